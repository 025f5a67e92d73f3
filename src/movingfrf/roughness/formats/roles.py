"""What a name and a unit say about numbers in a file: station, elevation, time, a counter, or something else."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import option
from movingfrf.roughness.formats.base import METRES, length_of, metres

Role = Literal["station", "elevation", "across", "time", "counter", "label", "other", "unknown"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Vocabulary:
    """What files are written with; in brackets, between what a number is safe."""

    # Seconds in one unit of time.
    seconds: Mapping[str, float]
    # Newton in one unit of force, as they are written: mN and MN differ.
    newtons: Mapping[str, float]
    # Words of a name that tell its role, in English, German, French, Spanish and Italian: the first in this order
    # that a name has. A compound counts by its end or its beginning, as its language has it.
    words: Sequence[tuple[Role, re.Pattern[str]]]
    # Words of a station whose unit they are; where that is empty, it may be one or another.
    implied: Sequence[tuple[re.Pattern[str], str]]
    # Names of a place on a map, which together are no distance.
    maps: Sequence[tuple[str, str]]
    # Units that may stand anywhere in a name: no other word is written like them.
    plain: frozenset[str]
    # Words that tell one path from another.
    sides: re.Pattern[str]
    force: re.Pattern[str]  # words that name one
    # Units of anything but length and time: quotients, powers, degrees, per cents, forces, voltages.
    other_unit: re.Pattern[str]
    # Words that a path has, whichever it is.
    any_path: re.Pattern[str]
    # Share of the steps of stations that may go down, in damaged rows; elevations do half the time [0.01 to 0.3].
    falling: float = 0.1
    # Share of the length by which two stationings of one road may differ: odometers and roundings [1e-3 to 0.05].
    same: float = 0.01


VOCABULARY = Vocabulary(
    seconds={
        **dict.fromkeys(("s", "sec", "secs", "second", "seconds", "sek"), 1.0),
        **dict.fromkeys(("ms", "msec", "milliseconds"), 1e-3),
        **dict.fromkeys(("us", "µs", "μs"), 1e-6),
        **dict.fromkeys(("min", "minutes"), 60.0),
        **dict.fromkeys(("h", "hr", "hour", "hours"), 3600.0),
    },
    newtons={
        "N": 1.0,
        "daN": 10.0,
        **dict.fromkeys(("kN", "KN"), 1e3),
        "MN": 1e6,
        **dict.fromkeys(("kgf", "kp"), 9.80665),
        **dict.fromkeys(("lbf", "lb", "lbs"), 4.4482216152605),
        **dict.fromkeys(("kip", "kips", "klbf"), 4448.2216152605),
    },
    words=(
        (
            "other",
            re.compile(
                r"lat|lati?tude|lon|lng|longi?tude|breitengrad|l(ä|ae)ngengrad|easting|northing|rechtswert|hochwert|"
                r"speed|velocity|.*geschwindigkeit|vitesse|velocidad|temp|temperatur.*|iri|mpd|macrotexture|acc|"
                r"accel.*|.*beschleunigung|azimuth|heading|bearing|pitch|roll|yaw|curvature|.*kr(ü|ue)mmung|slope|"
                r"gradient|grade|.*neigung|pente|crossfall|superelevation|cant|(ü|ue)berh(ö|oe)hung|gauge|"
                r"spurweite|twist|rut|ruts|rutting|spurrinne.*|quality|hdop|satellites?|weight|force|load|"
                r"versines?|chords?|sehne.*|pfeilh(ö|oe)hen?|"  # offsets from a chord
                r"cross|crosslevel|width|breite|.*depth|.*tiefe|thickness|.*dicke|radius|clearance|ride|"
                r"std|stdev|stddev|sigma|.*accuracy|precision|uncertainty|genauigkeit|tolerance|versatz|humidity|"
                r"ends?|next|previous"
            ),
        ),
        (
            "elevation",
            re.compile(
                r"z|z[lr]|h|elev.*|height|heights|.*h(ö|oe)hen?|altitude|alt|ele|level|levels|vertical|uneven.*|"
                r".*unebenheit.*|irregularit.*|alti|hauteur|cota|quota|altura|altezza"
            ),
        ),
        ("across", re.compile(r"lateral|across|transverse|offset|quer.*")),
        (
            "station",
            re.compile(
                r"x|s|u|dist|distan.*|station|stations|stationing|stationierung|sta|chain.*|mileage|milepost|"
                r"milepoint|kilomet.*|km|pk|kp|position|pos|abscis.*|progressiv.*|.*weg|.*strecke|odometer|dmi|"
                r"arclength"
            ),
        ),
        (
            "time",
            re.compile(
                r"t|time|times|timestamp|elapsed|datetime|date|utc|.*zeit|datum|temps|tiempo|tempo|seconds?|hours?"
            ),
        ),
        ("elevation", re.compile(r".*profil.*|perfil.*")),  # a profile's distance is none
        ("other", re.compile(r"alignment")),  # but a vertical one
        (
            "counter",
            re.compile(
                r"i|n|no|nr|num|number|nummer|index|idx|id|row|line|record|samples?|count|counter|point|pt|punkt|"
                r"unnamed"
            ),
        ),
        (
            "label",  # what tells stretches of road apart, and what is said of a station
            re.compile(
                r"lanes?|fahrstreifen|direction|richtung|section|abschnitt|route|run|year|jahr|flag|valid|status|event|"
                r"code|remarks?|comments?|notes?|bemerkung.*|kommentar.*"
            ),
        ),
    ),
    implied=(
        (re.compile(r"km|kilomet.*|pk|kp"), "km"),
        (re.compile(r"milepost|milepoint"), "mi"),
        (re.compile(r"mileage"), ""),
    ),
    maps=(("x", "y"), ("east", "north"), ("easting", "northing"), ("rechts", "hoch"), ("e", "n")),
    plain=frozenset(("mm", "cm", "ft", "um", "µm", "μm", "inches", "мм")),
    sides=re.compile(
        r"left|right|l|r|links|rechts|gauche|droite?|izquierd[ao]|izq|derech[ao]|der|sinistr[ao]|destr[ao]|inner|outer|"
        r"cent(er|re)|middle|mitte|[a-z]*wp|wheel|path|wheelpath|track|rail|lane|spur"
    ),
    force=re.compile(
        r"f[xyz]?|forces?|weight|gewicht|.*loads?|.*kr(a|ä|ae)fte?|.*last(en)?|effort|fuerza|forza|charge|carga|carico"
    ),
    other_unit=re.compile(
        r".*[/%°²³^*].*|deg\.?|degrees?(_north|_east)?|rad|c|k|celsius|g|hz|v|mv|n|kn|kg|t|mph|kmh|kph|kmph|knots|"
        r"bar|pa"
    ),
    any_path=re.compile(r"[a-z]?wp|wheel|path|wheelpath|track|rail|lane|spur"),
)


class Head(NamedTuple):
    """What the name of a column or an array, and its unit, say."""

    role: Role
    unit: str | None = None  # as it was written; None where none is stated


def head(name: str, unit: str = "") -> Head:
    """Tell what a column or an array holds by its name and its unit; the unit counts first.

    Parameters
    ----------
    name : str
        The name, with a unit in brackets (`dist (m)`), behind a comma (`Elevation, mm`) or as its last word
        (`station_ft`), or without.
    unit : str, optional
        The unit where it stands apart from the name: in a line of units, in an attribute.

    Returns
    -------
    Head
        Its role and the unit, wherever it stood. The unit may be one that nobody knows.

    Examples
    --------
    >>> head("station_ft"), head("Elevation, mm"), head("Messzeit [ms]"), head("left")
    (Head(role='station', unit='ft'), Head(role='elevation', unit='mm'), Head(role='time', unit='ms'), \
Head(role='unknown', unit=None))
    """
    words = words_of(outside(name))
    stated = unit.strip().strip("[]()").strip() or (unit_in(name) or "").strip()
    if kind_of_unit(stated) == "unknown" and (within := _unit_among(words)) is not None:
        stated = words.pop(within)
    if stated in ("-", "1"):  # what has no dimension
        stated = ""
    kind = kind_of_unit(stated)
    role = _role(words)
    if kind in ("time", "other") and role != "counter":
        role = kind
    elif kind == "length" and role in ("time", "label"):
        role = "unknown"
    if not stated and role == "station":
        stated = implied_unit(name) or ""
    return Head(role, stated or None)


def implied_unit(name: str) -> str | None:
    """Find the unit that a station's name says, as kilometres do; empty where it could be one or another."""
    words = words_of(outside(name))
    told = (unit for pattern, unit in VOCABULARY.implied if any(map(pattern.fullmatch, words)))
    return next(told, None)


def require_unit(name: str) -> None:
    """Refuse a station whose name leaves open what it is measured in.

    Raises
    ------
    ValueError
        If it is one of those that may be miles, kilometres or metres.
    """
    if implied_unit(name) == "":
        raise ValueError(f"{name[:40]!r} may be in miles, kilometres or metres: {option('units')} says which")


def unit_in(name: str) -> str | None:
    """Find the unit in a column's name: of what stands in brackets, square ones first, what is a unit.

    Examples
    --------
    >>> unit_in("Elevation (filtered) (mm)"), unit_in("z(x) (in, raw)"), unit_in("x [furlong]"), unit_in("x")
    ('mm', 'in', 'furlong', None)
    """
    found = re.findall(r"\[([^\]]*)\]", name) + re.findall(r"\(([^)]*)\)", name)
    units = [text for text in found if kind_of_unit(text) != "unknown"]
    # A unit may begin what is said, though `in` may be no inch.
    begun = [re.split(r"[,;]|(?<!\bin)\s", text.strip())[0] for text in found]
    units += [text for text in begun if length_of(text) is not None]
    return next(iter([*units, *found]), None)


def kind_of_unit(unit: str) -> Literal["length", "time", "other", "unknown"]:
    """Tell what is measured in a unit; unknown where it is none, or one that nobody knows."""
    word = unit.strip().lower()
    if length_of(word) is not None:
        return "length"
    if word in VOCABULARY.seconds:
        return "time"
    if unit.strip() in VOCABULARY.newtons:
        return "other"
    return "other" if VOCABULARY.other_unit.fullmatch(word) else "unknown"


def scales_of(units: Sequence[str | None], names: Sequence[str], timed: bool) -> list[float]:
    """Metres in one unit of a station and of elevations; of a station that is a time, seconds.

    Parameters
    ----------
    units : sequence of str or None
        Units, None for metres or seconds.
    names : sequence of str
        What is measured in them, for the message.
    timed : bool
        Whether the station is a time.

    Returns
    -------
    list of float
        One for each unit.

    Raises
    ------
    ValueError
        If one is not known.
    """
    along = VOCABULARY.seconds.get((units[0] or "s").strip().lower()) if timed else None
    scales = [metres(unit or "m", name) for unit, name in list(zip(units, names, strict=True))[along is not None :]]
    return scales if along is None else [along, *scales]


def words_of(name: str) -> list[str]:
    """Split a name into its words, in lower case: at blanks, signs, and capital letters within.

    Examples
    --------
    >>> words_of("station_ft"), words_of("LElev."), words_of("Distance, m"), words_of("roadHeight2")
    (['station', 'ft'], ['l', 'elev'], ['distance', 'm'], ['road', 'height'])
    """
    return [word.lower() for word in re.findall(r"[^\W\d_]+", _split(name))]


def outside(name: str) -> str:
    """Leave out of a name what stands in brackets."""
    return re.sub(r"\[[^\]]*\]|\([^)]*\)", " ", name)


def _split(name: str) -> str:
    """Put a blank before every capital letter that begins a word."""
    return re.sub(r"([a-zäöü])([A-Z])|([A-Z])([A-Z][a-z])", r"\1\3 \2\4", name)


def rest_of(name: str) -> str:
    """Tell what a name says besides its role and its unit: which recording it is.

    Examples
    --------
    >>> rest_of("x1"), rest_of("Elevation_left [mm]"), rest_of("distance")
    ('1', 'left', '')
    """
    found = re.findall(r"[^\W\d_]+|\d+", _split(outside(name)).lower())
    if (within := _unit_among(found)) is not None:
        found.pop(within)
    told = [pattern for role, pattern in VOCABULARY.words if role in ("station", "elevation")]
    return " ".join(word for word in found if not any(pattern.fullmatch(word) for pattern in told))


def names_a_path(name: str) -> bool:
    """Tell whether a name does nothing but tell one path from another."""
    words = words_of(outside(name))
    if (within := _unit_among(words)) is not None:
        words.pop(within)
    return bool(words) and all(map(VOCABULARY.sides.fullmatch, words))


def counts(values: FloatArray) -> bool:
    """Tell whether numbers do nothing but count: whole, one more each time, from 0 or 1 on.

    Parameters
    ----------
    values : ndarray, shape (row,)
        The numbers.

    Returns
    -------
    bool
        Whether they do.
    """
    return bool(values.size > 1 and values[0] in (0.0, 1.0) and (np.diff(values) == 1.0).all())


def _role(words: Sequence[str]) -> Role:
    if words[-1:] and words[-1] in ("id", "no", "nr", "nummer", "number", "index"):  # of a station
        return "counter"
    if list(words) in (["to"], ["bis"]):  # where a stretch ends
        return "other"
    return next((role for role, told in VOCABULARY.words if any(map(told.fullmatch, words))), "unknown")


def _unit_among(words: Sequence[str]) -> int | None:
    """Find a unit among the words of a name.

    It is the last, a length, or a time behind a word for time; or a plain one, wherever it stands. A name that is
    nothing but a unit of length (`m`) counts.
    """
    last = len(words) - 1
    if last >= 0 and (words[last] in METRES and (last or _role(words) == "unknown")):
        return last
    if last > 0 and words[last] in VOCABULARY.seconds and _role(words[:last]) == "time":
        return last
    return next((n for n, word in enumerate(words) if word in VOCABULARY.plain), None)

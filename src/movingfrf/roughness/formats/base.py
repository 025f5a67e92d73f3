"""What every format has in common: the raw profile it fills, units of length, and how much a file may claim."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import nearest, option
from movingfrf._basics.output import Content
from movingfrf.roughness.profile import Profile

# A column of a file: its name, or its number counted from 0.
ColumnKey = str | int

# Metres in one unit of length.
METRES = {
    unit: length
    for units, length in (
        ("m metre metres meter meters mètre mètres м", 1.0),
        ("dm decimetre decimetres decimeter decimeters", 0.1),
        ("cm centimetre centimetres centimeter centimeters см", 0.01),
        ("mm millimetre millimetres millimeter millimeters millimètre millimètres мм", 1e-3),
        ("um µm μm micron microns micrometre micrometres micrometer micrometers", 1e-6),  # two letters of one look
        ("km kilometre kilometres kilometer kilometers км", 1e3),
        ("in in. inch inches", 0.0254),
        ("mil mils thou", 0.0254e-3),
        ("ft ft. foot feet", 0.3048),
        ("ftus usft", 1200 / 3937),
        ("yd yard yards", 0.9144),
        ("mi mile miles", 1609.344),
    )
    for unit in units.split()
}


def _numbered(row: int) -> str:
    return f"station number {row}"


class RawProfile(NamedTuple):
    """What a file says, before anything is decided about it."""

    stations: FloatArray  # (distance,) [m]
    elevations: FloatArray  # (distance, path) [m], nan where the file has none
    understood: str  # how the numbers were read
    across: FloatArray | None = None  # (path,) [m], left positive, where the file says so
    source: str = ""  # what the profile in the file was made from
    steps: tuple[str, ...] = ()  # what was done to it before, and in reading
    place: Callable[[int], str] = _numbered  # where in the file a station stands
    same_across: bool = False  # one elevation for all paths
    timed: str = ""  # name of the stations where they are times [s], which a speed turns into distances


class Wanted(NamedTuple):
    """What is asked for of all that a file holds."""

    columns: Sequence[ColumnKey] | None = None  # the station, then elevations; None: by names and units
    recording: str | None = None  # by name; None: the only one
    units: Sequence[str] | None = None  # of the stations, then of the elevations, in place of those in the file
    skip_lines: int = 0  # lines at the beginning that are no part of the table
    missing: tuple[float, ...] = ()  # values that stand for no elevation, as the file has them


class Recording(NamedTuple):
    """One of the recordings that a file holds: a track, a struct, a group, a sheet."""

    name: str
    points: int
    length: float  # [m], nan where it is not known before it is read


class Format(NamedTuple):
    """A format: how it is recognised, read and written."""

    name: str
    title: str  # what it is called in a sentence
    endings: tuple[str, ...]
    recognises: Callable[[bytes], bool]  # from the first bytes of a file
    read: Callable[[Path, Wanted], RawProfile]
    # Profile and encoding → files, each by what its name has behind that of the profile's.
    made: Callable[[Profile, str], dict[str, Content]] | None = None
    encodings: tuple[str, ...] = ("",)  # how it can be written; the first is the default
    several: bool = False  # whether a file may hold several recordings; what holds one refuses `recording`
    takes: tuple[str, ...] = ()  # what else of `Wanted` it understands


def metres(unit: str, what: str) -> float:
    """Metres in a unit of length.

    Parameters
    ----------
    unit : str
        The unit, as a file has it.
    what : str
        What is measured in it, for the message.

    Returns
    -------
    float
        Its length [m].

    Raises
    ------
    ValueError
        If it is not a unit of length.
    """
    length = length_of(unit)
    if length is None:
        raise ValueError(
            f"the unit {unit.strip()[:30]!r} of {what} is not known; lengths may be in "
            f"{', '.join(dict.fromkeys(u for u in METRES if len(u) < 3 and u.isascii()))}, with a number "
            f"before it too (0.1mm); {option('units')} says which it is, {option('columns')} chooses other columns"
        )
    return length


def length_of(unit: str) -> float | None:
    """Metres in a unit of length, with or without a number before it; None if it is no such unit.

    Examples
    --------
    >>> length_of("ft"), length_of("0.1 mm"), length_of("1/10 mm"), length_of("s")
    (0.3048, 0.0001, 0.0001, None)
    """
    word = re.sub(r"(us )?survey (ft|foot|feet)", "ftus", unit.strip().strip("\"'").lower())
    found = re.fullmatch(r"(?:(\d{1,6}(?:[.,]\d{1,6})?)(?:/(\d{1,6}))?[\s*]*)?(\D+)", word)
    if found is None or found[3] not in METRES:
        return None
    parts = float((found[1] or "1").replace(",", ".")), float(found[2] or "1")
    return METRES[found[3]] * parts[0] / parts[1] if min(parts) > 0 else None


def scaled(values: FloatArray, scale: float, missing: Sequence[float] = ()) -> FloatArray:
    """Convert to metres, nan where a value stands for none; what is in metres already stays as it is."""
    for marker in missing:
        # Of a marker with decimals single precision keeps seven digits [1e-7 to 1e-5].
        values = np.where(np.isclose(values, marker, rtol=1e-6, atol=0.0), np.nan, values)
    return values if scale == 1.0 else values * scale


def chosen_columns(names: Sequence[str], columns: Sequence[ColumnKey]) -> list[int]:
    """Numbers of the columns that were asked for.

    Parameters
    ----------
    names : sequence of str
        Names that the file has.
    columns : sequence of str or int
        Names, with or without the unit in brackets or behind a comma, or numbers counted from 0.

    Returns
    -------
    list of int
        One number for each.

    Raises
    ------
    ValueError
        If there is no such column, with those that there are.
    """
    bare = [re.sub(r"[\[(,].*", "", name).strip().lower() for name in names]
    found = []
    for column in columns:
        if isinstance(column, str) and column in names:
            found.append(list(names).index(column))
        elif isinstance(column, str) and bare.count(column.strip().lower()) == 1:
            found.append(bare.index(column.strip().lower()))
        elif not isinstance(column, str) and 0 <= column < len(names):
            found.append(int(column))
        else:
            raise ValueError(f"there is no column {column!r}; there are {listed(names)}")
    if len(set(found)) < len(found):
        raise ValueError(f"the columns {list(columns)!r} name one column twice")
    return found


def chosen_recording(recordings: Sequence[Recording], asked: str | None) -> int:
    """Find the recording that was asked for, or the only one.

    Parameters
    ----------
    recordings : sequence of Recording
        What the file holds; at least one.
    asked : str, optional
        Name of one of them.

    Returns
    -------
    int
        Its number, counted from 0.

    Raises
    ------
    ValueError
        If there are several and none is asked for, or there is none of that name; with names and lengths.
    """
    names = [each.name for each in recordings]
    if asked in names:
        return names.index(asked)
    if asked is None and len(recordings) == 1:
        return 0
    most = 12  # that are listed
    there = "; ".join(
        f"{name[:60]!r}, {points} points" + (f" over {length:.6g} m" if length == length else "")
        for name, points, length in recordings[:most]
    ) + (f"; and {len(names) - most} more" if len(names) > most else "")
    if asked is None:
        raise ValueError(
            f"holds {len(names)} recordings, which are not joined: {there}; {option('recording')} chooses one"
        )
    raise ValueError(f"there is no recording {asked[:60]!r}{nearest(asked, names)}; there are {there}")


def told_apart_by_number(names: Sequence[str]) -> list[str]:
    """Names of which no two are alike: from the second on, equal ones get a number."""
    found: dict[str, None] = {}
    number: dict[str, int] = {}
    for name in names:
        again = name
        while again in found:
            number[name] = number.get(name, 1) + 1
            again = f"{name} ({number[name]})"
        found[again] = None
    return list(found)


def units_taken(own: Sequence[str | None], asked: Sequence[str] | None) -> list[str | None]:
    """Units of a station and of elevations: those that were asked for, or else a file's own.

    Parameters
    ----------
    own : sequence of str or None
        Units in the file, of the station first; None or empty where it has none.
    asked : sequence of str, optional
        Two units, of the station and of all elevations, or one for each.

    Returns
    -------
    list of str or None
        One for each.

    Raises
    ------
    ValueError
        If there are neither two nor one for each.
    """
    if asked is None:
        return [unit or None for unit in own]
    if len(asked) not in (2, len(own)):
        raise ValueError(
            f"{option('units')} must be those of the station and of the elevations, or of each of {len(own) - 1} "
            f"paths, got {len(asked)}"
        )
    return [*asked] if len(asked) == len(own) else [asked[0], *[asked[1]] * (len(own) - 1)]


def listed(names: Sequence[str], most: int = 12) -> str:
    """Write names one after the other, the first of them where there are many."""
    shown = ", ".join(repr(name[:40]) for name in names[:most])
    return shown if len(names) <= most else f"{shown} and {len(names) - most} more"


def bytes_of(path: Path) -> bytes:
    """Bytes of a file.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    bytes
        What it holds.

    Raises
    ------
    ValueError
        If it cannot be read.
    """
    try:
        return path.read_bytes()
    except OSError as error:
        raise ValueError(f"cannot be read: {error.strerror or error}") from None

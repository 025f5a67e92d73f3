"""Files of named arrays: which of them are the stations, and which the elevations, of one recording or several."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import option
from movingfrf.roughness.formats.base import (
    RawProfile,
    Recording,
    Wanted,
    chosen_columns,
    chosen_recording,
    length_of,
    listed,
    metres,
    scaled,
    units_taken,
)
from movingfrf.roughness.formats.choice import Array, Choice, Series, Unclear, choose, increases
from movingfrf.roughness.formats.roles import Head, counts, head, kind_of_unit, require_unit, scales_of, words_of


@dataclass(frozen=True, slots=True, kw_only=True)
class ArrayNames:
    """What the package itself calls the arrays that it writes, and what it says of others."""

    stations: str = "distance"
    elevations: str = "elevation"
    across: str = "across"
    # Arrays that stand in no struct and in no group.
    top: str = "top level"
    # Stations that a profile takes; what is shorter describes something.
    least: int = 4


ARRAY_NAMES = ArrayNames()


class Pick(NamedTuple):
    """Stations and elevations that belong together, each with the name that a sentence gives it."""

    stations: tuple[str, Array]
    elevations: list[tuple[str, Array]]
    left: list[str]  # names of what else is as long
    across: Array | None = None


def raw_profile(
    arrays: Mapping[str, Array],
    wanted: Wanted,
    kind: str,
    unread: Mapping[str, str] | None = None,
    texts: Mapping[str, str] | None = None,
) -> RawProfile:
    """Make a raw profile of the arrays in a file.

    Parameters
    ----------
    arrays : mapping of str to Array
        Arrays of real numbers, by name; what stands in a struct or a group has its name before a dot or a slash.
    wanted : Wanted
        Names of the stations and of the elevations, which are found by names and units otherwise, and which
        recording.
    kind : str
        What kind of file it is, for the message.
    unread : mapping of str to str, optional
        What else is there, and what it is, for the message.
    texts : mapping of str to str, optional
        Texts beside the arrays, of which some may be units: `elevation_units`.

    Returns
    -------
    RawProfile
        In metres.

    Raises
    ------
    ValueError
        If the arrays cannot be told apart, or do not fit each other; with what there is.
    """
    arrays, general = _with_units(arrays, texts or {})
    pick = _named(arrays, wanted) if wanted.columns is not None else _found(arrays, wanted, unread or {})
    name, stored = pick.stations
    stations = stored.load().ravel()
    parts = [_by_station(array.load(), stations.size, called) for called, array in pick.elevations]
    taken = [pick.stations, *pick.elevations]
    own = [_unit(called, array) for called, array in taken]
    units = units_taken(own, wanted.units)
    if units[0] is None:
        require_unit(_bare(name))
    if general and None in units and length_of(general) != 1.0:
        raise ValueError(
            f"says {general[:30]!r} of its units, and not of what: {option('units')} says those of stations and "
            "elevations"
        )
    timed = head(_bare(name), units[0] or "").role == "time"
    scales = scales_of(units, [f"{called!r}" for called, _ in taken], timed)
    stated = {unit or "metres, since no unit is given" for unit in units}
    across = pick.across
    (_, first), *others = pick.elevations
    return RawProfile(
        scaled(stations, scales[0]),
        np.concatenate(
            [scaled(part, s, wanted.missing) for part, s in zip(parts, scales[1:], strict=True)], axis=1
        ),
        f"{kind} with stations {name!r} and elevations {', '.join(repr(called) for called, _ in pick.elevations)} "
        f"in {', '.join(sorted(stated))}" + (f", without {listed(pick.left)}" if pick.left else ""),
        across=None if across is None else scaled(across.load().ravel(), metres(across.unit or "m", "'across'")),
        place=lambda row: f"value {row + 1}",
        same_across=not others and first.is_vector and len(first.shape) < 3,
        timed=name if timed else "",
    )


def _unit(called: str, array: Array) -> str | None:
    """Find the unit of an array: its own, or that in its name."""
    return array.unit or head(_bare(re.sub(r", (column|row) \d.*", "", called))).unit


def _with_units(arrays: Mapping[str, Array], texts: Mapping[str, str]) -> tuple[dict[str, Array], str]:
    """Give arrays the units that texts beside them tell by their names; and a unit that is told of nothing."""
    found, general = dict(arrays), ""
    for told, text in texts.items():
        words = words_of(_bare(told))
        about = [word for word in words if word not in ("unit", "units")]
        if len(about) == len(words) or kind_of_unit(text) == "unknown":
            continue
        group = told[: len(told) - len(_bare(told))]
        those = [name for name in arrays if name == group + _bare(name) and words_of(_bare(name)) == about]
        found |= {name: arrays[name]._replace(unit=text) for name in those}
        general = general if about else text
    return found, general


def _named(arrays: Mapping[str, Array], wanted: Wanted) -> Pick:
    """Take the arrays that were asked for; a matrix alone is stations and elevations."""
    names = list(arrays)
    if wanted.recording is not None:
        groups = _groups(arrays)
        there = [
            Recording(group, max(a.length for a in own.values()), float("nan")) for group, own in groups.items()
        ]
        if not there:
            raise ValueError("holds no recordings to choose from")
        own = groups[there[chosen_recording(there, wanted.recording)].name]
        arrays = {_bare(name): array for name, array in own.items()}
        names = list(arrays)
    picked = [names[n] for n in chosen_columns(names, wanted.columns or ())]
    if len(picked) == 1 and _is_table(arrays[picked[0]]):
        return _columns_of(picked[0], arrays[picked[0]])
    if len(picked) < 2:
        raise ValueError(f"{option('columns')} must name the stations and at least one array of elevations")
    stations, *elevations = picked
    fitting = arrays.get(ARRAY_NAMES.across) if elevations == [ARRAY_NAMES.elevations] else None
    return Pick((stations, arrays[stations]), [(name, arrays[name]) for name in elevations], [], fitting)


def _found(arrays: Mapping[str, Array], wanted: Wanted, unread: Mapping[str, str]) -> Pick:
    """Find stations and elevations by names, units and sizes, and the recording that is wanted."""
    picks: dict[str, Pick] = {}
    unclear: list[Unclear] = []
    groups = _groups(arrays)
    for group, own in groups.items():
        try:
            for key, pick in _picked(own, _above(group, groups)).items():
                within = "" if group == ARRAY_NAMES.top else group
                picks[" ".join(filter(None, (within, key))) or ARRAY_NAMES.top] = pick
        except Unclear as error:
            unclear.append(error)
    if picks:
        recordings = [
            Recording(name, pick.stations[1].length, _length(*pick.stations)) for name, pick in picks.items()
        ]
        return picks[recordings[chosen_recording(recordings, wanted.recording)].name]
    there = "; ".join(
        [f"{name!r} {' by '.join(map(str, a.shape))}" for name, a in list(arrays.items())[:12]]
        + [f"{name[:40]!r}, {what}, which is not read" for name, what in list(unread.items())[:12]]
    )
    why = next((f" ({error})" for error in unclear if str(error)), "")
    raise ValueError(
        f"holds no arrays that are clearly stations and elevations{why}: {there or 'nothing at all'}; name them by "
        f"{option('columns')}"
    )


def _groups(arrays: Mapping[str, Array]) -> dict[str, dict[str, Array]]:
    """Sort arrays by the struct or the group that they stand in."""
    found: dict[str, dict[str, Array]] = {}
    for name, array in arrays.items():
        group = name[: len(name) - len(_bare(name))].rstrip("./") or ARRAY_NAMES.top
        found.setdefault(group, {})[name] = array
    return found


def _above(group: str, groups: Mapping[str, dict[str, Array]]) -> dict[str, Array]:
    """Stations that stand above a group, as those of netCDF do; the nearest alone."""
    while group != ARRAY_NAMES.top:
        group = group[: len(group) - len(_bare(group))].rstrip("./") or ARRAY_NAMES.top
        found = {
            name: array
            for name, array in groups.get(group, {}).items()
            if array.is_vector and head(_bare(name), array.unit).role == "station"
        }
        if found:
            return found
    return {}


def _bare(name: str) -> str:
    """Name of an array within its struct or group."""
    return re.split(r"[./]", name)[-1]


def _picked(own: Mapping[str, Array], above: Mapping[str, Array]) -> dict[str, Pick]:
    """Find recordings in one struct or group: none, one without a name, or several by what names have in common.

    Raises
    ------
    Unclear
        If arrays could be stations and elevations, but their names do not say which.
    """
    bare = {_bare(name): name for name in own}
    if ARRAY_NAMES.stations in bare and ARRAY_NAMES.elevations in bare:
        one, other = bare[ARRAY_NAMES.stations], bare[ARRAY_NAMES.elevations]
        across = own.get(bare.get(ARRAY_NAMES.across, ""))
        return {"": Pick((one, own[one]), [(other, own[other])], [], across)}
    long = {name: array for name, array in own.items() if array.length >= ARRAY_NAMES.least}
    series = [Series(_bare(name), _head(name, array), array) for name, array in long.items()]
    if not _stations(series) and above and any(each.head.role in ("elevation", "unknown") for each in series):
        long = {**above, **long}
        series = [Series(_bare(name), _head(name, array), array) for name, array in long.items()]
    tables = {} if _stations(series) else _tables(long, series)
    if tables:
        return tables
    names = list(long)
    return {
        key: _pick(choice, names, series) for key, choice in choose(series, ordered=False).items() if choice.whole
    }


def _head(name: str, array: Array) -> Head:
    return head(_bare(name), array.unit)


def _stations(series: Sequence[Series]) -> bool:
    return any(each.head.role == "station" and each.array.is_vector for each in series)


def _pick(choice: Choice, names: Sequence[str], series: Sequence[Series]) -> Pick:
    assert choice.station is not None
    count = series[choice.station].array.length
    taken = [(names[n], series[n].array) for n in (choice.station, *choice.elevations)]
    across = [each.array for each in series if each.head.role == "across" and each.array.is_vector]
    wide = len(taken) == 2 and across and across[0].length in taken[1][1].shape
    left = [
        names[n]
        for n, each in enumerate(series)
        if n not in (choice.station, *choice.elevations) and each.array.fits(count) and each.head.role != "across"
    ]
    return Pick(taken[0], taken[1:], left, across[0] if wide and across[0].length != count else None)


def _tables(long: Mapping[str, Array], series: Sequence[Series]) -> dict[str, Pick]:
    """Find matrices that hold stations and elevations, where no vector goes up that could be the stations."""
    unnamed = {
        name: each for name, each in zip(long, series, strict=True) if each.head.role in ("unknown", "elevation")
    }
    if any(
        each.head.role == "unknown" and each.array.is_vector and increases(each.values())
        for each in unnamed.values()
    ):
        return {}
    tables = {name: long[name] for name in unnamed if _is_table(long[name])}
    return {"" if len(tables) == 1 else _bare(name): _columns_of(name, table) for name, table in tables.items()}


def _is_table(array: Array) -> bool:
    """Whether a matrix holds stations in its first column, or its first row where that is the longer side."""
    sides = array.shape
    return len(sides) == 2 and 1 < min(sides) < max(sides) and increases(_lying(array)[:, 0])


def _lying(array: Array) -> FloatArray:
    """Values of a matrix with one row per station."""
    values = array.load()
    return values if values.shape[0] >= values.shape[1] else values.T


def _columns_of(name: str, array: Array) -> Pick:
    """Stations and elevations of a matrix; a first column that counts is none where the second increases too."""
    values = _lying(array)
    first = int(values.shape[1] > 2 and counts(values[:, 0]) and increases(values[:, 1]))
    line = "column" if array.shape[0] >= array.shape[1] else "row"
    count, width = values.shape[0], values.shape[1] - first - 1

    def station() -> FloatArray:
        return _lying(array)[:, first]

    def elevations() -> FloatArray:
        return _lying(array)[:, first + 1 :]

    return Pick(
        (f"{name}, {line} {first + 1}", Array((count,), station, array.unit)),
        [
            (
                f"{name}, {line} {first + 2}" + (" and on" if width > 1 else ""),
                Array((count, width), elevations, array.unit),
            )
        ],
        [f"{name}, {line} 1"] if first else [],
    )


def _length(called: str, stations: Array) -> float:
    values, unit = stations.load().ravel(), _unit(called, stations)
    try:
        return float(values[-1] - values[0]) * metres(unit or "m", "") if values.size else float("nan")
    except ValueError:
        return float("nan")


def _by_station(values: FloatArray, count: int, name: str) -> FloatArray:
    """Arrange elevations with one row per station."""
    values = values.reshape(-1, 1) if values.ndim < 2 or 1 in values.shape else values
    if values.ndim == 2 and values.shape[0] == count:
        return values
    if values.ndim == 2 and values.shape[1] == count:
        return values.T
    raise ValueError(f"has {count} stations, but {name!r} has the shape {values.shape}")

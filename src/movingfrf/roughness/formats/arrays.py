"""Files of named arrays: which of them are the stations, and which the elevations, of one recording or several."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
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
    listed,
    metres,
    scaled,
    units_taken,
)
from movingfrf.roughness.formats.roles import Head, counts, head, names_a_path, rest_of, scales_of, sort_out


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


class Array(NamedTuple):
    """An array that is not read before it is needed."""

    shape: tuple[int, ...]
    load: Callable[[], FloatArray]
    unit: str = ""

    @property
    def length(self) -> int:
        """Number of values along its longest side."""
        return max(self.shape, default=1)

    @property
    def is_vector(self) -> bool:
        """Whether only one side has more than one value."""
        return sum(side != 1 for side in self.shape) == 1

    def fits(self, count: int) -> bool:
        """Whether it has a row or a column for each of so many stations."""
        return count in self.shape and len([side for side in self.shape if side != 1]) <= 2


class Pick(NamedTuple):
    """Stations and elevations that belong together, each with the name that a sentence gives it."""

    stations: tuple[str, Array]
    elevations: list[tuple[str, Array]]
    left: list[str]  # names of what else is as long
    across: Array | None = None


class Unclear(ValueError):
    """Arrays that belong together do not say which of them is what."""


def raw_profile(
    arrays: Mapping[str, Array], wanted: Wanted, kind: str, unread: Mapping[str, str] | None = None
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

    Returns
    -------
    RawProfile
        In metres.

    Raises
    ------
    ValueError
        If the arrays cannot be told apart, or do not fit each other; with what there is.
    """
    pick = _named(arrays, wanted) if wanted.columns is not None else _found(arrays, wanted, unread or {})
    name, stored = pick.stations
    stations = stored.load().ravel()
    parts = [_by_station(array.load(), stations.size, called) for called, array in pick.elevations]
    taken = [pick.stations, *pick.elevations]
    units = units_taken([array.unit for _, array in taken], wanted.units)
    timed = head(_bare(name), (wanted.units or [stored.unit])[0]).role == "time"
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
            Recording(name, pick.stations[1].length, _length(pick.stations[1])) for name, pick in picks.items()
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
    heads = {name: head(_bare(name), array.unit) for name, array in long.items()}
    stations = [name for name, each in heads.items() if each.role == "station" and long[name].is_vector]
    if not stations and above and any(each.role in ("elevation", "unknown") for each in heads.values()):
        stations, long = list(above), {**above, **long}
        heads = {name: head(_bare(name), array.unit) for name, array in long.items()}
    if len(stations) > 1:
        return _side_by_side(long, heads, stations)
    if stations:
        return {"": pick} if (pick := _with(stations[0], long, heads)) else {}
    return _nameless(long, heads)


def _with(station: str, long: Mapping[str, Array], heads: Mapping[str, Head]) -> Pick | None:
    """Elevations to a station: those that names and units show; None if there are none."""
    count = long[station].length
    names = [name for name in long if name != station]
    found = sort_out([heads[name] for name in names])
    called = [names[n] for n in found.elevations if heads[names[n]].role == "elevation"]
    # What no name calls an elevation must at least fit.
    elevations = [names[n] for n in found.elevations if names[n] in called or long[names[n]].fits(count)]
    left = [name for name in names if name not in elevations and long[name].fits(count)]
    if not elevations:
        return None
    if not called and len(elevations) > 1 and not all(names_a_path(_bare(name)) for name in elevations):
        raise Unclear(f"several may be the elevations: {listed(elevations)}")
    if {"x", "y"} <= {_bare(name).lower() for name in (station, *left)}:
        raise Unclear("x and y may be coordinates of a map")
    across = [long[name] for name in names if heads[name].role == "across" and long[name].is_vector]
    wide = len(elevations) == 1 and across and across[0].length in long[elevations[0]].shape
    return Pick(
        (station, long[station]),
        [(name, long[name]) for name in elevations],
        [name for name in left if heads[name].role != "across"],
        across[0] if wide and across[0].length != count else None,
    )


def _side_by_side(long: Mapping[str, Array], heads: Mapping[str, Head], stations: list[str]) -> dict[str, Pick]:
    """Find recordings whose stations and elevations share a word or a number: `x1` and `z1`, `x2` and `z2`."""
    keys = {name: rest_of(_bare(name)) for name in long}
    picks = {}
    for station in stations:
        own = {name: array for name, array in long.items() if name == station or keys[name] == keys[station]}
        alike = [name for name in stations if keys[name] == keys[station]]
        if len(alike) == 1 and (pick := _with(station, own, heads)):
            picks[keys[station]] = pick
    if not picks or (len(picks) == 1 and "" in picks):
        raise Unclear(f"several may be the stations: {listed(stations)}")
    return picks


def _nameless(long: Mapping[str, Array], heads: Mapping[str, Head]) -> dict[str, Pick]:
    """Where no name says station: a table alone, or the only array that increases and the only other."""
    unnamed = [name for name, each in heads.items() if each.role in ("unknown", "elevation")]
    increasing = [
        name
        for name in unnamed
        if heads[name].role == "unknown" and long[name].is_vector and _increases(long[name].load().ravel())
    ]
    others = [name for name in unnamed if name not in increasing]
    if len(increasing) == len(others) == 1:
        if counts(long[increasing[0]].load().ravel()):
            raise Unclear(f"{increasing[0]!r} does nothing but count")
        return {"": Pick((increasing[0], long[increasing[0]]), [(others[0], long[others[0]])], [])}
    tables = {} if increasing else {name: long[name] for name in unnamed if _is_table(long[name])}
    if tables:
        return {"" if len(tables) == 1 else _bare(name): _columns_of(name, table) for name, table in tables.items()}
    times = [name for name, each in heads.items() if each.role == "time"]
    along = next((name for name in times if long[name].is_vector), None)
    pick = None if along is None else _with(along, long, heads)
    return {"": pick} if pick else {}


def _increases(values: FloatArray) -> bool:
    return bool((np.diff(values) > 0).all())


def _is_table(array: Array) -> bool:
    """Whether a matrix holds stations in its first column, or its first row where that is the longer side."""
    sides = array.shape
    return len(sides) == 2 and 1 < min(sides) < max(sides) and _increases(_lying(array)[:, 0])


def _lying(array: Array) -> FloatArray:
    """Values of a matrix with one row per station."""
    values = array.load()
    return values if values.shape[0] >= values.shape[1] else values.T


def _columns_of(name: str, array: Array) -> Pick:
    """Stations and elevations of a matrix; a first column that counts is none where the second increases too."""
    values = _lying(array)
    first = int(values.shape[1] > 2 and counts(values[:, 0]) and _increases(values[:, 1]))
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


def _length(stations: Array) -> float:
    values = stations.load().ravel()
    try:
        return float(values[-1] - values[0]) * metres(stations.unit or "m", "") if values.size else float("nan")
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

"""Which columns or arrays are the stations and the elevations: by names, units and values.

Text, spreadsheets and files of arrays are all decided here.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf.roughness.formats.base import length_of, listed, told_apart_by_number
from movingfrf.roughness.formats.roles import (
    VOCABULARY,
    Head,
    counts,
    implied_unit,
    kind_of_unit,
    names_a_path,
    outside,
    rest_of,
    words_of,
)


class Array(NamedTuple):
    """An array, or a column of a table, that is not read before it is needed."""

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


class Series(NamedTuple):
    """A column or an array: its name, what that and its unit say, and its values."""

    name: str
    head: Head
    array: Array

    def values(self) -> FloatArray:
        """All values, one after the other."""
        return self.array.load().ravel()


class Choice(NamedTuple):
    """Which of several columns or arrays make a recording, by number."""

    station: int | None  # None where nothing could be one
    elevations: list[int]  # none where nothing could be one
    timed: bool = False  # whether the station is a time

    @property
    def whole(self) -> bool:
        """Whether it is a recording."""
        return self.station is not None and bool(self.elevations)


class Unclear(ValueError):
    """Columns or arrays do not say which of them is what."""


def choose(series: Sequence[Series], *, ordered: bool) -> dict[str, Choice]:
    """Tell stations and elevations, of each recording that there is.

    The station is what is called so and goes up; of several that do, the first with a unit, if all tell the same
    road. Else a time; else, where no name says it, the first column, or the only array that goes up.
    Elevations are those that are called so and those that nothing but a side describes (`left`); where none is
    called so, those with sides or a unit of length, or else what no name describes, if that is one kind of thing.

    Several recordings are stations and elevations with a word or a number in common (`x1` and `z1`, `x2` and
    `z2`), or columns in turns: a station and its elevations, another and its own.

    Parameters
    ----------
    series : sequence of Series
        Columns or arrays of numbers.
    ordered : bool
        Whether they stand in an order that says something, as columns do.

    Returns
    -------
    dict of str to Choice
        By the name of the recording; one without a name where there is one only, which may lack something.

    Raises
    ------
    Unclear
        If several could be the station, or several the elevations, or the station is a place on a map or a counter.
    """
    stations = [n for n, each in enumerate(series) if each.head.role == "station" and each.array.is_vector]
    if len(stations) > 1:
        found = _by_keys(series, stations, ordered) or (_in_turns(series, stations) if ordered else {})
        if found:
            return found
    return {"": _one(series, list(range(len(series))), ordered)}


def _by_keys(series: Sequence[Series], stations: Sequence[int], ordered: bool) -> dict[str, Choice]:
    """Find recordings by what names have in common."""
    keys = [rest_of(each.name) for each in series]
    found = dict[str, Choice]()
    for station in stations:
        own = [n for n, key in enumerate(keys) if key == keys[station]]
        if [n for n in own if n in stations] == [station] and len(own) > 1:
            choice = _one(series, own, ordered)
            found |= {keys[station] or series[station].name: choice} if choice.whole else {}
    return found if len(found) > 1 else {}


def _in_turns(series: Sequence[Series], stations: Sequence[int]) -> dict[str, Choice]:
    """Find recordings side by side in a table: each station has elevations of its own behind it."""
    ends = [*stations[1:], len(series)]
    own = [
        [n for n in range(first + 1, end) if series[n].head.role == "elevation" or names_a_path(series[n].name)]
        for first, end in zip(stations, ends, strict=True)
    ]
    if not all(own):
        return {}
    names = told_apart_by_number([series[n].name for n in stations])
    return {name: Choice(n, heights) for name, n, heights in zip(names, stations, own, strict=True)}


def _one(series: Sequence[Series], among: Sequence[int], ordered: bool) -> Choice:
    """Tell the station and the elevations of one recording."""
    station, timed = _station(series, among, ordered)
    if station is None:
        return Choice(None, [n for n in among if series[n].head.role == "elevation"])
    elevations = _elevations(series, [n for n in among if n != station], series[station].array.length, ordered)
    names = {_plain(series[n].name): n for n in among}
    for along, beside in VOCABULARY.maps:
        pair = names.get(along), names.get(beside)
        if station not in pair or None in pair or {*pair} & {*elevations}:
            continue
        if all(np.ptp(series[n].values()) > 0 for n in pair if n is not None):  # else it runs along one of them
            raise Unclear(f"{along} and {beside} may be coordinates of a map")
    return Choice(station, elevations, timed)


def _plain(name: str) -> str:
    return re.sub(r"\[.*|\(.*", "", name).strip(" ,").lower()


def _station(series: Sequence[Series], among: Sequence[int], ordered: bool) -> tuple[int | None, bool]:
    """Find the station, and whether it is a time."""
    vectors = [n for n in among if series[n].array.is_vector]
    called = [n for n in vectors if series[n].head.role == "station"]
    unknown = [n for n in vectors if series[n].head.role == "unknown"]
    if called:
        rising = [n for n in called if _rises(series[n].values())]
        others = [n for n in unknown if not rising and _has_length(series[n]) and _rises(series[n].values())]
        return (others[0] if len(others) == 1 else _agreed(series, rising or called)), False
    rising = [] if ordered else [n for n in unknown if _rises(series[n].values())]
    time = next((n for n in vectors if series[n].head.role == "time"), None)
    if time is not None and len(rising) != 1:
        return time, True
    found = _first(series, unknown) if ordered else rising[0] if len(rising) == 1 else None
    if found is not None and words_of(series[found].name) and series[found].head.unit is None:
        if counts(series[found].values()):
            raise Unclear(f"{series[found].name!r} does nothing but count")
    return found, False


def _first(series: Sequence[Series], unknown: list[int]) -> int | None:
    """Find the station by the order of columns: the first, unless it counts or only another goes up."""
    if len(unknown) > 2:
        counting, second, third = (series[n].values() for n in unknown[:3])
        if counts(counting) and increases(second) and not increases(third):
            return unknown[1]
    rising = [n for n in unknown[1:] if increases(series[n].values())]
    lone = len(rising) == 1 and not _rises(series[unknown[0]].values())
    return rising[0] if lone else unknown[0] if unknown else None


def _agreed(series: Sequence[Series], stations: Sequence[int]) -> int:
    """Take the first of several stationings, with a unit if any has one, if all tell the same road."""
    stated = [n for n in stations if _has_length(series[n]) and implied_unit(series[n].name) is None] or stations
    going = [n for n in stated if increases(series[n].values())] or stated
    first, *others = going
    for other in others:
        if not _same_road(series[first], series[other]):
            raise Unclear(f"several may be the stations: {listed([series[n].name for n in going])}")
    return first


def _same_road(one: Series, other: Series) -> bool:
    """Whether two stationings go the same way, wherever they begin."""
    if one.array.length != other.array.length:
        return False
    a, b = (each.values() * (length_of(each.head.unit or "m") or 1.0) for each in (one, other))
    there = np.isfinite(a) & np.isfinite(b)
    if not there.any():
        return True
    off = (a - b)[there]
    return bool(np.ptp(off) <= VOCABULARY.same * np.ptp(a[there]))


def _elevations(series: Sequence[Series], among: Sequence[int], count: int, ordered: bool) -> list[int]:
    """Find the elevations to a station with so many values."""
    called = [n for n in among if series[n].head.role == "elevation"]
    unknown = [n for n in among if series[n].head.role == "unknown" and series[n].array.fits(count)]
    if ordered and len(unknown) > 1:
        unknown = [n for n in unknown if not is_counter(series[n].name, series[n].head, series[n].values())]
    sides = [n for n in unknown if names_a_path(series[n].name)]
    if called:
        return sorted([*called, *(n for n in sides if _has_length(series[n]) or _which(series[n].name))])
    found = sides or [n for n in unknown if _has_length(series[n])] or unknown
    kinds = {_kind(series[n].name) for n in found}
    if len(found) > 1 and found != sides and (len(kinds) > 1 or not ordered):
        raise Unclear(f"several may be the elevations: {listed([series[n].name for n in found])}")
    return found


def _kind(name: str) -> str:
    """Tell what a name says besides a side, a number, a letter and a unit."""
    words = words_of(outside(name))
    return " ".join(word for word in words if len(word) > 1 and not VOCABULARY.sides.fullmatch(word))


def _which(name: str) -> bool:
    """Whether a name says which path it is about: the number of the path stands under `wheel path`."""
    return not all(map(VOCABULARY.any_path.fullmatch, words_of(outside(name))))


def _has_length(each: Series) -> bool:
    return kind_of_unit(each.head.unit or "") == "length"


def increases(values: FloatArray) -> bool:
    """Tell whether every value is more than the one before, where there are values."""
    there = values[np.isfinite(values)]
    return bool(there.size > 1 and (np.diff(there) > 0).all())


def is_counter(name: str, said: Head, values: FloatArray) -> bool:
    """Tell a column that no name and no unit describes and that does nothing but count."""
    return said == Head("unknown") and not names_a_path(name) and counts(values)


def _rises(values: FloatArray) -> bool:
    """Tell whether values are as those of stations, of which some may be twice there, or damaged."""
    there = values[np.isfinite(values)]
    steps = np.diff(there)
    return bool(steps.size and (steps < 0).mean() <= VOCABULARY.falling and (steps > 0).mean() > 0.5)

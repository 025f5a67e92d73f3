"""Numbers that stand for a missing elevation: -9999, -999.25 and the like, which stand out far from all others."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf.roughness.formats.base import METRES


class Sentinel(NamedTuple):
    """A value that is hardly an elevation."""

    value: float  # as it is in the profile [m]
    number: int  # how often it is there, on all paths
    off: float  # how far it is from the elevation nearest to it [m]
    first: int  # number of the first station with it


@dataclass(frozen=True, slots=True, kw_only=True)
class Standing:
    """How far a value, or a step between stations, must stand out; in brackets, where each number is safe."""

    # Times the largest step between stations of everything else: kerbs, potholes, humps and their neighbours differ
    # by one step, and a marker by hundreds [3 to 100].
    steps: float = 10.0
    # What is this far from all other elevations [m] is none, whatever its digits [10 to 100].
    height: float = 50.0
    # Markers as they are written: nines alone, those of log files, the ends of whole numbers.
    markers: re.Pattern[str] = re.compile(r"9{3,}(\.9+)?|999\.25|3276[78]|65535|214748364[78]")
    # Those that a pothole may have too: they count where they stand at several places.
    short: re.Pattern[str] = re.compile(r"99(\.9+)?")
    most: int = 4  # different markers that are looked for on one path, low and high [a convention]
    # Times the step that nearly all do not exceed, from which on stations are missing: survey by hand has twice, a
    # logger that drops points three times [3 to 20].
    hole: float = 5.0
    # Share of the steps that are nearly all: where more are long, the profile is meant so, as tracks of GPS and
    # shapes with dense edges are [0.8 to 0.95].
    nearly_all: float = 0.9
    most_put: int = 4  # stations put into holes at most, times those of the file: memory does not matter [1 to 10]


STANDING = Standing()


def sentinels(elevations: FloatArray) -> list[Sentinel]:
    """Find the values that stand for a missing elevation.

    A value counts that is among the lowest or the highest of a path, stands out from all others by many times their
    largest step, and either is written like a marker in some unit of length or lies beyond any road.

    Parameters
    ----------
    elevations : ndarray, shape (distance,) or (distance, path)
        Elevations [m], nan where the file says that there is none.

    Returns
    -------
    list of Sentinel
        The most frequent first; empty where every value may be an elevation.

    Examples
    --------
    >>> sentinels(np.array([0.0, 0.01, -9999.0, 0.02, 0.01, -9999.0, 0.0]))
    [Sentinel(value=-9999.0, number=2, off=9999.0, first=2)]
    """
    found: dict[float, Sentinel] = {}
    for column in elevations.reshape(len(elevations), -1).T:
        for one in _of_path(column):
            known = found.get(one.value, one._replace(number=0))
            found[one.value] = Sentinel(
                one.value, known.number + one.number, min(known.off, one.off), min(known.first, one.first)
            )
    return sorted(found.values(), key=lambda each: -each.number)


def _of_path(column: FloatArray) -> list[Sentinel]:
    there = column[np.isfinite(column)]
    # The lowest and the highest values, each with what lies between it and the next one towards the middle.
    ends = _lowest(there) + [(-value, off) for value, off in _lowest(-there)]
    candidates = [
        value for value, off in ends if off > STANDING.height or _is_marker(value) or _again(column, value)
    ]
    rest = there[~np.isin(there, candidates)]
    if there.size > 1 and not np.ptp(there) and _is_marker(there[0]):  # nothing else is there
        value, first = float(there[0]), int(np.flatnonzero(column == there[0])[0])
        return [Sentinel(value, there.size, abs(value), first)]
    if rest.size < 2:
        return []
    step = float(np.abs(np.diff(rest)).max())
    found = []
    for value in candidates:
        off, places = float(np.abs(rest - value).min()), np.flatnonzero(column == value)
        if off > STANDING.steps * step:
            found.append(Sentinel(value, places.size, off, int(places[0])))
    return found


def _lowest(values: FloatArray) -> list[tuple[float, float]]:
    """Find the lowest different values, of few the lower half, each with how far the next one is above it."""
    lowest: list[float] = []
    while values.size and len(lowest) <= STANDING.most:
        lowest.append(float(values.min()))
        values = values[values > lowest[-1]]
    lower = lowest if values.size else lowest[: len(lowest) // 2 + 1]
    return [(one, above - one) for one, above in pairwise(lower)]


def _is_marker(value: float) -> bool:
    """Whether a value is written like a marker, in metres or in whatever unit the file has."""
    return any(map(STANDING.markers.fullmatch, _written(value, METRES.values())))


def _again(column: FloatArray, value: float) -> bool:
    """Whether a value below zero is written like a marker of two digits, and stands at several places."""
    short = value < 0 and any(map(STANDING.short.fullmatch, _written(value, (1.0, 1e-3))))
    return short and int(np.count_nonzero(np.diff(column == value, prepend=False, append=False))) > 2


def _written(value: float, units: Iterable[float]) -> Iterator[str]:
    """Write a value in units of length [m], without its sign."""
    return (f"{abs(value) / metres:.6f}".rstrip("0").rstrip(".") for metres in {*units})

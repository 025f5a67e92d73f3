"""Files of named arrays: which of them are the stations, and which the elevations."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import option
from movingfrf.roughness.formats.base import ColumnKey, RawProfile, chosen_columns, metres, scaled


@dataclass(frozen=True, slots=True, kw_only=True)
class ArrayNames:
    """What the package itself calls the arrays that it writes."""

    stations: str = "distance"
    elevations: str = "elevation"
    across: str = "across"


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


def raw_profile(arrays: Mapping[str, Array], columns: Sequence[ColumnKey] | None, kind: str) -> RawProfile:
    """Make a raw profile of the arrays in a file.

    Parameters
    ----------
    arrays : mapping of str to Array
        Arrays of real numbers, by name.
    columns : sequence of str or int, optional
        Names of the stations and of the elevations; found by themselves where only one choice is possible.
    kind : str
        What kind of file it is, for the message.

    Returns
    -------
    RawProfile
        In metres.

    Raises
    ------
    ValueError
        If the arrays cannot be told apart, or do not fit each other; with what there is.
    """
    names = list(arrays)
    there = "; ".join(f"{name!r} {' by '.join(map(str, a.shape))}" for name, a in list(arrays.items())[:12])
    if columns is not None:
        picked = [names[n] for n in chosen_columns(names, columns)]
        if len(picked) < 2:
            raise ValueError(f"{option('columns')} must name the stations and at least one array of elevations")
    else:
        picked = _recognised(arrays)
        if not picked:
            raise ValueError(
                f"holds no arrays that are clearly stations and elevations: {there or 'nothing at all'}; name them "
                f"by {option('columns')}"
            )
    stations = arrays[picked[0]].load().ravel()
    parts = [_by_station(arrays[name].load(), stations.size, name) for name in picked[1:]]
    scales = [metres(arrays[name].unit or "m", repr(name)) for name in picked]
    stated = {arrays[name].unit or "metres, since no unit is given" for name in picked}
    elevations = np.concatenate([scaled(part, s) for part, s in zip(parts, scales[1:], strict=True)], axis=1)
    across = (
        arrays[ARRAY_NAMES.across].load().ravel()
        if ARRAY_NAMES.across in arrays and picked[1:] == [ARRAY_NAMES.elevations]
        else None
    )
    return RawProfile(
        scaled(stations, scales[0]),
        elevations,
        f"{kind} with stations {picked[0]!r} and elevations {', '.join(map(repr, picked[1:]))} in "
        f"{', '.join(sorted(stated))}",
        across=across,
        place=lambda row: f"value {row + 1}",
        same_across=len(picked) == 2 and arrays[picked[1]].is_vector and len(arrays[picked[1]].shape) < 3,
    )


def _recognised(arrays: Mapping[str, Array]) -> list[str]:
    """Names of stations and elevations where only one choice is possible; else none."""
    if ARRAY_NAMES.stations in arrays and ARRAY_NAMES.elevations in arrays:
        return [ARRAY_NAMES.stations, ARRAY_NAMES.elevations]
    long = {name: array for name, array in arrays.items() if array.length >= 4}  # stations that a profile takes
    increasing = [name for name, a in long.items() if a.is_vector and bool((np.diff(a.load().ravel()) > 0).all())]
    others = [name for name in long if name not in increasing]
    return [*increasing, *others] if len(increasing) == len(others) == 1 else []


def _by_station(values: FloatArray, count: int, name: str) -> FloatArray:
    """Arrange elevations with one row per station."""
    values = values.reshape(-1, 1) if values.ndim < 2 or 1 in values.shape else values
    if values.ndim == 2 and values.shape[0] == count:
        return values
    if values.ndim == 2 and values.shape[1] == count:
        return values.T
    raise ValueError(f"has {count} stations, but {name!r} has the shape {values.shape}")

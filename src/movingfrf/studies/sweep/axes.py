"""What of a scenario varies: axes, the values along them, and the cases that they span."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from numbers import Real
from typing import Any

import numpy as np

from movingfrf._basics.checks import shown
from movingfrf.scenarios.variants import plain
from movingfrf.studies.sweep.design import Design


@dataclass(frozen=True, slots=True, kw_only=True)
class Axis:
    """Keys that vary together.

    Parameters
    ----------
    paths : tuple of str
        Where each key stands in the scenario: `vehicle.tyre_stiffness.0`, or a whole table.
    values : tuple of tuple
        What each key is at each place along the axis.
    name : str
        What the axis is called; empty: as its first key.
    """

    paths: tuple[str, ...]
    values: tuple[tuple[Any, ...], ...]
    name: str = ""

    @property
    def size(self) -> int:
        """Places along it."""
        return len(self.values)

    def at(self, place: int) -> dict[str, Any]:
        """Values of the keys at a place."""
        return dict(zip(self.paths, self.values[place], strict=True))

    def along(self, path: str) -> list[Any]:
        """Values of one key along the axis."""
        number = self.paths.index(path)
        return [each[number] for each in self.values]


class Axes(tuple[Axis, ...]):
    """All axes of a sweep, in the order in which they were given."""

    __slots__ = ()

    @property
    def told(self) -> list[dict[str, Any]]:
        """All of it in numbers, texts, lists and tables."""
        return [
            {"paths": [*axis.paths], "values": [[*each] for each in axis.values], "name": axis.name}
            for axis in self
        ]

    @classmethod
    def of_told(cls, told: list[dict[str, Any]]) -> Axes:
        """Take what `told` says."""
        return cls(
            Axis(paths=tuple(one["paths"]), values=tuple(map(tuple, one["values"])), name=one["name"])
            for one in told
        )

    @property
    def shape(self) -> tuple[int, ...]:
        """Places along each."""
        return tuple(axis.size for axis in self)

    @property
    def cases(self) -> int:
        """How many cases there are."""
        return math.prod(self.shape)

    @property
    def paths(self) -> list[str]:
        """All keys."""
        return [path for axis in self for path in axis.paths]

    @property
    def names(self) -> dict[str, str]:
        """Names of the keys: the last word of the path, or the whole path where others are called the same."""
        last = {
            path: next(word for word in reversed(path.split(".")) if not word.isdecimal()) for path in self.paths
        }
        words = list(last.values())
        return {path: word if words.count(word) == 1 else path for path, word in last.items()}

    @property
    def dimensions(self) -> tuple[str, ...]:
        """What each axis is called: as its first key."""
        names = self.names
        return tuple(axis.name or names[axis.paths[0]] for axis in self)

    def _order(self) -> list[int]:
        """Numbers of the axes in the order in which cases are solved: what is dear changes least often."""
        # Tables whose values take longest to be made, or to meet each other.
        dear_ones = ("roughness", "guideway", "run")

        def dear(number: int) -> tuple[int, int]:
            tables = {path.split(".")[0] for path in self[number].paths}
            return min(dear_ones.index(name) if name in dear_ones else len(dear_ones) for name in tables), number

        return sorted(range(len(self)), key=dear)

    def numbers(self, first: int, last: int) -> Iterator[tuple[int, ...]]:
        """Go through some of the cases in the order in which they are solved: the place along each axis."""
        order = self._order()
        shape = tuple(self.shape[axis] for axis in order)
        for case in range(first, last):
            places = dict(zip(order, np.unravel_index(case, shape), strict=True)) if order else {}
            yield tuple(int(places[axis]) for axis in range(len(self)))

    def values(self, places: Sequence[int]) -> dict[str, Any]:
        """Values of all keys at places along the axes."""
        return {
            path: value for axis, place in zip(self, places, strict=True) for path, value in axis.at(place).items()
        }


def axes_of(given: Mapping[Any, Any] | Design) -> Axes:
    """Understand axes.

    Parameters
    ----------
    given : mapping of str, or tuple of str, to sequence, or Design
        Values by the path of a key, or of keys that vary together; or samples.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ValueError
        If it is no mapping, an axis has no values or values of different kinds, or a key stands twice.

    Examples
    --------
    >>> axles = "vehicle.axles.0", "vehicle.axles.1"
    >>> axes = axes_of({"run.speed": [10.0, 20.0], axles: [(2.0, -2.0), (3.0, -1.0)]})
    >>> axes.shape, axes.dimensions
    ((2, 2), ('speed', 'vehicle.axles.0'))
    """
    if isinstance(given, Design):
        return Axes([Axis(paths=given.paths, values=tuple(map(tuple, given.values.tolist())), name="sample")])
    if not isinstance(given, Mapping):
        raise ValueError(f"axes must be a mapping from keys of the scenario to their values, got {shown(given)}")
    axes = Axes(_axis(key, values) for key, values in given.items())
    seen: set[str] = set()
    for path in axes.paths:
        if path in seen:
            raise ValueError(f"{path} varies twice: a key stands in one axis")
        above = [other for other in seen if path.startswith(f"{other}.") or other.startswith(f"{path}.")]
        if above:
            raise ValueError(f"{path} and {above[0]} exclude each other: one is part of the other")
        seen.add(path)
    return axes


def _axis(key: Any, values: Any) -> Axis:
    """Understand one axis."""
    linked = isinstance(key, tuple)
    paths = key if linked else (key,)
    if not paths or not all(isinstance(path, str) and all(path.split(".")) for path in paths):
        raise ValueError(f"an axis must be named by the path of a key, as 'run.speed', got {shown(key)}")
    said = " and ".join(paths)
    if isinstance(values, str | Mapping) or not hasattr(values, "__iter__"):
        raise ValueError(f"{said} must have a list of values, got {shown(values)}")
    each = [plain(value) for value in values]
    if not each:
        raise ValueError(f"{said} must have a value at least, got none")
    if linked:
        bad = next((value for value in each if not isinstance(value, list) or len(value) != len(paths)), None)
        if bad is not None:
            raise ValueError(f"{said} must have {len(paths)} values at each place, got {shown(bad)}")
    columns = [list(column) for column in zip(*each, strict=True)] if linked else [each]
    for path, column in zip(paths, columns, strict=True):
        _require_alike(path, column)
    return Axis(paths=tuple(paths), values=tuple(zip(*columns, strict=True)))


def _require_alike(path: str, values: Sequence[Any]) -> None:
    """Refuse values of different kinds, and numbers that are none."""

    def kind(value: Any) -> str:
        if isinstance(value, bool):
            return "a truth value"
        if isinstance(value, Real):
            return "a number"
        kinds = {"a text": str, "a table": dict, "a list": list}
        return next((words for words, one in kinds.items() if isinstance(value, one)), "something else")

    kinds = dict.fromkeys(kind(value) for value in values)
    if len(kinds) > 1 and set(kinds) != {"a text", "a table"}:
        raise ValueError(f"{path} must have values of one kind, got {' and '.join(kinds)}")
    if "something else" in kinds:
        raise ValueError(f"{path} must have numbers, texts or tables as values, got {shown(values[0])}")
    if any(isinstance(value, Real) and math.isnan(value) for value in values):
        raise ValueError(f"{path} must have numbers, got nan")

"""What an entry in the list of measures is, and what measures are taken of: a result over time, or random."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.peaks import extremes
from movingfrf.metrics.comfort import (
    WEIGHTING_OF,
    WEIGHTINGS,
    Comfort,
    felt,
    weighted_rows,
)
from movingfrf.metrics.fatigue import spectral_fatigue
from movingfrf.metrics.loads import (
    ContactLoss,
    after,
    common_points,
    contact_loss,
    load_coefficient,
    road_stress_factor,
    road_wear,
    samples_before,
)
from movingfrf.results.labels import Measure

if TYPE_CHECKING:
    import xarray as xr


# From histories (time, *s) to numbers (*s).
Measuring = Callable[[FloatArray], FloatArray]


def rms(values: FloatArray) -> FloatArray:
    """Root mean square, (time, *s) to (*s)."""
    return np.sqrt(np.mean(np.square(values), axis=0))


def lowest(values: FloatArray) -> FloatArray:
    """Smallest value, (time, *s) to (*s), between samples too."""
    return extremes(values.T)[0].T


def peak(values: FloatArray) -> FloatArray:
    """Largest magnitude, (time, *s) to (*s), between samples too."""
    low, high = extremes(values.T)
    return np.maximum(high, -low).T


class Place(NamedTuple):
    """A contact, a path or a degree of freedom: its name, and what stands for the words in braces of an entry."""

    name: str
    words: Mapping[str, str] = {}


class Arrays(dict[str, Any]):
    """Variables of a result without their labels, taken as they are asked for."""

    def __init__(self, result: xr.Dataset) -> None:
        super().__init__()
        self._result = result

    def __missing__(self, name: str) -> Any:
        """Take a variable."""
        self[name] = self._result[name].values
        return self[name]


@dataclass(frozen=True, kw_only=True, eq=False)
class History:
    """The response of a vehicle over time, and what is asked about it; what several measures need is found once."""

    arrays: Mapping[str, Any]  # variables by name, (time, place) or (place,)
    step: float  # of the record [s]
    labelled: xr.Dataset | None = None  # the same as a result, which other than the usual measures take
    weighting: str = "Wk"  # of translations
    slope: float | None = None  # exponent of an S-N curve
    since: float = 0.0  # what is left out at the start [s]
    judged: bool = False  # whether people are where the degrees of freedom are

    @classmethod
    def of(cls, result: xr.Dataset, **asked: Any) -> History:
        """Take a result, and what is asked about it."""
        return cls(arrays=Arrays(result), step=float(result.attrs["time_step"]), labelled=result, **asked)

    @property
    def whole(self) -> xr.Dataset:
        """The response as a result."""
        assert self.labelled is not None, "a measure that needs labels is not one of the usual ones"
        return self.labelled

    @cached_property
    def first(self) -> int:
        """How many samples are left out at the start."""
        return samples_before(self.since, self.step, len(self.arrays["acceleration"])) if self.since else 0

    @cached_property
    def result(self) -> xr.Dataset:
        """The result without the first seconds."""
        return after(self.whole, self.since)

    @cached_property
    def coefficients(self) -> FloatArray:
        """Dynamic load coefficients, shape (contact,)."""
        return load_coefficient(self.measured(rms, "contact_force"), self.arrays["static_load"])

    @cached_property
    def stress(self) -> FloatArray:
        """Road stress factors, shape (contact,)."""
        return road_stress_factor(self.coefficients)

    @cached_property
    def loss(self) -> ContactLoss:
        """For how long each contact bears nothing."""
        return contact_loss(self.result)

    @cached_property
    def wear(self) -> FloatArray:
        """Aggregate force over the static one, shape (path,); nan where no point of the road meets all contacts."""
        paths = np.unique(self.result.path.values)
        return road_wear(self.result) if common_points(self.result).size else np.full(paths.size, np.nan)

    @cached_property
    def _weighted(self) -> dict[int, FloatArray]:
        return {}

    @cached_property
    def _felt(self) -> dict[int, Comfort]:
        return {}

    @cached_property
    def _measured(self) -> dict[tuple[Measuring, str], FloatArray]:
        return {}

    def measured(self, measure: Measuring, variable: str) -> FloatArray:
        """Measure a variable at all places at once, (time, place) to (place,), once."""
        if (measure, variable) not in self._measured:
            self._measured[measure, variable] = measure(self.arrays[variable][self.first :])
        return self._measured[measure, variable]

    def weighted(self, dof: int) -> FloatArray:
        """Weight an acceleration before it is cut; where all are asked for, with those beside it."""
        if dof not in self._weighted:
            rows, together = self.arrays["acceleration"].T, 8  # channels at a time [1 to 64: memory and time only]
            first = dof - dof % together
            some = [dof] if self.judged else list(range(first, min(first + together, len(rows))))
            names = [self.place("dof", one).words["weighting"] for one in some]
            found = weighted_rows(rows[some], self.step, names)[:, self.first :]
            self._weighted.update(zip(some, found, strict=True))
        return self._weighted[dof]

    def felt(self, dof: int) -> Comfort:
        """Make of an acceleration what ISO 2631-1 makes of it."""
        if dof not in self._felt:
            weighting = self.place("dof", dof).words["weighting"]
            self._felt[dof] = felt(self.weighted(dof), self.step, weighting)
        return self._felt[dof]

    def value(self, variable: str, number: int) -> float:
        """Value of a variable at a contact or a degree of freedom."""
        return float(self.arrays[variable][number])

    def column(self, variable: str, number: int) -> FloatArray:
        """History of a variable at a contact or a degree of freedom."""
        history: FloatArray = self.arrays[variable][self.first :, number]
        return history

    def place(self, kind: str, number: int) -> Place:
        """Name a contact, a path or a degree of freedom."""
        if kind == "path":
            return Place(f"path {np.unique(self.result.path.values)[number]}")
        if kind == "contact":
            return Place(f"contact {number}")
        unit = str(self.arrays["dof_unit"][number])
        weighting = self.weighting if unit == "m" else "We"
        by = f"{WEIGHTINGS[weighting].standard}, {weighting}"
        return Place(str(self.arrays["dof"][number]), {"unit": unit, "weighting": weighting, "by": by})


@dataclass(frozen=True, kw_only=True, eq=False)
class Random:
    """The response to a random road, and what is asked about it."""

    result: xr.Dataset
    slope: float | None = None  # exponent of an S-N curve

    @cached_property
    def equivalent(self) -> FloatArray | None:
        """Steady amplitude as damaging as each contact force [N], shape (contact,); None if not asked for."""
        if self.slope is None:
            return None
        damage: FloatArray = spectral_fatigue(self.result, "contact_force", slope=self.slope).values
        return damage ** (1 / self.slope)

    def value(self, variable: str, number: int) -> float:
        """Value of a variable at a contact or a degree of freedom."""
        return float(self.result[variable].values[number])

    def place(self, kind: str, number: int) -> Place:
        """Name a contact or a degree of freedom."""
        if kind == "contact":
            return Place(f"contact {number}")
        unit = str(self.result.dof_unit.values[number])
        return Place(str(self.result.dof.values[number]), {"unit": unit, "weighting": WEIGHTING_OF[unit]})


class OfHistory(NamedTuple):
    """How a measure is taken of a history; words in braces are those of the place."""

    name: str
    value: Callable[[History, int], float | None]  # at the number of a place; None if it is not asked for
    by: str = ""  # the standard or the source that defines it, where the name alone does not
    note: Callable[[History, int], str] = lambda of, number: ""  # what the source makes of it, or why there is none
    usual: str = ""  # what tables of many cases call it, if `run` reports it; `measure` alone reports others


class OfRandom(NamedTuple):
    """How a measure is taken of the response to a random road."""

    name: str
    value: Callable[[Random, int], float | None]
    by: str = ""
    quantity: str = ""  # that of its table unless it says otherwise


class Entry(NamedTuple):
    """A measure: its unit, and how it is taken of a history, of a random response, or of both."""

    units: str
    history: OfHistory | None = None
    random: OfRandom | None = None


class Table(NamedTuple):
    """Measures of one quantity: a row of a report for each contact, path or degree of freedom."""

    place: str  # what the rows are: contact, path or dof
    quantity: str
    captions: Mapping[str, str]  # of histories, by quantity; with `angular` before it for a rotation
    random_captions: Mapping[str, str]
    entries: Sequence[Entry]

    def of_history(self, history: History, number: int, *, usual: bool = False) -> list[Measure]:
        """Take all measures of a history at one place, or the usual ones."""
        place = history.place(self.place, number)
        return [
            _measure(place, self.quantity, entry.units, taken, value, taken.note(history, number))
            for entry in self.entries
            if (taken := entry.history) and (taken.usual or not usual)
            if (value := taken.value(history, number)) is not None
        ]

    def of_random(self, random: Random, number: int) -> list[Measure]:
        """Take all measures of a random response at one place."""
        place = random.place(self.place, number)
        return [
            _measure(place, taken.quantity or self.quantity, entry.units, taken, value)
            for entry in self.entries
            if (taken := entry.random) and (value := taken.value(random, number)) is not None
        ]


def _measure(
    place: Place, quantity: str, units: str, taken: OfHistory | OfRandom, value: float, note: str = ""
) -> Measure:
    name, units, by = (text.format(**place.words) for text in (taken.name, units, taken.by))
    return Measure(f"{place.name} {quantity}", name, float(value), units, by, note)

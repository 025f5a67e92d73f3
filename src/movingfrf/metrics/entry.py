"""What an entry in the list of measures is, and what measures are taken of: a result over time, or random."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf.metrics.comfort import (
    WEIGHTING_OF,
    WEIGHTINGS,
    Comfort,
    felt,
    weighted,
)
from movingfrf.metrics.fatigue import spectral_fatigue
from movingfrf.metrics.loads import (
    ContactLoss,
    after,
    common_points,
    contact_loss,
    dynamic_load_coefficient,
    road_stress_factor,
    road_wear,
    samples_before,
)
from movingfrf.results.labels import Measure

if TYPE_CHECKING:
    import xarray as xr


class Place(NamedTuple):
    """A contact, a path or a degree of freedom: its name, and what stands for the words in braces of an entry."""

    name: str
    words: Mapping[str, str] = {}


@dataclass(frozen=True, kw_only=True, eq=False)
class History:
    """The response of a vehicle over time, and what is asked about it; what several measures need is found once."""

    whole: xr.Dataset
    weighting: str = "Wk"  # of translations
    slope: float | None = None  # exponent of an S-N curve
    since: float = 0.0  # what is left out at the start [s]
    judged: bool = False  # whether people are where the degrees of freedom are

    @cached_property
    def step(self) -> float:
        """Step of the record [s]."""
        return float(self.whole.attrs["time_step"])

    @cached_property
    def result(self) -> xr.Dataset:
        """The result without the first seconds."""
        return after(self.whole, self.since)

    @cached_property
    def coefficients(self) -> FloatArray:
        """Dynamic load coefficients, shape (contact,)."""
        return dynamic_load_coefficient(self.result)

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

    def weighted(self, dof: int) -> FloatArray:
        """Weight an acceleration before it is cut."""
        if dof not in self._weighted:
            acceleration = self.whole.acceleration.values[:, dof]
            first = samples_before(self.since, self.step, acceleration.size)
            weighting = self.place("dof", dof).words["weighting"]
            self._weighted[dof] = weighted(acceleration, self.step, weighting)[first:]
        return self._weighted[dof]

    def felt(self, dof: int) -> Comfort:
        """Make of an acceleration what ISO 2631-1 makes of it."""
        if dof not in self._felt:
            weighting = self.place("dof", dof).words["weighting"]
            self._felt[dof] = felt(self.weighted(dof), self.step, weighting)
        return self._felt[dof]

    @cached_property
    def _arrays(self) -> dict[str, FloatArray]:
        return {}

    def _array(self, variable: str) -> FloatArray:
        """Take a variable without its labels, once."""
        if variable not in self._arrays:
            self._arrays[variable] = self.result[variable].values
        return self._arrays[variable]

    def value(self, variable: str, number: int) -> float:
        """Value of a variable at a contact or a degree of freedom."""
        return float(self._array(variable)[number])

    def column(self, variable: str, number: int) -> FloatArray:
        """History of a variable at a contact or a degree of freedom."""
        return self._array(variable)[:, number]

    def place(self, kind: str, number: int) -> Place:
        """Name a contact, a path or a degree of freedom."""
        if kind == "path":
            return Place(f"path {np.unique(self.result.path.values)[number]}")
        if kind == "contact":
            return Place(f"contact {number}")
        unit = str(self.whole.dof_unit.values[number])
        weighting = self.weighting if unit == "m" else "We"
        by = f"{WEIGHTINGS[weighting].standard}, {weighting}"
        return Place(str(self.whole.dof.values[number]), {"unit": unit, "weighting": weighting, "by": by})


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

"""How the cases of a sweep may be solved, and what is measured of each."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cache
from typing import TYPE_CHECKING, NamedTuple

from movingfrf._basics.arrays import FloatArray
from movingfrf.metrics.measures import Usual, statistics, statistics_of, usual, usual_of
from movingfrf.scenarios.scenario import Scenario

if TYPE_CHECKING:
    import xarray as xr


class Way(NamedTuple):
    """One way to solve a case."""

    solve: Callable[[Scenario], xr.Dataset]
    measures: dict[str, Usual]
    taken: Callable[[xr.Dataset, Iterable[str]], dict[str, FloatArray]]  # measures of a result, by name


@cache
def ways() -> dict[str, Way]:
    """Give all ways, by the name that `sweep` takes as `response`."""
    return {
        "simulate": Way(Scenario.run, usual(), usual_of),
        "random": Way(Scenario.at_random, statistics(), statistics_of),
    }

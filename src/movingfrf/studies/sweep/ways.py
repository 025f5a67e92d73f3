"""How the cases of a sweep may be solved, and what is measured of each."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import cache, partial
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf.metrics.entry import History
from movingfrf.metrics.measures import Usual, statistics, statistics_of, usual, usual_of
from movingfrf.response.ride import in_steps_of_the_band, ride
from movingfrf.scenarios.scenario import Drive, Scenario
from movingfrf.scenarios.stepped import require_endless


class Answer(NamedTuple):
    """A solved case."""

    measured: Callable[[Iterable[str]], dict[str, FloatArray]]  # measures by name, (contact,) or (dof,)
    findings: list[str]  # codes of what is to be known about it
    time_step: float  # of what was measured [s]; nan where there is none


class Way(NamedTuple):
    """One way to solve a case."""

    solve: Callable[[Scenario, Drive, bool], Answer]  # in steps that are stated, or those of the band
    measures: dict[str, Usual]


@cache
def ways() -> dict[str, Way]:
    """Give all ways, by the name that `sweep` takes as `response`."""
    return {"simulate": Way(_ridden, usual()), "random": Way(_at_random, statistics())}


def _ridden(scenario: Scenario, drive: Drive, stated: bool) -> Answer:
    """Solve as `run` does, without labels."""
    profile, vehicle = drive.road.profile, drive.vehicle
    if not stated:
        drive = replace(drive, journey=in_steps_of_the_band(profile, drive.journey))
    found = ride(require_endless(drive.guideway, instead="cdfm"), vehicle, profile, drive.journey)
    step = drive.journey.time_step
    records = {name: values.T for name, values in found.records(found.fine).items()}
    steady = {"static_load": found.steady.load, "static_deflection": found.steady.deflection}
    history = History(arrays={**records, **steady, **vehicle.coordinates}, step=step / found.finer)
    codes = [finding.code for finding in (*found.findings, *drive.unusual)]
    return Answer(partial(usual_of, history), codes, step)


def _at_random(scenario: Scenario, drive: Drive, stated: bool) -> Answer:
    """Solve for all roads of the spectrum."""
    result = scenario.at_random()
    codes = [str(one["code"]) for one in json.loads(result.attrs["findings"])]
    return Answer(partial(statistics_of, result), codes, np.nan)

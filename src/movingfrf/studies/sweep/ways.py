"""How the cases of a sweep may be solved, and what is measured of each."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import cache, partial
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import checking
from movingfrf.metrics.entry import History
from movingfrf.metrics.measures import Usual, statistics, usual, usual_of
from movingfrf.response.random import checked_coherence, stationary
from movingfrf.response.ride import in_steps_of_the_band, ride
from movingfrf.scenarios.scenario import Drive
from movingfrf.scenarios.stepped import require_endless


class Answer(NamedTuple):
    """A solved case."""

    measured: Callable[[Iterable[str]], dict[str, FloatArray]]  # measures by name, (contact,) or (dof,)
    findings: list[str]  # codes of what is to be known about it
    time_step: float  # of what was measured [s]; nan where there is none
    histories: Callable[[], dict[str, FloatArray]] = dict  # by name, (time, contact) or (time, dof)


class Way(NamedTuple):
    """One way to solve a case."""

    solve: Callable[[Drive, bool], Answer]  # in steps that are stated, or those of the band
    measures: dict[str, Usual]


@cache
def ways() -> dict[str, Way]:
    """Give all ways, by the name that `sweep` takes as `response`."""
    return {"simulate": Way(_ridden, usual()), "random": Way(_at_random, statistics())}


def _ridden(drive: Drive, stated: bool) -> Answer:
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
    return Answer(partial(usual_of, history), codes, step, found.turned)


def _at_random(drive: Drive, stated: bool) -> Answer:
    """Solve for all roads of the spectrum, without labels."""
    guideway, vehicle = require_endless(drive.guideway, instead="cdfm"), drive.vehicle
    with checking() as check:
        coherence = checked_coherence(check, drive.road.coherence, len(set(vehicle.paths)))
    found = stationary(guideway, vehicle, drive.spectrum, speed=drive.journey.speed, coherence=coherence)
    codes = [finding.code for finding in (*found.findings, *drive.of_random_roads)]
    return Answer(lambda names: {name: found.statistics[name] for name in names}, codes, np.nan)

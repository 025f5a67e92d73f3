"""A hump, a flat road, a vehicle whose dashpots matter, a road that travels along."""

from __future__ import annotations

import numpy as np

import movingfrf as mf
from tests.helpers import (
    DAMPED,
    QUARTER_TRUCK,
    VEHICLES,
)

TRACK = DAMPED["euler_bernoulli_winkler"]

HUMP = mf.bump(height=0.01, width=3.0, at=3.0, length=90.0, start=-40.0)

FLAT = mf.Profile(np.linspace(-100.0, 5000.0, 6), np.zeros(6))

# A vehicle whose dashpots matter: 40 times those of the reference tyres.
DASHPOT = mf.quarter_car(**(QUARTER_TRUCK | {"tyre_damping": 8.0e4}))


def travelling(element, half=40.0, absorbing=30.0, track=TRACK, **more):
    return mf.finite_track(
        track, first=-half, last=half, element=element, travels=True, absorbing=absorbing, **more
    )


def over_hump(road, vehicle="half_truck", method=mf.cdfm, **more):
    options = {"speed": 10.0, "duration": 1.5, "blend": 0.0} | more
    return method(road, VEHICLES[vehicle] if isinstance(vehicle, str) else vehicle, HUMP, **options)

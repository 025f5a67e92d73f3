"""A plate two metres wide, a car on it, and how it is struck."""

from __future__ import annotations

import numpy as np

import movingfrf as mf
from tests.helpers import FULL_TRUCK

# Two metres of the reference road, damped so strongly that what is struck is at rest after a third of a second.
WIDTH = 2.0

BENDING, MASS, STIFFNESS = 1.573e7, 711.9, 8.0e6  # per metre of width

TRACK = mf.track(
    mf.EulerBernoulliBeam(bending_stiffness=WIDTH * BENDING, mass=WIDTH * MASS),
    mf.Spring(stiffness=WIDTH * STIFFNESS, damping=WIDTH * 1.0e5),
)

# Wheels at nodes; tyres whose dashpots matter.
CAR = mf.full_car(**(FULL_TRUCK | {"sides": (0.5, -0.5), "tyre_damping": (4.0e4, 5.0e4)}))


def plate(track=TRACK, width=WIDTH, half=20.0, element=0.25, across=4, **more):
    return mf.finite_plate(
        track, **({"width": width, "first": -half, "last": half, "element": element, "across": across} | more)
    )


# Between the wheels of the car; struck once for all tests below.
AXLES = float(np.ptp(CAR.positions))

BETWEEN_WHEELS = [(ahead, side, 0.5) for side in (0.5, -0.5) for ahead in (0.0, AXLES, -AXLES)]


def strike(places, speed, road=None, **more):
    """Strike a plate with absorbing ends for some (ahead, receiver across, source across)."""
    ahead, receiver, source = np.array(places).T
    options = {"strike": 0.0, "time_step": 2.5e-4, "scheme": "generalised_alpha"} | more
    return mf.moving_impulse_response(
        plate(absorbing=12.0) if road is None else road,
        speed=speed,
        offsets=ahead,
        across=receiver - source,
        strike_across=source,
        **options,
    )


HUMPS = mf.Profile(
    np.linspace(-40.0, 60.0, 1001),
    np.stack(
        [
            np.ravel(
                mf.bump(height=h, width=3.0, at=at, length=100.0, start=-40.0).along(0)(
                    np.linspace(-40.0, 60.0, 1001)
                )
            )
            for h, at in ((0.01, 3.0), (-0.006, 4.5))
        ],
        axis=1,
    ),
)

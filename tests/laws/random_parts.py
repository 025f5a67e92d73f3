"""A road, a spectrum, a car of four equal corners, and their random response."""

from __future__ import annotations

import movingfrf as mf
from tests.helpers import DAMPED, VEHICLES

ROAD, RIGID = DAMPED["euler_bernoulli_winkler"], mf.RigidGuideway()

GROUND = mf.IsoRoad.of_class("A", band=(0.02, 5.0))

ISOTROPIC = mf.IsotropicCoherence()

# Four equal corners: bounce, pitch and roll do not mix.
SYMMETRIC = {
    "body_mass": 1200.0,
    "pitch_inertia": 1800.0,
    "wheel_masses": (40.0, 40.0),
    "suspension_stiffness": (2.0e4, 2.0e4),
    "suspension_damping": (1.5e3, 1.5e3),
    "tyre_stiffness": (2.0e5, 2.0e5),
    "tyre_damping": (100.0, 100.0),
    "axles": (1.3, -1.3),
}

CAR = mf.full_car(**SYMMETRIC, roll_inertia=500.0, sides=(0.7, -0.7))


def respond(vehicle="half_truck", road=ROAD, spectrum=GROUND, *, speed=15.0, coherence=ISOTROPIC, **more):
    vehicle = VEHICLES[vehicle] if isinstance(vehicle, str) else vehicle
    return mf.random_response(road, vehicle, spectrum, speed=speed, coherence=coherence, **more)

"""Vehicles that several tests take apart, and the equations with constraints that they are held against."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import movingfrf as mf
from tests.helpers import (
    VEHICLES,
)

BOGIE = {
    "frame_mass": 2615.0,
    "frame_pitch_inertia": 1476.0,
    "wheelset_mass": 1813.0,
    "primary_stiffness": 2.4e6,
    "primary_damping": 8e3,
    "axle_spacing": 2.56,
}

OMEGA = np.r_[0.0, np.geomspace(0.5, 2000.0, 17)] - 0.3j

STEER = mf.Axle(
    position=2.0,
    mass=700.0,
    suspension_stiffness=4e5,
    suspension_damping=1e4,
    tyre_stiffness=1.75e6,
    tyre_damping=1e3,
)


DRIVE = mf.Axle(position=-1.5, mass=1100.0, suspension_stiffness=1e6, suspension_damping=2e4, tyre_stiffness=3.5e6)


TANDEM = mf.WalkingBeam(
    positions=(-7.4, -8.7),
    mass=1500.0,
    pitch_inertia=700.0,
    suspension_stiffness=1.6e6,
    suspension_damping=3e4,
    tyre_stiffness=3.5e6,
    tyre_damping=2e3,
)


TRACTOR = mf.Unit(
    mass=6000.0, pitch_inertia=2.0e4, position=0.3, axles=[STEER, DRIVE], roll_inertia=4e3, name="tractor"
)


TRAILER = mf.Unit(
    mass=20000.0, pitch_inertia=1.5e5, position=-5.0, axles=[TANDEM], roll_inertia=2e4, name="trailer"
)


HITCH = -1.2

# Manchester benchmark, PARAMETERS of the sources in the catalogue.
COACH = {
    "body_mass": 32e3,
    "body_pitch_inertia": 1.97e6,
    "bogie_mass": 2615.0,
    "bogie_pitch_inertia": 1476.0,
    "wheelset_mass": 1813.0,
    "primary_stiffness": 2.4e6,
    "primary_damping": 8e3,
    "secondary_stiffness": 8.6e5,
    "secondary_damping": 4e4,
    "bogie_spacing": 19.0,
    "axle_spacing": 2.56,
}


def constrained(mass, damping, stiffness, at, springs, dashpots, ties, omega):
    """Dynamic stiffness at the contacts, multipliers for `ties` (rows that stay zero) and for rigid contacts."""
    elastic = np.isfinite(springs)
    k = np.diag(np.where(elastic, springs, 0.0) + 1j * omega * dashpots)
    rows = np.where(elastic[:, None], at, 0.0)
    whole = -(omega**2) * mass + 1j * omega * damping + stiffness + rows.T @ k @ rows
    held = np.vstack([ties, at[~elastic]])
    count, contacts = len(held), len(at)
    system = np.block([[whole, held.T], [held, np.zeros((count, count))]])
    prescribed = np.zeros((count, contacts))
    prescribed[len(ties) :][:, ~elastic] = np.eye(int((~elastic).sum()))
    solution = np.linalg.solve(system, np.vstack([rows.T @ k, prescribed]))
    motion, multipliers = solution[: len(mass)], solution[len(mass) :]
    force = k - k @ rows @ motion
    # A multiplier pulls the vehicle up where it pushes the road down: the road pushes it by as much.
    force[~elastic] -= multipliers[len(ties) :]
    return force


def own(vehicle):
    springs, dashpots = (np.array([getattr(c, n) for c in vehicle.contacts]) for n in ("stiffness", "damping"))
    return *(np.asarray(a, float) for a in vehicle.matrices), springs, dashpots


def of(vehicle, omega=OMEGA):
    return np.moveaxis(vehicle.dynamics().stiffness(omega), -1, 0)


# Rigid contacts.


def rigid(vehicle, *numbers):
    contacts = [
        replace(contact, stiffness=np.inf, damping=0.0) if n in numbers else contact
        for n, contact in enumerate(vehicle.contacts)
    ]
    return replace(vehicle, contacts=contacts)


def plank():
    """Let both ends of a rigid plank under a sprung load follow the road: rows that share degrees of freedom."""
    return mf.Vehicle(
        mass=np.diag([1000.0, 400.0, 200.0]),
        damping=[[2e3, 0, -2e3], [0, 0, 0], [-2e3, 0, 2e3]],
        stiffness=[[1e5, 0, -1e5], [0, 0, 0], [-1e5, 0, 1e5]],
        contact_map=[[1.0, 1.2, 0.0], [1.0, -0.8, 0.0]],
        contacts=[mf.Contact(position=1.2, stiffness=np.inf), mf.Contact(position=-0.8, stiffness=np.inf)],
        vertical=[1, 0, 1],
        dof_names=["bounce", "pitch", "load"],
    )


RIGID = {
    "quarter truck": rigid(VEHICLES["quarter_truck"], 0),
    "one of two": rigid(VEHICLES["half_truck"], 1),
    "two of three": rigid(VEHICLES["three_axles"], 0, 2),
    "full truck": rigid(VEHICLES["full_truck"], 0, 1, 2, 3),
    "plank": plank(),
    "one end of the plank": replace(
        plank(), contacts=[plank().contacts[0], mf.Contact(position=-0.8, stiffness=3e5, damping=2e3)]
    ),
    "coach": mf.carriage(**COACH),
    "bogie": mf.bogie(**BOGIE),
    "wheelset": mf.wheelset(mass=1813.0),
    "train": mf.train(car=mf.carriage(**COACH), count=2, spacing=25.0),
}


def seat(**changed):
    given = {"mount": {"body": 1.0}, "driver_mass": 60.0, "cushion_stiffness": 3e4, "cushion_damping": 500.0}
    return mf.seated(VEHICLES["quarter_car"], **given | changed)

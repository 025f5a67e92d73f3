"""The cases that are timed: the reference case as `movingfrf new` writes it, what differs from it, and a train.

Each is a function that prepares it and returns what is timed. Guideways, vehicles and profiles are made once, as by
whoever solves many cases: what the package remembers of them is there from the second call on. Public names alone
are used, so that other checkouts can be timed on the same cases (`benchmarks.against`).
"""

from __future__ import annotations

import atexit
import shutil
import tempfile
import tomllib
from collections.abc import Callable
from copy import copy
from dataclasses import replace
from functools import cache, partial
from pathlib import Path

import numpy as np

import movingfrf as mf

SCENARIO = mf.read_scenario(
    Path(__file__).parents[1] / "src" / "movingfrf" / "scenarios" / "templates" / "scenario.toml"
)
TRUCK, ROAD = SCENARIO.case.vehicle, SCENARIO.case.road
JOURNEY = {
    name: getattr(SCENARIO.journey, name)
    for name in ("speed", "duration", "start", "time_step", "truncation", "blend")
}

PAVEMENT, SOIL = SCENARIO.guideway.beam, SCENARIO.guideway.foundation
RAIL = mf.EulerBernoulliBeam(bending_stiffness=6.42e6, mass=60.2)
PADS = mf.Spring(stiffness=3.0e8, damping=3.0e4)
BALLAST = mf.Spring(stiffness=1.0e8, damping=8.0e4)
GUIDEWAYS = {
    "euler_bernoulli": SCENARIO.guideway,
    "bending_damping": mf.track(replace(PAVEMENT, bending_damping=1.0e4), SOIL),
    "timoshenko_pasternak": mf.track(
        mf.TimoshenkoBeam(
            bending_stiffness=PAVEMENT.bending_stiffness,
            mass=PAVEMENT.mass,
            shear_stiffness=4.0e8,
            rotary_inertia=5.5,
        ),
        mf.ShearLayer(stiffness=SOIL.stiffness, damping=SOIL.damping, shear_stiffness=2.0e6),
    ),
    "two_layers": mf.track(RAIL, mf.OnMass(above=PADS, mass=250.0, below=BALLAST)),
    "three_layers": mf.track(
        RAIL,
        mf.OnMass(
            above=PADS,
            mass=250.0,
            below=mf.OnMass(above=mf.Spring(stiffness=2.0e8, damping=8.0e4), mass=1200.0, below=BALLAST),
        ),
    ),
}
CAR = mf.quarter_car(
    body_mass=400.0,
    wheel_mass=40.0,
    suspension_stiffness=2.0e4,
    suspension_damping=1.5e3,
    tyre_stiffness=2.0e5,
    tyre_damping=150.0,
)

# A train of sixteen coaches on rough track: 64 contacts, 160 degrees of freedom, content up to 100 Hz.
TRAIN_SPEED = 80.0
TRACK = mf.track(
    mf.EulerBernoulliBeam(bending_stiffness=1.284e7, mass=120.4),
    mf.OnMass(
        above=mf.Spring(stiffness=6.0e8, damping=6.0e4),
        mass=500.0,
        below=mf.Spring(stiffness=2.0e8, damping=1.6e5),
    ),
)
HERTZ = 2 * mf.hertzian_stiffness(75e3, wheel_radius=0.46)


@cache
def coaches(contact_stiffness: float) -> mf.Vehicle:
    """Repeat the Velaro coach of the catalogue sixteen times."""
    coach = mf.carriage(
        body_mass=47_800.0,
        body_pitch_inertia=1_957_888.0,
        bogie_mass=3500.0,
        bogie_pitch_inertia=1715.0,
        wheelset_mass=1800.0,
        primary_stiffness=2.4e6,
        primary_damping=2.0e4,
        secondary_stiffness=7.0e5,
        secondary_damping=4.0e4,
        bogie_spacing=17.375,
        axle_spacing=2.5,
        contact_stiffness=contact_stiffness,
    )
    return mf.train(car=coach, count=16, spacing=24.775)


@cache
def rails(length: float) -> mf.Profile:
    """Make track for a journey of this length [m]."""
    spectrum = mf.GermanTrack.of_class("low", band=(0.0125, 1.25))
    return mf.realise(spectrum, length=length + 450.0, step=0.1, start=-400.0)


Run = Callable[[], object]
HOUR = {**JOURNEY, "duration": 3600.0}


def by_train(length: float, contact_stiffness: float = HERTZ) -> Run:
    """Prepare a journey of the train."""
    return partial(
        mf.simulate,
        TRACK,
        coaches(contact_stiffness),
        rails(length),
        speed=TRAIN_SPEED,
        duration=length / TRAIN_SPEED,
        time_step=2.5e-3,
        truncation=110.0,
    )


def drive(guideway: str = "euler_bernoulli", vehicle: mf.Vehicle = TRUCK, **options) -> Run:
    """Prepare the reference case, or what differs from it."""
    return partial(mf.simulate, GUIDEWAYS[guideway], vehicle, ROAD.profile, **(JOURNEY | options))


def anew(*, road_alone: bool = False) -> Run:
    """Prepare the reference case of copies, which remember nothing: of the road alone, or of all there is."""

    def run() -> object:
        guideway, vehicle = (one if road_alone else copy(one) for one in (SCENARIO.guideway, TRUCK))
        return mf.simulate(guideway, vehicle, copy(ROAD.profile), **JOURNEY)

    return run


def hour() -> Run:
    """Prepare one hour of travel, once everything is loaded and compiled: its memory is the journey's alone."""
    drive(duration=1.0)()
    profile = mf.realise(ROAD.spectrum, length=HOUR["speed"] * HOUR["duration"] + 5.0, start=-2.5)
    return partial(mf.simulate, SCENARIO.guideway, TRUCK, profile, **HOUR)


def frf(guideway: str) -> Run:
    """Prepare moving FRFs at 3,361 frequencies and three offsets."""
    omega = 2 * np.pi * np.linspace(0.0, 140.0, 3361) - 0.3j
    return partial(GUIDEWAYS[guideway].moving_frf, np.array([0.0, 4.27, -4.27]), 10.0, omega)


def random() -> Run:
    """Prepare the response to the random road."""
    return partial(mf.random_response, SCENARIO.guideway, TRUCK, ROAD.spectrum, speed=20.0)


def transfer() -> Run:
    """Prepare responses per unit roughness at 2,000 frequencies."""
    return partial(mf.transfer, SCENARIO.guideway, TRUCK, speed=20.0, frequency=np.linspace(0.0, 100.0, 2000))


def loads() -> Run:
    """Prepare three loads, 5 s, seen at twenty points."""
    points = np.linspace(-10.0, 5.0, 20)
    forces = np.full((5000, 3), 1e5)
    return partial(mf.moving_loads, SCENARIO.guideway, forces, [0.0, -3.0, -6.0], speed=20.0, observe=points)


def many(key: str, low: float, high: float) -> Run:
    """Prepare twenty cases of the reference scenario on a profile from a file, all measures of each."""
    folder = Path(tempfile.mkdtemp(prefix="movingfrf-bench-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    mf.write_profile(mf.realise(ROAD.spectrum, length=320.0, start=-2.5), folder / "road.csv")
    tables = tomllib.loads(SCENARIO.text) | {"roughness": {"kind": "profile", "file": str(folder / "road.csv")}}
    return partial(mf.sweep, tables, {key: np.linspace(low, high, 20)})


CASES: dict[str, Callable[[], Run]] = {
    "reference": drive,
    "reference_5_ms": partial(drive, time_step=5e-3),
    "found_truncation": partial(drive, truncation=None),
    **{f"frf_{name}": partial(frf, name) for name in GUIDEWAYS},
    **{f"on_{name}": partial(drive, name) for name in GUIDEWAYS if name != "euler_bernoulli"},
    "another_road": partial(anew, road_alone=True),
    "all_anew": anew,
    "hundred_samples": partial(drive, duration=0.1),
    "quarter_car": partial(drive, "bending_damping", CAR, duration=5.0, truncation=None),
    "random_response": random,
    "transfer": transfer,
    "moving_loads": loads,
    "sweep_speeds": partial(many, "run.speed", 8.0, 12.0),
    "sweep_tyres": partial(many, "vehicle.tyre_stiffness.0", 3.0e6, 4.0e6),
    "train": partial(by_train, 80.0),
    "train_10_km": partial(by_train, 10_000.0),
    "hour": hour,
}

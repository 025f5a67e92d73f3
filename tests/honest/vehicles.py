"""Vehicles to draw from: with and without dashpots, on tyres, on Hertz springs, on rigid wheels."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

import movingfrf as mf
from tests.helpers import FULL_TRUCK, HALF_TRUCK, QUARTER_CAR, QUARTER_TRUCK, lump, three_axle_truck

Draw = np.random.Generator

BOGIE = {
    "frame_mass": 3000.0,
    "frame_pitch_inertia": 2500.0,
    "wheelset_mass": 1800.0,
    "primary_stiffness": 2.4e6,
    "primary_damping": 2.0e4,
    "axle_spacing": 2.5,
    "body_mass": 22_000.0,
    "secondary_stiffness": 7.0e5,
    "secondary_damping": 4.0e4,
}
CARRIAGE = {
    "body_mass": 47_800.0,
    "body_pitch_inertia": 1.958e6,
    "bogie_mass": 3500.0,
    "bogie_pitch_inertia": 1715.0,
    "wheelset_mass": 1800.0,
    "primary_stiffness": 2.4e6,
    "primary_damping": 2.0e4,
    "secondary_stiffness": 7.0e5,
    "secondary_damping": 4.0e4,
    "bogie_spacing": 17.375,
    "axle_spacing": 2.5,
}


NAMED = ("golden_car", "half_passenger_car", "passenger_car", "half_truck", "two_axle_truck", "manchester_coach")


def scattered(draw: Draw, values: dict, spread: float = 0.25) -> dict:
    """Change every parameter but geometry by a factor of its own."""

    def changed(name, value):
        if name in ("axles", "sides", "axle_spacing", "bogie_spacing"):
            return value
        factor = np.exp(draw.uniform(-spread, spread))
        return tuple(factor * each for each in value) if isinstance(value, tuple) else factor * value

    return {name: changed(name, value) for name, value in values.items()}


def without(values: dict, *names: str) -> dict:
    return {name: value for name, value in values.items() if name not in names}


def hertz(draw: Draw) -> dict:
    """Stiffness of a contact of steel on steel, a third of the time with some damping."""
    damping = 0.0 if draw.random() < 0.67 else 10 ** draw.uniform(3, 5)
    return {"contact_stiffness": draw.uniform(1.5e9, 2.8e9), "contact_damping": damping}


def _quarter_truck_rigid(draw: Draw) -> mf.Vehicle:
    return mf.quarter_car(**scattered(draw, QUARTER_TRUCK) | {"tyre_stiffness": np.inf, "tyre_damping": 0.0})


def _oscillator(draw: Draw) -> mf.Vehicle:
    mass, frequency = 10 ** draw.uniform(2.5, 4), draw.uniform(1.0, 12.0)
    stiffness = mass * (2 * np.pi * frequency) ** 2
    damping = 2 * draw.uniform(0.02, 0.4) * np.sqrt(mass * stiffness)
    wheel = 0.0 if draw.random() < 0.5 else draw.uniform(0.05, 0.3) * mass
    return mf.sprung_mass(mass=mass, stiffness=stiffness, damping=damping, wheel_mass=wheel)


def _catalogue(draw: Draw) -> mf.Vehicle:
    names = (
        "golden_car",
        "half_passenger_car",
        "passenger_car",
        "half_truck",
        "two_axle_truck",
        "manchester_coach",
    )
    return mf.catalogue(name=names[draw.integers(len(names))])


VEHICLES: dict[str, Callable[[Draw], mf.Vehicle]] = {
    "quarter car": lambda draw: mf.quarter_car(**without(scattered(draw, QUARTER_CAR), "tyre_damping")),
    "quarter car, tyre dashpot": lambda draw: mf.quarter_car(**scattered(draw, QUARTER_CAR)),
    "quarter truck, tyre dashpot": lambda draw: mf.quarter_car(**scattered(draw, QUARTER_TRUCK)),
    "quarter truck, rigid": _quarter_truck_rigid,
    "half truck": lambda draw: mf.half_car(**without(scattered(draw, HALF_TRUCK), "tyre_damping")),
    "half truck, tyre dashpots": lambda draw: mf.half_car(**scattered(draw, HALF_TRUCK)),
    "full truck": lambda draw: mf.full_car(**scattered(draw, FULL_TRUCK)),
    "catalogue": _catalogue,
    "three axles": lambda draw: three_axle_truck(),
    "oscillator": _oscillator,
    "lump": lambda draw: lump(),
    "wheelset, Hertz": lambda draw: mf.wheelset(mass=draw.uniform(900, 2000), **hertz(draw)),
    "wheelset, rigid": lambda draw: mf.wheelset(mass=draw.uniform(900, 2000)),
    "bogie, Hertz": lambda draw: mf.bogie(**scattered(draw, BOGIE), **hertz(draw)),
    "bogie, rigid": lambda draw: mf.bogie(**scattered(draw, BOGIE)),
    "carriage, Hertz": lambda draw: mf.carriage(**scattered(draw, CARRIAGE), **hertz(draw)),
    "carriage, rigid": lambda draw: mf.carriage(**scattered(draw, CARRIAGE)),
}
STEEL = ("wheelset", "bogie", "carriage")


def vehicle(draw: Draw, name: str) -> tuple[mf.Vehicle, str]:
    """Draw a vehicle of a kind, and what its contacts average over; returns what to call it, too."""
    drawn = VEHICLES[name](draw)
    steel = name.startswith(STEEL)
    touched = {"footprint": 0.0, "cams": 0.0}
    if draw.random() < 0.5:
        touched["footprint"] = draw.uniform(0.005, 0.015) if steel else draw.uniform(0.05, 0.5)
    if not steel and draw.random() < 0.15:
        touched["cams"] = draw.uniform(0.05, 0.3)
    if not any(touched.values()):
        return replace(drawn, contacts=[replace(at, **touched) for at in drawn.contacts]), name
    said = ", ".join(f"{key} {value:.3g}" for key, value in touched.items() if value)
    return replace(drawn, contacts=[replace(at, **touched) for at in drawn.contacts]), f"{name}, {said}"

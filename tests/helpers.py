"""Every implementation, listed once, and the formulas that the laws are checked against.

Nothing here uses the package's own wave or coupling code: `compliance` is written out from the equations of
motion, `rigid_motions` from the geometry.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np

import movingfrf as mf
from movingfrf.guideways.track import Track

GRAVITY = 9.81

# The reference road, and a rail UIC60 per metre of track.
PAVEMENT = mf.EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9)
RAIL = mf.EulerBernoulliBeam(bending_stiffness=6.42e6, mass=60.2)
TIMOSHENKO = mf.TimoshenkoBeam(bending_stiffness=1.573e7, mass=711.9, shear_stiffness=4.0e8, rotary_inertia=5.5)
SOIL = mf.Spring(stiffness=8.0e6, damping=3.0e4)
SHEARED_SOIL = mf.ShearLayer(stiffness=8.0e6, damping=3.0e4, shear_stiffness=2.0e6)
PAD = mf.Spring(stiffness=3.0e8, damping=3.0e4)
BALLAST = mf.Spring(stiffness=1.0e8, damping=8.0e4)
SUBGRADE = mf.Spring(stiffness=1.3e8, damping=5.0e4)

DAMPED: dict[str, Track] = {
    "euler_bernoulli_winkler": mf.track(PAVEMENT, SOIL),
    "bending_damping": mf.track(replace(PAVEMENT, bending_damping=2.0e4), SOIL),
    "euler_bernoulli_pasternak": mf.track(PAVEMENT, SHEARED_SOIL),
    "timoshenko_pasternak": mf.track(TIMOSHENKO, SHEARED_SOIL),
    "rail_pad_sleeper_ballast": mf.track(RAIL, mf.OnMass(above=PAD, mass=250.0, below=BALLAST)),
    "rail_two_masses": mf.track(
        RAIL, mf.OnMass(above=PAD, mass=250.0, below=mf.OnMass(above=BALLAST, mass=900.0, below=SUBGRADE))
    ),
}


def undamped(part):
    """Take the losses out of a beam, foundation or track."""
    if isinstance(part, Track):
        return mf.track(undamped(part.beam), undamped(part.foundation))
    if isinstance(part, mf.OnMass):
        return mf.OnMass(above=undamped(part.above), mass=part.mass, below=undamped(part.below))
    if isinstance(part, mf.EulerBernoulliBeam):
        return replace(part, bending_damping=0.0)
    return part if isinstance(part, mf.TimoshenkoBeam) else replace(part, damping=0.0)


UNDAMPED: dict[str, Track] = {name: undamped(road) for name, road in DAMPED.items() if name != "bending_damping"}


# At rest, slow, below and above the critical speed, as multiples of it.
BELOW, ABOVE = (0.06, 0.6), (1.3, 2.1)
SHARES = (0.0, *BELOW, *ABOVE)


def stiffness_of(part, kappa, frequency):
    """Dynamic stiffness of a beam or foundation for the wave e^{i(Ωt + κx)}, from its equations of motion."""
    if isinstance(part, mf.EulerBernoulliBeam):
        bending = part.bending_stiffness + 1j * frequency * part.bending_damping
        return bending * kappa**4 - part.mass * frequency**2
    if isinstance(part, mf.TimoshenkoBeam):
        shear = part.shear_stiffness
        rotation = part.bending_stiffness * kappa**2 + shear - part.rotary_inertia * frequency**2
        return shear * kappa**2 - (shear * kappa) ** 2 / rotation - part.mass * frequency**2
    if isinstance(part, mf.OnMass):
        above = stiffness_of(part.above, kappa, frequency)
        layer = stiffness_of(part.below, kappa, frequency) - part.mass * frequency**2
        return above * layer / (above + layer)
    spring = part.stiffness + 1j * frequency * part.damping
    return spring + getattr(part, "shear_stiffness", 0.0) * kappa**2


def compliance(road: Track, kappa, frequency):
    """C(κ, Ω) of a track in the fixed frame [m²/N], METHOD.md section 3, written out."""
    kappa, frequency = np.asarray(kappa, complex), np.asarray(frequency, complex)
    return 1.0 / (stiffness_of(road.beam, kappa, frequency) + stiffness_of(road.foundation, kappa, frequency))


def written_on(page: str) -> dict:
    """Run the one block of Python on a page of the documentation; returns what it defines."""
    text = (Path(__file__).parents[1] / "docs" / f"{page}.md").read_text(encoding="utf-8")
    (code,) = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    names: dict = {}
    exec(compile(code, page, "exec", dont_inherit=True), names)
    return names


class Listed(NamedTuple):
    """A guideway that the laws are put to; its compliance C(κ, Ω) [m²/N] written out, if known; is it damped."""

    guideway: mf.Guideway
    compliance: Callable | None = None
    damped: bool = True


GUIDEWAYS: dict[str, Listed] = {
    **{name: Listed(road, partial(compliance, road)) for name, road in DAMPED.items()},
    **{
        f"undamped_{name}": Listed(road, partial(compliance, road), damped=False) for name, road in UNDAMPED.items()
    },
    "rail_in_heat": Listed(
        mf.track(mf.TensionedBeam(beam=RAIL, force=-7.5e5), BALLAST),
        lambda kappa, omega: 1 / (6.42e6 * kappa**4 - 7.5e5 * kappa**2 - 60.2 * omega**2 + 8e4j * omega + 1e8),
    ),
    "relaxing_pads": Listed(
        mf.track(RAIL, mf.RelaxingSpring(stiffness=1e8, relaxing_stiffness=2e9, damping=1e5)),
        lambda kappa, omega: 1 / (6.42e6 * kappa**4 - 60.2 * omega**2 + 1e8 + 2e14j * omega / (2e9 + 1e5j * omega)),
    ),
    "taut_string": Listed(
        written_on("guideways")["TautString"](tension=2e4, mass=1.35, stiffness=2e3, damping=60.0),
        lambda kappa, omega: 1 / (2e4 * kappa**2 - 1.35 * omega**2 + 60j * omega + 2e3),
    ),
}


# PARAMETERS.md: the reference vehicle.
WHEELBASE = 4.27
HALF_TRUCK = {
    "body_mass": 17_735.0,
    "pitch_inertia": 1.47e5,
    "wheel_masses": (1500.0, 1000.0),
    "suspension_stiffness": (2.47e6, 4.23e6),
    "suspension_damping": (3.0e4, 4.0e4),
    "tyre_stiffness": (3.74e6, 4.60e6),
    "tyre_damping": (3.9e3, 4.3e3),
    "axles": (0.519 * WHEELBASE, -0.481 * WHEELBASE),
}
# The same on four wheels, its centre of mass beside the middle of its axles.
FULL_TRUCK = {
    name: tuple(0.5 * value for value in HALF_TRUCK[name])
    for name in ("wheel_masses", "suspension_stiffness", "suspension_damping", "tyre_stiffness", "tyre_damping")
} | {
    "body_mass": 17_735.0,
    "pitch_inertia": 1.47e5,
    "roll_inertia": 1.6e4,
    "axles": HALF_TRUCK["axles"],
    "sides": (0.85, -1.0),
}
QUARTER_CAR = {
    "body_mass": 400.0,
    "wheel_mass": 40.0,
    "suspension_stiffness": 2.0e4,
    "suspension_damping": 1.5e3,
    "tyre_stiffness": 2.0e5,
    "tyre_damping": 150.0,
}
# A heavier one, that the reference road feels.
QUARTER_TRUCK = {
    "body_mass": 8900.0,
    "wheel_mass": 1100.0,
    "suspension_stiffness": 1.0e6,
    "suspension_damping": 3.0e4,
    "tyre_stiffness": 3.5e6,
    "tyre_damping": 2.0e3,
}


def three_axle_truck() -> mf.Vehicle:
    """Build a rigid body on three axles, assembled spring by spring: `bounce`, `pitch`, three wheels."""
    axles = np.array([3.0, -1.2, -2.5])
    springs, dashpots = np.array([8e5, 1.5e6, 1.2e6]), np.array([2e4, 3e4, 2.5e4])
    tyres, wheels = np.array([2e6, 3.4e6, 3.0e6]), np.array([600.0, 1000.0, 900.0])
    stiffness, damping = np.zeros((5, 5)), np.zeros((5, 5))
    for n, at in enumerate(axles):
        stretch = np.array([1.0, at, 0.0, 0.0, 0.0])
        stretch[2 + n] = -1.0
        stiffness += springs[n] * np.outer(stretch, stretch)
        damping += dashpots[n] * np.outer(stretch, stretch)
    return mf.Vehicle(
        mass=np.diag([20_000.0, 9.0e4, *wheels]),
        damping=damping,
        stiffness=stiffness,
        contact_map=np.hstack([np.zeros((3, 2)), np.eye(3)]),
        contacts=[mf.Contact(position=x, stiffness=k, damping=2e3) for x, k in zip(axles, tyres, strict=True)],
        vertical=[1, 0, 1, 1, 1],
        dof_names=["bounce", "pitch", "wheel_1", "wheel_2", "wheel_3"],
    )


def lump() -> mf.Vehicle:
    """Put one mass on one contact, damped critically: its double pole has a single mode."""
    mass, stiffness = 2000.0, 2.0e5
    return mf.Vehicle(
        mass=[[mass]],
        damping=[[0.0]],
        stiffness=[[0.0]],
        contact_map=[[1.0]],
        contacts=[mf.Contact(position=0.0, stiffness=stiffness, damping=2 * np.sqrt(mass * stiffness))],
        vertical=[1],
        dof_names=["mass"],
    )


VEHICLES: dict[str, mf.Vehicle] = {
    "quarter_car": mf.quarter_car(**QUARTER_CAR),
    "quarter_truck": mf.quarter_car(**QUARTER_TRUCK),
    "half_truck": mf.half_car(**HALF_TRUCK),
    "full_truck": mf.full_car(**FULL_TRUCK),
    "three_axles": three_axle_truck(),
    "critically_damped_mass": lump(),
    "sprung_mass": mf.sprung_mass(mass=5750.0, stiffness=1.595e6, damping=1.2e4),
    "footprint": mf.quarter_car(**QUARTER_TRUCK, footprint=0.2),
}


def rigid_motions(vehicle: mf.Vehicle) -> list[np.ndarray]:
    """Motions that stretch no suspension: down by one metre, nose and left side down by one radian with all wheels.

    Motions of the body come first, then one wheel per contact: a wheel under the nose, or under the left side, goes
    down by its lever arm.
    """
    motions = [np.asarray(vehicle.vertical, float)]
    body = len(vehicle.dof_names) - len(vehicle.contacts)
    for name, levers in (
        ("pitch", [contact.position for contact in vehicle.contacts]),
        ("roll", [contact.across for contact in vehicle.contacts]),
    ):
        if name in vehicle.dof_names:
            motions.append(np.array([*np.eye(body)[vehicle.dof_names.index(name)], *levers]))
    return motions


def held_matrices(vehicle: mf.Vehicle):
    """M, C, K, B, k_t, c_t as plain arrays."""
    tyres = np.array([[contact.stiffness, contact.damping] for contact in vehicle.contacts])
    arrays = (vehicle.mass, vehicle.damping, vehicle.stiffness, vehicle.contact_map)
    return *(np.asarray(array, float) for array in arrays), tyres[:, 0], tyres[:, 1]


def dynamic_stiffness(vehicle: mf.Vehicle, omega: complex) -> np.ndarray:
    """D_v(ω) of METHOD.md section 4, one frequency, by a plain inverse [N/m]."""
    mass, damping, stiffness, at, k, c = held_matrices(vehicle)
    tyres = np.diag(k + 1j * omega * c)
    whole = -(omega**2) * mass + 1j * omega * damping + stiffness + at.T @ tyres @ at
    return tyres - tyres @ at @ np.linalg.inv(whole) @ at.T @ tyres


def difference(first, second) -> float:
    """Relative L2 difference over the first axis, the greatest of the others."""
    first, second = np.asarray(first), np.asarray(second)
    size = np.sqrt((np.abs(second) ** 2).sum(axis=0))
    return float(np.max(np.sqrt((np.abs(first - second) ** 2).sum(axis=0)) / size))


# Coefficients of central differences of eighth order, for the first and the second derivative.
_FIRST = np.array([1 / 280, -4 / 105, 1 / 5, -4 / 5, 0.0, 4 / 5, -1 / 5, 4 / 105, -1 / 280])
_SECOND = np.array([-1 / 560, 8 / 315, -1 / 5, 8 / 5, -205 / 72, 8 / 5, -1 / 5, 8 / 315, -1 / 560])
MARGIN = 4


def rates(history: np.ndarray, step: float) -> tuple[np.ndarray, np.ndarray]:
    """First and second derivative in time; `MARGIN` samples at either end are missing."""
    windows = np.lib.stride_tricks.sliding_window_view(history, 2 * MARGIN + 1, axis=0)
    return windows @ _FIRST / step, windows @ _SECOND / step**2


def observed_order(steps, errors) -> float:
    """Slope of the regression of log error on log step."""
    return float(np.polyfit(np.log(steps), np.log(errors), 1)[0])


def apart(found, wanted, span=slice(None)) -> dict[str, float]:
    """Relative L2 difference of each output of two coupled results; of the deflection, what moves."""
    first, second = (
        {name: result[name].values[span] for name in ("contact_force", "motion", "acceleration")}
        | {"deflection": (result.deflection - result.static_deflection).values[span]}
        for result in (found, wanted)
    )
    return {name: difference(first[name], second[name]) for name in first}

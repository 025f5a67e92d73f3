"""The moving oscillator in closed form: its pole, its force over a wavy road, and on a beam that gives way."""

from __future__ import annotations

import numpy as np
import pytest

import movingfrf as mf
from tests.helpers import DAMPED

MASS, STIFFNESS, DAMPING, WHEEL = 5750.0, 1.595e6, 1.2e4, 500.0
FREQUENCY = np.array([0.0, 0.5, 2.0, 2.65, 3.5, 10.0, 30.0])
OMEGA = 2 * np.pi * FREQUENCY


def dynamic_stiffness(wheel):
    """Force per displacement of the contact: m₂ and m₁ on k + iωc, with −ω² each."""
    spring = STIFFNESS + 1j * OMEGA * DAMPING
    return -(OMEGA**2) * (wheel + MASS * spring / (spring - OMEGA**2 * MASS))


def made(wheel):
    return mf.sprung_mass(mass=MASS, stiffness=STIFFNESS, damping=DAMPING, wheel_mass=wheel)


def forces(road, wheel, speed=10.0):
    """Contact force per metre of roughness."""
    return mf.transfer(road, made(wheel), speed=speed, frequency=FREQUENCY).contact_force.values[:, 0, 0]


both = pytest.mark.parametrize("wheel", [0.0, WHEEL], ids=["spring on the road", "with a wheel"])


@both
def test_over_a_wavy_rigid_road(wheel):
    np.testing.assert_allclose(forces(mf.RigidGuideway(), wheel), dynamic_stiffness(wheel), rtol=1e-11, atol=1e-6)


@both
def test_on_a_beam_that_gives_way(wheel):
    """F = D r/(1 + D G), with the receptance of a beam on springs 1/(2√2 EI q³), q⁴ = (k + icω − mω²)/EI."""
    q = ((8.0e6 + 3.0e4j * OMEGA - 711.9 * OMEGA**2) / 1.573e7) ** 0.25
    receptance = 1 / (2 * np.sqrt(2) * 1.573e7 * q**3)
    stiffness = dynamic_stiffness(wheel)
    found = forces(DAMPED["euler_bernoulli_winkler"], wheel, speed=1e-9)
    np.testing.assert_allclose(found, stiffness / (1 + stiffness * receptance), rtol=1e-10, atol=1e-6)


@both
def test_its_vibration_and_its_weight(wheel):
    vehicle = made(wheel)
    assert vehicle.natural_frequencies == pytest.approx([np.sqrt(STIFFNESS / MASS) / (2 * np.pi)], rel=1e-12)
    assert vehicle.damping_ratios == pytest.approx([DAMPING / (2 * np.sqrt(STIFFNESS * MASS))], rel=1e-12)
    assert vehicle.static_loads == pytest.approx([9.81 * (MASS + wheel)], rel=1e-12)
    assert vehicle.dof_names == (("body", "wheel") if wheel else ("body",))


def test_a_stiff_tyre_makes_a_quarter_car_of_it():
    car = mf.quarter_car(
        body_mass=MASS,
        wheel_mass=WHEEL,
        suspension_stiffness=STIFFNESS,
        suspension_damping=DAMPING,
        tyre_stiffness=1e12,
    )
    stiff = mf.transfer(mf.RigidGuideway(), car, speed=10.0, frequency=FREQUENCY).contact_force.values[:, 0, 0]
    np.testing.assert_allclose(stiff, forces(mf.RigidGuideway(), WHEEL), rtol=1e-4, atol=0.01)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"mass": 0.0}, "mass must be positive, got 0.0 kg"),
        ({"stiffness": -1.0}, "stiffness must be positive, got -1.0 N/m"),
        ({"damping": -1.0}, "damping must not be negative, got -1.0 N s/m"),
        ({"wheel_mass": -1.0}, "wheel_mass must not be negative, got -1.0 kg"),
        ({"footprint": -1.0}, "footprint must not be negative, got -1.0 m"),
    ],
)
def test_refused(given, message):
    with pytest.raises(ValueError, match=message):
        mf.sprung_mass(**({"mass": MASS, "stiffness": STIFFNESS} | given))

"""Vehicles on a rigid road against the textbook, derived here from scratch."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import eigh

import movingfrf as mf
from tests.helpers import HALF_TRUCK, QUARTER_CAR, QUARTER_TRUCK, VEHICLES


def textbook(parameters, omega):
    """Quarter car on a road z_r (all upward here): body, wheel and tyre compression per elevation.

    m_b z̈_b = −k_s (z_b − z_w) − c_s (ż_b − ż_w)
    m_w z̈_w = +k_s (z_b − z_w) + c_s (ż_b − ż_w) − k_t (z_w − z_r) − c_t (ż_w − ż_r)
    """
    s = 1j * omega
    suspension = parameters["suspension_stiffness"] + s * parameters["suspension_damping"]
    tyre = parameters["tyre_stiffness"] + s * parameters["tyre_damping"]
    body_per_wheel = suspension / (parameters["body_mass"] * s**2 + suspension)
    wheel = tyre / (parameters["wheel_mass"] * s**2 + tyre + suspension * (1 - body_per_wheel))
    return body_per_wheel * wheel, wheel, tyre * (1 - wheel)


def fitted(history, time, omega):
    """Complex amplitude X of Re X e^{iωt}, next to a constant, by least squares."""
    basis = np.stack([np.cos(omega * time), -np.sin(omega * time), np.ones_like(time)], axis=1)
    (real, imaginary, _), *_ = np.linalg.lstsq(basis, history, rcond=None)
    return real + 1j * imaginary


@pytest.mark.parametrize("parameters", [QUARTER_CAR, QUARTER_TRUCK], ids=["car", "truck"])
@pytest.mark.parametrize("frequency", [0.5, 1.2, 4.0, 10.0, 25.0])
def test_harmonic_road(parameters, frequency):
    """Steady state after the start has died away: amplitude and phase of body, wheel and contact force.

    A cubic spline through fifty stations per wave is good to (2π/50)⁴/384·(a few), 1e-5; what rings on from the
    start is below 1e-5 after fifteen seconds.
    """
    speed, omega, amplitude = 10.0, 2 * np.pi * frequency, 2e-3
    profile = mf.harmonic(amplitude=amplitude, wavelength=speed / frequency, length=240.0, start=-1.0, phase=0.4)
    result = mf.simulate(mf.RigidGuideway(), mf.quarter_car(**parameters), profile, speed=speed, duration=22.0)
    late = slice(16_000, 20_000)  # before the end of the record
    time = result.time.values[late]
    # Elevation (up) A sin(ωt + 0.4) = Re −iA e^{0.4 i} e^{iωt}; the blend subtracts the constant datum.
    elevation = -1j * amplitude * np.exp(0.4j)
    body, wheel, force = textbook(parameters, omega)
    expected = {"body": -body * elevation, "wheel": -wheel * elevation}
    for dof, value in expected.items():
        motion = result.motion.sel(dof=dof).values[late]
        found = fitted(motion, time, omega)
        assert abs(found - value) < 2e-4 * abs(value)
        acceleration = fitted(result.acceleration.sel(dof=dof).values[late], time, omega)
        assert abs(acceleration + omega**2 * value) < 2e-4 * abs(omega**2 * value)
    found = fitted(result.contact_force.values[late, 0], time, omega)
    assert abs(found - force * elevation) < 2e-4 * abs(force * elevation)


def test_half_car_natural_frequencies():
    """Undamped, from an energy assembled here: axle heights z ± lever · pitch stretch the suspensions."""
    front, rear = HALF_TRUCK["axles"]
    levers = np.array([[1.0, front, -1.0, 0.0], [1.0, rear, 0.0, -1.0], [0, 0, 1, 0], [0, 0, 0, 1.0]])
    springs = np.diag([*HALF_TRUCK["suspension_stiffness"], *HALF_TRUCK["tyre_stiffness"]])
    mass = np.diag([HALF_TRUCK["body_mass"], HALF_TRUCK["pitch_inertia"], *HALF_TRUCK["wheel_masses"]])
    expected = np.sqrt(eigh(levers.T @ springs @ levers, mass, eigvals_only=True)) / (2 * np.pi)
    undamped = mf.half_car(**HALF_TRUCK | {"suspension_damping": (0.0, 0.0), "tyre_damping": (0.0, 0.0)})
    np.testing.assert_allclose(undamped.natural_frequencies, expected, rtol=1e-9)


def test_damped_poles_solve_the_equations_of_motion():
    """det(λ²M + λC + K) = 0 with all springs and dashpots; the damping ratio is −Re λ/|λ|."""
    truck = VEHICLES["half_truck"]
    front, rear = HALF_TRUCK["axles"]
    levers = np.array([[1.0, front, -1.0, 0.0], [1.0, rear, 0.0, -1.0], [0, 0, 1, 0], [0, 0, 0, 1.0]])
    springs = np.diag([*HALF_TRUCK["suspension_stiffness"], *HALF_TRUCK["tyre_stiffness"]])
    dashpots = np.diag([*HALF_TRUCK["suspension_damping"], *HALF_TRUCK["tyre_damping"]])
    mass = np.diag([HALF_TRUCK["body_mass"], HALF_TRUCK["pitch_inertia"], *HALF_TRUCK["wheel_masses"]])
    for pole, frequency, ratio in zip(truck.poles, truck.natural_frequencies, truck.damping_ratios, strict=True):
        dynamic = pole**2 * mass + levers.T @ (springs + pole * dashpots) @ levers
        singular = np.linalg.svd(dynamic, compute_uv=False)
        assert singular[-1] < 1e-9 * singular[0]
        assert frequency == pytest.approx(abs(pole) / (2 * np.pi), rel=1e-12)
        assert ratio == pytest.approx(-pole.real / abs(pole), rel=1e-12)
        assert 0 < ratio < 1


def test_the_reference_vehicle_weighs_what_it_should():
    assert VEHICLES["half_truck"].static_loads.sum() == pytest.approx(9.81 * (17_735 + 1500 + 1000), rel=1e-12)


def test_footprint_averages_the_road():
    """A factor sin(πnL)/(πnL) on a harmonic road: at wavelength 0.5 m and L = 0.2 m it is 0.7568."""
    speed, wavelength = 10.0, 0.5
    profile = mf.harmonic(amplitude=1e-3, wavelength=wavelength, length=80.0, start=-1.0)
    seen = []
    for footprint in (0.0, 0.2):
        car = mf.quarter_car(**QUARTER_TRUCK, footprint=footprint)
        result = mf.simulate(mf.RigidGuideway(), car, profile, speed=speed, duration=6.0)
        late = slice(3000, 5000)
        seen.append(
            fitted(result.roughness.values[late, 0], result.time.values[late], 2 * np.pi * speed / wavelength)
        )
    n = np.pi * 0.2 / wavelength
    assert seen[1] / seen[0] == pytest.approx(np.sin(n) / n, rel=1e-4)

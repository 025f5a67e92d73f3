"""Vehicles on a rigid road against the textbook, derived here from scratch."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import eigh

import movingfrf as mf
from tests.helpers import FULL_TRUCK, HALF_TRUCK, QUARTER_CAR, QUARTER_TRUCK, VEHICLES


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


def pair_of_masses(above, below, suspension, tyre):
    """Squared natural frequencies of one mass above another on springs: ω⁴ m M − ω² (…) + k_s k_t = 0."""
    product = above * below
    half = 0.5 * (suspension * (above + below) + tyre * above) / product
    root = np.sqrt(half**2 - suspension * tyre / product)
    return half - root, half + root


def test_full_car_natural_frequencies():
    """Alike left and right, front and rear: bounce, pitch and roll are quarter cars of their own.

    The body counts by M/4, I_p/(4 a²) and I_r/(4 b²) for each wheel. In the seventh motion opposite corners move
    against each other, and only wheels move: ω² = (k_s + k_t)/m.
    """
    body, pitch, roll, wheel, suspension, tyre = 18e3, 1.5e5, 1.4e4, 700.0, 1.7e6, 2.1e6
    a, b = 2.1, 0.9
    car = mf.full_car(
        body_mass=body,
        pitch_inertia=pitch,
        roll_inertia=roll,
        wheel_masses=(wheel, wheel),
        suspension_stiffness=(suspension, suspension),
        suspension_damping=(0.0, 0.0),
        tyre_stiffness=(tyre, tyre),
        axles=(a, -a),
        sides=(b, -b),
    )
    expected = [(suspension + tyre) / wheel]
    for above in (body / 4, pitch / (4 * a**2), roll / (4 * b**2)):
        expected += pair_of_masses(above, wheel, suspension, tyre)
    np.testing.assert_allclose(
        car.natural_frequencies, np.sqrt(np.sort(expected)) / (2 * np.pi), rtol=1e-9, atol=0.0
    )


def test_full_car_static_loads_of_a_mass_beside_the_middle():
    """Levers share the weight between axles; from side to side axles share its moment by their stiffness in roll.

    Suspension and tyre of a wheel are springs in series; their wheels' own weight is carried where it is.
    """
    (front, rear), (left, right) = FULL_TRUCK["axles"], FULL_TRUCK["sides"]
    weight = 9.81 * FULL_TRUCK["body_mass"]
    axles = weight * np.array([-rear, front]) / (front - rear)
    springs = 1 / (1 / np.array(FULL_TRUCK["suspension_stiffness"]) + 1 / np.array(FULL_TRUCK["tyre_stiffness"]))
    # The centre of mass lies left of the middle between the wheels, since right wheels are farther from it.
    moment = -0.5 * (left + right) * weight
    transferred = springs / springs.sum() * moment / (left - right)
    wheels = 9.81 * np.array(FULL_TRUCK["wheel_masses"])
    expected = np.stack([axles / 2 + transferred, axles / 2 - transferred], axis=1) + wheels[:, None]
    truck = VEHICLES["full_truck"]
    assert [name for name in truck.dof_names if name.endswith("wheel")] == [
        "front_left_wheel",
        "front_right_wheel",
        "rear_left_wheel",
        "rear_right_wheel",
    ]
    np.testing.assert_allclose(truck.static_loads, expected.ravel(), rtol=1e-10)
    assert truck.static_loads[0] > truck.static_loads[1]


def test_a_full_car_leans_away_from_the_wheel_that_is_lifted():
    """The absolute facts of its signs; downward, nose down and left side down are positive.

    Slowly, on a rigid road: 1 cm up under the left wheels lifts the body by its share and turns it left side up;
    later under the front wheels, on both paths, nose up.
    """
    x = np.arange(-8.0, 40.0, 0.05)
    share = np.clip((x - 2.5) / 3.0, 0, 1)
    step = 0.01 * (10 * share**3 - 15 * share**4 + 6 * share**5)
    left, both = (mf.Profile(x, np.stack([step, other], axis=1)) for other in (0 * x, step))
    (front, rear), (on_left, on_right) = FULL_TRUCK["axles"], FULL_TRUCK["sides"]
    options = {"speed": 0.8, "time_step": 5e-3, "blend": 0.0}
    truck = VEHICLES["full_truck"]
    result = mf.simulate(mf.RigidGuideway(), truck, left, duration=14.0, **options).isel(time=-600)
    # A plane through 1 cm at the left wheels and nothing at the right ones.
    motion = result.motion
    assert float(motion.sel(dof="roll")) == pytest.approx(-0.01 / (on_left - on_right), rel=1e-3)
    assert float(motion.sel(dof="bounce")) == pytest.approx(0.01 * on_right / (on_left - on_right), rel=1e-3)
    assert float(motion.sel(dof="front_left_wheel")) == pytest.approx(-0.01, rel=1e-3)
    assert abs(float(motion.sel(dof="front_right_wheel"))) < 1e-5
    result = mf.simulate(mf.RigidGuideway(), truck, both, duration=14.0, **options)
    between = result.isel(time=int(np.searchsorted(front + 0.8 * result.time.values, 6.1))).motion
    assert float(between.sel(dof="pitch")) == pytest.approx(-0.01 / (front - rear), rel=1e-2)
    # The body still bounces a little, and turns with it as its centre of mass lies beside the middle.
    assert abs(float(between.sel(dof="roll"))) < 1e-5


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

"""A few laws over drawn parameters."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import movingfrf as mf
from tests.helpers import GRAVITY, compliance, dynamic_stiffness, held_matrices, rigid_motions

drawn = settings(max_examples=25, deadline=None, derandomize=True)


def magnitude(low, high):
    """Numbers spread evenly over the orders of magnitude."""
    return st.floats(np.log10(low), np.log10(high)).map(lambda exponent: 10.0**exponent)


none_or = st.just(0.0)
beams = st.builds(
    mf.EulerBernoulliBeam,
    bending_stiffness=magnitude(1e5, 1e9),
    mass=magnitude(20.0, 5e3),
    bending_damping=none_or | magnitude(1e2, 1e5),
) | st.builds(
    mf.TimoshenkoBeam,
    bending_stiffness=magnitude(1e6, 1e8),
    mass=magnitude(50.0, 3e3),
    shear_stiffness=magnitude(1e8, 1e10),
    rotary_inertia=none_or | magnitude(0.1, 50.0),
)
springs = st.builds(mf.Spring, stiffness=magnitude(1e6, 1e9), damping=magnitude(1e3, 1e6))
layers = st.builds(
    mf.ShearLayer,
    stiffness=magnitude(1e6, 1e9),
    damping=magnitude(1e3, 1e6),
    shear_stiffness=magnitude(1e4, 1e7),
)
foundations = springs | layers | st.builds(mf.OnMass, above=springs, mass=magnitude(50.0, 1e3), below=springs)
speeds = st.floats(0.1, 400.0)
frequencies = st.floats(0.1, 900.0)


@drawn
@given(beam=beams, foundation=foundations, speed=speeds, omega=frequencies)
def test_mirror_and_reality(beam, foundation, speed, omega):
    road, x = mf.track(beam, foundation), np.array([0.0, 0.7, -0.7, 5.0, -5.0])
    frf = road.moving_frf(x, speed, [omega])[0]
    # Roots of a polynomial of degree up to ten, near-multiple ones among them: half of the digits at worst.
    scale = 1e-8 * np.abs(frf).max()
    assert np.abs(road.moving_frf(-x, -speed, [omega])[0] - frf).max() < scale
    assert np.abs(road.moving_frf(x, speed, [-omega])[0] - frf.conj()).max() < scale


@drawn
@given(beam=beams, foundation=foundations, speed=speeds, omega=frequencies)
def test_volume_of_the_basin(beam, foundation, speed, omega):
    """∫ G dξ = C(0, ω), the integral over each side by the residues' own decay: ∫ G″ dξ = 0 as well."""
    road = mf.track(beam, foundation)
    # Decay enough for the basin to end: waves leave with a finite speed, η/speed per metre at least.
    w = np.array([omega - 1j * (200.0 + 3 * speed)])
    length = 60 / np.sqrt(np.sqrt(1e6 / 1e9))
    u = np.linspace(-1.0, 1.0, 60_001)
    # Stations crowd at the load, where G is smooth on each side only.
    x, dx = length * u**3, 3 * length * u**2 * (u[1] - u[0])
    volume = road.moving_frf(x, speed, w)[0] @ dx
    expected = compliance(road, 0.0, w)[0]
    assert abs(volume - expected) < 1e-4 * abs(expected)


pair = st.tuples
half_cars = st.fixed_dictionaries(
    {
        "body_mass": magnitude(200.0, 5e4),
        "pitch_inertia": magnitude(200.0, 5e5),
        "wheel_masses": pair(magnitude(10.0, 2e3), magnitude(10.0, 2e3)),
        "suspension_stiffness": pair(magnitude(1e4, 5e6), magnitude(1e4, 5e6)),
        "suspension_damping": pair(magnitude(1e2, 1e5), magnitude(1e2, 1e5)),
        "tyre_stiffness": pair(magnitude(1e5, 1e7), magnitude(1e5, 1e7)),
        "tyre_damping": pair(magnitude(1.0, 1e4), magnitude(1.0, 1e4)),
        "axles": pair(st.floats(0.2, 5.0), st.floats(-5.0, -0.2)),
    }
)


@drawn
@given(parameters=half_cars, omega=frequencies)
def test_half_car_at_its_contacts(parameters, omega):
    car = mf.half_car(**parameters)
    *_, at, tyres, _ = held_matrices(car)
    weight = GRAVITY * np.asarray(car.mass) @ np.asarray(car.vertical)
    rest = car.dynamics().stiffness(np.zeros(1, complex))[..., 0]
    for motion in rigid_motions(car):
        work = motion @ weight
        assert abs(car.static_loads @ (at @ motion) - work) < 1e-9 * np.abs(weight).max() * 5
        assert np.abs(rest @ (at @ motion)).max() < 1e-8 * tyres.max()
    found = car.dynamics().stiffness(np.array([omega + 0j]))[..., 0]
    assert np.abs(found - dynamic_stiffness(car, omega)).max() < 1e-8 * np.abs(found).max()
    assert np.abs(found - found.T).max() < 1e-8 * np.abs(found).max()


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
@settings(drawn, max_examples=12)
@given(parameters=half_cars, speed=st.floats(2.0, 40.0), start=none_or | st.floats(0.01, 5.0))
def test_weight_and_momentum_of_a_journey(parameters, speed, start):
    """On the reference road: the weight is carried, and what is accelerated is pushed by the road."""
    road = mf.track(
        mf.EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9), mf.Spring(stiffness=8.0e6, damping=3.0e4)
    )
    car = mf.half_car(**parameters)
    hump = mf.bump(height=1e-3, width=2.0, at=6.0 + start, length=70.0, start=-12.0)
    result = mf.simulate(road, car, hump, speed=speed, duration=0.5, start=start, time_step=5e-3, truncation=60.0)
    mass, *_ = held_matrices(car)
    total = result.acceleration.values @ mass @ np.asarray(car.vertical) + result.contact_force.values.sum(axis=1)
    assert np.abs(total).max() < 1e-8 * max(np.abs(result.contact_force.values).max(), 1e-4)
    weight = GRAVITY * np.trace(mass * np.diag(car.vertical))
    assert abs(float(result.static_load.sum()) - weight) < 1e-9 * weight

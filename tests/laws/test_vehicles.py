"""Laws of the vehicle at its contacts, put to every vehicle."""

from __future__ import annotations

import numpy as np
import pytest

import movingfrf as mf
from tests.helpers import DAMPED, GRAVITY, HALF_TRUCK, VEHICLES, dynamic_stiffness, held_matrices, rigid_motions

OMEGA = np.r_[0.0, np.geomspace(0.5, 3000.0, 25)]

every_vehicle = pytest.mark.parametrize("name", VEHICLES)


def at_contacts(vehicle, omega):
    """Ask the package for the dynamic stiffness, shape (frequency, contact, contact)."""
    return np.moveaxis(vehicle.dynamics().stiffness(np.asarray(omega, complex)), -1, 0)


def tyre_scale(vehicle):
    return max(contact.stiffness for contact in vehicle.contacts)


@every_vehicle
@pytest.mark.parametrize("decay", [0.0, 0.6])
def test_dynamic_stiffness_is_that_of_the_matrices(name, decay):
    """METHOD.md section 4, by one plain inverse per frequency; modal sums lose a few digits near a pole."""
    vehicle = VEHICLES[name]
    for omega in OMEGA - 1j * decay:
        expected = dynamic_stiffness(vehicle, omega)
        scale = np.abs(expected).max() + 1e-3 * tyre_scale(vehicle)
        assert np.abs(at_contacts(vehicle, [omega])[0] - expected).max() < 1e-9 * scale


def test_a_vehicle_without_modes_is_among_them():
    assert VEHICLES["critically_damped_mass"].dynamics().parts[0].modes is None
    assert VEHICLES["half_truck"].dynamics().parts[0].modes is not None


@every_vehicle
def test_dynamic_stiffness_is_symmetric(name):
    """Maxwell and Betti: the passive vehicle is reciprocal."""
    stiffness = at_contacts(VEHICLES[name], OMEGA)
    scale = tyre_scale(VEHICLES[name])
    assert np.abs(stiffness - stiffness.transpose(0, 2, 1)).max() < 1e-11 * scale


@every_vehicle
def test_dynamic_stiffness_is_real_and_dissipates(name):
    stiffness = at_contacts(VEHICLES[name], OMEGA[1:])
    mirrored = at_contacts(VEHICLES[name], -OMEGA[1:])
    assert np.abs(mirrored - stiffness.conj()).max() < 1e-10 * np.abs(stiffness).max()
    # Power drawn from a moved road is never negative: the imaginary part is positive semidefinite.
    for one in stiffness:
        assert np.linalg.eigvalsh(one.imag).min() > -1e-10 * np.abs(one).max()


@every_vehicle
def test_rest_resists_no_rigid_motion(name):
    vehicle = VEHICLES[name]
    stiffness, at = at_contacts(vehicle, [0.0])[0], np.asarray(vehicle.contact_map)
    for motion in rigid_motions(vehicle):
        assert np.abs(stiffness @ (at @ motion)).max() < 1e-9 * tyre_scale(vehicle)
    if len(vehicle.contacts) <= len(rigid_motions(vehicle)):
        assert np.abs(stiffness).max() < 1e-9 * tyre_scale(vehicle)
    else:
        assert np.abs(stiffness).max() > 1e-3 * tyre_scale(vehicle)


@every_vehicle
def test_limit_of_high_frequency_is_the_tyre_alone(name):
    """The wheels stand still in space: D → k_t + iω c_t; what is left falls with (ω_wheel/ω)²."""
    vehicle, omega = VEHICLES[name], 1e6
    *_, stiffness, damping = held_matrices(vehicle)
    expected = np.diag(stiffness + 1j * omega * damping)
    assert np.abs(at_contacts(vehicle, [omega])[0] - expected).max() < 2e-3 * np.abs(expected).max()


@every_vehicle
def test_static_loads_carry_the_weight_and_its_moment(name):
    vehicle = VEHICLES[name]
    mass = np.asarray(vehicle.mass)
    weight = GRAVITY * mass @ np.asarray(vehicle.vertical)
    at = np.asarray(vehicle.contact_map)
    for motion in rigid_motions(vehicle):
        # Virtual work of the weights and of the contact forces along the same rigid motion.
        expected = motion @ weight
        assert vehicle.static_loads @ (at @ motion) == pytest.approx(expected, rel=1e-10)
    assert vehicle.static_loads.sum() == pytest.approx(weight.sum(), rel=1e-10)


@every_vehicle
def test_offsets_are_receiver_minus_source(name):
    """Pair by pair; only a vehicle with contacts beside the centre line asks a guideway about places across."""
    vehicle = VEHICLES[name]
    offsets = vehicle.offsets
    beside = any(contact.across for contact in vehicle.contacts)
    assert set(offsets) == ({"ahead", "across", "source_across"} if beside else {"ahead"})
    assert all(table.shape == 2 * (len(vehicle.contacts),) for table in offsets.values())
    for i, receiver in enumerate(vehicle.contacts):
        for j, source in enumerate(vehicle.contacts):
            assert offsets["ahead"][i, j] == pytest.approx(receiver.position - source.position, abs=1e-9)
            if beside:
                assert offsets["across"][i, j] == receiver.across - source.across
                assert offsets["source_across"][i, j] == source.across


def test_static_loads_of_two_axles_follow_from_levers():
    """Body weight by the lever rule about the axles, wheels where they are, 9.81 m/s²."""
    front, rear = HALF_TRUCK["axles"]
    body, (wheel_front, wheel_rear) = HALF_TRUCK["body_mass"], HALF_TRUCK["wheel_masses"]
    expected = [
        9.81 * (body * -rear / (front - rear) + wheel_front),
        9.81 * (body * front / (front - rear) + wheel_rear),
    ]
    np.testing.assert_allclose(VEHICLES["half_truck"].static_loads, expected, rtol=1e-12)


def redistributed(vehicle, road, speed):
    """F₀ = F_s − D(0) W₀ with W₀ = G(0) F₀, METHOD.md section 5, from matrices alone."""
    positions = np.array([contact.position for contact in vehicle.contacts])
    frf = road.moving_frf(positions[:, None] - positions, speed, [0.0])[0].real
    stiffness = dynamic_stiffness(vehicle, 0.0).real
    force = vehicle.static_loads.copy()
    for _ in range(200):
        force = vehicle.static_loads - stiffness @ (frf @ force)
    return force, frf @ force


@pytest.mark.parametrize("speed", [2.0, 60.0])
@pytest.mark.parametrize("name", VEHICLES)
def test_sag_redistributes_the_weight_of_three_axles(name, speed):
    """In travel on a smooth road: found here by iteration, which contracts because D(0) G(0) < 1."""
    vehicle, road = VEHICLES[name], DAMPED["euler_bernoulli_winkler"]
    flat = mf.Profile([-10.0, 0.0, 10.0, 20.0], np.zeros((4, 2)))
    result = mf.simulate(road, vehicle, flat, speed=speed, duration=0.1, time_step=0.01)
    force, deflection = redistributed(vehicle, road, speed)
    np.testing.assert_allclose(result.static_load, force, rtol=1e-9)
    np.testing.assert_allclose(result.static_deflection, deflection, rtol=1e-9)
    assert float(result.static_load.sum()) == pytest.approx(vehicle.static_loads.sum(), rel=1e-10)
    change = np.abs(result.static_load.values / vehicle.static_loads - 1).max()
    # Two axles and two sides are as many as the motions that stretch nothing, and both sides sag alike.
    if np.unique(vehicle.positions).size > 2:
        assert change > 1e-3
    else:
        assert change < 1e-9
    for motion in rigid_motions(vehicle):
        moment = np.asarray(vehicle.contact_map) @ motion
        assert result.static_load.values @ moment == pytest.approx(vehicle.static_loads @ moment, rel=1e-9)


@every_vehicle
def test_rigid_road_leaves_the_static_loads_alone(name):
    flat = mf.Profile([-10.0, 0.0, 10.0, 20.0], np.zeros((4, 2)))
    result = mf.simulate(mf.RigidGuideway(), VEHICLES[name], flat, speed=10.0, duration=0.1, time_step=0.01)
    np.testing.assert_allclose(result.static_load, VEHICLES[name].static_loads, rtol=1e-12)
    assert not result.static_deflection.values.any()


def test_footprints_of_the_catalogue():
    assert [c.footprint for c in mf.catalogue("half_truck", footprint=0.3).contacts] == [0.3, 0.3]
    assert [c.footprint for c in mf.catalogue("half_truck", footprint=[0.2, 0.3]).contacts] == [0.2, 0.3]
    assert mf.catalogue("golden_car").contacts[0].footprint == 0.25
    assert mf.catalogue("golden_car", footprint=0.0).contacts[0].footprint == 0.0
    with pytest.raises(ValueError, match=r"footprint must have shape \(2\), got \(3,\)"):
        mf.catalogue("half_truck", footprint=[0.1, 0.2, 0.3])
    with pytest.raises(ValueError, match="footprint must not be negative"):
        mf.catalogue("half_truck", footprint=[0.1, -0.2])

"""Coupled stepping: laws at every instant, what a result says, interruptions."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import movingfrf as mf
from tests.helpers import (
    MARGIN,
    PAVEMENT,
    QUARTER_TRUCK,
    VEHICLES,
    difference,
    held_matrices,
    rates,
    three_axle_truck,
)
from tests.stepping.coupled_parts import DASHPOT, FLAT, HUMP, TRACK, over_hump, travelling


@pytest.mark.parametrize("compiled", [True, False], ids=["compiled", "plain"])
def test_in_steady_travel_a_dashpot_feels_nothing(compiled):
    """The total derivative under the contact, ẇ + v ∂w/∂x, is zero in a basin that travels along.

    On a strongly damped road the basin leans back: ∂w/∂x under the contact is far from zero. Were ẇ alone taken,
    the wheel would move by c v w′/k, thirty times the tolerance; with the wrong sign by twice that.
    """
    track = mf.track(
        mf.EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9), mf.Spring(stiffness=8.0e6, damping=3.0e5)
    )
    speed = 20.0
    # Whole steps to an element, so that what its passage modulates is the same in each.
    element = 0.125 if compiled else 0.25
    count = 320 if compiled else 60
    result = mf.cdfm(
        travelling(element, 20.0, 12.0, track),
        DASHPOT,
        FLAT,
        speed=speed,
        duration=count * element / speed / 10,
        time_step=element / speed / 10,
        run_in=1.0 if compiled else 0.25,
        compiled=compiled,
    )
    slope = track.moving_frf([0.0], speed, [0.0], derivative=1)[0, 0].real * DASHPOT.static_loads[0]
    convective = 8.0e4 * speed * slope / QUARTER_TRUCK["tyre_stiffness"]
    moved = np.abs(result.motion.values[:, 1]).max()
    assert moved < abs(convective) / 30


@pytest.mark.parametrize("scheme", ["average_acceleration", "generalised_alpha"])
@pytest.mark.parametrize("travels", [False, True], ids=["still", "travelling"])
def test_contact_law_and_newton_at_every_instant(scheme, travels):
    """F = k e + c ė with e = z − w + r under the contact, and M z̈ + C ż + K z + Bᵀ F = 0, from outputs alone.

    Rates by central differences of eighth order. The scheme's own velocities differ from those of its
    displacements by ω²Δt²/12 or so: 2e-4 with ¼ ms at 30 Hz.
    """
    step, inside = 2.5e-4, slice(MARGIN, -MARGIN)
    road = travelling(0.25, 25.0, 18.0) if travels else mf.finite_track(TRACK, first=-30.0, last=45.0)
    result = over_hump(road, DASHPOT, speed=20.0, time_step=step, duration=0.8, scheme=scheme, superposed=True)
    mass, damping, stiffness, at, k_tyre, c_tyre = held_matrices(DASHPOT)
    force, motion = result.contact_force.values, result.motion.values
    velocity, second = rates(motion, step)
    balance = second @ mass + velocity @ damping + motion[inside] @ stiffness + force[inside] @ at
    compression = motion @ at.T - (result.deflection - result.static_deflection).values + result.roughness.values
    spring = k_tyre * compression[inside] + c_tyre * rates(compression, step)[0]
    assert np.abs(balance).max() < 3e-4 * np.abs(force).max()
    assert difference(spring, force[inside]) < 3e-4


def test_a_vehicle_at_rest_on_the_road_needs_no_run_in():
    """Without run-in both begin at rest under the weight: nothing jumps at the first step."""
    road = mf.finite_track(TRACK, first=-20.0, last=40.0, element=0.25)
    result = over_hump(road, run_in=0.0, speed=1e-3, duration=0.2)
    assert np.abs(result.contact_force).max() < 1e-5 * VEHICLES["half_truck"].static_loads.max()
    at_rest = mf.simulate(TRACK, VEHICLES["half_truck"], FLAT, speed=1e-3, duration=0.2)
    np.testing.assert_allclose(result.static_deflection, at_rest.static_deflection, rtol=1e-4)


def test_what_a_result_says():
    """The variables of `simulate`, and the settings."""
    result = over_hump(travelling(0.5), method=mf.sim)
    spectral = mf.simulate(TRACK, VEHICLES["half_truck"], HUMP, speed=10.0, duration=1.5, blend=0.0)
    assert set(result.variables) == set(spectral.variables)
    for name in spectral.variables:
        assert result[name].dims == spectral[name].dims
        assert result[name].attrs == spectral[name].attrs
    assert result.attrs["road_dofs"] == 318
    assert result.attrs["time_step"] == 1e-3
    assert "SIM" in result.attrs["title"]
    assert "CDFM" in over_hump(travelling(0.5)).attrs["title"]


def test_a_lost_contact_is_announced():
    high = mf.bump(height=0.15, width=1.5, at=3.0, length=90.0, start=-40.0)
    with pytest.warns(mf.ValidityWarning, match="would lift off the road"):
        result = mf.cdfm(travelling(0.5), VEHICLES["half_truck"], high, speed=15.0, duration=1.0, blend=0.0)
    assert "contact_lost" in result.attrs["findings"]


class Interrupted:
    """A progress callback during which somebody presses Ctrl-C, when a stage first reports."""

    def __init__(self, stage):
        self.stage, self.fractions = stage, []

    def __call__(self, stage, fraction):
        if stage == self.stage:
            self.fractions.append(fraction)
            raise KeyboardInterrupt


@pytest.mark.parametrize("method", [mf.cdfm, mf.sim])
@pytest.mark.parametrize("compiled", [True, False], ids=["compiled", "plain"])
def test_an_interruption_ends_a_run(method, compiled):
    """The loops come up for air every so many steps, long before the end of a long run."""
    road = travelling(0.5, 8.0, 4.0)
    stage, steps = ("stepping", 400_000) if compiled else ("run-in", 0)
    interrupted = Interrupted(stage)
    long = {"duration": 4e-4 * max(steps, 100), "time_step": 4e-4, "run_in": 0.02, "speed": 20.0, "blend": 0.0}
    with pytest.raises(KeyboardInterrupt):
        method(road, VEHICLES["quarter_truck"], FLAT, compiled=compiled, progress=interrupted, **long)
    assert len(interrupted.fractions) == 1
    if compiled:
        assert interrupted.fractions[0] < 0.06


def test_progress_ends_with_everything_done():
    seen = []
    over_hump(travelling(0.5), progress=lambda stage, fraction: seen.append((stage, fraction)))
    assert seen[-1] == ("stepping", 1.0)
    assert ("run-in", 1.0) in seen


def test_inputs_are_left_alone():
    """Two runs with one road give the same bytes: nothing that is kept has been marched on."""
    road = travelling(0.5)
    first, second = over_hump(road, superposed=True), over_hump(road, superposed=True)
    assert (first.contact_force.values == second.contact_force.values).all()
    third = over_hump(replace(road), superposed=True)
    assert (first.motion.values == third.motion.values).all()


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_a_record_that_begins_on_a_bump():
    """Without blending a wheel stands on r(0) ≠ 0: F(0) = k r + c ṙ, as simulate says, and order 2 from there on.

    What simulate gives at the very first samples carries the ripple of a jump that a transform cannot avoid.
    """
    profile = mf.harmonic(amplitude=5e-3, wavelength=4.0, phase=0.9, length=40.0, start=-10.0)
    truck, options = VEHICLES["half_truck"], {"speed": 10.0, "duration": 0.5, "blend": 0.0}
    forces = {}
    for step in (2e-3, 1e-3, 5e-4, 1.25e-4):
        result = mf.cdfm(travelling(0.25), truck, profile, time_step=step, superposed=True, **options)
        forces[step] = result.contact_force.values[:: round(2e-3 / step)]
    springs = np.array([contact.stiffness for contact in truck.contacts])
    dashpots = np.array([contact.damping for contact in truck.contacts])
    height, rate = profile.along()(truck.positions), 10.0 * profile.along()(truck.positions, 1)
    # The datum is the elevation under the foremost contact.
    height = height - profile.along()(truck.positions.max())
    np.testing.assert_allclose(forces[2e-3][0], springs * height + dashpots * rate, rtol=1e-9)
    wanted = mf.simulate(TRACK, truck, profile, time_step=1.25e-4, truncation=400.0, **options)
    assert difference(forces[1.25e-4][20:], wanted.contact_force.values[::16][20:]) < 2e-3
    errors = [difference(forces[step][1:], forces[1.25e-4][1:]) for step in (2e-3, 1e-3, 5e-4)]
    order = np.polyfit(np.log([2e-3, 1e-3, 5e-4]), np.log(errors), 1)[0]
    assert order == pytest.approx(2.0, abs=0.2)


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_weight_on_a_road_that_gives_way_far():
    """Three stiff axles on a soft road: what the sag redistributes is more than a plain iteration can bear."""
    soft = mf.track(PAVEMENT, mf.Spring(stiffness=3.0e5, damping=3.0e4))
    stiff = three_axle_truck()
    stiff = replace(stiff, contacts=[replace(contact, stiffness=2e7) for contact in stiff.contacts])
    smooth = mf.Profile([-1e3, 0.0, 1e3, 2e3], np.zeros(4))
    road = mf.finite_track(soft, first=-60.0, last=60.0, element=0.5, travels=True, absorbing=40.0)
    options = {"speed": 10.0, "duration": 0.5}
    result = mf.cdfm(road, stiff, smooth, run_in=3.0, superposed=True, **options)
    wanted = mf.simulate(soft, stiff, smooth, **options)
    np.testing.assert_allclose(result.static_load, wanted.static_load, rtol=2e-3)

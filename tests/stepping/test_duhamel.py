"""Duhamel's integral with a moving impulse response: against closed forms, the frequency domain, and its step."""

from __future__ import annotations

import numpy as np
import pytest

import movingfrf as mf
from tests.helpers import DAMPED, VEHICLES, apart, difference, observed_order

TRACK = DAMPED["euler_bernoulli_winkler"]
TRUCK = VEHICLES["half_truck"]
AXLES = float(np.ptp(TRUCK.positions))


@pytest.fixture(scope="module")
def struck():
    return mf.struck_track(TRACK, speed=10.0, offsets=[0.0, AXLES, -AXLES])


def rough():
    return mf.realise(mf.IsoRoad.of_class("A", band=(0.02, 2.0)), length=50.0, step=0.02, seed=1, start=-8.0)


def drive(road, method, vehicle=TRUCK, profile=None, **more):
    options = {"speed": 10.0, "duration": 2.5} | more
    return method(road, vehicle, rough() if profile is None else profile, **options)


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_order_towards_the_frequency_domain(struck):
    """Order 2 in the step, down to the struck road's own error (1e-5, see the tests of the impulse).

    Newmark's method for the vehicle, backward differences of second order for the dashpots and contact forces that
    are linear within a step are each of order 2.
    """
    steps = np.array([4e-3, 2e-3, 1e-3, 5e-4])
    errors = []
    for step in steps:
        wanted = drive(TRACK, mf.simulate, time_step=step, truncation=min(300.0, 0.5 / step))
        errors.append(apart(drive(struck, mf.duhamel, time_step=step), wanted))
    for output in errors[0]:
        order = observed_order(steps, [error[output] for error in errors])
        assert order == pytest.approx(2.0, abs=0.1), output
    finest = errors[-1]
    assert finest["contact_force"] < 1e-4
    assert finest["motion"] < 1e-4
    assert finest["deflection"] < 2e-4
    assert finest["acceleration"] < 1e-3


def test_steady_state_is_that_of_the_track(struck):
    result = drive(struck, mf.duhamel, duration=0.5)
    wanted = drive(TRACK, mf.simulate, duration=0.5)
    np.testing.assert_allclose(result.static_deflection, wanted.static_deflection, rtol=1e-4)
    np.testing.assert_allclose(result.static_load, wanted.static_load, rtol=1e-9)


def test_three_axles_share_their_weight():
    truck = VEHICLES["three_axles"]
    offsets = np.unique(np.subtract.outer(truck.positions, truck.positions).round(12))
    road = mf.struck_track(TRACK, speed=20.0, offsets=offsets)
    flat = mf.Profile(np.linspace(-10.0, 60.0, 6), np.zeros(6))
    result = drive(road, mf.duhamel, truck, flat, speed=20.0, duration=0.5)
    wanted = drive(TRACK, mf.simulate, truck, flat, speed=20.0, duration=0.5)
    shifted = np.abs(wanted.static_load - truck.static_loads).max()
    assert np.abs(result.static_load - wanted.static_load).max() < 1e-3 * shifted
    np.testing.assert_allclose(result.static_deflection, wanted.static_deflection, rtol=1e-4)
    assert np.abs(result.contact_force).max() == 0.0


def massless(step=1e-3, duration=3.0):
    """Make a road without mass on springs and dashpots: g = A e^{−at}, whose first sample is its largest."""
    time = step * np.arange(round(duration / step))
    ringing = 1e-6 * np.exp(-10 * time)[:, None]
    return mf.SampledGuideway(response=ringing, time_step=step, offsets=[0.0], speed=10.0)


def test_a_response_that_begins_with_its_largest_value():
    """It gives way by the transform at ω = 0, as everywhere in the package: the first sample counts half."""
    truck = VEHICLES["quarter_truck"]
    result = drive(massless(), mf.duhamel, truck, duration=0.5)
    wanted = drive(massless(), mf.simulate, truck, duration=0.5)
    np.testing.assert_allclose(result.static_deflection, wanted.static_deflection, rtol=1e-9)


def test_compiled_and_plain_loops_are_one(struck):
    """One and two contacts; with a memory shorter and longer than the record."""
    for road, vehicle in (
        (struck, TRUCK),
        (massless(), VEHICLES["quarter_truck"]),
    ):
        for step, duration in ((5e-3, 0.3), (2e-3, 3.5)):
            compiled, plain = (
                drive(road, mf.duhamel, vehicle, time_step=step, duration=duration, compiled=flag)
                for flag in (True, False)
            )
            assert max(apart(compiled, plain).values()) < 1e-10


def test_a_coarser_step_than_that_of_the_response():
    """Steps of one, four and eight samples: hats are integrated, the response stays as fine as it is."""
    road = massless(2.5e-4)
    for step in (2.5e-4, 1e-3, 2e-3):
        time = step * np.arange(round(1.0 / step))
        force = 1e5 * time[:, None]
        found = mf.duhamel_loads(road, force, [0.0], speed=10.0, time_step=step).deflection.values[:, 0]
        # ∫ A e^{−a(t − τ)} τ dτ = A/a (t − (1 − e^{−at})/a); the trapezoidal rule is off by (aΔt)²/12 = 5e-7.
        exact = 1e-6 * 1e5 / 10 * (time - (1 - np.exp(-10 * time)) / 10)
        assert np.abs(found - exact).max() < 1e-6 * exact.max()


def test_a_force_that_is_there_from_the_start():
    """A/a (1 − e^{−at}) under a constant force: of its first hat only the half after t = 0 exists."""
    time = 1e-3 * np.arange(1000)
    found = mf.duhamel_loads(massless(), np.full((1000, 1), 1e5), [0.0], speed=10.0).deflection.values[:, 0]
    exact = 1e-6 * 1e5 / 10 * (1 - np.exp(-10 * time))
    # (aΔt)²/12 = 8e-6, and a fifth of that per step at the beginning.
    assert np.abs(found - exact).max() < 2e-5 * exact.max()
    np.testing.assert_allclose(found[1:20], exact[1:20], rtol=2e-3)
    assert found[0] == 0.0


def test_an_impulse_gives_the_response_back():
    """A force that is one triangle of unit area: what remains of the response within two steps is smoothed."""
    force = np.zeros((500, 1))
    force[10] = 1 / 1e-3
    found = mf.duhamel_loads(massless(), force, [0.0], speed=10.0).deflection.values[:, 0]
    assert np.abs(found[:10]).max() == 0.0
    # One half of the triangle is behind the tip.
    assert found[10] == pytest.approx(0.5e-6, rel=0.01)
    np.testing.assert_allclose(found[11:], 1e-6 * np.exp(-10 * 1e-3 * np.arange(1, 490)), rtol=1e-4)


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_prescribed_loads_on_a_track(struck):
    """Two forces against `moving_loads` on the closed form, seen at both and elsewhere."""
    time = 1e-3 * np.arange(1500)
    pulse = np.sin(np.pi * np.clip(time / 0.5, 0.0, 1.0)) ** 4
    force = np.stack([1e5 * pulse, -4e4 * pulse * np.sin(40 * time)], axis=1)
    at = [0.0, -AXLES]
    found = mf.duhamel_loads(struck, force, at, speed=10.0).deflection.values
    wanted = mf.moving_loads(TRACK, force, at, speed=10.0).deflection.values
    assert difference(found, wanted) < 1e-3
    # Ahead and behind are told apart.
    assert difference(found[:, ::-1], wanted) > 0.1
    elsewhere = mf.duhamel_loads(struck, force[:, :1], [0.0], speed=10.0, observe=[AXLES]).deflection.values
    wanted = mf.moving_loads(TRACK, force[:, :1], [0.0], speed=10.0, observe=[AXLES]).deflection.values
    assert difference(elsewhere, wanted) < 2e-3


def test_progress():
    seen = []
    drive(massless(), mf.duhamel, VEHICLES["quarter_truck"], progress=lambda *what: seen.append(what))
    assert seen[-1] == ("convolving", 1.0)


def test_an_interruption_ends_a_run():
    def interrupted(stage, fraction):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        drive(massless(), mf.duhamel, VEHICLES["quarter_truck"], progress=interrupted)


@pytest.mark.parametrize("step", [1.5e-3, 5e-4, 1.0001e-3])
def test_a_step_that_is_no_multiple_is_refused(step):
    truck = VEHICLES["quarter_truck"]
    message = f"time_step must be a whole multiple of 0.001 s, the step of the impulse response, got {step}"
    with pytest.raises(ValueError, match=message):
        drive(massless(), mf.duhamel, truck, time_step=step)
    with pytest.raises(ValueError, match=message):
        mf.duhamel_loads(massless(), np.ones((10, 1)), [0.0], speed=10.0, time_step=step)


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"force": np.ones((10, 2))}, r"force must have shape \(any, 1\), got \(10, 2\)"),
        ({"force": np.ones((1, 1))}, "force must have at least two samples, one load and one observation point"),
        ({"observe": []}, "force must have at least two samples, one load and one observation point"),
        ({"observe": [1.0]}, "ahead must be one of the recorded offsets"),
        ({"speed": 9.0}, "speed must be 10.0 m/s, at which"),
        ({"positions": [np.nan]}, "positions must be finite"),
    ],
)
def test_refusals(more, message):
    options = {"force": np.ones((10, 1)), "positions": [0.0], "speed": 10.0} | more
    with pytest.raises(ValueError, match=message):
        mf.duhamel_loads(massless(), **options)


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_a_record_that_begins_on_a_bump(struck):
    """Forces that act from t = 0 on enter the integral by half a hat: order 2 from the first step on."""
    profile = mf.harmonic(amplitude=5e-3, wavelength=4.0, phase=0.9, length=40.0, start=-10.0)
    steps, options = [4e-3, 2e-3, 1e-3], {"speed": 10.0, "duration": 0.064, "blend": 0.0}
    found = {
        step: mf.duhamel(struck, TRUCK, profile, time_step=step, **options) for step in (*steps, struck.time_step)
    }
    springs = np.array([contact.stiffness for contact in TRUCK.contacts])
    dashpots = np.array([contact.damping for contact in TRUCK.contacts])
    height = profile.along()(TRUCK.positions) - profile.along()(TRUCK.positions.max())
    first = springs * height + dashpots * 10.0 * profile.along()(TRUCK.positions, 1)
    np.testing.assert_allclose(found[1e-3].contact_force.values[0], first, rtol=1e-9)
    fine = found[struck.time_step].deflection.values - found[struck.time_step].static_deflection.values
    errors = []
    for step in steps:
        moving = found[step].deflection.values - found[step].static_deflection.values
        errors.append(difference(moving[1:], fine[:: round(step / struck.time_step)][1:]))
    order = np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert order == pytest.approx(2.0, abs=0.3)

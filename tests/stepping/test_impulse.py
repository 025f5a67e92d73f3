"""Struck roads: the moving impulse response, its transform, and what the ends of a short road do to it."""

from __future__ import annotations

import numpy as np
import pytest

import movingfrf as mf
from tests.helpers import DAMPED, VEHICLES, apart, difference

TRACK = DAMPED["euler_bernoulli_winkler"]
OFFSETS = np.array([0.0, 4.27, -4.27])
FREQUENCIES = np.arange(0.0, 71.0)
OMEGA = 2 * np.pi * FREQUENCIES


def error(struck, track=TRACK, speed=10.0, offsets=OFFSETS, omega=OMEGA):
    """Difference from the closed form, (frequency, offset), and the closed form."""
    exact = track.moving_frf(offsets, speed, omega)
    return np.abs(struck.moving_frf(offsets, speed, omega) - exact), np.abs(exact)


# Struck once for each speed: all tests look at the same three responses.
@pytest.fixture(scope="module", params=[0.0, 10.0, 30.0], ids=["at rest", "10 m/s", "30 m/s"])
def improved(request):
    return mf.struck_track(TRACK, speed=request.param, offsets=OFFSETS)


def test_forty_metres_are_enough(improved):
    """Four roads of 40 m whose end reflections cancel: below 70 Hz 2.8e-4 of max |G| at each offset (measured).

    METHOD.md promises 1e-3; pointwise it is 4e-3 of G, which falls to a twentieth at one axle distance.
    """
    apart, exact = error(improved, speed=improved.speed)
    largest = np.abs(TRACK.moving_frf([0.0], improved.speed, OMEGA)).max()
    assert apart.max() < 4e-4 * largest
    assert (apart / exact).max() < 1e-2
    assert improved.critical_speed == pytest.approx(TRACK.critical_speed)


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_the_papers_road_is_as_wrong_as_it_is():
    """METHOD.md section 3: 40 m, pinned, 0.5 m, 1 ms, ξ = 0, 10 m/s: 3.0e-2 and 8.8e-2 at 50 and 70 Hz.

    Measured there by other means; the two programs differ in how they begin.
    """
    plain = mf.struck_track(TRACK, speed=10.0, offsets=[0.0], plain=True)
    apart, exact = error(plain, offsets=np.zeros(1))
    relative = (apart / exact)[:, 0]
    assert relative[50] == pytest.approx(3.0e-2, rel=0.1)
    assert relative[70] == pytest.approx(8.8e-2, rel=0.1)
    # Its floor in terms of max |G|: 5e-3.
    assert apart.max() / exact.max() == pytest.approx(5e-3, rel=0.3)


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_a_longer_road_and_a_finer_step():
    """METHOD.md section 3, 200 m and ¼ ms: 9e-4 at 50 Hz, 2e-3 at 70 Hz."""
    road = mf.finite_track(TRACK, first=-100.0, last=100.0, element=0.5, ends="pinned")
    struck = mf.moving_impulse_response(road, speed=10.0, offsets=[0.0], strike=0.0, time_step=2.5e-4)
    apart, exact = error(struck, offsets=np.zeros(1))
    relative = (apart / exact)[:, 0]
    assert relative[50] < 1.5e-3
    assert relative[70] < 3e-3


def test_absorbing_ends_do_as_well():
    """One road of 60 m whose ends absorb."""
    road = mf.finite_track(TRACK, first=-30.0, last=30.0, absorbing=20.0)
    struck = mf.moving_impulse_response(road, speed=10.0, offsets=OFFSETS, strike=0.0, scheme="generalised_alpha")
    apart, _ = error(struck)
    largest = np.abs(TRACK.moving_frf([0.0], 10.0, OMEGA)).max()
    assert apart.max() < 5e-4 * largest


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_four_ends_are_better_than_one():
    """Each single road of 40 m is off by 2e-2 of max |G|; in the average what met an end oddly often cancels."""
    kinds = [(a, b) for a in ("pinned", "guided") for b in ("pinned", "guided")]
    roads = [mf.finite_track(TRACK, first=-20.0, last=20.0, element=0.5, ends=ends) for ends in kinds]
    options = {"speed": 10.0, "offsets": OFFSETS, "strike": 0.0, "time_step": 2e-4, "scheme": "generalised_alpha"}
    largest = np.abs(TRACK.moving_frf([0.0], 10.0, OMEGA)).max()
    alone = [error(mf.moving_impulse_response(road, **options))[0].max() / largest for road in roads]
    together = mf.moving_impulse_response(roads, **options)
    assert min(alone) > 5e-3
    assert error(together)[0].max() / largest < 0.1 * min(alone)
    # The average, sample by sample.
    records = [mf.moving_impulse_response(road, **options).samples for road in roads]
    np.testing.assert_allclose(together.samples, np.mean(records, axis=0), rtol=1e-12, atol=1e-20)


@pytest.mark.parametrize("name", ["rail_pad_sleeper_ballast", "euler_bernoulli_pasternak", "bending_damping"])
def test_other_tracks(name):
    """Layers of mass, Pasternak, damped bending; the same four roads, 20 m long."""
    track, rail = DAMPED[name], name.startswith("rail")
    half, element = (10.0, 0.25) if rail else (20.0, 0.5)
    kinds = [(a, b) for a in ("pinned", "guided") for b in ("pinned", "guided")]
    roads = [mf.finite_track(track, first=-half, last=half, element=element, ends=ends) for ends in kinds]
    struck = mf.moving_impulse_response(
        roads,
        speed=20.0,
        offsets=[0.0, 2.0, -2.0],
        strike=0.0,
        duration=0.25 if rail else 0.8,
        time_step=2e-4,
        scheme="generalised_alpha",
    )
    apart, exact = error(struck, track, 20.0, np.array([0.0, 2.0, -2.0]))
    assert apart.max() < 3e-3 * exact.max()


@pytest.mark.filterwarnings("ignore:waves come back")
def test_an_impulse_is_a_velocity():
    """One unknown of mass m on a spring: struck it swings as e^{−ζt} sin(ωt)/(mω).

    The step slows it by (ωΔt)²/12: a phase of 2.6e-3 t, which is 1e-4 of the vibration at most while that decays.
    """
    road = mf.FiniteGuideway(
        mass=[[2000.0]],
        damping=[[4e4]],
        stiffness=[[5.0e6]],
        interpolation=lambda x, derivative: np.full((x.size, 1), 1.0 - derivative),
        interval=(-10.0, 30.0),
    )
    struck = mf.moving_impulse_response(
        road, speed=1.0, offsets=[0.0, 3.0], strike=0.0, time_step=5e-4, duration=1.0, band=10.0
    )
    time = 5e-4 * np.arange(2001)
    omega = np.sqrt(2500.0 - 10.0**2)
    exact = np.exp(-10.0 * time) * np.sin(omega * time) / (2000.0 * omega)
    assert struck.samples.shape == (2001, 2)
    assert np.abs(struck.samples - exact[:, None]).max() < 2e-4 * exact.max()
    # At rest the transform is the compliance 1/k.
    assert struck.moving_frf(0.0, 1.0, [0.0]).real == pytest.approx(1 / 5.0e6, rel=2e-4)


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
@pytest.mark.parametrize("scheme", ["average_acceleration", "hilber_hughes_taylor", "generalised_alpha"])
def test_compiled_and_plain_loops_are_one(scheme):
    road = mf.finite_track(TRACK, first=-10.0, last=10.0, element=0.5, ends=("pinned", "guided"))
    compiled, plain = (
        mf.moving_impulse_response(
            road,
            speed=10.0,
            offsets=OFFSETS,
            strike=-2.5,
            time_step=1e-3,
            duration=0.1,
            scheme=scheme,
            compiled=flag,
        ).samples
        for flag in (True, False)
    )
    assert difference(compiled, plain) < 1e-11


def test_travelling_backwards_is_the_mirror_image():
    """G(ξ, v) = G(−ξ, −v)."""
    road = mf.finite_track(TRACK, first=-30.0, last=30.0, element=0.5, absorbing=20.0)
    forward, backward = (
        mf.moving_impulse_response(
            road, speed=sign * 10.0, offsets=sign * OFFSETS, strike=0.0, time_step=5e-4, band=40.0
        ).samples
        for sign in (1, -1)
    )
    assert difference(backward, forward) < 1e-9
    assert difference(forward[:, 1], forward[:, 2]) > 0.1


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_a_struck_road_is_a_guideway_like_any_other():
    """`simulate` on it and on the closed form, 1e-5 in every output; `moving_loads` as well."""
    truck = VEHICLES["half_truck"]
    distance = float(np.ptp(truck.positions))
    struck = mf.struck_track(TRACK, speed=10.0, offsets=[0.0, distance, -distance])
    profile = mf.realise(mf.IsoRoad.of_class("A", band=(0.02, 2.0)), length=50.0, step=0.02, seed=1, start=-8.0)
    first, second = (
        mf.simulate(road, truck, profile, speed=10.0, duration=3.0, truncation=70.0) for road in (struck, TRACK)
    )
    assert max(apart(first, second).values()) < 1e-4
    np.testing.assert_allclose(first.static_deflection, second.static_deflection, rtol=1e-4)
    force = 1e5 * np.sin(np.pi * np.arange(1000) / 1000)[:, None] ** 4
    first, second = (
        mf.moving_loads(road, force, [0.0], speed=10.0, observe=[0.0, distance]).deflection
        for road in (struck, TRACK)
    )
    assert difference(first, second) < 1e-3


def test_it_says_when_the_response_has_not_died_away():
    road = mf.finite_track(TRACK, first=-30.0, last=30.0, element=0.5, absorbing=20.0)
    options = {"speed": 10.0, "offsets": [0.0], "strike": 0.0, "time_step": 5e-4, "band": 40.0}
    with pytest.warns(mf.ValidityWarning, match="has not died away: after 0.1 s"):
        mf.moving_impulse_response(road, duration=0.1, **options)
    # Long enough: nothing is said, which `filterwarnings = error` would turn into a failure.
    mf.moving_impulse_response(road, duration=1.5, **options)


def test_it_says_when_the_step_is_long():
    """(ωΔt)²/12 of a period at the highest frequency of the band: 1.6 % for 70 Hz and 1 ms."""
    road = mf.finite_track(TRACK, first=-30.0, last=30.0, element=0.5, absorbing=20.0)
    with pytest.warns(mf.ValidityWarning, match=r"long for 70 Hz: vibrations there are slowed by 1\.6%"):
        mf.moving_impulse_response(road, speed=10.0, offsets=[0.0], strike=0.0, time_step=1e-3)


def test_it_says_when_the_ends_reflect():
    """Pinned ends of 40 m: a wave of 50 to 70 Hz is back with a fifth; 1e-2 of max |G| (METHOD.md section 3)."""
    road = mf.finite_track(TRACK, first=-20.0, last=20.0, element=0.5, ends="pinned")
    with pytest.warns(mf.ValidityWarning) as warned:
        mf.moving_impulse_response(road, speed=0.0, offsets=[0.0], strike=0.0, time_step=5e-4)
    messages = [str(each.message) for each in warned]
    assert any("waves come back from the ends of the road" in message for message in messages)


def test_the_papers_road_says_all_three():
    with pytest.warns(mf.ValidityWarning) as warned:
        mf.struck_track(TRACK, speed=10.0, offsets=[0.0], plain=True)
    messages = " | ".join(str(each.message) for each in warned)
    for finding in ("has not died away", "is long for 70 Hz", "waves come back from the ends"):
        assert finding in messages


OPTIONS = {"speed": 10.0, "offsets": [0.0], "strike": 0.0, "time_step": 5e-4, "band": 40.0}


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"duration": 4.0}, r"roads must be long enough: points .* stay on the road, .* for 3 s, not for the"),
        ({"offsets": [35.0]}, "roads must be long enough"),
        ({"offsets": [-31.0]}, "roads must be long enough"),
        ({"strike": 30.5}, "roads must be long enough"),
        ({"speed": -10.0, "duration": 3.1}, "roads must be long enough"),
        ({"time_step": 7e-3}, "time_step must be at most 0.00625 s to hold 40 Hz, got 0.007 s"),
        ({"time_step": 0.0}, "time_step must be positive"),
        ({"band": -1.0}, "band must be positive"),
        ({"offsets": []}, "offsets must hold at least one"),
        ({"duration": 0.0}, "duration must be positive"),
        ({"strike": np.nan}, "strike must be a finite number"),
        ({"scheme": "runge_kutta"}, "scheme must be a Scheme or one of average_acceleration, linear"),
    ],
)
def test_refusals(more, message):
    road = mf.finite_track(TRACK, first=-30.0, last=30.0, element=0.5)
    with pytest.raises(ValueError, match=message):
        mf.moving_impulse_response(road, **(OPTIONS | more))


def test_roads_that_cannot_be_struck():
    road = mf.finite_track(TRACK, first=-30.0, last=30.0, element=0.5, travels=True)
    for roads in (road, [], [TRACK]):
        with pytest.raises(ValueError, match="roads must be one or more roads that stand still"):
            mf.moving_impulse_response(roads, **OPTIONS)


def test_struck_track_refuses_what_its_elements_do_not_suit():
    with pytest.raises(ValueError, match="element must be at most"):
        mf.struck_track(TRACK, speed=10.0, offsets=[0.0], band=2000.0)
    with pytest.raises(ValueError, match="roads must be long enough"):
        mf.struck_track(TRACK, speed=10.0, offsets=[20.5])

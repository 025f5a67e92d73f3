"""Wheels on a plate of finite elements: both domains, Duhamel, travelling plates, what is refused."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve

import movingfrf as mf
from movingfrf.stepping.marching import March
from movingfrf.stepping.schemes import SCHEMES
from movingfrf.stepping.tie import tie_of
from tests.helpers import DAMPED, FULL_TRUCK, QUARTER_TRUCK, TIMOSHENKO, apart, difference
from tests.stepping.plate_parts import (
    CAR,
    HUMPS,
    TRACK,
    plate,
    strike,
)


def two_paths(seeds=(1, 2)):
    """Make a road without anything in common left and right."""
    paths = [
        mf.realise(mf.IsoRoad.of_class("A", band=(0.02, 2.0)), length=50.0, step=0.02, seed=seed, start=-8.0)
        for seed in seeds
    ]
    return mf.Profile(paths[0].distance, np.stack([np.ravel(path.elevation) for path in paths], axis=1))


def travelling(element, across):
    return plate(element=element, across=across, absorbing=12.0, travels=True)


@pytest.mark.filterwarnings("ignore:the vehicle's motion has not died away")
def test_time_and_frequency_domain_converge_to_each_other(struck):
    """Four wheels on a plate, stepped along with it, against `simulate` on the struck one.

    Elements and steps of both orders are refined at once; at the finest force 1.8e-4, motion 8e-5, acceleration and
    deflection 3.5e-4, roll 1.3e-5, of which the struck plate's own elements keep some. The last 50 ms are left out,
    where the two continue the profile differently.
    """
    differences = []
    for element, across, step in ((0.5, 2, 2e-3), (0.5, 4, 1e-3), (0.25, 4, 5e-4)):
        options = {"speed": 10.0, "duration": 1.0, "time_step": step}
        spectral = mf.simulate(struck, CAR, two_paths(), truncation=200.0, **options)
        stepped = mf.cdfm(travelling(element, across), CAR, two_paths(), superposed=True, run_in=0.2, **options)
        found = apart(stepped, spectral, slice(0, round(0.95 / step)))
        found["roll"] = difference(stepped.motion.sel(dof="roll"), spectral.motion.sel(dof="roll"))
        differences.append(list(found.values()))
    differences = np.array(differences)
    assert (differences[-1] < [3e-4, 1.2e-4, 6e-4, 7e-4, 2e-5]).all()
    assert (differences[1:] < 0.5 * differences[:-1]).all()
    np.testing.assert_allclose(stepped.static_deflection, spectral.static_deflection, rtol=2e-4)
    np.testing.assert_allclose(stepped.static_load, spectral.static_load, rtol=1e-9)
    # Both halves of the road matter.
    assert np.abs(spectral.motion.sel(dof="roll")).max() > 0.2 * np.abs(spectral.motion.sel(dof="bounce")).max()


@pytest.mark.filterwarnings("ignore:the vehicle's motion has not died away")
def test_duhamel_on_a_struck_plate(struck):
    """The same record in the time domain: of second order in the step, 1e-3 at one millisecond."""
    differences = []
    for step in (2e-3, 1e-3):
        options = {"speed": 10.0, "duration": 1.0, "time_step": step}
        convolved = mf.duhamel(struck, CAR, two_paths(), **options)
        spectral = mf.simulate(struck, CAR, two_paths(), truncation=200.0, **options)
        differences.append(list(apart(convolved, spectral, slice(0, round(0.95 / step))).values()))
    assert (np.array(differences[1]) < [1e-3, 5e-4, 5e-3, 1.5e-3]).all()
    assert (np.array(differences[1]) < 0.5 * np.array(differences[0])).all()
    np.testing.assert_allclose(convolved.static_load, spectral.static_load, rtol=1e-9)


def over_humps(road, method=mf.cdfm, vehicle=CAR, **more):
    options = {"speed": 20.0, "duration": 0.4, "time_step": 2e-3, "blend": 0.0, "run_in": 0.3} | more
    return method(road, vehicle, HUMPS, **options)


def test_a_travelling_plate_is_a_long_one():
    """Seen from the vehicle an endless road is the same wherever it is; sixteen elements go by."""
    moving = over_humps(travelling(0.5, 2))
    whole = over_humps(plate(first=-28.0, last=30.0, element=0.5, across=2, absorbing=12.0))
    # What the ends send back, as for a beam: 1.8e-4 of the accelerations, 1.2e-4 of the deflection.
    assert max(apart(moving, whole).values()) < 4e-4
    np.testing.assert_allclose(moving.static_deflection, whole.static_deflection, rtol=1e-5)
    assert np.abs(moving.motion.sel(dof="roll")).max() > 1e-4


def test_exchanged_forces_on_a_plate_are_the_solved_ones():
    road = plate(first=-28.0, last=30.0, element=0.5, across=2, absorbing=12.0)
    coupled, exchanged = over_humps(road), over_humps(road, mf.sim)
    assert max(apart(exchanged, coupled).values()) < 1e-7


def test_schemes_on_a_plate_agree():
    """Both of order 2: at 2 ms they differ by 5e-4 of the force and 1e-4 of the deflection."""
    first, second = (
        over_humps(travelling(0.5, 2), scheme=name) for name in ("generalised_alpha", "average_acceleration")
    )
    found = apart(first, second)
    assert found["contact_force"] < 1e-3
    assert found["deflection"] < 3e-4


def test_a_car_at_rest_on_a_plate_needs_no_run_in():
    """Its equilibrium, found at once, is one: on wheels that share the weight as the road gives way under each.

    Beside the middle the body leans; the right wheels stand near the edge.
    """
    leaning = mf.full_car(**(FULL_TRUCK | {"sides": (0.3, -0.9)}))
    flat = mf.Profile(np.linspace(-20.0, 20.0, 6), np.zeros((6, 2)))
    road = plate(element=0.5, across=4, absorbing=12.0)
    result = mf.cdfm(road, leaning, flat, speed=1e-6, duration=0.1, run_in=0.0)
    assert np.abs(result.contact_force).max() < 1e-6 * leaning.static_loads.max()
    np.testing.assert_allclose(result.deflection[0], result.static_deflection, rtol=1e-9)
    rows = road.rows(leaning.positions, 0, leaning.across).toarray()
    yields = rows @ np.stack([spsolve(road.stiffness, row) for row in rows], axis=1)
    np.testing.assert_allclose(result.static_deflection, yields @ result.static_load.values, rtol=1e-9)
    # What the road redistributes turns opposite corners against each other: weight and both moments stay.
    change = result.static_load.values - leaning.static_loads
    assert np.abs(change).max() > 5e-4 * leaning.static_loads.max()
    for levers in (np.ones(4), leaning.positions, leaning.across):
        assert abs(levers @ change) < 1e-9 * leaning.static_loads.sum()


def test_forces_at_the_start_fit_any_state():
    """F = k (z − w + r) + c (ż − ẇ − v w′ + ṙ) below each wheel, and M ü + C u̇ + K u = Σ Nᵀ F on the road."""
    road, random = plate(half=8.0, element=0.5, across=2), np.random.default_rng(7)
    march = March(
        guideway=road,
        scheme=SCHEMES["average_acceleration"],
        time_step=1e-3,
        speed=30.0,
        contacts=CAR.positions + 0.7,
        contacts_across=CAR.across,
        observers=np.empty(0),
        tie=tie_of(CAR),
    )
    state = march.at_rest()
    state.guideway[:2], state.body[:2] = random.normal(size=(2, road.dofs)), random.normal(size=(2, 7))
    roughness, rate, load = random.normal(size=(3, 4))
    march.begun(state, roughness, rate, load)
    rows, slopes = (road.rows(CAR.positions + 0.7, order, CAR.across) for order in (0, 1))
    wheels, velocities = state.body[:2, 3:]
    springs, dashpots = np.array([(contact.stiffness, contact.damping) for contact in CAR.contacts]).T
    force = springs * (wheels - rows @ state.guideway[0] + roughness)
    force += dashpots * (velocities - rows @ state.guideway[1] - 30.0 * (slopes @ state.guideway[0]) + rate)
    np.testing.assert_allclose(state.acting, force + load, rtol=1e-10)
    balance = road.mass @ state.guideway[2] + road.damping @ state.guideway[1] + road.stiffness @ state.guideway[0]
    assert np.abs(balance - rows.T @ state.acting).max() < 1e-9 * np.abs(road.stiffness @ state.guideway[0]).max()


def test_points_of_the_centre_line_that_stand_still():
    """A point sees what a contact on the centre line sees while that passes it: at 3 m after 75 steps."""
    quarter = mf.quarter_car(**QUARTER_TRUCK)
    road = plate(first=-28.0, last=30.0, element=0.5, across=2, absorbing=12.0)
    result = over_humps(road, vehicle=quarter, observe=[3.0])
    assert result.place_deflection.values[75, 0] == pytest.approx(result.deflection.values[75, 0], rel=1e-12)


# What cannot be.

LAYERED, OTHER_BEAM = (
    DAMPED["rail_pad_sleeper_ballast"],
    mf.track(TIMOSHENKO, mf.Spring(stiffness=8e6, damping=0.0)),
)


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"track": LAYERED}, "track must be an Euler–Bernoulli beam on springs or a shear layer to be spread over"),
        ({"track": OTHER_BEAM}, "track must be an Euler–Bernoulli beam on springs or a shear layer"),
        ({"track": mf.RigidGuideway()}, "track must be an Euler–Bernoulli beam on springs"),
        ({"poisson": 0.5}, r"poisson must be less than 0\.5, got 0\.5"),
        ({"poisson": -0.1}, r"poisson must not be negative, got -0\.1"),
        ({"transverse": 0.0}, r"transverse must be positive, got 0\.0"),
        ({"width": 0.0}, r"width must be positive, got 0\.0 m"),
        ({"across": 0}, "across must be a whole number of at least 1, got 0"),
        ({"across": 2.0}, r"across must be a whole number of at least 1, got 2\.0"),
        (
            {"width": 10.0, "across": 4},
            r"across must be at least 6, so that an element is no wider than the length 1\.675 m over which",
        ),
        ({"element": 2.5}, r"element must be at most .* m, the length \(4 EI/k\)\^¼"),
        ({"band": 2000.0}, "element must be at most .* to the wave of .* at 2000 Hz"),
        ({"ends": "simple"}, "ends must be one or two of pinned, clamped, guided, free, absorbing, got 'simple'"),
        ({"ends": "free", "travels": True}, "ends of a road that travels along must be among absorbing, clamped"),
        ({"half": 0.3}, "last must lie four elements of 0.25 m or more behind first"),
        ({"absorbing": 21.0}, "absorbing must be at most half of the stretch, 20 m, got 21.0 m"),
    ],
)
def test_plates_that_make_no_sense(more, message):
    with pytest.raises(ValueError, match=message):
        plate(**more)


@pytest.mark.parametrize("method", [mf.cdfm, mf.sim])
def test_wheels_beside_the_road(method):
    """Half of the width is where it ends; on its edge a wheel still stands."""
    road = plate(width=0.9, element=0.5, across=1, half=26.0)
    message = r"road must be wide enough: it is 0\.9 m wide, and a contact or a point stands 0\.5 m from its centre"
    with pytest.raises(ValueError, match=message):
        over_humps(road, method)
    with pytest.raises(ValueError, match=message):
        mf.struck_plate(TRACK, width=0.9, speed=10.0, vehicle=CAR, across=1)
    over_humps(plate(width=1.0, element=0.5, across=1, half=26.0), method, duration=0.02, run_in=0.0)


def test_impulses_and_points_beside_the_road():
    road = plate(element=0.5, across=2)
    with pytest.raises(ValueError, match=r"road must be wide enough: it is 2 m wide, .* stands 1\.2 m from"):
        strike([(0.0, 0.0, 1.2)], 10.0, road)
    with pytest.raises(ValueError, match=r"road must be wide enough: .* stands 1\.1 m from"):
        strike([(0.0, -1.1, 0.5)], 10.0, road)
    with pytest.raises(ValueError, match=r"across must have shape \(2\), got \(3,\)"):
        mf.moving_impulse_response(road, speed=1.0, offsets=[0.0, 1.0], strike=0.0, across=[0.0, 0.0, 0.0])
    with pytest.raises(ValueError, match=r"strike_across must be finite"):
        mf.moving_impulse_response(road, speed=1.0, offsets=[0.0], strike=0.0, strike_across=[np.nan])
    beam_like = mf.finite_track(TRACK, first=-20.0, last=20.0)
    for places in ([(0.0, 0.5, 0.5)], [(0.0, 0.5, 0.0)]):
        with pytest.raises(
            ValueError, match="across and strike_across must be 0 m on a road whose section moves as"
        ):
            strike(places, 10.0, beam_like)


def test_a_pair_of_wheels_that_was_not_recorded(struck):
    """Opposite wheels farther apart than those between which the plate was struck."""
    wide = mf.full_car(**(FULL_TRUCK | {"sides": (0.5, -0.7)}))
    for call in (mf.simulate, mf.duhamel):
        with pytest.raises(ValueError, match="ahead, across, source_across must be one of the recorded offsets"):
            call(struck, wide, two_paths(), speed=10.0, duration=1.0)


@pytest.mark.parametrize("method", [mf.cdfm, mf.simulate, mf.duhamel])
def test_a_profile_with_one_path_for_two(method, struck):
    """One column is one path, of two that wheels follow; without columns a profile is the same for all."""
    road = struck if method is not mf.cdfm else plate(element=0.5, across=2, half=26.0)
    stations, flat = np.linspace(-20.0, 40.0, 6), np.zeros(6)
    options = {"speed": 10.0, "duration": 0.1}
    with pytest.raises(ValueError, match=r"a contact follows path 1, but the profile has 1 path,"):
        method(road, CAR, mf.Profile(stations, flat[:, None]), **options)
    method(road, CAR, mf.Profile(stations, flat), **options)


def test_a_travelling_road_says_by_how_many_unknowns():
    options = {"mass": np.eye(3), "damping": np.zeros((3, 3)), "stiffness": np.eye(3), "interval": (0.0, 1.0)}
    with pytest.raises(ValueError, match="column must be positive on a road that travels, got 0"):
        mf.FiniteGuideway(**options, interpolation=lambda x, d: np.ones((x.size, 3)), travels=True)

"""What finite roads, schemes and journeys refuse, and that the message names the condition."""

from __future__ import annotations

import re

import numpy as np
import pytest
import scipy.sparse as sparse
from scipy.linalg import eigh

import movingfrf as mf
from tests.helpers import DAMPED, FULL_TRUCK, PAVEMENT, QUARTER_TRUCK, SOIL, TIMOSHENKO, VEHICLES

TRACK = DAMPED["euler_bernoulli_winkler"]
FLAT = mf.Profile(np.linspace(-100.0, 500.0, 6), np.zeros(6))
TRUCK, QUARTER = VEHICLES["half_truck"], VEHICLES["quarter_truck"]
STRETCH = {"first": -20.0, "last": 40.0}


@pytest.mark.parametrize(
    ("more", "message"),
    [
        # (4 EI/k)^¼ = 1.675 m.
        (
            {"element": 1.7, "band": 0.0},
            r"element must be at most 1\.675 m, the length \(4 EI/k\)\^¼ .* got 1\.7 m",
        ),
        # At 200 Hz EIκ⁴ = mω² − k: 2π/κ = 2.165 m.
        (
            {"element": 0.6, "band": 200.0},
            r"element must be at most 0\.5412 m, 4 to the wave of 2\.165 m .* 200 Hz",
        ),
        ({"element": 0.0}, r"element must be positive, got 0\.0 m"),
        ({"ends": "simply"}, "ends must be one or two of pinned, clamped, guided, free, absorbing, got 'simply'"),
        ({"ends": ("pinned", "open")}, "ends must be one or two of"),
        ({"ends": ("pinned",)}, "ends must be one or two of"),
        ({"last": -19.5}, r"last must lie four elements of 0\.25 m or more behind first, got -19\.5 m"),
        ({"first": np.inf}, "first must be a finite number"),
        ({"absorbing": -1.0}, r"absorbing must not be negative, got -1\.0 m"),
        ({"band": -1.0}, r"band must not be negative, got -1\.0 Hz"),
    ],
)
def test_stretches_that_cannot_be_cut(more, message):
    with pytest.raises(ValueError, match=message):
        mf.finite_track(TRACK, **(STRETCH | more))


def test_only_slender_beams_are_cut():
    for track in (mf.track(TIMOSHENKO, SOIL), PAVEMENT, mf.RigidGuideway()):
        with pytest.raises(ValueError, match="track must have an Euler–Bernoulli beam to be cut into elements"):
            mf.finite_track(track, **STRETCH)


def rows(positions, derivative):
    return np.tile([1.0 - derivative, 0.0, 0.0], (positions.size, 1))


GOOD = {
    "mass": 1e3 * np.eye(3),
    "damping": np.zeros((3, 3)),
    "stiffness": 1e6 * np.eye(3),
    "interpolation": rows,
    "interval": (-20.0, 40.0),
}
SKEW = np.array([[2.0, 1.0, 0.0], [0.5, 2.0, 0.0], [0.0, 0.0, 2.0]])


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"mass": SKEW}, r"mass must be a symmetric matrix \[kg\]"),
        ({"damping": SKEW}, r"damping must be a symmetric matrix \[N s/m\]"),
        ({"stiffness": sparse.csr_array(SKEW)}, r"stiffness must be a symmetric matrix \[N/m\]"),
        ({"stiffness": np.ones((3, 2))}, r"stiffness must be a square matrix \[N/m\], got shape \(3, 2\)"),
        ({"stiffness": "stiff"}, "stiffness must be a square matrix"),
        ({"damping": np.full((3, 3), np.nan)}, r"damping must be finite throughout \[N s/m\]"),
        ({"mass": np.diag([1.0, np.inf, 1.0])}, r"mass must be finite throughout \[kg\]"),
        ({"stiffness": np.eye(4)}, r"damping and stiffness must have one shape, got \[\(3, 3\), \(4, 4\)\]"),
        ({"mass": np.diag([1.0, 0.0, 1.0])}, r"mass must be positive definite, got .*0\.0.* kg .* at index 1"),
        ({"mass": np.diag([1.0, 1.0, -1.0])}, r"mass must be positive definite, .* at index 2"),
        ({"interval": (3.0, 3.0)}, r"interval must begin before it ends, got 3\.0 m to 3\.0 m"),
        ({"interval": 3.0}, r"interval must be two numbers \[m\]"),
        ({"spacing": -1.0}, r"spacing must not be negative, got -1\.0 m"),
        ({"interpolation": lambda x, d: np.ones((x.size, 2))}, r"finite rows of 3 values, .* got \(1, 2\)"),
        ({"interpolation": lambda x, d: np.ones((2, 3))}, r"finite rows of 3 values, .* got \(2, 3\)"),
        ({"interpolation": lambda x, d: np.full((x.size, 3), np.nan)}, "interpolation must give finite rows"),
        ({"interpolation": lambda x, d: np.zeros((x.size, 3))}, "interpolation must give finite rows"),
        ({"interpolation": lambda x: np.ones((x.size, 3))}, "interpolation must give rows for positions .*, but:"),
    ],
)
def test_matrices_that_cannot_be_a_road(more, message):
    with pytest.raises(ValueError, match=message):
        mf.FiniteGuideway(**(GOOD | more))


def test_every_fault_is_named_at_once():
    with pytest.raises(mf.ParameterError, match=r"mass must be a symmetric .*; stiffness must be finite"):
        mf.FiniteGuideway(**(GOOD | {"mass": SKEW, "stiffness": np.full((3, 3), np.nan)}))


def test_asymmetry_within_rounding_is_none():
    almost = 1e6 * (np.eye(3) + 1e-13 * np.tri(3))
    assert mf.FiniteGuideway(**(GOOD | {"stiffness": almost})).dofs == 3


def drive(road, vehicle=QUARTER, method=mf.cdfm, **more):
    return method(road, vehicle, FLAT, **({"speed": 10.0, "duration": 1.0} | more))


def test_indefinite_matrices_are_refused():
    """Positive on its diagonal and symmetric, but not definite: only a factorisation tells."""
    indefinite = 1e3 * (np.full((3, 3), 2.0) - np.eye(3))
    with pytest.raises(ValueError, match="mass must be positive definite"):
        mf.FiniteGuideway(**(GOOD | {"mass": indefinite}))
    for name, matrix in (("damping", -np.eye(3)), ("stiffness", indefinite), ("damping", indefinite)):
        with pytest.raises(ValueError, match=f"{name} must be positive semidefinite"):
            mf.FiniteGuideway(**(GOOD | {name: matrix}))
    # More unknowns than a band solver takes, in no order: the sparse solver says the same.
    many = 200
    mirrored = np.arange(many)[:, None] + np.arange(many) == many - 1
    road = {
        "damping": sparse.csc_array((many, many)),
        "stiffness": sparse.eye_array(many),
        "interpolation": lambda x, derivative: np.full((x.size, many), (1.0 - derivative) / many),
        "interval": (-20.0, 40.0),
    }
    with pytest.raises(ValueError, match="mass must be positive definite"):
        mf.FiniteGuideway(mass=sparse.eye_array(many) - 3.0 * mirrored, **road)
    assert mf.FiniteGuideway(mass=sparse.eye_array(many) - 0.3 * mirrored, **road).dofs == many


def test_an_interpolation_that_ignores_the_derivative():
    """A dashpot would feel N instead of its slope."""
    road = mf.finite_track(TRACK, **STRETCH)
    blind = mf.FiniteGuideway(
        mass=road.mass,
        damping=road.damping,
        stiffness=road.stiffness,
        interpolation=lambda x, derivative: road.interpolation(x, 0),
        interval=road.interval,
    )
    with pytest.raises(ValueError, match="interpolation must give with derivative 1 the slopes of its rows"):
        drive(blind)


def test_other_kinds_of_road():
    """The likeliest mistake: a track where a piece of it is wanted."""
    with pytest.raises(ValueError, match=r"road must be a FiniteGuideway, which finite_track cuts .* got a Track"):
        drive(TRACK)
    with pytest.raises(ValueError, match=r"road must be a SampledGuideway, which struck_track .* got a Track"):
        drive(TRACK, method=mf.duhamel)
    with pytest.raises(ValueError, match="road must be a FiniteGuideway"):
        mf.newmark_loads(TRACK, np.ones((10, 1)), [0.0], speed=1.0)
    finite = mf.finite_track(TRACK, **STRETCH)
    with pytest.raises(ValueError, match=r"guideway must have a moving FRF, .* got a FiniteGuideway"):
        drive(finite, method=mf.simulate)
    with pytest.raises(ValueError, match=r"guideway must have a moving FRF"):
        mf.moving_loads(finite, np.ones((10, 1)), [0.0], speed=1.0)
    layered = mf.finite_track(DAMPED["rail_pad_sleeper_ballast"], first=-20.0, last=40.0)
    with pytest.raises(ValueError, match="compiled must be None or False"):
        drive(layered, compiled=True)


def test_a_road_that_nothing_holds_up():
    road = mf.FiniteGuideway(**(GOOD | {"stiffness": np.zeros((3, 3))}))
    with pytest.raises(mf.SolveError, match="stiffness matrix is singular: nothing holds the road up"):
        drive(road)


@pytest.mark.parametrize("method", [mf.cdfm, mf.sim])
def test_a_vehicle_that_leaves_the_road(method):
    """Both intervals are named; the run-in begins 10 m behind the start."""
    road = mf.finite_track(TRACK, **STRETCH)
    message = (
        r"road must reach from -12\.0539 m to 42\.2161 m, where the contacts travel \(run-in included\), "
        r"but it reaches from -20 m to 40 m"
    )
    with pytest.raises(ValueError, match=message):
        drive(road, TRUCK, method, duration=4.0)
    with pytest.raises(ValueError, match=r"road must reach from -22\.0539 m to"):
        drive(road, TRUCK, method, run_in=2.0)
    with pytest.raises(ValueError, match=r"where the contacts travel, but"):
        drive(road, TRUCK, method, run_in=0.0, duration=5.0)
    with pytest.raises(ValueError, match=r"road must reach from -22\.0539 m to"):
        drive(road, TRUCK, method, start=-10.0)
    # A road that travels along needs to be no longer than the vehicle.
    drive(mf.finite_track(TRACK, first=-8.0, last=8.0, travels=True, absorbing=5.0), TRUCK, method, duration=4.0)


def test_loads_that_leave_the_road():
    road = mf.finite_track(TRACK, **STRETCH)
    for more in ({"start": 35.0}, {"observe": [45.0]}, {"observe": [-21.0]}, {"speed": -30.0}):
        with pytest.raises(ValueError, match=r"road must reach from .* but it reaches from -20 m to 40 m"):
            mf.newmark_loads(road, np.ones((1000, 1)), [0.0], **({"speed": 10.0} | more))


@pytest.mark.parametrize("method", [mf.cdfm, mf.sim])
def test_places_that_cannot_be_observed(method):
    still, travelling = (mf.finite_track(TRACK, travels=flag, **STRETCH) for flag in (False, True))
    for road, more in ((travelling, {}), (still, {"superposed": True})):
        with pytest.raises(ValueError, match="observe must be empty on a road that travels along and where"):
            drive(road, method=method, observe=[0.0], **more)
    with pytest.raises(ValueError, match=r"observe must lie on the road, -20 m to 40 m, got \[41\.0\] m"):
        drive(still, method=method, observe=[41.0])
    with pytest.raises(ValueError, match=r"observe must have shape \(any\)"):
        drive(still, method=method, observe=[[1.0]])


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"force": np.ones((10, 2))}, r"force must have shape \(any, 1\), got \(10, 2\)"),
        ({"force": np.ones((1, 1))}, "force must have at least two samples, one load and one observation point"),
        ({"positions": [], "force": np.ones((5, 0))}, "force must have at least two samples"),
        ({"observe": []}, "force must have at least two samples"),
        ({"speed": np.nan}, "speed must be a finite number"),
        ({"time_step": -1e-3}, "time_step must be positive"),
        ({"start": np.inf}, "start must be a finite number"),
        ({"scheme": 3}, "scheme must be a Scheme or one of average_acceleration, .*, got 3"),
    ],
)
def test_loads_that_make_no_sense(more, message):
    road = mf.finite_track(TRACK, **STRETCH)
    with pytest.raises(ValueError, match=message):
        mf.newmark_loads(road, **({"force": np.ones((10, 1)), "positions": [0.0], "speed": 10.0} | more))


def test_a_road_that_travels_along_starts_at_zero():
    road = mf.finite_track(TRACK, travels=True, **STRETCH)
    for more in ({"start": 1.0}, {"speed": -1.0}):
        with pytest.raises(ValueError, match="start must be 0 m, and the speed positive, on a road that travels"):
            mf.newmark_loads(road, np.ones((10, 1)), [0.0], **({"speed": 10.0} | more))


def pair(distance, paths=(0, 0)):
    """Two masses side by side."""
    return mf.Vehicle(
        mass=np.diag([1e3, 1e3]),
        damping=np.zeros((2, 2)),
        stiffness=np.zeros((2, 2)),
        contact_map=np.eye(2),
        contacts=[
            mf.Contact(position=x, stiffness=1e6, path=p) for x, p in zip((0.0, distance), paths, strict=True)
        ],
        vertical=[1, 1],
        dof_names=["one", "two"],
    )


def test_contacts_closer_than_nodes():
    road = mf.finite_track(TRACK, element=0.5, **STRETCH)
    with pytest.raises(
        ValueError, match=r"nodes at most 0\.3 m apart, the distance between two contacts, got 0\.5 m"
    ):
        drive(road, pair(0.3))
    drive(road, pair(0.5))
    # Side by side on two paths is another matter: they load the same place.
    flat = mf.Profile(FLAT.stations, np.zeros((6, 2)))
    mf.cdfm(road, pair(0.0, (0, 1)), flat, speed=10.0, duration=1.0)


@pytest.mark.parametrize("method", [mf.cdfm, mf.sim])
@pytest.mark.parametrize(
    ("scheme", "message"),
    [
        (mf.Scheme(0.25, 0.45), r"scheme is unstable at every step, since γ ≥ ½ does not hold: \(0\.25, 0\.45"),
        (mf.Scheme(0.25, 0.5, 0.3, 0.1), r"scheme is unstable at every step, since α_m ≤ α_f ≤ ½, γ ≥"),
        (mf.Scheme(0.2, 0.6, 0.0, 0.1), r"scheme is unstable at every step, since α_m ≤ α_f ≤ ½, γ ≥"),
        ("Newmark", "scheme must be a Scheme or one of average_acceleration, linear_acceleration, fox_goodwin, "),
        (None, "scheme must be a Scheme or one of"),
    ],
)
def test_schemes_that_are_unstable_or_unknown(method, scheme, message):
    with pytest.raises(ValueError, match=message):
        drive(mf.finite_track(TRACK, **STRETCH), method=method, scheme=scheme)


def test_a_scheme_with_too_little_of_the_old_forces():
    """With α_f = 0.3 forces come late: γ ≥ ½ − α_m + α_f is needed or every vibration grows."""
    with pytest.raises(ValueError, match="scheme is unstable at every step"):
        drive(mf.finite_track(TRACK, **STRETCH), scheme=mf.Scheme(0.45, 0.5, 0.0, 0.3))


@pytest.mark.parametrize(("scheme", "phase"), [("central_difference", 2.0), ("linear_acceleration", 12**0.5)])
def test_steps_too_long_for_a_scheme(scheme, phase):
    """Stable while ω Δt ≤ 2, or √12, for the highest vibration of the mesh: the message names the longest step."""
    road = mf.FiniteGuideway(**(GOOD | {"stiffness": np.diag([1e6, 4e6, 9e6])}))
    longest = phase / np.sqrt(9e3)
    with pytest.raises(ValueError, match=rf"time_step must be at most {longest:.3g} s: .* ω Δt ≤ {phase:.4g}"):
        mf.newmark_loads(road, np.ones((50, 1)), [0.0], speed=1.0, time_step=1.01 * longest, scheme=scheme)
    steady = mf.newmark_loads(road, np.ones((50, 1)), [0.0], speed=1.0, time_step=0.99 * longest, scheme=scheme)
    assert np.abs(steady.deflection).max() < 1e-5
    # On a mesh the elements set the limit, far below any step that is otherwise needed.
    with pytest.raises(ValueError, match=r"time_step must be at most .* road and vehicle vibrate at up to"):
        drive(mf.finite_track(TRACK, **STRETCH), scheme=scheme)


def test_a_road_of_one_unknown_and_a_scheme_of_limited_step():
    road = mf.FiniteGuideway(
        mass=[[1e3]],
        damping=[[0.0]],
        stiffness=[[9e6]],
        interpolation=lambda x, derivative: np.full((x.size, 1), 1.0 - derivative),
        interval=(-20.0, 40.0),
    )
    options = {"speed": 1.0, "scheme": "central_difference"}
    with pytest.raises(ValueError, match=r"time_step must be at most 0\.0211 s"):
        mf.newmark_loads(road, np.ones((50, 1)), [0.0], time_step=0.022, **options)
    assert np.isfinite(mf.newmark_loads(road, np.ones((50, 1)), [0.0], time_step=0.02, **options).deflection).all()


def test_a_vehicle_too_stiff_for_a_scheme_of_limited_step():
    """Its wheel vibrates faster than the road: at √(k/m) = 300 rad/s and 8 ms ωΔt is 2.4, which grows."""
    road = mf.FiniteGuideway(**(GOOD | {"mass": 1e6 * np.eye(3)}))
    stiff = mf.quarter_car(
        **(QUARTER_TRUCK | {"tyre_stiffness": 1e8, "suspension_damping": 0.0, "tyre_damping": 0.0})
    )
    with pytest.raises(ValueError, match="time_step must be at most"):
        drive(road, stiff, scheme="central_difference", time_step=8e-3, duration=0.4)


def test_wheels_that_load_the_same_unknown_add_up():
    """Four tyres on a road of one unknown: a step is refused where central differences grow, ω Δt = 2."""
    road = mf.FiniteGuideway(
        mass=[[1e3]],
        damping=[[0.0]],
        stiffness=[[1e4]],
        interpolation=lambda x, derivative: np.full((x.size, 1), 1.0 - derivative),
        interval=(-20.0, 40.0),
    )
    stiff = {"wheel_masses": (1e3, 1e3), "tyre_stiffness": (3e7, 3e7), "tyre_damping": (0.0, 0.0)}
    car = mf.full_car(**(FULL_TRUCK | stiff))
    mass, _, stiffness, contacts = car.matrices
    tyres = np.hstack([contacts, -np.ones((4, 1))])
    both = np.pad(stiffness, (0, 1)) + tyres.T * 3e7 @ tyres
    both[-1, -1] += 1e4
    highest = eigh(both, np.diag([*np.diag(mass), 1e3]), eigvals_only=True)[-1] ** 0.5
    with pytest.raises(ValueError, match="time_step must be at most") as refused:
        drive(road, car, scheme="central_difference", time_step=1.01 * 2 / highest, duration=0.4)
    limit = float(re.search(r"at most ([\d.]+) s", str(refused.value)).group(1))
    assert 0.8 * 2 / highest < limit < 1.001 * 2 / highest


def test_forces_that_do_not_come_to_agree():
    """The exchange diverges where a tyre is stiffer than the inertia that a step gives the road; both are named."""
    stiff = mf.quarter_car(**(QUARTER_TRUCK | {"tyre_stiffness": 3.5e8}))
    road = mf.finite_track(TRACK, **STRETCH)
    bump = mf.bump(height=0.01, width=3.0, at=0.0, length=60.0, start=-20.0)
    for compiled in (True, False):
        with pytest.raises(mf.SolveError, match=r"does not agree within 50 iterations at 0\.01 s and 10 m/s"):
            mf.sim(road, stiff, bump, speed=10.0, duration=1.0, time_step=0.01, blend=0.0, compiled=compiled)
    # Solved for, the same step is no difficulty.
    mf.cdfm(road, stiff, bump, speed=10.0, duration=1.0, time_step=0.01, blend=0.0)
    with pytest.raises(mf.SolveError, match=r"within 2 iterations at .* \(relative tolerance 1e-12\)"):
        mf.sim(road, QUARTER, bump, speed=10.0, duration=1.0, blend=0.0, iterations=2, tolerance=1e-12)


@pytest.mark.parametrize(
    ("method", "more", "message"),
    [
        (mf.cdfm, {"run_in": -1.0}, r"run_in must not be negative, got -1\.0 s"),
        (mf.cdfm, {"speed": 0.0}, r"speed must be positive, got 0\.0 m/s"),
        (mf.cdfm, {"duration": 1e-3}, "duration must be at least two time steps"),
        (mf.cdfm, {"blend": -1.0}, "blend must not be negative"),
        (mf.sim, {"tolerance": 0.0}, "tolerance must be positive"),
        (mf.sim, {"iterations": 0}, "iterations must be a whole number of at least 1, got 0"),
        (mf.sim, {"run_in": np.nan}, "run_in must be a number of at least zero"),
    ],
)
def test_journeys_that_make_no_sense(method, more, message):
    with pytest.raises(ValueError, match=message):
        drive(mf.finite_track(TRACK, **STRETCH), method=method, **more)


def test_a_profile_that_is_too_short():
    short = mf.Profile(np.linspace(-5.0, 9.0, 6), np.zeros(6))
    with pytest.raises(ValueError, match=r"profile must cover the journey from -2\.05387 m to 12\.2161 m"):
        mf.cdfm(mf.finite_track(TRACK, **STRETCH), TRUCK, short, speed=10.0, duration=1.0)


def test_more_than_memory_holds():
    road = mf.finite_track(TRACK, first=-8.0, last=8.0, travels=True)
    far = mf.Profile(np.linspace(-10.0, 1.1e8, 6), np.zeros(6))
    with pytest.raises(ValueError, match=r"steps of 1e-06 s needs about .* GiB of memory"):
        mf.cdfm(road, TRUCK, far, speed=1.0, duration=1e8, time_step=1e-6)

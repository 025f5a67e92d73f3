"""Time-stepping schemes: order of accuracy, numerical damping, limits of stability."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import movingfrf as mf
from movingfrf.stepping.schemes import SCHEMES
from tests.helpers import DAMPED, VEHICLES, apart, observed_order

ORDER = 0.1
STEADY = [name for name, scheme in SCHEMES.items() if np.isinf(scheme.largest_phase)]

# A chain of four masses, coupled by inertia as well; a force acts on all of them in these shares.
SHARES = np.array([0.2, 0.5, -0.1, 1.0])
STRETCH = np.array([[1.0, 0, 0, 0], [-1, 1, 0, 0], [0, -1, 1, 0], [0, 0, -1, 1]])
INERTIA = np.diag([2.0, 1.0, 3.0, 1.5]) + np.diag([0.3, 0, 0], 1) + np.diag([0.3, 0, 0], -1)
SPRINGS, DASHPOTS = (STRETCH.T @ np.diag(row) @ STRETCH for row in ([225.0, 125, 175, 100], [3.0, 5, 2, 4]))
DURATION = 2.0


def chain(damped=True):
    return mf.FiniteGuideway(
        mass=INERTIA,
        damping=damped * DASHPOTS,
        stiffness=SPRINGS,
        interpolation=lambda x, derivative: np.tile(SHARES, (x.size, 1)) * (1 - derivative),
        interval=(0.0, 10.0),
    )


def pulse(time):
    """Force that begins smoothly [N]."""
    return 50 * np.sin(np.pi * time / DURATION) ** 4 * np.cos(3 * time)


def deflection_of(road, force, step, scheme, compiled=None):
    result = mf.newmark_loads(
        road, force[:, None], [1.0], speed=0.0, time_step=step, scheme=scheme, compiled=compiled
    )
    return result.deflection.values[:, 0]


def integrated(force, damped=True):
    """Deflection of the chain over time, by an adaptive Runge–Kutta method of order 8 to twelve digits."""
    inverse = np.linalg.inv(INERTIA)

    def rates(time, state):
        push = SHARES * force(time) - damped * DASHPOTS @ state[4:] - SPRINGS @ state[:4]
        return np.concatenate([state[4:], inverse @ push])

    solution = solve_ivp(
        rates, (0, DURATION), np.zeros(8), method="DOP853", rtol=1e-12, atol=1e-15, dense_output=True
    )
    return lambda time: SHARES @ solution.sol(time)[:4]


STEPS = DURATION / np.array([100, 200, 400])


@pytest.mark.parametrize("damped", [False, True], ids=["undamped", "damped"])
def test_order_on_a_small_system(damped):
    """Every scheme is of order 2; Fox and Goodwin's of order 4 where no force depends on the velocity."""
    exact = integrated(pulse, damped)
    for name in SCHEMES:
        errors = []
        for step in STEPS:
            time = step * np.arange(round(DURATION / step) + 1)
            wanted = exact(time)
            found = deflection_of(chain(damped), pulse(time), step, name)
            errors.append(np.sqrt(((found - wanted) ** 2).sum() / (wanted**2).sum()))
        order = 4.0 if name == "fox_goodwin" and not damped else 2.0
        assert observed_order(STEPS, errors) == pytest.approx(order, abs=ORDER), name
        assert errors[-1] < 1e-4, name


@pytest.mark.parametrize("name", SCHEMES)
def test_order_with_a_force_that_is_there_from_the_start(name):
    """The road then starts with the acceleration that the force gives it; without it the order is 1."""
    exact = integrated(lambda time: 50.0)
    errors = []
    for step in STEPS:
        time = step * np.arange(round(DURATION / step) + 1)
        found = deflection_of(chain(), np.full(time.size, 50.0), step, name)
        errors.append(np.abs(found - exact(time)).max())
    assert observed_order(STEPS, errors) == pytest.approx(2.0, abs=ORDER)


@pytest.mark.parametrize("compiled", [True, False], ids=["compiled", "plain"])
@pytest.mark.parametrize("name", STEADY)
def test_order_on_a_road(name, compiled):
    """A smooth force travels along a pinned road; against steps sixteen times as short as the shortest."""
    road = mf.finite_track(
        DAMPED["euler_bernoulli_winkler"], first=-10.0, last=10.0, element=1.0, ends="pinned", band=0.0
    )

    def run(count, compiled=compiled):
        time = 0.4 / count * np.arange(count + 1)
        force = 1e5 * np.sin(np.pi * time / 0.4) ** 2 * np.cos(40 * time)
        return mf.newmark_loads(
            road,
            force[:, None],
            [-2.0],
            speed=10.0,
            time_step=0.4 / count,
            observe=[-2.0, 1.3],
            scheme=name,
            compiled=compiled,
        ).deflection.values

    counts = np.array([50, 100, 200]) if not compiled else np.array([100, 200, 400, 800])
    fine = run(12_800, compiled=True)
    errors = []
    for count in counts:
        wanted = fine[:: 12_800 // count]
        errors.append(np.sqrt(((run(count) - wanted) ** 2).sum() / (wanted**2).sum()))
    assert observed_order(1 / counts, errors) == pytest.approx(2.0, abs=ORDER)


def coupled(scheme, step, *, superposed=False):
    """Drive the half truck over a wide hump."""
    road = mf.finite_track(DAMPED["euler_bernoulli_winkler"], first=-15.0, last=30.0, element=0.5, absorbing=8.0)
    return mf.cdfm(
        road,
        VEHICLES["half_truck"],
        mf.bump(height=0.01, width=4.0, at=3.0, length=45.0, start=-15.0),
        speed=10.0,
        duration=1.6,
        time_step=step,
        blend=0.0,
        run_in=0.4,
        superposed=superposed,
        scheme=scheme,
    )


def coupled_orders(scheme, **more):
    steps = np.array([4e-3, 2e-3, 1e-3, 5e-4])
    fine = coupled(scheme, 6.25e-5, **more)
    errors = [
        apart(coupled(scheme, step, **more), fine.isel(time=slice(None, None, round(step / 6.25e-5))))
        for step in steps
    ]
    return {name: observed_order(steps, [error[name] for error in errors]) for name in errors[0]}


@pytest.mark.parametrize("superposed", [True, False], ids=["superposed", "stepped weight"])
@pytest.mark.parametrize("name", STEADY)
def test_order_of_vehicle_and_road_together(name, superposed):
    orders = coupled_orders(name, superposed=superposed)
    for output in ("contact_force", "motion", "deflection"):
        assert orders[output] == pytest.approx(2.0, abs=ORDER), output


@pytest.mark.parametrize("name", STEADY)
def test_order_of_the_acceleration(name):
    """What a result calls acceleration is that of its instant, to second order like all else.

    The quantity that a scheme with α carries along as its acceleration belongs to an instant (α_f − α_m) Δt later
    (S. Erlicher, L. Bonaventura, O. S. Bursi, Comput. Mech. 28, 2002): taken as it is, its order is 1.
    """
    assert coupled_orders(name)["acceleration"] == pytest.approx(2.0, abs=ORDER)


def slab():
    """Two slabs side by side that share the load: 50 rad/s."""
    return mf.FiniteGuideway(
        mass=np.diag([1000.0, 1000.0]),
        damping=np.zeros((2, 2)),
        stiffness=np.diag([2.5e6, 2.5e6]),
        interpolation=lambda x, derivative: np.full((x.size, 2), 0.5 * (1 - derivative)),
        interval=(0.0, 10.0),
    )


@pytest.mark.parametrize(("scheme", "shrinks"), [("hilber_hughes_taylor", 0.9 / 1.1), ("generalised_alpha", 0.8)])
def test_the_highest_vibrations_shrink(scheme, shrinks):
    """By the spectral radius at ωΔt → ∞: (1 − α)/(1 + α) for HHT with α = 0.1, by construction for the other.

    Chung and Hulbert 1993; here ωΔt = 5000. A double root grows linearly besides: the ratio is approached as 1/n.
    """
    force = np.zeros(401)
    force[0] = 1e6
    deflection = np.abs(deflection_of(slab(), force, 100.0, scheme))
    ratio = deflection[400] / deflection[399]
    assert ratio == pytest.approx(shrinks, rel=0.01)


@pytest.mark.parametrize("name", [name for name, row in SCHEMES.items() if not row.alpha_f])
def test_vibrations_are_slowed_as_theory_says(name):
    """Free vibration by a scheme with γ = ½: cos(ω̃Δt) = 1 − ½ (ωΔt)²/(1 + β (ωΔt)²), from its recurrence."""
    phase = 0.1
    force = np.zeros(600)
    force[0] = 1e6
    deflection = deflection_of(slab(), force, phase / 50.0, name)
    crossings = np.flatnonzero(deflection[:-1] * deflection[1:] < 0)
    zeros = crossings + deflection[crossings] / (deflection[crossings] - deflection[crossings + 1])
    # The force ends within the first step. A chord crosses zero within (0.1)³/24 of a step of where the sine does.
    found = np.pi * (zeros.size - 2) / (zeros[-1] - zeros[1])
    slowed = np.arccos(1 - 0.5 * phase**2 / (1 + SCHEMES[name].beta * phase**2))
    assert found / phase == pytest.approx(slowed / phase, abs=2e-6)


def test_a_scheme_is_its_row():
    force = np.full(200, 1e5)
    by_name = deflection_of(chain(), force, 1e-3, "generalised_alpha")
    by_row = deflection_of(chain(), force, 1e-3, SCHEMES["generalised_alpha"])
    assert (by_name == by_row).all()
    assert (deflection_of(chain(), force, 1e-3, "average_acceleration") != by_name).any()


def amplification(scheme, phase):
    """Spectral radius of an undamped vibration of ωΔt = phase, from the equations in the docstring of `Scheme`."""
    beta, gamma, alpha_m, alpha_f = scheme
    square = phase**2
    new = [[1, 0, -beta], [0, 1, -gamma], [(1 - alpha_f) * square, 0, 1 - alpha_m]]
    old = [[1, 1, 0.5 - beta], [0, 1, 1 - gamma], [-alpha_f * square, 0, -alpha_m]]
    return np.abs(np.linalg.eigvals(np.linalg.solve(new, old))).max()


ROWS = [
    *SCHEMES.values(),
    mf.Scheme(0.3, 0.6),
    mf.Scheme(0.25, 0.6),
    mf.Scheme(0.2, 0.45),
    mf.Scheme(0.3025, 0.6, 0.0, 0.1),
    mf.Scheme(0.45, 0.5, 0.0, 0.3),
    mf.Scheme(0.25, 0.5, 0.3, 0.1),
    mf.Scheme(0.45, 0.8, 0.0, 0.3),
    mf.Scheme(0.64, 1.1, 0.0, 0.6),
    mf.Scheme(0.25, 0.6, -0.1, 0.0),
]


@pytest.mark.parametrize("row", ROWS, ids=str)
def test_what_counts_as_stable_is_stable(row):
    """No vibration below the stated phase may grow: spectral radius of the amplification matrix.

    A double root on the unit circle comes out of the eigenvalue solver with the square root of the rounding error.
    """
    limit = row.largest_phase
    phases = np.geomspace(1e-3, 1e4, 200)
    radii = np.array([amplification(row, phase) for phase in phases])
    assert (radii[phases < 0.999 * limit] < 1 + 1e-6).all()
    if 0 < limit < np.inf:
        assert amplification(row, 1.01 * limit) > 1.01

"""What is prepared once and used for several profiles, or forces: the same numbers, one factorisation."""

from __future__ import annotations

import numpy as np
import pytest

import movingfrf as mf
from movingfrf.stepping import marching
from movingfrf.stepping.coupled import prepared_journey
from movingfrf.stepping.exchange import Iteration
from movingfrf.stepping.moving_loads import prepared_passage
from movingfrf.vehicles.journey import Journey
from tests.helpers import VEHICLES, apart, difference
from tests.stepping.coupled_parts import TRACK, travelling

# The weight need not have settled.
pytestmark = pytest.mark.filterwarnings("ignore:the deflection under the vehicle")

JOURNEY = Journey(speed=10.0, duration=0.4, time_step=1e-3, blend=0.0)
HUMPS = [mf.bump(height=height, width=1.5, at=2.0, length=60.0, start=-30.0) for height in (0.01, -0.004, 0.02)]
STANDING = {"first": -30.0, "last": 30.0, "element": 0.5, "absorbing": 12.0}


def roads():
    return {"standing": mf.finite_track(TRACK, **STANDING), "travelling": travelling(0.5, 25.0, 12.0)}


NUMBA = pytest.mark.skipif(not marching.usable("stepping.compiled"), reason="needs numba")


@pytest.mark.parametrize("road", roads())
@pytest.mark.parametrize("superposed", [False, True])
@pytest.mark.parametrize(
    "compiled",
    [False, pytest.param(True, marks=NUMBA)],
)
@pytest.mark.parametrize("method", ["cdfm", "sim"])
def test_a_batch_has_the_numbers_of_its_cases(road, superposed, compiled, method):
    """The last case comes first as well: none begins where another has ended."""
    parts = roads()[road], VEHICLES["half_truck"]
    how = {"superposed": superposed, "run_in": 0.3, "compiled": compiled}
    iteration = {"iteration": Iteration(1e-10)} if method == "sim" else {}
    solve = prepared_journey(JOURNEY, parts, **how, **iteration)
    order = [HUMPS[2], *HUMPS]
    batch = [solve(hump) for hump in order]
    for hump, one in zip(order, batch, strict=True):
        alone = getattr(mf, method)(
            *parts, hump, speed=JOURNEY.speed, duration=JOURNEY.duration, blend=0.0, time_step=1e-3, **how
        )
        assert max(apart(one, alone).values()) < 1e-12
    assert min(apart(*batch[1:3]).values()) > 0.1


def test_a_batch_of_forces_has_the_numbers_of_its_cases():
    road, at, points = roads()["standing"], np.array([0.0, -3.0]), np.array([1.0])
    times = 1e-3 * np.arange(400)[:, None]
    histories = [1e4 * np.sin(rate * times + [0.5, 1.0]) for rate in (20.0, 50.0)]
    solve = prepared_passage(road, at, points, speed=10.0, time_step=1e-3, samples=400)
    for forces in [histories[1], *histories]:
        alone = mf.newmark_loads(road, forces, at, speed=10.0, observe=points)
        assert difference(solve(forces).deflection.values, alone.deflection.values) < 1e-12


def test_a_batch_is_factorised_once(monkeypatch):
    factorised = []
    solver = marching.solver
    monkeypatch.setattr(marching, "solver", lambda matrix: factorised.append(1) or solver(matrix))
    solve = prepared_journey(JOURNEY, (roads()["standing"], VEHICLES["half_truck"]), run_in=0.1, compiled=False)
    # The effective matrix and the mass of the journey, and the effective matrix of the run-in.
    assert len(factorised) == 3
    for hump in HUMPS:
        solve(hump)
    assert len(factorised) == 3

"""Compiled loops and NumPy give the same numbers; and who takes which."""

from __future__ import annotations

import subprocess
import sys
from copy import copy

import numpy as np
import pytest

import movingfrf as mf
from movingfrf._basics.compiling import PATIENCE, compiling, loops_for, numba_is_there, usable
from movingfrf._basics.prediction import predicted, predicting
from movingfrf._basics.spline import cubic
from movingfrf.response.influence import influence
from movingfrf.response.line import Line
from movingfrf.response.system import System, Tables
from tests.analytic.vehicle_parts import RIGID
from tests.helpers import DAMPED, UNDAMPED, VEHICLES

pytestmark = pytest.mark.skipif(not numba_is_there(), reason="needs numba")

ROADS = DAMPED | {f"undamped_{name}": road for name, road in UNDAMPED.items()}
GRID = {
    "even": 2 * np.pi * np.linspace(0.0, 150.0, 700) - 0.3j,
    "even over decades": np.geomspace(1e-3, 1e5, 300) * (1 - 1e-6j),
    "few": np.array([300.0 - 1.0j, 20.0 - 1.0j, 20.0 - 1.0j, 2000.0 - 5.0j]),
    "one": np.array([0.0 - 0.1j]),
}
AHEAD = np.array([-60.0, -4.0, -0.3, 0.0, 0.3, 4.0, 60.0])


def both(compute):
    """Compute something compiled, and in NumPy."""
    found = []
    for choice in (True, False):
        with compiling(choice):
            found.append(compute())
    return found


def off(one, other):
    """Largest difference, relative to the largest value."""
    return float(np.abs(one - other).max() / np.abs(other).max())


@pytest.mark.parametrize(
    "module",
    ["_basics.compiled", "guideways.compiled", "vehicles.compiled", "response.compiled", "stepping.compiled"],
)
def test_loops_can_be_compiled(module):
    """What cannot be compiled is done in NumPy, which nobody would notice."""
    assert usable(module)


@pytest.mark.parametrize("grid", GRID)
@pytest.mark.parametrize("share", [0.0, 1e-12, 1e-9, 1e-6, 1e-3, 0.1, 0.6, 0.97, 1.03, 1.6, 5.0])
@pytest.mark.parametrize("name", [name for name in ROADS if hasattr(ROADS[name], "waves")])
def test_moving_frfs(name, share, grid):
    """At rest, nearly so, below and above the critical speed; also undamped, somewhat below the real axis."""
    road = ROADS[name]
    speed = share * min(road.critical_speed, 300.0)
    for derivative in (0, 2):
        one, other = both(lambda n=derivative: road.moving_frf(AHEAD, speed, GRID[grid], derivative=n))
        for column in range(AHEAD.size):
            size = np.abs(other[:, column]).max()
            # Undamped waves that nearly meet, 60 m and hundreds of radians away, lose the most.
            assert off(one[:, column], other[:, column]) < 2e-9 or size < 1e-12 * np.abs(other).max()


@pytest.mark.parametrize("speed", [0.0, 20.0])
def test_real_waves_are_met_where_damping_would_push_them(speed):
    """Undamped, above the cut-off, at real frequencies: rounding alone tells on which side of the axis they lie."""
    road = mf.track(mf.EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9), mf.Spring(stiffness=8.0e6))
    omega = np.sqrt(8.0e6 / 711.9) * np.linspace(1.3, 3.0, 300)
    damped = mf.track(road.beam, mf.Spring(stiffness=8.0e6, damping=1.0))
    for one in both(lambda: road.moving_frf(AHEAD, speed, omega)):
        assert off(one, damped.moving_frf(AHEAD, speed, omega)) < 1e-3


@pytest.mark.parametrize("name", ROADS)
def test_waves_are_all_there(name):
    """As many on either side, and the same ones: in whatever order."""
    road = ROADS[name]
    if not hasattr(road, "waves"):
        pytest.skip("has no waves")
    for speed in min(road.critical_speed, 300.0) * np.array([1e-6, 0.5, 0.95, 1.1, 3.0]):
        one, other = both(lambda speed=speed: road.waves(speed, GRID["even"]))
        assert (one.forward.sum(axis=0) == other.forward.sum(axis=0)).all()
        for number in range(0, GRID["even"].size, 23):
            apart = np.abs(one.kappa[:, number, None] - other.kappa[None, :, number])
            assert (apart.min(axis=0) < 1e-9 * np.abs(other.kappa[:, number])).all()
            assert (np.sort(apart.argmin(axis=0)) == np.arange(len(apart))).all()


@pytest.mark.parametrize("name", [*VEHICLES, *RIGID])
def test_vehicles(name):
    dynamics = (VEHICLES | RIGID)[name].dynamics()
    omega = GRID["even"]
    contacts = dynamics.contacts
    below = np.random.default_rng(0).normal(size=(3, contacts, omega.size, 2)).view(complex)[..., 0]
    one, other = both(lambda: dynamics.stiffness(omega))
    assert off(one, other) < 1e-12
    for part, same in zip(*both(lambda: dynamics.response(omega, below)), strict=True):
        assert off(part, same) < 1e-12


def test_splines():
    """Even or uneven knots, in any order, at knots, before the first and past the last."""
    random = np.random.default_rng(1)
    for knots in (np.linspace(0.0, 9.0, 40), np.sort(random.uniform(0.0, 9.0, 40)), np.array([0.0, 1.0, 9.0])):
        spline = cubic(knots, random.normal(size=knots.size))
        places = [knots, np.linspace(-1.0, 10.0, 500), random.uniform(-1.0, 10.0, 500), np.array(3.3), np.zeros(0)]
        for at in places:
            for order in range(5):
                one, other = both(lambda one=spline, at=at, order=order: one(at, order))
                assert one.shape == other.shape
                np.testing.assert_allclose(one, other, rtol=0, atol=1e-9)


@pytest.mark.parametrize("ends", [{}, {"first": 0.3}, {"last": -1.0}, {"first": 0.1, "last": 0.2}])
def test_making_splines(ends):
    """Of few or many knots, even or not, some of them far closer than others."""
    random = np.random.default_rng(3)
    for size in (4, 5, 6, 50, 3000):
        for widths in (np.ones(size), random.uniform(0.5, 1.5, size), 10.0 ** random.uniform(-3, 1, size)):
            knots, values = np.cumsum(widths), random.normal(size=size)
            one, other = both(lambda x=knots, y=values: cubic(x, y, **ends).c)
            for mine, others in zip(one, other, strict=True):
                assert off(mine, others) < 1e-9


def test_how_records_go_on():
    random = np.random.default_rng(4)
    rough = np.cumsum(np.cumsum(random.normal(size=3000)))
    for record in (rough - rough.mean(), np.ones(100), np.zeros(100)):
        (one, missed), (other, others) = both(lambda record=record: predicting(record, 16))
        assert one.shape == other.shape
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-9)
        assert missed == pytest.approx(others, rel=1e-9)
        mine, theirs = both(lambda record=record, known=one: predicted(record, known, 60))
        np.testing.assert_allclose(mine, theirs, rtol=0, atol=1e-9 * np.abs(record).max())


def test_where_a_band_is_harmful():
    """Anywhere within it, nowhere, and throughout: of several cases and ports, one of which drives nothing."""
    random = np.random.default_rng(5)
    system = System(guideway=DAMPED["euler_bernoulli_winkler"], vehicle=VEHICLES["half_truck"], speed=15.0)
    line = Line(samples=1000, time_step=2e-3, points=4000)
    energy = random.exponential(size=(3, system.ports, line.size)) / (1.0 + np.arange(line.size)) ** 3
    energy[1, 0] = 0.0
    with compiling(False):
        found = influence(system, line, energy, 70.0, 1e-3)
    ends = set()
    for allowed in np.geomspace(1e-6, 2.0, 60):
        for share in (found.whole, found.added):
            one, other = both(lambda share=share, allowed=allowed: found.negligible_from(share, allowed, energy))
            assert one == other
            ends.add(one)
    assert len(ends) > 40


@pytest.mark.parametrize("contacts", [1, 2, 3, 5, 16])
def test_contacts_on_a_guideway(contacts):
    """Of any size to each other: the largest entry of a column may stand anywhere in it."""
    random = np.random.default_rng(contacts)
    frf, dynamic, rough = (
        random.normal(size=(*shape, 40, 2)).view(complex)[..., 0]
        for shape in ((contacts, contacts), (contacts, contacts), (2, 3, contacts))
    )
    dynamic *= 10.0 ** random.uniform(-4, 4, size=(contacts, 1, 1))
    tables = Tables(np.zeros(40, complex), frf, dynamic)
    one, other = both(lambda: tables.coupled(rough))
    for part, same in zip(one, other, strict=True):
        assert part.shape == rough.shape
        assert off(part, same) < 1e-9
    # Where I + D G is next to nothing on its diagonal, elimination must not begin there.
    frf[:], dynamic[:] = np.eye(contacts)[:, :, None], -np.eye(contacts)[:, :, None] * (1.0 - 1e-15)
    frf += 1e-3 * np.eye(contacts, k=1)[:, :, None] + 1e-3 * np.eye(contacts, k=1 - contacts)[:, :, None]
    if contacts > 1:
        one, other = both(lambda: tables.coupled(rough))
        assert off(one[0], other[0]) < 1e-9


@pytest.mark.parametrize("vehicle", ["half_truck", "quarter_truck", "full_truck", "bogie", "plank"])
def test_what_bands_hold(vehicle):
    """Gains, bounds of energies, and whole energies, of several cases, one of which has little of some."""
    road = DAMPED["euler_bernoulli_winkler"]

    def found():
        system = System(guideway=road, vehicle=(VEHICLES | RIGID)[vehicle], speed=15.0)
        line = Line(samples=1000, time_step=2e-3, points=4000)
        energy = np.random.default_rng(2).exponential(size=(3, system.ports, line.size)) ** 4
        energy[1, 0] = 0.0
        return influence(system, line, energy, 70.0, 1e-3)

    one, other = both(found)
    assert (one.starts == other.starts).all()
    np.testing.assert_allclose(one.size, other.size, rtol=1e-9)
    for mine, others in ((one.added, other.added), (one.whole, other.whole)):
        np.testing.assert_allclose(mine.gain, others.gain, rtol=1e-6, atol=1e-12 * others.gain.max())
        np.testing.assert_allclose(mine.beyond, others.beyond, rtol=1e-6, atol=1e-12)


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
@pytest.mark.parametrize("truncation", [None, 40.0, 0.0])
@pytest.mark.parametrize("vehicle", ["half_truck", "quarter_truck", "full_truck", "bogie"])
@pytest.mark.parametrize("road", ["euler_bernoulli_winkler", "rail_pad_sleeper_ballast"])
def test_a_whole_drive(road, vehicle, truncation):
    profile = mf.realise(mf.IsoRoad.of_class("A", band=(0.02, 4.0)), length=60.0, start=-6.0)
    driven, travel = (VEHICLES | RIGID)[vehicle], {"speed": 15.0, "duration": 2.0, "truncation": truncation}
    # Copies remember nothing of each other. The road is the same: what goes on past its end magnifies rounding.
    one, other = both(lambda: mf.simulate(DAMPED[road], copy(driven), profile, **travel))
    for name in ("contact_force", "deflection", "motion", "acceleration"):
        assert off(one[name].values, other[name].values) < 1e-9
    assert one.attrs["truncation"] == pytest.approx(other.attrs["truncation"], rel=1e-6)


def test_an_infinite_response_is_refused_by_both():
    road = mf.track(mf.EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9), mf.Spring(stiffness=8.0e6))
    cut_off = np.sqrt(8.0e6 / 711.9)
    for choice in (True, False):
        with compiling(choice), pytest.raises(mf.SolveError, match=r"infinite at 16\.87"):
            road.moving_frf([0.0], 0.0, [1.0, cut_off])


LOADED = """
import sys
sys.argv = ["movingfrf"]
from movingfrf._basics.compiling import loops_for
assert loops_for("guideways.compiled", {work}) is None
assert "numba" not in sys.modules
assert (loops_for("guideways.compiled", 1) is not None) == {then}
"""


@pytest.mark.parametrize("then", [False, True])
def test_a_command_loads_numba_where_it_pays(then):
    """Which is told by what it has done: the same command takes the same way."""
    code = LOADED.format(work=PATIENCE.work if then else 1000, then=then)
    subprocess.run([sys.executable, "-c", code], check=True)


def test_what_cannot_be_loaded_is_done_without(monkeypatch):
    monkeypatch.setitem(sys.modules, "movingfrf.nothing.compiled", None)
    with compiling(True):
        assert loops_for("nothing.compiled", 1) is None


@pytest.mark.parametrize("choice", [True, False])
@pytest.mark.parametrize("beam", ["slender", "damped", "thick"])
def test_five_layers_near_rest_are_as_at_rest(beam, choice):
    """Ten waves, eight of which run away to infinity; in whatever order frequencies are asked for."""
    beams = {
        "slender": mf.EulerBernoulliBeam(6.4e6, 60.0),
        "damped": mf.EulerBernoulliBeam(6.4e6, 60.0, bending_damping=2e4),
        "thick": mf.TimoshenkoBeam(6.4e6, 60.0, shear_stiffness=4e8, rotary_inertia=5.5),
    }
    below = mf.Spring(5e7, 3e4)
    for mass in (200.0, 300.0, 700.0, 900.0, 500.0):
        below = mf.OnMass(mf.Spring(1e8, 3e4), mass, below)
    road, omega = mf.track(beams[beam], below), 2 * np.pi * np.linspace(0.0, 200.0, 1281) - 0.3j
    with compiling(choice):
        for grid in (omega, np.random.default_rng(0).permutation(omega)):
            wanted = road.moving_frf([0.0, 3.0, -3.0], 0.0, grid)
            for speed in (1e-12, 1e-10, 1e-9, 1e-6):
                found = road.moving_frf([0.0, 3.0, -3.0], speed, grid)
                assert off(found, wanted) < 1e-10 + speed


def test_a_numba_that_does_not_fit_is_done_without(monkeypatch):
    """Whatever it raises; and what cannot be compiled for want of room."""
    from movingfrf._basics import compiling as decided

    for error in (AttributeError("numpy has no attribute"), OSError(28, "No space left on device"), SystemError()):
        decided._loaded.cache_clear()

        def fails(name, error=error):
            raise error

        monkeypatch.setattr(decided, "import_module", fails)
        with compiling(True):
            assert loops_for("guideways.compiled", 1) is None
    monkeypatch.undo()
    decided._loaded.cache_clear()


def test_a_run_of_the_reference_case_does_without_numba(tmp_path):
    """As `python -m movingfrf` too, whose name Python has replaced by a path when it matters."""
    start = [sys.executable, "-X", "importtime", "-m", "movingfrf"]
    subprocess.run([*start[:1], *start[3:], "new", tmp_path / "one.toml"], check=True, capture_output=True)
    done = subprocess.run(
        [*start, "run", tmp_path / "one.toml", "--output", tmp_path / "out", "--no-report"],
        check=True,
        capture_output=True,
        text=True,
    )
    loaded = {line.rpartition("|")[2].strip() for line in done.stderr.splitlines()}
    assert "movingfrf.response.simulation" in loaded
    assert "numba" not in loaded

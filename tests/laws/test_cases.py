"""Many cases at once are the same as one after the other, for whatever is solved."""

import tracemalloc

import numpy as np
import pytest

import movingfrf as mf
from movingfrf.response import batches
from movingfrf.response.line import Line
from movingfrf.response.sampling import Driving, excited
from movingfrf.response.solve import solve
from movingfrf.response.stability import _turned, along_the_axis, stretches
from movingfrf.response.survey import survey
from movingfrf.response.system import Prescribed, System
from movingfrf.response.truncation import Truncation
from tests.helpers import DAMPED, VEHICLES

ROAD = DAMPED["euler_bernoulli_winkler"]
LINE = Line(samples=3000, time_step=1e-3)
CUT = Truncation(frequency=70.0)


def records(cases, ports):
    """Smooth records that begin at zero."""
    random = np.random.default_rng(2)
    freely = np.cumsum(random.normal(size=(cases, ports, LINE.samples)), axis=-1)
    return freely * np.linspace(0.0, 1.0, LINE.samples) ** 2


# A train of two parts, and a wheel that follows the road, are among them.
CARRIERS = VEHICLES | {
    "train": mf.convoy([VEHICLES["half_truck"], VEHICLES["quarter_truck"]], gaps=8.0),
    "wheelset": mf.wheelset(mass=1500.0),
}


@pytest.mark.parametrize(
    "name",
    ["quarter_truck", "half_truck", "three_axles", "critically_damped_mass", "full_truck", "train", "wheelset"],
)
def test_vehicles(name):
    """Three cases, two of them in a second axis: spectra, solution, histories and survey."""
    system = System(guideway=ROAD, vehicle=CARRIERS[name], speed=20.0)
    roads = records(4, len(CARRIERS[name].contacts)).reshape(2, 2, -1, LINE.samples)
    together = LINE.spectra(LINE.given(roads))
    at_once = solve(system, LINE.omega(), together, truncation=CUT)
    histories = at_once.histories(LINE)
    for index in np.ndindex(2, 2):
        alone = solve(system, LINE.omega(), LINE.spectra(LINE.given(roads[index])), truncation=CUT)
        for mine, other in zip(alone, at_once, strict=True):
            np.testing.assert_allclose(mine, other[index], atol=1e-12 * np.abs(other).max())
        for mine, other in zip(alone.histories(LINE), histories, strict=True):
            np.testing.assert_allclose(mine.values, other.values[index], atol=1e-9 * np.abs(other.values).max())

    # One road is rigid from where on it may be for each of them.
    def cut(some):
        step = LINE.time_step
        found = excited(
            system, Driving(lambda line: line.given(some), step), LINE, truncation=None, solved_step=step
        )
        return found.truncation

    assert cut(roads).frequency == max(cut(roads[index]).frequency for index in np.ndindex(2, 2))


def test_prescribed_forces():
    system = Prescribed(guideway=ROAD, loads=np.array([0.0, -3.0]), points=np.array([0.0, 1.0, -2.0]), speed=20.0)
    forces = LINE.spectra(LINE.given(records(3, 2)))
    at_once = solve(system, LINE.omega(), forces, truncation=CUT).deflection
    alone = [solve(system, LINE.omega(), one, truncation=CUT).deflection for one in forces]
    np.testing.assert_allclose(at_once, alone, atol=1e-13 * np.abs(at_once).max())


@pytest.mark.parametrize("ports", [1, 2, 3, 5, 17])
def test_small_matrices(ports):
    """Products and solutions, frequency last, are those of NumPy, frequency first; any number of cases."""
    random = np.random.default_rng(0)
    shapes = (ports, ports, 40), (2, 3, ports, 40)
    matrices, columns = (random.normal(size=shape) + 1j * random.normal(size=shape) for shape in shapes)
    first, last = np.moveaxis(matrices, -1, 0), np.moveaxis(columns, -1, 0)[..., None]
    product = np.moveaxis((first[:, None, None] @ last)[..., 0], 0, -1)
    np.testing.assert_allclose(batches.applied(matrices, columns), product, atol=1e-12)
    back = batches.solved(matrices, batches.applied(matrices, columns))
    np.testing.assert_allclose(back, columns, atol=1e-9)
    square = np.moveaxis(first @ first, 0, -1)
    np.testing.assert_allclose(batches.multiplied(matrices, matrices), square, atol=1e-12)


def test_a_path_in_stretches_turns_as_the_whole():
    """Of many contacts the path along the axis is evaluated stretch by stretch."""
    system = System(guideway=ROAD, vehicle=CARRIERS["train"], speed=20.0)
    path = along_the_axis(system.vehicle, system.speed)
    whole = _turned(system, system.at(path))
    for most in (3, 16, 101):
        cut = stretches(path, most)
        assert max(piece.size for piece in cut) <= most
        assert all(piece.size % 2 for piece in cut)
        assert sum(_turned(system, system.at(piece)) for piece in cut) == pytest.approx(whole, abs=1e-9)


def test_what_has_no_answer_is_refused_though_the_road_is_rigid():
    """Beyond the truncation there is no deflection to look at."""
    system = System(guideway=ROAD, vehicle=VEHICLES["quarter_truck"], speed=20.0)
    omega = LINE.omega()[500:520]
    with pytest.raises(mf.SolveError, match=r"no finite response at \d"):
        solve(system, omega, np.full((1, omega.size), np.nan + 0j), truncation=Truncation(frequency=1.0))


def test_many_contacts_take_little_memory_before_they_are_solved():
    """Tables of a hundred contacts have ten thousand entries at each frequency."""
    wheels = mf.Vehicle(
        mass=1000.0 * np.eye(100),
        damping=np.zeros((100, 100)),
        stiffness=np.zeros((100, 100)),
        contact_map=np.eye(100),
        contacts=[mf.Contact(position=-2.0 * n, stiffness=3e6, damping=3e4) for n in range(100)],
        vertical=np.ones(100),
        dof_names=[f"wheel_{n}" for n in range(100)],
    )
    system = System(guideway=ROAD, vehicle=wheels, speed=20.0)
    line = Line(samples=500, time_step=2e-3)
    system.dynamics  # noqa: B018 (computed once, and not counted)
    tracemalloc.start()
    survey(system)
    surveyed = tracemalloc.get_traced_memory()[1]
    excited(system, Driving(lambda line: line.given(np.ones((1, 100, 500))), 2e-3), line, truncation=70.0)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    # All at once tables took 420 MB; then there is what each contact does to each of 400 outputs, in bands.
    assert surveyed < 60e6
    assert peak < 250e6


def test_many_loads_take_little_memory():
    """The matrices of a hundred loads and a hundred points are made for few frequencies at a time."""
    places = -0.5 * np.arange(100.0)
    force = np.repeat(np.sin(0.1 * np.arange(1000.0))[:, None], 100, axis=1)
    tracemalloc.start()
    mf.moving_loads(ROAD, force, places, speed=10.0)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    # All at once they take 600 MB.
    assert peak < 80e6, peak

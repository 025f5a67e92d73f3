"""Many cases at once are the same as one after the other, for whatever is solved."""

import numpy as np
import pytest

import movingfrf as mf
from movingfrf.response import batches
from movingfrf.response.line import Line
from movingfrf.response.solve import solve
from movingfrf.response.survey import survey
from movingfrf.response.system import Prescribed, joined
from movingfrf.response.truncation import Truncation
from tests.helpers import DAMPED, VEHICLES

ROAD = DAMPED["euler_bernoulli_winkler"]
LINE = Line(samples=3000, time_step=1e-3, settling=1.0)
CUT = Truncation(frequency=70.0)


def records(cases, ports):
    """Smooth records that begin at zero."""
    random = np.random.default_rng(2)
    freely = np.cumsum(random.normal(size=(cases, ports, LINE.samples)), axis=-1)
    return freely * np.linspace(0.0, 1.0, LINE.samples) ** 2


@pytest.mark.parametrize(
    "name", ["quarter_truck", "half_truck", "three_axles", "critically_damped_mass", "full_truck"]
)
def test_vehicles(name):
    """Three cases, two of them in a second axis: spectra, solution, histories and survey."""
    system = joined(ROAD, VEHICLES[name], 20.0)
    roads = records(4, len(VEHICLES[name].contacts)).reshape(2, 2, -1, LINE.samples)
    together = LINE.spectra(roads)
    at_once = solve(system, LINE.omega(), together, truncation=CUT)
    histories = at_once.histories(LINE)
    for index in np.ndindex(2, 2):
        alone = solve(system, LINE.omega(), LINE.spectra(roads[index]), truncation=CUT)
        for mine, other in zip(alone, at_once, strict=True):
            np.testing.assert_allclose(mine, other[index], atol=1e-12 * np.abs(other).max())
        for mine, other in zip(alone.histories(LINE), histories, strict=True):
            np.testing.assert_allclose(mine.values, other.values[index], atol=1e-9 * np.abs(other.values).max())
    # One road is rigid from where on it may be for each of them.
    found = [survey(system, LINE, together[index], None).truncation for index in np.ndindex(2, 2)]
    of_all = survey(system, LINE, together, None).truncation
    assert of_all.frequency == max(one.frequency for one in found)


def test_prescribed_forces():
    system = Prescribed(guideway=ROAD, loads=np.array([0.0, -3.0]), points=np.array([0.0, 1.0, -2.0]), speed=20.0)
    forces = LINE.spectra(records(3, 2))
    at_once = solve(system, LINE.omega(), forces, truncation=CUT).deflection
    alone = [solve(system, LINE.omega(), one, truncation=CUT).deflection for one in forces]
    np.testing.assert_allclose(at_once, alone, atol=1e-13 * np.abs(at_once).max())


@pytest.mark.parametrize("ports", [1, 2, 3, 5])
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


def test_many_loads_take_little_memory():
    """The matrices of a hundred loads and a hundred points are made for few frequencies at a time."""
    import tracemalloc

    places = -0.5 * np.arange(100.0)
    force = np.repeat(np.sin(0.1 * np.arange(400.0))[:, None], 100, axis=1)
    tracemalloc.start()
    mf.moving_loads(ROAD, force, places, speed=10.0, truncation=100.0)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 100e6

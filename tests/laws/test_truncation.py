"""What a truncation leaves out does not come back: not at the end of a record, and not as a step in frequency."""

import numpy as np
import pytest

import movingfrf as mf
from movingfrf.response.line import Line
from movingfrf.response.truncation import EVERYWHERE, Truncation
from movingfrf.scenarios import forces
from tests.helpers import DAMPED, HALF_TRUCK

ROAD = DAMPED["euler_bernoulli_winkler"]


def by_seconds(values):
    """Root mean square of each second of a record in steps of 1 ms, shape (second, channel)."""
    return np.sqrt(np.mean(values.reshape(-1, 1000, values.shape[1]) ** 2, axis=1))


def test_the_last_second_is_as_good_as_the_others():
    """Roughness goes on to 100 Hz. A sharp cut at 50 Hz rings, and the exponential window raises what is late."""
    surface = mf.realise(mf.IsoRoad.of_class("A"), length=255.0, step=0.02, seed=3, start=-5.0)
    travel = {"speed": 10.0, "duration": 24.0}
    truck = mf.half_car(**HALF_TRUCK)
    whole = mf.simulate(ROAD, truck, surface, **travel, truncation=500.0).deflection.values
    with pytest.warns(mf.ValidityWarning, match="truncation"):
        cut = mf.simulate(ROAD, truck, surface, **travel, truncation=50.0).deflection.values
    error = by_seconds(cut - whole)
    assert (error[-1] < 1.5 * np.median(error, axis=0)).all()


def test_prescribed_loads_end_as_well_as_they_begin():
    """A force with as much beyond the truncation as before it, all the time."""
    time = 1e-3 * np.arange(12_000)
    force = forces.random_sum(rms=1e4, lowest=1.0, highest=100.0, count=400, seed=1, ramp=0.5)(time)[:, None]
    travel = {"positions": [0.0], "speed": 10.0}
    whole = mf.moving_loads(ROAD, force, **travel).deflection.values
    with pytest.warns(mf.ValidityWarning, match="truncation"):
        cut = mf.moving_loads(ROAD, force, **travel, truncation=50.0).deflection.values
    error = by_seconds(cut - whole)
    assert (error[-1] < 1.5 * np.median(error, axis=0)).all()


def test_what_a_truncation_leaves_out_of_prescribed_loads_does_not_ring_on():
    """As much beyond the truncation as before it for two seconds, then nothing."""
    time = 1e-3 * np.arange(12_000)
    force = forces.random_sum(rms=1e4, lowest=1.0, highest=100.0, count=400, seed=1, ramp=0.5, switch_off=2.0)(time)
    travel = {"force": force[:, None], "positions": [0.0], "speed": 10.0}
    whole = mf.moving_loads(ROAD, **travel).deflection.values
    with pytest.warns(mf.ValidityWarning, match="truncation"):
        cut = mf.moving_loads(ROAD, **travel, truncation=50.0).deflection.values
    error = by_seconds(cut - whole)
    assert error[3:].max() < 1e-3 * error.max()


@pytest.mark.parametrize("truncation", [10.0, 70.0, 490.0, 600.0])
def test_compliance_falls_smoothly_from_one_to_nothing(truncation):
    omega, cut = Line(samples=20_000, time_step=1e-3).omega(), Truncation(frequency=truncation)
    share = cut.taper(omega)
    frequency = omega.real / (2 * np.pi)
    assert (share[frequency <= truncation * (1 - 1e-9)] == 1.0).all()
    assert (share[frequency > 1.051 * truncation] == 0).all()
    assert (np.diff(share) <= 0).all()
    # Of degree thirteen: its steepest slope is 13!/(6!)²/2¹² of the mean one.
    step = frequency[1] / (0.05 * truncation)
    assert np.abs(np.diff(share)).max() <= 12012 / 4096 * step * (1 + 1e-9)
    assert abs(cut.untouched(omega) - np.sum(share == 1.0)) <= 0.01 / step + 1
    assert abs(cut.reach(omega) - np.sum(share > 0)) <= 1


def test_without_a_truncation_nothing_is_touched():
    omega = Line(samples=1000, time_step=1e-3).omega()
    assert EVERYWHERE.untouched(omega) == EVERYWHERE.reach(omega) == omega.size
    assert (EVERYWHERE.taper(omega) == 1).all()


def test_a_truncation_at_zero_is_a_rigid_road():
    surface = mf.bump(height=0.01, width=1.0, at=5.0, length=30.0)
    truck = mf.half_car(**HALF_TRUCK)
    travel = {"speed": 10.0, "duration": 1.0, "start": 2.5, "blend": 0.0}
    with pytest.warns(mf.ValidityWarning, match="truncation") as warned:
        cut = mf.simulate(ROAD, truck, surface, **travel, truncation=0.0)
    # A warning points at who called the package.
    assert {warning.filename for warning in warned} == {__file__}
    rigid = mf.simulate(mf.RigidGuideway(), truck, surface, **travel)
    assert cut.contact_force.values == pytest.approx(rigid.contact_force.values, rel=1e-6, abs=2.0)

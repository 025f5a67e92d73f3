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


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_a_cut_rings_neither_on_nor_around():
    """Switched on once and for all under a truncation: in the end the load stands where it would without."""
    for samples, truncation, left in (
        (4000, 20.0, 3e-4),
        (1500, 20.0, 1e-2),
        (1000, 50.0, 1e-3),
        (700, 100.0, 1e-4),
    ):
        travel = {"force": np.full((samples, 1), 1e5), "positions": [0.0], "speed": 10.0}
        whole = mf.moving_loads(ROAD, **travel).deflection.values
        cut = mf.moving_loads(ROAD, **travel, truncation=truncation).deflection.values
        assert np.abs(cut - whole)[-samples // 5 :].max() < left * np.abs(whole).max()


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_a_wheel_of_its_own_swiftness_does_not_bounce_at_the_end():
    """Its own vibration dies away within 4 ms: the padding must be longer all the same."""
    wheel = mf.sprung_mass(mass=10.0, stiffness=1e6, damping=6e3, wheel_mass=500.0)
    hump = mf.bump(height=0.02, width=0.1, at=0.05, length=60.0)
    travel = {"speed": 10.0, "duration": 2.0, "blend": 0.0, "time_step": 1e-4}
    cut, whole = (mf.simulate(ROAD, wheel, hump, truncation=f, **travel).contact_force.values for f in (500.0, 1e5))
    assert np.abs(cut[1000:]).max() < 1e-2 * np.abs(whole).max()


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
@pytest.mark.parametrize("damping", [0.0, 3.0e4])
def test_motion_that_dies_away_more_slowly_than_on_held_contacts_does_not_wrap_around(damping):
    """A mass on a stiff spring: what is left of it after 1 s belongs to the guideway."""
    road = mf.track(mf.EulerBernoulliBeam(1.573e7, 711.9), mf.Spring(8.0e6, damping))
    mass = mf.sprung_mass(mass=5000.0, stiffness=1e9, damping=2e6)
    hump = mf.bump(height=0.02, width=1.0, at=9.0, length=200.0)
    short = mf.simulate(road, mass, hump, speed=10.0, duration=1.0, blend=0.0)
    step = short.attrs["solved_step"]
    long = mf.simulate(road, mass, hump, speed=10.0, duration=8.0, blend=0.0, solved_step=step)
    for name in ("contact_force", "deflection", "motion"):
        size = np.abs(long[name].values - long[name].values[0]).max()
        assert np.abs(short[name].values - long[name].values[: short.sizes["time"]]).max() < 5e-5 * size

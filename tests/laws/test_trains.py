"""A train is solved car by car: everything as if all of its contacts were solved at once."""

from dataclasses import replace

import numpy as np
import pytest

import movingfrf as mf
from movingfrf.guideways.waves import Waves
from movingfrf.response import along, batches, stability
from movingfrf.response import system as systems
from movingfrf.response.along import CarByCar, in_order
from movingfrf.response.stability import along_the_axis, growing_vibrations
from movingfrf.response.survey import survey
from movingfrf.response.system import System, Tables
from movingfrf.response.truncation import Truncation
from tests.helpers import DAMPED, UNDAMPED, VEHICLES
from tests.laws.test_stability import LIVELY, SLACK, wheels


def coach(contact_stiffness=np.inf, mass=1.0):
    return mf.carriage(
        body_mass=47_800.0 * mass,
        body_pitch_inertia=1_957_888.0,
        bogie_mass=3500.0,
        bogie_pitch_inertia=1715.0,
        wheelset_mass=1800.0,
        primary_stiffness=2.4e6,
        primary_damping=2.0e4,
        secondary_stiffness=7.0e5,
        secondary_damping=4.0e4,
        bogie_spacing=17.375,
        axle_spacing=2.5,
        contact_stiffness=contact_stiffness,
    )


def side_by_side(vehicle, number, ahead):
    """Vehicles that do not touch, each so far ahead of the one before that they overlap."""
    each = np.eye(number)
    return mf.Vehicle(
        mass=np.kron(each, vehicle.mass),
        damping=np.kron(each, vehicle.damping),
        stiffness=np.kron(each, vehicle.stiffness),
        contact_map=np.kron(each, vehicle.contact_map),
        contacts=[
            replace(one, position=one.position + ahead * n) for n in range(number) for one in vehicle.contacts
        ],
        vertical=np.tile(vehicle.vertical, number),
        dof_names=[f"{n}_{name}" for n in range(number) for name in vehicle.dof_names],
    )


HERTZ = 2.9e9
TRUCK, FOUR_WHEELS = VEHICLES["half_truck"], VEHICLES["full_truck"]
TRAINS = {
    "two coaches": mf.train(coach(), 2, spacing=24.775),
    "sixteen coaches on springs": mf.train(coach(HERTZ), 16, spacing=24.775),
    "mixed": mf.convoy([coach(), coach(HERTZ, 0.4), coach(), coach(HERTZ)], spacing=24.775),
    "left and right": mf.convoy([FOUR_WHEELS, TRUCK, FOUR_WHEELS, FOUR_WHEELS], gaps=[4.0, 0.7, 30.0]),
    "overtaking": mf.convoy([side_by_side(TRUCK, 3, 1.25), TRUCK, side_by_side(TRUCK, 3, 1.25)], gaps=5.5),
    "wheels": wheels(12, 1.8, 1e3),
}


def dense(road, vehicle, speed, omega):
    frf = np.moveaxis(road.moving_frf(speed=speed, omega=omega, **vehicle.offsets), 0, -1)
    return Tables(omega, frf, vehicle.dynamics().stiffness(omega))


def off(mine, others):
    """Largest difference relative to the largest value of all, and a tenth of that relative to its frequency's."""
    apart, size = np.abs(mine - others).max(axis=(0, 1)), np.abs(others).max(axis=(0, 1))
    return max(apart.max() / size.max(), 0.1 * (apart / size).max())


@pytest.mark.parametrize("share", [1e-5, 0.3, 1.01, 1.7])
@pytest.mark.parametrize("name", list(TRAINS))
@pytest.mark.parametrize("road", [*DAMPED, "undamped_euler_bernoulli_winkler", "undamped_timoshenko_pasternak"])
def test_a_train_is_solved_as_all_contacts_at_once(road, name, share):
    """Roughness in two cases, weights, beyond a truncation too; the determinant of all."""
    guideway = UNDAMPED[road.removeprefix("undamped_")] if road.startswith("undamped") else DAMPED[road]
    vehicle = TRAINS[name]
    speed = share * (guideway.critical_speed if np.isfinite(guideway.critical_speed) else 300.0)
    omega = 2 * np.pi * np.geomspace(0.05, 250.0, 12) - 0.1j
    here, there = (
        CarByCar(in_order(vehicle), omega, guideway.waves(speed, omega)),
        dense(guideway, vehicle, speed, omega),
    )
    # Without damping the equations themselves leave a digit less.
    allowed = 1e-10 if road.startswith("undamped") else 1e-11
    random = np.random.default_rng(3)
    given = random.normal(size=(2, len(vehicle.contacts), omega.size)) + 0j
    for mine, others in zip(here.coupled(given), there.coupled(given), strict=True):
        assert off(mine, others) < allowed
    for mine, others in zip(here.carried(given), there.carried(given), strict=True):
        assert off(mine, others) < allowed
    cut = Truncation(frequency=50.0)
    force, deflection = here.admitted(cut).coupled(given)
    stiff_force, stiff_deflection = there.admitted(cut).coupled(given)
    assert off(force, stiff_force) < allowed
    assert not stiff_deflection[..., -1].any()
    assert not deflection[..., -1].any()
    assert off(deflection[..., :9], stiff_deflection[..., :9]) < allowed
    np.testing.assert_allclose(
        np.prod([along.determinants(piece) ** times for times, piece in here.pieces], axis=0),
        along.determinants(there.matrix),
        rtol=1e-9,
    )


@pytest.mark.parametrize("ways", [6, 1])
def test_waves_on_each_side_may_be_more_and_fewer(ways):
    """Five to none of five run ahead, from frequency to frequency; or none at all, above the speed of all waves."""
    random, omega = np.random.default_rng(0), np.linspace(10.0, 60.0, 12) + 0j
    forward = np.array([n % ways for n in range(12)])[None] > np.arange(5)[:, None]
    kappa = random.uniform(-2, 2, (5, 12)) + 1j * np.where(forward, 1, -1) * random.uniform(0, 2, (5, 12))
    waves = Waves(kappa, 1e-9 * (random.normal(size=(5, 12)) + 1j * random.normal(size=(5, 12))), forward)
    vehicle = TRAINS["mixed"]
    offsets = vehicle.offsets["ahead"][..., None]
    frf = np.zeros((*offsets.shape[:2], 12), complex)
    for wave, weight, ahead in zip(*waves, strict=True):
        with np.errstate(all="ignore"):
            one = np.exp(1j * wave * offsets)
            frf += np.where(ahead & (offsets >= 0), weight * one, 0) - np.where(
                ~ahead & (offsets < 0), weight * one, 0
            )
    given = random.normal(size=(1, len(vehicle.contacts), 12)) + 0j
    there = Tables(omega, frf, vehicle.dynamics().stiffness(omega))
    for mine, others in zip(
        CarByCar(in_order(vehicle), omega, waves).coupled(given), there.coupled(given), strict=True
    ):
        assert off(mine, others) < 1e-11


@pytest.mark.parametrize(
    ("name", "blocks", "kinds"),
    [
        ("sixteen coaches on springs", 16, 1),
        ("mixed", 4, 3),
        ("left and right", 4, 2),
        ("overtaking", 3, 2),
        ("wheels", 12, 1),
    ],
)
def test_what_stands_one_behind_the_other(name, blocks, kinds):
    """What overlaps is one block, equal cars are of one kind, and no contact is left out."""
    order = in_order(TRAINS[name])
    assert (len(order.blocks), len(order.kinds)) == (blocks, kinds)
    assert sorted(np.concatenate(order.blocks)) == list(range(len(TRAINS[name].contacts)))
    assert all(gap > 0 for gap in order.gaps[1:])


def test_equal_cars_are_computed_once():
    """Their modes are the same values, and the response of all of them is that of each."""
    dynamics, one = TRAINS["sixteen coaches on springs"].dynamics(), coach(HERTZ).dynamics()
    assert len(dynamics.parts) == 16
    assert all(part.modes is dynamics.parts[0].modes for part in dynamics.parts)
    omega = np.linspace(1.0, 500.0, 7) - 0.1j
    below = np.random.default_rng(0).normal(size=(2, 16, 4, 7)) + 0j
    together = dynamics.response(omega, below.reshape(2, 64, 7))
    alone = one.response(omega, below)
    for mine, others in zip(together, alone, strict=True):
        np.testing.assert_allclose(mine.reshape(others.shape), others, atol=1e-13 * np.abs(others).max())
    assert dynamics.poles.size == 16 * one.poles.size


class Hidden:
    """A guideway that does not tell its waves."""

    def __init__(self, road):
        self.critical_speed, self.moving_frf = road.critical_speed, road.moving_frf


def test_a_guideway_without_waves_is_solved_at_once():
    road, train = DAMPED["rail_pad_sleeper_ballast"], TRAINS["mixed"]
    assert System(guideway=road, vehicle=train, speed=50.0).train is not None
    assert System(guideway=Hidden(road), vehicle=train, speed=50.0).train is None
    assert System(guideway=road, vehicle=TRUCK, speed=50.0).train is None


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
@pytest.mark.parametrize("contact_stiffness", [np.inf, HERTZ])
def test_a_drive_is_the_same_either_way(contact_stiffness):
    """Steps, truncation, loads and records: with the waves of the track, and without."""
    road, train = DAMPED["rail_pad_sleeper_ballast"], mf.train(coach(contact_stiffness), 4, spacing=24.775)
    profile = mf.realise(mf.GermanTrack.of_class("low", band=(0.02, 0.5)), length=300.0, step=0.1, start=-120.0)
    results = [
        mf.simulate(guideway, train, profile, speed=60.0, duration=2.0, time_step=5e-3, truncation=60.0)
        for guideway in (road, Hidden(road))
    ]
    for name in ("contact_force", "deflection", "acceleration", "motion", "static_load", "static_deflection"):
        mine, others = (result[name].values for result in results)
        assert np.abs(mine - others).max() < 1e-9 * np.abs(others).max(), name
    assert results[0].attrs["solved_step"] == results[1].attrs["solved_step"]


def test_the_sag_shares_the_weight_anew():
    """Of three axles one is more than rigid motions determine: (I + D G) F₀ = F_s at rest, written out."""
    road, lorries = DAMPED["euler_bernoulli_winkler"], mf.convoy([VEHICLES["three_axles"]] * 3, gaps=6.0)
    system = System(guideway=road, vehicle=lorries, speed=20.0)
    assert system.train is not None
    steady = survey(system).steady
    there = dense(road, lorries, 20.0, np.zeros(1, complex))
    load = np.linalg.solve(there.matrix[..., 0].real, lorries.static_loads)
    np.testing.assert_allclose(steady.load, load, rtol=1e-9)
    np.testing.assert_allclose(steady.deflection, there.frf[..., 0].real @ load, rtol=1e-9)
    assert np.abs(load / lorries.static_loads - 1).max() > 1e-3


SOFT = mf.quarter_car(**SLACK)
PASTERNAK = DAMPED["euler_bernoulli_pasternak"]
# Guideway, vehicle, share of the critical speed.
COUNTED = {
    "ten, slow": (LIVELY, mf.convoy([SOFT] * 10, spacing=20.0), 0.6),
    "far apart": (LIVELY, mf.convoy([SOFT] * 10, spacing=300.0), 1.1),
    "close together": (LIVELY, mf.convoy([SOFT] * 10, spacing=9.0), 1.2),
    "coaches, slow": (DAMPED["rail_pad_sleeper_ballast"], mf.train(coach(), 3, spacing=24.775), 0.3),
    "coaches, fast": (DAMPED["euler_bernoulli_winkler"], mf.train(coach(), 3, spacing=24.775), 1.7),
    "coaches on springs, fast": (DAMPED["euler_bernoulli_winkler"], mf.train(coach(HERTZ), 3, spacing=24.775), 1.7),
    "many alike": (LIVELY, mf.convoy([SOFT] * 9, spacing=12.0), 1.5),
    "hardly damped": (PASTERNAK, wheels(11, 2.27, 3.4), 0.95),
}


@pytest.mark.parametrize("name", list(COUNTED))
def test_growing_vibrations_are_counted_alike(name):
    road, vehicle, share = COUNTED[name]
    speed = share * road.critical_speed
    counts = []
    for guideway in (road, Hidden(road)):
        system = System(guideway=guideway, vehicle=vehicle, speed=speed)
        counts.append(growing_vibrations(system, [system.at(along_the_axis(vehicle, speed))]))
    assert counts[0] == counts[1]
    assert (counts[0] > 0) == (share > 1.0 or name == "hardly damped")


def test_an_unstable_train_is_refused_by_name():
    road, vehicle, share = COUNTED["coaches, fast"]
    with pytest.raises(mf.SolveError, match=r"a vibration of .* Hz grows") as mine:
        stability.require_stable(*_system_and_path(road, vehicle, share * road.critical_speed))
    with pytest.raises(mf.SolveError) as others:
        stability.require_stable(*_system_and_path(Hidden(road), vehicle, share * road.critical_speed))
    assert str(mine.value) == str(others.value)


def _system_and_path(road, vehicle, speed):
    system = System(guideway=road, vehicle=vehicle, speed=speed)
    return system, [system.at(along_the_axis(vehicle, speed))]


def test_cost_is_in_proportion_to_the_cars(monkeypatch):
    """Numbers that are multiplied and solved for, of a solution and of what the stability is counted by."""
    counted = [0]

    def counting(function):
        def made(*arrays):
            counted[0] += sum(array.size for array in arrays)
            return function(*arrays)

        return made

    for name in ("applied", "multiplied", "solved", "determinants"):
        monkeypatch.setattr(along, name, counting(getattr(along, name)))
    omega = np.linspace(1.0, 500.0, 5) - 0.1j
    costs = []
    for cars in (4, 8, 16):
        train = mf.train(coach(), cars, spacing=24.775)
        system = System(guideway=DAMPED["rail_pad_sleeper_ballast"], vehicle=train, speed=60.0)
        counted[0] = 0
        tables = system.at(omega)
        assert isinstance(tables, CarByCar)
        tables.coupled(np.ones((4 * cars, omega.size), complex))
        assert tables.pieces
        costs.append(counted[0])
    assert costs[2] - costs[1] == 2 * (costs[1] - costs[0])
    # Many more frequencies at a time than matrices of all contacts would let in.
    assert batches.BATCH.frequencies(system.entries) > 3 * batches.BATCH.frequencies(64**2)


def test_per_unit_of_roughness_alike(monkeypatch):
    road, train = DAMPED["rail_pad_sleeper_ballast"], TRAINS["mixed"]
    omega = 2 * np.pi * np.geomspace(0.1, 200.0, 9) - 0.1j
    mine = System(guideway=road, vehicle=train, speed=60.0).per_unit(omega)
    monkeypatch.setattr(systems, "BATCH", replace(batches.BATCH, at_once=1000))
    others = System(guideway=road, vehicle=train, speed=60.0).per_unit(omega)
    for one, other in zip(mine, others, strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-8, atol=1e-11 * np.abs(other).max())

"""Vehicles: what is refused, their modes by name, their matrices in files."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import movingfrf as mf
from tests.analytic.vehicle_parts import (
    BOGIE,
    COACH,
    DRIVE,
    HITCH,
    OMEGA,
    RIGID,
    STEER,
    TANDEM,
    TRACTOR,
    TRAILER,
    constrained,
    of,
    own,
    plank,
    seat,
)
from tests.helpers import (
    DAMPED,
    HALF_TRUCK,
    VEHICLES,
    dynamic_stiffness,
)

# Refusals.

CONTACT = mf.Contact(position=0.0, stiffness=1e6)


@pytest.mark.parametrize(
    ("make", "match"),
    [
        (lambda: mf.Contact(position=0.0, stiffness=np.inf, damping=1.0), r"damping must be 0 at a rigid contact"),
        (lambda: mf.Contact(position=0.0, stiffness=-np.inf), r"stiffness must be a positive number, got -inf"),
        (lambda: mf.Contact(position=0.0, stiffness=1e6, cams=-0.1), r"cams must not be negative, got -0.1 m"),
        (lambda: mf.Contact(position=0.0, stiffness=1e6, name=3), r"name must be a text, got 3"),
        (
            lambda: replace(
                plank(), contacts=[replace(c, position=0.0) for c in plank().contacts], contact_map=[[1, 0, 0]] * 2
            ),
            r"contacts must not prescribe one motion twice",
        ),
        (
            lambda: mf.full_car(**full_car() | {"sides": (2.0, 1.0)}),
            r"contacts\[0\] at 1.4 m ahead and 2 m to the left must carry weight, got a static load of -",
        ),
        (lambda: mf.half_car(**HALF_TRUCK | {"axles": (3.0, 1.0)}), r"contacts\[0\] .* would tip over"),
        (lambda: mf.Body(mass=0.0), r"mass must be positive, got 0.0 kg"),
        (lambda: mf.Body(mass=1.0, pitch_inertia=-1.0), r"pitch_inertia must be positive, got -1.0 kg m²"),
        (lambda: mf.Suspension(upper="a", lower="b", stiffness=0.0), r"stiffness or damping must be positive"),
        (
            lambda: mf.assemble(bodies=[mf.Body(mass=1.0, name="a")], contacts=[CONTACT], under=["b"]),
            r"under\[0\] must be one of the bodies 'a', got 'b'",
        ),
        (
            lambda: mf.assemble(bodies=[mf.Body(mass=1.0), mf.Body(mass=1.0)], contacts=[CONTACT], under=[""]),
            r"bodies\[1\].name must be a different one for each body",
        ),
        (
            lambda: mf.assemble(bodies=[mf.Body(mass=1.0)], contacts=[CONTACT], under=["", ""]),
            r"under must name one body per contact, 1 in all, got 2",
        ),
        (
            lambda: mf.assemble(bodies=[], contacts=[CONTACT], under=[]),
            r"bodies must be a list of one or more Body",
        ),
        (
            lambda: mf.assemble(
                bodies=[mf.Body(mass=1.0, name=n, pitch_inertia=1.0) for n in "abc"],
                hinges=[
                    mf.Hinge(first="a", second="c", position=0.0),
                    mf.Hinge(first="b", second="c", position=1.0),
                ],
                contacts=[CONTACT],
                under=["a"],
            ),
            r"hinges must not hold a body twice",
        ),
        (
            lambda: mf.assemble(
                bodies=[mf.Body(mass=1.0, name=n) for n in "ab"],
                hinges=[mf.Hinge(first="a", second="b", position=0.0, rolls=True)],
                contacts=[CONTACT],
                under=["a"],
            ),
            r"hinges\[0\].rolls needs a body with a roll_inertia, but 'a' has none",
        ),
        (lambda: mf.truck(units=[TRACTOR, TRAILER]), r"hitches must be one less than units, 1 in all, got 0"),
        (lambda: mf.truck(units=[]), r"units must be a list of one or more Unit objects"),
        (
            lambda: mf.truck(units=[replace(TRACTOR, roll_inertia=None)], sides=(1.0, -1.0)),
            r"units\[0\].roll_inertia is needed for left and right wheels",
        ),
        (
            lambda: mf.truck(units=[TRACTOR], sides=(-1.0, 1.0)),
            r"sides must have the left wheels left of the right",
        ),
        (lambda: replace(TRACTOR, axles=[1]), r"axles must be a list of any number of"),
        (lambda: replace(TANDEM, positions=(-8.0, -7.0)), r"positions must have the front axle first"),
        (
            lambda: mf.truck(units=[replace(TRACTOR, axles=[STEER])]),
            r"contacts must hold the vehicle up, but a motion of tractor_bounce, tractor_pitch meets no stiffness",
        ),
        (
            lambda: mf.carriage(**COACH | {"axle_spacing": 20.0}),
            r"axle_spacing must be less than the bogie spacing 19 m",
        ),
        (lambda: mf.wheelset(mass=-1.0), r"mass must be positive"),
        (
            lambda: mf.wheelset(mass=1.0, contact_damping=1.0),
            r"contact_damping must be 0 at a rigid contact, got 1.0",
        ),
        (lambda: mf.carriage(**COACH | {"wheelset_mass": -1.0}), r"wheelset_mass must be positive, got -1.0 kg"),
        (lambda: mf.carriage(**COACH | {"secondary_damping": -1.0}), r"secondary_damping must not be negative"),
        (
            lambda: mf.bogie(**BOGIE, secondary_stiffness=1e6),
            r"body_mass must be positive above a secondary suspension",
        ),
        (lambda: mf.Hinge(first="a", second="a", position=0.0), r"second must be another body than the first"),
        (
            lambda: mf.truck(units=[replace(TRACTOR, axles=[DRIVE, STEER])]),
            r"units must have their axles in order from the front, got them at \[-1.5, 2.0\] m",
        ),
        (lambda: seat(seat_stiffness=5e3), r"seat_mass must be positive for a seat with a stiffness"),
        (
            lambda: mf.simulate(mf.RigidGuideway(), None, None, speed=1.0, duration=1.0),
            r"vehicle must be a Vehicle",
        ),
        (lambda: mf.hertzian_stiffness(0.0, wheel_radius=0.4), r"load must be positive"),
        (lambda: mf.convoy([], gaps=1.0), r"vehicles must be a list of one or more Vehicle objects"),
        (lambda: mf.convoy([plank()]), r"gaps or spacing is needed"),
        (lambda: mf.convoy([plank(), plank()], gaps=-0.5), r"gaps\[0\] must keep the contacts of vehicle 2 behind"),
        (lambda: mf.convoy([plank(), plank()], spacing=[1.0, 2.0]), r"spacing must have shape \(1\), got \(2,\)"),
        (lambda: mf.train(car=plank(), count=0, spacing=10.0), r"count must be a whole number of at least 1"),
        (lambda: seat(mount={"roll": 1.0}), r"mount.roll is no degree of freedom; there are body, wheel"),
        (lambda: seat(mount={}), r"mount must name degrees of freedom"),
        (lambda: seat(mount={"body": 0.5}), r"mount must move down by 1 m when the vehicle does, got 0.5 m"),
        (lambda: seat(seat_mass=10.0), r"seat_stiffness must be positive"),
        (lambda: mf.on_paths(plank(), [0]), r"paths must be one number per contact, 2 in all, got 1"),
        (lambda: mf.catalogue(name="tank"), r"name must be one of golden_car, .*, got 'tank'"),
    ],
)
def test_refusals(make, match):
    with pytest.raises(ValueError, match=match):
        make()


def full_car():
    return {
        "body_mass": 840.0,
        "pitch_inertia": 1100.0,
        "roll_inertia": 820.0,
        "wheel_masses": (53.0, 76.0),
        "suspension_stiffness": (1e4, 1.3e4),
        "suspension_damping": (900.0, 900.0),
        "tyre_stiffness": (2e5, 2e5),
        "axles": (1.4, -1.47),
        "sides": (0.7, -0.75),
    }


def test_time_stepping_refuses_rigid_contacts():
    road = mf.finite_track(DAMPED["euler_bernoulli_winkler"], first=-40.0, last=40.0, element=0.5)
    profile = mf.harmonic(amplitude=1e-3, wavelength=5.0, length=60.0, start=-20.0)
    with pytest.raises(ValueError, match="rigid contacts"):
        mf.cdfm(road, mf.wheelset(mass=1e3), profile, speed=10.0, duration=1.0, start=-10.0)


# Modes and files.


@pytest.mark.parametrize("name", ["half_truck", "full_truck", "semitrailer", "coach"])
def test_modes_solve_the_equations_of_motion(name):
    """(λ² M + λ C + K) q = 0 on the free motions, and shares that sum to one."""
    vehicle = {
        "semitrailer": mf.truck(units=[TRACTOR, TRAILER], hitches=[HITCH]),
        "coach": mf.carriage(**COACH),
    }.get(name) or VEHICLES[name]
    mass, damping, stiffness, at, springs, dashpots = own(vehicle)
    elastic = np.isfinite(springs)
    rows = at[elastic]
    stiffness = stiffness + rows.T * springs[elastic] @ rows
    damping = damping + rows.T * dashpots[elastic] @ rows
    modes = mf.vehicle_modes(vehicle)
    np.testing.assert_allclose([mode.frequency for mode in modes], vehicle.natural_frequencies, rtol=1e-9)
    np.testing.assert_allclose([mode.damping_ratio for mode in modes], vehicle.damping_ratios, rtol=1e-6, atol=1e-9)
    for mode in modes:
        push = (mode.pole**2 * mass + mode.pole * damping + stiffness) @ mode.shape
        free = ~at[~elastic].astype(bool).any(axis=0)
        assert np.abs(push[free]).max() < 1e-6 * np.abs(stiffness @ mode.shape).max()
        assert np.abs(mode.shape[~free]).max(initial=0.0) < 1e-12
        assert mode.share.sum() == pytest.approx(1.0)
        strongest = vehicle.dof_names[int(mode.share.argmax())]
        assert mode.description.startswith(f"{strongest} {100 * mode.share.max():.0f} %")


def test_a_mode_is_named_after_what_moves():
    """Behind a hinge, too: the drive axle hops at 10.5 Hz, where the true kinetic energy is nine tenths its own."""
    lorry = mf.catalogue(name="tractor_semitrailer")
    mass = np.asarray(lorry.mass)
    for mode in mf.vehicle_modes(lorry):
        energy = (mode.shape.conj() * (mass @ mode.shape)).real
        energy /= energy.sum()
        wheels = [n for n, name in enumerate(lorry.dof_names) if name.startswith("wheel")]
        assert mode.share[wheels].sum() == pytest.approx(energy[wheels].sum(), abs=0.08)
    hop = mf.vehicle_modes(lorry)[4]
    assert hop.description.startswith("wheel_2 84 %")


@pytest.mark.parametrize("ending", ["npz", "mat"])
@pytest.mark.parametrize("name", ["full_truck", "footprint", "coach", "one of two"])
def test_files_hold_a_vehicle_exactly(name, ending, tmp_path):
    vehicle = VEHICLES.get(name) or RIGID[name]
    file = tmp_path / f"vehicle.{ending}"
    mf.write_vehicle(vehicle, file)
    found = mf.read_vehicle(file)
    for first, second in zip(found.matrices, vehicle.matrices, strict=True):
        assert np.array_equal(first, second)
    assert found.contacts == tuple(vehicle.contacts)
    assert found.dof_names == vehicle.dof_names
    assert np.array_equal(found.vertical, vehicle.vertical)


def test_a_vehicle_in_a_text(tmp_path):
    file = tmp_path / "car.toml"
    file.write_text(
        "mass = [[400, 0], [0, 40]]\ndamping = [[1500, -1500], [-1500, 1500]]\n"
        "stiffness = [[2e4, -2e4], [-2e4, 2e4]]\n"
        "contact_map = [[0, 1]]\nposition = [0]\ncontact_stiffness = [inf]\n"
    )
    car = mf.read_vehicle(file)
    assert car.contacts[0].rigid
    assert car.dof_names == ("dof_1", "dof_2")
    assert car.static_loads[0] == pytest.approx(440 * 9.81)


ONE_MASS = (
    b"mass = [[1.0]]\ndamping = [[0.0]]\nstiffness = [[0.0]]\ncontact_map = [[1.0]]\nposition = [0.0]\n"
    b"contact_stiffness = [1e5]\n"
)


def test_complex_matrices_are_refused(tmp_path):
    """A loss factor would be dropped without a word."""
    car = VEHICLES["half_truck"]
    mf.write_vehicle(car, tmp_path / "car.npz")
    with np.load(tmp_path / "car.npz") as stored:
        arrays = dict(stored)
    np.savez(tmp_path / "lossy.npz", **arrays | {"stiffness": arrays["stiffness"] * (1 + 0.2j)})
    with pytest.raises(ValueError, match=r"stiffness must be a matrix of real numbers: complex ones"):
        mf.read_vehicle(tmp_path / "lossy.npz")
    np.savez(tmp_path / "objects.npz", **arrays | {"mass": np.array([{}])})
    with pytest.raises(ValueError, match=r"objects.npz: mass.npy holds neither numbers nor texts, but '\|O'"):
        mf.read_vehicle(tmp_path / "objects.npz")
    np.savez_compressed(tmp_path / "bomb.npz", **arrays | {"mass": np.zeros((6000, 6000))})
    with pytest.raises(ValueError, match=r"bomb.npz: unpacks to more than 10 times its size"):
        mf.read_vehicle(tmp_path / "bomb.npz")


@pytest.mark.parametrize(
    ("name", "content", "match"),
    [
        ("car.xls", b"", r"a vehicle is read from .mat, .npz, .toml, not from .xls"),
        ("car.npz", b"nonsense", r"is damaged, or no NumPy file: File is not a zip file"),
        ("car.mat", b"nonsense", r"is no MATLAB file of version 5 or 7.3"),
        ("car.toml", b"a = ", r"is not TOML"),
        ("car.toml", b"mass = [[1]]", r"damping is missing; stiffness is missing"),
        ("car.toml", b"mas = [[1]]", r"mas is not known; a vehicle consists of mass"),
        ("car.toml", ONE_MASS + b"dof_names = 3", r"dof_names must be a list of one or more texts, got 3"),
        ("car.toml", ONE_MASS + b'dof_names = "a"', r"dof_names must be a list of one or more texts, got 'a'"),
        ("car.toml", ONE_MASS + b"path = [inf]", r"path must be whole numbers"),
        ("car.toml", ONE_MASS + b'contact_name = ["a", "b"]', r"contact_name must be 1 texts, got 2"),
    ],
)
def test_files_that_are_refused(name, content, match, tmp_path):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(ValueError, match=match):
        mf.read_vehicle(tmp_path / name)
    with pytest.raises(ValueError, match="cannot read"):
        mf.read_vehicle(tmp_path / "missing.npz")


@pytest.mark.parametrize("ending", ["npz", "mat"])
def test_damaged_files_end_in_an_error_or_a_vehicle(ending, tmp_path):
    good = tmp_path / f"good.{ending}"
    mf.write_vehicle(VEHICLES["half_truck"], good)
    content, random = good.read_bytes(), np.random.default_rng(5)
    bad = tmp_path / f"bad.{ending}"
    refused = 0
    for _ in range(300):
        damaged = bytearray(content)
        for place in random.integers(len(damaged), size=random.integers(1, 6)):
            damaged[place] = random.integers(256)
        bad.write_bytes(damaged[: random.integers(1, len(damaged) + 1)] if random.random() < 0.3 else damaged)
        try:
            mf.read_vehicle(bad)
        except ValueError:
            refused += 1
    assert refused > 100


def test_every_entry_of_the_catalogue_can_be_driven():
    from movingfrf.vehicles.catalogue import CATALOGUE

    profile = mf.harmonic(amplitude=1e-4, wavelength=4.0, length=80.0, start=-30.0)
    for name, entry in CATALOGUE.items():
        assert entry.source
        assert entry.summary
        vehicle = mf.catalogue(name=name)
        result = mf.simulate(
            mf.RigidGuideway(), vehicle, profile, speed=10.0, duration=2.0, time_step=5e-3, blend=3.0
        )
        assert np.isfinite(result.contact_force).all()


def test_sag_of_the_road_redistributes_between_rigid_wheels():
    """Two rigid wheels and an elastic one; (1 + D G) F = F_s with D from multipliers."""
    vehicle, road = RIGID["two of three"], DAMPED["euler_bernoulli_winkler"]
    flat = mf.Profile([-10.0, 0.0, 10.0, 20.0], np.zeros(4))
    result = mf.simulate(road, vehicle, flat, speed=20.0, duration=0.1, time_step=0.01)
    mass, damping, stiffness, at, springs, dashpots = own(vehicle)
    held = constrained(mass, damping, stiffness, at, springs, dashpots, np.zeros((0, len(mass))), 0.0).real
    positions = vehicle.positions
    frf = road.moving_frf(positions[:, None] - positions, 20.0, [0.0])[0].real
    expected = np.linalg.solve(np.eye(3) + held @ frf, vehicle.static_loads)
    np.testing.assert_allclose(result.static_load, expected, rtol=1e-9)
    assert np.abs(expected / vehicle.static_loads - 1).max() > 1e-3


def test_elastic_vehicles_of_the_family_are_what_their_matrices_say():
    """METHOD.md section 4 by a plain inverse, for the vehicles that the laws do not list."""
    coach = mf.carriage(**COACH, contact_stiffness=2.4e9)
    for vehicle in (
        coach,
        mf.convoy([coach, VEHICLES["half_truck"]], gaps=5.0),
        mf.catalogue(name="passenger_car"),
    ):
        expected = np.array([dynamic_stiffness(vehicle, omega) for omega in OMEGA])
        scale = max(contact.stiffness for contact in vehicle.contacts)
        assert np.abs(of(vehicle) - expected).max() < 1e-8 * scale

"""Trucks, trains, seats and rigid contacts against equations that are written out here.

The independent route to any vehicle with constraints is its Lagrange multipliers: hinges and rigid contacts as
extra rows and columns, one dense solution per frequency, nothing eliminated.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import movingfrf as mf
from movingfrf.response.stability import along_the_axis, growing_vibrations
from movingfrf.response.system import joined
from tests.helpers import (
    DAMPED,
    HALF_TRUCK,
    QUARTER_TRUCK,
    VEHICLES,
    difference,
    dynamic_stiffness,
    three_axle_truck,
)

BOGIE = {
    "frame_mass": 2615.0,
    "frame_pitch_inertia": 1476.0,
    "wheelset_mass": 1813.0,
    "primary_stiffness": 2.4e6,
    "primary_damping": 8e3,
    "axle_spacing": 2.56,
}

OMEGA = np.r_[0.0, np.geomspace(0.5, 2000.0, 17)] - 0.3j

STEER = mf.Axle(
    position=2.0,
    mass=700.0,
    suspension_stiffness=4e5,
    suspension_damping=1e4,
    tyre_stiffness=1.75e6,
    tyre_damping=1e3,
)
DRIVE = mf.Axle(position=-1.5, mass=1100.0, suspension_stiffness=1e6, suspension_damping=2e4, tyre_stiffness=3.5e6)
TANDEM = mf.WalkingBeam(
    positions=(-7.4, -8.7),
    mass=1500.0,
    pitch_inertia=700.0,
    suspension_stiffness=1.6e6,
    suspension_damping=3e4,
    tyre_stiffness=3.5e6,
    tyre_damping=2e3,
)
TRACTOR = mf.Unit(
    mass=6000.0, pitch_inertia=2.0e4, position=0.3, axles=[STEER, DRIVE], roll_inertia=4e3, name="tractor"
)
TRAILER = mf.Unit(
    mass=20000.0, pitch_inertia=1.5e5, position=-5.0, axles=[TANDEM], roll_inertia=2e4, name="trailer"
)
HITCH = -1.2

# Manchester benchmark, PARAMETERS of the sources in the catalogue.
COACH = {
    "body_mass": 32e3,
    "body_pitch_inertia": 1.97e6,
    "bogie_mass": 2615.0,
    "bogie_pitch_inertia": 1476.0,
    "wheelset_mass": 1813.0,
    "primary_stiffness": 2.4e6,
    "primary_damping": 8e3,
    "secondary_stiffness": 8.6e5,
    "secondary_damping": 4e4,
    "bogie_spacing": 19.0,
    "axle_spacing": 2.56,
}


def constrained(mass, damping, stiffness, at, springs, dashpots, ties, omega):
    """Dynamic stiffness at the contacts, multipliers for `ties` (rows that stay zero) and for rigid contacts."""
    elastic = np.isfinite(springs)
    k = np.diag(np.where(elastic, springs, 0.0) + 1j * omega * dashpots)
    rows = np.where(elastic[:, None], at, 0.0)
    whole = -(omega**2) * mass + 1j * omega * damping + stiffness + rows.T @ k @ rows
    held = np.vstack([ties, at[~elastic]])
    count, contacts = len(held), len(at)
    system = np.block([[whole, held.T], [held, np.zeros((count, count))]])
    prescribed = np.zeros((count, contacts))
    prescribed[len(ties) :][:, ~elastic] = np.eye(int((~elastic).sum()))
    solution = np.linalg.solve(system, np.vstack([rows.T @ k, prescribed]))
    motion, multipliers = solution[: len(mass)], solution[len(mass) :]
    force = k - k @ rows @ motion
    # A multiplier pulls the vehicle up where it pushes the road down: the road pushes it by as much.
    force[~elastic] -= multipliers[len(ties) :]
    return force


def own(vehicle):
    springs, dashpots = (np.array([getattr(c, n) for c in vehicle.contacts]) for n in ("stiffness", "damping"))
    return *(np.asarray(a, float) for a in vehicle.matrices), springs, dashpots


def of(vehicle, omega=OMEGA):
    return vehicle.dynamics().stiffness(omega)


def compare(found, expected, within=1e-9):
    scale = np.abs(expected).max(axis=(1, 2), keepdims=True)
    assert (np.abs(found - expected) / scale).max() < within


# Assembly and hinges.


def test_a_truck_is_its_axles():
    """The three-axle truck of the helpers, whose matrices are summed spring by spring there."""
    axles = [
        mf.Axle(
            position=x, mass=m, suspension_stiffness=k, suspension_damping=c, tyre_stiffness=t, tyre_damping=2e3
        )
        for x, m, k, c, t in zip(
            (3.0, -1.2, -2.5),
            (600.0, 1e3, 900.0),
            (8e5, 1.5e6, 1.2e6),
            (2e4, 3e4, 2.5e4),
            (2e6, 3.4e6, 3e6),
            strict=True,
        )
    ]
    lorry = mf.truck(units=[mf.Unit(mass=20_000.0, pitch_inertia=9.0e4, position=0.0, axles=axles)])
    by_hand = three_axle_truck()
    for found, expected in zip(lorry.matrices, by_hand.matrices, strict=True):
        np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-9 * np.abs(expected).max())
    np.testing.assert_allclose(lorry.static_loads, by_hand.static_loads, rtol=1e-12)


def apart_pieces():
    """Write out tractor and trailer without their hitch: bounce and pitch each, three unsprung bodies."""
    at = {"steer": 2.0, "drive": -1.5, "beam": -8.05}
    mass = np.diag([6000.0, 2.0e4, 20000.0, 1.5e5, 700.0, 1100.0, 1500.0, 700.0])
    stretches = [
        (4e5, 1e4, [1, at["steer"] - 0.3, 0, 0, -1, 0, 0, 0]),
        (1e6, 2e4, [1, at["drive"] - 0.3, 0, 0, 0, -1, 0, 0]),
        (1.6e6, 3e4, [0, 0, 1, at["beam"] + 5.0, 0, 0, -1, 0]),
    ]
    stiffness = sum(k * np.outer(row, row) for k, _, row in stretches)
    damping = sum(c * np.outer(row, row) for _, c, row in stretches)
    contact_map = np.zeros((4, 8))
    contact_map[[0, 1], [4, 5]] = 1.0
    contact_map[2, 6:], contact_map[3, 6:] = (1.0, 0.65), (1.0, -0.65)
    hitch = np.array([[1.0, HITCH - 0.3, -1.0, -(HITCH + 5.0), 0, 0, 0, 0]])
    springs, dashpots = np.array([1.75e6, 3.5e6, 3.5e6, 3.5e6]), np.array([1e3, 0.0, 2e3, 2e3])
    return mass, damping, stiffness, contact_map, springs, dashpots, hitch


def test_a_hitch_is_a_constraint():
    semitrailer = mf.truck(units=[TRACTOR, TRAILER], hitches=[HITCH])
    assert semitrailer.dof_names == (
        "tractor_bounce",
        "tractor_pitch",
        "trailer_pitch",
        "wheel_1",
        "wheel_2",
        "beam_3_bounce",
        "beam_3_pitch",
    )
    pieces = apart_pieces()
    expected = np.array([constrained(*pieces, omega) for omega in OMEGA])
    compare(of(semitrailer), expected)


def test_static_loads_of_a_semitrailer_follow_from_levers():
    """The trailer rests on hitch and tandem, the tractor carries what the hitch takes; a beam shares evenly."""
    semitrailer = mf.truck(units=[TRACTOR, TRAILER], hitches=[HITCH])
    beam = -8.05
    on_tandem = 20000.0 * (HITCH - -5.0) / (HITCH - beam)
    on_hitch = 20000.0 - on_tandem
    on_steer = (6000.0 * (0.3 + 1.5) + on_hitch * (HITCH + 1.5)) / 3.5
    on_drive = 6000.0 + on_hitch - on_steer
    expected = 9.81 * np.array(
        [on_steer + 700, on_drive + 1100, 0.5 * (on_tandem + 1500), 0.5 * (on_tandem + 1500)]
    )
    np.testing.assert_allclose(semitrailer.static_loads, expected, rtol=1e-9)


def test_a_stiff_spring_tends_to_the_hitch():
    """As one over its stiffness."""
    *pieces, hitch = apart_pieces()
    semitrailer = mf.truck(units=[TRACTOR, TRAILER], hitches=[HITCH])
    errors = []
    for stiff in (1e10, 1e11):
        mass, damping, stiffness, at, springs, dashpots = pieces
        sprung = [
            constrained(
                mass, damping, stiffness + stiff * hitch.T @ hitch, at, springs, dashpots, np.zeros((0, 8)), w
            )
            for w in OMEGA[:12]
        ]
        errors.append(np.abs(of(semitrailer)[:12] - sprung).max())
    assert errors[0] / errors[1] == pytest.approx(10.0, rel=0.05)


def test_longer_combinations_and_two_sides():
    """Both sides rolling alike is the plane truck; a third unit hangs on the second."""
    dolly = mf.Unit(
        mass=9000.0, pitch_inertia=4e4, position=-14.0, axles=[replace(DRIVE, position=-14.5)], name="last"
    )
    plane = mf.truck(units=[TRACTOR, TRAILER, dolly], hitches=[HITCH, -10.0])
    assert [name for name in plane.dof_names if "last" in name] == ["last_pitch"]
    assert plane.static_loads.sum() == pytest.approx(
        9.81 * (6000 + 20000 + 9000 + 700 + 1100 + 1500 + 1100), rel=1e-10
    )
    wide = mf.truck(units=[TRACTOR, TRAILER], hitches=[HITCH], sides=(1.0, -1.0))
    narrow = mf.truck(units=[TRACTOR, TRAILER], hitches=[HITCH])
    # Contacts come axle by axle, left and right in turn (a beam's two axles side by side): sum what one axle meets.
    left = [n for n, contact in enumerate(wide.contacts) if contact.across > 0]
    right = [n for n, contact in enumerate(wide.contacts) if contact.across < 0]
    stiffness = of(wide)
    both = sum(stiffness[:, a][:, :, b] for a in (left, right) for b in (left, right))
    compare(both, of(narrow))
    assert {contact.path for contact in wide.contacts} == {0, 1}
    assert wide.contacts[0].name == "axle 1 left"


# Rigid contacts.


def rigid(vehicle, *numbers):
    contacts = [
        replace(contact, stiffness=np.inf, damping=0.0) if n in numbers else contact
        for n, contact in enumerate(vehicle.contacts)
    ]
    return replace(vehicle, contacts=contacts)


def plank():
    """Let both ends of a rigid plank under a sprung load follow the road: rows that share degrees of freedom."""
    return mf.Vehicle(
        mass=np.diag([1000.0, 400.0, 200.0]),
        damping=[[2e3, 0, -2e3], [0, 0, 0], [-2e3, 0, 2e3]],
        stiffness=[[1e5, 0, -1e5], [0, 0, 0], [-1e5, 0, 1e5]],
        contact_map=[[1.0, 1.2, 0.0], [1.0, -0.8, 0.0]],
        contacts=[mf.Contact(position=1.2, stiffness=np.inf), mf.Contact(position=-0.8, stiffness=np.inf)],
        vertical=[1, 0, 1],
        dof_names=["bounce", "pitch", "load"],
    )


RIGID = {
    "quarter truck": rigid(VEHICLES["quarter_truck"], 0),
    "one of two": rigid(VEHICLES["half_truck"], 1),
    "two of three": rigid(VEHICLES["three_axles"], 0, 2),
    "full truck": rigid(VEHICLES["full_truck"], 0, 1, 2, 3),
    "plank": plank(),
    "one end of the plank": replace(
        plank(), contacts=[plank().contacts[0], mf.Contact(position=-0.8, stiffness=3e5, damping=2e3)]
    ),
    "coach": mf.carriage(**COACH),
    "bogie": mf.bogie(**BOGIE),
    "wheelset": mf.wheelset(mass=1813.0),
    "train": mf.train(car=mf.carriage(**COACH), count=2, spacing=25.0),
}


@pytest.mark.parametrize("name", RIGID)
def test_rigid_contacts_are_constraints(name):
    """Dynamic stiffness, static loads and the motion itself."""
    vehicle = RIGID[name]
    mass, damping, stiffness, at, springs, dashpots = own(vehicle)
    ties = np.zeros((0, len(mass)))
    expected = np.array([constrained(mass, damping, stiffness, at, springs, dashpots, ties, w) for w in OMEGA])
    compare(of(vehicle), expected)
    random = np.random.default_rng(1)
    shape = (OMEGA.size, len(vehicle.contacts))
    displacement = random.normal(size=shape) + 1j * random.normal(size=shape)
    motion, force = vehicle.dynamics().response(OMEGA, displacement)
    forces = -np.einsum("wij,wj->wi", expected, displacement)
    assert np.abs(force - forces).max(axis=1) == pytest.approx(0.0, abs=1e-9 * np.abs(forces).max())
    followed = (motion @ at.T)[:, np.isinf(springs)]
    assert np.abs(followed - displacement[:, np.isinf(springs)]).max() < 1e-9
    # Newton's law for the whole: what the contacts push up is mass times acceleration down, with the sign turned.
    momentum = (-(OMEGA**2)[:, None] * motion) @ mass @ np.asarray(vehicle.vertical)
    assert np.abs(momentum + force.sum(axis=1)).max() < 1e-9 * np.abs(momentum).max()
    assert vehicle.static_loads.sum() == pytest.approx(9.81 * vehicle.vertical @ mass @ vehicle.vertical, rel=1e-10)


@pytest.mark.parametrize("road", ["euler_bernoulli_winkler", "rail_pad_sleeper_ballast"])
def test_a_stiff_contact_tends_to_the_rigid_one(road):
    """As one over its stiffness, in every output; content up to 40 Hz."""
    profile = mf.realise(mf.IsoRoad.of_class("A", band=(0.02, 2.0)), length=70.0)
    errors = []
    for stiffness in (1e11, 1e12):
        stiff, held = (
            mf.quarter_car(**QUARTER_TRUCK | {"tyre_stiffness": k, "tyre_damping": 0.0})
            for k in (stiffness, np.inf)
        )
        found, wanted = (mf.simulate(DAMPED[road], one, profile, speed=20.0, duration=3.0) for one in (stiff, held))
        errors.append(
            [
                difference(found[name], wanted[name])
                for name in ("contact_force", "deflection", "motion", "acceleration")
            ]
        )
    ratio = np.array(errors[0]) / errors[1]
    np.testing.assert_allclose(ratio, 10.0, rtol=0.05)
    assert max(errors[1]) < 1e-3


def test_a_moving_mass_follows_the_road():
    """It holds m z̈ = −F and z = w − r at every instant, from the result alone."""
    profile = mf.realise(mf.IsoRoad(roughness=4e-6, band=(0.02, 1.0)), length=60.0)
    result = mf.simulate(
        DAMPED["euler_bernoulli_winkler"], mf.wheelset(mass=2000.0), profile, speed=20.0, duration=2.0
    )
    moved = result.deflection - result.static_deflection - result.roughness
    assert difference(result.motion.values[:, 0], moved.values[:, 0]) < 1e-9
    assert difference(result.contact_force.values[:, 0], -2000.0 * result.acceleration.values[:, 0]) < 1e-6
    assert float(result.static_load[0]) == pytest.approx(2000 * 9.81)


@pytest.mark.parametrize("speed", [150.0, 200.0, 250.0, 350.0])
@pytest.mark.parametrize("mass", [100.0, 2e3, 2e4, 2e5])
def test_when_a_moving_mass_is_unstable(speed, mass):
    """Zeros of 1 − ω² m G(ω) below the real axis, counted along a long closed curve (Metrikine, Dieterman 1997).

    Only above the critical speed of 177.5 m/s, and there only heavy masses.
    """
    road = DAMPED["euler_bernoulli_winkler"]
    curve = np.r_[
        np.geomspace(1e-3, 3e4, 40_000) * (1 - 1e-6j), 3e4 * np.exp(-1j * np.linspace(0, np.pi / 2, 4000))
    ]
    phase = np.unwrap(np.angle(1 - curve**2 * mass * road.moving_frf(np.array(0.0), speed, curve)))
    expected = round(-(phase[-1] - phase[0]) / np.pi)
    system = joined(road, mf.wheelset(mass=mass), speed)
    assert growing_vibrations(system, system.sample(along_the_axis(system.vehicle, speed))) == expected
    assert (expected == 2) == (speed > 177.5 and mass >= {200.0: 2e5, 250.0: 2e4, 350.0: 2e3}.get(speed, np.inf))


@pytest.mark.parametrize("road", ["euler_bernoulli_winkler", "timoshenko_pasternak", "rail_pad_sleeper_ballast"])
@pytest.mark.parametrize("name", ["coach", "train", "full truck", "one of two"])
def test_what_travels_slowly_on_rigid_wheels_is_stable(name, road):
    """Far below the critical speed nothing feeds a vibration, however many wheels turn the determinant."""
    system = joined(DAMPED[road], RIGID[name], 30.0)
    assert growing_vibrations(system, system.sample(along_the_axis(system.vehicle, 30.0))) == 0


def test_a_heavy_wheel_under_next_to_nothing_is_looked_at_too():
    """Its vibration on the road is a thousand times faster than the vehicle's own slow one."""
    car = mf.quarter_car(
        body_mass=100.0,
        wheel_mass=5000.0,
        suspension_stiffness=10.0,
        suspension_damping=20.0,
        tyre_stiffness=np.inf,
    )
    road = DAMPED["euler_bernoulli_winkler"]
    counts = []
    for vehicle in (car, mf.wheelset(mass=5000.0)):
        system = joined(road, vehicle, 300.0)
        counts.append(growing_vibrations(system, system.sample(along_the_axis(vehicle, 300.0))))
    assert counts == [2, 2]


def test_many_rigid_wheels_are_counted_like_very_stiff_ones():
    """Above the critical speed, eight wheelsets: whose determinant turns by two circles more at infinity."""
    road, counts = DAMPED["euler_bernoulli_winkler"], []
    for stiffness in (np.inf, 1e12):
        train = mf.train(car=mf.carriage(**COACH, contact_stiffness=stiffness), count=2, spacing=25.0)
        system = joined(road, train, 300.0)
        counts.append(growing_vibrations(system, system.sample(along_the_axis(train, 300.0))))
    assert counts[0] == counts[1] > 0


def test_an_unstable_mass_is_refused():
    profile, road = mf.harmonic(amplitude=1e-3, wavelength=5.0, length=500.0), DAMPED["euler_bernoulli_winkler"]
    with pytest.raises(mf.SolveError, match="unstable together at 350 m/s"):
        mf.simulate(road, mf.wheelset(mass=2e4), profile, speed=350.0, duration=1.0, start=10.0)


# Railway, trains.


def test_frequencies_of_a_coach_on_rigid_rails():
    """By its symmetry: bogie pitch alone; body and bogies in bounce, and in pitch, two by two; undamped."""
    undamped = mf.carriage(**COACH | {"primary_damping": 0.0, "secondary_damping": 0.0})
    primary, secondary, half, lever = 2 * 2.4e6, 8.6e5, 1.28, 9.5

    def pair(mass, spring_body, coupling):
        matrix = np.array([[spring_body, -coupling], [-coupling, secondary + primary]])
        return np.sqrt(np.linalg.eigvals(np.diag([1 / mass, 1 / 2615.0]) @ matrix).real)

    # Half of the body over one bogie; in pitch the inertia over the squared lever acts as a mass.
    bounce = pair(16e3, secondary, secondary)
    pitch = pair(0.5 * 1.97e6 / lever**2, secondary, secondary)
    bogies = np.sqrt(primary * half**2 / 1476.0)
    expected = np.sort([*bounce, *pitch, bogies, bogies]) / (2 * np.pi)
    np.testing.assert_allclose(undamped.natural_frequencies, expected, rtol=1e-9)


def test_a_coach_stands_evenly():
    coach = mf.carriage(**COACH)
    np.testing.assert_allclose(coach.static_loads, 9.81 * (8000 + 0.5 * 2615 + 1813), rtol=1e-9)
    assert coach.dof_names[:6] == (
        "body_bounce",
        "body_pitch",
        "bogie_1_bounce",
        "bogie_1_pitch",
        "bogie_2_bounce",
        "bogie_2_pitch",
    )


def test_a_bogie_with_its_share_of_the_body_is_half_a_coach_in_bounce():
    half = mf.bogie(
        **BOGIE,
        body_mass=16e3,
        secondary_stiffness=8.6e5,
        secondary_damping=4e4,
    )
    coach = of(mf.carriage(**COACH)).reshape(OMEGA.size, 2, 2, 2, 2)
    # Both bogies moved alike: the sum over the bogies that move.
    compare(coach.sum(axis=3)[:, 0], of(half))


def test_hertz():
    """Slope dP/dδ of δ = G P^(2/3), by a difference."""
    load, step = 70e3, 1.0
    constant = 3.86e-8 * 0.46**-0.115
    approach = [constant * (load + s) ** (2 / 3) for s in (-step, step)]
    assert mf.hertzian_stiffness(load, wheel_radius=0.46) == pytest.approx(
        2 * step / (approach[1] - approach[0]), rel=1e-6
    )


def test_a_convoy_far_apart_is_each_vehicle_alone():
    """On a damped road, 200 m apart, what one does is not felt by the other."""
    road, truck, car = DAMPED["euler_bernoulli_winkler"], VEHICLES["half_truck"], VEHICLES["quarter_truck"]
    profile = mf.realise(mf.IsoRoad.of_class("A", band=(0.02, 2.0)), length=280.0, start=-220.0)
    both = mf.convoy([truck, car], spacing=200.0)
    options = {"speed": 20.0, "duration": 2.0}
    together = mf.simulate(road, both, profile, **options)
    first = mf.simulate(road, truck, profile, **options)
    second = mf.simulate(road, car, profile, start=-200.0, **options)
    # The second one alone would start on a road of its own, where the profile sets in before it.
    assert difference(together.contact_force[:, :2], first.contact_force) < 1e-6
    np.testing.assert_allclose(together.static_load, [*first.static_load, *second.static_load], rtol=1e-9)
    assert both.dof_names == tuple([f"1_{n}" for n in truck.dof_names] + [f"2_{n}" for n in car.dof_names])


def test_a_convoy_close_together_is_solved_as_one():
    """The same matrices, with a spring of next to nothing between the cars, make a vehicle of one part."""
    truck = VEHICLES["half_truck"]
    pair = mf.convoy([truck, truck], gaps=3.0)
    assert len(pair.dynamics().parts) == 2
    np.testing.assert_allclose(pair.positions, [*truck.positions, *(truck.positions - 4.27 - 3.0)])
    tie = np.zeros(8)
    tie[[0, 4]] = 1.0, -1.0
    one = replace(pair, stiffness=np.asarray(pair.stiffness) + 1e-3 * np.outer(tie, tie))
    assert len(one.dynamics().parts) == 1
    profile = mf.realise(mf.IsoRoad.of_class("A", band=(0.02, 2.0)), length=80.0, start=-20.0)
    results = [
        mf.simulate(DAMPED["euler_bernoulli_winkler"], each, profile, speed=20.0, duration=2.0, truncation=60.0)
        for each in (pair, one)
    ]
    for name in ("contact_force", "motion", "deflection"):
        assert difference(*(result[name] for result in results)) < 1e-7


# Seats.


def test_a_driver_on_a_seat():
    """Masses in a row: driver over seat over floor, each a fraction of what carries it."""
    car = VEHICLES["quarter_truck"]
    seated = mf.seated(
        car,
        mount={"body": 1.0},
        driver_mass=60.0,
        cushion_stiffness=3e4,
        cushion_damping=800.0,
        seat_mass=20.0,
        seat_stiffness=1e4,
        seat_damping=500.0,
    )
    assert seated.dof_names == ("body", "wheel", "seat", "driver")
    assert seated.static_loads[0] == pytest.approx(car.static_loads[0] + 9.81 * 80.0)
    omega = OMEGA[1:]
    motion, _ = seated.dynamics().response(omega, np.ones((omega.size, 1), complex))
    body, _, seat, driver = motion.T
    s = 1j * omega
    cushion, suspension = 3e4 + 800.0 * s, 1e4 + 500.0 * s
    driver_per_seat = cushion / (60.0 * s**2 + cushion)
    seat_per_body = suspension / (20.0 * s**2 + suspension + cushion * (1 - driver_per_seat))
    # Far above its vibrations a driver hardly moves, and a sum over modes cancels.
    np.testing.assert_allclose(driver / seat, driver_per_seat, rtol=1e-7)
    np.testing.assert_allclose(seat / body, seat_per_body, rtol=1e-7)


def test_a_seat_ahead_of_the_centre_pitches_the_truck():
    """The driver's weight on its lever: axle loads by the lever rule."""
    truck = VEHICLES["half_truck"]
    seated = mf.seated(
        truck, mount={"bounce": 1.0, "pitch": 1.5}, driver_mass=100.0, cushion_stiffness=3e4, cushion_damping=500.0
    )
    front, rear = HALF_TRUCK["axles"]
    on_front = 981.0 * (1.5 - rear) / (front - rear)
    np.testing.assert_allclose(seated.static_loads - truck.static_loads, [on_front, 981.0 - on_front], rtol=1e-9)


# Enveloping.


@pytest.mark.parametrize(("footprint", "cams"), [(0.2, 0.0), (0.0, 0.3), (0.15, 0.2)])
def test_a_contact_envelops_the_road(footprint, cams):
    """Mean over the footprint about two points, by quadrature of a wave."""
    contact = mf.Contact(position=0.0, stiffness=1e6, footprint=footprint, cams=cams)
    kappa = np.r_[0.0, 1e-6, np.geomspace(0.1, 60.0, 30)]
    x = (np.arange(4000) + 0.5) / 4000 - 0.5
    places = np.concatenate([footprint * x + 0.5 * cams, footprint * x - 0.5 * cams])
    expected = np.exp(1j * kappa[:, None] * places).mean(axis=1).real
    np.testing.assert_allclose(contact.enveloping(kappa), expected, atol=1e-6)
    assert contact.enveloping(kappa - 1e-12j)[3] == pytest.approx(expected[3], abs=1e-6)


@pytest.mark.filterwarnings("ignore:the vehicle's motion has not died away")
def test_cams_in_a_computation():
    """On a sine of twice the distance of the cams they stand on opposite slopes and see nothing of it."""
    profile = mf.harmonic(amplitude=1e-3, wavelength=0.8, length=140.0, start=-1.0)
    car = VEHICLES["quarter_car"]
    with_cams = replace(car, contacts=[replace(car.contacts[0], cams=0.4)])
    late = slice(2000, 4000)
    seen = [
        mf.simulate(mf.RigidGuideway(), one, profile, speed=10.0, duration=12.0).roughness[late].std().item()
        for one in (car, with_cams)
    ]
    assert seen[1] < 1e-4 * seen[0]


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


def seat(**changed):
    given = {"mount": {"body": 1.0}, "driver_mass": 60.0, "cushion_stiffness": 3e4, "cushion_damping": 500.0}
    return mf.seated(VEHICLES["quarter_car"], **given | changed)


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
    np.savez_compressed(tmp_path / "bomb.npz", **arrays | {"mass": np.zeros((6000, 6000))})
    with pytest.raises(ValueError, match=r"unpacks to [\d.]+ MiB, too much for a vehicle"):
        mf.read_vehicle(tmp_path / "bomb.npz")


@pytest.mark.parametrize(
    ("name", "content", "match"),
    [
        ("car.xls", b"", r"a vehicle is read from .mat, .npz, .toml, not from .xls"),
        ("car.npz", b"nonsense", r"is not a file of NumPy arrays"),
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
            mf.RigidGuideway(), vehicle, profile, speed=10.0, duration=2.0, time_step=5e-3, blend=1.0
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

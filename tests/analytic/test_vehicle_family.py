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
from movingfrf.response.system import System
from tests.analytic.vehicle_parts import (
    BOGIE,
    COACH,
    DRIVE,
    HITCH,
    OMEGA,
    RIGID,
    TRACTOR,
    TRAILER,
    constrained,
    of,
    own,
)
from tests.helpers import (
    DAMPED,
    HALF_TRUCK,
    QUARTER_TRUCK,
    VEHICLES,
    difference,
    three_axle_truck,
)


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
    motion, force = (part.T for part in vehicle.dynamics().response(OMEGA, displacement.T))
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
        found, wanted = (
            mf.simulate(DAMPED[road], one, profile, speed=20.0, duration=3.0, solved_step=2e-4)
            for one in (stiff, held)
        )
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
        DAMPED["euler_bernoulli_winkler"],
        mf.wheelset(mass=2000.0),
        profile,
        speed=20.0,
        duration=2.0,
        solved_step=1e-4,
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
    system = System(guideway=road, vehicle=mf.wheelset(mass=mass), speed=speed)
    assert growing_vibrations(system, [system.at(along_the_axis(system.vehicle, speed))]) == expected
    assert (expected == 2) == (speed > 177.5 and mass >= {200.0: 2e5, 250.0: 2e4, 350.0: 2e3}.get(speed, np.inf))


@pytest.mark.parametrize("road", ["euler_bernoulli_winkler", "timoshenko_pasternak", "rail_pad_sleeper_ballast"])
@pytest.mark.parametrize("name", ["coach", "train", "full truck", "one of two"])
def test_what_travels_slowly_on_rigid_wheels_is_stable(name, road):
    """Far below the critical speed nothing feeds a vibration, however many wheels turn the determinant."""
    system = System(guideway=DAMPED[road], vehicle=RIGID[name], speed=30.0)
    assert growing_vibrations(system, [system.at(along_the_axis(system.vehicle, 30.0))]) == 0


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
        system = System(guideway=road, vehicle=vehicle, speed=300.0)
        counts.append(growing_vibrations(system, [system.at(along_the_axis(vehicle, 300.0))]))
    assert counts == [2, 2]


def test_many_rigid_wheels_are_counted_like_very_stiff_ones():
    """Above the critical speed, eight wheelsets: whose determinant turns by two circles more at infinity."""
    road, counts = DAMPED["euler_bernoulli_winkler"], []
    for stiffness in (np.inf, 1e12):
        train = mf.train(car=mf.carriage(**COACH, contact_stiffness=stiffness), count=2, spacing=25.0)
        system = System(guideway=road, vehicle=train, speed=300.0)
        counts.append(growing_vibrations(system, [system.at(along_the_axis(train, 300.0))]))
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
    options = {"speed": 20.0, "duration": 2.0, "solved_step": 1e-4}
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
    (body, _, seat, driver), _ = seated.dynamics().response(omega, np.ones((1, omega.size), complex))
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


# What is left is rounding, which reaches up to any frequency.
@pytest.mark.filterwarnings("ignore:.*of the slope of the road")
@pytest.mark.filterwarnings("ignore:the vehicle's motion has not died away")
@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
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

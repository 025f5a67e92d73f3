"""A value may remember what it implies; from outside it is as if it did not."""

from __future__ import annotations

import copy
import gc
import pickle
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from threading import Barrier

import numpy as np
import pytest

import movingfrf as mf
import movingfrf.guideways.track as tracks
from movingfrf._basics.remembered import Remembering, remembered
from movingfrf.guideways.guideway import at_offsets
from tests.helpers import DAMPED

ASKED: list[str] = []


@dataclass(frozen=True, slots=True)
class Span(Remembering):
    """A value with a property and a method that are computed once."""

    length: float
    wait: Barrier = field(default_factory=lambda: Barrier(1), compare=False, repr=False)

    @property
    @remembered
    def half(self) -> list[float]:
        """Half of it."""
        ASKED.append("half")
        return [0.5 * self.length]

    @remembered
    def double(self) -> list[float]:
        """Twice as much, known once the others have come to ask."""
        ASKED.append("double")
        self.wait.wait()
        return [2 * self.length]


@pytest.fixture(autouse=True)
def _nobody_asked():
    ASKED.clear()


def test_properties_and_methods_are_computed_once_each():
    span = Span(6.0)
    assert (span.half, span.double(), span.half, span.double()) == ([3.0], [12.0], [3.0], [12.0])
    assert ASKED == ["half", "double"]
    assert Span.double.__doc__ == "Twice as much, known once the others have come to ask."


def test_nobody_sees_that_it_is_remembered():
    track = replace(DAMPED["euler_bernoulli_winkler"])
    plain = (repr(track), hash(track), pickle.dumps(track))
    assert track.critical_speed == pytest.approx(177.525, rel=1e-4)
    assert (repr(track), hash(track), pickle.dumps(track)) == plain
    assert track == replace(track)
    assert not hasattr(track, "__dict__")


@pytest.mark.parametrize(
    "copied", [replace, copy.copy, copy.deepcopy, lambda value: pickle.loads(pickle.dumps(value))]
)
def test_a_copy_computes_afresh(copied, monkeypatch):
    track = replace(DAMPED["euler_bernoulli_winkler"])
    speed = track.critical_speed
    twin = copied(track)
    assert twin == track
    monkeypatch.setattr(tracks, "least_phase_velocity", lambda _: pytest.fail("asked"))
    assert track.critical_speed == speed
    with pytest.raises(pytest.fail.Exception, match="asked"):
        _ = twin.critical_speed


def test_another_value_has_another_memory():
    track = DAMPED["euler_bernoulli_winkler"]
    stiffer = replace(track, foundation=replace(track.foundation, stiffness=16 * track.foundation.stiffness))
    assert stiffer.critical_speed == pytest.approx(2 * track.critical_speed)


def test_threads_may_ask_at_once():
    count = 4
    span = Span(6.0, Barrier(count, timeout=10.0))
    with ThreadPoolExecutor(count) as pool:
        found = [one.result() for one in [pool.submit(span.double) for _ in range(count)]]
    assert found == count * [[12.0]]
    asked = len(ASKED)
    assert span.double() == [12.0]
    assert len(ASKED) == asked == count


def test_what_fails_is_not_remembered():
    @dataclass(frozen=True, slots=True)
    class Fickle(Remembering):
        tries: list[int]

        @remembered
        def answer(self) -> int:
            self.tries.append(0)
            if len(self.tries) < 2:
                raise ValueError("not yet")
            return 42

    fickle = Fickle([])
    with pytest.raises(ValueError, match="not yet"):
        fickle.answer()
    assert fickle.answer() == fickle.answer() == 42
    assert len(fickle.tries) == 2


def test_a_vehicle_knows_the_road_that_it_was_on_and_no_other():
    """What is known of both is what would be computed: other roads, speeds and steps in between change nothing."""
    soft, firm = (
        mf.track(mf.EulerBernoulliBeam(1.573e7, 711.9), mf.Spring(stiffness, 3.0e4)) for stiffness in (2.0e6, 8.0e6)
    )
    surface = mf.realise(mf.IsoRoad.of_class("A", band=(0.02, 2.0)), length=60.0, start=-10.0)

    def car():
        return mf.quarter_car(
            body_mass=400.0, wheel_mass=40.0, suspension_stiffness=2e4, suspension_damping=1.5e3, tyre_stiffness=2e5
        )

    asked = [(soft, 10.0, 1.0), (soft, 10.0, 2.0), (firm, 10.0, 1.0), (firm, 12.0, 1.0), (soft, 10.0, 1.0)]
    one = car()
    for road, speed, duration in asked:
        found, wanted = (
            mf.simulate(road, vehicle, surface, speed=speed, duration=duration) for vehicle in (one, car())
        )
        assert found.identical(wanted)


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_what_is_remembered_changes_no_digit():
    """Of one journey after another, each unlike the one before in something: as of values that remember nothing."""
    tracks = [
        mf.track(mf.EulerBernoulliBeam(1.573e7, 711.9), mf.Spring(stiffness, 3.0e4)) for stiffness in (4.0e6, 8.0e6)
    ]
    roads = [
        mf.realise(mf.IsoRoad.of_class(letter, band=(0.02, 2.0)), length=70.0, start=-12.0, seed=seed)
        for letter, seed in (("A", 0), ("A", 1), ("E", 0))
    ]
    cars = [
        mf.quarter_car(
            body_mass=400.0,
            wheel_mass=40.0,
            suspension_stiffness=2e4,
            suspension_damping=1.5e3,
            tyre_stiffness=2e5,
            footprint=footprint,
        )
        for footprint in (0.0, 0.2)
    ]
    settings = {
        "speed": [10.0, 12.0],
        "duration": [1.0, 2.0],
        "start": [0.0, 1.0],
        "time_step": [1e-3, 2e-3, 0.05],
        "truncation": [None, 0.0, 30.0, 70.0],
        "blend": [5.0, 0.0],
        "solved_step": [None, 5e-3],
    }
    random = np.random.default_rng(0)
    track, road, car = tracks[0], roads[0], cars[0]
    journey = {name: values[0] for name, values in settings.items()}
    for turn in range(60):
        # Something else, or nothing at all.
        match what := random.choice([*settings, "track", "road", "car", "nothing"]):
            case "track":
                track = tracks[random.integers(2)]
            case "road":
                road = roads[random.integers(3)]
            case "car":
                car = cars[random.integers(2)]
            case "nothing":
                pass
            case _:
                journey[what] = settings[what][random.integers(len(settings[what]))]
        found = mf.simulate(track, car, road, **journey)
        wanted = mf.simulate(copy.copy(track), copy.copy(car), copy.copy(road), **journey)
        assert found.identical(wanted), (turn, what, journey)


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_the_next_vehicle_takes_moving_frfs_and_what_was_seen_where_they_are_the_same():
    """Vehicles that vibrate alike, so that frequencies are the same, with wheels elsewhere, or at another speed."""
    track = mf.track(mf.EulerBernoulliBeam(1.573e7, 711.9), mf.Spring(8.0e6, 3.0e4))
    surface = mf.realise(mf.IsoRoad.of_class("A", band=(0.02, 2.0)), length=90.0, start=-30.0)

    def cars(apart, mass=400.0):
        car = mf.quarter_car(
            body_mass=mass, wheel_mass=40.0, suspension_stiffness=2e4, suspension_damping=1.5e3, tyre_stiffness=2e5
        )
        return mf.convoy([car, car], spacing=apart)

    journeys = [(5.0, 10.0, 400.0), (5.0, 10.0, 400.1), (6.0, 10.0, 400.0), (6.0, 12.0, 400.0), (5.0, 12.0, 400.1)]
    for apart, speed, mass in journeys:
        asked = {"speed": speed, "duration": 2.0, "solved_step": 5e-3, "blend": 0.0}
        found = mf.simulate(track, cars(apart, mass), surface, **asked)
        wanted = mf.simulate(copy.copy(track), cars(apart, mass), copy.copy(surface), **asked)
        assert found.identical(wanted), (apart, speed, mass)


def test_results_do_not_share_what_may_be_changed():
    track, car = DAMPED["euler_bernoulli_winkler"], mf.sprung_mass(mass=400.0, stiffness=2e5, damping=1e3)
    surface = mf.harmonic(amplitude=1e-3, wavelength=3.0, length=60.0, start=-20.0)
    results = [mf.simulate(track, car, surface, speed=10.0, duration=0.5) for _ in range(4)]
    wanted = results[0].copy(deep=True)
    for result in results[:3]:
        for name in result.data_vars:
            result[name].values[...] = 0.0
            result[name].attrs["units"] = "none"
        result.attrs["speed"] = 0.0
        for name in result.coords:
            result[name].attrs["units"] = "none"
    assert results[3].identical(wanted)
    assert mf.simulate(track, car, surface, speed=10.0, duration=0.5).identical(wanted)


def test_what_remembers_a_journey_is_let_go():
    """What vehicle and profile remember does not lead back to them: nobody has to look for circles."""
    flat = mf.Profile([-10.0, 0.0, 10.0, 40.0], [0.0] * 4)

    def there():
        kinds = [type(one) for one in gc.get_objects()]
        return kinds.count(mf.Vehicle), kinds.count(mf.Profile)

    gc.collect()
    gc.disable()
    try:
        before = there()
        for _ in range(3):
            car, road = mf.sprung_mass(mass=400.0, stiffness=2e5, damping=1e3), replace(flat)
            for _ in range(3):
                mf.simulate(DAMPED["euler_bernoulli_winkler"], car, road, speed=10.0, duration=0.5)
        del car, road
        assert there() == before
    finally:
        gc.enable()


def test_a_road_that_may_change_is_asked_anew():
    class Springs:
        critical_speed, stiffness = float("inf"), 8.0e6

        def moving_frf(self, ahead, speed, omega, *, across=0.0, source_across=0.0, derivative=0):
            def springs(asked):
                return (asked.ahead == 0) / (self.stiffness + 3.0e4j * asked.omega)

            return at_offsets(springs, ahead, speed, omega)

    road, wheel = Springs(), mf.sprung_mass(mass=400.0, stiffness=2e5, damping=1e3)
    flat = mf.Profile([-10.0, 0.0, 10.0, 40.0], [0.0] * 4)
    sags = []
    for road.stiffness in (8.0e6, 4.0e6):
        sags.append(float(mf.simulate(road, wheel, flat, speed=10.0, duration=0.5).static_deflection[0]))
    assert sags[1] == pytest.approx(2 * sags[0], rel=1e-12)

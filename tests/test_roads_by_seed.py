"""Realised roads with a length and an origin of their own: the same road whatever travels over it, made once."""

from __future__ import annotations

import math
import tracemalloc
import warnings

import numpy as np
import pytest

import movingfrf as mf
from movingfrf._basics.toml_file import tables_of
from movingfrf.scenarios import roads, variants
from movingfrf.scenarios.reading import parse_scenario
from movingfrf.scenarios.variants import Variants
from movingfrf.studies.sweep.plan import plan_of
from tests.sweep_parts import TEXT
from tests.test_roads import CAR, END, LENGTH, SPECTRUM_KINDS, START, assert_same, faults, road

LAPLACE = 'kind = "laplace_road"\nkurtosis = 6.0\nsegment = 5.0\nspectrum = {kind = "iso_road", road_class = "D"}'
KINDS = {kind: f'kind = "{kind}"\n{keys}' for kind, (keys, _) in SPECTRUM_KINDS.items()} | {"laplace_road": LAPLACE}
# Where the roads of these tests lie, beside what the journeys need.
LIES = "length = 80.0\norigin = -9.5"


def case(roughness, run="speed = 10.0\nduration = 2.0"):
    return parse_scenario(f"{CAR.split('[run]')[0]}[run]\n{run}\n[roughness]\n{roughness}").case


@pytest.mark.parametrize("kind", KINDS)
def test_the_same_road_at_every_speed_duration_and_start(kind):
    text = f"{KINDS[kind]}\nseed = 3\n{LIES}"
    step = "\nstep = 0.0014" if kind == "iso3095_limit" else "\nstep = 0.05"
    first, *others = [
        case(text + step, run).road.profile
        for run in (
            "speed = 10.0\nduration = 2.0",
            "speed = 25.0\nduration = 2.0",
            "speed_kmh = 36.0\nduration = 5.5",
            "speed = 10.0\nduration = 2.0\nstart = 17.3",
        )
    ]
    assert first.stations[0] == -9.5
    assert first.stations[-1] == pytest.approx(70.5, abs=0.05)
    for other in others:
        np.testing.assert_array_equal(other.stations, first.stations)
        np.testing.assert_array_equal(other.columns, first.columns)
    without = case(KINDS[kind] + "\nseed = 3" + step).road.profile
    assert not np.allclose(without.along(0)(first.stations[200:300]), first.columns[200:300, 0])


@pytest.mark.parametrize("more", ["", "across = [0.7, -0.75]", "seed = [4, 5]"])
def test_it_is_that_of_python(more):
    made = road(f'kind = "iso_road"\nroad_class = "C"\nstep = 0.05\n{LIES}\n{more}')
    keywords = {"across": {"across": [0.7, -0.75]}, "seed": {"seed": [4, 5]}}.get(more.split(" ")[0], {})
    spectrum = mf.IsoRoad.of_class("C")
    assert_same(made.profile, mf.realise(spectrum, 80.0, start=-9.5, step=0.05, **keywords))
    assert repr(made.spectrum) == repr(spectrum)
    assert made.profile.across == ((0.7, -0.75) if "across" in more else None)


def test_by_default_it_begins_where_the_hindmost_contact_starts():
    """With the length of the journey it is the road of the journey, up to its end."""
    kind = 'kind = "iso_road"\nroad_class = "B"\nstep = 0.05\n'
    of_journey, own = (road(f"{kind}{more}").profile for more in ("", f"length = {LENGTH}"))
    count = len(own.stations)
    assert own.stations[0] == START
    assert START + LENGTH <= own.stations[-1] < START + LENGTH + 0.05 < END
    # Transforms of other sizes: to the rounding of one.
    np.testing.assert_allclose(own.columns, of_journey.columns[:count], rtol=0, atol=1e-12 * own.columns.std())
    # Faster it is the same; another start takes it along.
    slow, fast, later = (
        case(f"{kind}length = 90.0", run).road.profile
        for run in (
            "speed = 10.0\nduration = 2.0",
            "speed = 40.0\nduration = 2.0",
            "speed = 10.0\nduration = 2.0\nstart = 7.0",
        )
    )
    assert slow == fast
    np.testing.assert_array_equal(later.columns, slow.columns)
    np.testing.assert_allclose(later.stations, slow.stations + 7.0)


def test_the_results_of_two_starts_meet():
    """Where a vehicle has forgotten how it set out, its force belongs to the place on the road."""
    text = f'kind = "iso_road"\nroad_class = "A"\nseed = [0, 1]\n{LIES.replace("80", "120")}'
    early, late = (
        parse_scenario(f"{CAR.split('[run]')[0]}[run]\n{run}\n[roughness]\n{text}").run().contact_force.values
        for run in ("speed = 10.0\nduration = 10.0", "speed = 10.0\nduration = 9.0\nstart = 10.0")
    )
    same = early[1000:] - late
    assert np.sqrt((same[-3000:] ** 2).mean()) < 5e-4 * np.sqrt((late[-3000:] ** 2).mean())


@pytest.mark.parametrize(
    ("said", "name", "words"),
    [
        (
            "length = 15.0",
            "",
            "must cover the journey from -1.47 m to 21.4 m, but it reaches from -1.47 m to 13.53 m",
        ),
        (
            "length = 90.0\norigin = 2.0",
            "",
            "from -1.47 m to 21.4 m, but it reaches from 2 m to 92 m: `start` greater by 3.47",
        ),
        ("origin = 2.0", "origin", "is of use only with `length`"),
        ("length = 0.0", "length", "must be positive, got 0.0 m"),
        ('length = 90.0\norigin = "x"', "origin", "must be a finite number [m], got 'x'"),
    ],
)
def test_what_is_refused(said, name, words):
    found = faults(f'kind = "iso_road"\nroad_class = "B"\nstep = 0.05\n{said}')
    (where,) = found
    assert where == (f"roughness.{name}" if name else "roughness:")
    assert words in found[where]
    assert "\n" not in found[where]


def test_both_are_refused_at_once():
    assert set(faults(f'{LAPLACE}\nlength = "x"\norigin = inf')) == {"roughness.length", "roughness.origin"}


def tables(**roughness):
    found = tables_of(TEXT)
    return {**found, "roughness": {**found["roughness"], **roughness}}


@pytest.fixture
def made(monkeypatch):
    """Seeds of the roads that are realised, in order."""
    seeds = []
    realise = roads.realise

    def counting(spectrum, *, seed, **others):
        seeds.append(seed)
        return realise(spectrum, seed=seed, **others)

    monkeypatch.setattr(roads, "realise", counting)
    return seeds


SPEEDS = {"run.speed": [8.0, 9.0, 10.0, 11.0, 12.0, 13.0]}
OWN = {"length": 60.0, "origin": -10.0}


@pytest.mark.parametrize("own", [OWN, {"length": 60.0}])
def test_a_road_is_made_once_in_a_sweep_over_speed(made, own):
    plain = mf.sweep(tables(**own), SPEEDS, measures="contact_force_rms")
    assert made == [0]
    made.clear()
    for axes in (SPEEDS | {"roughness.seed": range(6)}, {"roughness.seed": range(6)} | SPEEDS):
        both = mf.sweep(tables(**own), axes, measures="contact_force_rms").sel(seed=0)
        assert (both.status == "").all()
        np.testing.assert_array_equal(both.contact_force_rms, plain.contact_force_rms)
        assert made == [*range(6)]
        made.clear()


def test_roads_that_follow_their_journeys_are_made_for_each(made):
    with pytest.warns(mf.ValidityWarning, match=r"follows its journey.*another speed"):
        mf.sweep(tables(), SPEEDS, measures="contact_force_rms")
    assert len(made) == 6


def parts(*roads):
    return {**tables_of(TEXT), "roughness": {"kind": "superposed", "parts": list(roads)}}


ROUGH = tables_of(TEXT)["roughness"]
BUMP = {"kind": "bump", "height": 0.01, "width": 1.0, "at": 4.0}


def test_parts_of_a_road_are_made_once(made):
    scenario = parts(ROUGH | OWN, BUMP, ROUGH | OWN | {"seed": 1})
    found = mf.sweep(scenario, SPEEDS, measures="contact_force_rms")
    assert (found.status == "").all()
    assert made == [0, 1]
    alone = mf.sweep(scenario, {"run.speed": [11.0]}, measures="contact_force_rms")
    np.testing.assert_array_equal(found.contact_force_rms[3], alone.contact_force_rms[0])


STARTS, VEHICLES = {"run.start": [0.0, 1.0]}, {"vehicle": ["half_truck", "golden_car"]}
# Of each sweep: the scenario, the axes, and the name of the axis along which roads are others.
SWEEPS = {
    "speed": (tables(), SPEEDS, "speed"),
    "duration": (tables(), {"run.duration": [1.0, 1.1]}, "duration"),
    "start": (tables(), STARTS, "start"),
    "vehicles": (tables(), VEHICLES, "vehicle"),
    "axles": (tables(), {"vehicle.axles.1": [-2.0, -3.0]}, "axles"),
    "the last of many": (tables(), {"run.speed": [10.0] * 20 + [11.0]}, "speed"),
    "linked": (tables(), {("roughness.road_class", "run.speed"): [("A", 9.0), ("A", 8.0)]}, "speed"),
    "a part": (parts(BUMP, ROUGH), SPEEDS, "speed"),
    "one of several": (tables(), SPEEDS | {"roughness": [BUMP, ROUGH]}, "speed"),
    "length alone, start": (tables(length=60.0), STARTS, "start"),
    "length alone, speed": (tables(length=60.0), SPEEDS, ""),
    "length and origin": (tables(**OWN), SPEEDS | STARTS | VEHICLES, ""),
    "parts with their own": (parts(BUMP, ROUGH | OWN), SPEEDS, ""),
    "stiffness": (tables(), {"vehicle.tyre_stiffness.0": [3e6, 4e6], "run.time_step": [1e-3, 2e-3]}, ""),
    "seed": (tables(), {"roughness.seed": [0, 1]}, ""),
    "length that varies": (tables(**OWN), SPEEDS | {"roughness.length": [60.0, 70.0]}, ""),
    "a shape with a seed": (
        {
            **tables_of(TEXT),
            "roughness": {"kind": "polygon", "radius": 0.5, "orders": [3], "amplitudes": [1e-5], "seed": 2},
        },
        SPEEDS,
        "",
    ),
}


@pytest.mark.parametrize("name", SWEEPS)
def test_a_sweep_says_where_roads_are_others_and_what_to_do(name):
    """And says it of no other: the profiles at both ends of each axis are the evidence."""
    scenario, axes, along = SWEEPS[name]
    plan = plan_of(scenario, axes)
    said = plan.findings
    assert [one.code for one in said] == (["other_roads"] if along else [])
    assert all(f"for another {along} it is" in one.message for one in said)
    assert all("unless `length` and `origin` [m] in [roughness] say" in one.message for one in said)
    assert plan_of(scenario, axes, response="random").findings == []
    if len(axes) == 1 and along:
        size = math.prod(plan.axes.shape)
        first, last = (plan.variants.at(plan.axes.values([place])).case.road.profile for place in (0, size - 1))
        assert first != last


def test_memory_is_bounded_however_many_values():
    """Roads by seed, whole tables by name, vehicles: of each kind the latest few stay."""
    variants_ = Variants(tables(step=0.08, length=5000.0, origin=-10.0), variants.Path(), "many")

    def held(seeds):
        tracemalloc.start()
        for seed in seeds:
            variants_.at({"roughness.seed": seed, "vehicle.tyre_stiffness.0": 3e6 + seed})
        size, _ = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        return size

    held(range(70))
    # A road takes a megabyte, a name or a vehicle less.
    assert held(range(70, 100)) < 8e6


def test_other_vehicles_by_name_are_forgotten(tmp_path):
    names = []
    for number in range(100):
        (tmp_path / f"v{number}.toml").write_text(TEXT)
        names.append(f"v{number}.toml")
    kept = Variants(tables(**OWN), tmp_path, "many")
    for name in names:
        kept.at({"vehicle": name})
    assert all(len(made) <= 64 for made in kept._known._made.values())
    assert len(kept._known._made["roughness"]) == 1
    assert not [name for name in vars(kept) if name not in ("tables", "folder", "name", "_known")]


def test_roads_of_their_own_without_a_word():
    with warnings.catch_warnings():
        warnings.simplefilter("error", mf.ValidityWarning)
        table = mf.sweep(tables(**OWN), SPEEDS, measures="static_load")
    assert "other_roads" not in str(table.attrs["findings"])

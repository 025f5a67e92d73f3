"""In the hand of a user: equal values, short representations, obvious arguments, refusals that say what to do."""

from __future__ import annotations

import copy
import dataclasses
import inspect
import json
import pickle

import jsonschema
import numpy as np
import pytest
import xarray as xr

import movingfrf as mf
from movingfrf._basics.checks import shown
from movingfrf._basics.values import Value, content
from movingfrf.roughness.road import Road
from movingfrf.scenarios.reading import parse_scenario
from movingfrf.scenarios.scenario import ScenarioError
from movingfrf.scenarios.schema import scenario_schema
from movingfrf.scenarios.template import template
from tests.faults.fault import ROOT

TRACK = mf.track(mf.EulerBernoulliBeam(1.573e7, 711.9), mf.Spring(8.0e6, 3.0e4))
TRUCK = mf.catalogue("half_truck")
CAR = mf.catalogue("golden_car")
ISO = mf.IsoRoad.of_class("A", band=(0.02, 2.0))
STATIONS = np.arange(0.0, 200.0, 0.25)


def wavy(phase: float = 0.0) -> mf.Profile:
    return mf.Profile(STATIONS, 1e-3 * np.sin(STATIONS + phase), "a wave")


def scenario(text: str) -> mf.Scenario:
    return parse_scenario(text, name="truck")


def recorded(first: float = 1.0) -> mf.SampledGuideway:
    ringing = 1e-6 * np.exp(-0.01 * np.arange(2000.0))[:, None]
    ringing[0] *= first
    return mf.SampledGuideway(response=ringing, time_step=1e-3, offsets=[0.0], speed=20.0)


def cut(last: float) -> mf.FiniteGuideway:
    return mf.finite_track(TRACK, first=0.0, last=last, element=0.5, ends="pinned")


SCENARIO, LOADS = template("scenario"), template("loads")
# Everything public that holds arrays, and what holds it: made twice alike and once otherwise.
HOLDERS = {
    "Vehicle": (lambda: mf.catalogue("half_truck"), lambda: mf.on_paths(TRUCK, [0, 1])),
    "a train": (lambda: mf.train(CAR, 3, spacing=10.0), lambda: mf.train(CAR, 3, spacing=11.0)),
    "Profile": (wavy, lambda: wavy(0.1)),
    "Scenario": (lambda: scenario(SCENARIO), lambda: scenario(SCENARIO.replace("speed = 10.0", "speed = 11.0"))),
    "loads": (lambda: scenario(LOADS), lambda: scenario(LOADS.replace("ramp = 0.2", "ramp = 0.3"))),
    "a case": (lambda: scenario(LOADS).case, lambda: scenario(SCENARIO).case),
    "SampledGuideway": (recorded, lambda: recorded(1.001)),
    "FiniteGuideway": (lambda: cut(10.0), lambda: cut(12.0)),
    "a plate": (
        lambda: mf.finite_plate(TRACK, width=3.0, first=-5.0, last=5.0, across=3, ends="pinned"),
        lambda: mf.finite_plate(TRACK, width=3.0, first=-5.0, last=5.0, across=4, ends="pinned"),
    ),
    "Track": (lambda: mf.track(TRACK.beam, TRACK.foundation), lambda: mf.track(TRACK.beam, mf.Spring(8.1e6))),
    "TabulatedSpectrum": (
        lambda: mf.TabulatedSpectrum([0.1, 1.0], [1e-5, 1e-7]),
        lambda: mf.TabulatedSpectrum([0.1, 1.0], [1e-5, 1e-8]),
    ),
    "ThirdOctaveSpectrum": (mf.iso3095_limit, lambda: mf.ThirdOctaveSpectrum([0.02, 0.016], [0.0, 1.0])),
    "IsoRoad": (lambda: mf.IsoRoad(16e-6), lambda: mf.IsoRoad(17e-6)),
    "Contact": (lambda: TRUCK.contacts[0], lambda: TRUCK.contacts[1]),
    "Mode": (lambda: mf.vehicle_modes(CAR)[0], lambda: mf.vehicle_modes(CAR)[1]),
    "Road": (lambda: Road(wavy(), "a wave"), lambda: Road(wavy(0.1), "a wave")),
    "ProfileDescription": (lambda: mf.describe_profile(wavy()), lambda: mf.describe_profile(wavy(0.1))),
}


@pytest.mark.parametrize("name", HOLDERS)
def test_values_are_equal_by_what_they_hold(name):
    make, other = HOLDERS[name]
    one = make()
    assert one == make()
    assert hash(one) == hash(make())
    assert one != other()
    assert one != "something else"
    assert {one: "kept"}[make()] == "kept"
    for again in (pickle.loads(pickle.dumps(one)), copy.copy(one), copy.deepcopy(one)):
        assert again == one
        assert hash(again) == hash(one)


def test_no_public_class_with_arrays_compares_them_otherwise():
    """A dataclass that may hold an array leaves comparison to `Value`: its own would ask an array for its truth."""
    for name in mf.__all__:
        made = getattr(mf, name)
        if dataclasses.is_dataclass(made) and any("Array" in str(field.type) for field in dataclasses.fields(made)):
            assert made.__eq__ is Value.__eq__, name
            assert made.__hash__ is Value.__hash__, name


def test_zero_and_nan():
    """−0 is 0, as numbers are; nan is nan, so that a copy equals what it was made from; shapes count."""
    negative = mf.Profile(STATIONS, -0.0 * STATIONS)
    assert negative == mf.Profile(STATIONS, 0.0 * STATIONS)
    assert hash(negative) == hash(mf.Profile(STATIONS, 0.0 * STATIONS))
    assert mf.Profile(STATIONS, STATIONS) != mf.Profile(STATIONS, STATIONS[:, None])
    flat = mf.Profile(STATIONS, 0 * STATIONS)  # described without a fit, by nan
    assert mf.describe_profile(flat) == mf.describe_profile(flat)
    assert content(float("nan")) == content(np.float64("nan"))
    several = [np.array([1.0, sign * np.nan]) for sign in (1.0, -1.0)]
    assert content(several[0]) == content(several[1])
    assert content(np.array([1, 2])) == content(np.array([1.0, 2.0]))
    assert content(np.array([1.0, 2.0])) != content(np.array([2.0, 1.0]))


@pytest.mark.parametrize("name", HOLDERS)
def test_a_representation_is_a_few_lines(name):
    value = HOLDERS[name][0]()
    lines = repr(value).splitlines()
    assert len(lines) <= 10
    assert max(map(len, lines)) < 400
    if hasattr(value, "_repr_html_"):
        page = value._repr_html_()
        assert page.count("<tr>") <= 10
        assert page.startswith("<table>")


def test_representations_say_what_it_is():
    assert "bounce, pitch, front_wheel, rear_wheel" in repr(TRUCK)
    assert "198.5 kN" in repr(TRUCK)
    assert "32 in all" in repr(mf.train(mf.catalogue("velaro_coach"), 8, spacing=24.8))
    assert "800 from 0 m to 199.75 m, 0.25 m apart" in repr(wavy())
    assert "10 m/s (36 km/h)" in repr(scenario(SCENARIO))
    named = mf.Profile(STATIONS, 0 * STATIONS, "<script>alert('&')</script>")
    assert "&lt;script&gt;" in named._repr_html_()
    assert "<script>" not in named._repr_html_()
    assert "15730000.0" in TRACK._repr_html_()


# What may be given without its keyword, and the same with keywords.
POSITIONAL = {
    "catalogue": (lambda: mf.catalogue("half_truck"), lambda: mf.catalogue(name="half_truck")),
    "train": (lambda: mf.train(CAR, 8, spacing=5.0), lambda: mf.train(car=CAR, count=8, spacing=5.0)),
    "Spring": (lambda: mf.Spring(8e6, 3e4), lambda: mf.Spring(stiffness=8e6, damping=3e4)),
    "ShearLayer": (
        lambda: mf.ShearLayer(8e6, 3e4, shear_stiffness=1e6),
        lambda: mf.ShearLayer(stiffness=8e6, damping=3e4, shear_stiffness=1e6),
    ),
    "OnMass": (
        lambda: mf.OnMass(mf.Spring(6e8), 500.0, mf.Spring(2e8)),
        lambda: mf.OnMass(above=mf.Spring(6e8), mass=500.0, below=mf.Spring(2e8)),
    ),
    "RelaxingSpring": (
        lambda: mf.RelaxingSpring(1e6, relaxing_stiffness=2e6, damping=1e4),
        lambda: mf.RelaxingSpring(stiffness=1e6, relaxing_stiffness=2e6, damping=1e4),
    ),
    "EulerBernoulliBeam": (
        lambda: mf.EulerBernoulliBeam(1.5e7, 700.0),
        lambda: mf.EulerBernoulliBeam(bending_stiffness=1.5e7, mass=700.0),
    ),
    "TensionedBeam": (
        lambda: mf.TensionedBeam(TRACK.beam, 1e4),
        lambda: mf.TensionedBeam(beam=TRACK.beam, force=1e4),
    ),
    "IsoRoad": (lambda: mf.IsoRoad(16e-6), lambda: mf.IsoRoad(roughness=16e-6)),
    "GermanTrack": (lambda: mf.GermanTrack(4e-7), lambda: mf.GermanTrack(roughness=4e-7)),
    "ExponentialCoherence": (
        lambda: mf.ExponentialCoherence(2.0),
        lambda: mf.ExponentialCoherence(decay=2.0),
    ),
    "realise": (lambda: mf.realise(ISO, 50.0), lambda: mf.realise(ISO, length=50.0)),
    "resampled": (lambda: mf.resampled(wavy(), 0.5), lambda: mf.resampled(wavy(), step=0.5)),
    "cropped": (lambda: mf.cropped(wavy(), 10.0, 20.0), lambda: mf.cropped(wavy(), first=10.0, last=20.0)),
    "high_passed": (lambda: mf.high_passed(wavy(), 50.0), lambda: mf.high_passed(wavy(), wavelength=50.0)),
    "selected": (lambda: mf.selected(wavy(), [0]), lambda: mf.selected(wavy(), paths=[0])),
    "rolled": (lambda: mf.rolled(wavy(), 0.5), lambda: mf.rolled(wavy(), radius=0.5)),
    "wheelset": (lambda: mf.wheelset(1800.0), lambda: mf.wheelset(mass=1800.0)),
    "sprung_mass": (lambda: mf.sprung_mass(5e3, 1.6e6), lambda: mf.sprung_mass(mass=5e3, stiffness=1.6e6)),
}


@pytest.mark.parametrize("name", POSITIONAL)
def test_the_obvious_needs_no_keyword(name):
    plain, spelt = POSITIONAL[name]
    assert plain() == spelt()


def test_lengths_that_could_be_swapped_need_their_keywords():
    for name in ("harmonic", "bump", "pothole", "wheel_flat", "Contact", "Axle"):
        kinds = {one.kind for one in inspect.signature(getattr(mf, name)).parameters.values()}
        assert kinds == {inspect.Parameter.KEYWORD_ONLY}, name


TRAVEL = {"speed": 10.0, "duration": 1.0}
RESULT = mf.simulate(TRACK, TRUCK, wavy(), **TRAVEL, start=20.0)
RANDOM = mf.random_response(TRACK, CAR, mf.IsoRoad.of_class("A"), speed=10.0)
FILE = ROOT / "road.csv"

# What stands where something else belongs, and what is said.
MISTAKEN = {
    "a spectrum for a profile": (lambda: mf.simulate(TRACK, TRUCK, ISO, **TRAVEL), r"realise\(spectrum, length\)"),
    "a class for a spectrum": (lambda: mf.realise(mf.IsoRoad, 10.0), "the class IsoRoad itself: brackets"),
    "a bare array": (lambda: mf.simulate(TRACK, TRUCK, np.zeros(9), **TRAVEL), r"Profile\(distance, elevation\)"),
    "a list of numbers": (lambda: mf.iri([0.0, 1.0]), r"a list of float; `Profile\(distance, elevation\)"),
    "a file for a profile": (lambda: mf.iri("road.csv"), r"'road.csv'; `read_profile\(file\).profile`"),
    "a path for a profile": (lambda: mf.describe_profile(FILE), r"read_profile\(file\).profile"),
    "what read_profile gave": (lambda: mf.detrended(Road(wavy(), "")), "got a Road; its `.profile` is one"),
    "profiles": (lambda: mf.simulate(TRACK, TRUCK, [wavy(), wavy()], **TRAVEL), "a list of Profile; `side_by"),
    "road and vehicle swapped": (lambda: mf.simulate(TRUCK, TRACK, wavy(), **TRAVEL), "order is guideway, vehicle"),
    "vehicle and profile swapped": (lambda: mf.simulate(TRACK, wavy(), TRUCK, **TRAVEL), "order is guideway"),
    "the same through time": (lambda: mf.cdfm(TRUCK, cut(10.0), wavy(), **TRAVEL), "got a Vehicle; the order is"),
    "a track to step on": (lambda: mf.sim(TRACK, TRUCK, wavy(), **TRAVEL), "finite_track"),
    "a beam for a track": (lambda: mf.simulate(TRACK.beam, TRUCK, wavy(), **TRAVEL), r"track\(beam, foundation\)"),
    "a vehicle for a foundation": (lambda: mf.track(TRACK.beam, TRUCK), "must be a foundation, got a Vehicle$"),
    "a name for a vehicle": (lambda: mf.transfer(TRACK, "half_truck", speed=1.0, frequency=[1.0]), "catalogue"),
    "vehicles": (lambda: mf.simulate(TRACK, [CAR, CAR], wavy(), **TRAVEL), "a list of Vehicle; `convoy"),
    "a scenario for a vehicle": (lambda: mf.vehicle_modes(scenario(SCENARIO)), "scenario.case.vehicle"),
    "a scenario for a track": (lambda: mf.finite_track(scenario(SCENARIO), first=0.0, last=9.0), "scenario.gui"),
    "a profile for a spectrum": (lambda: mf.random_response(TRACK, CAR, wavy(), speed=1.0), "`simulate` takes a p"),
    "a letter for a spectrum": (lambda: mf.third_octave_levels("A", [0.1]), r"IsoRoad.of_class\(letter\)"),
    "a file to compare": (lambda: mf.compare("truck.toml"), r"read_scenario\(file\)"),
    "one variable of a result": (
        lambda: mf.dynamic_load_coefficient(RESULT.contact_force),
        "got a DataArray; it is one variable of a result, and the whole Dataset",
    ),
    "a result for coefficients": (lambda: mf.road_stress_factor(RESULT), r"dynamic_load_coefficient\(result\)"),
    "a result for a history": (lambda: mf.rainflow(RESULT), "take a variable of it"),
    "and for an acceleration": (lambda: mf.running_rms(RESULT, 1e-3), "take a variable of it"),
    "a scenario for a result": (lambda: mf.measures(scenario(SCENARIO)), r"scenario.run\(\)"),
    "a file for a result": (lambda: mf.assess("result.nc"), "xarray.load_dataset"),
    "a number too high": (lambda: mf.comfort(RESULT, 9), r"dof must be among 0 \(bounce\), 1 \(pitch\)"),
    "a history for a random result": (
        lambda: mf.spectral_fatigue("random.nc", "contact_force", slope=3.0),
        "from `random_response`, got 'random.nc'; `xarray",
    ),
    "speeds": (lambda: mf.simulate(TRACK, TRUCK, wavy(), speed=[1, 2], duration=1.0), '"Limits" in docs/conv'),
    "a speed that varies": (lambda: mf.transfer(TRACK, CAR, speed=abs, frequency=[1.0]), "one constant speed"),
    "speeds in an array": (lambda: mf.random_response(TRACK, CAR, ISO, speed=np.ones(3)), "one constant speed"),
    "a law for a tyre": (lambda: mf.Contact(position=0.0, stiffness=abs), "linear: see \"Limits\" in docs/conv"),
    "a table for a suspension": (
        lambda: mf.quarter_car(
            body_mass=1.0, wheel_mass=1.0, suspension_stiffness=[1, 2], suspension_damping=1, tyre_stiffness=1
        ),
        "suspension_stiffness must be .*springs and dashpots are linear",
    ),
    "laws of both axles": (
        lambda: mf.half_car(
            body_mass=1.0, pitch_inertia=1.0, wheel_masses=(1, 1), suspension_stiffness=(1, 1),
            suspension_damping=(1, 1), tyre_stiffness=abs, axles=(1, -1),
        ),
        "tyre_stiffness must be two numbers .*linear",
    ),
    "tables for a file": (lambda: mf.read_scenario({"run": {}}), "file must be the name .*; the tables of"),
    "nothing for a file": (lambda: mf.read_profile(None), "file must be the name of a file, got None$"),
    "a number for a file": (lambda: mf.read_vehicle(5), "file must be the name of a file, got 5$"),
    "bytes for a file": (lambda: mf.read_sampled_guideway(b"a.npz"), "the name of a file, got a bytes$"),
    "files": (lambda: mf.read_profile(["a.csv", "b.csv"]), "a list of str; one file after the other"),
    "a vehicle for a file": (lambda: mf.write_vehicle(CAR, CAR), "the vehicle comes first, then the file"),
    "a profile for a file": (lambda: mf.write_profile(wavy(), wavy()), "the profile comes first, then the file"),
    "file and result swapped": (lambda: mf.export("x.csv", RESULT), "the result comes first, then the file"),
    "a number to export into": (lambda: mf.export(RESULT, 5), "file must be the name of a file, got 5$"),
    "forces for coefficients": (
        lambda: mf.road_stress_factor(RESULT.contact_force),
        r"coefficient must be dynamic load coefficients, .* got a DataArray; `dynamic_load_coefficient\(result\)`",
    ),
    "loads for coefficients": (lambda: mf.road_stress_factor(RESULT.static_load), "got a DataArray; `dynamic_load"),
    "bare forces for coefficients": (
        lambda: mf.road_stress_factor(RESULT.contact_force.values),
        r"at least zero throughout, got -[\d.]+; `dynamic_load_coefficient\(result\)` makes them of a",
    ),
    "beam and foundation swapped": (
        lambda: mf.track(TRACK.foundation, TRACK.beam),
        "beam must be a beam, got a Spring; the order is beam, foundation; foundation must be a found",
    ),
    "vehicle and spectrum swapped": (lambda: mf.random_response(TRACK, ISO, CAR, speed=1.0), "and then profile or"),
    "spectrum and guideway swapped": (lambda: mf.random_response(ISO, CAR, TRACK, speed=1.0), "the order is gui"),
    "a result for a profile": (lambda: mf.iri(RESULT), "of kind 'coupled'; a result does not hold its profile"),
    "a result to prepare": (
        lambda: mf.resampled(RESULT, 0.5),
        "of kind 'coupled'; a result does not hold its profile",
    ),
    "a result to describe": (lambda: mf.describe_profile(RESULT), "a result does not hold its profile"),
    "histories for a history": (
        lambda: mf.rainflow(RESULT.contact_force),
        r"got \(1000, 2\); one column at a time, as result.contact_force.sel\(contact=0\)$",
    ),
    "accelerations for one": (
        lambda: mf.whole_body_vibration(RESULT.acceleration, 1e-3),
        r"one column at a time, as result.acceleration.sel\(dof='bounce'\)$",
    ),
    "bare histories": (lambda: mf.level_crossings(np.ones((9, 2)), [0.5]), r"column at a time, as values\[:, 0\]$"),
    "an array for a vehicle": (lambda: mf.simulate(TRACK, np.ones(3), wavy(), **TRAVEL), "got an ndarray$"),
    "a variable for a number": (
        lambda: mf.simulate(TRACK, TRUCK, wavy(), speed=RESULT.contact_force, duration=1.0),
        r"^speed must be a positive number \[m/s\], got a DataArray; one constant speed",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", MISTAKEN)
def test_what_stands_where_something_else_belongs_is_refused_with_what_to_do(name):
    call, said = MISTAKEN[name]
    with pytest.raises(ValueError, match=said):
        call()


def test_what_is_taken_takes_the_place_that_a_refusal_names():
    """One column of a result, its coefficients, a profile of stations and elevations."""
    assert mf.rainflow(RESULT.contact_force.sel(contact=0)).shape[1] == 2
    assert (mf.road_stress_factor(mf.dynamic_load_coefficient(RESULT)) > 1).all()
    assert (mf.road_stress_factor(RANDOM.dynamic_load_coefficient) > 1).all()


@pytest.mark.parametrize("call", [lambda: mf.weighted(RESULT, 1e-3), lambda: mf.vibration_dose("x", 1e-3)])
def test_one_fault_is_said_once(call):
    with pytest.raises(mf.ParameterError) as refused:
        call()
    assert len(refused.value.faults) == 1


def test_what_is_shown_in_a_message_takes_one_line():
    for value in (RESULT, RESULT.contact_force, wavy(), np.eye(3), [np.eye(2)], {"a": np.eye(2)}):
        assert "\n" not in shown(value)
    assert shown(np.eye(2)) == "array([[1., 0.], [0., 1.]])"


def test_what_is_read_is_shown_in_a_few_lines(tmp_path):
    mf.write_profile(wavy(), tmp_path / "road.csv")
    read = mf.read_profile(tmp_path / "road.csv")
    lines = repr(read).splitlines()
    assert lines[0] == "ReadProfile"
    assert [line.split() for line in lines[1:-1]] == [line.split() for line in repr(read.profile).splitlines()[1:]]
    assert lines[-1].split(maxsplit=1) == ["understood", read.understood]
    table = read._repr_html_()
    assert table.startswith("<table><caption>ReadProfile</caption>")
    assert "800 stations from 0 m" in table
    profile, understood = read
    assert (profile, understood) == (read.profile, read.understood)


def test_every_argument_of_a_kind_is_looked_at():
    """Whatever takes a guideway, a vehicle, a profile, a spectrum or a result says so where a text is given."""
    words = {
        "vehicle": "a Vehicle",
        "profile": "a Profile",
        "spectrum": "a roughness spectrum",
        "result": "(response|result)",
    }
    needed = {"speed": 1.0, "duration": 1.0, "length": 9.0, "frequency": [1.0], "wavelength": [0.1], "step": 1.0}
    needed |= {"radius": 1.0, "spike": 1.0, "paths": [0], "file": "x.csv", "mount": {}, "slope": 3.0, "dof": "body"}
    needed |= {"quantity": "motion", "kurtosis": 4.0, "segment": 9.0, "driver_mass": 1.0, "cushion_stiffness": 1.0}
    needed |= {"cushion_damping": 1.0, "guideway": TRACK, "vehicle": CAR, "profile": wavy(), "spectrum": ISO}
    needed |= {"track": TRACK, "width": 3.0}
    looked_at = 0
    for name in mf.__all__:
        function = getattr(mf, name)
        if inspect.isclass(function):
            continue
        parameters = inspect.signature(function).parameters.values()
        for argument in [one.name for one in parameters if one.name in words]:
            given = {
                one.name: needed[one.name] for one in parameters if one.default is one.empty and one.name in needed
            }
            if name in ("cdfm", "sim", "duhamel"):
                given["road"] = recorded() if name == "duhamel" else cut(10.0)
            if name in ("high_passed", "low_passed"):
                given["wavelength"] = 9.0
            with pytest.raises(ValueError, match=rf"{argument} must be .*{words[argument]}.*, got 'a text'"):
                function(**given | {argument: "a text"})
            looked_at += 1
    assert looked_at > 35


def test_the_limits_that_refusals_point_to_are_there():
    section = (ROOT / "docs" / "conventions.md").read_text(encoding="utf-8").partition("\n## Limits\n")[2]
    assert "one constant speed" in section
    assert "springs and dashpots are linear" in section
    assert '"Limits" in `docs/conventions.md`' in (ROOT / "README.md").read_text(encoding="utf-8")


ANY_CASE = {
    "weighting": lambda word: mf.weighting(word("Wk"), [1.0, 4.0]),
    "weighted": lambda word: mf.weighted(np.sin(np.arange(99.0)), 1e-2, word("Wd")),
    "comfort": lambda word: mf.comfort(RESULT, word("bounce"), weighting=word("Wk")),
    "assess": lambda word: [(one.name, one.standard) for one in mf.assess(RESULT, weighting=word("Wb"))],
    "of_class": lambda word: mf.IsoRoad.of_class(word("B")),
    "two_slope": lambda word: mf.TwoSlopeRoad.of_class(word("good motorway")),
    "track_class": lambda word: mf.GermanTrack.of_class(word("low")),
    "ends": lambda word: mf.finite_track(TRACK, first=0.0, last=9.0, ends=word("Pinned").strip()),
    "scheme": lambda word: (
        mf.newmark_loads(
            cut(20.0), np.ones((9, 1)), [5.0], speed=1.0, scheme=word("central_difference"), time_step=1e-5
        ).deflection.values
    ),
    "catalogue": lambda word: mf.catalogue(word("half_truck")),
    "method": lambda word: scenario(SHORT).run(method=word("moving-frf")).contact_force.values,
}
SHORT = SCENARIO.replace("duration = 24.0", "duration = 0.5")


@pytest.mark.parametrize("name", ANY_CASE)
def test_words_are_known_in_any_case(name):
    as_known = content(ANY_CASE[name](str))
    for change in (str.lower, str.upper):
        assert content(ANY_CASE[name](change)) == as_known
    with pytest.raises(ValueError, match=r"must be (a Scheme or )?one (or two )?of"):
        ANY_CASE[name](lambda _: "nonsense")


def test_the_speed_of_a_scenario_in_kilometres_per_hour():
    """Allowed in place of the other, and shown as it was given, in words, in results and on pages."""
    from movingfrf.reports.result import render
    from movingfrf.scenarios.description import described

    given = scenario(SHORT.replace("speed = 10.0", "speed_kmh = 36.0"))
    assert given.journey.speed == pytest.approx(10.0, rel=1e-15)
    run = dict(dict(described(given).sections)["Run"])
    assert run["speed"] == "36 km/h (10 m/s)"
    result = given.run()
    assert result.attrs["speed_kmh"] == pytest.approx(36.0)
    page = render(result, guideway=given.endless, scenario_text=given.text, title="x")
    assert "36\u00a0km/h (10\u00a0m/s)" in page
    plain = scenario(SHORT)
    np.testing.assert_allclose(result.contact_force, plain.run().contact_force, rtol=0, atol=1e-6)
    assert dict(dict(described(plain).sections)["Run"])["speed"] == "10 m/s (36 km/h)"
    loads = scenario(LOADS.replace("speed = 10.0", "speed_kmh = 36.0"))
    assert loads.journey.in_kmh


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("", "run.speed is missing: speed .m/s. or speed_kmh .km/h."),
        ("speed = 10.0\nspeed_kmh = 36.0", "run.speed and speed_kmh exclude each other"),
        ("speed_kmh = -36.0", "run.speed_kmh must be positive, got -36.0 km/h"),
        ('speed_kmh = "36"', "run.speed_kmh must be"),
        ("speed_km_h = 36.0", "did you mean 'speed_kmh'"),
    ],
)
def test_one_speed_of_the_two(line, message):
    """And whatever else is wrong with the table is said at the same time."""
    text = SHORT.replace("speed = 10.0", line).replace("time_step = 0.001", "time_step = -1.0")
    with pytest.raises(ScenarioError, match=message) as refused:
        scenario(text)
    assert "run.time_step" in str(refused.value)


def test_the_schema_knows_both_speeds():
    import tomllib

    schema = scenario_schema()
    for line, good in (("speed = 10.0", True), ("speed_kmh = 36.0", True), ("speed = 1.0\nspeed_kmh = 1.0", False)):
        tables = tomllib.loads(SHORT.replace("speed = 10.0", line))
        assert jsonschema.Draft7Validator(schema).is_valid(tables) == good
        json.dumps(schema)


def test_plots_take_their_arguments_in_one_order():
    from movingfrf.reports import plots

    drawn = [
        function
        for name, function in vars(plots).items()
        if inspect.isfunction(function)
        and function.__module__ == plots.__name__
        and not name.startswith("_")
        and "ax" in inspect.signature(function).parameters
    ]
    page = (ROOT / "docs" / "plots.md").read_text(encoding="utf-8")
    assert len(drawn) == 11
    for function in drawn:
        first, second, *others = inspect.signature(function).parameters.values()
        assert (first.name, second.name) == ("guideway" if function is plots.moving_frf else "result", "ax")
        assert {one.kind for one in others} <= {inspect.Parameter.KEYWORD_ONLY}
        row = next(line for line in page.splitlines() if line.startswith(f"| `{function.__name__}`"))
        assert all(f"`{one.name}`" in row for one in others)


def test_degrees_of_freedom_are_drawn_by_name_or_number():
    from matplotlib.figure import Figure

    from movingfrf.reports import plots

    ax = Figure().subplots()
    by_name = plots.accelerations(RESULT, ax, dof="Pitch").lines[-1].get_ydata()
    np.testing.assert_array_equal(by_name, plots.accelerations(RESULT, ax, dof=1).lines[-1].get_ydata())
    with pytest.raises(ValueError, match=r"dof must be among 0 \(bounce\), 1 \(pitch\).*, got 'roll'"):
        plots.acceleration_spectrum(RESULT, ax, dof="roll")
    with pytest.raises(ValueError, match=r"contacts must be among .*got 5"):
        plots.contact_forces(RESULT, ax, contacts=[5])


def test_a_random_result_is_no_history():
    assert isinstance(RANDOM, xr.Dataset)
    with pytest.raises(ValueError, match="got a result of kind 'random'; `random_measures` measures it"):
        mf.dynamic_load_coefficient(RANDOM)


# What one asks for first, shown.


def test_vibrations_comfort_and_measures_are_shown_in_few_digits():
    modes = mf.vehicle_modes(TRUCK)
    assert repr(modes).splitlines()[1].split() == "1.637 Hz 3.57 % of critical pitch 93 %, bounce 5 %".split()
    assert repr(modes[0]).splitlines()[1:3] == ["  frequency   1.637 Hz", "  damping     3.57 % of critical"]
    felt = mf.comfort(RESULT, "bounce")
    assert f"  rms           {felt.rms:.4g} m/s²: " in repr(felt)
    assert "rad/s^1.75" in repr(mf.comfort(RESULT, "pitch", weighting="We"))
    assert felt == mf.comfort(RESULT, 0)
    found = mf.measures(RESULT)
    lines = repr(found).splitlines()
    assert lines[0].split() == ["of", "measure", "value", "unit", "by"]
    assert len(lines) == len(found) + 1
    assert isinstance(found, list)
    assert found == [*found]
    assert "weighted rms" in found._repr_html_()
    assert found._repr_html_().count("<tr>") == len(lines)
    many = copy.deepcopy(mf.assess(RESULT))
    many.extend(many * 9)
    assert repr(many).splitlines()[-1] == f"… {len(many) - many.most} more"
    assert repr(many[:0]) == "[]"
    assert repr(pickle.loads(pickle.dumps(found))) == repr(found)


@pytest.mark.parametrize(("coach", "length"), [("velaro_coach", 24.775), ("shinkansen_coach", 25.0)])
def test_a_train_is_spaced_as_coaches_are(coach, length):
    """Lengths over couplers: J. Goicolea; Y. S. Wu and Y. B. Yang, as in the catalogue."""
    axles = mf.train(mf.catalogue(coach), 3).positions
    assert axles[0] - axles[4] == pytest.approx(length, rel=0.01)
    with pytest.raises(ValueError, match="spacing must be given"):
        mf.train(mf.catalogue("golden_car"), 2)

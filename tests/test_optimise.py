"""The best values of keys: known optima, gradients against differences, limits, refusals."""

from __future__ import annotations

import csv
import doctest
import json
import math
import warnings
from pathlib import Path

import numpy as np
import pytest

import movingfrf as mf
from movingfrf._basics.progress import silent
from movingfrf.metrics.measures import statistics, usual
from movingfrf.metrics.slopes import slopes
from movingfrf.response.gradient import gradient, records_of
from movingfrf.response.random_gradient import random_gradient, statistic_slope
from movingfrf.response.ride import ride
from movingfrf.scenarios.reading import parse_scenario
from movingfrf.scenarios.scenario import drive_of
from movingfrf.scenarios.variants import Variants, tables_in
from movingfrf.studies.optimisation.page import render
from movingfrf.studies.optimisation.problem import Key, problem_of
from movingfrf.studies.optimisation.search import Searcher
from movingfrf.studies.optimisation.words import limits_in
from tests.sweep_parts import command
from tests.test_vehicle_scenarios import GROUND, TEXTS

pytestmark = pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")

RIGID = {"kind": "rigid_guideway"}
TRACK = {
    "kind": "track",
    "beam": {"kind": "euler_bernoulli_beam", "bending_stiffness": 1.573e7, "mass": 711.9},
    "foundation": {"kind": "spring", "stiffness": 8e6, "damping": 3e4},
}
CAR = {
    "kind": "quarter_car",
    "body_mass": 400.0,
    "wheel_mass": 40.0,
    "suspension_stiffness": 2e4,
    "suspension_damping": 1.5e3,
    "tyre_stiffness": 2e5,
}
TRUCK = {
    "kind": "half_car",
    "body_mass": 16200.0,
    "pitch_inertia": 1.3e5,
    "wheel_masses": [700.0, 1100.0],
    "suspension_stiffness": [4e5, 1e6],
    "suspension_damping": [1e4, 2e4],
    "tyre_stiffness": [1.75e6, 3.5e6],
    "tyre_damping": [1e3, 2e3],
    "axles": [3.0, -1.5],
}
CARRIAGE = {
    "kind": "carriage",
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
FULL = {
    "kind": "full_car",
    "body_mass": 1200.0,
    "pitch_inertia": 2000.0,
    "roll_inertia": 400.0,
    "wheel_masses": [40.0, 45.0],
    "suspension_stiffness": [2e4, 2.2e4],
    "suspension_damping": [1500.0, 1600.0],
    "tyre_stiffness": [2e5, 2e5],
    "axles": [1.2, -1.4],
    "sides": [0.75, -0.75],
}
UNEVEN = {
    "kind": "superposed",
    "parts": [
        {"kind": "bump", "height": 0.02, "width": 1.0, "at": 5.0},
        {"kind": "harmonic", "amplitude": 5e-3, "wavelength": 3.0},
    ],
}
DAMPING = "vehicle.suspension_damping"


def tables(vehicle=CAR, guideway=RIGID, roughness=UNEVEN, **run):
    journey = {"speed": 20.0, "duration": 2.0, "time_step": 2e-3, "blend": 2.0, **run}
    return {"guideway": guideway, "vehicle": vehicle, "roughness": roughness, "run": journey}


def value_in(said, path):
    for word in path.split("."):
        said = said[int(word)] if isinstance(said, list) else said[word]
    return said


def places_of(known, names, vehicle):
    counts = {"contact": len(vehicle.contacts), "dof": len(vehicle.dof_names)}
    return [(name, place) for name in names for place in range(counts[known[name].place])]


def differences(said, path, places, response="simulate"):
    """Take derivatives along a key, by differences of fourth order of whole cases, and sizes to judge them by."""
    x = value_in(said, path)
    step = 1e-3 * abs(x)
    names = [*dict.fromkeys(name for name, _ in places)]
    axes = {path: [x + n * step for n in (-2, -1, 1, 2)]}
    table = mf.sweep(said, axes, measures=names, response=response, time_step=said["run"]["time_step"])
    low, below, above, high = np.stack([table[name].values[:, place] for name, place in places], axis=1)
    found = (8 * (above - below) - (high - low)) / (12 * step)
    # What hardly changes is known to so many digits of the measure.
    return found, np.maximum(np.abs(found), 1e-2 * np.abs(above / x))


def stencils(variants, said, paths):
    found = []
    for path in paths:
        x = value_in(said, path)
        found.append([(s / (2e-4 * abs(x)), variants.at({path: x + s * 1e-4 * abs(x)}).case) for s in (-1.0, 1.0)])
    return found


# Which vehicle on which guideway, and keys of each kind: masses, springs, dashpots, contacts, geometry, the road's.
KINDS = {
    "quarter car": (CAR, RIGID, ["body_mass", "wheel_mass", "suspension_damping", "tyre_stiffness"], []),
    "half truck": (
        TRUCK,
        TRACK,
        ["pitch_inertia", "wheel_masses.1", "suspension_stiffness.0", "tyre_stiffness.0", "tyre_damping.1"],
        ["guideway.beam.mass", "guideway.foundation.damping", "roughness.parts.0.height"],
    ),
    "full car": (FULL, TRACK, ["roll_inertia", "suspension_damping.1", "tyre_stiffness.0"], []),
    "rigid contacts": (CARRIAGE, TRACK, ["wheelset_mass", "primary_damping", "secondary_stiffness"], []),
    "sprung mass": (
        {"kind": "sprung_mass", "mass": 5750.0, "stiffness": 1.6e6, "damping": 2e4, "wheel_mass": 500.0},
        TRACK,
        ["mass", "stiffness", "damping", "wheel_mass"],
        [],
    ),
    "no freedom but its contact's": ({"kind": "wheelset", "mass": 1500.0}, TRACK, ["mass"], []),
    "seat": (
        {
            "kind": "seated",
            "mount": {"body": 1.0},
            "driver_mass": 80.0,
            "cushion_stiffness": 3e4,
            "cushion_damping": 500.0,
            "vehicle": CAR,
        },
        RIGID,
        ["driver_mass", "cushion_damping"],
        [],
    ),
    "articulated": (
        tables_in(parse_scenario(TEXTS["truck"] + GROUND))[0]["vehicle"],
        TRACK,
        ["units.0.mass", "units.1.axles.0.suspension_damping", "units.0.axles.1.tyre_stiffness"],
        [],
    ),
}


@pytest.mark.parametrize("kind", KINDS)
def test_gradients_are_differences(kind):
    """Whole cases to either side, in the same steps; as accurate as these differences are.

    Between samples a peak is found in places, from one of which to the next its slope changes a little.
    """
    vehicle, guideway, keys, others = KINDS[kind]
    road = {"kind": "side_by_side", "parts": [UNEVEN, UNEVEN["parts"][1]]} if vehicle is FULL else UNEVEN
    said = tables(vehicle, guideway, road, solved_step=1e-3, truncation=60.0)
    variants = Variants(*tables_in(said))
    case = drive_of(variants.at({}))
    solved = ride(case.guideway, case.vehicle, case.road.profile, case.journey)
    places, records = places_of(usual(), usual(), case.vehicle), records_of(solved)
    paths = [*(f"vehicle.{key}" for key in keys), *others]
    made = [slopes()[name](records, place) for name, place in places]
    found = gradient(solved, made, stencils(variants, said, paths))

    smooth = np.array(["peak" not in name and "smallest" not in name for name, _ in places])
    for number, path in enumerate(paths):
        expected, size = differences(said, path, places)
        off = np.abs(found[:, number] - expected)
        assert (off <= np.where(smooth, 1e-6, 1e-3) * size).all(), path


def test_every_usual_measure_has_its_slope():
    assert slopes().keys() == usual().keys()


@pytest.mark.parametrize("vehicle", [TRUCK, FULL], ids=["truck", "car"])
def test_gradients_of_random_responses_are_differences(vehicle):
    road = {"kind": "iso_road", "road_class": "B"}
    if vehicle is FULL:
        road |= {"across": [0.75, -0.75], "coherence": {"kind": "isotropic_coherence"}}
    said = tables(vehicle, TRACK, road)
    variants = Variants(*tables_in(said))
    scenario = variants.at({})
    result, case = scenario.at_random(), drive_of(scenario)
    names = [name for name in statistics() if not name.startswith(("roughness_", "lift_off"))]
    places = places_of(statistics(), names, case.vehicle)
    made = [statistic_slope(result, name, place) for name, place in places]
    paths = ["vehicle.body_mass", f"{DAMPING}.1"]
    found = random_gradient(case, result.frequency.values, made, stencils(variants, said, paths))

    for number, path in enumerate(paths):
        expected, size = differences(said, path, places, "random")
        assert (np.abs(found[:, number] - expected) <= 1e-6 * size).all(), path


def test_lift_off_has_a_gradient():
    """A rough road, so that the numbers are not all zero."""
    said = tables(CAR, RIGID, {"kind": "iso_road", "road_class": "E"})
    variants = Variants(*tables_in(said))
    scenario = variants.at({})
    result, case = scenario.at_random(), drive_of(scenario)
    places = [("lift_off_share", 0), ("lift_off_rate", 0)]
    made = [statistic_slope(result, *place) for place in places]
    found = random_gradient(case, result.frequency.values, made, stencils(variants, said, [DAMPING]))
    expected, _ = differences(said, DAMPING, places, "random")
    assert (np.abs(expected * 1500.0) > 0.1 * result.lift_off_share.item()).all()
    np.testing.assert_allclose(found[:, 0], expected, rtol=1e-5)


@pytest.mark.parametrize("value", [1.0, 1.0005, 55.0, 100.0])
def test_derivatives_stay_within_the_range(value):
    key = Key(("a",), 1.0, 100.0, "")
    near = key.around(value)
    assert all(1.0 <= at <= 100.0 for _, at in near)
    assert sum(weight * at**2 for weight, at in near) == pytest.approx(2 * value, rel=1e-8)
    assert key.at(key.share(value)) == pytest.approx(value, rel=1e-12)


def test_slopes_along_the_ranges():
    """One key goes by factors, the other by steps."""
    said = tables(solved_step=1e-3, truncation=60.0)
    over = {DAMPING: (100.0, 1e4), "vehicle.suspension_stiffness": (1.5e4, 3e4)}
    problem = problem_of(said, over, "contact_force_rms", where={("acceleration_rms", "body"): 99.0})
    assert [key.by_factors for key in problem.keys] == [True, False]
    searcher, at = Searcher(problem, silent, 10), np.array([0.4, 0.6])
    found = searcher.slopes(at)
    for key, way in enumerate(1e-3 * np.eye(2)):
        expected = (searcher.at(at + way).wanted - searcher.at(at - way).wanted) / 2e-3
        np.testing.assert_allclose(found[:, key], expected, rtol=1e-3)
    # Whatever was tried last: the least, which is at neither end of what was.
    forces = [float(searcher.at(np.array([share, 0.6])).wanted[0]) for share in (0.0, 0.6, 1.0)]
    assert float(searcher.best().wanted[0]) < min(forces[0], forces[-1])


def test_the_damping_that_is_most_comfortable_in_closed_form():
    """On white velocity the body's variance is π S ((m + M) k²/(M² c) + K c/M²), least at c = k √((m + M)/K)."""
    said = tables(roughness={"kind": "iso_road", "roughness": 16e-6, "band": [1e-3, 30.0]})
    best = mf.optimise(said, {DAMPING: (100.0, 1e4)}, "acceleration_rms", dof="body", response="random", starts=1)
    assert best.success
    # Beyond either end of the band lies a share of some 1e-5 of the variance.
    assert best.x[0] == pytest.approx(2e4 * math.sqrt(440.0 / 2e5), rel=1e-4)
    assert best.fun == pytest.approx(float(best.scenario.at_random().acceleration_rms.sel(dof="body")), rel=1e-12)


@pytest.fixture(scope="module")
def held():
    """Dampers of a truck for the rear axle, within a limit of comfort."""
    over = {f"{DAMPING}.0": (2e3, 2e5), f"{DAMPING}.1": (2e3, 2e5)}
    limits = {"weighted_acceleration_rms": 0.19}
    return mf.optimise(tables(TRUCK, TRACK), over, "dynamic_load_coefficient", contact="rear", where=limits)


def grid(over, **more):
    """Compute all there is within ranges, as a sweep."""
    axes = {path: np.geomspace(low, high, 15) for path, (low, high) in over.items()}
    measures = ["dynamic_load_coefficient", "weighted_acceleration_rms"]
    return mf.sweep(tables(TRUCK, TRACK), axes, measures=measures, **more)


def test_a_grid_has_nothing_better(held):
    assert held.success
    table = grid({f"{DAMPING}.0": (2e3, 2e5), f"{DAMPING}.1": (2e3, 2e5)})
    load = table.dynamic_load_coefficient.values[..., 1]
    inside = table.weighted_acceleration_rms.values[..., 0] <= 0.19
    assert load.min() < held.fun <= load[inside].min()
    # It is no better than the grid's best by more than the grid is coarse.
    assert held.fun > 0.97 * load[inside].min()


def test_what_was_found_is_a_scenario_and_a_table(held):
    result = held.scenario.run()
    assert mf.dynamic_load_coefficient(result)[1] == pytest.approx(held.fun, rel=1e-9)
    again = parse_scenario(held.scenario.text)
    np.testing.assert_array_equal(drive_of(again).vehicle.matrices[1], drive_of(held.scenario).vehicle.matrices[1])
    table = held.table
    assert table.sizes["evaluation"] == held.nfev > held.njev > 1
    assert {"dynamic_load_coefficient", "weighted_acceleration_rms", "status"} <= set(table.data_vars)
    own = [table[f"{DAMPING}.{number}"].values[0] for number in (0, 1)]
    assert own == TRUCK["suspension_damping"]  # to the last digit
    assert (table.status == "").all()
    assert "bounce, at most 0.19, is at its limit" in held.message
    assert "as the scenario was" in held.message


def test_the_largest_of_all_contacts_is_made_small():
    """Both are equal there, where a step towards either makes the other larger."""
    over = {(f"{DAMPING}.0", f"{DAMPING}.1"): (2e3, 2e5), "vehicle.tyre_stiffness.0": (1e6, 4e6)}
    best = mf.optimise(tables(TRUCK, RIGID), over, "contact_force_rms", starts=2)
    assert best.success
    axes = {(f"{DAMPING}.0", f"{DAMPING}.1"): [(c, c) for c in np.geomspace(2e3, 2e5, 30)]}
    axes["vehicle.tyre_stiffness.0"] = np.geomspace(1e6, 4e6, 8)
    worst = mf.sweep(tables(TRUCK, RIGID), axes, measures=["contact_force_rms"]).contact_force_rms.max("contact")
    assert 0.97 * worst.min() < best.fun <= worst.min()
    assert best.fun == best.table.contact_force_rms.max("contact").min()
    # A key of several: one value.
    assert best.x.size == 2
    assert drive_of(best.scenario).vehicle.matrices[1].any()


def test_limits_that_cannot_be_kept_are_said():
    limits = {"weighted_acceleration_rms": 0.1, "smallest_contact_force": (0.0, None)}
    with pytest.warns(mf.ValidityWarning, match=r"keep all limits; nearest: .* of body, at most 0\.1, is "):
        best = mf.optimise(tables(), {DAMPING: (100.0, 1e4)}, "dynamic_load_coefficient", where=limits)
    assert not best.success
    comfort = mf.sweep(tables(), {DAMPING: np.geomspace(100.0, 1e4, 200)}, measures=["weighted_acceleration_rms"])
    least = float(comfort.weighted_acceleration_rms.isel(dof=0).min())
    (line,) = np.flatnonzero(best.table.suspension_damping.values == best.x[0])
    nearest = float(best.table.weighted_acceleration_rms[line, 0])
    assert nearest == pytest.approx(least, rel=1e-3)
    codes = [one["code"] for one in json.loads(best.table.attrs["findings"])]
    assert codes == ["limits_not_kept"]


def test_a_key_at_an_end_of_its_range_is_said():
    """The lower a bump, the better: in one step."""
    height = "roughness.parts.0.height"
    with pytest.warns(
        mf.ValidityWarning, match=f"{height} stands at the lower end of its range, 0.01000 m: beyond"
    ):
        best = mf.optimise(tables(), {height: (0.01, 0.03)}, "contact_force_peak", starts=1)
    assert best.success
    assert best.x[0] == 0.01


FAST = tables(
    {"kind": "sprung_mass", "mass": 1e4, "stiffness": 1e7, "damping": 1e5}, TRACK, speed=260.0, duration=0.5
)


def test_a_search_goes_round_what_is_impossible():
    """With little damping the mass is unstable at that speed, with more it is not, with most it is best."""
    best = mf.optimise(FAST, {"vehicle.damping": (1e3, 1e6)}, "contact_force_rms", starts=1)
    unstable = ["unstable" in why for why in best.table.status.values]
    assert any(unstable)
    assert not all(unstable)
    damping = np.geomspace(1e4, 3e4, 12)
    force = mf.sweep(FAST, {"vehicle.damping": damping}, measures=["contact_force_rms"]).contact_force_rms
    assert 0.9 * float(force.min()) < best.fun <= float(force.min())


ROAD = {"kind": "iso_road", "road_class": "B"}


@pytest.mark.parametrize(
    ("said", "over", "more", "words"),
    [
        ({}, {}, {}, "over must be a mapping from keys to ranges"),
        ({}, {DAMPING: (2.0, 1.0)}, {}, "must have a range from a lower to a higher value, got 2 to 1"),
        ({}, {DAMPING: (2.0, 2.0)}, {}, "from a lower to a higher value, got 2 to 2"),
        ({}, {DAMPING: 3.0}, {}, r"must be two numbers \[N s/m\], got 3.0"),
        ({}, {"vehicle.suspension_dampin": (1.0, 2.0)}, {}, "did you mean 'suspension_damping'"),
        ({}, {"run.duration": (1.0, 2.0)}, {}, "run.duration has no best value"),
        ({}, {"vehicle": (1.0, 2.0)}, {}, "vehicle has no best value"),
        ({"roughness": ROAD}, {"run.speed": (10.0, 20.0)}, {}, "changes the way of the vehicle"),
        ({"roughness": ROAD}, {"roughness.seed": (1, 9)}, {}, "roughness.seed must be a whole number"),
        (
            {},
            {DAMPING: (1.0, 2.0)},
            {"minimise": "dynamic_load_coeficient"},
            "did you mean 'dynamic_load_coefficient'",
        ),
        ({}, {DAMPING: (1.0, 2.0)}, {"contact": "weel"}, "did you mean 'wheel'"),
        ({}, {DAMPING: (1.0, 2.0)}, {"dof": "body"}, "dof is not what dynamic_load_coefficient is taken of"),
        ({}, {DAMPING: (1.0, 2.0)}, {"where": {"comfort": 0.5}}, "where must be one of"),
        ({}, {DAMPING: (1.0, 2.0)}, {"where": {"deflection_rms": (2.0, 1.0)}}, "an upper limit, or a lower and"),
        ({}, {DAMPING: (1.0, 2.0)}, {"where": {("acceleration_rms", "cab"): 1.0}}, "among 0 .body., 1 .wheel."),
        ({}, {DAMPING: (1.0, 2.0)}, {"response": "rnadom"}, "did you mean 'random'"),
        ({}, {DAMPING: (1.0, 2.0)}, {"starts": 0}, "starts must be a whole number of at least 1"),
        ({}, {DAMPING: (-2.0, -1.0)}, {}, "suspension_damping must not be negative"),
    ],
)
def test_what_is_refused(said, over, more, words):
    asked = {"minimise": "dynamic_load_coefficient", **more}
    with pytest.raises(ValueError, match=words):
        mf.optimise({**tables(), **said}, over, **asked)


def test_no_case_with_an_answer():
    with pytest.raises(
        mf.SolveError, match=r"none of 8 cases within the ranges has an answer; the first: .*unstable"
    ):
        mf.optimise(FAST, {"vehicle.damping": (9e3, 1.1e4)}, "contact_force_rms")


def test_the_command(tmp_path):
    from movingfrf._basics.toml_file import as_toml

    file = tmp_path / "car.toml"
    file.write_text(as_toml(tables()))
    asked = ["--over", f"{DAMPING}=100~1e4", "--minimise", "dynamic_load_coefficient", "--contact", "wheel"]
    done = command("optimise", file, *asked, "--where", "weighted_acceleration_rms:body=5", "--starts", "1")
    assert done.returncode == 0, done.stderr
    assert "dynamic_load_coefficient of wheel is" in done.stdout
    folder = tmp_path / "out" / "car-best"
    assert {path.name for path in folder.iterdir()} == {"best.toml", "table.csv", "report.html"}
    rows = [*csv.DictReader((folder / "table.csv").read_text().splitlines())]
    best = min(float(row["dynamic_load_coefficient wheel"]) for row in rows)
    result = mf.read_scenario(folder / "best.toml").run()
    assert float(mf.dynamic_load_coefficient(result)[0]) == pytest.approx(best, rel=1e-12)
    refused = command("optimise", file, "--over", f"{DAMPING}=5", *asked[2:])
    assert refused.returncode == 2
    assert "must be KEY=LOW~HIGH" in refused.stderr


def test_limits_in_a_line():
    lines = ["weighted_acceleration_rms:cab=0.5", "deflection_rms=1e-3", "smallest_contact_force:1=2e4~"]
    assert limits_in(lines) == {
        ("weighted_acceleration_rms", "cab"): 0.5,
        "deflection_rms": 1e-3,
        ("smallest_contact_force", 1): (2e4, None),
    }


@pytest.mark.parametrize("line", ["contact_force_rms", "contact_force_rms=", "=3", "contact_force_rms:=3", "a=~"])
def test_lines_that_are_no_limits(line):
    with pytest.raises(ValueError, match=r"must be MEASURE=LIMIT, MEASURE=LOW~ for"):
        limits_in([line])


def test_the_documentation_runs():
    page = Path(__file__).parents[1] / "docs" / "optimisation.md"
    assert doctest.testfile(str(page), module_relative=False).failed == 0


def test_the_page_has_what_was_found(held):
    over = {f"{DAMPING}.0": (2e3, 2e5), f"{DAMPING}.1": (2e3, 2e5)}
    limits = {"weighted_acceleration_rms": 0.19}
    problem = problem_of(tables(TRUCK, TRACK), over, "dynamic_load_coefficient", contact="rear", where=limits)
    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        page = render(problem, held, "best", held.scenario.text)
    assert page.count("<figure") == 2
    assert held.message.split(";")[0] in page
    assert "as it was" in page
    assert "at most 0.19" in page


def test_the_scenario_that_was_found_at_random_travels_as_long_as_the_one_given():
    said = tables(CAR, RIGID, {"kind": "iso_road", "road_class": "B"})
    said["run"]["duration"] = 3.0
    best = mf.optimise(said, over={DAMPING: (1e3, 2e3)}, minimise="contact_force_rms", response="random")
    assert best.scenario.journey.duration == 3.0

"""Scenarios stepped through time: finite roads against modal series, stretches of endless ones, the commands."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from scipy.integrate import solve_ivp

import movingfrf as mf
from movingfrf.commands.main import main
from movingfrf.reports.figures import blank
from movingfrf.reports.result import render as write_page
from movingfrf.scenarios.description import described
from movingfrf.scenarios.reading import parse_scenario
from movingfrf.studies.comparison.convergence import converged, quantities
from movingfrf.studies.comparison.files import convergence_as_json
from movingfrf.studies.comparison.methods import FOR_LOADS, FOR_VEHICLE, Case, chosen
from movingfrf.studies.comparison.page import _error_over_time, render
from tests.stepping.plate_parts import TRACK, WIDTH
from tests.test_scenario import LOADS, edited

# The bridge of examples/bridge.py on next to no foundation, which the series below takes in exactly.
LENGTH, BENDING_STIFFNESS, MASS, FOUNDATION, SPEED = 25.0, 8.323e9, 2303.0, 1.0, 25.0
BRIDGE = f"""
[guideway]
kind = "finite_track"
first = 0.0
last = {LENGTH}
element = 1.25
ends = "pinned"
[guideway.track]
beam = {{kind = "euler_bernoulli_beam", bending_stiffness = {BENDING_STIFFNESS}, mass = {MASS}}}
foundation = {{kind = "spring", stiffness = {FOUNDATION}}}

[run]
speed = {SPEED}
duration = {LENGTH / SPEED}
time_step = 1e-3
"""
FORCE = 56_407.5  # [N]
CONSTANT = (
    BRIDGE
    + f"""
[loads]
positions = [0.0]
[[loads.force]]
kind = "constant"
force = {FORCE}
"""
)
# The sprung mass of the same example, on a road that waves.
WEIGHT, SPRING = FORCE, 1595e3  # [N, N/m]
OSCILLATOR = (
    BRIDGE
    + f"""
[vehicle]
kind = "vehicle"
mass = [[{WEIGHT / 9.81}]]
damping = [[0.0]]
stiffness = [[0.0]]
contact_map = [[1.0]]
contacts = [{{position = 0.0, stiffness = {SPRING}}}]
vertical = [1.0]
dof_names = ["body"]

[roughness]
kind = "harmonic"
amplitude = 2e-3
wavelength = 5.0
"""
).replace("[run]", "[run]\nblend = 0.0")

# Enough for the sum: the next mode moves the deflection by 1/60^4.
ORDERS = np.arange(1, 60)
WAVENUMBERS = np.pi * ORDERS / LENGTH
FREQUENCIES = np.sqrt((BENDING_STIFFNESS * WAVENUMBERS**4 + FOUNDATION) / MASS)


def under_a_constant_force(time):
    """Deflection under a constant force that crosses a simply supported beam.

    L. Frýba, Vibration of Solids and Structures under Moving Loads, 1999, chapter 1, without damping.
    """
    passing = WAVENUMBERS * SPEED
    each = np.sin(np.outer(time, passing)) - passing / FREQUENCIES * np.sin(np.outer(time, FREQUENCIES))
    amplitudes = 2 * FORCE / (MASS * LENGTH) / (FREQUENCIES**2 - passing**2)
    return (each * amplitudes * np.sin(np.outer(time, passing))).sum(axis=1)


def crossing_of_a_sprung_mass(time, roughness):
    """Contact force of a mass on a spring that crosses the same beam, by its modes and an ODE solver."""
    modes = 8  # the next, 6561 times as stiff as the first, would move the force by 1e-4

    def force(t, q, z):
        return WEIGHT + SPRING * (z - np.sin(WAVENUMBERS[:modes] * SPEED * t) @ q + roughness(t))

    def rates(t, state):
        q, velocity, (z, dz) = state[:modes], state[modes : 2 * modes], state[2 * modes :]
        pushed = 2 / (MASS * LENGTH) * force(t, q, z) * np.sin(WAVENUMBERS[:modes] * SPEED * t)
        upward = SPRING * (np.sin(WAVENUMBERS[:modes] * SPEED * t) @ q - z - roughness(t))
        return np.concatenate([velocity, pushed - FREQUENCIES[:modes] ** 2 * q, [dz, upward * 9.81 / WEIGHT]])

    span = (0.0, time[-1])
    found = solve_ivp(rates, span, np.zeros(2 * modes + 2), t_eval=time, rtol=1e-8, atol=1e-12, method="DOP853")
    return np.array([force(t, state[:modes], state[2 * modes]) for t, state in zip(time, found.y.T, strict=True)])


def apart(found, wanted):
    return np.linalg.norm(found - wanted) / np.linalg.norm(wanted)


@pytest.fixture
def bridge(tmp_path):
    file = tmp_path / "bridge.toml"
    file.write_text(OSCILLATOR)
    return file


def test_a_constant_force_crosses_a_bridge():
    """Twenty elements; steps of 1 ms leave (ω Δt)²/12 = 8e-5 of the lowest mode and 1e-3 of the second."""
    result = parse_scenario(CONSTANT).run(method="newmark")
    wanted = under_a_constant_force(result.time.values)
    assert wanted.max() == pytest.approx(FORCE * LENGTH**3 / 48 / BENDING_STIFFNESS, rel=0.1)
    assert apart(result.deflection.values[:, 0], wanted) < 5e-4


@pytest.mark.parametrize("method", ["cdfm", "sim"])
def test_a_sprung_mass_crosses_a_bridge(method):
    """What varies of the contact force, which the waves of the road cause more than the bridge."""
    scenario = parse_scenario(OSCILLATOR)
    result = scenario.run(method=method)
    assert result.attrs["run_in"] == 0.0  # it begins at the end of the bridge
    surface = scenario.case.road.profile.along(0)
    datum = surface(0.0)
    wanted = crossing_of_a_sprung_mass(result.time.values, lambda t: surface(SPEED * t) - datum)
    found = result.contact_force.values[:, 0] + result.static_load.values
    assert np.ptp(wanted) > 0.1 * WEIGHT
    assert apart(found - WEIGHT, wanted - WEIGHT) < 1e-3


def test_the_converged_answer_on_a_finite_road_is_the_series():
    scenario = parse_scenario(CONSTANT)
    found = converged(scenario)
    wanted = under_a_constant_force(scenario.journey.times)
    assert max(found.movement.values()) < 3e-5
    assert apart(found.quantities["deflection"][:, 0], wanted) < 1e-5


def test_an_endless_road_is_stepped_as_it_is_compared():
    scenario = parse_scenario(edited(duration=1.5))
    exact = scenario.run()
    assert exact.attrs["method"] == "moving-frf"
    for method in ("cdfm", "sim"):
        result = scenario.run(method=method)
        assert result.attrs["method"] == method
        assert (result.attrs["scenario"], result.attrs["road"]) == (exact.attrs["scenario"], exact.attrs["road"])
        case = Case(scenario=scenario, time_step=1e-3, element=0.25)
        assert result.drop_attrs().identical(FOR_VEHICLE[method].prepare(case)(case.given).drop_attrs())
        assert apart(result.contact_force.values, exact.contact_force.values) < 1e-3
        # Room for a second of run-in, and for 14 lengths over which the road bends.
        assert result.attrs["road_first"] == pytest.approx(-2.05 - 10.0 - 14 * (4 * 1.573e7 / 8e6) ** 0.25, abs=0.3)
    loads = parse_scenario(LOADS)
    result = loads.run(method="newmark")
    case = Case(scenario=loads, time_step=1e-3, element=0.25)
    assert result.drop_attrs().identical(FOR_LOADS["newmark"].prepare(case)(case.given).drop_attrs())
    assert apart(result.deflection.values, loads.run().deflection.values) < 2e-3


@pytest.mark.filterwarnings("ignore:the deflection under the vehicle")
def test_the_weight_travels_as_long_as_a_finite_road_has_room():
    """In multiples of eight steps, so that longer steps begin at the same place."""
    text = OSCILLATOR.replace('ends = "pinned"', 'ends = "absorbing"').replace(
        "stiffness = 1.0}", "stiffness = 1e7}"
    )
    for last, start, wanted in ((75.0, 40.0, 1.0), (75.0, 13.3, 0.528), (75.0, 0.1, 0.0)):
        there = text.replace("last = 25.0", f"last = {last}").replace("[run]", f"[run]\nstart = {start}")
        assert parse_scenario(there).run(method="cdfm").attrs["run_in"] == pytest.approx(wanted, abs=1e-12)
    off = text.replace("[run]", "[run]\nstart = -0.1")
    with pytest.raises(ValueError, match=r"road must reach from -0\.1 m"):
        parse_scenario(off).run(method="cdfm")


def test_who_writes_a_scenario_can_let_the_weight_settle():
    text = OSCILLATOR.replace('ends = "pinned"', 'ends = "absorbing"').replace(
        "stiffness = 1.0}", "stiffness = 1e7}"
    )
    text = text.replace("last = 25.0", "last = 75.0").replace("[run]", "[run]\nstart = 13.3")
    with pytest.warns(UserWarning, match="a scenario a finite road that reaches further back, or a later start"):
        parse_scenario(text).run(method="cdfm")


def travelling():
    """Give the journey of the usual scenario, on a finite road that travels along."""
    scenario = parse_scenario(edited(duration=0.5))
    road = mf.finite_track(
        scenario.guideway, first=-25.0, last=25.0, element=0.25, ends="absorbing", absorbing=10.0, travels=True
    )
    return replace(scenario, case=replace(scenario.case, guideway=road))


def test_a_road_that_travels_along_is_the_same_everywhere():
    scenario = travelling()
    result = scenario.run(method="cdfm")
    assert result.attrs["superposed"] == 1
    assert (
        apart(result.contact_force.values, parse_scenario(edited(duration=0.5)).run().contact_force.values) < 2e-3
    )
    together = mf.cdfm(
        scenario.guideway,
        scenario.case.vehicle,
        scenario.case.road.profile,
        speed=scenario.journey.speed,
        duration=0.5,
        time_step=scenario.journey.time_step,
    )
    moved = quantities(result, scenario)["deflection"]
    assert np.allclose(moved, result.deflection.values - result.static_deflection.values)
    pages = [write_page(one, guideway=None) for one in (result, together)]
    for words in ("not the same everywhere", "differently everywhere"):
        assert all(words not in page for page in pages)
    assert "not the same" not in str(described(scenario))
    assert "not the same" not in render(mf.compare(scenario, ["cdfm"], curve=False, memory=False, runs=1))


@pytest.mark.parametrize(
    ("text", "method", "message"),
    [
        (edited(), "cdmf", r"moving-frf, cdfm, sim with a vehicle, got 'cdmf' \(did you mean 'cdfm'\?\)"),
        (edited(), "newmark", "moving-frf, cdfm, sim with a vehicle, got 'newmark'"),
        (LOADS, "cdfm", "moving-frf, newmark with prescribed loads, got 'cdfm'"),
        (OSCILLATOR, "newmark", "one of cdfm, sim with a vehicle on a finite road, got 'newmark'"),
        (CONSTANT, "cdfm", "one of newmark with prescribed loads on a finite road, got 'cdfm'"),
        (OSCILLATOR, "moving-frf", "no moving FRF.*run FILE --method cdfm"),
        (CONSTANT, "moving-frf", "no moving FRF.*run FILE --method newmark"),
    ],
)
def test_what_a_method_does_not_suit_is_refused(text, method, message):
    with pytest.raises(ValueError, match=message):
        parse_scenario(text).run(method=method)


def test_what_cannot_be_divided_is_not_stepped():
    scenario = parse_scenario(edited())
    rigid = replace(scenario, case=replace(scenario.case, guideway=mf.RigidGuideway()))
    with pytest.raises(ValueError, match=r"Euler–Bernoulli beam.*got a RigidGuideway"):
        rigid.run(method="cdfm")


@pytest.mark.parametrize(
    ("text", "what"), [(OSCILLATOR, "the contacts travel"), (CONSTANT, "loads and observers travel")]
)
def test_who_leaves_a_finite_road_is_named_as_the_scenario_names_it(text, what):
    """Nothing runs in where there is no room to; prescribed loads have no contacts."""
    with pytest.raises(mf.ScenarioError, match=rf"to [\d.]+ m, where {what}, but it reaches from 0 m to 25 m"):
        parse_scenario(re.sub(r"duration = \S+", "duration = 2.0", text))


def test_an_undamped_vehicle_is_called_so(capsys):
    assert main(["check", str(Path(__file__).parents[1] / "examples" / "bridge.toml")]) == 0
    told = " ".join(capsys.readouterr().out.split())
    assert "2.651 Hz undamped: body 100 %" in told
    assert "a vibration of the vehicle at 2.65 Hz is undamped: it does not settle" in told


def test_the_command_steps_a_finite_road(bridge, tmp_path, capsys):
    output = tmp_path / "out"
    assert main(["run", str(bridge), "--output", str(output)]) == 2
    assert "movingfrf run FILE --method cdfm" in capsys.readouterr().err
    assert not output.exists()
    assert main(["run", str(bridge), "--output", str(output), "--method", "sim"]) == 0
    assert "Method: separate iterative method (SIM)" in capsys.readouterr().out
    with xr.open_dataset(output / "result.nc") as result:
        assert result.attrs["method"] == "sim"
        assert (result.attrs["road_first"], result.attrs["road_last"]) == (0.0, LENGTH)
    assert json.loads((output / "summary.json").read_text())["settings"]["method"] == "sim"
    page = (output / "report.html").read_text(encoding="utf-8")
    assert "Moving FRFs" not in page
    assert "moving FRF" not in page
    for words in ("separate iterative method", "reaches from 0 m to 25 m", "stepped on together", "Exchanges"):
        assert words in page
    assert "Critical speed" not in page


def test_the_page_of_a_bridge_calls_nothing_steady(bridge, tmp_path):
    """What is dynamic comes of the bridge; on a stretch cut out of an endless road of the roughness alone."""
    pages = {}
    for text in (OSCILLATOR, edited(duration=0.5)):
        bridge.write_text(text)
        assert main(["run", str(bridge), "--output", str(tmp_path / "out"), "--method", "cdfm"]) == 0
        pages[text == OSCILLATOR] = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    for words in (
        "is what the roughness adds",
        "about which they vary",
        "the sag in steady travel",
        "about the steady state",
        "over a rough road",
    ):
        assert words in pages[False]
        assert words not in pages[True]
    for words in ("over a finite road, whose surface rises and falls by 4", "a beginning and no mean"):
        assert words in pages[True]
        assert words not in pages[False]


def test_the_spectrum_of_a_road_that_is_next_to_flat_is_left_out(bridge, tmp_path):
    """Of 1 µm over the length of the bridge nothing reaches the lowest class line; of 2 mm over 5 m it does."""
    flat = OSCILLATOR.replace("2e-3", "1e-6").replace("wavelength = 5.0", "wavelength = 25.0")
    for text, there in ((flat, False), (OSCILLATOR, True)):
        bridge.write_text(text)
        assert main(["run", str(bridge), "--output", str(tmp_path / "out"), "--method", "cdfm"]) == 0
        page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
        assert ("ISO 8608 classes" in page, "there is content over" in page) == (there, there)
        assert ("so none is drawn" in page) != there


def test_the_page_of_loads_says_how_they_were_stepped(tmp_path):
    file = tmp_path / "force.toml"
    file.write_text(CONSTANT)
    assert main(["run", str(file), "--output", str(tmp_path / "out"), "--method", "newmark"]) == 0
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "by Newmark&#39;s method" in page
    assert "moving FRF" not in page


def test_a_finite_road_is_compared_with_itself(bridge, tmp_path, capsys):
    output = tmp_path / "out"
    assert main(["compare", str(bridge), "--no-curve", "--output", str(output)]) == 0
    told = capsys.readouterr().out
    assert "over moving-frf" not in told
    table = json.loads((output / "compare.json").read_text())
    assert list(table) == ["cdfm", "sim"]
    assert table["cdfm"]["relative_l2"]["contact_force"] < 1e-3
    assert table["cdfm"]["element"] == 1.25
    answer = json.loads((output / "convergence.json").read_text())["converged_answer"]
    assert answer["halved"] == "step and elements"
    assert answer["finest_element"] < 1.25 / 4
    page = (output / "report.html").read_text(encoding="utf-8")
    for words in ("on the same road", "halving step and elements", "the weight is always stepped along"):
        assert words in page


def test_the_page_of_a_compared_bridge_speaks_of_nothing_else():
    found = mf.compare(parse_scenario(OSCILLATOR), memory=False, runs=1)
    page = render(found)
    for words in ("dashed lines", "struck road", "truncation", "static sag", "wheel", "a rough road"):
        assert words not in page
    for words in ("limits it: the elements.", "judged by the whole deflection and by the vehicle acceleration"):
        assert words in page
    # Times within a decade, between two powers of ten, are to be read all the same.
    near = [point._replace(seconds=2e-3 * (1 + n / len(found.curve))) for n, point in enumerate(found.curve)]
    ax = blank(3.0).subplots()
    _error_over_time(replace(found, curve=near), "deflection", ax, targets=False)
    ax.figure.draw_without_rendering()
    assert [label for label in ax.get_xticklabels(which="minor") if label.get_text()]


def test_what_counts_as_static_on_a_finite_road_makes_no_difference():
    scenario = parse_scenario(OSCILLATOR)
    result = scenario.run(method="cdfm")
    other = result.assign(
        static_load=result.static_load + 1e3,
        contact_force=result.contact_force - 1e3,
        static_deflection=result.static_deflection + 1.0,
    )
    compared, again = quantities(result, scenario), quantities(other, scenario)
    assert all(np.allclose(compared[name], again[name], rtol=1e-9) for name in compared)


def test_of_a_road_given_by_matrices_the_step_alone_is_halved():
    scenario = parse_scenario(OSCILLATOR)
    matrices = replace(scenario.guideway, finer=None)
    given = replace(scenario, case=replace(scenario.case, guideway=matrices))
    found = mf.compare(given, ["cdfm", "cdfm-weight"], curve=False, memory=False, runs=1)
    together, alone = found.rows
    assert together.relative_l2 == alone.relative_l2
    answer = json.loads(convergence_as_json(found))["converged_answer"]
    assert (answer["halved"], answer["finest_element"]) == ("the step alone", None)
    assert "halving the step alone" in render(found)


@pytest.mark.parametrize("method", ["moving-frf", "moving-frf-fe", "duhamel", "cdfm-window"])
def test_methods_that_need_an_endless_road_are_refused_by_name(method):
    with pytest.raises(ValueError, match=f"^{method}: for roads that are endless.*cdfm, cdfm-weight, sim can be"):
        chosen(parse_scenario(OSCILLATOR), [method, "cdfm"])
    assert list(chosen(parse_scenario(CONSTANT), None)) == ["newmark"]


def test_finer_roads_have_elements_within_elements():
    """Coarse functions are among the fine ones, so the same road gives way as much or more, and hardly more."""
    track = parse_scenario(edited()).guideway
    chain = mf.finite_track(track, first=0.0, last=19.9, element=0.5, ends=("pinned", "absorbing"))
    plate = mf.finite_plate(TRACK, width=WIDTH, first=0.0, last=20.0, element=0.8, across=2, ends="pinned")
    for road in (chain, plate):
        fine = road.finer(2)
        assert fine.spacing == pytest.approx(0.5 * road.spacing, rel=1e-12)
        assert (fine.interval, fine.width, fine.travels) == (road.interval, road.width, road.travels)
        sags = []
        for one in (road, fine):
            row = one.rows(np.array([9.3]), 0, 0.4).toarray()[0]
            sags.append(row @ np.linalg.solve(one.stiffness.toarray(), row))
        assert sags[0] * (1 - 1e-9) < sags[1] < 1.05 * sags[0]
    assert plate.finer(2).dofs == 4 * 51 * 5 - 2 * 2 * 5  # two times as many elements across as well


@pytest.mark.slow
def test_a_plate_is_compared_with_finer_plates():
    text = edited(duration=0.5, start=14.0, blend=1.0)
    scenario = parse_scenario(text)
    plate = mf.finite_plate(TRACK, width=WIDTH, first=0.0, last=30.0, element=0.5, across=2)
    found = mf.compare(
        replace(scenario, case=replace(scenario.case, guideway=plate)), ["cdfm"], curve=False, memory=False, runs=1
    )
    assert found.reference.finest_element == pytest.approx(0.125)
    assert max(found.reference.movement.values()) < 1e-2
    assert found.rows[0].relative_l2["deflection"] < 0.05

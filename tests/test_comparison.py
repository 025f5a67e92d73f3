"""Methods compared on one case: what is compared, how times at equal error are read, and what is written."""

from __future__ import annotations

import io
import json
import math
import re
import subprocess
import sys
import time
from dataclasses import replace

import numpy as np
import pytest

import movingfrf as mf
from movingfrf.commands.main import main
from movingfrf.scenarios.reading import parse_scenario
from movingfrf.scenarios.scenario import shortened
from movingfrf.scenarios.stepped import elements
from movingfrf.studies.comparison.comparison import Point, peak_memory, ratios, time_at
from movingfrf.studies.comparison.convergence import converged, maximum_error, relative_l2
from movingfrf.studies.comparison.files import as_json, convergence_as_json, curve_as_csv, table_as_csv
from movingfrf.studies.comparison.methods import Case
from movingfrf.studies.comparison.page import render
from tests.test_scenario import LOADS, edited

# What takes seconds to compare is compared once.
pytestmark = pytest.mark.xdist_group("comparison")

# Long enough for the rough road to be met by both axles.
SHORT = edited(duration=1.6)
TIMOSHENKO = SHORT.replace("euler_bernoulli_beam", "timoshenko_beam").replace(
    "bending_damping = 0.0", "shear_stiffness = 4.0e8\nrotary_inertia = 5.5"
)
METHODS = ["moving-frf", "moving-frf-fe", "duhamel", "cdfm", "sim"]
BATCH = 4
QUANTITIES = ("contact_force", "deflection", "wheel_acceleration")


@pytest.fixture(scope="module")
def found():
    return mf.compare(parse_scenario(SHORT, name="short"), METHODS, batch=BATCH, memory=False)


def row(found, method):
    return next(row for row in found.rows if row.method == method)


def test_methods_of_different_descent_agree(found):
    """What remains of the moving FRF is the truncation at 70 Hz; the stepped methods have a step of 1 ms."""
    assert max(found.reference.movement.values()) < 5e-5
    assert row(found, "moving-frf").relative_l2["contact_force"] < 1e-4
    assert row(found, "moving-frf-fe").relative_l2["contact_force"] < 1e-4
    for method in ("duhamel", "cdfm", "sim"):
        assert row(found, method).relative_l2["contact_force"] < 1e-3
        assert row(found, method).relative_l2["wheel_acceleration"] < 5e-3
    for quantity in QUANTITIES:
        ours, theirs = (row(found, name).relative_l2[quantity] for name in ("cdfm", "sim"))
        assert ours == pytest.approx(theirs, rel=1e-3)


def test_the_window_stands_beside_the_whole_road(found):
    assert [row.method for row in found.rows] == [
        "moving-frf",
        "moving-frf-fe",
        "duhamel",
        "cdfm",
        "cdfm-window",
        "sim",
    ]


@pytest.mark.parametrize("method", ["cdfm", "sim", "duhamel", "cdfm-window"])
def test_errors_fall_with_the_square_of_the_step(found, method):
    """Between 4 ms and 1 ms, where neither the length of the elements nor the finest digits limit the error."""
    line = [p for p in found.curve if p.method == method and not p.element > 0.3]
    steps = np.array([p.time_step for p in line])
    errors = np.array([p.relative_l2["contact_force"] for p in line])
    chosen = (steps > 0.9e-3) & (steps < 4.1e-3)
    assert chosen.sum() == 3
    order = np.polyfit(np.log(steps[chosen]), np.log(errors[chosen]), 1)[0]
    assert order == pytest.approx(2.0, abs=0.2)


def test_ratios_are_of_total_times(found):
    least = row(found, "moving-frf")
    for one in found.rows:
        assert one.ratio == pytest.approx((one.setup_s + one.solve_s) / (least.setup_s + least.solve_s))
        assert one.setup_s > 0
        assert one.solve_s > 0


def test_times_at_equal_error_lie_on_the_lines(found):
    for target, times in found.equal_error.items():
        for method, seconds in times.items():
            points = [p for p in found.curve if p.method == method]
            reached = [p.seconds for p in points if p.relative_l2["contact_force"] <= target]
            if reached:
                assert seconds <= min(reached) * (1 + 1e-12)
                assert seconds >= min(p.seconds for p in points) * (1 - 1e-12)


def test_a_batch_shares_the_set_up(found):
    assert found.batch == BATCH
    for one in found.rows:
        assert one.batch_s == pytest.approx(one.setup_s / BATCH + one.solve_s)
    for target, times in found.equal_error_in_batch.items():
        for method, seconds in times.items():
            alone = found.equal_error[target][method]
            assert math.isnan(seconds) == math.isnan(alone)
            assert not seconds > alone
    # Both are mostly set-up: struck roads, a mesh and a run-in against 1.6 s of travel.
    assert found.equal_error_in_batch[1e-3]["duhamel"] < 0.5 * found.equal_error[1e-3]["duhamel"]
    over = ratios(found, 1e-3, in_batch=True)
    times = found.equal_error_in_batch[1e-3]
    assert over["cdfm"] == pytest.approx(times["cdfm"] / times["moving-frf"])


def test_reading_a_time_at_equal_error_in_a_batch():
    line = [one._replace(setup_s=0.8) for one in points([1e-1, 1e-2], [1.0, 1.0])]
    assert time_at(line, "a", "force", 1e-2) == pytest.approx(1.0)
    assert time_at(line, "a", "force", 1e-2, batch=4) == pytest.approx(0.4)


def points(errors, seconds, element=0.5):
    steps = 8e-3 / 2.0 ** np.arange(len(errors))
    return [
        Point("a", step, element, second, {"force": error})
        for step, second, error in zip(steps, seconds, errors, strict=True)
    ]


def test_reading_a_time_at_equal_error():
    """On a straight line in the logarithms: errors 1e-1, 1e-2, 1e-3 at 1, 2, 4 s are 10^-(1 + log2 t)."""
    line = points([1e-1, 1e-2, 1e-3], [1.0, 2.0, 4.0])
    assert time_at(line, "a", "force", 10**-1.5) == pytest.approx(2**0.5)
    assert time_at(line, "a", "force", 1e-2) == pytest.approx(2.0)
    assert time_at(line, "a", "force", 10.0) == pytest.approx(1.0)
    assert math.isnan(time_at(line, "a", "force", 1e-4))
    assert math.isnan(time_at(line, "b", "force", 1e-2))
    # A second mesh that levels off early but is quicker while it does not.
    other = points([1e-1, 8e-3, 8e-3], [0.5, 1.0, 2.0], element=1.0)
    assert time_at(line + other, "a", "force", 1e-2) < 1.0
    assert time_at(line + other, "a", "force", 1e-3) == pytest.approx(4.0)


def test_errors_are_those_of_the_worst_channel():
    wanted = {"force": np.array([[3.0, 1.0], [-4.0, 1.0]])}
    other = {"force": wanted["force"] + [[0.0, 0.1], [0.0, -0.1]]}
    assert relative_l2(other, wanted) == {"force": pytest.approx(0.1)}
    assert maximum_error(other, wanted) == {"force": pytest.approx(0.1)}
    other = {"force": wanted["force"] + [[0.0, 0.0], [0.4, 0.0]]}
    assert relative_l2(other, wanted) == {"force": pytest.approx(0.4 / 5)}
    assert maximum_error(other, wanted) == {"force": pytest.approx(0.1)}


def test_what_is_written(found):
    table = json.loads(as_json(found))
    assert set(METHODS) <= set(table)
    for figures in table.values():
        assert {"setup_s", "solve_s", "peak_bytes", "relative_l2"} <= set(figures)
        assert set(figures["relative_l2"]) == set(QUANTITIES)
    written = json.loads(convergence_as_json(found))
    assert written["converged_answer"]["movement_relative_l2"].keys() == set(QUANTITIES)
    assert written["ratio_at_equal_error"]["0.001"]["moving-frf"] == pytest.approx(1.0)
    assert len(written["error_over_time"]) == len(found.curve)
    assert written["batch"] == BATCH
    assert written["ratio_at_equal_error_in_batch"]["0.001"] == ratios(found, 1e-3, in_batch=True)
    assert all(table[name]["batch_s"] < table[name]["setup_s"] + table[name]["solve_s"] for name in METHODS)
    for text, count in (
        (table_as_csv(found), len(found.rows)),
        (curve_as_csv(found), len(found.curve)),
    ):
        read = np.genfromtxt(io.StringIO(text), delimiter=",", names=True, dtype=None, encoding="utf-8")
        assert read.size == count
        assert read["time_step_s"][0] > 0


def test_the_report_is_one_page(found):
    page = render(found)
    assert page.count("<svg") == 2
    assert not re.search(r'(?:src|href)="(?!#)|url\((?!#)|@import', page)
    for words in ("short: methods compared", "cdfm-window", "The converged answer", "over moving-frf", "elements"):
        assert words in page


def test_the_report_says_what_is_shared(found):
    page = render(found)
    for words in (
        "A batch of 4 cases that differ by their profile alone shares the set-up: ",
        "what the guideway and, with a vehicle, that imply: critical speed, modes, moving FRFs (moving-frf)",
        "the moving impulse response of the struck road (moving-frf-fe, duhamel)",
        "and, with a vehicle, the smooth run-in (cdfm, cdfm-window, sim)",
        "set-up / 4 + solving",
        "a case in a batch of 4",
        "in a batch of 4, the time over that of moving-frf",
    ):
        assert words in page
    rows = [one._replace(batch_s=math.nan) for one in found.rows]
    page = render(replace(found, batch=1, rows=rows, equal_error_in_batch={}))
    assert "The set-up counts in full." in page
    assert "batch" not in page


def test_the_converged_answer_knows_when_it_has_not_converged():
    """With abrupt loads the order is lower, and the movement says so."""
    smooth = parse_scenario(LOADS)
    abrupt = parse_scenario(LOADS.replace("ramp = 0.2", "ramp = 0.0"))
    brief = [shortened(one, 0.5) for one in (smooth, abrupt)]
    first, second = (converged(scenario).movement["deflection"] for scenario in brief)
    assert first < 1e-3
    assert second > first


def test_elements_are_round_shares_of_the_bending_length():
    assert elements(parse_scenario(SHORT).guideway) == [0.5, 0.25]


def test_memory_of_a_method_is_measured_in_a_process_of_its_own():
    scenario = parse_scenario(SHORT)
    found = peak_memory("cdfm-window", Case(scenario=scenario, time_step=1e-3, element=0.25))
    # Records of two contacts (force, deflection) and four degrees of freedom (motion, acceleration).
    assert 1600 * 12 * 8 < found < 64 * 2**20


@pytest.mark.parametrize(
    ("text", "methods", "message"),
    [
        (SHORT, ["cdfn"], "did you mean 'cdfm'"),
        (SHORT, ["newmark"], "with a vehicle are moving-frf.*got newmark"),
        (LOADS, ["moving-frf", "sim"], "with prescribed loads are moving-frf.*got sim"),
        (SHORT, [], "got none"),
        (TIMOSHENKO, None, "Euler–Bernoulli.*TimoshenkoBeam"),
    ],
)
def test_what_cannot_be_compared_is_refused(text, methods, message):
    with pytest.raises(ValueError, match=message):
        mf.compare(parse_scenario(text), methods)


def test_a_batch_has_at_least_one_case():
    with pytest.raises(ValueError, match="batch must be a whole number of at least 1, got 0"):
        mf.compare(parse_scenario(SHORT), batch=0)


def test_a_rigid_road_is_refused():
    scenario = parse_scenario(SHORT)
    rigid = mf.Scenario(
        name="rigid",
        text="",
        case=replace(scenario.case, guideway=mf.RigidGuideway()),
    )
    with pytest.raises(ValueError, match="got a RigidGuideway"):
        mf.compare(rigid)


def test_the_command(tmp_path, capsys):
    file = tmp_path / "loads.toml"
    file.write_text(LOADS)
    chosen = ["--methods", "moving-frf,newmark", "--batch", "3", "--no-curve", "--output", str(tmp_path / "out")]
    assert main(["compare", str(file), *chosen]) == 0
    told = capsys.readouterr().out
    for words in ("newmark-window", "set-up", "deflection, relative L2", "by their forces alone", "wrote"):
        assert words in told
    names = ["compare.csv", "compare.json", "convergence.csv", "convergence.json", "report.html"]
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == names
    table = json.loads((tmp_path / "out" / "compare.json").read_text())
    assert list(table) == ["moving-frf", "newmark", "newmark-window"]
    assert table["newmark"]["relative_l2"].keys() == {"deflection"}
    assert table["newmark"]["peak_bytes"] > 1000 * 8


def test_the_command_refuses_unknown_methods(tmp_path, capsys):
    file = tmp_path / "truck.toml"
    file.write_text(SHORT)
    assert main(["compare", str(file), "--methods", "moving-frf,cdmf", "--output", str(tmp_path / "out")]) == 2
    assert "cdmf" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_interruption_leaves_nothing(tmp_path):
    import signal

    file = tmp_path / "long.toml"
    file.write_text(edited(duration=600.0))
    output = tmp_path / "out"
    command = [sys.executable, "-m", "movingfrf", "compare", str(file), "--output", str(output)]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    until = time.monotonic() + 60
    while not output.exists() and time.monotonic() < until:
        time.sleep(0.05)
    time.sleep(1.0)
    process.send_signal(signal.SIGINT)
    _, told = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "interrupted" in told
    assert "Traceback" not in told
    assert not output.exists()

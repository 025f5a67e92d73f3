"""The command, as a user meets it: files, messages, exit statuses."""

import io
import json
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
import xarray as xr
from rich.console import Console

from movingfrf.commands.console import _head, cell_of, listing, measures_in_lines, print_table, print_tables
from movingfrf.commands.main import main
from movingfrf.reports.tables import Column, Row, Table
from movingfrf.results.labels import Measure
from movingfrf.scenarios.template import template
from tests.test_scenario import LOADS, edited

SHORT = edited(duration=2.0)


@pytest.fixture
def scenario(tmp_path):
    file = tmp_path / "truck.toml"
    file.write_text(SHORT)
    return file


def test_new_check_run(tmp_path, capsys):
    file = tmp_path / "case.toml"
    assert main(["new", str(file)]) == 0
    assert main(["new", str(file)]) == 0  # again, unchanged
    file.write_text(SHORT)
    assert main(["check", str(file)]) == 0
    told = capsys.readouterr().out
    for words in ("177.53 m/s", "10.332 Hz", "98.40 kN", "3.581 mm", "class A", "2000 of 0.001 s", "in order"):
        assert words in told
    assert main(["run", str(file)]) == 0
    told = capsys.readouterr().out
    for words in ("coefficient", "rear_wheel acceleration", "Findings", "solving", "result.nc"):
        assert words in told
    assert sorted(p.name for p in (tmp_path / "out" / "case").iterdir()) == [
        "report.html",
        "result.nc",
        "summary.json",
    ]


def test_without_a_report_none_of_an_earlier_run_stays(scenario, tmp_path, capsys):
    folder = tmp_path / "out"
    assert main(["run", str(scenario), "-o", str(folder)]) == 0
    (folder / "notes.txt").write_text("mine")
    whole = (folder / "result.nc").read_bytes()
    scenario.write_text(edited(duration=1.0))
    capsys.readouterr()
    assert main(["run", str(scenario), "-o", str(folder), "--no-report"]) == 0
    assert "report.html" not in capsys.readouterr().out
    assert sorted(file.name for file in folder.iterdir()) == ["notes.txt", "result.nc", "summary.json"]
    assert (folder / "result.nc").read_bytes() != whole


def test_new_prints_without_a_file_and_protects_what_exists(tmp_path, capsys):
    assert main(["new"]) == 0
    assert "[guideway.beam]" in capsys.readouterr().out
    assert main(["new", "--loads"]) == 0
    assert "[[loads.force]]" in capsys.readouterr().out
    (tmp_path / "mine.toml").write_text("mine")
    assert main(["new", str(tmp_path / "mine.toml")]) == 2
    assert (tmp_path / "mine.toml").read_text() == "mine"
    assert main(["new", str(tmp_path / "mine.toml"), "--force"]) == 0


def test_the_result_reopens_equal_and_equal_input_gives_equal_bytes(scenario, tmp_path):
    for name in ("a", "b"):
        assert main(["run", str(scenario), "--output", str(tmp_path / name)]) == 0
        time.sleep(1.1 if name == "a" else 0)  # a clock in a file would show
    for file in ("result.nc", "summary.json", "report.html"):
        assert (tmp_path / "a" / file).read_bytes() == (tmp_path / "b" / file).read_bytes(), file
    from movingfrf import read_scenario

    direct = read_scenario(scenario).run()
    with xr.open_dataset(tmp_path / "a" / "result.nc") as reopened:
        xr.testing.assert_identical(reopened.load(), direct)
    summary = json.loads((tmp_path / "a" / "summary.json").read_text())
    force = next(
        m for m in summary["measures"] if m["quantity"] == "contact 1 force" and m["name"] == "dynamic rms"
    )
    assert force["value"] == pytest.approx(np.sqrt((direct.contact_force[:, 1] ** 2).mean().item()), rel=1e-12)
    assert force["units"] == "N"


def test_names_with_brackets_and_colons(tmp_path, capsys):
    file = tmp_path / "a [red]x [b] :smile:.toml"
    assert main(["new", str(file)]) == 0
    file.write_text(SHORT)
    assert main(["check", str(file)]) == 0
    assert main(["run", str(file), "--output", str(tmp_path / "o [/b]")]) == 0
    told = capsys.readouterr().out
    assert str(file) in told
    assert str(tmp_path / "o [/b]" / "result.nc") in told


def test_prescribed_loads_run_too(tmp_path, capsys):
    file = tmp_path / "loads.toml"
    file.write_text(LOADS)
    assert main(["check", str(file)]) == 0
    assert main(["run", str(file), "--output", str(tmp_path / "out")]) == 0
    with xr.open_dataset(tmp_path / "out" / "result.nc") as result:
        assert result.deflection.dims == ("time", "point")
    assert "peak" in capsys.readouterr().out


def test_an_earlier_result_and_other_files_survive_a_failed_run(scenario, tmp_path, monkeypatch, capsys):
    output = tmp_path / "out"
    assert main(["run", str(scenario), "--output", str(output)]) == 0
    (output / "notes.txt").write_text("mine")
    before = {file.name: file.read_bytes() for file in output.iterdir()}

    def fails(*_args, **_kwargs):
        raise OSError(28, "No space left on device")

    import movingfrf.reports.result

    monkeypatch.setattr(movingfrf.reports.result, "render", fails)
    scenario.write_text(edited(duration=3.0))
    assert main(["run", str(scenario), "--output", str(output)]) == 2
    assert {file.name: file.read_bytes() for file in output.iterdir()} == before
    assert "No space left" in capsys.readouterr().err
    assert main(["run", str(scenario), "--output", str(tmp_path / "fresh" / "deep")]) == 2
    assert not (tmp_path / "fresh").exists()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["run"], "FILE"),
        (["runn", "x"], "run"),
        (["run", "{scenario}", "--outptu", "x"], "--output"),
        (["run", "none.toml"], "No such file"),
        (["check", "{folder}"], "cannot be read"),
        (["run", "{scenario}", "--output", "{scenario}"], "File exists"),
        (["run", "{scenario}", "--output", "/proc/nowhere"], "cannot read or write"),
    ],
)
def test_refusals_are_one_message_and_status_2(arguments, message, scenario, capsys):
    filled = [word.format(scenario=scenario, folder=scenario.parent) for word in arguments]
    assert main(filled) == 2
    told = capsys.readouterr()
    assert message in told.err
    assert "Traceback" not in told.err
    assert told.out == ""


def test_an_unsolvable_case_is_refused_with_frequency_and_speed(tmp_path, capsys):
    file = tmp_path / "resonant.toml"
    # An undamped road driven at exactly its critical speed.
    critical = (2 * np.sqrt(8.0e6 * 1.573e7) / 711.9) ** 0.5
    file.write_text(edited(duration=1.0, speed=repr(float(critical)), damping=0.0))
    assert main(["run", str(file), "--output", str(tmp_path / "out")]) == 2
    told = capsys.readouterr().err
    assert "Hz" in told
    assert "177.5" in told
    assert not (tmp_path / "out").exists()


def test_interruption_leaves_nothing(tmp_path):
    file = tmp_path / "long.toml"
    file.write_text(edited(duration=1200.0))
    output = tmp_path / "out"
    command = [sys.executable, "-m", "movingfrf", "run", str(file), "--output", str(output)]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.PIPE, env=os.environ, text=True)
    until = time.monotonic() + 60
    while not output.exists() and time.monotonic() < until:
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    _, told = process.communicate(timeout=60)
    assert process.returncode == 130, told
    assert "interrupted" in told
    assert "Traceback" not in told
    assert not output.exists()


@pytest.mark.parametrize("width", [32, 60, 80, 200])
def test_a_printed_table_fits_and_loses_nothing(width):
    """No line is wider than the console, and every word of a head and every number is there, whole."""
    heads = ["resolution [m]", "dynamic load coefficient", *(f"acceleration of wheel {n} [m/s²]" for n in range(6))]
    rows = {f"contact {n} force": [f"{1.234e5 + n + 10 * column:.7g}" for column in range(8)] for n in range(3)}
    written = io.StringIO()
    table = Table("", "contact", [Column(head, "") for head in heads], [Row(*row) for row in rows.items()])
    print_tables(Console(width=width, file=written, markup=False), [table])
    told = written.getvalue()
    assert max(map(len, told.splitlines())) <= width
    assert "…" not in told
    words = told.split()
    assert set(words) >= {word for head in heads for word in head.split()}
    assert all(words.count(cell) == 1 for cells in rows.values() for cell in cells)
    pieces = words.count("contact")
    assert pieces > 3 if width == 32 else True
    assert width < 200 or told.count("\n\n") == 1


def printed(table, width):
    written = io.StringIO()
    print_table(Console(width=width, file=written, markup=False), table)
    return written.getvalue()


@pytest.mark.parametrize(("width", "pieces"), [(32, 3), (45, 2), (60, 1)])
def test_measures_line_by_line_lose_no_digit(width, pieces):
    """Where value, unit and standard do not fit beside each other they follow below: no 9.84e for 9.84e+04."""
    found = [Measure("contact 0 force", f"root mean square {n}", 9.84e4, "N", "Cebon 1999") for n in range(3)]
    told = printed(measures_in_lines(found), width)
    assert max(map(len, told.splitlines())) <= width
    assert told.count("9.84e+04") == told.count("Cebon 1999") == 3
    assert told.count("contact 0 force") == told.count("\n\n") + 1 == pieces


def test_a_list_of_names_and_values_keeps_its_letters_and_wraps():
    told = printed(listing("Roughness", [("spectrum", "1.6e−05 m³ at 0.1 cycle/m, × 10⁻⁶")]), 30)
    assert told.split() == "Roughness spectrum 1.6e−05 m³ at 0.1 cycle/m, × 10⁻⁶".split()
    assert max(map(len, told.splitlines())) <= 30


def test_numbers_that_are_none_or_never():
    """A rate of 1e-46 a second says never; what has no value is a dash; what has no dimension has no unit."""
    assert cell_of(Measure("x", "lift-offs", 2.03e-46, "1/s")) == "< 1e-12"
    assert cell_of(Measure("x", "share", 0.0, "1")) == "0"
    assert cell_of(Measure("x", "rms", 2.03e-46, "m")) == "2.03e-46"
    assert cell_of(Measure("x", "crossing rate", float("nan"), "1/s")) == "–"
    assert _head(Column("dynamic load coefficient", "1")) == "dynamic load coefficient"
    assert _head(Column("static", "N")) == "static [N]"


def test_check_says_of_an_unstable_case_that_it_has_no_answer(tmp_path, capsys):
    """It describes all that there is to describe, and ends as a run of it would."""
    text = template("scenario").replace("speed = 10.0 ", "speed = 260.0 ").replace("truncation = 70.0", "# ")
    for old, new in (
        ("duration = 24.0", "duration = 0.5"),
        ("damping = 3.0e4 ", "damping = 3.0e3 "),
        ("suspension_damping = [3.0e4, 4.0e4]", "suspension_damping = [3.0e3, 4.0e3]"),
        ("tyre_damping = [3.9e3, 4.3e3]", "tyre_damping = [0.0, 0.0]"),
    ):
        text = text.replace(old, new)
    (tmp_path / "fast.toml").write_text(text)
    assert main(["check", str(tmp_path / "fast.toml")]) == 2
    told = capsys.readouterr()
    for words in ("Vibrations on a rigid road", "Contacts at rest", "above the critical speed", "time steps"):
        assert words in told.out
    assert "unstable together at 260 m/s" in told.err
    assert "in order" not in told.out

"""The guard of speed: cases, the file of ratios and what calls it agree. Nothing is timed here."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
from benchmarks import ratios, speed
from benchmarks.cases import CASES, SCENARIO
from benchmarks.ratios import Row, tables, written
from benchmarks.worker import KINDS, Taken, Worker

from movingfrf.scenarios.template import template

ROOT = Path(__file__).parents[1]
BOTH = ("compiled", "numpy")
TEXT = ratios.FILE.read_text(encoding="utf-8")


def row(case="hour", kind="numpy", **taken) -> Row:
    expected = tables()[case]
    values = (
        {"seconds": 1.0, "floor": 1.0} | {name: expected[kind].get(name) for name in ("ratio", "bytes")} | taken
    )
    return Row(case, kind, Taken(**values), expected["words"], expected[kind])


def test_every_row_has_a_case_and_every_case_a_row():
    assert list(tables()) == list(CASES)
    assert len({table["words"] for table in tables().values()}) == len(CASES)
    for case, table in tables().items():
        assert set(table) - {"long"} == {"words", *BOTH}, case
        for kind in BOTH:
            assert set(table[kind]) - {"at_most", "bytes", "bytes_at_most"} == {"ratio"}, case
            assert min(table[kind].values()) > 0
    assert tables()["hour"].keys() >= {"long"}
    assert tables()["hour"]["numpy"].keys() >= {"bytes", "bytes_at_most"}


def test_the_reference_case_is_what_the_package_writes():
    assert SCENARIO.text == template("scenario")
    assert CASES["reference"]()().drop_attrs().identical(SCENARIO.run().drop_attrs())


def test_makefile_and_pipeline_call_what_there_is():
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    for target in ("bench", "speed", "against", "workers", "kills"):
        (recipe,) = re.findall(rf"^{target}: .*\n((?:\t.*\n)+)", makefile, re.MULTILINE)
        assert f"-m benchmarks.{target}" in recipe
        assert (ROOT / "benchmarks" / f"{target}.py").exists()
        assert target in makefile.partition(".PHONY:")[2].partition("\n")[0].split()
    assert "make speed || make speed" in (ROOT / ".ci" / "run").read_text(encoding="utf-8")


def test_what_is_written_changes_numbers_alone():
    assert written(TEXT, [row(case, kind) for case in CASES for kind in BOTH]) == TEXT
    new = written(TEXT, [row("reference", "compiled", ratio=1234.56), row("hour", ratio=0.98765, bytes=201.4)])
    differ = [after for before, after in zip(TEXT.splitlines(), new.splitlines(), strict=True) if before != after]
    aims = tables()["hour"]["numpy"]
    assert differ == [
        f"compiled = {{ ratio = 1230, at_most = {tables()['reference']['compiled']['at_most']:g} }}",
        "numpy = {{ ratio = 0.988, at_most = {at_most:g}, bytes = 201, bytes_at_most = {bytes_at_most:g} }}".format(
            **aims
        ),
    ]


def test_grown_by_half_is_slower():
    expected = tables()["hour"]["numpy"]
    assert row(ratio=1.49 * expected["ratio"]).grown == ""
    assert row(ratio=1.51 * expected["ratio"]).grown.startswith("hour (numpy): ratio ")
    assert f", expected {expected['bytes']:g}" in row(bytes=1.51 * expected["bytes"]).grown


@pytest.fixture
def answers(monkeypatch):
    """Stand in for processes that time: case → factors on the ratio in the file, one each time it is asked for."""
    factors, asked = {}, []

    class Told:
        def __init__(self, kind):
            self.kind = kind

        def floor(self, case):
            asked.append((case, self.kind))
            left = factors.get(case, [])
            expected = tables()[case][self.kind]
            return Taken(1.0, 1.0, expected["ratio"] * (left.pop(0) if left else 1.0), expected.get("bytes"))

        def close(self):
            asked.append("end")

    monkeypatch.setattr(ratios, "Worker", Told)
    monkeypatch.setattr(ratios, "KINDS", BOTH)
    return factors, asked


def test_what_is_slow_once_is_asked_again_and_what_is_slow_twice_counts(answers, capsys):
    factors, asked = answers
    factors |= {"reference": [2.0], "transfer": [2.0, 2.0]}
    assert speed.main(["reference", "transfer"]) == 1
    assert asked[:6] == [(case, kind) for case in ("reference", "transfer") for kind in ("compiled", *BOTH)]
    told = capsys.readouterr().out
    expected = tables()["transfer"]["compiled"]["ratio"]
    assert f"slower than it was: transfer (compiled): ratio {2 * expected:.3g}, expected {expected:g}\n" in told
    assert "reference (" not in told
    factors["reference"] = [2.0]
    assert speed.main(["reference"]) == 0


def test_what_has_become_faster_is_said(answers, capsys):
    answers[0]["reference"] = [0.5]
    assert speed.main(["reference"]) == 0
    assert "UPDATE=1` keeps it so: reference (compiled)\n" in capsys.readouterr().out


def test_long_rows_are_left_to_updates_and_get_processes_of_their_own(answers, monkeypatch, tmp_path, capsys):
    long = {case for case, table in tables().items() if table.get("long")}
    _, asked = answers
    assert speed.main([]) == 0
    assert {case for case, *_ in asked} - {"e"} == set(CASES) - long
    asked.clear()
    file = tmp_path / "ratios.toml"
    file.write_text(TEXT, encoding="utf-8")
    monkeypatch.setattr(speed, "FILE", file)
    answers[0]["reference"] = [0.5]
    assert speed.main(["--update"]) == 0
    assert asked.count("end") == 2 + 2 * len(long)
    assert file.read_text(encoding="utf-8") != TEXT
    assert "\n".join(TEXT.splitlines()[9:]) in file.read_text(encoding="utf-8")


def test_a_row_that_is_not_there_is_refused(capsys):
    with pytest.raises(SystemExit):
        speed.main(["referense"])
    assert "no row is called referense; there are reference, " in capsys.readouterr().err


def test_a_process_answers_or_its_end_is_said(capfd):
    worker = Worker("numpy")
    assert len(worker.once("frf_euler_bernoulli")) == 2
    with pytest.raises(SystemExit, match="once nothing: its process has ended"):
        worker.once("nothing")
    worker.close()
    assert "KeyError: 'nothing'" in capfd.readouterr().err


@pytest.mark.parametrize("kind", KINDS)
def test_a_process_has_numba_or_none(kind):
    code = (
        "import io, sys; from importlib.util import find_spec; from benchmarks.worker import main;"
        f"sys.argv[1:], sys.stdin = ['{kind}'], io.StringIO(); main(); print(bool(find_spec('numba')))"
    )
    ran = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert ran.stdout == f"{kind == 'compiled'}\n"

"""What is said of a scenario that is no TOML: the line, and what to write instead where that is plain."""

from __future__ import annotations

import pytest

import movingfrf as mf
from movingfrf.scenarios.reading import parse_scenario
from movingfrf.scenarios.template import template

SCENARIO = template("scenario")
BACKSLASH = """; a backslash has a meaning in "…": write / in its place, or '…'"""


def said(text):
    with pytest.raises(mf.ScenarioError) as caught:
        parse_scenario(text)
    (fault,) = caught.value.faults
    return fault.message


@pytest.mark.parametrize(
    ("line", "hint"),
    [
        ("duration = 20,0", "; a decimal point is a point: 20.0"),
        ("speed = -3,25  # m/s", "; a decimal point is a point: -3.25"),
        ("speed = 1,000.0", "; a number has no commas; 1_000 is one"),
        ("speed = .5", "; a number begins with a digit: 0.5"),
        ("speed = 5.", "; a number ends with a digit: 5.0"),
        ("speed = 10 m/s", "; behind a number stands no unit, unless in a comment: # m/s"),
        ("speed: 10", "; between a key and its value stands =: speed = …"),
        ('file = "C:\\data\\x.mat"', BACKSLASH),
        ('file = "C:\\Users\\x.mat"', BACKSLASH),
        ('file = "road.csv', "; a quotation mark is missing"),
        ('kind = half_car"', "; a quotation mark is missing"),
        ("kind = half_car", '; a text stands in quotation marks: "…"'),
        ("travels = True", "; true and false begin with small letters"),
        ("speed = 1\nspeed = 2", "; speed stands there already: a key stands once in its table"),
        ("[here]", "; [here] stands there already, or here is no table: a table stands once"),
        ("[there", "; a bracket is missing: ]"),
        # Nothing is plain here.
        ("speed", ""),
        ("[there] speed = 1", ""),
    ],
)
@pytest.mark.parametrize("end", ["", "\n", "\r\nlast = 1\r\n"])
def test_what_is_no_toml(line, hint, end):
    number = 3 + line.count("\n")
    message = said(f"# A case\n[here]\n{line}{end}")
    assert message.startswith("is not TOML: ")
    assert f"(at line {number}, " in message or "(at end of document)" in message
    assert message.endswith(")" + hint), message


def test_a_backslash_that_toml_takes_for_a_tab():
    text = '[vehicle]\nkind = "vehicle_file"\nfile = "C:\\temp\\road.mat"\n' + SCENARIO[SCENARIO.index("[run]") :]
    with pytest.raises(mf.ScenarioError) as caught:
        parse_scenario(text)
    (message,) = [fault.message for fault in caught.value.faults if fault.name == "vehicle.file"]
    assert message.endswith(BACKSLASH)


@pytest.mark.parametrize("encoding", ["cp1252", "latin-1", "cp850"])
def test_another_encoding_is_named_with_its_line(encoding, tmp_path):
    file = tmp_path / "case.toml"
    file.write_bytes(f"# A case\n# Straße\n{SCENARIO}".encode(encoding, "replace"))
    with pytest.raises(mf.ScenarioError, match=r"is not UTF-8 \(line 2\): save it as UTF-8"):
        mf.read_scenario(file)
    with pytest.raises(ValueError, match=r"case.toml: is not UTF-8 \(line 2\): save it as UTF-8"):
        mf.read_vehicle(file)


def test_what_is_no_text_is_called_so(tmp_path):
    for content in (bytes(range(256)), b"\xff\xfea"):
        (tmp_path / "case.toml").write_bytes(content)
        with pytest.raises(mf.ScenarioError, match="is not a text file"):
            mf.read_scenario(tmp_path / "case.toml")

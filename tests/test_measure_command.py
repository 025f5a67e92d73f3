"""The command `movingfrf measure`: the same numbers as from Python, in a table, as JSON and as CSV."""

from __future__ import annotations

import csv
import json
import re
from pathlib import Path

import numpy as np
import pytest

import movingfrf as mf
from movingfrf.commands.main import main
from movingfrf.results.files import load, save


@pytest.fixture(scope="module")
def result():
    truck = mf.half_car(
        body_mass=17_735.0,
        pitch_inertia=1.47e5,
        wheel_masses=(1500.0, 1000.0),
        suspension_stiffness=(2.47e6, 4.23e6),
        suspension_damping=(3e4, 4e4),
        tyre_stiffness=(3.74e6, 4.60e6),
        tyre_damping=(3.9e3, 4.3e3),
        axles=(2.216, -2.054),
    )
    road = mf.realise(mf.IsoRoad.of_class("A"), length=60.0, seed=1)
    return mf.simulate(mf.RigidGuideway(), truck, road, speed=15.0, duration=3.0, start=5.0)


@pytest.fixture(scope="module")
def file(result, tmp_path_factory):
    path = tmp_path_factory.mktemp("measured") / "result.nc"
    save(result, path)
    return path


def test_table(result, file, capsys):
    assert main(["measure", str(file)]) == 0
    told = capsys.readouterr().out
    for measure in mf.assess(result):
        named = re.sub(
            r"^contact (\d)", lambda found: f"{found[0]} ({'front rear'.split()[int(found[1])]})", measure.quantity
        )
        assert named in told
        assert f"{measure.name} " in told
        assert f"{measure.value:.4g}" in told
    assert "…" not in told
    assert "ISO 2631-1, Wk" in told


def test_files_hold_all_digits_and_units(file, tmp_path):
    wanted = [measure._asdict() for measure in mf.assess(load(file), slope=4.0)]
    options = ["measure", str(file), "--slope", "4", "--output"]
    assert main([*options, str(tmp_path / "m.json")]) == 0
    content = json.loads((tmp_path / "m.json").read_text(encoding="utf-8"))
    assert content["measures"] == wanted
    assert content["settings"]["speed"] == 15.0
    assert main([*options, str(tmp_path / "m.csv")]) == 0
    with (tmp_path / "m.csv").open(encoding="utf-8", newline="") as text:
        rows = list(csv.DictReader(text))
    assert [row | {"value": float(row["value"])} for row in rows] == wanted


def test_verdicts_and_a_later_start(file, tmp_path, capsys):
    options = ["--dof", "bounce", "--from", "1", "--output", str(tmp_path / "m.json")]
    assert main(["measure", str(file), *options]) == 0
    told = capsys.readouterr().out
    wanted = mf.assess(load(file), dofs=["bounce"], since=1.0)
    noted = [measure for measure in wanted if measure.note]
    assert len(noted) == 4
    for measure in noted:
        assert f"- {measure.quantity}, {measure.name}: {measure.note}\n" in told
    content = json.loads((tmp_path / "m.json").read_text(encoding="utf-8"))
    assert content["measures"] == [measure._asdict() for measure in wanted]
    assert content["settings"]["measured_from"] == 1.0


def test_what_has_no_answer_is_a_dash(result, tmp_path, capsys):
    """A vehicle of 4.27 m in a record of 1.5 m."""
    save(result.isel(time=slice(0, 100)), tmp_path / "short.nc")
    assert main(["measure", str(tmp_path / "short.nc")]) == 0
    told = capsys.readouterr().out
    assert re.search(r"ΣP⁴ over static +–", told)
    assert "path 0 wear, 95th percentile of ΣP⁴ over static: the record is too short" in told
    assert "dynamic load coefficient" in told


def test_choice(file, tmp_path):
    options = ["--contact", "1", "--dof", "pitch", "--dof", "bounce", "--weighting", "Wd"]
    assert main(["measure", str(file), *options, "--output", str(tmp_path / "m.csv")]) == 0
    text = (tmp_path / "m.csv").read_text(encoding="utf-8")
    assert {line.split(",")[0] for line in text.splitlines()[1:]} == {
        "contact 1 force",
        "contact 1 deflection",
        "pitch acceleration",
        "bounce acceleration",
    }
    assert "bounce acceleration,weighted rms" in text
    assert '"ISO 2631-1, Wd"' in text


def test_a_result_reopens_as_it_was(result, file):
    assert load(file).identical(result)


def test_refusals(result, file, tmp_path, capsys):
    (tmp_path / "no.nc").write_text("nothing")
    save(result.drop_vars("contact_force"), tmp_path / "force.nc")
    save(result.drop_vars("deflection"), tmp_path / "other.nc")
    lost = result.drop_vars(["acceleration", "motion"])
    del lost.attrs["time_step"]
    save(lost, tmp_path / "lost.nc")
    for value, name, place in (("nan", "contact_force", (250, 1)), ("inf", "acceleration", (0, 1))):
        broken = result.copy(deep=True)
        broken[name][place] = float(value)
        save(broken, tmp_path / f"{value}.nc")
    save(result.assign_attrs(movingfrf="x").drop_attrs(), tmp_path / "alien.nc")
    force = np.ones((100, 1))
    save(mf.moving_loads(mf.RigidGuideway(), force, [0.0], speed=5.0), tmp_path / "loads.nc")
    for arguments, message in (
        ([str(tmp_path / "none.nc")], "none.nc: No such file"),
        ([str(tmp_path / "no.nc")], "no.nc: is not a netCDF file"),
        ([str(tmp_path / "other.nc")], "other.nc: lacks deflection"),
        ([str(tmp_path / "force.nc")], "force.nc: lacks contact_force"),
        ([str(tmp_path / "lost.nc")], "lost.nc: lacks the attribute time_step; lacks motion, acceleration"),
        ([str(tmp_path / "nan.nc")], "nan.nc: has contact_force nan at time 0.25 s, contact 1"),
        ([str(tmp_path / "inf.nc")], "inf.nc: has acceleration inf at time 0 s, dof pitch"),
        ([str(tmp_path / "loads.nc")], "result must be the coupled response of a vehicle, with contact_force"),
        ([str(tmp_path / "alien.nc")], "alien.nc: is no result of movingfrf"),
        ([str(file), "--from", "3"], "since must leave at least two samples, so be 2.998 s at most, got 3.0 s"),
        ([str(file), "--from", "-1"], "since must not be negative, got -1.0 s"),
        ([str(file), "--slope", "-3"], "slope must be positive, got -3.0\n"),
        ([str(file), "--output", "m.txt"], "m.txt: must end in .json or .csv"),
        ([str(file), "--contact", "2"], "contacts must be among 0 (front), 1 (rear), got 2"),
        (
            [str(file), "--dof", "nose"],
            "dofs must be among 0 (bounce), 1 (pitch), 2 (front_wheel), 3 (rear_wheel), got 'nose'",
        ),
    ):
        assert main(["measure", *arguments]) == 2
        assert message in capsys.readouterr().err


def test_the_example_of_the_documentation_runs(capsys):
    text = (Path(__file__).parents[1] / "docs" / "measures.md").read_text(encoding="utf-8")
    (code,) = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    exec(code, {})
    told = capsys.readouterr().out
    assert told.count("Cebon 1999") == 2
    # Every name of the tables is there.
    names = re.findall(r"`([a-z_]+)(?:\(…\)\.\w+)?`", "".join(re.findall(r"^\|.*\| (.*?) \|$", text, re.MULTILINE)))
    assert len(names) > 25
    assert [name for name in names if not hasattr(mf, name)] == []


def test_contacts_and_degrees_of_freedom_by_name_or_number(result, file, tmp_path):
    def measured(*options):
        assert main(["measure", str(file), *options, "--output", str(tmp_path / "m.json")]) == 0
        return json.loads((tmp_path / "m.json").read_text(encoding="utf-8"))["measures"]

    assert measured("--contact", "Rear", "--dof", "BOUNCE") == measured("--contact", "1", "--dof", "0")
    assert {one["quantity"].split()[1] for one in measured("--contact", "rear", "--dof", "pitch")[:-8]} == {"1"}
    by = [
        mf.assess(result, contacts=chosen, dofs=seat) for chosen, seat in ((1, 0), ("rear", "Bounce"), ([1], [0]))
    ]
    assert by[0] == by[1] == by[2]
    assert mf.comfort(result, "Front Wheel") == mf.comfort(result, 2) == mf.comfort(result, "front_wheel")

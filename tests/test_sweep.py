"""Many cases: each is the one that `run` computes, whatever order, workers and chunks; and what is refused."""

from __future__ import annotations

import csv
import doctest
import io
import os
import re
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import movingfrf as mf
from movingfrf._basics.toml_file import as_toml, tables_of
from movingfrf.metrics.measures import usual
from movingfrf.scenarios.reading import parse_scenario
from movingfrf.scenarios.template import template
from movingfrf.scenarios.variants import unit_of
from movingfrf.studies.sweep import chunks
from movingfrf.studies.sweep.files import as_csv
from movingfrf.studies.sweep.page.page import render
from movingfrf.studies.sweep.page.tables import findings, tables
from movingfrf.studies.sweep.words import axes_in, part_in
from tests.sweep_parts import FILE, TEXT, command, scenario_in

pytestmark = pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")


@pytest.fixture
def truck(tmp_path):
    return scenario_in(tmp_path)


AXES = {
    "speed": {"run.speed": [9.0, 10.0, 11.0]},
    "a number in a list": {"vehicle.tyre_stiffness.1": np.linspace(4e6, 5e6, 3)},
    "guideway": {"guideway.foundation.stiffness": [4e6, 8e6], "guideway.beam.mass": [700.0]},
    "class and seed": {"roughness.road_class": ["A", "C"], "roughness.seed": range(2)},
    "linked": {("vehicle.suspension_stiffness.0", "vehicle.suspension_stiffness.1"): [(2e6, 4e6), (3e6, 5e6)]},
    "a whole table": {"roughness": [FILE, {"kind": "bump", "height": 0.01, "width": 1.0, "at": 4.0}]},
    "vehicles": {"vehicle": ["half_truck", "golden_car", "other.toml"]},
    "a key that is not written": {"run.solved_step": [2e-3, 4e-3]},
}


def alone(truck, changes):
    """Solve a case by itself, from a text in which the values stand."""
    tables = tables_at(truck)
    for path, value in changes.items():
        *above, last = path.split(".")
        there = tables
        for name in above:
            there = there[int(name)] if isinstance(there, list) else there[name]
        there[int(last) if isinstance(there, list) else last] = value
    folder = truck.parent
    return parse_scenario(as_toml(tables), folder=folder).run()


def tables_at(file):
    return tables_of(file.read_text())


def whole(value, truck):
    """Replace what stands for a vehicle by its table."""
    if value == "other.toml":
        return tables_at(truck.parent / "other.toml")["vehicle"]
    return {"kind": "catalogue", "name": value} if isinstance(value, str) else value


@pytest.mark.parametrize("axis", AXES)
def test_a_case_is_what_run_computes(axis, truck):
    table = mf.sweep(truck, AXES[axis])
    dims = table.status.dims
    for places in np.ndindex(table.status.shape):
        changes = {}
        for place, (key, values) in zip(places, AXES[axis].items(), strict=True):
            if isinstance(key, tuple):
                changes |= dict(zip(key, values[place], strict=True))
            else:
                value = np.asarray(values, object)[place] if not isinstance(values, np.ndarray) else values[place]
                changes[key] = whole(value, truck) if key == "vehicle" else value
        changes = {
            path: value.item() if isinstance(value, np.generic) else value for path, value in changes.items()
        }
        case = table.isel(dict(zip(dims, places, strict=True)))
        assert case.status.item() == ""
        # In the steps that were found for it, which the table tells.
        result = alone(truck, {**changes, "run.time_step": case.time_step.item()})
        # By hand, what is easily said; and all of them as `run` reports them, in whatever order.
        sizes = dict(result.sizes)
        rms = np.sqrt((result.contact_force.values**2).mean(axis=0))
        assert case.contact_force_rms.values[: sizes["contact"]] == pytest.approx(rms, rel=1e-9)
        rms = np.sqrt((result.acceleration.values**2).mean(axis=0))
        assert case.acceleration_rms.values[: sizes["dof"]] == pytest.approx(rms, rel=1e-9)
        reported = [measure.value for measure in mf.measures(result)]
        found = [
            case[name].values[number]
            for place in ("force", "deflection", "acceleration")
            for number in range(sizes["dof" if place == "acceleration" else "contact"])
            for name in usual()
            if place in name or (place == "force" and "load" in name)
        ]
        assert sorted(found) == pytest.approx(sorted(reported), rel=1e-9)
        for name, one in usual().items():
            assert np.isnan(case[name].values[sizes[one.place] :]).all()


def test_the_page_runs():
    page = Path(__file__).parents[1] / "docs" / "sweeps.md"
    found = doctest.testfile(str(page), module_relative=False)
    assert found.attempted > 4
    assert found.failed == 0


@pytest.mark.parametrize(
    ("path", "unit"),
    [
        ("run.speed", "m/s"),
        ("run.speed_kmh", "km/h"),
        ("vehicle.tyre_stiffness.1", "N/m"),
        ("guideway.foundation.damping", "N s/m²"),
        ("guideway.beam.mass", "kg/m"),
        ("roughness.seed", ""),
        ("roughness.road_class", ""),
        ("vehicle", ""),
        ("vehicle.none", ""),
        ("none.speed", ""),
    ],
)
def test_units_of_keys(path, unit):
    assert unit_of(tables_of(TEXT), path) == unit


def test_units_of_keys_in_lists_of_tables():
    axle = {"kind": "axle", "position": 1.0, "mass": 700.0}
    tables = {"vehicle": {"kind": "truck", "units": [{"mass": 4500.0, "axles": [axle]}]}}
    assert unit_of(tables, "vehicle.units.0.axles.0.mass") == "kg"
    assert unit_of(tables, "vehicle.units.0.axles.1.mass") == ""


def test_names_and_units(truck):
    table = mf.sweep(truck, {"run.speed": [9.0, 10.0], "vehicle": ["half_truck", "golden_car"]})
    assert table.contact_force_rms.dims == ("speed", "vehicle", "contact")
    assert table.contact_name.values[0].tolist() == [["front", "rear"], ["wheel", ""]]
    assert {name: table[name].attrs["units"] for name in ("deflection_rms", "acceleration_rms")} == {
        "deflection_rms": "m",
        "acceleration_rms": "m/s2 or rad/s2",
    }
    assert set(usual()) <= set(table.data_vars)
    table.to_netcdf(truck.parent / "sweep.nc", engine="h5netcdf")
    with xr.open_dataset(truck.parent / "sweep.nc", engine="h5netcdf") as again:
        np.testing.assert_array_equal(again.contact_force_rms, table.contact_force_rms)


def test_measures_that_are_asked_for(truck):
    table = mf.sweep(truck, {"run.speed": [9.0]}, measures=["static_load", "dynamic_load_coefficient"])
    assert set(table.data_vars) == {"static_load", "dynamic_load_coefficient", "time_step", "status", "findings"}
    assert "dof" not in table.dims
    coarse = mf.sweep(truck, {"run.speed": [9.0]}, measures="contact_force_rms", time_step=5e-3)
    (result,) = [replace_step(truck, 9.0, 5e-3)]
    assert coarse.contact_force_rms.values[0] == pytest.approx(
        np.sqrt((result.contact_force.values**2).mean(axis=0)), rel=1e-9
    )


def replace_step(truck, speed, step):
    scenario = mf.read_scenario(truck)
    text = scenario.text.replace("speed = 10.0", f"speed = {speed}").replace(
        "time_step = 0.001", f"time_step = {step}"
    )
    return parse_scenario(text, folder=truck.parent).run()


def test_steps_that_do_not_show_all_of_it(truck):
    """Measures are of the response as it was solved, as those of `run` are, and not of what 50 ms show of it."""
    table = mf.sweep(truck, {"run.speed": [10.0]}, time_step=0.05)
    result = replace_step(truck, 10.0, 0.05)
    assert "solved_contact_force" in result
    reported = [measure.value for measure in mf.measures(result)]
    found = [value for name in usual() for value in table[name].values.ravel()]
    assert sorted(found) == pytest.approx(sorted(reported), rel=1e-9)
    fine = mf.sweep(truck, {"run.speed": [10.0]})
    np.testing.assert_allclose(table.contact_force_rms, fine.contact_force_rms, rtol=0.02)
    coarse = np.sqrt((result.contact_force.values**2).mean(axis=0))
    assert (np.abs(table.contact_force_rms.values[0] - coarse) > 1e-3 * coarse).all()


def test_histories(truck, tmp_path):
    """As `simulate` has them, in memory and from a folder; what a vehicle or a case lacks is nan."""
    axes = {"run.speed": [9.0, -1.0], "vehicle": ["half_truck", "golden_car"]}
    table = mf.sweep(truck, axes, histories=True)
    result = alone(truck, {"run.speed": 9.0, "vehicle": {"kind": "catalogue", "name": "golden_car"}})
    for name in ("contact_force", "deflection", "motion", "acceleration", "roughness"):
        width = result[name].shape[1]
        found = table[name].values[0, 1]
        np.testing.assert_array_equal(found[:, :width], result[name])
        assert np.isnan(found[:, width:]).all()
        assert np.isnan(table[name].values[1]).all()
        assert table[name].dims[-2:] == result[name].dims
    np.testing.assert_array_equal(table.time, result.time)
    assert table.identical(mf.sweep(truck, axes, histories=True, store=tmp_path / "kept"))


def test_a_step_that_varies_stands_once_in_the_table(truck):
    table = mf.sweep(
        truck, {"run.time_step": [1e-3, 2e-3], "vehicle.footprint": [0.0, 0.1, 0.2]}, measures="static_load"
    )
    rows = list(csv.DictReader(as_csv(table).splitlines()))
    assert [row["time_step [s]"] for row in rows] == 3 * ["0.001"] + 3 * ["0.002"]


def test_histories_over_roads(truck):
    roads = [{"kind": "bump", "height": height, "width": 1.0, "at": 6.0} for height in (0.01, 0.02)]
    table = mf.sweep(truck, {"roughness": roads}, histories=True)
    first, second = table.roughness_seen.values
    np.testing.assert_allclose(2.0 * first, second, atol=1e-12)


@pytest.mark.parametrize(
    ("axes", "asked", "words"),
    [
        ({"run.speed": np.linspace(8.0, 12.0, 10**6)}, {}, r"histories of 1000000 cases needs about \d+ GiB"),
        ({"run.duration": [1.0, 1e9]}, {}, r"histories of 2 cases needs about \S+ GiB"),
        ({"run.time_step": [1e-3, 2e-3]}, {}, r"run\.time_step must not vary"),
        ({"run.speed": [9.0]}, {"response": "random"}, r"histories are those of response=\"simulate\""),
    ],
)
def test_histories_that_cannot_be(axes, asked, words, truck):
    with pytest.raises(ValueError, match=words):
        mf.sweep(truck, axes, histories=True, **asked)


GRID = {"run.speed": [9.0, 10.0, 11.0], "vehicle.tyre_stiffness.0": [3e6, 4e6], "roughness.seed": [0, 1]}


def test_nothing_depends_on_order_chunks_or_workers(truck, monkeypatch, tmp_path):
    found = mf.sweep(truck, GRID)
    turned = mf.sweep(truck, dict(reversed(GRID.items())))
    for name in usual():
        np.testing.assert_array_equal(turned[name].transpose(*found[name].dims), found[name])
    monkeypatch.setattr(chunks, "CHUNKING", replace(chunks.CHUNKING, cases=5))
    assert mf.sweep(truck, GRID).identical(found)
    assert mf.sweep(truck, GRID, store=tmp_path / "kept").identical(found)
    monkeypatch.undo()
    # Of one chunk a process makes all; these are three.
    more = {"run.speed": np.linspace(8.0, 12.0, 130)}
    assert mf.sweep(truck, more, workers=2).identical(mf.sweep(truck, more))
    fewer = mf.sweep(truck, GRID | {"run.speed": [10.0]})
    np.testing.assert_array_equal(fewer.contact_force_peak[0], found.contact_force_peak[1])


def test_what_is_stored_is_not_computed_again(truck, tmp_path, monkeypatch):
    monkeypatch.setattr(chunks, "CHUNKING", replace(chunks.CHUNKING, cases=3))
    found = mf.sweep(truck, GRID, store=tmp_path / "kept")
    files = sorted((tmp_path / "kept" / "chunks").iterdir())
    assert len(files) == 4
    written = {file: (file.stat().st_mtime_ns, file.read_bytes()) for file in files}
    files[1].unlink()
    assert mf.sweep(truck, GRID, store=tmp_path / "kept").identical(found)
    for file, (when, what) in written.items():
        assert file.read_bytes() == what
        assert (file.stat().st_mtime_ns == when) == (file != files[1])


def test_another_sweep_is_refused_and_so_is_a_damaged_chunk(truck, tmp_path):
    kept = tmp_path / "kept"
    mf.sweep(truck, {"run.speed": [9.0]}, store=kept)
    with pytest.raises(ValueError, match="holds another sweep: it differs in axes"):
        mf.sweep(truck, {"run.speed": [9.5]}, store=kept)
    with pytest.raises(ValueError, match="holds another sweep: it differs in measures"):
        mf.sweep(truck, {"run.speed": [9.0]}, store=kept, measures="static_load")
    (file,) = (kept / "chunks").iterdir()
    file.write_bytes(file.read_bytes()[:100])
    with pytest.raises(ValueError, match="is damaged; remove it"):
        mf.sweep(truck, {"run.speed": [9.0]}, store=kept)


def test_files_are_part_of_a_sweep(truck, tmp_path):
    """Cases of one content of a file and of another do not go together, wherever it is named."""
    (tmp_path / "there").mkdir()
    mf.write_vehicle(mf.catalogue("half_truck"), tmp_path / "there" / "truck.npz")
    (tmp_path / "there" / "matrices.toml").write_text('[vehicle]\nkind = "vehicle_file"\nfile = "truck.npz"\n')
    axes = {"roughness": ["road.csv"], "vehicle": ["there/matrices.toml", "other.toml"]}
    table = mf.sweep(truck, axes, store=tmp_path / "kept", workers=2)
    assert (table.status == "").all()
    assert table.vehicle.values.tolist() == ["there/matrices.toml", "other.toml"]
    assert mf.sweep(truck, axes, store=tmp_path / "kept").identical(table)
    mf.write_vehicle(mf.catalogue("two_axle_truck"), tmp_path / "another.npz")
    others = {name: (tmp_path / name).read_bytes() + b"\n" for name in ("road.csv", "other.toml")}
    for file, other in (others | {"there/truck.npz": (tmp_path / "another.npz").read_bytes()}).items():
        before = (tmp_path / file).read_bytes()
        (tmp_path / file).write_bytes(other)
        with pytest.raises(ValueError, match="holds another sweep: it differs in files"):
            mf.sweep(truck, axes, store=tmp_path / "kept")
        (tmp_path / file).write_bytes(before)


def test_a_case_without_an_answer_says_why_and_ends_nothing(truck):
    # The second one would be off its profile, the third is no speed.
    axes = {"run.speed": [10.0, 45.0, -1.0]}
    table = mf.sweep(truck, axes | {"roughness": [FILE]})
    first, second, third = table.status.values[:, 0].tolist()
    assert first == ""
    assert "must cover the journey" in second
    assert "run.speed must be positive" in third
    assert np.isnan(table.contact_force_rms.values[1:]).all()
    assert np.isfinite(table.contact_force_rms.values[0]).all()


def test_findings_of_cases_and_of_the_sweep(truck):
    with pytest.warns(mf.ValidityWarning, match="another road of the same spectrum"):
        table = mf.sweep(truck, {"run.speed": [9.0, 10.0], "roughness.road_class": ["A", "H"]})
    assert table.findings.values[0].tolist()[0] == ""
    assert "contact_lost" in table.findings.values[0, 1]


REFUSED = {
    "is not known here (did you mean 'speed'?)": {"run.sped": [9.0]},
    "there is no tyer_stiffness (did you mean 'tyre_stiffness'?) in vehicle": {"vehicle.tyer_stiffness.0": [1.0]},
    "is a list, with the numbers 0 to 1": {"vehicle.tyre_stiffness.2": [3e6]},
    "must be a positive number": {"run.speed": ["fast"]},
    "of one kind, got a number and a text": {"run.speed": [9.0, "fast"]},
    "must be positive": {"run.speed": [-1.0, -2.0]},
    "must have numbers, got nan": {"run.speed": [np.nan]},
    "a list of values, got 9.0": {"run.speed": 9.0},
    "a value at least, got none": {"run.speed": []},
    "varies twice": {"run.speed": [9.0], ("run.speed", "run.start"): [(9.0, 0.0)]},
    "exclude each other": {"vehicle": ["half_truck"], "vehicle.tyre_stiffness.0": [3e6]},
    "must have 2 values at each place": {("run.speed", "run.start"): [(9.0,)]},
    "named by the path of a key": {3: [9.0]},
    "nothing.toml": {"vehicle": ["nothing.toml"]},
}


@pytest.mark.parametrize("words", REFUSED)
def test_an_impossible_axis_is_refused_before_anything_is_computed(words, truck, monkeypatch):
    monkeypatch.setattr("movingfrf.studies.sweep.sweep.solved", lambda *_: pytest.fail("computed"))
    with pytest.raises(ValueError, match=re.escape(words)):
        mf.sweep(truck, REFUSED[words])


def test_wheels_that_follow_the_rail_and_wheels_on_springs(tmp_path):
    """A stiffness may be inf, in the scenario and along an axis; what is kept knows it."""
    tables = {
        "guideway": {
            "kind": "track",
            "beam": {"kind": "euler_bernoulli_beam", "bending_stiffness": 6.42e6, "mass": 60.2},
            "foundation": {"kind": "spring", "stiffness": 5e7, "damping": 5e4},
        },
        "vehicle": {"kind": "wheelset", "mass": 900.0, "contact_stiffness": float("inf")},
        "roughness": {"kind": "harmonic", "amplitude": 1e-4, "wavelength": 2.0},
        "run": {"speed": 20.0, "duration": 0.5},
    }
    axes = {"vehicle.contact_stiffness": [1e9, float("inf")]}
    table = mf.sweep(tables, axes, store=tmp_path / "kept")
    assert (table.status == "").all()
    assert mf.sweep(tables, axes, store=tmp_path / "kept").identical(table)
    assert mf.sweep(tables, axes, workers=2).identical(table)
    assert table.contact_force_rms.values[0, 0] == pytest.approx(table.contact_force_rms.values[1, 0], rel=0.3)


def test_what_else_is_refused(truck):
    with pytest.raises(ValueError, match=r"measures must be one of .* got 'force'"):
        mf.sweep(truck, {"run.speed": [9.0]}, measures=["force"])
    with pytest.raises(ValueError, match="measures must be some of"):
        mf.sweep(truck, {"run.speed": [9.0]}, measures=[])
    with pytest.raises(ValueError, match="axes must be a mapping"):
        mf.sweep(truck, [1.0])
    with pytest.raises(ValueError, match="workers must be a whole number"):
        mf.sweep(truck, {"run.speed": [9.0]}, workers=0)
    with pytest.raises(ValueError, match="cannot be read"):
        mf.sweep(truck.parent / "none.toml", {"run.speed": [9.0]})
    with pytest.raises(ValueError, match="prescribed loads are not swept"):
        mf.sweep(parse_scenario(template("loads")), {"run.speed": [9.0]})


def test_axes_in_a_line():
    assert axes_in(["run.speed=5:35:4"]) == {"run.speed": [5.0, 15.0, 25.0, 35.0]}
    assert axes_in(["roughness.seed=3:5", "a=x:y"]) == {"roughness.seed": [3, 4, 5], "a": ["x:y"]}
    assert axes_in(["a.x, a.y = 1,2;3:4"]) == {("a.x", "a.y"): [(1, 3), (2, 4)]}
    assert axes_in(["vehicle=half_truck,other.toml", "b=true"]) == {
        "vehicle": ["half_truck", "other.toml"],
        "b": [True],
    }
    for line in ("speed", "=1", "run.speed=", "a=1:2:3:4", "a=1:2:0", "a=2:1", "a=1.5:2.5", "a,b=1", "a,b=1,2;3"):
        with pytest.raises(ValueError, match="--over"):
            axes_in([line])
    with pytest.raises(ValueError, match="varies twice"):
        axes_in(["a=1", "a=2"])
    assert part_in("3/64") == (3, 64)
    for text in ("65/64", "0/4", "3", "a/b", "-1/4"):
        with pytest.raises(ValueError, match="--part"):
            part_in(text)


def test_the_command_in_parts_and_in_one(truck):
    over = ["--over", "run.speed=8:12:100", "--over", "roughness.seed=0,1"]
    parts = truck.parent / "parts"
    for part in ("1/2", "2/2"):
        done = command("sweep", truck, *over, "--part", part, "-o", parts)
        assert done.returncode == 0, done.stderr
        assert not (parts / "table.csv").exists()
    assert len(list((parts / "chunks").iterdir())) == 4
    done = command("sweep", truck, *over, "-o", parts)
    assert done.returncode == 0, done.stderr
    assert "200 cases, none without an answer" in done.stdout
    assert "another road of the same spectrum" in done.stdout
    rows = list(csv.reader(io.StringIO((parts / "table.csv").read_text())))
    assert rows[0][:3] == ["speed [m/s]", "seed", "static_load front [N]"]
    assert {"acceleration_rms bounce [m/s2]", "acceleration_rms pitch [rad/s2]"} <= set(rows[0])
    assert len(rows) == 201
    found = mf.sweep(truck, {"run.speed": np.linspace(8.0, 12.0, 100), "roughness.seed": [0, 1]})
    assert (parts / "table.csv").read_text() == as_csv(found)
    refused = command("sweep", truck, "--over", "run.sped=9", "-o", truck.parent / "none")
    assert refused.returncode == 2
    assert not (truck.parent / "none").exists()


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="signals")
def test_killed_at_any_moment_and_started_again(truck):
    """What is stored stays, and the end is the same, bit for bit."""
    over = ["--over", "run.speed=8:12:150", "--over", "roughness.seed=0,1"]
    kept = truck.parent / "kept"
    for wait in (1.0, 1.3, 1.7):
        process = subprocess.Popen(
            [sys.executable, "-m", "movingfrf", "sweep", str(truck), *over, "-o", str(kept)],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        time.sleep(wait)
        process.send_signal(signal.SIGKILL)
        process.wait()
    before = {file: file.stat().st_mtime_ns for file in sorted(Path(kept).glob("chunks/*.npz"))}
    done = command("sweep", truck, *over, "-o", kept)
    assert done.returncode == 0, done.stderr
    assert all(file.stat().st_mtime_ns == when for file, when in before.items())
    whole_run = command("sweep", truck, *over, "-o", truck.parent / "at_once")
    assert whole_run.returncode == 0, whole_run.stderr
    assert (kept / "table.csv").read_bytes() == (truck.parent / "at_once" / "table.csv").read_bytes()


@pytest.mark.skipif(os.name == "nt", reason="signals")
def test_two_at_once_on_one_folder(truck):
    """Neither of them harms the other, whoever writes first, and the second has nothing of its own to say."""
    order = [sys.executable, "-m", "movingfrf", "sweep", str(truck), "--over", "run.speed=8:12:150", "--measures"]
    kept = truck.parent / "kept"
    both = [
        subprocess.Popen(
            [*order, "static_load,contact_force_rms", "-o", str(kept), *others], stderr=subprocess.PIPE
        )
        for others in ([], ["--workers", "2"])
    ]
    for process in both:
        assert process.communicate(timeout=60)[1] == b""
        assert process.returncode == 0
    alone = mf.sweep(
        truck, {"run.speed": np.linspace(8.0, 12.0, 150)}, measures=["static_load", "contact_force_rms"]
    )
    assert (kept / "table.csv").read_text() == as_csv(alone)
    assert sorted(file.name for file in (kept / "chunks").iterdir()) == ["00000.npz", "00001.npz", "00002.npz"]


def test_run_with_another_value(truck):
    """As of a file in which it stands; the text in the result is such a file."""
    done = command("run", truck, "--set", "run.speed=12", "--set", "vehicle.tyre_stiffness.0=3e6", "--no-report")
    assert done.returncode == 0, done.stderr
    with xr.open_dataset(truck.parent / "out" / "truck" / "result.nc", engine="h5netcdf") as result:
        text = TEXT.replace("speed = 10.0", "speed = 12.0").replace("[3.74e6, 4.60e6]", "[3.0e6, 4.60e6]")
        wanted = parse_scenario(text).run().contact_force
        np.testing.assert_allclose(result.contact_force, wanted, rtol=1e-9, atol=1e-6)
        again = parse_scenario(result.attrs["scenario"])
    assert again.journey.speed == 12.0
    assert again.case == parse_scenario(text).case
    for setting in ("run.sped=12", "run.speed", "run.speed=fast"):
        refused = command("run", truck, "--set", setting)
        assert refused.returncode == 2
        assert setting.split("=")[0] in refused.stderr
    assert command("run", truck, "--set", "run.speed=1", "--set", "run.speed=2").returncode == 2


@pytest.mark.parametrize("name", ["scenario", "loads"])
def test_tables_written_and_read_are_the_same(name):
    tables = tables_of(template(name))
    assert tables_of(as_toml(tables)) == tables
    odd = {"a b": {'"': [{"x": 1, "y": [True, "é\n"]}], "z": {}}, "n": 1e300, "t": tables_of("t = 2020-01-02")["t"]}
    assert tables_of(as_toml(odd)) == odd


def test_random_responses(truck):
    axes = {"run.speed": [9.0, 12.0], "vehicle": ["half_truck", "golden_car"], "roughness.road_class": ["A", "C"]}
    table = mf.sweep(truck, axes, response="random")
    assert (table.status == "").all()
    for speed in axes["run.speed"]:
        for number, name in enumerate(axes["vehicle"]):
            road = parse_scenario(TEXT).guideway
            wanted = mf.random_response(
                road, mf.catalogue(name), mf.IsoRoad.of_class("C", band=(0.01, 6.0)), speed=speed
            )
            found = table.sel(speed=speed, road_class="C").isel(vehicle=number)
            for measure in ("contact_force_rms", "weighted_acceleration", "dynamic_load_coefficient"):
                values = found[measure].values
                np.testing.assert_allclose(values[: wanted[measure].size], wanted[measure], rtol=1e-9)
    one = mf.sweep(truck, {"run.speed": [9.0]}, response="random", measures="contact_force_rms")
    assert set(one.data_vars) == {"contact_force_rms", "status", "findings"}
    bump = {"kind": "bump", "height": 0.01, "width": 1.0, "at": 4.0}
    without = mf.sweep(truck, {"roughness": [bump]}, response="random")
    assert "has no spectrum" in without.status.item()
    with pytest.raises(ValueError, match="response must be one of simulate, random"):
        mf.sweep(truck, {"run.speed": [9.0]}, response="randon")
    done = command("sweep", truck, "--random", "--over", "run.speed=9,12", "-o", truck.parent / "at_random")
    assert done.returncode == 0, done.stderr
    assert "contact_force_rms front [N]" in (truck.parent / "at_random" / "table.csv").read_text()


def test_the_page_says_what_the_table_has(truck):
    """A figure for each question, where it is worst, which cases have none; equal tables, equal pages."""
    axes = {"run.speed": [9.0, 12.0, 45.0], "roughness": [FILE], "vehicle": ["half_truck", "golden_car", "none"]}
    table = mf.sweep(truck, axes)
    page = render(table, "trucks", "text of the scenario")
    assert page == render(table, "trucks", "text of the scenario")
    assert page.count("<figure") == 5
    said = " ".join(findings(table))
    # At 45 m/s both vehicles leave the profile; there is no third one, at any speed.
    assert (
        said.count("1 case without an answer: truck: 1 fault; roughness: the profile must cover the journey") == 2
    )
    assert said.count("3 cases without an answer: truck: 1 fault; vehicle.name must be one of") == 1
    (worst,) = tables(table)
    coefficient = next(row for row in worst.rows if "coefficient" in row.name)
    at = table.dynamic_load_coefficient.max("contact")
    assert float(coefficient.cells[2]) == pytest.approx(float(at.max()), rel=1e-3)
    speed = float(at.max(["roughness", "vehicle"]).idxmax("speed"))
    assert f"speed {speed:g} m/s" in coefficient.cells[4]
    none = mf.sweep(truck, {"run.speed": [45.0, 10.0], "roughness": [FILE]}).isel(speed=[0])
    assert "It has no answer." in render(none, "none", "")
    for few in ({"roughness.seed": range(3)}, {"vehicle": ["half_truck", "golden_car"]}, {"run.speed": [9.0]}):
        for one in (mf.sweep(truck, few, measures=["motion_rms"], response="random"), mf.sweep(truck, few)):
            # What is one case has answers, but no axis to be drawn along.
            assert ("<figure" in (page := render(one, "few", ""))) == (one.status.size > 1)
            assert "Largest: " in page


@pytest.mark.skipif(os.name == "nt", reason="signals")
def test_a_worker_that_is_killed(truck, tmp_path):
    """One line, and what is solved stays: the same call goes on."""
    over = [
        "--over",
        "run.speed=8:12:200",
        "--over",
        "roughness.seed=0,1",
        "-o",
        str(tmp_path / "kept"),
        "--workers",
        "2",
    ]
    process = subprocess.Popen(
        [sys.executable, "-m", "movingfrf", "sweep", str(truck), *over],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children")
    if not children.exists():
        process.kill()
        pytest.skip("needs /proc")
    while process.poll() is None and not (workers := children.read_text().split()):
        time.sleep(0.01)
    os.kill(int(workers[0]), signal.SIGKILL)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 2
    assert "a worker has ended before its cases were solved: it was killed" in said.replace("\n", " ")
    assert "Traceback" not in said
    assert not any(Path(f"/proc/{worker}").exists() for worker in workers)
    # The other one has not been waited for: it had three chunks or four to solve.
    assert len(list((tmp_path / "kept" / "chunks").glob("*.npz"))) < 3
    done = command("sweep", truck, *over)
    assert done.returncode == 0, done.stderr
    assert "400 cases, none without an answer" in done.stdout

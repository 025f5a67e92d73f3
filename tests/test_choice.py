"""What is chosen of a file is chosen before it is checked; what counts as missing; references of OpenCRG."""

from pathlib import Path

import numpy as np
import pytest

import movingfrf as mf
from movingfrf.commands.main import main
from tests.reader_parts import written

CASES = Path(__file__).parent / "data" / "cases"

# Selection.


@pytest.mark.parametrize(
    ("options", "shape", "said"),
    [
        ({"last": 30.0}, (394, 2), "cropped to 0 to 30 m"),
        ({"paths": [0]}, (600, 1), "took the paths [0]"),
        ({"paths": [1], "last": 20.0}, (263, 1), "took the paths [1]"),
    ],
)
def test_a_gap_outside_of_what_is_wanted_is_none(options, shape, said, capsys):
    profile = mf.read_profile(CASES / "gap-outside.csv", **options).profile
    assert profile.columns.shape == shape
    assert said in profile.steps
    typed = [word for key, value in options.items() for word in (f"--{key}", str(value).strip("[]"))]
    assert main(["profile", str(CASES / "gap-outside.csv"), *typed]) == 0
    shown = capsys.readouterr().out
    assert shown.count("cropped to") == ("last" in options)
    assert shown.count("took the paths") == ("paths" in options)
    with pytest.raises(ValueError, match=r"line 527: no elevation at 40.005 m"):
        mf.read_profile(CASES / "gap-outside.csv", paths=[1])


def test_what_is_wrong_outside_does_not_matter_and_inside_it_does(tmp_path):
    rows = [(x, z) for x, z in zip(range(12), [0.0, 0.1] * 6, strict=True)]
    rows[10] = (3, 0.0)
    file = written(tmp_path, "road.csv", "".join(f"{x},{z}\n" for x, z in rows))
    with pytest.raises(ValueError, match=r"line 11: distance must increase, got 9 m followed by 3 m"):
        mf.read_profile(file)
    # Everything between the first and the last that lie there counts, whatever its distance says.
    assert mf.read_profile(file, last=9.0, first=4.0).profile.stations.tolist() == [4, 5, 6, 7, 8, 9]
    with pytest.raises(ValueError, match="line 11: distance must increase"):
        mf.read_profile(file, last=9.0)
    np.savez(tmp_path / "road.npz", x=np.arange(12.0), z=np.where(np.arange(12) == 2, np.inf, 0.1))
    with pytest.raises(ValueError, match="value 3: elevation must be finite"):
        mf.read_profile(tmp_path / "road.npz")
    profile = mf.read_profile(tmp_path / "road.npz", first=3.0).profile
    assert profile.stations[0] == 3.0
    assert profile.steps == ("cropped to 3 to 11 m",)


def test_gaps_are_filled_after_the_choice_and_rims_are_left_out(tmp_path):
    text = "station,left,right\n" + "".join(
        f"{x},{'' if x in (5, 0) else x / 10},{'' if x > 8 else x / 10}\n" for x in range(12)
    )
    file = written(tmp_path, "road.csv", text)
    profile = mf.read_profile(file, first=1.0, paths=[0], repair_gaps=2.0).profile
    assert profile.columns[:, 0] == pytest.approx(np.arange(1, 12) / 10)
    assert [step.split()[0] for step in profile.steps] == ["cropped", "took", "filled"]
    cropped = mf.read_profile(file, paths=[1], crop_rims=True).profile
    assert cropped.stations[-1] == 8.0
    assert cropped.steps == ("took the paths [1]", "left out 0 stations at the beginning and 3 at the end")


def test_a_choice_that_leaves_nothing_names_the_option(capsys):
    for typed, said in [
        (["--first", "100"], "--first must leave at least 4 stations, but between 100 m and 45.6438 m there are 0"),
        (["--last", "-1"], "--last must leave at least 4 stations, but between 0 m and -1 m there are 0"),
        (["--paths", "2"], "--paths must be below 2, the number of paths, got 2"),
    ]:
        assert main(["profile", str(CASES / "gap-outside.csv"), *typed]) == 2
        assert said in " ".join(capsys.readouterr().err.split())


def test_a_scenario_takes_the_choice_too(tmp_path, capsys):
    mf_file = tmp_path / "road.toml"
    assert main(["new", str(mf_file)]) == 0
    head, _, tail = mf_file.read_text().partition("[roughness]")
    run = (
        tail[tail.index("[run]") :]
        .replace("duration = 24.0", "duration = 1.0")
        .replace("start = 0.0", "start = 5.0")
    )
    file = CASES / "gap-outside.csv"
    roughness = f'[roughness]\nkind = "profile"\nfile = "{file}"\npaths = [0]\nfirst = 0.5\nlast = 30.0\n'
    mf_file.write_text(head + roughness + run)
    assert main(["check", str(mf_file)]) == 0
    shown = " ".join(capsys.readouterr().out.split())
    assert "387 stations from 0.5334 m to 29.9466 m" in shown
    assert "cropped to 0.5 to 30 m; took the paths [0]" in shown


# Missing values.


def packed(folder, values, kind, **said):
    import h5py

    with h5py.File(folder / "road.nc", "w") as file:
        file["x"] = np.arange(float(len(values)))
        file["z"] = np.array(values, kind)
        file["z"].attrs.update(said)
    return folder / "road.nc"


def test_a_packed_missing_value_is_a_gap():
    with pytest.raises(ValueError, match=r"value 301: no elevation at 30 m; in all 150"):
        mf.read_profile(CASES / "missing_value.nc")


SCALE = {"scale_factor": np.array([1e-3]), "add_offset": 1.0}
WHOLE = [10, 20, -9999, 40, 50, 60]
DECIMAL = [1.0, 2.0, -9999.9, 4.0, 5.0, 6.0]


@pytest.mark.parametrize(
    ("values", "kind", "said"),
    [
        (WHOLE, "i2", {**SCALE, "missing_value": np.int16(-9999)}),
        (WHOLE, "i2", {**SCALE, "missing_value": np.array([-1, -9999], "i2")}),
        (WHOLE, "i2", {**SCALE, "missing_value": -9999.0}),
        (WHOLE, "i4", {**SCALE, "_FillValue": np.int32(-9999)}),
        (WHOLE, "i2", {**SCALE, "missing_value": np.bytes_("-9999")}),
        (WHOLE, "i2", {**SCALE, "valid_min": np.int16(0)}),
        (WHOLE, "i2", {**SCALE, "valid_range": np.array([0, 60], "i2")}),
        # Limits with decimals of whole numbers are about what they stand for.
        (WHOLE, "i2", {**SCALE, "valid_range": np.array([1.0, 1.06001])}),
        (DECIMAL, "f4", {"missing_value": -9999.9}),
        (DECIMAL, "f4", {"_FillValue": np.float32(-9999.9)}),
        (DECIMAL, "f8", {"valid_min": 0.0}),
        ([0.1, 0.2, 0.3, 0.1, 0.2, 0.1], "f4", {"valid_max": 0.2}),
        ([1.0, 2.0, 9.969209968386869e36, 4.0, 5.0, 6.0], "f4", {}),
        (DECIMAL, "f8", {"missing_value": "-9999.9"}),
        ([10, 20, -1, 40, 50, 60], "i1", {**SCALE, "_Unsigned": "true", "_FillValue": np.int8(-1)}),
        ([10, 20, 255, 40, 50, 60], "u1", {**SCALE, "_FillValue": np.int8(-1)}),
    ],
    ids=str,
)
def test_all_that_netcdf_calls_missing_is_a_gap(tmp_path, values, kind, said):
    with pytest.raises(ValueError, match=r"value 3: no elevation at 2 m; in all 1 elevation is missing in 1 gap"):
        mf.read_profile(packed(tmp_path, values, kind, **said))


def test_what_is_valid_stays(tmp_path):
    unsigned = packed(tmp_path, [10, 20, -56, 40, 50, 60], "i1", _Unsigned="true", scale_factor=0.5)
    assert mf.read_profile(unsigned).profile.elevation.tolist() == [5.0, 10.0, 100.0, 20.0, 25.0, 30.0]
    limits = packed(tmp_path, [0.1, 0.2, 0.1, 0.1, 0.2, 0.1], "f4", valid_max=0.2, valid_min=0.1)
    assert mf.read_profile(limits).profile.elevation[1] == pytest.approx(0.2)


@pytest.mark.parametrize("name", ["road.csv", "road.mat", "road.npz", "road.nc", "road.erd", "road.crg"])
@pytest.mark.parametrize(("marker", "shown"), [(-9999.0, "−9999"), (-999.25, "−999.25"), (32767.0, "32767")])
def test_markers_that_a_file_does_not_name_are_a_finding_in_every_format(tmp_path, name, marker, shown):
    z = np.round(0.01 * np.sin(0.3 * np.arange(200.0)), 4)
    z[[40, 41, 120]] = marker
    mf.write_profile(mf.Profile(0.1 * np.arange(200), z), tmp_path / name)
    found = mf.describe_profile(mf.read_profile(tmp_path / name, paths=[0]).profile).findings
    (said,) = [finding for finding in found if "marker of missing values" in finding]
    assert said.startswith(f"3 elevations are {shown} m, ")


# References of OpenCRG.


def test_a_reference_is_followed_and_named():
    profile, understood = mf.read_profile(CASES / "ref.crg")
    assert "OpenCRG grid of 'plain.crg', which it refers to (text, single precision)" in understood
    assert profile.source == "ref.crg (plain.crg)"
    assert np.array_equal(profile.columns, mf.read_profile(CASES / "plain.crg").profile.columns)


REFERENCE = "$CT\ninvented\n$!***\n$ROAD_CRG_FILE\n%s\n$!***\n"


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ("* a comment\n pla ! the first half\n in.crg", ""),
        ("below/plain.crg", ""),
        ("none.crg", r"refers to 'none\.crg', which is not there"),
        ("", "refers to '', which is not there"),
        ("../plain.crg", r"refers to '\.\./plain\.crg', which is not followed: read that file itself"),
        ("$$HOME/plain.crg", r"refers to '\$HOME/plain\.crg', which is not followed"),
        ("again.crg", r"refers to 'again\.crg', which refers to 'plain\.crg' in turn"),
        ("ref.crg", r"refers to 'ref\.crg', which is not followed"),
    ],
)
def test_where_references_lead(tmp_path, lines, message):
    grid = (CASES / "plain.crg").read_text()
    for folder in (tmp_path, tmp_path / "road", tmp_path / "road" / "below"):
        folder.mkdir(exist_ok=True)
        (folder / "plain.crg").write_text(grid)
    (tmp_path / "road" / "again.crg").write_text(REFERENCE % "plain.crg")
    file = written(tmp_path / "road", "ref.crg", REFERENCE % lines)
    if message:
        with pytest.raises(ValueError, match=message):
            mf.read_profile(file)
    else:
        assert mf.read_profile(file).profile.paths == 3

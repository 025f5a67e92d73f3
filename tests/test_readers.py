"""Profiles from files and into files, format by format."""

import struct
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import movingfrf as mf
from movingfrf.roughness.formats import hdf
from movingfrf.roughness.formats.gpx import distances
from tests import fuzz_readers

DATA = Path(__file__).parents[2] / "shared" / "data"
STATIONS, HEIGHTS = np.array([0.0, 0.5, 1.25, 2.0, 3.0]), np.array([583.1, 583.2, 583.15, 583.0, 583.05])


def needs(name):
    return pytest.mark.skipif(not (DATA / name).exists(), reason=f"the published profile {name} is not there")


def written(folder, name, content):
    file = folder / name
    file.write_bytes(content if isinstance(content, bytes) else content.encode())
    return file


# Text in columns.


@pytest.mark.parametrize("separator", [",", ";", "\t", " ", "   "])
@pytest.mark.parametrize("header", ["", "station{0}elevation\n", "# a comment\n\nx [m]{0}z [m]\n"])
@pytest.mark.parametrize("newline", ["\n", "\r\n", "\r"])
def test_columns_in_every_dress(tmp_path, separator, header, newline):
    text = header.format(separator) + "\n".join(
        f"{x}{separator}{z}" for x, z in zip(STATIONS, HEIGHTS, strict=True)
    )
    file = written(tmp_path, "road.txt", f"{text}\n".replace("\n", newline).encode("utf-8-sig"))
    profile, understood = mf.read_profile(file)
    assert np.array_equal(profile.distance, STATIONS)
    assert np.array_equal(profile.elevation, HEIGHTS)
    assert profile.source == "road.txt"
    assert profile.steps == ()
    assert "5 stations from 0 m to 3 m" in understood
    assert ("no header" in understood) == (not header)
    assert ("taken as metres" in understood) == ("[m]" not in header)


@pytest.mark.parametrize(
    ("text", "encoding"),
    [
        ("Station [m];Left [mm];Right [mm]\n0,0;1,5;2\n0,25;2,5;3\n0,5;-1;0\n0,75;1e1;4\n", "utf-8"),
        ("Station [m];Höhe links [mm];Höhe rechts [mm]\n0,0;1,5;2\n0,25;2,5;3\n0,5;-1;0\n0,75;10,0;4\n", "latin-1"),
        ("s\tl\tr\nm\tmm\tmm\n0\t1,5\t2\n0,25\t2,5\t3\n0,5\t-1\t0\n,75\t10\t4\n", "utf-16"),
        ('"distance (km)","left (cm)","right (mm)"\n0,.15,2\n0.00025,.25,3\n5e-4,-.1,0\n7.5e-4,1.,4\n', "utf-8"),
        (
            "x [cm]  z left [dm]  z right [mm]\n0  .015 2\n25 .025 3\n50 -.01 0\n75 0.1 4\n".replace("z ", "z_"),
            "utf-8",
        ),
        ("0,0 0,0015 0,002\n0,25 0,0025 0,003\n0,5 -0,001 0\n0,75 0,01 0,004\n", "utf-8"),
        ("% made by hand\n0;1.5e-3;.002;\n.25;2.5e-3;.003;\n.5;-1e-3;0;\n.75;.01;.004;\n", "utf-8"),
    ],
)
def test_units_and_decimal_commas_become_metres(tmp_path, text, encoding):
    profile, understood = mf.read_profile(written(tmp_path, "road.csv", text.encode(encoding)))
    # A conversion is one multiplication, right to one rounding.
    assert profile.stations == pytest.approx([0.0, 0.25, 0.5, 0.75], rel=3e-16, abs=0)
    expected = [[1.5e-3, 2e-3], [2.5e-3, 3e-3], [-1e-3, 0.0], [0.01, 4e-3]]
    assert profile.columns == pytest.approx(np.array(expected), rel=3e-16, abs=0)
    assert ("decimal commas" in understood) == ("5,5" in text or ",5" in text)


@pytest.mark.parametrize(
    ("unit", "metres"), [("ft", 0.3048), ("in", 0.0254), ("mi", 1609.344), ("yd", 0.9144), ("µm", 1e-6)]
)
def test_units_that_are_not_metric(tmp_path, unit, metres):
    text = f"x [{unit}],z [m]\n" + "".join(f"{n},0\n" for n in range(5))
    assert mf.read_profile(written(tmp_path, "road.csv", text)).profile.stations == pytest.approx(
        metres * np.arange(5), rel=3e-16
    )


def test_columns_by_name_and_by_number(tmp_path):
    text = "Station [m],Speed [km/h],Left [mm],Right [mm]\n" + "".join(f"{n},80,{n},{-n}\n" for n in range(5))
    file = written(tmp_path, "road.csv", text)
    with pytest.raises(ValueError, match=r"line 1: the unit 'km/h' of column 'Speed \[km/h\]' is not known"):
        mf.read_profile(file)
    for columns in (["Station", "Right", "Left [mm]"], [0, 3, 2]):
        profile = mf.read_profile(file, columns=columns).profile
        assert profile.elevation[1] == pytest.approx([-1e-3, 1e-3])
    with pytest.raises(ValueError, match="there is no column 'Middle'; there are 'Station"):
        mf.read_profile(file, columns=["Station", "Middle"])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "is empty"),
        ("x,z\n", "no numbers"),
        ("1\n2\n3\n4\n", "line 1: expected a station and at least one elevation"),
        ("0,1\n1,2\n2,x\n3,4\n", "line 3: expected numbers separated by commas, got '2,x'"),
        ("0,1\n1,2\n2\n3,4\n", "line 3: expected 2 columns as before, got 1"),
        ("0,1\n1,2\n2,1,7\n3,4\n", "line 3: expected 2 columns as before, got 3"),
        ("# c\n0,1\n\n1,2\n1,3\n2,4\n", "line 5: distance must increase, got 1 m followed by 1 m"),
        ("0,1\n1,2\n2,nan\n3,4\n", "line 3: no elevation at 2 m; in all 1 elevations are missing in 1 gaps"),
        ("0,1\n1,2\n2,inf\n3,4\n", "line 3: elevation must be finite"),
        ("0,1\n1,2\nnan,3\n3,4\n", "line 3: there is no station"),
        ("0,1\n1,2\n2,3\n", "at least 4 stations"),
        ("0,5.8o3\n1,2\n2,3\n3,4\n4,5\n", "line 1: expected numbers"),
        ("0;1.234,5\n1;2\n2;3\n3;4\n", "line 1: expected a station|line 1: expected numbers"),
        ("0;1,5\n1;2.5\n2;3\n3;4\n", "line 2: expected numbers separated by semicolons, got '1;2.5'"),
        ("0,0, 1,5\n1,0, 2,5\n2,0, 2,5\n3,0, 2,5\n", "line 1: commas with and without a space"),
        ("x,y,z\n0,1\n1,2\n2,3\n3,4\n", "line 2: expected 3 columns as before, got 2"),
        ("x\n0,1\n1,2\n2,3\n3,4\n", "line 1: 1 names for 2 columns"),
        ("x [furlong],z [m]\n0,1\n1,2\n2,3\n3,4\n", "line 1: the unit 'furlong' of column"),
        ("x,z\nfoo,bar\n0,1\n1,2\n2,3\n3,4\n", "line 2: expected numbers"),
        ("0,1\n1,2\n2,1e400\n3,4\n", "line 3: elevation must be finite"),
        ("0,1\n1,2\n2,1_0\n3,4\n", "line 3: expected numbers"),
        ('0,1\n1,2\n2,"3\n3,4\n', "line 3"),
    ],
)
def test_faulty_columns(tmp_path, text, message):
    with pytest.raises(ValueError, match=message):
        mf.read_profile(written(tmp_path, "road.csv", text))


def test_files_that_cannot_be_read(tmp_path):
    with pytest.raises(ValueError, match=r"cannot read .*none\.csv: No such file"):
        mf.read_profile(tmp_path / "none.csv")
    with pytest.raises(ValueError, match="cannot read"):
        mf.read_profile(tmp_path)
    with pytest.raises(ValueError, match="not a text file"):
        mf.read_profile(written(tmp_path, "binary", bytes(range(256))))
    with pytest.raises(ValueError, match=r"is not what its ending \.crg says"):
        mf.read_profile(written(tmp_path, "road.crg", "0,1\n1,2\n2,3\n3,4\n"))


@settings(max_examples=60, deadline=None, derandomize=True)
@given(st.lists(st.floats(-1e6, 1e6), min_size=4, max_size=8))
def test_numbers_are_those_of_python(tmp_path_factory, values):
    file = tmp_path_factory.getbasetemp() / "digits.csv"
    file.write_text("".join(f"{n},{value!r}\n" for n, value in enumerate(values)))
    assert mf.read_profile(file).profile.elevation.tolist() == values


# What is missing.

GAPS = "x [m],left [mm],right [mm]\n0,1,\n1,2,5\n2,,5\n3,,6\n4,5,6\n5,6,7\n6,7,NaN\n7,8,7\n"


def test_drop_outs_are_told_and_filled_on_request_only(tmp_path):
    whole = GAPS.replace("0,1,\n", "0,1,4\n")
    file = written(tmp_path, "road.csv", whole)
    message = (
        r"line 4: no elevation at 2 m on path 0; in all 3 elevations are missing in 2 gaps, the longest 3 m long"
    )
    with pytest.raises(ValueError, match=message):
        mf.read_profile(file)
    with pytest.raises(ValueError, match=r"line 4: the gap at 2 m on path 0 is 3 m long, and .* allows 2.5 m"):
        mf.read_profile(file, repair_gaps=2.5)
    profile, understood = mf.read_profile(file, repair_gaps=3.0)
    assert profile.elevation[:, 0] == pytest.approx(1e-3 * np.arange(1, 9))
    assert profile.elevation[6, 1] == pytest.approx(7e-3)
    (step,) = profile.steps
    assert step.startswith(
        "filled 3 missing elevations in 2 gaps by straight lines, the longest 3 m long at 2 m on pa"
    )
    assert "filled" not in understood


def test_a_gap_at_an_end_is_never_filled(tmp_path):
    file = written(tmp_path, "road.csv", GAPS)
    with pytest.raises(ValueError, match="line 2: the gap at 0 m on path 1 is open, at an end of the profile"):
        mf.read_profile(file, repair_gaps=100.0)
    profile, _ = mf.read_profile(file, crop_rims=True, repair_gaps=3.0)
    assert profile.stations[0] == 1.0
    assert profile.steps[0] == "left out 1 stations at the beginning and 0 at the end"


# Round trips: the precision of each format. A float keeps 24 bits; the text forms of OpenCRG keep 18 decimals (then
# rounded to a number) or 7.
PRECISION = {
    ("road.csv", None): 0.0,
    ("road.nc", None): 0.0,
    ("road.mat", None): 0.0,
    ("road.erd", "text"): 0.0,
    ("road.erd", "double"): 0.0,
    ("road.erd", "float"): 2.0**-24,
    ("road.crg", "double"): 0.0,
    ("road.crg", "float"): 2.0**-24,
    ("road.crg", "long text"): 2.0**-53,
    ("road.crg", "short text"): 1e-7,
}


@pytest.mark.parametrize(("name", "encoding"), PRECISION)
def test_round_trips_are_exact_to_the_precision_of_the_format(tmp_path, name, encoding):
    elevation = np.random.default_rng(0).normal(size=(200, 2)).clip(-0.999, 0.999)
    road = mf.Profile(478.0 + 0.25 * np.arange(200), elevation, "a road", ("made up",), (0.75, -0.75))
    mf.write_profile(road, tmp_path / name, encoding=encoding)
    back = mf.read_profile(tmp_path / name).profile
    # Largest elevation 1 m: the precision of its first digit is that of all decimals.
    assert np.abs(back.elevation - elevation).max() <= PRECISION[name, encoding]
    assert back.stations == pytest.approx(road.stations, rel=1e-15)
    assert "a road" in back.source or name.endswith(("csv", "mat", "crg"))
    if name.endswith(("nc", "crg", "mat")):
        assert back.across == pytest.approx((0.75, -0.75))
    if name.endswith("nc"):
        assert back.steps == ("made up",)


@pytest.mark.parametrize("name", ["road.csv", "road.nc", "road.mat", "road.erd", "road.crg"])
def test_one_path_stays_one_path(tmp_path, name):
    road = mf.Profile(0.5 * np.arange(6), [0.0, 0.1, 0.3, -0.2, 0.1, 0.0])
    mf.write_profile(road, tmp_path / name)
    # A grid has two long sections at least: a strip whose middle is asked for.
    across = [0.0] if name.endswith("crg") else None
    back = mf.read_profile(tmp_path / name, across=across).profile
    assert back.columns[:, 0].tolist() == road.elevation.tolist()
    assert back.same_across == (not name.endswith("crg"))


def test_uneven_stations_survive_where_the_format_has_stations(tmp_path):
    road = mf.Profile(STATIONS, HEIGHTS)
    for name in ("road.csv", "road.nc", "road.mat"):
        mf.write_profile(road, tmp_path / name)
        assert mf.read_profile(tmp_path / name).profile.stations.tolist() == STATIONS.tolist()
    for name in ("road.erd", "road.crg"):
        with pytest.raises(ValueError, match=r"are 0.5 to 1 m apart; resample .* `movingfrf convert --step`"):
            mf.write_profile(road, tmp_path / name)


@pytest.mark.parametrize(
    ("name", "options", "message"),
    [
        (
            "road.xyz",
            {},
            r"its ending does not tell the format; written are files that end in \.crg, \.erd, \.mat, \.nc",
        ),
        ("road.gpx", {}, r"gpx is only read, not written; written are files that end in \.crg"),
        ("road.csv", {"encoding": "float"}, "csv has no encoding 'float'; it has none"),
        ("road.csv", {"format": "docx"}, "there is no format 'docx'; it is one of crg, erd, mat, netcdf, csv$"),
        ("road.crg", {}, "needs the lateral positions of two paths"),
    ],
)
def test_what_cannot_be_written(tmp_path, name, options, message):
    with pytest.raises(ValueError, match=message):
        mf.write_profile(mf.Profile(np.arange(5.0), np.zeros((5, 2))), tmp_path / name, **options)


# OpenCRG. A file written by hand: what its numbers mean is the standard's, not a library's.

HAND = """$ROAD_CRG
REFERENCE_LINE_START_U = 100.0
REFERENCE_LINE_END_U = 104.0
REFERENCE_LINE_INCREMENT = 1.0
REFERENCE_LINE_START_X = 0.0
REFERENCE_LINE_START_Y = 0.0
REFERENCE_LINE_START_PHI = 0.0
REFERENCE_LINE_START_Z = 5.0
$
$KD_Definition
#:LRFI
D:reference line slope,m/m
D:reference line banking,m/m
D:long section at v = -1.5,m
D:long section at v = 0.0,m
D:long section at v = 2.0,m
$
$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$$
"""


def hand_made(right="0.03"):
    rows = [("0.1", "0.02", right, "0.00", f"0.{n}") for n in range(5)]
    return HAND + "".join("".join(f"{word:>10}" for word in row) + "\n" for row in rows)


def test_slope_banking_and_sides_of_a_grid(tmp_path):
    """Surface: 5 m + 0.1 (u − u₀) + 0.02 v + grid, v to the left."""
    file = written(tmp_path, "hand.crg", hand_made())
    profile, understood = mf.read_profile(file, across=[2.0, 1.0, -1.5])
    along = np.arange(5.0)
    assert profile.stations.tolist() == (100 + along).tolist()
    left = 5.0 + 0.1 * along + 0.02 * 2.0 + 0.1 * along
    between = 5.0 + 0.1 * along + 0.02 * 1.0 + 0.05 * along
    right = 5.0 + 0.1 * along - 0.02 * 1.5 + 0.03
    assert profile.elevation == pytest.approx(np.stack([left, between, right], axis=1), rel=1e-14)
    for words in ("slope) added", "banking added", "text, single precision"):
        assert words in understood
    # All long sections, from left to right.
    assert mf.read_profile(file).profile.across == (2.0, 0.0, -1.5)


def test_nan_at_a_rim_is_told_or_cropped(tmp_path):
    file = written(tmp_path, "hand.crg", hand_made(right="*****"))
    with pytest.raises(ValueError, match=r"no elevation at 100 m, -1.5 m across; in all 5 elevations are missing"):
        mf.read_profile(file)
    profile, _ = mf.read_profile(file, crop_rims=True)
    assert profile.across == (2.0, 0.0)
    assert profile.steps == ("left out 0 long sections at the left rim and 1 at the right",)
    # On a long section its neighbour without elevations does not count; beside it, it does.
    assert mf.read_profile(file, across=[0.0]).profile.paths == 1
    with pytest.raises(ValueError, match=r"no elevation at 100 m, -0.1 m across"):
        mf.read_profile(file, across=[-0.1])
    with pytest.raises(
        ValueError,
        match=r"-1.5 m \(right\) to 2 m \(left\), but `across` \(on the command line --across\) asks for 2.1 m",
    ):
        mf.read_profile(file, across=[2.1])


def test_lateral_positions_from_other_files(tmp_path):
    from scipy.io import savemat

    x, z = np.arange(5.0), np.arange(10.0).reshape(5, 2)
    for across, message in (([0.0], "one lateral position for each path"), ([1.0, 1.0], "all different")):
        savemat(tmp_path / "a.mat", {"distance": x, "elevation": z, "across": across})
        with pytest.raises(ValueError, match=message):
            mf.read_profile(tmp_path / "a.mat", across=[0.0])
    savemat(tmp_path / "a.mat", {"distance": x, "elevation": z, "across": [-1.0, 1.0]})
    assert mf.read_profile(tmp_path / "a.mat", across=[0.0]).profile.elevation[1].tolist() == [2.5]
    mf.write_profile(mf.Profile(x, z[:, :1], across=(0.5,)), tmp_path / "b.nc")
    assert mf.read_profile(tmp_path / "b.nc", across=[0.5]).profile.elevation[:, 0].tolist() == z[:, 0].tolist()
    with pytest.raises(ValueError, match=r"reaches from 0.5 m \(right\) to 0.5 m \(left\)"):
        mf.read_profile(tmp_path / "b.nc", across=[0.6])


def test_modifiers_of_a_grid_are_named_and_not_applied(tmp_path):
    mods = "$ROAD_CRG_MODS\nSCALE_Z_GRID = 2.0\n$\n$KD_Definition"
    profile, understood = mf.read_profile(written(tmp_path, "a.crg", hand_made().replace("$KD_Definition", mods)))
    assert "modifiers not applied (scale_z_grid)" in understood
    assert np.array_equal(
        profile.elevation, mf.read_profile(written(tmp_path, "b.crg", hand_made())).profile.elevation
    )


def test_without_the_library_the_message_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyopencrg", None)
    with pytest.raises(ValueError, match=r"need PyOpenCRG: pip install 'movingfrf\[io\]'"):
        mf.read_profile(written(tmp_path, "hand.crg", hand_made()))


@needs("belgian_block.crg")
def test_the_belgian_block_number_by_number():
    """Against its big-endian floats, read without any knowledge of the format but their number and order."""
    data = (DATA / "belgian_block.crg").read_bytes()
    channels = data[: 2**16].count(b"\nD:")
    rows = 1001
    # Records of 80 bytes fill up the end.
    begin = data.index(b"\n", data.index(b"\n$$$$") + 1) + 1
    grid = np.frombuffer(data[begin : begin + 4 * rows * channels], ">f4").reshape(rows, channels)[:, 1:]
    assert channels == 342
    profile, understood = mf.read_profile(DATA / "belgian_block.crg", across=(0.75, -0.75, 0.333))
    at = [round((across + 1.7) / 0.01) for across in (0.75, -0.75)]
    assert np.array_equal(profile.elevation[:, :2], grid[:, at].astype(float))
    between = 0.7 * grid[:, 203].astype(float) + 0.3 * grid[:, 204].astype(float)
    assert profile.elevation[:, 2] == pytest.approx(between, rel=1e-12)
    assert "curved reference line" in understood
    # Detrended, the figures that come with the file: 23 and 24 mm.
    assert 1e3 * mf.detrended(profile).elevation[:, :2].std(axis=0) == pytest.approx([24, 23], abs=0.5)
    with pytest.raises(ValueError, match=r"no elevation at 733.59 m, -1.38 m across; in all 22228"):
        mf.read_profile(DATA / "belgian_block.crg")
    assert np.isnan(grid).sum() == 22228


@pytest.mark.parametrize(("name", "inches"), [("1in", 0.957), ("2in", 1.741)])
@needs("detrended_rms_course_1in.crg")
def test_the_ride_courses(name, inches):
    profile, _ = mf.read_profile(DATA / f"detrended_rms_course_{name}.crg", across=[0.0])
    course = mf.cropped(profile, first=100.0, last=404.8)
    assert course.elevation.std() / 0.0254 == pytest.approx(inches, abs=5e-4)


# ERD.

LTPP = """ERDFILEV2.00
      3,   {count},     -1,      1,      5,       0.0250,     -1,
TITLE   A section: Run 1
SHORTNAMLElev.  RElev.  CElev.
UNITSNAMmm      mm      mm
XLABEL  Distance
XUNITS  m
DATE    11/Apr/1997

END
"""


@pytest.mark.parametrize("separator", ["  ", ","])
def test_erd_as_a_profiler_writes_it(tmp_path, separator):
    rows = "".join(separator.join([f"{n}.5", f"{-n}", "1e1"]) + "\n" for n in range(6))
    file = written(tmp_path, "run.erd", LTPP.format(count=6) + rows)
    profile, understood = mf.read_profile(file)
    assert profile.elevation == pytest.approx(1e-3 * np.array([[n + 0.5, -n, 10.0] for n in range(6)]))
    assert profile.stations == pytest.approx(0.025 * np.arange(6))
    assert profile.source == "run.erd (A section: Run 1)"
    assert "'LElev.', 'RElev.', 'CElev.' in mm" in understood
    assert mf.read_profile(file, columns=["RElev."]).profile.elevation.tolist() == profile.elevation[:, 1].tolist()


def test_erd_with_several_samples_in_a_line(tmp_path):
    text = LTPP.format(count=4) + "\n".join(" ".join(str(6 * line + n) for n in range(6)) for line in range(2))
    profile, _ = mf.read_profile(written(tmp_path, "run.erd", text))
    assert profile.elevation == pytest.approx(1e-3 * np.arange(12.0).reshape(4, 3))


@pytest.mark.parametrize(("key", "code"), [(0, "h"), (1, "f"), (2, "d")])
def test_erd_with_binary_numbers_beside_it(tmp_path, key, code):
    header = LTPP.format(count=4).replace("     5,", f"     {key},")
    file = written(tmp_path, "run.erd", header)
    (tmp_path / "run.bin").write_bytes(struct.pack(f"<12{code}", *range(12)))
    profile, _ = mf.read_profile(file)
    assert profile.elevation == pytest.approx(1e-3 * np.arange(12.0).reshape(4, 3))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("ERDFILEV2.00\n", "has no line END"),
        ("ERDFILEV2.00\nEND\n", "line 2: expected channels, samples"),
        (LTPP.format(count=7) + "1 2 3\n" * 4, "announces 7 samples for each channel, but 4 are there"),
        (LTPP.format(count=4) + "1 2 3\n1 2 x\n1 2 3\n1 2 3\n", "line 2: expected numbers separated by spaces"),
        (LTPP.format(count=4) + "1 2\n" * 6, "2 numbers in a line do not fit 3 channels"),
        (LTPP.format(count=4), "has no numbers behind its header"),
        (LTPP.format(count=4).replace("  5,", " 17,"), "stored in the way 17 are not understood"),
        (LTPP.format(count=4).replace("  5,", "  1,"), r"needs its binary numbers in run.erd.bin beside it"),
        (LTPP.format(count=4).replace("0.0250", "abc"), "must have a number for the step, got 'abc'"),
        (LTPP.format(count=4).replace("UNITSNAMmm ", "UNITSNAMm/km"), "the unit 'm/km' of channel 'LElev.'"),
        (LTPP.format(count=4).replace("DATE", "GAIN"), "scales its numbers by GAIN"),
    ],
)
def test_faulty_erd(tmp_path, text, message):
    with pytest.raises(ValueError, match=message):
        mf.read_profile(written(tmp_path, "run.erd", text))


# MATLAB and HDF5.


@pytest.mark.parametrize("packed", [False, True])
@pytest.mark.parametrize("kind", ["f8", "f4", "i2", "u1"])
def test_matlab_arrays_as_scipy_writes_them(tmp_path, packed, kind):
    from scipy.io import savemat

    x, z = np.arange(20.0), np.arange(40).reshape(20, 2).astype(kind)
    rest = {"note": "text", "limits": np.zeros((2, 2)), "odd": {"a": 1.0}, "cell": np.array(["a", 1.0], object)}
    savemat(tmp_path / "road.mat", {"x": x, "z": z, **rest}, do_compression=packed)
    profile, understood = mf.read_profile(tmp_path / "road.mat")
    assert np.array_equal(profile.elevation, z)
    assert "stations 'x' and elevations 'z'" in understood


def test_a_matlab_file_of_the_other_byte_order(tmp_path):
    def element(kind, data):
        return struct.pack(">II", kind, len(data)) + data + bytes(-len(data) % 8)

    def matrix(name, values):
        parts = element(6, struct.pack(">II", 6, 0)) + element(5, struct.pack(">ii", len(values), 1))
        return element(14, parts + element(1, name) + element(9, struct.pack(f">{len(values)}d", *values)))

    head = b"MATLAB 5.0 MAT-file".ljust(124) + b"\x01\x00MI"
    file = written(tmp_path, "road.mat", head + matrix(b"s", range(5)) + matrix(b"h", [0.1, 0.2, 0.1, 0.0, 0.1]))
    assert mf.read_profile(file).profile.elevation.tolist() == [0.1, 0.2, 0.1, 0.0, 0.1]


@needs("IRI_737b.mat")
def test_a_published_matlab_profile():
    from scipy.io import loadmat

    profile = mf.read_profile(DATA / "IRI_737b.mat").profile
    other = loadmat(DATA / "IRI_737b.mat")
    assert np.array_equal(profile.stations, other["road_x"].ravel())
    assert np.array_equal(profile.elevation, other["road_z"].ravel())


def test_arrays_that_cannot_be_told_apart_are_listed(tmp_path):
    from scipy.io import savemat

    x = np.arange(6.0)
    savemat(tmp_path / "road.mat", {"x": x, "left": -x, "right": 0 * x})
    with pytest.raises(
        ValueError, match=r"no arrays that are clearly .*: 'x' 1 by 6; 'left' 1 by 6; 'right' 1 by 6"
    ):
        mf.read_profile(tmp_path / "road.mat")
    profile = mf.read_profile(tmp_path / "road.mat", columns=["x", "left", "right"]).profile
    assert profile.elevation[3].tolist() == [-3.0, 0.0]
    savemat(tmp_path / "road.mat", {"x": x, "z": np.zeros(5)})
    with pytest.raises(ValueError, match=r"has 6 stations, but 'z' has the shape \(5, 1\)"):
        mf.read_profile(tmp_path / "road.mat")


def test_hdf5_with_units_and_a_matlab_7_3_file(tmp_path):
    import h5py

    fuzz_readers._packed(fuzz_readers.profile(), tmp_path)
    profile, understood = mf.read_profile(tmp_path / "version73.mat")
    assert np.array_equal(profile.elevation, fuzz_readers.profile().elevation)
    assert "MATLAB 7.3" in understood
    with h5py.File(tmp_path / "other.nc", "w") as file:
        file["s"], file["h"] = np.arange(6.0), np.array([1.0, 2.0, 1.0, 3.0, 1.0, 0.0])
        file["h"].attrs["units"] = "mm"
    assert mf.read_profile(tmp_path / "other.nc").profile.elevation == pytest.approx(
        1e-3 * np.array([1.0, 2.0, 1.0, 3.0, 1.0, 0.0])
    )


def test_what_matlab_stores_as_numbers_and_what_netcdf_packs_into_them(tmp_path):
    import h5py

    with h5py.File(tmp_path / "other.nc", "w") as file:
        file["x"] = np.arange(6.0)
        file["note"] = np.arange(20, dtype="u2")
        file["note"].attrs["MATLAB_class"] = np.bytes_("char")
        file["z"] = np.array([10, 20, -999, 40, 50, 60], "i2")
        file["z"].attrs.update({"scale_factor": np.array([0.5]), "add_offset": 1.0, "_FillValue": np.int16(-999)})
        file["z"].attrs["units"] = "cm"
    with pytest.raises(ValueError, match=r"value 3: no elevation at 2 m"):
        mf.read_profile(tmp_path / "other.nc")
    profile = mf.read_profile(tmp_path / "other.nc", repair_gaps=2.0).profile
    assert profile.elevation == pytest.approx(0.01 * np.array([6.0, 11.0, 16.0, 21.0, 26.0, 31.0]))


def test_an_hdf5_library_that_hangs_or_crashes_is_not_waited_for(tmp_path, monkeypatch):
    """As it does on some damaged files; too rare to keep one that does so with every version of it."""
    mf.write_profile(fuzz_readers.profile(), tmp_path / "road.nc")
    with monkeypatch.context() as patched:
        patched.setattr(hdf, "LIMITS", replace(hdf.LIMITS, patience=0.0))
        with pytest.raises(ValueError, match=r"road\.nc: is damaged: reading it comes to no end"):
            mf.read_profile(tmp_path / "road.nc")
    monkeypatch.setattr(sys, "executable", "/bin/false")
    with pytest.raises(ValueError, match=r"road\.nc: is damaged, or no HDF5 file: the HDF5 library fails on it"):
        mf.read_profile(tmp_path / "road.nc")


def test_files_that_claim_more_than_they_hold(tmp_path):
    import h5py
    from scipy.io import savemat

    with h5py.File(tmp_path / "vast.nc", "w") as file:
        file["distance"] = np.arange(10.0)
        file.create_dataset("elevation", shape=(10, 10**9), chunks=(10, 1000), dtype="f8")
    with pytest.raises(ValueError, match=r"the array 'elevation' claims .* MiB, far more than the file can hold"):
        mf.read_profile(tmp_path / "vast.nc")
    savemat(tmp_path / "bomb.mat", {"x": np.arange(8.0), "z": np.zeros(18_000_000)}, do_compression=True)
    with pytest.raises(ValueError, match="unpacks to more than 10 times its size"):
        mf.read_profile(tmp_path / "bomb.mat", columns=["x", "z"])
    (tmp_path / "cut.nc").write_bytes((tmp_path / "vast.nc").read_bytes()[:1000])
    with pytest.raises(ValueError, match="cut short"):
        mf.read_profile(tmp_path / "cut.nc")


# GPX.


@pytest.mark.parametrize(
    ("latitude", "north", "east"),
    [
        (0, 110.574, 111.320),
        (30, 110.852, 96.486),
        (45, 111.132, 78.847),
        (60, 111.412, 55.800),
        (75, 111.618, 28.902),
    ],
)
def test_length_of_a_degree(latitude, north, east):
    """Tabulated lengths of a degree on WGS 84 [km], to their last digit."""
    fine = np.linspace(-0.5, 0.5, 101)
    assert distances(latitude + fine, 0 * fine).sum() / 1e3 == pytest.approx(north, abs=1e-3)
    assert distances(latitude + 0 * fine, 179.8 + fine).sum() / 1e3 == pytest.approx(east, abs=1e-3)


def test_short_distances_against_chords_in_space():
    """Chord between two points of the ellipsoid in Cartesian coordinates; it is shorter than the arc by d²/24R²."""
    random = np.random.default_rng(0)
    phi, lam = random.uniform(-70, 70, 50), random.uniform(-180, 180, 50)
    near = [
        np.stack([v, v + d], axis=1)
        for v, d in ((phi, random.normal(0, 2e-3, 50)), (lam, random.normal(0, 2e-3, 50)))
    ]
    a, e2 = 6378137.0, 2 / 298.257223563 - 1 / 298.257223563**2
    p, q = np.radians(near[0]), np.radians(near[1])
    n = a / np.sqrt(1 - e2 * np.sin(p) ** 2)
    points = np.stack([n * np.cos(p) * np.cos(q), n * np.cos(p) * np.sin(q), n * (1 - e2) * np.sin(p)])
    chords = np.linalg.norm(np.diff(points, axis=2)[..., 0], axis=0)
    found = np.array([distances(u, v)[0] for u, v in zip(*near, strict=True)])
    assert found == pytest.approx(chords, rel=3e-8)


GPX = fuzz_readers.GPX


def points(*places):
    return GPX % b"".join(fuzz_readers.POINT % place for place in places)


def test_a_track_that_stands_still_for_a_while(tmp_path):
    places = [
        (48.0, 9.0, 300.0),
        (48.001, 9.0, 301.0),
        (48.001, 9.0, 301.5),
        (48.002, 9.0, 302.0),
        (48.003, 9.0, 299.0),
    ]
    profile, understood = mf.read_profile(written(tmp_path, "track.gpx", points(*places)))
    assert profile.elevation.tolist() == [300.0, 301.0, 302.0, 299.0]
    assert np.diff(profile.stations) == pytest.approx(111.2, rel=1e-3)
    assert profile.steps == ("1 points that do not lead on left out",)
    assert profile.source == "track.gpx (A road)"
    assert "ellipsoid of WGS 84" in understood


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (GPX % b"", "has no points"),
        (points((48.0, 200.0, 1.0)), "has a point with lon='200.000000', which must lie within ±180"),
        (GPX % b'<trkpt lat="1" lon="2"><ele>high</ele></trkpt>', "has the height 'high', which is no number"),
        (GPX % b'<trkpt lat="1" lon="2">', "is not XML"),
        (b'<!DOCTYPE x [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;">]><gpx>&b;</gpx>', "declares a document type"),
    ],
)
def test_faulty_tracks(tmp_path, text, message):
    with pytest.raises(ValueError, match=message):
        mf.read_profile(written(tmp_path, "track.gpx", text))


# Options that do not suit.


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"across": [0.0]}, "has no lateral positions"),
        ({"across": []}, "across must name at least one lateral position"),
        ({"across": "left"}, "across must"),
        ({"columns": 3}, "columns must be a list of names or numbers"),
        ({"columns": [0, 0]}, "name one column twice"),
        ({"columns": [0]}, "a station and at least one elevation"),
        ({"crop_rims": 1}, "crop_rims must be true or false"),
        ({"repair_gaps": -1.0}, "repair_gaps must be positive"),
        ({"format": "docx"}, "format must be one of crg, erd, mat, netcdf, gpx, csv, got 'docx'"),
        ({"format": ["csv"]}, "format must be one of"),
    ],
)
def test_options_that_do_not_suit(tmp_path, options, message):
    file = written(tmp_path, "road.csv", "0,1\n1,2\n2,3\n3,4\n")
    with pytest.raises(ValueError, match=message):
        mf.read_profile(file, **options)


def test_the_format_can_be_named(tmp_path):
    file = written(tmp_path, "road", b"MATLAB \n")
    with pytest.raises(ValueError, match="no MATLAB file of version 5"):
        mf.read_profile(file, format="mat")


# Damage. Tiny files in numbers; files of some size for how much memory their reader takes.


def test_damaged_files_are_read_or_refused():
    """A small share of `python -m tests.fuzz_readers`, in processes of their own."""
    found = fuzz_readers.run(40, seed=7)
    assert len(found) == 13
    assert not {name: counts for name, counts in found.items() if counts.keys() - {"read", "refused"}}


@pytest.mark.parametrize("name", ["a.csv", "a.erd", "a.mat", "a.nc", "a.crg", "b.crg", "c.erd", "a.gpx"])
def test_memory_stays_below_ten_times_the_file(tmp_path, name):
    import tracemalloc

    file = tmp_path / name
    if name == "a.gpx":
        file.write_bytes(points(*((48 + 1e-5 * n, 9.0, 300.0) for n in range(20_000))))
    else:
        encoding = {"b.crg": "short text", "c.erd": "float"}.get(name)
        mf.write_profile(fuzz_readers.profile(150_000 if name == "b.crg" else 20_000), file, encoding=encoding)
    mf.read_profile(file)  # loads what it needs
    tracemalloc.start()
    try:
        mf.read_profile(file)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    # Text of OpenCRG is taken apart 100,000 lines at a time, at close to 1 kB each, however small the file.
    most = 2**27 if name == "b.crg" else 10 * sum(part.stat().st_size for part in tmp_path.iterdir())
    assert peak < most

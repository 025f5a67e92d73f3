"""Profiles from files and into files, format by format."""

import struct
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import movingfrf as mf
from movingfrf.commands.main import main
from movingfrf.roughness.files import FORMATS
from tests.reader_parts import DATA, needs, written

STATIONS, HEIGHTS = np.array([0.0, 0.5, 1.25, 2.0, 3.0]), np.array([583.1, 583.2, 583.15, 583.0, 583.05])


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
    assert "without 'Speed [km/h]' (no elevation)" in mf.read_profile(file).understood
    with pytest.raises(ValueError, match=r"line 1: the unit 'km/h' of column 'Speed \[km/h\]' is not known"):
        mf.read_profile(file, columns=["Station", "Speed"])
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
        ("1\n2\n3\n4\n", "line 1: expected two numbers or more"),
        ("0,1\n1,2\n2,x\n3,4\n", "line 3: expected numbers separated by commas, got '2,x'"),
        ("0,1\n1,2\n2\n3,4\n", "line 3: expected 2 columns as before, got 1"),
        ("0,1\n1,2\n2,1,7\n3,4\n", "line 3: expected 2 columns as before, got 3"),
        ("# c\n0,1\n\n1,2\n1,3\n2,4\n", "line 5: distance must increase, got 1 m followed by 1 m"),
        ("0,1\n1,2\n2,nan\n3,4\n", "line 3: no elevation at 2 m; in all 1 elevation is missing in 1 gap"),
        ("0,1\n1,2\n2,inf\n3,4\n", "line 3: elevation must be finite"),
        ("0,1\n1,2\nnan,3\n3,4\n", "line 3: there is no station"),
        ("0,1\n1,2\n2,3\n", "at least 4 stations"),
        ("0,5.8o3\n1,2\n2,3\n3,4\n4,5\n", "line 1: expected numbers"),
        ("0;1.234,5\n1;2\n2;3\n3;4\n", "line 1: expected a station|line 1: expected numbers"),
        ("0;1,5\n1;2.5\n2;3\n3;4\n", "line 2: expected numbers separated by semicolons, got '1;2.5'"),
        ("0,0, 1,5\n1,0, 2,5\n2,0, 2,5\n3,0, 2,5\n", "line 1: commas with and without a space"),
        ("x,y,z\n0,1\n1,2\n2,3\n3,4\n", "line 2: expected 3 columns as before, got 2"),
        ("x,y\n0,1,2\n1,2,3\n2,3,4\n3,4,5\n", "line 1: 2 names for 3 columns"),
        ("x [furlong],z [m]\n0,1\n1,2\n2,3\n3,4\n", "line 1: the unit 'furlong' of column"),
        ("x,z\nfoo,bar\n0,1\n1,2\n2,3\n3,4\n", "line 2: expected numbers"),
        ("0,1\n1,2\n2,1e400\n3,4\n", r"line 3: (station and )?elevation must be finite"),
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
    assert profile.steps[0] == "left out 1 station at the beginning and 0 at the end"


# Round trips: the precision of each format. A float keeps 24 bits; the text forms of OpenCRG keep 18 decimals (then
# rounded to a number) or 7.
PRECISION = {
    ("road.csv", None): 0.0,
    ("road.nc", None): 0.0,
    ("road.mat", None): 0.0,
    ("road.npz", None): 0.0,
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
    if name.endswith(("nc", "crg", "mat", "npz")):
        assert back.across == pytest.approx((0.75, -0.75))
    if name.endswith(("nc", "npz")):
        assert back.steps == ("made up",)


def test_every_format_is_tried_and_told_of(capsys):
    written = [form for form in FORMATS.values() if form.made]
    assert {(f"road{form.endings[0]}", encoding or None) for form in written for encoding in form.encodings} == {
        *PRECISION
    }
    for command in ("profile", "convert"):
        assert main([command, "--help"]) == 0
        said = " ".join(capsys.readouterr().out.replace("│", " ").split())
        assert "{" not in said
        for form in FORMATS.values():
            assert form.title in said
            assert form.name in said
            assert command == "profile" or not form.made or form.endings[0] in said
            assert command == "profile" or not any(form.encodings) or f"of {form.name} {form.encodings[0]}" in said
    for form in FORMATS.values():
        assert form.title in mf.read_profile.__doc__
        assert (form.name in mf.write_profile.__doc__) == (form.made is not None)


@pytest.mark.parametrize("name", ["road.csv", "road.nc", "road.mat", "road.npz", "road.erd", "road.crg"])
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
    for name in ("road.csv", "road.nc", "road.mat", "road.npz"):
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
        ("road.csv", {"format": "docx"}, "there is no format 'docx'; it is one of crg, .*, csv$"),
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
    with pytest.raises(ValueError, match=r"need PyOpenCRG: pip install PyOpenCRG, or the extra `io`"):
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

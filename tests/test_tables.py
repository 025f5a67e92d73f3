"""Text tables and spreadsheets as people have them: which column is what, units, and what is no row."""

import re
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest

import movingfrf as mf
from movingfrf.commands.main import main
from movingfrf.metrics.profile import describe_profile
from movingfrf.roughness.formats import fields
from tests.fuzz_readers import damaged
from tests.reader_parts import written
from tests.spreadsheets import ods, xlsx

CASES = Path(__file__).parent / "data" / "cases"


def index(file, **options):
    profile, understood = mf.read_profile(file, **options)
    return [round(path.index, 3) for path in describe_profile(profile).paths], understood


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("right.csv", "one header line"),
        ("index-column.csv", "without '' (a counter)"),
        ("time-column.csv", "without 'time' (a time)"),
        ("unit-in-name.csv", "'station_ft' from ft"),
        ("commented-names.txt", "'distance [mm]' from mm"),
        ("quoted-comma.csv", "'Elevation, mm' from mm"),
        ("sep-line.csv", "separated by semicolons"),
        ("title-line.csv", "1 line above left out"),
        ("preamble.txt", "4 lines above left out"),
    ],
)
def test_one_road_in_every_form(name, said):
    """A road of which the right index is known from another program."""
    found, understood = index(CASES / name)
    assert set(found) == {3.059}
    assert "600 stations from 0 m to 45.6438 m" in understood
    assert said in understood


def test_a_gap_at_the_rim():
    with pytest.raises(ValueError, match=r"line 2: no elevation at 0 m; in all 2 .* open, at an end"):
        mf.read_profile(CASES / "leading-empty.csv")
    profile, _ = mf.read_profile(CASES / "leading-empty.csv", crop_rims=True)
    assert profile.steps == ("left out 2 stations at the beginning and 0 at the end",)
    whole = mf.read_profile(CASES / "right.csv").profile
    assert profile.elevation == pytest.approx(whole.elevation[2:], abs=1e-6)


# Every text below holds this road: stations 0, 0.5, 1, 1.5, 2 m, elevations in mm; a second path is twice as high.
STATIONS, HEIGHTS = [0.0, 0.5, 1.0, 1.5, 2.0], [0.0, 1.5, -2.0, 4.0, 1.0]


def lines(form, **scales):
    """Write a line for each station: {n} counts, {x} is the station, {z} the elevation, {y} of another path."""
    along, up = scales.get("along", 1.0), scales.get("up", 1.0)
    texts = [
        form.format(n=n, x=f"{x * along:.10g}", z=f"{z * up:.10g}", y=f"{2 * z * up:.10g}")
        for n, (x, z) in enumerate(zip(STATIONS, HEIGHTS, strict=True))
    ]
    return "".join(f"{text}\n" for text in texts)


def european(text):
    return text.replace(",", ";").replace(".", ",")


STATION = [
    ("index,Weg [m],Höhe [mm]\n" + lines("{n},{x},{z}"), "without 'index' (a counter)"),
    (european("Nr,Höhe (mm),Station (m)\n" + lines("{n},{z},{x}")), "without 'Nr' (a counter)"),
    ("Unnamed: 0,z_mm,chainage_m\n" + lines("{n},{z},{x}"), "columns 'chainage_m', 'z_mm'"),
    ("elevation [mm],mileage [m]\n" + lines("{z},{x}"), "columns 'mileage [m]', 'elevation [mm]'"),
    ("Timestamp,Position [m],Profil [mm]\n" + lines("2026-11-30 12:00:0{n},{x},{z}"), "'Timestamp' (no numbers)"),
    ("t [ms];s [m];h [mm]\n" + lines("{n}0;{x};{z}"), "without 't [ms]' (a time)"),
    ("Strecke/km;Höhe/mm;IRI;Bemerkung\n" + lines("{x};{z};1.5;", along=1e-3), "'Bemerkung' (empty)"),
    ("lane,lat,lon,x [m],speed [km/h],z [mm]\n" + lines("1,48.{n},9.{n},{x},80,{z}"), "'lane' (no elevation)"),
    ("a,b,c,d\n" + lines("{n},{x},{z},joint", up=1e-3), "without 'a' (a counter), 'd' (no numbers)"),
    ("distance [m],elevation [mm],remark\n" + lines("{x},{z},").replace("4,", "4,bump"), "'remark' (no numbers)"),
]


@pytest.mark.parametrize(("text", "said"), STATION)
def test_the_station_is_known_by_its_name(tmp_path, text, said):
    profile, understood = mf.read_profile(written(tmp_path, "road.csv", text))
    assert profile.stations == pytest.approx(STATIONS, rel=1e-12)
    assert profile.elevation == pytest.approx(1e-3 * np.array(HEIGHTS), rel=1e-12)
    assert said in understood


UNITS = [
    lines("{x},{z}", along=1 / 0.3048).replace("0,0\n", "Station (ft),Elevation (mm)\n0,0\n", 1),
    "dist_km,z_mm\n" + lines("{x},{z}", along=1e-3),
    "Station ft;Höhe in\n" + lines("{x};{z}", along=1 / 0.3048, up=1 / 25.4),
    "x in cm\tz in mm\n" + lines("{x}\t{z}", along=100),
    "x,z\n(m),(mm)\n" + lines("{x},{z}"),
    "# distance, elevation\n# m, mm\n" + lines("{x},{z}"),
    "% x[cm]   z[mm]\n" + lines("{x} {z}", along=100),
    "// distance [m]; elevation [mm]\n" + lines("{x}  {z}"),
    "Distance along road [m]   Elevation left [mm]\n" + lines("{x} {z}"),
    "Chainage [m]\tElevation [µm]\n" + lines("{x}\t{z}", up=1000),
]


@pytest.mark.parametrize("text", UNITS)
def test_units_wherever_they_stand(tmp_path, text):
    profile, _ = mf.read_profile(written(tmp_path, "road.txt", text))
    assert profile.stations == pytest.approx(STATIONS, rel=1e-9)
    assert profile.elevation == pytest.approx(1e-3 * np.array(HEIGHTS), rel=1e-9)


def test_units_that_are_asked_for(tmp_path, capsys):
    file = written(tmp_path, "road.csv", "a,b,c\n" + lines("{x},{z},{y}"))
    profile, understood = mf.read_profile(file, units=("ft", "in"))
    assert profile.stations == pytest.approx(0.3048 * np.array(STATIONS), rel=1e-15)
    assert profile.elevation[:, 1] == pytest.approx(0.0508 * np.array(HEIGHTS), rel=1e-15)
    assert "'a' from ft, 'b' from in" in understood
    assert mf.read_profile(file, units=("m", "mm", "cm")).profile.elevation[3].tolist() == [0.004, 0.08]
    wrong = written(tmp_path, "wrong.csv", "x [furlong],z [m]\n" + lines("{x},{z}"))
    assert mf.read_profile(wrong, units=("m", "mm")).profile.elevation[1] == 1.5e-3
    assert main(["profile", str(file), "--units", "ft,in"]) == 0
    assert "'b' from in" in " ".join(capsys.readouterr().out.split())
    with pytest.raises(ValueError, match=r"must be those of the station and of the elevations.* 2 paths, got 4"):
        mf.read_profile(file, units=("m", "m", "m", "m"))
    with pytest.raises(ValueError, match="the unit 'furlong' of column 'a' is not known"):
        mf.read_profile(file, units=("furlong", "m"))
    with pytest.raises(ValueError, match="must be a list of units"):
        mf.read_profile(file, units="ft")


TIMED = ["t [s],z [mm]\n", "Zeit,Höhe\ns,mm\n", "time,elevation_mm\n", "# time [s], profile [mm]\n"]


@pytest.mark.parametrize("header", TIMED)
def test_a_record_over_time_needs_a_speed(tmp_path, header):
    file = written(tmp_path, "road.csv", header + lines("{x},{z}"))
    with pytest.raises(ValueError, match=r"is a record over time .*`speed` \(on the command line --speed\)"):
        mf.read_profile(file)
    profile, _ = mf.read_profile(file, speed=20.0)
    assert profile.stations == pytest.approx(20.0 * np.array(STATIONS), rel=1e-15)
    assert profile.elevation == pytest.approx(1e-3 * np.array(HEIGHTS), rel=1e-15)
    assert profile.steps == ("turned times into distances at 20 m/s",)


def test_a_speed_for_times_only(tmp_path):
    with pytest.raises(ValueError, match="has distances of its own"):
        mf.read_profile(CASES / "time-column.csv", speed=5.0)
    file = written(tmp_path, "road.csv", lines("{x},{z}"))
    profile, _ = mf.read_profile(file, units=("ms", "mm"), speed=100.0)
    assert profile.stations == pytest.approx(0.1 * np.array(STATIONS), rel=1e-15)
    with pytest.raises(ValueError, match="speed must be positive"):
        mf.read_profile(file, speed=-1.0)


@pytest.mark.parametrize("name", ["road.mat", "road.npz", "road.nc", "road.erd"])
def test_units_that_are_asked_for_hold_in_every_format_that_leaves_them_open(tmp_path, name):
    mf.write_profile(mf.Profile(STATIONS, HEIGHTS), tmp_path / name)
    profile, understood = mf.read_profile(tmp_path / name, units=("ft", "in"))
    assert profile.stations == pytest.approx(0.3048 * np.array(STATIONS), rel=1e-15)
    assert profile.columns[:, 0] == pytest.approx(0.0254 * np.array(HEIGHTS), rel=1e-15)
    assert "ft" in understood
    assert "in" in understood


@pytest.mark.parametrize(("stations", "across"), [("t", None), ("time_s", None), ("time", [0.75])])
def test_arrays_over_time_need_a_speed(tmp_path, stations, across):
    np.savez(tmp_path / "road.npz", **{stations: STATIONS, "z": HEIGHTS}, **({"across": across} if across else {}))
    with pytest.raises(ValueError, match=r"is a record over time.*`speed`"):
        mf.read_profile(tmp_path / "road.npz")
    profile, _ = mf.read_profile(tmp_path / "road.npz", speed=20.0)
    assert profile.stations == pytest.approx(20.0 * np.array(STATIONS), rel=1e-15)
    assert profile.columns[:, 0].tolist() == HEIGHTS


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("sample,height\n" + lines("{n},{z}"), r"'height' is a distance along the road \('sample' is a counter\)"),
        ("lat,lon,ele\n" + lines("{n},9,{z}"), "is a distance along the road .*'lon' is no elevation"),
        ("distance,IRI\n" + lines("{x},2"), r"is an elevation \('IRI' is no elevation\)"),
        ("Station;Höhe;Breite\n" + lines("A{n};{z};3"), "'Station' holds no numbers that could be stations"),
    ],
)
def test_what_is_no_profile(tmp_path, text, message):
    with pytest.raises(ValueError, match=message):
        mf.read_profile(written(tmp_path, "road.csv", text))


QUOTED = [
    '"Weg, m";"Höhe, mm"\n' + lines('"{x}";"{z}"').replace(".", ","),
    '"Distance, m","Elevation, mm"\n' + lines('"{x}","{z}"').replace(".", ","),
    '"x [m]","z [mm]","remark"\n' + lines('{x},{z},"joint, ""deep"" at {n}"'),
    '"Distance\n[m]","Elevation\n[mm]"\n' + lines("{x},{z}"),
    '"x [m]"   "z [mm]"\n' + lines('"{x}"   "{z}"'),
    "x [m],remark,z [mm]\n" + lines('{x},"two\nlines",{z}'),
    "x [m],z [mm],remark\n" + lines('{x},{z},"two\nlines"'),
]


@pytest.mark.parametrize("text", QUOTED)
def test_quotation_marks(tmp_path, text):
    profile, _ = mf.read_profile(written(tmp_path, "road.csv", text))
    assert profile.stations.tolist() == STATIONS
    assert profile.elevation == pytest.approx(1e-3 * np.array(HEIGHTS), rel=1e-15)


MISSING = (
    "NaN nan NA N/A n/a null NULL - -- --- ? * ***** #N/A #NV #DIV/0! 1.#QNAN none missing . k.A. <NA>".split()
)


@pytest.mark.parametrize("marker", ["", *MISSING])
@pytest.mark.parametrize("separator", [",", ";", "\t", " "])
def test_every_marker_of_what_is_missing(tmp_path, marker, separator):
    marker = marker or ('""' if separator == " " else "")
    text = lines("{x}|{z}|{y}").replace("|-2|", f"|{marker}|").replace("|", separator)
    file = written(tmp_path, "road.csv", text)
    with pytest.raises(ValueError, match="line 3: no elevation at 1 m on path 0; in all 1 elevation is"):
        mf.read_profile(file)
    assert mf.read_profile(file, repair_gaps=1.0).profile.elevation[2].tolist() == [2.75, -4.0]


ABOVE = [
    ("sep=,\n", "x [m],z [mm]\n", "one header line, columns"),
    ('"sep=,"\n', "x [m],z [mm]\n", "one header line, columns"),
    ("Profile of lane 1\nMeasured 30.11.2026 by AB, in rain\n\n", "x [m],z [mm]\n", "2 lines above left out"),
    ("Road,A12\nInterval,0.25\nLane,1\n", "distance [m],elevation [mm]\n", "3 lines above left out"),
    ("# made by hand\nRoad A12, lane 1\n", "distance [m],elevation [mm]\n# checked\n", "1 line above left out"),
    ("".join(f"Key {n}: value {n}\n" for n in range(100)), "x [m],z [mm]\n", "100 lines above left out"),
]


@pytest.mark.parametrize(("above", "names", "said"), ABOVE)
def test_what_stands_above_a_table(tmp_path, above, names, said):
    profile, understood = mf.read_profile(written(tmp_path, "road.csv", above + names + lines("{x},{z}")))
    assert profile.stations.tolist() == STATIONS
    assert profile.elevation == pytest.approx(1e-3 * np.array(HEIGHTS), rel=1e-15)
    assert said in understood


@pytest.mark.parametrize(
    ("names", "form"),
    [
        ("Distance    Elevation\n   (m)        (mm)\n--------   ---------\n", "{x} {z}"),
        ("Distance    Elevation\n--------   ---------\n   (m)        (mm)\n", "{x} {z}"),
        ("Distance,Elevation\n=====,=====\nm,mm\n", "{x},{z}"),
        ("distance,elevation,remark\n[m],[mm],text\n", "{x},{z},joint"),
        ("time,distance,elevation\nhh:mm:ss,m,mm\n", "12:00:0{n},{x},{z}"),
        ("distance;elevation;valid\nm;mm;yes/no\n", "{x};{z};yes"),
        ("distance [m]|elevation [mm]\n", "{x}|{z}"),
        ("sep=|\ndistance [m]|elevation [mm]|remark\n", "{x}|{z}|a, b"),
    ],
)
def test_names_units_and_rules_above_a_table(tmp_path, names, form):
    profile, _ = mf.read_profile(written(tmp_path, "road.txt", names + lines(form)))
    assert profile.stations.tolist() == STATIONS
    assert profile.elevation == pytest.approx(1e-3 * np.array(HEIGHTS), rel=1e-15)


@pytest.mark.parametrize("above", ["600,0.05\n", "12.5,80\n2024,5\n", "Lane 1\n600,2\n"])
def test_numbers_above_the_names_need_to_be_left_out(tmp_path, above):
    file = written(tmp_path, "road.csv", above + "distance [m],elevation [mm]\n" + lines("{x},{z}"))
    with pytest.raises(ValueError, match=r"line [23]: expected numbers .*--skip-lines\) leaves out lines above"):
        mf.read_profile(file)
    profile, _ = mf.read_profile(file, skip_lines=above.count("\n"))
    assert profile.elevation == pytest.approx(1e-3 * np.array(HEIGHTS), rel=1e-15)


def test_a_second_table_below_the_first_is_not_joined(tmp_path):
    with pytest.raises(
        ValueError, match=r"line 27: expected numbers .*a second table would need a file of its own"
    ):
        mf.read_profile(written(tmp_path, "road.csv", ("x,z\n" + many("{x},{z}", count=20)) * 2))


@pytest.mark.parametrize(
    ("text", "columns"),
    [
        ("event,x,z\n" + lines("{n},{x},{z}").replace("3,1.5", "bridge,1.5"), None),
        ("x,z,status\n" + lines("{x},{z},{n}").replace(",2\n", ",OK\n"), None),
        ("time,x,z\n" + lines("{n},{x},{z}").replace("2,1.0", "12:30,1.0"), None),
        ("x,z,other\n" + lines("{x},{z},{n}").replace(",2\n", ",bad\n"), ["x", "z"]),
        ("x,z,other\n" + lines("{x},{z},{n}").replace(",2\n", ",bad\n"), [0, 1]),
    ],
)
def test_a_text_in_a_column_that_is_not_taken(tmp_path, text, columns):
    profile, _ = mf.read_profile(written(tmp_path, "road.csv", text), columns=columns)
    assert profile.stations.tolist() == STATIONS
    assert profile.elevation.tolist() == HEIGHTS
    if columns:
        with pytest.raises(ValueError, match=r"line 4: expected numbers separated by commas, got '1,.*bad'"):
            mf.read_profile(tmp_path / "road.csv", columns=["x", "z", "other"])


@pytest.mark.parametrize(
    "remark", ['"joint at\n12.5 m"', '"a, b\nline 2"', '"two\r\n\r\nlines"', '"km 3\n4"', '"1\n2, 3 m"']
)
@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_line_ends_within_quotation_marks(tmp_path, remark, separator):
    """RFC 4180: they belong to the field."""
    for some in (lines("{x}|{z}|#"), lines("{x}|{z}|#").replace("#\n", "\n", 2).replace("#\n", '"a"\n', 1)):
        text = ("x|z|remark\n" + some).replace("|", separator).replace("#", remark)
        profile, _ = mf.read_profile(written(tmp_path, "road.csv", text))
        assert profile.stations.tolist() == STATIONS
        assert profile.elevation.tolist() == HEIGHTS


def test_a_column_whose_name_has_a_comma(tmp_path, capsys):
    file = written(tmp_path, "road.csv", '"Distance, m","Elevation, mm",b\n' + lines("{x},{z},1"))
    for columns in (["Distance, m", "Elevation, mm"], ["Distance", "Elevation"]):
        assert mf.read_profile(file, columns=columns).profile.elevation[3] == pytest.approx(0.004)
    assert main(["profile", str(file), "--columns", '"Distance, m", "Elevation, mm"']) == 0
    assert "without" not in capsys.readouterr().out


def test_lines_to_skip_where_it_is_not_plain(tmp_path, capsys):
    text = "Road,A12\nInterval,0.25\na,b\n" + lines("{x},{z}")
    file = written(tmp_path, "road.csv", text)
    with pytest.raises(ValueError, match=r"line 3: expected numbers .*--skip-lines\) leaves out lines above"):
        mf.read_profile(file)
    profile, understood = mf.read_profile(file, skip_lines=2)
    assert profile.elevation.tolist() == HEIGHTS
    assert "2 lines above left out, columns 'a', 'b'" in understood
    assert main(["profile", str(file), "--skip-lines", "2"]) == 0
    assert "2 lines above left out" in " ".join(capsys.readouterr().out.split())
    # Lines keep their numbers.
    text = text.replace("1.5,4", "1.5,x")
    with pytest.raises(ValueError, match=r"line 7: expected numbers separated by commas, got '1\.5,x'"):
        mf.read_profile(written(tmp_path, "road.csv", text), skip_lines=2)
    with pytest.raises(ValueError, match=r"has 9 lines, and .* leaves out 20"):
        mf.read_profile(file, skip_lines=20)
    assert mf.read_profile(written(tmp_path, "road.txt", "5 2\n" + lines("{x} {z}")), skip_lines=1)
    mf.write_profile(profile, tmp_path / "road.crg")
    with pytest.raises(ValueError, match=r"is for Excel and OpenDocument spreadsheets, CSV .*and this is OpenCRG"):
        mf.read_profile(tmp_path / "road.crg", skip_lines=2)


@pytest.mark.parametrize(
    "below",
    [
        *(
            "Average: 0.0\n",
            "Ende der Messung: 12.05.2024\n",
            "(5 rows affected)\n",
            "5 rows exported on 2024-05-01\n",
        ),
        *(
            "Total,45.6\n",
            "\nEnd of data\n",
            ",\n,\n",
            "Mittelwert,0.9\nMaximum,4\n",
            "----\nEnd of file, 5 rows\n\x1a",
        ),
        ",\n" * 40_000,
    ],
)
def test_what_stands_below_a_table(tmp_path, below):
    profile, understood = mf.read_profile(written(tmp_path, "road.csv", "x,z\n" + lines("{x},{z}") + below))
    assert profile.elevation.tolist() == HEIGHTS
    assert re.search(r"(lines?, )?'.*' (… )?below left out", understood)


@pytest.mark.parametrize(
    "below", ["2.5,x\n", "o.5,3\n", "x,3\n", "2.5\n", "2.5 mm\n", "2.5;3\n", "Total,1\n2.5,3\n", ",3\n"]
)
def test_a_damaged_row_is_no_trailing_line(tmp_path, below):
    with pytest.raises(ValueError, match=r"line [67]: (expected|there is no station)"):
        mf.read_profile(written(tmp_path, "road.csv", lines("{x},{z}") + below))


REMARKED = [
    lines("{x} {z} // joint {n}"),
    lines("{x} {z} ! joint {n}"),
    lines("{x} {z} ; joint {n}"),
    lines("{x},{z} % joint {n}"),
    lines("{x},{z} # joint {n}"),
    "// made by hand\n! in rain\n* and snow\n" + lines("{x}\t{z}") + "// the end\n",
]


@pytest.mark.parametrize("text", REMARKED)
def test_comments_of_every_kind(tmp_path, text):
    profile, _ = mf.read_profile(written(tmp_path, "road.txt", text))
    assert profile.stations.tolist() == STATIONS
    assert profile.elevation.tolist() == HEIGHTS


@pytest.mark.parametrize(
    ("written_as", "meant"),
    [("2.5D-03", 2.5e-3), ("2.5d-3", 2.5e-3), (".25D-002", 2.5e-3), ("2.5-103", 2.5e-103), ("2.5E-03", 2.5e-3)],
)
@pytest.mark.parametrize("separator", [" ", ";"])
def test_exponents_of_fortran(tmp_path, written_as, meant, separator):
    text = lines("{x}|{z}").replace("|4", f"|{written_as}").replace("|", separator)
    assert mf.read_profile(written(tmp_path, "road.dat", text)).profile.elevation[3] == meant


def test_stationing_in_kilometres_and_metres(tmp_path):
    text = "Station;z\n0+999,5;1\n1+000;2\n1+000,5;1\n1+001;2\n"
    assert mf.read_profile(written(tmp_path, "a.csv", text)).profile.stations.tolist() == [
        999.5,
        1000,
        1000.5,
        1001,
    ]
    feet = "Station (ft),z\n12+50,1\n12+75,2\n13+00,1\n13+25,2\n"
    found = mf.read_profile(written(tmp_path, "b.csv", feet)).profile.stations
    assert found == pytest.approx(0.3048 * np.array([1250, 1275, 1300, 1325]), rel=1e-15)


def test_thousands_are_named_only_where_they_are_the_matter(tmp_path):
    for row in ("7.620,0.1x2", "22.936,1.x15", "1.715,OK"):
        text = "x,z\n" + lines("{x},{z}") + f"{row}\n" + lines("{n}3,{z}")
        with pytest.raises(ValueError, match=r"line 7: expected numbers separated by commas, got '[^']*'$"):
            mf.read_profile(written(tmp_path, "road.csv", text))


@pytest.mark.parametrize("row", ["0;1.234,5", "1 000,5;1,5", "0;1'234.5"])
def test_separated_thousands_are_refused(tmp_path, row):
    with pytest.raises(ValueError, match="what separates thousands cannot be told from a decimal sign"):
        mf.read_profile(written(tmp_path, "road.csv", f"x;z\n{row}\n" * 5))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('x,z\n0,1\n1,"2\n2,3\n3,4"\n4,5\n', "line 3: a quotation mark is not closed in its line"),
        ('x,z,r\n0,1,a\n1,2,"b\n2,3,c\n3,4,d"\n4,5,e\n5,6,f\n', "line 3: a quotation mark is not closed"),
        ("distance,elevation\n0,5.8o3\n1,2\n2,3\n3,4\n", "line 2: expected numbers"),
        ("distance,elevation\nO,5.8o3\n1,2\n2,3\n3,4\n", "line 2: expected numbers"),
        ("x,z,remark\n0,1,a\n1,2,b\n2,3\n3,4,d\n", "line 4: expected 3 columns as before, got 2"),
        ("x,z,remark\n0,1,a\n1,2,b\n2,3,c,d\n3,4,e\n", "line 4: expected 3 columns as before, got 4"),
        ("x,z,remark\n0,1,a\n1,2,b\n2,3o,c\n3,4,e\n", "line 4: expected numbers separated by commas, got '2,3o,c'"),
    ],
)
def test_a_damaged_line_is_told(tmp_path, text, message):
    with pytest.raises(ValueError, match=message):
        mf.read_profile(written(tmp_path, "road.csv", text))


def many(form, **options):
    return "".join(lines(form.replace("{x}", f"{n}{{n}}.25").replace("{z}", f"0.0{n}{{n}}3")) for n in range(1, 6))


@pytest.mark.parametrize(
    "text",
    [
        "x,z\n" + many("{x},{z}"),
        "distance,remark,left\n" + many('{x},"joint, {n}",{z}'),
        '"a, m","b, m"\n' + many('"{x}","{z}"').replace(".", ","),
        "# x[m] z[mm]\n" + many(" {x}  {z} ") + "End of data\n",
        "x;z;y\n" + many("{x};{z};2;"),
        many("{x} {z} # joint {n}"),
        "x,z,y\n" + many("{x},{z},2").replace("0.0123", "NaN").replace("0.0203,2", "--,"),
        "Road,A12\nInterval: 0.25\n\ndistance,elevation\n" + many("{x},{z}D-03") + "Mean,0.01\n",
    ],
)
def test_the_fast_way_is_the_slow_one(text):
    """What is read by the C parser, of a text in whatever state, is what each line says by itself."""
    random = np.random.default_rng([*text.encode()])
    fast = 0
    for state in [text.encode(), *(damaged(text.encode(), random) for _ in range(100))]:
        try:
            data, encoding = fields.as_text(state)
            rows = fields.find_table(data, encoding)
        except ValueError:
            continue
        found = fields._fast(data, encoding, rows)
        if found is not None:
            assert np.array_equal(found, fields._line_by_line(data, encoding, rows).values, equal_nan=True), state
            fast += 1
    assert fast > 4


# Spreadsheets.

ROWS = [["distance [m]", "elevation [mm]", "remark"], *([x, z, ""] for x, z in zip(STATIONS, HEIGHTS, strict=True))]
TITLED = [
    ["Profile of lane 1"],
    [],
    ["Weg in m", "Höhe in mm"],
    *(["", *row[:2]][1:] for row in ROWS[1:]),
    ["Summe", 4.5],
]


@pytest.fixture
def calamine():
    return pytest.importorskip("python_calamine", reason="pip install python-calamine")


@pytest.mark.parametrize(("write", "ending"), [(xlsx, "xlsx"), (ods, "ods")])
@pytest.mark.parametrize(
    ("rows", "said"),
    [(ROWS, "without 'remark' (empty)"), (TITLED, "1 line above left out, 'Summe"), (ROWS[1:], "no header")],
)
def test_spreadsheets(tmp_path, calamine, write, ending, rows, said):
    file = write(tmp_path / f"road.{ending}", {"Tabelle 1": rows})
    profile, understood = mf.read_profile(file)
    assert profile.stations.tolist() == STATIONS
    scale = 1.0 if rows is ROWS[1:] or len(rows) == 5 else 1e-3
    assert profile.elevation == pytest.approx(scale * np.array(HEIGHTS), rel=1e-15)
    assert "sheet 'Tabelle 1'" in understood
    assert said in understood


@pytest.mark.parametrize(("write", "ending"), [(xlsx, "xlsx"), (ods, "ods")])
def test_sheets_are_never_joined(tmp_path, calamine, write, ending, capsys):
    twice = [ROWS[0], *([2 * x, z, ""] for x, z, _ in ROWS[1:])]
    file = write(tmp_path / f"road.{ending}", {"Notes": [["by AB"]], "left lane": ROWS, "right lane": twice})
    with pytest.raises(ValueError, match=r"'left lane', 5 points over 2 m; 'right lane', 5 points over 4 m"):
        mf.read_profile(file)
    assert mf.read_profile(file, recording="right lane").profile.stations[-1] == 4.0
    assert main(["profile", str(file), "--recording", "left lane"]) == 0
    capsys.readouterr()
    with pytest.raises(ValueError, match="there is no recording 'middle'"):
        mf.read_profile(file, recording="middle")
    with pytest.raises(ValueError, match="sheet 'Notes', "):
        mf.read_profile(file, recording="Notes")
    assert mf.read_profile(write(tmp_path / f"one.{ending}", {"Notes": [["by AB"]], "left": ROWS}))


def test_a_fault_in_a_sheet_is_told_by_its_row(tmp_path, calamine):
    rows = [*ROWS[:4], [1.75, "x", ""], *ROWS[4:]]
    with pytest.raises(ValueError, match=r"sheet 'A', row 5: expected numbers, got '1.75 \| x"):
        mf.read_profile(xlsx(tmp_path / "road.xlsx", {"A": rows}))
    gap = [*ROWS[:3], [0.75, "", ""], *ROWS[3:]]
    with pytest.raises(ValueError, match=r"sheet 'A', row 4: no elevation at 0.75 m"):
        mf.read_profile(xlsx(tmp_path / "road.xlsx", {"A": gap}))


def test_cells_beside_the_table_of_a_sheet(tmp_path, calamine):
    beside = [["Mean", 0.002], ["IRI", 3.06], *[["", ""]] * 30]
    names = ["distance [m]", "elevation [mm]"]
    table = [names, *([0.5 * n, n % 3] for n in range(31))]
    rows = [[*row, "", *cells] for row, cells in zip(table, beside, strict=True)]
    profile, understood = mf.read_profile(xlsx(tmp_path / "road.xlsx", {"A": rows}))
    assert profile.elevation == pytest.approx(1e-3 * (np.arange(31) % 3))
    assert "without the cells beside the table" in understood
    # Another table is no such thing, however short it is, and whichever of the two is damaged.
    rows = [[*row, "", *(row if n < 6 else ("", ""))] for n, row in enumerate(table)]
    with pytest.raises(ValueError, match=r"road\.xlsx: "):
        mf.read_profile(xlsx(tmp_path / "road.xlsx", {"A": rows}))
    for column in (1, 4):
        rows = [[*row, "", *row] for row in table]
        rows[20][column] = "x"
        with pytest.raises(ValueError, match="sheet 'A', "):
            mf.read_profile(xlsx(tmp_path / "road.xlsx", {"A": rows}))


def test_options_keep_their_names_in_messages_about_sheets(tmp_path, calamine):
    rows = [["distance [m]", "remark"], *([n, n] for n in range(5))]
    with pytest.raises(ValueError, match=r"\(on the command line --columns\)"):
        mf.read_profile(xlsx(tmp_path / "road.xlsx", {"A": rows}))


def test_damaged_spreadsheets_are_refused(tmp_path, calamine):
    file = xlsx(tmp_path / "road.xlsx", {"A": ROWS})
    whole = file.read_bytes()
    at = whole.index(b"xl/worksheets/s1.xml") + 60
    for state in (whole[: len(whole) // 2], whole[:at] + bytes(100) + whole[at + 100 :]):
        with pytest.raises(ValueError, match=r"road\.xlsx: .*(damaged|no spreadsheet)"):
            mf.read_profile(written(tmp_path, "road.xlsx", state))
    # A cell that lies a million rows and sixteen thousand columns away would take the memory of all between.
    far = xlsx(tmp_path / "far.xlsx", {"A": ROWS})
    with zipfile.ZipFile(far) as parts:
        kept = {name: parts.read(name) for name in parts.namelist()}
    kept["xl/worksheets/s1.xml"] = kept["xl/worksheets/s1.xml"].replace(b'r="B6"', b'r="XFD1048576"')
    with zipfile.ZipFile(far, "w") as parts:
        for name, content in kept.items():
            parts.writestr(name, content)
    with pytest.raises(ValueError, match="damaged"):
        mf.read_profile(far)


def test_without_the_library_the_message_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "python_calamine", None)
    with pytest.raises(ValueError, match=r"need python-calamine: pip install python-calamine, or the extra `io`"):
        mf.read_profile(xlsx(tmp_path / "road.xlsx", {"A": ROWS}))

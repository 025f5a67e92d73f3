"""Tables and arrays as people have them: one rule for station, counter, map, recordings and units."""

import numpy as np
import pytest

import movingfrf as mf
from movingfrf.commands.main import main
from movingfrf.roughness.formats.base import length_of
from movingfrf.roughness.sentinels import sentinels
from tests.reader_parts import written

# Every file below holds this road [m]; `y` is another path, twice as high, `c` counts.
X, Z = np.array([0.0, 0.5, 1.0, 1.5, 2.0, 2.5]), 1e-3 * np.array([0.0, 1.5, -2.0, 4.0, 1.0, 3.0])


def lines(form, along=1.0, up=1e-3, offset=0.0):
    """Write a line for each station, in units of so many metres."""
    return "".join(
        form.format(c=n, x=f"{(x + offset) / along:.10g}", z=f"{z / up:.10g}", y=f"{2 * z / up:.10g}") + "\n"
        for n, (x, z) in enumerate(zip(X, Z, strict=True))
    )


def read(folder, text, **options):
    return mf.read_profile(written(folder, "road.csv", text), **options)


def same(profile, paths=1, offset=0.0):
    assert profile.stations == pytest.approx(X + offset, rel=1e-8)
    assert profile.columns.shape[1] == paths
    assert profile.columns[:, 0] == pytest.approx(Z, rel=1e-8)


FEET = {"along": 0.3048, "up": 0.0254}

UNITS = [
    "# units: ft, in\nDistance,Elevation\n" + lines("{x},{z}", **FEET),
    "# distance [ft], elevation [in]\ndistance,elevation\n" + lines("{x},{z}", **FEET),
    "# Distance in feet, elevation in inches\nx,z\n" + lines("{x},{z}", **FEET),
    "m,mm\nDistance,Elevation\n" + lines("{x},{z}"),
    "Units: m and mm\nDistance,Elevation\n" + lines("{x},{z}"),
    "# Unit distance: m\n# Unit elevation: mm\nDistance,Elevation\n" + lines("{x},{z}"),
    "Elevation unit,mm\nDistance,Elevation\n" + lines("{x},{z}"),
    "# column 1: distance [m]\n# column 2: elevation [mm]\n" + lines("{x} {z}"),
    "Elevation in millimetres over distance in metres\nDistance,Elevation\n" + lines("{x},{z}"),
    "Station_m,Elev_mm_left\n" + lines("{x},{z}"),
    "Station m,mm_left\n" + lines("{x},{z}"),
    "Расстояние, м;Высота, мм\n" + lines("{x};{z}"),
    "x,z (millimeters)\n" + lines("{x},{z}"),
    "x (US survey ft),z [mil]\n" + lines("{x},{z}", along=1200 / 3937, up=0.0254e-3),
    "x,z [0.1 mm]\n" + lines("{x},{z}", up=1e-4),
    "x,Elevation (1/10 mm)\n" + lines("{x},{z}", up=1e-4),
    "x,Elevation (filtered) (mm)\n" + lines("{x},{z}"),
    "x,z(x) (mm)\n" + lines("{x},{z}"),
    "x,z (in wheel path) [mm]\n" + lines("{x},{z}"),
    'x,"Elevation left (inner wheel path), mm"\n' + lines("{x},{z}"),
    "x,Elevation (ft above datum)\n" + lines("{x},{z}", up=0.3048),
    'x,"z (in, unfiltered)"\n' + lines("{x},{z}", up=0.0254),
    "Kilometer,Elevation [mm]\n" + lines("{x},{z}", along=1e3),
    "PK;Profil [mm]\n" + lines("{x};{z}", along=1e3),
    "Milepost,Elevation (in)\n" + lines("{x},{z}", along=1609.344, up=0.0254),
]


@pytest.mark.parametrize("text", UNITS)
def test_units_wherever_they_stand(tmp_path, text):
    same(read(tmp_path, text).profile)


@pytest.mark.parametrize(
    "remark", ["Sampling distance: 10 cm", "profile measured on foot", "Length: 2 km", "made in m", "Wheel: 3 ft"]
)
def test_remarks_with_lengths_are_no_units(tmp_path, remark):
    same(read(tmp_path, f"# {remark}\nDistance,Elevation\n" + lines("{x},{z}", up=1.0)).profile)


def test_units_with_a_number():
    assert [length_of(unit) for unit in ("10 mm", "1/10 mm", "0,1mm", "s", "1/0 mm", "mm/s")] == [
        0.01,
        pytest.approx(1e-4),
        pytest.approx(1e-4),
        None,
        None,
        None,
    ]


def test_units_with_a_number_are_asked_for(tmp_path, capsys):
    file = written(tmp_path, "road.csv", "x,z [1e-4 m]\n" + lines("{x},{z}", up=1e-4))
    with pytest.raises(ValueError, match=r"the unit '1e-4 m' .* is not known.*--units\) says which it is"):
        mf.read_profile(file)
    same(mf.read_profile(file, units=("m", "0.1mm")).profile)
    assert main(["profile", str(file), "--units", "m,0.1mm"]) == 0
    assert "0.1mm" in capsys.readouterr().out


@pytest.mark.parametrize("name", ["Station [km]", "km", "Kilometrierung", "Station"])
def test_stationing_is_in_metres_whatever_the_unit_says(tmp_path, name):
    text = f"{name};z [mm]\n" + "".join(
        f"12+{x:07.3f};{z}\n".replace(".", ",") for x, z in zip(X, 1e3 * Z, strict=True)
    )
    same(read(tmp_path, text).profile, offset=12000.0)


def test_a_mileage_without_a_unit_may_be_anything(tmp_path):
    text = "Mileage,z\n" + lines("{x},{z}", up=1.0)
    with pytest.raises(ValueError, match=r"'Mileage' may be in miles, kilometres or metres: .*--units\)"):
        read(tmp_path, text)
    same(read(tmp_path, text, units=("m", "m")).profile)
    np.savez(tmp_path / "road.npz", mileage=X, z=Z)
    with pytest.raises(ValueError, match="'mileage' may be in miles, kilometres or metres"):
        mf.read_profile(tmp_path / "road.npz")


ARRAYS = [
    {"Distance_ft": X / 0.3048, "Profile_in": Z / 0.0254},
    {"station_mm": X * 1e3, "elevation_mm": Z * 1e3},
    {"x": X, "z": Z * 1e3, "z_units": "mm"},
    {"distance": X / 0.3048, "elevation": Z * 1e3, "distance_unit": "ft", "units_elevation": "mm"},
    {"Kilometer": X / 1e3, "z": Z},
]


@pytest.mark.parametrize("arrays", ARRAYS, ids=lambda arrays: "-".join(arrays))
def test_units_in_names_of_arrays_and_beside_them(tmp_path, arrays):
    from scipy.io import savemat

    savemat(tmp_path / "a.mat", arrays)
    savemat(tmp_path / "b.mat", {"road": arrays})
    np.savez(tmp_path / "c.npz", **arrays)
    for name in ("a.mat", "b.mat", "c.npz"):
        same(mf.read_profile(tmp_path / name).profile)


def test_times_in_names_of_arrays(tmp_path):
    np.savez(tmp_path / "road.npz", t_ms=X * 1e3 / 20, z=Z)
    same(mf.read_profile(tmp_path / "road.npz", speed=20.0).profile)


def test_a_unit_of_nothing_is_refused(tmp_path):
    np.savez(tmp_path / "road.npz", s=X, z=Z * 1e3, unit="mm")
    with pytest.raises(ValueError, match=r"says 'mm' of its units, and not of what: .*--units\)"):
        mf.read_profile(tmp_path / "road.npz")
    same(mf.read_profile(tmp_path / "road.npz", units=("m", "mm")).profile)


@pytest.mark.parametrize(("name", "value"), [("unit", "mm"), ("Units", "mm"), ("units", np.array([b"mm"]))])
def test_attributes_for_units(tmp_path, name, value):
    import h5py

    with h5py.File(tmp_path / "road.h5", "w") as file:
        file["distance"], file["elevation"] = X, Z * 1e3
        file["elevation"].attrs[name] = value
    same(mf.read_profile(tmp_path / "road.h5").profile)


BESIDE = [
    ("x1 [m],z1 [mm],x2 [m],z2 [mm]\n", ("1", "2")),
    ("Distance,Elevation [mm],Distance,Elevation [mm]\n", ("Distance", "Distance (2)")),
    (
        "Run 1,,Run 2,\ndistance [m],elevation [mm],distance [m],elevation [mm]\n",
        ("distance [m]", "distance [m] (2)"),
    ),
    ("Distance [m],Elevation [mm],Distance 2 [m],Elevation 2 [mm]\n", ("Distance [m]", "2")),
]


@pytest.mark.parametrize(("head", "names"), BESIDE)
def test_recordings_side_by_side_are_not_joined(tmp_path, head, names):
    one, other = lines("{x},{z}").splitlines(), lines("{x},{z}", offset=7.0).splitlines()[:4]
    file = written(tmp_path, "road.csv", head + "\n".join(map(",".join, zip(one, [*other, ",", ","], strict=True))))
    with pytest.raises(ValueError, match="holds 2 recordings, which are not joined") as refused:
        mf.read_profile(file)
    assert f"{names[0]!r}, 6 points over 2.5 m; {names[1]!r}, 4 points over 1.5 m" in str(refused.value)
    same(mf.read_profile(file, recording=names[0]).profile)
    second, understood = mf.read_profile(file, recording=names[1])
    assert second.stations.tolist() == [7.0, 7.5, 8.0, 8.5]
    assert second.elevation == pytest.approx(Z[:4])
    assert "(of another recording)" in understood


@pytest.mark.parametrize(
    ("labels", "name"), [(("1", "2"), "run"), (("R", "L"), "Lane"), (("in", "gegen"), "Richtung")]
)
def test_recordings_below_each_other_are_not_joined(tmp_path, labels, name):
    rows = [f"{label},{line}" for label in labels for line in lines("{x},{z}").splitlines()]
    for order in (rows, sorted(rows, key=lambda row: float(row.split(",")[1]))):
        file = written(tmp_path, "road.csv", f"{name},x [m],z [mm]\n" + "\n".join(order))
        with pytest.raises(ValueError, match=rf"'{name} {labels[0]}', 6 points over 2.5 m; '{name} {labels[1]}'"):
            mf.read_profile(file)
        same(mf.read_profile(file, recording=f"{name} {labels[1]}").profile)


def test_a_lane_that_changes_is_said(tmp_path):
    text = "lane,x [m],z [mm]\n" + "".join(
        f"{1 + (n > 2)},{line}\n" for n, line in enumerate(lines("{x},{z}").splitlines())
    )
    profile, understood = read(tmp_path, text)
    same(profile)
    assert "without 'lane' (changes along the way)" in understood


OTHERS = [
    "Distance [m],Elevation [mm],Width [m]\n",
    "Distance [m],Elevation [mm],Water depth [mm]\n",
    "Distance [m],Elevation [mm],Std [mm]\n",
    "Distance [m],Elevation [mm],Foo [mm]\n",
    "Distance [m],left [mm],Crosslevel [mm]\n",
    "Chainage [m],Vertical alignment [mm],Cross level [mm]\n",
    "Chainage [m],LP left [mm],Alignment left [mm]\n",
    "Distance [m],Left [mm],Humidity\n",
    "Curve radius [m],Distance [m],Elevation [mm]\n",
    "Elevation accuracy,Distance [m],Elevation [mm]\n",
    "Wheel path,Distance [m],Elevation [mm]\n",
]


@pytest.mark.parametrize("head", OTHERS)
def test_what_is_called_otherwise_is_no_path(tmp_path, head):
    form = "50,{x},{z}" if "Distance" in head.split(",")[1] else "{x},{z},50"
    same(read(tmp_path, head + lines(form)).profile)


def test_names_that_tell_sides_are_paths(tmp_path):
    for head in (
        "x [m],left [mm],right [mm]",
        "x [m],Elevation [mm],left [mm]",
        "x [m],Run 1 [mm],Run 2 [mm]",
        "x,a,b",
    ):
        units = {"units": ("m", "mm")} if head == "x,a,b" else {}
        same(read(tmp_path, f"{head}\n" + lines("{x},{z},{y}"), **units).profile, paths=2)
    with pytest.raises(ValueError, match=r"several may be the elevations: 'Laser', 'Gyro'.*--columns\)"):
        read(tmp_path, "x [m],Laser,Gyro\n" + lines("{x},{z},{y}"))


STATIONS = [
    "Station ID,Station [m],Elevation [mm]\n" + lines("7{c},{x},{z}"),
    "distance_to_next,distance,elevation [mm]\n" + lines("0.5,{x},{z}"),
    "Sensor position [m],Distance [m],Elevation [mm]\n" + lines("0.75,{x},{z}"),
    "Axle distance [m],Travel [m],Height [mm]\n" + lines("2.5,{x},{z}"),
    "km,m,z [mm]\n" + lines("12,{x},{z}"),
    "km,distance,z [mm]\n" + "".join(f"12.00,{x},{1e3 * z}\n" for x, z in zip(X, Z, strict=True)),
    "Hoogte [mm],Afstand [m]\n" + lines("{z},{x}"),
    "X,Y,Z\n" + lines("{x},0.75,{z}", up=1.0),
    lines("{c} {x} {z}", up=1.0),
]


@pytest.mark.parametrize("text", STATIONS)
def test_the_station_goes_up(tmp_path, text):
    same(read(tmp_path, text).profile)


@pytest.mark.parametrize("names", ["X,Y,Z", "East,North,Z", "Rechts,Hoch,Höhe", "X [m],Y [m],Z [mm]"])
def test_a_map_is_no_distance(tmp_path, names):
    text = f"{names}\n" + "".join(f"{4e5 + x},{5e6 + 2 * x},{z}\n" for x, z in zip(X, Z, strict=True))
    with pytest.raises(ValueError, match=r"may be coordinates of a map; .*--columns\)"):
        read(tmp_path, text)


def test_what_counts_is_no_station(tmp_path):
    with pytest.raises(ValueError, match=r"'frame' does nothing but count; .*--columns\)"):
        read(tmp_path, "frame,elevation\n" + lines("{c},{z}"))
    profile, understood = read(tmp_path, lines("{c},{z}"))
    assert profile.stations[-1] == 5.0
    assert "the first column does nothing but count: taken as a distance" in understood


def test_stationings_that_disagree_are_refused(tmp_path):
    with pytest.raises(ValueError, match="several may be the stations: 'Distance', 'Position'"):
        read(tmp_path, "Distance,Position,Elevation\n" + lines("{x},{c},{z}"))


def test_an_erd_file_over_time(tmp_path):
    text = "ERDFILEV2.00\n1, 6, -1, -1, 5, 25, -1,\nSHORTNAMElev\nUNITSNAMmm\nXUNITS  ms\nEND\n" + lines("{z}")
    file = written(tmp_path, "road.erd", text)
    with pytest.raises(ValueError, match="is a record over time"):
        mf.read_profile(file)
    same(mf.read_profile(file, speed=20.0).profile)


@pytest.mark.parametrize("marker", ["1e30", "1e38", "9.969209968386869e36"])
def test_what_no_road_reaches_is_named_as_a_marker(tmp_path, marker):
    text = "x,z\n" + lines("{x},{z}").replace(",4\n", f",{marker}\n")
    with pytest.raises(ValueError, match=r"line 5: elevation must be finite, got .*marks a missing elevation"):
        read(tmp_path, text)


def test_a_path_of_markers_and_short_ones():
    road = 0.01 * np.sin(np.arange(500.0) / 7)
    (found,) = sentinels(np.stack([road, np.full(500, -9999.0)], axis=1))
    assert (found.value, found.number) == (-9999.0, 500)
    road[[7, 200, 400]] = -0.0999  # millimetres
    assert [each.value for each in sentinels(road)] == [-0.0999]
    road[[200, 400]] = 0.0  # a pothole of that depth
    assert sentinels(road) == []


def test_what_has_no_unit_of_length_is_said(tmp_path):
    with pytest.raises(ValueError, match=r"'z \[mm²/m\]' is in 'mm²/m', no unit of length"):
        read(tmp_path, "x [m],z [mm²/m]\n" + lines("{x},{z}"))
    with pytest.raises(ValueError, match=r"'z \[mm\]' holds no numbers"):
        read(tmp_path, "x [m];z [mm]\n" + "".join(f"{x};0,{n}\n" for n, x in enumerate(X)))

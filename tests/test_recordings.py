"""Several recordings in one container: never joined in silence. What arrays in it are stations and elevations."""

from pathlib import Path

import numpy as np
import pytest

import movingfrf as mf
from tests.reader_parts import written

CASES = Path(__file__).parent / "data" / "cases"

X = 0.25 * np.arange(12.0)
Z = np.round(0.01 * np.sin(X), 4)


def mat(folder, **arrays):
    from scipy.io import savemat

    savemat(folder / "road.mat", arrays)
    return folder / "road.mat"


# GPX.


@pytest.mark.parametrize(
    ("file", "names", "length"),
    [
        ("two-tracks.gpx", ("day 1", "day 2"), 900),
        ("two-segments.gpx", ("drive, segment 1", "drive, segment 2"), 590),
    ],
)
def test_tracks_and_segments_are_not_joined(file, names, length):
    with pytest.raises(
        ValueError, match=f"holds 2 recordings, which are not joined: '{names[0]}', .* points over "
    ):
        mf.read_profile(CASES / file)
    for name in names:
        profile, understood = mf.read_profile(CASES / file, recording=name)
        assert profile.stations[-1] == pytest.approx(length, rel=1e-4)
        assert f"GPX track {name!r} of" in understood
        assert name in profile.source
        assert "Car park" not in profile.source + understood
    with pytest.raises(ValueError, match=r"no recording 'day 3'.*; there are "):
        mf.read_profile(CASES / file, recording="day 3")


def gpx(*lines):
    """Tracks and routes, each `(element, name, segments)`, a segment so many points; the name stands last."""
    text = '<gpx xmlns="http://www.topografix.com/GPX/1/1"><wpt lat="1" lon="1"><name>A stop</name></wpt>'
    for element, name, segments in lines:
        point = "trkpt" if element == "trk" else "rtept"
        text += f"<{element}>"
        for number, points in enumerate(segments):
            places = "".join(
                f'<{point} lat="{48 + number + 1e-5 * n}" lon="9"><name>x</name><ele>{n}</ele></{point}>'
                for n in range(points)
            )
            text += f"<trkseg>{places}</trkseg>" if element == "trk" else places
        text += (f"<name>{name}</name>" if name else "") + f"</{element}>"
    return text + "</gpx>"


@pytest.mark.parametrize(
    ("lines", "names"),
    [
        ([("trk", "", [5]), ("trk", "", [6])], ["track 1", "track 2"]),
        ([("trk", "home", [5]), ("trk", "home", [6])], ["home", "home (2)"]),
        ([("trk", "home", [5, 6]), ("rte", "way", [7])], ["home, segment 1", "home, segment 2", "way"]),
        ([("rte", "", [5]), ("rte", "", [6])], ["route 1", "route 2"]),
    ],
)
def test_names_of_tracks_segments_and_routes(tmp_path, lines, names):
    file = written(tmp_path, "drive.gpx", gpx(*lines))
    with pytest.raises(ValueError, match=rf"holds {len(names)} recordings") as refused:
        mf.read_profile(file)
    for number, name in enumerate(names):
        assert f"{name!r}, {5 + number} points" in str(refused.value)
        assert mf.read_profile(file, recording=name).profile.stations.size == 5 + number


def test_a_single_track_is_read_and_a_stray_point_beside_it_is_said(tmp_path):
    file = written(tmp_path, "drive.gpx", gpx(("trk", "home", [1, 8]), ("trk", "", [0])))
    profile, understood = mf.read_profile(file)
    assert profile.stations.size == 8
    assert "'home, segment 2' of 8 points" in understood
    assert "1 line of less than 4 points beside it" in understood


# MATLAB.


def test_a_struct_and_a_matrix_as_people_save_them():
    for file, said in [
        ("struct.mat", "'road.distance' and elevations 'road.elevation'"),
        ("matrix.mat", "column 1"),
    ]:
        profile, understood = mf.read_profile(CASES / file)
        assert (profile.stations.size, profile.paths) == (400, 1)
        assert profile.stations[-1] == pytest.approx(39.9)
        assert said in understood
    named = mf.read_profile(CASES / "struct.mat", columns=["road.distance", "road.elevation"]).profile
    assert np.array_equal(named.elevation, mf.read_profile(CASES / "matrix.mat").profile.elevation)


@pytest.mark.parametrize("packed", [False, True])
def test_structs_within_structs_and_several_of_them(tmp_path, packed):
    from scipy.io import savemat

    first, second = {"x": X, "z": Z, "note": "dry"}, {"x": X[:8], "z": -Z[:8], "speed": 20.0}
    savemat(tmp_path / "a.mat", {"survey": {"road": first, "year": 2020.0}}, do_compression=packed)
    assert "'survey.road.x'" in mf.read_profile(tmp_path / "a.mat").understood
    savemat(tmp_path / "b.mat", {"north": first, "south": second}, do_compression=packed)
    with pytest.raises(
        ValueError, match=r"'north', 12 points over 2.75 m; 'south', 8 points over 1.75 m; `recording`"
    ):
        mf.read_profile(tmp_path / "b.mat")
    assert mf.read_profile(tmp_path / "b.mat", recording="south").profile.elevation.tolist() == (-Z[:8]).tolist()
    columns = {"recording": "south", "columns": ["x", "z"]}
    assert mf.read_profile(tmp_path / "b.mat", **columns).profile.elevation.tolist() == (-Z[:8]).tolist()
    several = np.array([(X, Z), (X, 2 * Z)], [("x", object), ("z", object)])
    savemat(tmp_path / "c.mat", {"runs": several}, do_compression=packed)
    assert np.array_equal(mf.read_profile(tmp_path / "c.mat", recording="runs(2)").profile.elevation, 2 * Z)


def test_matrices_with_paths_lying_and_counted(tmp_path):
    file = mat(tmp_path, m=np.column_stack([X, Z, -Z]))
    assert mf.read_profile(file).profile.paths == 2
    assert mf.read_profile(mat(tmp_path, m=np.stack([X, Z]))).profile.elevation.tolist() == Z.tolist()
    counted, understood = mf.read_profile(mat(tmp_path, m=np.column_stack([np.arange(12), X, Z])))
    assert counted.stations.tolist() == X.tolist()
    assert "stations 'm, column 2'" in understood
    assert "without 'm, column 1'" in understood
    several = mat(tmp_path, left=np.column_stack([X, Z]), right=np.column_stack([X, -Z]))
    with pytest.raises(ValueError, match=r"holds 2 recordings.*'left'.*'right'"):
        mf.read_profile(several)
    assert mf.read_profile(several, columns=["right"]).profile.elevation.tolist() == (-Z).tolist()


def test_what_matlab_alone_reads_is_named(tmp_path):
    cells = np.empty(2, object)
    cells[:] = [X, Z]
    with pytest.raises(ValueError, match="'runs', a cell array, which is not read"):
        mf.read_profile(mat(tmp_path, runs=cells))
    with pytest.raises(ValueError, match=r"'road\.runs', a cell array, which is not read"):
        mf.read_profile(mat(tmp_path, road={"runs": cells}))
    with pytest.raises(ValueError, match="'z', an array of complex numbers, which is not read"):
        mf.read_profile(mat(tmp_path, z=Z + 1j))


def test_structs_of_matlab_7_3_are_groups(tmp_path):
    import h5py

    head = b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM"
    for names in (["road"], ["north", "south"]):
        with h5py.File(tmp_path / "road.mat", "w", userblock_size=512) as file:
            for name in names:
                file.create_group(name).attrs["MATLAB_class"] = np.bytes_("struct")
                file[name]["x"], file[name]["z"] = X[None], Z[None]
            file.create_group("#refs#")["x"] = X
        with (tmp_path / "road.mat").open("r+b") as file:
            file.write(head)
        if len(names) == 1:
            assert "'road.x' and elevations 'road.z'" in mf.read_profile(tmp_path / "road.mat").understood
    assert mf.read_profile(tmp_path / "road.mat", recording="south").profile.stations.tolist() == X.tolist()


# netCDF and NumPy.


def test_groups_of_netcdf(tmp_path):
    import h5py

    with h5py.File(tmp_path / "road.nc", "w") as file:
        file["distance"] = X
        for sign, name in ((1, "left"), (-1, "right")):
            file[f"runs/{name}/elevation"] = sign * Z
    with pytest.raises(ValueError, match=r"'runs/left', 12 points over 2.75 m; 'runs/right', 12 points"):
        mf.read_profile(tmp_path / "road.nc")
    assert mf.read_profile(tmp_path / "road.nc", recording="runs/right").profile.elevation.tolist() == (-Z).tolist()


def test_groups_of_netcdf_with_one_recording_and_one_that_holds_itself(tmp_path):
    import h5py

    with h5py.File(tmp_path / "road.nc", "w") as file:
        group = file.create_group("a")
        group["chainage"], group["height"] = X, Z
        group["itself"] = group
        file["b/speed"] = X
    # Names of the arrays are enough, however deep the circle is followed.
    assert mf.read_profile(tmp_path / "road.nc", columns=["a/chainage", "a/height"]).profile.paths == 1


@pytest.mark.parametrize(
    ("arrays", "names"),
    [
        ({"x1": X, "z1": Z, "x2": X[:8], "z2": Z[:8]}, ["1", "2"]),
        ({"distance_left": X, "elevation_left": Z, "distance_right": X, "elevation_right": Z}, ["left", "right"]),
        ({"north/x": X, "north/z": Z, "south/x": X, "south/z": Z}, ["north", "south"]),
        ({"x": X, "z": Z, "old.x": X, "old.z": Z}, ["top level", "old"]),
    ],
    ids=lambda value: "",
)
def test_several_stations_in_one_numpy_file(tmp_path, arrays, names):
    np.savez(tmp_path / "road.npz", **arrays)
    with pytest.raises(
        ValueError, match=rf"holds 2 recordings, which are not joined: '{names[0]}', .*; '{names[1]}'"
    ):
        mf.read_profile(tmp_path / "road.npz")
    stored = [value for name, value in arrays.items() if "z" in name or "elevation" in name]
    for name, values in zip(names, stored, strict=True):
        assert mf.read_profile(tmp_path / "road.npz", recording=name).profile.elevation.tolist() == values.tolist()


def test_formats_with_one_recording_have_no_choice(tmp_path):
    file = written(tmp_path, "road.csv", "0,1\n1,2\n2,3\n3,4\n")
    with pytest.raises(ValueError, match=r"which holds one recording: `recording` .*--recording\) has no choice"):
        mf.read_profile(file, recording="a")
    with pytest.raises(ValueError, match="recording must be a text, got 3"):
        mf.read_profile(file, recording=3)


def test_a_recording_is_chosen_on_the_command_line_and_in_a_scenario(capsys, tmp_path):
    from movingfrf.commands.main import main

    assert main(["profile", str(CASES / "two-tracks.gpx"), "--recording", "day 2"]) == 0
    assert "GPX track 'day 2'" in capsys.readouterr().out
    assert main(["profile", str(CASES / "two-tracks.gpx")]) == 2
    assert "'day 1', 31 points over 899.999 m" in " ".join(capsys.readouterr().err.split())


# Which array is what.


@pytest.mark.parametrize(
    ("arrays", "name"),
    [
        ({"t": 0.01 * np.arange(12), "z": Z}, "t"),
        ({"time_s": 0.01 * np.arange(12), "elevation": Z}, "time_s"),
        ({"Zeit": X, "Hoehe": Z, "speed": X}, "Zeit"),
    ],
    ids=lambda value: "",
)
def test_a_record_over_time_alone_is_refused(tmp_path, arrays, name):
    with pytest.raises(ValueError, match=rf"is a record over time \('{name}'\) without a distance"):
        mf.read_profile(mat(tmp_path, **arrays))
    np.savez(tmp_path / "road.npz", **arrays)
    with pytest.raises(ValueError, match="is a record over time"):
        mf.read_profile(tmp_path / "road.npz")


def test_time_by_its_unit_in_netcdf_and_distance_beside_it(tmp_path):
    import h5py

    with h5py.File(tmp_path / "road.nc", "w") as file:
        file["x"], file["z"] = X, Z
        file["x"].attrs["units"] = "s"
    with pytest.raises(ValueError, match=r"over time \('x'\)"):
        mf.read_profile(tmp_path / "road.nc")
    profile, understood = mf.read_profile(mat(tmp_path, t=np.arange(12.0), dist=X, z=Z, speed=0 * X))
    assert profile.stations.tolist() == X.tolist()
    assert "without 't', 'speed'" in understood


@pytest.mark.parametrize(
    ("arrays", "why"),
    [
        ({"a": np.arange(12.0), "b": Z}, "'a' does nothing but count"),
        ({"x": X, "y": -X, "z": Z}, "x and y may be coordinates"),
        ({"distance": X, "km": X, "z": Z}, "several may be the stations: 'distance', 'km'"),
        ({"x": X, "a": Z, "b": Z}, "several may be the elevations: 'a', 'b'"),
    ],
    ids=lambda value: "",
)
def test_arrays_that_could_be_several_things_are_not_guessed(tmp_path, arrays, why):
    with pytest.raises(ValueError, match=why):
        mf.read_profile(mat(tmp_path, **arrays))


def test_left_and_right_are_paths(tmp_path):
    assert mf.read_profile(mat(tmp_path, x=X, left=Z, right=-Z, iri=Z)).profile.columns[3].tolist() == [Z[3], -Z[3]]

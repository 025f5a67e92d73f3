"""Profiles in MATLAB, HDF5, NumPy and GPX files; damaged files of every format."""

import io
import struct
import sys
import zipfile
from dataclasses import replace
from importlib.util import find_spec

import numpy as np
import pytest

import movingfrf as mf
from movingfrf.roughness.files import FORMATS
from movingfrf.roughness.formats import apart
from movingfrf.roughness.formats.gpx import distances
from tests import fuzz_readers
from tests.reader_parts import DATA, needs, written

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
    savemat(tmp_path / "road.mat", {"x": x, "a": -x, "b": 0 * x})
    with pytest.raises(ValueError, match=r"several may be the elevations.*: 'x' 1 by 6; 'a' 1 by 6; 'b' 1 by 6"):
        mf.read_profile(tmp_path / "road.mat")
    profile = mf.read_profile(tmp_path / "road.mat", columns=["x", "a", "b"]).profile
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


@pytest.mark.parametrize(
    "said",
    [
        {"missing_value": np.array([-999, -998], "i2")},
        {"missing_value": np.int16(-999), "_FillValue": np.int16(-1)},
        {"valid_range": np.array([0, 100], "i2")},
        {"valid_min": np.int16(0)},
        {"valid_max": np.int16(100), "_FillValue": np.int16(-999)},
    ],
    ids=str,
)
def test_what_netcdf_says_is_no_value_is_none(tmp_path, said):
    """All that makes a masked array of it in other readers."""
    import h5py

    with h5py.File(tmp_path / "other.nc", "w") as file:
        file["x"] = np.arange(6.0)
        file["z"] = np.array([10, 20, -999, 40, 50, 60], "i2")
        file["z"].attrs.update(said)
    with pytest.raises(ValueError, match=r"value 3: no elevation at 2 m"):
        mf.read_profile(tmp_path / "other.nc")


def test_an_hdf5_library_that_hangs_or_crashes_is_not_waited_for(tmp_path, monkeypatch):
    """As it does on some damaged files; too rare to keep one that does so with every version of it."""
    mf.write_profile(fuzz_readers.profile(), tmp_path / "road.nc")
    with monkeypatch.context() as patched:
        patched.setattr(apart, "LIMITS", replace(apart.LIMITS, patience=0.0))
        with pytest.raises(ValueError, match=r"road\.nc: is damaged: reading it comes to no end"):
            mf.read_profile(tmp_path / "road.nc")
    monkeypatch.setattr(sys, "executable", "/bin/false")
    with pytest.raises(ValueError, match=r"road\.nc: is damaged, or no HDF5 file: the library fails on it"):
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


# NumPy.


@pytest.mark.parametrize("packed", [np.savez, np.savez_compressed])
@pytest.mark.parametrize("kind", ["<f8", ">f4", "i2", "u1"])
def test_numpy_arrays_as_numpy_writes_them(tmp_path, packed, kind):
    values = np.arange(20).reshape(10, 2).astype(kind)
    packed(tmp_path / "any.npz", x=np.arange(10) / 4, z=np.asfortranarray(values), name=np.array("a road"), ok=True)
    profile, understood = mf.read_profile(tmp_path / "any.npz", columns=["x", "z"])
    assert profile.stations.tolist() == (np.arange(10) / 4).tolist()
    assert np.array_equal(profile.elevation, values)
    assert "NumPy file with stations 'x' and elevations 'z' in metres" in understood
    assert mf.read_profile(tmp_path / "any.npz").profile.paths == 2
    assert mf.read_profile(tmp_path / "any.npz", format="npz").profile.source == "any.npz"


def npy(header, content=b""):
    """Make an archive of two arrays with one header."""
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w") as archive:
        for name in ("distance", "elevation"):
            # Without the time of day, which would end in the names of tests, another for each process.
            archive.writestr(
                zipfile.ZipInfo(f"{name}.npy"),
                b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header + content,
            )
    return made.getvalue()


HEADER = b"{'descr': '<f8', 'fortran_order': False, 'shape': (%s,), }\n"


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (npy(b"{'descr': '<f8'}"), "the header of distance.npy cannot be read"),
        (npy(b"__import__('os')"), "the header of distance.npy cannot be read"),
        (npy(HEADER % b"-1"), r"distance.npy cannot have the shape \(-1,\)"),
        (npy(HEADER % b"10")[:-30], "is damaged, or no NumPy file: File is not a zip file"),
        (
            npy(b"{'descr': '|O', 'fortran_order': False, 'shape': (10,), }", 80 * b"0"),
            "'distance', no plain array",
        ),
    ],
)
def test_faulty_numpy_files(tmp_path, content, message):
    with pytest.raises(ValueError, match=message):
        mf.read_profile(written(tmp_path, "road.npz", content))


def test_numpy_files_that_claim_more_than_they_hold(tmp_path):
    vast = npy(HEADER % b"1000000000000", 80 * b"0")
    with pytest.raises(ValueError, match=r"distance.npy holds 10 values, but claims \(1000000000000,\)"):
        mf.read_profile(written(tmp_path, "vast.npz", vast))
    np.savez_compressed(tmp_path / "bomb.npz", distance=np.arange(8.0), elevation=np.zeros(18_000_000))
    with pytest.raises(ValueError, match="unpacks to more than 10 times its size"):
        mf.read_profile(tmp_path / "bomb.npz")
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_LZMA) as archive:
        archive.writestr("distance.npy", b"")
    with pytest.raises(ValueError, match=r"distance\.npy is packed in a way that NumPy does not know"):
        mf.read_profile(written(tmp_path, "road.npz", packed.getvalue()))


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
    assert profile.steps == ("1 point that does not lead on left out",)
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
        ({"format": "docx"}, "format must be one of crg, .*, csv, got 'docx'"),
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
    # Every format and encoding that is written; GPX twice, a European CSV, packed MATLAB files of two versions,
    # three with structs and a matrix, netCDF with a group and netCDF 3, one array of NumPy, a text with remarks, a
    # spreadsheet if it can be read.
    assert len(found) == 12 + bool(find_spec("python_calamine")) + sum(
        len(form.encodings) for form in FORMATS.values() if form.made
    )
    assert not {name: counts for name, counts in found.items() if counts.keys() - {"read", "refused"}}


@pytest.mark.parametrize("name", ["a.csv", "a.erd", "a.mat", "a.npz", "a.nc", "a.crg", "b.crg", "c.erd", "a.gpx"])
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

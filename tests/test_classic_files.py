"""Files of arrays in older and simpler forms: netCDF 3, a single NumPy array, a table in HDF5, odd attributes."""

import h5py
import numpy as np
import pytest
from scipy.io import netcdf_file

import movingfrf as mf
from tests.reader_parts import written

X, Z = 0.25 * np.arange(40), 0.01 * np.sin(np.arange(40))


@pytest.mark.parametrize("version", [1, 2])
def test_netcdf_3(tmp_path, version):
    stored = np.round(1e5 * Z).astype("i2")
    stored[[3, 5, 7]] = -32768, 9999, 30000
    with netcdf_file(tmp_path / "road.nc", "w", version=version) as file:
        file.createDimension("distance", 40)
        x = file.createVariable("distance", "f8", ("distance",))
        z = file.createVariable("z", "i2", ("distance",))
        x[:], x.units = X / 0.3048, b"ft"
        z[:], z.units, z.scale_factor = stored, b"mm", 0.01
        z._FillValue, z.missing_value, z.valid_max = np.int16(-32768), np.int16(9999), np.int16(20000)
        file.source = b"a road"
    with pytest.raises(ValueError, match="3 elevations are missing in 3 gaps"):
        mf.read_profile(tmp_path / "road.nc")
    profile, _ = mf.read_profile(tmp_path / "road.nc", repair_gaps=0.5)
    left = np.delete(np.arange(40), [3, 5, 7])
    assert profile.stations == pytest.approx(X, rel=1e-14)
    assert profile.elevation[left] == pytest.approx(np.round(Z, 5)[left], abs=1e-9)
    assert "a road" in profile.source
    whole = (tmp_path / "road.nc").read_bytes()
    for length in (8, 40, 200, 400):
        with pytest.raises(ValueError, match="is damaged, or no netCDF file"):
            mf.read_profile(written(tmp_path, "cut.nc", whole[:length]))


def test_a_single_numpy_array(tmp_path):
    np.save(tmp_path / "road.npy", np.column_stack([X, Z]))
    profile, understood = mf.read_profile(tmp_path / "road.npy")
    assert (profile.stations.tolist(), profile.elevation.tolist()) == (X.tolist(), Z.tolist())
    assert "column 1" in understood
    np.save(tmp_path / "rows.npy", np.stack([X, Z, 2 * Z]))
    assert mf.read_profile(tmp_path / "rows.npy", units=("ft", "in")).profile.elevation[3, 1] == 0.0254 * 2 * Z[3]
    np.save(tmp_path / "one.npy", Z)
    with pytest.raises(ValueError, match="no arrays that are clearly stations and elevations"):
        mf.read_profile(tmp_path / "one.npy")


def test_a_table_in_hdf5(tmp_path):
    rows = np.zeros(40, [("station_ft", "f8"), ("elevation", "f4"), ("remark", "S8")])
    rows["station_ft"], rows["elevation"] = X, Z
    with h5py.File(tmp_path / "road.h5", "w") as file:
        file["survey"] = rows
    profile, _ = mf.read_profile(tmp_path / "road.h5", units=("ft", "m"))
    assert profile.stations == pytest.approx(0.3048 * X, rel=1e-14)
    assert profile.elevation.tolist() == Z.astype("f4").astype(float).tolist()


@pytest.mark.parametrize(
    ("name", "unit"),
    [("unit", "in"), ("Units", np.array([b"in"])), ("UNITS", np.array(["in"], "O")), ("units", "in")],
)
def test_units_of_hdf5_however_they_are_attached(tmp_path, name, unit):
    with h5py.File(tmp_path / "road.h5", "w") as file:
        file["distance"], file["elevation"] = X, Z / 0.0254
        file["elevation"].attrs[name] = unit
    assert mf.read_profile(tmp_path / "road.h5").profile.elevation == pytest.approx(Z, rel=1e-14, abs=1e-18)


def test_a_gap_may_be_filled_by_the_length_that_the_message_names(tmp_path):
    for first, step in ((523417.62, 0.0762), (0.0, 2 / 7)):
        stations = first + step * np.arange(40)
        rows = "".join(
            f"{x},{z if n not in (20, 21) else ''}\n" for n, (x, z) in enumerate(zip(stations, Z, strict=True))
        )
        file = written(tmp_path, "road.csv", rows)
        with pytest.raises(ValueError, match=r"the longest ([0-9.]+) m long") as caught:
            mf.read_profile(file)
        said = str(caught.value)
        named = float(said.split("the longest ")[1].split(" m")[0])
        assert f"no elevation at {round(stations[20], 4)} m" in said
        assert "in 1 gap by straight lines" in mf.read_profile(file, repair_gaps=named).profile.steps[0]
        with pytest.raises(ValueError, match="allows"):
            mf.read_profile(file, repair_gaps=named * 0.999)


def test_places_are_named_in_all_the_digits_that_they_have():
    stations = 523417.62 + 0.0762 * np.arange(400)
    elevation = 0.001 * np.sin(np.arange(400.0))
    elevation[100] += 0.05
    elevation[200:300] = elevation[200]
    findings = " ".join(mf.describe_profile(mf.Profile(stations, elevation)).findings)
    assert "mm at 523425.24 m: a spike" in findings
    assert "from 523432.86 m on" in findings

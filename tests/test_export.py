"""Results for other programs: what every kind of result becomes in every kind of file, read by others."""

from __future__ import annotations

import csv
import io
import sys

import numpy as np
import pytest
import scipy.io
import xarray as xr

import movingfrf as mf
from movingfrf._basics.matlab_file import arrays_and_texts
from movingfrf.commands.main import main
from movingfrf.results.export import exported
from movingfrf.results.exports.matlab import valid_names
from movingfrf.results.files import save

ROAD = mf.track(mf.EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9), mf.Spring(stiffness=8e6, damping=3e4))
SPECTRUM = mf.IsoRoad.of_class("A")


@pytest.fixture(scope="module")
def results():
    """One result of every kind, small, and one in coarser steps than it was solved in."""
    truck = mf.catalogue(name="half_truck")
    profile = mf.realise(SPECTRUM, length=60.0, seed=1)
    frequency = np.linspace(1.0, 20.0, 20)
    alone = mf.Spring(stiffness=8e6, damping=3e4)
    return {
        "coupled": mf.simulate(ROAD, truck, profile, speed=10.0, duration=2.0, start=15.0),
        "coarse": mf.simulate(ROAD, truck, profile, speed=10.0, duration=2.0, start=15.0, time_step=0.04),
        "loaded": mf.moving_loads(
            ROAD, np.outer(np.hanning(200), [1e4, 5e3]), [0.0, -3.0], speed=10.0, observe=[0.0, 2.0]
        ),
        "transfer": mf.transfer(ROAD, truck, speed=10.0, frequency=frequency),
        "random": mf.random_response(ROAD, truck, SPECTRUM, speed=10.0),
        "receptance": mf.receptance(
            mf.track(mf.EulerBernoulliBeam(bending_stiffness=1e7, mass=700.0), alone), frequency
        ),
    }


KINDS = ("coupled", "coarse", "loaded", "transfer", "random", "receptance")
pytestmark = pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")


def table(data):
    """Heads of a CSV file, as the csv module reads them, and its numbers."""
    heads, *rows = csv.reader(io.StringIO(data.decode()))
    return heads, np.array(rows, float)


def test_heads_of_a_table(results):
    heads, _ = table(exported(results["coupled"], ".csv"))
    assert heads[:4] == ["time [s]", "distance [m]", "contact force front [N]", "contact force rear [N]"]
    assert "motion pitch [rad]" in heads
    assert "acceleration front_wheel [m/s2]" in heads
    assert table(exported(results["loaded"], ".csv"))[0] == [
        "time [s]",
        "force at 0 m [N]",
        "force at -3 m [N]",
        "deflection at 0 m [m]",
        "deflection at 2 m [m]",
    ]
    assert "acceleration density pitch [(rad/s2)2/Hz]" in table(exported(results["random"], ".csv"))[0]
    heads, numbers = table(exported(results["transfer"], ".csv"))
    at = heads.index("motion pitch per roughness under rear (imaginary) [rad/m]")
    assert (numbers[:, at] == results["transfer"].motion.values[:, 1, 1].imag).all()


@pytest.mark.parametrize("kind", KINDS)
def test_a_table_has_every_digit_of_every_column(results, kind):
    result = results[kind]
    axis = "time" if "time" in result.dims else "frequency"
    wanted = [result[axis].values[:, None]]
    if kind in ("coupled", "coarse"):
        wanted.append(15.0 + 10.0 * wanted[0])
    for variable in result.data_vars.values():
        if variable.dims[0] == axis:
            columns = variable.values.reshape(variable.shape[0], -1)
            both = np.stack([columns.real, columns.imag], axis=2) if columns.dtype.kind == "c" else columns
            wanted.append(both.reshape(len(columns), -1))
    heads, numbers = table(exported(result, ".csv"))
    assert (numbers == np.concatenate(wanted, axis=1)).all()
    assert len(set(heads)) == len(heads) == numbers.shape[1]
    assert all(head.endswith("]") for head in heads)


@pytest.mark.parametrize("kind", KINDS)
def test_matlab_by_scipy_and_by_our_own_reader(results, kind):
    result, data = results[kind], exported(results[kind], ".mat")
    there = scipy.io.loadmat(io.BytesIO(data), simplify_cells=True)
    for name, variable in result.variables.items():
        assert np.array_equal(np.squeeze(there[name]), np.squeeze(variable.values)), name
        assert there["units"][name] == variable.attrs.get("units", variable.attrs.get("comment"))
        assert there["dimensions"][name] == ", ".join(variable.dims)
    assert there["settings"]["title"] == result.attrs["title"]
    ours = arrays_and_texts(data)
    for name, variable in result.variables.items():
        if variable.dtype.kind in "if":
            assert np.array_equal(np.squeeze(ours.numbers[name].load()), np.squeeze(variable.values)), name
        elif variable.dtype.kind == "U":
            assert ours.texts[name]() == variable.values.tolist()


def test_names_in_matlab():
    assert valid_names(["a b", "a_b", "Länge", "_x", "for", "x" * 70]) == {
        "a b": "a_b",
        "a_b": "a_b_2",
        "Länge": "L_nge",
        "_x": "x_x",
        "for": "for_",
        "x" * 70: "x" * 63,
    }
    alike = valid_names(["y" * 63 + end for end in "ab"])
    assert sorted(map(len, alike.values())) == [63, 63]
    assert len(set(alike.values())) == 2


def test_an_attribute_of_ones_own_gets_a_name(results):
    data = exported(results["coupled"].assign_attrs({"my remark": "wet"}), ".mat")
    assert scipy.io.loadmat(io.BytesIO(data), simplify_cells=True)["settings"]["my_remark"] == "wet"


@pytest.mark.parametrize("kind", KINDS)
def test_universal_file(results, kind, tmp_path):
    pyuff = pytest.importorskip("pyuff", reason="the extra `io` is not installed")
    result = results[kind]
    axis = "time" if "time" in result.dims else "frequency"
    mf.export(result, tmp_path / "r.uff")
    read = pyuff.UFF(str(tmp_path / "r.uff")).read_sets()
    sets = iter(read if isinstance(read, list) else [read])
    nodes = set()
    for name, variable in result.data_vars.items():
        if variable.dims[0] != axis:
            continue
        for column in variable.values.reshape(variable.shape[0], -1).T:
            read = next(sets)
            label = read["ordinate_axis_lab"]
            whole = name.replace("_density", "_PSD").split("_")
            assert label.split() == whole[: len(label.split())]
            assert 0 < len(label) <= 20
            assert name.replace("_", " ") in read["id1"]
            np.testing.assert_allclose(read["data"], column, rtol=1e-11)
            np.testing.assert_allclose(read["x"], result[axis].values, rtol=1e-5)
            assert read["func_type"] == {"coupled": 1, "coarse": 1, "loaded": 1, "random": 9}.get(kind, 4)
            assert read["abscissa_spec_data_type"] == (17 if axis == "time" else 18)
            assert read["abscissa_spacing"] == (0 if kind == "random" else 1)
            nodes.add((read["id1"], read["rsp_node"], read["ref_node"], read["ordinate_axis_lab"]))
    assert next(sets, None) is None
    assert len({node[1:] for node in nodes}) == len(nodes)


def test_signs_and_units_in_a_universal_file(results, tmp_path):
    pyuff = pytest.importorskip("pyuff", reason="the extra `io` is not installed")
    mf.export(results["transfer"], tmp_path / "r.uff")
    mf.export(results["coupled"], tmp_path / "h.uff")
    sets = {file: pyuff.UFF(str(tmp_path / file)).read_sets() for file in ("r.uff", "h.uff")}
    named = {one["id1"]: one for found in sets.values() for one in found}
    force = named["contact force rear per roughness under front"]
    assert (force["rsp_ent_name"].strip(), force["ref_ent_name"].strip()) == ("rear", "front")
    assert (force["rsp_node"], force["ref_node"], force["rsp_dir"], force["ref_dir"]) == (2, 1, -3, 3)
    assert (force["ordinate_spec_data_type"], force["orddenom_spec_data_type"]) == (9, 8)
    assert force["ordinate_axis_units_lab"] == "N/m"
    pitch = named["motion pitch"]
    assert (pitch["rsp_node"], pitch["rsp_dir"], pitch["ordinate_axis_units_lab"]) == (1002, 0, "rad")
    assert named["roughness front"]["rsp_dir"] == 3
    assert pitch["abscissa_inc"] == 1e-3


def test_equal_results_have_equal_bytes(results, monkeypatch):
    first = exported(results["coupled"], ".mat")
    monkeypatch.setattr("time.asctime", lambda *_: "Thu Jan  1 00:00:00 1970")
    assert exported(results["coupled"], ".mat") == first
    assert first.startswith(b"MATLAB 5.0 MAT-file, written by movingfrf")


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("ending", [".csv", ".mat"])
def test_the_command_writes_what_python_does(results, kind, ending, tmp_path, capsys):
    save(results[kind], tmp_path / "result.nc")
    assert main(["export", str(tmp_path / "result.nc"), str(tmp_path / f"out{ending}")]) == 0
    assert capsys.readouterr().out == f"wrote {tmp_path / f'out{ending}'}\n"
    assert (tmp_path / f"out{ending}").read_bytes() == exported(results[kind], ending)
    assert sorted(file.name for file in tmp_path.iterdir()) == [f"out{ending}", "result.nc"]


def test_nothing_is_replaced_unasked(results, tmp_path, capsys):
    save(results["loaded"], tmp_path / "result.nc")
    target = tmp_path / "mine.csv"
    target.write_text("mine")
    assert main(["export", str(tmp_path / "result.nc"), str(target)]) == 2
    assert (
        "mine.csv exists; choose another name, or replace it with `force` (on the command line --force)"
        in capsys.readouterr().err
    )
    with pytest.raises(ValueError, match=r"mine.csv exists; choose another name, or replace it with `force`"):
        mf.export(results["loaded"], target)
    assert target.read_text() == "mine"
    assert main(["export", str(tmp_path / "result.nc"), str(target), "--force"]) == 0
    assert target.read_text().startswith("time [s],")


def test_refusals(results, tmp_path, capsys):
    result = results["coupled"]
    with pytest.raises(mf.ParameterError, match=r"file must end in .csv, .mat, .uff, got '.xls'"):
        mf.export(result, tmp_path / "a.xls")
    with pytest.raises(mf.ParameterError, match="result must be a result of movingfrf over time or frequency"):
        mf.export(mf.aggregate_force(result), tmp_path / "a.csv")
    xr.Dataset({"a": ("x", [1.0])}).to_netcdf(tmp_path / "a.nc", engine="h5netcdf")
    assert main(["export", str(tmp_path / "a.nc"), str(tmp_path / "a.csv")]) == 2
    assert "a.nc: is no result of movingfrf" in capsys.readouterr().err
    assert [file.name for file in tmp_path.iterdir()] == ["a.nc"]


def test_a_variable_of_ones_own(results, tmp_path):
    """Along a dimension that the package does not know."""
    own = results["loaded"].assign(shape=(("time", "mode"), np.ones((200, 2)), {"units": "kg"}))
    heads, _ = table(exported(own, ".csv"))
    assert heads[-2:] == ["shape mode 0 [kg]", "shape mode 1 [kg]"]
    pyuff = pytest.importorskip("pyuff", reason="the extra `io` is not installed")
    mf.export(own, tmp_path / "a.uff")
    assert pyuff.UFF(str(tmp_path / "a.uff")).read_sets()[-1]["rsp_node"] == 6002


def heads_of(result):
    return [head for head in table(exported(result, ".csv"))[0] if not head.startswith(("time", "distance"))]


def test_a_part_keeps_its_names_and_units(results):
    """What was chosen by one value, of a dimension or of two, is named as it is in the whole."""
    whole, transfer = results["coupled"], results["transfer"]
    assert heads_of(whole.sel(dof="pitch"))[2:6] == [
        "deflection front [m]",
        "deflection rear [m]",
        "motion pitch [rad]",
        "acceleration pitch [rad/s2]",
    ]
    assert heads_of(whole.isel(contact=1))[:2] == ["contact force rear [N]", "deflection rear [m]"]
    assert heads_of(whole.isel(contact=[1]))[0] == "contact force rear [N]"
    assert heads_of(whole.drop_vars("contact_name").isel(contact=[1]))[0] == "contact force contact 1 [N]"
    one = table(exported(transfer.isel(source=1, contact=0).sel(dof="pitch"), ".csv"))[0]
    assert "contact force front per roughness under contact 1 (real) [N/m]" in one
    assert "motion pitch per roughness under contact 1 (imaginary) [rad/m]" in one
    assert "motion density pitch [rad2/Hz]" in table(exported(results["random"].sel(dof="pitch"), ".csv"))[0]
    assert heads_of(results["loaded"].isel(point=1))[-1] == "deflection at 2 m [m]"


def test_dimensions_in_any_order_and_more_of_them(results):
    whole = results["coupled"]
    assert exported(whole.transpose("contact", "dof", "time", ...), ".csv") == exported(whole, ".csv")
    twice = xr.concat([whole, whole], "case")
    heads, numbers = table(exported(twice[["contact_force"]], ".csv"))
    for name, case, contact in (("front case 1", 1, 0), ("rear case 0", 0, 1)):
        column = numbers[:, heads.index(f"contact force {name} [N]")]
        np.testing.assert_array_equal(column, twice.contact_force.values[case, :, contact])
    numbered = heads_of(twice.assign_coords(case=[0.5, 2.0])[["contact_force"]])
    assert numbered[2] == "contact force front case 2.0 [N]"
    alike = heads_of(results["loaded"].assign_coords(load=("load", [0.0, 0.0], {"units": "m"})))
    assert alike[:2] == ["force load 0 [N]", "force load 1 [N]"]


def test_units_are_those_that_a_variable_says(results):
    whole = results["coupled"]
    in_kn = whole.assign(contact_force=(whole.contact_force / 1e3).assign_attrs(units="kN"))
    assert heads_of(in_kn)[0] == "contact force front [kN]"
    assert "motion pitch [m or rad]" in heads_of(whole.drop_vars("dof_unit"))
    assert "motion [m or rad]" in heads_of(whole.mean("dof", keep_attrs=True))


@pytest.mark.parametrize("ending", [".csv", ".uff"])
def test_a_part_without_a_history_is_refused(results, ending):
    if ending == ".uff":
        pytest.importorskip("pyuff", reason="the extra `io` is not installed")
    for kind, left in (("coupled", ["static_load", "time"]), ("random", ["static_load", "frequency"])):
        with pytest.raises(ValueError, match=r"result must hold a variable over \w+, got none; .mat takes"):
            exported(results[kind][left], ending)
    assert exported(results["random"][["static_load", "frequency"]], ".mat")


def test_a_universal_file_of_what_is_over_time_alone(results, tmp_path):
    pyuff = pytest.importorskip("pyuff", reason="the extra `io` is not installed")
    whole = results["coupled"]

    def nodes(part):
        mf.export(part, tmp_path / "a.uff", force=True)
        sets = pyuff.UFF(str(tmp_path / "a.uff")).read_sets()
        return {one["id1"]: (one["rsp_node"], one["rsp_ent_name"].strip()) for one in sets}

    assert nodes(whole.isel(contact=1))["contact force rear"] == (2, "rear")
    assert nodes(whole.isel(contact=[1]))["contact force rear"] == (2, "rear")
    assert nodes(whole.mean("contact", keep_attrs=True))["contact force"] == (0, "NONE")
    assert nodes(whole.assign(wind=("time", np.ones(2000))))["wind"] == (0, "NONE")
    assert nodes(whole.drop_vars("dof_unit"))["motion pitch"] == (1002, "pitch")


def test_variables_called_as_the_structures_of_a_matlab_file(results):
    own = results["loaded"].assign(units=("time", np.arange(200.0)), settings=("time", np.ones(200)), units_2=7.0)
    there = scipy.io.loadmat(io.BytesIO(exported(own, ".mat")), simplify_cells=True)
    assert there["units"]["force"] == "N"
    assert there["settings"]["kind"] == "loaded"
    assert np.array_equal(there["units_2"], np.arange(200.0))
    assert there["dimensions"]["settings_2"] == "time"
    assert there["units_2_2"] == 7.0


def test_a_full_disk_where_a_universal_file_is_made(results, tmp_path, monkeypatch):
    pyuff = pytest.importorskip("pyuff", reason="the extra `io` is not installed")

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(pyuff.UFF, "write_sets", full)
    with pytest.raises(OSError, match="No space left on device, while it is made in ") as failed:
        mf.export(results["coupled"], tmp_path / "a.uff")
    assert failed.value.filename == str(tmp_path / "a.uff")


def test_what_pyuff_hides(results, tmp_path, monkeypatch):
    pyuff = pytest.importorskip("pyuff", reason="the extra `io` is not installed")

    def full(*_):
        try:
            raise OSError(28, "No space left on device")
        except OSError:
            raise Exception("Error writing data-set #58")  # noqa: B904

    monkeypatch.setattr(pyuff.UFF, "write_sets", full)
    with pytest.raises(OSError, match="No space left"):
        mf.export(results["coupled"], tmp_path / "a.uff")
    assert not list(tmp_path.iterdir())


def test_without_the_extra(results, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyuff", None)
    with pytest.raises(ValueError, match=r"need pyuff: pip install pyuff, or the extra `io`"):
        mf.export(results["coupled"], tmp_path / "a.uff")
    assert not list(tmp_path.iterdir())


def test_a_universal_file_needs_two_points(results, tmp_path):
    pytest.importorskip("pyuff", reason="the extra `io` is not installed")
    with pytest.raises(ValueError, match="at least two points of time, got 1"):
        mf.export(results["loaded"].isel(time=[0]), tmp_path / "a.uff")


def test_what_is_claimed_of_conventions(results):
    """CF allows no complex numbers, and wants coordinates in order; units are what UDUNITS reads."""
    claimed = {kind for kind in KINDS if results[kind].attrs.get("Conventions") == "CF-1.11"}
    assert claimed == {"coupled", "coarse", "random", "loaded"}
    for kind in claimed:
        for name, variable in results[kind].variables.items():
            assert variable.attrs["long_name"]
            assert " or " not in variable.attrs.get("units", ""), name
            assert ("units" in variable.attrs) != ("comment" in variable.attrs)


def test_points_out_of_order_are_not_claimed_to_be():
    loads = mf.moving_loads(ROAD, np.ones((50, 1)), [0.0], speed=10.0, observe=[0.0, 2.0, 1.0])
    assert "Conventions" not in loads.attrs
    assert mf.moving_loads(ROAD, np.ones((50, 1)), [0.0], speed=10.0, observe=[2.0, 1.0, 0.0]).attrs["Conventions"]


def test_a_coordinate_misses_nothing(results, tmp_path):
    import h5py

    save(results["coupled"], tmp_path / "r.nc")
    with h5py.File(tmp_path / "r.nc") as file:
        assert "_FillValue" not in file["time"].attrs
        assert file["time"].attrs["units"] == "s"
        assert file.attrs["Conventions"] == "CF-1.11"


def test_one_unit_where_all_degrees_of_freedom_have_one():
    car = mf.quarter_car(
        body_mass=400.0, wheel_mass=40.0, suspension_stiffness=2e4, suspension_damping=1.5e3, tyre_stiffness=2e5
    )
    found = mf.transfer(ROAD, car, speed=10.0, frequency=[1.0, 2.0])
    assert found.motion.attrs["units"] == "m/m"
    assert found.acceleration.attrs["units"] == "1/s2"


def test_labels_of_universal_files_end_with_a_word():
    from movingfrf.results.exports.universal import _label

    assert _label("contact_force_density") == "contact force PSD"
    assert _label("acceleration_of_the_left_mirror") == "acceleration of the"
    assert _label("x" * 30) == "x" * 20

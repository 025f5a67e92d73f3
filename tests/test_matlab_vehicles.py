"""Vehicles and sampled guideways as MATLAB has them: sparse, in structs, texts as rows of characters."""

from __future__ import annotations

import re

import numpy as np
import pytest
from scipy import sparse
from scipy.io import savemat

import movingfrf as mf

TRUCK, CAR = mf.catalogue("half_truck"), mf.catalogue("golden_car")
NAMES = list(TRUCK.dof_names)


def stored(vehicle):
    mass, damping, stiffness, contact_map = vehicle.matrices
    return {
        "mass": mass,
        "damping": damping,
        "stiffness": stiffness,
        "contact_map": contact_map,
        "position": vehicle.positions,
        "contact_stiffness": vehicle.springs,
        "vertical": np.asarray(vehicle.vertical),
    }


def read(arrays, folder, **how):
    savemat(folder / "lorry.mat", arrays, **how)
    return mf.read_vehicle(folder / "lorry.mat")


def refusal(arrays, folder):
    with pytest.raises(ValueError, match=r"lorry\.mat: ") as caught:
        read(arrays, folder)
    return str(caught.value).partition("lorry.mat: ")[2]


def same(found, wanted=TRUCK):
    for one, other in zip(found.matrices, wanted.matrices, strict=True):
        np.testing.assert_array_equal(one, other)
    np.testing.assert_array_equal(found.static_loads, wanted.static_loads)


MATRICES = ("mass", "damping", "stiffness", "contact_map")


@pytest.mark.parametrize("packed", [False, True])
@pytest.mark.parametrize("names", [MATRICES, ("stiffness",), ("contact_map",)])
def test_sparse_matrices(names, packed, tmp_path):
    arrays = stored(TRUCK)
    same(read(arrays | {name: sparse.csc_array(arrays[name]) for name in names}, tmp_path, do_compression=packed))


def test_a_sparse_matrix_without_entries_and_one_of_a_single_column(tmp_path):
    arrays = stored(CAR)
    still = {"damping": sparse.csc_array((2, 2))}
    column = {"contact_map": sparse.csc_array(arrays["contact_map"].T)}
    assert not read(arrays | still, tmp_path).matrices[1].any()
    same(read(arrays | column, tmp_path), CAR)


@pytest.mark.parametrize(
    ("ending", "message"),
    [
        ("II", "does not fit"),  # rows beyond the matrix
        ("cut", "is damaged"),
    ],
)
def test_damaged_sparse_matrices(ending, message, tmp_path):
    file = tmp_path / "lorry.mat"
    savemat(file, stored(TRUCK) | {"stiffness": sparse.csc_array(np.eye(4))})
    data = bytearray(file.read_bytes())
    rows = data.index(np.arange(4, dtype="<i4").tobytes())  # row numbers of the unit matrix
    if ending == "cut":
        del data[-40:]
    else:
        data[rows : rows + 4] = np.int32(7).tobytes()
    file.write_bytes(data)
    with pytest.raises(ValueError, match=message):
        mf.read_vehicle(file)


def test_any_damage_to_a_sparse_matrix_ends_in_an_error_or_in_numbers(tmp_path):
    """Whatever the counts claim: no huge allocation, no error of another kind."""
    file = tmp_path / "lorry.mat"
    savemat(file, {"stiffness": sparse.csc_array(np.eye(4))} | stored(CAR))
    whole = file.read_bytes()
    rng = np.random.default_rng(1)
    for _ in range(400):
        data = bytearray(whole)
        for at in rng.integers(128, 400, 3):
            data[at] = rng.integers(256)
        file.write_bytes(data)
        try:
            mf.read_vehicle(file)
        except ValueError as error:
            assert str(error)  # noqa: PT017


def test_a_sparse_matrix_that_claims_to_be_huge(tmp_path):
    huge = sparse.csc_array(([1.0], ([0], [0])), shape=(100_000, 100_000))
    assert "'mass' of shape (100000, 100000), too large" in refusal(stored(TRUCK) | {"mass": huge}, tmp_path)


def test_one_struct_that_holds_everything(tmp_path):
    names = np.array(NAMES, dtype=object)
    found = read({"truck": stored(TRUCK) | {"dof_names": names}, "ans": 3.0}, tmp_path)
    same(found)
    assert found.dof_names == TRUCK.dof_names
    same(read({"model": {"truck": stored(TRUCK), "date": "today"}}, tmp_path))


def test_structs_of_which_none_is_the_vehicle(tmp_path):
    both = {"truck": stored(TRUCK), "car": stored(CAR)}
    assert refusal(both, tmp_path) == "holds a vehicle in several structs, car, truck: save one of them"
    short = {name: array for name, array in stored(TRUCK).items() if name != "mass"}
    assert refusal({"truck": short}, tmp_path) == "mass is missing"
    same(read({"truck": stored(TRUCK), "other": {"mass": 3.0}}, tmp_path))


def test_names_as_rows_of_characters(tmp_path):
    rows = np.array([name.ljust(12) for name in NAMES])
    assert read(stored(TRUCK) | {"dof_names": rows}, tmp_path).dof_names == TRUCK.dof_names
    assert read({"t": stored(TRUCK) | {"dof_names": rows}}, tmp_path).dof_names == TRUCK.dof_names


def test_rows_and_columns(tmp_path):
    arrays = stored(TRUCK)
    flat = ("position", "contact_stiffness", "vertical")
    for form in ((1, -1), (-1, 1)):
        same(read(arrays | {name: np.reshape(arrays[name], form) for name in flat}, tmp_path))
    assert "contact_map must have shape (2, 4), got (4, 2)" in refusal(
        arrays | {"contact_map": arrays["contact_map"].T}, tmp_path
    )


def test_further_variables_are_named_in_one_sentence(tmp_path):
    more = {"ans": 1.0, "Q": np.eye(2), "note": "a text"}
    told = refusal(stored(TRUCK) | more, tmp_path)
    assert told.startswith(
        "ans, Q, note are not known: leave them out or rename them; a vehicle consists of mass, "
    )
    assert told.count("consists of") == 1


def test_what_is_there_and_not_read_is_named(tmp_path):
    lossy = stored(TRUCK)["stiffness"] * (1 + 0.1j)
    told = refusal(stored(TRUCK) | {"stiffness": lossy}, tmp_path)
    assert told == "holds as stiffness an array of complex numbers, which is not read"
    assert "a sparse matrix of complex numbers" in refusal(
        stored(TRUCK) | {"stiffness": sparse.csc_array(lossy)}, tmp_path
    )


def with_contacts(matrix, at_contacts):
    contact_map = TRUCK.matrices[3]
    return matrix + contact_map.T @ np.diag(at_contacts) @ contact_map


def test_matrices_that_include_the_contacts(tmp_path):
    arrays, dashpots = stored(TRUCK), [1e3, 2e3]
    tyres = with_contacts(arrays["stiffness"], TRUCK.springs)
    assert refusal(arrays | {"stiffness": tyres}, tmp_path).endswith(
        "it includes the springs of the contacts, which stand apart: take them out"
    )
    damped = {"damping": with_contacts(arrays["damping"], dashpots)}
    assert "it includes the dashpots of the contacts" in refusal(
        arrays | damped | {"contact_damping": dashpots}, tmp_path
    )
    # Told as nothing apart, what is within can only be asked for.
    assert "are dashpots of the contacts, which stand apart, included, or" in refusal(arrays | damped, tmp_path)


def test_a_missing_vertical_is_asked_for(tmp_path):
    arrays = {name: array for name, array in stored(TRUCK).items() if name != "vertical"}
    told = refusal(arrays, tmp_path)
    assert told.endswith("vertical is missing, so it is 1 throughout: a rotation needs a 0 there")
    assert len(re.findall("is vertical 1 for a rotation", told)) == 1
    wrong = refusal(arrays | {"vertical": np.ones(4)}, tmp_path)
    assert "is vertical 1 for a rotation?" in wrong
    assert "is missing" not in wrong
    same(read({name: array for name, array in stored(CAR).items() if name != "vertical"}, tmp_path), CAR)


def test_a_sampled_guideway_in_a_struct(tmp_path):
    time = 1e-3 * np.arange(2000)
    record = {
        "response": np.exp(-40.0 * time)[:, None] * [4e-7, 1e-7],
        "time_step": 1e-3,
        "offsets": [0.0, 2.0],
        "speed": 10.0,
        "remarks": np.array(["code: one   ", "other: a row"]),
    }
    savemat(tmp_path / "road.mat", {"road": record, "ans": 1.0})
    with pytest.warns(mf.ValidityWarning):  # of what it says of itself
        found = mf.read_sampled_guideway(tmp_path / "road.mat")
    assert found.samples.shape == (2000, 2)
    assert [tuple(remark) for remark in found.remarks] == [("code", "one"), ("other", "a row")]
    savemat(tmp_path / "road.mat", record | {"ans": 1.0, "k": 2.0})
    with pytest.raises(ValueError, match=r"road.mat: ans, k are not known: leave them out or rename them"):
        mf.read_sampled_guideway(tmp_path / "road.mat")

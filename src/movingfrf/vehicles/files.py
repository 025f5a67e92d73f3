"""Vehicles as matrices in files: MATLAB, NumPy and TOML."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from movingfrf._basics.array_file import Arrays, Content, read_arrays, write_arrays
from movingfrf._basics.checks import Checks, Fault, ParameterError, checking, real_numbers
from movingfrf._basics.toml_file import tables_of, text_of
from movingfrf.vehicles.contact import Contact
from movingfrf.vehicles.vehicle import Vehicle, require_vehicle


@dataclass(frozen=True, slots=True, kw_only=True)
class VehicleArrays:
    """Names of the arrays that a file may hold."""

    matrices: tuple[str, ...] = ("mass", "damping", "stiffness", "contact_map")
    # Per contact: what a file must say of it, and what it may say.
    contact: tuple[str, ...] = ("position", "contact_stiffness")
    contact_optional: tuple[str, ...] = ("contact_damping", "path", "across", "footprint", "cams")
    descriptive: tuple[str, ...] = ("vertical", "dof_names", "contact_name")

    @property
    def required(self) -> tuple[str, ...]:
        """What a file must hold."""
        return (*self.matrices, *self.contact)

    @property
    def optional(self) -> tuple[str, ...]:
        """What may stand beside it."""
        return (*self.contact_optional, *self.descriptive)


ARRAYS = VehicleArrays()

# A vehicle of a thousand degrees of freedom is not larger [a convention].
VEHICLE = Content(
    what="a vehicle", largest=2**28, needed=ARRAYS.required, others=ARRAYS.optional, texts=ARRAYS.optional
)


def read_vehicle(file: str | Path) -> Vehicle:
    """Read a vehicle from a file of matrices: `.mat` (MATLAB), `.npz` (NumPy) or `.toml`.

    A .mat file may hold all of it in the fields of one struct, and matrices may be sparse there.

    Parameters
    ----------
    file : str or Path
        The file. It holds `mass`, `damping`, `stiffness` (dof, dof), the latter two without the dashpots and
        springs of the contacts, which stand apart: `contact_map` (contact, dof), and per contact `position` [m],
        `contact_stiffness` [N/m] (`inf`: rigid) and, where wanted, `contact_damping` [N s/m], `path` (counted from
        0), `across` [m], `footprint` [m], `cams` [m], `contact_name`. Optional: `vertical` (dof), 1 for a
        translation and 0 for a rotation, else 1 for every degree of freedom; `dof_names`, else `dof_1`, `dof_2` …

    Returns
    -------
    Vehicle
        The vehicle.

    Raises
    ------
    ValueError
        If the file cannot be read, an array is missing, unknown or of the wrong shape, or the vehicle is refused.
    """
    arrays = read_arrays(file, VEHICLE, {".toml": _read_toml})
    try:
        return _filled(arrays)
    except ParameterError as error:
        raise ValueError(f"{Path(file)}: {error}") from None


def write_vehicle(vehicle: Vehicle, file: str | Path) -> None:
    """Write a vehicle as a file of matrices, `.mat` or `.npz`, that `read_vehicle` reads.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle.
    file : str or Path
        The file; replaced if it is there.

    Raises
    ------
    ValueError
        If the ending is another one.
    """
    require_vehicle(vehicle)
    mass, damping, stiffness, contact_map = vehicle.matrices
    arrays: dict[str, Any] = {
        "mass": mass,
        "damping": damping,
        "stiffness": stiffness,
        "contact_map": contact_map,
        "position": vehicle.positions,
        "contact_stiffness": vehicle.springs,
        **{
            name: np.array([getattr(one, _field(name)) for one in vehicle.contacts])
            for name in ARRAYS.contact_optional
        },
        "vertical": np.asarray(vehicle.vertical),
        "dof_names": np.array(vehicle.dof_names),
        "contact_name": np.array([one.name for one in vehicle.contacts]),
    }
    write_arrays(file, arrays, VEHICLE.what)


def _filled(arrays: Mapping[str, Any]) -> Vehicle:
    with checking() as check:
        VEHICLE.check_names(check, arrays)
    with checking() as check:
        matrices = {name: _table(check, name, arrays[name]) for name in ARRAYS.matrices}
        contacts, dofs = _row(check, "position", arrays["position"]).size, len(matrices["mass"])
        if contacts == 1 and matrices["contact_map"].shape == (dofs, 1):
            matrices["contact_map"] = matrices["contact_map"].T  # a column of MATLAB's
        columns = {
            name: _row(check, name, arrays[name], contacts)
            for name in (*ARRAYS.contact, *ARRAYS.contact_optional)
            if name in arrays and not check.faults
        }
        paths = columns.get("path", np.zeros(contacts))
        if not np.isfinite(paths).all() or (paths % 1).any():
            check.refuse("path", "must be whole numbers, counted from 0")
        vertical = _row(check, "vertical", arrays.get("vertical", np.ones(dofs)), dofs)
        names = _texts(check, "dof_names", arrays.get("dof_names", [f"dof_{n}" for n in range(1, dofs + 1)]))
        called = _texts(check, "contact_name", arrays.get("contact_name", [""] * contacts))
        if len(called) != contacts:
            check.refuse("contact_name", f"must be {contacts} texts, got {len(called)}")
    columns = {_field(name): column for name, column in columns.items()}
    listed = []
    for number in range(contacts):
        values: dict[str, Any] = {name: float(column[number]) for name, column in columns.items()}
        listed.append(Contact(**values | {"path": int(paths[number]), "name": called[number]}))
    try:
        return Vehicle(**matrices, contacts=listed, vertical=vertical, dof_names=names)
    except ParameterError as error:
        if "vertical" in arrays or not any("times vertical" in fault.message for fault in error.faults):
            raise
        raise ParameterError(
            [*error.faults, Fault("vertical", "is missing, so it is 1 throughout: a rotation needs a 0 there")]
        ) from None


def _field(name: str) -> str:
    """Name the field of a `Contact` that an array of values per contact fills."""
    return name.removeprefix("contact_")


def _texts(check: Checks, name: str, value: Any) -> list[str]:
    """Texts of a list or an array."""
    return list(check.listed(name, value.ravel().tolist() if isinstance(value, np.ndarray) else value, str))


def _table(check: Checks, name: str, value: Any) -> np.ndarray:
    try:
        table = np.atleast_2d(_real(value))
    except (TypeError, ValueError) as error:
        check.refuse(name, f"must be a matrix of real numbers: {error}")
        return np.zeros((1, 1))
    if table.ndim != 2 or not table.size:
        check.refuse(name, f"must be a matrix, got an array of shape {table.shape}")
        return np.zeros((1, 1))
    return table


def _real(value: Any) -> np.ndarray:
    """Real numbers; a loss factor as an imaginary part is none."""
    if np.iscomplexobj(value):
        raise ValueError("complex ones, as for hysteretic damping, are not supported")
    return real_numbers(value)


def _row(check: Checks, name: str, value: Any, count: int | None = None) -> np.ndarray:
    """Numbers of a row or a column."""
    try:
        row = _real(value).ravel()
    except (TypeError, ValueError) as error:
        check.refuse(name, f"must be real numbers: {error}")
        return np.ones(count or 1)
    if count is not None and row.size != count:
        check.refuse(name, f"must be {count} numbers, got {row.size}")
        return np.ones(count or 1)
    if np.isnan(row).any():
        check.refuse(name, "must be numbers throughout")
    return row


def _read_toml(path: Path, _: Content) -> Arrays:
    try:
        return tables_of(text_of(path.read_bytes()))
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None

"""A sweep as a table that spreadsheets open: one line a case."""

from __future__ import annotations

import csv
import io
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import xarray as xr


def as_csv(table: xr.Dataset) -> str:
    """Write a sweep as comma-separated values.

    Parameters
    ----------
    table : xarray.Dataset
        What `sweep` returned.

    Returns
    -------
    str
        A line of heads, as `contact_force_rms front [N]`, and one for each case: values of the axes, measures, the
        step in time, why it has no answer, what is to be known of it.
    """
    dims = table.status.dims
    shape = tuple(table.sizes[dim] for dim in dims)
    varied = [str(name) for name in table.coords if table[name].dims and set(table[name].dims) <= set(dims)]
    columns: list[tuple[str, Any]] = [
        (with_unit(name, table[name]), np.broadcast_to(_spread(table[name], dims), shape).ravel())
        for name in varied
    ]
    for name in measures_in(table):
        values = table[name]
        place = str(values.dims[-1])
        called, unit = _called(table, place), values.attrs.get("units", "1")
        for number, word in enumerate(called):
            here = _unit(table, unit, number)
            head = f"{name} {word}{'' if here == '1' else f' [{here}]'}"
            columns.append((head, values.values[..., number].ravel()))
    # A step that varies is an axis, and stands with these.
    others = [name for name in ("time_step", "status", "findings") if name in table.data_vars]
    columns += [(with_unit(name, table[name]), table[name].values.ravel()) for name in others]
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([head for head, _ in columns])
    for row in zip(*(values for _, values in columns), strict=True):
        writer.writerow([_cell(value) for value in row])
    return text.getvalue()


def measures_in(table: xr.Dataset) -> list[str]:
    """Name what a sweep has measured: what there is of each contact or degree of freedom, and no history."""
    dims = table.status.dims
    return [str(name) for name, values in table.data_vars.items() if len(values.dims) == len(dims) + 1]


def with_unit(words: str, values: xr.DataArray) -> str:
    """Put the unit of values behind words, as `speed [m/s]`."""
    unit = str(values.attrs.get("units", "1"))
    return words if unit == "1" else f"{words} [{unit}]"


def _spread(values: xr.DataArray, dims: tuple[Any, ...]) -> np.ndarray:
    """Put an axis where it lies among all axes."""
    (dim,) = values.dims
    return values.values.reshape([-1 if dim == other else 1 for other in dims])


def _called(table: xr.Dataset, place: str) -> list[str]:
    """Name contacts or degrees of freedom: by number where names differ from case to case, or are none."""
    names = table[f"{place}_name"]
    if names.dims == (place,) and all(names.values) and len(set(names.values)) == names.size:
        return [str(name) for name in names.values]
    return [f"{place} {number}" for number in range(table.sizes[place])]


def _unit(table: xr.Dataset, unit: str, number: int) -> str:
    """Choose the unit of a degree of freedom, where that is the same in all cases."""
    if " or " not in unit:
        return unit
    units = table["dof_unit"]
    if units.dims != ("dof",):
        return unit
    return unit.split(" or ")[-1 if units.values[number] == "rad" else 0]


def _cell(value: Any) -> Any:
    if isinstance(value, float | np.floating):
        return "" if np.isnan(value) else repr(float(value))
    return value

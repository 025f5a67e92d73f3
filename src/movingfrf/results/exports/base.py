"""What every export has in common: a result as columns over time or frequency, each with a name and a unit."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from movingfrf._basics.arrays import NumberArray
from movingfrf.results.labels import SCHEMAS, kind_of, unit_of

if TYPE_CHECKING:
    import xarray as xr


class Place(NamedTuple):
    """Where something was computed: along which dimension, its number there from 0, and what it is called."""

    dim: str
    number: int
    name: str


class Column(NamedTuple):
    """What one variable is at one place, over time or frequency."""

    variable: str
    places: tuple[Place, ...]  # a response and, of a transfer function, where it comes from
    units: str
    values: NumberArray  # real or complex

    @property
    def name(self) -> str:
        """Variable and places in words."""
        where = [f"per roughness under {name}" if dim == "source" else name for dim, _, name in self.places]
        return " ".join([self.variable.replace("_", " "), *where])


def axis_of(result: xr.Dataset) -> str:
    """Say what the columns of a result run over, time or frequency."""
    return "time" if "time" in result.dims else "frequency"


def columns(result: xr.Dataset) -> list[Column]:
    """Take a result apart into columns over time or frequency.

    Parameters
    ----------
    result : xarray.Dataset
        A result of the package.

    Returns
    -------
    list of Column
        Every variable at every contact, degree of freedom, load and point, in their order; not what holds for all
        times or frequencies, and not the response in the finer steps in which it was solved.
    """
    axis, schema = axis_of(result), SCHEMAS[str(kind_of(result))]
    found = []
    for name, variable in result.data_vars.items():
        if variable.dims[:1] == (axis,):
            units = schema[str(name)].units if name in schema else str(variable.attrs.get("units", "1"))
            for numbers in np.ndindex(variable.shape[1:]):
                places = [_place(result, str(dim), n) for dim, n in zip(variable.dims[1:], numbers, strict=True)]
                unit = unit_of(
                    units, *(str(result.dof_unit.values[each.number]) for each in places if each.dim == "dof")
                )
                found.append(Column(str(name), tuple(places), unit, variable.values[(slice(None), *numbers)]))
    return found


def _place(result: xr.Dataset, dim: str, number: int) -> Place:
    """Name a contact or a degree of freedom by its name, a point or a load by its position."""
    if dim in ("contact", "source"):
        names = result.contact_name.values.tolist() if "contact_name" in result.coords else []
        named = len(set(names)) == len(names) > number and names[number]
        return Place(dim, number, names[number] if named else f"contact {number}")
    if dim not in result.coords:
        return Place(dim, number, f"{dim} {number}")
    value = result[dim].values[number]
    return Place(dim, number, f"at {value:.12g} m" if result[dim].attrs.get("units") == "m" else str(value))

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
        A result of the package, whole or a part, its dimensions in any order, and more of them if it has more.

    Returns
    -------
    list of Column
        Every variable at every contact, degree of freedom, load and point, in their order; not what holds for all
        times or frequencies, and not the response in the finer steps in which it was solved.

    Raises
    ------
    ValueError
        If there is none.
    """
    axis = axis_of(result)
    found = []
    for name, variable in result.data_vars.items():
        if axis not in variable.dims:
            continue
        variable = variable.transpose(axis, ...)
        known = [dim for dim in _dims_of(result, str(name)) if dim in variable.dims or dim in result.coords]
        for numbers in np.ndindex(variable.shape[1:]):
            at = dict.fromkeys(known, 0) | dict(zip(map(str, variable.dims[1:]), numbers, strict=True))
            places = [_place(result, dim, n) for dim, n in at.items()]
            units = units_of(result, str(name), at.get("dof"))
            found.append(Column(str(name), tuple(places), units, variable.values[(slice(None), *numbers)]))
    if not found:
        raise ValueError(f"result must hold a variable over {axis}, got none; .mat takes what there is")
    return found


def units_of(result: xr.Dataset, name: str, dof: int | None = None) -> str:
    """Take the unit that a variable says it has, else that of its kind, for one of its degrees of freedom.

    Parameters
    ----------
    result : xarray.Dataset
        A result of the package, whole or a part.
    name : str
        The variable.
    dof : int, optional
        Number of the degree of freedom, from 0.

    Returns
    -------
    str
        The unit; `m or rad` and the like where nothing says which.
    """
    label = SCHEMAS[str(kind_of(result))].get(name)
    units = str(result[name].attrs.get("units", label.units if label else "1"))
    told = None if dof is None else dof_unit(result, dof)
    return unit_of(units, told) if told else units


def dof_unit(result: xr.Dataset, dof: int) -> str:
    """Say what a degree of freedom is measured in, m or rad; nothing where the result does not."""
    return str(np.ravel(result.dof_unit.values)[dof]) if "dof_unit" in result.coords else ""


def _dims_of(result: xr.Dataset, name: str) -> tuple[str, ...]:
    """Dimensions that a variable has in a whole result, behind the first: those of a part may be one of each."""
    label = SCHEMAS[str(kind_of(result))].get(name)
    return label.dims[1:] if label else ()


def _place(result: xr.Dataset, dim: str, number: int) -> Place:
    """Name contacts and degrees of freedom by names, points and loads by positions, those alike by numbers."""
    if dim not in result.coords:
        return Place(dim, number, f"{dim} {number}")
    values = np.ravel(result[dim].values).tolist()
    if dim in ("contact", "source"):
        # Of a part, as it is numbered in the whole.
        names = _contact_names(result)
        said = names.get(values[number], "")
        alone = list(names.values()).count(said) == 1
        return Place(dim, int(values[number]), said if said and alone else f"contact {values[number]}")
    if values.count(values[number]) > 1:
        return Place(dim, number, f"{dim} {number}")
    if result[dim].attrs.get("units") == "m":
        return Place(dim, number, f"at {values[number]:.12g} m")
    return Place(dim, number, f"{'' if dim == 'dof' else f'{dim} '}{values[number]}")


def _contact_names(result: xr.Dataset) -> dict[int, str]:
    """Names of contacts by their numbers; none where they have none."""
    if not {"contact", "contact_name"} <= result.coords.keys():
        return {}
    return dict(zip(np.ravel(result.contact.values).tolist(), np.ravel(result.contact_name.values), strict=False))

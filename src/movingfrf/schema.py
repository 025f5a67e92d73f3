"""What a result is called and measured in: the one place where arrays get labels."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

if TYPE_CHECKING:
    import xarray as xr


class Label(NamedTuple):
    """Dimensions, unit and long name of a variable; a coordinate has no meaning of its own."""

    dims: tuple[str, ...]
    units: str
    long_name: str
    coordinate: bool = False


_TIME = Label(("time",), "s", "time", coordinate=True)

# The response of a vehicle and a guideway to a rough road.
COUPLED: dict[str, Label] = {
    "time": _TIME,
    "contact": Label(("contact",), "1", "number of the contact", coordinate=True),
    "position": Label(("contact",), "m", "position of the contact, ahead positive", coordinate=True),
    "path": Label(("contact",), "1", "path of the profile that the contact follows", coordinate=True),
    "dof": Label(("dof",), "1", "degree of freedom", coordinate=True),
    "dof_unit": Label(("dof",), "1", "unit of the degree of freedom", coordinate=True),
    "contact_force": Label(("time", "contact"), "N", "dynamic contact force, compression positive"),
    "static_load": Label(("contact",), "N", "contact force in steady travel on the smooth road"),
    "deflection": Label(("time", "contact"), "m", "deflection of the guideway under the contact, down"),
    "static_deflection": Label(("contact",), "m", "deflection in steady travel on the smooth road, down"),
    "motion": Label(("time", "dof"), "m or rad", "motion about the steady state, down, nose down"),
    "acceleration": Label(("time", "dof"), "m/s2 or rad/s2", "acceleration, down, nose down"),
    "roughness": Label(("time", "contact"), "m", "elevation of the road under the contact, up"),
    # Points of a finite road that stand still, where they were asked for.
    "place": Label(("place",), "m", "position of a point of the road", coordinate=True),
    "place_deflection": Label(("time", "place"), "m", "deflection of the road at that point, down"),
}

# The response of a guideway to prescribed forces.
LOADED: dict[str, Label] = {
    "time": _TIME,
    "load": Label(("load",), "m", "position of the load, ahead positive", coordinate=True),
    "point": Label(("point",), "m", "position of the observer, ahead positive", coordinate=True),
    "force": Label(("time", "load"), "N", "prescribed force, down"),
    "deflection": Label(("time", "point"), "m", "deflection of the guideway at the observer, down"),
}


def labelled(
    values: Mapping[str, ArrayLike], schema: Mapping[str, Label], attributes: Mapping[str, str | float | int]
) -> xr.Dataset:
    """Make the Dataset of a result.

    Parameters
    ----------
    values : mapping of str to array_like
        Arrays by their name in the schema.
    schema : mapping of str to Label
        `COUPLED` or `LOADED`.
    attributes : mapping of str to str, float or int
        Attributes of the Dataset, text or numbers only: nothing else survives netCDF.

    Returns
    -------
    xarray.Dataset
        With units and long names on every variable.
    """
    import xarray as xr

    data: dict[str, xr.Variable] = {}
    coordinates: dict[str, xr.Variable] = {}
    for name, value in values.items():
        dims, units, long_name, is_coordinate = schema[name]
        variable = xr.Variable(dims, np.asarray(value), {"units": units, "long_name": long_name})
        (coordinates if is_coordinate else data)[name] = variable
    return xr.Dataset(data, coordinates, dict(attributes))

"""Universal files of modal analysis (UFF), .uff: a dataset 58 for each history or spectrum, through pyuff."""

from __future__ import annotations

import textwrap
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from movingfrf._basics.undoing import scratch
from movingfrf._basics.version import VERSION
from movingfrf.results.exports.base import Column, Place, axis_of, columns, dof_unit, units_of
from movingfrf.results.labels import kind_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    import xarray as xr


@dataclass(frozen=True, slots=True, kw_only=True)
class Dataset58:
    """Numbers by which dataset 58 calls things: standardised, no tuning."""

    # Functions by kind of result; all others are histories.
    history: int
    functions: Mapping[str, int]
    # Data: along the axes, of the variables, and of what they are per unit of, by kind of result; unknown is 0.
    axes: Mapping[str, int]
    data: Mapping[str, int]
    per: Mapping[str, int]
    # Directions: z points up, as roughness does; all else counts downwards. A rotation does not say its axis.
    up: int
    down: int
    scalar: int
    # Nodes are numbered by what they are, so that no two places have one [a convention].
    first_node: Mapping[str, int]
    other_nodes: int
    letters: int  # of an entity's name
    label: int  # letters of an axis's name


DATASET_58 = Dataset58(
    history=1,
    functions={"transfer": 4, "receptance": 4, "mobility": 4, "accelerance": 4, "random": 9},
    axes={"time": 17, "frequency": 18},
    data={
        "contact_force": 9,
        "force": 13,
        "deflection": 8,
        "place_deflection": 8,
        "motion": 8,
        "roughness": 8,
        "receptance": 8,
        "mobility": 11,
        "acceleration": 12,
        "accelerance": 12,
    },
    per={"transfer": 8, "receptance": 13, "mobility": 13, "accelerance": 13},
    up=3,
    down=-3,
    scalar=0,
    first_node={"contact": 1, "source": 1, "dof": 1001, "load": 2001, "point": 3001, "place": 4001, "ahead": 5001},
    other_nodes=6001,
    letters=10,
    label=20,
)


def made(result: xr.Dataset) -> bytes:
    """Write every column in ASCII with twelve digits; the format rounds the step to six.

    Numbers of nodes: contacts from 1, degrees of freedom from 1001, loads from 2001, points that travel along from
    3001, places of the road from 4001, offsets of a receptance from 5001.
    """
    try:
        import pyuff
    except ModuleNotFoundError:
        raise ValueError("universal files need pyuff: pip install pyuff, or the extra `io`") from None
    x = result[axis_of(result)].values
    if x.size < 2:
        raise ValueError(f"a universal file needs at least two points of {axis_of(result)}, got {x.size}")
    with scratch() as folder:
        file = folder / "result.uff"
        try:
            pyuff.UFF(str(file)).write_sets([_set(result, x, column) for column in columns(result)], "overwrite")
        except Exception as error:
            # A full disk or an interrupt stands behind an exception of pyuff's own, which does not say so.
            raise (error.__context__ or error) from None
        return file.read_bytes()


def _set(result: xr.Dataset, x: np.ndarray[Any, Any], column: Column) -> dict[str, Any]:
    """One dataset 58."""
    form, axis, kind = DATASET_58, axis_of(result), str(kind_of(result))
    upwards = column.variable.startswith("roughness")
    nowhere = Place("", 0, "NONE")
    reference = next((place for place in column.places if place.dim == "source"), nowhere)
    response = next((place for place in column.places if place.dim != "source"), nowhere)
    turns = response.dim == "dof" and dof_unit(result, response.number) == "rad"
    return {
        "type": 58,
        "binary": 0,
        "id1": column.name[:80],
        "id2": str(result.attrs.get("title", "NONE"))[:80],
        "id4": f"movingfrf {VERSION}",
        "func_type": form.functions.get(kind, form.history),
        "rsp_ent_name": response.name[: form.letters],
        "rsp_node": _node(response),
        "rsp_dir": form.scalar if turns else form.up if upwards else form.down,
        "ref_ent_name": reference.name[: form.letters],
        "ref_node": _node(reference),
        "ref_dir": form.up if reference.dim else form.scalar,
        "abscissa_spacing": int(np.ptp(np.diff(x)) <= 1e-6 * (x[1] - x[0])),
        "abscissa_spec_data_type": form.axes[axis],
        "abscissa_axis_lab": axis,
        "abscissa_axis_units_lab": units_of(result, axis),
        "ordinate_spec_data_type": form.data.get(column.variable.removesuffix("_density"), 0),
        "ordinate_axis_lab": _label(column.variable),
        "ordinate_axis_units_lab": column.units[:20],
        "orddenom_spec_data_type": form.per.get(kind, 0),
        "z_axis_spec_data_type": 0,
        "x": x,
        "data": column.values,
    }


def _label(variable: str) -> str:
    """Name a variable in as many whole words as the format has room for."""
    words = variable.replace("_density", "_PSD").replace("_", " ")
    return textwrap.shorten(words, DATASET_58.label, placeholder="") or words[: DATASET_58.label]


def _node(place: Place) -> int:
    """Give a place its number; 0 is none."""
    return DATASET_58.first_node.get(place.dim, DATASET_58.other_nodes) + place.number if place.dim else 0

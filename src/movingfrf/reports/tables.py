"""Tables for reading, of a page and of a console alike."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from movingfrf._basics import wording
from movingfrf._basics.wording import is_never, number
from movingfrf.reports.curves import contact_curves, readable
from movingfrf.results.labels import Measure

if TYPE_CHECKING:
    import xarray as xr


# Units in which numbers are read → what they are called, and how many make an SI unit.
SCALES = {"N": ("kN", 1e-3), "m": ("mm", 1e3), "1": ("", 1.0)}


class Setting(NamedTuple):
    """One line of the head: what was set, to which value, and what to know about it."""

    name: str
    value: str
    note: str = ""
    wide: bool = False


class Column(NamedTuple):
    """Head of a column, and whether words stand below it rather than numbers."""

    name: str
    units: str
    words: bool = False


class Row(NamedTuple):
    """One row of a table, with the colour of its curves; without cells the heading of the rows below it."""

    name: str
    cells: list[str]
    colour: str = ""


class Table(NamedTuple):
    """A table for reading."""

    caption: str
    corner: str
    columns: list[Column]
    rows: list[Row]


def measure_tables(result: xr.Dataset, found: Sequence[Measure], captions: Mapping[str, str]) -> list[Table]:
    """Put measures into tables: one for each kind of quantity, and rotations apart from translations.

    Parameters
    ----------
    result : xarray.Dataset
        A response with contacts and degrees of freedom.
    found : sequence of Measure
        Its measures.
    captions : mapping of str to str
        Caption by the kind of quantity: the last word of its name, with `angular` before it for a rotation.

    Returns
    -------
    list of Table
        In the order of the measures.
    """
    drawn = set(wording.evenly_spread(result.sizes["contact"]))
    contacts = {f"contact {c.column}": c for c in contact_curves(result, range(result.sizes["contact"]))}
    rows: dict[tuple[str, str], list[Measure]] = {}
    for measure in found:
        place, _, kind = measure.quantity.rpartition(" ")
        rows.setdefault((kind, place), []).append(measure)
    tables: dict[tuple[str, tuple[Column, ...]], Table] = {}
    for (kind, place), measures in rows.items():
        columns = tuple(Column(m.name, SCALES.get(m.units, (m.units, 1.0))[0]) for m in measures)
        kind = f"angular {kind}" if measures[0].units.startswith("rad") else kind
        curve = contacts.get(place)
        corner = "contact" if curve else "degree of freedom"
        table = tables.setdefault((kind, columns), Table(captions[kind], corner, list(columns), []))
        colour = curve.colour if curve and curve.column in drawn else ""
        table.rows.append(Row(curve.name if curve else readable(place), [*map(_cell, measures)], colour))
    return list(tables.values())


def _cell(measure: Measure) -> str:
    if np.isnan(measure.value):
        return "–"
    if is_never(measure.value, measure.units):
        return "< 10⁻¹²"
    return number(SCALES.get(measure.units, ("", 1.0))[1] * measure.value)

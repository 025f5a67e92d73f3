"""A table for spreadsheets: one column for each history or spectrum, .csv."""

from __future__ import annotations

import csv
import io
from typing import TYPE_CHECKING

import numpy as np

from movingfrf.results.exports.base import axis_of, columns, units_of
from movingfrf.results.labels import kind_of

if TYPE_CHECKING:
    import xarray as xr


def made(result: xr.Dataset) -> bytes:
    """Write a line a time or frequency under heads with units, each number with all its digits."""
    axis = axis_of(result)
    table = [(f"{axis} [{units_of(result, axis)}]", result[axis].values)]
    if kind_of(result) == "coupled" and {"start", "speed"} <= result.attrs.keys():
        table.append(("distance [m]", result.attrs["start"] + result.attrs["speed"] * result[axis].values))
    for column in columns(result):
        if np.iscomplexobj(column.values):
            table.append((f"{column.name} (real) [{column.units}]", column.values.real))
            table.append((f"{column.name} (imaginary) [{column.units}]", column.values.imag))
        else:
            table.append((f"{column.name} [{column.units}]", column.values))
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow([head for head, _ in table])
    rows.writerows(zip(*(values.tolist() for _, values in table), strict=True))
    return text.getvalue().encode()

"""A table for spreadsheets: one column for each history or spectrum, .csv."""

from __future__ import annotations

import csv
import io
from typing import TYPE_CHECKING

import numpy as np

from movingfrf.results.exports.base import axis_of, columns
from movingfrf.results.labels import SCHEMAS, kind_of

if TYPE_CHECKING:
    import xarray as xr


def made(result: xr.Dataset) -> bytes:
    """Write a line a time or frequency under heads with units, each number with all its digits."""
    axis = axis_of(result)
    table = {f"{axis} [{SCHEMAS[str(kind_of(result))][axis].units}]": result[axis].values}
    for column in columns(result):
        if np.iscomplexobj(column.values):
            table[f"{column.name} (real) [{column.units}]"] = column.values.real
            table[f"{column.name} (imaginary) [{column.units}]"] = column.values.imag
        else:
            table[f"{column.name} [{column.units}]"] = column.values
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(table)
    rows.writerows(zip(*(values.tolist() for values in table.values()), strict=True))
    return text.getvalue().encode()

"""Axes of a sweep, their values, and where cases stand on them, in words."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.wording import number
from movingfrf.reports.curves import readable
from movingfrf.studies.sweep.page.choice import DRAWN

if TYPE_CHECKING:
    import xarray as xr


def keys_of(table: xr.Dataset) -> list[str]:
    """Name the coordinates that are keys of the scenario."""
    dims = set(table.status.dims)
    return [
        str(name)
        for name in table.coords
        if name != "sample" and table[name].dims and set(table[name].dims) <= dims
    ]


def said(table: xr.Dataset, name: str, value: Any, digits: int = 6) -> str:
    """Write a value of a key with its unit: six digits are more than any drawn one means."""
    if table[name].dtype.kind not in "iuf":
        return str(value)
    return f"{short(float(value), digits)} {unit_of(table, name)}".strip()


def short(value: float, digits: int) -> str:
    """Write a number without trailing zeros, millions as powers of ten.

    Examples
    --------
    >>> short(21.35, 6), short(4.2e6, 6), short(3832430.0, 4)
    ('21.35', '4.2 × 10⁶', '3.832 × 10⁶')
    """
    mantissa, times, power = number(value, digits).partition(" × ")
    if not times and abs(value) >= 1e6:  # more digits than a power of ten would take
        mantissa, times, power = number(value / 1e6, digits), " × ", "10⁶"
    return (mantissa.rstrip("0").rstrip(".") if "." in mantissa else mantissa) + times + power


def key_in_words(name: str) -> str:
    """Write the name of a key as words; its unit stands behind its values.

    Examples
    --------
    >>> key_in_words("speed_kmh"), key_in_words("tyre_stiffness")
    ('speed', 'tyre stiffness')
    """
    return readable(name.removesuffix("_kmh"))


def unit_of(table: xr.Dataset, name: str) -> str:
    """Give the unit of a key; empty if it has none."""
    unit = str(table[name].attrs.get("units", "1"))
    return "" if unit == "1" else unit


def case_in_words(table: xr.Dataset, case: Sequence[int]) -> str:
    """Say at which values of the keys a case stands; of those alone that vary."""
    places = dict(zip(map(str, table.status.dims), case, strict=True))
    keys = keys_of(table) if "design" in table.attrs else list(places)
    told, digits = [], 4 if "design" in table.attrs else 6
    for key in keys:
        (dim,) = table[key].dims
        if table.sizes[dim] > 1:
            told.append(f"{key_in_words(key)} {said(table, key, table[key].values[places[str(dim)]], digits)}")
    return ", ".join(told)


def places_of(table: xr.Dataset, dim: str) -> FloatArray:
    """Say where the values of an axis stand: the values, or their numbers where they are none."""
    values = table[dim].values
    return values.astype(float) if values.dtype.kind in "iuf" else np.arange(values.size, dtype=float)


def names_of(table: xr.Dataset, dim: str) -> list[str]:
    """Name the values of an axis, each with its unit; of long names the end, by which files differ."""
    return [shortened(said(table, dim, value)) for value in table[dim].values]


def shortened(name: str) -> str:
    """Leave out the beginning of a long name."""
    return name if len(name) <= DRAWN.name_letters else f"…{name[1 - DRAWN.name_letters :]}"


def between(value: float, places: FloatArray, unit: str) -> str:
    """Write a place between others: a hundredth of their span, or a little less, is told.

    Examples
    --------
    >>> between(21.3456, np.array([5.0, 35.0]), "m/s"), between(1004.5678, np.array([1000.0, 1010.0]), "")
    ('21.3 m/s', '1004.6')
    """
    span = float(np.ptp(places))
    decimals = 2 - math.floor(math.log10(span)) if span else 6
    return f"{short(round(value, decimals), 12)} {unit}".strip()

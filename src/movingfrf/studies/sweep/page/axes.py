"""Axes of a figure whose places are values of a key."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from movingfrf._basics.wording import raised
from movingfrf.studies.sweep.page.words import key_in_words, short, unit_of

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axis import Axis


def name_axis(axis: Axis, table: xr.Dataset, key: str, most: int = 9) -> None:
    """Name an axis after a key, with its unit; a power of ten stands there once.

    Parameters
    ----------
    axis : matplotlib.axis.Axis
        The axis.
    table : xarray.Dataset
        What `sweep` returned.
    key : str
        Name of a numeric coordinate.
    most : int
        Numbers that it has room for.
    """
    from matplotlib.ticker import FuncFormatter, MaxNLocator

    power = power_of(table[key].values.astype(float))
    unit = f"10{raised(str(power))} {unit_of(table, key)}".strip() if power else unit_of(table, key)
    axis.set_label_text(f"{key_in_words(key)} [{unit}]" if unit else key_in_words(key))
    axis.set_major_locator(MaxNLocator(most, steps=[1, 2, 2.5, 5, 10]))
    axis.set_major_formatter(FuncFormatter(lambda value, _: short(value / 10.0**power, 6)))


def power_of(values: np.ndarray) -> int:
    """Choose a power of ten, a multiple of three, for values that are read badly without.

    Examples
    --------
    >>> power_of(np.array([2e6, 5e6])), power_of(np.array([5.0, 35.0])), power_of(np.array([0.001, 0.004]))
    (6, 0, -3)
    """
    largest = float(np.abs(values).max())
    return 0 if not largest or 0.01 <= largest < 1e4 else 3 * math.floor(math.log10(largest) / 3 + 1e-9)

"""How far each axis moves the mean of a measure."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from movingfrf._basics.wording import number
from movingfrf.reports.curves import PALETTE
from movingfrf.reports.figures import Illustration
from movingfrf.studies.sweep.page.seen import Seen
from movingfrf.studies.sweep.page.tornado import Panel, tornado
from movingfrf.studies.sweep.page.words import key_in_words

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes


class Reach(NamedTuple):
    """Between what the mean of a measure lies as one axis is gone along."""

    axis: str
    low: float
    high: float


def reaches(table: xr.Dataset, seen: Seen) -> list[Reach]:
    """Find how far each axis moves the mean over all others.

    Of the lines along an axis only those are taken of which every case has an answer, lest what is missing be taken
    for what the axis does.

    Parameters
    ----------
    table : xarray.Dataset
        What `sweep` returned.
    seen : Seen
        The measure.

    Returns
    -------
    list of Reach
        From the axis that moves it most on.
    """
    found = []
    for place, dim in enumerate(map(str, table.status.dims)):
        lines = np.moveaxis(seen.worst, place, 0).reshape(table.sizes[dim], -1)
        lines = lines[:, np.isfinite(lines).all(axis=0)]
        if len(lines) > 1 and lines.size:
            means = lines.mean(axis=1)
            found.append(Reach(dim, float(means.min()), float(means.max())))
    return sorted(found, key=lambda one: one.low - one.high)


def illustration(table: xr.Dataset, each: Sequence[Seen]) -> Illustration | None:
    """Draw how far axes move each measure; None of a design, or where at most one axis varies."""
    if "design" in table.attrs or sum(table.sizes[dim] > 1 for dim in table.status.dims) < 2:
        return None
    told = [(seen, found) for seen in each if (found := reaches(table, seen))]
    if not told:
        return None
    return tornado(
        "What does each measure depend on?",
        _caption(told),
        [Panel(seen.label, [one.axis for one in found], partial(_draw, told=found)) for seen, found in told],
    )


def _caption(told: list[tuple[Seen, list[Reach]]]) -> str:
    """Say what moves each measure most."""

    def span(seen: Seen, one: Reach) -> str:
        return f"{seen.called}: {key_in_words(one.axis)}, {number(one.low)} to {seen.written(one.high)}"

    most = "; ".join(span(seen, found[0]) for seen, found in told)
    return (
        f"What matters most – {most}. Each bar goes from the smallest to the largest mean along an axis, over all "
        "values of the others; what two axes do only together does not show."
    )


def _draw(ax: Axes, told: list[Reach]) -> None:
    lows, widths = [one.low for one in told], [one.high - one.low for one in told]
    ax.barh(np.arange(len(told)), widths, left=lows, height=0.5, color=PALETTE[0])
    ax.ticklabel_format(axis="x", useOffset=False)

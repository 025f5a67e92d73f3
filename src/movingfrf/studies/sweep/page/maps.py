"""A map over two numeric axes, with the line along which the limit is passed."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.wording import evenly_spread
from movingfrf.reports.axes import legend_above
from movingfrf.reports.curves import GREY, PALETTE
from movingfrf.reports.figures import SIZE, blank
from movingfrf.studies.sweep.page.answers import Axis, beyond, counted, passes, where, worst
from movingfrf.studies.sweep.page.axes import name_axis
from movingfrf.studies.sweep.page.choice import DRAWN, laid_out
from movingfrf.studies.sweep.page.kind import View
from movingfrf.studies.sweep.page.lines import what_is_taken
from movingfrf.studies.sweep.page.words import key_in_words, places_of, said, unit_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def field(view: View) -> FloatArray:
    """Take the measure over both axes: the worst contact, the mean over the roads.

    Returns
    -------
    ndarray, shape (along, across)
    """
    dims = [str(dim) for dim in view.table.status.dims]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        found: FloatArray = np.nanmean(laid_out(view.seen.worst, dims, view.layout, below=view.seen.below), axis=2)
    return found


def answer(view: View) -> str:
    """Say in how many cases the limit is passed, where at both ends of the other axis, and where it is worst."""
    table, seen, chosen = view
    told = worst(table, seen)
    if seen.limit is None:
        return told
    if not seen.beyond(seen.worst).any():
        return f"{passes(seen, never=True)}. {told}"
    along, across = (places_of(table, dim) for dim in (chosen.along, chosen.across))
    axis = Axis(key_in_words(chosen.along), along, unit_of(table, chosen.along))
    values = field(view)
    mean = " in the mean over the roads" if chosen.seeds else ""
    ends = [
        f"at {key_in_words(chosen.across)} {said(table, chosen.across, across[end])} {where(found, axis)}"
        for end in (int(across.argmin()), int(across.argmax()))
        for found in [beyond(along, values[:, end], seen.limit.value, below=seen.below)]
    ]
    return f"{passes(seen)} {counted(seen)};{mean} {', '.join(ends)}. {told}"


def drawn(view: View) -> str:
    """Say what colours and lines are."""
    words = what_is_taken(view)
    if view.layout.seeds:
        words.append("Colours: means over the roads.")
    if _crossed(view):
        words.append("The thick line is the limit, between solved cases as they are joined by straight lines.")
    if not np.isfinite(field(view)).all():
        words.append("Hatched: no answer.")
    sizes = [view.table.sizes[dim] for dim in (view.layout.along, view.layout.across)]
    if max(sizes) > DRAWN.map_most:
        words.append(f"Of each axis {DRAWN.map_most} values are drawn at most.")
    return " ".join(words)


def _crossed(view: View) -> bool:
    """Say whether the limit lies between values of the map."""
    values, limit = field(view), view.seen.limit
    return limit is not None and bool(np.nanmin(values) < limit.value < np.nanmax(values))


def figure(view: View) -> Figure:
    """Draw filled contours, lines with their values, and the limit."""
    from matplotlib.ticker import MaxNLocator

    table, seen, chosen = view
    made = blank(SIZE.single + 1.2)
    ax, bar = made.subplots(1, 2, width_ratios=(30, 1), squeeze=False)[0]
    (x, some), (y, others) = (_order(places_of(table, dim)) for dim in (chosen.along, chosen.across))
    values = field(view)[np.ix_(some, others)].T
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    # What is the same but for rounding has no lines.
    even = high - low <= 1e-9 * max(abs(low), abs(high))
    levels = [low - 1.0, low + 1.0] if even else MaxNLocator(9).tick_values(low, high)
    ax.patch.set(facecolor="#eeeeee", hatch="////", edgecolor="#bbbbbb")
    filled = ax.contourf(x, y, values, levels=levels, cmap="cividis")
    if not even:
        lines = ax.contour(x, y, values, levels=levels, colors="white", linewidths=0.6)
        for text in ax.clabel(lines, levels[1::2], inline=False, fontsize=8.0, fmt=written, colors="#222222"):
            text.set_rotation(0.0)
            text.set_bbox({"facecolor": "white", "alpha": 0.75, "edgecolor": "none", "pad": 0.8})
    if seen.limit and _crossed(view):
        ax.contour(x, y, values, levels=[seen.limit.value], colors="white", linewidths=4.5)
        ax.contour(x, y, values, levels=[seen.limit.value], colors=PALETTE[1], linewidths=2.5)
        ax.plot([], [], color=PALETTE[1], linewidth=2.5, label=f"limit {seen.limit.said}")
    ax.grid(visible=False)
    name_axis(ax.xaxis, table, chosen.along)
    name_axis(ax.yaxis, table, chosen.across)
    ax.spines[["top", "right"]].set(visible=True, color=GREY)
    made.colorbar(filled, cax=bar)
    bar.yaxis.tick_left()
    bar.yaxis.set_label_position("left")
    bar.set_ylabel(seen.label)
    bar.grid(visible=False)
    legend_above(ax)
    return made


def written(value: float) -> str:
    """Write the value of a line."""
    return f"{value:.6g}".replace("-", "−")


def _order(places: FloatArray) -> tuple[FloatArray, list[int]]:
    """Put places in ascending order, as many as a map bears; with their numbers."""
    order = np.argsort(places, kind="stable")
    some = order[evenly_spread(len(places), DRAWN.map_most)]
    return places[some], some.tolist()

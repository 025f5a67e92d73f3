"""Curves along a numeric axis: of each contact, or of each value of another axis; over seeds a band."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.wording import evenly_spread
from movingfrf.reports.axes import decimated, legend_above
from movingfrf.reports.curves import GREY, PALETTE
from movingfrf.reports.figures import SIZE, blank
from movingfrf.studies.sweep.page.answers import Axis, Stretch, beyond, passes, share, where, worst
from movingfrf.studies.sweep.page.axes import name_axis
from movingfrf.studies.sweep.page.choice import DRAWN
from movingfrf.studies.sweep.page.kind import View
from movingfrf.studies.sweep.page.lines import Line, lines_of, what_is_taken
from movingfrf.studies.sweep.page.words import key_in_words, places_of, said, unit_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def stretches_of(view: View) -> list[list[Stretch]]:
    """Find where each curve, or its mean over the roads, lies beyond the limit."""
    limit, places = view.seen.limit, places_of(view.table, view.layout.along)
    assert limit
    return [beyond(places, line.mean, limit.value, below=view.seen.below) for line in lines_of(view)]


def answer(view: View) -> str:
    """Say where the limit is passed, and where it is worst."""
    told = worst(view.table, view.seen)
    return told if view.seen.limit is None else f"{_passing(view)} {told}"


def _passing(view: View) -> str:
    """Say where the curves pass the limit."""
    table, seen, chosen = view
    lines, found = lines_of(view), stretches_of(view)
    places = places_of(table, chosen.along)
    axis = Axis(key_in_words(chosen.along), places, unit_of(table, chosen.along))
    mean = " in the mean over the roads" if chosen.seeds else ""
    if not any(found):
        words = f"{passes(seen, never=True)}{mean}."
    elif len(lines) == 1:
        words = f"{passes(seen)}{mean} {where(found[0], axis)}."
    else:
        over = [(line.label, where(each, axis)) for line, each in zip(lines, found, strict=True) if each]
        told = [f"{label}: {stretch}" for label, stretch in over[: len(PALETTE)]]
        never = len(lines) - len(over)
        told += [f"{len(over) - len(told)} more curves"] if len(over) > len(told) else []
        told += ["nowhere else"] if never else []
        words = f"{passes(seen)}{mean} – {'; '.join(told)}."
    if chosen.seeds:
        words += f" {_roads(view, lines)}"
    return words


def _roads(view: View, lines: list[Line]) -> str:
    """Say on how many roads the limit is passed, where most do."""
    seen, chosen = view.seen, view.layout
    each = np.stack([line.values for line in lines])  # (line, along, seed)
    over, there = seen.beyond(each).sum(axis=2), np.isfinite(each).sum(axis=2)
    if not over.any():
        return "Not a single road does."
    with np.errstate(invalid="ignore", divide="ignore"):
        line, place = np.unravel_index(int(np.nanargmax(over / there)), over.shape)
    at = f"{key_in_words(chosen.along)} {said(view.table, chosen.along, view.table[chosen.along].values[place])}"
    label = f"{lines[line].label}, " if lines[line].label else ""
    return f"At {label}{at} most roads do: {share(int(over[line, place]), int(there[line, place]), 'roads')}."


def drawn(view: View) -> str:
    """Say what curves and bands are."""
    table, seen, chosen = view
    lines = lines_of(view)
    words = what_is_taken(view)
    if len(lines) > len(PALETTE):
        words.append(f"{len(PALETTE)} of {len(lines)} curves are drawn.")
    if chosen.seeds:
        words.append("Lines are means over the roads, bands from their 5th to their 95th percentile.")
        if len(lines) == 1:
            words[-1] = "Line: mean over the roads; dashed: median; band: from their 5th to their 95th percentile."
    ends = {*places_of(table, chosen.along).tolist()}
    if seen.limit and any(end not in ends for line in stretches_of(view) for each in line for end in each):
        words.append("Where the limit is crossed is read off straight lines between solved cases.")
    return " ".join(words)


def figure(view: View) -> Figure:
    """Draw the curves, the limit, and where it is crossed."""
    table, seen, chosen = view
    places = places_of(table, chosen.along)
    lines = lines_of(view)
    made = blank(SIZE.single + 0.4)
    (ax,) = made.subplots(1, 1, squeeze=False)[0]
    some = evenly_spread(len(lines), len(PALETTE))
    for colour, number in zip(PALETTE, some, strict=False):
        _draw(ax, places, lines[number], colour, alone=len(lines) == 1)
    if seen.limit:
        ax.axhline(seen.limit.value, color=GREY, linestyle=":", linewidth=1.4, label=f"limit {seen.limit.said}")
        found = stretches_of(view)
        for colour, number in zip(PALETTE, some, strict=False):
            if len(found[number]) <= DRAWN.stretches:
                ends = [end for each in found[number] for end in each if places.min() < end < places.max()]
                ax.plot(ends, [seen.limit.value] * len(ends), "|", color=colour, markersize=14, markeredgewidth=2)
    name_axis(ax.xaxis, table, chosen.along)
    ax.set_ylabel(seen.label)
    ax.ticklabel_format(axis="y", useOffset=False)
    legend_above(ax)
    return made


def _draw(ax: Axes, places: FloatArray, line: Line, colour: str, *, alone: bool) -> None:
    """Draw the mean over the roads, and between what these lie."""
    order = np.argsort(places, kind="stable")
    x, y = places[order], line.mean[order]
    several = line.values.shape[1] > 1
    label = line.label or ("mean" if several else None)
    dots = "o" if len(places) <= DRAWN.names else None
    there = np.isfinite(y)
    if not there.any():
        return
    # Holes stay holes where nothing has to be thinned out.
    thin = decimated(x[there], y[there], buckets=DRAWN.curve_points) if len(x) > 2 * DRAWN.curve_points else (x, y)
    ax.plot(*thin, color=colour, label=label, marker=dots, markersize=4.0, linewidth=1.4)
    if not several:
        return
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        low, middle, high = np.nanpercentile(line.values[order], [5.0, 50.0, 95.0], axis=1)
    some = evenly_spread(len(x), 2 * DRAWN.curve_points)
    ax.fill_between(x[some], low[some], high[some], color=colour, alpha=0.18, linewidth=0)
    if alone:
        ax.plot(x[some], middle[some], color=colour, linestyle="--", linewidth=1.0, label="median")

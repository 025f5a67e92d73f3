"""Dots for each value of a text axis, and, where these are many, all of them by rank."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.wording import evenly_spread
from movingfrf.reports.axes import legend_above
from movingfrf.reports.curves import GREY, PALETTE
from movingfrf.reports.figures import SIZE, blank
from movingfrf.studies.sweep.page.answers import passes, worst
from movingfrf.studies.sweep.page.choice import DRAWN
from movingfrf.studies.sweep.page.kind import View
from movingfrf.studies.sweep.page.lines import Line, lines_of, what_is_taken
from movingfrf.studies.sweep.page.words import key_in_words, names_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def worst_first(view: View) -> list[int]:
    """Order the values of the axis from the worst one on, by their numbers; those without an answer come last."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        means = np.stack([line.mean for line in lines_of(view)])
        each = np.nanmin(means, axis=0) if view.seen.below else -np.nanmax(means, axis=0)
    return np.argsort(each, kind="stable").tolist()


def answer(view: View) -> str:
    """Say for which values the limit is passed, which are the worst, and where it is worst of all."""
    table, seen, chosen = view
    names = names_of(table, chosen.along)
    lines = lines_of(view)
    told = worst(table, seen)
    if len(names) > DRAWN.names:
        told = f"The worst: {', '.join(names[number] for number in worst_first(view)[:3])}. {told}"
    if seen.limit is None:
        return told
    over = np.stack([seen.beyond(line.mean) for line in lines])  # (curve, value)
    if not over.any():
        return f"{passes(seen, never=True)}. {told}"
    mean = " in the mean over the roads" if chosen.seeds else ""
    if chosen.across:
        counts = [
            f"{line.label}: {int(each.sum())} of {int(np.isfinite(line.mean).sum())}"
            for line, each in zip(lines, over, strict=True)
            if each.any()
        ]
        counts[0] += f" values of {key_in_words(chosen.along)}"
        more = f"; {len(counts) - len(PALETTE)} more" if len(counts) > len(PALETTE) else ""
        said = f"– {'; '.join(counts[: len(PALETTE)])}{more}"
    else:
        found = [names[number] for number in worst_first(view) if over[:, number].any()]
        listed = f": {', '.join(found)}" if len(found) <= len(PALETTE) else ""
        said = f"for {len(found)} of {len(names)} values of {key_in_words(chosen.along)}{listed}"
    return f"{passes(seen)}{mean} {said}. {told}"


def drawn(view: View) -> str:
    """Say what dots are, or ranks."""
    words = what_is_taken(view)
    lines = lines_of(view)
    if len(lines) > len(PALETTE):
        words.append(f"{len(PALETTE)} of {len(lines)} values of {key_in_words(view.layout.across)} are drawn.")
    if view.layout.seeds:
        words.append(
            "Means over the roads" + ("." if _ranked(view) else ", bars from their 5th to 95th percentile.")
        )
    if _ranked(view):
        words.append(f"Each curve has its own order of {key_in_words(view.layout.along)}; table.csv has the names.")
    return " ".join(words)


def _ranked(view: View) -> bool:
    return view.layout.kind == "ranks"


def figure(view: View) -> Figure:
    """Draw a row of dots for each value, or a curve from the worst value to the best."""
    return _ranks(view) if _ranked(view) else _rows(view)


def _drawn_lines(view: View) -> list[tuple[str, Line]]:
    lines = lines_of(view)
    some = evenly_spread(len(lines), len(PALETTE))
    return [(colour, lines[number]) for colour, number in zip(PALETTE, some, strict=False)]


def _rows(view: View) -> Figure:
    table, seen, chosen = view
    names = names_of(table, chosen.along)
    lines = _drawn_lines(view)
    made = blank(1.1 + 0.42 * len(names) + 0.22 * bool(len(lines) > 1))
    (ax,) = made.subplots(1, 1, squeeze=False)[0]
    for number, (colour, line) in enumerate(lines):
        # Beside each other, so that none hides another.
        rows = np.arange(len(names)) + 0.12 * (number - 0.5 * (len(lines) - 1))
        if line.values.shape[1] > 1:
            low, high = _band(line.values)
            ax.hlines(rows, low, high, color=colour, alpha=0.35, linewidth=3.0)
        ax.plot(line.mean, rows, "o", color=colour, markersize=5.0, label=line.label or None)
    if seen.limit:
        ax.axvline(seen.limit.value, color=GREY, linestyle=":", linewidth=1.4, label=f"limit {seen.limit.said}")
    ax.set_yticks(np.arange(len(names)), names)
    ax.set(ylim=(len(names) - 0.5, -0.5), xlabel=seen.label)
    ax.ticklabel_format(axis="x", useOffset=False)
    legend_above(ax)
    return made


def _ranks(view: View) -> Figure:
    seen, chosen = view.seen, view.layout
    made = blank(SIZE.single + 0.4)
    (ax,) = made.subplots(1, 1, squeeze=False)[0]
    for colour, line in _drawn_lines(view):
        values = np.sort(line.mean[np.isfinite(line.mean)])
        values = values if seen.below else values[::-1]
        some = evenly_spread(values.size, 2 * DRAWN.curve_points)
        ax.plot(np.array(some) + 1, values[some], color=colour, label=line.label or None, linewidth=1.4)
    if seen.limit:
        ax.axhline(seen.limit.value, color=GREY, linestyle=":", linewidth=1.4, label=f"limit {seen.limit.said}")
    ax.set(xlabel=f"{key_in_words(chosen.along)}, number from the worst on", ylabel=seen.label)
    ax.ticklabel_format(axis="y", useOffset=False)
    legend_above(ax)
    return made


def _band(values: FloatArray) -> FloatArray:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        found: FloatArray = np.nanpercentile(values, [5.0, 95.0], axis=1)
    return found

"""Samples of a design, or roads: how often which value comes, and how it goes with each key."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.wording import evenly_spread, number
from movingfrf.reports.curves import GREY, PALETTE
from movingfrf.reports.figures import SIZE, blank
from movingfrf.studies.sweep.page.answers import passes, share, worst
from movingfrf.studies.sweep.page.axes import name_axis
from movingfrf.studies.sweep.page.choice import DRAWN
from movingfrf.studies.sweep.page.kind import View
from movingfrf.studies.sweep.page.lines import what_is_taken
from movingfrf.studies.sweep.page.words import key_in_words, keys_of

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


class Influence(NamedTuple):
    """How much of a measure's variance follows from a key alone."""

    key: str
    share: float

    @property
    def percent(self) -> str:
        """The share in words."""
        return f"{100 * self.share:.0f} %"


def independent(table: xr.Dataset) -> slice:
    """Take the samples that know nothing of each other: of a saltelli design those before keys are exchanged."""
    drawn = json.loads(table.attrs.get("design", "{}"))
    return slice(2 * int(drawn["samples"]) if drawn.get("kind") == "saltelli" else None)


def alone(table: xr.Dataset, values: FloatArray) -> FloatArray:
    """Take the values of independent samples, or of roads, that have an answer."""
    found: FloatArray = values.reshape(-1)[independent(table)]
    return found[np.isfinite(found)]


def influences(view: View) -> list[Influence]:
    """Find how much of a measure's variance follows from each key of a design alone, from the most on.

    Samples are put into classes of equally many by their key, and variance within classes is what the key does not
    tell: Kelley's epsilon squared, which expects nothing of a key that does nothing, and less than there is where
    classes are wide.
    """
    table, part = view.table, independent(view.table)
    if view.layout.along != "sample":
        return []
    values = view.seen.worst[part]
    there = np.isfinite(values)
    values = values[there]
    classes = int(min(max(values.size // 8, 2), 20))
    if values.size < 2 * classes or np.ptp(values) <= 1e-9 * np.abs(values).max():
        return []
    found = []
    for key in keys_of(table):
        order = np.argsort(table[key].values[part][there], kind="stable")
        within = sum(float(((each - each.mean()) ** 2).sum()) for each in np.array_split(values[order], classes))
        left = within / (values.size - classes) / values.var(ddof=1)
        found.append(Influence(key, max(1.0 - float(left), 0.0)))
    return sorted(found, key=lambda one: -one.share)


def answer(view: View) -> str:
    """Say how many pass the limit, mean and percentiles, what matters, and the worst."""
    table, seen = view.table, view.seen
    values = alone(table, seen.worst)
    words = []
    if seen.limit:
        over = int(seen.beyond(values).sum())
        words.append(f"{passes(seen)} for {share(over, values.size, _what(view))}.")
    low, middle, high = (number(float(value)) for value in np.percentile(values, [5.0, 50.0, 95.0]))
    words.append(
        f"Mean {seen.written(values.mean())}; 5, 50 and 95 % of the {_what(view)} lie below {low}, {middle} and "
        f"{high} {seen.units}".rstrip()
        + "."
    )
    for most in influences(view)[:1]:
        words.append(f"Of its variance {most.percent} or more follow from {key_in_words(most.key)} alone.")
    return " ".join([*words, worst(table, seen)])


def _what(view: View) -> str:
    return "samples" if view.layout.along == "sample" else "roads"


def drawn(view: View) -> str:
    """Say what is drawn, and of how many."""
    seen = view.seen
    words = what_is_taken(view)
    there, counted = int(np.isfinite(seen.worst).sum()), alone(view.table, seen.worst).size
    limit = ", dotted: limit" if seen.limit else ""
    words.append(f"Left: how often which value comes; solid: mean, dashed: 5th, 50th and 95th percentile{limit}.")
    if counted < there:
        words.append(f"Shares are of the {counted} samples that were drawn independently of each other.")
    found = influences(view)
    if found:
        words.append(
            "Right: over the keys that matter most, with the share of the variance that follows from each alone."
        )
        if there > DRAWN.samples:
            words.append(f"{DRAWN.samples} of {there} samples are drawn there.")
    else:
        words[-1] = words[-1].replace("Left: how", "How")
    return " ".join(words)


def figure(view: View) -> Figure:
    """Draw a histogram, and the measure over the keys that matter most."""
    table, seen = view.table, view.seen
    found = influences(view)[: DRAWN.keys]
    made = blank(SIZE.single + 0.4)
    widths = (1.5, *[1.0] * len(found))
    first, *others = made.subplots(1, 1 + len(found), squeeze=False, width_ratios=widths)[0]
    _draw_spread(first, view)
    some = np.flatnonzero(np.isfinite(seen.worst))
    some = some[evenly_spread(some.size, DRAWN.samples)]
    for ax, one in zip(others, found, strict=True):
        ax.plot(table[one.key].values[some], seen.worst[some], ".", color=PALETTE[0], markersize=3.0)
        if seen.limit:
            ax.axhline(seen.limit.value, color=GREY, linestyle=":", linewidth=1.4)
        name_axis(ax.xaxis, table, one.key, most=3)
        ax.set_title(f"{one.percent} of the variance")
        ax.ticklabel_format(axis="y", useOffset=False)
    return made


def _draw_spread(ax: Axes, view: View) -> None:
    """Draw how often which value comes."""
    seen = view.seen
    values = alone(view.table, seen.worst)
    ax.hist(values, bins=_bins(values), color=PALETTE[5])
    ax.axvline(values.mean(), color=PALETTE[0], linewidth=1.6)
    for value in np.percentile(values, [5.0, 50.0, 95.0]):
        ax.axvline(float(value), color=PALETTE[0], linewidth=1.2, linestyle="--")
    if seen.limit:
        ax.axvline(seen.limit.value, color=GREY, linestyle=":", linewidth=1.6)
    ax.set(xlabel=seen.label, ylabel=_what(view))


def _bins(values: FloatArray) -> int:
    """Count the bars: as the square root of how many values there are, up to what a figure resolves."""
    return int(min(max(np.sqrt(values.size), 5), 50))

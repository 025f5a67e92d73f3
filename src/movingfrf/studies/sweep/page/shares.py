"""What the scatter of each measure is due to: shares of its variance, of a saltelli design."""

from __future__ import annotations

import json
from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from movingfrf.reports.curves import GREY, INK, PALETTE
from movingfrf.reports.figures import Illustration
from movingfrf.studies.sweep.design import shares_of
from movingfrf.studies.sweep.page.choice import DRAWN
from movingfrf.studies.sweep.page.seen import Seen
from movingfrf.studies.sweep.page.tornado import Panel, tornado
from movingfrf.studies.sweep.page.words import key_in_words

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes


class Share(NamedTuple):
    """What is due to a key of the variance of a measure, and by how much that may be off."""

    key: str
    first: float  # due to it alone
    total: float  # to it and what it does together with others
    first_off: float  # half an interval of confidence
    total_off: float


def shares(table: xr.Dataset, seen: Seen) -> list[Share]:
    """Find how much of a measure's variance is due to which key.

    Samples are drawn again from those that there are: how far the shares then scatter is how uncertain they are. As
    samples fill their ranges more evenly than by chance, they are rather less so.

    Parameters
    ----------
    table : xarray.Dataset
        What `sweep` returned.
    seen : Seen
        The measure.

    Returns
    -------
    list of Share
        From the key that matters most on; none without a saltelli design of which every case has an answer.
    """
    from scipy.stats import norm

    drawn = json.loads(table.attrs.get("design", "{}"))
    if drawn.get("kind") != "saltelli" or not np.isfinite(seen.worst).all():
        return []
    keys, base = drawn["paths"], int(drawn["samples"])
    parts = seen.worst.reshape(len(keys) + 2, base)
    found = shares_of(parts)
    if not np.isfinite(found).all():
        return []
    rng = np.random.default_rng(0)
    again = np.array([shares_of(parts[:, rng.integers(base, size=base)]) for _ in range(DRAWN.resamples)])
    off = norm.ppf(0.5 + 0.5 * DRAWN.confidence) * np.nanstd(again, axis=0)
    names = {table[name].attrs.get("long_name"): str(name) for name in table.coords}
    told = [Share(names[key], *map(float, (*found[:, at], *off[:, at]))) for at, key in enumerate(keys)]
    return sorted(told, key=lambda one: -one.total)


def illustration(table: xr.Dataset, each: Sequence[Seen]) -> Illustration | None:
    """Draw the shares of each measure; None where there are none."""
    told = [(seen.called, found) for seen in each if (found := shares(table, seen))]
    if not told:
        return None
    return tornado(
        "What is the scatter of each measure due to?",
        _caption(told),
        [Panel(called, [one.key for one in found], partial(_draw, told=found)) for called, found in told],
    )


def _caption(told: list[tuple[str, list[Share]]]) -> str:
    """Say what matters most to each measure."""

    def percent(one: Share) -> str:
        return f"{key_in_words(one.key)} {100 * one.total:.0f} ± {100 * one.total_off:.0f} %".replace("-", "−")

    most = "; ".join(f"{called}: {percent(found[0])}" for called, found in told)
    return (
        f"What matters most – {most}. Wide bars: share of the variance due to a key and to what it does with "
        f"others; narrow bars: to it alone; lines: {100 * DRAWN.confidence:g} % confidence, of samples drawn again."
    )


def _draw(ax: Axes, told: list[Share]) -> None:
    rows = np.arange(len(told))
    total, first, total_off, first_off = (
        [getattr(one, name) for one in told] for name in ("total", "first", "total_off", "first_off")
    )
    ax.barh(rows, total, height=0.72, color=PALETTE[5], alpha=0.55, xerr=total_off, ecolor=GREY)
    ax.barh(rows, first, height=0.3, color=PALETTE[0], xerr=first_off, ecolor=INK)
    low, high = ax.get_xlim()
    ax.set_xlim(min(0.0, low), max(1.0, high))

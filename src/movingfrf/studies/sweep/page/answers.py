"""Answers in numbers: where a measure is worst, where it passes its limit, how many cases do."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.wording import number
from movingfrf.metrics.comfort import comfort_reactions
from movingfrf.studies.sweep.page.choice import DRAWN
from movingfrf.studies.sweep.page.seen import Seen
from movingfrf.studies.sweep.page.words import between, case_in_words

if TYPE_CHECKING:
    import xarray as xr


class Stretch(NamedTuple):
    """A part of an axis."""

    first: float
    last: float


class Axis(NamedTuple):
    """What is said of an axis: its name, where its values stand, and their unit."""

    name: str
    places: FloatArray
    unit: str


def beyond(places: FloatArray, values: FloatArray, limit: float, *, below: bool) -> list[Stretch]:
    """Find where values lie beyond a limit.

    Parameters
    ----------
    places : ndarray, shape (n,)
        Where values stand along an axis.
    values : ndarray, shape (n,)
        The values; nan where there is none, and nothing is said beside.
    limit : float
        The limit.
    below : bool
        Whether beyond is below.

    Returns
    -------
    list of Stretch
        In ascending order; ends between two values lie where the straight line between them crosses the limit.

    Examples
    --------
    >>> beyond(np.array([10.0, 20.0, 30.0]), np.array([0.1, 0.2, 0.4]), 0.25, below=False)
    [Stretch(first=22.5, last=30.0)]
    """
    order = np.argsort(places, kind="stable")
    x = places[order]
    over = (limit - values if below else values - limit)[order]
    # What has no value ends a stretch as the ends of the axis do.
    inside = np.concatenate([[False], over > 0, [False]])
    firsts, lasts = np.flatnonzero(~inside[:-1] & inside[1:]), np.flatnonzero(inside[:-1] & ~inside[1:]) - 1

    def edge(within: int, outside: int) -> float:
        if not 0 <= outside < x.size or not np.isfinite(over[outside]):
            return float(x[within])
        share = over[within] / (over[within] - over[outside])
        return float(x[within] + share * (x[outside] - x[within]))

    return [Stretch(edge(a, a - 1), edge(b, b + 1)) for a, b in zip(firsts.tolist(), lasts.tolist(), strict=True)]


def where(stretches: Sequence[Stretch], axis: Axis) -> str:
    """Say where stretches lie along an axis.

    Examples
    --------
    >>> speed = Axis("speed", np.array([10.0, 20.0, 30.0]), "m/s")
    >>> where([Stretch(22.5, 30.0)], speed), where([Stretch(10.0, 30.0)], speed), where([], speed)
    ('from 22.5 m/s on', 'everywhere', 'nowhere')
    """
    low, high = float(axis.places.min()), float(axis.places.max())
    name = "" if axis.unit else f"{axis.name} "

    def one(stretch: Stretch) -> str:
        first, last = (between(end, axis.places, axis.unit) for end in stretch)
        if stretch.first <= low:
            return "everywhere" if stretch.last >= high else f"up to {name}{last}"
        if stretch.last >= high:
            return f"from {name}{first} on"
        return f"at {name}{first}" if first == last else f"from {name}{first} to {last}"

    if len(stretches) > DRAWN.stretches:
        return f"over {len(stretches)} stretches, first {one(stretches[0])}"
    return " and ".join(map(one, stretches)) or "nowhere"


def share(some: int, of: int, what: str) -> str:
    """Say how many of some drawn at random it is, and between what the share lies.

    Parameters
    ----------
    some, of : int
        How many, and of how many.
    what : str
        What they are, in the plural.

    Returns
    -------
    str
        With the interval of confidence after Wilson.

    Examples
    --------
    >>> share(12, 256, "samples")
    '12 of 256 samples, 4.7 % (95 % confidence: 2.7 to 8.0 %)'
    """
    from scipy.stats import binomtest

    if not of:
        return f"none of 0 {what}"
    interval = binomtest(some, of).proportion_ci(DRAWN.confidence, method="wilson")
    ends = [number(100 * float(end), 2) for end in (interval.low, interval.high)]
    sure = f"{100 * DRAWN.confidence:g} % confidence"
    if not some:
        return f"none of {of} {what} ({sure}: less than {ends[1]} %)"
    return f"{some} of {of} {what}, {number(100 * some / of, 2)} % ({sure}: {ends[0]} to {ends[1]} %)"


def passes(seen: Seen, *, never: bool = False) -> str:
    """Say that a measure passes its limit, or never does, as the beginning of a sentence."""
    assert seen.limit
    verb = ("does not fall below" if never else "falls below") if seen.below else "exceeds"
    verb = "does not exceed" if never and not seen.below else verb
    meaning = f" ({seen.limit.meaning})" if seen.limit.meaning and not never else ""
    return f"The {seen.called} {verb} {seen.limit.said}{meaning}"


def worst(table: xr.Dataset, seen: Seen) -> str:
    """Say how large a measure becomes, or how small, and where."""
    *case, _ = seen.at
    value = float(seen.each[seen.at])
    beside = ""
    if seen.static is not None and seen.static[seen.at] > 0:
        beside = f", {number(value / float(seen.static[seen.at]), 2)} of the static load"
    if seen.felt and seen.units == "m/s²":
        beside = f", {' or '.join(f'“{words}”' for words in comfort_reactions(value))} in ISO 2631-1"
    told = case_in_words(table, case)
    here = f"at {str(seen.places[seen.at]).replace('_', ' ')}" + (f", {told}" if told else "")
    return f"{'Smallest' if seen.below else 'Largest'}: {seen.written(value)}{beside}, {here}."


def counted(seen: Seen) -> str:
    """Say how many cases lie beyond the limit."""
    there = int(np.isfinite(seen.worst).sum())
    return f"in {int(seen.beyond(seen.worst).sum()) or 'none'} of {there} cases"

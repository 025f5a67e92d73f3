"""Tables of a sweep, and what is to be known of it, for a page and for a console."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from movingfrf._basics.wording import count, is_never, number
from movingfrf.reports.tables import Column, Row, Table
from movingfrf.studies.sweep.page.limits import Limit
from movingfrf.studies.sweep.page.seen import Seen, seen_of
from movingfrf.studies.sweep.page.shares import shares
from movingfrf.studies.sweep.page.words import case_in_words, keys_of

if TYPE_CHECKING:
    import xarray as xr


def findings(table: xr.Dataset) -> list[str]:
    """Say what to know about a sweep, in sentences.

    Parameters
    ----------
    table : xarray.Dataset
        What `sweep` returned.

    Returns
    -------
    list of str
        Of the sweep as a whole, then why cases have no answer, then what is to be known of how many cases.
    """
    said = [str(one["message"]) for one in json.loads(table.attrs["findings"])]
    found = [f"{words[0].upper()}{words[1:]}." for words in said]
    reasons = Counter(str(why) for why in table.status.values.ravel() if why)
    found += [f"{count(times, 'case')} without an answer: {why}." for why, times in reasons.most_common(8)]
    if len(reasons) > 8:
        found.append(f"{len(reasons) - 8} other reasons for cases without an answer stand in table.csv.")
    if reasons and _kind(table) == "saltelli":
        found.append("What is due to which key is not said: that needs an answer of every case.")
    codes = Counter(code for each in table.findings.values.ravel() if each for code in str(each).split(", "))
    cases = table.status.size
    found += [
        f"{code.replace('_', ' ').capitalize()}, in {times} of {count(cases, 'case')}; `movingfrf run` says more."
        for code, times in codes.most_common()
    ]
    return found


def _kind(table: xr.Dataset) -> str:
    """Say how samples were drawn; empty where there are none."""
    return str(json.loads(table.attrs.get("design", "{}")).get("kind", ""))


def tables(table: xr.Dataset, limits: Sequence[Limit] = ()) -> list[Table]:
    """Tables for reading.

    Parameters
    ----------
    table : xarray.Dataset
        What `sweep` returned.
    limits : sequence of Limit
        What measures are held against.

    Returns
    -------
    list of Table
        Of each measure the extremes, and where the worst one is; what is due to which key, where the design tells.
    """
    each = [seen for seen in seen_of(table, limits) if np.isfinite(seen.worst).any()]
    rows = []
    for seen in each:
        there = seen.worst[np.isfinite(seen.worst)]
        cells = [
            "< 10⁻¹²" if is_never(float(value), seen.units or "1") else number(float(value))
            for value in (there.min(), np.median(there), there.max())
        ]
        *case, _ = seen.at
        # Of a design a line would be too long; table.csv has the sample.
        told = f"sample {case[0]}" if "design" in table.attrs else case_in_words(table, case)
        at = f"{seen.places[seen.at]}, {told}".rstrip(", ")
        rows.append(Row(seen.called.capitalize(), [*cells, seen.units, at]))
    columns = [
        Column("smallest", ""),
        Column("median", ""),
        Column("largest", ""),
        Column("unit", "", words=True),
        Column("worst at", "", words=True),
    ]
    found = [Table("Measures over all cases, and where each is worst.", "measure", columns, rows)] if rows else []
    return [*found, *_shares(table, each)]


def _shares(table: xr.Dataset, each: Sequence[Seen]) -> list[Table]:
    """Say how much of each measure's variance is due to which key, where the design tells."""
    told = [(seen, found) for seen in each if (found := shares(table, seen))]
    if not told:
        return []
    keys = keys_of(table)
    rows = []
    for seen, found in told:
        by_key = {one.key: one for one in found}
        cells = [
            f"{number(one.first, 2)} ± {number(one.first_off, 1)}; "
            f"{number(one.total, 2)} ± {number(one.total_off, 1)}"
            for one in (by_key[key] for key in keys)
        ]
        rows.append(Row(seen.called.capitalize(), cells))
    return [
        Table(
            "Share of the variance due to a key alone; to it and others with it; each with its 95 % confidence.",
            "measure",
            [Column(key, "", words=True) for key in keys],
            rows,
        )
    ]

"""What a figure has along an axis: a measure of each contact, or at each value of another axis."""

from __future__ import annotations

import warnings
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf.reports.curves import PALETTE, readable
from movingfrf.studies.sweep.page.choice import laid_out
from movingfrf.studies.sweep.page.kind import View
from movingfrf.studies.sweep.page.words import key_in_words, names_of


class Line(NamedTuple):
    """One curve: a measure along an axis, on each road."""

    label: str
    values: FloatArray  # (along, seed)

    @property
    def mean(self) -> FloatArray:
        """Mean over the roads."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)
            found: FloatArray = np.nanmean(self.values, axis=1)
        return found


def lines_of(view: View) -> list[Line]:
    """Take the curves: of each contact where these are few and nothing else varies, else of the worst one."""
    table, seen, chosen = view
    dims = [str(dim) for dim in table.status.dims]

    def lines(values: FloatArray) -> FloatArray:
        return laid_out(values, dims, chosen, below=seen.below)

    if chosen.across:
        found = lines(seen.worst)
        names = [f"{key_in_words(chosen.across)} {name}" for name in names_of(table, chosen.across)]
        return [Line(name, found[:, number]) for number, name in enumerate(names)]
    there = [number for number in range(seen.each.shape[-1]) if np.isfinite(seen.each[..., number]).any()]
    one_each = all((seen.places[..., number] == seen.places[..., number].flat[0]).all() for number in there)
    if seen.calmest or not one_each or not 1 < len(there) <= len(PALETTE):
        return [Line("", lines(seen.worst)[:, 0])]
    return [
        Line(readable(str(seen.places[..., number].flat[0])), lines(seen.each[..., number])[:, 0])
        for number in there
    ]


def what_is_taken(view: View) -> list[str]:
    """Say of which contact, and at which values of axes that are not drawn, in sentences."""
    table, seen, chosen = view
    words = []
    if seen.calmest:
        words.append("Of each case the calmest of what moves up and down.")
    elif not lines_of(view)[0].label or chosen.across:
        place = "contact" if str(table[seen.name].dims[-1]) == "contact" else "degree of freedom"
        several = np.isfinite(seen.each).any(axis=tuple(range(seen.each.ndim - 1))).sum() > 1
        words += [f"Of each case the worst {place}."] if several else []
    if chosen.others:
        words.append(f"Of all values of {' and '.join(map(key_in_words, chosen.others))} the worst.")
    return words

"""The page of a sweep: what each measure does along the axes, where it passes limits."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from movingfrf._basics.version import VERSION
from movingfrf._basics.wording import count
from movingfrf.reports.figures import Illustration, drawing, illustrated
from movingfrf.reports.page import Answer, page
from movingfrf.reports.tables import Setting
from movingfrf.studies.sweep.page import curves, dots, maps, reaches, samples, shares, single
from movingfrf.studies.sweep.page.choice import layout_of
from movingfrf.studies.sweep.page.kind import Kind, View
from movingfrf.studies.sweep.page.limits import Limit
from movingfrf.studies.sweep.page.seen import seen_of
from movingfrf.studies.sweep.page.tables import findings, tables
from movingfrf.studies.sweep.page.words import key_in_words, keys_of, said

if TYPE_CHECKING:
    import xarray as xr


def kinds() -> dict[str, Kind]:
    """Give the kinds of figures, by what a layout calls them."""
    return {"curves": curves, "map": maps, "dots": dots, "ranks": dots, "samples": samples, "": single}


def views(table: xr.Dataset, limits: Sequence[Limit] = ()) -> list[View]:
    """Take what is asked of a sweep, as figures have it; without what no case answers.

    Parameters
    ----------
    table : xarray.Dataset
        What `sweep` returned.
    limits : sequence of Limit
        What measures are held against.

    Returns
    -------
    list of View
        One for each question.
    """
    chosen = layout_of(table)
    return [View(table, seen, chosen) for seen in seen_of(table, limits) if np.isfinite(seen.worst).any()]


def answers(table: xr.Dataset, limits: Sequence[Limit] = ()) -> list[Answer]:
    """Answer what is asked of a sweep.

    Parameters
    ----------
    table : xarray.Dataset
        What `sweep` returned.
    limits : sequence of Limit
        What measures are held against.

    Returns
    -------
    list of Answer
        Each with its question.
    """
    return [Answer(view.seen.asks, kinds()[view.layout.kind].answer(view)) for view in views(table, limits)]


def render(table: xr.Dataset, title: str, scenario: str, limits: Sequence[Limit] = ()) -> str:
    """Write the report of a sweep.

    Parameters
    ----------
    table : xarray.Dataset
        What `sweep` returned.
    title : str
        What the page is called.
    scenario : str
        Text of the scenario that is varied.
    limits : sequence of Limit
        What measures are held against.

    Returns
    -------
    str
        One HTML page without references to anything outside it.
    """
    with drawing():
        figures = _figures(table, views(table, limits))
    return page(
        title=title,
        version=VERSION,
        summary=_summary(table),
        settings=[_setting(table, name) for name in keys_of(table)],
        answers=answers(table, limits),
        findings=findings(table),
        no_findings="No findings: every case has an answer, within the assumptions that it is computed under.",
        tables=tables(table, limits),
        figures=figures,
        method=[
            "Each case is the scenario below with other values of some keys, solved and measured as a case by "
            "itself; table.csv has every contact and degree of freedom of every case."
        ],
        scenario=scenario,
        measures="The worst cases",
    )


def _figures(table: xr.Dataset, each: Sequence[View]) -> list[Illustration]:
    """Draw a figure for each question, and one of what measures depend on."""
    found = []
    for number, view in enumerate(each):
        kind = kinds()[view.layout.kind]
        if view.layout.kind:
            caption = f"{kind.answer(view)} {kind.drawn(view)}".rstrip()
            found.append(illustrated(f"sweep-{number}", view.seen.asks, caption, kind.figure(view)))
    seen = [view.seen for view in each]
    return [*found, *(last for module in (shares, reaches) if (last := module.illustration(table, seen)))]


def _summary(table: xr.Dataset) -> str:
    """Say how many cases there are, of what, and how many have no answer."""
    cases, without = table.status.size, int((table.status.values != "").sum())
    if "design" in table.attrs:
        drawn = json.loads(table.attrs["design"])
        of = f", drawn ({drawn['kind'].replace('_', ' ')}) of {' and '.join(drawn['paths'])}"
    else:
        of = ": " + " × ".join(f"{table.sizes[dim]} of {key_in_words(str(dim))}" for dim in table.status.dims)
    return f"{count(cases, 'case')}{of}. {_answered(cases, without)}"


def _answered(cases: int, without: int) -> str:
    """Say how many cases have no answer."""
    if cases == 1:
        return f"It has {'no' if without else 'an'} answer."
    if without == cases:
        return "None of them has an answer."
    if without:
        return f"{without} of them {'has' if without == 1 else 'have'} no answer."
    return "Every one has an answer."


def _setting(table: xr.Dataset, name: str) -> Setting:
    """Say over what an axis goes."""
    values, digits = table[name].values, 4 if "design" in table.attrs else 6
    if values.dtype.kind in "iuf" and values.size > 4:
        words = f"{said(table, name, values.min(), digits)} to {said(table, name, values.max(), digits)}"
    else:
        words = ", ".join(said(table, name, value) for value in values[:6]) + (", …" if values.size > 6 else "")
    return Setting(str(table[name].attrs.get("long_name", name)), words, count(values.size, "value"))

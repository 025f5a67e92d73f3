"""The page of a search: what was found, next to the scenario as it was, and all that was tried."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from movingfrf._basics.version import VERSION
from movingfrf._basics.wording import count, number
from movingfrf.reports.axes import legend_above
from movingfrf.reports.curves import GREY, PALETTE
from movingfrf.reports.figures import SIZE, blank, drawing, illustrated
from movingfrf.reports.page import page
from movingfrf.reports.tables import Column, Row, Setting, Table
from movingfrf.studies.optimisation.problem import Limit, Of, Problem

if TYPE_CHECKING:
    from scipy.optimize import OptimizeResult


def render(problem: Problem, best: OptimizeResult, title: str, scenario: str) -> str:
    """Write the report of a search.

    Parameters
    ----------
    problem : Problem
        What was asked.
    best : OptimizeResult
        What `optimise` found.
    title : str
        What the page is called.
    scenario : str
        Text of the scenario that was found.

    Returns
    -------
    str
        One HTML page without references to anything outside it.
    """
    parts: list[tuple[Of, Limit | None]] = [(problem.aim, None), *((limit.of, limit) for limit in problem.limits)]
    with drawing():
        figures = [
            illustrated(
                f"search-{number_}",
                f"How does the {of.words.replace('_', ' ')} depend on the keys?",
                "Every case that was tried; a ring is the one that was found, hollow ones break a limit."
                + ("" if limit is None else f" The limit: {limit.words}."),
                _figure(problem, best, of, limit),
            )
            for number_, (of, limit) in enumerate(parts)
        ]
    return page(
        title=title,
        version=VERSION,
        summary=best.message,
        settings=[
            Setting(key.name, f"{key.told(key.low)} to {key.told(key.high)}", "range that was searched")
            for key in problem.keys
        ],
        findings=findings(best),
        no_findings="No findings: all limits are kept, and no key stands at an end of its range.",
        tables=tables(problem, best),
        figures=figures,
        method=[
            "The ranges were sampled, and the search went downhill from the best samples by sequential quadratic "
            "programming (SLSQP of SciPy), with gradients from one adjoint solution each: "
            f"{count(best.nfev, 'case')}, {count(best.njev, 'gradient')}. table.csv has all cases. There may be "
            "something better elsewhere in the ranges."
        ],
        scenario=scenario,
        measures="What was found",
    )


def findings(best: OptimizeResult) -> list[str]:
    """Say what is to be known of what was found, in sentences."""
    return [str(one["message"]) for one in json.loads(best.table.attrs["findings"])]


def tables(problem: Problem, best: OptimizeResult) -> list[Table]:
    """Tables for reading: keys and measures, as they were and as they were found.

    Parameters
    ----------
    problem : Problem
        What was asked.
    best : OptimizeResult
        What `optimise` found.

    Returns
    -------
    list of Table
        One.
    """
    last = _number(problem, best)
    given = 0 if problem.own is not None and not best.table.status.values[0] else None
    rows = [
        Row(key.name, [_cell(values, given), number(float(values[last])), key.unit, f"{key.low:g} to {key.high:g}"])
        for key, values in zip(problem.keys, _values(problem, best), strict=True)
    ]
    wanted = [(problem.aim, "smallest"), *((limit.of, limit.words) for limit in problem.limits)]
    for of, asked in wanted:
        units = problem.plan.way.measures[of.measure].units.split(" or ")[0]
        for place, name in zip(of.numbers, of.names, strict=True):
            values = best.table[of.measure].values[:, place]
            cells = [_cell(values, given), number(float(values[last])), "" if units == "1" else units, asked]
            rows.append(Row(f"{of.measure} of {name}", cells))
    columns = [
        Column("as it was", ""),
        Column("found", ""),
        Column("unit", "", words=True),
        Column("asked for", "", words=True),
    ]
    return [Table("The scenario as it was, and as it was found.", "", columns, rows)]


def _cell(values: np.ndarray, given: int | None) -> str:
    return "" if given is None else number(float(values[given]))


def _values(problem: Problem, best: OptimizeResult) -> list[np.ndarray]:
    """Values of each key in every case that was tried."""
    table = best.table
    named = {str(table[name].attrs.get("long_name")): table[name].values for name in table.coords}
    return [named[key.paths[0]] for key in problem.keys]


def _number(problem: Problem, best: OptimizeResult) -> int:
    """Find which of the cases is the best one."""
    same = np.all([each == x for each, x in zip(_values(problem, best), best.x, strict=True)], axis=0)
    return int(np.flatnonzero(same)[0])


def _figure(problem: Problem, best: OptimizeResult, of: Of, limit: Limit | None) -> Any:
    """Draw a measure of every case over each of the first keys."""
    table, last = best.table, _number(problem, best)
    keys = problem.keys[:3]
    figure = blank(SIZE.single + 0.4)
    axes = figure.subplots(1, len(keys), squeeze=False, sharey=True)[0]
    kept = np.ones(table.status.size, bool)
    for one in problem.limits:
        values = table[one.of.measure].values[:, list(one.of.numbers)]
        with np.errstate(invalid="ignore"):
            slack = 1e-6 * np.abs(values)
            kept &= ((values >= one.low - slack) & (values <= one.high + slack)).all(axis=1)
    units = problem.plan.way.measures[of.measure].units.split(" or ")[0]
    for ax, key, along in zip(axes, keys, _values(problem, best), strict=False):
        for place, name, colour in zip(of.numbers, of.names, PALETTE, strict=False):
            values = table[of.measure].values[:, place]
            ax.plot(along[kept], values[kept], "o", color=colour, markersize=4.0, label=name)
            ax.plot(along[~kept], values[~kept], "o", color=colour, markersize=4.0, fillstyle="none")
            ax.plot(along[last], values[last], "o", color=colour, markersize=10.0, fillstyle="none")
        for end in () if limit is None else (limit.low, limit.high):
            if np.isfinite(end):
                ax.axhline(end, color=GREY, linestyle=":", linewidth=1.2)
        if key.by_factors:
            ax.set_xscale("log")
        ax.set_xlabel(f"{key.paths[0]} [{key.unit}]" if key.unit else key.paths[0])
    axes[0].set_ylabel(of.measure.replace("_", " ") + ("" if units == "1" else f" [{units}]"))
    legend_above(axes[0])
    return figure

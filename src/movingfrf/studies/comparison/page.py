"""The page of a comparison: table, times at equal error, error over time."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from movingfrf._basics.compiling import numba_is_there
from movingfrf._basics.version import VERSION
from movingfrf._basics.wording import count, in_both_units, number, plain
from movingfrf.reports.axes import legend_above
from movingfrf.reports.curves import GREY, PALETTE
from movingfrf.reports.figures import SIZE, Illustration, blank, drawing, illustrated
from movingfrf.reports.page import page
from movingfrf.reports.tables import Column, Row, Setting, Table
from movingfrf.scenarios.scenario import Drive
from movingfrf.scenarios.stepped import stands_still
from movingfrf.stepping.finite_guideway import FiniteGuideway
from movingfrf.studies.comparison.comparison import Comparison, Point, ratios
from movingfrf.studies.comparison.convergence import TARGETS, refined
from movingfrf.studies.comparison.methods import FOR_LOADS, FOR_VEHICLE, compiles

if TYPE_CHECKING:
    from matplotlib.axes import Axes


QUANTITIES = {
    "contact_force": "contact force",
    "deflection": "deflection",
    "wheel_acceleration": "wheel acceleration",
}


def render(comparison: Comparison) -> str:
    """Write the report of a comparison.

    Parameters
    ----------
    comparison : Comparison
        What `compare` found.

    Returns
    -------
    str
        One HTML page without references to anything outside it.
    """
    scenario = comparison.scenario
    with drawing():
        figures = _figures(comparison) if comparison.curve else []
    return page(
        title=f"{scenario.name}: methods compared",
        version=VERSION,
        summary=_summary(comparison),
        settings=_settings(comparison),
        findings=findings(comparison),
        no_findings="No findings: the converged answer moves far less than the errors that are read from it.",
        tables=tables(comparison),
        figures=figures,
        method=_method(comparison),
        scenario=scenario.text,
        measures="Times and errors",
    )


def tables(comparison: Comparison) -> list[Table]:
    """Tables for reading.

    Parameters
    ----------
    comparison : Comparison
        What `compare` found.

    Returns
    -------
    list of Table
        Times and memory, errors, times at equal error, movement of the converged answer.
    """
    return [
        _time_table(comparison),
        _error_table(comparison),
        *([_equal_error_table(comparison)] if comparison.curve else []),
        _reference_table(comparison),
    ]


def _name(comparison: Comparison, quantity: str) -> str:
    """Call a quantity by its name; where everything that moves touches the road there are no wheels."""
    case = comparison.scenario.case
    if quantity == "wheel_acceleration" and isinstance(case, Drive):
        touching = np.asarray(case.vehicle.contact_map).any(axis=0)
        return "vehicle acceleration" if touching.all() else QUANTITIES[quantity]
    return QUANTITIES[quantity]


def _main(comparison: Comparison) -> str:
    return _name(comparison, comparison.main_quantity)


def _summary(comparison: Comparison) -> str:
    journey = comparison.scenario.journey
    road = "a finite road" if stands_still(comparison.scenario.guideway) else "a rough road"
    what = f"a vehicle on {road}" if isinstance(comparison.scenario.case, Drive) else "prescribed loads on a road"
    words = (
        f"One case, {what} at {plain(journey.speed)} m/s for {plain(journey.duration)} s, solved by "
        f"{count(len(comparison.rows), 'method')} in one process on one thread. Errors are those of the "
        f"{_main(comparison)}, unless said otherwise, relative to a converged answer from "
        "the time domain."
    )
    for in_batch, times in ((False, comparison.equal_error), (True, comparison.equal_error_in_batch)):
        for target in times:
            found = ratios(comparison, target, in_batch=in_batch)
            others = [
                f"{number(ratio, 3)} ({name})"
                for name, ratio in found.items()
                if name != "moving-frf" and math.isfinite(ratio)
            ]
            where = f", in a batch of {comparison.batch}," if in_batch else ""
            if others:
                words += f" At an error of {number(target, 1)}{where} the time over that of moving-frf is "
                words += f"{', '.join(others)}."
    return f"{words} {_shared(comparison)}"


def _shared(comparison: Comparison) -> str:
    """Say whether the set-up is shared, and what it is of each method."""
    if comparison.batch == 1:
        return "The set-up counts in full."
    by: dict[str, list[str]] = {}
    for name in _methods(comparison):
        by.setdefault((FOR_VEHICLE | FOR_LOADS)[name].shares, []).append(name)
    shared = "; ".join(f"{shares} ({', '.join(names)})" for shares, names in by.items())
    what = "profile" if isinstance(comparison.scenario.case, Drive) else "forces"
    return (
        f"A batch of {comparison.batch} cases that differ by their {what} alone shares the set-up: {shared}. The "
        f"cases are solved one after another, so that each takes set-up / {comparison.batch} + solving."
    )


def _settings(comparison: Comparison) -> list[Setting]:
    journey, reference = comparison.scenario.journey, comparison.reference
    return [
        Setting("Speed", *in_both_units(journey.speed, in_kmh=journey.in_kmh)),
        Setting("Duration", f"{plain(journey.duration)} s"),
        Setting("Time step", f"{plain(1e3 * journey.time_step)} ms", "of the table"),
        Setting("Threads", "1"),
        Setting("Steps", "compiled by numba" if compiles(comparison.scenario.guideway) else "NumPy and LAPACK"),
        Setting(
            "Converged answer",
            f"{plain(1e3 * reference.finest_step)} ms"
            + ("" if math.isnan(reference.finest_element) else f", {plain(reference.finest_element)} m"),
            f"at the last halving of {refined(comparison.scenario.guideway)}, extrapolated",
        ),
    ]


def findings(comparison: Comparison) -> list[str]:
    """Say what to know about a comparison, in sentences.

    Parameters
    ----------
    comparison : Comparison
        What `compare` found.

    Returns
    -------
    list of str
        What the methods say of their own results first.
    """
    said: dict[str, list[str]] = {}
    for row in comparison.rows:
        for message in row.findings:
            said.setdefault(message, []).append(row.method)
    found = [f"{', '.join(methods)}: {message}." for message, methods in said.items()]
    movement = max(comparison.reference.movement.values())
    if not movement <= 0.1 * min(TARGETS):
        found.append(
            f"The converged answer still moves by {number(movement, 2)} when it is refined; errors below ten times "
            "that say little."
        )
    if not compiles(comparison.scenario.guideway):
        found.append(
            "The steps of cdfm, sim and newmark are taken in NumPy and LAPACK, some forty times more slowly than "
            "compiled ones: "
            + (
                "the compiled loops take roads of beam elements without layers of mass only."
                if numba_is_there()
                else "numba is not installed (pip install numba, or the extra `fast`)."
            )
        )
    for target in comparison.equal_error:
        missing = [name for name, seconds in comparison.equal_error[target].items() if math.isnan(seconds)]
        if missing:
            found.append(
                f"An error of {number(target, 1)} is not reached in the range of steps by {', '.join(missing)}."
            )
    return found


def _time_table(comparison: Comparison) -> Table:
    columns = [
        Column("step", "ms"),
        Column("element", "m"),
        Column("set-up", "s"),
        Column("solving", "s"),
        Column("peak memory", "MiB"),
    ]
    beside = "moving-frf" in _methods(comparison)
    if beside:
        columns.append(Column("time over moving-frf", ""))
    batched = comparison.batch > 1
    if batched:
        columns.append(Column(f"a case in a batch of {comparison.batch}", "s"))
    colours = _colours(comparison)
    rows = []
    for row in comparison.rows:
        cells = [
            plain(1e3 * row.time_step),
            _cell(row.element, plain),
            number(row.setup_s, 3),
            number(row.solve_s, 3),
            number(row.peak_bytes / 2**20, 3) if row.peak_bytes else "–",
            *([_cell(row.ratio, _three)] if beside else []),
            *([number(row.batch_s, 3)] if batched else []),
        ]
        rows.append(Row(row.method, cells, colours[row.method]))
    words = "Times (medians) and memory (peak of all arrays) at the scenario's own step."
    words += f" {_shared(comparison)}" if batched else ""
    return Table(words, "method", columns, rows)


def _error_table(comparison: Comparison) -> Table:
    names = list(comparison.reference.quantities)
    columns = [
        *(Column(f"{_name(comparison, name)}, relative L2", "") for name in names),
        *(Column(f"{_name(comparison, name)}, largest", "") for name in names),
    ]
    rows = []
    for row in comparison.rows:
        errors = [found[name] for found in (row.relative_l2, row.maximum_error) for name in names]
        rows.append(Row(row.method, [number(error, 2) for error in errors], _colours(comparison)[row.method]))
    return Table(
        "Errors in the same runs, the worst channel of each quantity: root mean square of the error over that of "
        "the answer, and largest error over the largest value.",
        "method",
        columns,
        rows,
    )


def _cell(value: float, write: Callable[[float], str]) -> str:
    return "–" if math.isnan(value) else write(value)


def _three(value: float) -> str:
    return number(value, 3)


def _equal_error_table(comparison: Comparison) -> Table:
    columns: list[Column] = []
    cells: dict[str, list[str]] = {name: [] for name in _methods(comparison)}

    def add(words: str, target: float, times: dict[str, float], *, in_batch: bool) -> None:
        columns.append(Column(words, "s"))
        for name, row in cells.items():
            row.append(_cell(times[name], _three))
        if "moving-frf" in cells:
            columns.append(Column("over moving-frf", ""))
            over = ratios(comparison, target, in_batch=in_batch)
            for name, row in cells.items():
                row.append(_cell(over[name], _three))

    for target, times in comparison.equal_error.items():
        add(f"time to an error of {number(target, 1)}", target, times, in_batch=False)
    for target, times in comparison.equal_error_in_batch.items():
        add(f"a case in a batch of {comparison.batch}, {number(target, 1)}", target, times, in_batch=True)
    colours = _colours(comparison)
    return Table(
        f"Time, set-up included, to equal error in {_main(comparison)}, read from the figure: "
        "the least on a line of the method."
        + (f" In a batch of {comparison.batch} the set-up is shared." if comparison.batch > 1 else ""),
        "method",
        columns,
        [Row(name, row, colours[name]) for name, row in cells.items()],
    )


def _reference_table(comparison: Comparison) -> Table:
    movement = comparison.reference.movement
    longer = "" if _ends(comparison) else ", or when the road was made twice as long"
    return Table(
        "The converged answer: its movement (relative L2, the worst channel) at the last halving of "
        f"{refined(comparison.scenario.guideway)}{longer}.",
        "quantity",
        [Column("movement", "")],
        [Row(_name(comparison, name), [number(value, 2)]) for name, value in movement.items()],
    )


def _ends(comparison: Comparison) -> bool:
    """Tell whether the road is finite."""
    return isinstance(comparison.scenario.guideway, FiniteGuideway)


def _methods(comparison: Comparison) -> list[str]:
    return [row.method for row in comparison.rows]


def _colours(comparison: Comparison) -> dict[str, str]:
    """One colour for each method; more methods than colours share them."""
    palette = PALETTE
    return {name: palette[n % len(palette)] for n, name in enumerate(_methods(comparison))}


def _figures(comparison: Comparison) -> list[Illustration]:
    main, *others = comparison.reference.quantities
    figure = blank(SIZE.single + 1.6)
    (ax,) = figure.subplots(1, 1, squeeze=False)[0]
    legend_above(_error_over_time(comparison, main, ax, targets=True))
    found = [
        illustrated(
            "error-time",
            f"Error in {_name(comparison, main)} over time",
            _reading(comparison),
            figure,
        )
    ]
    if others:
        judged = (
            "whole deflection"
            if stands_still(comparison.scenario.guideway)
            else "deflection without the static sag"
        )
        figure = blank(SIZE.single + 0.8)
        axes = figure.subplots(1, len(others), sharex=True, squeeze=False)[0]
        for ax, name in zip(axes, others, strict=True):
            _error_over_time(comparison, name, ax, targets=False)
            ax.set_title(_name(comparison, name), fontweight="bold")
        found.append(
            illustrated(
                "error-time-others",
                "Errors in the other quantities over time",
                f"The same runs and colours, judged by the {judged} and by the {_name(comparison, others[-1])}.",
                figure,
            )
        )
    return found


def _reading(comparison: Comparison) -> str:
    """Say how to read the figure of errors over time, of what is in it."""
    methods = [(FOR_VEHICLE | FOR_LOADS)[name] for name in _methods(comparison)]
    words = "Each point is one run, each line one method over a range of steps"
    lines = [_lines([point for point in comparison.curve if point.method == name]) for name in _methods(comparison)]
    if max(map(len, lines)) > 1:
        words += "; dashed lines with circles have elements of twice the length of full lines with squares"
    words += ". Left and down is better. Where a line crosses a dotted one the times at equal error are read"
    limits = {
        "the elements": any(m.divides or m.strikes for m in methods)
        and not math.isnan(comparison.reference.finest_element),
        "the 40 m of struck road": any(m.strikes for m in methods),
        "the truncation": any(name.startswith("moving-frf") for name in _methods(comparison)),
    }
    there = [limit for limit, is_there in limits.items() if is_there]
    if not there:
        return f"{words}."
    return f"{words}; where a line turns flat something other than the step limits it: {', or '.join(there)}."


def _error_over_time(comparison: Comparison, quantity: str, ax: Axes, *, targets: bool) -> Axes:
    colours = _colours(comparison)
    if targets:
        for target in comparison.equal_error:
            ax.axhline(target, color=GREY, linestyle=":", linewidth=1.2)
    # Dashes and markers of the lines of one method, from the longest elements to the shortest.
    looks = (("--", "o"), ("-", "s"))
    for name in _methods(comparison):
        lines = _lines([point for point in comparison.curve if point.method == name])
        for (dashes, marker), line in zip(looks[-len(lines) :], lines, strict=True):
            ax.plot(
                [point.seconds for point in line],
                [point.relative_l2[quantity] for point in line],
                linestyle=dashes,
                marker=marker,
                markersize=4.0,
                color=colours[name],
                label=name if line is lines[-1] else None,
            )
    ax.set(xscale="log", yscale="log", xlabel="time, set-up included [s]", ylabel="relative L2 error")
    _label_within_a_decade(ax)
    return ax


def _label_within_a_decade(ax: Axes, apart: float = 0.2) -> None:
    """Label ticks between powers of ten, so far apart as a share of the axis, where none may be in sight."""
    low, high = ax.get_xlim()
    if high >= 10 * low:
        ax.xaxis.set_minor_formatter("")
        return
    inside = [tick for tick in ax.get_xticks(minor=True).tolist() if low <= tick <= high]
    taken = [tick for tick in ax.get_xticks().tolist() if low <= tick <= high]
    labels = []
    for tick in inside:
        free = all(abs(math.log(tick / other)) >= apart * math.log(high / low) for other in taken)
        labels.append(f"{tick:g}" if free else "")
        taken += [tick] * free
    ax.set_xticks(inside, labels, minor=True)


def _lines(points: Sequence[Point]) -> list[list[Point]]:
    """Group points by the length of elements, longest first, and sort each group by step."""
    lines: dict[str, list[Point]] = {}
    for point in sorted(points, key=lambda point: (-point.element, -point.time_step)):
        lines.setdefault(str(point.element), []).append(point)
    return list(lines.values())


def _method(comparison: Comparison) -> list[str]:
    main = _main(comparison)
    methods = {name: (FOR_VEHICLE | FOR_LOADS)[name] for name in _methods(comparison)}
    lines = [f"{name}: {method.words}." for name, method in methods.items()]
    # With cdfm-weight the weight does not travel in a run of its own.
    stepped = [name for name, method in methods.items() if method.divides and name != "cdfm-weight"]
    if _ends(comparison):
        lines.append(
            "The road is finite and stepped as it is, by average acceleration (Newmark), what is constant "
            "factorised once."
            + (
                " It is not the same everywhere: the weight is always stepped along, and errors are those of the "
                "contact force without the weight and of the whole deflection."
                if isinstance(comparison.scenario.case, Drive) and stands_still(comparison.scenario.guideway)
                else ""
            )
        )
    elif stepped:
        lines.append(
            f"{', '.join(stepped)}: cubic Hermite elements, average acceleration (Newmark), what is constant "
            "factorised once, ends of the road absorbing. On a road that is the same everywhere the weight travels "
            "in a run of its own and only what the roughness adds is stepped afterwards: with equal elements that "
            "is several times more accurate than stepping both together."
            if isinstance(comparison.scenario.case, Drive)
            else f"{', '.join(stepped)}: cubic Hermite elements, average acceleration (Newmark), what is constant "
            "factorised once, ends of the road absorbing."
        )
    same = "the same road" if _ends(comparison) else "a road that travels with the vehicle"
    return [
        *lines,
        "Every method gets the same cubic spline of the road's surface, with its rate of change ṙ = v r′, and "
        "includes the convective term v ∂w/∂x wherever a contact has a dashpot."
        if isinstance(comparison.scenario.case, Drive)
        else "Every method gets the same forces at its own steps.",
        f"The converged answer is computed by time stepping alone, on {same}, by halving "
        f"{refined(comparison.scenario.guideway)} and extrapolating the answers, (4 fine − coarse)/3, until these "
        "move by less than 5 × 10⁻⁶ or the last level is done.",
        f"Times are medians of up to three runs on one thread, after a short run that is not timed; {main} decides "
        "times at equal error. Memory is the peak of all arrays, in a process of its own.",
    ]

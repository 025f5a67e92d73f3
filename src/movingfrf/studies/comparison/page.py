"""The page of a comparison: table, times at equal error, error over time."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from movingfrf._basics.version import VERSION
from movingfrf._basics.wording import number, plain
from movingfrf.reports.axes import legend_above
from movingfrf.reports.curves import GREY, PALETTE
from movingfrf.reports.figures import SIZE, Illustration, blank, drawing, illustrated
from movingfrf.reports.page import page
from movingfrf.reports.tables import Column, Row, Setting, Table
from movingfrf.stepping.marching import numba_is_there
from movingfrf.studies.comparison.comparison import Comparison, Point, ratios
from movingfrf.studies.comparison.convergence import TARGETS
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


def _name(quantity: str) -> str:
    return QUANTITIES[quantity]


def _summary(comparison: Comparison) -> str:
    journey = comparison.scenario.journey
    what = "prescribed loads on a road" if comparison.scenario.vehicle is None else "a vehicle on a rough road"
    words = (
        f"One case, {what} at {plain(journey.speed)} m/s for {plain(journey.duration)} s, solved by "
        f"{len(comparison.rows)} methods in one process on one thread. Errors are those of the "
        f"{_name(comparison.main_quantity)}, unless said otherwise, relative to a converged answer from the time "
        "domain."
    )
    for target in comparison.equal_error:
        found = {name: ratio for name, ratio in ratios(comparison, target).items() if math.isfinite(ratio)}
        others = [f"{number(ratio, 3)} ({name})" for name, ratio in found.items() if name != "moving-frf"]
        if others:
            words += f" At an error of {number(target, 1)} the time over that of moving-frf is {', '.join(others)}."
    return words


def _settings(comparison: Comparison) -> list[Setting]:
    journey, reference = comparison.scenario.journey, comparison.reference
    return [
        Setting("Speed", f"{plain(journey.speed)} m/s", f"{plain(round(3.6 * journey.speed, 6))} km/h"),
        Setting("Duration", f"{plain(journey.duration)} s"),
        Setting("Time step", f"{plain(1e3 * journey.time_step)} ms", "of the table"),
        Setting("Threads", "1"),
        Setting("Steps", "compiled by numba" if compiles(comparison.scenario.guideway) else "NumPy and LAPACK"),
        Setting(
            "Converged answer",
            f"{plain(1e3 * reference.finest_step)} ms, {plain(reference.finest_element)} m",
            "finest step and elements, extrapolated",
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
                "the compiled loops take roads without layers of mass only."
                if numba_is_there()
                else "numba is not installed (pip install movingfrf[fast])."
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
        Column("time over moving-frf", ""),
    ]
    colours = _colours(comparison)
    rows = []
    for row in comparison.rows:
        cells = [
            plain(1e3 * row.time_step),
            _cell(row.element, plain),
            number(row.setup_s, 3),
            number(row.solve_s, 3),
            number(row.peak_bytes / 2**20, 3) if row.peak_bytes else "–",
            _cell(row.ratio, _three),
        ]
        rows.append(Row(row.method, cells, colours[row.method]))
    words = "Times (medians) and memory (peak of all arrays) at the scenario's own step."
    return Table(words, "method", columns, rows)


def _error_table(comparison: Comparison) -> Table:
    names = list(comparison.reference.quantities)
    columns = [
        *(Column(f"{_name(name)}, relative L2", "") for name in names),
        *(Column(f"{_name(name)}, largest", "") for name in names),
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
    for target, times in comparison.equal_error.items():
        columns += [Column(f"time to an error of {number(target, 1)}", "s"), Column("over moving-frf", "")]
        over = ratios(comparison, target)
        for name, row in cells.items():
            row += [_cell(x, _three) for x in (times[name], over[name])]
    colours = _colours(comparison)
    return Table(
        f"Time, set-up included, to equal error in {_name(comparison.main_quantity)}, read from the figure: the "
        "least on a line of the method.",
        "method",
        columns,
        [Row(name, row, colours[name]) for name, row in cells.items()],
    )


def _reference_table(comparison: Comparison) -> Table:
    movement = comparison.reference.movement
    return Table(
        "The converged answer: its movement (relative L2, the worst channel) when mesh and step were halved last, "
        "or the road made twice as long.",
        "quantity",
        [Column("movement", "")],
        [Row(_name(name), [number(value, 2)]) for name, value in movement.items()],
    )


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
            f"Error in {_name(main)} over time",
            "Each point is one run, each line one method over a range of steps; dashed lines with circles have "
            "elements of twice the length of full lines with squares. Left and down is better. Where a line "
            "crosses a dotted one the times at equal error are read; where a line turns flat something other than "
            "the step limits it: the elements, the 40 m of struck road, or the truncation.",
            figure,
        )
    ]
    if others:
        figure = blank(SIZE.single + 0.8)
        axes = figure.subplots(1, len(others), sharex=True, squeeze=False)[0]
        for ax, name in zip(axes, others, strict=True):
            _error_over_time(comparison, name, ax, targets=False)
            ax.set_title(_name(name), fontweight="bold")
        found.append(
            illustrated(
                "error-time-others",
                "Errors in the other quantities over time",
                "The same runs and colours, judged by the deflection without the static sag and by the "
                "acceleration of the wheels.",
                figure,
            )
        )
    return found


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
    ax.xaxis.set_minor_formatter("")
    return ax


def _lines(points: Sequence[Point]) -> list[list[Point]]:
    """Group points by the length of elements, longest first, and sort each group by step."""
    lines: dict[str, list[Point]] = {}
    for point in sorted(points, key=lambda point: (-point.element, -point.time_step)):
        lines.setdefault(str(point.element), []).append(point)
    return list(lines.values())


def _method(comparison: Comparison) -> list[str]:
    main = _name(comparison.main_quantity)
    methods = {name: (FOR_VEHICLE | FOR_LOADS)[name] for name in _methods(comparison)}
    lines = [f"{name}: {method.words}." for name, method in methods.items()]
    # With cdfm-weight the weight does not travel in a run of its own.
    stepped = [name for name, method in methods.items() if method.divides and name != "cdfm-weight"]
    if stepped:
        lines.append(
            f"{', '.join(stepped)}: cubic Hermite elements, average acceleration (Newmark), what is constant "
            "factorised once, ends of the road absorbing. On a road that is the same everywhere the weight travels "
            "in a run of its own and only what the roughness adds is stepped afterwards: with equal elements that "
            "is several times more accurate than stepping both together."
            if comparison.scenario.vehicle is not None
            else f"{', '.join(stepped)}: cubic Hermite elements, average acceleration (Newmark), what is constant "
            "factorised once, ends of the road absorbing."
        )
    return [
        *lines,
        "Every method gets the same cubic spline of the road's surface, with its rate of change ṙ = v r′, and "
        "includes the convective term v ∂w/∂x wherever a contact has a dashpot."
        if comparison.scenario.vehicle is not None
        else "Every method gets the same forces at its own steps.",
        "The converged answer is computed by time stepping alone, on a road that travels with the vehicle: "
        "elements and step are halved together and the answers extrapolated, (4 fine − coarse)/3, until the answer "
        "moves by less than 5 × 10⁻⁶ or five levels are done.",
        f"Times are medians of up to three runs on one thread, after a short run that is not timed; {main} decides "
        "times at equal error. Memory is the peak of all arrays, in a process of its own.",
    ]

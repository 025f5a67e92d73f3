"""A comparison as JSON and CSV."""

from __future__ import annotations

import json
import math
from typing import Any

from movingfrf._basics.arrays import finite
from movingfrf.studies.comparison.comparison import Comparison, ratios
from movingfrf.studies.comparison.convergence import refined


def as_json(comparison: Comparison) -> str:
    """Write the table as JSON: method → its figures.

    Parameters
    ----------
    comparison : Comparison
        What `compare` found.

    Returns
    -------
    str
        JSON text; a number without a finite value is null.
    """
    table = {
        row.method: {key: value for key, value in row._asdict().items() if key != "method"}
        for row in comparison.rows
    }
    return json.dumps(finite(table), indent=1) + "\n"


def convergence_as_json(comparison: Comparison) -> str:
    """Write the converged answer's movement, the error–time figure and times at equal error as JSON.

    Parameters
    ----------
    comparison : Comparison
        What `compare` found.

    Returns
    -------
    str
        JSON text; a number without a finite value is null.
    """
    reference = comparison.reference
    content = {
        "converged_answer": {
            "movement_relative_l2": reference.movement,
            "finest_time_step": reference.finest_step,
            "finest_element": reference.finest_element,
            "halved": refined(comparison.scenario.guideway),
        },
        "error_over_time": [point._asdict() for point in comparison.curve],
        "seconds_at_equal_error": {f"{target:g}": times for target, times in comparison.equal_error.items()},
        "ratio_at_equal_error": {f"{target:g}": ratios(comparison, target) for target in comparison.equal_error},
        "batch": comparison.batch,
        "seconds_at_equal_error_in_batch": {
            f"{target:g}": times for target, times in comparison.equal_error_in_batch.items()
        },
        "ratio_at_equal_error_in_batch": {
            f"{target:g}": ratios(comparison, target, in_batch=True) for target in comparison.equal_error_in_batch
        },
    }
    return json.dumps(finite(content), indent=1) + "\n"


def table_as_csv(comparison: Comparison) -> str:
    """Write the table as CSV, units in its head.

    Parameters
    ----------
    comparison : Comparison
        What `compare` found.

    Returns
    -------
    str
        CSV text.
    """
    names = list(comparison.reference.quantities)
    head = ["method", "time_step [s]", "element [m]", "setup [s]", "solve [s]", "peak memory [bytes]"]
    head += [f"relative L2 error of {name}" for name in names]
    head += [f"maximum error of {name}" for name in names]
    head += ["time over moving-frf", f"time of a case in a batch of {comparison.batch} [s]"]
    lines = [
        [
            *(row.method, row.time_step, row.element, row.setup_s, row.solve_s, row.peak_bytes),
            *(row.relative_l2[name] for name in names),
            *(row.maximum_error[name] for name in names),
            row.ratio,
            row.batch_s,
        ]
        for row in comparison.rows
    ]
    return _csv(head, lines)


def curve_as_csv(comparison: Comparison) -> str:
    """Write the error–time figure as CSV, units in its head.

    Parameters
    ----------
    comparison : Comparison
        What `compare` found.

    Returns
    -------
    str
        CSV text.
    """
    names = list(comparison.reference.quantities)
    head = [
        "method",
        "time_step [s]",
        "element [m]",
        "time [s]",
        "set-up of it [s]",
        *(f"relative L2 error of {name}" for name in names),
    ]
    lines = [
        [
            *(point.method, point.time_step, point.element, point.seconds, point.setup_s),
            *(point.relative_l2[name] for name in names),
        ]
        for point in comparison.curve
    ]
    return _csv(head, lines)


def _csv(head: list[str], lines: list[list[Any]]) -> str:
    def cell(value: Any) -> str:
        if isinstance(value, float):
            return f"{value:.9g}" if math.isfinite(value) else ""
        return str(value)

    return "\n".join(",".join(cell(value) for value in line) for line in [head, *lines]) + "\n"

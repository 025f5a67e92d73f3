"""Forces over time from files: which column is the time and which the force, and their units."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import Fault, ParameterError
from movingfrf._basics.wording import plain, told_apart
from movingfrf.roughness.formats.base import listed
from movingfrf.roughness.formats.columns import TextTable, read_table
from movingfrf.roughness.formats.roles import VOCABULARY, counts, words_of
from movingfrf.roughness.sentinels import STANDING, sentinels


class Force(NamedTuple):
    """A force at some times."""

    time: FloatArray  # (row,) [s], increasing
    force: FloatArray  # (row,) [N]


def read_force(file: Path, column: int | None, skip_lines: int) -> Force:
    """Read a force over time.

    Parameters
    ----------
    file : Path
        Text in columns.
    column : int, optional
        Number of the force's column, counted from 0; None: the first that name or unit calls a force, or else the
        first that is no time.
    skip_lines : int
        Lines at the beginning that are no part of the table.

    Returns
    -------
    Force
        At least four rows.

    Raises
    ------
    ValueError
        If there is no such column, a number is missing, or the times do not increase; with the line.
    """
    table = read_table(file, skip_lines)
    at = _time(table)
    taken = _force(table, at, column)
    table.found.require((at, taken))
    time, force = (table.found.values[:, n] for n in (at, taken))
    for n, values in ((at, time), (taken, force)):
        if (bad := np.flatnonzero(~np.isfinite(values))).size:
            raise ValueError(f"{table.place(int(bad[0]))}: expected a finite number in column {table.names[n]!r}")
    if len(time) < 4:
        raise ValueError(f"must hold at least 4 rows of time and force, got {len(time)}")
    if (bad := np.flatnonzero(np.diff(time) <= 0)).size:
        one, other = told_apart(*time[bad[0] : bad[0] + 2])
        raise ValueError(f"{table.place(int(bad[0]) + 1)}: time must increase, got {one} followed by {other}")
    for marker in sentinels(force):
        written = f"{abs(marker.value):.6f}".rstrip("0").rstrip(".")
        others = force[force != marker.value]
        # A pulse between forces that do not change may have any value.
        if STANDING.markers.fullmatch(written) and (marker.value < 0 or (others != others[:1]).any()):
            raise ValueError(
                f"{table.place(marker.first)}: {plain(marker.value)} in column {table.names[taken]!r} stands for a "
                "missing value: leave such rows out"
            )
    return Force(time * _scale(table, at, VOCABULARY.seconds), force * _scale(table, taken, VOCABULARY.newtons))


def _scale(table: TextTable, column: int, units: Mapping[str, float]) -> float:
    """Seconds or newton in the unit of a column."""
    unit = _unit(table, column)
    scale = 1.0 if unit is None else units.get(unit, units.get(unit.lower()))
    if scale is None:
        raise ValueError(f"the unit {unit!r} of column {table.names[column]!r} must be one of {', '.join(units)}")
    return scale


def _unit(table: TextTable, column: int) -> str | None:
    """Find the unit of a column: one of force may be the last word of its name too."""
    unit = table.heads[column].unit
    *before, last = re.split(r"[\s_,;]+", table.names[column].strip()) or [""]
    return unit.strip() if unit else last if before and last in VOCABULARY.newtons else None


def _time(table: TextTable) -> int:
    """Find the column of times: one that is called so and increases, best with a unit, or else the first."""
    numeric = [n for n in range(len(table.names)) if n not in table.found.texts]
    values = table.found.values
    if called := [n for n in numeric if table.heads[n].role == "time"]:
        increasing = [n for n in called if (np.diff(values[:, n]) > 0).all()]
        return min(increasing or called, key=lambda n: (table.heads[n].unit is None, n))
    if any(each.role == "time" for each in table.heads):
        raise ValueError("the times must be numbers [s]")
    able = [n for n in numeric if table.heads[n].role == "unknown" and table.heads[n].unit is None]
    if not able or able[0] != 0:
        raise ValueError(f"none of the columns {listed(table.names)} is called a time")
    if not table.named and len(able) > 2 and counts(values[:, 0]) and (np.diff(values[:, able[1]]) > 0).all():
        raise ValueError("the first column may be a time [s] or a number of the row: a line of names above tells")
    return 0


def _force(table: TextTable, time: int, column: int | None) -> int:
    """Find the column of forces."""
    able = [n for n in range(len(table.names)) if n != time and n not in table.found.texts]
    if column is not None:
        if column not in able:
            raise ParameterError([Fault("column", f"must be one of {able}, counted from 0, got {column}")])
        return column
    called = [n for n in able if _called_a_force(table, n)]
    unknown = [n for n in able if table.heads[n].role == "unknown" and table.heads[n].unit is None]
    if not called and not unknown:
        raise ValueError(f"none of the columns {listed(table.names)} is a force; column takes one by its number")
    return (called or unknown)[0]


def _called_a_force(table: TextTable, column: int) -> bool:
    words = words_of(table.names[column])
    return _unit(table, column) in VOCABULARY.newtons or any(map(VOCABULARY.force.fullmatch, words))

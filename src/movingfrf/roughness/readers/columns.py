"""Profiles in plain columns: station, elevation, and further elevations, one per path."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np

from movingfrf._checks import ParameterError
from movingfrf.roughness.profiles import Profile

# What may stand between two numbers, tried in this order; None is any white space.
SEPARATORS = {";": "semicolons", ",": "commas", "\t": "tabs", None: "spaces"}


class ReadProfile(NamedTuple):
    """A profile and a sentence about how the file was understood."""

    profile: Profile
    understood: str


def read_columns(file: str | Path) -> ReadProfile:
    """Read a profile from a text file of columns.

    The first column is the station, the others are elevations, all in metres. Columns are separated by
    commas, semicolons, tabs or spaces; lines that begin with # and empty lines are skipped, and one line of
    column names may stand first.

    Parameters
    ----------
    file : str or Path
        The file.

    Returns
    -------
    ReadProfile
        The profile, and what the reader understood.

    Raises
    ------
    ValueError
        If the file cannot be read or is not such a file, with the line that is wrong.
    """
    path = Path(file)
    try:
        text = path.read_bytes().decode("utf-8-sig")
    except OSError as error:
        raise ValueError(f"cannot read {path}: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise ValueError(f"{path} is not a text file") from None
    lines = [
        (number, line.strip())
        for number, line in enumerate(text.splitlines(), start=1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    if not lines:
        raise ValueError(f"{path} is empty: a profile needs at least four lines of station and elevation")
    separator = next(mark for mark in SEPARATORS if mark is None or mark in lines[0][1])
    # Names stand first only if nothing in that line is a number; else it is a faulty row.
    header = not any(_numbers(word, None) for word in lines[0][1].split(separator) if word.strip())
    rows: list[list[float]] = []
    for number, line in lines[1:] if header else lines:
        row = _numbers(line, separator)
        if row is None:
            raise ValueError(
                f"{path}, line {number}: expected numbers separated by {SEPARATORS[separator]}, got {line[:60]!r}"
            )
        if rows and len(row) != len(rows[0]):
            raise ValueError(f"{path}, line {number}: expected {len(rows[0])} columns as before, got {len(row)}")
        rows.append(row)
    if not rows or len(rows[0]) < 2:
        raise ValueError(f"{path}: expected a station and at least one elevation in each line")
    table = np.array(rows)
    try:
        profile = Profile(table[:, 0], table[:, 1] if table.shape[1] == 2 else table[:, 1:])
    except ParameterError as error:
        raise ValueError(f"{path}: {error}") from None
    steps = np.diff(table[:, 0])
    spacing = (
        f"{steps.mean():.4g} m" if np.ptp(steps) < 1e-6 * steps.mean() else f"{steps.min():.4g}–{steps.max():.4g} m"
    )
    understood = (
        f"{path.name}: {len(table)} stations from {table[0, 0]:g} m to {table[-1, 0]:g} m every {spacing}, "
        f"{profile.paths} path(s), elevation {table[:, 1:].min():g} to {table[:, 1:].max():g} m, "
        f"separated by {SEPARATORS[separator]}, {'one header line' if header else 'no header'}"
    )
    return ReadProfile(profile, understood)


def _numbers(line: str, separator: str | None) -> list[float] | None:
    """Numbers of one line, None if something else stands there."""
    try:
        return [float(word) for word in line.split(separator)]
    except ValueError:
        return None

"""Limits as they are written in a line: `weighted_acceleration_rms=0.5`."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any


def limits_in(lines: Iterable[str]) -> dict[Any, Any]:
    """Understand limits of measures.

    Parameters
    ----------
    lines : iterable of str
        Each `MEASURE=LIMIT`, `MEASURE:PLACE=LIMIT` of one contact or degree of freedom; the limit is an upper one,
        `LOW~` a lower one, `LOW~HIGH` both.

    Returns
    -------
    dict
        As `optimise` takes them.

    Raises
    ------
    ValueError
        If a line is none, or a measure is limited twice.

    Examples
    --------
    >>> limits_in(["weighted_acceleration_rms:cab=0.5", "smallest_contact_force=2e4~"])
    {('weighted_acceleration_rms', 'cab'): 0.5, 'smallest_contact_force': (20000.0, None)}
    """
    found: dict[Any, Any] = {}
    for line in lines:
        said, _, limit = (part.strip() for part in line.rpartition("="))
        measure, colon, where = (part.strip() for part in said.partition(":"))
        low, high = _ends(limit) if "~" in limit else (None, _number(limit))
        if not measure or (low, high) == (None, None) or (colon and not where):
            raise ValueError(
                f"--where {line} must be MEASURE=LIMIT, MEASURE=LOW~ for a lower limit, or MEASURE:PLACE=LIMIT, as "
                "weighted_acceleration_rms:cab=0.5"
            )
        name = (measure, int(where) if where.isdecimal() else where) if colon else measure
        if name in found:
            raise ValueError(f"--where {line}: {said} is limited twice")
        found[name] = (low, high) if low is not None else high
    return found


def _ends(text: str) -> tuple[float | None, float | None]:
    """Read the ends of a range; None of what is no number."""
    low, _, high = text.partition("~")
    return _number(low), _number(high)


def _number(text: str) -> float | None:
    """Read a number; None if it is none."""
    try:
        return float(text)
    except ValueError:
        return None

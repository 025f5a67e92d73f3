"""How a computation says how far it has got."""

from __future__ import annotations

from collections.abc import Callable

# Called with the name of a stage and the fraction of it that is done.
Progress = Callable[[str, float], None]


def silent(stage: str, fraction: float) -> None:
    """Report no progress."""

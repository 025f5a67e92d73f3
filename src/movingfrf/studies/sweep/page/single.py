"""One case: an answer without a figure."""

from __future__ import annotations

from typing import TYPE_CHECKING

from movingfrf.studies.sweep.page.answers import passes, worst
from movingfrf.studies.sweep.page.kind import View

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def answer(view: View) -> str:
    """Say whether the limit is passed, and how large the measure is."""
    told = worst(view.table, view.seen)
    if view.seen.limit is None:
        return told
    return f"{passes(view.seen, never=not view.seen.beyond(view.seen.worst).any())}. {told}"


def drawn(view: View) -> str:
    """Nothing is drawn."""
    return ""


def figure(view: View) -> Figure:
    """Refuse: a case has no axis."""
    raise NotImplementedError(f"one case of {view.seen.name} is no figure")

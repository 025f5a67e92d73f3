"""What a kind of figure is: how it is drawn, what it answers, what is to be known of the drawing."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Protocol

from movingfrf.studies.sweep.page.choice import Layout
from movingfrf.studies.sweep.page.seen import Seen

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure


class View(NamedTuple):
    """A measure of a sweep, as one figure has it."""

    table: xr.Dataset
    seen: Seen
    layout: Layout


class Kind(Protocol):
    """A module that draws one kind of figure."""

    def answer(self, view: View) -> str:
        """Answer the question in sentences, with numbers."""
        ...

    def drawn(self, view: View) -> str:
        """Say what is drawn."""
        ...

    def figure(self, view: View) -> Figure:
        """Draw it."""
        ...

"""What each measure depends on, as bars of the keys, the one that matters most on top."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from movingfrf.reports.figures import Illustration, blank, illustrated
from movingfrf.studies.sweep.page.words import key_in_words

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class Panel(NamedTuple):
    """The bars of one measure."""

    title: str
    keys: list[str]
    draw: Callable[[Axes], None]


def tornado(asks: str, caption: str, panels: Sequence[Panel]) -> Illustration:
    """Draw the panels, two beside each other.

    Parameters
    ----------
    asks : str
        The question.
    caption : str
        Its answer, and what is drawn.
    panels : sequence of Panel
        One for each measure.

    Returns
    -------
    Illustration
        The figure.
    """
    across = min(2, len(panels))
    down = -(-len(panels) // across)
    made = blank(down * (0.85 + 0.28 * max(len(panel.keys) for panel in panels)) + 0.1)
    grid = made.add_gridspec(down, across)
    for number, panel in enumerate(panels):
        ax = made.add_subplot(grid[number // across, number % across])
        panel.draw(ax)
        ax.set_yticks(np.arange(len(panel.keys)), list(map(key_in_words, panel.keys)))
        ax.set_ylim(len(panel.keys) - 0.5, -0.5)
        ax.set_title(panel.title)
        ax.grid(visible=False, axis="y")
    return illustrated("sweep-tornado", asks, caption, made)

"""Where the axes of a page's figure stand: room for letters is counted, so that a figure is drawn only once.

matplotlib's own layouts draw everything twice to measure it, and set powers of ten as mathematics; together that
takes four times as long as the figures. On a page the browser sets the letters anyway, in a font of its own.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from movingfrf._basics.wording import raised
from movingfrf.reports.axes import legend_rows

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure


@dataclass(frozen=True, slots=True, kw_only=True)
class Room:
    """What stands around axes takes so much [inch]; conventions, for letters of ten points."""

    letter: float = 0.085  # width of one in a tick label
    line: float = 0.17  # height of one
    tick: float = 0.1  # a tick and the gap to its label
    gap: float = 0.06  # between a tick label and the name of the axis
    title: float = 0.3
    legend: float = 0.22  # a row of it
    least: float = 0.15  # beside axes where nothing stands, and between what stands beside and the edge


ROOM = Room()


@dataclass(frozen=True, slots=True)
class Margins:
    """Room that axes need on their four sides [inch]."""

    left: float
    right: float
    below: float
    above: float


def arrange(figure: Figure) -> None:
    """Place all axes of a figure that stand in one grid, so that nothing runs into anything or out of the figure.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        The figure, complete but for this.
    """
    axes = [(ax, spec) for ax in figure.axes if (spec := ax.get_subplotspec()) is not None]
    grid = axes[0][1].get_gridspec()
    width, height = figure.get_size_inches()
    for ax, _ in axes:
        for axis in (ax.xaxis, ax.yaxis):
            _plain_powers(axis)
    # Twice: how many ticks there are follows from the size of axes, and the size from the room for their labels.
    for _ in range(2):
        needed = [(spec, _margins(ax)) for ax, spec in axes]
        columns = [[m for spec, m in needed if spec.colspan.start == column] for column in range(grid.ncols)]
        rows = [[m for spec, m in needed if spec.rowspan.start == row] for row in range(grid.nrows)]
        across = _placed(
            width,
            [max(m.left for m in column) for column in columns],
            [max(m.right for m in column) for column in columns],
            grid.get_width_ratios(),
        )
        down = _placed(
            height,
            [max(m.above for m in row) for row in rows],
            [max(m.below for m in row) for row in rows],
            grid.get_height_ratios(),
        )
        for ax, spec in axes:
            (left, wide), (top, high) = across[spec.colspan.start], down[spec.rowspan.start]
            ax.set_position((left / width, 1.0 - (top + high) / height, wide / width, high / height))
    for ax, spec in axes:
        (_, wide), (_, high) = across[spec.colspan.start], down[spec.rowspan.start]
        beside = max(
            _labels(other.yaxis, "labelleft") for other, at in axes if at.colspan.start == spec.colspan.start
        )
        ax.yaxis.set_label_coords(-(ROOM.tick + beside + ROOM.gap) / wide, 0.5)
        ax.xaxis.set_label_coords(0.5, -(ROOM.tick + ROOM.line + ROOM.gap) / high)


def _placed(whole: float, before: list[float], behind: list[float], ratios: ArrayLike) -> list[tuple[float, float]]:
    """Share out a length: where each of the axes begins and how long it is [inch]."""
    shares = np.asarray(ratios, dtype=float)
    sizes = shares / shares.sum() * max(whole - sum(before) - sum(behind), 0.1 * whole)
    ends = np.cumsum(np.array(before) + sizes + np.array(behind))
    return [(float(end - after - size), float(size)) for end, size, after in zip(ends, sizes, behind, strict=True)]


def _margins(ax: Axes) -> Margins:
    """Count what stands around some axes."""
    from matplotlib.text import Annotation

    legend, name = ax.get_legend(), ROOM.gap + ROOM.line
    names = [] if legend is None else [text.get_text() for text in legend.get_texts()]
    behind = max((len(text.get_text()) for text in ax.texts if isinstance(text, Annotation)), default=0)
    return Margins(
        left=ROOM.least + ROOM.tick + _labels(ax.yaxis, "labelleft") + name * bool(ax.get_ylabel()),
        right=ROOM.least + max(2 * ROOM.letter * behind, 0.5 * _labels(ax.xaxis, "labelbottom") - ROOM.letter),
        below=ROOM.least
        + ROOM.tick
        + ROOM.line * _labelled(ax.xaxis, "labelbottom")
        + name * bool(ax.get_xlabel()),
        above=ROOM.least + ROOM.title * bool(ax.get_title("left")) + ROOM.legend * legend_rows(names),
    )


def _labelled(axis: Axis, side: str) -> bool:
    return bool(axis.get_tick_params().get(side, True))


def _labels(axis: Axis, side: str) -> float:
    """Width of the longest tick label of an axis [inch]."""
    if not _labelled(axis, side):
        return 0.0
    low, high = sorted(axis.get_view_interval())
    slack = 1e-9 * (high - low)
    places = [place for place in axis.get_majorticklocs() if low - slack <= place <= high + slack]
    return ROOM.letter * max(map(len, axis.get_major_formatter().format_ticks(places)), default=0)


def _plain_powers(axis: Axis) -> None:
    """Let an axis write powers of ten as text."""
    from matplotlib.ticker import Formatter, LogFormatterSciNotation

    class Plain(Formatter):
        """What another formatter writes, without mathematics."""

        def __init__(self, inner: Formatter) -> None:
            self.inner = inner

        def __call__(self, x: float, pos: int | None = None) -> str:
            return plain_power(self.inner(x, pos))

        def set_locs(self, locs: list[float]) -> None:
            self.inner.set_locs(locs)

    for formatter, setter in (
        (axis.get_major_formatter(), axis.set_major_formatter),
        (axis.get_minor_formatter(), axis.set_minor_formatter),
    ):
        if isinstance(formatter, LogFormatterSciNotation):
            setter(Plain(formatter))


def plain_power(label: str) -> str:
    r"""Write a tick label of matplotlib's as text.

    Parameters
    ----------
    label : str
        What a logarithmic axis writes: mathematics between dollar signs.

    Returns
    -------
    str
        The same in letters.

    Examples
    --------
    >>> plain_power(r"$\mathdefault{10^{-3}}$"), plain_power(r"$\mathdefault{2\times10^{0}}$")
    ('10⁻³', '2×10⁰')
    """
    text = re.sub(r"\$|\\mathdefault|[{}]", "", label.replace(r"\times", "×"))
    return re.sub(r"\^([-−\d]+)", lambda found: raised(found.group(1).replace("−", "-")), text)

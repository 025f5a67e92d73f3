"""The look of the paper's figures: those of a journal, legible at the width of a column."""

from __future__ import annotations

import io
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf.reports.axes import decimated
from movingfrf.reports.curves import INK, PALETTE
from movingfrf.reports.figures import drawing, drawn_svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


# Width of a figure over two columns [inch], and the resolution of its bitmap [1/inch].
WIDTH, RESOLUTION = 7.0, 300

STYLE: dict[Any, Any] = {
    "font.size": 8.0,
    "axes.titlesize": 8.0,
    "axes.labelsize": 8.0,
    "xtick.labelsize": 7.5,
    "ytick.labelsize": 7.5,
    "legend.fontsize": 7.5,
    "legend.frameon": False,
    "lines.linewidth": 1.1,
}


class Line(NamedTuple):
    """How a curve is drawn: distinct by colour and by dashes."""

    color: str
    linestyle: Any = "-"
    linewidth: float = 1.1


BLACK = Line(INK, "-", 1.5)
BLUE, ORANGE, GREEN = (
    Line(PALETTE[0]),
    Line(PALETTE[1], (0, (5, 2))),
    Line(PALETTE[2], (0, (2, 1.2))),
)
PINK, GOLD, SKY = (
    Line(PALETTE[3], (0, (5, 1.5, 1, 1.5))),
    Line(PALETTE[4], (0, (7, 1.5))),
    Line(PALETTE[5], (0, (1, 1))),
)
LINES = (BLUE, ORANGE, GREEN, PINK, GOLD, SKY)


@contextmanager
def journal() -> Iterator[None]:
    """Draw in the paper's style, and leave matplotlib's settings as they were."""
    import matplotlib

    with drawing():
        matplotlib.rcParams.update(STYLE)
        yield


def canvas(rows: int, columns: int, height: float, **how: Any) -> tuple[Figure, list[Axes]]:
    """Make a figure of panels, each with its letter, where there are several."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(WIDTH, height), layout="constrained")
    axes = list(figure.subplots(rows, columns, squeeze=False, **how).flat)
    if len(axes) > 1:
        for letter, ax in zip("abcdefghijkl", axes, strict=False):
            ax.set_title(f"({letter})", loc="left")
    return figure, axes


def curve(ax: Axes, x: FloatArray, y: FloatArray, line: Line, label: str = "", **more: Any) -> None:
    """Draw a curve, thinned out to what the eye sees."""
    ax.plot(*decimated(np.asarray(x), np.asarray(y), buckets=1000), **line._asdict(), label=label, **more)


def legend_outside(figure: Figure, ax: Axes) -> None:
    """Name the curves of one panel above all panels that show the same ones."""
    handles, labels = ax.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=len(labels))


def logarithmic(ax: Axes) -> None:
    """Make the ordinate logarithmic, with powers of ten named only."""
    ax.set_yscale("log")
    ax.yaxis.set_minor_formatter("")


def title(ax: Axes, text: str) -> None:
    """Add words to the panel's letter."""
    letter = ax.get_title(loc="left")
    ax.set_title(f"{letter} {text}".strip(), loc="left")


def amplitude_spectrum(values: FloatArray, time_step: float) -> tuple[FloatArray, FloatArray]:
    """Frequency [Hz] and magnitude of the Fourier transform of a record [unit · s]."""
    spectrum = time_step * np.abs(np.fft.rfft(values, axis=0))
    return np.fft.rfftfreq(len(values), time_step), spectrum


def drawn(figure: Figure, key: str) -> tuple[str, bytes]:
    """Draw a figure as SVG and as a bitmap (PNG); equal figures and keys give equal files."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    svg = drawn_svg(figure, key)
    # Drawing has placed everything; doing so again would take most of the time.
    figure.set_layout_engine("none")
    figure.set_dpi(RESOLUTION)
    written = io.BytesIO()
    FigureCanvasAgg(figure).print_png(written, metadata={"Software": None})  # type: ignore[no-untyped-call]
    return svg, written.getvalue()

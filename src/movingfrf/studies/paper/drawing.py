"""The look of the paper's figures: those of a journal, legible at the width of a column."""

from __future__ import annotations

import io
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf.reports.axes import decimated
from movingfrf.reports.curves import INK, PALETTE
from movingfrf.reports.figures import drawing, drawn_svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@dataclass(frozen=True, slots=True, kw_only=True)
class JournalStyle:
    """A figure of a journal; sizes are conventions."""

    width: float = 7.0  # over two columns [inch]
    resolution: int = 300  # of the bitmap [1/inch]
    text: float = 8.0  # of titles and labels [pt]
    small: float = 7.5  # of ticks and legends [pt]
    stroke: float = 1.1  # width of a curve [pt]


JOURNAL_STYLE = JournalStyle()


class Stroke(NamedTuple):
    """How a curve is drawn: distinct by colour and by dashes."""

    color: str
    linestyle: Any = "-"
    linewidth: float = JOURNAL_STYLE.stroke


@dataclass(frozen=True, slots=True, kw_only=True)
class Strokes:
    """All strokes, by the names of their colours."""

    black: Stroke
    blue: Stroke
    orange: Stroke
    green: Stroke
    pink: Stroke
    gold: Stroke
    sky: Stroke

    @property
    def coloured(self) -> tuple[Stroke, ...]:
        """All but the black one, in the order of the palette."""
        return (self.blue, self.orange, self.green, self.pink, self.gold, self.sky)


STROKES = Strokes(
    black=Stroke(INK, "-", 1.5),
    blue=Stroke(PALETTE[0]),
    orange=Stroke(PALETTE[1], (0, (5, 2))),
    green=Stroke(PALETTE[2], (0, (2, 1.2))),
    pink=Stroke(PALETTE[3], (0, (5, 1.5, 1, 1.5))),
    gold=Stroke(PALETTE[4], (0, (7, 1.5))),
    sky=Stroke(PALETTE[5], (0, (1, 1))),
)


@contextmanager
def journal() -> Iterator[None]:
    """Draw in the paper's style, and leave matplotlib's settings as they were."""
    import matplotlib

    with drawing():
        matplotlib.rcParams.update(
            {
                "font.size": JOURNAL_STYLE.text,
                "axes.titlesize": JOURNAL_STYLE.text,
                "axes.labelsize": JOURNAL_STYLE.text,
                "xtick.labelsize": JOURNAL_STYLE.small,
                "ytick.labelsize": JOURNAL_STYLE.small,
                "legend.fontsize": JOURNAL_STYLE.small,
                "legend.frameon": False,
                "lines.linewidth": JOURNAL_STYLE.stroke,
            }
        )
        yield


def canvas(rows: int, columns: int, height: float, **how: Any) -> tuple[Figure, list[Axes]]:
    """Make a figure of panels, each with its letter, where there are several."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(JOURNAL_STYLE.width, height), layout="constrained")
    axes = list(figure.subplots(rows, columns, squeeze=False, **how).flat)
    if len(axes) > 1:
        for letter, ax in zip("abcdefghijkl", axes, strict=False):
            ax.set_title(f"({letter})", loc="left")
    return figure, axes


def curve(ax: Axes, x: FloatArray, y: FloatArray, stroke: Stroke, label: str = "", **more: Any) -> None:
    """Draw a curve, thinned out to what the eye sees."""
    ax.plot(*decimated(np.asarray(x), np.asarray(y), buckets=1000), **stroke._asdict(), label=label, **more)


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
    figure.set_dpi(JOURNAL_STYLE.resolution)
    written = io.BytesIO()
    FigureCanvasAgg(figure).print_png(written, metadata={"Software": None})  # type: ignore[no-untyped-call]
    return svg, written.getvalue()

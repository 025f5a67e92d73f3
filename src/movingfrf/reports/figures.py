"""Figures of a page: their look, their size, and how they become markup."""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from movingfrf.reports.curves import GREY, INK
from movingfrf.reports.layout import arrange

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@dataclass(frozen=True, slots=True, kw_only=True)
class FigureSize:
    """Sizes of the page's figures [inch], conventions: their width, and the height of axes as they are stacked."""

    width: float = 9.6
    single: float = 3.4  # alone in a figure
    stacked: float = 1.75  # above or below others
    panel: float = 1.55  # one of many that share an axis


SIZE = FigureSize()

# The look of the page's figures, on top of matplotlib's defaults and never on top of a user's own settings.
PAGE_STYLE: dict[Any, Any] = {
    "axes.edgecolor": GREY,
    "axes.grid": True,
    "axes.labelcolor": INK,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.titlelocation": "left",
    "axes.titlesize": 10.0,
    "axes.titley": 1.0,  # told, it is not measured
    "font.size": 10.0,
    "grid.color": "#e3e5e7",
    "grid.linewidth": 0.7,
    "legend.fontsize": 9.5,
    "lines.linewidth": 1.0,
    "svg.fonttype": "none",
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
}


class Illustration(NamedTuple):
    """A figure of the page: heading, inline SVG (markup) and caption."""

    heading: str
    svg: str
    caption: str


@contextmanager
def drawing() -> Iterator[None]:
    """Draw in the report's own style, whatever matplotlib was set to, and leave those settings as they were."""
    import matplotlib

    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(PAGE_STYLE)
        yield


def blank(height: float) -> Figure:
    """Make an empty figure of the page's width and some height [inch]."""
    from matplotlib.figure import Figure

    return Figure(figsize=(SIZE.width, height))


def drawn_svg(figure: Figure, key: str) -> str:
    """Draw a figure as SVG, a file of its own; equal figures and keys give equal text.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        The figure.
    key : str
        Makes its ids.

    Returns
    -------
    str
        The file.
    """
    import matplotlib
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    matplotlib.rcParams["svg.hashsalt"] = f"movingfrf {key}"
    written = io.StringIO()
    nothing = dict.fromkeys(("Creator", "Date", "Format", "Type"))
    FigureCanvasSVG(figure).print_svg(written, metadata=nothing)  # type: ignore[no-untyped-call]
    return written.getvalue()


def inlined(svg: str, key: str, label: str) -> str:
    """Turn an SVG file into markup for a page that holds several.

    Parameters
    ----------
    svg : str
        What `drawn_svg` returned.
    key : str
        Makes its ids unique on the page.
    label : str
        What it shows, for those who do not see it.

    Returns
    -------
    str
        Markup.
    """
    from markupsafe import Markup, escape

    svg = svg[svg.index("<svg") :]
    # Only inside tags: text between them may say whatever it likes.
    svg = re.sub(r"<[^>]+>", lambda tag: re.sub(r'(\bid="|href="#|url\(#)', rf"\1{key}-", tag.group()), svg)
    return Markup(svg.replace("<svg", f'<svg role="img" aria-label="{escape(label)}"', 1))


def illustrated(key: str, heading: str, caption: str, figure: Figure) -> Illustration:
    """Turn a figure into an illustration; `key` makes its ids unique on the page."""
    arrange(figure)
    return Illustration(heading, inlined(drawn_svg(figure, key), key, heading), caption)


def panels(count: int, draw: Callable[[int, Axes], object], colours: Sequence[str], names: Sequence[str]) -> Figure:
    """Panels of equal height below each other, on common axes."""
    figure = blank(max(SIZE.panel * count, SIZE.single - 0.4) + 0.5)
    axes = figure.subplots(count, 1, sharex=True, sharey=True, squeeze=False)[:, 0]
    for panel, ax in enumerate(axes):
        draw(panel, ax)
        ax.set_title(names[panel], color=colours[panel], fontweight="bold")
        if panel < count - 1:
            ax.set_xlabel("")
    return figure

"""Draw the rooms of the house and their arrows from the imports: `make picture` writes docs/images/rooms.svg."""

from __future__ import annotations

import sys
import textwrap
from pathlib import Path

import matplotlib as mpl
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parents[1]))

from tests.rooms import LAYERS, SOURCE, arrows  # noqa: E402

# Okabe and Ito's colours, one for the arrows that leave a room.
COLOURS = {
    "metrics": "#009E73",
    "response": "#D55E00",
    "stepping": "#0072B2",
    "reports": "#CC79A7",
    "scenarios": "#56B4E9",
    "studies": "#E69F00",
    "commands": "#222222",
}
WIDTH, HEIGHT, STEP = 2.5, 0.74, 1.5


def centres() -> dict[str, tuple[float, float]]:
    """Place every room: layers from bottom to top, rooms of a layer beside each other."""
    spread = {1: 3.1, 3: 3.6}
    places = {}
    for level, rooms in enumerate(LAYERS):
        for n, room in enumerate(rooms):
            places[room] = ((n - (len(rooms) - 1) / 2) * spread.get(level, 0.0), level * STEP)
    # What is alone in its layer stands aside, so that arrows pass it.
    places["metrics"] = (4.2, places["metrics"][1])
    places["scenarios"] = (-2.6, places["scenarios"][1])
    places["studies"] = (1.6, places["studies"][1])
    return places


def purpose(room: str) -> str:
    """First words of a room's docstring, on two lines at most."""
    text = (SOURCE / room / "__init__.py").read_text(encoding="utf-8").strip().strip('"').rstrip(".")
    return "\n".join(textwrap.wrap(text.replace("`", ""), 34, max_lines=2, placeholder=" …"))


def draw() -> str:
    """Draw the picture as SVG; equal imports give equal text."""
    places, found = centres(), arrows()
    mpl.rcParams |= {"svg.fonttype": "none", "svg.hashsalt": "rooms", "font.family": "sans-serif"}
    figure = Figure(figsize=(11.5, 10.0))
    ax = figure.add_axes((0.01, 0.01, 0.98, 0.98))
    for (upper, lower), modules in found.items():
        if lower == "_basics":  # every room uses it; its arrows would hide the others
            continue
        (x0, y0), (x1, y1) = places[upper], places[lower]
        layers = round((y0 - y1) / STEP)
        bend = 0.0 if layers == 1 else 0.12 if x1 >= x0 else -0.12
        ax.add_patch(
            FancyArrowPatch(
                (x0 + 0.3 * (x1 > x0) - 0.3 * (x1 < x0), y0 - HEIGHT / 2),
                (x1 + 0.25 * (x0 > x1) - 0.25 * (x0 < x1), y1 + HEIGHT / 2),
                connectionstyle=f"arc3,rad={bend}",
                arrowstyle="-|>,head_length=5,head_width=2.5",
                linewidth=0.7 + 0.28 * modules,
                color=COLOURS[upper],
                alpha=0.85,
                zorder=1,
            )
        )
    for room, (x, y) in places.items():
        wide = 11.6 if room == "_basics" else WIDTH
        ax.add_patch(
            FancyBboxPatch(
                (x - wide / 2, y - HEIGHT / 2),
                wide,
                HEIGHT,
                boxstyle="round,pad=0.02,rounding_size=0.08",
                facecolor="white",
                edgecolor=COLOURS.get(room, "#6b6b6b"),
                linewidth=1.6,
                zorder=2,
            )
        )
        ax.text(x, y + 0.17, room, ha="center", va="center", fontsize=13, fontweight="bold", zorder=3)
        words = "every room uses it; no arrows are drawn" if room == "_basics" else purpose(room)
        ax.text(x, y - 0.15, words, ha="center", va="center", fontsize=8, color="#444444", zorder=3)
    ax.set(xlim=(-6.0, 6.0), ylim=(-0.5, (len(LAYERS) - 1) * STEP + 0.5))
    ax.set_axis_off()
    path = HERE / "rooms.svg"
    pairs = " ".join(f"{upper}>{lower}" for upper, lower in found)
    nothing = dict.fromkeys(("Creator", "Date", "Format", "Type"))
    figure.savefig(path, metadata={**nothing, "Title": "Rooms and arrows", "Description": pairs})
    return str(path)


if __name__ == "__main__":
    print(f"wrote {draw()}")

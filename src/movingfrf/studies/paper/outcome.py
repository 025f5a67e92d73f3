"""What an item of the paper comes to: statements and whether they hold, numbers, figures, tables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

from movingfrf.reports.tables import Column

if TYPE_CHECKING:
    from matplotlib.figure import Figure


HOLDS, PARTLY, FAILS = "holds", "holds in part", "does not hold"
# Nothing to judge: the paper shows without stating, or the quick version does not go far enough; and what is shown
# beyond the paper.
UNJUDGED, SHOWN = "not judged", "shown"
JUDGED = (HOLDS, PARTLY, FAILS)

Cell = float | int | str


class Statement(NamedTuple):
    """What the paper states, what was found, and whether that agrees.

    Words in quotation marks are the paper's; "(implied)" marks what its figures or their use say without words.
    """

    stated: str
    found: str
    verdict: str
    rule: str = ""  # when it holds, and when in part


class Plot(NamedTuple):
    """A figure: the name of its files, heading, caption."""

    name: str
    heading: str
    caption: str
    figure: Figure


class DataTable(NamedTuple):
    """A table: the name of its file, caption, head and rows of a name and values; nan where there is none.

    One that is too long to be read stays a file and does not appear on the page.
    """

    name: str
    caption: str
    corner: str
    columns: Sequence[Column]
    rows: Sequence[tuple[str, Sequence[Cell]]]
    on_page: bool = True


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """What an item comes to.

    Parameters
    ----------
    statements : sequence of Statement
        What the paper states, and whether it holds.
    numbers : dict of str to float
        What was found, by name, with the unit at the end of the name where there is one.
    computed : sequence of str
        What was computed and how, in sentences.
    substitutes : sequence of str
        What stands in for something that the text of the paper does not have.
    plots : sequence of Plot
        Figures.
    tables : sequence of DataTable
        Tables.
    """

    statements: Sequence[Statement] = ()
    numbers: dict[str, float] = field(default_factory=dict)
    computed: Sequence[str] = ()
    substitutes: Sequence[str] = ()
    plots: Sequence[Plot] = ()
    tables: Sequence[DataTable] = ()


def verdict(holds: bool, partly: bool = False) -> str:
    """Put a judgement into words."""
    return HOLDS if holds else PARTLY if partly else FAILS

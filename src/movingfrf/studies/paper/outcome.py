"""What an item of the paper comes to: statements and whether they hold, numbers, figures, tables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TYPE_CHECKING, NamedTuple

from movingfrf.reports.tables import Column

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Verdict(StrEnum):
    """Whether what the paper states holds, in the words of the page."""

    HOLDS = "holds"
    PARTLY = "holds in part"
    FAILS = "does not hold"
    # Nothing to judge: the paper shows without stating, or the quick version does not go far enough.
    UNJUDGED = "not judged"
    SHOWN = "shown"  # beyond the paper


@dataclass(frozen=True, slots=True, kw_only=True)
class Agreement:
    """Up to where two results are called alike: conventions, which the rules of the statements repeat in words."""

    line_width: float = 5e-3  # a deviation over the range drawn: one that is wider than a line is visible
    one_curve: float = 1e-2  # relative L2 difference of two curves that are one to the eye
    close: float = 0.2  # relative L2 difference of two curves that are close
    suffices: float = 1e-3  # an error that is none
    considerable: float = 1e-2  # an error that is no longer small


AGREEMENT = Agreement()

Cell = float | int | str


class Statement(NamedTuple):
    """What the paper states, what was found, and whether that agrees.

    Words in quotation marks are the paper's; "(implied)" marks what its figures or their use say without words.
    """

    stated: str
    found: str
    verdict: Verdict
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


def verdict(holds: bool, partly: bool = False) -> Verdict:
    """Judge a statement that can be judged."""
    return Verdict.HOLDS if holds else Verdict.PARTLY if partly else Verdict.FAILS

"""What the commands have in common on a terminal: the console, its tables, and how far a computation has got."""

from __future__ import annotations

import io
import json
import math
import re
import sys
import textwrap
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TextIO

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Table as Grid

from movingfrf._basics.ending import pending

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    import xarray as xr

    from movingfrf.reports.tables import Column, Table
    from movingfrf.results.labels import Measure


@dataclass(frozen=True, slots=True, kw_only=True)
class Layout:
    """How tables are laid out on a console, in letters."""

    piped: int = 160  # width of the output where there is no terminal [a convention]
    head: int = 12  # what a line of a head may take, even above shorter numbers [a convention]
    # Blanks at which no line breaks: between a number and its unit, in powers of ten, in N s/m and in ISO 2631-1.
    together: str = (
        r"(?<=[\d⁰¹²³⁴⁵⁶⁷⁸⁹∞]) (?=[A-Za-zµ%°×√])|(?<=×) (?=1)|(?<=N) (?=s/)|(?<=[A-Z][A-Z]) (?=[A-Z]?\d)"
    )
    gap: int = 2  # between columns: one letter of rich's padding beside each of the two


LAYOUT = Layout()


class _Worded(Console):
    """Console that breaks sentences between words; what is longer than a line, as a path may be, stays whole."""

    def print(self, *objects: Any, hanging: int = 0, **how: Any) -> None:
        """Print as rich does, but for the sentences that are to be wrapped softly."""
        if how.get("soft_wrap") and self.is_terminal:
            objects = tuple(wrapped(one, self.width, hanging) if isinstance(one, str) else one for one in objects)
        super().print(*objects, **how)


def wrapped(text: str, across: int, hanging: int = 0) -> str:
    """Break the lines of a text between words, a number with its unit; what follows is indented alike or more."""
    lines = []
    for line in text.split("\n"):
        indent = re.match(r" *(- )?", line)
        lines += textwrap.wrap(
            re.sub(LAYOUT.together, "\u00a0", line),
            max(across, 1),
            subsequent_indent=" " * max(len(indent[0] if indent else ""), hanging),
            break_long_words=False,
            break_on_hyphens=False,
        ) or [""]
    return "\n".join(lines).replace("\u00a0", " ")


def plain_console() -> _Worded:
    """Console that prints names as they are, whatever brackets or colons they hold."""
    console = _Worded(highlight=False, markup=False, emoji=False)
    if not console.is_terminal:
        console.width = LAYOUT.piped
    return console


def for_reading(text: str, stream: TextIO) -> str:
    """Break the lines of a text between words, as wide as a terminal is."""
    return wrapped(text, Console(file=stream).width)


def hand_out(text: str) -> None:
    """Print what is to become a file: UTF-8, whatever the locale, unless it is only looked at."""
    if isinstance(sys.stdout, io.TextIOWrapper) and not sys.stdout.isatty():
        sys.stdout.reconfigure(encoding="utf-8")
    sys.stdout.write(text)


class Stages:
    """Shows which stage a computation is in, if it takes long, and remembers how long each took.

    Parameters
    ----------
    patience : float
        A computation shorter than this shows nothing [s].
    """

    def __init__(self, patience: float = 1.0) -> None:
        self.seconds: dict[str, float] = {}
        self._patience = patience
        self._began = self._since = time.perf_counter()
        self._stage = ""
        terminal = Console(stderr=True)
        self._shows = terminal.is_terminal
        self._display = Progress(
            TextColumn("{task.description}"),
            BarColumn(),
            TimeElapsedColumn(),
            console=terminal,
            transient=True,
        )
        self._task = self._display.add_task("", total=1.0)

    def __enter__(self) -> Stages:
        """Start the clock of the first stage."""
        pending.append(self._vanish)
        return self

    def __exit__(self, *_: object) -> None:
        """End the last stage and take the display away."""
        self.report("", 1.0)
        self._vanish()
        pending.remove(self._vanish)

    def _vanish(self) -> None:
        if self._display.live.is_started:
            self._display.stop()

    def report(self, stage: str, fraction: float) -> None:
        """Note that a stage has got so far."""
        now = time.perf_counter()
        if stage != self._stage:
            if self._stage:
                self.seconds[self._stage] = self.seconds.get(self._stage, 0.0) + now - self._since
            self._stage, self._since = stage, now
        if self._shows and now - self._began > self._patience and stage and not self._display.live.is_started:
            self._display.start()
        # A task that is done would stop its clock.
        self._display.update(self._task, description=stage, completed=min(fraction, 0.999))

    def table(self) -> Table:
        """Time of every stage."""
        return listing("Time", ((stage, f"{seconds:.3f} s") for stage, seconds in self.seconds.items()))


def listing(heading: str, lines: Iterable[tuple[str, str]]) -> Table:
    """Names and values under a heading: a table without heads."""
    from movingfrf.reports.tables import Column, Row, Table

    return Table(heading, "", [Column("", "", words=True)], [Row(name, [value]) for name, value in lines])


def measures_in_lines(found: Sequence[Measure]) -> Table:
    """Put measures into a table, each in a line with its unit and who defines it, below what was measured."""
    from movingfrf.reports.tables import Column, Row, Table

    rows: list[Row] = []
    above = ""
    for taken in found:
        if taken.quantity != above:
            rows.append(Row(taken.quantity, []))
        units = "" if taken.units == "1" else taken.units
        rows.append(Row(f"  {taken.name}", [cell_of(taken), units, taken.standard]))
        above = taken.quantity
    return Table("", "", [Column("value", ""), Column("unit", "", words=True), Column("by", "", words=True)], rows)


def with_names(result: xr.Dataset, found: Sequence[Measure]) -> list[Measure]:
    """Call contacts by their names too, as findings do, where measures are read and not looked up."""
    from movingfrf.results.labels import contacts_in_words

    called = contacts_in_words(result) if "contact" in result.dims else []
    words = {f"contact {number}": each for number, each in enumerate(called)}
    said = []
    for measure in found:
        place, _, kind = measure.quantity.rpartition(" ")
        said.append(measure._replace(quantity=f"{words.get(place, place)} {kind}".strip()))
    return said


def measures_in_rows(found: Sequence[Measure]) -> list[Table]:
    """Put measures into tables: one for all quantities that were measured alike, with a row for each."""
    from movingfrf.reports.tables import Column, Row, Table

    quantities: dict[str, list[Measure]] = {}
    for measure in found:
        quantities.setdefault(measure.quantity, []).append(measure)
    tables: dict[tuple[Column, ...], Table] = {}
    for quantity, taken in quantities.items():
        columns = tuple(Column(measure.name, measure.units) for measure in taken)
        table = tables.setdefault(columns, Table("", "", list(columns), []))
        table.rows.append(Row(quantity, [cell_of(measure) for measure in taken]))
    return list(tables.values())


def print_result(console: Console, result: xr.Dataset, found: Sequence[Measure]) -> None:
    """Print measures and findings."""
    print_tables(console, measures_in_rows(with_names(result, found)))
    print_findings(console, [finding["message"] for finding in json.loads(result.attrs["findings"])])


def cell_of(measure: Measure) -> str:
    """Write a number as it is typed, a dash where there is none."""
    from movingfrf._basics.wording import NEVER, is_never

    if math.isnan(measure.value):
        return "–"
    return f"< {NEVER:g}" if is_never(measure.value, measure.units) else f"{measure.value:.4g}"


def print_tables(console: Console, tables: Iterable[Table]) -> None:
    """Print tables, each with an empty line below it."""
    for table in tables:
        print_table(console, table)
        console.print()


def print_table(console: Console, table: Table) -> None:
    """Print a table, the one way in which anything in columns gets onto a console.

    Where the console is too narrow, a table is printed in pieces below each other; of one without heads, a list of
    names and values, the values take more lines instead.
    """
    heads = [_head(column) for column in table.columns]
    listed = not any(heads)
    # Beside a list of names, which has an edge and a gap, values have so much room.
    room = console.width - max((len(row.name) for row in table.rows), default=0) - LAYOUT.gap - 2
    rows = [
        [
            (wrapped(cell, room) if listed else cell) if column.words else _typed(cell)
            for column, cell in zip(table.columns, row.cells, strict=True)
        ]
        if row.cells
        else []
        for row in table.rows
    ]
    if table.caption and not listed:
        console.print(table.caption, style="bold")
    names = [table.corner, *(row.name for row in table.rows)]
    pieces = [dict(enumerate(heads))] if listed else _pieces(console.width, names, heads, rows)
    for number, piece in enumerate(pieces):
        if number:
            console.print()
        grid = Grid(
            title=table.caption if listed else None,
            title_justify="left",
            title_style="bold",
            show_header=not listed,
            box=None,
            pad_edge=listed,
        )
        grid.add_column(table.corner, no_wrap=not listed, overflow="ellipsis" if listed else "fold")
        for column, head in piece.items():
            grid.add_column(head, justify="left" if table.columns[column].words else "right", no_wrap=not listed)
        for row, cells in zip(table.rows, rows, strict=True):
            grid.add_row(row.name, *(cells[column] for column in piece if cells), style=None if cells else "bold")
        console.print(grid)


def _head(column: Column) -> str:
    """Head of a column; what has no dimension has no unit."""
    return column.name if column.units in ("", "1") else f"{column.name} [{column.units}]"


def _typed(number: str) -> str:
    """Write a number as it is typed, powers of ten too, since a console has no raised digits to speak of."""
    return number.replace(" × 10", "e").translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹−", "-0123456789-"))


def _pieces(
    across: int, names: Sequence[str], heads: Sequence[str], rows: Sequence[Sequence[str]]
) -> list[dict[int, str]]:
    """Share columns out among pieces no wider than a console: number → head of the columns of each piece."""
    bodies = [[cells[column] for cells in rows if cells] for column in range(len(heads))]
    room = across - max(map(len, names))
    roomy = (
        sum(LAYOUT.gap + max(map(len, [head, *cells])) for head, cells in zip(heads, bodies, strict=True)) <= room
    )
    pieces: list[dict[int, str]] = [{}]
    left = room
    for column, (head, cells) in enumerate(zip(heads, bodies, strict=True)):
        # Where room is short a head may take more lines than one, but no word of it breaks.
        widest = max([LAYOUT.head, *map(len, [*head.split(), *cells])])
        lines = [head] if roomy else wrapped(head, widest).split("\n")
        width = LAYOUT.gap + max(map(len, [*lines, *cells]))
        if pieces[-1] and width > left:
            pieces.append({})
            left = room
        pieces[-1][column] = "\n".join(lines)
        left -= width
    return pieces


def print_findings(console: Console, messages: list[str]) -> None:
    """Print findings, one a line, or that there are none."""
    console.print("Findings" if messages else "Findings: none", style="bold")
    for message in messages:
        console.print(f"- {message}", soft_wrap=True)

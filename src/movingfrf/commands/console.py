"""What the commands have in common on a terminal: the console, its tables, and how far a computation has got."""

from __future__ import annotations

import json
import math
import textwrap
import time
from typing import TYPE_CHECKING

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Table

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    import xarray as xr

    from movingfrf.reports.tables import Table as TableForReading
    from movingfrf.results.labels import Measure


# Raised digits and minus signs → as they are typed.
TYPED = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹−", "-0123456789-")

# Columns of the output where there is no terminal; letters of a head on one line, at least; gap between columns.
PIPED, HEAD, GAP = 160, 12, 2

# A computation shorter than this shows no progress [s].
PATIENCE = 1.0

# The most that a stage shows as done.
ALMOST = 0.999


def plain_console() -> Console:
    """Console that prints names as they are, whatever brackets or colons they hold."""
    console = Console(highlight=False, markup=False, emoji=False)
    if not console.is_terminal:
        console.width = PIPED
    return console


class Stages:
    """Shows which stage a computation is in, if it takes long, and remembers how long each took."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
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
        return self

    def __exit__(self, *_: object) -> None:
        """End the last stage and take the display away."""
        self.report("", 1.0)
        if self._display.live.is_started:
            self._display.stop()

    def report(self, stage: str, fraction: float) -> None:
        """Note that a stage has got so far."""
        now = time.perf_counter()
        if stage != self._stage:
            if self._stage:
                self.seconds[self._stage] = self.seconds.get(self._stage, 0.0) + now - self._since
            self._stage, self._since = stage, now
        if self._shows and now - self._began > PATIENCE and stage and not self._display.live.is_started:
            self._display.start()
        # A task that is done would stop its clock.
        self._display.update(self._task, description=stage, completed=min(fraction, ALMOST))

    def table(self) -> Table:
        """Time of every stage."""
        table = Table(title="Time", title_justify="left", title_style="bold", show_header=False, box=None)
        for stage, seconds in self.seconds.items():
            table.add_row(stage, f"{seconds:.3f} s")
        return table


def print_result(console: Console, result: xr.Dataset, found: list[Measure]) -> None:
    """Print measures, one table for all quantities that were measured alike, and findings."""
    quantities: dict[str, list[Measure]] = {}
    for measure in found:
        quantities.setdefault(measure.quantity, []).append(measure)
    tables: dict[tuple[str, ...], dict[str, list[str]]] = {}
    for quantity, taken in quantities.items():
        heads = tuple(_head(measure.name, measure.units) for measure in taken)
        tables.setdefault(heads, {})[quantity] = [cell_of(measure) for measure in taken]
    for heads, rows in tables.items():
        _print_columns(console, "", heads, rows)
    print_findings(console, [finding["message"] for finding in json.loads(result.attrs["findings"])])


def _head(name: str, units: str) -> str:
    """Head of a column; what has no dimension has no unit."""
    return name if units in ("", "1") else f"{name} [{units}]"


def cell_of(measure: Measure) -> str:
    """Write a number as it is typed, a dash where there is none."""
    from movingfrf._basics.wording import NEVER, is_never

    if math.isnan(measure.value):
        return "–"
    return f"< {NEVER:g}" if is_never(measure.value, measure.units) else f"{measure.value:.4g}"


def _print_columns(console: Console, corner: str, heads: Sequence[str], rows: Mapping[str, Sequence[str]]) -> None:
    """Print a table; where a console is too narrow for its columns, in pieces below each other."""
    columns: list[tuple[str, list[str]]] = []
    pieces: list[list[int]] = [[]]
    room = console.width - max(map(len, [corner, *rows]))
    left = room
    bodies = list(zip(*rows.values(), strict=True))
    roomy = sum(GAP + max(map(len, [head, *cells])) for head, cells in zip(heads, bodies, strict=True)) <= room
    for number, cells in enumerate(bodies):
        # Where room is short a head may take more lines than one, but no word of it breaks.
        widest = max(HEAD, *map(len, [*heads[number].split(), *cells]))
        lines = [heads[number]] if roomy else textwrap.wrap(heads[number], widest)
        columns.append(("\n".join(lines), list(cells)))
        width = GAP + max(map(len, [*lines, *cells]))
        if pieces[-1] and width > left:
            pieces.append([])
            left = room
        pieces[-1].append(number)
        left -= width
    for piece in pieces:
        table = Table(box=None, pad_edge=False)
        table.add_column(corner, no_wrap=True, overflow="fold")
        for number in piece:
            table.add_column(columns[number][0], justify="right", no_wrap=True)
        for at, name in enumerate(rows):
            table.add_row(name, *(columns[number][1][at] for number in piece))
        console.print(table)
        console.print()


def print_sections(console: Console, sections: list[tuple[str, list[tuple[str, str]]]]) -> None:
    """Print headings, each with lines of name and value."""
    for heading, lines in sections:
        table = Table(title=heading, title_justify="left", title_style="bold", show_header=False, box=None)
        for name, value in lines:
            table.add_row(name, value)
        console.print(table)


def print_findings(console: Console, messages: list[str]) -> None:
    """Print findings, one a line, or that there are none."""
    console.print("Findings" if messages else "Findings: none", style="bold")
    for message in messages:
        console.print(f"- {message}", soft_wrap=True)


def print_table(console: Console, table: TableForReading) -> None:
    """Print a table as the report has it."""
    console.print(table.caption, style="bold")
    heads = [_head(column.name, column.units) for column in table.columns]
    # Powers of ten as they are typed, since a console has no raised digits to speak of.
    rows = {row.name: [cell.replace(" × 10", "e").translate(TYPED) for cell in row.cells] for row in table.rows}
    _print_columns(console, table.corner, heads, rows)

"""The reproduction as files: one page, every figure, every table, and all numbers as JSON."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from movingfrf._basics.arrays import finite
from movingfrf._basics.output import Content
from movingfrf._basics.progress import Progress, silent
from movingfrf._basics.version import VERSION
from movingfrf._basics.wording import number
from movingfrf.reports.figures import inlined
from movingfrf.reports.page import rendered
from movingfrf.reports.tables import Column, Row, Table
from movingfrf.studies.paper.drawing import drawn, journal
from movingfrf.studies.paper.items import ITEMS, Reproduction, name_of
from movingfrf.studies.paper.outcome import Cell, DataTable, Outcome, Statement, Verdict
from movingfrf.studies.paper.study import SCENARIOS, scenario

# Verdict → class of its colour on the page.
CSS_CLASSES = {
    Verdict.HOLDS: "holds",
    Verdict.PARTLY: "part",
    Verdict.FAILS: "not",
    Verdict.UNJUDGED: "open",
    Verdict.SHOWN: "open",
}

NOTE = (
    "The text of the paper is at hand without its equations, figures and parameter tables. Words in quotation "
    "marks are its own; (implied) is what its figures or their use say without words. What the text does not "
    "give is substituted, and listed with each item: no number here is the paper's own unless it says so."
)


class VerdictLine(NamedTuple):
    """One statement of the verdict, with the item it belongs to."""

    name: str
    anchor: str
    statement: dict[str, str]


def command_of(key: str, quick: bool) -> str:
    """Write the command that computes one item alone."""
    return f"movingfrf paper --only {key}{' --quick' if quick else ''} --output out/{key}"


def contents(found: Reproduction, progress: Progress = silent) -> dict[str, Content]:
    """Make the page, figures, tables and numbers.

    Parameters
    ----------
    found : Reproduction
        What was computed.
    progress : callable
        Called with the name of a stage and the fraction of it that is done.

    Returns
    -------
    dict of str to str or bytes
        Files by their names, in folders.
    """
    files: dict[str, Content] = {}
    drawings: dict[str, str] = {}
    plots = [plot for outcome in found.outcomes.values() for plot in outcome.plots]
    with journal():
        for n, plot in enumerate(plots):
            progress("figures", n / len(plots))
            drawings[plot.name], files[f"figures/{plot.name}.png"] = drawn(plot.figure, plot.name)
            files[f"figures/{plot.name}.svg"] = drawings[plot.name]
    files["report.html"] = as_html(found, drawings)
    for outcome in found.outcomes.values():
        files |= {f"tables/{table.name}.csv": as_csv(table) for table in outcome.tables}
    files |= {f"scenarios/{name}.toml": scenario(name).text for name in SCENARIOS}
    return files | {"paper.json": as_json(found)}


def as_html(found: Reproduction, drawings: Mapping[str, str]) -> str:
    """Write the page.

    Parameters
    ----------
    found : Reproduction
        What was computed.
    drawings : mapping of str to str
        Name of a figure → SVG.

    Returns
    -------
    str
        One HTML page without references to anything outside it.
    """
    claims = [key for key in found.outcomes if key.startswith("claim")]
    others = [_item(key, found, drawings) for key in found.outcomes if key not in claims]
    return rendered(
        "paper.html.j2",
        title="The moving FRF, reproduced",
        version=VERSION,
        summary=tally(found),
        note=NOTE,
        claims=list(_lines(found, claims)),
        others=others,
        items=[*others, *(_item(key, found, drawings) for key in claims)],
        scenarios=[scenario(name) for name in SCENARIOS],
    )


def tally(found: Reproduction) -> str:
    """Count what holds, in sentences.

    Parameters
    ----------
    found : Reproduction
        What was computed.

    Returns
    -------
    str
        Sentences.
    """
    verdicts = [statement.verdict for outcome in found.outcomes.values() for statement in outcome.statements]
    held, partly, failed = (verdicts.count(one) for one in (Verdict.HOLDS, Verdict.PARTLY, Verdict.FAILS))
    words = (
        '"Fast calculation of vehicle–road coupled response by the moving FRF", item by item. Statements that can '
        f"be judged: {held + partly + failed}, of which {held} hold, {partly} in part and {failed} not."
    )
    return words + (" Quick version: fewer points, shorter journeys." if found.quick else "")


def _lines(found: Reproduction, keys: list[str]) -> Iterator[VerdictLine]:
    for key in keys:
        for statement in found.outcomes[key].statements:
            yield VerdictLine(name_of(key), f"item-{key}", _statement(statement))


def _statement(statement: Statement) -> dict[str, str]:
    return {**statement._asdict(), "kind": CSS_CLASSES[statement.verdict]}


def _item(key: str, found: Reproduction, drawings: Mapping[str, str]) -> dict[str, Any]:
    outcome, item = found.outcomes[key], ITEMS[key]
    return {
        "name": name_of(key),
        "anchor": f"item-{key}",
        "title": item.title,
        "place": item.place,
        "statements": [_statement(statement) for statement in outcome.statements],
        "computed": outcome.computed,
        "substitutes": outcome.substitutes,
        "command": command_of(key, found.quick),
        "figures": [
            {
                "name": plot.name,
                "heading": plot.heading,
                "caption": plot.caption,
                "svg": inlined(drawings[plot.name], plot.name, plot.heading),
            }
            for plot in outcome.plots
        ],
        "tables": [
            {**readable_table(table)._asdict(), "name": table.name} for table in outcome.tables if table.on_page
        ],
    }


def readable_table(table: DataTable) -> Table:
    """Write the values of a table for reading.

    Parameters
    ----------
    table : DataTable
        The table.

    Returns
    -------
    Table
        With text in its cells.
    """
    rows = [Row(name, [_cell(value) for value in values]) for name, values in table.rows]
    return Table(table.caption, table.corner, list(table.columns), rows)


def _cell(value: Cell) -> str:
    if isinstance(value, str):
        return value
    if math.isnan(value):
        return "–"
    return f"{value:,}".replace(",", "\u202f") if isinstance(value, int) else number(value, 3)


def as_csv(table: DataTable) -> str:
    """Write a table as CSV, units in its head; what there is not is empty.

    Parameters
    ----------
    table : DataTable
        The table.

    Returns
    -------
    str
        CSV text.
    """
    written = io.StringIO()
    writer = csv.writer(written, lineterminator="\n")
    writer.writerow([table.corner, *(_head(column) for column in table.columns)])
    for name, values in table.rows:
        writer.writerow(
            [name, *("" if isinstance(value, float) and math.isnan(value) else value for value in values)]
        )
    return written.getvalue()


def _head(column: Column) -> str:
    return f"{column.name} [{column.units}]" if column.units else column.name


def as_json(found: Reproduction) -> str:
    """Write statements, verdicts and numbers as JSON, by the items' keys.

    Parameters
    ----------
    found : Reproduction
        What was computed.

    Returns
    -------
    str
        JSON text; a number without a finite value is null.
    """
    return (
        json.dumps(
            finite(
                {
                    "movingfrf": VERSION,
                    "quick": found.quick,
                    "items": {key: _as_data(key, outcome) for key, outcome in found.outcomes.items()},
                }
            ),
            indent=1,
            ensure_ascii=False,
        )
        + "\n"
    )


def _as_data(key: str, outcome: Outcome) -> dict[str, Any]:
    item = ITEMS[key]
    return {
        "title": item.title,
        "place": item.place,
        "statements": [statement._asdict() for statement in outcome.statements],
        "numbers": outcome.numbers,
        "computed": list(outcome.computed),
        "substitutes": list(outcome.substitutes),
        "figures": [plot.name for plot in outcome.plots],
        "tables": [table.name for table in outcome.tables],
    }


def verdict_table(found: Reproduction) -> Table:
    """List the verdicts for a terminal.

    Parameters
    ----------
    found : Reproduction
        What was computed.

    Returns
    -------
    Table
        One row per item.
    """
    rows = [
        Row(
            f"{name_of(key)}: {ITEMS[key].title}",
            ["; ".join(statement.verdict for statement in outcome.statements)],
        )
        for key, outcome in found.outcomes.items()
    ]
    return Table(tally(found), "", [Column("verdict", "")], rows)

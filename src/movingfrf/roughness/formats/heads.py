"""What stands above a table: the names of its columns and their units, and lines that are neither."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

from movingfrf._basics.checks import option
from movingfrf.roughness.formats.fields import WRITING, Line, Table, grouped, is_number, split
from movingfrf.roughness.formats.roles import VOCABULARY, Head, head, kind_of_unit, unit_in


class Columns(NamedTuple):
    """Names and units of the columns of a table."""

    names: list[str]
    heads: list[Head]  # what names and units say
    lines: int  # lines of names and units
    skipped: list[Line]  # lines above them that are none
    # Units of the station and of elevations that stand elsewhere above the table; None where there are none.
    declared: tuple[str | None, str | None] = (None, None)

    @property
    def units(self) -> list[str | None]:
        """Units as they are written; None where there is none."""
        return [each.unit for each in self.heads]


class _Row(NamedTuple):
    """A line above a table, in fields."""

    line: Line
    fields: list[str]
    comment: bool
    text: str  # without the sign of a comment


def columns_of(table: Table) -> Columns:
    """Find names and units above a table.

    The line of names is the nearest to the rows that has one for each column; a line of units may stand between.
    A comment counts if it names a station or has units. What is above that is left out, if it is plain that the
    names are names.

    Parameters
    ----------
    table : Table
        Where the rows stand.

    Returns
    -------
    Columns
        One name for each column, numbers where there are no names.

    Raises
    ------
    ValueError
        If a line could be names or a damaged row, with its number.
    """
    rows = [row for line in table.above if not all(map(WRITING.ruled.fullmatch, (row := _row(line, table)).fields))]
    units = rows.pop().fields if rows and _are_units(rows[-1].fields, table) else None
    while rows and rows[-1].comment and not _tells(rows[-1], table.width):
        rows.pop()  # remarks
    named = rows.pop() if rows and (rows[-1].comment or len(rows[-1].fields) > 1) else None
    above = [row for row in rows if not row.comment]
    plain = named is not None and _tells(named, table.width)
    # A row that is damaged may look like a name, and two lines of names may be a title and names, or a damaged row.
    damaged = [field for field in named.fields if not is_number(field)] if named else []
    if named and (any(map(is_number, named.fields)) or (not plain and any(len(row.fields) > 1 for row in above))):
        raise ValueError(
            f"line {named.line.number}: expected numbers separated by {table.said}, got {named.line.text[:60]!r}"
            f"{grouped(damaged)}; {option('skip_lines')} leaves out lines above the table"
        )
    if named and len(named.fields) < table.width:
        raise ValueError(
            f"line {named.line.number}: {len(named.fields)} names for {table.width} columns separated by "
            f"{table.said}, got {named.line.text[:60]!r}"
        )
    found = _columns(named.fields if named else [], units, table.width, [row.line for row in above])
    others = [_row(line, table) for line in table.above if named is None or line is not named.line]
    return _declared(found, [row.text for row in others])


def _columns(names: list[str], units: list[str] | None, count: int, skipped: list[Line]) -> Columns:
    lines = bool(names) + (units is not None)
    if not names:
        names = [str(n) for n in range(count)]
        found = [Head("unknown", unit.strip("[]()") or None) for unit in units or [""] * count]
        return Columns(names, found, lines, skipped)
    units = [*(unit.strip("[]()") for unit in units or ()), *[""] * len(names)][: len(names)]
    found = [head(name, unit) if name else Head("counter") for name, unit in zip(names, units, strict=True)]
    return Columns([" ".join(name.split()) for name in names], found, lines, skipped)


def _declared(columns: Columns, texts: Sequence[str]) -> Columns:
    """Take in units that lines above a table tell: of each column, of station and elevations, or by name."""
    along: str | None = None
    up: str | None = None
    heads = columns.heads
    for text in texts:
        pieces = [piece for piece in re.split(r"[,;\t]|\s{2,}|\band\b|\bund\b|\bover\b", text) if piece.strip()]
        bare = [re.sub(r"^.*\bunits?\b\W*|[\[\]()\s]", "", piece, flags=re.IGNORECASE) for piece in pieces]
        kinds = [kind_of_unit(unit) for unit in bare]
        if "length" in kinds and "unknown" not in kinds and len(bare) > 1:
            if len(bare) == len(heads):
                told = zip(heads, bare, strict=True)
                heads = [each if each.unit else _with_unit(each, unit) for each, unit in told]
            elif len(bare) == 2:
                along, up = bare
            continue
        for role, unit in filter(None, map(_told, pieces if any(map(_told, pieces)) else [text])):
            along, up = (unit, up) if role == "station" else (along, unit)
    return columns._replace(heads=heads, declared=(along, up))


def _with_unit(each: Head, unit: str) -> Head:
    kind = kind_of_unit(unit)
    return Head("time" if kind == "time" else "other" if kind == "other" else each.role, unit)


def _told(text: str) -> tuple[str, str] | None:
    """Find what a remark says of a unit, `Elevation: mm`, `distance in metres`: of the station or of elevations."""
    text = re.sub(r"\bcolumn \d+\b", "", text, flags=re.IGNORECASE).strip()
    found = re.search(r"(?:[\[(]|\bin\s|[:=,;\t])\s*([^\W\d_]+)[\])]?$", text)
    if found is None or re.search(r"\d", text) or kind_of_unit(found[1]) != "length":
        return None
    role = head(re.sub(r"\bunits?\b", "", text[: found.start()], flags=re.IGNORECASE)).role
    return (role, found[1]) if role in ("station", "elevation") else None


def _row(line: Line, table: Table) -> _Row:
    text = line.text.strip()
    comment = text[:1] in WRITING.signs if table.separator != ";" or text[:1] != ";" else False
    if comment:
        text = text.lstrip(WRITING.signs).strip()
    return _Row(line, _names(text, table), comment, text)


def _names(text: str, table: Table) -> list[str]:
    """Names in a line, separated as the rows are; or else in another way that gives one for each column."""
    own = _between_spaces(text) if table.separator is None else split(text, table.separator)
    if table.closed and own and not own[-1]:
        own.pop()
    ways = [
        re.split(r"\s{2,}|\t+", text.strip()),
        [name.strip(" ;,\t") for name in re.findall(r"[^\[(]+[\[(][^\])]*[\])]", text)],
        *(split(text, separator) for separator, _ in WRITING.separators if separator),
        _between_spaces(text),
    ]
    fitting = (names for names in ways if len(names) == table.width and _station_in(names))
    return own if len(own) in (table.width, table.width + table.closed) else next(fitting, own)


def _between_spaces(text: str) -> list[str]:
    """Names with spaces between them; a bracket belongs to the name before it."""
    if '"' in text:
        return split(text, None)
    return re.findall(r"[^\s\[(]+(?:\s*(?:\[[^\]]*\]|\([^)]*\)))?|\[[^\]]*\]", text)


def _tells(row: _Row, count: int) -> bool:
    """Whether it is plain that a line holds names: enough, no numbers, a station, a time or a unit for each."""
    enough = len(row.fields) == count if row.comment else len(row.fields) >= count
    return enough and not any(map(is_number, row.fields)) and _station_in(row.fields)


def _station_in(names: Sequence[str]) -> bool:
    units = [unit_in(name) or "" for name in names]
    return any(head(name).role in ("station", "time") for name in names) or all(
        kind_of_unit(unit) != "unknown" for unit in units
    )


def _are_units(fields: Sequence[str], table: Table) -> bool:
    """Whether a line holds a unit for each column of numbers, in brackets or not, one of a length or a force."""
    of_numbers = [field for n, field in enumerate(fields) if n not in table.texts and field not in ("", "-")]
    kinds = [kind_of_unit(field.strip("[]()")) for field in of_numbers]
    telling = "length" in kinds or any(field.strip("[]()") in VOCABULARY.newtons for field in of_numbers)
    return len(fields) >= table.width and telling and "unknown" not in kinds

"""Text in columns: a station and the elevations of one path or more, as CSV files and spreadsheets have them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import chain
from pathlib import Path
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import option
from movingfrf._basics.output import Content
from movingfrf.roughness.formats.base import (
    ColumnKey,
    Format,
    RawProfile,
    Wanted,
    bytes_of,
    chosen_columns,
    listed,
    metres,
    scaled,
    units_taken,
)
from movingfrf.roughness.formats.fields import Line, Numbers, Table, as_text, find_table, line_of, numbers
from movingfrf.roughness.formats.heads import Columns, columns_of
from movingfrf.roughness.formats.roles import Head, Role, counts, kind_of_unit, scales_of, sort_out
from movingfrf.roughness.profile import Profile


class Taken(NamedTuple):
    """Columns that make a profile."""

    used: list[int]  # the station, then elevations
    timed: bool  # whether the station is a time
    left: dict[int, str]  # other columns, and why they are none


def read(path: Path, wanted: Wanted) -> RawProfile:
    """Read text in columns."""
    return table(bytes_of(path), wanted)


def table(data: bytes, wanted: Wanted) -> RawProfile:
    """Make a raw profile of text in columns.

    Parameters
    ----------
    data : bytes
        The text.
    wanted : Wanted
        Columns to take, by name or by number counted from 0: the station, then elevations; found by their names and
        units otherwise, or else by their order.

    Returns
    -------
    RawProfile
        In metres; in seconds where there are times only.

    Raises
    ------
    ValueError
        If it is no such text, with the line that is wrong.
    """
    data, encoding = as_text(data)
    data = _below(data, wanted.skip_lines)
    rows, head = _laid_out(data, encoding)
    found = numbers(data, encoding, rows, all_wanted=False)
    there = [bool(np.isfinite(column).any()) for column in found.values.T]
    if wanted.columns is not None:
        taken = _asked_for(head, wanted.columns, found.texts)
    else:
        taken = _taken(head, found.values, found.texts, there)
    found.require(taken.used)
    if wanted.units is not None:
        taken = taken._replace(timed=kind_of_unit(wanted.units[0]) == "time")
    stated = units_taken([head.units[n] for n in taken.used], wanted.units)
    try:
        scales = scales_of(stated, [f"column {head.names[n]!r}" for n in taken.used], taken.timed)
    except ValueError as error:
        raise ValueError(f"line {max(rows.first - 1, 1)}: {error}") from None

    def place(row: int) -> str:
        return f"line {line_of(data, encoding, rows, row)}"

    along, *columns = (found.values[:, n] for n in taken.used)
    elevations = [scaled(column, scale, wanted.missing) for column, scale in zip(columns, scales[1:], strict=True)]
    return RawProfile(
        scaled(along, scales[0]),
        np.stack(elevations, axis=1),
        _words(rows, head, taken, stated, wanted.skip_lines),
        place=place,
        same_across=len(taken.used) == 2,
        timed=head.names[taken.used[0]] if taken.timed else "",
    )


class TextTable(NamedTuple):
    """Columns of a text as they stand, whatever they hold."""

    names: list[str]  # numbers where there are no names
    heads: list[Head]  # what names and units say
    named: bool  # whether there are names
    found: Numbers
    place: Callable[[int], str]  # where a row stands


def read_table(file: str | Path, skip_lines: int = 0) -> TextTable:
    """Read a file of columns as it stands.

    Parameters
    ----------
    file : str or Path
        Text in columns, with or without names.
    skip_lines : int
        Lines at the beginning that are no part of the table.

    Returns
    -------
    TextTable
        All of it.

    Raises
    ------
    ValueError
        If it is no such file; with the line.
    """
    data, encoding = as_text(bytes_of(Path(file)))
    data = _below(data, skip_lines)
    rows, head = _laid_out(data, encoding)

    def place(row: int) -> str:
        return f"line {line_of(data, encoding, rows, row)}"

    return TextTable(head.names, head.heads, head.lines > 0, numbers(data, encoding, rows, all_wanted=False), place)


def made(profile: Profile, encoding: str = "") -> dict[str, Content]:
    """Make columns with commas between them, each number with all its digits; source and steps are comments."""
    elevation = profile.columns
    paths = range(elevation.shape[1])
    names = ["station [m]"] + (
        ["elevation [m]"] if profile.same_across else [f"elevation of path {p} [m]" for p in paths]
    )
    notes = [f"source: {profile.source}"] * bool(profile.source) + list(profile.steps)
    head = "".join([*(f"# {' '.join(note.split())}\n" for note in notes), ",".join(names), "\n"])
    return {"": chain([head.encode("utf-8", "replace")], rows([profile.stations, elevation], ","))}


def rows(arrays: Sequence[FloatArray], separator: str) -> Iterator[bytes]:
    """Lines of text with the columns of arrays side by side, each number with all its digits.

    Parameters
    ----------
    arrays : sequence of ndarray, shape (row,) or (row, column)
        Numbers, all with the same number of rows.
    separator : str
        What stands between two numbers.

    Yields
    ------
    bytes
        Some lines.
    """
    at_once = 100_000  # rows that are turned into text: as many as fit into memory beside the profile
    for first in range(0, len(arrays[0]), at_once):
        block = np.column_stack([array[first : first + at_once] for array in arrays])
        yield "".join(separator.join(map(repr, row)) + "\n" for row in block.tolist()).encode()


def _below(data: bytes, skipped: int) -> bytes:
    """Empty the first lines, so that those below keep their numbers."""
    if not skipped:
        return data
    kept = data.split(b"\n", skipped)
    if len(kept) <= skipped:
        raise ValueError(f"has {len(kept)} lines, and {option('skip_lines')} leaves out {skipped}")
    return b"\n" * skipped + kept[-1]


def _laid_out(data: bytes, encoding: str) -> tuple[Table, Columns]:
    """Find rows and names; there may be more names than the first row has fields."""
    rows = find_table(data, encoding)
    head = columns_of(rows)
    if len(head.names) > rows.width:
        rows = rows._replace(width=len(head.names), closed=False)
    return rows, head


def _asked_for(head: Columns, columns: Sequence[ColumnKey], texts: frozenset[int]) -> Taken:
    used = chosen_columns(head.names, columns)
    if len(used) < 2:
        raise ValueError(f"{option('columns')} must name a station and at least one elevation")
    for n in used:
        if n in texts:
            raise ValueError(f"the column {head.names[n]!r} holds no numbers")
    return Taken(used, head.heads[used[0]].role == "time", {})


def _taken(head: Columns, values: FloatArray, texts: frozenset[int], there: Sequence[bool]) -> Taken:
    """Tell station and elevations by names and units, or else by their order."""
    heads = head.heads
    left = {n: "no numbers" if n in texts else "empty" for n in range(len(heads)) if n in texts or not there[n]}
    able = [n for n in range(len(heads)) if n not in left]
    told = sort_out([heads[n] for n in able])
    elevations = [able[n] for n in told.elevations]
    station = None if told.station is None else able[told.station]
    if any(heads[n].role == "station" for n in left) and station is None:
        n = min(n for n in left if heads[n].role == "station")
        raise ValueError(f"the column {head.names[n]!r} holds no numbers that could be stations")
    timed = station is None and told.time is not None
    if timed:
        assert told.time is not None
        station = able[told.time]
    if station is None:
        unknown = [n for n in able if heads[n].role == "unknown"]
        if _counter_first(values[:, unknown]):
            left[unknown.pop(0)] = _why("counter")
        station = unknown[0] if unknown else None
    elevations = [n for n in elevations if n != station and n not in left]
    if station is None or not elevations:
        what = "a distance along the road" if station is None else "an elevation"
        raise ValueError(
            f"none of the columns {listed(head.names)} is {what}{_excuses(head, left, able)}; {option('columns')} "
            "names station and elevations"
        )
    left |= {n: _why(heads[n].role) for n in able if n not in (station, *elevations) and n not in left}
    return Taken([station, *elevations], timed, left)


def _excuses(head: Columns, left: dict[int, str], able: Sequence[int]) -> str:
    """Say of columns that are not what is looked for what they are."""
    said = {**left, **{n: _why(head.heads[n].role) for n in able if head.heads[n].role in ("counter", "other")}}
    return f" ({', '.join(f'{head.names[n]!r} is {why}' for n, why in sorted(said.items()))})" if said else ""


def _why(role: Role) -> str:
    """Say what a column is that is not taken."""
    said: dict[Role, str] = {
        "other": "no elevation",
        "time": "a time",
        "counter": "a counter",
        "station": "another station",
        "across": "a lateral position",
    }
    return said.get(role, "not called an elevation")


def _counter_first(columns: FloatArray) -> bool:
    """Whether the first of some columns without names counts, and the second is a station: it alone increases."""
    if columns.shape[1] < 3 or not counts(columns[:, 0]):
        return False
    return bool((np.diff(columns[:, 1]) > 0).all() and not (np.diff(columns[:, 2]) > 0).all())


def _words(rows: Table, head: Columns, taken: Taken, stated: Sequence[str | None], skip_lines: int) -> str:
    """Say how the columns were understood."""
    words = [f"separated by {rows.said}"]
    words += ["decimal commas"] * (rows.decimal == ",")
    words.append({0: "no header", 1: "one header line"}.get(head.lines, f"{head.lines} header lines"))
    above = skip_lines + len(head.skipped)
    words += [f"{above} {'line' if above == 1 else 'lines'} above left out"] * (above > 0)
    if rows.below:
        words.append(f"{_cited(rows.below)} below left out")
    names = head.names
    if head.lines or taken.left:
        words.append(f"columns {listed([names[n] for n in taken.used])}")
    if taken.left:
        words.append("without " + ", ".join(f"{names[n]!r} ({why})" for n, why in sorted(taken.left.items())))
    units = dict(zip(taken.used, stated, strict=True))
    if all(unit is None for unit in stated):
        words.append("no units, taken as metres")
    elif any(unit is None or metres(unit, "") != 1.0 for unit in stated[taken.timed :]):
        said = [f"{names[n]!r} {f'from {u}' if u else 'taken as metres'}" for n, u in units.items()]
        words.append(f"in metres after conversion ({', '.join(said)})")
    else:
        words.append("in metres")
    return ", ".join(words)


def _cited(lines: Sequence[Line]) -> str:
    first = lines[0].text.strip()[:40]
    return f"{first!r}" if len(lines) == 1 else f"{len(lines)} lines, {first!r} …"


# Text in columns has no signature: it is what a file is taken for that has none.
FORMAT = Format(
    "csv",
    "CSV or other text in columns",
    (".csv", ".txt", ".tsv", ".dat", ".prn", ".asc"),
    lambda head: False,
    read,
    made,
    takes=("units", "skip_lines"),
)

"""Text in columns: a station and the elevations of one path or more, as CSV files and spreadsheets have them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from itertools import chain, islice
from pathlib import Path
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray, IntArray
from movingfrf._basics.checks import option
from movingfrf._basics.output import Content
from movingfrf.roughness.formats.base import (
    ColumnKey,
    Format,
    RawProfile,
    Recording,
    Wanted,
    bytes_of,
    chosen_columns,
    chosen_recording,
    length_of,
    listed,
    metres,
    scaled,
    units_taken,
)
from movingfrf.roughness.formats.choice import Array, Choice, Series, Unclear, choose, increases, is_counter
from movingfrf.roughness.formats.fields import (
    WRITING,
    Line,
    Numbers,
    Table,
    as_text,
    bare,
    find_table,
    line_of,
    lines,
    numbers,
)
from movingfrf.roughness.formats.heads import Columns, columns_of
from movingfrf.roughness.formats.roles import Head, counts, kind_of_unit, outside, require_unit, scales_of
from movingfrf.roughness.formats.roles import head as told_by
from movingfrf.roughness.profile import Profile


class Taken(NamedTuple):
    """Columns that make a profile."""

    used: list[int]  # the station, then elevations
    timed: bool  # whether the station is a time
    left: dict[int, str]  # other columns, and why they are none
    several: bool = False  # whether the table holds other recordings too


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
    if wanted.columns is not None:
        taken = _asked_for(head, wanted.columns, found.texts)
    else:
        taken = _taken(head, found, wanted)
    found.require(taken.used)
    if wanted.units is not None:
        taken = taken._replace(timed=kind_of_unit(wanted.units[0]) == "time")
    stated = units_taken(_own_units(head, taken), wanted.units)
    if stated[0] is None:
        require_unit(head.names[taken.used[0]])
    elif stated[0].strip().lower() == "km" and _stationing(data, encoding, rows, taken.used[0]):
        stated[0] = "m"  # kilometres and metres are written out
    try:
        scales = scales_of(stated, [f"column {head.names[n]!r}" for n in taken.used], taken.timed)
    except ValueError as error:
        raise ValueError(f"line {max(rows.first - 1, 1)}: {error}") from None

    def place(row: int) -> str:
        return f"line {line_of(data, encoding, rows, int(those[row]))}"

    marked = [(), *[wanted.missing] * (len(scales) - 1)]
    values = [
        scaled(found.values[:, n], scale, markers)
        for n, scale, markers in zip(taken.used, scales, marked, strict=True)
    ]
    those: IntArray = np.arange(len(values[0]))
    if taken.several:  # the table goes on where another recording does
        those = those[: 1 + int(np.flatnonzero(np.isfinite(values).any(axis=0))[-1])]
    elif labelled := _by_label(data, encoding, rows, head, values[0]):
        runs = [Recording(name, own.size, float(np.ptp(values[0][own]))) for name, own in labelled.items()]
        those = labelled[runs[chosen_recording(runs, wanted.recording)].name]
    elif wanted.recording is not None:
        raise ValueError(f"is {FORMAT.title}, which holds one recording: {option('recording')} has no choice")
    values = [column[those] for column in values] if those.size < len(values[0]) else values
    return RawProfile(
        values[0],
        np.stack(values[1:], axis=1),
        _words(rows, head, taken, stated, found.values[:, taken.used[0]], wanted.skip_lines),
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


def _taken(head: Columns, found: Numbers, wanted: Wanted) -> Taken:
    """Tell station and elevations by names, units and values."""
    heads, values, count = head.heads, found.values, len(head.names)
    there = [bool(np.isfinite(column).any()) for column in values.T]
    left = {
        n: "holds no numbers" if n in found.texts else "is empty"
        for n in range(count)
        if n in found.texts or not there[n]
    }
    able = [n for n in range(count) if n not in left]
    series = [
        Series(head.names[n] if head.lines else "", heads[n], Array((len(values),), lambda n=n: values[:, n]))  # type: ignore[misc]
        for n in able
    ]
    if any(heads[n].role == "station" for n in left) and not any(heads[n].role == "station" for n in able):
        n = min(n for n in left if heads[n].role == "station")
        raise ValueError(f"the column {head.names[n]!r} holds no numbers that could be stations")
    try:
        choices = choose(series, ordered=True)
    except Unclear as error:
        raise ValueError(f"{error}; {option('columns')} names station and elevations") from None
    several = len(choices) > 1
    if several:
        recordings = [_recording(name, series, choice) for name, choice in choices.items()]
        choice = choices[recordings[chosen_recording(recordings, wanted.recording)].name]
    else:
        (choice,) = choices.values()
    if choice.station is None or not choice.elevations:
        what = "a distance along the road" if choice.station is None else "an elevation"
        raise ValueError(
            f"none of the columns {listed(head.names)} is {what}{_excuses(head, left, able)}; {option('columns')} "
            "names station and elevations"
        )
    used = [able[choice.station], *(able[n] for n in choice.elevations)]
    return Taken(used, choice.timed, left | _reasons(head, values, used, able), several)


def _recording(name: str, series: Sequence[Series], choice: Choice) -> Recording:
    assert choice.station is not None
    station = series[choice.station]
    along = station.values()[np.isfinite(station.values())]
    scale = length_of(station.head.unit or "m")
    return Recording(name, along.size, float("nan") if scale is None else float(np.ptp(along)) * scale)


def _reasons(head: Columns, values: FloatArray, used: Sequence[int], able: Sequence[int]) -> dict[int, str]:
    """Say why columns of numbers are not taken."""
    said = {n: _why(head.names[n], head.heads[n]) for n in able if n not in used}
    for n in said:
        if is_counter(head.names[n], head.heads[n], values[:, n]):
            said[n] = "is a counter"
        if head.heads[n].role == "label" and np.ptp(values[np.isfinite(values[:, n]), n]) > 0:
            said[n] = "changes along the way"
    return said


def _excuses(head: Columns, left: dict[int, str], able: Sequence[int]) -> str:
    """Say of columns that are not what is looked for what they are."""
    other = [n for n in able if head.heads[n].role in ("counter", "label", "other")]
    said = {**left, **{n: _why(head.names[n], head.heads[n]) for n in other}}
    return f" ({', '.join(f'{head.names[n]!r} {why}' for n, why in sorted(said.items()))})" if said else ""


def _why(name: str, told: Head) -> str:
    """Say what a column is that is not taken."""
    if told.role == "other" and told_by(outside(name)).role == "elevation":
        return f"is in {told.unit!r}, no unit of length"
    said = {
        "other": "is no elevation",
        "label": "is no elevation",
        "time": "is a time",
        "counter": "is a counter",
        "station": "is another station",
        "elevation": "is of another recording",
        "across": "is a lateral position",
    }
    return said.get(told.role, "is not called an elevation")


def _own_units(head: Columns, taken: Taken) -> list[str | None]:
    """Units that names have, or else what stands above the table."""
    along, up = head.declared
    station, *elevations = (head.units[n] for n in taken.used)
    return [station or along, *(unit or up for unit in elevations)]


def _by_label(data: bytes, encoding: str, rows: Table, head: Columns, stations: FloatArray) -> dict[str, IntArray]:
    """Find recordings below each other, which a run, a lane and the like tell apart where stations begin anew."""
    if increases(stations):
        return {}
    for n in (n for n, each in enumerate(head.heads) if each.role == "label"):
        labels = np.array(list(_fields(data, encoding, rows, n)))
        own = {label: np.flatnonzero(labels == label) for label in dict.fromkeys(labels.tolist())}
        if (
            len(labels) == len(stations)
            and 1 < len(own)
            and all(increases(stations[rows]) for rows in own.values())
        ):
            return {f"{head.names[n]} {label}": those for label, those in own.items()}
    return {}


def _stationing(data: bytes, encoding: str, rows: Table, column: int) -> bool:
    """Whether stations are written as kilometres and metres, `12+345.6`."""
    shown = islice(_fields(data, encoding, rows, column), WRITING.alike)
    return any(map(WRITING.chainage.fullmatch, shown))


def _fields(data: bytes, encoding: str, rows: Table, column: int) -> Iterator[str]:
    """Fields of a column as they are written."""
    for line in lines(data[: rows.end], encoding):
        if line.number >= rows.first and bare(line.text, rows.separator).strip():
            fields = rows.fields(line.text)
            yield fields[column] if column < len(fields) else ""


def _words(
    rows: Table, head: Columns, taken: Taken, stated: Sequence[str | None], stations: FloatArray, above: int
) -> str:
    """Say how the columns were understood."""
    words = [f"separated by {rows.said}"]
    words += ["decimal commas"] * (rows.decimal == ",")
    words.append({0: "no header", 1: "one header line"}.get(head.lines, f"{head.lines} header lines"))
    above += len(head.skipped)
    words += [f"{above} {'line' if above == 1 else 'lines'} above left out"] * (above > 0)
    if rows.below:
        words.append(f"{_cited(rows.below)} below left out")
    names = head.names
    if head.lines or taken.left:
        words.append(f"columns {listed([names[n] for n in taken.used])}")
    if taken.left:
        said = [f"{names[n]!r} ({re.sub('^(is|holds) ', '', why)})" for n, why in sorted(taken.left.items())]
        words.append(f"without {', '.join(said)}")
    units = dict(zip(taken.used, stated, strict=True))
    if head.heads[taken.used[0]] == Head("unknown") and counts(stations):
        words.append("the first column does nothing but count: taken as a distance, one unit a row")
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
    several=True,
    takes=("units", "skip_lines"),
)

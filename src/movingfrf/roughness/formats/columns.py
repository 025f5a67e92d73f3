"""Text in columns: a station and the elevations of one path or more, as CSV files and spreadsheets have them."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple, TextIO

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf.roughness.formats.base import (
    ColumnKey,
    Format,
    RawProfile,
    bytes_of,
    chosen_columns,
    listed,
    metres,
    scaled,
    unit_in,
)
from movingfrf.roughness.profile import Profile

# What may stand between two numbers, tried in this order; None is any white space.
SEPARATORS = {";": "semicolons", "\t": "tabs", ",": "commas", None: "spaces"}

# Signs that begin a comment.
COMMENTS = "#%"

NUMBER = re.compile(r"[+-]?(\d+([.,]\d*)?|[.,]\d+)([eE][+-]?\d+)?")


class ColumnLayout(NamedTuple):
    """How the numbers stand in a file."""

    separator: str | None
    decimal: str
    comment: str
    names: list[str]
    units: list[str | None]
    first: int  # number of the first line of numbers
    header: int  # number of lines of names and units


def read(path: Path, columns: Sequence[ColumnKey] | None) -> RawProfile:
    """Read text in columns; the first is the station unless `columns` says otherwise."""
    return table(bytes_of(path), columns)


def table(data: bytes, columns: Sequence[ColumnKey] | None) -> RawProfile:
    """Make a raw profile of text in columns.

    Parameters
    ----------
    data : bytes
        The text.
    columns : sequence of str or int, optional
        Columns to take, by name or by number counted from 0: the station, then elevations. All by default.

    Returns
    -------
    RawProfile
        In metres.

    Raises
    ------
    ValueError
        If it is no such text, with the line that is wrong.
    """
    data, encoding = _as_text(data)
    layout = _layout(data, encoding)
    used = list(range(len(layout.names))) if columns is None else chosen_columns(layout.names, columns)
    if len(used) < 2:
        raise ValueError("expected a station and at least one elevation in each line")
    try:
        scales = [
            1.0 if layout.units[n] is None else metres(str(layout.units[n]), f"column {layout.names[n]!r}")
            for n in used
        ]
    except ValueError as error:
        raise ValueError(f"line {max(layout.first - 1, 1)}: {error}") from None
    values = numbers(data, encoding, layout)

    def place(row: int) -> str:
        return f"line {_line_of(data, encoding, layout, row)}"

    _require_whole_rows(data, encoding, layout, values)
    stations = scaled(values[:, used[0]], scales[0])
    elevations = np.stack([scaled(values[:, n], s) for n, s in zip(used[1:], scales[1:], strict=True)], axis=1)
    return RawProfile(stations, elevations, _words(layout, used), place=place, same_across=len(used) == 2)


def read_numbers(file: str | Path) -> FloatArray:
    """Read a file of columns as it stands, whatever its numbers mean.

    Parameters
    ----------
    file : str or Path
        Text in columns, with or without names.

    Returns
    -------
    ndarray, shape (row, column)
        All of its numbers.

    Raises
    ------
    ValueError
        If it is no such file, or a field is empty; with the line.
    """
    try:
        data, encoding = _as_text(bytes_of(Path(file)))
        layout = _layout(data, encoding)
        values = numbers(data, encoding, layout)
        bad = np.flatnonzero(~np.isfinite(values).all(axis=1))
        if bad.size:
            raise ValueError(f"line {_line_of(data, encoding, layout, int(bad[0]))}: expected finite numbers only")
    except ValueError as error:
        raise ValueError(f"{file}: {error}") from None
    return values


def numbers(data: bytes, encoding: str, layout: ColumnLayout) -> FloatArray:
    """Read all numbers of a text whose layout is known.

    Parameters
    ----------
    data : bytes
        The text.
    encoding : str
        Its encoding.
    layout : ColumnLayout
        Separators, names, where the numbers begin.

    Returns
    -------
    ndarray, shape (row, column)
        Numbers; nan where a field is empty.

    Raises
    ------
    ValueError
        With the first line that is wrong.
    """
    import pandas as pd

    try:
        frame = pd.read_csv(
            io.BytesIO(memoryview(data)[_offset(data, layout.first) :]),
            sep=layout.separator or r"\s+",
            decimal=layout.decimal,
            comment=layout.comment,
            header=None,
            names=range(len(layout.names)),
            index_col=False,
            dtype=np.float64,
            encoding=encoding,
            # Before 3.1 pandas reads decimals to the last digit but one unless it is told; later it warns of that.
            float_precision="round_trip" if [int(n) for n in pd.__version__.split(".")[:2]] < [3, 1] else None,
        )
    except (ValueError, OverflowError) as error:
        raise ValueError(_first_fault(data, encoding, layout) or f"cannot be read as numbers: {error}") from None
    return frame.to_numpy()


def write(profile: Profile, path: Path, encoding: str = "") -> None:
    """Write columns with commas between them, each number with all its digits; source and steps are comments."""
    elevation = profile.columns
    paths = range(elevation.shape[1])
    names = ["station [m]"] + (
        ["elevation [m]"] if profile.same_across else [f"elevation of path {p} [m]" for p in paths]
    )
    notes = [f"source: {profile.source}"] * bool(profile.source) + list(profile.steps)
    with path.open("w", encoding="utf-8", newline="\n") as file:
        file.writelines(f"# {' '.join(note.split())}\n" for note in notes)
        file.write(",".join(names) + "\n")
        write_rows(file, [profile.stations, elevation], ",")


def write_rows(file: TextIO, arrays: Sequence[FloatArray], separator: str) -> None:
    """Write the columns of arrays side by side, each number with all its digits.

    Parameters
    ----------
    file : text file
        Where to.
    arrays : sequence of ndarray, shape (row,) or (row, column)
        Numbers, all with the same number of rows.
    separator : str
        What stands between two numbers.
    """
    at_once = 100_000  # rows that are turned into text: as many as fit into memory beside the profile
    for first in range(0, len(arrays[0]), at_once):
        block = np.column_stack([array[first : first + at_once] for array in arrays])
        file.writelines(separator.join(map(repr, row)) + "\n" for row in block.tolist())


def _as_text(data: bytes) -> tuple[bytes, str]:
    """Tell the encoding; text in two-byte characters is turned into UTF-8."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        try:
            return data.decode("utf-16").encode("utf-8"), "utf-8"
        except UnicodeError:
            raise ValueError("is not a text file") from None
    if b"\0" in data:
        raise ValueError("is not a text file")
    data = data.removeprefix(b"\xef\xbb\xbf")
    try:
        # Numbers are ASCII; only names and comments can hold anything else.
        data.decode("utf-8")
    except UnicodeDecodeError:
        return data, "latin-1"
    return data, "utf-8"


def _lines(data: bytes, encoding: str, comment: str = COMMENTS) -> Iterator[tuple[int, str]]:
    """Lines that hold something, with their numbers."""
    text = io.TextIOWrapper(io.BytesIO(data), encoding=encoding, newline=None)
    for number, line in enumerate(text, start=1):
        line = line.strip("\n")
        if line.strip() and line.lstrip()[0] not in comment:
            yield number, line


def _layout(data: bytes, encoding: str) -> ColumnLayout:
    most = 4  # lines of names, units and first numbers that tell how a file is laid out [a convention]
    looked_at: list[tuple[int, str]] = []
    for number, line in _lines(data, encoding):
        if separators := _separators(line):
            return _laid_out(data, encoding, looked_at, number, line, separators[0])
        looked_at.append((number, line))
        if len(looked_at) == most:
            break
    if not looked_at:
        raise ValueError("is empty: a profile needs at least four lines of station and elevation")
    for number, line in looked_at:
        if any(NUMBER.fullmatch(word) for word in re.split(r"[;,\s]+", line)):
            raise ValueError(
                f"line {number}: expected a station and at least one elevation, all numbers, got {line[:60]!r}"
            )
    raise ValueError(
        f"no numbers in the first {len(looked_at)} lines: expected a station and at least one elevation in each"
    )


def _separators(line: str) -> list[str | None]:
    """Separators that make a line two numbers or more; the first is the one that is meant."""
    split = {separator: _fields(line, separator) for separator in SEPARATORS}
    return [
        separator
        for separator, fields in split.items()
        if len(fields) > 1 and NUMBER.fullmatch(fields[0]) and all(map(_is_number, fields))
    ]


def _fields(line: str, separator: str | None) -> list[str]:
    fields = [field.strip() for field in line.split(separator)]
    fields = [f[1:-1].strip() if len(f) > 1 and f[0] == f[-1] == '"' else f for f in fields]
    return fields[:-1] if len(fields) > 1 and not fields[-1] and separator is not None else fields


def _is_number(field: str) -> bool:
    missing = ("", "nan", "na", "n/a", "null")  # where nothing was measured
    return bool(NUMBER.fullmatch(field)) or field.lower() in missing


def _laid_out(
    data: bytes, encoding: str, above: list[tuple[int, str]], first: int, line: str, separator: str | None
) -> ColumnLayout:
    """Say how the numbers stand that begin in a line, given the lines of names and units above it."""
    if separator == "," and "." not in line and re.search(r",\s", line) and re.search(r"\d,\d", line):
        raise ValueError(
            f"line {first}: commas with and without a space behind them, so that a decimal comma cannot be told "
            f"from a separator, got {line[:60]!r}"
        )
    # Behind an empty last field of the first line there may be a path whose first value is missing.
    count = len(_fields(line, separator))
    rows = [(number, text, _names(text, separator)) for number, text in above]
    names = [str(n) for n in range(count)] if not rows else rows[0][2]
    units: list[str | None] = [unit_in(name) for name in names] if rows else [None] * count
    if len(rows) == 2 and all(_bare_unit(field) for field in rows[1][2]):
        units = [_bare_unit(field) for field in rows[1][2]]
    for n, (number, text, fields) in enumerate(rows):
        if any(NUMBER.fullmatch(field) for field in fields) or n > 1 or (n == 1 and not all(units)):
            raise ValueError(
                f"line {number}: expected numbers separated by {SEPARATORS[separator]}, got {text[:60]!r}"
            )
        if len(fields) != len(names) or len(names) < count:
            raise ValueError(
                f"line {number}: {len(fields)} names for {count} columns separated by {SEPARATORS[separator]}, got "
                f"{text[:60]!r}"
            )
    comment = next((mark for mark in COMMENTS if data.lstrip().startswith(mark.encode())), COMMENTS[0])
    return ColumnLayout(
        separator, _decimal(data, encoding, first, separator), comment, names, units, first, len(rows)
    )


def _names(line: str, separator: str | None) -> list[str]:
    """Names of a header line; between spaces a bracket belongs to the name before it."""
    if separator is not None:
        return _fields(line, separator)
    return re.findall(r"[^\s\[(]+(?:\s*(?:\[[^\]]*\]|\([^)]*\)))?|\[[^\]]*\]", line)


def _bare_unit(field: str) -> str | None:
    """Read a unit in a line of units, with or without brackets; None if it is none."""
    unit = unit_in(field) or field
    try:
        metres(unit, "")
    except ValueError:
        return None
    return unit


def _decimal(data: bytes, encoding: str, first: int, separator: str | None) -> str:
    """Tell the decimal sign from the first line that has one."""
    if separator == ",":
        return "."
    for number, line in _lines(data, encoding):
        if number >= first and ("." in line or "," in line):
            return "." if "." in line else ","
    return "."


def _first_fault(data: bytes, encoding: str, layout: ColumnLayout) -> str | None:
    """Say which line is the first that cannot be read."""
    said = SEPARATORS[layout.separator]
    for number, line in _rows(data, encoding, layout):
        fields = _fields(line.split(layout.comment)[0], layout.separator)
        wrong = "," if layout.decimal == "." else "."
        if not all(map(_is_number, fields)) or any(wrong in field for field in fields):
            return f"line {number}: expected numbers separated by {said}, got {line[:60]!r}"
        if len(fields) > len(layout.names):
            return f"line {number}: expected {len(layout.names)} columns as before, got {len(fields)}"
        # Before 3.1 pandas does not take it for infinite.
        if any(np.isinf(float(field.replace(",", "."))) for field in fields if NUMBER.fullmatch(field)):
            return f"line {number}: station and elevation must be finite, got {line[:60]!r}"
    return None


def _offset(data: bytes, line: int) -> int:
    """Place of the first byte of a line."""
    ends = (end.end() for end in re.finditer(rb"\r\n|\n|\r", data))
    return next((end for n, end in enumerate(ends, start=2) if n == line), 0)


def _rows(data: bytes, encoding: str, layout: ColumnLayout) -> Iterator[tuple[int, str]]:
    """Lines of numbers, as they are counted in `numbers`."""
    for number, line in _lines(data, encoding, layout.comment):
        if number >= layout.first:
            yield number, line


def _line_of(data: bytes, encoding: str, layout: ColumnLayout, row: int) -> int:
    return next((number for n, (number, _) in enumerate(_rows(data, encoding, layout)) if n == row), -1)


def _require_whole_rows(data: bytes, encoding: str, layout: ColumnLayout, values: FloatArray) -> None:
    """Tell fields that are empty from fields that are not there, which counts as damage."""
    incomplete = np.flatnonzero(np.isnan(values[:, -1]))
    if not incomplete.size:
        return
    left = set(incomplete.tolist())
    for row, (number, line) in enumerate(_rows(data, encoding, layout)):
        if row in left:
            left.remove(row)
            # A separator at the end of a line closes it, or opens an empty field.
            count = len(line.split(layout.comment)[0].split(layout.separator))
            if count < len(layout.names):
                raise ValueError(f"line {number}: expected {len(layout.names)} columns as before, got {count}")
            if not left:
                return


def _words(layout: ColumnLayout, used: Sequence[int]) -> str:
    words = [f"separated by {SEPARATORS[layout.separator]}"]
    words += ["decimal commas"] * (layout.decimal == ",")
    words.append({0: "no header", 1: "one header line"}.get(layout.header, f"{layout.header} header lines"))
    if layout.header:
        words.append(f"columns {listed([layout.names[n] for n in used])}")
    units = {n: layout.units[n] for n in used}
    if all(unit is None for unit in units.values()):
        words.append("no units, taken as metres")
    elif any(unit is None or metres(unit, "") != 1.0 for unit in units.values()):
        said = [f"{layout.names[n]!r} {f'from {u}' if u else 'taken as metres'}" for n, u in units.items()]
        words.append(f"in metres after conversion ({', '.join(said)})")
    else:
        words.append("in metres")
    return ", ".join(words)


# Text in columns has no signature: it is what a file is taken for that has none.
FORMAT = Format(
    "csv",
    "CSV or other text in columns",
    (".csv", ".txt", ".tsv", ".dat", ".prn", ".asc"),
    lambda head: False,
    read,
    write,
)

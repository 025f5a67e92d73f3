"""Text as a table of fields: what separates them, where its rows begin and end, and the numbers in them."""

from __future__ import annotations

import csv
import io
import re
import warnings
from array import array
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray, IntArray
from movingfrf._basics.checks import option


@dataclass(frozen=True, slots=True, kw_only=True)
class Writing:
    """How numbers, what is missing, and comments are written; and how much of a text tells what it is like."""

    # What may stand between two fields, tried in this order, and what it is called; None is any white space.
    separators: tuple[tuple[str | None, str], ...] = (
        (";", "semicolons"),
        ("\t", "tabs"),
        (",", "commas"),
        ("|", "vertical bars"),
        (None, "spaces"),
    )
    # Fortran writes D for E, and leaves it out before an exponent of three digits.
    number: re.Pattern[str] = re.compile(
        r"[+\-−]?(\d+([.,]\d*)?|[.,]\d+)([eEdD][+\-−]?\d+)?|[+-]?\d*[.,]\d+[+-]\d{3}", re.ASCII
    )
    # Stationing: whole kilometres and metres, or hundreds of feet and feet.
    chainage: re.Pattern[str] = re.compile(r"(\d+)\+(\d{2,3})([.,]\d+)?", re.ASCII)
    # Programs' words for no value, signs that people put there, and what a spreadsheet or Fortran has for an error.
    missing: re.Pattern[str] = re.compile(
        r"|[-+]?nan(\(\w*\))?|[-+]?1\.#(ind|qnan)0*|n[/.]?a\.?|n\.?d\.?|nil|null|none|void|missing|no ?data|fehlt|"
        r"k\.? ?a\.?|<na>|[-–—]+|\?+|\*+|\.+|_+|#n/?[av]|#(value|ref|div/0|num|null|name|wert|bezug|zahl)[!?]",
        re.IGNORECASE,
    )
    # Of these the C parser knows the usual ones; the others are read line by line.
    markers: tuple[str, ...] = ("-", "--", "---", "?", "*", "**", "***", ".", "null", "NIL", "na", "N.A.", "n.a.")
    # Whole words: a fault of one letter in a number is none.
    footer: re.Pattern[str] = re.compile(r"[^\W\d_]{2,}[^\d]*")
    word: re.Pattern[str] = re.compile(r"\(?[^\W\d_]{2,}[.,:;)]*")
    ruled: re.Pattern[str] = re.compile(r"[-=_*]{2,}")
    thousands: re.Pattern[str] = re.compile(r"[+-]?\d{1,3}([.,' ])\d{3}(\1\d{3})*([.,]\d+)?")
    # Signs that begin a comment, wherever they stand or behind a blank or a separator; not within quotation marks.
    comment: re.Pattern[str] = re.compile(
        r'"[^"]*"|((?<!\d\.)#(?!N/?[AV]|VALUE|REF|DIV|NUM|NULL|NAME|WERT|BEZUG|ZAHL).*|(?:^|(?<=[\s,;]))(?:[%!]|//).*)'
    )
    signs: str = "#%!/;*"  # of comments that may hold names
    # Of these the C parser takes what begins a comment for one.
    sharp: re.Pattern[bytes] = re.compile(rb"\d\.#|#(N/?[AV]|VALUE|REF|DIV|NUM|NULL|NAME|WERT|BEZUG|ZAHL)")
    closing: re.Pattern[str] = re.compile(r'"[^"]*"|((?:^|(?<=\s));.*)')  # where semicolons separate nothing
    looked_at: int = 400  # lines that show where the table begins [a preamble is shorter; 50 to 10 000]
    alike: int = 8  # rows of which half make a table where some columns hold text [4 to 20]
    tail: int = 2**16  # bytes at the end in which rows that are none are looked for [a convention]
    opened: re.Pattern[str] = re.compile(r'(?:^|[;,\t])\s*"(?:[^"]|"")*$')  # a mark that is not closed in its line
    joined: int = 20  # lines that a field in quotation marks may have [a convention]


WRITING = Writing()


class Line(NamedTuple):
    """A line that holds something; one whose quotation marks hold line ends is several."""

    number: int  # counted from 1
    text: str


class Table(NamedTuple):
    """Where the rows of a text stand, and what separates their fields."""

    separator: str | None
    decimal: str
    comment: str  # the sign of comments for the C parser
    width: int  # columns
    closed: bool  # whether a separator stands behind the last field too
    texts: frozenset[int]  # columns that hold no numbers
    first: int  # number of the first line of the rows
    above: list[Line]  # what stands above it, comments included
    below: list[Line]  # what stands below the last row and is none
    end: int | None = None  # place of the first byte below the rows

    @property
    def said(self) -> str:
        """What separates the fields."""
        return dict(WRITING.separators)[self.separator]

    def fields(self, text: str) -> list[str]:
        """Fields of a row."""
        found = split(bare(text, self.separator), self.separator)
        return found[:-1] if self.closed and len(found) > 1 and not found[-1] else found


class Numbers(NamedTuple):
    """What the rows of a table hold."""

    values: FloatArray  # (row, column), nan where there is no number
    texts: frozenset[int]  # columns that hold no numbers
    faults: Mapping[int, Line] = {}  # of the other columns that hold a text somewhere: where, and what to say of it

    def require(self, columns: Iterable[int]) -> None:
        """Refuse a text among the numbers of some columns."""
        if faults := [self.faults[n] for n in columns if n in self.faults]:
            raise ValueError(f"line {min(faults).number}: {min(faults).text}")


def as_text(data: bytes) -> tuple[bytes, str]:
    """Tell the encoding; text in two-byte characters is turned into UTF-8.

    Parameters
    ----------
    data : bytes
        What a file holds.

    Returns
    -------
    bytes, str
        The text without a byte order mark, and its encoding.

    Raises
    ------
    ValueError
        If it is no text.
    """
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        try:
            data = data.decode("utf-16").encode("utf-8")
        except UnicodeError:
            raise ValueError("is not a text file") from None
    data = data.removeprefix(b"\xef\xbb\xbf").rstrip(b"\x1a")  # the end of a file of DOS
    if b"\0" in data:
        raise ValueError("is not a text file")
    if b"\n" not in data:
        data = data.replace(b"\r", b"\n")
    try:
        # Numbers are ASCII; only names and comments can hold anything else.
        data.decode("utf-8")
    except UnicodeDecodeError:
        return data, "latin-1"
    return data, "utf-8"


def lines(data: bytes, encoding: str) -> Iterator[Line]:
    """Lines that hold something, with their numbers; those that quotation marks hold together are one."""
    text = io.TextIOWrapper(io.BytesIO(data), encoding=encoding, newline=None)
    numbered = enumerate(text, start=1)
    for number, line in numbered:
        parts = [line.rstrip("\n")]
        if line.count('"') % 2 and WRITING.opened.search(line):
            while line.count('"') % 2 and len(parts) < WRITING.joined and (more := next(numbered, None)):
                parts.append(more[1].rstrip("\n"))
                line += more[1]
        if any(part.strip() for part in parts):
            yield Line(number, "\n".join(parts))


def bare(text: str, separator: str | None) -> str:
    """Leave out the comment of a line."""
    if not any(sign in text for sign in "#%!/;"):
        return text
    patterns = [WRITING.comment] if separator == ";" else [WRITING.comment, WRITING.closing]
    for pattern in patterns:
        text = next((text[: found.start()] for found in pattern.finditer(text) if found[1] is not None), text)
    return text


def split(text: str, separator: str | None) -> list[str]:
    """Fields of a line, those in quotation marks by RFC 4180; without the blanks around them."""
    if separator is None:
        words = text.split() if '"' not in text else re.findall(r'"(?:[^"]|"")*"|[^\s"]+', text)
        return [word[1:-1].replace('""', '"').strip() if word[0] == '"' else word for word in words]
    if '"' not in text:
        return [field.strip() for field in text.split(separator)]
    try:
        rows = list(csv.reader([text], delimiter=separator, skipinitialspace=True, strict=True))
    except csv.Error:
        return [field.strip() for field in text.split(separator)]
    return [field.strip() for field in rows[0]] if len(rows) == 1 else text.split(separator)


def is_number(field: str) -> bool:
    """Whether a field holds a number, whatever its decimal sign."""
    return WRITING.number.fullmatch(field) is not None or WRITING.chainage.fullmatch(field) is not None


def is_missing(field: str) -> bool:
    """Whether a field says that there is no value."""
    return WRITING.missing.fullmatch(field) is not None


def number_in(field: str, decimal: str) -> float | None:
    """Read the number in a field, nan where it says that there is none; None if it is neither."""
    if WRITING.number.fullmatch(field):
        if ("," if decimal == "." else ".") in field:
            return None
        word = field.replace(",", ".").replace("−", "-")
        # Fortran: 1.5D+02, and 1.5-103 without a letter.
        word = re.sub(r"(?<=[\d.])[dD]|(?<=[\d.])(?=[+-]\d{3}$)", "e", word)
        return float(word)
    if is_missing(field):
        return float("nan")
    if field.lower().lstrip("+-") in ("inf", "infinity"):
        return float("inf")
    if (whole := WRITING.chainage.fullmatch(field)) and not (whole[3] or decimal).startswith(
        "," if decimal == "." else "."
    ):
        return float(whole[1]) * 10 ** len(whole[2]) + float(whole[2] + (whole[3] or "").replace(",", "."))
    return None


def find_table(data: bytes, encoding: str) -> Table:
    """Find the rows of a text.

    They begin at the first line of two numbers or more and nothing else, or where several lines in a row have
    numbers and texts at the same places. They end above lines that begin with a word, or hold nothing.

    Parameters
    ----------
    data : bytes
        The text.
    encoding : str
        Its encoding.

    Returns
    -------
    Table
        Where and how the rows stand.

    Raises
    ------
    ValueError
        If there is no table, with the line that comes nearest to one.
    """
    shown = list(islice(lines(data, encoding), WRITING.looked_at))
    asked = re.fullmatch(r"\"?sep=(.)\"?[;,\t]*\s*", shown[0].text, re.IGNORECASE) if shown else None
    candidates: tuple[str | None, ...] = tuple(separator for separator, _ in WRITING.separators)
    if asked and asked[1] in candidates:
        candidates = (asked[1],)
        shown = shown[1:]
    for n, line in enumerate(shown):
        for separator in candidates:
            fields = split(bare(line.text, separator), separator)
            if len(fields) > 1 and "t" not in _kinds(fields) and _kinds(fields).count("n") > 1:
                return _table(data, encoding, shown, n, separator)
        most = max(candidates, key=lambda separator: _in_common(shown[n:], separator))
        if _in_common(shown[n:], most):
            return _table(data, encoding, shown, n, most)
    plain = [line for line in shown if bare(line.text, None).strip()]
    if not plain:
        raise ValueError("is empty: there must be at least four lines of numbers")
    for line in plain[:4]:
        if any(is_number(word) for word in re.split(r"[;,\s]+", line.text) if word):
            raise ValueError(
                f"line {line.number}: expected two numbers or more, got "
                f"{line.text[:60]!r}{grouped([field for field in line.text.split(';') if not is_number(field)])}"
            )
    raise ValueError(
        f"no numbers in the first {len(plain)} lines: expected two or more in each"
        + (f"; {option('skip_lines')} leaves out more above the table" if len(shown) == WRITING.looked_at else "")
    )


def numbers(data: bytes, encoding: str, table: Table, *, all_wanted: bool = True) -> Numbers:
    """Read the rows of a table whose place is known.

    Parameters
    ----------
    data : bytes
        The text.
    encoding : str
        Its encoding.
    table : Table
        Where and how the rows stand.
    all_wanted : bool
        Whether a text among the numbers of any column is refused, or told as that column's fault.

    Returns
    -------
    Numbers
        All of them.

    Raises
    ------
    ValueError
        With the first line that is wrong.
    """
    # What the C parser does not read as it stands is read line by line: slow, but it says what is wrong.
    values = _fast(data, encoding, table)
    found = _line_by_line(data, encoding, table) if values is None else Numbers(values, table.texts)
    if all_wanted:
        found.require(range(table.width))
    return found


def line_of(data: bytes, encoding: str, table: Table, row: int) -> int:
    """Give the number of the line where a row stands, counted from 0."""
    return next((line.number for line in islice(_rows(data, encoding, table), row, None)), -1)


def _kinds(fields: Sequence[str]) -> str:
    """Say of each field whether it is a number, missing, or a text: n, m, t."""
    return "".join("n" if is_number(f) else "m" if is_missing(f) else "t" for f in fields)


def _in_common(shown: Sequence[Line], separator: str | None) -> int:
    """Count the columns of numbers where some lines have numbers and texts at the same places; 0 if they have not.

    Where something is missing in the first line, or is text, others tell whether it is the first row of a table.
    """
    first = split(bare(shown[0].text, separator), separator)
    if len(first) < 2 or "n" not in _kinds(first):
        return 0
    bared = (bare(line.text, separator) for line in shown)
    rows = [split(text, separator) for text in islice((text for text in bared if text.strip()), WRITING.alike)]
    alike = [_kinds(row) for row in rows if _same_places(_kinds(first), _kinds(row))]
    if len(alike) < max(2, len(rows) / 2):
        return 0
    columns = ["".join(column) for column in zip(*alike, strict=True)]
    able = sum("t" not in kinds for kinds in columns)
    return sum("n" in kinds for kinds in columns) if able > 1 else 0


def _same_places(one: str, other: str) -> bool:
    """Whether two rows have numbers and texts at the same places, as far as nothing is missing."""
    return len(one) == len(other) and all(a == b or "m" in (a, b) for a, b in zip(one, other, strict=True))


def _table(data: bytes, encoding: str, shown: Sequence[Line], at: int, separator: str | None) -> Table:
    first = shown[at]
    unquoted = re.sub(r'"[^"]*"', "", first.text)
    if separator == "," and "." not in unquoted and re.search(r",\s", unquoted) and re.search(r"\d,\d", unquoted):
        raise ValueError(
            f"line {first.number}: commas with and without a space behind them, so that a decimal comma cannot be "
            f"told from a separator, got {first.text[:60]!r}"
        )
    rows = [split(text, separator) for line in shown[at:] if (text := bare(line.text, separator)).strip()]
    count = len(rows[0])
    closed = separator is not None and count > 2 and all(not row[-1] for row in rows)
    count -= closed
    kinds = [_kinds(row) for row in rows if len(row) >= count]
    found = [[row[n] for row in kinds] for n in range(count)]
    texts = frozenset(n for n, column in enumerate(found) if column.count("t") > column.count("n"))
    signs = [
        field
        for row in rows
        for n, field in enumerate(row[:count])
        if n not in texts and is_number(field) and ("," in field or "." in field)
    ]
    decimal = "," if signs and "," in signs[0] else "."
    comment = "%" if data.lstrip().startswith(b"%") else "#"
    table = Table(separator, decimal, comment, count, closed, texts, first.number, list(shown[:at]), [])
    return _ended(data, encoding, table)


def _ended(data: bytes, encoding: str, table: Table) -> Table:
    """Find what stands below the rows: lines that begin with a word, or hold nothing."""
    # Empty cells below may be as many as a spreadsheet has rows.
    full = len(data.rstrip(b" \t,;|\r\n"))
    empty = data[full:].partition(b"\n")[2]
    below = [Line(0, row) for row in empty.decode().splitlines() if row.strip()][::-1]
    end = place = len(data) - len(empty) if below else len(data)
    begin = max(place - WRITING.tail, _offset(data, table.first))
    tail = data[begin:place].splitlines(keepends=True)
    for raw in reversed(tail[1:]):
        place -= len(raw)
        text = raw.decode(encoding, "replace").rstrip("\r\n")
        if text.count('"') % 2:  # the end of a field of several lines
            break
        fields = table.fields(text)
        if not any(fields):
            if text.strip():  # a row of empty cells
                below.append(Line(0, text))
                end = place
        elif _is_footer(fields, text, table):
            below.append(Line(0, text))
            end = place
        else:
            break
    return table._replace(below=below[::-1], end=end) if below else table


def _is_footer(fields: Sequence[str], text: str, table: Table) -> bool:
    """Whether a line below a table begins with a word where rows have a number, or is a sentence."""
    if all(map(WRITING.ruled.fullmatch, fields)):
        return True
    # What stands in a column of texts is no word where rows have a number.
    own = [field for n, field in enumerate(fields) if n not in table.texts or len(fields) == 1]
    words = [field for field in own if field and not is_missing(field)]
    if own and not is_number(own[0]) and words and WRITING.footer.fullmatch(words[0]):
        return True
    # A row that is cut short holds no words, unless some of its columns do.
    said = [WRITING.word.fullmatch(word) is not None for word in text.split() if not is_missing(word)]
    sentence = len(fields) != table.width and sum(said) > 1 and not table.texts
    return sentence or (len(fields) == 1 and said[:1] == [True])


def _fast(data: bytes, encoding: str, table: Table) -> FloatArray | None:
    """Read rows by the C parser of pandas; None where anything about them is unusual."""
    import pandas as pd

    body = memoryview(data)[_offset(data, table.first) : table.end]
    # A quotation mark that is not closed in its line would swallow others.
    if b'"' in data and not all(map(_quoting(table.separator).fullmatch, io.BytesIO(body))):
        return None
    if b"#" in data and WRITING.sharp.search(body):
        return None
    if not table.texts and re.search(rb"[\d.][dD][+-]?\d", body[:1000]):
        body = memoryview(bytes(body).translate(bytes.maketrans(b"Dd", b"Ee")))  # exponents as Fortran writes them
    count = table.width + table.closed
    texts = {*table.texts, *range(table.width, count)}
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            frame = pd.read_csv(
                io.BytesIO(body),
                sep=table.separator or r"\s+",
                decimal=table.decimal,
                comment=table.comment,
                header=None,
                names=range(count),
                index_col=False,
                skipinitialspace=True,
                na_values=WRITING.markers,
                dtype={n: "category" if n in texts else np.float64 for n in range(count)},
                encoding=encoding,
                # Before 3.1 pandas reads decimals to the last digit but one unless told; later it warns of that.
                float_precision="round_trip" if [int(n) for n in pd.__version__.split(".")[:2]] < [3, 1] else None,
            )
    except (ValueError, OverflowError, Warning):
        return None
    if table.closed and frame.pop(table.width).notna().any():
        return None
    incomplete = np.flatnonzero(frame[table.width - 1].isna().to_numpy())
    if incomplete.size and (
        frame.iloc[incomplete].isna().all(axis=1).any()  # some line ends make two rows of one
        or not _whole(data, encoding, table, incomplete)
    ):
        return None
    values = np.full(frame.shape, np.nan, order="F")  # column by column, as they were read
    for n in set(range(table.width)) - table.texts:
        values[:, n] = frame[n].to_numpy()
    return values


def _quoting(separator: str | None) -> re.Pattern[bytes]:
    """Match a line whose quotation marks, if it has any, enclose whole fields."""
    sign = rb"\s" if separator is None else re.escape(separator.encode())
    field = rb'(?:[ ]*+"(?:[^"\n]|"")*+"[ ]*+|[^"\n%s]*+)' % sign
    return re.compile(rb"%s(?:%s%s)*+[\r\n]*+" % (field, sign, field))


def _whole(data: bytes, encoding: str, table: Table, rows: IntArray) -> bool:
    """Tell fields that are empty, in some rows, from fields that are not there, which counts as damage."""
    left = set(rows.tolist())
    for row, line in enumerate(_rows(data, encoding, table)):
        if row in left:
            left.remove(row)
            if len(table.fields(line.text)) != table.width:
                return False
            if not left:
                return True
    return False


def _line_by_line(data: bytes, encoding: str, table: Table) -> Numbers:
    """Read rows one by one; a column of more texts than numbers holds none, other texts are its fault."""
    values = array("d")
    texts: dict[int, Line] = {}
    there = [0] * table.width
    fault = None
    for line in _rows(data, encoding, table):
        fields = table.fields(line.text)
        if len(fields) != table.width:
            fault = Line(line.number, f"expected {table.width} columns as before, got {len(fields)}")
            break
        if any(_is_row(part, table) for field in fields for part in field.split("\n")[1:]):
            fault = Line(line.number, f"a quotation mark is not closed in its line, got {line.text[:60]!r}")
            break
        for n, field in enumerate(fields):
            value = number_in(field, table.decimal)
            if value is None:
                texts.setdefault(n, line)
                there[n] -= 1
                value = float("nan")
            elif value == value:
                there[n] += 1
            values.append(value)
    left = frozenset(n for n in texts if there[n] < 0 or n in table.texts)
    faults = {n: Line(line.number, _unreadable(line, table)) for n, line in texts.items() if n not in left}
    if fault:
        first = min([*faults.values(), fault])
        raise ValueError(f"line {first.number}: {first.text}")
    return Numbers(np.array(values).reshape(-1, table.width), left, faults)


def _is_row(text: str, table: Table) -> bool:
    """Whether a line within quotation marks looks like a row that they swallowed."""
    kinds = _kinds(split(text, table.separator))
    return kinds.count("n") > 1 or (len(kinds) == table.width and "n" in kinds)


def _unreadable(line: Line, table: Table) -> str:
    fields = table.fields(line.text)
    said = f"expected numbers separated by {table.said}, got {line.text[:60]!r}"
    if not any(map(is_number, fields)):  # like names
        above = line.number - table.first < WRITING.alike
        skip = f"{option('skip_lines')} leaves out lines above the table"
        return f"{said}; {skip if above else 'a second table would need a file of its own'}"
    return said + grouped([field for field in fields if number_in(field, table.decimal) is None])


def grouped(fields: Sequence[str]) -> str:
    """Say that thousands are separated, where one of the fields that are damaged looks like it."""
    found = any(WRITING.thousands.fullmatch(field.strip()) for field in fields)
    return "; what separates thousands cannot be told from a decimal sign" if found else ""


def _offset(data: bytes, line: int) -> int:
    """Place of the first byte of a line."""
    if line == 1:
        return 0
    ends = (end.end() for end in re.finditer(rb"\r\n|\n|\r", data))
    return next((end for n, end in enumerate(ends, start=2) if n == line), 0)


def _rows(data: bytes, encoding: str, table: Table) -> Iterator[Line]:
    """Lines of the rows, as they are counted in `numbers`."""
    for line in lines(data[: table.end], encoding):
        if line.number >= table.first and bare(line.text, table.separator).strip():
            yield line

"""Spreadsheets: each sheet is read as text in columns is, a row as a line.

A damaged file may make the library crash, or take memory without end, so it is taken apart in a process of its own.
"""

from __future__ import annotations

import csv
import io
import re
import zipfile
from collections.abc import Iterable
from itertools import zip_longest
from pathlib import Path
from typing import NamedTuple

import numpy as np

from movingfrf._basics.matlab_file import UNPACKING
from movingfrf._basics.undoing import scratch
from movingfrf.roughness.formats import columns
from movingfrf.roughness.formats.apart import taken_apart
from movingfrf.roughness.formats.base import Format, RawProfile, Recording, Wanted, chosen_recording


class Sheet(NamedTuple):
    """A sheet and what was read of it, or why nothing was."""

    name: str
    raw: RawProfile | None
    fault: str = ""


def read(path: Path, wanted: Wanted) -> RawProfile:
    """Read the sheet that holds a table; where several do, the one that is asked for."""
    texts = _texts(path)
    found = [_sheet(name, text, wanted._replace(recording=None)) for name, text in texts]
    if not found:
        raise ValueError("holds no sheets")
    if wanted.recording is not None and wanted.recording not in [sheet.name for sheet in found]:
        inside = [sheet.raw for sheet in (_sheet(*each, wanted) for each in texts) if sheet.raw]
        if len(inside) == 1:  # one of several in a sheet
            return inside[0]
    asked = [sheet for sheet in found if sheet.name == wanted.recording]
    tables = asked or [sheet for sheet in found if sheet.raw] or found[:1]
    recordings = [_recording(sheet) for sheet in tables]
    sheet = tables[chosen_recording(recordings, wanted.recording)]
    if sheet.raw is None:
        raise ValueError(sheet.fault)
    return sheet.raw


def _sheet(name: str, text: bytes, wanted: Wanted) -> Sheet:
    try:
        raw = _table(text, wanted)
    except ValueError as error:
        return Sheet(name, None, f"sheet {name[:40]!r}, {_rows(str(error))}")
    understood = raw.understood.replace("separated by tabs", f"sheet {name[:40]!r}")
    return Sheet(
        name, raw._replace(understood=understood, place=lambda row: f"sheet {name[:40]!r}, {_rows(raw.place(row))}")
    )


def _table(text: bytes, wanted: Wanted) -> RawProfile:
    """Read the table of a sheet; where that fails, without the few cells that stand beside it."""
    try:
        return columns.table(text, wanted)
    except ValueError:
        if (parts := _parted(text)) is None or _is_table(parts[1]):
            raise
        found = columns.table(parts[0], wanted)
        return found._replace(understood=f"{found.understood}, without the cells beside the table")


def _is_table(text: bytes) -> bool:
    try:
        columns.table(text, Wanted())
    except ValueError:
        return False
    return True


def _parted(text: bytes) -> tuple[bytes, bytes] | None:
    """Part the columns before an empty one from those behind; None if nearly all rows do not stand before it."""
    rows = list(csv.reader(io.StringIO(text.decode(), newline=""), delimiter="\t"))
    filled = [sum(bool(cell) for cell in column) for column in zip_longest(*rows, fillvalue="")]
    if 0 not in filled[1:]:
        return None
    first = filled.index(0, 1)
    few = 0.25  # of as many rows as the table, or it would be another one [0.05 to 0.5]
    if max(filled[first:]) > few * max(filled[:first]):
        return None
    return _as_text(row[:first] for row in rows), _as_text(row[first + 1 :] for row in rows)


def _as_text(rows: Iterable[list[str]]) -> bytes:
    made = io.StringIO()
    csv.writer(made, delimiter="\t", lineterminator="\n").writerows(rows)
    return made.getvalue().encode()


def _rows(said: str) -> str:
    """Say of a sheet what was said of its text."""
    return re.sub(r"^line (?=\d)", "row ", said).replace(" separated by tabs", "").replace("\\t", " | ")


def _recording(sheet: Sheet) -> Recording:
    if sheet.raw is None:
        return Recording(sheet.name, 0, float("nan"))
    return Recording(sheet.name, sheet.raw.stations.size, float(np.ptp(sheet.raw.stations)))


def _texts(path: Path) -> list[tuple[str, bytes]]:
    """Name and text of each sheet."""
    try:
        import python_calamine  # noqa: F401
    except ImportError:
        raise ValueError(
            "spreadsheets need python-calamine: pip install python-calamine, or the extra `io`"
        ) from None
    size = path.stat().st_size
    if zipfile.is_zipfile(path):
        try:
            with zipfile.ZipFile(path) as packed:
                unpacked = sum(entry.file_size for entry in packed.infolist())
        except (zipfile.BadZipFile, ValueError, NotImplementedError) as error:
            raise ValueError(f"is damaged, or no spreadsheet: {error}") from None
        if unpacked > UNPACKING.most(size):
            raise ValueError(f"unpacks to more than {UNPACKING.times} times its size: unpack it elsewhere first")
    with scratch("unpacked") as folder:
        most = 2**31 + 100 * size  # memory of a program that holds all cells [byte; a convention]
        names = taken_apart(path, folder, "sheet_child.py", most, "spreadsheet")
        return [(name, (folder / f"{n}.txt").read_bytes()) for n, name in enumerate(names)]


def _recognises(head: bytes) -> bool:
    older, zipped = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", b"PK\x03\x04"
    # What is zipped begins with one of these.
    first_of = (
        b"[Content_Types]",
        b"_rels/",
        b"docProps/",
        b"xl/",
        b"customXml/",
        b"mimetype",
    )
    length = int.from_bytes(head[26:28], "little")
    return head.startswith(older) or (head.startswith(zipped) and head[30 : 30 + length].startswith(first_of))


FORMAT = Format(
    "sheet",
    "Excel and OpenDocument spreadsheets",
    (".xlsx", ".xlsm", ".xlsb", ".xls", ".ods"),
    _recognises,
    read,
    several=True,
    takes=("units", "skip_lines"),
)

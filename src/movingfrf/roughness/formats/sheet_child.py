"""Takes the sheets out of a spreadsheet as text in columns, in a process of its own: see `sheets`.

Arguments: the file, a folder to write into, and the most bytes that the process may take. Writes each sheet as
0.txt, 1.txt and so on, a line for each row, and index.json with their names. What is wrong with the file goes to
standard error, with exit status 3; 4 where it cannot write, and why.
"""

from __future__ import annotations

import csv
import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TextIO

import python_calamine


def text(cell: Any) -> str:
    """Write what a cell holds: numbers with all their digits, texts in one line."""
    if isinstance(cell, float):
        return repr(int(cell)) if cell.is_integer() else repr(cell)
    return " ".join(str(cell).split())


def extract(file: Path, folder: Path) -> None:
    """Write sheets and index."""
    book = python_calamine.load_workbook(file)
    kept = [sheet.name for sheet in book.sheets_metadata if sheet.typ == python_calamine.SheetTypeEnum.WorkSheet]
    for n, name in enumerate(kept):
        sheet = book.get_sheet_by_name(name)
        with written(folder / f"{n}.txt") as out:
            out.write("\n" * (sheet.start[0] if sheet.start else 0))
            rows = csv.writer(out, delimiter="\t", lineterminator="\n")
            rows.writerows([text(cell) for cell in row] for row in sheet.iter_rows())
    with written(folder / "index.json") as out:
        json.dump(kept, out)


@contextmanager
def written(place: Path) -> Iterator[TextIO]:
    """Open a file to write; what goes wrong with it is no fault of the spreadsheet."""
    try:
        with place.open("w", encoding="utf-8", newline="") as out:
            yield out
    except OSError as error:
        print(error.strerror or error, file=sys.stderr)
        sys.exit(4)


def limit(most: int) -> None:
    """Bound the memory of this process, where the system can."""
    try:
        import resource
    except ImportError:
        return
    resource.setrlimit(resource.RLIMIT_AS, (most, most))


if __name__ == "__main__":
    limit(int(sys.argv[3]))
    try:
        extract(Path(sys.argv[1]), Path(sys.argv[2]))
    except (python_calamine.CalamineError, OSError, ValueError, MemoryError) as error:
        print(" ".join(str(error).split()) or "it takes too much memory", file=sys.stderr)
        sys.exit(3)

"""Whether a case has become slower: `make speed`.

Measures all rows but the long ones against their floor, with and without the compiled kernels, and ends with
status 1 where a ratio has grown by half over that in `ratios.toml`, twice in a row. `make speed UPDATE=1`
measures the long ones too and writes all ratios into the file instead; `ROWS="reference train"` names the rows.
"""

from __future__ import annotations

import argparse
import sys

from benchmarks.ratios import FILE, GROWTH, HEAD, Row, measured, tables, written
from benchmarks.worker import KINDS, NUMPY


def guarded(rows: list[Row]) -> int:
    """Say what has become slower, or faster; the status to end with."""
    grown = [row.grown for row in rows if row.grown]
    for words in grown:
        print(f"slower than it was: {words}")
    faster = [row for row in rows if row.taken.ratio * GROWTH < row.expected["ratio"]]
    if faster:
        named = ", ".join(f"{row.case} ({row.kind})" for row in faster)
        print(f"faster than it was, `make speed UPDATE=1` keeps it so: {named}")
    return int(bool(grown))


def updated(rows: list[Row]) -> None:
    """Write what was measured."""
    FILE.write_text(written(FILE.read_text(encoding="utf-8"), rows), encoding="utf-8")
    print(f"written to {FILE.name}: ratio is what is in the file now, in file what was there before")


def main(arguments: list[str] | None = None) -> int:
    """Measure, print, and tell whether all is as fast as it was."""
    expected = tables()
    parser = argparse.ArgumentParser(prog="python -m benchmarks.speed", description=__doc__.splitlines()[0])
    parser.add_argument("--update", action="store_true", help="write what is measured into the file")
    parser.add_argument("rows", nargs="*", metavar="ROW", help=f"what to measure: {', '.join(expected)}")
    options = parser.parse_args(arguments)
    if unknown := set(options.rows) - set(expected):
        parser.error(f"no row is called {', '.join(sorted(unknown))}; there are {', '.join(expected)}")
    if KINDS == (NUMPY,):
        print("numba is not installed: without the compiled kernels alone")
    cases = options.rows or [case for case, table in expected.items() if options.update or not table.get("long")]
    print(HEAD)
    rows = []
    for row in measured(cases):
        print(row, flush=True)
        rows.append(row)
    if options.update:
        updated(rows)
        return 0
    return guarded(rows)


if __name__ == "__main__":
    sys.exit(main())

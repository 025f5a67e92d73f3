"""The file of ratios: what each case costs in times of its floor, with and without the compiled kernels.

`ratios.toml` holds one table a case of `benchmarks.cases`: `words`, whether it takes `long`, and for each kind of
worker its `ratio` and, where memory is measured too, its `bytes` per sample, with what it is to be `at_most`.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, closing
from pathlib import Path
from typing import Any, NamedTuple

from benchmarks.worker import KINDS, Taken, Worker

FILE = Path(__file__).with_name("ratios.toml")
GROWTH = 1.5  # of a ratio, from which it counts as grown and not as noise [1.3 to 2]

HEAD = f"{'one thread, medians':24s} {'':8s} {'ms':>10s} {'floor':>9s} {'ratio':>8s}  in file  at most"


def tables() -> dict[str, dict[str, Any]]:
    """Read the file: case → its table."""
    return tomllib.loads(FILE.read_text(encoding="utf-8"))


class Row(NamedTuple):
    """A case as a kind of worker took it, what it is in words, and what the file expects."""

    case: str
    kind: str
    taken: Taken
    words: str
    expected: dict[str, float]

    def __str__(self) -> str:
        """All of it in a line, times as processor time."""
        most = self.expected.get("at_most", "")
        line = (
            f"{self.case:24s} {self.kind:8s} {1e3 * self.taken.seconds:10.2f} {1e3 * self.taken.floor:9.2f} "
            f"{self.taken.ratio:8.2f} {self.expected['ratio']:8g} {most:>8}   {self.words}"
        )
        if self.taken.bytes is None:
            return line
        memory = "{line}; {:.0f} bytes a sample, {bytes:g} in file, {bytes_at_most:g} at most"
        return memory.format(self.taken.bytes, line=line, **self.expected)

    @property
    def measured(self) -> dict[str, float]:
        """What the file holds, as it was measured."""
        return {name: value for name, value in self.taken._asdict().items() if name in self.expected}

    @property
    def grown(self) -> str:
        """What has grown by half, in words; empty where nothing has."""
        return ", ".join(
            f"{self.case} ({self.kind}): {name} {value:.3g}, expected {self.expected[name]:g}"
            for name, value in self.measured.items()
            if value > GROWTH * self.expected[name]
        )


def measured(cases: Iterable[str]) -> Iterator[Row]:
    """Measure cases, each with every kind of worker; what takes long, in a process of its own.

    What has grown is measured again at once: the machine may have been busy.
    """
    expected = tables()
    with ExitStack() as stack:
        workers = {kind: stack.enter_context(closing(Worker(kind))) for kind in KINDS}

        def row(case: str, kind: str) -> Row:
            table = expected[case]
            if table.get("long"):
                with closing(Worker(kind)) as own:
                    taken = own.floor(case)
            else:
                taken = workers[kind].floor(case)
            return Row(case, kind, taken, table["words"], table[kind])

        for case in cases:
            for kind in KINDS:
                found = row(case, kind)
                yield row(case, kind) if found.grown else found


def written(text: str, rows: Iterable[Row]) -> str:
    """Put what was measured into the text of the file, three digits of it; all else stays."""
    for row in rows:
        begin = text.index(f"\n{row.kind} = ", text.index(f"[{row.case}]\n")) + 1
        values = row.expected | {name: float(f"{value:.3g}") for name, value in row.measured.items()}
        line = ", ".join(f"{name} = {value:g}" for name, value in values.items())
        text = text[:begin] + f"{row.kind} = {{ {line} }}" + text[text.index("\n", begin) :]
    return text

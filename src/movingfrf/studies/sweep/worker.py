"""A process that solves chunks of a sweep: `python -m movingfrf.studies.sweep.worker FOLDER`."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from movingfrf.studies.sweep.chunks import CHUNKING, InFolder, Kept, cases_of
from movingfrf.studies.sweep.plan import Plan
from movingfrf.studies.sweep.solving import solved


def solve_asked(plan: Plan, kept: Kept, asked: int) -> None:
    """Solve chunks until the pipe that tells which, and that other workers read as well, has no more of them."""
    variants = plan.to_solve
    while said := os.read(asked, CHUNKING.word):
        number = int.from_bytes(said)
        kept.put(number, solved(plan, variants, *cases_of(number, plan.axes.cases)))


def main(folder: str) -> None:
    """Solve chunks of the sweep in a folder that standard input asks for."""
    plan = Plan.of_text((Path(folder) / "sweep.json").read_text(encoding="utf-8"))
    solve_asked(plan, InFolder(Path(folder), plan), 0)


if __name__ == "__main__":
    main(*sys.argv[1:])

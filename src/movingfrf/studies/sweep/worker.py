"""A process that solves chunks of a sweep: `python -m movingfrf.studies.sweep.worker FOLDER`."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from movingfrf.studies.sweep.chunks import CHUNKING, InFolder, cases_of
from movingfrf.studies.sweep.plan import Plan
from movingfrf.studies.sweep.solving import solved


def main(folder: str) -> None:
    """Solve chunks of the sweep in a folder, until the pipe that other workers read as well has no more of them."""
    plan = Plan.of_text((Path(folder) / "sweep.json").read_text(encoding="utf-8"))
    kept, variants = InFolder(Path(folder), plan), plan.variants
    while asked := os.read(0, CHUNKING.word):
        number = int.from_bytes(asked)
        kept.put(number, solved(plan, variants, *cases_of(number, plan.axes.cases)))


if __name__ == "__main__":
    main(*sys.argv[1:])

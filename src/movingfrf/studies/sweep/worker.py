"""A process that solves chunks of a sweep: `python -m movingfrf.studies.sweep.worker FOLDER NUMBER,NUMBER…`."""

from __future__ import annotations

import sys
from pathlib import Path

from movingfrf.studies.sweep.chunks import InFolder, cases_of
from movingfrf.studies.sweep.plan import Plan
from movingfrf.studies.sweep.solving import solved


def main(folder: str, numbers: str) -> None:
    """Solve some chunks of the sweep in a folder."""
    plan = Plan.of_text((Path(folder) / "sweep.json").read_text(encoding="utf-8"))
    kept, variants = InFolder(Path(folder), plan), plan.variants
    for number in map(int, numbers.split(",")):
        kept.put(number, solved(plan, variants, *cases_of(number, plan.axes.cases)))


if __name__ == "__main__":
    main(*sys.argv[1:])

"""Compute cases and their references: `python -m tests.honest [--cases 300] [--every 10] [--only N]`."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial

from tests.honest.comparison import CODES, FALSE_ALARMS, TOLERATED, Outcome, outcome

ROW = (
    "{number:>4} {difference:>8} {truth:>8} {where:>6} {channel:<16} {share:>7} {speed:>5} {step:>6} {duration:>6} "
    "{solved:>9} {ends:>5}  {vehicle} | {guideway} | {profile} | {findings}"
)
HEADS = {
    "number": "case",
    "difference": "finer",
    "truth": "exact",
    "solved": "solved ms",
    "speed": "m/s",
    "step": "ms",
    "duration": "s",
} | {name: name for name in ("where", "channel", "share", "ends", "vehicle", "guideway", "profile", "findings")}


def row(found: Outcome) -> str:
    worst = found.difference
    told = [f"{each['code']} {each['figure']:.1e}" for each in found.findings if each["code"] in CODES]
    if found.grades[0] != found.grades[1]:
        told.append(f"grade {found.grades[0]:.5f}, reference {found.grades[1]:.5f}")
    told += [f"{name} {size:.1e}" for name, size in found.variants.items()]
    mark = "*" if found.silent else ""
    return ROW.format(
        number=f"{mark}{found.number}",
        difference=f"{found.finer.size:.1e}",
        truth="" if found.exact is None else f"{found.exact.size:.1e}",
        where=worst.where,
        channel=worst.channel,
        share=f"{worst.share:.1g}",
        solved=f"{1e3 * found.solved_step:.2g}",
        findings=found.failed or ", ".join(told),
        **found.said,
    )


def told(found: Sequence[Outcome], worst: int) -> tuple[str, bool]:
    """Put outcomes into words; and whether a rule is broken."""
    ranked = sorted(found, key=lambda each: (bool(each.failed), each.difference.size), reverse=True)
    right = [each for each in found if each.right]
    alarms = [each for each in right if each.false_alarm]
    silent = [each for each in found if each.silent]
    broken = bool(silent) or len(alarms) > FALSE_ALARMS * len(right)
    own, others = (sum(each.seconds[part] for each in found) for part in (0, 1))
    exact = sum(each.exact is not None for each in found)
    lines = [
        ROW.format(**HEADS),
        *(row(each) for each in ranked[:worst]),
        f"{len(found)} cases, {len(right)} right to {TOLERATED:g} of a channel's largest value; of these "
        f"{len(alarms)} with a finding that says otherwise: {', '.join(str(each.number) for each in alarms)}",
        f"{len(found) - len(right)} wrong, {len(silent)} of them (*) without a finding of the right figure; "
        f"{sum(bool(each.failed) for each in found)} failed",
        f"{exact} against a state space; {own:.0f} s, theirs {others:.0f} s",
    ]
    return "\n".join(lines), broken


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", type=int, default=300, help="how many are drawn")
    parser.add_argument("--seed", type=int, default=0, help="another one gives other cases")
    parser.add_argument("--every", type=int, default=1, help="10: a tenth of them, the short ones")
    parser.add_argument("--only", type=int, nargs="*", help="numbers of the cases")
    parser.add_argument("--worst", type=int, default=40, help="rows of the table")
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    parser.add_argument("--why", action="store_true", help="what a wrong case owes to")
    asked = parser.parse_args()
    numbers = asked.only or range(0, asked.cases, asked.every)
    compute = partial(outcome, seed=asked.seed, variants=asked.why)
    if asked.jobs == 1:
        found = [compute(number) for number in numbers]
    else:
        with ProcessPoolExecutor(asked.jobs) as pool:
            found = list(pool.map(compute, numbers))
    text, broken = told(found, asked.worst)
    print(text)
    return int(broken)


if __name__ == "__main__":
    sys.exit(main())

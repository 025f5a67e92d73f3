"""How fast, against another checkout: `make against OLD=path`, or `benchmarks.against PATH [--numpy] [CASE …]`.

Each side has a process of its own, on one thread, with its own package and the cases of this checkout. Both solve
them in turn, so that a busy machine slows both; medians of wall and processor time, and the median of the ratios
of neighbours. With the compiled kernels, or without: `make against OLD=path NUMPY=1`.
"""

from __future__ import annotations

import argparse
import statistics
from contextlib import closing
from pathlib import Path

from benchmarks.ratios import tables
from benchmarks.worker import KINDS, NUMPY, ROOT, Worker

ROUNDS, SLOW, SECONDS = 31, 5, 1.0  # rounds; of what takes longer than so many seconds, so many


def main() -> None:
    """Compare this checkout with the one that is named."""
    expected = tables()
    parser = argparse.ArgumentParser(prog="python -m benchmarks.against", description=__doc__.splitlines()[0])
    parser.add_argument("checkout", type=Path)
    parser.add_argument("cases", nargs="*", metavar="CASE", help=", ".join(expected))
    parser.add_argument("--numpy", action="store_true", help="without the compiled kernels")
    options = parser.parse_args()
    there, kind = options.checkout.resolve(), NUMPY if options.numpy else KINDS[0]
    cases = options.cases or [case for case, table in expected.items() if not table.get("long")]
    print(f"{kind}, one thread, medians of {ROUNDS} ({SLOW} of slow cases); this checkout over {there.name}")
    with closing(Worker(kind, ROOT)) as mine, closing(Worker(kind, there)) as theirs:
        for case in cases:
            wall = max(side.once(case)[0] for side in (mine, theirs))  # warm
            pairs = [(mine.once(case), theirs.once(case)) for _ in range(SLOW if wall > SECONDS else ROUNDS)]
            words = []
            for number, name in enumerate(("wall", "processor")):
                times = [(here[number], other[number]) for here, other in pairs]
                ratio = statistics.median(a / b for a, b in times)
                medians = (1e3 * statistics.median(side) for side in zip(*times, strict=True))
                words.append("{} {:8.2f} / {:8.2f} ms  {:5.2f}".format(name, *medians, ratio))
            print(f"{case:25s} {'   '.join(words)}", flush=True)


if __name__ == "__main__":
    main()

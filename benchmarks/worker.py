"""A process that times cases (`benchmarks.cases`), one after the other as it is asked: `benchmarks.worker KIND`.

It has one thread, and either numba loaded, for the compiled kernels, or no numba, as where it is not installed.
Its parent asks by lines: `once CASE` is answered with wall and processor time of a call, `floor CASE` with how
the case compares with its floor: the transforms that the reference case cannot do without, real FFTs of 48,000
points (2 forward, 12 inverse) on arrays that lie ready. An hour of travel has a floor of 7.2 million points, and
its memory is measured too, in a process of its own.

Case and floor take turns, and what counts is the median of the ratios of neighbours, of processor time: on one
thread that is what the clock on the wall shows on an idle machine, without the waiting on a busy one, of which a
long case gets its share and a floor of two milliseconds hardly any. Measured again and again on two cores, idle
or taken by other processes, the same ratio stayed within 5 % (of what takes seconds 20 %); of wall time it grew
up to 2.5 times. A large block is given back before anything is timed, from which on freed memory is kept:
otherwise the floor alone takes half as long again in some states of the heap.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple

ROOT = Path(__file__).resolve().parents[1]
COMPILED, NUMPY = "compiled", "numpy"
KINDS = (COMPILED, NUMPY) if find_spec("numba") else (NUMPY,)

# A case is timed for so long, as often as limits allow.
SECONDS, FEWEST, MOST = 1.0, 3, 31


class Taken(NamedTuple):
    """Median processor times of a case and its floor [s], their ratio; peak memory [bytes per sample] or None."""

    seconds: float
    floor: float
    ratio: float
    bytes: float | None = None


class Worker:
    """A process that times cases, with the package of this checkout or of another one."""

    def __init__(self, kind: str, checkout: Path = ROOT) -> None:
        threads = {f"{library}_NUM_THREADS": "1" for library in ("OMP", "OPENBLAS", "NUMBA")}
        paths = os.pathsep.join([str(checkout / "src"), str(ROOT)])
        self.process = subprocess.Popen(
            [sys.executable, "-m", "benchmarks.worker", kind],
            cwd=ROOT,
            env=os.environ | threads | {"PYTHONPATH": paths},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def close(self) -> None:
        """End it."""
        self.process.communicate()

    def _asked(self, question: str) -> list[Any]:
        try:
            print(question, file=self.process.stdin, flush=True)
            return json.loads(self.process.stdout.readline())
        except (BrokenPipeError, ValueError):
            sys.exit(f"{question}: its process has ended")

    def once(self, case: str) -> list[float]:
        """Wall and processor time of one call [s]."""
        return self._asked(f"once {case}")

    def floor(self, case: str) -> Taken:
        """Compare a case with its floor."""
        return Taken(*self._asked(f"floor {case}"))


def transforms(points: int) -> Callable[[], None]:
    """Prepare the transforms that the reference case needs."""
    import numpy as np
    import scipy.fft

    random = np.random.default_rng(0)
    forward = random.normal(size=(2, points))
    inverse = scipy.fft.rfft(random.normal(size=(12, points)))

    def run() -> None:
        scipy.fft.rfft(forward)
        scipy.fft.irfft(inverse, points)

    return run


def main() -> None:
    """Answer until the parent has no more questions."""
    if sys.argv[1] == COMPILED:
        import numba  # noqa: F401
    else:
        sys.modules["numba"] = None
    import resource
    import statistics
    import time
    import warnings
    from functools import cache

    import numpy as np
    from benchmarks.cases import CASES, HOUR

    warnings.simplefilter("ignore")
    np.empty(31 * 2**20, np.uint8)  # the largest block after which glibc keeps what is freed

    def peak() -> int:
        return 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    prepared = cache(lambda case: CASES[case]())

    def once(case: str) -> list[float]:
        run = prepared(case)
        wall, processor = time.perf_counter(), time.process_time()
        run()
        return [time.perf_counter() - wall, time.process_time() - processor]

    def floor(case: str) -> list[float | None]:
        run, before = prepared(case), peak()
        run()
        samples = HOUR["duration"] / HOUR["time_step"]
        growth = (peak() - before) / samples if case == "hour" else None
        least = transforms(7_200_000 if case == "hour" else 48_000)
        least()
        times: list[tuple[float, float]] = []
        while len(times) < FEWEST or (len(times) < MOST and sum(map(sum, times)) < SECONDS):
            began = time.process_time()
            run()
            between = time.process_time()
            least()
            times.append((between - began, time.process_time() - between))
        seconds, lowest = map(statistics.median, zip(*times, strict=True))
        return [seconds, lowest, statistics.median(a / b for a, b in times), growth]

    answers = {"once": once, "floor": floor}
    for question in sys.stdin:
        asked, case = question.split()
        print(json.dumps(answers[asked](case)), flush=True)


if __name__ == "__main__":
    main()

"""How fast, against the floor: `make bench`.

Every row of `ratios.toml`, with and without the compiled kernels: processor time, the floor's, their ratio, the
one in the file and the one that is aimed at. Then where the time of the reference case goes, what the import
costs, and the other methods. One thread; machines differ and are shared, so that the ratio is what counts.
"""

from __future__ import annotations

import argparse
import cProfile
import os
import pstats
import statistics
import subprocess
import sys
import warnings
from collections import Counter
from pathlib import Path

# Before NumPy is loaded: its linear algebra reads the number of threads once.
os.environ |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}

from benchmarks import methods
from benchmarks.cases import CASES
from benchmarks.ratios import HEAD, measured, tables

import movingfrf as mf

ROUNDS, MODULES = 31, 12


def stages() -> None:
    """Print where the time of the reference case goes: to a module's lines, and to what they call elsewhere."""
    run = CASES["reference"]()
    run()
    profiler = cProfile.Profile()
    profiler.enable()
    for _ in range(ROUNDS):
        run()
    profiler.disable()
    inside = str(Path(mf.__file__).parent)
    taken: Counter[str] = Counter()
    for (file, *_), (_, _, own, _, callers) in pstats.Stats(profiler).stats.items():
        if file.startswith(inside):
            taken[file] += own
        for (caller, *_), (_, _, _, cumulative) in callers.items():
            if caller.startswith(inside) and not file.startswith(inside):
                taken[caller] += cumulative
    print("where it goes (with the profiler's own cost)")
    for file, seconds in taken.most_common(MODULES):
        print(f"  {Path(file).relative_to(inside).as_posix():<40} {seconds / ROUNDS * 1e3:6.2f} ms")
    rest = sum(taken.values()) - sum(seconds for _, seconds in taken.most_common(MODULES))
    print(f"  {'all others':<40} {rest / ROUNDS * 1e3:6.2f} ms")


def imports() -> None:
    """Time `import movingfrf` above `import numpy`, in processes of their own."""

    def seconds(statement: str) -> float:
        code = f"import time; a = time.perf_counter(); {statement}; print(time.perf_counter() - a)"
        runs = [subprocess.run([sys.executable, "-c", code], capture_output=True, text=True) for _ in range(7)]
        return statistics.median(float(run.stdout) for run in runs)

    numpy, package = seconds("import numpy"), seconds("import numpy, movingfrf")
    above = package - numpy
    print(
        f"import                   {package * 1e3:8.1f} ms   numpy {numpy * 1e3:7.1f} ms   above it {above:.3f} s"
    )


def main() -> None:
    """Run the benchmarks that are asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="leave out long rows and the other methods")
    options = parser.parse_args()
    warnings.simplefilter("ignore", mf.ValidityWarning)
    print(HEAD)
    for row in measured(case for case, table in tables().items() if not (options.quick and table.get("long"))):
        print(row, flush=True)
    stages()
    imports()
    if not options.quick:
        methods.main()


if __name__ == "__main__":
    main()

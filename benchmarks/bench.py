"""How fast, against the floor: `make bench`.

Every row of `ratios.toml`, with and without the compiled kernels: processor time, the floor's, their ratio, the
one in the file and the one that is aimed at. Then where the time of the reference case goes, what the import
costs, and the other methods. One thread; machines differ and are shared, so that the ratio is what counts.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import warnings

# Before NumPy is loaded: its linear algebra reads the number of threads once.
os.environ |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}

from benchmarks import methods
from benchmarks.cases import CASES
from benchmarks.ratios import HEAD, measured, tables

import movingfrf as mf

ROUNDS = 31


def stages() -> None:
    """Print where the time of the reference case goes."""
    import cProfile
    import pstats

    run = CASES["reference"]()
    run()
    profiler = cProfile.Profile()
    profiler.enable()
    for _ in range(ROUNDS):
        run()
    profiler.disable()
    stats = pstats.Stats(profiler).stats
    wanted = {
        "excite": "spline of the profile",
        "elevation": "profile under the contacts",
        "spectra": "forward transforms and continuation",
        "survey": "steady state, stability, truncation",
        "solve": "moving FRF, coupling, vehicle",
        "histories": "inverse transforms",
        "labelled": "Dataset",
    }
    taken = {name: cumulative for (_, _, name), (_, _, _, cumulative, _) in stats.items() if name in wanted}
    print("where it goes (with the profiler's own cost)")
    # A function that has another name by now is an error here and not a line less.
    for name, words in wanted.items():
        print(f"  {words:<44} {taken[name] / ROUNDS * 1e3:6.2f} ms")


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

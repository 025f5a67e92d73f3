"""Random roads without realisations, against 400 of them: `python -m benchmarks.random_roads`.

First how much faster the closed form is than the realisations (roads and journeys of 24 s, nothing else), in one
process on one thread. Then whether they agree: variances of every response, octave by octave, against the mean of
the realisations within its confidence interval.
"""

from __future__ import annotations

import argparse
import os
import statistics
import time
import warnings
from itertools import pairwise

# Before NumPy is loaded: its linear algebra reads the number of threads once.
os.environ |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}

import numpy as np
from scipy.stats import t as student
from tests.cross.realisations import BANDS, CASES, Case, compared

from movingfrf import ValidityWarning

REALISATIONS, ROUNDS = 400, 31


def agreement(name: str, case: Case, realisations: int) -> None:
    """Print how the observed variances lie within their confidence intervals."""
    found = compared(case, range(realisations))
    columns = [f"{low:g}-{high:g}" for low, high in pairwise(BANDS)] + ["all"]
    print(f"\n{name}: observed over predicted variance (t) in bands [Hz], peak of 16 s over its expectation")
    print(" " * 26 + "".join(f"{column:>14}" for column in columns) + "    peak")
    for response, ratios, values, peak in zip(
        found.names, found.mean / found.expected, found.t, found.peak, strict=True
    ):
        cells = "".join(f"{ratio:8.3f} ({value:+.1f})" for ratio, value in zip(ratios, values, strict=True))
        print(f"{response.replace('acceleration', 'acc.'):26}{cells}{peak:8.3f}")
    inside = np.abs(found.t) < student.ppf(0.975, realisations - 1)
    allowed = student.ppf(1 - 0.025 / found.t.size, realisations - 1)
    print(
        f"{inside.mean():.0%} of {found.t.size} variances within their 95 % interval; largest |t| "
        f"{np.abs(found.t).max():.2f}, allowed {allowed:.2f} (95 % for all together, Bonferroni); mean t² "
        f"{np.mean(found.t**2):.2f}, expected {(realisations - 1) / (realisations - 3):.2f}; "
        f"standard error {np.median(found.error / found.mean):.2%} (median)"
    )


def speed(name: str, case: Case, realisations: int) -> None:
    """Print the times of both ways."""
    case.predicted()
    times = []
    for _ in range(ROUNDS):
        began = time.perf_counter()
        case.predicted()
        times.append(time.perf_counter() - began)
    closed = statistics.median(times)
    case.travelled(0)
    began = time.perf_counter()
    for seed in range(realisations):
        case.travelled(seed)
    simulated = time.perf_counter() - began
    print(
        f"{name:24} closed form {closed * 1e3:6.1f} ms ({case.predicted().attrs['frequencies']} frequencies)   "
        f"{realisations} realisations {simulated:6.2f} s   {simulated / closed:5.0f} times faster"
    )


def main() -> None:
    """Compare every case."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--realisations", type=int, default=REALISATIONS)
    options = parser.parse_args()
    warnings.simplefilter("ignore", ValidityWarning)
    for name, case in CASES.items():
        speed(name, case, options.realisations)
    for name, case in CASES.items():
        agreement(name, case, options.realisations)


if __name__ == "__main__":
    main()

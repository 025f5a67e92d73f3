"""How fast, against the floor: `make bench`.

The floor is the transforms that the answer cannot do without, real FFTs of 48,000 points (2 forward, 12
inverse), timed alternately with `simulate` in one process on one thread. Medians; the ratio is what counts,
since machines differ and are shared.
"""

from __future__ import annotations

import argparse
import os
import resource
import statistics
import subprocess
import sys
import time
import warnings

# Before NumPy is loaded: its linear algebra reads the number of threads once.
os.environ |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}

import numpy as np
import scipy.fft
from benchmarks import methods

import movingfrf as mf

ROUNDS = 31


def reference_case(duration: float = 24.0):
    """Prepare the reference case: a half truck at 10 m/s, class A, 1 ms, the road up to 70 Hz."""
    road = mf.track(
        mf.EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9), mf.Spring(stiffness=8.0e6, damping=3.0e4)
    )
    truck = mf.half_car(
        body_mass=17735.0,
        pitch_inertia=1.47e5,
        wheel_masses=(1500.0, 1000.0),
        suspension_stiffness=(2.47e6, 4.23e6),
        suspension_damping=(3.0e4, 4.0e4),
        tyre_stiffness=(3.74e6, 4.60e6),
        tyre_damping=(3.9e3, 4.3e3),
        axles=(2.21613, -2.05387),
    )
    spectrum = mf.IsoRoad.of_class("A", band=(0.01, 6.0))
    profile = mf.realise(spectrum, length=10.0 * duration + 5.0, start=-2.5)

    def run():
        return mf.simulate(road, truck, profile, speed=10.0, duration=duration, truncation=70.0)

    return run


def floor(points: int):
    """Prepare the transforms that the reference case needs, on arrays that lie ready."""
    random = np.random.default_rng(0)
    forward = random.normal(size=(2, points))
    inverse = scipy.fft.rfft(random.normal(size=(12, points)))

    def transforms():
        scipy.fft.rfft(forward)
        scipy.fft.irfft(inverse, points)

    return transforms


def alternately(first, second, rounds: int) -> tuple[float, float, float]:
    """Medians of both [s], and the median of the ratio of neighbours."""
    times = []
    for _ in range(rounds + 2):
        began = time.perf_counter()
        first()
        between = time.perf_counter()
        second()
        times.append((between - began, time.perf_counter() - between))
    times = times[2:]  # warm
    a, b = (statistics.median(column) for column in zip(*times, strict=True))
    return a, b, statistics.median(x / y for x, y in times)


def speed() -> float:
    """Time the reference case against its floor; returns the ratio."""
    mine, least, ratio = alternately(reference_case(), floor(48_000), ROUNDS)
    print(f"reference case, 24 s     {mine * 1e3:8.2f} ms   FFTs {least * 1e3:8.2f} ms   ratio {ratio:5.2f}")
    return ratio


def stages() -> None:
    """Print where the time of the reference case goes."""
    import cProfile
    import pstats

    run = reference_case()
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


def hour(short_ratio: float) -> None:
    """Time one hour of travel against its floor and measure its memory, in a process of its own."""
    code = "import benchmarks.bench as b; b.hour_alone()"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    mine, least, ratio, per_sample = (float(word) for word in done.stdout.split())
    print(f"one hour, 3.6 million    {mine:8.2f} s    FFTs {least:8.2f} s    ratio {ratio:5.2f}", end="")
    print(f"   {ratio / short_ratio:.2f} times that of 24 s; peak memory {per_sample:.0f} bytes per sample")


def hour_alone() -> None:
    """Measure one hour; prints time, floor, ratio and bytes per sample."""
    run = reference_case(3600.0)
    import xarray  # noqa: F401  (its memory is not the journey's)

    reference_case(1.0)()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    run()
    per_sample = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) * 1024 / 3_600_000
    mine, least, ratio = alternately(run, floor(7_200_000), 3)
    print(mine, least, ratio, per_sample)


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
    parser.add_argument("--quick", action="store_true", help="leave out the hour of travel and the other methods")
    arguments = parser.parse_args()
    warnings.simplefilter("ignore", mf.ValidityWarning)
    print("one thread, medians")
    ratio = speed()
    stages()
    imports()
    if not arguments.quick:
        hour(ratio)
        methods.main()


if __name__ == "__main__":
    main()

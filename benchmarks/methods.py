"""Moving FRF against the methods that step in time or convolve: part of `make bench`.

The reference case by every method, at its own step and over a range of steps; the ratio at equal error is read
from the latter (`movingfrf compare`), of one case and of one in a batch that shares its set-up. Below it stands
what that ratio cannot exceed: the time of the coupled method over that of what a call of `simulate` does besides
moving FRFs and coupling, these taken as free: the transforms, the spline of the road and the labelled result. One
thread, one process, medians.
"""

from __future__ import annotations

import os
import statistics
import time
import warnings

# Before NumPy is loaded: its linear algebra reads the number of threads once.
os.environ |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}

import math
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
import scipy.fft
from benchmarks.cases import SCENARIO

import movingfrf as mf
from movingfrf.reports.tables import Table
from movingfrf.results.labels import labelled
from movingfrf.roughness.excitation import Touch, excite
from movingfrf.scenarios.scenario import Scenario
from movingfrf.stepping.marching import March
from movingfrf.stepping.schemes import SCHEMES
from movingfrf.stepping.tie import tie_of
from movingfrf.studies.comparison.comparison import Comparison, Point, ratios
from movingfrf.studies.comparison.page import tables

METHODS = [
    *("moving-frf", "moving-frf-fe", "moving-frf-fe-plain", "duhamel"),
    *("cdfm", "cdfm-window", "cdfm-weight", "sim"),
]
# Cases that share their set-up.
BATCH = 100


def printed(table: Table) -> None:
    """Print a table."""
    print(table.caption)
    widths = [max(len(line) for line in column) for column in zip(*_lines(table), strict=True)]
    for line in _lines(table):
        print("  " + "  ".join(cell.rjust(width) for cell, width in zip(line, widths, strict=True)))


def _lines(table: Table) -> list[list[str]]:
    head = [table.corner, *(f"{c.name} [{c.units}]" if c.units else c.name for c in table.columns)]
    return [head, *([row.name, *row.cells] for row in table.rows)]


def struck_roads() -> None:
    """Print the error of the moving FRF of 40 m of finite elements against the closed form."""
    road = SCENARIO.guideway
    offsets = np.array([0.0, 4.27, -4.27])
    omega = 2 * np.pi * np.linspace(0.0, 70.0, 141)
    exact = road.moving_frf(offsets, 10.0, omega)
    print("moving FRF of 40 m of finite elements at 10 m/s, against the closed form")
    for name, plain in (("as in the paper", True), ("end reflections cancelled", False)):
        struck = mf.struck_track(road, speed=10.0, offsets=offsets, plain=plain)
        error = np.abs(struck.moving_frf(offsets, 10.0, omega) - exact)
        share = error.max(axis=0) / np.abs(exact).max()
        at = [float(error[n, 0] / abs(exact[n, 0])) for n in (100, 140)]
        print(
            f"  {name:28s} below 70 Hz, of max|G|: {share[0]:.1e} (under the load), {share[1]:.1e} (4.27 m ahead), "
            f"{share[2]:.1e} (behind); relative at 50 and 70 Hz: {at[0]:.1e}, {at[1]:.1e}"
        )


def steps_of_the_coupled_method() -> None:
    """Time 24,000 steps of the coupled method on about 1200 unknowns."""
    vehicle = SCENARIO.case.vehicle
    road = mf.finite_track(SCENARIO.guideway, first=-30.0, last=270.0, element=0.5)
    march = March(
        guideway=road,
        scheme=SCHEMES["average_acceleration"],
        time_step=1e-3,
        speed=10.0,
        contacts=vehicle.positions,
        observers=np.empty(0),
        tie=tie_of(vehicle),
    )
    march.prepare()
    steps = 24_000
    seen = 1e-3 * np.sin(np.arange(steps + 1) / 100.0)[:, None] * [1.0, 1.0]
    times = []
    for _ in range(4):
        state = march.at_rest()
        began = time.perf_counter()
        march.run(steps, state, roughness=seen, rate=0.1 * seen, loads=np.zeros((1, 2)))
        times.append(time.perf_counter() - began)
    seconds = statistics.median(times[1:])
    print(
        f"coupled method, {steps} steps on {road.dofs} unknowns, 2 contacts: {seconds:.3f} s, "
        f"{1e6 * seconds / steps:.2f} µs a step, {1e9 * seconds / steps / road.dofs:.2f} ns a step and unknown "
        f"({'compiled' if march.uses_compiled else 'NumPy and LAPACK'})"
    )


def at_equal_error(found: Comparison) -> None:
    """Print ratios at equal error, and what they cannot exceed."""
    for target, times in found.equal_error.items():
        for in_batch in (False, True):
            over = ratios(found, target, in_batch=in_batch)
            told = ", ".join(f"{name} {over[name]:.3g}" for name in times if math.isfinite(over[name]))
            where = f", in a batch of {found.batch}" if in_batch else ""
            print(f"time over that of moving-frf at an error of {target:g} in contact force{where}: {told}")
        step = step_at(found.curve, target)
        if math.isnan(step):
            continue
        least = besides(found.scenario, step)
        bound = times["cdfm"] / sum(least.values())
        print(
            f"  moving-frf reaches that error with a step of {1e3 * step:.3g} ms, where "
            + ", ".join(f"{what} take {1e3 * seconds:.2f} ms" for what, seconds in least.items())
            + f"; with all else free the ratio of cdfm were {bound:.3g}"
        )


def step_at(curve: list[Point], target: float) -> float:
    """Longest step with which moving-frf reaches an error [s], read like the time; nan if none does."""
    line = sorted((p for p in curve if p.method == "moving-frf"), key=lambda p: p.time_step)
    best = math.nan
    for fine, coarse in pairwise(line):
        a, b = fine.relative_l2["contact_force"], coarse.relative_l2["contact_force"]
        if a <= target < b:
            share = math.log(target / a) / math.log(b / a)
            best = fine.time_step * (coarse.time_step / fine.time_step) ** share
        elif b <= target:
            best = coarse.time_step
    return best


def besides(scenario: Scenario, step: float) -> dict[str, float]:
    """Time what a call does besides moving FRFs and coupling [s]."""
    points = scipy.fft.next_fast_len(int(1.125 * scenario.journey.duration / step), real=True)
    random = np.random.default_rng(0)
    forward = random.normal(size=(2, points))
    inverse = scipy.fft.rfft(random.normal(size=(12, points)))
    journey, vehicle, road = replace(scenario.journey, time_step=step), scenario.case.vehicle, scenario.case.road
    result = scenario.run()
    values = {name: result[name].values for name in (*result.data_vars, *result.coords)}

    def transforms() -> None:
        scipy.fft.rfft(forward)
        scipy.fft.irfft(inverse, points)

    def spline() -> None:
        touch = Touch(**vehicle.touching)
        seen = excite(road.profile, touch, start=journey.start, distance=journey.distance, blend=journey.blend)
        seen.elevation(journey.travelled)

    def labels() -> None:
        labelled(values, result.attrs)

    return {"transforms": median(transforms), "the road's spline": median(spline), "labels": median(labels)}


def median(action: Callable[[], None]) -> float:
    """Median time of an action [s]."""
    times = []
    for _ in range(21):
        began = time.perf_counter()
        action()
        times.append(time.perf_counter() - began)
    return statistics.median(times)


def main() -> None:
    """Run everything."""
    warnings.simplefilter("ignore", mf.ValidityWarning)
    struck_roads()
    steps_of_the_coupled_method()
    found = mf.compare(SCENARIO, METHODS, batch=BATCH)
    for table in tables(found):
        printed(table)
    at_equal_error(found)


if __name__ == "__main__":
    main()

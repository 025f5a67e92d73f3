"""One case, several methods: how long each takes, how much memory, and how far it is from the converged answer.

Every method gets the same scenario and the same spline profile; preparing and solving are both timed. The
converged answer is the coupled method on a road that travels with the vehicle, refined in mesh and step and
extrapolated until it no longer moves; it owes nothing to the frequency domain.
"""

from __future__ import annotations

import json
import math
import statistics
import sys
import time
import tracemalloc
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from threadpoolctl import threadpool_limits

from movingfrf._basics.checks import ValidityWarning, checking
from movingfrf._basics.compiling import compiling
from movingfrf._basics.door import mistaken
from movingfrf._basics.progress import Progress, silent
from movingfrf._basics.undoing import carried_out
from movingfrf._basics.values import Value, brief
from movingfrf.scenarios.reading import parse_scenario
from movingfrf.scenarios.scenario import Drive, Scenario, shortened
from movingfrf.scenarios.stepped import elements
from movingfrf.studies.comparison.convergence import (
    TARGETS,
    Reference,
    aligned,
    converged,
    maximum_error,
    relative_l2,
)
from movingfrf.studies.comparison.methods import FOR_LOADS, FOR_VEHICLE, Case, Method, chosen

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True, slots=True, kw_only=True)
class Timing:
    """How methods are timed; in brackets, between what each number is safe. None of them changes an error."""

    # Steps of the error–time figure, relative to the scenario's own [powers of two: all have times in common].
    steps: tuple[float, ...] = (8.0, 4.0, 2.0, 1.0, 0.5, 0.25)
    runs: int = 3  # that are timed, at most [from 1; the more, the less a busy machine shows]
    patience: float = 2.0  # no further run once they have taken so long together [s] [from 0]
    warm_up: float = 0.2  # of a first run, which compiles and fills caches [s] [from 0: at least 20 steps are run]


TIMING = Timing()

# Times of a method on a case: of preparing and of solving [s]; and the result.
Timed = Callable[[Method, Case], tuple[float, float, "xr.Dataset"]]


class Performance(NamedTuple):
    """One method at the scenario's own step."""

    method: str
    time_step: float
    element: float  # nan where the method divides nothing
    setup_s: float
    solve_s: float
    peak_bytes: int
    relative_l2: dict[str, float]
    maximum_error: dict[str, float]
    ratio: float  # of its time to that of moving-frf; nan without that
    findings: list[str]  # what the method itself says about the validity of its result
    batch_s: float  # of a case in a batch, over which the set-up is shared; nan without a batch


class Point(NamedTuple):
    """One run of the error–time figure."""

    method: str
    time_step: float
    element: float
    seconds: float
    relative_l2: dict[str, float]
    setup_s: float = 0.0  # of its seconds, what a batch shares


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Comparison(Value):
    """What `compare` found.

    Parameters
    ----------
    scenario : Scenario
        The case.
    rows : list of Performance
        The table.
    curve : list of Point
        The error–time figure.
    reference : Reference
        What errors are relative to.
    equal_error : dict of float to dict of str to float
        Error in the first quantity → method → time at that error [s]; nan where it is not reached.
    batch : int
        Cases over which the set-up is shared; 1: it counts in full.
    equal_error_in_batch : dict of float to dict of str to float
        As `equal_error`, of a case in the batch [s]; empty without one.
    """

    scenario: Scenario
    rows: list[Performance]
    curve: list[Point]
    reference: Reference
    equal_error: dict[float, dict[str, float]] = field(default_factory=dict)
    batch: int = 1
    equal_error_in_batch: dict[float, dict[str, float]] = field(default_factory=dict)

    def told(self) -> list[tuple[str, str]]:
        """Tell scenario, and of each method its time and error, in words."""
        return [
            ("scenario", self.scenario.name),
            *((row.method, brief(f"{row.solve_s:.3g} s, errors {row.relative_l2}")) for row in self.rows),
        ]

    @property
    def main_quantity(self) -> str:
        """The quantity whose error decides: the contact force, or the deflection under prescribed loads."""
        return next(iter(self.reference.quantities))


# So many solutions repay what it takes to load compiled loops.
@compiling(True)
def compare(
    scenario: Scenario,
    methods: Sequence[str] | None = None,
    *,
    batch: int = 1,
    curve: bool = True,
    memory: bool = True,
    runs: int = TIMING.runs,
    progress: Progress = silent,
) -> Comparison:
    """Solve one case by several methods and compare times, memory and errors.

    One thread. Times are medians of a few runs, after a short one that is not timed.

    Parameters
    ----------
    scenario : Scenario
        A vehicle on a rough road, or prescribed loads, on a track of an Euler–Bernoulli beam.
    methods : sequence of str, optional
        Names of methods; None: the usual ones.
    batch : int
        Cases that differ by their profile, or by their loads, alone: what a method prepares is shared by all of
        them, and the time of one, set-up / batch + solving, is told as well.
    curve : bool
        Whether to run the methods over a range of steps as well.
    memory : bool
        Whether to measure peak memory, each method in a process of its own.
    runs : int
        Number of runs of which the median is taken, at most: fewer where they take long.
    progress : callable
        Called with the name of a stage and the fraction of it that is done.

    Returns
    -------
    Comparison
        Table, curve, converged answer, times at equal error.

    Raises
    ------
    ValueError
        If a method is unknown or does not suit the scenario, or the guideway cannot be divided into elements.
    SolveError
        If the case has no meaningful answer.
    """
    with checking() as check:
        if not isinstance(scenario, Scenario):
            check.refuse("scenario", mistaken("scenario", scenario))
        batch = check.whole("batch", batch, least=1)
    compared = chosen(scenario, methods)
    own = Case(scenario=scenario, time_step=scenario.journey.time_step, element=elements(scenario.guideway)[-1])
    for case in (own, replace(own, element=elements(scenario.guideway)[0])):
        case.finite(travels=True)  # refuses what cannot be divided before anything long begins
    with threadpool_limits(limits=1), _quiet():
        # Whatever a method refuses it refuses here, before anything long begins.
        _warm_up(own, compared, progress)
        reference = converged(scenario, progress)
        own = replace(own, around=reference.around)
        timed = partial(_timed, runs=runs, batch=batch > 1)
        rows = [_row(name, method, own, reference, memory, timed, progress) for name, method in compared.items()]
        points = _curve(own, compared, reference, timed, progress) if curve else []
    first = next((row for row in rows if row.method == "moving-frf"), None)
    if first is not None:
        least = first.setup_s + first.solve_s
        rows = [row._replace(ratio=(row.setup_s + row.solve_s) / least) for row in rows]
    if batch > 1:
        rows = [row._replace(batch_s=row.setup_s / batch + row.solve_s) for row in rows]
    main = next(iter(reference.quantities))

    def equal(cases: int) -> dict[float, dict[str, float]]:
        return {
            target: {name: time_at(points, name, main, target, cases) for name in compared} for target in TARGETS
        }

    return Comparison(
        scenario=scenario,
        rows=rows,
        curve=points,
        reference=reference,
        equal_error=equal(1) if points else {},
        batch=batch,
        equal_error_in_batch=equal(batch) if points and batch > 1 else {},
    )


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep findings to themselves: they are those of the case, not of each of its many runs."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ValidityWarning)
        yield


def _warm_up(case: Case, methods: Mapping[str, Method], progress: Progress) -> None:
    """Run each method once, briefly: compiled loops are compiled, modules loaded."""
    journey = case.scenario.journey
    brief = min(journey.duration, max(TIMING.warm_up, 20 * journey.time_step))
    short = replace(case, scenario=shortened(case.scenario, brief))
    for number, (name, method) in enumerate(methods.items()):
        progress(f"loading {name}", number / len(methods))
        method.prepare(short)(short.given)


def _timed(method: Method, case: Case, *, runs: int, batch: bool) -> tuple[float, float, xr.Dataset]:
    """Median times of preparing and of solving [s], and the result.

    What the first case of a batch takes more than the next one is preparing, too.
    """
    setups: list[float] = []
    solves: list[float] = []
    began = time.perf_counter()
    while len(setups) < runs and (not setups or time.perf_counter() - began < TIMING.patience):
        given, other = case.given, case.given
        began_with_it = time.perf_counter()
        solve = method.prepare(case)
        prepared = time.perf_counter()
        result = solve(given)
        solved = time.perf_counter()
        if batch:
            solve(other)
        each = min(solved - prepared, time.perf_counter() - solved) if batch else solved - prepared
        solves.append(each)
        setups.append(solved - began_with_it - each)
    return statistics.median(setups), statistics.median(solves), result


def _row(
    name: str, method: Method, case: Case, reference: Reference, memory: bool, timed: Timed, progress: Progress
) -> Performance:
    progress(f"{name}, {case.time_step:g} s", 0.0)
    setup, solve, result = timed(method, case)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", ValidityWarning)
        method.prepare(case)(case.given)
    said = [str(warning.message) for warning in caught if issubclass(warning.category, ValidityWarning)]
    found, wanted = aligned(result, case, reference)
    if memory:
        progress(f"{name}, memory", 0.5)
    return Performance(
        name,
        case.time_step,
        case.element if method.divides else math.nan,
        setup,
        solve,
        peak_memory(name, case) if memory else 0,
        relative_l2(found, wanted),
        maximum_error(found, wanted),
        math.nan,
        list(dict.fromkeys(said)),
        math.nan,
    )


def _curve(
    case: Case, methods: Mapping[str, Method], reference: Reference, timed: Timed, progress: Progress
) -> list[Point]:
    """Run every method over a range of steps, and over some elements where it has any."""
    journey = case.scenario.journey
    # A step must leave a few samples, and be a whole multiple or part of the scenario's.
    steps = [factor * case.time_step for factor in TIMING.steps if factor * case.time_step <= journey.duration / 20]
    runs = [
        (name, replace(case, time_step=step, element=element))
        for name, method in methods.items()
        for element in (elements(case.scenario.guideway) if method.divides else [case.element])
        for step in steps
    ]
    points = []
    for number, (name, run) in enumerate(runs):
        progress(f"error over time: {name}, {run.time_step:g} s", number / len(runs))
        setup, solve, result = timed(methods[name], run)
        error = relative_l2(*aligned(result, run, reference))
        element = run.element if methods[name].divides else math.nan
        points.append(Point(name, run.time_step, element, setup + solve, error, setup))
    return points


def time_at(points: Sequence[Point], method: str, quantity: str, target: float, batch: int = 1) -> float:
    """Read from the error–time figure how long a method takes to an error.

    Parameters
    ----------
    points : sequence of Point
        The figure.
    method : str
        Name of the method.
    quantity : str
        Quantity whose relative L2 error counts.
    target : float
        That error, a ratio.
    batch : int
        Cases over which the set-up is shared.

    Returns
    -------
    float
        Least time [s] at which a line through the method's points, straight in the logarithms and at one length of
        elements, reaches the error; nan if none does.
    """
    times = []
    lines: dict[str, list[Point]] = {}
    for point in points:
        if point.method == method:
            lines.setdefault(str(point.element), []).append(point)
    for line in lines.values():
        line.sort(key=lambda point: -point.time_step)
        errors = np.log([max(point.relative_l2[quantity], 1e-300) for point in line])
        seconds = np.log([point.seconds - point.setup_s * (1 - 1 / batch) for point in line])
        aim = math.log(target)
        times += [float(value) for value, error in zip(seconds, errors, strict=True) if error <= aim]
        for n in range(len(line) - 1):
            if (errors[n] - aim) * (errors[n + 1] - aim) < 0:
                share = (aim - errors[n]) / (errors[n + 1] - errors[n])
                times.append(float(seconds[n] + share * (seconds[n + 1] - seconds[n])))
    return math.exp(min(times)) if times else math.nan


def peak_memory(name: str, case: Case) -> int:
    """Most memory that a method's arrays take at once, in a process of its own.

    Parameters
    ----------
    name : str
        Name of the method.
    case : Case
        The case.

    Returns
    -------
    int
        Bytes, as Python's tracemalloc counts them: all that NumPy allocates, from preparing to the result.

    Raises
    ------
    RuntimeError
        If the process fails.
    """
    scenario = case.scenario
    asked = {
        "method": name,
        "text": scenario.text,
        "folder": str(scenario.folder),
        "time_step": case.time_step,
        "element": case.element,
        "around": case.around,
    }
    command = [sys.executable, "-m", "movingfrf.studies.comparison.comparison"]
    done = carried_out(command, json.dumps(asked).encode())
    if done.returncode:
        raise RuntimeError(
            f"measuring the memory of {name} failed: {done.stderr[-2000:].decode('utf-8', 'replace')}"
        )
    return int(done.stdout)


def _measure_memory(asked: Mapping[str, Any]) -> int:
    """Measure the peak in this process."""
    scenario = parse_scenario(asked["text"], folder=asked["folder"])
    case = Case(scenario=scenario, time_step=asked["time_step"], element=asked["element"], around=asked["around"])
    method = (FOR_VEHICLE if isinstance(scenario.case, Drive) else FOR_LOADS)[asked["method"]]
    with threadpool_limits(limits=1), _quiet():
        _warm_up(case, {asked["method"]: method}, silent)
        given = case.given
        tracemalloc.start()
        method.prepare(case)(given)
        return tracemalloc.get_traced_memory()[1]


def ratios(comparison: Comparison, target: float, *, in_batch: bool = False) -> dict[str, float]:
    """Time of each method over that of moving-frf, at equal error.

    Parameters
    ----------
    comparison : Comparison
        What `compare` found.
    target : float
        The error, a ratio.
    in_batch : bool
        Whether times are those of a case in the batch.

    Returns
    -------
    dict of str to float
        By method; nan where either does not reach the error.
    """
    times = (comparison.equal_error_in_batch if in_batch else comparison.equal_error)[target]
    least = times.get("moving-frf", math.nan)
    return {name: seconds / least for name, seconds in times.items()}


if __name__ == "__main__":
    print(_measure_memory(json.load(sys.stdin)))

"""The search: a few samples of the ranges, then from the best of them downhill, with gradients."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import SolveError, ValidityWarning
from movingfrf._basics.progress import Progress
from movingfrf.metrics.slopes import slopes
from movingfrf.response.gradient import gradient, records_of
from movingfrf.response.random_gradient import random_gradient, statistic_slope
from movingfrf.response.ride import ride
from movingfrf.scenarios.scenario import drive_of
from movingfrf.studies.optimisation.problem import Limit, Problem
from movingfrf.studies.sweep.axes import Axes, Axis
from movingfrf.studies.sweep.plan import Plan
from movingfrf.studies.sweep.solving import Solved, solved

if TYPE_CHECKING:
    from scipy.optimize import OptimizeResult


@dataclass(frozen=True, slots=True, kw_only=True)
class Search:
    """What tunes the search; in brackets, between what each number is safe."""

    samples: int = 8  # of the ranges, or so many for each key, as a power of two [4 to 64: time and certainty]
    apart: float = 0.2  # starts lie so far from each other along some range [0.1 to 0.4]
    steps: int = 40  # from one start [20 to 200]
    accuracy: float = 1e-9  # of the measure, relative, at which it ends [1e-10 to 1e-7]
    kept: float = 1e-6  # a limit is kept up to this share of it [1e-8 to 1e-5]
    # A case that is impossible counts as so much worse than any other, in times of the largest.
    impossible: float = 10.0  # [2 to 100]


class Evaluated(NamedTuple):
    """A case that was tried."""

    shares: FloatArray  # along the range of each key
    case: Solved
    wanted: FloatArray  # what of it matters, in the order of `Problem.wanted`; nan where it has no answer


class Bound(NamedTuple):
    """What something that matters must not fall below, or exceed."""

    place: int  # of it among all that matters
    sign: float  # 1: not fall below, −1: not exceed
    end: float
    scale: float
    words: str = ""
    moves: bool = False  # whether it gives way, by what is made small

    def room(self, wanted: FloatArray, given: float = 0.0) -> float:
        """Say how far from it something is, in times of its scale; not negative where it is kept."""
        return self.sign * (float(wanted[self.place]) - self.end) / self.scale + given * self.moves

    def slope(self, slopes: FloatArray, moving: bool) -> FloatArray:
        """Say how that changes with the keys, and with how far bounds give way."""
        own: FloatArray = self.sign * slopes[self.place] / self.scale
        return np.append(own, float(self.moves)) if moving else own


class Searcher:
    """Tries values of the keys, and remembers what came out.

    Parameters
    ----------
    problem : Problem
        What is asked.
    progress : callable
        Called with the name of a stage and the fraction of it that is done.
    most : int
        About how many cases will be tried at most.
    """

    def __init__(self, problem: Problem, progress: Progress, most: int) -> None:
        self.problem, self._progress, self._most = problem, progress, most
        self.tried: list[Evaluated] = []
        self.gradients = 0
        self._known: dict[bytes, Evaluated] = {}
        self._slopes: dict[bytes, FloatArray] = {}
        self._variants = problem.plan.variants
        self._limits: list[Bound] | None = None

    def at(self, shares: FloatArray) -> Evaluated:
        """Try values so far along their ranges."""
        shares = np.clip(shares, 0.0, 1.0)
        asked = shares.tobytes()
        if asked not in self._known:
            plan = planned(self.problem, [self.problem.values(shares)])
            case = solved(plan, self._variants, 0, 1)
            wanted = np.array(
                [
                    case.values[measure][0][place] if not case.status[0] else np.nan
                    for measure, place in self.problem.wanted
                ]
            )
            found = self._known[asked] = Evaluated(shares, case, wanted)
            self.tried.append(found)
            self._progress("search", min(len(self.tried) / self._most, 1.0))
        return self._known[asked]

    def slopes(self, shares: FloatArray) -> FloatArray:
        """Say how what matters changes along the ranges, shape (wanted, key)."""
        shares = np.clip(shares, 0.0, 1.0)
        asked = shares.tobytes()
        if asked not in self._slopes:
            self.gradients += 1
            with warnings.catch_warnings():
                # They are told of each case.
                warnings.simplefilter("ignore", ValidityWarning)
                self._slopes[asked] = self._sloping(self.problem.values(shares))
        return self._slopes[asked]

    def _sloping(self, values: FloatArray) -> FloatArray:
        """Take derivatives at some values of the keys."""
        problem = self.problem
        scenario = self._variants.at(problem.named(values.tolist()))
        case, wanted = drive_of(scenario), problem.wanted
        near = [
            [
                (weight, problem.named([*values[:number], value, *values[number + 1 :]]))
                for weight, value in key.around(float(values[number]))
            ]
            for number, key in enumerate(problem.keys)
        ]
        stencils = [[(weight, drive_of(self._variants.at(named))) for weight, named in each] for each in near]
        if problem.plan.response == "simulate":
            found = ride(case.guideway, case.vehicle, case.road.profile, case.journey)  # type: ignore[arg-type]
            records, known = records_of(found), slopes()
            each = gradient(found, [known[measure](records, place) for measure, place in wanted], stencils)  # type: ignore[arg-type]
        else:
            result = scenario.at_random()
            statistics = [statistic_slope(result, measure, place) for measure, place in wanted]
            each = random_gradient(case, result.frequency.values, statistics, stencils)  # type: ignore[arg-type]
            for number, key in enumerate(problem.keys):
                # The band of a spectrum, and that of the response, may change as well.
                if key.paths[0].split(".")[0] in ("run", "roughness"):
                    each[:, number] = sum(weight * self._statistics(named) for weight, named in near[number])
        return each * [key.slope(value) for key, value in zip(problem.keys, values.tolist(), strict=True)]

    def _statistics(self, named: dict[str, float]) -> FloatArray:
        """Take the statistics of a case near by."""
        result = self._variants.at(named).at_random()
        return np.array([float(result[measure][place]) for measure, place in self.problem.wanted])

    def aim(self, tried: Evaluated) -> float:
        """Take what is made small: the measure, where it is largest."""
        return float(tried.wanted[self.aims].max())

    @property
    def aims(self) -> list[int]:
        """Where what is made small stands among what matters."""
        return self._places(self.problem.aim.measure, self.problem.aim.numbers)

    def _places(self, measure: str, numbers: Sequence[int]) -> list[int]:
        wanted = self.problem.wanted
        return [wanted.index((measure, number)) for number in numbers]

    def limits(self) -> list[Bound]:
        """Give all limits."""
        if self._limits is None:
            self._limits = [
                Bound(place, sign, end, self._scale(place, limit), f"{limit.of.measure} of {name}, {limit.words},")
                for limit in self.problem.limits
                for place, name in zip(
                    self._places(limit.of.measure, limit.of.numbers), limit.of.names, strict=True
                )
                for sign, end in ((1.0, limit.low), (-1.0, limit.high))
                if np.isfinite(end)
            ]
        return self._limits

    def _scale(self, place: int, limit: Limit) -> float:
        """Give the size of a limit; where that is zero, of what was found first."""
        own = max(abs(end) for end in (limit.low, limit.high) if np.isfinite(end))
        seen = (abs(float(tried.wanted[place])) for tried in self.tried if np.isfinite(tried.wanted[place]))
        return own or next((size for size in seen if size), 1.0)

    def exceeded(self, tried: Evaluated) -> float:
        """By how much the worst limit is exceeded, as a share of it; nan without an answer."""
        if not np.isfinite(tried.wanted).all():
            return np.nan
        return max(0.0, *(-bound.room(tried.wanted) for bound in self.limits()), 0.0)

    def order(self, tried: Evaluated) -> tuple[bool, float, float]:
        """Rank cases: those within the limits by what is made small, others by how far off they are."""
        exceeded = self.exceeded(tried)
        if not np.isfinite(exceeded):
            return (True, np.inf, np.inf)
        kept = exceeded <= Search().kept
        return (not kept, 0.0 if kept else exceeded, self.aim(tried))

    def best(self) -> Evaluated:
        """Best of all that was tried."""
        return min(self.tried, key=self.order)


def planned(problem: Problem, values: Sequence[FloatArray]) -> Plan:
    """Plan some evaluations as a sweep."""
    paths = tuple(path for key in problem.keys for path in key.paths)
    rows = (problem.named(each.tolist()) for each in values)
    axis = Axis(paths=paths, values=tuple(tuple(row[path] for path in paths) for row in rows), name="evaluation")
    return replace(problem.plan, axes=Axes([axis]))


def searched(problem: Problem, starts: int, progress: Progress) -> tuple[Searcher, list[OptimizeResult]]:
    """Search.

    Parameters
    ----------
    problem : Problem
        What is asked.
    starts : int
        From how many of the samples it goes downhill.
    progress : callable
        Called with the name of a stage and the fraction of it that is done.

    Returns
    -------
    searcher : Searcher
        All that was tried.
    runs : list of OptimizeResult
        How each way downhill ended.

    Raises
    ------
    SolveError
        If no case that was tried has an answer.
    """
    from scipy.stats import qmc

    tuned, keys = Search(), len(problem.keys)
    samples = 1 << max(tuned.samples * keys - 1, 1).bit_length()
    searcher = Searcher(problem, progress, samples + 1 + starts * (10 + 5 * keys))
    own = problem.own
    first = [] if own is None else [own]
    for shares in [*first, *np.asarray(qmc.Sobol(keys, seed=0).random(samples))]:
        searcher.at(shares)
    ranked = sorted(searcher.tried, key=searcher.order)
    if not np.isfinite(ranked[0].wanted).all():
        raise SolveError(
            f"none of {len(ranked)} cases within the ranges has an answer; the first: {ranked[0].case.status[0]}"
        )
    limits, aims = [*searcher.limits()], searcher.aims
    runs = []
    if searcher.exceeded(ranked[0]) > tuned.kept:
        # Into the limits first, or as near as can be.
        runs.append(_downhill(searcher, ranked[0], tuned, [each._replace(moves=True) for each in limits], 0.0))
        ranked = sorted(searcher.tried, key=searcher.order)
        if searcher.exceeded(ranked[0]) > tuned.kept:
            return searcher, runs
    size = abs(searcher.aim(ranked[0])) or 1.0
    if len(aims) > 1:
        limits += [Bound(place, -1.0, 0.0, size, moves=True) for place in aims]
    for start in _spread(ranked, starts, tuned.apart):
        runs.append(_downhill(searcher, start, tuned, limits, -np.inf))
    return searcher, runs


def _spread(ranked: Sequence[Evaluated], count: int, apart: float) -> Iterator[Evaluated]:
    """Choose the best, and the next best that lie apart from each other."""
    chosen: list[Evaluated] = []
    for tried in ranked:
        if not np.isfinite(tried.wanted).all() or len(chosen) == count:
            return
        if all(np.abs(tried.shares - other.shares).max() >= apart for other in chosen):
            chosen.append(tried)
            yield tried


def _downhill(
    searcher: Searcher, start: Evaluated, tuned: Search, bounds: Sequence[Bound], least: float
) -> OptimizeResult:
    """Go downhill by sequential quadratic programming, within bounds.

    Where bounds give way, how far they do is what is made small, down to the least: so is the largest of several
    measures, by a bound on all of them, which is smooth where the largest is not.
    """
    from scipy.optimize import OptimizeResult, minimize

    keys, aim, moving = len(searcher.problem.keys), searcher.aims[0], any(bound.moves for bound in bounds)
    size = abs(searcher.aim(start)) or 1.0
    last = start

    def at(x: FloatArray) -> FloatArray:
        """Give what matters; where there is no answer, that of the last case that has one."""
        nonlocal last
        tried = searcher.at(x[:keys])
        last = tried if np.isfinite(tried.wanted).all() else last
        return last.wanted

    def slopes(x: FloatArray) -> FloatArray:
        at(x)
        return searcher.slopes(last.shares)

    def small(x: FloatArray) -> float:
        found = x[-1] if moving else float(at(x)[aim] / size)
        # What is impossible is worse than all else: steps that lead there are made shorter.
        impossible = not np.isfinite(searcher.at(x[:keys]).wanted).all()
        return found + tuned.impossible * max(abs(found), 1.0) * impossible

    def down(x: FloatArray) -> FloatArray:
        return np.append(np.zeros(keys), 1.0) if moving else slopes(x)[aim] / size

    def room(x: FloatArray) -> FloatArray:
        wanted = at(x)
        return np.array([bound.room(wanted, x[-1]) for bound in bounds])

    def rooms(x: FloatArray) -> FloatArray:
        each = slopes(x)
        return np.array([bound.slope(each, moving) for bound in bounds])

    given = [max(-bound.room(start.wanted) for bound in bounds if bound.moves)] if moving else []
    try:
        return minimize(
            small,
            np.append(start.shares, given),
            jac=down,
            bounds=[(0.0, 1.0)] * keys + [(least, None)] * moving,
            constraints=[{"type": "ineq", "fun": room, "jac": rooms}] if bounds else [],
            method="SLSQP",
            options={"maxiter": tuned.steps, "ftol": tuned.accuracy},
        )
    except (ValueError, SolveError) as refused:
        # A derivative needs cases to either side of a value, and one of them is impossible.
        return OptimizeResult(x=last.shares, success=False, message=str(refused), nit=0)

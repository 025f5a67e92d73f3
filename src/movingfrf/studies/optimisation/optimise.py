"""The best values of keys of a scenario, within limits: `optimise`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from movingfrf._basics.checks import Finding, checking, warned
from movingfrf._basics.progress import Progress, silent
from movingfrf._basics.wording import count, number
from movingfrf.results.findings import with_more
from movingfrf.scenarios.scenario import Scenario
from movingfrf.studies.optimisation.problem import Problem, problem_of
from movingfrf.studies.optimisation.search import Evaluated, Search, Searcher, planned, searched
from movingfrf.studies.sweep.solving import Solved
from movingfrf.studies.sweep.sweep import gathered

if TYPE_CHECKING:
    import xarray as xr
    from scipy.optimize import OptimizeResult


def optimise(
    scenario: Scenario | str | Path | Mapping[str, Any],
    over: Mapping[Any, Any],
    minimise: str,
    *,
    contact: int | str | None = None,
    dof: int | str | None = None,
    where: Mapping[Any, Any] | None = None,
    response: str = "simulate",
    starts: int = 3,
    progress: Progress = silent,
) -> OptimizeResult:
    """Find the values of keys that make a measure smallest, within limits on others.

    The ranges are sampled (eight samples for each key, evenly spread, and the scenario as it is), then the search
    goes downhill from the best samples, by sequential quadratic programming with gradients. The same call finds the
    same. It cannot promise that there is nothing better elsewhere: more `starts` look at more places.

    Parameters
    ----------
    scenario : Scenario, str, Path or mapping
        A vehicle on a rough road: a scenario, a file, or its tables as a dict.
    over : mapping of str, or tuple of str, to tuple of float
        By the dotted path of a key, `vehicle.suspension_damping.0`, between which values it may be [in its own
        unit]; keys in a tuple have one value. Where the upper end is ten times the lower one or more, equal factors
        are equal steps.
    minimise : str
        A measure, as `sweep` calls it.
    contact, dof : int or str, optional
        Number or name of the contact, or of the degree of freedom, where it is taken. None: where it is largest, of
        all contacts, or of all degrees of freedom that are translations and move no contact: bodies and seats, but
        neither wheels nor rotations.
    where : mapping of str, or tuple of str and place, to float or tuple of float, optional
        Upper limits of measures [in their own units], or lower and upper ones with None for one that is not there:
        at all places that None means above, or at one, `("weighted_acceleration_rms", "cab")`.
    response : str
        `simulate`, or `random`: the response to all roads of a spectrum, as `random_response` computes it.
    starts : int
        From how many samples, apart from each other, the search goes downhill.
    progress : callable
        Called with the name of a stage and the fraction of it that is done.

    Returns
    -------
    scipy.optimize.OptimizeResult
        `x`, values in the order of the keys; `fun`, the measure there; `success`, whether all limits are kept and
        the search ended where there is no way down; `message` in words; `nfev` and `njev`, cases and gradients
        computed; `scenario`, a `Scenario` with these values; `table`, an xarray.Dataset of all cases that were
        tried, as `sweep` returns it.

    Raises
    ------
    ValueError
        If a range is empty or reversed, a key names nothing, a measure or place is unknown, or a key changes the
        road that is realised.
    SolveError
        If no case that was tried has an answer.

    Warns
    -----
    ValidityWarning
        If no values keep the limits, or the best one lies at an end of its range.

    References
    ----------
    D. Kraft, A software package for sequential quadratic programming, DFVLR-FB 88-28, 1988.

    Examples
    --------
    >>> import movingfrf as mf
    >>> tables = {
    ...     "guideway": {"kind": "rigid_guideway"},
    ...     "vehicle": {"kind": "quarter_car", "body_mass": 400.0, "wheel_mass": 40.0, "suspension_stiffness": 2e4,
    ...                 "suspension_damping": 1.5e3, "tyre_stiffness": 2e5},
    ...     "roughness": {"kind": "iso_road", "road_class": "B"},
    ...     "run": {"speed": 20.0, "duration": 10.0},
    ... }
    >>> best = mf.optimise(tables, over={"vehicle.suspension_damping": (500.0, 1e4)},
    ...                    minimise="weighted_acceleration", response="random")
    >>> best.success, best.scenario.case.vehicle.dof_names
    (True, ('body', 'wheel'))
    """
    problem = problem_of(scenario, over, minimise, contact=contact, dof=dof, where=where, response=response)
    return optimised(problem, starts=starts, progress=progress)


def optimised(problem: Problem, *, starts: int = 3, progress: Progress = silent) -> OptimizeResult:
    """Find the best values.

    Parameters
    ----------
    problem : Problem
        What is asked.
    starts : int
        From how many samples the search goes downhill.
    progress : callable
        Called with the name of a stage and the fraction of it that is done.

    Returns
    -------
    OptimizeResult
        As `optimise` returns it.

    Raises
    ------
    ValueError
        If `starts` is no whole number above zero.
    SolveError
        If no case that was tried has an answer.
    """
    from scipy.optimize import OptimizeResult

    with checking() as check:
        starts = check.whole("starts", starts, least=1)
    searcher, runs = searched(problem, starts, progress)
    best = searcher.best()
    values = problem.values(best.shares).tolist()
    # Status 8: no shorter step leads downhill, as where two peaks of a record are equal.
    ended = any(run.success or run.get("status") == 8 for run in runs)
    found = _findings(searcher, best, values, ended)
    table = tabled(problem, searcher)
    table.attrs["findings"] = with_more(table.attrs["findings"], warned(found))
    return OptimizeResult(
        x=problem.values(best.shares),
        fun=searcher.aim(best),
        success=bool(ended and not searcher.order(best)[0]),
        message=_message(searcher, best, values),
        nfev=len(searcher.tried),
        njev=searcher.gradients,
        nit=sum(int(run.nit) for run in runs),
        scenario=problem.plan.variants.at(problem.named(values)),
        table=table,
    )


def _message(searcher: Searcher, best: Evaluated, values: list[float]) -> str:
    """Say what was found."""
    problem = searcher.problem
    said = ", ".join(f"{key.name} = {key.told(value)}" for key, value in zip(problem.keys, values, strict=True))
    unit = problem.plan.way.measures[problem.aim.measure].units.split(" or ")[0]
    aim = f"The {problem.aim.words} is {number(searcher.aim(best))} {'' if unit == '1' else unit}".strip()
    own = problem.own
    given = searcher.at(own) if own is not None else None
    before = "" if given is None or given.case.status[0] else f", {number(searcher.aim(given))} as the scenario was"
    # So near that it is the limit that keeps it from being better [1e-5 to 1e-3].
    active = [
        f"{bound.words} is at its limit" for bound in searcher.limits() if abs(bound.room(best.wanted)) <= 1e-4
    ]
    tried = f"{count(len(searcher.tried), 'case')} and {count(searcher.gradients, 'gradient')} were computed"
    return f"{'; '.join([f'{aim}{before}, with {said}', *active, tried])}."


def _findings(searcher: Searcher, best: Evaluated, values: list[float], ended: bool) -> list[Finding]:
    """Say what is to be known of the best values."""
    problem, found = searcher.problem, []
    off = [
        f"{bound.words} is {number(float(best.wanted[bound.place]))}"
        for bound in searcher.limits()
        if bound.room(best.wanted) < -Search().kept
    ]
    if off:
        found.append(
            Finding("limits_not_kept", f"No values that were tried keep all limits; nearest: {'; '.join(off)}.")
        )
    elif not ended:
        found.append(Finding("search_not_ended", "The search was still on its way down when it was ended."))
    for key, value, share in zip(problem.keys, values, best.shares.tolist(), strict=True):
        if min(share, 1.0 - share) < 1e-6:
            end = "lower" if share < 0.5 else "upper"
            found.append(
                Finding(
                    "end_of_range",
                    f"{key.name} stands at the {end} end of its range, {key.told(value)}: beyond it there may be "
                    "better values.",
                )
            )
    return found


class _Tried:
    """All cases of a search, as a sweep keeps them."""

    def __init__(self, cases: list[Solved]) -> None:
        self._cases = cases

    def missing(self) -> list[int]:
        """Give the numbers of cases that are not there: none."""
        return []

    def put(self, number: int, solved: Solved) -> None:
        """Keep a case."""
        self._cases[number] = solved

    def all(self) -> Iterator[Solved]:
        """Go through all cases."""
        yield from self._cases


def tabled(problem: Problem, searcher: Searcher) -> xr.Dataset:
    """Make a table of all cases that were tried, in the order in which they were."""
    tried = searcher.tried
    plan = planned(problem, [problem.values(one.shares) for one in tried])
    table = gathered(plan, _Tried([one.case for one in tried]))
    return table.assign_attrs(title="Cases that a search has tried")

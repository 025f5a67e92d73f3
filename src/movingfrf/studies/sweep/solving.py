"""The cases of a sweep, one after the other: the measures of each, or why it has none."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import SolveError
from movingfrf._basics.compiling import compiling, numba_is_there
from movingfrf.response.batches import unthreaded
from movingfrf.scenarios.scenario import Drive
from movingfrf.scenarios.variants import Variants
from movingfrf.studies.sweep.plan import Plan


class Solved(NamedTuple):
    """Some cases of a sweep."""

    values: dict[str, list[FloatArray]]  # of each measure: per case (contact,) or (dof,), empty where there is none
    contacts: list[tuple[str, ...]]  # names, per case
    dofs: list[tuple[str, ...]]
    units: list[tuple[str, ...]]  # of the degrees of freedom
    status: list[str]  # why a case has no answer; empty where it has
    findings: list[str]  # codes of what is to be known about a case
    steps: list[float]  # steps in time of what was measured [s]
    histories: list[
        dict[str, FloatArray]
    ]  # per case by name, (time, contact) or (time, dof); empty unless asked for


@unthreaded
def solved(
    plan: Plan, variants: Variants, first: int, last: int, each: Callable[[int], None] = lambda done: None
) -> Solved:
    """Solve some cases.

    Parameters
    ----------
    plan : Plan
        The sweep.
    variants : Variants
        Its scenarios, which remember what they made.
    first, last : int
        Which cases, in the order in which they are solved.
    each : callable
        Called with the number of cases that are done.

    Returns
    -------
    Solved
        The cases in this order.
    """
    found = Solved({name: [] for name in plan.measures}, [], [], [], [], [], [], [])
    # Compiled or not, from the first case to the last: which of them a process solves changes no digit.
    with compiling(numba_is_there()):
        for done, places in enumerate(plan.axes.numbers(first, last)):
            _add(found, plan, variants, plan.axes.values(places))
            each(done + 1)
    return found


def _add(found: Solved, plan: Plan, variants: Variants, values: dict[str, object]) -> None:
    """Solve a case, or say why it has no answer."""
    contacts: tuple[str, ...] = ()
    dofs: tuple[str, ...] = ()
    units: tuple[str, ...] = ()
    findings, status, step = "", "", np.nan
    measured: dict[str, FloatArray] = dict.fromkeys(plan.measures, np.zeros(0))
    histories: dict[str, FloatArray] = {}
    try:
        case = variants.at(values, told=False).case
        if not isinstance(case, Drive):
            raise ValueError("prescribed loads are not swept")
        vehicle = case.vehicle
        contacts, dofs = tuple(contact.name for contact in vehicle.contacts), tuple(vehicle.dof_names)
        units = tuple(np.asarray(vehicle.coordinates["dof_unit"]).tolist())
        answer = plan.way.solve(case, plan.stated)
        findings, step = ", ".join(dict.fromkeys(answer.findings)), answer.time_step
        measured = answer.measured(plan.measures)
        histories = answer.histories() if plan.histories else {}
    except (ValueError, SolveError) as refused:
        status = "; ".join(line.strip() for line in str(refused).splitlines())
    for name in plan.measures:
        found.values[name].append(measured[name])
    for where, what in zip(found[1:], (contacts, dofs, units, status, findings, step, histories), strict=True):
        where.append(what)  # type: ignore[attr-defined]

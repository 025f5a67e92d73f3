"""The answer that all methods are measured against, and how far from it one is."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import SolveError
from movingfrf._basics.progress import Progress, silent, under
from movingfrf.guideways.guideway import Guideway
from movingfrf.scenarios.scenario import Drive, Scenario
from movingfrf.scenarios.stepped import DISCRETISATION, elements, stands_still
from movingfrf.stepping.finite_guideway import FiniteGuideway
from movingfrf.studies.comparison.methods import Case, newmark, stepped

if TYPE_CHECKING:
    import xarray as xr


# Errors at which methods are compared for time.
TARGETS = (1e-3, 1e-4)


@dataclass(frozen=True, slots=True, kw_only=True)
class Refinement:
    """What tunes the search for the converged answer; in brackets, between what each number is safe."""

    # Movement at which it counts as converged [1e-6 to 1e-5, a tenth of the least target].
    enough: float = 5e-6
    hopeless: float = 5e-2  # movement at which it is none [a convention]
    levels: int = 4  # how often step and elements are halved at most [4 to 5; after 3 it still moves by 2e-5]
    # The same of a finite plate, where each costs some twenty times as much as the last [2 to 3: it takes two to
    # see the answer move].
    levels_across: int = 2
    # Where no longer stretch at either side is tried, in lengths over which the road bends [100 to 400].
    farthest: float = 200.0
    unseen: float = 0.2  # share of the least target that the ends of a compared road may add [0.05 to 0.5]


REFINEMENT = Refinement()

Quantities = dict[str, FloatArray]


class Reference(NamedTuple):
    """The converged answer, and by how much it still moved when it was refined last."""

    quantities: Quantities
    time_step: float  # of what is kept
    movement: dict[str, float]
    finest_step: float
    finest_element: float
    # Road at each side that the compared errors do not see, in lengths over which it bends; nan of a finite road.
    around: float


def quantities(result: xr.Dataset, scenario: Scenario) -> Quantities:
    """Pick what is compared of a result: arrays of shape (time, channel).

    Parameters
    ----------
    result : xarray.Dataset
        What any method returned.
    scenario : Scenario
        The case.

    Returns
    -------
    dict of str to ndarray
        Dynamic contact force [N], deflection without the sag [m], acceleration of the degrees of freedom that touch
        the road [m/s²]; the deflection alone under prescribed loads. Where nothing is steady, on a bridge,
        the contact force is that without the weight, and the deflection is the whole.
    """
    if not isinstance(scenario.case, Drive):
        return {"deflection": result.deflection.values}
    vehicle = scenario.case.vehicle
    wheels = np.flatnonzero(np.abs(np.asarray(vehicle.contact_map)).any(axis=0))
    force, deflection = result.contact_force.values, result.deflection.values
    if stands_still(scenario.guideway):
        force = force + (result.static_load.values - vehicle.static_loads)
    else:
        deflection = deflection - result.static_deflection.values
    return {
        "contact_force": force,
        "deflection": deflection,
        "wheel_acceleration": result.acceleration.values[:, wheels],
    }


def converged(scenario: Scenario, progress: Progress = silent) -> Reference:
    """Lengthen the road, then refine mesh and step together, until the extrapolated answer no longer moves.

    A finite road stays as long as it is, and one that is given by its matrices as fine as it is. Errors fall with
    the square of the step, or faster, so that (4 fine − coarse)/3 is the better answer.

    Parameters
    ----------
    scenario : Scenario
        The case.
    progress : callable
        As everywhere.

    Returns
    -------
    Reference
        At the scenario's own steps.

    Raises
    ------
    SolveError
        If the answer does not converge.
    """
    guideway = scenario.guideway
    endless = not isinstance(guideway, FiniteGuideway)
    step, element = scenario.journey.time_step, elements(guideway)[0]
    prepare = stepped if isinstance(scenario.case, Drive) else newmark

    def solved(level: int, around: float) -> Quantities:
        case = Case(scenario=scenario, time_step=step / 2**level, element=element / 2**level, around=around)
        heading = f"converged answer, refinement {level}"
        result = prepare(case, travels=endless, progress=under(heading, progress))(case.given)
        return {name: values[:: 2**level].copy() for name, values in quantities(result, scenario).items()}

    # First the length of the road, coarsely: what comes back from its ends changes the answer like a mesh error.
    around, enough, from_ends = DISCRETISATION.around, math.nan, dict[str, float]()
    coarse = solved(0, around)
    while endless:
        wider = solved(0, 2 * around)
        from_ends = relative_l2(coarse, wider)
        if math.isnan(enough) and next(iter(from_ends.values())) <= REFINEMENT.unseen * min(TARGETS):
            enough = around
        if max(from_ends.values()) <= REFINEMENT.enough or around >= REFINEMENT.farthest:
            break
        around, coarse = 2 * around, wider
    answers: list[Quantities] = []
    movement: dict[str, float] = {}
    plate = isinstance(guideway, FiniteGuideway) and guideway.width > 0
    for level in range(1, 1 + (REFINEMENT.levels_across if plate else REFINEMENT.levels)):
        fine = solved(level, around)
        answers.append({name: (4 * fine[name] - coarse[name]) / 3 for name in fine})
        coarse = fine
        if len(answers) > 1:
            movement = relative_l2(answers[-2], answers[-1])
            if max(movement.values()) <= REFINEMENT.enough:
                break
    movement = {name: max(moved, from_ends.get(name, 0.0)) for name, moved in movement.items()}
    if not min(movement.values()) <= REFINEMENT.hopeless:
        raise SolveError(
            f"the answer from the time domain does not converge: it still moves by {min(movement.values()):.1e} "
            f"at the last halving of {refined(guideway)}, to {step / 2**level:.3g} s; the scenario's "
            f"time_step, {step:g} s, is too long, or its loads begin or end too abruptly"
        )
    enough = around if endless and math.isnan(enough) else enough
    return Reference(answers[-1], step, movement, step / 2**level, element / 2**level, enough)


def refined(guideway: Guideway | FiniteGuideway) -> str:
    """Say what is halved, again and again, on the way to the converged answer.

    Parameters
    ----------
    guideway : Guideway or FiniteGuideway
        The road; one that is given by its matrices is as fine as it is.

    Returns
    -------
    str
        Step and elements, or the step alone.
    """
    given = isinstance(guideway, FiniteGuideway) and guideway.finer is None
    return "the step alone" if given else "step and elements"


def relative_l2(found: Quantities, wanted: Quantities) -> dict[str, float]:
    """Relative L2 difference of each quantity, its worst channel.

    Parameters
    ----------
    found, wanted : dict of str to ndarray
        Quantities at the same times.

    Returns
    -------
    dict of str to float
        By quantity; of a channel that is zero the difference itself.
    """
    return {name: _worst(found[name] - wanted[name], wanted[name], _root_mean_square) for name in wanted}


def maximum_error(found: Quantities, wanted: Quantities) -> dict[str, float]:
    """Largest difference of each quantity over its largest value, the worst channel.

    Parameters
    ----------
    found, wanted : dict of str to ndarray
        Quantities at the same times.

    Returns
    -------
    dict of str to float
        By quantity.
    """
    return {name: _worst(found[name] - wanted[name], wanted[name], _largest) for name in wanted}


def _root_mean_square(values: FloatArray) -> FloatArray:
    size: FloatArray = np.sqrt(np.mean(values**2, axis=0))
    return size


def _largest(values: FloatArray) -> FloatArray:
    size: FloatArray = np.abs(values).max(axis=0)
    return size


def _worst(difference: FloatArray, wanted: FloatArray, size: Callable[[FloatArray], FloatArray]) -> float:
    scale = size(wanted)
    return float((size(difference) / np.where(scale > 0, scale, 1.0)).max())


def aligned(result: xr.Dataset, case: Case, reference: Reference) -> tuple[Quantities, Quantities]:
    """Quantities of a result and of the converged answer at the times that both have."""
    found = quantities(result, case.scenario)
    ratio = case.time_step / reference.time_step
    # The coarser of the two steps is a whole multiple of the other.
    mine, its = (1, round(ratio)) if ratio >= 1 else (round(1 / ratio), 1)
    pairs = {name: (found[name][::mine], reference.quantities[name][::its]) for name in found}
    count = min(len(values) for pair in pairs.values() for values in pair)
    return {name: a[:count] for name, (a, _) in pairs.items()}, {name: b[:count] for name, (_, b) in pairs.items()}

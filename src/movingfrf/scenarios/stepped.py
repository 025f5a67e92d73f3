"""A case stepped in time: on the finite road that it has, or on one that is cut out of its endless track."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import checking
from movingfrf._basics.progress import Progress, silent
from movingfrf.guideways.beams import EulerBernoulliBeam
from movingfrf.guideways.guideway import Guideway
from movingfrf.guideways.track import Track
from movingfrf.roughness.profile import Profile
from movingfrf.stepping.coupled import prepared_journey
from movingfrf.stepping.exchange import SOLVED, Iteration
from movingfrf.stepping.finite_guideway import FiniteGuideway
from movingfrf.stepping.finite_track import bending_length, finite_track
from movingfrf.stepping.moving_loads import prepared_passage
from movingfrf.stepping.requirements import require_on_guideway
from movingfrf.vehicles.journey import Journey
from movingfrf.vehicles.vehicle import Vehicle

if TYPE_CHECKING:
    import xarray as xr


# How `sim` finds contact forces unless told otherwise.
EXCHANGED = Iteration(1e-10)


@dataclass(frozen=True, slots=True, kw_only=True)
class Discretisation:
    """How the endless road becomes one that can be stepped; in brackets, between what each number is safe.

    Lengths are multiples of the one over which the road bends, (4 EI/k)^¼.
    """

    # Road in front of and behind the vehicle; a comparison doubles it until its ends are not seen [10 to 56].
    around: float = 14.0
    absorbing: float = 0.6  # share of it that absorbs [0.4 to 0.8]
    # Elements that are tried, rounded, the longest first [0.1 to 0.3: longer ones do not carry the waves at 70 Hz].
    elements: tuple[float, ...] = (0.3, 0.15)
    # Time for which weights travel over the smooth road before a record begins [s] [1 to 4; from 2 where a
    # foundation has a tenth of a pavement's damping]. On a finite road no longer than the road reaches back.
    run_in: float = 1.0
    # Such a shorter run-in is a multiple of so many steps, so that the longest steps of a comparison begin where
    # the case's own do [a multiple of the longest].
    together: int = 8


DISCRETISATION = Discretisation()


@dataclass(frozen=True, slots=True, kw_only=True)
class Division:
    """How a road is divided into elements.

    Parameters
    ----------
    element : float
        Length of an element [m]; nan on a finite road that is given by its matrices.
    around : float
        Road in front of and behind the vehicle, in lengths over which it bends; of no meaning on a finite road.
    travels : bool
        Whether what is cut out of an endless road travels along.
    """

    element: float
    around: float = DISCRETISATION.around
    travels: bool = False


def elements(guideway: Guideway | FiniteGuideway) -> list[float]:
    """Choose lengths of elements: round numbers near shares of the length over which a track bends.

    Parameters
    ----------
    guideway : Guideway or FiniteGuideway
        An endless track, or a finite road, which has elements of its own.

    Returns
    -------
    list of float
        Lengths [m], descending; nan of a finite road that is given by its matrices.

    Raises
    ------
    ValueError
        If an endless guideway cannot be divided into elements.
    """
    if isinstance(guideway, FiniteGuideway):
        return [math.nan if guideway.finer is None else guideway.spacing]
    length = bending_length(divisible(guideway))
    return [_rounded(share * length) for share in DISCRETISATION.elements]


def stands_still(guideway: Guideway | FiniteGuideway) -> bool:
    """Tell whether a road need not be the same everywhere: a finite one that does not travel along.

    Parameters
    ----------
    guideway : Guideway or FiniteGuideway
        The road.

    Returns
    -------
    bool
        Whether it stands still.
    """
    return isinstance(guideway, FiniteGuideway) and not guideway.travels


def require_endless(guideway: Guideway | FiniteGuideway, *, instead: str) -> Guideway:
    """Give a guideway that has moving FRFs.

    Parameters
    ----------
    guideway : Guideway or FiniteGuideway
        The guideway.
    instead : str
        Method that a finite road is for.

    Returns
    -------
    Guideway
        The same.

    Raises
    ------
    ValueError
        If it is a finite road.
    """
    if isinstance(guideway, FiniteGuideway):
        raise ValueError(
            "guideway is a finite road, which has no moving FRF; step it through time: "
            f"`movingfrf run FILE --method {instead}`, or run(method={instead!r}) in Python"
        )
    return guideway


def require_journey(road: FiniteGuideway, places: FloatArray, journey: Journey, *, what: str) -> None:
    """Refuse a journey that leads off a finite road.

    Parameters
    ----------
    road : FiniteGuideway
        The road.
    places : ndarray
        Where contacts, or loads and observers, stand, ahead of the reference point [m].
    journey : Journey
        How they travel.
    what : str
        What they are, for the message.

    Raises
    ------
    ValueError
        If it does.
    """
    end = journey.start + journey.speed * journey.time_step * journey.samples
    with checking() as check:
        travel = (0.0, road.spacing) if road.travels else (journey.start, end)
        require_on_guideway(check, road, places, travel, what=f"{what} travel")


def divisible(guideway: Guideway) -> Track:
    """Give an endless guideway as a track that can be divided into elements.

    Parameters
    ----------
    guideway : Guideway
        The guideway.

    Returns
    -------
    Track
        The same.

    Raises
    ------
    ValueError
        If it is no track with an Euler–Bernoulli beam.
    """
    if isinstance(guideway, Track) and isinstance(guideway.beam, EulerBernoulliBeam):
        return guideway
    kind = type(guideway.beam if isinstance(guideway, Track) else guideway).__name__
    raise ValueError(
        "guideway must be a track with an Euler–Bernoulli beam, since all methods but moving-frf divide it into "
        f"finite elements, got a {kind}"
    )


def coupled(
    parts: tuple[Guideway | FiniteGuideway, Vehicle],
    journey: Journey,
    division: Division,
    *,
    superposed: bool = True,
    run_in: float | None = None,
    iteration: Iteration = SOLVED,
    progress: Progress = silent,
) -> Callable[[Profile], xr.Dataset]:
    """Prepare a vehicle's journey, stepped together with the road.

    Parameters
    ----------
    parts : tuple of Guideway or FiniteGuideway, and Vehicle
        Who travels on what.
    journey : Journey
        How.
    division : Division
        Elements of the road.
    superposed : bool
        Whether the weight travels in a run of its own where the road is the same everywhere, endless or travelling
        along; along another it is always stepped along.
    run_in : float, optional
        Time for which the weight travels before the record [s]; None: what `run_in_of` finds.
    iteration : Iteration
        How contact forces are found in each step.
    progress : callable
        As everywhere.

    Returns
    -------
    callable
        Steps through the journey over a profile and returns the result of `cdfm` or `sim`.
    """
    guideway, vehicle = parts
    before = run_in_of(guideway, vehicle.positions, journey) if run_in is None else run_in
    return prepared_journey(
        journey,
        (stretch(guideway, vehicle.positions, journey, division, before), vehicle),
        iteration=iteration,
        superposed=superposed and not stands_still(guideway),
        run_in=before,
        progress=progress,
    )


def loaded(
    guideway: Guideway | FiniteGuideway,
    places: tuple[FloatArray, FloatArray],
    journey: Journey,
    division: Division,
    *,
    progress: Progress = silent,
) -> Callable[[FloatArray], xr.Dataset]:
    """Prepare the passage of prescribed loads along a road.

    Parameters
    ----------
    guideway : Guideway or FiniteGuideway
        The road.
    places : tuple of ndarray
        Where forces act, and where the deflection is wanted [m].
    journey : Journey
        How they travel.
    division : Division
        Elements of the road.
    progress : callable
        As everywhere.

    Returns
    -------
    callable
        Steps through the passage of forces, shape (time, load) [N], and returns the result of `newmark_loads`.
    """
    positions, observe = places
    return prepared_passage(
        stretch(guideway, np.concatenate(places), journey, division),
        positions,
        observe,
        speed=journey.speed,
        time_step=journey.time_step,
        samples=journey.samples,
        progress=progress,
    )


def run_in_of(guideway: Guideway | FiniteGuideway, places: FloatArray, journey: Journey) -> float:
    """Time for which the weight travels along the smooth road before the record [s].

    Parameters
    ----------
    guideway : Guideway or FiniteGuideway
        The road; a finite one has to reach back far enough.
    places : ndarray
        Where contacts stand, ahead of the reference point [m].
    journey : Journey
        How they travel.

    Returns
    -------
    float
        A second, or what a finite road has room for; nothing on a bridge that the record begins at the end of.
    """
    if not isinstance(guideway, FiniteGuideway) or guideway.travels:
        return DISCRETISATION.run_in
    behind = (journey.start + float(places.min()) - guideway.interval[0]) / journey.speed
    step = DISCRETISATION.together * journey.time_step
    return min(DISCRETISATION.run_in, max(0.0, math.floor(behind / step * (1 + 1e-12)) * step))


def stretch(
    guideway: Guideway | FiniteGuideway,
    places: FloatArray,
    journey: Journey,
    division: Division,
    run_in: float = 0.0,
) -> FiniteGuideway:
    """Give the road to step on: a finite one itself, of a track what the journey needs.

    Parameters
    ----------
    guideway : Guideway or FiniteGuideway
        The road.
    places : ndarray
        Where contacts, or loads and observers, stand, ahead of the reference point [m].
    journey : Journey
        How they travel.
    division : Division
        Elements of the road.
    run_in : float
        Time for which they travel before the record [s].

    Returns
    -------
    FiniteGuideway
        With elements of that length.

    Raises
    ------
    ValueError
        If an endless guideway cannot be divided into elements, or elements do not suit it.
    """
    if isinstance(guideway, FiniteGuideway):
        parts = 1 if guideway.finer is None else round(guideway.spacing / division.element)
        return guideway if guideway.finer is None or parts == 1 else guideway.finer(parts)
    track, element = divisible(guideway), division.element
    around = division.around * bending_length(track)
    first, last = places.min() - around, places.max() + around
    if not division.travels:
        first += journey.start - run_in * journey.speed
        last += journey.start + journey.distance
    # Nodes at multiples of the element, wherever the track ends: its length must not change the mesh.
    return finite_track(
        track,
        first=math.floor(first / element) * element,
        last=math.ceil(last / element) * element,
        element=element,
        absorbing=DISCRETISATION.absorbing * around,
        travels=division.travels,
    )


def _rounded(value: float) -> float:
    """Round down to 1, 2 or 5 times a power of ten, or a quarter of that."""
    power = 10.0 ** math.floor(math.log10(value))
    return max(step * power for step in (0.5, 1.0, 1.25, 2.0, 2.5, 5.0) if step * power <= value * (1 + 1e-9))

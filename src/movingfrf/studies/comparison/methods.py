"""The methods that can be compared, each a function that prepares a case and returns what solves it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from copy import copy
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import nearest, spelt
from movingfrf._basics.compiling import numba_is_there
from movingfrf._basics.progress import Progress, silent
from movingfrf.guideways.foundations import OnMass
from movingfrf.guideways.guideway import Guideway
from movingfrf.guideways.track import Track
from movingfrf.response.simulation import driven
from movingfrf.response.survey import survey
from movingfrf.response.system import System
from movingfrf.roughness.profile import Profile
from movingfrf.scenarios.forces import Loads
from movingfrf.scenarios.scenario import Drive, Passage, Scenario, drive_of, passage_of
from movingfrf.scenarios.stepped import (
    DISCRETISATION,
    EXCHANGED,
    Division,
    coupled,
    divisible,
    loaded,
    require_endless,
    run_in_of,
    stretch,
)
from movingfrf.stepping.duhamel import convolved, duhamel_loads
from movingfrf.stepping.exchange import SOLVED, Iteration
from movingfrf.stepping.finite_guideway import FiniteGuideway
from movingfrf.stepping.impulse import CANCELLING, struck_track
from movingfrf.vehicles.journey import Journey
from movingfrf.vehicles.vehicle import Vehicle

if TYPE_CHECKING:
    import xarray as xr


# What solves a prepared case: of a profile, or of prescribed loads. Preparing does not see them, so that what is
# prepared serves every case of a batch.
Solve = Callable[[Any], "xr.Dataset"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Case:
    """A scenario with its step and the length of the road's elements.

    Parameters
    ----------
    scenario : Scenario
        The scenario.
    time_step : float
        Step in time [s].
    element : float
        Length of an element [m].
    around : float
        Road in front of and behind the vehicle, in lengths over which it bends.
    """

    scenario: Scenario
    time_step: float
    element: float
    around: float = DISCRETISATION.around

    @property
    def journey(self) -> Journey:
        """The scenario's journey in this case's steps, no longer than in its own: the profile ends there."""
        journey = self.scenario.journey
        samples = math.floor(journey.samples * journey.time_step / self.time_step * (1 + 1e-12))
        return replace(journey, time_step=self.time_step, duration=samples * self.time_step)

    @property
    def track(self) -> Track:
        """The guideway, known to be a track of beam and foundation."""
        assert isinstance(self.scenario.guideway, Track)
        return self.scenario.guideway

    @property
    def places(self) -> FloatArray:
        """Where contacts, or loads and observers, stand, ahead of the reference point [m]."""
        return self.scenario.case.places

    @property
    def offsets(self) -> FloatArray:
        """Every distance from a contact or load to a contact or observer [m]."""
        return np.unique(self.scenario.case.offsets["ahead"])

    @property
    def vehicle(self) -> Vehicle:
        """The vehicle."""
        return drive_of(self.scenario).vehicle

    @property
    def given(self) -> Profile | Loads:
        """What differs from case to case of a batch: profile or loads, a copy that remembers nothing."""
        case = self.scenario.case
        return replace(case.loads) if isinstance(case, Passage) else replace(case.road.profile)

    @property
    def run_in(self) -> float:
        """Time for which the weight travels before the record [s]: the same whatever this case's step."""
        return run_in_of(self.scenario.guideway, self.places, self.scenario.journey)

    def division(self, *, travels: bool = False) -> Division:
        """Say how this case divides a road into elements."""
        return Division(element=self.element, around=self.around, travels=travels)

    def finite(self, *, travels: bool = False) -> FiniteGuideway:
        """Give the road that this case steps on: all that the journey needs, or what travels along."""
        before = self.run_in if isinstance(self.scenario.case, Drive) else 0.0
        return stretch(self.scenario.guideway, self.places, self.journey, self.division(travels=travels), before)


def _transformed(case: Case, guideway: Guideway) -> Solve:
    """Solve in the frequency domain, on any guideway."""
    if isinstance(case.scenario.case, Passage):
        passage = replace(case.scenario.case, guideway=guideway, journey=case.journey)
        return lambda loads: replace(passage, loads=loads).run()
    # Copies remember nothing: no batch finds done what another one did. What they imply is prepared.
    known, vehicle, journey = copy(guideway), copy(case.vehicle), case.journey
    survey(System.of(known, vehicle, journey.speed))
    return lambda profile: driven(known, vehicle, profile, journey)


def _moving_frf(case: Case) -> Solve:
    return _transformed(case, require_endless(case.scenario.guideway, instead="cdfm"))


def _moving_frf_fe(case: Case, *, plain: bool = False) -> Solve:
    struck = struck_track(case.track, speed=case.journey.speed, offsets=case.offsets, plain=plain)
    return _transformed(case, struck)


def _moving_frf_fe_plain(case: Case) -> Solve:
    return _moving_frf_fe(case, plain=True)


def _duhamel(case: Case) -> Solve:
    # The step of the integral is a whole multiple of that of the struck road, which is no longer than its recipe's.
    per_step = math.ceil(case.time_step / CANCELLING.time_step - 1e-9)
    struck = struck_track(
        case.track,
        speed=case.journey.speed,
        offsets=case.offsets,
        time_step=case.time_step / per_step,
    )
    journey = case.journey
    if isinstance(case.scenario.case, Passage):
        return lambda loads: duhamel_loads(
            struck,
            loads.at(journey.times),
            loads.positions,
            speed=journey.speed,
            time_step=journey.time_step,
            observe=loads.observe,
        )
    vehicle = case.vehicle
    return lambda profile: convolved(struck, vehicle, profile, journey)


def stepped(
    case: Case,
    *,
    travels: bool = False,
    superposed: bool = True,
    iteration: Iteration = SOLVED,
    progress: Progress = silent,
) -> Solve:
    """Step vehicle and road; where the road is the same everywhere the weight has a run of its own."""
    return coupled(
        (case.scenario.guideway, case.vehicle),
        case.journey,
        case.division(travels=travels),
        superposed=superposed,
        run_in=case.run_in,
        iteration=iteration,
        progress=progress,
    )


def _cdfm(case: Case) -> Solve:
    return stepped(case)


def _cdfm_window(case: Case) -> Solve:
    return stepped(case, travels=True)


def _cdfm_weight(case: Case) -> Solve:
    return stepped(case, superposed=False)


def _sim(case: Case) -> Solve:
    return stepped(case, iteration=EXCHANGED)


def newmark(case: Case, *, travels: bool = False, progress: Progress = silent) -> Solve:
    """Step the road under prescribed loads."""
    loads, journey = passage_of(case.scenario).loads, case.journey
    division = case.division(travels=travels)
    solve = loaded(case.scenario.guideway, (loads.positions, loads.observe), journey, division, progress=progress)
    return lambda loads: solve(loads.at(journey.times))


def _newmark_window(case: Case) -> Solve:
    return newmark(case, travels=True)


@dataclass(frozen=True, slots=True, kw_only=True)
class Method:
    """One way to solve a case.

    Parameters
    ----------
    prepare : callable
        Prepares a case, all that a batch shares, and returns what solves it of a profile or of loads.
    words : str
        What the method does, in a few words.
    divides : bool
        Whether it divides the road of the journey into elements, whose length matters.
    finite : bool
        Whether it runs on a finite road as it is.
    strikes : bool
        Whether it strikes 40 m of road.
    usual : bool
        Whether it is compared if nobody says what.
    beside : str, optional
        The variant that is shown beside it.
    """

    prepare: Callable[[Case], Solve]
    words: str
    divides: bool = False
    finite: bool = False
    strikes: bool = False
    usual: bool = False
    beside: str | None = None

    @property
    def shares(self) -> str:
        """What it prepares, and a batch shares, in a few words."""
        if self.strikes:
            return "the moving impulse response of the struck road"
        if self.divides:
            return "the mesh, the factorised matrices and, with a vehicle, the smooth run-in"
        return "what the guideway and, with a vehicle, that imply: critical speed, modes, moving FRFs"


FOR_VEHICLE: dict[str, Method] = {
    "moving-frf": Method(prepare=_moving_frf, words="moving FRF in closed form", usual=True),
    "moving-frf-fe": Method(
        prepare=_moving_frf_fe,
        words="moving FRF of 40 m of finite elements, end reflections cancelled",
        strikes=True,
        usual=True,
    ),
    "moving-frf-fe-plain": Method(
        prepare=_moving_frf_fe_plain, words="moving FRF of 40 m of finite elements, as in the paper", strikes=True
    ),
    "duhamel": Method(
        prepare=_duhamel,
        words="Duhamel's integral with the moving impulse response of the finite elements",
        strikes=True,
        usual=True,
    ),
    "cdfm": Method(
        prepare=_cdfm,
        words="coupled method, the whole road",
        divides=True,
        finite=True,
        usual=True,
        beside="cdfm-window",
    ),
    "cdfm-window": Method(
        prepare=_cdfm_window, words="coupled method, a stretch of road that travels along", divides=True
    ),
    "cdfm-weight": Method(
        prepare=_cdfm_weight,
        words="coupled method, the whole road, the weight stepped as well",
        divides=True,
        finite=True,
    ),
    "sim": Method(
        prepare=_sim, words="separate iterative method, the whole road", divides=True, finite=True, usual=True
    ),
}
FOR_LOADS: dict[str, Method] = {
    **{name: FOR_VEHICLE[name] for name in ("moving-frf", "moving-frf-fe", "moving-frf-fe-plain", "duhamel")},
    "newmark": Method(
        prepare=newmark,
        words="Newmark's method, the whole road",
        divides=True,
        finite=True,
        usual=True,
        beside="newmark-window",
    ),
    "newmark-window": Method(
        prepare=_newmark_window, words="Newmark's method, a stretch of road that travels along", divides=True
    ),
}


def chosen(scenario: Scenario, names: Sequence[str] | None) -> dict[str, Method]:
    """Look methods up by name; a variant stands beside its method.

    Parameters
    ----------
    scenario : Scenario
        The case.
    names : sequence of str, optional
        Names; None: the usual ones.

    Returns
    -------
    dict of str to Method
        By name.

    Raises
    ------
    ValueError
        If a method is unknown or does not suit the scenario or its road, or the guideway cannot be divided into
        elements.
    """
    with_vehicle = isinstance(scenario.case, Drive)
    known, others = (FOR_VEHICLE, FOR_LOADS) if with_vehicle else (FOR_LOADS, FOR_VEHICLE)
    guideway = scenario.guideway
    ends = isinstance(guideway, FiniteGuideway)
    if not isinstance(guideway, FiniteGuideway):
        divisible(guideway)
    if isinstance(scenario.case, Drive) and np.isinf(scenario.case.vehicle.springs).any():
        raise ValueError(
            "the vehicle has rigid contacts (stiffness = inf), which only the moving FRF knows, so there is "
            "nothing to compare: give each contact a finite stiffness [N/m], as hertzian_stiffness does for a "
            "wheel on a rail"
        )
    # 40 m of road have no room for a vehicle longer than 16 m: what strikes them is then not among the usual ones.
    long = with_vehicle and np.ptp(scenario.case.places) > 16.0
    suited = {name: method for name, method in known.items() if method.finite or not ends}
    usual = [name for name, method in suited.items() if method.usual and not (long and method.strikes)]
    wanted = usual if names is None else [spelt(name, known) or name for name in names]
    unknown = [name for name in wanted if name not in known]
    if unknown or not wanted:
        what = "a vehicle" if with_vehicle else "prescribed loads"
        hint = nearest(unknown[0], known) if unknown and unknown[0] not in others else ""
        raise ValueError(
            f"methods for a scenario with {what} are {', '.join(known)}; got {', '.join(unknown) or 'none'}{hint}"
        )
    unsuited = [name for name in wanted if name not in suited]
    if unsuited:
        raise ValueError(
            f"{', '.join(unsuited)}: for roads that are endless and the same everywhere, out of which a moving FRF "
            f"or a stretch that travels along is taken; on a finite road {', '.join(suited)} can be compared"
        )
    shown = [other for name in wanted for other in (name, known[name].beside or name) if other in suited]
    return {name: known[name] for name in dict.fromkeys(shown)}


def compiles(guideway: Guideway | FiniteGuideway) -> bool:
    """Tell whether steps on this guideway are compiled: numba is there, the road a chain without layers of mass."""
    if isinstance(guideway, FiniteGuideway):
        return numba_is_there() and guideway.mesh is not None and guideway.column == 2
    return numba_is_there() and isinstance(guideway, Track) and not isinstance(guideway.foundation, OnMass)

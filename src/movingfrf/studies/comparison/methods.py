"""The methods that can be compared, each a function that prepares a case and returns what solves it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import nearest
from movingfrf._basics.progress import Progress, silent
from movingfrf.guideways.beams import EulerBernoulliBeam
from movingfrf.guideways.foundations import OnMass
from movingfrf.guideways.guideway import Guideway
from movingfrf.guideways.track import Track
from movingfrf.response.moving_loads import moving_loads
from movingfrf.response.simulation import simulate
from movingfrf.roughness.profile import Profile
from movingfrf.scenarios.scenario import Scenario
from movingfrf.stepping.coupled import prepared_journey
from movingfrf.stepping.duhamel import duhamel, duhamel_loads
from movingfrf.stepping.exchange import SOLVED, Iteration
from movingfrf.stepping.finite_guideway import FiniteGuideway
from movingfrf.stepping.finite_track import bending_length, finite_track
from movingfrf.stepping.impulse import CANCELLING, struck_track
from movingfrf.stepping.marching import numba_is_there
from movingfrf.stepping.moving_loads import newmark_loads
from movingfrf.vehicles.journey import Journey
from movingfrf.vehicles.vehicle import Vehicle

if TYPE_CHECKING:
    import xarray as xr


Solve = Callable[[], "xr.Dataset"]


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
    # foundation has a tenth of a pavement's damping].
    run_in: float = 1.0


DISCRETISATION = Discretisation()


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
        if self.scenario.loads is not None:
            return np.concatenate([self.scenario.loads.positions, self.scenario.loads.observe])
        assert self.scenario.vehicle is not None
        return self.scenario.vehicle.positions

    @property
    def offsets(self) -> FloatArray:
        """Every distance from a contact or load to a contact or observer [m]."""
        loads = self.scenario.loads
        sources = self.places if loads is None else loads.positions
        receivers = self.places if loads is None else loads.observe
        return np.unique(np.round(receivers[:, None] - sources, 9))

    def forces(self) -> FloatArray:
        """Prescribed forces at this case's steps, shape (time, load) [N]."""
        assert self.scenario.loads is not None
        at = np.arange(self.journey.samples) * self.time_step
        return np.stack([history(at) for history in self.scenario.loads.histories], axis=1)

    def driven(self) -> tuple[tuple[Vehicle, Profile], dict[str, Any]]:
        """Give vehicle and profile, and the journey as keywords, as every coupled method takes them."""
        assert self.scenario.vehicle is not None
        assert self.scenario.road is not None
        journey = self.journey
        how = {name: getattr(journey, name) for name in ("speed", "duration", "start", "time_step", "blend")}
        return (self.scenario.vehicle, self.scenario.road.profile), how

    def loaded(self) -> tuple[tuple[FloatArray, FloatArray], dict[str, Any]]:
        """Give forces and positions, and the rest as keywords, as every method for prescribed loads takes them."""
        assert self.scenario.loads is not None
        loads, journey = self.scenario.loads, self.journey
        how = {"speed": journey.speed, "time_step": journey.time_step, "observe": loads.observe}
        return (self.forces(), loads.positions), how

    def finite(self, *, travels: bool) -> FiniteGuideway:
        """Cut out of the track what the journey needs: all of it, or what travels along."""
        around = self.around * bending_length(self.track)
        first, last = self.places.min() - around, self.places.max() + around
        if not travels:
            journey = self.journey
            before = DISCRETISATION.run_in * journey.speed if self.scenario.loads is None else 0.0
            first += journey.start - before
            last += journey.start + journey.speed * journey.time_step * journey.samples
        # Nodes at multiples of the element, wherever the track ends: its length must not change the mesh.
        return finite_track(
            self.track,
            first=math.floor(first / self.element) * self.element,
            last=math.ceil(last / self.element) * self.element,
            element=self.element,
            absorbing=DISCRETISATION.absorbing * around,
            travels=travels,
        )


def _transformed(case: Case, guideway: Guideway) -> Solve:
    """Solve in the frequency domain, on any guideway."""
    truncation = case.journey.truncation
    if case.scenario.loads is not None:
        given, how = case.loaded()
        return lambda: moving_loads(guideway, *given, truncation=truncation, **how)
    parts, travel = case.driven()
    return lambda: simulate(guideway, *parts, truncation=truncation, **travel)


def _moving_frf(case: Case) -> Solve:
    return _transformed(case, case.scenario.guideway)


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
    if case.scenario.loads is not None:
        given, how = case.loaded()
        return lambda: duhamel_loads(struck, *given, **how)
    parts, travel = case.driven()
    return lambda: duhamel(struck, *parts, **travel)


def stepped(
    case: Case,
    *,
    travels: bool = False,
    superposed: bool = True,
    iteration: Iteration = SOLVED,
    progress: Progress = silent,
) -> Solve:
    """Step vehicle and road; the weight in a run of its own, since the road is the same everywhere."""
    parts, _ = case.driven()
    return prepared_journey(
        case.journey,
        (case.finite(travels=travels), *parts),
        iteration=iteration,
        superposed=superposed,
        run_in=DISCRETISATION.run_in,
        progress=progress,
    )


def _cdfm(case: Case) -> Solve:
    return stepped(case)


def _cdfm_window(case: Case) -> Solve:
    return stepped(case, travels=True)


def _cdfm_weight(case: Case) -> Solve:
    return stepped(case, superposed=False)


def _sim(case: Case) -> Solve:
    return stepped(case, iteration=Iteration(1e-10))


def newmark(case: Case, *, travels: bool = False, progress: Progress = silent) -> Solve:
    """Step the road under prescribed loads."""
    finite = case.finite(travels=travels)
    given, how = case.loaded()
    return lambda: newmark_loads(finite, *given, progress=progress, **how)


def _newmark_window(case: Case) -> Solve:
    return newmark(case, travels=True)


@dataclass(frozen=True, slots=True, kw_only=True)
class Method:
    """One way to solve a case.

    Parameters
    ----------
    prepare : callable
        Prepares a case and returns what solves it.
    words : str
        What the method does, in a few words.
    divides : bool
        Whether it divides the road of the journey into elements, whose length matters.
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
    strikes: bool = False
    usual: bool = False
    beside: str | None = None


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
        prepare=_cdfm, words="coupled method, the whole road", divides=True, usual=True, beside="cdfm-window"
    ),
    "cdfm-window": Method(
        prepare=_cdfm_window, words="coupled method, a stretch of road that travels along", divides=True
    ),
    "cdfm-weight": Method(
        prepare=_cdfm_weight, words="coupled method, the whole road, the weight stepped as well", divides=True
    ),
    "sim": Method(prepare=_sim, words="separate iterative method, the whole road", divides=True, usual=True),
}
FOR_LOADS: dict[str, Method] = {
    **{name: FOR_VEHICLE[name] for name in ("moving-frf", "moving-frf-fe", "moving-frf-fe-plain", "duhamel")},
    "newmark": Method(
        prepare=newmark,
        words="Newmark's method, the whole road",
        divides=True,
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
        If a method is unknown or does not suit the scenario, or the guideway cannot be divided into elements.
    """
    known, others = (FOR_VEHICLE, FOR_LOADS) if scenario.loads is None else (FOR_LOADS, FOR_VEHICLE)
    guideway = scenario.guideway
    if not isinstance(guideway, Track) or not isinstance(guideway.beam, EulerBernoulliBeam):
        kind = type(guideway.beam if isinstance(guideway, Track) else guideway).__name__
        raise ValueError(
            "guideway must be a track with an Euler–Bernoulli beam, since all methods but the first divide it into "
            f"finite elements, got a {kind}"
        )
    vehicle = scenario.vehicle
    if vehicle is not None and np.isinf(vehicle.springs).any():
        raise ValueError(
            "the vehicle has rigid contacts (stiffness = inf), which only the moving FRF knows, so there is "
            "nothing to compare: give each contact a finite stiffness [N/m], as hertzian_stiffness does for a "
            "wheel on a rail"
        )
    # 40 m of road have no room for a vehicle longer than 16 m: what strikes them is then not among the usual ones.
    long = vehicle is not None and np.ptp(vehicle.positions) > 16.0
    usual = [name for name, method in known.items() if method.usual and not (long and method.strikes)]
    wanted = usual if names is None else list(names)
    unknown = [name for name in wanted if name not in known]
    if unknown or not wanted:
        what = "prescribed loads" if scenario.vehicle is None else "a vehicle"
        hint = nearest(unknown[0], known) if unknown and unknown[0] not in others else ""
        raise ValueError(
            f"methods for a scenario with {what} are {', '.join(known)}; got {', '.join(unknown) or 'none'}{hint}"
        )
    shown = [other for name in wanted for other in (name, known[name].beside or name)]
    return {name: known[name] for name in dict.fromkeys(shown)}


def compiles(guideway: Guideway) -> bool:
    """Tell whether steps on this guideway are compiled: numba is there and the foundation has no mass."""
    return numba_is_there() and isinstance(guideway, Track) and not isinstance(guideway.foundation, OnMass)


def elements(scenario: Scenario) -> list[float]:
    """Choose lengths of elements to try: round numbers near shares of the length over which the track bends.

    Parameters
    ----------
    scenario : Scenario
        The case.

    Returns
    -------
    list of float
        Lengths [m], descending.
    """
    assert isinstance(scenario.guideway, Track)
    length = bending_length(scenario.guideway)
    return [_rounded(share * length) for share in DISCRETISATION.elements]


def _rounded(value: float) -> float:
    """Round down to 1, 2 or 5 times a power of ten, or a quarter of that."""
    power = 10.0 ** math.floor(math.log10(value))
    return max(step * power for step in (0.5, 1.0, 1.25, 2.0, 2.5, 5.0) if step * power <= value * (1 + 1e-9))

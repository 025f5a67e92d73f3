"""A vehicle and a finite guideway, stepped in time: as one system (CDFM), or side by side (SIM)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

import movingfrf.results.findings as find
from movingfrf._basics.arrays import FloatArray, require_memory
from movingfrf._basics.checks import SolveError, checking
from movingfrf._basics.progress import Progress, silent
from movingfrf.results.labels import attributes, labelled
from movingfrf.roughness.excitation import Touch, excite
from movingfrf.roughness.profile import Profile, require_profile
from movingfrf.stepping.exchange import SOLVED, Iteration
from movingfrf.stepping.finite_guideway import FiniteGuideway
from movingfrf.stepping.marching import March, State
from movingfrf.stepping.requirements import (
    require_across,
    require_apart,
    require_kind,
    require_on_guideway,
    require_slopes,
    require_stable_scheme,
)
from movingfrf.stepping.schemes import Scheme, scheme_named
from movingfrf.stepping.tie import no_vehicle, stiffness_at_rest, tie_of
from movingfrf.vehicles.journey import Journey
from movingfrf.vehicles.vehicle import Vehicle, require_vehicle

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True, slots=True, kw_only=True)
class SteadyTravel:
    """What tunes the smooth run before the record; in brackets, between what each number is safe."""

    # The run needs no more rounds than this to agree with the loads it brings about.
    rounds: int = 5  # [4 or more: three axles take four where the guideway gives way far]
    # Relative change of the contact forces from one round to the next at which they agree.
    agreed: float = 1e-9  # [1e-11 to 1e-7]
    # Relative change of the steady deflection, from one element to the next, at which the run was too short.
    unsettled: float = 1e-3  # [a convention: from here on a finding says so]
    # A vehicle whose contacts move as a rigid body allows is not held by the guideway: stiffness, relative to the
    # stiffest contact, that is rounding.
    unheld: float = 1e-9  # [1e-12 to 1e-6]


STEADY_TRAVEL = SteadyTravel()


class Steady(NamedTuple):
    """Steady travel on the smooth guideway."""

    load: FloatArray  # (contact,) [N]
    deflection: FloatArray  # (contact,) [m]
    motion: FloatArray  # (dof,) about the vehicle at rest on a rigid guideway
    findings: list[find.Finding]


def cdfm(
    road: FiniteGuideway,
    vehicle: Vehicle,
    profile: Profile,
    *,
    speed: float,
    duration: float,
    start: float = 0.0,
    time_step: float = 1e-3,
    blend: float = 5.0,
    superposed: bool = False,
    run_in: float = 1.0,
    observe: ArrayLike = (),
    scheme: str | Scheme = "average_acceleration",
    compiled: bool | None = None,
    progress: Progress = silent,
) -> xr.Dataset:
    """Drive a vehicle over a finite road, both stepped as one system: the coupled method (CDFM).

    Every contact ties the vehicle to the road by a spring and a dashpot at a place that changes from step to step,
    F = k (z − w + r) + c (ż − ẇ − v ∂w/∂x + ṙ). What does not change is factorised once; the contact forces of a
    step follow from a system as small as their number.

    Parameters
    ----------
    road : FiniteGuideway
        The road, long enough for the journey and the run-in; see `finite_track`.
    vehicle : Vehicle
        The vehicle.
    profile : Profile
        Elevation of the road; must cover the journey of every contact.
    speed : float
        Speed [m/s].
    duration : float
        Duration [s].
    start : float
        Distance of the vehicle's reference point at t = 0 [m].
    time_step : float
        Step in time [s].
    blend : float
        Length over which the profile sets in [m]; 0 leaves it as it is.
    superposed : bool
        Whether the road carries the vehicle's weight in a run of its own, the run-in, and only what the roughness
        adds is stepped afterwards. Right on a road that is the same everywhere, and then more accurate; a bridge
        needs False.
    run_in : float
        Time for which the vehicle's weight travels along the smooth road before the record begins [s], from a road
        at rest under it; 0 begins with that state.
    observe : array_like, shape (place,)
        Points of the road's centre line, standing still, whose deflection is recorded too [m]: mid-span of a
        bridge. Not with `superposed`, whose steady part is known under the contacts only.
    scheme : str or Scheme
        Time-stepping scheme, by name or as the row of its numbers.
    compiled : bool, optional
        Whether to use the compiled loops; None: where they apply and numba is installed.
    progress : callable
        Called with the name of a stage and the fraction of it that is done.

    Returns
    -------
    xarray.Dataset
        With the variables of a result of `simulate`, and `place_deflection` (time, place) [m] if asked for.

    Raises
    ------
    ValueError
        If a value is impossible, the vehicle would leave the road, contacts stand closer than the road's nodes, the
        scheme is unstable, the profile does not cover the journey, or memory does not hold the result.
    SolveError
        If the road's matrices are inconsistent or a result is not finite.

    Warns
    -----
    ValidityWarning
        If contact would be lost, or contacts on several paths meet a profile that is known along one.

    References
    ----------
    W. Zhai, Z. Han, Z. Chen, L. Ling, S. Zhu, Train–track–bridge dynamic interaction, Vehicle Syst. Dyn. 57, 2019.

    Examples
    --------
    >>> import movingfrf as mf
    >>> track = mf.track(mf.EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9),
    ...                  mf.Spring(stiffness=8.0e6, damping=3.0e4))
    >>> car = mf.quarter_car(body_mass=400.0, wheel_mass=40.0, suspension_stiffness=2e4,
    ...                      suspension_damping=1.5e3, tyre_stiffness=2e5)
    >>> hump = mf.bump(height=0.02, width=1.0, at=1.0, length=10.0)
    >>> road = mf.finite_track(track, first=-25.0, last=25.0, element=0.5)
    >>> result = cdfm(road, car, hump, speed=10.0, duration=0.5, blend=0.0, run_in=0.2)
    >>> dict(result.sizes)
    {'time': 500, 'contact': 1, 'dof': 2}
    """
    require_profile(profile)
    return prepared_journey(
        Journey(speed=speed, duration=duration, start=start, time_step=time_step, blend=blend),
        (road, vehicle),
        scheme=scheme,
        superposed=superposed,
        run_in=run_in,
        observe=observe,
        compiled=compiled,
        progress=progress,
    )(profile)


def sim(
    road: FiniteGuideway,
    vehicle: Vehicle,
    profile: Profile,
    *,
    speed: float,
    duration: float,
    start: float = 0.0,
    time_step: float = 1e-3,
    blend: float = 5.0,
    superposed: bool = False,
    run_in: float = 1.0,
    observe: ArrayLike = (),
    scheme: str | Scheme = "average_acceleration",
    tolerance: float = 1e-10,
    iterations: int = 50,
    compiled: bool | None = None,
    progress: Progress = silent,
) -> xr.Dataset:
    """Drive a vehicle over a finite road, each stepped on its own: the separate iterative method (SIM).

    Within each step road and vehicle exchange contact forces until these agree. The road's answer to a contact
    force of the step is known before, so that an exchange costs next to nothing and the road is solved once a step.

    Parameters
    ----------
    road : FiniteGuideway
        The road, long enough for the journey and the run-in; see `finite_track`.
    vehicle : Vehicle
        The vehicle.
    profile : Profile
        Elevation of the road; must cover the journey of every contact.
    speed : float
        Speed [m/s].
    duration : float
        Duration [s].
    start : float
        Distance of the vehicle's reference point at t = 0 [m].
    time_step : float
        Step in time [s].
    blend : float
        Length over which the profile sets in [m]; 0 leaves it as it is.
    superposed : bool
        As for `cdfm`.
    run_in : float
        As for `cdfm` [s].
    observe : array_like, shape (place,)
        As for `cdfm` [m].
    scheme : str or Scheme
        Time-stepping scheme, by name or as the row of its numbers.
    tolerance : float
        Relative change of the contact forces at which they agree, a ratio.
    iterations : int
        Number of exchanges in a step after which the method gives up.
    compiled : bool, optional
        Whether to use the compiled loops; None: where they apply and numba is installed.
    progress : callable
        Called with the name of a stage and the fraction of it that is done.

    Returns
    -------
    xarray.Dataset
        With the variables of a result of `simulate`; the attribute `iterations` is the most that a step took.

    Raises
    ------
    ValueError
        As for `cdfm`, or if the tolerance is not positive.
    SolveError
        If the forces of a step do not come to agree, or as for `cdfm`.

    Warns
    -----
    ValidityWarning
        If contact would be lost, or contacts on several paths meet a profile that is known along one.

    References
    ----------
    C. G. Krishnanunni, B. N. Rao, Decoupled technique for dynamic response of vehicle–pavement systems, Eng.
    Struct. 191, 2019.
    """
    with checking() as check:
        tolerance = check.positive("tolerance", tolerance, "1")
        iterations = check.whole("iterations", iterations, least=1)
    require_profile(profile)
    return prepared_journey(
        Journey(speed=speed, duration=duration, start=start, time_step=time_step, blend=blend),
        (road, vehicle),
        scheme=scheme,
        iteration=Iteration(tolerance, iterations),
        superposed=superposed,
        run_in=run_in,
        observe=observe,
        compiled=compiled,
        progress=progress,
    )(profile)


def prepared_journey(
    journey: Journey,
    parts: tuple[FiniteGuideway, Vehicle],
    *,
    scheme: str | Scheme = "average_acceleration",
    iteration: Iteration = SOLVED,
    superposed: bool = False,
    run_in: float = 1.0,
    observe: ArrayLike = (),
    compiled: bool | None = None,
    progress: Progress = silent,
) -> Callable[[Profile], xr.Dataset]:
    """Check and prepare a journey: all that is the same whatever the profile, done once.

    Matrices and their factorisation, the contacts' rows of the inverse, and the smooth run-in.

    Parameters
    ----------
    journey : Journey
        How the vehicle travels.
    parts : tuple of FiniteGuideway and Vehicle
        Who travels on what.
    scheme, superposed, run_in, observe, compiled, progress
        As for `cdfm`.
    iteration : Iteration
        How contact forces are found in each step.

    Returns
    -------
    callable
        Steps through the journey over a profile, one after another if there are several, and returns the result of
        `cdfm` or `sim`.
    """
    guideway, vehicle = parts
    require_kind("road", guideway, FiniteGuideway, "finite road")
    require_vehicle(vehicle)
    with checking() as check:
        run_in = check.not_negative("run_in", run_in, "s")
        row = scheme_named(check, scheme)
        places = check.array("observe", observe, "m", (None,))
        if places.size and (superposed or guideway.travels):
            check.refuse("observe", "must be empty on a road that travels along and where the weight is superposed")
    with checking() as check:
        if places.size and not guideway.interval[0] <= places.min() <= places.max() <= guideway.interval[1]:
            check.refuse(
                "observe",
                f"must lie on the road, {guideway.interval[0]:.6g} m to {guideway.interval[1]:.6g} m, got "
                f"{places.tolist()} m",
            )
        positions = journey.start * (not guideway.travels) + vehicle.positions
        before, after = -journey.speed * run_in, journey.distance
        # A guideway that travels along follows element by element.
        require_on_guideway(
            check,
            guideway,
            positions,
            (0.0, guideway.spacing) if guideway.travels else (before, after),
            what="the contacts travel (run-in included)" if run_in else "the contacts travel",
        )
        require_across(check, guideway, vehicle.across)
        require_apart(check, guideway, positions)
        if any(contact.damping for contact in vehicle.contacts):
            require_slopes(check, guideway)
        require_stable_scheme(check, guideway, row, journey.time_step, vehicle)
    channels = 5 * len(vehicle.contacts) + 2 * len(vehicle.dof_names)
    require_memory(8.0 * channels * journey.samples, f"{journey.samples} steps of {journey.time_step:g} s")
    march = March(
        guideway=guideway,
        scheme=row,
        time_step=journey.time_step,
        speed=journey.speed,
        contacts=positions,
        contacts_across=vehicle.across,
        observers=places,
        observers_travel=False,
        tie=tie_of(vehicle),
        iteration=iteration,
        compiled=compiled,
    )
    run_in_steps = round(run_in / journey.time_step)
    steady, settled = steady_travel(march, vehicle, run_in_steps, progress)
    loads = np.zeros((1, positions.size)) if superposed else vehicle.static_loads[None]
    march.prepare()

    def step(profile: Profile) -> xr.Dataset:
        seen = seen_in_time(profile, vehicle, journey)
        roughness, rate = seen.roughness, seen.rate
        state = march.at_rest() if superposed else settled.copied()
        march.begun(state, roughness[0], rate[0], loads[0])
        trace = march.run(
            journey.samples - 1, state, roughness=roughness, rate=rate, loads=loads, progress=progress
        )
        force, deflection, motion = trace.force, trace.deflection, trace.motion
        if superposed:
            deflection += steady.deflection
        else:
            force += vehicle.static_loads - steady.load
            motion -= steady.motion
        method, name = (
            ("sim", "separate iterative method (SIM)") if iteration.tolerance else ("cdfm", "coupled method (CDFM)")
        )
        settings = attributes(
            "coupled",
            f"Coupled response of a vehicle and a finite road: {name}",
            method=method,
            **journey.settings,
            **seen.settings,
            run_in=run_in,
            superposed=int(superposed),
            scheme=repr(row),
            **guideway.attributes,
            iterations=trace.iterations,
            findings=[
                *steady.findings,
                *find.contact_lost(force + steady.load, journey.time_step, vehicle.standing),
                *find.one_path(profile.one_path, vehicle.paths, vehicle.across),
                *find.graded(*seen.slopes),
            ],
        )
        values = {
            "contact_force": force,
            "static_load": steady.load,
            "deflection": deflection,
            "static_deflection": steady.deflection,
            "motion": motion,
            "acceleration": trace.acceleration,
            "roughness": roughness,
        }
        if places.size:
            values |= {"place": places, "place_deflection": trace.observed}
        return labelled({**journey.coordinates(vehicle), **values}, settings)

    return step


class Seen(NamedTuple):
    """What the contacts see of the road, step by step."""

    roughness: FloatArray  # (time, contact) [m]
    rate: FloatArray  # (time, contact) [m/s]
    settings: dict[str, float]  # datum [m] and grade
    slopes: tuple[float, float, float]  # grade, mean slope, and that of the first metres


def seen_in_time(profile: Profile, vehicle: Vehicle, journey: Journey) -> Seen:
    """Elevation under each contact and its rate of change.

    Parameters
    ----------
    profile : Profile
        Elevation of the surface.
    vehicle : Vehicle
        The vehicle.
    journey : Journey
        How it travels.

    Returns
    -------
    Seen
        Time first, as steps take it.
    """
    excitation = excite(
        profile, Touch(**vehicle.touching), start=journey.start, distance=journey.distance, blend=journey.blend
    )
    roughness = excitation.elevation(journey.travelled)
    rate = excitation.rate(journey.travelled, journey.speed)
    return Seen(
        np.ascontiguousarray(roughness.T), np.ascontiguousarray(rate.T), excitation.settings, excitation.slopes
    )


def steady_travel(march: March, vehicle: Vehicle, steps: int, progress: Progress) -> tuple[Steady, State]:
    """Let the weights alone travel along the smooth guideway, from rest, and see what they settle to.

    Parameters
    ----------
    march : March
        The guideway, and where contacts start.
    vehicle : Vehicle
        The vehicle; where the sag of the guideway redistributes its weight the run is repeated with what it found.
    steps : int
        Steps of the run; 0: at rest.
    progress : callable
        As everywhere.

    Returns
    -------
    Steady
        Contact forces and deflections, averaged over the passage of one element, and the vehicle's motion on them.
    State
        Guideway and vehicle at the end of the run.
    """
    held = stiffness_at_rest(march.tie)
    held = np.where(np.abs(held) < STEADY_TRAVEL.unheld * np.abs(march.tie.springs).max(), 0.0, held)
    sags = _sags(march, -steps)
    yields = march.guideway.rows(march.places(-steps), 0, march.contacts_across) @ sags
    load = np.linalg.solve(np.eye(len(held)) + held @ yields, vehicle.static_loads)
    deflection = yields @ load
    alone = replace(march, tie=no_vehicle(march.contacts.size), iteration=SOLVED, observers=np.empty(0))
    nothing = np.zeros((steps + 1, march.contacts.size))
    findings: list[find.Finding] = []
    for _ in range(STEADY_TRAVEL.rounds if steps else 1):
        state = alone.at_rest(-steps)
        state.guideway[0] = sags @ load
        state.acting[:] = load
        if not steps:
            break
        trace = alone.run(
            steps,
            state,
            roughness=nothing,
            rate=nothing,
            loads=load[None],
            origin=-steps,
            stage="run-in",
            progress=progress,
        )
        passage = _passage(march, steps)
        deflection = trace.deflection[-passage:].mean(axis=0)
        findings = _settling(trace.deflection, passage, march.time_step)
        missing = vehicle.static_loads - held @ deflection - load
        if np.abs(missing).max() <= STEADY_TRAVEL.agreed * np.abs(load).max():
            break
        # In travel the guideway yields nearly as it does at rest.
        load = load + np.linalg.solve(np.eye(len(held)) + held @ yields, missing)
    else:
        raise SolveError(
            f"the vehicle's weight and the sag of the road under it do not come to agree in steady travel at "
            f"{march.speed:g} m/s"
        )
    tie = march.tie
    motion = np.linalg.solve(vehicle.held_stiffness, tie.contact_map.T @ (tie.springs * deflection))
    state.body = np.zeros((3, motion.size))
    state.body[0] = motion
    return Steady(load, deflection, motion, findings), state


def _sags(march: March, step: int) -> FloatArray:
    """Displacement of the guideway at rest per force at each contact, shape (guideway dof, contact)."""
    from scipy.sparse.linalg import splu

    try:
        factor = splu(march.guideway.stiffness)
    except RuntimeError:
        raise SolveError("the road's stiffness matrix is singular: nothing holds the road up at rest") from None
    return factor.solve(march.guideway.rows(march.places(step), 0, march.contacts_across).toarray().T)


def _passage(march: March, most: int) -> int:
    """Count the steps in which an element passes: between its nodes a mesh gives way a little more or less."""
    steps = march.guideway.spacing / (march.speed * march.time_step)
    return max(1, min(round(steps), most))


def _settling(deflection: FloatArray, passage: int, time_step: float) -> list[find.Finding]:
    """Compare the last two passages of an element."""
    if len(deflection) <= 2 * passage:
        return []
    last, before = deflection[-passage:].mean(axis=0), deflection[-2 * passage : -passage].mean(axis=0)
    # What is left shrinks from passage to passage; from one to the next it changes by about as much as is left.
    change = float(np.abs(last - before).max() / np.abs(last).max())
    if change <= STEADY_TRAVEL.unsettled:
        return []
    return [
        find.Finding(
            "not_settled",
            f"the deflection under the vehicle's weight still changes by {change:.1e} from one element to the next "
            f"after a run-in of {time_step * (len(deflection) - 1):.3g} s; a longer run-in "
            "(run_in) would let it settle: in a scenario a finite road that reaches further back, or a later start",
        )
    ]

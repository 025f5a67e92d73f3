"""A vehicle on a rough road: the call that most users need."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

import movingfrf.results.findings as find
from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.progress import Progress, silent
from movingfrf._basics.remembered import latest, recalled
from movingfrf.guideways.guideway import Guideway, require_guideway, told
from movingfrf.response.accuracy import hidden, past_the_end, truncated, unresolved
from movingfrf.response.batches import unthreaded
from movingfrf.response.influence import looked_at
from movingfrf.response.line import Given, Line, holds, require_record
from movingfrf.response.sampling import SAMPLING, Driving, Excited, at_first, excited
from movingfrf.response.solve import solve
from movingfrf.response.survey import SteadyState, survey
from movingfrf.response.system import CoupledHistories, Response, System
from movingfrf.response.truncation import Truncation
from movingfrf.results.labels import Labels, attributes, turned
from movingfrf.roughness.excitation import Excitation, Touch, excite
from movingfrf.roughness.profile import Profile, require_profile
from movingfrf.vehicles.journey import Journey
from movingfrf.vehicles.vehicle import Vehicle, require_vehicle

if TYPE_CHECKING:
    import xarray as xr


def simulate(
    guideway: Guideway,
    vehicle: Vehicle,
    profile: Profile,
    *,
    speed: float,
    duration: float,
    start: float = 0.0,
    time_step: float = 1e-3,
    truncation: float | None = None,
    blend: float = 5.0,
    solved_step: float | None = None,
    progress: Progress = silent,
) -> xr.Dataset:
    """Drive a vehicle over a rough road and return what both do.

    The vehicle comes from steady travel on a smooth road. From the start of its foremost contact on, the
    profile sets in.

    Parameters
    ----------
    guideway : Guideway
        The road or track.
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
    truncation : float, optional
        Frequency beyond which the road counts as rigid [Hz]; it stiffens over the next 5 %, since a sharp cut
        would ring. None: the lowest one beyond which a rigid road changes no output by more than 1e-6 (relative
        L2), found and recorded.
    blend : float
        Length over which the profile sets in [m]; 0 leaves it as it is. Else the mean slope of the first 100 m,
        if it is more than roughness, is part of the steady state: elevation and motion are about it.
    solved_step : float, optional
        Step in which the response is solved [s], finer or coarser than `time_step`. None: as fine as the content of
        road and system needs, found and recorded; another one tells how much depends on it.
    progress : callable
        Called with the name of a stage and the fraction of it that is done.

    Returns
    -------
    xarray.Dataset
        `contact_force`, `static_load`, `deflection`, `static_deflection`, `motion`, `acceleration` and
        `roughness`; the settings, and findings about the validity of the result, in its attributes.

    Raises
    ------
    ValueError
        If a value is impossible, the profile does not cover the journey, or memory does not hold the result.
    SolveError
        If vehicle and guideway are unstable together, or a result is not finite.

    Warns
    -----
    ValidityWarning
        If contact would be lost, the speed is near or above critical, the response has not decayed, there is
        content beyond the truncation or the Nyquist frequency, or contacts on several paths meet a profile that is
        known along one.

    Examples
    --------
    >>> import movingfrf as mf
    >>> road = mf.track(mf.EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9),
    ...                 mf.Spring(stiffness=8.0e6, damping=3.0e4))
    >>> car = mf.quarter_car(body_mass=400.0, wheel_mass=40.0, suspension_stiffness=2e4,
    ...                      suspension_damping=1.5e3, tyre_stiffness=2e5)
    >>> hump = mf.bump(height=0.02, width=1.0, at=5.0, length=30.0)
    >>> result = mf.simulate(road, car, hump, speed=10.0, duration=2.0, blend=0.0)
    >>> dict(result.sizes)
    {'time': 2000, 'contact': 1, 'dof': 2}
    """
    journey = Journey(
        speed=speed,
        duration=duration,
        start=start,
        time_step=time_step,
        truncation=truncation,
        blend=blend,
        solved_step=solved_step,
    )
    return driven(guideway, vehicle, profile, journey, progress=progress)


@unthreaded
def driven(
    guideway: Guideway, vehicle: Vehicle, profile: Profile, journey: Journey, *, progress: Progress = silent
) -> xr.Dataset:
    """Drive a vehicle over a rough road: `simulate`, for a journey.

    Parameters
    ----------
    guideway : Guideway
        The road or track.
    vehicle : Vehicle
        The vehicle.
    profile : Profile
        Elevation of the road; must cover the journey of every contact.
    journey : Journey
        How the vehicle travels.
    progress : callable
        Called with the name of a stage and the fraction of it that is done.

    Returns
    -------
    xarray.Dataset
        As `simulate` returns it.

    Raises
    ------
    ValueError
        If the profile does not cover the journey, or memory does not hold the result.
    SolveError
        If vehicle and guideway are unstable together, or a result is not finite.
    """
    require_guideway(guideway)
    require_vehicle(vehicle)
    require_profile(profile)
    progress("profile", 0.0)
    excitation = excitation_of(profile, vehicle, journey)
    system = System.of(guideway, vehicle, journey.speed)
    progress("steady state", 0.0)
    driving = _driving(excitation, journey)
    line = line_of(journey, vehicle, fading=excitation.fading / journey.speed)
    line = at_first(system, driving, line, journey.solved_step, SAMPLING.road)
    surveyed = survey(system, soon=looked_at(line, journey.truncation, driving.images))
    driven_by, response, histories, left_out = _solved(system, driving, line, journey, progress)
    cut = truncated(system, driven_by, response, histories)
    elevation = excitation.elevation(journey.travelled)
    steady, wheels = surveyed.steady, range(len(vehicle.contacts))
    above = np.append(
        hidden(driven_by.line, response.force, histories.force.values),
        hidden(driven_by.line, response.motion, histories.acceleration.values, derivative=2),
    )
    finer = driven_by.finer(journey.time_step) if above.any() else 1
    kept = finer == 1 or holds(driven_by.line, above.size, finer)
    not_shown = find.not_shown(
        above,
        [
            *(f"force of {vehicle.standing.listed([n])}" for n in wheels),
            *(f"acceleration of {name}" for name in vehicle.dof_names),
        ],
        journey.time_step,
        kept=kept,
    )
    # What is measured, and whether contact is kept, is taken from the response as it was solved.
    finer = finer if not_shown and kept else 1
    fine = response.histories(driven_by.line, finer) if finer > 1 else histories
    found = [
        *find.contact_lost(
            turned(steady.load[:, None] + fine.force.values[0]), journey.time_step / finer, vehicle.standing
        ),
        *surveyed.findings,
        *find.one_path(profile.one_path, vehicle.paths, vehicle.across),
        *find.not_decayed("vehicle's motion", histories.motion.wrapped, histories.motion.values),
        *find.beyond_truncation(cut.frequency, cut.error),
        *find.unresolved(left_out, driven_by.step, stated=journey.solved_step is not None),
        *find.jumps_at_the_start(_jump(elevation, vehicle)),
        *not_shown,
        *find.profile_ends(_guessed(system, excitation, journey, driven_by, histories), excitation.guessed),
        *find.graded(*excitation.slopes),
    ]
    values = {
        **_records(histories, steady, elevation),
        # What is remembered stays.
        "static_load": steady.load.copy(),
        "static_deflection": steady.deflection.copy(),
    }
    times = {"time": journey.times}
    if finer > 1:
        times["solved_time"] = solved_times = journey.time_step / finer * np.arange(journey.samples * finer)
        seen = excitation.elevation(journey.speed * solved_times)
        values |= {f"solved_{name}": value for name, value in _records(fine, steady, seen).items()}
    settings = attributes(
        "coupled",
        "Coupled response of a vehicle and a guideway",
        method="moving-frf",
        **journey.settings,
        truncation=cut.frequency,
        truncation_error=cut.error,
        solved_step=driven_by.step,
        **excitation.settings,
        critical_speed=surveyed.critical_speed,
        guideway=told(guideway),
        profile=profile.source,
        profile_steps="\n".join(profile.steps),
        findings=found,
    )
    steps = (journey.samples, journey.time_step, len(values), finer)

    labels = latest(vehicle, "labels", lambda known: known.steps == steps, lambda: Labels(steps))
    if labels.ready:
        return labels.on(values, settings)
    return labels.made({**times, **vehicle.coordinates, **values}, settings)


def excitation_of(profile: Profile, vehicle: Vehicle, journey: Journey) -> Excitation:
    """Let a vehicle look at a profile on a journey.

    Parameters
    ----------
    profile : Profile
        Elevation of the road.
    vehicle : Vehicle
        The vehicle.
    journey : Journey
        How it travels.

    Returns
    -------
    Excitation
        To be asked at any distance travelled.
    """
    touch = recalled(vehicle, "touch", lambda: Touch(**vehicle.touching))
    return excite(profile, touch, start=journey.start, distance=journey.distance, blend=journey.blend)


def _solved(
    system: System, driving: Driving, line: Line, journey: Journey, progress: Progress
) -> tuple[Excited, Response, CoupledHistories, float]:
    """Solve, for more where what is left out matters to a channel's largest value; and say how much it does."""
    wanted = SAMPLING.road
    before: Excited | None = None
    for _ in range(SAMPLING.rounds):
        progress("sampling", 0.0)
        # One part, one case.
        driven_by = excited(
            system,
            driving,
            line,
            truncation=journey.truncation,
            solved_step=journey.solved_step,
            wanted=wanted,
            after=before,
        )
        response = solve(
            system, driven_by.omega, driven_by.spectra, truncation=driven_by.truncation, progress=progress
        )
        progress("histories", 0.0)
        histories = response.histories(driven_by.line)
        left_out = unresolved(driven_by, response, histories)
        many = driven_by.line.solved * len(system.vehicle.contacts) > SAMPLING.many
        tolerated = SAMPLING.tolerated * (SAMPLING.less if many else 1.0)
        if driven_by.finest or left_out <= tolerated:
            break
        less = wanted.negligible * max(0.5 * tolerated / left_out, 0.01)
        wanted, before = replace(wanted, negligible=less, smooth=less), driven_by
    return driven_by, response, histories, left_out


def _driving(excitation: Excitation, journey: Journey) -> Driving:
    """Tell of a road in time."""
    speed, short = journey.speed, excitation.short_waves
    if short is not None:
        short = short._replace(energy=short.energy / speed, whole=short.whole / speed)
    return Driving(
        given=lambda line: Given(excitation.elevation(speed * line.instants)),
        step=excitation.station / speed,
        finest=excitation.closest / speed,
        short=short,
    )


def _jump(seen: FloatArray, vehicle: Vehicle) -> float:
    """Largest step at t = 0 that a contact with a dashpot, or a rigid one, meets [m]."""
    hard = (vehicle.dashpots > 0) | np.isinf(vehicle.springs)
    return float(np.abs(seen[:, 0] * hard).max())


def _guessed(
    system: System, excitation: Excitation, journey: Journey, driven_by: Excited, histories: CoupledHistories
) -> float:
    """Estimate what guesses past the end of the profile change, relative to a channel's largest value."""
    if excitation.guessed <= 0:
        return 0.0
    off = excitation.doubt(journey.speed * driven_by.line.instants)
    known = max(int((journey.distance - excitation.guessed) / (journey.speed * journey.time_step)), 1)
    return past_the_end(system, driven_by, Given(off), histories, known)


def _records(histories: CoupledHistories, steady: SteadyState, seen: FloatArray) -> dict[str, FloatArray]:
    """Name the records of a case as in a result."""
    return {
        "contact_force": turned(histories.force.values[0]),
        "deflection": turned(histories.deflection.values[0] + steady.deflection[:, None]),
        "motion": turned(histories.motion.values[0]),
        "acceleration": turned(histories.acceleration.values[0]),
        "roughness": turned(seen),
    }


def line_of(journey: Journey, vehicle: Vehicle, *, fading: float = 0.0) -> Line:
    """Line of frequencies that stands for a journey, with padding for the vehicle's motion to die away.

    Parameters
    ----------
    journey : Journey
        How the vehicle travels.
    vehicle : Vehicle
        The vehicle.
    fading : float
        Time within which the road fades out, at least [s].

    Returns
    -------
    Line
        With the journey's samples.

    Raises
    ------
    ValueError
        If memory would not hold the result.
    """
    asked = (journey.samples, journey.time_step, fading, Truncation.stated(journey.truncation).width)

    def make() -> Line:
        samples, time_step, _, cut = asked
        dying = max(-float(vehicle.poles.real.max()), 0.0) if vehicle.poles.size else 0.0
        return Line(samples=samples, time_step=time_step, dying=dying, fading=fading, cut=cut)

    def fits(known: Line) -> bool:
        return (known.samples, known.time_step, known.fading, known.cut) == asked

    line = latest(vehicle, "line", fits, make)
    require_record(line, len(vehicle.contacts) + len(vehicle.dof_names))
    return line

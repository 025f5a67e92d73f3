"""A vehicle on a rough road: the call that most users need."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

import movingfrf.results.findings as find
from movingfrf._basics.progress import Progress, silent
from movingfrf.guideways.guideway import Guideway, require_guideway, told
from movingfrf.response.accuracy import past_the_end, truncated, unresolved
from movingfrf.response.line import Given, Line, require_record
from movingfrf.response.sampling import SAMPLING, excited
from movingfrf.response.solve import solve
from movingfrf.response.survey import survey
from movingfrf.response.system import System
from movingfrf.results.labels import attributes, labelled, turned
from movingfrf.roughness.excitation import Touch, excite
from movingfrf.roughness.profile import Profile
from movingfrf.vehicles.journey import Journey
from movingfrf.vehicles.vehicle import Vehicle, require_vehicle

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True, slots=True, kw_only=True)
class Settling:
    """What tunes the padding in which the vehicle settles; in brackets, between what each number is safe."""

    # To what the vehicle's slowest vibration should have decayed at the end of the padding.
    decayed: float = 3e-2  # [1e-3 to 3e-2]
    # The padding for it is at most so many times the duration, or so many of its cycles: what has not settled by
    # then comes back weakened by the window.
    durations: float = 2.0  # [1 to 16]
    cycles: float = 20.0  # [10 to 100]


SETTLING = Settling()


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
    progress("profile", 0.0)
    excitation = excite(
        profile,
        Touch(**vehicle.touching),
        start=journey.start,
        distance=journey.distance,
        blend=journey.blend,
    )
    system = System(guideway=guideway, vehicle=vehicle, speed=journey.speed)
    progress("steady state", 0.0)
    surveyed = survey(system)
    line, wanted = line_of(journey, vehicle), SAMPLING.road
    for _ in range(SAMPLING.rounds):
        progress("sampling", 0.0)
        # One case.
        driven_by = excited(
            system,
            lambda line: Given(excitation.elevation(journey.speed * line.instants)),
            line,
            excitation.station / journey.speed,
            truncation=journey.truncation,
            solved_step=journey.solved_step,
            wanted=wanted,
        )
        response = solve(
            system, driven_by.omega, driven_by.spectra, truncation=driven_by.truncation, progress=progress
        )
        progress("histories", 0.0)
        histories = response.histories(driven_by.line)
        left_out = unresolved(driven_by, response, histories)
        if driven_by.finest or left_out <= SAMPLING.tolerated:
            break
        less = wanted.negligible * max(0.5 * SAMPLING.tolerated / left_out, 0.01)
        wanted = replace(wanted, negligible=less, smooth=less)
    force, deflection, motion, acceleration = histories
    cut = truncated(system, driven_by, response, histories)
    guessed = 0.0
    if excitation.guessed > 0:
        off = excitation.doubt(journey.speed * driven_by.line.instants)
        known = max(int((journey.distance - excitation.guessed) / (journey.speed * journey.time_step)), 1)
        guessed = past_the_end(system, driven_by, Given(off), histories, known)
    steady = surveyed.steady
    total = steady.load[:, None] + force.values[0]
    found = [
        *find.contact_lost(turned(total), journey.time_step),
        *surveyed.findings,
        *find.one_path(profile.one_path, vehicle.paths, vehicle.across),
        *find.not_decayed("vehicle's motion", motion.wrapped, motion.values),
        *find.beyond_truncation(cut.frequency, cut.error),
        *find.unresolved(left_out, driven_by.step),
        *find.not_shown(driven_by.not_shown, system.outputs, journey.time_step),
        *find.profile_ends(guessed, excitation.guessed),
        *find.grade_taken(excitation.grade),
    ]
    deflected = deflection.values[0]
    deflected += steady.deflection[:, None]
    values = {
        **journey.coordinates(vehicle),
        "contact_force": turned(force.values[0]),
        "static_load": steady.load,
        "deflection": turned(deflected),
        "static_deflection": steady.deflection,
        "motion": turned(motion.values[0]),
        "acceleration": turned(acceleration.values[0]),
        "roughness": turned(excitation.elevation(journey.travelled)),
    }
    if any(finding.code == "beyond_nyquist" for finding in found):
        # What is measured is taken from the response in the steps in which it was solved.
        finer = int(np.ceil(journey.time_step / driven_by.step))
        fine, times = (
            response.histories(driven_by.line, finer),
            line.time_step / finer * np.arange(line.samples * finer),
        )
        values |= {
            "solved_time": times,
            "solved_contact_force": turned(fine.force.values[0]),
            "solved_deflection": turned(fine.deflection.values[0] + steady.deflection[:, None]),
            "solved_motion": turned(fine.motion.values[0]),
            "solved_acceleration": turned(fine.acceleration.values[0]),
            "solved_roughness": turned(excitation.elevation(journey.speed * times)),
        }
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
    return labelled(values, settings)


def line_of(journey: Journey, vehicle: Vehicle) -> Line:
    """Line of frequencies that stands for a journey, with padding for the vehicle to settle in.

    Parameters
    ----------
    journey : Journey
        How the vehicle travels.
    vehicle : Vehicle
        The vehicle.

    Returns
    -------
    Line
        With the journey's samples.

    Raises
    ------
    ValueError
        If memory would not hold the result.
    """
    settling = 0.0
    for pole in vehicle.poles.tolist():
        longest = max(SETTLING.durations * journey.duration, SETTLING.cycles * 2 * np.pi / abs(pole))
        settled = -np.log(SETTLING.decayed) / -pole.real if pole.real < 0 else np.inf
        settling = max(settling, min(settled, longest))
    channels = len(vehicle.contacts) + len(vehicle.dof_names)
    require_record(journey.duration, settling, journey.time_step, channels)
    return Line(samples=journey.samples, time_step=journey.time_step, settling=settling)

"""A vehicle on a rough road: the call that most users need."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from movingfrf._basics.progress import Progress, silent
from movingfrf._basics.remembered import latest
from movingfrf.guideways.guideway import Guideway, require_guideway, told
from movingfrf.response.batches import unthreaded
from movingfrf.response.ride import ride
from movingfrf.results.labels import Labels, attributes
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
    found = ride(guideway, vehicle, profile, journey, progress=progress)
    excitation, steady, finer = found.excitation, found.steady, found.finer
    values = {
        **found.turned(),
        # What is remembered stays.
        "static_load": steady.load.copy(),
        "static_deflection": steady.deflection.copy(),
    }
    times = {"time": journey.times}
    if finer > 1:
        times["solved_time"] = journey.time_step / finer * np.arange(journey.samples * finer)
        values |= {f"solved_{name}": value for name, value in found.turned(finer).items()}
    settings = attributes(
        "coupled",
        "Coupled response of a vehicle and a guideway",
        method="moving-frf",
        **journey.settings,
        truncation=found.truncation.frequency,
        truncation_error=found.truncation.error,
        solved_step=found.driven_by.step,
        **excitation.settings,
        critical_speed=found.surveyed.critical_speed,
        guideway=told(guideway),
        profile=profile.source,
        profile_steps="\n".join(profile.steps),
        findings=found.findings,
    )
    steps = (journey.samples, journey.time_step, len(values), finer)

    labels = latest(vehicle, "labels", lambda known: known.steps == steps, lambda: Labels(steps))
    if labels.ready:
        return labels.on(values, settings)
    return labels.made({**times, **vehicle.coordinates, **values}, settings)

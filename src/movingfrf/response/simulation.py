"""A vehicle on a rough road: the call that most users need."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

import movingfrf.results.findings as find
from movingfrf._basics.progress import Progress, silent
from movingfrf.guideways.guideway import Guideway, require_guideway, told
from movingfrf.response.line import SpectralGrid, require_record
from movingfrf.response.solve import couple, histories
from movingfrf.response.stability import along_the_axis, require_stable
from movingfrf.response.system import joined, steady_state
from movingfrf.response.truncation import bands, first_negligible, guideway_influence, middles, truncation_error
from movingfrf.results.labels import COUPLED, labelled, provenance
from movingfrf.roughness.excitation import excite
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
    # The padding for it is at most so many times the duration, or so many steps.
    durations: float = 4.0  # [2 to 16]
    steps: int = 2**16  # [2**14 to 2**18]


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
        Length over which the profile sets in [m]; 0 leaves it as it is.
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
        If contact would be lost, the speed is near or above critical, the response has not decayed, or there
        is content beyond the truncation or the Nyquist frequency.

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
    require_guideway(guideway)
    require_vehicle(vehicle)
    journey = Journey(
        speed=speed, duration=duration, start=start, time_step=time_step, truncation=truncation, blend=blend
    )
    grid = spectral_grid(journey, vehicle)
    samples = journey.samples
    progress("profile", 0.0)
    excitation = excite(
        profile,
        vehicle.positions,
        vehicle.paths,
        speed=speed,
        samples=samples,
        time_step=time_step,
        start=start,
        blend=blend,
    )
    spectra = grid.to_spectra(excitation.roughness)
    roughness = _enveloped(vehicle, spectra, speed, grid)

    progress("steady state", 0.0)
    system = joined(guideway, vehicle, speed)
    starts = bands(grid)
    at_rest, along_axis, in_bands = system.samples(
        np.zeros(1, complex), along_the_axis(vehicle, speed), middles(starts, grid)
    )
    steady = steady_state(system, at_rest)
    require_stable(system, along_axis)
    part = guideway_influence(system, starts, in_bands, roughness)
    if truncation is None:
        kept = first_negligible(part, roughness)
        grid = replace(grid, truncation=max(kept - 1, 0) / (grid.padded * time_step))
    error = truncation_error(part, grid.untouched)

    coupled = couple(system, roughness, grid=grid, progress=progress)
    progress("histories", 0.0)
    response = histories(coupled, grid)
    critical_speed = float(guideway.critical_speed)
    seen = excitation.roughness if roughness is spectra else grid.to_histories(roughness).values
    found = [
        *find.contact_lost(response.force.values + steady.load, time_step),
        *find.near_critical(speed, critical_speed),
        *find.not_decayed("vehicle's motion", response.motion.wrapped, response.motion.values),
        *find.beyond_truncation(grid.truncation or 0.0, error),
        *find.beyond_nyquist(roughness, time_step),
    ]
    deflection = response.deflection.values
    deflection += steady.deflection
    values = {
        **journey.coordinates(vehicle),
        "contact_force": response.force.values,
        "static_load": steady.load,
        "deflection": deflection,
        "static_deflection": steady.deflection,
        "motion": response.motion.values,
        "acceleration": response.acceleration.values,
        "roughness": seen,
    }
    attributes = {
        **provenance("Coupled response of a vehicle and a guideway"),
        "speed": float(speed),
        "duration": float(duration),
        "start": float(start),
        "time_step": float(time_step),
        "truncation": float(grid.truncation or 0.0),
        "truncation_error": error,
        "blend": float(blend),
        "datum": excitation.datum,
        "critical_speed": critical_speed,
        "guideway": told(guideway),
        "profile": profile.source,
        "profile_steps": "\n".join(profile.steps),
        "findings": find.announced(found),
    }
    return labelled(values, COUPLED, attributes)


def spectral_grid(journey: Journey, vehicle: Vehicle) -> SpectralGrid:
    """Frequencies that stand for the journey, with padding for the vehicle to settle in.

    Parameters
    ----------
    journey : Journey
        How the vehicle travels.
    vehicle : Vehicle
        The vehicle.

    Returns
    -------
    SpectralGrid
        With the journey's samples and truncation.

    Raises
    ------
    ValueError
        If memory would not hold the result.
    """
    slowest = float((-vehicle.poles.real).min(initial=np.inf))
    longest = max(SETTLING.durations * journey.duration, SETTLING.steps * journey.time_step)
    settling = min(-np.log(SETTLING.decayed) / slowest, longest) if slowest > 0 else longest
    channels = len(vehicle.contacts) + len(vehicle.dof_names)
    require_record(journey.duration, settling, journey.time_step, channels)
    return SpectralGrid(
        samples=journey.samples, time_step=journey.time_step, truncation=journey.truncation, settling=settling
    )


def _enveloped(vehicle: Vehicle, spectra: np.ndarray, speed: float, grid: SpectralGrid) -> np.ndarray:
    """Roughness as contacts see it that do not touch the profile at one point only."""
    seeing = [number for number, contact in enumerate(vehicle.contacts) if contact.envelops]
    if not seeing:
        return spectra
    enveloped = spectra.copy(order="K")
    wavenumber = grid.omega() / speed
    for number in seeing:
        enveloped[:, number] *= vehicle.contacts[number].enveloping(wavenumber)
    return enveloped

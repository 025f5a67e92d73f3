"""Duhamel's integral with the moving impulse response, in the time domain."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

import movingfrf.results.findings as find
from movingfrf._basics.arrays import FloatArray, require_memory
from movingfrf._basics.checks import checking
from movingfrf._basics.compiling import usable
from movingfrf._basics.progress import Progress, silent
from movingfrf.guideways.sampled import SampledGuideway
from movingfrf.results.labels import attributes, labelled
from movingfrf.roughness.profile import Profile, require_profile
from movingfrf.stepping.coupled import seen_in_time
from movingfrf.stepping.half_step import HalfStep
from movingfrf.stepping.marching import STRIDE
from movingfrf.stepping.requirements import require_kind
from movingfrf.stepping.schemes import SCHEMES
from movingfrf.stepping.tie import stiffness_at_rest, tie_of
from movingfrf.vehicles.journey import Journey
from movingfrf.vehicles.vehicle import Vehicle, require_vehicle

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True, slots=True, kw_only=True)
class Convolution:
    """What tunes the integral; in brackets, between what each number is safe."""

    # Two steps whose ratio differs by less than this from a whole number fit each other.
    fitting: float = 1e-6  # [1e-10 to 1e-5]
    # What a moving impulse response has faded to where the integral may end, relative to its largest value.
    faded: float = 1e-9  # [1e-12 to 1e-7]


CONVOLUTION = Convolution()


def duhamel(
    road: SampledGuideway,
    vehicle: Vehicle,
    profile: Profile,
    *,
    speed: float,
    duration: float,
    start: float = 0.0,
    time_step: float = 1e-3,
    blend: float = 5.0,
    compiled: bool | None = None,
    progress: Progress = silent,
) -> xr.Dataset:
    """Drive a vehicle over a road that is known by its moving impulse response.

    The road deflects by Duhamel's integral over all earlier contact forces, the vehicle is stepped by Newmark's
    method, and the contact forces of a step are solved for within it. Contact forces are linear between steps.

    Parameters
    ----------
    road : SampledGuideway
        Moving impulse response between all contacts; see `moving_impulse_response`.
    vehicle : Vehicle
        The vehicle.
    profile : Profile
        Elevation of the road; must cover the journey of every contact.
    speed : float
        Speed [m/s]; the one at which the response was recorded.
    duration : float
        Duration [s].
    start : float
        Distance of the vehicle's reference point at t = 0 [m].
    time_step : float
        Step in time [s], a whole multiple of the response's.
    blend : float
        Length over which the profile sets in [m]; 0 leaves it as it is.
    compiled : bool, optional
        Whether to use the compiled loop; None: where numba is installed.
    progress : callable
        Called with the name of a stage and the fraction of it that is done.

    Returns
    -------
    xarray.Dataset
        With the variables of a result of `simulate`.

    Raises
    ------
    ValueError
        If a value is impossible, speed or distances were not recorded, the steps do not fit, or the profile does
        not cover the journey.

    Warns
    -----
    ValidityWarning
        If contact would be lost, or contacts on several paths meet a profile that is known along one.
    """
    journey = Journey(speed=speed, duration=duration, start=start, time_step=time_step, blend=blend)
    return convolved(road, vehicle, profile, journey, compiled=compiled, progress=progress)


def convolved(
    road: SampledGuideway,
    vehicle: Vehicle,
    profile: Profile,
    journey: Journey,
    *,
    compiled: bool | None = None,
    progress: Progress = silent,
) -> xr.Dataset:
    """Drive a vehicle over a road that is known by its moving impulse response: `duhamel`, for a journey.

    Parameters
    ----------
    road : SampledGuideway
        Moving impulse response between all contacts.
    vehicle : Vehicle
        The vehicle.
    profile : Profile
        Elevation of the road.
    journey : Journey
        How the vehicle travels.
    compiled : bool, optional
        As for `duhamel`.
    progress : callable
        Called with the name of a stage and the fraction of it that is done.

    Returns
    -------
    xarray.Dataset
        As `duhamel` returns it.

    Raises
    ------
    ValueError
        As for `duhamel`.
    """
    time_step = journey.time_step
    require_kind("road", road, SampledGuideway, "record")
    require_vehicle(vehicle)
    require_profile(profile)
    road.require_speed(journey.speed)
    positions = vehicle.positions
    columns = road.columns(**vehicle.offsets)
    whole, _, earlier = weights(road, time_step)
    channels = 5 * positions.size + 2 * len(vehicle.dof_names)
    require_memory(8.0 * channels * journey.samples, f"{journey.samples} steps of {time_step:g} s")
    seen = seen_in_time(profile, vehicle, journey)
    yields = road.moving_frf(speed=journey.speed, omega=[0.0], **vehicle.offsets)[0].real
    tie = tie_of(vehicle)
    held = stiffness_at_rest(tie)
    load = np.linalg.solve(np.eye(positions.size) + held @ yields, vehicle.static_loads)
    steady = yields @ load
    samples = journey.samples
    record = [
        np.zeros((width, samples)) for width in (positions.size, positions.size, len(tie.mass), len(tie.mass))
    ]
    # (receiver, source, time): newest force last, as the forces stand in their record.
    kernel = np.ascontiguousarray(whole.T[columns])
    backwards = np.ascontiguousarray(kernel[:, :, :0:-1])
    advance = _compiled() if (usable("stepping.compiled") if compiled is None else compiled) else _plain
    state = np.zeros((3, len(tie.mass)))
    # The elevation may begin with a jump: forces act from t = 0 on, the first one by half of its hat.
    first = tie.springs * seen.roughness[0] + tie.dashpots * seen.rate[0]
    half = HalfStep.of(tie, SCHEMES["average_acceleration"].over(time_step))
    state[2] = at_once = half.balanced(state, first)
    begun = np.einsum("tij,j->it", earlier[:, columns], first)
    for begin in range(0, samples - 1, STRIDE.steps):
        end = min(begin + STRIDE.steps, samples - 1)
        advance(
            half,
            kernel[:, :, 0].copy(),
            backwards,
            np.ascontiguousarray(begun),
            seen.roughness,
            seen.rate,
            state,
            begin,
            end,
            *record,
        )
        progress("convolving", end / (samples - 1))
    # The force at the start has been convolved apart.
    record[0][:, 0], record[3][:, 0] = first, at_once
    force, deflection, motion, acceleration = (values.T for values in record)
    values = {
        **journey.coordinates(vehicle),
        "contact_force": force,
        "static_load": load,
        "deflection": deflection + steady,
        "static_deflection": steady,
        "motion": motion,
        "acceleration": acceleration,
        "roughness": seen.roughness,
    }
    settings = attributes(
        "coupled",
        "Coupled response of a vehicle and a guideway: Duhamel's integral",
        method="duhamel",
        **journey.settings,
        **seen.settings,
        critical_speed=road.critical_speed,
        findings=[
            *find.contact_lost(force + load, time_step, vehicle.standing),
            *find.one_path(profile.one_path, vehicle.paths, vehicle.across),
            *find.graded(*seen.slopes),
            *road.findings,
        ],
    )
    return labelled(values, settings)


def duhamel_loads(
    road: SampledGuideway,
    force: ArrayLike,
    positions: ArrayLike,
    *,
    speed: float,
    time_step: float = 1e-3,
    observe: ArrayLike | None = None,
) -> xr.Dataset:
    """Deflection under prescribed forces that travel along, by Duhamel's integral, from rest at t = 0.

    Parameters
    ----------
    road : SampledGuideway
        Moving impulse response from all loads to all observers.
    force : array_like, shape (time, load)
        Forces [N], positive down, linear between samples.
    positions : array_like, shape (load,)
        Where the forces act, ahead of the frame that travels with them [m].
    speed : float
        Common speed [m/s]; the one at which the response was recorded.
    time_step : float
        Step in time [s], a whole multiple of the response's.
    observe : array_like, shape (point,), optional
        Observation points in the same frame [m]; the loads' own by default.

    Returns
    -------
    xarray.Dataset
        `deflection` (time, point) [m] and `force` (time, load) [N].

    Raises
    ------
    ValueError
        If a value is impossible, speed or distances were not recorded, or the steps do not fit.

    Examples
    --------
    >>> time = 1e-3 * np.arange(2000)
    >>> ringing = 1e-6 * np.exp(-10 * time)[:, None]
    >>> road = SampledGuideway(response=ringing, time_step=1e-3, offsets=[0.0], speed=10.0)
    >>> result = duhamel_loads(road, np.full((1500, 1), 1e5), [0.0], speed=10.0)
    >>> round(1e3 * result.deflection[-1, 0].item(), 3)  # mm
    10.0
    """
    with checking() as check:
        at = check.array("positions", positions, "m", (None,))
        forces = check.array("force", force, "N", (None, at.size))
        points = at if observe is None else check.array("observe", observe, "m", (None,))
        speed = check.finite("speed", speed, "m/s")
        time_step = check.positive("time_step", time_step, "s")
        if not check.faults and (len(forces) < 2 or not at.size or not points.size):
            check.refuse("force", "must have at least two samples, one load and one observation point")
    require_kind("road", road, SampledGuideway, "record")
    road.require_speed(speed)
    columns = road.columns(points[:, None] - at)
    whole, _, first = weights(road, time_step)
    deflection = np.zeros((len(forces), points.size))
    for point, row in enumerate(columns):
        for load, column in enumerate(row):
            history = forces[:, load].copy()
            # The first force begins at t = 0: of its hat only the half that lies behind that.
            early = min(len(forces), len(first))
            deflection[:early, point] += history[0] * first[:early, column]
            history[0] = 0.0
            deflection[:, point] += np.convolve(history, whole[:, column])[: len(forces)]
    values = {
        "time": time_step * np.arange(len(forces)),
        "load": at,
        "point": points,
        "force": forces,
        "deflection": deflection,
    }
    settings = attributes(
        "loaded",
        "Response of a guideway to prescribed moving loads: Duhamel's integral",
        method="duhamel",
        speed=speed,
        time_step=time_step,
        critical_speed=road.critical_speed,
        findings=road.findings,
    )
    return labelled(values, settings)


def weights(guideway: SampledGuideway, time_step: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Integrals of the impulse response times the hat around each step, and times its two halves.

    Parameters
    ----------
    guideway : SampledGuideway
        The moving impulse response, until it has faded.
    time_step : float
        Step [s], a whole multiple of the response's.

    Returns
    -------
    whole, later, earlier : ndarray, shape (step, offset)
        Deflection per force [m/N]: whole hats, and the halves after and before the step.

    Raises
    ------
    ValueError
        If the step is not a whole multiple of the response's.
    """
    ratio = time_step / guideway.time_step
    count = round(ratio)
    if count < 1 or abs(ratio - count) > CONVOLUTION.fitting:
        raise ValueError(
            f"time_step must be a whole multiple of {guideway.time_step!r} s, the step of the impulse response, "
            f"got {time_step!r} s"
        )
    samples = guideway.samples
    size = np.abs(samples).max(axis=1)
    needed = int(np.flatnonzero(size > CONVOLUTION.faded * size.max())[-1]) + 1 if size.any() else 1
    steps = -(-needed // count) + 1
    padded = np.zeros((steps * count + 1, samples.shape[1]))
    kept = min(len(samples), len(padded))
    padded[1:kept] = samples[1:kept]
    share = np.arange(count + 1) / count
    trapezoid = np.full(count + 1, guideway.time_step)
    trapezoid[[0, -1]] *= 0.5
    pieces = np.lib.stride_tricks.sliding_window_view(padded, count + 1, axis=0)[::count]
    later, earlier = np.zeros((2, steps + 1, samples.shape[1]))
    # Hats have kinks where halves meet: the trapezoidal rule errs there by Δt²/12 times the change of slope, unless
    # it is the samples' own.
    kinks = np.zeros(count + 1)
    if not guideway.stepped:
        kinks[[0, -1]] = np.array([-1.0, 1.0]) * guideway.time_step / (12 * count)
    later[:-1] = pieces @ (trapezoid * (1 - share) + kinks)
    earlier[1:] = pieces @ (trapezoid * share - kinks)
    # How the response begins, under halves that fall from 1 and rise from 0.
    rising = guideway.time_step * guideway.onset.moment(1) / count
    later[0] += guideway.time_step * guideway.onset.moment(0) - rising
    earlier[1] += rising
    return later + earlier, later, earlier


def _plain(
    half: HalfStep,
    now: FloatArray,
    backwards: FloatArray,
    begun: FloatArray,
    roughness: FloatArray,
    rate: FloatArray,
    state: FloatArray,
    begin: int,
    end: int,
    force_out: FloatArray,
    deflection_out: FloatArray,
    motion_out: FloatArray,
    acceleration_out: FloatArray,
) -> None:
    """Convolve and step from `begin` to `end`; forces and deflections are (contact, time)."""
    dt, memory = half.rule.step, backwards.shape[2]
    for step in range(begin + 1, end + 1):
        past = min(step, memory)
        seen = force_out[:, step - past : step]
        known = np.einsum("ijm,jm->i", backwards[:, :, memory - past :], seen)
        if step < begun.shape[1]:
            known += begun[:, step]
        # Velocity of the moving contact by backward differences; of second order once there are two steps behind.
        a, b, c = (1.5, -2.0, 0.5) if step > 1 else (1.0, -1.0, 0.0)
        older = b * deflection_out[:, step - 1] + c * deflection_out[:, max(step - 2, 0)]
        free = half.freed(state, force_out[:, step - 1])
        road, guideway = (roughness[step], rate[step]), (known, (a * known + older) / dt)
        force = np.linalg.solve(*half.met(free, road, guideway, (now, a / dt * now)))
        half.taken(state, free, force)
        force_out[:, step] = force
        deflection_out[:, step] = known + now @ force
        motion_out[:, step], acceleration_out[:, step] = state[0], state[2]


def _compiled() -> Callable[..., None]:
    from movingfrf.stepping.compiled import convolve

    loop: Callable[..., None] = convolve
    return loop

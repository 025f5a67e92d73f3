"""What each contact sees of a profile while it travels."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.smooth import smooth_step, smooth_step_slope
from movingfrf.roughness.profile import SLACK, Profile


class Excitation(NamedTuple):
    """Elevation under each contact over time, and the datum that was subtracted."""

    roughness: FloatArray  # (time, contact) [m]
    datum: float  # [m]
    rate: FloatArray | None = None  # (time, contact) [m/s], where it was asked for


def excite(
    profile: Profile,
    positions: FloatArray,
    paths: Sequence[int],
    *,
    speed: float,
    samples: int,
    time_step: float,
    start: float,
    blend: float,
    rate: bool = False,
) -> Excitation:
    """Sample the profile under each contact, at the contact's own position.

    The elevation at the foremost contact's start is the datum, each path's own. Up to that point the road counts
    as flat and within `blend` metres after it the profile sets in, so that every contact meets the same road.

    Parameters
    ----------
    profile : Profile
        The road.
    positions : ndarray, shape (contact,)
        Contacts ahead of the vehicle's reference point [m].
    paths : sequence of int, length contact
        Path of the profile that each contact follows.
    speed : float
        Speed [m/s].
    samples : int
        Number of samples in time.
    time_step : float
        Step in time [s].
    start : float
        Distance of the reference point at t = 0 [m].
    blend : float
        Length over which the profile sets in [m]; 0 leaves the profile as it is.
    rate : bool
        Whether the rate of change ṙ = v r′ is wanted as well.

    Returns
    -------
    Excitation
        Roughness [m], positive up, the datum of the foremost contact's path [m], and the rate [m/s] if wanted.

    Raises
    ------
    ValueError
        If the profile does not cover the journey or lacks a path.
    """
    foremost = start + positions.max()
    require_cover(profile, start + positions.min(), foremost + speed * time_step * samples, paths)
    elevation = {path: profile.along(path) for path in set(paths)}
    datums = {path: float(along(np.array(foremost))) for path, along in elevation.items()}
    slope = {path: along.derivative() for path, along in elevation.items()} if rate else {}
    roughness = np.empty((len(paths), samples))
    rates = np.empty((len(paths), samples)) if rate else None
    travelled = speed * time_step * np.arange(samples)
    for contact, (position, path) in enumerate(zip(positions, paths, strict=True)):
        distance = travelled + (start + position)
        seen = elevation[path](distance)
        seen -= datums[path]
        blending = int(np.searchsorted(distance, foremost + blend)) if blend else 0
        setting_in = (distance[:blending] - foremost) / blend if blend else distance[:0]
        if rates is not None:
            rising = slope[path](distance)
            rising[:blending] *= smooth_step(setting_in)
            if blend:
                rising[:blending] += seen[:blending] * smooth_step_slope(setting_in) / blend
            rates[contact] = speed * rising
        seen[:blending] *= smooth_step(setting_in)
        roughness[contact] = seen
    datum = datums[paths[int(positions.argmax())]]
    return Excitation(roughness.T, datum, None if rates is None else rates.T)


def require_cover(profile: Profile, first: float, last: float, paths: Sequence[int]) -> None:
    """Refuse a profile that is shorter than the journey, or lacks a path that a contact follows.

    Parameters
    ----------
    profile : Profile
        The road.
    first, last : float
        First and last distance that a contact meets [m].
    paths : sequence of int
        Paths that the contacts follow.

    Raises
    ------
    ValueError
        With both intervals, or with the missing path.
    """
    stations = profile.stations
    slack = SLACK * (1 + abs(last))
    if stations[0] > first + slack or stations[-1] < last - slack:
        raise ValueError(
            f"the profile must cover the journey from {first:.6g} m to {last:.6g} m, "
            f"but it reaches from {stations[0]:.6g} m to {stations[-1]:.6g} m"
        )
    if not profile.same_across and max(paths) >= profile.paths:
        raise ValueError(
            f"a contact follows path {max(paths)}, but the profile has {profile.paths} path(s), counted from 0; a "
            "profile without columns is the same for all paths"
        )

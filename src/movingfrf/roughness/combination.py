"""Profiles made of profiles: added up, set side by side, and rolled over by a wheel."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import checking
from movingfrf._basics.wording import told_apart
from movingfrf.roughness.profile import Profile, require_profile
from movingfrf.roughness.steps.base import changed, like


def superposed(*profiles: Profile) -> Profile:
    """Add profiles up: a bump on a rough road, say, or a flat wheel on a rough rail.

    The sum has the stations of all of them, so that it is the sum of their splines also between stations.

    Parameters
    ----------
    *profiles : Profile
        Profiles to add. One without columns counts for all paths.

    Returns
    -------
    Profile
        Their sum over the interval that they share.

    Raises
    ------
    ValueError
        If there are none, they share no interval, or have different numbers of paths.

    Examples
    --------
    >>> import movingfrf as mf
    >>> both = superposed(mf.harmonic(amplitude=0.001, wavelength=4.0, length=20.0),
    ...                   mf.bump(height=0.02, width=1.0, at=4.5, length=20.0))
    >>> round(float(both.along(0)(5.0)), 6)
    0.021
    """
    for profile in profiles:
        require_profile(profile, "profiles")
    with checking() as check:
        if not profiles:
            check.refuse("profiles", "must be at least one")
        counts = sorted({profile.paths for profile in profiles if not profile.same_across})
        if len(counts) > 1:
            check.refuse("profiles", f"must have the same number of paths, got {' and '.join(map(str, counts))}")
    stations = _shared_stations(profiles)
    across = [profile.across for profile in profiles if profile.across is not None]
    full_width = all(profile.full_width for profile in profiles)
    if not counts:
        elevation = sum(profile.along(0)(stations) for profile in profiles)
    else:
        elevation = np.stack(
            [sum(profile.along(path)(stations) for profile in profiles) for path in range(counts[0])], axis=1
        )
    return Profile(
        stations,
        elevation,
        source=_sources(profiles),
        across=across[0] if across else None,
        full_width=full_width,
    )


def side_by_side(*profiles: Profile) -> Profile:
    """Set profiles side by side, each a path of its own (or several): one for each wheel, say.

    Parameters
    ----------
    *profiles : Profile
        Profiles whose paths become the columns, in this order.

    Returns
    -------
    Profile
        All their paths over the interval that they share.

    Raises
    ------
    ValueError
        If there are none, or they share no interval.

    Examples
    --------
    >>> import movingfrf as mf
    >>> level = Profile([0.0, 4.0, 8.0, 12.0], [0.0, 0.0, 0.0, 0.0])
    >>> side_by_side(mf.wheel_flat(radius=0.46, chord=0.05, length=12.0), level).paths
    2
    """
    for profile in profiles:
        require_profile(profile, "profiles")
    with checking() as check:
        if not profiles:
            check.refuse("profiles", "must be at least one")
    stations = _shared_stations(profiles)
    columns = [profile.along(path)(stations) for profile in profiles for path in range(profile.paths)]
    return Profile(stations, np.stack(columns, axis=1), source=_sources(profiles))


def rolled(profile: Profile, radius: float) -> Profile:
    """Path of the centre of a rigid wheel that rolls over a profile, from its height on a level road.

    A round wheel bridges what is narrower than itself: it rises ahead of a step, and never reaches the bottom of a
    narrow hole. Each point of the path is the highest that any point of the profile under the wheel lifts it to,
    max over |s| < R of z(x + s) + √(R² − s²) − R. The wheel touches at stations and at so many places between them
    that what it misses lowers it by at most step²/(8R).

    Between stations the profile is its cubic spline, but higher than both of them only where it is bent down at
    both: beside an edge a spline makes waves that are none of the road's. A road of ISO 8608's class E or worse
    has such edges too if its shortest wave has fewer than five stations: the wheel may be ten times as much lower.

    Parameters
    ----------
    profile : Profile
        The road or rail, its stations evenly spaced.
    radius : float
        Radius R of the wheel [m].

    Returns
    -------
    Profile
        Elevation of the wheel, on the same stations. Within a radius of either end, it does not know what it
        misses.

    Raises
    ------
    ValueError
        If the radius is not positive or the stations are not evenly spaced.

    Examples
    --------
    >>> step = Profile(np.arange(200) * 0.01, np.where(np.arange(200) < 100, 0.0, 0.01))
    >>> seen = rolled(step, radius=0.5).along(0)  # over a step of 10 mm, 99.5 mm ahead
    >>> seen([0.89, 0.95, 1.0]).round(4).tolist()
    [0.0, 0.0075, 0.01]
    """
    require_profile(profile)
    with checking() as check:
        radius = check.positive("radius", radius, "m")
    step = profile.require_even("rolling a wheel over it")
    highest = np.stack([_rolled(profile, path, step, radius) for path in range(profile.paths)], axis=1)
    return changed(profile, f"rolled over by a wheel of {radius:g} m radius", elevation=like(profile, highest))


def _rolled(profile: Profile, path: int, step: float, radius: float) -> FloatArray:
    """Height of the wheel at every station of a path."""
    elevation, spline = profile.columns[:, path], profile.along(path)
    # How far it is bent down at both ends of an interval, and so may rise between them.
    bent = np.pad(np.maximum(-np.diff(elevation, 2), 0.0), 1, mode="edge")
    least = np.minimum(bent[:-1], bent[1:])
    # Between places h apart the wheel is lower by up to h²/8 times the curvatures of wheel and road. What is too
    # sharp for so many places is an edge, and that is a station [8 to 32].
    sharpest = max(-float(spline(profile.stations, 2).min()), 0.0)
    places = min(int(np.ceil(np.sqrt(1 + radius * sharpest))), 16)
    highest = elevation.copy()
    # Farther out the wheel is higher above its lowest point than anything on the profile.
    relief = min(float(np.ptp(elevation)) + 0.5 * least.max(initial=0.0), radius)
    reach = np.sqrt(relief * (2 * radius - relief))
    for part in np.arange(places) / places:
        between = elevation
        if part:
            crest = np.maximum(elevation[:-1], elevation[1:]) + 0.5 * least
            between = np.minimum(spline(profile.stations[:-1] + part * step), crest)
        for k in range(int(-reach / step) - 1, int(reach / step) + 1):
            away = (k + part) * step
            if abs(away) > reach or not -len(elevation) < k < len(between):
                continue
            lifted = between - (radius - np.sqrt(max(radius**2 - away**2, 0.0)))
            # The place k + part steps ahead of a station.
            at = slice(max(-k, 0), min(len(elevation), len(between) - k))
            np.maximum(highest[at], lifted[at.start + k : at.stop + k], out=highest[at])
    return highest


def _shared_stations(profiles: Sequence[Profile]) -> FloatArray:
    """Stations of all profiles within the interval that they share."""
    first = max(profile.stations[0] for profile in profiles)
    last = min(profile.stations[-1] for profile in profiles)
    if first >= last:
        ends = told_apart(*(profile.stations[end] for profile in profiles for end in (0, -1)))
        reaches = "; ".join(f"{one} m to {other} m" for one, other in zip(ends[::2], ends[1::2], strict=True))
        raise ValueError(f"the profiles must share an interval, but they reach from {reaches}")
    # Stations nearer to each other than this share of the smallest step count as one: at 500 km they are rounded to
    # 1e-10 m, and steps are a millimetre at the least; the sum is off by about this share of its change over a step
    # [1e-7 to 1e-4].
    same = 1e-6 * min(np.diff(profile.stations).min() for profile in profiles)
    stations = np.unique(np.concatenate([profile.stations for profile in profiles]))
    stations = stations[(stations > first + same) & (stations < last - same)]
    apart = np.diff(stations, prepend=-np.inf) > same
    return np.array([first, *stations[apart], last])


def _sources(profiles: Sequence[Profile]) -> str:
    return "; ".join(profile.source for profile in profiles if profile.source)

"""An even step."""

from __future__ import annotations

import numpy as np

from movingfrf._basics.checks import checking
from movingfrf._basics.wording import told_apart
from movingfrf.roughness.profile import SLACK, Profile, require_profile
from movingfrf.roughness.steps.base import FILTER, Step, changed, filtered, like, require_room


def resampled(profile: Profile, step: float) -> Profile:
    """Put the stations at an even step: on the cubic spline, after waves that are too short for it are taken out.

    If the new step is longer than that of the profile (the median one where it is uneven), waves shorter than 2.5
    new steps are filtered out before, without shifting the others: half of a wave of that length is left, and less
    than 3 % of one of two steps, the shortest that the new stations can show.

    Parameters
    ----------
    profile : Profile
        The road.
    step : float
        Even distance between the new stations [m].

    Returns
    -------
    Profile
        With stations from the first on.

    Raises
    ------
    ValueError
        If the step is not positive, leaves fewer than four stations, or needs more memory than is free.

    Examples
    --------
    >>> resampled(Profile([0.0, 0.9, 2.1, 3.0], [0.0, 0.9, 2.1, 3.0]), step=0.5).elevation.round(9).tolist()
    [0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0]
    """
    require_profile(profile)
    with checking() as check:
        step = check.positive("step", step, "m")
    stations = profile.stations
    length = stations[-1] - stations[0]
    count = int((length / step) * (1 + SLACK)) + 1
    with checking() as check:
        if count < 4:
            long, got = told_apart(length, step)
            check.refuse("step", f"must leave at least 4 stations on {long} m, got {got} m")
    require_room(length, step, profile.paths)
    old = profile.even_step() or float(np.median(np.diff(stations)))
    done = f"resampled from {old:.4g} to {step:g} m"
    fine = profile
    if step > old * (1 + 1e-6):
        fine = _without_short_waves(profile, old, FILTER.shortest_wave * step)
        done += f" after taking out waves shorter than {FILTER.shortest_wave * step:g} m"
    new = stations[0] + step * np.arange(count)
    elevation = np.stack([fine.along(path)(new) for path in range(fine.paths)], axis=1)
    return changed(profile, done, distance=new, elevation=like(profile, elevation))


def _without_short_waves(profile: Profile, step: float, wavelength: float) -> Profile:
    """Even stations at the profile's own step, and waves shorter than a length filtered out."""
    stations, columns = profile.stations, profile.columns
    if profile.even_step() is None:
        intervals = max(round((stations[-1] - stations[0]) / step), 4)
        stations = np.linspace(stations[0], stations[-1], intervals + 1)
        columns = np.stack([profile.along(path)(stations) for path in range(profile.paths)], axis=1)
    kept = filtered(columns, step, wavelength=wavelength, kind="lowpass", order=FILTER.sharp)
    return Profile(stations, like(profile, kept))


STEP = Step(resampled, {"step": "step"})

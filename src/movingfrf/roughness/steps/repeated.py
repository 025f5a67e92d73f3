"""A longer road: copies behind each other."""

from __future__ import annotations

import numpy as np

from movingfrf._basics.checks import checking
from movingfrf._basics.smooth import smooth_step
from movingfrf._basics.wording import told_apart
from movingfrf.roughness.profile import Profile, require_profile
from movingfrf.roughness.steps.base import Step, extended, longer


def repeated(profile: Profile, length: float, *, overlap: float = 0.0) -> Profile:
    """Make a longer road of a short one by putting copies of it behind each other.

    Such a road is periodic: its spectrum has lines, and what happens once on the original happens every time.

    Parameters
    ----------
    profile : Profile
        The road, at an even step.
    length : float
        Length to reach by copies behind each other [m].
    overlap : float
        Length over which the end of each copy fades into the beginning of the next [m]. With 0 they stand one step
        apart, and whatever jump lies between end and beginning is passed at every joint.

    Returns
    -------
    Profile
        It says how often the original stands in it, and how high the jumps are.

    Raises
    ------
    ValueError
        If the length is less than the profile's, the overlap more than half of it, or stations are uneven.

    Examples
    --------
    >>> repeated(Profile([0.0, 1.0, 2.0, 3.0], [0.0, 1.0, 2.0, 1.0]), length=6.0).elevation.tolist()
    [0.0, 1.0, 2.0, 1.0, 0.0, 1.0, 2.0]
    """
    require_profile(profile)
    step = profile.require_even("repetition")
    own = profile.stations[-1] - profile.stations[0]
    length, count = longer(length, own, step, profile.paths)
    with checking() as check:
        if (overlap := check.not_negative("overlap", overlap, "m")) > own / 2:
            most, got = told_apart(own / 2, overlap)
            check.refuse("overlap", f"must be at most half of the profile, {most} m, got {got} m")
    elevation = profile.columns
    shared = round(overlap / step)
    period = elevation[: len(elevation) - shared].copy()
    if shared:
        rising = smooth_step((np.arange(shared) + 0.5) / shared)[:, None]
        period[:shared] = rising * elevation[:shared] + (1 - rising) * elevation[len(elevation) - shared :]
    jump = np.abs(period[0] - period[-1]).max()
    done = f"repeated {count / len(period):.4g} times to {length:g} m, " + (
        f"each time faded over {shared * step:g} m" if shared else f"with a jump of up to {jump:.3g} m each time"
    )
    return extended(profile, step, count, np.arange(count) % len(period), period, done)


STEP = Step(repeated, {"repeat_to": "length"})

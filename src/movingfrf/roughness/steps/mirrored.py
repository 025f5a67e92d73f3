"""A longer road: forth and back."""

from __future__ import annotations

import numpy as np

from movingfrf.roughness.profile import Profile, require_profile
from movingfrf.roughness.steps.base import Step, extended, longer


def mirrored(profile: Profile, length: float) -> Profile:
    """Make a longer road of a short one by driving it forth and back, forth and back.

    There is no jump where it turns, but a corner; such a road is periodic over twice the length of the original.

    Parameters
    ----------
    profile : Profile
        The road, at an even step.
    length : float
        Length to reach by driving forth and back [m].

    Returns
    -------
    Profile
        It says how often the original stands in it.

    Raises
    ------
    ValueError
        If the length is less than the profile's, or stations are uneven.

    Examples
    --------
    >>> mirrored(Profile([0.0, 1.0, 2.0, 3.0], [0.0, 1.0, 2.0, 5.0]), length=6.0).elevation.tolist()
    [0.0, 1.0, 2.0, 5.0, 2.0, 1.0, 0.0]
    """
    require_profile(profile)
    step = profile.require_even("mirroring")
    own = profile.stations[-1] - profile.stations[0]
    length, count = longer(length, own, step, profile.paths)
    last = len(profile.stations) - 1
    place = last - np.abs(np.arange(count) % (2 * last) - last)
    done = f"mirrored forth and back {length / own:.4g} times to {length:g} m"
    return extended(profile, step, count, place, profile.columns, done)


STEP = Step(mirrored, {"mirror_to": "length"}, without="repeat_to")

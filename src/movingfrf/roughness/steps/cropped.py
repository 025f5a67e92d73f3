"""A piece of a profile."""

from __future__ import annotations

import numpy as np

from movingfrf._basics.checks import checking
from movingfrf.roughness.profile import Profile, require_profile
from movingfrf.roughness.steps.base import Step, changed


def cropped(profile: Profile, first: float | None = None, last: float | None = None) -> Profile:
    """Take the stations from one distance to another.

    Parameters
    ----------
    profile : Profile
        The road.
    first : float, optional
        Distance from which stations are kept [m]; from the beginning by default.
    last : float, optional
        Distance to which stations are kept [m]; to the end by default.

    Returns
    -------
    Profile
        Its stations keep their distances.

    Raises
    ------
    ValueError
        If fewer than four stations are left.

    Examples
    --------
    >>> cropped(Profile(np.arange(9.0), np.zeros(9)), first=2.5).stations.tolist()
    [3.0, 4.0, 5.0, 6.0, 7.0, 8.0]
    """
    require_profile(profile)
    stations = profile.stations
    with checking() as check:
        low = stations[0] if first is None else check.finite("first", first, "m")
        high = stations[-1] if last is None else check.finite("last", last, "m")
        kept = (stations >= low) & (stations <= high)
        if not check.faults and kept.sum() < 4:
            check.refuse(
                "last" if first is None else "first",
                f"must leave at least 4 stations, but between {low:g} m and {high:g} m there are {kept.sum()}",
            )
    done = f"cropped to {low:g} to {high:g} m"
    return changed(profile, done, distance=stations[kept], elevation=np.asarray(profile.elevation)[kept])


STEP = Step(cropped, {"first": "first", "last": "last"})

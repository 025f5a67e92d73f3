"""A piece of a profile."""

from __future__ import annotations

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import checking
from movingfrf._basics.wording import told_apart
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
        first = first if first is None else check.finite("first", first, "m")
        last = last if last is None else check.finite("last", last, "m")
    kept = slice(*within(stations, first, last))
    done = cropping(stations, first, last)
    return changed(profile, done, distance=stations[kept], elevation=np.asarray(profile.elevation)[kept])


def within(stations: FloatArray, first: float | None, last: float | None) -> tuple[int, int]:
    """Find where stations begin and end that lie between two distances [m].

    Stations may be out of order, or missing: everything from the first one that lies there to the last one counts.

    Parameters
    ----------
    stations : ndarray, shape (distance,)
        Stations [m].
    first, last : float, optional
        The distances [m]; the ends by default.

    Returns
    -------
    tuple of int
        Number of the first station, and of the one behind the last.

    Raises
    ------
    ValueError
        If fewer than four stations are left.
    """
    low, high = -np.inf if first is None else first, np.inf if last is None else last
    there = np.flatnonzero((stations >= low) & (stations <= high))
    begin = int(there[0]) if there.size and first is not None else 0
    end = int(there[-1]) + 1 if there.size and last is not None else len(stations)
    count = end - begin if there.size else 0
    with checking() as check:
        if count < 4:
            one, other = told_apart(*(ends_of(stations, first, last)))
            check.refuse(
                "last" if first is None else "first",
                f"must leave at least 4 stations, but between {one} m and {other} m there are {count}",
            )
    return begin, end


def ends_of(stations: FloatArray, first: float | None, last: float | None) -> tuple[float, float]:
    """Distances between which stations are taken [m]: those that are given, or the ends."""
    begins, ends = stations[[0, -1]].tolist() if stations.size else (np.nan, np.nan)
    return begins if first is None else first, ends if last is None else last


def cropping(stations: FloatArray, first: float | None, last: float | None) -> str:
    """Say which stations were taken."""
    low, high = told_apart(*ends_of(stations, first, last))
    return f"cropped to {low} to {high} m"


STEP = Step(cropped, {"first": "first", "last": "last"})

"""Drift taken out."""

from __future__ import annotations

import numpy as np

from movingfrf._basics.checks import checking
from movingfrf.roughness.profile import Profile, require_profile
from movingfrf.roughness.steps.base import Step, changed, like


def detrended(profile: Profile, degree: int = 1) -> Profile:
    """Take out drift: of each path the polynomial that fits it best.

    Parameters
    ----------
    profile : Profile
        The road.
    degree : int
        Exponent of the highest power of the polynomial that is taken out: 0 the mean, 1 a straight line.

    Returns
    -------
    Profile
        What is left, about zero.

    Raises
    ------
    ValueError
        If the degree does not lie between 0 and 5.

    Examples
    --------
    >>> x = np.arange(5.0)
    >>> detrended(Profile(x, 3.0 + 0.1 * x)).elevation.max().round(12).item()
    0.0
    """
    require_profile(profile)
    most = 5
    with checking() as check:
        if (degree := check.whole("degree", degree)) > most:
            check.refuse("degree", f"must be at most {most}, got {degree}")
    stations = profile.stations
    # Legendre polynomials over −1 to 1: powers of a station of 500 km would lose every digit.
    along = 2 * (stations - stations[0]) / (stations[-1] - stations[0]) - 1
    fitted = np.polynomial.legendre.legval(along, np.polynomial.legendre.legfit(along, profile.columns, degree)).T
    removed = np.ptp(fitted, axis=0).max()
    done = f"took out a polynomial of degree {degree}, which ranged over {removed:.4g} m at the most"
    return changed(profile, done, elevation=like(profile, profile.columns - fitted))


STEP = Step(detrended, {"detrend": "degree"})

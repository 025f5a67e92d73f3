"""What a spectral density says about peaks, and about contact that is lost."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import ndtr

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.wording import Standing
from movingfrf.results.findings import Finding


def peak_factor(crossings: ArrayLike) -> FloatArray:
    """Give the expected largest value of a Gaussian process, over its root mean square.

    Upcrossings of a high level are rare and independent, so that the largest value stays below u with the
    probability exp(−N e^{−u²/2}), N the expected number of upcrossings of zero; the mean of that distribution is
    returned. Its expansion for large N is Davenport's √(2 ln N) + 0.5772/√(2 ln N). Where the vibration comes in
    bursts (an irregularity near 1) crossings are not independent and the factor is somewhat too large.

    Parameters
    ----------
    crossings : array_like
        Expected number of upcrossings of zero, dimensionless.

    Returns
    -------
    ndarray
        Peak factor, like `crossings`.

    Examples
    --------
    >>> peak_factor([100.0, 1e4]).round(2).tolist()
    [3.2, 4.42]
    """
    count = np.asarray(crossings, float)[..., None]
    # Beyond the upper end the chance is below e^{-32}. Of an even, analytic function the trapezoidal rule converges
    # exponentially: 200 points leave 1e-11, 400 [200 to any number] nothing but rounding.
    end, points = np.sqrt(2 * np.log(np.maximum(count, 1.0))) + 8.0, 400
    level, step = end * np.linspace(0.0, 1.0, points), end[..., 0] / (points - 1)
    exceeded: FloatArray = -np.expm1(-count * np.exp(-0.5 * level**2))
    return step * (exceeded.sum(axis=-1) - 0.5 * exceeded[..., 0])


def spectral_rate(above: FloatArray, below: FloatArray) -> FloatArray:
    """√(mₖ₊₂/mₖ) [1/s]; nan for what does not move."""
    return np.sqrt(np.divide(above, below, out=np.full_like(below, np.nan), where=below > 0))


def lift_off(load: FloatArray, rms: FloatArray, crossing: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Share of the time with a tensile total force, and how often it turns so [1/s], by Gauss and Rice."""
    level = np.divide(load, rms, out=np.copysign(np.full_like(load, np.inf), load), where=rms > 0)
    return ndtr(-level), np.nan_to_num(crossing) * np.exp(-0.5 * level**2)


def lifting_off(
    share: FloatArray,
    rate: FloatArray,
    exposure: float,
    contacts: Standing,
    *,
    most_times: float = 1.0,
    most_share: float = 1e-3,
) -> list[Finding]:
    """Contacts that are likely to lift off within the exposure.

    Contact counts as lost, by convention, beyond so many expected lift-offs or beyond such a share of the time.
    """
    often = rate * exposure
    lost = np.flatnonzero((often > most_times) | (share > most_share)).tolist()
    if not lost:
        return []
    up_to = "up to " if len(lost) > 1 else "about "
    return [
        Finding(
            "contact_lost",
            f"{contacts.listed(lost)} would lift off the {contacts.ground} {up_to}{often[lost].max():.2g} times in "
            f"{exposure:g} s, for {100 * share[lost].max():.2g} % of the time; the linear contact pulls there "
            "instead, so extremes of forces and accelerations are not to be relied on",
        )
    ]

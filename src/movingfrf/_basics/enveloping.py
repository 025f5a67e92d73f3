"""What of a wave of the road a contact follows that touches more than one point of it."""

from __future__ import annotations

import numpy as np

from movingfrf._basics.arrays import NumberArray


def enveloping(wavenumber: NumberArray, footprint: float, cams: float) -> NumberArray:
    """Share of a wave of the profile that a contact follows.

    Parameters
    ----------
    wavenumber : ndarray
        Wavenumber κ of the profile [rad/m]; may be complex.
    footprint : float
        Length L over which the contact averages the profile [m].
    cams : float
        Distance s between the two points whose mean height it follows [m].

    Returns
    -------
    ndarray
        sin(κL/2)/(κL/2) · cos(κs/2), like `wavenumber`.

    Examples
    --------
    >>> enveloping(2 * np.pi * np.array([0.0, 1.0, 2.0]), footprint=0.5, cams=0.0).round(3).tolist()
    [1.0, 0.637, 0.0]
    """
    half = 0.5 * footprint * wavenumber
    # The series where the quotient loses its digits.
    small = np.abs(half) < 1e-4
    averaged = np.where(small, 1.0 - half * half / 6.0, np.sin(half) / np.where(small, 1.0, half))
    return averaged * np.cos(0.5 * cams * wavenumber)

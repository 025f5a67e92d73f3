"""Switching on and off without a kink."""

from __future__ import annotations

import numpy as np

from movingfrf._basics.arrays import FloatArray


def smooth_step(x: FloatArray) -> FloatArray:
    """Quintic from 0 at x ≤ 0 to 1 at x ≥ 1, its slope and curvature zero at both ends.

    Examples
    --------
    >>> smooth_step(np.array([-1.0, 0.0, 0.5, 1.0, 2.0])).tolist()
    [0.0, 0.0, 0.5, 1.0, 1.0]
    """
    x = np.clip(x, 0.0, 1.0)
    return x * x * x * (10.0 + x * (6.0 * x - 15.0))


def smooth_step_slope(x: FloatArray) -> FloatArray:
    """Slope of `smooth_step`.

    Examples
    --------
    >>> smooth_step_slope(np.array([-1.0, 0.0, 0.5, 1.0])).tolist()
    [0.0, 0.0, 1.875, 0.0]
    """
    x = np.clip(x, 0.0, 1.0)
    slope: FloatArray = 30.0 * (x * (1.0 - x)) ** 2
    return slope

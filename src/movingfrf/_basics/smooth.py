"""Switching on and off without a kink."""

from __future__ import annotations

from functools import cache
from math import comb

import numpy as np

from movingfrf._basics.arrays import FloatArray, handed
from movingfrf._basics.compiling import loops_for


def smooth_step(x: FloatArray) -> FloatArray:
    """Quintic from 0 at x ≤ 0 to 1 at x ≥ 1, its slope and curvature zero at both ends.

    Examples
    --------
    >>> smooth_step(np.array([-1.0, 0.0, 0.5, 1.0, 2.0])).tolist()
    [0.0, 0.0, 0.5, 1.0, 1.0]
    """
    x = np.clip(x, 0.0, 1.0)
    return x * x * x * (10.0 + x * (6.0 * x - 15.0))


@cache
def coefficients() -> tuple[float, ...]:
    """Of x⁷ times a polynomial in −x, as which `smoothest_step` begins: those of its powers, the highest first."""
    flat = 6
    return tuple(
        comb(flat + power, power) * float(comb(2 * flat + 1, flat - power)) for power in range(flat, -1, -1)
    )


def smoothest_step(x: FloatArray) -> FloatArray:
    """Polynomial from 0 at x ≤ 0 to 1 at x ≥ 1, its first six derivatives zero at both ends.

    A spectrum that is cut off so rings on by 13!/6! · 2/(ΔΩ t)⁷ only, a time t after what was cut, ΔΩ being the
    width of the step.

    Examples
    --------
    >>> smoothest_step(np.array([-1.0, 0.0, 0.5, 1.0, 2.0])).tolist()
    [0.0, 0.0, 0.5, 1.0, 1.0]
    """
    if loops := loops_for("_basics.compiled", x.size // 16):
        flat = handed(x, float).ravel()
        found: FloatArray = loops.smoothest_step(flat, coefficients()).reshape(x.shape)
        return found
    step = (x > 0.5).astype(float)
    # As a rule x ascends over far more than the step.
    within = np.flatnonzero((x > 0.0) & (x < 1.0))
    nearest = 0.5 - np.abs(x[within] - 0.5)
    rising = np.zeros_like(nearest)
    for coefficient in coefficients():
        rising = rising * -nearest + coefficient
    rising *= nearest ** len(coefficients())
    step[within] += np.where(x[within] > 0.5, -rising, rising)
    return step


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


def memory(slopes: FloatArray, curvatures: FloatArray, *, times_its_scale: float = 12.0) -> FloatArray:
    """Length over which slope and curvature of a record fade past its end; inf if it is straight.

    Parameters
    ----------
    slopes, curvatures : ndarray, shape (*record, sample)
        First and second derivative along the record, towards its end.
    times_its_scale : float
        So many times the ratio of typical slope to typical curvature: enough not to add frequencies [12 to 16].

    Returns
    -------
    ndarray, shape (*record)
        In the unit of what the record runs along.
    """
    slope, curvature = (np.square(values).sum(axis=-1) for values in (slopes, curvatures))
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(curvature > 0, times_its_scale * np.sqrt(slope / curvature), np.inf)


def onward(
    beyond: FloatArray, slope: FloatArray | float, curvature: FloatArray | float, length: FloatArray | float
) -> FloatArray:
    """How a record goes on past its end, about its last value: its slope and curvature fade out over a length.

    Parameters
    ----------
    beyond : ndarray, shape (sample,)
        Distance past the end, or time.
    slope, curvature, length : ndarray, shape (*record, 1), or float
        Derivatives at the end, and the length.

    Returns
    -------
    ndarray, shape (*record, sample)
        In value, slope and curvature it goes on where the record ends.

    Examples
    --------
    >>> onward(np.array([0.0, 0.5, 1.0, 2.0]), 1.0, 0.0, 1.0).tolist()
    [0.0, 0.25, 0.0, 0.0]
    """
    gone: FloatArray = beyond * (slope + 0.5 * curvature * beyond) * (1.0 - smooth_step(beyond / length))
    return gone

"""Splines and smooth steps, compiled by numba (the extra `fast`); `spline` and `smooth` have them in NumPy."""

from __future__ import annotations

import numpy as np

from movingfrf._basics.loops import loop
from movingfrf._basics.smooth import coefficients as of_step


@loop
def piecewise(knots, coefficients, at, order):
    """Evaluate a derivative of piecewise polynomials; as `Piecewise.__call__`."""
    powers, pieces = coefficients.shape
    found = np.empty(at.size)
    scale = np.ones(max(powers - order, 1))
    for row in range(powers - order):
        for k in range(order):
            scale[row] *= powers - 1 - row - k
    piece, last = 0, pieces - 1
    begins, share = knots[0], pieces / (knots[pieces] - knots[0])
    for n in range(at.size):
        place = at[n]
        before, piece = piece, int(min(max((place - begins) * share, 0.0), float(last)))
        # Knots are even as a rule; where they are not, what ascends is in the same piece or the next one; or it is
        # sought.
        for guess in range(3):
            if (piece == 0 or place >= knots[piece]) and (piece == last or place < knots[piece + 1]):
                break
            if guess == 0:
                piece = before
            elif guess == 1:
                piece = min(before + 1, last)
            else:
                low, high = 0, last
                while low < high:
                    middle = (low + high + 1) // 2
                    if place >= knots[middle]:
                        low = middle
                    else:
                        high = middle - 1
                piece = low
        beyond = place - knots[piece]
        if powers == 4 and order == 0:
            found[n] = (
                (coefficients[0, piece] * beyond + coefficients[1, piece]) * beyond + coefficients[2, piece]
            ) * beyond + coefficients[3, piece]
        else:
            value = 0.0
            for row in range(powers - order):
                value = value * beyond + scale[row] * coefficients[row, piece]
            found[n] = value
    return found


@loop
def smoothest_step(x, coefficients):
    """Step from 0 to 1; as `smooth.smoothest_step`."""
    step = np.empty(x.size)
    for n in range(x.size):
        near = min(x[n], 1.0 - x[n])
        if near <= 0.0:
            step[n] = 1.0 if x[n] > 0.5 else 0.0
        else:
            rising, power = 0.0, 1.0
            for coefficient in coefficients:
                rising = rising * -near + coefficient
                power *= near
            rising *= power
            step[n] = 1.0 - rising if x[n] > 0.5 else rising
    return step


def ready():
    """Compile what is here, or load it, for arrays as they are handed over."""
    knots, coefficients = np.array([0.0, 1.0]), np.ones((4, 1))
    for known in (knots, coefficients):
        known.setflags(write=False)
    piecewise(knots, coefficients, np.array([0.5]), 0)
    smoothest_step(np.array([0.5]), of_step())

"""Polynomials from knot to knot, compiled by numba (the extra `fast`); `spline` has them in NumPy."""

from __future__ import annotations

import numpy as np

from movingfrf._basics.loops import loop


@loop
def piecewise(knots, coefficients, at, order):
    """Evaluate a derivative of piecewise polynomials; as `Piecewise.__call__`."""
    powers, pieces = coefficients.shape
    found = np.empty(at.size)
    scale = np.ones(max(powers - order, 1))
    for row in range(powers - order):
        for k in range(order):
            scale[row] *= powers - 1 - row - k
    piece = 0
    for n in range(at.size):
        place = at[n]
        if piece + 1 < pieces and place >= knots[piece + 1]:
            piece += 1
        # What ascends is in the same piece or the next one.
        if (piece > 0 and place < knots[piece]) or (piece + 1 < pieces and place >= knots[piece + 1]):
            low, high = 0, pieces - 1
            while low < high:
                middle = (low + high + 1) // 2
                if place >= knots[middle]:
                    low = middle
                else:
                    high = middle - 1
            piece = low
        value, beyond = 0.0, place - knots[piece]
        for row in range(powers - order):
            value = value * beyond + scale[row] * coefficients[row, piece]
        found[n] = value
    return found

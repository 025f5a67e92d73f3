"""The moving FRF of a track to fifty digits, in decimal numbers: for what rounding hides from floating point."""

from __future__ import annotations

from cmath import exp
from decimal import Decimal, localcontext
from math import comb
from typing import NamedTuple

import numpy as np

DIGITS = 60
# Above the rounding of so many digits at a double root, and below anything that a float can tell.
BELOW_THE_AXIS = Decimal("1e-27")


class Precise(NamedTuple):
    """A complex decimal number."""

    re: Decimal
    im: Decimal = Decimal(0)

    def __add__(self, other):
        """Sum."""
        return Precise(self.re + other.re, self.im + other.im)

    def __sub__(self, other):
        """Difference."""
        return Precise(self.re - other.re, self.im - other.im)

    def __mul__(self, other):
        """Product."""
        return Precise(self.re * other.re - self.im * other.im, self.re * other.im + self.im * other.re)

    def __truediv__(self, other):
        """Quotient."""
        size = other.re * other.re + other.im * other.im
        return self * Precise(other.re / size, -other.im / size)

    def __complex__(self):
        """Round to floating point."""
        return complex(float(self.re), float(self.im))


ZERO, ONE = Precise(Decimal(0)), Precise(Decimal(1))


def moving_frf(stiffness, ahead, speed, omega):
    """Sum of residues at ω − i 10⁻²⁷ [m/N], an independent route: no side is ever in doubt.

    The roots are found all at once by Durand's and Kerner's method.
    """
    with localcontext() as context:
        context.prec = DIGITS
        omega = Precise(Decimal(omega), -BELOW_THE_AXIS)
        above, below = (in_moving_frame(table, speed, omega) for table in (stiffness.above, stiffness.below))
        waves = roots(above)
        slope = [Precise(Decimal(power)) * one for power, one in enumerate(above)][1:]
        weights = [complex(Precise(Decimal(0), Decimal(1)) * at(below, wave) / at(slope, wave)) for wave in waves]
        # Large residues on the two sides of a double root never meet in one sum.
        return np.array(
            [
                sum(
                    (weight if place >= 0 else -weight) * exp(1j * complex(wave) * place)
                    for wave, weight in zip(waves, weights, strict=True)
                    if (wave.im > 0) == (place >= 0)
                )
                for place in ahead
            ]
        )


def in_moving_frame(table, speed, omega):
    """Coefficients of ascending powers of κ, with p = i(ω − κv)."""
    constant = Precise(-omega.im, omega.re)
    linear = Precise(Decimal(0), -Decimal(speed))
    found = [ZERO] * (sum(table.shape) - 1)
    for a, b in np.argwhere(table).tolist():
        for j in range(b + 1):
            term = Precise(Decimal(float(table[a, b])) * comb(b, j))
            for factor in [linear] * j + [constant] * (b - j):
                term = term * factor
            found[a + j] = found[a + j] + term
    while found[-1] == ZERO:
        found.pop()
    return found


def at(coefficients, point):
    value = ZERO
    for one in reversed(coefficients):
        value = value * point + one
    return value


def roots(coefficients):
    size = (abs(complex(coefficients[0] / coefficients[-1]))) ** (1 / (len(coefficients) - 1))
    starts = np.roots([complex(one / coefficients[-1]) for one in reversed(coefficients)])
    # Roots that floating point takes for one must not begin as one.
    starts = starts + 1e-9 * size * np.exp(1j * np.arange(starts.size))
    found = [Precise(Decimal(start.real), Decimal(start.imag)) for start in starts]
    for _ in range(400):
        moved = Decimal(0)
        for number, root in enumerate(found):
            product = coefficients[-1]
            for other, place in enumerate(found):
                if other != number:
                    product = product * (root - place)
            step = at(coefficients, root) / product
            found[number] = root - step
            moved = max(moved, abs(step.re) + abs(step.im))
        if moved < Decimal(size) * Decimal("1e-50"):
            return found
    raise AssertionError("the roots were not found")

"""Waves at many evenly spaced frequencies side by side, as processors take them; compiled by numba (`compiled`).

All that is known of them lies in the rows of one array, a frequency a column, real and imaginary parts one below
the other. What is a row here is the number of its real part.
"""

from __future__ import annotations

import math

import numpy as np

from movingfrf._basics.loops import loop


@loop
def _set(lanes, row, other, factor):
    """Set numbers to multiples of others."""
    for k in range(lanes.shape[1]):
        lanes[row, k] = factor * lanes[other, k]
        lanes[row + 1, k] = factor * lanes[other + 1, k]


@loop
def _set_number(lanes, row, number):
    """Set all to one number."""
    real, imaginary = number.real, number.imag
    for k in range(lanes.shape[1]):
        lanes[row, k] = real
        lanes[row + 1, k] = imaginary


@loop
def _times_plus(lanes, row, factor, added):
    """Multiply by numbers, then add others."""
    for k in range(lanes.shape[1]):
        real, imaginary = lanes[row, k], lanes[row + 1, k]
        lanes[row, k] = real * lanes[factor, k] - imaginary * lanes[factor + 1, k] + lanes[added, k]
        lanes[row + 1, k] = real * lanes[factor + 1, k] + imaginary * lanes[factor, k] + lanes[added + 1, k]


@loop
def _times_plus_number(lanes, row, factor, number):
    """Multiply by numbers, then add one."""
    x, y = number.real, number.imag
    for k in range(lanes.shape[1]):
        real, imaginary = lanes[row, k], lanes[row + 1, k]
        lanes[row, k] = real * lanes[factor, k] - imaginary * lanes[factor + 1, k] + x
        lanes[row + 1, k] = real * lanes[factor + 1, k] + imaginary * lanes[factor, k] + y


@loop
def _less_product(lanes, row, one, other):
    """Take products off."""
    for k in range(lanes.shape[1]):
        lanes[row, k] -= lanes[one, k] * lanes[other, k] - lanes[one + 1, k] * lanes[other + 1, k]
        lanes[row + 1, k] -= lanes[one, k] * lanes[other + 1, k] + lanes[one + 1, k] * lanes[other, k]


@loop
def _divide(lanes, row, by):
    """Divide by numbers."""
    for k in range(lanes.shape[1]):
        x, y = lanes[by, k], lanes[by + 1, k]
        share = 1.0 / (x * x + y * y)
        real, imaginary = lanes[row, k], lanes[row + 1, k]
        lanes[row, k] = (real * x + imaginary * y) * share
        lanes[row + 1, k] = (imaginary * x - real * y) * share


@loop
def _pull(lanes, one, other, root, second):
    """Add the inverse distance of two roots to the pull on one, and take it off that on the other."""
    for k in range(lanes.shape[1]):
        x, y = lanes[root, k] - lanes[second, k], lanes[root + 1, k] - lanes[second + 1, k]
        share = 1.0 / (x * x + y * y)
        real, imaginary = x * share, -y * share
        lanes[one, k] += real
        lanes[one + 1, k] += imaginary
        lanes[other, k] -= real
        lanes[other + 1, k] -= imaginary


@loop
def _move(lanes, root, step, pull, near, settled_within):
    """Take steps off a root, and count where it has not settled."""
    moving = 0
    for k in range(lanes.shape[1]):
        real, imaginary = lanes[root, k] - lanes[step, k], lanes[root + 1, k] - lanes[step + 1, k]
        lanes[root, k] = real
        lanes[root + 1, k] = imaginary
        size = real * real + imaginary * imaginary
        moved = lanes[step, k] * lanes[step, k] + lanes[step + 1, k] * lanes[step + 1, k]
        pulled = lanes[pull, k] * lanes[pull, k] + lanes[pull + 1, k] * lanes[pull + 1, k]
        left = moved * (pulled * size + 1.0)
        settled = (moved <= near * size) & (left * left * moved <= settled_within * size * size * size)
        moving += 0 if settled else 1
    return moving


@loop
def _at(lanes, table, s, into):
    """Polynomials in κ of a table in κ and s."""
    powers = table.shape[1]
    for a in range(table.shape[0]):
        _set_number(lanes, into + 2 * a, table[a, powers - 1])
        for b in range(powers - 2, -1, -1):
            _times_plus_number(lanes, into + 2 * a, s, table[a, b])


@loop
def _value(lanes, into, at, coefficients, degree):
    """Values of polynomials at a root."""
    _set(lanes, into, coefficients + 2 * degree, 1.0)
    for a in range(degree - 1, -1, -1):
        _times_plus(lanes, into, at, coefficients + 2 * a)


@loop
def _led_on(lanes, root, past, first):
    """Lead on from the last four values of a root, by a cubic."""
    last = past[first - 1]
    once, twice = last - past[first - 2], last - 2.0 * past[first - 2] + past[first - 3]
    thrice = twice - (past[first - 2] - 2.0 * past[first - 3] + past[first - 4])
    for k in range(lanes.shape[1]):
        ahead = k + 1.0
        second = 0.5 * ahead * (ahead + 1.0)
        third = second * (ahead + 2.0) / 3.0
        lanes[root, k] = last.real + ahead * once.real + second * twice.real + third * thrice.real
        lanes[root + 1, k] = last.imag + ahead * once.imag + second * twice.imag + third * thrice.imag


@loop
def _doubts(lanes, size, s, roots, degree, into):
    """Sum the magnitudes of all terms at the largest root, in one row of four."""
    powers = size.shape[1]
    for k in range(lanes.shape[1]):
        lanes[into, k] = lanes[into + 1, k] = 0.0
    for n in range(degree):
        root = roots + 2 * n
        for k in range(lanes.shape[1]):
            squared = lanes[root, k] * lanes[root, k] + lanes[root + 1, k] * lanes[root + 1, k]
            lanes[into + 1, k] = max(lanes[into + 1, k], squared)
    for k in range(lanes.shape[1]):
        lanes[into + 1, k] = math.sqrt(lanes[into + 1, k])
        lanes[into + 2, k] = math.sqrt(lanes[s, k] * lanes[s, k] + lanes[s + 1, k] * lanes[s + 1, k])
    for a in range(size.shape[0] - 1, -1, -1):
        for k in range(lanes.shape[1]):
            lanes[into + 3, k] = size[a, powers - 1]
        for b in range(powers - 2, -1, -1):
            term = size[a, b]
            for k in range(lanes.shape[1]):
                lanes[into + 3, k] = lanes[into + 3, k] * lanes[into + 2, k] + term
        for k in range(lanes.shape[1]):
            lanes[into, k] = lanes[into, k] * lanes[into + 1, k] + lanes[into + 3, k]


@loop
def _doubtful(lanes, root, slope, doubts, uncertain):
    """Count where rounding might put a root on the real axis."""
    count = 0
    for k in range(lanes.shape[1]):
        doubt, side = uncertain * lanes[doubts, k], lanes[root + 1, k]
        steep = lanes[slope, k] * lanes[slope, k] + lanes[slope + 1, k] * lanes[slope + 1, k]
        count += 0 if side * side * steep > doubt * doubt else 1
    return count


@loop
def room(guideway, width):
    """Make room for so many frequencies."""
    degree, powers = guideway[0].shape[0] - 1, guideway[1].shape[0]
    return np.empty((2 * (5 + 2 * degree + degree + 1 + powers), width))


@loop
def side_by_side(guideway, omega, first, found, lanes):
    """Find waves at the frequencies from one on, for which there is room, and store them; as `compiled.waves`.

    From those at the four frequencies before. Tells whether all have settled and none is in doubt; otherwise what
    is stored is no good.
    """
    above, below, size, _, uncertain, search = guideway
    near, settled_within, quickly = search[0], search[1], search[8]
    kappa, weight, forward = found
    degree, width = above.shape[0] - 1, lanes.shape[1]
    s, value, slope, doubts, roots = 0, 2, 4, 6, 10
    pulls = roots + 2 * degree
    denominator = pulls + 2 * degree
    numerator = denominator + 2 * (degree + 1)
    for k in range(width):
        lanes[s, k] = -omega[first + k].imag
        lanes[s + 1, k] = omega[first + k].real
    _at(lanes, above, s, denominator)
    for n in range(degree):
        _led_on(lanes, roots + 2 * n, kappa[n], first)
    moving, steps = 1, 0
    while moving > 0 and steps < quickly:
        moving, steps = 0, steps + 1
        for row in range(pulls, pulls + 2 * degree):
            for k in range(width):
                lanes[row, k] = 0.0
        for n in range(degree):
            for m in range(n):
                _pull(lanes, pulls + 2 * n, pulls + 2 * m, roots + 2 * n, roots + 2 * m)
        for n in range(degree):
            root = roots + 2 * n
            _set(lanes, slope, denominator + 2 * degree, 1.0)
            _set(lanes, value, denominator + 2 * degree, 1.0)
            _times_plus(lanes, value, root, denominator + 2 * (degree - 1))
            for a in range(degree - 2, -1, -1):
                _times_plus(lanes, slope, root, value)
                _times_plus(lanes, value, root, denominator + 2 * a)
            _less_product(lanes, slope, value, pulls + 2 * n)
            _divide(lanes, value, slope)
            moving += _move(lanes, root, value, pulls + 2 * n, near, settled_within)
    if moving > 0:
        return False
    _at(lanes, below, s, numerator)
    _doubts(lanes, size, s, roots, degree, doubts)
    for a in range(1, degree + 1):
        _set(lanes, denominator + 2 * (a - 1), denominator + 2 * a, float(a))
    doubtful = 0
    for n in range(degree):
        root = roots + 2 * n
        _value(lanes, slope, root, denominator, degree - 1)
        doubtful += _doubtful(lanes, root, slope, doubts, uncertain)
        _value(lanes, value, root, numerator, below.shape[0] - 1)
        _divide(lanes, value, slope)
        for k in range(width):
            kappa[n, first + k] = complex(lanes[root, k], lanes[root + 1, k])
            weight[n, first + k] = complex(-lanes[value + 1, k], lanes[value, k])
            forward[n, first + k] = lanes[root + 1, k] > 0.0
    return doubtful == 0

"""Splines, smooth steps, linear prediction and peaks, compiled by numba (the extra `fast`).

`spline`, `smooth`, `prediction` and `peaks` have them in NumPy.
"""

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
def cubic(x, y, first, last):
    """Give coefficients of the cubic spline through four points or more, slopes at its ends if known; as `cubic`.

    Elimination needs no pivoting: rows are dominated by their diagonal, but for the ends', which come to be so.
    """
    size = x.size
    slope, above = np.empty(size), np.empty(size)
    width, next_width = x[1] - x[0], x[2] - x[1]
    rise, next_rise = (y[1] - y[0]) / width, (y[2] - y[1]) / next_width
    if np.isnan(first):
        both = width + next_width
        above[0] = both / next_width
        slope[0] = ((width + 2.0 * both) * next_width * rise + width * width * next_rise) / (both * next_width)
    else:
        above[0], slope[0] = 0.0, first
    for n in range(1, size - 1):
        width, rise = x[n] - x[n - 1], (y[n] - y[n - 1]) / (x[n] - x[n - 1])
        next_width = x[n + 1] - x[n]
        next_rise = (y[n + 1] - y[n]) / next_width
        inverse = 1.0 / (2.0 * (width + next_width) - next_width * above[n - 1])
        above[n] = width * inverse
        slope[n] = (3.0 * (next_width * rise + width * next_rise) - next_width * slope[n - 1]) * inverse
    if np.isnan(last):
        width, next_width = x[size - 2] - x[size - 3], x[size - 1] - x[size - 2]
        rise, next_rise = (y[size - 2] - y[size - 3]) / width, (y[size - 1] - y[size - 2]) / next_width
        both = width + next_width
        right = ((next_width + 2.0 * both) * width * next_rise + next_width * next_width * rise) / both
        slope[size - 1] = (right - both * slope[size - 2]) / (width - both * above[size - 2])
    else:
        slope[size - 1] = last
    coefficients = np.empty((4, size - 1))
    for n in range(size - 2, -1, -1):
        slope[n] -= above[n] * slope[n + 1]
    for n in range(size - 1):
        inverse = 1.0 / (x[n + 1] - x[n])
        rise = (y[n + 1] - y[n]) * inverse
        bend = (slope[n] + slope[n + 1] - 2.0 * rise) * inverse
        coefficients[0, n], coefficients[1, n] = bend * inverse, (rise - slope[n]) * inverse - bend
        coefficients[2, n], coefficients[3, n] = slope[n], y[n]
    return coefficients


@loop
def reflected(forward, backward, order):
    """Take reflection coefficients out of errors of prediction, in place; as `prediction.predicting`."""
    reflections, size = np.zeros(order), forward.size
    for step in range(order):
        power, product = 0.0, 0.0
        for n in range(size - step):
            power += forward[n] * forward[n] + backward[n] * backward[n]
            product += forward[n] * backward[n]
        if power == 0.0:
            return reflections[:step]
        factor = 2.0 * product / power
        reflections[step] = factor
        # Forward errors move up by one, towards the next backward ones.
        for n in range(size - step):
            ahead, behind = forward[n] - factor * backward[n], backward[n] - factor * forward[n]
            backward[n] = behind
            if n:
                forward[n - 1] = ahead
    return reflections


@loop
def predicted(known, coefficients, samples):
    """Predict the next samples; as `prediction.predicted`."""
    order = coefficients.size
    record = np.empty(order + samples)
    for n in range(order):
        record[n] = known[n]
    for n in range(order, order + samples):
        value = 0.0
        for before in range(order):
            value += coefficients[before] * record[n - 1 - before]
        record[n] = value
    return record[order:]


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


@loop
def _told(before, here, after):
    """Top of a parabola through three samples if the middle one is the largest; else -inf."""
    bend = before - 2.0 * here + after
    if here >= before and here >= after and bend < 0.0:
        return here - 0.125 * (after - before) ** 2 / bend
    return -np.inf


@loop
def _between(row, n, weights, sign, around):
    """Largest value near a sample, as those around it tell."""
    places, reach = weights.shape[0] // 2, weights.shape[1] // 2
    at = 1
    for place in range(2 * places + 1):
        value = 0.0
        for k in range(2 * reach + 1):
            value += weights[place, k] * row[n - reach + k]
        around[place] = sign * value
        if 0 < place < 2 * places and around[place] > around[at]:
            at = place
    return max(around[at], _told(around[at - 1], around[at], around[at + 1]))


@loop
def extremes(rows, sampled, steps, weights, near):
    """Smallest and largest value of each record, between its samples too; as `peaks.extremes`.

    `sampled` are those of its samples, and become the others.
    """
    count, size = rows.shape
    reach, around = weights.shape[1] // 2, np.empty(weights.shape[0])
    places, tops = np.empty((2, size), np.int64), np.empty((2, size))
    for number in range(count):
        row = rows[number]
        # The top of a parabola lies no higher above its sample than an eighth of the largest step.
        aside = (near + 0.125) * steps[number]
        low, high = sampled[number, 0] + aside, sampled[number, 1] - aside
        told, top = np.zeros(2, np.int64), np.full(2, -np.inf)
        for n in range(1, size - 1):
            here = row[n]
            if low < here < high:
                continue
            side = 1 if here >= high else 0
            sign = 2.0 * side - 1.0
            value = _told(sign * row[n - 1], sign * here, sign * row[n + 1])
            if value > -np.inf:
                places[side, told[side]], tops[side, told[side]] = n, value
                top[side] = max(top[side], value)
                told[side] += 1
        for side in range(2):
            sign, limit = 2.0 * side - 1.0, top[side] - near * steps[number]
            largest = sign * sampled[number, side]
            for k in range(told[side]):
                if tops[side, k] >= limit:
                    inside = reach <= places[side, k] < size - reach
                    value = _between(row, places[side, k], weights, sign, around) if inside else tops[side, k]
                    largest = max(largest, value)
            sampled[number, side] = sign * largest
    return sampled


def ready():
    """Compile what is here, or load it, for arrays as they are handed over."""
    knots, coefficients = np.array([0.0, 1.0]), np.ones((4, 1))
    for known in (knots, coefficients):
        known.setflags(write=False)
    piecewise(knots, coefficients, np.array([0.5]), 0)
    cubic(np.arange(4.0), np.arange(4.0), np.nan, np.nan)
    predicted(np.ones(1), reflected(np.arange(3.0), np.arange(3.0), 1), 1)
    smoothest_step(np.array([0.5]), of_step())
    extremes(np.ones((1, 3)), np.ones((1, 2)), np.ones(1), np.ones((3, 3)), 0.25)

"""Waves frequency by frequency, compiled by numba (the extra `fast`); `waves` and `roots` have them in NumPy."""

from __future__ import annotations

import math

import numpy as np

from movingfrf._basics.loops import loop
from movingfrf.guideways.lanes import room, side_by_side
from movingfrf.guideways.roots import ROOTS


@loop
def squared(value):
    """Squared magnitude."""
    return value.real * value.real + value.imag * value.imag


@loop
def over(above, below):
    """Quotient: complex division, but for what it does beyond 1e±150, takes most of the time otherwise."""
    share = 1.0 / squared(below)
    return complex(
        (above.real * below.real + above.imag * below.imag) * share,
        (above.imag * below.real - above.real * below.imag) * share,
    )


@loop
def _at(expanded, s, coefficients):
    """Polynomial in κ of a table in κ and s."""
    powers = expanded.shape[1]
    for a in range(expanded.shape[0]):
        value = expanded[a, powers - 1]
        for b in range(powers - 2, -1, -1):
            value = value * s + expanded[a, b]
        coefficients[a] = value


@loop
def _value(coefficients, at):
    value = coefficients[coefficients.size - 1]
    for a in range(coefficients.size - 2, -1, -1):
        value = value * at + coefficients[a]
    return value


@loop
def _both(coefficients, at):
    """Value and slope, of degree one at least."""
    slope = coefficients[coefficients.size - 1]
    value = slope * at + coefficients[coefficients.size - 2]
    for a in range(coefficients.size - 3, -1, -1):
        slope = slope * at + value
        value = value * at + coefficients[a]
    return value, slope


@loop
def _on_circles(coefficients, roots):
    """Place roots on circles whose radii the Newton polygon of the magnitudes gives.

    D. A. Bini, Numerical computation of polynomial zeros by means of Aberth's method, Numerical Algorithms 13,
    1996.
    """
    degree = roots.size
    size = np.empty(degree + 1)
    for a in range(degree + 1):
        magnitude = squared(coefficients[a])
        size[a] = 0.5 * math.log(magnitude) if magnitude > 0.0 else -np.inf
    first = 0
    while first < degree:
        steepest, last = -np.inf, first + 1
        for a in range(first + 1, degree + 1):
            rise = (size[a] - size[first]) / (a - first)
            # A root at zero has no finite logarithm.
            if size[first] > -np.inf and rise >= steepest:
                steepest, last = rise, a
        radius = math.exp(-steepest) if size[first] > -np.inf else 0.0
        for root in range(first, last):
            # Off every symmetry.
            turn = 2 * math.pi * ((root - first) / (last - first) + first / degree) + 0.7
            roots[root] = complex(radius * math.cos(turn), radius * math.sin(turn))
        first = last


@loop
def _settle(coefficients, roots, others, search):
    """Move all roots until they stay where they are, and tell whether they do; `others` is scratch."""
    near, settled_within, most, patience, askew = search[:5]
    degree = roots.size
    for number in range(1, most + 1):
        others[:] = 0.0
        for n in range(degree):
            for m in range(n):
                apart = roots[n] - roots[m]
                share = 1.0 / squared(apart)
                # From one place no two part by themselves.
                if share < np.inf:
                    pull = complex(apart.real * share, -apart.imag * share)
                    others[n] += pull
                    others[m] -= pull
        settled = True
        for n in range(degree):
            value, slope = _both(coefficients, roots[n])
            step = over(value, slope - value * others[n])
            # At a multiple root the slope vanishes and so does the need to move.
            if not squared(step) < np.inf:
                step = 0j
            roots[n] -= step
            size, moved = squared(roots[n]), squared(step)
            left = moved * (squared(others[n]) * size + 1.0)
            if not (moved <= near * size and left * left * moved <= settled_within * size * size * size):
                settled = False
        if settled:
            return True
        if number % patience == 0 and number < most:
            for n in range(degree):
                roots[n] *= 1.0 + askew * n
    return False


@loop
def _even(omega, first, most, share):
    """Count frequencies from one on, up to so many, that lie as evenly as the four before."""
    if first < 4:
        return 0
    gap, count = omega[first - 1].real - omega[first - 2].real, 0
    for at in range(first - 3, min(first + most, omega.size)):
        if not abs(omega[at].real - omega[at - 1].real - gap) <= share * gap:
            break
        count = at - first + 1
    return max(count, 0)


@loop
def waves(guideway, omega):
    """Find waves, and at which frequencies two of them meet from both sides; as `waves._waves`."""
    above, below, size, by_omega, uncertain, search = guideway
    uneven, even, abreast, few_abreast = search[5], search[6], search[7], search[9]
    degree, count = above.shape[0] - 1, omega.size
    kappa, weight = np.empty((degree, count), np.complex128), np.empty((degree, count), np.complex128)
    forward, infinite = np.empty((degree, count), np.bool_), np.zeros(count, np.bool_)
    denominator, numerator = np.empty(degree + 1, np.complex128), np.empty(below.shape[0], np.complex128)
    derivative, others = np.empty(degree, np.complex128), np.empty(degree, np.complex128)
    magnitude, change = np.empty(size.shape[0]), np.empty(by_omega.shape[0], np.complex128)
    roots, lanes, singly, at = np.empty(degree, np.complex128), np.empty((0, 0)), 0, 0
    while at < count:
        if at >= singly:
            together = _even(omega, at, abreast, even)
            if together >= few_abreast:
                width = abreast if together >= abreast else few_abreast
                if lanes.shape[1] != width:
                    lanes = room(guideway, width)
                if side_by_side(guideway, omega, at, (kappa, weight, forward), lanes):
                    at += width
                    continue
                singly = at + width
            else:
                singly = at + max(together, 1)
        s = complex(-omega[at].imag, omega[at].real)
        _at(above, s, denominator)
        _at(below, s, numerator)
        _at(size, math.sqrt(squared(s)), magnitude)
        if at == 0:
            _on_circles(denominator, roots)
        else:
            # Roots go on as they have over the last three frequencies, or two, unless these lie too unevenly.
            ahead, last, far = omega[at].real - omega[at - 1].real, 0.0, 0.0
            if at > 1:
                last = omega[at - 1].real - omega[at - 2].real
            if at > 2:
                far = omega[at - 2].real - omega[at - 3].real
            linear, bending = 0.0, 0.0
            if 0.0 < ahead < uneven * last:
                linear = ahead / last
                if 0.0 < last < uneven * far:
                    share = ahead * (ahead + last) / (last + far)
                    linear += share / last
                    bending = share / far
            for n in range(degree):
                roots[n] = kappa[n, at - 1]
                if linear > 0.0:
                    roots[n] += linear * (kappa[n, at - 1] - kappa[n, at - 2])
                if bending > 0.0:
                    roots[n] -= bending * (kappa[n, at - 2] - kappa[n, at - 3])
        settled = _settle(denominator, roots, others, search)
        for a in range(degree):
            derivative[a] = (a + 1) * denominator[a + 1]
        # The largest root has the largest doubt, which is too little for any of them as a rule.
        largest = 0.0
        for n in range(degree):
            largest = max(largest, squared(roots[n]))
        most = uncertain * _value(magnitude, math.sqrt(largest))
        for n in range(degree):
            root = roots[n]
            slope = _value(derivative, root)
            kappa[n, at] = root
            weight[n, at] = 1j * over(_value(numerator, root), slope)
            side = root.imag
            forward[n, at] = side > 0.0
            if settled and side * side * squared(slope) > most * most:
                continue
            doubt = uncertain * _value(magnitude, math.sqrt(squared(root)))
            # What still moves is a multiple root, or none.
            if not settled and squared(_value(denominator, root)) > doubt * doubt:
                infinite[at] = True
            if side * side * squared(slope) <= doubt * doubt:
                bend = 0j
                for a in range(degree - 1, 0, -1):
                    bend = bend * root + a * derivative[a]
                if squared(slope) <= 2.0 * doubt * math.sqrt(squared(bend)):
                    infinite[at] = True
                _at(by_omega, s, change)
                side = over(_value(change, root), slope).real
            forward[n, at] = side > 0.0
        at += 1
    return (kappa, weight, forward), infinite


@loop
def summed(kappa, weight, forward, ahead):
    """Sum the waves that are met at each offset; as `Waves.summed`."""
    frf = np.empty((ahead.size, kappa.shape[1]), np.complex128)
    for row in range(ahead.size):
        offset = ahead[row]
        for at in range(kappa.shape[1]):
            total = 0j
            for n in range(kappa.shape[0]):
                if forward[n, at] == (offset >= 0.0):
                    if offset == 0.0:
                        total += weight[n, at]
                    else:
                        left = math.exp(-kappa[n, at].imag * offset)
                        turn = kappa[n, at].real * offset
                        total += weight[n, at] * complex(left * math.cos(turn), left * math.sin(turn))
            frf[row, at] = total if offset >= 0.0 else -total
    return frf


def ready():
    """Compile what is here, or load it, for arrays as they are handed over."""
    above, below, by_omega = np.array([[1, 1], [0, 0], [1, 0j]]), np.array([[1 + 0j]]), np.array([[0j]])
    size = above.real.copy()
    for table in (above, below, size, by_omega):
        table.setflags(write=False)
    found, _ = waves((above, below, size, by_omega, 1e-12, ROOTS.numbers), np.array([1 - 0.1j]))
    summed(*found, np.array([0.0, 1.0]))

r"""Free waves of a one-dimensional guideway, seen by an observer who travels along it.

A guideway is a table. Its dynamic stiffness (force per deflection, per metre) for the wave
:math:`e^{i(Ωt + κx)}` is a ratio of two polynomials in κ and p = iΩ with *real* coefficients,
``table[a, b]`` standing for :math:`κ^a p^b`: a mass is :math:`m p^2`, a dashpot :math:`c p`. An observer at
speed v sees the frequency ω = Ω + κv, hence p = i(ω − κv), and at each ω a polynomial in κ alone. Its roots
are the waves; the moving FRF is the sum of their residues.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import comb
from typing import Any, NamedTuple

import numpy as np

from movingfrf._basics.arrays import BoolArray, ComplexArray, FloatArray, IntArray, NumberArray
from movingfrf._basics.checks import SolveError


@dataclass(frozen=True, slots=True, kw_only=True)
class RootSearch:
    """What tunes the search for the waves, and for the side of the real axis on which each of them counts.

    In brackets, between what each number is safe.
    """

    # Below this speed the moving frame differs from the fixed one by rounding errors, while the roots that run away
    # to infinity as v → 0 (one per κⁿ that v alone keeps alive) begin to cost digits.
    at_rest: float = 1e-13  # [m/s; 1e-15 to 1e-12]
    # What so many rounding errors of the dynamic stiffness could bring about counts as there: a root that they
    # could put on the real axis is real and belongs where damping would push it; between two that they could make
    # one the contour is pinched, and the response infinite. What is let through is right to about the inverse.
    rounding_errors: float = 1e4  # [1e3 to 1e6]
    # Newton steps on a root: the last one moves it by less than this share, and squares the error.
    most_steps: int = 4  # [2 to 20]
    converged: float = 1e-9  # [1e-16 to 1e-8]
    # Steps of all roots together, where some nearly meet.
    most_steps_together: int = 40  # [20 to 200]
    askew: complex = 6e-7 + 8e-7j  # how far they are moved first, off every symmetry [1e-8 to 1e-5 in magnitude]
    # Roots of two kinds that differ by this factor are computed apart, to within about its inverse.
    far: float = 1e4  # [1e2 to 1e6]


ROOTS = RootSearch()


def polynomial(terms: dict[tuple[int, int], float]) -> FloatArray:
    """Coefficient table from {(power of κ, power of p): coefficient}.

    Examples
    --------
    >>> polynomial({(4, 0): 3.0, (0, 0): 2.0}).ravel()
    array([2., 0., 0., 0., 3.])
    """
    table = np.zeros(np.max(list(terms), axis=0) + 1)
    for powers, coefficient in terms.items():
        table[powers] += coefficient
    return table


def table_product(first: FloatArray, second: FloatArray) -> FloatArray:
    """Table of the product of two polynomials."""
    if second.size == 1:
        return first * second.item()
    table = np.zeros(np.array(first.shape) + second.shape - 1)
    for a, b in np.argwhere(first):
        table[a : a + second.shape[0], b : b + second.shape[1]] += first[a, b] * second
    return table


def table_sum(first: FloatArray, second: FloatArray) -> FloatArray:
    """Table of the sum of two polynomials."""
    table = np.zeros(np.maximum(first.shape, second.shape))
    for part in (first, second):
        table[: part.shape[0], : part.shape[1]] += part
    return table


@dataclass(frozen=True, slots=True, eq=False)
class Ratio:
    """A dynamic stiffness as numerator over denominator, two coefficient tables in (κ, p).

    Parameters
    ----------
    above, below : ndarray, shape (power of κ, power of p)
        Real coefficients; numerator over denominator is a force per metre and deflection [N/m²].
    """

    above: FloatArray
    below: FloatArray

    def __add__(self, other: Ratio) -> Ratio:
        """Side by side: the same deflection, forces add."""
        above = table_sum(table_product(self.above, other.below), table_product(other.above, self.below))
        return Ratio(above, table_product(self.below, other.below))

    def in_series(self, other: Ratio) -> Ratio:
        """One on top of the other: the same force, deflections add; ab/(a + b)."""
        below = table_sum(table_product(self.above, other.below), table_product(other.above, self.below))
        return Ratio(table_product(self.above, other.above), below)


def in_moving_frame(table: NumberArray, speed: float, omega: ComplexArray) -> ComplexArray:
    """Put p = i(ω − κv) into a table: one polynomial in κ for each frequency.

    Parameters
    ----------
    table : ndarray, shape (power of κ, power of p)
        Coefficients.
    speed : float
        Speed of the observer [m/s].
    omega : ndarray, shape (frequency,)
        Frequency in the moving frame [rad/s].

    Returns
    -------
    ndarray, shape (power of κ, frequency)
        Coefficients, ascending, without leading powers that vanish. Here, and in all that follows, frequency is
        the last axis: it is long, the others are short.
    """
    polynomials: ComplexArray = _expanded(table, 1j * omega, -1j * speed if abs(speed) > ROOTS.at_rest else 0.0)
    return polynomials


def _expanded(table: NumberArray, constant: NumberArray, linear: complex) -> Any:
    """Put p = constant + linear κ into a table, shape (power of κ, frequency)."""
    powers_kappa, powers_p = table.shape
    powers = [np.ones_like(constant), constant]
    for _ in range(powers_p - 2):
        powers.append(powers[-1] * constant)
    expanded = np.zeros((powers_kappa + (powers_p - 1 if linear else 0), constant.size), constant.dtype)
    for a, b in np.argwhere(table).tolist():
        for j in range(b + 1 if linear else 1):
            expanded[a + j] += (table[a, b] * comb(b, j) * linear**j) * powers[b - j]
    degree = max((n for n, row in enumerate(expanded) if row.any()), default=0)
    return expanded[: degree + 1]


def evaluated(coefficients: NumberArray, at: NumberArray) -> Any:
    """Values of the polynomials (power, frequency) at the points (point, frequency), by Horner's rule."""
    value = np.zeros_like(at) + coefficients[-1]
    for row in coefficients[-2::-1]:
        value *= at
        value += row
    return value


def slopes(coefficients: ComplexArray) -> ComplexArray:
    """Coefficients of the derivatives of the polynomials (power, frequency)."""
    return coefficients[1:] * np.arange(1, len(coefficients))[:, None]


def wavenumbers(coefficients: ComplexArray) -> ComplexArray:
    """All roots κ of each polynomial [rad/m].

    A quartic without cubic term is solved in closed form, anything else by the eigenvalues of its companion
    matrix (balanced by LAPACK, so that roots of very different size keep their digits). Newton steps then
    bring each root to rounding accuracy.

    Parameters
    ----------
    coefficients : ndarray, shape (degree + 1, frequency)
        Coefficients of ascending powers of κ; the last row has no zero.

    Returns
    -------
    ndarray, shape (degree, frequency)
        The roots, in no particular order.
    """
    roots = guess = _first_guess(coefficients)
    slope = slopes(coefficients)
    for _ in range(ROOTS.most_steps):
        with np.errstate(all="ignore"):
            step = evaluated(coefficients, roots) / evaluated(slope, roots)
            # At a multiple root the slope vanishes and so does the need to move.
            step = np.where(np.isfinite(step), step, 0.0)
        roots = roots - step
        settled = _squared(step) <= ROOTS.converged**2 * _squared(roots)
        if settled.all():
            return roots
    far = np.flatnonzero(~settled.all(axis=0))
    roots[:, far] = _all_at_once(coefficients[:, far], guess[:, far])
    return roots


def _all_at_once(coefficients: ComplexArray, roots: ComplexArray) -> ComplexArray:
    """Roots that nearly meet, each pushed away by the others (Aberth and Ehrlich), shape (degree, frequency)."""
    # From a conjugate pair no two real roots are ever reached, and from one place no two at all.
    roots = roots * (1 + ROOTS.askew * np.arange(len(roots))[:, None])
    for _ in range(ROOTS.most_steps_together):
        with np.errstate(all="ignore"):
            newton = evaluated(coefficients, roots) / evaluated(slopes(coefficients), roots)
            gaps = roots[:, None] - roots
            gaps[np.arange(len(roots)), np.arange(len(roots))] = np.inf
            step = newton / (1 - newton * (1 / gaps).sum(axis=1))
            step = np.where(np.isfinite(step), step, 0.0)
        roots = roots - step
        if (_squared(step) <= ROOTS.converged**2 * _squared(roots)).all():
            break
    return roots


def _first_guess(coefficients: ComplexArray) -> ComplexArray:
    """Roots to a few digits at least, shape (degree, frequency)."""
    degree = len(coefficients) - 1
    if degree == 4 and not coefficients[3].any():
        monic = coefficients[:-1] / coefficients[-1]
        return _quartic(monic[2], monic[1], monic[0])
    for small in range(1, degree):
        if _far_apart(np.abs(coefficients), small):
            # At small v some roots run away to infinity, and a matrix that holds both kinds loses the others.
            return np.concatenate([_first_guess(coefficients[: small + 1]), _first_guess(coefficients[small:])])
    companion = np.zeros((coefficients.shape[1], degree, degree), complex)
    companion[:, np.arange(1, degree), np.arange(degree - 1)] = 1.0
    companion[:, :, -1] = -(coefficients[:-1] / coefficients[-1]).T
    return np.ascontiguousarray(np.linalg.eigvals(companion).T)


def _far_apart(sizes: FloatArray, small: int) -> bool:
    """Whether the first so many roots are, at every frequency, far smaller than the others (Cauchy's bounds)."""
    below = np.arange(small)[:, None]
    above = np.arange(small + 1, len(sizes))[:, None]
    if not sizes[small].all():
        return False
    largest = 2 * ((sizes[:small] / sizes[small]) ** (1 / (small - below))).max(axis=0)
    smallest = 0.5 / ((sizes[small + 1 :] / sizes[small]) ** (1 / (above - small))).max(axis=0)
    return bool((smallest > ROOTS.far * largest).all())


def _quartic(p: ComplexArray, q: ComplexArray, r: ComplexArray) -> ComplexArray:
    """Roots of x⁴ + p x² + q x + r by Ferrari's method, shape (4, frequency)."""
    # Resolvent cubic m³ + p m² + (p²/4 − r) m − q²/8 = 0 by Cardano, depressed with m = y − p/3.
    linear = -(p * p) / 12 - r
    constant = (p * r) / 3 - p * p * p / 108 - q * q / 8
    square_root = np.sqrt(constant * constant / 4 + linear * linear * linear / 27)
    # The sign without cancellation, then the branch that gives the largest m: m = 0 would divide by zero.
    opposed = constant.real * square_root.real + constant.imag * square_root.imag > 0
    u = _cube_root(np.where(opposed, -square_root, square_root) - constant / 2)
    with np.errstate(all="ignore"):
        partner = np.where(u == 0, 0.0, linear / (3 * u))
    turns = np.exp(2j * np.pi / 3 * np.arange(3))[:, None]
    m = turns * u - np.conj(turns) * partner - p / 3
    m = np.take_along_axis(m, _squared(m).argmax(axis=0)[None], axis=0)[0]
    root = np.sqrt(2 * m)
    with np.errstate(all="ignore"):
        quotient = np.where(root == 0, 0.0, 2 * q / root)
    first = np.sqrt(-(2 * p + 2 * m + quotient))
    second = np.sqrt(-(2 * p + 2 * m - quotient))
    roots: ComplexArray = np.stack([root + first, root - first, second - root, -root - second])
    roots *= 0.5
    return roots


def _cube_root(values: ComplexArray) -> ComplexArray:
    """Principal cube root, in a third of the time of a complex power."""
    size, angle = np.cbrt(np.abs(values)), np.arctan2(values.imag, values.real) / 3
    root = np.empty_like(values)
    root.real, root.imag = size * np.cos(angle), size * np.sin(angle)
    return root


def _squared(values: NumberArray) -> FloatArray:
    """Squared magnitude; several times faster than the magnitude."""
    return values.real**2 + values.imag**2


def residue_sum(
    stiffness: Ratio, ahead: FloatArray, speed: float, omega: ComplexArray, derivative: int
) -> ComplexArray:
    """Evaluate the moving FRF by closing the contour of the inverse Fourier integral over κ.

    For receivers ahead of the source the waves with Im κ > 0 count, behind those with Im κ < 0; how many
    there are on each side is found, never assumed. A root on the real axis belongs to the side to which the
    limit ω − i0⁺ pushes it.

    Parameters
    ----------
    stiffness : Ratio
        Dynamic stiffness of the guideway [N/m²].
    ahead : ndarray, shape (offset,)
        Receiver minus source [m], ascending and distinct.
    speed : float
        Common speed [m/s].
    omega : ndarray, shape (frequency,)
        Frequency in the moving frame [rad/s], Im ω ≤ 0.
    derivative : int
        Order of the derivative with respect to x.

    Returns
    -------
    ndarray, shape (offset, frequency)
        Moving FRF [m/N/m^derivative].

    Raises
    ------
    SolveError
        If the response is infinite: an undamped guideway at a cut-off frequency or a critical speed.
    """
    kappa, weight, forward = waves(stiffness, speed, omega)
    if derivative:
        weight = weight * (1j * kappa) ** derivative
    frf = np.zeros((ahead.size, omega.size), complex)
    for ahead_of_it in (True, False):
        here = (ahead >= 0) == ahead_of_it
        if here.any():
            frf[here] = _one_side(kappa, weight, forward == ahead_of_it, ahead[here])
            if not ahead_of_it:
                frf[here] *= -1.0
    _require_finite(frf, speed, omega)
    return frf


class Waves(NamedTuple):
    """Free waves of a guideway at some frequencies, each of shape (wave, frequency).

    G(ξ ≥ 0) = Σ weight e^{iκξ} over those that are forward, G(ξ < 0) = −Σ weight e^{iκξ} over the others.
    """

    kappa: ComplexArray  # wavenumbers [rad/m]
    weight: ComplexArray  # residues of the moving FRF [m/N]
    forward: BoolArray  # whether a wave counts ahead of the source


def waves(stiffness: Ratio, speed: float, omega: ComplexArray) -> Waves:
    """Find the waves of a guideway, and on which side of a source each of them counts.

    Parameters
    ----------
    stiffness : Ratio
        Dynamic stiffness of the guideway [N/m²].
    speed : float
        Common speed [m/s].
    omega : ndarray, shape (frequency,)
        Frequency in the moving frame [rad/s], Im ω ≤ 0.

    Returns
    -------
    Waves
        All of them.

    Raises
    ------
    SolveError
        If the response is infinite: an undamped guideway at a cut-off frequency or a critical speed.
    """
    if not omega.size:
        nothing = np.zeros((0, 0), complex)
        return Waves(nothing, nothing, nothing.real > 0)
    with np.errstate(all="ignore"):
        denominator = in_moving_frame(stiffness.above, speed, omega)
        kappa = wavenumbers(denominator)
        slope: ComplexArray = evaluated(slopes(denominator), kappa)
        weight = 1j * evaluated(in_moving_frame(stiffness.below, speed, omega), kappa) / slope
        side, infinite = _sides(stiffness.above, speed, omega, kappa, slope)
    _require_finite(np.where(infinite, np.nan, weight), speed, omega)
    return Waves(kappa, weight, side > 0)


def _require_finite(values: ComplexArray, speed: float, omega: ComplexArray) -> None:
    """Refuse a response, (…, frequency), that is infinite at some frequencies."""
    good = np.isfinite(values).all(axis=0)
    if not good.all():
        frequency = omega[good.argmin()] / (2 * np.pi)
        raise SolveError(
            f"the moving FRF is infinite at {frequency.real:.6g} Hz and {speed:.6g} m/s: an undamped resonance"
            " of the guideway, or values beyond floating-point range"
        )


def _sides(
    table: FloatArray, speed: float, omega: ComplexArray, kappa: ComplexArray, slope: ComplexArray
) -> tuple[FloatArray, BoolArray]:
    """Tell on which side of the real axis each root lies (by sign), and at which frequencies two sides meet."""
    side = kappa.imag
    infinite: BoolArray = np.zeros(omega.size, bool)
    size = evaluated(_expanded(np.abs(table), np.abs(omega), abs(speed)), np.abs(kappa))
    uncertain = ROOTS.rounding_errors * np.finfo(float).eps * size
    # To first order D is D′ times the distance from a root.
    doubtful = side * side * _squared(slope) <= uncertain * uncertain
    if not doubtful.any():
        return side, infinite
    # To second order D + D′x + D″x²/2 has a double root once D changes by D′²/2D″. For a pair κ ± iy that is
    # y|D′|/2: neither of a pair is ever taken as real.
    bend = evaluated(slopes(slopes(in_moving_frame(table, speed, omega))), kappa)
    infinite |= (doubtful & (_squared(slope) <= 2 * uncertain * np.abs(bend))).any(axis=0)
    # Im κ(ω − i0⁺) has the sign of Re(∂D/∂ω ÷ ∂D/∂κ).
    by_omega = evaluated(in_moving_frame(_by_omega(table), speed, omega), kappa)
    return np.where(doubtful, (by_omega / slope).real, side), infinite


def _by_omega(table: FloatArray) -> ComplexArray:
    """Table of the derivative with respect to ω: that by p, times i."""
    return 1j * table[:, 1:] * np.arange(1, table.shape[1])


def _one_side(kappa: ComplexArray, weight: ComplexArray, chosen: BoolArray, ahead: FloatArray) -> ComplexArray:
    """Sum the chosen waves at the given offsets; which ones they are may change from frequency to frequency."""
    total = np.zeros((ahead.size, kappa.shape[1]), complex)
    for wave, belongs in enumerate(chosen):
        at: slice | IntArray = slice(None) if belongs.all() else np.flatnonzero(belongs)
        # Right at the source no wave has travelled; `ahead` is ascending, so that only its first entry can be zero.
        resting = int(ahead[0] == 0)
        total[:resting, at] += weight[wave, at]
        total[resting:, at] += weight[wave, at] * np.exp(1j * kappa[wave, at] * ahead[resting:, None])
    return total


ONE = polynomial({(0, 0): 1.0})

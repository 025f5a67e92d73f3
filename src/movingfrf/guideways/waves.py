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

from movingfrf._basics.arrays import BoolArray, ComplexArray, FloatArray, IntArray, NumberArray, handed, squared
from movingfrf._basics.checks import SolveError
from movingfrf._basics.compiling import loops_for
from movingfrf.guideways.roots import ROOTS, inverse, wavenumbers


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


def in_moving_frame(table: NumberArray, speed: float) -> ComplexArray:
    """Put p = i(ω − κv) into a table.

    Parameters
    ----------
    table : ndarray, shape (power of κ, power of p)
        Coefficients.
    speed : float
        Speed of the observer [m/s].

    Returns
    -------
    ndarray, shape (power of κ, power of iω)
        Coefficients, without leading powers of κ that vanish.
    """
    return _expanded(table, -1j * speed if abs(speed) > ROOTS.at_rest else 0.0)


def _expanded(table: NumberArray, linear: complex) -> ComplexArray:
    """Put p = s + linear κ into a table, shape (power of κ, power of s)."""
    powers_kappa, powers_p = table.shape
    expanded = [[0j] * powers_p for _ in range(powers_kappa + (powers_p - 1 if linear else 0))]
    for a, row in enumerate(table.tolist()):
        for b, coefficient in enumerate(row):
            for j in range((b + 1 if linear else 1) if coefficient else 0):
                expanded[a + j][b - j] += coefficient * comb(b, j) * linear**j
    while len(expanded) > 1 and not any(expanded[-1]):
        expanded.pop()
    return np.array(expanded)


def at_frequencies(expanded: NumberArray, s: NumberArray) -> Any:
    """Polynomials in κ, shape (power of κ, frequency), of a table in κ and s at some s.

    Here, and in all that follows, frequency is the last axis: it is long, the others are short.
    """
    powers = np.ones((expanded.shape[1], s.size), s.dtype)
    for power in range(1, len(powers)):
        np.multiply(powers[power - 1], s, out=powers[power])
    return expanded @ powers


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


class Waves(NamedTuple):
    """Free waves of a guideway, as a moving FRF consists of them.

    G(ξ ≥ 0) = Σ weight e^{iκξ} over those that are forward, G(ξ < 0) = −Σ weight e^{iκξ} over the others.
    """

    kappa: ComplexArray  # (wave, frequency) wavenumber κ [rad/m]
    weight: ComplexArray  # (wave, frequency) i N(κ)/D′(κ) [m/N]
    forward: BoolArray  # (wave, frequency) whether it is met ahead of the source, or behind

    def summed(self, ahead: FloatArray, derivative: int = 0) -> ComplexArray:
        """Sum the waves that are met at some offsets.

        Parameters
        ----------
        ahead : ndarray, shape (offset,)
            Receiver minus source [m].
        derivative : int
            Order of the derivative with respect to x.

        Returns
        -------
        ndarray, shape (offset, frequency)
            Moving FRF [m/N/m^derivative].
        """
        kappa, weight, forward = self
        if derivative:
            weight = weight * (1j * kappa) ** derivative
        if loops := loops_for("guideways.compiled", kappa.size * ahead.size):
            return loops.summed(kappa, weight, forward, handed(ahead, float))
        frf = np.zeros((ahead.size, kappa.shape[1]), complex)
        for direction in (True, False):
            here = np.flatnonzero((ahead >= 0) == direction)
            for wave, belongs in enumerate(forward == direction):
                # Which waves they are may change from frequency to frequency.
                at: slice | IntArray = slice(None) if belongs.all() else np.flatnonzero(belongs)
                some = weight[wave, at] if direction else -weight[wave, at]
                for row in here if some.size else ():
                    # Right at the source no wave has travelled.
                    frf[row, at] += some * np.exp(1j * ahead[row] * kappa[wave, at]) if ahead[row] else some
        return frf


class Seen(NamedTuple):
    """A dynamic stiffness as an observer who travels along sees it: tables in (κ, iω)."""

    above: ComplexArray  # numerator D
    below: ComplexArray  # denominator N
    size: FloatArray  # sum of the magnitudes of the terms of D, in |κ| and |ω|
    by_omega: ComplexArray  # derivative of D by ω

    @property
    def waves(self) -> int:
        """Number of waves."""
        return len(self.above) - 1

    @property
    def numbers(self) -> tuple[Any, ...]:
        """What compiled loops take of a guideway."""
        return (*self, ROOTS.uncertain, ROOTS.numbers)

    @classmethod
    def of(cls, stiffness: Ratio, speed: float) -> Seen:
        """Look at a dynamic stiffness [N/m²] at some speed [m/s]."""
        above, below = (in_moving_frame(table, speed) for table in (stiffness.above, stiffness.below))
        size = _expanded(np.abs(stiffness.above), abs(speed)).real.copy()
        seen = cls(above, below, size, in_moving_frame(_by_omega(stiffness.above), speed))
        for table in seen:
            table.setflags(write=False)
        return seen


def waves(seen: Seen, speed: float, omega: ComplexArray) -> Waves:
    """Find the free waves of a guideway, and on which side of a source each is met.

    The moving FRF is the inverse Fourier integral over κ, its contour closed. For receivers ahead of the source
    the waves with Im κ > 0 count, behind those with Im κ < 0; how many there are on each side is found, never
    assumed. A root on the real axis belongs to the side to which the limit ω − i0⁺ pushes it.

    Parameters
    ----------
    seen : Seen
        Dynamic stiffness of the guideway at that speed [N/m²].
    speed : float
        Common speed of source and receiver [m/s].
    omega : ndarray, shape (frequency,)
        Frequency in the moving frame [rad/s], Im ω ≤ 0.

    Returns
    -------
    Waves
        As many as the dynamic stiffness has zeros.

    Raises
    ------
    SolveError
        If the response is infinite: an undamped guideway at a cut-off frequency or a critical speed.
    """
    if not omega.size:
        nothing = np.zeros((0, 0), complex)
        return Waves(nothing, nothing, nothing.real > 0)
    if loops := loops_for("guideways.compiled", seen.waves * omega.size):
        found, infinite = loops.waves(seen.numbers, handed(omega))
    else:
        with np.errstate(all="ignore"):
            found, infinite = _waves(seen, omega, ROOTS.uncertain)
    if infinite.any():
        refuse(infinite, speed, omega)
    require_finite(found[1], speed, omega)
    return Waves(*found)


def require_finite(values: ComplexArray, speed: float, omega: ComplexArray) -> None:
    """Refuse a response, (…, frequency), that is not finite at some frequency [rad/s] and this speed [m/s].

    Raises
    ------
    SolveError
        With the first of them.
    """
    # A sum is finite only if all of its terms are.
    if not np.isfinite(values.sum()):
        refuse(~np.isfinite(values).all(axis=tuple(range(values.ndim - 1))), speed, omega)


def refuse(bad: Any, speed: float, omega: ComplexArray) -> None:
    """Refuse a response that is infinite at the first of the marked frequencies [rad/s], at this speed [m/s].

    Raises
    ------
    SolveError
        With that frequency.
    """
    frequency = omega[bad.argmax()] / (2 * np.pi)
    raise SolveError(
        f"the moving FRF is infinite at {frequency.real:.6g} Hz and {speed:.6g} m/s: an undamped resonance"
        " of the guideway, or values beyond floating-point range"
    )


def _waves(
    seen: Seen, omega: ComplexArray, uncertain: float
) -> tuple[tuple[ComplexArray, ComplexArray, BoolArray], BoolArray]:
    """Find waves, and at which frequencies two of them meet from both sides; `compiled.waves` in NumPy.

    What is less than the share `uncertain` of all terms of D counts as nothing.
    """
    s = 1j * omega
    denominator = at_frequencies(seen.above, s)
    kappa, unsettled = wavenumbers(denominator)
    slope = evaluated(slopes(denominator), kappa)
    weight = evaluated(at_frequencies(seen.below, s), kappa) * inverse(slope)
    side, infinite = kappa.imag, np.zeros(omega.size, bool)
    doubt = uncertain * evaluated(at_frequencies(seen.size, np.abs(omega)), np.sqrt(squared(kappa)))
    # To first order D is D′ times the distance from a root.
    doubtful = side * side * squared(slope) <= doubt * doubt
    if doubtful.any():
        # To second order D + D′x + D″x²/2 has a double root once D changes by D′²/2D″. For a pair κ ± iy that is
        # y|D′|/2: neither of a pair is ever taken as real.
        bend = evaluated(slopes(slopes(denominator)), kappa) if len(denominator) > 2 else 0j * kappa
        infinite = (doubtful & (squared(slope) <= 2 * doubt * np.abs(bend))).any(axis=0)
        # Im κ(ω − i0⁺) has the sign of Re(∂D/∂ω ÷ ∂D/∂κ).
        side = np.where(doubtful, (evaluated(at_frequencies(seen.by_omega, s), kappa) / slope).real, side)
    # What still moves is a multiple root, or none.
    lost = np.abs(evaluated(denominator[:, unsettled], kappa[:, unsettled])) > doubt[:, unsettled]
    infinite[unsettled] |= lost.any(axis=0)
    return (kappa, 1j * weight, side > 0), infinite


def _by_omega(table: FloatArray) -> ComplexArray:
    """Table of the derivative with respect to ω: that by p, times i."""
    return 1j * table[:, 1:] * np.arange(1, table.shape[1])


ONE = polynomial({(0, 0): 1.0})

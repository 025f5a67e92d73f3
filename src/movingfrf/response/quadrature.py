"""Integrals over densities with peaks and combs: Gauss points on panels, halved until every density is resolved."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import SolveError


@dataclass(frozen=True, slots=True, kw_only=True)
class PanelRule:
    """What tunes the integrals over densities; in brackets, between what each number is safe."""

    # Gauss points of a panel. Its integrals are exact for polynomials of degree 23.
    points: int = 12  # [8 to 12]
    # What the last two Legendre coefficients of a density may amount to over all panels, relative to its integral.
    # The integrals themselves are far more accurate, 1e-9 and better: the rule is exact for twice the degree.
    unresolved: float = 1e-3  # [1e-4 to 3e-3]
    # A panel this narrow, relative to its frequency, cannot be halved any further; so many panels are beyond
    # reason.
    narrowest: float = 1e-10  # [1e-13 to 1e-9]
    most_panels: int = 50_000  # [a convention]


PANELS = PanelRule()


class Unresolved(SolveError):
    """A density is so sharp that halving does not resolve it.

    Parameters
    ----------
    frequency : float
        Where [Hz].
    """

    def __init__(self, frequency: float) -> None:
        self.frequency = frequency
        super().__init__(f"the spectral densities of the response cannot be resolved near {frequency:.4g} Hz")


class Lines(NamedTuple):
    """Densities at frequencies that are at the same time the points of a quadrature."""

    frequency: FloatArray  # (frequency,) ascending [Hz]
    bandwidth: FloatArray  # (frequency,) what the density there stands for [Hz]
    density: FloatArray  # (frequency, output) [unit²/Hz]

    def moment(self, power: float) -> FloatArray:
        """∫ fᵏ S df of every output, shape (output,) [unit² Hz^power]."""
        return (self.bandwidth * self.frequency**power) @ self.density


def resolved(
    density: Callable[[FloatArray], FloatArray],
    edges: FloatArray,
    *,
    powers: tuple[int, ...],
    comparable: FloatArray,
) -> Lines:
    """Find frequencies that resolve densities, and their moments.

    On each panel the densities are interpolated at Gauss points; the last two coefficients in Legendre polynomials
    say how well. Panels on which they are not small are halved.

    Parameters
    ----------
    density : callable
        Densities (frequency, output) at frequencies (frequency,) [Hz].
    edges : ndarray, shape (edge,)
        Increasing frequencies between which panels lie at first [Hz]; a kink or jump is best placed on one.
    powers : tuple of int
        Moments ∫ fᵏ S df that have to be resolved.
    comparable : ndarray, shape (output, output)
        Row by row the integral that an output is measured by: the identity, plus what makes an output negligible
        beside others.

    Returns
    -------
    Lines
        Densities with frequencies and bandwidths.

    Raises
    ------
    SolveError
        If a density is not finite.
    Unresolved
        If it is so sharp that halving does not resolve it.
    """
    at, weight, last = _gauss()
    panels = np.stack([edges[:-1], edges[1:]], axis=1)
    low = high = np.empty(0)
    values = np.empty((0, PANELS.points, len(comparable)))
    while True:
        low, high = np.concatenate([low, panels[:, 0]]), np.concatenate([high, panels[:, 1]])
        frequency = _inside(panels[:, 0], panels[:, 1], at)
        values = np.concatenate([values, density(frequency.ravel()).reshape(len(panels), PANELS.points, -1)])
        if not np.isfinite(values.sum()):
            raise SolveError("a spectral density of the response exceeds the range of floating-point numbers")
        half = 0.5 * (high - low)
        raised = half[:, None] * _inside(low, high, at) ** np.array(powers)[:, None, None]  # (power, panel, point)
        whole = (weight * raised).reshape(len(powers), -1) @ values.reshape(-1, values.shape[2])
        unresolved = sum(np.abs((coefficient * raised).transpose(1, 0, 2) @ values) for coefficient in last)
        rough = (unresolved > PANELS.unresolved * (whole @ comparable.T) / len(low)).any(axis=(1, 2))
        if not rough.any():
            break
        if (half[rough] < PANELS.narrowest * high[rough]).any() or len(low) > PANELS.most_panels:
            raise Unresolved(float(low[rough][half[rough].argmin()]))
        middle = low[rough] + half[rough]
        panels = np.concatenate([np.stack([low[rough], middle], axis=1), np.stack([middle, high[rough]], axis=1)])
        low, high, values = low[~rough], high[~rough], values[~rough]
    order = np.argsort(low)
    frequency = _inside(low, high, at)[order].ravel()
    bandwidth = np.outer(half, weight)[order].ravel()
    return Lines(frequency, bandwidth, values[order].reshape(frequency.size, -1))


def _inside(low: FloatArray, high: FloatArray, at: FloatArray) -> FloatArray:
    """Gauss points of every panel, shape (panel, point)."""
    return 0.5 * ((low + high)[:, None] + np.outer(high - low, at))


@cache
def _gauss() -> tuple[FloatArray, FloatArray, FloatArray]:
    """Points and weights on −1 … 1, and the functionals that give what the last two coefficients integrate to."""
    points = PANELS.points
    at, weight = np.polynomial.legendre.leggauss(points)
    degrees = np.arange(points - 2, points)
    polynomials = np.polynomial.legendre.legvander(at, points - 1)[:, degrees]
    # ∫|P_k| is below 2; a coefficient is (2k + 1)/2 ∫ P_k S.
    return at, weight, (2 * degrees + 1)[:, None] * polynomials.T * weight

"""How much two wheel paths have in common: the coherence of parallel profiles of one surface."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy.special import gamma, kv

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import checking
from movingfrf._basics.values import Value
from movingfrf.roughness.spectra.iso import IsoRoad
from movingfrf.roughness.spectra.spectrum import LARGEST_WAVINESS, Spectrum


class Coherence(Protocol):
    """What two parallel paths of a surface have in common, wave by wave.

    The cross-spectral density of two paths is γ times the spectral density of each: γ is real, since a surface that
    looks the same from the left and from the right delays no path against the other, 1 for one and the same path,
    and positive semidefinite over any set of paths. It is the cross-spectrum divided by the spectrum; the
    magnitude-squared coherence that estimators report is γ².
    """

    def between(self, spatial_frequency: FloatArray, apart: FloatArray) -> FloatArray:
        """Coherence γ of two paths.

        Parameters
        ----------
        spatial_frequency : ndarray, shape (frequency,)
            Spatial frequency along the road [cycle/m].
        apart : ndarray, shape (*s)
            Distance between the paths across the road [m], of either sign.

        Returns
        -------
        ndarray, shape (frequency, *s)
            γ, dimensionless.
        """
        ...


@dataclass(frozen=True, slots=True)
class IsotropicCoherence(Value):
    """Coherence of a surface that is equally rough in all directions, with a spectrum that falls as n^−w.

    A surface whose spectral density over both wavenumbers depends on their magnitude alone, S(κ) ∝ κ^−(w+1), has
    along every straight line a spectrum ∝ n^−w. Its cross-spectrum between two lines Δy apart is
    ∫ (k² + q²)^−(w+1)/2 cos(q Δy) dq with k = 2πn, which Basset's integral turns into a modified Bessel function:

        γ = 2^(1−ν)/Γ(ν) · z^ν K_ν(z),   z = 2πn |Δy|,   ν = w/2;   w = 2: γ = z K₁(z).

    Parameters
    ----------
    waviness : float
        Exponent w of the spectrum along the road.

    Raises
    ------
    ValueError
        If the waviness is not positive, or beyond 10.

    References
    ----------
    K. M. A. Kamash, J. D. Robson: The application of isotropy in road surface modelling. Journal of Sound and
    Vibration 57 (1978) 89–100. NIST Digital Library of Mathematical Functions, 10.32.11 (Basset's integral).

    Examples
    --------
    >>> IsotropicCoherence().between(np.array([0.01, 0.1, 1.0]), np.array(1.5)).round(3).tolist()
    [0.987, 0.626, 0.0]
    """

    waviness: float = 2.0

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking(self) as check:
            if check.positive("waviness", self.waviness, "1") > LARGEST_WAVINESS:
                check.refuse("waviness", f"must be at most {LARGEST_WAVINESS:g}, got {self.waviness!r}")

    def between(self, spatial_frequency: FloatArray, apart: FloatArray) -> FloatArray:
        """Coherence γ of two paths; see `Coherence`.

        Parameters
        ----------
        spatial_frequency : ndarray, shape (frequency,)
            Spatial frequency along the road [cycle/m].
        apart : ndarray, shape (*s)
            Distance between the paths across the road [m].

        Returns
        -------
        ndarray, shape (frequency, *s)
            γ, dimensionless.
        """
        order = self.waviness / 2
        z = 2 * np.pi * _products(spatial_frequency, apart)
        # Below it the Bessel function of the largest waviness, K₅, would overflow. γ differs from 1 by some z^w
        # there, and by z² ln z at the least: by rounding alone for roads, whose w is 1 and more [1e-60 to 1e-17].
        shown = np.maximum(z, 1e-60)
        shared = 2 ** (1 - order) / gamma(order) * shown**order * kv(order, shown)
        return np.where(z > 0, np.minimum(shared, 1.0), 1.0)


@dataclass(frozen=True, slots=True)
class ExponentialCoherence(Value):
    """Coherence that decays exponentially with the distance over the wavelength, γ = exp(−d n |Δy|).

    A model of one parameter, to be fitted to measured pairs of paths.

    Parameters
    ----------
    decay : float
        Dimensionless ratio d. At 3.46 half of the amplitude is in common at the same wave as on an isotropic
        surface of waviness 2; smaller values make paths that share more of their short waves.

    Raises
    ------
    ValueError
        If the decay is negative.

    Examples
    --------
    >>> ExponentialCoherence(decay=4.0).between(np.array([0.1]), np.array([0.0, 1.5])).round(3).tolist()
    [[1.0, 0.549]]
    """

    decay: float

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking(self) as check:
            check.not_negative("decay", self.decay, "1")

    def between(self, spatial_frequency: FloatArray, apart: FloatArray) -> FloatArray:
        """Coherence γ of two paths; see `Coherence`.

        Parameters
        ----------
        spatial_frequency : ndarray, shape (frequency,)
            Spatial frequency along the road [cycle/m].
        apart : ndarray, shape (*s)
            Distance between the paths across the road [m].

        Returns
        -------
        ndarray, shape (frequency, *s)
            γ, dimensionless.
        """
        return np.exp(-self.decay * _products(spatial_frequency, apart))


def _products(spatial_frequency: FloatArray, apart: FloatArray) -> FloatArray:
    """Distances between paths over wavelengths, shape (frequency, *s)."""
    with checking() as check:
        n = check.array("spatial_frequency", spatial_frequency, "cycle/m", None)
        distance = np.abs(check.array("apart", apart, "m", None))
    products: FloatArray = np.multiply.outer(n, distance)
    return products


def presumed(spectrum: Spectrum) -> Coherence | None:
    """Coherence of the isotropic surface with a given spectrum, where that has a closed form.

    Parameters
    ----------
    spectrum : Spectrum
        One-sided spectrum along the road.

    Returns
    -------
    IsotropicCoherence or None
        None if the spectrum is none of a single falling power.
    """
    if isinstance(spectrum, IsoRoad) and spectrum.waviness > 0:
        return IsotropicCoherence(waviness=spectrum.waviness)
    return None

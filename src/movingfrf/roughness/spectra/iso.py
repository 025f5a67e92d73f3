"""Roughness spectra: one-sided, over spatial frequency in cycles per metre."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import Checks, checking

# Spatial frequency at which ISO 8608 states the roughness [cycle/m].
REFERENCE_FREQUENCY = 0.1

# Geometric class centres of ISO 8608 at 0.1 cycle/m [m³]; the limits between classes are twice these.
CLASS_CENTRES = {letter: 16e-6 * 4.0**n for n, letter in enumerate("ABCDEFGH")}

# Measured roads lie between 1 and 4; powers far beyond overflow.
LARGEST_WAVINESS = 10.0


class Spectrum(Protocol):
    """A roughness spectrum: how much elevation lies at which spatial frequency."""

    @property
    def band(self) -> tuple[float, float]:
        """Spatial frequencies between which there is content [cycle/m]."""
        ...

    def density(self, spatial_frequency: FloatArray) -> FloatArray:
        """One-sided spectral density of the elevation, zero outside the band [m³]."""
        ...

    def variance_below(self, spatial_frequency: FloatArray) -> FloatArray:
        """Variance of the elevation up to a spatial frequency [m²]."""
        ...


class BandLimited(ABC):
    """A formula and its integral, cut off at the ends of a band: all that a spectrum needs."""

    __slots__ = ()
    band: tuple[float, float]

    @abstractmethod
    def _formula(self, n: FloatArray) -> FloatArray:
        """Spectral density within the band [m³]."""

    @abstractmethod
    def _integral(self, low: float, high: FloatArray) -> FloatArray:
        """Integral of the formula between two places within the band [m²]."""

    def density(self, spatial_frequency: FloatArray) -> FloatArray:
        """One-sided spectral density of the elevation, zero outside the band.

        Parameters
        ----------
        spatial_frequency : ndarray
            Spatial frequency [cycle/m].

        Returns
        -------
        ndarray
            G_d [m³].
        """
        n = np.clip(spatial_frequency, *self.band)
        return np.where(n == spatial_frequency, self._formula(n), 0.0)

    def variance_below(self, spatial_frequency: FloatArray) -> FloatArray:
        """Variance of the elevation from the lower end of the band up to a spatial frequency.

        Parameters
        ----------
        spatial_frequency : ndarray
            Spatial frequency [cycle/m].

        Returns
        -------
        ndarray
            ∫ G_d dn [m²].
        """
        return self._integral(self.band[0], np.clip(spatial_frequency, *self.band))


@dataclass(frozen=True, slots=True, kw_only=True)
class IsoRoad(BandLimited):
    """Roughness spectrum of ISO 8608, G_d(n) = G_d(n₀) (n/n₀)^−w with n₀ = 0.1 cycle/m.

    Parameters
    ----------
    roughness : float
        Displacement spectral density G_d(n₀) [m³].
    waviness : float
        Exponent w; 2 in the standard.
    band : tuple of float
        Lowest and highest spatial frequency with content [cycle/m].

    Raises
    ------
    ValueError
        If the roughness is not positive, or the band is not two increasing positive frequencies.

    References
    ----------
    ISO 8608:2016, Mechanical vibration: road surface profiles, reporting of measured data.

    Examples
    --------
    >>> IsoRoad.of_class("A").roughness
    1.6e-05
    >>> IsoRoad(roughness=16e-6).density(np.array([0.1, 1.0])).tolist()
    [1.6e-05, 1.6e-07]
    """

    roughness: float
    waviness: float = 2.0
    band: tuple[float, float] = (0.01, 10.0)

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking() as check:
            check.positive("roughness", self.roughness, "m³")
            check_waviness(check, self.waviness)
            band = checked_band(check, self.band)
        object.__setattr__(self, "band", band)

    def __str__(self) -> str:
        """Say which spectrum it is, in words."""
        return (
            f"ISO 8608 class {iso_class(self.roughness)}, {self.roughness:g} m³ at 0.1 cycle/m, waviness "
            f"{self.waviness:g}, {band_in_words(self.band)}"
        )

    @classmethod
    def of_class(
        cls, road_class: str, *, waviness: float = 2.0, band: tuple[float, float] = (0.01, 10.0)
    ) -> IsoRoad:
        """Road of an ISO 8608 class, at the class's geometric centre.

        Parameters
        ----------
        road_class : str
            Class, A (smooth) to H (rough).
        waviness : float
            Exponent w.
        band : tuple of float
            Lowest and highest spatial frequency with content [cycle/m].

        Returns
        -------
        IsoRoad
            The spectrum.

        Raises
        ------
        ValueError
            If there is no such class.
        """
        with checking() as check:
            if not isinstance(road_class, str) or road_class.upper() not in CLASS_CENTRES:
                check.refuse("road_class", f"must be one of {', '.join(CLASS_CENTRES)}, got {road_class!r}")
            check_waviness(check, waviness)
            checked_band(check, band)
        return cls(roughness=CLASS_CENTRES[road_class.upper()], waviness=waviness, band=band)

    def _formula(self, n: FloatArray) -> FloatArray:
        return self.roughness * (n / REFERENCE_FREQUENCY) ** -self.waviness

    def _integral(self, low: float, high: FloatArray) -> FloatArray:
        return power_integral(self.roughness * REFERENCE_FREQUENCY**self.waviness, self.waviness, low, high)


def power_integral(
    scale: FloatArray | float, exponent: FloatArray | float, low: FloatArray | float, high: FloatArray | float
) -> FloatArray:
    """∫ scale · n^−w dn from `low` to `high`, for an exponent w of any size.

    Examples
    --------
    >>> power_integral(2.0, 2.0, 1.0, np.array([2.0, 4.0])).tolist()
    [1.0, 1.5]
    """
    power = 1 - np.asarray(exponent, float)
    logarithm = power == 0
    safe = np.where(logarithm, 1.0, power)
    return np.where(
        logarithm, scale * np.log(np.divide(high, low)), scale * (np.power(high, safe) - np.power(low, safe)) / safe
    )


def check_waviness(check: Checks, waviness: float) -> None:
    """Demand an exponent whose powers do not overflow."""
    if abs(check.finite("waviness", waviness, "1")) > LARGEST_WAVINESS:
        check.refuse("waviness", f"must lie within ±{LARGEST_WAVINESS:g}, got {waviness!r}")


def checked_band(check: Checks, band: tuple[float, float]) -> tuple[float, float]:
    """Demand two increasing positive frequencies."""
    low, high = check.pair("band", band, "cycle/m")
    if low >= high:
        check.refuse("band", f"must be two increasing frequencies, got {band!r} cycle/m")
    return low, high


def band_in_words(band: tuple[float, float]) -> str:
    """Write a band with its unit."""
    return f"{band[0]:g} to {band[1]:g} cycle/m"


def iso_class(roughness: float) -> str:
    """Class of ISO 8608 that a roughness at 0.1 cycle/m falls into.

    Parameters
    ----------
    roughness : float
        G_d(n₀) [m³].

    Returns
    -------
    str
        A to H; rougher roads than H are H.

    Examples
    --------
    >>> iso_class(31e-6), iso_class(33e-6)
    ('A', 'B')
    """
    return next((letter for letter, centre in CLASS_CENTRES.items() if roughness < 2 * centre), "H")

"""What a spectrum of roughness is, and the band that it covers."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Protocol

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import Checks, checking
from movingfrf._basics.door import mistaken
from movingfrf._basics.values import Value

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


class BandLimited(ABC, Value):
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

        Raises
        ------
        ValueError
            If a frequency is not finite.
        """
        asked = _checked_frequency(spatial_frequency)
        n = np.clip(asked, *self.band)
        return np.where(n == asked, self._formula(n), 0.0)

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

        Raises
        ------
        ValueError
            If a frequency is not finite.
        """
        return self._integral(self.band[0], np.clip(_checked_frequency(spatial_frequency), *self.band))


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


def _checked_frequency(spatial_frequency: FloatArray) -> FloatArray:
    with checking() as check:
        n = check.array("spatial_frequency", spatial_frequency, "cycle/m", None)
    return n


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


def require_spectrum(spectrum: object) -> None:
    """Refuse what is no spectrum.

    Parameters
    ----------
    spectrum : object
        What was given.

    Raises
    ------
    ValueError
        If it does not keep the contract of a `Spectrum`.
    """
    with checking() as check:
        is_spectrum(check, spectrum)


def is_spectrum(check: Checks, spectrum: object) -> bool:
    """Refuse what is no spectrum, along with whatever else is wrong; whether it is one."""
    kept = all(hasattr(spectrum, name) for name in ("band", "density", "variance_below"))
    if isinstance(spectrum, type) or not kept:
        check.refuse("spectrum", mistaken("spectrum", spectrum))
        return False
    return True

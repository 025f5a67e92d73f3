"""Spectra by table: densities, or levels in thirds of octaves as acoustics states the roughness of rails."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import checking
from movingfrf._basics.values import digest
from movingfrf.roughness.spectra.spectrum import BandLimited, Spectrum, band_in_words, require_spectrum

# Amplitude to which levels of roughness refer [m].
REFERENCE_AMPLITUDE = 1e-6

# A third of an octave in base ten, from its centre to either edge.
HALF_THIRD = 10**0.05


@dataclass(frozen=True, slots=True, eq=False)
class TabulatedSpectrum(BandLimited):
    """Spectrum through tabulated densities, straight between them in logarithms.

    Parameters
    ----------
    spatial_frequency : array_like, shape (frequency,)
        Spatial frequencies [cycle/m], increasing and positive; the first and the last end the band.
    spectral_density : array_like, shape (frequency,)
        One-sided density of the elevation at each [m³].

    Raises
    ------
    ValueError
        If there are less than two frequencies, they do not increase, or a density is not positive.

    Examples
    --------
    >>> spectrum = TabulatedSpectrum(spatial_frequency=[0.1, 1.0, 10.0], spectral_density=[1e-5, 1e-7, 1e-8])
    >>> spectrum.density(np.array([0.2, 2.0])).round(9).tolist()
    [2.5e-06, 5e-08]
    """

    spatial_frequency: ArrayLike
    spectral_density: ArrayLike

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking(self) as check:
            n = check.array("spatial_frequency", self.spatial_frequency, "cycle/m", (None,))
            density = check.array("spectral_density", self.spectral_density, "m³", (None,))
            if not check.faults:
                if n.size < 2 or n[0] <= 0 or (np.diff(n) <= 0).any():
                    check.refuse("spatial_frequency", "must be at least two increasing positive numbers [cycle/m]")
                if density.size != n.size:
                    check.refuse(
                        "spectral_density", f"must have {n.size} values, one per frequency, got {density.size}"
                    )
                if (density <= 0).any():
                    check.refuse("spectral_density", f"must be positive throughout, got {density.min():g} m³")

    def __repr__(self) -> str:
        """Say which spectrum it is, and a sum over its numbers in place of them: results carry it."""
        return f"TabulatedSpectrum({self}, blake2b={digest(self)})"

    def __str__(self) -> str:
        """Say which spectrum it is, in words."""
        return f"spectrum through {np.size(self.spatial_frequency)} values, {band_in_words(self.band)}"

    @property
    def band(self) -> tuple[float, float]:  # type: ignore[override]
        """Spatial frequencies between which there is content [cycle/m]."""
        n = np.asarray(self.spatial_frequency)
        return float(n[0]), float(n[-1])

    def _formula(self, n: FloatArray) -> FloatArray:
        knots, values = np.asarray(self.spatial_frequency), np.asarray(self.spectral_density)
        return np.exp(np.interp(np.log(n), np.log(knots), np.log(values)))

    def _integral(self, low: float, high: FloatArray) -> FloatArray:
        # The band begins with the first value, where the sum below is zero.
        knots, values = np.asarray(self.spatial_frequency), np.asarray(self.spectral_density)
        rise = 1 + np.diff(np.log(values)) / np.diff(np.log(knots))
        whole = self._over_piece(knots[:-1], values[:-1], rise, knots[1:])
        before = np.concatenate([[0.0], np.cumsum(whole)[:-1]])
        piece = np.clip(np.searchsorted(knots, high, side="right") - 1, 0, rise.size - 1)
        return before[piece] + self._over_piece(knots[piece], values[piece], rise[piece], high)

    @staticmethod
    def _over_piece(knot: FloatArray, value: FloatArray, rise: FloatArray, n: FloatArray) -> FloatArray:
        """∫ value · (n/knot)^(rise − 1) dn from the knot on, also where the rise is all but zero."""
        growth = np.log(n / knot)
        safe = np.where(rise == 0, 1.0, rise)
        return value * knot * np.where(rise == 0, growth, np.expm1(safe * growth) / safe)


@dataclass(frozen=True, slots=True, eq=False)
class ThirdOctaveSpectrum(BandLimited):
    """Spectrum with given levels in bands of a third of an octave, its density the same throughout each band.

    Parameters
    ----------
    wavelength : array_like, shape (band,)
        Centre of each band [m], in increasing or decreasing order without gaps; nominal values will do.
    level : array_like, shape (band,)
        Level of the mean square within each band [dB re 1 µm].

    Raises
    ------
    ValueError
        If there are less than two bands, or wavelengths are not a third of an octave apart.

    Examples
    --------
    >>> rail = ThirdOctaveSpectrum(wavelength=[0.02, 0.016, 0.0125], level=[0.0, -3.0, -6.0])
    >>> third_octave_levels(rail, [0.016]).round(1).tolist()
    [-3.0]
    """

    wavelength: ArrayLike
    level: ArrayLike

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking(self) as check:
            centres = check.array("wavelength", self.wavelength, "m", (None,))
            levels = check.array("level", self.level, "dB", (None,))
            if not check.faults:
                if centres.size < 2 or (centres <= 0).any():
                    check.refuse("wavelength", "must be at least two positive numbers [m]")
                # Nominal centres are off by up to 0.006 decades each.
                elif np.abs(np.abs(np.diff(np.log10(centres))) - 0.1).max() > 0.012:
                    check.refuse("wavelength", "must be a third of an octave apart, as 0.02, 0.016, 0.0125 m are")
                elif np.unique(np.sign(np.diff(centres))).size > 1:
                    check.refuse("wavelength", "must go in one direction, to longer or to shorter waves [m]")
                if levels.size != centres.size:
                    check.refuse("level", f"must have {centres.size} values, one per wavelength, got {levels.size}")
                if (np.abs(levels) > 200).any():
                    check.refuse("level", "must be of a credible magnitude, within ±200 dB")

    def __repr__(self) -> str:
        """Say which spectrum it is, and a sum over its numbers in place of them: results carry it."""
        return f"ThirdOctaveSpectrum({self}, blake2b={digest(self)})"

    def __str__(self) -> str:
        """Say which spectrum it is, in words."""
        return f"levels in {np.size(self.level)} thirds of octaves, {band_in_words(self.band)}"

    @property
    def band(self) -> tuple[float, float]:  # type: ignore[override]
        """Spatial frequencies between which there is content [cycle/m]."""
        edges, _ = self._bands
        return float(edges[0]), float(edges[-1])

    @property
    def _bands(self) -> tuple[FloatArray, FloatArray]:
        """Edges of the bands, midway between their centres [cycle/m], and the mean square within each [m²]."""
        order = np.argsort(-np.asarray(self.wavelength))
        centres = 1 / np.asarray(self.wavelength)[order]
        midway = np.sqrt(centres[:-1] * centres[1:])
        edges = np.array([centres[0] / HALF_THIRD, *midway, centres[-1] * HALF_THIRD])
        return edges, REFERENCE_AMPLITUDE**2 * 10 ** (np.asarray(self.level)[order] / 10)

    def _formula(self, n: FloatArray) -> FloatArray:
        edges, mean_square = self._bands
        which = np.clip(np.searchsorted(edges, n, side="right") - 1, 0, mean_square.size - 1)
        return (mean_square / np.diff(edges))[which]

    def _integral(self, low: float, high: FloatArray) -> FloatArray:
        edges, mean_square = self._bands
        return np.interp(high, edges, np.concatenate([[0.0], np.cumsum(mean_square)]))


def iso3095_limit() -> ThirdOctaveSpectrum:
    """Highest roughness of the rails of a test track for noise, ISO 3095:2013, waves of 3.15 mm to 0.4 m.

    Returns
    -------
    ThirdOctaveSpectrum
        The limit as a spectrum.

    Notes
    -----
    The 22 levels were found alike as Figure 2 of ISO 3095:2013, in the listing of EN 15610:2009, and among the rail
    roughnesses of Delegated Directive (EU) 2021/1226.

    Examples
    --------
    >>> third_octave_levels(iso3095_limit(), [0.1, 0.01]).round(6).tolist()
    [4.9, -8.0]
    """
    # Figure 2: levels [dB re 1 µm] at wavelengths from 40 to 0.315 cm.
    wavelengths = 10 ** (-np.arange(4, 26) / 10)
    levels = (
        "17.1 15.0 13.0 11.0 9.0 7.0 4.9 2.9 0.9 -1.1 -3.2 -5.0 -5.6 -6.2 -6.8 -7.4 -8.0 -8.6 -9.2 -9.8 -10.4 -11.0"
    )
    return ThirdOctaveSpectrum(wavelength=wavelengths, level=np.array(levels.split(), float))


def third_octave_levels(spectrum: Spectrum, wavelength: ArrayLike) -> FloatArray:
    """Levels of roughness in bands of a third of an octave.

    Parameters
    ----------
    spectrum : Spectrum
        One-sided spectrum of the elevation.
    wavelength : array_like, shape (band,)
        Centre of each band [m].

    Returns
    -------
    ndarray, shape (band,)
        Level of the mean square within each band [dB re 1 µm]; −inf where there is nothing.

    Raises
    ------
    ValueError
        If a wavelength is not positive.
    """
    require_spectrum(spectrum)
    with checking() as check:
        centres = check.array("wavelength", wavelength, "m", (None,))
        if not check.faults and (centres <= 0).any():
            check.refuse("wavelength", f"must be positive, got {centres.min():g} m")
    mean_square = spectrum.variance_below(HALF_THIRD / centres) - spectrum.variance_below(
        1 / (HALF_THIRD * centres)
    )
    with np.errstate(divide="ignore"):
        return 10 * np.log10(mean_square / REFERENCE_AMPLITUDE**2)

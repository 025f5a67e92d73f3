"""Spectra of track irregularities, vertical, all converted to one-sided ones over cycles per metre.

The sources state them in several ways: over the wavenumber Ω = 2πn in rad/m, where S(n) = 2π S(2πn), or over n
itself; in cm², mm² or m². Each class says what its source states, and what of it was checked against what.
"""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from dataclasses import KW_ONLY, dataclass
from typing import Any, ClassVar

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import checking, plain, shown, spelt
from movingfrf.roughness.spectra.spectrum import BandLimited, band_in_words, checked_band, power_integral

# Wavelengths between which the FRA's forms hold: 5 and 1000 feet.
FRA_BAND = (1 / 304.8, 1 / 1.524)


@dataclass(frozen=True, slots=True)
class FraTrack(BandLimited):
    """Vertical profile of American track by class, S(Ω) = k A_v Ω_c²/(Ω²(Ω² + Ω_c²)) with k = 0.25.

    Over wavenumber in rad/m, Ω_c = 0.8245 rad/m, one-sided, A_v in cm² rad/m at the source. In its mid-band it is
    more than ten times as rough as `FrybaTrack` of the same class: two fits of different data that share a name.

    Parameters
    ----------
    roughness : float
        A_v [m² rad/m].
    band : tuple of float
        Lowest and highest spatial frequency with content [cycle/m]; by default waves of 5 to 1000 feet.

    Raises
    ------
    ValueError
        If the roughness is not positive, or the band is not two increasing positive frequencies.

    Notes
    -----
    The six values of A_v, k, Ω_c and the units were found alike in several open programs that superpose
    harmonics of variance S ΔΩ from it, which is what makes it one-sided. One program takes n in cycles per metre
    together with Ω_c in rad/m; the corner at 0.1312 cycle/m = 0.04 cycle/ft, which the other form has too, says
    that this is a slip.

    References
    ----------
    A. Hamid, K. Rasmussen, M. Baluja, T.-L. Yang: Analytical descriptions of track geometry variations.
    FRA/ORD-83/03.1 (1983), as used in the literature on trains and bridges.

    Examples
    --------
    >>> FraTrack.of_class(6).density(np.array([0.1])).round(9).tolist()
    [8.533e-06]
    """

    # 40 · 10⁻³ cycles per foot, which this form rounds to 0.8245 rad/m and Frýba's to 0.131 cycle/m.
    _CORNER: ClassVar[float] = 0.8245
    _FACTOR: ClassVar[float] = 0.25
    # Class of track → A_v [m² rad/m], published in cm² rad/m.
    _ROUGHNESS: ClassVar[Mapping[int, float]] = {
        1: 1.2107e-4,
        2: 1.0181e-4,
        3: 0.6816e-4,
        4: 0.5376e-4,
        5: 0.2095e-4,
        6: 0.0339e-4,
    }

    roughness: float
    _: KW_ONLY
    band: tuple[float, float] = FRA_BAND

    def __post_init__(self) -> None:
        """Check the parameters."""
        _check_and_store(self, self.roughness, "m² rad/m", self.band)

    def __str__(self) -> str:
        """Say which spectrum it is, in words."""
        return f"FRA track, A_v {self.roughness:g} m² rad/m, {band_in_words(self.band)}"

    @classmethod
    def of_class(cls, track_class: int, *, band: tuple[float, float] = FRA_BAND) -> FraTrack:
        """Track of a class of the Federal Railroad Administration.

        Parameters
        ----------
        track_class : int
            Class, 1 (poor) to 6 (good).
        band : tuple of float
            Lowest and highest spatial frequency with content [cycle/m].

        Returns
        -------
        FraTrack
            The spectrum.

        Raises
        ------
        ValueError
            If there is no such class.
        """
        return cls(roughness=_listed(track_class, cls._ROUGHNESS, band), band=band)

    @property
    def _corner(self) -> float:
        return self._CORNER / (2 * np.pi)

    @property
    def _scale(self) -> float:
        return self._FACTOR * self.roughness * self._CORNER**2 / (2 * np.pi) ** 3

    def _formula(self, n: FloatArray) -> FloatArray:
        return self._scale / (n**2 * (n**2 + self._corner**2))

    def _integral(self, low: float, high: FloatArray) -> FloatArray:
        c = self._corner
        return self._scale / c**2 * (1 / low - 1 / high - _lorentzian(c, low, high))


@dataclass(frozen=True, slots=True)
class FrybaTrack(BandLimited):
    """Vertical profile of American track by class, after Frýba, S(n) = A n₂²(n² + n₁²)/(n⁴(n² + n₂²)).

    Over cycles per metre, n₁ = 0.0233 and n₂ = 0.131 cycle/m: 7.1 · 10⁻³ and 40 · 10⁻³ cycles per foot. In its
    mid-band it is more than ten times smoother than `FraTrack` of the same class.

    Parameters
    ----------
    roughness : float
        A [m].
    band : tuple of float
        Lowest and highest spatial frequency with content [cycle/m]; by default waves of 5 to 1000 feet.

    Raises
    ------
    ValueError
        If the roughness is not positive, or the band is not two increasing positive frequencies.

    Notes
    -----
    The values were found in one open program, which quotes the book; that its corners are round numbers in
    cycles per foot confirms the unit of n. That the density is one-sided is taken from that program's use.

    References
    ----------
    L. Frýba: Dynamics of railway bridges. Academia, Praha, 1996.

    Examples
    --------
    >>> FrybaTrack.of_class(6).density(np.array([0.1])).round(10).tolist()
    [6.528e-07]
    """

    # Corners [cycle/m], and class of track → A [m].
    _CORNERS: ClassVar[tuple[float, float]] = (0.0233, 0.131)
    _ROUGHNESS: ClassVar[Mapping[int, float]] = {
        1: 15.53e-8,
        2: 8.85e-8,
        3: 4.92e-8,
        4: 2.75e-8,
        5: 1.57e-8,
        6: 0.98e-8,
    }

    roughness: float
    _: KW_ONLY
    band: tuple[float, float] = FRA_BAND

    def __post_init__(self) -> None:
        """Check the parameters."""
        _check_and_store(self, self.roughness, "m", self.band)

    def __str__(self) -> str:
        """Say which spectrum it is, in words."""
        return f"FRA track after Frýba, A {self.roughness:g} m, {band_in_words(self.band)}"

    @classmethod
    def of_class(cls, track_class: int, *, band: tuple[float, float] = FRA_BAND) -> FrybaTrack:
        """Track of a class of the Federal Railroad Administration.

        Parameters
        ----------
        track_class : int
            Class, 1 (poor) to 6 (good).
        band : tuple of float
            Lowest and highest spatial frequency with content [cycle/m].

        Returns
        -------
        FrybaTrack
            The spectrum.

        Raises
        ------
        ValueError
            If there is no such class.
        """
        return cls(roughness=_listed(track_class, cls._ROUGHNESS, band), band=band)

    def _formula(self, n: FloatArray) -> FloatArray:
        b, c = self._CORNERS
        return self.roughness * c**2 * (n**2 + b**2) / (n**4 * (n**2 + c**2))

    def _integral(self, low: float, high: FloatArray) -> FloatArray:
        b, c = self._CORNERS
        # Partial fractions: c² (n² + b²)/(n⁴ (n² + c²)) = (1 − b²/c²)(1/n² − 1/(n² + c²)) + b²/n⁴.
        simple = (1 - (b / c) ** 2) * (1 / low - 1 / high - _lorentzian(c, low, high))
        return self.roughness * (simple + b**2 / 3 * (low**-3 - high**-3))


@dataclass(frozen=True, slots=True)
class GermanTrack(BandLimited):
    """Vertical profile of German high-speed track, S(Ω) = A_v Ω_c²/((Ω² + Ω_r²)(Ω² + Ω_c²)).

    Over wavenumber in rad/m, one-sided, Ω_r = 0.0206 and Ω_c = 0.8246 rad/m.

    Parameters
    ----------
    roughness : float
        A_v [m² rad/m].
    band : tuple of float
        Lowest and highest spatial frequency with content [cycle/m]; by default waves of 3 to 150 m.

    Raises
    ------
    ValueError
        If the roughness is not positive, or the band is not two increasing positive frequencies.

    Notes
    -----
    The values were found alike in several open programs. A further one states the spectra of ERRI B176,
    one-sided, as b₀/(Ω⁴ + a₂Ω² + a₀) with b₀ = 2.741619e-7 and 7.343623e-7, a₂ = 0.6803895, a₀ = 2.8855e-4: the
    same numbers, which confirms values, unit and side at once. The usual forms differ in the band.

    References
    ----------
    H. Claus, W. Schiehlen: Modeling and simulation of railway bogie structural vibrations. Vehicle
    System Dynamics 29 Suppl. (1998) 538–552. ORE/ERRI B176: Bogies with steered or steering wheelsets (1989).

    Examples
    --------
    >>> GermanTrack.of_class("low").density(np.array([0.1])).round(9).tolist()
    [4.056e-06]
    """

    # Corners [rad/m], and level → A_v [m² rad/m].
    _CORNERS: ClassVar[tuple[float, float]] = (0.0206, 0.8246)
    _ROUGHNESS: ClassVar[Mapping[str, float]] = {"low": 4.032e-7, "high": 10.80e-7}

    roughness: float
    _: KW_ONLY
    band: tuple[float, float] = (1 / 150, 1 / 3)

    def __post_init__(self) -> None:
        """Check the parameters."""
        _check_and_store(self, self.roughness, "m² rad/m", self.band)

    def __str__(self) -> str:
        """Say which spectrum it is, in words."""
        return f"German track, A_v {self.roughness:g} m² rad/m, {band_in_words(self.band)}"

    @classmethod
    def of_class(cls, track_class: str, *, band: tuple[float, float] = (1 / 150, 1 / 3)) -> GermanTrack:
        """Track with little or with much irregularity.

        Parameters
        ----------
        track_class : str
            "low" or "high": how irregular the track is.
        band : tuple of float
            Lowest and highest spatial frequency with content [cycle/m].

        Returns
        -------
        GermanTrack
            The spectrum.

        Raises
        ------
        ValueError
            If there is no such level.
        """
        return cls(roughness=_listed(track_class, cls._ROUGHNESS, band), band=band)

    @property
    def _corners(self) -> tuple[float, float]:
        return self._CORNERS[0] / (2 * np.pi), self._CORNERS[1] / (2 * np.pi)

    def _formula(self, n: FloatArray) -> FloatArray:
        r, c = self._corners
        return self.roughness / (2 * np.pi) * c**2 / ((n**2 + r**2) * (n**2 + c**2))

    def _integral(self, low: float, high: FloatArray) -> FloatArray:
        r, c = self._corners
        scale = self.roughness / (2 * np.pi) * c**2 / (c**2 - r**2)
        return scale * (_lorentzian(r, low, high) - _lorentzian(c, low, high))


@dataclass(frozen=True, slots=True)
class SncfTrack(BandLimited):
    """Vertical profile of French track, S(n) = A/(1 + n/n₀)³ with n₀ = 0.0489 cycle/m.

    Parameters
    ----------
    roughness : float
        A [m³].
    band : tuple of float
        Lowest and highest spatial frequency with content [cycle/m]; by default waves of 2 to 40 m.

    Raises
    ------
    ValueError
        If the roughness is not positive, or the band is not two increasing positive frequencies.

    Notes
    -----
    The values were found in one open program, which quotes a thesis; they are the least certain of this
    module. n₀ is 2πn₀ = 0.307 rad/m in the form that other texts give. A is taken per cycle per metre: good track
    then deviates by 1.3 mm (root mean square, waves of 2 to 40 m), as much as `GermanTrack` within the band that
    they share; per rad/m it would be 3.2 mm.

    References
    ----------
    A. R. B. Berawi: Improving railway track maintenance using power spectral density. Thesis, University of Porto,
    2013.

    Examples
    --------
    >>> SncfTrack.of_class("good").density(np.array([0.1])).round(9).tolist()
    [5.553e-06]
    """

    # Corner [cycle/m], and quality → A [m³].
    _CORNER: ClassVar[float] = 0.0489
    _ROUGHNESS: ClassVar[Mapping[str, float]] = {"good": 308e-6 * 0.509, "poor": 308e-6 * 1.790}

    roughness: float
    _: KW_ONLY
    band: tuple[float, float] = (1 / 40, 1 / 2)

    def __post_init__(self) -> None:
        """Check the parameters."""
        _check_and_store(self, self.roughness, "m³", self.band)

    def __str__(self) -> str:
        """Say which spectrum it is, in words."""
        return f"SNCF track, A {self.roughness:g} m³, {band_in_words(self.band)}"

    @classmethod
    def of_class(cls, track_class: str, *, band: tuple[float, float] = (1 / 40, 1 / 2)) -> SncfTrack:
        """Good or poor track.

        Parameters
        ----------
        track_class : str
            "good" or "poor".
        band : tuple of float
            Lowest and highest spatial frequency with content [cycle/m].

        Returns
        -------
        SncfTrack
            The spectrum.

        Raises
        ------
        ValueError
            If there is no such quality.
        """
        return cls(roughness=_listed(track_class, cls._ROUGHNESS, band), band=band)

    def _formula(self, n: FloatArray) -> FloatArray:
        return self.roughness / (1 + n / self._CORNER) ** 3

    def _integral(self, low: float, high: FloatArray) -> FloatArray:
        scale = self.roughness * self._CORNER / 2
        return scale * ((1 + low / self._CORNER) ** -2 - (1 + high / self._CORNER) ** -2)


@dataclass(frozen=True, slots=True, kw_only=True)
class ChineseBallastlessTrack(BandLimited):
    """Vertical profile of Chinese ballastless high-speed track, S(n) = A/n^p in four pieces.

    Over cycles per metre, one-sided, A in mm² at the source.

    Parameters
    ----------
    band : tuple of float
        Lowest and highest spatial frequency with content [cycle/m]; by default waves of 2 to 200 m.

    Raises
    ------
    ValueError
        If the band is not two increasing positive frequencies.

    Notes
    -----
    The twelve numbers and their unit were found alike in three open programs. The pieces meet at their breakpoints
    within 0.4 %, which no misprint would survive. That they are the standard's mean spectrum, not that of a
    percentile, is recalled and not checked.

    References
    ----------
    TB/T 3352-2014: PSD of ballastless track irregularities of high-speed railway (in Chinese).

    Examples
    --------
    >>> ChineseBallastlessTrack().density(np.array([0.1])).round(10).tolist()
    [4.577e-07]
    """

    # Breakpoints [cycle/m], and of each piece A/n^p the A [m² (cycle/m)^(p−1)], published in mm², and the exponent
    # p.
    _BREAKS: ClassVar[FloatArray] = np.array([0.0187, 0.0474, 0.1533])
    _SCALES: ClassVar[FloatArray] = np.array([1.0544e-5, 3.5588e-3, 1.9784e-2, 3.9488e-4]) * 1e-6
    _EXPONENTS: ClassVar[FloatArray] = np.array([3.3891, 1.9271, 1.3643, 3.4516])

    band: tuple[float, float] = (1 / 200, 1 / 2)

    def __post_init__(self) -> None:
        """Check the parameters."""
        _check_and_store(self, 1.0, "1", self.band)

    def __str__(self) -> str:
        """Say which spectrum it is, in words."""
        return f"Chinese ballastless track, {band_in_words(self.band)}"

    def _formula(self, n: FloatArray) -> FloatArray:
        piece = np.searchsorted(self._BREAKS, n, side="right")
        return self._SCALES[piece] * n ** -self._EXPONENTS[piece]

    def _integral(self, low: float, high: FloatArray) -> FloatArray:
        pieces = np.array([0.0, *self._BREAKS]), np.array([*self._BREAKS, np.inf])
        first, last = (np.clip(np.asarray(n)[..., None], *pieces) for n in (low, high))
        return np.sum(power_integral(self._SCALES, self._EXPONENTS, first, last), axis=-1)


def _lorentzian(corner: float, low: float, high: FloatArray) -> FloatArray:
    """∫ dn/(n² + corner²) from `low` to `high`."""
    return (np.arctan(high / corner) - np.arctan(low / corner)) / corner


def _check_and_store(spectrum: BandLimited, roughness: float, unit: str, band: tuple[float, float]) -> None:
    with checking(spectrum) as check:
        check.positive("roughness", roughness, unit)
        checked_band(check, band)


def _listed(track_class: int | str, values: Mapping[Any, float], band: tuple[float, float]) -> float:
    """Roughness of a class that a table lists; a wrong band is reported together with a wrong class."""
    track_class = plain(track_class)
    if isinstance(track_class, str):
        track_class = spelt(track_class, [one for one in values if isinstance(one, str)]) or track_class
    known = (
        not isinstance(track_class, (bool, float)) and isinstance(track_class, Hashable) and track_class in values
    )
    with checking() as check:
        if not known:
            check.refuse("track_class", f"must be one of {', '.join(map(str, values))}, got {shown(track_class)}")
        checked_band(check, band)
    return values[track_class]

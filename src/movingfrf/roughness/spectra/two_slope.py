"""The road spectrum of two slopes, one-sided over spatial frequency in cycles per metre."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import checking
from movingfrf.roughness.spectra.spectrum import (
    BandLimited,
    band_in_words,
    check_waviness,
    checked_band,
    power_integral,
)

# Spatial frequency at which the slopes meet, one radian per metre [cycle/m].
MEETING = 1 / (2 * np.pi)


class RoadType(NamedTuple):
    """Mean exponents of a type of road, and the roughness of its classes at the geometric centre [m³]."""

    waviness: tuple[float, float]
    roughness: Mapping[str, float]


@dataclass(frozen=True, slots=True)
class TwoSlopeRoad(BandLimited):
    """Road spectrum of two slopes, G_d(n) = G_d(n₀) (n/n₀)^−w with n₀ = 1/(2π) cycle/m: w₁ up to n₀, w₂ beyond.

    Parameters
    ----------
    roughness : float
        Displacement spectral density G_d(n₀) [m³].
    waviness : tuple of float
        Exponent w₁ of waves longer than 2π m, and exponent w₂ of shorter ones.
    band : tuple of float
        Lowest and highest spatial frequency with content [cycle/m].

    Raises
    ------
    ValueError
        If the roughness is not positive, an exponent is beyond ±10, or the band is not two increasing positive
        frequencies.

    Notes
    -----
    Classes span a factor of four each; their roughness and exponents are those that the literature quotes from the
    paper, which itself was not at hand. The default exponents are those of the drafts of ISO 8608 of that time.

    References
    ----------
    C. J. Dodds, J. D. Robson, The description of road surface roughness, Journal of Sound and Vibration 31 (1973)
    175-183.

    Examples
    --------
    >>> TwoSlopeRoad.of_class("good motorway").roughness
    1.6e-05
    >>> round(TwoSlopeRoad(roughness=16e-6).variance_below(np.array(10.0)).item(), 9)
    4.2432e-05
    """

    # Type of road → exponents, and quality → roughness.
    _TYPES: ClassVar[Mapping[str, RoadType]] = {
        "motorway": RoadType((1.945, 1.360), {"very good": 4e-6, "good": 16e-6}),
        "principal road": RoadType(
            (2.05, 1.440), {"very good": 4e-6, "good": 16e-6, "average": 64e-6, "poor": 256e-6}
        ),
        "minor road": RoadType((2.28, 1.428), {"average": 64e-6, "poor": 256e-6, "very poor": 1024e-6}),
    }

    roughness: float
    _: KW_ONLY
    waviness: tuple[float, float] = (2.0, 1.5)
    band: tuple[float, float] = (0.01, 10.0)

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking(self) as check:
            check.positive("roughness", self.roughness, "m³")
            waviness = check.pair("waviness", self.waviness, "1", signed=True)
            if not check.faults:
                for exponent in waviness:
                    check_waviness(check, exponent)
                check.keep("waviness", waviness)
            checked_band(check, self.band)

    def __str__(self) -> str:
        """Say which spectrum it is, in words."""
        return (
            f"two slopes, {self.roughness:g} m³ at 1/(2π) cycle/m, waviness {self.waviness[0]:g} below and "
            f"{self.waviness[1]:g} above, {band_in_words(self.band)}"
        )

    @classmethod
    def of_class(
        cls,
        road_class: str,
        *,
        waviness: tuple[float, float] | None = None,
        band: tuple[float, float] = (0.01, 10.0),
    ) -> TwoSlopeRoad:
        """Road of a type and quality, at the geometric centre of its class.

        Parameters
        ----------
        road_class : str
            "very good" or "good motorway"; "very good", "good", "average" or "poor principal road"; "average",
            "poor" or "very poor minor road".
        waviness : tuple of float, optional
            Exponent w₁ and exponent w₂; the means of that type of road by default.
        band : tuple of float
            Lowest and highest spatial frequency with content [cycle/m].

        Returns
        -------
        TwoSlopeRoad
            The spectrum.

        Raises
        ------
        ValueError
            If there is no such class.
        """
        known = {
            f"{quality} {name}": (roughness, kind.waviness)
            for name, kind in cls._TYPES.items()
            for quality, roughness in kind.roughness.items()
        }
        with checking() as check:
            road_class = check.choice("road_class", road_class, known)
            checked_band(check, band)
        roughness, usual = known[road_class]
        return cls(roughness=roughness, waviness=usual if waviness is None else waviness, band=band)

    def _formula(self, n: FloatArray) -> FloatArray:
        long, short = self.waviness
        return self.roughness * (n / MEETING) ** -np.where(n <= MEETING, long, short)

    def _integral(self, low: float, high: FloatArray) -> FloatArray:
        long, short = (
            power_integral(self.roughness * MEETING**exponent, exponent, place(low, MEETING), place(high, MEETING))
            for exponent, place in zip(self.waviness, (np.minimum, np.maximum), strict=True)
        )
        return long + short

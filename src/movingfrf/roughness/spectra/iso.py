"""The spectra and classes of ISO 8608, one-sided over spatial frequency in cycles per metre."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import checking
from movingfrf.roughness.spectra.spectrum import (
    BandLimited,
    band_in_words,
    check_waviness,
    checked_band,
    power_integral,
)

# Spatial frequency at which ISO 8608 states the roughness [cycle/m].
REFERENCE_FREQUENCY = 0.1

# Geometric class centres of ISO 8608 at 0.1 cycle/m [m³]; the limits between classes are twice these.
CLASS_CENTRES = {letter: 16e-6 * 4.0**n for n, letter in enumerate("ABCDEFGH")}


@dataclass(frozen=True, slots=True)
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
    >>> import numpy as np
    >>> IsoRoad.of_class("A").roughness
    1.6e-05
    >>> IsoRoad(roughness=16e-6).density(np.array([0.1, 1.0])).tolist()
    [1.6e-05, 1.6e-07]
    """

    roughness: float
    _: KW_ONLY
    waviness: float = 2.0
    band: tuple[float, float] = (0.01, 10.0)

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking(self) as check:
            check.positive("roughness", self.roughness, "m³")
            check_waviness(check, self.waviness)
            checked_band(check, self.band)

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
            road_class = check.choice("road_class", road_class, CLASS_CENTRES)
            check_waviness(check, waviness)
            checked_band(check, band)
        return cls(roughness=CLASS_CENTRES[road_class], waviness=waviness, band=band)

    def _formula(self, n: FloatArray) -> FloatArray:
        return self.roughness * (n / REFERENCE_FREQUENCY) ** -self.waviness

    def _integral(self, low: float, high: FloatArray) -> FloatArray:
        return power_integral(self.roughness * REFERENCE_FREQUENCY**self.waviness, self.waviness, low, high)


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

"""The straight line in logarithms that ISO 8608 fits to the spectrum of a profile."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf.roughness.spectra.iso import CLASS_CENTRES, REFERENCE_FREQUENCY, iso_class
from movingfrf.roughness.spectra.spectrum import band_in_words

# Bands in which ISO 8608 smooths a spectrum [cycle/m]: octaves up to a centre of 1/32, thirds of octaves up to 1/4,
# twelfths beyond, over the range that it fits, 0.011 to 2.83.
SMOOTHING_EDGES = np.concatenate(
    [2.0 ** np.array([-6.5, -5.5]), 2.0 ** (np.arange(-27, -9, 2) / 6), 2.0 ** (np.arange(-42, 37, 2) / 24)]
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Fit:
    """What tunes where a spectrum has content and is a power law; in brackets, between what each number is safe.

    Content ends where several bands in a row lie far below the line through those before: through a decade of them,
    without the last half octave, in which a spline or a filter begins to fall. It ends with the last band that lies
    little below the line. A band of one line estimated from eight half-overlapping pieces scatters by a third.
    Heights below the line, and what it leaves, are differences of the natural logarithm of the density.
    """

    in_a_row: int = 3  # bands [2 to 5]
    cliff: float = float(np.log(4.0))  # below a quarter of the line [log 3.5 to log 8]
    kept: float = float(np.log(1.5))  # above two thirds of the line [log 1.1 to log 1.6]
    before: float = float(np.log(10.0))  # length of the line, in the logarithm of the frequency [log 5 to log 10]
    shoulder: float = float(np.log(2.0)) / 2  # length left out before the end, likewise [0.25 to 0.4]
    fewest_bands: int = 6  # bands that a line begins with [5 to 10]
    least_octaves: int = 2  # that a fit takes [a convention]
    reach: float = 2.0  # ratio, within which it reaches 0.1 cycle/m: an octave [a convention]
    # Root mean square of what the line leaves, beyond which a spectrum is no power law.
    largest_misfit: float = float(np.log(1.8))  # [log 1.7 to log 2.2]


FIT = Fit()


class IsoFit(NamedTuple):
    """A power law fitted to an estimated spectrum, as ISO 8608 does it, or the reason why there is none.

    Parameters
    ----------
    roughness : float
        Density at 0.1 cycle/m [m³]; nan without a fit.
    waviness : float
        Exponent w, dimensionless; nan without a fit.
    roughness_at_two : float
        Density at 0.1 cycle/m of the fit with the waviness 2 of the standard [m³]; nan without a fit.
    band : tuple of float
        Spatial frequencies between which the profile has content and was fitted [cycle/m].
    reason : str
        Why there is no fit; empty where there is one.
    """

    roughness: float
    waviness: float
    roughness_at_two: float
    band: tuple[float, float]
    reason: str

    @property
    def road_class(self) -> str:
        """Class of ISO 8608, that of the waviness 2; empty without a fit."""
        return "" if self.reason else iso_class(self.roughness_at_two)

    @property
    def doubt(self) -> str:
        """Why the class means little: the waviness is so far from 2 that the line passes another; or nothing."""
        to_the_next = np.log(CLASS_CENTRES["B"] / CLASS_CENTRES["A"])
        if self.reason or abs(np.log(self.roughness / self.roughness_at_two)) < to_the_next:
            return ""
        return (
            f"the class is of little meaning: the waviness, {self.waviness:.2f}, is so far from the 2 of ISO 8608 "
            f"that the fitted line passes 0.1 cycle/m in class {iso_class(self.roughness)}"
        )

    @property
    def covered(self) -> str:
        """The band, in words."""
        return _in_words(self.band)

    def density(self, spatial_frequency: FloatArray) -> FloatArray:
        """Density of the fitted line.

        Parameters
        ----------
        spatial_frequency : ndarray
            Spatial frequency [cycle/m].

        Returns
        -------
        ndarray
            G_d [m³].
        """
        fitted: FloatArray = self.roughness * (spatial_frequency / REFERENCE_FREQUENCY) ** -self.waviness
        return fitted


def fit_iso(spatial_frequency: FloatArray, density: FloatArray) -> IsoFit:
    """Fit roughness and waviness to an estimated spectrum, as ISO 8608 does, where the profile has content.

    The mean density of each band of `SMOOTHING_EDGES` enters a straight line in logarithms, over the part of 0.011
    to 2.83 cycle/m that the estimate covers and in which there is content: a profile that was filtered, resampled
    to a shorter step, or made from a spectrum with a narrower band has less of it.

    Parameters
    ----------
    spatial_frequency : ndarray
        Spatial frequency [cycle/m].
    density : ndarray
        Spectral density [m³].

    Returns
    -------
    IsoFit
        The fit, or the reason why there is none: content that does not reach 0.1 cycle/m, or a spectrum that is no
        power law.
    """
    band = np.digitize(spatial_frequency, SMOOTHING_EDGES)
    used = [b for b in range(1, SMOOTHING_EDGES.size) if (band == b).any() and density[band == b].mean() > 0]
    if len(used) < FIT.fewest_bands:
        return _none(
            (np.nan, np.nan),
            "the profile is level or straight but for rounding, or too short for a spectrum between 0.011 and "
            "2.83 cycle/m",
        )
    log_n = np.array([np.log(spatial_frequency[band == b]).mean() for b in used])
    log_density = np.array([np.log(density[band == b].mean()) for b in used])
    first, end = _content(log_n, log_density)
    log_n, log_density = log_n[first:end], log_density[first:end]
    inside = np.isin(band, used[first:end])
    covered = (float(spatial_frequency[inside].min()), float(spatial_frequency[inside].max()))
    near = covered[0] <= FIT.reach * REFERENCE_FREQUENCY and covered[1] >= REFERENCE_FREQUENCY / FIT.reach
    if not near or covered[1] < 2**FIT.least_octaves * covered[0]:
        need = f"{FIT.least_octaves} octaves that reach to within one of {REFERENCE_FREQUENCY} cycle/m"
        return _none(covered, f"a fit takes {need}, and there is content over {_in_words(covered)} alone")
    log_n -= np.log(REFERENCE_FREQUENCY)
    slope, level = np.polyfit(log_n, log_density, 1)
    if np.sqrt(np.mean((log_density - level - slope * log_n) ** 2)) > FIT.largest_misfit:
        return _none(covered, f"over {_in_words(covered)} the spectrum is no power law")
    at_two = float(np.exp((log_density + 2 * log_n).mean()))
    return IsoFit(float(np.exp(level)), float(-slope), at_two, covered, "")


def _in_words(band: tuple[float, float]) -> str:
    return band_in_words((float(f"{band[0]:.2g}"), float(f"{band[1]:.3g}")))


def _none(band: tuple[float, float], reason: str) -> IsoFit:
    return IsoFit(np.nan, np.nan, np.nan, band, reason)


def _content(log_n: FloatArray, log_density: FloatArray) -> tuple[int, int]:
    """Find the bands in which there is content: the first, and the one after the last."""
    # Bands that surely have content: the highest spectrum of the slope, which is level on a usual road.
    sloping = np.convolve(log_density + 2 * log_n, np.ones(FIT.fewest_bands), "valid")
    start = int(sloping.argmax())
    end = start + _until_cliff(log_n[start:], log_density[start:])
    return end - _until_cliff(-log_n[:end][::-1], log_density[:end][::-1]), end


def _until_cliff(place: FloatArray, height: FloatArray) -> int:
    """Count the points before those that fall far below the line of the ones before them."""
    fewest, in_a_row = FIT.fewest_bands, FIT.in_a_row
    for end in range(fewest, place.size):
        last = max(int(np.searchsorted(place, place[end - 1] - FIT.shoulder)), fewest)
        near = slice(min(int(np.searchsorted(place, place[last - 1] - FIT.before)), last - fewest), last)
        slope, level = np.polyfit(place[near], height[near], 1)
        below = level + slope * place - height
        # Long waves end where the density falls towards them: many roads have less of them than the line has.
        beyond = max(slope, 0.0) * (place[end : end + in_a_row] - place[end - 1])
        if (below[end : end + in_a_row] - beyond > FIT.cliff).all():
            return int(np.flatnonzero(below[:end] < FIT.kept)[-1]) + 1
    return place.size

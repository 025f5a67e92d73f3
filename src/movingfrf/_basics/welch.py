"""The one estimate of a spectrum: Welch's method with Hann windows that overlap by half."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from movingfrf._basics.arrays import FloatArray


@dataclass(frozen=True, slots=True, kw_only=True)
class Estimate:
    """How finely a record is cut for its spectrum; in brackets, between what each number is safe.

    More and shorter segments scatter less and resolve less.
    """

    segments: int = 8  # half-overlapping segments of a record, at the least [a convention]
    longest_segment: float = 10.0  # of a record over time [s]: resolves 0.1 Hz [a convention]
    # Of an elevation over distance [m]: at 0.01 cycle/m it resolves the longest waves of ISO 8608 twice over.
    longest_stretch: float = 250.0  # [a convention]
    fewest_samples: int = 32  # of a record, and of a segment [a convention]
    # Below this share of its size a variation is rounding: of a sum of thousands of terms 1e-13 of it, and forces
    # that vary by a millionth of a static load are results.
    rounding: float = 1e-9  # [1e-12 to 1e-7]


ESTIMATE = Estimate()

# Below this elevation a road is flat [m]: elevations of a kilometre are rounded to 1e-13 m, and the smoothest rails
# are rough by some 1e-8 m [1e-12 to 1e-9].
FLAT = 1e-12


def spectral_density(values: FloatArray, time_step: float) -> tuple[FloatArray, FloatArray]:
    """Estimate a one-sided power spectral density (Welch, Hann window, half overlap, means removed).

    Parameters
    ----------
    values : ndarray, shape (time,)
        Record, in any unit.
    time_step : float
        Step of the record [s].

    Returns
    -------
    frequency : ndarray
        Frequency [Hz], without zero; empty where the record is constant or has a few samples only.
    density : ndarray
        Power spectral density [unit²/Hz].

    Examples
    --------
    >>> time = np.arange(20_000) * 1e-3
    >>> frequency, density = spectral_density(3.0 * np.sin(2 * np.pi * 5.0 * time), 1e-3)
    >>> variance = density.sum() * (frequency[1] - frequency[0])
    >>> round(float(variance), 2), round(float(frequency[density.argmax()]), 1)
    (4.5, 5.0)
    """
    fewest = ESTIMATE.fewest_samples
    if len(values) < fewest or np.ptp(values) <= ESTIMATE.rounding * np.abs(values).max():
        return np.empty(0), np.empty(0)
    longest = max(int(ESTIMATE.longest_segment / time_step), fewest)
    length = min(max(_length(values, ESTIMATE.segments), fewest), longest)
    return _estimated(values, time_step, length, detrend="constant", left_out=1)


def welch(
    elevation: FloatArray, step: float, *, segments: int = ESTIMATE.segments
) -> tuple[FloatArray, FloatArray]:
    """Estimate the one-sided spectrum of a uniformly sampled profile (Welch, Hann window, half overlap).

    Parameters
    ----------
    elevation : ndarray, shape (distance,)
        Elevation [m].
    step : float
        Distance between samples [m].
    segments : int
        Number of half-overlapping segments that the profile is cut into; each is freed of its linear trend.

    Returns
    -------
    spatial_frequency : ndarray
        Spatial frequency [cycle/m], without the lowest three lines: trend and window have taken from them.
    density : ndarray
        Spectral density [m³].
    """
    return _estimated(elevation, step, max(_length(elevation, segments), 8), detrend="linear", left_out=3)


def _length(values: FloatArray, segments: int) -> int:
    """Tell the samples in each of so many half-overlapping segments."""
    return 2 * len(values) // (segments + 1)


def _estimated(
    values: FloatArray, step: float, length: int, *, detrend: Literal["constant", "linear"], left_out: int
) -> tuple[FloatArray, FloatArray]:
    """Estimate a spectrum from segments of a length, each freed of mean or trend; the lowest lines are left out."""
    from scipy.signal import welch as scipy_welch

    frequency, density = scipy_welch(values, 1 / step, nperseg=min(length, len(values)), detrend=detrend)
    return frequency[left_out:], density[left_out:]

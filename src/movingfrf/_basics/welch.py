"""The one estimate of a spectrum: Welch's method with Hann windows that overlap by half."""

from __future__ import annotations

import numpy as np

from movingfrf._basics.arrays import FloatArray

# Welch's method: half-overlapping segments of a record, and the longest segment [s] and [m]. The longest ones
# resolve 0.1 Hz and, at 0.01 cycle/m, the longest waves of ISO 8608 twice over.
SEGMENTS, LONGEST_SEGMENT, LONGEST_STRETCH = 8, 10.0, 250.0
FEWEST_SAMPLES = 32

# Below this share of its size a variation is rounding, below this elevation [m] a road is flat.
ROUNDING, FLAT = 1e-9, 1e-12


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
    from scipy.signal import welch as scipy_welch

    count = len(values)
    if count < FEWEST_SAMPLES or np.ptp(values) <= ROUNDING * np.abs(values).max():
        return np.empty(0), np.empty(0)
    longest = max(int(LONGEST_SEGMENT / time_step), FEWEST_SAMPLES)
    length = min(max(2 * count // (SEGMENTS + 1), FEWEST_SAMPLES), longest, count)
    frequency, density = scipy_welch(values, 1 / time_step, nperseg=length)
    return frequency[1:], density[1:]


def welch(elevation: FloatArray, step: float, *, segments: int = 8) -> tuple[FloatArray, FloatArray]:
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
    from scipy.signal import welch as scipy_welch

    length = max(2 * len(elevation) // (segments + 1), 8)
    n, density = scipy_welch(elevation, 1 / step, nperseg=min(length, len(elevation)), detrend="linear")
    return n[3:], density[3:]

"""The one estimate of a spectrum: Welch's method with Hann windows that overlap by half."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import ComplexArray, FloatArray


@dataclass(frozen=True, slots=True, kw_only=True)
class Estimate:
    """How finely a record is cut for its spectrum; in brackets, between what each number is safe.

    More and shorter segments scatter less and resolve less.
    """

    segments: int = 8  # half-overlapping segments of a record, at the least [a convention]
    longest_segment: float = 10.0  # of a record over time [s]: resolves 0.1 Hz [a convention]
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
    length = min(max(_length(len(values), ESTIMATE.segments), fewest), longest)
    frequency, density, _ = _estimated(values[:, None], time_step, length, trend=False, left_out=1)
    return frequency, density[:, 0]


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
    spatial_frequency, density, _ = cross_spectra(elevation[:, None], step, segments=segments)
    return spatial_frequency, density[:, 0]


class Spectra(NamedTuple):
    """One-sided spectra of columns, and between the first and the last."""

    frequency: FloatArray  # (line,) [cycle/m], or [Hz] of a record over time
    own: FloatArray  # (line, column) [m³]
    both: ComplexArray  # (line,) [m³]


def cross_spectra(columns: FloatArray, step: float, *, segments: int) -> Spectra:
    """Estimate the one-sided spectra of the paths of a profile as `welch` does, and that between the outermost.

    Parameters
    ----------
    columns : ndarray, shape (distance, path)
        Elevation [m].
    step : float
        Distance between samples [m].
    segments : int
        Number of half-overlapping segments, each freed of its linear trend.

    Returns
    -------
    Spectra
        Without the lowest three lines.
    """
    return _estimated(columns, step, max(_length(len(columns), segments), 8), trend=True, left_out=3)


def _length(samples: int, segments: int) -> int:
    """Tell the samples in each of so many half-overlapping segments."""
    return 2 * samples // (segments + 1)


def _estimated(columns: FloatArray, step: float, length: int, *, trend: bool, left_out: int) -> Spectra:
    """Estimate spectra from segments of a length, each freed of its mean and, if asked, its trend.

    The lowest lines are left out. All columns in one pass, a segment at a time: a profile of 500 km is long, and
    copies of it are not needed.
    """
    from scipy.fft import rfft

    samples = len(columns)
    length = min(length, samples)
    window = 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(length) / length)
    ramp = np.arange(length) - (length - 1) / 2
    starts = np.arange(0, samples - length + 1, length - length // 2)
    own: FloatArray = np.zeros((length // 2 + 1, columns.shape[1]))
    both: ComplexArray = np.zeros(length // 2 + 1, complex)
    for start in starts:
        piece = columns[start : start + length] - columns[start : start + length].mean(axis=0)
        if trend:
            piece -= np.outer(ramp, ramp @ piece / (ramp @ ramp))
        lines = rfft(piece * window[:, None], axis=0)
        own += lines.real**2 + lines.imag**2
        both += lines[:, 0].conj() * lines[:, -1]
    scale = 2 * step / (window @ window) / len(starts)
    if length % 2 == 0:  # the last line has no partner at a negative frequency
        own[-1], both[-1] = own[-1] / 2, both[-1] / 2
    frequency = np.arange(length // 2 + 1) / (length * step)
    return Spectra(frequency[left_out:], scale * own[left_out:], scale * both[left_out:])

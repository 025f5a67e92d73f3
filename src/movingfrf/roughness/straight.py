"""Straight lines in elevations: the mean slope, and paths of which nothing but rounding is left beside it."""

from __future__ import annotations

import numpy as np

from movingfrf._basics.arrays import BoolArray, FloatArray
from movingfrf._basics.welch import FLAT

# Resolutions of instruments and file formats that are looked for [m].
RESOLUTIONS = (1e-2, 1e-3, 5e-4, 2.5e-4, 1e-4, 1e-5, 1e-6)


def resolution(elevation: FloatArray) -> float:
    """Find what all elevations are a multiple of.

    Parameters
    ----------
    elevation : ndarray, shape (distance,)
        Elevations [m].

    Returns
    -------
    float
        Resolution [m]; 0 if nothing that is usual.
    """
    # So many stations are looked at [1000 and more].
    elevation = elevation[:20_000]
    for usual in RESOLUTIONS:
        counts = (elevation - elevation[0]) / usual
        # Rounding of the numbers themselves, which may be hundreds of metres.
        slack = 1e-3 + 4 * np.spacing(np.abs(elevation).max()) / usual
        if np.round(counts).any() and np.abs(counts - np.round(counts)).max() < slack < 0.1:
            return usual
    return 0.0


def mean_slope(stations: FloatArray, columns: FloatArray) -> FloatArray:
    """Slope of the straight line that fits each path best.

    Parameters
    ----------
    stations : ndarray, shape (distance,)
        Stations [m].
    columns : ndarray, shape (distance, path)
        Elevations [m].

    Returns
    -------
    ndarray, shape (path,)
        Rise per distance [m/m], positive uphill.
    """
    along = stations - stations.mean()
    slope: FloatArray = along @ (columns - columns.mean(axis=0)) / (along @ along)
    return slope


def straight(stations: FloatArray, columns: FloatArray) -> BoolArray:
    """Tell which paths are straight lines, level or sloping, but for the rounding of their numbers.

    Parameters
    ----------
    stations : ndarray, shape (distance,)
        Stations [m].
    columns : ndarray, shape (distance, path)
        Elevations [m].

    Returns
    -------
    ndarray of bool, shape (path,)
        Whether nothing is left beside the line that fits best but what the last digit of a file, of single or of
        double precision does.
    """
    line = np.outer(stations - stations.mean(), mean_slope(stations, columns))
    left = np.ptp(columns - columns.mean(axis=0) - line, axis=0)
    return np.array([most <= _rounding(column) for most, column in zip(left, columns.T, strict=True)])


def _rounding(elevation: FloatArray) -> float:
    """How far apart two elevations of a straight line may lie by rounding [m]."""
    largest = float(np.abs(elevation).max())
    single = np.float32(largest) if (elevation.astype(np.float32) == elevation).all() else np.float32(0.0)
    # Twice the last digit that is written; of double precision, in which they were computed, a few digits more.
    return max(2 * resolution(elevation), 2 * float(np.spacing(single)), 16 * float(np.spacing(largest)), FLAT)

"""Spectra of elevations: of the paths of a profile, and of what a contact saw of one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from movingfrf._basics.arrays import BoolArray, FloatArray
from movingfrf._basics.welch import ESTIMATE, Spectra, cross_spectra, welch
from movingfrf.results.labels import kind_of, time_step_of
from movingfrf.roughness.straight import straight

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True, slots=True, kw_only=True)
class Pieces:
    """Half-overlapping pieces of an elevation for Welch's method; in brackets, between what each number is safe."""

    # [a convention: with 6 or 12 a road near the limit of a class changes over].
    fewest: int = ESTIMATE.segments
    # Length of the longest one of a profile [m]. Three lines of its spectrum make the lowest wave, so that the
    # longest wave that ISO 8608 fits, 91 m, is within reach [280 to 1000].
    longest: float = 400.0
    # The same of what a contact saw [m]: it resolves the longest waves of ISO 8608 twice over [a convention].
    longest_seen: float = 250.0


PIECES = Pieces()


def path_spectra(columns: FloatArray, step: float, rough: BoolArray) -> Spectra:
    """Estimate the spectra of all paths of a profile, and that between the first and the last.

    Parameters
    ----------
    columns : ndarray, shape (distance, path)
        Elevation [m].
    step : float
        Distance between stations [m].
    rough : ndarray of bool, shape (path,)
        Which paths are more than straight lines; the others have rounding for a spectrum.

    Returns
    -------
    Spectra
        Spatial frequency [cycle/m] and densities [m³]; zero of straight lines.
    """
    found = cross_spectra(columns, step, segments=_pieces(len(columns) * step, PIECES.longest))
    return found._replace(own=found.own * rough, both=found.both * rough[[0, -1]].all())


def elevation_spectrum(result: xr.Dataset, contact: int) -> tuple[FloatArray, FloatArray]:
    """Estimate the one-sided spectrum of the elevation that a contact saw.

    Parameters
    ----------
    result : xarray.Dataset
        What `simulate` returned, or `random_response`, where the spectrum is known.
    contact : int
        Number of the contact.

    Returns
    -------
    spatial_frequency : ndarray
        Spatial frequency [cycle/m]; empty on a flat or straight road or a record of a few samples.
    density : ndarray
        Spectral density [m³].
    """
    if kind_of(result) == "random":
        speed, density = result.attrs["speed"], result.roughness_density.values[:, contact]
        return result.frequency.values / speed, speed * density
    elevation = result.roughness.values[:, contact]
    step = result.attrs["speed"] * time_step_of(result)
    few = len(elevation) < ESTIMATE.fewest_samples
    if few or straight(step * np.arange(len(elevation)), elevation[:, None]).all():
        return np.empty(0), np.empty(0)
    return welch(elevation, step, segments=_pieces(len(elevation) * step, PIECES.longest_seen))


def _pieces(length: float, longest: float) -> int:
    """How many pieces a length is cut into."""
    return max(PIECES.fewest, int(2 * length / longest))

"""Road profiles: from arrays, from a spectrum, harmonic, bump."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np
import scipy.fft
from numpy.typing import ArrayLike

from movingfrf._checks import FloatArray, checking, require_memory
from movingfrf.smooth import smooth_step

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

# Bytes per sample that a realisation takes at its peak.
BYTES_PER_SAMPLE = 64


@dataclass(frozen=True, slots=True, eq=False)
class Profile:
    """Elevation of a road over distance; between its samples a cubic spline.

    Parameters
    ----------
    distance : array_like, shape (distance,)
        Stations along the road [m], increasing; at least four.
    elevation : array_like, shape (distance,) or (distance, path)
        Elevation [m], positive up: the same for all paths, or one column for each.

    Raises
    ------
    ValueError
        If stations do not increase, values are not finite, or shapes disagree.

    Examples
    --------
    >>> Profile([0.0, 1.0, 2.0, 3.0], [0.0, 0.01, 0.0, -0.01]).paths
    1
    """

    distance: ArrayLike
    elevation: ArrayLike

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking() as check:
            distance = check.array("distance", self.distance, "m", (None,))
            paths = 1 if np.ndim(self.elevation) < 2 else None
            shape = (None, None) if paths is None else (None,)
            elevation = check.array("elevation", self.elevation, "m", shape)
            if not check.faults:
                if distance.size < 4:
                    check.refuse("distance", f"must have at least 4 stations, got {distance.size}")
                if distance.size != len(elevation):
                    check.refuse(
                        "elevation",
                        f"must have {distance.size} values, one per station, got {len(elevation)}",
                    )
                falls = np.flatnonzero(np.diff(distance) <= 0)
                if falls.size:
                    n = int(falls[0])
                    check.refuse(
                        "distance",
                        f"must increase, got {distance[n]:g} m followed by {distance[n + 1]:g} m at index {n + 1}",
                    )
        object.__setattr__(self, "distance", distance)
        object.__setattr__(self, "elevation", elevation)

    @property
    def stations(self) -> FloatArray:
        """Stations [m], shape (distance,)."""
        return np.asarray(self.distance, float)

    @property
    def paths(self) -> int:
        """Number of paths."""
        elevation = np.asarray(self.elevation)
        return 1 if elevation.ndim == 1 else elevation.shape[1]

    @property
    def same_across(self) -> bool:
        """Whether all paths have the same elevation: there are no columns."""
        return np.ndim(self.elevation) == 1

    def along(self, path: int = 0) -> CubicSpline:
        """Elevation of one path as a function of distance: the cubic spline through its samples.

        Parameters
        ----------
        path : int
            Number of the path.

        Returns
        -------
        scipy.interpolate.CubicSpline
            Callable with any array of distances [m] on the profile; gives elevations [m].
        """
        from scipy.interpolate import CubicSpline

        elevation = np.asarray(self.elevation)
        return CubicSpline(self.stations, elevation if elevation.ndim == 1 else elevation[:, path])


class Spectrum(Protocol):
    """A roughness spectrum: how much elevation lies at which spatial frequency."""

    @property
    def band(self) -> tuple[float, float]:
        """Spatial frequencies between which there is content [cycle/m]."""
        ...

    def variance_below(self, spatial_frequency: FloatArray) -> FloatArray:
        """Variance of the elevation up to a spatial frequency [m²]."""
        ...


def realise(
    spectrum: Spectrum,
    *,
    length: float,
    step: float = 0.05,
    seed: int | Sequence[int] = 0,
    start: float = 0.0,
) -> Profile:
    """One road of many: a profile with the given spectrum and random phases.

    A sum of harmonics over the band whose variances are exactly those of the spectrum, one per frequency line,
    so that every seed gives a road of the same roughness. It repeats itself after `length` or after two of its
    longest waves, whichever is longer.

    Parameters
    ----------
    spectrum : IsoRoad or any Spectrum
        One-sided spectrum of the elevation.
    length : float
        Length of the profile [m].
    step : float
        Distance between stations [m]; at most half of the shortest wave.
    seed : int or sequence of int
        Seed of the phases: the same seed gives the same road. Several: one path each; equal seeds give equal paths,
        different ones paths without anything in common.
    start : float
        First station [m].

    Returns
    -------
    Profile
        With stations from `start` to at least `start + length`.

    Raises
    ------
    ValueError
        If a length is not positive, the step is too coarse for the band, or there is no seed.

    Examples
    --------
    >>> from movingfrf.roughness.spectra import IsoRoad
    >>> road = realise(IsoRoad.of_class("A"), length=100.0, seed=1)
    >>> road.stations[-1].item()
    100.0
    """
    with checking() as check:
        check.positive("length", length, "m")
        check.positive("step", step, "m")
        several = isinstance(seed, (list, tuple))
        seeds = [check.whole("seed", number) for number in (seed if isinstance(seed, (list, tuple)) else [seed])]
        if not seeds:
            check.refuse("seed", "must be a whole number, or one for each path, got an empty list")
        check.finite("start", start, "m")
        if not check.faults and step * spectrum.band[1] > 0.5 * (1 + 1e-9):
            check.refuse(
                "step",
                f"must be at most {0.5 / spectrum.band[1]:g} m, half of the shortest wave of the spectrum "
                f"({spectrum.band[1]:g} cycle/m), got {step:g} m",
            )
    count = int(np.ceil(length / step - 1e-9)) + 1
    period = max(count, int(np.ceil(2 / (spectrum.band[0] * step))), 8)
    require_memory(BYTES_PER_SAMPLE * period, f"a profile of {length:g} m in steps of {step:g} m")
    period = scipy.fft.next_fast_len(period, real=True)
    edges = (np.arange(period // 2 + 2) - 0.5) / (period * step)
    variance = np.diff(spectrum.variance_below(np.maximum(edges, 0.0)))
    elevations = []
    for number in seeds:
        phase = np.random.default_rng(number).uniform(0.0, 2 * np.pi, variance.size)
        # A real harmonic of variance σ² has the amplitude √2 σ, half of it at the positive frequency.
        harmonics = np.sqrt(variance / 2) * np.exp(1j * phase) * period
        elevations.append(scipy.fft.irfft(harmonics, period)[:count])
    return Profile(start + step * np.arange(count), np.stack(elevations, axis=1) if several else elevations[0])


def harmonic(
    *, amplitude: float, wavelength: float, length: float, phase: float = 0.0, start: float = 0.0
) -> Profile:
    """One sine wave, sampled fifty times per wave.

    Parameters
    ----------
    amplitude : float
        Half of the height from trough to crest [m].
    wavelength : float
        Length of the wave [m].
    length : float
        Length of the profile [m].
    phase : float
        Phase at distance 0 [rad].
    start : float
        First station [m].

    Returns
    -------
    Profile
        Elevation amplitude · sin(2π x/wavelength + phase).

    Raises
    ------
    ValueError
        If amplitude, wavelength or length is not positive.
    """
    with checking() as check:
        check.positive("amplitude", amplitude, "m")
        check.positive("wavelength", wavelength, "m")
        check.positive("length", length, "m")
        check.finite("phase", phase, "rad")
        check.finite("start", start, "m")
    distance = _stations(start, length, wavelength / 50)
    return Profile(distance, amplitude * np.sin(2 * np.pi * distance / wavelength + phase))


def bump(*, height: float, width: float, at: float, length: float, start: float = 0.0) -> Profile:
    """One smooth hump (or dip, if the height is negative) on a flat road.

    Parameters
    ----------
    height : float
        Elevation of its top [m].
    width : float
        Distance over which it rises and falls [m].
    at : float
        Distance at which it begins [m].
    length : float
        Length of the profile [m].
    start : float
        First station [m].

    Returns
    -------
    Profile
        A quintic rise over half of the width and its mirror image.

    Raises
    ------
    ValueError
        If the height is zero, or the width or the length is not positive.
    """
    with checking() as check:
        if check.finite("height", height, "m") == 0:
            check.refuse("height", "must not be zero")
        check.positive("width", width, "m")
        check.positive("length", length, "m")
        check.finite("at", at, "m")
        check.finite("start", start, "m")
    distance = _stations(start, length, width / 100)
    return Profile(distance, height * smooth_step(2 * (0.5 - np.abs((distance - at) / width - 0.5))))


def _stations(start: float, length: float, step: float) -> FloatArray:
    count = max(int(np.ceil(length / step - 1e-9)) + 1, 4)
    require_memory(BYTES_PER_SAMPLE * count, f"a profile of {length:g} m in steps of {step:g} m")
    return start + step * np.arange(count)

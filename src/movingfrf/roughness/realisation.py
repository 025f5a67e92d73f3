"""Roads with a prescribed spectrum: one of many, Gaussian or not, on one path or several of one surface."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
import scipy.fft
from numpy.typing import ArrayLike

from movingfrf._basics.arrays import ComplexArray, FloatArray, require_memory
from movingfrf._basics.checks import Checks, checking, shown
from movingfrf.roughness.profile import Profile
from movingfrf.roughness.spectra.coherence import Coherence, presumed
from movingfrf.roughness.spectra.spectrum import Spectrum

# Draws lines of unit variance for a number of paths, shape (path, frequency), given the period in samples.
Draw = Callable[[np.random.Generator, int, int], ComplexArray]


def realise(
    spectrum: Spectrum,
    *,
    length: float,
    step: float = 0.05,
    seed: int | Sequence[int] = 0,
    start: float = 0.0,
    across: ArrayLike | None = None,
    coherence: Coherence | None = None,
) -> Profile:
    """One road of many: a profile with the given spectrum and random phases.

    A sum of harmonics over the band whose variances are exactly those of the spectrum, one per frequency line,
    so that every seed gives a road of the same roughness. It repeats itself after `length` or after two of its
    longest waves, whichever is longer.

    Parameters
    ----------
    spectrum : Spectrum
        One-sided spectrum of the elevation: `IsoRoad`, `FraTrack` or any other.
    length : float
        Length of the profile [m].
    step : float
        Distance between stations [m]; at most half of the shortest wave.
    seed : int or sequence of int
        Seed of the phases: the same seed gives the same road. Several: one path each; equal seeds give equal paths,
        different ones paths without anything in common.
    start : float
        First station [m].
    across : array_like, shape (path,), optional
        Lateral positions of the paths [m], to the left: paths of one surface, which have their long waves in
        common. The first is the path that the seed gives by itself; the others have the spectrum in expectation,
        since their lines are sums of independent parts.
    coherence : Coherence, optional
        What the paths have in common; for an `IsoRoad` that of an isotropic surface by default.

    Returns
    -------
    Profile
        With stations from `start` to at least `start + length`.

    Raises
    ------
    ValueError
        If a length is not positive, the step is too coarse for the band, there is no seed, or the coherence of
        several paths is not known or none that paths can have.

    References
    ----------
    M. Shinozuka, C.-M. Jan: Digital simulation of random processes and its applications. Journal of Sound and
    Vibration 25 (1972) 111–128.

    Examples
    --------
    >>> import movingfrf as mf
    >>> road = realise(mf.IsoRoad.of_class("A"), length=100.0, seed=1)
    >>> road.stations[-1].item()
    100.0
    >>> realise(mf.IsoRoad.of_class("A"), length=100.0, seed=1, across=[0.75, -0.75]).paths
    2
    """
    with checking() as check:
        ask = _asked(check, spectrum, length, step, seed, start, across, coherence)
    return _realised(ask, _phases, f"{spectrum}, seed {ask.said_seed}")


def realise_laplace(
    spectrum: Spectrum,
    *,
    kurtosis: float,
    segment: float,
    length: float,
    step: float = 0.05,
    seed: int | Sequence[int] = 0,
    start: float = 0.0,
    across: ArrayLike | None = None,
    coherence: Coherence | None = None,
) -> Profile:
    """One road of many whose roughness varies along the way: quiet stretches, and rough ones.

    White noise whose variance changes from segment to segment, filtered to the spectrum. The variances are
    independent, gamma distributed with mean 1 and variance ν = kurtosis/3 − 1, which gives the noise a generalised
    Laplace distribution of the stated kurtosis. Segments much longer than the waves of interest make a road that is
    Gaussian locally and changes its class; segments of one step make a Laplace moving average, whose roughness
    comes in spikes. The spectrum is the prescribed one in expectation; a single road has more of it, or less.

    The elevation of a road with short segments is nearer to Gaussian than its noise: the filter adds up many
    segments. For the weights f_j of the filter its excess kurtosis is 3ν Σ_segments (Σ f_j²)²/(Σ f_j²)².

    Parameters
    ----------
    spectrum : Spectrum
        One-sided spectrum of the elevation, in expectation.
    kurtosis : float
        Kurtosis of the noise, a ratio above 3, that of a Gaussian road; 6 for Laplace's own distribution.
    segment : float
        Length over which the variance stays the same [m], at least a step: 100 to 200 for roads that change their
        condition, a few metres for local damage.
    length : float
        Length of the profile [m].
    step : float
        Distance between stations [m]; at most half of the shortest wave.
    seed : int or sequence of int
        Seed of variances and noise: the same seed gives the same road. Several: one path each.
    start : float
        First station [m].
    across : array_like, shape (path,), optional
        Lateral positions of the paths [m], to the left: paths of one surface, rough in the same places.
    coherence : Coherence, optional
        What the paths have in common; for an `IsoRoad` that of an isotropic surface by default.

    Returns
    -------
    Profile
        With stations from `start` to at least `start + length`.

    Raises
    ------
    ValueError
        If the kurtosis is not above 3, the segment is shorter than a step, or `realise` would refuse.

    References
    ----------
    K. Bogsjö, K. Podgórski, I. Rychlik: Models for road surface roughness. Vehicle System Dynamics 50
    (2012) 725–747. P. Johannesson, K. Podgórski, I. Rychlik: Laplace distribution models for road topography and
    roughness. International Journal of Vehicle Performance 3 (2017) 224–258.

    Examples
    --------
    >>> import movingfrf as mf
    >>> road = realise_laplace(mf.IsoRoad.of_class("C"), kurtosis=9.0, segment=100.0, length=1000.0, seed=1)
    >>> road.stations[-1].item()
    1000.0
    """
    with checking() as check:
        ask = _asked(check, spectrum, length, step, seed, start, across, coherence)
        # Nearer to a Gaussian road the gamma distribution has no meaningful shape.
        kurtosis = check.finite("kurtosis", kurtosis, "1")
        if kurtosis / 3 - 1 < 1e-9:
            check.refuse("kurtosis", f"must be above 3, the kurtosis of a Gaussian road, got {kurtosis!r}")
        segment = check.positive("segment", segment, "m")
        if segment < ask.step:
            check.refuse("segment", f"must be at least one step of {ask.step:g} m, got {segment:g} m")

    def draw(rng: np.random.Generator, paths: int, period: int) -> ComplexArray:
        spread = kurtosis / 3 - 1
        place = np.floor(np.arange(period) * (ask.step / segment) * (1 + 1e-12)).astype(int)
        deviation = np.sqrt(rng.gamma(1 / spread, spread, place[-1] + 1))[place]
        noise = rng.standard_normal((paths, period)) * deviation
        return scipy.fft.rfft(noise) / np.sqrt(period)

    laplace = f"Laplace road of kurtosis {kurtosis:g} over segments of {segment:g} m"
    return _realised(ask, draw, f"{laplace}, {spectrum}, seed {ask.said_seed}")


class _Asked(NamedTuple):
    """What both kinds of realisation are asked for, checked."""

    spectrum: Spectrum
    length: float
    step: float
    start: float
    seeds: list[int]
    in_columns: bool
    across: FloatArray | None
    coherence: Coherence | None

    @property
    def said_seed(self) -> int | list[int]:
        """The seeds as they were given: one alone, or a list."""
        return self.seeds if self.in_columns and self.across is None else self.seeds[0]


def _asked(
    check: Checks,
    spectrum: Spectrum,
    length: float,
    step: float,
    seed: int | Sequence[int],
    start: float,
    across: ArrayLike | None,
    coherence: Coherence | None,
) -> _Asked:
    if not hasattr(spectrum, "variance_below"):
        check.refuse("spectrum", f"must be a spectrum, IsoRoad or another, got {shown(spectrum)}")
    length = check.positive("length", length, "m")
    step = check.positive("step", step, "m")
    several = isinstance(seed, (list, tuple))
    seeds = [check.whole("seed", number) for number in (seed if isinstance(seed, (list, tuple)) else [seed])]
    if not seeds:
        check.refuse("seed", "must be a whole number, or one for each path, got an empty list")
    start = check.finite("start", start, "m")
    if not check.faults and step * spectrum.band[1] > 0.5 * (1 + 1e-9):
        check.refuse(
            "step",
            f"must be at most {0.5 / spectrum.band[1]:g} m, half of the shortest wave of the spectrum "
            f"({spectrum.band[1]:g} cycle/m), got {step:g} m",
        )
    if across is None:
        if coherence is not None:
            check.refuse("coherence", "is of use only with `across`, the lateral positions of the paths [m]")
        return _Asked(spectrum, length, step, start, seeds, several, None, None)
    at = check.array("across", across, "m", (None,))
    if not at.size:
        check.refuse("across", "must hold the lateral position [m] of at least one path")
    if several:
        check.refuse("seed", f"must be one whole number where `across` makes the paths, got {seed!r}")
    coherence = coherence if coherence is not None else presumed(spectrum)
    if coherence is None:
        check.refuse("coherence", "is needed: what paths of this spectrum have in common is not known")
    return _Asked(spectrum, length, step, start, seeds, True, at, coherence)


def _realised(ask: _Asked, draw: Draw, source: str) -> Profile:
    """Give drawn lines the variances of the spectrum, and to several paths what they have in common."""
    spectrum, length, step, start, seeds, in_columns, across, coherence = ask
    count = int(np.ceil(length / step - 1e-9)) + 1
    period = max(count, int(np.ceil(2 / (spectrum.band[0] * step))), 8)
    paths = 1 if across is None else across.size
    # Bytes that a realisation takes at its peak.
    needed = 64 * period * (max(paths, len(seeds)) + paths**2 / 8)
    require_memory(needed, f"a profile of {length:g} m in steps of {step:g} m")
    period = scipy.fft.next_fast_len(period, real=True)
    edges = (np.arange(period // 2 + 2) - 0.5) / (period * step)
    variance = np.diff(spectrum.variance_below(np.maximum(edges, 0.0)))
    elevations = []
    for number in seeds:
        lines = draw(np.random.default_rng(number), paths, period)
        if across is not None and coherence is not None:
            frequency = np.arange(variance.size) / (period * step)
            lines = np.einsum("fij,jf->if", _factors(coherence, frequency, across), lines)
        # A real harmonic of variance σ² has the amplitude √2 σ, half of it at the positive frequency.
        harmonics = np.sqrt(variance / 2) * lines * period
        elevations.extend(scipy.fft.irfft(harmonics, period)[:, :count])
    return Profile(
        start + step * np.arange(count),
        np.stack(elevations, axis=1) if in_columns else elevations[0],
        source=source,
        across=None if across is None else tuple(across.tolist()),
    )


def _phases(rng: np.random.Generator, paths: int, period: int) -> ComplexArray:
    """Lines of fixed amplitude and random phase."""
    return np.exp(1j * rng.uniform(0.0, 2 * np.pi, (paths, period // 2 + 1)))


def _factors(coherence: Coherence, frequency: FloatArray, across: FloatArray) -> FloatArray:
    """Lower triangular factors of the coherence matrices, shape (frequency, path, path).

    Cholesky's, so that the first path is the first line drawn. Long waves are all but the same on all paths, and
    their matrices singular to rounding; a path that adds nothing to those before it gets no part of its own.
    """
    # Below it a pivot is rounding. Of a coherence known to 1e-15 a pivot p is known to 1e-15/p of itself, and so is
    # what it passes on to later paths; the path loses √p of its size. What is then left in its column is at most √p
    # as well, if the matrix is one of coherences [1e-11 to 1e-8].
    smallest_pivot, largest_rest = 1e-10, 1e-4
    matrix = coherence.between(frequency, across[:, None] - across)
    factor = np.zeros_like(matrix)
    for j in range(across.size):
        rest = matrix[:, j:, j] - np.einsum("fik,fk->fi", factor[:, j:, :j], factor[:, j, :j])
        own = rest[:, :1] > smallest_pivot
        if np.abs(np.where(own, 0.0, rest)).max() > largest_rest:
            raise ValueError(
                f"coherence must be positive semidefinite over the paths at {', '.join(f'{y:g}' for y in across)} m"
            )
        factor[:, j:, j] = np.where(own, rest / np.sqrt(np.where(own, rest[:, :1], 1.0)), 0.0)
    return factor

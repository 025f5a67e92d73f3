"""Roads with a prescribed spectrum: one of many, Gaussian or not, on one path or several of one surface."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
import scipy.fft
from numpy.typing import ArrayLike

from movingfrf._basics.arrays import ComplexArray, FloatArray, IntArray, require_memory
from movingfrf._basics.checks import Checks, checking, shown
from movingfrf._basics.wording import told_apart
from movingfrf.roughness.profile import SLACK, Profile
from movingfrf.roughness.spectra.coherence import Coherence, presumed
from movingfrf.roughness.spectra.spectrum import Spectrum, is_spectrum


class Harmonics(NamedTuple):
    """The harmonics of which a road consists: they follow from its length and band alone, not from stations."""

    halves: int  # halves of the shortest wave in a period, an even number
    period: float  # [m]
    first: int  # waves in a period, of the longest within the band
    last: int  # of the shortest

    @classmethod
    def of(cls, band: tuple[float, float], length: float) -> Harmonics:
        """Find the harmonics of a road of some length [m]."""
        half = 0.5 / band[1]
        least = max(int(np.ceil(length / half * (1 - SLACK))) + 1, int(np.ceil(2 / (band[0] * half))))
        # Rounded up to six binary digits: a fast length for transforms, the same where lengths differ by little.
        unit = 2 ** max(least.bit_length() - 6, 1)
        halves = -(-least // unit) * unit
        period = halves * half
        # The shortest wave of the band is one of them, so that no band is too narrow for a line.
        return cls(halves, period, int(np.ceil(band[0] * period * (1 - SLACK))), halves // 2)

    @property
    def numbers(self) -> IntArray:
        """Waves in a period of each, shape (line,)."""
        return np.arange(self.first, self.last + 1)

    def variances(self, spectrum: Spectrum) -> FloatArray:
        """Variance of each [m²], together that of the band."""
        edges = (self.numbers[:-1] + 0.5) / self.period
        return np.diff(spectrum.variance_below(np.array([spectrum.band[0], *edges, spectrum.band[1]])))


# Draws lines of unit variance for a number of paths, shape (path, line).
Draw = Callable[[np.random.Generator, int, Harmonics], ComplexArray]


def realise(
    spectrum: Spectrum,
    length: float,
    *,
    step: float | None = None,
    seed: int | Sequence[int] = 0,
    start: float = 0.0,
    covering: tuple[float, float] | None = None,
    across: ArrayLike | None = None,
    coherence: Coherence | None = None,
) -> Profile:
    """One road of many: a profile with the given spectrum and random phases.

    A sum of harmonics over the band whose variances are exactly those of the spectrum, one per frequency line,
    so that every seed gives a road of the same roughness. It repeats itself after somewhat more than `length`, or
    after two of its longest waves, whichever is longer. Seed, spectrum and length make the road; the step only says
    where its elevation is told.

    Parameters
    ----------
    spectrum : Spectrum
        One-sided spectrum of the elevation: `IsoRoad`, `FraTrack` or any other.
    length : float
        Length of the road [m].
    step : float, optional
        Distance between stations [m], at most half of the shortest wave; by default a sixteenth, which leaves
        little for the spline between stations to miss. The road is the same at any step.
    seed : int or sequence of int
        Seed of the phases: the same seed gives the same road. Several: one path each; equal seeds give equal paths,
        different ones paths without anything in common.
    start : float
        Where the road begins [m].
    covering : tuple of float, optional
        First and last distance that the stations cover [m], `start` and `start + length` by default. Beyond these
        the same road goes on.
    across : array_like, shape (path,), optional
        Lateral positions of the paths [m], to the left: paths of one surface, which have their long waves in
        common. The first is the path that the seed gives by itself; the others have the spectrum in expectation,
        since their lines are sums of independent parts.
    coherence : Coherence, optional
        What the paths have in common; for an `IsoRoad` that of an isotropic surface by default.

    Returns
    -------
    Profile
        With stations at whole steps from `start`, from `start` to at least `start + length` or as far as `covering`
        says.

    Raises
    ------
    ValueError
        If a length is not positive, the step is too coarse for the band, `covering` is no interval, there is no
        seed, or the coherence of several paths is not known or none that paths can have.

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
        ask = _asked(check, spectrum, length, step, seed, start, covering, across, coherence)
    return _realised(ask, _phases, f"{spectrum}, seed {ask.said_seed}")


def realise_laplace(
    spectrum: Spectrum,
    *,
    kurtosis: float,
    segment: float,
    length: float,
    step: float | None = None,
    seed: int | Sequence[int] = 0,
    start: float = 0.0,
    covering: tuple[float, float] | None = None,
    across: ArrayLike | None = None,
    coherence: Coherence | None = None,
) -> Profile:
    """One road of many whose roughness varies along the way: quiet stretches, and rough ones.

    White noise whose variance changes from segment to segment, filtered to the spectrum. The variances are
    independent, gamma distributed with mean 1 and variance ν = kurtosis/3 − 1, which gives the noise a generalised
    Laplace distribution of the stated kurtosis. Segments much longer than the waves of interest make a road that is
    Gaussian locally and changes its class; the shortest ones make a Laplace moving average, whose roughness comes
    in spikes. The spectrum is the prescribed one in expectation; a single road has more of it, or less. The noise
    has a value every half of the shortest wave, wherever the stations lie: as for `realise`, the road is the same
    at any step.

    The elevation of a road with short segments is nearer to Gaussian than its noise: the filter adds up many
    segments. For the weights f_j of the filter its excess kurtosis is 3ν Σ_segments (Σ f_j²)²/(Σ f_j²)².

    Parameters
    ----------
    spectrum : Spectrum
        One-sided spectrum of the elevation, in expectation.
    kurtosis : float
        Kurtosis of the noise, a ratio above 3, that of a Gaussian road; 6 for Laplace's own distribution.
    segment : float
        Length over which the variance stays the same [m], at least half of the shortest wave: 100 to 200 for roads
        that change their condition, a few metres for local damage.
    length : float
        Length of the road [m].
    step : float, optional
        Distance between stations [m], at most half of the shortest wave; by default a sixteenth, which leaves
        little for the spline between stations to miss. The road is the same at any step.
    seed : int or sequence of int
        Seed of variances and noise: the same seed gives the same road. Several: one path each.
    start : float
        Where the road begins [m].
    covering : tuple of float, optional
        First and last distance that the stations cover [m], `start` and `start + length` by default. Beyond these
        the same road goes on.
    across : array_like, shape (path,), optional
        Lateral positions of the paths [m], to the left: paths of one surface, rough in the same places.
    coherence : Coherence, optional
        What the paths have in common; for an `IsoRoad` that of an isotropic surface by default.

    Returns
    -------
    Profile
        With stations at whole steps from `start`, from `start` to at least `start + length` or as far as `covering`
        says.

    Raises
    ------
    ValueError
        If the kurtosis is not above 3, the segment is shorter than half of the shortest wave, or `realise` would
        refuse.

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
        ask = _asked(check, spectrum, length, step, seed, start, covering, across, coherence)
        # Nearer to a Gaussian road the gamma distribution has no meaningful shape.
        kurtosis = check.finite("kurtosis", kurtosis, "1")
        if kurtosis / 3 - 1 < 1e-9:
            check.refuse("kurtosis", f"must be above 3, the kurtosis of a Gaussian road, got {kurtosis!r}")
        segment = check.positive("segment", segment, "m")
        if not check.faults and segment < (half := 0.5 / spectrum.band[1]) * (1 - SLACK):
            least, got = told_apart(half, segment)
            check.refuse(
                "segment", f"must be at least half of the shortest wave of the spectrum, {least} m, got {got} m"
            )

    def draw(rng: np.random.Generator, paths: int, harmonics: Harmonics) -> ComplexArray:
        spread = kurtosis / 3 - 1
        count = harmonics.halves
        place = np.floor(np.arange(count) * (harmonics.period / count / segment) * (1 + 1e-12)).astype(int)
        deviation = np.sqrt(rng.gamma(1 / spread, spread, place[-1] + 1))[place]
        noise = rng.standard_normal((paths, count)) * deviation
        return scipy.fft.rfft(noise)[:, harmonics.numbers] / np.sqrt(count)

    laplace = f"Laplace road of kurtosis {kurtosis:g} over segments of {segment:g} m"
    return _realised(ask, draw, f"{laplace}, {spectrum}, seed {ask.said_seed}")


class _Asked(NamedTuple):
    """What both kinds of realisation are asked for, checked."""

    spectrum: Spectrum
    length: float
    step: float
    start: float
    covering: tuple[float, float]
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
    step: float | None,
    seed: int | Sequence[int],
    start: float,
    covering: tuple[float, float] | None,
    across: ArrayLike | None,
    coherence: Coherence | None,
) -> _Asked:
    # Sixteen stations to the shortest wave: the images of the spline between them are next to nothing.
    sixteenth = 0.0625 / spectrum.band[1] if is_spectrum(check, spectrum) else 1.0
    length = check.positive("length", length, "m")
    step = check.positive("step", sixteenth if step is None else step, "m")
    several = isinstance(seed, (list, tuple))
    seeds = [check.whole("seed", number) for number in (seed if isinstance(seed, (list, tuple)) else [seed])]
    if not seeds:
        check.refuse("seed", "must be a whole number, or one for each path, got an empty list")
    start = check.finite("start", start, "m")
    first, last = (start, start + length) if covering is None else check.array("covering", covering, "m", (2,))
    if not check.faults and not first < last:
        check.refuse("covering", f"must be a first and a last distance [m], got {shown(covering)}")
    if not check.faults and step * spectrum.band[1] > 0.5 * (1 + SLACK):
        most, got = told_apart(0.5 / spectrum.band[1], step)
        check.refuse(
            "step",
            f"must be at most {most} m, half of the shortest wave of the spectrum ({spectrum.band[1]:g} cycle/m), "
            f"got {got} m",
        )
    where = (float(first), float(last))
    if across is None:
        if coherence is not None:
            check.refuse("coherence", "is of use only with `across`, the lateral positions of the paths [m]")
        return _Asked(spectrum, length, step, start, where, seeds, several, None, None)
    at = check.array("across", across, "m", (None,))
    if not at.size:
        check.refuse("across", "must hold the lateral position [m] of at least one path")
    if several:
        check.refuse("seed", f"must be one whole number where `across` makes the paths, got {seed!r}")
    coherence = coherence if coherence is not None else presumed(spectrum)
    if coherence is None:
        check.refuse("coherence", "is needed: what paths of this spectrum have in common is not known")
    return _Asked(spectrum, length, step, start, where, seeds, True, at, coherence)


def _realised(ask: _Asked, draw: Draw, source: str) -> Profile:
    """Give drawn lines the variances of the spectrum, and to several paths what they have in common."""
    spectrum, start, step, across, coherence = ask.spectrum, ask.start, ask.step, ask.across, ask.coherence
    # Stations at whole steps from the start, those that just cover the interval.
    first, last = (np.array(ask.covering) - start) / step
    first, last = np.floor(first + SLACK), np.ceil(last - SLACK)
    harmonics = Harmonics.of(spectrum.band, ask.length)
    paths = 1 if across is None else across.size
    # Bytes that a realisation takes at its peak.
    several, count, lines = max(paths, len(ask.seeds)), last - first + 1, harmonics.last - harmonics.first + 1
    needed = 96 * (count + lines) + 16 * several * (count + 4 * lines) + 16 * paths**2 * lines
    require_memory(needed, f"a profile of {step * count:g} m in steps of {step:g} m")
    stations = np.arange(int(first), int(last) + 1)
    # A real harmonic of variance σ² has the amplitude √2 σ.
    amplitudes = np.sqrt(2 * harmonics.variances(spectrum))
    elevations = []
    for number in ask.seeds:
        drawn = draw(np.random.default_rng(number), paths, harmonics)
        if across is not None and coherence is not None:
            factors = _factors(coherence, harmonics.numbers / harmonics.period, across)
            drawn = np.einsum("fij,jf->if", factors, drawn)
        elevations += [_summed(harmonics, step, stations, amplitudes * unit) for unit in drawn]
    return Profile(
        start + step * stations,
        np.stack(elevations, axis=1) if ask.in_columns else elevations[0],
        source=source,
        across=None if across is None else tuple(across.tolist()),
    )


def _phases(rng: np.random.Generator, paths: int, harmonics: Harmonics) -> ComplexArray:
    """Lines of fixed amplitude and random phase."""
    return np.exp(1j * rng.uniform(0.0, 2 * np.pi, (paths, harmonics.numbers.size)))


def _summed(harmonics: Harmonics, step: float, stations: IntArray, lines: ComplexArray) -> FloatArray:
    """Sum of the harmonics Re Σ c_k e^{2πi k x/P} at stations x = i · step, whatever the step.

    Bluestein's transform: with 2ki = k² + i² − (i − k)² the sum over k is a convolution of chirps e^{iπ α n²},
    α = step/P, which fast transforms make. n² is a whole number, exact up to 2⁵³, so that of the angle only the
    rounding of one product is lost, 1e-16 of up to α n² turns.
    """
    k, turn = harmonics.numbers, step / harmonics.period

    def chirp(n: IntArray) -> ComplexArray:
        return np.exp(1j * np.pi * np.remainder(turn * (n * n), 2.0))

    size = scipy.fft.next_fast_len(stations.size + k.size - 1)
    between = scipy.fft.fft(chirp(np.arange(stations[0] - k[-1], stations[-1] - k[0] + 1)).conj(), size)
    convolved = scipy.fft.ifft(scipy.fft.fft(lines * chirp(k), size, overwrite_x=True) * between, overwrite_x=True)
    return (chirp(stations) * convolved[k.size - 1 : k.size - 1 + stations.size]).real


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

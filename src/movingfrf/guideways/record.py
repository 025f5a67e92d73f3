"""What samples of an impulse response show: how it begins between the first ones, what is missing after the last.

A beam with mass begins like √t, a road without mass or soft in shear with a jump, anything smeared like t: nothing
that the trapezoidal rule would know. For a term c tˢ the sum over whole steps and the integral differ by a series
that holds no more than the beginning (Euler–Maclaurin, for broken powers by Navot):

    ∫ tˢ φ(t) dt = Δt Σ_{k≥1} (kΔt)ˢ φ(kΔt) − Δt^{1+s} Σ_n ζ(−s−n) Δtⁿ φ⁽ⁿ⁾(0)/n!
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import ComplexArray, FloatArray


@dataclass(frozen=True, slots=True, kw_only=True)
class ImpulseRecord:
    """What tunes how a recorded impulse response is read; in brackets, between what each number is safe."""

    # Two speeds that differ by less than this share, of 1 m/s at least, are one.
    same_speed: float = 1e-9  # [1e-12 to 1e-6]
    # Two offsets that differ by less are one; those of a vehicle are rounded to the nanometre.
    same_place: float = 1e-6  # [m; 1e-8 to 1e-4]
    # Samples that share one exponential factor in the transform.
    block: int = 256  # [16 to 1024: time and memory only]
    # Frequencies transformed at a time: their factors stay within the processor's cache.
    together: int = 256  # [16 to 4096: time and memory only]
    # What the step or the end of a record may change is worth a word from this share of the largest moving FRF on.
    worth_a_word: float = 1e-3  # [a convention]
    # Samples after which the beginning is over; octaves from the middle of the last one to the sampling frequency.
    later: int = 16  # [8 to 64]
    octaves: float = 1.4  # [1 to 1.5]

    # How a response begins: powers of time with which it may set in from its first sample, each followed by others
    # one apart.
    powers: tuple[float, ...] = (1.0, 0.5)  # [a convention]
    terms: int = 4  # fitted to as many samples; the next one is foretold [2 to 5]
    # A beginning that misses the next sample by more than this share of the largest so far is none.
    missed: float = 0.1  # [0.05 to 0.3]
    far_better: float = 0.1  # share of the miss of another one [0.01 to 0.3]
    hidden: float = 0.05  # share of the first step by which what it hides after a jump counts [0.02 to 0.2]
    # Arguments of the series, in magnitude, and its terms; beyond, as many samples in a plain sum.
    near: float = 4.0  # [3.3 to 5]
    series: int = 70  # [60 to 150]
    samples: int = 30  # [20 to 100]
    # How it is continued: by this share of the record, its end.
    share: float = 0.5  # [0.3 to 0.7]
    order: int = 4  # samples by which the next one is foretold: two vibrations, or four that creep [2 to 6]
    per_radian: float = 2.0  # samples used to a radian of the vibration there [1 to 4]
    fewest: int = 40  # samples used, where there are as many [20 to 200]
    # Share of the largest singular value below which a sample says nothing new.
    new: float = 1e-6  # [1e-9 to 1e-4]
    lasting: float = 0.05  # share that is left of a vibration from sample to sample, if it lasts [0.01 to 0.2]
    last: int = 16  # samples from which the amplitudes at the end are taken [8 to 40]
    # A vibration is taken to fade by this share at least from sample to sample.
    fading: float = 1e-4  # [1e-6 to 1e-3]


RECORD = ImpulseRecord()


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Onset:
    """What samples of an impulse response say of its beginning: Σ_j size_j (t/Δt)^power_j, the first sample first.

    Parameters
    ----------
    powers, sizes : ndarray, shape (term, offset)
        Powers of time, and what each contributes one step after the impulse [m/(N s)].
    doubt : ndarray, shape (offset,)
        Estimated error of the integral over the response, per step [m/(N s)]; nan where no beginning was recognised
        and the first sample counts as a jump.
    """

    powers: FloatArray
    sizes: FloatArray
    doubt: FloatArray

    def transform(self, argument: ComplexArray) -> ComplexArray:
        """Return ∫ g e^{−zt/Δt} dt/Δt − Σ_{k≥1} g(kΔt) e^{−kz}, shape (argument, offset)."""
        added = np.zeros((argument.size, self.powers.shape[1]), complex)
        for power in np.unique(self.powers):
            held = (self.sizes * (self.powers == power)).sum(axis=0)
            added -= _excess(float(power), argument)[:, None] * held
        return added

    def moment(self, order: int) -> FloatArray:
        """Give the factor of φ⁽ⁿ⁾(0)/n! in the same with any weight φ for the exponential, shape (offset,)."""
        return -(self.sizes * _zeta(self.powers + order)).sum(axis=0)


def onset_of(samples: FloatArray, *, stepped: bool) -> Onset:
    """Recognise how a response begins, column by column.

    Parameters
    ----------
    samples : ndarray, shape (time, offset)
        The moving impulse response [m/(N s)], the first row at the instant of the impulse.
    stepped : bool
        Whether they were stepped through time, so that the trapezoidal rule is theirs.

    Returns
    -------
    Onset
        The beginning that foretells the next sample best; the first sample alone where none does.
    """
    terms, offsets = RECORD.terms, samples.shape[1]
    powers = np.zeros((terms + 1, offsets))
    sizes = np.zeros((terms + 1, offsets))
    sizes[0] = samples[0]
    doubt = np.full(offsets, np.nan)
    if stepped or len(samples) < terms + 2:
        return Onset(powers=powers, sizes=sizes, doubt=doubt)
    allowed = RECORD.missed * np.abs(samples[1 : terms + 2]).max(axis=0)
    for first in RECORD.powers:
        known = samples[1 : terms + 2] - samples[0]
        some, fewer = (_fitted(first, known[:count]) for count in (terms + 1, terms))
        follow = first + np.arange(terms)
        missed = np.abs((terms + 1.0) ** follow @ fewer - known[terms])
        # After a jump there is no √t, unless it foretells far better: a layer that the first step hides.
        better = missed <= np.where((first < 1) & (samples[0] != 0), RECORD.far_better, 1.0) * allowed
        allowed = np.where(better, missed, allowed)
        powers[1:, better] = follow[:, None]
        sizes[1:, better] = fewer[:, better]
        changed = np.abs(_zeta(first + np.arange(terms + 1.0)) @ (some - np.pad(fewer, ((0, 1), (0, 0)))))
        if first < 1:
            changed += RECORD.hidden * np.abs(samples[0])
        doubt = np.where(better, changed, doubt)
    return Onset(powers=powers, sizes=sizes, doubt=doubt)


def _fitted(first: float, known: FloatArray) -> FloatArray:
    """Sizes of as many powers, one apart, as there are samples after the first, shape (term, offset)."""
    count = np.arange(len(known))
    return np.linalg.solve((count[:, None] + 1.0) ** (first + count), known)


def _zeta(power: FloatArray) -> FloatArray:
    """Riemann's ζ(−s) for s ≥ 0, by its functional equation."""
    from scipy.special import gamma, zeta

    beyond = np.where(power > 0, 1 + power, 2.0)
    found = 2 * (2 * pi) ** -beyond * np.cos(0.5 * pi * beyond) * gamma(beyond) * zeta(beyond)
    return np.where(power > 0, found, -0.5)


def _excess(power: float, argument: ComplexArray) -> ComplexArray:
    """Σ_{k≥1} kˢ e^{−kz} − ∫ tˢ e^{−zt} dt = Σ_n ζ(−s−n) (−z)ⁿ/n!."""
    from scipy.special import gamma

    near = np.abs(argument) <= RECORD.near
    found = np.empty_like(argument)
    term = np.ones(int(near.sum()), complex)
    found[near] = 0.0
    for order, factor in enumerate(_zeta(power + np.arange(RECORD.series))):
        found[near] += factor * term
        term *= -argument[near] / (order + 1)
    far = argument[~near]
    count = np.arange(1.0, RECORD.samples + 1)
    found[~near] = np.exp(-far[:, None] * count) @ count**power - gamma(1 + power) / far ** (1 + power)
    return found


class Tail(NamedTuple):
    """Transform of what is missing, at rest and where it is largest."""

    at_rest: FloatArray  # (offset,) [m/N]
    largest: FloatArray  # (offset,) magnitude [m/N]
    frequency: FloatArray  # (offset,) where that is [Hz]


def tail_of(samples: FloatArray, time_step: float) -> Tail:
    """Continue a response by linear prediction, and transform what that adds.

    Parameters
    ----------
    samples : ndarray, shape (time, offset)
        The moving impulse response [m/(N s)].
    time_step : float
        Step [s].

    Returns
    -------
    Tail
        Of each column.
    """
    late = samples[-max(int(RECORD.share * len(samples)), min(len(samples), 2)) :]
    found = [_column(column, time_step) for column in late.T]
    return Tail(*(np.array(part) for part in zip(*found, strict=True)))


def _column(late: FloatArray, time_step: float) -> tuple[float, float, float]:
    size = float(np.sqrt(np.mean(late**2)))
    if not size:
        return 0.0, 0.0, 0.0
    # As many samples as the vibration needs: next to each other they would only repeat themselves.
    rate = np.sqrt(np.mean(np.diff(late) ** 2)) / size
    apart = 1 / (RECORD.per_radian * rate) if rate else np.inf
    stride = max(1, int(min(apart, late.size / RECORD.fewest)))
    used = late[::-1][::stride][::-1]
    order = min(RECORD.order, used.size // 2)
    step = stride * time_step
    # used[k] = Σ_i weights[i] used[k − 1 − i].
    rows = np.lib.stride_tricks.sliding_window_view(used[:-1], order)[:, ::-1]
    weights = np.linalg.lstsq(rows, used[order:], rcond=RECORD.new)[0]
    waves = np.roots(np.r_[1.0, -weights]).astype(complex)
    waves = waves[np.abs(waves) > RECORD.lasting]
    if not waves.size:
        return 0.0, 0.0, 0.0
    # What does not fade would never end.
    waves = waves * np.minimum(1.0, np.exp(-RECORD.fading) / np.abs(waves))
    # Amplitudes at the last sample, of the vibrations that the last samples hold.
    last = used[::-1][: RECORD.last]
    powers = waves ** -np.arange(float(last.size))[:, None]
    heights = np.abs(powers).max(axis=0)
    parts = np.linalg.lstsq(powers / heights, last.astype(complex), rcond=RECORD.new)[0] / heights
    rates = np.log(waves) / step
    at = np.r_[0.0, np.abs(rates.imag)]
    transform: ComplexArray = (parts / (1j * at[:, None] - rates)).sum(axis=1)
    largest = int(np.abs(transform).argmax())
    return float(transform[0].real), float(np.abs(transform[largest])), float(at[largest] / (2 * pi))

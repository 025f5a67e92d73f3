"""From time to complex frequency and back: sign, scale, window and padding are decided here."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate, pairwise
from typing import NamedTuple, TypeVar

import numpy as np
import scipy.fft

from movingfrf._basics.arrays import ComplexArray, FloatArray, IntArray, require_memory, squared
from movingfrf._basics.checks import checking
from movingfrf._basics.remembered import Remembering, recalled, remembered
from movingfrf._basics.smooth import memory, onward, smooth_step, smoothest_step
from movingfrf._basics.spline import cubic

Values = TypeVar("Values", FloatArray, ComplexArray)


@dataclass(frozen=True, slots=True, kw_only=True)
class Transform:
    """What tunes the transform of records to complex frequency; in brackets, between what each number is safe."""

    # What wraps around the end of the padded record comes back weaker by this factor at least; what happens at the
    # beginning and spreads in time, as rounding does, grows by the other one by the end of the record.
    wrap_around: float = 3e-6  # [1e-8 to 1e-5]
    growth: float = 3e3  # [1e2 to 5e3]
    # What a cut in frequency discards spreads over the inverse of the width of that cut: within so much of it, in
    # radians, nothing may grow by more than e.
    within: float = 0.2  # [0.05 to 0.25]
    # It rings before what was cut as well, and that comes back behind the end of the padding: so many times the
    # inverse of the width of the cut away from the record.
    rings: float = 12.0  # [8 to 20]
    # The padding is so much of a record at least, or so long: on a guideway motion may die away more slowly than it
    # would on held contacts.
    apart: float = 1 / 3  # [1/4 to 1]
    longest: float = 30.0  # [s; 10 to 300]
    # And so many times the record at most, but for the fading.
    most: float = 50.0  # [20 to 100]
    # So many rounding errors of its root mean square a spectrum is uncertain.
    noise: float = 10.0  # [3 to 30]
    # Share of a frequency over which what lies above it fades in.
    fading_in: float = 0.1  # [0.05 to 0.2]
    # An envelope is followed in so many instants per frequency.
    follows: float = 1.3  # [1.2 to 3]
    least: int = 16  # steps of padding [8 to 64]
    # Share of the padding within which a record fades out after its end; the rest is for the response to die away.
    fades: float = 0.25  # [0.15 to 0.4]
    # So many samples before the end of a record tell how it goes on.
    lately: int = 4096  # [256 to 65 536]
    # An abrupt change is taken out as a pulse whose rate of decay is this share of a step's inverse, at least so
    # many times that of the period.
    pulse: float = 0.01  # [1e-3 to 0.05]
    pulse_ends: float = 30.0  # [25 to 50]
    # An abrupt change so near to a sample, as a share of the step, falls on it; one that is so small is none.
    rounding: float = 1e-6  # [1e-9 to 1e-5]
    # Nearer to the next sample than this share of the step, an abrupt change has hardly begun to act there.
    nearest: float = 0.05  # [0.02 to 0.1]
    # Channels transformed at a time: as many as a processor's vector holds numbers, but no more numbers in all.
    together: int = 8  # [1 to 64: time only]
    numbers: int = 2**20  # [2**16 to 2**24: time and memory only]
    # Bytes per sample of the padded record and channel (a contact or a degree of freedom) at the peak of a
    # computation, measured on an hour of travel.
    bytes_per_sample: int = 60

    def rows(self, points: int) -> int:
        """How many channels of so many points are transformed at a time."""
        return max(min(self.together, self.numbers // points), 1)


TRANSFORM = Transform()


class Abrupt(NamedTuple):
    """An abrupt change of what drives a port."""

    time: float  # from when on [s]
    port: int
    jumps: FloatArray  # (3, *case): of the value, its rate and the rate of that


class Given(NamedTuple):
    """What drives a system, at the instants of a line, and where it changes abruptly."""

    values: FloatArray  # (*case, port, instant); where it changes abruptly, the value after
    abrupt: tuple[Abrupt, ...] = ()

    @property
    def begins(self) -> tuple[float, ...]:
        """From when on each part of it acts [s]: what begins at t = 0, and what later changes abruptly add."""
        return (0.0, *sorted({change.time for change in self.abrupt} - {0.0}))


class Histories(NamedTuple):
    """Records, and what of each wraps around from the end of the padding to the start."""

    values: FloatArray  # (*case, port, time)
    wrapped: FloatArray  # (*case, port)


@dataclass(frozen=True, slots=True, kw_only=True)
class Line(Remembering):
    """A record in time and the complex frequencies that stand for it.

    X(ω) = ∫ x(t) e^{−iωt} dt, evaluated along ω − iη (exponential window, Kausel and Roësset 1992). The discrete
    transform implies that all repeats itself. With η as large as the end of the record allows, a padding of 0.6 of
    the record damps that to `TRANSFORM.wrap_around`; a third where motion dies away; more beside a cut.
    What drives a system is asked for in steps of its own, finer or coarser than those of the record.

    Parameters
    ----------
    samples : int
        Samples of the record.
    time_step : float
        Step of the record [s].
    dying : float
        Rate at which the slowest motion dies away once nothing drives it [1/s]; 0 if that is not known.
    fading : float
        Time in which what drives the system fades out past the end, at least [s].
    cut : float
        Width of the narrowest band over which a spectrum of the response is cut off [Hz]; inf if none is.
    points : int, optional
        Steps of the solution per period; None: those of the record.

    Examples
    --------
    >>> line = Line(samples=1000, time_step=1e-3, points=8000)
    >>> spectrum = line.spectra(Given(np.sin(2 * np.pi * 5 * line.instants) ** 3))
    >>> bool(np.allclose(line.records(spectrum).values, np.sin(2 * np.pi * 5 * line.time) ** 3, atol=1e-6))
    True
    """

    samples: int
    time_step: float
    dying: float = 0.0
    fading: float = 0.0
    cut: float = np.inf
    points: int | None = None

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking(self) as check:
            check.whole("samples", self.samples, least=1)
            check.positive("time_step", self.time_step, "s")
            check.not_negative("dying", self.dying, "1/s")
            check.not_negative("fading", self.fading, "s")

    def solved_in(self, points: int) -> Line:
        """Take the same record, solved in so many steps per period."""
        return recalled(self, f"solved in {points}", lambda: replace(self, points=points))

    @property
    @remembered
    def decay(self) -> float:
        """Distance η of the line of evaluation from the real axis [rad/s]."""
        allowed = min(math.log(TRANSFORM.growth) / self.duration, TRANSFORM.within * 2 * math.pi * self.cut)
        return max(allowed, -math.log(TRANSFORM.wrap_around) / (TRANSFORM.most * self.duration))

    @property
    def duration(self) -> float:
        """Duration of the record [s]."""
        return self.samples * self.time_step

    @property
    @remembered
    def needed(self) -> float:
        """Time until all is over that would come back [s]: the record, the fading, and time to die away."""
        over = self.duration + self.fading
        # A record over which the window hardly falls is short, and may be small against what follows it.
        weakened = math.log(TRANSFORM.growth / TRANSFORM.wrap_around) - self.decay * self.duration
        dead = (self.dying * over + weakened) / (self.dying + self.decay)
        padding = max(
            min(TRANSFORM.apart * self.duration, TRANSFORM.longest),
            min(TRANSFORM.rings / self.cut, TRANSFORM.most * self.duration),
            TRANSFORM.least * self.time_step,
        )
        return max(min(dead, TRANSFORM.most * self.duration + self.fading), over, self.duration + padding)

    @property
    @remembered
    def padded(self) -> int:
        """Steps of the record per period: what is needed, and what makes their number factorise."""
        return int(scipy.fft.next_fast_len(math.ceil(self.needed / self.time_step), real=True))

    @property
    def period(self) -> float:
        """Duration of the padded record [s]."""
        return self.padded * self.time_step

    @property
    def solved(self) -> int:
        """Steps of the solution per period."""
        return self.padded if self.points is None else self.points

    @property
    def size(self) -> int:
        """Number of complex frequencies."""
        return self.solved // 2 + 1

    @property
    @remembered
    def told(self) -> tuple[float, ...]:
        """What a transform depends on."""
        return (self.samples, self.time_step, self.padded, self.solved, self.decay, self._faded_within)

    @property
    def time(self) -> FloatArray:
        """Times of the record [s], from zero."""
        return np.arange(self.samples) * self.time_step

    @property
    @remembered
    def _faded_within(self) -> float:
        """Time past the end of the record in which what drives the system fades out [s]."""
        padding = self.period - self.samples * self.time_step
        return min(max(TRANSFORM.fades * padding, self.fading), padding)

    @property
    def instants(self) -> FloatArray:
        """Times at which the excitation is asked for [s]: from zero until, past the end, it has faded out."""
        faded = self.samples * self.time_step + self._faded_within
        return np.arange(int(np.ceil(faded / self.period * self.solved))) * (self.period / self.solved)

    def omega(self, numbers: IntArray | slice = slice(None)) -> ComplexArray:
        """Complex angular frequencies ω − iη [rad/s]: those of the given numbers, or all."""
        step = 2 * np.pi / self.period
        if isinstance(numbers, slice):
            numbers = np.arange(*numbers.indices(self.size))
        return step * numbers - 1j * self.decay

    def given(self, records: FloatArray) -> Given:
        """Take records that are known at the steps of the record alone, and zero before their first sample.

        Parameters
        ----------
        records : ndarray, shape (*case, port, time)
            Records; between their samples cubic splines, past the last one they go on smoothly.

        Returns
        -------
        Given
            At the instants of the line.
        """
        if self.samples < 4:
            records = np.concatenate([records, np.repeat(records[..., -1:], 4 - self.samples, axis=-1)], axis=-1)
        known = np.arange(records.shape[-1]) * self.time_step
        spline, instants = cubic(known, records), self.instants
        within = int(np.searchsorted(instants, known[-1], side="right"))
        values = np.empty((*records.shape[:-1], instants.size))
        values[..., :within] = spline(instants[:within])
        latest = known[-TRANSFORM.lately :]
        length = np.clip(memory(spline(latest, 1), spline(latest, 2)), 4 * self.time_step, known[-1])
        slope, curvature = (spline(known[-1:], order) for order in (1, 2))
        after = instants[within:] - known[-1]
        values[..., within:] = records[..., -1:] + onward(after, slope, curvature, length[..., None])
        onset = np.stack([spline(0.0, order) for order in range(3)])
        # What is rounding, in the course of a step, is no change.
        size = np.abs(onset) * (self.time_step ** np.arange(3.0)).reshape(-1, *[1] * (onset.ndim - 1))
        onset[size <= TRANSFORM.rounding * np.abs(records).max(axis=-1)] = 0.0
        abrupt = (Abrupt(0.0, port, onset[..., port]) for port in range(onset.shape[-1]))
        return Given(values, tuple(change for change in abrupt if change.jumps.any()))

    def clear(self, given: Given) -> float:
        """Shortest time from an abrupt change to the next sample of the record [s]; inf if nothing changes so."""
        steps = np.array([change.time for change in given.abrupt]) / self.time_step
        gap = (np.ceil(steps) - steps)[steps < self.samples]
        gap = np.where(gap > TRANSFORM.rounding, np.maximum(gap, TRANSFORM.nearest), 1.0)
        return float(gap.min(initial=np.inf)) * self.time_step

    def spectra(self, given: Given) -> ComplexArray:
        """Transform what drives a system and is zero before t = 0.

        Past the end of the record it fades out, within the padding. Abrupt changes are exact in the spectrum where
        they are told; a jump that is not told is centred at t = 0.

        Parameters
        ----------
        given : Given
            Values at the instants of the line; not modified.

        Returns
        -------
        ndarray, shape (*case, port, frequency)
            Spectra, in the unit of the record times second.
        """
        return together(self._parts(given, (self.decay,))[0])

    def looked_at(self, given: Given) -> tuple[ComplexArray, FloatArray]:
        """Transform what drives a system, and tell how much there is of it.

        Parameters
        ----------
        given : Given
            As `spectra` takes it.

        Returns
        -------
        parts : ndarray, shape (part, *case, port, frequency)
            Its spectra part by part, see `Given.begins`.
        energy : ndarray, shape (*case, port, frequency)
            Squared magnitudes of the spectrum of it all without the window: what is early counts no more than what
            is late.
        """
        parts, whole = self._parts(given, (self.decay, 0.0))
        energy = squared(together(whole))
        # Rounding spreads over all frequencies; what lies below it is not known to be there.
        energy[energy < (TRANSFORM.noise * np.finfo(float).eps) ** 2 * energy.mean(axis=-1, keepdims=True)] = 0.0
        return parts, energy

    def _parts(self, given: Given, decays: tuple[float, ...]) -> ComplexArray:
        """Take abrupt changes out as pulses, transform the rest, and add the spectra of the pulses.

        Of each decay that the window may have: (decay, part, *case, port, frequency).
        """
        if not given.abrupt:
            return self._transformed(given.values, decays)[:, None]
        instants, rest, begins = self.instants, given.values.copy(), given.begins
        rate = max(TRANSFORM.pulse * self.solved, TRANSFORM.pulse_ends) / self.period
        pulses = [Pulse.of(change.jumps, rate) for change in given.abrupt]
        for change, pulse in zip(given.abrupt, pulses, strict=True):
            after = int(np.searchsorted(instants, change.time))
            rest[..., change.port, after:] -= pulse.values(instants[after:] - change.time)
        first = self._transformed(rest, decays)
        parts = np.zeros((len(decays), len(begins), *first.shape[1:]), complex)
        parts[:, 0] = first
        for number, decay in enumerate(decays):
            s = 1j * self.omega().real + decay
            for change, pulse in zip(given.abrupt, pulses, strict=True):
                spectrum = np.exp(-change.time * s) * pulse.spectrum(s)
                parts[number, begins.index(change.time), ..., change.port, :] += spectrum
        return parts

    def _transformed(self, values: FloatArray, decays: tuple[float, ...]) -> ComplexArray:
        """Let values fade out and transform them; (*case, port, instant) to (decay, …, frequency)."""
        known, end, step = values.shape[-1], self.samples * self.time_step, self.period / self.solved
        fading = int(np.ceil(end / step * (1.0 - TRANSFORM.rounding)))
        fade = step * (1.0 - smooth_step((step * np.arange(fading, known) - end) / self._faded_within))
        windows = [np.exp(-decay * step * np.arange(known)) if decay else None for decay in decays]
        rows = values.reshape(-1, known)
        spectra = np.empty((len(decays), len(rows), self.size), complex)
        together = max(TRANSFORM.rows(self.solved) // len(decays), 1)
        padded = np.zeros((len(decays), min(together, len(rows)), self.solved))
        for first in range(0, len(rows), together):
            some = slice(first, first + together)
            block = padded[:, : len(rows[some])]
            for window, there in zip(windows, block[..., :known], strict=True):
                np.multiply(rows[some, :fading], step, out=there[:, :fading])
                np.multiply(rows[some, fading:], fade, out=there[:, fading:])
                # A jump at t = 0 is centred there: half of its first sample lies before it.
                there[:, 0] *= 0.5
                if window is not None:
                    there *= window
            spectra[:, some] = scipy.fft.rfft(block)
        return spectra.reshape(len(decays), *values.shape[:-1], self.size)

    def records(self, spectra: ComplexArray, *, derivative: int = 0, finer: int = 1) -> Histories:
        """Transform spectra, or their derivatives in time, back to records; the inverse of `spectra`.

        Parameters
        ----------
        spectra : ndarray, shape (*case, port, frequency)
            Spectra along ω − iη; frequencies beyond the last one are zero.
        derivative : int
            Order of the derivative with respect to time.
        finer : int
            How many values there shall be for each sample of the record.

        Returns
        -------
        Histories
            Records of shape (*case, port, time), and the largest value, as it wraps around, within an eighth of the
            padding near its end.
        """
        return self.all_records([(spectra, derivative)], finer)[0]

    def all_records(self, asked: Sequence[tuple[ComplexArray, int]], finer: int = 1) -> list[Histories]:
        """Transform several spectra, each with the order of a derivative, back to records: as `records` does."""
        samples, padded, step = self.samples * finer, self.padded * finer, self.time_step / finer
        shapes = [spectra.shape[:-1] for spectra, _ in asked]
        # Of no frequencies there is nothing.
        made = [np.empty if spectra.shape[-1] else np.zeros for spectra, _ in asked]
        found = [
            Histories(make((*shape, samples)), np.zeros(shape)) for make, shape in zip(made, shapes, strict=True)
        ]
        kinds = [
            (spectra.reshape(-1, spectra.shape[-1]), derivative, values.reshape(-1, samples), wrapped.reshape(-1))
            for (spectra, derivative), (values, wrapped) in zip(asked, found, strict=True)
            if spectra.shape[-1]
        ]
        longest = max((channels.shape[-1] for channels, *_ in kinds), default=0)
        s = 1j * self.omega(slice(longest))
        factors = {derivative: s**derivative for _, derivative in asked if derivative}
        growth = np.exp(self.decay * step * np.arange(samples)) / step
        # Not at the very end of the padding, where the ripple lies that precedes a jump at t = 0.
        last = max((padded - samples) // 8, 1)
        for rows, here in in_blocks([len(channels) for channels, *_ in kinds], TRANSFORM.rows(padded)):
            block = np.zeros((rows, max(longest, padded // 2 + 1)), complex)
            for kind, some, there in here:
                channels, derivative, _, _ = kinds[kind]
                size = channels.shape[-1]
                np.multiply(
                    channels[some], factors[derivative][:size] if derivative else 1.0, out=block[there, :size]
                )
            periodic = scipy.fft.irfft(folded(block, padded), padded, overwrite_x=True)
            ends = np.abs(periodic[:, -3 * last : -2 * last]).max(axis=1) / step
            for kind, some, there in here:
                _, _, values, wrapped = kinds[kind]
                np.multiply(periodic[there, :samples], growth, out=values[some])
                wrapped[some] = ends[there]
        return found

    def from_on(self, first: int, size: int) -> FloatArray:
        """Share that counts of each of so many frequencies where those from one on do, shape (frequency,).

        What a sharp cut discards would ring on, and the window raises what comes late.
        """
        return smoothest_step((np.arange(size) - first) / max(TRANSFORM.fading_in * first, 1.0))

    def swings(self, spectra: ComplexArray, first: int, *, fading_in: bool = True) -> FloatArray:
        """Squared envelope within the record of what spectra hold from some frequency on.

        Parameters
        ----------
        spectra : ndarray, shape (*case, port, frequency)
            As `records` takes them, but for the frequencies below the first one.
        first : int
            Number of the first one.
        fading_in : bool
            Whether they fade in, as in `from_on`, or begin by themselves.

        Returns
        -------
        ndarray, shape (*case, port, instant)
            In the unit of the record squared, from the sample after zero on: what begins abruptly at t = 0 is
            everywhere before that.
        """
        above = spectra * self.from_on(first, first + spectra.shape[-1])[first:] if fading_in else spectra
        # Shifted down to zero frequency, not many more samples than there are frequencies follow it.
        samples = int(scipy.fft.next_fast_len(max(int(TRANSFORM.follows * above.shape[-1]), 16)))
        swinging = scipy.fft.ifft(above, samples)
        instants = np.arange(samples) * (self.period / samples)
        begin, end = np.searchsorted(instants, [self.time_step, self.duration]).tolist()
        within = slice(begin, max(end, begin + 1))
        size: FloatArray = squared(swinging[..., within])
        size *= np.exp(2.0 * self.decay * instants[within] + 2.0 * math.log(2 * samples / self.period))
        return size


def together(parts: Values) -> Values:
    """Sum parts, (part, …), which need no memory if there is but one."""
    whole: Values = parts[0] if len(parts) == 1 else parts.sum(axis=0)
    return whole


def in_blocks(counts: Sequence[int], together: int) -> Iterator[tuple[int, list[tuple[int, slice, slice]]]]:
    """Go through channels of several kinds, so many of each, together as many as are transformed at a time.

    Yields
    ------
    int
        Rows of a block.
    list of tuple
        Which kind, which of its channels, and which rows these are.

    Examples
    --------
    >>> for rows, parts in in_blocks([1, 3], 3):
    ...     print(rows, parts)
    3 [(0, slice(0, 1, None), slice(0, 1, None)), (1, slice(0, 2, None), slice(1, 3, None))]
    1 [(1, slice(2, 3, None), slice(0, 1, None))]
    """
    ends = list(accumulate(counts, initial=0))
    for first in range(0, ends[-1], together):
        last = min(first + together, ends[-1])
        cuts = [(max(begin, first), min(end, last), begin) for begin, end in pairwise(ends)]
        parts = [
            (kind, slice(low - begin, high - begin), slice(low - first, high - first))
            for kind, (low, high, begin) in enumerate(cuts)
            if low < high
        ]
        yield last - first, parts


def folded(spectra: ComplexArray, samples: int) -> ComplexArray:
    """Fold what a period of so many samples cannot tell from lower frequencies onto these.

    The samples are those of the whole: nothing is filtered.

    Parameters
    ----------
    spectra : ndarray, shape (row, frequency)
        Harmonics of a period.
    samples : int
        Samples of the period.

    Returns
    -------
    ndarray, shape (row, frequency)
        At most samples // 2 + 1 of them.

    Examples
    --------
    Five cycles in a period of eight samples look like three:

    >>> folded(np.array([[0, 0, 0, 0, 0, 1j]]), 8).tolist()
    [[0j, 0j, 0j, -1j, 0j]]
    """
    half = samples // 2
    if spectra.shape[-1] <= half + 1:
        return spectra
    below = spectra[:, : half + 1].copy()
    # What lies at zero or half the sampling frequency, irfft takes once for both signs of its frequency.
    once = [0, half] if samples % 2 == 0 else [0]
    below[:, once[1:]] *= 2.0
    for first in range(0, spectra.shape[-1], samples):
        block = spectra[:, first : first + samples]
        if first:
            upward = block[:, : half + 1].copy()
            within = [number for number in once if number < upward.shape[-1]]
            upward[:, within] *= 2.0
            below[:, : upward.shape[-1]] += upward
        downward = block[:, half + 1 :]
        last = samples - half - 1
        below[:, last - downward.shape[-1] + 1 : last + 1] += np.conj(downward[:, ::-1])
    return below


class Pulse(NamedTuple):
    """(c₀ + c₁ t + c₂ t²) e^{−at} from t = 0 on: an abrupt change whose transform is known."""

    coefficients: FloatArray  # (3, *case)
    rate: float  # a [1/s]

    @classmethod
    def of(cls, jumps: FloatArray, rate: float) -> Pulse:
        """Take value, first and second derivative at t = 0, shape (3, *case)."""
        value, slope, bend = jumps
        linear = slope + rate * value
        return cls(np.stack([value, linear, 0.5 * (bend + 2 * rate * linear - rate**2 * value)]), rate)

    def values(self, time: FloatArray) -> FloatArray:
        """Values at some times [s], shape (*case, time)."""
        constant, linear, square = self.coefficients[..., None]
        return (constant + time * (linear + time * square)) * np.exp(-self.rate * time)

    def spectrum(self, s: ComplexArray) -> ComplexArray:
        """∫ … e^{−st} dt, shape (*case, frequency)."""
        constant, linear, square = self.coefficients[..., None]
        inverse = 1.0 / (s + self.rate)
        return inverse * (constant + inverse * (linear + 2.0 * inverse * square))


def holds(line: Line, channels: int, finer: int) -> bool:
    """Tell whether memory holds records of so many channels with so many values for each step."""
    try:
        require_record(replace(line, samples=line.samples * finer, time_step=line.time_step / finer), channels)
    except ValueError:
        return False
    return True


def require_record(line: Line, channels: int) -> None:
    """Refuse a record that memory would not hold.

    Parameters
    ----------
    line : Line
        The record.
    channels : int
        Histories that are computed: contacts and degrees of freedom, or loads and points.

    Raises
    ------
    ValueError
        With what is needed and what is free.
    """
    require_memory(
        TRANSFORM.bytes_per_sample * channels * line.needed / line.time_step,
        f"a record of {line.duration:g} s in steps of {line.time_step:g} s",
    )

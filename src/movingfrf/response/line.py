"""From time to complex frequency and back: sign, scale, window and padding are decided here."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import scipy.fft
from numpy.typing import NDArray

from movingfrf._basics.arrays import ComplexArray, FloatArray, IntArray, require_memory
from movingfrf._basics.checks import checking
from movingfrf._basics.smooth import smooth_step


@dataclass(frozen=True, slots=True, kw_only=True)
class Transform:
    """What tunes the transform of records to complex frequency; in brackets, between what each number is safe."""

    # What wraps around the end of the padded record comes back weaker by this factor; errors at the end of the
    # padded record grow by its inverse, which is why it is not smaller.
    wrap_around: float = 3e-5  # [1e-5 to 5e-5]
    # Share of the padding within which the level of a record fades out after its end; the rest of the padding is
    # for the response to die away.
    level_fades: float = 0.25  # [0.15 to 0.4]
    # Slope and curvature fade earlier: after so many times the ratio of the record's typical slope to its typical
    # curvature, at most within this share of the padding. So many samples before the end tell what is typical.
    slope_fades: float = 0.05  # [0.02 to 0.1]
    times_its_scale: float = 12.0  # [12 to 16]
    lately: int = 4096  # [256 to 65 536]
    # Channels transformed at a time: as many as a processor's vector holds numbers.
    together: int = 4  # [1 to 64: time only]
    # Bytes per sample of the padded record and channel (a contact or a degree of freedom) at the peak of a
    # computation, measured on an hour of travel.
    bytes_per_sample: int = 60


TRANSFORM = Transform()

# One-sided differences of fourth and third order for slope and curvature at the last sample (latest first).
DIFFERENCES = np.array([[25 / 12, -4.0, 3.0, -4 / 3, 1 / 4], [35 / 12, -26 / 3, 19 / 2, -14 / 3, 11 / 12]])


class Histories(NamedTuple):
    """Records, and what of each wraps around from the end of the padding to the start."""

    values: FloatArray  # (*case, port, time)
    wrapped: FloatArray  # (*case, port)


@dataclass(frozen=True, slots=True, kw_only=True)
class Line:
    """A record in time and the complex frequencies that stand for it.

    X(ω) = ∫ x(t) e^{−iωt} dt, evaluated along ω − iη (exponential window, Kausel and Roësset 1992): the
    periodic repetition that a discrete transform implies is damped to `TRANSFORM.wrap_around` after one period.

    Parameters
    ----------
    samples : int
        Samples of the record.
    time_step : float
        Step of the record [s].
    settling : float
        Time that the padding must leave, at least, for the response to die away [s].

    Examples
    --------
    >>> line = Line(samples=1000, time_step=1e-3)
    >>> record = np.sin(2 * np.pi * 5 * line.time) ** 3
    >>> bool(np.allclose(line.records(line.spectra(record)).values, record, atol=1e-12))
    True
    """

    samples: int
    time_step: float
    settling: float = 0.0

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking(self) as check:
            check.whole("samples", self.samples, least=1)
            check.positive("time_step", self.time_step, "s")
            check.not_negative("settling", self.settling, "s")

    @property
    def padded(self) -> int:
        """Length of the transform: the record, time to settle, and what makes the length factorise."""
        padding = max(self.samples // 8, int(self.settling / (1 - TRANSFORM.level_fades) / self.time_step), 16)
        return int(scipy.fft.next_fast_len(self.samples + padding, real=True))

    @property
    def period(self) -> float:
        """Duration of the padded record [s]."""
        return self.padded * self.time_step

    @property
    def decay(self) -> float:
        """Distance η of the line of evaluation from the real axis [rad/s]."""
        return float(-np.log(TRANSFORM.wrap_around)) / self.period

    @property
    def size(self) -> int:
        """Number of complex frequencies."""
        return self.padded // 2 + 1

    @property
    def time(self) -> FloatArray:
        """Times of the record [s], from zero."""
        return np.arange(self.samples) * self.time_step

    def omega(self, numbers: IntArray | slice = slice(None)) -> ComplexArray:
        """Complex angular frequencies ω − iη [rad/s]: those of the given numbers, or all."""
        step = 2 * np.pi / self.period
        if isinstance(numbers, slice):
            numbers = np.arange(*numbers.indices(self.size))
        return step * numbers - 1j * self.decay

    def spectra(self, records: FloatArray) -> ComplexArray:
        """Transform records that are zero before their first sample.

        Past its end each record is continued: smoothly in value, slope and curvature, down to zero within the
        padding. (A record that simply stopped would jump, and the jump would ring backwards.)

        Parameters
        ----------
        records : ndarray, shape (*case, port, time)
            Records; not modified.

        Returns
        -------
        ndarray, shape (*case, port, frequency)
            Spectra, in the unit of the record times second.
        """
        rows = records.reshape(-1, self.samples)
        spectra = np.empty((len(rows), self.size), complex)
        window = self.time_step * np.exp(-self.decay * self.time_step * np.arange(self.padded))
        together = TRANSFORM.together
        for first in range(0, len(rows), together):
            block = rows[first : first + together]
            padded = np.empty((len(block), self.padded))
            padded[:, : self.samples] = block
            for row, record in zip(padded, block, strict=True):
                row[self.samples :] = self._continuation(record)
            # A jump at t = 0 is centred there: half of its first sample lies before it.
            padded[:, 0] *= 0.5
            padded *= window
            np.fft.rfft(padded, out=spectra[first : first + together])
        return spectra.reshape(*records.shape[:-1], self.size)

    def scratch(self) -> NDArray[np.float64]:
        """Memory for `records` to work in: fresh pages cost more than a transform."""
        return np.empty((TRANSFORM.together, self.padded))

    def records(
        self, spectra: ComplexArray, *, derivative: int = 0, scratch: NDArray[np.float64] | None = None
    ) -> Histories:
        """Transform spectra, or their derivatives in time, back to records; the inverse of `spectra`.

        Parameters
        ----------
        spectra : ndarray, shape (*case, port, frequency)
            Spectra along ω − iη; frequencies beyond the last one are zero.
        derivative : int
            Order of the derivative with respect to time.
        scratch : ndarray, optional
            What `scratch()` returned, to be used again for several calls.

        Returns
        -------
        Histories
            Records of shape (*case, port, time), and the largest value, as it wraps around, within a hundredth of
            the period near its end (not at the very end, where the ripple that precedes a jump at t = 0 lies).
        """
        ports = spectra.shape[:-1]
        rows = spectra.reshape(math.prod(ports), spectra.shape[-1])
        values, wrapped = np.zeros((len(rows), self.samples)), np.zeros(len(rows))
        if not rows.size:
            return Histories(values.reshape(*ports, self.samples), wrapped.reshape(ports))
        last = self.padded // 100 + 1
        memory = self.scratch() if scratch is None else scratch
        factor = (1j * self.omega(slice(rows.shape[1]))) ** derivative if derivative else None
        growth = np.exp(self.decay * self.time_step * np.arange(self.samples)) / self.time_step
        for first in range(0, len(rows), TRANSFORM.together):
            some = slice(first, first + TRANSFORM.together)
            block = rows[some] if factor is None else rows[some] * factor
            periodic = np.fft.irfft(block, self.padded, out=memory[: len(block)])
            np.multiply(periodic[:, : self.samples], growth, out=values[some])
            wrapped[some] = np.abs(periodic[:, -6 * last : -5 * last]).max(axis=1) / self.time_step
        return Histories(values.reshape(*ports, self.samples), wrapped.reshape(ports))

    def _continuation(self, record: FloatArray) -> FloatArray:
        """Continue the record, so that neither value, slope nor curvature jumps."""
        length = self.padded - self.samples
        after = np.zeros(length)
        level = record[-1]
        settle = max(int(TRANSFORM.level_fades * length), 1)
        after[:settle] = level * _fading(settle)
        fade = min(self._memory(record), length)
        taken = DIFFERENCES.shape[1]
        if self.samples >= taken and fade > 1:
            latest = record[: -taken - 1 : -1]
            slope, curvature = (weights @ latest for weights in DIFFERENCES)
            ahead = np.arange(1.0, fade + 1)
            after[:fade] += (slope * ahead + 0.5 * curvature * ahead**2) * _fading(fade)
        return after

    def _memory(self, record: FloatArray) -> int:
        """Count the samples over which slope and curvature fade: enough not to add frequencies."""
        steps = np.diff(record[-TRANSFORM.lately :])
        bends = np.diff(steps)
        bend, step = float(bends @ bends), float(steps @ steps)
        longest = (self.padded - self.samples) * TRANSFORM.slope_fades
        return int(min(TRANSFORM.times_its_scale * np.sqrt(step / bend), longest)) if bend else int(longest)


def _fading(count: int) -> FloatArray:
    """From just below 1 to 0 over `count` samples."""
    return 1.0 - smooth_step(np.arange(1, count + 1) / count)


def require_record(duration: float, settling: float, time_step: float, channels: int) -> None:
    """Refuse a record that memory would not hold.

    Parameters
    ----------
    duration, settling : float
        Length of the record and of the padding behind it [s].
    time_step : float
        Step in time [s].
    channels : int
        Histories that are computed: contacts and degrees of freedom, or loads and points.

    Raises
    ------
    ValueError
        With what is needed and what is free.
    """
    require_memory(
        TRANSFORM.bytes_per_sample * channels * (duration + settling) / time_step,
        f"a record of {duration:g} s in steps of {time_step:g} s",
    )

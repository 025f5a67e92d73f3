"""A guideway known by its moving impulse response: from a finite-element model, or from a measurement."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from hashlib import blake2b

import numpy as np
from numpy.typing import ArrayLike

from movingfrf._basics.arrays import ComplexArray, FloatArray, IntArray
from movingfrf._basics.checks import Finding, checking, shown, warned
from movingfrf._basics.remembered import Remembering, remembered
from movingfrf._basics.smooth import smooth_step
from movingfrf._basics.values import Value
from movingfrf.guideways.guideway import Asked, at_offsets
from movingfrf.guideways.record import RECORD, Onset, onset_of, tail_of


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SampledGuideway(Remembering, Value):
    """A guideway given by samples of its moving impulse response, at one speed and for some offsets.

    From its first sample, a jump where that is not zero, the response is taken to set in like √t or like t, as the
    next samples show; or with the jump alone, if they show neither.

    Parameters
    ----------
    response : array_like, shape (time, offset)
        Deflection [m] per unit impulse [N s] at points that leave each offset when the impulse strikes and travel
        on at `speed`; the first row at the instant of the impulse.
    time_step : float
        Step between samples [s].
    offsets : array_like, shape (offset,)
        Receiver minus source [m], positive ahead.
    speed : float
        The speed [m/s].
    across, source_across : array_like, shape (offset,), optional
        Of a road whose section does not move as one: receiver minus source across it, and where the source stands,
        left of the centre line [m]. None: places across make no difference.
    critical_speed : float
        Critical speed of the guideway [m/s], where it is known; inf otherwise.
    stepped : bool
        Whether the samples were stepped through time, as those of a struck road: then their sum by the trapezoidal
        rule is exact. Others are taken to lie on the response, which sets in between them.
    remarks : iterable of (str, str), optional
        What else is to be known of the record, code and message; results carry it among their findings.

    Raises
    ------
    ValueError
        If shapes disagree or a value is impossible.

    Warns
    -----
    ValidityWarning
        If the response has not died away at the end of the record, the step is too long for what it shows, or for
        each remark.

    Examples
    --------
    An impulse response 1e-6 · e^{−10 s} (a massless road on springs and dashpots) and its FRF at rest, 1e-7 m/N:

    >>> time = 1e-3 * np.arange(4000)
    >>> ringing = 1e-6 * np.exp(-10 * time)[:, None]
    >>> road = SampledGuideway(response=ringing, time_step=1e-3, offsets=[0.0], speed=10.0)
    >>> abs(road.moving_frf(0.0, 10.0, [0.0])).round(10).tolist()
    [1e-07]
    """

    response: ArrayLike
    time_step: float
    offsets: ArrayLike
    speed: float
    across: ArrayLike | None = None
    source_across: ArrayLike | None = None
    critical_speed: float = np.inf
    stepped: bool = False
    remarks: Iterable[tuple[str, str]] = ()

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking(self) as check:
            offsets = check.array("offsets", self.offsets, "m", (None,))
            response = check.array("response", self.response, "m/(N s)", (None, offsets.size))
            check.positive("time_step", self.time_step, "s")
            check.finite("speed", self.speed, "m/s")
            if (self.across is None) != (self.source_across is None):
                check.refuse("across", "and source_across must be given both or neither [m]")
            for name, value in (("across", self.across), ("source_across", self.source_across)):
                if value is not None:
                    check.array(name, value, "m", (offsets.size,))
            check.positive_or_infinite("critical_speed", self.critical_speed, "m/s")
            if not check.faults and (len(response) < 2 or not offsets.size):
                check.refuse("response", "must hold at least two samples and one offset")
            remarks = tuple(tuple(remark) for remark in self.remarks)
            if not all(len(remark) == 2 and all(isinstance(part, str) for part in remark) for remark in remarks):
                check.refuse("remarks", f"must be pairs of a code and a message, got {shown(self.remarks)}")
        object.__setattr__(self, "remarks", remarks)
        warned(self.findings)

    def __repr__(self) -> str:
        """Say which record it is: its size, and a sum over its bytes in place of them."""
        places = (self.offsets, self.across, self.source_across)
        held = b"".join(np.asarray(part).tobytes() for part in (self.response, *places) if part is not None)
        samples, offsets = self.samples.shape
        return (
            f"SampledGuideway({samples} samples of {offsets} offsets, time_step={self.time_step!r}, "
            f"speed={self.speed!r}, blake2b={blake2b(held, digest_size=8).hexdigest()})"
        )

    @property
    def samples(self) -> FloatArray:
        """The moving impulse response, shape (time, offset) [m/(N s)]."""
        return np.asarray(self.response)

    @property
    @remembered
    def onset(self) -> Onset:
        """How the response begins, between its first samples."""
        return onset_of(self.samples, stepped=self.stepped)

    @property
    @remembered
    def findings(self) -> tuple[Finding, ...]:
        """What is to be known of whatever is computed from the record."""
        largest = self.time_step * float(np.abs(np.fft.rfft(self.samples, axis=0)).max())
        remarks = tuple(Finding(*remark) for remark in self.remarks)
        return remarks if not largest else (*self._cut_off(largest), *self._coarse(largest), *remarks)

    def _cut_off(self, largest: float) -> list[Finding]:
        """Estimate what is left out of a record that ends too early, beside the largest moving FRF [m/N]."""
        tail, known = tail_of(self.samples, self.time_step), self.time_step * self.samples.sum(axis=0)
        worst = int(tail.largest.argmax())
        if tail.largest[worst] <= RECORD.worth_a_word * largest:
            return []
        still = np.abs(tail.at_rest).max() / np.abs(known + tail.at_rest).max()
        return [
            Finding(
                "record_cut_off",
                "the moving impulse response has not died away: after "
                f"{self.time_step * (len(self.samples) - 1):.4g} s about {_share(still)} of the static deflection "
                f"is missing, and at {tail.frequency[worst]:.3g} Hz {_share(tail.largest[worst] / largest)} of the "
                "largest moving FRF; a longer record is needed, on a longer road, or with more damping",
            )
        ]

    def _coarse(self, largest: float) -> list[Finding]:
        """Estimate what is wrong in a record whose step is too long, beside the largest moving FRF [m/N]."""
        if self.stepped:
            return []
        doubt = self.onset.doubt
        recognised = ~np.isnan(doubt)
        # A beginning that is recognised has been seen to, what sets in later has not; the end is no step.
        rising = smooth_step(np.arange(len(self.samples)) / RECORD.later)[:, None]
        spectrum = np.abs(np.fft.rfft(np.where(recognised, rising, 1.0) * rising[::-1] * self.samples, axis=0))
        half, quarter = len(spectrum) // 2, len(spectrum) // 4
        upper, lower = (
            np.sqrt(np.square(part).sum(axis=0) / max(len(part), 1))
            for part in (spectrum[half:], spectrum[quarter:half])
        )
        # What folds back to low frequencies comes from the sampling frequency, above the middle of the last octave.
        ratio = np.minimum(np.divide(upper, lower, out=np.ones_like(upper), where=lower > 0), 1.0)
        folded = upper * ratio**RECORD.octaves
        share = self.time_step * float((np.where(recognised, doubt, 0.0) + folded).max()) / largest
        if share <= RECORD.worth_a_word:
            return []
        return [
            Finding(
                "record_step",
                f"a step of {self.time_step:g} s is long for what the impulse response shows: the moving FRF may "
                f"be off by {_share(share)} of its largest value, and nothing is known of it beyond "
                f"{0.5 / self.time_step:.4g} Hz; samples closer together would tell more",
            )
        ]

    def columns(self, ahead: ArrayLike, across: ArrayLike = 0.0, source_across: ArrayLike = 0.0) -> IntArray:
        """Find the columns of `response` that belong to some offsets.

        Parameters
        ----------
        ahead : array_like, shape (*s)
            Offsets [m].
        across, source_across : array_like, broadcastable to (*s)
            Offsets across and places of the sources across [m]; where they make no difference they are ignored.

        Returns
        -------
        ndarray, shape (*s)
            Numbers of columns.

        Raises
        ------
        ValueError
            If an offset was not recorded.
        """
        named = {"ahead": ahead, "across": across, "source_across": source_across}
        with checking() as check:
            places = np.broadcast_arrays(*(check.array(name, place, "m", None) for name, place in named.items()))
        wide = () if self.across is None else (self.across, self.source_across)
        known = [np.asarray(recorded, float) for recorded in (self.offsets, *wide)]
        asked = len(known)
        apart = np.max(
            [np.abs(place[..., None] - recorded) for place, recorded in zip(places, known, strict=False)], axis=0
        )
        nearest = apart.argmin(axis=-1)
        missing = apart.min(axis=-1) > RECORD.same_place
        if missing.any():
            names = list(named)[:asked]
            recorded = np.stack(known, axis=-1).squeeze(axis=-1 if asked == 1 else ()).tolist()
            wanted = [float(place[missing][0]) for place in places[:asked]]
            raise ValueError(
                f"{', '.join(names)} must be one of the recorded offsets {recorded} m, got "
                f"{', '.join(map(repr, wanted))} m"
            )
        return nearest

    def require_speed(self, speed: float) -> None:
        """Refuse any speed but the recorded one.

        Parameters
        ----------
        speed : float
            Speed that is asked for [m/s].

        Raises
        ------
        ValueError
            If it is another one.
        """
        if not abs(speed - self.speed) <= RECORD.same_speed * max(abs(self.speed), 1.0):
            raise ValueError(
                f"speed must be {self.speed!r} m/s, at which the impulse response was recorded, got {speed!r} m/s"
            )

    def moving_frf(
        self,
        ahead: ArrayLike,
        speed: float,
        omega: ArrayLike,
        *,
        across: ArrayLike = 0.0,
        source_across: ArrayLike = 0.0,
        derivative: int = 0,
    ) -> ComplexArray:
        """Deflection per unit force between points that travel together: the transform of the impulse response.

        Parameters
        ----------
        ahead : array_like, shape (*s)
            Receiver minus source [m]; recorded offsets only.
        speed : float
            Common speed of source and receiver [m/s]; the recorded one only.
        omega : array_like, shape (frequency,)
            Angular frequency in the moving frame [rad/s]; may be complex. Beyond half the sampling frequency the
            record says nothing and the guideway counts as rigid.
        across, source_across : array_like
            Receiver minus source across, and the source's place [m]; recorded ones only, if any were recorded.
        derivative : int
            Order of the derivative with respect to x: 0 only.

        Returns
        -------
        ndarray, shape (frequency, *s), complex
            Moving FRF [m/N].

        Raises
        ------
        ValueError
            If the speed, an offset or a derivative was not recorded.
        """
        self.require_speed(speed)
        return at_offsets(
            self._frf,
            ahead,
            speed,
            omega,
            across=across,
            source_across=source_across,
            derivative=derivative,
            wide=self.across is not None,
        )

    def _frf(self, asked: Asked) -> ComplexArray:
        columns = self.columns(asked.ahead, asked.across, asked.source_across)[:, 0]
        frf = np.zeros((columns.size, asked.omega.size), complex)
        within = np.flatnonzero(np.abs(asked.omega.real) <= np.pi / self.time_step)
        for first in range(0, within.size, RECORD.together):
            some = within[first : first + RECORD.together]
            frf[:, some] = self._transformed(asked.omega[some], columns).T
        return frf

    def _transformed(self, omega: ComplexArray, columns: IntArray) -> ComplexArray:
        """Σ_{k≥1} g(kΔt) e^{−iωkΔt} Δt, in blocks of samples that share a factor, and what the onset adds."""
        samples = self.samples[:, columns]
        size = RECORD.block
        blocks = -(-len(samples) // size)
        padded = np.zeros((blocks * size, columns.size))
        padded[1 : len(samples)] = samples[1:]
        by_block = padded.reshape(blocks, size, -1).swapaxes(0, 1).reshape(size, -1)
        phase = -1j * self.time_step * omega[:, None]
        within, between = np.exp(phase * np.arange(size)), np.exp(phase * (size * np.arange(blocks)))
        # Two real products take half the time of one with a real factor made complex.
        inner: ComplexArray = np.empty((omega.size, by_block.shape[1]), complex)
        inner.real, inner.imag = within.real @ by_block, within.imag @ by_block
        frf: ComplexArray = np.einsum("wb,wbc->wc", between, inner.reshape(omega.size, blocks, -1))
        frf += self.onset.transform(1j * self.time_step * omega)[:, columns]
        frf *= self.time_step
        return frf


def _share(value: float) -> str:
    """Write a share; past its whole an estimate only says that there is no telling."""
    return f"{value:.1e}" if value < 0.1 else f"{value:.0%}" if value < 1 else "all"

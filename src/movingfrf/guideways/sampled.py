"""A guideway known by its moving impulse response: from a finite-element model, or from a measurement."""

from __future__ import annotations

from dataclasses import dataclass
from hashlib import blake2b

import numpy as np
from numpy.typing import ArrayLike

from movingfrf._basics.arrays import ComplexArray, FloatArray, IntArray
from movingfrf._basics.checks import checking
from movingfrf.guideways.guideway import Asked, at_offsets


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


RECORD = ImpulseRecord()


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SampledGuideway:
    """A guideway given by samples of its moving impulse response, at one speed and for some offsets.

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

    Raises
    ------
    ValueError
        If shapes disagree or a value is impossible.

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
        """Σ g(k Δt) e^{−iω k Δt} Δt, the first sample by half, in blocks of samples that share a factor."""
        samples = self.samples[:, columns].copy()
        samples[0] *= 0.5
        size = RECORD.block
        blocks = -(-len(samples) // size)
        padded = np.zeros((blocks * size, columns.size))
        padded[: len(samples)] = samples
        by_block = padded.reshape(blocks, size, -1).swapaxes(0, 1).reshape(size, -1)
        phase = -1j * self.time_step * omega[:, None]
        within, between = np.exp(phase * np.arange(size)), np.exp(phase * (size * np.arange(blocks)))
        # Two real products take half the time of one with a real factor made complex.
        inner: ComplexArray = np.empty((omega.size, by_block.shape[1]), complex)
        inner.real, inner.imag = within.real @ by_block, within.imag @ by_block
        frf: ComplexArray = np.einsum("wb,wbc->wc", between, inner.reshape(omega.size, blocks, -1))
        frf *= self.time_step
        return frf

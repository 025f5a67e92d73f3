"""What each band of frequencies holds of every output, and what of that the guideway adds.

Both decide what need not be solved: beyond the truncation the guideway counts as rigid, beyond the content of the
road nothing is left.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple, Protocol

import numpy as np

from movingfrf._basics.arrays import ComplexArray, FloatArray, IntArray, handed
from movingfrf._basics.compiling import loops_for
from movingfrf._basics.remembered import recalled
from movingfrf.response.batches import BATCH
from movingfrf.response.line import Line
from movingfrf.response.truncation import TRUNCATION, Truncation


class Sized(Protocol):
    """What tells how large its outputs are: `System` and `Prescribed`."""

    @property
    def ports(self) -> int:
        """Contacts, or loads and points."""
        ...

    @property
    def kinds(self) -> tuple[int, ...]:
        """How many outputs there are of each kind, one kind after the other."""
        ...

    def per_unit(self, omega: ComplexArray) -> FloatArray:
        """Say what the guideway adds to each output, then its size, per unit: (2, port, output, frequency)."""
        ...


class Share(NamedTuple):
    """What is looked at of every output, band by band."""

    gain: FloatArray  # (port, output, band) magnitude per unit of what drives that port
    beyond: FloatArray  # (case, output, band + 1) upper bound of its energy from the beginning of each band on
    most: FloatArray  # (band + 1,) of any output of any case


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Influence:
    """Outputs, and what the compliance of the guideway adds to them, in bands.

    Energies are shares of that of the output, contacts taken as independent; every output counts for a share of the
    largest of its kind at least.

    Parameters
    ----------
    starts : ndarray, shape (band,)
        Number of the first frequency of each band.
    added : Share
        What the guideway adds.
    whole : Share
        All of the output.
    size : ndarray, shape (case, output)
        Energy of which energies are shares.
    lines : int
        Number of the frequencies.
    power : ndarray, shape (case, port, band)
        Energy of what drives each port.
    highest : ndarray, shape (port, output)
        Largest magnitude of each output per unit of what drives a port, over the bands, and where images are.
    """

    starts: IntArray
    added: Share
    whole: Share
    size: FloatArray
    lines: int
    power: FloatArray
    highest: FloatArray

    def error(self, kept: int, end: int) -> float:
        """Greatest relative change of any output if the road is rigid from frequency number `kept` to `end`."""
        return float(np.sqrt(self._between(self.added, kept, end).max(initial=0.0)))

    def content(self, first: int) -> float:
        """Greatest share of any output, relative L2, that lies from frequency number `first` on."""
        return math.sqrt(self.whole.most[self.starts.searchsorted(first)])

    def up_to(self, share: float) -> int:
        """Give a frequency number beyond which no more than a share of any output is left, relative L2."""
        bands = int((self.whole.most > share**2).sum())
        return int(self.starts[bands]) if bands < self.starts.size else self.lines

    def shares(self, first: int, end: int) -> FloatArray:
        """Greatest share of each output, relative L2, from frequency number `first` to `end`; shape (output,)."""
        return np.sqrt(self._between(self.whole, first, end).max(axis=0))

    def _between(self, share: Share, first: int, end: int) -> FloatArray:
        """Energy of the bands that begin from frequency number `first` on, before `end`; shape (case, output)."""
        begins, ends = self.starts.searchsorted([first, end]).tolist()
        return share.beyond[:, :, begins] - share.beyond[:, :, max(begins, ends)]

    @property
    def middles(self) -> IntArray:
        """Number of the frequency in the middle of each band."""
        return middles(self.starts, self.lines)

    def at_most(self, energy: FloatArray) -> float:
        """Bound the share of any output, relative L2, of what drives ports with so much energy, (case, port)."""
        return float(np.sqrt(quotient((np.sqrt(energy) @ self.highest) ** 2, self.size).max(initial=0.0)))

    def negligible_from(self, share: Share, allowed: float, energy: FloatArray) -> int:
        """Find the lowest frequency from which on a share of the outputs is negligible.

        Parameters
        ----------
        share : Share
            `added` or `whole`.
        allowed : float
            What may be left of any output, relative L2.
        energy : ndarray, shape (*case, contact, frequency)
            Squared magnitudes of the spectra of what drives the system.

        Returns
        -------
        int
            Number of the frequency; the number of frequencies if there is no such frequency.
        """
        limit, count = allowed**2, len(self.starts)
        band = int((share.most > limit).sum())
        if not band:
            return 0
        # Within the last harmful band, frequency by frequency.
        first = int(self.starts[band - 1])
        last = int(self.starts[band]) if band < count else energy.shape[-1]
        cases = energy[..., first:last].reshape(-1, energy.shape[-2], last - first)
        if loops := loops_for("response.compiled", 0):
            parts = (share.gain[:, :, band - 1], share.beyond[:, :, band], self.size, cases)
            return first + int(loops.harmful(*(handed(part, float) for part in parts), limit))
        cases = np.sqrt(cases)
        each = quotient((share.gain[:, :, band - 1].T @ cases) ** 2, self.size[:, :, None])
        tail = np.cumsum(each[:, :, ::-1], axis=2)[:, :, ::-1] + share.beyond[:, :, band, None]
        harmful = np.flatnonzero((tail > limit).any(axis=(0, 1)))
        return int(first + harmful[-1] + 1) if harmful.size else first


def _bands(line: Line, truncation: float | None) -> IntArray:
    """Give the number of the first frequency of each band; one band begins beyond a stated truncation [Hz]."""
    beyond = min(Truncation.stated(truncation).harmonics(line.period, line.size), line.size - 1)
    return _bands_of(line.size, beyond)


@lru_cache(maxsize=16)
def _bands_of(lines: int, beyond: int) -> IntArray:
    edges = np.exp(np.arange(TRUNCATION.bands) * (math.log(lines) / TRUNCATION.bands)).astype(int)
    starts = np.append(edges, [0, beyond])
    starts.sort()
    starts = starts[np.append(True, starts[1:] > starts[:-1])]
    starts.setflags(write=False)
    return starts


def middles(starts: IntArray, lines: int) -> IntArray:
    """Give the number of the frequency in the middle of each band, of so many frequencies."""
    ends = np.append(starts[1:], lines)
    return (starts + ends - 1) // 2


def looked_at(line: Line, truncation: float | None, images: float | None) -> ComplexArray:
    """Give the frequencies at which `influence` looks at a system [rad/s].

    Parameters
    ----------
    line : Line
        The frequencies.
    truncation : float, optional
        Stated truncation [Hz].
    images : float, optional
        Frequency about which what drives it has images [rad/s].

    Returns
    -------
    ndarray, shape (frequency,)
        The middle of each band, and where images are.
    """

    def make() -> ComplexArray:
        omega = line.omega(middles(_bands(line, truncation), line.size))
        return omega if images is None else np.append(omega, images - 1j * line.decay)

    return recalled(line, f"looked at, {truncation}, {images}", make)


def influence(
    system: Sized,
    line: Line,
    energy: FloatArray,
    truncation: float | None,
    alike: float,
    images: float | None = None,
) -> Influence:
    """Estimate outputs, and the guideway's part in them, from the system at the middle of each band.

    Over a band, √energy ≤ Σ_j |output per unit at port j| · √(energy at that port).

    Parameters
    ----------
    system : System or Prescribed
        What is driven.
    line : Line
        The frequencies.
    energy : ndarray, shape (*case, port, frequency)
        Squared magnitudes of the spectra of what drives it.
    truncation : float, optional
        Stated truncation [Hz]: one band begins beyond it.
    alike : float
        Share of the size of the largest output of its kind that every output counts for at least.
    images : float, optional
        Frequency about which what drives it has images [rad/s].

    Returns
    -------
    Influence
        Per band and output.
    """
    starts = _bands(line, truncation)
    omega = looked_at(line, truncation, images)
    cases = energy.reshape(-1, *energy.shape[-2:])
    power = np.add.reduceat(cases, starts, axis=2)
    if system.ports <= BATCH.looped and (loops := loops_for("response.compiled", 0)):
        gains = system.per_unit(omega)
        beyond, size = loops.shares(gains, power, np.array(system.kinds), alike)
    else:
        gains, beyond, size = _shares(system, omega, power, alike)
    added, whole = map(Share, gains, beyond, beyond.max(axis=(1, 2), initial=0.0))
    return Influence(
        starts=starts,
        added=added,
        whole=whole,
        size=size,
        lines=line.size,
        power=power,
        highest=gains[1].max(axis=-1),
    )


def _shares(
    system: Sized, omega: ComplexArray, power: FloatArray, alike: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Give gains, bounds of energies from each band on, and energies of which these are shares."""
    amplitude, outputs = np.sqrt(power), sum(system.kinds)
    # What the guideway adds, then all of it. Gains of many contacts are many; half of the digits tell what is
    # negligible.
    gains = np.empty((2, power.shape[1], outputs, omega.size), np.float32)
    bands, total = power.shape[-1], np.zeros((len(power), outputs))
    energies = np.empty((2, len(power), outputs, bands))
    for here in BATCH.some(omega.size, system.ports**2):
        gains[..., here] = found = system.per_unit(omega[here])
        found = found[..., : bands - here.start]
        np.square(np.einsum("scob,ncb->snob", found, amplitude[..., here]), out=energies[..., here])
        total += np.einsum("cob,ncb->no", np.square(found[1]), power[..., here])
    begins = np.cumsum((0, *system.kinds[:-1]))
    least = np.maximum.reduceat(total, begins, axis=1)
    size = np.maximum(total, alike**2 * np.repeat(least, system.kinds, axis=1))
    beyond = np.zeros((*energies.shape[:-1], bands + 1))
    np.cumsum(quotient(energies, size[:, :, None])[..., ::-1], axis=-1, out=beyond[..., -2::-1])
    return gains, beyond, size


def quotient(part: FloatArray, whole: FloatArray) -> FloatArray:
    """Quotient of two energies; nothing of nothing is nothing."""
    whole = np.broadcast_to(whole, part.shape)
    return np.divide(part, whole, out=np.zeros_like(part), where=whole > 0)

"""What each band of frequencies holds of every output, and what of that the guideway adds.

Both decide what need not be solved: beyond the truncation the guideway counts as rigid, beyond the content of the
road nothing is left.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from movingfrf._basics.arrays import ComplexArray, FloatArray, IntArray
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

    def per_unit(self, omega: ComplexArray) -> tuple[FloatArray, FloatArray]:
        """Say what the guideway adds to each output, and its size, per unit: (port, output, frequency)."""
        ...


class Share(NamedTuple):
    """What is looked at of every output, band by band."""

    gain: FloatArray  # (port, output, band) magnitude per unit of what drives that port
    energy: FloatArray  # (case, output, band) upper bound of the energy that it carries

    def between(self, starts: IntArray, first: int, end: int) -> FloatArray:
        """Energy of the bands that begin from frequency number `first` on, before `end`; shape (case, output)."""
        return self.energy[:, :, (starts >= first) & (starts < end)].sum(axis=2)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Influence:
    """Outputs, and what the compliance of the guideway adds to them, in bands.

    Parameters
    ----------
    starts : ndarray, shape (band,)
        Number of the first frequency of each band.
    added : Share
        What the guideway adds.
    whole : Share
        All of the output.
    total : ndarray, shape (case, output)
        Energy of the whole output, contacts taken as independent.
    least : ndarray, shape (case, output)
        Energy that every output counts for at least: a share of the largest of its kind.
    lines : int
        Number of the frequencies.
    """

    starts: IntArray
    added: Share
    whole: Share
    total: FloatArray
    least: FloatArray
    lines: int

    @property
    def size(self) -> FloatArray:
        """Energy against which a part of an output counts, shape (case, output)."""
        return np.maximum(self.total, self.least)

    def error(self, kept: int, end: int) -> float:
        """Greatest relative change of any output if the road is rigid from frequency number `kept` to `end`."""
        return float(np.sqrt(quotient(self.added.between(self.starts, kept, end), self.size).max(initial=0.0)))

    def content(self, first: int) -> float:
        """Greatest share of any output, relative L2, that lies from frequency number `first` on."""
        return float(self.shares(first, self.lines).max(initial=0.0))

    def shares(self, first: int, end: int) -> FloatArray:
        """Greatest share of each output, relative L2, from frequency number `first` to `end`; shape (output,)."""
        return np.sqrt(quotient(self.whole.between(self.starts, first, end), self.size).max(axis=0))

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
        limit, total = allowed**2, self.size[:, :, None]
        beyond = np.cumsum(share.energy[:, :, ::-1], axis=2)[:, :, ::-1]
        harmful_bands = np.flatnonzero((quotient(beyond, total) > limit).any(axis=(0, 1)))
        if not harmful_bands.size:
            return 0
        band = int(harmful_bands[-1]) + 1
        # Within the last harmful band, frequency by frequency.
        first = int(self.starts[band - 1])
        last = int(self.starts[band]) if band < len(self.starts) else energy.shape[-1]
        cases = np.sqrt(energy[..., first:last]).reshape(-1, energy.shape[-2], last - first)
        each = (share.gain[:, :, band - 1].T @ cases) ** 2
        tail = np.cumsum(each[:, :, ::-1], axis=2)[:, :, ::-1]
        if band < len(self.starts):
            tail += beyond[:, :, band, None]
        harmful = np.flatnonzero((quotient(tail, total) > limit).any(axis=(0, 1)))
        return int(first + harmful[-1] + 1) if harmful.size else first


def _bands(line: Line, truncation: float | None) -> IntArray:
    """Give the number of the first frequency of each band; one band begins beyond a stated truncation [Hz]."""
    edges = np.geomspace(1, line.size, TRUNCATION.bands + 1).astype(int)
    beyond = min(Truncation.stated(truncation).harmonics(line.period, line.size), line.size - 1)
    starts = np.unique(np.r_[0, edges, beyond])
    return starts[starts < line.size]


def influence(system: Sized, line: Line, energy: FloatArray, truncation: float | None, alike: float) -> Influence:
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

    Returns
    -------
    Influence
        Per band and output.
    """
    starts = _bands(line, truncation)
    omega = line.omega((starts + np.r_[starts[1:], line.size] - 1) // 2)
    batch = BATCH.frequencies(system.ports**2)
    cases = energy.reshape(-1, *energy.shape[-2:])
    power = np.add.reduceat(cases, starts, axis=2)
    shares: list[Share] = []
    total, first = np.zeros(0), 0
    for some in np.split(omega, range(batch, omega.size, batch)):
        here = slice(first, first + some.size)
        gains = system.per_unit(some)
        if not shares:
            # Gains of many contacts are many; half of the digits tell what is negligible.
            ports, outputs, _ = gains[0].shape
            shape = len(cases), outputs, omega.size
            shares = [Share(np.empty((ports, *shape[1:]), np.float32), np.empty(shape)) for _ in gains]
            total = np.zeros(shape[:2])
        for share, gain in zip(shares, gains, strict=True):
            share.gain[..., here] = gain
            share.energy[..., here] = np.einsum("cob,ncb->nob", gain, np.sqrt(power[..., here])) ** 2
        total += np.einsum("cob,cob,ncb->no", gains[-1], gains[-1], power[..., here])
        first += some.size
    ends = np.cumsum(system.kinds)
    kinds = np.split(total, ends[:-1], axis=1)
    least = [np.broadcast_to(kind.max(axis=1, initial=0.0, keepdims=True), kind.shape) for kind in kinds]
    return Influence(
        starts=starts,
        added=shares[0],
        whole=shares[1],
        total=total,
        least=alike**2 * np.concatenate(least, axis=1),
        lines=line.size,
    )


def quotient(part: FloatArray, whole: FloatArray) -> FloatArray:
    """Quotient of two energies; nothing of nothing is nothing."""
    whole = np.broadcast_to(whole, part.shape)
    return np.divide(part, whole, out=np.zeros_like(part), where=whole > 0)

"""How much the guideway matters beyond a frequency, and from which frequency on it may count as rigid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import ComplexArray, FloatArray, IntArray
from movingfrf.response.batches import matrix_product, solve_contacts
from movingfrf.response.line import SpectralGrid
from movingfrf.response.system import Sample, System


@dataclass(frozen=True, slots=True, kw_only=True)
class TruncationSearch:
    """What tunes the search for the truncation; in brackets, between what each number is safe."""

    # The change in any output that a rigid road beyond the truncation may make is 1e-6, relative L2. The spectra
    # are those of records under an exponential window; undoing it raises what was cut early against what comes
    # late.
    negligible: float = 3e-8  # [1e-9 to 1e-7]
    # Bands, equally wide in the logarithm, within which the system counts as constant.
    bands: int = 160  # [80 to 640]


TRUNCATION = TruncationSearch()


class Influence(NamedTuple):
    """What the compliance of the guideway adds to every output, band by band.

    Outputs are force and deflection at each contact, motion and acceleration of each degree of freedom.
    """

    starts: IntArray  # (band,) number of the first frequency
    change: FloatArray  # (band, output, contact) magnitude per roughness
    energy: FloatArray  # (band, output) upper bound of the energy that the change carries
    total: FloatArray  # (output,) energy of the whole output


def bands(grid: SpectralGrid) -> IntArray:
    """Give the number of the first frequency of each band; one band begins at the grid's truncation."""
    edges = np.geomspace(1, grid.size, TRUNCATION.bands + 1).astype(int)
    starts = np.unique(np.r_[0, edges, min(grid.untouched, grid.size - 1)])
    return starts[starts < grid.size]


def middles(starts: IntArray, grid: SpectralGrid) -> ComplexArray:
    """Frequency in the middle of each band [rad/s]."""
    return grid.omega((starts + np.r_[starts[1:], grid.size] - 1) // 2)


def guideway_influence(system: System, starts: IntArray, sample: Sample, roughness: ComplexArray) -> Influence:
    """Estimate the guideway's part in every output from the system at the middle of each band.

    A rigid road changes the displacement under the contacts by −W, hence the force by D W and the motion by
    −H W. Over a band, √energy ≤ Σ_j |change per roughness under contact j| · √(energy of that roughness).

    Parameters
    ----------
    system : System
        Vehicle and road.
    starts : ndarray, shape (band,)
        What `bands` returned.
    sample : Sample
        Both sides at the `middles` of the bands.
    roughness : ndarray, shape (frequency, contact)
        Spectra of the elevation under the contacts [m s].

    Returns
    -------
    Influence
        Per band and output.
    """
    omega, frf, stiffness = sample
    unit = np.broadcast_to(np.eye(frf.shape[1], dtype=complex), frf.shape)
    force = solve_contacts(frf, stiffness, unit)
    deflection = matrix_product(frf, force)
    moved = _motions(system, omega, deflection)
    motion = moved - _motions(system, omega, unit)
    squared = np.abs(omega[:, None, None]) ** 2
    pushed = matrix_product(stiffness, deflection)
    change = np.abs(np.concatenate([pushed, deflection, moved, squared * moved], axis=1))
    whole = np.abs(np.concatenate([force, deflection, motion, squared * motion], axis=1))
    power = np.add.reduceat(roughness.real**2 + roughness.imag**2, starts, axis=0)
    energy = np.einsum("boc,bc->bo", change, np.sqrt(power)) ** 2
    total = np.einsum("boc,bc->o", whole**2, power)
    return Influence(starts, change, energy, total)


def _motions(system: System, omega: ComplexArray, displacement: ComplexArray) -> ComplexArray:
    """Motion per displacement below the contacts, one case after the other, shape (frequency, dof, case)."""
    cases = range(displacement.shape[2])
    return np.stack([system.motion(omega, displacement[:, :, case]) for case in cases], axis=2)


def truncation_error(found: Influence, kept: int) -> float:
    """Greatest relative change of any output if the road is rigid from frequency number `kept` on."""
    beyond = found.energy[found.starts >= kept].sum(axis=0)
    return float(np.sqrt(_relative(beyond, found.total).max(initial=0.0)))


def first_negligible(found: Influence, roughness: ComplexArray) -> int:
    """Find the lowest frequency from which on a rigid road changes no output by more than 1e-6.

    Parameters
    ----------
    found : Influence
        What `guideway_influence` returned.
    roughness : ndarray, shape (frequency, contact)
        Spectra of the elevation under the contacts [m s].

    Returns
    -------
    int
        Number of the frequency; the number of frequencies if there is no such frequency.
    """
    allowed = TRUNCATION.negligible**2
    beyond = np.cumsum(found.energy[::-1], axis=0)[::-1]
    harmful_bands = np.flatnonzero((_relative(beyond, found.total) > allowed).any(axis=1))
    if not harmful_bands.size:
        return 0
    band = int(harmful_bands[-1]) + 1
    # Within the last harmful band, frequency by frequency.
    first = found.starts[band - 1]
    last = found.starts[band] if band < len(found.starts) else len(roughness)
    each = (np.abs(roughness[first:last]) @ found.change[band - 1].T) ** 2
    tail = np.cumsum(each[::-1], axis=0)[::-1] + (beyond[band] if band < len(beyond) else 0.0)
    harmful = np.flatnonzero((_relative(tail, found.total) > allowed).any(axis=1))
    return int(first + harmful[-1] + 1) if harmful.size else int(first)


def _relative(part: FloatArray, whole: FloatArray) -> FloatArray:
    """Quotient of two energies; nothing of nothing is nothing."""
    return np.divide(part, whole, out=np.zeros_like(part), where=whole > 0)

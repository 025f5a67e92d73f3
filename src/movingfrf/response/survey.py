"""What is to be known of a system before it is solved: steady travel, stability, truncation, findings."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import islice
from typing import NamedTuple

import numpy as np

import movingfrf.results.findings as find
from movingfrf._basics.arrays import ComplexArray, FloatArray, IntArray
from movingfrf.guideways.guideway import findings_of
from movingfrf.response.batches import BATCH, applied, unthreaded
from movingfrf.response.line import Line
from movingfrf.response.stability import along_the_axis, require_stable, stretches
from movingfrf.response.system import System, Tables
from movingfrf.response.truncation import EVERYWHERE, TRUNCATION, Truncation


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SteadyState:
    """Travel on a smooth road: what is constant in time.

    Parameters
    ----------
    load : ndarray, shape (contact,)
        Contact forces [N].
    deflection : ndarray, shape (contact,)
        Deflection under each contact [m].
    """

    load: FloatArray
    deflection: FloatArray


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Survey:
    """What is to be known of a system before it is solved.

    Parameters
    ----------
    steady : SteadyState
        Travel on a smooth road.
    critical_speed : float
        Of the guideway [m/s].
    truncation : Truncation
        Where the guideway may begin to count as rigid, and what that changes.
    findings : tuple of Finding
        What a user should know.
    """

    steady: SteadyState
    critical_speed: float
    truncation: Truncation
    findings: tuple[find.Finding, ...]


class Excited(NamedTuple):
    """What a record excites a system by, and what is said of its truncation."""

    line: Line
    roughness: ComplexArray  # (*case, contact, frequency) spectra of the elevation under the contacts [m s]
    truncation: float | None  # [Hz]; None: the lowest one that changes no output by more than 1e-6, relative L2


def survey(system: System, excited: Excited | None = None) -> Survey:
    """Look at a system before it is solved.

    Parameters
    ----------
    system : System
        Vehicle and road.
    excited : Excited, optional
        The record that is to be solved; without one nothing is truncated.

    Returns
    -------
    Survey
        Steady state, critical speed, truncation and findings.

    Raises
    ------
    SolveError
        If vehicle and guideway are unstable together.
    """
    critical_speed = float(system.guideway.critical_speed)
    findings = [*find.near_critical(system.speed, critical_speed), *findings_of(system.guideway)]
    batch = BATCH.frequencies(system.entries)
    path = stretches(along_the_axis(system.vehicle, system.speed), batch)
    starts = np.zeros(0, int) if excited is None else bands(excited)
    among = np.zeros(0, complex) if excited is None else middles(starts, excited.line)
    pieces = [among[first : first + batch] for first in range(0, among.size, batch)]
    with unthreaded():
        tables = system.at_each([np.zeros(1, complex), *path, *pieces])
        steady = steady_state(system, next(tables))
        require_stable(system, islice(tables, len(path)))
        truncation = EVERYWHERE
        if excited is not None:
            truncation = _truncation(guideway_influence(system, starts, tables, excited.roughness), excited)
            findings = [*findings, *find.beyond_truncation(truncation.frequency, truncation.error)]
    return Survey(steady=steady, critical_speed=critical_speed, truncation=truncation, findings=tuple(findings))


def _truncation(influence: Influence, excited: Excited) -> Truncation:
    """Take the truncation that is stated, or find one; and what it changes."""
    line, frequency = excited.line, excited.truncation
    if frequency is None:
        kept = first_negligible(influence, excited.roughness)
        # Where the response to rest alone is kept, some frequency below the next.
        frequency = max(kept - 1, 0.5 * (kept > 0)) / line.period
    untouched = Truncation(frequency=frequency).untouched(line.omega())
    return Truncation(frequency=frequency, error=influence.error(untouched))


def steady_state(system: System, at_rest: Tables) -> SteadyState:
    """Steady travel on a smooth road.

    Parameters
    ----------
    system : System
        Vehicle and road.
    at_rest : Tables
        Both sides at ω = 0.

    Returns
    -------
    SteadyState
        Loads and deflections. With more contacts than rigid motions the sag of the road redistributes the
        weight: (I + D G) F₀ = F_s at ω = 0.
    """
    load = at_rest.shared(system.vehicle.static_loads[:, None] + 0j)[:, 0].real
    return SteadyState(load=load, deflection=at_rest.frf[..., 0].real @ load)


class Influence(NamedTuple):
    """What the compliance of the guideway adds to every output, band by band.

    Outputs are force and deflection at each contact, motion and acceleration of each degree of freedom.
    """

    starts: IntArray  # (band,) number of the first frequency
    change: FloatArray  # (source contact, output, band) magnitude per roughness
    energy: FloatArray  # (case, output, band) upper bound of the energy that the change carries
    total: FloatArray  # (case, output) energy of the whole output

    def error(self, kept: int) -> float:
        """Greatest relative change of any output if the road is rigid from frequency number `kept` on."""
        beyond = self.energy[:, :, self.starts >= kept].sum(axis=2)
        return float(np.sqrt(_relative(beyond, self.total).max(initial=0.0)))


def bands(excited: Excited) -> IntArray:
    """Give the number of the first frequency of each band; one band begins beyond a stated truncation."""
    line, stated = excited.line, excited.truncation
    edges = np.geomspace(1, line.size, TRUNCATION.bands + 1).astype(int)
    cut = EVERYWHERE if stated is None else Truncation(frequency=stated)
    beyond = min(cut.untouched(line.omega()), line.size - 1)
    starts = np.unique(np.r_[0, edges, beyond])
    return starts[starts < line.size]


def middles(starts: IntArray, line: Line) -> ComplexArray:
    """Frequency in the middle of each band [rad/s]."""
    return line.omega((starts + np.r_[starts[1:], line.size] - 1) // 2)


def guideway_influence(
    system: System, starts: IntArray, tables: Iterable[Tables], roughness: ComplexArray
) -> Influence:
    """Estimate the guideway's part in every output from the system at the middle of each band.

    A rigid road changes the displacement under the contacts by −W, hence the force by D W and the motion by
    −H W. Over a band, √energy ≤ Σ_j |change per roughness under contact j| · √(energy of that roughness).

    Parameters
    ----------
    system : System
        Vehicle and road.
    starts : ndarray, shape (band,)
        What `bands` returned.
    tables : iterable of Tables
        Both sides at the `middles` of the bands, piece by piece.
    roughness : ndarray, shape (*case, contact, frequency)
        Spectra of the elevation under the contacts [m s].

    Returns
    -------
    Influence
        Per band and output.
    """
    cases = roughness.reshape(-1, *roughness.shape[-2:])
    power = np.add.reduceat(cases.real**2 + cases.imag**2, starts, axis=2)
    changes, energies, total, band = [], [], 0.0, 0
    for piece in tables:
        change, whole = _per_roughness(system, piece)
        here = power[..., band : band + piece.omega.size]
        changes.append(change)
        energies.append(np.einsum("cob,ncb->nob", change, np.sqrt(here)) ** 2)
        total = total + np.einsum("cob,ncb->no", whole**2, here)
        band += piece.omega.size
    return Influence(starts, np.concatenate(changes, axis=2), np.concatenate(energies, axis=2), np.asarray(total))


def _per_roughness(system: System, tables: Tables) -> tuple[FloatArray, FloatArray]:
    """Magnitudes per roughness of what the guideway adds and of the whole, (source contact, output, frequency)."""
    omega = tables.omega
    # One case per contact under which the road is rough.
    unit, force = tables.unit, tables.forces(tables.unit)
    deflection = applied(tables.frf, force)
    moved, pushed = system.dynamics.response(omega, deflection)
    motion = moved - system.dynamics.response(omega, unit)[0]
    squared = np.abs(omega) ** 2
    change = np.concatenate([pushed, deflection, moved, squared * moved], axis=1)
    whole = np.concatenate([force, deflection, motion, squared * motion], axis=1)
    return np.abs(change), np.abs(whole)


def first_negligible(found: Influence, roughness: ComplexArray) -> int:
    """Find the lowest frequency from which on a rigid road changes no output of any case by more than 1e-6.

    Parameters
    ----------
    found : Influence
        What `guideway_influence` returned.
    roughness : ndarray, shape (*case, contact, frequency)
        Spectra of the elevation under the contacts [m s].

    Returns
    -------
    int
        Number of the frequency; the number of frequencies if there is no such frequency.
    """
    allowed, total = TRUNCATION.negligible**2, found.total[:, :, None]
    beyond = np.cumsum(found.energy[:, :, ::-1], axis=2)[:, :, ::-1]
    harmful_bands = np.flatnonzero((_relative(beyond, total) > allowed).any(axis=(0, 1)))
    if not harmful_bands.size:
        return 0
    band = int(harmful_bands[-1]) + 1
    # Within the last harmful band, frequency by frequency.
    first = int(found.starts[band - 1])
    last = int(found.starts[band]) if band < len(found.starts) else roughness.shape[-1]
    cases = np.abs(roughness[..., first:last].reshape(-1, roughness.shape[-2], last - first))
    each = (found.change[:, :, band - 1].T @ cases) ** 2
    tail = np.cumsum(each[:, :, ::-1], axis=2)[:, :, ::-1]
    if band < len(found.starts):
        tail += beyond[:, :, band, None]
    harmful = np.flatnonzero((_relative(tail, total) > allowed).any(axis=(0, 1)))
    return int(first + harmful[-1] + 1) if harmful.size else first


def _relative(part: FloatArray, whole: FloatArray) -> FloatArray:
    """Quotient of two energies; nothing of nothing is nothing."""
    whole = np.broadcast_to(whole, part.shape)
    return np.divide(part, whole, out=np.zeros_like(part), where=whole > 0)

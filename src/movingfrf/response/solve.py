"""Where guideway and vehicle meet: one small linear system per frequency.

Below contact j the vehicle is moved by d = w − r, the deflection (down) less the elevation (up). It answers
with the dynamic force F = −D d, the guideway with w = G (F_s + F). In steady travel on a smooth road both are
constant; what the roughness adds to that state solves (I + D G) F = D R.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import ComplexArray
from movingfrf._basics.checks import SolveError
from movingfrf._basics.progress import Progress, silent
from movingfrf.response.batches import chunk_for, matrix_product, solve_contacts, unthreaded
from movingfrf.response.line import Histories, SpectralGrid
from movingfrf.response.system import System


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CoupledSpectra:
    """What the roughness adds to the steady state, along the grid's complex frequencies.

    Parameters
    ----------
    force : ndarray, shape (frequency, contact)
        Dynamic contact force [N s].
    deflection : ndarray, shape (kept frequency, contact)
        Dynamic deflection under each contact [m s]; zero beyond the truncation.
    motion : ndarray, shape (frequency, dof)
        Motion of the vehicle [m s or rad s].
    """

    force: ComplexArray
    deflection: ComplexArray
    motion: ComplexArray


def couple(
    system: System, roughness: ComplexArray, *, grid: SpectralGrid, progress: Progress = silent
) -> CoupledSpectra:
    """Couple guideway and vehicle over a rough road.

    Up to the grid's truncation the contact force solves (I + D G) F = D R; beyond it the road stiffens until it is
    rigid, G = 0.
    Either way the vehicle is then moved by d = G F − R and everything follows from d.

    Parameters
    ----------
    system : System
        Vehicle and road.
    roughness : ndarray, shape (frequency, contact)
        Spectra of the elevation under the contacts [m s].
    grid : SpectralGrid
        Frequencies and truncation.
    progress : callable
        Called with the name of the stage and the fraction of it that is done.

    Returns
    -------
    CoupledSpectra
        Dynamic contact force, deflection and vehicle motion.

    Raises
    ------
    SolveError
        If a result is not finite.
    """
    vehicle = system.vehicle
    # One channel after the other in memory, as the transforms read them.
    deflection = np.empty((len(vehicle.contacts), grid.kept), complex).T
    force = np.empty((len(vehicle.contacts), grid.size), complex).T
    motion = np.empty((len(vehicle.dof_names), grid.size), complex).T
    chunk = chunk_for(len(vehicle.contacts))
    with unthreaded(len(vehicle.contacts)):
        for first in range(0, grid.size, chunk):
            last = min(first + chunk, grid.size)
            omega = grid.omega(slice(first, last))
            displacement = -roughness[first:last]
            kept = max(min(last, grid.kept) - first, 0)
            if kept:
                _, frf, stiffness = system.sample(omega[:kept])
                frf = frf * grid.compliance(slice(first, first + kept))[:, None, None]
                forces = solve_contacts(frf, stiffness, roughness[first : first + kept, :, None])
                deflection[first : first + kept] = matrix_product(frf, forces)[:, :, 0]
                displacement[:kept] += deflection[first : first + kept]
            motion[first:last], force[first:last] = system.dynamics.response(omega, displacement)
            progress("coupling", last / grid.size)
    # A sum is finite only if all of its terms are.
    if not all(np.isfinite(part.sum()) for part in (deflection, force, motion)):
        raise SolveError(
            f"the coupled response at {system.speed:g} m/s exceeds the range of floating-point numbers"
        )
    return CoupledSpectra(force=force, deflection=deflection, motion=motion)


class CoupledHistories(NamedTuple):
    """Histories of what the roughness adds to the steady state."""

    force: Histories
    deflection: Histories
    motion: Histories
    acceleration: Histories


def histories(spectra: CoupledSpectra, grid: SpectralGrid) -> CoupledHistories:
    """Transform coupled spectra to time.

    Parameters
    ----------
    spectra : CoupledSpectra
        What `couple` returned.
    grid : SpectralGrid
        The grid they were computed on.

    Returns
    -------
    CoupledHistories
        Dynamic force [N], deflection [m], motion [m or rad] and acceleration [m/s² or rad/s²].
    """
    scratch = grid.scratch()
    return CoupledHistories(
        grid.to_histories(spectra.force, scratch=scratch),
        grid.to_histories(spectra.deflection, scratch=scratch),
        grid.to_histories(spectra.motion, scratch=scratch),
        grid.to_histories(spectra.motion, derivative=2, scratch=scratch),
    )


class Responses(NamedTuple):
    """What a roughness under the contacts adds to the steady state; every array (frequency, output, case)."""

    force: ComplexArray  # [N]
    deflection: ComplexArray  # [m]
    motion: ComplexArray  # [m or rad]


def responses(system: System, omega: ComplexArray, roughness: ComplexArray) -> Responses:
    """Solve the coupled system for any number of cases of roughness under the contacts.

    Parameters
    ----------
    system : System
        Vehicle and road.
    omega : ndarray, shape (frequency,)
        Angular frequency [rad/s].
    roughness : ndarray, shape (frequency, contact, case)
        Elevation under the contacts [m].

    Returns
    -------
    Responses
        Force and deflection at the contacts, and motion of the vehicle.

    Raises
    ------
    SolveError
        If a frequency is singular.
    """
    vehicle, cases = system.vehicle, roughness.shape[2]
    contacts, dofs = len(vehicle.contacts), len(vehicle.dof_names)
    found = Responses(*(np.empty((omega.size, outputs, cases), complex) for outputs in (contacts, contacts, dofs)))
    step = chunk_for(contacts)
    with unthreaded(contacts):
        for first in range(0, omega.size, step):
            some = slice(first, first + step)
            _, frf, stiffness = system.sample(omega[some])
            found.force[some] = solve_contacts(frf, stiffness, roughness[some])
            found.deflection[some] = matrix_product(frf, found.force[some])
            displacement = found.deflection[some] - roughness[some]
            for case in range(cases):
                found.motion[some, :, case] = system.motion(omega[some], displacement[:, :, case])
    singular = ~np.isfinite(sum(np.abs(part).sum(axis=(1, 2)) for part in found))
    if singular.any():
        raise SolveError(
            f"vehicle and guideway have no finite response at {omega[singular][0].real / (2 * np.pi):.6g} Hz and "
            f"{system.speed:g} m/s: a vibration without damping is driven at its own frequency"
        )
    return found

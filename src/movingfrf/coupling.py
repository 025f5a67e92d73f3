"""Where guideway and vehicle meet: one small linear system per frequency.

Below contact j the vehicle is moved by d = w − r, the deflection (down) less the elevation (up). It answers
with the dynamic force F = −D d, the guideway with w = G (F_s + F). In steady travel on a smooth road both are
constant; what the roughness adds to that state solves (I + D G) F = D R.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from movingfrf._checks import ComplexArray, FloatArray, SolveError
from movingfrf.guideways.base import Guideway
from movingfrf.spectral import SpectralGrid
from movingfrf.vehicles.base import Vehicle

# Frequencies solved at a time: their arrays stay within the processor's cache.
CHUNK = 4096


Progress = Callable[[str, float], None]


def silent(stage: str, fraction: float) -> None:
    """Report no progress."""


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


def offsets(positions: FloatArray) -> FloatArray:
    """Receiver minus source for every pair of contacts, shape (receiver, source) [m]."""
    return positions[:, None] - positions


def contact_frf(guideway: Guideway, vehicle: Vehicle, speed: float, omega: ComplexArray) -> ComplexArray:
    """Evaluate the moving FRF between all contacts, shape (frequency, receiver, source) [m/N]."""
    across = offsets(np.array([contact.across for contact in vehicle.contacts]))
    return guideway.moving_frf(offsets(vehicle.positions), speed, omega, across=across)


def solve_contacts(frf: ComplexArray, stiffness: ComplexArray, gap: ComplexArray) -> ComplexArray:
    """Solve (I + D G) F = D R for each frequency.

    Parameters
    ----------
    frf : ndarray, shape (frequency, contact, contact)
        Moving FRF G [m/N].
    stiffness : ndarray, shape (frequency, contact, contact)
        Dynamic stiffness D of the vehicle [N/m].
    gap : ndarray, shape (frequency, contact, case)
        Elevation R under the contacts [m].

    Returns
    -------
    ndarray, shape (frequency, contact, case)
        Contact forces F [N].
    """
    count = frf.shape[1]
    system = np.eye(count) + product(stiffness, frf)
    right = product(stiffness, gap)
    if count == 1:
        return right / system
    if count == 2:  # Cramer's rule: several times faster than LAPACK on batches of this size
        (a, b), (c, d) = (system[:, row, :, None].swapaxes(0, 1) for row in range(2))
        determinant = a * d - b * c
        front, rear = right[:, 0], right[:, 1]
        solution = np.empty((2, *front.shape[::-1]), complex).T.swapaxes(1, 2)
        solution[:, 0] = (d * front - b * rear) / determinant
        solution[:, 1] = (a * rear - c * front) / determinant
        return solution
    return np.linalg.solve(system, right)


def product(left: ComplexArray, right: ComplexArray) -> ComplexArray:
    """Matrix product for each frequency, shapes (frequency, i, j) and (frequency, j, k)."""
    if left.shape[1] > 2:
        return left @ right
    # Up to two contacts the loops over i, j and k are the short ones: let the processor loop over frequency.
    return np.add.reduce([left[:, :, j, None] * right[:, j, None, :] for j in range(left.shape[2])])


def steady_state(guideway: Guideway, vehicle: Vehicle, speed: float) -> SteadyState:
    """Steady travel on a smooth road.

    Parameters
    ----------
    guideway : Guideway
        The road.
    vehicle : Vehicle
        The vehicle.
    speed : float
        Speed [m/s].

    Returns
    -------
    SteadyState
        Loads and deflections. With more contacts than rigid motions the sag of the road redistributes the
        weight: (I + D G) F₀ = F_s at ω = 0.
    """
    rest = np.zeros(1, complex)
    frf = contact_frf(guideway, vehicle, speed, rest)[0].real
    stiffness = vehicle.dynamic_stiffness(rest, None)[0].real
    load = np.linalg.solve(np.eye(len(frf)) + stiffness @ frf, vehicle.static_loads)
    return SteadyState(load=load, deflection=frf @ load)


def couple(
    guideway: Guideway,
    vehicle: Vehicle,
    roughness: ComplexArray,
    *,
    speed: float,
    grid: SpectralGrid,
    progress: Progress = silent,
) -> CoupledSpectra:
    """Couple guideway and vehicle over a rough road.

    Up to the grid's truncation the contact force solves (I + D G) F = D R; beyond it the road is rigid, G = 0.
    Either way the vehicle is then moved by d = G F − R and everything follows from d.

    Parameters
    ----------
    guideway : Guideway
        The road.
    vehicle : Vehicle
        The vehicle.
    roughness : ndarray, shape (frequency, contact)
        Spectra of the elevation under the contacts [m s].
    speed : float
        Speed [m/s].
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
    contacts, dofs = len(vehicle.contacts), len(vehicle.dof_names)
    modes = vehicle.modes()
    contact_map = vehicle.matrices[3]
    # One channel after the other in memory, as the transforms read them.
    deflection = np.empty((contacts, grid.kept), complex).T
    force = np.empty((contacts, grid.size), complex).T
    motion = np.empty((dofs, grid.size), complex).T
    for first in range(0, grid.size, CHUNK):
        last = min(first + CHUNK, grid.size)
        omega = grid.omega(slice(first, last))
        displacement = -roughness[first:last]
        kept = max(min(last, grid.kept) - first, 0)
        if kept:
            solved = omega[:kept]
            frf = contact_frf(guideway, vehicle, speed, solved)
            stiffness = vehicle.dynamic_stiffness(solved, modes)
            forces = solve_contacts(frf, stiffness, roughness[first : first + kept, :, None])
            deflection[first : first + kept] = product(frf, forces)[:, :, 0]
            displacement[:kept] += deflection[first : first + kept]
        springs = vehicle.contact_stiffness(omega)
        displacement *= springs
        moved = vehicle.motion(omega, displacement, modes)
        motion[first:last] = moved
        force[first:last] = springs * (contact_map @ moved.T).T - displacement
        progress("coupling", last / grid.size)
    if not all(np.isfinite(part).all() for part in (deflection, force, motion)):
        raise SolveError(f"the coupled response at {speed:g} m/s exceeds the range of floating-point numbers")
    return CoupledSpectra(force=force, deflection=deflection, motion=motion)

"""Where guideway and vehicle meet: one small linear system per frequency.

Below contact j the vehicle is moved by d = w − r, the deflection (down) less the elevation (up). It answers
with the dynamic force F = −D d, the guideway with w = G (F_s + F). In steady travel on a smooth road both are
constant; what the roughness adds to that state solves (I + D G) F = D R.
"""

from __future__ import annotations

from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from threadpoolctl import threadpool_limits

from movingfrf._basics.arrays import ComplexArray, FloatArray
from movingfrf._basics.checks import SolveError
from movingfrf._basics.progress import Progress, silent
from movingfrf.guideways.guideway import Guideway
from movingfrf.response.line import SpectralGrid
from movingfrf.vehicles.dynamics import Dynamics
from movingfrf.vehicles.vehicle import Vehicle

# Frequencies solved at a time: their arrays stay within the processor's cache. Of many contacts, fewer.
CHUNK, ENTRIES = 4096, 2**18


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


class Sample(NamedTuple):
    """Both sides of the contacts at some frequencies."""

    omega: ComplexArray  # (frequency,)
    frf: ComplexArray  # (frequency, receiver, source) [m/N]
    stiffness: ComplexArray  # (frequency, contact, contact) [N/m]

    def matrices(self) -> ComplexArray:
        """I + D G, shape (frequency, contact, contact): singular at the poles of the coupled system."""
        matrices: ComplexArray = np.eye(self.frf.shape[1]) + product(self.stiffness, self.frf)
        return matrices


@dataclass(frozen=True, slots=True, eq=False)
class System:
    """A guideway and a vehicle that travels on it; made by `joined`.

    Parameters
    ----------
    guideway : Guideway
        The road.
    vehicle : Vehicle
        The vehicle.
    speed : float
        Speed [m/s].
    dynamics : Dynamics
        What `vehicle.dynamics()` returns, computed once.
    """

    guideway: Guideway
    vehicle: Vehicle
    speed: float
    dynamics: Dynamics

    def sample(self, omega: ComplexArray) -> Sample:
        """Evaluate both sides at some frequencies [rad/s]."""
        frf = self.guideway.moving_frf(speed=self.speed, omega=omega, **self.vehicle.offsets)
        return Sample(omega, frf, self.dynamics.stiffness(omega))

    def samples(self, *omegas: ComplexArray) -> list[Sample]:
        """Evaluate both sides at several sets of frequencies [rad/s] in one go."""
        ends = np.cumsum([0, *(omega.size for omega in omegas)])
        whole = self.sample(np.concatenate(omegas))
        return [Sample(*(part[first:last] for part in whole)) for first, last in pairwise(ends)]

    def motion(self, omega: ComplexArray, displacement: ComplexArray) -> ComplexArray:
        """Motion of the vehicle (frequency, dof) that is displaced below its contacts (frequency, contact)."""
        return self.dynamics.response(omega, displacement)[0]


def joined(guideway: Guideway, vehicle: Vehicle, speed: float) -> System:
    """Put a vehicle on a guideway.

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
    System
        The two together.
    """
    return System(guideway, vehicle, speed, vehicle.dynamics())


def chunk_for(contacts: int) -> int:
    """Frequencies to solve at a time with so many contacts."""
    return max(min(CHUNK, ENTRIES // contacts**2), 16)


def unthreaded(contacts: int) -> AbstractContextManager[object]:
    """Keep LAPACK to one thread: many small matrices gain nothing by two, and lose tenfold if one has to wait."""
    return threadpool_limits(limits=1) if contacts > 2 else nullcontext()


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


def steady_state(system: System, at_rest: Sample) -> SteadyState:
    """Steady travel on a smooth road.

    Parameters
    ----------
    system : System
        Vehicle and road.
    at_rest : Sample
        Both sides at ω = 0.

    Returns
    -------
    SteadyState
        Loads and deflections. With more contacts than rigid motions the sag of the road redistributes the
        weight: (I + D G) F₀ = F_s at ω = 0.
    """
    frf, stiffness = at_rest.frf[0].real, at_rest.stiffness[0].real
    load = np.linalg.solve(np.eye(len(frf)) + stiffness @ frf, system.vehicle.static_loads)
    return SteadyState(load=load, deflection=frf @ load)


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
                deflection[first : first + kept] = product(frf, forces)[:, :, 0]
                displacement[:kept] += deflection[first : first + kept]
            motion[first:last], force[first:last] = system.dynamics.response(omega, displacement)
            progress("coupling", last / grid.size)
    # A sum is finite only if all of its terms are.
    if not all(np.isfinite(part.sum()) for part in (deflection, force, motion)):
        raise SolveError(
            f"the coupled response at {system.speed:g} m/s exceeds the range of floating-point numbers"
        )
    return CoupledSpectra(force=force, deflection=deflection, motion=motion)

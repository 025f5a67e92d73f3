"""Guideway and vehicle at the contacts, and their steady travel on a smooth road."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import ComplexArray, FloatArray
from movingfrf.guideways.guideway import Guideway
from movingfrf.response.batches import matrix_product
from movingfrf.vehicles.dynamics import Dynamics
from movingfrf.vehicles.vehicle import Vehicle


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


class Sample(NamedTuple):
    """Both sides of the contacts at some frequencies."""

    omega: ComplexArray  # (frequency,)
    frf: ComplexArray  # (frequency, receiver, source) [m/N]
    stiffness: ComplexArray  # (frequency, contact, contact) [N/m]

    def matrices(self) -> ComplexArray:
        """I + D G, shape (frequency, contact, contact): singular at the poles of the coupled system."""
        matrices: ComplexArray = np.eye(self.frf.shape[1]) + matrix_product(self.stiffness, self.frf)
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

"""What ties a wheel to the guideway within a time step."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf.vehicles.vehicle import Vehicle


class Tie(NamedTuple):
    """What happens at the contacts: a vehicle on springs and dashpots, or nothing but prescribed forces."""

    mass: FloatArray  # (dof, dof)
    damping: FloatArray  # (dof, dof)
    stiffness: FloatArray  # (dof, dof)
    contact_map: FloatArray  # (contact, dof)
    springs: FloatArray  # (contact,) [N/m]
    dashpots: FloatArray  # (contact,) [N s/m]


def tie_of(vehicle: Vehicle) -> Tie:
    """Matrices of a vehicle without its contacts, and its contacts."""
    if np.isinf(vehicle.springs).any():
        raise ValueError(
            "the vehicle has rigid contacts (stiffness = inf), which the time-stepping methods do not know: give "
            "each contact a finite stiffness [N/m]"
        )
    mass, damping, stiffness, contact_map = (np.ascontiguousarray(matrix) for matrix in vehicle.matrices)
    return Tie(mass, damping, stiffness, contact_map, vehicle.springs, vehicle.dashpots)


def stiffness_at_rest(tie: Tie) -> FloatArray:
    """Force at the contacts per constant displacement below them [N/m], shape (contact, contact).

    More of them than the vehicle has rigid motions share the weight as the guideway sags.
    """
    pushed = tie.contact_map.T * tie.springs
    held = tie.stiffness + pushed @ tie.contact_map
    return np.diag(tie.springs) - pushed.T @ np.linalg.solve(held, pushed)


def no_vehicle(contacts: int) -> Tie:
    """Prescribed forces only."""
    none = np.zeros((0, 0))
    return Tie(none, none, none, np.zeros((contacts, 0)), np.zeros(contacts), np.zeros(contacts))

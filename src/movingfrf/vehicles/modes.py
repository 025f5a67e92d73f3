"""The vibrations of a vehicle on a rigid road, described."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from movingfrf._basics.arrays import ComplexArray, FloatArray
from movingfrf._basics.values import Listed, Value
from movingfrf._basics.wording import number
from movingfrf.vehicles.dynamics import state_matrix
from movingfrf.vehicles.vehicle import Vehicle, require_vehicle


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Mode(Value):
    """One vibration of a vehicle on its contact springs, the guideway rigid."""

    heads: ClassVar = ("frequency", "damping", "what moves")

    pole: complex  # [rad/s]
    shape: ComplexArray  # (dof,), its largest entry 1
    share: FloatArray  # (dof,) of the kinetic energy, their sum 1; see `vehicle_modes`
    description: str

    @property
    def frequency(self) -> float:
        """Magnitude of the pole over 2π [Hz]."""
        return abs(self.pole) / (2 * np.pi)

    @property
    def damping_ratio(self) -> float:
        """Share of critical damping; 1 for a motion that does not swing."""
        return float(-self.pole.real / abs(self.pole))

    def told(self) -> list[tuple[str, str]]:
        """Tell frequency, damping and what moves, in few digits."""
        return list(zip(self.heads, self._cells(), strict=True))

    def _cells(self) -> tuple[str, str, str]:
        damping = f"{number(100 * self.damping_ratio, 3)} % of critical"
        return (
            f"{number(self.frequency)} Hz",
            damping if abs(self.damping_ratio) > 1e-9 else "none",
            self.description,
        )


def vehicle_modes(vehicle: Vehicle) -> list[Mode]:
    """Vibrations of a vehicle on a rigid road, with what moves in each.

    A degree of freedom has the share |q_j|²/(M⁻¹)_jj, its kinetic energy where the mass matrix is diagonal. Where
    it is not, as behind a hinge, 1/(M⁻¹)_jj is its mass when all others are free to move.

    Parameters
    ----------
    vehicle : Vehicle
        Any vehicle.

    Returns
    -------
    list of Mode
        By ascending frequency, shown as a table; a motion that does not swing appears as two.

    Examples
    --------
    >>> import movingfrf as mf
    >>> car = mf.quarter_car(body_mass=400.0, wheel_mass=40.0, suspension_stiffness=2e4,
    ...                      suspension_damping=1.5e3, tyre_stiffness=2e5)
    >>> [mode.description for mode in vehicle_modes(car)]
    ['body 100 %', 'wheel 98 %']
    """
    require_vehicle(vehicle)
    mobility, found = np.diag(np.linalg.inv(vehicle.matrices[0])), []
    for part in vehicle.dynamics().parts:
        if not len(part.own.constant):
            continue
        poles, vectors = np.linalg.eig(state_matrix(part.own))
        shapes = part.motion.free @ vectors[: len(part.own.constant)]
        for pole, shape in zip(poles.astype(complex), shapes.T, strict=True):
            if pole.imag < 0:
                continue
            whole = np.zeros(len(mobility), complex)
            whole[part.dofs] = shape / shape[np.abs(shape).argmax()]
            share = np.abs(whole) ** 2 / mobility
            share /= share.sum()
            found.append(Mode(complex(pole), whole, share, _described(vehicle.dof_names, share)))
    return Listed(sorted(found, key=lambda mode: abs(mode.pole)), Mode.heads, Mode._cells)


def _described(names: Sequence[str], share: FloatArray, *, least: float = 0.03) -> str:
    """Name what moves by at least a share (0.03, a convention), the strongest first."""
    strongest_first = np.argsort(-share, kind="stable").tolist()
    return ", ".join(f"{names[n]} {100 * share[n]:.0f} %" for n in strongest_first if share[n] >= least)

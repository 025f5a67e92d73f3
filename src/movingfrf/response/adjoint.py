"""How numbers that are made of a response change with vehicle, road and speed: one adjoint solution for all of it.

With z the motion of the vehicle, F the forces at its contacts, 1/k the yielding of these, and d = w − r, w = G F,

    A z + Bᵀ F = 0,   F/k = B z − d,   A = K + iωC − ω²M.

Where vehicle, guideway and road change, so do z, F and w: dA z + dBᵀ F is a force on the vehicle, and what is left
of (dB) z − d(1/k) F − dG F + dr acts like an elevation of the road. A number that changes by Re Σ (F̄ᴴ dF + w̄ᴴ dw +
z̄ᴴ dz) is asked the other way round. As A and k are symmetric, the response of the same vehicle to a displacement λ*
below its contacts and forces z̄* on it, with

    (I + Gᵀ D) λ* = F̄* + Gᵀ (w̄* + what of z̄* comes out at the contacts),

is a motion g* and contact forces δ*, and the number changes by

    Re Σ [ −gᴴ (dA z + dBᵀ F) − δᴴ (dB z − d(1/k) F + dr) + (w̄ + δ)ᴴ dG F ].

Nothing of this is solved for a key of its own: matrices, elevations and moving FRFs are evaluated a little to
either side of it, where they are smooth. Frequencies, window and truncation are those of the response.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import NamedTuple, Protocol

import numpy as np

from movingfrf._basics.arrays import ComplexArray, FloatArray
from movingfrf._basics.remembered import recalled
from movingfrf.guideways.guideway import Guideway
from movingfrf.metrics.slopes import Slope
from movingfrf.response.batches import BATCH, applied, solved
from movingfrf.response.survey import steady_state
from movingfrf.response.system import System, Tables
from movingfrf.response.truncation import Truncation
from movingfrf.roughness.road import Road
from movingfrf.vehicles.dynamics import Dynamics, Modes, Part, Quadratic
from movingfrf.vehicles.journey import Journey
from movingfrf.vehicles.vehicle import Vehicle


class Case(Protocol):
    """A vehicle on a rough road, as a scenario says it."""

    @property
    def guideway(self) -> Guideway:
        """The road or track."""
        ...

    @property
    def vehicle(self) -> Vehicle:
        """The vehicle."""
        ...

    @property
    def road(self) -> Road:
        """The profile, and what it stands for."""
        ...

    @property
    def journey(self) -> Journey:
        """How the vehicle travels."""
        ...


# A derivative: what to sum up, cases near by, each with its weight.
Stencil = Sequence[tuple[float, Case]]


class Wanted(NamedTuple):
    """By how much numbers change with what a vehicle and a road do, each (number, case, place, frequency)."""

    force: ComplexArray
    deflection: ComplexArray
    motion: ComplexArray


class Solution(NamedTuple):
    """What is known of a response; (case, place, frequency)."""

    system: System
    omega: ComplexArray  # (frequency,) [rad/s]
    truncation: Truncation
    force: ComplexArray
    deflection: ComplexArray  # as far as the guideway gives way
    motion: ComplexArray


def at_rest(system: System, slopes: Sequence[Slope], stencils: Sequence[Stencil]) -> FloatArray:
    """Say what changes of steady travel add.

    Parameters
    ----------
    system : System
        Vehicle and road.
    slopes : sequence of Slope
        How each measure changes with steady travel.
    stencils : sequence of stencils
        Cases near by, key by key.

    Returns
    -------
    ndarray, shape (measure, key)
        Derivatives [unit of the measure per unit of the key].
    """
    found = np.zeros((len(slopes), len(stencils)))
    if not any(slope.load or slope.sag for slope in slopes):
        return found
    for key, stencil in enumerate(stencils):
        for weight, case in stencil:
            near = System.of(case.guideway, case.vehicle, case.journey.speed)
            steady = steady_state(near, near.at(np.zeros(1, complex)))
            for number, slope in enumerate(slopes):
                if slope.load or slope.sag:
                    load, sag = steady.load[slope.place], steady.deflection[slope.place]
                    found[number, key] += weight * (slope.load * load + slope.sag * sag)
    return found


class _Answer(NamedTuple):
    """What the adjoint system answers, conjugate; each (number, case, place, frequency)."""

    motion: ComplexArray  # g*
    pressed: ComplexArray  # δ*
    below: ComplexArray  # (w̄ + δ)*


class _Matrices(NamedTuple):
    """How numbers change with the matrices of a vehicle, summed over cases and frequencies."""

    powers: FloatArray  # (3, number, dof, dof): with K, C and M
    contact_map: FloatArray  # (number, contact, dof)
    springs: FloatArray  # (number, contact)
    dashpots: FloatArray  # (number, contact)

    @classmethod
    def nothing(cls, numbers: int, contacts: int, dofs: int) -> _Matrices:
        """Begin with zero."""
        shapes = (3, numbers, dofs, dofs), (numbers, contacts, dofs), (numbers, contacts), (numbers, contacts)
        return cls(*map(np.zeros, shapes))

    def add(
        self, answer: _Answer, omega: ComplexArray, force: ComplexArray, motion: ComplexArray, yields: ComplexArray
    ) -> None:
        """Add some frequencies."""
        s = 1j * omega
        for power, total in enumerate(self.powers):
            total -= _summed(answer.motion * s**power, motion)
        self.contact_map[:] -= _summed(answer.motion, force).swapaxes(1, 2) + _summed(answer.pressed, motion)
        squeezed = -(answer.pressed * np.square(yields) * force).sum(axis=1)
        self.springs[:] += squeezed.real.sum(axis=-1)
        self.dashpots[:] += (s * squeezed).real.sum(axis=-1)

    def change(self, stencil: Stencil) -> FloatArray:
        """Give the derivative of each number along a key, shape (number,)."""
        total = np.zeros(self.springs.shape[0])
        for weight, case in stencil:
            mass, damping, stiffness, contact_map = case.vehicle.matrices
            springs = np.where(np.isinf(case.vehicle.springs), 0.0, case.vehicle.springs)
            part = self.springs @ springs + self.dashpots @ case.vehicle.dashpots
            matrices = stiffness, damping, mass, contact_map
            for sums, matrix in zip((*self.powers, self.contact_map), matrices, strict=True):
                part = part + np.tensordot(sums, matrix, axes=2)
            total += weight * part
        return total


def changes(
    known: Solution, wanted: Wanted, stencils: Sequence[Stencil], elevation: Callable[[Case], ComplexArray]
) -> FloatArray:
    """Say how numbers that are made of a response change along keys.

    Parameters
    ----------
    known : Solution
        The response.
    wanted : Wanted
        How each number changes with it.
    stencils : sequence of stencils
        Cases near by, key by key.
    elevation : callable
        What contacts see of the road in a case, (case, contact, frequency).

    Returns
    -------
    ndarray, shape (number, key)
        Derivatives, steady travel left out.
    """
    omega, vehicle, numbers = known.omega, known.system.vehicle, len(wanted.force)
    found = np.zeros((numbers, len(stencils)))
    roads = [
        np.sum([weight * elevation(case) for weight, case in stencil], axis=0) if _differ(stencil, _road) else None
        for stencil in stencils
    ]
    tracks = [stencil if _differ(stencil, _track) else None for stencil in stencils]
    sums = _Matrices.nothing(numbers, len(vehicle.contacts), len(vehicle.dof_names))
    kept = known.truncation.taper(omega)
    contact: ComplexArray = vehicle.springs[:, None] + 1j * omega * vehicle.dashpots[:, None]
    yields = 1.0 / contact  # nothing, where it is rigid
    for some in BATCH.some(omega.size, max(known.system.ports**2, numbers * len(vehicle.dof_names))):
        answer = _answered(known, wanted, some)
        here, force = omega[some], known.force[..., some]
        sums.add(answer, here, force, known.motion[..., some], yields[:, some])
        for key, (road, track) in enumerate(zip(roads, tracks, strict=True)):
            if road is not None:
                found[:, key] -= (answer.pressed * road[..., some]).real.sum(axis=(1, 2, 3))
            if track is not None and kept[some].any():
                yielding = applied(kept[some] * _of_tracks(track, here), force)
                found[:, key] += (answer.below * yielding).real.sum(axis=(1, 2, 3))
    return found + np.stack([sums.change(stencil) for stencil in stencils], axis=-1)


def _answered(known: Solution, wanted: Wanted, some: slice) -> _Answer:
    """Solve the adjoint system at some frequencies."""
    system, omega, kept = known.system, known.omega[some], known.truncation.taper(known.omega[some])
    force, deflection, motion = (np.conj(part[..., some]) for part in wanted)
    moved, pressed = _forced(system.dynamics, omega, motion)
    if kept.any():
        frf = kept * np.moveaxis(
            system.guideway.moving_frf(speed=system.speed, omega=omega, **system.vehicle.offsets), 0, -1
        )
        force = force + applied(frf.swapaxes(0, 1), _plus(pressed, deflection))
        tables = Tables(omega, frf, system.dynamics.stiffness(omega))
        force = solved(tables.matrix.swapaxes(0, 1), force)  # I + Gᵀ D is the transpose of I + D G
    answered, felt = system.dynamics.response(omega, force)
    pressed = pressed + felt
    return _Answer(moved + answered, pressed, _plus(pressed, deflection))


def _plus(pressed: ComplexArray, deflection: ComplexArray) -> ComplexArray:
    """Add what is there of deflections, which end where the guideway is rigid."""
    total = pressed.copy()
    total[..., : deflection.shape[-1]] += deflection
    return total


def _summed(left: ComplexArray, right: ComplexArray) -> FloatArray:
    """Sum products of two places over cases and frequencies, (number, place, place); right has no numbers."""
    numbers, cases, places, size = left.shape
    rows = np.moveaxis(left, 1, 2).reshape(numbers * places, cases * size)
    columns = np.moveaxis(right, 0, 1).reshape(right.shape[1], cases * size)
    products: FloatArray = (rows @ columns.T).real
    return products.reshape(numbers, places, -1)


def _forced(dynamics: Dynamics, omega: ComplexArray, force: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
    """Motion, and contact forces, of a vehicle under forces on its degrees of freedom, its contacts held."""
    motion = np.zeros_like(force)
    pressed = np.zeros((*force.shape[:-2], dynamics.contacts, omega.size), complex)
    if not force.any():
        return motion, pressed
    for part, dofs, below in dynamics.alike:
        pushed = force[..., dofs, :]
        free = part.motion.free.T @ pushed
        modes = recalled(part, "modes under forces", partial(_modes, part))
        moved: ComplexArray
        if not len(part.own.constant):
            moved = free
        elif modes is None:
            moved = solved(part.own.at(omega), free)
        else:
            entered = modes.entered[0]
            assert entered is not None
            moved = modes.shapes @ ((entered @ free) / (1j * omega - modes.poles[:, None]))
        motion[..., dofs, :] = part.motion.free @ moved
        pressed[..., below, :] = part.entry.transposed().times(omega, moved) + part.motion.prescribed.T @ pushed
    return motion, pressed


def _modes(part: Part) -> Modes | None:
    """Poles and residues of P⁻¹ between forces on the free coordinates and these."""
    free = len(part.own.constant)
    nothing = np.zeros((free, free))
    return Modes.of(part.own, Quadratic(np.eye(free), nothing, nothing))


def _differ(stencil: Stencil, of: Callable[[Case], tuple[object, ...]]) -> bool:
    """Tell whether a key changes something."""
    first, *others = (of(case) for _, case in stencil)
    return any(other != first for other in others)


def _road(case: Case) -> tuple[object, ...]:
    """Tell what contacts see of the road depends on."""
    touching = (np.asarray(each).tobytes() for each in case.vehicle.touching.values())
    return (case.road, case.journey, case.vehicle.across.tobytes(), *touching)


def _track(case: Case) -> tuple[object, ...]:
    """Tell what moving FRFs between contacts depend on."""
    vehicle = case.vehicle
    return case.guideway, case.journey.speed, vehicle.positions.tobytes(), vehicle.across.tobytes()


def _of_tracks(stencil: Stencil, omega: ComplexArray) -> ComplexArray:
    """Give the derivative of the moving FRFs between contacts, (contact, contact, frequency)."""
    found = (
        weight * case.guideway.moving_frf(speed=case.journey.speed, omega=omega, **case.vehicle.offsets)
        for weight, case in stencil
    )
    return np.moveaxis(np.sum([*found], axis=0), 0, -1)

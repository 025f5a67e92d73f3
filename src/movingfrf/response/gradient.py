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
from typing import NamedTuple, Protocol

import numpy as np
import scipy.fft

from movingfrf._basics.arrays import ComplexArray, FloatArray
from movingfrf._basics.remembered import recalled
from movingfrf.guideways.guideway import Guideway
from movingfrf.metrics.slopes import Slope
from movingfrf.response.batches import BATCH, applied, solved, unthreaded
from movingfrf.response.line import Given, Line
from movingfrf.response.random import Ensemble
from movingfrf.response.ride import Ride, excitation_of
from movingfrf.response.solve import solve
from movingfrf.response.survey import steady_state
from movingfrf.response.system import System, Tables
from movingfrf.response.truncation import EVERYWHERE, Truncation
from movingfrf.roughness.road import Road
from movingfrf.vehicles.dynamics import Modes, Part, Quadratic
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


@unthreaded
def gradient(ride: Ride, slopes: Sequence[Slope], stencils: Sequence[Stencil]) -> FloatArray:
    """Say how measures of a ride change with keys of its scenario.

    Parameters
    ----------
    ride : Ride
        The ride.
    slopes : sequence of Slope
        How each measure changes with the records of the ride.
    stencils : sequence of stencils
        Of each key the cases near by, and their weights [1/unit of the key].

    Returns
    -------
    ndarray, shape (measure, key)
        Derivatives [unit of the measure per unit of the key].
    """
    driven_by, response, line = ride.driven_by, ride.response, ride.driven_by.line
    omega = driven_by.omega
    known = Solution(ride.system, omega, driven_by.truncation, *response)

    def elevation(case: Case) -> ComplexArray:
        excitation = excitation_of(case.road.profile, case.vehicle, case.journey)
        return driven_by.likewise(Given(excitation.elevation(case.journey.speed * line.instants)))[None]

    wanted = Wanted(*(np.zeros((len(slopes), *part.shape), complex) for part in response))
    places = {
        "contact_force": (wanted.force, 0),
        "deflection": (wanted.deflection, 0),
        "acceleration": (wanted.motion, 2),
    }
    for number, slope in enumerate(slopes):
        if slope.weights.any():
            there, derivative = places[slope.record]
            size = there.shape[-1]
            seen = received(line, slope.weights, size, ride.finer)
            there[number, 0, slope.place] = seen * np.conj((1j * omega[:size]) ** derivative)
    return _changes(known, wanted, stencils, elevation) + _at_rest(ride.system, slopes, stencils)


class Statistic(NamedTuple):
    """How a statistic of a random response changes with the moments ∫ |W|² fᵏ S df of a quantity."""

    quantity: str  # contact_force, deflection, motion or acceleration
    place: int  # number of the contact or degree of freedom
    weights: FloatArray  # (frequency,) with its spectral density, bandwidth included [unit/(unit²/Hz)]
    load: float = 0.0  # … with the static load there [unit/N]
    sag: float = 0.0  # … with the static deflection there [unit/m]


@unthreaded
def random_gradient(
    case: Case, frequency: FloatArray, statistics: Sequence[Statistic], stencils: Sequence[Stencil]
) -> FloatArray:
    """Say how statistics of a random response change with keys of its scenario.

    Parameters
    ----------
    case : Case
        The vehicle on the road.
    frequency : ndarray, shape (frequency,)
        Those that the integrals need [Hz].
    statistics : sequence of Statistic
        How each changes with what vehicle and road do.
    stencils : sequence of stencils
        Of each key the cases near by, and their weights [1/unit of the key].

    Returns
    -------
    ndarray, shape (statistic, key)
        Derivatives [unit of the statistic per unit of the key].
    """
    omega = 2 * np.pi * frequency + 0j

    def elevation(case: Case) -> ComplexArray:
        spectrum, coherence = case.road.spectrum, case.road.coherence
        assert spectrum is not None
        shared = 1.0 if coherence is None else coherence
        ensemble = Ensemble(
            vehicle=case.vehicle, spectrum=spectrum, coherence=shared, speed=case.journey.speed
        )
        return ensemble.amplitudes(frequency)

    system = System.of(case.guideway, case.vehicle, case.journey.speed)
    response = solve(system, omega, elevation(case))
    wanted = Wanted(*(np.zeros((len(statistics), *part.shape), complex) for part in response))
    for number, (quantity, place, weights, _, _) in enumerate(statistics):
        kind = ("contact_force", "deflection", "motion", "acceleration").index(quantity)
        part = response[min(kind, 2)][:, place]
        wanted[min(kind, 2)][number, :, place] = 2.0 * weights * part * (omega.real**4 if kind == 3 else 1.0)
    known = Solution(system, omega, EVERYWHERE, *response)
    return _changes(known, wanted, stencils, elevation) + _at_rest(system, statistics, stencils)


def received(line: Line, weights: FloatArray, size: int, finer: int) -> ComplexArray:
    """Say how Σ weights · record changes with the spectrum of the record: transpose of `Line.records`.

    Parameters
    ----------
    line : Line
        The record.
    weights : ndarray, shape (time,)
        Of its values.
    size : int
        Frequencies of the spectrum.
    finer : int
        How many values there are for each step of the record.

    Returns
    -------
    ndarray, shape (frequency,)
        c with Σ weights · record = Re Σ c* X.
    """
    padded, step = line.padded * finer, line.time_step / finer
    growth = np.exp(line.decay * step * np.arange(weights.size)) / step
    half = scipy.fft.rfft(weights * growth, padded)
    # What a period of so many samples cannot tell from lower frequencies is these.
    number = np.arange(size) % padded
    below = number < half.size
    found: ComplexArray = np.where(
        below, half[np.minimum(number, half.size - 1)], np.conj(half[np.where(below, 0, padded - number)])
    )
    found *= 2.0 / padded
    found[0] *= 0.5
    return found


def _at_rest(
    system: System, slopes: Sequence[Slope] | Sequence[Statistic], stencils: Sequence[Stencil]
) -> FloatArray:
    """Say what changes of steady travel add, shape (measure, key)."""
    found = np.zeros((len(slopes), len(stencils)))
    if not any(slope.load or slope.sag for slope in slopes):
        return found
    for key, stencil in enumerate(stencils):
        for weight, case in stencil:
            near = System.of(case.guideway, case.vehicle, case.journey.speed)
            steady = steady_state(near, near.at(np.zeros(1, complex)))
            for number, slope in enumerate(slopes):
                if slope.load or slope.sag:
                    at_rest = slope.load * steady.load[slope.place] + slope.sag * steady.deflection[slope.place]
                    found[number, key] += weight * at_rest
    return found


class _Matrices(NamedTuple):
    """How numbers change with the matrices of a vehicle, summed over cases and frequencies."""

    powers: FloatArray  # (3, number, dof, dof): with K, C and M
    contact_map: FloatArray  # (number, contact, dof)
    springs: FloatArray  # (number, contact)
    dashpots: FloatArray  # (number, contact)

    def change(self, stencil: Stencil) -> FloatArray:
        """Derivative of each number along a key, shape (number,)."""
        total = np.zeros(self.springs.shape[0])
        for weight, case in stencil:
            mass, damping, stiffness, contact_map = case.vehicle.matrices
            springs = np.where(np.isinf(case.vehicle.springs), 0.0, case.vehicle.springs)
            part = self.springs @ springs + self.dashpots @ case.vehicle.dashpots
            for sums, matrix in zip((*self.powers, self.contact_map), (stiffness, damping, mass, contact_map)):
                part = part + np.tensordot(sums, matrix, axes=2)
            total += weight * part
        return total


def _changes(
    known: Solution, wanted: Wanted, stencils: Sequence[Stencil], elevation: Callable[[Case], ComplexArray]
) -> FloatArray:
    """Say how numbers change along keys, shape (number, key)."""
    system, omega, numbers = known.system, known.omega, len(wanted.force)
    dynamics, contacts, dofs = system.dynamics, system.dynamics.contacts, system.dynamics.dofs
    found = np.zeros((numbers, len(stencils)))
    roads = [
        sum(weight * elevation(case) for weight, case in stencil) if _differ(stencil, _road) else None
        for stencil in stencils
    ]
    softer = [stencil if _differ(stencil, _track) else None for stencil in stencils]
    sums = _Matrices(
        np.zeros((3, numbers, dofs, dofs)),
        np.zeros((numbers, contacts, dofs)),
        np.zeros((numbers, contacts)),
        np.zeros((numbers, contacts)),
    )
    reach, kept = known.truncation.reach(omega), known.truncation.taper(omega)
    rigid = np.isinf(system.vehicle.springs)
    contact = np.where(rigid, 1.0, system.vehicle.springs)[:, None] + 1j * omega * system.vehicle.dashpots[:, None]
    yields = ~rigid[:, None] / contact  # a rigid contact stays rigid
    for some in BATCH.some(omega.size, max(contacts**2, numbers * dofs)):
        here, share = omega[some], kept[some]
        force, motion = known.force[..., some], known.motion[..., some]
        pushed, moved, sagged = (part[..., some] for part in (wanted.force, wanted.motion, wanted.deflection))
        taken = np.conj(pushed)
        gives = bool(some.start < reach)
        out = _forced(dynamics.alike, here, np.conj(moved), contacts)
        if gives:
            frf = np.moveaxis(
                system.guideway.moving_frf(speed=system.speed, omega=here, **system.vehicle.offsets), 0, -1
            )
            frf = share * frf
            below = out[1].copy()
            below[..., : sagged.shape[-1]] += np.conj(sagged)
            taken = taken + applied(frf.swapaxes(0, 1), below)
            taken = solved(Tables(here, frf, dynamics.stiffness(here)).matrix.swapaxes(0, 1), taken)
        answered, pressed = dynamics.response(here, taken)
        answered, pressed = answered + out[0], pressed + out[1]  # conjugates of g and δ
        s = 1j * here
        for power, total in enumerate(sums.powers):
            total -= _summed(answered * s**power, motion)
        sums.contact_map[:] -= _summed(force, answered, across=True) + _summed(pressed, motion)
        squeezed = -(pressed * yields[:, some] ** 2 * force).sum(axis=1)
        sums.springs[:] += squeezed.real.sum(axis=-1)
        sums.dashpots[:] += (s * squeezed).real.sum(axis=-1)
        below = pressed.copy()
        below[..., : sagged.shape[-1]] += np.conj(sagged)
        for key, (road, tracks) in enumerate(zip(roads, softer, strict=True)):
            if road is not None:
                found[:, key] -= (pressed * road[..., some]).real.sum(axis=(1, 2, 3))
            if tracks is not None and gives:
                yielding = applied(share * _of_tracks(tracks, here), force)
                found[:, key] += (below * yielding).real.sum(axis=(1, 2, 3))
    return found + np.stack([sums.change(stencil) for stencil in stencils], axis=-1)


def _summed(left: ComplexArray, right: ComplexArray, *, across: bool = False) -> FloatArray:
    """Sum products of two places over cases and frequencies: (number, place, place)."""
    if across:  # the left one has no numbers
        return np.einsum("cif,ncjf->nij", left, right, optimize=True).real
    numbers, cases, places, size = left.shape
    rows = np.moveaxis(left, 1, 2).reshape(numbers * places, cases * size)
    columns = np.moveaxis(right, 0, 1).reshape(right.shape[1], cases * size)
    return (rows @ columns.T).real.reshape(numbers, places, -1)


def _forced(
    alike: Sequence[tuple[Part, np.ndarray, np.ndarray]], omega: ComplexArray, force: ComplexArray, contacts: int
) -> tuple[ComplexArray, ComplexArray]:
    """Motion, and contact forces, of a vehicle under forces on its degrees of freedom, its contacts held."""
    motion = np.zeros_like(force)
    pressed = np.zeros((*force.shape[:-2], contacts, omega.size), complex)
    if not force.any():
        return motion, pressed
    for part, dofs, below in alike:
        pushed = force[..., dofs, :]
        free = part.motion.free.T @ pushed
        modes = recalled(part, "modes under forces", lambda part=part: _modes(part))
        if modes is None:
            columns = np.moveaxis(free.reshape(-1, *free.shape[-2:]), (2, 1), (0, 1))
            found = np.linalg.solve(np.moveaxis(part.own.at(omega), -1, 0), columns)
            moved = np.moveaxis(found, (0, 1), (2, 1)).reshape(free.shape)
        elif modes.poles.size:
            entered = modes.entered[0]
            assert entered is not None
            moved = modes.shapes @ ((entered @ free) / (1j * omega - modes.poles[:, None]))
        else:
            moved = free
        motion[..., dofs, :] = part.motion.free @ moved
        pressed[..., below, :] = part.entry.transposed().times(omega, moved) + part.motion.prescribed.T @ pushed
    return motion, pressed


def _modes(part: Part) -> Modes | None:
    """Poles and residues of P⁻¹ between forces on the free coordinates and these."""
    free = len(part.own.constant)
    nothing = np.zeros((free, free))
    if not free:
        return None
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
    """Derivative of the moving FRFs between contacts, (contact, contact, frequency)."""
    total = 0.0
    for weight, case in stencil:
        found = case.guideway.moving_frf(speed=case.journey.speed, omega=omega, **case.vehicle.offsets)
        total = total + weight * np.moveaxis(found, 0, -1)
    return np.asarray(total)

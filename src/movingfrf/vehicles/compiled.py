"""A vehicle at its contacts from its modes, compiled by numba (the extra `fast`); `dynamics` has it in NumPy.

A few frequencies at a time, side by side as processors take them: columns of one array, whose rows hold real and
imaginary parts one below the other. What is a row here is the number of its real part. Where there are fewer
frequencies, the last one fills the rest.
"""

from __future__ import annotations

import numpy as np

from movingfrf._basics.loops import loop
from movingfrf.vehicles.dynamics import Numbers


@loop
def _clear(lanes, row):
    for k in range(lanes.shape[1]):
        lanes[row, k] = 0.0
        lanes[row + 1, k] = 0.0


@loop
def _add(lanes, row, factor, other):
    """Add a number times some values."""
    x, y = factor.real, factor.imag
    for k in range(lanes.shape[1]):
        real, imaginary = lanes[other, k], lanes[other + 1, k]
        lanes[row, k] += x * real - y * imaginary
        lanes[row + 1, k] += x * imaginary + y * real


@loop
def _add_real(lanes, row, factor, other):
    """Add a real number times some values."""
    for k in range(lanes.shape[1]):
        lanes[row, k] += factor * lanes[other, k]
        lanes[row + 1, k] += factor * lanes[other + 1, k]


@loop
def _multiply(lanes, row, factor):
    """Multiply some values by others."""
    for k in range(lanes.shape[1]):
        real, imaginary = lanes[row, k], lanes[row + 1, k]
        lanes[row, k] = real * lanes[factor, k] - imaginary * lanes[factor + 1, k]
        lanes[row + 1, k] = real * lanes[factor + 1, k] + imaginary * lanes[factor, k]


@loop
def _admittances(omega, first, poles, lanes, s, into):
    """Store iω and 1/(iω − λ) for every pole λ."""
    for k in range(lanes.shape[1]):
        at = min(first + k, omega.size - 1)
        lanes[s, k] = -omega[at].imag
        lanes[s + 1, k] = omega[at].real
    for m in range(poles.size):
        x, y, row = poles[m].real, poles[m].imag, into + 2 * m
        for k in range(lanes.shape[1]):
            real, imaginary = lanes[s, k] - x, lanes[s + 1, k] - y
            share = 1.0 / (real * real + imaginary * imaginary)
            lanes[row, k] = real * share
            lanes[row + 1, k] = -imaginary * share


@loop
def stiffness(vehicle, omega):
    """Dynamic stiffness at the contacts of a part; as `Part.stiffness`."""
    poles, carried, direct, _, _, _, _, together = vehicle
    powers, entries, modes = carried.shape
    contacts = direct.shape[1]
    found = np.empty((entries, omega.size), np.complex128)
    s, total, admittances = 0, 2, 4
    lanes = np.empty((4 + 2 * modes, together))
    for first in range(0, omega.size, together):
        _admittances(omega, first, poles, lanes, s, admittances)
        for entry in range(entries):
            _clear(lanes, total)
            for power in range(powers - 1, -1, -1):
                if power < powers - 1:
                    _multiply(lanes, total, s)
                for m in range(modes):
                    _add(lanes, total, -carried[power, entry, m], admittances + 2 * m)
                held = direct[power, entry // contacts, entry % contacts]
                for k in range(together):
                    lanes[total, k] += held
            for k in range(min(together, omega.size - first)):
                found[entry, first + k] = complex(lanes[total, k], lanes[total + 1, k])
    return found


@loop
def response(vehicle, omega, displacement, held):
    """Motion and contact force of a part for a displacement, this from frequency number `held` on.

    As `Part.response`.
    """
    poles, _, direct, entered, moving, pushing, prescribed, together = vehicle
    cases, contacts, frequencies = displacement.shape
    powers, modes, dofs = len(entered), poles.size, len(moving)
    moved = np.empty((cases, dofs, frequencies), np.complex128)
    force = np.empty((cases, contacts, frequencies), np.complex128)
    s, total, admittances = 0, 2, 4
    modal = admittances + 2 * modes
    below = modal + 2 * modes
    lanes = np.empty((below + 2 * contacts, together))
    for first in range(0, frequencies, together):
        count = min(together, frequencies - first)
        _admittances(omega, first, poles, lanes, s, admittances)
        for case in range(cases):
            for c in range(contacts):
                for k in range(together):
                    here = displacement[case, c, first + min(k, count - 1)]
                    lanes[below + 2 * c, k] = here.real
                    lanes[below + 2 * c + 1, k] = here.imag
            for m in range(modes):
                mode = modal + 2 * m
                _clear(lanes, mode)
                for power in range(powers - 1, -1, -1):
                    if power < powers - 1:
                        _multiply(lanes, mode, s)
                    for c in range(contacts):
                        _add(lanes, mode, entered[power, m, c], below + 2 * c)
                _multiply(lanes, mode, admittances + 2 * m)
            for dof in range(dofs):
                _clear(lanes, total)
                for m in range(modes):
                    _add(lanes, total, moving[dof, m], modal + 2 * m)
                for c in range(prescribed.shape[1]):
                    _add_real(lanes, total, prescribed[dof, c], below + 2 * c)
                for k in range(count):
                    moved[case, dof, first + k] = complex(lanes[total, k], lanes[total + 1, k])
            for c in range(contacts if first + count > held else 0):
                _clear(lanes, total)
                for power in range(powers - 1, -1, -1):
                    if power < powers - 1:
                        _multiply(lanes, total, s)
                    for m in range(modes):
                        _add(lanes, total, pushing[power, c, m], modal + 2 * m)
                    for source in range(contacts):
                        _add_real(lanes, total, -direct[power, c, source], below + 2 * source)
                for k in range(count):
                    force[case, c, first + k] = complex(lanes[total, k], lanes[total + 1, k])
    return moved, force


def ready():
    """Compile what is here, or load it, for arrays as they are handed over."""
    omega, poles, direct = np.array([1 - 0.1j]), np.array([-1 + 0j]), np.ones((1, 1, 1))
    coefficients, moving, prescribed = np.ones((1, 1, 1), complex), np.ones((1, 1), complex), np.zeros((1, 0))
    for known in (poles, direct, coefficients, moving, prescribed):
        known.setflags(write=False)
    vehicle = Numbers(poles, coefficients, direct, coefficients, moving, coefficients, prescribed, 1)
    stiffness(vehicle, omega)
    response(vehicle, omega, np.ones((1, 1, 1), complex), 0)

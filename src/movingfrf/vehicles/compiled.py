"""A vehicle at its contacts from its modes, compiled by numba (the extra `fast`); `dynamics` has it in NumPy.

A few frequencies at a time, real and imaginary parts apart, side by side as processors take them.
"""

from __future__ import annotations

import numpy as np

from movingfrf._basics.loops import loop
from movingfrf.vehicles.dynamics import Numbers


@loop
def _admittances(omega, first, count, poles, s, into):
    """Store iω and 1/(iω − λ) for every pole λ."""
    for k in range(count):
        s[0, k] = -omega[first + k].imag
        s[1, k] = omega[first + k].real
    for m in range(poles.size):
        x, y = poles[m].real, poles[m].imag
        for k in range(count):
            real, imaginary = s[0, k] - x, s[1, k] - y
            share = 1.0 / (real * real + imaginary * imaginary)
            into[m, 0, k] = real * share
            into[m, 1, k] = -imaginary * share


@loop
def _add(factor, value, count, into):
    """Add a number times some values."""
    x, y = factor.real, factor.imag
    for k in range(count):
        real, imaginary = value[0, k], value[1, k]
        into[0, k] += x * real - y * imaginary
        into[1, k] += x * imaginary + y * real


@loop
def _multiply(factor, count, into):
    """Multiply some values by others."""
    for k in range(count):
        real, imaginary = into[0, k], into[1, k]
        into[0, k] = real * factor[0, k] - imaginary * factor[1, k]
        into[1, k] = real * factor[1, k] + imaginary * factor[0, k]


@loop
def stiffness(vehicle, omega):
    """Dynamic stiffness at the contacts of a part; as `Part.stiffness`."""
    poles, carried, direct, _, _, _, _, together = vehicle
    powers, entries, modes = carried.shape
    contacts = direct.shape[1]
    found = np.empty((entries, omega.size), np.complex128)
    s, total = np.empty((2, together)), np.empty((2, together))
    admittance = np.empty((modes, 2, together))
    for first in range(0, omega.size, together):
        count = min(together, omega.size - first)
        _admittances(omega, first, count, poles, s, admittance)
        for entry in range(entries):
            total[:] = 0.0
            for power in range(powers - 1, -1, -1):
                if power < powers - 1:
                    _multiply(s, count, total)
                for m in range(modes):
                    _add(-carried[power, entry, m], admittance[m], count, total)
                total[0] += direct[power, entry // contacts, entry % contacts]
            for k in range(count):
                found[entry, first + k] = complex(total[0, k], total[1, k])
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
    s, total = np.empty((2, together)), np.empty((2, together))
    admittance, below = np.empty((modes, 2, together)), np.empty((contacts, 2, together))
    modal = np.empty((modes, 2, together))
    for first in range(0, frequencies, together):
        count = min(together, frequencies - first)
        _admittances(omega, first, count, poles, s, admittance)
        for case in range(cases):
            for c in range(contacts):
                for k in range(count):
                    below[c, 0, k] = displacement[case, c, first + k].real
                    below[c, 1, k] = displacement[case, c, first + k].imag
            for m in range(modes):
                total[:] = 0.0
                for power in range(powers - 1, -1, -1):
                    if power < powers - 1:
                        _multiply(s, count, total)
                    for c in range(contacts):
                        _add(entered[power, m, c], below[c], count, total)
                _multiply(admittance[m], count, total)
                modal[m] = total
            for dof in range(dofs):
                total[:] = 0.0
                for m in range(modes):
                    _add(moving[dof, m], modal[m], count, total)
                for c in range(prescribed.shape[1]):
                    _add(complex(prescribed[dof, c]), below[c], count, total)
                for k in range(count):
                    moved[case, dof, first + k] = complex(total[0, k], total[1, k])
            for c in range(contacts if first + count > held else 0):
                total[:] = 0.0
                for power in range(powers - 1, -1, -1):
                    if power < powers - 1:
                        _multiply(s, count, total)
                    for m in range(modes):
                        _add(pushing[power, c, m], modal[m], count, total)
                    for source in range(contacts):
                        _add(complex(-direct[power, c, source]), below[source], count, total)
                for k in range(count):
                    force[case, c, first + k] = complex(total[0, k], total[1, k])
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

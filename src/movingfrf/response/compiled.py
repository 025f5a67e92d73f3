"""A vehicle on a guideway, solved frequency by frequency, compiled by numba (the extra `fast`); as `system`."""

from __future__ import annotations

import numpy as np

from movingfrf._basics.loops import loop
from movingfrf.guideways.compiled import over, squared, summed, waves
from movingfrf.guideways.roots import ROOTS
from movingfrf.vehicles.compiled import response, stiffness
from movingfrf.vehicles.dynamics import Numbers


@loop
def _eliminate(system, inverses):
    """Solve for the columns to the right of a square matrix, in place; partial pivoting. `inverses` is scratch."""
    count, columns = system.shape
    for step in range(count):
        pivot = step
        for row in range(step + 1, count):
            if squared(system[row, step]) > squared(system[pivot, step]):
                pivot = row
        if pivot != step:
            for column in range(step, columns):
                system[step, column], system[pivot, column] = system[pivot, column], system[step, column]
        inverses[step] = over(1.0 + 0j, system[step, step])
        for row in range(step + 1, count):
            factor = system[row, step] * inverses[step]
            for column in range(step + 1, columns):
                system[row, column] -= factor * system[step, column]
    for step in range(count - 1, -1, -1):
        for column in range(count, columns):
            total = system[step, column]
            for known in range(step + 1, count):
                total -= system[step, known] * system[known, column]
            system[step, column] = total * inverses[step]


@loop
def coupled(frf, which, dynamic, roughness):
    """Contact forces (I + D G)⁻¹ D R and deflections G F, G of distinct offsets; as `Tables.coupled`."""
    cases, contacts, frequencies = roughness.shape
    force = np.empty((cases, contacts, frequencies), np.complex128)
    deflection = np.empty((cases, contacts, frequencies), np.complex128)
    system = np.empty((contacts, contacts + cases), np.complex128)
    inverses = np.empty(contacts, np.complex128)
    for k in range(frequencies):
        for i in range(contacts):
            for j in range(contacts):
                total = 1.0 + 0j if i == j else 0j
                for m in range(contacts):
                    total += dynamic[i, m, k] * frf[which[m, j], k]
                system[i, j] = total
            for case in range(cases):
                total = 0j
                for m in range(contacts):
                    total += dynamic[i, m, k] * roughness[case, m, k]
                system[i, contacts + case] = total
        _eliminate(system, inverses)
        for case in range(cases):
            for i in range(contacts):
                force[case, i, k] = system[i, contacts + case]
                total = 0j
                for m in range(contacts):
                    total += frf[which[i, m], k] * system[m, contacts + case]
                deflection[case, i, k] = total
    return force, deflection


@loop
def tables(guideway, ahead, vehicle, omega):
    """Give the moving FRF at distinct offsets, the dynamic stiffness, and where a response is infinite."""
    direct = vehicle[2]
    (kappa, weight, forward), infinite = waves(guideway, omega)
    contacts = direct.shape[1]
    dynamic = stiffness(vehicle, omega).reshape((contacts, contacts, omega.size))
    return summed(kappa, weight, forward, ahead), dynamic, infinite


@loop
def answered(guideway, ahead, which, vehicle, omega, kept, roughness):
    """Answer to roughness, and where that is infinite; as `System.answer`.

    Of the moving FRF the given shares are kept, as far as they reach.
    """
    reach = kept.size
    frf, dynamic, infinite = tables(guideway, ahead, vehicle, omega[:reach])
    for k in range(reach - 1, -1, -1):
        # It stiffens towards the end alone.
        if kept[k] == 1.0:
            break
        for row in range(ahead.size):
            frf[row, k] *= kept[k]
    solved, deflection = coupled(frf, which, dynamic, roughness[:, :, :reach].copy())
    displacement = -roughness
    displacement[:, :, :reach] += deflection
    motion, force = response(vehicle, omega, displacement)
    # Near a resonance of the vehicle between held contacts D d would lose digits that (I + D G)⁻¹ D R has.
    force[:, :, :reach] = solved
    return (force, deflection, motion), infinite


def ready():
    """Compile what is here, or load it, for arrays as they are handed over."""
    above, below, by_omega = np.array([[1, 1], [0, 0], [1, 0j]]), np.array([[1 + 0j]]), np.array([[0j]])
    size, omega, poles, direct = above.real.copy(), np.array([1 - 0.1j]), np.array([-1 + 0j]), np.ones((1, 1, 1))
    known, moving, prescribed = np.ones((1, 1, 1), complex), np.ones((1, 1), complex), np.zeros((1, 0))
    ahead, which = np.zeros(1), np.zeros((1, 1), int)
    for table in (above, below, by_omega, size, poles, direct, known, moving, prescribed, ahead, which):
        table.setflags(write=False)
    guideway = above, below, size, by_omega, 1e-12, ROOTS.numbers
    vehicle = Numbers(poles, known, direct, known, moving, known, prescribed, 1)
    rough = np.ones((1, 1, 1), complex)
    frf, dynamic, _ = tables(guideway, ahead, vehicle, omega)
    coupled(frf, which, dynamic, rough)
    answered(guideway, ahead, which, vehicle, omega, np.ones(1), rough)

"""A vehicle on a guideway, solved frequency by frequency, compiled by numba (the extra `fast`); as `system`."""

from __future__ import annotations

import math

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
def coupled(frf, which, dynamic, given, rough):
    """Give contact forces (I + D G)⁻¹ D R, or (I + D G)⁻¹ L, and deflections G F, G of distinct offsets.

    As `Tables.coupled`, or `Tables.carried`: what is given is roughness or loads.
    """
    cases, contacts, frequencies = given.shape[0], given.shape[1], dynamic.shape[2]
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
                total = 0j if rough else given[case, i, k]
                for m in range(contacts if rough else 0):
                    total += dynamic[i, m, k] * given[case, m, k]
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
def turned(frf, dynamic, largest_change):
    """Angle by which det(I + D G) of one contact or two turns along a path; as `stability._turned`.

    Of the path, ends and middles of intervals in turn. NaN where an interval needs a closer look.
    """
    contacts, frequencies = dynamic.shape[0], dynamic.shape[2]
    here, before = np.empty((2, 2), np.complex128), np.empty((2, 2), np.complex128)
    angle, limit = 0.0, largest_change * largest_change
    for k in range(frequencies):
        for i in range(contacts):
            for j in range(contacts):
                before[i, j] = here[i, j]
                total = 1.0 + 0j if i == j else 0j
                for m in range(contacts):
                    total += dynamic[i, m, k] * frf[m, j, k]
                here[i, j] = total
        if k == 0:
            continue
        if contacts == 1:
            factor = over(here[0, 0], before[0, 0])
            other = 1.0 + 0j
        else:
            # Eigenvalues of X₁⁻¹X₂: half of its trace and its determinant.
            determinant = before[0, 0] * before[1, 1] - before[0, 1] * before[1, 0]
            half = before[1, 1] * here[0, 0] - before[0, 1] * here[1, 0]
            half = 0.5 * over(half + before[0, 0] * here[1, 1] - before[1, 0] * here[0, 1], determinant)
            root = np.sqrt(half * half - over(here[0, 0] * here[1, 1] - here[0, 1] * here[1, 0], determinant))
            factor, other = half + root, half - root
        if not (squared(factor - 1.0) <= limit and squared(other - 1.0) <= limit):
            return np.nan
        angle += math.atan2(factor.imag, factor.real) + math.atan2(other.imag, other.real)
    return angle


@loop
def tables(guideway, ahead, vehicle, omega):
    """Give the moving FRF at distinct offsets, the dynamic stiffness, and where a response is infinite."""
    direct = vehicle[2]
    (kappa, weight, forward), infinite = waves(guideway, omega)
    contacts = direct.shape[1]
    dynamic = stiffness(vehicle, omega).reshape((contacts, contacts, omega.size))
    return summed(kappa, weight, forward, ahead), dynamic, infinite


@loop
def moving_frf(guideway, ahead, omega):
    """Give the moving FRF at distinct offsets, and where a response is infinite."""
    (kappa, weight, forward), infinite = waves(guideway, omega)
    return summed(kappa, weight, forward, ahead), infinite


@loop
def answered(frf, which, dynamic, vehicle, omega, kept, roughness):
    """Answer to roughness; as `System.answer`.

    Of the moving FRF the given shares are kept, as far as they reach.
    """
    reach = kept.size
    solved, deflection = coupled(frf * kept, which, dynamic, roughness, True)
    cases, contacts, frequencies = roughness.shape
    displacement = np.empty((cases, contacts, frequencies), np.complex128)
    # Element by element: assigning arrays to parts of others takes seconds to compile.
    for case in range(cases):
        for i in range(contacts):
            for k in range(frequencies):
                yields = deflection[case, i, k] if k < reach else 0j
                displacement[case, i, k] = yields - roughness[case, i, k]
    motion, force = response(vehicle, omega, displacement, reach)
    # Near a resonance of the vehicle between held contacts D d would lose digits that (I + D G)⁻¹ D R has.
    for case in range(cases):
        for i in range(contacts):
            for k in range(reach):
                force[case, i, k] = solved[case, i, k]
    return force, deflection, motion


@loop
def _size(value):
    return math.sqrt(squared(value))


@loop
def per_unit(frf, which, dynamic, vehicle, omega):
    """Size of what the guideway adds to each output, then of all of it, per unit; as `System.per_unit`."""
    contacts, frequencies = dynamic.shape[0], omega.size
    # Contact by contact under which the road is rough; then the same on a rigid road, whose motion is −H.
    unit = np.empty((contacts, contacts, frequencies), np.complex128)
    for case in range(contacts):
        for i in range(contacts):
            for k in range(frequencies):
                unit[case, i, k] = 1.0 if case == i else 0.0
    force, deflection = coupled(frf, which, dynamic, unit, True)
    below = np.empty((2 * contacts, contacts, frequencies), np.complex128)
    for case in range(contacts):
        for i in range(contacts):
            for k in range(frequencies):
                below[case, i, k], below[contacts + case, i, k] = deflection[case, i, k], unit[case, i, k]
    moved, pushed = response(vehicle, omega, below, 0)
    dofs = moved.shape[1]
    sizes = np.empty((2, contacts, 2 * contacts + 2 * dofs, frequencies))
    for case in range(contacts):
        for i in range(contacts):
            for k in range(frequencies):
                yields = _size(deflection[case, i, k])
                sizes[0, case, i, k], sizes[1, case, i, k] = _size(pushed[case, i, k]), _size(force[case, i, k])
                sizes[0, case, contacts + i, k], sizes[1, case, contacts + i, k] = yields, yields
        for dof in range(dofs):
            row = 2 * contacts + dof
            for k in range(frequencies):
                added, held = moved[case, dof, k], moved[contacts + case, dof, k]
                square = squared(omega[k])
                sizes[0, case, row, k], sizes[1, case, row, k] = _size(added), _size(added - held)
                sizes[0, case, row + dofs, k] = square * sizes[0, case, row, k]
                sizes[1, case, row + dofs, k] = square * sizes[1, case, row, k]
    return sizes


@loop
def shares(sizes, power, kinds, alike):
    """Bounds of energies from each band on, as shares, and energies of which; as `influence.influence`."""
    sides, ports, outputs, _ = sizes.shape
    cases, _, bands = power.shape
    beyond, whole = np.zeros((sides, cases, outputs, bands + 1)), np.zeros((cases, outputs))
    for case in range(cases):
        for output in range(outputs):
            for k in range(bands):
                for port in range(ports):
                    whole[case, output] += sizes[1, port, output, k] ** 2 * power[case, port, k]
        begin = 0
        for count in kinds:
            largest = 0.0
            for output in range(begin, begin + count):
                largest = max(largest, whole[case, output])
            for output in range(begin, begin + count):
                whole[case, output] = max(whole[case, output], alike * alike * largest)
            begin += count
        for side in range(sides):
            for output in range(outputs):
                size = whole[case, output]
                for k in range(bands - 1, -1, -1):
                    most = 0.0
                    for port in range(ports):
                        most += sizes[side, port, output, k] * math.sqrt(power[case, port, k])
                    share = most * most / size if size > 0.0 else 0.0
                    beyond[side, case, output, k] = beyond[side, case, output, k + 1] + share
    return beyond, whole


@loop
def harmful(sizes, beyond, size, energy, limit):
    """Count the first frequencies of a band up to the last one from which on too much is left of some output.

    With sizes of outputs in the band, and energies beyond it; as `Influence.negligible_from`.
    """
    cases, ports, frequencies = energy.shape
    last = 0
    for case in range(cases):
        for output in range(size.shape[1]):
            whole, left = size[case, output], beyond[case, output]
            for k in range(frequencies - 1, last - 1, -1):
                most = 0.0
                for port in range(ports):
                    most += sizes[port, output] * math.sqrt(energy[case, port, k])
                left += most * most / whole if whole > 0.0 else 0.0
                if left > limit:
                    last = k + 1
                    break
    return last


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
    moving_frf(guideway, ahead, omega)
    turned(frf[which], dynamic, 0.9)
    sizes = per_unit(frf, which, dynamic, vehicle, omega)
    sizes.setflags(write=False)
    beyond, size = shares(sizes, np.ones((1, 1, 1)), np.ones(4, int), 0.1)
    harmful(beyond[0, :, :, 0].copy(), beyond[0, :, :, 0].copy(), size, np.ones((1, 1, 1)), 0.1)
    coupled(frf, which, dynamic, rough, True)
    for solved in (frf, dynamic):
        solved.setflags(write=False)
    answered(frf, which, dynamic, vehicle, omega, np.ones(1), rough)

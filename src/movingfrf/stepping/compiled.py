"""The inner loops of time stepping, compiled by numba (the extra `fast`); `marching` has them in NumPy.

A guideway of cubic beam elements on a foundation without mass has bands of half-width three. Its effective matrix
is factorised once, from both ends towards the middle: two recurrences that do not wait for each other. What a
contact needs to know before the guideway is solved, its own row of the inverse, is computed once as well; beyond a
few metres its entries are zero to rounding. So a step costs one band product and one band solve, however many
contacts there are.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from movingfrf.stepping.exchange import HUGE, TINY
from movingfrf.stepping.finite_guideway import ELEMENT_ROUNDING
from movingfrf.stepping.kernels import (
    FAST,
    HALF_WIDTH,
    balanced,
    band_product,
    dot,
    eliminate,
    freed,
    met,
    shape_functions,
    solve,
    taken,
)


@njit(cache=True, fastmath=FAST)
def iterate(matrix, right, force, tolerance, most):
    """Exchange contact forces until they agree: F ← right − (matrix − I) F from the forces given.

    Returns the iterations taken, or −1 if they do not come to agree.
    """
    n = right.size
    fresh = np.empty(n)
    for count in range(1, most + 1):
        change = size = 0.0
        for j in range(n):
            total = right[j] + force[j]
            for s in range(n):
                total -= matrix[j, s] * force[s]
            fresh[j] = total
        for j in range(n):
            change = max(change, abs(fresh[j] - force[j]))
            size = max(size, abs(fresh[j]))
            force[j] = fresh[j]
        if change <= tolerance * size or size < TINY:
            right[:] = force
            return count
        if not size < HUGE:
            return -1
    return -1


@njit(cache=True, fastmath=FAST)
def march(
    # `HalfStep`: the rule of the scheme, and the vehicle.
    half,
    # Guideway: bands of mass, damping and stiffness (4, n), factors of the effective matrix, rows of its inverse.
    mass,
    damping,
    stiffness,
    rows,
    columns,
    core,
    inverse,
    reach_from,
    # Mesh: (position of the first node, length of an element), numbers of the unknowns; whether it travels along.
    mesh,
    number,
    travels,
    # Where contacts and observers stand at step 0, the speed of the contacts, and whether observers share it.
    contacts,
    observers,
    speed,
    observers_travel,
    # What happens in each step: elevation and its rate, prescribed forces (one row: constant).
    roughness,
    rate,
    loads,
    # Contact forces are iterated to this tolerance, or solved for if it is zero.
    tolerance,
    most,
    # State: displacement, velocity, acceleration of guideway and vehicle; forces on the guideway; elements moved on
    # by.
    guideway,
    body,
    acting,
    shifted,
    # Steps to take, counted from row 0 of the records, which is step `origin` of the journey.
    origin,
    begin,
    end,
    force_out,
    deflection_out,
    observed_out,
    motion_out,
    acceleration_out,
):
    """March from `begin` to `end`; returns the step that did not converge (or −1), and the most iterations."""
    dt, free_u, free_v, lift_u, lift_v, keep, alpha_m, alpha_f = half.rule
    n = guideway.shape[1]
    k = contacts.size
    m = body.shape[1]
    last = number.size // 2 - 2
    reach = inverse.shape[1]
    u, v, a = guideway[0], guideway[1], guideway[2]
    at_u, at_v, right = np.empty(n), np.empty(n), np.empty(n)
    free, push, acceleration = np.empty((3, m)), np.empty(m), np.empty(m)
    middle = np.empty(core.shape[0])
    places, before = np.zeros((k, 4), np.int64), np.zeros((k, 4), np.int64)
    values, slopes, values_before = np.zeros((k, 4)), np.zeros((k, 4)), np.zeros((k, 4))
    # Accelerations at the unknowns around each contact: free, and per unit force at each contact.
    free_a = np.empty((k, 4))
    per_force = np.empty((k, 4, k))
    # Of the guideway under each contact: deflection and its rate, without the forces of a step and per force.
    down, sinking, moves, moving = np.empty(k), np.empty(k), np.empty((k, k)), np.empty((k, k))
    matrix, gap, force = np.empty((k, k)), np.empty(k), np.empty(k)
    here, here_values, here_slopes = np.zeros(4, np.int64), np.zeros(4), np.zeros(4)
    for j in range(k):
        gap[j] = acting[j] - loads[min(begin, loads.shape[0] - 1), j]
        shape_functions(
            contacts[j] + speed * dt * (origin + begin) - shifted[0] * mesh[1],
            mesh[0],
            mesh[1],
            last,
            number,
            before[j],
            values_before[j],
            slopes[j],
        )
    worst = 0
    for step in range(begin + 1, end + 1):
        travelled = speed * dt * (origin + step)
        if travels:
            elements = int(np.floor(travelled / mesh[1] + ELEMENT_ROUNDING)) - shifted[0]
            if elements > 0:
                shifted[0] += elements
                gone = min(2 * elements, n)
                for part in range(3):
                    for i in range(n - gone):
                        guideway[part, i] = guideway[part, i + gone]
                    for i in range(n - gone, n):
                        guideway[part, i] = 0.0
                for j in range(k):
                    for q in range(4):
                        before[j, q] -= gone
            travelled -= shifted[0] * mesh[1]
        for j in range(k):
            shape_functions(
                contacts[j] + travelled, mesh[0], mesh[1], last, number, places[j], values[j], slopes[j]
            )
        # What the guideway would do without the contact forces of this step.
        for i in range(n):
            at_u[i] = u[i] + keep * (dt * v[i] + free_u * a[i])
            at_v[i] = v[i] + keep * free_v * a[i]
        band_product(stiffness, damping, at_u, at_v, right)
        if alpha_m != 0.0:
            for i in range(n):
                right[i] -= alpha_m * mass[0, i] * a[i]
            for d in range(1, HALF_WIDTH + 1):
                for i in range(n - d):
                    right[i] -= alpha_m * mass[d, i] * a[i + d]
                    right[i + d] -= alpha_m * mass[d, i] * a[i]
        prescribed = min(step, loads.shape[0] - 1)
        for j in range(k):
            for q in range(4):
                right[places[j, q]] += keep * values[j, q] * loads[prescribed, j]
                if alpha_f != 0.0 and before[j, q] >= 0:
                    right[before[j, q]] += alpha_f * values_before[j, q] * acting[j]
        if m:
            freed(half, body, gap, push, free)
            for j in range(k):
                force[j] = gap[j]
            # Contact forces: the rate of the deflection under a contact is ẇ + v w′.
            for j in range(k):
                for q in range(4):
                    place = places[j, q]
                    start = reach_from[place]
                    free_a[j, q] = dot(inverse[place], right[start : start + reach])
                    for s in range(k):
                        total = 0.0
                        for p in range(4):
                            offset = places[s, p] - start
                            if 0 <= offset < reach:
                                total += values[s, p] * inverse[place, offset]
                        per_force[j, q, s] = keep * total
            for j in range(k):
                w = dw = 0.0
                for q in range(4):
                    place = places[j, q]
                    moved = u[place] + dt * v[place] + free_u * a[place] + lift_u * free_a[j, q]
                    w += values[j, q] * moved
                    dw += values[j, q] * (v[place] + free_v * a[place] + lift_v * free_a[j, q])
                    dw += speed * slopes[j, q] * moved
                for s in range(k):
                    yields = yielding = 0.0
                    for q in range(4):
                        yields += values[j, q] * per_force[j, q, s]
                        yielding += slopes[j, q] * per_force[j, q, s]
                    moves[j, s] = lift_u * yields
                    moving[j, s] = lift_v * yields + speed * lift_u * yielding
                down[j], sinking[j] = w, dw
            met(half, free, step, roughness, rate, down, sinking, moves, moving, matrix, gap)
            if tolerance > 0.0:
                count = iterate(matrix, gap, force, tolerance, most)
                if count < 0:
                    return step, worst
                worst = max(worst, count)
            else:
                eliminate(matrix, gap)
            for j in range(k):
                for q in range(4):
                    right[places[j, q]] += keep * values[j, q] * gap[j]
        else:
            for j in range(k):
                gap[j] = 0.0
        solve(rows, columns, core, right, middle)
        for i in range(n):
            u[i] += dt * v[i] + free_u * a[i] + lift_u * right[i]
            v[i] += free_v * a[i] + lift_v * right[i]
            a[i] = right[i]
        taken(half, body, free, gap)
        for i in range(m):
            motion_out[step, i] = body[0, i]
            acceleration_out[step, i] = body[2, i]
        if alpha_m != 0.0 or alpha_f != 0.0:
            # What such a scheme carries as acceleration belongs to a later instant; that of this one balances.
            balanced(half, body, gap, push, acceleration)
            for i in range(m):
                acceleration_out[step, i] = acceleration[i]
        for j in range(k):
            acting[j] = gap[j] + loads[prescribed, j]
            w = 0.0
            for q in range(4):
                w += values[j, q] * u[places[j, q]]
                before[j, q] = places[j, q]
                values_before[j, q] = values[j, q]
            force_out[step, j] = gap[j]
            deflection_out[step, j] = w
        for j in range(observers.size):
            shape_functions(
                observers[j] + (travelled if observers_travel else 0.0),
                mesh[0],
                mesh[1],
                last,
                number,
                here,
                here_values,
                here_slopes,
            )
            w = 0.0
            for q in range(4):
                w += here_values[q] * u[here[q]]
            observed_out[step, j] = w
    return -1, worst


@njit(cache=True, fastmath=FAST)
def convolve(
    half,
    now,
    backwards,
    begun,
    roughness,
    rate,
    state,
    begin,
    end,
    force_out,
    deflection_out,
    motion_out,
    acceleration_out,
):
    """Convolve and step from `begin` to `end`; forces and deflections are (contact, time)."""
    k = now.shape[0]
    m = state.shape[1]
    memory = backwards.shape[2]
    dt = half.rule.step
    free, push = np.empty((3, m)), np.empty(m)
    known, sinking, moving = np.empty(k), np.empty(k), np.empty((k, k))
    gap, matrix = force_out[:, begin].copy(), np.empty((k, k))
    for step in range(begin + 1, end + 1):
        past = min(step, memory)
        freed(half, state, gap, push, free)
        a, b, c = 1.5 / dt, -2.0 / dt, 0.5 / dt
        if step == 1:
            a, b, c = 1.0 / dt, -1.0 / dt, 0.0
        for j in range(k):
            for s in range(k):
                moving[j, s] = a * now[j, s]
        for j in range(k):
            total = 0.0
            for s in range(k):
                total += dot(backwards[j, s, memory - past :], force_out[s, step - past : step])
            if step < begun.shape[1]:
                total += begun[j, step]
            known[j] = total
            older = b * deflection_out[j, step - 1] + c * deflection_out[j, max(step - 2, 0)]
            sinking[j] = a * total + older
        met(half, free, step, roughness, rate, known, sinking, now, moving, matrix, gap)
        eliminate(matrix, gap)
        taken(half, state, free, gap)
        for i in range(m):
            motion_out[i, step] = state[0, i]
            acceleration_out[i, step] = state[2, i]
        for j in range(k):
            w = known[j]
            for s in range(k):
                w += now[j, s] * gap[s]
            force_out[j, step] = gap[j]
            deflection_out[j, step] = w

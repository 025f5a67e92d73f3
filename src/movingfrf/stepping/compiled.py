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
from movingfrf.stepping.kernels import FAST, HALF_WIDTH, band_product, dot, eliminate, shape_functions, solve


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
    # Scheme: step, β, γ, α_m, α_f.
    scheme,
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
    # Vehicle: inverses of its effective and its own mass, its matrices, map to the contacts; springs, dashpots.
    vehicle_inverse,
    mass_inverse,
    vehicle_mass,
    vehicle_damping,
    vehicle_stiffness,
    contact_map,
    springs,
    dashpots,
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
    dt, beta, gamma, alpha_m, alpha_f = scheme[0], scheme[1], scheme[2], scheme[3], scheme[4]
    n = guideway.shape[1]
    k = contacts.size
    m = body.shape[1]
    last = number.size // 2 - 2
    reach = inverse.shape[1]
    keep = 1.0 - alpha_f
    u, v, a = guideway[0], guideway[1], guideway[2]
    z, dz, ddz = body[0], body[1], body[2]
    at_u, at_v, right = np.empty(n), np.empty(n), np.empty(n)
    free_z, free_dz, push, free_ddz = np.empty(m), np.empty(m), np.empty(m), np.empty(m)
    middle = np.empty(core.shape[0])
    places, before = np.zeros((k, 4), np.int64), np.zeros((k, 4), np.int64)
    values, slopes, values_before = np.zeros((k, 4)), np.zeros((k, 4)), np.zeros((k, 4))
    # Accelerations at the unknowns around each contact: free, and per unit force at each contact.
    free_a = np.empty((k, 4))
    per_force = np.empty((k, 4, k))
    matrix, gap, force = np.empty((k, k)), np.empty(k), np.empty(k)
    here, here_values, here_slopes = np.zeros(4, np.int64), np.zeros(4), np.zeros(4)
    # The vehicle's acceleration per contact force, and what that moves at the contacts.
    lifted = np.zeros((m, k))
    for i in range(m):
        for s in range(k):
            for p in range(m):
                lifted[i, s] -= keep * vehicle_inverse[i, p] * contact_map[s, p]
    own = np.zeros((k, k))
    for j in range(k):
        for s in range(k):
            for i in range(m):
                own[j, s] += contact_map[j, i] * lifted[i, s]
    lift_u, lift_v = beta * dt * dt, gamma * dt
    for j in range(k):
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
        free_a_u, free_a_v = (0.5 - beta) * dt * dt, (1.0 - gamma) * dt
        for i in range(n):
            at_u[i] = u[i] + keep * (dt * v[i] + free_a_u * a[i])
            at_v[i] = v[i] + keep * free_a_v * a[i]
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
            for i in range(m):
                free_z[i] = z[i] + dt * dz[i] + free_a_u * ddz[i]
                free_dz[i] = dz[i] + free_a_v * ddz[i]
            for i in range(m):
                total = 0.0
                for p in range(m):
                    total -= vehicle_stiffness[i, p] * (keep * free_z[p] + alpha_f * z[p])
                    total -= vehicle_damping[i, p] * (keep * free_dz[p] + alpha_f * dz[p])
                    total -= alpha_m * vehicle_mass[i, p] * ddz[p]
                if alpha_f != 0.0:
                    previous = min(step - 1, loads.shape[0] - 1)
                    for s in range(k):
                        total -= alpha_f * contact_map[s, i] * (acting[s] - loads[previous, s])
                push[i] = total
            for i in range(m):
                total = 0.0
                for p in range(m):
                    total += vehicle_inverse[i, p] * push[p]
                free_ddz[i] = total
            # Contact forces: F = k (B z − w + r) + c (B ż − ẇ − v w′ + ṙ), each linear in all of them.
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
                    moved = u[place] + dt * v[place] + free_a_u * a[place] + lift_u * free_a[j, q]
                    w += values[j, q] * moved
                    dw += values[j, q] * (v[place] + free_a_v * a[place] + lift_v * free_a[j, q])
                    dw += speed * slopes[j, q] * moved
                up = dup = 0.0
                for i in range(m):
                    up += contact_map[j, i] * (free_z[i] + lift_u * free_ddz[i])
                    dup += contact_map[j, i] * (free_dz[i] + lift_v * free_ddz[i])
                gap[j] = springs[j] * (up - w + roughness[step, j]) + dashpots[j] * (dup - dw + rate[step, j])
                for s in range(k):
                    yields = yielding = 0.0
                    for q in range(4):
                        yields += values[j, q] * per_force[j, q, s]
                        yielding += slopes[j, q] * per_force[j, q, s]
                    matrix[j, s] = springs[j] * lift_u * (yields - own[j, s]) + dashpots[j] * (
                        lift_v * (yields - own[j, s]) + speed * lift_u * yielding
                    )
                matrix[j, j] += 1.0
            if tolerance > 0.0:
                for j in range(k):
                    force[j] = acting[j] - loads[min(step - 1, loads.shape[0] - 1), j]
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
            u[i] += dt * v[i] + free_a_u * a[i] + lift_u * right[i]
            v[i] += free_a_v * a[i] + lift_v * right[i]
            a[i] = right[i]
        for i in range(m):
            ddz[i] = free_ddz[i]
            for s in range(k):
                ddz[i] += lifted[i, s] * gap[s]
            z[i] = free_z[i] + lift_u * ddz[i]
            dz[i] = free_dz[i] + lift_v * ddz[i]
            motion_out[step, i] = z[i]
            acceleration_out[step, i] = ddz[i]
        if alpha_m != 0.0 or alpha_f != 0.0:
            # What such a scheme carries as acceleration belongs to a later instant; that of this one balances.
            for i in range(m):
                push[i] = 0.0
                for p in range(m):
                    push[i] -= vehicle_stiffness[i, p] * z[p] + vehicle_damping[i, p] * dz[p]
                for s in range(k):
                    push[i] -= contact_map[s, i] * gap[s]
            for i in range(m):
                acceleration_out[step, i] = 0.0
                for p in range(m):
                    acceleration_out[step, i] += mass_inverse[i, p] * push[p]
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
    dt,
    now,
    backwards,
    begun,
    vehicle_inverse,
    vehicle_damping,
    vehicle_stiffness,
    contact_map,
    springs,
    dashpots,
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
    k = springs.size
    m = state.shape[1]
    memory = backwards.shape[2]
    z, dz, ddz = state[0], state[1], state[2]
    lift_u, lift_v = 0.25 * dt * dt, 0.5 * dt
    lifted, own = np.zeros((m, k)), np.zeros((k, k))
    for i in range(m):
        for s in range(k):
            for p in range(m):
                lifted[i, s] -= vehicle_inverse[i, p] * contact_map[s, p]
    for j in range(k):
        for s in range(k):
            for i in range(m):
                own[j, s] += contact_map[j, i] * lifted[i, s]
    free_z, free_dz, free_ddz, push = np.empty(m), np.empty(m), np.empty(m), np.empty(m)
    known, gap, matrix = np.empty(k), np.empty(k), np.empty((k, k))
    for step in range(begin + 1, end + 1):
        past = min(step, memory)
        for i in range(m):
            free_z[i] = z[i] + dt * dz[i] + lift_u * ddz[i]
            free_dz[i] = dz[i] + lift_v * ddz[i]
        for i in range(m):
            total = 0.0
            for p in range(m):
                total -= vehicle_stiffness[i, p] * free_z[p] + vehicle_damping[i, p] * free_dz[p]
            push[i] = total
        for i in range(m):
            total = 0.0
            for p in range(m):
                total += vehicle_inverse[i, p] * push[p]
            free_ddz[i] = total
        a, b, c = 1.5, -2.0, 0.5
        if step == 1:
            a, b, c = 1.0, -1.0, 0.0
        for j in range(k):
            total = 0.0
            for s in range(k):
                total += dot(backwards[j, s, memory - past :], force_out[s, step - past : step])
            if step < begun.shape[1]:
                total += begun[j, step]
            known[j] = total
            older = b * deflection_out[j, step - 1] + c * deflection_out[j, max(step - 2, 0)]
            up = dup = 0.0
            for i in range(m):
                up += contact_map[j, i] * (free_z[i] + lift_u * free_ddz[i])
                dup += contact_map[j, i] * (free_dz[i] + lift_v * free_ddz[i])
            gap[j] = springs[j] * (up - total + roughness[step, j])
            gap[j] += dashpots[j] * (dup - (a * total + older) / dt + rate[step, j])
            for s in range(k):
                matrix[j, s] = springs[j] * (now[j, s] - lift_u * own[j, s])
                matrix[j, s] += dashpots[j] * (a / dt * now[j, s] - lift_v * own[j, s])
            matrix[j, j] += 1.0
        eliminate(matrix, gap)
        for i in range(m):
            ddz[i] = free_ddz[i]
            for s in range(k):
                ddz[i] += lifted[i, s] * gap[s]
            z[i] = free_z[i] + lift_u * ddz[i]
            dz[i] = free_dz[i] + lift_v * ddz[i]
            motion_out[i, step] = z[i]
            acceleration_out[i, step] = ddz[i]
        for j in range(k):
            w = known[j]
            for s in range(k):
                w += now[j, s] * gap[s]
            force_out[j, step] = gap[j]
            deflection_out[j, step] = w

"""The inner loops of time stepping, compiled by numba (the extra `fast`); `marching` has them in NumPy.

A road of cubic beam elements on a foundation without mass has bands of half-width three. Its effective matrix is
factorised once, from both ends towards the middle: two recurrences that do not wait for each other. What a contact
needs to know before the road is solved, its own row of the inverse, is computed once as well; beyond a few metres
its entries are zero to rounding. So a step costs one band product and one band solve, however many contacts there
are.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from movingfrf.stepping.finite_guideway import SAME_PLACE
from movingfrf.stepping.marching import HUGE, TINY

# A product and a sum may be rounded once instead of twice; nothing else that changes results is allowed.
FAST = {"contract", "nsz"}

# Half-width of the bands.
WIDTH = 3


@njit(cache=True, fastmath=FAST)
def factorise(bands, rows, columns, core):
    """Factorise a symmetric band matrix, L D Lᵀ, from both ends; returns the smallest pivot of the two.

    `bands[d, i]` is A[i + d, i]. For the upper end and, mirrored, the lower end, `rows` (half, 6) receives the
    three entries of L left of the diagonal (nearest first), `columns` (half, 8) the three below it and the inverse
    pivot; `core` (q, q) what is left in the middle, for the caller to invert.
    """
    n = bands.shape[1]
    half = rows.shape[0]
    q = core.shape[0]
    work = np.zeros((2, half + WIDTH, 4))
    for i in range(half):
        for d in range(4):
            work[0, i, d] = bands[d, i]
            work[1, i, d] = bands[d, n - 1 - i - d]
    rows[:] = 0.0
    smallest = np.inf
    for end in range(2):
        for i in range(half):
            pivot = work[end, i, 0]
            smallest = min(smallest, pivot)
            if not pivot > 0.0:
                return pivot
            for a in range(1, 4):
                below = work[end, i, a] / pivot
                columns[i, 4 * end + a - 1] = below
                if i + a < half:
                    rows[i + a, 3 * end + a - 1] = below
                for b in range(1, a + 1):
                    work[end, i + b, a - b] -= below * work[end, i, b]
            columns[i, 4 * end + 3] = 1.0 / pivot
    core[:] = 0.0
    for a in range(q):
        for b in range(a + 1):
            if a - b < 4:
                core[a, b] = core[b, a] = bands[a - b, half + b]
    for b in range(WIDTH):
        for d in range(WIDTH - b):
            a = b + d
            core[a, b] += work[0, half + b, d]
            core[q - 1 - b, q - 1 - a] += work[1, half + b, d]
            if d:
                core[b, a] += work[0, half + b, d]
                core[q - 1 - a, q - 1 - b] += work[1, half + b, d]
    return smallest


@njit(cache=True, fastmath=FAST)
def solve(rows, columns, core, x, middle):
    """Solve in place; `middle` is scratch of the core's size."""
    last = x.size - 1
    half = rows.shape[0]
    q = core.shape[0]
    a1 = a2 = a3 = b1 = b2 = b3 = 0.0
    for i in range(half):
        a = ((x[i] - rows[i, 2] * a3) - rows[i, 1] * a2) - rows[i, 0] * a1
        b = ((x[last - i] - rows[i, 5] * b3) - rows[i, 4] * b2) - rows[i, 3] * b1
        x[i] = a
        x[last - i] = b
        a3, a2, a1 = a2, a1, a
        b3, b2, b1 = b2, b1, b
    for r in range(q):
        middle[r] = x[half + r]
    for r in range(WIDTH):
        for near in range(WIDTH - r):
            middle[r] -= columns[half - 1 - near, r + near] * x[half - 1 - near]
            middle[q - 1 - r] -= columns[half - 1 - near, 4 + r + near] * x[last - (half - 1 - near)]
    for r in range(q):
        total = 0.0
        for c in range(q):
            total += core[r, c] * middle[c]
        x[half + r] = total
    a1, a2, a3 = x[half], x[half + 1], x[half + 2]
    b1, b2, b3 = x[half + q - 1], x[half + q - 2], x[half + q - 3]
    for i in range(half - 1, -1, -1):
        a = ((x[i] * columns[i, 3] - columns[i, 2] * a3) - columns[i, 1] * a2) - columns[i, 0] * a1
        b = ((x[last - i] * columns[i, 7] - columns[i, 6] * b3) - columns[i, 5] * b2) - columns[i, 4] * b1
        x[i] = a
        x[last - i] = b
        a3, a2, a1 = a2, a1, a
        b3, b2, b1 = b2, b1, b


@njit(cache=True, fastmath=FAST)
def influence(rows, columns, core, reach, first):
    """Rows of the inverse, each cut to the entries that are not zero to rounding.

    `first` (n,) receives where each row begins; returns (n, reach).
    """
    n = first.size
    last = n - 1
    half = rows.shape[0]
    side = reach // 2
    cut = np.empty((n, reach))
    whole = np.zeros(n)
    middle = np.empty(core.shape[0])
    for i in range(n):
        first[i] = min(max(i - side, 0), n - reach)
        # Away from the core a row needs no more of the sweeps than its own reach.
        if i + side < half or last - i + side < half:
            lower = 0 if i + side < half else 1
            begin = i if lower == 0 else last - i
            a1 = a2 = a3 = 0.0
            for j in range(begin, begin + side):
                a = ((-rows[j, 3 * lower + 2] * a3) - rows[j, 3 * lower + 1] * a2) - rows[j, 3 * lower] * a1
                if j == begin:
                    a = 1.0
                whole[j if lower == 0 else last - j] = a
                a3, a2, a1 = a2, a1, a
            a1 = a2 = a3 = 0.0
            for j in range(begin + side - 1, max(begin - side, 0) - 1, -1):
                at = j if lower == 0 else last - j
                a = whole[at] * columns[j, 4 * lower + 3] - columns[j, 4 * lower + 2] * a3
                a = (a - columns[j, 4 * lower + 1] * a2) - columns[j, 4 * lower] * a1
                whole[at] = a
                a3, a2, a1 = a2, a1, a
        else:
            whole[i] = 1.0
            solve(rows, columns, core, whole, middle)
        cut[i] = whole[first[i] : first[i] + reach]
        whole[:] = 0.0
    return cut


@njit(cache=True, fastmath=FAST)
def product(stiffness, damping, displacement, velocity, force):
    """Force = −(K u + C v) for band matrices."""
    n = force.size
    for edge in range(2 * WIDTH):
        i = edge if edge < WIDTH else n - 2 * WIDTH + edge
        total = stiffness[0, i] * displacement[i] + damping[0, i] * velocity[i]
        for d in range(1, WIDTH + 1):
            if i + d < n:
                total += stiffness[d, i] * displacement[i + d] + damping[d, i] * velocity[i + d]
            if i >= d:
                total += stiffness[d, i - d] * displacement[i - d] + damping[d, i - d] * velocity[i - d]
        force[i] = -total
    # Views without negative indices: only so does the compiler use the processor's vectors.
    k0, k1, k2, k3 = stiffness[0, 3:], stiffness[1, 3:], stiffness[2, 3:], stiffness[3, 3:]
    l1, l2, l3 = stiffness[1, 2:], stiffness[2, 1:], stiffness[3]
    c0, c1, c2, c3 = damping[0, 3:], damping[1, 3:], damping[2, 3:], damping[3, 3:]
    d1, d2, d3 = damping[1, 2:], damping[2, 1:], damping[3]
    u0, u1, u2, u3 = displacement[3:], displacement[4:], displacement[5:], displacement[6:]
    w1, w2, w3 = displacement[2:], displacement[1:], displacement
    v0, v1, v2, v3 = velocity[3:], velocity[4:], velocity[5:], velocity[6:]
    y1, y2, y3 = velocity[2:], velocity[1:], velocity
    inner = force[3:]
    for i in range(n - 2 * WIDTH):
        elastic = k0[i] * u0[i] + k1[i] * u1[i] + k2[i] * u2[i] + k3[i] * u3[i]
        elastic += l1[i] * w1[i] + l2[i] * w2[i] + l3[i] * w3[i]
        viscous = c0[i] * v0[i] + c1[i] * v1[i] + c2[i] * v2[i] + c3[i] * v3[i]
        viscous += d1[i] * y1[i] + d2[i] * y2[i] + d3[i] * y3[i]
        inner[i] = -(elastic + viscous)


@njit(cache=True, fastmath=True)
def dot(first, second):
    """Sum of products, in the order that is fastest."""
    total = 0.0
    for i in range(first.size):
        total += first[i] * second[i]
    return total


@njit(cache=True, fastmath=FAST)
def shape_functions(x, first_node, element, last, number, places, values, slopes):
    """Cubic Hermite functions at x and their slopes; a constrained unknown gets the place 0 and the value 0."""
    at = (x - first_node) / element
    e = min(max(int(np.floor(at)), 0), last)
    s = at - e
    values[0] = 1.0 + s * s * (2.0 * s - 3.0)
    values[1] = element * s * (1.0 + s * (s - 2.0))
    values[2] = s * s * (3.0 - 2.0 * s)
    values[3] = element * s * s * (s - 1.0)
    slopes[0] = 6.0 * s * (s - 1.0) / element
    slopes[1] = 1.0 + s * (3.0 * s - 4.0)
    slopes[2] = -slopes[0]
    slopes[3] = s * (3.0 * s - 2.0)
    for q in range(4):
        place = number[2 * e + q]
        if place < 0:
            place, values[q], slopes[q] = 0, 0.0, 0.0
        places[q] = place


@njit(cache=True, fastmath=FAST)
def eliminate(matrix, right):
    """Solve a small dense system in place, with partial pivoting; the solution is left in `right`."""
    n = right.size
    for i in range(n):
        p = i
        for r in range(i + 1, n):
            if abs(matrix[r, i]) > abs(matrix[p, i]):
                p = r
        if p != i:
            for c in range(n):
                matrix[i, c], matrix[p, c] = matrix[p, c], matrix[i, c]
            right[i], right[p] = right[p], right[i]
        for r in range(i + 1, n):
            ratio = matrix[r, i] / matrix[i, i]
            for c in range(i + 1, n):
                matrix[r, c] -= ratio * matrix[i, c]
            right[r] -= ratio * right[i]
    for i in range(n - 1, -1, -1):
        for c in range(i + 1, n):
            right[i] -= matrix[i, c] * right[c]
        right[i] /= matrix[i, i]


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
    # Road: bands of mass, damping and stiffness (4, n), factors of the effective matrix, rows of its inverse.
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
    # State: displacement, velocity, acceleration of road and vehicle; forces on the road, elements moved on.
    road,
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
    n = road.shape[1]
    k = contacts.size
    m = body.shape[1]
    last = number.size // 2 - 2
    reach = inverse.shape[1]
    keep = 1.0 - alpha_f
    u, v, a = road[0], road[1], road[2]
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
            elements = int(np.floor(travelled / mesh[1] + SAME_PLACE)) - shifted[0]
            if elements > 0:
                shifted[0] += elements
                gone = min(2 * elements, n)
                for part in range(3):
                    for i in range(n - gone):
                        road[part, i] = road[part, i + gone]
                    for i in range(n - gone, n):
                        road[part, i] = 0.0
                for j in range(k):
                    for q in range(4):
                        before[j, q] -= gone
            travelled -= shifted[0] * mesh[1]
        for j in range(k):
            shape_functions(
                contacts[j] + travelled, mesh[0], mesh[1], last, number, places[j], values[j], slopes[j]
            )
        # What the road would do without the contact forces of this step.
        free_a_u, free_a_v = (0.5 - beta) * dt * dt, (1.0 - gamma) * dt
        for i in range(n):
            at_u[i] = u[i] + keep * (dt * v[i] + free_a_u * a[i])
            at_v[i] = v[i] + keep * free_a_v * a[i]
        product(stiffness, damping, at_u, at_v, right)
        if alpha_m != 0.0:
            for i in range(n):
                right[i] -= alpha_m * mass[0, i] * a[i]
            for d in range(1, WIDTH + 1):
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

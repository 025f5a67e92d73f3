"""Banded linear algebra of a guideway and a few unknowns, and the vehicle's half of a step, compiled."""

from __future__ import annotations

import numpy as np
from numba import njit

# What the compiler may do: round a product and a sum once instead of twice; nothing else that changes results.
FAST = {"contract", "nsz"}

# Half-width of the bands of cubic elements with two unknowns at a node.
HALF_WIDTH = 3


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
    work = np.zeros((2, half + HALF_WIDTH, 4))
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
    for b in range(HALF_WIDTH):
        for d in range(HALF_WIDTH - b):
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
    for r in range(HALF_WIDTH):
        for near in range(HALF_WIDTH - r):
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
def inverse_rows(rows, columns, core, reach, first):
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
def band_product(stiffness, damping, displacement, velocity, force):
    """Force = −(K u + C v) for band matrices."""
    n = force.size
    for edge in range(2 * HALF_WIDTH):
        i = edge if edge < HALF_WIDTH else n - 2 * HALF_WIDTH + edge
        total = stiffness[0, i] * displacement[i] + damping[0, i] * velocity[i]
        for d in range(1, HALF_WIDTH + 1):
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
    for i in range(n - 2 * HALF_WIDTH):
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


# The vehicle's half of a step; `half_step.HalfStep` has the same in NumPy and says what each does. They are put
# into the loops that call them: as calls, or with an array taken out of the tuple more than once, a step took half
# as long again.


@njit(cache=True, fastmath=FAST, inline="always")
def freed(half, body, before, push, free):
    """Motion after the step without its contact forces, left in `free`; `push` is scratch (dof,)."""
    step, free_u, free_v, lift_u, lift_v, keep, alpha_m, alpha_f = half.rule
    mass, damping, stiffness, contact_map, _, _ = half.tie
    inverse = half.inverse
    m = body.shape[1]
    for i in range(m):
        free[0, i] = body[0, i] + step * body[1, i] + free_u * body[2, i]
        free[1, i] = body[1, i] + free_v * body[2, i]
    for i in range(m):
        total = 0.0
        for p in range(m):
            total -= stiffness[i, p] * free[0, p] + damping[i, p] * free[1, p]
        push[i] = total
    if alpha_m != 0.0 or alpha_f != 0.0:
        for i in range(m):
            total = keep * push[i]
            for p in range(m):
                old = stiffness[i, p] * body[0, p] + damping[i, p] * body[1, p]
                total -= alpha_f * old + alpha_m * mass[i, p] * body[2, p]
            for s in range(before.size):
                total -= alpha_f * contact_map[s, i] * before[s]
            push[i] = total
    for i in range(m):
        total = 0.0
        for p in range(m):
            total += inverse[i, p] * push[p]
        free[2, i] = total
        free[0, i] += lift_u * total
        free[1, i] += lift_v * total


@njit(cache=True, fastmath=FAST, inline="always")
def met(half, free, step, roughness, rate, down, sinking, yields, yielding, matrix, right):
    """Contact forces of the step: matrix · F = right."""
    _, _, _, contact_map, springs, dashpots = half.tie
    fixed = half.fixed
    k = right.size
    for j in range(k):
        up = rising = 0.0
        for i in range(free.shape[1]):
            up += contact_map[j, i] * free[0, i]
            rising += contact_map[j, i] * free[1, i]
        elastic = springs[j] * (up - down[j] + roughness[step, j])
        right[j] = elastic + dashpots[j] * (rising - sinking[j] + rate[step, j])
        for s in range(k):
            matrix[j, s] = fixed[j, s] + springs[j] * yields[j, s] + dashpots[j] * yielding[j, s]


@njit(cache=True, fastmath=FAST, inline="always")
def taken(half, body, free, force):
    """Bring a vehicle to the end of the step, in place."""
    lift_u, lift_v, lifted = half.rule.lift_u, half.rule.lift_v, half.lifted
    for i in range(body.shape[1]):
        gained = 0.0
        for s in range(force.size):
            gained += lifted[i, s] * force[s]
        body[0, i] = free[0, i] + lift_u * gained
        body[1, i] = free[1, i] + lift_v * gained
        body[2, i] = free[2, i] + gained


@njit(cache=True, fastmath=FAST, inline="always")
def balanced(half, body, force, push, acceleration):
    """Acceleration that fits displacement, velocity and contact forces; `push` is scratch (dof,)."""
    _, damping, stiffness, contact_map, _, _ = half.tie
    inverse = half.mass_inverse
    m = body.shape[1]
    for i in range(m):
        push[i] = 0.0
        for p in range(m):
            push[i] -= stiffness[i, p] * body[0, p] + damping[i, p] * body[1, p]
        for s in range(force.size):
            push[i] -= contact_map[s, i] * force[s]
    for i in range(m):
        acceleration[i] = 0.0
        for p in range(m):
            acceleration[i] += inverse[i, p] * push[p]

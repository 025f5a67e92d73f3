"""Many small matrices, one per frequency: products, solutions, and how many at a time."""

from __future__ import annotations

from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass

import numpy as np
from threadpoolctl import threadpool_limits

from movingfrf._basics.arrays import ComplexArray


@dataclass(frozen=True, slots=True, kw_only=True)
class Batch:
    """How many frequencies are solved at a time, so that their arrays stay within the processor's cache.

    In brackets, between what each number is safe; they cost time and memory only.
    """

    most: int = 4096  # frequencies [256 to 65 536]
    entries: int = 2**18  # of the matrices of all of them: of many contacts, fewer frequencies [2**14 to 2**22]
    fewest: int = 16  # frequencies, of however many contacts [1 to 256]


BATCH = Batch()


def chunk_for(contacts: int) -> int:
    """Frequencies to solve at a time with so many contacts."""
    return max(min(BATCH.most, BATCH.entries // contacts**2), BATCH.fewest)


def unthreaded(contacts: int) -> AbstractContextManager[object]:
    """Keep LAPACK to one thread: many small matrices gain nothing by two, and lose tenfold if one has to wait."""
    return threadpool_limits(limits=1) if contacts > 2 else nullcontext()


def solve_contacts(frf: ComplexArray, stiffness: ComplexArray, gap: ComplexArray) -> ComplexArray:
    """Solve (I + D G) F = D R for each frequency.

    Parameters
    ----------
    frf : ndarray, shape (frequency, contact, contact)
        Moving FRF G [m/N].
    stiffness : ndarray, shape (frequency, contact, contact)
        Dynamic stiffness D of the vehicle [N/m].
    gap : ndarray, shape (frequency, contact, case)
        Elevation R under the contacts [m].

    Returns
    -------
    ndarray, shape (frequency, contact, case)
        Contact forces F [N].
    """
    count = frf.shape[1]
    system = np.eye(count) + matrix_product(stiffness, frf)
    right = matrix_product(stiffness, gap)
    if count == 1:
        return right / system
    if count == 2:  # Cramer's rule: several times faster than LAPACK on batches of this size
        (a, b), (c, d) = (system[:, row, :, None].swapaxes(0, 1) for row in range(2))
        determinant = a * d - b * c
        front, rear = right[:, 0], right[:, 1]
        solution = np.empty((2, *front.shape[::-1]), complex).T.swapaxes(1, 2)
        solution[:, 0] = (d * front - b * rear) / determinant
        solution[:, 1] = (a * rear - c * front) / determinant
        return solution
    return np.linalg.solve(system, right)


def matrix_product(left: ComplexArray, right: ComplexArray) -> ComplexArray:
    """Matrix product for each frequency, shapes (frequency, i, j) and (frequency, j, k)."""
    if left.shape[1] > 2:
        return left @ right
    # Up to two contacts the loops over i, j and k are the short ones: let the processor loop over frequency.
    return np.add.reduce([left[:, :, j, None] * right[:, j, None, :] for j in range(left.shape[2])])

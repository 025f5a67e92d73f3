"""Many small matrices, one per frequency, frequency last: products, solutions, and how many at a time."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import nullcontext
from dataclasses import dataclass
from functools import cache, wraps
from typing import TYPE_CHECKING, ParamSpec, TypeVar

import numpy as np

from movingfrf._basics.arrays import ComplexArray

if TYPE_CHECKING:
    from threadpoolctl import ThreadpoolController


@dataclass(frozen=True, slots=True, kw_only=True)
class Batch:
    """How many frequencies are solved at a time, so that their arrays stay within the processor's cache.

    In brackets, between what each number is safe; they cost time and memory only.
    """

    most: int = 4096  # frequencies [256 to 65 536]
    entries: int = 2**18  # of the matrices of all of them: of many contacts, fewer frequencies [2**14 to 2**22]
    fewest: int = 16  # frequencies, of however many contacts [1 to 256]
    at_once: int = 8  # contacts of a train; more are solved car by car [2 to 32]
    bytes_per_value: int = 100  # per frequency, output and contact at the peak of a transfer or a random response
    looped: int = 16  # columns of a matrix, up to which BLAS gains nothing from so many small ones [2 to 32]

    def frequencies(self, entries: int) -> int:
        """Frequencies to solve at a time with so many entries of a matrix at each."""
        return max(min(self.most, self.entries // entries), self.fewest)

    def some(self, count: int, entries: int) -> Iterator[slice]:
        """Go through so many frequencies, as many at a time."""
        step = self.frequencies(entries)
        yield from (slice(first, first + step) for first in range(0, count, step))


BATCH = Batch()

Taken = ParamSpec("Taken")
Given = TypeVar("Given")


def unthreaded(function: Callable[Taken, Given]) -> Callable[Taken, Given]:
    """Keep BLAS and LAPACK to one thread while a function runs.

    Many small matrices and thin products gain nothing by two, take twice the processor's time, and lose tenfold if
    one thread has to wait.
    """

    @wraps(function)
    def on_one_thread(*args: Taken.args, **keywords: Taken.kwargs) -> Given:
        _keeps_memory()
        pools = _threads()
        with pools.limit(limits=1) if pools else nullcontext():
            return function(*args, **keywords)

    return on_one_thread


@cache
def _keeps_memory() -> None:
    """Let the C library keep what is freed, once: to have pages cleared anew takes a third of a case's time.

    From then on glibc keeps up to twice as much as the largest block that was freed, if that is below 32 MiB.
    """
    np.empty(31 * 2**20, np.uint8)


@cache
def _threads() -> ThreadpoolController | None:
    """Find NumPy's thread pools, once: that takes as long as a quarter car's response.

    None without threadpoolctl, as in a browser, which has no threads.
    """
    try:
        from threadpoolctl import ThreadpoolController
    except ImportError:
        return None
    return ThreadpoolController()


def applied(matrices: ComplexArray, columns: ComplexArray) -> ComplexArray:
    """Multiply a matrix per frequency with columns.

    Parameters
    ----------
    matrices : ndarray, shape (i, j, frequency)
        The matrices.
    columns : ndarray, shape (*case, j, frequency)
        Columns, any number of them.

    Returns
    -------
    ndarray, shape (*case, i, frequency)
        Products.
    """
    if matrices.shape[1] > BATCH.looped:
        first = np.moveaxis(matrices, -1, 0), np.moveaxis(columns.reshape(-1, *columns.shape[-2:]), (2, 1), (0, 1))
        product = np.matmul(*(np.ascontiguousarray(part) for part in first))
        return np.moveaxis(product, (0, 1), (2, 1)).reshape(*columns.shape[:-2], *matrices.shape[::2])
    # The loops over i, j and cases are the short ones: let the processor loop over frequency.
    product = matrices[:, 0] * columns[..., 0, None, :]
    for j in range(1, matrices.shape[1]):
        product += matrices[:, j] * columns[..., j, None, :]
    return product


def multiplied(left: ComplexArray, right: ComplexArray) -> ComplexArray:
    """Multiply matrices per frequency, shapes (i, j, frequency) and (j, k, frequency)."""
    return applied(left, right.swapaxes(0, 1)).swapaxes(0, 1)


def solved(matrices: ComplexArray, right: ComplexArray) -> ComplexArray:
    """Solve a linear system per frequency.

    Parameters
    ----------
    matrices : ndarray, shape (j, j, frequency)
        The matrices.
    right : ndarray, shape (*case, j, frequency)
        Right-hand sides, any number of them.

    Returns
    -------
    ndarray, shape (*case, j, frequency)
        Solutions.
    """
    count = len(matrices)
    if count == 1:
        return right / matrices[0]
    if count == 2:  # Cramer's rule: several times faster than LAPACK on batches of this size
        (a, b), (c, d) = matrices
        determinant = a * d - b * c
        first, second = right[..., 0, :], right[..., 1, :]
        solution = np.empty(right.shape, complex)
        np.divide(d * first - b * second, determinant, out=solution[..., 0, :])
        np.divide(a * second - c * first, determinant, out=solution[..., 1, :])
        return solution
    columns = np.moveaxis(right.reshape(-1, *right.shape[-2:]), (2, 1), (0, 1))
    found = np.linalg.solve(np.moveaxis(matrices, -1, 0), columns)
    return np.moveaxis(found, (0, 1), (2, 1)).reshape(right.shape)

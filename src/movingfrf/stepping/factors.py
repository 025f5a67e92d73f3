"""Symmetric positive definite matrices, factorised once."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sparse
from scipy.linalg import lapack
from scipy.sparse.linalg import splu

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import SolveError


def indefinite() -> SolveError:
    """Say that no step can be taken."""
    return SolveError(
        "the road's matrices are inconsistent: mass, damping and stiffness together are not positive definite, so "
        "no step can be taken"
    )


def bands_of(matrix: sparse.csc_array, width: int) -> FloatArray:
    """Lower bands of a symmetric matrix, `bands[d, i]` being A[i + d, i]."""
    bands = np.zeros((width + 1, matrix.shape[0]))
    for d in range(width + 1):
        diagonal = matrix.diagonal(-d)
        bands[d, : diagonal.size] = diagonal
    return bands


def half_width(matrix: sparse.csc_array) -> int:
    """Find how far from the diagonal a matrix has entries."""
    places = sparse.coo_array(matrix)
    return int(np.abs(places.row - places.col).max(initial=0))


def is_definite(matrix: sparse.csc_array) -> bool:
    """Tell whether a symmetric matrix is positive definite."""
    try:
        solver(matrix)
    except (SolveError, RuntimeError):  # SuperLU's word for an exactly singular matrix
        return False
    return True


def solver(matrix: sparse.csc_array) -> BandSolver | SparseSolver:
    """Factorise a positive definite matrix."""
    # Bands wider than this are left to the sparse solver [any: of speed alone].
    widest = 64
    return BandSolver(matrix) if half_width(matrix) <= widest else SparseSolver(matrix)


class BandSolver:
    """LAPACK's band Cholesky factorisation."""

    def __init__(self, matrix: sparse.csc_array) -> None:
        self._factor, fails = lapack.dpbtrf(bands_of(matrix, half_width(matrix)), lower=1)
        if fails:
            raise indefinite()

    def solve(self, right: FloatArray) -> FloatArray:
        """Solve for one or more columns."""
        solution, _ = lapack.dpbtrs(self._factor, right, lower=1)
        return solution


class SparseSolver:
    """SuperLU, with the pivots of a symmetric matrix."""

    def __init__(self, matrix: sparse.csc_array) -> None:
        options = {"SymmetricMode": True}
        self._factor = splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)
        if not (self._factor.U.diagonal() > 0).all():
            raise indefinite()

    def solve(self, right: FloatArray) -> FloatArray:
        """Solve for one or more columns."""
        return self._factor.solve(right)

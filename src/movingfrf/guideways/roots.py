"""All roots of a polynomial at each of many frequencies, from one frequency to the next (Aberth and Ehrlich).

Each root moves by Newton's step, the pull of the other roots taken out of it: all roots of a polynomial are found
at once, and no two of them are the same one. Roots move little from frequency to frequency: one step is enough, or
two.

References
----------
O. Aberth, Iteration methods for finding all zeros of a polynomial simultaneously, Mathematics of Computation 27,
1973.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from movingfrf._basics.arrays import ComplexArray, IntArray, squared


@dataclass(frozen=True, slots=True, kw_only=True)
class RootSearch:
    """What tunes the search for the waves, and for the side of the real axis on which each of them counts.

    In brackets, between what each number is safe.
    """

    # Below this speed the moving frame differs from the fixed one by rounding errors, while the roots that run away
    # to infinity as v → 0 (one per κⁿ that v alone keeps alive) begin to cost digits.
    at_rest: float = 1e-13  # [m/s; 1e-15 to 1e-12]
    # What so many rounding errors of the dynamic stiffness could bring about counts as there: a root that they
    # could put on the real axis is real and belongs where damping would push it; between two that they could make
    # one the contour is pinched, and the response infinite. What is let through is right to about the inverse.
    rounding_errors: float = 1e4  # [1e3 to 1e6]
    # A root has settled when the next step would move it by less than this share of it; and before that by less
    # than the other one, since to first order that is only so for single roots.
    settled: float = 1e-15  # [1e-16 to 1e-13]
    near: float = 1e-4  # [1e-6 to 1e-3]
    # Steps, and how many of them until roots that have not settled are moved off every symmetry: from a conjugate
    # pair no two real roots are ever reached, and from one place no two at all.
    most_steps: int = 200  # [100 to 400]
    patience: int = 8  # [6 to 16]
    askew: complex = 6e-7 + 8e-7j  # [1e-8 to 1e-5 in magnitude]
    # In NumPy the eigenvalues of companion matrices are the roots at some frequencies, and a cubic through four of
    # these leads to those between. So far apart they are at most, and so many there are at least.
    apart: int = 80  # [32 to 160: time only]
    fewest: int = 16  # [1 to 64: time only]

    # Compiled, steps between frequencies that grow by more than this factor tell nothing of how roots go on.
    uneven: float = 2.0  # [1.5 to 4: time only]
    # Frequencies that are even but for this share of their step are taken side by side, so many, or else so few; if
    # their roots have not settled within so many steps, they are taken one by one.
    even: float = 1e-6  # [1e-9 to 1e-4: time only]
    abreast: int = 64  # [32 to 128: time only]
    few_abreast: int = 32  # [16 to 64: time only]
    quickly: int = 4  # [2 to 8: time only]

    @property
    def uncertain(self) -> float:
        """What is less than this share of all terms of a dynamic stiffness counts as nothing."""
        return self.rounding_errors * float(np.finfo(float).eps)

    @property
    def numbers(self) -> tuple[float, float, int, int, complex, float, float, int, int, int]:
        """What compiled loops take of it: the first two squared."""
        return (
            self.near**2,
            self.settled**2,
            self.most_steps,
            self.patience,
            self.askew,
            self.uneven,
            self.even,
            self.abreast,
            self.quickly,
            self.few_abreast,
        )


ROOTS = RootSearch()


def wavenumbers(coefficients: ComplexArray) -> tuple[ComplexArray, IntArray]:
    """All roots κ of each polynomial [rad/m].

    Parameters
    ----------
    coefficients : ndarray, shape (degree + 1, frequency)
        Coefficients of ascending powers of κ; the last row has no zero.

    Returns
    -------
    roots : ndarray, shape (degree, frequency)
        As a rule each continued in its row; at every frequency in any order.
    unsettled : ndarray
        Numbers of the frequencies at which some still move: those of multiple roots, and of none that were found.
    """
    count = coefficients.shape[1]
    apart = min(max(count // ROOTS.fewest, 1), ROOTS.apart)
    some = coefficients[:, ::apart]
    anchors = _settled(some, _eigenvalues(some))[0]
    if apart == 1:
        return _settled(coefficients, anchors)
    return _settled(coefficients, _between(_continued(anchors), apart)[:, :count])


def inverse(values: ComplexArray) -> ComplexArray:
    """Reciprocal, in a third of the time of a complex division; beyond 1e±150 it is 0 or not finite."""
    size = squared(values)
    np.reciprocal(size, out=size)
    found = np.empty_like(values)
    np.multiply(values.real, size, out=found.real)
    np.negative(size, out=size)
    np.multiply(values.imag, size, out=found.imag)
    return found


def _eigenvalues(coefficients: ComplexArray) -> ComplexArray:
    """Roots as eigenvalues of companion matrices; of roots of very different size the small ones lack digits."""
    degree = len(coefficients) - 1
    companion = np.zeros((coefficients.shape[1], degree, degree), complex)
    companion[:, np.arange(1, degree), np.arange(degree - 1)] = 1.0
    companion[:, :, -1] = -(coefficients[:-1] / coefficients[-1]).T
    return np.ascontiguousarray(np.linalg.eigvals(companion).T)


def _continued(roots: ComplexArray) -> ComplexArray:
    """Put roots into the rows of those nearest at the frequency before, where that is no matter of choice."""
    degree = len(roots)
    nearest = squared(roots[:, None, :-1] - roots[None, :, 1:]).argmin(axis=1)
    clear = (np.sort(nearest, axis=0) == np.arange(degree)[:, None]).all(axis=0)
    order = list(range(degree))
    orders = [order]
    for before, certain in zip(nearest.T.tolist(), clear.tolist(), strict=True):
        order = [before[row] for row in order] if certain else order
        orders.append(order)
    return np.take_along_axis(roots, np.array(orders).T, axis=0)


def _between(anchors: ComplexArray, apart: int) -> ComplexArray:
    """Lead on from every root to the next: a cubic through four of them, shape (degree, apart times as many)."""
    degree, count = anchors.shape
    nodes = np.arange(min(count, 4))
    first = np.clip(np.arange(count) - 1, 0, count - nodes.size)
    within = np.arange(count) - first
    powers = np.linalg.inv(np.vander(nodes, increasing=True)).T.astype(complex)
    led = np.empty((degree, count, apart), complex)
    for begins in set(within.tolist()):
        # Counted from the first of the four.
        weights = powers @ (begins + np.arange(apart) / apart) ** nodes[:, None]
        here = np.flatnonzero(within == begins)
        through = anchors[:, first[here, None] + nodes].reshape(-1, nodes.size)
        led[:, here] = (through @ weights).reshape(degree, -1, apart)
    return led.reshape(degree, -1)


def _settled(coefficients: ComplexArray, roots: ComplexArray) -> tuple[ComplexArray, IntArray]:
    """Move all roots until they stay where they are, (degree, frequency), and say where they do not."""
    moving, turn = roots, np.arange(len(roots))[:, None]
    far: IntArray | None = None
    for number in range(1, ROOTS.most_steps + 1):
        with np.errstate(all="ignore"):
            step, others = _step(coefficients, moving)
            if not np.isfinite(step.sum()):
                # At a multiple root the slope vanishes and so does the need to move.
                step[~np.isfinite(step)] = 0.0
            moving -= step
            size, moved = squared(moving), squared(step)
            # What is left is of third order: δ³ over the square of the distance from the others.
            left = moved * (moved * (squared(others) * size + 1.0)) ** 2
            unsettled = ~((moved <= ROOTS.near**2 * size) & (left <= ROOTS.settled**2 * size**3)).all(axis=0)
        if far is not None:
            roots[:, far] = moving
        if not unsettled.any():
            return roots, np.zeros(0, int)
        still = np.flatnonzero(unsettled)
        far = still if far is None else far[still]
        coefficients, moving = coefficients[:, still], moving[:, still]
        if number % ROOTS.patience == 0:
            moving *= 1.0 + ROOTS.askew * turn
    assert far is not None  # something has not settled
    return roots, far


def _step(coefficients: ComplexArray, roots: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
    """Step to take off each root, and the sum of its inverse distances from the others."""
    degree = len(roots)
    # Horner's rule for the value and the slope at once.
    value, slope = coefficients[degree] * roots, np.empty_like(roots)
    slope[:] = coefficients[degree]
    value += coefficients[degree - 1]
    for row in coefficients[degree - 2 :: -1] if degree > 1 else ():
        slope *= roots
        slope += value
        value *= roots
        value += row
    others = np.zeros_like(roots)
    for number in range(degree - 1):
        apart = inverse(roots[number] - roots[number + 1 :])
        others[number] += apart.sum(axis=0)
        others[number + 1 :] -= apart
    pulled = inverse(slope - value * others)
    pulled *= value
    return pulled, others

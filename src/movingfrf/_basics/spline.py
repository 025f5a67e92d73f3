"""Cubic splines and what else consists of polynomials piece by piece.

SciPy's are as good; the package that holds them takes longer to import than a whole run of a scenario to solve.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg.lapack import dgtsv

from movingfrf._basics.arrays import FloatArray, handed
from movingfrf._basics.compiling import loops_for
from movingfrf._basics.values import Value


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Piecewise(Value):
    """Polynomials from knot to knot, the first and the last of them going on beyond.

    Parameters
    ----------
    x : ndarray, shape (knot,)
        Knots, increasing, in any unit.
    c : ndarray, shape (power, *more, piece)
        Coefficients of the powers of the distance from a piece's first knot, the highest power first.
    """

    x: FloatArray
    c: FloatArray

    def __call__(self, at: ArrayLike, order: int = 0) -> FloatArray:
        """Evaluate a derivative.

        Parameters
        ----------
        at : array_like
            Places, in the unit of the knots.
        order : int
            Order of the derivative; 0 is the value itself.

        Returns
        -------
        ndarray, shape (*more, *at.shape)
            Values.
        """
        places = np.asarray(at, dtype=float)
        flat = places.ravel()
        # Of a few places NumPy's answer is as soon there: a unit of work is sixteen of them.
        if self.c.ndim == 2 and (loops := loops_for("_basics.compiled", flat.size // 16)):
            known = [np.ascontiguousarray(part).view() for part in (self.x, self.c)]
            for part in known:
                part.setflags(write=False)
            return loops.piecewise(*known, handed(flat, float), order).reshape(places.shape)
        inner = self.x[1:-1]
        first, last = np.searchsorted(inner, flat[[0, -1]], side="right").tolist() if flat.size else (0, 0)
        if flat.size > last - first > 0 and (flat[1:] >= flat[:-1]).all():
            # Ascending places are shared out among the pieces: what belongs to a piece is repeated, not picked.
            before = np.searchsorted(flat, inner[first:last], side="left")
            pieces = np.diff(before, prepend=0, append=flat.size)

            def each(values: FloatArray) -> FloatArray:
                return np.repeat(values[..., first : last + 1], pieces, axis=-1)
        else:
            place = np.searchsorted(inner, flat, side="right")

            def each(values: FloatArray) -> FloatArray:
                return values[..., place]

        degree = len(self.c) - 1
        if order > degree:
            return np.zeros((*self.c.shape[1:-1], *places.shape))
        from_knot = flat - each(self.x[:-1])
        found = np.zeros((*self.c.shape[1:-1], flat.size))
        for row, power in enumerate(range(degree, order - 1, -1)):
            if row:
                found *= from_knot
            falling = float(np.prod(np.arange(power, power - order, -1)))
            found += each(self.c[row] if falling == 1.0 else falling * self.c[row])
        return found.reshape((*self.c.shape[1:-1], *places.shape))

    def antiderivative(self) -> Piecewise:
        """Integrate from the first knot on."""
        powers = np.arange(len(self.c), 0, -1.0).reshape(-1, *[1] * (self.c.ndim - 1))
        raised = np.concatenate([self.c / powers, np.zeros_like(self.c[:1])])
        width = np.diff(self.x)
        gained = np.zeros_like(self.c[0])
        for row in raised:
            gained = gained * width + row
        raised[-1, ..., 1:] = np.cumsum(gained, axis=-1)[..., :-1]
        return Piecewise(self.x, raised)


def cubic(
    x: FloatArray, y: FloatArray, *, first: ArrayLike | None = None, last: ArrayLike | None = None
) -> Piecewise:
    """Make the cubic spline through points.

    Parameters
    ----------
    x : ndarray, shape (knot,)
        Knots, increasing, at least two.
    y : ndarray, shape (*more, knot)
        Values there.
    first, last : array_like, shape (*more), optional
        Slope at an end. None: the third derivative does not jump at the knot next to it ("not a knot"); through
        three points goes a parabola then, through two a straight line.

    Returns
    -------
    Piecewise
        With four coefficients a piece.

    Notes
    -----
    C. de Boor, A Practical Guide to Splines, Springer, 1978, chapter IV.

    Examples
    --------
    >>> x = np.linspace(0.0, 1.0, 5)
    >>> spline = cubic(x, x**3)
    >>> round(float(spline(0.3)), 12), round(float(spline(0.3, 1)), 12)
    (0.027, 0.27)
    """
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    if y.ndim == 1 and x.size >= 4 and (loops := loops_for("_basics.compiled", x.size // 16)):
        slopes = (np.nan if slope is None else float(np.asarray(slope)) for slope in (first, last))
        return Piecewise(x, loops.cubic(handed(x, float), handed(y, float), *slopes))
    width = np.diff(x)
    rise = np.diff(y) / width
    if x.size < 4:
        first, last = _few(width, rise, first, last)
    size = x.size
    below, middle, above = np.empty(size - 1), np.empty(size), np.empty(size - 1)
    right = np.empty(y.shape)
    # The slopes at the knots: the second derivative jumps at none.
    middle[1:-1] = 2.0 * (width[:-1] + width[1:])
    above[1:], below[:-1] = width[:-1], width[1:]
    right[..., 1:-1] = 3.0 * (width[1:] * rise[..., :-1] + width[:-1] * rise[..., 1:])
    if first is None:
        middle[0], above[0] = width[1], width[0] + width[1]
        outer = (width[0] + 2.0 * above[0]) * width[1] * rise[..., 0]
        right[..., 0] = (outer + width[0] ** 2 * rise[..., 1]) / above[0]
    else:
        middle[0], above[0], right[..., 0] = 1.0, 0.0, first
    if last is None:
        middle[-1], below[-1] = width[-2], width[-1] + width[-2]
        outer = (width[-1] + 2.0 * below[-1]) * width[-2] * rise[..., -1]
        right[..., -1] = (outer + width[-1] ** 2 * rise[..., -2]) / below[-1]
    else:
        middle[-1], below[-1], right[..., -1] = 1.0, 0.0, last
    *_, solved, _ = dgtsv(below, middle, above, right.reshape(-1, size).T)
    slope = np.asarray(solved).T.reshape(y.shape)
    bend = (slope[..., :-1] + slope[..., 1:] - 2.0 * rise) / width
    pieces = [bend / width, (rise - slope[..., :-1]) / width - bend, slope[..., :-1], y[..., :-1]]
    return Piecewise(x, np.stack(pieces))


def _few(
    width: FloatArray, rise: FloatArray, first: ArrayLike | None, last: ArrayLike | None
) -> tuple[ArrayLike | None, ArrayLike | None]:
    """Slopes at the ends of a line through two points or a parabola through three, where none are given."""
    if width.size == 1:
        return rise[..., 0] if first is None else first, rise[..., 0] if last is None else last
    if first is None and last is None:
        bend = (rise[..., 1] - rise[..., 0]) / (width[0] + width[1])
        return rise[..., 0] - bend * width[0], rise[..., 1] + bend * width[1]
    return first, last

"""Cubic splines against SciPy's, an independent route to the same polynomials."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from movingfrf._basics.spline import cubic


@pytest.mark.parametrize("knots", [2, 3, 4, 5, 60])
@pytest.mark.parametrize("more", [(), (3,), (2, 3)])
@pytest.mark.parametrize("slopes", [(None, None), (0.3, None), (None, -0.2), (0.1, 0.4)])
def test_a_spline_is_scipys(knots, more, slopes):
    rng = np.random.default_rng(knots)
    x = np.cumsum(rng.uniform(0.1, 1.0, knots))
    y = rng.normal(size=(*more, knots))
    ends = ["not-a-knot" if slope is None else (1, np.full(more, slope)) for slope in slopes]
    theirs = CubicSpline(x, y, axis=-1, bc_type=ends)
    ours = cubic(x, y, first=slopes[0], last=slopes[1])
    ascending = np.sort(rng.uniform(x[0] - 0.5, x[-1] + 0.5, 50))
    for at in (ascending, rng.permutation(ascending).reshape(10, 5), x, x[:1], ascending[7]):
        for order in range(5):
            expected = theirs(at, order)
            scale = 1.0 + np.abs(theirs.c).max()
            if order < 3 or at is not x:  # a third derivative jumps at knots
                np.testing.assert_allclose(ours(at, order), expected, rtol=0, atol=1e-12 * scale)
        if knots > 3:
            np.testing.assert_allclose(
                ours.antiderivative()(at), theirs.antiderivative()(at), rtol=0, atol=1e-12 * scale
            )

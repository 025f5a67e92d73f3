"""The closed form against the mean of journeys over realised roads, response by response and band by band."""

from __future__ import annotations

import numpy as np
import pytest

from tests.cross.realisations import CASES, compared, densities, expected

# Fewer than a proof needs, for speed: `python -m benchmarks.random_roads` takes 400.
REALISATIONS = 80


@pytest.mark.parametrize("name", CASES)
def test_mean_of_realisations(name):
    """Variances in octaves within the confidence interval of their mean.

    Of Student's t with 79 degrees of freedom |t| > 4 has a probability of 1e-4, for each of the 120 variances at
    most, which hang together. Errors of that size: 1 to 14 %, and of a wrong delay or coherence ten times as much.
    """
    found = compared(CASES[name], range(REALISATIONS))
    assert np.abs(found.t).max() < 4.0
    assert np.mean(found.t**2) < 2.5
    assert np.median(found.error / found.mean) < 0.06
    # The largest value of 16 s: bursts of a narrow band make it smaller than independent crossings would.
    assert ((found.peak > 0.88) & (found.peak < 1.04)).all()


@pytest.mark.parametrize("name", CASES)
def test_expectation_of_the_estimator(name):
    """What the window leaks falls into a neighbouring band, and nothing is lost: the variances add up to the total.

    Densities integrated by trapezoids in steps of 1/256 Hz, a fifteenth of the narrowest resonance.
    """
    case = CASES[name]
    result = case.predicted()
    whole = densities(result) @ result.bandwidth.values
    assert expected(case)[:, -1] == pytest.approx(whole, rel=1e-3)

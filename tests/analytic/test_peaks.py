"""Peaks between samples, against the same records with sixty-four times as many."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.fft

from movingfrf._basics.compiling import compiling, numba_is_there
from movingfrf._basics.peaks import extremes
from movingfrf.metrics.entry import lowest, peak

WAYS = [False, pytest.param(True, marks=pytest.mark.skipif(not numba_is_there(), reason="numba is not there"))]


def drawn(share: float, seed: int, samples: int = 600, finer: int = 64):
    """Draw a record with content up to a share of its Nyquist frequency, zero at both ends; and the same finer."""
    rng = np.random.default_rng(seed)
    spectrum = np.zeros(samples // 2 + 1, complex)
    count = int(share * samples / 2)
    spectrum[:count] = rng.normal(size=(2, count)).T @ [1.0, 1j]
    coarse, fine = (scipy.fft.irfft(spectrum, n * samples) * n for n in (1, finer))
    return tuple(np.sin(np.pi * np.arange(one.size) / one.size) ** 2 * one for one in (coarse, fine))


@pytest.mark.parametrize("compiled", WAYS)
@pytest.mark.parametrize(("share", "off"), [(0.1, 1e-4), (0.4, 1.5e-4), (0.7, 2e-4)])
def test_extremes_of_what_is_between_samples(share, off, compiled):
    with compiling(compiled):
        missed = 0.0
        for seed in range(40):
            coarse, fine = drawn(share, seed)
            low, high = extremes(coarse)
            extent = np.ptp(fine)
            assert abs(low - fine.min()) < off * extent
            assert abs(high - fine.max()) < off * extent
            missed = max(missed, (fine.max() - coarse.max()) / extent)
    # Samples alone miss far more.
    assert missed > 10 * off or share < 0.2


@pytest.mark.parametrize("compiled", WAYS)
def test_records_without_anything_between(compiled):
    with compiling(compiled):
        for record in (np.zeros(50), np.full(50, -3.0), np.arange(50.0), np.arange(2.0), np.ones(1)):
            low, high = extremes(record)
            assert (low, high) == (record.min(), record.max())
        # A peak near an end is that of a parabola through three samples.
        assert extremes(np.array([0.0, 3.0, 3.0, 0.0]))[1] == pytest.approx(3.375)


def test_every_record_by_itself():
    rows = np.stack([drawn(0.5, seed)[0] for seed in range(6)])
    low, high = extremes(rows.reshape(2, 3, -1))
    each = [extremes(row) for row in rows]
    np.testing.assert_array_equal(np.stack([low.ravel(), high.ravel()], axis=1), each)
    np.testing.assert_array_equal(peak(rows.T), np.maximum(high, -low).ravel())
    np.testing.assert_array_equal(lowest(rows.T), low.ravel())


@pytest.mark.skipif(not numba_is_there(), reason="numba is not there")
def test_compiled_and_in_numpy():
    rows = np.stack([drawn(0.6, seed)[0] for seed in range(20)])
    with compiling(True):
        compiled = extremes(rows)
    with compiling(False):
        np.testing.assert_allclose(extremes(rows), compiled, rtol=1e-12)

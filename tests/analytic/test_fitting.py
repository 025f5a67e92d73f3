"""The fit of ISO 8608 to spectra and profiles that are known, and where there is content to fit."""

from __future__ import annotations

import re

import numpy as np
import pytest

import movingfrf as mf
from movingfrf._basics.welch import welch
from movingfrf.roughness.fitting import fit_iso


def fitted(spectrum, *, length=1000.0, step=0.05, seed=1):
    return fit_iso(*welch(np.asarray(mf.realise(spectrum, length=length, step=step, seed=seed).elevation), step))


@pytest.mark.parametrize("waviness", [-1.0, 0.5, 2.0, 3.3, 12.0])
def test_a_power_law_gives_itself(waviness):
    """Lines so dense that the mean over a band is the integral of n^−w over it, whatever the exponent."""
    n = np.arange(0.001, 5.0, 1e-4)
    fit = fit_iso(n, 3e-5 * (n / 0.1) ** -waviness)
    # The mean of a band is put at the mean of log n, wrong by w(w + 1)/24 of its width squared, 0.48 for an octave.
    assert fit.waviness == pytest.approx(waviness, abs=0.01 * (1 + abs(waviness)) ** 2)
    assert fit.density(np.array([1.0]))[0] == pytest.approx(
        3e-5 * 10**-waviness, rel=0.02 * (1 + abs(waviness)) ** 2
    )
    assert fit.reason == ""
    assert fit.band == pytest.approx((0.011, 2.83), rel=0.01)


@pytest.mark.parametrize("band", [(0.01, 0.5), (0.01, 1.0), (0.01, 2.0), (0.05, 10.0), (0.1, 10.0)])
@pytest.mark.parametrize("waviness", [1.5, 2.0, 3.0])
def test_only_where_a_road_has_content(band, waviness):
    """Eight pieces of 222 m, 20 bands at the least that scatter by a tenth or less: w to some hundredths."""
    fit = fitted(mf.IsoRoad.of_class("B", waviness=waviness, band=band))
    assert fit.waviness == pytest.approx(waviness, abs=0.12)
    assert fit.roughness == pytest.approx(64e-6, rel=0.15)
    # A band of an octave may hang over the lower end by half of its width, one of a twelfth by a twentieth.
    assert band[0] / 1.5 < fit.band[0]
    assert min(band[1] / 1.5, 2.7) < fit.band[1] < 1.06 * band[1]


def test_nothing_is_left_out_of_a_road_with_content_throughout():
    """Of a hundred short roads a few may lose an end to the scatter of single lines; of longer ones none."""
    ends = []
    for seed in range(60):
        slope = np.random.default_rng(seed).normal(size=1000)
        ends.append(fit_iso(*welch(1e-3 * np.cumsum(slope), 0.1)).band)
    low, high = np.array(ends).T
    assert (low > 1.05 * low.min()).mean() < 0.05
    assert (high < 0.95 * high.max()).mean() < 0.05


def test_a_filtered_road_is_fitted_up_to_its_filter():
    """Half of the amplitude, a quarter of the variance, is left of waves of 2.5 steps: 0.4 of the inverse step."""
    road = mf.realise(mf.IsoRoad.of_class("B"), length=2000.0, step=0.05, seed=3)
    coarse = mf.resampled(mf.resampled(road, step=0.5), step=0.05)
    fit = fit_iso(*welch(np.asarray(coarse.elevation), 0.05, segments=16))
    assert 0.5 < fit.band[1] < 0.8
    assert fit.waviness == pytest.approx(2.0, abs=0.05)
    smooth = mf.high_passed(road, wavelength=20.0)
    fit = fit_iso(*welch(np.asarray(smooth.elevation), 0.05, segments=16))
    assert 0.05 < fit.band[0] < 0.13
    assert fit.waviness == pytest.approx(2.0, abs=0.05)


@pytest.mark.parametrize(
    ("fit", "reason"),
    [
        (
            lambda: fit_iso(np.empty(0), np.empty(0)),
            "the profile is level or straight but for rounding, or too short",
        ),
        (
            lambda: fitted(mf.IsoRoad.of_class("B", band=(0.3, 10.0))),
            r"2 octaves that reach to within one of 0.1 cycle/m, and there is content over 0.3\d* to 2.8",
        ),
        (lambda: fitted(mf.IsoRoad.of_class("B", band=(0.004, 0.04)), length=2000.0), "is no power law"),
        # A bend all the way, waviness 0 to 5.
        (
            lambda: fit_iso(n := np.arange(0.001, 5.0, 1e-4), n**-2 * np.exp(-0.5 * np.log(n / 0.2) ** 2)),
            "over 0.011 to 2.83 cycle/m the spectrum is no power law",
        ),
    ],
)
def test_where_there_is_no_fit_the_reason_is_told(fit, reason):
    found = fit()
    assert re.search(reason, found.reason)
    assert found.road_class == ""
    assert np.isnan([found.roughness, found.waviness, found.roughness_at_two]).all()


def test_a_class_far_from_waviness_two_is_doubted():
    """With w = 3 the line through the middle of the bands, 0.7 cycle/m, is 7 times as high at 0.1 as with w = 2."""
    steep = fitted(mf.IsoRoad.of_class("B", waviness=3.0))
    assert steep.road_class == "A"
    assert "passes 0.1 cycle/m in class B" in steep.doubt
    assert fitted(mf.IsoRoad.of_class("B")).doubt == ""

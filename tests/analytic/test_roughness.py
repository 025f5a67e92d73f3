"""Roughness spectra and realised profiles against ISO 8608 and the statistics of their estimators."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.signal import welch
from scipy.stats import chi2

import movingfrf as mf


def test_class_centres():
    """Geometric means, powers of four: PARAMETERS.md; arithmetic centres (20e-6 …) are a common mistake."""
    centres = [16e-6, 64e-6, 256e-6, 1024e-6, 4096e-6, 16_384e-6, 65_536e-6, 262_144e-6]
    for letter, centre in zip("ABCDEFGH", centres, strict=True):
        assert mf.IsoRoad.of_class(letter).roughness == pytest.approx(centre, rel=1e-12)
        assert mf.IsoRoad.of_class(letter.lower()).density(np.array([0.1]))[0] == pytest.approx(centre, rel=1e-12)


def test_class_limits():
    from movingfrf.roughness.spectra.iso import iso_class

    for letter, limit in zip("ABCDEFG", 32e-6 * 4.0 ** np.arange(7), strict=True):
        assert iso_class(0.99 * limit) == letter
        assert iso_class(1.01 * limit) == chr(ord(letter) + 1)


def test_density_follows_its_power_law():
    road = mf.IsoRoad(roughness=16e-6, waviness=2.0, band=(0.01, 10.0))
    n = np.array([0.005, 0.01, 0.1, 1.0, 10.0, 11.0])
    np.testing.assert_allclose(road.density(n), [0, 16e-4, 16e-6, 16e-8, 16e-10, 0], rtol=1e-12)
    steep = mf.IsoRoad(roughness=16e-6, waviness=2.5)
    assert steep.density(np.array([1.0]))[0] == pytest.approx(16e-6 * 10**-2.5, rel=1e-12)


@pytest.mark.parametrize("waviness", [1.0, 1.7, 2.0, 2.6])
@pytest.mark.parametrize("seed", [0, 7])
def test_variance_is_the_area_under_the_one_sided_density(waviness, seed):
    """Each frequency line carries the variance of its share of the band, so a whole period has it exactly.

    ∫ G_d dn by a fine rule in log n; the record is one period.
    """
    road = mf.IsoRoad(roughness=64e-6, waviness=waviness, band=(0.02, 5.0))
    n = np.geomspace(0.02, 5.0, 20_001)
    density = road.density(np.clip(n, 0.02, 5.0))
    area = np.sum((density[1:] + density[:-1]) / 2 * np.diff(n))
    # A period of 2016 halves of the shortest wave: the next number of six binary digits.
    profile = mf.realise(road, length=200.0, step=0.05, seed=seed, covering=(0.0, 201.55))
    elevation = np.asarray(profile.elevation)
    assert elevation.size == 4032
    assert np.mean(elevation**2) == pytest.approx(area, rel=1e-6)


@pytest.mark.parametrize(("letter", "waviness"), [("A", 2.0), ("C", 2.0), ("B", 1.5), ("B", 2.5)])
def test_realised_spectrum_is_the_prescribed_one(letter, waviness):
    """Welch's estimate over the whole band, within the confidence band of the estimator.

    8 km in half-overlapping segments of 256 m: with a Hann window K segments are worth about 36 K²/(19 K − 1)
    independent averages, a χ² of twice as many degrees of freedom; 99.9 % of the frequencies of the band are
    expected within its 0.05 % and 99.95 % quantiles. The window's leakage biases a spectrum that falls with n²
    by (Δn/n)²·w(w + 1)/2, below 1 % from ten lines on.
    """
    spectrum = mf.IsoRoad.of_class(letter, waviness=waviness, band=(0.01, 8.0))
    profile = mf.realise(spectrum, length=8192.0, step=0.05, seed=3)
    segment = int(256 / 0.05)
    elevation = np.asarray(profile.elevation)
    n, density = welch(elevation, 1 / 0.05, nperseg=segment)
    inside = (n > 10 / 256) & (n < 7.9)
    ratio = density[inside] / spectrum.density(n[inside])
    count = 2 * elevation.size // segment - 1
    freedom = 2 * 36 * count**2 / (19 * count - 1)
    low, high = chi2.ppf([5e-4, 1 - 5e-4], freedom) / freedom
    # A profile of fixed amplitudes and random phases scatters less than a Gaussian one, never more.
    assert ((ratio > low) & (ratio < high)).mean() > 0.995
    # Over thirds of octaves the scatter is a few per cent: no part of the band is high or low by 5 %.
    for start in np.geomspace(0.05, 6.0, 18):
        octave = (n[inside] >= start) & (n[inside] < start * 1.26)
        assert ratio[octave].mean() == pytest.approx(1.0, abs=4 / np.sqrt(freedom / 2 * max(octave.sum() / 2, 1)))
    outside = n > 8.2
    assert density[outside].max() < 0.01 * spectrum.density(np.array([7.9]))[0]


def test_seeds():
    road = mf.IsoRoad.of_class("A")
    first, again, other = (np.asarray(mf.realise(road, length=50.0, seed=s).elevation) for s in (5, 5, 6))
    np.testing.assert_array_equal(first, again)
    assert abs(np.corrcoef(first, other)[0, 1]) < 0.9
    assert np.abs(first - other).max() > 1e-3 * np.abs(first).max()


def test_a_profile_is_the_cubic_spline_through_its_samples():
    x = np.sort(np.random.default_rng(1).uniform(0.0, 20.0, 60))
    z = np.column_stack([np.sin(x), np.cos(2 * x)])
    profile = mf.Profile(x, z)
    between = np.linspace(x[0], x[-1], 777)
    for path in (0, 1):
        # Uneven stations: the not-a-knot spline of a reference implementation, to rounding.
        np.testing.assert_allclose(profile.along(path)(between), CubicSpline(x, z[:, path])(between), atol=1e-12)
        np.testing.assert_allclose(profile.along(path)(x), z[:, path], atol=1e-13)


def test_interpolation_is_of_fourth_order():
    """Halving the distance between samples divides the error by sixteen (inside, away from the ends)."""
    between = np.linspace(4.0, 16.0, 501)
    errors = []
    for count in (101, 201, 401):
        x = np.linspace(0.0, 20.0, count)
        errors.append(np.abs(mf.Profile(x, np.sin(2 * x)).along(0)(between) - np.sin(2 * between)).max())
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    np.testing.assert_allclose(orders, 4.0, atol=0.15)


def test_harmonic_and_bump():
    wave = mf.harmonic(amplitude=0.01, wavelength=2.0, length=10.0, phase=0.3, start=-1.0)
    x = np.linspace(0.0, 8.0, 333)
    np.testing.assert_allclose(wave.along(0)(x), 0.01 * np.sin(np.pi * x + 0.3), atol=2e-8)
    hump = mf.bump(height=0.02, width=1.0, at=3.0, length=10.0)
    assert float(hump.along(0)(3.5)) == pytest.approx(0.02, rel=1e-6)
    assert abs(float(hump.along(0)(2.9))) < 1e-9
    assert float(hump.along(0)(3.25)) == pytest.approx(0.01, rel=1e-4)  # a quintic is half-way up half-way

"""Spectra against their sources' own forms, quadrature, and each other."""

from __future__ import annotations

import csv
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad

import movingfrf as mf

RAILS = Path(__file__).parents[3] / "shared" / "data" / "rail_roughness_long.csv"

SPECTRA = {
    "iso, w 2": mf.IsoRoad.of_class("B"),
    "iso, w 1": mf.IsoRoad.of_class("B", waviness=1.0),
    "iso, w 2.6": mf.IsoRoad.of_class("B", waviness=2.6),
    "two slopes": mf.TwoSlopeRoad.of_class("average principal road"),
    "two slopes, one below, a logarithm above": mf.TwoSlopeRoad(
        roughness=1e-6, waviness=(3.0, 1.0), band=(0.1, 4.0)
    ),
    "two slopes, short waves only": mf.TwoSlopeRoad(roughness=1e-6, band=(0.2, 4.0)),
    **{f"fra {n}": mf.FraTrack.of_class(n) for n in (1, 6)},
    **{f"fryba {n}": mf.FrybaTrack.of_class(n) for n in (1, 6)},
    **{f"german {level}": mf.GermanTrack.of_class(level) for level in ("low", "high")},
    **{f"sncf {quality}": mf.SncfTrack.of_class(quality) for quality in ("good", "poor")},
    "chinese": mf.ChineseBallastlessTrack(),
    "chinese, cut": mf.ChineseBallastlessTrack(band=(0.03, 0.1)),
    "iso 3095": mf.iso3095_limit(),
    # Falling, level, rising, and falling with n⁻¹, whose integral is a logarithm.
    "table": mf.TabulatedSpectrum(
        spatial_frequency=[0.02, 0.1, 0.3, 0.5, 5.0], spectral_density=[1e-4, 1e-5, 1e-5, 3e-5, 3e-6]
    ),
}


@pytest.mark.parametrize("name", SPECTRA)
def test_variance_is_the_integral_of_the_density(name):
    """Adaptive quadrature, piece by piece where a formula has breakpoints; 1e-10 is what was asked of it."""
    spectrum = SPECTRA[name]
    low, high = spectrum.band
    thirds = 10 ** (np.arange(4, 25) / 10 + 0.05)
    breaks = [
        1 / (2 * np.pi),
        *mf.ChineseBallastlessTrack._BREAKS,
        *np.ravel(getattr(spectrum, "spatial_frequency", [])),
        *thirds,
    ]
    places = np.unique(np.clip([low, *np.geomspace(low, high, 9), *breaks, high], low, high))
    places = np.array([low, *places[1:][np.diff(np.log(places)) > 1e-9]])
    # Beyond a breakpoint the formula of the next piece holds: stay within each by one part in 1e13.
    pieces = [
        quad(
            lambda n: float(spectrum.density(np.array(n))), a * (1 + 1e-13), b * (1 - 1e-13), epsrel=1e-12, epsabs=0
        )[0]
        for a, b in pairwise(places)
    ]
    np.testing.assert_allclose(spectrum.variance_below(places[1:]), np.cumsum(pieces), rtol=1e-10)
    assert spectrum.variance_below(np.array([0.0, low / 2, low])).tolist() == [0.0, 0.0, 0.0]
    assert spectrum.variance_below(np.array(2 * high)) == spectrum.variance_below(np.array(high))
    assert spectrum.density(np.array([0.0, low / 2, 1.01 * high])).tolist() == [0.0, 0.0, 0.0]
    assert (spectrum.density(np.array([low, high])) > 0).all()


def test_fra_in_the_units_of_its_source():
    """In cm²/(rad/m), k A_v Ω_c²/(Ω²(Ω² + Ω_c²)); S(n) dn = S(Ω) dΩ."""
    wavenumber = np.geomspace(0.05, 4.0, 20)
    for track_class, roughness in enumerate((1.2107, 1.0181, 0.6816, 0.5376, 0.2095, 0.0339), start=1):
        stated = 0.25 * roughness * 0.8245**2 / (wavenumber**2 * (wavenumber**2 + 0.8245**2))
        found = mf.FraTrack.of_class(track_class).density(wavenumber / (2 * np.pi))
        np.testing.assert_allclose(found, 2 * np.pi * stated * 1e-4, rtol=1e-12)


def test_the_two_forms_of_the_fra_share_a_corner_and_a_name_and_no_more():
    """The corner is 40e-3 cycle/ft in both; between, the one is more than ten times the other (PARAMETERS.md)."""
    corner = 0.04 / 0.3048
    assert mf.FraTrack._CORNER / (2 * np.pi) == pytest.approx(corner, rel=2e-4)
    assert mf.FrybaTrack._CORNERS[1] == pytest.approx(corner, rel=2e-3)
    assert mf.FrybaTrack._CORNERS[0] == pytest.approx(0.0071 / 0.3048, rel=1e-3)
    n = np.geomspace(0.05, 0.3, 20)
    for track_class in (1, 6):
        ratio = mf.FraTrack.of_class(track_class).density(n) / mf.FrybaTrack.of_class(track_class).density(n)
        assert (ratio > 10).all()


def test_fryba_by_hand():
    """Class 4 at the upper corner: A n₂² (n₂² + n₁²)/(n₂⁴ · 2n₂²) = A (1 + (n₁/n₂)²)/(2 n₂²)."""
    found = mf.FrybaTrack.of_class(4).density(np.array([0.131]))[0]
    assert found == pytest.approx(2.75e-8 * (1 + (0.0233 / 0.131) ** 2) / (2 * 0.131**2), rel=1e-12)


@pytest.mark.parametrize(("level", "numerator"), [("low", 2.741619e-7), ("high", 7.343623e-7)])
def test_german_spectra_are_those_of_erri_b176(level, numerator):
    """A separate printing: one-sided, b₀/(Ω⁴ + a₂ Ω² + a₀), m²/(rad/m), to the seven digits that it has."""
    wavenumber = np.geomspace(0.05, 2.0, 20)
    stated = numerator / (wavenumber**4 + 0.6803895 * wavenumber**2 + 0.00028855)
    found = mf.GermanTrack.of_class(level).density(wavenumber / (2 * np.pi))
    np.testing.assert_allclose(found, 2 * np.pi * stated, rtol=2e-5)


def test_sncf_deviates_as_german_track_does():
    """Per cycle per metre, good tracks of two countries agree; per rad/m they would not."""
    at = (1 / 40, 1 / 3)
    spectra = mf.SncfTrack.of_class("good", band=at), mf.GermanTrack.of_class("low", band=at)
    french, german = (np.sqrt(spectrum.variance_below(np.array(1.0))) for spectrum in spectra)
    assert french == pytest.approx(german, rel=0.15)
    assert mf.SncfTrack.of_class("poor").density(np.array([0.0489]))[0] == pytest.approx(
        308e-6 * 1.79 / 8, rel=1e-12
    )


def test_two_slopes_meet_and_each_is_its_power():
    """By hand: a decade below n₀ the density is 10^w₁ times, a decade above 10^−w₂ times that at n₀, 1 rad/m."""
    road = mf.TwoSlopeRoad.of_class("good motorway")
    found = road.density(np.array([0.1, 1.0, 10.0]) / (2 * np.pi))
    assert found == pytest.approx([16e-6 * 10**1.945, 16e-6, 16e-6 * 10**-1.36], rel=1e-12)
    # With equal slopes it is the spectrum of ISO 8608, stated at another frequency.
    level = mf.TwoSlopeRoad(roughness=1e-6, waviness=(2.0, 2.0))
    iso = mf.IsoRoad(roughness=1e-6 / (0.2 * np.pi) ** 2)
    n = np.geomspace(0.01, 10.0, 20)
    assert level.density(n) == pytest.approx(iso.density(n), rel=1e-12)
    assert level.variance_below(n) == pytest.approx(iso.variance_below(n), rel=1e-12)
    # Classes of one type lie a factor of four apart; exponents may be others than the means.
    rough = [
        mf.TwoSlopeRoad.of_class(f"{quality} minor road").roughness for quality in ("average", "poor", "very poor")
    ]
    assert rough == pytest.approx([64e-6, 256e-6, 1024e-6])
    assert mf.TwoSlopeRoad.of_class("poor minor road", waviness=(2.0, 2.0)).waviness == (2.0, 2.0)


def test_chinese_spectrum_in_the_units_of_its_source():
    """A/n^p in mm²/(1/m), one number for each piece; pieces meet within what their digits allow."""
    spectrum = mf.ChineseBallastlessTrack()
    for n, scale, power in [
        (0.01, 1.0544e-5, 3.3891),
        (0.03, 3.5588e-3, 1.9271),
        (0.1, 1.9784e-2, 1.3643),
        (0.4, 3.9488e-4, 3.4516),
    ]:
        assert spectrum.density(np.array([n]))[0] == pytest.approx(scale / n**power * 1e-6, rel=1e-12)
    for place in (0.0187, 0.0474, 0.1533):
        before, after = spectrum.density(np.array([place * (1 - 1e-9), place]))
        assert before == pytest.approx(after, rel=5e-3)


def test_a_table_of_a_power_law_is_the_power_law():
    road = mf.IsoRoad(roughness=3e-5, waviness=2.3, band=(0.02, 4.0))
    knots = np.geomspace(0.02, 4.0, 7)
    table = mf.TabulatedSpectrum(spatial_frequency=knots, spectral_density=road.density(np.clip(knots, 0.02, 4.0)))
    n = np.geomspace(0.021, 3.9, 55)
    np.testing.assert_allclose(table.density(n), road.density(n), rtol=1e-12)
    np.testing.assert_allclose(table.variance_below(n), road.variance_below(n), rtol=1e-11)


def test_levels_come_back():
    limit = mf.iso3095_limit()
    levels = mf.third_octave_levels(limit, 10 ** (-np.arange(4, 26) / 10))
    published = [17.1, 15, 13, 11, 9, 7, 4.9, 2.9, 0.9, -1.1, -3.2, -5]
    published += [-5.6, -6.2, -6.8, -7.4, -8, -8.6, -9.2, -9.8, -10.4, -11]
    np.testing.assert_allclose(levels, published, atol=1e-9)
    # By hand: −8 dB re 1 µm are 10^−12.8 m², in the band at 1 cm over a width of 100 (10^0.05 − 10^−0.05) cycle/m.
    density = limit.density(np.array([99.0, 101.0]))
    np.testing.assert_allclose(density, 10**-12.8 / (100 * (10**0.05 - 10**-0.05)), rtol=1e-12)
    # The other way round, and by nominal wavelengths, it is the same spectrum, to what nominal values are worth.
    nominal = [0.00315, 0.004, 0.005, 0.0063, 0.008, 0.01]
    turned = mf.ThirdOctaveSpectrum(wavelength=nominal, level=[-11, -10.4, -9.8, -9.2, -8.6, -8])
    np.testing.assert_allclose(
        turned.density(np.array([105.0, 250.0])), limit.density(np.array([105.0, 250.0])), rtol=0.03
    )
    assert mf.third_octave_levels(limit, [2.0])[0] == -np.inf


def test_levels_of_a_power_law():
    """Mean square of n^−2 between n/b and n·b is G n (b − 1/b); a class A road at a wavelength of 1 m."""
    level = mf.third_octave_levels(mf.IsoRoad.of_class("A"), [1.0])[0]
    assert level == pytest.approx(10 * np.log10(16e-8 * (10**0.05 - 10**-0.05) / 1e-12), abs=1e-9)


@pytest.mark.skipif(not RAILS.exists(), reason=f"the measured rail roughness {RAILS.name} is not there")
def test_measured_rails_realised_have_the_measured_levels():
    """Left rail of one section, wavelengths to five digits; a whole period has each band's mean square."""
    with RAILS.open(encoding="utf-8") as lines:
        rows = [
            row for row in csv.DictReader(lines) if (row["sec"], row["rail"], row["kampagne"]) == ("B5", "L", "1")
        ]
    rows = [row for row in rows if row["r_id"] == rows[0]["r_id"]]
    wavelengths = np.array([float(row["wavelength_cm"]) for row in rows]) / 100
    levels = np.array([float(row["roughness_db_re_1um"]) for row in rows])
    assert levels.size == 22
    spectrum = mf.ThirdOctaveSpectrum(wavelength=wavelengths, level=levels)
    np.testing.assert_allclose(mf.third_octave_levels(spectrum, wavelengths), levels, atol=3e-3)
    rail = mf.realise(spectrum, length=50.0 - 1e-3, step=1e-3, seed=2)
    elevation = np.asarray(rail.elevation)
    assert elevation.size == 50_000
    power = 2 * np.abs(np.fft.rfft(elevation) / elevation.size) ** 2
    n = np.fft.rfftfreq(elevation.size, 1e-3)
    for wavelength, level in zip(wavelengths, levels, strict=True):
        band = (n > 1 / (wavelength * 10**0.05)) & (n < 10**0.05 / wavelength)
        # A line more or less at either edge, of the band or of a rougher neighbour.
        assert 10 * np.log10(power[band].sum() / 1e-12) == pytest.approx(level, abs=0.05 + 20 / band.sum())


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: mf.FraTrack.of_class(7), "track_class must be one of 1, 2, 3, 4, 5, 6, got 7"),
        (lambda: mf.FraTrack.of_class(True), "track_class must be one of 1, 2, 3, 4, 5, 6, got True"),
        (lambda: mf.FrybaTrack.of_class("6"), "track_class must be one of 1, 2, 3, 4, 5, 6, got '6'"),
        (
            lambda: mf.GermanTrack.of_class([], band=(1, 0)),
            r"must be one of low, high, got \[\]; band\[1\] must be positive",
        ),
        (lambda: mf.SncfTrack.of_class("bad"), "track_class must be one of good, poor, got 'bad'"),
        (
            lambda: mf.TwoSlopeRoad.of_class("bad road"),
            "road_class must be one of very good motorway, .*got 'bad road'",
        ),
        (lambda: mf.TwoSlopeRoad(roughness=1e-6, waviness=2.0), "waviness must be two numbers, got 2.0"),
        (lambda: mf.TwoSlopeRoad(roughness=1e-6, waviness=(2.0, 11.0)), "waviness must lie within ±10, got 11.0"),
        (lambda: mf.SncfTrack(roughness=0.0), r"roughness must be positive, got 0\.0 m³"),
        (lambda: mf.FraTrack(roughness=1e-6, band=(0.2, 0.1)), "band must be two increasing frequencies"),
        (lambda: mf.ChineseBallastlessTrack(band=(0.0, 1.0)), r"band\[0\] must be positive, got 0\.0 cycle/m"),
        (lambda: table([1.0], [1.0]), "at least two increasing positive numbers"),
        (lambda: table([1.0, 1.0], [1.0, 1.0]), "at least two increasing positive numbers"),
        (lambda: table([1.0, 2.0], [1.0]), "spectral_density must have 2 values, one per frequency, got 1"),
        (lambda: table([1.0, 2.0], [1.0, 0.0]), "spectral_density must be positive throughout, got 0 m³"),
        (lambda: levels([0.1], [0.0]), "wavelength must be at least two positive numbers"),
        (lambda: levels([0.1, 0.2], [0.0, 0.0]), "wavelength must be a third of an octave apart"),
        (lambda: levels([0.1, 0.125, 0.1], [0.0] * 3), "wavelength must go in one direction"),
        (lambda: levels([0.1, 0.125], [0.0]), "level must have 2 values, one per wavelength, got 1"),
        (lambda: levels([0.1, 0.125], [0.0, 1e4]), "within ±200 dB"),
        (lambda: mf.third_octave_levels(mf.iso3095_limit(), [0.1, -1.0]), "wavelength must be positive, got -1 m"),
    ],
)
def test_impossible_spectra(make, message):
    with pytest.raises(mf.ParameterError, match=message):
        make()


def table(n, density):
    return mf.TabulatedSpectrum(spatial_frequency=n, spectral_density=density)


def levels(wavelength, level):
    return mf.ThirdOctaveSpectrum(wavelength=wavelength, level=level)

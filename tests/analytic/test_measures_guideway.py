"""Mobilities and decay rates against published values, closed forms, and measured tracks."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

import movingfrf as mf
from movingfrf.metrics.guideway import BAYS

MEASURED = Path(__file__).parents[3] / "shared" / "data" / "tdr_long.csv"

RAIL = mf.EulerBernoulliBeam(bending_stiffness=210e9 * 3038.3e-8, mass=60.2)
PAD = mf.Spring(stiffness=300e6, damping=30e3)
ON_PADS = mf.track(RAIL, PAD)
ON_SLEEPERS = mf.track(RAIL, mf.OnMass(above=PAD, mass=250.0, below=mf.Spring(stiffness=100e6, damping=80e3)))


def point(track, frequency) -> float:
    return float(abs(mf.mobility(track, [frequency]).mobility.values[0, 0]))


@pytest.mark.parametrize(("frequency", "published"), [(20.0, 3.88704e-7), (200.907, 5.13532e-6)])
def test_published_mobility_of_a_rail_on_pads(frequency, published):
    """UIC60 on a continuous pad (PARAMETERS.md, Tracks): the frequency is rounded to 5e-4 Hz, 5e-6 of |Y|."""
    assert point(ON_PADS, frequency) == pytest.approx(published, rel=5e-6)


def test_published_peak_of_a_rail_on_pads():
    """2.12203e-5 m/s/N at 356 Hz, read from a table that steps over the very peak."""
    peak = minimize_scalar(
        lambda f: -point(ON_PADS, f), bounds=(300.0, 420.0), method="bounded", options={"xatol": 1e-3}
    )
    assert -peak.fun == pytest.approx(2.12203e-5, rel=2e-4)
    assert peak.x == pytest.approx(356.0, abs=1.0)


def extreme(low, high, sign) -> float:
    found = minimize_scalar(
        lambda f: -sign * point(ON_SLEEPERS, f), bounds=(low, high), method="bounded", options={"xatol": 1e-3}
    )
    return float(found.x)


def test_published_mobility_with_sleepers():
    """Sleepers of 250 kg/m on ballast: 1.12899e-6 at 20 Hz, peaks at 89.6 and 403.7 Hz, dip at 198.9 Hz.

    Extremes of a table whose steps are not known: the flat dip lies within one of its neighbours.
    """
    assert point(ON_SLEEPERS, 20.0) == pytest.approx(1.12899e-6, abs=5e-12)
    assert extreme(60.0, 130.0, 1) == pytest.approx(89.6, abs=0.5)
    assert extreme(130.0, 300.0, -1) == pytest.approx(198.9, abs=1.0)
    assert extreme(300.0, 550.0, 1) == pytest.approx(403.7, abs=0.5)


def closed_form(frequency, x) -> np.ndarray:
    """Receptance of an Euler–Bernoulli beam on a Winkler foundation at rest, the two waves that decay."""
    omega = 2 * np.pi * frequency
    foundation = 300e6 + 1j * omega * 30e3 - omega**2 * 60.2
    beta = np.asarray(foundation / (4 * 210e9 * 3038.3e-8), complex) ** 0.25
    return np.exp(-beta * x) * (np.cos(beta * x) + np.sin(beta * x)) * beta / (2 * foundation)


def test_forms_in_closed_form():
    """Receptance β/2K · e^(−βx)(cos βx + sin βx), mobility iω and accelerance −ω² times as much."""
    f, x = np.array([5.0, 80.0, 350.0, 900.0]), np.array([0.0, 0.5, 1.7])
    wanted = np.stack([closed_form(frequency, x) for frequency in f])
    omega = 2 * np.pi * f[:, None]
    np.testing.assert_allclose(mf.receptance(ON_PADS, f, ahead=x).receptance.values, wanted, rtol=1e-10)
    np.testing.assert_allclose(mf.mobility(ON_PADS, f, ahead=x).mobility.values, 1j * omega * wanted, rtol=1e-10)
    np.testing.assert_allclose(
        mf.accelerance(ON_PADS, f, ahead=x).accelerance.values, -(omega**2) * wanted, rtol=1e-10
    )


def test_labels():
    found = mf.accelerance(ON_PADS, [1.0, 2.0], ahead=[0.0, 1.0, -1.0], speed=50.0)
    assert found.accelerance.dims == ("frequency", "ahead")
    assert found.accelerance.attrs["units"] == "m/s2/N"
    np.testing.assert_allclose(found.omega.values, 2 * np.pi * found.frequency.values)
    assert (found.attrs["form"], found.attrs["speed"]) == ("accelerance", 50.0)
    moving = ON_PADS.moving_frf([0.0, 1.0, -1.0], 50.0, found.omega.values)
    np.testing.assert_allclose(found.accelerance.values, -(found.omega.values[:, None] ** 2) * moving, rtol=1e-13)
    # Ahead and behind of a moving force differ.
    assert not np.allclose(found.accelerance.values[:, 1], found.accelerance.values[:, 2], rtol=1e-3, atol=0.0)


def test_grid_of_the_standard():
    """EN 15461: 29 points to 66 spacings."""
    assert BAYS.size == 29
    assert 0.6 * BAYS[-1] == pytest.approx(39.6)
    assert np.diff(BAYS).tolist() == [0.25] * 10 + [0.5] * 3 + [1.0] * 4 + [2.0] * 2 + [4.0] * 3 + [6.0] * 5 + [
        12.0
    ]


def test_decay_rate_on_an_even_grid():
    """A wave e^(−βx): a geometric series, half a step at the source and a whole one at the end."""
    beta, step, count = 0.3, 0.25, 80
    x = step * np.arange(count + 1)
    q = np.exp(-2 * beta * step)
    total = step * (0.5 + (q - q ** (count + 1)) / (1 - q))
    # Of any size and phase, and of one of several frequencies.
    responses = np.stack([np.ones_like(x), (2 - 1j) * np.exp(-(beta + 4j) * x)])
    found = mf.decay_rate(responses, x)
    assert found[1] == pytest.approx(10 / np.log(10) / total, rel=1e-12)
    # Without decay: no less than what the farthest point allows.
    assert found[0] == pytest.approx(10 / np.log(10) / (x[-1] + step / 2), rel=1e-12)


def test_decay_rate_on_an_uneven_grid():
    """0, 0.5 and 1.4 m stand for 0.25, 0.7 and 0.9 m."""
    found = mf.decay_rate([1.0, 0.75, 0.25], [0.0, 0.5, 1.4])
    assert found == pytest.approx(10 / np.log(10) / (0.25 + 0.75**2 * 0.7 + 0.25**2 * 0.9), rel=1e-12)


@pytest.mark.parametrize("frequency", [500.0, 1000.0, 2500.0])
def test_decay_of_the_wave_that_travels_farthest(frequency):
    """Far away the response falls by so much a metre; and in closed form κ⁴ = (mω² − k − iωc)/EI."""
    omega = 2 * np.pi * frequency
    kappa = (np.asarray(60.2 * omega**2 - 300e6 - 1j * omega * 30e3) / (210e9 * 3038.3e-8)) ** 0.25
    wanted = 20 / np.log(10) * min(abs(kappa.imag), abs(kappa.real))
    found = mf.wave_decay_rate(ON_PADS, [frequency])[0]
    assert found == pytest.approx(wanted, rel=1e-10)
    near, far = np.abs(mf.mobility(ON_PADS, [frequency], ahead=[10.0, 12.0]).mobility.values[0])
    assert 20 * np.log10(near / far) / 2 == pytest.approx(found, rel=1e-3)


@pytest.mark.parametrize("damping", [1e3, 3e3, 3e4])
@pytest.mark.parametrize("frequency", [1500.0, 3000.0])
def test_decay_rate_of_a_track_is_twice_that_of_its_wave(frequency, damping):
    """The receptance of a beam is as e^(−iκx) − i e^(−κx): at the source |1 − i|² = 2 of the wave's square.

    Summed to 43.2 m a wave of the rate Δ lacks 10^(−4.32 Δ). With loss the two terms are not of one size: by 4 % on
    the damped rail at 1500 Hz; the grid of the standard adds 2 %.
    """
    rail = mf.track(RAIL, mf.Spring(stiffness=300e6, damping=damping))
    points, wave = mf.track_decay_rate(rail, [frequency])[0], mf.wave_decay_rate(rail, [frequency])[0]
    assert points == pytest.approx(2 * wave / (1 - 10 ** (-4.32 * wave)), rel=0.05)


def test_decay_rate_of_a_shearing_rail_is_that_of_its_wave():
    """A Timoshenko beam answers at high frequencies with one wave, its near field gone: to 3 % at 5 kHz."""
    rail = mf.TimoshenkoBeam(bending_stiffness=6.4e6, mass=60.2, shear_stiffness=2.5e8, rotary_inertia=0.24)
    track = mf.track(rail, PAD)
    points, wave = mf.track_decay_rate(track, [5000.0])[0], mf.wave_decay_rate(track, [5000.0])[0]
    assert points == pytest.approx(wave, rel=0.03)


def test_decay_rate_of_what_hardly_decays():
    """No less than the points' 43.2 m allow; of an Euler–Bernoulli rail twice that."""
    rail = mf.track(RAIL, mf.Spring(stiffness=300e6, damping=0.1))
    assert mf.track_decay_rate(rail, [2000.0])[0] == pytest.approx(2 * 10 / np.log(10) / 43.2, rel=0.02)


def test_rigidly_alike_with_mobility_or_accelerance():
    f = [300.0, 700.0]
    responses = mf.accelerance(ON_PADS, f, ahead=0.6 * BAYS).accelerance.values
    np.testing.assert_allclose(mf.decay_rate(responses, 0.6 * BAYS), mf.track_decay_rate(ON_PADS, f), rtol=1e-12)


@pytest.mark.skipif(not MEASURED.exists(), reason=f"the measured decay rates of {MEASURED.name} are not there")
def test_trend_of_measured_decay_rates():
    """Hard pads on concrete sleepers, mean of all vertical measurements without dampers, 500 to 2500 Hz.

    Rail section, spacing and pads of the measured track are not given, and its pinned–pinned dip at 1 kHz is beyond
    a continuous support: within a factor of two and a half, falling alike.
    """
    with MEASURED.open(encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["dir"] == "v" and row["damp"] == "False"]
    f = np.array([500.0, 630.0, 1600.0, 2000.0, 2500.0])
    measured = np.array([np.mean([float(r["tdr_db_per_m"]) for r in rows if float(r["freq_hz"]) == x]) for x in f])
    rail = mf.TimoshenkoBeam(
        bending_stiffness=210e9 * 3038.3e-8,
        mass=60.2,
        shear_stiffness=0.4 * 81e9 * 76.7e-4,
        rotary_inertia=7850 * 3038.3e-8,
    )
    track = mf.track(
        rail,
        mf.OnMass(
            above=mf.Spring(stiffness=800e6 / 0.6, damping=6e4 / 0.6),
            mass=150.0 / 0.6,
            below=mf.Spring(stiffness=60e6 / 0.6, damping=5e4 / 0.6),
        ),
    )
    found = mf.track_decay_rate(track, f)
    ratio = found / measured
    assert ((ratio > 0.4) & (ratio < 2.5)).all()
    assert np.corrcoef(np.log(found), np.log(measured))[0, 1] > 0.9


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: mf.mobility(ON_PADS, [-1.0]), "frequency must not be negative, got -1 Hz"),
        (lambda: mf.mobility(ON_PADS, [np.nan]), "frequency must be finite"),
        (lambda: mf.receptance(ON_PADS, [1.0], ahead=[[0.0]]), "ahead must have shape"),
        (lambda: mf.accelerance("road", [1.0]), "guideway must have a moving FRF"),
        (lambda: mf.decay_rate([1.0, 0.5], [0.1, 1.0]), "distance must increase from 0"),
        (lambda: mf.decay_rate([1.0, 0.5], [0.0, 0.0]), "distance must increase from 0"),
        (lambda: mf.decay_rate([1.0, 0.5, 0.2], [0.0, 1.0]), "response must have 2 points in its last axis"),
        (lambda: mf.decay_rate([0.0, 0.5], [0.0, 1.0]), "response must be finite, and not zero at the source"),
        (lambda: mf.track_decay_rate(mf.RigidGuideway(), [100.0]), "response must be finite, and not zero"),
        (lambda: mf.track_decay_rate(ON_PADS, [0.0]), "frequency must be positive"),
        (lambda: mf.track_decay_rate(ON_PADS, [1.0], spacing=0.0), "spacing must be positive"),
        (lambda: mf.wave_decay_rate(mf.RigidGuideway(), [1.0]), "track must be a track"),
    ],
)
def test_refusals(call, message):
    with pytest.raises(ValueError, match=message):
        call()

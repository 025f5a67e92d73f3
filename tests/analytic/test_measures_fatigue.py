"""Cycle counts and damage against the standard's example, closed forms, and counted Gaussian histories."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import gamma

import movingfrf as mf
from movingfrf.metrics import fatigue
from movingfrf.metrics.fatigue import METHODS


def gaussian(frequency, density, *, seconds, step, seed) -> np.ndarray:
    """Realise a stationary Gaussian history with a one-sided density [unit²/Hz]: random amplitudes and phases."""
    count = round(seconds / step)
    f = np.fft.rfftfreq(count, step)
    given = np.interp(f, frequency, density, left=0.0, right=0.0)
    rng = np.random.default_rng(seed)
    lines = (rng.normal(size=f.size) + 1j * rng.normal(size=f.size)) * np.sqrt(given / (4 * seconds)) * count
    return np.fft.irfft(lines, count)


def moments(frequency, density, *orders) -> list[float]:
    return [float(np.trapezoid(density * frequency**n, frequency)) for n in orders]


def test_level_crossings_of_a_sine():
    time = np.linspace(0.0, 10.0, 10_001)
    wave = np.sin(2 * np.pi * time - 1.0)
    assert mf.level_crossings(wave, [-1.1, -0.5, 0.0, 0.5, 1.1]).tolist() == [0, 10, 10, 10, 0]


def test_level_crossings_one_by_one():
    """A walk of whole numbers, that touches and rests on levels: counted by hand, step by step."""
    walk = np.cumsum(np.random.default_rng(3).integers(-1, 2, 500))
    levels = np.arange(-5, 6) / 2
    wanted = [sum(a < level <= b for a, b in pairwise(walk)) for level in levels]
    assert mf.level_crossings(walk, levels).tolist() == wanted


def test_level_crossings_of_a_gaussian_history():
    """Rice: ν₀ exp(−x²/2σ²), within three standard errors of a count of independent crossings."""
    f = np.linspace(5.0, 15.0, 101)
    density = np.full(101, 0.1)
    history = gaussian(f, density, seconds=2000.0, step=2e-3, seed=4)
    m0, m2 = moments(f, density, 0, 2)
    levels = np.array([-1.0, 0.0, 1.0, 2.0])
    wanted = 2000.0 * np.sqrt(m2 / m0) * np.exp(-(levels**2) / (2 * m0))
    assert (np.abs(mf.level_crossings(history, levels) - wanted) < 3 * np.sqrt(wanted)).all()


def test_standard_example_of_rainflow():
    """The history −2 1 −3 5 −1 3 −4 4 −2 of ASTM E1049, repeated: ranges 3, 4, 7 and 9, once each."""
    cycles = mf.rainflow([-2, 1, -3, 5, -1, 3, -4, 4, -2])
    assert sorted(2 * cycles[:, 0]) == [3.0, 4.0, 7.0, 9.0]
    # Means: of −3…… the largest goes from −4 to 5, the range of 4 from −1 to 3.
    means = dict(zip((2 * cycles[:, 0]).tolist(), cycles[:, 1].tolist(), strict=True))
    assert (means[9.0], means[4.0]) == (0.5, 1.0)


@pytest.mark.parametrize("shift", range(0, 40, 7))
def test_rainflow_of_a_repeated_history_does_not_depend_on_its_start(shift):
    history = np.random.default_rng(5).normal(size=40)
    whole = mf.rainflow(np.append(history, history[0]))
    turned = np.roll(history, shift)
    np.testing.assert_allclose(
        np.sort(mf.rainflow(np.append(turned, turned[0]))[:, 0]), np.sort(whole[:, 0]), rtol=1e-12
    )
    # Every step of a closed history belongs to one cycle.
    assert 4 * whole[:, 0].sum() == pytest.approx(np.abs(np.diff(np.append(history, history[0]))).sum(), rel=1e-12)


def cycles_one_by_one(history) -> list[tuple[float, float]]:
    """Rychlik's definition, on a circle: from each crest down to the higher of the two deepest points beside it.

    That is, the deepest before and the deepest after which the history reaches without rising above the crest.
    """
    found, count = [], len(history)
    for n, crest in enumerate(history):
        if not history[n - 1] < crest > history[(n + 1) % count]:
            continue
        deepest = []
        for way in (-1, 1):
            below = crest
            for step in range(1, count):
                if (value := history[(n + way * step) % count]) > crest:
                    break
                below = min(below, value)
            deepest.append(below)
        found.append(((crest - max(deepest)) / 2, (crest + max(deepest)) / 2))
    return sorted(found)


@pytest.mark.parametrize("seed", range(5))
def test_rainflow_by_its_definition(seed):
    history = np.random.default_rng(seed).normal(size=300)
    np.testing.assert_allclose(sorted(map(tuple, mf.rainflow(history))), cycles_one_by_one(history), rtol=1e-12)


def test_rainflow_of_a_history_upside_down_or_backwards():
    """Of distinct values, the same ranges; means change their sign, or stay."""
    history = np.random.default_rng(8).normal(size=1000)
    cycles = np.array(sorted(map(tuple, mf.rainflow(history))))
    np.testing.assert_array_equal(sorted(map(tuple, mf.rainflow(history[::-1]))), cycles)
    np.testing.assert_allclose(sorted(map(tuple, mf.rainflow(-history) * (1, -1))), cycles, rtol=1e-12)


def test_rainflow_sees_turning_points_alone():
    history = np.random.default_rng(9).integers(-9, 10, 200).astype(float)
    between = np.stack([history, np.append((history[1:] + history[:-1]) / 2, history[-1])], axis=1)
    assert sorted(map(tuple, mf.rainflow(between.ravel()))) == sorted(map(tuple, mf.rainflow(history)))


def test_rainflow_of_nothing():
    assert mf.rainflow(np.ones(10)).shape == (0, 2)
    # A rise falls back when the history begins again.
    assert mf.rainflow([1.0, 2.0, 3.0]).tolist() == [[1.0, 2.0]]
    assert mf.rainflow_damage(np.zeros(5), slope=3.0) == 0.0


def test_damage_of_a_sine():
    """Cycles times a^m over the strength; the sample that hits each crest exactly."""
    wave = 2.0 * np.sin(2 * np.pi * np.arange(0, 4000) / 40)
    assert mf.rainflow_damage(wave, slope=4.0, strength=100.0) == pytest.approx(100 * 2.0**4 / 100, rel=1e-2)
    assert mf.equivalent_amplitude(wave, slope=4.0, duration=50.0, rate=2.0) == pytest.approx(2.0, rel=1e-2)


@pytest.mark.parametrize("slope", [3.0, 5.0, 8.0])
def test_narrow_band_in_closed_form(slope):
    """ν₀ (√2 σ)^m Γ(1 + m/2)/C; with other methods within the bandwidth of 2 %."""
    f = np.linspace(9.9, 10.1, 401)
    density = np.full(401, 20.0)
    wanted = narrow_band(f, density, slope) / 7.0
    found = mf.spectral_damage(f, density, slope=slope, strength=7.0, method="narrow_band")
    assert found == pytest.approx(wanted, rel=1e-9)
    for method in METHODS:
        assert mf.spectral_damage(f, density, slope=slope, strength=7.0, method=method) == pytest.approx(
            wanted, rel=0.05
        )


def narrow_band(frequency, density, slope) -> float:
    m0, m2 = moments(frequency, density, 0, 2)
    return float(np.sqrt(m2 / m0) * (2 * m0) ** (slope / 2) * gamma(1 + slope / 2))


def dirlik(frequency, density, slope) -> float:
    """Integrate Dirlik's distribution of rainflow ranges, written here in normalised ranges Z = S/(2σ)."""
    m0, m1, m2, m4 = moments(frequency, density, 0, 1, 2, 4)
    irregularity, mean = m2 / np.sqrt(m0 * m4), m1 / m0 * np.sqrt(m2 / m4)
    d1 = 2 * (mean - irregularity**2) / (1 + irregularity**2)
    r = (irregularity - mean - d1**2) / (1 - irregularity - d1 + d1**2)
    d2 = (1 - irregularity - d1 + d1**2) / (1 - r)
    d3 = 1 - d1 - d2
    q = 1.25 * (irregularity - d3 - d2 * r) / d1

    def density_of(z):
        return d1 / q * np.exp(-z / q) + d2 * z / r**2 * np.exp(-(z**2) / (2 * r**2)) + d3 * z * np.exp(-(z**2) / 2)

    # The amplitude is σ Z.
    moment = quad(lambda z: z**slope * density_of(z), 0.0, 60.0, limit=400)[0]
    return np.sqrt(m4 / m2) * m0 ** (slope / 2) * moment


# Low and high modes of like variance, a plateau, and a slope like that of a road.
F = np.linspace(0.5, 60.0, 2001)
DENSITIES = {
    "two modes": np.where((F > 3) & (F < 5), 1.0, 0.0) + np.where((F > 30) & (F < 40), 0.1, 0.0),
    "plateau": np.where((F > 5) & (F < 50), 0.1, 0.0),
    "road": np.where(F > 1, 1.0 / F**2, 0.0),
}


@pytest.mark.parametrize("name", DENSITIES)
@pytest.mark.parametrize("slope", [3.0, 6.0])
def test_dirlik_by_its_integral(name, slope):
    found = mf.spectral_damage(F, DENSITIES[name], slope=slope)
    assert found == pytest.approx(dirlik(F, DENSITIES[name], slope), rel=1e-6)


# Damage per second at m = 4 by FLife 2.3, an independent implementation.
BY_FLIFE = {
    "two modes": {
        "narrow_band": 1473.3264952542495,
        "dirlik": 703.9663932967759,
        "tovo_benasciutti": 753.3244163191707,
        "single_moment": 782.4326899974385,
    },
    "plateau": {
        "narrow_band": 4922.462969485823,
        "dirlik": 4123.449219858015,
        "tovo_benasciutti": 3949.538526215192,
        "single_moment": 4164.408255111663,
    },
    "road": {
        "narrow_band": 60.76078970625018,
        "dirlik": 29.307313338517094,
        "tovo_benasciutti": 30.49850081833837,
        "single_moment": 24.52611551290976,
    },
}


@pytest.mark.parametrize("name", DENSITIES)
def test_another_implementation(name):
    assert {
        method: mf.spectral_damage(F, DENSITIES[name], slope=4.0, method=method) for method in METHODS
    } == pytest.approx(BY_FLIFE[name], rel=1e-12)


@pytest.mark.parametrize("name", DENSITIES)
def test_spectral_damage_is_that_of_counted_histories(name):
    """Rainflow of 800 s of Gaussian history, m = 4. Both methods are fits: −16 to −6 % off on these spectra."""
    step = 1 / 1200  # twenty samples to the shortest wave: crests are missed by (π/20)²/6 on average, 2 % of a⁴
    history = gaussian(F, DENSITIES[name], seconds=800.0, step=step, seed=6)
    counted = mf.rainflow_damage(history, slope=4.0) / 800.0
    for method in ("dirlik", "tovo_benasciutti"):
        assert mf.spectral_damage(F, DENSITIES[name], slope=4.0, method=method) == pytest.approx(counted, rel=0.18)
    # A narrow band of the same variance and crossings is the worst case.
    assert mf.spectral_damage(F, DENSITIES[name], slope=4.0, method="narrow_band") > 0.97 * counted


def two_sharp_modes(share):
    """Two lightly damped modes a decade apart, the high one with so many times the density."""
    low, high = (1 / ((f**2 - F**2) ** 2 + (0.02 * f * F) ** 2) for f in (3.0, 30.0))
    return low / low.max() + share * high / high.max()


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("slope", [2.0, 4.0, 10.0])
def test_no_damage_beyond_what_a_gaussian_process_can_do(method, slope):
    """Above zero and at most a narrow band's, over irregularities from 0.2 to 1; what is outside is refused."""
    for share in np.geomspace(1e-4, 10.0, 12):
        density = two_sharp_modes(share)
        most = narrow_band(F, density, slope) * (1 + 1e-6)
        if method == "dirlik" and dirlik(F, density, slope) > most:
            m0, m2, m4 = moments(F, density, 0, 2, 4)
            with pytest.raises(ValueError, match=f"irregularity is {m2 / np.sqrt(m0 * m4):.3g}:"):
                mf.spectral_damage(F, density, slope=slope, method=method)
        else:
            assert 0 < mf.spectral_damage(F, density, slope=slope, method=method) <= most


def test_a_fit_beyond_its_range_is_refused():
    """Where Dirlik's formula, integrated here, exceeds a narrow band; the other methods stay below it."""
    share = next(
        share
        for share in np.geomspace(1e-4, 10.0, 60)
        if dirlik(F, two_sharp_modes(share), 10.0) > 1.01 * narrow_band(F, two_sharp_modes(share), 10.0)
    )
    with pytest.raises(ValueError, match="method 'dirlik' does not hold for this density, whose irregularity is 0"):
        mf.spectral_damage(F, two_sharp_modes(share), slope=10.0)
    assert mf.spectral_damage(F, two_sharp_modes(share), slope=10.0, method="tovo_benasciutti") > 0


def test_negative_damage_is_refused(monkeypatch):
    """As of a method whose weights turn negative: Zhao and Baker's, whose Rayleigh part does below 0.13."""
    monkeypatch.setattr(fatigue, "METHODS", {**METHODS, "zhao_baker": lambda moment, slope: -0.2})
    density = np.where(F > 0.6, F**-3.0, 0.0)
    with pytest.raises(ValueError, match=r"method 'zhao_baker' does not hold .* it gives -0.2 times the damage"):
        mf.spectral_damage(F, density, slope=4.0, method="zhao_baker")


def test_damage_beyond_numbers():
    with pytest.raises(ValueError, match="strength must be in proportion to the density, got 1 "):
        mf.spectral_damage(F, np.full(F.size, 1e18), slope=50.0)


def test_scales():
    """Damage goes with the amplitude to the power of m, at forces of any size, and with one over the strength."""
    small = mf.spectral_damage(F, DENSITIES["plateau"], slope=12.0)
    large = mf.spectral_damage(F, 1e10 * DENSITIES["plateau"], slope=12.0, strength=1e60)
    assert large == pytest.approx(small, rel=1e-9)
    assert mf.spectral_damage(F, 0 * F, slope=4.0) == 0.0


@pytest.mark.parametrize("method", METHODS)
def test_lines(method):
    """One line is a narrow band by every method, ν₀ (√2 σ)^m Γ(1 + m/2); one at 0 Hz is at rest."""
    for f, density, nu in (
        ([1.0, 2.0, 3.0], [0.0, 1.0, 0.0], 2.0),
        ([1.0, 2.0], [0.0, 2.0], 2.0),
        ([0.0, 0.1, 0.2], [0.0, 10.0, 0.0], 0.1),
        ([7.0, 7.0 + 1e-6], [1e6, 1e6], 7.0),
    ):
        found = mf.spectral_damage(f, density, slope=4.0, method=method)
        assert found == pytest.approx(nu * 4.0 * 2.0, rel=1e-5), (f, density)
    for density in ([1.0, 0.0], [1e3, 0.0]):
        assert mf.spectral_damage([0.0, 1.0], density, slope=4.0, method=method) == 0.0
    # Towards a line every method ends in it.
    for width in 10.0 ** np.arange(-9, -2):
        found = mf.spectral_damage([5.0 - width, 5.0, 5.0 + width], [0.0, 1 / width, 0.0], slope=4.0, method=method)
        assert found == pytest.approx(40.0, rel=1e-4)
        found = mf.spectral_damage([5.0 - width, 5.0 + width], [0.5 / width, 0.5 / width], slope=4.0, method=method)
        assert found == pytest.approx(40.0, rel=1e-3)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: mf.spectral_damage(F, F, slope=0.0), "slope must be positive"),
        (lambda: mf.spectral_damage(F, F, slope=4.0, strength=-1.0), "strength must be positive"),
        (lambda: mf.spectral_damage(F, -F, slope=4.0), "density must not be negative"),
        (lambda: mf.spectral_damage(F[::-1], F, slope=4.0), "frequency must be at least two numbers"),
        (lambda: mf.spectral_damage(F, F[1:], slope=4.0), "density must have shape"),
        (lambda: mf.spectral_damage(F, F, slope=4.0, method="miles"), "method must be one of narrow_band, dirlik"),
        (lambda: mf.level_crossings([np.nan], [0.0]), "values must be finite"),
        (lambda: mf.rainflow([[1.0]]), "values must have shape"),
        (lambda: mf.rainflow([]), "values must hold at least one number"),
        (lambda: mf.equivalent_amplitude([], slope=3.0, duration=1.0), "values must hold at least one number"),
        (
            lambda: mf.spectral_damage(F, F, slope=4.0, method=["dirlik"]),
            "method must be one of narrow_band, dirlik",
        ),
        (lambda: mf.spectral_damage(F, F, slope=51.0), "slope must be at most 50"),
        (lambda: mf.equivalent_amplitude([1.0, 2.0, 1.0], slope=3.0, duration=0.0), "duration must be positive"),
        (lambda: mf.rainflow_damage([1.0, 2.0, 1.0], slope=-3.0), "slope must be positive"),
    ],
)
def test_refusals(call, message):
    with pytest.raises(mf.ParameterError, match=message):
        call()

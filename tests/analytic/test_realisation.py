"""Realised roads against the spectra, coherences and distributions that they are asked for."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.signal import csd, welch
from scipy.stats import chi2, kstest, laplace

import movingfrf as mf
from movingfrf.roughness.realisation import Harmonics
from movingfrf.roughness.spectra.coherence import presumed

SPECTRA = [
    mf.IsoRoad.of_class("A"),
    mf.IsoRoad.of_class("C", waviness=2.6),
    mf.FraTrack.of_class(6),
    mf.FrybaTrack.of_class(4),
    mf.GermanTrack.of_class("high"),
    mf.SncfTrack.of_class("poor"),
    mf.ChineseBallastlessTrack(),
    mf.iso3095_limit(),
]


@pytest.mark.parametrize("spectrum", SPECTRA, ids=str)
def test_realised_spectra_lie_in_the_confidence_band_of_the_estimator(spectrum):
    """Welch over the whole band, from the longest wave to the shortest.

    Half-overlapping Hann windows of 24 of the longest waves; K segments are worth 36 K²/(19 K − 1) independent
    ones, a χ² of twice as many degrees of freedom, between whose 0.05 % and 99.95 % quantiles all but one in a
    thousand lines are expected. The window smears a spectrum that falls with n^w by w(w + 1)/2 · (Δn/n)², 2 % at
    the 24th line for the steepest, and takes from what is next to the ends of the band: three lines there are left
    out.
    """
    low, high = spectrum.band
    step = 0.45 / high
    segment = int(24 / (low * step))
    count = 40
    profile = mf.realise(spectrum, length=0.5 * (count + 1) * segment * step, step=step, seed=5)
    elevation = np.asarray(profile.elevation)[: (count + 1) * segment // 2]
    n, density = welch(elevation, 1 / step, nperseg=segment, detrend=False)
    inside = (n > low + 3 * n[1]) & (n < high - 3 * n[1])
    freedom = 2 * 36 * count**2 / (19 * count - 1)
    bounds = chi2.ppf([5e-4, 1 - 5e-4], freedom) / freedom
    ratio = density[inside] / spectrum.density(n[inside])
    beyond = np.mean((ratio < bounds[0]) | (ratio > bounds[1]))
    assert inside.sum() > 400
    assert beyond < 0.003
    # Tenths of decades have so many lines that a few per cent would show.
    for start in np.geomspace(low * 1.2, high / 1.3, 15):
        part = (n[inside] >= start) & (n[inside] < 1.26 * start)
        independent = freedom / 2 * max(part.sum() / 2, 1)
        assert ratio[part].mean() == pytest.approx(1.0, abs=4 / np.sqrt(independent) + 0.02)
    assert density[n > high + 3 * n[1]].max(initial=0.0) < 1e-3 * spectrum.density(np.array(high))


@pytest.mark.parametrize("waviness", [1.0, 2.0, 2.6, 4.0])
def test_isotropic_coherence_is_the_transform_of_an_isotropic_spectrum(waviness):
    """∫ (k² + q²)^−(w+1)/2 cos(q Δy) dq over the same without the cosine, by quadrature of the oscillating tail."""
    coherence = mf.IsotropicCoherence(waviness=waviness)
    for n, apart in [(0.02, 0.75), (0.1, 1.5), (0.3, 2.0), (0.1, -1.5)]:
        k = 2 * np.pi * n

        def surface(q, k=k):
            return (k * k + q * q) ** (-(waviness + 1) / 2)

        whole = quad(surface, 0, np.inf, epsrel=1e-12)[0]
        shared = quad(surface, 0, np.inf, weight="cos", wvar=abs(apart), epsabs=1e-8 * whole, limit=300)[0]
        found = coherence.between(np.array([n]), np.array([[apart]]))
        assert found.shape == (1, 1, 1)
        assert found.item() == pytest.approx(shared / whole, abs=2e-8)


def test_coherence_at_the_ends():
    """One path is itself at any frequency; far apart nothing is in common; waves of any length give a number."""
    for coherence in (
        mf.IsotropicCoherence(),
        mf.IsotropicCoherence(waviness=10.0),
        mf.ExponentialCoherence(decay=5),
    ):
        n = np.array([0.0, 1e-20, 1e-3, 1e3])
        with np.errstate(all="raise", under="ignore"):
            assert coherence.between(n, np.zeros(2)).tolist() == [[1.0, 1.0]] * 4
            shared = coherence.between(n, np.array([1.5]))[:, 0]
        assert (np.diff(shared) <= 0).all()
        assert shared[0] == 1.0
        assert shared[:2] == pytest.approx(1.0, abs=1e-12)
        assert shared[-1] == pytest.approx(0.0, abs=1e-12)


COHERENCES = [mf.IsotropicCoherence(), mf.IsotropicCoherence(waviness=2.6), mf.ExponentialCoherence(decay=3.0)]


@pytest.mark.parametrize("coherence", COHERENCES, ids=str)
def test_paths_have_in_common_what_they_should(coherence):
    """Line by line over 200 seeds: a whole period of each road, no window, no leakage.

    With lines of unit variance A_i = Σ L_ik e^{iφ_k}, Re(A_i A_j*) has the mean γ_ij and, for the first path, the
    variance (1 − γ²)/2; the sum of the squares of the standardised means over N lines is N ± 4 √(2N). For other
    pairs Re and Im are bounded by 1 in standard deviation.
    """
    spectrum = mf.IsoRoad.of_class("B", band=(0.05, 2.0))
    across = np.array([0.75, -0.75, 0.0])
    seeds, samples, step = 200, 400, 0.1
    n = np.fft.rfftfreq(samples, step)
    lines = (n > 0.05) & (n < 2.0)
    gamma = coherence.between(n[lines], across[:, None] - across)
    # A period of 160 halves of the shortest wave: what 39.75 m and an end ask for.
    place = {"length": 39.75, "step": step, "covering": (0.0, (samples - 1) * step)}
    scale = np.sqrt(
        np.diff(spectrum.variance_below(np.array([n[lines] - n[1] / 2, n[lines] + n[1] / 2])), axis=0)[0]
    )
    cross = np.zeros((lines.sum(), 3, 3), complex)
    for seed in range(seeds):
        road = mf.realise(spectrum, seed=seed, across=across, coherence=coherence, **place)
        assert np.shape(road.elevation) == (samples, 3)
        assert road.across == (0.75, -0.75, 0.0)
        amplitude = np.sqrt(2) * np.fft.rfft(road.elevation, axis=0)[lines] / samples / scale[:, None]
        cross += np.einsum("fi,fj->fij", amplitude, amplitude.conj()) / seeds
    # The first path has the spectrum exactly, each other one on average.
    np.testing.assert_allclose(cross[:, 0, 0].real, 1.0, rtol=1e-9)
    for pair in [(0, 1), (0, 2)]:
        deviation = np.sqrt((1 - gamma[:, *pair] ** 2) / (2 * seeds))
        scattered = (cross[:, *pair].real - gamma[:, *pair]) / deviation
        count = scattered.size
        assert abs(np.sum(scattered**2) - count) < 4 * np.sqrt(2 * count)
        assert np.abs(scattered).max() < 4.5
        assert abs(scattered.mean()) < 4 / np.sqrt(count)
        assert abs(np.sum((cross[:, *pair].imag / deviation) ** 2) - count) < 4 * np.sqrt(2 * count)
    assert np.abs((cross - gamma)[:, 1:, 1:]).max() < 5 / np.sqrt(seeds)
    assert np.abs((cross - gamma)[:, 1:, 1:].mean(axis=0)).max() < 5 / np.sqrt(seeds * lines.sum())


def test_coherence_by_an_independent_estimator():
    """Welch's cross-spectrum of one long road, over the whole band, tenths of decades at a time."""
    spectrum = mf.IsoRoad.of_class("C", band=(0.01, 4.0))
    road = mf.realise(spectrum, length=20_000.0, step=0.1, seed=11, across=[0.75, -0.75])
    left, right = np.asarray(road.elevation).T
    settings = {"fs": 10.0, "nperseg": 10_000, "detrend": False}
    n, shared = csd(left, right, **settings)
    own = [welch(path, **settings)[1] for path in (left, right)]
    found = shared.real / np.sqrt(own[0] * own[1])
    expected = mf.IsotropicCoherence().between(n, np.array(1.5))
    for start in np.geomspace(0.012, 3.0, 24):
        part = (n >= start) & (n < 1.26 * start)
        # 39 segments are worth 20 independent ones, neighbouring lines half as many.
        independent = 20 * max(part.sum() / 2, 1)
        scatter = np.sqrt((1 - expected[part] ** 2).mean() / (2 * independent))
        assert found[part].mean() == pytest.approx(expected[part].mean(), abs=5 * scatter + 2e-3)


FINE = mf.IsoRoad.of_class("A", band=(0.01, 10.0))
COARSE = mf.IsoRoad.of_class("C", band=(0.001, 0.0104))
# Spectrum, steps, and the distance at which stations of all of them lie.
STEPS = [(FINE, [0.05, 0.02, 0.0125, 0.004, None], 0.1), (COARSE, [1.0, 48.0, 12.0], 48.0)]


@pytest.mark.parametrize(("spectrum", "steps", "common"), STEPS, ids=["short waves", "long waves"])
@pytest.mark.parametrize("kind", ["one path", "surface", "strangers", "Laplace"])
def test_a_road_belongs_to_seed_length_and_band_and_not_to_the_step(spectrum, steps, common, kind):
    """By its sum at every station that they share; at the coarsest step there are 2.003 stations to a wave."""
    make = {
        "one path": mf.realise,
        "surface": partial(mf.realise, across=[0.7, -0.7]),
        "strangers": partial(mf.realise, seed=[4, 2]),
        "Laplace": partial(mf.realise_laplace, kurtosis=6.0, segment=60.0),
    }[kind]
    length = 2000 * common
    roads = [make(spectrum, length=length, step=step, start=-3.0) for step in steps]
    shared = [road.columns[:: round(common / road.even_step())][:2001] for road in roads]
    for found in shared[1:]:
        np.testing.assert_allclose(found, shared[0], rtol=0, atol=1e-9 * shared[0].std())
    assert roads[-1].stations[-1] >= length - 3.0


def test_harmonics_are_summed_where_the_stations_are():
    """The sum written out, at both ends and in the middle of 5 km of road, whose lines lie within the band."""
    spectrum = mf.IsoRoad.of_class("A", band=(0.013, 8.0))
    harmonics = Harmonics.of(spectrum.band, 5000.0)
    n = harmonics.numbers / harmonics.period
    assert harmonics.period > 5000.0
    assert spectrum.band[0] <= n[0] < n[0] + 1 / harmonics.period
    assert n[-1] == pytest.approx(spectrum.band[1], rel=1e-12)
    assert harmonics.variances(spectrum).sum() == pytest.approx(spectrum.variance_below(np.array(9.0)), rel=1e-12)
    phases = np.random.default_rng(7).uniform(0.0, 2 * np.pi, n.size)
    road = mf.realise(spectrum, length=5000.0, step=0.03, start=100.0, seed=7)
    for x in road.stations[[0, 1, 2, 80_000, -2, -1]]:
        waves = np.cos(2 * np.pi * n * (x - 100.0) + phases)
        expected = np.sqrt(2 * harmonics.variances(spectrum)) @ waves
        assert road.along(0)(x) == pytest.approx(expected, abs=1e-10 * np.std(road.elevation))


def test_the_default_step_is_a_sixteenth_of_the_shortest_wave():
    for spectrum in (FINE, mf.GermanTrack.of_class("low")):
        assert mf.realise(spectrum, length=40.0).even_step() == pytest.approx(0.0625 / spectrum.band[1], rel=1e-9)


@pytest.mark.parametrize("kind", [mf.realise, partial(mf.realise_laplace, kurtosis=6.0, segment=1.0)])
def test_a_road_goes_on_beyond_its_length(kind):
    """Ahead and behind, at the same whole steps, until it repeats itself."""
    road = kind(FINE, length=300.0, start=2.0, step=0.02)
    longer = kind(FINE, length=300.0, start=2.0, step=0.02, covering=(-3.005, 330.001))
    assert longer.stations[[0, -1]] == pytest.approx([-3.02, 330.02], abs=1e-9)
    same = longer.columns[251 : 251 + road.stations.size]
    np.testing.assert_allclose(same, road.columns, rtol=0, atol=1e-10 * road.columns.std())
    period = Harmonics.of(FINE.band, 300.0).period
    assert period == pytest.approx(300.8)
    np.testing.assert_allclose(longer.along(0)(-1.0), longer.along(0)(period - 1.0), rtol=0, atol=1e-10)
    # A length that differs by a rounding has the same road, one of four metres more another.
    again, other = (kind(FINE, length=300.0 + more, start=2.0, step=0.02) for more in (0.003, 4.0))
    np.testing.assert_allclose(again.columns[: road.stations.size], road.columns, rtol=0, atol=1e-12)
    assert np.abs(other.columns[: road.stations.size] - road.columns).max() > road.columns.std()


@pytest.mark.parametrize("length", [10.0, 10.5, 11.0])
def test_no_band_is_too_narrow(length):
    narrow = mf.IsoRoad.of_class("A", band=(1.01, 1.02))
    road = mf.realise(narrow, length=length, step=0.1)
    assert np.var(road.elevation) == pytest.approx(float(narrow.variance_below(np.array(2.0))), rel=0.1)
    assert np.var(mf.realise_laplace(narrow, kurtosis=4.0, segment=1.0, length=length).elevation) > 0


def test_the_first_path_is_the_road_by_itself():
    spectrum = mf.IsoRoad.of_class("B")
    alone = mf.realise(spectrum, length=100.0, seed=4)
    assert alone.same_across
    assert alone.source.endswith("seed 4")
    pair = mf.realise(spectrum, length=100.0, seed=4, across=[0.8, -0.7, 0.8])
    columns = np.asarray(pair.elevation)
    np.testing.assert_array_equal(columns[:, 0], alone.elevation)
    # A path in the same place is the same path.
    np.testing.assert_allclose(columns[:, 2], alone.elevation, atol=1e-9 * np.abs(alone.elevation).max())
    assert 0.5 < np.corrcoef(columns.T)[0, 1] < 1.0


def test_paths_close_together_need_no_luck():
    """Coherence matrices of many close paths are singular to rounding; neighbours differ by what they should.

    E (z_i − z_j)² = ∫ 2 (1 − γ) G_d dn.
    """
    spectrum = mf.IsoRoad.of_class("B", band=(0.01, 5.0))
    across = np.linspace(0.0, 0.5, 11)
    road = mf.realise(spectrum, length=2000.0, step=0.1, seed=0, across=across)
    columns = np.asarray(road.elevation)
    assert np.isfinite(columns).all()

    def apart(n):
        gamma = mf.IsotropicCoherence().between(np.array([n]), np.array(0.05))[0]
        return 2 * (1 - gamma) * spectrum.density(np.array(n))

    expected = quad(apart, 0.01, 5.0, limit=200, points=[0.1, 1.0])[0]
    # Half of it comes from waves shorter than a metre: 2000 m hold thousands of independent pieces.
    assert np.mean(np.diff(columns, axis=1) ** 2) == pytest.approx(expected, rel=0.05)


@pytest.mark.parametrize("shared", [-0.6, 0.999])
def test_what_three_paths_cannot_have_in_common(shared):
    """Three paths cannot each oppose both others, nor the outer two be strangers if the middle one knows both."""

    class Some:
        def between(self, spatial_frequency, apart):
            both = np.where(np.abs(apart) > 1.0, -0.6 if shared < 0 else 0.2, shared)
            return np.broadcast_to(np.where(apart == 0, 1.0, both), (*spatial_frequency.shape, *apart.shape))

    with pytest.raises(ValueError, match="coherence must be positive semidefinite over the paths at 0, 1, 2 m"):
        mf.realise(mf.IsoRoad.of_class("A"), length=20.0, across=[0.0, 1.0, 2.0], coherence=Some())


@settings(max_examples=40, deadline=None, derandomize=True)
@example([0.0, 3.39e-06, 0.125, 1.0], mf.IsotropicCoherence(waviness=4.0))
@given(
    st.lists(st.floats(-3.0, 3.0), min_size=1, max_size=8),
    st.one_of(
        st.floats(0.05, 10.0).map(lambda waviness: mf.IsotropicCoherence(waviness=waviness)),
        st.floats(0.0, 100.0).map(lambda decay: mf.ExponentialCoherence(decay=decay)),
    ),
)
def test_any_paths_belong_together(across, coherence):
    """Both models are positive semidefinite over any paths, and no such set is refused, however close they lie."""
    at = np.array(across)
    matrices = coherence.between(np.geomspace(1e-4, 10.0, 30), at[:, None] - at)
    assert ((matrices >= 0) & (matrices <= 1)).all()
    assert np.linalg.eigvalsh(matrices).min() > -1e-12
    road = mf.realise(mf.IsoRoad.of_class("A"), length=20.0, across=across, coherence=coherence)
    columns = np.asarray(road.elevation)
    np.testing.assert_array_equal(columns[:, 0], mf.realise(mf.IsoRoad.of_class("A"), length=20.0).elevation)
    assert np.isfinite(columns).all()


def test_presumed_coherence():
    assert presumed(mf.IsoRoad.of_class("A", waviness=2.4)) == mf.IsotropicCoherence(waviness=2.4)
    assert presumed(mf.IsoRoad.of_class("A", waviness=0.0)) is None
    assert presumed(mf.FraTrack.of_class(5)) is None


# As white as its step allows: the filter leaves the noise as it is but for the longest waves.
WHITE = mf.IsoRoad(roughness=1e-6, waviness=0.0, band=(0.01, 10.0))


def test_noise_of_kurtosis_six_is_laplace_distributed():
    """A normal variate with exponentially distributed variance is Laplace distributed; variance ∫ G_d dn = 1e-5."""
    road = mf.realise_laplace(WHITE, kurtosis=6.0, segment=0.05, length=10_000.0, step=0.05, seed=1)
    elevation = np.asarray(road.elevation)
    assert kstest(elevation, laplace(scale=np.sqrt(0.5 * 1e-6 * 9.99)).cdf).pvalue > 0.01
    assert kstest(elevation, "norm", args=(0, np.sqrt(1e-6 * 9.99))).pvalue < 1e-6


@pytest.mark.parametrize("segment", [0.25, 2.0, 60.0])
def test_kurtosis_of_laplace_roads(segment):
    """E z⁴/(E z²)² = 3 (1 + ν Σ_segments (Σ f²)²/(Σ f²)²), f the weights of the filter, averaged over places.

    With kurtosis 4 the gamma variances have E V² = 4/3 and a standard deviation of V² of 1.63: the mean over N
    segments scatters by 1.63/√N, here below 4 % even for the longest.
    """
    spectrum = mf.IsoRoad(roughness=16e-6, waviness=2.0, band=(0.05, 2.0))
    step, length = 0.25, 250_000.0
    road = mf.realise_laplace(spectrum, kurtosis=4.0, segment=segment, length=length, step=step, seed=8)
    z = np.asarray(road.elevation)
    found = np.mean(z**4) / np.mean(z**2) ** 2
    samples = 4800
    n = np.fft.rfftfreq(samples, step)
    weights = np.fft.irfft(np.sqrt(spectrum.density(n)), samples) ** 2
    per = round(segment / step)
    shares = [np.roll(weights, shift).reshape(-1, per).sum(axis=1) for shift in range(per)]
    expected = 3 * (1 + (4 / 3 - 1) * np.mean([np.sum(s**2) for s in shares]) / weights.sum() ** 2)
    assert 3 < expected < 4
    assert found == pytest.approx(expected, abs=0.12)


def test_laplace_roads_have_the_spectrum_in_expectation():
    """Mean periodogram of 400 whole periods; the variances make lines scatter by √(1 + …), well within 2 each."""
    spectrum = mf.IsoRoad.of_class("C", band=(0.05, 2.0))
    samples, step, seeds = 400, 0.1, 400
    n = np.fft.rfftfreq(samples, step)
    lines = (n > 0.06) & (n < 1.99)
    power = 0.0
    for seed in range(seeds):
        road = mf.realise_laplace(
            spectrum,
            kurtosis=6.0,
            segment=5.0,
            length=39.75,
            step=step,
            covering=(0.0, (samples - 1) * step),
            seed=seed,
            across=[0.7, -0.7],
        )
        power = power + 2 * np.abs(np.fft.rfft(road.elevation, axis=0)[lines] / samples) ** 2 / seeds
    expected = spectrum.variance_below(n[lines] + n[1] / 2) - spectrum.variance_below(n[lines] - n[1] / 2)
    ratio = power / expected[:, None]
    assert np.abs(ratio - 1).max() < 5 * np.sqrt(2 / seeds)
    assert ratio.mean() == pytest.approx(1.0, abs=0.02)


def test_laplace_paths_are_rough_in_the_same_places():
    noise = {"kurtosis": 9.0, "segment": 10.0, "coherence": mf.ExponentialCoherence(decay=100.0)}
    road = mf.realise_laplace(WHITE, length=20_000.0, step=0.05, seed=3, across=[0.0, 50.0], **noise)
    left, right = (np.asarray(road.elevation)[:-1].reshape(-1, 200, 2).std(axis=1)).T
    columns = np.asarray(road.elevation)
    assert abs(np.corrcoef(columns.T)[0, 1]) < 0.05  # nothing in common, wave by wave
    assert np.corrcoef(left, right)[0, 1] > 0.95  # but the variance


def test_laplace_seeds():
    road = {"spectrum": WHITE, "kurtosis": 5.0, "segment": 1.0, "length": 50.0}
    spectrum = road.pop("spectrum")
    first, again, other = (mf.realise_laplace(spectrum, **road, seed=seed) for seed in (5, 5, 6))
    np.testing.assert_array_equal(first.elevation, again.elevation)
    assert np.abs(np.asarray(first.elevation) - other.elevation).max() > 1e-4
    several = mf.realise_laplace(spectrum, **road, seed=[6, 5])
    np.testing.assert_array_equal(np.asarray(several.elevation)[:, 1], first.elevation)
    assert "kurtosis 5" in first.source


ISO = mf.IsoRoad.of_class("A")


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda: mf.realise(ISO, length=9.0, seed=[1, 2], across=[0, 1]),
            "seed must be one whole number where `across`",
        ),
        (lambda: mf.realise(ISO, length=9.0, across=[]), "across must hold the lateral position"),
        (lambda: mf.realise(ISO, length=9.0, across=[[1.0]]), "across must have shape"),
        (lambda: mf.realise(ISO, length=9.0, coherence=mf.IsotropicCoherence()), "coherence is of use only with"),
        (lambda: mf.realise(mf.FraTrack.of_class(5), length=9.0, across=[0, 1]), "coherence is needed"),
        (
            lambda: mf.realise(ISO, length=9.0, step=0.06),
            r"step must be at most 0\.05 m, half of the shortest wave",
        ),
        (lambda: mf.realise(ISO, length=9.0, step=0.0), "step must be positive"),
        (lambda: mf.realise(ISO, length=9.0, covering=(3.0, 3.0)), "covering must be a first and a last distance"),
        (lambda: mf.realise(ISO, length=9.0, covering=(3.0,)), "covering must have shape"),
        (
            lambda: mf.realise(16e-6, length=9.0),
            "spectrum must be a roughness spectrum, as IsoRoad is, got 1.6e-05",
        ),
        (lambda: mf.IsotropicCoherence(waviness=0.0), "waviness must be positive"),
        (lambda: mf.IsotropicCoherence(waviness=11.0), "waviness must be at most 10"),
        (lambda: mf.ExponentialCoherence(decay=-1.0), "decay must not be negative"),
        (
            lambda: laplace_road(kurtosis=3.0),
            r"kurtosis must be above 3, the kurtosis of a Gaussian road, got 3\.0",
        ),
        (lambda: laplace_road(kurtosis=3.0000000000000004), "kurtosis must be above 3"),
        (
            lambda: laplace_road(segment=0.01),
            r"segment must be at least half of the shortest wave of the spectrum, 0\.05 m",
        ),
        (lambda: laplace_road(seed=[]), "seed must be a whole number"),
    ],
)
def test_impossible_realisations(make, message):
    with pytest.raises(mf.ParameterError, match=message):
        make()


def laplace_road(**changes):
    return mf.realise_laplace(ISO, **({"kurtosis": 6.0, "segment": 1.0, "length": 10.0} | changes))

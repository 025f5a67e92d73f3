"""Moving FRFs and critical speeds against closed forms and published or independently computed numbers."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import movingfrf as mf
from movingfrf.guideways.waves import ONE, Ratio, polynomial
from tests.helpers import DAMPED, PAVEMENT, RAIL, UNDAMPED

TABLE = Path(__file__).parents[1] / "data" / "moving_frf.csv"
ROWS = list(csv.DictReader(TABLE.read_text().splitlines()))


@pytest.mark.parametrize("guideway", sorted({row["guideway"] for row in ROWS}))
def test_every_row_of_the_table(guideway):
    """Integrals over κ with thirty digits, no residues; their own error is 1e-9 (METHOD.md section 9)."""
    rows = [row for row in ROWS if row["guideway"] == guideway]
    assert len(rows) > 20
    for row in rows:
        omega = 2 * np.pi * float(row["frequency_Hz"])
        frf = DAMPED[guideway].moving_frf([float(row["offset_m"])], float(row["speed_m_s"]), [omega])[0, 0]
        expected = float(row["frf_real_m_N"]) + 1j * float(row["frf_imag_m_N"])
        assert abs(frf - expected) < 1e-8 * abs(expected), row


# PARAMETERS.md, steady moving load on a damped Winkler beam: (v/v_cr, c/2√(mk)) → deflection under the load and
# greatest deflection anywhere, over the static one.
STEADY = {
    (0.5, 0.05): (1.15326, 1.15358), (0.5, 0.1): (1.14897, 1.15027), (0.5, 0.3): (1.10617, 1.11726),
    (0.5, 1.1): (0.78459, 0.85915), (0.5, 2.0): (0.53280, 0.63285),
    (0.9, 0.05): (2.19388, 2.22373), (0.9, 0.1): (1.96671, 2.06040), (0.9, 0.3): (1.20266, 1.44001),
    (0.9, 1.1): (0.47602, 0.66815), (0.9, 2.0): (0.29287, 0.42868),
    (1.0, 0.05): (2.60231, 3.78221), (1.0, 0.1): (1.80246, 2.64655), (1.0, 0.3): (0.96563, 1.44854),
    (1.0, 1.1): (0.40512, 0.62410), (1.0, 2.0): (0.25451, 0.39505),
    (2.0, 0.05): (0.00344, 0.94765), (2.0, 0.1): (0.00686, 0.88048), (2.0, 0.3): (0.02002, 0.68078),
    (2.0, 1.1): (0.05366, 0.34286), (2.0, 2.0): (0.06039, 0.21524),
}  # fmt: skip


@pytest.mark.parametrize(("case", "expected"), STEADY.items())
def test_steady_load_over_speed_and_damping(case, expected):
    (share, ratio), (bending, mass, stiffness) = case, (1.573e7, 711.9, 8.0e6)
    road = mf.track(
        mf.EulerBernoulliBeam(bending_stiffness=bending, mass=mass),
        mf.Spring(stiffness=stiffness, damping=2 * ratio * np.sqrt(mass * stiffness)),
    )
    speed = share * np.sqrt(2 * np.sqrt(stiffness * bending) / mass)
    static = 1 / (2 * np.sqrt(2) * bending * (stiffness / bending) ** 0.75)
    x = np.linspace(-12.0, 4.0, 16_001)
    under = road.moving_frf([0.0], speed, [0.0])[0, 0].real / static
    greatest = road.moving_frf(x, speed, [0.0])[0].real.max() / static
    # The digits of the table; the grid of 1 mm finds a peak to 1e-6.
    assert under == pytest.approx(expected[0], abs=0.51e-5)
    assert greatest == pytest.approx(expected[1], abs=0.51e-5)


positive = {"allow_nan": False, "allow_infinity": False}
beams = st.tuples(
    st.floats(1e5, 1e9, **positive), st.floats(10.0, 5e3, **positive), st.floats(1e5, 1e9, **positive)
)
drawn = settings(max_examples=25, deadline=None, derandomize=True)


@drawn
@given(beam=beams, share=st.just(0.0) | st.floats(1e-6, 0.95), shear=st.just(0.0) | st.floats(0.01, 0.9))
def test_steady_load_without_damping(beam, share, shear):
    """w(0) = P/(2 EI b √(2b + a)), b = √(k/EI), a = (G_p − mv²)/EI, up to 0.95 of the critical speed.

    Rounding in 2b + a is amplified by 1/(1 − (v/v_cr)²), about ten.
    """
    bending, mass, stiffness = beam
    pasternak = shear * 2 * np.sqrt(stiffness * bending)
    foundation = (
        mf.ShearLayer(stiffness=stiffness, shear_stiffness=pasternak)
        if pasternak
        else mf.Spring(stiffness=stiffness)
    )
    road = mf.track(mf.EulerBernoulliBeam(bending_stiffness=bending, mass=mass), foundation)
    critical = np.sqrt((pasternak + 2 * np.sqrt(stiffness * bending)) / mass)
    # Minimum of a phase velocity, found numerically to the square root of the rounding error or better.
    assert road.critical_speed == pytest.approx(critical, rel=1e-9)
    speed = share * critical
    b, a = np.sqrt(stiffness / bending), (pasternak - mass * speed**2) / bending
    expected = 1 / (2 * bending * b * np.sqrt(2 * b + a))
    assert road.moving_frf([0.0], speed, [0.0])[0, 0] == pytest.approx(expected, rel=1e-10)
    at_rest = road.moving_frf([0.0], 0.0, [0.0])[0, 0].real
    assert expected / at_rest == pytest.approx(1 / np.sqrt(1 - share**2), rel=1e-10)


@drawn
@given(beam=beams, damping=st.just(0.0) | st.floats(1e-3, 2.0), frequency=st.floats(0.0, 0.95))
def test_point_receptance_at_rest(beam, damping, frequency):
    """G(0; ω) = 1/(2√2 EI q³), q⁴ = (k + icω − mω²)/EI, to 1e-12; also when the road creeps at 1e-12 m/s."""
    bending, mass, stiffness = beam
    road = mf.track(
        mf.EulerBernoulliBeam(bending_stiffness=bending, mass=mass),
        mf.Spring(stiffness=stiffness, damping=2 * damping * np.sqrt(mass * stiffness)),
    )
    omega = frequency * np.sqrt(stiffness / mass)
    c = 2 * damping * np.sqrt(mass * stiffness)
    q = ((stiffness + 1j * c * omega - mass * omega**2 + 0j) / bending) ** 0.25
    expected = 1 / (2 * np.sqrt(2) * bending * q**3)
    for speed in (0.0, 1e-12):
        assert abs(road.moving_frf([0.0], speed, [omega])[0, 0] / expected - 1) < 1e-12


class Repelling:
    """A foundation of one's own, whose shear layer pushes away: k − G κ²."""

    def __init__(self, stiffness, shear):
        self.table = polynomial({(0, 0): stiffness, (2, 0): -shear})

    def foundation_stiffness(self, *, damped=True):
        return Ratio(self.table, ONE)


def test_a_track_that_buckles_is_refused():
    """EI κ⁴ − G κ² + k has a root from G = 2 √(k EI) on, at κ⁴ = k/EI."""
    stiffness, bending = 8.0e6, 1.573e7
    limit = 2 * np.sqrt(stiffness * bending)
    still = mf.track(PAVEMENT, Repelling(stiffness, (1 - 1e-6) * limit))
    assert (
        still.moving_frf([0.0], 0.0, [0.0])[0, 0].real
        > 100 * DAMPED["euler_bernoulli_winkler"].moving_frf([0.0], 0.0, [0.0])[0, 0].real
    )
    length = f"{2 * np.pi * (bending / stiffness) ** 0.25:.3g}"
    with pytest.raises(ValueError, match=rf"beam must stay straight on its foundation, .* in waves of {length} m"):
        mf.track(PAVEMENT, Repelling(stiffness, (1 + 1e-6) * limit))


def test_basin_at_rest():
    """w(x) = w(0) e^{−βx}(cos βx + sin βx), β⁴ = k/4EI; its upward lobe is −e^{−π} at βx = π."""
    road = DAMPED["euler_bernoulli_winkler"]
    beta = (8.0e6 / (4 * 1.573e7)) ** 0.25
    x = np.linspace(-10.0, 10.0, 401)
    basin = road.moving_frf(x, 0.0, [0.0])[0].real
    z = beta * np.abs(x)
    expected = beta / (2 * 8.0e6) * np.exp(-z) * (np.cos(z) + np.sin(z))
    assert np.abs(basin - expected).max() < 1e-12 * expected.max()
    lobe = road.moving_frf([np.pi / beta], 0.0, [0.0])[0, 0].real
    assert lobe / expected.max() == pytest.approx(-np.exp(-np.pi), rel=1e-11)
    # Under a force of one newton the shear jumps by one: −EI w‴ is ±1/2 on either side.
    third = road.moving_frf([0.0, -1e-12], 0.0, [0.0], derivative=3)[0].real
    np.testing.assert_allclose(1.573e7 * third, [0.5, -0.5], rtol=1e-9)
    curvature = road.moving_frf([0.0], 0.0, [0.0], derivative=2)[0, 0].real
    assert -1.573e7 * curvature == pytest.approx(1 / (4 * beta), rel=1e-11)  # moment P/4β, sagging


def test_rigid_sleepers_at_rest():
    """A foundation with masses is at ω = 0 two springs in series."""
    road, k = DAMPED["rail_pad_sleeper_ballast"], 3.0e8 * 1.0e8 / 4.0e8
    q = (k / 6.42e6) ** 0.25
    expected = 1 / (2 * np.sqrt(2) * 6.42e6 * q**3)
    assert road.moving_frf([0.0], 0.0, [0.0])[0, 0] == pytest.approx(expected, rel=1e-11)


def test_undamped_beam_beyond_its_cut_on():
    """Beyond √(k/m) waves leave the load: G = −(1 + i)/(4 EI κ³), energy goes outwards (Im G < 0)."""
    road, omega = UNDAMPED["euler_bernoulli_winkler"], 300.0
    kappa = ((711.9 * omega**2 - 8.0e6) / 1.573e7) ** 0.25
    expected = -(1 + 1j) / (4 * 1.573e7 * kappa**3)
    assert road.moving_frf([0.0], 0.0, [omega])[0, 0] == pytest.approx(expected, rel=1e-11)
    # The wave that travels ahead of the load is e^{−iκx}; the near field has gone after 20 m.
    far = road.moving_frf([20.0, 21.0], 0.0, [omega])[0]
    assert far[1] / far[0] == pytest.approx(np.exp(-1j * kappa), rel=1e-6)


def mobility(road, frequency):
    """|Y| at the load of a track at rest [m/s/N]."""
    omega = 2 * np.pi * np.atleast_1d(frequency)
    return np.abs(omega * road.moving_frf([0.0], 0.0, omega)[:, 0])


def test_published_rail_on_continuous_pads():
    """PARAMETERS.md: UIC60 on 300e6 N/m² and 30 kN s/m² (rolland's analytic table, six digits)."""
    rail = mf.EulerBernoulliBeam(bending_stiffness=210e9 * 3038.3e-8, mass=60.2)
    road = mf.track(rail, mf.Spring(stiffness=300e6, damping=30e3))
    np.testing.assert_allclose(mobility(road, [20.0, 200.907]), [3.88704e-7, 5.13532e-6], rtol=2e-5)
    # The highest value of the table stands at 356 Hz; its frequencies are about one per cent apart.
    assert mobility(road, 356.0)[0] == pytest.approx(2.12203e-5, rel=2e-5)
    frequencies = np.arange(300.0, 420.0, 0.1)
    assert frequencies[mobility(road, frequencies).argmax()] == pytest.approx(356.0, rel=0.005)


def test_published_rail_on_sleepers():
    """PARAMETERS.md: the same with 250 kg/m of sleepers on ballast; two peaks and the dip between them."""
    rail = mf.EulerBernoulliBeam(bending_stiffness=210e9 * 3038.3e-8, mass=60.2)
    pad, ballast = mf.Spring(stiffness=300e6, damping=30e3), mf.Spring(stiffness=100e6, damping=80e3)
    road = mf.track(rail, mf.OnMass(above=pad, mass=250.0, below=ballast))
    assert mobility(road, 20.0)[0] == pytest.approx(1.12899e-6, rel=2e-5)
    frequencies = np.arange(40.0, 600.0, 0.1)
    found = mobility(road, frequencies)
    peaks = frequencies[1:-1][(found[1:-1] > found[:-2]) & (found[1:-1] > found[2:])]
    dips = frequencies[1:-1][(found[1:-1] < found[:-2]) & (found[1:-1] < found[2:])]
    # The published frequencies are those of a table about one per cent apart.
    np.testing.assert_allclose(peaks, [89.6, 403.7], rtol=0.005)
    np.testing.assert_allclose(dips, [198.9], rtol=0.005)


def test_critical_speed_of_the_reference_road():
    assert DAMPED["euler_bernoulli_winkler"].critical_speed == pytest.approx(
        np.sqrt(2 * np.sqrt(8.0e6 * 1.573e7) / 711.9), rel=1e-9
    )
    # Pasternak: v² = (G_p + 2√(kEI))/m.
    assert DAMPED["euler_bernoulli_pasternak"].critical_speed == pytest.approx(
        np.sqrt((2.0e6 + 2 * np.sqrt(8.0e6 * 1.573e7)) / 711.9), rel=1e-9
    )
    assert mf.RigidGuideway().critical_speed == np.inf


def test_critical_speed_of_a_timoshenko_beam():
    """Minimum over κ of Ω/κ, the lower root of ρI m Ω⁴ − (…) Ω² + … = 0, on a fine grid."""
    bending, mass, shear, inertia, k, pasternak = 1.573e7, 711.9, 4.0e8, 5.5, 8.0e6, 2.0e6
    kappa = np.linspace(0.5, 1.5, 200_001)
    # (Sκ² + k + G_pκ² − mΩ²)(EIκ² + S − ρIΩ²) = S²κ²
    one, two = shear * kappa**2 + k + pasternak * kappa**2, bending * kappa**2 + shear
    a, b, c = mass * inertia, -(mass * two + inertia * one), one * two - (shear * kappa) ** 2
    lower = (-b - np.sqrt(b**2 - 4 * a * c)) / (2 * a)
    assert DAMPED["timoshenko_pasternak"].critical_speed == pytest.approx(np.sqrt(lower / kappa**2).min(), rel=1e-8)


def test_critical_speed_with_masses_deflects_most():
    """With its own damping: no other speed below the first stationary phase velocity deflects the track more."""
    road = DAMPED["rail_pad_sleeper_ballast"]
    critical, x = road.critical_speed, np.linspace(-6.0, 2.0, 4001)

    def greatest(speed):
        return road.moving_frf(x, speed, [0.0])[0].real.max()

    others = [greatest(critical * factor) for factor in (0.3, 0.7, 0.95, 0.99, 1.01, 1.05, 1.3)]
    assert greatest(critical) > max(others)


def test_massless_foundation_layer_is_a_spring():
    """A mass without weight to speak of between two springs changes nothing (sign and place of the inertia)."""
    stacked = mf.track(RAIL, mf.OnMass(above=mf.Spring(stiffness=3e8), mass=1e-9, below=mf.Spring(stiffness=1e8)))
    single = mf.track(RAIL, mf.Spring(stiffness=0.75e8))
    omega = np.array([0.0, 100.0, 700.0]) - 5j
    first, second = (road.moving_frf([0.0, 1.0, -1.0], 30.0, omega) for road in (stacked, single))
    assert np.abs(first - second).max() < 1e-9 * np.abs(second).max()


def test_inertia_of_a_layer_softens_the_foundation_below_its_resonance():
    """The absolute fact of the sign of sleeper inertia: k_f = ab/(a + b) with b = k_b − m_s Ω²."""
    omega = 2 * np.pi * 60.0
    below = 1.0e8 - 250.0 * omega**2
    foundation = 3.0e8 * below / (3.0e8 + below)
    q = ((foundation - 60.2 * omega**2) / 6.42e6) ** 0.25
    expected = 1 / (2 * np.sqrt(2) * 6.42e6 * q**3)
    road = UNDAMPED["rail_pad_sleeper_ballast"]
    assert road.moving_frf([0.0], 0.0, [omega])[0, 0] == pytest.approx(expected, rel=1e-10)

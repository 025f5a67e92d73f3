"""Beam elements and user matrices: natural frequencies and deflections at rest against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.optimize import brentq
from scipy.sparse.linalg import spsolve

import movingfrf as mf
from tests.helpers import BALLAST, DAMPED, PAD, PAVEMENT, RAIL, SHEARED_SOIL, SOIL, observed_order

BENDING, MASS, STIFFNESS, DAMPING = 1.573e7, 711.9, 8.0e6, 3.0e4
LENGTH = 20.0
COUNTS = (16, 24, 32, 48)

# Regression over steps that halve or better gives an order to a tenth.
ORDER = 0.1


def cut(track, count, ends="pinned"):
    """LENGTH metres of a track in `count` elements; no band of frequencies is asked for."""
    return mf.finite_track(track, first=0.0, last=LENGTH, element=LENGTH / count, ends=ends, band=0.0)


def natural(road):
    """Natural frequencies without damping, ascending [rad/s]."""
    return np.sqrt(eigh(road.stiffness.toarray(), road.mass.toarray(), eigvals_only=True))


@pytest.mark.parametrize("pasternak", [0.0, 2.0e6], ids=["winkler", "pasternak"])
@pytest.mark.parametrize("n", [2, 3, 5])
def test_frequencies_of_a_pinned_road(n, pasternak):
    """ω = √((EI κ⁴ + G_p κ² + k)/m), κ = nπ/L; cubic elements: order 4.

    The first wave is so accurate (1e-11) that the eigenvalue solver's rounding would show.
    """
    road = mf.track(PAVEMENT, SHEARED_SOIL if pasternak else SOIL)
    kappa = n * np.pi / LENGTH
    exact = np.sqrt((BENDING * kappa**4 + pasternak * kappa**2 + STIFFNESS) / MASS)
    errors = np.array([natural(cut(road, count))[n - 1] / exact - 1 for count in COUNTS])
    # Elements only stiffen.
    assert (errors > 0).all()
    assert observed_order(LENGTH / np.array(COUNTS), errors) == pytest.approx(4.0, abs=ORDER)
    # The classical error (κh)⁴/1440 of ω² of bending alone, half of it in ω, in the share of bending.
    share = BENDING * kappa**4 / (exact**2 * MASS)
    assert errors[-1] < 1.1 * share * (kappa * LENGTH / COUNTS[-1]) ** 4 / 1440


# Frequency equations over x = βL (any text on vibrations), divided by cosh x, and the number of rigid motions.
CLASSICAL = {
    ("clamped", "clamped"): (lambda x: np.cos(x) - 1 / np.cosh(x), 0),
    ("free", "free"): (lambda x: np.cos(x) - 1 / np.cosh(x), 2),
    ("clamped", "free"): (lambda x: np.cos(x) + 1 / np.cosh(x), 0),
    ("clamped", "pinned"): (lambda x: np.sin(x) - np.cos(x) * np.tanh(x), 0),
    ("pinned", "free"): (lambda x: np.sin(x) - np.cos(x) * np.tanh(x), 1),
    ("clamped", "guided"): (lambda x: np.sin(x) + np.cos(x) * np.tanh(x), 0),
    ("guided", "free"): (lambda x: np.sin(x) + np.cos(x) * np.tanh(x), 1),
    ("pinned", "guided"): (np.cos, 0),
    ("guided", "guided"): (np.sin, 1),
    ("pinned", "pinned"): (np.sin, 0),
}


def roots(equation, count):
    """First positive roots of a frequency equation."""
    x = np.arange(0.5, 20.0, 0.05)
    values = equation(x)
    changes = np.flatnonzero(values[:-1] * values[1:] < 0)[:count]
    return np.array([brentq(equation, x[i], x[i + 1], xtol=1e-13) for i in changes])


@pytest.mark.parametrize("ends", CLASSICAL, ids="-".join)
def test_frequencies_with_other_ends(ends):
    """ω² = (EI β⁴ + k)/m on a Winkler foundation, whatever the ends; a rigid motion has √(k/m).

    A pinned beam with a free end swings on its foundation like a rigid one, a = x: also √(k/m).
    """
    equation, rigid = CLASSICAL[ends]
    beta = np.concatenate([np.zeros(rigid), roots(equation, 3) / LENGTH])
    exact = np.sqrt((BENDING * beta**4 + STIFFNESS) / MASS)
    errors = []
    for count in COUNTS:
        for order in (ends, ends[::-1]):
            found = natural(cut(mf.track(PAVEMENT, SOIL), count, order))[: beta.size]
            np.testing.assert_allclose(found[:rigid], exact[:rigid], rtol=1e-9)
            errors.append(found[rigid:] / exact[rigid:] - 1)
    # Either end first is the same beam.
    np.testing.assert_allclose(errors[::2], errors[1::2], atol=1e-10)
    errors = np.array(errors[::2])
    assert np.abs(errors[-1]).max() < 1e-5
    assert observed_order(LENGTH / np.array(COUNTS), errors[:, -1]) == pytest.approx(4.0, abs=ORDER)


def test_frequencies_of_a_rail_on_sleepers():
    """Roots of det [[EI κ⁴ + k₁ − m ω², −k₁], [−k₁, k₁ + k₂ − m_s ω²]] = 0 for the wave n of pinned rails."""
    n, pad, ballast, sleepers = 4, PAD.stiffness, BALLAST.stiffness, 250.0
    kappa = n * np.pi / LENGTH
    exact = np.sqrt(
        eigh([[6.42e6 * kappa**4 + pad, -pad], [-pad, pad + ballast]], np.diag([60.2, sleepers]), eigvals_only=True)
    )
    counts, errors = (32, 48, 64), []
    for count in counts:
        found = natural(cut(DAMPED["rail_pad_sleeper_ballast"], count))
        errors.append([np.abs(found / one - 1).min() for one in exact])
    assert np.max(errors[-1]) < 1e-6
    assert observed_order(1 / np.array(counts), np.array(errors)[:, 1]) == pytest.approx(4.0, abs=ORDER)


@pytest.mark.parametrize("name", ["euler_bernoulli_winkler", "euler_bernoulli_pasternak", "rail_two_masses"])
@pytest.mark.parametrize(
    ("share", "ahead", "order"),
    [(0.0, 0.0, 4), (0.0, 2.0, 4), (0.5, 0.0, 3), (0.25, 0.0, 3)],
    ids=["node", "other node", "mid-element", "quarter"],
)
def test_deflection_at_rest(name, share, ahead, order):
    """Against the closed form of the endless track: order 4 at nodes, 3 under a load between them.

    Within the element that is loaded the exact deflection has a jump in its third derivative, which no cubic has.
    Load and observer keep their place within an element.
    """
    track = DAMPED[name]
    scale = {"rail_two_masses": 0.5}.get(name, 1.0)
    sizes = scale * np.array([0.4, 0.2, 0.1, 0.05])
    errors = []
    for size in sizes:
        # 60 times the length over which it bends: the ends are out of sight.
        road = mf.finite_track(track, first=-24.0, last=24.0, element=size, ends="clamped", band=0.0)
        at = np.array([share * size, share * size + scale * ahead])
        force = road.rows(at[:1]).toarray()[0]
        found = road.rows(at[1:]) @ spsolve(road.stiffness, force)
        exact = track.moving_frf([at[1] - at[0]], 0.0, [0.0])[0, 0].real
        errors.append(abs(found[0] - exact) / track.moving_frf([0.0], 0.0, [0.0])[0, 0].real)
    assert errors[0] < (1e-3 if order == 3 else 3e-4)
    assert observed_order(sizes, errors) == pytest.approx(order, abs=ORDER)


def test_damping_is_that_of_the_wave():
    """Of the wave n of a pinned road: c + B κ⁴, and for the mass m, per metre."""
    road = cut(DAMPED["bending_damping"], 80)
    stations = np.arange(81) * LENGTH / 80
    kappa = 3 * np.pi / LENGTH
    # Deflection and slope at the nodes; the first and the last deflection are held.
    shape = np.stack([np.sin(kappa * stations), kappa * np.cos(kappa * stations)], axis=1).ravel()
    shape = np.delete(shape, [0, -2])
    modal = [shape @ (matrix @ shape) for matrix in (road.mass, road.damping, road.stiffness)]
    np.testing.assert_allclose(
        np.array(modal) / (0.5 * LENGTH),
        [MASS, DAMPING + 2.0e4 * kappa**4, BENDING * kappa**4 + STIFFNESS],
        rtol=1e-6,  # (κh)⁴/1440 of cubic interpolation, a few times 1e-7
    )


def test_interpolation_reproduces_cubics():
    """Deflection and slope at any place, the last one included; at rest outside what is held."""
    road = cut(DAMPED["euler_bernoulli_winkler"], 40, "free")
    cubic = np.polynomial.Polynomial([1.0, -0.3, 0.05, 0.004])
    nodes = np.linspace(0.0, LENGTH, 41)
    values = np.stack([cubic(nodes), cubic.deriv()(nodes)], axis=1).ravel()
    x = np.array([0.0, 0.1, 0.5, 7.77, 12.25, 19.99, LENGTH])
    np.testing.assert_allclose(road.rows(x) @ values, cubic(x), rtol=1e-13)
    np.testing.assert_allclose(road.rows(x, 1) @ values, cubic.deriv()(x), rtol=1e-12)
    pinned = cut(DAMPED["euler_bernoulli_winkler"], 40)
    assert pinned.dofs == road.dofs - 2
    assert pinned.rows(np.array([0.0, LENGTH])).toarray() == pytest.approx(0.0, abs=1e-15)
    np.testing.assert_allclose(pinned.rows(x, 1) @ np.delete(values, [0, -2]), road.rows(x, 1) @ np.r_[
        0.0, values[1:-2], 0.0, values[-1]
    ], rtol=1e-12)  # fmt: skip


def test_a_whole_number_of_elements_fills_the_stretch():
    """A span is as long as it was said to be; elements are a little shorter instead."""
    road = mf.finite_track(DAMPED["euler_bernoulli_winkler"], first=-3.0, last=7.1, element=0.5)
    assert road.interval == (-3.0, 7.1)
    assert road.spacing == pytest.approx(10.1 / 21)
    # A length that is a whole number of elements but for rounding gets no more of them.
    assert mf.finite_track(DAMPED["euler_bernoulli_winkler"], first=0.0, last=2.1, element=0.3).mesh.elements == 7


def test_weight_of_the_masses():
    """Moving everything down by one metre moves m + m_s per metre."""
    road = mf.finite_track(DAMPED["rail_pad_sleeper_ballast"], first=0.0, last=20.0, ends="free")
    down = np.tile([1.0, 1.0, 0.0, 0.0], 81)  # deflection of rail and sleepers, slope of rail and sleepers
    assert down @ (road.mass @ down) == pytest.approx(20.0 * (60.2 + 250.0), rel=1e-12)
    assert down @ (road.stiffness @ down) == pytest.approx(20.0 * BALLAST.stiffness, rel=1e-9)
    assert down @ (road.damping @ down) == pytest.approx(20.0 * BALLAST.damping, rel=1e-12)


def test_absorbing_ends_add_damping_that_begins_gently():
    """Outside the stretch nothing is added; it grows steadily to more than the critical damping 2√(km)."""
    track = DAMPED["euler_bernoulli_winkler"]
    ends = {"element": 0.25, "first": -30.0, "last": 30.0}
    plain, soft = (mf.finite_track(track, ends=kind, **ends) for kind in ("clamped", "absorbing"))
    added = (soft.damping - plain.damping).toarray()
    assert (soft.stiffness - plain.stiffness).nnz == 0 or abs(soft.stiffness - plain.stiffness).max() == 0.0
    positions = 0.25 * (np.arange(soft.dofs) // 2 + 1) - 30.0  # clamped: the first node has no unknowns
    assert np.abs(added[np.abs(positions) < 15.0]).max() < 1e-12 * soft.damping.max()
    # Per metre at the deflection of each node, from half a metre within the end on.
    along = added[::2, ::2].sum(axis=1)[1:] / 0.25
    critical = 2 * np.sqrt(STIFFNESS * MASS)
    assert critical < along[0] < 3 * critical
    assert (np.diff(along[:60]) < 1e-9 * critical).all()
    np.testing.assert_allclose(along[:60], along[::-1][1:61], rtol=1e-9, atol=1e-9 * critical)
    # Two metres into it there is a hundredth of that, by a quintic step; a straight line would give an eighth.
    assert along[51] < 0.03 * along[0]


def test_numbers_without_a_decimal_point_are_numbers():
    """Masses given as integers are the masses given as floats."""
    whole = mf.track(
        mf.EulerBernoulliBeam(bending_stiffness=6_420_000, mass=60), mf.OnMass(above=PAD, mass=250, below=BALLAST)
    )
    point = mf.track(
        mf.EulerBernoulliBeam(bending_stiffness=6.42e6, mass=60.0), mf.OnMass(above=PAD, mass=250.0, below=BALLAST)
    )
    first, second = (mf.finite_track(track, first=0.0, last=20.0) for track in (whole, point))
    for name in ("mass", "damping", "stiffness"):
        assert abs(getattr(first, name) - getattr(second, name)).max() == 0.0


def test_a_beam_of_whole_numbers():
    beam = mf.EulerBernoulliBeam(bending_stiffness=15_730_000, mass=712)
    road = mf.finite_track(mf.track(beam, SOIL), first=0, last=20, element=0.5, ends="pinned")
    assert natural(road)[0] == pytest.approx(np.sqrt((BENDING * (np.pi / 20) ** 4 + STIFFNESS) / 712.0), rel=1e-6)


def test_rails_have_no_band_limit_of_their_own_foundation():
    """Below its cut-on a track carries no wave: only bending under a load limits the element."""
    assert mf.finite_track(mf.track(RAIL, PAD), first=0.0, last=20.0, element=0.5, band=200.0).dofs > 0

"""A beam under axial force: Hetényi's basin, Kerr's critical speed, a wire without stiffness, buckling."""

from __future__ import annotations

import numpy as np
import pytest

import movingfrf as mf
from movingfrf.scenarios.reading import parse_scenario
from tests.helpers import PAVEMENT, RAIL, SOIL, TIMOSHENKO, written_on

BENDING, MASS, STIFFNESS = RAIL.bending_stiffness, RAIL.mass, 5.0e7
BED = mf.Spring(stiffness=STIFFNESS)
LIMIT = 2 * np.sqrt(STIFFNESS * BENDING)  # 3.6e7 N


def laid(force, foundation=BED, beam=RAIL):
    return mf.track(mf.TensionedBeam(beam=beam, force=force), foundation)


@pytest.mark.parametrize("share", [-0.9, -0.02, 0.0, 0.05, 0.9])
def test_basin_at_rest(share):
    """P e^{−αx} (β cos βx + α sin βx)/(4 EI αβ (α² + β²)), α², β² = √(k/4EI) ± N/4EI (Hetényi 1946, chapter 6)."""
    force = share * LIMIT
    half, add = np.sqrt(STIFFNESS / (4 * BENDING)), force / (4 * BENDING)
    alpha, beta = np.sqrt(half + add), np.sqrt(half - add)
    x = np.linspace(-8.0, 8.0, 161)
    z = np.abs(x)
    expected = np.exp(-alpha * z) * (beta * np.cos(beta * z) + alpha * np.sin(beta * z))
    expected /= 4 * BENDING * alpha * beta * (alpha**2 + beta**2)
    found = laid(force).moving_frf(x, 0.0, [0.0])[0]
    assert np.abs(found - expected).max() < 1e-11 * expected.max()


@pytest.mark.parametrize("share", [-0.99, -0.02, 0.0, 0.05, 3.0])
def test_critical_speed(share):
    """√((2 √(k EI) + N)/m): Kerr 1972."""
    expected = np.sqrt((1 + share) * LIMIT / MASS)
    assert laid(share * LIMIT).critical_speed == pytest.approx(expected, rel=1e-9)


def on_mass(damping):
    above, below = (mf.Spring(stiffness=stiffness, damping=damping) for stiffness in (2 * STIFFNESS, STIFFNESS))
    return mf.OnMass(above=above, mass=250.0, below=below)


UNDER = on_mass(5.0e4)


@pytest.mark.parametrize("left", [0.01, 1e-3, 1e-4])
def test_critical_speed_about_to_buckle_on_a_mass(left):
    """√((2 √(k EI) + N)/M) again: so slow a wave moves the mass by 2/3 of the rail, k = 2/3 of the spring below."""
    limit = LIMIT * np.sqrt(2 / 3)
    expected = np.sqrt(left * limit / (MASS + UNDER.mass * (2 / 3) ** 2))
    assert laid(-(1 - left) * limit, UNDER).critical_speed == pytest.approx(expected, rel=2 * left)


def test_compression_alone_makes_damping_give_way():
    """At 0.9 of the buckling force a moving load deflects the track most; under strong damping one at rest."""
    limit = LIMIT * np.sqrt(2 / 3)
    slowest = np.sqrt(0.1 * limit / (MASS + UNDER.mass * (2 / 3) ** 2))
    assert laid(-0.9 * limit, UNDER).critical_speed < 0.9 * slowest
    stiff = on_mass(5.0e6)
    for beam in (RAIL, TIMOSHENKO):
        assert laid(0.0, stiff, beam).critical_speed == mf.track(beam, stiff).critical_speed == np.inf
        assert laid(1e5, stiff, beam).critical_speed == np.inf
        assert np.isfinite(laid(-1e5, stiff, beam).critical_speed)


def test_without_bending_stiffness_it_is_a_string():
    """Of the page on guideways, in closed form; stiffness of 1e-3 N m² changes the wire by (EI k)^½/T = 2e-5."""
    wire = {"mass": 1.35, "stiffness": 200.0, "damping": 20.0}
    string = written_on("guideways")["TautString"](tension=2.0e4, **wire)
    thin = mf.EulerBernoulliBeam(bending_stiffness=1e-3, mass=wire["mass"])
    beam = laid(2.0e4, mf.Spring(stiffness=wire["stiffness"], damping=wire["damping"]), thin)
    assert beam.critical_speed == pytest.approx(string.critical_speed, rel=1e-4)
    x, omega = [0.0, 3.0, -3.0, 20.0], np.array([0.0, 5.0, 40.0])
    for speed in (0.0, 60.0):
        one, other = (road.moving_frf(x, speed, omega) for road in (beam, string))
        assert np.abs(one - other).max() < 3e-4 * np.abs(other).max()


def test_too_much_compression_buckles():
    laid(-(1 - 1e-9) * LIMIT)
    length = f"{2 * np.pi * (BENDING / STIFFNESS) ** 0.25:.3g}"
    with pytest.raises(ValueError, match=rf"beam must stay straight .* buckles in waves of {length} m"):
        laid(-(1 + 1e-9) * LIMIT)
    # Far beyond, the softest wave is the one of EI κ⁴ − N κ² + k at its least: κ² = N/2EI.
    length = f"{2 * np.pi * np.sqrt(2 * BENDING / (9 * LIMIT)):.3g}"
    with pytest.raises(ValueError, match=rf"buckles in waves of {length} m"):
        laid(-9 * LIMIT)


def test_any_beam_and_any_foundation():
    """Tension is a shear layer that hangs on the beam, whatever the beam: N κ² is G_p κ²."""
    for beam in (PAVEMENT, TIMOSHENKO):
        sheared = mf.track(beam, mf.ShearLayer(stiffness=8.0e6, damping=3.0e4, shear_stiffness=2.0e6))
        one, other = (road.moving_frf([0.0, 2.0], 30.0, [3.0, 90.0]) for road in (laid(2.0e6, SOIL, beam), sheared))
        np.testing.assert_allclose(one, other, rtol=1e-12)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"beam": "rail", "force": 0.0}, "beam must be a beam, got 'rail'"),
        ({"beam": RAIL, "force": np.inf}, "force must be a finite number, got inf N"),
    ],
)
def test_refused(given, message):
    with pytest.raises(ValueError, match=message):
        mf.TensionedBeam(**given)


def test_in_a_scenario():
    text = """
[guideway.beam]
kind = "tensioned_beam"
force = -7.5e5
[guideway.beam.beam]
kind = "euler_bernoulli_beam"
bending_stiffness = 6.42e6
mass = 60.2
[guideway.foundation]
kind = "spring"
stiffness = 5.0e7
[loads]
positions = [0.0]
[[loads.force]]
kind = "constant"
force = 1e5
[run]
speed = 30.0
duration = 1.0
"""
    assert parse_scenario(text).guideway == laid(-7.5e5)

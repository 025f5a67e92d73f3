"""Undamped tracks close to a cut-off frequency or a critical speed: right, or refused; against fifty digits."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

import movingfrf as mf
from tests import precise

ROAD = mf.EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9)
DEEP = mf.TimoshenkoBeam(bending_stiffness=1.573e7, mass=711.9, shear_stiffness=4.0e8, rotary_inertia=5.5)
RAIL = mf.EulerBernoulliBeam(bending_stiffness=6.42e6, mass=60.2)
WIRE = mf.EulerBernoulliBeam(bending_stiffness=150.0, mass=1.35)
PAD, BALLAST = mf.Spring(stiffness=3.0e8), mf.Spring(stiffness=1.0e8)
SHEARED = mf.ShearLayer(stiffness=5.0e7, shear_stiffness=1.0e6)

TRACKS = {
    "winkler": mf.track(ROAD, mf.Spring(stiffness=8.0e6)),
    "pasternak": mf.track(ROAD, mf.ShearLayer(stiffness=8.0e6, shear_stiffness=2.0e6)),
    "timoshenko": mf.track(DEEP, mf.Spring(stiffness=8.0e6)),
    "compressed": mf.track(mf.TensionedBeam(beam=RAIL, force=-7.5e5), mf.Spring(stiffness=5.0e7)),
    "wire": mf.track(mf.TensionedBeam(beam=WIRE, force=2.0e4), mf.Spring(stiffness=100.0)),
    "sleepers": mf.track(RAIL, mf.OnMass(above=PAD, mass=250.0, below=BALLAST)),
    "two layers": mf.track(
        RAIL, mf.OnMass(above=PAD, mass=250.0, below=mf.OnMass(above=BALLAST, mass=1000.0, below=SHEARED))
    ),
}
PLACES = [-3.0, -0.5, 0.0, 0.5, 3.0]
# What is let through may be off by the inverse of the rounding errors that would be refused, ROOTS.rounding_errors.
ALLOWED = 2e-4


def squares(track, kappa):
    """Ω² of all branches, ascending."""
    table = track.stiffness().above[::2, ::2]
    return np.sort(-np.roots((kappa * kappa) ** np.arange(table.shape[0]) @ table[:, ::-1]).real)


def cut_off(track, speed, branch=0):
    """Least frequency in the moving frame at which a branch has waves, [rad/s] to rounding: ω = Ω + κv."""

    def frequency(kappa):
        return float(np.sqrt(squares(track, kappa)[branch])) + kappa * speed

    static = track.stiffness().above[:, 0]
    last = np.flatnonzero(static)[-1]
    size = (static[0] / static[last]) ** (1 / last)
    among = -np.sign(speed) * size * np.r_[0.0, np.geomspace(1e-4, 10.0, 500)]
    least = int(np.argmin([frequency(kappa) for kappa in among]))
    if least == among.size - 1:
        return 0.0
    bounds = sorted((among[max(least - 1, 0)], among[min(least + 1, among.size - 1)]))
    found = minimize_scalar(frequency, bounds=bounds, method="bounded", options={"xatol": 1e-9 * size})
    return min(frequency(found.x), frequency(among[least]))


def check(track, speed, omega):
    """Whether there is an answer; if there is, it must be right."""
    try:
        found = track.moving_frf(PLACES, speed, [omega])[0]
    except mf.SolveError:
        return False
    exact = precise.moving_frf(track.stiffness(), PLACES, speed, omega)
    assert np.abs(found - exact).max() < ALLOWED * np.abs(exact).max(), (speed, omega, found, exact)
    return True


NEAR = (1, 3, 5, 7, 9, 10, 11, 12, 13, 14, 15)


@pytest.mark.parametrize("speed", [0.0, 1e-3, 10.0, 60.0, 150.0])
@pytest.mark.parametrize("name", list(TRACKS))
def test_near_a_cut_off_frequency(name, speed):
    """(1 ± 10⁻ᵏ) ω_cut, on both sides of the double root: a conjugate pair has one root on each side."""
    track = TRACKS[name]
    omega = cut_off(track, speed)
    if not omega > 0:
        pytest.skip("short waves are slower than the moving frame")
    there = {
        power: check(track, speed, omega * (1 + side * 10.0**-power)) for power in NEAR for side in (-1.0, 1.0)
    }
    # As near as 10⁻¹⁰ there is an answer; and at least 10⁻¹⁴ is too near for floating point.
    assert all(there[power] for power in NEAR if power <= 10)
    assert not any(there[power] for power in NEAR if power >= 14)


@pytest.mark.parametrize("name", ["timoshenko", "sleepers"])
def test_near_a_higher_cut_off_frequency(name):
    """Sleepers between pad and ballast, the shear of the beam."""
    for speed in (0.0, 1e-3, 10.0):
        omega = cut_off(TRACKS[name], speed, branch=1)
        for power in NEAR:
            for side in (-1.0, 1.0):
                check(TRACKS[name], speed, omega * (1 + side * 10.0**-power))


def test_waves_that_hardly_travel():
    """At 1 mm/s waves in the sleepers, all at nearly one frequency, meet at −38.9 rad/m and 1264.8624841654 rad/s.

    Their roots are known to five digits at first, beside one of 2.5e6 rad/m.
    """
    for power in NEAR[:8]:
        for side in (-1.0, 1.0):
            check(TRACKS["sleepers"], 1e-3, 1264.8624841653847 * (1 + side * 10.0**-power))


@pytest.mark.parametrize("name", ["winkler", "pasternak", "timoshenko", "compressed", "wire"])
def test_near_a_critical_speed(name):
    """A steady load at (1 ± 10⁻ᵏ) of the critical speed."""
    track = TRACKS[name]
    there = {
        power: check(track, track.critical_speed * (1 + side * 10.0**-power), 0.0)
        for power in NEAR
        for side in (-1.0, 1.0)
    }
    assert all(there[power] for power in NEAR if power <= 9)
    assert not any(there[power] for power in NEAR if power >= 14)


def test_the_case_that_was_wrong():
    """Reference road without damping, 10⁻¹⁰ below cut-off at 10 m/s: 4.5e-3 m/N, once 5.5e-8."""
    track = TRACKS["winkler"]
    found = track.moving_frf([0.0], 10.0, [cut_off(track, 10.0) * (1 - 1e-10)])[0, 0]
    assert abs(found) == pytest.approx(4.5e-3, rel=0.02)

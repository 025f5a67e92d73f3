"""Critical speeds over many decades of stiffness, against closed forms and a search of one's own."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

import movingfrf as mf


@pytest.mark.parametrize(
    ("bending", "mass", "shear", "inertia", "stiffness", "layer"),
    [
        # Soft in shear, so that longer waves travel faster: no dip, the front of the shear waves √((S + G)/m).
        (9.0e8, 6248.0, 1.38e6, 115.3, 1.18e8, 364.0),
        (3.1e8, 6.27, 4.07e6, 1.6e-4, 1.27e8, 1.3e4),
        (9.0e8, 18.4, 4.4e3, 0.0, 4.2e9, None),
        # A heavy rotation: the front of the bending waves √(E/ρ) is slower.
        (2660.0, 713.0, 3.26e7, 3370.0, 8.42e9, 9.13e5),
    ],
)
def test_shorter_waves_are_ever_slower(bending, mass, shear, inertia, stiffness, layer):
    """Then it is the least of the wave fronts, taken in the limit."""
    beam = mf.TimoshenkoBeam(bending_stiffness=bending, mass=mass, shear_stiffness=shear, rotary_inertia=inertia)
    foundation = (
        mf.Spring(stiffness=stiffness)
        if layer is None
        else mf.ShearLayer(stiffness=stiffness, shear_stiffness=layer)
    )
    fronts = [np.sqrt((shear + (layer or 0.0)) / mass), np.sqrt(bending / inertia) if inertia else np.inf]
    assert mf.track(beam, foundation).critical_speed == pytest.approx(min(fronts), rel=1e-9)


@pytest.mark.parametrize("bending", [1e-12, 1e-3, 1.573e7, 1e15])
@pytest.mark.parametrize("layer", [1e-9, 2.0e6, 1e12])
def test_a_beam_on_a_shear_layer_at_any_scale(bending, layer):
    """v² = (G + 2 √(kEI))/m, whatever outweighs what."""
    beam = mf.EulerBernoulliBeam(bending_stiffness=bending, mass=711.9)
    track = mf.track(beam, mf.ShearLayer(stiffness=8.0e6, shear_stiffness=layer))
    exact = np.sqrt((layer + 2 * np.sqrt(8.0e6 * bending)) / 711.9)
    assert track.critical_speed == pytest.approx(exact, rel=1e-9)


def timoshenko_minimum(bending, mass, shear, inertia, stiffness, layer):
    """Least phase velocity over 34 decades of wavenumbers, from the equations of motion."""

    def squared(logarithm):
        kappa2 = 10.0 ** (2 * logarithm)
        # m ρI c⁴ − (ρI a + m b) c² + a b − S² = 0 per κ², a the stiffness to deflection, b that to rotation; what
        # cancels in a b − S² has been taken out on paper.
        a, b = shear + layer + stiffness / kappa2, bending + shear / kappa2
        half = inertia * a + mass * b
        product = bending * a + shear / kappa2 * (layer + stiffness / kappa2)
        return 2 * product / (half + np.sqrt(np.maximum(half**2 - 4 * mass * inertia * product, 0.0)))

    among = np.linspace(-14.0, 20.0, 6801)
    values = squared(among)
    least = int(np.clip(values.argmin(), 1, among.size - 2))
    found = minimize_scalar(squared, bounds=(among[least - 1], among[least + 1]), method="bounded")
    return np.sqrt(min(found.fun, values.min()))


@pytest.mark.parametrize("seed", range(4))
def test_drawn_timoshenko_beams(seed):
    """Each value over many decades: dips at any wavelength, dips so shallow that they are none, fronts."""
    rng = np.random.default_rng(seed)
    for _ in range(60):
        bending, mass, shear, inertia, stiffness, layer = 10.0 ** rng.uniform(
            [0, 0, 2, -4, 1, -2], [9, 4, 11, 4, 10, 9]
        )
        beam = mf.TimoshenkoBeam(
            bending_stiffness=bending, mass=mass, shear_stiffness=shear, rotary_inertia=inertia
        )
        found = mf.track(beam, mf.ShearLayer(stiffness=stiffness, shear_stiffness=layer)).critical_speed
        exact = timoshenko_minimum(bending, mass, shear, inertia, stiffness, layer)
        assert found == pytest.approx(exact, rel=1e-6), (bending, mass, shear, inertia, stiffness, layer)


RAIL = mf.EulerBernoulliBeam(bending_stiffness=6.42e6, mass=60.2)
PAD = mf.Spring(stiffness=3.0e8, damping=3.0e4)
BALLAST = {"stiffness": 1.0e8, "damping": 8.0e4}


@pytest.mark.parametrize("layer", [1e-9, 1.0, 1e3])
def test_ballast_that_hardly_shears(layer):
    """Short waves in the sleepers travel at √(G/m) then; the rail deflects most where it does without."""
    sleepers, sheared = (
        mf.track(RAIL, mf.OnMass(above=PAD, mass=250.0, below=below))
        for below in (mf.Spring(**BALLAST), mf.ShearLayer(**BALLAST, shear_stiffness=layer))
    )
    assert sheared.critical_speed == pytest.approx(sleepers.critical_speed, rel=1e-9 + 2e-8 * layer)


def test_ballast_that_shears():
    """The speed of the greatest steady deflection, by a search of one's own."""
    track = mf.track(RAIL, mf.OnMass(above=PAD, mass=250.0, below=mf.ShearLayer(**BALLAST, shear_stiffness=1e6)))
    x = np.linspace(-1.0, 0.0, 20_001)

    def greatest(speed):
        return track.moving_frf(x, speed, [0.0])[0].real.max()

    speeds = np.linspace(10.0, 700.0, 70)
    best = speeds[np.argmax([greatest(speed) for speed in speeds])]
    found = minimize_scalar(lambda speed: -greatest(speed), bounds=(best - 10, best + 10), method="bounded")
    assert track.critical_speed == pytest.approx(found.x, rel=1e-5)

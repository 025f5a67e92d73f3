"""A foundation that relaxes: its limits, and the point receptance at rest in closed form."""

import numpy as np
import pytest

import movingfrf as mf
from movingfrf.scenarios.reading import parse_scenario
from tests.helpers import RAIL

LASTING, RELAXING, DAMPING = 1.0e8, 2.0e8, 5.0e5
PAD = mf.RelaxingSpring(stiffness=LASTING, relaxing_stiffness=RELAXING, damping=DAMPING)
OMEGA = 2 * np.pi * np.geomspace(0.01, 2000.0, 40)


def test_receptance_at_rest():
    """1/(2√2 EI q³) with q⁴ = (K(iω) − mω²)/EI (METHOD.md section 9), K of the three parts written out."""
    stiffness = LASTING + RELAXING * 1j * OMEGA * DAMPING / (RELAXING + 1j * OMEGA * DAMPING)
    q4 = (stiffness - RAIL.mass * OMEGA**2) / RAIL.bending_stiffness
    expected = 1 / (2 * np.sqrt(2) * RAIL.bending_stiffness * q4**0.75)
    found = mf.track(RAIL, PAD).moving_frf(0.0, 0.0, OMEGA)
    assert np.abs(found / expected - 1).max() < 1e-9


@pytest.mark.parametrize(("damping", "left"), [(1e-3, LASTING), (1e12, LASTING + RELAXING)])
def test_a_dashpot_that_gives_way_at_once_or_never(damping, left):
    pad = mf.RelaxingSpring(stiffness=LASTING, relaxing_stiffness=RELAXING, damping=damping)
    spring = mf.Spring(stiffness=left, damping=1e-6)
    found, expected = (mf.track(RAIL, one).moving_frf([0.0, 2.0, -2.0], 30.0, OMEGA[5:]) for one in (pad, spring))
    assert np.abs(found - expected).max() < 1e-4 * np.abs(expected).max()


def test_its_waves_without_losses_are_those_of_what_lasts():
    spring = mf.track(RAIL, mf.Spring(stiffness=LASTING))
    assert mf.track(RAIL, PAD).critical_speed == pytest.approx(spring.critical_speed, rel=1e-12)


def test_finite_elements_do_not_know_it():
    with pytest.raises(mf.ParameterError, match="must stand on a Spring, ShearLayer or OnMass"):
        mf.finite_track(mf.track(RAIL, PAD), first=0.0, last=20.0, element=0.5)


def test_in_a_scenario_between_rail_and_sleepers():
    text = """
[guideway.beam]
kind = "euler_bernoulli_beam"
bending_stiffness = 6.42e6
mass = 60.2
[guideway.foundation]
kind = "on_mass"
mass = 250.0
[guideway.foundation.above]
kind = "relaxing_spring"
stiffness = 1.0e8
relaxing_stiffness = 2.0e8
damping = 5.0e5
[guideway.foundation.below]
kind = "spring"
stiffness = 1.0e8
damping = 8.0e4
[loads]
positions = [0.0]
[[loads.force]]
kind = "constant"
force = 1.0
[run]
speed = 20.0
duration = 1.0
"""
    below = mf.Spring(stiffness=1.0e8, damping=8.0e4)
    assert parse_scenario(text).guideway == mf.track(RAIL, mf.OnMass(above=PAD, mass=250.0, below=below))

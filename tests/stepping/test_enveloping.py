"""Cams and footprints in the time domain: `cdfm`, `sim` and `duhamel` see what `simulate` sees."""

from dataclasses import replace

import numpy as np
import pytest

import movingfrf as mf
from movingfrf.stepping.impulse import struck_track
from tests.helpers import DAMPED, VEHICLES

ROAD = DAMPED["euler_bernoulli_winkler"]


def relative(found, wanted):
    return float(np.linalg.norm(found - wanted) / np.linalg.norm(wanted))


def touching(**changes):
    truck = VEHICLES["quarter_truck"]
    return replace(truck, contacts=[replace(truck.contacts[0], **changes)])


def by_step(name, road, *parts, **travel):
    method = {"cdfm": mf.cdfm, "sim": mf.sim}[name]
    return method(road, *parts, **travel, superposed=True)


@pytest.mark.parametrize("name", ["cdfm", "sim"])
@pytest.mark.parametrize("changes", [{"cams": 0.6}, {"cams": 0.5, "footprint": 0.2}])
def test_cams_over_a_short_hump(name, changes):
    truck = touching(**changes)
    hump = mf.bump(height=0.02, width=0.8, at=5.0, length=30.0)
    travel = {"speed": 10.0, "duration": 2.0, "time_step": 5e-4, "blend": 0.0}
    wanted = mf.simulate(ROAD, truck, hump, **travel)
    finite = mf.finite_track(ROAD, first=-25.0, last=45.0, element=0.25)
    found = by_step(name, finite, truck, hump, **travel)
    assert relative(found.contact_force.values, wanted.contact_force.values) < 5e-4
    np.testing.assert_array_equal(found.roughness.values, wanted.roughness.values)
    plain = mf.simulate(ROAD, touching(), hump, **travel)
    assert relative(plain.contact_force.values, wanted.contact_force.values) > 0.5


@pytest.mark.filterwarnings("ignore:a footprint or a cam reaches")
def test_a_footprint_up_to_the_last_sample():
    """On a rough road that ends where the journey ends, a footprint reaches beyond; both see the same there."""
    truck = touching(footprint=0.35)
    surface = mf.realise(mf.IsoRoad.of_class("A", band=(0.01, 2.0)), length=21.0, seed=1)
    travel = {"speed": 7.0, "duration": 3.0, "time_step": 5e-4}
    wanted = mf.simulate(ROAD, truck, surface, **travel)
    finite = mf.finite_track(ROAD, first=-25.0, last=45.0, element=0.25)
    found = mf.cdfm(finite, truck, surface, **travel, superposed=True)
    force = wanted.contact_force.values
    apart = np.abs(found.contact_force.values - force) / np.abs(force).max()
    assert apart[-60:].max() < 3e-4
    assert apart.max() < 1e-3


def test_duhamel_sees_cams_too():
    truck = touching(cams=0.6, footprint=0.1)
    hump = mf.bump(height=0.02, width=0.8, at=5.0, length=30.0)
    travel = {"speed": 10.0, "duration": 1.5, "blend": 0.0}
    struck = struck_track(ROAD, speed=10.0, offsets=[0.0])
    found = mf.duhamel(struck, truck, hump, **travel, time_step=1e-3)
    wanted = mf.simulate(ROAD, truck, hump, **travel, time_step=1e-3)
    assert relative(found.contact_force.values, wanted.contact_force.values) < 5e-3

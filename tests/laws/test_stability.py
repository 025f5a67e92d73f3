"""Stability of vehicles with many contacts, where the phase of the determinant turns fast."""

import numpy as np
import pytest

import movingfrf as mf
from movingfrf.response.stability import along_the_axis, growing_vibrations
from movingfrf.response.system import System
from tests.helpers import DAMPED, QUARTER_TRUCK

LIVELY = mf.track(
    mf.EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9), mf.Spring(stiffness=8e6, damping=3e3)
)
SLACK = QUARTER_TRUCK | {"suspension_stiffness": 1.5e6, "suspension_damping": 3e3, "tyre_damping": 0.0}


def count(road, vehicle, speed):
    system = System(guideway=road, vehicle=vehicle, speed=speed)
    return growing_vibrations(system, [system.at(along_the_axis(vehicle, speed))])


def wheels(number, gap, damping):
    """Bare wheels in a row: as many identical resonances, next to the axis if the damping is small."""
    return mf.Vehicle(
        mass=1000.0 * np.eye(number),
        damping=np.zeros((number, number)),
        stiffness=np.zeros((number, number)),
        contact_map=np.eye(number),
        contacts=[mf.Contact(position=-gap * n, stiffness=3e6, damping=damping) for n in range(number)],
        vertical=np.ones(number),
        dof_names=[f"wheel_{n}" for n in range(number)],
    )


def convoy(number, gap):
    """Quarter trucks that do not know of each other."""
    one, each = mf.quarter_car(**SLACK), np.eye(number)
    return mf.Vehicle(
        mass=np.kron(each, one.mass),
        damping=np.kron(each, one.damping),
        stiffness=np.kron(each, one.stiffness),
        contact_map=np.kron(each, one.contact_map),
        contacts=[
            mf.Contact(position=-gap * n, stiffness=SLACK["tyre_stiffness"], damping=0.0) for n in range(number)
        ],
        vertical=np.ones(2 * number),
        dof_names=[f"{name}_{n}" for n in range(number) for name in one.dof_names],
    )


@pytest.mark.parametrize(("number", "gap", "damping"), [(6, 1.8, 1e3), (12, 2.5, 10.0), (6, 1.8, 0.1), (1, 0, 0.0)])
@pytest.mark.parametrize("speed", [10.0, 60.0])
def test_rows_of_wheels_are_stable_below_the_critical_speed(number, gap, damping, speed):
    """Below it a load loses energy to the road at every frequency; identical resonances must not add up."""
    assert count(DAMPED["euler_bernoulli_winkler"], wheels(number, gap, damping), speed) == 0


@pytest.mark.parametrize("speed", [185.0, 195.0, 205.0, 230.0, 250.0])
def test_vehicles_far_apart_are_unstable_one_by_one(speed):
    """At 300 m the road transmits nothing, so that n vehicles have n times the growing vibrations of one."""
    one = count(LIVELY, convoy(1, 0.0), speed)
    assert [count(LIVELY, convoy(number, 300.0), speed) for number in (2, 3, 4)] == [2 * one, 3 * one, 4 * one]


def test_some_of_these_are_unstable():
    assert count(LIVELY, convoy(1, 0.0), 195.0) == 2

"""Answers are computed on one BLAS thread, whatever the environment says: a second one costs and gains nothing."""

from __future__ import annotations

import numpy as np
import pytest
from threadpoolctl import threadpool_info, threadpool_limits

import movingfrf as mf

ROAD = mf.track(mf.EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9), mf.Spring(stiffness=8e6, damping=3e4))
TRUCK = mf.catalogue(name="half_truck")
SPECTRUM = mf.IsoRoad.of_class("A", band=(0.05, 3.0))


class Watching:
    """A guideway that notes on how many threads it is asked."""

    def __init__(self):
        self.threads = set()

    def moving_frf(self, ahead, speed, omega, derivative=0):
        self.threads |= {pool["num_threads"] for pool in threadpool_info() if pool["user_api"] == "blas"}
        return ROAD.moving_frf(ahead, speed, omega, derivative=derivative)

    critical_speed = ROAD.critical_speed


def simulate(road):
    return mf.simulate(road, TRUCK, mf.realise(SPECTRUM, length=60.0, start=-5.0), speed=10.0, duration=4.0)


def moving_loads(road):
    return mf.moving_loads(road, np.ones((300, 2)), [0.0, -4.0], speed=10.0, time_step=2e-3)


def transfer(road):
    return mf.transfer(road, TRUCK, speed=10.0, frequency=np.linspace(0.1, 30.0, 50))


def random_response(road):
    return mf.random_response(road, TRUCK, SPECTRUM, speed=10.0)


@pytest.mark.parametrize("answer", [simulate, moving_loads, transfer, random_response])
def test_an_answer_takes_one_thread_and_leaves_the_others_to_the_user(answer):
    road = Watching()
    with threadpool_limits(limits=2, user_api="blas"):
        before = threadpool_info()
        answer(road)
        assert road.threads == {1}
        assert threadpool_info() == before

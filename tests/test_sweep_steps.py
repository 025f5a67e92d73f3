"""In what steps the cases of a sweep are observed unless they are stated, and what that changes."""

from __future__ import annotations

import numpy as np
import pytest

import movingfrf as mf
from movingfrf.metrics.measures import usual
from tests.sweep_parts import FILE, scenario_in


@pytest.fixture(scope="module")
def truck(tmp_path_factory):
    """Drive for 20 s, on a road that is long enough at 20 m/s."""
    folder = tmp_path_factory.mktemp("steps")
    file = scenario_in(folder)
    file.write_text(file.read_text().replace("duration = 1.0", "duration = 20.0"))
    mf.write_profile(mf.realise(mf.IsoRoad.of_class("B"), length=450.0, start=-20.0, seed=5), folder / "road.csv")
    return file


def test_the_measures_are_those_of_fine_steps(truck):
    """A quarter of a millisecond shows everything."""
    axes = {"run.speed": [8.0, 20.0], "roughness": [FILE]}
    found, fine = (mf.sweep(truck, axes, time_step=step) for step in (None, 2.5e-4))
    # Steps are as much shorter as the speed is higher; the road's shortest waves are 1/6 m long.
    steps = found.time_step.values.ravel()
    assert 1.9 < steps[0] / steps[1] < 3.2
    assert 0.1 < steps[1] * 20.0 * 6.0 < 0.4
    for name in usual():
        if "static" not in name:
            np.testing.assert_allclose(found[name], fine[name], rtol=2e-3, err_msg=name)


def test_a_step_that_is_stated_or_varies_is_taken(truck):
    stated = mf.sweep(truck, {"vehicle.footprint": [0.0, 0.2]}, time_step=2e-3)
    assert (stated.time_step == 2e-3).all()
    varied = mf.sweep(truck, {"run.time_step": [1e-3, 2e-3], "vehicle.footprint": [0.0]}, measures="static_load")
    assert varied.time_step.dims == ("time_step",)
    assert varied.time_step.values.tolist() == [1e-3, 2e-3]
    random = mf.sweep(truck, {"run.speed": [8.0]}, response="random")
    assert "time_step" not in random


@pytest.mark.parametrize("road", ["uneven", "coarse"])
def test_the_scenario_s_step_where_the_road_does_not_tell(road, tmp_path):
    truck = scenario_in(tmp_path)
    profile = mf.realise(mf.IsoRoad.of_class("B"), length=60.0, start=-20.0, seed=5)
    if road == "uneven":
        stations = profile.stations + 0.3 * np.diff(profile.stations[:2]) * np.sin(np.arange(profile.stations.size))
        profile = mf.Profile(stations, np.asarray(profile.elevation))
    else:
        # As rough from station to station as it can be.
        profile = mf.Profile(np.arange(-20.0, 40.0, 0.1), 1e-3 * np.random.default_rng(0).normal(size=600))
    mf.write_profile(profile, tmp_path / "road.csv")
    found = mf.sweep(truck, {"roughness": [FILE]}, measures="contact_force_rms")
    assert found.time_step.values.tolist() == [1e-3]


def test_waves_that_only_the_forces_have(tmp_path):
    """Ripples too low for the elevation, and not for the contact forces, are measured nevertheless."""
    truck = scenario_in(tmp_path)
    truck.write_text(truck.read_text().replace("duration = 1.0", "duration = 20.0"))
    stations = np.arange(-20.0, 240.0, 0.003)
    long, ripples = (np.sin(2 * np.pi * stations / length) for length in (50.0, 0.009))
    mf.write_profile(mf.Profile(stations, 20e-3 * long + 1e-5 * ripples), tmp_path / "road.csv")
    found, fine = (mf.sweep(truck, {"roughness": [FILE]}, time_step=step) for step in (None, 1e-4))
    # They come at 1111 Hz: a record in these steps alone would be a twentieth off in its peaks.
    assert found.time_step.item() > 3e-4
    for name in ("acceleration_rms", "acceleration_peak", "contact_force_rms"):
        np.testing.assert_allclose(found[name], fine[name], rtol=0.01, err_msg=name)

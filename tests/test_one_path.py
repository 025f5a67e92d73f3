"""A profile that is known along one path under wheels that are side by side: said wherever it is driven over."""

from __future__ import annotations

import json
import warnings

import numpy as np
import pytest

import movingfrf as mf
from movingfrf.commands.main import main
from movingfrf.scenarios.description import described
from movingfrf.scenarios.reading import parse_scenario
from tests.helpers import DAMPED, VEHICLES
from tests.test_roads import CAR

ROUGH = mf.realise(mf.IsoRoad.of_class("B", band=(0.05, 2.0)), length=40.0, start=-8.0)
HUMP = mf.bump(height=0.01, width=1.0, at=3.0, length=40.0, start=-8.0)
MEASURED = mf.Profile(np.linspace(-8.0, 32.0, 401), 1e-3 * np.sin(np.linspace(0.0, 60.0, 401)), source="road.csv")
SEVERAL, SINGLE = mf.catalogue(name="passenger_car"), VEHICLES["half_truck"]
SAMPLED = mf.SampledGuideway(
    response=np.exp(-np.arange(200.0) / 20)[:, None] * [[1e-7, 1e-8, 1e-8]],
    time_step=1e-3,
    offsets=[0.0, *(np.ptp(SINGLE.positions) * np.array([1.0, -1.0]))],
    speed=10.0,
)
FINITE = mf.finite_track(DAMPED["euler_bernoulli_winkler"], first=-20.0, last=30.0, element=0.5)


def codes(method, guideway, vehicle, profile, **more):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", mf.ValidityWarning)
        result = method(guideway, vehicle, profile, speed=10.0, duration=0.5, **more)
    return [finding["code"] for finding in json.loads(result.attrs["findings"])]


@pytest.mark.parametrize(
    ("vehicle", "profile", "said"),
    [
        (SEVERAL, ROUGH, True),
        (SEVERAL, MEASURED, True),
        (SEVERAL, mf.superposed(ROUGH, HUMP), True),
        (SEVERAL, mf.rolled(ROUGH, radius=0.3), True),
        (mf.on_paths(SEVERAL, [0, 0, 0, 0]), ROUGH, True),  # one path by number, but side by side
        (mf.on_paths(SINGLE, [0, 1]), ROUGH, True),  # one line of wheels, but two paths
        (SEVERAL, HUMP, False),
        (SEVERAL, mf.superposed(HUMP, HUMP), False),
        (SEVERAL, mf.rolled(HUMP, radius=0.3), False),
        (SEVERAL, mf.side_by_side(ROUGH, ROUGH), False),
        (SEVERAL, mf.Profile(ROUGH.distance, 0 * ROUGH.elevation + 7.0), False),  # level
        (SINGLE, ROUGH, False),
    ],
)
def test_what_is_known_along_one_path(vehicle, profile, said):
    """And not what is meant for the whole width, has columns, or has nothing that could differ."""
    assert ("one_path" in codes(mf.simulate, mf.RigidGuideway(), vehicle, profile)) == said


def test_it_is_what_keeps_a_car_from_rolling():
    with pytest.warns(
        mf.ValidityWarning, match="contacts travel on 2 side by side.*alike on both sides does not roll"
    ):
        result = mf.simulate(mf.RigidGuideway(), SEVERAL, ROUGH, speed=10.0, duration=1.0)
    rolled = float(np.abs(result.motion.sel(dof="roll")).max())  # a little: its left wheels are farther out
    paths = mf.realise(mf.IsoRoad.of_class("B", band=(0.05, 2.0)), length=40.0, start=-8.0, across=[0.7, -0.7])
    result = mf.simulate(mf.RigidGuideway(), SEVERAL, paths, speed=10.0, duration=1.0)
    assert np.abs(result.motion.sel(dof="roll")).max() > 10 * rolled


@pytest.mark.parametrize(("method", "guideway"), [(mf.cdfm, FINITE), (mf.sim, FINITE), (mf.duhamel, SAMPLED)])
def test_through_time_as_well(method, guideway):
    abreast = mf.on_paths(SINGLE, [0, 1])
    assert "one_path" in codes(method, guideway, abreast, ROUGH)
    assert "one_path" not in codes(method, guideway, abreast, HUMP)
    assert "one_path" not in codes(method, guideway, SINGLE, ROUGH)


@pytest.mark.parametrize(
    ("roughness", "said"),
    [
        ('kind = "iso_road"\nroad_class = "A"', True),
        (
            'kind = "laplace_road"\nkurtosis = 6\nsegment = 1\nspectrum = {kind = "iso_road", road_class = "A"}',
            True,
        ),
        ('kind = "iso_road"\nroad_class = "A"\nseed = [0, 0]', False),
        ('kind = "iso_road"\nroad_class = "A"\nacross = [0.7, -0.75]', False),
        ('kind = "bump"\nheight = 0.01\nwidth = 1.0\nat = 5.0', False),
    ],
)
def test_before_anything_is_solved(roughness, said):
    remarks = described(parse_scenario(f"{CAR}[roughness]\n{roughness}")).remarks
    assert any("known along one path" in remark for remark in remarks) == said


def test_for_a_random_road(tmp_path, capsys):
    """What a list of equal seeds says, a single seed leaves open."""
    for seed, said in (("3", True), ("[3, 3]", False)):
        file = tmp_path / "car.toml"
        file.write_text(f'{CAR}[roughness]\nkind = "iso_road"\nroad_class = "A"\nseed = {seed}\n')
        assert main(["random", str(file), "--output", str(tmp_path / "out")]) == 0
        assert ("known along one path" in capsys.readouterr().out) == said
        page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
        assert ("known along one path" in page) == said

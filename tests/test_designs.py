"""Designs of sweeps: samples that fill their ranges, and what is due to which key."""

from __future__ import annotations

import json

import numpy as np
import pytest
import scipy.stats
import xarray as xr

import movingfrf as mf
from movingfrf.studies.sweep.page.page import render
from tests.sweep_parts import command, scenario_in

pytestmark = pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")


@pytest.fixture
def truck(tmp_path):
    return scenario_in(tmp_path)


RANGES = {"run.speed": (8.0, 12.0), "vehicle.tyre_stiffness.0": (3e6, 4e6)}


@pytest.mark.parametrize("kind", ["sobol", "latin_hypercube", "random", "saltelli"])
def test_designs_fill_their_ranges(kind):
    drawn = mf.design(RANGES, samples=64, kind=kind, seed=3)
    assert drawn.values.shape == ((64 if kind != "saltelli" else 256), 2)
    for (low, high), values in zip(RANGES.values(), drawn.values.T, strict=True):
        assert low <= values.min() < low + 0.1 * (high - low)
        assert high - 0.1 * (high - low) < values.max() <= high
        assert values.mean() == pytest.approx(0.5 * (low + high), rel=0.05)
    np.testing.assert_array_equal(mf.design(RANGES, samples=64, kind=kind, seed=3).values, drawn.values)
    assert (mf.design(RANGES, samples=64, kind=kind, seed=4).values != drawn.values).any()
    assert kind in repr(drawn)


def test_a_design_of_a_distribution():
    drawn = mf.design({"run.speed": scipy.stats.norm(10.0, 2.0)}, samples=1024)
    assert drawn.values.mean() == pytest.approx(10.0, abs=0.01)
    assert drawn.values.std() == pytest.approx(2.0, rel=0.01)


def test_a_sweep_of_a_design(truck, tmp_path):
    drawn = mf.design(RANGES, samples=4)
    table = mf.sweep(truck, drawn, store=tmp_path / "kept")
    assert dict(table.sizes) == {"sample": 4, "contact": 2, "dof": 4}
    np.testing.assert_array_equal(table.speed, drawn.values[:, 0])
    one = mf.sweep(
        truck, {path: [value] for path, value in zip(drawn.paths, drawn.values[2].tolist(), strict=True)}
    )
    np.testing.assert_array_equal(one.contact_force_rms[0, 0], table.contact_force_rms[2])
    assert mf.sweep(truck, drawn, workers=2, store=tmp_path / "again").identical(table)
    assert "<figure" in render(table, "design", "")


def test_shares_of_the_variance_of_what_is_known():
    """Of 3x + y² + 2xy, x and y even over (−1, 1): variances 3 of x, 4/45 of y alone, 4/9 of both."""
    drawn = mf.design({"x": (-1.0, 1.0), "y": (-1.0, 1.0)}, samples=2**14, kind="saltelli")
    x, y = drawn.values.T
    table = xr.Dataset(
        {
            "force": (("sample", "contact"), (3 * x + y**2 + 2 * x * y)[:, None], {"long_name": "force"}),
            "load": (("sample", "contact"), 7.0 + 1e-13 * x[:, None], {"long_name": "load"}),
            "status": ("sample", np.full(x.size, "", object)),
        },
        attrs={"kind": "sweep", "design": json.dumps(drawn.drawn), "axes": "[]"},
    )
    found, whole = mf.sensitivity(table, "force"), 3 + 4 / 45 + 4 / 9
    assert found.first_order.values[:, 0] == pytest.approx([3 / whole, 4 / 45 / whole], abs=0.01)
    assert found.total.values[:, 0] == pytest.approx([(3 + 4 / 9) / whole, (4 / 45 + 4 / 9) / whole], abs=0.01)
    assert np.isnan(mf.sensitivity(table, "load").total).all()
    table.status[0] = "none"
    with pytest.raises(ValueError, match="an answer of every case, but 1 of"):
        mf.sensitivity(table, "force")


def test_designs_that_are_refused(truck):
    for over, words in (
        ({}, "must be a mapping"),
        ({"run.speed": (12.0, 8.0)}, "from a lower to a higher value, got 12 to 8"),
        ({"run.speed": (8.0, 8.0)}, "from a lower to a higher value"),
        ({"run.speed": 8.0}, "must have a range"),
    ):
        with pytest.raises(ValueError, match=words):
            mf.design(over, samples=4)
    with pytest.raises(ValueError, match="a power of two for sobol, got 1000; the next one is 1024"):
        mf.design(RANGES, samples=1000)
    with pytest.raises(ValueError, match="kind must be one of"):
        mf.design(RANGES, samples=4, kind="sobolev")
    with pytest.raises(ValueError, match="is not known here"):
        mf.sweep(truck, mf.design({"run.sped": (8.0, 9.0)}, samples=2))
    with pytest.raises(ValueError, match="got one of axes"):
        mf.sensitivity(mf.sweep(truck, {"run.speed": [9.0]}), "static_load")
    with pytest.raises(ValueError, match="got one of a sobol design"):
        mf.sensitivity(mf.sweep(truck, mf.design(RANGES, samples=2)), "static_load")
    with pytest.raises(ValueError, match="what sweep returned"):
        mf.sensitivity(None, "static_load")


def test_keys_of_a_design_have_ranges_of_their_own():
    with pytest.raises(ValueError, match=r"over must have a range for each key, got one for all of .*run\.start"):
        mf.design({("run.speed", "run.start"): (10.0, 30.0)}, samples=8)


def test_the_command_draws_samples(truck):
    out = truck.parent / "drawn"
    over = ["--over", "run.speed=8~12", "--over", "vehicle.tyre_stiffness.0=3e6~4e6"]
    done = command("sweep", truck, *over, "--samples", "8", "--design", "saltelli", "-o", out)
    assert done.returncode == 0, done.stderr
    assert "Share of the variance" in done.stdout
    assert len((out / "table.csv").read_text().splitlines()) == 33
    for line, more in (
        ("run.speed=8,9", ["--samples", "8"]),
        ("run.speed=8~9", []),
        ("run.speed=9~8", ["--samples", "8"]),
    ):
        refused = command("sweep", truck, "--over", line, *more, "-o", truck.parent / "none")
        assert refused.returncode == 2
        assert "run.speed" in refused.stderr

"""What 0.1 wrote still opens: results, and the scenarios that they were computed from, which still say the same.

`tests/data/written_by_0_1` was written by `movingfrf run`, `random` and `measure` of that version from the two
scenarios beside it.
"""

from __future__ import annotations

import csv
import json
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.fft
import xarray as xr

import movingfrf as mf
from movingfrf.commands.main import main
from movingfrf.metrics.measures import random_measures
from movingfrf.reports.result import render
from movingfrf.results.files import load

WRITTEN = Path(__file__).parent / "data" / "written_by_0_1"

# 0.1 sampled road and loads at the steps of the output: what lay above 100 Hz folded onto what lies below, or was
# lost, and a truncation's error was counted over the padding too. How far results differ for that, relative L2; all
# else stays.
FOLDED = {"contact_force": 6e-3, "acceleration": 6e-3, "motion": 5e-5, "deflection": 2e-4}
SAMPLED = {"truncation", "truncation_error"}
ROUNDING = 1e-9


def relative(found, wanted) -> float:
    return float(np.linalg.norm(found - wanted) / (np.linalg.norm(wanted) or 1.0))


def on_its_road(case):
    """Let a drive travel along the road that 0.1 realised: its harmonics belonged to the step and a fast length."""
    if not hasattr(case, "road"):
        return case
    first, last = case.journey.interval(case.vehicle)
    spectrum, step = case.road.spectrum, 0.05
    count = int(np.ceil((last - first) / step - 1e-9)) + 1
    period = scipy.fft.next_fast_len(max(count, int(np.ceil(2 / (spectrum.band[0] * step)))), real=True)
    edges = (np.arange(period // 2 + 2) - 0.5) / (period * step)
    variance = np.diff(spectrum.variance_below(np.maximum(edges, 0.0)))
    phases = np.random.default_rng(0).uniform(0.0, 2 * np.pi, period // 2 + 1)
    elevation = np.fft.irfft(np.sqrt(variance / 2) * np.exp(1j * phases) * period, period)[:count]
    profile = mf.Profile(first + step * np.arange(count), elevation, source=case.road.profile.source)
    return replace(case, road=case.road._replace(profile=profile))


@pytest.mark.parametrize("name", ["truck", "loads"])
def test_a_scenario_says_what_it_said(name):
    """All of it but its road, which 0.1 realised otherwise."""
    scenario = mf.read_scenario(WRITTEN / f"{name}.toml")
    scenario = replace(scenario, case=on_its_road(scenario.case))
    earlier = load(WRITTEN / f"{name}.nc")
    assert scenario.text == earlier.attrs["scenario"]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", mf.ValidityWarning)
        now = scenario.run()
    assert set(now.variables) == set(earlier.variables)
    for variable in now.variables:
        if now[variable].dtype.kind == "f":
            assert relative(now[variable].values, earlier[variable].values) < FOLDED.get(variable, ROUNDING), (
                variable
            )
        else:
            assert (now[variable].values == earlier[variable].values).all(), variable
    numbers = {key for key, value in earlier.attrs.items() if isinstance(value, float)}
    # Which said neither.
    assert set(now.attrs) - {"kind", "method", "solved_step", "grade", "Conventions"} == set(earlier.attrs)
    assert all(now.attrs[key] == pytest.approx(earlier.attrs[key], rel=1e-6) for key in numbers - SAMPLED)
    codes = [[one["code"] for one in json.loads(result.attrs["findings"])] for result in (now, earlier)]
    assert codes[0] == codes[1]


@pytest.mark.parametrize("name", ["truck", "loads"])
def test_a_result_becomes_a_page(name):
    scenario = mf.read_scenario(WRITTEN / f"{name}.toml")
    page = render(load(WRITTEN / f"{name}.nc"), guideway=scenario.guideway, title=name)
    assert "movingfrf 0.1.0" in page
    assert "<svg" in page


def test_a_result_is_measured_as_it_was(tmp_path, capsys):
    assert main(["measure", str(WRITTEN / "truck.nc"), "--output", str(tmp_path / "now.csv")]) == 0
    now, earlier = (
        list(csv.reader(file.read_text(encoding="utf-8").splitlines()))
        for file in (tmp_path / "now.csv", WRITTEN / "truck.csv")
    )
    # Measures that have come since may stand between.
    known = [row[:2] for row in earlier]
    now = [row for row in now if row[:2] in known]
    assert [row[:2] + row[3:] for row in now] == [row[:2] + row[3:] for row in earlier]
    for mine, theirs in zip(now[1:], earlier[1:], strict=True):
        # 0.1 took for a peak what a sample showed, and not what is between two of them.
        if mine[1] in ("dynamic peak", "peak", "smallest total"):
            further = float(mine[2]) - float(theirs[2])
            assert (further <= 0) if mine[1] == "smallest total" else (further >= 0)
            assert float(mine[2]) == pytest.approx(float(theirs[2]), rel=0.05), mine[:2]
            continue
        assert float(mine[2]) == pytest.approx(float(theirs[2]), rel=ROUNDING, nan_ok=True), mine[:2]


def test_the_response_to_a_random_road_opens():
    result = xr.load_dataset(WRITTEN / "random.nc", engine="h5netcdf")
    found = {(one.quantity, one.name): one.value for one in random_measures(result)}
    assert found["contact 0 load", "dynamic load coefficient"] == result.dynamic_load_coefficient.values[0]
    with pytest.raises(ValueError, match=r"random\.nc: holds the response to a random road"):
        load(WRITTEN / "random.nc")

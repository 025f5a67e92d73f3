"""Every example and the README's code run, and one number of each is what it was understood to be."""

import importlib.util
import re
from pathlib import Path

import numpy as np
import pytest

import movingfrf as mf

ROOT = Path(__file__).parents[1]
PAVED_ROAD = ROOT.parent / "shared" / "data" / "utia_profile.txt"


def loaded(name):
    spec = importlib.util.spec_from_file_location(name, ROOT / "examples" / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_readme_runs(capsys):
    (code,) = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), re.DOTALL)
    assert len([line for line in code.splitlines() if line.strip()]) <= 10
    exec(code, {})
    coefficient = float(capsys.readouterr().out)
    assert 0.02 < coefficient < 0.5  # a stiff quarter truck on a class B road, 72 km/h


def test_nothing_is_left_to_be_filled_in():
    texts = [*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md")]
    assert len(texts) > 4
    assert not [file.name for file in texts if re.search(r"@@|TODO|FIXME|XXX", file.read_text(encoding="utf-8"))]


def test_half_truck_example():
    found = loaded("half_truck").dynamic_load_coefficients()
    assert list(found) == [10.0, 15.0, 20.0]
    # Measured values of trucks on good roads lie between 0.05 and 0.3 (Cebon 1999).
    assert all(0.05 < value < 0.3 for pair in found.values() for value in pair)


@pytest.mark.skipif(not PAVED_ROAD.exists(), reason=f"the surveyed profile {PAVED_ROAD.name} is not there")
def test_paved_road_example():
    told = "\n".join(loaded("paved_road").told(ROOT / "examples" / "paved_road.toml"))
    assert "2177 stations from 478 m to 1022 m every 0.25 m" in told
    assert "Front axle: 98.4 kN at rest" in told


def test_paved_road_without_its_profile(tmp_path):
    scenario = tmp_path / "paved_road.toml"
    scenario.write_text((ROOT / "examples" / "paved_road.toml").read_text(encoding="utf-8"), encoding="utf-8")
    with pytest.raises(mf.ScenarioError, match=r"utia_profile\.txt: No such file"):
        loaded("paved_road").told(scenario)


def test_bridge_example(capsys):
    """Published: 2.4073 mm at 0.3710 s with 15 modes, 2.3839 mm with one (PARAMETERS.md)."""
    bridge = loaded("bridge")
    bridge.main()
    assert "2.4073 mm at 0.3710 s" in capsys.readouterr().out
    middle = bridge.crossing(modes=1).place_deflection.values
    assert middle.max() == pytest.approx(2.3839e-3, rel=1e-4)


def test_wide_road_example():
    """On roads without anything in common the wheels of an axle feel little of each other."""
    wide = loaded("wide_road")
    profile = wide.surface(0, 1)
    found, stepped = (solved(profile).contact_force.values for solved in (wide.by_moving_frf, wide.by_stepping))
    apart = np.linalg.norm(found - stepped, axis=0) / np.linalg.norm(stepped, axis=0)
    assert (apart < 2e-3).all()  # steps of 1 ms, content to 40 Hz: (ω Δt)²/12 is 5e-3 there, less below
    assert np.abs(np.corrcoef(found.T)[0, 1]) < 0.3

"""Every example and the README's code run, and one number of each is what it was understood to be."""

import importlib.util
import inspect
import re
import sys
import types
from pathlib import Path

import numpy as np
import pytest

import movingfrf as mf
from movingfrf.commands.main import main
from movingfrf.scenarios.reading import parse_scenario
from movingfrf.scenarios.template import template

ROOT = Path(__file__).parents[1]
PAVED_ROAD = ROOT.parent / "shared" / "data" / "utia_profile.txt"
BELGIAN_BLOCK = PAVED_ROAD.with_name("belgian_block.crg")


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


def test_tables_of_the_documentation_stand_line_by_line():
    """A table that was wrapped like prose is none."""
    for file in [*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md")]:
        lines = file.read_text(encoding="utf-8").replace("\\|", "").splitlines()
        for above, line, below in zip(lines, lines[1:], lines[2:], strict=False):
            if "|---" in line:
                assert re.fullmatch(r"\|(-+:?\|)+", line), f"{file.name}: {line}"
                columns = line.count("|")
                assert above.count("|") == below.count("|") == columns, f"{file.name}: {above}"


def test_half_truck_example():
    found = loaded("half_truck").dynamic_load_coefficients()
    assert list(found) == [10.0, 15.0, 20.0]
    # Measured values of trucks on good roads lie between 0.05 and 0.3 (Cebon 1999).
    assert all(0.05 < value < 0.3 for pair in found.values() for value in pair)


def test_three_speeds_example(tmp_path):
    """A case of the sweep is the journey by itself."""
    file = tmp_path / "road.csv"
    mf.write_profile(mf.realise(mf.IsoRoad.of_class("B"), length=500.0, seed=1), file)
    example = loaded("three_speeds")
    table = example.compared(file)
    assert table.speed_kmh.values.tolist() == [60.0, 80.0, 100.0]
    lorry = mf.catalogue("tractor_semitrailer")
    road = mf.track(mf.EulerBernoulliBeam(1.573e7, 711.9), mf.Spring(8.0e6, 3.0e4))
    profile = mf.read_profile(file).profile
    found = table.sel(speed_kmh=80.0)
    coefficients, step = found.dynamic_load_coefficient, found.time_step.item()
    alone = mf.simulate(road, lorry, profile, speed=80 / 3.6, duration=15.0, start=20.0, time_step=step)
    np.testing.assert_allclose(coefficients, mf.dynamic_load_coefficient(alone), rtol=1e-9)
    assert 0.1 < float(coefficients.max()) < 0.3


def test_network_example(tmp_path):
    """The road that is loaded most, of class B, is so by the journey by itself as well."""
    example = loaded("network")
    example.surveyed(tmp_path, 4)
    table = example.loaded(tmp_path)
    assert dict(table.sizes) == {"file": 4, "vehicle": 3, "contact": 5}
    worst = example.most_loaded(table)[0]
    truck = table.dynamic_load_coefficient.sel(file=worst.file).max("contact").idxmax("vehicle")
    step = table.time_step.sel(file=worst.file, vehicle=truck).item()
    lorry = mf.catalogue(str(truck.values))
    road = mf.track(mf.EulerBernoulliBeam(1.573e7, 711.9), mf.Spring(8.0e6, 3.0e4))
    profile = mf.read_profile(tmp_path / str(worst.file.values)).profile
    alone = mf.simulate(road, lorry, profile, speed=80 / 3.6, duration=10.0, start=20.0, time_step=step)
    assert float(worst) == pytest.approx(mf.dynamic_load_coefficient(alone).max(), rel=1e-9)
    assert str(worst.file.values) in ("profiles/001.csv", "profiles/003.csv")


def test_the_agency_s_page(tmp_path):
    """The file and the line of docs/sweeps.md lead to what the example says, and to a page that says it."""
    text = (ROOT / "docs" / "sweeps.md").read_text(encoding="utf-8")
    (scenario,) = re.findall(r"```toml\n(.*?)```", text, re.DOTALL)
    (line,) = re.findall(r"    movingfrf (sweep lorry.toml .*?)\n\n", text, re.DOTALL)
    (tmp_path / "lorry.toml").write_text(scenario, encoding="utf-8")
    mf.write_profile(mf.realise(mf.IsoRoad.of_class("B"), length=500.0, seed=1), tmp_path / "road.csv")
    words = line.replace("\\\n", " ").replace("lorry.toml", str(tmp_path / "lorry.toml")).split()
    assert not main(words)
    expected = loaded("three_speeds").compared(tmp_path / "road.csv")
    page = (tmp_path / "out" / "lorry-sweep" / "report.html").read_text(encoding="utf-8")
    largest = float(expected.dynamic_load_coefficient.max())
    assert f"Largest: {largest:.4f}, at axle 1, speed 80 km/h." in page
    assert page.count("<figure") == 3


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_designer_example():
    """Around the best dampers, a hundredth away in any direction, the limit is broken or the load is larger."""
    example = loaded("designer")
    found = example.best()
    assert found.success
    ways = np.array([[np.cos(angle), np.sin(angle)] for angle in np.linspace(0.0, 2 * np.pi, 24, endpoint=False)])
    near = found.x * np.exp(0.01 * ways)
    dampers = tuple(f"vehicle.suspension_damping.{number}" for number in (0, 1))
    measures = ["dynamic_load_coefficient", "weighted_acceleration_rms"]
    table = mf.sweep(example.scenario(), {dampers: [tuple(each) for each in near]}, measures=measures)
    load, comfort = table.dynamic_load_coefficient.values[:, 1], table.weighted_acceleration_rms.values[:, 0]
    within = comfort <= example.COMFORT
    assert 0 < within.sum() < within.size  # the limit is what decides
    assert (load[within] > found.fun).all()
    assert load.min() < found.fun == pytest.approx(0.0595, rel=0.01)


@pytest.mark.skipif(not PAVED_ROAD.exists(), reason=f"the surveyed profile {PAVED_ROAD.name} is not there")
@pytest.mark.filterwarnings("ignore:the profile begins with a grade of -0.51 %")
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


def test_bridge_scenario_example():
    """The same bridge by elements; under the mass, which the modes of bridge.py give as well."""
    result = mf.read_scenario(ROOT / "examples" / "bridge.toml").run(method="cdfm")
    assert result.deflection.values.max() == pytest.approx(2.3578e-3, rel=1e-4)
    by_modes = loaded("bridge").crossing().deflection.values.max()
    assert result.deflection.values.max() == pytest.approx(by_modes, rel=1e-4)


@pytest.mark.slow
def test_wide_road_example():
    """On roads without anything in common the wheels of an axle feel little of each other."""
    wide = loaded("wide_road")
    profile = wide.surface(0, 1)
    found, stepped = (solved(profile).contact_force.values for solved in (wide.by_moving_frf, wide.by_stepping))
    apart = np.linalg.norm(found - stepped, axis=0) / np.linalg.norm(stepped, axis=0)
    assert (apart < 2e-3).all()  # steps of 1 ms, content to 40 Hz: (ω Δt)²/12 is 5e-3 there, less below
    assert np.abs(np.corrcoef(found.T)[0, 1]) < 0.3


def test_random_road_example():
    """The closed form against one minute over one road: some 100 waves of the body, so within 20 %."""
    example = loaded("random_road")
    every, one = example.all_roads(20.0), example.one_road(20.0, seed=1)
    forces = one.contact_force.std("time").values / every.contact_force_rms.values
    bounce = one.acceleration.std("time").values / every.acceleration_rms.values
    assert np.abs(np.concatenate([forces, bounce]) - 1).max() < 0.2
    assert 0.05 < every.dynamic_load_coefficient.values.min() < every.dynamic_load_coefficient.values.max() < 0.3


def test_rough_stretches_example():
    """Kurtosis 3 E V² of the force; 600 stretches leave E V² uncertain by 2.3/√600, or 6 %, and E V by 3 %."""
    found = loaded("rough_stretches").moments()
    assert found["even"][1] == pytest.approx(3.0, abs=0.1)
    assert found["varying"][1] == pytest.approx(4.5, rel=0.15)
    assert found["varying"][0] == pytest.approx(found["even"][0], rel=0.06)


def test_semitrailer_example():
    """Walking beams without dampers of their own are known for the highest dynamic loads (Cebon 1999)."""
    example = loaded("semitrailer")
    apart, together = (
        mf.dynamic_load_coefficient(example.drive(example.vehicle(walking_beam=beam))) for beam in (False, True)
    )
    assert (apart < 0.1).all()
    assert (together[3:] > 2 * apart[3:]).all()
    np.testing.assert_allclose(together[:3], apart[:3], rtol=0.05)


def test_train_example():
    """A tenth of its way: every coach carries its share, and the first bogies feel the track first."""
    text = (ROOT / "examples" / "train.toml").read_text(encoding="utf-8")
    short = text.replace("duration = 12.5 ", "duration = 1.25 ").replace("count = 16", "count = 4")
    result = parse_scenario(short).run()
    np.testing.assert_allclose(result.static_load.sum(), 4 * 9.81 * (47_800 + 2 * 3500 + 4 * 1800), rtol=1e-6)


@pytest.mark.skipif(not BELGIAN_BLOCK.exists(), reason=f"the measured surface {BELGIAN_BLOCK.name} is not there")
def test_belgian_block_example():
    """The paths of the surface have 24 and 23 mm, as its file's description says; a quarter of the car at rest."""
    told = "\n".join(loaded("belgian_block").told(BELGIAN_BLOCK))
    assert "mirrored forth and back 12 times to 120 m" in told
    assert "Elevation 23.5 mm root mean square, at 30 km/h." in told
    assert f"{(1400 * 1.4 / 2.7 / 2 + 40) * 9.81e-3:.1f} kN at rest" in told


def test_belgian_block_without_its_surface(tmp_path):
    with pytest.raises(ValueError, match=r"cannot read .*none\.crg: No such file"):
        loaded("belgian_block").told(tmp_path / "none.crg")


PAGES = [file for file in sorted((ROOT / "docs").glob("*.md")) if "```python" in file.read_text(encoding="utf-8")]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_the_code_of_a_page_runs(page, tmp_path, monkeypatch):
    """Block after block, as a reader would; `truck.toml` is what `movingfrf new` writes, as the page says."""
    monkeypatch.chdir(tmp_path)
    Path("truck.toml").write_text(template("scenario"), encoding="utf-8")
    names = {"__name__": page.stem}
    monkeypatch.setitem(sys.modules, page.stem, types.ModuleType(page.stem))  # where dataclasses look themselves up
    for block in re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL):
        exec(block, names)


def test_calls_in_the_documentation_can_be_called():
    """`Contact(position, stiffness)` in a text is a promise: without keywords stands what needs none."""
    promised = 0
    for file in [ROOT / "README.md", *(ROOT / "docs").glob("*.md")]:
        for name, given in re.findall(r"`(?:mf\.)?(\w+)\(([^()`]*)\)`", file.read_text(encoding="utf-8")):
            positional = [one for one in given.split(",") if one.strip() not in ("", "…") and "=" not in one]
            if positional and name in mf.__all__:
                promised += 1
                parameters = inspect.signature(getattr(mf, name)).parameters.values()
                free = [one for one in parameters if one.kind is not one.KEYWORD_ONLY]
                several = any(one.kind is one.VAR_POSITIONAL for one in free)
                assert several or len(positional) <= len(free), f"{file.name}: {name}({given})"
    assert promised > 3


def test_nothing_is_to_be_installed_from_where_it_is_not():
    """What is told to be installed is there: packages of others, or this clone."""
    texts = [*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md"), *(ROOT / "src").rglob("*.py")]
    found = [file.name for file in texts if re.search(r"pip\s+install\s+'?movingfrf", file.read_text("utf-8"))]
    assert found == []

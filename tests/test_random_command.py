"""`movingfrf random`: files, messages, refusals; the report of a random response."""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import movingfrf as mf
from movingfrf.commands.main import main
from movingfrf.metrics.measures import random_measures
from movingfrf.reports.random import drawing_frequencies, paths_in_words, render
from tests.helpers import DAMPED, FULL_TRUCK
from tests.test_scenario import LOADS, TEMPLATE

HARMONIC = re.sub(
    r"(?s)\[roughness\].*?(?=\n\[|\Z)",
    '[roughness]\nkind = "harmonic"\namplitude = 0.001\nwavelength = 4.0\n',
    TEMPLATE,
)
BRIDGE = (Path(__file__).parents[1] / "examples" / "bridge.toml").read_text(encoding="utf-8")


def test_three_files_that_say_the_same(tmp_path, capsys):
    """Equal bytes in the folder that was named and in the one that is beside the scenario unless told."""
    scenario, named, usual = tmp_path / "truck.toml", tmp_path / "a", tmp_path / "out" / "truck-random"
    scenario.write_text(TEMPLATE)
    command = ["random", str(scenario), "--exposure", "60"]
    assert main([*command, "--output", str(named)]) == 0
    assert main(command) == 0
    told = capsys.readouterr().out
    for words in (
        "Spectrum: ISO 8608 class A, 1.6e-05 m³ at 0.1 cycle/m, waviness 2, 0.01 to 6 cycle/m; one road under all",
        "contact 0 (front) force",
        "coefficient",
        "bounce acceleration",
        "pitch acceleration",
        "Findings: none",
    ):
        assert words in told
    assert sorted(file.name for file in named.iterdir()) == ["random.nc", "report.html", "summary.json"]
    for file in named.iterdir():
        assert file.read_bytes() == (usual / file.name).read_bytes(), file.name
    made = mf.read_scenario(scenario)
    direct = mf.random_response(
        made.guideway,
        made.case.vehicle,
        made.case.road.spectrum,
        speed=made.journey.speed,
        coherence=1.0,
        exposure=60.0,
    )
    with xr.open_dataset(named / "random.nc") as reopened:
        assert (reopened.contact_force_density.values == direct.contact_force_density.values).all()
        assert reopened.attrs["scenario"] == TEMPLATE
        assert reopened.attrs["spectrum"] == str(made.case.road.spectrum)
    summary = json.loads((named / "summary.json").read_text(encoding="utf-8"))
    (rms,) = [m for m in summary["measures"] if m["quantity"] == "contact 1 force" and m["name"] == "rms"]
    assert rms["value"] == pytest.approx(direct.contact_force_rms.values[1], rel=1e-12)
    assert rms["units"] == "N"
    assert summary["settings"]["exposure"] == 60.0


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (HARMONIC, "the roughness has no spectrum"),
        (LOADS, "prescribed loads have no random road"),
        # Before the roughness, of which it would send to the method that has no answer either.
        (BRIDGE, "guideway is a finite road, which has no moving FRF"),
    ],
)
def test_what_has_no_spectrum_is_refused(tmp_path, capsys, text, words):
    scenario = tmp_path / "case.toml"
    scenario.write_text(text)
    assert main(["random", str(scenario)]) == 2
    assert words in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_a_value_that_is_refused(tmp_path, capsys):
    scenario = tmp_path / "truck.toml"
    scenario.write_text(TEMPLATE)
    assert main(["random", str(scenario), "--exposure", "-1"]) == 2
    assert "exposure must be positive" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
@pytest.mark.parametrize(
    ("coherence", "words"),
    [
        (1, "one road under all wheels: left and right see the same, and nothing makes the vehicle roll"),
        (0.0, "paths without anything in common"),
        (0.5, "coherence 0.5"),
        (mf.IsotropicCoherence(), "coherence IsotropicCoherence(waviness=2.0)"),
    ],
)
def test_what_the_paths_have_in_common(coherence, words):
    spectrum = mf.IsoRoad.of_class("A", band=(0.1, 1.0))
    car = mf.full_car(**FULL_TRUCK)
    result = mf.random_response(mf.RigidGuideway(), car, spectrum, speed=10.0, coherence=coherence)
    assert paths_in_words(result) == words


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_report():
    """One page, nothing outside it, findings as sentences, numbers as in the measures."""
    spectrum = replace(mf.IsoRoad.of_class("A"), roughness=1e-3)
    result = mf.random_response(
        DAMPED["euler_bernoulli_winkler"], mf.full_car(**FULL_TRUCK), spectrum, speed=10.0, coherence=0.5
    )
    found = random_measures(result)
    page = render(result, found, title="A <title>", scenario="[run]")
    assert "A &lt;title&gt;" in page
    outside = re.sub(r"<svg[^>]*>|xmlns(:\w+)?=\"[^\"]*\"", "", page)
    assert not re.search(r"(src|href)=\"(?!#)", outside)
    assert page.count("<svg") == 5
    assert "Contacts 0 (front left) to 3 (rear right) would lift off the road up to" in page
    for name in ("static", "crossing rate", "dynamic load coefficient", "road stress factor", "weighted rms (Wk)"):
        assert name in page
    static = next(m for m in found if m.quantity == "contact 0 force" and m.name == "static")
    assert f"<td>{1e-3 * static.value:.2f}</td>" in page
    assert len(page) < 2e6


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_report_of_what_does_not_move():
    """A rigid road does not deflect, one road for both sides does not roll: no figure fails, a dash for a rate."""
    car = mf.full_car(**(FULL_TRUCK | {"sides": (0.9, -0.9)}))
    result = mf.random_response(mf.RigidGuideway(), car, mf.IsoRoad.of_class("A"), speed=10.0, coherence=1.0)
    assert not result.deflection_rms.any()
    assert np.isnan(result.deflection_crossing_rate).all()
    found = random_measures(result)
    page = render(result, found, title="rigid")
    assert "<td>–</td>" in page
    (felt,) = [m for m in found if m.quantity == "roll acceleration" and m.name.startswith("weighted")]
    assert felt.value == 0.0
    # Left and right do the same: one curve stands for both.
    assert "front left wheel = front right wheel" in page


def test_a_report_names_contacts_and_keeps_weightings_apart():
    """Contacts by name and place; Wk over translations only; what never happens as such, not with three digits."""
    car = mf.full_car(**FULL_TRUCK)
    spectrum = mf.IsoRoad.of_class("A", band=(0.1, 1.0))
    result = mf.random_response(mf.RigidGuideway(), car, spectrum, speed=10.0, coherence=0.5)
    assert 0 < result.lift_off_rate.values.max() < 1e-12
    drawn = mf.random_response(
        mf.RigidGuideway(), car, spectrum, speed=10.0, coherence=0.5, frequency=drawing_frequencies(result)
    )
    page = render(result, random_measures(result), title="car", drawn=drawn)
    assert re.search(r"contact 0 \(front left\) at \+[\d.]+ m, path 0</th>", page)
    assert page.count("< 10⁻¹²".replace("<", "&lt;")) == 8  # rate and share, four contacts
    translations, rotations = re.findall(r"<table>(.*?)</table>", page, re.DOTALL)[-2:]
    assert "(Wk)" in translations
    assert "(We)" not in translations
    assert "(We)" in rotations
    assert "pitch" in rotations
    assert set(result.frequency.values) <= set(drawn.frequency.values)
    assert np.diff(np.log(drawn.frequency.values)).max() < 0.01

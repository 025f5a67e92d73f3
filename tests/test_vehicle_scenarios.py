"""Vehicles in scenario files, and the command that describes them: the same as in Python, faults by name."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import movingfrf as mf
from movingfrf.commands.main import main
from movingfrf.scenarios.kinds import VEHICLE
from movingfrf.scenarios.reading import named_vehicle, parse_scenario
from movingfrf.studies.comparison.methods import chosen
from movingfrf.vehicles.catalogue import CATALOGUE
from tests.helpers import HALF_TRUCK

GROUND = """
[guideway]
kind = "rigid_guideway"
[roughness]
kind = "harmonic"
amplitude = 1e-4
wavelength = 4.0
[run]
speed = 10.0
duration = 4.0
"""

TEXTS = {
    "catalogue": '[vehicle]\nkind = "catalogue"\nname = "half_truck"\n',
    "sprung_mass": '[vehicle]\nkind = "sprung_mass"\nmass = 5750.0\nstiffness = 1.6e6\nwheel_mass = 500.0\n',
    "truck": """
[vehicle]
kind = "truck"
hitches = [-1.2]
[[vehicle.units]]
name = "tractor"
mass = 6000.0
pitch_inertia = 2e4
position = 0.3
[[vehicle.units.axles]]
position = 2.0
mass = 700.0
suspension_stiffness = 4e5
suspension_damping = 1e4
tyre_stiffness = 1.75e6
[[vehicle.units.axles]]
position = -1.5
mass = 1100.0
suspension_stiffness = 1e6
suspension_damping = 2e4
tyre_stiffness = 3.5e6
[[vehicle.units]]
name = "trailer"
mass = 20000.0
pitch_inertia = 1.5e5
position = -5.0
[[vehicle.units.axles]]
kind = "walking_beam"
positions = [-7.4, -8.7]
mass = 1500.0
pitch_inertia = 700.0
suspension_stiffness = 1.6e6
suspension_damping = 3e4
tyre_stiffness = 3.5e6
""",
    "assemble": """
[vehicle]
kind = "assemble"
under = ["front", ""]
[[vehicle.bodies]]
mass = 100.0
pitch_inertia = 30.0
[[vehicle.bodies]]
name = "front"
mass = 10.0
[[vehicle.bodies]]
name = "drawbar"
mass = 5.0
pitch_inertia = 2.0
position = -2.0
[[vehicle.suspensions]]
upper = ""
lower = "front"
stiffness = 1e5
position = 1.0
[[vehicle.suspensions]]
upper = ""
lower = "drawbar"
stiffness = 1e5
position = -2.5
[[vehicle.hinges]]
first = ""
second = "drawbar"
position = -1.5
[[vehicle.contacts]]
position = 1.0
stiffness = 2e5
[[vehicle.contacts]]
position = -1.0
stiffness = inf
""",
    "convoy": """
[vehicle]
kind = "convoy"
gaps = 10.0
[[vehicle.vehicles]]
kind = "catalogue"
name = "half_truck"
[[vehicle.vehicles]]
kind = "catalogue"
name = "golden_car"
""",
    "train": """
[vehicle]
kind = "train"
count = 3
spacing = 25.0
[vehicle.car]
kind = "carriage"
body_mass = 32e3
body_pitch_inertia = 1.97e6
bogie_mass = 2615.0
bogie_pitch_inertia = 1476.0
wheelset_mass = 1813.0
primary_stiffness = 2.4e6
primary_damping = 8e3
secondary_stiffness = 8.6e5
secondary_damping = 4e4
bogie_spacing = 19.0
axle_spacing = 2.56
""",
    "seated": """
[vehicle]
kind = "seated"
driver_mass = 80.0
cushion_stiffness = 3e4
cushion_damping = 600.0
[vehicle.mount]
bounce = 1.0
pitch = 1.5
[vehicle.vehicle]
kind = "catalogue"
name = "half_truck"
""",
    "on_paths": """
[vehicle]
kind = "on_paths"
paths = [0, 0]
[vehicle.vehicle]
kind = "catalogue"
name = "half_truck"
""",
    "bogie": """
[vehicle]
kind = "bogie"
frame_mass = 2615.0
frame_pitch_inertia = 1476.0
wheelset_mass = 1813.0
primary_stiffness = 2.4e6
primary_damping = 8e3
axle_spacing = 2.56
""",
    "wheelset": '[vehicle]\nkind = "wheelset"\nmass = 1800.0\ncontact_stiffness = 1.4e9\n',
}


def built(text, **where):
    return parse_scenario(text + GROUND, **where).case.vehicle


def faults(text):
    with pytest.raises(mf.ScenarioError) as caught:
        built(text)
    return {fault.name: fault.message for fault in caught.value.faults}


def test_every_kind_of_vehicle_has_a_text():
    elsewhere = {"quarter_car", "half_car", "full_car", "vehicle", "vehicle_file", "carriage"}
    assert set(TEXTS) | elsewhere == set(VEHICLE.kinds)


@pytest.mark.parametrize("kind", TEXTS)
def test_every_kind_runs(kind):
    result = parse_scenario(TEXTS[kind] + GROUND).run()
    assert np.isfinite(result.contact_force).all()


def test_a_scenario_builds_what_python_builds():
    coach = {
        "body_mass": 32e3,
        "body_pitch_inertia": 1.97e6,
        "bogie_mass": 2615.0,
        "bogie_pitch_inertia": 1476.0,
        "wheelset_mass": 1813.0,
        "primary_stiffness": 2.4e6,
        "primary_damping": 8e3,
        "secondary_stiffness": 8.6e5,
        "secondary_damping": 4e4,
        "bogie_spacing": 19.0,
        "axle_spacing": 2.56,
    }
    truck = mf.half_car(**HALF_TRUCK)
    expected = {
        "catalogue": truck,
        "train": mf.train(car=mf.carriage(**coach), count=3, spacing=25.0),
        "convoy": mf.convoy([truck, mf.catalogue(name="golden_car")], gaps=10.0),
        "seated": mf.seated(
            truck,
            mount={"bounce": 1.0, "pitch": 1.5},
            driver_mass=80.0,
            cushion_stiffness=3e4,
            cushion_damping=600.0,
        ),
        "wheelset": mf.wheelset(mass=1800.0, contact_stiffness=1.4e9),
    }
    for kind, vehicle in expected.items():
        found = built(TEXTS[kind])
        assert found.contacts == vehicle.contacts
        assert found.dof_names == vehicle.dof_names
        for one, other in zip(found.matrices, vehicle.matrices, strict=True):
            np.testing.assert_allclose(one, other, rtol=1e-12)


@pytest.mark.parametrize(
    ("kind", "old", "new", "name", "message"),
    [
        (
            "truck",
            "mass = 700.0",
            "mass = -700.0",
            "vehicle.units[0].axles[0].mass",
            "must be positive, got -700.0 kg",
        ),
        (
            "truck",
            'kind = "walking_beam"',
            'kind = "beam"',
            "vehicle.units[1].axles[0].kind",
            "must be one of axle, ",
        ),
        ("truck", "hitches = [-1.2]", "", "vehicle.hitches", "must be one less than units, 1 in all, got 0"),
        (
            "truck",
            "pitch_inertia = 2e4",
            "pitch_inertai = 2e4",
            "vehicle.units[0].pitch_inertai",
            "is not known here",
        ),
        ("catalogue", "half_truck", "half_tuck", "vehicle.name", "must be one of golden_car, "),
        (
            "seated",
            "pitch = 1.5",
            "roll = 1.5",
            "vehicle.mount.roll",
            "is no degree of freedom; there are bounce, ",
        ),
        ("seated", "half_truck", "half_tuck", "vehicle.vehicle.name", "must be one of golden_car, "),
        ("convoy", "gaps = 10.0", "", "vehicle.gaps", "or spacing is needed, not both"),
        (
            "assemble",
            'second = "drawbar"',
            'second = "bar"',
            "vehicle.hinges[0].second",
            "must be one of the bodies",
        ),
        ("train", "count = 3", "count = 3.5", "vehicle.count", "must be a whole number of at least 1, got 3.5"),
        ("wheelset", "1.4e9", "-1.4e9", "vehicle.contact_stiffness", "must be positive"),
    ],
)
def test_faults_are_found_where_they_are(kind, old, new, name, message):
    found = faults(TEXTS[kind].replace(old, new, 1))
    assert found[name].startswith(message), found


@pytest.mark.parametrize("kind", TEXTS)
def test_nonsense_is_refused_and_never_a_defect(kind):
    """Every line of every text with absurd values in turn."""
    absurd = ["nan", "-inf", "1e300", "-1", "0", '""', "[]", "[[1]]", "{}", "true", '"A"', "[1, 2]", "1979-05-27"]
    lines = TEXTS[kind].splitlines()
    refused = 0
    for n, line in enumerate(lines):
        if "=" not in line:
            continue
        for value in absurd:
            text = "\n".join([*lines[:n], f"{line.split('=')[0]}= {value}", *lines[n + 1 :]])
            try:
                built(text)
            except mf.ScenarioError as error:
                assert error.faults  # noqa: PT017
                refused += 1
    assert refused > 10


def test_a_vehicle_by_its_name_its_matrices_or_its_scenario(tmp_path):
    truck = mf.catalogue(name="half_truck")
    mf.write_vehicle(truck, tmp_path / "truck.npz")
    (tmp_path / "case.toml").write_text(TEXTS["catalogue"] + GROUND)
    (tmp_path / "file.toml").write_text('[vehicle]\nkind = "vehicle_file"\nfile = "truck.npz"\n')
    for name in ("half_truck", tmp_path / "truck.npz", tmp_path / "case.toml", tmp_path / "file.toml"):
        np.testing.assert_array_equal(named_vehicle(name).static_loads, truck.static_loads)
    (tmp_path / "bad.toml").write_text('[vehicle]\nkind = "vehicle_file"\nfile = "none.npz"\n')
    with pytest.raises(mf.ScenarioError, match=r"vehicle: cannot read .*none.npz: No such file"):
        named_vehicle(tmp_path / "bad.toml")


def test_the_scenarios_of_the_documentation_are_in_order(tmp_path):
    text = (Path(__file__).parents[1] / "docs" / "vehicles.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```toml\n(.*?)```", text, re.DOTALL)
    assert len(blocks) >= 5
    mf.write_vehicle(mf.catalogue(name="half_truck"), tmp_path / "lorry.npz")
    for block in blocks:
        if "[vehicle]" in block:
            assert built(block, folder=tmp_path).static_loads.min() > 0


def test_the_command_lists_and_describes(tmp_path, capsys):
    assert main(["vehicles"]) == 0
    told = capsys.readouterr().out
    for name, entry in CATALOGUE.items():
        assert name in told
        assert entry.source in told
    assert main(["vehicles", "tractor_semitrailer", "--output", str(tmp_path / "lorry.mat")]) == 0
    told = capsys.readouterr().out
    for words in ("trailer_pitch", "392.40 kN", "axle 5", "1.411 Hz", "wrote"):
        assert words in told
    assert main(["vehicles", str(tmp_path / "lorry.mat")]) == 0
    assert "392.40 kN" in capsys.readouterr().out
    for arguments, message in (
        (["vehicles", "tank"], "name must be one of golden_car"),
        (["vehicles", "half_trck"], "got 'half_trck' (did you mean 'half_truck'?)"),
        (["vehicles", "none.npz"], "cannot read none.npz"),
        (["vehicles", "--output", "x.npz"], "--output needs the name of a vehicle"),
        (["vehicles", "half_truck", "--output", str(tmp_path / "x.xls")], "is written to .mat or .npz"),
    ):
        assert main(arguments) == 2
        assert message in capsys.readouterr().err


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (TEXTS["seated"].replace("half_truck", "two_axle_truck"), "% of critical damping: it takes long to settle"),
        (TEXTS["bogie"] + "[unused]", ""),
    ],
)
def test_check_remarks_on_what_is_in_order(text, words, tmp_path, capsys):
    file = tmp_path / "case.toml"
    file.write_text(
        text.replace("[unused]", "") + GROUND.replace("duration = 4.0", "duration = 4.0\ntime_step = 0.05")
    )
    assert main(["check", str(file)]) == 0
    told = " ".join(capsys.readouterr().out.split())
    assert words in told
    assert ("steps of 0.05 s shows only what is below 10 Hz" in told) == (
        parse_scenario(file.read_text()).case.vehicle.natural_frequencies.max() > 10
    )
    assert "in order" in told


def test_a_vehicle_on_rigid_contacts_or_longer_than_a_struck_road_is_not_compared_with_those():
    """The usual methods that strike 40 m have no room for a train; rigid wheels cannot be stepped."""
    ground = GROUND.replace(
        '[guideway]\nkind = "rigid_guideway"',
        '[guideway]\nbeam = {kind = "euler_bernoulli_beam", bending_stiffness = 6e6, mass = 60.0}\n'
        'foundation = {kind = "spring", stiffness = 1e8, damping = 1e5}',
    )
    stiff = TEXTS["train"].replace("axle_spacing = 2.56", "axle_spacing = 2.56\ncontact_stiffness = 2e9")
    assert set(chosen(parse_scenario(stiff + ground), None)) == {"moving-frf", "cdfm", "cdfm-window", "sim"}
    assert "duhamel" in chosen(parse_scenario(TEXTS["catalogue"] + ground), None)
    with pytest.raises(ValueError, match=r"rigid contacts .* there is nothing to compare"):
        chosen(parse_scenario(TEXTS["train"] + ground), None)


def test_a_train_is_described_in_short(tmp_path, capsys):
    """Sixteen coaches have the same frequencies, and more contacts than anyone wants to read."""
    (tmp_path / "train.toml").write_text(TEXTS["train"].replace("count = 3", "count = 16"))
    assert main(["vehicles", str(tmp_path / "train.toml")]) == 0
    told = capsys.readouterr().out
    assert "(16 times)" in told
    assert "53 more" in told
    assert "(160 in all)" in told
    assert len(told.splitlines()) < 45


def test_a_file_in_millimetres_is_noticed_on_its_own(tmp_path, capsys):
    """`movingfrf vehicles` says of a file what `check` says of a scenario."""
    truck = mf.catalogue("half_truck")
    far = replace(truck, contacts=tuple(replace(one, position=1e3 * one.position) for one in truck.contacts))
    mf.write_vehicle(far, tmp_path / "mm.mat")
    mf.write_vehicle(truck, tmp_path / "m.mat")
    assert main(["vehicles", str(tmp_path / "mm.mat")]) == 0
    told = " ".join(capsys.readouterr().out.split())
    assert "- the vehicle's length from its first contact to its last is 4270 m, usual is 0.2 to 60 m" in told
    assert main(["vehicles", str(tmp_path / "m.mat")]) == 0
    assert "Findings" not in capsys.readouterr().out


@pytest.mark.parametrize(("given", "lengths"), [("0.3", [0.3, 0.3]), ("[0.2, 0.3]", [0.2, 0.3])])
def test_footprints_of_the_catalogue_in_a_scenario(tmp_path, given, lengths):
    file = tmp_path / "case.toml"
    file.write_text(
        '[guideway]\nkind = "rigid_guideway"\n[vehicle]\nkind = "catalogue"\nname = "half_truck"\n'
        f'footprint = {given}\n[roughness]\nkind = "bump"\nheight = 0.01\nwidth = 1.0\nat = 5.0\n'
        "[run]\nspeed = 10.0\nduration = 1.0\n"
    )
    assert [contact.footprint for contact in mf.read_scenario(file).case.vehicle.contacts] == lengths

"""Scenario files: what they build, and everything that is wrong with one reported at once."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import movingfrf as mf
from movingfrf.scenarios.kinds import DRIVE, TABLES
from movingfrf.scenarios.reading import parse_scenario
from movingfrf.scenarios.template import template

TEMPLATE = template("scenario")

LOADS = """
[guideway]
beam = {kind = "euler_bernoulli_beam", bending_stiffness = 1.573e7, mass = 711.9}
foundation = {kind = "spring", stiffness = 8e6, damping = 3e4}

[loads]
positions = [0.0, -2.5]
observe = [0.0, 1.0, -2.5]
[[loads.force]]
kind = "constant"
force = 1e5
ramp = 0.2
[[loads.force]]
kind = "harmonics"
mean = 5e4
amplitudes = [1e4]
frequencies = [12.0]
switch_off = 1.5
ramp = 0.2

[run]
speed = 10.0
duration = 2.0
"""


LOADS_TEMPLATE = template("loads")


def faults(text, **where):
    with pytest.raises(mf.ScenarioError) as caught:
        parse_scenario(text, **where)
    return {fault.name: fault.message for fault in caught.value.faults}


def edited(**changes):
    """Replace the values of some keys of the template; a value of None removes the line."""
    lines = []
    for line in TEMPLATE.splitlines():
        key = line.split("=")[0].strip()
        if key not in changes:
            lines.append(line)
        elif changes[key] is not None:
            lines.append(f"{key} = {changes[key]}")
    return "\n".join(lines)


def test_the_template_is_the_reference_case():
    scenario = parse_scenario(TEMPLATE)
    assert (scenario.journey.speed, scenario.journey.duration, scenario.journey.truncation) == (10.0, 24.0, 70.0)
    road = mf.track(
        mf.EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9), mf.Spring(stiffness=8e6, damping=3e4)
    )
    assert scenario.guideway == road
    assert scenario.case.vehicle.dof_names == ("bounce", "pitch", "front_wheel", "rear_wheel")
    assert "class A" in scenario.case.road.description


def test_a_scenario_is_the_same_call_as_in_python():
    scenario = parse_scenario(edited(duration=2.0))
    result = scenario.run()
    direct = mf.simulate(
        scenario.guideway,
        scenario.case.vehicle,
        scenario.case.road.profile,
        speed=10.0,
        duration=2.0,
        truncation=70.0,
    )
    assert result.attrs["scenario"] == scenario.text
    assert result.drop_attrs().identical(direct.drop_attrs())


def test_loads_from_a_scenario_are_those_that_python_takes():
    result = parse_scenario(LOADS).run()
    assert dict(result.sizes) == {"time": 2000, "load": 2, "point": 3}
    time = np.arange(2000) * 1e-3
    step = lambda x: (lambda y: y**3 * (10 - 15 * y + 6 * y**2))(np.clip(x, 0, 1))  # noqa: E731
    force = np.stack(
        [
            1e5 * step(time / 0.2),
            (5e4 + 1e4 * np.sin(2 * np.pi * 12 * time)) * step(time / 0.2) * step((1.5 - time) / 0.2),
        ],
        axis=1,
    )
    assert np.allclose(result.force, force, atol=1e-6)
    road = parse_scenario(TEMPLATE).guideway
    direct = mf.moving_loads(road, force, [0.0, -2.5], speed=10.0, observe=[0.0, 1.0, -2.5])
    # Python takes samples, and a spline between them.
    assert np.abs(result.deflection - direct.deflection).max() < 1e-6 * direct.deflection.max()


def test_the_template_of_loads_runs():
    result = parse_scenario(LOADS_TEMPLATE).run()
    assert result.force.shape == (10_000, 2)
    assert result.deflection.shape == (10_000, 3)
    # Under the constant load by itself the reference road gives way by 3.737 mm; the other load adds to it.
    assert 3.5e-3 < result.deflection[7000, 0].item() < 4.5e-3


def test_forces_from_a_file(tmp_path):
    (tmp_path / "axles.csv").write_text("t,a,b\n" + "\n".join(f"{0.1 * n},{n},{n * n}" for n in range(21)))
    text = LOADS[: LOADS.index("[[loads.force]]")] + LOADS[LOADS.index("[run]") :]
    text = text.replace(
        "[run]",
        '[[loads.force]]\nkind = "tabulated"\nfile = "axles.csv"\ncolumn = 2\n'
        '[[loads.force]]\nkind = "random_sum"\nrms = 100.0\nlowest = 1.0\nhighest = 20.0\nseed = 3\n[run]',
    )
    force = parse_scenario(text, folder=tmp_path).run().force.values
    assert force[1000, 0] == pytest.approx(100.0)
    assert np.sqrt(np.mean(force[:, 1] ** 2)) == pytest.approx(100.0, rel=0.2)  # 2 s of 50 waves
    assert faults(text.replace("column = 2", "column = 3"), folder=tmp_path) == {
        "loads.force[0].column": "must be one of [1, 2], counted from 0, got 3"
    }


def test_a_user_vehicle_and_a_nested_track():
    text = """
[guideway.beam]
kind = "timoshenko_beam"
bending_stiffness = 6.4e6
mass = 60.2
shear_stiffness = 2.5e8
rotary_inertia = 0.24
[guideway.foundation]
kind = "on_mass"
mass = 250.0
above = {kind = "spring", stiffness = 3e8, damping = 3e4}
below = {kind = "shear_layer", stiffness = 1e8, damping = 8e4, shear_stiffness = 1e6}
[vehicle]
kind = "vehicle"
mass = [[900.0]]
damping = [[0.0]]
stiffness = [[0.0]]
contact_map = [[1.0]]
vertical = [1.0]
dof_names = ["wheel"]
[[vehicle.contacts]]
position = 0.0
stiffness = 1e8
damping = 1e4
[roughness]
kind = "harmonic"
amplitude = 1e-5
wavelength = 1.0
[run]
speed = 30.0
duration = 1.0
"""
    result = parse_scenario(text).run()
    assert list(result.dof.values) == ["wheel"]
    assert result.static_load.item() == pytest.approx(900 * 9.81)


FULL_CAR = """
[vehicle]
kind = "full_car"
body_mass = 840.0
pitch_inertia = 1100.0
roll_inertia = 820.0
wheel_masses = [53.0, 76.0]
suspension_stiffness = [1.0e4, 1.3e4]
suspension_damping = [900.0, 900.0]
tyre_stiffness = [2.0e5, 2.0e5]
axles = [1.4, -1.47]
sides = [0.7, -0.75]

"""


def four_wheels(seeds, **changes):
    """Write the template with a full car, and with seeds."""
    text = edited(seed=seeds, duration=2.0, **changes)
    return text[: text.index("[vehicle]")] + FULL_CAR.lstrip() + text[text.index("[roughness]") :]


def test_a_full_car_and_a_seed_for_each_path():
    """Two paths without anything in common, each the one of its seed; equal seeds make one road of both."""
    scenario = parse_scenario(four_wheels("[0, 1]"))
    assert scenario.case.vehicle.dof_names[:3] == ("bounce", "pitch", "roll")
    profile = scenario.case.road.profile
    assert profile.paths == 2
    assert scenario.case.road.description.endswith("seed [0, 1]")
    for path, seed in enumerate((0, 1)):
        alone = parse_scenario(four_wheels(f"[{seed}, {seed}]")).case.road.profile
        assert (alone.elevation[:, 0] == alone.elevation[:, 1]).all()
        assert (profile.elevation[:, path] == alone.elevation[:, 0]).all()
    # Long waves are few; by their slopes they are strangers.
    assert abs(np.corrcoef(np.diff(profile.elevation, axis=0).T)[0, 1]) < 0.2
    # One seed in a list is one path, the same as without a list.
    one, listed = (parse_scenario(edited(seed=seed)).case.road.profile for seed in ("1", "[1]"))
    assert listed.paths == 1
    assert (np.ravel(listed.elevation) == np.ravel(one.elevation)).all()
    result = scenario.run()
    direct = mf.simulate(
        scenario.guideway, scenario.case.vehicle, profile, speed=10.0, duration=2.0, truncation=70.0
    ).drop_attrs()
    assert result.drop_attrs().identical(direct)
    assert np.abs(result.motion.sel(dof="roll")).max() > 1e-5
    same = parse_scenario(four_wheels("[1, 1]")).run()
    with pytest.warns(
        mf.ValidityWarning, match="the profile is known along one path, but contacts travel on 2 side"
    ):
        single = parse_scenario(four_wheels("1")).run()
    assert np.abs(same.motion.sel(dof="roll")).max() < 0.1 * np.abs(result.motion.sel(dof="roll")).max()
    # A single seed makes one road for all of the width.
    assert (same.contact_force.values == single.contact_force.values).all()


@pytest.mark.parametrize(
    ("seeds", "name", "message"),
    [
        ("[]", "roughness.seed", "must be a whole number, or one for each path, got an empty list"),
        ("[0, -1]", "roughness.seed", "must be a whole number of at least 0, got -1"),
        ("[0, 1.5]", "roughness.seed", "must be a whole number of at least 0, got 1.5"),
        ('[0, "one"]', "roughness.seed", "must be a whole number"),
        ("[[0, 1]]", "roughness.seed", "must be a whole number"),
        ("true", "roughness.seed", "must be a whole number"),
        ("[4]", "roughness:", "a contact follows path 1, but the profile has 1 path"),
    ],
)
def test_impossible_seeds(seeds, name, message):
    assert message in faults(four_wheels(seeds))[name]


@pytest.mark.parametrize(
    ("old", "new", "name", "message"),
    [
        ("roll_inertia = 820.0", "roll_inertia = 0", "vehicle.roll_inertia", "must be positive, got 0.0 kg m²"),
        ("roll_inertia = 820.0\n", "", "vehicle.roll_inertia", "is missing"),
        ("sides = [0.7, -0.75]", "sides = [-0.7, 0.75]", "vehicle.sides", "left wheels left of the right ones"),
        ("sides = [0.7, -0.75]", "sides = [0.7, 0.7]", "vehicle.sides", "got [0.7, 0.7] m"),
        ("sides = [0.7, -0.75]", "sides = 0.7", "vehicle.sides", "must be two numbers"),
        ("axles = [1.4, -1.47]", "axles = [-1.4, 1.4]", "vehicle.axles", "front axle ahead of the rear one"),
        ("axles = [1.4, -1.47]", "axles = [1.4, inf]", "vehicle.axles[1]", "must be a finite number"),
    ],
)
def test_impossible_full_cars(old, new, name, message):
    assert message in faults(four_wheels("[0, 1]").replace(old, new))[name]


def test_all_faults_at_once():
    text = edited(mass=-1, stiffness="nan", speed=None, seed=1.5, axles="[1.0]", wheel_masses='"x"', band="[1.0]")
    found = faults(text.replace("duration", "durration").replace('"half_car"', '"half_car"\nmas = 1'))
    assert set(found) == {
        "guideway.beam.mass",
        "guideway.foundation.stiffness",
        "vehicle.mas",
        "vehicle.wheel_masses",
        "vehicle.axles",
        "roughness.band",
        "run.durration",
        "run.duration",
        "run.speed",
    }
    assert found["guideway.beam.mass"] == "must be positive, got -1.0 kg/m"
    assert "did you mean 'duration'?" in found["run.durration"]


@pytest.mark.parametrize(
    ("changes", "name", "message"),
    [
        ({"bending_stiffness": 0}, "guideway.beam.bending_stiffness", "must be positive, got 0.0 N m²"),
        ({"bending_stiffness": "1e300"}, "guideway.beam.bending_stiffness", "credible magnitude"),
        ({"bending_stiffness": "true"}, "guideway.beam.bending_stiffness", "must be a positive number"),
        ({"damping": -1}, "guideway.foundation.damping", "must not be negative, got -1.0 N s/m²"),
        ({"body_mass": "inf"}, "vehicle.body_mass", "got inf kg"),
        ({"tyre_stiffness": "[1e6, 0.0]"}, r"vehicle.tyre_stiffness[1]", "must be positive, got 0.0 N/m"),
        ({"axles": "[-2.0, 2.0]"}, "vehicle.axles", "front axle ahead of the rear one"),
        ({"speed": 0}, "run.speed", "must be positive, got 0.0 m/s"),
        ({"time_step": -0.001}, "run.time_step", "must be positive, got -0.001 s"),
        ({"duration": 0.0001}, "run.duration", "at least two time steps"),
        ({"truncation": -1}, "run.truncation", "must not be negative, got -1.0 Hz"),
        ({"duration": "1e9"}, "run:", "GiB of memory"),
        ({"road_class": '"Q"'}, "roughness.road_class", "must be one of A, B, C, D, E, F, G, H, got 'Q'"),
        ({"road_class": None}, "roughness.road_class", "needed"),
        ({"waviness": '"two"'}, "roughness.waviness", "must be a finite number"),
        ({"waviness": "1e9"}, "roughness.waviness", "must lie within ±10"),
        ({"seed": "0\nstep = 0.2"}, "roughness.step", "half of the shortest wave"),
        ({"seed": "0\nstep = 1e-9"}, "roughness:", "GiB of memory"),
        ({"seed": -1}, "roughness.seed", "whole number"),
        ({"kind": "3"}, "guideway.kind", "must be one of track, rigid_guideway, "),
    ],
)
def test_impossible_values(changes, name, message):
    assert message in faults(edited(**changes))[name]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "is empty"),
        ("# only a comment\n", "is empty"),
        ("a = ", "is not TOML"),
        ("x = 1", "is not known here"),
        ("guideway = 3", "must be a table"),
        ("[vehicle]\nkind = 'vehicle'\ncontacts = 3", "must be one or more tables"),
    ],
)
def test_texts_that_are_no_scenario(text, message):
    assert any(message in found for found in faults(text).values())


def test_files_that_are_no_scenario(tmp_path):
    for content, message in [(bytes(range(256)), "not a text file"), (b"", "is empty"), (None, "No such file")]:
        file = tmp_path / f"{message.split()[0]}.toml"
        if content is not None:
            file.write_bytes(content)
        with pytest.raises(mf.ScenarioError, match=message):
            mf.read_scenario(file)
    with pytest.raises(mf.ScenarioError, match="cannot be read"):
        mf.read_scenario(tmp_path)


@pytest.mark.parametrize(
    ("text", "name", "message"),
    [
        (LOADS.replace("ramp = 0.2", 'ramp = "x"'), "loads.force[0].ramp", "got 'x'"),
        (LOADS.replace("switch_off = 1.5", "switch_off = 0.1"), "loads.force[1].switch_off", "leave time"),
        (LOADS[: LOADS.index("[[loads.force]]")] + LOADS[LOADS.index("[run]") :], "loads.force", "is missing"),
        (LOADS.replace("duration = 2.0", "duration = 1e9"), "run:", "GiB of memory"),
        (LOADS.replace("observe = [0.0, 1.0, -2.5]", 'observe = ["1", "2"]'), "loads.observe", "array of numbers"),
        (LOADS.replace("observe = [0.0, 1.0, -2.5]", "observe = [true]"), "loads.observe", "array of numbers"),
        (
            LOADS_TEMPLATE.replace("count = 50", "count = 1000000000"),
            "loads.force[1].count",
            "must be at most 100000",
        ),
        (LOADS + "\n[vehicle]\n", "vehicle", "exclude each other"),
        (edited(speed="9" * 400), "run.speed", "got inf m/s"),
        (edited(speed="9" * 5001), "the text", "is not TOML"),
        (
            TEMPLATE[: TEMPLATE.index("[roughness]")]
            + '[roughness]\nkind = "profile"\n[run]\nspeed = 1.0\nduration = 1.0',
            "roughness.file",
            "is missing",
        ),
    ],
)
def test_more_impossible_scenarios(text, name, message):
    assert message in faults(text)[name]


def test_a_byte_order_mark_is_no_fault(tmp_path):
    (tmp_path / "a.toml").write_bytes(TEMPLATE.encode("utf-8-sig"))
    assert mf.read_scenario(tmp_path / "a.toml").journey.speed == 10.0


def test_a_profile_shorter_than_the_journey(tmp_path):
    (tmp_path / "short.csv").write_text("\n".join(f"{x},0.0" for x in range(100)))
    text = TEMPLATE[: TEMPLATE.index("[roughness]")] + '[roughness]\nkind = "profile"\nfile = "short.csv"\n'
    text += TEMPLATE[TEMPLATE.index("[run]") :]
    assert faults(text, folder=tmp_path) == {
        "roughness:": "the profile must cover the journey from -2.05387 m to 242.216 m, "
        "but it reaches from 0 m to 99 m: the journey is 145.27 m too long"
    }
    missing = faults(text.replace("short.csv", "none.csv"), folder=tmp_path)
    assert "No such file" in missing["roughness:"]


values = st.one_of(
    st.sampled_from(
        ["nan", "-inf", "1e300", "-1", "0", '""', "[]", "[[1]]", "{}", "true", "1979-05-27", '"A"', "[1, 2]"]
    ),
    st.floats(allow_nan=False, allow_infinity=False).map(repr),
)
keys = st.sampled_from(
    [line.split("=")[0].strip() for line in TEMPLATE.splitlines() if "=" in line and line[0] != "#"]
)


@settings(max_examples=150, deadline=None, derandomize=True)
@given(st.dictionaries(keys, values, min_size=1, max_size=3), st.integers(0, len(TEMPLATE)))
def test_nonsense_is_refused_and_never_a_defect(changes, cut):
    """Whatever a scenario says, it is built or refused with a ScenarioError."""
    for text in (edited(**changes), TEMPLATE[:cut]):
        try:
            parse_scenario(text)
        except mf.ScenarioError as error:
            assert error.faults  # noqa: PT017


def test_every_kind_is_reachable_and_names_its_arguments():
    for family in TABLES.values():
        for name, kind in family.kinds.items():
            assert name == kind.name
            assert callable(kind.make)
            assert kind.words, name
            for key in kind.keys:
                assert key.words, (name, key.name)
                assert (key.type in TABLES) + (key.item in TABLES) + key.is_file <= 1, (name, key.name)


def test_each_of_several_keys_has_its_own_unit():
    """One docstring line may say two arguments: `primary_stiffness, primary_damping : float`, [N/m, N s/m]."""
    units = {key.name: key.unit for key in TABLES[mf.Vehicle].kinds["bogie"].keys}
    assert (units["primary_stiffness"], units["primary_damping"]) == ("N/m", "N s/m")
    assert (units["secondary_stiffness"], units["frame_mass"]) == ("N/m", "kg")


def test_keys_say_what_the_signature_says():
    keys = {key.name: key for key in TABLES[mf.Vehicle].kinds["truck"].keys}
    assert keys["units"].needed
    assert keys["units"].item in TABLES
    assert not keys["sides"].needed
    assert keys["sides"].type == tuple[float, float]  # None is the default, no value
    assert keys["hitches"].default == ()
    assert [key.name for kind in DRIVE["run"].kinds.values() for key in kind.keys if not key.needed] == [
        "speed",
        "speed_kmh",
        "start",
        "time_step",
        "truncation",
        "blend",
        "solved_step",
    ]

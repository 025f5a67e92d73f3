"""Sampled guideways in files and scenarios, and what `check` says of roads without a moving FRF in closed form."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.io import savemat

import movingfrf as mf
from movingfrf.commands.main import main
from movingfrf.scenarios.reading import parse_scenario

TIME = 1e-3 * np.arange(2000)
# A massless road on springs and dashpots, seen from two places; the sizes differ so that columns are told apart.
RECORD = mf.SampledGuideway(
    response=np.exp(-40.0 * TIME)[:, None] * [4e-7, 1e-7, 2e-7],
    time_step=1e-3,
    offsets=[0.0, 2.0, -2.0],
    speed=10.0,
    critical_speed=150.0,
)
WIDE = mf.SampledGuideway(
    response=np.exp(-40.0 * TIME)[:, None] * [4e-7, 1e-7],
    time_step=1e-3,
    offsets=[0.0, 0.0],
    across=[0.0, -1.5],
    source_across=[0.75, 0.75],
    speed=10.0,
)

CASE = """
[guideway]
kind = "sampled_guideway"
file = "road.npz"
[vehicle]
kind = "quarter_car"
body_mass = 8900.0
wheel_mass = 1100.0
suspension_stiffness = 1.5e6
suspension_damping = 3e4
tyre_stiffness = 3.5e6
[roughness]
kind = "harmonic"
amplitude = 1e-3
wavelength = 4.0
[run]
speed = 10.0
duration = 1.0
"""
LOADS = (
    CASE[: CASE.index("[vehicle]")]
    + "[loads]\npositions = [0.0]\nobserve = [0.0, -2.0]\n"
    + '[[loads.force]]\nkind = "constant"\nforce = 1e5\nramp = 0.2\n'
    + CASE[CASE.index("[run]") :]
)


def values(guideway):
    return {
        name: getattr(guideway, name)
        for name in ("response", "time_step", "offsets", "speed", "across", "source_across", "critical_speed")
    }


@pytest.mark.parametrize("ending", [".npz", ".mat"])
@pytest.mark.parametrize("guideway", [RECORD, WIDE], ids=["narrow", "wide"])
def test_what_is_written_is_read(guideway, ending, tmp_path):
    file = tmp_path / f"road{ending}"
    mf.write_sampled_guideway(guideway, file)
    found = values(mf.read_sampled_guideway(file))
    for name, value in values(guideway).items():
        assert type(found[name]) is type(value), name
        assert np.array_equal(np.asarray(found[name]), np.asarray(value)), name


def test_one_offset_is_read(tmp_path):
    alone = mf.SampledGuideway(response=RECORD.samples[:, :1], time_step=1e-3, offsets=[0.0], speed=10.0)
    mf.write_sampled_guideway(alone, tmp_path / "road.mat")
    assert mf.read_sampled_guideway(tmp_path / "road.mat").samples.shape == (2000, 1)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"response": None}, "response is missing"),
        ({"speed": None}, "speed is missing"),
        ({"spead": 10.0}, "spead is not known; a sampled guideway consists of response, time_step, "),
        ({"time_step": [1e-3, 2e-3]}, "time_step must be one number, got 2"),
        ({"time_step": -1e-3}, "time_step must be positive, got -0.001 s"),
        ({"offsets": [0.0, 1.0]}, r"response must have shape \(any, 2\), got \(2000, 3\)"),
        ({"response": RECORD.samples * 1j}, "response must be an array of numbers"),
        ({"across": [0.0, 1.0, 2.0]}, "across and source_across must be given both or neither"),
    ],
)
def test_impossible_files(changes, message, tmp_path):
    file = tmp_path / "road.npz"
    whole = {name: value for name, value in values(RECORD).items() if value is not None} | changes
    np.savez(file, **{name: value for name, value in whole.items() if value is not None})
    with pytest.raises(ValueError, match=f"road.npz: {message}"):
        mf.read_sampled_guideway(file)


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("road.csv", b"", r"road.csv: a sampled guideway is read from .mat, .npz, not from .csv"),
        ("road.npz", b"nonsense", r"road.npz: is damaged, or no NumPy file"),
        ("road.mat", b"nonsense", r"road.mat: is no MATLAB file of version 5"),
        ("road.mat", b"MATLAB 7.3", r"road.mat: is a MATLAB 7.3 file; save it with -v7"),
        ("road.npz", None, r"cannot read .*road.npz: No such file"),
    ],
)
def test_files_that_hold_none(name, content, message, tmp_path):
    if content is not None:
        (tmp_path / name).write_bytes(content)
    with pytest.raises(ValueError, match=message):
        mf.read_sampled_guideway(tmp_path / name)


def test_another_ending_is_not_written(tmp_path):
    with pytest.raises(ValueError, match=r"road.csv: a sampled guideway is written to .mat or .npz, not to .csv"):
        mf.write_sampled_guideway(RECORD, tmp_path / "road.csv")


def test_a_scenario_runs_on_a_record_from_matlab(tmp_path):
    """As MATLAB stores it: numbers as matrices of one, offsets in a row."""
    record = {"response": RECORD.samples, "time_step": 1e-3, "offsets": RECORD.offsets[None, :], "speed": 10.0}
    savemat(tmp_path / "road.mat", record)
    scenario = parse_scenario(CASE.replace("road.npz", "road.mat"), folder=tmp_path)
    drive = scenario.case
    direct = mf.simulate(RECORD, drive.vehicle, drive.road.profile, speed=10.0, duration=1.0)
    np.testing.assert_array_equal(scenario.run().contact_force.values, direct.contact_force.values)


def test_loads_on_a_record_are_those_that_python_takes(tmp_path):
    mf.write_sampled_guideway(RECORD, tmp_path / "road.npz")
    scenario = parse_scenario(LOADS, folder=tmp_path)
    direct = mf.moving_loads(RECORD, scenario.case.forces, [0.0], speed=10.0, observe=[0.0, -2.0])
    wanted = direct.deflection.values
    np.testing.assert_allclose(scenario.run().deflection.values, wanted, atol=1e-5 * np.abs(wanted).max())


@pytest.mark.parametrize(
    ("text", "name", "message"),
    [
        (CASE.replace("speed = 10.0", "speed = 20.0"), "run:", "speed must be 10.0 m/s, at which the impulse"),
        (
            LOADS.replace("[0.0, -2.0]", "[0.0, -3.0]"),
            "guideway:",
            "the recorded offsets [0.0, 2.0, -2.0] m",
        ),
        (CASE.replace("road.npz", "rode.npz"), "guideway:", "No such file"),
        (CASE.replace('file = "road.npz"', ""), "guideway.file", "is missing"),
    ],
)
def test_what_was_not_recorded_is_refused_at_once(text, name, message, tmp_path):
    mf.write_sampled_guideway(RECORD, tmp_path / "road.npz")
    with pytest.raises(mf.ScenarioError) as caught:
        parse_scenario(text, folder=tmp_path)
    (fault,) = caught.value.faults
    assert (fault.name, message in fault.message) == (name, True), fault


FINITE = """
[guideway]
kind = "finite_plate"
width = 3.0
first = -5.0
last = 15.0
across = 3
ends = "pinned"
track = {beam = {kind = "euler_bernoulli_beam", bending_stiffness = 4.719e7, mass = 2135.7}, foundation = \
{kind = "spring", stiffness = 2.4e7, damping = 9e4}}
""" + CASE[CASE.index("[vehicle]") :]


def test_check_describes_what_has_no_closed_form(tmp_path, capsys):
    mf.write_sampled_guideway(RECORD, tmp_path / "road.npz")
    track = FINITE.replace("finite_plate", "finite_track").replace("width = 3.0\n", "").replace("across = 3\n", "")
    for text, words in (
        (CASE, ["SampledGuideway", "150 m/s, of which the speed is 0.0667", "Contacts in steady travel"]),
        (
            FINITE,
            [
                "finite road, not the same everywhere: no moving FRF, no critical speed",
                "20 m, from -5 m to 15 m",
                "3 m",
                "40 along, of 0.5 m",
                "Contacts at rest",
                "movingfrf run FILE --method cdfm or sim",
            ],
        ),
        (track, ["80 along, of 0.25 m", "Contacts at rest"]),
        (
            LOADS.replace('kind = "sampled_guideway"\nfile = "road.npz"\n', track[11 : track.index("[vehicle]")]),
            ["80 along", "movingfrf run FILE --method newmark"],
        ),
    ):
        file = tmp_path / "case.toml"
        file.write_text(text, encoding="utf-8")
        assert main(["check", str(file)]) == 0
        told = capsys.readouterr().out
        for word in words:
            assert word in told, told


def test_plain_run_of_a_finite_road_is_refused_with_advice(tmp_path, capsys):
    file = tmp_path / "case.toml"
    file.write_text(FINITE, encoding="utf-8")
    assert main(["run", str(file)]) == 2
    assert "`movingfrf run FILE --method cdfm`" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
    rough = 'kind = "iso_road"\nroad_class = "A"'
    file.write_text(
        FINITE.replace('kind = "harmonic"\namplitude = 1e-3\nwavelength = 4.0', rough), encoding="utf-8"
    )
    assert main(["random", str(file)]) == 2
    assert "guideway is a finite road" in capsys.readouterr().err


def test_a_journey_off_a_finite_road_is_refused_at_once(tmp_path):
    with pytest.raises(mf.ScenarioError, match=r"guideway: road must reach from 0 m to 20 m, .* from -5 m to 15 m"):
        parse_scenario(FINITE.replace("duration = 1.0", "duration = 2.0"))

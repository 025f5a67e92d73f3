"""What is said: findings once and in the right words, what is absurd, one of a thing, lines that fit a terminal."""

from __future__ import annotations

import json
import os
import re
import struct
import subprocess
import sys
import warnings
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import movingfrf as mf
from movingfrf._basics.wording import Standing, count, in_both_units
from movingfrf.commands.console import _head, _pieces, wrapped
from movingfrf.commands.main import main
from movingfrf.reports.tables import Column
from movingfrf.results.findings import contact_lost
from movingfrf.results.labels import contacts_in_words
from movingfrf.scenarios.description import described
from movingfrf.scenarios.reading import parse_scenario
from movingfrf.scenarios.scenario import Drive, ScenarioError
from movingfrf.scenarios.template import template
from movingfrf.scenarios.unusual import USUAL, unusual
from movingfrf.vehicles.catalogue import CATALOGUE
from movingfrf.vehicles.journey import Journey
from tests.faults.fault import ROOT
from tests.test_schema import IN_ORDER

TRUCK, LOADS = template("scenario"), template("loads")
TRAIN = (ROOT / "examples" / "train.toml").read_text(encoding="utf-8")


# Findings of several contacts.


def rolling(vehicle, amplitude, **journey):
    """Travel over waves that lift every wheel."""
    rough = mf.harmonic(amplitude=amplitude, wavelength=4.0, length=250.0, start=-100.0)
    with warnings.catch_warnings(record=True):
        warnings.simplefilter("always")
        result = mf.simulate(mf.RigidGuideway(), vehicle, rough, speed=30.0, duration=2.0, blend=0.0, **journey)
    return [finding for finding in json.loads(result.attrs["findings"]) if finding["code"] == "contact_lost"]


def hertzian_coach():
    coach = mf.catalogue("velaro_coach")
    return replace(coach, contacts=[replace(contact, stiffness=2.4e9) for contact in coach.contacts])


def test_a_train_that_lifts_off_is_said_once_with_names_and_rails():
    (finding,) = rolling(mf.train(hertzian_coach(), 3, spacing=24.775), 0.05, start=60.0)
    assert finding["message"].startswith(
        "contacts 0 (1 wheelset 1) to 11 (3 wheelset 4) would lift off the rail during"
    )
    assert "road" not in finding["message"]


def test_a_truck_lifts_off_the_road():
    (finding,) = rolling(mf.catalogue("half_truck"), 0.05)
    assert finding["message"].startswith("contacts 0 (front) and 1 (rear) would lift off the road during up to")
    (finding,) = rolling(mf.catalogue("golden_car"), 0.05)
    assert finding["message"].startswith("contact 0 (wheel) would lift off the road during ")


@pytest.mark.filterwarnings("ignore:.*of the variance of a contact force")
def test_a_random_road_says_it_once_too():
    road = mf.IsoRoad(0.02, band=(0.02, 2.0))
    with pytest.warns(
        mf.ValidityWarning, match="contacts 0 .1 wheelset 1. to 7 .2 wheelset 4. would lift off the rail"
    ):
        mf.random_response(mf.RigidGuideway(), mf.train(hertzian_coach(), 2, spacing=24.775), road, speed=40.0)


@pytest.mark.parametrize(
    ("names", "numbers", "said"),
    [
        (["front", "rear"], [1], "contact 1 (rear)"),
        (["front", "rear"], [0, 1], "contacts 0 (front) and 1 (rear)"),
        ([""] * 64, range(64), "contacts 0 to 63"),
        ([""] * 64, [0, 2, 4], "contacts 0, 2 and 4"),
        ([""] * 64, range(0, 64, 2), "contacts 0, 2, 4 and 29 more"),
    ],
)
def test_contacts_by_name(names, numbers, said):
    assert Standing(names).listed(list(numbers)) == said


def test_share_and_instant_are_those_of_the_worst_and_the_first():
    force = np.array([[1.0, 1.0], [1.0, -1.0], [-1.0, -1.0], [1.0, 1.0]])
    (finding,) = contact_lost(force, 0.5, Standing(["", ""]))
    assert "during up to 50.00% of the time, first at 0.500 s" in finding.message
    assert contact_lost(np.ones((3, 2)), 0.5, Standing(["", ""])) == []


def test_findings_about_a_railway_know_no_road():
    """Whatever can be found of a coach on a track, in steps, on grades and up to a truncation."""
    track = mf.track(mf.EulerBernoulliBeam(1.284e7, 120.4), mf.Spring(2e7, 1e3))
    stations = np.arange(-40.0, 200.0, 0.1)
    rough = mf.Profile(stations, 0.02 * stations + 1e-4 * np.sign(np.sin(stations)) + 1e-3)
    found = set()
    coach, wheels = hertzian_coach(), mf.wheelset(1800.0)
    for vehicle, blend, truncation in ((coach, 5.0, 5.0), (coach, 0.0, None), (wheels, 0.0, None)):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            result = mf.simulate(
                track, vehicle, rough, speed=60.0, duration=1.0, blend=blend, truncation=truncation
            )
        for finding in json.loads(result.attrs["findings"]):
            found.add(finding["code"])
            assert "road" not in finding["message"]
    assert {"contact_lost", "grade", "unresolved", "beyond_truncation"} <= found


# What is absurd.


def said_of(text, **kept):
    scenario = parse_scenario(text, folder=ROOT / "examples", **kept)
    return [finding.message for finding in scenario.case.unusual]


def everything_in_order():
    yield from ((name, text) for name, text in IN_ORDER.items() if "file =" not in text)
    yield from (("template", TRUCK), ("loads", LOADS))
    for folder in (ROOT / "examples", ROOT / "src" / "movingfrf" / "studies" / "paper" / "scenarios"):
        for path in folder.glob("*.toml"):
            if "file =" not in (text := path.read_text(encoding="utf-8")):
                yield path.name, text


@pytest.mark.parametrize(("name", "text"), [*everything_in_order()])
def test_nothing_is_unusual_about_what_is_in_order(name, text):
    assert said_of(text) == []


@pytest.mark.parametrize("name", CATALOGUE)
def test_nothing_is_unusual_about_the_catalogue(name):
    for vehicle in (mf.catalogue(name), mf.convoy([mf.catalogue(name)] * 2, gaps=250.0)):
        assert unusual(mf.RigidGuideway(), Journey(speed=20.0, duration=1.0), vehicle=vehicle) == []


ABSURD = [
    ("speed = 10.0", "speed = 720.0", "4.06 times the critical one of 177.5 m/s, usual is less than 4 times"),
    ("speed = 10.0", "speed = 80.0", "with 100 kN on an axle is 80 m/s, usual is 0.1 to 40 m/s: it is 288 km/h;"),
    ("speed = 10.0", "speed = 0.01", "on an axle is 0.01 m/s"),
    ("time_step = 0.001", "time_step = 1.0", "the step in time is 1 s, usual is 1 × 10⁻⁷ to 0.05 s"),
    ("body_mass = 17735.0", "body_mass = 17.735", "mass on springs, 17.73 kg, over that of the wheels, 2500 kg,"),
    ("wheel_masses = [1500.0, 1000.0]", "wheel_masses = [1.5, 1.0]", "over that of the wheels, 2.500 kg, is 7094"),
    ("axles = [2.21613, -2.05387]", "axles = [110.0, -110.0]", "from its first contact to its last is 220 m"),
    ("axles = [2.21613, -2.05387]", "axles = [0.0022, -0.0021]", "to its last is 0.0043 m, usual is 0.2 to 60 m"),
    ("stiffness = 8.0e6", "stiffness = 8.0e3", "the stiffness of the foundation is 8000 N/m²"),
    ("stiffness = 8.0e6", "stiffness = 2.0e5", "the sag under 100 kN at rest is 0.05942 m, usual is 1 × 10⁻⁷ to"),
    ("bending_stiffness = 1.573e7", "bending_stiffness = 1.573e4", "bending stiffness of the beam is 15730 N m²"),
    ("mass = 711.9", "mass = 0.7119", "the mass of the beam is 0.7119 kg/m, usual is 1 to 100000 kg/m"),
    ("damping = 3.0e4", "damping = 3.0e7", "the damping of the foundation, over the critical one, is 198.8"),
    ("tyre_stiffness = [3.74e6, 4.6e6]", "tyre_stiffness = [3740.0, 4600.0]", "compresses the spring of contact 0"),
    ("suspension_stiffness = [2.47e6, 4.23e6]", "suspension_stiffness = [2470.0, 4230.0]", "slowest vibration"),
    ("suspension_stiffness = [2.47e6, 4.23e6]", "suspension_stiffness = [2.47e9, 4.23e9]", "fastest vibration"),
    ("suspension_damping = [3.0e4, 4.0e4]", "suspension_damping = [3.0e7, 4.0e7]", "is 0.0131 Hz, usual is 0.1 to"),
    ("pitch_inertia = 1.47e5", "pitch_inertia = 147.0", "the fastest vibration of the vehicle is 331.3 Hz"),
    ("suspension_damping = [3.0e4, 4.0e4]", "suspension_damping = [30.0, 40.0]", "the best damped vibration"),
    ('road_class = "A"', "roughness = 16.0", "slope is"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "words"), ABSURD)
def test_what_is_absurd_is_said_and_not_refused(old, new, words):
    if old not in TRUCK:
        old = next(line for line in TRUCK.splitlines() if line.startswith(old.split(" = ")[0] + " = ")).partition(
            "#"
        )[0]
    assert old in TRUCK
    messages = said_of(TRUCK.replace(old, new + "  "))
    assert any(words in message for message in messages), messages
    assert all("usual is" in message for message in messages)


def test_more_that_is_absurd():
    journey = Journey(speed=20.0, duration=1.0)
    coach, road = mf.catalogue("velaro_coach"), mf.RigidGuideway()
    light = mf.carriage(
        body_mass=32.0, body_pitch_inertia=1.97e3, bogie_mass=2.6, bogie_pitch_inertia=1.5, wheelset_mass=1.8,
        primary_stiffness=2.4e3, primary_damping=8.0, secondary_stiffness=860.0, secondary_damping=40.0,
        bogie_spacing=19.0, axle_spacing=2.56,
    )  # fmt: skip
    for given, words in (
        ({"vehicle": light}, "the smallest static load, that of contact 0 (wheelset 1), is 108.9 N"),
        ({"profile": mf.Profile(np.arange(9.0), 3.0 * (np.arange(9.0) % 2))}, "are elevations in m?"),
        (
            {"forces": np.array([[5.1e6]])},
            "the largest prescribed force is 5.1 × 10⁶ N, usual is at most 5 × 10⁶ N",
        ),
    ):
        assert words in " ".join(finding.message for finding in unusual(road, journey, **given))
    for wrong, words in (
        (Journey(speed=171.0, duration=1.0), "usual is 0.1 to 140 m/s"),
        (Journey(speed=1.0, duration=1e6), "the duration is 1 × 10⁶ s, usual is 0.001 to 36000 s"),
    ):
        assert words in " ".join(finding.message for finding in unusual(road, wrong, vehicle=coach))
    car = mf.catalogue("passenger_car")
    assert unusual(road, Journey(speed=69.0, duration=1.0), vehicle=car) == []
    said = [one.message for one in unusual(road, Journey(speed=80.0, duration=1.0), vehicle=car)]
    assert said == ["the speed is 80 m/s, usual is 0.1 to 70 m/s: it is 288 km/h; `speed_kmh` takes km/h"]
    loose = mf.half_car(
        body_mass=730.0, pitch_inertia=1230.0, wheel_masses=(40.0, 35.5), suspension_stiffness=(2e4, 1.8e4),
        suspension_damping=(1.3, 1e3), tyre_stiffness=(1.75e5, 1.75e5), axles=(1.01, -1.8),
    )  # fmt: skip
    (one,) = unusual(road, journey, vehicle=loose)
    assert one.message.startswith(
        "the worst damped vibration of the vehicle has 0.024 % of critical damping, usual is"
    )
    layered = mf.track(mf.EulerBernoulliBeam(1.3e7, 120.0), mf.OnMass(mf.Spring(6e8), 0.5, mf.Spring(2e11)))
    said = " ".join(finding.message for finding in unusual(layered, journey))
    assert "the mass of a layer is 0.5 kg/m" in said
    assert "the stiffness of the foundation is 2 × 10¹¹ N/m²" in said
    wire = mf.track(mf.TensionedBeam(mf.EulerBernoulliBeam(150.0, 1.35), 2e4), mf.Spring(1e4, 10.0))
    assert unusual(wire, journey) == []


@pytest.mark.filterwarnings("ignore:the guideway counts as rigid", "ignore:.*of the root mean square of")
def test_check_and_run_both_say_it():
    scenario = parse_scenario(
        TRUCK.replace("speed = 10.0", "speed = 101.0").replace("duration = 24.0", "duration = 0.2")
    )
    assert isinstance(scenario.case, Drive)
    (message,) = (finding.message for finding in scenario.case.unusual)
    assert message in described(scenario).remarks
    with pytest.warns(mf.ValidityWarning, match="usual is 0.1 to 40 m/s"):
        result = scenario.run()
    assert message in [f["message"] for f in json.loads(result.attrs["findings"]) if f["code"] == "unusual"]


def test_ranges_are_ranges():
    for name in USUAL.__slots__:
        value = getattr(USUAL, name)
        assert value > 0 if isinstance(value, float) else value[0] < value[1]


# Numbers and things as people write them.


@pytest.mark.parametrize(
    ("speed", "in_kmh", "words"),
    [
        (69.4444, False, ("69.4444 m/s", "250 km/h")),  # 249.99984
        (33.333, False, ("33.333 m/s", "120 km/h")),
        (10.0, False, ("10 m/s", "36 km/h")),
        (250 / 3.6, True, ("250 km/h", "69.44 m/s")),
        (249.99984 / 3.6, True, ("249.99984 km/h", "69.44 m/s")),
        (0.5, False, ("0.5 m/s", "1.8 km/h")),
    ],
)
def test_a_speed_in_the_other_unit_is_rounded(speed, in_kmh, words):
    assert in_both_units(speed, in_kmh=in_kmh) == words


def test_one_of_a_thing():
    assert (count(1, "path"), count(2, "path"), count(0, "gap")) == ("1 path", "2 paths", "0 gaps")
    short, car = mf.Profile(np.arange(50.0), np.zeros((50, 1))), mf.on_paths(mf.catalogue("golden_car"), [1])
    with pytest.raises(ValueError, match="but the profile has 1 path, counted from 0"):
        mf.simulate(mf.RigidGuideway(), car, short, speed=1.0, duration=9.0)


def test_no_message_counts_one_in_the_plural():
    """`path(s)` is neither the one nor the other."""
    source = ROOT / "src" / "movingfrf"
    found = {
        path.name for path in source.rglob("*.py") if re.search(r"\w\(s\)[ ,.;]", path.read_text(encoding="utf-8"))
    }
    assert found == set()


# A terminal of 80 letters.


def test_sentences_break_between_words():
    text = "- a sentence of some words with 4300 N s/m in it and a/path/that/is/longer/than/the/line/it/stands/in"
    lines = wrapped(text, 40).split("\n")
    assert lines[1].startswith("  ")
    assert all(len(line) <= 40 or "/longer/" in line for line in lines)
    assert "a/path/that/is/longer/than/the/line/it/stands/in" in " ".join(lines)
    for left, right in pairwise(lines):
        assert not left.endswith("4300")
        assert not right.lstrip().startswith("s/m")
    assert wrapped("", 40) == ""


@pytest.mark.parametrize(
    "kept", ["ISO 2631-1", "ASTM E1926", "ISO 8608", "20 s", "4300 N s/m", "1.6 × 10⁻⁵ m³", "95 %", "12 °"]
)
def test_what_belongs_together_stays_in_one_line(kept):
    for filling in range(1, 40):
        for line in wrapped(f"{'x' * filling} {kept} over", 30).split("\n"):
            assert kept in line or not set(kept.split()) & set(line.split())


def test_heads_break_between_words_and_keep_a_number_with_its_unit():
    heads = [_head(Column("impact factor (95 %)", "1")), _head(Column("weighted rms (Wk)", "m/s²"))] * 4
    pieces = _pieces(40, ["contact 0 force"], heads, [["1.0"] * 8])
    for piece in pieces:
        for column, head in piece.items():
            assert head.replace("\n", " ") == heads[column]
            assert "(95\n" not in head


def on_terminal(arguments, folder, columns=80, status=0):
    """Run a command on a terminal so many letters wide, and return its lines; of one that refuses, what it says."""
    pty = pytest.importorskip("pty")
    import fcntl
    import termios

    ours, its = pty.openpty()
    fcntl.ioctl(its, termios.TIOCSWINSZ, struct.pack("HHHH", 50, columns, 0, 0))
    environment = {**os.environ, "TERM": "xterm", "COLUMNS": str(columns)}
    command = [sys.executable, "-m", "movingfrf", *arguments]
    streams = {"stderr" if status else "stdout": its, "stdout" if status else "stderr": subprocess.DEVNULL}
    with subprocess.Popen(command, **streams, cwd=folder, env=environment) as process:
        os.close(its)
        said = b""
        while True:
            try:
                said += (more := os.read(ours, 65536))
            except OSError:  # the other end is closed
                break
            if not more:
                break
    os.close(ours)
    assert process.returncode == status, said
    plain = re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", said.decode())
    return [line.rstrip("\r").rpartition("\r")[2] for line in plain.split("\n")]


@pytest.mark.skipif(sys.platform == "win32", reason="needs a pseudo-terminal")
def test_refusals_are_no_wider_than_a_terminal_either(tmp_path):
    """Between words, all faults of a file in lines of their own; where nobody reads, as they are."""
    wrong = TRUCK.replace("duration = 24.0", "duration = -1.0").replace('kind = "half_car"', 'kind = "half_truck"')
    (tmp_path / "truck.toml").write_text(wrong, encoding="utf-8")
    (tmp_path / "road.csv").write_text("distance [m],elevation [m]\n" + "".join(f"{x},\n" for x in range(99)))
    for arguments in (["check", "truck.toml"], ["profile", "road.csv"]):
        lines = on_terminal(arguments, tmp_path, status=2)
        assert max(map(len, lines)) <= 80
        whole = [sys.executable, "-m", "movingfrf", *arguments]
        plain = subprocess.run(whole, capture_output=True, text=True, cwd=tmp_path, check=False).stderr
        assert max(map(len, plain.splitlines())) > 80
        assert " ".join(lines).split() == plain.split()


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="needs a pseudo-terminal")
def test_nothing_is_wider_than_a_terminal(tmp_path):
    (tmp_path / "truck.toml").write_text(TRUCK.replace("duration = 24.0", "duration = 0.5"), encoding="utf-8")
    (tmp_path / "train.toml").write_text(TRAIN, encoding="utf-8")
    (tmp_path / "road.csv").write_text("\n".join(f"{x / 4:g},{x % 7 * 1e-3:g}" for x in range(400)))
    for arguments in (
        ["check", "truck.toml"],
        ["check", "train.toml"],
        ["run", "truck.toml", "-o", "out"],
        ["measure", "out/result.nc", "--dof", "bounce", "--slope", "4"],
        ["random", "truck.toml", "-o", "random"],
        ["vehicles"],
        ["vehicles", "passenger_car"],
        ["kinds"],
        ["kinds", "half_car"],
        ["profile", "road.csv"],
        ["compare", "truck.toml", "--methods", "moving-frf,cdfm-window", "--no-curve", "-o", "compared"],
        ["--help"],
        ["measure", "--help"],
        ["profile", "--help"],
    ):
        lines = on_terminal(arguments, tmp_path)
        assert len(lines) > 3
        wide = [line for line in lines if len(line) > 80]
        assert wide == [], arguments


def test_help_has_no_option_for_an_empty_list(capsys):
    from movingfrf.commands.main import main

    for command in ("measure", "profile", "convert", "random", "run", "compare"):
        assert main([command, "--help"]) == 0
        assert "--empty" not in capsys.readouterr().out


# Contacts by number and name, wherever they are read.

RAIL = mf.track(mf.EulerBernoulliBeam(1.573e7, 711.9), mf.Spring(8e6, 3e4))


def test_contacts_have_their_names_on_a_console(tmp_path, capsys):
    text = TRUCK.replace("duration = 24.0", "duration = 0.5").replace("time_step = 0.001", "time_step = 0.05")
    (tmp_path / "truck.toml").write_text(text, encoding="utf-8")
    assert main(["run", str(tmp_path / "truck.toml"), "--no-report", "-o", str(tmp_path / "out")]) == 0
    told = capsys.readouterr().out
    assert "contact 0 (front) force" in told
    assert "contact 1 (rear) force" in told
    assert "contact 0 force" not in told
    assert main(["measure", str(tmp_path / "out" / "result.nc"), "--slope", "4", "--contact", "1"]) == 0
    assert "contact 1 (rear) deflection" in capsys.readouterr().out
    # What programs look up stays.
    kept = json.loads((tmp_path / "out" / "summary.json").read_text(encoding="utf-8"))["measures"]
    assert {"contact 0 force", "contact 1 force"} <= {measure["quantity"] for measure in kept}


def test_contacts_have_their_names_in_findings_and_faults():
    road = mf.harmonic(amplitude=0.0002, wavelength=0.4, length=60.0, start=-20.0)
    given = {"speed": 20.0, "duration": 1.0, "time_step": 0.05}
    with pytest.warns(
        mf.ValidityWarning, match=r"square of the force of contact 0 \(wheelset 1\) lies above 10 Hz"
    ):
        mf.simulate(RAIL, mf.wheelset(1800.0), road, **given)
    with pytest.warns(mf.ValidityWarning):
        result = mf.simulate(RAIL, mf.catalogue("half_truck"), road, **given)
    assert contacts_in_words(result.isel(contact=[1])) == ["contact 1 (rear)"]
    assert contacts_in_words(result.drop_vars("contact_name")) == ["contact 0", "contact 1"]
    broken = result.copy(deep=True)
    broken.contact_force[3, 1] = float("nan")
    with pytest.raises(ValueError, match=r"contact_force nan at time 0.15 s, contact 1 \(rear\)"):
        mf.dynamic_load_coefficient(broken)


def test_contacts_have_their_names_in_captions():
    from movingfrf.reports.coupled import _deflections_figure, _forces_figure

    road = mf.realise(mf.IsoRoad.of_class("B"), 100.0, seed=1)
    result = mf.simulate(RAIL, mf.catalogue("half_truck"), road, speed=10.0, duration=2.0, start=20.0)
    for figure in (_forces_figure, _deflections_figure):
        assert re.search(r" under contact \d \((front|rear)\) at ", figure(result).caption)


@pytest.mark.parametrize("name", ["half_truck", "Manchester-Coach"])
def test_a_vehicle_of_the_catalogue_is_no_kind(name):
    known = name.lower().replace("-", "_")
    for text, place in (
        (TRUCK.replace('kind = "half_car"', f'kind = "{name}"'), "vehicle.kind"),
        (TRAIN.replace('kind = "catalogue"', f'kind = "{name}"'), "vehicle.car.kind"),
    ):
        with pytest.raises(ScenarioError) as refused:
            parse_scenario(text)
        said = str(refused.value)
        assert f"{place} must be one of " in said
        assert f'got {name!r}, which is in the catalogue: kind = "catalogue", name = "{known}"' in said

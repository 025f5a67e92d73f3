"""What samples of an impulse response show: how it begins, how it ends; and that every result says so."""

from __future__ import annotations

import json
import warnings

import numpy as np
import pytest
from scipy.special import gamma, gammainc

import movingfrf as mf
from movingfrf.commands.main import main
from tests.helpers import DAMPED, VEHICLES

SPEED = 10.0
TRACK = DAMPED["euler_bernoulli_winkler"]
LIGHT = mf.track(TRACK.beam, mf.Spring(stiffness=TRACK.foundation.stiffness, damping=3.0e3))
quietly = pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")


def moving_impulse_response(track, ahead, step, duration, finer=64):
    """Sample the response itself, by an inverse transform along ω − iη in far shorter steps."""
    dt = step / finer
    count = round(4 * duration / dt)
    eta = np.log(1e6) / (count * dt)
    omega = 2 * np.pi * np.arange(count // 2 + 1) / (count * dt) - 1j * eta
    frf = track.moving_frf(ahead, SPEED, omega)
    # Rounded off at the end, so that it does not ring.
    frf *= np.cos(0.5 * np.pi * np.clip(4 * np.arange(len(frf)) / count - 1, 0, 1))[:, None] ** 2
    response = np.fft.irfft(frf, count, axis=0) / dt * np.exp(eta * dt * np.arange(count))[:, None]
    response[0] = 0.0  # of a beam with mass
    return response[::finer][: round(duration / step) + 1]


def record(track=TRACK, ahead=(0.0,), step=1e-3, duration=1.5, **more):
    samples = moving_impulse_response(track, list(ahead), step, duration)
    return mf.SampledGuideway(response=samples, time_step=step, offsets=list(ahead), speed=SPEED, **more)


OMEGA = 2 * np.pi * np.linspace(0.0, 100.0, 201)
RATE, SWING = 20.0, 100.0
# Real part of Σ a tˢ e^{−(20 − 100 i) t}: a beam with mass begins like √t, a massless road with a jump, what is
# smeared like t.
BEGINNINGS = {
    "root": {0.5: 1.0},
    "jump": {0.0: 1.0},
    "straight": {1.0: 1.0},
    "root and more": {0.5: 1.0, 1.5: -20.0, 2.5: 300.0},
}


def swinging(terms, time):
    wave = np.exp(-(RATE - 1j * SWING) * time)
    return sum(size * (time**power * wave).real for power, size in terms.items())


def transform(terms, omega):
    total = 0.0
    for power, size in terms.items():
        for turn in (1j, -1j):
            total = total + 0.5 * size * gamma(1 + power) / (RATE + turn * SWING + 1j * omega) ** (1 + power)
    return total


@pytest.mark.parametrize("below", [0.0, 5.0, 400.0, 2000.0], ids=lambda below: f"{below:g} below")
@pytest.mark.parametrize("name", BEGINNINGS)
def test_beginnings(name, below):
    """Up to the Nyquist frequency of 2 ms, at complex ω as well, where trapezoids reach 1e-2 at rest."""
    terms = BEGINNINGS[name]
    time = 2e-3 * np.arange(1000)
    road = mf.SampledGuideway(response=swinging(terms, time)[:, None], time_step=2e-3, offsets=[0.0], speed=SPEED)
    omega = np.linspace(0.0, 0.999 * np.pi / 2e-3, 300) - 1j * below
    found = road.moving_frf(0.0, SPEED, omega)
    exact = transform(terms, omega)
    assert np.abs(found - exact).max() < 3e-5 * np.abs(transform(terms, OMEGA)).max()


@pytest.mark.parametrize(("step", "allowed"), [(5e-3, 5e-4), (2.5e-3, 1e-5), (1e-3, 1e-6)])
def test_a_beam_with_mass(step, allowed):
    """Exact samples of the reference road at 5 ms: its static deflection was 8.9 % off."""
    found = record(step=step).moving_frf(0.0, SPEED, np.append(0.0, OMEGA))
    exact = TRACK.moving_frf(0.0, SPEED, np.append(0.0, OMEGA))
    assert np.abs(found - exact).max() < allowed * np.abs(exact).max()


@pytest.mark.parametrize("times", [1, 2, 5])
@pytest.mark.parametrize("name", ["root", "jump"])
def test_duhamel_begins_in_the_same_way(name, times):
    """A constant load from t = 0 on: the integral of the response, from the first step on."""
    power = {"root": 0.5, "jump": 0.0}[name]
    time = 1e-3 * np.arange(2000)
    response = time**power * np.exp(-RATE * time)
    road = mf.SampledGuideway(response=response[:, None], time_step=1e-3, offsets=[0.0], speed=SPEED)
    result = mf.duhamel_loads(road, np.ones((300, 1)), [0.0], speed=SPEED, time_step=times * 1e-3)
    exact = gammainc(1 + power, RATE * result.time.values) * gamma(1 + power) / RATE ** (1 + power)
    # For good: of the trapezoidal rule over √t 7e-4 stay. In passing: the open end of the integral, Δt² g'/12.
    assert abs(result.deflection.values[-1, 0] - exact[-1]) < 2e-6 * exact.max()
    assert np.abs(result.deflection.values[:, 0] - exact).max() < 2e-4 * exact.max()


@pytest.mark.parametrize("ahead", [2.0, -4.0])
@pytest.mark.parametrize("step", [5e-3, 2.5e-3])
def test_a_step_that_is_too_long_says_by_how_much(ahead, step):
    """Away from the load a beam sets in with ever shorter waves, which no samples hold."""
    with pytest.warns(mf.ValidityWarning, match=f"a step of {step} s is long for what the impulse response shows"):
        road = record(ahead=(0.0, ahead), step=step)
    (finding,) = road.findings
    assert finding.code == "record_step"
    stated = figure(finding.message.partition("be off by ")[2])
    omega = 2 * np.pi * np.linspace(0.0, 20.0, 81)
    exact = TRACK.moving_frf([0.0, ahead], SPEED, omega)
    real = np.abs(road.moving_frf([0.0, ahead], SPEED, omega) - exact).max() / np.abs(exact).max()
    assert 1 / 3 < stated / real < 3


def figure(text):
    """First share in a text."""
    word = text.split()[0]
    return float(word.rstrip("%")) / (100 if word.endswith("%") else 1)


@quietly
@pytest.mark.parametrize("end", [0.1, 0.2, 0.3, 0.5, 1.0])
@pytest.mark.parametrize("damping", [3.0e2, 3.0e3, 1.0e4])
def test_a_record_that_is_cut_off_says_by_how_much(damping, end):
    """The static deflection, and the largest moving FRF at the frequency at which more is missing than anywhere."""
    track = mf.track(TRACK.beam, mf.Spring(stiffness=8.0e6, damping=damping))
    short = record(track, duration=end)
    found = [finding.message for finding in short.findings if finding.code == "record_cut_off"]
    omega = 2 * np.pi * np.append(0.0, np.linspace(10.0, 25.0, 601))
    exact = track.moving_frf(0.0, SPEED, omega)
    missing = np.abs(short.moving_frf(0.0, SPEED, omega) - exact)
    still, largest = missing[0] / abs(exact[0]), missing.max() / np.abs(exact).max()
    if largest < 3e-4:
        assert not found
        return
    (message,) = found
    assert f"after {end:g} s" in message
    # The largest moving FRF is itself taken from what the record holds.
    assert 1 / 3 < figure(message.partition(" Hz ")[2].replace("all", "100%")) / largest < 3
    if still > 0.3 * largest:
        assert 1 / 3 < figure(message.partition("about ")[2]) / still < 3


def test_records_that_are_long_enough_say_nothing():
    """As `filterwarnings = error` would tell; noise of a measurement is no vibration that goes on."""
    assert record().findings == ()
    noisy = record().samples + 1e-5 * 1.3e-6 * np.random.default_rng(0).standard_normal((1501, 1))
    assert mf.SampledGuideway(response=noisy, time_step=1e-3, offsets=[0.0], speed=SPEED).findings == ()
    still = mf.SampledGuideway(response=np.zeros((9, 1)), time_step=1e-3, offsets=[0.0], speed=SPEED)
    assert still.findings == ()
    assert still.moving_frf(0.0, SPEED, [1.0])[0] == 0


@pytest.fixture(scope="module")
def cut():
    """Three tenths of a second of the lightly damped road, from which the tenth of its deflection is missing."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", mf.ValidityWarning)
        return record(LIGHT, duration=0.3, remarks=[("measured", "the hammer was soft")])


CAR = VEHICLES["quarter_car"]
SPECTRUM = mf.IsoRoad.of_class("A")


@quietly
@pytest.mark.parametrize(
    "call",
    [
        lambda road: mf.simulate(road, CAR, mf.realise(SPECTRUM, length=60.0), speed=SPEED, duration=2.0),
        lambda road: mf.duhamel(road, CAR, mf.realise(SPECTRUM, length=60.0), speed=SPEED, duration=2.0),
        lambda road: mf.moving_loads(road, np.ones((500, 1)), [0.0], speed=SPEED),
        lambda road: mf.duhamel_loads(road, np.ones((500, 1)), [0.0], speed=SPEED),
        lambda road: mf.transfer(road, CAR, speed=SPEED, frequency=[1.0, 2.0]),
        lambda road: mf.random_response(road, CAR, SPECTRUM, speed=SPEED),
        lambda road: mf.receptance(road, [1.0, 2.0], speed=SPEED),
    ],
    ids=["simulate", "duhamel", "moving_loads", "duhamel_loads", "transfer", "random_response", "receptance"],
)
def test_every_result_carries_what_the_guideway_says(cut, call):
    codes = [finding["code"] for finding in json.loads(call(cut).attrs["findings"])]
    assert {"record_cut_off", "measured"} <= set(codes)
    assert len(codes) == len(set(codes))


@quietly
def test_what_it_says_is_what_a_load_finds(cut):
    """A constant load: the deflection in the end, against that of the track."""
    stated = figure(cut.findings[0].message.partition("about ")[2])
    found = mf.moving_loads(cut, np.ones((4000, 1)), [0.0], speed=SPEED).deflection.values[-1, 0]
    exact = LIGHT.moving_frf(0.0, SPEED, [0.0])[0].real
    assert 1 / 3 < stated / abs(found / exact - 1) < 3


class Told:
    """A guideway of one's own that knows of a limit."""

    critical_speed = np.inf
    findings = (("a_limit", "it is only known at rest"),)

    def moving_frf(self, *arguments, **keywords):
        return mf.RigidGuideway().moving_frf(*arguments, **keywords)


@quietly
def test_any_guideway_may_say_something():
    result = mf.moving_loads(Told(), np.ones((500, 1)), [0.0], speed=SPEED)
    assert json.loads(result.attrs["findings"]) == [{"code": "a_limit", "message": "it is only known at rest"}]


@quietly
@pytest.mark.parametrize("ending", [".npz", ".mat"])
def test_files_keep_it(cut, ending, tmp_path):
    stepped = mf.SampledGuideway(
        response=cut.samples, time_step=1e-3, offsets=[0.0], speed=SPEED, stepped=True, remarks=[("a", "b: c")] * 2
    )
    for road in (cut, stepped):
        mf.write_sampled_guideway(road, tmp_path / f"road{ending}")
        read = mf.read_sampled_guideway(tmp_path / f"road{ending}")
        assert (read.findings, read.stepped) == (road.findings, road.stepped)
    with pytest.warns(mf.ValidityWarning, match="has not died away"):
        mf.read_sampled_guideway(tmp_path / f"road{ending}")


def test_impossible_remarks(tmp_path):
    good = {"response": np.exp(-np.arange(60.0))[:, None], "time_step": 1e-3, "offsets": [0.0], "speed": SPEED}
    with pytest.raises(ValueError, match="remarks must be pairs of a code and a message, got"):
        mf.SampledGuideway(**good, remarks=["soft"])
    np.savez(tmp_path / "road.npz", **good, remarks=["soft"])
    with pytest.raises(ValueError, match='remarks must be texts of the form "code: message"'):
        mf.read_sampled_guideway(tmp_path / "road.npz")


CASE = """
[guideway]
kind = "sampled_guideway"
file = "road.npz"
[loads]
positions = [0.0]
[[loads.force]]
kind = "constant"
force = 1e5
[run]
speed = 10.0
duration = 1.0
"""


def test_check_and_run_say_it_once(cut, tmp_path, capsys):
    mf.write_sampled_guideway(cut, tmp_path / "road.npz")
    (tmp_path / "case.toml").write_text(CASE, encoding="utf-8")
    for command in (["check"], ["run", "--output", str(tmp_path / "out")]):
        assert main([*command, str(tmp_path / "case.toml")]) == 0
        said = capsys.readouterr()
        assert said.out.count("has not died away") == 1
        assert said.out.count("the hammer was soft") == 1
        assert said.err == ""


@quietly
@pytest.mark.parametrize("damping", [0.0, 3.0e3])
def test_a_road_that_is_far_too_short(damping):
    """Nobody can do anything with "1.6e+03 times the largest": what to do, and the record keeps it."""
    track = mf.track(TRACK.beam, mf.Spring(stiffness=8.0e6, damping=damping))
    struck = mf.struck_track(track, speed=SPEED, offsets=[0.0], plain=True)
    (finding,) = [finding for finding in struck.findings if finding.code == "reflections"]
    assert "hardly weaker than they set out: the road is far too short" in finding.message
    assert "e+" not in finding.message
    assert "a longer road, absorbing ends" in finding.message
    result = mf.moving_loads(struck, np.ones((500, 1)), [0.0], speed=SPEED)
    assert finding.message in result.attrs["findings"]

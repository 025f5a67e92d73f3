"""Loads that are switched, against the inverse Laplace transform of the closed form, the finer the sooner."""

import json

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import movingfrf as mf
from movingfrf._basics.smooth import smooth_step
from movingfrf.response.line import Abrupt, Given, Line
from movingfrf.response.moving_loads import isolated_jumps
from movingfrf.scenarios import forces
from movingfrf.scenarios.scenario import Passage
from movingfrf.vehicles.journey import Journey
from tests.laws.test_guideways import ROADS

POINTS = np.array([0.0, 1.5, -1.5])
LOAD = 1e5
# Guideways with shear, with layers, with a damped bending, and a speed for each.
TRAVEL = {
    "euler_bernoulli_winkler": 0.0,
    "bending_damping": 20.0,
    "euler_bernoulli_pasternak": 30.0,
    "timoshenko_pasternak": 0.0,
    "rail_pad_sleeper_ballast": 0.0,
}
every_track = pytest.mark.parametrize("name", TRAVEL)


def answer(name, speed, transform, times, *, points=2**15, growth=1e7):
    """Deflection at `POINTS` under a load of a Laplace transform s → [N s], zero before t = 0, shape (time, point).

    Each instant from a period at most 16 times as long: where something has just begun, steps are tiny.
    """
    found, scale, below = np.zeros((times.size, POINTS.size)), 0.01, 0.0
    while below < times.max():
        some = (times > below) & (times <= 0.5 * scale)
        if some.any():
            number = np.arange(points // 2 + 1)
            s = np.log(growth) / scale + 2j * np.pi * number / scale
            fade = 1.0 - smooth_step(2.0 * number / number[-1] - 1.0)
            answered = ROADS[name].moving_frf(POINTS, speed, -1j * s) * (transform(s) * fade)[:, None]
            instants = np.arange(points) * scale / points
            history = (
                np.fft.irfft(answered, points, axis=0) * points / scale * growth ** (instants / scale)[:, None]
            )
            early = instants < 0.6 * scale
            found[some] = CubicSpline(instants[early], history[early])(times[some])
        below, scale = 0.5 * scale, 8.0 * scale
    return found


def superposed(name, speed, pieces, times):
    """Deflection under pieces (instant, Laplace transform of what begins then)."""
    found = np.zeros((times.size, POINTS.size))
    for begins, transform in pieces:
        later = times - begins > 1e-12
        found[later] += answer(name, speed, transform, times[later] - begins)
    return found


def step(force):
    return lambda s: force / s


def sine(amplitude, frequency, phase):
    """Laplace transform of a sine that begins at once."""
    omega = 2 * np.pi * frequency
    return lambda s: amplitude * (s * np.sin(phase) + omega * np.cos(phase)) / (s * s + omega * omega)


def passage(name, speed, history, *, duration, time_step, truncation=None):
    """Run a scenario of one load; a journey goes forward, but it need not go far."""
    loads = forces.Loads(positions=np.array([0.0]), histories=(history,), observe=POINTS)
    journey = Journey(speed=max(speed, 1e-6), duration=duration, time_step=time_step, truncation=truncation)
    return Passage(guideway=ROADS[name], loads=loads, journey=journey).run()


def of_the_sag(values, wanted):
    return np.abs(values - wanted) / np.abs(wanted).max()


@pytest.mark.filterwarnings("ignore:.* cannot show:movingfrf.ValidityWarning")
@every_track
@pytest.mark.parametrize("time_step", [1e-3, 1e-2, 2e-2])
def test_a_load_that_is_switched_on_at_the_start(name, time_step):
    """METHOD.md section 5: a load that appears on the road at t = 0. The deflection is zero there."""
    force = np.full((round(1.0 / time_step), 1), LOAD)
    result = mf.moving_loads(ROADS[name], force, [0.0], speed=TRAVEL[name], time_step=time_step, observe=POINTS)
    wanted = answer(name, TRAVEL[name], step(LOAD), result.time.values)
    assert np.abs(result.deflection[0]).max() < 1e-6 * np.abs(wanted).max()
    # Where the shear wave of a Timoshenko beam arrives, its front is a kink.
    assert of_the_sag(result.deflection.values, wanted).max() < (4e-4 if name.startswith("timo") else 1e-4)


@pytest.mark.filterwarnings("ignore:.* cannot show:movingfrf.ValidityWarning")
@pytest.mark.parametrize("name", [name for name in TRAVEL if name != "euler_bernoulli_pasternak"])
@pytest.mark.parametrize("time_step", [1e-3, 1e-2])
@pytest.mark.parametrize(
    ("on", "off"), [(0.0137, 0.72), (0.3, 0.70041), (0.30002, 0.5)], ids=["between", "on", "just past a step"]
)
def test_a_load_that_is_switched_within_the_record(name, time_step, on, off):
    result = passage(
        name,
        TRAVEL[name],
        forces.constant(force=LOAD, switch_on=on, switch_off=off),
        duration=1.0,
        time_step=time_step,
    )
    wanted = superposed(name, TRAVEL[name], [(on, step(LOAD)), (off, step(-LOAD))], result.time.values)
    assert np.abs(result.deflection.values[result.time < on + 1e-9]).max() < 1e-9 * np.abs(wanted).max()
    assert of_the_sag(result.deflection.values, wanted).max() < (4e-4 if name.startswith("timo") else 1e-4)


@pytest.mark.filterwarnings("ignore:.* cannot show:movingfrf.ValidityWarning")
@pytest.mark.parametrize("name", ["euler_bernoulli_winkler", "rail_pad_sleeper_ballast"])
@pytest.mark.parametrize(
    ("frequency", "on", "off"), [(720.0, 0.0, 0.2), (720.0, 0.05317, 0.2), (1730.0, 0.1, 0.21), (7.0, 0.05317, 0.2)]
)
def test_a_wave_that_is_switched(name, frequency, on, off):
    """Also above the highest frequency that the record shows, 500 Hz."""
    force = forces.harmonics(
        amplitudes=[LOAD], frequencies=[frequency], phases=[0.4], mean=0.1 * LOAD, switch_on=on, switch_off=off
    )
    result = passage(name, 0.0, force, duration=0.3, time_step=1e-3)
    begins, ends = (sine(LOAD, frequency, 2 * np.pi * frequency * at + 0.4) for at in (on, off))
    pieces = [(on, begins), (on, step(0.1 * LOAD)), (off, lambda s: -ends(s)), (off, step(-0.1 * LOAD))]
    assert of_the_sag(result.deflection.values, superposed(name, 0.0, pieces, result.time.values)).max() < 2e-4


def test_many_waves_that_are_switched_are_the_sum_of_each():
    count, how = 20, {"switch_on": 0.1003, "switch_off": 0.3}
    together = forces.random_sum(rms=1e3, lowest=20.0, highest=900.0, count=count, seed=4, **how)
    random = np.random.default_rng(4)
    frequencies, phases = random.uniform(20.0, 900.0, count), random.uniform(0, 2 * np.pi, count)
    pieces = []
    for frequency, phase in zip(frequencies, phases, strict=True):
        for at, sign in ((0.1003, 1.0), (0.3, -1.0)):
            amplitude = sign * 1e3 * np.sqrt(2 / count)
            pieces.append((at, sine(amplitude, frequency, 2 * np.pi * frequency * at + phase)))
    with pytest.warns(mf.ValidityWarning, match="cannot show"):
        result = passage("euler_bernoulli_winkler", 0.0, together, duration=0.5, time_step=2e-3)
    wanted = superposed(
        "euler_bernoulli_winkler",
        0.0,
        [(at, lambda s, at=at: sum(wave(s) for when, wave in pieces if when == at)) for at in (0.1003, 0.3)],
        result.time.values,
    )
    assert of_the_sag(result.deflection.values, wanted).max() < 2e-4


@pytest.mark.parametrize("first", [0.0337, 0.1, -0.2])
def test_a_force_from_a_file_begins_and_ends_with_its_rows(tmp_path, first):
    """A straight line, which a spline follows: zero before the first row and after the last one."""
    rows, last, on = first + 0.05 * np.arange(11), first + 0.5, max(first, 0.0)
    force = LOAD * (1.0 + rows)
    (tmp_path / "force.csv").write_text("\n".join(f"{t},{f}" for t, f in zip(rows, force, strict=True)))
    history = forces.tabulated(file=tmp_path / "force.csv")
    result = passage("euler_bernoulli_winkler", 20.0, history, duration=1.0, time_step=2e-3)

    def line(at):
        return lambda s: LOAD * ((1.0 + at) / s + 1.0 / s**2)

    pieces = [(on, line(on)), (last, lambda s: -line(last)(s))]
    wanted = superposed("euler_bernoulli_winkler", 20.0, pieces, result.time.values)
    assert of_the_sag(result.deflection.values, wanted).max() < 1e-4
    assert result.force.values[result.time > last].max() == 0.0
    assert history(np.array([rows[-1]]))[0] == pytest.approx(force[-1])


@pytest.mark.parametrize("ramp", [0.02, 3e-4])
def test_a_force_that_rises_within_less_than_a_step_is_followed(ramp):
    """The steps of the solution are as fine as the rise needs, those of the record 5 ms."""
    coarse, fine = (
        passage(
            "euler_bernoulli_winkler",
            10.0,
            forces.constant(force=LOAD, switch_on=0.1, ramp=ramp),
            duration=0.5,
            time_step=time_step,
        ).deflection.values
        for time_step in (5e-3, 5e-5)
    )
    assert of_the_sag(coarse, fine[::100]).max() < 1e-4


def test_a_load_on_a_rigid_guideway_moves_nothing():
    result = mf.moving_loads(mf.RigidGuideway(), np.full((100, 1), LOAD), [0.0], speed=10.0)
    assert (result.deflection == 0.0).all()


@pytest.mark.parametrize("name", ["bending_damping", "timoshenko_pasternak", "rail_in_heat"])
def test_switching_on_later_is_the_same_later(name):
    at_once, later = (
        passage(
            name, 20.0, forces.constant(force=LOAD, switch_on=on), duration=1.0 + on, time_step=1e-3
        ).deflection.values[round(on / 1e-3) :]
        for on in (0.0, 0.2)
    )
    assert of_the_sag(later, at_once).max() < 1e-4


def test_an_abrupt_change_is_exact_in_the_spectrum():
    """e^{-2 t} from t = 0.3137 s on, off the grid, is e^{-0.3137 s}/(s + 2) times what it is there."""
    line, at = Line(samples=1000, time_step=1e-3), 0.3137
    values = np.where(line.instants >= at, np.exp(-2.0 * line.instants), 0.0)[None]
    jumps = np.exp(-2.0 * at) * np.array([1.0, -2.0, 4.0])
    s = 1j * line.omega()
    wanted = np.exp(-(s + 2.0) * at) / (s + 2.0)
    given = Given(values, (Abrupt(at, 0, jumps),))
    assert line.looked_at(given)[0].shape == (2, 1, line.size)  # from t = 0 on, and from the change on
    record = line.records(line.spectra(given)).values
    exact = line.records(wanted[None]).values
    assert np.abs(record - exact).max() < 1e-6
    assert np.abs(line.records(line.spectra(Given(values))).values - exact).max() > 0.1


def jumping(at, time):
    return LOAD * (time >= at)


@pytest.mark.parametrize("name", ["euler_bernoulli_winkler", "timoshenko_pasternak", "taut_string"])
@pytest.mark.parametrize("time_step", [1e-3, 5e-3])
def test_a_jump_between_samples_is_found_and_its_figure_is_honest(name, time_step):
    """Compared with a jump at the later sample, as one at t = 0 is."""
    time, at = np.arange(round(1.0 / time_step)) * time_step, 0.3
    with pytest.warns(mf.ValidityWarning, match="jumps between two samples"):
        result = mf.moving_loads(
            ROADS[name], jumping(at, time)[:, None], [0.0], speed=0.0, time_step=time_step, observe=POINTS
        )
    wanted = superposed(name, 0.0, [(at, step(LOAD))], time)
    real = (np.abs(result.deflection.values - wanted).max(axis=0) / np.abs(wanted).max(axis=0)).max()
    figure = {found["code"]: found["figure"] for found in json.loads(result.findings)}["jump_within_a_step"]
    assert real / 3 < figure < 3 * real


def test_what_is_smooth_or_noisy_does_not_jump():
    time, random = 1e-3 * np.arange(4000), np.random.default_rng(1)
    smooth = [np.sin(2 * np.pi * f * time + 0.3) for f in (1.0, 30.0, 100.0, 250.0, 490.0)]
    humps = [np.exp(-0.5 * ((time - 1.0003) / width) ** 2) for width in (1e-2, 2e-3, 7e-4)]
    rising = [smooth_step((time - 1.0) / ramp) for ramp in (0.1, 0.01, 2e-3)]
    noisy = [random.normal(size=4000), random.laplace(size=4000), np.cumsum(random.normal(size=4000))]
    assert not isolated_jumps(np.stack([*smooth, *humps, *rising, *noisy], axis=1)).any()


@pytest.mark.parametrize(
    ("at", "beside"), [(0.0015, 0.0), (1.0005, 0.0), (1.0005, 30.0), (1.0005, 100.0), (3.9975, 30.0)]
)
def test_a_jump_is_found_beside_what_is_smooth(at, beside):
    time = 1e-3 * np.arange(4000)
    force = (time > at) + 0.4 * np.sin(2 * np.pi * beside * time)
    assert isolated_jumps(force[:, None]) == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize("duration", [0.2, 2.0])
@pytest.mark.parametrize("truncation", [20.0, 70.0])
@pytest.mark.parametrize("name", ["euler_bernoulli_winkler", "rail_pad_sleeper_ballast"])
def test_what_a_truncation_leaves_out_is_what_it_says(name, truncation, duration):
    force = np.full((round(duration / 1e-3), 1), LOAD)
    how = {"positions": [0.0], "speed": 0.0, "observe": POINTS}
    whole = mf.moving_loads(ROADS[name], force, **how).deflection.values
    with pytest.warns(mf.ValidityWarning, match="truncation"):
        cut = mf.moving_loads(ROADS[name], force, **how, truncation=truncation)
    real = np.sqrt(((cut.deflection.values - whole) ** 2).sum(axis=0) / (whole**2).sum(axis=0)).max()
    assert cut.truncation_error == pytest.approx(real, rel=1e-4)

"""Frequency weightings and vibration doses against ISO 2631-1, closed forms, and the same filters in time."""

from __future__ import annotations

from dataclasses import replace
from functools import reduce

import numpy as np
import pytest
from scipy.signal import lsim, residue

import movingfrf as mf
from movingfrf.metrics.comfort import WEIGHTINGS, Comfort

# Factors × 1000 at nominal third-octave frequencies [Hz] (ISO 2631-1, tables 3 and 4).
TABLES = {
    "Wk": {0.5: 418, 1.0: 482, 2.0: 531, 4.0: 967, 8.0: 1036, 16.0: 768, 31.5: 405, 63.0: 186, 80.0: 132},
    "Wd": {0.5: 853, 1.0: 1011, 2.0: 890, 4.0: 512, 8.0: 253, 16.0: 125},
    "Wf": {0.1: 695, 0.125: 895, 0.16: 1006, 0.2: 992, 0.25: 854, 0.315: 619, 0.4: 384},
}


def quadratic(frequency, quality):
    """1 + p/(Qω) + (p/ω)², descending powers of p."""
    omega = 2 * np.pi * frequency
    return [1 / omega**2, 1 / (quality * omega), 1.0]


def polynomials(name):
    """Numerator and denominator of a weighting as one ratio of polynomials in p."""
    (low, high), transition, step, gain, _ = WEIGHTINGS[name]
    above, below = (
        [[gain / (2 * np.pi * low) ** 2, 0.0, 0.0]],
        [quadratic(low, 0.5**0.5), quadratic(high, 0.5**0.5)],
    )
    if transition:
        above.append([1 / (2 * np.pi * transition[0]), 1.0])
        below.append(quadratic(*transition[1:]))
    if step:
        above.append(np.multiply(quadratic(step[0], step[1]), (step[0] / step[2]) ** 2))
        below.append(quadratic(step[2], step[3]))
    return reduce(np.polymul, above), reduce(np.polymul, below)


def test_factors_to_four_digits():
    """PARAMETERS.md, computed there from the standard's definition."""
    vertical = np.abs(mf.weighting("Wk", [1.0, 10**0.6, 10**0.8, 10.0, 100.0]))
    np.testing.assert_allclose(vertical, [0.4825, 0.9648, 1.0544, 0.9884, 0.0887], rtol=0, atol=5e-5)
    assert abs(mf.weighting("Wk", 0.5)) == pytest.approx(0.418, abs=5e-4)
    np.testing.assert_allclose(np.abs(mf.weighting("Wd", [1.0, 10.0])), [1.0110, 0.2017], rtol=0, atol=5e-5)


@pytest.mark.parametrize("name", TABLES)
def test_tables_of_the_standard(name):
    """Three digits are printed."""
    found = 1e3 * np.abs(mf.weighting(name, list(TABLES[name])))
    np.testing.assert_allclose(found, list(TABLES[name].values()), rtol=3e-3, atol=0.6)


def test_shapes_of_all_weightings():
    """What each is for, where the standard plots it."""
    middle = {name: abs(mf.weighting(name, f)) for name, f in (("Wc", 4.0), ("Wj", 20.0), ("Wb", 8.0), ("We", 0.8))}
    assert all(0.85 < value < 1.08 for value in middle.values())
    # Below its step (and above the band limit) Wb is flat at 0.4, as BS 6841 has it; Wj at the square of its ratio.
    assert abs(mf.weighting("Wb", 1.0) / mf.weighting("Wd", 0.9)) == pytest.approx(0.38, abs=0.02)
    assert (2.5 / 4) ** 2 * WEIGHTINGS["Wb"].gain == pytest.approx(0.4, rel=1e-9)
    # Where Wc, Wd and We hand over to velocity they fall by 6 dB an octave.
    for name, f in (("Wd", 20.0), ("We", 20.0)):
        assert abs(mf.weighting(name, 2 * f) / mf.weighting(name, f)) == pytest.approx(0.5, rel=0.02)
    assert mf.weighting("Wk", [[0.0, 1.0], [2.0, 3.0]]).shape == (2, 2)
    assert mf.weighting("Wk", 0.0) == 0


@pytest.mark.parametrize("name", WEIGHTINGS)
def test_frequency_and_time_domain_agree(name):
    """The analogue filter in state space with scipy's first-order hold.

    A chirp-like sum to 20 Hz that sets in smoothly, in steps of 0.5 ms: straight pieces miss (ωΔt)²/12 = 3e-4.
    """
    step = 5e-4
    time = np.arange(0.0, 20.0, step)
    rng = np.random.default_rng(2)
    waves = rng.uniform(0.1, 20.0, 30), rng.uniform(0, 2 * np.pi, 30)
    signal = np.sin(2 * np.pi * np.outer(time, waves[0]) + waves[1]).sum(axis=1) * np.minimum(time, 1) ** 3
    # Time in units in which the filter's coefficients are of one size.
    above, below = polynomials(name)
    scale = 2 * np.pi * np.sqrt(np.prod(WEIGHTINGS[name].band))
    above = above * scale ** np.arange(len(above) - 1, -1, -1.0)
    below = below * scale ** np.arange(len(below) - 1, -1, -1.0)
    _, wanted, _ = lsim((above, below), signal, scale * time)
    found = mf.weighted(signal, step, name)
    assert np.linalg.norm(found - wanted) < 1e-3 * np.linalg.norm(wanted)


def test_nothing_comes_back_around():
    """A shock near the end leaves the beginning alone, and several histories do not mix."""
    time = 1e-3 * np.arange(4000)
    # Smooth: a shock of one sample is cut at half the sampling rate and rings ahead.
    shock = np.stack([np.exp(-(((time - 3.9) / 0.02) ** 2)), 0 * time], axis=1)
    found = mf.weighted(shock, 1e-3, "Wk")
    assert np.abs(found[:3700]).max() < 1e-8 * np.abs(found).max()
    np.testing.assert_array_equal(found[:, 1], 0.0)
    np.testing.assert_allclose(found[:, 0], mf.weighted(shock[:, 0], 1e-3, "Wk"), rtol=0, atol=1e-14)


def test_measures_of_a_sine():
    """A weighted sine of amplitude A: rms A/√2, crest √2, MTVV A/√2, VDV A (3T/8)^¼."""
    step, amplitude, duration = 1e-3, 3.0, 400.0
    time = step * np.arange(round(duration / step))
    # In 400 s the start counts for little: 1 s of it for 1e-3.
    found = mf.whole_body_vibration(amplitude * np.sin(2 * np.pi * 8 * time), step, "Wk")
    weighted = amplitude * abs(mf.weighting("Wk", 8.0))
    assert found.rms == pytest.approx(weighted / np.sqrt(2), rel=1e-3)
    assert found.vdv == pytest.approx(weighted * (3 * duration / 8) ** 0.25, rel=1e-3)
    assert found.mtvv == pytest.approx(weighted / np.sqrt(2), rel=0.02)
    assert found.crest_factor == pytest.approx(np.sqrt(2), rel=0.1)
    assert found.exceeded == ()


def begun(name, amplitude, frequency, time):
    """Weight a sine that begins at zero, in closed form: partial fractions of W(p) A ω/(p² + ω²)."""
    above, below = polynomials(name)
    omega = 2 * np.pi * frequency
    shares, poles, _ = residue(amplitude * omega * above, np.polymul(below, [1.0, 0.0, omega**2]))
    return (shares[:, None] * np.exp(np.outer(poles, time))).sum(axis=0).real


GRAVITY_AND_MORE = [(0.0, 0.0), (9.81, 0.0), (-9.81, 0.3), (0.0, -2.0), (1e4, 0.0)]


@pytest.mark.parametrize(("bias", "drift"), GRAVITY_AND_MORE)
def test_a_recording_does_not_begin_as_a_step(bias, drift):
    """0.5 √2 sin(2π 5 t) on a bias and a drift, 10 s at 256 Hz."""
    time = np.arange(2560) / 256
    shaken = np.sqrt(0.5) * np.sin(2 * np.pi * 5 * time)
    found = mf.whole_body_vibration(shaken + bias + drift * time, 1 / 256)
    assert (found.rms, found.mtvv, found.vdv) == pytest.approx((0.518, 0.521, 1.02), abs=5e-4)
    truth = begun("Wk", np.sqrt(0.5), 5.0, time)
    # The line that fits a sine of fifty waves best is 1 % of it.
    assert found.rms == pytest.approx(np.sqrt(np.mean(truth**2)), rel=5e-4)
    assert found.mtvv == pytest.approx(np.sqrt(np.convolve(truth**2, np.ones(256), "valid").max() / 256), rel=5e-4)
    assert found.vdv == pytest.approx((np.sum(truth**4) / 256) ** 0.25, rel=5e-4)
    assert found.bias == pytest.approx(bias + drift * time.mean(), abs=1e-12 + 1e-15 * abs(bias))
    assert found.drift == pytest.approx(drift, abs=3e-3)
    assert f"{found.bias:.3g} m/s²" in found.taken_out
    assert "rad/s²" in mf.whole_body_vibration(shaken + 1, 1 / 256, "We").taken_out
    assert "cannot tell" not in found.taken_out


@pytest.mark.parametrize("name", ["Wk", "Wd", "We", "Wf"])
@pytest.mark.parametrize(("seconds", "rate"), [(60.0, 256), (4.0, 16), (1.0, 64), (0.5, 32)])
def test_a_line_makes_no_difference_to_a_recording(name, seconds, rate):
    """However short and coarse; of one too short for the weighting it is said that they look alike."""
    time = np.arange(round(seconds * rate)) / rate
    shaken = np.random.default_rng(3).standard_normal(time.size)
    bare = mf.whole_body_vibration(shaken, 1 / rate, name)
    found = mf.whole_body_vibration(shaken + 9.81 - 0.7 * time, 1 / rate, name)
    for measure in ("rms", "peak", "mtvv", "vdv"):
        assert getattr(found, measure) == pytest.approx(getattr(bare, measure), rel=1e-9)
    weighted = mf.weighted(np.stack([shaken, shaken + 9.81], axis=1), 1 / rate, name, recorded=True)
    np.testing.assert_allclose(weighted[:, 1], weighted[:, 0], rtol=0, atol=1e-12)
    assert np.abs(weighted).max() == pytest.approx(bare.peak, rel=1e-9)
    assert ("cannot tell" in found.taken_out) == (seconds < 1 / WEIGHTINGS[name].band[0])


def test_of_what_is_computed_nothing_is_taken_out():
    """A vehicle whose acceleration has a mean keeps it: a recording of the same would not."""
    car = mf.quarter_car(
        body_mass=400.0, wheel_mass=40.0, suspension_stiffness=2e4, suspension_damping=1.5e3, tyre_stiffness=2e5
    )
    hump = mf.bump(height=0.02, width=8.0, at=8.0, length=60.0)
    result = mf.simulate(mf.RigidGuideway(), car, hump, speed=10.0, duration=2.0, blend=0.0)
    body = result.acceleration.sel(dof="body").values
    felt = mf.comfort(result, "body")
    assert felt.taken_out == ""
    assert felt.rms == pytest.approx(np.sqrt(np.mean(mf.weighted(body, 1e-3) ** 2)), rel=1e-12)
    assert next(m.value for m in mf.measures(result) if m.name == "weighted rms") == felt.rms
    assert mf.whole_body_vibration(body, 1e-3).rms != pytest.approx(felt.rms, rel=1e-3)


def test_running_rms_and_dose_of_a_burst():
    """Two seconds of a square wave of ±2: over one second 2, over four √2; dose (16 · 2)^¼."""
    step = 1e-3
    values = np.zeros(10_000)
    values[4000:6000] = np.where(np.arange(2000) % 10 < 5, 2.0, -2.0)
    running = mf.running_rms(values, step)
    assert running.max() == pytest.approx(2.0, rel=1e-12)
    np.testing.assert_allclose(
        running[[3999, 4499, 5499, 6499, 7000]], [0, np.sqrt(2), 2, np.sqrt(2), 0], atol=1e-7
    )
    assert mf.running_rms(values, step, window=4.0).max() == pytest.approx(np.sqrt(2), rel=1e-12)
    # Before the record there was nothing.
    assert mf.running_rms(np.ones(10), 0.1)[0] == pytest.approx(np.sqrt(0.1))
    assert mf.vibration_dose(values, step) == pytest.approx(32**0.25, rel=1e-12)
    # Without the first seconds, as if they had not been.
    np.testing.assert_array_equal(mf.running_rms(values, step, since=4.5), mf.running_rms(values[4500:], step))
    # Several histories, in any arrangement.
    grid = values[:, None, None] * np.array([[1.0, 2.0, 0.0]])
    assert mf.vibration_dose(grid, step) == pytest.approx(32**0.25 * np.array([[1.0, 2.0, 0.0]]))
    np.testing.assert_allclose(mf.running_rms(grid, step)[:, 0, 1], 2 * running, rtol=0, atol=1e-7)


def test_criteria():
    """One shock in a quiet minute exceeds all; a crest factor of 9 alone does not exceed."""
    quiet = 0.01 * np.sin(2 * np.pi * 8 * 1e-3 * np.arange(60_000))
    quiet[30_000:30_050] += 10.0
    assert mf.whole_body_vibration(quiet, 1e-3).exceeded == ("crest", "MTVV", "VDV")
    steady = Comfort(weighting="Wk", rms=1.0, peak=9.0, mtvv=1.5, vdv=1.75 * 16**0.25, duration=16.0)
    assert steady.exceeded == ()
    assert replace(steady, peak=9.01).exceeded == ("crest",)
    assert replace(steady, mtvv=1.51).exceeded == ("MTVV",)
    assert replace(steady, vdv=3.51).exceeded == ("VDV",)
    nothing = replace(steady, rms=0.0)
    assert nothing.exceeded == ()
    assert np.isnan(nothing.crest_factor)


@pytest.mark.parametrize(
    ("rms", "words"),
    [
        (0.0, ("not uncomfortable",)),
        (0.314, ("not uncomfortable",)),
        (0.315, ("a little uncomfortable",)),
        (0.55, ("a little uncomfortable", "fairly uncomfortable")),
        (1.0, ("uncomfortable",)),
        (1.3, ("uncomfortable", "very uncomfortable")),
        (2.2, ("very uncomfortable", "extremely uncomfortable")),
        (9.0, ("extremely uncomfortable",)),
    ],
)
def test_reactions(rms, words):
    """ISO 2631-1, C.2.3."""
    assert mf.comfort_reactions(rms) == words


def test_totals():
    """ISO 2631-1, equation (10), with the factors of a seat and of health."""
    assert mf.vibration_total([3.0, 4.0]) == pytest.approx(5.0)
    assert mf.vibration_total([1.0, 1.0, 1.0], [1.4, 1.4, 1.0]) == pytest.approx(np.sqrt(2 * 1.96 + 1))


def test_total_of_a_seated_person():
    """ISO 2631-1, 8.2.2.1: each factor by itself, and all of them by the sum of squares."""
    factors = {
        "seat": {"x": 1, "y": 1, "z": 1, "roll": 0.63, "pitch": 0.4, "yaw": 0.2},
        "backrest": {"x": 0.8, "y": 0.5, "z": 0.4},
        "feet": {"x": 0.25, "y": 0.25, "z": 0.4},
    }
    alone = {f"{place} {axis}": k for place, axes in factors.items() for axis, k in axes.items()}
    assert {axis: mf.seated_total({axis: 2.0}) for axis in alone} == pytest.approx(
        {a: 2 * k for a, k in alone.items()}
    )
    assert mf.seated_total(dict.fromkeys(alone, 1.0)) == pytest.approx(sum(k**2 for k in alone.values()) ** 0.5)


def test_comfort_of_a_result():
    """The named degree of freedom, weighted: its rms by Parseval's sum over the weighted spectrum of the record.

    The quarter car has come to rest at the end, so that the record is a transient whole.
    """
    car = mf.quarter_car(
        body_mass=400.0, wheel_mass=40.0, suspension_stiffness=2e4, suspension_damping=1.5e3, tyre_stiffness=2e5
    )
    hump = mf.bump(height=0.02, width=1.0, at=5.0, length=220.0)
    result = mf.simulate(mf.RigidGuideway(), car, hump, speed=10.0, duration=20.0, blend=0.0)
    found = mf.comfort(result, "body")
    acceleration = result.acceleration.sel(dof="body").values
    f = np.fft.rfftfreq(acceleration.size, 1e-3)
    lines = np.abs(np.fft.rfft(acceleration) * mf.weighting("Wk", f)) ** 2
    mean_square = 2 * lines[1:].sum() / acceleration.size**2
    assert found.rms == pytest.approx(np.sqrt(mean_square), rel=1e-4)
    assert found.duration == pytest.approx(20.0)
    assert mf.comfort(result, "wheel").rms > 2 * found.rms
    assert mf.comfort(result, "body", weighting="Wd").rms != found.rms


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: mf.weighting("Wx", 1.0), r"weighting must be one of Wk, .*, got 'Wx'"),
        (lambda: mf.weighting("Wk", np.nan), "frequency must be finite"),
        (lambda: mf.weighted([0.0, np.inf], 1e-3), "acceleration must be finite"),
        (lambda: mf.weighted([0.0, 1.0], 0.0), "time_step must be positive"),
        (lambda: mf.running_rms([1.0], 1e-3, 0.0), "window must be positive"),
        (lambda: mf.running_rms([1.0] * 9, 1e-3, since=1.0), "since must leave at least two samples"),
        (lambda: mf.vibration_dose([1.0], -1.0), "time_step must be positive"),
        (lambda: mf.comfort_reactions(-1.0), "rms must not be negative"),
        (lambda: mf.vibration_total([[1.0]]), "rms must have shape"),
        (lambda: mf.vibration_total([1.0, 2.0], [1.0, 2.0, 3.0]), r"factors must have shape \(2\), got \(3,\)"),
        (lambda: mf.weighting(["Wk"], 1.0), r"weighting must be one of Wk, .*, got \['Wk'\]"),
        (lambda: mf.weighted(3.0, 1e-3), r"acceleration must hold at least one sample, .* got shape \(\)"),
        (lambda: mf.running_rms(3.0, 1e-3), r"values must hold at least one sample, .* got shape \(\)"),
        (lambda: mf.running_rms([], 1e-3), r"values must hold at least one sample, .* got shape \(0,\)"),
        (lambda: mf.running_rms([1.0, np.nan], 1e-3), "values must be finite"),
        (lambda: mf.vibration_dose([np.nan], 1e-3), "values must be finite"),
        (lambda: mf.vibration_dose(3.0, 1e-3), "values must hold at least one sample"),
        (lambda: mf.comfort(None, "body"), "result must be the coupled response of a vehicle"),
        (lambda: mf.whole_body_vibration([[1.0]], 1e-3), "acceleration must have shape"),
        (lambda: mf.whole_body_vibration([1.0, 2.0], 1e-3), r"at least three samples \[m/s²\], got 2"),
        (lambda: mf.seated_total({"seat z": 1.0, "nose x": 1.0}), "rms must be of seat x, .*, got 'nose x'"),
        (lambda: mf.seated_total({"seat z": -1.0}), r"rms\['seat z'\] must not be negative"),
        (lambda: mf.seated_total([1.0]), "rms must give accelerations by place and axis"),
    ],
)
def test_refusals(call, message):
    with pytest.raises(mf.ParameterError, match=message):
        call()

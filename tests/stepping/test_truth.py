"""Stepped roads against closed forms: Frýba's beam, the moving oscillator, steady loads on endless tracks."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import movingfrf as mf
from tests.helpers import DAMPED, difference

# PARAMETERS.md: moving oscillator on a simply supported beam.
LENGTH, BENDING, MASS, SPEED = 25.0, 2.87e9 * 2.9, 2303.0, 100 / 3.6
SPRUNG, SPRING = 5750.0, 1595e3
WEIGHT = SPRUNG * 9.81


def bridge(element=0.5):
    """Simply supported; what holds it up in between is a millionth of its own stiffness."""
    beam = mf.EulerBernoulliBeam(bending_stiffness=BENDING, mass=MASS)
    return mf.finite_track(
        mf.track(beam, mf.Spring(stiffness=1.0)), first=0.0, last=LENGTH, element=element, ends="pinned"
    )


def modes(x, count):
    """Shapes sin jπx/L of the first modes, shape (..., mode)."""
    return np.sin(np.pi * np.arange(1, count + 1) * np.asarray(x)[..., None] / LENGTH)


def frequencies(count):
    return (np.pi * np.arange(1, count + 1) / LENGTH) ** 2 * np.sqrt(BENDING / MASS)


def fryba(x, time, force, speed, count=60):
    """Deflection at x under a force that enters a simply supported beam at t = 0.

    L. Frýba, Vibration of Solids and Structures under Moving Loads, 3rd ed., 1999, chapter 1, without damping:
    Σ_j 2F/(mL) sin(jπx/L) (sin Ω_j t − (Ω_j/ω_j) sin ω_j t)/(ω_j² − Ω_j²), Ω_j = jπv/L.
    """
    omega, driven = frequencies(count), np.pi * speed * np.arange(1, count + 1) / LENGTH
    phase = np.sin(driven * time[:, None]) - driven / omega * np.sin(omega * time[:, None])
    return 2 * force / (MASS * LENGTH) * (modes(x, count) * phase / (omega**2 - driven**2)).sum(axis=-1)


@pytest.mark.parametrize("speed", [100 / 3.6, 70.0])
def test_a_force_crosses_a_bridge(speed):
    """Under the force all the way, and 5 m ahead of it, which passes mid-span; 1e-3 of the greatest deflection."""
    step = 5e-4
    for ahead in (0.0, 5.0):
        count = int((LENGTH - ahead) / (speed * step))
        time = step * np.arange(count)
        result = mf.newmark_loads(
            bridge(), np.full((count, 1), WEIGHT), [0.0], speed=speed, time_step=step, observe=[ahead]
        )
        wanted = fryba(speed * time + ahead, time, WEIGHT, speed)
        assert np.abs(wanted).max() > 1e-3
        assert np.abs(result.deflection.values[:, 0] - wanted).max() < 1e-3 * np.abs(wanted).max()


def test_a_force_backwards_is_its_mirror_image():
    step, count = 5e-4, 900
    forward, backward = (
        mf.newmark_loads(
            bridge(),
            np.full((count, 2), WEIGHT) * [1.0, 0.5],
            sign * np.array([0.0, -2.0]),
            start=start,
            speed=sign * SPEED,
            time_step=step,
            observe=sign * np.array([3.0, -1.5]),
        ).deflection.values
        for sign, start in ((1.0, 3.0), (-1.0, LENGTH - 3.0))
    )
    assert difference(backward, forward) < 1e-9


STEP = 2.5e-4
TIME = STEP * np.arange(3600)


def oscillator_on(count):
    """Beam and oscillator integrated mode by mode: deflection at mid-span, mass, contact force, under the wheel.

    With the force F = Mg + k (z − w(vt, t)): q̈_j + ω_j² q_j = 2/(mL) F sin jπvt/L, M z̈ = −k (z − w).
    """
    omega = frequencies(count)

    def rates(time, state):
        shapes = modes(SPEED * time, count)
        stretch = state[-2] - shapes @ state[:count]
        moved = 2 / (MASS * LENGTH) * (WEIGHT + SPRING * stretch) * shapes - omega**2 * state[:count]
        return np.concatenate([state[count:-2], moved, [state[-1], -SPRING * stretch / SPRUNG]])

    start = np.zeros(2 * count + 2)
    solution = solve_ivp(rates, (0.0, TIME[-1]), start, t_eval=TIME, method="LSODA", rtol=1e-8, atol=1e-11)
    shares, mass = solution.y[:count], solution.y[-2]
    under = (modes(SPEED * TIME, count) * shares.T).sum(axis=1)
    return modes(LENGTH / 2, count) @ shares, mass, SPRING * (mass - under), under


@pytest.fixture(scope="module")
def oscillator():
    return oscillator_on(15)


@pytest.fixture(scope="module")
def crossing():
    """Make the same journey by the coupled method: no run-in, the bridge carries the weight as it comes."""
    mass = mf.Vehicle(
        mass=[[SPRUNG]],
        damping=[[0.0]],
        stiffness=[[0.0]],
        contact_map=[[1.0]],
        contacts=[mf.Contact(position=0.0, stiffness=SPRING)],
        vertical=[1],
        dof_names=["mass"],
    )
    flat = mf.Profile(np.linspace(-1.0, LENGTH + 1.0, 6), np.zeros(6))
    options = {"speed": SPEED, "duration": 0.9, "time_step": STEP, "blend": 0.0, "run_in": 0.0}
    return mf.cdfm(bridge(), mass, flat, superposed=False, observe=[LENGTH / 2, 0.0], **options)


def test_published_numbers_of_the_moving_oscillator(oscillator):
    """PARAMETERS.md: mid-span 2.4073 mm at 0.3710 s with 15 modes, 2.3839 mm with one; the mass 2.590 mm."""
    middle, mass, _, _ = oscillator
    assert 1e3 * middle.max() == pytest.approx(2.4073, abs=0.6e-4)
    assert TIME[middle.argmax()] == pytest.approx(0.3710, abs=3e-4)
    assert 1e3 * mass.max() == pytest.approx(2.590, abs=0.6e-3)
    assert 1e3 * oscillator_on(1)[0].max() == pytest.approx(2.3839, abs=0.6e-4)


def test_coupled_method_drives_the_oscillator(oscillator, crossing):
    """Every mode that elements have against fifteen; each output to 1e-3 of its greatest value."""
    _, mass, force, under = oscillator
    for found, wanted in (
        (crossing.motion[:, 0], mass),
        (crossing.contact_force[:, 0], force),
        (crossing.deflection[:, 0], under),
    ):
        assert np.abs(found.values - wanted).max() < 1e-3 * np.abs(wanted).max()
    assert 1e3 * crossing.motion.values.max() == pytest.approx(2.590, rel=1e-3)


def test_coupled_method_sees_mid_span(oscillator, crossing):
    """The published 2.4073 mm at 0.3710 s, and the whole history, to 1e-3; a support stays where it is."""
    middle, _, _, _ = oscillator
    found = crossing.place_deflection.values
    assert np.abs(found[:, 0] - middle).max() < 1e-3 * middle.max()
    assert 1e3 * found[:, 0].max() == pytest.approx(2.4073, rel=1e-3)
    assert TIME[found[:, 0].argmax()] == pytest.approx(0.3710, abs=1e-3)
    assert np.abs(found[:, 1]).max() == 0.0


def test_mid_span_under_the_forces_of_the_coupled_method(oscillator, crossing):
    """Contact forces of the coupled method put to the beam's modes: mid-span, to 1e-3 of 2.4073 mm.

    Each mode is stepped exactly for a load that is linear between samples (Duhamel's integral).
    """
    count, step = 15, STEP
    np.testing.assert_allclose(crossing.time, TIME, atol=1e-12)
    total = (crossing.contact_force + crossing.static_load).values[:, 0]
    loads = 2 / (MASS * LENGTH) * total[:, None] * modes(SPEED * TIME, count)
    omega = frequencies(count)
    cosine, sine = np.cos(omega * step), np.sin(omega * step)
    shares, rates, middle = np.zeros(count), np.zeros(count), np.zeros(TIME.size)
    for n in range(1, TIME.size):
        slope = (loads[n] - loads[n - 1]) / step
        away, drift = shares - loads[n - 1] / omega**2, (rates - slope / omega**2) / omega
        shares = away * cosine + drift * sine + loads[n] / omega**2
        rates = omega * (drift * cosine - away * sine) + slope / omega**2
        middle[n] = modes(LENGTH / 2, count) @ shares
    assert 1e3 * middle.max() == pytest.approx(2.4073, rel=1e-3)
    assert TIME[middle.argmax()] == pytest.approx(0.3710, abs=1e-3)
    wanted, _, _, _ = oscillator
    assert np.abs(middle - wanted).max() < 1e-3 * wanted.max()


@pytest.mark.parametrize(
    ("name", "speed", "duration", "under"),
    [
        ("euler_bernoulli_winkler", 30.0, 1.0, 1e-4),
        ("euler_bernoulli_winkler", 120.0, 1.0, 1e-4),
        ("euler_bernoulli_pasternak", 60.0, 1.0, 1e-4),
        ("bending_damping", 60.0, 1.0, 1e-4),
        ("rail_pad_sleeper_ballast", 60.0, 0.3, 7e-4),
        ("rail_two_masses", 60.0, 0.6, 7e-4),
    ],
)
def test_steady_load_on_an_endless_track(name, speed, duration, under):
    """Under the load, ahead and behind, on a travelling road, against the residue sum at ω = 0.

    What the passage of single elements modulates is averaged over one passage. Away from the load cubic elements
    are of order 4 (a few millionths with 0.25 m), under it of order 3: `under`, more on a slender rail.
    """
    track, element, steps = DAMPED[name], 0.25, 10
    road = mf.finite_track(track, first=-30.0, last=30.0, element=element, travels=True, absorbing=20.0)
    step = element / (speed * steps)
    points = np.array([0.0, 2.0, -2.0, -4.25])
    count = int(duration / step)
    result = mf.newmark_loads(road, np.full((count, 1), 1e5), [0.0], speed=speed, time_step=step, observe=points)
    found = result.deflection.values[-steps:].mean(axis=0)
    wanted = 1e5 * track.moving_frf(points, speed, [0.0])[0].real
    error = np.abs(found - wanted) / wanted[0]
    assert error[0] < under
    assert error[1:].max() < 3e-5
    # Ahead and behind differ: the basin trails the load.
    assert abs(wanted[1] - wanted[2]) > 3e-3 * wanted[0]


def test_loads_that_vary_on_an_endless_track():
    """Two forces in a smooth pulse against `moving_loads`, which knows no elements and no steps."""
    track = DAMPED["euler_bernoulli_winkler"]
    time = 5e-4 * np.arange(2000)
    pulse = np.sin(np.pi * np.clip(time / 0.3, 0.0, 1.0)) ** 4
    force = np.stack([1e5 * pulse, -4e4 * pulse * np.sin(60 * time)], axis=1)
    options = {"speed": 20.0, "time_step": 5e-4, "observe": [0.0, -3.0, 5.0]}
    road = mf.finite_track(track, first=-40.0, last=60.0, element=0.25)
    stepped = mf.newmark_loads(road, force, [0.0, -4.0], **options).deflection.values
    wanted = mf.moving_loads(track, force, [0.0, -4.0], **options).deflection.values
    assert difference(stepped, wanted) < 1e-3

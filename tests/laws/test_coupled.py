"""Laws of the coupled response, put to results of `simulate` alone: only time histories are looked at."""

from __future__ import annotations

import json

import numpy as np
import pytest

import movingfrf as mf
from tests.helpers import (
    DAMPED,
    MARGIN,
    QUARTER_TRUCK,
    VEHICLES,
    difference,
    dynamic_stiffness,
    held_matrices,
    rates,
)

ROAD = DAMPED["euler_bernoulli_winkler"]
DYNAMIC = ("contact_force", "motion", "acceleration")

every_vehicle = pytest.mark.parametrize("name", VEHICLES)


def rough(highest=4.0, length=60.0, seed=1, start=-8.0):
    return mf.realise(
        mf.IsoRoad.of_class("A", band=(0.02, highest)), length=length, step=0.02, seed=seed, start=start
    )


def dynamic(result):
    """Every dynamic output as one dictionary of arrays over time."""
    found = {name: result[name].values for name in DYNAMIC}
    found["deflection"] = result.deflection.values - result.static_deflection.values
    return found


def greatest_difference(first, second):
    return max(difference(a, b) for a, b in zip(dynamic(first).values(), dynamic(second).values(), strict=True))


def drive(vehicle="half_truck", road=ROAD, profile=None, *, speed=10.0, duration=3.0, **more):
    profile = rough() if profile is None else profile
    # A second path, where one is followed: another road, but one that is flat, shifted or scaled as the first is.
    paths = 1 + max(contact.path for contact in VEHICLES[vehicle].contacts)
    profile = mf.Profile(profile.distance, np.outer(profile.elevation, (-0.5) ** np.arange(paths)))
    return mf.simulate(road, VEHICLES[vehicle], profile, speed=speed, duration=duration, **more)


# (vehicle, road, speed): every vehicle on the reference road, every road under the half truck or a quarter truck.
CASES = [
    *((vehicle, "euler_bernoulli_winkler", 10.0) for vehicle in VEHICLES),
    *(("half_truck", road, 15.0) for road in DAMPED),
    ("half_truck", "euler_bernoulli_winkler", 160.0),
    ("quarter_truck", "euler_bernoulli_winkler", 230.0),
    ("half_truck", "rigid", 10.0),
]


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
@pytest.mark.parametrize(("vehicle", "road", "speed"), CASES)
def test_newton_at_every_instant(vehicle, road, speed):
    """M z̈ + C ż + K z + Bᵀ F = 0 and F = k_t e + c_t ė with the tyre's compression e = B z − (w − r).

    An independent check in the time domain: velocities by central differences of eighth order (relative error
    (ωΔt)^8/630, below 1e-6 for content up to 60 Hz and Δt = ½ ms; at the knots of the profile's spline the third
    derivative jumps, which costs up to 6e-5 through a strong dashpot). Row by row this is the balance of vertical
    momentum, of pitch, and of each wheel.
    """
    waves = min(4.0, 60.0 / speed)
    profile = rough(waves, length=3.0 * speed + 30.0)
    guideway = mf.RigidGuideway() if road == "rigid" else DAMPED[road]
    result = drive(vehicle, guideway, profile, speed=speed, duration=2.0, time_step=5e-4)
    mass, damping, stiffness, at, k_tyre, c_tyre = held_matrices(VEHICLES[vehicle])
    step, inside = 5e-4, slice(MARGIN, -MARGIN)
    # The jump in curvature at the very start lies outside the first derivative's reach after a few samples.
    force, motion, acceleration = (result[name].values for name in DYNAMIC)
    velocity, second = rates(motion, step)
    assert difference(second, acceleration[inside]) < 1e-4
    balance = acceleration[inside] @ mass + velocity @ damping + motion[inside] @ stiffness + force[inside] @ at
    assert np.abs(balance).max() < 1e-4 * np.abs(force).max()
    compression = motion @ at.T - (result.deflection - result.static_deflection).values + result.roughness.values
    spring = k_tyre * compression[inside] + c_tyre * rates(compression, step)[0]
    assert difference(spring, force[inside]) < 1e-4
    # The whole vehicle: what is accelerated is pushed by the road alone, exactly (no derivative is taken).
    momentum = acceleration @ mass @ np.asarray(VEHICLES[vehicle].vertical)
    assert np.abs(momentum + force.sum(axis=1)).max() < 1e-9 * np.abs(force).max()


@every_vehicle
def test_a_flat_road_moves_nothing(name):
    flat = mf.Profile([-10.0, 0.0, 20.0, 40.0], np.full(4, 3.0))
    result = drive(name, profile=flat)
    assert max(np.abs(values).max() for values in dynamic(result).values()) == 0.0


@every_vehicle
def test_a_road_lowered_evenly_is_the_same_road(name):
    """A road at 583 m above sea level is not a bump of 583 m.

    Elevations then have steps of 1e-13 m: against 1 mm of roughness 1e-10, which a tyre and the second derivative
    at the Nyquist frequency multiply by up to (500 Hz/5 Hz)² = 1e4.
    """
    profile = rough()
    lifted = mf.Profile(profile.distance, np.asarray(profile.elevation) + 583.0)
    low, high = drive(name, profile=profile), drive(name, profile=lifted)
    assert greatest_difference(high, low) < 1e-6
    assert high.attrs["datum"] - low.attrs["datum"] == pytest.approx(583.0, rel=1e-12)


# Without blending the rear wheel starts on a step, which the Nyquist frequency sees.
@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
@pytest.mark.parametrize("blend", [0.0, 5.0])
def test_datum_and_blend(blend):
    """The road under the foremost contact starts at zero; within `blend` metres a quintic step lets it in."""
    profile = rough()
    result = drive(profile=profile, blend=blend)
    front = float(result.position.max())
    travelled = 10.0 * result.time.values
    for contact, position in enumerate(result.position.values):
        x = position + travelled
        s = np.clip((x - front) / blend, 0, 1) if blend else np.ones_like(x)
        expected = (profile.along(0)(x) - profile.along(0)(front)) * (10 * s**3 - 15 * s**4 + 6 * s**5)
        np.testing.assert_allclose(result.roughness[:, contact], expected, atol=1e-14)


@every_vehicle
def test_linear_in_the_roughness(name):
    profile = rough()
    triple = mf.Profile(profile.distance, -3.0 * np.asarray(profile.elevation))
    once, thrice = drive(name, profile=profile), drive(name, profile=triple)
    for one, three in zip(dynamic(once).values(), dynamic(thrice).values(), strict=True):
        assert difference(three, -3.0 * one) < 1e-9
    # Superposition of two roads.
    other = rough(seed=2)
    both = mf.Profile(profile.distance, np.asarray(profile.elevation) + np.asarray(other.elevation))
    second, together = drive(name, profile=other), drive(name, profile=both)
    # Each of three drives chooses its own truncation, at which it leaves out a few millionths.
    for a, b, ab in zip(*(dynamic(r).values() for r in (once, second, together)), strict=True):
        assert difference(a + b, ab) < 3e-5


@every_vehicle
def test_a_shifted_road_is_a_delayed_response(name):
    """A hump 2 m further on at 10 m/s comes 200 samples later; a start 2 m further on brings it forward."""
    near, far = (mf.bump(height=0.01, width=4.0, at=at, length=60.0, start=-10.0) for at in (6.0, 8.0))
    first, later, ahead = (
        drive(name, profile=profile, blend=0.0, truncation=150.0, start=start)
        for profile, start in ((near, 0.0), (far, 0.0), (far, 2.0))
    )
    # Stations every 4 cm, so that 2 m are a whole number of them and the splines agree.
    for a, b, c in zip(*(dynamic(r).values() for r in (first, later, ahead)), strict=True):
        assert difference(b[200:], a[:-200]) < 3e-5
        assert difference(c, a) < 3e-5
        assert np.abs(b[:200]).max() < 1e-4 * np.abs(a).max()


def test_the_rear_wheel_sees_the_front_ones_road_later():
    """4 m apart at 10 m/s: 0.4 s. On a rigid road two cars without a common body answer alike, 0.4 s apart."""
    pair = mf.Vehicle(
        mass=np.diag([400.0, 40.0, 400.0, 40.0]),
        damping=np.kron(np.eye(2), [[1500.0, -1500.0], [-1500.0, 1500.0]]),
        stiffness=np.kron(np.eye(2), [[2e4, -2e4], [-2e4, 2e4]]),
        contact_map=[[0, 1, 0, 0], [0, 0, 0, 1]],
        contacts=[mf.Contact(position=x, stiffness=2e5, damping=150.0) for x in (1.0, -3.0)],
        vertical=[1, 1, 1, 1],
        dof_names=["body_1", "wheel_1", "body_2", "wheel_2"],
    )
    result = mf.simulate(mf.RigidGuideway(), pair, rough(), speed=10.0, duration=3.0, solved_step=5e-4)
    front, rear = result.roughness.values.T
    np.testing.assert_allclose(rear[400:], front[:-400], atol=1e-14)
    assert np.abs(front[:400]).max() > 1e-4
    assert np.abs(rear[:400]).max() < 1e-15
    force = result.contact_force.values
    # The rear car's record ends 0.4 s further on, where it is continued differently, and rings back a little.
    assert difference(force[400:, 1], force[:-400, 0]) < 1e-5
    # Before the rear car reaches the road nothing moves it, beyond what wraps around.
    assert np.abs(force[:390, 1]).max() < 1e-6 * np.abs(force).max()


def plateau(height=0.01):
    """Flat up to 2.5 m, then one centimetre up within 3 m."""
    x = np.arange(-8.0, 40.0, 0.05)
    s = np.clip((x - 2.5) / 3.0, 0, 1)
    return mf.Profile(x, height * (10 * s**3 - 15 * s**4 + 6 * s**5))


def test_a_step_up_lifts_the_nose_and_presses_the_tyre():
    """The absolute facts of the signs; downward and nose down are positive.

    Slowly: while the front axle stands on the plateau and the rear one does not, the body is turned nose up by
    1 cm over the wheelbase; later it is 1 cm higher.
    """
    result = drive(profile=plateau(), speed=0.8, duration=14.0, time_step=5e-3, blend=0.0)
    x = float(result.position[0]) + 0.8 * result.time.values
    between = result.isel(time=int(np.searchsorted(x, 6.1)))
    after = result.isel(time=-1)
    # Quasi-static: what rings on is a few per cent of the step.
    assert float(between.motion.sel(dof="pitch")) == pytest.approx(-0.01 / 4.27, rel=0.03)
    assert float(between.motion.sel(dof="bounce")) == pytest.approx(-0.01 * 0.481, rel=0.03)
    assert float(between.motion.sel(dof="front_wheel")) == pytest.approx(-0.01, rel=0.03)
    assert float(after.motion.sel(dof="bounce")) == pytest.approx(-0.01, rel=0.03)
    assert float(after.motion.sel(dof="pitch")) == pytest.approx(0.0, abs=2e-5)
    assert float(after.roughness[0]) == pytest.approx(0.01, rel=1e-9)
    # Fast: a wheel that meets a rise is pressed onto the road, the road gives way, the wheel accelerates up.
    fast = drive("quarter_truck", profile=plateau(), speed=20.0, duration=1.0, blend=0.0)
    rise = fast.isel(time=int((2.5 + 0.9) / 20.0 / 1e-3))
    assert float(rise.contact_force[0]) > 0
    assert float(rise.deflection[0]) > float(rise.static_deflection[0]) > 0
    assert float(rise.acceleration.sel(dof="wheel")) < 0


@every_vehicle
def test_rigid_road_is_the_limit_of_a_stiff_one(name):
    """The response approaches that on a rigid road as the compliance does: a thousandth for a thousand times."""
    profile = rough()
    rigid = drive(name, mf.RigidGuideway(), profile)
    apart = []
    for factor in (1e2, 1e5):
        stiff = mf.track(
            mf.EulerBernoulliBeam(bending_stiffness=1.573e7 * factor, mass=711.9 * factor),
            mf.Spring(stiffness=8.0e6 * factor, damping=3.0e4 * factor),
        )
        result = drive(name, stiff, profile, truncation=500.0)
        apart.append(max(difference(result[v], rigid[v]) for v in DYNAMIC))
    assert apart[0] < 0.05
    assert apart[1] == pytest.approx(apart[0] / 1e3, rel=0.05)


@pytest.mark.parametrize(
    ("vehicle", "highest", "speed"),
    [("half_truck", 6.0, 10.0), ("three_axles", 3.0, 20.0), ("footprint", 10.0, 10.0), ("quarter_car", 2.0, 40.0)],
)
def test_truncation_of_its_own_changes_nothing(vehicle, highest, speed):
    """The promise of the contract: 1e-6 of each output, relative L2."""
    profile = rough(highest, length=5 * speed + 30.0)
    chosen = drive(vehicle, profile=profile, speed=speed, duration=5.0)
    whole = drive(vehicle, profile=profile, speed=speed, duration=5.0, truncation=500.0)
    assert 0 < chosen.attrs["truncation"] < 500
    for output in DYNAMIC:
        assert difference(chosen[output], whole[output]) < 1e-6
    dynamic = [run.deflection - run.static_deflection for run in (chosen, whole)]
    assert difference(*dynamic) < 1e-6


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_beyond_the_truncation_the_road_is_rigid():
    """Not absent: the contact force beyond it is that on a rigid road, the deflection is gone."""
    profile = rough(8.0)
    cut = drive(profile=profile, truncation=5.0)
    rigid = drive(profile=profile, road=mf.RigidGuideway())
    assert cut.attrs["truncation"] == 5.0
    middle = slice(500, 2500)
    window = np.hanning(2000)[:, None]
    high = np.fft.rfftfreq(2000, 1e-3) > 20.0
    spectra = [np.fft.rfft(r.contact_force.values[middle] * window, axis=0)[high] for r in (cut, rigid)]
    assert np.abs(spectra[0]).max() > 0
    # What the hard edge at 5 Hz leaks through the Hann window beyond 20 Hz falls off with the third power.
    assert difference(spectra[0], spectra[1]) < 0.02
    assert any(finding["code"] == "beyond_truncation" for finding in json.loads(cut.attrs["findings"]))


# A lightly damped road, and quarter trucks on it: one whose suspension hardly damps, one that does.
LIVELY = mf.track(
    mf.EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9), mf.Spring(stiffness=8.0e6, damping=3.0e3)
)
BAD = QUARTER_TRUCK | {
    "body_mass": 4000.0,
    "wheel_mass": 500.0,
    "suspension_stiffness": 4.0e5,
    "suspension_damping": 100.0,
    "tyre_stiffness": 1.8e6,
    "tyre_damping": 0.0,
}
GOOD = QUARTER_TRUCK | {
    "body_mass": 8000.0,
    "wheel_mass": 1000.0,
    "suspension_damping": 1.0e4,
    "tyre_stiffness": 4.0e6,
    "tyre_damping": 0.0,
}
FAST = 1.4 * 177.525  # critical speed of the road: √(2√(kEI)/m)


def growing_roots(vehicle, speed):
    """Zeros of 1 + D G with 0.05 < −Im ω < 60 rad/s: minima on a grid, each followed by Newton's method."""

    def value(omega):
        omega = np.ravel(omega)
        stiffness = np.array([dynamic_stiffness(vehicle, w)[0, 0] for w in omega])
        return 1.0 + stiffness * LIVELY.moving_frf([0.0], speed, omega)[:, 0]

    across, down = np.linspace(2.0, 300.0, 90), np.geomspace(0.05, 60.0, 30)
    size = np.abs(value(across[:, None] - 1j * down)).reshape(90, 30)
    inner = size[1:-1, 1:-1]
    around = [size[1 + i : 89 + i, 1 + j : 29 + j] for i in (-1, 0, 1) for j in (-1, 0, 1) if i or j]
    found = []
    for i, j in np.argwhere(inner <= np.minimum.reduce(around)):
        root = across[i + 1] - 1j * down[j + 1]
        for _ in range(40):
            small = 1e-6 * abs(root)
            at, right, left = value(np.array([root, root + small, root - small * (1 + 0j)]))
            root -= at * 2 * small / (right - left)
            if root.imag > 0:
                break
        if root.imag < 0 and abs(value(np.array([root]))[0]) < 1e-8:
            found.append(root)
    return found


def test_a_growing_vibration_is_refused():
    vehicle = mf.quarter_car(**BAD)
    assert len(growing_roots(vehicle, FAST)) == 1
    profile = rough(0.2, length=400.0)
    with pytest.raises(mf.SolveError, match="unstable together"):
        mf.simulate(LIVELY, vehicle, profile, speed=FAST, duration=1.0)


def test_a_growing_vibration_is_named():
    """Frequency and growth of the vibration that grows, to the four digits of the message."""
    vehicle = mf.quarter_car(**BAD)
    (root,) = growing_roots(vehicle, FAST)
    with pytest.raises(mf.SolveError, match="unstable together") as refused:
        mf.simulate(LIVELY, vehicle, rough(0.2, length=400.0), speed=FAST, duration=1.0)
    assert f"{root.real / (2 * np.pi):.4g} Hz" in str(refused.value)
    assert f"e^({-root.imag:.4g} t)" in str(refused.value)


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_a_decaying_vibration_above_the_critical_speed_is_not():
    vehicle = mf.quarter_car(**GOOD)
    assert not growing_roots(vehicle, FAST)
    result = mf.simulate(LIVELY, vehicle, rough(0.2, length=400.0), speed=FAST, duration=1.0)
    assert result.sizes["time"] == 1000
    assert any(f["code"] == "critical_speed" for f in json.loads(result.attrs["findings"]))


@pytest.mark.parametrize("name", DAMPED)
def test_speeds_far_below_the_critical_one_are_stable(name):
    result = drive(road=DAMPED[name], speed=0.1 * DAMPED[name].critical_speed, profile=rough(1.0, length=150.0))
    assert np.isfinite(result.motion.values).all()

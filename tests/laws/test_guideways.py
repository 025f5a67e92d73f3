"""The laws of `guideways.guideway`, put to every guideway at rest, below and above its critical speed."""

from __future__ import annotations

import numpy as np
import pytest

import movingfrf as mf
from movingfrf.guideways.track import Track
from tests.helpers import (
    ABOVE,
    BALLAST,
    BELOW,
    DAMPED,
    GUIDEWAYS,
    PAD,
    RAIL,
    SHARES,
    SOIL,
    SUBGRADE,
    UNDAMPED,
    difference,
)

# ξ = 0, near and far, ahead and behind [m]; both signs of the frequency [rad/s], without zero.
OFFSETS = np.array([0.0, 0.5, 3.0, -0.5, -3.0])
OMEGA = np.r_[-np.geomspace(600.0, 2.0, 12), np.geomspace(2.0, 600.0, 12)]

# The sum of a few residues loses a few of the sixteen digits.
ROUNDING = 1e-12

ROADS = {name: listed.guideway for name, listed in GUIDEWAYS.items()}
KNOWN = {name: listed.compliance for name, listed in GUIDEWAYS.items() if listed.compliance}
LOSSY = [name for name, listed in GUIDEWAYS.items() if listed.damped]

every_guideway = pytest.mark.parametrize("name", ROADS)
every_damped_one = pytest.mark.parametrize("name", LOSSY)
every_known_one = pytest.mark.parametrize("name", KNOWN)
every_speed = pytest.mark.parametrize("share", SHARES)


def worst(first, second):
    """Greatest difference over all offsets, relative to the greatest magnitude at each frequency."""
    return float((np.abs(first - second) / np.abs(second).max(axis=1, keepdims=True)).max())


@every_guideway
@every_speed
def test_mirror(name, share):
    road = ROADS[name]
    speed = share * road.critical_speed
    there = road.moving_frf(OFFSETS, speed, OMEGA)
    assert worst(road.moving_frf(-OFFSETS, -speed, OMEGA), there) < ROUNDING


@every_damped_one
def test_ahead_and_behind_differ_in_motion_only(name):
    road = ROADS[name]
    speed = 0.6 * road.critical_speed
    assert worst(road.moving_frf(-OFFSETS, 0.0, OMEGA), road.moving_frf(OFFSETS, 0.0, OMEGA)) < ROUNDING
    assert worst(road.moving_frf(-OFFSETS, speed, OMEGA), road.moving_frf(OFFSETS, speed, OMEGA)) > 0.01


@every_guideway
@every_speed
@pytest.mark.parametrize("decay", [0.0, 3.0])
def test_reality(name, share, decay):
    road = ROADS[name]
    speed = share * road.critical_speed
    omega = OMEGA - 1j * decay
    there = road.moving_frf(OFFSETS, speed, omega)
    assert worst(road.moving_frf(OFFSETS, speed, -omega.conj()), there.conj()) < ROUNDING


# Waves of any length, and frequencies in the fixed frame up to where a resonant layer ends.
KAPPA, FREQUENCY = (
    grid.ravel() for grid in np.meshgrid(np.r_[0.0, np.geomspace(0.01, 20.0, 25)], OMEGA * 20.0, indexing="xy")
)


@every_known_one
def test_dissipation(name):
    """Im C · sign Ω ≤ 0 for every wave."""
    waves = KNOWN[name](KAPPA, FREQUENCY)
    assert (waves.imag * np.sign(FREQUENCY) <= 1e-12 * np.abs(waves)).all()
    if name in LOSSY:
        assert (waves.imag * np.sign(FREQUENCY) < 0).all()


@pytest.mark.parametrize(
    "name", [name for name, road in ROADS.items() if isinstance(road, Track) and name in KNOWN]
)
def test_the_table_of_polynomials_is_the_dynamic_stiffness(name):
    ratio = ROADS[name].stiffness()
    above, below = (
        np.polynomial.polynomial.polyval2d(KAPPA, 1j * FREQUENCY, table) for table in (ratio.above, ratio.below)
    )
    waves = below / above
    # A ratio of polynomials of degree up to ten, summed in floating point.
    assert (waves.imag * np.sign(FREQUENCY) <= 1e-12 * np.abs(waves)).all()
    expected = KNOWN[name](KAPPA, FREQUENCY)
    # Near an undamped resonance both lose digits by cancellation in the sum of the stiffness.
    resonant = np.abs(expected) > 1e3 * np.median(np.abs(expected))
    assert (np.abs(waves - expected) <= 1e-8 * np.abs(expected))[~resonant].all()
    if name in LOSSY:
        assert (waves.imag * np.sign(FREQUENCY) < 0).all()


def wave_integral(compliance, offsets, speed, omega, panels):
    """METHOD.md section 3 (b): (1/2π) ∫ C(κ, ω − κv) e^{iκξ} dκ, by quadrature.

    Gauss and Legendre on panels along the real axis up to ±K, graded towards κ = 0, then vertical rays on
    which the integrand decays; K lies beyond every wave of the guideway.
    """
    nodes, weights = np.polynomial.legendre.leggauss(16)
    # The wave that deflects half as much as an even load.
    scale = next(
        k for k in np.geomspace(1e-3, 1e3, 601) if abs(compliance(k, 0.0)) < 0.5 * abs(compliance(0.0, 0.0))
    )
    # A layer of mass adds waves of frequencies up to (k₁ + k₂)/(c₁ + c₂), seen at the wavenumber Ω/v.
    reach = np.arcsinh((60.0 * scale + (5.0e3 / speed if speed else 0.0)) / scale)
    edges = np.linspace(-reach, reach, panels + 1)
    half = np.diff(edges) / 2
    u = (edges[:-1] + half + half * nodes[:, None]).ravel()
    du = (half * weights[:, None]).ravel()
    kappa, dkappa = scale * np.sinh(u), scale * np.cosh(u) * du
    end = scale * np.sinh(reach)
    # t from 0 to ∞ by t = K s/(1 − s).
    s = np.concatenate([(n + (nodes + 1) / 2) / 40 for n in range(40)])
    ds = np.tile(weights / 80, 40)
    t, dt = end * s / (1 - s), end * ds / (1 - s) ** 2
    result = np.empty((omega.size, offsets.size), complex)
    for side, members in ((1j, offsets >= 0), (-1j, offsets < 0)):
        path = np.concatenate([kappa, end + side * t, -end + side * t])
        dpath = np.concatenate([dkappa, side * dt, -side * dt])
        waves = np.exp(1j * path[:, None] * offsets[members]) * dpath[:, None] / (2 * np.pi)
        for row, w in zip(result, omega, strict=True):
            row[members] = compliance(path, w - path * speed) @ waves
    return result


@every_known_one
@every_speed
def test_moving_frf_is_the_integral_over_all_waves(name, share):
    """Undamped tracks, and the undamped rotation of a Timoshenko beam, are kept off the real axis by ω − iη."""
    road = ROADS[name]
    speed = share * road.critical_speed
    decay = 0.5 if name in LOSSY and "timoshenko" not in name else 60.0 + 0.1 * speed
    omega = np.array([0.0, 31.0, -97.0, 420.0]) - 1j * decay
    # What does not bend follows short waves, too.
    fineness = (600, 900) if isinstance(road, Track) else (1800, 2700)
    coarse, fine = (wave_integral(KNOWN[name], OFFSETS, speed, omega, panels) for panels in fineness)
    error = worst(coarse, fine)
    assert error < 1e-8, "the quadrature itself has not converged"
    assert worst(road.moving_frf(OFFSETS, speed, omega), fine) < max(10 * error, 1e-10)


def differentiable(road):
    """Tell whether a guideway knows derivatives along it; none is obliged to."""
    try:
        road.moving_frf(1.0, 0.0, [1.0], derivative=3)
    except ValueError:
        return False
    return True


@pytest.mark.parametrize("name", [name for name, road in ROADS.items() if differentiable(road)])
@every_speed
def test_derivative_is_a_finite_difference(name, share):
    """Central differences of eighth order, step 2 cm: relative error (κ·step)^8/630 < 1e-8 for κ < 10."""
    road = ROADS[name]
    speed = share * road.critical_speed
    step, omega = 0.02, np.array([0.0, 40.0, 200.0]) - 0.7j
    first = np.array([1 / 280, -4 / 105, 1 / 5, -4 / 5, 0, 4 / 5, -1 / 5, 4 / 105, -1 / 280])
    for centre in (1.0, -1.0):
        for order in (1, 2, 3):
            exact = road.moving_frf([centre], speed, omega, derivative=order)
            lower = road.moving_frf(centre + step * np.arange(-4, 5), speed, omega, derivative=order - 1)
            assert worst((lower @ first / step)[:, None], exact) < 1e-6


@every_guideway
def test_no_step_between_rest_and_slow_travel(name):
    """G is smooth in v: between 0 and 1e-3 m/s it changes by the order of v/v_cr."""
    road, omega = ROADS[name], OMEGA - 0.1j
    rest = road.moving_frf(OFFSETS, 0.0, omega)
    for speed in (1e-14, 1e-12, 1e-9, 1e-6, 1e-3):
        moving = road.moving_frf(OFFSETS, speed, omega)
        assert worst(moving, rest) < 1e-9 + 2 * speed / road.critical_speed * 50


@every_known_one
def test_volume_of_the_basin(name):
    """∫ G dξ = C(0, ω): at rest the foundation carries the load, ∫ k w dx = P, at any speed."""
    road = ROADS[name]
    step = 0.02
    offsets = np.arange(-6000, 6000) * step + step / 2
    for share in SHARES:
        # Decay enough for the basin to end within 120 m: |Im κ| is about η over the speed of the waves.
        speed = share * road.critical_speed
        omega = np.array([0.0, 45.0]) - 1j * (90.0 + speed / 4)
        volume = road.moving_frf(offsets, speed, omega).sum(axis=1) * step
        expected = KNOWN[name](0.0, omega)
        # Midpoint rule over a kink in the third derivative at ξ = 0: second order at worst, (κ step)²/24.
        assert np.abs(volume / expected - 1).max() < 2e-4


@pytest.mark.parametrize("name", [name for name in LOSSY if name in KNOWN])
@every_speed
def test_the_foundation_carries_a_steady_load(name, share):
    """Equilibrium in steady travel: ∫ k w dx = P, with k what an even load meets; no decay is added here.

    Midpoint rule in steps of 1 cm, over a basin that damping ends within 200 m.
    """
    road = ROADS[name]
    foundation = 1 / KNOWN[name](0.0, 0.0).real
    offsets = (np.arange(-20_000, 20_000) + 0.5) * 0.01
    basin = road.moving_frf(offsets, share * road.critical_speed, [0.0])[0].real
    assert foundation * basin.sum() * 0.01 == pytest.approx(1.0, abs=1e-4)


@every_guideway
@pytest.mark.parametrize("share", [*BELOW, *ABOVE])
def test_undamped_road_is_the_limit_of_a_vanishing_decay(name, share):
    """Real ω stands for ω − i0⁺. G changes by |ω ∂G/∂ω| 1e-9, tens of times larger near a cut-off."""
    road = ROADS[name]
    speed = share * road.critical_speed
    omega = OMEGA[OMEGA > 0]
    limit = road.moving_frf(OFFSETS, speed, omega * (1 - 1e-9j))
    assert worst(road.moving_frf(OFFSETS, speed, omega), limit) < 1e-6


# Resonant layers carry waves at every speed.
@pytest.mark.parametrize("name", [name for name in UNDAMPED if "rail" not in name])
def test_undamped_road_radiates_beyond_its_critical_speed_only(name):
    """A steady load makes waves above the critical speed: long ones behind it, short ones ahead.

    Their group velocity is below, respectively above, the speed of the load; which side each real wave
    is on is decided by the limit ω − i0⁺ alone.
    """
    speed = UNDAMPED[name].critical_speed
    far = np.array([-200.0, -190.0, 190.0, 200.0])
    calm = np.abs(UNDAMPED[name].moving_frf(far, 0.5 * speed, [0.0]))
    assert calm.max() < 1e-12 * UNDAMPED[name].moving_frf([0.0], 0.0, [0.0]).real
    x = np.linspace(100.0, 140.0, 4001)
    ahead, behind = (UNDAMPED[name].moving_frf(side * x, 1.5 * speed, [0.0])[0].real for side in (1, -1))
    crossings = [np.count_nonzero(np.diff(np.sign(wave))) for wave in (ahead, behind)]
    assert crossings[0] > 2 * crossings[1] > 4


@every_damped_one
@pytest.mark.parametrize("share", [0.3, 0.6, 0.9])
def test_basin_trails_the_load(name, share):
    """An absolute fact: damping holds the basin back, its deepest point lies behind a travelling load."""
    road = ROADS[name]
    speed = share * road.critical_speed
    x = np.linspace(-3.0, 3.0, 1201)
    basin = road.moving_frf(x, speed, [0.0])[0].real
    # Only what bends is smooth under the load.
    assert x[basin.argmax()] < (-0.002 if isinstance(road, Track) else 1e-9)
    assert (basin[:600] > basin[:600:-1])[-200:].all()  # within a metre: behind is deeper than ahead


def pulse(time, at, width):
    """Evaluate a Gauss curve, zero to double precision beyond eight widths."""
    return np.exp(-0.5 * ((time - at) / width) ** 2)


# Observers on both sides; a pulse of 5 ms: content up to 8/(2π·5 ms) = 255 Hz, below half the sampling rate.
POINTS, PULSE_AT, PULSE_WIDTH, STEP = np.array([0.0, 2.0, -2.0, 10.0, -10.0]), 0.5, 5e-3, 1e-3


@every_damped_one
@every_speed
@pytest.mark.filterwarnings("ignore:the speed of:movingfrf.ValidityWarning")
def test_nothing_moves_before_the_pulse(name, share):
    road = ROADS[name]
    time = np.arange(1500) * STEP
    force = 1e5 * pulse(time, PULSE_AT, PULSE_WIDTH)[:, None]
    moved = mf.moving_loads(
        road, force, [0.0], speed=share * road.critical_speed, time_step=STEP, observe=POINTS
    ).deflection.values
    before = np.abs(moved[time < PULSE_AT - 8 * PULSE_WIDTH]).max()
    # What is left one second after the pulse comes back weaker by less than 1e-4; rounding grows by up to 1e5.
    left = np.abs(moved[-100:]).max()
    assert before < 1e-4 * left + 1e-9 * np.abs(moved).max()


@every_guideway
@pytest.mark.parametrize("speed", [40.0, 250.0])
@pytest.mark.filterwarnings("ignore:the deflection has not died away:movingfrf.ValidityWarning")
@pytest.mark.filterwarnings("ignore:the speed of:movingfrf.ValidityWarning")
def test_a_moving_load_is_a_row_of_fixed_ones(name, speed):
    """The absolute fact of the direction of travel, METHOD.md section 2: g(ξ, s) = h(ξ + vs, s).

    A load that travels is at every sample a load of one sample's duration at a fixed place v·t. The sum over
    fixed places, seen from a fixed place, is exact for wavenumbers up to (π/step − bandwidth)/v, beyond which
    G has fallen by (κ/q)³ for an Euler and Bernoulli beam: by 1e-4 at 40 m/s and 1e-2 at 250 m/s.
    """
    road, time = ROADS[name], np.arange(800) * STEP
    force = 1e5 * pulse(time, 0.1, PULSE_WIDTH)
    struck = np.flatnonzero(force > 1e-10 * force.max())
    fixed = np.zeros((time.size, struck.size))
    fixed[struck, np.arange(struck.size)] = force[struck]
    moments = np.array([105, 130, 160])
    observers = np.array([-4.0, -1.0, 0.0, 1.5])
    places = observers + speed * time[moments][:, None]
    seen_there = (
        mf.moving_loads(road, fixed, speed * time[struck], speed=0.0, time_step=STEP, observe=places.ravel())
        .deflection.values[moments]
        .reshape(3, 3, 4)[np.arange(3), np.arange(3)]
    )
    ahead, behind = (
        mf.moving_loads(road, force[:, None], [0.0], speed=v, time_step=STEP, observe=observers).deflection.values[
            moments
        ]
        for v in (speed, -speed)
    )
    # Where little is left, what is left of rounding: the exponential window raises it.
    size = np.maximum(np.abs(seen_there).max(axis=1), 1e-5 * np.abs(seen_there).max())
    # An undamped road wraps around less than 1e-4 of what is left at the end; it started as the pulse did.
    tolerance = 3e-4 if speed < 100 else 1e-2
    if not isinstance(road, Track):
        tolerance = 0.06  # of a string it falls with κ/q alone
    assert (np.abs(ahead - seen_there).max(axis=1) < tolerance * size).all()
    # Travelling the other way is seen: the more, the nearer the critical speed.
    assert (np.abs(behind - seen_there).max(axis=1) > min(0.1, 0.5 * speed / road.critical_speed) * size).any()


@every_damped_one
def test_a_load_settles(name):
    """Switched on, and in the end as if it had always been there."""
    moved = mf.moving_loads(
        ROADS[name], np.full((1200, 1), 1e5), [0.0], speed=20.0, time_step=STEP
    ).deflection.values
    steady = 1e5 * ROADS[name].moving_frf([0.0], 20.0, [0.0])[0].real
    assert moved[-1] == pytest.approx(steady, rel=1e-3)


@pytest.mark.parametrize("speed", [0.0, 30.0])
def test_rigid_guideway_is_the_limit_of_a_stiff_one(speed):
    """Twice as stiff in every part gives way half as much; no part stands in the way of the limit."""
    sizes = []
    for factor in (1.0, 1e3, 1e6):
        road = mf.track(
            mf.EulerBernoulliBeam(bending_stiffness=1.573e7 * factor, mass=711.9 * factor),
            mf.Spring(stiffness=8.0e6 * factor, damping=3.0e4 * factor),
        )
        sizes.append(road.moving_frf(OFFSETS, speed, OMEGA))
    rigid = mf.RigidGuideway().moving_frf(OFFSETS, speed, OMEGA)
    assert rigid.shape == sizes[0].shape
    for factor, frf in zip((1e3, 1e6), sizes[1:], strict=True):
        assert difference(factor * frf, sizes[0]) < 1e-9
        assert np.abs(frf - rigid).max() < 1.01 * np.abs(sizes[0]).max() / factor


def test_offsets_keep_their_shape():
    """The contact matrix comes out as (frequency, receiver, source), receiver minus source."""
    positions = np.array([2.0, -2.0, -3.5])
    road, omega = DAMPED["euler_bernoulli_winkler"], OMEGA[-3:]
    frf = road.moving_frf(positions[:, None] - positions, 50.0, omega)
    for i, receiver in enumerate(positions):
        for j, source in enumerate(positions):
            alone = road.moving_frf(receiver - source, 50.0, omega)
            assert alone.shape == (3,)
            np.testing.assert_allclose(frf[:, i, j], alone, rtol=1e-13)


@pytest.mark.parametrize("damping", [1.0, 1e3, 2e4])
@pytest.mark.parametrize("speed", [1e-12, 1e-9, 1e-7, 1e-5])
def test_roots_that_run_away_take_nothing_with_them(damping, speed):
    """Bending damping and masses add roots that grow as 1/v; what v itself changes is of the order of v."""
    beam = mf.EulerBernoulliBeam(bending_stiffness=6.4e6, mass=60.0, bending_damping=damping)
    for foundation in (
        SOIL,
        mf.OnMass(above=PAD, mass=250.0, below=mf.OnMass(above=BALLAST, mass=900.0, below=SUBGRADE)),
    ):
        road = mf.track(beam, foundation)
        omega, ahead = 2 * np.pi * np.linspace(0.0, 200.0, 41), [0.0, 4.0, -4.0]
        at_rest, slow = (road.moving_frf(ahead, v, omega) for v in (0.0, speed))
        assert np.abs(slow / at_rest - 1).max() < speed + 1e-12


def test_layers_are_numbered_from_the_top_however_they_nest():
    """Pad, mass, ballast, mass, subgrade: the same track whether it nests above or below."""
    above = mf.OnMass(above=mf.OnMass(above=PAD, mass=1000.0, below=BALLAST), mass=250.0, below=SUBGRADE)
    below = mf.OnMass(above=PAD, mass=1000.0, below=mf.OnMass(above=BALLAST, mass=250.0, below=SUBGRADE))
    omega = 2 * np.pi * np.linspace(1.0, 200.0, 20)
    first, second = (mf.track(RAIL, foundation).moving_frf(0.0, 10.0, omega) for foundation in (above, below))
    assert np.abs(first / second - 1).max() < 1e-12
    # The second is the one that test_dissipation_and_polynomials compares with the equations of motion.


def test_across_broadcasts_with_ahead():
    road = DAMPED["euler_bernoulli_winkler"]
    frf = road.moving_frf(0.0, 10.0, [1.0, 2.0, 3.0], across=np.zeros(3))
    assert frf.shape == (3, 3)
    assert (frf == frf[:, :1]).all()
    assert road.moving_frf([0.0, 1.0], 10.0, []).shape == (0, 2)

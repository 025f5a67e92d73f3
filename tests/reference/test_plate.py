"""Roads as wide as they are: plates against closed forms, waves across a section, and the frequency domain."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve

import movingfrf as mf
from movingfrf.stepping.marching import March
from movingfrf.stepping.schemes import SCHEMES
from movingfrf.stepping.tie import tie_of
from tests.helpers import DAMPED, FULL_TRUCK, QUARTER_TRUCK, TIMOSHENKO, apart, difference, observed_order

# Two metres of the reference road, damped so strongly that what is struck is at rest after a third of a second.
WIDTH = 2.0
BENDING, MASS, STIFFNESS = 1.573e7, 711.9, 8.0e6  # per metre of width
TRACK = mf.track(
    mf.EulerBernoulliBeam(bending_stiffness=WIDTH * BENDING, mass=WIDTH * MASS),
    mf.Spring(stiffness=WIDTH * STIFFNESS, damping=WIDTH * 1.0e5),
)
# Damped in bending as well, on a shear layer.
SHEARED = mf.track(
    replace(TRACK.beam, bending_damping=4.0e4),
    mf.ShearLayer(stiffness=1.6e7, damping=2.0e5, shear_stiffness=4.0e6),
)

# Wheels at nodes; tyres whose dashpots matter.
CAR = mf.full_car(**(FULL_TRUCK | {"sides": (0.5, -0.5), "tyre_damping": (4.0e4, 5.0e4)}))


def undamped(width):
    """One of some width, at rest."""
    return mf.track(
        mf.EulerBernoulliBeam(bending_stiffness=width * BENDING, mass=width * MASS),
        mf.Spring(stiffness=width * STIFFNESS, damping=0.0),
    )


def plate(track=TRACK, width=WIDTH, half=20.0, element=0.25, across=4, **more):
    return mf.finite_plate(
        track, **({"width": width, "first": -half, "last": half, "element": element, "across": across} | more)
    )


# The same from scratch: cubic functions along a line, of value and slope at either end, and their integrals.


def cubics(share, size, order):
    """Evaluate derivatives of the four functions of an element, shape (4, *share)."""
    coefficients = np.array([[1, 0, -3, 2], [0, size, -2 * size, size], [0, 0, 3, -2], [0, 0, -size, size]])
    functions = [np.polynomial.Polynomial(row).deriv(order) for row in coefficients]
    return np.array([function(share) for function in functions]) / size**order


def integrals(size, count, first, second, weight=None):
    """Integrate products of derivatives, times a weight, along a line of elements from 0; dense."""
    points, weights = np.polynomial.legendre.leggauss(8)
    share, whole = 0.5 * (points + 1), np.zeros((2 * count + 2, 2 * count + 2))
    for n in range(count):
        here = slice(2 * n, 2 * n + 4)
        heavy = 0.5 * size * weights * (1.0 if weight is None else weight(size * (n + share)))
        whole[here, here] += (cubics(share, size, first) * heavy) @ cubics(share, size, second).T
    return whole


def line_row(at, size, count):
    """List the functions of a line of elements from 0 at one place."""
    n = min(int(at / size), count - 1)
    row = np.zeros(2 * count + 2)
    row[2 * n : 2 * n + 4] = cubics(at / size - n, size, 0)
    return row


def stiffnesses(bending, poisson, transverse):
    """D_x, D_y, D_1 and the factor of w_xy² for a beam's bending stiffness per width."""
    along = bending / (1 - poisson**2)
    mean = np.sqrt(transverse) * along
    return along, transverse * along, poisson * mean, 2 * (1 - poisson) * mean


@pytest.mark.parametrize("track", [TRACK, SHEARED], ids=["springs", "shear layer"])
@pytest.mark.parametrize(("poisson", "transverse"), [(0.0, 1.0), (0.35, 1.0), (0.2, 3.0)])
def test_matrices_are_products_of_lines(track, poisson, transverse):
    """Cubic along times cubic across: each integral over the plate is one along times one across.

    Gauss points in either program are exact for polynomials of degree six, so that only rounding is left.
    """
    long, wide, size, breadth = 5, 3, 0.8, WIDTH / 3
    road = plate(track, half=2.0, element=size, across=wide, poisson=poisson, transverse=transverse, ends="free")
    along = [[integrals(size, long, a, b) for b in range(3)] for a in range(3)]
    aside = [[integrals(breadth, wide, a, b) for b in range(3)] for a in range(3)]

    def over(a, b, c, d):
        """∫ ∂^(a+b) u/∂x^a ∂y^b · ∂^(c+d) v/∂x^c ∂y^d, numbered node by node across, then along."""
        whole = np.kron(along[a][c], aside[b][d])
        places = np.arange(len(whole)).reshape(long + 1, 2, wide + 1, 2)
        # At a node: deflection, slope along, slope across, twist.
        order = places.transpose(0, 2, 3, 1).ravel()
        return whole[np.ix_(order, order)]

    dx, dy, d1, twice = stiffnesses(track.beam.bending_stiffness / WIDTH, poisson, transverse)
    bending = dx * over(2, 0, 2, 0) + dy * over(0, 2, 0, 2) + twice * over(1, 1, 1, 1)
    bending += d1 * (over(2, 0, 0, 2) + over(0, 2, 2, 0))
    carried, soil = over(0, 0, 0, 0), track.foundation
    stiffness = bending + soil.stiffness / WIDTH * carried
    if isinstance(soil, mf.ShearLayer):
        stiffness += soil.shear_stiffness / WIDTH * (over(1, 0, 1, 0) + over(0, 1, 0, 1))
    damping = soil.damping / WIDTH * carried
    damping += track.beam.bending_damping / track.beam.bending_stiffness * bending
    for found, wanted in (
        (road.mass, track.beam.mass / WIDTH * carried),
        (road.damping, damping),
        (road.stiffness, stiffness),
    ):
        assert np.abs(found.toarray() - wanted).max() < 1e-12 * np.abs(wanted).max()


def test_rows_interpolate_what_is_cubic_either_way():
    """A polynomial of degree three along and across, given by its nodal values, at any place, and its slope."""
    road = plate(half=2.0, element=0.8, across=3, ends="free")
    field = np.array([[0.3, -1.2, 0.5, 0.7], [1.1, 0.4, -0.6, 0.2], [-0.8, 0.9, 0.1, -0.3], [0.6, -0.5, 0.2, 0.4]])

    def value(x, y, a=0, b=0):
        table = np.polynomial.polynomial.polyder(np.polynomial.polynomial.polyder(field, a, axis=0), b, axis=1)
        return np.polynomial.polynomial.polyval2d(*np.broadcast_arrays(x, y), table)

    x, y = np.meshgrid(np.linspace(-2.0, 2.0, 6), np.linspace(-1.0, 1.0, 4), indexing="ij")
    nodal = np.stack([value(x, y), value(x, y, 1), value(x, y, 0, 1), value(x, y, 1, 1)], axis=-1).ravel()
    along, aside = np.array([-2.0, -1.93, -0.4, 0.31, 1.2, 2.0]), np.array([1.0, -0.77, 0.33, 0.0, -1.0, 0.9])
    np.testing.assert_allclose(road.rows(along, 0, aside) @ nodal, value(along, aside), rtol=1e-12)
    np.testing.assert_allclose(road.rows(along, 1, aside) @ nodal, value(along, aside, 1), rtol=1e-12)
    # One place across for all, and the centre line unless told otherwise.
    np.testing.assert_allclose(road.rows(along, 0, -0.4) @ nodal, value(along, -0.4), rtol=1e-12)
    assert (road.rows(along) != road.rows(along, 0, 0.0)).nnz == 0


@pytest.mark.parametrize(
    ("end", "sinks", "turns"),
    [("pinned", False, True), ("clamped", False, False), ("guided", True, False), ("free", True, True)],
)
def test_ends_hold_all_of_the_width(end, sinks, turns):
    """Deflection or slope along is held at every place across the end, and nowhere at the other one."""
    road = plate(half=2.0, element=0.8, across=3, ends=(end, "free"))
    anything = np.random.default_rng(5).normal(size=road.dofs)
    places = np.linspace(-1.0, 1.0, 7)
    for at, sinking, turning in ((-2.0, sinks, turns), (2.0, True, True)):
        deflection, slope = (road.rows(np.full(7, at), order, places) @ anything for order in (0, 1))
        assert (np.abs(deflection) > 1e-3).all() if sinking else np.abs(deflection).max() < 1e-14
        assert (np.abs(slope) > 1e-3).all() if turning else np.abs(slope).max() < 1e-13


def test_absorbing_ends_spread_their_dashpots_over_the_width():
    """1.5 · 2√(km), growing from nothing by a quintic step; exact integrals here, to degree six there."""
    long, wide, size, length = 16, 2, 0.5, 3.0
    road = plate(half=4.0, element=size, across=wide, ends=("free", "absorbing"), absorbing=length)

    def strength(x):
        share = np.clip(1 - (8.0 - x) / length, 0, 1)
        return 3.0 * np.sqrt(STIFFNESS * MASS) * share**3 * (10 - 15 * share + 6 * share**2)

    wanted = np.kron(integrals(size, long, 0, 0, strength), integrals(WIDTH / wide, wide, 0, 0))
    places = np.arange(len(wanted)).reshape(long + 1, 2, wide + 1, 2)
    order = places.transpose(0, 2, 3, 1).ravel()[: road.dofs]  # the last nodes are held
    extra = road.damping - plate(half=4.0, element=size, across=wide, ends="free").damping[: road.dofs, : road.dofs]
    assert np.abs(extra - wanted[np.ix_(order, order)]).max() < 1e-3 * np.abs(wanted).max()


def at_rest(road, force, places):
    """Deflection (place,) at x = 0 under forces on all unknowns."""
    return road.rows(np.zeros(len(places)), 0, np.array(places)) @ spsolve(road.stiffness, force)


def point(road, across=0.0):
    return road.rows(np.zeros(1), 0, across).toarray()[0]


@pytest.mark.parametrize("poisson", [0.0, 0.35])
def test_a_point_load_on_a_wide_plate(poisson):
    """Under it w = P/(8 √(kD)), whatever Poisson's ratio (Hertz 1884; Timoshenko and Woinowsky-Krieger, §57).

    Under the load the curvature grows as log r, which cubic functions follow with order 2; at sixteen times (D/k)^¼
    what edges send back is e^(−16/√2) = 1e-5, and corners little more.
    """
    bending = BENDING / (1 - poisson**2)
    side = 16 * (bending / STIFFNESS) ** 0.25
    errors = []
    for count in (16, 32, 48):
        element = side / count * (1 + 1e-9)
        road = plate(undamped(side), side, 0.5 * side, element, count, poisson=poisson, ends="free", band=0.0)
        force = point(road)
        errors.append(at_rest(road, force, [0.0])[0] * 8 * np.sqrt(STIFFNESS * bending) - 1)
    errors = np.array(errors)
    assert observed_order([1 / 16, 1 / 32, 1 / 48], -errors) == pytest.approx(2.0, abs=0.1)
    assert abs(errors[-1]) < 2e-3
    # Extrapolated in h².
    assert abs((2.25 * errors[2] - errors[1]) / 1.25) < 1e-4


# Per metre of width: deflection λ/(2k) under a unit load, λ = (k/4B)^¼.
def beam(bending):
    return (STIFFNESS / (4 * bending)) ** 0.25 / (2 * STIFFNESS)


def test_a_section_stiff_enough_stays_straight():
    """Under a load in the middle the plate tends to its beam as D_y grows.

    Without Poisson's effect the section's own deflection falls as s^(−3/4): it bends over a length that grows as
    s^(1/4). With it the section is curved against the track, which twists it: of order s^(−1/2).
    """
    ratios = 10.0 ** np.arange(2, 6)
    for poisson, at, order, span in ((0.0, WIDTH / 2, 0.75, ratios[:3]), (0.35, 0.0, 0.5, ratios[1:])):
        errors = []
        for transverse in span:
            road = plate(
                undamped(WIDTH), half=20.0, poisson=poisson, transverse=transverse, ends="free", element=0.5
            )
            errors.append(at_rest(road, point(road), [at])[0] / (beam(BENDING) / WIDTH) - 1)
        assert observed_order(1 / span, -np.array(errors)) == pytest.approx(order, abs=0.1)
        assert abs(errors[-1]) < 1.5e-3


@pytest.mark.parametrize("poisson", [0.0, 0.35])
@pytest.mark.parametrize("transverse", [100.0, 1000.0])
def test_a_load_beside_the_middle_turns_a_straight_section(poisson, transverse):
    """B b³/12 θ⁗ − 2(1−ν)√s D b θ″ + k b³/12 θ = P y δ(x): θ = P y/(2√c √(T + 2√(a c))) under the load.

    A kink in the twist, which elements of half a metre follow to 1e-3; left and right as lever arms say.
    """
    road = plate(undamped(3.0), 3.0, 60.0, 0.5, 2, poisson=poisson, transverse=transverse, ends="free", band=0.0)
    bends, holds = BENDING * 3.0**3 / 12, STIFFNESS * 3.0**3 / 12
    twists = stiffnesses(BENDING, poisson, transverse)[3] * 3.0
    wanted = 1.5 / (2 * np.sqrt(holds) * np.sqrt(twists + 2 * np.sqrt(bends * holds)))
    right, middle, left = at_rest(road, point(road, 1.5), [-1.5, 0.0, 1.5])
    assert (left - right) / 3.0 == pytest.approx(wanted, rel=3e-3)
    # The middle sinks as it does under the same load there: turning does not move it.
    assert middle == pytest.approx(at_rest(road, point(road), [1.5])[0], rel=1e-9)


def test_a_line_load_bends_a_strip_and_a_plate():
    """Across all of the width: a narrow strip curves as it likes and bends with B, a wide one with B/(1 − ν²).

    What a strip's own width adds falls with its square.
    """
    poisson, points = 0.3, np.polynomial.legendre.leggauss(4)

    def deflection(width, count, places):
        road = plate(undamped(width), width, 15.0, 0.5, count, poisson=poisson, ends="free", band=0.0)
        at = width * ((0.5 * (points[0] + 1) + np.arange(count)[:, None]) / count - 0.5)
        shares = np.tile(0.5 * points[1] / count, count)
        force = shares @ road.rows(np.zeros(at.size), 0, at.ravel()).toarray()
        return at_rest(road, force, places) * width

    widths = np.array([0.5, 0.25, 0.125])
    # The middle less the edges: the section's own curve, −ν times that along.
    curved = np.array([np.subtract(*deflection(width, 2, [0.0, width / 2])) for width in widths])
    assert observed_order(widths, -curved) == pytest.approx(2.0, abs=0.2)
    # A cubic lacks the kink in the third derivative under the load, 1e-4 of it between elements of half a metre.
    assert deflection(0.125, 2, [0.0])[0] == pytest.approx(beam(BENDING), rel=5e-4)
    assert deflection(16.0, 16, [0.0])[0] == pytest.approx(beam(BENDING / (1 - poisson**2)), rel=2e-4)
    assert beam(BENDING) / beam(BENDING / (1 - poisson**2)) - 1 > 2e-2


def waves(places, speed, omega, *, track=TRACK, width=WIDTH, count=32, poisson=0.35, transverse=1.0):
    """Sum waves e^{i(Ωt + κx)} of an endless strip, Ω = ω − κv, to its moving FRF; cubic elements across.

    Places are (ahead, receiver across, source across). Of a wave the energy per length is ½ wᴴ(D_x κ⁴ ⟨N N⟩
    − D_1 κ² (⟨N N″⟩ + ⟨N″ N⟩) + D_y ⟨N″ N″⟩ + 4 D_k κ² ⟨N′ N′⟩) w. The trapezoidal rule in u, κ = sinh u,
    converges exponentially; what lies beyond 60/m is 1/(8π D 60²), 3e-5 of the largest.
    """
    beam, soil, size = track.beam, track.foundation, width / count
    dx, dy, d1, twice = stiffnesses(beam.bending_stiffness / width, poisson, transverse)
    products = {orders: integrals(size, count, *orders) for orders in ((0, 0), (1, 1), (2, 2), (0, 2), (2, 0))}
    u, step = np.linspace(-np.arcsinh(60.0), np.arcsinh(60.0), 421, retstep=True)
    kappa = np.sinh(u)
    squared = (kappa**2)[:, None, None]
    bending = dx * squared**2 * products[0, 0] + dy * products[2, 2] + twice * squared * products[1, 1]
    bending = bending - d1 * squared * (products[0, 2] + products[2, 0])
    rows = {at: line_row(at + 0.5 * width, size, count) for _, *both in places for at in both}
    sources = sorted({source for *_, source in places})
    right = np.stack([rows[source] for source in sources], axis=1)
    frf = np.empty((len(omega), len(places)), complex)
    for n, line in enumerate(omega):
        fixed = (line - kappa * speed)[:, None, None]
        carried = (soil.stiffness + 1j * fixed * soil.damping - beam.mass * fixed**2) / width
        answers = np.linalg.solve(
            bending + carried * products[0, 0], np.broadcast_to(right, (u.size, *right.shape))
        )
        for m, (ahead, receiver, source) in enumerate(places):
            seen = answers[:, :, sources.index(source)] @ rows[receiver]
            frf[n, m] = (seen * np.exp(1j * kappa * ahead) * np.cosh(u)).sum() * step / (2 * np.pi)
    return frf


# Between the wheels of the car; struck once for all tests below.
AXLES = float(np.ptp(CAR.positions))
BETWEEN_WHEELS = [(ahead, side, 0.5) for side in (0.5, -0.5) for ahead in (0.0, AXLES, -AXLES)]
OMEGA = 2 * np.pi * np.array([2.0, 6.0, 15.0, 30.0, 60.0])


def strike(places, speed, road=None, **more):
    """Strike a plate with absorbing ends for some (ahead, receiver across, source across)."""
    ahead, receiver, source = np.array(places).T
    options = {"strike": 0.0, "time_step": 2.5e-4, "scheme": "generalised_alpha"} | more
    return mf.moving_impulse_response(
        plate(absorbing=12.0) if road is None else road,
        speed=speed,
        offsets=ahead,
        across=receiver - source,
        strike_across=source,
        **options,
    )


def asked(struck, places, speed, omega=OMEGA):
    ahead, receiver, source = np.array(places).T
    return struck.moving_frf(ahead, speed, omega, across=receiver - source, source_across=source)


@pytest.fixture(scope="module")
def struck():
    both = BETWEEN_WHEELS + [(ahead, -receiver, -source) for ahead, receiver, source in BETWEEN_WHEELS]
    return strike(both, 10.0)


def test_moving_frf_between_wheels(struck):
    """Same path and opposite path, here, ahead and behind, against waves along and elements across.

    Under the load elements of half a metre across lack 9e-4 of max |G|, of a quarter 4e-4; elsewhere 2.7e-4 are
    left, the absorbing ends and the step.
    """
    wanted = waves(BETWEEN_WHEELS, 10.0, OMEGA)
    error = np.abs(asked(struck, BETWEEN_WHEELS, 10.0) - wanted) / np.abs(wanted).max()
    assert error[:, 0].max() < 1.5e-3
    assert error[:, 1:].max() < 5e-4
    # The opposite path feels a fifth to a third, ahead and behind differ: nothing passes by accident.
    assert 0.15 < np.abs(wanted[:, 3]).max() / np.abs(wanted).max() < 0.6
    assert np.abs(wanted[:, 1] - wanted[:, 2]).max() > 1e-2 * np.abs(wanted).max()


def test_moving_frf_between_the_middle_and_an_edge():
    """At three times the speed, of an orthotropic plate; an edge gives way more than the middle."""
    places = [
        (0.0, 1.0, 0.0),
        (1.5, 1.0, 0.0),
        (0.0, 0.0, 1.0),
        (-1.5, 0.0, 1.0),
        (0.0, 1.0, 1.0),
        (0.0, -1.0, 1.0),
    ]
    of = {"poisson": 0.2, "transverse": 0.6}
    wanted = waves(places, 30.0, OMEGA, **of)
    found = asked(strike(places, 30.0, plate(absorbing=12.0, **of)), places, 30.0)
    # 5e-4 under the load at the edge, which gives way three times as much as the middle; 1.7e-4 elsewhere.
    assert np.abs(found - wanted).max() < 1e-3 * np.abs(wanted).max()
    assert np.abs(found - wanted)[:, :4].max() < 4e-4 * np.abs(wanted).max()


def test_left_and_right_are_mirror_images(struck):
    """G(ξ, y ← y₀) = G(ξ, −y ← −y₀)."""
    mirrored = [(ahead, -receiver, -source) for ahead, receiver, source in BETWEEN_WHEELS]
    assert difference(asked(struck, mirrored, 10.0), asked(struck, BETWEEN_WHEELS, 10.0)) < 1e-9


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_reciprocity_at_rest():
    """Source and receiver exchanged, along and across, sample by sample."""
    road = plate(half=6.0, element=0.5, across=2, ends=("pinned", "free"))
    options = {"road": road, "duration": 0.15, "time_step": 1e-3, "band": 30.0}
    there = strike([(1.3, 0.9, -0.35)], 0.0, strike=-0.4, **options)
    back = strike([(-1.3, -0.35, 0.9)], 0.0, strike=0.9, **options)
    elsewhere = strike([(-1.3, 0.35, 0.9)], 0.0, strike=0.9, **options)
    assert difference(back.samples, there.samples) < 1e-10
    assert difference(elsewhere.samples, there.samples) > 1e-2


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_a_plate_struck_as_in_the_paper():
    """40 m, pinned, elements of half a metre, 1 ms; every pair of contacts is recorded."""
    plain = mf.struck_plate(TRACK, width=WIDTH, speed=10.0, vehicle=CAR, across=2, plain=True)
    road = plate(half=20.0, element=0.5, across=2, ends="pinned")
    places = [(AXLES, -0.5, 0.5), (0.0, -0.5, -0.5), (-AXLES, 0.5, -0.5)]
    by_hand = strike(places, 10.0, road, time_step=1e-3, scheme="average_acceleration")
    assert difference(asked(plain, places, 10.0), asked(by_hand, places, 10.0)) < 1e-6
    table = plain.moving_frf(speed=10.0, omega=OMEGA, **CAR.offsets)
    assert table.shape == (OMEGA.size, 4, 4)
    # Front left from rear right; a sum over other columns at a time rounds differently.
    alone = plain.moving_frf(AXLES, 10.0, OMEGA, across=1.0, source_across=-0.5)
    assert difference(table[:, 0, 3], alone) < 1e-12
    assert plain.critical_speed == pytest.approx(TRACK.critical_speed)


@pytest.mark.parametrize("across", [0.0, 0.75])
def test_waves_that_come_back_are_found_wherever_the_plate_is_struck(across):
    """Beside the centre line the blow also turns the section, which must not hide what comes back."""
    light = replace(undamped(3.0), foundation=mf.Spring(stiffness=3 * STIFFNESS, damping=9.0e4))
    road = plate(light, width=3.0, element=0.5, across=2, ends="pinned")
    with pytest.warns(mf.ValidityWarning) as caught:
        strike([(0.0, across, across)], 10.0, road, time_step=1e-3, scheme="average_acceleration")
    assert any("waves come back" in str(warning.message) for warning in caught)


def test_four_plates_whose_end_reflections_cancel():
    """With one element across the same functions serve the waves: what remains is 40 m, 0.25 m and 0.25 ms.

    2e-4 of max |G| (docs/methods.md: 2.6e-4 for the beam).
    """
    narrow = mf.track(
        mf.EulerBernoulliBeam(bending_stiffness=BENDING, mass=MASS), mf.Spring(stiffness=STIFFNESS, damping=1.0e5)
    )
    wheel = mf.Vehicle(
        mass=[[1000.0]],
        damping=[[0.0]],
        stiffness=[[0.0]],
        contact_map=[[1.0]],
        contacts=[mf.Contact(position=0.3, stiffness=1e6, across=-0.5)],
        vertical=[1],
        dof_names=["wheel"],
    )
    averaged = mf.struck_plate(narrow, width=1.0, speed=10.0, vehicle=wheel, across=1, poisson=0.25)
    wanted = waves([(0.0, -0.5, -0.5)], 10.0, OMEGA, track=narrow, width=1.0, count=1, poisson=0.25)
    found = asked(averaged, [(0.0, -0.5, -0.5)], 10.0)
    assert np.abs(found - wanted).max() < 5e-4 * np.abs(wanted).max()


def two_paths(seeds=(1, 2)):
    """Make a road without anything in common left and right."""
    paths = [
        mf.realise(mf.IsoRoad.of_class("A", band=(0.02, 2.0)), length=50.0, step=0.02, seed=seed, start=-8.0)
        for seed in seeds
    ]
    return mf.Profile(paths[0].distance, np.stack([np.ravel(path.elevation) for path in paths], axis=1))


def travelling(element, across):
    return plate(element=element, across=across, absorbing=12.0, travels=True)


@pytest.mark.filterwarnings("ignore:the vehicle's motion has not died away")
def test_time_and_frequency_domain_converge_to_each_other(struck):
    """Four wheels on a plate, stepped along with it, against `simulate` on the struck one.

    Elements and steps of both orders are refined at once; at the finest force 1.6e-4, motion 3e-5, acceleration and
    deflection 3.5e-4, roll 4e-6, of which the struck plate's own elements keep some. The last 50 ms are left out,
    where the two continue the profile differently.
    """
    differences = []
    for element, across, step in ((0.5, 2, 2e-3), (0.5, 4, 1e-3), (0.25, 4, 5e-4)):
        options = {"speed": 10.0, "duration": 1.0, "time_step": step}
        spectral = mf.simulate(struck, CAR, two_paths(), truncation=200.0, **options)
        stepped = mf.cdfm(travelling(element, across), CAR, two_paths(), superposed=True, run_in=0.2, **options)
        found = apart(stepped, spectral, slice(0, round(0.95 / step)))
        found["roll"] = difference(stepped.motion.sel(dof="roll"), spectral.motion.sel(dof="roll"))
        differences.append(list(found.values()))
    differences = np.array(differences)
    assert (differences[-1] < [3e-4, 6e-5, 6e-4, 7e-4, 1e-5]).all()
    assert (differences[1:] < 0.5 * differences[:-1]).all()
    np.testing.assert_allclose(stepped.static_deflection, spectral.static_deflection, rtol=2e-4)
    np.testing.assert_allclose(stepped.static_load, spectral.static_load, rtol=1e-9)
    # Both halves of the road matter.
    assert np.abs(spectral.motion.sel(dof="roll")).max() > 0.2 * np.abs(spectral.motion.sel(dof="bounce")).max()


@pytest.mark.filterwarnings("ignore:the vehicle's motion has not died away")
def test_duhamel_on_a_struck_plate(struck):
    """The same record in the time domain: of second order in the step, 1e-3 at one millisecond."""
    differences = []
    for step in (2e-3, 1e-3):
        options = {"speed": 10.0, "duration": 1.0, "time_step": step}
        convolved = mf.duhamel(struck, CAR, two_paths(), **options)
        spectral = mf.simulate(struck, CAR, two_paths(), truncation=200.0, **options)
        differences.append(list(apart(convolved, spectral, slice(0, round(0.95 / step))).values()))
    assert (np.array(differences[1]) < [1e-3, 3e-4, 5e-3, 1.5e-3]).all()
    assert (np.array(differences[1]) < 0.5 * np.array(differences[0])).all()
    np.testing.assert_allclose(convolved.static_load, spectral.static_load, rtol=1e-9)


HUMPS = mf.Profile(
    np.linspace(-40.0, 60.0, 1001),
    np.stack(
        [
            np.ravel(
                mf.bump(height=h, width=3.0, at=at, length=100.0, start=-40.0).along(0)(
                    np.linspace(-40.0, 60.0, 1001)
                )
            )
            for h, at in ((0.01, 3.0), (-0.006, 4.5))
        ],
        axis=1,
    ),
)


def over_humps(road, method=mf.cdfm, vehicle=CAR, **more):
    options = {"speed": 20.0, "duration": 0.4, "time_step": 2e-3, "blend": 0.0, "run_in": 0.3} | more
    return method(road, vehicle, HUMPS, **options)


def test_a_travelling_plate_is_a_long_one():
    """Seen from the vehicle an endless road is the same wherever it is; sixteen elements go by."""
    moving = over_humps(travelling(0.5, 2))
    whole = over_humps(plate(first=-28.0, last=30.0, element=0.5, across=2, absorbing=12.0))
    # What the ends send back, as for a beam: 1.8e-4 of the accelerations, 1.2e-4 of the deflection.
    assert max(apart(moving, whole).values()) < 4e-4
    np.testing.assert_allclose(moving.static_deflection, whole.static_deflection, rtol=1e-5)
    assert np.abs(moving.motion.sel(dof="roll")).max() > 1e-4


def test_exchanged_forces_on_a_plate_are_the_solved_ones():
    road = plate(first=-28.0, last=30.0, element=0.5, across=2, absorbing=12.0)
    coupled, exchanged = over_humps(road), over_humps(road, mf.sim)
    assert max(apart(exchanged, coupled).values()) < 1e-7


def test_schemes_on_a_plate_agree():
    """Both of order 2: at 2 ms they differ by 5e-4 of the force and 1e-4 of the deflection."""
    first, second = (
        over_humps(travelling(0.5, 2), scheme=name) for name in ("generalised_alpha", "average_acceleration")
    )
    found = apart(first, second)
    assert found["contact_force"] < 1e-3
    assert found["deflection"] < 3e-4


def test_a_car_at_rest_on_a_plate_needs_no_run_in():
    """Its equilibrium, found at once, is one: on wheels that share the weight as the road gives way under each.

    Beside the middle the body leans; the right wheels stand near the edge.
    """
    leaning = mf.full_car(**(FULL_TRUCK | {"sides": (0.3, -0.9)}))
    flat = mf.Profile(np.linspace(-20.0, 20.0, 6), np.zeros((6, 2)))
    road = plate(element=0.5, across=4, absorbing=12.0)
    result = mf.cdfm(road, leaning, flat, speed=1e-6, duration=0.1, run_in=0.0)
    assert np.abs(result.contact_force).max() < 1e-6 * leaning.static_loads.max()
    np.testing.assert_allclose(result.deflection[0], result.static_deflection, rtol=1e-9)
    rows = road.rows(leaning.positions, 0, leaning.across).toarray()
    yields = rows @ np.stack([spsolve(road.stiffness, row) for row in rows], axis=1)
    np.testing.assert_allclose(result.static_deflection, yields @ result.static_load.values, rtol=1e-9)
    # What the road redistributes turns opposite corners against each other: weight and both moments stay.
    change = result.static_load.values - leaning.static_loads
    assert np.abs(change).max() > 5e-4 * leaning.static_loads.max()
    for levers in (np.ones(4), leaning.positions, leaning.across):
        assert abs(levers @ change) < 1e-9 * leaning.static_loads.sum()


def test_forces_at_the_start_fit_any_state():
    """F = k (z − w + r) + c (ż − ẇ − v w′ + ṙ) below each wheel, and M ü + C u̇ + K u = Σ Nᵀ F on the road."""
    road, random = plate(half=8.0, element=0.5, across=2), np.random.default_rng(7)
    march = March(
        guideway=road,
        scheme=SCHEMES["average_acceleration"],
        time_step=1e-3,
        speed=30.0,
        contacts=CAR.positions + 0.7,
        contacts_across=CAR.across,
        observers=np.empty(0),
        tie=tie_of(CAR),
    )
    state = march.at_rest()
    state.guideway[:2], state.body[:2] = random.normal(size=(2, road.dofs)), random.normal(size=(2, 7))
    roughness, rate, load = random.normal(size=(3, 4))
    march.begun(state, roughness, rate, load)
    rows, slopes = (road.rows(CAR.positions + 0.7, order, CAR.across) for order in (0, 1))
    wheels, velocities = state.body[:2, 3:]
    springs, dashpots = np.array([(contact.stiffness, contact.damping) for contact in CAR.contacts]).T
    force = springs * (wheels - rows @ state.guideway[0] + roughness)
    force += dashpots * (velocities - rows @ state.guideway[1] - 30.0 * (slopes @ state.guideway[0]) + rate)
    np.testing.assert_allclose(state.acting, force + load, rtol=1e-10)
    balance = road.mass @ state.guideway[2] + road.damping @ state.guideway[1] + road.stiffness @ state.guideway[0]
    assert np.abs(balance - rows.T @ state.acting).max() < 1e-9 * np.abs(road.stiffness @ state.guideway[0]).max()


def test_points_of_the_centre_line_that_stand_still():
    """A point sees what a contact on the centre line sees while that passes it: at 3 m after 75 steps."""
    quarter = mf.quarter_car(**QUARTER_TRUCK)
    road = plate(first=-28.0, last=30.0, element=0.5, across=2, absorbing=12.0)
    result = over_humps(road, vehicle=quarter, observe=[3.0])
    assert result.place_deflection.values[75, 0] == pytest.approx(result.deflection.values[75, 0], rel=1e-12)


# What cannot be.

LAYERED, OTHER_BEAM = (
    DAMPED["rail_pad_sleeper_ballast"],
    mf.track(TIMOSHENKO, mf.Spring(stiffness=8e6, damping=0.0)),
)


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"track": LAYERED}, "track must be an Euler–Bernoulli beam on springs or a shear layer to be spread over"),
        ({"track": OTHER_BEAM}, "track must be an Euler–Bernoulli beam on springs or a shear layer"),
        ({"track": mf.RigidGuideway()}, "track must be an Euler–Bernoulli beam on springs"),
        ({"poisson": 0.5}, r"poisson must be less than 0\.5, got 0\.5"),
        ({"poisson": -0.1}, r"poisson must not be negative, got -0\.1"),
        ({"transverse": 0.0}, r"transverse must be positive, got 0\.0"),
        ({"width": 0.0}, r"width must be positive, got 0\.0 m"),
        ({"across": 0}, "across must be a whole number of at least 1, got 0"),
        ({"across": 2.0}, r"across must be a whole number of at least 1, got 2\.0"),
        (
            {"width": 10.0, "across": 4},
            r"across must be at least 6, so that an element is no wider than the length 1\.675 m over which",
        ),
        ({"element": 2.5}, r"element must be at most .* m, the length \(4 EI/k\)\^¼"),
        ({"band": 2000.0}, "element must be at most .* to the wave of .* at 2000 Hz"),
        ({"ends": "simple"}, "ends must be one or two of pinned, clamped, guided, free, absorbing, got 'simple'"),
        ({"ends": "free", "travels": True}, "ends of a road that travels along must be among absorbing, clamped"),
        ({"half": 0.3}, "last must lie four elements of 0.25 m or more behind first"),
        ({"absorbing": 21.0}, "absorbing must be at most half of the stretch, 20 m, got 21.0 m"),
    ],
)
def test_plates_that_make_no_sense(more, message):
    with pytest.raises(ValueError, match=message):
        plate(**more)


@pytest.mark.parametrize("method", [mf.cdfm, mf.sim])
def test_wheels_beside_the_road(method):
    """Half of the width is where it ends; on its edge a wheel still stands."""
    road = plate(width=0.9, element=0.5, across=1, half=26.0)
    message = r"road must be wide enough: it is 0\.9 m wide, and a contact or a point stands 0\.5 m from its centre"
    with pytest.raises(ValueError, match=message):
        over_humps(road, method)
    with pytest.raises(ValueError, match=message):
        mf.struck_plate(TRACK, width=0.9, speed=10.0, vehicle=CAR, across=1)
    over_humps(plate(width=1.0, element=0.5, across=1, half=26.0), method, duration=0.02, run_in=0.0)


def test_impulses_and_points_beside_the_road():
    road = plate(element=0.5, across=2)
    with pytest.raises(ValueError, match=r"road must be wide enough: it is 2 m wide, .* stands 1\.2 m from"):
        strike([(0.0, 0.0, 1.2)], 10.0, road)
    with pytest.raises(ValueError, match=r"road must be wide enough: .* stands 1\.1 m from"):
        strike([(0.0, -1.1, 0.5)], 10.0, road)
    with pytest.raises(ValueError, match=r"across must have shape \(2\), got \(3,\)"):
        mf.moving_impulse_response(road, speed=1.0, offsets=[0.0, 1.0], strike=0.0, across=[0.0, 0.0, 0.0])
    with pytest.raises(ValueError, match=r"strike_across must be finite"):
        mf.moving_impulse_response(road, speed=1.0, offsets=[0.0], strike=0.0, strike_across=[np.nan])
    beam_like = mf.finite_track(TRACK, first=-20.0, last=20.0)
    for places in ([(0.0, 0.5, 0.5)], [(0.0, 0.5, 0.0)]):
        with pytest.raises(
            ValueError, match="across and strike_across must be 0 m on a road whose section moves as"
        ):
            strike(places, 10.0, beam_like)


def test_a_pair_of_wheels_that_was_not_recorded(struck):
    """Opposite wheels farther apart than those between which the plate was struck."""
    wide = mf.full_car(**(FULL_TRUCK | {"sides": (0.5, -0.7)}))
    for call in (mf.simulate, mf.duhamel):
        with pytest.raises(ValueError, match="ahead, across, source_across must be one of the recorded offsets"):
            call(struck, wide, two_paths(), speed=10.0, duration=1.0)


@pytest.mark.parametrize("method", [mf.cdfm, mf.simulate, mf.duhamel])
def test_a_profile_with_one_path_for_two(method, struck):
    """One column is one path, of two that wheels follow; without columns a profile is the same for all."""
    road = struck if method is not mf.cdfm else plate(element=0.5, across=2, half=26.0)
    stations, flat = np.linspace(-20.0, 40.0, 6), np.zeros(6)
    options = {"speed": 10.0, "duration": 0.1}
    with pytest.raises(ValueError, match=r"a contact follows path 1, but the profile has 1 path\(s\)"):
        method(road, CAR, mf.Profile(stations, flat[:, None]), **options)
    method(road, CAR, mf.Profile(stations, flat), **options)


def test_a_travelling_road_says_by_how_many_unknowns():
    options = {"mass": np.eye(3), "damping": np.zeros((3, 3)), "stiffness": np.eye(3), "interval": (0.0, 1.0)}
    with pytest.raises(ValueError, match="column must be positive on a road that travels, got 0"):
        mf.FiniteGuideway(**options, interpolation=lambda x, d: np.ones((x.size, 3)), travels=True)

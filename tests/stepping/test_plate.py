"""Roads as wide as they are: plates against closed forms, waves across a section, and the frequency domain."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve

import movingfrf as mf
from tests.helpers import difference, observed_order
from tests.stepping.plate_parts import (
    AXLES,
    BENDING,
    BETWEEN_WHEELS,
    CAR,
    MASS,
    STIFFNESS,
    TRACK,
    WIDTH,
    plate,
    strike,
)

# Damped in bending as well, on a shear layer.
SHEARED = mf.track(
    replace(TRACK.beam, bending_damping=4.0e4),
    mf.ShearLayer(stiffness=1.6e7, damping=2.0e5, shear_stiffness=4.0e6),
)


def undamped(width):
    """One of some width, at rest."""
    return mf.track(
        mf.EulerBernoulliBeam(bending_stiffness=width * BENDING, mass=width * MASS),
        mf.Spring(stiffness=width * STIFFNESS, damping=0.0),
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


OMEGA = 2 * np.pi * np.array([2.0, 6.0, 15.0, 30.0, 60.0])


def asked(struck, places, speed, omega=OMEGA):
    ahead, receiver, source = np.array(places).T
    return struck.moving_frf(ahead, speed, omega, across=receiver - source, source_across=source)


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

"""Shapes of roads, rails and wheels against their geometry, and what combines them."""

from __future__ import annotations

import numpy as np
import pytest

import movingfrf as mf

RADIUS = 0.46


def slope(profile, x, within):
    """Secant of a profile about a place."""
    along = profile.along(0)
    return (along(x + within) - along(x - within)) / (2 * within)


def test_pothole():
    """A level floor, edges that are half-way down half-way, mirror symmetry, level road elsewhere."""
    hole = mf.pothole(depth=0.05, width=0.8, edge=0.2, at=3.0, length=10.0, start=-1.0)
    along = hole.along(0)
    np.testing.assert_allclose(along(np.linspace(3.2, 3.6, 9)), -0.05, rtol=1e-6)
    np.testing.assert_allclose(along([3.1, 3.7]), -0.025, rtol=1e-4)
    x = np.linspace(-0.5, 0.5, 101)
    np.testing.assert_allclose(along(3.4 + x), along(3.4 - x), atol=1e-7)
    np.testing.assert_allclose(along([-1.0, 2.9, 3.9, 9.0]), 0.0, atol=1e-9)
    raised = mf.pothole(depth=-0.05, width=0.8, edge=0.2, at=3.0, length=10.0)
    assert float(raised.along(0)(3.4)) == pytest.approx(0.05, rel=1e-6)


def test_faulted_slabs():
    """Each slab climbs by the fault over its length, less what the edge takes; the road drops at joints."""
    slabs = mf.faulted_slabs(height=0.006, spacing=5.0, edge=0.1, at=2.0, length=40.0)
    along = slabs.along(0)
    for joint in (2.0, 7.0, 32.0):
        # Over the edge the slab climbs on, by height · edge/spacing.
        assert along(joint + 0.05) - along(joint - 0.05) == pytest.approx(-0.006 * (1 - 0.1 / 5.0), rel=1e-4)
        assert slope(slabs, joint + 2.5, 1.0) == pytest.approx(0.006 / 5.0, rel=1e-6)
    assert np.mean(np.asarray(slabs.elevation)[:-1]) == pytest.approx(0.0, abs=1e-5)


def test_dipped_joints():
    """Depth at the joint, the dip angle 4d/b between the rail ends, level rail beyond their reach."""
    rail = mf.dipped_joints(depth=0.003, reach=1.0, spacing=12.0, rounding=0.002, at=6.0, length=30.0)
    along = rail.along(0)
    for joint in (6.0, 18.0):
        assert along(joint) == pytest.approx(-0.003, rel=1e-4)
        angle = slope(rail, joint + 0.05, 0.005) - slope(rail, joint - 0.05, 0.005)
        # At 50 mm each rail end has bent back by a twentieth, and the rounding of 2 mm moves it by that much.
        assert angle == pytest.approx(4 * 0.003 / 1.0 * (1 - 0.048), rel=2e-3)
        np.testing.assert_allclose(along([joint - 1.01, joint + 1.01, joint + 3.0]), 0.0, atol=1e-8)


def test_dipped_weld():
    """Mean depth of a cosine is half of its depth; the short one sits in the middle of the long one."""
    weld = mf.dipped_weld(depth=4e-4, width=1.0, short_depth=1e-4, short_width=0.1, at=5.0, length=10.0)
    x = weld.stations
    area = np.sum(np.asarray(weld.elevation)) * (x[1] - x[0])
    assert area == pytest.approx(-(4e-4 * 1.0 + 1e-4 * 0.1) / 2, rel=1e-6)
    np.testing.assert_allclose(weld.along(0)([5.0, 5.05, 4.75, 4.4]), [-5e-4, -3.9021e-4, -2e-4, 0.0], atol=2e-9)
    raised = mf.dipped_weld(depth=-4e-4, width=1.0, at=5.0, length=10.0)
    assert float(raised.along(0)(5.0)) == pytest.approx(4e-4, rel=1e-6)


def lowest_point(outline, turned):
    """How far the centre of a wheel stands above the rail: outline (radius, angle from straight down), turned."""
    radius, angle = outline
    return np.array([np.max(radius * np.cos(angle - turn)) for turn in turned])


def test_a_fresh_flat_by_rolling_the_wheel():
    """A circle with a chord cut off, rolled as an outline of points: its centre sinks as the profile says.

    The formula is the first term in c/R: corners stand at sin⁻¹(c/2R), and 1 − cos s/R is s²/(2R²) to (c/R)²/48.
    """
    chord = 0.08
    half = np.arcsin(chord / (2 * RADIUS))
    angle = np.linspace(-np.pi, np.pi, 400_001)
    cut = np.abs(angle) < half
    radius = np.full_like(angle, RADIUS)
    radius[cut] = RADIUS * np.cos(half) / np.cos(angle[cut])
    x = np.linspace(-0.06, 0.06, 241)
    centre = lowest_point((radius, angle), x / RADIUS) - RADIUS
    profile = mf.wheel_flat(radius=RADIUS, chord=chord, at=3.0, length=20.0)
    depth = chord**2 / (8 * RADIUS)
    found = profile.along(0)(3.0 + x)
    away = np.abs(x) > chord / 100  # but for the corner at the bottom, which the spline rounds over a step
    np.testing.assert_allclose(found[away], centre[away], atol=0.01 * depth)
    assert found.min() == pytest.approx(-depth, rel=0.03)
    assert (found < 1e-6).all()  # what is missing from the wheel lowers it
    # Once per revolution.
    turn = 2 * np.pi * RADIUS
    np.testing.assert_allclose(profile.along(0)(3.0 + turn + x[away]), found[away], atol=2e-2 * depth)
    assert profile.along(0)(3.0 + turn / 2) == pytest.approx(0.0, abs=1e-12)


def test_a_worn_flat():
    flat = mf.wheel_flat(radius=RADIUS, chord=0.1, depth=0.001, at=0.0, length=10.0)
    x = np.linspace(-0.05, 0.05, 51)
    expected = -0.0005 * (1 + np.cos(2 * np.pi * x / 0.1))
    np.testing.assert_allclose(flat.along(0)(2 * np.pi * RADIUS + x), expected, atol=1e-7)


def test_polygon_by_its_harmonics():
    """Over whole revolutions each order has its amplitude and phase, and nothing else is there."""
    wheel = {"radius": 0.5, "orders": [1, 3, 20], "amplitudes": [1e-4, 5e-5, 1e-5]}
    turn = 2 * np.pi * 0.5
    profile = mf.polygon(**wheel, phases=[0.1, -0.4, 2.0], length=2 * turn + 0.1)
    x = np.arange(2000) * turn / 1000
    lines = np.fft.rfft(profile.along(0)(x))[::2] / 1000
    for order, amplitude, phase in zip(wheel["orders"], wheel["amplitudes"], (0.1, -0.4, 2.0), strict=True):
        assert lines[order] == pytest.approx(amplitude / 1j * np.exp(1j * phase), rel=1e-4)
    lines[wheel["orders"]] = 0.0
    assert np.abs(lines).max() < 1e-9
    first, again, other = (np.asarray(mf.polygon(**wheel, length=9.0, seed=s).elevation) for s in (1, 1, 2))
    np.testing.assert_array_equal(first, again)
    assert np.abs(first - other).max() > 1e-5


def test_a_wheel_rolls_onto_a_step():
    """It meets the edge √(2Rh − h²) before it and rises along a circle about it, down the same way."""
    height, x = 0.02, np.arange(4001) * 1e-3
    step = mf.Profile(x, np.where((x >= 1.0) & (x <= 3.0), height, 0.0))
    seen = np.asarray(mf.rolled(step, radius=RADIUS).elevation)
    before = np.maximum(1.0 - x, np.maximum(x - 3.0, 0.0))
    expected = np.maximum(height - RADIUS + np.sqrt(np.maximum(RADIUS**2 - before**2, 0.0)), 0.0)
    np.testing.assert_allclose(seen, expected, atol=1e-12)


def test_a_wheel_bridges_a_narrow_hole():
    """It sinks by R − √(R² − g²/4) into a gap g; it cannot tell how deep the hole is."""
    x = np.arange(2001) * 1e-3
    for depth in (0.05, 0.5, 5.0):
        gap = mf.Profile(x, np.where(np.abs(x - 1.0) < 0.0995, -depth, 0.0))
        seen = np.asarray(mf.rolled(gap, radius=RADIUS).elevation)
        assert seen.min() == pytest.approx(np.sqrt(RADIUS**2 - 0.1**2) - RADIUS, abs=1e-12)
        assert x[seen.argmin()] == pytest.approx(1.0, abs=1e-9)
    # What is rounder than the wheel it follows: the lowest point of a long wave stays where it is.
    wave = mf.harmonic(amplitude=0.01, wavelength=20.0, length=40.0)
    seen = mf.rolled(wave, radius=RADIUS)
    np.testing.assert_allclose(np.asarray(seen.elevation)[5:-5], np.asarray(wave.elevation)[5:-5], atol=1e-5)
    assert seen.steps == ("rolled over by a wheel of 0.46 m radius",)


ROLLED = [(road_class, step) for road_class in "ABCDEFGH" for step in (0.02, 0.0125, 0.005)]
ROLLED += [(road_class, step) for road_class in "ABCD" for step in (0.05, 0.03)]


@pytest.mark.parametrize(("road_class", "step"), ROLLED)
def test_a_wheel_follows_rough_roads_as_well_as_it_says(road_class, step):
    """Within step²/(8R) of the highest that two hundred places to a step of the spline lift it to; never above."""
    road = mf.realise(mf.IsoRoad.of_class(road_class), length=12.0, step=step, seed=1)
    spline, parts = road.along(0), 200
    for radius in (0.3, 0.5):
        reach = radius - step / parts
        seen = mf.rolled(road, radius=radius)
        under = np.arange(-reach, reach, step / parts)
        places = road.stations[(road.stations > radius) & (road.stations < 12.0 - radius)][:: round(0.3 / step)]
        highest = [np.max(spline(x + under) + np.sqrt(radius**2 - under**2) - radius) for x in places]
        missed = highest - seen.along(0)(places)
        assert missed.max() < step**2 / (8 * radius)
        assert missed.min() > -1e-4 * np.ptp(road.elevation)


def test_each_path_is_rolled_by_itself():
    pair = mf.realise(mf.IsoRoad.of_class("E"), length=20.0, across=[0.7, -0.7])
    seen = np.asarray(mf.rolled(pair, radius=0.3).elevation)
    for path in (0, 1):
        alone = mf.rolled(mf.Profile(pair.stations, np.asarray(pair.elevation)[:, path]), radius=0.3)
        np.testing.assert_array_equal(seen[:, path], alone.elevation)
    assert (seen >= np.asarray(pair.elevation)).all()


def test_a_sum_of_profiles_is_the_sum_of_their_splines():
    """On the stations of all of them a sum of cubic splines is a cubic spline: exact also between stations."""
    rng = np.random.default_rng(3)
    uneven = mf.Profile(np.sort(rng.uniform(-3.0, 25.0, 120)), rng.normal(0.0, 0.01, 120))
    parts = [
        mf.realise(mf.IsoRoad.of_class("C"), length=30.0, start=-5.0, seed=1),
        mf.bump(height=0.03, width=0.77, at=7.1, length=22.0, start=-1.3),
        uneven,
    ]
    total = mf.superposed(*parts)
    first, last = max(p.stations[0] for p in parts), min(p.stations[-1] for p in parts)
    assert (total.stations[0], total.stations[-1]) == (first, last)
    x = np.linspace(first + 1.0, last - 1.0, 5001)
    expected = sum(part.along(0)(x) for part in parts)
    # The ends of the interval cut through splines; what that changes dies away by 0.27 per station.
    np.testing.assert_allclose(total.along(0)(x), expected, atol=1e-9)
    assert total.source.count(";") == 1  # of the two that say where they come from


def test_stations_of_one_grid_are_not_doubled_by_rounding():
    grids = [
        mf.Profile(start + 0.05 * np.arange(count), np.zeros(count)) for start, count in [(0.0, 401), (5.0, 301)]
    ]
    assert mf.superposed(*grids).stations.size == 301


def test_sums_with_paths():
    pair = mf.realise(mf.IsoRoad.of_class("A"), length=30.0, across=[0.7, -0.7])
    hump = mf.bump(height=0.02, width=1.0, at=10.0, length=30.0)
    both = mf.superposed(pair, hump)
    assert both.across == (0.7, -0.7)
    for path in (0, 1):
        assert both.along(path)(10.5) - pair.along(path)(10.5) == pytest.approx(0.02, abs=1e-6)
    side = mf.side_by_side(pair, hump)
    assert side.paths == 3
    np.testing.assert_allclose(side.along(2)([10.5, 12.0]), [0.02, 0.0], atol=1e-6)
    np.testing.assert_allclose(side.along(1)(10.5), pair.along(1)(10.5), atol=1e-9)


FLAT = {"radius": 0.46, "chord": 0.05, "length": 10.0}
HOLE = {"depth": 0.05, "width": 0.5, "edge": 0.1, "at": 1.0, "length": 10.0}
JOINTS = {"depth": 0.003, "reach": 1.0, "spacing": 12.0, "rounding": 0.01, "length": 30.0}
SLABS = {"height": 0.003, "spacing": 5.0, "edge": 0.1, "length": 30.0}
WELD = {"depth": 3e-4, "width": 1.0, "at": 5.0, "length": 10.0}
WHEEL = {"radius": 0.5, "orders": [1, 2], "amplitudes": [1e-4, 1e-4], "length": 10.0}


@pytest.mark.parametrize(
    ("make", "given", "changes", "message"),
    [
        (mf.pothole, HOLE, {"depth": 0.0}, "depth must not be zero"),
        (mf.pothole, HOLE, {"edge": 0.3}, r"edge must be at most half of the width, 0\.25 m, got 0\.3 m"),
        (mf.pothole, HOLE, {"width": -1.0}, "width must be positive"),
        (mf.faulted_slabs, SLABS, {"edge": 3.0}, r"edge must be at most half of the spacing, 2\.5 m, got 3 m"),
        (mf.faulted_slabs, SLABS, {"height": 0.0}, "height must not be zero"),
        (mf.dipped_joints, JOINTS, {"spacing": 2.0}, r"spacing must be at least 2\.02 m, two rail ends, got 2 m"),
        (mf.dipped_joints, JOINTS, {"rounding": 0.0}, "rounding must be positive"),
        (mf.dipped_weld, WELD, {"depth": 0.0}, "depth must not be zero"),
        (mf.dipped_weld, WELD, {"short_width": 0.0}, "short_width must be positive"),
        (mf.wheel_flat, FLAT, {"chord": 0.5}, r"chord must be at most the radius, 0\.46 m, got 0\.5 m"),
        (mf.wheel_flat, FLAT, {"depth": -0.1}, "depth must be positive"),
        (mf.wheel_flat, FLAT, {"length": 1e12}, "GiB of memory"),
        (
            mf.polygon,
            WHEEL,
            {"orders": [1, 0]},
            r"orders must be one or more whole numbers of at least 1, got \[1, 0\]",
        ),
        (mf.polygon, WHEEL, {"orders": [1, 2.5]}, "orders must be one or more whole numbers"),
        (mf.polygon, WHEEL, {"orders": []}, "orders must be one or more whole numbers"),
        (mf.polygon, WHEEL, {"amplitudes": [1e-4]}, r"amplitudes must have shape \(2\), got \(1,\)"),
        (mf.polygon, WHEEL, {"phases": [1.0]}, r"phases must have shape \(2\), got \(1,\)"),
        (mf.polygon, WHEEL, {"seed": -1}, "seed must be a whole number of at least 0"),
    ],
)
def test_impossible_shapes(make, given, changes, message):
    with pytest.raises(ValueError, match=message):
        make(**(given | changes))


def test_impossible_combinations():
    level = mf.Profile([0.0, 1.0, 2.0, 3.0], np.zeros(4))
    later = mf.Profile([3.0, 4.0, 5.0, 6.0], np.zeros((4, 2)))
    uneven = mf.Profile([0.0, 1.0, 2.5, 3.0], np.zeros((4, 3)))
    with pytest.raises(ValueError, match="must share an interval, but they reach from 0 m to 3 m; 3 m to 6 m"):
        mf.superposed(level, later)
    with pytest.raises(ValueError, match="must share an interval"):
        mf.side_by_side(level, later)
    with pytest.raises(mf.ParameterError, match="must have the same number of paths, got 2 and 3"):
        mf.superposed(later, uneven)
    for combine in (mf.superposed, mf.side_by_side):
        with pytest.raises(mf.ParameterError, match="profiles must be at least one"):
            combine()
    with pytest.raises(ValueError, match="stations at an even step"):
        mf.rolled(uneven, radius=0.5)
    with pytest.raises(mf.ParameterError, match="radius must be positive"):
        mf.rolled(level, radius=0.0)

"""What a contact sees of a road: in space against plain averages, by wavenumber against waves in space."""

import itertools
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

import movingfrf as mf
from movingfrf._basics.short_waves import HIGH_PASS, ShortWaves, filtered
from movingfrf.roughness.excitation import Touch, excite

STEP = 0.02
SURFACE = mf.realise(mf.IsoRoad.of_class("B", band=(0.02, 3.0)), length=60.0, step=STEP, seed=4, start=-10.0)
# Plain, with a footprint, with cams, with both; the second ahead of the first.
POSITIONS, FOOTPRINTS, CAMS = (
    np.array([0.0, 1.3, -2.0, 0.7]),
    np.array([0, 0.35, 0, 0.2]),
    np.array([0, 0, 0.6, 0.5]),
)
TOUCH = Touch(positions=POSITIONS, paths=[0, 0, 0, 0], footprints=FOOTPRINTS, cams=CAMS)
PLAIN = Touch(positions=np.zeros(1), paths=[0], footprints=np.zeros(1), cams=np.zeros(1))


def seen_at(profile, place, footprint, cams):
    """Average a spline by adaptive quadrature, knot by knot."""
    along, half = profile.along(0), 0.5 * footprint
    found = []
    for cam in (place - 0.5 * cams, place + 0.5 * cams):
        knots = profile.stations[(profile.stations > cam - half) & (profile.stations < cam + half)]
        edges = np.r_[cam - half, knots, cam + half]
        pieces = [quad(along, a, b, epsabs=1e-15)[0] for a, b in pairwise(edges)]
        found.append(sum(pieces) / footprint if footprint else float(along(cam)))
    return 0.5 * sum(found)


def test_footprints_and_cams_average_the_spline():
    excitation = excite(SURFACE, TOUCH, start=2.0, distance=30.0, blend=0.0)
    travelled = np.array([0.0, 0.513, 7.77, 29.3])
    datum = float(SURFACE.along(0)(3.3))
    assert excitation.datum == pytest.approx(datum, rel=1e-12)
    expected = [
        [seen_at(SURFACE, 2.0 + x + far, footprint, cams) - datum for far in travelled]
        for x, footprint, cams in zip(POSITIONS, FOOTPRINTS, CAMS, strict=True)
    ]
    np.testing.assert_allclose(excitation.elevation(travelled), expected, atol=1e-12)


@pytest.mark.parametrize("blend", [0.0, 5.0])
def test_the_rate_is_the_slope_of_the_elevation_times_the_speed(blend):
    """By central differences of fourth order, away from knots' jumps in the third derivative by their size only."""
    excitation = excite(SURFACE, TOUCH, start=2.0, distance=30.0, blend=blend)
    travelled, d = np.linspace(0.3, 29.0, 400), 1e-4
    values = [excitation.elevation(travelled + n * d) for n in (-2, -1, 1, 2)]
    slope = (values[0] - 8 * values[1] + 8 * values[2] - values[3]) / (12 * d)
    rate = excitation.rate(travelled, 12.0)
    np.testing.assert_allclose(rate, 12.0 * slope, atol=2e-7 * np.abs(rate).max())


def test_up_to_the_foremost_start_the_road_is_flat_and_then_sets_in():
    excitation = excite(SURFACE, TOUCH, start=2.0, distance=30.0, blend=5.0)
    free = excite(SURFACE, TOUCH, start=2.0, distance=30.0, blend=0.0)
    travelled = np.linspace(0.0, 20.0, 2001)
    for row, position in enumerate(POSITIONS):
        at = travelled + position - POSITIONS.max()  # from the foremost contact's start on
        share = np.clip(at / 5.0, 0.0, 1.0)
        share = share**3 * (10 - 15 * share + 6 * share**2)
        np.testing.assert_allclose(
            excitation.elevation(travelled)[row], share * free.elevation(travelled)[row], atol=1e-15
        )


def test_a_wave_in_space_is_the_wave_by_wavenumber():
    wavelength, amplitude = 1.7, 2e-3
    wave = mf.harmonic(amplitude=amplitude, wavelength=wavelength, length=60.0, start=-10.0)
    travelled, kappa = np.linspace(0.0, 30.0, 777), 2 * np.pi / wavelength
    excitation = excite(wave, TOUCH, start=0.0, distance=30.0, blend=0.0)
    seen = excitation.elevation(travelled) + excitation.datum
    expected = (TOUCH.waves(np.array([kappa])) * -1j * amplitude * np.exp(1j * kappa * travelled)).real
    # A spline through fifty points a wave.
    np.testing.assert_allclose(seen, expected, atol=3e-6 * amplitude)


def test_beyond_its_ends_a_straight_profile_goes_straight_on():
    """A footprint that reaches out finds the slope of the end, which fades over a length much longer than that."""
    slope = mf.Profile(np.linspace(0.0, 10.0, 101), 0.03 * np.linspace(0.0, 10.0, 101))
    touch = Touch(positions=np.zeros(1), paths=[0], footprints=np.array([0.4]), cams=np.array([0.6]))
    excitation = excite(slope, touch, start=0.0, distance=10.0, blend=0.0)
    travelled = np.array([0.0, 0.1, 5.0, 9.9, 10.0])
    np.testing.assert_allclose(excitation.elevation(travelled)[0], 0.03 * travelled, atol=3e-6)
    np.testing.assert_allclose(excitation.rate(travelled, 10.0)[0], 0.3, rtol=1e-3)


def test_past_its_end_a_profile_goes_on_in_value_slope_and_curvature():
    along = excite(SURFACE, PLAIN, start=2.0, distance=30.0, blend=0.0).along[0]
    near = along.ends + 1e-7 * np.array([-1.0, 1.0])
    # Its curvature to within the pieces that it fades in.
    for order, jump in enumerate((1e-8, 1e-7, 1e-4)):
        before, after = along.level(near, order)
        assert abs(after - before) < jump, order
    assert abs(along.level(along.ends - 1e-7, 2)) > 1e-2
    far = along.level(along.ends + along.fades * np.array([1.0, 2.0, 50.0]))
    np.testing.assert_allclose(far, along.level(along.ends), atol=1e-15)


@pytest.mark.parametrize("grade", [0.06, -0.01])
@pytest.mark.parametrize("paths", [1, 2])
def test_a_grade_is_taken_out_of_every_path(grade, paths):
    """Whatever the duration; what is left is the road without the grade, to the rounding of the spline."""
    rough = mf.realise(mf.IsoRoad.of_class("A", band=(0.02, 4.0)), length=400.0, seed=[0, 1][:paths], start=-10.0)
    steep = mf.Profile(rough.stations, rough.columns + grade * rough.stations[:, None])
    touch = Touch(positions=np.array([1.0, -3.0]), paths=[0, paths - 1], footprints=np.zeros(2), cams=np.zeros(2))
    travelled = np.linspace(0.0, 30.0, 301)
    found = [excite(steep, touch, start=0.0, distance=d, blend=5.0) for d in (30.0, 300.0)]
    assert found[0].grade == found[1].grade
    assert found[0].grade == pytest.approx(grade, abs=1e-3)
    level = excite(rough, touch, start=0.0, distance=30.0, blend=5.0)
    assert level.grade == 0.0
    ramp = (found[0].grade - grade) * (travelled + touch.positions[:, None] - 1.0)
    apart = found[0].elevation(travelled) - (level.elevation(travelled) - ramp)
    # Where the road is blended in under every contact.
    np.testing.assert_allclose(apart[:, travelled > 9.0], 0.0, atol=1e-12)
    assert excite(steep, touch, start=0.0, distance=30.0, blend=0.0).grade == 0.0


def test_a_road_without_a_grade_has_none():
    """Bumps and long waves are roughness, on long profiles and on short ones."""
    hump = mf.bump(height=0.1, width=3.0, at=4.0, length=20.0)
    assert excite(hump, PLAIN, start=0.0, distance=15.0, blend=1.0).grade == 0.0
    for letter, length, seed in itertools.product("AC", (40.0, 300.0), range(20)):
        road = mf.realise(mf.IsoRoad.of_class(letter, band=(0.01, 2.0)), length=length, seed=seed)
        assert excite(road, PLAIN, start=0.0, distance=30.0, blend=5.0).grade == 0.0, (letter, length, seed)


def test_a_smooth_road_goes_on_as_smoothly_past_the_end_of_its_profile():
    """Its fourth derivative, which cubic splines have in their third differences, does not jump there."""
    road = mf.realise(mf.IsoRoad.of_class("A", band=(0.02, 4.0)), length=60.0, seed=3)
    along, step = excite(road, PLAIN, start=0.0, distance=50.0, blend=0.0).along[0], road.even_step()
    around = along.level(along.ends + step * np.arange(-400.0, 200.0))
    fourth = np.abs(np.diff(around, n=4))
    assert fourth[390:].max() < 1.5 * fourth[:390].max()
    assert along.level(along.ends + 2 * along.fades) == pytest.approx(float(along.level(along.ends)), abs=1e-15)


def test_a_filter_bounds_what_is_in_short_waves():
    """Of waves of one length it tells exactly how much there is, of longer ones next to nothing, of all a bound."""
    n = np.arange(20_000.0)

    def told(record):
        return ShortWaves(np.array([np.square(filtered(record)).sum()]), 1.0)

    for length in (2.5, 5.0, 12.0):
        wave = told(np.sin(2 * np.pi / length * n))
        assert wave.shorter(length)[0] == pytest.approx(n.size / 2, rel=2e-3)
        assert wave.shorter(0.5 * length)[0] < 1e-5 * n.size / 2 or length < 4.0
    assert told(np.sin(2 * np.pi / 16.0 * n)).shorter(8.0)[0] < 1e-9 * n.size
    # A level and a slope are nothing; what is left is rounding, here of numbers up to 1e4.
    assert told(3.0 + 0.5 * n + 4.0 * np.sin(2 * np.pi / 200.0 * n)).shorter(8.0)[0] < 1e-13 * n.size
    assert np.isinf(told(n).shorter(1.9)).all()
    assert np.isinf(told(n).shorter(HIGH_PASS.longest)).all()
    rough = np.random.default_rng(0).normal(size=n.size)
    spectrum = np.abs(np.fft.rfft(rough)) ** 2 * 2 / n.size
    for length in (2.2, 3.0, 6.0):
        assert told(rough).shorter(length)[0] > spectrum[int(n.size / length) :].sum()


@pytest.mark.parametrize("step", [None, 0.04, 0.08])
def test_guesses_past_the_end_are_off_by_as_much_as_is_said(step):
    """Over sixty roads that go on, the median of what a footprint is off there is the one that is told.

    From sixteen stations a wave the next one is predicted, from fewer it is not.
    """
    touch = Touch(positions=np.zeros(1), paths=[0], footprints=np.array([0.5]), cams=np.zeros(1))
    off, said = [], []
    for seed in range(60):
        road = mf.realise(mf.IsoRoad.of_class("B", band=(0.02, 6.0)), length=60.0, step=step, seed=seed)
        ends = road.stations <= 40.0 + 1e-9
        cut = mf.Profile(road.stations[ends], road.columns[ends, 0])
        known, guessed = (excite(one, touch, start=0.0, distance=40.0, blend=0.0) for one in (road, cut))
        at = np.array([39.9, 40.0])
        off.append(known.elevation(at)[0] - guessed.elevation(at)[0])
        said.append(np.median(np.abs(guessed.doubt(at)[:, 0]), axis=0))
        assert known.guessed == 0.0
        assert guessed.guessed == pytest.approx(0.25)
    ratio = np.median(np.abs(off), axis=0) / np.median(said, axis=0)
    assert (guessed.along[0].past.coefficients is None) == (step is not None)
    assert (ratio > 0.5).all()
    assert (ratio < 2.0).all()


def test_paths_of_a_profile_without_columns_are_one():
    touch = Touch(positions=np.zeros(2), paths=[0, 3], footprints=np.zeros(2), cams=np.zeros(2))
    left, right = excite(SURFACE, touch, start=0.0, distance=10.0, blend=0.0).elevation(np.linspace(0, 10, 50))
    np.testing.assert_array_equal(left, right)


@pytest.mark.parametrize(("footprint", "cams"), [(0.012, 0.0), (0.2, 0.0), (0.2, 0.5)])
def test_at_the_end_of_a_long_climb_too(footprint, cams):
    """A hundred kilometres, five hundred metres up: of a smooth climb an average is the road but for its bend."""
    length, climb = 1e5, 500.0
    stations = np.linspace(0.0, length, 100_001)
    road = mf.Profile(stations, 0.5 * climb * (1 - np.cos(np.pi * stations / length)))
    touch = Touch(positions=np.zeros(1), paths=[0], footprints=np.array([footprint]), cams=np.array([cams]))
    plain = Touch(positions=np.zeros(1), paths=[0], footprints=np.zeros(1), cams=np.zeros(1))
    travelled = np.arange(99_000.0, 99_900.0, 0.1)
    averaged, point = (excite(road, t, start=0.0, distance=99_950.0, blend=0.0) for t in (touch, plain))
    # Half of the mean square distance times the curvature, 2.5e-7 1/m at its largest; and rounding of 500 m.
    spread = (footprint**2 / 24 + cams**2 / 8) * 2.5e-7
    apart = averaged.elevation(travelled) - point.elevation(travelled)
    assert np.abs(apart).max() < spread + 2e-10
    np.testing.assert_allclose(averaged.rate(travelled, 1.0), point.rate(travelled, 1.0), atol=1e-9)


def test_far_above_the_sea_a_footprint_averages_as_well():
    """The area under a road grows with its height; what is averaged is about the datum."""
    high = mf.Profile(SURFACE.stations, SURFACE.columns[:, 0] + 4000.0)
    travelled = np.linspace(0.0, 30.0, 200)
    low, raised = (
        excite(surface, TOUCH, start=2.0, distance=30.0, blend=0.0).elevation(travelled)
        for surface in (SURFACE, high)
    )
    # As many digits as elevations of 4000 m have.
    np.testing.assert_allclose(raised, low, atol=1e-11)


def test_a_footprint_may_be_asked_for_however_far_beyond_the_profile():
    excitation = excite(SURFACE, TOUCH, start=2.0, distance=30.0, blend=0.0)
    beyond = excitation.elevation(np.linspace(0.0, 4000.0, 20_000))
    np.testing.assert_allclose(beyond[:, -8192:], beyond[:, -1:] + np.zeros(8192), rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    ("begins", "said"),
    [
        (12345.0, r"`start` greater by 12345 to 12384 m makes it fit"),
        (-500.0, r"`start` smaller by 461 to 500 m makes it fit"),
        (0.5, r"`start` greater by 0.5 to 39.5 m makes it fit"),
    ],
)
def test_a_journey_beside_its_profile_is_told_where_it_fits(begins, said):
    profile = mf.Profile(begins + np.arange(0.0, 50.0, 1.0), np.zeros(50))
    car = mf.catalogue("golden_car")
    with pytest.raises(ValueError, match=said):
        mf.simulate(mf.RigidGuideway(), car, profile, speed=10.0, duration=1.0)

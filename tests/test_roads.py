"""Every kind of [roughness]: what it builds from a scenario is what Python builds from the same keywords."""

from __future__ import annotations

import numpy as np
import pytest

import movingfrf as mf
from movingfrf.scenarios.kinds import ROUGHNESS, SPECTRUM
from movingfrf.scenarios.reading import parse_scenario
from movingfrf.scenarios.roads import ROADS

CAR = """
[guideway]
kind = "rigid_guideway"
[vehicle]
kind = "full_car"
body_mass = 840.0
pitch_inertia = 1100.0
roll_inertia = 820.0
wheel_masses = [53.0, 76.0]
suspension_stiffness = [1.0e4, 1.3e4]
suspension_damping = [900.0, 900.0]
tyre_stiffness = [2.0e5, 2.0e5]
axles = [1.4, -1.47]
sides = [0.7, -0.75]
[run]
speed = 10.0
duration = 2.0
"""
# What the journey needs, from the rear axle's start to the front axle's end.
START, LENGTH = -1.47, 22.87
# The road goes on for 5 m and a quarter of a second.
END = START + LENGTH + 5.0 + 0.25 * 10.0
PLACE = {"length": END - START, "start": START}
REALISED = {"length": LENGTH, "start": START, "covering": (START, END)}


def road(text):
    return parse_scenario(CAR + "[roughness]\n" + text).case.road


def faults(text):
    with pytest.raises(mf.ScenarioError) as caught:
        road(text)
    return {fault.name: fault.message for fault in caught.value.faults}


def assert_same(found, expected):
    np.testing.assert_allclose(found.stations, expected.stations, atol=1e-12)
    np.testing.assert_allclose(np.asarray(found.elevation), np.asarray(expected.elevation), atol=1e-12)


RAIL = mf.ThirdOctaveSpectrum(wavelength=[0.2, 0.16, 0.125], level=[3.0, 1.0, -1.0])

SPECTRUM_KINDS = {
    "iso_road": ('road_class = "B"\nband = [0.05, 5.0]', mf.IsoRoad.of_class("B", band=(0.05, 5.0))),
    "two_slope_road": ('road_class = "poor minor road"', mf.TwoSlopeRoad.of_class("poor minor road")),
    "fra_track": ("track_class = 4", mf.FraTrack.of_class(4)),
    "fryba_track": ("roughness = 1e-8", mf.FrybaTrack(roughness=1e-8)),
    "german_track": ('track_class = "low"', mf.GermanTrack.of_class("low")),
    "sncf_track": ('track_class = "poor"\nband = [0.05, 0.5]', mf.SncfTrack.of_class("poor", band=(0.05, 0.5))),
    "chinese_ballastless_track": ("", mf.ChineseBallastlessTrack()),
    "tabulated_spectrum": (
        "spatial_frequency = [0.1, 1.0]\nspectral_density = [1e-5, 1e-7]",
        mf.TabulatedSpectrum(spatial_frequency=[0.1, 1.0], spectral_density=[1e-5, 1e-7]),
    ),
    "third_octave_spectrum": ("wavelength = [0.2, 0.16, 0.125]\nlevel = [3.0, 1.0, -1.0]", RAIL),
    "iso3095_limit": ("", mf.iso3095_limit()),
}

SHAPE_KINDS = {
    "harmonic": ("amplitude = 0.01\nwavelength = 2.0", mf.harmonic(amplitude=0.01, wavelength=2.0, **PLACE)),
    "bump": ("height = 0.01\nwidth = 1.0\nat = 5.0", mf.bump(height=0.01, width=1.0, at=5.0, **PLACE)),
    "pothole": (
        "depth = 0.04\nwidth = 0.5\nedge = 0.1\nat = 5.0",
        mf.pothole(depth=0.04, width=0.5, edge=0.1, at=5.0, **PLACE),
    ),
    "faulted_slabs": (
        "height = 0.004\nspacing = 5.0\nedge = 0.1",
        mf.faulted_slabs(height=0.004, spacing=5.0, edge=0.1, **PLACE),
    ),
    "dipped_joints": (
        "depth = 0.003\nreach = 1.0\nspacing = 9.0\nrounding = 0.02",
        mf.dipped_joints(depth=0.003, reach=1.0, spacing=9.0, rounding=0.02, **PLACE),
    ),
    "dipped_weld": ("depth = 3e-4\nwidth = 1.0\nat = 5.0", mf.dipped_weld(depth=3e-4, width=1.0, at=5.0, **PLACE)),
    "wheel_flat": ("radius = 0.46\nchord = 0.1", mf.wheel_flat(radius=0.46, chord=0.1, **PLACE)),
    "polygon": (
        "radius = 0.46\norders = [1, 3]\namplitudes = [1e-4, 1e-5]\nseed = 4",
        mf.polygon(radius=0.46, orders=[1, 3], amplitudes=[1e-4, 1e-5], seed=4, **PLACE),
    ),
}


def test_every_kind_is_tried_here():
    assert set(SPECTRUM_KINDS) == set(SPECTRUM.kinds)
    others = {"laplace_road", "superposed", "side_by_side", "profile"}
    assert {*SPECTRUM_KINDS, *SHAPE_KINDS, *others} == set(ROUGHNESS.kinds)


@pytest.mark.parametrize("kind", SPECTRUM_KINDS)
def test_spectra(kind):
    keys, spectrum = SPECTRUM_KINDS[kind]
    step = 0.4 / spectrum.band[1]
    made = road(f'kind = "{kind}"\n{keys}\nseed = 3\nstep = {step}')
    assert_same(made.profile, mf.realise(spectrum, step=step, seed=3, **REALISED))
    assert repr(made.spectrum) == repr(spectrum)
    assert made.coherence == 1.0
    assert made.description == f"{spectrum}, seed 3"


@pytest.mark.parametrize("kind", SHAPE_KINDS)
def test_shapes(kind):
    keys, profile = SHAPE_KINDS[kind]
    made = road(f'kind = "{kind}"\n{keys}')
    assert_same(made.profile, profile)
    assert made.description == profile.source != ""
    assert made.spectrum is None


@pytest.mark.parametrize(
    "kind", ['kind = "iso_road"\nroad_class = "B"', 'kind = "bump"\nheight = 0.01\nwidth = 1.0\nat = 5.0']
)
def test_a_road_reaches_as_far_as_what_touches_it(kind):
    """Half of a footprint on either side, beyond the end 5 m and a quarter of a second; it is the same road."""
    plain, touching = (
        parse_scenario(CAR.replace("[run]", f"{more}[run]") + "[roughness]\n" + kind).case.road.profile
        for more in ("", "footprint = 0.3\n")
    )
    assert plain.stations[0] == pytest.approx(START)
    for road, reach in ((plain, 0.0), (touching, 0.15)):
        step = float(np.diff(road.stations).max())
        assert START - reach - step < road.stations[0] <= START - reach + 1e-9
        assert END + reach - 1e-9 <= road.stations[-1] < END + reach + 1.01 * step
    x = np.linspace(START, END, 500)
    np.testing.assert_allclose(touching.along(0)(x), plain.along(0)(x), rtol=0, atol=2e-5 * np.ptp(plain.elevation))


def test_a_road_does_not_depend_on_the_time_step():
    """With 5 ms a journey ends 2 ms later than with 1 ms: on the same road, which just fits into its period."""
    for kind in ('road_class = "B"', 'road_class = "C"\nseed = [1, 2]'):
        text = f'[roughness]\nkind = "iso_road"\nband = [0.5, 10.0]\n{kind}'
        fine, coarse = (
            parse_scenario(CAR.replace("duration = 2.0", f"duration = 2.108\ntime_step = {step}") + text).case
            for step in ("0.001", "0.005")
        )
        assert fine.journey.distance < coarse.journey.distance
        count = min(len(case.road.profile.stations) for case in (fine, coarse))
        first, second = (case.road.profile.columns[:count] for case in (fine, coarse))
        np.testing.assert_allclose(first, second, rtol=0, atol=1e-10 * first.std())


def test_paths_of_one_surface():
    made = road('kind = "iso_road"\nroad_class = "C"\nwaviness = 2.2\nacross = [0.7, -0.75]\nseed = 5')
    spectrum = mf.IsoRoad.of_class("C", waviness=2.2)
    assert_same(made.profile, mf.realise(spectrum, seed=5, across=[0.7, -0.75], **REALISED))
    assert made.profile.across == (0.7, -0.75)
    assert made.coherence == mf.IsotropicCoherence(waviness=2.2)
    given = road(
        'kind = "german_track"\ntrack_class = "high"\nstep = 0.2\nacross = [0.75, -0.75]\n'
        '[roughness.coherence]\nkind = "exponential_coherence"\ndecay = 3.0'
    )
    assert given.coherence == mf.ExponentialCoherence(decay=3.0)
    spectrum = mf.GermanTrack.of_class("high")
    again = mf.realise(spectrum, step=0.2, across=[0.75, -0.75], coherence=given.coherence, **REALISED)
    assert_same(given.profile, again)


def test_what_seeded_paths_have_in_common():
    """Nothing, everything, or no one number."""
    for seeds, common in [("[1, 2]", 0.0), ("[2, 2]", 1.0), ("[1, 2, 2]", None)]:
        assert road(f'kind = "iso_road"\nroad_class = "C"\nseed = {seeds}').coherence == common


def test_laplace_roads():
    made = road(
        'kind = "laplace_road"\nkurtosis = 6.0\nsegment = 5.0\nseed = 2\nacross = [0.7, -0.75]\n'
        'spectrum = {kind = "iso_road", road_class = "D"}'
    )
    spectrum = mf.IsoRoad.of_class("D")
    across = [0.7, -0.75]
    assert_same(
        made.profile, mf.realise_laplace(spectrum, kurtosis=6, segment=5, seed=2, across=across, **REALISED)
    )
    assert (made.spectrum, made.coherence) == (None, None)  # not Gaussian


PARTS = """
kind = "superposed"
[[roughness.parts]]
kind = "iso_road"
road_class = "B"
seed = [1, 2]
[[roughness.parts]]
kind = "side_by_side"
[[roughness.parts.parts]]
kind = "pothole"
depth = 0.04
width = 0.5
edge = 0.1
at = 10.0
[[roughness.parts.parts]]
kind = "bump"
height = 0.01
width = 1.0
at = 5.0
"""


def test_roads_made_of_roads():
    made = road(PARTS)
    left, right = (made.profile.along(path) for path in (0, 1))
    rough = mf.realise(mf.IsoRoad.of_class("B"), seed=[1, 2], **PLACE)
    assert left(10.25) - rough.along(0)(10.25) == pytest.approx(-0.04, abs=1e-6)
    assert right(10.25) - rough.along(1)(10.25) == pytest.approx(0.0, abs=1e-6)
    assert right(5.5) - rough.along(1)(5.5) == pytest.approx(0.01, abs=1e-6)
    assert made.description.count(";") == 2
    assert made.spectrum is None
    with pytest.warns(mf.ValidityWarning, match="would lift off the road"):
        result = parse_scenario(CAR + "[roughness]\n" + PARTS).run()
    assert "pothole" in result.attrs["road"]
    # The left wheels fall into the hole, the front one first: 1.4 m ahead, and 2.87 m behind it the rear one.
    lowest = result.roughness.values.argmin(axis=0) * 1e-2  # [m]
    assert lowest[0] == pytest.approx(10.25 - 1.4, abs=0.2)
    assert lowest[2] - lowest[0] == pytest.approx(2.87, abs=0.05)


@pytest.mark.parametrize(
    ("text", "name", "message"),
    [
        (
            'kind = "fra_track"\ntrack_class = 9\nstep = 0.5',
            "track_class",
            "must be one of 1, 2, 3, 4, 5, 6, got 9",
        ),
        ('kind = "fra_track"\nstep = 0.5', "track_class", "or roughness is needed: a class or a number, not both"),
        ('kind = "fra_track"\ntrack_class = 1\nroughness = 1e-6', "track_class", "not both"),
        ('kind = "german_track"\nroad_class = "low"', "road_class", "did you mean 'track_class'?"),
        ('kind = "sncf_track"\ntrack_class = "good"\nstep = 2.0', "step", "half of the shortest wave"),
        (
            'kind = "iso_road"\nroad_class = "A"\nacross = [0.7, "x"]',
            "across",
            "must be an array of numbers [m], got [0.7, 'x']",
        ),
        (
            'kind = "iso_road"\nroad_class = "A"\nacross = [0.7, -0.7]\nseed = [1, 2]',
            "seed",
            "one whole number where",
        ),
        ('kind = "fra_track"\ntrack_class = 1\nstep = 0.5\nacross = [0.7, -0.7]', "coherence", "is needed"),
        ('kind = "iso_road"\nroad_class = "A"\ncoherence = 0.5', "coherence", "must be a table"),
        (
            'kind = "iso_road"\nroad_class = "A"\nacross = [0, 1]\ncoherence = {kind = "exponential_coherense"}',
            "coherence.kind",
            "did you mean 'exponential_coherence'?",
        ),
        ('kind = "laplace_road"\nkurtosis = 6.0\nsegment = 1.0', "spectrum", "is missing"),
        (
            'kind = "laplace_road"\nkurtosis = 2\nsegment = 1\nspectrum = {kind = "iso_road", roughness = 1e-6}',
            "kurtosis",
            "must be above 3",
        ),
        ('kind = "superposed"', "parts", "is missing"),
        ('kind = "superposed"\nparts = []', "parts", "must be one or more tables"),
        (PARTS.replace("depth = 0.04", "depth = 0"), "parts[1].parts[0].depth", "must not be zero"),
        (PARTS.replace("edge = 0.1", "edges = 0.1"), "parts[1].parts[0].edge", "is missing"),
        (PARTS.replace("seed = [1, 2]", "seed = [1, 2, 3]"), "profiles", "same number of paths, got 2 and 3"),
        (
            'kind = "pothole"\ndepth = 0.1\nwidth = 1.0\nedge = 0.1\nat = 1.0\nlength = 9.0',
            "length",
            "not known here",
        ),
        (
            'kind = "polygon"\nradius = 0.5\norders = 3\namplitudes = [1.0]',
            "orders",
            "must be one or more whole numbers of at least 1, got 3",
        ),
    ],
)
def test_impossible_roads(text, name, message):
    assert message in faults(text)[f"roughness.{name}"]


def test_what_is_left_to_the_class_has_no_default_of_its_own():
    """The exponents of a two-slope road are those of its type; without a type, those of the standard's drafts."""
    (key,) = [key for key in SPECTRUM.kinds["two_slope_road"].keys if key.name == "waviness"]
    assert key.default is None
    assert key.words.endswith("shorter ones. By default that of the class, with roughness [2.0, 1.5].")
    for keys, waviness in (('road_class = "poor minor road"', (2.28, 1.428)), ("roughness = 1e-6", (2.0, 1.5))):
        assert road(f'kind = "two_slope_road"\n{keys}').spectrum.waviness == waviness
    assert next(key for key in SPECTRUM.kinds["iso_road"].keys if key.name == "waviness").default == 2.0


def test_keys_are_the_keywords_of_python():
    """All but the length and the start, which follow from the journey; of realised roads they may be said."""
    for kind in ROADS:
        keys = {key.name for key in kind.keys}
        assert not {"start", "covering", "way", "where", "given"} & keys, kind.name
        of_its_own = {"length", "origin"} if kind.name in {*SPECTRUM_KINDS, "laplace_road"} else set()
        assert {"length", "origin"} & keys == of_its_own, kind.name


@pytest.mark.parametrize("kind", ["german_track", "iso_road"])
def test_what_a_road_was_made_from_is_told_and_not_fitted(kind):
    from movingfrf.scenarios.description import described

    scenario = parse_scenario(f'{CAR}[roughness]\nkind = "{kind}"\n{SPECTRUM_KINDS[kind][0]}\nseed = [1, 2]')
    lines = dict(dict(described(scenario).sections)["Roughness"])
    assert lines["source"] == scenario.case.road.description
    assert lines["fitted spectrum"] == "none: it was made from the spectrum above"
    assert not any("class" in name for name in lines)
    assert scenario.run().attrs["spectrum"] == str(scenario.case.road.spectrum)

"""Steps between a measured profile and one to drive on: what each does, and that each says so."""

import inspect

import numpy as np
import pytest

import movingfrf as mf
from movingfrf._basics.documented import documented
from movingfrf.commands.main import main
from movingfrf.roughness.preparation import STEPS

STEP = 0.1
X = 50.0 + STEP * np.arange(6001)


def waves(*lengths):
    return mf.Profile(X, sum(0.01 * np.sin(2 * np.pi * X / length + 0.3) for length in lengths))


def amplitude(profile, length, first=250.0, last=450.0):
    """Amplitude and phase of a wave in the middle of a profile, by projection over whole waves."""
    stations = profile.stations
    last = first + length * np.floor((last - first) / length)
    inside = (stations >= first - 1e-9) & (stations < last - 1e-9)
    wave = np.exp(-2j * np.pi * stations[inside] / length)
    return 2 * np.mean(np.asarray(profile.elevation)[inside] * wave)


def said(profile, *words):
    assert all(word in profile.steps[-1] for word in words), profile.steps


@pytest.mark.parametrize("length", [2.0, 10.0, 20.0, 40.0, 100.0])
def test_high_pass_keeps_its_share_and_shifts_nothing(length):
    """Closed form: 1/(1 + (λ/λ_c)⁴) of the amplitude, no phase; 2e-4 is what the ends add."""
    before = waves(length)
    after = mf.high_passed(before, wavelength=20.0)
    ratio = amplitude(after, length) / amplitude(before, length)
    assert ratio == pytest.approx(1 / (1 + (length / 20.0) ** 4), abs=2e-4)
    said(after, "took out waves longer than 20 m", "both ways")


def test_high_pass_takes_out_the_level():
    assert np.abs(mf.high_passed(mf.Profile(X, 583.0 + 0 * X), wavelength=50.0).elevation).max() < 1e-9


@pytest.mark.parametrize("length", [0.4, 1.0, 2.0, 4.0, 20.0])
def test_low_pass_keeps_its_share_and_shifts_nothing(length):
    """Closed form of the filter at even steps h: tan(πh/λ) stands for πh/λ, by the bilinear transform."""
    before = waves(length)
    after = mf.low_passed(before, wavelength=2.0)
    ratio = amplitude(after, length) / amplitude(before, length)
    warped = np.tan(np.pi * STEP / length) / np.tan(np.pi * STEP / 2.0)
    assert ratio == pytest.approx(1 / (1 + warped**4), abs=2e-4)
    said(after, "took out waves shorter than 2 m", "both ways")


@pytest.mark.parametrize("steps", [2, 3, 5, 8, 40])
def test_among_the_shortest_waves_both_filters_are_steeper_than_their_formula(steps):
    """tan(πh/λ) for 1/λ, with λ_c of four steps: tan(πh/λ_c) = 1."""
    before = mf.Profile(X, np.cos(2 * np.pi * np.arange(X.size) / steps))
    low, high = (filtered(before, wavelength=4 * STEP) for filtered in (mf.low_passed, mf.high_passed))
    left = 1 / (1 + np.tan(np.pi / steps) ** 4)
    middle = slice(X.size // 2, X.size // 2 + 200)
    for after, share in ((low, left), (high, 1 - left)):
        assert after.elevation[middle] == pytest.approx(share * before.elevation[middle], abs=1e-9)


def test_the_shortest_and_the_longest_wavelength_are_taken():
    """Whose last digit differs from that of four steps, or of the length: stations far out, stations added up."""
    for x in (100.0 + 0.05 * np.arange(4000), np.arange(-50.0, 149.97, 0.05)):
        road = mf.Profile(x, 0 * x)
        for wavelength in (0.2, 199.95):
            assert mf.low_passed(road, wavelength=wavelength).steps
            assert mf.high_passed(road, wavelength=wavelength).steps
        for wavelength in (0.2 * (1 - 1e-6), 199.95 * (1 + 1e-6)):
            with pytest.raises(ValueError, match=r"four steps and the length of the profile, 0\.2 and 199\.95 m"):
                mf.low_passed(road, wavelength=wavelength)


def test_low_and_high_pass_share_every_wave_between_them():
    road = mf.Profile(X, np.random.default_rng(4).normal(size=X.size))
    both = mf.low_passed(road, wavelength=5.0).elevation + mf.high_passed(road, wavelength=5.0).elevation
    assert both[1000:-1000] == pytest.approx(road.elevation[1000:-1000], abs=1e-9)
    assert mf.prepared(road, low_pass=5.0).elevation == pytest.approx(mf.low_passed(road, wavelength=5.0).elevation)


def test_resampling_takes_out_what_would_come_back_as_another_wave():
    """A wave of 0.6 m at stations every 0.5 m would look like one of 3 m."""
    before = waves(0.6, 10.0)
    after = mf.resampled(before, step=0.5)
    assert after.even_step() == pytest.approx(0.5)
    assert abs(amplitude(after, 10.0)) == pytest.approx(0.01, rel=1e-4)
    assert abs(amplitude(after, 3.0, last=430.0)) < 1e-6
    naive = mf.Profile(X[::5], before.elevation[::5])
    assert abs(amplitude(naive, 3.0, last=430.0)) == pytest.approx(0.01, rel=0.02)
    said(after, "resampled from 0.1 to 0.5 m", "shorter than 1.25 m")


def test_what_resampling_leaves_of_short_waves():
    """Butterworth of order 8, both ways: half of waves of 2.5 steps, less than 3 % of those of two.

    The bilinear transform bends frequencies by (π n h)²/3 of themselves, 2 % at n = 0.8 cycle/m and h = 0.1 m,
    which the 16th power multiplies; it bends that of the filter alike, so that the half stays.
    """
    assert abs(amplitude(mf.resampled(waves(1.25), step=0.5), 1.25)) == pytest.approx(0.005, rel=1e-3)
    # Two stations a wave, at its crests and troughs.
    x = STEP * np.arange(6001)
    crests = mf.resampled(mf.Profile(x, 0.01 * np.cos(2 * np.pi * x / 1.0)), step=0.5).elevation[400:800]
    assert np.abs(crests).max() == pytest.approx(0.01 / (1 + 1.25**16), rel=0.25)
    assert np.abs(crests).max() < 0.03 * 0.01


def test_finer_stations_are_on_the_spline():
    random = np.random.default_rng(0)
    stations = np.cumsum(random.uniform(0.1, 0.4, 400))
    road = mf.Profile(stations, np.stack([np.sin(stations), np.cos(stations)], axis=1), across=(0.8, -0.8))
    fine = mf.resampled(road, step=0.05)
    # The error of a cubic spline on steps h: (h⁴/384) max|z⁗|, five times that near the ends.
    assert fine.elevation[:, 0] == pytest.approx(np.sin(fine.stations), abs=5 * 0.4**4 / 384)
    assert fine.across == (0.8, -0.8)
    assert fine.stations[0] == stations[0]
    assert stations[-1] - 0.05 < fine.stations[-1] <= stations[-1]


@pytest.mark.parametrize("degree", [0, 1, 3])
def test_detrending_takes_out_its_polynomial_and_nothing_beyond(degree):
    u = (X - X[0]) / 600
    drift = 583.0 + 0 * u + (2.0 * u if degree else 0.0) + (5 * u**3 - u**2 if degree == 3 else 0.0)
    after = mf.detrended(mf.Profile(X, drift), degree=degree)
    assert np.abs(after.elevation).max() < 1e-11
    said(after, f"polynomial of degree {degree}")
    once = mf.detrended(mf.Profile(X, drift + 0.01 * np.sin(X)), degree=degree)
    twice = mf.detrended(once, degree=degree)
    assert twice.elevation == pytest.approx(once.elevation, abs=1e-12)


def test_detrending_far_from_the_origin():
    """Stations of 500 km: powers of them would lose all digits of a cubic."""
    x = 500e3 + X
    assert np.abs(mf.detrended(mf.Profile(x, 1e-6 * (x - 500e3) ** 2), degree=2).elevation).max() < 1e-9


def test_spikes_are_found_counted_and_bridged():
    clean = 0.002 * np.sin(X)
    dirty = np.stack([clean, clean], axis=1)
    dirty[[100, 101, 700], 0] += [0.05, 0.07, -0.04]
    dirty[3000, 1] += 0.021
    after = mf.repaired(mf.Profile(X, dirty), spike=0.02)
    # A straight line over 0.3 m of a sine: z″ h²/8.
    assert np.abs(after.elevation - clean[:, None]).max() < 0.002 * 0.3**2 / 8 * 1.01
    said(after, "replaced 4 spikes of more than 0.02 m", "the longest gap 0.3 m at 60 m")
    untouched = mf.repaired(mf.Profile(X, dirty), spike=0.2)
    assert np.array_equal(untouched.elevation, dirty)
    said(untouched, "replaced 0 spikes")


def test_words_of_a_key_promise_no_other_that_there_is_not():
    """The window of the median is an argument in Python alone; what a scenario is told of it is its default."""
    window = inspect.signature(mf.repaired).parameters["window"].default
    words = documented(mf.prepared)["spike"].words
    assert f"the median around it, over {window:g} m (`window` in Python)" in words
    assert "by default" not in words


@pytest.mark.parametrize("place", [slice(100, 106), slice(0, 1), slice(6000, 6001)])
def test_what_is_too_long_for_a_spike_is_refused(place):
    z = np.zeros(X.size)
    z[place] = 0.1
    with pytest.raises(ValueError, match=r"spikes make a gap of more than 0.5 m, or one at an end, near"):
        mf.repaired(mf.Profile(X, z), spike=0.02, window=2.0)


def test_cropping_keeps_distances():
    after = mf.cropped(waves(7.0), first=100.05, last=200.0)
    assert (after.stations[0], after.stations[-1]) == pytest.approx((100.1, 200.0))
    said(after, "cropped to 100.05 to 200 m")
    with pytest.raises(
        ValueError, match=r"first must leave at least 4 stations, but between 649.8 m and 650 m there"
    ):
        mf.cropped(waves(7.0), first=649.8)


def test_paths_are_taken_in_order_and_keep_their_places():
    road = mf.Profile(X[:5], np.arange(15.0).reshape(5, 3), across=(1.0, 0.0, -1.0))
    after = mf.selected(road, paths=[2, 0])
    assert after.across == (-1.0, 1.0)
    assert after.elevation[0].tolist() == [2.0, 0.0]
    with pytest.raises(ValueError, match="paths must be below 3, the number of paths, got 3"):
        mf.selected(road, paths=[3])
    with pytest.raises(ValueError, match="paths must be a list of at least one number of a path, got 1"):
        mf.selected(road, paths=1)


SHORT = mf.Profile(730.0 + 0.5 * np.arange(21), np.linspace(0.0, 0.2, 21) ** 2)


def test_repetition_is_periodic_and_names_its_jump():
    after = mf.repeated(SHORT, length=50.0)
    assert after.stations == pytest.approx(730.0 + 0.5 * np.arange(101))
    assert np.array_equal(after.elevation[21:42], SHORT.elevation)
    said(after, "repeated 4.81 times to 50 m", "jump of up to 0.04 m")


def test_overlap_fades_the_end_into_the_beginning():
    after = mf.repeated(SHORT, length=50.0, overlap=5.0)
    period = 21 - 10
    assert after.elevation[period : 2 * period] == pytest.approx(after.elevation[:period])
    # In the middle of the fade both count half.
    weights = 6 * 0.55**5 - 15 * 0.55**4 + 10 * 0.55**3
    mixed = weights * SHORT.elevation[5] + (1 - weights) * SHORT.elevation[16]
    assert after.elevation[5] == pytest.approx(mixed)
    assert np.abs(np.diff(after.elevation)).max() < 0.04 / 4
    said(after, "each time faded over 5 m")
    with pytest.raises(ValueError, match="overlap must be at most half of the profile, 5 m"):
        mf.repeated(SHORT, length=50.0, overlap=6.0)


def test_mirroring_has_no_jump():
    after = mf.mirrored(SHORT, length=45.0)
    z = SHORT.elevation
    assert after.elevation.tolist() == [*z, *z[-2::-1], *z[1:], *z[-2::-1], *z[1:11]]
    said(after, "mirrored forth and back 4.5 times to 45 m")
    with pytest.raises(ValueError, match="length must be at least that of the profile, 10 m, got 9 m"):
        mf.mirrored(SHORT, length=9.0)


def test_even_stations_are_demanded_where_they_matter():
    uneven = mf.Profile([0.0, 1.0, 2.5, 3.0, 4.0], np.zeros(5))
    for step in (
        lambda: mf.high_passed(uneven, wavelength=4.0),
        lambda: mf.repeated(uneven, length=9.0),
        lambda: mf.mirrored(uneven, length=9.0),
        lambda: mf.repaired(uneven, spike=1.0),
    ):
        with pytest.raises(
            ValueError, match=r"needs stations at an even step, but they are 0.5 to 1.5 m apart; resam"
        ):
            step()


def test_steps_are_told_in_order_and_faults_bear_the_name_of_the_option():
    ready = mf.prepared(waves(7.0), first=60.0, detrend=1, high_pass=50.0, step=0.25, mirror_to=2000.0)
    beginnings = ("cropped", "took out a polynomial", "took out waves longer", "resampled", "mirrored")
    assert len(ready.steps) == len(beginnings)
    assert all(step.startswith(word) for step, word in zip(ready.steps, beginnings, strict=True))
    assert mf.prepared(ready) is ready
    with pytest.raises(ValueError, match="high_pass must lie between four steps and the length of the profile"):
        mf.prepared(waves(7.0), high_pass=1e4)
    with pytest.raises(ValueError, match="mirror_to and repeat_to exclude each other"):
        mf.prepared(waves(7.0), mirror_to=1e3, repeat_to=1e3)
    with pytest.raises(ValueError, match="repeat_to must be at least that of the profile"):
        mf.prepared(waves(7.0), repeat_to=1.0)
    with pytest.raises(ValueError, match="detrend must be at most 5, got 6"):
        mf.prepared(waves(7.0), detrend=6)


def test_scenario_command_and_python_ask_for_steps_by_the_same_keys(tmp_path, capsys):
    keys = [key for step in STEPS for key in step.keys]
    assert list(inspect.signature(mf.prepared).parameters) == ["profile", *keys]
    file = tmp_path / "road.toml"
    file.write_text('[roughness]\nkind = "profile"\nfile = "road.csv"\nnonsense = 1\n')
    with pytest.raises(mf.ScenarioError, match="nonsense is not known here") as refused:
        mf.read_scenario(file)
    (said,) = [line for line in str(refused.value).splitlines() if "nonsense" in line]
    allowed = set(said.partition("allowed are ")[2].split(", "))
    reading = {
        "file",
        "format",
        "columns",
        "recording",
        "units",
        "speed",
        "skip_lines",
        "missing",
        "reverse",
        "across",
        "crop_rims",
        "repair_gaps",
    }
    assert allowed == {*keys, *reading, "kind"}
    assert main(["profile", "--help"]) == 0
    shown = " ".join(capsys.readouterr().out.replace("│", " ").split())
    for key in allowed - {"kind", "file"}:
        words = {**documented(mf.read_profile), **documented(mf.prepared)}[key].words
        assert f"--{key.replace('_', '-')} " in shown
        assert words.split("`")[0] in shown


def test_a_road_too_long_for_memory_is_refused_before_it_is_made():
    with pytest.raises(ValueError, match="of memory"):
        mf.mirrored(SHORT, length=1e15)
    with pytest.raises(ValueError, match="of memory"):
        mf.resampled(SHORT, step=1e-12)


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"across": (0.7, -0.7)}, "across must have one position .* for each path, 1, got 2"),
    ],
)
def test_lateral_positions_of_a_profile(fields, message):
    with pytest.raises(ValueError, match=message):
        mf.Profile(X, np.zeros(X.size), **fields)


def test_an_even_step_is_one_up_to_rounding():
    decimal = mf.Profile(np.round(1e5 + 0.1 * np.arange(1000), 1), np.zeros(1000))
    assert decimal.even_step() == pytest.approx(0.1)
    thirds = mf.Profile(np.round(np.arange(1000) / 3, 3), np.zeros(1000))
    assert thirds.even_step() == pytest.approx(1 / 3)
    assert mf.Profile(np.round(np.arange(1000) / 30, 2), np.zeros(1000)).even_step() is None

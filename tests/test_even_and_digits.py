"""One notion of even stations, and messages with as many digits as it takes."""

from pathlib import Path

import numpy as np
import pytest

import movingfrf as mf
from movingfrf._basics.wording import told_apart
from movingfrf.roughness.excitation import require_cover

CASES = Path(__file__).parent / "data" / "cases"

X = 0.1 * np.arange(4000)
Z = 0.004 * np.sin(0.7 * X)


@pytest.mark.parametrize(
    "stations",
    [
        np.float32(X),
        np.float32(20e3 + X),
        np.round(X / 3, 3),
        np.round(1e5 + X, 1),
        X + 1e-3 * np.sin(np.arange(4000.0)),
    ],
    ids=["single precision", "20 km along", "rounded thirds", "far along", "a hundredth of a step"],
)
def test_what_measures_take_as_even_is_even_for_all(tmp_path, stations):
    profile = mf.Profile(stations, Z)
    step = profile.even_step()
    assert step == pytest.approx(np.mean(np.diff(np.asarray(stations, float))))
    assert np.isfinite(mf.iri(profile)).all()
    for name in ("road.crg", "road.erd"):
        mf.write_profile(profile, tmp_path / name)
        back = mf.read_profile(tmp_path / name).profile
        assert np.abs(back.stations - profile.stations).max() < 0.02 * step + 1e-6
        assert back.columns[:, 0].tolist() == Z.tolist()
    mf.high_passed(profile, wavelength=20.0)
    mf.mirrored(profile, length=900.0)
    mf.repaired(profile, spike=1.0)
    assert not any("uneven" in finding for finding in mf.describe_profile(profile).findings)


def test_stations_that_a_file_does_not_hold_are_put_right_and_it_says_so(tmp_path):
    mf.write_profile(mf.Profile(np.float32(X), Z), tmp_path / "road.erd")
    text = (tmp_path / "road.erd").read_text()
    assert "HISTORY put stations at an even step, which moved them by up to 1.8e-05 m" in text
    mf.write_profile(mf.Profile(X, Z), tmp_path / "road.erd")
    assert "HISTORY" not in (tmp_path / "road.erd").read_text()
    mf.write_profile(mf.Profile(np.float32(X), Z), tmp_path / "road.crg")
    assert b"put stations at an even step" in (tmp_path / "road.crg").read_bytes()


def test_what_is_uneven_for_one_is_uneven_for_all(tmp_path):
    profile = mf.Profile(X + 0.005 * np.sin(np.arange(4000.0)), Z)
    assert profile.even_step() is None
    with pytest.raises(ValueError, match="must have stations at even steps"):
        mf.iri(profile)
    for name in ("road.crg", "road.erd"):
        with pytest.raises(
            ValueError, match=r"needs stations at an even step, but they are 0.0952\d* to 0.1048\d* m"
        ):
            mf.write_profile(profile, tmp_path / name)


def test_single_precision_in_a_file_is_even_from_the_first_to_the_last(tmp_path):
    from scipy.io import savemat

    savemat(tmp_path / "road.mat", {"distance": np.float32(X), "elevation": np.float32(Z)})
    profile, understood = mf.read_profile(tmp_path / "road.mat")
    assert "4000 stations from 0 m to 399.9 m every 0.1 m" in understood
    mf.write_profile(profile, tmp_path / "road.crg")


# A straight line has no class, whatever it is kept in.


@pytest.mark.parametrize("name", ["road.csv", "road.mat", "road.npz", "road.nc", "road.erd", "road.crg"])
def test_a_straight_ramp_has_no_class_in_any_format(tmp_path, name):
    ramp = mf.read_profile(CASES / "straight-ramp.csv").profile
    mf.write_profile(ramp, tmp_path / name)
    (path, *_) = mf.describe_profile(mf.read_profile(tmp_path / name, paths=[0]).profile).paths
    assert path.fit.road_class == ""
    assert "level or straight but for rounding" in path.fit.reason


# Digits.


@pytest.mark.parametrize(
    ("values", "texts"),
    [
        ((523417.6, 523417.5), ("523417.6", "523417.5")),
        ((1e6, 1e6 + 0.25), ("1000000", "1000000.2")),
        ((0.1, 0.1 + 1e-9), ("0.1", "0.100000001")),
        ((12.0, 400.0), ("12", "400")),
        ((5.0, 5.0), ("5", "5")),
        ((1e-9, 2e-9), ("1e-09", "2e-09")),
        ((np.nan, np.inf), ("nan", "inf")),
        ((1.0, np.nextafter(1.0, 2.0)), ("1", "1.0000000000000002")),
    ],
)
def test_as_many_digits_as_it_takes(values, texts):
    assert told_apart(*values) == texts


def test_every_comparison_shows_the_difference(tmp_path):
    road = mf.Profile(523417.0 + 0.1 * np.arange(100), np.zeros(100))
    with pytest.raises(ValueError, match=r"line 7: distance must increase, got 523418 m followed by 523417\.8 m"):
        mf.read_profile(CASES / "six-digits.csv")
    with pytest.raises(ValueError, match=r"distance must increase, got 523418\.2 m followed by 523418\.1 m"):
        mf.Profile([523417.9, 523418.0, 523418.2, 523418.1], np.zeros(4))
    with pytest.raises(ValueError, match=r"to 523427\.1 m, but it reaches from 523417 m to 523426\.9 m"):
        require_cover(road, 523417.0, 523427.1, [0])
    with pytest.raises(ValueError, match=r"at most half of the width, 0\.1 m, got 0\.10000001 m"):
        mf.pothole(depth=0.01, width=0.2, edge=0.10000001, at=0.0, length=1.0)
    with pytest.raises(ValueError, match=r"at least that of the profile, 9\.9 m, got 9\.8999999 m"):
        mf.repeated(road, length=9.8999999)
    with pytest.raises(ValueError, match=r"share an interval, but they reach from 523417 m to 523426\.9 m"):
        mf.superposed(road, mf.Profile(523427.0 + 0.1 * np.arange(4), np.zeros(4)))

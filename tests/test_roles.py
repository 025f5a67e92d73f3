"""What names and units say, and which values are no elevations."""

import numpy as np
import pytest

from movingfrf.roughness.formats.choice import Array, Series, choose
from movingfrf.roughness.formats.roles import counts, head, kind_of_unit
from movingfrf.roughness.sentinels import sentinels


@pytest.mark.parametrize(
    ("name", "unit", "role", "found"),
    [
        ("station [m]", "", "station", "m"),
        ("station_ft", "", "station", "ft"),
        ("Distance, m", "", "station", "m"),
        ("dist(m)", "", "station", "m"),
        ("DistKm", "", "station", "km"),
        ("KM", "", "station", "km"),
        ("Chainage", "", "station", None),
        ("Fahrweg", "mm", "station", "mm"),
        ("Stationierung [km]", "", "station", "km"),
        ("x", "", "station", None),
        ("elevation of path 0 [m]", "", "elevation", "m"),
        ("Elevation in mm", "", "elevation", "mm"),
        ("LElev.", "", "elevation", None),
        ("Längshöhe (links)", "", "elevation", "links"),
        ("left_in", "", "unknown", "in"),
        ("left", "", "unknown", None),
        ("ProfileDistance", "", "station", None),
        ("Profil links", "", "elevation", None),
        ("profile_s", "", "station", None),
        ("t", "s", "time", "s"),
        ("t", "", "time", None),
        ("time_ms", "", "time", "ms"),
        ("Messzeit [h]", "", "time", "h"),
        ("x", "s", "time", "s"),
        ("h", "", "elevation", None),
        ("", "", "unknown", None),
        ("Unnamed: 0", "", "counter", None),
        ("No.", "", "counter", None),
        ("Speed", "", "other", None),
        ("v [km/h]", "", "other", "km/h"),
        ("latitude", "degrees_north", "other", "degrees_north"),
        ("vertical acceleration", "", "other", None),
        ("z", "m/s^2", "other", "m/s^2"),
        ("IRI (m/km)", "", "other", "m/km"),
        ("lateral position [m]", "", "across", "m"),
        ("distance", "1", "station", None),
    ],
)
def test_a_name_and_a_unit_say_what_it_is(name, unit, role, found):
    assert head(name, unit) == (role, found)


def series(**values):
    return [Series(name, head(name), Array((len(each),), lambda each=each: each)) for name, each in values.items()]


X, Z = np.linspace(0.0, 1.0, 9), np.array([0.0, 3.0, 1.0, 2.0, 0.0, 3.0, 1.0, 2.0, 0.0])


def test_station_and_elevations_by_name_wherever_they_stand():
    names = ("no", "elevation [mm]", "time [s]", "right [mm]", "remark", "distance [m]")
    found = series(**dict(zip(names, (X, Z, X, Z, Z, X), strict=True)))
    for ordered in (True, False):
        assert choose(found, ordered=ordered) == {"": (5, [1, 3], False)}
    assert choose(series(a=X, b=Z), ordered=True) == {"": (0, [1], False)}
    assert choose(series(a=Z, b=X), ordered=False) == {"": (1, [0], False)}


def test_counters_and_units():
    assert counts(np.arange(5.0))
    assert counts(np.arange(1.0, 5.0))
    assert not counts(np.array([0.0, 1.0, 2.5]))
    assert not counts(np.arange(7.0, 12.0))
    assert [kind_of_unit(unit) for unit in ("ft", "MS", "m/s", "links")] == ["length", "time", "other", "unknown"]


@pytest.mark.parametrize("marker", [-9999.0, -999.25, -9.999, -32768e-3, 99999.0, -9999 * 0.3048, 1e19])
def test_markers_stand_out(marker):
    road = 100 + 0.01 * np.sin(np.arange(500.0) / 7)
    with_gaps = np.stack([road, road], axis=1)
    with_gaps[[20, 21, 90], [0, 0, 1]] = marker
    (found,) = sentinels(with_gaps)
    assert (found.value, found.number, found.first) == (marker, 3, 20)


def test_markers_at_every_other_station_stand_out():
    road = 0.01 * np.sin(np.arange(500.0) / 7)
    road[::2] = -9999.0
    assert [(each.value, each.number) for each in sentinels(road)] == [(-9999.0, 250)]


def test_several_markers_and_gaps_beside_them():
    road = 0.01 * np.sin(np.arange(500.0) / 7)
    road[[3, 4, 5, 300]] = [-9999.0, -9999.0, -999.25, np.nan]
    assert [each.value for each in sentinels(road)] == [-9999.0, -999.25]


@pytest.mark.parametrize(
    "road",
    [
        np.where(np.arange(100) > 50, 0.15, 0.0),  # a kerb
        np.where(np.arange(100) == 50, -0.0999, 0.0),  # a pothole
        np.linspace(0.0, 999.0, 200),  # a mountain
        np.linspace(0.0, 0.949, 950) + np.where(np.arange(950) > 400, 0.05, 0.0),  # with a kerb, up to 0.999 m
        np.full(50, 12.0),
        np.where(np.arange(100) > 50, 200.0, 100.0),  # two levels
        np.full(50, np.nan),
        np.array([0.0, 1.0]),
    ],
)
def test_roads_have_no_markers(road):
    assert sentinels(road) == []

"""What is missing in a file, chainage, and profiles that run the other way."""

import contextlib
import csv
import io
import itertools
import json
import re
from pathlib import Path

import numpy as np
import pytest

import movingfrf as mf
from movingfrf.commands.main import main
from movingfrf.metrics.iri import iri

STEP, COUNT = 0.1, 4000
X = np.round(12_345.6 + STEP * np.arange(COUNT), 3)
Z = np.round(5e-4 * np.cumsum(np.random.default_rng(0).normal(size=COUNT)), 6)
LOST = (X > 12_500) & (X < 12_540)


def written(path, columns, heads=("x [m]", "z [m]")):
    rows = zip(*columns, strict=True)
    path.write_text("\n".join(",".join(map(str, row)) for row in [heads, *rows]) + "\n")
    return path


def emptied(values, lost, by=""):
    return [by if gone else value for value, gone in zip(values.tolist(), lost, strict=True)]


@pytest.fixture
def rows(tmp_path):
    return written(tmp_path / "rows.csv", [X[~LOST], Z[~LOST]])


@pytest.fixture
def cells(tmp_path):
    return written(tmp_path / "cells.csv", [X, emptied(Z, LOST)])


def refusal(file, **options):
    with pytest.raises(ValueError, match="missing in") as refused:
        mf.read_profile(file, **options)
    return str(refused.value).replace(str(file), "")


def test_rows_that_are_not_there_are_a_gap_like_empty_cells(rows, cells):
    words = refusal(rows)
    assert "line 1547: no elevation at 12500.1 m; in all 399 elevations are missing in 1 gap" in words
    assert "the longest 40 m long at 12500.1 m. `repair_gaps`" in words
    assert words == refusal(cells)
    with pytest.raises(ValueError, match=r"the gap at 12500\.1 m is 40 m long, and `repair_gaps` .* allows 39 m"):
        mf.read_profile(rows, repair_gaps=39)
    one, other = (mf.read_profile(file, repair_gaps=40.01).profile for file in (rows, cells))
    assert np.allclose(one.stations, other.stations, rtol=0, atol=1e-9)
    assert np.allclose(one.elevation, other.elevation, rtol=0, atol=1e-15)
    line = np.interp(X, X[~LOST], Z[~LOST])
    assert np.allclose(one.elevation, line, rtol=0, atol=1e-12)
    assert one.steps == other.steps


def test_a_hole_beside_what_is_chosen_does_not_matter(rows):
    assert mf.read_profile(rows, first=12_540).profile.stations[0] == 12_540
    assert mf.read_profile(rows, last=12_500).profile.stations[-1] == 12_500
    assert "40 m long" in refusal(rows, first=12_490, last=12_550)


@pytest.mark.parametrize("paths", [None, [1]])
def test_a_hole_is_a_gap_on_every_path(tmp_path, paths):
    file = written(tmp_path / "two.csv", [X[~LOST], Z[~LOST], -Z[~LOST]], ["x [m]", "left [m]", "right [m]"])
    each = 399
    assert f"in all {each * (2 if paths is None else 1)} elevations are missing" in refusal(file, paths=paths)


def test_holes_in_other_formats(tmp_path):
    np.savez(tmp_path / "road.npz", distance=X[~LOST], elevation=Z[~LOST])
    assert "value 1546: no elevation at 12500.1 m" in refusal(tmp_path / "road.npz")
    jitter = np.random.default_rng(1).uniform(0, 0.9 * STEP, COUNT)
    file = written(tmp_path / "jitter.csv", [np.round(X + jitter, 4)[~LOST], Z[~LOST]])
    assert "missing in 1 gap, the longest 40" in refusal(file)


@pytest.mark.parametrize(
    "stations",
    [
        np.cumsum(np.random.default_rng(0).lognormal(2.0, 0.8, 400)),  # a track of GPS
        np.unique(
            np.concatenate([np.arange(0.0, 100.0, 0.5), np.round(np.arange(20, 21, 0.01), 2)])
        ),  # a shape's dense edge
        np.delete(np.arange(0.0, 100.0, 0.1), [40, 500, 501]),  # a row or two dropped
        np.array([0.0, 1.0, 2.0, 3.0, 40.0]),
    ],
)
def test_what_is_meant_to_be_uneven_is_read(tmp_path, stations):
    file = written(tmp_path / "road.csv", [stations, 0.001 * np.sin(stations)])
    assert np.array_equal(mf.read_profile(file).profile.stations, stations)


def test_a_hole_longer_than_memory(tmp_path):
    """So many stations are not put there."""
    stations = np.concatenate([np.arange(0.0, 10.0, 0.001), 1e12 + np.arange(0.0, 10.0, 0.001)])
    file = written(tmp_path / "road.csv", [stations, 0 * stations])
    assert "the longest 1e+12 m long" in refusal(file)
    assert mf.read_profile(file, repair_gaps=1e13).profile.stations.size < 6 * stations.size


def test_pieces_are_described_each_by_itself(rows, cells, tmp_path):
    pieces = [piece.profile for piece in mf.read_pieces(cells)]
    assert [piece.stations[[0, -1]].tolist() for piece in pieces] == [[12_345.6, 12_500], [12_540, X[-1]]]
    found = mf.describe_profile(pieces)
    (path,) = found.paths
    assert any("There are gaps between 2 pieces" in words for words in found.findings)
    longest = mf.describe_profile(pieces[1])
    assert np.array_equal(path.density, longest.paths[0].density)
    assert path.fit == longest.paths[0].fit
    lengths = [np.ptp(piece.stations) for piece in pieces]
    each = [float(iri(piece)[0, 0]) for piece in pieces]
    assert path.index == pytest.approx(np.average(each, weights=lengths), rel=1e-12)
    edges, values = found.edges[20.0], path.indices[20.0]
    blank = {at for at, value in zip(edges, values, strict=False) if np.isnan(value)}
    assert blank == {12_500.0, 12_520.0}
    # Those of the second piece, from its first station on: 12540 is a multiple of 20.
    assert values[edges[:-1] >= 12_540][:10] == pytest.approx(iri(pieces[1], segment=20.0)[:10, 0], rel=1e-12)
    assert main(["profile", str(rows), "--keep-gaps", "-o", str(tmp_path / "out")]) == 0
    lines = list(csv.DictReader((tmp_path / "out" / "iri.csv").read_text().splitlines()))
    assert [line["start [m]"] for line in lines if not line["IRI of path 0 [mm/m]"]] == ["12500", "12520", "12500"]
    content = json.loads((tmp_path / "out" / "profile.json").read_text())
    assert content["paths"][0]["iri_per_20_m_mm_per_m"].count(None) == 2


def test_short_gaps_are_filled_and_long_ones_part(tmp_path):
    lost = LOST | ((X > 12_600.05) & (X < 12_600.35))
    file = written(tmp_path / "road.csv", [X, emptied(Z, lost)])
    assert len(mf.read_pieces(file)) == 3
    pieces = mf.read_pieces(file, repair_gaps=0.5)
    assert [piece.profile.stations[0] for piece in pieces] == [12_345.6, 12_540]
    assert pieces[1].profile.steps[0].startswith("filled 3 missing elevations in 1 gap")
    with pytest.raises(ValueError, match="no four stations in a row"):
        mf.read_pieces(written(tmp_path / "none.csv", [X, emptied(Z, np.arange(COUNT) % 3 == 0)]))
    with pytest.raises(ValueError, match="distance must increase"):
        mf.read_pieces(written(tmp_path / "falls.csv", [-X, Z]))


def test_paths_with_gaps_of_their_own_are_parted_together(tmp_path):
    other = (X > 12_600) & (X < 12_610)
    file = written(
        tmp_path / "two.csv", [X, emptied(Z, LOST), emptied(-Z, other)], ["x [m]", "left [m]", "right [m]"]
    )
    ends = [piece.profile.stations[[0, -1]].tolist() for piece in mf.read_pieces(file)]
    assert ends == [[12_345.6, 12_500], [12_540, 12_600], [12_610, X[-1]]]


def test_what_is_simulated_has_no_gaps(cells, capsys):
    assert main(["convert", str(cells), str(cells.with_suffix(".nc")), "--keep-gaps"]) == 2
    assert "--keep-gaps" in capsys.readouterr().err
    scenario = cells.with_suffix(".toml")
    scenario.write_text('[roughness]\nkind = "profile"\nfile = "cells.csv"\nkeep_gaps = true\n')
    with pytest.raises(mf.ScenarioError, match="keep_gaps is not known here"):
        mf.read_scenario(scenario)


# Chainage.


@pytest.mark.parametrize("first", [0.0, 7.3, 12_345.6, -33.0])
def test_segments_begin_at_multiples_of_their_length(first):
    stations = np.round(first + STEP * np.arange(COUNT), 6)
    found = mf.describe_profile(mf.Profile(stations, Z))
    for span, edges in found.edges.items():
        inner = edges[1:-1]
        assert np.allclose(inner % span, 0)
        assert (edges[0], edges[-1]) == (stations[0], stations[-1])
        lengths = np.diff(edges)
        assert (lengths > 0).all()
        assert np.allclose(lengths[1:-1], span)
        assert lengths[-1] <= span
        # By the index of the whole: segments share it by their lengths, but for steps that they cut.
        (path,) = found.paths
        assert np.average(path.indices[span], weights=lengths) == pytest.approx(path.index, rel=5e-3)


def test_what_is_too_short_for_an_index_is_listed_without(tmp_path):
    road = mf.Profile(np.round(99.8 + STEP * np.arange(1004), 6), Z[:1004])
    found = mf.describe_profile(road)
    assert found.edges[20.0].tolist() == [99.8, 100, 120, 140, 160, 180, 200, 200.1]
    assert np.flatnonzero(np.isnan(found.paths[0].indices[20.0])).tolist() == [0, 6]
    assert np.isfinite(found.paths[0].index)


def test_tables_of_many_files_can_be_put_together(rows, tmp_path):
    names = ["a.csv", "b.csv"]
    for name in names:
        written(tmp_path / name, [X, Z])
        assert main(["profile", str(tmp_path / name), "-o", str(tmp_path / name[0])]) == 0
    (heads, *first), (same, *second) = (
        [*csv.reader((tmp_path / name[0] / "iri.csv").read_text().splitlines())] for name in names
    )
    assert heads == same == ["file", "segment [m]", "start [m]", "end [m]", "IRI of path 0 [mm/m]"]
    assert {line[0] for line in first} | {line[0] for line in second} == {*names}
    assert all(len(line[4].replace(".", "").lstrip("0")) <= 5 for line in first)
    assert [line[2:4] for line in first if line[1] == "100"] == [
        list(pair) for pair in itertools.pairwise(["12345.6", "12400", "12500", "12600", "12700", "12745.5"])
    ]


def test_the_recipe_for_many_files_runs(rows, cells, tmp_path, monkeypatch):
    page = (Path(__file__).parents[1] / "docs" / "profiles.md").read_text(encoding="utf-8")
    (code,) = re.findall(r"```python\n(.*?)```", page.partition("## Many files")[2], re.DOTALL)
    (tmp_path / "survey").mkdir()
    for file in (rows, cells):
        file.rename(tmp_path / "survey" / file.name)
    written(tmp_path / "survey" / "short.csv", [X[:300], Z[:300]])
    monkeypatch.chdir(tmp_path)
    with contextlib.redirect_stdout(io.StringIO()) as told:
        exec(code, {})
    heads, *lines = csv.reader(told.getvalue().splitlines())
    assert heads == ["file", "from [m]", "to [m]", "path", "IRI [mm/m]"]
    assert [line[0] for line in lines] == ["cells.csv"] * 5 + ["rows.csv"] * 5
    assert [line[1:] for line in lines[:5]] == [line[1:] for line in lines[5:]]
    assert [line[2] for line in lines[:5] if not line[4]] == ["12600.0"]


# Values that stand for nothing.


def of_format(path, columns, marker):
    """Write a profile in millimetres, or in metres where a format has no other unit, with a marker in it."""
    x, z = (np.asarray(column, float) for column in columns)
    z = np.where(LOST, marker, 1e3 * z)
    if path.suffix == ".csv":
        written(path, [x, z], ["x [m]", "z [mm]"])
    elif path.suffix == ".npz":
        np.savez(path, **{"station [m]": x, "elevation [mm]": z.astype(np.float32)})
    elif path.suffix == ".erd":
        mf.write_profile(mf.Profile(STEP * np.arange(COUNT), z), path)
        path.write_text(path.read_text(encoding="latin-1").replace("UNITSNAMm ", "UNITSNAMmm"), encoding="latin-1")
    elif path.suffix == ".crg":
        mf.write_profile(mf.Profile(STEP * np.arange(COUNT), np.stack([z, z], 1), across=(1.0, -1.0)), path)
    return path


@pytest.mark.parametrize("ending", ["csv", "npz", "erd", "crg"])
@pytest.mark.parametrize("marker", [-9999.0, -999.25])
def test_what_stands_for_nothing_is_a_gap_in_every_format(tmp_path, ending, marker):
    pytest.importorskip("pyopencrg" if ending == "crg" else "numpy")
    file = of_format(tmp_path / f"road.{ending}", [X, Z], marker)
    before = mf.read_profile(file).profile
    assert before.columns.min() < -0.9
    each = 2 if ending == "crg" else 1
    assert f"in all {399 * each} elevations are missing" in refusal(file, missing=[-1.0, marker])
    pieces = mf.read_pieces(file, missing=[marker])
    assert [piece.profile.stations.size for piece in pieces] == [1545, 2056]


def test_where_markers_stand_nothing_is_computed(tmp_path):
    found = mf.describe_profile(mf.Profile(X, np.stack([Z, np.where(LOST, -9999.0, Z)], axis=1)))
    good, bad = found.paths
    assert good.fit.road_class
    assert np.isfinite(good.index)
    assert not bad.fit.road_class
    assert np.isnan(bad.index)
    assert np.isnan(bad.indices[20.0]).all()
    assert found.coherence is None
    assert any("`missing` (on the command line --missing) says what stands" in words for words in found.findings)
    assert "Path 1: no class: values that stand for missing ones are no road." in found.findings
    file = written(tmp_path / "road.csv", [X, emptied(Z, LOST, -9999)])
    assert main(["profile", str(file), "--missing", "-9999", "--keep-gaps"]) == 0
    with pytest.raises(ValueError, match="missing must be an array of numbers"):
        mf.read_profile(file, missing=["x"])


# The other way.


def test_falling_chainage_is_turned_round_on_request(tmp_path):
    file = written(tmp_path / "falls.csv", [X[::-1], Z[::-1]])
    with pytest.raises(ValueError, match=r"line 3: distance must increase.* it falls throughout, and `reverse`"):
        mf.read_profile(file)
    profile = mf.read_profile(file, reverse=True).profile
    assert np.array_equal(profile.stations, X)
    assert np.array_equal(profile.elevation, Z)
    assert profile.steps == ("turned round, as driven the other way: what was left is right",)
    part = mf.read_profile(file, reverse=True, first=12_400, last=12_450).profile
    assert part.stations[[0, -1]].tolist() == [12_400, 12_450]
    assert main(["profile", str(file), "--reverse"]) == 0


def test_what_rises_is_counted_from_the_other_end(tmp_path):
    file = tmp_path / "road.nc"
    mf.write_profile(mf.Profile([1.0, 2.0, 4.0, 8.0], np.arange(8.0).reshape(4, 2), across=(0.7, -0.7)), file)
    turned = mf.read_profile(file, reverse=True).profile
    assert turned.stations.tolist() == [1.0, 5.0, 7.0, 8.0]
    assert turned.elevation.tolist() == [[6, 7], [4, 5], [2, 3], [0, 1]]
    assert turned.across == (-0.7, 0.7)


def test_the_place_of_a_fault_is_that_of_the_file(tmp_path):
    values = emptied(Z[:50], np.arange(50) == 9)
    file = written(tmp_path / "falls.csv", [X[:50][::-1], values])
    with pytest.raises(ValueError, match="line 11: no elevation"):
        mf.read_profile(file, reverse=True)


def test_sections_one_behind_the_other_are_named(tmp_path):
    file = written(tmp_path / "two.csv", [np.tile(X[:50], 3), Z[:150]])
    with pytest.raises(ValueError, match=r"line 52: distance must increase.* begins again 2 times: recordings one"):
        mf.read_profile(file)
    slip = written(tmp_path / "slip.csv", [np.delete(np.append(X[:50], X[48]), 48), Z[:50]])
    with pytest.raises(ValueError, match=r"12350\.4 m$"):
        mf.read_profile(slip)


def test_what_was_done_to_any_piece_is_said(cells):
    pieces = [piece.profile for piece in mf.read_pieces(cells)]
    pieces = [pieces[0], mf.detrended(pieces[1], degree=1)]
    assert mf.describe_profile(pieces).profile.steps == pieces[1].steps

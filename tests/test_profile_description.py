"""What `movingfrf profile` and `convert` say and write."""

import csv
import itertools
import json
import re
from pathlib import Path

import numpy as np
import pytest
import scipy.signal

import movingfrf as mf
from movingfrf.commands.main import main
from movingfrf.metrics.profile import as_dict
from movingfrf.reports.profile import render
from movingfrf.roughness.fitting import SMOOTHING_EDGES

DATA = Path(__file__).parents[2] / "shared" / "data"


def needs(name):
    return pytest.mark.skipif(not (DATA / name).exists(), reason=f"the published profile {name} is not there")


def noise(seed, count=40_000):
    """Make a road whose slope is white: waviness 2."""
    return 1e-3 * np.cumsum(np.random.default_rng(seed).normal(size=count))


@pytest.mark.parametrize(("letter", "waviness"), [("A", 2.0), ("C", 1.6), ("F", 2.5)])
def test_class_and_waviness_of_a_known_road(letter, waviness):
    road = mf.realise(mf.IsoRoad.of_class(letter, waviness=waviness), length=4000.0, step=0.05, seed=3)
    (path,) = mf.describe_profile(road).paths
    assert path.fit.waviness == pytest.approx(waviness, abs=0.05)
    # Some 20 pieces of 400 m: lines are right to 1/√20, and a fit through hundreds of them to some percent.
    assert path.fit.roughness == pytest.approx(16e-6 * 4.0 ** "ABCDEF".index(letter), rel=0.1)
    assert path.fit.road_class == letter or waviness != 2.0


X = 0.05 * np.arange(8000)
UNEVEN = np.sort(X + np.random.default_rng(0).uniform(0, 0.02, 8000))
STRAIGHT = {
    "level": (X, 0.0 * X),
    "level, far up": (X, 583.123 + 0.0 * X),
    "a ramp": (X, 0.06 * X),
    "a ramp, far up": (X, 583.0 + 0.06 * X),
    "downhill, far out": (5e5 + X, 1234.5 - 0.1 * (5e5 + X)),
    "added up": (X, 583.0 + np.cumsum(np.full(X.size, 0.003))),
    "uneven stations": (UNEVEN, 583.0 + 0.03 * UNEVEN),
    "whole millimetres": (X, np.round(0.0123 * X, 3)),
    "whole micrometres, uneven stations": (UNEVEN, np.round(583 + 0.0123 * UNEVEN, 6)),
    "single precision": (X, (583.0 + 0.0123 * X).astype(np.float32)),
}


@pytest.mark.parametrize("name", STRAIGHT)
def test_a_straight_line_has_no_class(name):
    """What is left of it is the rounding of its numbers: 7e-25 m³ were class A."""
    profile = mf.Profile(*STRAIGHT[name])
    found = mf.describe_profile(profile)
    (path,) = found.paths
    assert (path.fit.road_class, path.fit.reason[:45]) == ("", "the profile is level or straight but for roun")
    assert not path.density.size
    assert any("No class: the profile is level or straight but for rounding" in words for words in found.findings)
    assert as_dict(found)["paths"][0]["iso_8608_class"] is None
    along = profile.stations
    slope = (profile.elevation[-1] - profile.elevation[0]) / (along[-1] - along[0])
    assert path.slope == pytest.approx(slope, abs=1e-5)
    render(found, understood="", title="a line")


@pytest.mark.parametrize("datum", [0.0, 583.0])
@pytest.mark.parametrize("roughness", [1e-12, 16e-6])
def test_what_is_rough_on_a_ramp_keeps_its_class(datum, roughness):
    """Also where it is micrometres, as on rails."""
    road = mf.realise(mf.IsoRoad(roughness=roughness), length=400.0, seed=1)
    z = datum + 0.06 * road.stations + road.elevation
    (path,) = mf.describe_profile(mf.Profile(road.stations, z)).paths
    assert path.fit.road_class == "A"
    assert path.fit.roughness_at_two == pytest.approx(roughness, rel=0.3)
    assert path.slope == pytest.approx(0.06, abs=1e-3)


def test_a_mean_slope_is_named(tmp_path, capsys):
    """By the command, its JSON and its page, and by what is said of a scenario."""
    road = mf.realise(mf.IsoRoad.of_class("A"), length=400.0, seed=1)
    columns = np.stack([road.elevation + 0.06 * road.stations, road.elevation - 0.01 * road.stations], axis=1)
    mf.write_profile(mf.Profile(road.stations, columns), tmp_path / "road.csv")
    assert main(["profile", str(tmp_path / "road.csv"), "-o", str(tmp_path / "out")]) == 0
    out = capsys.readouterr().out
    assert "mean slope" in out
    assert re.search(r"\b6\.0\d\b.*\n.* -1\.0\d\b", out)
    paths = json.loads((tmp_path / "out" / "profile.json").read_text(encoding="utf-8"))["paths"]
    assert [path["mean_slope_percent"] for path in paths] == pytest.approx([6.0, -1.0], abs=0.1)
    scenario = tmp_path / "case.toml"
    text = (Path(__file__).parents[1] / "examples" / "paved_road.toml").read_text(encoding="utf-8")
    road_and_run = (
        '[roughness]\nkind = "profile"\nfile = "road.csv"\n[run]\nspeed = 20.0\nduration = 5.0\nstart = 5.0\n'
    )
    scenario.write_text(text.partition("[roughness]")[0] + road_and_run, encoding="utf-8")
    assert main(["check", str(scenario)]) == 0
    assert re.search(r"mean slope +6\.0\d %, -1\.0\d %", capsys.readouterr().out)


@pytest.mark.parametrize("count", [999, 1000, 20_001, 30_000])
def test_spectra_are_those_of_welch(count):
    """By another program, up to rounding; the coherence, from its cross-spectra summed over the bands."""
    first, second = noise(0, count), noise(1, count)
    second += first
    found = mf.describe_profile(mf.Profile(0.1 * np.arange(count), np.stack([first, second], axis=1)))
    pieces = max(8, int(2 * 0.1 * count / 400))
    length = 2 * count // (pieces + 1)
    options = {"fs": 10.0, "nperseg": length, "detrend": "linear"}
    for path, elevation in zip(found.paths, (first, second), strict=True):
        n, density = scipy.signal.welch(elevation, **options)
        assert path.spatial_frequency == pytest.approx(n[3:])
        assert path.density == pytest.approx(density[3:], rel=1e-9)
    n, both = scipy.signal.csd(first, second, **options)
    own, other = (scipy.signal.welch(z, **options)[1] for z in (first, second))
    centres, coherence = found.coherence
    for centre, value in zip(centres, coherence, strict=True):
        edge = np.searchsorted(SMOOTHING_EDGES, centre)
        band = (n >= SMOOTHING_EDGES[edge - 1]) & (n < SMOOTHING_EDGES[edge]) & (np.arange(n.size) >= 3)
        expected = abs(both[band].sum()) ** 2 / (own[band].sum() * other[band].sum())
        assert value == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize(("shared", "expected"), [(0.0, 0.0), (1.0, 0.5), (3.0, 0.9)])
def test_coherence_of_paths_with_a_known_part_in_common(shared, expected):
    """γ² = s²/(1 + s²) for a path that is s times the other plus noise of the same spectrum."""
    first, own = noise(0, 200_000), noise(1, 200_000)
    road = mf.Profile(0.1 * np.arange(200_000), np.stack([first, shared * first + own], axis=1))
    n, coherence = mf.describe_profile(road).coherence
    # Bands of two lines and more in 100 pieces: scatter of √(2 γ² (1 − γ²)²/200), three times that, and bias 1/200.
    above = n > 0.1
    assert above.sum() > 10
    assert coherence[above] == pytest.approx(
        expected, abs=3 * np.sqrt(2 * expected) * (1 - expected) / np.sqrt(200) + 0.02
    )


def test_equal_paths_are_coherent_and_one_path_has_no_coherence():
    road = mf.Profile(0.1 * np.arange(5000), np.stack([noise(0, 5000)] * 2, axis=1))
    # Equal but for 10⁻⁹ of it: no longer the same path, and still as coherent as numbers can be.
    near = mf.Profile(road.stations, road.columns * [1.0, 1 + 1e-9])
    assert mf.describe_profile(near).coherence[1] == pytest.approx(1.0)
    assert mf.describe_profile(road).coherence is None
    assert mf.describe_profile(mf.selected(road, paths=[0])).coherence is None
    flat = mf.Profile(0.1 * np.arange(5000), np.zeros((5000, 2)))
    assert mf.describe_profile(flat).coherence is None
    assert mf.describe_profile(flat).paths[0].fit.road_class == ""


def test_roughness_index_of_waves_of_ten_metres():
    """Golden car: 1.2584 times the slope's amplitude, of whose rectified sine the mean is 2/π."""
    x = 0.05 * np.arange(20_001)
    road = mf.Profile(x, 1e-3 * 10 / (2 * np.pi) * np.sin(2 * np.pi * x / 10))
    (path,) = mf.describe_profile(road).paths
    assert {span: each.size for span, each in path.indices.items()} == {20.0: 50, 100.0: 10}
    assert path.indices[100.0][1:] == pytest.approx(2 / np.pi * 1.2584, rel=2e-3)
    assert path.index == pytest.approx(2 / np.pi * 1.2584, rel=1e-2)


def test_what_looks_odd_is_told():
    z = np.round(noise(0, 8000), 4)
    z[500] += 0.2
    z[2000:2300] = z[2000]
    stations = 0.1 * np.arange(8000)
    found = mf.describe_profile(mf.Profile(stations, z))
    spike, level = found.findings
    assert re.match(r"1 elevation stands out from both of its neighbours, by (199|200|201) mm at 50 m", spike)
    assert re.match(r"The elevation does not change at all over (29\.9|30) m", level)
    assert "from 200 m on" in level
    assert found.paths[0].resolution == 1e-4
    z[5000:5200], z[6000:6250] = z[5000], z[6000]
    _, levels = mf.describe_profile(mf.Profile(stations, z)).findings
    for words in ("m from 200 m on", "m from 500 m on", "m from 600 m on"):
        assert words in levels
    smooth = mf.describe_profile(mf.Profile(stations, noise(0, 8000)))
    assert smooth.findings == ()
    assert smooth.paths[0].resolution == 0.0


def test_uneven_stations_are_put_right_for_the_measures_only():
    x = np.sort(0.1 * np.arange(20_000) + np.random.default_rng(0).uniform(0, 0.05, 20_000))
    road = mf.Profile(x, 0.01 * np.sin(2 * np.pi * x / 10))
    found = mf.describe_profile(road)
    assert found.profile is road
    assert "Stations are uneven" in found.findings[0]
    even = mf.describe_profile(
        mf.Profile(0.1 * np.arange(20_000), 0.01 * np.sin(2 * np.pi * np.arange(20_000) / 100))
    )
    assert found.paths[0].index == pytest.approx(even.paths[0].index, rel=2e-3)


@pytest.mark.parametrize(
    ("road", "reason"),
    [
        (mf.Profile(0.1 * np.arange(100), noise(0, 100)), "needs 11 m of road, and there are 9.9 m"),
        (
            mf.Profile(0.5 * np.arange(100), noise(0, 100)),
            "needs a step of at most 0.3 m, and there is one of 0.5 m",
        ),
    ],
)
def test_where_there_is_no_roughness_index_the_reason_is_told(road, reason):
    found = mf.describe_profile(road)
    assert reason in found.findings[0]
    assert np.isnan(found.paths[0].index)
    assert as_dict(found)["paths"][0]["iri_mm_per_m"] is None
    assert "International roughness index</h3>" not in render(found, understood="", title="x")


def test_of_many_paths_some_are_described():
    road = mf.Profile(0.1 * np.arange(400), np.stack([noise(n, 400) for n in range(20)], axis=1))
    found = mf.describe_profile(road)
    assert [path.number for path in found.paths] == [0, 4, 8, 11, 15, 19]
    assert found.paths[2].highest == road.elevation[:, 8].max()
    assert found.scope == "6 of 20 paths are described"
    assert not any("described" in finding for finding in found.findings)
    page = render(found, understood="", title="x")
    assert "6 of 20 paths are described." in page
    assert "6 of them described" in page


def test_equal_paths_are_said_and_described_once():
    first, other = noise(0), noise(1)
    first[20] += 0.2
    found = mf.describe_profile(
        mf.Profile(0.1 * np.arange(first.size), np.stack([first, other, first, first], axis=1))
    )
    assert [path.number for path in found.paths] == [0, 1]
    assert found.findings[0] == "Paths 0, 2 and 3 are equal: path 0 is described for all."
    assert sum("stands out" in finding for finding in found.findings) == 1
    assert found.scope == "2 of 4 paths are described"


def test_the_page_is_complete_in_itself_and_always_the_same():
    road = mf.Profile(
        0.1 * np.arange(60_000), np.stack([noise(n, 60_000) for n in range(2)], axis=1), "a <road> & more",
        ("cropped",), (0.75, -0.75),
    )  # fmt: skip
    found = mf.describe_profile(road)
    page, again = (render(found, understood="so and so", title="road.csv") for _ in range(2))
    assert page == again
    assert not re.search(r'(src|href)="(?!#)|url\((?!#)|<script', page)
    for words in ("a &lt;road&gt; &amp; more", "cropped", "so and so", "0 at +0.75 m", "Coherence", "per 100 m"):
        assert words in page
    assert page.count("<svg") == 4
    assert len(page) < 2e6


def test_elevations_in_millimetres_are_rougher_than_roads_are():
    road = mf.realise(mf.IsoRoad.of_class("A"), length=200.0, seed=0)
    assert mf.describe_profile(road).findings == ()
    wrong = mf.describe_profile(mf.Profile(road.stations, 1e3 * road.elevation))
    assert any(re.match("Rougher than roads are, IRI .* are the elevations in metres?", f) for f in wrong.findings)
    roughest = mf.realise(mf.IsoRoad.of_class("G"), length=200.0, seed=0)
    assert not any("ougher" in finding for finding in mf.describe_profile(roughest).findings)


@needs("belgian_block.crg")
def test_ten_metres_have_no_class():
    block = mf.read_profile(DATA / "belgian_block.crg", across=[0.75]).profile
    found = mf.describe_profile(block)
    assert found.paths[0].fit.road_class == ""
    assert any(
        finding.startswith("No class: the profile is level or straight but for rounding")
        for finding in found.findings
    )
    assert as_dict(found)["paths"][0]["iso_8608_class"] is None
    render(found, understood="", title="x")


@needs("utia_profile.txt")
def test_a_surveyed_road():
    """Class A, whole-length IRI near 3.3, quantised to 0.1 mm: what is known of it."""
    for name, about in (("utia_profile.txt", 0.01), ("utia_profile_irregular.txt", 0.05)):
        (path,) = mf.describe_profile(mf.read_profile(DATA / name).profile).paths
        assert path.fit.road_class == "A"
        assert path.index == pytest.approx(3.335, rel=about)
        assert path.resolution == 1e-4


@needs("utia_profile.txt")
@pytest.mark.parametrize("step", [0.05, 0.1])
def test_a_surveyed_road_is_the_same_road_at_a_shorter_step(step):
    """A line through 40 bands that scatter by 0.4 in the logarithm, over a range of rms 1.2: w to 0.4/√40/1.2."""
    road = mf.read_profile(DATA / "utia_profile.txt").profile
    (before,), (after,) = (mf.describe_profile(p).paths for p in (road, mf.resampled(road, step=step)))
    assert before.fit.waviness == pytest.approx(2.7, abs=0.05)
    assert after.fit.road_class == "A"
    assert after.fit.waviness == pytest.approx(before.fit.waviness, abs=3 * 0.4 / np.sqrt(40) / 1.2)
    # Stations every 0.25 m end at 2 cycle/m; a cubic spline begins to lose at 0.4 of the inverse of its step.
    assert 0.25 * 4 < after.fit.band[1] < 2.0


@needs("IRI_737b.mat")
def test_a_published_rough_road():
    (path,) = mf.describe_profile(mf.read_profile(DATA / "IRI_737b.mat").profile).paths
    assert path.index == pytest.approx(7.177, rel=1e-3)


# The commands.


@pytest.fixture
def road(tmp_path):
    file = tmp_path / "road.csv"
    rows = zip(0.25 * np.arange(400), noise(0, 400), noise(1, 400), strict=True)
    file.write_text("x [m],left [m],right [m]\n" + "".join(f"{x},{a},{b}\n" for x, a, b in rows))
    return file


def test_profile_tells_and_writes(road, tmp_path, capsys):
    assert main(["profile", str(road), "--detrend", "1", "-o", str(tmp_path / "out")]) == 0
    told = capsys.readouterr().out
    for words in (
        "400 stations from 0 m to 99.75 m every 0.25 m",
        "- took out a polynomial",
        "per 20 m",
        "Findings",
    ):
        assert words in told
    assert sorted(file.name for file in (tmp_path / "out").iterdir()) == ["iri.csv", "profile.html", "profile.json"]
    content = json.loads((tmp_path / "out" / "profile.json").read_text())
    assert content["length_m"] == 99.75
    heads, *lines = csv.reader((tmp_path / "out" / "iri.csv").read_text().splitlines())
    assert heads == ["file", "segment [m]", "start [m]", "end [m]", "IRI of path 0 [mm/m]", "IRI of path 1 [mm/m]"]
    edges = ["0", "20", "40", "60", "80", "99.75"]
    assert [line[:4] for line in lines] == [["road.csv", "20", *pair] for pair in itertools.pairwise(edges)]
    both = [path["iri_per_20_m_mm_per_m"] for path in content["paths"]]
    assert [line[4:] for line in lines] == [[f"{x:.5g}" for x in pair] for pair in zip(*both, strict=True)]
    assert content["segments_m"] == {"20": [float(edge) for edge in edges]}
    assert len(content["paths"]) == 2
    assert len(content["paths"][0]["iri_per_20_m_mm_per_m"]) == 5
    assert content["steps"][0].startswith("took out a polynomial")
    assert content["source"] == "road.csv"


def test_profile_without_output_writes_nothing(road, tmp_path):
    assert main(["profile", str(road)]) == 0
    assert [file.name for file in tmp_path.iterdir()] == ["road.csv"]


def test_convert_there_and_back(road, tmp_path, capsys):
    files = [road, *(tmp_path / name for name in ("b.nc", "c.mat", "d.erd", "e.csv"))]
    for source, target in itertools.pairwise(files):
        assert main(["convert", str(source), str(target)]) == 0
    first, last = (mf.read_profile(file).profile for file in (files[0], files[-1]))
    assert np.array_equal(first.elevation, last.elevation)
    assert "wrote" in capsys.readouterr().out


def test_convert_prepares_on_request_and_protects_what_exists(road, tmp_path, capsys):
    target = tmp_path / "new" / "road.erd"
    words = ["convert", str(road), str(target), "--paths", "1,0", "--mirror-to", "300", "--encoding", "double"]
    assert main(words) == 0
    assert sorted(file.name for file in target.parent.iterdir()) == ["road.erd", "road.erd.bin"]
    assert "- mirrored forth and back 3.008 times to 300 m" in capsys.readouterr().out
    assert mf.read_profile(target).profile.stations[-1] == 300.0
    assert main(words) == 2
    assert "exists; choose another name, or --force" in capsys.readouterr().err
    assert main([*words, "--force"]) == 0


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["profile", "none.csv"], "No such file"),
        (
            ["profile", "{road}", "--across", "0.7,x"],
            "--across must be numbers with commas between them, got '0.7,x'",
        ),
        (["profile", "{road}", "--columns", "0,7"], "there is no column 7"),
        (["profile", "{road}", "--high-pass", "1000"], "--high-pass must lie between"),
        (["profile", "{road}", "--detrend", "1.5"], "--detrend must be a whole number, got 1.5"),
        (["profile", "{road}", "--detrend", "7"], "--detrend must be at most 5, got 7"),
        (["convert", "{road}", "{folder}/new/road.gpx"], "{folder}/new/road.gpx: gpx is only read, not written"),
        (["convert", "{road}", "{folder}/road.xyz"], "its ending does not tell the format"),
        (
            ["convert", "{road}", "{folder}/deep/road.crg"],
            "{folder}/deep/road.crg: an OpenCRG file needs the lateral positions of two paths",
        ),
    ],
)
def test_what_the_commands_refuse(road, tmp_path, capsys, words, message):
    before = sorted(tmp_path.rglob("*"))
    assert main([word.format(road=road, folder=tmp_path) for word in words]) == 2
    assert message.format(folder=tmp_path) in capsys.readouterr().err
    assert sorted(tmp_path.rglob("*")) == before


SCENARIO = """
[guideway]
kind = "rigid_guideway"
[vehicle]
kind = "quarter_car"
body_mass = 8900
wheel_mass = 1100
suspension_stiffness = 1e6
suspension_damping = 2e4
tyre_stiffness = 3.5e6
[roughness]
kind = "profile"
file = "road.csv"
{options}
[run]
speed = 10.0
duration = 15.0
"""


def test_a_scenario_reads_and_prepares_a_profile(road):
    file = road.with_suffix(".toml")
    file.write_text(SCENARIO.format(options="paths = [1]\nhigh_pass = 20.0\nmirror_to = 200.0"))
    made = mf.read_scenario(file).case.road
    by_hand = mf.mirrored(
        mf.high_passed(mf.selected(mf.read_profile(road).profile, paths=[1]), wavelength=20.0), length=200.0
    )
    assert np.array_equal(made.profile.elevation, by_hand.elevation)
    assert made.profile.steps == by_hand.steps
    assert all(step in made.description for step in by_hand.steps)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ("high_pass = 1e4", r"roughness.high_pass must lie between four steps and"),
        ("repair_gaps = -1", r"roughness.repair_gaps must be positive"),
        ("across = [0.7]", r"has no lateral positions"),
        ("columns = 3", r"roughness.columns must be a list"),
        ("hi_pass = 3", r"roughness.hi_pass is not known here \(did you mean 'high_pass'\?\)"),
        ("", r"must cover the journey from 0 m to 150 m, but it reaches from 0 m to 99.75 m"),
    ],
)
def test_what_a_scenario_refuses(road, options, message):
    file = road.with_suffix(".toml")
    file.write_text(SCENARIO.format(options=options))
    with pytest.raises(mf.ScenarioError, match=message):
        mf.read_scenario(file)

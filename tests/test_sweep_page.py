"""The page of a sweep: which figure it chooses, and that the numbers of its answers are right."""

from __future__ import annotations

import re
from glob import glob

import numpy as np
import pytest
import scipy.stats

import movingfrf as mf
from movingfrf.studies.sweep import words
from movingfrf.studies.sweep.page import curves, dots, maps, samples
from movingfrf.studies.sweep.page.answers import Axis, Stretch, beyond, share, where
from movingfrf.studies.sweep.page.axes import power_of
from movingfrf.studies.sweep.page.choice import DRAWN, layout
from movingfrf.studies.sweep.page.limits import Limit, limits_in
from movingfrf.studies.sweep.page.lines import lines_of
from movingfrf.studies.sweep.page.page import answers, render, views
from movingfrf.studies.sweep.page.reaches import reaches
from movingfrf.studies.sweep.page.seen import seen_of
from movingfrf.studies.sweep.page.shares import shares
from movingfrf.studies.sweep.page.tables import findings, tables
from movingfrf.studies.sweep.plan import plan_of
from movingfrf.studies.sweep.words import axes_in
from tests.sweep_parts import command, scenario_in, table_of

COEFFICIENT = "dynamic_load_coefficient"
SPEEDS = np.linspace(5.0, 35.0, 31)


def limited(value, place=""):
    return [Limit(COEFFICIENT, value, place)]


def the_view(table, limits=()):
    (view,) = views(table, limits)
    return view


def the_answer(table, limits=()):
    (answer,) = answers(table, limits)
    return answer.said


@pytest.mark.parametrize(
    ("sizes", "numeric", "kind", "along", "across", "others"),
    [
        ({"speed": 61}, {"speed"}, "curves", "speed", "", ()),
        ({"speed": 2}, {"speed"}, "curves", "speed", "", ()),
        ({"speed": 3, "stiffness": 9}, {"speed", "stiffness"}, "curves", "stiffness", "speed", ()),
        ({"speed": 5, "stiffness": 9}, {"speed", "stiffness"}, "map", "stiffness", "speed", ()),
        ({"speed": 5, "k": 9, "vehicle": 3}, {"speed", "k"}, "map", "k", "speed", ("vehicle",)),
        ({"vehicle": 3, "speed": 2}, {"speed"}, "curves", "speed", "vehicle", ()),
        ({"vehicle": 10, "speed": 3}, {"speed"}, "dots", "vehicle", "speed", ()),
        ({"roughness": 200, "vehicle": 3}, set(), "ranks", "roughness", "vehicle", ()),
        ({"roughness": 200, "speed": 30}, {"speed"}, "curves", "speed", "roughness", ()),
        ({"speed": 1, "roughness.seed": 9}, {"speed", "roughness.seed"}, "samples", "", "", ()),
        ({"speed": 1}, {"speed"}, "", "", "", ()),
    ],
)
def test_axes_choose_the_figure(sizes, numeric, kind, along, across, others):
    chosen = layout(sizes, numeric, design=False)
    assert (chosen.kind, chosen.along, chosen.across, chosen.others) == (kind, along, across, others)
    assert layout(sizes, numeric, design=True).kind == "samples"


def test_a_limit_is_crossed_where_the_line_between_values_crosses_it():
    """Against the roots of a polynomial: between values that lie 1e-4 apart a straight line is as good as it."""
    x = np.linspace(0.0, 3.0, 30_001)
    roots = np.sort(np.roots([1.0, -4.5, 5.5, -1.7]).real)
    values = x**3 - 4.5 * x**2 + 5.5 * x - 1.5
    for found in (beyond(x, values, 0.2, below=False), beyond(x, -values, -0.2, below=True)):
        assert np.ravel(found) == pytest.approx([*roots, 3.0], abs=1e-6)


def test_stretches_of_few_values():
    x = np.array([30.0, 10.0, 20.0, 40.0, 50.0])
    assert beyond(x, np.array([3.0, 1.0, 2.0, np.nan, 4.0]), 2.5, below=False) == [(25.0, 30.0), (50.0, 50.0)]
    assert beyond(x, np.array([3.0, 1.0, 2.0, 4.0, 5.0]), 9.0, below=False) == []
    # What touches a limit does not pass it.
    assert beyond(x[:2], np.array([2.0, 2.0]), 2.0, below=True) == []


def test_stretches_in_words():
    speed = Axis("speed", SPEEDS, "m/s")
    assert where([Stretch(21.34, 35.0)], speed) == "from 21.3 m/s on"
    assert where([Stretch(5.0, 7.0), Stretch(9.0, 12.25)], speed) == "up to 7 m/s and from 9 m/s to 12.2 m/s"
    assert where([Stretch(5.0, 35.0)], speed) == "everywhere"
    assert where([Stretch(8.0, 8.0)], speed._replace(unit="")) == "at speed 8"
    many = [Stretch(at, at + 0.5) for at in (6.0, 8.0, 10.0, 12.0)]
    assert where(many, speed) == "over 4 stretches, first from 6 m/s to 6.5 m/s"


def test_the_interval_of_a_share():
    """Against the roots of Wilson's equation, (p̂ − p)² = z² p (1 − p)/n."""
    z, n, part = scipy.stats.norm.ppf(0.975), 40, 6 / 40
    low, high = np.sort(np.roots([1 + z**2 / n, -2 * part - z**2 / n, part**2]))
    said = share(6, 40, "roads")
    assert said == f"6 of 40 roads, 15 % (95 % confidence: {100 * low:.1f} to {100 * high:.0f} %)"
    assert share(0, 40, "roads") == f"none of 40 roads (95 % confidence: less than {100 * z**2 / (n + z**2):.1f} %)"


def test_curves_of_each_contact():
    """Straight lines: the front one is 0.2 at 25 m/s, the rear one at 15 m/s."""
    table = table_of({"speed": SPEEDS}, front=0.008 * SPEEDS, rear=0.05 + 0.01 * SPEEDS)
    said = the_answer(table, limited(0.2))
    assert "exceeds 0.2 – front: from 25 m/s on; rear: from 15 m/s on." in said
    assert "Largest: 0.4000, at rear, speed 35 m/s." in said
    said = the_answer(table, limited(0.2, "front"))
    assert "exceeds 0.2 from 25 m/s on. Largest: 0.2800, at front" in said
    assert "does not exceed 0.5." in the_answer(table, limited(0.5))
    view = the_view(table, limited(0.201))
    assert "straight lines between solved cases" in curves.drawn(view)
    assert "straight lines" not in curves.drawn(the_view(table, limited(0.5)))


def test_curves_of_many_contacts_are_of_the_worst():
    contacts = {f"axle {number}": 0.01 * (number + 1) * SPEEDS for number in range(7)}
    view = the_view(table_of({"speed": SPEEDS}, **contacts))
    (line,) = lines_of(view)
    np.testing.assert_array_equal(line.values[:, 0], 0.07 * SPEEDS)
    assert "worst contact" in curves.drawn(view)


def test_curves_of_other_axes_and_the_worst_over_others():
    front = np.arange(24.0).reshape(4, 3, 2)
    axes = {"speed": [1.0, 2.0, 3.0, 4.0], "vehicle": ["a", "b", "c"], "road_class": ["A", "B"]}
    view = the_view(table_of(axes, front=front, rear=front - 1.0))
    assert [line.label for line in lines_of(view)] == ["vehicle a", "vehicle b", "vehicle c"]
    np.testing.assert_array_equal(np.stack([line.mean for line in lines_of(view)]), front[:, :, 1].T)
    assert "Of all values of road class the worst." in curves.drawn(view)
    assert "vehicle c: from 1.5 m/s on" in the_answer(view.table, limited(8.0))


def test_roads_are_a_spread():
    rng = np.random.default_rng(1)
    values = 0.01 * SPEEDS[:, None] + rng.normal(0.0, 0.02, (31, 40))
    table = table_of({"speed": SPEEDS, "seed": list(range(40))}, wheel=values)
    said = the_answer(table, limited(0.2))
    mean = values.mean(axis=1)
    at = SPEEDS[np.flatnonzero(mean > 0.2)[0] - 1 :][:2]
    (found,) = re.findall(r"in the mean over the roads (?:.*?)from ([\d.]+) m/s on", said)
    assert at[0] <= float(found) <= at[1]
    over = (values > 0.2).sum(axis=1)
    assert f"At speed {SPEEDS[over.argmax()]:g} m/s most roads do: {over.max()} of 40 roads" in said
    assert "Not a single road does." in the_answer(table, limited(2.0))


def test_a_map():
    """0.2 is passed along speed · stiffness = 80: at 20 m/s at the lower end, at 10 m/s at the upper one."""
    stiffness = np.linspace(4.0, 8.0, 9)
    values = np.multiply.outer(SPEEDS, stiffness) / 400
    table = table_of({"speed": SPEEDS, "stiffness": stiffness}, front=values, rear=0.5 * values)
    said = the_answer(table, limited(0.2))
    assert f"in {(values > 0.2).sum()} of {values.size} cases" in said
    assert "at stiffness 4 from 20 m/s on, at stiffness 8 from 10 m/s on." in said
    assert "Largest: 0.7000, at front, speed 35 m/s, stiffness 8." in said
    np.testing.assert_array_equal(maps.field(the_view(table)), values)
    values[20:, :3] = np.nan
    assert "Hatched" in maps.drawn(the_view(table_of({"speed": SPEEDS, "stiffness": stiffness}, front=values)))
    assert "<figure" in render(table_of({"speed": SPEEDS, "stiffness": stiffness}, front=values), "", "")
    assert "<figure" in render(table_of({"speed": SPEEDS, "stiffness": stiffness}, front=0.1), "", "")


def test_dots_and_ranks():
    table = table_of({"vehicle": ["a", "b", "c"]}, front=[0.1, 0.3, np.nan], rear=[0.15, 0.1, np.nan])
    said = the_answer(table, limited(0.12))
    assert "exceeds 0.12 for 2 of 3 values of vehicle: b, a. Largest: 0.3000, at front, vehicle b." in said
    roads = [f"profiles/{number:03d}.csv" for number in range(200)]
    values = np.stack([np.arange(200.0), np.arange(200.0)[::-1] * 0.5], axis=1)
    view = the_view(table_of({"roughness": roads, "vehicle": ["a", "b"]}, front=values), limited(90.0))
    assert view.layout.kind == "ranks"
    said = dots.answer(view)
    assert "exceeds 90 – vehicle a: 109 of 200 values of roughness; vehicle b: 19 of 200." in said
    assert "The worst: profiles/199.csv, profiles/198.csv, profiles/197.csv." in said
    assert "<figure" in render(view.table, "", "", limited(90.0))


def test_samples_of_a_design():
    plan = mf.design({"run.x": (-1.0, 1.0), "run.y": (-1.0, 1.0)}, samples=1024)
    x, y = plan.values.T
    values = x**2 + 0.1 * y  # variances 4/45 and 1/300: x alone 96.4 %, though no rank correlation sees it
    table = table_of({"x": x, "y": y}, design=plan.drawn, front=values)
    said = the_answer(table, limited(0.5))
    over = int((values > 0.5).sum())
    assert f"exceeds 0.5 for {over} of 1024 samples, {100 * over / 1024:.0f} %" in said
    low, middle, high = np.percentile(values, [5, 50, 95])
    (found,) = re.findall(r"lie below (\S+), (\S+) and (\S+)\.", said)
    assert [float(one.replace("−", "-")) for one in found] == pytest.approx([low, middle, high], rel=1e-3)
    first, second = samples.influences(the_view(table))
    assert first.key == "x"
    # Classes of finite width, and of 51 samples each.
    assert first.share == pytest.approx(4 / 45 / (4 / 45 + 1 / 300), abs=0.02)
    assert second.share == pytest.approx(1 / 300 / (4 / 45 + 1 / 300), abs=0.03)
    # Epsilon squared by the F of an analysis of variance, of 20 classes.
    by_class = np.array_split(values[np.argsort(x)], 20)
    ratio = scipy.stats.f_oneway(*by_class).statistic
    assert first.share == pytest.approx((ratio - 1) * 19 / (19 * ratio + 1024 - 20), rel=1e-9)
    assert samples.influences(the_view(table_of({"x": x, "y": y}, design=plan.drawn, front=3.0))) == []


def test_shares_of_a_saltelli_design_and_how_uncertain_they_are():
    """Of 3x + y² + 2xy: 3, 4/45 and 4/9; over forty seeds nineteen in twenty intervals hold the truth, or more."""
    whole = 3 + 4 / 45 + 4 / 9
    within = 0
    for seed in range(40):
        plan = mf.design({"run.x": (-1.0, 1.0), "run.y": (-1.0, 1.0)}, samples=128, kind="saltelli", seed=seed)
        x, y = plan.values.T
        table = table_of({"x": x, "y": y}, design=plan.drawn, front=3 * x + y**2 + 2 * x * y)
        (seen,) = seen_of(table)
        first, second = shares(table, seen)
        assert (first.key, second.key) == ("x", "y")
        within += abs(first.total - (3 + 4 / 9) / whole) <= first.total_off
        within += abs(second.total - (4 / 45 + 4 / 9) / whole) <= second.total_off
        assert first.total_off < 0.5
    assert within >= 0.9 * 80
    # Shares of samples are of those that were drawn independently: the first two in four.
    over = int((seen.worst[:256] > 1.0).sum())
    assert f"for {over} of 256 samples" in the_answer(table, limited(1.0))
    page = render(table, "", "")
    assert "What is the scatter of each measure due to?" in page
    assert f"{100 * first.total:.0f} ± {100 * first.total_off:.0f} %" in page
    table[COEFFICIENT].values[3] = np.nan
    table.status.values[3] = "unstable"
    assert "needs an answer of every case" in " ".join(findings(table))
    assert "What is the scatter" not in render(table, "", "")


def test_how_far_axes_move_a_measure():
    """What is missing moves nothing: means are taken of whole lines alone."""
    values = np.add.outer(np.array([0.0, 1.0, 5.0]), np.array([0.0, 2.0]))
    table = table_of({"speed": [1.0, 2.0, 3.0], "vehicle": ["a", "b"]}, front=values)
    (seen,) = seen_of(table)
    first, second = reaches(table, seen)
    assert (first, second) == (("speed", 1.0, 6.0), ("vehicle", 2.0, 4.0))
    assert "What matters most – dynamic load coefficient: speed, 1.000 to 6.000." in render(table, "", "")
    values[2, 1] = np.nan
    table = table_of({"speed": [1.0, 2.0, 3.0], "vehicle": ["a", "b"]}, front=values)
    (seen,) = seen_of(table)
    assert reaches(table, seen) == [("speed", 0.0, 5.0), ("vehicle", 0.5, 2.5)]


def test_contact_and_comfort_have_limits_of_their_own():
    table = table_of({"speed": SPEEDS}, measure="smallest_contact_force", front=2e4 - 1e3 * SPEEDS, rear=5e3)
    said = the_answer(table)
    assert "falls below 0 kN (contact is lost) – front: from 20 m/s on; nowhere else." in said
    assert "Smallest: −15.00 kN, at front, speed 35 m/s." in said
    felt = {"bounce": 0.0315 * SPEEDS, "pitch": 1e-3, "wheel": 5.0}
    table = table_of({"speed": SPEEDS}, measure="weighted_acceleration_rms", **felt)
    said = the_answer(table)
    assert "exceeds 0.315 m/s² (more than “not uncomfortable” in ISO 2631-1) from 10 m/s on." in said
    assert "Largest: 1.103 m/s², “uncomfortable” in ISO 2631-1, at bounce" in said
    said = the_answer(table, [Limit("weighted_acceleration_rms", 4.0, "wheel")])
    assert "exceeds 4 m/s² everywhere" in said
    said = the_answer(table, [Limit("weighted_acceleration_rms", 10.0, "pitch")])
    assert "does not exceed 10 rad/s²" in said


def test_limits_are_in_the_unit_of_the_table():
    table = table_of({"speed": SPEEDS}, measure="contact_force_peak", front=1e3 * SPEEDS)
    said = the_answer(table, [Limit("contact_force_peak", 2e4)])
    assert said.startswith("The contact force peak exceeds 20 kN from 20 m/s on.")


def test_one_case_and_none():
    said = the_answer(table_of({"speed": [9.0]}, front=[0.3], rear=[0.1]), limited(0.2))
    assert said == "The dynamic load coefficient exceeds 0.2. Largest: 0.3000, at front."
    table = table_of({"speed": SPEEDS}, front=np.nan, rear=np.nan)
    assert answers(table) == tables(table) == []
    page = render(table, "", "")
    assert "None of them has an answer." in page
    assert "<figure" not in page
    assert "The worst cases" not in page


def test_powers_of_ten_of_an_axis():
    assert [power_of(np.array([one])) for one in (0.0, 35.0, 9999.0, 2e4, 3.74e6, 0.005, -1e6)] == [
        0, 0, 0, 3, 6, -3, 6,
    ]  # fmt: skip


@pytest.mark.parametrize("kind", ["one axis", "map", "roads", "ranks", "saltelli"])
def test_pages_of_a_hundred_thousand_cases_are_bounded(kind):
    """Some 2 s and 1 MB each at most; noise from case to case takes most."""
    rng = np.random.default_rng(0)
    axes, design = {
        "one axis": ({"speed": np.linspace(5, 35, 100_000)}, None),
        "map": ({"speed": np.linspace(5, 35, 400), "stiffness": np.linspace(1, 2, 250)}, None),
        "roads": ({"speed": np.linspace(5, 35, 1000), "seed": list(range(100))}, None),
        "ranks": ({"roughness": [f"{n}.csv" for n in range(5000)], "vehicle": list("abcdefghijklmnopqrst")}, None),
        "saltelli": (
            {"x": rng.random(65536), "y": rng.random(65536)},
            {"kind": "saltelli", "samples": 16384, "seed": 0, "paths": ["run.x", "run.y"]},
        ),
    }[kind]
    shape = [65536] if design else [len(each) for each in axes.values()]
    table = table_of(axes, design=design, front=rng.random(shape), rear=rng.random(shape))
    page = render(table, "", "", limited(0.5))
    assert 5e3 < len(page) < 1e6
    (caption,) = re.findall(r"Figure 1.</b> (.*?)</figcaption>", page, re.DOTALL)
    assert len(caption) < 1000
    assert DRAWN.samples <= 1000


# Limits and patterns as they are written in a line.


@pytest.fixture
def truck(tmp_path):
    return scenario_in(tmp_path)


def test_limits_in_a_line(truck):
    plan = plan_of(truck, {"run.speed": [9.0, 10.0], "vehicle": ["half_truck", "golden_car", "none"]})
    assert limits_in(["dynamic_load_coefficient=0.2", "contact_force_peak.rear = 8e4"], plan) == [
        (COEFFICIENT, 0.2, "", ""),
        ("contact_force_peak", 8e4, "rear", ""),
    ]
    assert limits_in(["contact_force_peak.wheel=1"], plan)[0].place == "wheel"
    assert limits_in(["weighted_acceleration_rms.BOUNCE=1", "contact_force_peak.1=1"], plan)[1].place == "rear"
    for line, why in (
        ("dynamic_load_coefficient", "must be MEASURE=VALUE"),
        ("=3", "must be MEASURE=VALUE"),
        ("dynamic_load=0.2", r"did you mean|must be one of static_load"),
        ("contact_force_peak=soft", r"must be a number \[N\], got soft"),
        ("contact_force_peak=inf", r"must be a number \[N\]"),
        ("contact_force_peak.reer=1", r"the contact must be among .*rear.* \(did you mean 'rear'\?\)"),
        ("weighted_acceleration_rms.seat=1", "the dof must be among"),
    ):
        with pytest.raises(ValueError, match=why) as refused:
            limits_in([line], plan)
        assert f"--limit {line}" in str(refused.value)
    with pytest.raises(ValueError, match="is limited twice"):
        limits_in(["contact_force_peak=1", "contact_force_peak=2"], plan)


def test_files_that_match(tmp_path, monkeypatch):
    # However the system lists them.
    monkeypatch.setattr(words, "glob", lambda *given, **how: sorted(glob(*given, **how), reverse=True))
    for name in ("b.csv", "a.csv", "c.txt", "more/d.csv"):
        (tmp_path / "p" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "p" / name).touch()
    (tmp_path / "p" / "folder.csv").mkdir()
    assert axes_in(["roughness=p/*.csv"], tmp_path) == {"roughness": ["p/a.csv", "p/b.csv"]}
    assert axes_in(["roughness.file=p/c.txt,p/[ab].csv"], tmp_path) == {
        "roughness.file": ["p/c.txt", "p/a.csv", "p/b.csv"]
    }
    assert axes_in(["roughness=p/**/*.csv"], tmp_path) == {"roughness": ["p/a.csv", "p/b.csv", "p/more/d.csv"]}
    assert axes_in(["roughness,run.start=p/?.csv;0,1"], tmp_path) == {
        ("roughness", "run.start"): [("p/a.csv", 0), ("p/b.csv", 1)]
    }
    assert axes_in(["roughness=p/none.csv"], tmp_path) == {"roughness": ["p/none.csv"]}
    with pytest.raises(ValueError, match=re.escape(f"no file matches p/*.erd in {tmp_path}")):
        axes_in(["roughness=p/*.erd"], tmp_path)


def test_the_command_with_limits(truck):
    """The page and the console say the number; another limit solves nothing again."""
    out = truck.parent / "limited"
    over = ["sweep", truck, "--over", "run.speed=8,10,12", "-o", out]
    done = command(*over, "--limit", "dynamic_load_coefficient.front=0.01")
    assert done.returncode == 0, done.stderr
    said = "The dynamic load coefficient exceeds 0.01 everywhere."
    assert said in " ".join(done.stdout.split())
    assert said in (out / "report.html").read_text(encoding="utf-8")
    before = {file: file.stat().st_mtime_ns for file in (out / "chunks").iterdir()}
    again = command(*over, "--limit", "dynamic_load_coefficient=0.9")
    assert again.returncode == 0, again.stderr
    assert "does not exceed 0.9" in " ".join(again.stdout.split())
    assert {file: file.stat().st_mtime_ns for file in (out / "chunks").iterdir()} == before
    refused = command(*over[:-1], truck.parent / "none", "--limit", "dynamic_load_coefficient.side=0.9")
    assert refused.returncode == 2
    assert "the contact must be among" in " ".join(refused.stderr.split())
    assert not (truck.parent / "none").exists()

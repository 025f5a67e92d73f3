"""The report: complete, self-contained, repeatable, and of bounded size."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest

import movingfrf as mf
from movingfrf._basics.wording import number
from movingfrf.metrics.measures import measures
from movingfrf.reports.coupled import _contact_offsets, _neighbours, of_coupled
from movingfrf.reports.frf import _frf_end
from movingfrf.reports.result import render

ROAD = mf.track(mf.EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9), mf.Spring(stiffness=8e6, damping=3e4))
CAR = mf.quarter_car(
    body_mass=400.0,
    wheel_mass=40.0,
    suspension_stiffness=2e4,
    suspension_damping=1.5e3,
    tyre_stiffness=2e5,
)


def three_wheels():
    """Make a rigid body on three springs."""
    positions = np.array([2.0, 0.5, -2.5])
    return mf.Vehicle(
        mass=np.diag([3000.0, 9000.0]),
        damping=np.zeros((2, 2)),
        stiffness=np.zeros((2, 2)),
        contact_map=np.stack([np.ones(3), positions], axis=1),
        contacts=tuple(mf.Contact(position=x, stiffness=3e5, damping=6e3) for x in positions),
        vertical=(1.0, 0.0),
        dof_names=("bounce", "pitch"),
    )


def drive(vehicle=CAR, *, rough=True, speed=15.0, duration=4.0):
    length = speed * duration + 10.0
    if rough:
        spectrum = mf.IsoRoad.of_class("B", band=(0.01, 3.0))
        profile = mf.realise(spectrum, length=length, step=0.05, seed=0, start=-4.0)
    else:
        distance = np.arange(-4.0, length, 0.5)
        profile = mf.Profile(distance, np.zeros_like(distance))
    return mf.simulate(ROAD, vehicle, profile, speed=speed, duration=duration, truncation=60.0)


def with_findings(result, *messages):
    found = [{"code": "test", "message": message} for message in messages]
    return result.assign_attrs(findings=json.dumps(found))


@pytest.fixture(scope="module")
def three():
    return drive(three_wheels())


@pytest.fixture(scope="module")
def page(three):
    result = with_findings(three, "the wheel <i>hops</i>")
    return render(result, guideway=ROAD, scenario_text="[run]\nspeed = 15.0 # <b> & </b>", title="Trial & error")


def assert_self_contained(page):
    names = {"http://www.w3.org/2000/svg", "http://www.w3.org/1999/xlink"}
    assert set(re.findall(r"https?://[^\s\"'<>)]+", page)) <= names
    # A namespace is a name: it stands in xmlns only.
    assert "http" not in re.sub(r'xmlns(:\w+)?="[^"]*"', "", page).replace("http-equiv", "")
    assert not re.search(r"<script|<link|<img|<iframe|@import|\bsrc=", page)
    assert all(target.startswith("#") for target in re.findall(r"url\(([^)]*)\)", page))
    assert all(target.startswith("#") for target in re.findall(r'href="([^"]*)"', page))


def assert_ids_unique_and_defined(page):
    ids = re.findall(r'\sid="([^"]+)"', page)
    assert len(ids) == len(set(ids))
    used = set(re.findall(r'href="#([^"]+)"', page)) | set(re.findall(r"url\(#([^)]+)\)", page))
    assert used <= set(ids)


def cells(page):
    """Numbers of every table row by its name: units dropped."""
    rows = {}
    for name, body in re.findall(r'<th scope="row">(.*?)</th>(.*?)</tr>', page, re.DOTALL):
        text = re.sub(r"<[^>]*>", "", name).split(" at ")[0]
        rows.setdefault(text, []).extend(value.split(" ")[0] for value in re.findall(r"<td>(.*?)</td>", body))
    return rows


def test_self_contained(page):
    assert_self_contained(page)
    assert_ids_unique_and_defined(page)
    assert "nan" not in re.sub(r"<style>.*?</style>", "", page, flags=re.DOTALL).lower().split()


def test_every_measure_appears_in_engineering_units(three, page):
    rows = cells(page)
    for measure in measures(three):
        scale = {"N": 1e-3, "m": 1e3}.get(measure.units, 1.0)
        place = measure.quantity.rsplit(" ", 1)[0]
        shown = [float(value.replace("−", "-")) for value in rows[place] if "×" not in value]
        assert np.isclose(shown, scale * measure.value, rtol=6e-4, atol=0.0).any(), measure


def test_tables_are_narrow_and_their_columns_have_one_unit(page):
    """Five numbers beside a name fit on a sheet and into a window of 1100 px."""
    tables = re.findall(r"<table>(.*?)</table>", page, re.DOTALL)
    assert len(tables) == 4  # forces, deflections, accelerations, angular accelerations
    assert all(table.count('scope="col"') <= 6 for table in tables)
    assert not re.search(r"<td>[^<]* (m|rad)/s²</td>", page)
    assert "rad/s²" in tables[3]
    assert "rad" not in tables[2]


def test_nearby_offsets_and_neighbours(three):
    """Wheels at 2, 0.5 and −2.5 m: 1.5 m, and 3 m as the least that is twice as long."""
    assert _contact_offsets(three) == [0.0, 1.5, -1.5, 3.0, -3.0]
    assert _neighbours(three, 0) == [0, 1]
    assert _neighbours(three, 2) == [1, 2]
    assert _contact_offsets(drive(duration=0.1)) == [0.0]


def test_the_moving_frf_is_drawn_as_far_as_the_road_moves():
    """Not to a truncation far beyond: a footprint takes short waves away, and the soft road the rest."""
    frequency = np.linspace(0.0, 500.0, 501)

    def frf(_frequency, offsets):
        return np.ones((len(_frequency), len(offsets)), complex)

    result = drive(duration=2.0).assign_attrs(truncation=400.0)
    time = result.time.values
    result.deflection[:] = np.sin(2 * np.pi * 50.0 * time)[:, None]
    assert _frf_end(result, frf) == pytest.approx(1.3 * 50.0, rel=0.1)
    assert _frf_end(result.assign_attrs(truncation=35.0), frf) == pytest.approx(1.3 * 35.0)
    result.deflection[:] = 1e-3
    assert _frf_end(result, frf) == frequency[-1]


def test_text_is_escaped(page):
    assert "# &lt;b&gt; &amp; &lt;/b&gt;" in page
    assert "The wheel &lt;i&gt;hops&lt;/i&gt;." in page
    assert "<h1>Trial &amp; error</h1>" in page
    assert "No findings" not in page


def test_head_states_the_settings(page):
    text = re.sub(r"<[^>]*>", " ", page)
    for stated in ("15 m/s", "54 km/h", "60 m", "1 ms", "60 Hz", "177.5 m/s", mf.__version__):
        assert stated in text


def test_every_figure_has_a_caption_and_is_drawn(page):
    assert page.count("<figure>") == page.count("<figcaption>") == page.count("<svg ") == 7
    assert page.count('role="img"') == 7
    for words in ("Moving FRFs", "Contact forces", "ISO 8608", "Deflections", "Accelerations"):
        assert words in page


def test_equal_input_gives_equal_text_whatever_matplotlib_is_set_to():
    import matplotlib

    result = drive(duration=0.5)
    before = render(result, guideway=ROAD)
    with matplotlib.rc_context({"font.size": 30.0, "lines.linewidth": 9.0}):
        again = render(result, guideway=ROAD)
        assert matplotlib.rcParams["font.size"] == 30.0
    assert before == again
    assert "No findings" in before
    assert_self_contained(before)


def on_track(spectrum, step):
    profile = mf.realise(spectrum, length=410.0, step=step, seed=0)
    return mf.simulate(mf.RigidGuideway(), CAR, profile, speed=40.0, duration=10.0, time_step=5e-3)


def test_roughness_is_fitted_where_it_has_content():
    """Track whose waves end at 3 m, which a fit to 2.83 cycle/m takes for a waviness beyond 10."""
    result = on_track(mf.GermanTrack.of_class("low"), 0.05)
    figures = of_coupled(result, mf.RigidGuideway())
    fitted = re.search(r"dashed, over 0.0\d+ to (0.\d+) cycle/m\)", figures[0].caption)
    assert 0.2 < float(fitted[1]) < 0.34
    assert figures[0].heading == "Roughness"
    known = of_coupled(result.assign_attrs(spectrum="German track"), mf.RigidGuideway())
    assert "It was made from a spectrum, so none is fitted: German track." in known[0].caption
    assert "class A" not in known[0].caption


def test_flat_road_and_a_record_of_two_samples():
    result = drive(rough=False, duration=2e-3)
    page = render(result, guideway=mf.RigidGuideway())
    assert "next to flat, or the record too short for a spectrum, so none is drawn" in page
    assert "The road is rigid" in page
    assert_ids_unique_and_defined(page)


def test_moving_loads():
    time = np.arange(3000) * 1e-3
    force = np.stack([np.full(time.size, 1e5), 2e4 * np.sin(2 * np.pi * 8 * time)], axis=1)
    result = mf.moving_loads(ROAD, force, [0.0, -3.0], speed=30.0, observe=[0.0, -3.0, 2.0])
    page = render(result, guideway=ROAD)
    assert_self_contained(page)
    assert_ids_unique_and_defined(page)
    assert page.count("<svg ") == 4
    rows = re.findall(r"point at [^<]*</th><td>([^<]*)</td>", page)
    assert rows == [number(1e3 * largest) for largest in result.deflection.values.max(axis=0)]


def test_long_record_stays_small():
    result = drive(duration=0.5)
    long = result.isel(time=np.resize(np.arange(500), 400_000)).assign_coords(time=np.arange(400_000) * 1e-3)
    noise = np.random.default_rng(0).standard_normal(400_000)
    for name in ("contact_force", "deflection", "acceleration", "roughness"):
        long[name] = long[name] + noise[:, None] * float(np.abs(long[name]).max())
    assert len(render(long, guideway=ROAD).encode()) < 2_000_000


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (98399.5, "98400"),
        (-0.0810412, "−0.08104"),
        (1e6, "1.000 × 10⁶"),
        (9.9999, "10.00"),
        (-2e-9, "−2.000 × 10⁻⁹"),
    ],
)
def test_numbers_read_well(value, text):
    assert number(value) == text


@pytest.mark.parametrize("time_step", [1e-3, 2e-2])
def test_a_truncation_that_was_not_stated_is_none(time_step):
    """Whether the solution takes longer steps than the record or shorter ones."""
    time = time_step * np.arange(round(2.0 / time_step))
    force = 1e5 * np.sin(np.pi * time / 2.0)[:, None] ** 2
    result = mf.moving_loads(ROAD, force, [0.0], speed=10.0, time_step=time_step)
    assert "every frequency of the record is kept" in render(result, guideway=ROAD)


def test_a_distance_has_the_digits_that_check_shows(tmp_path):
    road = mf.harmonic(amplitude=1e-3, wavelength=5.0, length=40.0, start=-5.0)
    car = mf.catalogue("golden_car")
    result = mf.simulate(mf.RigidGuideway(), car, road, speed=80 / 3.6, duration=1.0)
    page = render(result, guideway=mf.RigidGuideway())
    assert ">22.2222 m<" in page

"""Figures of pages: drawn once, without mathematics, and with room for all that stands around their axes."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import movingfrf as mf
from movingfrf.metrics.profile import describe_profile
from movingfrf.reports import figures
from movingfrf.reports.figures import drawn_svg
from movingfrf.reports.profile import render as profile_page
from movingfrf.reports.random import render as random_page
from movingfrf.reports.result import render
from movingfrf.studies.sweep.page.limits import Limit
from movingfrf.studies.sweep.page.page import render as sweep_render
from tests.sweep_parts import table_of

ROAD = mf.track(mf.EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9), mf.Spring(stiffness=8e6, damping=3e4))
SPECTRUM = mf.IsoRoad.of_class("B", band=(0.01, 3.0))


def vehicle_page():
    truck = mf.catalogue(name="half_truck")
    road = mf.realise(SPECTRUM, length=80.0, start=-5.0)
    return render(mf.simulate(ROAD, truck, road, speed=15.0, duration=4.0), guideway=ROAD)


def smooth_page():
    car = mf.catalogue(name="passenger_car")
    road = mf.Profile([-5.0, 0.0, 40.0, 80.0], [0.0, 0.0, 0.0, 0.0])
    return render(mf.simulate(mf.RigidGuideway(), car, road, speed=15.0, duration=2.0), guideway=mf.RigidGuideway())


def coach_page():
    road = mf.realise(mf.GermanTrack.of_class("low", band=(0.0125, 1.25)), length=120.0, start=-50.0)
    return render(
        mf.simulate(ROAD, mf.catalogue(name="manchester_coach"), road, speed=30.0, duration=1.0), guideway=ROAD
    )


def loads_page():
    forces = [[1e5, 2e4]] * 500
    return render(mf.moving_loads(ROAD, forces, [0.0, -12.345], speed=20.0, time_step=2e-3), guideway=ROAD)


def random_road_page():
    result = mf.random_response(ROAD, mf.catalogue(name="half_truck"), SPECTRUM, speed=15.0)
    return random_page(result, [], title="a", scenario="", drawn=result)


def measured_page():
    road = mf.realise(SPECTRUM, length=120.0, step=0.1, seed=(0, 1))
    return profile_page(describe_profile(road), understood="", title="a")


def sweep_page(**axes):
    shape = [len(each) for each in axes.values()]
    values = np.random.default_rng(0).random(shape)
    limits = [Limit("dynamic_load_coefficient", 0.5)]
    return sweep_render(table_of(axes, front=values, rear=0.5 * values), "a", "", limits)


def sweep_curves_page():
    return sweep_page(speed=np.linspace(5.0, 35.0, 9), vehicle=["half_truck", "golden_car", "tractor_semitrailer"])


def sweep_map_page():
    return sweep_page(speed=np.linspace(5.0, 35.0, 9), tyre_stiffness=np.linspace(3e6, 4e6, 6))


def sweep_dots_page():
    return sweep_page(vehicle=["half_truck", "profiles/of/the/whole/network/road_0001.csv"], seed=list(range(5)))


def sweep_design_page():
    plan = mf.design({f"run.{key}": (3e6, 4e6) for key in "abc"}, samples=16, kind="saltelli")
    keys = dict(zip(("tyre_stiffness", "suspension_damping", "speed"), plan.values.T, strict=True))
    drawn = plan.drawn | {"paths": [f"run.{key}" for key in keys]}
    table = table_of(keys, design=drawn, front=plan.values @ [1e-8, 2e-8, 3e-8])
    return sweep_render(table, "a", "", [Limit("dynamic_load_coefficient", 0.2)])


PAGES = [
    vehicle_page,
    smooth_page,
    coach_page,
    loads_page,
    random_road_page,
    measured_page,
    sweep_curves_page,
    sweep_map_page,
    sweep_dots_page,
    sweep_design_page,
]


@pytest.fixture
def seen(monkeypatch):
    """Look at every figure of a page before it is drawn."""
    kept: list[Figure] = []

    def keep(figure, key):
        kept.append(figure)
        return drawn_svg(figure, key)

    monkeypatch.setattr(figures, "drawn_svg", keep)
    return kept


@pytest.mark.parametrize("page", PAGES)
def test_nothing_runs_into_anything(page, seen):
    """Measured by matplotlib, letter by letter, in the letters that it would draw itself."""
    page()
    assert seen
    for figure in seen:
        renderer = FigureCanvasAgg(figure).get_renderer()
        width, height = figure.bbox.width, figure.bbox.height
        boxes = [ax.get_tightbbox(renderer) for ax in figure.axes]
        for box in boxes:
            assert box.x0 >= 0.0
            assert box.y0 >= 0.0
            assert box.x1 <= width
            assert box.y1 <= height
        for number, one in enumerate(boxes):
            for other in boxes[number + 1 :]:
                assert one.x1 <= other.x0 or other.x1 <= one.x0 or one.y1 <= other.y0 or other.y1 <= one.y0
        for ax in figure.axes:
            named = [
                axis.label.get_window_extent(renderer) for axis in (ax.xaxis, ax.yaxis) if axis.label.get_text()
            ]
            ticks = [
                label.get_window_extent(renderer)
                for axis in (ax.xaxis, ax.yaxis)
                for label in axis.get_ticklabels()
                if label.get_visible() and label.get_text()
            ]
            assert not any(name.overlaps(tick) for name in named for tick in ticks)
        # And hardly any room is wasted: against what matplotlib finds, which measures everything.
        ours = sum(ax.bbox.width * ax.bbox.height for ax in figure.axes)
        figure.set_layout_engine("constrained")
        figure.draw_without_rendering()
        assert ours > 0.85 * sum(ax.bbox.width * ax.bbox.height for ax in figure.axes)


@pytest.mark.parametrize("page", PAGES)
def test_figures_are_drawn_once_and_without_mathematics(page, seen, monkeypatch):
    drawn = []
    draw = Figure.draw
    monkeypatch.setattr(Figure, "draw", lambda figure, renderer: drawn.append(figure) or draw(figure, renderer))

    def refuse(*_):
        raise AssertionError("mathematics is set")

    monkeypatch.setattr("matplotlib.mathtext.MathTextParser.parse", refuse)
    text = page()
    assert len(drawn) == len(seen) == text.count("<svg ")

"""A guideway of one's own: the page that shows one, the helper that it is made with, and who takes it."""

from __future__ import annotations

import ast
import doctest
import re
from copy import copy
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import movingfrf as mf
from movingfrf._basics.compiling import compiling
from movingfrf.reports.frf import frf_figures
from tests.helpers import DAMPED, VEHICLES, written_on

PAGE = Path(__file__).parents[1] / "docs" / "guideways.md"
TRACK = DAMPED["euler_bernoulli_winkler"]


class Own:
    """A track that nobody recognises: no base, no dataclass, no representation of its own."""

    critical_speed = TRACK.critical_speed

    def moving_frf(self, ahead, speed, omega, *, across=0.0, source_across=0.0, derivative=0):
        return TRACK.moving_frf(
            ahead, speed, omega, across=across, source_across=source_across, derivative=derivative
        )


def test_the_page_runs():
    names = written_on("guideways")
    found = doctest.testfile(str(PAGE), module_relative=False, globs=names)
    assert found.attempted > 5
    assert found.failed == 0


def test_twenty_lines_are_twenty_lines():
    (code,) = re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    (own,) = [node for node in ast.parse(code).body if isinstance(node, ast.ClassDef)]
    lines = code.splitlines()[own.decorator_list[0].lineno - 1 : own.end_lineno]
    assert len([line for line in lines if line.strip()]) <= 20


SURFACE = mf.harmonic(amplitude=1e-3, wavelength=3.0, length=60.0, start=-20.0)
SPECTRUM = mf.IsoRoad.of_class("A")

CALLS = {
    "simulate": lambda road: mf.simulate(road, VEHICLES["half_truck"], SURFACE, speed=10.0, duration=1.0),
    "transfer": lambda road: mf.transfer(road, VEHICLES["half_truck"], speed=10.0, frequency=[1.0, 10.0]),
    "random_response": lambda road: mf.random_response(road, VEHICLES["quarter_truck"], SPECTRUM, speed=10.0),
    "moving_loads": lambda road: mf.moving_loads(road, np.full((200, 1), 1e5), [0.0], speed=10.0),
    "receptance": lambda road: mf.receptance(road, [1.0, 10.0], ahead=[0.0, 1.0]),
}


@pytest.mark.parametrize("call", CALLS)
@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_calls_take_anything_that_keeps_the_contract(call, monkeypatch):
    # In NumPy: compiled, a track and a vehicle are answered in one loop, and rounding differs. Vehicles that know
    # this track know it compiled.
    monkeypatch.setattr("tests.test_own_guideway.VEHICLES", {name: copy(one) for name, one in VEHICLES.items()})
    with compiling(False):
        own, known = (CALLS[call](road) for road in (Own(), TRACK))
    assert own.attrs.pop("guideway") == "Own"
    assert known.attrs.pop("guideway") == repr(TRACK)
    assert own.identical(known)
    for name, values in CALLS[call](Own()).data_vars.items():
        xr.testing.assert_allclose(values, known[name], rtol=1e-9, atol=1e-9 * float(abs(known[name]).max()))


def test_a_report_draws_it():
    result = CALLS["simulate"](Own())
    own, known = (frf_figures(result, road, [0.0, 4.0]) for road in (Own(), TRACK))
    assert own == known != []


@pytest.mark.parametrize("call", [name for name in CALLS if name != "receptance"])
def test_what_has_no_critical_speed_is_refused(call):
    class Half:
        moving_frf = Own.moving_frf

    with pytest.raises(ValueError, match=r"guideway must have a critical_speed .*, got a Half without"):
        CALLS[call](Half())


# What a function of distinct offsets was asked, and an answer that names the offset.
def remembering(asked_for):
    def frf(asked):
        asked_for.append(asked)
        return asked.ahead + 10 * asked.across + 100 * asked.source_across + 1e-3 * asked.omega

    return frf


AHEAD = np.array([[0.0, 2.0, -1.0], [2.0, 2.0, 0.0]])


def test_offsets_are_asked_for_once_and_come_back_in_their_shape():
    asked_for = []
    found = mf.at_offsets(remembering(asked_for), AHEAD, 7, [1.0, 2.0], across=[[0.5], [0.0]], source_across=3.0)
    (asked,) = asked_for
    assert asked.ahead.ravel().tolist() == [-1.0, 0.0, 2.0]
    assert asked.ahead.shape == asked.across.shape == asked.source_across.shape == (3, 1)
    assert not asked.across.any()
    assert not asked.source_across.any()
    assert (asked.speed, asked.derivative) == (7.0, 0)
    assert asked.omega.tolist() == [1.0, 2.0]
    np.testing.assert_allclose(found, [AHEAD + 1e-3, AHEAD + 2e-3])


def test_places_across_are_handed_over_where_they_matter():
    asked_for = []
    across, source = [[0.5], [0.0]], [3.0, 3.0, -3.0]
    found = mf.at_offsets(remembering(asked_for), AHEAD, 7.0, [1.0], across=across, source_across=source, wide=True)
    (asked,) = asked_for
    assert asked.ahead.shape == (5, 1)  # of six places two are one
    np.testing.assert_allclose(found[0], AHEAD + 10 * np.array(across) + 100 * np.array(source) + 1e-3)


def test_one_number_is_broadcast_and_one_offset_has_no_axis():
    assert mf.at_offsets(lambda _: 0.0, AHEAD, 7.0, [1.0, 2.0]).shape == (2, 2, 3)
    found = mf.at_offsets(lambda asked: 1 / (1 + 1j * asked.omega[None]), 0.0, 7.0, [0.0, 1.0])
    np.testing.assert_allclose(found, [1.0, 0.5 - 0.5j])
    assert mf.at_offsets(lambda asked: asked.ahead, [], 7.0, [0.0, 1.0]).shape == (2, 0)
    assert mf.at_offsets(lambda asked: asked.ahead, [1.0], 7.0, []).shape == (0, 1)


@pytest.mark.parametrize("shape", [(3,), (1,), (3, 2), (2, 3), (3, 3, 1)])
def test_another_shape_is_refused_even_where_counts_agree(shape):
    with pytest.raises(ValueError, match=r"frf must return one number .* \(offset, frequency\), .* here \(3, 3\)"):
        mf.at_offsets(lambda _: np.zeros(shape), [0.0, 1.0, 2.0], 7.0, [0.0, 1.0, 2.0])


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"ahead": [0.0, np.nan]}, "ahead must be finite"),
        ({"across": ["left"]}, r"across must be an array of numbers \[m\]"),
        ({"source_across": [np.inf]}, "source_across must be finite"),
        ({"speed": "fast"}, r"speed must be a finite number \[m/s\]"),
        ({"omega": [1.0 + 1.0j]}, "omega must be finite, one-dimensional and have Im ω ≤ 0"),
        ({"omega": [[1.0]]}, "omega must be finite, one-dimensional"),
        ({"derivative": -1}, "derivative must be a whole number of at least 0"),
        ({"derivative": 1}, "derivative must be 0: this guideway knows deflections only, got 1"),
        ({"derivative": 3, "known_derivatives": 2}, "derivative must be at most 2, got 3"),
        ({"ahead": np.zeros(2), "across": np.zeros(3)}, "shape mismatch"),
    ],
)
def test_what_is_refused(given, message):
    arguments = {"ahead": [0.0], "speed": 10.0, "omega": [1.0]} | given
    with pytest.raises(ValueError, match=message):
        mf.at_offsets(lambda _: 0.0, **arguments)


def test_derivatives_that_are_known_are_asked_for():
    for known in (2, None):
        assert (
            mf.at_offsets(lambda asked: asked.derivative, 0.0, 0.0, [1.0], derivative=2, known_derivatives=known)
            == 2
        )

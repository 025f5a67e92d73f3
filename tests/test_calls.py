"""No call leads from a lower room back to a higher one; `make calls` watches longer cases, and other checkouts."""

from __future__ import annotations

import importlib.util
from collections import Counter

import pytest

import movingfrf as mf
from movingfrf.scenarios.template import template
from tests.helpers import DAMPED
from tests.rooms import LEVEL, SOURCE

spec = importlib.util.spec_from_file_location("calls", SOURCE.parents[1] / "tools" / "calls.py")
calls = importlib.util.module_from_spec(spec)
spec.loader.exec_module(calls)


@pytest.mark.parametrize("name", ["run", "random", "compare", "profile"])
@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_no_call_leads_back(name):
    seen, case = Counter(), calls.cases(0.1)[name]()
    with calls.watched(seen):
        case()
    rooms = {call.rooms for call in seen}
    expected = {
        "run": {("scenarios", "response"), ("response", "guideways"), ("response", "vehicles")},
        "random": {("response", "metrics"), ("response", "guideways")},
        "compare": {("studies", "stepping"), ("studies", "response"), ("stepping", "vehicles")},
        "profile": {("metrics", "roughness")},
    }
    assert expected[name] <= rooms
    assert calls.back(seen, LEVEL) == []


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_a_call_that_leads_back_is_seen_and_said():
    """A callback of a lower room into a higher one, through a function that lies outside the package."""
    seen = Counter()
    with calls.watched(seen):
        mf.moving_loads(
            DAMPED["euler_bernoulli_winkler"],
            [[1e5]] * 200,
            [0.0],
            speed=10.0,
            truncation=50.0,
            progress=lambda stage, fraction: template("scenario"),
        )
    (call, *_) = calls.back(seen, LEVEL)
    assert call.rooms == ("response", "scenarios")
    assert call.called == "template"
    assert [line for line in calls.table(seen, LEVEL, modules=True) if "leads back" in line]


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_what_remembers_is_seen_through():
    """Whoever asks for a critical speed calls the guideway, though `_basics` calls its function."""
    seen = Counter()
    track = calls.replace(DAMPED["euler_bernoulli_winkler"])
    with calls.watched(seen):
        mf.moving_loads(track, [[1e5]] * 200, [0.0], speed=10.0, truncation=50.0)
    assert "Track.critical_speed" in {call.called for call in seen}
    assert not [call for call in seen if call.caller == "_basics.remembered"]


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_the_command_prints_a_table_for_each_case(capsys, monkeypatch):
    assert calls.main(["--duration", "0.25", "profile", "--modules"]) == 0
    told = capsys.readouterr().out
    assert "profile: " in told
    assert "  metrics    -> roughness " in told
    assert "      metrics.profile -> roughness.profile" in told
    monkeypatch.setattr(calls, "levels", lambda: LEVEL | {"roughness": LEVEL["commands"]})
    assert calls.main(["--duration", "0.25", "profile"]) == 1
    assert "  back: metrics.profile." in capsys.readouterr().out
    with pytest.raises(SystemExit):
        calls.main(["everything"])

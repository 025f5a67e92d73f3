"""The paper's command and its parts: what is refused, ended early, equal; scenarios, small rules."""

import signal
import subprocess
import sys
import time

import numpy as np
import pytest

from movingfrf._basics.output import replacing
from movingfrf.commands.main import main
from movingfrf.studies.paper.guideway import _falls_from
from movingfrf.studies.paper.items import ITEMS, chosen, reproduce
from movingfrf.studies.paper.load import _enough
from movingfrf.studies.paper.report import contents
from movingfrf.studies.paper.study import SCENARIOS, Study, drive, scenario


def test_order_is_that_of_the_report():
    assert chosen(["claim1", "12", "5"]) == ["5", "12", "claim1"]
    assert chosen(None) == list(ITEMS)


@pytest.mark.parametrize(
    ("only", "words"), [("13", "got 13"), ("clam4", "did you mean 'claim4'"), (",", "got none")]
)
def test_an_unknown_item_is_refused_before_anything_is_written(only, words, tmp_path, capsys):
    assert main(["paper", "--only", only, "--output", str(tmp_path / "out")]) == 2
    assert words in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_equal_runs_give_equal_files():
    first, second = (contents(reproduce(["7", "claim3"], quick=True)) for _ in range(2))
    assert {"report.html", "paper.json"} < set(first)
    assert first == second


@pytest.mark.parametrize(("told", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_ended_early_it_leaves_nothing(told, status, tmp_path):
    command = [sys.executable, "-m", "movingfrf", "paper", "--only", "claim4", "--output", str(tmp_path / "out")]
    running = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 60
    while not list((tmp_path / "out").glob(".partial-*")) and time.monotonic() < deadline:
        time.sleep(0.05)
    running.send_signal(told)
    _, said = running.communicate(timeout=60)
    assert running.returncode == status
    assert ("interrupted" in said) == (told == signal.SIGINT)
    assert not (tmp_path / "out").exists()


def test_progress_names_the_item():
    told = []
    reproduce(["1"], quick=True, progress=lambda stage, fraction: told.append((stage, fraction)))
    assert len(told) > 5
    assert all(stage.startswith("1/1 Item 1") for stage, _ in told)
    assert all(0 <= fraction <= 1 for _, fraction in told)


# Parts.


@pytest.mark.parametrize("name", SCENARIOS)
def test_scenarios_are_in_order(name, tmp_path, capsys):
    file = tmp_path / f"{name}.toml"
    file.write_text(scenario(name).text, encoding="utf-8")
    assert main(["check", str(file)]) == 0
    assert "in order" in capsys.readouterr().out


def test_both_vehicles_are_one():
    """Left and right wheels of the one add up to the wheels of the other."""
    flat, wide = drive("truck").vehicle, drive("truck_3d").vehicle
    assert wide.static_loads.reshape(2, 2).sum(axis=1) == pytest.approx(flat.static_loads)
    shared = wide.natural_frequencies[[0, 1, 3, 5]]
    assert shared == pytest.approx(flat.natural_frequencies, rel=1e-9)


def test_the_road_of_the_paper_has_480_unknowns():
    assert Study().finite.dofs == 480


def test_where_an_error_is_small_enough():
    cuts = np.array([10.0, 20.0, 40.0, 80.0])

    def falls(cut):
        return (cut / 20.0) ** -4.0 * 1e-3 if cut < 33.0 else 1e-9  # a cliff behind the last cut that is too low

    def found(error):
        return _enough(cuts, np.array([error(cut) for cut in cuts]), error)

    assert found(falls) == pytest.approx(33.0, rel=5e-3)
    assert np.isnan(found(lambda cut: 1.0))
    assert found(lambda cut: 1e-9) == 10.0


def test_from_where_an_amplitude_falls():
    frequency = np.arange(0.0, 80.0)
    assert _falls_from(frequency, np.exp(-(((frequency - 20.0) / 30.0) ** 2))) == 20.0
    assert _falls_from(frequency, np.exp(-frequency)) == 0.0


def test_folders_appear_together_or_not_at_all(tmp_path):
    (tmp_path / "figures").write_text("a file in the way")

    def written():
        with replacing(tmp_path) as files:
            files |= {"a.txt": "a", "figures/b.svg": "b"}

    with pytest.raises(NotADirectoryError, match="a file where a folder is needed"):
        written()
    assert [file.name for file in tmp_path.iterdir()] == ["figures"]

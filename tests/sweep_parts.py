"""A scenario in a folder of its own, and the command, for the tests of sweeps."""

from __future__ import annotations

import subprocess
import sys

import movingfrf as mf
from movingfrf.scenarios.template import template

TEXT = template("scenario").replace("duration = 24.0", "duration = 1.0")
FILE = {"kind": "profile", "file": "road.csv"}


def scenario_in(tmp_path):
    """Write a scenario into a folder, with a measured profile and another vehicle beside it."""
    (tmp_path / "truck.toml").write_text(TEXT)
    other = TEXT.replace("tyre_stiffness = [3.74e6, 4.60e6]", "tyre_stiffness = [3.0e6, 4.0e6]")
    (tmp_path / "other.toml").write_text(other)
    road = mf.realise(mf.IsoRoad.of_class("B"), length=60.0, start=-20.0, seed=5)
    mf.write_profile(road, tmp_path / "road.csv")
    return tmp_path / "truck.toml"


def command(*arguments, **how):
    return subprocess.run(
        [sys.executable, "-m", "movingfrf", *map(str, arguments)],
        capture_output=True,
        text=True,
        check=False,
        **how,
    )

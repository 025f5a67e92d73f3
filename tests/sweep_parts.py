"""A scenario in a folder of its own, and the command, for the tests of sweeps."""

from __future__ import annotations

import json
import subprocess
import sys

import numpy as np
import xarray as xr

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


def table_of(axes, *, design=None, measure="dynamic_load_coefficient", **values):
    """Make a table as `sweep` returns it, of one measure at contacts `front` and `rear` (and of others) by hand.

    Axes are lists of values; of a design its keys. Values are arrays over the axes, by the name of the contact.
    """
    dims = ["sample"] if design else list(axes)
    shape = [len(next(iter(axes.values())))] if design else [len(each) for each in axes.values()]
    coords = {"sample": np.arange(shape[0])} if design else {}
    for name, along in axes.items():
        words = {"long_name": f"run.{name}", **({"units": "m/s"} if name == "speed" else {})}
        kind = object if isinstance(along[0], str) else None
        coords[name] = ("sample" if design else name, np.array(along, kind), words)
    each = np.stack([np.broadcast_to(np.asarray(one, float), shape) for one in values.values()], axis=-1)
    place = "dof" if "acceleration" in measure else "contact"
    coords[f"{place}_name"] = (place, np.array(list(values), object))
    if place == "dof":
        coords["dof_unit"] = (place, np.array(["rad" if name == "pitch" else "m" for name in values], object))
    units = {"contact": "N", "dof": "m/s2 or rad/s2"}[place] if measure != "dynamic_load_coefficient" else "1"
    status = np.where(np.isfinite(each).any(axis=-1), "", "unstable").astype(object)
    variables = {
        measure: ((*dims, place), each, {"units": units, "long_name": measure}),
        "status": (dims, status),
        "findings": (dims, np.full(shape, "", object)),
    }
    attrs = {"kind": "sweep", "findings": "[]", "axes": "[]"}
    return xr.Dataset(variables, coords, attrs | ({"design": json.dumps(design)} if design else {}))

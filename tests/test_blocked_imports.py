"""What a browser's Python has, NumPy, SciPy and xarray, is enough to compute; what comes with extras says how."""

import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from movingfrf._basics import arrays

# Installed with the package, but needed for files, pages, the command line, plates and speed alone.
BLOCKED = (
    "cyclopts",
    "h5netcdf",
    "h5py",
    "jinja2",
    "matplotlib",
    "netCDF4",
    "numba",
    "psutil",
    "rich",
    "skfem",
    "threadpoolctl",
)
EXTRAS = ("FLife", "distributed", "pyopencrg", "pyuff", "python_calamine")

PRELUDE = f"""
import sys
import threading


BLOCKED = {(*BLOCKED, *EXTRAS)!r}


class Blocked:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in BLOCKED:
            raise ImportError(f"{{name}} is blocked")


def no_thread(self):
    raise RuntimeError("can't start new thread")


sys.meta_path.insert(0, Blocked())
threading.Thread.start = no_thread
import movingfrf as mf
"""

COMPUTED = """
import numpy as np

road = mf.track(
    mf.EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9), mf.Spring(stiffness=8.0e6, damping=3.0e4)
)
car = mf.quarter_car(
    body_mass=400.0, wheel_mass=40.0, suspension_stiffness=2e4, suspension_damping=1.5e3, tyre_stiffness=2e5
)
hump = mf.bump(height=0.02, width=1.0, at=5.0, length=30.0)
result = mf.simulate(road, car, hump, speed=10.0, duration=2.0, blend=0.0)
assert len(mf.measures(result)) > 5, mf.measures(result)
assert mf.rainflow(result.contact_force.values[:, 0]).size
truck = mf.convoy([mf.catalogue(name="half_truck")] * 2, gaps=[10.0])
iso = mf.IsoRoad.of_class("A")
many = mf.simulate(road, truck, mf.realise(iso, length=200.0, seed=1), speed=10.0, duration=5.0, start=50.0)
assert np.isfinite(many.contact_force.values).all()
assert mf.transfer(road, car, speed=10.0, frequency=[1.0, 10.0]).contact_force.size == 2
assert float(mf.random_response(road, car, iso, speed=10.0).contact_force_rms[0]) > 0
loads = mf.moving_loads(road, np.full((1000, 1), 1e4), [0.0], speed=10.0)
assert np.isfinite(loads.deflection.values).all()
loaded = {name.partition(".")[0] for name in sys.modules}
print(*sorted(loaded & set(BLOCKED)))
"""


def run(code):
    return subprocess.run(
        [sys.executable, "-W", "ignore", "-c", PRELUDE + code],
        capture_output=True,
        text=True,
        check=False,
    )


def test_numpy_scipy_and_xarray_are_enough_to_compute():
    """As in Pyodide, which has no threads either; the meta-path finder is asked before any installed package."""
    done = run(COMPUTED)
    assert done.returncode == 0, done.stderr
    assert done.stdout == "\n"


def test_what_is_blocked_is_blocked():
    done = run("import h5py")
    assert done.returncode == 1
    assert done.stderr.endswith("ImportError: h5py is blocked\n")


def test_memory_that_nothing_tells_is_not_refused(monkeypatch):
    """Without /proc and psutil, as in a browser; where one of them tells, it counts."""
    assert 0 < arrays.free_memory() < 2**50
    with pytest.raises(ValueError, match=r"a train of 9 needs about 9\.31e"):
        arrays.require_memory(1e20, "a train of 9")
    monkeypatch.setattr(arrays, "Path", lambda name: Path("/nowhere") / name[1:])
    monkeypatch.setitem(sys.modules, "psutil", SimpleNamespace(virtual_memory=lambda: SimpleNamespace(available=7)))
    assert arrays.free_memory() == 7.0
    monkeypatch.setitem(sys.modules, "psutil", None)
    assert arrays.free_memory() == float("inf")
    arrays.require_memory(1e20, "a train of 9")

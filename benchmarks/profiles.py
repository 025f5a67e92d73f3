"""How long it takes to describe a long profile: `python -m benchmarks.profiles [--length 500] [--format csv|nc]`.

Writes a road of two paths (500 km at 0.1 m: 5 million stations, left and right) and runs `movingfrf profile` on it,
page and figures included, in a process of its own; says how long that took and how much memory it had at its peak.
"""

from __future__ import annotations

import argparse
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import movingfrf as mf

STEP = 0.1


def road(kilometres: float) -> mf.Profile:
    """Make a road of class A whose paths share half of their variance, to a tenth of a millimetre."""
    spectrum = mf.IsoRoad.of_class("A", band=(0.002, 5.0))
    common, left, right = (
        mf.realise(spectrum, length=1e3 * kilometres, step=STEP, seed=seed).elevation for seed in range(3)
    )
    paths = np.stack([common + left, common + right], axis=1) / np.sqrt(2)
    stations = np.round(STEP * np.arange(len(paths)), 1)
    return mf.Profile(stations, np.round(paths, 4), across=(0.75, -0.75))


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.profiles", description=__doc__.splitlines()[0])
    parser.add_argument("--length", type=float, default=500.0, help="length of the road [km]")
    parser.add_argument("--format", choices=("csv", "nc", "mat", "erd", "crg"), default="csv")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / f"road.{options.format}"
        profile = road(options.length)
        mf.write_profile(profile, file)
        count, size = profile.stations.size, sum(part.stat().st_size for part in Path(folder).iterdir())
        del profile
        command = [sys.executable, "-m", "movingfrf", "profile", str(file), "--output", f"{folder}/out"]
        began = time.perf_counter()
        done = subprocess.run(command, capture_output=True, text=True)
        seconds = time.perf_counter() - began
        if done.returncode:
            sys.exit(done.stderr)
        page = (Path(folder) / "out" / "profile.html").stat().st_size
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    peak, busy = used.ru_maxrss / 2**20, used.ru_utime + used.ru_stime
    print(done.stdout)
    print(
        f"{count} stations, two paths, {size / 1e6:.0f} MB of {options.format}: described in {seconds:.1f} s "
        f"({busy:.1f} s of computing, on {os.cpu_count()} cores) with {peak:.2f} GiB at the "
        f"peak; page of {page / 1e6:.2f} MB"
    )


if __name__ == "__main__":
    main()

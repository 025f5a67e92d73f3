"""What commands cost, against what they cannot do without: `make cost`.

Processor time of whole processes, alternately with processes that only import the libraries which a command cannot
do without; medians. Then what `simulate`, `transfer` and `random_response` cost with two BLAS threads against one.
Ends with status 1 where a ratio is larger than it may be.
"""

from __future__ import annotations

import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
from functools import partial
from pathlib import Path
from typing import NamedTuple

ROUNDS = 9

# What a command that solves, draws and writes imports at the least, and one that only computes.
FLOORS = {
    "solving": ("import numpy, scipy.linalg, xarray, h5netcdf, matplotlib.figure", 1),
    "numbers, twice": ("import numpy, scipy.linalg", 2),
}


class Command(NamedTuple):
    """A command, what it is measured against, and how many times that it may cost."""

    words: tuple[str, ...]
    floor: str
    most: float


COMMANDS = {
    "run": Command(("run", "case.toml", "--output", "out"), "solving", 2.2),
    "run --no-report": Command(("run", "case.toml", "--output", "out", "--no-report"), "solving", 1.6),
    "check": Command(("check", "case.toml"), "numbers, twice", 1.3),
    "vehicles": Command(("vehicles",), "numbers, twice", 1.3),
    "--help": Command(("--help",), "numbers, twice", 1.0),
}
THREADS = 1.2  # processor time with two threads over that with one, at most

# Medians of what public functions take in one process.
SOLVING = r"""
import json, statistics, time, warnings
import numpy as np
import movingfrf as mf
from benchmarks.cases import SCENARIO
warnings.simplefilter("ignore")
road = SCENARIO.guideway
rail = mf.track(
    mf.TimoshenkoBeam(bending_stiffness=1.3e7, mass=120.0, shear_stiffness=4e8, rotary_inertia=0.5),
    mf.OnMass(
        above=mf.Spring(stiffness=1e8, damping=5e4), mass=300.0, below=mf.Spring(stiffness=8e7, damping=1e5)
    ),
)
spectrum = mf.IsoRoad.of_class("A", band=(0.01, 6.0))
profile = mf.realise(spectrum, length=270.0, start=-20.0)
vehicles = {"half truck": mf.catalogue(name="half_truck"), "semitrailer": mf.catalogue(name="tractor_semitrailer")}
lines = np.linspace(0.1, 70.0, 2000)
cases = {}
for name, vehicle in vehicles.items():
    cases[f"simulate, {name}"] = lambda v=vehicle: mf.simulate(road, v, profile, speed=10.0, duration=10.0)
    cases[f"transfer, {name}"] = lambda v=vehicle: mf.transfer(rail, v, speed=20.0, frequency=lines)
    cases[f"random_response, {name}"] = lambda v=vehicle: mf.random_response(rail, v, spectrum, speed=20.0)
for name, case in cases.items():
    case()
    taken = []
    for _ in range(7):
        begun = time.process_time()
        case()
        taken.append(time.process_time() - begun)
    cases[name] = statistics.median(taken)
print(json.dumps(cases))
"""


def processor_time(command: list[str], folder: Path, environment: dict[str, str]) -> float:
    """Run a process to its end; processor time of it and of what it starts [s]."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, cwd=folder, env=environment, stdout=subprocess.DEVNULL, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def commands(folder: Path, threads: str) -> list[tuple[str, float, float, float]]:
    """Name, processor time [s], ratio and largest ratio of every command."""
    environment = os.environ | {"OMP_NUM_THREADS": threads, "OPENBLAS_NUM_THREADS": threads}
    python = [sys.executable]
    processes = {name: [*python, "-c", words] for name, (words, _) in FLOORS.items()} | {
        name: [*python, "-m", "movingfrf", *command.words] for name, command in COMMANDS.items()
    }
    taken: dict[str, list[float]] = {name: [] for name in processes}
    for _ in range(ROUNDS):
        for name, process in processes.items():
            taken[name].append(processor_time(process, folder, environment))
    middle = {name: statistics.median(times) for name, times in taken.items()}
    found = []
    for name, command in COMMANDS.items():
        floor = FLOORS[command.floor][1] * middle[command.floor]
        found.append((name, middle[name], middle[name] / floor, command.most))
    return found


def threads() -> list[tuple[str, float, float, float]]:
    """Name, processor time with two threads [s], that over the time with one, and the largest such ratio."""
    several: dict[str, list[dict[str, float]]] = {"1": [], "2": []}
    for _ in range(3):
        for number, found in several.items():
            environment = os.environ | {"OMP_NUM_THREADS": number, "OPENBLAS_NUM_THREADS": number}
            ran = subprocess.run(
                [sys.executable, "-c", SOLVING],
                cwd=Path(__file__).parents[1],
                env=environment,
                capture_output=True,
                text=True,
                check=True,
            )
            found.append(json.loads(ran.stdout))
    one, two = (
        {name: statistics.median(each[name] for each in found) for name in found[0]} for found in several.values()
    )
    return [(name, two[name], two[name] / one[name], THREADS) for name in one]


def main() -> int:
    """Measure, print, and tell whether all is as it should be."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        # As an installation has them, modules are compiled already, even where the environment would rather not.
        os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
        subprocess.run([sys.executable, "-m", "movingfrf", "new", "case.toml"], cwd=folder, check=True)
        dear = False
        for heading, measured in (
            ("command, one thread", partial(commands, folder, "1")),
            ("command, two threads", partial(commands, folder, "2")),
            ("two threads against one", threads),
        ):
            rows = measured()
            print(f"{heading:36s} processor time   ratio   at most")
            for name, seconds, ratio, most in rows:
                dear |= ratio > most
                print(
                    f"{name:36s} {1e3 * seconds:11.1f} ms {ratio:7.2f} {most:8.1f}{'  !' if ratio > most else ''}"
                )
            print()
    return int(dear)


if __name__ == "__main__":
    sys.exit(main())

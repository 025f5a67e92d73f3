"""How fast, against another checkout: `make against OLD=path`.

Each side has a process of its own, on one thread. Both prepare the same cases and then solve them in turn, so that
a busy machine slows both; medians of wall and processor time, and the median of the ratios of neighbours.
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
from pathlib import Path

ROUNDS = 31

# What each side runs: one line asks for a case, one line answers.
WORKER = r"""
import json, sys, time, warnings
import numpy as np
import movingfrf as mf
from benchmarks.train import SPEED, TRACK, train as built
warnings.simplefilter("ignore")
road = mf.track(mf.EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9), mf.Spring(stiffness=8e6, damping=3e4))
truck = mf.half_car(
    body_mass=17735.0, pitch_inertia=1.47e5, wheel_masses=(1500.0, 1000.0), suspension_stiffness=(2.47e6, 4.23e6),
    suspension_damping=(3.0e4, 4.0e4), tyre_stiffness=(3.74e6, 4.60e6), tyre_damping=(3.9e3, 4.3e3),
    axles=(2.21613, -2.05387),
)
car = mf.quarter_car(
    body_mass=400.0, wheel_mass=40.0, suspension_stiffness=2e4, suspension_damping=1.5e3, tyre_stiffness=2e5,
    tyre_damping=150.0,
)
spectrum = mf.IsoRoad.of_class("A", band=(0.01, 6.0))
profile = mf.realise(spectrum, length=245.0, start=-2.5)
coaches = built(2 * mf.hertzian_stiffness(75e3, wheel_radius=0.46))
rails = mf.realise(mf.GermanTrack.of_class("low", band=(0.0125, 1.25)), length=700.0, step=0.1, start=-400.0)
points, forces = np.linspace(-10.0, 5.0, 20), np.full((5000, 3), 1e5)
lines = np.linspace(0.0, 100.0, 2000)
cases = {
    "reference": lambda: mf.simulate(road, truck, profile, speed=10.0, duration=24.0, truncation=70.0),
    "truncation": lambda: mf.simulate(road, truck, profile, speed=10.0, duration=24.0),
    "quarter": lambda: mf.simulate(road, car, profile, speed=10.0, duration=5.0),
    "random": lambda: mf.random_response(road, truck, spectrum, speed=20.0),
    "transfer": lambda: mf.transfer(road, truck, speed=20.0, frequency=lines),
    "loads": lambda: mf.moving_loads(road, forces, [0.0, -3.0, -6.0], speed=20.0, observe=points),
    "train": lambda: mf.simulate(TRACK, coaches, rails, speed=SPEED, duration=2.0, truncation=110.0),
}
for line in sys.stdin:
    wall, cpu = time.perf_counter(), time.process_time()
    cases[line.strip()]()
    print(json.dumps([time.perf_counter() - wall, time.process_time() - cpu]), flush=True)
"""
CASES = ("reference", "truncation", "quarter", "random", "transfer", "loads", "train")


def worker(checkout: Path) -> subprocess.Popen[str]:
    """Start one side."""
    environment = os.environ | {
        "PYTHONPATH": os.pathsep.join([str(checkout / "src"), str(checkout)]),
        "OMP_NUM_THREADS": "1",
        "OPENBLAS_NUM_THREADS": "1",
    }
    command = [sys.executable, "-c", WORKER]
    return subprocess.Popen(command, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)


def timed(side: subprocess.Popen[str], case: str) -> tuple[float, float]:
    """Solve a case on one side; wall and processor time [s]."""
    assert side.stdin is not None
    assert side.stdout is not None
    side.stdin.write(f"{case}\n")
    side.stdin.flush()
    wall, processor = json.loads(side.stdout.readline())
    return wall, processor


def main() -> None:
    """Compare this checkout with the one that is named."""
    here, there = Path(__file__).resolve().parent.parent, Path(sys.argv[1]).resolve()
    wanted = sys.argv[2:] or CASES
    sides = [worker(here), worker(there)]
    print(f"one thread, medians of {ROUNDS} (train: 5); this checkout over {there.name}")
    for case in wanted:
        rounds = 5 if case == "train" else ROUNDS
        for side in sides:
            timed(side, case)  # warm
        pairs = [[timed(side, case) for side in sides] for _ in range(rounds)]
        words = []
        for number, kind in enumerate(("wall", "processor")):
            mine, theirs = ([pair[side][number] for pair in pairs] for side in (0, 1))
            ratio = statistics.median(a / b for a, b in zip(mine, theirs, strict=True))
            medians = (1e3 * statistics.median(times) for times in (mine, theirs))
            words.append("{} {:8.2f} / {:8.2f} ms  {:5.2f}".format(kind, *medians, ratio))
        print(f"{case:10s} {'   '.join(words)}", flush=True)
    for side in sides:
        assert side.stdin is not None
        side.stdin.close()
        side.wait()


if __name__ == "__main__":
    main()

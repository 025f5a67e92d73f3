"""What it costs to share a sweep out: two processes against one, and a cluster of two workers: `make workers`.

Of two processes the wall times, which ask for two idle cores, and the processor times, which hardly do: on idle
cores two are as much faster as twice the one's is more than both of theirs, less what waits. Of a cluster the share
of its workers' time in which they solve no chunk: connection, scheduler, bytes and files, and who has nothing left
to do at the end.
"""

from __future__ import annotations

import argparse
import os
import resource
import tempfile
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

# Before NumPy is loaded: its linear algebra reads the number of threads once.
os.environ |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}

import numpy as np
from tests.cluster_parts import Cluster

import movingfrf as mf
from movingfrf._basics.toml_file import tables_of
from movingfrf.scenarios.template import template
from movingfrf.studies.sweep.plan import Plan, plan_of
from movingfrf.studies.sweep.sweep import swept

AIM_GAIN, AIM_SHARE = 1.6, 0.1
CAR: dict[str, Any] = {
    "guideway": {"kind": "rigid_guideway"},
    "vehicle": {"kind": "catalogue", "name": "golden_car"},
    "roughness": {"kind": "bump", "height": 0.02, "width": 1.0, "at": 5.0},
    "run": {"speed": 10.0, "duration": 0.5, "blend": 0.0},
}


def plan(tables: dict[str, Any], cases: int) -> Plan:
    """Ask for so many speeds."""
    return plan_of(tables, {"run.speed": np.linspace(8.0, 12.0, cases).tolist()})


@contextmanager
def timed(taken: list[float]) -> Iterator[Path]:
    """Take the wall time and the processor time, of children too, of a block that writes into a folder."""

    def processor() -> float:
        used = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
        return sum(one.ru_utime + one.ru_stime for one in used)

    with tempfile.TemporaryDirectory() as made:
        wall, cpu = time.perf_counter(), processor()
        yield Path(made)
        taken += [time.perf_counter() - wall, processor() - cpu]


def processes(name: str, asked: Plan) -> None:
    """Compare two processes with this one."""
    one: list[float] = []
    two: list[float] = []
    for workers, taken in ((1, one), (2, two)):
        with timed(taken) as folder:
            swept(asked, folder / "sweep", workers=workers)
    print(
        f"{name}, {asked.axes.cases} cases: one process {one[0]:.1f} s, two {two[0]:.1f} s: "
        f"{one[0] / two[0]:.2f} times as fast (aim {AIM_GAIN}); by processor time {one[1]:.1f} and {two[1]:.1f} s, "
        f"{2 * one[1] / two[1]:.2f} times; load {os.getloadavg()[0]:.1f}",
        flush=True,
    )


def cluster(name: str, asked: Plan, warm: Plan) -> None:
    """Tell which share of the time of a cluster's workers goes elsewhere than into chunks."""
    from distributed import Client, get_task_stream

    with tempfile.TemporaryDirectory() as made, Cluster(Path(made)) as started:
        # Its workers have loaded what they need, and are there.
        swept(warm, Path(made) / "warm", cluster=started.address)
        taken: list[float] = []
        with Client(started.address, set_as_default=False) as client:
            workers = len(client.nthreads())
            with get_task_stream(client) as stream, timed(taken) as folder:
                swept(asked, folder / "sweep", cluster=started.address)
        chunks = [
            part["stop"] - part["start"]
            for task in stream.data
            for part in task["startstops"]
            if part["action"] == "compute"
        ]
    share = 1.0 - sum(chunks) / (workers * taken[0])
    print(
        f"{name}, {asked.axes.cases} cases: {workers} workers of a cluster {taken[0]:.1f} s, {len(chunks)} tasks "
        f"of {np.median(chunks):.3f} s in the middle; {share:.1%} of the workers' time elsewhere "
        f"(aim {AIM_SHARE:.0%}); load {os.getloadavg()[0]:.1f}",
        flush=True,
    )


def main() -> None:
    """Run both, for a short car and for the reference case."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", type=int, default=10_000, help="of each sweep of two processes")
    parser.add_argument("--of-cluster", type=int, default=3000, help="cases of a sweep of the cluster")
    options = parser.parse_args()
    warnings.simplefilter("ignore", mf.ValidityWarning)
    for name, tables in (("short car", CAR), ("reference truck", tables_of(template("scenario")))):
        cluster(name, plan(tables, options.of_cluster), plan(tables, 256))
        processes(name, plan(tables, options.cases))


if __name__ == "__main__":
    main()

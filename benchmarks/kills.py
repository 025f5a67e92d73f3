"""`kill -9` of client, worker and scheduler of a sweep on a cluster, at ten random moments each: `make kills`.

Started again, no stored chunk is computed again, and chunks and tables are those of a process alone, byte for byte.
Prints a line for each kill; ends with exit status 1 if one of them has cost anything.
"""

from __future__ import annotations

import argparse
import os
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from tests.cluster_parts import Cluster
from tests.sweep_parts import scenario_in

VICTIMS, LONGEST = ("client", "worker", "scheduler"), 120.0
ASKED = ["--over", "run.speed=8:12:192", "--over", "roughness.seed=0,1", "--measures", "contact_force_rms"]


def begun(truck: Path, folder: Path, *others: str) -> subprocess.Popen[str]:
    """Start the sweep."""
    return subprocess.Popen(
        [sys.executable, "-m", "movingfrf", "sweep", str(truck), *ASKED, "-o", str(folder), *others],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )


def contents(folder: Path) -> dict[str, bytes]:
    """Read chunks and table."""
    return {file.name: file.read_bytes() for file in (*folder.glob("chunks/*.npz"), *folder.glob("table.csv"))}


def written(folder: Path) -> dict[str, int]:
    """Tell when each chunk was written."""
    return {file.name: file.stat().st_mtime_ns for file in folder.glob("chunks/*.npz")}


def killed(victim: str, after: float, truck: Path, alone: dict[str, bytes], place: Path) -> str:
    """Kill one of them after so many seconds; what is wrong afterwards, or nothing."""
    folder = place / "sweep"
    with Cluster(place) as cluster:
        client = begun(truck, folder, "--cluster", cluster.address)
        time.sleep(after)
        {"client": client, "worker": cluster.workers[0], "scheduler": cluster.scheduler}[victim].kill()
        before = written(folder)
        _, said = client.communicate(timeout=LONGEST)
    ended = client.returncode
    print(
        f"{victim:<9} after {after:4.1f} s: {len(before)} chunks; exit status {ended:>3}; {said.strip()[:60]}",
        end="",
    )
    allowed = {"client": (-9, 0), "worker": (0,), "scheduler": (2, 0)}[victim]
    if (
        ended not in allowed
        or said.count("\n") != (ended == 2)
        or (ended == 2 and not said.startswith("movingfrf: "))
    ):
        return f"exit status {ended}, {said!r}"
    # Whatever came after the kill is stored as well.
    before = written(folder)
    with Cluster(place) as cluster:
        again = begun(truck, folder, "--cluster", cluster.address)
        _, said = again.communicate(timeout=LONGEST)
    if again.returncode or said:
        return f"started again: exit status {again.returncode}, {said!r}"
    if not before.items() <= written(folder).items():
        return "a stored chunk was computed again"
    return "" if contents(folder) == alone else "other bytes"


def main() -> None:
    """Kill all of them."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--moments", type=int, default=10, help="of each")
    parser.add_argument("--seed", type=int, default=0, help="of the moments")
    options = parser.parse_args()
    os.environ |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    drawn, wrong = random.Random(options.seed), 0
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        truck = scenario_in(folder)
        assert begun(truck, folder / "alone").wait() == 0
        alone = contents(folder / "alone")
        place = folder / "whole"
        place.mkdir()
        with Cluster(place) as cluster:
            since = time.monotonic()
            assert begun(truck, place / "sweep", "--cluster", cluster.address).wait() == 0
            lasts = time.monotonic() - since
        assert contents(place / "sweep") == alone
        print(f"undisturbed: {len(alone) - 1} chunks in {lasts:.1f} s; the same bytes as by a process alone")
        for victim in VICTIMS:
            for number in range(options.moments):
                place = folder / f"{victim}-{number}"
                place.mkdir()
                fault = killed(victim, drawn.uniform(0.0, lasts), truck, alone, place)
                print(f"; {fault or 'well'}", flush=True)
                wrong += bool(fault)
    print(f"{wrong or 'none'} of {len(VICTIMS) * options.moments} kills has cost anything")
    sys.exit(wrong > 0)


if __name__ == "__main__":
    main()

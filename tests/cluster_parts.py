"""A scheduler of dask.distributed and workers, as processes of their own, for tests and benchmarks."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from pathlib import Path

SOURCE = Path(__file__).parents[1] / "src"


class Cluster:
    """A scheduler and workers that end with the block.

    Parameters
    ----------
    folder : Path
        Where they put what they need.
    workers : int
        How many workers there are at first, each on one thread.
    """

    def __init__(self, folder: Path, workers: int = 2) -> None:
        self.folder = folder
        self.workers: list[subprocess.Popen[bytes]] = []
        said = folder / "scheduler.json"
        said.unlink(missing_ok=True)
        self.scheduler = self._started("scheduler", "--host", "127.0.0.1", "--port", "0", "--scheduler-file", said)
        until = time.monotonic() + 30.0
        while not said.exists() or not said.read_text():
            assert self.scheduler.poll() is None, (folder / "log.txt").read_text()
            assert time.monotonic() < until, "no scheduler within 30 s"
            time.sleep(0.02)
        self.address: str = json.loads(said.read_text())["address"]
        for _ in range(workers):
            self.add_worker()

    def add_worker(self, source: Path = SOURCE, threads: int = 1) -> None:
        """Start another worker, with the package that lies in a folder."""
        some = ["--nthreads", threads, "--no-nanny", "--local-directory", self.folder]
        self.workers.append(self._started("worker", self.address, *some, source=source))

    def _started(self, kind: str, *arguments: object, source: Path = SOURCE) -> subprocess.Popen[bytes]:
        module = f"distributed.cli.dask_{kind}"
        with (self.folder / "log.txt").open("ab") as log:
            return subprocess.Popen(
                [sys.executable, "-m", module, "--no-dashboard", *map(str, arguments)],
                env=os.environ | {"PYTHONPATH": str(source), "OMP_NUM_THREADS": "1"},
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
            )

    def __enter__(self) -> Cluster:
        """Give it as it is."""
        return self

    def __exit__(self, *_: object) -> None:
        """End all of it."""
        for process in (*self.workers, self.scheduler):
            process.kill()
            process.wait()

"""Other processes that solve chunks of a sweep; its folder and a pipe are all that they have in common."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path

from movingfrf._basics.progress import Progress
from movingfrf._basics.undoing import undone
from movingfrf.studies.sweep.chunks import CHUNKING, Kept


def carried_on(folder: Path, kept: Kept, chunks: Sequence[int], workers: int, progress: Progress) -> None:
    """Have chunks solved by other processes, each the next when it is done with one, and wait for them.

    Parameters
    ----------
    folder : Path
        Where the sweep lies.
    kept : Kept
        Its chunks.
    chunks : sequence of int
        Which are solved.
    workers : int
        How many processes.
    progress : callable
        Called with the name of a stage and the fraction of it that is done.

    Raises
    ------
    ChildProcessError
        If a process ends before it has solved what it was to solve, with what it said.
    """
    one_thread = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    running: list[subprocess.Popen[str]] = []

    def stop() -> None:
        for process in running:
            process.kill()
            process.wait()
            if process.stderr:
                process.stderr.close()

    with undone(stop):
        reading, writing = os.pipe()
        command = [sys.executable, "-m", "movingfrf.studies.sweep.worker", str(folder)]
        for _ in range(workers):
            process = subprocess.Popen(
                command,
                env=os.environ | one_thread,
                stdin=reading,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE,
                text=True,
            )
            running.append(process)
        # None is read twice, whoever comes first.
        os.write(writing, b"".join(number.to_bytes(CHUNKING.word) for number in chunks))
        for end in (writing, reading):
            os.close(end)
        wanted = set(chunks)
        while any(process.poll() is None for process in running):
            progress("cases", 1.0 - len(wanted & set(kept.missing())) / len(wanted))
            _require_well(running)
            time.sleep(CHUNKING.look)
        _require_well(running)


def _require_well(running: Sequence[subprocess.Popen[str]]) -> None:
    """Refuse to go on where a process has ended with an error."""
    for process in running:
        if process.returncode:
            said = process.stderr.read().strip().splitlines() if process.stderr else []
            killed = "it was killed" if process.returncode < 0 else f"its exit status was {process.returncode}"
            raise ChildProcessError(
                f"a worker has ended before its cases were solved: {said[-1] if said else killed}; what is solved "
                "is kept where there is a folder for it, and called again the sweep goes on from there"
            )

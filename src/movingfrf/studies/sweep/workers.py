"""Other processes that solve chunks of a sweep; its folder and a pipe are all that they have in common."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NoReturn

from movingfrf._basics.compiling import load
from movingfrf._basics.ending import pending, signals
from movingfrf._basics.progress import Progress
from movingfrf._basics.undoing import undone
from movingfrf.studies.sweep.chunks import CHUNKING, Kept
from movingfrf.studies.sweep.plan import Plan
from movingfrf.studies.sweep.worker import solve_asked


class Forked:
    """A copy of this process that does something else and ends: it knows at once what others load for a second.

    Parameters
    ----------
    work : callable
        What it does.
    """

    def __init__(self, work: Callable[[], object]) -> None:
        reading, writing = os.pipe()
        with warnings.catch_warnings():
            # Threads of BLAS count; it is prepared for that.
            warnings.simplefilter("ignore", DeprecationWarning)
            self._pid = os.fork()
        if not self._pid:
            _work_and_end(work, writing)
        os.close(writing)
        self.stderr = os.fdopen(reading, errors="replace")
        self.returncode: int | None = None

    def poll(self) -> int | None:
        """Tell its exit status, negative if it was killed; None while it goes on."""
        return self._look(os.WNOHANG)

    def wait(self) -> int | None:
        """Wait for its end."""
        return self._look(0)

    def kill(self) -> None:
        """Kill it, if it goes on."""
        if self.poll() is None:
            os.kill(self._pid, signal.SIGKILL)

    def _look(self, how: int) -> int | None:
        if self.returncode is None:
            ended, status = os.waitpid(self._pid, how)
            if ended:
                self.returncode = os.waitstatus_to_exitcode(status)
        return self.returncode


def _work_and_end(work: Callable[[], object], writing: int) -> NoReturn:
    """Do what a copy is for; what this process has to undo is not the copy's."""
    pending.clear()
    for number in signals():
        signal.signal(number, signal.SIG_DFL)
    status = 1
    try:
        work()
        status = 0
    except BaseException as error:
        os.write(writing, f"{type(error).__name__}: {error}".encode())
    finally:
        os._exit(status)


def may_fork() -> bool:
    """Whether a copy of this process is sound: what other threads hold would stay held in it forever."""
    return sys.platform == "linux" and threading.active_count() == 1


def carried_on(
    plan: Plan, folder: Path, kept: Kept, chunks: Sequence[int], workers: int, progress: Progress
) -> None:
    """Have chunks solved by other processes, each the next when it is done with one, and wait for them.

    Parameters
    ----------
    plan : Plan
        The sweep.
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
    running: list[Forked | subprocess.Popen[str]] = []

    def stop() -> None:
        for process in running:
            process.kill()
            process.wait()
            if process.stderr:
                process.stderr.close()

    with undone(stop):
        reading, writing = os.pipe()
        # None is read twice, whoever comes first.
        os.write(writing, b"".join(number.to_bytes(CHUNKING.word) for number in chunks))
        os.close(writing)
        if may_fork():
            load()
            running += (Forked(lambda: solve_asked(plan, kept, reading)) for _ in range(workers))
        else:
            running += (_started(folder, reading) for _ in range(workers))
        os.close(reading)
        wanted = set(chunks)
        while any(process.poll() is None for process in running):
            progress("cases", 1.0 - len(wanted & set(kept.missing())) / len(wanted))
            _require_well(running)
            time.sleep(CHUNKING.look)
        _require_well(running)


def _started(folder: Path, reading: int) -> subprocess.Popen[str]:
    """Start a process that knows nothing yet."""
    one_thread = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    return subprocess.Popen(
        [sys.executable, "-m", "movingfrf.studies.sweep.worker", str(folder)],
        env=os.environ | one_thread,
        stdin=reading,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )


def _require_well(running: Sequence[Forked | subprocess.Popen[str]]) -> None:
    """Refuse to go on where a process has ended with an error."""
    for process in running:
        if process.returncode:
            said = process.stderr.read().strip().splitlines() if process.stderr else []
            killed = "it was killed" if process.returncode < 0 else f"its exit status was {process.returncode}"
            raise ChildProcessError(
                f"a worker has ended before its cases were solved: {said[-1] if said else killed}; what is solved "
                "is kept where there is a folder for it, and called again the sweep goes on from there"
            )

"""What lasts as long as a block of the program and no longer, however the block or the process ends."""

from __future__ import annotations

import shutil
import signal
import subprocess
import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path

from movingfrf._basics.ending import pending, signals


@contextmanager
def undone(undo: Callable[[], object]) -> Iterator[None]:
    """Call something when the block ends, in whatever way, the process included.

    Parameters
    ----------
    undo : callable
        What to call; it may be called twice.
    """
    pending.append(undo)
    try:
        yield
    finally:
        undo()
        pending.remove(undo)


@contextmanager
def scratch(doing: str = "made") -> Iterator[Path]:
    """Lend a folder for the time of the block.

    Parameters
    ----------
    doing : str
        What happens there to the file that the block is about: it is `made`, or `unpacked`.

    Yields
    ------
    Path
        The folder.

    Raises
    ------
    OSError
        If it cannot be made, or the block cannot write there: why, and where, without a name. The folder's says
        nothing to anybody, and whoever knows that of the file gives it.
    """
    folder = Path(tempfile.mkdtemp(prefix="movingfrf-"))
    with undone(partial(shutil.rmtree, folder, ignore_errors=True)):
        try:
            yield folder
        except OSError as error:  # a full disk, where a library does not say which
            said = f"{error.strerror or error}, while it is {doing} in {folder.parent}"
            raise OSError(error.errno, said) from None


def carried_out(
    command: Sequence[str], given: bytes = b"", timeout: float | None = None
) -> subprocess.CompletedProcess[bytes]:
    """Wait for a process that ends with this one.

    Parameters
    ----------
    command : sequence of str
        Program and arguments.
    given : bytes
        Its standard input.
    timeout : float, optional
        How long it may take [s].

    Returns
    -------
    subprocess.CompletedProcess
        With all that it wrote.

    Raises
    ------
    subprocess.TimeoutExpired
        If it takes longer.
    """
    pipe = subprocess.PIPE
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=pipe) as process, undone(process.kill):
        said = process.communicate(given, timeout)
        return subprocess.CompletedProcess(command, process.returncode, *said)


@contextmanager
def undisturbed() -> Iterator[None]:
    """Hold back what interrupts or ends the process until the block is done."""
    held: list[int] = []
    before = {number: signal.getsignal(number) for number in signals()}
    # Others than Python's own functions cannot be put back, or end the process without asking.
    heeded = {number: function for number, function in before.items() if callable(function)}
    try:
        for number in heeded:
            with suppress(ValueError):  # only the main thread is interrupted
                signal.signal(number, lambda got, _: held.append(got))
        yield
    finally:
        for number, function in heeded.items():
            with suppress(ValueError):
                signal.signal(number, function)
        for got in held:
            signal.raise_signal(got)

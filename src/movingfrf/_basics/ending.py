"""How the command ends where it is told to, by Ctrl-C or from outside: at once, in a line, with nothing half done.

No exception is raised: one that strikes while a module is being loaded, in a callback or in a destructor would show
as a traceback or get lost. So this is the first module that the command loads, and loads next to nothing itself.
"""

from __future__ import annotations

# Not `signal` and `collections.abc`: they take 3 ms to load, in which an interrupt would show.
import _signal  # type: ignore[import-not-found]
import os
import sys
from _collections_abc import Callable

# What has to be undone if the process ends now, the latest first. Each may be called at any moment, and twice.
pending: list[Callable[[], object]] = []

# What the command has put in place.
placed: list[str] = []


def is_command() -> bool:
    """Whether this process is the command `movingfrf`, and not one that imports the package."""
    script = (getattr(sys, "argv", None) or [""])[0]
    if script == "-m":  # a module that Python still looks for, named behind -m or other letters with it
        given = sys.orig_argv
        named = [at for at, option in enumerate(given) if option[:1] == "-" != option[1:2] and option[-1:] == "m"]
        script = given[named[0] + 1] if named and named[0] + 1 < len(given) else ""
    folder, name = os.path.split(script)
    # The module that was looked for, once it has been found.
    script = folder if name == "__main__.py" else script
    return os.path.basename(script).partition(".")[0] in ("movingfrf", "movingfrf-script")


def heed() -> None:
    """End at once where told to, from now on; what the caller of the process chose to ignore stays ignored."""
    for number in signals():
        if _signal.getsignal(number) != _signal.SIG_IGN:
            _signal.signal(number, _end)


def ignore() -> None:
    """Hear nothing more, while Python tidies up."""
    for number in signals():
        _signal.signal(number, _signal.SIG_IGN)


def written() -> str:
    """Say what has been put in place, in words to follow a message."""
    return f"already written: {', '.join(placed)}" if placed else "nothing was written"


def signals() -> list[int]:
    """List what ends a process early, by number."""
    names = ("SIGINT", "SIGTERM", "SIGHUP")  # the last where a terminal is closed, which not every system knows
    return [getattr(_signal, name) for name in names if hasattr(_signal, name)]


def _end(number: int, _: object) -> None:
    ignore()
    for undo in reversed(pending):
        try:
            undo()
        except Exception:
            pass  # the process ends, whatever is left
    if number == _signal.SIGINT:
        try:
            os.write(2, f"movingfrf: interrupted, {written()}\n".encode("ascii", "replace"))
        except OSError:
            pass
    os._exit(128 + number)

"""The command `movingfrf`."""

from __future__ import annotations

import gc
import os
import sys
from contextlib import suppress

from cyclopts import CycloptsError

from movingfrf._basics.checks import SolveError
from movingfrf._basics.ending import heed, ignore, placed, written
from movingfrf.commands.root import Status, app
from movingfrf.commands.streams import StandardStream

# Module → its commands, in the order in which messages list them. A module is loaded when one of its commands is
# called for, or help is.
COMMANDS = (
    ("scenarios", "new", "check"),
    ("schema", "schema"),
    ("kinds", "kinds"),
    ("scenarios", "vehicles", "run", "random", "measure"),
    ("export", "export"),
    ("studies", "compare", "sweep", "paper"),
    ("optimise", "optimise"),
    ("profiles", "profile", "convert"),
)
for _module, *_names in COMMANDS:
    for _name in _names:
        app.command(f"movingfrf.commands.{_module}:{_name}")


def _load_for_help(arguments: list[str]) -> None:
    """Load every command where all of them are to be listed, each with what it does."""
    if not arguments or arguments[0] in app.help_flags:
        for _, *names in COMMANDS:
            for name in names:
                app[name]


def main(arguments: list[str] | None = None) -> int:
    """Run the command and return its exit status.

    Parameters
    ----------
    arguments : list of str, optional
        What follows the command's name; that of the process by default.

    Returns
    -------
    int
        Exit status.
    """
    placed.clear()
    said = ""
    try:
        _load_for_help(sys.argv[1:] if arguments is None else arguments)
        app(arguments, exit_on_error=False, print_error=False, result_action="return_value")
        sys.stdout.flush()
    except (CycloptsError, ValueError, SolveError) as error:
        said = str(error)
    except MemoryError:
        said = "the case does not fit into the memory of this machine"
    except BrokenPipeError:
        pass  # whoever read, as `head` does, has read enough
    except (ChildProcessError, ConnectionError) as error:
        said = str(error)  # of others that compute
    except OSError as error:
        said = _failed(error)
    except SystemExit:
        pass  # so does rich end a process where nobody reads what it prints
    if not said:
        return Status.DONE
    said = f"movingfrf: {said}"
    with suppress(OSError):
        if sys.stderr.isatty():
            from movingfrf.commands.console import for_reading

            said = for_reading(said, sys.stderr)
        print(said, file=sys.stderr)
    return Status.REFUSED


def _failed(error: OSError) -> str:
    """Say what cannot be read or written, and why."""
    place = f"{error.filename}: " if error.filename else ""
    there = f"; {written()}" if error.filename == StandardStream.OUTPUT and placed else ""
    return f"cannot read or write: {place}{error.strerror or error}{there}"


def entry() -> None:
    """Run the command as a process; told to end, it leaves nothing half done."""
    heed()
    # Loading makes hundreds of thousands of objects, which all stay: looking through them for what can go, as often
    # as Python does, takes an eighth of a short run.
    gc.set_threshold(100_000)
    # One that was closed takes nothing.
    sys.stdout = StandardStream(sys.stdout or open(os.devnull, "w"), StandardStream.OUTPUT)
    sys.stderr = StandardStream(sys.stderr or open(os.devnull, "w"), "standard error")
    status = main()
    ignore()
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError):
            stream.flush()
    # Everything is written and put away: to let go of a million objects one by one takes a seventh of a short run.
    os._exit(status)


if __name__ == "__main__":
    entry()

"""The command `movingfrf`."""

from __future__ import annotations

import os
import signal
import sys

from cyclopts import CycloptsError

from movingfrf._basics.checks import SolveError
from movingfrf.commands.root import Status, app

# Module → its commands, in the order in which messages list them. A module is loaded when one of its commands is
# called for, or help is.
COMMANDS = (
    ("scenarios", "new", "check"),
    ("schema", "schema"),
    ("kinds", "kinds"),
    ("scenarios", "vehicles", "run", "random", "measure"),
    ("export", "export"),
    ("studies", "compare", "paper"),
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
    try:
        _load_for_help(sys.argv[1:] if arguments is None else arguments)
        app(arguments, exit_on_error=False, print_error=False, result_action="return_value")
    except KeyboardInterrupt:
        print("movingfrf: interrupted, nothing was written", file=sys.stderr)
        return Status.INTERRUPTED
    except (CycloptsError, ValueError, SolveError) as error:
        print(f"movingfrf: {error}", file=sys.stderr)
        return Status.REFUSED
    except MemoryError:
        print("movingfrf: the case does not fit into the memory of this machine", file=sys.stderr)
        return Status.REFUSED
    except OSError as error:
        place = f"{error.filename}: " if error.filename else ""
        print(f"movingfrf: cannot read or write: {place}{error.strerror or error}", file=sys.stderr)
        return Status.REFUSED
    return Status.DONE


def entry() -> None:
    """Run the command as a process; told to end, it leaves nothing half done."""
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(Status.TERMINATED))
    status = main()
    if status == Status.INTERRUPTED:
        # An interrupt that strikes while a module is being loaded leaves a mark by which Python ends itself with
        # the signal after all, whatever the status.
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)
    sys.exit(status)


if __name__ == "__main__":
    entry()

"""Files whose library may crash on damage, or never come to an end: taken apart in a process of its own."""

from __future__ import annotations

import errno
import json
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from movingfrf._basics.undoing import carried_out


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """What a file may cost before it counts as damaged: conventions, both."""

    # What a library may take on any file [s]; its import takes one or two on a slow machine.
    patience: float = 20.0
    pace: float = 5e6  # what it reads in a second at the least [byte]


LIMITS = Limits()


def taken_apart(path: Path, folder: Path, child: str, most: int, kind: str) -> Any:
    """Let a program of this folder take a file apart.

    Parameters
    ----------
    path : Path
        The file.
    folder : Path
        Where the program writes what is in it, and `index.json` about that.
    child : str
        Name of the program. It ends with status 4 where it cannot write, with another where the file is damaged,
        and says why.
    most : int
        What it may take, in the program's own terms.
    kind : str
        What the file should be, for the message.

    Returns
    -------
    object
        What stands in `index.json`.

    Raises
    ------
    ValueError
        If the file is damaged.
    OSError
        If what is in it cannot be written into the folder.
    """
    program = str(Path(__file__).with_name(child))
    command = [sys.executable, "-P", program, str(path.resolve()), str(folder), str(most)]
    try:
        done = carried_out(command, timeout=LIMITS.patience + path.stat().st_size / LIMITS.pace)
    except subprocess.TimeoutExpired:
        raise ValueError("is damaged: reading it comes to no end") from None
    said = done.stderr.decode("utf-8", "replace").strip().splitlines()
    if done.returncode == 4:
        raise OSError(errno.ENOSPC, said[-1])
    index = folder / "index.json"
    if done.returncode or not index.exists():
        raise ValueError(f"is damaged, or no {kind}: {said[-1] if said else 'the library fails on it'}")
    return json.loads(index.read_text(encoding="utf-8"))

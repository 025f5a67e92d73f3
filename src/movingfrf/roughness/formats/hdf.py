"""Arrays in HDF5 files, which are behind netCDF 4 and MATLAB 7.3.

Some damaged files make the HDF5 library run forever, or crash, where nothing in the same process can stop it. So a
file is taken apart in a process of its own.
"""

from __future__ import annotations

import errno
import json
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.matlab_file import UNPACKING
from movingfrf._basics.undoing import carried_out, scratch
from movingfrf.roughness.formats.arrays import Array

SIGNATURE = b"\x89HDF\r\n\x1a\n"


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """What a file may cost before it counts as damaged: conventions, all three."""

    trailing: int = 4096  # what may stand behind the end of the data [byte]
    # What the library may take on any file [s]; its import takes one or two on a slow machine.
    patience: float = 20.0
    pace: float = 5e6  # what it reads in a second at the least [byte]


LIMITS = Limits()


class HdfContents(NamedTuple):
    """Arrays of real numbers, those in groups with their names before a slash, and texts about the whole."""

    arrays: dict[str, Array]
    attributes: dict[str, str]
    unread: dict[str, str]  # what else there is, and what it is


@contextmanager
def opened(path: Path) -> Iterator[HdfContents]:
    """Open a file for the time of the block.

    Parameters
    ----------
    path : Path
        The file.

    Yields
    ------
    HdfContents
        Arrays, which can be loaded within the block, and attributes.

    Raises
    ------
    ValueError
        If it is no such file, or damaged.
    OSError
        If there is no room to unpack it.
    """
    size = _require_bounds(path)
    most = UNPACKING.most(size)
    with scratch() as folder:
        child = Path(__file__).with_name("hdf_child.py")
        command = [sys.executable, "-P", str(child), str(path.resolve()), str(folder), str(most)]
        try:
            done = carried_out(command, timeout=LIMITS.patience + size / LIMITS.pace)
        except subprocess.TimeoutExpired:
            raise ValueError("is damaged: reading it comes to no end") from None
        if done.returncode == 4:
            raise OSError(errno.ENOSPC, f"there is no room to unpack it in {folder.parent}")
        index = folder / "index.json"
        if done.returncode or not index.exists():
            said = done.stderr.decode("utf-8", "replace").strip().splitlines()
            raise ValueError(f"is damaged, or no HDF5 file: {said[-1] if said else 'the HDF5 library fails on it'}")
        content = json.loads(index.read_text(encoding="utf-8"))
        arrays = {
            item["name"]: Array(tuple(item["shape"]), partial(_load, folder / f"{n}.npy"), item["unit"])
            for n, item in enumerate(content["arrays"])
        }
        yield HdfContents(arrays, content["attributes"], content["unread"])


def _load(file: Path) -> FloatArray:
    loaded: FloatArray = np.load(file)
    return loaded


def _require_bounds(path: Path) -> int:
    """Size of a file; one that does not end where it says makes the library lose memory and time."""
    with path.open("rb") as file:
        head = file.read(1024)
    block = head[max(head.find(SIGNATURE), 0) :]
    # Where the superblock holds the addresses of the beginning and the end of the data, by its version.
    addresses = {0: (24, 40), 1: (28, 44), 2: (12, 28), 3: (12, 28)}
    places = addresses.get(block[8]) if len(block) > 8 else None
    base, end = [int.from_bytes(block[at : at + 8], "little") for at in places or (0, 0)]
    size = path.stat().st_size
    if places is None or base > size or not max(size - LIMITS.trailing, 1) <= end <= size:
        raise ValueError("is damaged, cut short, or no HDF5 file: it does not end where it says")
    return size

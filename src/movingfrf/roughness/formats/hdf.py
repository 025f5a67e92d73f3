"""Arrays in HDF5 files, which are behind netCDF 4 and MATLAB 7.3.

Some damaged files make the HDF5 library run forever, or crash, where nothing in the same process can stop it. So a
file is taken apart in a process of its own.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.matlab_file import UNPACKING
from movingfrf._basics.undoing import scratch
from movingfrf.roughness.formats.apart import taken_apart
from movingfrf.roughness.formats.choice import Array

SIGNATURE = b"\x89HDF\r\n\x1a\n"


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
    with scratch("unpacked") as folder:
        content = taken_apart(path, folder, "hdf_child.py", most, "HDF5 file")
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
    trailing = 4096  # what may stand behind the end of the data [byte; a convention]
    size = path.stat().st_size
    if places is None or base > size or not max(size - trailing, 1) <= end <= size:
        raise ValueError("is damaged, cut short, or no HDF5 file: it does not end where it says")
    return size

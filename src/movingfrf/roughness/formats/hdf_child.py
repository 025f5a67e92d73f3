"""Takes the arrays out of an HDF5 file, in a process of its own: see `hdf`.

Arguments: the file, a folder to write into, and the most bytes that all arrays together may have. Writes each array
of real numbers as 0.npy, 1.npy and so on, and index.json about them. What is wrong with the file goes to standard
error, with exit status 3; 4 where the folder has no room.
"""

from __future__ import annotations

import io
import json
import sys
from pathlib import Path
from typing import Any

import h5py
import numpy as np

# What h5py raises where a file is damaged.
DAMAGED = (OSError, RuntimeError, KeyError, TypeError, OverflowError, SystemError, AttributeError, ValueError)


def text(value: Any) -> str:
    """Read text of an attribute; empty if it is something else."""
    if isinstance(value, bytes):
        return value.decode("utf-8", "replace")
    return value if isinstance(value, str) else ""


def numbers_attribute(item: h5py.Dataset, attribute: str) -> np.ndarray:
    """Read an attribute of numbers, of which netCDF has one or a few; none if it is something else."""
    value = np.asarray(item.attrs.get(attribute, ()))
    return value.astype(float).ravel() if value.dtype.kind in "iuf" else np.empty(0)


def values(item: h5py.Dataset) -> np.ndarray:
    """Read an array as netCDF means it: scaled, and nan where it is filled, missing or beyond what is valid."""
    stored = np.asarray(item[()]).astype(float)
    found = stored.copy()
    for none in (*numbers_attribute(item, "_FillValue"), *numbers_attribute(item, "missing_value")):
        found[stored == none] = np.nan
    ends = numbers_attribute(item, "valid_range")
    low, high = ends if ends.size == 2 else (-np.inf, np.inf)
    for least in (low, *numbers_attribute(item, "valid_min")):
        found[stored < least] = np.nan
    for most in (high, *numbers_attribute(item, "valid_max")):
        found[stored > most] = np.nan
    scale, offset = (numbers_attribute(item, name) for name in ("scale_factor", "add_offset"))
    with np.errstate(all="ignore"):  # whatever a damaged file says is looked at later
        return found * (scale[0] if scale.size == 1 else 1.0) + (offset[0] if offset.size == 1 else 0.0)


def extract(file: Path, folder: Path, most: float) -> None:
    """Write arrays and index."""
    no_numbers = ("char", "logical", "cell", "struct", "function_handle")
    listed: list[dict[str, Any]] = []
    with h5py.File(file, "r") as opened:
        for name, item in opened.items():
            if not isinstance(item, h5py.Dataset) or item.shape is None or item.dtype.kind not in "iuf":
                continue
            # MATLAB stores text, cells and the like as numbers too, and says so.
            if text(item.attrs.get("MATLAB_class", "")) in no_numbers:
                continue
            needed = 8.0 * float(np.prod(item.shape, dtype=float))
            if needed > most:
                raise ValueError(
                    f"the array {name!r} claims {needed / 2**20:.4g} MiB, far more than the file can hold: it is "
                    "damaged, or packed so tightly that it must be unpacked elsewhere first"
                )
            most -= needed
            made = io.BytesIO()
            np.save(made, values(item))
            keep(folder / f"{len(listed)}.npy", made.getbuffer())
            listed.append({"name": name, "shape": item.shape, "unit": text(item.attrs.get("units", ""))})
        attributes = {name: text(opened.attrs.get(name, "")) for name in ("source", "steps")}
    keep(folder / "index.json", json.dumps({"arrays": listed, "attributes": attributes}).encode())


def keep(place: Path, content: bytes | memoryview) -> None:
    """Write a file; NumPy would leave a part of it where the disk is full, and say nothing."""
    try:
        place.write_bytes(content)
    except OSError:
        sys.exit(4)


if __name__ == "__main__":
    try:
        extract(Path(sys.argv[1]), Path(sys.argv[2]), float(sys.argv[3]))
    except DAMAGED as error:
        print(error, file=sys.stderr)
        sys.exit(3)

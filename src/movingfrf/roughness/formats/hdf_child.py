"""Takes the arrays out of an HDF5 file, in a process of its own: see `hdf`.

Arguments: the file, a folder to write into, and the most bytes that all arrays together may have. Writes each array
of real numbers as 0.npy, 1.npy and so on, and index.json about them. What is wrong with the file goes to standard
error, with exit status 3; 4 where the folder has no room.
"""

from __future__ import annotations

import io
import json
import sys
from collections.abc import Iterator
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


def unit_of(item: h5py.Dataset) -> str:
    """Read the unit, whatever its attribute is called, and whether it is a text or an array of one."""
    found = (np.asarray(item.attrs[name]).ravel() for name in item.attrs if name.lower() in ("units", "unit"))
    return next((text(value[0]) for value in found if value.size == 1), "")


def numbers_attribute(item: h5py.Dataset, attribute: str, like: np.dtype | None = None) -> np.ndarray:
    """Read an attribute of numbers, of which netCDF has one or a few; none if it is something else.

    `like` is the type of the array that they are compared with: rounded as its values are, and without a sign where
    they have none.
    """
    value = np.asarray(item.attrs.get(attribute, ()))
    if value.dtype.kind in "SUO" and value.size == 1:  # some write the number as text
        try:
            value = np.asarray(float(text(value.ravel()[0])))
        except ValueError:
            return np.empty(0)
    if value.dtype.kind not in "iuf":
        return np.empty(0)
    if like is not None and like.kind == "f":
        value = value.astype(like)
    if like is not None and like.kind == "u" and value.dtype.kind == "i":
        value = value.astype(like.newbyteorder("=").str.replace("u", "i")).view(like.newbyteorder("="))
    return value.astype(float).ravel()


def values(item: h5py.Dataset) -> np.ndarray:
    """Read an array as netCDF means it: scaled, and nan where it is filled, missing or beyond what is valid."""
    raw = np.asarray(item[()])
    if raw.dtype.kind == "i" and text(item.attrs.get("_Unsigned", "")).lower() == "true":
        raw = raw.view(raw.dtype.str.replace("i", "u"))
    stored, like = raw.astype(float), raw.dtype
    scale, offset = (numbers_attribute(item, name) for name in ("scale_factor", "add_offset"))
    with np.errstate(all="ignore"):  # whatever a damaged file says is looked at later
        found = stored * (scale[0] if scale.size == 1 else 1.0) + (offset[0] if offset.size == 1 else 0.0)
        for name in ("_FillValue", "missing_value"):
            for none in numbers_attribute(item, name, like):
                found[stored == none] = np.nan
        # What the netCDF library fills in where nothing was written and nothing else is said.
        if like.kind == "f" and "_FillValue" not in item.attrs:
            found[stored == np.array(9.969209968386869e36).astype(like).astype(float)] = np.nan
        for name in ("valid_range", "valid_min", "valid_max"):
            ends = numbers_attribute(item, name, like)
            # Limits are about packed values, but for whole numbers with limits that have decimals.
            packed = like.kind == "f" or np.asarray(item.attrs.get(name, 0)).dtype.kind != "f"
            about = stored if packed else found
            if name == "valid_range" and ends.size == 2:
                found[(about < ends[0]) | (about > ends[1])] = np.nan
            elif name == "valid_min" and ends.size == 1:
                found[about < ends[0]] = np.nan
            elif name == "valid_max" and ends.size == 1:
                found[about > ends[0]] = np.nan
    return found


def items(group: h5py.Group, within: str = "", depth: int = 0) -> Iterator[tuple[str, Any]]:
    """Arrays and what else there is, those in groups too, with the names of these before a slash."""
    deepest = 8  # groups within groups, which may hold themselves [a convention]
    for name, item in group.items():
        if isinstance(item, h5py.Group) and depth < deepest:
            if not name.startswith("#"):  # where MATLAB puts what it refers to
                yield from items(item, f"{within}{name}/", depth + 1)
        else:
            yield f"{within}{name}", item


def extract(file: Path, folder: Path, most: float) -> None:
    """Write arrays and index."""
    no_numbers = {"cell": "a cell array", "struct": "an array of structs", "table": "a table"}
    nothing = ("char", "logical", "function_handle")
    listed: list[dict[str, Any]] = []
    unread: dict[str, str] = {}
    with h5py.File(file, "r") as opened:
        for name, item in items(opened):
            if not isinstance(item, h5py.Dataset) or item.shape is None:
                continue
            # MATLAB stores text, cells and the like as numbers too, and says so.
            kind = text(item.attrs.get("MATLAB_class", ""))
            if kind in no_numbers or (item.dtype.kind == "O" and h5py.check_ref_dtype(item.dtype)):
                unread[name] = no_numbers.get(kind, "references to something else")
                continue
            # What gives a dimension of netCDF its length holds no numbers.
            empty = text(item.attrs.get("NAME", "")).startswith("This is a netCDF dimension but not a netCDF var")
            if kind in nothing or empty or item.dtype.kind not in "iuf":
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
            listed.append({"name": name, "shape": item.shape, "unit": unit_of(item)})
        attributes = {name: text(opened.attrs.get(name, "")) for name in ("source", "steps")}
    content = {"arrays": listed, "attributes": attributes, "unread": unread}
    keep(folder / "index.json", json.dumps(content).encode())


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

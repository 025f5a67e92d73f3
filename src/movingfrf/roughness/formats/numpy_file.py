"""NumPy files: of named arrays, .npz, and of one array, .npy."""

from __future__ import annotations

import io
import zipfile
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from movingfrf._basics import numpy_file
from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.output import Content
from movingfrf.roughness.formats import arrays
from movingfrf.roughness.formats.base import Format, RawProfile, Wanted, bytes_of
from movingfrf.roughness.formats.choice import Array
from movingfrf.roughness.profile import Profile


def read(path: Path, wanted: Wanted) -> RawProfile:
    """Read distance and elevation, or the arrays that are named, and where they come from."""
    stored = numpy_file.stored_arrays(_packed(bytes_of(path)))
    numbers = {
        name: Array(each.shape, partial(_floats, each))
        for name, each in stored.items()
        if each.kind in tuple("fiu")
    }
    unread = {name: "no plain array of real numbers" for name, each in stored.items() if each.kind in ("", "c")}
    texts = {name: _text(each) for name, each in stored.items() if "unit" in name.lower()}
    found = arrays.raw_profile(numbers, wanted, "NumPy file", unread, texts)
    source, steps = (_text(stored.get(name)) for name in ("source", "steps"))
    return found._replace(source=source, steps=tuple(step for step in steps.split("\n") if step))


def _packed(data: bytes) -> bytes:
    """Put a single array among named ones."""
    if not data.startswith(b"\x93NUMPY"):
        return data
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w") as archive:
        archive.writestr("array.npy", data)
    return made.getvalue()


def _floats(stored: numpy_file.Stored) -> FloatArray:
    values: FloatArray = stored.load().astype(float, copy=False)
    return values


def _text(stored: numpy_file.Stored | None) -> str:
    """Read a text; empty where there is none."""
    if stored is None or stored.kind != "U" or stored.shape:
        return ""
    text = str(stored.load())
    text.encode()  # refuses half a character
    return text


def made(profile: Profile, encoding: str = "") -> dict[str, Content]:
    """Hold distance, elevation, lateral positions, source and steps."""
    names = arrays.ARRAY_NAMES
    values: dict[str, Any] = {names.stations: profile.stations, names.elevations: np.asarray(profile.elevation)}
    if profile.across is not None:
        values[names.across] = np.array(profile.across)
    values |= {"source": np.array(profile.source), "steps": np.array("\n".join(profile.steps))}
    return {"": numpy_file.as_npz(values)}


FORMAT = Format(
    "npz",
    "NumPy",
    (".npz", ".npy"),
    lambda head: head.startswith(b"\x93NUMPY") or (head.startswith(b"PK\x03\x04") and b".npy" in head[:300]),
    read,
    made,
    several=True,
    takes=("units",),
)

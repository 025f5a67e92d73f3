"""NumPy files of named arrays, .npz, read array by array: a damaged one ends in an error, whatever it claims."""

from __future__ import annotations

import ast
import io
import math
import re
import struct
import zipfile
import zlib
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import IO, Any, NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.matlab_file import UNPACKING
from movingfrf.roughness.formats import arrays
from movingfrf.roughness.formats.base import ColumnKey, Format, RawProfile, bytes_of
from movingfrf.roughness.profile import Profile

MAGIC = b"\x93NUMPY"

# Types of real numbers and of text, as NumPy's headers call them.
NUMBERS = re.compile(r"[<>|]?(f[248]|[iu][1248])")
TEXT = re.compile(r"([<>])U(\d{1,6})")

# What takes a damaged archive apart may raise.
DAMAGED = (zipfile.BadZipFile, zlib.error, struct.error, EOFError, OSError, NotImplementedError, RuntimeError)


class Stored(NamedTuple):
    """An array in an archive: what its header says, and how many bytes stand before its values."""

    entry: zipfile.ZipInfo
    kind: str
    shape: tuple[int, ...]
    by_columns: bool
    header: int

    def values(self, archive: zipfile.ZipFile) -> bytes:
        """Bytes of all values."""
        return _unpacked(archive, self.entry)[self.header :]

    def load(self, archive: zipfile.ZipFile) -> FloatArray:
        """Values as numbers."""
        flat = np.frombuffer(self.values(archive), self.kind)
        if flat.size != math.prod(self.shape):
            raise ValueError(f"{self.entry.filename} holds {flat.size} values, but claims {self.shape}")
        return flat.astype(float).reshape(self.shape, order="F" if self.by_columns else "C")


def read(path: Path, columns: Sequence[ColumnKey] | None) -> RawProfile:
    """Read distance and elevation, or the arrays that are named, and where they come from."""
    data = bytes_of(path)
    try:
        archive = zipfile.ZipFile(io.BytesIO(data))
        entries = [entry for entry in archive.infolist() if entry.filename.endswith(".npy")]
        if sum(entry.file_size for entry in entries) > UNPACKING.most(len(data)):
            raise ValueError(f"unpacks to more than {UNPACKING.times} times its size: unpack it elsewhere first")
        stored = {entry.filename.removesuffix(".npy"): _stored(archive, entry) for entry in entries}
        numbers = {
            name: arrays.Array(each.shape, partial(each.load, archive))
            for name, each in stored.items()
            if NUMBERS.fullmatch(each.kind)
        }
        found = arrays.raw_profile(numbers, columns, "NumPy file")
        source, steps = (_text(archive, stored.get(name)) for name in ("source", "steps"))
    except DAMAGED as error:
        raise ValueError(f"is damaged, or no NumPy file: {error}") from None
    return found._replace(source=source, steps=tuple(step for step in steps.split("\n") if step))


def _stored(archive: zipfile.ZipFile, entry: zipfile.ZipInfo) -> Stored:
    """Read the header of an array."""
    longest = 10_000  # of a header [byte; as NumPy has it]
    with _opened(archive, entry) as file:
        start = file.read(12)
        if start[:6] != MAGIC or len(start) < 12 or start[6] not in (1, 2, 3):
            raise ValueError(f"is damaged: {entry.filename} is no NumPy array")
        places = slice(8, 10) if start[6] == 1 else slice(8, 12)
        length = int.from_bytes(start[places], "little")
        header = start[places.stop :] + file.read(min(length, longest) - (12 - places.stop))
    try:
        said = ast.literal_eval(header.decode("latin-1").strip())
        kind, by_columns, shape = said["descr"], said["fortran_order"], tuple(said["shape"])
    except (ValueError, SyntaxError, TypeError, KeyError, MemoryError, RecursionError):
        raise ValueError(f"is damaged: the header of {entry.filename} cannot be read") from None
    if not all(type(side) is int and side >= 0 for side in shape):
        raise ValueError(f"is damaged: {entry.filename} cannot have the shape {shape}")
    return Stored(entry, str(kind), shape, bool(by_columns), places.stop + length)


def _opened(archive: zipfile.ZipFile, entry: zipfile.ZipInfo) -> IO[bytes]:
    """Open an entry that is packed as NumPy packs."""
    if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        raise ValueError(f"is damaged: {entry.filename} is packed in a way that NumPy does not know")
    return archive.open(entry)


def _unpacked(archive: zipfile.ZipFile, entry: zipfile.ZipInfo) -> bytes:
    with _opened(archive, entry) as file:
        content: bytes = file.read()
    return content


def _text(archive: zipfile.ZipFile, stored: Stored | None) -> str:
    """Read a text, which NumPy stores as characters of four bytes; empty where there is none."""
    kind = TEXT.fullmatch(stored.kind) if stored else None
    if stored is None or kind is None or stored.shape:
        return ""
    order = "utf-32-le" if kind[1] == "<" else "utf-32-be"
    return stored.values(archive).decode(order).rstrip("\0")


def write(profile: Profile, path: Path, encoding: str = "") -> None:
    """Write distance, elevation, lateral positions, source and steps."""
    names = arrays.ARRAY_NAMES
    values: dict[str, Any] = {names.stations: profile.stations, names.elevations: np.asarray(profile.elevation)}
    if profile.across is not None:
        values[names.across] = np.array(profile.across)
    values |= {"source": np.array(profile.source), "steps": np.array("\n".join(profile.steps))}
    with path.open("wb") as file:  # NumPy appends an ending to a name that lacks it
        np.savez(file, **values)


FORMAT = Format(
    "npz",
    "NumPy",
    (".npz",),
    lambda head: head.startswith(b"PK\x03\x04") and b".npy" in head[:300],
    read,
    write,
)

"""NumPy files of named arrays, .npz, read array by array: a damaged one ends in an error, whatever it claims."""

from __future__ import annotations

import ast
import io
import math
import re
import struct
import zipfile
import zlib
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from typing import IO, Any, NamedTuple

import numpy as np

from movingfrf._basics.matlab_file import UNPACKING

# Types of numbers, truth and text, as NumPy's headers call them.
KINDS = re.compile(r"[<>|]?(f[248]|[iu][1248]|c8|c16|b1|U[1-9]\d{0,5})")


def as_npz(arrays: Mapping[str, Any]) -> bytes:
    """Make a file of arrays.

    Parameters
    ----------
    arrays : dict of str to array_like
        By name.

    Returns
    -------
    bytes
        The file.
    """
    made = io.BytesIO()
    np.savez(made, **arrays)
    return made.getvalue()


class Stored(NamedTuple):
    """An array that is not read before it is needed."""

    shape: tuple[int, ...]
    kind: str  # f, i or u: real numbers, c complex ones, b truth, U text; empty: none that is read
    load: Callable[[], Any]


class Header(NamedTuple):
    """What stands before the values of an array: their type, how they are arranged, and its own length."""

    kind: str
    shape: tuple[int, ...]
    by_columns: bool
    length: int  # [bytes]


def stored_arrays(data: bytes) -> dict[str, Stored]:
    """Take apart a NumPy file of named arrays.

    Parameters
    ----------
    data : bytes
        The file.

    Returns
    -------
    dict of str to Stored
        By name; loaded when asked for, which may raise as well.

    Raises
    ------
    ValueError
        If it is no such file, damaged, or unpacks to far more than it weighs.
    """
    with _damage():
        archive = zipfile.ZipFile(io.BytesIO(data))
        entries = [entry for entry in archive.infolist() if entry.filename.endswith(".npy")]
        if sum(entry.file_size for entry in entries) > UNPACKING.most(len(data)):
            raise ValueError(f"unpacks to more than {UNPACKING.times} times its size: unpack it elsewhere first")
        found = {}
        for entry in entries:
            header = _header(archive, entry)
            kind = np.dtype(header.kind).kind if KINDS.fullmatch(header.kind) else ""
            load = partial(_values, archive, entry, header)
            found[entry.filename.removesuffix(".npy")] = Stored(header.shape, kind, load)
        return found


@contextmanager
def _damage() -> Iterator[None]:
    """Make an error with a reason of all that taking a damaged archive apart may raise."""
    try:
        yield
    except (zipfile.BadZipFile, zlib.error, struct.error, EOFError, OSError, RuntimeError) as error:
        raise ValueError(f"is damaged, or no NumPy file: {error}") from None


def _header(archive: zipfile.ZipFile, entry: zipfile.ZipInfo) -> Header:
    longest = 10_000  # of a header [byte; as NumPy has it]
    with _opened(archive, entry) as file:
        start = file.read(12)
        if start[:6] != b"\x93NUMPY" or len(start) < 12 or start[6] not in (1, 2, 3):
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
    return Header(str(kind), shape, bool(by_columns), places.stop + length)


def _values(archive: zipfile.ZipFile, entry: zipfile.ZipInfo, header: Header) -> Any:
    if not KINDS.fullmatch(header.kind):
        raise ValueError(f"{entry.filename} holds neither numbers nor texts, but {header.kind[:30]!r}")
    with _damage(), _opened(archive, entry) as file:
        content = file.read()[header.length :]
    kind = np.dtype(header.kind)
    flat = np.frombuffer(content, kind)
    if flat.size != math.prod(header.shape):
        raise ValueError(f"{entry.filename} holds {flat.size} values, but claims {header.shape}")
    own = flat.astype(kind.newbyteorder("="))
    return own.reshape(header.shape, order="F" if header.by_columns else "C")


def _opened(archive: zipfile.ZipFile, entry: zipfile.ZipInfo) -> IO[bytes]:
    """Open an entry that is packed as NumPy packs."""
    if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        raise ValueError(f"is damaged: {entry.filename} is packed in a way that NumPy does not know")
    return archive.open(entry)

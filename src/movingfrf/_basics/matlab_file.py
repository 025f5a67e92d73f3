"""MATLAB files of version 5 (to 7.2), read number by number: a damaged one ends in an error, whatever it claims."""

from __future__ import annotations

import io
import struct
import zlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray


@dataclass(frozen=True, slots=True, kw_only=True)
class Unpacking:
    """How much of a file is unpacked; in brackets, between what each number is safe."""

    # What a file may unpack to: so many times its own size, or this many bytes if that is more. A damaged count or
    # a packed bomb claims more [a convention].
    times: int = 10
    least: int = 2**27
    # Bytes that tell an array's name and size: 112 of a matrix whose name has 63 letters, the most [128 and more].
    beginning: int = 1024

    def most(self, size: int) -> int:
        """Bytes that a file of this size may unpack to."""
        return max(self.times * size, self.least)


UNPACKING = Unpacking()


@dataclass(frozen=True, slots=True, kw_only=True)
class Level5:
    """Numbers of the level 5 format: a header of text that ends in version and byte order, then elements.

    An element has type, size and data.
    """

    header: int  # bytes
    # Types of elements.
    matrix: int
    compressed: int
    numbers: Mapping[int, str]  # how numpy calls them
    # Classes of arrays; numeric ones are double, single, and whole numbers of all sizes.
    numeric: range
    cell: int
    structs: tuple[int, ...]  # and objects, which are stored alike
    text: int
    sparse: int
    opaque: int  # it has its name where others have their size
    others: Mapping[int, str]  # what is not read, in words
    complex_flag: int  # beside the class
    # What names may not be in MATLAB, and how many letters they have at most.
    reserved: frozenset[str]
    longest_name: int
    int8: int  # type of an element
    deepest: int  # structs within structs [a convention]


LEVEL_5 = Level5(
    header=128,
    matrix=14,
    compressed=15,
    numbers={1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8"},
    numeric=range(6, 16),
    cell=1,
    structs=(2, 3),
    text=4,
    sparse=5,
    opaque=17,
    others={
        2: "a struct in very many others",
        3: "an object in very many others",
        5: "a sparse matrix of complex numbers",
        16: "a function",
        17: "an object, as a table or strings; save its columns, table2struct(…, 'ToScalar', true), or cellstr(…)",
    },
    complex_flag=0x0800,
    reserved=frozenset(
        "break case catch classdef continue else elseif end for function global if otherwise parfor persistent "
        "return spmd switch try while".split()
    ),
    longest_name=63,
    int8=1,
    deepest=8,
)


class Element(NamedTuple):
    """One element: its type, its data as far as they are there, and how many bytes there should be."""

    kind: int
    data: bytes
    size: int


class Stored(NamedTuple):
    """An array that is not read before it is needed."""

    shape: tuple[int, ...]
    load: Callable[[], FloatArray]


class Contents(NamedTuple):
    """What a file holds, by name; numbers and texts are read when asked for."""

    numbers: dict[str, Stored]
    texts: dict[str, Callable[[], list[str]]]
    # Numbers in the fields of structs, `road.distance`; of several structs in one array, `road(2).distance`.
    # Their texts stand among the others, under such names.
    fields: dict[str, Stored]
    unread: dict[str, str]  # what else there is, and what it is


def arrays_and_texts(data: bytes) -> Contents:
    """Take apart a MATLAB file of version 5 (up to 7.2).

    Parameters
    ----------
    data : bytes
        The file.

    Returns
    -------
    Contents
        Arrays of real numbers, also those in structs, and texts: arrays of characters, and cells that hold such.

    Raises
    ------
    ValueError
        If it is no such file, or damaged.
    """
    order = {b"IM": "<", b"MI": ">"}.get(data[126:128])
    if order is None:
        raise ValueError("is no MATLAB file of version 5 or 7.3; save it anew with -v7 or -v7.3")
    found = Contents({}, {}, {}, {})
    for element in _elements(memoryview(data)[LEVEL_5.header :], order):
        read_all = partial(_unpacked, element, len(data))
        kind, packed = element.kind, element.kind == LEVEL_5.compressed
        beginning = _unpacked(element, len(data), UNPACKING.beginning) if packed else element.data
        if packed:
            kind, beginning, _ = next(_elements(memoryview(beginning), order, partly=True), Element(0, b"", 0))
        if kind == LEVEL_5.matrix:
            _sort_in(found, _Matrix(read_all, packed, order, beginning), "")
    return found


class _Matrix(NamedTuple):
    """An array of any class, and how to read all of it."""

    read_all: Callable[[], bytes]
    packed: bool
    order: str
    beginning: bytes

    def parts(self, most: int = 2**31) -> list[Element]:
        """Elements that it consists of: flags, sizes, name and what its class has."""
        data = memoryview(self.read_all())
        return list(
            _elements(
                memoryview(next(_elements(data, self.order)).data) if self.packed else data, self.order, most=most
            )
        )


def _sort_in(found: Contents, matrix: _Matrix, within: str, depth: int = 0) -> None:
    """Put an array where it belongs by its class; what a struct holds is called by its own name and the field's."""
    order = matrix.order
    parts = list(_elements(memoryview(matrix.beginning), order, partly=True, most=3))
    if len(parts) < 3 or len(parts[0].data) < 4:
        return
    (flags,) = struct.unpack(f"{order}I", parts[0].data[:4])
    kind = flags & 0xFF
    name = within or bytes(parts[1 if kind == LEVEL_5.opaque else 2].data).decode("latin-1")
    shape = tuple(np.frombuffer(parts[1].data, f"{order}i4").tolist()) if len(parts[1].data) % 4 == 0 else None
    if kind in (*LEVEL_5.numeric, LEVEL_5.sparse) and not flags & LEVEL_5.complex_flag and shape is not None:
        stored = Stored(shape, partial(_sparse if kind == LEVEL_5.sparse else _numbers, matrix, shape, name))
        (found.fields if within else found.numbers)[name] = stored
    elif kind in (LEVEL_5.cell, LEVEL_5.text):
        found.texts[name] = partial(_texts, matrix, kind, shape)
        if kind == LEVEL_5.cell:
            found.unread[name] = "a cell array"
    elif kind in LEVEL_5.structs and depth < LEVEL_5.deepest:
        _open_struct(found, matrix, name, depth)
    else:
        found.unread[name] = LEVEL_5.others.get(kind, "an array of complex numbers")


def _open_struct(found: Contents, matrix: _Matrix, name: str, depth: int) -> None:
    order, parts = matrix.order, matrix.parts()
    objects = len(parts) > 3 and parts[3].kind == LEVEL_5.int8  # they have a name of their class there
    parts = parts[:3] + parts[3 + objects :]
    if len(parts) < 5 or len(parts[3].data) < 4:
        raise ValueError(f"is damaged: the struct {name!r} has no fields")
    (length,) = struct.unpack(f"{order}i", parts[3].data[:4])
    if length < 1:
        raise ValueError(f"is damaged: the struct {name!r} has names of {length} bytes")
    text = bytes(parts[4].data)
    names = [text[at : at + length].partition(b"\0")[0].decode("latin-1") for at in range(0, len(text), length)]
    fields = parts[5:]
    for n, part in enumerate(fields if names else ()):
        own = name if len(fields) <= len(names) else f"{name}({n // len(names) + 1})"
        inner = _Matrix(partial(_itself, part.data), False, order, part.data)
        _sort_in(found, inner, f"{own}.{names[n % len(names)]}", depth + 1)


def _itself(data: bytes) -> bytes:
    return data


def _texts(matrix: _Matrix, kind: int, shape: tuple[int, ...] | None) -> list[str]:
    """Texts in the rows of an array of characters, all of one length, or in the cells of an array."""
    order, parts = matrix.order, matrix.parts()[3:]
    if kind == LEVEL_5.text:
        whole = "".join(_decoded(part, order) for part in parts[:1])
        rows = shape[0] if shape and len(whole) == np.prod(shape, dtype=object) else 1
        return [whole[row::rows].strip() for row in range(rows)]
    cells = [list(_elements(memoryview(part.data), order)) for part in parts if part.kind == LEVEL_5.matrix]
    return [_decoded(cell[3], order).strip() for cell in cells if len(cell) > 3]


def _decoded(part: Element, order: str) -> str:
    utf_16 = {"<": "utf-16-le", ">": "utf-16-be"}[order]
    encoding = {2: "latin-1", 16: "utf-8", 4: utf_16, 17: utf_16}.get(part.kind)
    if encoding is None:
        raise ValueError(f"is damaged: a text is stored as type {part.kind}")
    return bytes(part.data).decode(encoding, "replace")


def _elements(data: memoryview, order: str, *, partly: bool = False, most: int = 2**31) -> Iterator[Element]:
    """Elements one after the other; `partly` lets the last one be cut short."""
    at = count = 0
    while at + 8 <= len(data) and count < most:
        kind, size = struct.unpack_from(f"{order}II", data, at)
        if kind >> 16:  # a small one: size and type in four bytes, the data in the next four
            kind, size, start, end = kind & 0xFFFF, kind >> 16, at + 4, at + 8
            if size > 4:
                raise ValueError(f"is damaged: an element of 4 bytes claims {size}")
        else:
            start = at + 8
            # Packed elements follow each other without a gap, all others at multiples of 8 bytes.
            end = start + (size if kind == LEVEL_5.compressed else -(-size // 8) * 8)
        if start + size > len(data) and not partly:
            raise ValueError(f"is damaged: an element claims {size} bytes, but {len(data) - start} are left")
        yield Element(kind, data[start : start + size], size)  # type: ignore[arg-type]
        at, count = end, count + 1


def _unpacked(element: Element, file_size: int, most: int = 0) -> bytes:
    """Unpack an element, all of it or its beginning, but no more than a file of this size can hold in earnest."""
    if element.kind != LEVEL_5.compressed:
        return element.data
    limit = UNPACKING.most(file_size)
    packed = zlib.decompressobj()
    try:
        data = packed.decompress(element.data, most or limit)
    except zlib.error as error:
        raise ValueError(f"is damaged: {error}") from None
    if not most and packed.unconsumed_tail:
        raise ValueError(f"unpacks to more than {UNPACKING.times} times its size: unpack it elsewhere first")
    return data


def _numbers(matrix: _Matrix, shape: tuple[int, ...], name: str) -> FloatArray:
    (values,) = _listed(matrix, name, 1)
    if len(shape) < 2 or min(shape) < 0 or np.prod(shape, dtype=object) != values.size:
        raise ValueError(f"is damaged: the array {name!r} of shape {shape} has {values.nbytes} bytes")
    return values.astype(float).reshape(shape, order="F")


def _sparse(matrix: _Matrix, shape: tuple[int, ...], name: str) -> FloatArray:
    """Fill a matrix from its columns: rows, where in them each column begins, and values."""
    rows, begins, values = _listed(matrix, name, 3)
    if len(shape) != 2 or min(shape) < 0 or 8 * np.prod(shape, dtype=object) > UNPACKING.least:
        raise ValueError(f"has a sparse matrix {name!r} of shape {shape}, too large to be filled")
    whole = rows.dtype.kind in "iu" and begins.dtype.kind in "iu" and begins.size == shape[1] + 1
    rows, begins = (each.astype(np.int64) if whole else np.zeros(1, np.int64) for each in (rows, begins))
    lengths, used = np.diff(begins), int(begins[-1])
    sound = whole and not begins[0] and (lengths >= 0).all() and used <= min(rows.size, values.size)
    if not sound or ((rows[:used] < 0) | (rows[:used] >= shape[0])).any():
        raise ValueError(f"is damaged: the sparse matrix {name!r} of shape {shape} does not fit its entries")
    filled = np.zeros(shape)
    filled[rows[:used], np.repeat(np.arange(shape[1]), lengths)] = values[:used]
    return filled


def _listed(matrix: _Matrix, name: str, count: int) -> list[np.ndarray]:
    """Numbers as they are stored, list by list."""
    parts = matrix.parts(most=3 + count)[3:]
    if len(parts) < count or any(part.kind not in LEVEL_5.numbers for part in parts):
        raise ValueError(f"is damaged: the array {name!r} has no numbers")
    stored = [np.dtype(f"{matrix.order}{LEVEL_5.numbers[part.kind]}") for part in parts]
    if any(part.size % kind.itemsize for part, kind in zip(parts, stored, strict=True)):
        raise ValueError(f"is damaged: the array {name!r} has parts of numbers")
    return [np.frombuffer(part.data, kind) for part, kind in zip(parts, stored, strict=True)]


def recognised(head: bytes) -> bool:
    """Tell from the first bytes of a file whether it is one of version 5.

    Parameters
    ----------
    head : bytes
        At least 128 bytes.

    Returns
    -------
    bool
        Whether it says so.
    """
    return head.startswith(b"MATLAB ") and head[126:128] in (b"IM", b"MI")


def as_mat(arrays: Mapping[str, Any], *, packed: bool = False) -> bytes:
    """Make a file of arrays, texts and structures, equal for equal content.

    Parameters
    ----------
    arrays : dict of str to array_like or dict
        By name.
    packed : bool
        Whether to compress it.

    Returns
    -------
    bytes
        The file.
    """
    from scipy.io import savemat

    made = io.BytesIO()
    savemat(made, arrays, do_compression=packed, oned_as="column", long_field_names=True)
    made.seek(0)
    made.write(b"MATLAB 5.0 MAT-file, written by movingfrf".ljust(116))  # in place of text that tells the time
    return made.getvalue()

"""Named arrays in files: NumPy's .npz and MATLAB's .mat, read without trust and written."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from movingfrf._basics import matlab_file, numpy_file
from movingfrf._basics.checks import Checks, checking
from movingfrf._basics.output import write_whole


@dataclass(frozen=True, slots=True, kw_only=True)
class Content:
    """What a file holds.

    Parameters
    ----------
    what : str
        What the arrays make, with its article, for messages.
    largest : int
        What a file may weigh at most [bytes]; what it may unpack to, its reader says.
    needed, others : collection of str
        Names of the arrays that it must hold, and of what may stand beside them.
    texts : collection of str
        Names under which texts are read; others are met with an empty list in their place.
    """

    what: str
    largest: int
    needed: Collection[str]
    others: Collection[str]
    texts: Collection[str]

    @property
    def known(self) -> tuple[str, ...]:
        """Every name that it may hold."""
        return (*self.needed, *self.others)

    def check_names(self, check: Checks, arrays: Collection[str]) -> None:
        """Refuse what is missing, and what is not known in one sentence."""
        for name in self.needed:
            if name not in arrays:
                check.refuse(name, "is missing")
        if unknown := [name for name in arrays if name not in self.known]:
            them = "are not known: leave them out or rename them" if len(unknown) > 1 else "is not known"
            check.refuse(", ".join(unknown), f"{them}; {self.what} consists of {', '.join(self.known)}")


# Arrays by name.
Arrays = dict[str, Any]
Reader = Callable[[Path, Content], Arrays]


def read_arrays(file: str | Path, content: Content, others: Mapping[str, Reader] | None = None) -> Arrays:
    """Read the arrays of a file, `.mat` (MATLAB, up to version 7.2) or `.npz` (NumPy).

    Parameters
    ----------
    file : str or Path
        The file.
    content : Content
        What it holds.
    others : dict of str to callable, optional
        Endings that are read as well, and what reads them.

    Returns
    -------
    dict of str to array_like
        By name.

    Raises
    ------
    ValueError
        If the file cannot be read, is too large, or has another ending.
    """
    with checking() as check:
        path = check.file("file", file)
    readers = {".mat": _read_mat, ".npz": _read_npz, **(others or {})}
    if path.suffix.lower() not in readers:
        raise ValueError(
            f"{path}: {content.what} is read from {', '.join(readers)}, not from {path.suffix or 'no ending'}"
        )
    try:
        if path.stat().st_size > content.largest:
            raise ValueError(f"{path}: is larger than {content.largest // 2**20} MiB, too large for {content.what}")
        return readers[path.suffix.lower()](path, content)
    except OSError as error:
        raise ValueError(f"cannot read {path}: {error.strerror or error}") from None


def write_arrays(file: str | Path, arrays: Mapping[str, Any], what: str) -> None:
    """Write arrays to a file, `.mat` or `.npz`; replaced if it is there.

    Parameters
    ----------
    file : str or Path
        The file.
    arrays : dict of str to array_like
        By name.
    what : str
        What they make, with its article, for messages.

    Raises
    ------
    ValueError
        If the ending is another one.
    OSError
        If the file cannot be written; then what was there is there still.
    """
    with checking() as check:
        path = check.file("file", file)
    if path.suffix.lower() == ".npz":
        made = numpy_file.as_npz(arrays)
    elif path.suffix.lower() == ".mat":
        # Texts become cells.
        texts = [name for name, array in arrays.items() if np.asarray(array).dtype.kind == "U"]
        cells = {name: np.asarray(arrays[name]).astype(object) for name in texts}
        made = matlab_file.as_mat({**arrays, **cells})
    else:
        raise ValueError(f"{path}: {what} is written to .mat or .npz, not to {path.suffix or 'no ending'}")
    write_whole(path, made)


def _read_mat(path: Path, content: Content) -> Arrays:
    data = path.read_bytes()
    if data.startswith(b"MATLAB 7.3"):
        raise ValueError(f"{path}: is a MATLAB 7.3 file; save it with -v7")
    try:
        found = matlab_file.arrays_and_texts(data)
        inside = _within(found, content)
        at = len(inside)
        for name, words in found.unread.items():
            if name[at:] in content.known and name not in found.texts and name.startswith(inside):
                raise ValueError(f"holds as {name} {words}, which is not read")
        loads = {name: stored.load for name, stored in (found.numbers | found.fields).items()}
        texts = {name: load if name[at:] in content.texts else list for name, load in found.texts.items()}
        own = {name[at:]: load for name, load in (loads | texts).items() if name.startswith(inside)}
        return {name: load() for name, load in own.items() if name and "." not in name}
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def _within(found: matlab_file.Contents, content: Content) -> str:
    """Find where the arrays are: in variables of their own, or in a struct, whose name is returned with a dot."""
    named = {*found.numbers, *found.fields, *found.texts, *found.unread}
    own = {name: {one for one in content.needed if f"{name}{one}" in named} for name in map(_struct, named)}
    some = {name: len(there) for name, there in own.items() if there}
    if "" in some or not some:
        return ""
    most = [name for name, count in some.items() if count == max(some.values())]
    if len(most) > 1:
        structs = ", ".join(sorted(name[:-1] for name in most))
        raise ValueError(f"holds {content.what} in several structs, {structs}: save one of them")
    return most[0]


def _struct(name: str) -> str:
    """Name the struct that a field belongs to, with its dot; nothing of a variable."""
    return "".join(name.rpartition(".")[:2])


def _read_npz(path: Path, content: Content) -> Arrays:
    try:
        return {name: stored.load() for name, stored in numpy_file.stored_arrays(path.read_bytes()).items()}
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None

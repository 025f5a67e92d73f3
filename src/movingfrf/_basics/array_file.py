"""Named arrays in files: NumPy's .npz and MATLAB's .mat, read without trust and written."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from movingfrf._basics import matlab_file, numpy_file
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
    texts : collection of str
        Names under which texts are read; others are met with an empty list in their place.
    """

    what: str
    largest: int
    texts: Collection[str] = ()


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
    path = Path(file)
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
    path = Path(file)
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
        numbers = {name: stored.load() for name, stored in found.numbers.items()}
        return numbers | {
            name: load() if name in content.texts else [] for name, load in found.texts.items() if "." not in name
        }
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def _read_npz(path: Path, content: Content) -> Arrays:
    try:
        return {name: stored.load() for name, stored in numpy_file.stored_arrays(path.read_bytes()).items()}
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None

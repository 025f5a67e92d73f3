"""Arrays: their types, and whether there is room for them."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.floating[Any]]
ComplexArray = NDArray[np.complexfloating[Any, Any]]
# Real or complex.
NumberArray = NDArray[np.inexact[Any]]
IntArray = NDArray[np.integer[Any]]
BoolArray = NDArray[np.bool_]


def finite(value: Any) -> Any:
    """Replace numbers that are not finite by None, in dicts and lists too: JSON knows no infinity."""
    if isinstance(value, dict):
        return {key: finite(item) for key, item in value.items()}
    if isinstance(value, list):
        return [finite(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def squared(values: NumberArray) -> FloatArray:
    """Squared magnitude; several times faster than the magnitude."""
    size: FloatArray = np.square(values.real)
    size += np.square(values.imag)
    return size


def handed(values: NumberArray, kind: type = complex) -> Any:
    """Hand an array over to compiled loops, which take those that lie in order and may be written to."""
    flags = values.flags
    ready = flags.c_contiguous and flags.writeable and values.dtype == kind
    return values if ready else np.array(values, kind, order="C")


def require_memory(needed: float, what: str) -> None:
    """Refuse a computation that would not fit into the free memory.

    Parameters
    ----------
    needed : float
        Bytes that the computation takes at its peak.
    what : str
        The quantity that makes it large, with its value, for the message.

    Raises
    ------
    ValueError
        If `needed` exceeds four fifths of the free memory.
    """
    # What is there wherever anything is, in bytes: it takes longer to ask than to compute [2**20 to 2**26].
    little = 2**24
    if needed < little:
        return
    # The share of the free memory that one computation may plan to take [a convention].
    share = 0.8
    available = free_memory()
    if needed > share * available:
        raise ValueError(
            f"{what} needs about {needed / 2**30:.3g} GiB of memory, but only {available / 2**30:.3g} GiB are free"
        )


def free_memory() -> float:
    """Bytes of memory that can be had without swapping; inf where nothing tells, as in a browser.

    Linux tells it itself; elsewhere psutil does.
    """
    try:
        lines = Path("/proc/meminfo").read_text(encoding="ascii").splitlines()
        return 1024.0 * next(int(line.split()[1]) for line in lines if line.startswith("MemAvailable:"))
    except (OSError, StopIteration):
        pass
    try:
        import psutil
    except ImportError:
        return math.inf
    return float(psutil.virtual_memory().available)

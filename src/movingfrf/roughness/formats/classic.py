"""Arrays in netCDF 3 files, the classic format, which SciPy reads."""

from __future__ import annotations

import io
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf.roughness.formats.base import bytes_of
from movingfrf.roughness.formats.choice import Array
from movingfrf.roughness.formats.hdf import HdfContents


def recognises(head: bytes) -> bool:
    """Whether a file begins like one in the classic format, or the one with 64-bit offsets."""
    return head.startswith((b"CDF\x01", b"CDF\x02"))


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
        Arrays and attributes.

    Raises
    ------
    ValueError
        If it is no such file, or damaged.
    """
    from scipy.io import netcdf_file

    try:
        # From memory, which gives what is there; from a disk as much is prepared for as a damaged file claims.
        with warnings.catch_warnings(), netcdf_file(io.BytesIO(bytes_of(path)), mmap=False) as file:
            warnings.simplefilter("ignore")
            kept = {name: item for name, item in file.variables.items() if item.data.dtype.kind in "iuf"}
            arrays = {
                name: Array(tuple(item.data.shape), partial(_values, item), _text(getattr(item, "units", "")))
                for name, item in kept.items()
            }
            said = {name: _text(getattr(file, name, "")) for name in ("source", "steps")}
    except Exception as error:  # whatever SciPy meets in a damaged file
        raise ValueError(f"is damaged, or no netCDF file: {error}") from None
    yield HdfContents(arrays, said, {})


def _values(item: Any) -> FloatArray:
    """Scale an array as netCDF means it; nan where it is filled, missing or beyond what is valid."""
    stored = item.data
    found: FloatArray = stored.astype(float)
    gone = np.zeros(stored.shape, bool)
    filled = [9.969209968386869e36] if stored.dtype.kind == "f" else []  # where nothing was written
    for none in [*filled, *_numbers(item, "_FillValue"), *_numbers(item, "missing_value")]:
        gone |= stored == np.array(none).astype(stored.dtype)
    low, high = (_numbers(item, "valid_range") * 2 or [-np.inf, np.inf])[:2]
    gone |= found < max([low, *_numbers(item, "valid_min")])
    gone |= found > min([high, *_numbers(item, "valid_max")])
    scale, offset = (
        _numbers(item, name) or [usual] for name, usual in (("scale_factor", 1.0), ("add_offset", 0.0))
    )
    return np.where(gone, np.nan, found * scale[0] + offset[0])


def _numbers(item: Any, name: str) -> list[float]:
    value = np.ravel(getattr(item, name, ()))
    return [float(one) for one in value] if value.dtype.kind in "iuf" else []


def _text(value: Any) -> str:
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else ""

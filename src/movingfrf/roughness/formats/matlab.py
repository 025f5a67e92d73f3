"""MATLAB files: version 5 (to 7.2), and version 7.3, which is HDF5."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from movingfrf._basics import matlab_file
from movingfrf.roughness.formats import arrays, hdf
from movingfrf.roughness.formats.base import Column, Format, Record, contents
from movingfrf.roughness.profile import Profile


def read(path: Path, columns: Sequence[Column] | None) -> Record:
    """Read the arrays of either version."""
    data = contents(path)
    if hdf.SIGNATURE in (data[:8], data[512:520]):
        del data
        with hdf.opened(path) as content:
            return arrays.record(content.arrays, columns, "MATLAB 7.3 file")
    numbers = matlab_file.arrays_and_texts(data).numbers
    return arrays.record(
        {name: arrays.Array(stored.shape, stored.load) for name, stored in numbers.items()}, columns, "MATLAB file"
    )


def write(profile: Profile, path: Path, encoding: str = "") -> None:
    """Write distance, elevation, lateral positions, source and steps as version 5."""
    from scipy.io import savemat

    values: dict[str, object] = {arrays.STATIONS: profile.stations[:, None], arrays.ELEVATIONS: profile.columns}
    if profile.across is not None:
        values[arrays.ACROSS] = np.array(profile.across)[None, :]
    values |= {"source": profile.source, "steps": "\n".join(profile.steps)}
    savemat(path, values, appendmat=False, oned_as="column")


FORMAT = Format("mat", (".mat",), matlab_file.recognised, read, write)

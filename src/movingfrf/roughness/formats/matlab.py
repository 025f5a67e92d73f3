"""MATLAB files: version 5 (to 7.2), and version 7.3, which is HDF5."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from movingfrf._basics import matlab_file
from movingfrf._basics.output import Content
from movingfrf.roughness.formats import arrays, hdf
from movingfrf.roughness.formats.base import Format, RawProfile, Wanted, bytes_of
from movingfrf.roughness.formats.choice import Array
from movingfrf.roughness.profile import Profile


def read(path: Path, wanted: Wanted) -> RawProfile:
    """Read the arrays of either version, those in structs too."""
    data = bytes_of(path)
    if hdf.SIGNATURE in (data[:8], data[512:520]):
        del data
        with hdf.opened(path) as content:
            # Fields of structs are groups there.
            inside = {name.replace("/", "."): array for name, array in content.arrays.items()}
            return arrays.raw_profile(inside, wanted, "MATLAB 7.3 file", content.unread)
    found = matlab_file.arrays_and_texts(data)
    numbers = {name: Array(stored.shape, stored.load) for name, stored in (found.numbers | found.fields).items()}
    texts = {name: " ".join(load()) for name, load in found.texts.items() if "unit" in name.lower()}
    return arrays.raw_profile(numbers, wanted, "MATLAB file", found.unread, texts)


def made(profile: Profile, encoding: str = "") -> dict[str, Content]:
    """Hold distance, elevation, lateral positions, source and steps as version 5."""
    names = arrays.ARRAY_NAMES
    values: dict[str, object] = {names.stations: profile.stations[:, None], names.elevations: profile.columns}
    if profile.across is not None:
        values[names.across] = np.array(profile.across)[None, :]
    values |= {"source": profile.source, "steps": "\n".join(profile.steps)}
    return {"": matlab_file.as_mat(values)}


FORMAT = Format("mat", "MATLAB", (".mat",), matlab_file.recognised, read, made, several=True, takes=("units",))

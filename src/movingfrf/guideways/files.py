"""Sampled guideways in files: MATLAB and NumPy."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from movingfrf._basics.array_file import Content, read_arrays, write_arrays
from movingfrf._basics.checks import ParameterError, checking
from movingfrf._basics.door import mistaken
from movingfrf.guideways.sampled import SampledGuideway

# A file holds what a `SampledGuideway` is made of, under the same names.
# Ten thousand samples at all 4,032 offsets of a train take 300 MiB [a convention].
RECORD = Content(
    what="a sampled guideway",
    largest=2**30,
    needed=("response", "time_step", "offsets", "speed"),
    others=("across", "source_across", "critical_speed", "stepped", "remarks"),
    texts=("remarks",),
)


def read_sampled_guideway(file: str | Path) -> SampledGuideway:
    """Read a guideway that is known by its moving impulse response: `.npz` (NumPy) or `.mat` (MATLAB).

    A .mat file may hold all of it in the fields of one struct.

    Parameters
    ----------
    file : str or Path
        The file. It holds the arrays `response` (time, offset) [m/(N s)] and `offsets` [m], the numbers `time_step`
        [s] and `speed` [m/s], and where wanted `across` and `source_across` [m] and `critical_speed` [m/s],
        `stepped` (1 if it is so) and `remarks` (texts, "code: message"), as for `SampledGuideway`.

    Returns
    -------
    SampledGuideway
        The guideway.

    Raises
    ------
    ValueError
        If the file cannot be read, an array is missing, unknown or of the wrong shape, or the guideway is refused.
    """
    found = read_arrays(file, RECORD)
    try:
        return SampledGuideway(**_arguments(found))
    except ParameterError as error:
        raise ValueError(f"{Path(file)}: {error}") from None


def write_sampled_guideway(guideway: SampledGuideway, file: str | Path) -> None:
    """Write a sampled guideway to a file, `.npz` or `.mat`, that `read_sampled_guideway` reads.

    Parameters
    ----------
    guideway : SampledGuideway
        The guideway.
    file : str or Path
        The file; replaced if it is there.

    Raises
    ------
    ValueError
        If the ending is another one.
    """
    with checking() as check:
        if not isinstance(guideway, SampledGuideway):
            check.refuse("guideway", mistaken("record", guideway))
    arrays = {one.name: getattr(guideway, one.name) for one in fields(guideway) if one.init}
    arrays["stepped"] = 1.0 if guideway.stepped else None
    arrays["remarks"] = [": ".join(remark) for remark in guideway.remarks] or None
    known = {name: np.asarray(array) for name, array in arrays.items() if array is not None}
    write_arrays(file, known, RECORD.what)


def _arguments(found: Mapping[str, Any]) -> dict[str, Any]:
    """Give arrays the shapes that they have in Python: MATLAB knows neither numbers nor arrays of one axis."""
    numbers = ("time_step", "speed", "critical_speed", "stepped")
    with checking() as check:
        RECORD.check_names(check, found)
        for name in numbers:
            if name in found and np.size(found[name]) != 1:
                check.refuse(name, f"must be one number, got {np.size(found[name])}")
        remarks = [str(remark).partition(": ")[::2] for remark in np.ravel(found.get("remarks", []))]
        if not all(code and message for code, message in remarks):
            check.refuse("remarks", 'must be texts of the form "code: message"')
    flat = {name: np.ravel(array) for name, array in found.items()}
    shaped = {
        name: array if name == "response" else flat[name][0].item() if name in numbers else flat[name]
        for name, array in found.items()
    }
    return shaped | {"remarks": remarks, "stepped": bool(shaped.get("stepped", False))}

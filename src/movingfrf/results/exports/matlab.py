"""Variables for MATLAB, .mat of version 5, which everything that knows MATLAB files opens."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import numpy as np

from movingfrf._basics.matlab_file import LEVEL_5, as_mat

if TYPE_CHECKING:
    from collections.abc import Iterable

    import xarray as xr


def made(result: xr.Dataset) -> bytes:
    """Write every variable under its name, as it is in the result.

    Beside them stand the structures `units`, `long_name` and `dimensions`, which say of each what it is, and
    `settings`, how the result was made. Texts, as names of degrees of freedom, are cells. The response in the finer
    steps in which it was solved is there too, as `solved_time` and so on, where the result keeps it.
    """
    variables = {str(name): variable for name, variable in result.variables.items()}
    content: dict[str, Any] = {
        "units": {
            name: each.attrs.get("units", each.attrs.get("comment", "1")) for name, each in variables.items()
        },
        "long_name": {name: each.attrs.get("long_name", name) for name, each in variables.items()},
        "dimensions": {name: ", ".join(map(str, each.dims)) for name, each in variables.items()},
    }
    # A variable that is called as a structure gives way to it, and is called so within them too.
    names = valid_names(variables, taken=(*content, "settings"))
    content = {which: {names[name]: said for name, said in texts.items()} for which, texts in content.items()}
    content["settings"] = {valid: result.attrs[name] for name, valid in valid_names(map(str, result.attrs)).items()}
    content |= {names[name]: _array(variable.values) for name, variable in variables.items()}
    return as_mat(content, packed=True)


def _array(values: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Cells of texts; numbers as MATLAB has them, whole ones too."""
    if values.dtype.kind in "USO":
        return np.array([str(each) for each in values.ravel()], dtype=object).reshape(values.shape)
    return values if values.dtype.kind == "c" else values.astype(float)


def valid_names(names: Iterable[str], taken: Iterable[str] = ()) -> dict[str, str]:
    """Find a name in MATLAB for each: a letter, then letters, digits and low lines, at most 63, no two alike.

    Parameters
    ----------
    names : iterable of str
        The names.
    taken : iterable of str
        Names that something else has.

    Returns
    -------
    dict of str to str
        Name in MATLAB of each.

    Examples
    --------
    >>> valid_names(["time", "2nd wheel", "end"])
    {'time': 'time', '2nd wheel': 'x2nd_wheel', 'end': 'end_'}
    """
    found: dict[str, str] = {}
    others = set(taken)
    for name in names:
        valid = re.sub(r"[^A-Za-z0-9_]", "_", name)
        valid = valid if re.match("[A-Za-z]", valid) else f"x{valid}"
        valid = f"{valid}_"[: LEVEL_5.longest_name] if valid in LEVEL_5.reserved else valid[: LEVEL_5.longest_name]
        number = 1
        stem = valid
        while valid in others:
            number += 1
            valid = f"{stem[: LEVEL_5.longest_name - 1 - len(str(number))]}_{number}"
        found[name] = valid
        others.add(valid)
    return found

"""Results on disk."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from movingfrf._basics.arrays import finite
from movingfrf._basics.netcdf_file import as_netcdf
from movingfrf._basics.output import write_whole
from movingfrf.results.labels import HISTORIES, SCHEMAS, Measure, flaws, kind_of

if TYPE_CHECKING:
    import xarray as xr


def save(result: xr.Dataset, file: Path) -> None:
    """Save a result as netCDF, which xarray, MATLAB and others open.

    Parameters
    ----------
    result : xarray.Dataset
        Any result of the package.
    file : Path
        The file; replaced if it is there.

    Raises
    ------
    OSError
        If it cannot be written; then what was there is there still.
    """
    write_whole(file, as_netcdf(result))


def opened(file: Path) -> xr.Dataset:
    """Open a result of any kind that `save` wrote.

    Parameters
    ----------
    file : Path
        The file.

    Returns
    -------
    xarray.Dataset
        The result, wholly in memory.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If it is not netCDF, or no result of the package.
    """
    import xarray as xr

    # Asked first, since the library below hides why a file cannot be read in half a page of text.
    with file.open("rb") as first:
        if first.read(3) == b"CDF":
            raise ValueError(
                f"{file}: is netCDF of version 3, which cannot hold a result as it is: write it as version 4, "
                'result.to_netcdf(file, engine="h5netcdf")'
            )
    try:
        with xr.open_dataset(file, engine="h5netcdf") as opened:
            result: xr.Dataset = opened.load()
    except OSError:
        raise ValueError(f"{file}: is not a netCDF file, or a damaged one") from None
    if "movingfrf" not in result.attrs or kind_of(result) is None:
        raise ValueError(f"{file}: is no result of movingfrf")
    return result


def load(file: Path) -> xr.Dataset:
    """Open histories that `save` wrote, to measure them.

    Parameters
    ----------
    file : Path
        The file.

    Returns
    -------
    xarray.Dataset
        The result, wholly in memory.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If it is not netCDF, no result of the package, no histories, or lacks a variable or a finite number in one.
    """
    result = opened(file)
    kind = str(kind_of(result))
    if kind == "random":
        raise ValueError(
            f"{file}: holds the response to a random road, which `movingfrf random` has measured already, see its "
            "summary.json; `movingfrf measure` takes histories, as `movingfrf run` writes them"
        )
    if kind not in HISTORIES:
        raise ValueError(f"{file}: holds no histories, as `movingfrf run` writes them, but a result of kind {kind}")
    schema = SCHEMAS[kind]
    lacking = [name for name in ("speed", "time_step", "findings") if name not in result.attrs]
    found = [f"lacks the attribute {name}" for name in lacking]
    found += flaws(result, [name for name, label in schema.items() if not label.optional])
    if found:
        raise ValueError(f"{file}: {'; '.join(found)}")
    return result


def measures_as_csv(found: list[Measure]) -> str:
    """Write measures as a table, one a line, with units and standards.

    Parameters
    ----------
    found : list of Measure
        The measures.

    Returns
    -------
    str
        CSV text with a header; numbers with all their digits.
    """
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(Measure._fields)
    table.writerows(found)
    return text.getvalue()


def summary_as_json(result: xr.Dataset, found: list[Measure]) -> str:
    """Summarise a result as JSON: settings, measures and findings.

    Parameters
    ----------
    result : xarray.Dataset
        Any result of the package.
    found : list of Measure
        Its measures.

    Returns
    -------
    str
        JSON text; a number without a finite value is null.
    """
    settings: Mapping[str, Any] = {
        key: value for key, value in result.attrs.items() if key not in ("findings", "scenario", "Conventions")
    }
    content = {
        "settings": settings,
        "measures": [measure._asdict() for measure in found],
        "findings": json.loads(result.attrs["findings"]),
    }
    return json.dumps(finite(content), indent=1, ensure_ascii=False) + "\n"

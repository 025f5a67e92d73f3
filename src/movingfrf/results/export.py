"""Results for other programs: tables, MATLAB, modal analysis."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from movingfrf._basics.checks import checking, option
from movingfrf._basics.door import mistaken
from movingfrf._basics.output import naming, write_whole
from movingfrf.results.exports import columns, matlab, universal
from movingfrf.results.labels import kind_of

if TYPE_CHECKING:
    import xarray as xr


def export(result: xr.Dataset, file: str | Path, *, force: bool = False) -> None:
    """Write a result for other programs: .csv, .mat or .uff.

    `.csv`: a line a time or frequency, a column for each contact, degree of freedom, load and point, with units in
    the heads, as `contact force front [N]`, and of a journey the distance of the vehicle; complex numbers as two
    columns. `.mat`: every variable under its name, and the structures `units`, `long_name`, `dimensions` and
    `settings`. `.uff`: a universal file with a dataset 58 for each column, named, with units, directions and its
    function type; 12 digits, 6 of the step. A result itself is netCDF: `result.to_netcdf(file, engine="h5netcdf")`.

    Parameters
    ----------
    result : xarray.Dataset
        Any result of the package over time or frequency, whole or a part.
    file : str or Path
        The file; its ending tells the kind.
    force : bool
        Replace the file if it exists.

    Raises
    ------
    ValueError
        If the result is none of the package, or no variable of it is over time or frequency, there is no such kind
        of file, the file exists, or what the kind needs is not installed.
    OSError
        If the file cannot be written; nothing is left half-written.

    Examples
    --------
    >>> import movingfrf as mf
    >>> loads = mf.moving_loads(mf.RigidGuideway(), [[1.0]] * 9, [0.0], speed=10.0)
    >>> exported(loads, ".csv").decode().splitlines()[:2]
    ['time [s],force at 0 m [N],deflection at 0 m [m]', '0.0,1.0,0.0']
    """
    with checking() as check:
        file = check.file("file", file)
    if file.exists() and not force:
        raise ValueError(f"{file} exists; choose another name, or replace it with {option('force')}")
    with naming(file):
        made = exported(result, file.suffix)
    write_whole(file, made)


def exported(result: xr.Dataset, ending: str) -> bytes:
    """Make what an export writes, whole and in memory.

    Parameters
    ----------
    result : xarray.Dataset
        Any result of the package over time or frequency.
    ending : str
        Ending of the file, `.csv`, `.mat` or `.uff`.

    Returns
    -------
    bytes
        The file.

    Raises
    ------
    ValueError
        As for `export`.
    """
    kinds = {".csv": columns.made, ".mat": matlab.made, ".uff": universal.made}
    with checking() as check:
        if ending.lower() not in kinds:
            check.refuse("file", f"must end in {', '.join(kinds)}, got {ending or 'no ending'!r}")
        if kind_of(result) is None or not {"time", "frequency"} & set(result.dims):
            check.refuse("result", mistaken("result", result))
    return kinds[ending.lower()](result)

"""netCDF 4 files, made in memory."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import xarray as xr


def as_netcdf(dataset: xr.Dataset) -> bytes:
    """Make a netCDF 4 file in memory, since the HDF5 library crashes where a disk is full.

    Parameters
    ----------
    dataset : xarray.Dataset
        What it shall hold.

    Returns
    -------
    bytes
        The file.
    """
    import h5netcdf
    from xarray.backends import H5NetCDFStore

    made = io.BytesIO()
    with h5netcdf.File(made, "w") as file:
        dataset.dump_to_store(H5NetCDFStore(file))
    return made.getvalue()

"""netCDF: what xarray and many others open; keeps everything that a profile knows."""

from __future__ import annotations

from pathlib import Path

from movingfrf._basics.netcdf_file import as_netcdf
from movingfrf._basics.output import Content
from movingfrf.roughness.formats import arrays, classic, hdf
from movingfrf.roughness.formats.base import Format, RawProfile, Wanted
from movingfrf.roughness.profile import Profile


def read(path: Path, wanted: Wanted) -> RawProfile:
    """Read distance and elevation, and where they come from."""
    with (classic if classic.recognises(_head(path)) else hdf).opened(path) as content:
        found = arrays.raw_profile(content.arrays, wanted, "netCDF", content.unread)
    source, steps = content.attributes["source"], content.attributes["steps"]
    return found._replace(source=source, steps=tuple(step for step in steps.split("\n") if step))


def _head(path: Path) -> bytes:
    with path.open("rb") as file:
        return file.read(16)


def made(profile: Profile, encoding: str = "") -> dict[str, Content]:
    """Hold distance, elevation, lateral positions, source and steps."""
    import xarray as xr

    dims = ("distance",) if profile.same_across else ("distance", "path")
    variables = {
        "elevation": xr.Variable(dims, profile.elevation, {"units": "m", "long_name": "elevation, positive up"})
    }
    if profile.across is not None:
        words = {"units": "m", "long_name": "lateral position, left positive"}
        variables["across"] = xr.Variable(("path",), list(profile.across), words)
    distance = xr.Variable(("distance",), profile.stations, {"units": "m", "long_name": "distance along the road"})
    attributes = {"source": profile.source, "steps": "\n".join(profile.steps)}
    return {"": as_netcdf(xr.Dataset(variables, {"distance": distance}, attributes))}


FORMAT = Format(
    "netcdf",
    "netCDF",
    (".nc", ".nc4", ".h5"),
    lambda head: head.startswith(hdf.SIGNATURE) or classic.recognises(head),
    read,
    made,
    several=True,
    takes=("units",),
)

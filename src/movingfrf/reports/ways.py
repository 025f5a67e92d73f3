"""By which method a result was computed, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from movingfrf._basics.wording import number, plain
from movingfrf.reports.tables import Setting

if TYPE_CHECKING:
    import xarray as xr


class Way(NamedTuple):
    """A method: its name, and how a sentence ends that says what was computed."""

    name: str
    words: str


# By the attribute `method` of a result; one that does not say has been computed by moving FRFs.
WAYS = {
    "moving-frf": Way(
        "moving FRF", "in the frequency domain, with moving frequency response functions (moving FRFs)"
    ),
    "cdfm": Way(
        "coupled method (CDFM)", "step by step in the time domain, as one system (the coupled method, CDFM)"
    ),
    "sim": Way(
        "separate iterative method (SIM)",
        "step by step in the time domain, side by side, contact forces exchanged within each step until both agree "
        "(the separate iterative method, SIM)",
    ),
    "duhamel": Way("Duhamel's integral", "step by step in the time domain, by Duhamel's integral"),
    "newmark": Way("Newmark's method", "step by step in the time domain, by Newmark's method"),
}


def way(result: xr.Dataset) -> Way:
    """Say by which method a result was computed.

    Parameters
    ----------
    result : xarray.Dataset
        A result.

    Returns
    -------
    Way
        The method.
    """
    return WAYS[result.attrs.get("method", "moving-frf")]


def is_stepped(result: xr.Dataset) -> bool:
    """Tell whether a result was stepped in time, on a finite road."""
    return "road_dofs" in result.attrs


def stands_still(result: xr.Dataset) -> bool:
    """Tell whether a vehicle was stepped along a road that need not be the same everywhere."""
    attrs = result.attrs
    return is_stepped(result) and not attrs["road_travels"] and not attrs["superposed"]


def stepped_road(result: xr.Dataset) -> str:
    """Say what road a result was stepped on.

    Parameters
    ----------
    result : xarray.Dataset
        What `cdfm`, `sim` or `newmark_loads` returned.

    Returns
    -------
    str
        Two sentences.
    """
    first, last = result.attrs["road_first"], result.attrs["road_last"]
    travels = ", and travels along" if result.attrs["road_travels"] else ""
    return (
        f"The road is finite: it reaches from {plain(round(first, 6))} m to {plain(round(last, 6))} m{travels}. "
        f"Its {result.attrs['road_dofs']} unknowns are stepped in time, what is constant factorised once."
    )


def way_settings(result: xr.Dataset) -> list[Setting]:
    """List the method, and what only a method that steps has to set.

    Parameters
    ----------
    result : xarray.Dataset
        A result.

    Returns
    -------
    list of Setting
        For the head of a report.
    """
    attrs = result.attrs
    found = [Setting("Method", way(result).name)]
    if is_stepped(result):
        spacing = f"nodes {number(attrs['road_spacing'])} m apart" if attrs["road_spacing"] else ""
        found += [
            Setting("Unknowns of the road", str(attrs["road_dofs"]), spacing),
            Setting("Scheme", attrs["scheme"], wide=True),
        ]
    if "run_in" in attrs:
        found.append(Setting("Run-in", f"{plain(attrs['run_in'])} s", "on the smooth road, before the record"))
    if attrs.get("method") == "sim":
        found.append(Setting("Exchanges of forces", str(attrs["iterations"]), "in a step, at most"))
    return found

"""First measures of a result: root mean square, peak, dynamic load coefficient."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from movingfrf._checks import FloatArray

if TYPE_CHECKING:
    import xarray as xr


class Measure(NamedTuple):
    """One number about a result."""

    quantity: str  # what was measured, and where
    name: str  # which measure
    value: float
    units: str


def measures(result: xr.Dataset) -> list[Measure]:
    """Measure every contact and degree of freedom, or every observation point.

    Parameters
    ----------
    result : xarray.Dataset
        What `simulate` or `moving_loads` returned.

    Returns
    -------
    list of Measure
        Per contact: static load [N], root mean square and peak of the dynamic force [N], smallest total force
        [N], dynamic load coefficient (root mean square over static load); static deflection [m], root mean
        square of the dynamic and peak of the total deflection [m]. Per degree of freedom: root mean square and
        peak of the acceleration [m/s² or rad/s²]. Per observation point under prescribed loads: root mean
        square and peak of the deflection [m].

    References
    ----------
    Dynamic load coefficient: D. Cebon, Handbook of Vehicle-Road Interaction, Swets & Zeitlinger, 1999.
    """
    if "contact_force" not in result:
        return [
            measure
            for point, deflection in zip(result.point.values, result.deflection.values.T, strict=True)
            for measure in _rms_and_peak(f"deflection at {point:g} m", deflection, "m")
        ]
    found: list[Measure] = []
    loads = result.static_load.values.tolist()
    for contact, (load, force) in enumerate(zip(loads, result.contact_force.values.T, strict=True)):
        quantity = f"contact {contact} force"
        found += [
            Measure(quantity, "static", load, "N"),
            Measure(quantity, "dynamic rms", _rms(force), "N"),
            Measure(quantity, "dynamic peak", float(np.abs(force).max()), "N"),
            Measure(quantity, "smallest total", load + float(force.min()), "N"),
            Measure(quantity, "dynamic load coefficient", _rms(force) / load if load else float("inf"), "1"),
        ]
    sags = result.static_deflection.values.tolist()
    for contact, (sag, deflection) in enumerate(zip(sags, result.deflection.values.T, strict=True)):
        quantity = f"contact {contact} deflection"
        found += [
            Measure(quantity, "static", sag, "m"),
            Measure(quantity, "dynamic rms", _rms(deflection - sag), "m"),
            Measure(quantity, "peak", float(np.abs(deflection).max()), "m"),
        ]
    for number, acceleration in enumerate(result.acceleration.values.T):
        unit = f"{result.dof_unit.values[number]}/s²"
        found += _rms_and_peak(f"{result.dof.values[number]} acceleration", acceleration, unit)
    return found


def _rms_and_peak(quantity: str, values: FloatArray, units: str) -> list[Measure]:
    return [
        Measure(quantity, "rms", _rms(values), units),
        Measure(quantity, "peak", float(np.abs(values).max()), units),
    ]


def _rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2)))

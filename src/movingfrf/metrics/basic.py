"""First measures of a coupled response: root mean square, peak, dynamic load coefficient."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr


class Measure(NamedTuple):
    """One number about a result."""

    quantity: str  # what was measured, and where
    name: str  # which measure
    value: float
    units: str


def measures(result: xr.Dataset) -> list[Measure]:
    """Measure every contact and every degree of freedom of a coupled response.

    Parameters
    ----------
    result : xarray.Dataset
        What `simulate` returned.

    Returns
    -------
    list of Measure
        Per contact: static load [N], root mean square and peak of the dynamic force [N], dynamic load
        coefficient (root mean square over static load), smallest total force [N], static deflection [m],
        root mean square of the dynamic and peak of the total deflection [m]. Per degree of freedom: root mean
        square and peak of the acceleration [m/s² or rad/s²].

    References
    ----------
    Dynamic load coefficient: D. Cebon, Handbook of Vehicle-Road Interaction, Swets & Zeitlinger, 1999.
    """
    found: list[Measure] = []
    for contact in range(result.sizes["contact"]):
        force = result.contact_force.values[:, contact]
        load = float(result.static_load.values[contact])
        deflection = result.deflection.values[:, contact]
        sag = float(result.static_deflection.values[contact])
        where = f"contact {contact}"
        found += [
            Measure(f"{where} force", "static", load, "N"),
            Measure(f"{where} force", "dynamic rms", _rms(force), "N"),
            Measure(f"{where} force", "dynamic peak", float(np.abs(force).max()), "N"),
            Measure(f"{where} force", "smallest total", load + float(force.min()), "N"),
            Measure(f"{where} force", "dynamic load coefficient", _rms(force) / load, "1"),
            Measure(f"{where} deflection", "static", sag, "m"),
            Measure(f"{where} deflection", "dynamic rms", _rms(deflection - sag), "m"),
            Measure(f"{where} deflection", "peak", float(np.abs(deflection).max()), "m"),
        ]
    for number, dof in enumerate(result.dof.values):
        acceleration = result.acceleration.values[:, number]
        units = f"{result.dof_unit.values[number]}/s²"
        found += [
            Measure(f"{dof} acceleration", "rms", _rms(acceleration), units),
            Measure(f"{dof} acceleration", "peak", float(np.abs(acceleration).max()), units),
        ]
    return found


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))

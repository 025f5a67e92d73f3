"""What a random response amounts to: a list of measures, and fatigue."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from movingfrf._basics.checks import Checks, checking, shown
from movingfrf.metrics.loads import road_stress_factor
from movingfrf.metrics.measures import CEBON, EISENMANN, Measure
from movingfrf.response.random import WEIGHTING_OF
from movingfrf.results.labels import RANDOM_QUANTITIES

if TYPE_CHECKING:
    import xarray as xr


# Sources of what the names alone do not define.
RICE, DAVENPORT, DIRLIK = "Rice 1945", "Davenport 1964", "Dirlik 1985"


def spectral_fatigue(
    result: xr.Dataset, quantity: str, *, slope: float, strength: float = 1.0, method: str = "dirlik"
) -> xr.DataArray:
    """Fatigue damage per second that a random response does, from its spectral density.

    Parameters
    ----------
    result : xarray.Dataset
        What `random_response` returned.
    quantity : str
        `contact_force`, `deflection`, `motion`, `acceleration` or `roughness`.
    slope : float
        Exponent m of the S-N curve N = C a^−m in the amplitude a.
    strength : float
        The curve's C: cycles to failure times amplitude to the power of the exponent [unit^m].
    method : str
        How rainflow cycles are estimated from a spectrum: `dirlik`, `tovo_benasciutti`, `single_moment` or
        `narrow_band`; see `spectral_damage`.

    Returns
    -------
    xarray.DataArray
        Damage per second [1/s] of every contact or degree of freedom.

    Raises
    ------
    ValueError
        If the result is none of `random_response`, there is no such quantity or method, a value is not positive,
        the method does not hold for a density, or the extra `fatigue` is not installed.
    """
    from movingfrf.metrics.fatigue import spectral_damage

    with checking() as check:
        _check_random(check, result)
        if not (isinstance(quantity, str) and quantity in RANDOM_QUANTITIES):
            check.refuse("quantity", f"must be one of {', '.join(RANDOM_QUANTITIES)}, got {shown(quantity)}")
    frequency, density = result.frequency.values, result[f"{quantity}_density"].values
    if "bandwidth" in result.coords:
        # The damage is integrated by trapezoids: so weighted they give the moments of the Gauss points.
        gaps = np.diff(frequency, prepend=frequency[0], append=frequency[-1])
        density = density * (result.bandwidth.values / (0.5 * (gaps[1:] + gaps[:-1])))[:, None]
    damage = [
        spectral_damage(frequency, column, slope=slope, strength=strength, method=method) for column in density.T
    ]
    found = result[f"{quantity}_rms"].copy(data=damage).rename(f"{quantity}_damage")
    found.attrs = {
        "units": "1/s",
        "long_name": f"fatigue damage per second of the {RANDOM_QUANTITIES[quantity][2]}",
        "slope": float(slope),
        "strength": float(strength),
        "method": method,
    }
    return found


def random_measures(result: xr.Dataset, *, slope: float | None = None) -> list[Measure]:
    """List the statistics of a random response.

    Parameters
    ----------
    result : xarray.Dataset
        What `random_response` returned.
    slope : float, optional
        Exponent m of an S-N curve; adds the steady amplitude that damages as much as each contact force.

    Returns
    -------
    list of Measure
        Per contact: static force, root mean square and expected peak (its largest value, not the largest
        magnitude that `measures` calls the dynamic peak) of the dynamic one [N], its crossing rate
        [1/s] and irregularity; of the total load the dynamic load coefficient, road stress factor, expected
        largest value [N], how often [1/s] and for which share of the time it would turn tensile; static, root mean
        square and peak deflection [m] with its crossing rate. Per degree of freedom: root mean square, expected
        peak, crossing rate and weighted root mean square of the acceleration.

    Raises
    ------
    ValueError
        If the result is none of `random_response`, or the damage for a slope cannot be had; see `spectral_fatigue`.
    """
    with checking() as check:
        _check_random(check, result)
    equivalent = None
    if slope is not None:
        equivalent = spectral_fatigue(result, "contact_force", slope=slope).values ** (1 / slope)
    found: list[Measure] = []
    for contact in result.contact.values.tolist():
        at = result.isel(contact=contact)
        load, peak = at.static_load.item(), at.contact_force_expected_peak.item()
        coefficient = at.dynamic_load_coefficient.item()
        force, total = f"contact {contact} force", f"contact {contact} load"
        found += [
            Measure(force, "static", load, "N"),
            Measure(force, "rms", at.contact_force_rms.item(), "N"),
            Measure(force, "expected peak", peak, "N", DAVENPORT),
            Measure(force, "crossing rate", at.contact_force_crossing_rate.item(), "1/s", RICE),
            Measure(force, "irregularity", at.contact_force_irregularity.item(), "1", RICE),
            Measure(total, "dynamic load coefficient", coefficient, "1", CEBON),
            Measure(total, "road stress factor", float(road_stress_factor(coefficient)), "1", EISENMANN),
            Measure(total, "expected largest", load + peak, "N", DAVENPORT),
            Measure(total, "lift-offs", at.lift_off_rate.item(), "1/s", RICE),
            Measure(total, "share lifted off", at.lift_off_share.item(), "1"),
        ]
        if equivalent is not None:
            amplitude = float(equivalent[contact])
            found.append(Measure(force, "damage-equivalent amplitude at 1 Hz", amplitude, "N", DIRLIK))
    for contact in result.contact.values.tolist():
        at = result.isel(contact=contact)
        quantity = f"contact {contact} deflection"
        found += [
            Measure(quantity, "static", at.static_deflection.item(), "m"),
            Measure(quantity, "rms", at.deflection_rms.item(), "m"),
            Measure(quantity, "expected peak", at.deflection_expected_peak.item(), "m", DAVENPORT),
            Measure(quantity, "crossing rate", at.deflection_crossing_rate.item(), "1/s", RICE),
        ]
    for dof in range(result.sizes["dof"]):
        at = result.isel(dof=dof)
        quantity, unit = f"{at.dof.item()} acceleration", f"{at.dof_unit.item()}/s²"
        weighting = WEIGHTING_OF[at.dof_unit.item()]
        found += [
            Measure(quantity, "rms", at.acceleration_rms.item(), unit),
            Measure(quantity, "expected peak", at.acceleration_expected_peak.item(), unit, DAVENPORT),
            Measure(quantity, "crossing rate", at.acceleration_crossing_rate.item(), "1/s", RICE),
            Measure(quantity, f"weighted rms ({weighting})", at.weighted_acceleration.item(), unit, "ISO 2631-1"),
        ]
    return found


def _check_random(check: Checks, result: object) -> None:
    if "contact_force_density" not in getattr(result, "data_vars", ()):
        check.refuse("result", "must be the response to a random road, from `random_response`")

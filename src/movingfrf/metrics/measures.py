"""Measures of a result: the usual ones, and all of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import Checks, checking
from movingfrf.metrics.comfort import (
    ISO_2631,
    WEIGHTING_OF,
    WEIGHTINGS,
    Comfort,
    check_weighting,
    samples_before,
    whole_body_vibration,
)
from movingfrf.metrics.fatigue import check_random, equivalent_amplitude, spectral_fatigue
from movingfrf.metrics.loads import (
    check_coupled,
    common_points,
    contact_loss,
    dynamic_load_coefficient,
    road_stress_factor,
    road_wear,
)
from movingfrf.results.labels import Measure

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True, slots=True, kw_only=True)
class Sources:
    """Sources of measures which their names alone do not define."""

    load: str = "Cebon 1999"  # dynamic load coefficient and wear
    stress: str = "Eisenmann 1975"
    cycles: str = "ASTM E1049"
    crossings: str = "Rice 1945"
    peak: str = "Davenport 1964"
    damage: str = "Dirlik 1985"


SOURCES = Sources()


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
        peak of the acceleration, and its root mean square as weighted by ISO 2631-1, with Wk if it is a
        translation and We if it is a rotation [m/s² or rad/s²]. Per observation point under prescribed loads: root
        mean square and peak of the deflection [m].

    Raises
    ------
    ValueError
        If the result is neither of these.

    References
    ----------
    Dynamic load coefficient: D. Cebon, Handbook of Vehicle-Road Interaction, Swets & Zeitlinger, 1999.
    """
    variables = getattr(result, "data_vars", ())
    if "force" in variables and "deflection" in variables:
        return [
            measure
            for point, deflection in zip(result.point.values, result.deflection.values.T, strict=True)
            for measure in _rms_and_peak(f"deflection at {point:g} m", deflection, "m")
        ]
    with checking() as check:
        check_coupled(check, result, "deflection", "static_deflection")
    contacts, dofs = range(result.sizes["contact"]), range(result.sizes["dof"])
    coefficients = dynamic_load_coefficient(result)
    return [
        *(measure for contact in contacts for measure in _of_force(result, contact, coefficients)),
        *(measure for contact in contacts for measure in _of_deflection(result, contact)),
        *(measure for dof in dofs for measure in _of_acceleration(result, dof, "Wk", 0.0)[:3]),
    ]


def assess(
    result: xr.Dataset,
    *,
    contacts: Sequence[int] | None = None,
    dofs: Sequence[str] | None = None,
    weighting: str = "Wk",
    slope: float | None = None,
    since: float = 0.0,
) -> list[Measure]:
    """Measure a coupled response in every way that the package knows.

    Parameters
    ----------
    result : xarray.Dataset
        What `simulate`, `cdfm` or `sim` returned.
    contacts : sequence of int, optional
        Numbers of the contacts; all by default.
    dofs : sequence of str, optional
        Names of the degrees of freedom, those where people are: what ISO 2631-1 makes of them is then noted. All
        by default, without such notes.
    weighting : str
        Frequency weighting of translations; rotations have We.
    slope : float, optional
        Exponent of an S-N curve; adds the amplitude of the steady cycling, once a second, that would do the same
        damage as each contact force.
    since : float
        Seconds to leave out at the start [s]: there wheels may not have reached the rough road yet, and what they
        roll onto has not built up.

    Returns
    -------
    list of Measure
        In addition to `measures`: road stress factor, share of the time and longest time without contact [s] of
        every contact; peak, crest factor, MTVV [m/s²] and VDV [m/s^1.75] of every weighted acceleration (rad for m
        if it is a rotation); and, unless contacts are chosen, the aggregate fourth-power force on each path that
        95 % of the road's points bear at most, over that of the static loads. A measure without an answer is nan,
        and its note says why. Notes also hold the likely reactions to a weighted rms, and whether a limit is
        exceeded beyond which the rms understates a vibration.

    Raises
    ------
    ValueError
        If the result is none of a vehicle or not finite, there is no such contact, degree of freedom or weighting,
        nothing is left of the record, or a slope is given and the extra `fatigue` is not installed.

    Examples
    --------
    >>> import movingfrf as mf
    >>> car = mf.quarter_car(body_mass=400.0, wheel_mass=40.0, suspension_stiffness=2e4,
    ...                      suspension_damping=1.5e3, tyre_stiffness=2e5)
    >>> hump = mf.bump(height=0.02, width=1.0, at=5.0, length=30.0)
    >>> result = mf.simulate(mf.RigidGuideway(), car, hump, speed=10.0, duration=2.0, blend=0.0)
    >>> [measure.name for measure in mf.assess(result, contacts=[], dofs=["body"])][-2:]
    ['MTVV', 'VDV']
    """
    with checking() as check:
        check_coupled(check, result, "deflection", "static_deflection")
        if not check.faults:
            _check_chosen(check, "contacts", contacts, list(range(result.sizes["contact"])))
            _check_chosen(check, "dofs", dofs, result.dof.values.tolist())
        check_weighting(check, weighting)
        if slope is not None:
            check.positive("slope", slope, "1")
    step = float(result.attrs["time_step"])
    whole, result = result, result.isel(time=slice(samples_before(since, step, result.sizes["time"]), None))
    names = result.dof.values.tolist()
    numbers = range(result.sizes["contact"]) if contacts is None else contacts
    coefficients, loss = dynamic_load_coefficient(result), contact_loss(result)
    stress = road_stress_factor(coefficients)
    found: list[Measure] = []
    for contact in numbers:
        quantity = f"contact {contact} force"
        found += [
            *_of_force(result, contact, coefficients),
            Measure(quantity, "road stress factor", float(stress[contact]), "1", SOURCES.stress),
            Measure(quantity, "share of time without contact", float(loss.share[contact]), "1"),
            Measure(quantity, "longest loss of contact", float(loss.longest[contact]), "s"),
        ]
        if slope is not None:
            force = result.contact_force.values[:, contact]
            amplitude = equivalent_amplitude(force, slope=slope, duration=force.size * step)
            found.append(Measure(quantity, "damage-equivalent amplitude at 1 Hz", amplitude, "N", SOURCES.cycles))
    for contact in numbers:
        found += _of_deflection(result, contact)
    if contacts is None:
        found += _of_wear(result)
    for dof in names if dofs is None else dofs:
        found += _of_acceleration(whole, names.index(dof), weighting, since, judged=dofs is not None)
    return found


def _of_force(result: xr.Dataset, contact: int, coefficients: FloatArray) -> list[Measure]:
    quantity, force = f"contact {contact} force", result.contact_force.values[:, contact]
    load = float(result.static_load.values[contact])
    return [
        Measure(quantity, "static", load, "N"),
        Measure(quantity, "dynamic rms", _rms(force), "N"),
        Measure(quantity, "dynamic peak", float(np.abs(force).max()), "N"),
        Measure(quantity, "smallest total", load + float(force.min()), "N"),
        Measure(quantity, "dynamic load coefficient", float(coefficients[contact]), "1", SOURCES.load),
    ]


def _of_deflection(result: xr.Dataset, contact: int) -> list[Measure]:
    quantity, deflection = f"contact {contact} deflection", result.deflection.values[:, contact]
    sag = float(result.static_deflection.values[contact])
    return [
        Measure(quantity, "static", sag, "m"),
        Measure(quantity, "dynamic rms", _rms(deflection - sag), "m"),
        Measure(quantity, "peak", float(np.abs(deflection).max()), "m"),
    ]


def _of_wear(result: xr.Dataset) -> list[Measure]:
    paths = np.unique(result.path.values)
    ratios, note = (
        np.full(paths.size, np.nan),
        "the record is too short for all contacts to pass one point of the road",
    )
    if common_points(result).size:
        ratios, note = road_wear(result), ""
    name = "95th percentile of ΣP⁴ over static"
    return [
        Measure(f"path {path} wear", name, float(ratio), "1", SOURCES.load, note)
        for path, ratio in zip(paths, ratios, strict=True)
    ]


def _of_acceleration(
    result: xr.Dataset, number: int, weighting: str, since: float, *, judged: bool = False
) -> list[Measure]:
    """As it is first, then as people would feel it."""
    quantity, acceleration = f"{result.dof.values[number]} acceleration", result.acceleration.values[:, number]
    unit = str(result.dof_unit.values[number])
    name = weighting if unit == "m" else "We"
    standard = WEIGHTINGS[name].standard
    step = float(result.attrs["time_step"])
    weighted = whole_body_vibration(acceleration, step, name, since=since)
    notes = _verdicts(weighted, unit) if judged else {}
    by = f"{standard}, {name}"
    return [
        *_rms_and_peak(quantity, acceleration[samples_before(since, step, acceleration.size) :], f"{unit}/s²"),
        Measure(quantity, "weighted rms", weighted.rms, f"{unit}/s²", by, notes.get("rms", "")),
        Measure(quantity, "weighted peak", weighted.peak, f"{unit}/s²", by),
        Measure(quantity, "crest factor", weighted.crest_factor, "1", by, notes.get("crest", "")),
        Measure(quantity, "MTVV", weighted.mtvv, f"{unit}/s²", by, notes.get("MTVV", "")),
        Measure(quantity, "VDV", weighted.vdv, f"{unit}/s^1.75", by, notes.get("VDV", "")),
    ]


def _verdicts(felt: Comfort, unit: str) -> dict[str, str]:
    """Say what ISO 2631-1 makes of a vibration, by the measure that it judges; nothing of motion sickness."""
    if felt.weighting == "Wf" or not felt.rms:
        return {}
    limits = {
        "crest": f"{ISO_2631.crest_limit:g}",
        "MTVV": f"{ISO_2631.mtvv_limit:g} times the weighted rms",
        "VDV": f"{ISO_2631.vdv_limit:g} times the weighted rms times the fourth root of the duration",
    }
    return {
        "rms": f"{', or '.join(felt.reactions)} (ISO 2631-1, C.2.3)" if unit == "m" else "",
        **{
            name: f"above {limit}: the rms alone understates this vibration"
            if name in felt.exceeded
            else f"not above {limit}"
            for name, limit in limits.items()
        },
    }


def _rms_and_peak(quantity: str, values: FloatArray, units: str) -> list[Measure]:
    return [
        Measure(quantity, "rms", _rms(values), units),
        Measure(quantity, "peak", float(np.abs(values).max()), units),
    ]


def _rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def _check_chosen(check: Checks, name: str, chosen: Sequence[object] | None, there: list[object]) -> None:
    for each in chosen or ():
        if each not in there:
            check.refuse(name, f"must be among {', '.join(map(str, there))}, got {each!r}")


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
        check_random(check, result)
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
            Measure(force, "expected peak", peak, "N", SOURCES.peak),
            Measure(force, "crossing rate", at.contact_force_crossing_rate.item(), "1/s", SOURCES.crossings),
            Measure(force, "irregularity", at.contact_force_irregularity.item(), "1", SOURCES.crossings),
            Measure(total, "dynamic load coefficient", coefficient, "1", SOURCES.load),
            Measure(total, "road stress factor", float(road_stress_factor(coefficient)), "1", SOURCES.stress),
            Measure(total, "expected largest", load + peak, "N", SOURCES.peak),
            Measure(total, "lift-offs", at.lift_off_rate.item(), "1/s", SOURCES.crossings),
            Measure(total, "share lifted off", at.lift_off_share.item(), "1"),
        ]
        if equivalent is not None:
            amplitude = float(equivalent[contact])
            found.append(Measure(force, "damage-equivalent amplitude at 1 Hz", amplitude, "N", SOURCES.damage))
    for contact in result.contact.values.tolist():
        at = result.isel(contact=contact)
        quantity = f"contact {contact} deflection"
        found += [
            Measure(quantity, "static", at.static_deflection.item(), "m"),
            Measure(quantity, "rms", at.deflection_rms.item(), "m"),
            Measure(quantity, "expected peak", at.deflection_expected_peak.item(), "m", SOURCES.peak),
            Measure(quantity, "crossing rate", at.deflection_crossing_rate.item(), "1/s", SOURCES.crossings),
        ]
    for dof in range(result.sizes["dof"]):
        at = result.isel(dof=dof)
        quantity, unit = f"{at.dof.item()} acceleration", f"{at.dof_unit.item()}/s²"
        weighting = WEIGHTING_OF[at.dof_unit.item()]
        found += [
            Measure(quantity, "rms", at.acceleration_rms.item(), unit),
            Measure(quantity, "expected peak", at.acceleration_expected_peak.item(), unit, SOURCES.peak),
            Measure(quantity, "crossing rate", at.acceleration_crossing_rate.item(), "1/s", SOURCES.crossings),
            Measure(quantity, f"weighted rms ({weighting})", at.weighted_acceleration.item(), unit, "ISO 2631-1"),
        ]
    return found

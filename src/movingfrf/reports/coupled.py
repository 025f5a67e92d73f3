"""One HTML page about a result: settings, findings, measures and figures, with nothing outside the page."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import numpy as np

from movingfrf._basics import wording
from movingfrf._basics.wording import number, plain
from movingfrf.guideways.guideway import Guideway
from movingfrf.metrics.measures import measures
from movingfrf.reports import illustrations, plots
from movingfrf.reports.page import Column, Row, Setting, Table, measure_tables, page
from movingfrf.results.labels import duration_of, speed_in_words, time_step_of

if TYPE_CHECKING:
    import xarray as xr


CAPTIONS = {
    "force": "Contact forces. The dynamic part is what the roughness adds to the static level; the dynamic load "
    "coefficient is its rms over the static force.",
    "deflection": "Deflections of the road under the contacts, positive down.",
    "acceleration": "Accelerations about the steady state, as they are and as people feel them: weighted with Wk "
    "of ISO 2631-1.",
    "angular acceleration": "Angular accelerations about the steady state, as they are and weighted with We of "
    "ISO 2631-1.",
}


def render(result: xr.Dataset, *, guideway: Guideway, scenario_text: str = "", title: str = "") -> str:
    """Write the report of a result.

    Parameters
    ----------
    result : xarray.Dataset
        What `simulate` or `moving_loads` returned.
    guideway : Guideway
        The guideway that it was computed for; its moving FRFs are drawn.
    scenario_text : str
        Text of the scenario file, shown as it is; by default what the result carries, if anything.
    title : str
        Title of the page; by default what the result calls itself.

    Returns
    -------
    str
        One HTML page without references to anything outside it. Equal input gives equal text.
    """
    coupled = "contact_force" in result
    with illustrations.drawing():
        figures = (
            illustrations.of_coupled(result, guideway) if coupled else illustrations.of_loads(result, guideway)
        )
    return page(
        title=title or result.attrs.get("title", "Response of a guideway"),
        version=result.attrs.get("movingfrf", "of unknown version"),
        summary=_coupled_summary(result) if coupled else _loaded_summary(result),
        settings=_settings(result),
        findings=_findings(result),
        no_findings=_no_findings(coupled),
        tables=measure_tables(result, measures(result), CAPTIONS) if coupled else _loaded_tables(result),
        figures=figures,
        method=_coupled_method() if coupled else _loaded_method(),
        scenario=scenario_text or result.attrs.get("scenario", ""),
    )


def _coupled_summary(result: xr.Dataset) -> str:
    contacts, dofs = result.sizes["contact"], result.sizes["dof"]
    road = "rough road" if illustrations.is_rough(result) else "smooth road"
    weight = number(1e-3 * float(result.static_load.values.sum()))
    return (
        f"A vehicle of {weight} kN with {wording.count(contacts, 'contact')} and "
        f"{wording.count(dofs, 'degree of freedom', 'degrees of freedom')} travels at {speed_in_words(result)} for "
        f"{plain(duration_of(result))} s over a {road}; contact forces, deflections of "
        "the road and motions of the vehicle were computed together, in the frequency domain, with moving "
        "frequency response functions (moving FRFs)."
    )


def _loaded_summary(result: xr.Dataset) -> str:
    return (
        f"{wording.count(result.sizes['load'], 'prescribed force')} on a road, travelling at "
        f"{speed_in_words(result)} for {plain(duration_of(result))} s from rest at t = 0; the deflection at "
        f"{wording.count(result.sizes['point'], 'point')} travelling along was computed in the frequency domain "
        "with moving frequency response functions (moving FRFs)."
    )


def _settings(result: xr.Dataset) -> list[Setting]:
    attrs, duration, step = result.attrs, duration_of(result), time_step_of(result)
    critical = attrs.get("critical_speed", float("inf"))
    speed = attrs["speed"]
    found = [
        Setting("Speed", f"{plain(speed)} m/s", f"{plain(round(3.6 * speed, 6))} km/h"),
        Setting("Duration", f"{plain(duration)} s"),
        Setting("Distance", f"{plain(float(f'{duration * abs(speed):.12g}'))} m"),
        Setting("Time step", f"{plain(1e3 * step)} ms", f"{result.sizes['time']} samples"),
        *_truncation_settings(result),
        Setting(
            "Critical speed of the road",
            f"{number(critical)} m/s" if np.isfinite(critical) else "none",
            f"{number(3.6 * critical)} km/h; this speed is {number(100 * abs(speed) / critical, 3)} % of it"
            if np.isfinite(critical)
            else "",
        ),
    ]
    if "start" in attrs:
        found.append(Setting("Start", f"{plain(attrs['start'])} m", "of the vehicle's reference point, at t = 0"))
    if "blend" in attrs:
        found.append(Setting("Blend", f"{plain(attrs['blend'])} m", "over which the profile sets in"))
    if "datum" in attrs:
        found.append(Setting("Datum", f"{number(attrs['datum'])} m", "subtracted from the profile's elevations"))
    if "road" in attrs:
        found.append(Setting("Roughness", attrs["road"], wide=True))
    if "guideway" in attrs:
        found.append(Setting("Road (SI units)", attrs["guideway"], wide=True))
    return found


def _truncation_settings(result: xr.Dataset) -> list[Setting]:
    if "truncation" not in result.attrs:
        return []
    truncation, coupled = result.attrs["truncation"], "contact_force" in result
    if not coupled:
        if truncation >= 0.5 / time_step_of(result):
            return [Setting("Truncation", "none", "every frequency of the record is kept")]
        return [Setting("Truncation", f"{plain(truncation)} Hz", "the response beyond it is left out")]
    error = result.attrs.get("truncation_error")
    return [
        Setting("Truncation", f"{truncation:.4g} Hz", "beyond it the road counts as rigid"),
        *(
            [
                Setting(
                    "Estimated truncation error",
                    number(error, 2),
                    "largest change of an output by the truncation, over the output's rms",
                )
            ]
            if error is not None
            else []
        ),
    ]


def _findings(result: xr.Dataset) -> list[str]:
    """Messages as sentences."""
    messages = [finding["message"] for finding in json.loads(result.attrs.get("findings", "[]"))]
    return [f"{message[:1].upper()}{message[1:].rstrip('.')}." for message in messages]


def _no_findings(coupled: bool) -> str:
    if coupled:
        return (
            "No findings: contact is kept throughout, the speed is well below critical, the response dies away "
            "within the padded record, and truncation and time step leave nothing of weight out."
        )
    return "No findings: the speed is well below critical and the response dies away within the padded record."


def _coupled_method() -> list[str]:
    return [
        "Vehicle and road are linear, and the speed is constant.",
        "The road is infinitely long and the same everywhere along its length; only its surface is rough.",
        "Contact is kept at all times: where a total contact force would turn negative the model pulls, and the "
        "findings say so.",
        "Before the record the vehicle has travelled on the smooth road for ever: static loads and steady sag are "
        "there from the start, and the roughness sets in from the foremost contact on.",
        "At every frequency the contact forces F solve (I + D G) F = D R, with G the moving FRFs between the "
        "contacts, D the dynamic stiffness of the vehicle at its contacts and R the elevation under them. Beyond "
        "the truncation G = 0: the road is rigid there, the vehicle is not.",
        "Forces, deflections and motions are positive downward (pitch: nose down), elevations upward; positions "
        "are positive ahead. Spectra are one-sided, estimated by Welch's method (Hann window, half overlap).",
    ]


def _loaded_method() -> list[str]:
    return [
        "The road is linear, infinitely long and the same everywhere along its length; the speed is constant.",
        "The forces are given and do not depend on what the road does. Before t = 0 the road is at rest; a force "
        "that is not zero at t = 0 is switched on at that instant.",
        "At every frequency the deflections are W = G F, with G the moving FRFs between loads and points.",
        "Forces and deflections are positive downward; positions are positive ahead. Spectra are one-sided, "
        "estimated by Welch's method (Hann window, half overlap).",
    ]


# Tables


def _loaded_tables(result: xr.Dataset) -> list[Table]:
    return [_load_table(result), _point_table(result)]


def _load_table(result: xr.Dataset) -> Table:
    drawn = {curve.column: curve.colour for curve in plots.load_curves(result)}
    rows = []
    for curve in plots.load_curves(result, range(result.sizes["load"])):
        force = 1e-3 * result.force.values[:, curve.column]
        cells = [number(float(value)) for value in (force.mean(), force.std(), force.min(), force.max())]
        rows.append(Row(curve.name, cells, drawn.get(curve.column, "")))
    names = ("mean", "rms about the mean", "smallest", "largest")
    return Table("Prescribed forces, down.", "load", [Column(name, "kN") for name in names], rows)


def _point_table(result: xr.Dataset) -> Table:
    drawn = {curve.column: curve.colour for curve in plots.point_curves(result)}
    time = result.time.values
    rows = []
    for curve in plots.point_curves(result, range(result.sizes["point"])):
        deflection = 1e3 * result.deflection.values[:, curve.column]
        largest, smallest = deflection.argmax(), deflection.argmin()
        cells = [
            number(float(deflection[largest])),
            f"{time[largest]:.6g}",
            number(float(deflection[smallest])),
            f"{time[smallest]:.6g}",
            number(float(np.sqrt(np.mean(deflection**2)))),
            number(float(deflection[-1])),
        ]
        rows.append(Row(curve.name, cells, drawn.get(curve.column, "")))
    columns = [
        Column("largest", "mm"),
        Column("at time", "s"),
        Column("smallest", "mm"),
        Column("at time", "s"),
        Column("rms", "mm"),
        Column("at the end", "mm"),
    ]
    return Table("Deflections of the road, down.", "observation point", columns, rows)

"""One HTML page about a result: settings, findings, measures and figures, with nothing outside the page."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import numpy as np

from movingfrf._basics.wording import number, plain
from movingfrf.guideways.guideway import Guideway
from movingfrf.reports.coupled import coupled_method, coupled_summary, coupled_tables, of_coupled
from movingfrf.reports.figures import drawing
from movingfrf.reports.loaded import loaded_method, loaded_summary, loaded_tables, of_loads
from movingfrf.reports.page import page
from movingfrf.reports.tables import Setting
from movingfrf.reports.ways import is_stepped, way_settings
from movingfrf.results.labels import HISTORIES, duration_of, kind_of, resolved, speeds_of, time_step_of

if TYPE_CHECKING:
    import xarray as xr


def render(result: xr.Dataset, *, guideway: Guideway | None, scenario_text: str = "", title: str = "") -> str:
    """Write the report of a result.

    Parameters
    ----------
    result : xarray.Dataset
        What `simulate`, `moving_loads`, `cdfm`, `sim` or `newmark_loads` returned.
    guideway : Guideway, optional
        The guideway that it was computed for; its moving FRFs are drawn. None: a finite road, which has none.
    scenario_text : str
        Text of the scenario file, shown as it is; by default what the result carries, if anything.
    title : str
        Title of the page; by default what the result calls itself.

    Returns
    -------
    str
        One HTML page without references to anything outside it. Equal input gives equal text.

    Raises
    ------
    ValueError
        If it is a result of another kind.
    """
    kind = kind_of(result)
    if kind not in HISTORIES:
        raise ValueError(f"result must be of a kind that has histories, {' or '.join(HISTORIES)}, got {kind}")
    coupled, solved = kind == "coupled", resolved(result)
    with drawing():
        figures = of_coupled(solved, guideway) if coupled else of_loads(solved, guideway)
    return page(
        title=title or result.attrs.get("title", "Response of a guideway"),
        version=result.attrs.get("movingfrf", "of unknown version"),
        summary=coupled_summary(result) if coupled else loaded_summary(result),
        settings=_settings(result),
        findings=_findings(result),
        no_findings=_no_findings(result),
        tables=coupled_tables(solved) if coupled else loaded_tables(solved),
        figures=figures,
        method=coupled_method(result) if coupled else loaded_method(result),
        scenario=scenario_text or result.attrs.get("scenario", ""),
    )


def _settings(result: xr.Dataset) -> list[Setting]:
    attrs, duration, step = result.attrs, duration_of(result), time_step_of(result)
    speed = attrs["speed"]
    found = [
        *way_settings(result),
        Setting("Speed", *speeds_of(result)),
        Setting("Duration", f"{plain(duration)} s"),
        Setting("Distance", f"{duration * abs(speed):g} m"),
        Setting("Time step", f"{plain(1e3 * step)} ms", f"{result.sizes['time']} samples"),
        *_truncation_settings(result),
    ]
    if "solved_step" in attrs:
        solved = f"{1e3 * attrs['solved_step']:.3g} ms"
        found.append(Setting("Solved in steps of", solved, "as fine as road, or loads, and system need"))
    if "critical_speed" in attrs:
        critical = attrs["critical_speed"]
        found.append(
            Setting(
                "Critical speed of the road",
                f"{number(critical)} m/s" if np.isfinite(critical) else "none",
                f"{number(3.6 * critical)} km/h; this speed is {number(100 * abs(speed) / critical, 3)} % of it"
                if np.isfinite(critical)
                else "",
            )
        )
    if "start" in attrs:
        of = "the vehicle's reference point" if "contact_force" in result else "the frame that travels along"
        found.append(Setting("Start", f"{plain(attrs['start'])} m", f"of {of}, at t = 0"))
    if "blend" in attrs:
        found.append(Setting("Blend", f"{plain(attrs['blend'])} m", "over which the profile sets in"))
    if "datum" in attrs:
        found.append(Setting("Datum", f"{number(attrs['datum'])} m", "subtracted from the profile's elevations"))
    if attrs.get("grade"):
        grade = f"{100 * attrs['grade']:+.3g} %"
        found.append(Setting("Grade", grade, "part of the steady state: elevation and motion are about it"))
    if "road" in attrs:
        found.append(Setting("Roughness", attrs["road"], wide=True))
    if "guideway" in attrs:
        found.append(Setting("Road (SI units)", attrs["guideway"], wide=True))
    return found


def _truncation_settings(result: xr.Dataset) -> list[Setting]:
    if "truncation" not in result.attrs:
        return []
    truncation, coupled = result.attrs["truncation"], kind_of(result) == "coupled"
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


def _no_findings(result: xr.Dataset) -> str:
    coupled = kind_of(result) == "coupled"
    if is_stepped(result):
        return "No findings: contact is kept throughout." if coupled else "No findings."
    if coupled:
        return (
            "No findings: contact is kept throughout, the speed is well below critical, the response dies away "
            "within the padded record, and truncation and time step leave nothing of weight out."
        )
    return "No findings: the speed is well below critical and the response dies away within the padded record."

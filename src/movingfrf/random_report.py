"""One HTML page about the response to a random road: spectral densities, statistics, findings."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from movingfrf import illustrations, plots, wording
from movingfrf._checks import FloatArray
from movingfrf.illustrations import Illustration
from movingfrf.metrics.basic import Measure
from movingfrf.page import Column, Row, Setting, Table, page
from movingfrf.wording import number, plain

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SCALES = {"N": ("kN", 1e-3), "m": ("mm", 1e3), "1": ("", 1.0)}


def render(result: xr.Dataset, found: Sequence[Measure], *, title: str, scenario: str = "") -> str:
    """Write the report of a random response.

    Parameters
    ----------
    result : xarray.Dataset
        What `random_response` returned.
    found : sequence of Measure
        Its measures.
    title : str
        Title of the page.
    scenario : str
        Text of the scenario file, shown as it is.

    Returns
    -------
    str
        One HTML page without references to anything outside it. Equal input gives equal text.
    """
    with illustrations.drawing():
        figures = [_forces(result), *_motions(result), _deflections(result), _surface(result)]
    messages = [finding["message"] for finding in json.loads(result.attrs["findings"])]
    contacts = wording.count(result.sizes["contact"], "contact")
    weight = number(1e-3 * float(result.static_load.values.sum()))
    return page(
        title=title,
        version=result.attrs["movingfrf"],
        summary=f"A vehicle of {weight} kN with {contacts} travels at {wording.speed(result)} over a random road: "
        "the stationary response, computed from the road's spectrum in closed form. No road was realised: root "
        "mean squares, crossing rates and expected peaks are those of all roads with this spectrum.",
        settings=_settings(result),
        findings=[f"{message[:1].upper()}{message[1:].rstrip('.')}." for message in messages],
        no_findings="No findings: contact is unlikely to be lost within the exposure, the speed is well below "
        "critical, and the forces have no content of weight at the end of the spectrum's band.",
        tables=_tables(found),
        figures=figures,
        method=_method(),
        scenario=scenario,
    )


def paths(result: xr.Dataset) -> str:
    """Say what the paths of a random road have in common.

    Parameters
    ----------
    result : xarray.Dataset
        What `random_response` returned.

    Returns
    -------
    str
        A few words, or the model as it was given.
    """
    coherence = str(result.attrs["coherence"])
    words = {
        "one path": "one path under all contacts",
        "1.0": "one road under all wheels",
        "0.0": "paths without anything in common",
    }
    return words.get(coherence, f"coherence {coherence}")


def _settings(result: xr.Dataset) -> list[Setting]:
    attrs = result.attrs
    speed, critical = attrs["speed"], attrs["critical_speed"]
    low, high = attrs["lowest_frequency"], attrs["highest_frequency"]
    return [
        Setting("Speed", f"{plain(speed)} m/s", f"{plain(round(3.6 * speed, 6))} km/h"),
        Setting("Exposure", f"{plain(attrs['exposure'])} s", "for which the largest values are expected"),
        Setting("Band", f"{number(low)} to {number(high)} Hz", "in which the road has content at this speed"),
        Setting("Frequencies", str(attrs["frequencies"]), "placed where the densities need them"),
        Setting(
            "Critical speed of the road",
            f"{number(critical)} m/s" if np.isfinite(critical) else "none",
            f"{number(3.6 * critical)} km/h; this speed is {number(100 * speed / critical, 3)} % of it"
            if np.isfinite(critical)
            else "",
        ),
        Setting("Spectrum (SI units)", attrs["spectrum"], wide=True),
        Setting("Paths", paths(result), wide=True),
        Setting("Road (SI units)", attrs["guideway"], wide=True),
    ]


def _method() -> list[str]:
    return [
        "Vehicle and road are linear, the speed is constant, and the road is infinitely long and the same "
        "everywhere along its length; only its surface is rough, a stationary Gaussian process.",
        "At every frequency the transfer functions from the elevation under each contact follow from "
        "(I + D G) F = D R, as they do for a given profile. The elevations under two contacts have the "
        "cross-spectral density G_d(f/v)/v · γ · exp(iω(x₁ − x₂)/v): the same road one after the other, γ the "
        "coherence of their paths.",
        "Spectral densities are one-sided, per Hz. Their moments are integrated by Gauss points on panels that "
        "were halved until every density was resolved.",
        "Crossing and peak rates are those of Rice for a Gaussian process. The expected peak is the mean of the "
        "largest value within the exposure, on one side of the steady state, if crossings of a high level are "
        "independent; where a response comes in bursts (irregularity near 1) it is a few per cent too large.",
        "Contact is kept at all times: how often a total contact force would turn negative is part of the tables.",
        "Accelerations are weighted after ISO 2631-1, Wk in m/s² and We in rad/s², whatever the degree of freedom "
        "is; for comfort only those of the body or a seat have a meaning.",
    ]


def _tables(found: Sequence[Measure]) -> list[Table]:
    """Put forces in one table, loads in the next, then deflections, then accelerations."""
    captions = {
        "force": "Contact forces: the static one, and the dynamic one that the roughness adds.",
        "load": "Total contact forces, static and dynamic, and what they do to the road. The dynamic load "
        "coefficient is the rms of the dynamic force over the static one.",
        "deflection": "Deflections of the road under the contacts; rms and peak of the dynamic part.",
        "acceleration": "Accelerations about the steady state.",
    }
    tables = []
    for kind, caption in captions.items():
        rows: dict[str, list[Measure]] = {}
        for measure in found:
            place, _, quantity = measure.quantity.rpartition(" ")
            if quantity == kind:
                rows.setdefault(place, []).append(measure)
        columns = list(zip(*rows.values(), strict=True))
        units = [{measure.units for measure in column} for column in columns]
        heads = [
            Column(column[0].name, SCALES.get(column[0].units, (column[0].units, 1.0))[0] if len(used) == 1 else "")
            for column, used in zip(columns, units, strict=True)
        ]
        tables.append(
            Table(
                caption,
                "degree of freedom" if kind == "acceleration" else "contact",
                heads,
                [
                    Row(
                        plots.readable(place),
                        [_cell(measure, len(used) > 1) for measure, used in zip(measures, units, strict=True)],
                    )
                    for place, measures in rows.items()
                ],
            )
        )
    return tables


def _cell(measure: Measure, with_unit: bool) -> str:
    unit, scale = SCALES.get(measure.units, (measure.units, 1.0))
    if np.isnan(measure.value):
        return "–"
    return number(scale * measure.value) + (f" {unit}" if with_unit else "")


def _figure(result: xr.Dataset, quantity: str, curves: Sequence[plots.Curve], scale: float, label: str) -> Figure:
    """Draw amplitude densities over frequency, and below them which share of the variance lies below it."""
    figure = illustrations.blank(illustrations.SINGLE + illustrations.PANEL)
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(5, 3))
    frequency, bandwidth = result.frequency.values, result.bandwidth.values
    highest = 0.0
    for curve in curves:
        density = result[f"{quantity}_density"].values[:, curve.column]
        amplitude, share = scale * np.sqrt(density), np.cumsum(bandwidth * density)
        highest = max(highest, float(amplitude.max()))
        if share[-1]:
            above.plot(frequency, amplitude, color=curve.colour, label=curve.name)
            below.plot(frequency, 100 * share / share[-1], color=curve.colour)
    if highest:
        above.set(yscale="log", ylim=(highest * np.sqrt(plots.DRAWN_RANGE), 2 * highest))
    above.set_ylabel(label)
    below.set(ylim=(0, 101), xlabel="frequency [Hz]", ylabel="variance below [%]")
    _logarithmic(below, frequency)
    plots.legend_above(above)
    return figure


def _logarithmic(ax: Axes, values: FloatArray) -> None:
    """Scale an axis logarithmically over increasing values, with plain numbers on it."""
    from matplotlib.ticker import FuncFormatter, LogLocator

    ax.set(xscale="log", xlim=(values[0], values[-1]))
    ax.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if values[-1] < 3e3 * values[0] else (1.0,)))
    ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    ax.xaxis.set_minor_locator(LogLocator(subs=()))


def _forces(result: xr.Dataset) -> Illustration:
    figure = _figure(result, "contact_force", plots.contact_curves(result), 1.0, "force amplitude density [N/√Hz]")
    caption = (
        "Amplitude spectral density of the dynamic contact forces, and the share of their variance that lies below "
        "a frequency: where that curve is steep, the force comes from. The humps are the vibrations of the body "
        "and of the wheels; dips between them come from the wheelbase, by which some waves lift and others pitch."
    )
    caption += wording.some_of(result.sizes["contact"], plots.MOST_CURVES, "contacts")
    return illustrations.illustrated("forces", "Contact forces", caption, figure)


def _deflections(result: xr.Dataset) -> Illustration:
    label = "deflection density [µm/√Hz]"
    figure = _figure(result, "deflection", plots.contact_curves(result), 1e6, label)
    caption = (
        "Amplitude spectral density of the dynamic deflection of the road under each contact, and shares below."
    )
    caption += wording.some_of(result.sizes["contact"], plots.MOST_CURVES, "contacts")
    return illustrations.illustrated("deflections", "Deflections", caption, figure)


def _motions(result: xr.Dataset) -> list[Illustration]:
    """Accelerations in m/s², then those in rad/s²."""
    found = []
    for unit, heading in (("m", "Accelerations"), ("rad", "Angular accelerations")):
        dofs = np.flatnonzero(result.dof_unit.values == unit)
        if not dofs.size:
            continue
        curves = [
            plots.Curve(int(dofs[n]), plots.readable(str(result.dof.values[dofs[n]])), plots.PALETTE[rank])
            for rank, n in enumerate(plots.shown(dofs.size))
        ]
        figure = _figure(result, "acceleration", curves, 1.0, f"acceleration density [{unit}/s²/√Hz]")
        caption = (
            "Amplitude spectral density of the accelerations, and the share of their variance below a frequency."
        )
        caption += wording.some_of(dofs.size, plots.MOST_CURVES, "degrees of freedom")
        found.append(illustrations.illustrated(f"motion-{unit}", heading, caption, figure))
    return found


def _surface(result: xr.Dataset) -> Illustration:
    figure = illustrations.blank(illustrations.SINGLE)
    (ax,) = figure.subplots(1, 1, squeeze=False)[0]
    n, speed = result.frequency.values / result.attrs["speed"], result.attrs["speed"]
    for curve in plots.contact_curves(result):
        seen = speed * result.roughness_density.values[:, curve.column]
        ax.plot(n, np.where(seen > 0, seen, np.nan), color=curve.colour, label=curve.name)
    ax.set(yscale="log", xlabel="spatial frequency [cycle/m]")
    _logarithmic(ax, n)
    ax.set_ylabel("spectral density $G_d$ [m³]")
    plots.legend_above(ax)
    caption = "Spectral density of the road as the contacts see it; a footprint takes the short waves away."
    return illustrations.illustrated("surface", "Road", caption, figure)

"""One HTML page about the response to a random road: spectral densities, statistics, findings."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from movingfrf._basics import wording
from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.wording import number, plain
from movingfrf.metrics.listed import RANDOM_CAPTIONS
from movingfrf.reports.axes import SPECTRUM_STYLE, decimated, draw_classes, legend_above
from movingfrf.reports.curves import PALETTE, Curve, contact_curves, distinct, left_out_dofs, readable, telling
from movingfrf.reports.figures import SIZE, Illustration, blank, drawing, illustrated
from movingfrf.reports.page import page
from movingfrf.reports.tables import Setting, measure_tables
from movingfrf.results.labels import Measure, speed_in_words, speeds_of
from movingfrf.roughness.spectra.iso import IsoRoad

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


# Frequencies of the figures [600 to 5000: more than a screen resolves, fewer than make a page heavy].
DRAWN_FREQUENCIES = 1200


def render(
    result: xr.Dataset,
    found: Sequence[Measure],
    *,
    title: str,
    scenario: str = "",
    drawn: xr.Dataset | None = None,
) -> str:
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
    drawn : xarray.Dataset, optional
        The same response at `drawing_frequencies`; by default curves have the corners of the result's frequencies.

    Returns
    -------
    str
        One HTML page without references to anything outside it. Equal input gives equal text.
    """
    curves = result if drawn is None else drawn
    with drawing():
        figures = [_forces(curves), *_motions(curves), _deflections(curves), _surface(curves)]
    messages = [finding["message"] for finding in json.loads(result.attrs["findings"])]
    contacts = wording.count(result.sizes["contact"], "contact")
    weight = number(1e-3 * float(result.static_load.values.sum()))
    return page(
        title=title,
        version=result.attrs["movingfrf"],
        summary=f"A vehicle of {weight} kN with {contacts} travels at {speed_in_words(result)} over a random road: "
        "the stationary response, computed from the road's spectrum in closed form. No road was realised: root "
        "mean squares, crossing rates and expected peaks are those of all roads with this spectrum.",
        settings=_settings(result),
        findings=[f"{message[:1].upper()}{message[1:].rstrip('.')}." for message in messages],
        no_findings="No findings: contact is unlikely to be lost within the exposure, the speed is well below "
        "critical, and the forces have no content of weight at the end of the spectrum's band.",
        tables=measure_tables(result, found, RANDOM_CAPTIONS),
        figures=figures,
        method=_method(),
        scenario=scenario,
    )


def drawing_frequencies(result: xr.Dataset) -> FloatArray:
    """Frequencies at which curves are smooth: those of the result, where densities vary, and many in between.

    Parameters
    ----------
    result : xarray.Dataset
        What `random_response` returned.

    Returns
    -------
    ndarray, shape (frequency,)
        Frequencies [Hz].
    """
    lines = result.frequency.values
    return np.union1d(lines, np.geomspace(lines[0], lines[-1], DRAWN_FREQUENCIES))


def paths_in_words(result: xr.Dataset) -> str:
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
    several = len(np.unique(result.path.values)) > 1
    words = {
        "one path": "one path under all contacts",
        "1.0": "one road under all wheels"
        + (": left and right see the same, and nothing makes the vehicle roll" if several else ""),
        "0.0": "paths without anything in common",
    }
    return words.get(coherence, f"coherence {coherence}")


def _settings(result: xr.Dataset) -> list[Setting]:
    attrs = result.attrs
    speed, critical = attrs["speed"], attrs["critical_speed"]
    low, high = attrs["lowest_frequency"], attrs["highest_frequency"]
    return [
        Setting("Speed", *speeds_of(result)),
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
        Setting("Spectrum", attrs["spectrum"], wide=True),
        Setting("Paths", paths_in_words(result), wide=True),
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


def _figure(result: xr.Dataset, quantity: str, curves: Sequence[Curve], scale: float, label: str) -> Figure:
    """Draw amplitude densities over frequency, and below them which share of the variance lies below it."""
    figure = blank(SIZE.single + SIZE.panel)
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(5, 3))
    frequency, densities = result.frequency.values, result[f"{quantity}_density"].values
    lowest, highest = np.inf, 0.0
    for curve in distinct(curves, densities):
        density = densities[:, curve.column]
        amplitude, share = scale * np.sqrt(density), _below(frequency, density)
        if share[-1]:
            lowest, highest = min(lowest, float(amplitude.min())), max(highest, float(amplitude.max()))
            above.plot(*_thinned(frequency, amplitude), color=curve.colour, label=curve.name)
            below.plot(*_thinned(frequency, 100 * share / share[-1]), color=curve.colour)
    if highest:
        above.set(yscale="log", ylim=(max(lowest / 1.5, highest * np.sqrt(SPECTRUM_STYLE.depth)), 1.5 * highest))
    above.set_ylabel(label)
    below.set(ylim=(0, 101), xlabel="frequency [Hz]", ylabel="variance below [%]")
    _logarithmic(below, frequency)
    legend_above(above)
    return figure


def _below(frequency: FloatArray, density: FloatArray) -> FloatArray:
    """Integrate a density up to every frequency, by trapezoids."""
    return np.append(0.0, np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(frequency)))


def _thinned(frequency: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    return decimated(frequency, values, buckets=DRAWN_FREQUENCIES // 2, logarithmic=True)


def _logarithmic(ax: Axes, values: FloatArray) -> None:
    """Scale an axis logarithmically over increasing values, with plain numbers on it."""
    from matplotlib.ticker import FuncFormatter, LogLocator

    ax.set(xscale="log", xlim=(values[0], values[-1]))
    ax.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if values[-1] < 3e3 * values[0] else (1.0,)))
    ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    ax.xaxis.set_minor_locator(LogLocator(subs=()))


def _forces(result: xr.Dataset) -> Illustration:
    figure = _figure(result, "contact_force", contact_curves(result), 1.0, "force amplitude density [N/√Hz]")
    caption = (
        "Amplitude spectral density of the dynamic contact forces, and the share of their variance that lies below "
        "a frequency: where that curve is steep, the force comes from. The humps are the vibrations of the body "
        "and of the wheels; dips between them come from the wheelbase, by which some waves lift and others pitch."
    )
    caption += wording.some_of(result.sizes["contact"], wording.MOST_CURVES, "contacts")
    return illustrated("forces", "Contact forces", caption, figure)


def _deflections(result: xr.Dataset) -> Illustration:
    label = "deflection density [µm/√Hz]"
    figure = _figure(result, "deflection", contact_curves(result), 1e6, label)
    caption = (
        "Amplitude spectral density of the dynamic deflection of the road under each contact, and shares below."
    )
    caption += wording.some_of(result.sizes["contact"], wording.MOST_CURVES, "contacts")
    return illustrated("deflections", "Deflections", caption, figure)


def _motions(result: xr.Dataset) -> list[Illustration]:
    """Accelerations in m/s², then those in rad/s²."""
    found = []
    for unit, heading in (("m", "Accelerations"), ("rad", "Angular accelerations")):
        dofs = np.flatnonzero(result.dof_unit.values == unit)
        if not dofs.size:
            continue
        curves = [
            Curve(int(dofs[n]), readable(str(result.dof.values[dofs[n]])), PALETTE[rank])
            for rank, n in enumerate(
                telling(result.acceleration_rms.values[dofs], [unit] * dofs.size, wording.MOST_CURVES)
            )
        ]
        figure = _figure(result, "acceleration", curves, 1.0, f"acceleration density [{unit}/s²/√Hz]")
        caption = (
            "Amplitude spectral density of the accelerations, and the share of their variance below a frequency."
        )
        caption += left_out_dofs(dofs.size, len(curves))
        found.append(illustrated(f"motion-{unit}", heading, caption, figure))
    return found


def _surface(result: xr.Dataset) -> Illustration:
    figure = blank(SIZE.single)
    (ax,) = figure.subplots(1, 1, squeeze=False)[0]
    n, speed = result.frequency.values / result.attrs["speed"], result.attrs["speed"]
    ends = n[[0, -1]]
    lowest, highest = IsoRoad.of_class("A").density(n)[-1], IsoRoad.of_class("H").density(n)[-1]
    for curve in distinct(contact_curves(result), result.roughness_density.values):
        seen = speed * result.roughness_density.values[:, curve.column]
        ax.plot(*_thinned(n, seen), color=curve.colour, label=curve.name)
        lowest, highest = min(lowest, seen[-1]), max(highest, float(seen.max()))
    ax.set(yscale="log", xlabel="spatial frequency [cycle/m]")
    ax.set_ylim(max(lowest / 10, 1e-3 * SPECTRUM_STYLE.depth * highest), 5 * highest)
    _logarithmic(ax, n)
    draw_classes(ax, ends)
    ax.set_ylabel("spectral density [m³]")
    legend_above(ax)
    caption = (
        "Spectral density of the road as the contacts see it, among the centre lines of the ISO 8608 classes A "
        "(smooth) to H (rough); a footprint takes the short waves away."
    )
    return illustrated("surface", "Road", caption, figure)

"""What a report says about prescribed loads."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from movingfrf._basics import wording
from movingfrf._basics.wording import number, plain
from movingfrf.guideways.guideway import Guideway
from movingfrf.reports import plots
from movingfrf.reports.axes import legend_above
from movingfrf.reports.curves import load_curves, point_curves
from movingfrf.reports.figures import SIZE, Illustration, blank, illustrated
from movingfrf.reports.frf import frf_figures
from movingfrf.reports.tables import Column, Row, Table
from movingfrf.reports.ways import is_stepped, stepped_road, way
from movingfrf.results.labels import duration_of, speed_in_words

if TYPE_CHECKING:
    import xarray as xr


def loaded_summary(result: xr.Dataset) -> str:
    """Say in a sentence what was computed."""
    return (
        f"{wording.count(result.sizes['load'], 'prescribed force')} on a road, travelling at "
        f"{speed_in_words(result)} for {plain(duration_of(result))} s from rest at t = 0; the deflection at "
        f"{wording.count(result.sizes['point'], 'point')} travelling along was computed {way(result).words}."
    )


def loaded_method(result: xr.Dataset) -> list[str]:
    """Say how it was computed, and what is assumed."""
    return [
        "The road is linear; the speed is constant.",
        "The forces are given and do not depend on what the road does. Before t = 0 the road is at rest; a force "
        "that is not zero at t = 0 is switched on at that instant.",
        stepped_road(result)
        if is_stepped(result)
        else "The road is infinitely long and the same everywhere along its length. At every frequency the "
        "deflections are W = G F, with G the moving FRFs between loads and points.",
        "Forces and deflections are positive downward; positions are positive ahead. Spectra are one-sided, "
        "estimated by Welch's method (Hann window, half overlap).",
    ]


# Tables


def loaded_tables(result: xr.Dataset) -> list[Table]:
    """Put forces and deflections into tables."""
    return [_load_table(result), _point_table(result)]


def _load_table(result: xr.Dataset) -> Table:
    drawn = {curve.column: curve.colour for curve in load_curves(result)}
    rows = []
    for curve in load_curves(result, range(result.sizes["load"])):
        force = 1e-3 * result.force.values[:, curve.column]
        cells = [number(float(value)) for value in (force.mean(), force.std(), force.min(), force.max())]
        rows.append(Row(curve.name, cells, drawn.get(curve.column, "")))
    names = ("mean", "rms about the mean", "smallest", "largest")
    return Table("Prescribed forces, down.", "load", [Column(name, "kN") for name in names], rows)


def _point_table(result: xr.Dataset) -> Table:
    drawn = {curve.column: curve.colour for curve in point_curves(result)}
    time = result.time.values
    rows = []
    for curve in point_curves(result, range(result.sizes["point"])):
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


def of_loads(result: xr.Dataset, guideway: Guideway | None) -> list[Illustration]:
    """Illustrate the response to prescribed loads; a guideway that has no moving FRF is None."""
    return [
        _prescribed_figure(result),
        _point_deflections_figure(result),
        _loaded_spectra_figure(result),
        *frf_figures(result, guideway, _load_offsets(result)),
    ]


def _load_offsets(result: xr.Dataset) -> list[float]:
    """Distinct offsets from loads to points [m], some of them where there are many."""
    offsets = np.unique(np.round(result.point.values[:, None] - result["load"].values, 6)) + 0.0
    return sorted(
        (float(offsets[place]) for place in wording.evenly_spread(offsets.size)), key=lambda x: (abs(x), -x)
    )


def _prescribed_figure(result: xr.Dataset) -> Illustration:
    figure = blank(SIZE.single)
    (ax,) = figure.subplots(1, 1, squeeze=False)[0]
    legend_above(plots.prescribed_forces(result, ax))
    caption = "The forces on the road, as prescribed; a force that is not zero at t = 0 is switched on there."
    caption += wording.some_of(result.sizes["load"], wording.MOST_CURVES, "loads")
    return illustrated("prescribed", "Prescribed forces", caption, figure)


def _point_deflections_figure(result: xr.Dataset) -> Illustration:
    figure = blank(SIZE.single)
    (ax,) = figure.subplots(1, 1, squeeze=False)[0]
    legend_above(plots.deflections(result, ax))
    caption = (
        "Deflection of the road at points that travel with the loads, positive down. The road starts at rest: look "
        "for how far the first swing exceeds the level that follows."
    )
    caption += wording.some_of(result.sizes["point"], wording.MOST_CURVES, "points")
    return illustrated("deflections", "Deflections", caption, figure)


def _loaded_spectra_figure(result: xr.Dataset) -> Illustration:
    figure = blank(2 * SIZE.single)
    above, below = figure.subplots(2, 1)
    legend_above(plots.prescribed_force_spectra(result, above))
    legend_above(plots.deflection_spectra(result, below))
    caption = (
        "Amplitude spectral densities of forces and deflections, means removed (one-sided). Where the deflections "
        "fall faster than the forces, the road is stiff."
    )
    return illustrated("spectra", "Spectra of forces and deflections", caption, figure)

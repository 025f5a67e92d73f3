"""Figures of a result: each function draws on the Axes it is given and returns it; nothing is ever shown.

All take the result first and the Axes second, then by keyword what to draw and in which interval; `docs/plots.md`
lists them.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf.metrics.spectra import elevation_spectrum
from movingfrf.reports.axes import (
    SPECTRUM_STYLE,
    Interval,
    decimated,
    draw_classes,
    draw_densities,
    draw_fit,
    draw_histories,
    draw_levels,
    fit_height,
    note,
)
from movingfrf.reports.curves import contact_curves, distinct, dof_curve, foremost, load_curves, place_curves
from movingfrf.roughness.fitting import fit_iso
from movingfrf.roughness.spectra.iso import IsoRoad

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes


def contact_forces(
    result: xr.Dataset,
    ax: Axes,
    *,
    contacts: Sequence[int] | None = None,
    interval: Interval | None = None,
) -> Axes:
    """Draw the total contact forces [kN] over time [s], with the static level dashed.

    Parameters
    ----------
    result : xarray.Dataset
        What `simulate` returned.
    ax : matplotlib.axes.Axes
        Where to draw.
    contacts : sequence of int, optional
        Numbers of the contacts; by default all, or some of them where there are many.
    interval : tuple of float, optional
        First and last instant [s]; by default the whole record.

    Returns
    -------
    matplotlib.axes.Axes
        `ax`.
    """
    curves = contact_curves(result, contacts)
    static = result.static_load.values
    draw_histories(ax, result.time.values, result.contact_force.values, curves, 1e-3, interval, offset=static)
    draw_levels(ax, static, curves, 1e-3, "static")
    ax.set_ylabel("contact force [kN]")
    fit_height(ax)
    return ax


def contact_force_spectra(result: xr.Dataset, ax: Axes, *, contacts: Sequence[int] | None = None) -> Axes:
    """Draw amplitude spectral densities of the dynamic contact forces [N/√Hz] over frequency [Hz].

    Parameters
    ----------
    result : xarray.Dataset
        What `simulate` returned.
    ax : matplotlib.axes.Axes
        Where to draw.
    contacts : sequence of int, optional
        Numbers of the contacts; by default all, or some of them where there are many.

    Returns
    -------
    matplotlib.axes.Axes
        `ax`.
    """
    curves = contact_curves(result, contacts)
    draw_densities(ax, result, "contact_force", curves, amplitude=True)
    ax.set_ylabel("force amplitude density [N/√Hz]")
    return ax


def prescribed_forces(
    result: xr.Dataset, ax: Axes, *, loads: Sequence[int] | None = None, interval: Interval | None = None
) -> Axes:
    """Draw the prescribed forces [kN] over time [s].

    Parameters
    ----------
    result : xarray.Dataset
        What `moving_loads` returned.
    ax : matplotlib.axes.Axes
        Where to draw.
    loads : sequence of int, optional
        Numbers of the loads; by default all, or some of them where there are many.
    interval : tuple of float, optional
        First and last instant [s]; by default the whole record.

    Returns
    -------
    matplotlib.axes.Axes
        `ax`.
    """
    draw_histories(ax, result.time.values, result.force.values, load_curves(result, loads), 1e-3, interval)
    ax.set_ylabel("force [kN]")
    fit_height(ax)
    return ax


def prescribed_force_spectra(result: xr.Dataset, ax: Axes, *, loads: Sequence[int] | None = None) -> Axes:
    """Draw amplitude spectral densities of the prescribed forces [N/√Hz], means removed, over frequency [Hz].

    Parameters
    ----------
    result : xarray.Dataset
        What `moving_loads` returned.
    ax : matplotlib.axes.Axes
        Where to draw.
    loads : sequence of int, optional
        Numbers of the loads; by default all, or some of them where there are many.

    Returns
    -------
    matplotlib.axes.Axes
        `ax`.
    """
    draw_densities(ax, result, "force", load_curves(result, loads), amplitude=True)
    ax.set_ylabel("force amplitude density [N/√Hz]")
    return ax


def deflections(
    result: xr.Dataset, ax: Axes, *, places: Sequence[int] | None = None, interval: Interval | None = None
) -> Axes:
    """Draw the deflections of the guideway [mm], positive down, over time [s].

    Parameters
    ----------
    result : xarray.Dataset
        What `simulate` or `moving_loads` returned.
    ax : matplotlib.axes.Axes
        Where to draw.
    places : sequence of int, optional
        Numbers of the contacts or observation points; by default all, or some of them where there are many.
    interval : tuple of float, optional
        First and last instant [s]; by default the whole record.

    Returns
    -------
    matplotlib.axes.Axes
        `ax`. Under contacts the deflection in steady travel on the smooth road is dashed.
    """
    curves = place_curves(result, places)
    draw_histories(ax, result.time.values, result.deflection.values, curves, 1e3, interval)
    if "static_deflection" in result:
        draw_levels(ax, result.static_deflection.values, curves, 1e3, "static")
    ax.set_ylabel("deflection, down [mm]")
    fit_height(ax)
    return ax


def deflection_spectra(result: xr.Dataset, ax: Axes, *, places: Sequence[int] | None = None) -> Axes:
    """Draw amplitude spectral densities of the deflections [µm/√Hz], means removed, over frequency [Hz].

    Parameters
    ----------
    result : xarray.Dataset
        What `simulate` or `moving_loads` returned.
    ax : matplotlib.axes.Axes
        Where to draw.
    places : sequence of int, optional
        Numbers of the contacts or observation points; by default all, or some of them where there are many.

    Returns
    -------
    matplotlib.axes.Axes
        `ax`.
    """
    curves = place_curves(result, places)
    draw_densities(ax, result, "deflection", curves, amplitude=True, scale=1e6)
    ax.set_ylabel("deflection amplitude density [µm/√Hz]")
    return ax


def accelerations(result: xr.Dataset, ax: Axes, *, dof: int | str, interval: Interval | None = None) -> Axes:
    """Draw the acceleration of a degree of freedom [m/s² or rad/s²] over time [s].

    Parameters
    ----------
    result : xarray.Dataset
        What `simulate` returned.
    ax : matplotlib.axes.Axes
        Where to draw.
    dof : int or str
        Number or name of the degree of freedom.
    interval : tuple of float, optional
        First and last instant [s]; by default the whole record.

    Returns
    -------
    matplotlib.axes.Axes
        `ax`.
    """
    curve = dof_curve(result, dof)
    draw_histories(ax, result.time.values, result.acceleration.values, [curve], 1.0, interval)
    ax.set_ylabel(f"acceleration [{result.dof_unit.values[curve.column]}/s²]")
    fit_height(ax)
    return ax


def acceleration_spectrum(result: xr.Dataset, ax: Axes, *, dof: int | str) -> Axes:
    """Draw the power spectral density of an acceleration [(m/s²)²/Hz or (rad/s²)²/Hz] over frequency [Hz].

    Parameters
    ----------
    result : xarray.Dataset
        What `simulate` returned.
    ax : matplotlib.axes.Axes
        Where to draw.
    dof : int or str
        Number or name of the degree of freedom.

    Returns
    -------
    matplotlib.axes.Axes
        `ax`.
    """
    curve = dof_curve(result, dof)
    draw_densities(ax, result, "acceleration", [curve], amplitude=False)
    ax.set_ylabel(f"PSD [({result.dof_unit.values[curve.column]}/s²)²/Hz]")
    return ax


def roughness(result: xr.Dataset, ax: Axes) -> Axes:
    """Draw the elevation of the road [mm], positive up, over the distance along it [m].

    One curve per path, as its foremost contact saw it: contacts in one path roll over one and the same road.

    Parameters
    ----------
    result : xarray.Dataset
        What `simulate` returned.
    ax : matplotlib.axes.Axes
        Where to draw.

    Returns
    -------
    matplotlib.axes.Axes
        `ax`.
    """
    for curve in distinct(contact_curves(result, foremost(result)), result.roughness.values):
        start = result.attrs.get("start", 0.0) + result.position.values[curve.column]
        distance, elevation = decimated(
            start + result.attrs["speed"] * result.time.values, result.roughness.values[:, curve.column]
        )
        ax.plot(distance, 1e3 * elevation, color=curve.colour, label=f"under {curve.name}")
    ax.margins(x=0)
    ax.set_xlabel("distance along the road [m]")
    ax.set_ylabel("elevation, up [mm]")
    fit_height(ax)
    return ax


def spectrum_in_sight(result: xr.Dataset, contact: int) -> tuple[FloatArray, FloatArray]:
    """Give the part of the spectrum of the elevation under a contact that `roughness_spectrum` has room for.

    Parameters
    ----------
    result : xarray.Dataset
        What `simulate` returned.
    contact : int
        Number of the contact.

    Returns
    -------
    spatial_frequency, density : ndarray
        In cycle/m and m³; empty on a flat road, where the record is too short, or all lies below the classes.
    """
    n, density = elevation_spectrum(result, contact)
    low, high = SPECTRUM_STYLE.road_ends
    inside = (n >= low) & (n <= high) & (density > 0)
    inside &= bool((density[inside] > SPECTRUM_STYLE.road_floor).any())
    return n[inside], density[inside]


def roughness_spectrum(result: xr.Dataset, ax: Axes) -> Axes:
    """Draw the spectrum of the road's elevation [m³] over spatial frequency [cycle/m] among the ISO 8608 classes.

    Parameters
    ----------
    result : xarray.Dataset
        What `simulate` returned.
    ax : matplotlib.axes.Axes
        Where to draw.

    Returns
    -------
    matplotlib.axes.Axes
        `ax`; the class lines are the geometric centres of the classes. A fit is drawn over the frequencies that it
        was made from, unless the result says which spectrum its road was made from.
    """
    ends = np.array(SPECTRUM_STYLE.road_ends)
    highest = IsoRoad.of_class("H").density(ends)[1]
    for curve in distinct(contact_curves(result, foremost(result)), result.roughness.values):
        n, density = spectrum_in_sight(result, curve.column)
        if not n.size:
            continue
        n, density = decimated(n, density, logarithmic=True)
        ax.plot(n, density, color=curve.colour, alpha=SPECTRUM_STYLE.opacity, label=f"under {curve.name}")
        highest = max(highest, float(density.max()))
        if "spectrum" not in result.attrs:
            draw_fit(fit_iso(*elevation_spectrum(result, curve.column)), curve.colour, ax)
    ax.set(xscale="log", yscale="log", xlim=SPECTRUM_STYLE.road_ends, ylim=(SPECTRUM_STYLE.road_floor, 5 * highest))
    ax.minorticks_off()
    draw_classes(ax, ends)
    if not ax.get_legend_handles_labels()[0]:
        note(ax, "the road is next to flat, or the record too short for a spectrum")
    ax.set_xlabel("spatial frequency [cycle/m]")
    ax.set_ylabel("spectral density [m³]")
    return ax

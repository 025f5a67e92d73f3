"""Figures of a result: each function draws on the Axes it is given and returns it; nothing is ever shown.

All take the result first and the Axes second, then by keyword what to draw and in which interval; `docs/plots.md`
lists them.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import checking
from movingfrf._basics.door import given, instead_of, mistaken
from movingfrf.guideways.guideway import Guideway, require_guideway
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
from movingfrf.reports.curves import (
    Chosen,
    contact_curves,
    distinct,
    dof_curve,
    foremost,
    load_curves,
    place_curves,
)
from movingfrf.reports.frf import draw_amplitudes, moving_frfs
from movingfrf.results.labels import SCHEMAS, flaws, kind_of
from movingfrf.roughness.fitting import fit_iso
from movingfrf.roughness.spectra.iso import IsoRoad

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike


def _require(
    result: Any,
    ax: Any,
    *kinds: str,
    names: Sequence[str],
    interval: Interval | None = None,
    speed: bool = False,
) -> None:
    """Refuse a result of no such kind or without such variables, what is no Axes, an interval beyond the record."""
    with checking() as check:
        if not hasattr(ax, "get_legend_handles_labels"):
            check.refuse("ax", mistaken("axes", ax))
        kind = kind_of(result) if hasattr(result, "data_vars") else None
        if kind not in kinds:
            of = {"coupled": "of a vehicle", "loaded": "to prescribed loads", "random": "to a random road"}
            words = " or ".join(of[one] for one in kinds)
            got = f"got {given(result)}{instead_of('drawn result', result)}"
            check.refuse("result", f"must be the response {words}, {got}")
            return
        if kind == "random":
            names = [f"{name}_density" for name in names]
        lost = {dim for name in names for dim in SCHEMAS[kind][name].dims} - set(result.dims)
        for dim in sorted(lost):
            check.refuse("result", f"must keep its dimension {dim}, as `result.isel({dim}=[0])` does")
        for flaw in flaws(result, names):
            check.refuse("result", f"must have what is drawn in finite numbers, but {flaw}")
        if speed and "speed" not in result.attrs:
            check.refuse("result", "must keep its attributes, speed among them, which arithmetic with it drops")
        if "time" in lost or kind == "random":
            return
        time = result.time.values
        if time.size < 2:
            check.refuse("result", f"must have two instants at least, got {time.size}")
        elif interval is not None:
            first, last = check.pair("interval", interval, "s", signed=True)
            if first >= last:
                check.refuse("interval", f"must be a first and a later instant [s], got {interval}")
            elif last <= time[0] or first > time[-1]:
                record = f"{time[0]:.6g} s to {time[-1]:.6g} s"
                check.refuse("interval", f"must lie within the record, {record}, got {interval} s")


def contact_forces(
    result: xr.Dataset,
    ax: Axes,
    *,
    contacts: Chosen | None = None,
    interval: Interval | None = None,
) -> Axes:
    """Draw the total contact forces [kN] over time [s], with the static level dashed.

    Parameters
    ----------
    result : xarray.Dataset
        What `simulate` returned.
    ax : matplotlib.axes.Axes
        Where to draw.
    contacts : sequence of int or str, optional
        Numbers or names of the contacts, or one; by default all, or some of them where there are many.
    interval : tuple of float, optional
        First and last instant [s]; by default the whole record.

    Returns
    -------
    matplotlib.axes.Axes
        `ax`.

    Raises
    ------
    ValueError
        If the result is of another kind or lacks what is drawn, or there is no such thing to draw.
    """
    _require(result, ax, "coupled", names=("contact_force", "static_load"), interval=interval)
    curves = contact_curves(result, contacts)
    static = result.static_load.values
    draw_histories(ax, result.time.values, result.contact_force.values, curves, 1e-3, interval, offset=static)
    draw_levels(ax, static, curves, 1e-3, "static")
    ax.set_ylabel("contact force [kN]")
    fit_height(ax)
    return ax


def contact_force_spectra(result: xr.Dataset, ax: Axes, *, contacts: Chosen | None = None) -> Axes:
    """Draw amplitude spectral densities of the dynamic contact forces [N/√Hz] over frequency [Hz].

    Parameters
    ----------
    result : xarray.Dataset
        What `simulate` or `random_response` returned.
    ax : matplotlib.axes.Axes
        Where to draw.
    contacts : sequence of int or str, optional
        Numbers or names of the contacts, or one; by default all, or some of them where there are many.

    Returns
    -------
    matplotlib.axes.Axes
        `ax`.

    Raises
    ------
    ValueError
        If the result is of another kind or lacks what is drawn, or there is no such thing to draw.
    """
    _require(result, ax, "coupled", "random", names=("contact_force",))
    curves = contact_curves(result, contacts)
    draw_densities(ax, result, "contact_force", curves, amplitude=True)
    ax.set_ylabel("force amplitude density [N/√Hz]")
    return ax


def prescribed_forces(
    result: xr.Dataset, ax: Axes, *, loads: Chosen | None = None, interval: Interval | None = None
) -> Axes:
    """Draw the prescribed forces [kN] over time [s].

    Parameters
    ----------
    result : xarray.Dataset
        What `moving_loads` returned.
    ax : matplotlib.axes.Axes
        Where to draw.
    loads : sequence of int, optional
        Numbers of the loads, or one; by default all, or some of them where there are many.
    interval : tuple of float, optional
        First and last instant [s]; by default the whole record.

    Returns
    -------
    matplotlib.axes.Axes
        `ax`.

    Raises
    ------
    ValueError
        If the result is of another kind or lacks what is drawn, or there is no such thing to draw.
    """
    _require(result, ax, "loaded", names=("force",), interval=interval)
    draw_histories(ax, result.time.values, result.force.values, load_curves(result, loads), 1e-3, interval)
    ax.set_ylabel("force [kN]")
    fit_height(ax)
    return ax


def prescribed_force_spectra(result: xr.Dataset, ax: Axes, *, loads: Chosen | None = None) -> Axes:
    """Draw amplitude spectral densities of the prescribed forces [N/√Hz], means removed, over frequency [Hz].

    Parameters
    ----------
    result : xarray.Dataset
        What `moving_loads` returned.
    ax : matplotlib.axes.Axes
        Where to draw.
    loads : sequence of int, optional
        Numbers of the loads, or one; by default all, or some of them where there are many.

    Returns
    -------
    matplotlib.axes.Axes
        `ax`.

    Raises
    ------
    ValueError
        If the result is of another kind or lacks what is drawn, or there is no such thing to draw.
    """
    _require(result, ax, "loaded", names=("force",))
    draw_densities(ax, result, "force", load_curves(result, loads), amplitude=True)
    ax.set_ylabel("force amplitude density [N/√Hz]")
    return ax


def deflections(
    result: xr.Dataset, ax: Axes, *, places: Chosen | None = None, interval: Interval | None = None
) -> Axes:
    """Draw the deflections of the guideway [mm], positive down, over time [s].

    Parameters
    ----------
    result : xarray.Dataset
        What `simulate` or `moving_loads` returned.
    ax : matplotlib.axes.Axes
        Where to draw.
    places : sequence of int or str, optional
        Numbers of the contacts or observation points, names of contacts, or one; by default all, or some of them
        where there are many.
    interval : tuple of float, optional
        First and last instant [s]; by default the whole record.

    Returns
    -------
    matplotlib.axes.Axes
        `ax`. Under contacts the deflection in steady travel on the smooth road is dashed.

    Raises
    ------
    ValueError
        If the result is of another kind or lacks what is drawn, or there is no such thing to draw.
    """
    _require(result, ax, "coupled", "loaded", names=("deflection",), interval=interval)
    curves = place_curves(result, places)
    draw_histories(ax, result.time.values, result.deflection.values, curves, 1e3, interval)
    if "static_deflection" in result:
        draw_levels(ax, result.static_deflection.values, curves, 1e3, "static")
    ax.set_ylabel("deflection, down [mm]")
    fit_height(ax)
    return ax


def deflection_spectra(result: xr.Dataset, ax: Axes, *, places: Chosen | None = None) -> Axes:
    """Draw amplitude spectral densities of the deflections [µm/√Hz], means removed, over frequency [Hz].

    Parameters
    ----------
    result : xarray.Dataset
        What `simulate`, `moving_loads` or `random_response` returned.
    ax : matplotlib.axes.Axes
        Where to draw.
    places : sequence of int or str, optional
        Numbers of the contacts or observation points, names of contacts, or one; by default all, or some of them
        where there are many.

    Returns
    -------
    matplotlib.axes.Axes
        `ax`.

    Raises
    ------
    ValueError
        If the result is of another kind or lacks what is drawn, or there is no such thing to draw.
    """
    _require(result, ax, "coupled", "loaded", "random", names=("deflection",))
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

    Raises
    ------
    ValueError
        If the result is of another kind or lacks what is drawn, or there is no such thing to draw.
    """
    _require(result, ax, "coupled", names=("acceleration",), interval=interval)
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
        What `simulate` or `random_response` returned.
    ax : matplotlib.axes.Axes
        Where to draw.
    dof : int or str
        Number or name of the degree of freedom.

    Returns
    -------
    matplotlib.axes.Axes
        `ax`.

    Raises
    ------
    ValueError
        If the result is of another kind or lacks what is drawn, or there is no such thing to draw.
    """
    _require(result, ax, "coupled", "random", names=("acceleration",))
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

    Raises
    ------
    ValueError
        If the result is of another kind or lacks what is drawn, or there is no such thing to draw.
    """
    _require(result, ax, "coupled", names=("roughness",), speed=True)
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
        What `simulate` or `random_response` returned.
    ax : matplotlib.axes.Axes
        Where to draw.

    Returns
    -------
    matplotlib.axes.Axes
        `ax`; the class lines are the geometric centres of the classes. A fit is drawn over the frequencies that it
        was made from, unless the result says which spectrum its road was made from.

    Raises
    ------
    ValueError
        If the result is of another kind or lacks what is drawn, or there is no such thing to draw.
    """
    _require(result, ax, "coupled", "random", names=("roughness",), speed=True)
    ends = np.array(SPECTRUM_STYLE.road_ends)
    highest = IsoRoad.of_class("H").density(ends)[1]
    seen = result.roughness_density if kind_of(result) == "random" else result.roughness
    for curve in distinct(contact_curves(result, foremost(result)), seen.values):
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


def moving_frf(
    guideway: Guideway,
    ax: Axes,
    *,
    speeds: ArrayLike,
    ahead: ArrayLike = 0.0,
    frequency: ArrayLike | None = None,
) -> Axes:
    """Draw amplitudes of moving FRFs [µm/kN] over frequency [Hz], at several speeds or several points ahead.

    They are evaluated a millionth of the highest frequency beside the real axis, so that resonances of an undamped
    guideway are high, not infinite.

    Parameters
    ----------
    guideway : Guideway
        The road or track, as for `simulate`.
    ax : matplotlib.axes.Axes
        Where to draw.
    speeds : array_like
        Speeds [m/s], or one.
    ahead : array_like, optional
        Points, receiver minus source, ahead positive [m], or one; by default under the load itself.
    frequency : array_like, shape (frequency,), optional
        Frequencies in the moving frame [Hz], increasing; by default from 0 to where the guideway hardly answers.

    Returns
    -------
    matplotlib.axes.Axes
        `ax`, with a curve for each speed and each point; its label says which.

    Raises
    ------
    ValueError
        If it is no guideway, or a number is impossible.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> import movingfrf as mf
    >>> road = mf.track(mf.EulerBernoulliBeam(1.573e7, 711.9), mf.Spring(8.0e6, 3.0e4))
    >>> ax = moving_frf(road, Figure().subplots(), speeds=[0.0, 30.0, 60.0])
    >>> [line.get_label() for line in ax.lines]
    ['0 m/s, under the load itself', '30 m/s, under the load itself', '60 m/s, under the load itself']
    """
    require_guideway(guideway)
    with checking() as check:
        if not hasattr(ax, "get_legend_handles_labels"):
            check.refuse("ax", mistaken("axes", ax))
        speeds = np.atleast_1d(check.array("speeds", speeds, "m/s", None))
        ahead = np.atleast_1d(check.array("ahead", ahead, "m", None))
        if frequency is not None:
            frequency = check.array("frequency", frequency, "Hz", (None,))
            if frequency.size < 2 or frequency[0] < 0 or not (np.diff(frequency) > 0).all():
                check.refuse("frequency", "must be two or more increasing frequencies [Hz], none negative")
        for name, values in (("speeds", speeds), ("ahead", ahead)):
            if values.ndim > 1 or not values.size:
                check.refuse(name, f"must be one number or a list of them, got shape {values.shape}")
    frequency, curves = moving_frfs(guideway, speeds.tolist(), ahead.tolist(), frequency)
    return draw_amplitudes(frequency, curves, ax)

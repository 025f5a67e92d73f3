"""Figures of a result: each function draws on the Axes it is given and returns it; nothing is ever shown."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from movingfrf._basics.arrays import ComplexArray, FloatArray
from movingfrf._basics.welch import FEWEST_SAMPLES, FLAT, LONGEST_STRETCH, SEGMENTS, spectral_density, welch
from movingfrf._basics.wording import evenly_spread
from movingfrf.roughness.fitting import IsoFit, fit_iso
from movingfrf.roughness.spectra.iso import CLASS_CENTRES, IsoRoad

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes


# Okabe and Ito's palette, distinct under every common colour blindness; its yellow is too pale on white.
PALETTE = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
INK, GREY = "#222222", "#6b6b6b"

# Buckets that a long record is cut into: more than a screen or a sheet of paper resolves.
BUCKETS = 2000

# Orders of magnitude of a moving FRF that are drawn.
FRF_RANGE = 1e-5

# Curves that differ by less than this share of their largest value lie on top of each other; motions whose root
# mean squares differ by less than this share tell the same.
COINCIDENT, ALIKE = 1e-6, 0.1

# Letters that fit beside each other into a legend above a figure, and what a curve's sign takes of them.
LEGEND_WIDTH, LEGEND_KEY = 118, 7

# Orders of magnitude of a spectral density that are drawn, and the share of the variance its frequency axis shows.
DRAWN_RANGE, DRAWN_VARIANCE = 1e-7, 0.9999

# A frequency axis ends no earlier than this [Hz], where the record goes as far.
LEAST_END = 40.0

# Opacity of a spectrum under its fit.
PALE = 0.6

# Least height of an axis, relative to the values on it: a constant must look constant.
LEAST_HEIGHT = 0.02

Interval = tuple[float, float]


class Curve(NamedTuple):
    """One curve of a figure: a column of an array, what it is called and how it looks."""

    column: int
    name: str
    colour: str


def decimated(
    x: FloatArray, y: FloatArray, *, buckets: int = BUCKETS, logarithmic: bool = False
) -> tuple[FloatArray, FloatArray]:
    """Thin out a long series without losing an extreme.

    Parameters
    ----------
    x : ndarray, shape (sample,)
        Increasing abscissa, in any unit.
    y : ndarray, shape (sample,)
        Ordinate, in any unit.
    buckets : int
        Number of consecutive buckets; of each the smallest and the largest value stay, where they are.
    logarithmic : bool
        Whether the buckets are equally wide in log x rather than equally full.

    Returns
    -------
    x, y : ndarray
        At most 2·buckets + 2 samples of the series, its first and last among them; a series that is not
        longer than that comes back whole.

    Examples
    --------
    >>> x = np.arange(100_000.0)
    >>> y = np.sin(x)
    >>> thin_x, thin_y = decimated(x, y, buckets=50)
    >>> thin_x.size <= 102, bool(thin_y.max() == y.max())
    (True, True)
    """
    count = len(x)
    if count <= 2 * buckets + 2:
        return x, y
    if logarithmic:
        starts = np.unique(np.searchsorted(x, np.geomspace(x[0], x[-1], buckets + 1)[:-1]))
    else:
        starts = np.arange(buckets) * count // buckets
    kept = {0, count - 1}
    for first, last in zip(starts, [*starts[1:], count], strict=True):
        bucket = y[first:last]
        kept.update((int(first + bucket.argmin()), int(first + bucket.argmax())))
    places = sorted(kept)
    return x[places], y[places]


def telling(rms: FloatArray, units: Sequence[str], most: int) -> list[int]:
    """Which degrees of freedom to draw where there are more than a figure bears.

    Those that move like one before them are left out, then the liveliest: bodies come before wheels.

    Parameters
    ----------
    rms : ndarray, shape (dof,)
        Root mean square of each acceleration [m/s² or rad/s²].
    units : sequence of str
        Unit of each degree of freedom.
    most : int
        Number of degrees of freedom that a figure bears.

    Returns
    -------
    list of int
        Their numbers.

    Examples
    --------
    >>> telling(np.array([1.0, 2.0, 9.0, 1.05, 2.0, 9.1]), ["m", "rad", "m", "m", "rad", "m"], most=5)
    [0, 1, 2]
    """
    if len(rms) <= most:
        return list(range(len(rms)))
    chosen: list[int] = []
    for dof, size in enumerate(rms):
        if all(units[dof] != units[one] or abs(size - rms[one]) > ALIKE * rms[one] for one in chosen):
            chosen.append(dof)
    return sorted(sorted(chosen, key=lambda dof: rms[dof])[:most])


def distinct(curves: Sequence[Curve], values: FloatArray) -> list[Curve]:
    """Merge curves that lie on top of each other: the first one stays, and says which others it stands for.

    Parameters
    ----------
    curves : sequence of Curve
        The curves.
    values : ndarray, shape (sample, channel)
        What is drawn, in any unit.

    Returns
    -------
    list of Curve
        Curves that can be told apart.
    """
    groups: list[list[Curve]] = []
    for curve in curves:
        mine = values[:, curve.column]
        for group in groups:
            other = values[:, group[0].column]
            if np.abs(mine - other).max(initial=0.0) <= COINCIDENT * np.abs(other).max(initial=0.0):
                group.append(curve)
                break
        else:
            groups.append([curve])
    others = [f" = {len(group) - 1} others" if len(group) > 2 else f" = {group[-1].name}" for group in groups]
    return [
        group[0]._replace(name=group[0].name + (words if len(group) > 1 else ""))
        for group, words in zip(groups, others, strict=True)
    ]


def contact_curves(result: xr.Dataset, contacts: Sequence[int] | None = None) -> list[Curve]:
    """Name and colour of contacts, the same in every figure.

    Parameters
    ----------
    result : xarray.Dataset
        What `simulate` returned.
    contacts : sequence of int, optional
        Numbers of the contacts; by default all, or some of them where there are many (see `evenly_spread`).

    Returns
    -------
    list of Curve
        One per contact.
    """
    position, path = result.position.values, result.path.values
    several_paths = len(np.unique(path)) > 1
    called = result.contact_name.values.tolist() if "contact_name" in result.coords else [""] * len(path)
    names = [
        f"contact {number}"
        + (f" ({called[number]})" if called[number] else "")
        + f" at {_signed(place)} m"
        + (f", path {path[number]}" if several_paths else "")
        for number, place in enumerate(position)
    ]
    return _curves(names, contacts)


def point_curves(result: xr.Dataset, points: Sequence[int] | None = None) -> list[Curve]:
    """Name and colour of the observation points of a result of `moving_loads`.

    Parameters
    ----------
    result : xarray.Dataset
        What `moving_loads` returned.
    points : sequence of int, optional
        Numbers of the points; by default all, or some of them where there are many (see `evenly_spread`).

    Returns
    -------
    list of Curve
        One per point.
    """
    return _curves([f"point at {_signed(place)} m" for place in result.point.values], points)


def load_curves(result: xr.Dataset, loads: Sequence[int] | None = None) -> list[Curve]:
    """Name and colour of the loads of a result of `moving_loads`.

    Parameters
    ----------
    result : xarray.Dataset
        What `moving_loads` returned.
    loads : sequence of int, optional
        Numbers of the loads; by default all, or some of them where there are many (see `evenly_spread`).

    Returns
    -------
    list of Curve
        One per load.
    """
    return _curves([f"load at {_signed(place)} m" for place in result["load"].values], loads)


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
    _draw_histories(ax, result.time.values, result.contact_force.values, curves, 1e-3, interval, offset=static)
    _draw_levels(ax, static, curves, 1e-3, "static")
    ax.set_ylabel("contact force [kN]")
    _fit_height(ax)
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
    _draw_densities(ax, result, result.contact_force.values, curves, amplitude=True)
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
    _draw_histories(ax, result.time.values, result.force.values, load_curves(result, loads), 1e-3, interval)
    ax.set_ylabel("force [kN]")
    _fit_height(ax)
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
    _draw_densities(ax, result, result.force.values, load_curves(result, loads), amplitude=True)
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
    curves = _place_curves(result, places)
    _draw_histories(ax, result.time.values, result.deflection.values, curves, 1e3, interval)
    if "static_deflection" in result:
        _draw_levels(ax, result.static_deflection.values, curves, 1e3, "static")
    ax.set_ylabel("deflection, down [mm]")
    _fit_height(ax)
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
    curves = _place_curves(result, places)
    _draw_densities(ax, result, result.deflection.values, curves, amplitude=True, scale=1e6)
    ax.set_ylabel("deflection amplitude density [µm/√Hz]")
    return ax


def accelerations(result: xr.Dataset, dof: int, ax: Axes, *, interval: Interval | None = None) -> Axes:
    """Draw the acceleration of a degree of freedom [m/s² or rad/s²] over time [s].

    Parameters
    ----------
    result : xarray.Dataset
        What `simulate` returned.
    dof : int
        Number of the degree of freedom.
    ax : matplotlib.axes.Axes
        Where to draw.
    interval : tuple of float, optional
        First and last instant [s]; by default the whole record.

    Returns
    -------
    matplotlib.axes.Axes
        `ax`.
    """
    _draw_histories(ax, result.time.values, result.acceleration.values, [_dof_curve(result, dof)], 1.0, interval)
    ax.set_ylabel(f"acceleration [{result.dof_unit.values[dof]}/s²]")
    _fit_height(ax)
    return ax


def acceleration_spectrum(result: xr.Dataset, dof: int, ax: Axes) -> Axes:
    """Draw the power spectral density of an acceleration [(m/s²)²/Hz or (rad/s²)²/Hz] over frequency [Hz].

    Parameters
    ----------
    result : xarray.Dataset
        What `simulate` returned.
    dof : int
        Number of the degree of freedom.
    ax : matplotlib.axes.Axes
        Where to draw.

    Returns
    -------
    matplotlib.axes.Axes
        `ax`.
    """
    _draw_densities(ax, result, result.acceleration.values, [_dof_curve(result, dof)], amplitude=False)
    ax.set_ylabel(f"PSD [({result.dof_unit.values[dof]}/s²)²/Hz]")
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
    _fit_height(ax)
    return ax


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
    low, high = 0.01, 10.0
    ends = np.array([low, high])
    lowest, highest = IsoRoad.of_class("A").density(ends)[1], IsoRoad.of_class("H").density(ends)[1]
    for curve in distinct(contact_curves(result, foremost(result)), result.roughness.values):
        n, density = road_spectrum(result, curve.column)
        inside = (n >= low) & (n <= high) & (density > 0)
        if not inside.any():
            continue
        n, density = decimated(n[inside], density[inside], logarithmic=True)
        ax.plot(n, density, color=curve.colour, alpha=PALE, label=f"under {curve.name}")
        highest = max(highest, float(density.max()))
        if "spectrum" not in result.attrs:
            draw_fit(fit_iso(*road_spectrum(result, curve.column)), curve.colour, ax)
    ax.set(xscale="log", yscale="log", xlim=(low, high), ylim=(lowest / 30, 5 * highest))
    ax.minorticks_off()
    draw_classes(ax, ends)
    if not ax.get_legend_handles_labels()[0]:
        _note(ax, "the road is flat, or the record too short for a spectrum")
    ax.set_xlabel("spatial frequency [cycle/m]")
    ax.set_ylabel("spectral density $G_d$ [m³]")
    return ax


def foremost(result: xr.Dataset) -> list[int]:
    """Find the foremost contact in each path, of at most `MOST_CURVES` paths.

    Parameters
    ----------
    result : xarray.Dataset
        What `simulate` returned.

    Returns
    -------
    list of int
        Contacts, in the order of the paths' numbers.
    """
    position, path = result.position.values, result.path.values
    paths = np.unique(path)
    return [
        max(np.flatnonzero(path == paths[number]).tolist(), key=lambda contact: position[contact])
        for number in evenly_spread(len(paths))
    ]


def road_spectrum(result: xr.Dataset, contact: int) -> tuple[FloatArray, FloatArray]:
    """Estimate the one-sided spectrum of the elevation that a contact saw.

    Parameters
    ----------
    result : xarray.Dataset
        What `simulate` returned.
    contact : int
        Number of the contact.

    Returns
    -------
    spatial_frequency : ndarray
        Spatial frequency [cycle/m]; empty on a flat road or a record of a few samples.
    density : ndarray
        Spectral density [m³].
    """
    elevation = result.roughness.values[:, contact]
    if len(elevation) < FEWEST_SAMPLES or np.ptp(elevation) < FLAT:
        return np.empty(0), np.empty(0)
    step = result.attrs["speed"] * _time_step(result)
    segments = max(SEGMENTS, int(2 * step * len(elevation) / LONGEST_STRETCH))
    return welch(elevation, step, segments=segments)


def frf_amplitude(
    frequency: FloatArray, frf: ComplexArray, offsets: ArrayLike, ax: Axes, *, truncation: float | None = None
) -> Axes:
    """Draw amplitudes of the moving FRF [µm/kN] over frequency [Hz].

    Parameters
    ----------
    frequency : ndarray, shape (frequency,)
        Frequency in the moving frame [Hz].
    frf : ndarray, shape (frequency, offset)
        Moving FRF [m/N].
    offsets : array_like, shape (offset,)
        Receiver minus source [m], positive ahead.
    ax : matplotlib.axes.Axes
        Where to draw.
    truncation : float, optional
        Frequency to mark, beyond which the road counts as rigid [Hz].

    Returns
    -------
    matplotlib.axes.Axes
        `ax`.
    """
    amplitude = 1e9 * np.abs(frf)
    for values, style in zip(amplitude.T, _offset_styles(offsets), strict=True):
        ax.plot(frequency, values, **style)
    if amplitude.any():
        largest = float(amplitude.max())
        ax.set_yscale("log")
        ax.minorticks_off()
        ax.set_ylim(max(0.5 * float(amplitude[amplitude > 0].min()), FRF_RANGE * largest), 2 * largest)
    else:
        _fit_height(ax)
    ax.set_ylabel("amplitude [µm/kN]")
    return _finish_frf(ax, frequency, truncation)


def frf_phase(
    frequency: FloatArray, frf: ComplexArray, offsets: ArrayLike, ax: Axes, *, truncation: float | None = None
) -> Axes:
    """Draw phases of the moving FRF, unwrapped [degrees], over frequency [Hz], where the amplitude is drawn.

    Parameters
    ----------
    frequency : ndarray, shape (frequency,)
        Frequency in the moving frame [Hz], fine enough for the phase to be followed.
    frf : ndarray, shape (frequency, offset)
        Moving FRF [m/N].
    offsets : array_like, shape (offset,)
        Receiver minus source [m], positive ahead.
    ax : matplotlib.axes.Axes
        Where to draw.
    truncation : float, optional
        Frequency to mark, beyond which the road counts as rigid [Hz].

    Returns
    -------
    matplotlib.axes.Axes
        `ax`.
    """
    from matplotlib.ticker import MultipleLocator

    amplitude = np.abs(frf)
    seen = amplitude >= FRF_RANGE * amplitude.max()
    phase = np.where(seen, np.degrees(np.unwrap(np.angle(frf), axis=0)), np.nan)
    for values, style in zip(phase.T, _offset_styles(offsets), strict=True):
        ax.plot(frequency, values, **style)
    ax.set_ylabel("phase [°]")
    _fit_height(ax)
    low, high = ax.get_ylim()
    step = 45.0
    while high - low > 6 * step:
        step *= 2
    ax.yaxis.set_major_locator(MultipleLocator(step))
    return _finish_frf(ax, frequency, truncation)


def legend_above(ax: Axes) -> Axes:
    """Put the legend above the axes, where it hides no curve.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Axes with labelled curves; without any, nothing happens.

    Returns
    -------
    matplotlib.axes.Axes
        `ax`.
    """
    names = ax.get_legend_handles_labels()[1]
    if names:
        ax.legend(
            loc="lower left",
            bbox_to_anchor=(0.0, 1.0),
            ncols=max(1, min(4, LEGEND_WIDTH // (max(map(len, names)) + LEGEND_KEY))),
            columnspacing=1.5,
            frameon=False,
            borderaxespad=0.2,
        )
    return ax


def _signed(place: float) -> str:
    """Position [m] with its sign, to the centimetre."""
    return f"{place:+.2f}".replace("-", "−") if abs(place) >= 0.005 else "0"


def _curves(names: Sequence[str], chosen: Sequence[int] | None) -> list[Curve]:
    """Curves of the chosen columns; a column keeps its colour whatever else is chosen."""
    usual = evenly_spread(len(names))
    colours = {column: PALETTE[rank] for rank, column in enumerate(usual)}
    columns = usual if chosen is None else list(chosen)
    taken = {colours[column] for column in columns if column in colours}
    free = itertools.cycle([colour for colour in PALETTE if colour not in taken] or PALETTE)
    return [Curve(c, names[c], colours[c] if c in colours else next(free)) for c in columns]


def _place_curves(result: xr.Dataset, places: Sequence[int] | None) -> list[Curve]:
    return contact_curves(result, places) if "contact" in result.dims else point_curves(result, places)


def _dof_curve(result: xr.Dataset, dof: int) -> Curve:
    return Curve(dof, readable(str(result.dof.values[dof])), INK)


def readable(name: str) -> str:
    """Write a name from code as words.

    Parameters
    ----------
    name : str
        Name, words joined by underscores.

    Returns
    -------
    str
        The words.
    """
    return name.replace("_", " ")


def _time_step(result: xr.Dataset) -> float:
    time = result.time.values
    return float(time[1] - time[0])


def _draw_histories(
    ax: Axes,
    time: FloatArray,
    values: FloatArray,
    curves: Sequence[Curve],
    scale: float,
    interval: Interval | None,
    offset: FloatArray | None = None,
) -> None:
    """Draw columns of `values` (time, channel), plus a constant each, times `scale`."""
    first, last = (0, len(time)) if interval is None else np.searchsorted(time, interval).tolist()
    part = slice(first, max(last, first + 2))
    for curve in curves:
        x, y = decimated(time[part], values[part, curve.column])
        level = 0.0 if offset is None else offset[curve.column]
        ax.plot(x, scale * (y + level), color=curve.colour, label=curve.name)
    # One step past the last sample: there the record ends, on a round number as a rule.
    ax.set_xlim(float(time[part][0]), float(time[part][-1] + time[1] - time[0]))
    ax.set_xlabel("time [s]")


def _draw_levels(ax: Axes, levels: FloatArray, curves: Sequence[Curve], scale: float, name: str) -> None:
    """Dashed lines at constant levels: dark on top of a single curve, else in the colours of the curves."""
    alone = len(curves) == 1
    for curve in curves:
        ax.axhline(
            scale * levels[curve.column],
            color=INK if alone else curve.colour,
            linewidth=1.2,
            linestyle=(0, (5, 3)),
            label=name if alone else "_",
        )


def _draw_densities(
    ax: Axes,
    result: xr.Dataset,
    values: FloatArray,
    curves: Sequence[Curve],
    *,
    amplitude: bool,
    scale: float = 1.0,
) -> None:
    """Draw spectral densities of columns of `values` (time, channel), as amplitudes or as powers."""
    time_step = _time_step(result)
    truncation = float(result.attrs.get("truncation", 0.0))
    if truncation > 0.499 / time_step:  # nothing is left out, and there is nothing to mark
        truncation = 0.0
    found = [(c, *spectral_density(values[:, c.column], time_step)) for c in distinct(curves, values)]
    found = [(curve, frequency, density) for curve, frequency, density in found if frequency.size]
    ax.set_xlabel("frequency [Hz]")
    if not found:
        _note(ax, "nothing varies, or the record is too short for a spectrum")
        ax.set(xlim=(0, 0.5 / time_step), yticks=())
        return
    end = max(upper_end(frequency, density) for _, frequency, density in found)
    extremes = []
    for curve, frequency, density in found:
        drawn = (frequency <= end) & (density > 0)
        x, y = decimated(frequency[drawn], density[drawn], logarithmic=True)
        y = scale * np.sqrt(y) if amplitude else scale**2 * y
        extremes += [float(y.min()), float(y.max())]
        ax.plot(x, y, color=curve.colour, label=curve.name)
    ax.set(xscale="log", yscale="log", xlim=(float(found[0][1][0]), end))
    depth = np.sqrt(DRAWN_RANGE) if amplitude else DRAWN_RANGE
    ax.set_ylim(max(0.7 * min(extremes), depth * max(extremes)), 1.5 * max(extremes))
    _plain_frequencies(ax)
    _mark_truncation(ax, truncation)


def upper_end(frequency: FloatArray, density: FloatArray) -> float:
    """Find the upper end of a frequency axis that shows nearly all of the variance.

    Parameters
    ----------
    frequency : ndarray
        Frequency [Hz].
    density : ndarray
        Spectral density [unit²/Hz].

    Returns
    -------
    float
        The end [Hz].
    """
    share = np.cumsum(density) / density.sum()
    needed = float(frequency[np.searchsorted(share, DRAWN_VARIANCE).clip(max=len(share) - 1)])
    return min(max(1.3 * needed, LEAST_END), float(frequency[-1]))


def draw_fit(fit: IsoFit, colour: str, ax: Axes) -> None:
    """Draw a fitted line, if there is one, over the range that was fitted; curves below it should be pale."""
    if not fit.reason:
        ends = np.array(fit.band)
        ax.plot(ends, fit.density(ends), color=colour, linestyle="--", linewidth=1.8)


def draw_classes(ax: Axes, ends: FloatArray) -> None:
    """Centre lines of the ISO 8608 classes, each named at its right end."""
    for letter in CLASS_CENTRES:
        density = IsoRoad.of_class(letter).density(ends)
        ax.plot(ends, density, color="#b8b8b8", linewidth=0.8, zorder=1, label="_")
        ax.annotate(
            letter,
            (ends[1], density[1]),
            xytext=(4, 0),
            textcoords="offset points",
            va="center",
            color=GREY,
            annotation_clip=False,
        )


def _offset_styles(offsets: ArrayLike) -> list[dict[str, Any]]:
    """Colour by side (ahead or behind), dashes by distance, and a label for each offset."""
    values = np.atleast_1d(np.asarray(offsets, dtype=float)).tolist()
    distances = sorted({abs(value) for value in values if value})
    dashes = ("--", "-.", ":", (0, (7, 2)))
    styles: list[dict[str, Any]] = []
    for value in values:
        if value == 0:
            styles.append({"color": INK, "linestyle": "-", "linewidth": 1.5, "label": "under the load itself"})
            continue
        # The last colours of the palette are the least likely to stand for a contact as well.
        side, colour = ("ahead", PALETTE[3]) if value > 0 else ("behind", PALETTE[5])
        dash = dashes[distances.index(abs(value)) % len(dashes)]
        label = f"{abs(value):.2f} m {side}"
        styles.append({"color": colour, "linestyle": dash, "linewidth": 1.5, "label": label})
    return styles


def _finish_frf(ax: Axes, frequency: FloatArray, truncation: float | None) -> Axes:
    ax.set_xlim(float(frequency[0]), float(frequency[-1]))
    ax.set_xlabel("frequency [Hz]")
    if truncation:
        _mark_truncation(ax, truncation)
    return ax


def _mark_truncation(ax: Axes, truncation: float) -> None:
    """Vertical line at the truncation [Hz], where it lies inside the axis."""
    low, high = ax.get_xlim()
    if low < truncation < high:
        ax.axvline(truncation, color=GREY, linewidth=1.2, linestyle=":", label=f"truncation, {truncation:.4g} Hz")


def _plain_frequencies(ax: Axes) -> None:
    """Frequencies on a logarithmic axis as plain numbers at 1, 2 and 5, not as powers of ten."""
    from matplotlib.ticker import FuncFormatter, LogLocator

    low, high = ax.get_xlim()
    ax.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if high < 3e3 * low else (1.0,)))
    ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    ax.minorticks_off()


def _fit_height(ax: Axes) -> None:
    """Fit the height of an axis, and of those that share it, to their data, but not to rounding errors."""
    bounds = np.array([other.dataLim.intervaly for other in ax.get_shared_y_axes().get_siblings(ax)])
    bounds = bounds[np.isfinite(bounds).all(axis=1)]
    low, high = bounds[:, 0].min(), bounds[:, 1].max()
    largest = max(abs(low), abs(high))
    least = LEAST_HEIGHT * largest if largest else 2.0
    middle, height = (low + high) / 2, max(1.1 * (high - low), least)
    ax.set_ylim(middle - height / 2, middle + height / 2)
    ax.ticklabel_format(axis="y", useOffset=False)


def _note(ax: Axes, text: str) -> None:
    """Say in words why there is no curve."""
    ax.text(0.5, 0.5, text, transform=ax.transAxes, ha="center", va="center", color=GREY, wrap=True)

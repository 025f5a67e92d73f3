"""What is drawn on axes, whatever it shows: histories, levels, densities, classes, legends."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.welch import spectral_density
from movingfrf.reports.curves import GREY, INK, Curve, distinct
from movingfrf.results.labels import kind_of, resolved, time_step_of
from movingfrf.roughness.fitting import IsoFit
from movingfrf.roughness.spectra.iso import CLASS_CENTRES, IsoRoad

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes


Interval = tuple[float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class SpectrumStyle:
    """What of a spectral density is drawn, and how."""

    depth: float = 1e-7  # least over largest density that is drawn [a convention]
    variance: float = 0.9999  # share of it that the frequency axis shows [a convention, which captions state]
    least_end: float = 40.0  # end of a frequency axis at the earliest, if the record goes as far [Hz; a convention]
    opacity: float = 0.6  # of a spectrum under its fit [a convention]
    # Of a road's elevation: spatial frequencies [cycle/m; a convention], and the least density, a thirtieth of that
    # of class A at the upper end [m³; a convention].
    road_ends: tuple[float, float] = (0.01, 10.0)
    road_floor: float = 1.6e-9 / 30


SPECTRUM_STYLE = SpectrumStyle()


def decimated(
    x: FloatArray, y: FloatArray, *, buckets: int = 2000, logarithmic: bool = False
) -> tuple[FloatArray, FloatArray]:
    """Thin out a long series without losing an extreme.

    Parameters
    ----------
    x : ndarray, shape (sample,)
        Increasing abscissa, in any unit.
    y : ndarray, shape (sample,)
        Ordinate, in any unit.
    buckets : int
        Number of consecutive buckets; of each the smallest and the largest value stay, where they are. From
        about 1000 on they are more than a screen or a sheet of paper resolves [a convention].
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
            ncols=_beside(names),
            columnspacing=1.5,
            frameon=False,
            borderaxespad=0.2,
        )
    return ax


def _beside(names: Sequence[str]) -> int:
    """Count the names of a legend that fit beside each other above a figure of the page."""
    room, key = 118, 7  # letters, and what a curve's sign takes of them
    return max(1, min(4, room // (max(map(len, names)) + key)))


def legend_rows(names: Sequence[str]) -> int:
    """Count the rows of the legend that `legend_above` makes of some names."""
    return -(-len(names) // _beside(names)) if names else 0


def draw_histories(
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


def draw_levels(ax: Axes, levels: FloatArray, curves: Sequence[Curve], scale: float, name: str) -> None:
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


def draw_densities(
    ax: Axes,
    result: xr.Dataset,
    name: str,
    curves: Sequence[Curve],
    *,
    amplitude: bool,
    scale: float = 1.0,
) -> None:
    """Draw spectral densities of the columns of a variable, as it was solved, as amplitudes or as powers."""
    found, truncation, end = _densities(result, name, curves)
    ax.set_xlabel("frequency [Hz]")
    if not found:
        note(ax, "nothing varies, or the record is too short for a spectrum")
        ax.set(xlim=(0, end), yticks=())
        return
    extremes = []
    for curve, frequency, density in found:
        drawn = (frequency <= end) & (density > 0)
        x, y = decimated(frequency[drawn], density[drawn], logarithmic=True)
        y = scale * np.sqrt(y) if amplitude else scale**2 * y
        extremes += [float(y.min()), float(y.max())]
        ax.plot(x, y, color=curve.colour, label=curve.name)
    ax.set(xscale="log", yscale="log", xlim=(float(found[0][1][0]), end))
    depth = np.sqrt(SPECTRUM_STYLE.depth) if amplitude else SPECTRUM_STYLE.depth
    ax.set_ylim(max(0.7 * min(extremes), depth * max(extremes)), 1.5 * max(extremes))
    _plain_frequencies(ax)
    mark_truncation(ax, truncation)


def _densities(
    result: xr.Dataset, name: str, curves: Sequence[Curve]
) -> tuple[list[tuple[Curve, FloatArray, FloatArray]], float, float]:
    """Find spectral densities, estimated of a history or known of a random road; truncation and last frequency."""
    if kind_of(result) == "random":
        frequency, known = result.frequency.values, result[f"{name}_density"].values
        drawn = [curve for curve in distinct(curves, known) if known[1:, curve.column].any()]
        ends = [upper_end(frequency, known[:, curve.column] * result.bandwidth.values) for curve in drawn]
        found = [(curve, frequency, known[:, curve.column]) for curve in drawn]
        return found, 0.0, max(ends, default=float(frequency[-1]))
    result = resolved(result)
    time_step, values = time_step_of(result), result[name].values
    truncation, nyquist = float(result.attrs.get("truncation", 0.0)), 0.5 / time_step
    found = [(c, *spectral_density(values[:, c.column], time_step)) for c in distinct(curves, values)]
    found = [one for one in found if one[1].size]
    end = max((upper_end(frequency, density) for _, frequency, density in found), default=nyquist)
    # Beside the Nyquist frequency nothing is left out, and there is nothing to mark.
    return found, truncation if truncation < 0.998 * nyquist else 0.0, end


def upper_end(frequency: FloatArray, density: FloatArray) -> float:
    """Find the upper end of a frequency axis that shows nearly all of the variance.

    Parameters
    ----------
    frequency : ndarray
        Frequency [Hz].
    density : ndarray
        Spectral density [unit²/Hz], or variances of bands that are not equally wide.

    Returns
    -------
    float
        The end [Hz].
    """
    share = np.cumsum(density) / density.sum()
    needed = float(frequency[np.searchsorted(share, SPECTRUM_STYLE.variance).clip(max=len(share) - 1)])
    return min(max(1.3 * needed, SPECTRUM_STYLE.least_end), float(frequency[-1]))


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


def mark_truncation(ax: Axes, truncation: float) -> None:
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


def fit_height(ax: Axes) -> None:
    """Fit the height of an axis, and of those that share it, to their data, but not to rounding errors."""
    bounds = np.array([other.dataLim.intervaly for other in ax.get_shared_y_axes().get_siblings(ax)])
    bounds = bounds[np.isfinite(bounds).all(axis=1)]
    low, high = bounds[:, 0].min(), bounds[:, 1].max()
    largest = max(abs(low), abs(high))
    # A constant must look constant: at least this share of its values high.
    least = 0.02 * largest if largest else 2.0
    middle, height = (low + high) / 2, max(1.1 * (high - low), least)
    ax.set_ylim(middle - height / 2, middle + height / 2)
    ax.ticklabel_format(axis="y", useOffset=False)


def note(ax: Axes, text: str) -> None:
    """Say in words why there is no curve."""
    ax.text(0.5, 0.5, text, transform=ax.transAxes, ha="center", va="center", color=GREY, wrap=True)

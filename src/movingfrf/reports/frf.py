"""Figures of moving FRFs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from movingfrf._basics.arrays import ComplexArray, FloatArray
from movingfrf._basics.welch import spectral_density
from movingfrf._basics.wording import plain
from movingfrf.guideways.guideway import Guideway
from movingfrf.reports.axes import fit_height, legend_above, mark_truncation, upper_end
from movingfrf.reports.curves import INK, PALETTE
from movingfrf.reports.figures import SIZE, Illustration, blank, illustrated
from movingfrf.results.labels import kind_of, time_step_of

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes


@dataclass(frozen=True, slots=True, kw_only=True)
class FrfAxes:
    """What of moving FRFs is drawn."""

    points: int = 1500  # frequencies [500 to 5000: phases are followed, and the page stays small]
    beyond: float = 1.3  # end over the truncation, or over where it has become small [a convention]
    least: float = 40.0  # end of the frequency axis at the earliest [Hz; a convention]
    # Where nothing is left out: drawn until it stays below this share of its largest amplitude [a convention].
    small: float = 0.01
    # Distance of the line on which it is evaluated from the real axis, where an undamped guideway is infinite, over
    # the highest frequency [1e-9 to 1e-5: the amplitudes beside a resonance stay].
    decay: float = 1e-6
    # Without a result: drawn until it stays below this share of what it is at 0 Hz, and no farther than [Hz;
    # conventions].
    faint: float = 0.1
    farthest: float = 5000.0
    dashes: tuple[Any, ...] = ("-", "--", "-.", ":", (0, (7, 2)))
    depth: float = 1e-5  # least over largest amplitude that is drawn [a convention]


FRF_AXES = FrfAxes()


def frf_figures(result: xr.Dataset, guideway: Guideway | None, offsets: list[float]) -> list[Illustration]:
    """Illustrate moving FRFs between points some offsets [m] apart, as far as they matter to a result.

    A finite road has none: it is not the same everywhere.
    """
    if guideway is None:
        return []
    truncation = result.attrs.get("truncation", 0.0)
    frf = partial(_beside_resonances, guideway, result.attrs["speed"])
    highest = _frf_end(result, frf)
    frequency = np.linspace(0.0, highest, FRF_AXES.points)
    values = frf(frequency, offsets)
    largest = np.abs(values).max(axis=0)
    seen = np.flatnonzero(largest >= FRF_AXES.depth * largest.max())
    values, offsets = values[:, seen], [offsets[place] for place in seen]
    figure = blank(SIZE.single + SIZE.stacked + 1.2)
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(SIZE.single, SIZE.stacked + 0.5))
    mark = truncation if truncation < highest else None
    legend_above(frf_amplitude(frequency, values, offsets, above, truncation=mark))
    frf_phase(frequency, values, offsets, below, truncation=mark)
    above.set_xlabel("")
    beyond = "the road counts as rigid" if kind_of(result) == "coupled" else "the response is left out"
    return [illustrated("frf", "Moving FRFs of the road", _frf_words(values, offsets, mark, beyond), figure)]


def _beside_resonances(
    guideway: Guideway, speed: float, frequency: FloatArray, ahead: Sequence[float]
) -> ComplexArray:
    """Evaluate moving FRFs [m/N], shape (frequency, offset), where those of an undamped guideway are finite."""
    omega = 2 * np.pi * (frequency - 1j * FRF_AXES.decay * frequency[-1])
    return guideway.moving_frf(np.asarray(ahead), speed, omega)


def moving_frfs(
    guideway: Guideway, speeds: Sequence[float], ahead: Sequence[float], frequency: FloatArray | None = None
) -> tuple[FloatArray, list[tuple[FloatArray, dict[str, Any]]]]:
    """Evaluate moving FRFs at some speeds and points, each with the style of its curve.

    Parameters
    ----------
    guideway : Guideway
        The road or track.
    speeds : sequence of float
        Speeds [m/s].
    ahead : sequence of float
        Receiver minus source [m], positive ahead.
    frequency : ndarray, shape (frequency,), optional
        Frequencies [Hz]; by default up to where the guideway hardly answers.

    Returns
    -------
    frequency : ndarray
        Frequencies [Hz].
    curves : list of (ndarray, dict)
        Amplitudes [µm/kN], colours, dashes and labels: a colour for each speed, or for each point at one speed.
    """
    if frequency is None:
        wide = np.linspace(0.0, FRF_AXES.farthest, FRF_AXES.points)
        under = np.abs([_beside_resonances(guideway, speed, wide, [0.0])[:, 0] for speed in speeds])
        seen = np.flatnonzero((under >= FRF_AXES.faint * under[:, :1]).any(axis=0) & under.any())
        end = max(float(wide[seen[-1]]) if seen.size else 0.0, FRF_AXES.least)
        frequency = np.linspace(0.0, end, FRF_AXES.points)
    curves: list[tuple[FloatArray, dict[str, Any]]] = []
    for row, speed in enumerate(speeds):
        amplitudes = 1e9 * np.abs(_beside_resonances(guideway, speed, frequency, ahead))
        for column, point in enumerate(ahead):
            first, second = (row, column) if len(speeds) > 1 else (column, row)
            dash = FRF_AXES.dashes[(first // len(PALETTE) + second) % len(FRF_AXES.dashes)]
            label = f"{plain(speed)} m/s, {_offset(point)}"
            style = {"color": PALETTE[first % len(PALETTE)], "linestyle": dash, "linewidth": 1.5, "label": label}
            curves.append((amplitudes[:, column], style))
    return frequency, curves


def _frf_end(result: xr.Dataset, frf: Callable[[FloatArray, Sequence[float]], ComplexArray]) -> float:
    """Highest frequency to draw [Hz]: where deflections under contacts end, a truncation, or the FRF itself."""
    step, truncation = time_step_of(result), result.attrs.get("truncation", 0.0)
    nyquist = 0.5 / step
    kept = max(FRF_AXES.beyond * truncation, FRF_AXES.least) if 0 < truncation < nyquist else nyquist
    if kind_of(result) == "coupled":
        spectra = (spectral_density(deflection, step) for deflection in result.deflection.values.T)
        ends = [upper_end(*spectrum) for spectrum in spectra if spectrum[0].size]
        if ends:
            return min(max(ends), kept)
    if kept < nyquist:
        return kept
    frequency = np.linspace(0.0, nyquist, FRF_AXES.points)
    amplitude = np.abs(frf(frequency, [0.0])[:, 0])
    needed = (
        frequency[np.flatnonzero(amplitude >= FRF_AXES.small * amplitude.max())[-1]] if amplitude.any() else 0.0
    )
    return float(min(max(FRF_AXES.beyond * needed, FRF_AXES.least), nyquist))


def _frf_words(values: ComplexArray, offsets: list[float], truncation: float | None, beyond: str) -> str:
    if not values.any():
        return "The road is rigid: no force deflects it, and its moving FRFs are zero."
    words = (
        "Deflection per unit force between points that travel along the road together, over the frequency that "
        "they feel: how easily the road gives way, and how late. "
    )
    if any(offsets):
        words += "At speed, a point ahead of the load and one equally far behind it respond differently. "
    if truncation:
        words += f"Beyond the truncation (dotted) {beyond}. "
    return words.strip()


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
    curves = zip(1e9 * np.abs(frf.T), _offset_styles(offsets), strict=True)
    return draw_amplitudes(frequency, list(curves), ax, truncation=truncation)


def draw_amplitudes(
    frequency: FloatArray,
    curves: Sequence[tuple[FloatArray, dict[str, Any]]],
    ax: Axes,
    *,
    truncation: float | None = None,
) -> Axes:
    """Draw amplitudes [µm/kN], each with its style, over frequency [Hz]."""
    for values, style in curves:
        ax.plot(frequency, values, **style)
    amplitude = np.array([values for values, _ in curves])
    if amplitude.any():
        largest = float(amplitude.max())
        ax.set_yscale("log")
        ax.minorticks_off()
        ax.set_ylim(max(0.5 * float(amplitude[amplitude > 0].min()), FRF_AXES.depth * largest), 2 * largest)
    else:
        fit_height(ax)
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
    seen = amplitude >= FRF_AXES.depth * amplitude.max()
    phase = np.where(seen, np.degrees(np.unwrap(np.angle(frf), axis=0)), np.nan)
    for values, style in zip(phase.T, _offset_styles(offsets), strict=True):
        ax.plot(frequency, values, **style)
    ax.set_ylabel("phase [°]")
    fit_height(ax)
    low, high = ax.get_ylim()
    step = 45.0
    while high - low > 6 * step:
        step *= 2
    ax.yaxis.set_major_locator(MultipleLocator(step))
    return _finish_frf(ax, frequency, truncation)


def _offset_styles(offsets: ArrayLike) -> list[dict[str, Any]]:
    """Colour by side (ahead or behind), dashes by distance, and a label for each offset."""
    values = np.atleast_1d(np.asarray(offsets, dtype=float)).tolist()
    distances = sorted({abs(value) for value in values if value})
    styles: list[dict[str, Any]] = []
    for value in values:
        if value == 0:
            styles.append({"color": INK, "linestyle": "-", "linewidth": 1.5, "label": _offset(value)})
            continue
        # The last colours of the palette are the least likely to stand for a contact as well.
        colour = PALETTE[3] if value > 0 else PALETTE[5]
        dash = FRF_AXES.dashes[1 + distances.index(abs(value)) % (len(FRF_AXES.dashes) - 1)]
        styles.append({"color": colour, "linestyle": dash, "linewidth": 1.5, "label": _offset(value)})
    return styles


def _offset(value: float) -> str:
    """Say in words where a point is [m]."""
    return f"{abs(value):.2f} m {'ahead' if value > 0 else 'behind'}" if value else "under the load itself"


def _finish_frf(ax: Axes, frequency: FloatArray, truncation: float | None) -> Axes:
    ax.set_xlim(float(frequency[0]), float(frequency[-1]))
    ax.set_xlabel("frequency [Hz]")
    if truncation:
        mark_truncation(ax, truncation)
    return ax

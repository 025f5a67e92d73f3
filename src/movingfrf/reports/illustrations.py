"""The illustrations of a report: figures as inline SVG, each with a heading and a caption."""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from movingfrf._basics import wording
from movingfrf._basics.arrays import ComplexArray, FloatArray
from movingfrf._basics.welch import FLAT, spectral_density
from movingfrf._basics.wording import number
from movingfrf.guideways.guideway import Guideway
from movingfrf.reports import plots
from movingfrf.results.labels import duration_of, time_step_of
from movingfrf.roughness.fitting import fit_iso

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


# Width of a figure [inch], and height of its axes in the three ways they are stacked.
WIDTH, SINGLE, STACKED, PANEL = 9.6, 3.4, 1.75, 1.55

# Window around the largest dynamic force [s].
ZOOM = 1.5

# Frequencies of the moving FRFs: how many, how far beyond the truncation, and at least up to there [Hz].
FRF_POINTS, FRF_BEYOND, FRF_LEAST = 1500, 1.3, 40.0
# Where nothing is left out: the moving FRF is drawn until it stays below this share of its largest amplitude.
FRF_SMALL = 0.01
# Distance of the line on which it is evaluated from the real axis, where an undamped road is infinite.
FRF_DECAY = 1e-6

# Degrees of freedom with panels of their own, and contacts in one figure around the peak.
MOST_DOFS, MOST_NEIGHBOURS = 8, 2

# Which degrees of freedom are left out where there are many.
MOVES_ALIKE = " Left out are those with an rms within a tenth of one that is drawn, then the liveliest."

# The look of the figures, on top of matplotlib's defaults and never on top of a user's own settings.
STYLE: dict[Any, Any] = {
    "axes.edgecolor": plots.GREY,
    "axes.grid": True,
    "axes.labelcolor": plots.INK,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.titlelocation": "left",
    "axes.titlesize": 10.0,
    "font.size": 10.0,
    "grid.color": "#e3e5e7",
    "grid.linewidth": 0.7,
    "legend.fontsize": 9.5,
    "lines.linewidth": 1.0,
    "svg.fonttype": "none",
    "text.color": plots.INK,
    "xtick.color": plots.INK,
    "ytick.color": plots.INK,
}


class Illustration(NamedTuple):
    """A figure of the page: heading, inline SVG (markup) and caption."""

    heading: str
    svg: str
    caption: str


@contextmanager
def drawing() -> Iterator[None]:
    """Draw in the report's own style, whatever matplotlib was set to, and leave those settings as they were."""
    import matplotlib

    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(STYLE)
        yield


def blank(height: float) -> Figure:
    """Make an empty figure of the page's width and some height [inch]."""
    from matplotlib.figure import Figure

    return Figure(figsize=(WIDTH, height), layout="constrained")


def drawn_svg(figure: Figure, key: str) -> str:
    """Draw a figure as SVG, a file of its own; equal figures and keys give equal text.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        The figure.
    key : str
        Makes its ids.

    Returns
    -------
    str
        The file.
    """
    import matplotlib
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    matplotlib.rcParams["svg.hashsalt"] = f"movingfrf {key}"
    written = io.StringIO()
    nothing = dict.fromkeys(("Creator", "Date", "Format", "Type"))
    FigureCanvasSVG(figure).print_svg(written, metadata=nothing)  # type: ignore[no-untyped-call]
    return written.getvalue()


def inlined(svg: str, key: str, label: str) -> str:
    """Turn an SVG file into markup for a page that holds several.

    Parameters
    ----------
    svg : str
        What `drawn_svg` returned.
    key : str
        Makes its ids unique on the page.
    label : str
        What it shows, for those who do not see it.

    Returns
    -------
    str
        Markup.
    """
    from markupsafe import Markup, escape

    svg = svg[svg.index("<svg") :]
    # Only inside tags: text between them may say whatever it likes.
    svg = re.sub(r"<[^>]+>", lambda tag: re.sub(r'(\bid="|href="#|url\(#)', rf"\1{key}-", tag.group()), svg)
    return Markup(svg.replace("<svg", f'<svg role="img" aria-label="{escape(label)}"', 1))


def illustrated(key: str, heading: str, caption: str, figure: Figure) -> Illustration:
    """Turn a figure into an illustration; `key` makes its ids unique on the page."""
    return Illustration(heading, inlined(drawn_svg(figure, key), key, heading), caption)


def of_coupled(result: xr.Dataset, guideway: Guideway) -> list[Illustration]:
    """Illustrate the response of a vehicle and a guideway."""
    return [
        _road_figure(result),
        *_frf_figures(result, guideway, _contact_offsets(result)),
        _forces_figure(result),
        *_zoom_figures(result),
        _force_spectra_figure(result),
        _deflections_figure(result),
        _accelerations_figure(result),
    ]


def of_loads(result: xr.Dataset, guideway: Guideway) -> list[Illustration]:
    """Illustrate the response to prescribed loads."""
    return [
        _prescribed_figure(result),
        _point_deflections_figure(result),
        _loaded_spectra_figure(result),
        *_frf_figures(result, guideway, _load_offsets(result)),
    ]


def is_rough(result: xr.Dataset) -> bool:
    """Tell whether the road has any roughness to draw."""
    return bool(np.ptp(result.roughness.values, axis=0).max() >= FLAT)


def _road_figure(result: xr.Dataset) -> Illustration:
    figure = blank(STACKED + SINGLE + 0.9)
    above, below = figure.subplots(2, 1, height_ratios=(STACKED, SINGLE))
    plots.legend_above(plots.roughness(result, above))
    plots.legend_above(plots.roughness_spectrum(result, below))
    caption = (
        "What the foremost contact of each path rolls over: elevation over distance, and its spectrum among the "
        "centre lines of the ISO 8608 classes A (smooth) to H (rough). " + _class_words(result)
    )
    return illustrated("road", "Roughness", caption, figure)


def _class_words(result: xr.Dataset) -> str:
    """Say which spectrum the road was made from, or what the fit found, path by path."""
    if "spectrum" in result.attrs:
        return f"It was made from a spectrum, so none is fitted: {result.attrs['spectrum']}."
    said = []
    for contact in plots.foremost(result):
        fit = fit_iso(*plots.road_spectrum(result, contact))
        if fit.reason:
            said.append(f"Under contact {contact} no class is fitted: {fit.reason}.")
            continue
        said.append(
            f"The fit under contact {contact} (dashed, over {fit.covered}) gives "
            f"{number(fit.roughness, 3)} m³ at 0.1 cycle/m with waviness "
            f"{number(fit.waviness, 3)}; with the waviness 2 of the standard "
            f"{number(fit.roughness_at_two, 3)} m³, class {fit.road_class}"
            + (f" ({fit.doubt})." if fit.doubt else ".")
        )
    return f"{' '.join(said)} A class describes random roughness; a single bump or joint has none."


def _contact_offsets(result: xr.Dataset) -> list[float]:
    """Zero, and two distances between contacts, ahead and behind [m]: the least, and the next twice as long."""
    positions = result.position.values
    distances = np.unique(np.round(np.abs(positions[:, None] - positions), 6))
    distances = distances[distances > 0]
    chosen = [*distances[:1].tolist(), *distances[distances >= 2 * distances.min(initial=np.inf)][:1].tolist()]
    return [0.0, *(offset for distance in chosen for offset in (distance, -distance))]


def _load_offsets(result: xr.Dataset) -> list[float]:
    """Distinct offsets from loads to points [m], some of them where there are many."""
    offsets = np.unique(np.round(result.point.values[:, None] - result["load"].values, 6)) + 0.0
    return sorted(
        (float(offsets[place]) for place in wording.evenly_spread(offsets.size)), key=lambda x: (abs(x), -x)
    )


def _frf_figures(result: xr.Dataset, guideway: Guideway, offsets: list[float]) -> list[Illustration]:
    speed, truncation = result.attrs["speed"], result.attrs.get("truncation", 0.0)

    def frf(frequency: FloatArray, ahead: Sequence[float]) -> ComplexArray:
        omega = 2 * np.pi * (frequency - 1j * FRF_DECAY * frequency[-1])
        return guideway.moving_frf(np.asarray(ahead), speed, omega)

    highest = _frf_end(result, frf)
    frequency = np.linspace(0.0, highest, FRF_POINTS)
    values = frf(frequency, offsets)
    largest = np.abs(values).max(axis=0)
    seen = np.flatnonzero(largest >= plots.FRF_RANGE * largest.max())
    values, offsets = values[:, seen], [offsets[place] for place in seen]
    figure = blank(SINGLE + STACKED + 1.2)
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(SINGLE, STACKED + 0.5))
    mark = truncation if truncation < highest else None
    plots.legend_above(plots.frf_amplitude(frequency, values, offsets, above, truncation=mark))
    plots.frf_phase(frequency, values, offsets, below, truncation=mark)
    above.set_xlabel("")
    beyond = "the road counts as rigid" if "contact_force" in result else "the response is left out"
    return [illustrated("frf", "Moving FRFs of the road", _frf_words(values, offsets, mark, beyond), figure)]


def _frf_end(result: xr.Dataset, frf: Callable[[FloatArray, Sequence[float]], ComplexArray]) -> float:
    """Highest frequency to draw [Hz]: where deflections under contacts end, a truncation, or the FRF itself."""
    step, truncation = time_step_of(result), result.attrs.get("truncation", 0.0)
    nyquist = 0.5 / step
    kept = max(FRF_BEYOND * truncation, FRF_LEAST) if 0 < truncation < nyquist else nyquist
    if "contact_force" in result:
        spectra = (spectral_density(deflection, step) for deflection in result.deflection.values.T)
        ends = [plots.upper_end(*spectrum) for spectrum in spectra if spectrum[0].size]
        if ends:
            return min(max(ends), kept)
    if kept < nyquist:
        return kept
    frequency = np.linspace(0.0, nyquist, FRF_POINTS)
    amplitude = np.abs(frf(frequency, [0.0])[:, 0])
    needed = frequency[np.flatnonzero(amplitude >= FRF_SMALL * amplitude.max())[-1]] if amplitude.any() else 0.0
    return float(min(max(FRF_BEYOND * needed, FRF_LEAST), nyquist))


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


def _panels(
    count: int, draw: Callable[[int, Axes], object], colours: Sequence[str], names: Sequence[str]
) -> Figure:
    """Panels of equal height below each other, on common axes."""
    figure = blank(max(PANEL * count, SINGLE - 0.4) + 0.5)
    axes = figure.subplots(count, 1, sharex=True, sharey=True, squeeze=False)[:, 0]
    for panel, ax in enumerate(axes):
        draw(panel, ax)
        ax.set_title(names[panel], color=colours[panel], fontweight="bold")
        if panel < count - 1:
            ax.set_xlabel("")
    return figure


def _forces_figure(result: xr.Dataset) -> Illustration:
    curves = plots.distinct(plots.contact_curves(result), result.contact_force.values)
    figure = _panels(
        len(curves),
        lambda n, ax: plots.contact_forces(result, ax, contacts=[curves[n].column]).set_ylabel("force [kN]"),
        [curve.colour for curve in curves],
        [curve.name for curve in curves],
    )
    peak, instant, contact = _peak_force(result)
    words = "Total contact forces; dashed, the static level about which they vary. "
    words += (
        f"The largest dynamic force, {number(1e-3 * peak)} kN, acts under contact {contact} at {instant:.6g} s. "
        "Contact is lost where a force falls below zero."
        if peak
        else "The road is smooth, so the forces stay at their static level."
    )
    words += wording.some_of(result.sizes["contact"], wording.MOST_CURVES, "contacts")
    return illustrated("forces", "Contact forces", words, figure)


def _peak_force(result: xr.Dataset) -> tuple[float, float, int]:
    """Largest magnitude of the dynamic force [N], its time [s] and contact."""
    places = [np.abs(column).argmax() for column in result.contact_force.values.T]
    peaks = [abs(column[p]) for column, p in zip(result.contact_force.values.T, places, strict=True)]
    contact = int(np.argmax(peaks))
    return float(peaks[contact]), float(result.time.values[places[contact]]), contact


def _zoom_figures(result: xr.Dataset) -> list[Illustration]:
    """Draw the forces around the largest one, where the record is long enough for that to add anything."""
    duration = duration_of(result)
    peak, instant, contact = _peak_force(result)
    if duration <= 2 * ZOOM or not peak:
        return []
    first = min(max(instant - ZOOM / 2, 0.0), duration - ZOOM)
    chosen = _neighbours(result, contact)
    figure = blank(SINGLE)
    (ax,) = figure.subplots(1, 1, squeeze=False)[0]
    plots.contact_forces(result, ax, contacts=chosen, interval=(first, first + ZOOM))
    for line in ax.lines:
        line.set_linewidth(1.5)
    plots.legend_above(ax)
    caption = (
        f"The {ZOOM:g} s around the largest dynamic force ({number(1e-3 * peak)} kN under contact {contact}), "
        "there and under the nearest contact of the same path. They meet the same spot one after the other: look "
        "for the same event with its delay. "
        "Dashed: the static levels."
    )
    return [illustrated("zoom", "Contact forces around the peak", caption, figure)]


def _neighbours(result: xr.Dataset, contact: int) -> list[int]:
    """Name a contact and the one nearest to it in its path."""
    position, path = result.position.values, result.path.values
    same = np.flatnonzero(path == path[contact])
    nearest = same[np.argsort(np.abs(position[same] - position[contact]), kind="stable")]
    return sorted(nearest[:MOST_NEIGHBOURS].tolist())


def _force_spectra_figure(result: xr.Dataset) -> Illustration:
    figure = blank(SINGLE + 0.3)
    (ax,) = figure.subplots(1, 1, squeeze=False)[0]
    plots.legend_above(plots.contact_force_spectra(result, ax))
    caption = (
        "Amplitude spectral densities of the dynamic contact forces (one-sided; their squares integrate to the "
        "variance). The lowest humps are, as a rule, the body on its suspension, higher ones the wheels on their "
        "tyres. The frequency axis covers 99.99 % of the variance."
    )
    caption += wording.some_of(result.sizes["contact"], wording.MOST_CURVES, "contacts")
    return illustrated("force-spectra", "Contact-force spectra", caption, figure)


def _deflections_figure(result: xr.Dataset) -> Illustration:
    curves = plots.distinct(plots.contact_curves(result), result.deflection.values)
    figure = _panels(
        len(curves),
        lambda n, ax: plots.deflections(result, ax, places=[curves[n].column]).set_ylabel("deflection [mm]"),
        [curve.colour for curve in curves],
        [curve.name for curve in curves],
    )
    deflection = result.deflection.values
    contact = int(np.argmax([column.max() for column in deflection.T]))
    place = int(deflection[:, contact].argmax())
    caption = (
        "Deflection of the road under each contact, positive down; dashed, the sag in steady travel on the smooth "
        f"road. The largest, {number(1e3 * float(deflection[place, contact]))} mm, occurs under contact {contact} "
        f"at {result.time.values[place]:.6g} s."
    )
    caption += wording.some_of(result.sizes["contact"], wording.MOST_CURVES, "contacts")
    return illustrated("deflections", "Deflections under the contacts", caption, figure)


def _accelerations_figure(result: xr.Dataset) -> Illustration:
    total = result.sizes["dof"]
    rms = np.sqrt(np.mean(result.acceleration.values**2, axis=0))
    dofs = plots.telling(rms, result.dof_unit.values.tolist(), MOST_DOFS)
    figure = blank((PANEL + 0.15) * max(len(dofs), 2) + 0.4)
    axes = figure.subplots(len(dofs), 2, sharex="col", squeeze=False, width_ratios=(3, 2))
    for row, dof in zip(axes, dofs, strict=True):
        plots.accelerations(result, dof, row[0])
        plots.acceleration_spectrum(result, dof, row[1])
        row[0].set_title(plots.readable(str(result.dof.values[dof])), fontweight="bold")
        row[1].set_title("power spectral density")
        unit = result.dof_unit.values[dof]
        row[0].set_ylabel(f"[{unit}/s²]")
        row[1].set_ylabel(f"[({unit}/s²)²/Hz]")
    for ax in axes[:-1].flat:
        ax.set_xlabel("")
    caption = (
        "Acceleration of each degree of freedom over time, and its one-sided power spectral density. Each panel "
        "has its own scale: compare numbers, not heights. Look for the frequencies at which a degree "
        "of freedom moves most."
    )
    caption += wording.some_of(total, len(dofs), "degrees of freedom") + (MOVES_ALIKE if len(dofs) < total else "")
    return illustrated("accelerations", "Accelerations of the vehicle", caption, figure)


def _prescribed_figure(result: xr.Dataset) -> Illustration:
    figure = blank(SINGLE)
    (ax,) = figure.subplots(1, 1, squeeze=False)[0]
    plots.legend_above(plots.prescribed_forces(result, ax))
    caption = "The forces on the road, as prescribed; a force that is not zero at t = 0 is switched on there."
    caption += wording.some_of(result.sizes["load"], wording.MOST_CURVES, "loads")
    return illustrated("prescribed", "Prescribed forces", caption, figure)


def _point_deflections_figure(result: xr.Dataset) -> Illustration:
    figure = blank(SINGLE)
    (ax,) = figure.subplots(1, 1, squeeze=False)[0]
    plots.legend_above(plots.deflections(result, ax))
    caption = (
        "Deflection of the road at points that travel with the loads, positive down. The road starts at rest: look "
        "for how far the first swing exceeds the level that follows."
    )
    caption += wording.some_of(result.sizes["point"], wording.MOST_CURVES, "points")
    return illustrated("deflections", "Deflections", caption, figure)


def _loaded_spectra_figure(result: xr.Dataset) -> Illustration:
    figure = blank(2 * SINGLE)
    above, below = figure.subplots(2, 1)
    plots.legend_above(plots.prescribed_force_spectra(result, above))
    plots.legend_above(plots.deflection_spectra(result, below))
    caption = (
        "Amplitude spectral densities of forces and deflections, means removed (one-sided). Where the deflections "
        "fall faster than the forces, the road is stiff."
    )
    return illustrated("spectra", "Spectra of forces and deflections", caption, figure)

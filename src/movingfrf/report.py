"""One HTML page about a result: settings, findings, measures and figures, with nothing outside the page."""

from __future__ import annotations

import io
import json
import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from importlib.resources import files
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from movingfrf import plots
from movingfrf._checks import ComplexArray, FloatArray
from movingfrf.guideways.base import Guideway
from movingfrf.metrics.basic import Measure, measures
from movingfrf.roughness.spectra import fit_iso, iso_class

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

MOST_DOFS = 8

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

SCALES = {"N": ("kN", 1e-3), "m": ("mm", 1e3), "1": ("", 1.0)}

SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


class Setting(NamedTuple):
    """One line of the head: what was set, to which value, and what to know about it."""

    name: str
    value: str
    note: str = ""
    wide: bool = False


class Column(NamedTuple):
    """Head of a column."""

    name: str
    units: str


class Row(NamedTuple):
    """One row of a table, with the colour of its curves."""

    name: str
    cells: list[str]
    colour: str = ""


class Table(NamedTuple):
    """A table for reading."""

    caption: str
    corner: str
    columns: list[Column]
    rows: list[Row]


class Illustration(NamedTuple):
    """A figure of the page: heading, inline SVG (markup) and caption."""

    heading: str
    svg: str
    caption: str


def render(result: xr.Dataset, *, guideway: Guideway, scenario_text: str = "", title: str = "") -> str:
    """Write the report of a result.

    Parameters
    ----------
    result : xarray.Dataset
        What `simulate` or `moving_loads` returned.
    guideway : Guideway
        The guideway that it was computed for; its moving FRFs are drawn.
    scenario_text : str
        Text of the scenario file, shown as it is; by default what the result carries, if anything.
    title : str
        Title of the page; by default what the result calls itself.

    Returns
    -------
    str
        One HTML page without references to anything outside it. Equal input gives equal text.
    """
    from jinja2 import Environment, StrictUndefined

    coupled = "contact_force" in result
    with _drawing():
        figures = _coupled_figures(result, guideway) if coupled else _loaded_figures(result, guideway)
    template = files("movingfrf").joinpath("templates", "report.html.j2").read_text(encoding="utf-8")
    environment = Environment(autoescape=True, undefined=StrictUndefined, keep_trailing_newline=True)
    return environment.from_string(template).render(
        title=title or result.attrs.get("title", "Response of a guideway"),
        version=result.attrs.get("movingfrf", "of unknown version"),
        summary=_coupled_summary(result) if coupled else _loaded_summary(result),
        settings=_settings(result),
        findings=_findings(result),
        no_findings=_no_findings(coupled),
        tables=_measure_tables(result) if coupled else _loaded_tables(result),
        figures=figures,
        method=_coupled_method() if coupled else _loaded_method(),
        scenario=scenario_text or result.attrs.get("scenario", ""),
    )


# Words and numbers


def number(value: float, digits: int = 4) -> str:
    """Write a number for reading: significant digits, powers of ten only where they are shorter.

    Parameters
    ----------
    value : float
        The number.
    digits : int
        Significant digits.

    Returns
    -------
    str
        The number, with a true minus sign.

    Examples
    --------
    >>> number(98399.5), number(-0.0810412), number(1.2e-7, 2), number(0.0), number(float("inf"))
    ('98400', '−0.08104', '1.2 × 10⁻⁷', '0', '∞')
    """
    if value == 0:
        return "0"
    if not np.isfinite(value):
        return str(value).replace("inf", "∞").replace("-", "−")
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    power = int(exponent)
    if -4 < power < 6:
        rounded = float(f"{mantissa}e{power}")
        return f"{rounded:.{max(digits - 1 - power, 0)}f}".replace("-", "−")
    return f"{mantissa} × 10{str(power).translate(SUPERSCRIPTS)}".replace("-", "−")


def _plain(value: float) -> str:
    """Write a setting as it was typed: without trailing zeros."""
    return f"{value:.10g}".replace("-", "−")


def _count(count: int, singular: str, plural: str = "") -> str:
    return f"{count} {singular if count == 1 else plural or singular + 's'}"


def _some_of(total: int, most: int, what: str) -> str:
    """Say in a caption that not everything is drawn."""
    return f" {most} of {total} {what} are drawn; the tables list all." if total > most else ""


def _speed(result: xr.Dataset) -> str:
    speed = result.attrs["speed"]
    # Unbreakable spaces: a number stays with its unit.
    return f"{_plain(speed)}\u00a0m/s ({_plain(round(3.6 * speed, 6))}\u00a0km/h)"


def _duration(result: xr.Dataset) -> float:
    """Duration of the record [s], free of the rounding of its last time."""
    return float(f"{result.sizes['time'] * _time_step(result):.12g}")


def _time_step(result: xr.Dataset) -> float:
    time = result.time.values
    return float(f"{time[1] - time[0]:.12g}")


def _coupled_summary(result: xr.Dataset) -> str:
    contacts, dofs = result.sizes["contact"], result.sizes["dof"]
    road = "rough road" if _is_rough(result) else "smooth road"
    weight = number(1e-3 * float(result.static_load.values.sum()))
    return (
        f"A vehicle of {weight} kN with {_count(contacts, 'contact')} and "
        f"{_count(dofs, 'degree of freedom', 'degrees of freedom')} travels at {_speed(result)} for "
        f"{_plain(_duration(result))} s over a {road}; contact forces, deflections of "
        "the road and motions of the vehicle were computed together, in the frequency domain, with moving "
        "frequency response functions (moving FRFs)."
    )


def _loaded_summary(result: xr.Dataset) -> str:
    return (
        f"{_count(result.sizes['load'], 'prescribed force')} on a road, travelling at {_speed(result)} for "
        f"{_plain(_duration(result))} s from rest at t = 0; the deflection at "
        f"{_count(result.sizes['point'], 'point')} travelling along was computed in the frequency domain with "
        "moving frequency response functions (moving FRFs)."
    )


def _settings(result: xr.Dataset) -> list[Setting]:
    attrs, duration, step = result.attrs, _duration(result), _time_step(result)
    critical = attrs.get("critical_speed", float("inf"))
    speed = attrs["speed"]
    found = [
        Setting("Speed", f"{_plain(speed)} m/s", f"{_plain(round(3.6 * speed, 6))} km/h"),
        Setting("Duration", f"{_plain(duration)} s"),
        Setting("Distance", f"{_plain(float(f'{duration * abs(speed):.12g}'))} m"),
        Setting("Time step", f"{_plain(1e3 * step)} ms", f"{result.sizes['time']} samples"),
        *_truncation_settings(result),
        Setting(
            "Critical speed of the road",
            f"{number(critical)} m/s" if np.isfinite(critical) else "none",
            f"{number(3.6 * critical)} km/h; this speed is {number(100 * abs(speed) / critical, 3)} % of it"
            if np.isfinite(critical)
            else "",
        ),
    ]
    if "start" in attrs:
        found.append(Setting("Start", f"{_plain(attrs['start'])} m", "of the vehicle's reference point, at t = 0"))
    if "blend" in attrs:
        found.append(Setting("Blend", f"{_plain(attrs['blend'])} m", "over which the profile sets in"))
    if "datum" in attrs:
        found.append(Setting("Datum", f"{number(attrs['datum'])} m", "subtracted from the profile's elevations"))
    if "guideway" in attrs:
        found.append(Setting("Road (SI units)", attrs["guideway"], wide=True))
    return found


def _truncation_settings(result: xr.Dataset) -> list[Setting]:
    if "truncation" not in result.attrs:
        return []
    truncation, coupled = result.attrs["truncation"], "contact_force" in result
    if not coupled:
        if truncation >= 0.5 / _time_step(result):
            return [Setting("Truncation", "none", "every frequency of the record is kept")]
        return [Setting("Truncation", f"{_plain(truncation)} Hz", "the response beyond it is left out")]
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


def _no_findings(coupled: bool) -> str:
    if coupled:
        return (
            "No findings: contact is kept throughout, the speed is well below critical, the response dies away "
            "within the padded record, and truncation and time step leave nothing of weight out."
        )
    return "No findings: the speed is well below critical and the response dies away within the padded record."


def _coupled_method() -> list[str]:
    return [
        "Vehicle and road are linear, and the speed is constant.",
        "The road is infinitely long and the same everywhere along its length; only its surface is rough.",
        "Contact is kept at all times: where a total contact force would turn negative the model pulls, and the "
        "findings say so.",
        "Before the record the vehicle has travelled on the smooth road for ever: static loads and steady sag are "
        "there from the start, and the roughness sets in from the foremost contact on.",
        "At every frequency the contact forces F solve (I + D G) F = D R, with G the moving FRFs between the "
        "contacts, D the dynamic stiffness of the vehicle at its contacts and R the elevation under them. Beyond "
        "the truncation G = 0: the road is rigid there, the vehicle is not.",
        "Forces, deflections and motions are positive downward (pitch: nose down), elevations upward; positions "
        "are positive ahead. Spectra are one-sided, estimated by Welch's method (Hann window, half overlap).",
    ]


def _loaded_method() -> list[str]:
    return [
        "The road is linear, infinitely long and the same everywhere along its length; the speed is constant.",
        "The forces are given and do not depend on what the road does. Before t = 0 the road is at rest; a force "
        "that is not zero at t = 0 is switched on at that instant.",
        "At every frequency the deflections are W = G F, with G the moving FRFs between loads and points.",
        "Forces and deflections are positive downward; positions are positive ahead. Spectra are one-sided, "
        "estimated by Welch's method (Hann window, half overlap).",
    ]


# Tables


def _measure_tables(result: xr.Dataset) -> list[Table]:
    """Contacts in one table, degrees of freedom in another, and so on for whatever has the same measures."""
    rows: dict[str, list[tuple[str, Measure]]] = {}
    for measure in measures(result):
        place, _, kind = measure.quantity.rpartition(" ")
        rows.setdefault(place, []).append((kind, measure))
    groups: dict[tuple[tuple[str, str], ...], list[str]] = {}
    for place, found in rows.items():
        groups.setdefault(tuple((kind, measure.name) for kind, measure in found), []).append(place)
    contacts = {f"contact {c.column}": c for c in plots.contact_curves(result, range(result.sizes["contact"]))}
    drawn = set(plots.shown(len(contacts)))
    return [
        _measure_table(kinds, [(place, rows[place]) for place in places], contacts, drawn)
        for kinds, places in groups.items()
    ]


def _measure_table(
    kinds: Sequence[tuple[str, str]],
    rows: Sequence[tuple[str, list[tuple[str, Measure]]]],
    contacts: dict[str, plots.Curve],
    drawn: set[int],
) -> Table:
    units = [{found[n][1].units for _, found in rows} for n in range(len(kinds))]
    columns = []
    for (kind, name), used in zip(kinds, units, strict=True):
        in_head = SCALES.get(next(iter(used)), (next(iter(used)), 1.0))[0] if len(used) == 1 else ""
        columns.append(Column(_column_name(kind, name), in_head))
    made = []
    for place, found in rows:
        curve = contacts.get(place)
        cells = []
        for (_, measure), used in zip(found, units, strict=True):
            unit, scale = SCALES.get(measure.units, (measure.units, 1.0))
            # A unit stands in the head of its column, unless the column mixes units.
            cells.append(number(scale * measure.value) + (f" {unit}" if len(used) > 1 else ""))
        colour = curve.colour if curve and curve.column in drawn else ""
        made.append(Row(curve.name if curve else plots.readable(place), cells, colour))
    if rows[0][0] in contacts:
        return Table(
            "Contact forces and deflections of the road. The dynamic part is what the roughness adds to the static "
            "level; the dynamic load coefficient is its rms over the static force.",
            "contact",
            columns,
            made,
        )
    return Table("Accelerations about the steady state.", "degree of freedom", columns, made)


def _column_name(kind: str, name: str) -> str:
    if name == "dynamic load coefficient":
        return "dynamic load coefficient"
    return f"{kind}, {name}"


def _loaded_tables(result: xr.Dataset) -> list[Table]:
    return [_load_table(result), _point_table(result)]


def _load_table(result: xr.Dataset) -> Table:
    drawn = {curve.column: curve.colour for curve in plots.load_curves(result)}
    rows = []
    for curve in plots.load_curves(result, range(result.sizes["load"])):
        force = 1e-3 * result.force.values[:, curve.column]
        cells = [number(float(value)) for value in (force.mean(), force.std(), force.min(), force.max())]
        rows.append(Row(curve.name, cells, drawn.get(curve.column, "")))
    names = ("mean", "rms about the mean", "smallest", "largest")
    return Table("Prescribed forces, down.", "load", [Column(name, "kN") for name in names], rows)


def _point_table(result: xr.Dataset) -> Table:
    drawn = {curve.column: curve.colour for curve in plots.point_curves(result)}
    time = result.time.values
    rows = []
    for curve in plots.point_curves(result, range(result.sizes["point"])):
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


# Figures


@contextmanager
def _drawing() -> Iterator[None]:
    """Draw in the report's own style, whatever matplotlib was set to, and leave those settings as they were."""
    import matplotlib

    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(STYLE)
        yield


def _figure(height: float) -> Figure:
    from matplotlib.figure import Figure

    return Figure(figsize=(WIDTH, height), layout="constrained")


def _svg(figure: Figure, key: str, label: str) -> str:
    """Inline SVG of a figure, its ids made unique on the page by `key`."""
    import matplotlib
    from markupsafe import Markup, escape
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    matplotlib.rcParams["svg.hashsalt"] = f"movingfrf {key}"
    written = io.StringIO()
    nothing = dict.fromkeys(("Creator", "Date", "Format", "Type"))
    FigureCanvasSVG(figure).print_svg(written, metadata=nothing)  # type: ignore[no-untyped-call]
    svg = written.getvalue()
    svg = svg[svg.index("<svg") :]
    # Only inside tags: text between them may say whatever it likes.
    svg = re.sub(r"<[^>]+>", lambda tag: re.sub(r'(\bid="|href="#|url\(#)', rf"\1{key}-", tag.group()), svg)
    return Markup(svg.replace("<svg", f'<svg role="img" aria-label="{escape(label)}"', 1))


def _illustration(key: str, heading: str, caption: str, figure: Figure) -> Illustration:
    return Illustration(heading, _svg(figure, key, heading), caption)


def _coupled_figures(result: xr.Dataset, guideway: Guideway) -> list[Illustration]:
    return [
        _road_figure(result),
        *_frf_figures(result, guideway, _contact_offsets(result)),
        _forces_figure(result),
        *_zoom_figures(result),
        _force_spectra_figure(result),
        _deflections_figure(result),
        _accelerations_figure(result),
    ]


def _loaded_figures(result: xr.Dataset, guideway: Guideway) -> list[Illustration]:
    return [
        _prescribed_figure(result),
        _point_deflections_figure(result),
        _loaded_spectra_figure(result),
        *_frf_figures(result, guideway, _load_offsets(result)),
    ]


def _is_rough(result: xr.Dataset) -> bool:
    return bool(np.ptp(result.roughness.values, axis=0).max() >= plots.FLAT)


def _road_figure(result: xr.Dataset) -> Illustration:
    figure = _figure(STACKED + SINGLE + 0.9)
    above, below = figure.subplots(2, 1, height_ratios=(STACKED, SINGLE))
    plots.legend_above(plots.roughness(result, above))
    plots.legend_above(plots.roughness_spectrum(result, below))
    caption = (
        "The road under the foremost contact of each path: elevation over distance, and its spectrum among the "
        "centre lines of the ISO 8608 classes A (smooth) to H (rough). " + _class_words(result)
    )
    return _illustration("road", "Road surface", caption, figure)


def _class_words(result: xr.Dataset) -> str:
    """Say what the fit found, path by path."""
    said = []
    for contact in plots.foremost(result):
        spectrum = plots.road_spectrum(result, contact)
        level, waviness = fit_iso(*spectrum)
        if np.isfinite(level):
            at_two, _ = fit_iso(*spectrum, waviness=2.0)
            said.append(
                f"{number(1e6 * level, 3)} × 10⁻⁶ m³ at 0.1 cycle/m with waviness {number(waviness, 3)} under "
                f"contact {contact}; with the waviness 2 of the standard {number(1e6 * at_two, 3)} × 10⁻⁶ m³, "
                f"class {iso_class(at_two)}"
            )
    if not said:
        return "The road is flat, or its record too short, so no class is fitted."
    return (
        f"The fit (dashed) gives {'; '.join(said)}. A class describes random roughness; a single bump or joint "
        "has none."
    )


def _contact_offsets(result: xr.Dataset) -> list[float]:
    """Zero, and the smallest and largest distance between contacts, ahead and behind [m]."""
    positions = result.position.values
    distances = np.unique(np.round(np.abs(positions[:, None] - positions), 6))
    distances = distances[distances > 0]
    chosen = np.unique([*distances[:1], *distances[-1:]]).tolist()
    return [0.0, *(offset for distance in chosen for offset in (distance, -distance))]


def _load_offsets(result: xr.Dataset) -> list[float]:
    """Distinct offsets from loads to points [m], some of them where there are many."""
    offsets = np.unique(np.round(result.point.values[:, None] - result["load"].values, 6)) + 0.0
    return sorted((float(offsets[place]) for place in plots.shown(offsets.size)), key=lambda x: (abs(x), -x))


def _frf_figures(result: xr.Dataset, guideway: Guideway, offsets: list[float]) -> list[Illustration]:
    speed, truncation = result.attrs["speed"], result.attrs.get("truncation", 0.0)

    def frf(frequency: FloatArray, ahead: Sequence[float]) -> ComplexArray:
        omega = 2 * np.pi * (frequency - 1j * FRF_DECAY * frequency[-1])
        return guideway.moving_frf(np.asarray(ahead), speed, omega)

    highest = _frf_end(0.5 / _time_step(result), truncation, frf)
    frequency = np.linspace(0.0, highest, FRF_POINTS)
    values = frf(frequency, offsets)
    figure = _figure(SINGLE + STACKED + 1.2)
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(SINGLE, STACKED + 0.5))
    mark = truncation if truncation < highest else None
    plots.legend_above(plots.frf_amplitude(frequency, values, offsets, above, truncation=mark))
    plots.frf_phase(frequency, values, offsets, below, truncation=mark)
    above.set_xlabel("")
    beyond = "the road counts as rigid" if "contact_force" in result else "the response is left out"
    return [_illustration("frf", "Moving FRFs of the road", _frf_words(values, offsets, mark, beyond), figure)]


def _frf_end(
    nyquist: float, truncation: float, frf: Callable[[FloatArray, Sequence[float]], ComplexArray]
) -> float:
    """Highest frequency to draw [Hz]."""
    if 0 < truncation < nyquist:
        return max(FRF_BEYOND * truncation, FRF_LEAST)
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
    figure = _figure(max(PANEL * count, SINGLE - 0.4) + 0.5)
    axes = figure.subplots(count, 1, sharex=True, sharey=True, squeeze=False)[:, 0]
    for panel, ax in enumerate(axes):
        draw(panel, ax)
        ax.set_title(names[panel], color=colours[panel], fontweight="bold")
        if panel < count - 1:
            ax.set_xlabel("")
    return figure


def _forces_figure(result: xr.Dataset) -> Illustration:
    curves = plots.contact_curves(result)
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
    words += _some_of(result.sizes["contact"], plots.MOST_CURVES, "contacts")
    return _illustration("forces", "Contact forces", words, figure)


def _peak_force(result: xr.Dataset) -> tuple[float, float, int]:
    """Largest magnitude of the dynamic force [N], its time [s] and contact."""
    places = [np.abs(column).argmax() for column in result.contact_force.values.T]
    peaks = [abs(column[p]) for column, p in zip(result.contact_force.values.T, places, strict=True)]
    contact = int(np.argmax(peaks))
    return float(peaks[contact]), float(result.time.values[places[contact]]), contact


def _zoom_figures(result: xr.Dataset) -> list[Illustration]:
    """Draw the forces around the largest one, where the record is long enough for that to add anything."""
    duration = _duration(result)
    peak, instant, contact = _peak_force(result)
    if duration <= 2 * ZOOM or not peak:
        return []
    first = min(max(instant - ZOOM / 2, 0.0), duration - ZOOM)
    chosen = [curve.column for curve in plots.contact_curves(result)]
    if contact not in chosen:
        chosen = [contact]
    figure = _figure(SINGLE)
    (ax,) = figure.subplots(1, 1, squeeze=False)[0]
    plots.contact_forces(result, ax, contacts=chosen, interval=(first, first + ZOOM))
    for line in ax.lines:
        line.set_linewidth(1.5)
    plots.legend_above(ax)
    caption = (
        f"The {ZOOM:g} s around the largest dynamic force ({number(1e-3 * peak)} kN under contact {contact}). "
        "Wheels in one path meet the same spot one after the other: look for the same event with its delay. "
        "Dashed: the static levels."
    )
    return [_illustration("zoom", "Contact forces around the peak", caption, figure)]


def _force_spectra_figure(result: xr.Dataset) -> Illustration:
    figure = _figure(SINGLE + 0.3)
    (ax,) = figure.subplots(1, 1, squeeze=False)[0]
    plots.legend_above(plots.contact_force_spectra(result, ax))
    caption = (
        "Amplitude spectral densities of the dynamic contact forces (one-sided; their squares integrate to the "
        "variance). The lowest humps are, as a rule, the body on its suspension, higher ones the wheels on their "
        "tyres. The frequency axis covers 99.99 % of the variance, and the truncation."
    )
    caption += _some_of(result.sizes["contact"], plots.MOST_CURVES, "contacts")
    return _illustration("force-spectra", "Contact-force spectra", caption, figure)


def _deflections_figure(result: xr.Dataset) -> Illustration:
    curves = plots.contact_curves(result)
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
    caption += _some_of(result.sizes["contact"], plots.MOST_CURVES, "contacts")
    return _illustration("deflections", "Deflections under the contacts", caption, figure)


def _accelerations_figure(result: xr.Dataset) -> Illustration:
    total = result.sizes["dof"]
    dofs = plots.shown(total, MOST_DOFS)
    figure = _figure((PANEL + 0.15) * max(len(dofs), 2) + 0.4)
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
    caption += _some_of(total, MOST_DOFS, "degrees of freedom")
    return _illustration("accelerations", "Accelerations of the vehicle", caption, figure)


def _prescribed_figure(result: xr.Dataset) -> Illustration:
    figure = _figure(SINGLE)
    (ax,) = figure.subplots(1, 1, squeeze=False)[0]
    plots.legend_above(plots.prescribed_forces(result, ax))
    caption = "The forces on the road, as prescribed; a force that is not zero at t = 0 is switched on there."
    caption += _some_of(result.sizes["load"], plots.MOST_CURVES, "loads")
    return _illustration("prescribed", "Prescribed forces", caption, figure)


def _point_deflections_figure(result: xr.Dataset) -> Illustration:
    figure = _figure(SINGLE)
    (ax,) = figure.subplots(1, 1, squeeze=False)[0]
    plots.legend_above(plots.deflections(result, ax))
    caption = (
        "Deflection of the road at points that travel with the loads, positive down. The road starts at rest: look "
        "for how far the first swing exceeds the level that follows."
    )
    caption += _some_of(result.sizes["point"], plots.MOST_CURVES, "points")
    return _illustration("deflections", "Deflections", caption, figure)


def _loaded_spectra_figure(result: xr.Dataset) -> Illustration:
    figure = _figure(2 * SINGLE)
    above, below = figure.subplots(2, 1)
    plots.legend_above(plots.prescribed_force_spectra(result, above))
    plots.legend_above(plots.deflection_spectra(result, below))
    caption = (
        "Amplitude spectral densities of forces and deflections, means removed (one-sided). Where the deflections "
        "fall faster than the forces, the road is stiff."
    )
    return _illustration("spectra", "Spectra of forces and deflections", caption, figure)

"""The description of a profile for reading: tables, figures, one HTML page."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from movingfrf._basics import wording
from movingfrf._basics.version import VERSION
from movingfrf._basics.wording import number, plain
from movingfrf.metrics.profile import PathDescription, ProfileDescription
from movingfrf.reports.axes import SPECTRUM_STYLE, decimated, draw_classes, draw_fit, legend_above
from movingfrf.reports.curves import PALETTE
from movingfrf.reports.figures import SIZE, Illustration, blank, drawing, illustrated
from movingfrf.reports.page import rendered
from movingfrf.reports.tables import Column, Row, Setting, Table
from movingfrf.roughness.spectra.iso import IsoRoad

if TYPE_CHECKING:
    from matplotlib.axes import Axes


# Spatial frequencies of the figures [cycle/m].
DRAWN_BAND = (0.005, 10.0)


def tables(found: ProfileDescription) -> list[Table]:
    """Tabulate a description.

    Parameters
    ----------
    found : ProfileDescription
        What `describe_profile` returned.

    Returns
    -------
    list of Table
        Spectrum and extent of each path, and the roughness index of segments.
    """
    colours = _colours(found)
    spectra = Table(
        "Elevation and fitted spectrum of each path: density G at 0.1 cycle/m, waviness w, and the range that they "
        f"were fitted over.{f' {found.scope}.' if found.scope else ''}",
        "path",
        [
            Column("lowest", "m"),
            Column("highest", "m"),
            Column("mean slope", "%"),
            Column("resolution", "mm"),
            Column("G", "10⁻⁶ m³"),
            Column("w", ""),
            Column("fitted", "cycle/m"),
            Column("G at w = 2", "10⁻⁶ m³"),
            Column("class", ""),
        ],
        [
            Row(
                _name(path),
                [
                    number(path.lowest, 6),
                    number(path.highest, 6),
                    f"{100 * path.slope:.2f}",
                    plain(1e3 * path.resolution) if path.resolution else "–",
                    _or_dash(1e6 * path.fit.roughness),
                    _or_dash(path.fit.waviness),
                    "–" if path.fit.reason else f"{path.fit.band[0]:.2g} to {path.fit.band[1]:.3g}",
                    _or_dash(1e6 * path.fit.roughness_at_two),
                    path.fit.road_class or "–",
                ],
                colour,
            )
            for path, colour in zip(found.paths, colours, strict=True)
        ],
    )
    rows = [
        Row(f"{_name(path)}, per {span:g} m", summary, colour)
        for path, colour in zip(found.paths, colours, strict=True)
        for span, each in path.indices.items()
        if (summary := _summary(each, span, found))
    ]
    whole = [
        Row(f"{_name(path)}, whole", ["1", number(path.index), "–", "–", "–", "–"], colour)
        for path, colour in zip(found.paths, colours, strict=True)
        if np.isfinite(path.index)
    ]
    if not whole:
        return [spectra]
    columns = [
        Column("segments", ""),
        Column("mean", "mm/m"),
        Column("median", "mm/m"),
        Column("95 % below", "mm/m"),
        Column("highest", "mm/m"),
        Column("there from", "m"),
    ]
    title = (
        "International roughness index (IRI) of the whole and of segments that begin at multiples of their length; "
        "what is shorter at both ends stands in iri.csv alone."
    )
    return [spectra, Table(title, "path", columns, [*whole, *rows])]


def render(found: ProfileDescription, *, understood: str, title: str) -> str:
    """Write the page about a profile.

    Parameters
    ----------
    found : ProfileDescription
        What `describe_profile` returned.
    understood : str
        How the file was understood.
    title : str
        Title of the page.

    Returns
    -------
    str
        One HTML page without references to anything outside it. Equal input gives equal text.
    """
    stations = found.profile.stations
    even = found.longest_step - found.shortest_step <= 1e-6 * found.longest_step
    step = f"{found.shortest_step:.4g}" if even else f"{found.shortest_step:.4g} to {found.longest_step:.4g}"
    settings = [
        Setting("length", f"{found.length:.6g} m", f"from {stations[0]:.12g} to {stations[-1]:.12g} m"),
        Setting("stations", str(stations.size)),
        Setting("step", f"{step} m"),
        Setting("paths", str(found.profile.paths), f"{len(found.paths)} of them described" if found.scope else ""),
        Setting("source", found.profile.source or "not stated", wide=True),
        Setting("understood", understood, wide=True),
    ]
    with drawing():
        figures = _figures(found)
    return rendered(
        "profile.html.j2",
        title=title,
        version=VERSION,
        summary=_lead(found),
        settings=settings,
        findings=found.findings,
        steps=found.profile.steps,
        tables=tables(found),
        figures=figures,
        method=_method(),
    )


def _method() -> list[str]:
    """Say how it was computed."""
    return [
        "Spectra by Welch's method: half-overlapping pieces of at most 400 m, each freed of its trend, Hann "
        "window; one-sided, without the three lowest lines. The fit is a straight line in logarithms through the "
        "mean densities of the bands of ISO 8608 (octaves, thirds, twelfths) from 0.011 to 2.83 cycle/m, or that "
        "part of it in which there is content: not beyond a place where the density falls to a quarter of the "
        "line. The class is that of the fit with waviness 2.",
        "IRI: the golden car at 80 km/h over the profile averaged over 250 mm (ASTM E1926), mean rectified "
        "suspension speed over speed. Segments begin at multiples of their length; what is left at both ends is "
        "shorter, is listed in iri.csv, and is no part of mean, median and the like.",
        "Coherence: magnitude squared of the cross-spectrum over the product of both spectra, each summed over "
        "the bands of ISO 8608. It is not zero even of paths without anything in common, but about one over the "
        "number of lines of all pieces that were summed: short profiles show too much of it.",
    ]


def _lead(found: ProfileDescription) -> str:
    classes = sorted({path.fit.road_class for path in found.paths if path.fit.road_class})
    rough = [path.index for path in found.paths if np.isfinite(path.index)]
    words = f"A profile of {found.length:.6g} m with {wording.count(found.profile.paths, 'path')}"
    if classes:
        words += f", class {' to '.join(dict.fromkeys([classes[0], classes[-1]]))} of ISO 8608"
        words += " (of little meaning, see below)" if any(path.fit.doubt for path in found.paths) else ""
    if rough:
        words += f", with an IRI of {' to '.join(dict.fromkeys(f'{x:.2f}' for x in (min(rough), max(rough))))} mm/m"
    return f"{words}."


def _name(path: PathDescription) -> str:
    return f"{path.number}" if path.across is None else f"{path.number} at {path.across:+g} m"


def _colours(found: ProfileDescription) -> list[str]:
    return [PALETTE[n % len(PALETTE)] for n in range(len(found.paths))]


def _or_dash(value: float) -> str:
    return number(value, 3) if np.isfinite(value) else "–"


def _summary(each: np.ndarray, span: float, found: ProfileDescription) -> list[str]:
    """Tell number, mean, median, 95 % and highest of whole segments, and where that begins; empty without any."""
    starts, ends = found.edges[span][:-1], found.edges[span][1:]
    there = np.flatnonzero(np.isfinite(each) & (ends - starts > span - found.used_step / 2))
    if not there.size:
        return []
    values, worst = each[there], there[each[there].argmax()]
    told = (values.mean(), np.median(values), np.percentile(values, 95), each[worst])
    return [str(there.size), *(number(float(v)) for v in told), f"{starts[worst]:.12g}"]


def _figures(found: ProfileDescription) -> list[Illustration]:
    figures = [_elevations(found), _spectra(found)]
    figures += [_index(found)] if any(path.indices for path in found.paths) else []
    figures += [_coherence(found)] if found.coherence is not None else []
    return figures


def _elevations(found: ProfileDescription) -> Illustration:
    figure = blank(SIZE.single)
    ax = figure.subplots()
    for path, colour in zip(found.paths, _colours(found), strict=True):
        for n, piece in enumerate(found.pieces):
            distance, elevation = decimated(piece.stations, piece.columns[:, path.number])
            ax.plot(distance, elevation, color=colour, label="" if n else f"path {_name(path)}")
    ax.margins(x=0)
    ax.ticklabel_format(axis="y", useOffset=False)
    ax.set_xlabel("distance [m]")
    ax.set_ylabel("elevation, up [m]")
    legend_above(ax)
    return illustrated("elevation", "Elevation", "Elevation over distance along the road.", figure)


def _spectra(found: ProfileDescription) -> Illustration:
    figure = blank(SIZE.single + 0.6)
    ax = figure.subplots()
    ends = np.array(DRAWN_BAND)
    low = float(IsoRoad.of_class("A").density(np.array([10.0]))[0])
    high = float(IsoRoad.of_class("H").density(np.array([0.011]))[0])
    for path, colour in zip(found.paths, _colours(found), strict=True):
        n, density = path.spatial_frequency, path.density
        inside = (n >= ends[0]) & (n <= ends[1]) & (density > 0)
        if not inside.any():
            continue
        n, density = decimated(n[inside], density[inside], buckets=400, logarithmic=True)
        ax.plot(n, density, color=colour, alpha=SPECTRUM_STYLE.opacity, label=f"path {_name(path)}")
        draw_fit(path.fit, colour, ax)
        low, high = min(low, float(density.min())), max(high, float(density.max()))
    ax.set(xscale="log", yscale="log", xlim=DRAWN_BAND, ylim=(max(low, 1e-12 * high) / 3, 3 * high))
    ax.minorticks_off()
    draw_classes(ax, np.array([0.01, 10.0]))
    ax.set_xlabel("spatial frequency [cycle/m]")
    ax.set_ylabel("spectral density [m³]")
    legend_above(ax)
    caption = (
        "Spectrum of the elevation among the centre lines of the ISO 8608 classes A (smooth) to H (rough); dashed, "
        "the fit of each path over the range that was fitted. A floor at high frequencies is, as a rule, the "
        "resolution of the instrument or the file."
    )
    return illustrated("spectrum", "Spectrum", caption, figure)


def _index(found: ProfileDescription) -> Illustration:
    figure = blank(SIZE.single)
    ax = figure.subplots()
    for path, colour in zip(found.paths, _colours(found), strict=True):
        for n, (span, each) in enumerate(path.indices.items()):
            _stairs(ax, found.edges[span], each, colour, f"path {_name(path)}, per {span:g} m", n)
    ax.margins(x=0)
    ax.set_ylim(bottom=0.0)
    ax.set_xlabel("distance [m]")
    ax.set_ylabel("IRI [mm/m]")
    legend_above(ax)
    caption = "International roughness index of segments: thin, the short ones; thick, the long ones."
    return illustrated("iri", "International roughness index", caption, figure)


def _stairs(ax: Axes, edges: np.ndarray, each: np.ndarray, colour: str, label: str, rank: int) -> None:
    """Draw segments as stairs, thinned out where there are many."""
    x, y = decimated(np.repeat(edges, 2)[1:-1], np.repeat(each, 2))
    ax.plot(x, y, color=colour, linewidth=0.7 + 1.1 * rank, alpha=0.55 + 0.4 * rank, label=label)


def _coherence(found: ProfileDescription) -> Illustration:
    assert found.coherence is not None
    figure = blank(SIZE.single)
    ax = figure.subplots()
    ax.plot(*found.coherence, color=PALETTE[0], marker="o", markersize=3)
    ax.set(xscale="log", xlim=DRAWN_BAND, ylim=(0.0, 1.05))
    ax.set_xlabel("spatial frequency [cycle/m]")
    ax.set_ylabel("coherence γ²")
    first, last = found.paths[0], found.paths[-1]
    caption = (
        f"Magnitude-squared coherence between the paths {_name(first)} and {_name(last)}: near 1 the wheels of an "
        "axle rise together, near 0 each for itself, which rolls the vehicle."
    )
    return illustrated("coherence", "Coherence between the outermost paths", caption, figure)

"""What a report says about a vehicle on a road."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from movingfrf._basics import wording
from movingfrf._basics.welch import FLAT
from movingfrf._basics.wording import number, plain
from movingfrf.guideways.guideway import Guideway
from movingfrf.metrics.listed import CAPTIONS, FINITE_CAPTIONS
from movingfrf.metrics.measures import measures
from movingfrf.metrics.spectra import elevation_spectrum
from movingfrf.reports import plots
from movingfrf.reports.axes import legend_above
from movingfrf.reports.curves import contact_curves, distinct, foremost, left_out_dofs, readable, telling
from movingfrf.reports.figures import SIZE, Illustration, blank, illustrated, panels
from movingfrf.reports.frf import frf_figures
from movingfrf.reports.tables import Table, measure_tables
from movingfrf.reports.ways import is_stepped, stands_still, stepped_road, way
from movingfrf.results.labels import contacts_in_words, duration_of, speed_in_words
from movingfrf.roughness.fitting import fit_iso

if TYPE_CHECKING:
    import xarray as xr


def coupled_summary(result: xr.Dataset) -> str:
    """Say in a sentence what was computed."""
    contacts, dofs = result.sizes["contact"], result.sizes["dof"]
    surface = "rough road" if is_rough(result) else "smooth road"
    if stands_still(result):
        varies = f"{1e3 * float(np.ptp(result.roughness.values, axis=0).max()):.3g}"
        surface = f"finite road, whose surface rises and falls by {varies} mm"
    weight = number(1e-3 * float(result.static_load.values.sum()))
    return (
        f"A vehicle of {weight} kN with {wording.count(contacts, 'contact')} and "
        f"{wording.count(dofs, 'degree of freedom', 'degrees of freedom')} travels at {speed_in_words(result)} for "
        f"{plain(duration_of(result))} s over a {surface}; contact forces, deflections of "
        f"the road and motions of the vehicle were computed together, {way(result).words}."
    )


def coupled_method(result: xr.Dataset) -> list[str]:
    """Say how it was computed, and what is assumed."""
    return [
        "Vehicle and road are linear, and the speed is constant.",
        *(_stepped(result) if is_stepped(result) else _transformed()),
        "Contact is kept at all times: where a total contact force would turn negative the model pulls, and the "
        "findings say so.",
        "Forces, deflections and motions are positive downward (pitch: nose down), elevations upward; positions "
        "are positive ahead. Spectra are one-sided, estimated by Welch's method (Hann window, half overlap).",
    ]


def _transformed() -> list[str]:
    return [
        "The road is infinitely long and the same everywhere along its length; only its surface is rough.",
        "Before the record the vehicle has travelled on the smooth road for ever: static loads and steady sag are "
        "there from the start, and the roughness sets in from the foremost contact on.",
        "At every frequency the contact forces F solve (I + D G) F = D R, with G the moving FRFs between the "
        "contacts, D the dynamic stiffness of the vehicle at its contacts and R the elevation under them. Beyond "
        "the truncation G = 0: the road is rigid there, the vehicle is not.",
    ]


def _stepped(result: xr.Dataset) -> list[str]:
    run_in = result.attrs["run_in"]
    before = (
        f"Before the record the weight travels along the smooth road for {plain(run_in)} s, from a road at rest "
        "under it"
        if run_in
        else "The record begins with the road at rest under the vehicle's weight"
    )
    return [
        stepped_road(result),
        before
        + (
            ". Since the road is the same everywhere, what the roughness adds is stepped on its own afterwards."
            if result.attrs["superposed"]
            else ", and is stepped on together with what the roughness adds."
        )
        + (
            " Static levels are those at the end of that: on a bridge, which gives way differently everywhere, "
            "they are a beginning and no mean."
            if stands_still(result)
            else ""
        ),
        "In every step the contact forces solve F = k (z − w + r) + c (ż − ẇ − v ∂w/∂x + ṙ), with z the vehicle, w "
        "the road and r the elevation at the contact.",
    ]


def coupled_tables(result: xr.Dataset) -> list[Table]:
    """Put the measures of the response into tables."""
    return measure_tables(result, measures(result), FINITE_CAPTIONS if stands_still(result) else CAPTIONS)


def of_coupled(result: xr.Dataset, guideway: Guideway | None) -> list[Illustration]:
    """Illustrate the response of a vehicle and a guideway; one that has no moving FRF is None."""
    return [
        _roughness_figure(result),
        *frf_figures(result, guideway, _contact_offsets(result)),
        _forces_figure(result),
        *_zoom_figures(result),
        _force_spectra_figure(result),
        _deflections_figure(result),
        _accelerations_figure(result),
    ]


def is_rough(result: xr.Dataset) -> bool:
    """Tell whether the road has any roughness to draw."""
    return bool(np.ptp(result.roughness.values, axis=0).max() >= FLAT)


def _roughness_figure(result: xr.Dataset) -> Illustration:
    elevation = "What the foremost contact of each path rolls over: elevation over distance"
    if not any(plots.spectrum_in_sight(result, contact)[0].size for contact in foremost(result)):
        figure = blank(SIZE.single)
        legend_above(plots.roughness(result, figure.subplots()))
        caption = (
            f"{elevation}. The road is next to flat, or the record too short for a spectrum, so none is drawn."
        )
        return illustrated("road", "Roughness", caption, figure)
    figure = blank(SIZE.stacked + SIZE.single + 0.9)
    above, below = figure.subplots(2, 1, height_ratios=(SIZE.stacked, SIZE.single))
    legend_above(plots.roughness(result, above))
    legend_above(plots.roughness_spectrum(result, below))
    caption = (
        f"{elevation}, and its spectrum among the "
        "centre lines of the ISO 8608 classes A (smooth) to H (rough). " + _class_words(result)
    )
    return illustrated("road", "Roughness", caption, figure)


def _class_words(result: xr.Dataset) -> str:
    """Say which spectrum the road was made from, or what the fit found, path by path."""
    if "spectrum" in result.attrs:
        return f"It was made from a spectrum, so none is fitted: {result.attrs['spectrum']}."
    said = []
    called = contacts_in_words(result)
    for contact in foremost(result):
        fit = fit_iso(*elevation_spectrum(result, contact))
        if fit.reason:
            said.append(f"Under {called[contact]} no class is fitted: {fit.reason}.")
            continue
        said.append(
            f"The fit under {called[contact]} (dashed, over {fit.covered}) gives "
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


def _forces_figure(result: xr.Dataset) -> Illustration:
    curves = distinct(contact_curves(result), result.contact_force.values)
    figure = panels(
        len(curves),
        lambda n, ax: plots.contact_forces(result, ax, contacts=[curves[n].column]).set_ylabel("force [kN]"),
        [curve.colour for curve in curves],
        [curve.name for curve in curves],
    )
    peak, instant, contact = _peak_force(result)
    under = contacts_in_words(result)[contact]
    level = "level at the beginning" if stands_still(result) else "static level about which they vary"
    words = f"Total contact forces; dashed, the {level}. "
    words += (
        f"The largest dynamic force, {number(1e-3 * peak)} kN, acts under {under} at {instant:.6g} s. "
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
    """Draw the forces in a window around the largest one, if the record is long enough for it to show more."""
    duration = duration_of(result)
    peak, instant, contact = _peak_force(result)
    window = _window(result, contact)
    if duration <= 2 * window or not peak:
        return []
    first = min(max(instant - window / 2, 0.0), duration - window)
    chosen = _neighbours(result, contact)
    figure = blank(SIZE.single)
    (ax,) = figure.subplots(1, 1, squeeze=False)[0]
    plots.contact_forces(result, ax, contacts=chosen, interval=(first, first + window))
    for line in ax.lines:
        line.set_linewidth(1.5)
    legend_above(ax)
    caption = (
        f"The {number(window, 2)} s around the largest dynamic force ({number(1e-3 * peak)} kN under "
        f"{contacts_in_words(result)[contact]}), there and under the nearest contact of the same path. They meet "
        "the same spot one after the other: look for the same event with its delay. "
        f"Dashed: the {'levels at the beginning' if stands_still(result) else 'static levels'}."
    )
    return [illustrated("zoom", "Contact forces around the peak", caption, figure)]


def _window(result: xr.Dataset, contact: int) -> float:
    """So long [s] that vibrations can be told apart, and what a contact meets is seen under its neighbour too."""
    longest, swings = 1.5, 40.0  # [s], and vibrations that a figure bears; conventions
    force, position = result.contact_force.values[:, contact], result.position.values[_neighbours(result, contact)]
    rate = np.count_nonzero(np.diff(force > 0)) / (2.0 * duration_of(result))
    delay = float(np.ptp(position)) / abs(result.attrs["speed"])
    return min(longest, max(swings / max(rate, swings / longest), 3.0 * delay))


def _neighbours(result: xr.Dataset, contact: int, most: int = 2) -> list[int]:
    """Name a contact and those nearest to it in its path, as many as a figure around the peak bears."""
    position, path = result.position.values, result.path.values
    same = np.flatnonzero(path == path[contact])
    nearest = same[np.argsort(np.abs(position[same] - position[contact]), kind="stable")]
    return sorted(nearest[:most].tolist())


def _force_spectra_figure(result: xr.Dataset) -> Illustration:
    figure = blank(SIZE.single + 0.3)
    (ax,) = figure.subplots(1, 1, squeeze=False)[0]
    legend_above(plots.contact_force_spectra(result, ax))
    caption = (
        "Amplitude spectral densities of the dynamic contact forces (one-sided; their squares integrate to the "
        "variance). The lowest humps are, as a rule, the body on its suspension, higher ones the wheels on their "
        "tyres. The frequency axis covers 99.99 % of the variance. Where curves drop straight down, the road's "
        "content ends: at its shortest wave, at this speed."
    )
    caption += wording.some_of(result.sizes["contact"], wording.MOST_CURVES, "contacts")
    return illustrated("force-spectra", "Contact-force spectra", caption, figure)


def _deflections_figure(result: xr.Dataset) -> Illustration:
    curves = distinct(contact_curves(result), result.deflection.values)
    figure = panels(
        len(curves),
        lambda n, ax: plots.deflections(result, ax, places=[curves[n].column]).set_ylabel("deflection [mm]"),
        [curve.colour for curve in curves],
        [curve.name for curve in curves],
    )
    deflection = result.deflection.values
    contact = int(np.argmax([column.max() for column in deflection.T]))
    place = int(deflection[:, contact].argmax())
    sag = "that at the beginning" if stands_still(result) else "the sag in steady travel on the smooth road"
    caption = (
        f"Deflection of the road under each contact, positive down; dashed, {sag}. The largest, "
        f"{number(1e3 * float(deflection[place, contact]))} mm, occurs under {contacts_in_words(result)[contact]} "
        f"at {result.time.values[place]:.6g} s."
    )
    caption += wording.some_of(result.sizes["contact"], wording.MOST_CURVES, "contacts")
    return illustrated("deflections", "Deflections under the contacts", caption, figure)


def _accelerations_figure(result: xr.Dataset, most: int = 8) -> Illustration:
    """Draw degrees of freedom, at most so many, each in panels of its own."""
    total = result.sizes["dof"]
    rms = np.sqrt(np.mean(result.acceleration.values**2, axis=0))
    dofs = telling(rms, result.dof_unit.values.tolist(), most)
    figure = blank((SIZE.panel + 0.15) * max(len(dofs), 2) + 0.4)
    axes = figure.subplots(len(dofs), 2, sharex="col", squeeze=False, width_ratios=(3, 2))
    for row, dof in zip(axes, dofs, strict=True):
        plots.accelerations(result, row[0], dof=dof)
        plots.acceleration_spectrum(result, row[1], dof=dof)
        row[0].set_title(readable(str(result.dof.values[dof])), fontweight="bold")
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
    caption += left_out_dofs(total, len(dofs))
    return illustrated("accelerations", "Accelerations of the vehicle", caption, figure)

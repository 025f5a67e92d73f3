"""Items 7 to 10 and 12: the vehicle on the road."""

from __future__ import annotations

import math
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np
from threadpoolctl import threadpool_limits

from movingfrf import plots
from movingfrf._checks import FloatArray
from movingfrf.comparison import ratios
from movingfrf.page import Column
from movingfrf.paper.drawing import (
    BLACK,
    BLUE,
    ORANGE,
    SKY,
    Line,
    canvas,
    curve,
    legend_outside,
    logarithmic,
    title,
)
from movingfrf.paper.outcome import UNJUDGED, DataTable, Outcome, Plot, Statement, verdict
from movingfrf.paper.road import SUBSTITUTE
from movingfrf.paper.study import TRUNCATION, Study, closed_form, relative, scenario
from movingfrf.roughness.spectra import IsoRoad, fit_iso, iso_class, welch
from movingfrf.wording import number

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

VEHICLE = (
    "The vehicle's parameters stand in a table that the text of the paper does not have. Substitute: the half "
    "truck of Mulcahy, and Law and Zhu."
)
ROUGHNESS = (
    "The profile is a figure of the paper. Substitute: a seeded realisation of class A of ISO 8608, 0.01 to 10 "
    "cycles/m."
)

# Two curves that differ by less than this are one to the eye.
ONE_CURVE = 1e-2

# The times that the paper gives for its last table, on its authors' computer [s].
STATED = {"cdfm": 1610.0, "sim": 686.0, "moving-frf": 5.9}

# Equal errors at which times are compared.
EQUAL = (1e-3, 1e-4)

# What the methods are called in the paper's last table.
NAMES = {
    "moving-frf": "moving FRF, closed form",
    "moving-frf-fe": "moving FRF, 40 m of elements, end reflections cancelled",
    "moving-frf-fe-plain": "moving FRF, 40 m of elements, as in the paper",
    "duhamel": "Duhamel's integral",
    "cdfm": "CDFM",
    "cdfm-window": "CDFM on a road that travels along",
    "cdfm-weight": "CDFM, the weight stepped along",
    "sim": "SIM",
}

ZOOM = (12.0, 12.5)


def profile(study: Study) -> Outcome:
    """Show the class A profile and its spectrum against ISO 8608."""
    road = scenario("truck").road
    assert road is not None
    distance, elevation = np.asarray(road.profile.distance), np.asarray(road.profile.elevation)
    n, density = welch(elevation, float(distance[1] - distance[0]), segments=8)
    level, waviness = fit_iso(n, density)
    at_two, _ = fit_iso(n, density, waviness=2.0)

    figure, (above, below) = canvas(1, 2, 2.6, width_ratios=(3, 2))
    curve(above, distance, 1e3 * elevation, BLUE)
    above.set(xlabel="distance [m]", ylabel="elevation [mm]", xlim=(distance[0], distance[-1]))
    inside = (n >= 0.01) & (n <= 10)
    curve(below, n[inside], density[inside], BLUE, "this profile")
    ends = np.array([0.01, 10.0])
    centre = IsoRoad.of_class("A").density(ends)
    below.plot(ends, centre, **BLACK._asdict(), label="class A, centre")
    below.plot(ends, 2 * centre, color=plots.INK, linestyle=":", label="class A, limit")
    below.set(xscale="log", yscale="log", xlabel="spatial frequency [cycle/m]", ylabel="$G_d$ [m³]")
    below.legend()
    return Outcome(
        statements=[
            Statement(
                "The road surface is of class A (Fig. 13).",
                f"Fitted with the waviness 2 of the standard: {number(1e6 * at_two, 3)} × 10⁻⁶ m³ at 0.1 cycle/m, "
                f"class {iso_class(at_two)} (centre 16, limit 32).",
                verdict(iso_class(at_two) == "A"),
            )
        ],
        numbers={"roughness_m3": at_two, "fitted_waviness": waviness, "roughness_at_fitted_waviness_m3": level},
        substitutes=[ROUGHNESS],
        plots=[
            Plot(
                "figure_13",
                "The road's surface",
                "(a) The profile; (b) its spectrum, and class A of ISO 8608.",
                figure,
            )
        ],
    )


def spectra(study: Study) -> Outcome:
    """Show spectra of moving FRFs, contact forces, roughness and responses."""
    result = study.by_moving_frf
    frequency = np.linspace(0.0, 100.0, 801)
    found = study.struck.moving_frf(study.offsets, study.speed, 2 * np.pi * frequency)
    exact = closed_form(study.road, frequency, study.offsets, study.speed)

    figure, axes = canvas(2, 2, 4.6)
    for n, (line, name) in enumerate(((BLACK, "under the load"), (BLUE, "ahead"), (SKY, "behind"))):
        curve(axes[0], frequency, 1e9 * np.abs(found[:, n]), line._replace(linewidth=1.1), name)
    axes[0].set(xlabel="frequency [Hz]", ylabel="|moving FRF| [nm/N]", xlim=(0, 100), yscale="log", ylim=(0.1, 50))
    deflection = (result.deflection - result.static_deflection).values
    for ax, values, scale, name in (
        (axes[1], result.contact_force.values, 1e-3, "contact force [kN/√Hz]"),
        (axes[2], result.roughness.values, 1e3, "roughness [mm/√Hz]"),
        (axes[3], deflection, 1e6, "deflection [µm/√Hz]"),
    ):
        _densities(ax, values, result, scale, name)
    axes[3].set_ylim(1e-3, None)
    for ax in axes:
        ax.legend()
    ahead, behind = (float(np.abs(exact[:, n]).max() / np.abs(exact[:, 0]).max()) for n in (1, 2))
    return Outcome(
        statements=[
            Statement(
                "Fig. 14 shows the spectra (no statement); the matrix of moving FRFs is not symmetric.",
                f"The largest amplitude ahead is {number(ahead, 2)}, behind {number(behind, 2)} of that under the "
                "load.",
                UNJUDGED,
            )
        ],
        numbers={"largest_ahead_over_under_load": ahead, "largest_behind_over_under_load": behind},
        computed=["Densities by Welch's method, one-sided: their squares integrate to the variance."],
        substitutes=[SUBSTITUTE, VEHICLE, ROUGHNESS],
        plots=[
            Plot(
                "figure_14",
                "Spectra of the coupled system",
                "(a) Moving FRFs under a contact, one wheelbase ahead and one behind, from 40 m of finite "
                "elements; amplitude densities of (b) contact forces, (c) roughness, (d) dynamic deflections.",
                figure,
            )
        ],
    )


def _densities(ax: Axes, values: FloatArray, result: xr.Dataset, scale: float, name: str) -> None:
    for column, (line, wheel) in enumerate(((BLUE, "front"), (ORANGE, "rear"))):
        frequency, density = plots.spectral_density(values[:, column], result.attrs["time_step"])
        drawn = frequency <= 100
        curve(ax, frequency[drawn], scale * np.sqrt(density[drawn]), line, wheel)
    ax.set(xlabel="frequency [Hz]", ylabel=name, xlim=(0, 100))
    logarithmic(ax)


def deflections(study: Study) -> Outcome:
    """Compare contact deflections by moving FRF with those by CDFM."""
    found, stepped, exact = study.by_moving_frf, study.by_cdfm, study.in_closed_form
    time = found.time.values
    total = {name: relative(r.deflection.values, stepped.deflection.values) for name, r in _both(found, exact)}
    dynamic = {name: relative(_dynamic(result), _dynamic(stepped)) for name, result in _both(found, exact)}

    figure, axes = canvas(2, 2, 3.6, width_ratios=(3, 2), sharey="row")
    for row, wheel in enumerate(("front", "rear")):
        for ax, interval in zip(axes[2 * row : 2 * row + 2], ((0.0, 24.0), ZOOM), strict=True):
            some = (time >= interval[0]) & (time <= interval[1])
            for result, line, name in ((stepped, BLACK, "CDFM"), (found, ORANGE, "moving FRF")):
                curve(ax, time[some], 1e3 * result.deflection.values[some, row], line, name)
            ax.set(xlim=interval)
            title(ax, f"{wheel} contact")
            if row:
                ax.set_xlabel("time [s]")
        axes[2 * row].set_ylabel("deflection [mm]")
    legend_outside(figure, axes[0])
    return Outcome(
        statements=[
            Statement(
                "The contact deflections by moving FRF and by CDFM agree (Fig. 15).",
                f"They differ by {number(total['struck'], 2)} (relative L2, the worse contact), their dynamic "
                f"parts by {number(dynamic['struck'], 2)}; in closed form by {number(total['exact'], 2)} and "
                f"{number(dynamic['exact'], 2)}.",
                verdict(total["struck"] < ONE_CURVE),
            )
        ],
        numbers={
            "deflection_difference": total["struck"],
            "dynamic_deflection_difference": dynamic["struck"],
            "dynamic_deflection_difference_closed_form": dynamic["exact"],
        },
        computed=[
            "CDFM: the whole road in elements of 0.2 m or less, Newmark's method (average acceleration), 1 ms. "
            "The convective term v ∂w/∂x is included in the dashpots of the tyres. Both see the same spline of "
            "the road.",
        ],
        substitutes=[SUBSTITUTE, VEHICLE, ROUGHNESS],
        plots=[
            Plot(
                "figure_15",
                "Deflection of the road under the contacts",
                "Total deflection under both contacts by moving FRF (40 m of finite elements, up to 70 Hz) and "
                "CDFM: the whole journey, and half a second of it.",
                figure,
            )
        ],
    )


def _both(found: xr.Dataset, exact: xr.Dataset) -> list[tuple[str, xr.Dataset]]:
    return [("struck", found), ("exact", exact)]


def _dynamic(result: xr.Dataset) -> FloatArray:
    return (result.deflection - result.static_deflection).values


def accelerations(study: Study) -> Outcome:
    """Compare accelerations by moving FRF, CDFM and SIM."""
    found, exact = study.by_moving_frf, study.in_closed_form
    stepped, apart = study.by_cdfm, study.by_sim
    names = [plots.readable(str(name)) for name in found.dof.values]
    pairs = {
        "moving FRF − CDFM": (found, stepped),
        "moving FRF − SIM": (found, apart),
        "CDFM − SIM": (stepped, apart),
        "closed form − CDFM": (exact, stepped),
    }
    differences = {
        name: [relative(a.acceleration.values[:, [n]], b.acceleration.values[:, [n]]) for n in range(len(names))]
        for name, (a, b) in pairs.items()
    }
    wheels = max(differences["moving FRF − CDFM"][2:] + differences["moving FRF − SIM"][2:])

    full = study.driven(study.road, truncation=None).acceleration.values[:, 2:]
    cut, coarse = (relative(result.acceleration.values[:, 2:], full) for result in (exact, stepped))

    spectrum, axes = canvas(2, 2, 4.2)
    for n, ax in enumerate(axes):
        frequency, density = plots.spectral_density(found.acceleration.values[:, n], found.attrs["time_step"])
        drawn = frequency <= 100
        curve(ax, frequency[drawn], np.sqrt(density[drawn]), BLUE)
        unit = found.dof_unit.values[n]
        ax.set(xlabel="frequency [Hz]", ylabel=f"[{unit}/s²/√Hz]", xlim=(0, 100))
        logarithmic(ax)
        title(ax, names[n])
    histories, rows = canvas(2, 2, 3.6, width_ratios=(3, 2), sharey="row")
    time = found.time.values
    for row, n in enumerate((2, 3)):
        for ax, interval in zip(rows[2 * row : 2 * row + 2], ((0.0, 24.0), (ZOOM[0], ZOOM[0] + 0.25)), strict=True):
            some = (time >= interval[0]) & (time <= interval[1])
            for result, line, name in (
                (stepped, BLACK, "CDFM"),
                (apart, SKY, "SIM"),
                (found, ORANGE, "moving FRF"),
            ):
                curve(ax, time[some], result.acceleration.values[some, n], line, name)
            ax.set(xlim=interval)
            title(ax, names[n])
            if row:
                ax.set_xlabel("time [s]")
        rows[2 * row].set_ylabel("acceleration [m/s²]")
    legend_outside(histories, rows[0])
    return Outcome(
        statements=[
            Statement(
                "The wheel accelerations by moving FRF, CDFM and SIM are highly consistent (Fig. 17).",
                f"Moving FRF and the other two differ by {number(wheels, 2)} at most (relative L2), CDFM and SIM "
                f"by {number(max(differences['CDFM − SIM']), 1)}. Two things make up the difference: truncating "
                f"the moving FRF at {TRUNCATION:g} Hz changes the wheels by {number(cut, 2)}, and CDFM's step of "
                f"1 ms by {number(coarse, 2)}, both against the closed form up to 500 Hz.",
                verdict(wheels < ONE_CURVE),
            )
        ],
        numbers={
            "wheel_acceleration_difference": wheels,
            "truncation_at_70_hz": cut,
            "cdfm_step_of_1_ms": coarse,
            "cdfm_against_sim": max(differences["CDFM − SIM"]),
            "closed_form_against_cdfm": max(differences["closed form − CDFM"][2:]),
        },
        computed=["Accelerations of bounce, pitch and both wheels, about steady travel."],
        substitutes=[SUBSTITUTE, VEHICLE, ROUGHNESS],
        plots=[
            Plot(
                "figure_16",
                "Spectra of the vehicle's accelerations",
                "Amplitude densities of the accelerations of all four degrees of freedom, by moving FRF.",
                spectrum,
            ),
            Plot(
                "figure_17",
                "Accelerations of the wheels",
                "Both wheels by moving FRF, CDFM and SIM: the whole journey, and a quarter of a second of it.",
                histories,
            ),
        ],
        tables=[
            DataTable(
                "figure_17",
                "Relative L2 differences of accelerations.",
                "pair",
                [Column(name, "") for name in names],
                [(name, values) for name, values in differences.items()],
            )
        ],
    )


def times(study: Study) -> Outcome:
    """Compare the times of all methods, and their errors against a converged answer."""
    compared = study.compared
    by_name = {row.method: row for row in compared.rows}
    plain = by_name["moving-frf-fe-plain"]
    seconds = {name: row.setup_s + row.solve_s for name, row in by_name.items()}
    columns = [
        Column("set-up", "s"),
        Column("solving", "s"),
        Column("peak memory", "MiB"),
        *(Column(f"error in {name.replace('_', ' ')}", "") for name in compared.reference.quantities),
        Column("the paper's time", "s"),
        Column("its time over moving FRF", ""),
        Column("time over moving FRF (closed form)", ""),
    ]
    stated = {**STATED, "moving-frf-fe-plain": STATED["moving-frf"]}
    del stated["moving-frf"]
    rows = [
        (
            NAMES[name],
            [
                row.setup_s,
                row.solve_s,
                row.peak_bytes / 2**20 if row.peak_bytes else math.nan,
                *row.relative_l2.values(),
                stated.get(name, math.nan),
                stated.get(name, math.nan) / STATED["moving-frf"],
                seconds[name] / seconds["moving-frf"],
            ],
        )
        for name, row in by_name.items()
    ]
    tables = [
        DataTable(
            "table_last",
            "Times (medians, one thread, set-up apart) at the step of 1 ms, errors against the converged answer "
            "(relative L2, the worst channel), and the times that the paper gives for its own computer.",
            "method",
            columns,
            rows,
        )
    ]
    numbers = {
        "cdfm_over_moving_frf": seconds["cdfm"] / seconds["moving-frf"],
        "sim_over_moving_frf": seconds["sim"] / seconds["moving-frf"],
        "moving_frf_s": seconds["moving-frf"],
        "moving_frf_contact_force_error": by_name["moving-frf"].relative_l2["contact_force"],
        "cdfm_contact_force_error": by_name["cdfm"].relative_l2["contact_force"],
        "converged_answer_moves": max(compared.reference.movement.values()),
    }
    words = ""
    equal: dict[float, dict[str, float]] = {}
    plots_made = []
    if compared.curve:
        equal = {target: ratios(compared, target) for target in EQUAL}
        numbers |= {
            f"{name.replace('-', '_')}_over_moving_frf_at_{target:g}": equal[target][name]
            for target in EQUAL
            for name in ("cdfm", "cdfm-window", "cdfm-weight", "sim", "duhamel", "moving-frf-fe")
        }
        words = " At equal error in contact force, set-up included: " + "; ".join(
            f"{number(target, 1)}, CDFM {times_over(found['cdfm'])}, SIM {times_over(found['sim'])}"
            for target, found in equal.items()
        )
        words += "."
        tables.append(
            DataTable(
                "ratios_at_equal_error",
                "Time over that of the moving FRF in closed form, at equal error in contact force, set-up "
                "included, over all steps and elements that were tried.",
                "method",
                [Column(f"at {number(target, 1)}", "") for target in EQUAL],
                [(NAMES[name], [equal[target][name] for target in EQUAL]) for name in by_name],
            )
        )
        plots_made.append(
            Plot(
                "error_over_time",
                "Error over time",
                "Error in contact force over time, set-up included, each point one run; lines join runs with one "
                "length of elements. Left and down is better; times at equal error are read at the dotted lines.",
                _error_over_time(study),
            )
        )
    naive = _dense_step(study)
    samples = scenario("truck").journey.samples
    numbers["dense_solve_s"] = naive
    numbers["dense_journey_over_moving_frf"] = naive * samples / seconds["moving-frf"]
    orders = equal.get(1e-3, {}).get("cdfm", numbers["cdfm_over_moving_frf"])
    return Outcome(
        statements=[
            Statement(
                "The main computation takes 1610 s by CDFM, 686 s by SIM and 5.9 s by moving FRF: ratios 273 and "
                "116.",
                f"Here, on one machine and in their best form, CDFM takes {number(seconds['cdfm'], 2)} s, SIM "
                f"{number(seconds['sim'], 2)} s, and the moving FRF {number(1e3 * seconds['moving-frf'], 2)} ms in "
                f"closed form ({number(numbers['cdfm_over_moving_frf'], 2)} and "
                f"{number(numbers['sim_over_moving_frf'], 2)} times) or {number(1e3 * plain.solve_s, 2)} ms after "
                f"{number(1e3 * plain.setup_s, 2)} ms of striking 40 m.{words}",
                verdict(orders >= 100, orders >= 3),
            )
        ],
        numbers=numbers,
        computed=[
            f"The moving FRF is kept up to {compared.scenario.journey.truncation:g} Hz here, since 70 Hz leave "
            "more than some of the errors at which times are compared (item 5).",
            "Each method in its best honest form: matrices factorised once, bands, compiled steps where numba is "
            "installed, one thread. The converged answer is CDFM on a road that travels along, refined in mesh and "
            f"step and extrapolated until it moves by {number(numbers['converged_answer_moves'], 1)}.",
            "Where the paper's ratios may come from: 1610 s for 24,000 steps are 67 ms a step. One dense system "
            f"of as many unknowns as 240 m in elements of 0.5 m have takes {number(1e3 * naive, 2)} ms here; "
            f"solving it in every step would take {number(naive * samples / seconds['moving-frf'], 2)} times as "
            "long as the moving FRF. Bands and a constant factorisation, which nothing forbids CDFM, take most "
            "of that away.",
            *(["Quick: two seconds of the journey, and no range of steps."] if study.quick else []),
        ],
        substitutes=[SUBSTITUTE, VEHICLE, ROUGHNESS],
        plots=plots_made,
        tables=tables,
    )


def times_over(ratio: float) -> str:
    """Write how many times as long something takes."""
    return "not reached" if math.isnan(ratio) else f"{number(ratio, 2)} times"


def _dense_step(study: Study) -> float:
    """Time to solve one dense system as large as vehicle and 240 m of road in elements of half a metre [s]."""
    journey = scenario("truck").journey
    unknowns = round(2 * journey.speed * journey.duration / 0.5) + 4
    matrix = np.eye(unknowns) + 1e-3 * np.random.default_rng(0).standard_normal((unknowns, unknowns))
    taken = []
    with threadpool_limits(limits=1):
        for _ in range(3):
            began = perf_counter()
            np.linalg.solve(matrix, np.ones(unknowns))
            taken.append(perf_counter() - began)
    return min(taken)


def _error_over_time(study: Study) -> Figure:
    compared = study.compared
    figure, (ax,) = canvas(1, 1, 3.4)
    for target in EQUAL:
        ax.axhline(target, color=plots.GREY, linestyle=":", linewidth=0.8)
    lines: dict[tuple[str, float], list[tuple[float, float]]] = {}
    for point in compared.curve:
        key = (point.method, -1.0 if math.isnan(point.element) else point.element)
        lines.setdefault(key, []).append((point.seconds, point.relative_l2["contact_force"]))
    colours = {name: plots.PALETTE[n % len(plots.PALETTE)] for n, name in enumerate(NAMES)}
    markers = dict(zip(NAMES, "osD^vPX*", strict=True))
    named: set[str] = set()
    for (name, element), points in lines.items():
        finest = element == min(e for n, e in lines if n == name)
        style = Line(colours[name], "-" if finest else (0, (4, 2)))
        ax.plot(
            *np.array(points).T,
            **style._asdict(),
            marker=markers[name],
            markersize=3.5,
            label=NAMES[name] if name not in named else None,
        )
        named.add(name)
    ax.set(
        xscale="log", yscale="log", xlabel="time, set-up included [s]", ylabel="relative L2 error of contact force"
    )
    ax.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure

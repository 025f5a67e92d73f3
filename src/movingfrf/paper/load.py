"""Items 3 to 6: the road under one moving load."""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from threadpoolctl import threadpool_limits

from movingfrf._checks import FloatArray
from movingfrf.comparison import converged
from movingfrf.guideways.base import Guideway
from movingfrf.page import Column
from movingfrf.paper import operations
from movingfrf.paper.drawing import BLACK, BLUE, ORANGE, PINK, SKY, amplitude_spectrum, canvas, curve, title
from movingfrf.paper.outcome import DataTable, Outcome, Plot, Statement, verdict
from movingfrf.paper.road import SUBSTITUTE
from movingfrf.paper.study import (
    FALLING,
    TRUNCATION,
    Study,
    quiet,
    relative,
    scenario,
    timed,
)
from movingfrf.reference.duhamel import duhamel_loads
from movingfrf.reference.finite_guideway import FiniteGuideway
from movingfrf.reference.impulse import struck_track
from movingfrf.reference.moving_load import newmark_loads
from movingfrf.simulation import moving_loads
from movingfrf.spectral import SpectralGrid
from movingfrf.wording import number

if TYPE_CHECKING:
    import xarray as xr

LOAD = (
    "The load's history is a figure of the paper. Substitute: a constant of 100 kN with a seeded sum of 60 "
    "harmonics below 60 Hz (10 kN root mean square), switched on over 0.2 s at the start and off over 0.2 s "
    "before 9 s."
)

# The error that the paper states beyond its truncation; a deviation wider than a line, over the range drawn;
# the agreement of two curves that are called one, and of two that are called close.
STATED, LINE_WIDTH, ONE_CURVE, CLOSE = 1e-4, 5e-3, 1e-2, 0.2

# Steps of Newmark's method with full matrices that are timed.
FEW = 200

# Highest truncation that is tried [Hz].
HIGHEST = 400.0

# Share of the record at its end over which a history is faded out before it is cut in frequency.
FADED = 0.05


def response(study: Study) -> Outcome:
    """History and spectra of load and response; moving FRF against Newmark's method."""
    found, exact, stepped = study.under_load(study.struck), study.under_load(study.road), study.by_newmark
    time, force = found.time.values, study.force[:, 0]
    ours, theirs = found.deflection.values[:, 0], stepped.deflection.values[:, 0]
    truth = exact.deflection.values
    apart = relative(ours[:, None], theirs[:, None])
    found_error, stepped_error = (relative(result.deflection.values, truth) for result in (found, stepped))

    loaded, (load_axis,) = canvas(1, 1, 1.9)
    curve(load_axis, time, 1e-3 * force, BLUE)
    load_axis.set(xlabel="time [s]", ylabel="load [kN]", xlim=(0, 10))
    spectra, (left, right) = canvas(1, 2, 2.3)
    for ax, values, scale, name in ((left, force, 1e-3, "load [kN s]"), (right, ours, 1e3, "deflection [mm s]")):
        frequency, size = amplitude_spectrum(values, 1e-3)
        drawn = (frequency > 0) & (frequency <= 100)
        curve(ax, frequency[drawn], scale * size[drawn], BLUE)
        ax.set(xlabel="frequency [Hz]", ylabel=f"spectrum of the {name}", xlim=(0, 100), yscale="log")
        ax.set_ylim(1e-5 * scale * size.max(), 2 * scale * size.max())
    histories, (whole, part, difference) = canvas(3, 1, 4.6, height_ratios=(3, 3, 2))
    for ax, interval in ((whole, (0.0, 10.0)), (part, (4.0, 4.5))):
        some = (time >= interval[0]) & (time <= interval[1])
        curve(ax, time[some], 1e3 * theirs[some], BLACK, "Newmark's method, 120 m")
        curve(ax, time[some], 1e3 * ours[some], ORANGE, "moving FRF")
        ax.set(ylabel="deflection [mm]", xlim=interval)
    whole.legend(loc="lower center", ncols=2)
    curve(difference, time, 1e6 * (ours - theirs), BLUE)
    difference.set(xlabel="time [s]", ylabel="difference [µm]", xlim=(0, 10))
    return Outcome(
        statements=[
            Statement(
                "The response by the moving FRF is verified by Newmark's method on a road of 120 m and 240 "
                "elements (Fig. 9).",
                f"They differ by {number(apart, 2)} (relative L2). Of the closed form, Newmark's method is off by "
                f"{number(stepped_error, 2)} (its elements of 0.5 m and steps of 1 ms), the moving FRF "
                f"of 40 m by {number(found_error, 2)}.",
                verdict(apart < ONE_CURVE),
            )
        ],
        numbers={
            "moving_frf_against_newmark": apart,
            "moving_frf_error": found_error,
            "newmark_error": stepped_error,
        },
        computed=[
            "Load and observer travel together at 10 m/s for 10 s in steps of 1 ms. Moving FRF from 40 m of "
            "finite elements as in the paper; Newmark's method (average acceleration) on "
            f"{study.newmark_road.dofs} unknowns, simply supported, the load starting 10 m from the end. Nothing "
            "is truncated here.",
        ],
        substitutes=[SUBSTITUTE, LOAD],
        plots=[
            Plot("figure_07", "Load history", "The load that travels along the road.", loaded),
            Plot(
                "figure_08",
                "Spectra of load and response",
                "Magnitude of the Fourier transforms of (a) the load, (b) the deflection under it.",
                spectra,
            ),
            Plot(
                "figure_09",
                "Response of the road",
                "Deflection under the load by moving FRF and by Newmark's method: (a) the whole record, (b) half a "
                "second of it, (c) their difference.",
                histories,
            ),
        ],
    )


def truncated(study: Study) -> Outcome:
    """Responses for truncations at 17 and 70 Hz against the full one."""
    full = study.under_load(study.struck)
    time, whole = full.time.values, full.deflection.values
    cut = {at: study.under_load(study.struck, truncation=at).deflection.values for at in (FALLING, TRUNCATION)}
    error = {at: relative(values, whole) for at, values in cut.items()}
    widest = {at: float(np.abs(values - whole).max() / np.ptp(whole)) for at, values in cut.items()}

    figure, (above, below) = canvas(1, 2, 2.5, width_ratios=(2, 3))
    for ax, interval in ((above, (0.0, 10.0)), (below, (4.0, 4.4))):
        some = (time >= interval[0]) & (time <= interval[1])
        curve(ax, time[some], 1e3 * whole[some, 0], BLACK, "full")
        curve(ax, time[some], 1e3 * cut[FALLING][some, 0], ORANGE, f"{FALLING:g} Hz")
        curve(ax, time[some], 1e3 * cut[TRUNCATION][some, 0], SKY, f"{TRUNCATION:g} Hz")
        ax.set(xlabel="time [s]", ylabel="deflection [mm]", xlim=interval)
    below.legend(ncols=3, loc="upper center", bbox_to_anchor=(0.5, 1.14))
    return Outcome(
        statements=[
            Statement(
                f"Truncated at {FALLING:g} Hz the response is close to the full one, with visible deviations.",
                f"Relative error {number(error[FALLING], 2)}; the largest deviation is "
                f"{number(100 * widest[FALLING], 2)} % of the range drawn.",
                verdict(widest[FALLING] > LINE_WIDTH and error[FALLING] < CLOSE),
            ),
            Statement(
                f"Truncated at {TRUNCATION:g} Hz it is indistinguishable.",
                f"Relative error {number(error[TRUNCATION], 2)}; the largest deviation is "
                f"{number(100 * widest[TRUNCATION], 2)} % of the range drawn, far less than the width of a line.",
                verdict(widest[TRUNCATION] < LINE_WIDTH),
            ),
        ],
        numbers={
            "error_at_17_hz": error[FALLING],
            "error_at_70_hz": error[TRUNCATION],
            "largest_deviation_at_17_hz_over_range": widest[FALLING],
            "largest_deviation_at_70_hz_over_range": widest[TRUNCATION],
        },
        computed=["Moving FRF from 40 m of finite elements; frequencies beyond the truncation are left out."],
        substitutes=[SUBSTITUTE, LOAD],
        plots=[
            Plot(
                "figure_10",
                "Responses for two truncations",
                "Deflection under the load, truncated at 17 and at 70 Hz: (a) the whole record, (b) part of it.",
                figure,
            )
        ],
    )


def truncation_error(study: Study) -> Outcome:
    """Relative error over the truncation: of the road under the load, and of the coupled contact force."""
    cuts = np.unique(np.r_[np.geomspace(5.0, HIGHEST, 16 if study.quick else 60), FALLING, TRUNCATION])
    sources: dict[str, tuple[str, Guideway]] = {
        "smooth load, 40 m of elements": ("load", study.struck),
        "smooth load, closed form": ("load", study.road),
        "abrupt load, 40 m of elements": ("load_abrupt", study.struck),
        "abrupt load, closed form": ("load_abrupt", study.road),
    }
    errors: dict[str, FloatArray] = {}
    for n, (name, (load, guideway)) in enumerate(sources.items()):
        whole = study.under_load(guideway, load).deflection.values
        errors[name] = np.array(
            [relative(study.under_load(guideway, load, float(cut)).deflection.values, whole) for cut in cuts]
        )
        study.told("truncation of the road's response", n + 1, len(sources))
    enough = {name: _enough(cuts, values) for name, values in errors.items()}

    full = study.driven(study.road, truncation=0.5 / scenario("truck").journey.time_step)
    rigid, without = [], []
    for n, cut in enumerate(cuts):
        found = study.driven(study.road, truncation=float(cut))
        rigid.append(relative(found.contact_force.values, full.contact_force.values))
        without.append(_left_out(full, float(cut)))
        study.told("truncation of the coupled response", n + 1, cuts.size)
    coupled = {"road rigid beyond the cut": np.array(rigid), "everything cut": np.array(without)}
    at_70 = {name: float(values[cuts == TRUNCATION][0]) for name, values in {**errors, **coupled}.items()}
    needed = _enough(cuts, coupled["road rigid beyond the cut"])
    factor = at_70["everything cut"] / at_70["road rigid beyond the cut"]
    smooth, abrupt = at_70["smooth load, closed form"], at_70["abrupt load, closed form"]

    curves = {**errors, **coupled}
    columns = [Column(name, "") for name in curves]
    rows = [(f"{cut:.4g}", [float(values[n]) for values in curves.values()]) for n, cut in enumerate(cuts)]

    figure, (left, right) = canvas(1, 2, 2.9, sharey=True)
    for (name, values), line in zip(errors.items(), (ORANGE, BLACK, SKY, BLUE), strict=True):
        curve(left, cuts, values, line, name)
    for (name, values), line in zip(coupled.items(), (BLUE, PINK), strict=True):
        curve(right, cuts, values, line, name)
    for ax in (left, right):
        ax.axhline(STATED, color="#6b6b6b", linewidth=0.8, linestyle=":")
        ax.axvline(TRUNCATION, color="#6b6b6b", linewidth=0.8, linestyle=":")
        ax.set(xlabel="truncation [Hz]", yscale="log", ylim=(1e-9, 2), xlim=(0, 200))
        ax.legend()
    left.set_ylabel("relative error (L2)")
    title(left, "deflection under the moving load")
    title(right, "contact force of the vehicle")
    return Outcome(
        statements=[
            Statement(
                "The relative error of the road's response decreases with the truncation, and falls below 10⁻⁴ "
                f"above {TRUNCATION:g} Hz (Fig. 11).",
                f"With a load that sets in smoothly: {number(smooth, 2)} in closed form and "
                f"{number(at_70['smooth load, 40 m of elements'], 2)} from 40 m of finite elements at "
                f"{TRUNCATION:g} Hz; 10⁻⁴ is reached at {number(enough['smooth load, closed form'], 3)} and "
                f"{number(enough['smooth load, 40 m of elements'], 3)} Hz. With a load that is switched abruptly "
                f"{number(abrupt, 2)} and {number(at_70['abrupt load, 40 m of elements'], 2)}, and 10⁻⁴ only at "
                f"{number(enough['abrupt load, closed form'], 3)} and "
                f"{number(enough['abrupt load, 40 m of elements'], 3)} Hz.",
                verdict(smooth < STATED and abrupt < STATED, smooth < STATED),
            ),
            Statement(
                "Therefore 0 to 70 Hz is used for the vehicle on the road as well.",
                f"In contact force over the whole class A spectrum, a road that counts as rigid beyond "
                f"{TRUNCATION:g} Hz leaves {number(at_70['road rigid beyond the cut'], 2)}; 10⁻⁴ is reached at "
                f"{number(needed, 3)} Hz. Cutting the response itself there leaves "
                f"{number(at_70['everything cut'], 2)}, {number(factor, 2)} times as much: through a tyre with a "
                "dashpot the force does not decay with frequency.",
                verdict(at_70["road rigid beyond the cut"] < STATED, at_70["road rigid beyond the cut"] < 1e-3),
            ),
        ],
        numbers={
            "smooth_load_error_at_70_hz": smooth,
            "smooth_load_struck_error_at_70_hz": at_70["smooth load, 40 m of elements"],
            "abrupt_load_error_at_70_hz": abrupt,
            "abrupt_load_struck_error_at_70_hz": at_70["abrupt load, 40 m of elements"],
            **{f"enough_hz_{name.replace(', ', '_').replace(' ', '_')}": value for name, value in enough.items()},
            "contact_force_rigid_error_at_70_hz": at_70["road rigid beyond the cut"],
            "contact_force_cut_error_at_70_hz": at_70["everything cut"],
            "cut_over_rigid_at_70_hz": factor,
            "enough_hz_contact_force": needed,
        },
        computed=[
            "Error: relative L2 norm of the difference from the response with all frequencies up to 500 Hz, each "
            "road against itself. Where the response itself is cut, the history of the contact force has its "
            "higher frequencies taken out; its last twentieth is faded out first, so that the end of the record "
            "does not count.",
        ],
        substitutes=[SUBSTITUTE, LOAD, "The half truck and the roughness of items 7 to 10, in (b)."],
        plots=[
            Plot(
                "figure_11",
                "Error over the truncation",
                "(a) Deflection under a load that sets in smoothly or abruptly; (b) contact force of the half "
                "truck, if the road counts as rigid beyond the cut, and if the response is cut. Dotted: the "
                "paper's 70 Hz and 10⁻⁴.",
                figure,
            )
        ],
        tables=[
            DataTable(
                "figure_11", "Relative error over all truncations.", "truncation [Hz]", columns, rows, on_page=False
            ),
            DataTable(
                "truncations",
                "Relative error for some truncations.",
                "truncation [Hz]",
                columns,
                [row for n, row in enumerate(rows) if cuts[n] in (FALLING, TRUNCATION) or n % 10 == 0],
            ),
        ],
    )


def _enough(cuts: FloatArray, error: FloatArray) -> float:
    """Read from a curve from where on an error is below the stated one [Hz]; nan: nowhere."""
    above = np.flatnonzero(error > STATED)
    last = int(above[-1]) if above.size else 0
    if last + 1 >= cuts.size:
        return float("nan")
    share = np.log(error[last] / STATED) / np.log(error[last] / error[last + 1])
    return float(cuts[last] * (cuts[last + 1] / cuts[last]) ** share)


def _left_out(full: xr.Dataset, cut: float) -> float:
    """Share of the contact force beyond a frequency."""
    force = full.contact_force.values
    step = full.attrs["time_step"]
    count = int(FADED * len(force))
    force = force.copy()
    force[-count:] *= (0.5 * (1 + np.cos(np.pi * np.arange(1, count + 1) / count)))[:, None]
    spectrum = np.fft.rfft(force, 2 * len(force), axis=0)
    beyond = np.fft.rfftfreq(2 * len(force), step) > cut
    return float((np.linalg.norm(spectrum[beyond], axis=0) / np.linalg.norm(spectrum, axis=0)).max())


def costs(study: Study) -> Outcome:
    """Table 1: multiplications and times of three methods, and their errors."""
    case = scenario("load")
    step, speed, samples = case.journey.time_step, case.journey.speed, case.journey.samples
    struck, road, forces = study.struck, study.newmark_road, study.force
    grid = SpectralGrid(samples=samples, time_step=step, truncation=TRUNCATION, settling=samples * step)
    kept_ones = slice(grid.kept)
    frf = struck.moving_frf([0.0], speed, grid.omega(kept_ones)) * grid.compliance(kept_ones)[:, None]

    def product() -> FloatArray:
        return grid.to_histories(frf * grid.to_spectra(forces)[: grid.kept]).values

    ways: dict[str, Callable[[], object]] = {
        "Newmark": lambda: newmark_loads(road, forces, [0.0], speed=speed, time_step=step).deflection.values,
        "Duhamel": lambda: duhamel_loads(struck, forces, [0.0], speed=speed, time_step=step).deflection.values,
        "moving FRF": product,
        "moving FRF, closed form": lambda: (
            moving_loads(
                study.road, forces, [0.0], speed=speed, time_step=step, truncation=TRUNCATION
            ).deflection.values
        ),
        "striking 40 m": lambda: struck_track(study.road, speed=speed, offsets=[0.0], plain=True),
    }
    study.told("times of three methods", 0, 1)
    with quiet():
        seconds = timed(ways)
        wanted = converged(case, study.progress).quantities["deflection"]
        errors = {name: relative(way(), wanted) for name, way in ways.items() if name != "striking 40 m"}  # type: ignore[arg-type]
    full_seconds, full_apart = _with_full_matrices(road, forces, speed, step)
    memory = _memory(struck.samples[:, 0])
    n = road.dofs
    counts = {
        "Newmark, full matrices": operations.newmark_full(n, samples),
        "Newmark": operations.newmark_banded(n, samples),
        "Duhamel": operations.duhamel(samples, memory),
        "moving FRF": operations.moving_frf(round(TRUNCATION * samples * step) + 1),
    }
    kept = operations.moving_frf(grid.kept)
    transforms = 2 * operations.real_fft(grid.padded)
    setup = seconds["striking 40 m"]
    nan = float("nan")
    rows = [
        ("Newmark, full matrices", [counts["Newmark, full matrices"], full_seconds, nan, errors["Newmark"]]),
        ("Newmark, bands", [counts["Newmark"], seconds["Newmark"], nan, errors["Newmark"]]),
        ("Duhamel's integral", [counts["Duhamel"], seconds["Duhamel"], setup, errors["Duhamel"]]),
        ("moving FRF, product alone (the paper's count)", [counts["moving FRF"], nan, nan, nan]),
        (
            "moving FRF with its transforms, padded",
            [kept + transforms, seconds["moving FRF"], setup, errors["moving FRF"]],
        ),
        (
            "moving FRF in closed form, all included",
            [nan, seconds["moving FRF, closed form"], nan, errors["moving FRF, closed form"]],
        ),
    ]
    return Outcome(
        statements=[
            Statement(
                "Table 1: the moving FRF takes the fewest multiplications and the least time.",
                f"Multiplications: Newmark {number(counts['Newmark, full matrices'], 3)} with full matrices and "
                f"{number(counts['Newmark'], 3)} with bands, Duhamel {number(counts['Duhamel'], 3)}, moving FRF "
                f"{number(counts['moving FRF'], 4)} for the product and {number(kept + transforms, 3)} with "
                f"padding and transforms, which the paper does not count. Times: {number(1e3 * full_seconds, 3)}, "
                f"{number(1e3 * seconds['Newmark'], 3)}, {number(1e3 * seconds['Duhamel'], 3)} and "
                f"{number(1e3 * seconds['moving FRF'], 3)} ms.",
                verdict(
                    counts["moving FRF"] + transforms < counts["Duhamel"] < counts["Newmark"]
                    and seconds["moving FRF"] < min(seconds["Newmark"], seconds["Duhamel"], full_seconds),
                    counts["moving FRF"] + transforms < counts["Duhamel"],
                ),
            )
        ],
        numbers={
            "newmark_full_multiplications": counts["Newmark, full matrices"],
            "newmark_banded_multiplications": counts["Newmark"],
            "duhamel_multiplications": counts["Duhamel"],
            "moving_frf_multiplications": counts["moving FRF"],
            "moving_frf_with_transforms_multiplications": kept + transforms,
            "newmark_full_s": full_seconds,
            "newmark_banded_s": seconds["Newmark"],
            "duhamel_s": seconds["Duhamel"],
            "moving_frf_s": seconds["moving FRF"],
            "newmark_error": errors["Newmark"],
            "duhamel_error": errors["Duhamel"],
            "moving_frf_error": errors["moving FRF"],
        },
        computed=[
            f"Multiplications, n = {n} unknowns, N = {samples} steps. Newmark with full matrices, factorised "
            "once: N (3 n² + 11 n + 17). With bands, as this package steps: N (31 n + 37). Duhamel: m N − m (m − "
            f"1)/2 with m = {memory} samples until the impulse response has faded to a thousandth of its largest "
            f"value. Moving FRF: 4 for each of the f T + 1 = {round(TRUNCATION * samples * step) + 1} frequencies "
            f"up to {TRUNCATION:g} Hz; padded for the response to die away, {grid.kept} of them, and two "
            f"transforms of {grid.padded} points. A division counts as a multiplication; what is prepared once "
            "does not count. tests/paper/test_operations.py counts the multiplications of small instrumented "
            "runs.",
            "Times: medians, in turns, one thread, steps compiled where numba is installed. Newmark with full "
            f"matrices is timed over {FEW} steps, in which it differs from bands by {number(full_apart, 1)}. "
            "Set-up: striking 40 m. Errors (relative L2): against Newmark's method on a road that travels along, "
            "refined until it no longer moves.",
            f"Bands alone make Newmark's method {number(counts['Newmark, full matrices'] / counts['Newmark'], 2)} "
            "times cheaper than the full matrices of a textbook.",
        ],
        substitutes=[SUBSTITUTE, LOAD, "The paper's own figures in Table 1 are not in its text."],
        tables=[
            DataTable(
                "table_1",
                "Multiplications, times and errors for 10 s of one moving load.",
                "method",
                [
                    Column("multiplications", ""),
                    Column("time", "s"),
                    Column("set-up", "s"),
                    Column("relative L2 error", ""),
                ],
                rows,
            )
        ],
    )


def _memory(response: FloatArray) -> int:
    """Count the samples until an impulse response stays below a thousandth of its largest value."""
    size = np.abs(response)
    return int(np.flatnonzero(size > 1e-3 * size.max())[-1]) + 1


def _with_full_matrices(road: FiniteGuideway, forces: FloatArray, speed: float, step: float) -> tuple[float, float]:
    """Step as in a textbook: time of the whole record [s], and difference from bands in the first steps."""
    mass, damping, stiffness = (matrix.toarray() for matrix in (road.mass, road.damping, road.stiffness))
    a0, a1, a2 = 4 / step**2, 2 / step, 4 / step
    rows = road.rows(speed * step * np.arange(FEW)).toarray()
    deflection = np.zeros((FEW, 1))
    u, v = np.zeros((2, road.dofs))
    a = np.linalg.solve(mass, rows[0] * forces[0])
    with threadpool_limits(limits=1):
        factor = cho_factor(stiffness + a0 * mass + a1 * damping)
        began = perf_counter()
        for n in range(1, FEW):
            right = rows[n] * forces[n] + mass @ (a0 * u + a2 * v + a) + damping @ (a1 * u + v)
            new = cho_solve(factor, right)
            acceleration = a0 * (new - u) - a2 * v - a
            v = v + 0.5 * step * (a + acceleration)
            u, a = new, acceleration
            deflection[n] = rows[n] @ u
        seconds = perf_counter() - began
    stepped = newmark_loads(road, forces[:FEW], [0.0], speed=speed, time_step=step).deflection.values
    return seconds * len(forces) / FEW, relative(deflection, stepped)

"""Items 3 to 6: the road under one moving load."""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from threadpoolctl import threadpool_limits

from movingfrf._basics.arrays import ComplexArray, FloatArray
from movingfrf._basics.wording import number
from movingfrf.guideways.guideway import Guideway
from movingfrf.reports.curves import GREY
from movingfrf.reports.tables import Column
from movingfrf.response.line import Line
from movingfrf.response.truncation import Truncation
from movingfrf.stepping.duhamel import duhamel_loads
from movingfrf.stepping.finite_guideway import FiniteGuideway
from movingfrf.stepping.finite_track import finite_track
from movingfrf.stepping.impulse import struck_track
from movingfrf.stepping.moving_loads import newmark_loads
from movingfrf.studies.comparison.convergence import converged
from movingfrf.studies.paper import operations
from movingfrf.studies.paper.drawing import (
    STROKES,
    amplitude_spectrum,
    canvas,
    curve,
    legend_outside,
    logarithmic,
    title,
)
from movingfrf.studies.paper.outcome import AGREEMENT, DataTable, Outcome, Plot, Statement, verdict
from movingfrf.studies.paper.stated import STATED, SUBSTITUTES
from movingfrf.studies.paper.study import Study, quiet, relative, scenario, timed

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure


# A response [m] with frequencies up to a cut [Hz].
Sharp = Callable[[float], FloatArray]


def response(study: Study) -> Outcome:
    """History and spectra of load and response; moving FRF against Newmark's method."""
    found, stepped = study.under_load(study.struck), study.by_newmark
    truth = study.under_load(study.guideway).deflection.values
    apart = relative(found.deflection.values, stepped.deflection.values)
    found_error, stepped_error = (relative(result.deflection.values, truth) for result in (found, stepped))
    journey = scenario("load").journey
    endless = finite_track(study.guideway, first=-60.0, last=160.0, element=STATED.newmark_element)
    without_ends = relative(
        newmark_loads(
            endless, study.force, [0.0], speed=journey.speed, time_step=journey.time_step
        ).deflection.values,
        truth,
    )
    loaded, spectra, histories = _figures_7_to_9(study, found, stepped)
    return Outcome(
        statements=[
            Statement(
                '"In order to verify the accuracy of the road response obtained using the moving FRF", it is '
                "compared "
                "with Newmark's method on a road of 120 m and 240 elements (Fig. 9); (implied) they agree.",
                f"They differ by {number(apart, 2)} (relative L2). From the closed form Newmark's method is off "
                f"by {number(stepped_error, 2)}, of which {number(without_ends, 2)} comes from its elements of "
                "0.5 m and steps of 1 ms (on a road without ends) and the rest from the pinned end behind the "
                f"load's start; the moving FRF of 40 m is off by {number(found_error, 2)}.",
                verdict(apart < AGREEMENT.one_curve),
                "holds below 1 %",
            )
        ],
        numbers={
            "moving_frf_against_newmark": apart,
            "moving_frf_error": found_error,
            "newmark_error": stepped_error,
            "newmark_error_without_ends": without_ends,
        },
        computed=[
            f"Load and observer travel together at {journey.speed:g} m/s for {journey.duration:g} s in steps of "
            f"{1e3 * journey.time_step:g} ms. Moving FRF from 40 m of finite elements as in the paper; Newmark's "
            f"method (average acceleration) on {study.finite.dofs} unknowns, simply supported, the load "
            f"starting {SUBSTITUTES.newmark_start:g} m from the end. Nothing is truncated here.",
        ],
        substitutes=[SUBSTITUTES.road, SUBSTITUTES.load],
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
                "second of it, (c) their difference, largest where the load has just left the pinned end.",
                histories,
            ),
        ],
    )


def _figures_7_to_9(study: Study, found: xr.Dataset, stepped: xr.Dataset) -> tuple[Figure, Figure, Figure]:
    time, force = found.time.values, study.force[:, 0]
    ours, theirs = found.deflection.values[:, 0], stepped.deflection.values[:, 0]
    loaded, (load_axis,) = canvas(1, 1, 1.9)
    curve(load_axis, time, 1e-3 * force, STROKES.blue)
    load_axis.set(xlabel="time [s]", ylabel="load [kN]", xlim=(0, 10))
    spectra, pair = canvas(1, 2, 2.3)
    for ax, values, scale, name in zip(
        pair, (force, ours), (1e-3, 1e3), ("load [kN s]", "deflection [mm s]"), strict=True
    ):
        frequency, size = amplitude_spectrum(values, found.attrs["time_step"])
        drawn = (frequency > 0) & (frequency <= 100)
        curve(ax, frequency[drawn], scale * size[drawn], STROKES.blue)
        ax.set(xlabel="frequency [Hz]", ylabel=f"spectrum of the {name}", xlim=(0, 100))
        logarithmic(ax)
        ax.set_ylim(1e-5 * scale * size.max(), 2 * scale * size.max())
    histories, (whole, part, difference) = canvas(3, 1, 4.6, height_ratios=(3, 3, 2))
    for ax, interval in ((whole, (0.0, 10.0)), (part, (4.0, 4.5))):
        some = (time >= interval[0]) & (time <= interval[1])
        curve(ax, time[some], 1e3 * theirs[some], STROKES.black, "Newmark's method, 120 m")
        curve(ax, time[some], 1e3 * ours[some], STROKES.orange, "moving FRF")
        ax.set(ylabel="deflection [mm]", xlim=interval)
    legend_outside(histories, whole)
    curve(difference, time, 1e6 * (ours - theirs), STROKES.blue)
    difference.set(xlabel="time [s]", ylabel="difference [µm]", xlim=(0, 10))
    return loaded, spectra, histories


def truncated(study: Study) -> Outcome:
    """Responses for truncations at 17 and 70 Hz against the full one."""
    full = study.under_load(study.struck)
    time, whole = full.time.values, full.deflection.values
    sharply = study.cut_sharply(study.struck)
    cut = {at: sharply(at) for at in (STATED.falling, STATED.truncation)}
    error = {at: relative(values, whole) for at, values in cut.items()}
    widest = {at: float(np.abs(values - whole).max() / np.ptp(whole)) for at, values in cut.items()}

    figure, (above, below) = canvas(1, 2, 2.5, width_ratios=(2, 3))
    for ax, interval in ((above, (0.0, 10.0)), (below, (4.0, 4.4))):
        some = (time >= interval[0]) & (time <= interval[1])
        curve(ax, time[some], 1e3 * whole[some, 0], STROKES.black, "full")
        curve(ax, time[some], 1e3 * cut[STATED.falling][some, 0], STROKES.orange, f"{STATED.falling:g} Hz")
        curve(ax, time[some], 1e3 * cut[STATED.truncation][some, 0], STROKES.sky, f"{STATED.truncation:g} Hz")
        ax.set(xlabel="time [s]", ylabel="deflection [mm]", xlim=interval)
    legend_outside(figure, below)
    return Outcome(
        statements=[
            Statement(
                f'"When the truncation frequency is {STATED.falling:g} Hz, the calculated response is close to the '
                'theoretical solution, but its deviations are visible."',
                f"Relative error {number(error[STATED.falling], 2)}; the largest deviation is "
                f"{number(100 * widest[STATED.falling], 2)} % of the range drawn.",
                verdict(widest[STATED.falling] > AGREEMENT.line_width and error[STATED.falling] < AGREEMENT.close),
                "holds if deviations are wider than a line, 0.5 % of the range, and the error below 20 %",
            ),
            Statement(
                f'"When the truncation frequency is {STATED.truncation:g} Hz, the calculated response is '
                'indistinguishable from the theoretical solution."',
                f"Relative error {number(error[STATED.truncation], 2)}; the largest deviation is "
                f"{number(100 * widest[STATED.truncation], 2)} % of the range drawn, far less than the width of a "
                "line.",
                verdict(widest[STATED.truncation] < AGREEMENT.line_width),
                "holds if deviations are narrower than a line",
            ),
        ],
        numbers={
            "error_at_17_hz": error[STATED.falling],
            "error_at_70_hz": error[STATED.truncation],
            "largest_deviation_at_17_hz_over_range": widest[STATED.falling],
            "largest_deviation_at_70_hz_over_range": widest[STATED.truncation],
        },
        computed=[
            "Moving FRF from 40 m of finite elements; frequencies beyond the truncation are left out, sharply as "
            "in the paper."
        ],
        substitutes=[SUBSTITUTES.road, SUBSTITUTES.load],
        plots=[
            Plot(
                "figure_10",
                "Responses for two truncations",
                "Deflection under the load, truncated at 17 and at 70 Hz: (a) the whole record, (b) part of it.",
                figure,
            )
        ],
    )


def error_over_truncation(study: Study) -> Outcome:
    """Relative error over the truncation: of the road under the load, and of the coupled contact force."""
    cuts = np.unique(np.r_[np.geomspace(5.0, 400.0, 16 if study.quick else 60), STATED.falling, STATED.truncation])
    sources: dict[str, tuple[str, Guideway]] = {
        "smooth load, 40 m of elements": ("load", study.struck),
        "smooth load, closed form": ("load", study.guideway),
        "abrupt load, 40 m of elements": ("load_abrupt", study.struck),
        "abrupt load, closed form": ("load_abrupt", study.guideway),
    }
    errors: dict[str, FloatArray] = {}
    enough: dict[str, float] = {}
    for n, (name, (load, guideway)) in enumerate(sources.items()):
        cut_sharply, whole = study.cut_sharply(guideway, load), study.under_load(guideway, load).deflection.values

        def error(cut: float, cut_sharply: Sharp = cut_sharply, whole: FloatArray = whole) -> float:
            return relative(cut_sharply(cut), whole)

        errors[name] = np.array([error(float(cut)) for cut in cuts])
        enough[name] = _enough(cuts, errors[name], error)
        study.told("truncation of the road's response", n + 1, len(sources))

    full = study.driven(study.guideway, truncation=0.5 / scenario("truck").journey.time_step)

    def coupled_error(cut: float) -> float:
        return relative(
            study.driven(study.guideway, truncation=cut).contact_force.values, full.contact_force.values
        )

    rigid = []
    for n, cut in enumerate(cuts):
        rigid.append(coupled_error(float(cut)))
        study.told("truncation of the coupled response", n + 1, cuts.size)
    coupled = {
        "road rigid beyond the cut": np.array(rigid),
        "everything cut": np.array([_left_out(full, float(cut)) for cut in cuts]),
    }
    at_70 = {name: float(values[cuts == STATED.truncation][0]) for name, values in {**errors, **coupled}.items()}
    needed = _enough(cuts, coupled["road rigid beyond the cut"], coupled_error)
    factor = at_70["everything cut"] / at_70["road rigid beyond the cut"]
    smooth, abrupt = at_70["smooth load, closed form"], at_70["abrupt load, closed form"]
    curves = {**errors, **coupled}
    columns = [Column(name, "") for name in curves]
    rows = [(f"{cut:.4g}", [float(values[n]) for values in curves.values()]) for n, cut in enumerate(cuts)]

    return Outcome(
        statements=[
            Statement(
                '"The error decreases as the truncation frequency increases, and it falls below 10⁻⁴ for the '
                f'truncation frequencies above {STATED.truncation:g} Hz" (Fig. 11).',
                f"With a load below 60 Hz that sets in smoothly: {number(smooth, 2)} in closed form and "
                f"{number(at_70['smooth load, 40 m of elements'], 2)} from 40 m of finite elements at "
                f"{STATED.truncation:g} Hz; 10⁻⁴ is reached at {number(enough['smooth load, closed form'], 3)} and "
                f"{number(enough['smooth load, 40 m of elements'], 3)} Hz. With a load that is switched abruptly "
                f"{number(abrupt, 2)} and {number(at_70['abrupt load, 40 m of elements'], 2)}, and 10⁻⁴ only at "
                f"{number(enough['abrupt load, closed form'], 3)} and "
                f"{number(enough['abrupt load, 40 m of elements'], 3)} Hz.",
                verdict(
                    smooth < STATED.truncation_error and abrupt < STATED.truncation_error,
                    smooth < STATED.truncation_error,
                ),
                "holds for both loads; in part for the smooth one",
            ),
            Statement(
                f'"Therefore, the frequency range of 0–{STATED.truncation:g} Hz is used in the further numerical '
                'simulations", '
                "with the vehicle; (implied) that is as good.",
                f"In contact force over the whole class A spectrum, a road that counts as rigid beyond "
                f"{STATED.truncation:g} Hz leaves {number(at_70['road rigid beyond the cut'], 2)}; 10⁻⁴ is reached "
                f"at {number(needed, 3)} Hz. Cutting the response itself there leaves "
                f"{number(at_70['everything cut'], 2)}, {number(factor, 2)} times as much: through a tyre with a "
                "dashpot the force does not decay with frequency.",
                verdict(
                    at_70["road rigid beyond the cut"] < STATED.truncation_error,
                    at_70["road rigid beyond the cut"] < 1e-3,
                ),
                "holds below 10⁻⁴, in part below 10⁻³",
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
        substitutes=[
            SUBSTITUTES.road,
            SUBSTITUTES.load,
            "The half truck and the roughness of items 7 to 10, in (b).",
        ],
        plots=[
            Plot(
                "figure_11",
                "Error over the truncation",
                "(a) Deflection under a load that sets in smoothly or abruptly; (b) contact force of the half "
                "truck, if the road counts as rigid beyond the cut, and if the response is cut. Dotted: the "
                "paper's 70 Hz and 10⁻⁴.",
                _figure_11(cuts, errors, coupled),
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
                [
                    row
                    for n, row in enumerate(rows)
                    if cuts[n] in (STATED.falling, STATED.truncation) or n % 10 == 0
                ],
            ),
        ],
    )


def _figure_11(cuts: FloatArray, errors: dict[str, FloatArray], coupled: dict[str, FloatArray]) -> Figure:
    figure, (left, right) = canvas(1, 2, 2.9, sharey=True)
    for (name, values), line in zip(
        errors.items(), (STROKES.orange, STROKES.black, STROKES.sky, STROKES.blue), strict=True
    ):
        curve(left, cuts, values, line, name)
    for (name, values), line in zip(coupled.items(), (STROKES.blue, STROKES.pink), strict=True):
        curve(right, cuts, values, line, name)
    for ax in (left, right):
        ax.axhline(STATED.truncation_error, color=GREY, linewidth=0.8, linestyle=":")
        ax.axvline(STATED.truncation, color=GREY, linewidth=0.8, linestyle=":")
        ax.set(xlabel="truncation [Hz]", yscale="log", ylim=(1e-9, 2), xlim=(0, cuts[-1]))
        ax.legend()
    left.set_ylabel("relative error (L2)")
    title(left, "deflection under the moving load")
    title(right, "contact force of the vehicle")
    return figure


def _enough(cuts: FloatArray, values: FloatArray, error: Callable[[float], float]) -> float:
    """Find from where on an error is below the stated one, to half a per cent [Hz]; nan: not up to the last cut."""
    above = np.flatnonzero(values > STATED.truncation_error)
    if not above.size or above[-1] + 1 == cuts.size:
        return float("nan") if above.size else float(cuts[0])
    low, high = (float(cut) for cut in cuts[above[-1] : above[-1] + 2])
    while high > 1.005 * low:
        middle = (low * high) ** 0.5
        low, high = (middle, high) if error(middle) > STATED.truncation_error else (low, middle)
    return high


def _left_out(full: xr.Dataset, cut: float) -> float:
    """Share of the contact force beyond a frequency."""
    force = full.contact_force.values
    step = full.attrs["time_step"]
    # The end of the record fades out: it must not count.
    count = int(0.05 * len(force))
    force = force.copy()
    force[-count:] *= (0.5 * (1 + np.cos(np.pi * np.arange(1, count + 1) / count)))[:, None]
    spectrum = np.fft.rfft(force, 2 * len(force), axis=0)
    beyond = np.fft.rfftfreq(2 * len(force), step) > cut
    return float((np.linalg.norm(spectrum[beyond], axis=0) / np.linalg.norm(spectrum, axis=0)).max())


class Way(NamedTuple):
    """One way to the response: its multiplications, times once and for each record [s], and its error."""

    multiplications: float
    setup: float
    record: float
    error: float


def costs(study: Study) -> Outcome:
    """Table 1: multiplications and times of three methods, and their errors."""
    case = scenario("load")
    step, samples = case.journey.time_step, case.journey.samples
    line = Line(samples=samples, time_step=step)
    kept = Truncation(frequency=STATED.truncation).reach(line.omega())
    unpadded, memory = round(STATED.truncation * samples * step) + 1, len(study.struck.samples)
    n = study.finite.dofs
    full, bands = operations.newmark_full(n, samples), operations.newmark_banded(n, samples)
    convolved = operations.duhamel(samples, memory)
    with_transforms = operations.moving_frf(kept) + 2 * operations.real_fft(line.padded)
    seconds, errors = _measured(study, line)
    few = 200  # steps with full matrices that are timed
    dense_setup, dense_record, dense_apart = _with_full_matrices(
        study.finite, study.force, case.journey.speed, step, few
    )
    nan = float("nan")
    ways = {
        "Newmark, full matrices": Way(full, dense_setup, dense_record, errors["Newmark"]),
        "Newmark, bands": Way(bands, seconds["factorising"], seconds["Newmark"], errors["Newmark"]),
        "Duhamel's integral": Way(convolved, seconds["striking"], seconds["Duhamel"], errors["Duhamel"]),
        "moving FRF, product alone (the paper's count)": Way(operations.moving_frf(unpadded), nan, nan, nan),
        "moving FRF of 40 m, with its transforms": Way(
            with_transforms,
            seconds["striking"] + seconds["transforming"],
            seconds["moving FRF"],
            errors["moving FRF"],
        ),
        "moving FRF in closed form": Way(
            with_transforms, seconds["closed form"], seconds["moving FRF"], errors["closed form"]
        ),
    }
    ours, stepped = ways["moving FRF of 40 m, with its transforms"], ways["Newmark, bands"]
    pays_from = (ours.setup - stepped.setup) / (stepped.record - ours.record)
    least = all(ours.record < ways[name].record for name in ("Newmark, bands", "Duhamel's integral"))
    return Outcome(
        statements=[
            Statement(
                'Table 1: "number of multiplication operations and computational cost for different methods" (its '
                "values are not in the text); (implied) the moving FRF needs least.",
                f"Multiplications: Newmark {number(full, 3)} with full matrices and {number(bands, 3)} with "
                f"bands, Duhamel {number(convolved, 3)}, moving FRF {operations.moving_frf(unpadded)} for the "
                f"product that the paper counts and {number(with_transforms, 3)} with padding and transforms. "
                f"Time for a record: {number(1e3 * dense_record, 3)}, {number(1e3 * stepped.record, 3)}, "
                f"{number(1e3 * seconds['Duhamel'], 3)} and {number(1e3 * ours.record, 3)} ms, after a set-up "
                f"(striking 40 m and transforming) of {number(1e3 * ours.setup, 2)} ms: against Newmark's method "
                f"with bands that pays from {number(max(pays_from, 0.0), 2)} records on; in closed form the "
                f"set-up takes {number(1e3 * seconds['closed form'], 2)} ms.",
                verdict(
                    least and with_transforms < convolved and pays_from <= 1,
                    least and with_transforms < convolved,
                ),
                "holds if it is the least from the first record on; in part if it is for each further record",
            )
        ],
        numbers={
            "newmark_full_multiplications": full,
            "newmark_banded_multiplications": bands,
            "duhamel_multiplications": convolved,
            "moving_frf_multiplications": operations.moving_frf(unpadded),
            "moving_frf_with_transforms_multiplications": with_transforms,
            "newmark_full_s": dense_record,
            "newmark_banded_s": stepped.record,
            "duhamel_s": seconds["Duhamel"],
            "moving_frf_s": ours.record,
            "moving_frf_setup_s": ours.setup,
            "moving_frf_pays_from_records": pays_from,
            "newmark_error": errors["Newmark"],
            "duhamel_error": errors["Duhamel"],
            "moving_frf_error": errors["moving FRF"],
        },
        computed=[
            f"Multiplications, n = {n} unknowns, N = {samples} steps. Newmark with full matrices, factorised "
            "once: N (3 n² + 11 n + 17). With bands, as this package steps: N (31 n + 34). Duhamel: m N − m (m − "
            f"1)/2 with the m = {memory} samples recorded on 40 m. Moving FRF: 4 for each of the f T + 1 = "
            f"{unpadded} frequencies up to {STATED.truncation:g} Hz; padded for the response to die away, "
            f"{kept} of them, and two transforms of {line.padded} points. A division counts as a "
            "multiplication; what is prepared once does not count. tests/paper/test_operations.py counts the "
            "multiplications of small instrumented runs.",
            "Times: medians, in turns, one thread, steps compiled where numba is installed. Newmark with full "
            f"matrices is timed over {few} steps, in which it differs from bands by {number(dense_apart, 1)}. "
            "Set-up, once for a road, speed and step: factorising, striking, or evaluating the moving FRF at all "
            "frequencies. Errors (relative L2): "
            + (
                "against the closed form with nothing left out."
                if study.quick
                else "against Newmark's method on a road that travels along, refined until it no longer moves."
            ),
            f"Bands alone make Newmark's method {number(full / bands, 2)} times cheaper than the full matrices of "
            "a textbook.",
        ],
        substitutes=[SUBSTITUTES.road, SUBSTITUTES.load, "The paper's own figures in Table 1 are not in its text."],
        tables=[
            DataTable(
                "table_1",
                "Multiplications, times and errors for 10 s of one moving load.",
                "method",
                [
                    Column("multiplications", ""),
                    Column("set-up", "s"),
                    Column("each record", "s"),
                    Column("relative L2 error", ""),
                ],
                [(name, list(way)) for name, way in ways.items()],
            )
        ],
    )


def _measured(study: Study, line: Line) -> tuple[dict[str, float], dict[str, float]]:
    """Measure times of all ways and of their preparation [s], and errors of the responses."""
    case = scenario("load")
    finite, forces = study.finite, study.force
    speed, step = case.journey.speed, case.journey.time_step
    cut = Truncation(frequency=STATED.truncation)
    omega = line.omega()[: cut.reach(line.omega())]
    frf = {
        name: guideway.moving_frf(0.0, speed, omega) * cut.taper(omega)
        for name, guideway in (("moving FRF", study.struck), ("closed form", study.guideway))
    }
    records: dict[str, Callable[[], FloatArray]] = {
        "Newmark": lambda: newmark_loads(finite, forces, [0.0], speed=speed, time_step=step).deflection.values,
        "Duhamel": lambda: (
            duhamel_loads(study.struck, forces, [0.0], speed=speed, time_step=step).deflection.values
        ),
        "moving FRF": lambda: _product(line, frf["moving FRF"], forces),
    }
    once: dict[str, Callable[[], object]] = {
        "factorising": lambda: newmark_loads(finite, forces[:2], [0.0], speed=speed, time_step=step),
        "striking": lambda: struck_track(study.guideway, speed=speed, offsets=[0.0], plain=True),
        "transforming": lambda: study.struck.moving_frf(0.0, speed, omega),
        "closed form": lambda: study.guideway.moving_frf(0.0, speed, omega),
    }
    study.told("times of three methods", 0, 1)
    with quiet():
        seconds = timed({**records, **once})
        seconds["Newmark"] -= seconds["factorising"]
        wanted = (
            study.under_load(study.guideway).deflection.values
            if study.quick
            else converged(case, study.progress).quantities["deflection"]
        )
        errors = {name: relative(record(), wanted) for name, record in records.items()}
        errors["closed form"] = relative(_product(line, frf["closed form"], forces), wanted)
    return seconds, errors


def _product(line: Line, frf: ComplexArray, forces: FloatArray) -> FloatArray:
    """Transform, multiply, transform back."""
    return line.records(frf * line.spectra(line.given(forces.T))[0, : frf.size]).values[:, None]


def _with_full_matrices(
    finite: FiniteGuideway, forces: FloatArray, speed: float, step: float, few: int
) -> tuple[float, float, float]:
    """Step as in a textbook: time to factorise and of a record [s], difference from bands in the first steps."""
    mass, damping, stiffness = (matrix.toarray() for matrix in (finite.mass, finite.damping, finite.stiffness))
    a0, a1, a2 = 4 / step**2, 2 / step, 4 / step
    rows = finite.rows(speed * step * np.arange(few)).toarray()
    deflection = np.zeros((few, 1))
    u, v = np.zeros((2, finite.dofs))
    a = np.linalg.solve(mass, rows[0] * forces[0])
    with threadpool_limits(limits=1):
        first = perf_counter()
        factor = cho_factor(stiffness + a0 * mass + a1 * damping)
        began = perf_counter()
        for n in range(1, few):
            right = rows[n] * forces[n] + mass @ (a0 * u + a2 * v + a) + damping @ (a1 * u + v)
            new = cho_solve(factor, right)
            acceleration = a0 * (new - u) - a2 * v - a
            v = v + 0.5 * step * (a + acceleration)
            u, a = new, acceleration
            deflection[n] = rows[n] @ u
        seconds = perf_counter() - began
    stepped = newmark_loads(finite, forces[:few], [0.0], speed=speed, time_step=step).deflection.values
    return began - first, seconds * len(forces) / few, relative(deflection, stepped)

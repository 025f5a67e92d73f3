"""Items 1 and 2: the moving impulse response and the moving FRF of the road; claim 4: where 40 m do not suffice."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from movingfrf._checks import FloatArray
from movingfrf.guideways.track import Spring, Track
from movingfrf.page import Column
from movingfrf.paper.drawing import BLACK, BLUE, ORANGE, SKY, canvas, curve, title
from movingfrf.paper.outcome import HOLDS, PARTLY, UNJUDGED, DataTable, Outcome, Plot, Statement, verdict
from movingfrf.paper.study import FALLING, TRUNCATION, Study, closed_form, quiet, relative
from movingfrf.reference.impulse import PAPER, struck_track
from movingfrf.spectral import SpectralGrid
from movingfrf.wording import number

SUBSTITUTE = (
    "The road's parameters stand in a table that the text of the paper does not have. Substitute: a published "
    "pavement beam (EI = 1.573 × 10⁷ N m², m = 711.9 kg/m, k = 8 × 10⁶ N/m², c = 3 × 10⁴ N s/m² per metre of "
    "width; Ding, Chen and Yang, J. Sound Vib. 331, 2012, with a lower damping) times the 3 m that the paper "
    "gives its three-dimensional road. Its √(k/m)/2π is 16.9 Hz."
)

# Frequencies at which errors of the moving FRF are looked at: every quarter hertz up to the paper's truncation.
BAND: FloatArray = np.arange(0.0, TRUNCATION + 0.125, 0.25)

# Highest frequency drawn [Hz], and the step of the closed form's impulse response [s].
DRAWN, FINE_STEP = 100.0, 2.5e-4

# Speeds [m/s] and offsets [m] of the maps.
FASTEST, FARTHEST = 60.0, 12.0

# Errors whose lines are drawn in the maps of claim 4.
LEVELS = (0.01, 0.03, 0.1)

# Errors: what suffices for results, and what is no longer small in a moving FRF.
SUFFICES, CONSIDERABLE = 1e-3, 1e-2


def moving_frf(study: Study) -> Outcome:
    """Compare 40 m of finite elements with the closed form: moving impulse response and moving FRF at 10 m/s."""
    frequency = np.linspace(0.0, DRAWN, 801)
    omega = 2 * np.pi * frequency
    exact = closed_form(study.road, frequency, study.offsets, study.speed)
    found = study.struck.moving_frf(study.offsets, study.speed, omega)
    finely = study.struck_finely.moving_frf(study.offsets, study.speed, omega)
    largest = np.abs(exact).max()
    amplitude = np.abs(exact[:, 0])
    falls = _falls_from(frequency, amplitude)
    falls_struck = _falls_from(frequency, np.abs(found[:, 0]))
    left = float(np.interp(TRUNCATION, frequency, amplitude) / amplitude.max())
    inside = frequency <= TRUNCATION
    plain, fine = (np.abs(values - exact)[inside].max(axis=0) / largest for values in (found, finely))
    at = {
        f: float(np.abs(found[n, 0] / exact[n, 0] - 1)) for f in (50, 70) for n in [np.searchsorted(frequency, f)]
    }

    figure, (response, spectrum, sides, error) = canvas(2, 2, 4.6)
    grid = SpectralGrid(samples=int(1.0 / FINE_STEP), time_step=FINE_STEP, settling=1.0)
    impulse = grid.to_histories(study.road.moving_frf([0.0], study.speed, grid.omega())).values[:, 0]
    struck_time = np.arange(len(study.struck.samples)) * study.struck.time_step
    curve(response, grid.time, 1e9 * impulse, BLACK, "closed form")
    curve(response, struck_time, 1e9 * study.struck.samples[:, 0], ORANGE, "40 m of finite elements")
    response.set(xlabel="time [s]", ylabel="moving impulse response [nm/(N s)]", xlim=(0, 0.5))
    curve(spectrum, frequency, 1e9 * amplitude, BLACK, "closed form")
    curve(spectrum, frequency, 1e9 * np.abs(found[:, 0]), ORANGE, "40 m of finite elements")
    spectrum.axvline(FALLING, color="#6b6b6b", linewidth=0.8, linestyle=":")
    spectrum.axvline(TRUNCATION, color="#6b6b6b", linewidth=0.8, linestyle=":")
    for n, (line, name) in enumerate(((BLUE, "one wheelbase ahead"), (SKY, "one wheelbase behind")), start=1):
        curve(sides, frequency, 1e9 * np.abs(exact[:, n]), line._replace(linestyle="-"), f"{name}")
        curve(sides, frequency, 1e9 * np.abs(found[:, n]), line._replace(linestyle=(0, (2, 1.5))), "the same, 40 m")
    for ax in (spectrum, sides):
        ax.set(xlabel="frequency [Hz]", ylabel="|moving FRF| [nm/N]", xlim=(0, DRAWN), ylim=(0, None))
    for values, line, name in ((found, ORANGE, "as in the paper"), (finely, BLUE, "end reflections cancelled")):
        curve(error, frequency[1:], np.abs(values - exact)[1:, 0] / largest, line, name)
    error.set(xlabel="frequency [Hz]", ylabel="difference over largest |G|", xlim=(0, DRAWN), yscale="log")
    sides.set_ylim(0, 9)
    for ax in (response, spectrum, error):
        ax.legend()
    sides.legend(ncols=2, fontsize=6.5, loc="upper right")
    return Outcome(
        statements=[
            Statement(
                f"Beyond {FALLING:g} Hz the amplitude of the moving FRF is a strictly decreasing function of "
                "frequency (Fig. 5(b)).",
                f"In closed form it falls strictly from {number(falls, 3)} Hz on. The 40 m of finite elements "
                "follow it with ripples of end reflections, so that theirs does so only from "
                f"{number(falls_struck, 3)} Hz on.",
                verdict(falls <= FALLING),
            ),
            Statement(
                "The moving FRF may be had from the impulse response of 40 m of finite elements.",
                f"Its largest difference from the closed form below {TRUNCATION:g} Hz is "
                f"{number(float(plain[0]), 2)} of the largest |G| under the load, {number(float(plain[1]), 2)} "
                f"ahead and {number(float(plain[2]), 2)} behind; relative to |G| itself {number(100 * at[50], 2)} "
                f"% at 50 Hz and {number(100 * at[70], 2)} % at 70 Hz. Claim 4 shows what that does to results.",
                PARTLY if plain.max() > SUFFICES else HOLDS,
            ),
        ],
        numbers={
            "falls_from_hz": falls,
            "struck_falls_from_hz": falls_struck,
            "amplitude_at_70_hz_over_largest": left,
            "struck_error_under_load": float(plain[0]),
            "struck_error_ahead": float(plain[1]),
            "struck_error_behind": float(plain[2]),
            "struck_error_at_50_hz": at[50],
            "struck_error_at_70_hz": at[70],
            "cancelled_error_under_load": float(fine[0]),
        },
        computed=[
            f"The road is struck at mid-length ({PAPER.length:g} m, elements of {PAPER.element:g} m, simply "
            f"supported, average acceleration with steps of {1e3 * PAPER.time_step:g} ms), the response is read "
            "at the points that travel on at 10 m/s, and transformed. The closed form is the sum of residues "
            "over the waves of the infinitely long road.",
            "With the average of four roads of 40 m, pinned or guided at either end, elements of 0.25 m and "
            f"steps of 0.25 ms, what the ends reflect cancels and {number(float(fine[0]), 2)} remains.",
            f"At {TRUNCATION:g} Hz the amplitude is {number(100 * left, 2)} % of its largest value.",
        ],
        substitutes=[SUBSTITUTE],
        plots=[
            Plot(
                "figure_05",
                "Moving impulse response and moving FRF at 10 m/s",
                "(a) Moving impulse response under the load; (b) amplitude of the moving FRF, dotted the paper's "
                f"17 and 70 Hz; (c) the same {study.wheelbase:g} m ahead of and behind the load; (d) difference "
                "between finite elements and closed form, under the load.",
                figure,
            )
        ],
    )


def _falls_from(frequency: FloatArray, amplitude: FloatArray) -> float:
    """Frequency from which an amplitude falls strictly, up to the paper's truncation [Hz]."""
    inside = frequency <= TRUNCATION
    rises = np.flatnonzero(np.diff(amplitude[inside]) >= 0)
    return float(frequency[rises[-1] + 1]) if rises.size else 0.0


def maps(study: Study) -> Outcome:
    """Amplitude of the moving FRF over frequency and speed, and over frequency and offset."""
    fine = 1 if study.quick else 3
    frequency = np.linspace(0.0, TRUNCATION, 60 * fine + 1)
    speeds, offsets = np.linspace(0.0, FASTEST, 20 * fine + 1), np.linspace(-FARTHEST, FARTHEST, 48 * fine + 1)
    over_speed = np.empty((speeds.size, frequency.size))
    for n, speed in enumerate(speeds):
        over_speed[n] = np.abs(closed_form(study.road, frequency, np.zeros(1), float(speed))[:, 0])
        study.told("moving FRF over speed", n + 1, speeds.size)
    over_offset = np.abs(closed_form(study.road, frequency, offsets, study.speed)).T
    with quiet():
        struck = struck_track(study.road, speed=study.speed, offsets=offsets, plain=True, progress=study.progress)
    from_elements = np.abs(struck.moving_frf(offsets, study.speed, 2 * np.pi * frequency)).T
    difference = float(np.abs(from_elements - over_offset).max() / over_offset.max())
    peak = over_speed.max(axis=1)

    figure, (left, right) = canvas(1, 2, 2.9)
    for ax, y, values, name in (
        (left, speeds, over_speed, "speed [m/s]"),
        (right, offsets, over_offset, "offset, ahead positive [m]"),
    ):
        drawn = ax.contourf(
            frequency, y, 1e9 * values, _levels(1e9 * values), cmap="cividis", norm="log", extend="both"
        )
        ax.set(xlabel="frequency [Hz]", ylabel=name)
        ax.grid(False)
        bar = figure.colorbar(drawn, ax=ax, label="|moving FRF| [nm/N]")
        bar.ax.minorticks_off()
        bar.set_ticks(
            [0.01, 0.03, 0.1, 0.3, 1, 3, 10, 30], labels=["0.01", "0.03", "0.1", "0.3", "1", "3", "10", "30"]
        )
    title(left, "under the load")
    title(right, f"at {study.speed:g} m/s")
    fastest = over_speed[-1]
    return Outcome(
        statements=[
            Statement(
                "Fig. 6 shows the amplitude over frequency for varying speed and offset (surfaces, no statement).",
                f"Under the load its largest value at {FASTEST:g} m/s is {number(float(peak[-1] / peak[0]), 3)} "
                f"times that at rest, at {number(float(frequency[fastest.argmax()]), 3)} instead of "
                f"{number(float(frequency[over_speed[0].argmax()]), 3)} Hz.",
                UNJUDGED,
            )
        ],
        numbers={
            "peak_at_60_m_per_s_over_that_at_rest": float(peak[-1] / peak[0]),
            "struck_error_over_offsets": difference,
        },
        computed=[
            "Closed form. The same map over offsets from 40 m of finite elements, as in the paper, differs from "
            f"it by at most {number(difference, 2)} of the largest amplitude.",
        ],
        substitutes=[SUBSTITUTE, f"The range of speeds and offsets: 0 to {FASTEST:g} m/s, ±{FARTHEST:g} m."],
        plots=[
            Plot(
                "figure_06",
                "Moving FRF over frequency, speed and offset",
                "Amplitude of the moving FRF (a) under the load, over speed; (b) at 10 m/s, over the offset from "
                "load to observer: ahead and behind differ.",
                figure,
            )
        ],
    )


def _levels(values: FloatArray) -> FloatArray:
    """Eight levels a decade, over three and a half decades below the largest value."""
    top = np.log10(values.max())
    levels: FloatArray = 10 ** np.arange(top - 3.5, top + 0.125, 0.125)
    return levels


def _damped(road: Track, factor: float) -> Track:
    assert isinstance(road.foundation, Spring)
    return replace(road, foundation=replace(road.foundation, damping=factor * road.foundation.damping))


def _stiffened(road: Track, factor: float) -> Track:
    assert isinstance(road.foundation, Spring)
    return replace(road, foundation=replace(road.foundation, stiffness=factor * road.foundation.stiffness))


def where_it_fails(study: Study) -> Outcome:
    """Claim 4: 40 m of finite elements; where they suffice, by results and over speed, damping and stiffness."""
    errors = {name: _contact_errors(study, name) for name in ("truck_narrow", "truck")}
    count = 4 if study.quick else 15
    speeds = np.geomspace(2.5, 80.0, count)
    factors = np.geomspace(0.1, 10.0, count)
    kinds = {"damping": _damped, "stiffness": _stiffened}
    error = np.empty((len(kinds), count, count))
    for m, kind in enumerate(kinds.values()):
        for n, factor in enumerate(factors):
            for j, speed in enumerate(speeds):
                error[m, n, j] = _error_of_40_m(kind(study.road, float(factor)), float(speed))
            study.told("40 m over speed, damping and stiffness", m * count + n + 1, len(kinds) * count)

    figure, axes = canvas(1, 2, 2.9, sharey=False)
    for ax, values, (name, symbol) in zip(
        axes, error, (("foundation damping", "c"), ("foundation stiffness", "k")), strict=True
    ):
        levels = np.geomspace(1e-3, 1.0, 13)
        drawn = ax.contourf(
            speeds, factors, np.clip(values, 1e-3, 1.0), levels, cmap="cividis", norm="log", extend="both"
        )
        lines = ax.contour(speeds, factors, values, LEVELS, colors="white", linewidths=1.0)
        ax.clabel(lines, fmt=lambda level: f"{100 * level:g} %", fontsize=7.5, colors="white")
        ax.plot(study.speed, 1.0, "o", color="white", markeredgecolor="black", markersize=5)
        ax.set(xscale="log", yscale="log", xlabel="speed [m/s]", ylabel=f"{name}, times this road's {symbol}")
        ax.set_xticks([2.5, 5, 10, 20, 40, 80], labels=["2.5", "5", "10", "20", "40", "80"])
        ax.set_yticks([0.1, 0.3, 1, 3, 10], labels=["0.1", "0.3", "1", "3", "10"])
        ax.minorticks_off()
        ax.grid(False)
    bar = figure.colorbar(drawn, ax=axes, label="largest error of the moving FRF")
    bar.set_ticks([0.001, 0.01, 0.1, 1.0], labels=["0.1 %", "1 %", "10 %", "100 %"])
    bar.ax.minorticks_off()

    here = _error_of_40_m(study.road, study.speed)
    here_over_speed = np.array([_error_of_40_m(study.road, float(speed)) for speed in speeds])
    weak = _error_of_40_m(_damped(study.road, 0.1), study.speed)
    stiff = _error_of_40_m(_stiffened(study.road, 10.0), study.speed)
    narrow, full = errors["truck_narrow"], errors["truck"]
    return Outcome(
        statements=[
            Statement(
                "A road of 40 m suffices for the moving impulse response at 10 m/s.",
                f"In contact force yes: {number(narrow['contact_force'], 2)} over roughness below 20 Hz, "
                f"{number(full['contact_force'], 2)} over the whole class A spectrum. Less so in wheel "
                f"acceleration, {number(full['wheel_acceleration'], 2)}, and in the road's dynamic deflection, "
                f"{number(full['deflection'], 2)}; the moving FRF itself is off by {number(here, 2)} of its "
                f"largest value. What decides is damping: with a tenth of it that is {number(weak, 2)}, on a "
                f"foundation ten times as stiff {number(stiff, 2)}; over speeds from {speeds[0]:g} to "
                f"{speeds[-1]:g} m/s it stays between {number(float(here_over_speed.min()), 2)} and "
                f"{number(float(here_over_speed.max()), 2)}.",
                verdict(
                    max(*full.values(), here) < SUFFICES, full["contact_force"] < SUFFICES and here < CONSIDERABLE
                ),
            )
        ],
        numbers={
            "moving_frf_error": here,
            **{f"narrow_band_{name}": value for name, value in narrow.items()},
            **{f"class_a_{name}": value for name, value in full.items()},
            "moving_frf_error_with_a_tenth_of_the_damping": weak,
            "moving_frf_error_on_ten_times_the_stiffness": stiff,
            "largest_moving_frf_error_over_speed": float(here_over_speed.max()),
        },
        computed=[
            "Left out of every comparison is the truncation: both sides are solved without it. The error of the "
            f"moving FRF is its largest difference from the closed form below {TRUNCATION:g} Hz, over the largest "
            "|G|, under the load.",
            "The limits are those of a finite road: waves come back from its ends where damping is low or, on a "
            "stiff foundation, small beside the critical one; and the travelling point has 20 m ahead of it, "
            "which it covers the sooner the faster it is. A longer road, absorbing ends, or the average of "
            "pinned and guided ends mend the first, only a longer road the second.",
        ],
        substitutes=[SUBSTITUTE, "The half truck and the roughness of items 7 to 10."],
        plots=[
            Plot(
                "claim_4",
                "Where 40 m of finite elements fail",
                "Largest error below 70 Hz of the moving FRF from 40 m of finite elements (simply supported, 0.5 "
                "m, 1 ms), over its largest value: (a) over speed and foundation damping, (b) over speed and "
                "foundation stiffness. The circle is the paper's speed on this road.",
                figure,
            )
        ],
        tables=[
            DataTable(
                "claim_4",
                "Relative L2 difference of results with the moving FRF of 40 m of finite elements from those in "
                "closed form, the worst channel.",
                "roughness",
                [Column("contact force", ""), Column("deflection", ""), Column("wheel acceleration", "")],
                [
                    ("class A, up to 2 cycle/m (20 Hz)", list(narrow.values())),
                    ("class A, up to 10 cycle/m (100 Hz)", list(full.values())),
                ],
            )
        ],
    )


def _contact_errors(study: Study, name: str) -> dict[str, float]:
    """Differences between results with the struck road and in closed form, nothing truncated."""
    found, wanted = (study.driven(guideway, name, None) for guideway in (study.struck, study.road))
    return {
        "contact_force": relative(found.contact_force.values, wanted.contact_force.values),
        "deflection": relative(
            (found.deflection - found.static_deflection).values,
            (wanted.deflection - wanted.static_deflection).values,
        ),
        "wheel_acceleration": relative(found.acceleration.values[:, 2:], wanted.acceleration.values[:, 2:]),
    }


def _error_of_40_m(road: Track, speed: float) -> float:
    """Largest error of the paper's moving FRF under the load below 70 Hz, over the largest |G|."""
    with quiet():
        struck = struck_track(road, speed=speed, offsets=[0.0], plain=True)
    exact = closed_form(road, BAND, np.zeros(1), speed)
    found = struck.moving_frf([0.0], speed, 2 * np.pi * BAND)
    return float(np.abs(found - exact).max() / np.abs(exact).max())

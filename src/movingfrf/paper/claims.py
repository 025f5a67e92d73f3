"""The paper's claims; the fourth has its maps in `road`."""

from __future__ import annotations

import math

import numpy as np

from movingfrf.comparison import ratios
from movingfrf.page import Column
from movingfrf.paper import operations
from movingfrf.paper.load import LOAD
from movingfrf.paper.outcome import UNJUDGED, DataTable, Outcome, Statement, verdict
from movingfrf.paper.road import BAND, SUBSTITUTE
from movingfrf.paper.study import TRUNCATION, Study, quiet, relative, scenario
from movingfrf.paper.vehicle import EQUAL, ROUGHNESS, VEHICLE, times_over
from movingfrf.reference.duhamel import duhamel_loads
from movingfrf.reference.finite_guideway import finite_track
from movingfrf.reference.impulse import CANCELLING, moving_impulse_response
from movingfrf.wording import number

# Where the road is struck, to see whether it matters [m]; the second place is not a node.
PLACES = (0.0, 12.1)


def time_invariant(study: Study) -> Outcome:
    """Claim 1: what travels along sees the same wherever it is; the convolution becomes a product."""
    road = finite_track(study.road, first=-60.0, last=80.0, element=0.2)
    with quiet():
        records = [
            moving_impulse_response(
                road,
                speed=study.speed,
                offsets=study.offsets,
                strike=place,
                duration=1.5,
                time_step=CANCELLING.time_step,
                scheme=CANCELLING.scheme,
            )
            for place in PLACES
        ]
    here, there = (record.moving_frf(study.offsets, study.speed, 2 * np.pi * BAND) for record in records)
    moved = float(np.abs(there - here).max() / np.abs(here).max())
    standing = _standing(study)
    journey = scenario("load").journey
    product = study.under_load(study.struck_finely)
    convolved = duhamel_loads(
        study.struck_finely, study.force, [0.0], speed=journey.speed, time_step=journey.time_step
    )
    apart = relative(product.deflection.values, convolved.deflection.values)
    return Outcome(
        statements=[
            Statement(
                "Seen by points that travel along, the time-varying system is time-invariant; the convolution "
                "becomes a product.",
                f"Struck {PLACES[1] - PLACES[0]:g} m further on, between two nodes, the road gives the same "
                f"moving FRF below {TRUNCATION:g} Hz within {number(moved, 1)} of its largest value (the accuracy "
                "of the elements); for a point that stands still the same two blows differ by "
                f"{number(100 * standing, 2)} % of it. The product of moving FRF and spectrum gives what "
                f"Duhamel's integral gives within {number(apart, 1)} (its hats of 1 ms).",
                verdict(moved < 1e-3 and apart < 1e-3),
            )
        ],
        numbers={
            "strike_elsewhere": moved,
            "strike_elsewhere_seen_at_rest": standing,
            "product_against_convolution": apart,
        },
        substitutes=[SUBSTITUTE, LOAD],
    )


def _standing(study: Study) -> float:
    """Change of what a point of the road that stands still sees if the blow moves on."""
    omega = 2 * np.pi * np.linspace(0.0, TRUNCATION, 141)
    here, there = np.abs(study.road.moving_frf([-PLACES[0], -PLACES[1]], 0.0, omega)).T
    return float(np.abs(here - there).max() / here.max())


def cheaper(study: Study) -> Outcome:
    """Claim 2: how much cheaper, at equal accuracy."""
    compared = study.compared
    by_name = {row.method: row for row in compared.rows}
    seconds = {name: row.setup_s + row.solve_s for name, row in by_name.items()}
    names = ("cdfm", "cdfm-weight", "cdfm-window", "sim", "duhamel")
    own = {name: seconds[name] / seconds["moving-frf"] for name in names}
    equal = {target: ratios(compared, target) for target in EQUAL} if compared.curve else {}
    rows = [(name, [own[name], *(found[name] for found in equal.values())]) for name in names]
    words = "; ".join(
        f"{number(target, 1)}, CDFM takes {times_over(found['cdfm'])} as long, SIM {times_over(found['sim'])}"
        for target, found in equal.items()
    )
    journey = scenario("truck").journey
    counts = (
        operations.newmark_banded(960, journey.samples),
        4 * operations.moving_frf(round(TRUNCATION * journey.duration) + 1) + 10 * operations.real_fft(48_000),
    )
    best = min((found["cdfm"] for found in equal.values() if not math.isnan(found["cdfm"])), default=own["cdfm"])
    return Outcome(
        statements=[
            Statement(
                "The moving FRF is cheaper by orders of magnitude than CDFM and SIM at equal accuracy.",
                (
                    f"At equal error in contact force, set-up included: {words}."
                    if equal
                    else f"At the step of 1 ms CDFM takes {times_over(own['cdfm'])}, SIM {times_over(own['sim'])} "
                    "as long (two seconds of the journey; the full version compares at equal error)."
                )
                + " That is against the other methods in their best form; item 12 says what full matrices would "
                "cost.",
                verdict(best >= 100, best >= 3),
            )
        ],
        numbers={
            **{f"{name.replace('-', '_')}_over_moving_frf": value for name, value in own.items()},
            **{
                f"{name.replace('-', '_')}_over_moving_frf_at_{target:g}": found[name]
                for target, found in equal.items()
                for name in names
            },
            "multiplications_of_the_road_alone_over_moving_frf": counts[0] / counts[1],
        },
        computed=[
            "Times with set-up, one thread, each method in its best form; see item 12. In multiplications, the "
            f"road's share of CDFM alone (960 unknowns, bands) takes {number(counts[0], 2)}, moving FRFs, "
            f"products and transforms {number(counts[1], 2)}: {number(counts[0] / counts[1], 2)} times less. "
            "Transforms and the moving FRF itself weigh more than the product that the paper counts.",
        ],
        substitutes=[SUBSTITUTE, VEHICLE, ROUGHNESS],
        tables=[
            DataTable(
                "claim_2",
                "Time over that of the moving FRF in closed form.",
                "method",
                [Column("at 1 ms", ""), *(Column(f"at an error of {number(target, 1)}", "") for target in equal)],
                rows,
            )
        ],
    )


def truncation(study: Study) -> Outcome:
    """Claim 3: the error of truncating at 70 Hz."""
    smooth, abrupt = (_error(study, name) for name in ("load", "load_abrupt"))
    full = study.driven(study.road, truncation=None).contact_force.values
    coupled = relative(study.in_closed_form.contact_force.values, full)
    return Outcome(
        statements=[
            Statement(
                f"The truncation error is below 10⁻⁴ beyond {TRUNCATION:g} Hz.",
                f"For the road under a load that sets in smoothly {number(smooth, 2)}, for one that is switched "
                f"abruptly {number(abrupt, 2)}, for the contact force of a vehicle on the whole class A spectrum "
                f"{number(coupled, 2)}. It is a property of the load, not of the road alone; item 5 says how far "
                "one has to go instead.",
                verdict(max(smooth, abrupt, coupled) < 1e-4, smooth < 1e-4),
            )
        ],
        numbers={"smooth_load": smooth, "abrupt_load": abrupt, "contact_force": coupled},
        computed=["Closed form, relative L2 norms against the response with nothing left out."],
        substitutes=[SUBSTITUTE, LOAD, VEHICLE, ROUGHNESS],
    )


def _error(study: Study, name: str) -> float:
    whole = study.under_load(study.road, name).deflection.values
    return relative(study.under_load(study.road, name, TRUNCATION).deflection.values, whole)


def left_open(study: Study) -> Outcome:
    """Claim 5: what the paper leaves open."""
    return Outcome(
        statements=[
            Statement(
                'The paper leaves open "nonlinear analysis of the vehicle–road system" and its "stochastic and '
                'nonlinear characteristics".',
                "So does this reproduction: nothing of it is computed here. What random roughness does to a "
                "linear vehicle follows from the same transfer functions; nonlinear contacts need an iteration "
                "between time and frequency.",
                UNJUDGED,
            )
        ],
    )

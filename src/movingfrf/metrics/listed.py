"""Every measure, once: unit, source, what it is called of a history and of a random road, and its caption.

A measure that has a file of its own brings its entry along, with name and source (`impact`): the way for new
ones. What is taken from files of several measures (`comfort`, `loads`, `fatigue`) has its entries here.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from movingfrf.metrics import impact
from movingfrf.metrics.comfort import ISO_2631
from movingfrf.metrics.entry import Entry, History, Measuring, OfHistory, OfRandom, Random, Table, lowest, peak, rms
from movingfrf.metrics.fatigue import equivalent_amplitude
from movingfrf.metrics.loads import road_stress_factor


@dataclass(frozen=True, slots=True, kw_only=True)
class Sources:
    """Sources of the measures with an entry here which their names alone do not define."""

    load: str = "Cebon 1999"  # dynamic load coefficient and wear
    stress: str = "Eisenmann 1975"
    cycles: str = "ASTM E1049"
    crossings: str = "Rice 1945"
    peak: str = "Davenport 1964"
    damage: str = "Dirlik 1985"


SOURCES = Sources()


def _of(measure: Measuring, variable: str) -> Callable[[History, int], float]:
    """Measure a variable as it is."""
    return lambda of, number: float(of.measured(measure, variable)[number])


def _variable(name: str) -> Callable[[History | Random, int], float]:
    """Take a variable of the result for the measure."""
    return lambda of, number: of.value(name, number)


def _smallest(of: History, contact: int) -> float:
    return of.value("static_load", contact) + float(of.measured(lowest, "contact_force")[contact])


def _equivalent(of: History, contact: int) -> float | None:
    if of.slope is None:
        return None
    force = of.column("contact_force", contact)
    return equivalent_amplitude(force, slope=of.slope, duration=force.size * of.step)


def _about_the_sag(of: History, contact: int) -> float:
    return float(rms(of.column("deflection", contact) - of.value("static_deflection", contact)))


def _too_short(of: History, path: int) -> str:
    short = "the record is too short for all contacts to pass one point of the road"
    return short if np.isnan(of.wear[path]) else ""


def _reactions(of: History, dof: int) -> str:
    """Say how people react to a vibration, by ISO 2631-1; nothing of motion sickness or of a rotation."""
    felt = of.felt(dof)
    if not of.judged or felt.weighting == "Wf" or not felt.rms or of.place("dof", dof).words["unit"] != "m":
        return ""
    return f"{', or '.join(felt.reactions)} (ISO 2631-1, C.2.3)"


def _verdict(name: str, limit: str) -> Callable[[History, int], str]:
    """Say whether ISO 2631-1 takes the rms alone for enough; nothing of motion sickness."""

    def note(of: History, dof: int) -> str:
        felt = of.felt(dof)
        if not of.judged or felt.weighting == "Wf" or not felt.rms:
            return ""
        if name in felt.exceeded:
            return f"above {limit}: the rms alone understates this vibration"
        return f"not above {limit}"

    return note


FORCES = Table(
    "contact",
    "force",
    {
        "force": "Contact forces. The dynamic part is what the roughness adds to the static level; the dynamic "
        "load coefficient is its rms over the static force."
    },
    {
        "force": "Contact forces: the static one, and the dynamic one that the roughness adds.",
        "load": "Total contact forces, static and dynamic, and what they do to the road. The dynamic load "
        "coefficient is the rms of the dynamic force over the static one.",
    },
    (
        Entry(
            "N",
            OfHistory("static", _variable("static_load"), usual="static_load"),
            OfRandom("static", _variable("static_load")),
        ),
        Entry(
            "N",
            OfHistory("dynamic rms", _of(rms, "contact_force"), usual="contact_force_rms"),
            OfRandom("rms", _variable("contact_force_rms")),
        ),
        Entry(
            "N",
            OfHistory("dynamic peak", _of(peak, "contact_force"), usual="contact_force_peak"),
            OfRandom("expected peak", _variable("contact_force_expected_peak"), SOURCES.peak),
        ),
        Entry(
            "1/s",
            random=OfRandom("crossing rate", _variable("contact_force_crossing_rate"), SOURCES.crossings),
        ),
        Entry("1", random=OfRandom("irregularity", _variable("contact_force_irregularity"), SOURCES.crossings)),
        Entry("N", OfHistory("smallest total", _smallest, usual="smallest_contact_force")),
        Entry(
            "1",
            OfHistory(
                "dynamic load coefficient",
                lambda of, n: of.coefficients[n],
                SOURCES.load,
                usual="dynamic_load_coefficient",
            ),
            OfRandom("dynamic load coefficient", _variable("dynamic_load_coefficient"), SOURCES.load, "load"),
        ),
        Entry(
            "1",
            OfHistory("road stress factor", lambda of, n: of.stress[n], SOURCES.stress),
            OfRandom(
                "road stress factor",
                lambda of, n: float(road_stress_factor(of.value("dynamic_load_coefficient", n))),
                SOURCES.stress,
                "load",
            ),
        ),
        impact.ENTRY,
        Entry(
            "N",
            random=OfRandom(
                "expected largest",
                lambda of, n: of.value("static_load", n) + of.value("contact_force_expected_peak", n),
                SOURCES.peak,
                "load",
            ),
        ),
        Entry("1/s", random=OfRandom("lift-offs", _variable("lift_off_rate"), SOURCES.crossings, "load")),
        Entry(
            "1",
            OfHistory("share of time without contact", lambda of, n: of.loss.share[n]),
            OfRandom("share lifted off", _variable("lift_off_share"), quantity="load"),
        ),
        Entry("s", OfHistory("longest loss of contact", lambda of, n: of.loss.longest[n])),
        Entry(
            "N",
            OfHistory("damage-equivalent amplitude at 1 Hz", _equivalent, SOURCES.cycles),
            OfRandom(
                "damage-equivalent amplitude at 1 Hz",
                lambda of, n: None if of.equivalent is None else of.equivalent[n],
                SOURCES.damage,
            ),
        ),
    ),
)

DEFLECTIONS = Table(
    "contact",
    "deflection",
    {"deflection": "Deflections of the road under the contacts, positive down."},
    {"deflection": "Deflections of the road under the contacts; rms and peak of the dynamic part."},
    (
        Entry(
            "m",
            OfHistory("static", _variable("static_deflection"), usual="static_deflection"),
            OfRandom("static", _variable("static_deflection")),
        ),
        Entry(
            "m",
            OfHistory("dynamic rms", _about_the_sag, usual="deflection_rms"),
            OfRandom("rms", _variable("deflection_rms")),
        ),
        Entry(
            "m",
            OfHistory("peak", _of(peak, "deflection"), usual="deflection_peak"),
            OfRandom("expected peak", _variable("deflection_expected_peak"), SOURCES.peak),
        ),
        Entry("1/s", random=OfRandom("crossing rate", _variable("deflection_crossing_rate"), SOURCES.crossings)),
    ),
)

WEAR = Table(
    "path",
    "wear",
    {"wear": "What all contacts together do to the points of the road."},
    {},
    (
        Entry(
            "1",
            OfHistory("95th percentile of ΣP⁴ over static", lambda of, n: of.wear[n], SOURCES.load, _too_short),
        ),
    ),
)

ACCELERATIONS = Table(
    "dof",
    "acceleration",
    {
        "acceleration": "Accelerations about the steady state, as they are and as people feel them: weighted with "
        "Wk of ISO 2631-1.",
        "angular acceleration": "Angular accelerations about the steady state, as they are and weighted with We "
        "of ISO 2631-1.",
    },
    {
        "acceleration": "Accelerations about the steady state.",
        "angular acceleration": "Angular accelerations about the steady state.",
    },
    (
        Entry(
            "{unit}/s²",
            OfHistory("rms", _of(rms, "acceleration"), usual="acceleration_rms"),
            OfRandom("rms", _variable("acceleration_rms")),
        ),
        Entry(
            "{unit}/s²",
            OfHistory("peak", _of(peak, "acceleration"), usual="acceleration_peak"),
            OfRandom("expected peak", _variable("acceleration_expected_peak"), SOURCES.peak),
        ),
        Entry("1/s", random=OfRandom("crossing rate", _variable("acceleration_crossing_rate"), SOURCES.crossings)),
        Entry(
            "{unit}/s²",
            OfHistory(
                "weighted rms",
                lambda of, n: float(rms(of.weighted(n))),
                "{by}",
                _reactions,
                usual="weighted_acceleration_rms",
            ),
            OfRandom("weighted rms ({weighting})", _variable("weighted_acceleration"), "ISO 2631-1"),
        ),
        Entry("{unit}/s²", OfHistory("weighted peak", lambda of, n: of.felt(n).peak, "{by}")),
        Entry(
            "1",
            OfHistory(
                "crest factor",
                lambda of, n: of.felt(n).crest_factor,
                "{by}",
                _verdict("crest", f"{ISO_2631.crest_limit:g}"),
            ),
        ),
        Entry(
            "{unit}/s²",
            OfHistory(
                "MTVV",
                lambda of, n: of.felt(n).mtvv,
                "{by}",
                _verdict("MTVV", f"{ISO_2631.mtvv_limit:g} times the weighted rms"),
            ),
        ),
        Entry(
            "{unit}/s^1.75",
            OfHistory(
                "VDV",
                lambda of, n: of.felt(n).vdv,
                "{by}",
                _verdict(
                    "VDV",
                    f"{ISO_2631.vdv_limit:g} times the weighted rms times the fourth root of the duration",
                ),
            ),
        ),
    ),
)

TABLES = (FORCES, DEFLECTIONS, WEAR, ACCELERATIONS)

CAPTIONS = {quantity: words for table in TABLES for quantity, words in table.captions.items()}
# On a road that is not the same everywhere, a bridge for one, nothing is steady.
FINITE_CAPTIONS = CAPTIONS | {
    "force": "Contact forces. The dynamic part is what comes, of the road and of its roughness, on top of the "
    "static level, that at the beginning of the record; the dynamic load coefficient is its rms over the "
    "static force.",
    "deflection": "Deflections of the road under the contacts, positive down. The static one is that at the "
    "beginning of the record, the dynamic rms is about it.",
    "acceleration": "Accelerations, as they are and as people feel them: weighted with Wk of ISO 2631-1.",
    "angular acceleration": "Angular accelerations, as they are and weighted with We of ISO 2631-1.",
}
RANDOM_CAPTIONS = {quantity: words for table in TABLES for quantity, words in table.random_captions.items()}

"""Limits that measures are held against: those of a line, `dynamic_load_coefficient.rear=0.2`, and usual ones."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

from movingfrf._basics.checks import checking
from movingfrf.metrics.comfort import ISO_2631
from movingfrf.scenarios.scenario import Drive
from movingfrf.studies.sweep.plan import Plan


class Limit(NamedTuple):
    """A value that a measure is not to pass."""

    measure: str
    value: float  # in the unit of the measure
    place: str = ""  # name of the contact or degree of freedom; empty: wherever it is worst
    meaning: str = ""


def usual_limits(measure: str) -> list[Limit]:
    """Give the limit that a measure has by what it means: contact, comfort.

    Examples
    --------
    >>> [limit.value for limit in usual_limits("smallest_contact_force")]
    [0.0]
    >>> usual_limits("contact_force_rms")
    []
    """
    words, _, comfortable = ISO_2631.reactions[0]
    said = {
        "smallest_contact_force": (0.0, "contact is lost"),
        "weighted_acceleration_rms": (comfortable, f"more than “{words}” in ISO 2631-1"),
        "weighted_acceleration": (comfortable, f"more than “{words}” in ISO 2631-1"),
    }
    return [Limit(measure, said[measure][0], meaning=said[measure][1])] if measure in said else []


def limits_in(lines: Iterable[str], plan: Plan) -> list[Limit]:
    """Understand limits, as `contact_force_peak=80e3` or `dynamic_load_coefficient.rear=0.2`.

    Parameters
    ----------
    lines : iterable of str
        Each `MEASURE=VALUE` or `MEASURE.PLACE=VALUE`, the place a contact or degree of freedom by its name or
        number, the value in the unit that the measure has in the table.
    plan : Plan
        The sweep.

    Returns
    -------
    list of Limit
        In this order.

    Raises
    ------
    ValueError
        If a line is none, the sweep does not take the measure, no vehicle has the place, or a limit stands twice.
    """
    found: dict[tuple[str, str], Limit] = {}
    for line in lines:
        key, equals, text = (part.strip() for part in line.partition("="))
        name, _, place = key.partition(".")
        if not (equals and name and text):
            raise ValueError(f"--limit {line} must be MEASURE=VALUE, as dynamic_load_coefficient=0.2")
        with checking() as check:
            name = check.choice(f"--limit {line}: the measure", name, plan.measures)
        usual = plan.way.measures[name]
        if place:
            names = _names(plan, usual.place)
            with checking() as check:
                which = int(place) if place.isdecimal() else place
                number = check.one_of(f"--limit {line}: the {usual.place}", which, names)
            place = names[number]
        unit = usual.units
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise ValueError(f"--limit {line} must be a number{'' if unit == '1' else f' [{unit}]'}, got {text}")
        if (name, place) in found:
            raise ValueError(f"--limit {line}: {key} is limited twice")
        found[name, place] = Limit(name, value, place)
    return list(found.values())


def _names(plan: Plan, place: str) -> list[str]:
    """Name the contacts or degrees of freedom of all vehicles that a sweep has, each once."""
    first = [0] * len(plan.axes)
    cases = [first]
    for number, axis in enumerate(plan.axes):
        others = isinstance(axis.values[0][0], str | dict) and axis.paths[0].split(".")[0] == "vehicle"
        cases += [[*first[:number], at, *first[number + 1 :]] for at in range(1, axis.size) if others]
    names: dict[str, None] = {}
    variants = plan.variants
    for case in cases:
        try:
            told = variants.at(plan.axes.values(case)).case
        except ValueError:  # a case without an answer
            continue
        assert isinstance(told, Drive)
        called = (
            [contact.name for contact in told.vehicle.contacts] if place == "contact" else told.vehicle.dof_names
        )
        names |= dict.fromkeys(name or f"{place} {number}" for number, name in enumerate(called))
    return list(names)

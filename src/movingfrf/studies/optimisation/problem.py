"""What is to be made small, over which keys, within which limits: checked before anything is computed."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import Checks, checking, shown
from movingfrf._basics.wording import number, told_apart
from movingfrf.scenarios.kinds import ROUGHNESS
from movingfrf.scenarios.scenario import Drive, Scenario
from movingfrf.scenarios.variants import tables_in, unit_of
from movingfrf.studies.sweep.plan import Plan, plan_of
from movingfrf.studies.sweep.ways import ways
from movingfrf.vehicles.vehicle import Vehicle


class Key(NamedTuple):
    """A key, or several that have one value, and the range of that."""

    paths: tuple[str, ...]
    low: float
    high: float
    unit: str

    @property
    def name(self) -> str:
        """What it is called."""
        return " and ".join(self.paths)

    @property
    def by_factors(self) -> bool:
        """Whether equal factors are equal steps: over a decade or more."""
        return self.low > 0 and self.high >= 10.0 * self.low

    def at(self, share: float) -> float:
        """Value so far along the range, from 0 to 1."""
        rises = self.by_factors
        value = self.low * (self.high / self.low) ** share if rises else self.low + share * (self.high - self.low)
        # So many digits that the scenario's own value comes back as it was written [10 to 13].
        return min(max(float(f"{value:.12g}"), self.low), self.high)

    def share(self, value: float) -> float:
        """Give how far along the range a value lies."""
        if self.by_factors:
            return math.log(value / self.low) / math.log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)

    def slope(self, value: float) -> float:
        """Change of the value per share of the range."""
        return value * math.log(self.high / self.low) if self.by_factors else self.high - self.low

    def around(self, value: float) -> list[tuple[float, float]]:
        """Give values near by within the range, each with its weight in a derivative [1/unit]."""
        # Matrices are polynomials of low degree in their keys, a road under a faster vehicle has shorter waves
        # [1e-6 to 1e-4, 1e-7 to 1e-5].
        step = (1e-6 if self.paths[0].startswith("run.") else 1e-5) * max(abs(value), 0.01 * (self.high - self.low))
        step = min(step, 0.25 * (self.high - self.low))
        if self.low <= value - step and value + step <= self.high:
            return [(-0.5 / step, value - step), (0.5 / step, value + step)]
        step = step if value + 2 * step <= self.high else -step
        return [(-1.5 / step, value), (2.0 / step, value + step), (-0.5 / step, value + 2 * step)]

    def told(self, value: float) -> str:
        """Write a value with its unit."""
        return f"{number(value)} {self.unit}".strip()


class Of(NamedTuple):
    """A measure at some contacts or degrees of freedom."""

    measure: str
    numbers: tuple[int, ...]
    names: tuple[str, ...]  # what these are called

    @property
    def words(self) -> str:
        """What it is called: with the place, unless that is one of several."""
        return f"{self.measure} of {self.names[0]}" if len(self.names) == 1 else f"largest {self.measure}"


class Limit(NamedTuple):
    """Between what a measure is to be, wherever it is taken."""

    of: Of
    low: float
    high: float

    @property
    def words(self) -> str:
        """The limit."""
        ends = (("at least", self.low), ("at most", self.high))
        return " and ".join(f"{word} {end:g}" for word, end in ends if math.isfinite(end))


class Problem(NamedTuple):
    """What is asked."""

    plan: Plan
    keys: tuple[Key, ...]
    aim: Of
    limits: tuple[Limit, ...]

    @property
    def wanted(self) -> list[tuple[str, int]]:
        """Measures and places that matter, each once."""
        parts = (self.aim, *(limit.of for limit in self.limits))
        return list(dict.fromkeys((part.measure, place) for part in parts for place in part.numbers))

    def values(self, shares: FloatArray) -> FloatArray:
        """Values of the keys so far along their ranges."""
        return np.array([key.at(share) for key, share in zip(self.keys, shares, strict=True)])

    def named(self, values: Sequence[float]) -> dict[str, float]:
        """Values by the path of the key."""
        return {path: value for key, value in zip(self.keys, values, strict=True) for path in key.paths}

    @property
    def own(self) -> FloatArray | None:
        """How far along the ranges the scenario's own values lie; None if it has none there."""
        within = []
        for key in self.keys:
            first, *others = (_own(self.plan.tables, path) for path in key.paths)
            if first is None or not key.low <= first <= key.high or any(other != first for other in others):
                return None
            within.append(key.share(first))
        return np.array(within)


def _own(tables: Any, path: str) -> float | None:
    """Value of a key as the scenario says it."""
    for word in path.split("."):
        if isinstance(tables, list) and word.isdecimal() and int(word) < len(tables):
            tables = tables[int(word)]
        elif isinstance(tables, dict) and word in tables:
            tables = tables[word]
        else:
            return None
    return float(tables) if isinstance(tables, int | float) and not isinstance(tables, bool) else None


def problem_of(
    scenario: Scenario | str | Path | Mapping[str, Any],
    over: Mapping[Any, Any],
    minimise: str,
    *,
    contact: int | str | None = None,
    dof: int | str | None = None,
    where: Mapping[Any, Any] | None = None,
    response: str = "simulate",
) -> Problem:
    """Check what is asked for.

    Parameters
    ----------
    scenario, over, minimise, contact, dof, where, response
        As `optimise` takes them.

    Returns
    -------
    Problem
        What is asked.

    Raises
    ------
    ValueError
        If a range is none, a key names nothing, a measure, contact or degree of freedom is unknown, or a key lets
        a realised road be another one.
    """
    limits = where or {}
    with checking() as check:
        response = check.choice("response", response, ways())
        # Of the road alone.
        known = [name for name in ways()[response].measures if not name.startswith("roughness_")]
        aim = check.choice("minimise", minimise, known)
        if not isinstance(over, Mapping) or not over:
            check.refuse("over", f"must be a mapping from keys to ranges (low, high), got {shown(over)}")
        if not isinstance(limits, Mapping):
            check.refuse("where", f"must be a mapping from measures to their limits, got {shown(where)}")
    tables = tables_in(scenario)[0]
    with checking() as check:
        keys = tuple(_key(check, key, given, tables) for key, given in over.items())
        asked = [_limit(check, key, given, known) for key, given in limits.items()]
    names = dict.fromkeys([aim, *(measure for measure, *_ in asked)])
    axes = {key.paths: [(end,) * len(key.paths) for end in (key.low, key.high)] for key in keys}
    # In the steps that the scenario says: what is found is measured so by whoever runs it.
    plan = replace(plan_of(scenario, axes, measures=list(names), response=response), stated=True)
    whole = Problem(plan, keys, Of(aim, (), ()), ())
    vehicle = _drive(whole).vehicle
    if response == "simulate":
        _require_one_road(whole)
    places = {name: plan.way.measures[name].place for name in plan.measures}
    with checking() as check:
        for name, given, place in (("contact", contact, "contact"), ("dof", dof, "dof")):
            if given is not None and places[aim] != place:
                check.refuse(name, f"is not what {aim} is taken of: it has a value for each {places[aim]}")
    with checking() as check:
        given, name = (contact, "contact") if places[aim] == "contact" else (dof, "dof")
        made = _of(check, name, aim, places[aim], given, vehicle)
        held = tuple(
            Limit(_of(check, f"where: {measure}", measure, places[measure], place, vehicle), low, high)
            for measure, place, low, high in asked
        )
    return whole._replace(aim=made, limits=held)


def _key(check: Checks, key: Any, given: Any, tables: Mapping[str, Any]) -> Key:
    """Understand a key, or several, and the range."""
    paths = key if isinstance(key, tuple) else (key,)
    if not paths or not all(isinstance(path, str) and path for path in paths):
        check.refuse("over", f"must have paths of keys, as 'vehicle.suspension_damping.0', got {shown(key)}")
        return Key(("",), 0.0, 1.0, "")
    said = " and ".join(paths)
    low, high = check.pair(said, given, unit_of(tables, paths[0]) or "1", signed=True)
    if not low < high and not math.isnan(low + high):
        ends = " to ".join(told_apart(low, high)) if low != high else f"{low:g} to {high:g}"
        check.refuse(said, f"must have a range from a lower to a higher value, got {ends}")
    # Others say how something is computed, or for how long: there is nothing to choose.
    chosen = ("speed", "speed_kmh", "start", "blend")
    for path in paths:
        table, _, rest = path.partition(".")
        if not rest or (table == "run" and rest not in chosen):
            check.refuse(path, "has no best value: it must be a number of vehicle, guideway or road, or a speed")
    return Key(tuple(paths), low, high, unit_of(tables, paths[0]))


def _limit(check: Checks, key: Any, given: Any, known: Sequence[str]) -> tuple[str, int | str | None, float, float]:
    """Understand a limit: the measure, where it is taken, and between what it may be."""
    measure, place = key if isinstance(key, tuple) and len(key) == 2 else (key, None)
    name = check.choice("where", measure, known)
    if isinstance(given, tuple | list) and len(given) == 2:
        low, high = (
            open_end if end is None else check.finite(f"where: {name}", end, "1")
            for end, open_end in zip(given, (-math.inf, math.inf), strict=True)
        )
    else:
        low, high = -math.inf, check.finite(f"where: {name}", given, "1")
    if low >= high or (low, high) == (-math.inf, math.inf):
        check.refuse(f"where: {name}", f"must be an upper limit, or a lower and an upper one, got {shown(given)}")
    return name, place, low, high


def _of(check: Checks, said: str, measure: str, place: str, given: int | str | None, vehicle: Vehicle) -> Of:
    """Find the contacts or degrees of freedom that a measure is taken of."""
    names = [contact.name for contact in vehicle.contacts] if place == "contact" else [*vehicle.dof_names]
    if given is not None:
        numbers = check.some_of(said, given, names)
    else:
        numbers = [*range(len(names))] if place == "contact" else carried(vehicle)
    return Of(measure, tuple(numbers), tuple(names[n] or f"{place} {n}" for n in numbers))


def carried(vehicle: Vehicle) -> list[int]:
    """Give the degrees of freedom that stand for what is carried: translations that move no contact.

    Bodies and seats, but neither wheels nor rotations; of a mass that stands on its contacts, its translations.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle.

    Returns
    -------
    list of int
        Their numbers.

    Examples
    --------
    >>> import movingfrf as mf
    >>> truck = mf.catalogue("half_truck")
    >>> [truck.dof_names[number] for number in carried(truck)]
    ['bounce']
    """
    along = np.asarray(vehicle.vertical) != 0
    apart = along & ~vehicle.matrices[3].any(axis=0)
    return [int(number) for number in np.flatnonzero(apart if apart.any() else along)]


def _drive(problem: Problem) -> Drive:
    """Make a case within the ranges, in their middle or at an end of all."""
    for share in (0.5, 0.0, 1.0):
        try:
            case = problem.plan.variants.at(problem.named([key.at(share) for key in problem.keys])).case
        except ValueError as error:
            refused = error
            continue
        assert isinstance(case, Drive)
        return case
    raise refused


def _require_one_road(problem: Problem) -> None:
    """Refuse keys that let a realised road be another one: there would be no way from one value to the next."""
    if not _realised(problem.plan.tables.get("roughness", {})):
        return
    variants, middle = problem.plan.variants, problem.named([key.at(0.5) for key in problem.keys])
    for key in problem.keys:
        stations = []
        for end in (key.low, key.high):
            with suppress(ValueError):  # an impossible case is none
                case = variants.at({**middle, **dict.fromkeys(key.paths, end)}).case
                assert isinstance(case, Drive)
                stations.append(case.road.profile.stations)
        if len(stations) == 2 and not np.array_equal(stations[0], stations[1]):
            raise ValueError(
                f"{key.name} changes the way of the vehicle, and with it the realised road: the best value would "
                "be that of the roads drawn. Take a profile from a file, or all roads of the spectrum (response "
                "'random', on the command line --random)"
            )


def _realised(table: Any) -> bool:
    """Tell whether a table of roughness, or a part of it, is drawn from a spectrum."""
    if isinstance(table, list):
        return any(map(_realised, table))
    if not isinstance(table, Mapping):
        return False
    kind = ROUGHNESS.kinds.get(str(table.get("kind")))
    if kind is not None and any(key.name == "seed" for key in kind.keys):
        return True
    return any(map(_realised, table.values()))

"""Measures of a result: the usual ones, and all of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import cache, partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import checking
from movingfrf.metrics.comfort import WEIGHTINGS
from movingfrf.metrics.entry import History, Random, Table, peak, rms
from movingfrf.metrics.fatigue import check_random
from movingfrf.metrics.listed import TABLES
from movingfrf.metrics.loads import after, check_coupled
from movingfrf.results.labels import SCHEMAS, Measure, contact_names, listed

if TYPE_CHECKING:
    import xarray as xr


def measures(result: xr.Dataset, *, since: float = 0.0) -> list[Measure]:
    """Measure every contact and degree of freedom, or every observation point.

    Parameters
    ----------
    result : xarray.Dataset
        The coupled response of a vehicle, from `simulate`, `cdfm`, `sim` or `duhamel`; or that to prescribed
        loads, from `moving_loads`, `newmark_loads` or `duhamel_loads`.
    since : float
        Seconds to leave out at the start [s], as in `assess`.

    Returns
    -------
    list of Measure
        Those that `movingfrf run` reports of contact forces [N], deflections [m] and accelerations, weighted ones
        too [m/s² or rad/s²]; of prescribed loads those of the deflection at each observation point [m]. Each says
        its unit and its source; `docs/measures.md` has their definitions.

    Raises
    ------
    ValueError
        If the result is neither of these, or nothing is left of the record.

    References
    ----------
    Dynamic load coefficient: D. Cebon, Handbook of Vehicle-Road Interaction, Swets & Zeitlinger, 1999.
    """
    variables = getattr(result, "data_vars", ())
    if "force" in variables and "deflection" in variables:
        return listed(
            measure
            for point, deflection in zip(result.point.values, after(result, since).deflection.values.T, strict=True)
            for measure in (
                Measure(f"deflection at {point:g} m", "rms", float(rms(deflection)), "m"),
                Measure(f"deflection at {point:g} m", "peak", float(peak(deflection)), "m"),
            )
        )
    history = _as_solved(result, since)
    result = history.whole
    return _everywhere(
        partial(Table.of_history, history=history, usual=True),
        contact=range(result.sizes["contact"]),
        dof=range(result.sizes["dof"]),
    )


class Usual(NamedTuple):
    """A usual measure as tables of many cases have it."""

    place: str  # of what there is one: contact or dof
    words: str  # what it is
    units: str
    value: Callable[[History, int], float | None] | None  # how it is taken of a history


@cache
def usual() -> dict[str, Usual]:
    """Give those that `measures` lists of a vehicle, by what tables of many cases call them."""
    return {
        taken.usual: Usual(
            table.place,
            f"{table.quantity}, {taken.name}".replace("force, ", "contact force, "),
            entry.units.format(unit="m").replace("s²", "s2") + (" or rad/s2" if "{" in entry.units else ""),
            taken.value,
        )
        for table in TABLES
        for entry in table.entries
        if (taken := entry.history) and taken.usual
    }


@cache
def statistics() -> dict[str, Usual]:
    """Give the statistics of a random response of which there is one for each contact or degree of freedom."""
    return {
        name: Usual(label.dims[0], label.long_name, label.units, None)
        for name, label in SCHEMAS["random"].items()
        if label.dims in (("contact",), ("dof",)) and not label.coordinate
    }


def usual_of(history: History, names: Iterable[str]) -> dict[str, FloatArray]:
    """Take usual measures of every contact and degree of freedom.

    Parameters
    ----------
    history : History
        The response of a vehicle, with or without labels.
    names : iterable of str
        Keys of `usual()`.

    Returns
    -------
    dict of str to ndarray, shape (contact,) or (dof,)
        As `measures` has them.
    """
    count = {"contact": len(history.arrays["static_load"]), "dof": len(history.arrays["dof_unit"])}
    found = {}
    for name in names:
        place, *_, value = usual()[name]
        assert value
        found[name] = np.array([value(history, number) for number in range(count[place])], float)
    return found


def _as_solved(result: xr.Dataset, since: float = 0.0) -> History:
    """Check a response; what is measured is taken of it as it was solved."""
    with checking() as check:
        result = check_coupled(check, result, "deflection", "static_deflection")
    return History.of(result, since=since)


def assess(
    result: xr.Dataset,
    *,
    contacts: Sequence[int | str] | int | str | None = None,
    dofs: Sequence[int | str] | int | str | None = None,
    weighting: str = "Wk",
    slope: float | None = None,
    since: float = 0.0,
) -> list[Measure]:
    """Measure a coupled response in every way that the package knows.

    Parameters
    ----------
    result : xarray.Dataset
        The coupled response of a vehicle, from `simulate`, `cdfm`, `sim` or `duhamel`.
    contacts : sequence of int or str, optional
        Numbers or names of the contacts, or one; all by default.
    dofs : sequence of str or int, optional
        Names or numbers of the degrees of freedom, those where people are, or one: what ISO 2631-1 makes of them is
        then noted. All by default, without such notes.
    weighting : str
        Frequency weighting of translations; rotations have We.
    slope : float, optional
        Exponent of an S-N curve; adds the amplitude of the steady cycling, once a second, that would do the same
        damage as each contact force.
    since : float
        Seconds to leave out at the start [s]: there wheels may not have reached the rough road yet, and what they
        roll onto has not built up.

    Returns
    -------
    list of Measure
        Those of `measures` and all others of each contact and degree of freedom and, unless contacts are chosen, of
        each path, each with its unit and its source; `docs/measures.md` has their definitions. A measure without an
        answer is nan, and its note says why. Notes also hold the likely reactions to a weighted rms, and whether
        a limit is exceeded beyond which the rms understates a vibration.

    Raises
    ------
    ValueError
        If the result is none of a vehicle or not finite, there is no such contact, degree of freedom or weighting,
        nothing is left of the record, or a slope is given and the extra `fatigue` is not installed.

    Examples
    --------
    >>> import movingfrf as mf
    >>> car = mf.quarter_car(body_mass=400.0, wheel_mass=40.0, suspension_stiffness=2e4,
    ...                      suspension_damping=1.5e3, tyre_stiffness=2e5)
    >>> hump = mf.bump(height=0.02, width=1.0, at=5.0, length=30.0)
    >>> result = mf.simulate(mf.RigidGuideway(), car, hump, speed=10.0, duration=2.0, blend=0.0)
    >>> [measure.name for measure in mf.assess(result, contacts=[], dofs=["body"])][-2:]
    ['MTVV', 'VDV']
    """
    with checking() as check:
        result = check_coupled(check, result, "deflection", "static_deflection")
        if not check.faults:
            called = contact_names(result)
            at_contacts = range(len(called)) if contacts is None else check.some_of("contacts", contacts, called)
            names = result.dof.values.tolist()
            at_dofs = range(len(names)) if dofs is None else check.some_of("dofs", dofs, names)
        weighting = check.choice("weighting", weighting, WEIGHTINGS)
        if slope is not None:
            slope = check.positive("slope", slope, "1")
    history = History.of(result, weighting=weighting, slope=slope, since=since, judged=dofs is not None)
    return _everywhere(
        partial(Table.of_history, history=history),
        contact=at_contacts,
        path=range(np.unique(result.path.values).size) if contacts is None else (),
        dof=at_dofs,
    )


def random_measures(result: xr.Dataset, *, slope: float | None = None) -> list[Measure]:
    """List the statistics of a random response.

    Parameters
    ----------
    result : xarray.Dataset
        What `random_response` returned.
    slope : float, optional
        Exponent m of an S-N curve; adds the steady amplitude that damages as much as each contact force.

    Returns
    -------
    list of Measure
        Of the contact force, the total load and the deflection of each contact and of the acceleration of each
        degree of freedom, each with its unit and its source; `docs/random.md` and `docs/measures.md` have their
        definitions. An expected peak is the largest value, not the largest magnitude that `measures` calls the
        dynamic peak; a load lifts off where it would turn tensile.

    Raises
    ------
    ValueError
        If the result is none of `random_response`, or the damage for a slope cannot be had; see `spectral_fatigue`.
    """
    with checking() as check:
        check_random(check, result)
        if slope is not None:
            slope = check.positive("slope", slope, "1")
    return _everywhere(
        partial(Table.of_random, random=Random(result=result, slope=slope)),
        contact=range(result.sizes["contact"]),
        dof=range(result.sizes["dof"]),
    )


def _everywhere(take: Callable[..., list[Measure]], **numbers: Iterable[int]) -> list[Measure]:
    """Take the measures of every table at the numbers of its places."""
    return listed(
        measure
        for table in TABLES
        for number in numbers.get(table.place, ())
        for measure in take(table, number=number)
    )

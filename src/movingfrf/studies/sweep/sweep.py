"""Many cases of a scenario: `sweep`."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from movingfrf._basics.checks import checking
from movingfrf._basics.progress import Progress, silent
from movingfrf._basics.undoing import scratch
from movingfrf.results.labels import SCHEMAS, attributes
from movingfrf.scenarios.scenario import Scenario
from movingfrf.scenarios.variants import unit_of
from movingfrf.studies.sweep.chunks import InFolder, InMemory, Kept, cases_of
from movingfrf.studies.sweep.design import Design
from movingfrf.studies.sweep.plan import Plan, plan_of
from movingfrf.studies.sweep.solving import solved
from movingfrf.studies.sweep.workers import carried_on

if TYPE_CHECKING:
    import xarray as xr


def sweep(
    scenario: Scenario | str | Path | Mapping[str, Any],
    axes: Mapping[Any, Any] | Design,
    *,
    measures: Sequence[str] | None = None,
    response: str = "simulate",
    histories: bool = False,
    time_step: float | None = None,
    workers: int = 1,
    store: str | Path | None = None,
    progress: Progress = silent,
) -> xr.Dataset:
    """Solve many cases of a scenario, and measure each.

    Every case is the one that `Scenario.run` computes of the same tables. What does not change from case to case is
    computed once.

    Parameters
    ----------
    scenario : Scenario, str, Path or mapping
        A vehicle on a rough road: a scenario, a file, or its tables as a dict.
    axes : mapping of str, or tuple of str, to sequence, or Design
        What `design` returned, or what varies: values by the dotted path of a key, `run.speed` or
        `vehicle.tyre_stiffness.0`, numbers in lists from zero; keys in a tuple vary together, each value being a
        tuple as long. A whole table (`vehicle`) takes tables, files or, for a vehicle, names of the catalogue.
    measures : sequence of str, optional
        What is asked of each case: `static_load`, `contact_force_rms`, `contact_force_peak`,
        `smallest_contact_force`, `dynamic_load_coefficient`, `static_deflection`, `deflection_rms`,
        `deflection_peak`, `acceleration_rms`, `acceleration_peak`, `weighted_acceleration_rms`; all by default. Of
        random responses their statistics, as `random_response` calls them.
    response : str
        `simulate`, or `random`: the response to all roads of a spectrum, as `random_response` computes it.
    histories : bool
        Whether forces, deflections, motions, accelerations and elevations over time are kept as well, as `simulate`
        has them, in the scenario's steps.
    time_step : float, optional
        Step in time in place of the scenario's [s]. None: as fine as the shortest waves of each case's road need,
        found and recorded, and the scenario's where they cannot be told; what the road shows is in it either way,
        and peaks are found between samples too.
    workers : int
        Processes, each on one thread.
    store : str or Path, optional
        Folder in which solved cases are kept, chunk by chunk: called again, only what is missing is computed.
    progress : callable
        Called with the name of a stage and the fraction of it that is done.

    Returns
    -------
    xarray.Dataset
        Measures over the axes, then contacts or degrees of freedom; `status` says why a case has no answer and is
        empty where it has, `findings` what is to be known of it, `time_step` in what steps it was solved.

    Raises
    ------
    ValueError
        If an axis names nothing or none of its values suits the scenario, a measure is unknown, memory does not
        hold the histories, or the folder holds another sweep.
    OSError
        If the folder cannot be written, or a worker ends before its time.

    Warns
    -----
    ValidityWarning
        If realised roads differ from case to case where their spectrum does not.

    Examples
    --------
    >>> import movingfrf as mf
    >>> tables = {
    ...     "guideway": {"kind": "rigid_guideway"},
    ...     "vehicle": {"kind": "sprung_mass", "mass": 400.0, "stiffness": 2e4, "damping": 1e3},
    ...     "roughness": {"kind": "bump", "height": 0.02, "width": 1.0, "at": 5.0},
    ...     "run": {"speed": 10.0, "duration": 2.0, "blend": 0.0},
    ... }
    >>> found = mf.sweep(tables, {"run.speed": [5.0, 10.0], "vehicle.damping": [1e3, 2e3, 4e3]})
    >>> found.contact_force_peak.dims, found.contact_force_peak.shape
    (('speed', 'damping', 'contact'), (2, 3, 1))
    """
    with checking() as check:
        workers = check.whole("workers", workers, least=1)
    plan = plan_of(scenario, axes, measures=measures, response=response, time_step=time_step, histories=histories)
    with ExitStack() as stack:
        folder = None if store is None else Path(store)
        if folder is None and workers > 1:
            folder = stack.enter_context(scratch())
        kept = swept(plan, folder, workers=workers, progress=progress)
        return gathered(plan, kept)


def swept(
    plan: Plan,
    folder: Path | None,
    *,
    part: tuple[int, int] = (1, 1),
    workers: int = 1,
    cluster: str | None = None,
    progress: Progress = silent,
) -> Kept:
    """Solve what is missing of a sweep.

    Parameters
    ----------
    plan : Plan
        The sweep.
    folder : Path or None
        Where chunks are kept; None: in memory.
    part : tuple of int
        Which part (k, n) of the chunks is solved: every nth, from the kth on.
    workers : int
        Processes.
    cluster : str, optional
        Where a scheduler of dask.distributed listens, whose workers solve the cases in place of this process, if
        there is a folder.
    progress : callable
        Called with the name of a stage and the fraction of it that is done.

    Returns
    -------
    Kept
        All chunks that are there.

    Raises
    ------
    ValueError
        If the folder holds another sweep, or dask.distributed is not installed.
    OSError
        If the folder cannot be written, a worker ends before its time, or no scheduler answers.
    """
    if cluster is not None and folder is not None:
        from movingfrf.studies.sweep.cluster import carried_out_by, scheduler_at

        # Before there is a folder.
        with scheduler_at(cluster) as client:
            stored = InFolder(folder, plan)
            carried_out_by(client, plan, stored, _of_part(part, stored), progress)
        return stored
    kept: Kept = InMemory(plan) if folder is None else InFolder(folder, plan)
    mine = _of_part(part, kept)
    if workers > 1 and folder is not None and len(mine) > 1:
        carried_on(plan, folder, kept, mine, min(workers, len(mine)), progress)
        return kept
    variants = plan.to_solve
    for done, number in enumerate(mine):
        first, last = cases_of(number, plan.axes.cases)

        def told(cases: int, done: int = done, all_of_it: int = last - first) -> None:
            progress("cases", (done + cases / all_of_it) / len(mine))

        told(0)
        kept.put(number, solved(plan, variants, first, last, told))
    return kept


def _of_part(part: tuple[int, int], kept: Kept) -> list[int]:
    """List the chunks of a part that are missing."""
    return [number for number in kept.missing() if number % part[1] == part[0] - 1]


def gathered(plan: Plan, kept: Kept) -> xr.Dataset:
    """Make a table of all cases.

    Parameters
    ----------
    plan : Plan
        The sweep.
    kept : Kept
        All of its chunks.

    Returns
    -------
    xarray.Dataset
        As `sweep` returns it.
    """
    import xarray as xr

    axes, names = plan.axes, plan.axes.names
    cases, shape, dims = axes.cases, axes.shape, axes.dimensions
    chunks = list(kept.all())
    numbers = [np.ravel_multi_index(places, shape) if shape else 0 for places in axes.numbers(0, cases)]

    def laid(values: list[Any], made: np.ndarray) -> np.ndarray:
        """Lay what cases have, in the order in which they were solved, out over the axes."""
        for number, value in zip(numbers, values, strict=True):
            if made.ndim == 1:
                made[number] = value
            else:
                made[number, : len(value)] = value
        return made.reshape(*shape, *made.shape[1:])

    def each(part: str) -> list[Any]:
        return [one for chunk in chunks for one in getattr(chunk, part)]

    variables: dict[str, Any] = {}
    coordinates: dict[str, Any] = {}
    for axis, dimension in zip(axes, dims, strict=True):
        if axis.name:
            coordinates[dimension] = (dimension, np.arange(axis.size), {"long_name": f"number of the {dimension}"})
        for path in axis.paths:
            unit = unit_of(plan.tables, path)
            words = {"long_name": path, "units": unit} if unit else {"long_name": path}
            coordinates[names[path]] = (dimension, _coordinate(axis.along(path)), words)
    places = {plan.way.measures[name].place for name in plan.measures}
    if plan.histories:
        places = {"contact", "dof"}
    widths = {}
    for label, place, part in (
        ("contact_name", "contact", "contacts"),
        ("dof_name", "dof", "dofs"),
        ("dof_unit", "dof", "units"),
    ):
        if place in places:
            called = each(part)
            widths[place] = max(map(len, called), default=0)
            coordinates[place] = (place, np.arange(widths[place]), {"long_name": f"number of the {place}"})
            coordinates[label] = _named(called, widths[place], place, dims, laid)
    for name in plan.measures:
        usual = plan.way.measures[name]
        values = [value for chunk in chunks for value in chunk.values[name]]
        made = laid(values, np.full((cases, widths[usual.place]), np.nan))
        variables[name] = ((*dims, usual.place), made, {"units": usual.units, "long_name": usual.words})
    if plan.histories:
        histories = each("histories")
        most, step = max((len(one["roughness"]) for one in histories if one), default=0), _step(each("steps"))
        coordinates["time"] = ("time", step * np.arange(most), {"units": "s", "long_name": "time"})
        for name in ("contact_force", "deflection", "motion", "acceleration", "roughness"):
            of = SCHEMAS["coupled"][name]
            made = np.full((cases, most, widths[of.dims[1]]), np.nan)
            for number, one in zip(numbers, histories, strict=True):
                if one:
                    values = one[name]
                    made[number, : len(values), : values.shape[1]] = values
            words = {"units": of.units, "long_name": of.long_name}
            # A road may be what varies.
            shown = f"{name}_seen" if name in coordinates else name
            variables[shown] = ((*dims, *of.dims), made.reshape(*shape, *made.shape[1:]), words)
    if plan.response == "simulate" and "time_step" not in coordinates:
        steps = laid(each("steps"), np.full(cases, np.nan))
        variables["time_step"] = (dims, steps, {"units": "s", "long_name": "step in time of what was measured"})
    for name, said in (("status", "why the case has no answer"), ("findings", "what is to be known of the case")):
        variables[name] = (dims, laid(each(name), np.full(cases, "", object)), {"long_name": said})
    settings = attributes(
        "sweep",
        "Measures of many cases",
        scenario=json.dumps(plan.tables),
        axes=json.dumps(plan.axes.told),
        findings=plan.findings,
        **({"design": json.dumps(plan.design)} if plan.design else {}),
    )
    return xr.Dataset(variables, coordinates, settings)


def _step(steps: list[float]) -> float:
    """Step in time of histories [s], the same for all cases that have an answer."""
    return next((step for step in steps if np.isfinite(step)), np.nan)


def _coordinate(values: list[Any]) -> Any:
    """Values along an axis as they can be labelled: tables and lists are numbered."""
    if all(isinstance(value, int | float | str) for value in values):
        return np.array(values, object if isinstance(values[0], str) else None)
    called = [
        value.get("name", value.get("kind", "table")) if isinstance(value, dict) else "values" for value in values
    ]
    return np.array([f"{word} {number}" for number, word in enumerate(called)], object)


def _named(words: list[tuple[str, ...]], width: int, place: str, dims: tuple[str, ...], laid: Any) -> Any:
    """Names of contacts or degrees of freedom: one for all cases where they are the same, or each case its own."""
    there = {each for each in words if each}
    if len(there) <= 1:
        (same,) = there or {("",) * width}
        return (place, np.array(same, object))
    return ((*dims, place), laid(words, np.full((len(words), width), "", object)))

"""What a sweep is, as data: a scenario's tables, axes, measures. Equal plans are equal sweeps."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from movingfrf._basics.arrays import require_memory
from movingfrf._basics.checks import Finding, checking
from movingfrf._basics.remembered import Remembering, remembered
from movingfrf._basics.version import VERSION
from movingfrf._basics.wording import count
from movingfrf.scenarios.scenario import Drive, Scenario
from movingfrf.scenarios.variants import Variants, contents, tables_in
from movingfrf.studies.sweep.axes import Axes, axes_of
from movingfrf.studies.sweep.design import Design
from movingfrf.studies.sweep.ways import Way, ways


@dataclass(frozen=True, slots=True, kw_only=True)
class Plan(Remembering):
    """A sweep before anything of it is computed.

    Parameters
    ----------
    tables : dict
        The scenario.
    folder : Path
        Folder to which paths in it are relative.
    name : str
        Its name.
    axes : Axes
        What varies.
    measures : tuple of str
        What is asked of each case.
    response : str
        How each case is solved: `simulate` or `random`.
    stated : bool
        Whether cases are solved in the scenario's steps in time, or in those that each needs.
    histories : bool
        Whether histories are kept beside measures.
    design : dict
        How samples were drawn, where the axis is one of samples.
    files : dict of str to str
        Files that scenario and axes name, each with letters that change with what it holds.
    """

    tables: dict[str, Any]
    folder: Path
    name: str
    axes: Axes
    measures: tuple[str, ...]
    response: str = "simulate"
    stated: bool = False
    histories: bool = False
    design: dict[str, Any] = field(default_factory=dict)
    files: dict[str, str] = field(default_factory=dict)

    @property
    def told(self) -> dict[str, Any]:
        """All of it in numbers, texts, lists and tables."""
        return {
            "version": VERSION,
            "name": self.name,
            "folder": str(self.folder.resolve()),
            "scenario": self.tables,
            "axes": self.axes.told,
            "measures": list(self.measures),
            "response": self.response,
            "stated": self.stated,
            "histories": self.histories,
            "design": self.design,
            "files": self.files,
        }

    @property
    def text(self) -> str:
        """The same as JSON."""
        return json.dumps(self.told, indent=1) + "\n"

    @classmethod
    def of_text(cls, text: str) -> Plan:
        """Read what `text` says."""
        told = json.loads(text)
        return cls(
            tables=told["scenario"],
            folder=Path(told["folder"]),
            name=told["name"],
            axes=Axes.of_told(told["axes"]),
            measures=tuple(told["measures"]),
            response=told["response"],
            stated=told["stated"],
            histories=told["histories"],
            design=told["design"],
            files=told["files"],
        )

    def require_files(self) -> None:
        """Refuse files that are not there, or hold something else than when the sweep was asked for."""
        there = _files(self.tables, self.axes, self.folder)
        for name, letters in self.files.items():
            if there.get(name) != letters:
                raise ValueError(f"{name} {'holds something else' if name in there else 'is not there'}")

    @property
    def findings(self) -> list[Finding]:
        """What is to be known about the sweep as a whole."""
        if self.response == "random":
            return []
        number = next((number for number in range(len(self.axes)) if self._other_roads(number)), None)
        if number is None:
            return []
        varied = next(path for path in self.axes[number].paths if _moving(path))
        return [
            Finding(
                "other_roads",
                "a realised road follows its journey unless `length` and `origin` [m] in [roughness] say where it "
                f"lies: for another {self.axes.names[varied]} it is another road of the same spectrum, and "
                "differences between cases are the roads' as well; a profile from a file is the same for all",
            )
        ]

    def _other_roads(self, number: int) -> bool:
        """Whether realised roads lie elsewhere, or are longer, at other places along an axis."""
        if not any(map(_moving, self.axes[number].paths)):
            return False

        def some(axis: int) -> list[int]:
            """Give places along an axis that tell of all: the first few and the last [2 to 1000: time only]."""
            size = self.axes[axis].size
            return [*range(min(size, 16)), size - 1]

        # What the road is may vary along another axis.
        whole = next((axis for axis, one in enumerate(self.axes) if "roughness" in one.paths), number)
        variants = self.variants
        for kind in some(whole):
            start = [kind if axis == whole else 0 for axis in range(len(self.axes))]
            lie = [
                variants.roads_at(self.axes.values([*start[:number], place, *start[number + 1 :]]))
                for place in some(number)
            ]
            there = [one for one in lie if one]
            if any(one != there[0] for one in there):
                return True
        return False

    @property
    def way(self) -> Way:
        """How each case is solved and measured."""
        return ways()[self.response]

    @property
    @remembered
    def variants(self) -> Variants:
        """Its scenarios, which remember what they made from the first look on."""
        return Variants(self.tables, self.folder, self.name)

    @property
    @remembered
    def to_solve(self) -> Variants:
        """The same as far as the answer needs them."""
        if self.response != "random":
            return self.variants
        return Variants(_shortened(self.tables), self.folder, self.name)


def plan_of(
    scenario: Scenario | str | Path | Mapping[str, Any],
    axes: Mapping[Any, Any] | Design,
    *,
    measures: Sequence[str] | None = None,
    response: str = "simulate",
    time_step: float | None = None,
    histories: bool = False,
) -> Plan:
    """Check what is asked for before anything is computed.

    Parameters
    ----------
    scenario : Scenario, str, Path or mapping
        A scenario, a file, or its tables.
    axes : mapping or Design
        As `sweep` takes them.
    measures : sequence of str, optional
        Names of measures; None: all.
    response : str
        `simulate` or `random`.
    time_step : float, optional
        Step in place of the scenario's [s]; None: found for each case, unless it varies or histories are kept.
    histories : bool
        Whether histories are kept.

    Returns
    -------
    Plan
        The sweep.

    Raises
    ------
    ValueError
        If a measure is unknown, an axis is none or none of its values suits the scenario, that has no vehicle, or
        histories would not go together or not fit into memory.
    """
    with checking() as check:
        response = check.choice("response", response, ways())
        known = ways()[response].measures
        names = known if measures is None else [measures] if isinstance(measures, str) else measures
        asked = [check.choice("measures", name, known) for name in names]
        if not asked:
            check.refuse("measures", f"must be some of {', '.join(known)}, got none")
        if time_step is not None:
            time_step = check.positive("time_step", time_step, "s")
        if histories and response != "simulate":
            check.refuse("histories", 'are those of response="simulate"; the response to all roads has none')
    spanned = axes_of(axes)
    if histories and "run.time_step" in spanned.paths:
        raise ValueError("run.time_step must not vary where histories are kept: they have one axis of time")
    tables, folder, name = tables_in(scenario)
    if time_step is not None:
        tables = {**tables, "run": {**tables.get("run", {}), "time_step": time_step}}
    found = Plan(
        tables=tables,
        folder=folder,
        name=name,
        axes=spanned,
        measures=tuple(dict.fromkeys(asked)),
        response=response,
        stated=time_step is not None or histories or "run.time_step" in spanned.paths,
        histories=histories,
        design=axes.drawn if isinstance(axes, Design) else {},
        # What they hold is part of the sweep: cases of another content do not go together.
        files=_files(tables, spanned, folder),
    )
    first = _first(found).case
    if not isinstance(first, Drive):
        raise ValueError(f"{name}: prescribed loads are not swept; a vehicle and a road are needed")
    if histories:
        # Forces, deflections and roughness of contacts; motions and accelerations of degrees of freedom.
        channels = 3 * len(first.vehicle.contacts) + 2 * len(first.vehicle.dof_names)
        # As long as the longest: what is shorter is filled up.
        axis = next((axis for axis in spanned if "run.duration" in axis.paths), None)
        said = (
            []
            if axis is None
            else [value for value in axis.along("run.duration") if isinstance(value, int | float)]
        )
        samples = max([first.journey.duration, *said]) / first.journey.time_step
        require_memory(8.0 * channels * samples * spanned.cases, f"histories of {count(spanned.cases, 'case')}")
    return found


def _shortened(tables: dict[str, Any]) -> dict[str, Any]:
    """Let a journey end early where all roads of a spectrum are meant: none need be made as long as it."""
    run = tables.get("run")
    enough = 1.0  # [s; 0.5 to any duration: time only]
    if not isinstance(run, dict) or not isinstance(run.get("duration"), int | float) or run["duration"] <= enough:
        return tables
    steps = run.get("time_step", 1e-3)
    short = isinstance(steps, int | float) and 0.0 < steps < 0.1 * enough
    return {**tables, "run": {**run, "duration": enough}} if short else tables


def _moving(path: str) -> bool:
    """Whether a key says how something travels, or what does."""
    return path.split(".")[0] in ("run", "vehicle")


def _files(tables: Mapping[str, Any], axes: Axes, folder: Path) -> dict[str, str]:
    """Tell the contents of all files of a sweep, by names that are the same wherever it is called from."""
    return contents([tables, *(axis.values for axis in axes)], folder.resolve())


def _first(plan: Plan) -> Scenario:
    """Find a case that is one, from the first on along one axis after the other; or say why the first is none."""
    variants, start = plan.variants, [0] * len(plan.axes)
    try:
        return variants.at(plan.axes.values(start))
    except ValueError as refused:
        first = refused
    for number, axis in enumerate(plan.axes):
        for place in range(1, axis.size):
            try:
                return variants.at(plan.axes.values([*start[:number], place, *start[number + 1 :]]))
            except ValueError:
                continue
    raise first

"""What a sweep is, as data: a scenario's tables, axes, measures. Equal plans are equal sweeps."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from movingfrf._basics.checks import Finding, checking
from movingfrf._basics.version import VERSION
from movingfrf.scenarios.kinds import ROUGHNESS
from movingfrf.scenarios.scenario import Drive, Scenario
from movingfrf.scenarios.variants import Variants, contents, tables_in
from movingfrf.studies.sweep.axes import Axes, axes_of
from movingfrf.studies.sweep.design import Design
from movingfrf.studies.sweep.ways import Way, ways


@dataclass(frozen=True, slots=True, kw_only=True)
class Plan:
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
        table = self.tables.get("roughness", {})
        kind = ROUGHNESS.kinds.get(str(table.get("kind"))) if isinstance(table, dict) else None
        realised = kind is not None and any(key.name == "seed" for key in kind.keys)
        ways = [f"run.{key}" for key in ("speed", "speed_kmh", "duration", "start")]
        varied = [path for path in self.axes.paths if path in ways]
        if not (realised and varied) or self.response == "random":
            return []
        return [
            Finding(
                "other_roads",
                f"a realised road is as long as its journey: for another {self.axes.names[varied[0]]} it is "
                "another road of the same spectrum, and differences between cases are theirs as well; a profile "
                "from a file is the same for all",
            )
        ]

    @property
    def way(self) -> Way:
        """How each case is solved and measured."""
        return ways()[self.response]

    @property
    def variants(self) -> Variants:
        """Its scenarios."""
        return Variants(self.tables, self.folder, self.name)


def plan_of(
    scenario: Scenario | str | Path | Mapping[str, Any],
    axes: Mapping[Any, Any] | Design,
    *,
    measures: Sequence[str] | None = None,
    response: str = "simulate",
    time_step: float | None = None,
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
        Step in place of the scenario's [s].

    Returns
    -------
    Plan
        The sweep.

    Raises
    ------
    ValueError
        If a measure is unknown, an axis is none or none of its values suits the scenario, or that has no vehicle.
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
    spanned = axes_of(axes)
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
        design=axes.drawn if isinstance(axes, Design) else {},
        # What they hold is part of the sweep: cases of another content do not go together.
        files=_files(tables, spanned, folder),
    )
    if not isinstance(_first(found).case, Drive):
        raise ValueError(f"{name}: prescribed loads are not swept; a vehicle and a road are needed")
    return found


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

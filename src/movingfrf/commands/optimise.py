"""The command that finds the best values of keys."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from movingfrf._basics.checks import ValidityWarning
from movingfrf.commands.console import Stages, plain_console, print_findings, print_tables


def optimise(
    file: Path,
    /,
    *,
    over: Annotated[list[str], Parameter(negative=())],
    minimise: str,
    contact: str | None = None,
    dof: str | None = None,
    where: Annotated[list[str] | None, Parameter(negative=())] = None,
    at_random: Annotated[bool, Parameter(name="--random", negative=())] = False,
    starts: int = 3,
    output: Annotated[Path | None, Parameter(alias="-o")] = None,
) -> None:
    """Find the values of keys that make a measure smallest, within limits on others.

    Writes best.toml, the scenario with these values, table.csv, a line for each case that was tried, and
    report.html.

    Parameters
    ----------
    file
        The scenario.
    over
        Between which values a key may be, as vehicle.suspension_damping.0=1e4~2e5; once for each key. Keys that
        have one value have commas between them.
    minimise
        The measure that is to be small, as dynamic_load_coefficient.
    contact
        Number or name of the contact where it is taken; where it is largest by default.
    dof
        The same of a degree of freedom; by default the largest of bodies and seats, without wheels and rotations.
    where
        An upper limit of a measure, as weighted_acceleration_rms=0.5, or at one place as
        weighted_acceleration_rms:cab=0.5; a lower one as smallest_contact_force=2e4~. Once for each.
    at_random
        The response to all roads of the spectrum in place of one of them, as movingfrf random computes it.
    starts
        From how many places the search goes downhill.
    output
        The folder to write into; out/NAME-best beside the scenario by default.
    """
    console = plain_console()
    stages = Stages()
    with stages:
        stages.report("loading", 0.0)
        from movingfrf._basics.output import replacing
        from movingfrf.studies.optimisation.optimise import optimised
        from movingfrf.studies.optimisation.page import findings, render, tables
        from movingfrf.studies.optimisation.problem import problem_of
        from movingfrf.studies.optimisation.words import limits_in
        from movingfrf.studies.sweep.files import as_csv
        from movingfrf.studies.sweep.words import ranges_in

        def place(said: str | None) -> int | str | None:
            return int(said) if said is not None and said.isdecimal() else said

        problem = problem_of(
            file,
            ranges_in(over),
            minimise,
            contact=place(contact),
            dof=place(dof),
            where=limits_in(where or ()),
            response="random" if at_random else "simulate",
        )
        folder = output if output is not None else file.parent / "out" / f"{problem.plan.name}-best"
        with warnings.catch_warnings():
            # Findings are printed; no need to warn of them as well.
            warnings.simplefilter("ignore", ValidityWarning)
            best = optimised(problem, starts=starts, progress=stages.report)
        stages.report("report.html", 0.0)
        text = best.scenario.text
        with replacing(folder) as files:
            files |= {"best.toml": text, "table.csv": as_csv(best.table)}
            files["report.html"] = render(problem, best, f"{problem.plan.name}: best values", text)
    console.print(best.message, soft_wrap=True)
    print_tables(console, tables(problem, best))
    print_findings(console, findings(best))
    for name in ("best.toml", "table.csv", "report.html"):
        console.print(f"wrote {folder / name}", soft_wrap=True)

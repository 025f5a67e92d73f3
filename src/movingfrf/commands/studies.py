"""Commands that take many solutions: the comparison of methods, the paper."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from movingfrf._basics import wording
from movingfrf._basics.checks import ValidityWarning, checking
from movingfrf.commands.console import Stages, listing, plain_console, print_findings, print_tables


def compare(
    file: Path,
    /,
    *,
    methods: str | None = None,
    output: Annotated[Path | None, Parameter(alias="-o")] = None,
    batch: int = 1,
    curve: bool = True,
) -> None:
    """Solve a scenario by several methods; compare their times, memory and errors.

    Writes compare.json and compare.csv (the table), convergence.json and convergence.csv (errors over time for a
    range of steps, times at equal error, how far the converged answer still moves) and report.html.

    Parameters
    ----------
    file
        The scenario.
    methods
        Names with commas between them: moving-frf, moving-frf-fe, moving-frf-fe-plain, duhamel, and with a vehicle
        cdfm, cdfm-window, cdfm-weight, sim, with prescribed loads newmark, newmark-window; the usual ones by
        default. Beside cdfm and newmark stands their variant on a road that travels along.
    output
        The folder to write into; out/NAME-compared beside the scenario by default.
    batch
        Cases that differ by their profile, or by their loads, alone, and share what a method prepares (matrices,
        factorisation, run-in, struck road): the time of one case is told as well.
    curve
        Whether to run all methods over a range of steps as well, which takes most of the time.
    """
    console = plain_console()
    stages = Stages()
    with stages:
        stages.report("loading", 0.0)
        from movingfrf._basics.output import replacing
        from movingfrf.scenarios.reading import read_scenario
        from movingfrf.studies.comparison import files as written
        from movingfrf.studies.comparison.comparison import compare as compared
        from movingfrf.studies.comparison.page import findings, render, tables

        scenario = read_scenario(file)
        folder = output if output is not None else file.parent / "out" / f"{scenario.name}-compared"
        names = None if methods is None else [name.strip() for name in methods.split(",") if name.strip()]
        with replacing(folder) as files:
            found = compared(scenario, names, batch=batch, curve=curve, progress=stages.report)
            stages.report("report.html", 0.0)
            files |= {
                "compare.json": written.as_json(found),
                "compare.csv": written.table_as_csv(found),
                "convergence.json": written.convergence_as_json(found),
                "convergence.csv": written.curve_as_csv(found),
                "report.html": render(found),
            }
    print_tables(console, tables(found))
    print_findings(console, findings(found))
    for name in files:
        console.print(f"wrote {folder / name}", soft_wrap=True)


def paper(
    *,
    output: Annotated[Path, Parameter(alias="-o")] = Path("out/paper"),
    only: str | None = None,
    quick: bool = False,
) -> None:
    """Reproduce the paper on the moving FRF: every figure, table and claim, and whether it holds.

    Writes report.html (one page, opens with the verdict), figures/ (PNG and SVG), tables/ (CSV) and paper.json (all
    numbers). The scenario files ship with the package.

    Parameters
    ----------
    output
        The folder to write into.
    only
        Items with commas between them: 1 to 12, claim1 to claim5; all by default.
    quick
        Everything more coarsely, in less than a minute.
    """
    console = plain_console()
    stages = Stages()
    with stages:
        stages.report("loading", 0.0)
        from movingfrf._basics.output import replacing
        from movingfrf.studies.paper.items import chosen, reproduce
        from movingfrf.studies.paper.report import contents, verdict_table

        names = None if only is None else [name.strip() for name in only.split(",") if name.strip()]
        chosen(names)
        with replacing(output) as files:
            found = reproduce(names, quick=quick, progress=stages.report)
            stages.report("writing", 0.0)
            files |= contents(found, stages.report)
        written = sorted(map(Path, files))
    print_tables(console, [verdict_table(found)])
    for name in written:
        if len(name.parts) == 1:
            console.print(f"wrote {output / name}", soft_wrap=True)
    for folder in sorted({name.parts[0] for name in written if len(name.parts) > 1}):
        number = sum(name.parts[0] == folder for name in written)
        console.print(f"wrote {wording.count(number, 'file')} into {output / folder}", soft_wrap=True)


def sweep(
    file: Path,
    /,
    *,
    over: Annotated[list[str], Parameter(negative=())],
    measures: str | None = None,
    at_random: Annotated[bool, Parameter(name="--random", negative=())] = False,
    samples: int | None = None,
    design: str = "sobol",
    seed: int = 0,
    time_step: float | None = None,
    limit: Annotated[list[str] | None, Parameter(negative=())] = None,
    part: str | None = None,
    workers: int | None = None,
    cluster: str | None = None,
    output: Annotated[Path | None, Parameter(alias="-o")] = None,
) -> None:
    """Solve many cases of a scenario, and measure each.

    Writes report.html, sweep.nc (netCDF) and table.csv, one line a case, into the folder; in its folder chunks lie
    cases that are solved. Called again, it solves what is missing.

    Parameters
    ----------
    file
        The scenario.
    over
        What varies: run.speed=10,20,30, or first:last:count as run.speed=5:35:61, or first:last for whole numbers
        as roughness.seed=0:99, or the files that match, as roughness=profiles/*.csv; once for each axis. Keys that
        vary together have commas between them and their values semicolons:
        vehicle.tyre_stiffness.0,vehicle.tyre_stiffness.1=3e6,4e6;3.5e6,4.5e6.
    measures
        Names with commas between them, as contact_force_rms,dynamic_load_coefficient; all by default.
    at_random
        The response to all roads of the spectrum in place of one of them, as movingfrf random computes it.
    samples
        So many samples in place of all combinations; each --over is a range then, as run.speed=10~30.
    design
        How they are drawn: sobol, latin_hypercube, random, or saltelli, which tells how much is due to which key.
    seed
        Of the samples.
    time_step
        Step in place of the scenario's, in seconds.
    limit
        What a measure is not to pass, in its unit, as dynamic_load_coefficient=0.2, or of one contact or degree of
        freedom weighted_acceleration_rms.body=0.5; the page says where it does. No part of the sweep: others may be
        asked of what is solved.
    part
        Which part of the cases, as 3/64: for jobs of an array. A call without it then solves what is missing, and
        writes the tables.
    workers
        Processes, each on one thread; one by default.
    cluster
        Where a scheduler of dask.distributed listens, as tcp://host:8786, whose workers solve the cases instead;
        needs the extra distributed.
    output
        The folder to write into; out/NAME-sweep beside the scenario by default.
    """
    console = plain_console()
    stages = Stages()
    with stages:
        stages.report("loading", 0.0)
        from movingfrf._basics.netcdf_file import as_netcdf
        from movingfrf._basics.output import replacing
        from movingfrf._basics.toml_file import as_toml
        from movingfrf.studies.sweep.design import design as drawn
        from movingfrf.studies.sweep.files import as_csv
        from movingfrf.studies.sweep.page.limits import limits_in
        from movingfrf.studies.sweep.page.page import answers, render
        from movingfrf.studies.sweep.page.tables import findings, tables
        from movingfrf.studies.sweep.plan import plan_of
        from movingfrf.studies.sweep.sweep import gathered, swept
        from movingfrf.studies.sweep.words import axes_in, part_in, ranges_in

        if workers is not None and cluster is not None:
            raise ValueError("--workers and --cluster exclude each other: a cluster has workers of its own")
        with checking() as check:
            processes = check.whole("--workers", 1 if workers is None else workers, least=1)
        which = (1, 1) if part is None else part_in(part)
        names = None if measures is None else [name.strip() for name in measures.split(",") if name.strip()]
        response = "random" if at_random else "simulate"
        axes = (
            axes_in(over, file.parent)
            if samples is None
            else drawn(ranges_in(over), samples=samples, kind=design, seed=seed)
        )
        plan = plan_of(file, axes, measures=names, response=response, time_step=time_step)
        limits = limits_in(limit or [], plan)
        folder = output if output is not None else file.parent / "out" / f"{plan.name}-sweep"
        kept = swept(plan, folder, part=which, workers=processes, cluster=cluster, progress=stages.report)
        table = None
        if part is None:
            stages.report("writing", 0.0)
            with warnings.catch_warnings():
                # Findings are printed; no need to warn of them as well.
                warnings.simplefilter("ignore", ValidityWarning)
                table = gathered(plan, kept)
            with replacing(folder) as files:
                files |= {"sweep.nc": as_netcdf(table), "table.csv": as_csv(table)}
                stages.report("report.html", 0.0)
                files["report.html"] = render(table, f"{plan.name}: sweep", as_toml(plan.tables), limits)
    if table is None:
        missing = len(kept.missing())
        console.print(f"part {part} is solved; {wording.count(missing, 'chunk')} of other parts not yet")
        return
    cases = table.status.size
    without = int((table.status.values != "").sum())
    console.print(f"{wording.count(cases, 'case')}, {without or 'none'} without an answer")
    print_tables(console, [listing("Answers", answers(table, limits)), *tables(table, limits)])
    print_findings(console, findings(table))
    for name in ("report.html", "sweep.nc", "table.csv"):
        console.print(f"wrote {folder / name}", soft_wrap=True)

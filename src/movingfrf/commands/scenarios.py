"""Commands about scenarios, vehicles and results."""

from __future__ import annotations

import warnings
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from movingfrf._basics.checks import ValidityWarning
from movingfrf.commands.console import (
    Stages,
    hand_out,
    listing,
    measures_in_lines,
    plain_console,
    print_findings,
    print_result,
    print_table,
    with_names,
)

if TYPE_CHECKING:
    from movingfrf.scenarios.scenario import Scenario


def new(file: Path | None = None, /, *, loads: bool = False, force: bool = False) -> None:
    """Write a commented scenario to start from: a half truck on a class A road, or prescribed loads.

    Parameters
    ----------
    file
        The file to write; without it the scenario goes to standard output.
    loads
        Prescribed forces that travel along, instead of a vehicle.
    force
        Replace the file if it exists and differs.
    """
    from movingfrf._basics.output import write_whole
    from movingfrf.scenarios.template import template

    text = template("loads" if loads else "scenario")
    if file is None:
        hand_out(text)
        return
    if file.is_file() and not force and file.read_text(encoding="utf-8", errors="replace") != text:
        raise ValueError(f"{file} exists and differs; choose another name, or --force to replace it")
    write_whole(file, text)
    plain_console().print(f"wrote {file}", soft_wrap=True)


def _read(file: Path, changes: list[str] | None = None) -> Scenario:
    """Read a scenario; what its guideway says of itself is printed with the results, not warned of as well."""
    from movingfrf.scenarios.reading import read_scenario

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ValidityWarning)
        if not changes:
            return read_scenario(file)
        from movingfrf.scenarios.variants import Variants, tables_in
        from movingfrf.studies.sweep.words import values_in

        return Variants(*tables_in(file)).at(values_in(changes))


def check(file: Path, /) -> None:
    """Check a scenario and say what it describes, without solving it.

    Parameters
    ----------
    file
        The scenario.
    """
    from movingfrf._basics.checks import SolveError
    from movingfrf.scenarios.description import described

    found = described(_read(file))
    console = plain_console()
    for heading, lines in found.sections:
        print_table(console, listing(heading, lines))
    if found.remarks:
        print_findings(console, found.remarks)
    if found.refusal:
        raise SolveError(f"{file}: {found.refusal}")
    console.print(f"{file}: in order", soft_wrap=True)


def vehicles(name: str | None = None, /, *, output: Annotated[Path | None, Parameter(alias="-o")] = None) -> None:
    """List the vehicles of the catalogue, or describe one: weight, contacts, natural frequencies, what vibrates.

    Parameters
    ----------
    name
        A vehicle of the catalogue, a file of matrices (.mat, .npz, .toml) or a scenario; all of the catalogue in
        short by default.
    output
        A file, .npz or .mat, to write the vehicle's matrices to.
    """
    from movingfrf._basics.wording import count
    from movingfrf.scenarios.description import described_vehicle
    from movingfrf.scenarios.reading import named_vehicle
    from movingfrf.scenarios.unusual import unusual_vehicle
    from movingfrf.vehicles.catalogue import CATALOGUE
    from movingfrf.vehicles.files import write_vehicle
    from movingfrf.vehicles.vehicle import GRAVITY

    console = plain_console()
    if name is None:
        if output is not None:
            raise ValueError("--output needs the name of a vehicle")
        for one, entry in CATALOGUE.items():
            made = entry.make()
            mass = made.static_loads.sum() / GRAVITY
            console.print(one, style="bold")
            console.print(f"  {entry.summary}", soft_wrap=True)
            console.print(
                f"  {count(len(made.dof_names), 'degree of freedom', 'degrees of freedom')}, "
                f"{count(len(made.contacts), 'contact')}, "
                f"{mass / 1e3:.4g} t, {made.natural_frequencies.min():.3g} to {made.natural_frequencies.max():.3g} "
                f"Hz, damped by {100 * made.damping_ratios.min():.2g} % or more",
                soft_wrap=True,
            )
            console.print(f"  source: {entry.source}", soft_wrap=True)
        console.print('\nin a scenario: [vehicle] kind = "catalogue", name = "half_truck"', soft_wrap=True)
        return
    vehicle = named_vehicle(name)
    if name in CATALOGUE:
        console.print(f"{name}: {CATALOGUE[name].summary}\nsource: {CATALOGUE[name].source}", soft_wrap=True)
    for heading, lines in described_vehicle(vehicle):
        print_table(console, listing(heading, lines))
    if remarks := unusual_vehicle(vehicle):
        print_findings(console, remarks)
    if output is not None:
        write_vehicle(vehicle, output)
        console.print(f"wrote {output}", soft_wrap=True)


def run(
    file: Path,
    /,
    *,
    output: Annotated[Path | None, Parameter(alias="-o")] = None,
    method: str = "moving-frf",
    report: Annotated[bool, Parameter(negative="--no-report")] = True,
    changes: Annotated[list[str] | None, Parameter(name="--set", negative=())] = None,
) -> None:
    """Solve a scenario; write result.nc, summary.json and report.html.

    The three files appear together when everything is done; an earlier result stays until then, and stays if
    the run fails. Other files in the folder are left alone.

    Parameters
    ----------
    file
        The scenario.
    output
        The folder to write into; out/NAME beside the scenario by default.
    method
        How: moving-frf, in the frequency domain, where the road is endless; step by step in time, on a finite road
        as it is and on a stretch that is cut out of an endless one, a vehicle by cdfm (with the road as one system)
        or sim (side by side, contact forces exchanged), prescribed loads by newmark.
    report
        Whether to draw report.html, which takes half the time of a short run. Without it an earlier report goes,
        since it shows another result.
    changes
        Another value of a key, as run.speed=22 or vehicle.tyre_stiffness.0=3e6; once for each.
    """
    console = plain_console()
    stages = Stages()
    with stages:
        stages.report("loading", 0.0)
        import xarray  # noqa: F401

        from movingfrf._basics.netcdf_file import as_netcdf
        from movingfrf._basics.output import replacing
        from movingfrf.metrics.measures import measures
        from movingfrf.reports.result import render
        from movingfrf.reports.ways import way
        from movingfrf.results.files import summary_as_json
        from movingfrf.scenarios.scenario import Drive

        stages.report("scenario", 0.0)
        scenario = _read(file, changes)
        folder = output if output is not None else file.parent / "out" / scenario.name
        with replacing(folder) as files, warnings.catch_warnings():
            # Findings are printed with the results; no need to warn of them as well.
            warnings.simplefilter("ignore", ValidityWarning)
            result = scenario.run(stages.report, method)
            stages.report("measures", 0.0)
            found = measures(result)
            stages.report("result.nc", 0.0)
            files["result.nc"] = as_netcdf(result)
            files["summary.json"] = summary_as_json(result, found)
            files["report.html"] = None
            if report:
                stages.report("report.html", 0.0)
                files["report.html"] = render(
                    result, guideway=scenario.endless, scenario_text=scenario.text, title=scenario.name
                )
    if isinstance(scenario.case, Drive):
        console.print(f"Road: {scenario.case.road.description}", soft_wrap=True)
    console.print(f"Method: {way(result).name}\n", soft_wrap=True)
    print_result(console, result, found)
    print_table(console, stages.table())
    for name in sorted(name for name, content in files.items() if content is not None):
        console.print(f"wrote {folder / name}", soft_wrap=True)


def random(
    file: Path,
    /,
    *,
    exposure: float = 600.0,
    slope: float | None = None,
    output: Annotated[Path | None, Parameter(alias="-o")] = None,
) -> None:
    """Compute the response of a scenario to all roads with its spectrum, without realising one.

    Root mean squares, crossing rates and expected peaks of every response, dynamic load coefficients, how often
    contact would be lost. Writes random.nc, summary.json and report.html.

    Parameters
    ----------
    file
        The scenario; its roughness must have a spectrum, as iso_road has.
    exposure
        Duration for which largest values are expected, in seconds.
    slope
        Exponent of an S-N curve; adds the steady amplitude that damages as much as each contact force.
    output
        The folder to write into; out/NAME-random beside the scenario by default.
    """
    console = plain_console()
    stages = Stages()
    with stages:
        stages.report("loading", 0.0)
        from movingfrf._basics.netcdf_file import as_netcdf
        from movingfrf._basics.output import replacing
        from movingfrf.metrics.measures import random_measures
        from movingfrf.reports.random import drawing_frequencies, paths_in_words, render
        from movingfrf.results.files import summary_as_json

        scenario = _read(file)
        folder = output if output is not None else file.parent / "out" / f"{scenario.name}-random"
        with replacing(folder) as files, warnings.catch_warnings():
            # Findings are printed with the results; no need to warn of them as well.
            warnings.simplefilter("ignore", ValidityWarning)
            response = partial(scenario.at_random, exposure=exposure, progress=stages.report)
            try:
                result = response()
            except ValueError as refused:
                raise ValueError(f"{file}: {refused}") from None
            drawn = response(frequency=drawing_frequencies(result))
            found = random_measures(result, slope=slope)
            files["random.nc"] = as_netcdf(result)
            files["summary.json"] = summary_as_json(result, found)
            stages.report("report.html", 0.0)
            title = f"{scenario.name}: random road"
            files["report.html"] = render(result, found, title=title, scenario=scenario.text, drawn=drawn)
    console.print(f"Spectrum: {result.attrs['spectrum']}; {paths_in_words(result)}\n", soft_wrap=True)
    print_result(console, result, found)
    for name in ("report.html", "random.nc", "summary.json"):
        console.print(f"wrote {folder / name}", soft_wrap=True)


def measure(
    file: Path,
    /,
    *,
    contact: list[int | str] | None = None,
    dof: list[int | str] | None = None,
    weighting: str = "Wk",
    slope: float | None = None,
    since: Annotated[float, Parameter(name="--from")] = 0.0,
    output: Annotated[Path | None, Parameter(alias="-o")] = None,
) -> None:
    """Measure an earlier result: comfort, load on the road, lost contact, fatigue.

    Prints every measure with its unit and the standard or source that defines it, and below them what ISO 2631-1
    makes of the degrees of freedom that were named.

    Parameters
    ----------
    file
        The result.nc of a run.
    contact
        Number or name of a contact; again for another. All by default.
    dof
        Name or number of a degree of freedom, where people are; again for another. All by default.
    weighting
        Frequency weighting of translations: Wk (vertical), Wd (horizontal), Wb (rail), Wf (motion sickness), Wc,
        We, Wj. Rotations have We.
    slope
        Exponent of an S-N curve; adds the steady amplitude that damages as much as each contact force.
    since
        Leave out the first seconds, in which the vehicle runs in.
    output
        A file to write the measures to as well: .json or .csv.
    """
    from movingfrf._basics.output import write_whole
    from movingfrf.metrics.measures import assess
    from movingfrf.results.files import load, measures_as_csv, summary_as_json

    if output is not None and output.suffix not in (".json", ".csv"):
        raise ValueError(f"{output}: must end in .json or .csv")
    result = load(file)
    found = assess(result, contacts=contact, dofs=dof, weighting=weighting, slope=slope, since=since)
    console = plain_console()
    named = with_names(result, found)
    print_table(console, measures_in_lines(named))
    notes = [f"{taken.quantity}, {taken.name}: {taken.note}" for taken in named if taken.note]
    if notes:
        console.print("\nNotes", style="bold")
    for note in notes:
        console.print(f"- {note}", soft_wrap=True)
    if output is not None:
        text = (
            measures_as_csv(found)
            if output.suffix == ".csv"
            else summary_as_json(result.assign_attrs(measured_from=since), found)
        )
        write_whole(output, text)
        console.print(f"wrote {output}", soft_wrap=True)

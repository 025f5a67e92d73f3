"""The command `movingfrf`."""

from __future__ import annotations

import json
import math
import os
import signal
import sys
import textwrap
import time
import warnings
from dataclasses import dataclass
from functools import partial
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeVar

from cyclopts import App, CycloptsError, Parameter
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Table

from movingfrf._basics.checks import ParameterError, SolveError, ValidityWarning
from movingfrf._basics.version import VERSION

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    import xarray as xr

    from movingfrf.reports.tables import Table as TableForReading
    from movingfrf.results.labels import Measure
    from movingfrf.roughness.files import ReadProfile


Number = TypeVar("Number", int, float)

# Exit statuses.
DONE, DEFECT, REFUSED, INTERRUPTED, TERMINATED = 0, 1, 2, 130, 143

# Raised digits and minus signs → as they are typed.
TYPED = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹−", "-0123456789-")

# Columns of the output where there is no terminal; letters of a head on one line, at least; gap between columns.
PIPED, HEAD, GAP = 160, 12, 2

# A computation shorter than this shows no progress [s].
PATIENCE = 1.0

# The most that a stage shows as done.
ALMOST = 0.999

app = App(
    name="movingfrf",
    suppress_keyboard_interrupt=False,
    version=VERSION,
    help="""How vehicles and roads shake each other, computed in the frequency domain.

    A scenario file says which vehicle drives over which road, and how rough it is:

    1. movingfrf new truck.toml writes one to start from, with a comment and a unit on every line
    (--loads: prescribed forces instead of a vehicle).

    2. movingfrf check truck.toml says what it describes: natural frequencies, critical speed, roughness class.
    movingfrf vehicles lists vehicles to take from the catalogue, or describes one.

    3. movingfrf run truck.toml --output out/truck solves it and writes result.nc (netCDF: xarray, MATLAB, ...),
    summary.json and report.html.

    4. movingfrf compare truck.toml --output out/compared solves it by other methods too, stepping in time among
    them, and says how long each takes and how far it is from the converged answer.

    5. movingfrf random truck.toml --output out/random computes the response to all roads with its spectrum, without
    realising one; movingfrf measure out/truck/result.nc gives comfort, load on the road and fatigue of a result.

    6. movingfrf paper --output out/paper reproduces the paper on the moving FRF, figure by figure.

    7. movingfrf profile road.csv describes a measured profile: class, waviness, IRI, what looks odd. movingfrf
    convert road.csv road.nc turns one format into another.

    Exit status: 0 done, 2 refused (a file, a value, a case without an answer), 130 interrupted, 1 a defect.""",
)


@app.command
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
    template = "loads.toml" if loads else "scenario.toml"
    text = files("movingfrf").joinpath("scenarios", "templates", template).read_text(encoding="utf-8")
    if file is None:
        sys.stdout.write(text)
        return
    if file.exists() and not force and file.read_text(encoding="utf-8", errors="replace") != text:
        raise ValueError(f"{file} exists and differs; choose another name, or --force to replace it")
    file.write_text(text, encoding="utf-8")
    _console().print(f"wrote {file}", soft_wrap=True)


@app.command
def check(file: Path, /) -> None:
    """Check a scenario and say what it describes, without solving it.

    Parameters
    ----------
    file
        The scenario.
    """
    from movingfrf.scenarios.description import described, remarks
    from movingfrf.scenarios.reading import read_scenario

    scenario = read_scenario(file)
    console = _console()
    _print_sections(console, described(scenario))
    if noted := remarks(scenario):
        _print_findings(console, noted)
    console.print(f"{file}: in order", soft_wrap=True)


@app.command
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
    from movingfrf.vehicles.catalogue import CATALOGUE
    from movingfrf.vehicles.files import write_vehicle
    from movingfrf.vehicles.vehicle import GRAVITY

    console = _console()
    if name is None:
        if output is not None:
            raise ValueError("--output needs the name of a vehicle")
        for one, entry in CATALOGUE.items():
            made = entry.make()
            mass = made.static_loads.sum() / GRAVITY
            console.print(one, style="bold")
            console.print(f"  {entry.summary}", soft_wrap=True)
            console.print(
                f"  {len(made.dof_names)} degrees of freedom, {count(len(made.contacts), 'contact')}, "
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
    _print_sections(console, described_vehicle(vehicle))
    if output is not None:
        write_vehicle(vehicle, output)
        console.print(f"wrote {output}", soft_wrap=True)


@app.command
def run(file: Path, /, *, output: Annotated[Path | None, Parameter(alias="-o")] = None) -> None:
    """Solve a scenario; write result.nc, summary.json and report.html.

    The three files appear together when everything is done; an earlier result stays until then, and stays if
    the run fails. Other files in the folder are left alone.

    Parameters
    ----------
    file
        The scenario.
    output
        The folder to write into; out/NAME beside the scenario by default.
    """
    console = _console()
    stages = _Stages()
    with stages:
        stages.report("loading", 0.0)
        import matplotlib.figure  # noqa: F401
        import scipy.interpolate  # noqa: F401
        import xarray  # noqa: F401

        from movingfrf.metrics.measures import measures
        from movingfrf.reports.result import render
        from movingfrf.results.files import replacing, save, summary
        from movingfrf.scenarios.reading import read_scenario

        stages.report("scenario", 0.0)
        scenario = read_scenario(file)
        folder = output if output is not None else file.parent / "out" / scenario.name
        with replacing(folder) as temporary, warnings.catch_warnings():
            # Findings are printed with the results; no need to warn of them as well.
            warnings.simplefilter("ignore", ValidityWarning)
            result = scenario.run(stages.report)
            stages.report("measures", 0.0)
            found = measures(result)
            stages.report("result.nc", 0.0)
            save(result, temporary / "result.nc")
            (temporary / "summary.json").write_text(summary(result, found), encoding="utf-8")
            stages.report("report.html", 0.0)
            page = render(result, guideway=scenario.guideway, scenario_text=scenario.text, title=scenario.name)
            (temporary / "report.html").write_text(page, encoding="utf-8")
    if scenario.road is not None:
        console.print(f"Road: {scenario.road.description}\n", soft_wrap=True)
    _print_result(console, result, found)
    console.print(stages.table())
    for name in ("report.html", "result.nc", "summary.json"):
        console.print(f"wrote {folder / name}", soft_wrap=True)


@app.command
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
    console = _console()
    stages = _Stages()
    with stages:
        stages.report("loading", 0.0)
        from movingfrf.metrics.measures import random_measures
        from movingfrf.reports.random import drawing_frequencies, paths, render
        from movingfrf.response.random import random_response
        from movingfrf.results.files import replacing, save, summary
        from movingfrf.scenarios.reading import read_scenario

        scenario = read_scenario(file)
        road = scenario.road
        if road is None or scenario.vehicle is None:
            raise ValueError(f"{file}: prescribed loads have no random road; a vehicle and a spectrum are needed")
        if road.spectrum is None:
            raise ValueError(
                f"{file}: the roughness has no spectrum ({road.description}): it is one road, not all of a kind. "
                "`movingfrf run` computes the response to it. A random road needs a kind with a spectrum, such as "
                "iso_road with the roughness and waviness that `movingfrf check` fits to a measured profile"
            )
        folder = output if output is not None else file.parent / "out" / f"{scenario.name}-random"
        with replacing(folder) as temporary, warnings.catch_warnings():
            # Findings are printed with the results; no need to warn of them as well.
            warnings.simplefilter("ignore", ValidityWarning)
            response = partial(
                random_response,
                scenario.guideway,
                scenario.vehicle,
                road.spectrum,
                speed=scenario.journey.speed,
                coherence=road.coherence,
                exposure=exposure,
                progress=stages.report,
            )
            result = response().assign_attrs(scenario=scenario.text)
            drawn = response(frequency=drawing_frequencies(result))
            found = random_measures(result, slope=slope)
            save(result, temporary / "random.nc")
            (temporary / "summary.json").write_text(summary(result, found), encoding="utf-8")
            stages.report("report.html", 0.0)
            title = f"{scenario.name}: random road"
            page = render(result, found, title=title, scenario=scenario.text, drawn=drawn)
            (temporary / "report.html").write_text(page, encoding="utf-8")
    console.print(f"Spectrum: {result.attrs['spectrum']}; {paths(result)}\n", soft_wrap=True)
    _print_result(console, result, found)
    for name in ("report.html", "random.nc", "summary.json"):
        console.print(f"wrote {folder / name}", soft_wrap=True)


@app.command
def measure(
    file: Path,
    /,
    *,
    contact: list[int] | None = None,
    dof: list[str] | None = None,
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
        Number of a contact; again for another. All by default.
    dof
        Name of a degree of freedom, where people are; again for another. All by default.
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
    from movingfrf.metrics.measures import assess
    from movingfrf.results.files import load, measures_as_csv, summary

    if output is not None and output.suffix not in (".json", ".csv"):
        raise ValueError(f"{output}: must end in .json or .csv")
    result = load(file)
    found = assess(result, contacts=contact, dofs=dof, weighting=weighting, slope=slope, since=since)
    console = _console()
    table = Table(box=None, pad_edge=False)
    for heading, justify in (("", "left"), ("value", "right"), ("unit", "left"), ("by", "left")):
        table.add_column(heading, justify=justify, no_wrap=True, overflow="fold")  # type: ignore[arg-type]
    above = ""
    for taken in found:
        if taken.quantity != above:
            table.add_row(taken.quantity, style="bold")
        units = "" if taken.units == "1" else taken.units
        table.add_row(f"  {taken.name}", _cell(taken), units, taken.standard)
        above = taken.quantity
    console.print(table)
    notes = [f"{taken.quantity}, {taken.name}: {taken.note}" for taken in found if taken.note]
    if notes:
        console.print("\nNotes", style="bold")
    for note in notes:
        console.print(f"- {note}", soft_wrap=True)
    if output is not None:
        text = (
            measures_as_csv(found)
            if output.suffix == ".csv"
            else summary(result.assign_attrs(measured_from=since), found)
        )
        output.write_text(text, encoding="utf-8")
        console.print(f"wrote {output}", soft_wrap=True)


@app.command
def compare(
    file: Path,
    /,
    *,
    methods: str | None = None,
    output: Annotated[Path | None, Parameter(alias="-o")] = None,
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
    curve
        Whether to run all methods over a range of steps as well, which takes most of the time.
    """
    console = _console()
    stages = _Stages()
    with stages:
        stages.report("loading", 0.0)
        from movingfrf.results.files import replacing
        from movingfrf.scenarios.reading import read_scenario
        from movingfrf.studies.comparison import files as written
        from movingfrf.studies.comparison.comparison import compare as compared
        from movingfrf.studies.comparison.page import findings, render, tables

        scenario = read_scenario(file)
        folder = output if output is not None else file.parent / "out" / f"{scenario.name}-compared"
        names = None if methods is None else [name.strip() for name in methods.split(",") if name.strip()]
        with replacing(folder) as temporary:
            found = compared(scenario, names, curve=curve, progress=stages.report)
            stages.report("report.html", 0.0)
            texts = {
                "compare.json": written.as_json(found),
                "compare.csv": written.table_as_csv(found),
                "convergence.json": written.convergence_as_json(found),
                "convergence.csv": written.curve_as_csv(found),
                "report.html": render(found),
            }
            for name, text in texts.items():
                (temporary / name).write_text(text, encoding="utf-8")
    for table in tables(found):
        _print_table(console, table)
    _print_findings(console, findings(found))
    for name in texts:
        console.print(f"wrote {folder / name}", soft_wrap=True)


@app.command
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
    console = _console()
    stages = _Stages()
    with stages:
        stages.report("loading", 0.0)
        from movingfrf.results.files import replacing
        from movingfrf.studies.paper.items import chosen, reproduce
        from movingfrf.studies.paper.report import verdict_table, write

        names = None if only is None else [name.strip() for name in only.split(",") if name.strip()]
        chosen(names)
        with replacing(output) as temporary:
            found = reproduce(names, quick=quick, progress=stages.report)
            stages.report("writing", 0.0)
            write(found, temporary, stages.report)
            written = sorted(file.relative_to(temporary) for file in temporary.rglob("*") if file.is_file())
    _print_table(console, verdict_table(found))
    for name in written:
        if len(name.parts) == 1:
            console.print(f"wrote {output / name}", soft_wrap=True)
    for folder in sorted({name.parts[0] for name in written if len(name.parts) > 1}):
        count = sum(name.parts[0] == folder for name in written)
        console.print(f"wrote {count} files into {output / folder}", soft_wrap=True)


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class ProfileOptions:
    """How a profile is read and what is done to it, in this order; nothing is done that is not asked for.

    Parameters
    ----------
    format
        Format of the file: crg, erd, mat, netcdf, gpx or csv; found from its content by default.
    columns
        Columns to take, names or numbers from 0 with commas between them: the station, then elevations.
    across
        Lateral positions of the paths to take from a grid [m], left positive, with commas: 0.75,-0.75.
    crop_rims
        Leave out what a grid has no elevation for at its rims.
    repair_gaps
        Fill missing elevations by straight lines, in gaps of at most this length [m].
    paths
        Numbers of the paths to take, from 0, with commas between them.
    first
        Take stations from this distance on [m].
    last
        Take stations up to this distance [m].
    spike
        Replace elevations further than this from the median of 1 m around them [m].
    detrend
        Take out a polynomial of this degree, a whole number: 0 the mean, 1 a straight line.
    high_pass
        Take out waves longer than this [m].
    step
        Resample to this step [m].
    repeat_to
        Repeat the profile up to this length [m].
    mirror_to
        Drive the profile forth and back up to this length [m].
    """

    format: str | None = None
    columns: str | None = None
    across: str | None = None
    crop_rims: bool = False
    repair_gaps: float | None = None
    paths: str | None = None
    first: float | None = None
    last: float | None = None
    spike: float | None = None
    # A float, since a command line's 1.5 would be rounded on the way to an int.
    detrend: float | None = None
    high_pass: float | None = None
    step: float | None = None
    repeat_to: float | None = None
    mirror_to: float | None = None

    def profile(self, file: Path) -> ReadProfile:
        """Read a file and do what was asked for; a refused option is named as it was typed."""
        try:
            return self._profile(file)
        except ParameterError as error:
            raise ParameterError(
                [fault._replace(name=f"--{fault.name.replace('_', '-')}") for fault in error.faults]
            ) from None

    def _profile(self, file: Path) -> ReadProfile:
        from movingfrf.roughness.files import ReadProfile, read_profile
        from movingfrf.roughness.preparation import prepared

        if self.detrend is not None and not self.detrend.is_integer():
            raise ValueError(f"--detrend must be a whole number, got {self.detrend:g}")
        columns = [int(word) if word.isdecimal() else word for word in _words(self.columns)]
        found, understood = read_profile(
            file,
            format=self.format,
            columns=columns or None,
            across=_numbers(self.across, "--across", float) or None,
            crop_rims=self.crop_rims,
            repair_gaps=self.repair_gaps,
        )
        ready = prepared(
            found,
            paths=_numbers(self.paths, "--paths", int) or None,
            first=self.first,
            last=self.last,
            spike=self.spike,
            detrend=None if self.detrend is None else int(self.detrend),
            high_pass=self.high_pass,
            step=self.step,
            repeat_to=self.repeat_to,
            mirror_to=self.mirror_to,
        )
        return ReadProfile(ready, understood)


AS_THE_FILE_HAS_IT = ProfileOptions()


@app.command
def profile(
    file: Path,
    /,
    *,
    output: Annotated[Path | None, Parameter(alias="-o")] = None,
    options: ProfileOptions = AS_THE_FILE_HAS_IT,
) -> None:
    """Describe a measured profile: length, step, spectrum and ISO 8608 class, IRI, coherence, and what looks odd.

    With --output it writes profile.html (tables and figures) and profile.json (all numbers) as well.

    Parameters
    ----------
    file
        The profile: OpenCRG, ERD, CSV or other text in columns, MATLAB, netCDF, GPX.
    output
        The folder to write into.
    options
        How it is read and prepared.
    """
    console = _console()
    stages = _Stages()
    with stages:
        stages.report("reading", 0.0)
        from movingfrf.metrics.profile import as_dict, describe_profile
        from movingfrf.reports.profile import render, tables
        from movingfrf.results.files import replacing

        read, understood = options.profile(file)
        found = describe_profile(read, progress=stages.report)
        written = []
        if output is not None:
            stages.report("figures", 0.0)
            texts = {
                "profile.html": render(found, understood=understood, title=file.name),
                "profile.json": json.dumps(as_dict(found, understood), indent=1, ensure_ascii=False) + "\n",
            }
            with replacing(output) as temporary:
                for name, text in texts.items():
                    (temporary / name).write_text(text, encoding="utf-8")
            written = [output / name for name in texts]
    console.print(understood, soft_wrap=True)
    for sentence in read.steps:
        console.print(f"- {sentence}", soft_wrap=True)
    console.print()
    for table in tables(found):
        _print_table(console, table)
    _print_findings(console, list(found.findings))
    for place in written:
        console.print(f"wrote {place}", soft_wrap=True)


@app.command
def convert(
    file: Path,
    target: Path,
    /,
    *,
    encoding: str | None = None,
    force: bool = False,
    options: ProfileOptions = AS_THE_FILE_HAS_IT,
) -> None:
    """Convert a profile from one format to another: CSV, ERD, MATLAB, netCDF, OpenCRG; GPX is only read.

    Parameters
    ----------
    file
        The profile.
    target
        The file to write; its ending tells the format: .csv, .erd, .mat, .nc, .crg.
    encoding
        How numbers are stored: of .crg double, float, long text, short text; of .erd text, float, double.
    force
        Replace the target if it exists.
    options
        How it is read and prepared.
    """
    console = _console()
    stages = _Stages()
    with stages:
        stages.report("reading", 0.0)
        from movingfrf.results.files import replacing
        from movingfrf.roughness.files import writer

        write = writer(target, encoding=encoding)
        if target.exists() and not force:
            raise ValueError(f"{target} exists; choose another name, or --force to replace it")
        read, understood = options.profile(file)
        stages.report("writing", 0.0)
        with replacing(target.parent) as temporary:
            write(read, temporary / target.name)
            written = sorted(part.name for part in temporary.iterdir())
    console.print(understood, soft_wrap=True)
    for sentence in read.steps:
        console.print(f"- {sentence}", soft_wrap=True)
    for name in written:
        console.print(f"wrote {target.parent / name}", soft_wrap=True)


def _words(listed: str | None) -> list[str]:
    """Split a list with commas; empty without one."""
    return [] if listed is None else [word.strip() for word in listed.split(",") if word.strip()]


def _numbers(listed: str | None, option: str, kind: Callable[[str], Number]) -> list[Number]:
    """Read the numbers in a list with commas."""
    try:
        return [kind(word) for word in _words(listed)]
    except ValueError:
        raise ValueError(f"{option} must be numbers with commas between them, got {listed!r}") from None


def _console() -> Console:
    """Console that prints names as they are, whatever brackets or colons they hold."""
    console = Console(highlight=False, markup=False, emoji=False)
    if not console.is_terminal:
        console.width = PIPED
    return console


class _Stages:
    """Shows which stage a computation is in, if it takes long, and remembers how long each took."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self._began = self._since = time.perf_counter()
        self._stage = ""
        terminal = Console(stderr=True)
        self._shows = terminal.is_terminal
        self._display = Progress(
            TextColumn("{task.description}"),
            BarColumn(),
            TimeElapsedColumn(),
            console=terminal,
            transient=True,
        )
        self._task = self._display.add_task("", total=1.0)

    def __enter__(self) -> _Stages:
        return self

    def __exit__(self, *_: object) -> None:
        self.report("", 1.0)
        if self._display.live.is_started:
            self._display.stop()

    def report(self, stage: str, fraction: float) -> None:
        """Note that a stage has got so far."""
        now = time.perf_counter()
        if stage != self._stage:
            if self._stage:
                self.seconds[self._stage] = self.seconds.get(self._stage, 0.0) + now - self._since
            self._stage, self._since = stage, now
        if self._shows and now - self._began > PATIENCE and stage and not self._display.live.is_started:
            self._display.start()
        # A task that is done would stop its clock.
        self._display.update(self._task, description=stage, completed=min(fraction, ALMOST))

    def table(self) -> Table:
        """Time of every stage."""
        table = Table(title="Time", title_justify="left", title_style="bold", show_header=False, box=None)
        for stage, seconds in self.seconds.items():
            table.add_row(stage, f"{seconds:.3f} s")
        return table


def _print_result(console: Console, result: xr.Dataset, found: list[Measure]) -> None:
    """Print measures, one table for all quantities that were measured alike, and findings."""
    quantities: dict[str, list[Measure]] = {}
    for measure in found:
        quantities.setdefault(measure.quantity, []).append(measure)
    tables: dict[tuple[str, ...], dict[str, list[str]]] = {}
    for quantity, taken in quantities.items():
        heads = tuple(_head(measure.name, measure.units) for measure in taken)
        tables.setdefault(heads, {})[quantity] = [_cell(measure) for measure in taken]
    for heads, rows in tables.items():
        _print_columns(console, "", heads, rows)
    _print_findings(console, [finding["message"] for finding in json.loads(result.attrs["findings"])])


def _head(name: str, units: str) -> str:
    """Head of a column; what has no dimension has no unit."""
    return name if units in ("", "1") else f"{name} [{units}]"


def _cell(measure: Measure) -> str:
    """Write a number as it is typed, a dash where there is none."""
    from movingfrf._basics.wording import NEVER, is_never

    if math.isnan(measure.value):
        return "–"
    return f"< {NEVER:g}" if is_never(measure.value, measure.units) else f"{measure.value:.4g}"


def _print_columns(console: Console, corner: str, heads: Sequence[str], rows: Mapping[str, Sequence[str]]) -> None:
    """Print a table; where a console is too narrow for its columns, in pieces below each other."""
    columns: list[tuple[str, list[str]]] = []
    pieces: list[list[int]] = [[]]
    room = console.width - max(map(len, [corner, *rows]))
    left = room
    bodies = list(zip(*rows.values(), strict=True))
    roomy = sum(GAP + max(map(len, [head, *cells])) for head, cells in zip(heads, bodies, strict=True)) <= room
    for number, cells in enumerate(bodies):
        # Where room is short a head may take more lines than one, but no word of it breaks.
        widest = max(HEAD, *map(len, [*heads[number].split(), *cells]))
        lines = [heads[number]] if roomy else textwrap.wrap(heads[number], widest)
        columns.append(("\n".join(lines), list(cells)))
        width = GAP + max(map(len, [*lines, *cells]))
        if pieces[-1] and width > left:
            pieces.append([])
            left = room
        pieces[-1].append(number)
        left -= width
    for piece in pieces:
        table = Table(box=None, pad_edge=False)
        table.add_column(corner, no_wrap=True, overflow="fold")
        for number in piece:
            table.add_column(columns[number][0], justify="right", no_wrap=True)
        for at, name in enumerate(rows):
            table.add_row(name, *(columns[number][1][at] for number in piece))
        console.print(table)
        console.print()


def _print_sections(console: Console, sections: list[tuple[str, list[tuple[str, str]]]]) -> None:
    """Print headings, each with lines of name and value."""
    for heading, lines in sections:
        table = Table(title=heading, title_justify="left", title_style="bold", show_header=False, box=None)
        for name, value in lines:
            table.add_row(name, value)
        console.print(table)


def _print_findings(console: Console, messages: list[str]) -> None:
    console.print("Findings" if messages else "Findings: none", style="bold")
    for message in messages:
        console.print(f"- {message}", soft_wrap=True)


def _print_table(console: Console, table: TableForReading) -> None:
    """Print a table as the report has it."""
    console.print(table.caption, style="bold")
    heads = [_head(column.name, column.units) for column in table.columns]
    # Powers of ten as they are typed, since a console has no raised digits to speak of.
    rows = {row.name: [cell.replace(" × 10", "e").translate(TYPED) for cell in row.cells] for row in table.rows}
    _print_columns(console, table.corner, heads, rows)


def main(arguments: list[str] | None = None) -> int:
    """Run the command and return its exit status.

    Parameters
    ----------
    arguments : list of str, optional
        What follows the command's name; that of the process by default.

    Returns
    -------
    int
        Exit status.
    """
    try:
        app(arguments, exit_on_error=False, print_error=False, result_action="return_value")
    except KeyboardInterrupt:
        print("movingfrf: interrupted, nothing was written", file=sys.stderr)
        return INTERRUPTED
    except (CycloptsError, ValueError, SolveError) as error:
        print(f"movingfrf: {error}", file=sys.stderr)
        return REFUSED
    except MemoryError:
        print("movingfrf: the case does not fit into the memory of this machine", file=sys.stderr)
        return REFUSED
    except OSError as error:
        place = f"{error.filename}: " if error.filename else ""
        print(f"movingfrf: cannot read or write: {place}{error.strerror or error}", file=sys.stderr)
        return REFUSED
    return DONE


def entry() -> None:
    """Run the command as a process; told to end, it leaves nothing half done."""
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(TERMINATED))
    status = main()
    if status == INTERRUPTED:
        # An interrupt that strikes while a module is being loaded leaves a mark by which Python ends itself with
        # the signal after all, whatever the status.
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)
    sys.exit(status)


if __name__ == "__main__":
    entry()

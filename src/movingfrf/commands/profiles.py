"""Commands about measured profiles."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeVar

from cyclopts import Parameter

from movingfrf._basics.checks import ParameterError
from movingfrf.commands.console import Stages, plain_console, print_findings, print_tables

if TYPE_CHECKING:
    from collections.abc import Callable

    from movingfrf.roughness.files import ReadProfile


Number = TypeVar("Number", int, float)


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
    console = plain_console()
    stages = Stages()
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
    print_tables(console, tables(found))
    print_findings(console, list(found.findings))
    for place in written:
        console.print(f"wrote {place}", soft_wrap=True)


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
    console = plain_console()
    stages = Stages()
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

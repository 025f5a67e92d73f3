"""Commands about measured profiles."""

from __future__ import annotations

import csv
import inspect
import json
from collections.abc import Callable, Sequence
from dataclasses import field, make_dataclass
from functools import partial
from pathlib import Path
from typing import Annotated, Any, NamedTuple

from cyclopts import Parameter

from movingfrf._basics.checks import ParameterError
from movingfrf._basics.documented import documented
from movingfrf.commands.console import Stages, plain_console, print_findings, print_tables
from movingfrf.roughness.files import ReadProfile, naming_formats, read_profile
from movingfrf.roughness.formats.base import ColumnKey
from movingfrf.roughness.preparation import Preparation, read_prepared, read_prepared_pieces


class Typed(NamedTuple):
    """How a value is typed on a command line."""

    kind: Any
    value: Callable[[str, Any], Any]  # option and what was typed → value


def _words(option: str, typed: str) -> list[str]:
    """Split a list with commas; a word that has one itself stands in quotation marks."""
    return [word.strip() for word in next(csv.reader([typed], skipinitialspace=True), []) if word.strip()]


def _columns(option: str, typed: str) -> list[str | int] | None:
    """Read names and numbers of columns."""
    return [int(word) if word.isdecimal() else word for word in _words(option, typed)] or None


def _numbers(kind: type, option: str, typed: str) -> list[int | float] | None:
    """Read the numbers in a list with commas."""
    try:
        return [kind(word) for word in _words(option, typed)] or None
    except ValueError:
        raise ValueError(f"{option} must be numbers with commas between them, got {typed!r}") from None


def _whole(option: str, typed: float) -> int:
    """Take a whole number for one."""
    if not typed.is_integer():
        raise ValueError(f"{option} must be a whole number, got {typed:g}")
    return int(typed)


# Types that are typed as another: a list as text with commas, and a whole number as a float, since a command line's
# 1.5 would be rounded on the way to an int.
TYPED: dict[Any, Typed] = {
    Sequence[ColumnKey] | None: Typed(str | None, _columns),
    Sequence[str] | None: Typed(str | None, lambda option, typed: _words(option, typed) or None),
    Sequence[float] | None: Typed(str | None, partial(_numbers, float)),
    Sequence[int] | None: Typed(str | None, partial(_numbers, int)),
    int | None: Typed(float | None, _whole),
}

# How a profile is read and what is done to it, in this order: the keys of both, with the words of their docstrings.
OPTIONS = {
    name: parameter
    for source in (read_profile, Preparation)
    for name, parameter in inspect.signature(source, eval_str=True).parameters.items()
    if name != "file"
}


def _field(name: str, option: inspect.Parameter) -> tuple[str, Any, Any]:
    """Name, type with its words, and default of an option."""
    kind = TYPED[option.annotation].kind if option.annotation in TYPED else option.annotation
    said = {**documented(read_profile), **documented(Preparation)}[name].words
    commas = " With commas between them." if kind != option.annotation and kind == str | None else ""
    return name, Annotated[kind, Parameter(help=said + commas)], field(default=option.default)


ProfileOptions = Parameter(name="*")(
    make_dataclass(
        "ProfileOptions",
        [_field(*option) for option in OPTIONS.items()],
        namespace={"__module__": __name__},
        frozen=True,
        kw_only=True,
    )
)
AS_THE_FILE_HAS_IT = ProfileOptions()


def read_as_asked(
    file: Path,
    options: ProfileOptions,  # type: ignore[valid-type]
    *,
    keep_gaps: bool = False,
) -> list[ReadProfile]:
    """Read a file, or its pieces, and do what was asked for; a refused option is named as it was typed."""
    asked = {}
    for name, value in vars(options).items():
        typed = TYPED.get(OPTIONS[name].annotation)
        asked[name] = value if typed is None or value is None else typed.value(_as_typed(name), value)
    try:
        return read_prepared_pieces(file, **asked) if keep_gaps else [read_prepared(file, **asked)]
    except ParameterError as error:
        raise ParameterError([fault._replace(name=_as_typed(fault.name)) for fault in error.faults]) from None


def _as_typed(name: str) -> str:
    """Name an option as it is typed."""
    return f"--{name.replace('_', '-')}"


@naming_formats
def profile(
    file: Path,
    /,
    *,
    output: Annotated[Path | None, Parameter(alias="-o")] = None,
    keep_gaps: Annotated[bool, Parameter(negative="")] = False,
    options: ProfileOptions = AS_THE_FILE_HAS_IT,  # type: ignore[valid-type]
) -> None:
    """Describe a measured profile: length, step, spectrum and ISO 8608 class, IRI, coherence, and what looks odd.

    With --output it writes profile.html (tables and figures), profile.json (all numbers) and iri.csv (the roughness
    index of every segment of 20 m and of 100 m) as well.

    Parameters
    ----------
    file
        The profile: {titles}.
    output
        The folder to write into.
    keep_gaps
        Describe the pieces between gaps of a profile: segments that touch a gap have no index.
    options
        How it is read and prepared.
    """
    console = plain_console()
    stages = Stages()
    with stages:
        stages.report("reading", 0.0)
        from movingfrf._basics.output import replacing
        from movingfrf.metrics.profile import as_dict, describe_profile, indices_as_csv
        from movingfrf.reports.profile import render, tables

        pieces = read_as_asked(file, options, keep_gaps=keep_gaps)
        most = 6  # pieces whose sentences are printed
        understood = "\n".join(piece.understood for piece in pieces[:most])
        understood += f"\nand {len(pieces) - most} more pieces" if len(pieces) > most else ""
        found = describe_profile([piece.profile for piece in pieces], progress=stages.report)
        written = []
        if output is not None:
            stages.report("figures", 0.0)
            with replacing(output) as files:
                files["profile.html"] = render(found, understood=understood, title=file.name)
                files["profile.json"] = json.dumps(as_dict(found, understood), indent=1, ensure_ascii=False) + "\n"
                files["iri.csv"] = indices_as_csv(found, file.name)
            written = [output / name for name in files]
    console.print(understood, soft_wrap=True)
    for sentence in found.profile.steps:
        console.print(f"- {sentence}", soft_wrap=True)
    console.print()
    print_tables(console, tables(found))
    print_findings(console, list(found.findings))
    for place in written:
        console.print(f"wrote {place}", soft_wrap=True)


@naming_formats
def convert(
    file: Path,
    target: Path,
    /,
    *,
    encoding: str | None = None,
    force: bool = False,
    options: ProfileOptions = AS_THE_FILE_HAS_IT,  # type: ignore[valid-type]
) -> None:
    """Convert a profile from one format to another: {written titles}; only read: {only read}.

    Parameters
    ----------
    file
        The profile.
    target
        The file to write; its ending tells the format: {written endings} …
    encoding
        How numbers are stored, the first by default: {encodings}.
    force
        Replace the target if it exists.
    options
        How it is read and prepared.
    """
    console = plain_console()
    stages = Stages()
    with stages:
        stages.report("reading", 0.0)
        from movingfrf._basics.output import replacing
        from movingfrf.roughness.files import writer

        made = writer(target, encoding=encoding)
        if target.exists() and not force:
            raise ValueError(f"{target} exists; choose another name, or --force to replace it")
        ((read, understood),) = read_as_asked(file, options)
        stages.report("writing", 0.0)
        with replacing(target.parent) as files:
            files |= made(read)
    console.print(understood, soft_wrap=True)
    for sentence in read.steps:
        console.print(f"- {sentence}", soft_wrap=True)
    for name in files:
        console.print(f"wrote {target.parent / name}", soft_wrap=True)

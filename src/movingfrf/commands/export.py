"""The command that writes results for other programs."""

from __future__ import annotations

from pathlib import Path

from movingfrf.commands.console import plain_console


def export(file: Path, target: Path, /, *, force: bool = False) -> None:
    """Write a result for other programs: a table (.csv), MATLAB (.mat), modal analysis (.uff, extra io).

    A column for each history or spectrum, with its name and unit; .mat holds every variable of the result. The
    result itself is netCDF, which many open as it is.

    Parameters
    ----------
    file
        The result: result.nc of a run, random.nc, or what Python wrote.
    target
        The file to write; its ending tells the kind.
    force
        Replace the target if it exists.
    """
    from movingfrf.results.export import export as write
    from movingfrf.results.files import opened

    write(opened(file), target, force=force)
    plain_console().print(f"wrote {target}", soft_wrap=True)

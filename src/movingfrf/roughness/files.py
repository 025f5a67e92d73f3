"""Profiles from files and into files, whatever their format."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import ParameterError, checking, option, shown, spelt
from movingfrf._basics.output import Content, behind_links, replacing
from movingfrf._basics.wording import count, told_apart
from movingfrf.roughness.formats import columns as text
from movingfrf.roughness.formats import crg, erd, gpx, matlab, netcdf, numpy_file, sheets
from movingfrf.roughness.formats.base import ColumnKey, Format, RawProfile, Wanted
from movingfrf.roughness.profile import Profile, require_profile
from movingfrf.roughness.steps.cropped import cropping, within
from movingfrf.roughness.steps.selected import path_numbers, selecting

Function = TypeVar("Function", bound=Callable[..., Any])

# All formats; text in columns last, since any text might be that.
FORMATS = {
    form.name: form
    for form in (
        crg.FORMAT,
        erd.FORMAT,
        matlab.FORMAT,
        netcdf.FORMAT,
        numpy_file.FORMAT,
        gpx.FORMAT,
        sheets.FORMAT,
        text.FORMAT,
    )
}


def naming_formats(function: Function) -> Function:
    """Put the formats into a docstring, in the place of words in braces, so that it follows from the list."""
    forms = FORMATS.values()
    written = [form for form in forms if form.made]
    said = {
        "{titles}": ", ".join(form.title for form in forms),
        "{names}": ", ".join(form.name for form in forms),
        "{written titles}": ", ".join(form.title for form in written),
        "{written names}": ", ".join(form.name for form in written),
        "{written endings}": ", ".join(form.endings[0] for form in written),
        "{only read}": ", ".join(form.title for form in forms if form not in written),
        "{encodings}": "; ".join(
            f"of {form.name} {', '.join(form.encodings)}" for form in written if any(form.encodings)
        ),
    }
    for words, instead in said.items():
        function.__doc__ = (function.__doc__ or "").replace(words, instead)
    return function


class ReadProfile(NamedTuple):
    """A profile and a sentence about how the file was understood."""

    profile: Profile
    understood: str


@naming_formats
def read_profile(
    file: str | Path,
    *,
    format: str | None = None,
    columns: Sequence[ColumnKey] | None = None,
    recording: str | None = None,
    units: Sequence[str] | None = None,
    speed: float | None = None,
    skip_lines: int | None = None,
    first: float | None = None,
    last: float | None = None,
    across: Sequence[float] | None = None,
    paths: Sequence[int] | None = None,
    crop_rims: bool = False,
    repair_gaps: float | None = None,
) -> ReadProfile:
    r"""Read a profile from a file: {titles}.

    What the file holds is converted to metres; nothing is subtracted, smoothed or filled in unless an option asks
    for it, and then the profile's `steps` say so.

    Parameters
    ----------
    file : str or Path
        The file.
    format : str, optional
        Format of the file: {names}; found from its first bytes, or else its ending.
    columns : sequence of str or int, optional
        The columns, channels or arrays to take: the station, then elevations. Names, or numbers counted from 0. Of
        an ERD file, which has no stations, elevations only.
    recording : str, optional
        Name of the recording to take of a file that holds several: a track or a segment of it, a route, a struct, a
        group, a sheet. They are never joined; without it such a file is refused, with names and lengths.
    units : sequence of str, optional
        Units of the stations and of the elevations, instead of those in the file: "ft", "in".
    speed : float, optional
        Constant speed [m/s] of a record over time, whose times it turns into distances.
    skip_lines : int, optional
        Number of lines at the beginning of a text to leave out, where it is not plain where the table begins.
    first : float, optional
        Distance from which stations are kept [m]; from the beginning by default.
    last : float, optional
        Distance to which stations are kept [m]; to the end by default.
    across : sequence of float, optional
        Lateral positions of the paths to take from a grid [m], left positive; interpolated between its long
        sections. All of these are paths by default, from left to right.
    paths : sequence of int, optional
        Number of each path to take, counted from 0. What these four do not take is not checked either.
    crop_rims : bool
        Whether to leave out what a grid has no elevation for: long sections at either side (unless `across` chooses
        them), then stations at either end.
    repair_gaps : float, optional
        The longest gap that may be filled by a straight line [m], from the last elevation before to the first
        after. Without it a missing elevation is an error.

    Returns
    -------
    ReadProfile
        The profile, and what was understood.

    Raises
    ------
    ValueError
        If the file cannot be read, is not what it seems, lacks elevations, or an option does not suit it; with the
        place in the file where there is one.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "road.csv"
    >>> _ = path.write_text("Station [m];Left [mm]\n0,0;1,5\n0,1;2,5\n0,2;2,0\n0,3;1,0\n")
    >>> profile, understood = read_profile(path)
    >>> profile.elevation.tolist()
    [0.0015, 0.0025, 0.002, 0.001]
    """
    path = Path(file)
    with checking() as check:
        if repair_gaps is not None:
            repair_gaps = check.positive("repair_gaps", repair_gaps, "m")
        wanted = None if across is None else check.array("across", across, "m", (None,))
        if wanted is not None and not check.faults and not wanted.size:
            check.refuse("across", "must name at least one lateral position [m]")
        if columns is not None and not (
            isinstance(columns, (list, tuple)) and all(type(column) in (str, int) for column in columns)
        ):
            check.refuse("columns", f"must be a list of names or numbers of columns, got {shown(columns)}")
        if units is not None and not (
            isinstance(units, (list, tuple)) and len(units) > 1 and all(isinstance(unit, str) for unit in units)
        ):
            check.refuse(
                "units", f"must be a list of units, of the stations and of the elevations, got {shown(units)}"
            )
        if speed is not None:
            speed = check.positive("speed", speed, "m/s")
        if skip_lines is not None:
            skip_lines = check.whole("skip_lines", skip_lines, least=0)
        if not isinstance(crop_rims, bool):
            check.refuse("crop_rims", f"must be true or false, got {shown(crop_rims)}")
        first = first if first is None else check.finite("first", first, "m")
        last = last if last is None else check.finite("last", last, "m")
        if recording is not None:
            recording = check.text("recording", recording)
        if format is not None:
            format = check.choice("format", format, FORMATS)
    try:
        form = _recognised(path, format)
        if recording is not None and not form.several:
            raise ValueError(f"is {form.title}, which holds one recording: {option('recording')} has no choice")
        raw = form.read(path, _understood_by(form, Wanted(columns, recording, units, skip_lines or 0)))
        raw = _at_speed(raw, speed)
        # What is chosen is chosen before anything is checked: what lies outside may be as it likes.
        raw = _cropped(raw, first, last)
        if wanted is not None:
            raw = _on_paths(raw, wanted)
        if crop_rims:
            raw = _cropped_sides(raw) if wanted is None and raw.across is not None else raw
        raw = _selected(raw, paths)
        raw = _completed(_cropped_ends(raw) if crop_rims else raw, repair_gaps)
        profile = Profile(
            raw.stations,
            raw.elevations[:, 0] if raw.same_across else raw.elevations,
            source=f"{path.name} ({raw.source})" if raw.source else path.name,
            steps=raw.steps,
            across=None if raw.across is None else tuple(raw.across.tolist()),
        )
    except ParameterError as error:
        if {fault.name for fault in error.faults} <= {"first", "last", "paths"}:
            raise
        raise ValueError(f"{path}: {error}") from None
    except OSError as error:
        raise ValueError(f"cannot read {path}: {error.strerror or error}") from None
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None
    return ReadProfile(profile, _sentence(path.name, profile, raw))


@naming_formats
def write_profile(
    profile: Profile,
    file: str | Path,
    *,
    format: str | None = None,
    encoding: str | None = None,
) -> None:
    """Write a profile into a file.

    Parameters
    ----------
    profile : Profile
        The road.
    file : str or Path
        The file; replaced if it exists.
    format : str, optional
        {written names}; found from the file's ending.
    encoding : str, optional
        How numbers are stored, the first by default: {encodings}.

    Raises
    ------
    ValueError
        If the format cannot be told, is only read, or cannot hold the profile: `crg` and `erd` need an even step,
        `crg` the lateral position of each of several paths.
    OSError
        If the file cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "road.nc"
    >>> write_profile(Profile([0.0, 1.0, 2.0, 3.0], [0.0, 0.01, 0.0, -0.01]), path)
    >>> read_profile(path).profile.stations.tolist()
    [0.0, 1.0, 2.0, 3.0]
    """
    require_profile(profile)
    path = behind_links(Path(file))
    made = writer(path, format=format, encoding=encoding)(profile)
    with replacing(path.parent) as files:
        files |= made


def writer(
    file: Path, *, format: str | None = None, encoding: str | None = None
) -> Callable[[Profile], dict[str, Content]]:
    """Find what makes a profile's files, by their names, in the format that a file shall have."""
    form = FORMATS.get(spelt(format, FORMATS) or "") if format is not None else _by_ending(file)
    written = [other for other in FORMATS.values() if other.made]
    if form is None and format is not None:
        known = ", ".join(other.name for other in written)
        raise ValueError(f"{file}: there is no format {format!r}; it is one of {known}")
    if form is None or form.made is None:
        why = "its ending does not tell the format" if form is None else f"{form.name} is only read, not written"
        endings = ", ".join(ending for other in written for ending in other.endings)
        raise ValueError(f"{file}: {why}; written are files that end in {endings}")
    if encoding is not None and encoding not in form.encodings:
        known = ", ".join(filter(None, form.encodings)) or "none"
        raise ValueError(f"{file}: {form.name} has no encoding {encoding!r}; it has {known}")
    make, chosen = form.made, encoding if encoding is not None else form.encodings[0]

    def named(profile: Profile) -> dict[str, Content]:
        try:
            return {file.name + ending: content for ending, content in make(profile, chosen).items()}
        except ValueError as error:
            raise ValueError(f"{file}: {error}") from None

    return named


def _by_ending(path: Path) -> Format | None:
    return next((form for form in FORMATS.values() if path.suffix.lower() in form.endings), None)


def _recognised(path: Path, name: str | None) -> Format:
    """Format of a file: the one that was named, or that its first bytes show, or that its ending says."""
    with path.open("rb") as file:
        head = file.read(4096)  # enough to recognise a file
    if name is not None:
        return FORMATS[name]
    ending = _by_ending(path)
    # Signatures before endings: the ending .txt may stand behind anything.
    shown = next((form for form in FORMATS.values() if form.recognises(head)), None)
    if shown is None and ending not in (None, text.FORMAT):
        raise ValueError(f"is not what its ending {path.suffix} says")
    return shown or text.FORMAT


def _understood_by(form: Format, wanted: Wanted) -> Wanted:
    """Refuse what a format does not understand."""
    for name in ("units", "skip_lines"):
        if getattr(wanted, name) and name not in form.takes:
            those = ", ".join(other.title for other in FORMATS.values() if name in other.takes)
            raise ValueError(f"{option(name)} is for {those}, and this is {form.title}")
    return wanted


def _at_speed(raw: RawProfile, speed: float | None) -> RawProfile:
    """Turn times into distances."""
    if not raw.timed and speed is None:
        return raw
    if not raw.timed:
        raise ValueError(f"has distances of its own, so {option('speed')} is not needed")
    if speed is None:
        raise ValueError(
            f"is a record over time ({raw.timed[:40]!r}) without a distance: a profile is elevation over distance; "
            f"{option('speed')} [m/s] turns times into distances, {option('columns')} chooses other columns"
        )
    done = f"turned times into distances at {speed:g} m/s"
    return raw._replace(stations=raw.stations * speed, steps=(*raw.steps, done), timed="")


def _on_paths(raw: RawProfile, across: FloatArray) -> RawProfile:
    """Interpolate a grid at lateral positions."""
    if raw.across is None:
        raise ValueError(f"has no lateral positions, so {option('across')} cannot choose among its paths")
    order = np.argsort(raw.across)
    grid = raw.across[order]
    if grid.size != raw.elevations.shape[1] or not np.isfinite(grid).all() or (np.diff(grid) == 0).any():
        raise ValueError(
            f"must have one lateral position for each path, all different, for {option('across')} to choose from"
        )
    # How far a path may lie outside the grid, and beside a long section, by the rounding of two decimal numbers
    # [m]: rounding is some 1e-15 of metres, and nobody places a path to a micrometre [1e-14 to 1e-6].
    rounding = 1e-9
    outside = (across < grid[0] - rounding) | (across > grid[-1] + rounding)
    if outside.any():
        rightmost, leftmost, asked = told_apart(grid[0], grid[-1], across[outside][0])
        raise ValueError(
            f"reaches from {rightmost} m (right) to {leftmost} m (left), but {option('across')} asks for {asked} m"
        )
    if grid.size == 1:
        return raw._replace(elevations=raw.elevations[:, [0] * across.size], across=across, same_across=False)
    right = np.clip(np.searchsorted(grid, across, side="right") - 1, 0, grid.size - 2)
    share = np.clip((across - grid[right]) / (grid[right + 1] - grid[right]), 0.0, 1.0)
    # On a long section its neighbour does not count, even where that has no elevation.
    share = np.where(np.abs(share - np.round(share)) < rounding, np.round(share), share)
    rights, lefts = raw.elevations[:, order[right]], raw.elevations[:, order[right + 1]]
    elevations = np.where(share == 0, rights, np.where(share == 1, lefts, rights + share * (lefts - rights)))
    return raw._replace(elevations=elevations, across=across, same_across=False)


def _cropped(raw: RawProfile, first: float | None, last: float | None) -> RawProfile:
    """Take the stations from one distance to another, and everything between them."""
    if first is None and last is None:
        return raw
    begin, end = within(raw.stations, first, last)
    return _part(raw, begin, end)._replace(steps=(*raw.steps, cropping(raw.stations, first, last)))


def _selected(raw: RawProfile, paths: Sequence[int] | None) -> RawProfile:
    """Take some of the paths."""
    if paths is None:
        return raw
    numbers = path_numbers(paths, raw.elevations.shape[1])
    return raw._replace(
        elevations=raw.elevations[:, numbers],
        across=None if raw.across is None or raw.across.size != raw.elevations.shape[1] else raw.across[numbers],
        same_across=False,
        steps=(*raw.steps, selecting(numbers)),
    )


def _part(raw: RawProfile, first: int, last: int) -> RawProfile:
    """Take the stations from one number to another, which is not among them."""
    place = raw.place
    return raw._replace(
        stations=raw.stations[first:last],
        elevations=raw.elevations[first:last],
        place=lambda row: place(row + first),
    )


def _cropped_sides(raw: RawProfile) -> RawProfile:
    """Leave out the long sections at the sides of a grid up to the first that is whole."""
    missing = np.isnan(raw.elevations)
    full = np.flatnonzero(~missing.any(axis=0))
    if not full.size:
        raise ValueError(
            f"has no long section with an elevation at every station: choose paths by {option('across')}"
        )
    left, right = int(full[0]), int(full[-1]) + 1
    if (left, right) == (0, missing.shape[1]):
        return raw
    return raw._replace(
        elevations=raw.elevations[:, left:right],
        across=None if raw.across is None else raw.across[left:right],
        steps=(
            *raw.steps,
            f"left out {count(left, 'long section')} at the left rim and {missing.shape[1] - right} at the right",
        ),
    )


def _cropped_ends(raw: RawProfile) -> RawProfile:
    """Leave out the stations at either end that have no elevation on every path."""
    kept = np.flatnonzero(~np.isnan(raw.elevations).any(axis=1))
    if not kept.size:
        raise ValueError("has no station with an elevation on every path")
    first, last, whole = int(kept[0]), int(kept[-1]) + 1, len(raw.elevations)
    if (first, last) == (0, whole):
        return raw
    said = f"left out {count(first, 'station')} at the beginning and {whole - last} at the end"
    return _part(raw, first, last)._replace(steps=(*raw.steps, said))


def _completed(raw: RawProfile, repair_gaps: float | None) -> RawProfile:
    """Fill gaps that may be filled, and refuse what is missing otherwise."""
    bad = np.flatnonzero(~np.isfinite(raw.stations))
    if bad.size:
        raise ValueError(f"{raw.place(int(bad[0]))}: there is no station, got {raw.stations[bad[0]]}")
    falls = np.flatnonzero(np.diff(raw.stations) <= 0)
    if falls.size:
        n = int(falls[0])
        one, next_one = told_apart(raw.stations[n], raw.stations[n + 1])
        raise ValueError(f"{raw.place(n + 1)}: distance must increase, got {one} m followed by {next_one} m")
    beyond = np.argwhere(np.abs(raw.elevations) > 1e20)  # what a profile may hold at most
    if beyond.size:
        row, path = map(int, beyond[0])
        raise ValueError(
            f"{raw.place(row)}: elevation must be finite, got {raw.elevations[row, path]:g} m; what marks "
            "a missing elevation must be left empty in the file"
        )
    gaps = [gap for path in range(raw.elevations.shape[1]) for gap in _gaps(raw, path)]
    if not gaps:
        return raw
    missing = sum(gap.missing for gap in gaps)
    first, longest = gaps[0], max(gaps, key=lambda gap: gap.length)
    if repair_gaps is None:
        raise ValueError(
            f"{raw.place(first.first)}: no elevation {_at(raw, first)}; in all "
            f"{count(missing, 'elevation is', 'elevations are')} missing in {count(len(gaps), 'gap')}, the longest "
            f"{_long(longest)} {_at(raw, longest)}. {option('repair_gaps')} fills gaps up to a length, "
            f"{option('crop_rims')} leaves out the rims of a grid"
        )
    if longest.length > repair_gaps:
        long, allowed = told_apart(longest.length, repair_gaps, digits=4)
        raise ValueError(
            f"{raw.place(longest.first)}: the gap {_at(raw, longest)} is "
            f"{f'{long} m long' if np.isfinite(longest.length) else _long(longest)}, and "
            f"{option('repair_gaps')} allows {allowed} m"
        )
    elevations = raw.elevations.copy()
    for path in {gap.path for gap in gaps}:
        column = elevations[:, path]
        there = ~np.isnan(column)
        column[~there] = np.interp(raw.stations[~there], raw.stations[there], column[there])
    done = (
        f"filled {count(missing, 'missing elevation')} in {count(len(gaps), 'gap')} by straight lines, the longest "
        f"{_long(longest)} "
        f"{_at(raw, longest)}"
    )
    return raw._replace(elevations=elevations, steps=(*raw.steps, done))


class _Gap(NamedTuple):
    """Consecutive stations of one path without an elevation."""

    path: int
    first: int
    missing: int
    length: float  # between the elevations on either side [m]; inf at an end


def _gaps(raw: RawProfile, path: int) -> list[_Gap]:
    missing = np.isnan(raw.elevations[:, path])
    if not missing.any():
        return []
    edges = np.flatnonzero(np.diff(np.concatenate([[False], missing, [False]])))
    bounds = np.concatenate([[-np.inf], raw.stations, [np.inf]])
    return [
        _Gap(path, int(first), int(end - first), float(bounds[end + 1] - bounds[first]))
        for first, end in zip(edges[::2], edges[1::2], strict=True)
    ]


def _long(gap: _Gap) -> str:
    return f"{gap.length:.4g} m long" if np.isfinite(gap.length) else "open, at an end of the profile"


def _at(raw: RawProfile, gap: _Gap) -> str:
    """Say where a gap begins, and on which path."""
    station = f"at {raw.stations[gap.first]:g} m"
    if raw.across is not None:
        return f"{station}, {raw.across[gap.path]:g} m across"
    return station if raw.elevations.shape[1] == 1 else f"{station} on path {gap.path}"


def _sentence(name: str, profile: Profile, raw: RawProfile) -> str:
    stations, elevation = profile.stations, profile.columns
    step = profile.even_step()
    steps = np.diff(stations)
    spacing = f"{step:.4g}" if step is not None else "–".join(told_apart(steps.min(), steps.max(), digits=4))
    first, last = told_apart(stations[0], stations[-1])
    return (
        f"{name}: {stations.size} stations from {first} m to {last} m every {spacing} m, "
        f"{count(profile.paths, 'path')}, elevation {elevation.min():g} to {elevation.max():g} m, {raw.understood}"
    )

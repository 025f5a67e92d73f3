"""What is missing in a file, be it empty or not there at all: refused, filled by straight lines, or left out."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import option
from movingfrf._basics.wording import count, place, told_apart
from movingfrf.roughness.formats.base import RawProfile
from movingfrf.roughness.profile import SLACK
from movingfrf.roughness.sentinels import STANDING


class Gap(NamedTuple):
    """Consecutive stations of one path without an elevation."""

    path: int
    first: int
    missing: int
    length: float  # between the elevations on either side [m]; inf at an end


def completed(raw: RawProfile, longest: float | None) -> RawProfile:
    """Fill gaps that may be filled, and refuse what is missing otherwise.

    Parameters
    ----------
    raw : RawProfile
        What a file holds.
    longest : float or None
        Length up to which gaps are filled [m].

    Returns
    -------
    RawProfile
        With every station and every elevation.

    Raises
    ------
    ValueError
        If stations do not increase, elevations are infinite, or gaps are longer; with the place in the file.
    """
    raw = with_all_stations(raw)
    gaps = gaps_of(raw)
    if not gaps:
        return raw
    most = max(gaps, key=lambda gap: gap.length)
    if longest is None:
        raise ValueError(
            f"{raw.place(gaps[0].first)}: no elevation {_at(raw, gaps[0])}; in all {_counted(raw, gaps)}. "
            f"{option('repair_gaps')} fills gaps up to a length, {option('crop_rims')} leaves out the rims of a "
            f"grid, and `movingfrf profile --keep-gaps` (`read_pieces` in Python) describes what is there"
        )
    # As it is told, so that what the message names is enough.
    if float(f"{most.length:.4g}") > longest * (1 + SLACK):
        long, allowed = told_apart(most.length, longest, digits=4)
        raise ValueError(
            f"{raw.place(most.first)}: the gap {_at(raw, most)} is "
            f"{f'{long} m long' if np.isfinite(most.length) else _long(most)}, and "
            f"{option('repair_gaps')} allows {allowed} m"
        )
    return _filled(raw, gaps)


def whole_pieces(raw: RawProfile, longest: float | None) -> list[RawProfile]:
    """Part a profile at its gaps, on all paths; those that may be filled are.

    Parameters
    ----------
    raw : RawProfile
        What a file holds.
    longest : float or None
        Length up to which gaps are filled [m].

    Returns
    -------
    list of RawProfile
        The pieces of at least four stations; each says how many there are and how much is missing.

    Raises
    ------
    ValueError
        If stations do not increase, elevations are infinite, or there is no piece.
    """
    raw = with_all_stations(raw)
    gaps = gaps_of(raw)
    short = [gap for gap in gaps if longest is not None and gap.length <= longest * (1 + SLACK)]
    raw = _filled(raw, short) if short else raw
    left = [gap for gap in gaps if gap not in short]
    if not left:
        return [raw]
    whole = np.isfinite(raw.elevations).all(axis=1)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], whole, [False]]))).reshape(-1, 2)
    runs = [(int(first), int(end)) for first, end in edges if end - first >= 4]
    if not runs:
        raise ValueError(f"has no four stations in a row with an elevation on every path: {_counted(raw, left)}")
    said = f"parted at gaps: {_counted(raw, left)}; {count(len(runs), 'piece')} of at least 4 stations"
    return [part(raw, first, end)._replace(steps=(*raw.steps, said)) for first, end in runs]


def part(raw: RawProfile, first: int, last: int) -> RawProfile:
    """Take the stations from one number to another, which is not among them."""
    before = raw.place
    return raw._replace(
        stations=raw.stations[first:last],
        elevations=raw.elevations[first:last],
        place=lambda row: before(row + first),
    )


def with_all_stations(raw: RawProfile) -> RawProfile:
    """Check stations, and put those that are missing into holes, without elevations: a hole is a gap like others.

    Raises
    ------
    ValueError
        If stations do not increase or elevations are infinite; with the place in the file.
    """
    bad = np.flatnonzero(~np.isfinite(raw.stations))
    if bad.size:
        raise ValueError(f"{raw.place(int(bad[0]))}: there is no station, got {raw.stations[bad[0]]}")
    steps = np.diff(raw.stations)
    falls = np.flatnonzero(steps <= 0)
    if falls.size:
        n = int(falls[0])
        one, next_one = told_apart(raw.stations[n], raw.stations[n + 1])
        raise ValueError(
            f"{raw.place(n + 1)}: distance must increase, got {one} m followed by {next_one} m{_why(steps)}"
        )
    beyond = np.argwhere(np.abs(raw.elevations) > 1e20)  # what a profile may hold at most
    if beyond.size:
        row, path = map(int, beyond[0])
        raise ValueError(
            f"{raw.place(row)}: elevation must be finite, got {raw.elevations[row, path]:g} m; what marks a "
            f"missing elevation is named by {option('missing')}"
        )
    if steps.size < 2:
        return raw
    holes = np.flatnonzero(steps > STANDING.hole * np.quantile(steps, STANDING.nearly_all))
    if not holes.size:
        return raw
    lacking = np.maximum(np.round(steps[holes] / np.median(steps)) - 1, 1)
    lacking = np.maximum(lacking * min(1.0, STANDING.most_put * steps.size / lacking.sum()), 1).astype(int)
    put = [raw.stations[n] + steps[n] * np.arange(1, k + 1) / (k + 1) for n, k in zip(holes, lacking, strict=True)]
    behind = np.repeat(holes + 1, lacking)
    rows = np.insert(np.arange(raw.stations.size), behind, behind)
    before = raw.place
    return raw._replace(
        stations=np.insert(raw.stations, behind, np.concatenate(put)),
        elevations=np.insert(raw.elevations, behind, np.nan, axis=0),
        place=lambda row: before(int(rows[row])),
    )


def _why(steps: FloatArray) -> str:
    """Say what may be the reason why stations do not increase, and what to do."""
    if (steps < 0).all():
        return f": it falls throughout, and {option('reverse')} turns it round"
    # A fall of some steps is a slip.
    restarts = int((steps < -STANDING.hole * np.quantile(np.abs(steps), STANDING.nearly_all)).sum())
    if restarts:
        return (
            f"; it begins again {count(restarts, 'time')}: recordings one behind the other, which are not "
            "joined, each belong in a file or a sheet of their own"
        )
    return ""


def gaps_of(raw: RawProfile) -> list[Gap]:
    """Find the gaps of all paths, one path after the other."""
    bounds = np.concatenate([[-np.inf], raw.stations, [np.inf]])
    gaps: list[Gap] = []
    for path, column in enumerate(raw.elevations.T):
        missing = np.isnan(column)
        if not missing.any():
            continue
        edges = np.flatnonzero(np.diff(np.concatenate([[False], missing, [False]])))
        gaps += [
            Gap(path, int(first), int(end - first), float(bounds[end + 1] - bounds[first]))
            for first, end in zip(edges[::2], edges[1::2], strict=True)
        ]
    return gaps


def _filled(raw: RawProfile, gaps: list[Gap]) -> RawProfile:
    """Fill gaps by straight lines, and say so."""
    elevations = raw.elevations.copy()
    for path, first, missing, _ in gaps:
        rows, sides = slice(first, first + missing), [first - 1, first + missing]
        elevations[rows, path] = np.interp(raw.stations[rows], raw.stations[sides], elevations[sides, path])
    most = max(gaps, key=lambda gap: gap.length)
    done = (
        f"filled {count(sum(gap.missing for gap in gaps), 'missing elevation')} in {count(len(gaps), 'gap')} by "
        f"straight lines, the longest {_long(most)} {_at(raw, most)}"
    )
    return raw._replace(elevations=elevations, steps=(*raw.steps, done))


def _counted(raw: RawProfile, gaps: list[Gap]) -> str:
    """Say how much is missing."""
    most = max(gaps, key=lambda gap: gap.length)
    missing = count(sum(gap.missing for gap in gaps), "elevation is", "elevations are")
    return f"{missing} missing in {count(len(gaps), 'gap')}, the longest {_long(most)} {_at(raw, most)}"


def _long(gap: Gap) -> str:
    return f"{gap.length:.4g} m long" if np.isfinite(gap.length) else "open, at an end of the profile"


def _at(raw: RawProfile, gap: Gap) -> str:
    """Say where a gap begins, and on which path."""
    station = f"at {place(raw.stations[gap.first])} m"
    if raw.across is not None:
        return f"{station}, {place(raw.across[gap.path])} m across"
    return station if raw.elevations.shape[1] == 1 else f"{station} on path {gap.path}"

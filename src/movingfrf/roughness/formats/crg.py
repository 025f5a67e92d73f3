"""OpenCRG: elevations on a grid along a reference line, straight or curved; behind it PyOpenCRG (extra `io`)."""

from __future__ import annotations

import re
from pathlib import Path, PureWindowsPath
from typing import Any, NamedTuple

import numpy as np

from movingfrf._basics.checks import option
from movingfrf._basics.output import Content
from movingfrf._basics.undoing import scratch
from movingfrf.roughness.formats.base import Format, RawProfile, Wanted, scaled
from movingfrf.roughness.profile import Profile


class Encoding(NamedTuple):
    """How numbers are written."""

    code: str  # that of the standard
    digits: str  # what it keeps, in words


ENCODINGS = {
    "double": Encoding("KDBI", "binary double precision"),
    "float": Encoding("KRBI", "binary single precision"),
    "long text": Encoding("LDFI", "text, double precision"),
    "short text": Encoding("LRFI", "text, single precision"),
}


def read(path: Path, wanted: Wanted) -> RawProfile:
    """Read a grid of elevations; its long sections become paths, from left to right."""
    if wanted.columns is not None:
        raise ValueError(
            f"is a grid: choose its paths by {option('across')}, their lateral positions, not by columns"
        )
    crg = _library()
    grid = _referred(path)
    try:
        # Its own verdicts come as Python warnings and a report; the errors among them are looked at below, as is
        # what is not finite.
        with np.errstate(all="ignore"):
            road = crg.read(path, check=False)
            stations, across = np.array(road.u), np.array(road.v[::-1])
            # Markers stand in the grid, before slope and banking are added.
            absent = np.isnan(scaled(np.array(road.z)[:, ::-1], 1.0, wanted.missing))
            elevations = np.where(absent, np.nan, road.surface_z()[:, ::-1])
    except (OverflowError, ZeroDivisionError, IndexError, KeyError, TypeError, OSError) as error:
        raise ValueError(f"is not an OpenCRG file that can be read: {type(error).__name__}: {error}") from None
    except ValueError as error:
        raise ValueError(str(error).removeprefix(f"{path}: ")) from None
    if road.read_errors:
        raise ValueError(f"is damaged: {'; '.join(map(str, road.read_errors))}")
    if not all(np.isfinite(line).all() for line in (stations, across, road.x, road.y, road.zr)):
        raise ValueError("is damaged: its reference line or the positions of its long sections are not finite")
    words = _words(road, f" of {grid.name!r}, which it refers to" if grid else "", _encoding(grid or path))
    return RawProfile(stations, elevations, words, across=across, source=grid.name if grid else "")


def made(profile: Profile, encoding: str) -> dict[str, Content]:
    """Make a grid along a straight reference line; a road that is the same across becomes a strip 2 m wide."""
    crg = _library()
    step, done = profile.on_grid("an OpenCRG file")
    across = np.array(profile.across if profile.across is not None else ())
    if profile.same_across:
        # A grid has two long sections at least.
        elevation, across = np.repeat(profile.columns, 2, axis=1), np.array([1.0, -1.0])
    elif across.size < 2:
        raise ValueError(
            "an OpenCRG file needs the lateral positions of two paths at least; give the profile `across`"
        )
    else:
        elevation = profile.columns
    order = np.argsort(across)
    notes = [f"source: {profile.source}"] * bool(profile.source) + list(done)
    road = crg.CrgRoad(
        z=elevation[:, order],
        u_inc=step,
        v=across[order],
        u_start=float(profile.stations[0]),
        comments=[" ".join(note.split()).encode("ascii", "replace").decode() for note in notes],
    )
    with scratch() as folder:
        road.save(folder / "road.crg", ENCODINGS[encoding].code)
        return {"": (folder / "road.crg").read_bytes()}


def _library() -> Any:
    try:
        import pyopencrg
    except ImportError:
        raise ValueError("OpenCRG files need PyOpenCRG: pip install PyOpenCRG, or the extra `io`") from None
    return pyopencrg


def _header(path: Path) -> str:
    with path.open("rb") as file:
        # That of a grid with very many long sections ends there at the latest.
        return file.read(2**20).decode("latin-1")


def _encoding(path: Path) -> str:
    found = re.search(r"^#:\s*(\w{4})", _header(path), re.MULTILINE)
    code = found.group(1).upper() if found else ""
    return next((encoding.digits for encoding in ENCODINGS.values() if encoding.code == code), "")


def _referred(path: Path) -> Path | None:
    """File that holds the grid where this one refers to it: one beside it or below, which refers to no other."""
    named = _reference(path)
    if named is None:
        return None
    target = path.parent / named
    if (
        "$" in named
        or PureWindowsPath(named).drive
        or not target.resolve().is_relative_to(path.parent.resolve())
        or target.resolve() == path.resolve()
    ):
        raise ValueError(f"refers to {named!r}, which is not followed: read that file itself")
    if not named or not target.is_file():
        raise ValueError(f"refers to {named!r}, which is not there")
    if (further := _reference(target)) is not None:
        raise ValueError(f"refers to {named!r}, which refers to {further!r} in turn: read that file itself")
    return target


def _reference(path: Path) -> str | None:
    """Name of the file that the header of another refers to, its lines put together; None without a reference."""
    lines = iter(re.split(r"^\${4,}", _header(path), maxsplit=1, flags=re.MULTILINE)[0].splitlines())
    if not any(re.match(r"\$ROAD_CRG_FILE\b", line, re.IGNORECASE) for line in lines):
        return None
    own = []
    for line in lines:
        if line.startswith("$") and not line.startswith("$$"):
            break
        # A comment, the rest of a line behind an exclamation mark, and a dollar that does not begin a block.
        own.append("" if line.startswith("*") else line.removeprefix("$").partition("!")[0].strip())
    return "".join(own)[:200]


def _words(road: Any, of: str, encoding: str) -> str:
    words = [
        f"OpenCRG grid{of} ({encoding}), {road.nv} long sections from {road.v_max:g} m (left) to {road.v_min:g} m "
        "(right)"
    ]
    if not road.is_straight:
        words.append("distance measured along the curved reference line")
    if np.ptp(road.zr) > 0:
        words.append("elevation of the reference line (slope) added")
    if np.any(road.banking != 0):
        words.append("banking added")
    if road.mods:
        words.append(f"modifiers not applied ({', '.join(sorted(road.mods))})")
    words += [f"note: {warning}" for warning in road.read_warnings]
    return ", ".join(words)


def _recognises(head: bytes) -> bool:
    return re.search(rb"^\$(ROAD_CRG|KD_DEFINITION)", head, re.MULTILINE | re.IGNORECASE) is not None


FORMAT = Format("crg", "OpenCRG", (".crg",), _recognises, read, made, tuple(ENCODINGS))

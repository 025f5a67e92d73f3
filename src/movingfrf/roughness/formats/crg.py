"""OpenCRG: elevations on a grid along a reference line, straight or curved; behind it PyOpenCRG (extra `io`)."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from movingfrf._basics.checks import option
from movingfrf.roughness.formats.base import Format, RawProfile, Wanted
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
    try:
        # Its own verdicts come as Python warnings and a report; the errors among them are looked at below, as is
        # what is not finite.
        with np.errstate(all="ignore"):
            road = crg.read(path, check=False)
            stations, across, elevations = np.array(road.u), np.array(road.v[::-1]), road.surface_z()[:, ::-1]
    except (OverflowError, ZeroDivisionError, IndexError, KeyError, TypeError, OSError) as error:
        raise ValueError(f"is not an OpenCRG file that can be read: {type(error).__name__}: {error}") from None
    except ValueError as error:
        raise ValueError(str(error).removeprefix(f"{path}: ")) from None
    if road.read_errors:
        raise ValueError(f"is damaged: {'; '.join(map(str, road.read_errors))}")
    if not all(np.isfinite(line).all() for line in (stations, across, road.x, road.y, road.zr)):
        raise ValueError("is damaged: its reference line or the positions of its long sections are not finite")
    return RawProfile(stations, elevations, _words(road, _encoding(path)), across=across)


def write(profile: Profile, path: Path, encoding: str) -> None:
    """Write a grid along a straight reference line; a road that is the same across becomes a strip 2 m wide."""
    crg = _library()
    step = profile.require_even("an OpenCRG file")
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
    notes = [f"source: {profile.source}"] * bool(profile.source) + list(profile.steps)
    road = crg.CrgRoad(
        z=elevation[:, order],
        u_inc=step,
        v=across[order],
        u_start=float(profile.stations[0]),
        comments=[" ".join(note.split()).encode("ascii", "replace").decode() for note in notes],
    )
    road.save(path, ENCODINGS[encoding].code)


def _library() -> Any:
    try:
        import pyopencrg
    except ImportError:
        raise ValueError("OpenCRG files need PyOpenCRG: pip install 'movingfrf[io]'") from None
    return pyopencrg


def _encoding(path: Path) -> str:
    with path.open("rb") as file:
        # The header of a grid with very many long sections ends there at the latest.
        found = re.search(rb"^#:\s*(\w{4})", file.read(2**20), re.MULTILINE)
    code = found.group(1).decode("latin-1").upper() if found else ""
    return next((encoding.digits for encoding in ENCODINGS.values() if encoding.code == code), "")


def _words(road: Any, encoding: str) -> str:
    words = [
        f"OpenCRG grid ({encoding}), {road.nv} long sections from {road.v_max:g} m (left) to {road.v_min:g} m "
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


FORMAT = Format("crg", "OpenCRG", (".crg",), _recognises, read, write, tuple(ENCODINGS))

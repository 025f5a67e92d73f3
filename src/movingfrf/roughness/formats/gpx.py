"""GPX tracks and routes: latitude, longitude and height of points, turned into distance along and elevation."""

from __future__ import annotations

from array import array
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from xml.parsers import expat

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.wording import count
from movingfrf.roughness.formats.base import (
    Format,
    RawProfile,
    Recording,
    Wanted,
    bytes_of,
    chosen_recording,
    scaled,
    told_apart_by_number,
)


def _numbers() -> array[float]:
    return array("d")


@dataclass(slots=True)
class Line:
    """Points one after the other: a segment of a track, or a route."""

    kind: str  # track or route
    number: int  # of the track or the route
    segment: int  # of the track; 0 of a route
    name: str = ""  # of the track or the route
    latitude: array[float] = field(default_factory=_numbers)
    longitude: array[float] = field(default_factory=_numbers)
    height: array[float] = field(default_factory=_numbers)

    def stations(self) -> FloatArray:
        """Distance of each point from the first [m]."""
        steps = distances(np.array(self.latitude), np.array(self.longitude))
        return np.concatenate([[0.0], np.cumsum(steps)])


class Lines:
    """Collects segments and routes while the file goes by."""

    def __init__(self) -> None:
        self.found: list[Line] = []
        self._open: list[str] = []  # elements that are open
        self._own: list[Line] = []  # of the track or the route that is open
        self._line: Line | None = None
        self._name = ""  # of the track or the route
        self._segment = 0  # of the track
        self._counts = {"track": 0, "route": 0}
        self._place: tuple[float, float] | None = None
        self._height = float("nan")
        self._text = ""

    def begin(self, tag: str, attributes: dict[str, str]) -> None:
        """Note where a track, a segment, a route or a point begins."""
        self._text = ""
        tag = _bare(tag)
        self._open.append(tag)
        match tag:
            case "trk" | "rte":
                self._line, self._own, self._name, self._segment = None, [], "", 0
                self._counts["track" if tag == "trk" else "route"] += 1
            case "trkseg":
                self._line = None
                self._segment += 1
            case "trkpt" | "rtept":
                self._place = (_degrees(attributes, "lat", 90.0), _degrees(attributes, "lon", 180.0))
                self._height = float("nan")

    def text(self, words: str) -> None:
        """Gather the text of an element."""
        self._text += words

    def end(self, tag: str) -> None:
        """Note the name of a track, the height of a point, and a point that is complete."""
        tag = _bare(tag)
        self._open.pop()
        if tag == "ele" and self._place is not None:
            try:
                self._height = float(self._text)
            except ValueError:
                raise ValueError(f"has the height {self._text.strip()[:30]!r}, which is no number") from None
        elif tag in ("trkpt", "rtept") and self._place is not None:
            if self._line is None:
                kind = "track" if tag == "trkpt" else "route"
                self._line = Line(kind, self._counts[kind], self._segment, self._name)
                self.found.append(self._line)
                self._own.append(self._line)
            self._line.latitude.append(self._place[0])
            self._line.longitude.append(self._place[1])
            self._line.height.append(self._height)
            self._place = None
        elif tag == "name" and self._open[-1:] in (["trk"], ["rte"]):
            self._name = self._text.strip()[:100]
            for line in self._own:  # where the name stands behind the points
                line.name = self._name


def read(path: Path, wanted: Wanted) -> RawProfile:
    """Read one segment or route; points that do not lead on are left out, and it says so."""
    if wanted.columns is not None:
        raise ValueError("is a track: it has no columns to choose from")
    lines = _parsed(bytes_of(path)).found
    if not lines:
        raise ValueError("has no points: expected trkpt or rtept with lat, lon and ele")
    names = _names(lines)
    least = 4  # points that make a profile: what has fewer is no recording that anyone would choose
    long = [n for n, line in enumerate(lines) if len(line.height) >= least] or list(range(len(lines)))
    recordings = [
        Recording(names[n], len(lines[n].height), float(lines[n].stations()[-1]))
        for n in (long if wanted.recording is None else range(len(lines)))
    ]
    chosen = chosen_recording(recordings, wanted.recording)
    number = long[chosen] if wanted.recording is None else chosen
    line, name = lines[number], names[number]
    height, along = np.array(line.height), line.stations()
    onward = np.concatenate([[True], np.diff(along) > 0])
    standing = int(np.sum(~onward))
    said = f"{count(standing, 'point')} that {'does' if standing == 1 else 'do'} not lead on left out"
    numbers = np.flatnonzero(onward)
    short = len(lines) - len(long)
    return RawProfile(
        along[onward],
        scaled(height[onward][:, None], 1.0, wanted.missing),
        f"GPX {line.kind} {name!r} of {count(height.size, 'point')}, horizontal distance on the ellipsoid of WGS 84"
        + (f", {said}" if standing else "")
        + (f", {count(short, 'line')} of less than {least} points beside it" if short else ""),
        source=name if line.name else "",
        steps=(said,) if standing else (),
        place=lambda row: f"point {numbers[row] + 1}",
        same_across=True,
    )


def _names(lines: Sequence[Line]) -> list[str]:
    """Names of segments and routes: those of the tracks, with the number of the segment where there are several."""
    segments = Counter((line.kind, line.number) for line in lines)
    names = []
    for line in lines:
        name = line.name or f"{line.kind} {line.number}"
        names.append(name if segments[line.kind, line.number] == 1 else f"{name}, segment {line.segment}")
    return told_apart_by_number(names)


def distances(latitude: FloatArray, longitude: FloatArray) -> FloatArray:
    """Horizontal distances between one point and the next on the ellipsoid of WGS 84.

    Between points near each other the ellipsoid is as good as a cylinder of its two radii of curvature at the mean
    latitude: up to 1 km, away from the poles, the distance is right to some 1e-8 of it.

    Parameters
    ----------
    latitude, longitude : ndarray, shape (point,)
        Place of each point [degree].

    Returns
    -------
    ndarray, shape (point - 1,)
        Distances [m].
    """
    # The ellipsoid of WGS 84: half its equatorial diameter [m] and its squared eccentricity.
    equatorial, eccentricity = 6_378_137.0, 6.694_379_990_141e-3
    phi, lam = np.radians(latitude), np.radians(longitude)
    middle = (phi[1:] + phi[:-1]) / 2
    # The short way round, across the date line too.
    turn = (np.diff(lam) + np.pi) % (2 * np.pi) - np.pi
    curved = 1 - eccentricity * np.sin(middle) ** 2
    northward = equatorial * (1 - eccentricity) / curved**1.5 * np.diff(phi)
    eastward = equatorial / np.sqrt(curved) * np.cos(middle) * turn
    return np.hypot(northward, eastward)


def _parsed(data: bytes) -> Lines:
    track = Lines()
    parser = expat.ParserCreate()
    parser.StartElementHandler = track.begin
    parser.EndElementHandler = track.end
    parser.CharacterDataHandler = track.text
    # Entities are what makes a small file huge, and no track needs them.
    parser.StartDoctypeDeclHandler = _refuse
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        raise ValueError(f"is not XML: {error}") from None
    return track


def _refuse(*_: object) -> None:
    raise ValueError("declares a document type, which a track does not need")


def _bare(tag: str) -> str:
    """Name of an element without the prefix of its namespace."""
    return tag.rpartition(":")[2]


def _degrees(attributes: dict[str, str], key: str, most: float) -> float:
    try:
        value = float(attributes.get(key, ""))
    except ValueError:
        value = float("nan")
    if not abs(value) <= most:
        given = attributes.get(key, "")[:30]
        raise ValueError(f"has a point with {key}={given!r}, which must lie within ±{most:g}")
    return value


def _recognises(head: bytes) -> bool:
    return b"<gpx" in head


FORMAT = Format("gpx", "GPX", (".gpx",), _recognises, read, several=True)

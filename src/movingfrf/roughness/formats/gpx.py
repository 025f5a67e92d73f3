"""GPX tracks: latitude, longitude and height of points, turned into distance along the track and elevation."""

from __future__ import annotations

from array import array
from pathlib import Path
from xml.parsers import expat

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf.roughness.formats.base import Format, RawProfile, Wanted, bytes_of


class GpxTrack:
    """Collects the points of a track while the file goes by."""

    def __init__(self) -> None:
        self.latitude, self.longitude, self.height = array("d"), array("d"), array("d")
        self.name = ""
        self._place: tuple[float, float] | None = None
        self._height = float("nan")
        self._text = ""

    def begin(self, tag: str, attributes: dict[str, str]) -> None:
        """Note where a point begins."""
        self._text = ""
        if _bare(tag) in ("trkpt", "rtept"):
            self._place = (_degrees(attributes, "lat", 90.0), _degrees(attributes, "lon", 180.0))
            self._height = float("nan")

    def text(self, words: str) -> None:
        """Gather the text of an element."""
        self._text += words

    def end(self, tag: str) -> None:
        """Note the height of a point, and a point that is complete."""
        tag = _bare(tag)
        if tag == "ele" and self._place is not None:
            try:
                self._height = float(self._text)
            except ValueError:
                raise ValueError(f"has the height {self._text.strip()[:30]!r}, which is no number") from None
        elif tag in ("trkpt", "rtept") and self._place is not None:
            self.latitude.append(self._place[0])
            self.longitude.append(self._place[1])
            self.height.append(self._height)
            self._place = None
        elif tag == "name" and not self.height and not self.name:
            self.name = self._text.strip()[:100]


def read(path: Path, wanted: Wanted) -> RawProfile:
    """Read a track; points that do not lead on are left out, and it says so."""
    if wanted.columns is not None:
        raise ValueError("is a track: it has no columns to choose from")
    track = _parsed(bytes_of(path))
    if not track.height:
        raise ValueError("has no points: expected trkpt or rtept with lat, lon and ele")
    height = np.array(track.height)
    steps = distances(np.array(track.latitude), np.array(track.longitude))
    onward = np.concatenate([[True], steps > 0])
    stations = np.concatenate([[0.0], np.cumsum(steps)])[onward]
    standing = int(np.sum(~onward))
    said = f"{standing} points that do not lead on left out"
    numbers = np.flatnonzero(onward)
    return RawProfile(
        stations,
        height[onward][:, None],
        f"GPX track {track.name!r} of {height.size} points, horizontal distance on the ellipsoid of WGS 84"
        + (f", {said}" if standing else ""),
        source=track.name,
        steps=(said,) if standing else (),
        place=lambda row: f"point {numbers[row] + 1}",
        same_across=True,
    )


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


def _parsed(data: bytes) -> GpxTrack:
    track = GpxTrack()
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


FORMAT = Format("gpx", "GPX", (".gpx",), _recognises, read)

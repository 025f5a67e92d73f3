"""What contacts that travel together see of a road: in space, hence in time, and wave by wave.

A contact at the distance x sees σ(x) · (E[r](x) − r₀): the elevation r, averaged over its footprint at both of its
cams (E), about the datum r₀, and blended in by σ, which is 0 up to where the foremost contact starts and 1 from
`blend` metres on, so that every contact meets the same road. Its rate of change is v times the slope of that. Of a
wave e^{iκx} the average leaves the share `enveloping`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from movingfrf._basics.arrays import ComplexArray, FloatArray
from movingfrf._basics.enveloping import enveloping
from movingfrf._basics.smooth import smooth_step, smooth_step_slope
from movingfrf.roughness.profile import SLACK, Profile

if TYPE_CHECKING:
    from scipy.interpolate import PPoly

# Samples that are averaged about one level: on the way of so many a road does not climb far [256 to 16 384].
TOGETHER = 4096


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Touch:
    """Contacts that travel together, and what of the road each of them touches.

    Parameters
    ----------
    positions : ndarray, shape (contact,)
        Ahead of the reference point [m].
    paths : sequence of int, length contact
        Path of the profile that each contact follows.
    footprints : ndarray, shape (contact,)
        Length over which each contact averages the profile [m].
    cams : ndarray, shape (contact,)
        Distance between the two points whose mean height it follows [m].
    """

    positions: FloatArray
    paths: Sequence[int]
    footprints: FloatArray
    cams: FloatArray

    def shares(self, wavenumber: FloatArray) -> FloatArray:
        """Share of a wave of the profile [rad/m] that each contact follows, shape (contact, wave)."""
        each = zip(self.footprints, self.cams, strict=True)
        return np.stack([enveloping(wavenumber, footprint, cams) for footprint, cams in each])

    def waves(self, wavenumber: FloatArray) -> ComplexArray:
        """Give what each contact sees of a wave e^{iκx}, the reference point at x = 0; shape (contact, wave)."""
        return self.shares(wavenumber) * np.exp(1j * np.outer(self.positions, wavenumber))


class Along(NamedTuple):
    """One path about its datum, going straight on beyond both ends."""

    datum: float
    level: PPoly

    @classmethod
    def of(cls, profile: Profile, path: int, datum_at: float) -> Along:
        """Prepare one path of a profile."""
        from scipy.interpolate import PPoly

        spline = profile.along(path)
        datum = float(spline(datum_at))
        ends = spline.x[[0, -1]]
        (low, high), (falling, rising) = spline(ends) - datum, spline(ends, 1)
        pieces = np.zeros((4, spline.x.size + 1))
        pieces[:, 1:-1] = spline.c
        pieces[3, 1:-1] -= datum
        pieces[2:, 0], pieces[2:, -1] = (falling, low - falling), (rising, high)
        return cls(datum, PPoly.construct_fast(pieces, np.r_[ends[0] - 1.0, spline.x, ends[1] + 1.0]))

    def seen(self, distance: FloatArray, footprint: float, cams: float, derivative: int = 0) -> FloatArray:
        """Average elevation about the datum [m], or slope [m/m], at ascending distances [m]."""
        if not footprint and not cams:
            found: FloatArray = self.level(distance, derivative)
            return found
        found = np.empty_like(distance)
        for first in range(0, distance.size, TOGETHER):
            some = slice(first, first + TOGETHER)
            found[some] = self._averaged(distance[some], footprint, cams, derivative)
        return found

    def _averaged(self, distance: FloatArray, footprint: float, cams: float, derivative: int) -> FloatArray:
        """Average a stretch of it, counted from where that begins and about the level there.

        The area under a road grows with the road's length and climb, and a difference of two such areas would have
        lost the digits that roughness needs.
        """
        from scipy.interpolate import PPoly

        places, begun, reach = self.level.x, distance[0], 0.5 * (footprint + cams)
        first = max(int(np.searchsorted(places, begun - reach)) - 1, 0)
        last = max(int(np.searchsorted(places, distance[-1] + reach)), first + 1)
        pieces, height = self.level.c[:, first:last].copy(), self.level(begun)
        pieces[3] -= height
        here = PPoly.construct_fast(pieces, places[first : last + 1] - begun)
        # Where it rises, the level is the integral of the slope.
        integral = here if derivative else here.antiderivative()
        at = (distance - begun) + 0.5 * cams * np.array([[-1.0], [1.0]] if cams else [[0.0]])
        half = 0.5 * footprint
        if footprint:
            found: FloatArray = ((integral(at + half) - integral(at - half)) / footprint).mean(axis=0)
        else:
            found = here(at, derivative).mean(axis=0)
        return found if derivative else found + height


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Excitation:
    """A road as contacts see it that travel along it; made by `excite`.

    Parameters
    ----------
    touch : Touch
        The contacts.
    along : dict of int to Along
        The paths they follow.
    start : float
        Distance of the reference point before it has travelled [m].
    blend : float
        Length over which the profile sets in [m]; 0 leaves it as it is.
    """

    touch: Touch
    along: dict[int, Along]
    start: float
    blend: float

    @property
    def datum(self) -> float:
        """Elevation at the foremost contact's start, on its path [m]."""
        return self.along[self.touch.paths[int(self.touch.positions.argmax())]].datum

    def elevation(self, travelled: FloatArray) -> FloatArray:
        """Elevation that each contact sees, about the datum of its path.

        Parameters
        ----------
        travelled : ndarray, shape (time,)
            Distances travelled [m], ascending.

        Returns
        -------
        ndarray, shape (contact, time)
            Elevation [m], positive up.
        """
        seen = np.empty((self.touch.positions.size, travelled.size))
        for row, along, distance, touched, setting_in in self._each(travelled):
            seen[row] = along.seen(distance, *touched)
            seen[row, : setting_in.size] *= smooth_step(setting_in)
        return seen

    def rate(self, travelled: FloatArray, speed: float) -> FloatArray:
        """Rate of change of the elevation that each contact sees, as for `elevation` [m/s]."""
        rate = np.empty((self.touch.positions.size, travelled.size))
        for row, along, distance, touched, setting_in in self._each(travelled):
            rising = along.seen(distance, *touched, derivative=1)
            blending = setting_in.size
            rising[:blending] *= smooth_step(setting_in)
            if blending:
                early = along.seen(distance[:blending], *touched)
                rising[:blending] += early * smooth_step_slope(setting_in) / self.blend
            np.multiply(rising, speed, out=rate[row])
        return rate

    def _each(
        self, travelled: FloatArray
    ) -> Iterator[tuple[int, Along, FloatArray, tuple[float, float], FloatArray]]:
        """Go through the contacts: path, distances, what is touched, how far the profile has set in at first."""
        touch = self.touch
        foremost = self.start + touch.positions.max()
        for row, (position, path) in enumerate(zip(touch.positions, touch.paths, strict=True)):
            distance = travelled + (self.start + position)
            blending = int(np.searchsorted(distance, foremost + self.blend)) if self.blend else 0
            setting_in = (distance[:blending] - foremost) / self.blend if self.blend else distance[:0]
            yield row, self.along[path], distance, (touch.footprints[row], touch.cams[row]), setting_in


def excite(profile: Profile, touch: Touch, *, start: float, distance: float, blend: float) -> Excitation:
    """Let contacts travel along a profile.

    The elevation at the foremost contact's start is the datum, each path's own. A footprint or a cam that reaches
    beyond an end of the profile finds it going straight on there.

    Parameters
    ----------
    profile : Profile
        The road.
    touch : Touch
        The contacts.
    start : float
        Distance of the reference point at t = 0 [m].
    distance : float
        How far it travels [m].
    blend : float
        Length over which the profile sets in [m]; 0 leaves the profile as it is.

    Returns
    -------
    Excitation
        To be asked at any distance travelled.

    Raises
    ------
    ValueError
        If the profile does not cover the journey or lacks a path.
    """
    foremost = start + touch.positions.max()
    require_cover(profile, start + touch.positions.min(), foremost + distance, touch.paths)
    # A profile without columns is the same for all paths.
    column = {path: 0 if profile.same_across else path for path in touch.paths}
    known = {path: Along.of(profile, path, foremost) for path in set(column.values())}
    along = {path: known[column[path]] for path in column}
    return Excitation(touch=touch, along=along, start=start, blend=blend)


def require_cover(profile: Profile, first: float, last: float, paths: Sequence[int]) -> None:
    """Refuse a profile that is shorter than the journey, or lacks a path that a contact follows.

    Parameters
    ----------
    profile : Profile
        The road.
    first, last : float
        First and last distance that a contact meets [m].
    paths : sequence of int
        Paths that the contacts follow.

    Raises
    ------
    ValueError
        With both intervals, or with the missing path.
    """
    stations = profile.stations
    slack = SLACK * (1 + abs(last))
    if stations[0] > first + slack or stations[-1] < last - slack:
        raise ValueError(
            f"the profile must cover the journey from {first:.6g} m to {last:.6g} m, "
            f"but it reaches from {stations[0]:.6g} m to {stations[-1]:.6g} m"
        )
    if not profile.same_across and max(paths) >= profile.paths:
        raise ValueError(
            f"a contact follows path {max(paths)}, but the profile has {profile.paths} path(s), counted from 0; a "
            "profile without columns is the same for all paths"
        )

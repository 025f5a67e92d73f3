"""What contacts that travel together see of a road: in space, hence in time, and wave by wave.

A contact at the distance x sees σ(x) · (E[r](x) − r₀ − g (x − x₀)): the elevation r, averaged over its footprint at
both of its cams (E), about the datum r₀ at x₀, where the foremost contact starts, and about the grade g there, and
blended in by σ, which is 0 up to x₀ and 1 from `blend` metres on, so that every contact meets the same road. Its
rate of change is v times the slope of that. Of a wave e^{iκx} the average leaves the share `enveloping`.

The road goes on past the end of the profile: smoothly, to a level of its own. A contact may be asked for there too.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import ComplexArray, FloatArray
from movingfrf._basics.enveloping import enveloping
from movingfrf._basics.smooth import memory, onward, smooth_step, smooth_step_slope
from movingfrf._basics.spline import Piecewise, cubic
from movingfrf._basics.wording import count, told_apart
from movingfrf.roughness.profile import SLACK, Profile


@dataclass(frozen=True, slots=True, kw_only=True)
class Seeing:
    """What tunes how contacts see a road; in brackets, between what each number is safe."""

    # Samples that are averaged about one level, on the way of which a road does not climb far; and last stations,
    # which tell how a profile goes on.
    together: int = 4096  # [256 to 16 384]
    # Past its end a profile goes on over so many of its last steps at least, over so many times its length at most,
    # in so many cubic pieces.
    fewest: int = 4  # [2 to 16]
    longest: float = 1.0  # [0.1 to 2]
    pieces: int = 64  # [32 to 256]
    # The grade is that of so many metres from the start of the hindmost contact on, as far as the profile reaches:
    # the median of the slopes over half of it, at so many places. What is less than `least`, more on a shorter
    # profile, or than so many times the median deviation of those slopes, is roughness.
    grade_over: float = 100.0  # [m; a convention]
    places: int = 101  # [51 to 1001]
    least: float = 2e-3  # [a convention]
    deviations: float = 2.0  # [a convention]
    # The road sets out over so many metres.
    sets_out: float = 15.0  # [m; a convention]
    # How well the road is guessed past the end of a profile is told from so many guesses before it, which lie so
    # many times the length of a guess apart.
    guesses: int = 15  # [7 to 63]
    apart: float = 4.0  # [1 to 10]


SEEING = Seeing()


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
    """One path about its datum and a grade, straight before its beginning, smooth past its end."""

    spline: Piecewise  # elevation [m]
    datum: float  # [m]
    datum_at: float  # where that is counted from [m]
    grade: float  # [m/m]
    onward: Piecewise  # how it goes on past its end, counted from there [m]
    fades: float  # over how many metres slope and curvature fade from there on

    @classmethod
    def of(cls, spline: Piecewise, datum_at: float, grade: float) -> Along:
        """Prepare one path of a profile."""
        datum, stations = float(spline(datum_at)), spline.x
        # Past the end slope and curvature fade, over a length that adds no frequencies.
        end, slope, curvature = (float(spline(stations[-1], order)) for order in range(3))
        end, slope = end - datum - grade * (float(stations[-1]) - datum_at), slope - grade
        extent = float(stations[-1] - stations[0])
        latest = spline.c[:, -SEEING.together :]
        length = float(memory(latest[2] - grade, 2.0 * latest[1]))
        length = min(max(length, SEEING.fewest * extent / spline.c.shape[1]), SEEING.longest * extent)
        after = np.linspace(0.0, length, SEEING.pieces + 1)
        fading = cubic(after, end + onward(after, slope, curvature, length), first=slope, last=0.0)
        flat = np.zeros((4, 1))
        flat[3] = end
        goes_on = Piecewise(np.append(after, length + 1.0), np.hstack([fading.c, flat]))
        return cls(spline, datum, datum_at, grade, goes_on, length)

    @property
    def ends(self) -> float:
        """Where the profile ends [m]."""
        return float(self.spline.x[-1])

    def level(self, distance: FloatArray | float, order: int = 0) -> FloatArray:
        """Elevation about datum and grade [m], or a derivative of it, within the profile or beyond."""
        places = np.asarray(distance)
        first, last = float(places.min()), float(places.max())
        if first < self.spline.x[0] or last > self.ends:
            return self.between(first, last)(places, order)
        found = self.spline(places, order)
        if order == 0:
            found -= self.datum
            if self.grade:
                found -= self.grade * (places - self.datum_at)
        elif order == 1:
            found -= self.grade
        return found

    def between(self, first: float, last: float) -> Piecewise:
        """Elevation about datum and grade from one place to another [m], within the profile or beyond."""
        stations, count = self.spline.x, self.spline.c.shape[1]
        begin, end = np.searchsorted(stations, [first, last], side="right").tolist()
        begin, end = min(max(begin - 1, 0), count - 1), min(max(end, 1), count)
        places, pieces = stations[begin : end + 1], self.spline.c[:, begin:end].copy()
        pieces[3] -= self.datum + self.grade * (places[:-1] - self.datum_at)
        pieces[2] -= self.grade
        if first < stations[0]:
            straight = np.zeros((4, 1))
            straight[2], straight[3] = pieces[2, 0], pieces[3, 0] - pieces[2, 0]
            places, pieces = np.append(places[0] - 1.0, places), np.hstack([straight, pieces])
        if last > stations[-1]:
            places = np.append(places, stations[-1] + self.onward.x[1:])
            pieces = np.hstack([pieces, self.onward.c])
        return Piecewise(places, pieces)

    def seen(self, distance: FloatArray, footprint: float, cams: float, derivative: int = 0) -> FloatArray:
        """Average elevation about the datum [m], or its slope [m/m], at ascending distances [m]."""
        if not footprint and not cams:
            return self.level(distance, derivative) if distance.size else distance
        found = np.empty_like(distance)
        for first in range(0, distance.size, SEEING.together):
            some = slice(first, first + SEEING.together)
            found[some] = self._averaged(distance[some], footprint, cams, derivative)
        return found

    def doubt(self, reach: float) -> Piecewise:
        """How far guesses past the end of a profile are off, over the distance from there [m].

        Guesses past places within the profile are off from what is there; an axis of guesses comes first.
        """
        last = self.ends - reach
        span = max(min(SEEING.apart * SEEING.guesses * reach, last - float(self.spline.x[0])), 0.0)
        here = last - span * np.linspace(0.0, 1.0, SEEING.guesses)[:, None]
        beyond = np.linspace(0.0, reach, SEEING.pieces + 1)
        guessed = onward(beyond, self.level(here, 1), self.level(here, 2), self.fades)
        off = guessed - (self.level(here + beyond) - self.level(here))
        return cubic(beyond, off, first=0.0)

    def _averaged(self, distance: FloatArray, footprint: float, cams: float, derivative: int) -> FloatArray:
        """Average a stretch of it, counted from where that begins and about the level there.

        The area under a road grows with the road's length and climb, and a difference of two such areas would have
        lost the digits that roughness needs.
        """
        begun, reach = float(distance[0]), 0.5 * (footprint + cams)
        around = self.between(begun - reach, float(distance[-1]) + reach)
        height = float(around(begun))
        around.c[3] -= height
        here = Piecewise(around.x - begun, around.c)
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
    grade : float
        Mean slope of the road at the beginning, about which elevation is counted [m/m].
    slope, sets_out : float
        Mean slope there, be it a grade or roughness, and that of the first metres [m/m].
    station : float
        Distance from station to station of the profile, that of most of them on the journey [m].
    closest : float
        The same where stations are closest [m], though not closer than a thousandth of it.
    guessed : float
        How far beyond the end of the profile a footprint or a cam reaches on the journey [m].
    """

    touch: Touch
    along: dict[int, Along]
    start: float
    blend: float
    grade: float
    slope: float
    sets_out: float
    station: float
    closest: float
    guessed: float

    @property
    def datum(self) -> float:
        """Elevation at the foremost contact's start, on its path [m]."""
        return self.along[self.touch.paths[int(self.touch.positions.argmax())]].datum

    @property
    def slopes(self) -> tuple[float, float, float]:
        """Grade, mean slope where the journey begins, and that of the first metres."""
        return self.grade, self.slope, self.sets_out

    @property
    def settings(self) -> dict[str, float]:
        """What a result says of how its road is counted, by the names of its attributes."""
        return {"datum": self.datum, "grade": self.grade}

    def elevation(self, travelled: FloatArray) -> FloatArray:
        """Elevation that each contact sees, about the datum of its path and the grade.

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

    def doubt(self, travelled: FloatArray) -> FloatArray:
        """How far the elevation under each contact may be off where it reaches past the end of a profile.

        Parameters
        ----------
        travelled : ndarray, shape (time,)
            Distances travelled [m], ascending.

        Returns
        -------
        ndarray, shape (guess, contact, time)
            What several guesses within the profile were off [m].
        """
        doubt = np.zeros((SEEING.guesses, self.touch.positions.size, travelled.size))
        for row, along, distance, (footprint, cams), _ in self._each(travelled):
            reach = 0.5 * (footprint + cams)
            first = int(np.searchsorted(distance, along.ends - reach))
            if reach and first < travelled.size:
                off, past = along.doubt(reach), np.minimum(distance[first:] + reach - along.ends, reach)
                touched = off.antiderivative()(past) / footprint if footprint else off(past)
                doubt[:, row, first:] = touched / (2.0 if cams else 1.0)
        return doubt

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
    beyond the end of the profile finds it going on smoothly there, before its beginning straight.

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
        Length over which the profile sets in [m]; 0 leaves the profile as it is, with its grade.

    Returns
    -------
    Excitation
        To be asked at any distance travelled.

    Raises
    ------
    ValueError
        If the profile does not cover the journey or lacks a path.
    """
    hindmost, foremost = start + touch.positions.min(), start + touch.positions.max()
    require_cover(profile, hindmost, foremost + distance, touch.paths)
    # A profile without columns is the same for all paths.
    column = {path: 0 if profile.same_across else path for path in touch.paths}
    splines = {path: profile.along(path) for path in set(column.values())}
    slope, counts = slope_of(list(splines.values()), hindmost)
    ahead = min(foremost + SEEING.sets_out, float(profile.stations[-1])) - foremost
    sets_out = float(np.mean([spline(foremost + ahead) - spline(foremost) for spline in splines.values()])) / ahead
    grade = slope if blend and counts else 0.0
    known = {path: Along.of(spline, foremost, grade) for path, spline in splines.items()}
    stations = profile.stations
    first, last = np.searchsorted(stations, [hindmost, foremost + distance]).tolist()
    apart = np.diff(stations[max(first - 1, 0) : last + 1])
    station = float(np.median(apart))
    reach = float((touch.positions + 0.5 * (touch.footprints + touch.cams)).max())
    return Excitation(
        touch=touch,
        along={path: known[column[path]] for path in column},
        start=start,
        blend=blend,
        grade=grade,
        slope=slope,
        sets_out=sets_out,
        station=station,
        closest=float(max(apart.min(), 1e-3 * station)),
        guessed=max(start + distance + reach - float(stations[-1]), 0.0),
    )


def slope_of(paths: Sequence[Piecewise], first: float) -> tuple[float, bool]:
    """Mean slope of a road where a journey begins, and whether it is a grade rather than roughness.

    Parameters
    ----------
    paths : sequence of Piecewise
        Elevation along the paths, which count all alike: what they differ by is roughness.
    first : float
        Where the journey begins [m].

    Returns
    -------
    float
        The median of the slopes over 50 m, within the first 100 m, or as much of it as the profile has [m/m]. It
        depends neither on bumps nor on the duration.
    bool
        Whether it is a grade.
    """
    length = min(SEEING.grade_over, min(float(spline.x[-1]) for spline in paths) - first)
    from_here = first + np.linspace(0.0, 0.5 * length, SEEING.places)
    half = 0.5 * length
    slopes = np.array([(spline(from_here + half) - spline(from_here)) / half for spline in paths])
    slope = float(np.median(slopes))
    scatter = float(np.median(np.abs(slopes - slope)))
    # Long waves look like a grade to a short profile, all the more the shorter it is.
    least = SEEING.least * (SEEING.grade_over / length) ** 2
    return slope, abs(slope) > max(least, SEEING.deviations * scatter)


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
        begins, ends, from_here, to_there = told_apart(first, last, stations[0], stations[-1])
        least, most = stations[0] - first, stations[-1] - last
        raise ValueError(
            f"the profile must cover the journey from {begins} m to {ends} m, but it reaches from {from_here} m to "
            f"{to_there} m: "
            + (
                f"the journey is {least - most:.6g} m too long"
                if least > most
                else f"`start` greater by {least:.6g} to {most:.6g} m makes it fit"
                if least > 0
                else f"`start` smaller by {-most:.6g} to {-least:.6g} m makes it fit"
            )
        )
    if not profile.same_across and max(paths) >= profile.paths:
        raise ValueError(
            f"a contact follows path {max(paths)}, but the profile has {count(profile.paths, 'path')}, counted "
            "from 0; a profile without columns is the same for all paths"
        )

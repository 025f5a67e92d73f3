"""One path of a road as contacts find it: before the beginning of its profile, along it, and past its end."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.remembered import recalled
from movingfrf._basics.smooth import memory, onward
from movingfrf._basics.spline import Piecewise, cubic
from movingfrf.roughness.profile import Profile


@dataclass(frozen=True, slots=True, kw_only=True)
class GoingOn:
    """What tunes how a road goes on past its profile; in brackets, between what each number is safe."""

    # Samples that are averaged about one level, on the way of which a road does not climb far; and last stations,
    # which tell how a profile goes on.
    together: int = 4096  # [256 to 16 384]
    # Past its end a profile goes on over so many of its last steps at least, over so many times its length at most,
    # in so many cubic pieces.
    fewest: int = 4  # [2 to 16]
    longest: float = 1.0  # [0.1 to 2]
    pieces: int = 64  # [32 to 256]
    # How well the road is guessed past the end of a profile is told from so many guesses before it, which lie so
    # many times the length of a guess apart.
    guesses: int = 15  # [7 to 63]
    apart: float = 4.0  # [1 to 10]
    # Order of the differences that tell how little there is in short waves.
    difference: int = 10  # [6 to 12]


GOING_ON = GoingOn()


class Rough(NamedTuple):
    """What differences from station to station tell of a path whose stations lie evenly."""

    step: float  # from station to station [m]
    sums: FloatArray  # (difference) from the first one on, of their squares [m²]
    variance: float  # of the elevation [m²]

    @classmethod
    def of(cls, spline: Piecewise, step: float) -> Rough:
        """Add up the squares of the differences."""
        elevation = np.append(spline.c[3], spline(spline.x[-1]))
        squares = np.square(np.diff(elevation, n=GOING_ON.difference))
        return cls(step, np.append(0.0, np.cumsum(squares)), float(elevation.var()))

    def over(self, first: float, last: float) -> float:
        """Sum over a stretch, counted from the first station on [m], and what is around its ends [m³]."""
        begin = min(max(int(first / self.step) - GOING_ON.difference, 0), self.sums.size - 1)
        end = min(max(int(last / self.step) + 1, begin), self.sums.size - 1)
        return float(self.sums[end] - self.sums[begin]) * self.step


class Past(NamedTuple):
    """How a path goes on past the end of its profile, about its elevation there and a grade."""

    onward: Piecewise  # elevation [m] over the distance from the end
    fades: float  # over how many metres slope and curvature fade from there on

    @classmethod
    def of(cls, spline: Piecewise, grade: float) -> Past:
        """Let slope and curvature fade, over a length that adds no frequencies."""
        stations = spline.x
        slope, curvature = (float(spline(stations[-1], order)) for order in (1, 2))
        slope -= grade
        extent = float(stations[-1] - stations[0])
        latest = spline.c[:, -GOING_ON.together :]
        length = float(memory(latest[2] - grade, 2.0 * latest[1]))
        length = min(max(length, GOING_ON.fewest * extent / spline.c.shape[1]), GOING_ON.longest * extent)
        after = np.linspace(0.0, length, GOING_ON.pieces + 1)
        fading = cubic(after, onward(after, slope, curvature, length), first=slope, last=0.0)
        return cls(Piecewise(np.append(after, length + 1.0), np.hstack([fading.c, np.zeros((4, 1))])), length)


class Along(NamedTuple):
    """One path about its datum and a grade, straight before its beginning, smooth past its end."""

    spline: Piecewise  # elevation [m]
    datum: float  # [m]
    datum_at: float  # where that is counted from [m]
    grade: float  # [m/m]
    past: Past
    rough: Rough | None  # where its stations lie evenly, and are not too many

    @classmethod
    def of(cls, profile: Profile, path: int, datum_at: float, grade: float) -> Along:
        """Prepare one path of a profile."""
        spline, step = profile.along(path), profile.even_step()
        rough = None
        if step is not None and profile.remembers and spline.x.size > GOING_ON.difference:
            rough = recalled(profile, f"roughness of path {path}", lambda: Rough.of(spline, step))
        if grade:
            past = Past.of(spline, grade)
        else:
            past = recalled(profile, f"past the end of path {path}", lambda: Past.of(spline, 0.0))
        return cls(spline, float(spline(datum_at)), datum_at, grade, past, rough)

    @property
    def ends(self) -> float:
        """Where the profile ends [m]."""
        return float(self.spline.x[-1])

    @property
    def fades(self) -> float:
        """Over how many metres slope and curvature fade from there on."""
        return self.past.fades

    def level(self, distance: FloatArray | float, order: int = 0) -> FloatArray:
        """Elevation about datum and grade [m], or a derivative of it, within the profile or beyond."""
        places = np.asarray(distance)
        begins, ends = float(self.spline.x[0]), self.ends
        found = np.asarray(self.spline(places, order))
        if order == 0:
            found -= self.datum
            if self.grade:
                found -= self.grade * (places - self.datum_at)
        elif order == 1:
            found -= self.grade
        if places.size and places.max() > ends:
            past = places > ends
            found[past] = self.past.onward(places[past] - ends, order)
            if order == 0:
                found[past] += float(self.spline(ends)) - self.datum - self.grade * (ends - self.datum_at)
        if places.size and places.min() < begins:
            before = places < begins
            slope = float(self.spline(begins, 1)) - self.grade
            if order:
                found[before] = slope if order == 1 else 0.0
            else:
                here = float(self.spline(begins)) - self.datum - self.grade * (begins - self.datum_at)
                found[before] = here + slope * (places[before] - begins)
        return found

    def steepness(self, first: float, last: float) -> float:
        """Root mean square of the slopes about the grade at the stations of a stretch [m/m]."""
        begin, end = np.searchsorted(self.spline.x[:-1], [first, last]).tolist()
        slopes = self.spline.c[2, min(begin, self.spline.c.shape[1] - 1) : max(end, begin + 1)]
        square = float(slopes @ slopes) / slopes.size - 2.0 * self.grade * float(slopes.mean()) + self.grade**2
        return math.sqrt(max(square, 0.0))

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
            beyond = self.past.onward
            onward = beyond.c.copy()
            onward[3] += float(self.level(self.ends))
            places = np.append(places, stations[-1] + beyond.x[1:])
            pieces = np.hstack([pieces, onward])
        return Piecewise(places, pieces)

    def seen(self, distance: FloatArray, footprint: float, cams: float, derivative: int = 0) -> FloatArray:
        """Average elevation about the datum [m], or its slope [m/m], at distances [m] that ascend row by row."""
        if not footprint and not cams:
            return self.level(distance, derivative)
        found = np.empty_like(distance)
        for places, averages in zip(distance, found, strict=True):
            for first in range(0, places.size, GOING_ON.together):
                some = slice(first, first + GOING_ON.together)
                averages[some] = self._averaged(places[some], footprint, cams, derivative)
        return found

    def doubt(self, reach: float) -> Piecewise:
        """How far guesses past the end of a profile are off, over the distance from there [m].

        Guesses past places within the profile are off from what is there; an axis of guesses comes first.
        """
        last = self.ends - reach
        span = max(min(GOING_ON.apart * GOING_ON.guesses * reach, last - float(self.spline.x[0])), 0.0)
        here = last - span * np.linspace(0.0, 1.0, GOING_ON.guesses)[:, None]
        beyond = np.linspace(0.0, reach, GOING_ON.pieces + 1)
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

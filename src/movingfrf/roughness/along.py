"""One path of a road as contacts find it: before the beginning of its profile, along it, and past its end."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.prediction import predicted, predicting
from movingfrf._basics.remembered import recalled
from movingfrf._basics.short_waves import HIGH_PASS, ShortWaves, filtered
from movingfrf._basics.smooth import memory, onward, smooth_step
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
    # Where so many stations before predict the next one better than slope and curvature do, by this share of the
    # error, it goes on as they predict, over so many times that length; of so many times as many stations. From so
    # many stations before its end on another spline stands in for that of the profile, which is the same but for
    # this share of the road's standard deviation.
    order: int = 16  # [12 to 32]
    better: float = 0.1  # [0.01 to 0.2]
    slowly: float = 4.0  # [3 to 8]
    times: int = 8  # [4 to 16]
    joins: int = 40  # [30 to 60]
    same: float = 5e-5  # [1e-6 to 1e-4]
    # How well the road is guessed past the end of a profile is told from so many guesses before it, which lie so
    # many times the length of a guess apart.
    guesses: int = 15  # [7 to 63]
    apart: float = 4.0  # [1 to 10]


GOING_ON = GoingOn()


class Rough(NamedTuple):
    """What is in the short waves of a path whose stations lie evenly."""

    step: float  # from station to station [m]
    sums: FloatArray  # from the first station on, of the squares of what is left without long waves [m²]
    variance: float  # of the elevation [m²]

    @classmethod
    def of(cls, spline: Piecewise, step: float) -> Rough:
        """Leave out long waves, and add up squares."""
        elevation = np.append(spline.c[3], spline(spline.x[-1]))
        squares = np.square(filtered(elevation))
        return cls(step, np.append(0.0, np.cumsum(squares)), float(elevation.var()))

    def over(self, first: float, last: float) -> float:
        """Sum over a stretch, counted from the first station on [m], and what is around its ends [m³]."""
        begin = min(max(int(first / self.step) - HIGH_PASS.order, 0), self.sums.size - 1)
        end = min(max(int(last / self.step) + 1, begin), self.sums.size - 1)
        return float(self.sums[end] - self.sums[begin]) * self.step


def rough_along(profile: Profile, path: int) -> Rough | None:
    """Tell what is in the short waves of a path; None where stations are uneven, or too many."""
    step, count = profile.even_step(), profile.stations.size
    if step is None or not profile.remembers or count <= HIGH_PASS.order:
        return None
    return recalled(profile, f"roughness of path {path}", lambda: Rough.of(profile.along(path), step))


def shortest_wave(profile: Profile, share: float) -> float | None:
    """Find how short the waves of a profile are.

    Parameters
    ----------
    profile : Profile
        The road.
    share : float
        What may be in shorter waves, root mean square, relative to the elevation.

    Returns
    -------
    float or None
        Length [m]; None where stations are uneven or too many, or where waves are as short as stations can tell.
    """

    def found() -> tuple[float | None]:
        paths = range(1 if profile.same_across else profile.paths)
        length = float(profile.stations[-1] - profile.stations[0])
        rough = [each for path in paths if (each := rough_along(profile, path))]
        if len(rough) < len(paths):
            return (None,)
        energy = np.array([each.over(0.0, length) for each in rough])
        whole = max(each.variance for each in rough) * length
        samples = ShortWaves(energy, whole).shortest(share)
        return (None if samples is None else samples * rough[0].step,)

    return recalled(profile, f"shortest wave, {share}", found)[0] if profile.remembers else None


class Past(NamedTuple):
    """How a path goes on past the end of its profile, about its elevation there and a grade."""

    begins: float  # from where on it stands in for the profile's spline [m]
    onward: Piecewise  # elevation [m] over the distance from the end
    fades: float  # over how many metres it fades from the end on
    coefficients: FloatArray | None = None  # of the stations before that predict the next one, where they do

    @classmethod
    def of(cls, spline: Piecewise, grade: float, *, even: bool) -> Past:
        """Let slope and curvature fade, or what the last stations predict, too slowly to add frequencies."""
        stations = spline.x
        extent, pieces = float(stations[-1] - stations[0]), spline.c.shape[1]
        latest = spline.c[:, -GOING_ON.together :]
        length = float(memory(latest[2] - grade, 2.0 * latest[1]))
        length = min(max(length, GOING_ON.fewest * extent / pieces), GOING_ON.longest * extent)
        if even and (predicted := cls._predicted(spline, grade, min(GOING_ON.slowly * length, extent))):
            return predicted
        slope, curvature = (float(spline(stations[-1], order)) for order in (1, 2))
        after = np.linspace(0.0, length, GOING_ON.pieces + 1)
        elevation = onward(after, slope - grade, curvature, length)
        return cls._level_at_last(float(stations[-1]), after, elevation, slope - grade, length)

    @classmethod
    def _predicted(cls, spline: Piecewise, grade: float, length: float) -> Past | None:
        """Go on as the last stations predict; None where that is not much better than by slope and curvature."""
        ends, joins, order = float(spline.x[-1]), GOING_ON.joins, GOING_ON.order
        last = max(spline.x.size - GOING_ON.together, 0)
        if spline.x.size - last < max(GOING_ON.times * order, 2 * joins):
            return None
        stations = spline.x[last:]
        record = np.append(spline.c[3, last:], float(spline(ends))) - grade * (stations - ends)
        record -= record[-1]
        coefficients, missed = predicting(record, order)
        if not missed < GOING_ON.better * np.sqrt(np.square(np.diff(record, n=3)).mean()):
            return None
        step = (ends - float(stations[0])) / (stations.size - 1)
        after = step * np.arange(1, int(length / step) + 2)
        goes_on = predicted(record, coefficients, after.size) * (1.0 - smooth_step(after / length))
        # The spline of the profile does not know the next stations: one through the last and the next ones is
        # smoother at the end, and hardly another one before it.
        places = np.append(stations[-joins - 1 :] - ends, after)
        slope = float(spline(stations[-joins - 1], 1)) - grade
        found = cls._level_at_last(ends, places, np.append(record[-joins - 1 :], goes_on), slope, length)
        between = 0.5 * (places[:joins] + places[1 : joins + 1])
        changed = found.onward(between) + grade * between - (spline(between + ends) - spline(ends))
        if np.abs(changed).max() > GOING_ON.same * record.std():
            return None
        return found._replace(coefficients=coefficients)

    @classmethod
    def _level_at_last(
        cls, ends: float, places: FloatArray, elevation: FloatArray, slope: float, length: float
    ) -> Past:
        """Lay a spline through elevations, and go on level."""
        fading = cubic(places, elevation, first=slope, last=0.0)
        level = Piecewise(np.append(places, places[-1] + 1.0), np.hstack([fading.c, np.zeros((4, 1))]))
        return cls(ends + float(places[0]), level, length)


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
        spline, step, rough = profile.along(path), profile.even_step(), rough_along(profile, path)
        if grade:
            past = Past.of(spline, grade, even=step is not None)
        else:
            name, even = f"past the end of path {path}", step is not None
            past = recalled(profile, name, lambda: Past.of(spline, 0.0, even=even))
        return cls(spline, float(spline(datum_at)), datum_at, grade, past, rough)

    @property
    def ends(self) -> float:
        """Where the profile ends [m]."""
        return float(self.spline.x[-1])

    @property
    def fades(self) -> float:
        """Over how many metres slope and curvature fade from there on."""
        return self.past.fades

    @property
    def _at_the_end(self) -> float:
        """Elevation there, about datum and grade [m]."""
        return float(self.spline(self.ends)) - self.datum - self.grade * (self.ends - self.datum_at)

    def level(self, distance: FloatArray | float, order: int = 0) -> FloatArray:
        """Elevation about datum and grade [m], or a derivative of it, within the profile or beyond.

        Distances ascend along their last axis.
        """
        places = np.asarray(distance)
        begins, ends = float(self.spline.x[0]), self.ends
        found = np.asarray(self.spline(places, order))
        if order == 0:
            found -= self.datum
            if self.grade:
                found -= self.grade * (places - self.datum_at)
        elif order == 1:
            found -= self.grade
        if not places.size:
            return found
        last = places.shape[-1] if places.ndim else 1
        for values, place in zip(found.reshape(-1, last), places.reshape(-1, last), strict=True):
            if place[-1] > self.past.begins:
                past = int(np.searchsorted(place, self.past.begins, side="right"))
                values[past:] = self.past.onward(place[past:] - ends, order)
                if order == 0:
                    values[past:] += self._at_the_end
            if place[0] < begins:
                before = int(np.searchsorted(place, begins))
                slope = float(self.spline(begins, 1)) - self.grade
                if order:
                    values[:before] = slope if order == 1 else 0.0
                else:
                    here = float(self.spline(begins)) - self.datum - self.grade * (begins - self.datum_at)
                    values[:before] = here + slope * (place[:before] - begins)
        return found

    def steepness(self, first: float, last: float) -> float:
        """Root mean square of the slopes about the grade at the stations of a stretch [m/m]."""
        begin, end = np.searchsorted(self.spline.x[:-1], [first, last]).tolist()
        slopes = self.spline.c[2, min(begin, self.spline.c.shape[1] - 1) : max(end, begin + 1)]
        square = float(slopes @ slopes) / slopes.size
        if self.grade:
            square += self.grade * (self.grade - 2.0 * float(slopes.mean()))
        return math.sqrt(max(square, 0.0))

    def between(self, first: float, last: float) -> Piecewise:
        """Elevation about datum and grade from one place to another [m], within the profile or beyond."""
        stations, count = self.spline.x, self.spline.c.shape[1]
        begin, end = np.searchsorted(stations, [first, last], side="right").tolist()
        beyond = last > self.past.begins
        most = int(np.searchsorted(stations, self.past.begins)) if beyond else count
        begin = min(max(begin - 1, 0), most if beyond else count - 1)
        end = most if beyond else min(max(end, 1), count)
        places, pieces = stations[begin : end + 1], self.spline.c[:, begin:end].copy()
        pieces[3] -= self.datum + self.grade * (places[:-1] - self.datum_at)
        pieces[2] -= self.grade
        if first < stations[0]:
            straight = np.zeros((4, 1))
            straight[2], straight[3] = pieces[2, 0], pieces[3, 0] - pieces[2, 0]
            places, pieces = np.append(places[0] - 1.0, places), np.hstack([straight, pieces])
        if beyond:
            goes_on = self.past.onward.c.copy()
            goes_on[3] += self._at_the_end
            places = np.append(places, self.ends + self.past.onward.x[1:])
            pieces = np.hstack([pieces, goes_on])
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

        Guesses past stations within the profile, from those up to there, are off from what is there; an axis of
        guesses comes first.
        """
        stations, joins = self.spline.x, GOING_ON.joins
        last = self.ends - reach
        span = max(min(GOING_ON.apart * GOING_ON.guesses * reach, last - float(stations[0])), 0.0)
        places = last - span * np.linspace(0.0, 1.0, GOING_ON.guesses)
        here = np.clip(np.searchsorted(stations, places, side="right") - 1, 3, stations.size - 2)
        beyond, off = np.linspace(0.0, reach, GOING_ON.pieces + 1), []
        for station in here.tolist():
            known = slice(max(station - joins, 0), station + 1)
            guess = self._guessed(stations[known], self.level(stations[known]), beyond)
            off.append(guess - self.level(stations[station] + beyond))
        return cubic(beyond, np.array(off), first=0.0)

    def _guessed(self, stations: FloatArray, elevation: FloatArray, beyond: FloatArray) -> FloatArray:
        """Guess how a road goes on past the last of some stations, as past the end of the profile [m]."""
        last, coefficients = elevation[-1], self.past.coefficients
        spline = cubic(stations, elevation)
        if coefficients is None or elevation.size < coefficients.size:
            slope, curvature = (float(spline(stations[-1], order)) for order in (1, 2))
            return last + onward(beyond, slope, curvature, self.fades)
        step = float(stations[-1] - stations[0]) / (stations.size - 1)
        after = step * np.arange(int(beyond[-1] / step) + 3)
        goes_on = np.append(0.0, predicted(elevation - last, coefficients, after.size - 1))
        goes_on *= 1.0 - smooth_step(after / self.fades)
        return last + cubic(after, goes_on, first=float(spline(stations[-1], 1)))(beyond)

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

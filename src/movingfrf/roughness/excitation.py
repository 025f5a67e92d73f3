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
from movingfrf._basics.remembered import Remembering, latest, remembered
from movingfrf._basics.short_waves import ShortWaves
from movingfrf._basics.smooth import smooth_step, smooth_step_slope
from movingfrf._basics.spline import Piecewise
from movingfrf._basics.wording import count, told_apart
from movingfrf.roughness.along import GOING_ON, Along
from movingfrf.roughness.profile import SLACK, Profile


@dataclass(frozen=True, slots=True, kw_only=True)
class Setting:
    """What tunes how a road sets in; in brackets, between what each number is safe."""

    # The grade is that of so many metres from the start of the hindmost contact on, as far as the profile reaches:
    # the median of the slopes over half of it, at so many places. What is less than `least`, more on a shorter
    # profile, or than so many times the median deviation of those slopes, is roughness.
    grade_over: float = 100.0  # [m; a convention]
    places: int = 101  # [51 to 1001]
    least: float = 2e-3  # [a convention]
    deviations: float = 2.0  # [a convention]
    # The road sets out over so many metres.
    sets_out: float = 15.0  # [m; a convention]
    # It fades out in so many times the ratio of its last level to its root mean square slope, and in so many times
    # the way at most.
    slower: float = 2.0  # [1 to 5]
    ways: float = 2.0  # [1 to 16]
    # Contacts are looked at together up to so many places in all.
    together: int = 2**18  # [2**12 to 2**22: time and memory only]


SETTING = Setting()


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Touch(Remembering):
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

    @property
    @remembered
    def told(self) -> tuple[bytes, ...]:
        """All of it, to be compared."""
        return tuple(
            np.asarray(part).tobytes() for part in (self.positions, self.paths, self.footprints, self.cams)
        )

    @property
    @remembered
    def alike(self) -> dict[tuple[int, float, float], list[int]]:
        """Contacts by path, footprint and cam: those that touch the same."""
        alike: dict[tuple[int, float, float], list[int]] = {}
        each = zip(self.paths, self.footprints.tolist(), self.cams.tolist(), strict=True)
        for row, what in enumerate(each):
            alike.setdefault(what, []).append(row)
        return alike

    def shares(self, wavenumber: FloatArray) -> FloatArray:
        """Share of a wave of the profile [rad/m] that each contact follows, shape (contact, wave)."""
        each = zip(self.footprints, self.cams, strict=True)
        return np.stack([enveloping(wavenumber, footprint, cams) for footprint, cams in each])

    def waves(self, wavenumber: FloatArray) -> ComplexArray:
        """Give what each contact sees of a wave e^{iκx}, the reference point at x = 0; shape (contact, wave)."""
        return self.shares(wavenumber) * np.exp(1j * np.outer(self.positions, wavenumber))


class Group(NamedTuple):
    """Contacts that follow one path and touch the same of it."""

    rows: list[int]  # which
    along: Along
    begins: FloatArray  # (contact, 1) where they start [m]
    touched: tuple[float, float]  # footprint and cams [m]
    foremost: float  # where the foremost contact of all starts [m]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Excitation(Remembering):
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
    distance : float
        How far the reference point travels [m].
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
    distance: float

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
        for group, distance, setting_in in self._alike(travelled):
            found = group.along.seen(distance, *group.touched)
            if setting_in.size:
                found[:, : setting_in.shape[1]] *= smooth_step(setting_in)
            if len(found) == len(seen):
                return found
            seen[group.rows] = found
        return seen

    def rate(self, travelled: FloatArray, speed: float) -> FloatArray:
        """Rate of change of the elevation that each contact sees, as for `elevation` [m/s]."""
        rate = np.empty((self.touch.positions.size, travelled.size))
        for group, distance, setting_in in self._alike(travelled):
            along, touched, blending = group.along, group.touched, setting_in.shape[1]
            rising = along.seen(distance, *touched, derivative=1)
            if blending:
                rising[:, :blending] *= smooth_step(setting_in)
                early = along.seen(distance[:, :blending], *touched)
                rising[:, :blending] += early * smooth_step_slope(setting_in) / self.blend
            rate[group.rows] = rising * speed
        return rate

    @property
    @remembered
    def fading(self) -> float:
        """Way in which the road may fade out past the end of the journey [m]: no faster than it rises as a rule.

        From the greatest elevation at the end and the root mean square slope on the steepest way.
        """
        travelled = self.distance
        begins = zip(self.touch.paths, (self.start + self.touch.positions).tolist(), strict=True)
        steep = max(self.along[path].steepness(first, first + travelled) for path, first in begins)
        level = float(np.abs(self.elevation(np.array([travelled]))).max())
        return min(SETTING.slower * level, SETTING.ways * travelled * steep) / (steep or 1.0)

    @property
    @remembered
    def short_waves(self) -> ShortWaves | None:
        """Tell how little of the road may be in its short waves, however finely it is sampled.

        From station to station, of what each contact meets on the journey [m³]; None where stations are uneven.
        """
        travelled = self.distance
        touch, energy, whole = self.touch, list[float](), 0.0
        reach = 0.5 * (touch.footprints + touch.cams)
        for path, first, last in zip(
            touch.paths, touch.positions - reach, touch.positions + reach + travelled, strict=True
        ):
            along = self.along[path]
            if along.rough is None:
                return None
            begins = self.start - float(along.spline.x[0])
            energy.append(along.rough.over(begins + first, begins + last))
            whole = max(whole, along.rough.variance * travelled)
        return ShortWaves(np.array(energy), whole)

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
        doubt = np.zeros((GOING_ON.guesses, self.touch.positions.size, travelled.size))
        for group, distances, _ in self._alike(travelled):
            along, (footprint, cams) = group.along, group.touched
            reach = 0.5 * (footprint + cams)
            for row, distance in zip(group.rows, distances, strict=True):
                first = int(np.searchsorted(distance, along.ends - reach))
                if reach and first < travelled.size:
                    off, past = along.doubt(reach), np.minimum(distance[first:] + reach - along.ends, reach)
                    touched = off.antiderivative()(past) / footprint if footprint else off(past)
                    doubt[:, row, first:] = touched / (2.0 if cams else 1.0)
        return doubt

    @property
    @remembered
    def _groups(self) -> list[Group]:
        """Contacts that touch the same."""
        foremost = self.start + self.touch.positions.max()
        return [
            Group(
                rows, self.along[path], self.start + self.touch.positions[rows, None], (footprint, cams), foremost
            )
            for (path, footprint, cams), rows in self.touch.alike.items()
        ]

    def _alike(self, travelled: FloatArray) -> Iterator[tuple[Group, FloatArray, FloatArray]]:
        """Go through contacts that touch the same: which, at what distances, how far the profile has set in."""
        # As many at a time as memory hardly notices.
        together = max(SETTING.together // max(travelled.size, 1), 1)
        for whole in self._groups:
            for first in range(0, len(whole.rows), together):
                some = slice(first, first + together)
                group = whole._replace(rows=whole.rows[some], begins=whole.begins[some])
                distance = travelled + group.begins
                over = group.foremost + self.blend - float(group.begins.min())
                blending = int(np.searchsorted(travelled, over)) if self.blend else 0
                yield group, distance, (distance[:, :blending] - group.foremost) / (self.blend or 1.0)


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

    def fits(known: Excitation) -> bool:
        same = (known.start, known.distance, known.blend) == (start, distance, blend)
        return same and (known.touch is touch or known.touch.told == touch.told)

    def make() -> Excitation:
        return _excited(profile, touch, start=start, distance=distance, blend=blend)

    return latest(profile, "excitation", fits, make) if profile.remembers else make()


def _excited(profile: Profile, touch: Touch, *, start: float, distance: float, blend: float) -> Excitation:
    """Let contacts travel along a profile that knows of no such journey."""
    hindmost, foremost = start + touch.positions.min(), start + touch.positions.max()
    require_cover(profile, hindmost, foremost + distance, touch.paths)
    # A profile without columns is the same for all paths.
    column = {path: 0 if profile.same_across else path for path in touch.paths}
    splines = {path: profile.along(path) for path in set(column.values())}
    slope, counts = _slope_at(profile, tuple(splines), hindmost)
    ahead = min(foremost + SETTING.sets_out, float(profile.stations[-1])) - foremost
    ends = np.array([foremost, foremost + ahead])
    sets_out = float(np.mean([np.diff(spline(ends)) for spline in splines.values()])) / ahead
    grade = slope if blend and counts else 0.0
    known = {path: Along.of(profile, path, foremost, grade) for path in splines}
    station, closest = _apart(profile, hindmost, foremost + distance)
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
        closest=closest,
        guessed=max(start + distance + reach - float(profile.stations[-1]), 0.0),
        distance=distance,
    )


def _apart(profile: Profile, first: float, last: float) -> tuple[float, float]:
    """How far most stations lie apart on a journey, and the closest ones, no closer than a thousandth of it [m]."""
    step = profile.even_step()
    if step is not None:
        return step, step
    stations = profile.stations
    begin, end = np.searchsorted(stations, [first, last]).tolist()
    apart = np.diff(stations[max(begin - 1, 0) : end + 1])
    station = float(np.median(apart))
    return station, float(max(apart.min(), 1e-3 * station))


class Slope(NamedTuple):
    """Mean slope of a road where a journey begins."""

    paths: tuple[int, ...]
    first: float  # where that is [m]
    found: tuple[float, bool]  # as `slope_of` gives it


def _slope_at(profile: Profile, paths: tuple[int, ...], first: float) -> tuple[float, bool]:
    """Find the mean slope where a journey begins, or take it again: it does not depend on how far that goes."""

    def find() -> Slope:
        return Slope(paths, first, slope_of([profile.along(path) for path in paths], first))

    if not profile.remembers:
        return find().found
    return latest(profile, "slope", lambda known: known[:2] == (paths, first), find).found


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
    length = min(SETTING.grade_over, min(float(spline.x[-1]) for spline in paths) - first)
    from_here = first + np.linspace(0.0, 0.5 * length, SETTING.places)
    half = 0.5 * length
    ends = np.stack([from_here, from_here + half])
    rises = np.concatenate([np.diff(spline(ends), axis=0)[0] for spline in paths])
    slope = _median(rises) / half
    scatter = _median(np.abs(rises - slope * half)) / half
    # Long waves look like a grade to a short profile, all the more the shorter it is.
    least = SETTING.least * (SETTING.grade_over / length) ** 2
    return slope, abs(slope) > max(least, SETTING.deviations * scatter)


def _median(values: FloatArray) -> float:
    """Median: of few values, in a tenth of NumPy's time."""
    ascending, middle = np.sort(values), values.size // 2
    return 0.5 * float(ascending[middle] + ascending[values.size - 1 - middle])


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

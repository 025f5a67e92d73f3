"""In what steps a record is solved: as fine as the road and the system need, whatever the steps of the output.

A road is a function of distance. Sampled at the output's step, what it holds above the Nyquist frequency would fold
onto lower ones. So it is sampled finer, until what the system makes of the highest frequencies is negligible, and
solved up to where anything is left.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import scipy.fft

from movingfrf._basics.arrays import ComplexArray, FloatArray, require_memory
from movingfrf._basics.remembered import Remembering, latest
from movingfrf._basics.short_waves import ShortWaves
from movingfrf._basics.smooth import smoothest_step
from movingfrf.response.batches import BATCH
from movingfrf.response.influence import Influence, Sized, influence
from movingfrf.response.line import TRANSFORM, Given, Line
from movingfrf.response.truncation import TRUNCATION, Truncation


@dataclass(frozen=True, slots=True, kw_only=True)
class Wanted:
    """How much is solved; in brackets, between what each number is safe."""

    # Steps from station to station of a profile at first, or from sample to sample; twice as many, and so on, until
    # they are enough.
    per_station: float = 2.0  # [2 to 8]
    # So many stations a step instead, where next to nothing is in waves shorter than two such steps.
    stations: tuple[float, ...] = (8.0, 4.0, 2.0)  # [1 to 16, descending: time only]
    # What of any output may lie in the highest quarter of the frequencies, and beyond what is solved, relative L2.
    negligible: float  # [1e-6 to 3e-4]
    # The same beyond what is solved, where nothing changes abruptly.
    smooth: float  # [1e-12 to 3e-4]
    # An output that is less than this share of the largest of its kind counts as if it were so much.
    alike: float = 1e-3  # [1e-4 to 0.1]
    # Whether every abrupt change is told.
    told: bool = False
    # Most steps per period, for all ports together. [2**18 to 2**27: time and memory only]
    most: int = 2**23


@dataclass(frozen=True, slots=True, kw_only=True)
class Sampling:
    """What tunes the steps of the solution; in brackets, between what each number is safe."""

    road: Wanted = Wanted(negligible=3e-5, smooth=3e-5)
    loads: Wanted = Wanted(per_station=4.0, negligible=1e-4, smooth=1e-9, alike=0.01, told=True, most=2**20)
    # With more steps for all ports together than these, so many times as much is negligible, and tolerated.
    many: int = 2**20  # [2**17 to 2**22: time only]
    costly: float = 3.0  # [1 to 5]
    less: float = 2.0  # [1 to 3]
    # A road of which no more than this share is in waves shorter than two coarse steps is sampled in these, unless
    # that might be more than this share of what is negligible of some output.
    next_to_nothing: float = 2e-6  # [1e-9 to 1e-5: time only]
    hidden: float = 1.0  # [0.03 to 1]
    # Where what a road leaves out turns out to be more than this share of the largest value of a channel, less is
    # negligible, and it is solved again.
    tolerated: float = 1.5e-4  # [5e-5 to 3e-4]
    rounds: int = 3  # [2 to 5]
    # Where the highest quarter begins; what lies beyond holds at most so many times its energy.
    quarter: float = 0.75  # [a convention]
    beyond: float = 3.0  # [1 to 4]
    # With eight times as many steps the energy there falls to this share of it at most, or else the road begins
    # with a jump, whose energy falls to an eighth: no step would be fine enough.
    falling: float = 0.1  # [0.05 to 0.12]
    # Where every abrupt change is told, finer steps help, unless the system answers the highest frequency of so
    # many steps with more than this share of its largest answer.
    stiff: float = 0.03  # [0.01 to 0.1]
    highest: int = 2**22  # [2**20 to 2**24]
    # What is left out of the answer to an abrupt change comes at once, within few periods of the highest frequency:
    # so many radians of it later it has died away. Or it is so small that no instant misses more, relative L2.
    passed: float = 20.0  # [10 to 100]
    at_once: float = 1e-4  # [1e-6 to 1e-4]
    least: int = 256  # steps per period [64 to 1024]
    # Share of the solved frequencies over which the road fades out; and where it changes abruptly: the wider, the
    # sooner what is left out has died away.
    fades: float = 0.1  # [0.05 to 0.2]
    fades_abrupt: float = 1.0  # [0.5 to 2]
    # A response that the steps of its record do not show is shown in so many steps to half a period of the highest
    # frequency beyond which more than this share of an output is left.
    shown: float = 3.0  # [2 to 8]
    unseen: float = 1e-5  # [1e-6 to 3e-5]
    # For figures a channel is as large as this share of the largest of its kind at least: one that hardly moves is
    # no matter. From the other one on, what a stated truncation changes is computed rather than estimated.
    smallest: float = 1e-3  # [a convention]
    estimated: float = 1e-4  # [1e-5 to 5e-4]
    slight: float = 1e-2  # up to here it is measured from what it leaves out alone [1e-3 to 2e-2]
    affordable: int = 2**15  # frequencies; of more of them it stays an upper estimate [time only]
    # Where steps are not stated, a record shows the shortest waves of a road in steps of so much of their length:
    # values between samples are known there as well (`peaks`). Of its elevation no more than this share is in
    # shorter ones; if that turns out to matter, the record is kept in finer steps. No coarser than this, and no
    # fewer than so many.
    observed: float = 0.4  # [0.2 to 0.4]
    shorter: float = 1e-3  # [1e-5 to 3e-3]
    coarsest: float = 0.02  # [s; 1e-3 to 0.05]
    at_least: int = 2048  # [512 to 8192: the mean over a record depends by a few steps of it on where it ends]
    # What is seen of a road is remembered for the next vehicle in periods of so many steps at most.
    remembered: int = 2**16  # [2**12 to 2**20: time and memory only]
    # A sampled force jumps where its third differences are those of a jump, up to this share of it, and no others
    # are within so many steps.
    like: float = 0.2  # [0.1 to 0.3]
    alone: int = 6  # [4 to 8]


SAMPLING = Sampling()


class LookedAt(NamedTuple):
    """What drives a system along a line."""

    line: tuple[float, ...]  # what of a line it depends on
    given: Given
    parts: ComplexArray  # as `Line.looked_at` gives them
    energy: FloatArray


class Driving(NamedTuple):
    """What drives a system: as it is given, and from what on."""

    given: Callable[[Line], Given]  # at the instants of any line
    step: float  # from station to station of the profile, or from sample to sample of the forces, as a rule [s]
    finest: float | None = None  # the same where they are closest [s]; None: it is the same everywhere
    # How little of it may be in its short periods; None if that is not known.
    short: ShortWaves | None = None
    # What remembers the latest look at it, if that may serve again.
    remembers: Remembering | None = None

    def looked_at(self, line: Line) -> LookedAt:
        """Transform it, and tell how much there is of it."""

        def look() -> LookedAt:
            given = self.given(line)
            return LookedAt(line.told, given, *line.looked_at(given))

        if self.remembers is None or line.solved > SAMPLING.remembered:
            return look()
        return latest(self.remembers, "looked at", lambda known: known.line == line.told, look)

    def points(self, period: float, wanted: Wanted, finer: float = np.inf) -> float:
        """Say in how many steps per period [s] sampling begins: no finer than is needed as far as one knows.

        Each step spans fewer stations than the stated number.
        """
        every = period / self.step
        if self.short is not None:
            for stations in wanted.stations:
                least = self.short.shorter(2 * stations).max(initial=0.0)
                if stations < finer and least <= SAMPLING.next_to_nothing**2 * self.short.whole:
                    return every / stations
        return wanted.per_station * every

    def stations(self, line: Line) -> float:
        """Count the stations from step to step of a line."""
        return line.period / (line.solved * self.step)

    @property
    def images(self) -> float | None:
        """Frequency about which a spline through its stations has images of its waves [rad/s], if that matters."""
        return None if self.short is None else 2 * np.pi / self.step

    def hides(self, line: Line, found: Influence) -> float:
        """Bound what sampling in the steps of a line hides of any output, relative L2."""
        period, stations = line.period, self.stations(line)
        if self.short is None or stations < 1.0:
            return 0.0
        hidden = 0.5 * period * self.short.shorter(2 * stations)
        # Sampled so coarsely, images of waves fall back onto these, or near them.
        turns = self.step / period * found.middles
        images = np.square(np.square(np.square([turns / (1.0 - turns), turns / (1.0 + turns)]))).sum(axis=0)
        return found.at_most(np.square(np.sqrt(hidden) + np.sqrt(found.power @ images)))


class Excited(NamedTuple):
    """What drives a system, in steps that are fine enough, and up to where it is solved."""

    line: Line
    omega: ComplexArray  # (frequency,) those that are solved [rad/s]
    spectra: ComplexArray  # (part, *case, port, frequency), as far as they are solved
    begins: tuple[float, ...]  # from when on each part acts [s]
    truncation: Truncation
    fade: FloatArray  # (frequency,) what of each frequency is solved: 1, past what is negligible less
    finest: bool  # whether no finer step would help, or none was to be looked for
    left_out: float  # of any output, relative L2, where no step that is allowed is fine enough
    beyond: FloatArray  # (output,) what lies beyond over what lies in the highest octave that is solved
    missing: float  # what of any output is known to be left out, relative L2, where the step is stated
    found: Influence  # along the line
    energies: tuple[float, ...]  # in the highest quarter, of ever finer steps

    @property
    def step(self) -> float:
        """Step in which the record is solved: half a period of the highest frequency [s]."""
        return 0.5 * self.line.period / max(self.fade.size - 1, 1)

    def finer(self, time_step: float) -> int:
        """Say how many values for each step of a record [s] show the response."""
        highest = min(self.found.up_to(SAMPLING.unseen), self.fade.size - 1)
        return max(int(np.ceil(SAMPLING.shown * time_step * 2 * highest / self.line.period)), 1)

    def likewise(self, given: Given) -> ComplexArray:
        """Spectra of something else, as far as this is solved."""
        return self.line.spectra(given)[..., : self.fade.size] * self.fade


def excited(
    system: Sized,
    driving: Driving,
    line: Line,
    *,
    truncation: float | None,
    solved_step: float | None = None,
    wanted: Wanted = SAMPLING.road,
    after: Excited | None = None,
) -> Excited:
    """Find the steps in which a record is solved.

    Parameters
    ----------
    system : System or Prescribed
        What is driven.
    driving : Driving
        What drives it.
    line : Line
        The record; sampling begins in steps of its own if it has them, or else as `at_first` says.
    truncation : float, optional
        Frequency beyond which the road counts as rigid [Hz]; None: it is found.
    solved_step : float, optional
        Step that is stated [s].
    wanted : Wanted
        How much is solved.
    after : Excited, optional
        The same with less wanted: its steps were not too fine, and need not be looked at again.

    Returns
    -------
    Excited
        Spectra of what drives it, and what of them need not be solved.

    Raises
    ------
    ValueError
        If memory would not hold it.
    """
    stated = None if solved_step is None else _harmonics(line, solved_step)
    if after is not None:
        line = after.line
    elif line.points is None:
        line = at_first(system, driving, line, solved_step, wanted)
    energies = (np.inf, np.inf, np.inf) if after is None else after.energies[:-1]
    while True:
        _, given, parts, energy = driving.looked_at(line)
        if after is None:
            found = influence(system, line, energy, truncation, wanted.alike, driving.images)
        else:
            found = after.found
        if driving.hides(line, found) > SAMPLING.hidden * wanted.negligible:
            # A number of steps that factorises makes them somewhat finer than they were to be.
            finer = 0.9 * driving.stations(line)
            line, after = _with_points(system, line, driving.points(line.period, wanted, finer)), None
            continue
        highest = found.content(int(SAMPLING.quarter * line.size))
        energies = (*energies, highest**2)
        # Beyond this frequency what an abrupt change adds has passed when the next sample is taken.
        passed = int(SAMPLING.passed * line.period / (2 * np.pi * line.clear(given)))
        at_once = SAMPLING.at_once / np.sqrt(line.size)
        points, ports = line.solved, given.values[..., 0].size
        relaxed = SAMPLING.costly if points * ports > SAMPLING.many else 1.0
        negligible = relaxed * wanted.negligible
        enough = highest <= negligible and (passed <= SAMPLING.quarter * line.size or highest <= at_once)
        if enough or stated is not None or 2 * points * ports > wanted.most:
            break
        # Before the closest stations are told apart what they hold does not fall.
        apart = points > 8 * wanted.per_station * line.period / (driving.finest or driving.step)
        falls = not apart or energies[-1] <= SAMPLING.falling * energies[-4]
        if not falls and not (wanted.told and _stiffens(system, line, found)):
            break
        line, after = _with_points(system, line, 2 * points), None
    fades = SAMPLING.fades_abrupt if given.abrupt else SAMPLING.fades
    if stated is None:
        limit = negligible if given.abrupt else relaxed * wanted.smooth
        ends = found.negligible_from(found.whole, limit, energy)
        if passed > ends:
            ends = min(passed, found.negligible_from(found.whole, at_once, energy))
        count = int(ends * (1 + fades)) + 2
        if count <= BATCH.frequencies(system.ports**2):
            count = sixteenths(count)
    else:
        count = stated
    count = min(count, line.size)
    ends = int(count / (1 + fades))
    # What a sharp cut discards would ring on, and the window raises what comes late.
    fade = 1.0 - smoothest_step((np.arange(count) - ends + 1) / max(count - ends, 1))
    if truncation is None:
        kept = min(found.negligible_from(found.added, TRUNCATION.negligible, energy), count)
        # Where the response to rest alone is kept, some frequency below the next.
        truncation = max(kept - 1, 0.5 * (kept > 0)) / line.period
    cut = Truncation(frequency=truncation)
    return Excited(
        line=line,
        omega=line.omega(slice(count)),
        spectra=parts[..., :count] * fade,
        begins=given.begins,
        truncation=replace(cut, error=found.error(cut.harmonics(line.period, line.size), count)),
        fade=fade,
        finest=stated is not None or not enough,
        left_out=0.0 if enough else highest,
        beyond=_beyond(found, ends, count),
        missing=0.0 if stated is None else found.content(ends),
        found=found,
        energies=energies,
    )


def at_first(system: Sized, driving: Driving, line: Line, solved_step: float | None, wanted: Wanted) -> Line:
    """Put so many steps on a line as sampling begins with.

    Parameters
    ----------
    system : System or Prescribed
        What is driven.
    driving : Driving
        What drives it.
    line : Line
        The record.
    solved_step : float or None
        Step that is stated [s].
    wanted : Wanted
        How much is solved.

    Returns
    -------
    Line
        The same record.

    Raises
    ------
    ValueError
        If memory would not hold it.
    """
    points = max(driving.points(line.period, wanted), SAMPLING.least)
    if solved_step is not None:
        points = max(points, 2.0 * _harmonics(line, solved_step))
    return _with_points(system, line, points)


def _with_points(system: Sized, line: Line, points: float) -> Line:
    """Put at least so many steps per period on a line."""
    require_memory(
        TRANSFORM.bytes_per_sample * system.ports * points,
        f"a period of {line.period:.4g} s solved in steps of {line.period / points:.3g} s",
    )
    return line.solved_in(scipy.fft.next_fast_len(int(points), real=True))


def sixteenths(count: int) -> int:
    """Round a number up in its fifth binary digit: what one case needs then serves others."""
    step = 1 << max(count.bit_length() - 5, 0)
    return -(-count // step) * step


def _harmonics(line: Line, step: float) -> int:
    """Count the harmonics of a line from zero up to one of which half a period is no more than a step [s]."""
    return int(np.ceil(0.5 * line.period / step)) + 1


def _beyond(found: Influence, ends: int, count: int) -> FloatArray:
    """Give the ratio of what is not solved to the highest octave that is, of each output, relative L2."""
    lines = found.lines
    not_solved = found.shares(ends, lines) ** 2
    not_sampled = SAMPLING.beyond * found.shares(int(SAMPLING.quarter * lines), lines) ** 2
    octave = found.shares(count // 2, count)
    return np.sqrt(np.divide(not_solved + not_sampled, octave**2, out=np.zeros_like(octave), where=octave > 0))


def _stiffens(system: Sized, line: Line, found: Influence) -> bool:
    """Tell whether a system answers the highest frequency of all with little."""
    highest = line.solved_in(SAMPLING.highest)
    answered = system.per_unit(highest.omega(slice(highest.size - 1, None)))[1][..., 0]
    return bool((answered <= SAMPLING.stiff * found.whole.gain.max(axis=-1)).all())

"""Histories of prescribed forces: functions of time, in newton, positive down."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import ParameterError, checking, shown
from movingfrf._basics.smooth import smooth_step
from movingfrf._basics.spline import cubic
from movingfrf._basics.values import Value
from movingfrf._basics.wording import told_apart
from movingfrf.response.line import Abrupt, Given, Line

# A smooth force at some times [s], or its derivative of an order up to 2 [N, N/s, N/s²].
Smooth = Callable[[FloatArray, int], FloatArray]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class History(Value):
    """A force over time.

    Parameters
    ----------
    smooth : callable
        Times [s] and an order → the force, or its first or second derivative [N, N/s, N/s²].
    begins, ends : float
        When it begins and ends to act, abruptly if it is not zero there [s].
    finest : float
        Time within which it may change noticeably [s].
    """

    smooth: Smooth
    begins: float = 0.0
    ends: float = np.inf
    finest: float = np.inf

    def __call__(self, time: FloatArray) -> FloatArray:
        """Force [N] at an array of times [s]; where it changes abruptly, the one after."""
        return np.where((time >= self.begins) & (time < self.ends), self.smooth(time, 0), 0.0)

    def abrupt(self, port: int) -> list[Abrupt]:
        """Where it changes abruptly from t = 0 on."""
        begins = max(self.begins, 0.0)
        if begins >= self.ends:
            return []
        at = {begins: 1.0, self.ends: -1.0} if np.isfinite(self.ends) else {begins: 1.0}
        changes = (
            Abrupt(time, port, sign * np.stack([self.smooth(np.array(time), order) for order in range(3)]))
            for time, sign in at.items()
        )
        return [change for change in changes if change.jumps.any()]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Loads(Value):
    """Prescribed forces that travel along.

    Parameters
    ----------
    positions : ndarray, shape (load,)
        Where the loads stand, ahead of the reference point [m].
    histories : tuple of History
        The force of each over time.
    observe : ndarray, shape (point,)
        Where the deflection is wanted, ahead of the reference point [m].
    """

    positions: FloatArray
    histories: tuple[History, ...]
    observe: FloatArray

    def at(self, time: FloatArray) -> FloatArray:
        """Evaluate the forces at some times [s], shape (time, load) [N]."""
        return np.stack([history(time) for history in self.histories], axis=1)

    def given(self, line: Line) -> Given:
        """Give the forces at the instants of a line, and where they change abruptly."""
        last = line.instants[-1]
        abrupt = [change for port, history in enumerate(self.histories) for change in history.abrupt(port)]
        return Given(self.at(line.instants).T, tuple(change for change in abrupt if change.time <= last))

    @property
    def finest(self) -> float:
        """Time within which a force may change noticeably [s]."""
        return min(history.finest for history in self.histories)


def loads(*, positions: Sequence[float], force: Sequence[History], observe: Sequence[float] | None = None) -> Loads:
    """Prescribed loads: where they stand, and one force for each.

    Parameters
    ----------
    positions : sequence of float
        Positions ahead of the reference point, which travels along [m].
    force : sequence of History
        Force of each load, over time.
    observe : sequence of float, optional
        Where the deflection is wanted, ahead of the reference point [m]; None: at the loads.

    Returns
    -------
    Loads
        The loads.

    Raises
    ------
    ValueError
        If there is no load or no observer, or a load without a force.
    """
    with checking() as check:
        at = check.array("positions", positions, "m", (None,))
        points = at if observe is None else check.array("observe", observe, "m", (None,))
        if not check.faults and not (at.size and points.size):
            check.refuse("positions", "must hold at least one position [m], as must observe")
        if not check.faults and len(force) != at.size:
            check.refuse("force", f"must stand once per position, {at.size} times, got {len(force)}")
    return Loads(positions=at, histories=tuple(force), observe=points)


def constant(
    *, force: float, switch_on: float = 0.0, switch_off: float | None = None, ramp: float = 0.0
) -> History:
    """One constant force, switched on and off.

    Parameters
    ----------
    force : float
        Force [N].
    switch_on : float
        When it begins [s].
    switch_off : float, optional
        When it has ended [s]; None: never.
    ramp : float
        Time over which it rises and falls smoothly [s]; 0 switches abruptly.

    Returns
    -------
    History
        The force.

    Raises
    ------
    ValueError
        If a time is negative or they are out of order.
    """
    with checking() as check:
        force = check.finite("force", force, "N")

    return _switched(History(smooth=partial(_steady, force)), switch_on, switch_off, ramp)


def _steady(force: float, time: FloatArray, order: int) -> FloatArray:
    return np.full_like(time, 0.0 if order else force)


def harmonics(
    *,
    amplitudes: Sequence[float],
    frequencies: Sequence[float],
    phases: Sequence[float] | None = None,
    mean: float = 0.0,
    switch_on: float = 0.0,
    switch_off: float | None = None,
    ramp: float = 0.0,
) -> History:
    """Sum sine waves on a mean, switched on and off.

    Parameters
    ----------
    amplitudes : sequence of float
        Amplitudes [N].
    frequencies : sequence of float
        Frequencies [Hz], one per amplitude.
    phases : sequence of float, optional
        Phases at t = 0 [rad]; zero by default.
    mean : float
        Constant part [N].
    switch_on : float
        When it begins [s].
    switch_off : float, optional
        When it has ended [s]; None: never.
    ramp : float
        Time over which it rises and falls smoothly [s]; 0 switches abruptly.

    Returns
    -------
    History
        The force.

    Raises
    ------
    ValueError
        If the lists differ in length, or a time is negative or out of order.
    """
    with checking() as check:
        size = check.array("amplitudes", amplitudes, "N", (None,))
        at = check.array("frequencies", frequencies, "Hz", (size.size,))
        phase = np.zeros(size.size) if phases is None else check.array("phases", phases, "rad", (size.size,))
        mean = check.finite("mean", mean, "N")

    sines = np.stack([size, 2 * np.pi * at, phase], axis=1)
    highest = np.abs(at).max(initial=0.0)
    finest = 0.1 / highest if highest else np.inf  # a tenth of a period
    return _switched(
        History(smooth=partial(_sum_of_sines, mean, sines), finest=finest), switch_on, switch_off, ramp
    )


def _sum_of_sines(mean: float, sines: FloatArray, time: FloatArray, order: int) -> FloatArray:
    total = np.full_like(time, 0.0 if order else mean)
    for amplitude, omega, shift in sines:
        # Each derivative is a quarter of a period ahead.
        total += amplitude * omega**order * np.sin(omega * time + (shift + 0.5 * np.pi * order))
    return total


def random_sum(
    *,
    rms: float,
    lowest: float,
    highest: float,
    count: int = 50,
    seed: int = 0,
    mean: float = 0.0,
    switch_on: float = 0.0,
    switch_off: float | None = None,
    ramp: float = 0.0,
) -> History:
    """Sum equal sine waves with seeded, random frequencies and phases, on a mean.

    Parameters
    ----------
    rms : float
        Root mean square of the fluctuation [N].
    lowest : float
        Lower end of the band in which the frequencies lie, uniformly distributed [Hz].
    highest : float
        Upper end of the band in which the frequencies lie [Hz].
    count : int
        Number of sine waves, at most 100,000.
    seed : int
        Seed: the same seed gives the same force.
    mean : float
        Constant part [N].
    switch_on : float
        When it begins [s].
    switch_off : float, optional
        When it has ended [s]; None: never.
    ramp : float
        Time over which it rises and falls smoothly [s]; 0 switches abruptly.

    Returns
    -------
    History
        The force.

    Raises
    ------
    ValueError
        If the band is empty, a number is not positive, or a time is negative or out of order.
    """
    most_waves = 100_000  # a limit of memory and patience [a convention]
    with checking() as check:
        rms = check.positive("rms", rms, "N")
        lowest = check.not_negative("lowest", lowest, "Hz")
        highest = check.positive("highest", highest, "Hz")
        if (count := check.whole("count", count, least=1)) > most_waves:
            check.refuse("count", f"must be at most {most_waves}, got {shown(count)}")
        seed = check.whole("seed", seed)
        if not check.faults and lowest >= highest:
            least, got = told_apart(lowest, highest)
            check.refuse("highest", f"must be above lowest, {least} Hz, got {got} Hz")
    random = np.random.default_rng(seed)
    return harmonics(
        amplitudes=np.full(count, rms * np.sqrt(2 / count)).tolist(),
        frequencies=random.uniform(lowest, highest, count).tolist(),
        phases=random.uniform(0, 2 * np.pi, count).tolist(),
        mean=mean,
        switch_on=switch_on,
        switch_off=switch_off,
        ramp=ramp,
    )


def tabulated(*, file: Path, column: int | None = None, skip_lines: int = 0) -> History:
    """Read a force from a file of columns: a time and one force or more, by names and units, [s] and [N] without.

    Between the rows the force is a cubic spline; before the first and after the last row it is zero.

    Parameters
    ----------
    file : Path
        The file: columns separated by commas, semicolons, tabs or spaces; times in s, ms, min or h, forces in N,
        kN, MN, lbf or kip, where names or a line below them say so.
    column : int, optional
        Number of the force's column, counted from 0; None: the first that name or unit calls a force, or else the
        first that is no time. What stands in other columns does not matter.
    skip_lines : int
        Number of lines at the beginning to leave out, where it is not plain where the table begins.

    Returns
    -------
    History
        The force.

    Raises
    ------
    ValueError
        If the file cannot be read, or lacks the column.
    """
    from movingfrf.scenarios.force_files import read_force

    with checking() as check:
        column = column if column is None else check.whole("column", column, least=0)
        skip_lines = check.whole("skip_lines", skip_lines, least=0)
    try:
        time, force = read_force(file, column, skip_lines)
    except ParameterError:
        raise
    except ValueError as error:
        raise ValueError(f"{file}: {error}") from None
    return History(
        smooth=cubic(time, force),
        begins=float(time[0]),
        ends=float(np.nextafter(time[-1], np.inf)),  # the last row counts
        finest=float(np.diff(time).min()),
    )


def _switched(history: History, on: float, off: float | None, ramp: float) -> History:
    """Let a history act from `on` to `off` only."""
    with checking() as check:
        on = check.not_negative("switch_on", on, "s")
        ramp = check.not_negative("ramp", ramp, "s")
        if off is not None:
            off = check.finite("switch_off", off, "s")
            if off < on + 2 * ramp:
                check.refuse("switch_off", f"must leave time for both ramps after switch_on, got {off!r} s")

    within = replace(history, begins=on, ends=np.inf if off is None else off)
    if not ramp:
        return within

    ramped = partial(_ramped, history.smooth, on, off, ramp)
    return replace(within, smooth=ramped, finest=min(history.finest, 0.25 * ramp))


def _ramped(smooth: Smooth, on: float, off: float | None, ramp: float, time: FloatArray, order: int) -> FloatArray:
    share = smooth_step((time - on) / ramp)
    if off is not None:
        share = share * smooth_step((off - time) / ramp)
    # Derivatives are asked for where it begins and ends: there they are zero.
    return smooth(time, order) * share

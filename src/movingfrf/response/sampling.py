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

from movingfrf._basics.arrays import ComplexArray, FloatArray
from movingfrf._basics.smooth import smooth_step
from movingfrf.response.batches import unthreaded
from movingfrf.response.influence import Influence, Sized, influence
from movingfrf.response.line import Given, Line
from movingfrf.response.truncation import TRUNCATION, Truncation


@dataclass(frozen=True, slots=True, kw_only=True)
class Wanted:
    """How much is solved; in brackets, between what each number is safe."""

    # What of any output may lie in the highest quarter of the frequencies, and beyond what is solved, relative L2.
    negligible: float  # [1e-6 to 3e-4]
    # The same beyond what is solved, where nothing changes abruptly.
    smooth: float  # [1e-12 to 3e-4]
    # Where outputs are of a kind, one that is less than this share of the largest counts as if it were so much.
    alike: float = 0.0  # [0 to 0.1]
    # Whether every abrupt change is told.
    told: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Sampling:
    """What tunes the steps of the solution; in brackets, between what each number is safe."""

    # Steps from station to station of a profile at first; twice as many, and so on, until they are enough.
    per_station: float = 2.0  # [2 to 8]
    road: Wanted = Wanted(negligible=2e-4, smooth=2e-4)
    loads: Wanted = Wanted(negligible=1e-4, smooth=1e-9, alike=0.01, told=True)
    # What is left out of the answer to an abrupt change comes at once, within few periods of the highest frequency:
    # so many radians of it later it has died away. Or it is so small that no instant misses more, relative L2.
    passed: float = 20.0  # [10 to 100]
    at_once: float = 1e-4  # [1e-6 to 1e-4]
    quarter: float = 0.75  # where it begins [a convention]
    # With twice as many steps the energy of the highest quarter falls to this share of it at most, or else the road
    # begins with a jump: no step would be fine enough.
    falling: float = 0.25  # [0.1 to 0.5]
    # Where every abrupt change is told, finer steps help, unless the system answers the highest frequency of
    # all with more than this share of its largest answer.
    stiff: float = 0.03  # [0.01 to 0.1]
    # Least and most steps per period.
    least: int = 256  # [64 to 1024]
    most: int = 2**22  # [2**20 to 2**26: time and memory only]
    # Share of the solved frequencies over which the road fades out.
    fades: float = 0.1  # [0.05 to 0.2]
    # The same where it changes abruptly: the wider, the sooner what is left out has died away.
    fades_abrupt: float = 1.0  # [0.5 to 2]
    # A sampled force jumps where its third differences are those of a jump, up to this share of it, and no others
    # are within so many steps.
    like: float = 0.2  # [0.1 to 0.3]
    alone: int = 6  # [4 to 8]


SAMPLING = Sampling()


class Excited(NamedTuple):
    """What drives a system, in steps that are fine enough, and up to where it is solved."""

    line: Line
    spectra: ComplexArray  # (part, *case, port, frequency), as far as they are solved
    begins: tuple[float, ...]  # from when on each part acts [s]
    truncation: Truncation
    fade: FloatArray  # (frequency,) what of each frequency is solved: 1, past what is negligible less
    left_out: float  # of any output, relative L2, where no step that is allowed is fine enough

    @property
    def step(self) -> float:
        """Step in which the record is solved: half a period of the highest frequency [s]."""
        return 0.5 * self.line.period / max(self.spectra.shape[-1] - 1, 1)

    @property
    def omega(self) -> ComplexArray:
        """Frequencies that are solved [rad/s]."""
        return self.line.omega(slice(self.spectra.shape[-1]))


def excited(
    system: Sized,
    given: Callable[[Line], Given],
    line: Line,
    step: float,
    *,
    truncation: float | None,
    solved_step: float | None = None,
    wanted: Wanted = SAMPLING.road,
) -> Excited:
    """Find the steps in which a record is solved.

    Parameters
    ----------
    system : System or Prescribed
        What is driven.
    given : callable
        What drives it, at the instants of any line.
    line : Line
        The record.
    step : float
        From station to station of the profile, or from sample to sample of the forces [s].
    truncation : float, optional
        Frequency beyond which the road counts as rigid [Hz]; None: it is found.
    solved_step : float, optional
        Steps that are stated [s].
    wanted : Wanted
        How much is solved.

    Returns
    -------
    Excited
        Spectra of what drives it, and what of them need not be solved.
    """
    points = max(SAMPLING.per_station * line.period / step, SAMPLING.least)
    if solved_step is not None:
        points = np.ceil(line.period / solved_step)
    before = np.inf
    with unthreaded():
        while True:
            points = scipy.fft.next_fast_len(int(points), real=True)
            line = replace(line, points=points)
            driving = given(line)
            magnitudes = line.magnitudes(driving)
            found = influence(system, line, magnitudes, truncation, wanted.alike)
            highest = found.content(int(SAMPLING.quarter * line.size))
            # Beyond this frequency what an abrupt change adds has passed when the next sample is taken.
            passed = int(SAMPLING.passed * line.period / (2 * np.pi * line.clear(driving)))
            at_once = SAMPLING.at_once / np.sqrt(line.size)
            enough = solved_step is not None or (
                highest <= wanted.negligible and (passed <= SAMPLING.quarter * line.size or highest <= at_once)
            )
            if enough or points >= SAMPLING.most:
                break
            if highest**2 > SAMPLING.falling * before and not (wanted.told and _stiffens(system, line, found)):
                break
            points, before = 2 * points, highest**2
    ends = line.size
    if solved_step is None:
        ends = found.negligible_from(
            found.whole, wanted.negligible if driving.abrupt else wanted.smooth, magnitudes
        )
        if passed > ends:
            ends = min(passed, found.negligible_from(found.whole, at_once, magnitudes))
    fades = SAMPLING.fades_abrupt if driving.abrupt else SAMPLING.fades
    count = min(int(ends * (1 + fades)) + 2, line.size)
    spectra = line.parts(driving)[..., :count]
    fade = np.ones(count)
    if count < line.size:
        # What a sharp cut discards would ring on, and the window raises what comes late.
        fading = count - ends
        fade[ends:] -= smooth_step(np.arange(1, fading + 1) / fading)
        spectra *= fade
    if truncation is None:
        kept = min(found.negligible_from(found.added, TRUNCATION.negligible, magnitudes), count)
        # Where the response to rest alone is kept, some frequency below the next.
        truncation = max(kept - 1, 0.5 * (kept > 0)) / line.period
    cut = Truncation(frequency=truncation)
    cut = replace(cut, error=found.error(cut.untouched(line.omega())))
    return Excited(line, spectra, driving.begins, cut, fade, 0.0 if enough else highest)


def isolated_jumps(forces: FloatArray) -> FloatArray:
    """Find where sampled forces jump: what is smooth has no third differences like it, and noise has many.

    Parameters
    ----------
    forces : ndarray, shape (time, load)
        Forces [N].

    Returns
    -------
    ndarray, shape (load,)
        Largest isolated jump of each [N]; 0 if there is none.

    Examples
    --------
    >>> time = np.arange(100)
    >>> isolated_jumps(np.stack([5.0 * (time > 40), np.sin(0.1 * time), time % 3.0], axis=1)).tolist()
    [5.0, 0.0, 0.0]
    """
    reach = SAMPLING.alone
    third = np.diff(np.pad(forces, ((reach + 1, reach + 1), (0, 0)), mode="edge"), n=3, axis=0)
    # A jump J makes J, -2 J, J.
    middle = third[reach:-reach]
    size = 0.5 * np.abs(middle)
    others = np.zeros_like(size)
    for away in range(1, reach + 1):
        expected = -0.5 * middle if away == 1 else 0.0
        for shift in (-away, away):
            there = third[reach + shift : len(third) - reach + shift]
            others = np.maximum(others, np.abs(there - expected))
    found: FloatArray = np.where(others < SAMPLING.like * size, size, 0.0).max(axis=0)
    return found


def _stiffens(system: Sized, line: Line, found: Influence) -> bool:
    """Tell whether a system answers the highest frequency of all with little."""
    highest = replace(line, points=SAMPLING.most)
    answered = system.per_unit(highest.omega(slice(highest.size - 1, None)))[1][..., 0]
    return bool((answered <= SAMPLING.stiff * found.whole.gain.max(axis=-1)).all())

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
class Sampling:
    """What tunes the steps of the solution; in brackets, between what each number is safe."""

    # Steps from station to station of a profile at first; twice as many, and so on, until they are enough.
    per_station: float = 4.0  # [2 to 8]
    # What of any output may lie in the highest quarter of the frequencies, and beyond what is solved, relative L2.
    # Where that turns out to be more than `tolerated` of the largest value of a channel, so much less, and again.
    negligible: float = 3e-5  # [1e-6 to 1e-4]
    tolerated: float = 3e-4  # [1e-4 to 5e-4]
    rounds: int = 3  # [2 to 5]
    # Where the highest quarter begins; what lies beyond holds at most so many times its energy.
    quarter: float = 0.75  # [a convention]
    beyond: float = 3.0  # [1 to 4]
    # With four times as many steps the energy there falls to this share of it at most, or else the road begins with
    # a jump: no step would be fine enough.
    falling: float = 0.25  # [0.1 to 0.5]
    # Least steps per period, and most for all ports together.
    least: int = 256  # [64 to 1024]
    most: int = 2**23  # [2**21 to 2**27: time and memory only]
    # Share of the solved frequencies over which the road fades out.
    fades: float = 0.1  # [0.05 to 0.2]
    # For figures a channel is as large as this share of the largest of its kind at least: one that hardly moves is
    # no matter. From the other one on, what a stated truncation changes is computed rather than estimated.
    smallest: float = 1e-3  # [a convention]
    estimated: float = 1e-4  # [1e-5 to 5e-4]


SAMPLING = Sampling()


class Excited(NamedTuple):
    """What drives a system, in steps that are fine enough, and up to where it is solved."""

    line: Line
    spectra: ComplexArray  # (*case, port, frequency), as far as they are solved
    truncation: Truncation
    ends: int  # number of the frequency from which on they fade out
    finest: bool  # whether no finer step would help, or none was to be looked for
    beyond: FloatArray  # (output,) what lies beyond over what lies in the highest octave that is solved
    not_shown: FloatArray  # (output,) share of it, relative L2, beyond the Nyquist frequency of the record

    @property
    def step(self) -> float:
        """Step in which the record is solved: half a period of the highest frequency [s]."""
        return 0.5 * self.line.period / max(self.spectra.shape[-1] - 1, 1)

    @property
    def omega(self) -> ComplexArray:
        """Frequencies that are solved [rad/s]."""
        return self.line.omega(slice(self.spectra.shape[-1]))

    def likewise(self, given: Given) -> ComplexArray:
        """Spectra of something else, as far as this is solved."""
        return _ended(self.line.spectra(given), self.ends, self.spectra.shape[-1])


def excited(
    system: Sized,
    given: Callable[[Line], Given],
    line: Line,
    step: float,
    *,
    truncation: float | None,
    solved_step: float | None = None,
    negligible: float = SAMPLING.negligible,
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
        Step that is stated [s].
    negligible : float
        What of any output may be left out, relative L2.

    Returns
    -------
    Excited
        Spectra of what drives it, and what of them need not be solved.
    """
    points = max(SAMPLING.per_station * line.period / step, SAMPLING.least)
    stated = None if solved_step is None else int(np.ceil(0.5 * line.period / solved_step)) + 1
    if stated is not None:
        points = max(points, 2.0 * stated)
    energies = [np.inf, np.inf]
    with unthreaded():
        while True:
            line = replace(line, points=scipy.fft.next_fast_len(int(points), real=True))
            driving = given(line)
            ports = driving.values[..., 0].size
            magnitudes = line.magnitudes(driving.values)
            found = influence(system, line, magnitudes, truncation)
            highest = found.content(int(SAMPLING.quarter * line.size))
            finest = 2 * points * ports > SAMPLING.most or highest**2 > SAMPLING.falling * energies[-2]
            if finest or stated is not None or highest <= negligible:
                break
            points, energies = 2 * points, [*energies, highest**2]
    if stated is None:
        ends = found.negligible_from(found.whole, negligible, magnitudes)
        count = min(int(ends * (1 + SAMPLING.fades)) + 2, line.size)
    else:
        count = min(stated, line.size)
        ends = int(count / (1 + SAMPLING.fades))
    if truncation is None:
        kept = min(found.negligible_from(found.added, TRUNCATION.negligible, magnitudes), count)
        # Where the response to rest alone is kept, some frequency below the next.
        truncation = max(kept - 1, 0.5 * (kept > 0)) / line.period
    cut = Truncation(frequency=truncation)
    cut = replace(cut, error=found.error(cut.untouched(line.omega()), count))
    return Excited(
        line=line,
        spectra=_ended(line.spectra(driving), ends, count),
        truncation=cut,
        ends=ends,
        finest=finest or stated is not None,
        beyond=_beyond(found, ends, count),
        not_shown=found.shares(line.padded // 2 + 1, count),
    )


def _ended(spectra: ComplexArray, ends: int, count: int) -> ComplexArray:
    """Let spectra fade out between two numbers of frequencies.

    What a sharp cut discards would ring on, and the window raises what comes late.
    """
    spectra = spectra[..., :count]
    fading = count - ends
    spectra[..., ends:] *= 1.0 - smooth_step(np.arange(1, fading + 1) / fading)
    return spectra


def _beyond(found: Influence, ends: int, count: int) -> FloatArray:
    """Give the ratio of what is not solved to the highest octave that is, of each output, relative L2."""
    lines = found.lines
    not_solved = found.shares(ends, lines) ** 2
    not_sampled = SAMPLING.beyond * found.shares(int(SAMPLING.quarter * lines), lines) ** 2
    octave = found.shares(count // 2, count)
    return np.sqrt(np.divide(not_solved + not_sampled, octave**2, out=np.zeros_like(octave), where=octave > 0))

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
from movingfrf.response.influence import Sized, influence
from movingfrf.response.line import Given, Line
from movingfrf.response.truncation import TRUNCATION, Truncation


@dataclass(frozen=True, slots=True, kw_only=True)
class Sampling:
    """What tunes the steps of the solution; in brackets, between what each number is safe."""

    # Steps from station to station of a profile at first; twice as many, and so on, until they are enough.
    per_station: float = 4.0  # [2 to 8]
    # What of any output may lie in the highest quarter of the frequencies, and beyond what is solved, relative L2.
    negligible: float = 3e-5  # [1e-6 to 1e-4]
    quarter: float = 0.75  # where it begins [a convention]
    # With four times as many steps the energy there falls to this share of it at most, or else the road begins with a
    # jump: no step would be fine enough.
    falling: float = 0.25  # [0.1 to 0.5]
    # Least and most steps per period.
    least: int = 256  # [64 to 1024]
    most: int = 2**22  # [2**20 to 2**26: time and memory only]
    # Share of the solved frequencies over which the road fades out.
    fades: float = 0.1  # [0.05 to 0.2]


SAMPLING = Sampling()


class Excited(NamedTuple):
    """What drives a system, in steps that are fine enough, and up to where it is solved."""

    line: Line
    spectra: ComplexArray  # (*case, port, frequency), as far as they are solved
    truncation: Truncation
    highest: float  # of any output, relative L2, in the highest quarter of the frequencies that were looked at
    not_shown: FloatArray  # (output,) share of it, relative L2, beyond the Nyquist frequency of the record

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

    Returns
    -------
    Excited
        Spectra of what drives it, and what of them need not be solved.
    """
    points = max(SAMPLING.per_station * line.period / step, SAMPLING.least)
    if solved_step is not None:
        points = np.ceil(line.period / solved_step)
    before = [np.inf, np.inf]
    with unthreaded():
        while True:
            points = scipy.fft.next_fast_len(int(points), real=True)
            line = replace(line, points=points)
            driving = given(line)
            magnitudes = line.magnitudes(driving.values)
            found = influence(system, line, magnitudes, truncation)
            highest = found.content(int(SAMPLING.quarter * line.size))
            enough = solved_step is not None or highest <= SAMPLING.negligible
            if enough or points >= SAMPLING.most or highest**2 > SAMPLING.falling * before[-2]:
                break
            points, before = 2 * points, [*before, highest**2]
    ends = line.size
    if solved_step is None:
        ends = found.negligible_from(found.whole, SAMPLING.negligible, magnitudes)
    count = min(int(ends * (1 + SAMPLING.fades)) + 2, line.size)
    spectra = line.spectra(driving)[..., :count]
    if count < line.size:
        # What a sharp cut discards would ring on, and the window raises what comes late.
        fading = count - ends
        spectra[..., ends:] *= 1.0 - smooth_step(np.arange(1, fading + 1) / fading)
    if truncation is None:
        kept = min(found.negligible_from(found.added, TRUNCATION.negligible, magnitudes), count)
        # Where the response to rest alone is kept, some frequency below the next.
        truncation = max(kept - 1, 0.5 * (kept > 0)) / line.period
    cut = Truncation(frequency=truncation)
    cut = replace(cut, error=found.error(cut.untouched(line.omega()), count))
    return Excited(line, spectra, cut, highest, found.shares(line.padded // 2 + 1, count))

"""The one loop over frequencies: chunk by chunk, within the processor's cache, on one thread."""

from __future__ import annotations

import math
from typing import Protocol, TypeVar

import numpy as np

from movingfrf._basics.arrays import ComplexArray
from movingfrf._basics.checks import SolveError
from movingfrf._basics.progress import Progress, silent
from movingfrf.response.batches import BATCH
from movingfrf.response.truncation import EVERYWHERE, Truncation

Answer = TypeVar("Answer", bound=tuple[ComplexArray, ...], covariant=True)


class Solvable(Protocol[Answer]):
    """What can be solved frequency by frequency: `System` and `Prescribed`."""

    @property
    def speed(self) -> float:
        """Speed [m/s]."""
        ...

    @property
    def words(self) -> str:
        """What a message begins with that says what it has not."""
        ...

    @property
    def entries(self) -> int:
        """Entries of a matrix at one frequency: they decide how many frequencies are solved at a time."""
        ...

    def answer(self, omega: ComplexArray, given: ComplexArray, truncation: Truncation) -> Answer:
        """Answer some frequencies; a part may end where the guideway begins to count as rigid."""
        ...


def solve(
    system: Solvable[Answer],
    omega: ComplexArray,
    given: ComplexArray,
    *,
    truncation: Truncation = EVERYWHERE,
    progress: Progress = silent,
) -> Answer:
    """Solve a system for any number of cases.

    Parameters
    ----------
    system : System or Prescribed
        A vehicle on a guideway, or prescribed forces on one.
    omega : ndarray, shape (frequency,)
        Angular frequencies [rad/s]; ascending, if there is a truncation.
    given : ndarray, shape (*case, port, frequency)
        Elevation under the contacts [m], or forces of the loads [N].
    truncation : Truncation
        Where the guideway begins to count as rigid.
    progress : callable
        Called with the name of the stage and the fraction of it that is done.

    Returns
    -------
    Response or Yielding
        The answer, each part of shape (*case, port, frequency).

    Raises
    ------
    SolveError
        If an answer is not finite.

    Notes
    -----
    Cases do not see each other: two at once are the same as one after the other.
    """
    progress("solving", 0.0)
    rows = math.prod(given.shape[:-1])
    step = BATCH.frequencies(max(system.entries, rows))
    answer = system.answer(omega[:step], given[..., :step], truncation)
    if omega.size > step:
        parts = [np.zeros((*part.shape[:-1], omega.size), complex) for part in answer]
        ends = [0] * len(parts)
        for first in range(0, omega.size, step):
            if first:
                some = slice(first, first + step)
                answer = system.answer(omega[some], given[..., some], truncation)
            for number, (whole, part) in enumerate(zip(parts, answer, strict=True)):
                if part.shape[-1]:
                    ends[number] = first + part.shape[-1]
                    whole[..., first : ends[number]] = part
            progress("solving", min(first + step, omega.size) / omega.size)
        answer = type(answer)(*(part[..., :end] for part, end in zip(parts, ends, strict=True)))
    # A sum is finite only if all of its terms are.
    if not all(np.isfinite(part.sum()) for part in answer):
        _refuse(system, omega, answer)
    return answer


def _refuse(system: Solvable[Answer], omega: ComplexArray, parts: tuple[ComplexArray, ...]) -> None:
    """Say at which frequency there is no answer."""
    bad = np.zeros(omega.size, bool)
    for part in parts:
        bad[: part.shape[-1]] |= ~np.isfinite(part).all(axis=tuple(range(part.ndim - 1)))
    at = f"{omega[bad][0].real / (2 * np.pi):.6g} Hz and " if bad.any() else ""
    raise SolveError(
        f"{system.words} no finite response at {at}{system.speed:g} m/s: a vibration without damping is driven at "
        "its own frequency, or the numbers leave the range of floating point"
    )

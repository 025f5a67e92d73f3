"""How little of a record is in its short waves, told by a filter that leaves out the long ones."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray


@dataclass(frozen=True, slots=True, kw_only=True)
class HighPass:
    """What tunes the filter; in brackets, between what each number is safe."""

    # It is a polynomial of this order in 2 sin ½θ, θ the turn of a wave from sample to sample. The higher the
    # order, the more it makes of rounding.
    order: int = 12  # [10 to 14, even]
    # It leaves out waves of so many samples and more.
    longest: float = 17.0  # [12 to 20]


HIGH_PASS = HighPass()


@cache
def _zeros() -> tuple[float, ...]:
    """Squares of 2 sin ½θ at the waves that it leaves out altogether, each of them once for both directions.

    Of all polynomials Chebyshev's rise most steeply beyond an interval within which they are small; twice zero is
    left out as well, since long waves are great.
    """
    edge, order = 2.0 * np.sin(np.pi / HIGH_PASS.longest), HIGH_PASS.order - 2
    turns = np.pi * (np.arange(order // 2) + 0.5) / order
    return (0.0, *np.square(edge * np.cos(turns)).tolist())


def filtered(record: FloatArray) -> FloatArray:
    """Leave out long waves; there are fewer samples by the order of the filter.

    Examples
    --------
    >>> n = np.arange(400.0)
    >>> long, short = (np.abs(filtered(np.sin(2 * np.pi * n / length))).max() for length in (50.0, 8.0))
    >>> bool(long < 1e-7 * short)
    True
    """
    for zero in _zeros():
        neighbours = record[:-2] + record[2:]
        record = (2.0 - zero) * record[1:-1]
        record -= neighbours
    return record


@cache
def _passed(samples: float) -> float:
    """Least share that the filter leaves of the energy of waves shorter than so many samples."""
    turned = (2.0 * math.sin(math.pi / samples)) ** 2
    return math.prod(turned - zero for zero in _zeros()) ** 2


class ShortWaves(NamedTuple):
    """Energy of what the filter leaves of records with even samples."""

    energy: FloatArray  # (record,) ∫ r² dx, filtered
    whole: float  # the same of all of the longest record, roughly

    def shorter(self, samples: float) -> FloatArray:
        """Bound what is in waves shorter than so many samples, ∫ r² dx, shape (record,).

        Examples
        --------
        >>> wave = np.sin(2 * np.pi / 4.0 * np.arange(1000.0))
        >>> energy = np.square(filtered(wave)).sum()
        >>> ShortWaves(np.array([energy]), 500.0).shorter(4.0).round().tolist()
        [494.0]
        """
        if not 2.0 <= samples < HIGH_PASS.longest:
            return np.full_like(self.energy, np.inf)
        return self.energy / _passed(samples)

    def shortest(self, share: float) -> float | None:
        """Find so many samples that no more than a share of any record, root mean square, is in shorter waves.

        None where that cannot be said.

        Examples
        --------
        >>> wave = np.sin(2 * np.pi / 11.5 * np.arange(1000.0))
        >>> energy = np.square(filtered(wave)).sum()
        >>> ShortWaves(np.array([energy]), 500.0).shortest(1e-2)
        8.0
        """
        most = share**2 * self.whole
        for samples in np.arange(math.ceil(HIGH_PASS.longest) - 1.0, 2.0, -1.0).tolist():
            if float(self.shorter(samples).max(initial=0.0)) <= most:
                return samples
        return None

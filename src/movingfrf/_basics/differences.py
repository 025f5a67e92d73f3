"""What differences of samples tell of their short waves, and of those between them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray


class Differences(NamedTuple):
    """Energy of the n-th differences of records with even samples.

    The n-th difference of a wave that advances by θ from sample to sample is (2 sin ½θ)ⁿ times the wave: that of
    short waves is great.
    """

    order: int
    energy: FloatArray  # (record,) ∫ (Δⁿ r)² dx
    whole: float  # the same of all of the longest record, roughly, without differences

    def shorter(self, samples: float) -> FloatArray:
        """Bound what is in waves shorter than so many samples, ∫ r² dx, shape (record,).

        Examples
        --------
        >>> wave = np.sin(2 * np.pi / 4.0 * np.arange(1000.0))
        >>> energy = np.square(np.diff(wave, n=8)).sum()
        >>> Differences(8, np.array([energy]), 500.0).shorter(4.0).round().tolist()
        [496.0]
        """
        if samples < 2.0:
            return np.full_like(self.energy, np.inf)
        return self.energy / (2.0 * np.sin(np.pi / samples)) ** (2 * self.order)

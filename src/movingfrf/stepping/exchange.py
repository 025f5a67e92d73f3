"""Contact forces exchanged between vehicle and guideway until both agree."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray

# Contact forces [N] that are nothing, and that are beyond all measure: the exchange of forces has run away. The
# compiled loops read them too, which know no other kind of constant.
# [1e-15 to 1e-3; 1e20 to 1e100]
TINY, HUGE = 1e-9, 1e30


class Iteration(NamedTuple):
    """How contact forces are found in each step: solved for (tolerance 0), or exchanged until they agree."""

    tolerance: float = 0.0  # relative change of the forces at which they agree
    most: int = 50


SOLVED = Iteration()


def exchanged(
    matrix: FloatArray, right: FloatArray, force: FloatArray, iteration: Iteration
) -> tuple[FloatArray, int]:
    """Exchange contact forces until they agree; −1 if they do not."""
    for count in range(1, iteration.most + 1):
        fresh = right + force - matrix @ force
        change, size = np.abs(fresh - force).max(), np.abs(fresh).max()
        force = fresh
        if change <= iteration.tolerance * size or size < TINY:
            return force, count
        if not size < HUGE:
            break
    return force, -1

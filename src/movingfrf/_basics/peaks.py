"""The largest and the smallest value of a record, between its samples too."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np

from movingfrf._basics.arrays import FloatArray, handed
from movingfrf._basics.compiling import loops_for


@dataclass(frozen=True, slots=True, kw_only=True)
class Between:
    """What tunes how values between samples are found; in brackets, between what each number is safe."""

    # Samples on either side that tell a value between two of them, and in how many places it is looked for.
    reach: int = 10  # [8 to 16]
    places: int = 8  # [6 to 16]
    # Shape of the window over the samples: what is below seven tenths of the Nyquist frequency comes out to 1e-4.
    shape: float = 9.0  # [8 to 10]
    # Extremes of which a parabola through three samples tells less than of the largest one, by so many times the
    # largest step from sample to sample, are looked at no further.
    near: float = 0.25  # [0.2 to 1: time only]


BETWEEN = Between()


@cache
def weights() -> FloatArray:
    """Weights of the samples around one for a value some way after it, shape (place, sample).

    Those of a sine over its argument, under a Kaiser window; a constant stays what it is.
    """
    after = np.arange(-BETWEEN.places, BETWEEN.places + 1)[:, None] / BETWEEN.places
    away = after - np.arange(-BETWEEN.reach, BETWEEN.reach + 1)
    share = np.clip(1.0 - np.square(away / (BETWEEN.reach + 1)), 0.0, None)
    found = np.sinc(away) * np.i0(BETWEEN.shape * np.sqrt(share))
    found /= found.sum(axis=1, keepdims=True)
    # At a sample the value is the sample.
    found[BETWEEN.places] = np.arange(-BETWEEN.reach, BETWEEN.reach + 1) == 0
    return np.asarray(found)


def extremes(records: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Find the smallest and the largest value of records that their samples show.

    What lies between samples is interpolated. At the ends, where there are none on one side, it is not followed as
    closely: a parabola through three samples tells.

    Parameters
    ----------
    records : ndarray, shape (*s, time)
        Records in even steps.

    Returns
    -------
    smallest, largest : ndarray, shape (*s)
        In the unit of the records.

    Examples
    --------
    >>> wave = np.sin(2 * np.pi * 0.3 * np.arange(200.0) + 0.4)
    >>> low, high = extremes(wave)
    >>> round(float(np.abs(wave).max()), 3), round(float(low), 4), round(float(high), 4)
    (0.996, -1.0001, 1.0001)
    """
    rows = records.reshape(-1, records.shape[-1])
    apart = np.diff(rows)
    steps = np.maximum(apart.max(axis=1, initial=0.0), -apart.min(axis=1, initial=0.0))
    if loops := loops_for("_basics.compiled", rows.size // 16):
        sampled = np.stack([rows.min(axis=1), rows.max(axis=1)], axis=1)
        found = loops.extremes(handed(rows, float), sampled, steps, handed(weights(), float), BETWEEN.near)
    else:
        each = zip(rows, steps.tolist(), strict=True)
        found = np.array([[-_largest(-row, step), _largest(row, step)] for row, step in each]).reshape(-1, 2)
    return found[:, 0].reshape(records.shape[:-1]), found[:, 1].reshape(records.shape[:-1])


def _largest(row: FloatArray, step: float) -> float:
    """Largest value of a record with this largest step from sample to sample."""
    sampled = float(row.max())
    before, here, after = row[:-2], row[1:-1], row[2:]
    bend = before - 2.0 * here + after
    at = np.flatnonzero((here >= before) & (here >= after) & (bend < 0.0))
    if not at.size:
        return sampled
    told = here[at] - 0.125 * np.square(after[at] - before[at]) / bend[at]
    close = told >= told.max() - BETWEEN.near * step
    at, told = at[close] + 1, told[close]
    inside = (at >= BETWEEN.reach) & (at < row.size - BETWEEN.reach)
    largest = max(sampled, float(told[~inside].max(initial=sampled)))
    if inside.any():
        around = row[at[inside, None] + np.arange(-BETWEEN.reach, BETWEEN.reach + 1)] @ weights().T
        top = np.clip(around.argmax(axis=1), 1, 2 * BETWEEN.places - 1)
        low, middle, high = (around[np.arange(top.size), top + aside] for aside in (-1, 0, 1))
        bend = np.where((middle >= low) & (middle >= high), low - 2.0 * middle + high, 0.0)
        above = np.divide(np.square(high - low), -8.0 * bend, out=np.zeros_like(bend), where=bend < 0.0)
        largest = max(largest, float((middle + above).max()))
    return largest

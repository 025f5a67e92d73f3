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
    places: int = 16  # [6 to 32]
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
    if loops := loops_for("_basics.compiled", rows.size // 16):
        apart = np.diff(rows)
        steps = np.maximum(apart.max(axis=1, initial=0.0), -apart.min(axis=1, initial=0.0))
        sampled = np.stack([rows.min(axis=1), rows.max(axis=1)], axis=1)
        found = loops.extremes(handed(rows, float), sampled, steps, handed(weights(), float), BETWEEN.near)
    else:
        found = np.array([[-largest_of(-row)[0], largest_of(row)[0]] for row in rows]).reshape(-1, 2)
    return found[:, 0].reshape(records.shape[:-1]), found[:, 1].reshape(records.shape[:-1])


def largest_of(record: FloatArray) -> tuple[float, FloatArray]:
    """Find the largest value of a record, between its samples too, and how it changes with each of them.

    Parameters
    ----------
    record : ndarray, shape (time,)
        In even steps.

    Returns
    -------
    largest : float
        As `extremes` finds it.
    weights : ndarray, shape (time,)
        Its derivative by each sample.

    Examples
    --------
    >>> value, weights = largest_of(np.array([0.0, 3.0, 3.0, 0.0]))
    >>> value, weights.tolist()
    (3.375, [-0.125, 0.75, 0.375, 0.0])
    """
    first = int(record.argmax())
    best: tuple[float, int, FloatArray] = (float(record[first]), first, np.ones(1))
    around = BETWEEN.reach
    near = BETWEEN.near * float(np.abs(np.diff(record)).max(initial=0.0))
    before, here, after = record[:-2], record[1:-1], record[2:]
    bend = before - 2.0 * here + after
    at = np.flatnonzero((here >= before) & (here >= after) & (bend < 0.0))
    told = here[at] - 0.125 * np.square(after[at] - before[at]) / bend[at]
    for place in (at[told >= told.max(initial=-np.inf) - near] + 1).tolist():
        inside = around <= place < record.size - around
        begins, table = (place - around, weights()) if inside else (place - 1, np.eye(3))
        values = table @ record[begins : begins + table.shape[1]]
        top = int(values[1:-1].argmax()) + 1
        middle: FloatArray = table[top]
        before_it, value, after_it = values[top - 1 : top + 2].tolist()
        bent = before_it - 2.0 * value + after_it
        if value >= max(before_it, after_it) and bent < 0.0:
            low, high, share = table[top - 1], table[top + 1], (after_it - before_it) / bent
            value -= 0.125 * share * (after_it - before_it)
            middle = middle - 0.25 * share * (high - low) + 0.125 * share**2 * (low - 2.0 * middle + high)
        if value > best[0]:
            best = value, begins, middle
    largest, begins, middle = best
    found = np.zeros(record.size)
    found[begins : begins + middle.size] = middle
    return largest, found

"""How a record goes on, told from how it has gone: linear prediction."""

from __future__ import annotations

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.compiling import loops_for


def predicting(record: FloatArray, order: int) -> tuple[FloatArray, float]:
    """Find the coefficients that predict a record from samples before, by Burg's method: what they predict decays.

    Parameters
    ----------
    record : ndarray, shape (sample,)
        Even samples, several times as many as the order.
    order : int
        How many samples tell the next one.

    Returns
    -------
    ndarray, shape (order,)
        Coefficients of the samples before, the last one first.
    float
        Root mean square of what they miss, forward and backward, in the unit of the record.

    Notes
    -----
    J. P. Burg, Maximum entropy spectral analysis, Ph.D. thesis, Stanford University, 1975.

    Examples
    --------
    >>> wave = np.sin(0.3 * np.arange(400.0))
    >>> coefficients, missed = predicting(wave, 4)
    >>> goes_on = predicted(wave, coefficients, 3)
    >>> bool(np.abs(goes_on - np.sin(0.3 * np.arange(400.0, 403.0))).max() < 1e-4)
    True
    """
    forward, backward = record[1:].copy(), record[:-1].copy()
    loops = loops_for("_basics.compiled", record.size * order // 64)
    reflections = (loops.reflected if loops else _reflected)(forward, backward, order)
    coefficients = np.zeros(0)
    for reflection in reflections:
        coefficients = np.append(coefficients - reflection * coefficients[::-1], reflection)
    left = forward.size - reflections.size
    missed = np.concatenate([forward[:left], backward[:left]])
    return coefficients, float(np.sqrt(np.square(missed).mean()))


def _reflected(forward: FloatArray, backward: FloatArray, order: int) -> FloatArray:
    """Take reflection coefficients out of errors of prediction, in place: as many are left less."""
    reflections = np.zeros(order)
    for step in range(order):
        size = forward.size - step
        ahead, behind = forward[:size], backward[:size]
        power = float(ahead @ ahead + behind @ behind)
        if not power:
            return reflections[:step]
        reflections[step] = factor = 2.0 * float(ahead @ behind) / power
        # Forward errors move up by one, towards the next backward ones.
        forward[: size - 1], backward[:size] = (ahead - factor * behind)[1:], behind - factor * ahead
    return reflections


def predicted(record: FloatArray, coefficients: FloatArray, samples: int) -> FloatArray:
    """Predict the next samples of a record from coefficients that `predicting` found."""
    order = coefficients.size
    if loops := loops_for("_basics.compiled", samples * order // 16):
        found: FloatArray = loops.predicted(record[record.size - order :].copy(), coefficients, samples)
        return found
    known = np.concatenate([record[record.size - order :], np.zeros(samples)])
    last_first = coefficients[::-1].copy()
    for n in range(samples):
        known[order + n] = last_first @ known[n : order + n]
    return known[order:]

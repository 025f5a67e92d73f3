"""How a record goes on, told from how it has gone: linear prediction."""

from __future__ import annotations

import numpy as np

from movingfrf._basics.arrays import FloatArray


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
    forward, backward, coefficients = record[1:], record[:-1], np.zeros(0)
    for _ in range(order):
        size = float(forward @ forward + backward @ backward)
        if not size:
            break
        reflection = 2.0 * float(forward @ backward) / size
        coefficients = np.append(coefficients - reflection * coefficients[::-1], reflection)
        forward, backward = (forward - reflection * backward)[1:], (backward - reflection * forward)[:-1]
    missed = np.concatenate([forward, backward])
    return coefficients, float(np.sqrt(np.square(missed).mean()))


def predicted(record: FloatArray, coefficients: FloatArray, samples: int) -> FloatArray:
    """Predict the next samples of a record from coefficients that `predicting` found."""
    order = coefficients.size
    known = np.concatenate([record[record.size - order :], np.zeros(samples)])
    last_first = coefficients[::-1].copy()
    for n in range(samples):
        known[order + n] = last_first @ known[n : order + n]
    return known[order:]

"""How usual measures change with the records that they are taken of: the derivative of each, sample by sample."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf.metrics.comfort import WEIGHTING_OF, weighted
from movingfrf.metrics.listed import peak


class Slope(NamedTuple):
    """How a measure changes with a record about steady travel, and with steady travel itself."""

    record: str  # contact_force, deflection or acceleration
    place: int  # number of the contact or degree of freedom
    weights: FloatArray  # (time,) with each sample [unit of the measure per that of the record]
    load: float = 0.0  # … with the static load there [unit/N]
    sag: float = 0.0  # … with the static deflection there [unit/m]


class Records(NamedTuple):
    """What is measured: records about steady travel, each (place, time), and steady travel."""

    step: float  # of the records [s]
    contact_force: FloatArray
    deflection: FloatArray
    acceleration: FloatArray
    load: FloatArray  # (contact,) [N]
    sag: FloatArray  # (contact,) [m]
    units: Sequence[str]  # of the degrees of freedom


def of_rms(record: FloatArray) -> tuple[float, FloatArray]:
    """Root mean square, and how it changes with each sample; not at all where all is zero.

    Examples
    --------
    >>> of_rms(np.array([3.0, -4.0, 0.0, 0.0]))
    (2.5, array([ 0.3, -0.4,  0. ,  0. ]))
    """
    value = float(np.sqrt(np.mean(np.square(record))))
    return value, record / (value * record.size) if value else np.zeros_like(record)


def of_peak(record: FloatArray) -> FloatArray:
    """How the largest magnitude changes with each sample, whatever is made of those around it.

    Examples
    --------
    >>> of_peak(np.array([1.0, 0.0, -2.0, 0.0])).round(9)
    array([ 0.,  0., -1.,  0.])
    """
    # Samples to either side that may tell the peak, and what is looked at of them [>= 10; twice as many].
    reach, about = 12, 24
    top = int(np.abs(record).argmax())
    first = max(top - about, 0)
    window = record[first : top + about + 1].copy()
    # Against rounding and curvature [1e-7 to 1e-4].
    aside = 1e-5 * float(np.abs(record[top]))
    found = np.zeros_like(record)
    for number in range(max(top - first - reach, 0), min(top - first + reach + 1, window.size)) if aside else ():
        kept, ends = window[number], []
        for window[number] in (kept - aside, kept + aside):
            ends.append(float(peak(window)))
        window[number] = kept
        found[first + number] = (ends[1] - ends[0]) / (2.0 * aside)
    return found


def _force_rms(of: Records, place: int) -> Slope:
    return Slope("contact_force", place, of_rms(of.contact_force[place])[1])


def _smallest(of: Records, place: int) -> Slope:
    # So far up that the smallest value is the largest magnitude.
    force = of.contact_force[place]
    return Slope("contact_force", place, of_peak(2.0 * float(np.abs(force).max()) - force), load=1.0)


def _load_coefficient(of: Records, place: int) -> Slope:
    value, weights = of_rms(of.contact_force[place])
    load = float(of.load[place])
    return Slope("contact_force", place, weights / load, load=-value / load**2)


def _deflection_peak(of: Records, place: int) -> Slope:
    weights = of_peak(of.deflection[place] + of.sag[place])
    return Slope("deflection", place, weights, sag=float(weights.sum()))


def _weighted(of: Records, place: int) -> Slope:
    name = WEIGHTING_OF[of.units[place]]
    _, weights = of_rms(weighted(of.acceleration[place], of.step, name))
    # A filter the other way round is the filter of the record that runs backwards.
    return Slope("acceleration", place, weighted(weights[::-1], of.step, name)[::-1])


def slopes() -> Mapping[str, Callable[[Records, int], Slope]]:
    """Give them by what tables of many cases call the measure, each at the number of a place."""
    return {
        "static_load": lambda of, n: Slope("contact_force", n, np.zeros(1), load=1.0),
        "contact_force_rms": _force_rms,
        "contact_force_peak": lambda of, n: Slope("contact_force", n, of_peak(of.contact_force[n])),
        "smallest_contact_force": _smallest,
        "dynamic_load_coefficient": _load_coefficient,
        "static_deflection": lambda of, n: Slope("deflection", n, np.zeros(1), sag=1.0),
        "deflection_rms": lambda of, n: Slope("deflection", n, of_rms(of.deflection[n])[1]),
        "deflection_peak": _deflection_peak,
        "acceleration_rms": lambda of, n: Slope("acceleration", n, of_rms(of.acceleration[n])[1]),
        "acceleration_peak": lambda of, n: Slope("acceleration", n, of_peak(of.acceleration[n])),
        "weighted_acceleration_rms": _weighted,
    }

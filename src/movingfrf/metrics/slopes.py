"""How usual measures change with the records that they are taken of: the derivative of each, sample by sample."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.peaks import largest_of
from movingfrf.metrics.comfort import WEIGHTING_OF, weighted


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
    """Tell how the largest magnitude changes with each sample.

    Examples
    --------
    >>> of_peak(np.array([0.0, -3.0, -3.0, 0.0])).tolist()
    [0.125, -0.75, -0.375, -0.0]
    """
    (high, up), (low, down) = largest_of(record), largest_of(-record)
    return up if high >= low else -down


def _force_rms(of: Records, place: int) -> Slope:
    return Slope("contact_force", place, of_rms(of.contact_force[place])[1])


def _smallest(of: Records, place: int) -> Slope:
    return Slope("contact_force", place, largest_of(-of.contact_force[place])[1], load=1.0)


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

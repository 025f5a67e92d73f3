"""How measures of a ride change with keys of its scenario; see `adjoint`."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy.fft

from movingfrf._basics.arrays import ComplexArray, FloatArray
from movingfrf.metrics.slopes import Records, Slope
from movingfrf.response.adjoint import Case, Solution, Stencil, Wanted, at_rest, changes
from movingfrf.response.batches import unthreaded
from movingfrf.response.line import Given, Line
from movingfrf.response.ride import Ride, excitation_of


def records_of(ride: Ride) -> Records:
    """Give what is measured of a ride: its records as they were solved."""
    force, deflection, _, acceleration = (part.values[0] for part in ride.fine)
    step, units = ride.journey.time_step / ride.finer, ride.system.vehicle.coordinates["dof_unit"]
    steady = ride.steady
    return Records(
        step, force, deflection, acceleration, steady.load, steady.deflection, np.asarray(units).tolist()
    )


@unthreaded
def gradient(ride: Ride, slopes: Sequence[Slope], stencils: Sequence[Stencil]) -> FloatArray:
    """Say how measures of a ride change with keys of its scenario.

    Parameters
    ----------
    ride : Ride
        The ride.
    slopes : sequence of Slope
        How each measure changes with the records of the ride.
    stencils : sequence of stencils
        Of each key the cases near by, and their weights [1/unit of the key].

    Returns
    -------
    ndarray, shape (measure, key)
        Derivatives [unit of the measure per unit of the key].
    """
    driven_by, response, line = ride.driven_by, ride.response, ride.driven_by.line
    omega = driven_by.omega
    known = Solution(ride.system, omega, driven_by.truncation, *response)

    def elevation(case: Case) -> ComplexArray:
        excitation = excitation_of(case.road.profile, case.vehicle, case.journey)
        return driven_by.likewise(Given(excitation.elevation(case.journey.speed * line.instants)))[None]

    wanted = Wanted(*(np.zeros((len(slopes), *part.shape), complex) for part in response))
    places = {
        "contact_force": (wanted.force, 0),
        "deflection": (wanted.deflection, 0),
        "acceleration": (wanted.motion, 2),
    }
    for number, slope in enumerate(slopes):
        if slope.weights.any():
            there, derivative = places[slope.record]
            size = there.shape[-1]
            seen = received(line, slope.weights, size, ride.finer)
            there[number, 0, slope.place] = seen * np.conj((1j * omega[:size]) ** derivative)
    return changes(known, wanted, stencils, elevation) + at_rest(ride.system, slopes, stencils)


def received(line: Line, weights: FloatArray, size: int, finer: int) -> ComplexArray:
    """Say how Σ weights · record changes with the spectrum of the record: transpose of `Line.records`.

    Parameters
    ----------
    line : Line
        The record.
    weights : ndarray, shape (time,)
        Of its values.
    size : int
        Frequencies of the spectrum.
    finer : int
        How many values there are for each step of the record.

    Returns
    -------
    ndarray, shape (frequency,)
        c with Σ weights · record = Re Σ c* X.
    """
    padded, step = line.padded * finer, line.time_step / finer
    growth = np.exp(line.decay * step * np.arange(weights.size)) / step
    half = scipy.fft.rfft(weights * growth, padded)
    # What a period of so many samples cannot tell from lower frequencies is these.
    number = np.arange(size) % padded
    below = number < half.size
    found: ComplexArray = np.where(
        below, half[np.minimum(number, half.size - 1)], np.conj(half[np.where(below, 0, padded - number)])
    )
    found *= 2.0 / padded
    found[0] *= 0.5
    return found

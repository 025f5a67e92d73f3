"""How statistics of a random response change with keys of its scenario; see `adjoint`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from movingfrf._basics.arrays import ComplexArray, FloatArray
from movingfrf.metrics.comfort import WEIGHTING_OF, weighting
from movingfrf.metrics.loads import load_coefficient
from movingfrf.metrics.slopes import Slope
from movingfrf.response.adjoint import Case, Solution, Stencil, Wanted, at_rest, changes
from movingfrf.response.batches import unthreaded
from movingfrf.response.random import TOLERANCES, Ensemble
from movingfrf.response.solve import solve
from movingfrf.response.statistics import lift_off, peak_factor, spectral_rate
from movingfrf.response.system import System
from movingfrf.response.truncation import EVERYWHERE
from movingfrf.results.labels import RANDOM_QUANTITIES

if TYPE_CHECKING:
    import xarray as xr

# What a statistic is of the moments m0, m2 and m4 [unit² Hz^n] and the static load [N], all of shape (*s).
Moments = Callable[[FloatArray, FloatArray, FloatArray, FloatArray], FloatArray]


def statistic_slope(result: xr.Dataset, name: str, place: int) -> Slope:
    """Say how a statistic changes with the spectral densities that it is an integral of.

    Parameters
    ----------
    result : xarray.Dataset
        What `random_response` returned, at the frequencies that its integrals need.
    name : str
        The statistic, one of contacts or degrees of freedom.
    place : int
        Number of the contact or degree of freedom.

    Returns
    -------
    Slope
        Its weights are those of the densities, shape (frequency,).
    """
    frequency, bandwidth = result.frequency.values, result.bandwidth.values
    load = float(result.static_load[place]) if place < result.sizes["contact"] else 1.0
    nothing = np.zeros(frequency.size)
    if name in ("static_load", "static_deflection"):
        at_rest = {"load": 1.0} if name == "static_load" else {"sag": 1.0}
        return Slope("contact_force", place, nothing, **at_rest)
    if name == "weighted_acceleration":
        gain = np.abs(weighting(WEIGHTING_OF[str(result.dof_unit.values[place])], frequency)) ** 2
        value = float(result[name][place])
        return Slope("acceleration", place, 0.5 / value * gain * bandwidth if value else nothing)
    quantity, statistic = _taken(name)
    density = result[f"{quantity}_density"].values[:, place]
    moments = [bandwidth * frequency**power @ density for power in TOLERANCES.powers]
    made = _statistics(float(result.attrs["exposure"]))[statistic]
    at = np.array([*moments, load])
    # Against rounding and curvature, relative [1e-7 to 1e-4].
    aside = 1e-5 * np.diag(at)
    with np.errstate(invalid="ignore", divide="ignore"):
        slopes = np.nan_to_num((made(*(at + aside).T) - made(*(at - aside).T)) / (2.0 * np.diag(aside)))
    weights = sum(
        slope * bandwidth * frequency**power for slope, power in zip(slopes, TOLERANCES.powers, strict=False)
    )
    return Slope(quantity, place, np.asarray(weights), load=float(slopes[-1]))


def _taken(name: str) -> tuple[str, str]:
    """Take the name of a statistic apart: the quantity, and what is made of it."""
    for quantity in RANDOM_QUANTITIES:
        if name.startswith(f"{quantity}_"):
            return quantity, name.removeprefix(f"{quantity}_")
    return "contact_force", name


def _statistics(exposure: float) -> dict[str, Moments]:
    """Say what each statistic is."""
    return {
        "rms": lambda m0, m2, m4, load: np.sqrt(m0),
        "crossing_rate": lambda m0, m2, m4, load: spectral_rate(m2, m0),
        "peak_rate": lambda m0, m2, m4, load: spectral_rate(m4, m2),
        "irregularity": lambda m0, m2, m4, load: spectral_rate(m2, m0) / spectral_rate(m4, m2),
        "expected_peak": lambda m0, m2, m4, load: np.sqrt(m0) * peak_factor(spectral_rate(m2, m0) * exposure),
        "dynamic_load_coefficient": lambda m0, m2, m4, load: load_coefficient(np.sqrt(m0), load),
        "lift_off_share": lambda m0, m2, m4, load: lift_off(load, np.sqrt(m0), spectral_rate(m2, m0))[0],
        "lift_off_rate": lambda m0, m2, m4, load: lift_off(load, np.sqrt(m0), spectral_rate(m2, m0))[1],
    }


@unthreaded
def random_gradient(
    case: Case, frequency: FloatArray, statistics: Sequence[Slope], stencils: Sequence[Stencil]
) -> FloatArray:
    """Say how statistics of a random response change with keys of its scenario.

    Parameters
    ----------
    case : Case
        The vehicle on the road.
    frequency : ndarray, shape (frequency,)
        Those that the integrals need [Hz].
    statistics : sequence of Statistic
        How each changes with the spectral densities of its quantity, times the bandwidth of the frequencies.
    stencils : sequence of stencils
        Of each key the cases near by, and their weights [1/unit of the key].

    Returns
    -------
    ndarray, shape (statistic, key)
        Derivatives [unit of the statistic per unit of the key].
    """
    omega = 2 * np.pi * frequency + 0j

    def elevation(case: Case) -> ComplexArray:
        spectrum, coherence = case.road.spectrum, case.road.coherence
        assert spectrum is not None
        shared = 1.0 if coherence is None else coherence
        ensemble = Ensemble(vehicle=case.vehicle, spectrum=spectrum, coherence=shared, speed=case.journey.speed)
        return ensemble.amplitudes(frequency)

    system = System.of(case.guideway, case.vehicle, case.journey.speed)
    response = solve(system, omega, elevation(case))
    wanted = Wanted(*(np.zeros((len(statistics), *part.shape), complex) for part in response))
    for number, (quantity, place, weights, *_) in enumerate(statistics):
        kind = [*RANDOM_QUANTITIES].index(quantity)
        part = response[min(kind, 2)][:, place]
        wanted[min(kind, 2)][number, :, place] = 2.0 * weights * part * (omega.real**4 if kind == 3 else 1.0)
    known = Solution(system, omega, EVERYWHERE, *response)
    return changes(known, wanted, stencils, elevation) + at_rest(system, statistics, stencils)

"""Random roads by realisations: many journeys over seeded roads, for comparison with the closed form."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

import movingfrf as mf
from tests.helpers import DAMPED, FULL_TRUCK, HALF_TRUCK

# What of a journey is looked at: the first seconds belong to the start, where the road sets in and vibrations build
# up (the slowest of the trucks decays as e^(−0.37 t), its variance twice as fast).
DURATION, DISCARDED, STEP = 24.0, 8.0, 2e-3

# Edges of the bands [Hz] in which variances are compared.
BANDS = np.array([0.3, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 60.0])


class Case(NamedTuple):
    """A vehicle on an elastic road, and what its surface is like."""

    vehicle: mf.Vehicle
    guideway: object = DAMPED["euler_bernoulli_winkler"]
    spectrum: object = mf.IsoRoad.of_class("A", band=(0.01, 6.0))
    speed: float = 10.0
    across: tuple[float, ...] | None = None
    coherence: object = None

    def predicted(self, **more):
        """Stationary response, in closed form."""
        return mf.random_response(
            self.guideway, self.vehicle, self.spectrum, speed=self.speed, coherence=self.coherence, **more
        )

    def travelled(self, seed: int):
        """One journey over one road."""
        ends = self.vehicle.positions
        road = mf.realise(
            self.spectrum,
            length=self.speed * DURATION + np.ptp(ends) + 1.0,
            start=ends.min() - 0.5,
            seed=seed,
            across=self.across,
            coherence=None if self.across is None else self.coherence,
        )
        return mf.simulate(self.guideway, self.vehicle, road, speed=self.speed, duration=DURATION, time_step=STEP)


CASES = {
    "half truck": Case(mf.half_car(**HALF_TRUCK)),
    "full truck, two paths": Case(
        mf.full_car(**FULL_TRUCK), across=FULL_TRUCK["sides"], coherence=mf.IsotropicCoherence()
    ),
}


class Comparison(NamedTuple):
    """Observed and expected variances, (response, band) with everything in the last band, and peaks (response,)."""

    names: list[str]
    mean: np.ndarray
    error: np.ndarray  # standard error of the mean
    expected: np.ndarray
    peak: np.ndarray  # mean of the largest value over its expectation

    @property
    def t(self) -> np.ndarray:
        """Student's t of every variance."""
        return (self.mean - self.expected) / self.error


def records(result) -> np.ndarray:
    """Responses about their steady state, start discarded, shape (response, time)."""
    late = result.isel(time=slice(round(DISCARDED / STEP), None))
    deflection = late.deflection - late.static_deflection
    return np.concatenate([late.contact_force.values, deflection.values, late.acceleration.values], axis=1).T


def names(result) -> list[str]:
    """Names of the responses, in the order of `records`."""
    contacts = [f"{what} {n}" for what in ("force", "deflection") for n in result.contact.values]
    return [*contacts, *(f"{dof} acceleration" for dof in result.dof.values)]


def densities(result) -> np.ndarray:
    """Predicted densities in the same order, (response, frequency)."""
    return np.concatenate(
        [result.contact_force_density, result.deflection_density, result.acceleration_density], axis=1
    ).T


def in_bands(periodogram: np.ndarray) -> np.ndarray:
    """Sum over the bands, and over everything, along the last axis."""
    samples = round((DURATION - DISCARDED) / STEP)
    number = np.digitize(np.fft.rfftfreq(samples, STEP), BANDS)
    bands = [periodogram[..., number == n].sum(axis=-1) for n in range(1, len(BANDS))]
    return np.stack([*bands, periodogram.sum(axis=-1)], axis=-1)


def window() -> np.ndarray:
    """Hann's window, of unit mean square."""
    taper = np.hanning(round((DURATION - DISCARDED) / STEP) + 2)[1:-1]
    return taper / np.sqrt(np.mean(taper**2))


def observed(record: np.ndarray) -> np.ndarray:
    """Variance of a record in each band, from its tapered periodogram, (response, band)."""
    spectrum = np.abs(np.fft.rfft(record * window())) ** 2 / record.shape[-1] ** 2
    spectrum[..., 1:] *= 2
    return in_bands(spectrum)


def expected(case: Case, finer: int = 16) -> np.ndarray:
    """Predict what `observed` is on average, leakage of the window included, (response, band).

    Sampled at t = kΔt, a process with the density S has the autocovariance R_k = ∫ S cos ωt df, and its tapered
    periodogram the expectation Σ_k R_k a_k e^{−iωt}/N with a the autocorrelation of the taper.
    """
    taper = window()
    count = finer * taper.size
    frequency = np.fft.rfftfreq(count, STEP)
    density = densities(case.predicted(frequency=frequency))
    covariance = np.fft.irfft(density) / (2 * STEP)
    padded = np.fft.irfft(np.abs(np.fft.rfft(taper, 2 * taper.size)) ** 2)
    product = np.concatenate(
        [covariance[:, : taper.size], np.zeros((len(density), 1)), covariance[:, 1 - taper.size :]], 1
    )
    spectrum = np.fft.rfft(product * padded)[:, ::2].real / taper.size**2
    spectrum[:, 1:] *= 2
    return in_bands(spectrum)


def compared(case: Case, seeds: Iterable[int]) -> Comparison:
    """Journeys over many roads against the closed form."""
    energies, peaks = [], []
    for seed in seeds:
        result = case.travelled(seed)
        record = records(result)
        energies.append(observed(record))
        peaks.append(record.max(axis=1))
    prediction = case.predicted(exposure=DURATION - DISCARDED)
    peak = [prediction[f"{name}_expected_peak"] for name in ("contact_force", "deflection", "acceleration")]
    return Comparison(
        names(result),
        np.mean(energies, axis=0),
        np.std(energies, axis=0, ddof=1) / np.sqrt(len(energies)),
        expected(case),
        np.mean(peaks, axis=0) / np.concatenate(peak),
    )

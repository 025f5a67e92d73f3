"""Where a result leaves the assumptions it was computed under, in plain words."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from movingfrf._basics.arrays import ComplexArray, FloatArray
from movingfrf._basics.checks import Finding as Finding
from movingfrf._basics.checks import warned


@dataclass(frozen=True, slots=True, kw_only=True)
class Thresholds:
    """From where on something is worth a word: conventions, all of them."""

    near_critical: float = 0.8  # share of the critical speed
    # What may wrap around from the end of the padding, and what a truncation may change, relative to a record.
    tolerated: float = 1e-3
    # Share of the roughness that may lie in the highest tenth of the frequencies, as an amplitude.
    at_nyquist: float = 0.01


THRESHOLDS = Thresholds()


def contact_lost(total_force: FloatArray, time_step: float) -> list[Finding]:
    """Total contact forces, shape (time, contact) [N], that turn to tension, which no tyre can carry."""
    found = []
    for contact, force in enumerate(total_force.T):
        lifted = force < 0
        if lifted.any():
            found.append(
                Finding(
                    "contact_lost",
                    f"contact {contact} would lift off the road during {lifted.mean():.2%} of the time, first at "
                    f"{lifted.argmax() * time_step:.3f} s; the linear contact pulls there instead, so forces "
                    "and accelerations around those instants are not to be relied on",
                )
            )
    return found


def near_critical(speed: float, critical_speed: float) -> list[Finding]:
    """Speed [m/s] close to or above the critical speed [m/s]."""
    if speed < THRESHOLDS.near_critical * critical_speed:
        return []
    where = "above" if speed > critical_speed else "close to"
    return [
        Finding(
            "critical_speed",
            f"the speed of {speed:.4g} m/s is {where} the critical speed of {critical_speed:.4g} m/s: deflections "
            "depend strongly on speed and damping there",
        )
    ]


def not_decayed(name: str, wrapped: FloatArray, values: FloatArray) -> list[Finding]:
    """Compare what wraps around from the end of the padding (*case, port) with records (*case, port, time)."""
    rows = values.reshape(-1, values.shape[-1])
    # A product of two rows would wake BLAS's threads, for nothing.
    size = np.sqrt([np.square(row).mean() for row in rows]).reshape(wrapped.shape)
    left = np.divide(wrapped, size, out=np.zeros_like(size), where=size > 0).max(initial=0.0)
    if left <= THRESHOLDS.tolerated:
        return []
    return [
        Finding(
            "not_decayed",
            f"the {name} has not died away at the end of the padded record; up to {left:.1e} of it wraps around to "
            "the start. More damping, or a longer duration, would let it decay",
        )
    ]


def beyond_truncation(truncation: float, error: float) -> list[Finding]:
    """Say what a truncation [Hz] may change, relative to the whole record."""
    if error <= THRESHOLDS.tolerated:
        return []
    return [
        Finding(
            "beyond_truncation",
            f"the road counts as rigid beyond {truncation:g} Hz, which may change an output by {error:.1e} of its "
            "root mean square; a higher truncation changes less",
        )
    ]


def beyond_nyquist(roughness: ComplexArray, time_step: float) -> list[Finding]:
    """Roughness spectra, shape (*case, contact, frequency), that reach up to the Nyquist frequency."""
    lines = roughness.shape[-1]
    squared = np.arange(lines, dtype=float) ** 2
    first = int(0.9 * lines)
    share = 0.0
    for spectrum in roughness.reshape(-1, lines):
        energy = (spectrum.real**2 + spectrum.imag**2) * squared
        if energy.any():
            share = max(share, float(np.sqrt(energy[first:].sum() / energy.sum())))
    if share <= THRESHOLDS.at_nyquist:
        return []
    return [
        Finding(
            "beyond_nyquist",
            f"{share:.1%} of the slope of the road, as seen by a contact, lies in the highest tenth of the "
            f"frequencies that a step of {time_step:g} s resolves (up to {0.5 / time_step:g} Hz); "
            "a shorter time step, or a smoother profile, is needed",
        )
    ]


def announced(found: Iterable[Finding]) -> str:
    """Warn of every finding, at the line that called the package, and return them all as JSON text."""
    return json.dumps([finding._asdict() for finding in warned(found)])

"""Where a result leaves the assumptions it was computed under, in plain words."""

from __future__ import annotations

import json
import math
import sys
import warnings
from collections.abc import Iterable
from dataclasses import dataclass
from types import FrameType
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import ComplexArray, FloatArray
from movingfrf._basics.checks import ValidityWarning


@dataclass(frozen=True, slots=True, kw_only=True)
class Thresholds:
    """From where on something is worth a word: conventions, all of them."""

    near_critical: float = 0.8  # share of the critical speed
    # What may wrap around from the end of the padding, and what a truncation may change, relative to a record.
    tolerated: float = 1e-3
    # What of an output a record may not show between its samples, as a share of the root mean square.
    at_nyquist: float = 0.01


THRESHOLDS = Thresholds()


class Finding(NamedTuple):
    """One thing to know about a result."""

    code: str
    message: str
    figure: float = math.nan  # how much, as a share of what the message names; nan: it has no figure


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


def beyond_nyquist(spectra: ComplexArray, shown: int, time_step: float) -> list[Finding]:
    """Spectra of like outputs, (output, frequency), of which a record shows the first `shown` frequencies."""
    energy = spectra.real**2 + spectra.imag**2
    beyond, whole = energy[:, shown + 1 :].sum(axis=-1).max(initial=0.0), energy.sum(axis=-1).max(initial=0.0)
    share = float(np.sqrt(beyond / whole)) if whole > 0 else 0.0
    if share <= THRESHOLDS.at_nyquist:
        return []
    return [
        Finding(
            "beyond_nyquist",
            f"{share:.1%} of the root mean square of an output lies above {0.5 / time_step:g} Hz, which steps "
            f"of {time_step:g} s do not show; the samples are right, but more happens between them. A shorter "
            "time step shows it",
            share,
        )
    ]


def not_resolved(left_out: float, solved_step: float) -> list[Finding]:
    """Say what is left out, relative to a record, although it was solved in steps as fine as are allowed [s]."""
    if left_out <= THRESHOLDS.tolerated:
        return []
    return [
        Finding(
            "not_resolved",
            f"steps of {solved_step:.2g} s, the finest that were tried, leave out {left_out:.1e} of the root mean "
            "square of an output, most of it where something begins or ends abruptly",
            left_out,
        )
    ]


def jumps_within_a_step(change: float, time_step: float) -> list[Finding]:
    """Say what it may change, relative to the largest value, that a force jumps within a step [s]."""
    if change <= THRESHOLDS.tolerated:
        return []
    return [
        Finding(
            "jump_within_a_step",
            f"a force jumps between two samples, {time_step:g} s apart, at an instant that they do not tell; "
            f"half a step later changes the deflection by up to {change:.1e} of its largest value. A shorter step "
            "would tell, or a scenario, whose loads are switched at stated instants",
            change,
        )
    ]


def announced(found: Iterable[Finding]) -> str:
    """Warn of every finding, at the line that called the package, and return them all as JSON text."""
    level = 1
    frame: FrameType | None = sys._getframe()
    while frame is not None and frame.f_globals.get("__name__", "").partition(".")[0] == "movingfrf":
        level, frame = level + 1, frame.f_back
    found = list(found)
    for finding in found:
        warnings.warn(finding.message, ValidityWarning, stacklevel=level)
    # Not a number is no JSON.
    return json.dumps(
        [{name: value for name, value in finding._asdict().items() if value == value} for finding in found]
    )

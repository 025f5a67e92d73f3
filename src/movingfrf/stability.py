"""Does the coupled system ring itself up? The argument principle on det(I + D G)."""

from __future__ import annotations

import numpy as np

from movingfrf._checks import ComplexArray, SolveError
from movingfrf.coupling import Sample, System
from movingfrf.vehicles.base import Vehicle

# The path runs this far below the real axis, relative to the frequency: a growth per radian too slow to see.
BELOW_AXIS = 1e-6

# Points of the path per decade, and around each pole of the vehicle at relative distances down to BELOW_AXIS.
PER_DECADE, CLUSTER = 16, np.r_[-1, 1] * np.logspace(-6, -0.5, 8)[:, None]

# Turns of the phase between neighbours that are still counted without a point between them, and how often an
# interval may be halved.
LARGEST_TURN, HALVINGS, MOST_POINTS = 0.25 * np.pi, 24, 20_000

# Natural frequencies further apart than this ratio leave no digits to the lower ones.
WIDEST = 1e-9

# Points with the smallest determinant from which a growing vibration is searched, to name it.
SEARCHES = 12


def along_the_axis(vehicle: Vehicle, speed: float) -> ComplexArray:
    """Frequencies from zero to far above the vehicle's poles, dense around each of them [rad/s].

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle.
    speed : float
        Speed, for the message [m/s].

    Returns
    -------
    ndarray, shape (frequency,)
        Ascending, just below the real axis.

    Raises
    ------
    SolveError
        If the vehicle's natural frequencies lie too far apart for floating-point numbers.
    """
    poles = np.abs(vehicle.poles)
    if not poles.min() > WIDEST * poles.max():
        raise SolveError(
            f"the vehicle's natural frequencies, from {poles.min() / (2 * np.pi):.3g} to "
            f"{poles.max() / (2 * np.pi):.3g} Hz, lie too far apart to be computed together at {speed:g} m/s"
        )
    lowest, highest = 1e-2 * poles.min(), 1e2 * poles.max()
    base = np.geomspace(lowest, highest, int(np.log10(highest / lowest) * PER_DECADE) + 2)
    path = np.unique(np.concatenate([[0.0], base, (poles * (1 + CLUSTER.reshape(-1, 1))).ravel()]))
    return path * (1 - 1j * BELOW_AXIS)


def growing_vibrations(system: System, along_axis: Sample) -> int:
    """Count the vibrations of the coupled system that grow in time, conjugate pairs counted twice.

    Every zero of det(I + D G) with Im ω < 0 turns the phase of the determinant by one full circle along the
    real axis; towards infinity the determinant is a positive constant.

    Parameters
    ----------
    system : System
        Vehicle and road.
    along_axis : Sample
        Both sides at the frequencies of `along_the_axis`.

    Returns
    -------
    int
        Zero for a stable system.
    """
    path, values = along_axis.omega, along_axis.determinants()
    for _ in range(HALVINGS):
        wide = np.flatnonzero(np.abs(np.angle(values[1:] / values[:-1])) > LARGEST_TURN)
        if not wide.size or path.size > MOST_POINTS:
            break
        between = 0.5 * (path[wide] + path[wide + 1])
        path = np.insert(path, wide + 1, between)
        values = np.insert(values, wide + 1, system.sample(between).determinants())
    turned = np.angle(values[1:] / values[:-1]).sum()
    return max(round(-float(turned) / np.pi), 0)


def require_stable(system: System, along_axis: Sample) -> None:
    """Refuse a system that rings itself up: it has no steady state to vibrate about.

    Parameters
    ----------
    system : System
        Vehicle and road.
    along_axis : Sample
        Both sides at the frequencies of `along_the_axis`.

    Raises
    ------
    SolveError
        If a vibration grows, with its frequency and growth where they can be found.
    """
    if growing_vibrations(system, along_axis):
        raise SolveError(
            f"vehicle and guideway are unstable together at {system.speed:g} m/s: {_described(system)}; "
            "the motion feeds a vibration that grows without bound, so there is no steady response"
        )


def _described(system: System) -> str:
    """Describe the fastest growing vibration: a zero of the determinant in the lower half-plane."""
    magnitudes = np.abs(system.vehicle.poles)
    across = np.geomspace(0.1 * magnitudes.min(), 10 * magnitudes.max(), 80)
    omega = (across[:, None] * (1 - 1j * np.geomspace(1e-4, 2.0, 16))).ravel()
    size = np.abs(system.sample(omega).determinants())
    zeros = [_zero(system, start) for start in omega[np.argsort(size)[:SEARCHES]]]
    growing = [zero for zero in zeros if zero is not None]
    if not growing:
        return "a vibration grows"
    fastest = min(growing, key=lambda zero: zero.imag)
    return f"a vibration of {fastest.real / (2 * np.pi):.4g} Hz grows as e^({-fastest.imag:.4g} t)"


def _zero(system: System, start: complex) -> complex | None:
    """Zero of the determinant near a point of the lower half-plane, by the secant method; None if it leaves."""
    before, now = start, start * 1.001
    for _ in range(60):
        at_before, at_now = system.sample(np.array([before, now])).determinants()
        if abs(at_now) < 1e-10:
            return now
        if at_now == at_before:
            return None
        before, now = now, complex(now - at_now * (now - before) / (at_now - at_before))
        if now.imag >= 0 or not np.isfinite(now):
            return None
    return None

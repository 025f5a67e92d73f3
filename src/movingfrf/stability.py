"""Does the coupled system ring itself up? The argument principle on det(I + D G)."""

from __future__ import annotations

import numpy as np

from movingfrf._checks import ComplexArray, SolveError
from movingfrf.coupling import contact_frf
from movingfrf.guideways.base import Guideway
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


def determinant(guideway: Guideway, vehicle: Vehicle, speed: float, omega: ComplexArray) -> ComplexArray:
    """det(I + D G) of the coupled system; its zeros are the system's poles.

    Parameters
    ----------
    guideway, vehicle : Guideway, Vehicle
        The two sides.
    speed : float
        Speed [m/s].
    omega : ndarray, shape (frequency,)
        Complex frequency, Im ω ≤ 0 [rad/s].

    Returns
    -------
    ndarray, shape (frequency,)
        Dimensionless.
    """
    frf = contact_frf(guideway, vehicle, speed, omega)
    stiffness = vehicle.dynamic_stiffness(omega, vehicle.modes())
    value: ComplexArray = np.linalg.det(np.eye(frf.shape[1]) + stiffness @ frf)
    return value


def growing_vibrations(guideway: Guideway, vehicle: Vehicle, speed: float) -> int:
    """Count the vibrations of the coupled system that grow in time, conjugate pairs counted twice.

    Every zero of det(I + D G) with Im ω < 0 turns the phase of the determinant by one full circle along the
    real axis; towards infinity the determinant is a positive constant.

    Parameters
    ----------
    guideway, vehicle : Guideway, Vehicle
        The two sides.
    speed : float
        Speed [m/s].

    Returns
    -------
    int
        Zero for a stable system.
    """
    values = _along_the_axis(guideway, vehicle, speed)
    turned = np.angle(values[1:] / values[:-1]).sum()
    return max(round(-float(turned) / np.pi), 0)


def require_stable(guideway: Guideway, vehicle: Vehicle, speed: float) -> None:
    """Refuse a system that rings itself up: it has no steady state to vibrate about.

    Parameters
    ----------
    guideway, vehicle : Guideway, Vehicle
        The two sides.
    speed : float
        Speed [m/s].

    Raises
    ------
    SolveError
        If a vibration grows, with its frequency and growth where they can be found.
    """
    if growing_vibrations(guideway, vehicle, speed):
        raise SolveError(
            f"vehicle and guideway are unstable together at {speed:g} m/s: "
            f"{_described(guideway, vehicle, speed)}; "
            "the motion feeds a vibration that grows without bound, so there is no steady response"
        )


def _along_the_axis(guideway: Guideway, vehicle: Vehicle, speed: float) -> ComplexArray:
    """Follow the determinant from zero to far above the vehicle's poles, without large turns between points."""
    poles = np.abs(vehicle.poles)
    if not poles.min() > WIDEST * poles.max():
        raise SolveError(
            f"the vehicle's natural frequencies, from {poles.min() / (2 * np.pi):.3g} to "
            f"{poles.max() / (2 * np.pi):.3g} Hz, lie too far apart to be computed together at {speed:g} m/s"
        )
    lowest, highest = 1e-2 * poles.min(), 1e2 * poles.max()
    base = np.geomspace(lowest, highest, int(np.log10(highest / lowest) * PER_DECADE) + 2)
    path = np.unique(np.concatenate([[0.0], base, (poles * (1 + CLUSTER.reshape(-1, 1))).ravel()]))
    values = determinant(guideway, vehicle, speed, path * (1 - 1j * BELOW_AXIS))
    for _ in range(HALVINGS):
        wide = np.flatnonzero(np.abs(np.angle(values[1:] / values[:-1])) > LARGEST_TURN)
        if not wide.size or path.size > MOST_POINTS:
            break
        between = 0.5 * (path[wide] + path[wide + 1])
        path = np.insert(path, wide + 1, between)
        values = np.insert(values, wide + 1, determinant(guideway, vehicle, speed, between * (1 - 1j * BELOW_AXIS)))
    return values


def _described(guideway: Guideway, vehicle: Vehicle, speed: float) -> str:
    """Describe the fastest growing vibration: a zero of the determinant in the lower half-plane."""
    magnitudes = np.abs(vehicle.poles)
    across = np.geomspace(0.1 * magnitudes.min(), 10 * magnitudes.max(), 80)
    omega = (across[:, None] * (1 - 1j * np.geomspace(1e-4, 2.0, 16))).ravel()
    size = np.abs(determinant(guideway, vehicle, speed, omega))
    zeros = [_zero(guideway, vehicle, speed, start) for start in omega[np.argsort(size)[:SEARCHES]]]
    growing = [zero for zero in zeros if zero is not None]
    if not growing:
        return "a vibration grows"
    fastest = min(growing, key=lambda zero: zero.imag)
    return f"a vibration of {fastest.real / (2 * np.pi):.4g} Hz grows as e^({-fastest.imag:.4g} t)"


def _zero(guideway: Guideway, vehicle: Vehicle, speed: float, start: complex) -> complex | None:
    """Zero of the determinant near a point of the lower half-plane, by the secant method; None if it leaves."""
    before, now = start, start * 1.001
    for _ in range(60):
        at_before, at_now = determinant(guideway, vehicle, speed, np.array([before, now]))
        if abs(at_now) < 1e-10:
            return now
        if at_now == at_before:
            return None
        before, now = now, complex(now - at_now * (now - before) / (at_now - at_before))
        if now.imag >= 0 or not np.isfinite(now):
            return None
    return None

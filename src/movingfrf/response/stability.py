"""Does the coupled system ring itself up? The argument principle on det(I + D G)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import cast

import numpy as np

from movingfrf._basics.arrays import ComplexArray, FloatArray, handed
from movingfrf._basics.checks import SolveError
from movingfrf._basics.compiling import loops_for
from movingfrf.response.along import CarByCar, determinants
from movingfrf.response.batches import BATCH
from movingfrf.response.system import System, Tables
from movingfrf.vehicles.vehicle import Vehicle


@dataclass(frozen=True, slots=True, kw_only=True)
class Contour:
    """What tunes the path along the axis and the count of turns; in brackets, between what each number is safe."""

    # The path runs this far below the real axis, relative to the frequency: a growth per radian too slow to see.
    below_axis: float = 1e-6  # [1e-8 to 1e-5]
    # Points of the path per decade, and around each pole of the vehicle: at distances that double from half of the
    # pole's own width up to `apart`, relative to its frequency. Every second point is the middle of an interval.
    per_decade: int = 16  # [8 to 64]
    apart: float = 0.3  # [0.2 to 0.5]
    # A change from one end of an interval to its middle, relative to the value and contact by contact, that needs
    # no closer look: below 1 the phase turns by less than a quarter. How often an interval may be halved, and how
    # many there may be at a time.
    largest_change: float = 0.9  # [0.5 to 0.95]
    halvings: int = 24  # [12 to 40]
    # The same of a train's determinant, all contacts together: an interval times the slope of its logarithm, where
    # 2 is a zero half-way. The slope is taken over this share of an interval.
    largest_turn: float = 1.0  # [0.2 to 1.5]
    aside: float = 1e-4  # [1e-6 to 1e-2]
    most_intervals: int = 20_000  # [5000 to 200 000]
    # Natural frequencies further apart than this ratio leave no digits to the lower ones.
    widest: float = 1e-9  # [1e-10 to 1e-8]
    # Frequencies between which a mass that follows the road, without vibrations of its own, is looked at.
    no_poles: tuple[float, float] = (1.0, 1e3)  # [rad/s; 0.1 to 10, and 100 to 1000]
    # Poles closer to each other than this share of their width need no points of their own; how many are compared.
    alike: float = 0.1  # [0 to 0.3]
    most_alike: int = 8  # [1 to 32: time only]
    # Points of the quarter circle from the end of the path down to the imaginary axis: ends and middles in turn.
    on_arc: int = 24  # [12 to 96, even]
    # Points with the smallest determinant from which a growing vibration is searched, to name it.
    searches: int = 12  # [a convention]


CONTOUR = Contour()


def along_the_axis(vehicle: Vehicle, speed: float) -> ComplexArray:
    """Frequencies from zero to far above the vehicle's poles [rad/s].

    With elastic contacts det(I + D G) is a positive constant there. With rigid ones it grows like a power of the
    frequency and keeps turning along the arc that closes the contour, so the path follows the arc down to the
    imaginary axis, where the determinant is real and positive.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle.
    speed : float
        Speed, for the message [m/s].

    Returns
    -------
    ndarray, shape (frequency,)
        Ascending, just below the real axis: ends and middles of intervals in turn.

    Raises
    ------
    SolveError
        If the vehicle's natural frequencies lie too far apart for floating-point numbers.
    """
    poles, rigid = vehicle.poles, bool(np.isinf(vehicle.springs).any())
    slowest, fastest = _extent(poles)
    # A wheel that follows the road vibrates on it, faster than anything above it might.
    fastest = max(fastest, CONTOUR.no_poles[1]) if rigid else fastest
    if not slowest > CONTOUR.widest * fastest:
        raise SolveError(
            f"the vehicle's natural frequencies, from {slowest / (2 * np.pi):.3g} to "
            f"{fastest / (2 * np.pi):.3g} Hz, lie too far apart to be computed together at {speed:g} m/s"
        )
    lowest, highest = 1e-2 * slowest, 1e2 * fastest
    base = np.geomspace(lowest, highest, int(np.log10(highest / lowest) * CONTOUR.per_decade) + 2)
    path = np.unique(np.concatenate([[0.0], base, *map(_around, _distinct(poles))]))
    if path.size % 2 == 0:
        path = np.append(path, 2 * highest)
    along = path * (1 - 1j * CONTOUR.below_axis)
    if not rigid:
        return along
    arc = np.exp(-0.5j * np.pi * np.arange(1, CONTOUR.on_arc + 1) / CONTOUR.on_arc)
    return np.concatenate([along, path[-1] * arc])


def _extent(poles: ComplexArray) -> tuple[float, float]:
    """Magnitude of the slowest and the fastest pole [rad/s]."""
    return (float(np.abs(poles).min()), float(np.abs(poles).max())) if poles.size else CONTOUR.no_poles


def _distinct(poles: ComplexArray) -> ComplexArray:
    """Poles without those that repeat others, as the cars of a train do."""
    kept: list[complex] = []
    for pole in poles.tolist():
        # Ascending in magnitude, so that those alike are not far behind.
        alike = (abs(pole - other) < CONTOUR.alike * abs(pole.real) for other in kept[-CONTOUR.most_alike :])
        if not any(alike):
            kept.append(pole)
    return np.array(kept, complex)


def _around(pole: complex) -> FloatArray:
    """Frequencies around a pole, as close as a resonance of its width needs."""
    width = min(max(abs(pole.real) / abs(pole), CONTOUR.below_axis), CONTOUR.apart)
    distances = 0.5 * width * 2.0 ** np.arange(int(np.log2(2 * CONTOUR.apart / width)) + 1)
    around: FloatArray = abs(pole) * (1 + np.concatenate([-distances, [0.0], distances]))
    return around


def stretches(path: ComplexArray, most: int) -> list[ComplexArray]:
    """Cut a path of ends and middles in turn into stretches that join, of at most so many points, three or more."""
    steps = 2 * max((most - 1) // 2, 1)
    return [path[first : first + steps + 1] for first in range(0, path.size - 1, steps)]


def growing_vibrations(system: System, along_axis: Iterable[Tables | CarByCar]) -> int:
    """Count the vibrations of the coupled system that grow in time, conjugate pairs counted twice.

    Every zero of det(I + D G) with Im ω < 0 turns the phase of the determinant by one full circle along the
    real axis, and on along the arc where the path has one; it ends where the determinant is real and positive.

    Parameters
    ----------
    system : System
        Vehicle and road.
    along_axis : iterable of Tables or CarByCar
        Both sides at the frequencies of `along_the_axis`, stretch by stretch.

    Returns
    -------
    int
        Zero for a stable system.
    """
    turned = sum(_turned(system, stretch) for stretch in along_axis)
    return max(round(-turned / np.pi), 0)


def _turned(system: System, along_axis: Tables | CarByCar) -> float:
    """Angle by which the determinant turns along a stretch of the path [rad]."""
    if isinstance(along_axis, CarByCar):
        return _turned_with_slopes(system, along_axis.omega)
    if len(along_axis.frf) <= 2 and (loops := loops_for("response.compiled", 0)):
        turned = loops.turned(*map(handed, (along_axis.frf, along_axis.stiffness)), CONTOUR.largest_change)
        if np.isfinite(turned):
            return float(turned)
    path, matrices = along_axis.omega, _stacked(along_axis)
    first, middle, last = path[:-1:2], path[1::2], path[2::2]
    at_first, at_middle, at_last = matrices[:-1:2], matrices[1::2], matrices[2::2]
    turned = 0.0
    for _ in range(CONTOUR.halvings):
        factors = np.hstack([_factors(at_first, at_middle), _factors(at_middle, at_last)])
        rough = (np.abs(factors - 1) > CONTOUR.largest_change).any(axis=1)
        turned += np.angle(factors[~rough]).sum()
        if not rough.any():
            return float(turned)
        first, last = np.r_[first[rough], middle[rough]], np.r_[middle[rough], last[rough]]
        at_first, at_last = np.r_[at_first[rough], at_middle[rough]], np.r_[at_middle[rough], at_last[rough]]
        if not 0 < first.size < CONTOUR.most_intervals:
            break
        middle = 0.5 * (first + last)
        at_middle = _stacked(cast("Tables", system.at(middle)))
    turned += np.angle(_factors(at_first, at_last)).sum()
    return float(turned)


def _turned_with_slopes(system: System, path: ComplexArray) -> float:
    """Angle by which the determinant of a train turns along a path [rad].

    The determinant is all that elimination leaves, and many zeros may turn it by full circles unseen. Its logarithm
    has no poles of its own, and each zero adds to the slope: where an interval times the slope is little at both of
    its ends, no zero is near.
    """

    def logarithm_and_slope(omega: ComplexArray, step: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
        both = np.concatenate([omega, omega + CONTOUR.aside * step])
        most = BATCH.frequencies(system.entries)
        parts = [_logarithm(system.at(both[begin : begin + most])) for begin in range(0, both.size, most)]
        here, aside = np.split(np.concatenate(parts), 2)
        return here, _unwound(aside - here) / (CONTOUR.aside * step)

    steps = np.diff(path)
    value, slope = logarithm_and_slope(path, np.append(steps, -steps[-1]))
    # Frequency, logarithm and slope at the ends of each interval.
    first, last = np.stack([path[:-1], value[:-1], slope[:-1]]), np.stack([path[1:], value[1:], slope[1:]])
    turned = 0.0
    for _ in range(CONTOUR.halvings):
        rough = np.abs(last[0] - first[0]) * np.abs([first[2], last[2]]).max(axis=0) > CONTOUR.largest_turn
        turned += _unwound(last[1] - first[1])[~rough].imag.sum()
        first, last = first[:, rough], last[:, rough]
        if not 0 < first.shape[1] < CONTOUR.most_intervals:
            break
        middle = 0.5 * (first[0] + last[0])
        halves = np.stack([middle, *logarithm_and_slope(middle, middle - first[0])])
        first, last = np.hstack([first, halves]), np.hstack([halves, last])
    return float(turned + _unwound(last[1] - first[1]).imag.sum())


def _unwound(change: ComplexArray) -> ComplexArray:
    """Change of a logarithm, by less than half a turn."""
    return change - 2j * np.pi * np.round(change.imag / (2 * np.pi))


def _logarithm(tables: Tables | CarByCar) -> ComplexArray:
    """Logarithm of the determinant of I + D G, whole turns left out, shape (frequency,)."""
    with np.errstate(divide="ignore"):
        return np.sum([times * np.log(determinants(piece)) for times, piece in tables.pieces], axis=0)


def _stacked(tables: Tables) -> ComplexArray:
    """I + D G with the frequency first, as determinants and eigenvalues take it."""
    return np.moveaxis(tables.matrix, -1, 0)


def _factors(before: ComplexArray, after: ComplexArray) -> ComplexArray:
    """Eigenvalues of X₁⁻¹X₂, shape (interval, contact): by their product the determinant changes.

    One by one they stay near 1 where the determinant itself, their product, may turn by full circles.
    """
    count = before.shape[1]
    if count == 1:
        return (after / before)[:, :, 0]
    if count == 2:
        (a, b), (c, d) = before[:, 0].T, before[:, 1].T
        (e, f), (g, h) = after[:, 0].T, after[:, 1].T
        determinant = a * d - b * c
        half = 0.5 * (d * e - b * g + a * h - c * f) / determinant
        root = np.sqrt(half * half - (e * h - f * g) / determinant)
        return np.stack([half + root, half - root], axis=1)
    return np.linalg.eigvals(np.linalg.solve(before, after)).astype(complex)


def require_stable(system: System, along_axis: Iterable[Tables | CarByCar]) -> None:
    """Refuse a system that rings itself up: it has no steady state to vibrate about.

    Parameters
    ----------
    system : System
        Vehicle and road.
    along_axis : iterable of Tables or CarByCar
        Both sides at the frequencies of `along_the_axis`, stretch by stretch.

    Raises
    ------
    SolveError
        If a vibration grows, with its frequency and growth where they can be found.
    """
    growing = growing_vibrations(system, along_axis)
    if growing:
        raise SolveError(
            f"vehicle and guideway are unstable together at {system.speed:g} m/s: {_described(system)}; "
            "the motion feeds a vibration that grows without bound, so there is no steady response"
        )


def _described(system: System) -> str:
    """Describe the fastest growing vibration: a zero of the determinant in the lower half-plane."""
    slowest, fastest = _extent(system.vehicle.poles)
    across = np.geomspace(0.1 * slowest, 10 * fastest, 80)
    omega = (across[:, None] * (1 - 1j * np.geomspace(1e-4, 2.0, 16))).ravel()
    size = _logarithm(system.at(omega)).real
    zeros = [_zero(system, start) for start in omega[np.argsort(size)[: CONTOUR.searches]]]
    growing = [zero for zero in zeros if zero is not None]
    if not growing:
        return "a vibration grows"
    worst = min(growing, key=lambda zero: zero.imag)
    return f"a vibration of {worst.real / (2 * np.pi):.4g} Hz grows as e^({-worst.imag:.4g} t)"


def _zero(system: System, start: complex) -> complex | None:
    """Zero of the determinant near a point of the lower half-plane, by the secant method; None if it leaves."""
    before, now = start, start * 1.001
    for _ in range(60):
        at_before, at_now = np.exp(_logarithm(system.at(np.array([before, now]))))
        if abs(at_now) < 1e-10:
            return now
        if at_now == at_before:
            return None
        before, now = now, complex(now - at_now * (now - before) / (at_now - at_before))
        if now.imag >= 0 or not np.isfinite(now):
            return None
    return None

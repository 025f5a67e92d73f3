"""The vehicle on a rigid guideway as a state space, driven piece by piece by the polynomials of the spline.

Nothing of the package's solution is used: matrices of the vehicle, SciPy's spline, modes, and Gauss's rule within
each piece, short against every time constant.
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

import movingfrf as mf
from tests.honest.cases import Case

NODES, WEIGHTS = np.polynomial.legendre.leggauss(8)
SHORT = 1.0  # pieces times the greatest eigenvalue
CONDITION = 1e8  # of the modes


def has_exact(case: Case) -> bool:
    """Whether the vehicle can be solved so: a rigid guideway, springs under all wheels, modes that differ."""
    return (
        isinstance(case.guideway, mf.RigidGuideway)
        and bool(np.isfinite(case.vehicle.springs).all())
        and np.linalg.cond(_modes(case.vehicle)[1]) < CONDITION
    )


def exact(case: Case, grade: float) -> dict[str, np.ndarray]:
    """Histories of a case about the steady state, contacts and degrees of freedom in rows."""
    vehicle = case.vehicle
    mass, damping, stiffness, contact_map = vehicle.matrices
    springs, dashpots = vehicle.springs[:, None], vehicle.dashpots[:, None]
    values, modes = _modes(vehicle)
    output = np.arange(round(case.duration / case.time_step)) * case.time_step
    times = _pieces(case, output, float(np.abs(values).max()))
    lengths = np.diff(times)
    nodes = times[:-1, None] + 0.5 * lengths[:, None] * (NODES + 1.0)
    seen, rate = _seen(case, nodes.ravel(), grade)
    pushed = -np.linalg.solve(mass, contact_map.T @ (springs * seen + dashpots * rate))
    into = np.linalg.solve(modes, np.concatenate([np.zeros_like(pushed), pushed]).astype(complex))
    into = into.reshape(len(values), *nodes.shape)
    left = np.exp(values[:, None, None] * (times[1:, None] - nodes))
    steps = (0.5 * lengths * (left * into * WEIGHTS).sum(axis=2)).T
    factors = np.exp(np.outer(lengths, values))
    states = np.zeros((times.size, len(values)), complex)
    for number in range(lengths.size):
        states[number + 1] = factors[number] * states[number] + steps[number]
    state = (modes @ states[np.searchsorted(times, output)].T).real
    motion, velocity = np.split(state, 2)
    seen, rate = _seen(case, output, grade)
    force = springs * (contact_map @ motion + seen) + dashpots * (contact_map @ velocity + rate)
    acceleration = -np.linalg.solve(mass, damping @ velocity + stiffness @ motion + contact_map.T @ force)
    return {"contact_force": force, "motion": motion, "acceleration": acceleration}


def _modes(vehicle: mf.Vehicle) -> tuple[np.ndarray, np.ndarray]:
    mass, damping, stiffness, contact_map = vehicle.matrices
    held = stiffness + contact_map.T @ (vehicle.springs[:, None] * contact_map)
    damped = damping + contact_map.T @ (vehicle.dashpots[:, None] * contact_map)
    count = len(mass)
    below = -np.linalg.solve(mass, np.hstack([held, damped]))
    return np.linalg.eig(np.vstack([np.hstack([np.zeros((count, count)), np.eye(count)]), below]))


def _pieces(case: Case, output: np.ndarray, fastest: float) -> np.ndarray:
    """Give the times between which what every contact sees is one polynomial, and no more than a piece is long."""
    foremost = float(case.vehicle.positions.max())
    edges = [output, np.arange(0.0, output[-1], SHORT / fastest)]
    for at in case.vehicle.contacts:
        if case.blend:
            edges.append((foremost - at.position + np.array([0.0, case.blend])) / case.speed)
        for shift in {0.5 * (a * at.footprint + b * at.cams) for a in (-1, 1) for b in (-1, 1)}:
            edges.append((case.onward.stations - (case.start + at.position + shift)) / case.speed)
    times = np.unique(np.concatenate(edges))
    return times[(times >= 0) & (times <= output[-1])]


def _seen(case: Case, times: np.ndarray, grade: float) -> tuple[np.ndarray, np.ndarray]:
    """Elevation under each contact and its rate of change."""
    rows = [_under(case, at, times, grade) for at in case.vehicle.contacts]
    return np.stack([seen for seen, _ in rows]), np.stack([rate for _, rate in rows])


def _under(case: Case, at: mf.Contact, times: np.ndarray, grade: float) -> tuple[np.ndarray, np.ndarray]:
    profile = case.onward
    column = profile.columns[:, 0 if profile.same_across else at.path]
    foremost = case.start + float(case.vehicle.positions.max())
    spline = CubicSpline(profile.stations, column - np.interp(foremost, profile.stations, column))
    distance = case.start + at.position + case.speed * times
    seen, slope = np.zeros_like(times), np.zeros_like(times)
    for shift in (-0.5 * at.cams, 0.5 * at.cams):
        if at.footprint:
            area = spline.antiderivative()
            ends = distance + shift - 0.5 * at.footprint, distance + shift + 0.5 * at.footprint
            seen += 0.5 * (area(ends[1]) - area(ends[0])) / at.footprint
            slope += 0.5 * (spline(ends[1]) - spline(ends[0])) / at.footprint
        else:
            seen += 0.5 * spline(distance + shift)
            slope += 0.5 * spline(distance + shift, 1)
    seen -= spline(foremost) + grade * (distance - foremost)
    slope -= grade
    if case.blend:
        share = np.clip((distance - foremost) / case.blend, 0.0, 1.0)
        step = share**3 * (10 + share * (6 * share - 15))
        slope = step * slope + 30 * share**2 * (1 - share) ** 2 / case.blend * seen
        seen = step * seen
    return seen, case.speed * slope

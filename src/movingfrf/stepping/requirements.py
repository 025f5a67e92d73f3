"""What a finite guideway, a scheme and a journey must fulfil before the first step."""

from __future__ import annotations

import numpy as np
from scipy.linalg import eigvalsh

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import Checks, checking
from movingfrf._basics.door import mistaken
from movingfrf.stepping.factors import solver
from movingfrf.stepping.finite_guideway import ELEMENT_ROUNDING, FiniteGuideway
from movingfrf.stepping.schemes import Scheme
from movingfrf.vehicles.vehicle import Vehicle


def require_kind(name: str, value: object, kind: type, wanted: str) -> None:
    """Refuse an argument of another kind.

    Parameters
    ----------
    name : str
        Name of the argument.
    value : object
        What was given.
    kind : type
        What it must be.
    wanted : str
        The same in words, a key of `wanted_kinds` in `_basics/door.py`.

    Raises
    ------
    ValueError
        If it is something else.
    """
    with checking() as check:
        if not isinstance(value, kind):
            check.refuse(name, mistaken(wanted, value))


def require_on_guideway(
    check: Checks, guideway: FiniteGuideway, positions: FloatArray, travel: tuple[float, float], *, what: str
) -> None:
    """Refuse a journey that leads off the guideway.

    Parameters
    ----------
    check : Checks
        Collects the fault.
    guideway : FiniteGuideway
        The guideway.
    positions : ndarray
        Where contacts and observers stand [m].
    travel : tuple of float
        How far they travel, backwards and forwards [m].
    what : str
        What they do, for the message: "the contacts travel".
    """
    first, last = positions.min() + min(travel), positions.max() + max(travel)
    slack = ELEMENT_ROUNDING * (1 + abs(last))
    if first < guideway.interval[0] - slack or last > guideway.interval[1] + slack:
        check.refuse(
            "road",
            f"must reach from {first:.6g} m to {last:.6g} m, where {what}, but it reaches "
            f"from {guideway.interval[0]:.6g} m to {guideway.interval[1]:.6g} m",
        )


def require_across(check: Checks, guideway: FiniteGuideway, across: FloatArray) -> None:
    """Refuse contacts or observers beside the guideway.

    Parameters
    ----------
    check : Checks
        Collects the fault.
    guideway : FiniteGuideway
        The guideway.
    across : ndarray
        Where they stand, left of the centre line [m].
    """
    if guideway.width and np.abs(across).max() > 0.5 * guideway.width * (1 + ELEMENT_ROUNDING):
        check.refuse(
            "road",
            f"must be wide enough: it is {guideway.width:g} m wide, and a contact or a point stands "
            f"{np.abs(across).max():.6g} m from its centre line",
        )


def require_slopes(check: Checks, guideway: FiniteGuideway) -> None:
    """Refuse an interpolation whose first derivative is not the slope of its rows; a dashpot needs it.

    Parameters
    ----------
    check : Checks
        Collects the fault.
    guideway : FiniteGuideway
        The guideway.
    """
    first, last = guideway.interval
    # A place at which nothing special happens: no simple share of the guideway.
    middle, step = first + 0.43219 * (last - first), 1e-8 * (last - first)
    rows = guideway.rows(np.array([middle - step, middle, middle + step])).toarray()
    slope = guideway.rows(np.array([middle]), 1).toarray()[0]
    # Where a row has a kink, as linear functions have at a node, either side will do.
    sides = [(rows[1] - rows[0]) / step, (rows[2] - rows[1]) / step]
    scale = max(np.abs(sides).max(), np.abs(slope).max())
    if scale and min(np.abs(slope - side).max() for side in sides) > 1e-2 * scale:
        check.refuse(
            "interpolation",
            f"must give with derivative 1 the slopes of its rows [1/m], which a contact with damping needs; at "
            f"{middle:.6g} m it does not",
        )


def require_apart(check: Checks, guideway: FiniteGuideway, positions: FloatArray) -> None:
    """Refuse contacts that stand closer to each other than the guideway's nodes."""
    distances = np.diff(np.unique(positions))
    distances = distances[distances > ELEMENT_ROUNDING]
    if distances.size and distances.min() < guideway.spacing * (1 - ELEMENT_ROUNDING):
        check.refuse(
            "road",
            f"must have nodes at most {distances.min():.4g} m apart, the distance between two contacts, got "
            f"{guideway.spacing:.4g} m",
        )


def require_stable_scheme(
    check: Checks, guideway: FiniteGuideway, scheme: Scheme, time_step: float, vehicle: Vehicle | None = None
) -> None:
    """Refuse a scheme that is unstable with this guideway and step, and say which condition fails.

    Parameters
    ----------
    check : Checks
        Collects the fault.
    guideway : FiniteGuideway
        The guideway.
    scheme : Scheme
        The scheme.
    time_step : float
        Step in time [s].
    vehicle : Vehicle, optional
        A vehicle that is stepped along.
    """
    limit = scheme.largest_phase
    if np.isinf(limit):
        return
    if limit == 0.0:
        condition = (
            "α_m ≤ α_f ≤ ½, γ ≥ ½ − α_m + α_f and β ≥ ¼ + ½ (α_f − α_m)"
            if scheme.alpha_m or scheme.alpha_f
            else "γ ≥ ½"
        )
        check.refuse("scheme", f"is unstable at every step, since {condition} does not hold: {tuple(scheme)}")
        return
    highest, what = _highest(guideway), "the road's elements"
    if vehicle is not None:
        # No vibration of the two together is faster than this: stiffnesses add, and so do squares of frequencies.
        springs = sum(contact.stiffness for contact in vehicle.contacts)
        # At so many places the guideway's answer to a contact spring is looked at [33 to 257].
        along, across = np.meshgrid(np.linspace(*guideway.interval, 65), np.unique(vehicle.across))
        rows = guideway.rows(along.ravel(), 0, across.ravel()).toarray()
        moved = float(np.einsum("pd,dp->p", rows, solver(guideway.mass).solve(rows.T)).max())
        own = float(eigvalsh(vehicle.held_stiffness, vehicle.matrices[0])[-1])
        highest, what = float(np.sqrt(highest**2 + own + springs * moved)), "road and vehicle"
    if time_step * highest > limit:
        check.refuse(
            "time_step",
            f"must be at most {limit / highest:.3g} s: with β = {scheme.beta:.4g} < γ/2 = {0.5 * scheme.gamma:.4g} "
            f"the scheme is stable only while ω Δt ≤ {limit:.4g}, and {what} vibrate at up to "
            f"{highest / (2 * np.pi):.4g} Hz, got {time_step!r} s",
        )


def _highest(guideway: FiniteGuideway) -> float:
    """Highest natural frequency of a guideway [rad/s]."""
    from scipy.sparse.linalg import eigsh

    # Of so few unknowns all natural frequencies are computed to find the highest [2 to 500].
    if guideway.dofs <= 50:
        return float(eigvalsh(guideway.stiffness.toarray(), guideway.mass.toarray())[-1] ** 0.5)
    return float(eigsh(guideway.stiffness, 1, M=guideway.mass, which="LM", return_eigenvectors=False)[0] ** 0.5)

"""At which speed a steady load meets the waves of its own guideway; and whether that stands at all."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf.guideways.waves import Ratio, residue_sum


@dataclass(frozen=True, slots=True, kw_only=True)
class CriticalSearch:
    """What tunes the search for the critical speed; in brackets, between what each number is safe.

    The slowest wave is sought among wavenumbers, then in a bracket that shrinks; the speed of the greatest steady
    deflection among speeds on a coarse basin, then between two of them on a fine one.
    """

    per_decade: int = 20  # wavenumbers looked at, over six decades [5 to 200]
    points: int = 33  # wavenumbers of a bracket: each refinement shrinks it to a sixteenth [17 to 129]
    refinements: int = 6  # of the bracket [4 to 12]
    speeds: int = 64  # up to the limit [16 to 256]
    coarse: int = 121  # points of the deflection basin at each of them [100 to 1000]
    fine: int = 1201  # points of the basin on which the speed is refined [600 to 5000]


SEARCH = CriticalSearch()


class PhaseVelocity(NamedTuple):
    """A phase velocity [m/s], and whether shorter waves travel slower still, without a lower bound."""

    value: float
    unbounded: bool


def buckles_at(lossless: Ratio) -> float:
    """Wavenumber of the wave by which an undamped guideway buckles most readily.

    Parameters
    ----------
    lossless : Ratio
        Dynamic stiffness without damping [N/m²]: only even powers of κ and p.

    Returns
    -------
    float
        That of the least static stiffness, where that is not positive [rad/m]; nan if the guideway stands.
    """
    above, below = (table[::2, 0][::-1] for table in (lossless.above, lossless.below))
    squares = np.roots(above)
    positive = squares.real[np.isreal(squares) & (squares.real > 0)]
    if not positive.size:
        return float("nan")
    # Between the longest and the shortest wave that meet no stiffness; to the digits of a message.
    among = np.geomspace(positive.min(), positive.max(), 10_000)
    return float(np.sqrt(among[(np.polyval(above, among) / np.polyval(below, among)).argmin()]))


def compressed(lossless: Ratio) -> bool:
    """Tell whether an undamped guideway is softer to long waves than to a load that is the same everywhere.

    Parameters
    ----------
    lossless : Ratio
        Dynamic stiffness without damping [N/m²]: only even powers of κ and p.

    Returns
    -------
    bool
        Whether the static stiffness falls from κ = 0 on, as under an axial force that no shear layer outweighs.
    """
    tables = lossless.above, lossless.below
    (above, rise), (below, fall) = (np.pad(table[:3:2, 0], (0, 2))[:2] for table in tables)
    return bool(rise * below < above * fall)


def first_stationary_velocity(lossless: Ratio) -> PhaseVelocity:
    """First stationary phase velocity of an undamped guideway, searched branch by branch from long waves on.

    Parameters
    ----------
    lossless : Ratio
        Dynamic stiffness without damping [N/m²]: only even powers of κ and p.

    Returns
    -------
    PhaseVelocity
        Without masses in the foundation the minimum over all waves. With them the velocity of short waves
        sinks to zero (each mass vibrates for itself), `unbounded` is True and the value is the first local
        minimum.
    """
    table = lossless.above[::2, ::2]
    leading = table[np.flatnonzero(table.any(axis=1))[-1]]
    # The shortest waves have a frequency of their own where the leading power of κ is multiplied by p².
    unbounded = bool(leading[1:].any())
    static = np.flatnonzero(table[:, 0])
    scale = (table[0, 0] / table[static[-1], 0]) ** (0.5 / static[-1])
    kappa = scale * np.geomspace(1e-3, 1e3, 6 * SEARCH.per_decade + 1)
    branches = _phase_velocities(table, kappa)
    for number, branch in enumerate(branches.T):
        dips = np.flatnonzero((branch[1:-1] < branch[:-2]) & (branch[1:-1] <= branch[2:])) + 1
        if dips.size:
            around = kappa[dips[0] - 1], kappa[dips[0] + 1]
            return PhaseVelocity(_refined_minimum(table, around, number), unbounded)
    # No dip: the velocity of the shortest waves of the stiffest branch is the least one that is not a mass's own.
    return PhaseVelocity(float(branches[:, -1].min() if unbounded else branches.min()), unbounded)


def _phase_velocities(table: FloatArray, kappa: FloatArray) -> FloatArray:
    """Ω/κ of every branch in ascending order, shape (wavenumber, branch)."""
    # Polynomials in p² = −Ω², with κ given.
    in_p2 = (kappa[:, None] ** 2) ** np.arange(table.shape[0]) @ table
    degree = in_p2.shape[1] - 1
    if degree == 1:
        return np.sqrt(in_p2[:, :1] / in_p2[:, 1:]) / kappa[:, None]
    companion = np.zeros((kappa.size, degree, degree))
    companion[:, np.arange(1, degree), np.arange(degree - 1)] = 1.0
    companion[:, :, -1] = -in_p2[:, :-1] / in_p2[:, -1:]
    roots = np.linalg.eigvals(companion).real
    # Next to the stiff branches a matrix leaves few digits to the soft ones; Newton's method restores them.
    power = np.arange(1, degree + 1)
    for _ in range(2):
        terms = roots[:, :, None] ** np.arange(degree + 1) * in_p2[:, None, :]
        slope = (terms[:, :, 1:] * power).sum(axis=2) / roots
        roots = roots - terms.sum(axis=2) / slope
    squares = -roots
    return np.sort(np.sqrt(np.maximum(squares, 0.0)), axis=1) / kappa[:, None]


def _refined_minimum(table: FloatArray, around: tuple[float, float], number: int) -> float:
    """Minimum of one branch between two wavenumbers."""
    for _ in range(SEARCH.refinements):
        kappa = np.linspace(*around, SEARCH.points)
        velocity = _phase_velocities(table, kappa)[:, number]
        lowest = min(max(int(velocity.argmin()), 1), SEARCH.points - 2)
        around = kappa[lowest - 1], kappa[lowest + 1]
    return float(velocity.min())


def speed_of_greatest_deflection(stiffness: Ratio, limit: float) -> float:
    """Speed at which a steady load deflects the guideway most.

    Parameters
    ----------
    stiffness : Ratio
        Dynamic stiffness with damping [N/m²].
    limit : float
        Upper end of the search [m/s].

    Returns
    -------
    float
        The speed [m/s]; inf if the deflection is greatest at rest, so that no speed is critical.
    """
    from scipy.optimize import minimize_scalar

    static = np.flatnonzero(stiffness.above[:, 0])
    length = (stiffness.above[static[-1], 0] / stiffness.above[0, 0]) ** (1 / static[-1])

    def shallowness(speed: float, points: int) -> float:
        basin = length * np.linspace(-8.0, 4.0, points)
        deflection = residue_sum(stiffness, basin, speed, np.zeros(1, complex), 0)[:, 0].real
        peak = min(max(int(deflection.argmax()), 1), points - 2)
        left, middle, right = deflection[peak - 1 : peak + 2]
        # The vertex of the parabola through the three highest points.
        return -float(middle - (right - left) ** 2 / (8 * (right - 2 * middle + left)))

    # Open at the limit, where the deflection of an undamped guideway is infinite.
    speeds = limit * np.linspace(0.0, 1.0 - 1e-9, SEARCH.speeds)
    values = np.array([shallowness(speed, SEARCH.coarse) for speed in speeds])
    best = int(values.argmin())
    if best == 0:
        return float("inf")
    bounds = speeds[best - 1], speeds[min(best + 1, SEARCH.speeds - 1)]
    found = minimize_scalar(
        shallowness, bounds=bounds, args=(SEARCH.fine,), method="bounded", options={"xatol": 1e-7 * limit}
    )
    return float(found.x)

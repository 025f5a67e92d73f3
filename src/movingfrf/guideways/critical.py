"""At which speed a steady load meets the waves of its own guideway; and whether that stands at all."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray, IntArray
from movingfrf.guideways.waves import Ratio, Seen, waves


@dataclass(frozen=True, slots=True, kw_only=True)
class CriticalSearch:
    """What tunes the search for the critical speed; in brackets, between what each number is safe.

    The slowest wave is sought among wavenumbers, then in a bracket that shrinks; the speed of the greatest steady
    deflection among speeds on a coarse basin, then between two of them on a fine one.
    """

    per_decade: int = 20  # wavenumbers looked at [5 to 200]
    # So many decades beyond where the terms of a guideway change places: its longest waves travel infinitely fast,
    # its shortest ones differ from their front by the squared ratio of the wavenumbers at most.
    longer: float = 1.0  # [0.5 to 4]
    shorter: float = 4.0  # [3.5 to 6]
    level: float = 1e-12  # relative difference up to which terms weigh the same [1e-14 to 1e-9]
    flat: float = 1e-13  # relative depth up to which a dip is one of rounding [1e-14 to 1e-10]
    # Steps of Laguerre's method on a root, which triple its digits, and the share by which the last one moves it.
    steps: int = 40  # [10 to 200]
    settled: float = 1e-6  # [1e-12 to 1e-5]
    points: int = 33  # wavenumbers of a bracket: each refinement shrinks it to a sixteenth [17 to 129]
    refinements: int = 6  # of the bracket [4 to 12]
    speeds: int = 64  # up to the limit [16 to 256]
    coarse: int = 121  # points of the deflection basin at each of them [100 to 1000]
    fine: int = 1201  # points of the basin on which the speed is refined [600 to 5000]


SEARCH = CriticalSearch()


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


def least_phase_velocity(lossless: Ratio) -> float:
    """Infimum of the phase velocities of an undamped guideway, over all waves of all lengths.

    Parameters
    ----------
    lossless : Ratio
        Dynamic stiffness without damping [N/m²]: only even powers of κ and p.

    Returns
    -------
    float
        The velocity [m/s]; that of the slowest wave front where shorter waves travel ever slower towards it, which
        is zero where a mass vibrates for itself.
    """
    waves = _Waves.of(lossless)
    slowest = waves.velocities[:, :1]
    dips = [waves.refined(0, dip) for dip in _dips(slowest[:, 0])]
    return float(min([*dips, *waves.fronts, slowest.min()]))


def first_stationary_velocity(lossless: Ratio) -> float:
    """First stationary phase velocity of an undamped guideway, searched branch by branch from long waves on.

    Parameters
    ----------
    lossless : Ratio
        Dynamic stiffness without damping [N/m²]: only even powers of κ and p.

    Returns
    -------
    float
        The velocity [m/s].
    """
    waves = _Waves.of(lossless)
    for number, branch in enumerate(waves.velocities.T):
        dips = _dips(branch)
        if dips.size:
            return waves.refined(number, dips[0])
    # No dip: the shortest waves of the stiffest branch are the slowest ones that are not a mass's own.
    return float(waves.fronts.max() if waves.fronts.size else waves.velocities[:, -1].min())


class _Waves(NamedTuple):
    """Phase velocities of an undamped guideway, on a grid of wavenumbers that leaves out nothing."""

    table: FloatArray  # (power of κ², power of −p²/κ², the squared phase velocity): Σ table[a, b] κ²ᵃ c²ᵇ = 0
    kappa: FloatArray  # (wavenumber,) [rad/m]
    velocities: FloatArray  # (wavenumber, branch), ascending [m/s]
    fronts: FloatArray  # (front,) velocities of infinitely short waves, where they are finite [m/s]

    @classmethod
    def of(cls, lossless: Ratio) -> _Waves:
        given = lossless.above[::2, ::2]
        table = np.zeros((sum(given.shape) - 1, given.shape[1]))
        for a, b in np.argwhere(given):
            table[a + b, b] = (-1.0) ** b * given[a, b]
        table = table[: np.flatnonzero(table.any(axis=1))[-1] + 1]
        first, last = _corners(table)
        decades = np.log10(last / first) + SEARCH.longer + SEARCH.shorter
        kappa = first / 10**SEARCH.longer * np.logspace(0, decades, int(SEARCH.per_decade * decades) + 1)
        # In the limit of short waves only the highest power of κ² is left.
        fronts = np.sqrt(_roots(np.trim_zeros(table[-1:, :][0], "b")[None])[0])
        return cls(table, kappa, _velocities(table, kappa), fronts)

    def refined(self, number: int, dip: int) -> float:
        """Minimum of one branch around a wavenumber of the grid."""
        around = self.kappa[dip - 1], self.kappa[dip + 1]
        for _ in range(SEARCH.refinements):
            kappa = np.linspace(*around, SEARCH.points)
            velocity = _velocities(self.table, kappa)[:, number]
            lowest = min(max(int(velocity.argmin()), 1), SEARCH.points - 2)
            around = kappa[lowest - 1], kappa[lowest + 1]
        return float(velocity.min())


def _dips(branch: FloatArray) -> IntArray:
    """Numbers of the local minima, those of rounding left out."""
    inner = (1 + SEARCH.flat) * branch[1:-1]
    return np.flatnonzero((inner < branch[:-2]) & (inner <= branch[2:])) + 1


def _corners(table: FloatArray) -> tuple[float, float]:
    """Longest and shortest wave at which three terms weigh the same; beyond them all branches are powers of κ."""
    powers = np.argwhere(table)
    sizes = np.log(np.abs(table[tuple(powers.T)]))
    corners = []
    for three in combinations(range(len(powers)), 3):
        some = list(three)
        try:
            at = np.linalg.solve(np.diff(powers[some], axis=0), -np.diff(sizes[some]))
        except np.linalg.LinAlgError:
            continue
        weights = sizes + powers @ at
        # All others weigh less.
        if weights.max() <= weights[some[0]] + SEARCH.level * np.abs(weights).max():
            corners.append(0.5 * at[0])
    return float(np.exp(min(corners))), float(np.exp(max(corners)))


def _velocities(table: FloatArray, kappa: FloatArray) -> FloatArray:
    """Phase velocity of every branch in ascending order, shape (wavenumber, branch) [m/s]."""
    return np.sqrt(_roots((kappa[:, None] ** 2) ** np.arange(len(table)) @ table))


def _roots(coefficients: FloatArray) -> FloatArray:
    """Roots of polynomials all of whose roots are real and not negative, shape (polynomial, root), ascending.

    From the left Laguerre's method climbs to the least root without ever passing it, and the quotient by that root
    is as good as the polynomial (Wilkinson). A companion matrix would lose roots of very different size.

    Parameters
    ----------
    coefficients : ndarray, shape (polynomial, power)
        Of ascending powers.
    """
    found = []
    rest = coefficients
    while rest.shape[1] > 1:
        degree = rest.shape[1] - 1
        root = np.zeros(len(rest))
        for _ in range(SEARCH.steps):
            value, slope, bend = _with_derivatives(rest, root)
            with np.errstate(all="ignore"):
                first, second = slope / value, bend / value
                spread = (degree - 1) * ((degree - 1) * first**2 - degree * second)
                step = degree / (np.sqrt(np.maximum(spread, 0.0)) - first)
            # Past the root by a rounding error the next climb would lead to the next root.
            step = np.where(np.isfinite(step) & (value * rest[:, 0] > 0), step, 0.0)
            root = root + step
            if (step <= SEARCH.settled * root).all():
                break
        found.append(root)
        quotient = [rest[:, -1]]
        for power in range(degree - 1, 0, -1):
            quotient.insert(0, rest[:, power] + root * quotient[0])
        rest = np.stack(quotient, axis=1)
    return np.sort(np.stack(found, axis=1), axis=1) if found else np.zeros((len(coefficients), 0))


def _with_derivatives(coefficients: FloatArray, at: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Values, slopes and second derivatives of polynomials (polynomial, power), each at a place of its own."""
    value, slope, half_bend = coefficients[:, -1], 0.0 * at, 0.0 * at
    for row in coefficients[:, -2::-1].T:
        half_bend = half_bend * at + slope
        slope = slope * at + value
        value = value * at + row
    return value, slope, 2.0 * half_bend


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

    terms = stiffness.above[:, 0]
    static = np.flatnonzero(terms)
    # Where the first of the static terms outweighs the load that is the same everywhere: a shear layer too soft to
    # matter must not shorten the basin.
    length = max((abs(terms[power]) / terms[0]) ** (1 / power) for power in static if power)

    def shallowness(speed: float, points: int) -> float:
        basin = length * np.linspace(-8.0, 4.0, points)
        deflection = waves(Seen.of(stiffness, speed), speed, np.zeros(1, complex)).summed(basin)[:, 0].real
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

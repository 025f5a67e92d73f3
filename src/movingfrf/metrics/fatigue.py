"""What a history or a spectrum does to a material: level crossings, rainflow cycles, damage."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from numbers import Real
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import gammaln

from movingfrf._basics.arrays import FloatArray, IntArray
from movingfrf._basics.checks import Checks, checking, plain, shown
from movingfrf._basics.door import mistaken
from movingfrf.results.labels import RANDOM_QUANTITIES, kind_of

if TYPE_CHECKING:
    import xarray as xr


# Moments of a density of unit variance, by their order, whole or not.
Moment = Callable[[float], float]


def level_crossings(values: ArrayLike, levels: ArrayLike) -> IntArray:
    """Count how often a history rises through each level.

    Parameters
    ----------
    values : array_like, shape (time,)
        The history, of any quantity [any unit]; between its samples straight.
    levels : array_like, shape (level,)
        The levels [unit of the history].

    Returns
    -------
    ndarray of int, shape (level,)
        Number of crossings from below a level to it or above it.

    Raises
    ------
    ValueError
        If an array is not one of finite numbers.

    Examples
    --------
    >>> level_crossings([0.0, 2.0, 0.0, 1.0, -1.0], [0.5, 1.5])
    array([2, 1])
    """
    with checking() as check:
        history = check.array("values", values, "any unit", (None,))
        at = check.array("levels", levels, "any unit", (None,))
    rising = np.diff(history) > 0
    from_below = np.searchsorted(np.sort(history[:-1][rising]), at)
    still_below = np.searchsorted(np.sort(history[1:][rising]), at)
    return from_below - still_below


def rainflow(values: ArrayLike) -> FloatArray:
    """Count the rainflow cycles of a history that repeats itself.

    A range is a cycle as soon as one at least as large follows it. Counting begins at the largest value, where the
    history, begun again, also ends: every cycle closes, and the largest range of all is always counted. A million
    turning points take about a second.

    Parameters
    ----------
    values : array_like, shape (time,)
        The history, of any quantity [any unit].

    Returns
    -------
    ndarray, shape (cycle, 2)
        Amplitude (half of the range) and mean of each cycle [unit of the history].

    Raises
    ------
    ValueError
        If the history is not one of finite numbers or is empty.

    References
    ----------
    ASTM E1049-85, Standard practices for cycle counting in fatigue analysis, 5.4.5 (repeating histories).
    C. Amzallag et al., Standardization of the rainflow counting method for fatigue analysis, International Journal
    of Fatigue 16 (1994) 287-293.

    Examples
    --------
    >>> rainflow([0.0, 4.0, 1.0, 3.0, 0.0])
    array([[1., 2.],
           [2., 2.]])
    """
    with checking() as check:
        history = check.array("values", values, "any unit", (None,))
        if not history.size:
            check.refuse("values", "must hold at least one number")
    # From its largest value to that again, a repeated history leaves nothing open.
    top = int(history.argmax())
    ends: list[list[float]] = []
    waiting: list[float] = []
    for turn in _turning_points(np.concatenate([history[top:], history[: top + 1]])).tolist():
        waiting.append(turn)
        while len(waiting) > 2 and abs(waiting[-1] - waiting[-2]) >= abs(waiting[-2] - waiting[-3]):
            ends.append(waiting[-3:-1])
            del waiting[-3:-1]
    first, second = np.reshape(ends, (-1, 2)).T
    return np.stack([np.abs(second - first) / 2, (first + second) / 2], axis=1)


def rainflow_damage(values: ArrayLike, *, slope: float, strength: float = 1.0) -> float:
    """Damage of a history by the rule of Palmgren and Miner, Σ a^m / C over its rainflow cycles.

    Parameters
    ----------
    values : array_like, shape (time,)
        The history, of any quantity [any unit].
    slope : float
        Exponent m of the S-N curve N = C a^−m in the amplitude a.
    strength : float
        The curve's C: cycles to failure times amplitude to the power of the exponent [unit of the history^m].

    Returns
    -------
    float
        Damage of the whole history, dimensionless: 1 is failure. No mean-stress correction.

    Raises
    ------
    ValueError
        If exponent or strength is not positive, the exponent beyond 50, the history empty or not one of finite
        numbers.

    Examples
    --------
    Ten cycles of amplitude 2:

    >>> round(rainflow_damage(np.tile([0.0, 2.0, 0.0, -2.0], 10), slope=3.0), 9)
    80.0
    """
    slope, strength = _curve(slope, strength)
    return float(np.sum(rainflow(values)[:, 0] ** slope) / strength)


def equivalent_amplitude(values: ArrayLike, *, slope: float, duration: float, rate: float = 1.0) -> float:
    """Amplitude of the steady cycling that does the same damage as a history in the same time.

    Parameters
    ----------
    values : array_like, shape (time,)
        The history, of any quantity [any unit].
    slope : float
        Exponent m of the S-N curve.
    duration : float
        Duration of the history [s].
    rate : float
        Rate of the steady cycling [1/s].

    Returns
    -------
    float
        Amplitude (Σ a^m / (rate · duration))^(1/m) [unit of the history].

    Raises
    ------
    ValueError
        If a value is not positive, or the history is not one of finite numbers.

    Examples
    --------
    >>> time = np.linspace(0.0, 10.0, 1001)
    >>> round(equivalent_amplitude(3 * np.cos(2 * np.pi * time), slope=5.0, duration=10.0), 9)
    3.0
    """
    with checking() as check:
        duration = check.positive("duration", duration, "s")
        rate = check.positive("rate", rate, "1/s")
    damage = rainflow_damage(values, slope=slope)
    return float((damage / (rate * duration)) ** (1 / float(slope)))


def spectral_damage(
    frequency: ArrayLike,
    density: ArrayLike,
    *,
    slope: float,
    strength: float = 1.0,
    method: str = "dirlik",
) -> float:
    """Damage per second that a stationary Gaussian process does, from its spectral density alone.

    The expected damage of its rainflow cycles. For a narrow band ν₀ (√2 σ)^m Γ(1 + m/2)/C, with the rate of
    upward zero crossings ν₀ and the standard deviation σ; for a wide band that is too much, and the other methods
    approximate the distribution of rainflow amplitudes from spectral moments. They are fits: where one leaves what
    a Gaussian process can do, above that bound or not above zero, its result is refused. A single line is a narrow
    band by every method; what is at 0 Hz does no damage.

    Parameters
    ----------
    frequency : array_like, shape (frequency,)
        Frequency [Hz], increasing.
    density : array_like, shape (frequency,)
        One-sided spectral density [unit² per Hz].
    slope : float
        Exponent m of the S-N curve N = C a^−m in the amplitude a.
    strength : float
        The curve's C: cycles to failure times amplitude to the power of the exponent [unit^m].
    method : str
        `dirlik`, `tovo_benasciutti`, `single_moment` or `narrow_band`.

    Returns
    -------
    float
        Damage per second [1/s].

    Raises
    ------
    ValueError
        If shapes disagree, frequencies do not increase, a density is negative, there is no such method, or the
        method does not hold for this density.

    References
    ----------
    I. Rychlik, On the narrow-band approximation for expected fatigue damage, Probabilistic Engineering Mechanics 8
    (1993) 1-4 (the bound). T. Dirlik, Application of computers in fatigue analysis, PhD thesis, University of
    Warwick, 1985. D. Benasciutti, R. Tovo, Spectral methods for lifetime prediction under wide-band stationary
    random processes, International Journal of Fatigue 27 (2005) 867-877. C. E. Larsen, L. D. Lutes, Predicting the
    fatigue life of offshore structures by the single-moment spectral method, Probabilistic Engineering Mechanics 6
    (1991) 96-108. Compared: A. Zorman, J. Slavič, M. Boltežar, Vibration fatigue by spectral methods, Mechanical
    Systems and Signal Processing 190 (2023) 110149.

    Examples
    --------
    >>> f = np.linspace(9.9, 10.1, 201)
    >>> round(spectral_damage(f, np.full(201, 5.0), slope=4.0), 1)  # σ² = 1: 10 · 4 · Γ(3)
    80.0
    """
    slope, strength = _curve(slope, strength)
    with checking() as check:
        f = check.array("frequency", frequency, "Hz", (None,))
        given = check.array("density", density, "unit²/Hz", (f.size,))
        method = check.choice("method", method, METHODS)
        if not check.faults and (f.size < 2 or f[0] < 0 or (np.diff(f) <= 0).any()):
            check.refuse("frequency", "must be at least two numbers, not negative and increasing [Hz]")
        if (given < 0).any():
            check.refuse("density", f"must not be negative, got {given.min():g}")
    variance = float(np.trapezoid(given, f))
    if not variance:
        return 0.0
    # Of unit variance, so that no power of a force in newtons leaves the range of numbers.
    unit = given / variance

    def moment(order: float) -> float:
        return float(np.trapezoid(unit * f**order, f))

    if not moment(2):
        return 0.0  # all of it at rest
    irregularity = moment(2) / np.sqrt(moment(4))
    # Closer to 1 than this a band is one line, where the narrow band's damage is exact and others divide nothing by
    # nothing [1e-12 to 1e-7].
    line = 1e-9
    # A method that does not hold may divide by zero; what comes of it is refused.
    with np.errstate(all="ignore"):
        share = METHODS[method if irregularity < 1 - line else "narrow_band"](moment, slope)
    # By how much a method may exceed the narrow band's damage, which bounds that of every Gaussian process:
    # rounding [1e-12 to 1e-6].
    rounding = 1e-6
    if not 0 < share <= 1 + rounding:
        raise ValueError(
            f"method {method!r} does not hold for this density, whose irregularity is "
            f"{irregularity:.3g}: it gives {share:.3g} times the damage of a narrow band with the same "
            "crossings, which is the most that a Gaussian process can do; another method may hold"
        )
    with np.errstate(over="ignore"):
        narrow = 0.5 * np.log(moment(2)) + 0.5 * slope * np.log(2 * variance) + gammaln(1 + slope / 2)
        damage = float(share * np.exp(narrow - np.log(strength)))
    if not np.isfinite(damage):
        raise ValueError(
            f"strength must be in proportion to the density, got {strength:g} for a damage beyond numbers"
        )
    return damage


def _narrow_band(moment: Moment, slope: float) -> float:
    """Every cycle's crest lies one upcrossing of zero from the next."""
    return 1.0


def _dirlik(moment: Moment, slope: float) -> float:
    """Ranges distributed as an exponential and two Rayleigh parts."""
    irregularity, mean = moment(2) / np.sqrt(moment(4)), moment(1) * np.sqrt(moment(2) / moment(4))
    first = 2 * (mean - irregularity**2) / (1 + irregularity**2)
    others = 1 - irregularity - first + first**2
    width = (irregularity - mean - first**2) / others
    second = others / (1 - width)
    third = 1 - first - second
    decay = 1.25 * (irregularity - third - second * width) / first
    exponential = np.exp(gammaln(1 + slope) - gammaln(1 + slope / 2)) * (decay / np.sqrt(2)) ** slope
    return float((first * exponential + second * np.abs(width) ** slope + third) / irregularity)


def _tovo_benasciutti(moment: Moment, slope: float) -> float:
    """Between what crossings of levels and what pairs of ranges make of it."""
    wide, irregularity = moment(1) / np.sqrt(moment(2)), moment(2) / np.sqrt(moment(4))
    apart = wide - irregularity
    of_levels = (
        apart
        * (1.112 * (1 + wide * irregularity - (wide + irregularity)) * np.exp(2.11 * irregularity) + apart)
        / (irregularity - 1) ** 2
    )
    return float(of_levels + (1 - of_levels) * irregularity ** (slope - 1))


def _single_moment(moment: Moment, slope: float) -> float:
    """As if every line of the spectrum were a narrow band whose damages add up with a power."""
    return float(moment(2 / slope) ** (slope / 2) / np.sqrt(moment(2)))


# Spectral methods by name → damage over that of a narrow band with the same crossings, from moments of a density
# of unit variance and the exponent. Zhao and Baker's is not among them: below an irregularity of 0.13 one of its
# weights turns negative, and with it the damage; just above, next to none is left.
METHODS: Mapping[str, Callable[[Moment, float], float]] = {
    "narrow_band": _narrow_band,
    "dirlik": _dirlik,
    "tovo_benasciutti": _tovo_benasciutti,
    "single_moment": _single_moment,
}


def _turning_points(history: FloatArray) -> FloatArray:
    """Return the ends of a history and the points between them where it turns."""
    moved = history[np.concatenate([[True], np.diff(history) != 0])]
    rises = np.diff(moved) > 0
    return moved[np.concatenate([[True], rises[1:] != rises[:-1], [True]])] if moved.size > 1 else moved


def _curve(slope: float, strength: float) -> tuple[float, float]:
    # Powers of a force beyond this leave the range of numbers; S-N curves are far flatter [a convention].
    steepest = 50.0
    with checking() as check:
        if (slope := check.positive("slope", slope, "1")) > steepest:
            check.refuse("slope", f"must be at most {steepest:g}, got {slope!r}")
        # A power of a force leaves the magnitudes of physical quantities.
        strength = plain(strength)
        if not (isinstance(strength, Real) and 0 < strength < float("inf")):
            check.refuse("strength", f"must be positive, got {shown(strength)} unit^m")
    return slope, float(strength)


def spectral_fatigue(
    result: xr.Dataset, quantity: str, *, slope: float, strength: float = 1.0, method: str = "dirlik"
) -> xr.DataArray:
    """Fatigue damage per second that a random response does, from its spectral density.

    Parameters
    ----------
    result : xarray.Dataset
        What `random_response` returned.
    quantity : str
        `contact_force`, `deflection`, `motion`, `acceleration` or `roughness`.
    slope : float
        Exponent m of the S-N curve N = C a^−m in the amplitude a.
    strength : float
        The curve's C: cycles to failure times amplitude to the power of the exponent [unit^m].
    method : str
        How rainflow cycles are estimated from a spectrum: `dirlik`, `tovo_benasciutti`, `single_moment` or
        `narrow_band`; see `spectral_damage`.

    Returns
    -------
    xarray.DataArray
        Damage per second [1/s] of every contact or degree of freedom.

    Raises
    ------
    ValueError
        If the result is none of `random_response`, there is no such quantity or method, a value is not positive, or
        the method does not hold for a density.
    """
    with checking() as check:
        check_random(check, result)
        quantity = check.choice("quantity", quantity, RANDOM_QUANTITIES)
    frequency, density = result.frequency.values, result[f"{quantity}_density"].values
    if "bandwidth" in result.coords:
        # The damage is integrated by trapezoids: so weighted they give the moments of the Gauss points.
        gaps = np.diff(frequency, prepend=frequency[0], append=frequency[-1])
        density = density * (result.bandwidth.values / (0.5 * (gaps[1:] + gaps[:-1])))[:, None]
    damage = [
        spectral_damage(frequency, column, slope=slope, strength=strength, method=method) for column in density.T
    ]
    found = result[f"{quantity}_rms"].copy(data=damage).rename(f"{quantity}_damage")
    found.attrs = {
        "units": "1/s",
        "long_name": f"fatigue damage per second of the {RANDOM_QUANTITIES[quantity][2]}",
        "slope": float(slope),
        "strength": float(strength),
        "method": method,
    }
    return found


def check_random(check: Checks, result: object) -> None:
    """Refuse what is not the response to a random road."""
    if kind_of(result) != "random":
        check.refuse("result", mistaken("random result", result))

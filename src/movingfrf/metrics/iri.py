"""Roughness indices of a profile: what a reference quarter car makes of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import ComplexArray, FloatArray
from movingfrf._basics.checks import checking
from movingfrf._basics.wording import told_apart
from movingfrf.results.findings import Finding, announced
from movingfrf.roughness.profile import Profile, require_profile


@dataclass(frozen=True, slots=True, kw_only=True)
class Procedure:
    """How a car is driven over a profile by ASTM E1926 and E1489; standardised down to `longest_step`."""

    speed: float = 80 / 3.6  # at which both indices are defined [m/s]
    average: float = 0.25  # length over which a tyre and the standards average a profile [m]
    start: float = 11.0  # length of the profile whose slope the car has at its start: half a second [m]
    longest_step: float = 0.3 * (1 + 1e-6)  # the standards' between stations [m], and the rounding of a file's
    # Straight pieces up to this long are not held against the spline: they cost the index 0.4 % and the ride number
    # 0.02 [0.05 to 0.12 m].
    short: float = 0.1
    fine: float = 0.05  # longest step of the spline; straight pieces of it cost 0.1 % [0.02 to 0.06 m]
    looked_at: float = 20e3  # so much of a profile tells what its step costs [m; 1e3 and more]
    # What is worth saying: a change of the index, of itself, and one of the ride number [conventions].
    telling_index: float = 0.01
    telling_number: float = 0.05


PROCEDURE = Procedure()


class ReferenceCar(NamedTuple):
    """A quarter car per unit of sprung mass, on a tyre that is a spring."""

    tyre: float  # K1, stiffness over sprung mass [1/s²]
    suspension: float  # K2, stiffness over sprung mass [1/s²]
    damping: float  # C, suspension damping over sprung mass [1/s]
    unsprung: float  # μ, unsprung over sprung mass

    def matrices(self) -> tuple[FloatArray, FloatArray]:
        """State matrix of (z_s, ż_s, z_u, ż_u) and what the elevation under the tyre adds to it."""
        k1, k2, c, mu = self
        return np.array(
            [
                [0.0, 1.0, 0.0, 0.0],
                [-k2, -c, k2, c],
                [0.0, 0.0, 0.0, 1.0],
                [k2 / mu, c / mu, -(k1 + k2) / mu, -c / mu],
            ]
        ), np.array([0.0, 0.0, 0.0, k1 / mu])


GOLDEN_CAR = ReferenceCar(tyre=653.0, suspension=63.3, damping=6.0, unsprung=0.15)
RIDE_NUMBER_CAR = ReferenceCar(tyre=5120.0, suspension=390.0, damping=17.0, unsprung=0.036)


def iri(profile: Profile, segment: float | None = None, *, average: float = PROCEDURE.average) -> FloatArray:
    """Compute the international roughness index of a profile.

    The mean rectified speed of the suspension of the golden car, over its speed of 80 km/h, at the n stations:

        IRI = 1/n Σ |ż_s − ż_u| / V

    Between stations the profile is straight, and the car follows it exactly (matrix exponential). Before that the
    profile is averaged over 250 mm by weights on its slopes, whole ones inside and fractional ones at both ends. A
    slope between two stations is itself an average over a step, so the weights are those that together with it have
    the second moment of a window of exactly 250 mm. Steps of 250 mm and more are averaged no further. The car
    starts where the first whole window lies, at the mean slope of the first 11 m.

    Straight pieces between far stations cut crests off: on a road without waves shorter than two steps the index is
    0.3 % low at a step of 0.1 m, 1 to 2 % at 0.2 and 0.25 m, 3 to 4 % at 0.3 m (`docs/measures.md`). It is what the
    standard says all the same; where the spline through the stations gives another index, a warning has the figure.

    Parameters
    ----------
    profile : Profile
        The road, at even steps of at most 0.3 m for a meaningful index, at least 11 m long.
    segment : float, optional
        Length of the segments that are measured one by one [m], from the first station on; what is left at the end
        is left out. None measures the whole profile as one.
    average : float
        Length of the moving average [m]; 0 leaves it out.

    Returns
    -------
    ndarray, shape (segment, path)
        Index [mm/m], which is the same as m/km.

    Raises
    ------
    ValueError
        If stations are uneven, or the profile is shorter than 11 m, than one segment or than the average.

    Warns
    -----
    ValidityWarning
        If the spline through stations more than 0.1 m apart has an index that differs by more than 1 %.

    References
    ----------
    ASTM E1926, Standard practice for computing international roughness index of roads from longitudinal profile
    measurements. M. W. Sayers, On the calculation of international roughness index from longitudinal road profile,
    Transportation Research Record 1501 (1995) 1-12.

    Examples
    --------
    Slopes of one part in a thousand, 10 m from crest to crest, where the golden car's gain is 1.26; the mean of a
    rectified sine is 2/π of its amplitude.

    >>> x = np.arange(0.0, 1000.0, 0.05)
    >>> wave = Profile(x, 1e-3 * 10 / (2 * np.pi) * np.sin(2 * np.pi * x / 10))
    >>> (np.pi / 2 * iri(wave, segment=500.0)[-1]).round(2)
    array([1.26])
    """
    require_profile(profile)
    found = straight_index(profile, segment, average)
    announced(coarse_for_index(profile, average))
    return found


def straight_index(profile: Profile, segment: float | None, average: float = PROCEDURE.average) -> FloatArray:
    """Roughness index, as `iri` computes it, without a word about the step; shape (segment, path) [mm/m]."""
    return 1e3 * _segments(profile, GOLDEN_CAR, segment, average, np.abs)


def index_between(profile: Profile, edges: FloatArray) -> FloatArray:
    """Roughness index of segments, by the rules of `iri`.

    Parameters
    ----------
    profile : Profile
        The road, at even steps and long enough for an index.
    edges : ndarray, shape (segment + 1,)
        Where each segment begins and ends [m], at least `shortest_segment` apart.

    Returns
    -------
    ndarray, shape (segment, path)
        Index [mm/m].
    """
    step = profile.even_step() or 0.0
    return 1e3 * _means(profile, step, GOLDEN_CAR, edges - profile.stations[0], PROCEDURE.average, np.abs)


def shortest_segment(step: float, average: float = PROCEDURE.average) -> float:
    """Length of the shortest segment that has an index [m]: a whole window, a fraction of a step at either end."""
    return average + 3 * step


def coarse_for_index(profile: Profile, average: float = PROCEDURE.average) -> list[Finding]:
    """Say what straight pieces between far stations cost the roughness index.

    Parameters
    ----------
    profile : Profile
        The profile, at even steps.
    average : float
        Length of the moving average [m].

    Returns
    -------
    list of Finding
        Empty where the step is short, or does not matter.
    """
    both = _straight_and_smooth(profile)
    if not both:
        return []
    straight, smooth = (straight_index(each, None, average)[0] for each in both)
    cost = np.divide(straight, smooth, out=np.ones_like(smooth), where=smooth > 0) - 1
    most = float(cost[np.abs(cost).argmax()])
    return _coarse(both[0], abs(most) > PROCEDURE.telling_index, f"roughness index is {abs(most):.1%}", most)


def _coarse(profile: Profile, telling: bool, by: str, cost: float) -> list[Finding]:
    way, step = "lower" if cost < 0 else "higher", profile.even_step()
    words = (
        f"the {by} {way} on straight pieces of {step:.3g} m, as the standard has them, than on the spline through "
        "the same stations: closer stations would tell"
    )
    return [Finding("coarse_step", words)] if telling else []


def _straight_and_smooth(profile: Profile) -> tuple[Profile, Profile] | None:
    """Take the beginning of a profile, and its spline at a fine step; None where it is fine itself."""
    step = profile.even_step() or 0.0
    if step <= PROCEDURE.short:
        return None
    count = min(profile.stations.size, int(PROCEDURE.looked_at / step))
    pieces = int(np.ceil(step / PROCEDURE.fine))
    # Stations but for the rounding of a file, so that both have them at the same places.
    even = Profile(step * np.arange(count), profile.columns[:count])
    fine = step / pieces * np.arange((count - 1) * pieces + 1)
    fine[-1] = even.stations[-1]
    return even, Profile(fine, np.stack([even.along(path)(fine) for path in range(even.paths)], axis=1))


def ride_number(
    profile: Profile, segment: float | None = None, *, average: float = PROCEDURE.average
) -> FloatArray:
    """Compute the ride number of a profile: how passengers rate the ride, from 0 (impassable) to 5 (perfect).

    From the root mean square PI of (ż_s − ż_u)/V, of a quarter car at 80 km/h that is much stiffer than the golden
    one and so feels shorter waves, with averaging and start as for the `iri`:

        RN = 5 exp(−160 PI),   PI² = (PI_left² + PI_right²)/2

    Its wheel swings at waves of 0.37 m, which kinks at stations 0.15 to 0.25 m apart excite: a ride number of 1.7
    comes out lower by 0.15 to 0.3 (`docs/measures.md`); a warning has the figure.

    Parameters
    ----------
    profile : Profile
        The road, at even steps, at least 11 m long. Of several paths the mean square is taken.
    segment : float, optional
        Length of the segments that are measured one by one [m]; None measures the whole profile as one.
    average : float
        Length of the moving average [m]; 0 leaves it out.

    Returns
    -------
    ndarray, shape (segment,)
        Ride number, dimensionless.

    Raises
    ------
    ValueError
        As for `iri`.

    Warns
    -----
    ValidityWarning
        If the spline through stations more than 0.1 m apart has a ride number that differs by more than 0.05.

    References
    ----------
    ASTM E1489, Standard practice for computing ride number of roads from longitudinal profile measurements.
    M. W. Sayers, S. M. Karamihas, Estimation of rideability by analyzing longitudinal road profile, Transportation
    Research Record 1536 (1996) 110-116.

    Examples
    --------
    >>> x = np.arange(0.0, 1000.0, 0.05)
    >>> wave = Profile(x, 1e-3 * 5 / (2 * np.pi) * np.sin(2 * np.pi * x / 5))
    >>> ride_number(wave).round(2)
    array([4.32])
    """
    require_profile(profile)
    found = _straight_number(profile, segment, average)
    if both := _straight_and_smooth(profile):
        straight, smooth = (_straight_number(each, None, average)[0] for each in both)
        cost = float(straight - smooth)
        telling = abs(cost) > PROCEDURE.telling_number
        announced(_coarse(both[0], telling, f"ride number is {abs(cost):.2g}", cost))
    return found


def _straight_number(profile: Profile, segment: float | None, average: float) -> FloatArray:
    square = _segments(profile, RIDE_NUMBER_CAR, segment, average, np.square)
    return 5 * np.exp(-160 * np.sqrt(square.mean(axis=1)))


def _segments(
    profile: Profile,
    car: ReferenceCar,
    segment: float | None,
    average: float,
    measure: Callable[[FloatArray], FloatArray],
) -> FloatArray:
    """Mean of a measure of the suspension's slope (ż_s − ż_u)/V over each segment, shape (segment, path)."""
    step, length = profile.even_step() or 0.0, float(np.ptp(profile.stations))
    with checking() as check:
        average = check.not_negative("average", average, "m")
        shortest = shortest_segment(step, average)
        if not step:
            check.refuse("profile", "must have stations at even steps [m]; resample it first")
        elif step > PROCEDURE.longest_step:
            most, got = told_apart(PROCEDURE.longest_step, step)
            check.refuse("profile", f"must have a step of at most {most} m, got {got} m")
        if length < PROCEDURE.start:
            least, got = told_apart(PROCEDURE.start, length)
            check.refuse("profile", f"must be at least {least} m long, got {got} m")
        elif shortest > length:
            most, got = told_apart(length, average)
            check.refuse("average", f"must leave something of the profile's {most} m, got {got} m")
        elif segment is not None and not shortest <= (
            segment := check.positive("segment", segment, "m")
        ) <= length * (1 + 1e-9):
            check.refuse(
                "segment",
                f"must be at least {shortest:g} m and at most the profile's {length:g} m, got {segment!r} m",
            )
    span = length if segment is None else segment
    # A rounding must not lose the last segment.
    edges = np.arange(int(length / span + 1e-6) + 1) * span
    return _means(profile, step, car, edges, average, measure)


def _means(
    profile: Profile,
    step: float,
    car: ReferenceCar,
    edges: FloatArray,
    average: float,
    measure: Callable[[FloatArray], FloatArray],
) -> FloatArray:
    """Mean of a measure between edges [m], distances from the first station on; shape (segment, path)."""
    weights = _weights(average / step)
    # Where each segment begins and ends, in steps.
    bounds = np.floor(edges / step + 1e-6).astype(int)
    # The first and the last steps are not surrounded by a whole window.
    half = weights.size // 2
    bounds = np.clip(bounds - half, 0, len(profile.stations) - weights.size)
    elevation = np.asarray(profile.elevation)
    found = []
    for column in [elevation] if elevation.ndim == 1 else elevation.T:
        slopes = np.convolve(np.diff(column) / step, weights, mode="valid")
        ahead = np.interp(PROCEDURE.start, step * np.arange(len(column)), column)
        start = (ahead - column[0]) / PROCEDURE.start
        taken = measure(suspension_slope(slopes, step, car, float(start)))
        found.append(np.add.reduceat(taken[: bounds[-1]], bounds[:-1]) / np.diff(bounds))
    return np.stack(found, axis=1)


def suspension_slope(slopes: FloatArray, step: float, car: ReferenceCar, start: float) -> FloatArray:
    """Slope (ż_s − ż_u)/V of the suspension at the end of each step of a road of straight pieces.

    Parameters
    ----------
    slopes : ndarray, shape (step,)
        Slope of each piece [m/m].
    step : float
        Length of a piece [m].
    car : ReferenceCar
        The car; travels at 80 km/h.
    start : float
        Slope along which it comes [m/m].

    Returns
    -------
    ndarray, shape (step,)
        Slope [m/m].
    """
    from scipy.signal import lfilter

    # The slope drives the car's slopes as the elevation drives its heights. One recursion of first order per mode
    # is exact, and unlike one of fourth order keeps its digits at steps of millimetres.
    poles, shapes, into = _modes(car)
    kept = np.exp(poles * step / PROCEDURE.speed)
    found = np.zeros(len(slopes))
    for pole, keep, shape, given in zip(poles, kept, shapes, into, strict=True):
        gain = shape * given / pole
        # About the steady state −gain, in which the car comes along the slope.
        (driven, _) = lfilter([gain * (keep - 1)], [1.0, -keep], slopes, zi=[-keep * gain * start])
        found += 2 * driven.real
    return found


def _modes(car: ReferenceCar) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
    """Upper poles [rad/s], how much of each mode the suspension's stroke shows, and what the road feeds into it."""
    state, road = car.matrices()
    poles, vectors = np.linalg.eig(state)
    into = np.linalg.solve(vectors, road)
    upper = poles.imag > 0
    return poles[upper], (vectors[0] - vectors[2])[upper], into[upper]


def _weights(window: float) -> FloatArray:
    """Weights that average slopes over a window of so many steps; each slope is an average over one already."""
    if not window or abs(window - 1) < 1e-9:
        return np.ones(1)
    # Of a window shorter than a step the end weights are negative: they undo what the step averages too much.
    inside, missing = max(int(np.ceil((window - 1) / 2 - 1e-6)) - 1, 0), (window**2 - 1) / 12
    # The end weight with which the second moment of the weights, in steps squared, is what a window of that length
    # has beyond a window of one step.
    whole = np.arange(-inside, inside + 1)
    fraction = (whole.size * missing - float((whole**2).sum())) / (2 * ((inside + 1) ** 2 - missing))
    weights = np.array([fraction, *np.ones(whole.size), fraction])
    return weights / weights.sum()

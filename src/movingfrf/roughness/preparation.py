"""What is done to a measured profile before it is used: each step makes a new profile and says what it did."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from movingfrf._basics.arrays import FloatArray, require_memory
from movingfrf._basics.checks import ParameterError, checking, shown
from movingfrf._basics.smooth import smooth_step
from movingfrf.roughness.profile import SLACK, Profile


@dataclass(frozen=True, slots=True, kw_only=True)
class Filter:
    """What tunes the filters, Butterworth's, which run both ways; in brackets, between what each number is safe.

    The first three are documented: of a wave as long as the filter's a half is left, of one of another length what
    the order says.
    """

    # Before samples are taken further apart, waves shorter than this many new steps are taken out: more than 2.485,
    # or 3 % are left of waves of two steps.
    shortest_wave: float = 2.5
    sharp: int = 8  # order of the filter that does so
    gentle: int = 2  # order of the one that takes out long waves
    settling: float = 2.0  # wavelengths that it goes on past either end, the profile turned about its end [1 to 8]


FILTER = Filter()


def selected(profile: Profile, *, paths: Sequence[int]) -> Profile:
    """Take some of the paths, in the order in which they are named.

    Parameters
    ----------
    profile : Profile
        The road.
    paths : sequence of int
        Number of each path to take, counted from 0.

    Returns
    -------
    Profile
        With a column for each.

    Raises
    ------
    ValueError
        If there is no such path, or none is named.

    Examples
    --------
    >>> both = Profile([0.0, 1.0, 2.0, 3.0], [[0.0, 1.0]] * 4)
    >>> selected(both, paths=[1]).elevation[0].tolist()
    [1.0]
    """
    with checking() as check:
        if np.ndim(paths) != 1 or not len(paths):
            check.refuse("paths", f"must be a list of at least one number of a path, got {shown(paths)}")
        else:
            for path in paths:
                if check.whole("paths", path) >= profile.paths:
                    check.refuse("paths", f"must be below {profile.paths}, the number of paths, got {path}")
    across = None if profile.across is None else tuple(profile.across[path] for path in paths)
    return _done(profile, f"took the paths {list(paths)}", elevation=profile.columns[:, list(paths)], across=across)


def cropped(profile: Profile, *, first: float | None = None, last: float | None = None) -> Profile:
    """Take the stations from one distance to another.

    Parameters
    ----------
    profile : Profile
        The road.
    first : float, optional
        Distance from which stations are kept [m]; from the beginning by default.
    last : float, optional
        Distance to which stations are kept [m]; to the end by default.

    Returns
    -------
    Profile
        Its stations keep their distances.

    Raises
    ------
    ValueError
        If fewer than four stations are left.

    Examples
    --------
    >>> cropped(Profile(np.arange(9.0), np.zeros(9)), first=2.5).stations.tolist()
    [3.0, 4.0, 5.0, 6.0, 7.0, 8.0]
    """
    stations = profile.stations
    with checking() as check:
        low = stations[0] if first is None else check.finite("first", first, "m")
        high = stations[-1] if last is None else check.finite("last", last, "m")
        kept = (stations >= low) & (stations <= high)
        if not check.faults and kept.sum() < 4:
            check.refuse(
                "last" if first is None else "first",
                f"must leave at least 4 stations, but between {low:g} m and {high:g} m there are {kept.sum()}",
            )
    done = f"cropped to {low:g} to {high:g} m"
    return _done(profile, done, distance=stations[kept], elevation=np.asarray(profile.elevation)[kept])


def repaired(profile: Profile, *, spike: float, window: float = 1.0, longest: float = 0.5) -> Profile:
    """Replace spikes by straight lines: elevations that lie far from the median of those around them.

    Parameters
    ----------
    profile : Profile
        The road, at an even step.
    spike : float
        Distance from the median beyond which an elevation counts as a spike [m].
    window : float
        Length of road that the median is taken over [m].
    longest : float
        The longest gap that may be bridged where spikes were taken out [m].

    Returns
    -------
    Profile
        It says how many were replaced, and where the longest gap was.

    Raises
    ------
    ValueError
        If a gap is longer than allowed or reaches an end, the window holds fewer than three stations, or stations
        are uneven.

    Examples
    --------
    >>> z = np.zeros(50)
    >>> z[20] = 0.1
    >>> clean = repaired(Profile(0.1 * np.arange(50), z), spike=0.02)
    >>> clean.steps[0]
    'replaced 1 spike of more than 0.02 m over the median of 1 m: the longest gap 0.2 m at 2 m'
    """
    from scipy.ndimage import median_filter

    with checking() as check:
        check.positive("spike", spike, "m")
        check.positive("window", window, "m")
        check.positive("longest", longest, "m")
    step = profile.require_even("looking for spikes")
    size = 2 * round(window / step / 2) + 1
    with checking() as check:
        if size < 3:
            check.refuse("window", f"must hold three stations, {3 * step:g} m, got {window:g} m")
    stations, elevation = profile.stations, profile.columns.copy()
    replaced, worst, place = 0, 0.0, 0.0
    for column in elevation.T:
        out = np.abs(column - median_filter(column, size, mode="mirror")) > spike
        if not out.any():
            continue
        there = np.flatnonzero(~out)
        gaps = np.diff(there) * step
        if out[0] or out[-1] or gaps.max() > longest * (1 + SLACK):
            at = stations[0] if out[0] else stations[-1] if out[-1] else stations[there[gaps.argmax()]]
            raise ValueError(
                f"spikes make a gap of more than {longest:g} m, or one at an end, near {at:g} m: they are no "
                "spikes; crop the profile there"
            )
        replaced += int(out.sum())
        if gaps.max() > worst:
            worst, place = float(gaps.max()), float(stations[there[gaps.argmax()] + 1])
        column[out] = np.interp(stations[out], stations[there], column[there])
    found = (
        f"replaced {replaced} spike{'s' * (replaced != 1)} of more than {spike:g} m over the median of {window:g} m"
    )
    where = f": the longest gap {worst:.4g} m at {place:g} m" if replaced else ""
    return _done(profile, found + where, elevation=_like(profile, elevation))


def detrended(profile: Profile, *, degree: int = 1) -> Profile:
    """Take out drift: of each path the polynomial that fits it best.

    Parameters
    ----------
    profile : Profile
        The road.
    degree : int
        Exponent of its highest power: 0 takes out the mean, 1 a straight line.

    Returns
    -------
    Profile
        What is left, about zero.

    Raises
    ------
    ValueError
        If the degree does not lie between 0 and 5.

    Examples
    --------
    >>> x = np.arange(5.0)
    >>> detrended(Profile(x, 3.0 + 0.1 * x)).elevation.max().round(12).item()
    0.0
    """
    most = 5
    with checking() as check:
        if check.whole("degree", degree) > most:
            check.refuse("degree", f"must be at most {most}, got {degree}")
    stations = profile.stations
    # Legendre polynomials over −1 to 1: powers of a station of 500 km would lose every digit.
    along = 2 * (stations - stations[0]) / (stations[-1] - stations[0]) - 1
    fitted = np.polynomial.legendre.legval(along, np.polynomial.legendre.legfit(along, profile.columns, degree)).T
    removed = np.ptp(fitted, axis=0).max()
    done = f"took out a polynomial of degree {degree}, which ranged over {removed:.4g} m at the most"
    return _done(profile, done, elevation=_like(profile, profile.columns - fitted))


def high_passed(profile: Profile, *, wavelength: float) -> Profile:
    """Take out long waves, without shifting the others: a Butterworth filter of second order, forth and back.

    A wave of length λ keeps 1/(1 + (λ/λ_c)⁴) of its amplitude, half of it at λ = λ_c.

    Parameters
    ----------
    profile : Profile
        The road, at an even step.
    wavelength : float
        Wavelength λ_c of which half is left [m].

    Returns
    -------
    Profile
        What is left, about zero. Within a wavelength or so of either end it depends on how the road is taken to go
        on.

    Raises
    ------
    ValueError
        If stations are uneven, or the wavelength is not at least four steps and at most the length.

    Examples
    --------
    >>> x = np.arange(0.0, 400.0, 0.1)
    >>> road = Profile(x, np.sin(2 * np.pi * x / 40))
    >>> middle = high_passed(road, wavelength=40.0).elevation[1500:2500]
    >>> round(float(middle.max()), 2)
    0.5
    """
    from scipy.signal import butter, sosfiltfilt

    with checking() as check:
        check.positive("wavelength", wavelength, "m")
    step = profile.require_even("a filter")
    length = profile.stations[-1] - profile.stations[0]
    with checking() as check:
        if not 4 * step <= wavelength <= length:
            check.refuse(
                "wavelength",
                f"must lie between four steps and the length of the profile, {4 * step:g} and {length:g} m, got "
                f"{wavelength:g} m",
            )
    past = min(len(profile.stations) - 1, int(np.ceil(FILTER.settling * wavelength / step)))
    sections = butter(FILTER.gentle, 1 / wavelength, "highpass", fs=1 / step, output="sos")
    kept = sosfiltfilt(sections, profile.columns, axis=0, padlen=past)
    how = f"Butterworth of order {FILTER.gentle}, both ways, half left there"
    done = f"took out waves longer than {wavelength:g} m ({how})"
    return _done(profile, done, elevation=_like(profile, kept))


def resampled(profile: Profile, *, step: float) -> Profile:
    """Put the stations at an even step: on the cubic spline, after waves that are too short for it are taken out.

    Parameters
    ----------
    profile : Profile
        The road.
    step : float
        Distance between stations [m]. If it is longer than that of the profile (the median one where it is uneven),
        waves shorter than 2.5 new steps are filtered out before, without shifting the others: half of a wave of
        that length is left, and less than 3 % of one of two steps, the shortest that the new stations can show.

    Returns
    -------
    Profile
        With stations from the first on.

    Raises
    ------
    ValueError
        If the step is not positive, leaves fewer than four stations, or needs more memory than is free.

    Examples
    --------
    >>> resampled(Profile([0.0, 0.9, 2.1, 3.0], [0.0, 0.9, 2.1, 3.0]), step=0.5).elevation.round(9).tolist()
    [0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0]
    """
    with checking() as check:
        check.positive("step", step, "m")
    stations = profile.stations
    length = stations[-1] - stations[0]
    count = int((length / step) * (1 + SLACK)) + 1
    with checking() as check:
        if count < 4:
            check.refuse("step", f"must leave at least 4 stations on {length:g} m, got {step:g} m")
    _require_room(length, step, profile.paths)
    old = profile.even_step() or float(np.median(np.diff(stations)))
    done = f"resampled from {old:.4g} to {step:g} m"
    fine = profile
    if step > old * (1 + 1e-6):
        fine = _without_short_waves(profile, old, FILTER.shortest_wave * step)
        done += f" after taking out waves shorter than {FILTER.shortest_wave * step:g} m"
    new = stations[0] + step * np.arange(count)
    elevation = np.stack([fine.along(path)(new) for path in range(fine.paths)], axis=1)
    return _done(profile, done, distance=new, elevation=_like(profile, elevation))


def repeated(profile: Profile, *, length: float, overlap: float = 0.0) -> Profile:
    """Make a longer road of a short one by putting copies of it behind each other.

    Such a road is periodic: its spectrum has lines, and what happens once on the original happens every time.

    Parameters
    ----------
    profile : Profile
        The road, at an even step.
    length : float
        Length to reach [m].
    overlap : float
        Length over which the end of each copy fades into the beginning of the next [m]. With 0 they stand one step
        apart, and whatever jump lies between end and beginning is passed at every joint.

    Returns
    -------
    Profile
        It says how often the original stands in it, and how high the jumps are.

    Raises
    ------
    ValueError
        If the length is less than the profile's, the overlap more than half of it, or stations are uneven.

    Examples
    --------
    >>> repeated(Profile([0.0, 1.0, 2.0, 3.0], [0.0, 1.0, 2.0, 1.0]), length=6.0).elevation.tolist()
    [0.0, 1.0, 2.0, 1.0, 0.0, 1.0, 2.0]
    """
    step = profile.require_even("repetition")
    own = profile.stations[-1] - profile.stations[0]
    count = _longer(length, own, step, profile.paths)
    with checking() as check:
        if check.not_negative("overlap", overlap, "m") > own / 2:
            check.refuse("overlap", f"must be at most half of the profile, {own / 2:g} m, got {overlap:g} m")
    elevation = profile.columns
    shared = round(overlap / step)
    period = elevation[: len(elevation) - shared].copy()
    if shared:
        rising = smooth_step((np.arange(shared) + 0.5) / shared)[:, None]
        period[:shared] = rising * elevation[:shared] + (1 - rising) * elevation[len(elevation) - shared :]
    jump = np.abs(period[0] - period[-1]).max()
    done = f"repeated {count / len(period):.4g} times to {length:g} m, " + (
        f"each time faded over {shared * step:g} m" if shared else f"with a jump of up to {jump:.3g} m each time"
    )
    return _extended(profile, step, count, np.arange(count) % len(period), period, done)


def mirrored(profile: Profile, *, length: float) -> Profile:
    """Make a longer road of a short one by driving it forth and back, forth and back.

    There is no jump where it turns, but a corner; such a road is periodic over twice the length of the original.

    Parameters
    ----------
    profile : Profile
        The road, at an even step.
    length : float
        Length to reach [m].

    Returns
    -------
    Profile
        It says how often the original stands in it.

    Raises
    ------
    ValueError
        If the length is less than the profile's, or stations are uneven.

    Examples
    --------
    >>> mirrored(Profile([0.0, 1.0, 2.0, 3.0], [0.0, 1.0, 2.0, 5.0]), length=6.0).elevation.tolist()
    [0.0, 1.0, 2.0, 5.0, 2.0, 1.0, 0.0]
    """
    step = profile.require_even("mirroring")
    own = profile.stations[-1] - profile.stations[0]
    count = _longer(length, own, step, profile.paths)
    last = len(profile.stations) - 1
    place = last - np.abs(np.arange(count) % (2 * last) - last)
    done = f"mirrored forth and back {length / own:.4g} times to {length:g} m"
    return _extended(profile, step, count, place, profile.columns, done)


def prepared(
    profile: Profile,
    *,
    paths: Sequence[int] | None = None,
    first: float | None = None,
    last: float | None = None,
    spike: float | None = None,
    detrend: int | None = None,
    high_pass: float | None = None,
    step: float | None = None,
    repeat_to: float | None = None,
    mirror_to: float | None = None,
) -> Profile:
    """Do several things to a profile, in the order of the arguments; what is None is not done.

    Parameters
    ----------
    profile : Profile
        The road.
    paths : sequence of int, optional
        Number of each path to take (`selected`).
    first, last : float, optional
        Distances to crop to [m] (`cropped`).
    spike : float, optional
        Distance from the median beyond which a spike is replaced [m] (`repaired`).
    detrend : int, optional
        Exponent of the highest power of the drift that is taken out (`detrended`).
    high_pass : float, optional
        Wavelength above which waves are taken out [m] (`high_passed`).
    step : float, optional
        Step to resample to [m] (`resampled`).
    repeat_to : float, optional
        Length to reach by repetition [m] (`repeated`).
    mirror_to : float, optional
        Length to reach by driving forth and back [m] (`mirrored`).

    Returns
    -------
    Profile
        Its `steps` list what was done.

    Raises
    ------
    ValueError
        If a step does, or if the profile is to be repeated and mirrored as well.
    """
    with checking() as check:
        if repeat_to is not None and mirror_to is not None:
            check.refuse("mirror_to", "and repeat_to exclude each other: one length [m] is enough")
    profile = _asked(profile, selected, "paths", paths=paths)
    if first is not None or last is not None:
        profile = cropped(profile, first=first, last=last)
    profile = _asked(profile, repaired, "spike", spike=spike)
    profile = _asked(profile, detrended, "detrend", degree=detrend)
    profile = _asked(profile, high_passed, "high_pass", wavelength=high_pass)
    profile = _asked(profile, resampled, "step", step=step)
    profile = _asked(profile, repeated, "repeat_to", length=repeat_to)
    return _asked(profile, mirrored, "mirror_to", length=mirror_to)


def _asked(profile: Profile, done: Callable[..., Profile], option: str, /, **argument: object) -> Profile:
    """Do a step if its argument is not None; a fault bears the option's name."""
    ((name, value),) = argument.items()
    if value is None:
        return profile
    try:
        return done(profile, **argument)
    except ParameterError as error:
        faults = [fault._replace(name=option if fault.name == name else fault.name) for fault in error.faults]
        raise ParameterError(faults) from None


def _done(profile: Profile, sentence: str, **changed: object) -> Profile:
    return replace(profile, **changed, steps=(*profile.steps, sentence))  # type: ignore[arg-type]


def _like(profile: Profile, columns: FloatArray) -> FloatArray:
    """Elevations in the shape that the profile's own have: without columns where it has none."""
    return columns[:, 0] if profile.same_across else columns


def _without_short_waves(profile: Profile, step: float, wavelength: float) -> Profile:
    """Even stations at the profile's own step, and waves shorter than a length filtered out."""
    from scipy.signal import butter, sosfiltfilt

    stations, columns = profile.stations, profile.columns
    if profile.even_step() is None:
        intervals = max(round((stations[-1] - stations[0]) / step), 4)
        stations = np.linspace(stations[0], stations[-1], intervals + 1)
        columns = np.stack([profile.along(path)(stations) for path in range(profile.paths)], axis=1)
    past = min(len(stations) - 1, int(np.ceil(FILTER.settling * wavelength / step)))
    sections = butter(FILTER.sharp, 1 / wavelength, "lowpass", fs=1 / step, output="sos")
    return Profile(stations, _like(profile, sosfiltfilt(sections, columns, axis=0, padlen=past)))


def _longer(length: float, own: float, step: float, paths: int) -> int:
    """Tell how many stations a longer road has."""
    with checking() as check:
        if check.positive("length", length, "m") < own * (1 - SLACK):
            check.refuse("length", f"must be at least that of the profile, {own:g} m, got {length:g} m")
    _require_room(length, step, paths)
    return int(np.ceil(length / step - SLACK * length / step)) + 1


def _require_room(length: float, step: float, paths: int) -> None:
    needed = 64 * length / step * paths  # bytes that a new profile takes at its peak
    require_memory(needed, f"a profile of {length:g} m in steps of {step:g} m")


def _extended(
    profile: Profile, step: float, count: int, place: np.ndarray, columns: FloatArray, sentence: str
) -> Profile:
    distance = profile.stations[0] + step * np.arange(count)
    return _done(profile, sentence, distance=distance, elevation=_like(profile, columns[place]))

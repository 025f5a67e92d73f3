"""Spikes replaced."""

from __future__ import annotations

import numpy as np

from movingfrf._basics.checks import checking
from movingfrf._basics.wording import place, told_apart
from movingfrf.roughness.profile import SLACK, Profile, require_profile
from movingfrf.roughness.steps.base import Step, changed, like


def repaired(profile: Profile, *, spike: float, window: float = 1.0, longest: float = 0.5) -> Profile:
    """Replace spikes by straight lines: elevations that lie far from the median of those around them.

    Parameters
    ----------
    profile : Profile
        The road, at an even step.
    spike : float
        How far an elevation may lie from the median around it, over 1 m (`window` in Python), before it is
        replaced [m].
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
    require_profile(profile)
    from scipy.ndimage import median_filter

    with checking() as check:
        spike = check.positive("spike", spike, "m")
        window = check.positive("window", window, "m")
        longest = check.positive("longest", longest, "m")
    step = profile.require_even("looking for spikes")
    size = 2 * round(window / step / 2) + 1
    with checking() as check:
        if size < 3:
            least, got = told_apart(3 * step, window)
            check.refuse("window", f"must hold three stations, {least} m, got {got} m")
    stations, elevation = profile.stations, profile.columns.copy()
    replaced, worst, where = 0, 0.0, 0.0
    for column in elevation.T:
        out = np.abs(column - median_filter(column, size, mode="mirror")) > spike
        if not out.any():
            continue
        there = np.flatnonzero(~out)
        gaps = np.diff(there) * step
        if out[0] or out[-1] or gaps.max() > longest * (1 + SLACK):
            at = stations[0] if out[0] else stations[-1] if out[-1] else stations[there[gaps.argmax()]]
            raise ValueError(
                f"spikes make a gap of more than {longest:g} m, or one at an end, near {place(at)} m: they are no "
                "spikes; crop the profile there"
            )
        replaced += int(out.sum())
        if gaps.max() > worst:
            worst, where = float(gaps.max()), float(stations[there[gaps.argmax()] + 1])
        column[out] = np.interp(stations[out], stations[there], column[there])
    found = (
        f"replaced {replaced} spike{'s' * (replaced != 1)} of more than {spike:g} m over the median of {window:g} m"
    )
    found += f": the longest gap {worst:.4g} m at {place(where)} m" if replaced else ""
    return changed(profile, found, elevation=like(profile, elevation))


STEP = Step(repaired, {"spike": "spike"})

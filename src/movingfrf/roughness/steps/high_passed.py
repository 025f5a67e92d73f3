"""Long waves taken out."""

from __future__ import annotations

import numpy as np

from movingfrf._basics.checks import checking
from movingfrf.roughness.profile import Profile
from movingfrf.roughness.steps.base import FILTER, Step, changed, like


def high_passed(profile: Profile, *, wavelength: float) -> Profile:
    """Take out long waves, without shifting the others: a Butterworth filter of second order, forth and back.

    A wave of length λ keeps 1/(1 + (λ/λ_c)⁴) of its amplitude, half of it at λ = λ_c.

    Parameters
    ----------
    profile : Profile
        The road, at an even step.
    wavelength : float
        Wavelength λ_c beyond which waves are taken out; of one as long as it half is left [m].

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
    return changed(profile, done, elevation=like(profile, kept))


STEP = Step(high_passed, {"high_pass": "wavelength"})

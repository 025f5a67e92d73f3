"""Long waves taken out."""

from __future__ import annotations

from movingfrf.roughness.profile import Profile, require_profile
from movingfrf.roughness.steps.base import Step, without_waves


def high_passed(profile: Profile, wavelength: float) -> Profile:
    """Take out long waves, without shifting the others: a Butterworth filter of second order, forth and back.

    A wave of length λ keeps 1/(1 + (λ/λ_c)⁴) of its amplitude, half of it at λ = λ_c. So it is while both are many
    steps h long; exactly, tan(πh/λ_c)/tan(πh/λ) stands for λ/λ_c: below λ_c a little more is left than that, all of
    a wave of two steps, above it less.

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
    >>> import numpy as np
    >>> x = np.arange(0.0, 400.0, 0.1)
    >>> road = Profile(x, np.sin(2 * np.pi * x / 40))
    >>> middle = high_passed(road, wavelength=40.0).elevation[1500:2500]
    >>> round(float(middle.max()), 2)
    0.5
    """
    require_profile(profile)
    return without_waves(profile, "longer", wavelength)


STEP = Step(high_passed, {"high_pass": "wavelength"})

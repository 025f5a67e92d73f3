"""Short waves taken out."""

from __future__ import annotations

from movingfrf.roughness.profile import Profile, require_profile
from movingfrf.roughness.steps.base import Step, without_waves


def low_passed(profile: Profile, wavelength: float) -> Profile:
    """Take out short waves, without shifting the others: a Butterworth filter of second order, forth and back.

    A wave of length λ keeps 1/(1 + (λ_c/λ)⁴) of its amplitude, half of it at λ = λ_c. So it is while both are many
    steps h long; exactly, tan(πh/λ)/tan(πh/λ_c) stands for λ_c/λ: below λ_c less is left than that, nothing of a
    wave of two steps, above it a little more.

    Parameters
    ----------
    profile : Profile
        The road, at an even step.
    wavelength : float
        Wavelength λ_c below which waves are taken out; of one as long as it half is left [m].

    Returns
    -------
    Profile
        What is left. Within a wavelength or so of either end it depends on how the road is taken to go on.

    Raises
    ------
    ValueError
        If stations are uneven, or the wavelength is not at least four steps and at most the length.

    Examples
    --------
    >>> import numpy as np
    >>> x = np.arange(0.0, 40.0, 0.01)
    >>> road = Profile(x, np.sin(2 * np.pi * x / 0.5))
    >>> middle = low_passed(road, wavelength=0.5).elevation[1500:2500]
    >>> round(float(middle.max()), 2)
    0.5
    """
    require_profile(profile)
    return without_waves(profile, "shorter", wavelength)


STEP = Step(low_passed, {"low_pass": "wavelength"})

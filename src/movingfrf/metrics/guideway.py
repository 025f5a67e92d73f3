"""What a guideway answers to a force: receptance, mobility, accelerance, and how they decay along it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from movingfrf._basics.arrays import ComplexArray, FloatArray, NumberArray
from movingfrf._basics.checks import checking, uncovered
from movingfrf._basics.door import mistaken
from movingfrf.guideways.guideway import Guideway, findings_of, require_guideway, told
from movingfrf.guideways.roots import wavenumbers
from movingfrf.guideways.track import Track
from movingfrf.guideways.waves import at_frequencies, in_moving_frame
from movingfrf.results.labels import attributes, labelled

if TYPE_CHECKING:
    import xarray as xr


# Points of a decay-rate measurement in sleeper spacings (EN 15461).
BAYS = np.array(
    [*np.arange(0, 2.75, 0.25), 3, 3.5, 4, 5, 6, 7, 8, 10, 12, 16, 20, 24, 30, 36, 42, 48, 54, 66], float
)

# Decibels of a ratio of amplitudes of e.
NEPER = 20 / np.log(10)

# Form → power of iω on the receptance.
POWERS = {"receptance": 0, "mobility": 1, "accelerance": 2}


def receptance(
    guideway: Guideway, frequency: ArrayLike, *, ahead: ArrayLike = 0.0, speed: float = 0.0
) -> xr.Dataset:
    """Deflection of a guideway per unit force, as a labelled result; see `mobility`.

    Parameters
    ----------
    guideway : Guideway
        The road or track.
    frequency : array_like, shape (frequency,)
        Frequency in the frame that travels along [Hz], not negative.
    ahead : array_like, shape (point,)
        Receiver minus source [m]; zero is the point receptance.
    speed : float
        Common speed of source and receiver [m/s].

    Returns
    -------
    xarray.Dataset
        `receptance` (frequency, ahead) [m/N], complex.

    Raises
    ------
    ValueError
        If an argument is not finite, or a frequency is negative.
    SolveError
        If the response is infinite.
    """
    return _response(guideway, frequency, ahead, speed, "receptance")


def mobility(guideway: Guideway, frequency: ArrayLike, *, ahead: ArrayLike = 0.0, speed: float = 0.0) -> xr.Dataset:
    """Velocity of a guideway per unit force, Y = iω G, as a labelled result.

    Parameters
    ----------
    guideway : Guideway
        The road or track.
    frequency : array_like, shape (frequency,)
        Frequency in the frame that travels along [Hz], not negative.
    ahead : array_like, shape (point,)
        Receiver minus source [m]; zero is the point mobility.
    speed : float
        Common speed of source and receiver [m/s].

    Returns
    -------
    xarray.Dataset
        `mobility` (frequency, ahead) [m/s/N], complex, with coordinates `frequency` [Hz], `omega` [rad/s] and
        `ahead` [m].

    Raises
    ------
    ValueError
        If an argument is not finite, or a frequency is negative.
    SolveError
        If the response is infinite.

    Examples
    --------
    A UIC60 rail on pads of 300 MN/m², as published:

    >>> import movingfrf as mf
    >>> rail = mf.track(mf.EulerBernoulliBeam(bending_stiffness=210e9 * 3038.3e-8, mass=60.2),
    ...                 mf.Spring(stiffness=300e6, damping=30e3))
    >>> point = mf.mobility(rail, [20.0, 356.0])
    >>> abs(point.mobility.values[:, 0])
    array([3.88704301e-07, 2.12205628e-05])
    """
    return _response(guideway, frequency, ahead, speed, "mobility")


def accelerance(
    guideway: Guideway, frequency: ArrayLike, *, ahead: ArrayLike = 0.0, speed: float = 0.0
) -> xr.Dataset:
    """Acceleration of a guideway per unit force, −ω² G, as a labelled result; see `mobility`.

    Parameters
    ----------
    guideway : Guideway
        The road or track.
    frequency : array_like, shape (frequency,)
        Frequency in the frame that travels along [Hz], not negative.
    ahead : array_like, shape (point,)
        Receiver minus source [m]; zero is the point accelerance.
    speed : float
        Common speed of source and receiver [m/s].

    Returns
    -------
    xarray.Dataset
        `accelerance` (frequency, ahead) [m/s²/N], complex.

    Raises
    ------
    ValueError
        If an argument is not finite, or a frequency is negative.
    SolveError
        If the response is infinite.
    """
    return _response(guideway, frequency, ahead, speed, "accelerance")


def decay_rate(response: ArrayLike, distance: ArrayLike) -> FloatArray:
    """Track decay rate from responses measured along a track, 4.343 / Σ |A(x_n)/A(x_0)|² Δx_n.

    Δx_n is what a point stands for: from midpoint to midpoint, at the source half of the first interval, at the far
    end the whole last one. 4.343 is 10/ln 10: of a wave e^(−βx) the rate is 8.686 β.

    Parameters
    ----------
    response : array_like, shape (*s, distance)
        Mobility or accelerance of each point, complex or its magnitude [any unit]; or a band's rms of it.
    distance : array_like, shape (distance,)
        Distance of each point from the source [m], from 0 on, increasing.

    Returns
    -------
    ndarray, shape (*s)
        Decay rate [dB/m].

    Raises
    ------
    ValueError
        If distances do not increase from 0, shapes disagree, or there is no response at the source.

    References
    ----------
    EN 15461:2008+A1:2010, Railway applications - Noise emission - Characterisation of the dynamic properties of
    track sections for pass by noise measurements, formula (1) and Annex A.

    Examples
    --------
    >>> x = np.linspace(0.0, 40.0, 4001)
    >>> round(float(decay_rate(np.exp(-0.5 * x), x)), 2)
    4.34
    """
    with checking() as check:
        at = check.array("distance", distance, "m", (None,))
        size = np.abs(np.asarray(uncovered(response), complex))
        if not check.faults and (at.size < 2 or at[0] != 0 or (np.diff(at) <= 0).any()):
            check.refuse("distance", "must increase from 0 and be two or more [m]")
        if size.shape[-1:] != at.shape:
            check.refuse("response", f"must have {at.size} points in its last axis, got shape {size.shape}")
        elif not np.isfinite(size).all() or not size[..., 0].all():
            check.refuse("response", "must be finite, and not zero at the source")
    steps = np.diff(at)
    stands_for = np.concatenate([[steps[0] / 2], (steps[1:] + steps[:-1]) / 2, steps[-1:]])
    return NEPER / 2 / np.sum((size / size[..., :1]) ** 2 * stands_for, axis=-1)


def track_decay_rate(guideway: Guideway, frequency: ArrayLike, *, spacing: float = 0.6) -> FloatArray:
    """Decay rate of a guideway at rest, from its mobilities at the 29 points of EN 15461.

    Parameters
    ----------
    guideway : Guideway
        The track.
    frequency : array_like, shape (frequency,)
        Frequency [Hz], positive.
    spacing : float
        Sleeper spacing by which the points are laid out [m]; by default what the standard takes without sleepers.

    Returns
    -------
    ndarray, shape (frequency,)
        Decay rate [dB/m]. The points stand for 72 spacings, 43.2 m. Where none answers more than the source, it
        cannot come out below 10/ln 10 over that, 0.10 dB/m, however little the track decays.

    Raises
    ------
    ValueError
        If a frequency or the spacing is not positive, or the guideway does not give way.

    References
    ----------
    EN 15461:2008+A1:2010, 6.7 and formula (1).
    """
    with checking() as check:
        spacing = check.positive("spacing", spacing, "m")
        f = check.array("frequency", frequency, "Hz", (None,))
        if not (f > 0).all():
            check.refuse("frequency", "must be positive [Hz]")
    distance = spacing * BAYS
    return decay_rate(mobility(guideway, f, ahead=distance).mobility.values, distance)


def wave_decay_rate(track: Track, frequency: ArrayLike) -> FloatArray:
    """Decay of the wave of a track at rest that travels farthest, 8.686 min |Im κ|.

    `track_decay_rate` is larger by |A(0)|²/|A_w|², the response at the source over the part that this wave has in
    it: squared responses are summed in units of the one at the source. On a lightly damped Euler–Bernoulli rail
    above its cut-on the response is as e^(−iκx) − i e^(−κx), and the factor tends to |1 − i|² = 2; on a Timoshenko
    rail, whose near field fades at high frequencies, to 1. Below about 0.3 dB/m the far end adds to that: of a
    wave's sum only the share 1 − 10^(−4.32 Δ), Δ its rate in dB/m, lies within the 43.2 m of the points.

    Parameters
    ----------
    track : Track
        The track, made by `track`.
    frequency : array_like, shape (frequency,)
        Frequency [Hz].

    Returns
    -------
    ndarray, shape (frequency,)
        Decay rate [dB/m].

    Raises
    ------
    ValueError
        If it is no track, or a frequency is not finite.

    References
    ----------
    D. Thompson, Railway Noise and Vibration, Elsevier, 2009, chapter 3.
    """
    with checking() as check:
        f = check.array("frequency", frequency, "Hz", (None,))
        if not isinstance(track, Track):
            check.refuse("track", mistaken("track", track))
    omega: ComplexArray = (2 * np.pi * f).astype(complex)
    kappa = wavenumbers(at_frequencies(in_moving_frame(track.stiffness().above, 0.0), 1j * omega))[0]
    return NEPER * np.abs(kappa.imag).min(axis=0)


def _response(guideway: Guideway, frequency: ArrayLike, ahead: ArrayLike, speed: float, form: str) -> xr.Dataset:
    require_guideway(guideway)
    with checking() as check:
        f = check.array("frequency", frequency, "Hz", (None,))
        if (f < 0).any():
            check.refuse("frequency", f"must not be negative, got {f.min():g} Hz")
        at = np.atleast_1d(check.array("ahead", ahead, "m", None))
        if at.ndim > 1:
            check.refuse("ahead", f"must have shape (any), got {at.shape}")
        speed = check.finite("speed", speed, "m/s")
    omega = 2 * np.pi * f
    values: NumberArray = (1j * omega[:, None]) ** POWERS[form] * guideway.moving_frf(at, speed, omega)
    settings = attributes(
        form,
        f"{form.capitalize()} of a guideway",
        form=form,
        speed=speed,
        guideway=told(guideway),
        findings=findings_of(guideway),
    )
    return labelled({"frequency": f, "omega": omega, "ahead": at, form: values}, settings)

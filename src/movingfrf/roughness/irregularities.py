"""Irregularities with a shape: on the road and the rail, and on the wheel as what the rail would have to look like.

Elevation is positive up, and a wheel that has lost a piece meets the rail as if the rail were lower there: what a
flat or a hollow takes away counts as negative. All shapes are geometry; whether the wheel follows them is the
solution's business, which says where contact is lost.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from movingfrf._basics.arrays import FloatArray, require_memory
from movingfrf._basics.checks import checking, shown
from movingfrf._basics.smooth import smooth_step
from movingfrf._basics.wording import told_apart
from movingfrf.roughness.profile import Profile


def harmonic(
    *, amplitude: float, wavelength: float, length: float, phase: float = 0.0, start: float = 0.0
) -> Profile:
    """One sine wave, sampled fifty times per wave.

    Parameters
    ----------
    amplitude : float
        Half of the height from trough to crest [m].
    wavelength : float
        Length of the wave [m].
    length : float
        Length of the profile [m].
    phase : float
        Phase at distance 0 [rad].
    start : float
        First station [m].

    Returns
    -------
    Profile
        Elevation amplitude · sin(2π x/wavelength + phase).

    Raises
    ------
    ValueError
        If amplitude, wavelength or length is not positive.
    """
    with checking() as check:
        amplitude = check.positive("amplitude", amplitude, "m")
        wavelength = check.positive("wavelength", wavelength, "m")
        length = check.positive("length", length, "m")
        phase = check.finite("phase", phase, "rad")
        start = check.finite("start", start, "m")
    distance = _stations(start, length, wavelength / 50)
    return Profile(
        distance,
        amplitude * np.sin(2 * np.pi * distance / wavelength + phase),
        source=f"a sine wave of {amplitude:g} m amplitude and {wavelength:g} m length",
        full_width=True,
    )


def bump(*, height: float, width: float, at: float, length: float, start: float = 0.0) -> Profile:
    """One smooth hump (or dip, if the height is negative) on a flat road.

    Parameters
    ----------
    height : float
        Elevation of its top [m].
    width : float
        Distance over which it rises and falls [m].
    at : float
        Distance at which it begins [m].
    length : float
        Length of the profile [m].
    start : float
        First station [m].

    Returns
    -------
    Profile
        A quintic rise over half of the width and its mirror image.

    Raises
    ------
    ValueError
        If the height is zero, or the width or the length is not positive.
    """
    with checking() as check:
        if (height := check.finite("height", height, "m")) == 0:
            check.refuse("height", "must not be zero")
        width = check.positive("width", width, "m")
        length = check.positive("length", length, "m")
        at = check.finite("at", at, "m")
        start = check.finite("start", start, "m")
    distance = _stations(start, length, width / 100)
    return Profile(
        distance,
        height * smooth_step(2 * (0.5 - np.abs((distance - at) / width - 0.5))),
        source=f"a bump of {height:g} m height and {width:g} m length at {at:g} m",
        full_width=True,
    )


def pothole(*, depth: float, width: float, edge: float, at: float, length: float, start: float = 0.0) -> Profile:
    """One hole with a level floor (or a table, if the depth is negative) in a flat road.

    Parameters
    ----------
    depth : float
        Depth of the floor [m].
    width : float
        Distance from rim to rim [m].
    edge : float
        Distance over which the road falls to the floor, and rises again [m]; at most half of the width. A wheel
        cannot follow edges that are sharper than itself: give its contact a `footprint`.
    at : float
        Distance at which it begins [m].
    length : float
        Length of the profile [m].
    start : float
        First station [m].

    Returns
    -------
    Profile
        A quintic fall, the floor, and a quintic rise.

    Raises
    ------
    ValueError
        If the depth is zero, a length is not positive, or the edges do not fit into the width.

    Examples
    --------
    >>> hole = pothole(depth=0.04, width=0.6, edge=0.1, at=5.0, length=20.0)
    >>> hole.along(0)([5.05, 5.3]).round(6).tolist()
    [-0.02, -0.04]
    """
    with checking() as check:
        if (depth := check.finite("depth", depth, "m")) == 0:
            check.refuse("depth", "must not be zero")
        width = check.positive("width", width, "m")
        if (edge := check.positive("edge", edge, "m")) > width / 2:
            most, got = told_apart(width / 2, edge)
            check.refuse("edge", f"must be at most half of the width, {most} m, got {got} m")
        length = check.positive("length", length, "m")
        at = check.finite("at", at, "m")
        start = check.finite("start", start, "m")
    distance = _stations(start, length, edge / 50)
    to_the_nearer_rim = width / 2 - np.abs(distance - (at + width / 2))
    return Profile(
        distance,
        -depth * smooth_step(to_the_nearer_rim / edge),
        source=f"a pothole of {depth:g} m depth and {width:g} m length at {at:g} m",
        full_width=True,
    )


def faulted_slabs(
    *, height: float, spacing: float, edge: float, length: float, at: float = 0.0, start: float = 0.0
) -> Profile:
    """Concrete slabs that have tilted: at each joint the road drops, and each slab climbs back.

    Parameters
    ----------
    height : float
        Drop at each joint in the direction of travel [m]; negative for a step up.
    spacing : float
        Distance between joints [m].
    edge : float
        Distance over which the road drops [m], centred at the joint; at most half of the spacing. A wheel cannot
        follow edges that are sharper than itself: give its contact a `footprint`.
    length : float
        Length of the profile [m].
    at : float
        Distance of one of the joints [m].
    start : float
        First station [m].

    Returns
    -------
    Profile
        A sawtooth between ± height/2 whose steep flanks are quintic.

    Raises
    ------
    ValueError
        If the height is zero, a length is not positive, or the edge is longer than half of a slab.

    Examples
    --------
    >>> slabs = faulted_slabs(height=0.004, spacing=5.0, edge=0.05, length=20.0)
    >>> slabs.along(0)([0.0, 2.5, 4.9]).round(5).tolist()
    [0.0, 0.0, 0.00192]
    """
    with checking() as check:
        if (height := check.finite("height", height, "m")) == 0:
            check.refuse("height", "must not be zero")
        spacing = check.positive("spacing", spacing, "m")
        if (edge := check.positive("edge", edge, "m")) > spacing / 2:
            most, got = told_apart(spacing / 2, edge)
            check.refuse("edge", f"must be at most half of the spacing, {most} m, got {got} m")
        length = check.positive("length", length, "m")
        at = check.finite("at", at, "m")
        start = check.finite("start", start, "m")
    distance = _stations(start, length, edge / 50)
    from_joint = _from_nearest(distance, at, spacing)
    return Profile(
        distance,
        height * (from_joint / spacing + 0.5 - smooth_step(from_joint / edge + 0.5)),
        source=f"slabs of {spacing:g} m faulted by {height:g} m, joints at {at:g} m",
        full_width=True,
    )


def dipped_joints(
    *,
    depth: float,
    reach: float,
    spacing: float,
    rounding: float,
    length: float,
    at: float = 0.0,
    start: float = 0.0,
) -> Profile:
    """Rail joints: at each the rail ends are bent down, and meet in a dip.

    Each dip is −d (1 − r/b)², r = √(s² + e²) − e, at a distance s from its joint: a parabola on either side, the
    dip angle 4d/b between them, their kink rounded over the length e. A wheel does not round a kink that is open
    upwards: it passes from one rail end to the other in an instant, at any radius. What rounds it is the wear of
    the rail ends and the contact patch, about a centimetre long.

    Parameters
    ----------
    depth : float
        Depth of a dip d [m].
    reach : float
        Distance b from a joint over which a rail end is bent [m].
    spacing : float
        Distance between joints [m], at least twice what a rail end and its rounding take.
    rounding : float
        Length e over which the kink is rounded [m].
    length : float
        Length of the profile [m].
    at : float
        Distance of one of the joints [m].
    start : float
        First station [m].

    Returns
    -------
    Profile
        Level rail with a dip at each joint.

    Raises
    ------
    ValueError
        If the depth is zero, a length is not positive, or neighbouring dips would overlap.

    References
    ----------
    H. H. Jenkins, J. E. Stephenson, G. A. Clayton, G. W. Morland, D. Lyon: The effect of track and
    vehicle parameters on wheel/rail vertical dynamic forces. Railway Engineering Journal 3 (1974) 2–16, for the dip
    angle as the measure of a joint.

    Examples
    --------
    >>> rail = dipped_joints(depth=0.004, reach=1.0, spacing=18.0, rounding=0.01, length=36.0)
    >>> rail.along(0)([18.0, 18.5, 20.0]).round(5).tolist()
    [-0.004, -0.00104, 0.0]
    """
    with checking() as check:
        if (depth := check.finite("depth", depth, "m")) == 0:
            check.refuse("depth", "must not be zero")
        reach = check.positive("reach", reach, "m")
        rounding = check.positive("rounding", rounding, "m")
        if (spacing := check.positive("spacing", spacing, "m")) < 2 * (reach + rounding) and not check.faults:
            least, got = told_apart(2 * (reach + rounding), spacing)
            check.refuse("spacing", f"must be at least {least} m, two rail ends, got {got} m")
        length = check.positive("length", length, "m")
        at = check.finite("at", at, "m")
        start = check.finite("start", start, "m")
    distance = _stations(start, length, rounding / 10)
    away = np.hypot(_from_nearest(distance, at, spacing), rounding) - rounding
    return Profile(
        distance,
        -depth * np.maximum(1 - away / reach, 0.0) ** 2,
        source=f"rail joints every {spacing:g} m, dipped by {depth:g} m, one at {at:g} m",
        full_width=True,
    )


def dipped_weld(
    *,
    depth: float,
    width: float,
    at: float,
    length: float,
    short_depth: float = 0.0,
    short_width: float = 0.1,
    start: float = 0.0,
) -> Profile:
    """One rail weld: a long cosine dip with a short one in its middle.

    −(d₁/2)(1 + cos 2πs/λ₁) − (d₂/2)(1 + cos 2πs/λ₂) at a distance s from the weld, each within half of its wave.

    Parameters
    ----------
    depth : float
        Depth d₁ of the long dip [m]; negative for a raised weld.
    width : float
        Its wavelength λ₁ [m], about 1.
    at : float
        Distance of the weld [m].
    length : float
        Length of the profile [m].
    short_depth : float
        Depth d₂ of the short dip in its middle [m]; negative for a ridge.
    short_width : float
        Its wavelength λ₂ [m], about 0.1.
    start : float
        First station [m].

    Returns
    -------
    Profile
        Level rail with the weld.

    Raises
    ------
    ValueError
        If the depth is zero, or a length is not positive.

    References
    ----------
    W. Zhai, K. Wang, C. Cai: Fundamentals of vehicle–track coupled dynamics. Vehicle System Dynamics 47 (2009)
    1349–1376, for welds as superposed cosines.

    Examples
    --------
    >>> rail = dipped_weld(depth=3e-4, width=1.0, short_depth=1e-4, short_width=0.1, at=5.0, length=10.0)
    >>> rail.along(0)([4.75, 5.0]).round(6).tolist()
    [-0.00015, -0.0004]
    """
    with checking() as check:
        if (depth := check.finite("depth", depth, "m")) == 0:
            check.refuse("depth", "must not be zero")
        width = check.positive("width", width, "m")
        short_depth = check.finite("short_depth", short_depth, "m")
        short_width = check.positive("short_width", short_width, "m")
        length = check.positive("length", length, "m")
        at = check.finite("at", at, "m")
        start = check.finite("start", start, "m")
    distance = _stations(start, length, min(width, short_width if short_depth else width) / 100)
    dips = [
        d * np.cos(np.pi * np.clip((distance - at) / wave, -0.5, 0.5)) ** 2
        for d, wave in ((depth, width), (short_depth, short_width))
    ]
    return Profile(
        distance,
        -np.sum(dips, axis=0),
        source=f"a weld dipped by {depth:g} m over {width:g} m at {at:g} m",
        full_width=True,
    )


def wheel_flat(
    *,
    radius: float,
    chord: float,
    length: float,
    depth: float | None = None,
    at: float = 0.0,
    start: float = 0.0,
) -> Profile:
    """Flat on a wheel, once per revolution, as the rail that would move a round wheel in the same way.

    A fresh flat is a chord c of the wheel: its centre sinks while it turns about the first corner and rises about
    the second, −s²/(2R) at a distance s < c/2 from the nearer corner, down to c²/(8R), where its speed jumps by v
    c/R. A flat that has worn round is a cosine dip of stated depth; its customary depth is c²/(16R). Both hold as
    long as the wheel follows, that is at low speed; the solution says where contact is lost.

    Parameters
    ----------
    radius : float
        Radius R of the wheel [m].
    chord : float
        Length c of the flat [m].
    length : float
        Length of the profile [m].
    depth : float, optional
        Depth of a flat that has worn round [m]. None: a fresh one, with corners.
    at : float
        Distance of one middle of the flat on the rail [m].
    start : float
        First station [m].

    Returns
    -------
    Profile
        Zero where the wheel is round, negative over the flat, with the period 2πR, in steps of c/100.

    Raises
    ------
    ValueError
        If a length or the depth is not positive, or the chord is longer than the wheel's radius.

    References
    ----------
    S. G. Newton, R. A. Clark: An investigation into the dynamic effects on the track of wheelflats on
    railway vehicles. Journal of Mechanical Engineering Science 21 (1979) 287–297. T. X. Wu, D. J. Thompson: A
    hybrid model for the noise generation due to railway wheel flats. Journal of Sound and Vibration 251 (2002)
    115–139.

    Examples
    --------
    >>> flat = wheel_flat(radius=0.46, chord=0.06, length=10.0, at=1.0)
    >>> round(float(flat.along(0)(1.0)), 5)  # c²/(8R) = 0.978 mm, less what the spline rounds off
    -0.00097
    """
    with checking() as check:
        radius = check.positive("radius", radius, "m")
        if (chord := check.positive("chord", chord, "m")) > radius and not check.faults:
            most, got = told_apart(radius, chord)
            check.refuse("chord", f"must be at most the radius, {most} m, got {got} m")
        if depth is not None:
            depth = check.positive("depth", depth, "m")
        length = check.positive("length", length, "m")
        at = check.finite("at", at, "m")
        start = check.finite("start", start, "m")
    distance = _stations(start, length, chord / 100)
    from_middle = np.abs(_from_nearest(distance, at, 2 * np.pi * radius))
    if depth is None:
        elevation = -(np.maximum(chord / 2 - from_middle, 0.0) ** 2) / (2 * radius)
    else:
        elevation = -depth * np.cos(np.pi * np.minimum(from_middle / chord, 0.5)) ** 2
    kind = "fresh" if depth is None else f"round, {depth:g} m deep"
    return Profile(
        distance,
        elevation,
        source=f"a wheel of {radius:g} m radius with a flat of {chord:g} m ({kind}) at {at:g} m",
        full_width=True,
    )


def polygon(
    *,
    radius: float,
    orders: ArrayLike,
    amplitudes: ArrayLike,
    length: float,
    phases: ArrayLike | None = None,
    seed: int = 0,
    start: float = 0.0,
) -> Profile:
    """Wheel that is out of round, as the rail that would move a round wheel in the same way.

    Parameters
    ----------
    radius : float
        Radius of the wheel [m].
    orders : array_like of int, shape (order,)
        Number of waves per revolution: 1 for a wheel off centre, 2 for an oval one.
    amplitudes : array_like, shape (order,)
        Deviation of the radius in each order [m].
    length : float
        Length of the profile [m].
    phases : array_like, shape (order,), optional
        Phase of each order at distance 0 [rad]. None: random ones.
    seed : int
        Seed of the random phases.
    start : float
        First station [m].

    Returns
    -------
    Profile
        Σ a_k sin(k x/R + φ_k), up where the radius is larger.

    Raises
    ------
    ValueError
        If the radius or the length is not positive, an order is not a whole number above zero, or there is not one
        amplitude, and one phase, for each order.

    Examples
    --------
    >>> oval = polygon(radius=0.46, orders=[2], amplitudes=[1e-4], phases=[0.0], length=10.0)
    >>> round(float(oval.along(0)(0.46 * np.pi / 4)), 8)
    0.0001
    """
    with checking() as check:
        radius = check.positive("radius", radius, "m")
        waves = check.array("orders", orders, "1", (None,))
        if not waves.size or not ((waves >= 1) & (waves % 1 == 0)).all():
            check.refuse("orders", f"must be one or more whole numbers of at least 1, got {shown(orders)}")
        sizes = check.array("amplitudes", amplitudes, "m", waves.shape)
        seed = check.whole("seed", seed)
        angles = None if phases is None else check.array("phases", phases, "rad", waves.shape)
        length = check.positive("length", length, "m")
        start = check.finite("start", start, "m")
    if angles is None:
        angles = np.random.default_rng(seed).uniform(0.0, 2 * np.pi, waves.size)
    distance = _stations(start, length, 2 * np.pi * radius / (50 * waves.max()))
    elevation = np.zeros_like(distance)
    for k, a, angle in zip(waves, sizes, angles, strict=True):
        elevation += a * np.sin(k * distance / radius + angle)
    return Profile(
        distance,
        elevation,
        source=f"a wheel of {radius:g} m radius out of round in the orders {', '.join(f'{k:g}' for k in waves)}",
        full_width=True,
    )


def _stations(start: float, length: float, step: float) -> FloatArray:
    count = max(int(np.ceil(length / step - 1e-9)) + 1, 4)
    needed = 64 * count  # bytes that making a shape takes at its peak
    require_memory(needed, f"a profile of {length:g} m in steps of {step:g} m")
    return start + step * np.arange(count)


def _from_nearest(distance: FloatArray, at: float, spacing: float) -> FloatArray:
    """Distance from the nearest of evenly spaced places, one of which is `at`."""
    return (distance - at + spacing / 2) % spacing - spacing / 2

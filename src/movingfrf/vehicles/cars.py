"""Road vehicles: functions that fill a `Vehicle`."""

from __future__ import annotations

from movingfrf._basics.checks import Checks, checking
from movingfrf.vehicles.assembly import Body, Suspension, assemble
from movingfrf.vehicles.contact import Contact
from movingfrf.vehicles.vehicle import Vehicle


def quarter_car(
    *,
    body_mass: float,
    wheel_mass: float,
    suspension_stiffness: float,
    suspension_damping: float,
    tyre_stiffness: float,
    tyre_damping: float = 0.0,
    footprint: float = 0.0,
) -> Vehicle:
    """One wheel and its share of the body: degrees of freedom `body`, `wheel`.

    Parameters
    ----------
    body_mass : float
        Sprung mass, the wheel's share of the body [kg].
    wheel_mass : float
        Unsprung mass: wheel, hub and what moves along [kg].
    suspension_stiffness : float
        Stiffness of the suspension [N/m].
    suspension_damping : float
        Damping of the suspension [N s/m].
    tyre_stiffness : float or inf
        Stiffness of the tyre [N/m]; `inf` for a wheel that follows the road rigidly.
    tyre_damping : float
        Damping of the tyre [N s/m].
    footprint : float
        Length of the tyre's contact patch [m].

    Returns
    -------
    Vehicle
        With its contact at position 0.

    Raises
    ------
    ValueError
        If a mass or stiffness is not positive or a damping is negative.

    Examples
    --------
    >>> car = quarter_car(body_mass=400.0, wheel_mass=40.0, suspension_stiffness=2e4,
    ...                   suspension_damping=1.5e3, tyre_stiffness=2e5)
    >>> car.natural_frequencies.round(2).tolist()
    [1.08, 11.68]
    """
    with checking() as check:
        body_mass = check.positive("body_mass", body_mass, "kg")
        wheel_mass = check.positive("wheel_mass", wheel_mass, "kg")
        suspension_stiffness = check.positive("suspension_stiffness", suspension_stiffness, "N/m")
        suspension_damping = check.not_negative("suspension_damping", suspension_damping, "N s/m")
        tyre_stiffness = check.positive_or_infinite("tyre_stiffness", tyre_stiffness, "N/m")
        tyre_damping = check.not_negative("tyre_damping", tyre_damping, "N s/m")
        footprint = check.not_negative("footprint", footprint, "m")
    return assemble(
        bodies=[Body(mass=body_mass, name="body"), Body(mass=wheel_mass, name="wheel")],
        suspensions=[
            Suspension(upper="body", lower="wheel", stiffness=suspension_stiffness, damping=suspension_damping)
        ],
        contacts=[
            Contact(position=0.0, stiffness=tyre_stiffness, damping=tyre_damping, footprint=footprint, name="wheel")
        ],
        under=["wheel"],
    )


def half_car(
    *,
    body_mass: float,
    pitch_inertia: float,
    wheel_masses: tuple[float, float],
    suspension_stiffness: tuple[float, float],
    suspension_damping: tuple[float, float],
    tyre_stiffness: tuple[float, float],
    tyre_damping: tuple[float, float] = (0.0, 0.0),
    axles: tuple[float, float],
    footprint: float = 0.0,
) -> Vehicle:
    """Two axles in one vertical plane: degrees of freedom `bounce`, `pitch`, `front_wheel`, `rear_wheel`.

    Pairs are (front, rear). Bounce is that of the centre of mass, positive down; pitch is positive nose down.

    Parameters
    ----------
    body_mass : float
        Sprung mass [kg].
    pitch_inertia : float
        Moment of inertia of the sprung mass about its centre of mass [kg m²].
    wheel_masses : tuple of float
        Unsprung mass per axle [kg].
    suspension_stiffness : tuple of float
        Stiffness of the suspension per axle [N/m].
    suspension_damping : tuple of float
        Damping of the suspension per axle [N s/m].
    tyre_stiffness : tuple of float or inf
        Stiffness of the tyres per axle [N/m]; `inf` for wheels that follow the road rigidly.
    tyre_damping : tuple of float
        Damping of the tyres per axle [N s/m].
    axles : tuple of float
        Positions ahead of the centre of mass [m]: (+a, −b).
    footprint : float
        Length of a tyre's contact patch [m].

    Returns
    -------
    Vehicle
        With its contacts at `axles`.

    Raises
    ------
    ValueError
        If a mass or stiffness is not positive, a damping is negative, or the front axle is not ahead of the
        rear one.
    """
    with checking() as check:
        body_mass = check.positive("body_mass", body_mass, "kg")
        pitch_inertia = check.positive("pitch_inertia", pitch_inertia, "kg m²")
        wheels = check.pair("wheel_masses", wheel_masses, "kg")
        (kf, kr) = check.pair("suspension_stiffness", suspension_stiffness, "N/m")
        (cf, cr) = check.pair("suspension_damping", suspension_damping, "N s/m", positive=False)
        tyres = check.pair("tyre_stiffness", tyre_stiffness, "N/m", infinite=True)
        tyre_dampers = check.pair("tyre_damping", tyre_damping, "N s/m", positive=False)
        footprint = check.not_negative("footprint", footprint, "m")
        front, rear = _in_order(check, "axles", axles, "have the front axle ahead of the rear one")

    names = ["front_wheel", "rear_wheel"]
    corners = list(zip(names, (front, rear), wheels, (kf, kr), (cf, cr), tyres, tyre_dampers, strict=True))
    return assemble(
        bodies=[
            Body(mass=body_mass, pitch_inertia=pitch_inertia),
            *(Body(mass=mass, position=at, name=name) for name, at, mass, *_ in corners),
        ],
        suspensions=[
            Suspension(upper="", lower=name, stiffness=k, damping=c, position=at)
            for name, at, _, k, c, *_ in corners
        ],
        contacts=[
            Contact(position=at, stiffness=k, damping=c, footprint=footprint, name=name.removesuffix("_wheel"))
            for name, at, *_, k, c in corners
        ],
        under=names,
    )


def full_car(
    *,
    body_mass: float,
    pitch_inertia: float,
    roll_inertia: float,
    wheel_masses: tuple[float, float],
    suspension_stiffness: tuple[float, float],
    suspension_damping: tuple[float, float],
    tyre_stiffness: tuple[float, float],
    tyre_damping: tuple[float, float] = (0.0, 0.0),
    axles: tuple[float, float],
    sides: tuple[float, float],
    footprint: float = 0.0,
) -> Vehicle:
    """Four wheels under one body, seven degrees of freedom.

    `bounce`, `pitch`, `roll` of the body, then `front_left_wheel`, `front_right_wheel`, `rear_left_wheel` and
    `rear_right_wheel`. Pairs are (front, rear), each value that of one wheel. Bounce is that of the centre of mass,
    positive down; pitch is positive nose down, roll positive left side down. Left wheels follow the profile's
    path 0, right wheels its path 1.

    Parameters
    ----------
    body_mass : float
        Sprung mass [kg].
    pitch_inertia : float
        Moment of inertia of the sprung mass in pitch, about its centre of mass [kg m²].
    roll_inertia : float
        Moment of inertia of the sprung mass in roll, about its centre of mass [kg m²].
    wheel_masses : tuple of float
        Unsprung mass at one wheel [kg].
    suspension_stiffness : tuple of float
        Stiffness of the suspension at one wheel [N/m].
    suspension_damping : tuple of float
        Damping of the suspension at one wheel [N s/m].
    tyre_stiffness : tuple of float or inf
        Stiffness of the tyre at one wheel [N/m]; `inf` for wheels that follow the road rigidly.
    tyre_damping : tuple of float
        Damping of the tyre at one wheel [N s/m].
    axles : tuple of float
        Positions ahead of the centre of mass [m]: (+a, −b).
    sides : tuple of float
        Positions of left and right wheels, left of the centre of mass [m]: (+left, −right).
    footprint : float
        Length of a tyre's contact patch [m].

    Returns
    -------
    Vehicle
        With its contacts at `axles` and `sides`.

    Raises
    ------
    ValueError
        If a mass or stiffness is not positive, a damping is negative, or axles or sides are out of order.

    Examples
    --------
    >>> car = full_car(body_mass=840.0, pitch_inertia=1100.0, roll_inertia=820.0, wheel_masses=(53.0, 76.0),
    ...                suspension_stiffness=(1.0e4, 1.3e4), suspension_damping=(900.0, 900.0),
    ...                tyre_stiffness=(2.0e5, 2.0e5), axles=(1.4, -1.47), sides=(0.7, -0.75))
    >>> car.natural_frequencies.round(2).tolist()[:3]
    [0.84, 1.13, 1.48]
    """
    with checking() as check:
        body_mass = check.positive("body_mass", body_mass, "kg")
        pitch_inertia = check.positive("pitch_inertia", pitch_inertia, "kg m²")
        roll_inertia = check.positive("roll_inertia", roll_inertia, "kg m²")
        wheels = check.pair("wheel_masses", wheel_masses, "kg")
        springs = check.pair("suspension_stiffness", suspension_stiffness, "N/m")
        dampers = check.pair("suspension_damping", suspension_damping, "N s/m", positive=False)
        tyres = check.pair("tyre_stiffness", tyre_stiffness, "N/m", infinite=True)
        tyre_dampers = check.pair("tyre_damping", tyre_damping, "N s/m", positive=False)
        along = _in_order(check, "axles", axles, "have the front axle ahead of the rear one")
        aside = _in_order(check, "sides", sides, "have the left wheels left of the right ones")
        footprint = check.not_negative("footprint", footprint, "m")
    corners = {
        f"{end}_{hand}": (axle, side)
        for axle, end in enumerate(("front", "rear"))
        for side, hand in enumerate(("left", "right"))
    }
    return assemble(
        bodies=[
            Body(mass=body_mass, pitch_inertia=pitch_inertia, roll_inertia=roll_inertia),
            *(
                Body(mass=wheels[axle], position=along[axle], across=aside[side], name=f"{name}_wheel")
                for name, (axle, side) in corners.items()
            ),
        ],
        suspensions=[
            Suspension(
                upper="",
                lower=f"{name}_wheel",
                stiffness=springs[axle],
                damping=dampers[axle],
                position=along[axle],
                across=aside[side],
            )
            for name, (axle, side) in corners.items()
        ],
        contacts=[
            Contact(
                position=along[axle],
                stiffness=tyres[axle],
                damping=tyre_dampers[axle],
                path=side,
                across=aside[side],
                footprint=footprint,
                name=name.replace("_", " "),
            )
            for name, (axle, side) in corners.items()
        ],
        under=[f"{name}_wheel" for name in corners],
    )


def _in_order(check: Checks, name: str, given: tuple[float, float], condition: str) -> tuple[float, float]:
    """Two positions [m], the first of which is the larger one."""
    try:
        first, second = (check.finite(f"{name}[{n}]", x, "m") for n, x in enumerate(given))
    except (TypeError, ValueError):
        check.refuse(name, f"must be two numbers, positive ahead or to the left [m], got {given!r}")
        return 1.0, -1.0
    if first <= second:
        check.refuse(name, f"must {condition}, got {given!r} m")
    return first, second

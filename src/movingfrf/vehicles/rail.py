"""Rail vehicles in one vertical plane: both rails, and the wheels of an axle, count as one."""

from __future__ import annotations

import numpy as np

from movingfrf._basics.checks import Checks, checking
from movingfrf._basics.wording import told_apart
from movingfrf.vehicles.assembly import Body, Suspension, assemble
from movingfrf.vehicles.contact import Contact
from movingfrf.vehicles.vehicle import Vehicle


def hertzian_stiffness(load: float, *, wheel_radius: float, worn: bool = True) -> float:
    """Stiffness of the contact between a wheel and a rail, linear about its static load.

    The approach of the two bodies is δ = G P^(2/3) (Hertz), so that k = dP/dδ = 3/(2G) P^(1/3).

    Parameters
    ----------
    load : float
        Static load of one wheel [N].
    wheel_radius : float
        Radius of the rolling circle [m].
    worn : bool
        Whether the tread is worn, G = 3.86 R^−0.115 · 1e-8 m/N^(2/3), or conical, 4.57 R^−0.149 · 1e-8.

    Returns
    -------
    float
        Stiffness of one wheel [N/m]; an axle has two, and in one vertical plane both count together.

    Raises
    ------
    ValueError
        If load or radius is not positive.

    References
    ----------
    W. M. Zhai, K. Y. Wang and C. B. Cai, Fundamentals of vehicle-track coupled dynamics, Vehicle System Dynamics 47
    (2009) 1349.

    Examples
    --------
    >>> round(hertzian_stiffness(70e3, wheel_radius=0.46) / 1e9, 2)
    1.46
    """
    with checking() as check:
        load = check.positive("load", load, "N")
        wheel_radius = check.positive("wheel_radius", wheel_radius, "m")
    constant = 3.86e-8 * wheel_radius**-0.115 if worn else 4.57e-8 * wheel_radius**-0.149
    return 1.5 / constant * load ** (1 / 3)


def wheelset(mass: float, *, contact_stiffness: float = np.inf, contact_damping: float = 0.0) -> Vehicle:
    """One wheelset on its own, the moving mass of the literature: degree of freedom `wheelset`.

    Parameters
    ----------
    mass : float
        Mass, with what of the vehicle moves along [kg].
    contact_stiffness : float or inf
        Stiffness of the contact [N/m]; `inf`: the wheelset follows the rail.
    contact_damping : float
        Damping of the contact [N s/m].

    Returns
    -------
    Vehicle
        With its contact at position 0.

    Raises
    ------
    ValueError
        If the mass or the stiffness is not positive, or a damping is negative.

    Examples
    --------
    >>> wheelset(mass=1800.0).static_loads.tolist()
    [17658.0]
    """
    with checking() as check:
        mass = check.positive("mass", mass, "kg")
        contact_stiffness, contact_damping = _contact_values(check, contact_stiffness, contact_damping)
    return assemble(
        bodies=[Body(mass=mass, name="wheelset")],
        contacts=[_contact(0.0, contact_stiffness, contact_damping, 1)],
        under=["wheelset"],
    )


def bogie(
    *,
    frame_mass: float,
    frame_pitch_inertia: float,
    wheelset_mass: float,
    primary_stiffness: float,
    primary_damping: float,
    axle_spacing: float,
    body_mass: float = 0.0,
    secondary_stiffness: float = 0.0,
    secondary_damping: float = 0.0,
    contact_stiffness: float = np.inf,
    contact_damping: float = 0.0,
) -> Vehicle:
    """One bogie, with or without the share of the body that it carries.

    Degrees of freedom: `body` (if it has a mass), `bogie_bounce`, `bogie_pitch`, `wheelset_1`, `wheelset_2`; the
    first wheelset is the leading one.

    Parameters
    ----------
    frame_mass : float
        Mass of the bogie frame [kg].
    frame_pitch_inertia : float
        Moment of inertia of the frame about its centre [kg m²].
    wheelset_mass : float
        Mass of one wheelset [kg].
    primary_stiffness : float
        Stiffness between one wheelset and the frame, both sides together [N/m].
    primary_damping : float
        Damping between one wheelset and the frame, both sides together [N s/m].
    axle_spacing : float
        Distance between the wheelsets [m].
    body_mass : float
        Mass of the body above this bogie [kg]; 0: none.
    secondary_stiffness : float
        Stiffness between frame and body, both sides together [N/m].
    secondary_damping : float
        Damping between frame and body, both sides together [N s/m].
    contact_stiffness : float or inf
        Of one wheelset's contacts, both rails together [N/m]; `inf`: the wheels follow the rails.
    contact_damping : float
        Of one wheelset's contacts, both rails together [N s/m]; nothing where they are rigid.

    Returns
    -------
    Vehicle
        With contacts at ± half of `axle_spacing`.

    Raises
    ------
    ValueError
        If a mass, stiffness or distance is not positive, or a damping is negative.
    """
    with checking() as check:
        frame_mass = check.positive("frame_mass", frame_mass, "kg")
        frame_pitch_inertia = check.positive("frame_pitch_inertia", frame_pitch_inertia, "kg m²")
        wheelset_mass = check.positive("wheelset_mass", wheelset_mass, "kg")
        primary_stiffness = check.positive("primary_stiffness", primary_stiffness, "N/m")
        primary_damping = check.not_negative("primary_damping", primary_damping, "N s/m")
        half = 0.5 * check.positive("axle_spacing", axle_spacing, "m")
        if body_mass := check.not_negative("body_mass", body_mass, "kg"):
            secondary_stiffness = check.positive("secondary_stiffness", secondary_stiffness, "N/m")
            secondary_damping = check.not_negative("secondary_damping", secondary_damping, "N s/m")
        elif secondary_stiffness or secondary_damping:
            check.refuse("body_mass", "must be positive above a secondary suspension [kg]")
        contact_stiffness, contact_damping = _contact_values(check, contact_stiffness, contact_damping)
    places = {"wheelset_1": half, "wheelset_2": -half}
    carried = [Body(mass=body_mass, name="body")] if body_mass else []
    above = (
        [Suspension(upper="body", lower="bogie", stiffness=secondary_stiffness, damping=secondary_damping)]
        if body_mass
        else []
    )
    return assemble(
        bodies=[
            *carried,
            Body(mass=frame_mass, pitch_inertia=frame_pitch_inertia, name="bogie"),
            *(Body(mass=wheelset_mass, position=at, name=name) for name, at in places.items()),
        ],
        suspensions=[
            *above,
            *(
                Suspension(
                    upper="bogie", lower=name, stiffness=primary_stiffness, damping=primary_damping, position=at
                )
                for name, at in places.items()
            ),
        ],
        contacts=[
            _contact(at, contact_stiffness, contact_damping, n) for n, at in enumerate(places.values(), start=1)
        ],
        under=list(places),
    )


def carriage(
    *,
    body_mass: float,
    body_pitch_inertia: float,
    bogie_mass: float,
    bogie_pitch_inertia: float,
    wheelset_mass: float,
    primary_stiffness: float,
    primary_damping: float,
    secondary_stiffness: float,
    secondary_damping: float,
    bogie_spacing: float,
    axle_spacing: float,
    contact_stiffness: float = np.inf,
    contact_damping: float = 0.0,
) -> Vehicle:
    """One carriage on two bogies and four wheelsets, ten degrees of freedom.

    `body_bounce`, `body_pitch`, `bogie_1_bounce`, `bogie_1_pitch`, `bogie_2_bounce`, `bogie_2_pitch`, `wheelset_1`
    to `wheelset_4`, from the front. Suspension values are those of both sides together.

    Parameters
    ----------
    body_mass : float
        Mass of the body, without bogies [kg].
    bogie_mass : float
        Mass of one bogie's frame, without wheelsets [kg].
    wheelset_mass : float
        Mass of one wheelset [kg].
    body_pitch_inertia : float
        Moment of inertia of the body about its centre of mass [kg m²].
    bogie_pitch_inertia : float
        Moment of inertia of one bogie's frame about its centre of mass [kg m²].
    primary_stiffness : float
        Stiffness between one wheelset and its bogie [N/m].
    primary_damping : float
        Damping between one wheelset and its bogie [N s/m].
    secondary_stiffness : float
        Stiffness between one bogie and the body [N/m].
    secondary_damping : float
        Damping between one bogie and the body [N s/m].
    bogie_spacing : float
        Distance between the centres of the bogies [m].
    axle_spacing : float
        Distance between the wheelsets of a bogie [m].
    contact_stiffness : float or inf
        Of one wheelset's contacts, both rails together [N/m]; `inf`: the wheels follow the rails.
    contact_damping : float
        Of one wheelset's contacts, both rails together [N s/m]; nothing where they are rigid.

    Returns
    -------
    Vehicle
        With its centre at position 0.

    Raises
    ------
    ValueError
        If a mass, stiffness or distance is not positive, a damping is negative, or the bogies overlap.

    Examples
    --------
    >>> coach = carriage(body_mass=32e3, body_pitch_inertia=1.97e6, bogie_mass=2615.0, bogie_pitch_inertia=1476.0,
    ...                  wheelset_mass=1813.0, primary_stiffness=2.4e6, primary_damping=8e3,
    ...                  secondary_stiffness=8.6e5, secondary_damping=4e4, bogie_spacing=19.0, axle_spacing=2.56)
    >>> coach.positions.round(2).tolist()
    [10.78, 8.22, -8.22, -10.78]
    """
    with checking() as check:
        body_mass = check.positive("body_mass", body_mass, "kg")
        body_pitch_inertia = check.positive("body_pitch_inertia", body_pitch_inertia, "kg m²")
        bogie_mass = check.positive("bogie_mass", bogie_mass, "kg")
        bogie_pitch_inertia = check.positive("bogie_pitch_inertia", bogie_pitch_inertia, "kg m²")
        wheelset_mass = check.positive("wheelset_mass", wheelset_mass, "kg")
        primary_stiffness = check.positive("primary_stiffness", primary_stiffness, "N/m")
        primary_damping = check.not_negative("primary_damping", primary_damping, "N s/m")
        secondary_stiffness = check.positive("secondary_stiffness", secondary_stiffness, "N/m")
        secondary_damping = check.not_negative("secondary_damping", secondary_damping, "N s/m")
        contact_stiffness, contact_damping = _contact_values(check, contact_stiffness, contact_damping)
        apart = check.positive("bogie_spacing", bogie_spacing, "m")
        wheels = check.positive("axle_spacing", axle_spacing, "m")
        if not check.faults and wheels >= apart:
            most, got = told_apart(apart, wheels)
            check.refuse("axle_spacing", f"must be less than the bogie spacing {most} m, got {got} m")
    centres = {"bogie_1": 0.5 * apart, "bogie_2": -0.5 * apart}
    bogies = [name for name in centres for _ in range(2)]
    places = [centre + half for centre in centres.values() for half in (0.5 * wheels, -0.5 * wheels)]
    names = [f"wheelset_{n}" for n in range(1, 5)]
    return assemble(
        bodies=[
            Body(mass=body_mass, pitch_inertia=body_pitch_inertia, name="body"),
            *(
                Body(mass=bogie_mass, pitch_inertia=bogie_pitch_inertia, position=at, name=name)
                for name, at in centres.items()
            ),
            *(Body(mass=wheelset_mass, position=at, name=name) for name, at in zip(names, places, strict=True)),
        ],
        suspensions=[
            *(
                Suspension(
                    upper="body", lower=name, stiffness=secondary_stiffness, damping=secondary_damping, position=at
                )
                for name, at in centres.items()
            ),
            *(
                Suspension(
                    upper=frame, lower=name, stiffness=primary_stiffness, damping=primary_damping, position=at
                )
                for frame, name, at in zip(bogies, names, places, strict=True)
            ),
        ],
        contacts=[_contact(at, contact_stiffness, contact_damping, n) for n, at in enumerate(places, start=1)],
        under=names,
    )


def _contact_values(check: Checks, stiffness: float, damping: float) -> tuple[float, float]:
    stiffness = check.positive_or_infinite("contact_stiffness", stiffness, "N/m")
    damping = check.not_negative("contact_damping", damping, "N s/m")
    if damping and stiffness == np.inf:
        check.refuse("contact_damping", f"must be 0 at a rigid contact, got {damping!r} N s/m")
    return stiffness, damping


def _contact(position: float, stiffness: float, damping: float, number: int) -> Contact:
    return Contact(position=position, stiffness=stiffness, damping=damping, name=f"wheelset {number}")

"""Trucks: rigid ones with any number of axles, tractors with semitrailers, longer combinations."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from movingfrf._basics.checks import Checks, checking
from movingfrf.vehicles.assembly import Body, Hinge, Suspension, assemble
from movingfrf.vehicles.contact import Contact
from movingfrf.vehicles.vehicle import Vehicle


class _RunningGear:
    """What stands under a unit."""

    __slots__ = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Axle(_RunningGear):
    """One axle under a truck; every value is that of the whole axle, both sides together.

    Parameters
    ----------
    position : float
        Place ahead of the vehicle's reference point [m].
    mass : float
        Unsprung mass [kg].
    suspension_stiffness : float
        Stiffness [N/m].
    tyre_stiffness : float or inf
        Stiffness [N/m]; `inf` for tyres that follow the road rigidly.
    suspension_damping : float
        Damping of the suspension [N s/m].
    tyre_damping : float
        Damping of the tyres [N s/m].
    footprint : float
        Length of the tyres' contact patch [m].

    Raises
    ------
    ValueError
        If a mass or stiffness is not positive or a damping is negative.
    """

    position: float
    mass: float
    suspension_stiffness: float
    suspension_damping: float
    tyre_stiffness: float
    tyre_damping: float = 0.0
    footprint: float = 0.0

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking(self) as check:
            check.finite("position", self.position, "m")
            _check_axle(check, self)

    @property
    def positions(self) -> tuple[float, ...]:
        """Where its wheels stand [m]."""
        return (self.position,)

    @property
    def inertia(self) -> float | None:
        """It does not pitch."""
        return None


@dataclass(frozen=True, slots=True, kw_only=True)
class WalkingBeam(_RunningGear):
    """Two axles at the ends of a beam that pivots about its middle, where it carries the truck on a spring.

    The axles share their load equally, whatever the road. Every value is that of both sides together.

    Parameters
    ----------
    positions : tuple of float
        Places of the two axles ahead of the vehicle's reference point [m], the front one first.
    mass : float
        Mass of beam and axles [kg].
    pitch_inertia : float
        Moment of inertia of beam and axles about the pivot [kg m²].
    suspension_stiffness : float
        Stiffness at the pivot [N/m].
    suspension_damping : float
        Damping at the pivot [N s/m].
    tyre_stiffness : float or inf
        Stiffness of the tyres of one axle [N/m]; `inf` for tyres that follow the road rigidly.
    tyre_damping : float
        Damping of the tyres of one axle [N s/m].
    footprint : float
        Length of the tyres' contact patch [m].

    Raises
    ------
    ValueError
        If a mass or stiffness is not positive, a damping is negative, or the axles are out of order.
    """

    positions: tuple[float, float]
    mass: float
    pitch_inertia: float
    suspension_stiffness: float
    suspension_damping: float
    tyre_stiffness: float
    tyre_damping: float = 0.0
    footprint: float = 0.0

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking(self) as check:
            front, rear = check.pair("positions", self.positions, "m", signed=True)
            if front <= rear:
                check.refuse("positions", f"must have the front axle first, got {self.positions!r} m")
            check.positive("pitch_inertia", self.pitch_inertia, "kg m²")
            _check_axle(check, self)

    @property
    def position(self) -> float:
        """Place of the pivot [m]."""
        return 0.5 * (self.positions[0] + self.positions[1])

    @property
    def inertia(self) -> float | None:
        """Moment of inertia about the pivot [kg m²]."""
        return self.pitch_inertia


@dataclass(frozen=True, slots=True, kw_only=True)
class Unit:
    """One body of a truck with its axles: the truck itself, a tractor, a trailer.

    Parameters
    ----------
    mass : float
        Sprung mass [kg].
    pitch_inertia : float
        Moment of inertia about its centre of mass [kg m²].
    position : float
        Centre of mass ahead of the vehicle's reference point [m].
    axles : sequence of Axle or WalkingBeam
        Its axles.
    roll_inertia : float, optional
        Moment of inertia about the longitudinal axis [kg m²], for trucks with left and right wheels.
    name : str
        Name, before those of its degrees of freedom; may stay empty for a single unit.

    Raises
    ------
    ValueError
        If a mass or inertia is not positive, or there is an axle of another kind.
    """

    mass: float
    pitch_inertia: float
    position: float
    axles: Sequence[Axle | WalkingBeam]
    roll_inertia: float | None = None
    name: str = ""

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking(self) as check:
            check.positive("mass", self.mass, "kg")
            check.positive("pitch_inertia", self.pitch_inertia, "kg m²")
            check.finite("position", self.position, "m")
            check.text("name", self.name)
            if self.roll_inertia is not None:
                check.positive("roll_inertia", self.roll_inertia, "kg m²")
            check.listed("axles", self.axles, _RunningGear, least=0)


def truck(
    units: Sequence[Unit], hitches: Sequence[float] = (), *, sides: tuple[float, float] | None = None
) -> Vehicle:
    """Build a truck from its units: a rigid truck, a tractor with a semitrailer, or a longer combination.

    Degrees of freedom: bounce and pitch (and roll) of each unit, then `wheel_1`, `wheel_2` … from the front, each
    with `_left` and `_right` if there are sides, or `beam_2_bounce`, `beam_2_pitch` for a walking beam. A hitch
    joins a unit to the one ahead: the bounce of the rear one follows from the rest and is no degree of freedom.
    With sides, units roll together at their hitches, as over a fifth wheel, and each wheel moves on its own.

    Parameters
    ----------
    units : sequence of Unit
        From the front.
    hitches : sequence of float
        Places of the hitches ahead of the vehicle's reference point [m], one less than there are units.
    sides : tuple of float, optional
        Positions of left and right wheels, left of the centre line [m]: (+left, −right). None: one plane, all on
        path 0. Left wheels follow the profile's path 0, right ones its path 1.

    Returns
    -------
    Vehicle
        With one contact per axle, or per axle and side.

    Raises
    ------
    ValueError
        If the number of hitches is wrong, sides are out of order or units lack a roll inertia, or the units do not
        stand on their axles.

    Examples
    --------
    >>> steer = Axle(position=2.0, mass=700.0, suspension_stiffness=4e5, suspension_damping=1e4,
    ...              tyre_stiffness=1.7e6)
    >>> drive = Axle(position=-1.5, mass=1100.0, suspension_stiffness=1e6, suspension_damping=2e4,
    ...              tyre_stiffness=3.5e6)
    >>> lorry = truck(units=[Unit(mass=9000.0, pitch_inertia=3e4, position=0.0, axles=[steer, drive])])
    >>> lorry.dof_names
    ('bounce', 'pitch', 'wheel_1', 'wheel_2')
    """
    with checking() as check:
        names = _unit_names(check, units, sides is not None)
        joints = check.array("hitches", hitches, "m", (None,))
        if not check.faults and joints.size != max(len(units) - 1, 0):
            check.refuse("hitches", f"must be one less than units, {len(units) - 1} in all, got {joints.size}")
        if sides is not None:
            sides = check.pair("sides", sides, "m", signed=True)
            if sides[0] <= sides[1]:
                check.refuse("sides", f"must have the left wheels left of the right ones, got {sides!r} m")
    corners = list(_corners(units, names, sides))
    return assemble(
        bodies=[
            *(
                Body(
                    mass=unit.mass,
                    pitch_inertia=unit.pitch_inertia,
                    roll_inertia=None if sides is None else unit.roll_inertia,
                    position=unit.position,
                    name=name,
                )
                for name, unit in zip(names, units, strict=True)
            ),
            *(
                Body(
                    mass=corner.share * corner.axle.mass,
                    pitch_inertia=None if corner.axle.inertia is None else corner.share * corner.axle.inertia,
                    position=corner.axle.position,
                    across=corner.across,
                    name=corner.name,
                )
                for corner in corners
            ),
        ],
        suspensions=[
            Suspension(
                upper=corner.unit,
                lower=corner.name,
                stiffness=corner.share * corner.axle.suspension_stiffness,
                damping=corner.share * corner.axle.suspension_damping,
                position=corner.axle.position,
                across=corner.across,
            )
            for corner in corners
        ],
        hinges=[
            Hinge(first=first, second=second, position=at, rolls=sides is not None)
            for first, second, at in zip(names[:-1], names[1:], joints.tolist(), strict=True)
        ],
        contacts=[
            Contact(
                position=at,
                stiffness=corner.share * corner.axle.tyre_stiffness,
                damping=corner.share * corner.axle.tyre_damping,
                path=corner.path,
                across=corner.across,
                footprint=corner.axle.footprint,
                name=f"axle {number}{corner.hand}",
            )
            for corner in corners
            for number, at in zip(corner.numbers, corner.axle.positions, strict=True)
        ],
        under=[corner.name for corner in corners for _ in corner.axle.positions],
    )


class _Corner(NamedTuple):
    """One wheel, or one axle where left and right are one."""

    unit: str
    axle: Axle | WalkingBeam
    name: str
    numbers: range  # of its axles, from the front
    share: float  # of the axle's values
    across: float
    path: int
    hand: str


def _corners(units: Sequence[Unit], names: Sequence[str], sides: tuple[float, float] | None) -> Iterator[_Corner]:
    hands = [(1.0, 0.0, 0, "")] if sides is None else [(0.5, sides[0], 0, " left"), (0.5, sides[1], 1, " right")]
    first = 1
    for unit, name in zip(units, names, strict=True):
        for axle in unit.axles:
            numbers = range(first, first + len(axle.positions))
            kind = "wheel" if axle.inertia is None else "beam"
            for share, across, path, hand in hands:
                body = f"{kind}_{first}{hand.replace(' ', '_')}"
                yield _Corner(name, axle, body, numbers, share, across, path, hand)
            first = numbers.stop


def _unit_names(check: Checks, units: Sequence[Unit], rolls: bool) -> list[str]:
    units = check.listed("units", units, Unit)
    places = [place for unit in units for axle in unit.axles for place in axle.positions]
    if places != sorted(places, reverse=True):
        check.refuse("units", f"must have their axles in order from the front, got them at {places} m")
    for n, unit in enumerate(units):
        if rolls and unit.roll_inertia is None:
            check.refuse(f"units[{n}].roll_inertia", "is needed for left and right wheels [kg m²]")
    return [unit.name or (f"unit_{n}" if len(units) > 1 else "") for n, unit in enumerate(units, start=1)]


def _check_axle(check: Checks, axle: Axle | WalkingBeam) -> None:
    check.positive("mass", axle.mass, "kg")
    check.positive("suspension_stiffness", axle.suspension_stiffness, "N/m")
    check.not_negative("suspension_damping", axle.suspension_damping, "N s/m")
    check.positive_or_infinite("tyre_stiffness", axle.tyre_stiffness, "N/m")
    check.not_negative("tyre_damping", axle.tyre_damping, "N s/m")
    check.not_negative("footprint", axle.footprint, "m")

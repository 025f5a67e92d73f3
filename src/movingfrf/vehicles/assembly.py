"""Vehicles put together from rigid bodies, suspensions, hinges and contacts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import Checks, checking
from movingfrf.vehicles.contact import Contact
from movingfrf.vehicles.vehicle import Vehicle


@dataclass(frozen=True, slots=True, kw_only=True)
class Body:
    """A rigid body that moves down, and turns where it has an inertia.

    Its degrees of freedom are called after it: `NAME` if it only moves down, else `NAME_bounce`, `NAME_pitch` and
    `NAME_roll`; `bounce`, `pitch` and `roll` for a body without a name.

    Parameters
    ----------
    mass : float
        Mass [kg].
    pitch_inertia : float, optional
        Moment of inertia in pitch, about the centre of mass [kg m²]; None: the body does not pitch.
    roll_inertia : float, optional
        Moment of inertia in roll, about the centre of mass [kg m²]; None: the body does not roll.
    position : float
        Centre of mass ahead of the vehicle's reference point [m].
    across : float
        Centre of mass left of the centre line [m].
    name : str
        Name.

    Raises
    ------
    ValueError
        If a mass or inertia is not positive.
    """

    mass: float
    pitch_inertia: float | None = None
    roll_inertia: float | None = None
    position: float = 0.0
    across: float = 0.0
    name: str = ""

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking(self) as check:
            check.positive("mass", self.mass, "kg")
            for name in ("pitch_inertia", "roll_inertia"):
                if getattr(self, name) is not None:
                    check.positive(name, getattr(self, name), "kg m²")
            check.finite("position", self.position, "m")
            check.finite("across", self.across, "m")
            check.text("name", self.name)

    @property
    def dof_names(self) -> list[str]:
        """Names of its degrees of freedom."""
        turns = [name for name in ("pitch", "roll") if getattr(self, f"{name}_inertia") is not None]
        if not turns and self.name:
            return [self.name]
        return [f"{self.name}_{name}" if self.name else name for name in ("bounce", *turns)]

    @property
    def inertias(self) -> list[float]:
        """Mass [kg] and moments of inertia [kg m²], one per degree of freedom."""
        turns = [inertia for inertia in (self.pitch_inertia, self.roll_inertia) if inertia is not None]
        return [self.mass, *turns]

    def at(self, position: float, across: float) -> list[float]:
        """Displacement of a point of the body per degree of freedom [m/m or m/rad]."""
        levers = [
            distance
            for distance, inertia in (
                (position - self.position, self.pitch_inertia),
                (across - self.across, self.roll_inertia),
            )
            if inertia is not None
        ]
        return [1.0, *levers]


@dataclass(frozen=True, slots=True)
class Suspension:
    """A spring and a dashpot side by side, upright between two bodies.

    Parameters
    ----------
    upper : str
        Name of the body above.
    lower : str
        Name of the body below.
    stiffness : float
        Stiffness [N/m].
    damping : float
        Damping [N s/m].
    position : float
        Place ahead of the vehicle's reference point [m].
    across : float
        Place left of the centre line [m].

    Raises
    ------
    ValueError
        If stiffness or damping is negative, or both are zero.
    """

    upper: str
    lower: str
    _: KW_ONLY
    stiffness: float
    damping: float = 0.0
    position: float = 0.0
    across: float = 0.0

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking(self) as check:
            check.text("upper", self.upper)
            check.text("lower", self.lower)
            stiffness = check.not_negative("stiffness", self.stiffness, "N/m")
            damping = check.not_negative("damping", self.damping, "N s/m")
            check.finite("position", self.position, "m")
            check.finite("across", self.across, "m")
            if stiffness == 0 and damping == 0:
                check.refuse("stiffness", "or damping must be positive, got 0 N/m and 0 N s/m")


@dataclass(frozen=True, slots=True)
class Hinge:
    """A joint at which two bodies move down together, free to pitch against each other.

    Parameters
    ----------
    first : str
        Name of the body that keeps its degrees of freedom.
    second : str
        Name of the body that gives up a degree of freedom: its bounce follows from the others.
    position : float
        Place ahead of the vehicle's reference point [m].
    rolls : bool
        Whether the bodies roll together, as over the fifth wheel of a semitrailer; the second one then gives up its
        roll as well.

    Raises
    ------
    ValueError
        If the position is not finite.
    """

    first: str
    second: str
    _: KW_ONLY
    position: float
    rolls: bool = False

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking(self) as check:
            if check.text("first", self.first) == check.text("second", self.second):
                check.refuse("second", f"must be another body than the first, got {self.second!r} for both")
            check.finite("position", self.position, "m")


def assemble(
    bodies: Sequence[Body],
    *,
    suspensions: Sequence[Suspension] = (),
    hinges: Sequence[Hinge] = (),
    contacts: Sequence[Contact],
    under: Sequence[str],
) -> Vehicle:
    """Put a vehicle together.

    Hinges are eliminated: what the second body of a hinge gives up follows from the remaining degrees of freedom,
    so that no stiff spring stands for them.

    Parameters
    ----------
    bodies : sequence of Body
        Rigid bodies, each with a different name.
    suspensions : sequence of Suspension
        Springs and dashpots between bodies.
    hinges : sequence of Hinge
        Joints between bodies.
    contacts : sequence of Contact
        Contacts with the guideway.
    under : sequence of str
        Name of the body above each contact.

    Returns
    -------
    Vehicle
        With the bodies' degrees of freedom, in their order, less those that hinges take.

    Raises
    ------
    ValueError
        If a name is not that of a body, two bodies share a name, or a body is hinged so that it would be held
        twice.

    Examples
    --------
    A plank on two wheels of which the front one has a spring:

    >>> import movingfrf as mf
    >>> plank = assemble(
    ...     bodies=[Body(mass=100.0, pitch_inertia=30.0), Body(mass=10.0, position=1.0, name="wheel")],
    ...     suspensions=[Suspension(upper="", lower="wheel", stiffness=1e5, position=1.0)],
    ...     contacts=[mf.Contact(position=1.0, stiffness=2e5), mf.Contact(position=-1.0, stiffness=2e5)],
    ...     under=["wheel", ""],
    ... )
    >>> plank.dof_names
    ('bounce', 'pitch', 'wheel')
    >>> plank.static_loads.round(2).tolist()
    [588.6, 490.5]
    """
    with checking() as check:
        check.listed("bodies", bodies, Body)
        check.listed("suspensions", suspensions, Suspension, least=0)
        check.listed("hinges", hinges, Hinge, least=0)
        check.listed("contacts", contacts, Contact)
        check.listed("under", under, str)
    with checking() as check:
        layout = _Layout(check, bodies)
        for n, suspension in enumerate(suspensions):
            layout.require(check, f"suspensions[{n}].upper", suspension.upper)
            layout.require(check, f"suspensions[{n}].lower", suspension.lower)
        for n, hinge in enumerate(hinges):
            layout.require(check, f"hinges[{n}].first", hinge.first)
            layout.require(check, f"hinges[{n}].second", hinge.second)
        if len(under) != len(contacts):
            check.refuse("under", f"must name one body per contact, {len(contacts)} in all, got {len(under)}")
        for n, name in enumerate(under):
            layout.require(check, f"under[{n}]", name)
    stiffness, damping = np.zeros((2, layout.dofs, layout.dofs))
    for suspension in suspensions:
        where = suspension.position, suspension.across
        stretch = layout.point(suspension.upper, *where) - layout.point(suspension.lower, *where)
        square = np.outer(stretch, stretch)
        stiffness += suspension.stiffness * square
        damping += suspension.damping * square
    mass = np.diag(np.concatenate([body.inertias for body in bodies]))
    contact_map = np.array(
        [
            layout.point(name, contact.position, contact.across)
            for name, contact in zip(under, contacts, strict=True)
        ]
    )
    vertical = np.array([float(name in layout.downward) for name in layout.names])
    kept, free = _unhinged(layout, hinges)
    return Vehicle(
        mass=free.T @ mass @ free,
        damping=free.T @ damping @ free,
        stiffness=free.T @ stiffness @ free,
        contact_map=contact_map @ free,
        contacts=list(contacts),
        vertical=vertical[kept],
        dof_names=[layout.names[n] for n in kept],
    )


class _Layout:
    """Where the degrees of freedom of each body stand."""

    def __init__(self, check: Checks, bodies: Sequence[Body]) -> None:
        self.bodies: dict[str, Body] = {}
        self.first: dict[str, int] = {}
        self.names: list[str] = []
        self.downward: set[str] = set()
        for n, body in enumerate(bodies):
            if body.name in self.bodies:
                check.refuse(f"bodies[{n}].name", f"must be a different one for each body, got {body.name!r} again")
            self.bodies[body.name] = body
            self.first[body.name] = len(self.names)
            self.downward.add(body.dof_names[0])
            self.names += body.dof_names

    @property
    def dofs(self) -> int:
        return len(self.names)

    def require(self, check: Checks, what: str, name: str) -> None:
        if name not in self.bodies:
            check.refuse(what, f"must be one of the bodies {', '.join(map(repr, self.bodies))}, got {name!r}")

    def point(self, name: str, position: float, across: float) -> FloatArray:
        """Displacement of a point of a body per degree of freedom."""
        row = np.zeros(self.dofs)
        levers = self.bodies[name].at(position, across)
        row[self.first[name] : self.first[name] + len(levers)] = levers
        return row

    def roll(self, name: str) -> FloatArray:
        """Roll of a body per degree of freedom; zero for one that does not roll."""
        row = np.zeros(self.dofs)
        body = self.bodies[name]
        if body.roll_inertia is not None:
            row[self.first[name] + len(body.inertias) - 1] = 1.0
        return row


def _unhinged(layout: _Layout, hinges: Sequence[Hinge]) -> tuple[list[int], FloatArray]:
    """Numbers of the degrees of freedom that hinges leave, and all of them per remaining one."""
    rows: list[FloatArray] = []
    given_up: list[int] = []
    with checking() as check:
        for n, hinge in enumerate(hinges):
            centre = layout.bodies[hinge.first].across
            rows.append(
                layout.point(hinge.first, hinge.position, centre)
                - layout.point(hinge.second, hinge.position, centre)
            )
            given_up.append(layout.first[hinge.second])
            if hinge.rolls:
                rolls = [name for name in (hinge.first, hinge.second) if not layout.roll(name).any()]
                for name in rolls:
                    check.refuse(f"hinges[{n}].rolls", f"needs a body with a roll_inertia, but {name!r} has none")
                rows.append(layout.roll(hinge.first) - layout.roll(hinge.second))
                given_up.append(int(np.flatnonzero(layout.roll(hinge.second))[0]) if not rolls else 0)
    kept = [n for n in range(layout.dofs) if n not in given_up]
    free = np.zeros((layout.dofs, len(kept)))
    free[kept, np.arange(len(kept))] = 1.0
    if rows:
        # Of hinges the determinant is 0 or ±1, but for rounding; at 0 one holds a body that others hold already.
        dependent = 1e-9  # [1e-12 to 0.5]
        constraint = np.array(rows)
        bound = constraint[:, given_up]
        if len(set(given_up)) < len(given_up) or np.abs(np.linalg.det(bound)) < dependent:
            with checking() as check:
                check.refuse(
                    "hinges", "must not hold a body twice: each body may be the second one of one hinge only"
                )
        free[given_up] = -np.linalg.solve(bound, constraint[:, kept])
    return kept, free

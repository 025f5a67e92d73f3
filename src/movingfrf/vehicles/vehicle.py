"""One vehicle for all: matrices, and a map from its degrees of freedom to its contacts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NotRequired, TypedDict

import numpy as np
from numpy.typing import ArrayLike

from movingfrf._basics.arrays import ComplexArray, FloatArray
from movingfrf._basics.checks import Checks, checking
from movingfrf._basics.door import mistaken
from movingfrf._basics.remembered import Remembering, remembered
from movingfrf._basics.values import Value
from movingfrf._basics.wording import Standing, enumerated
from movingfrf.vehicles.contact import Contact
from movingfrf.vehicles.dynamics import Dynamics, Quadratic, Split, held, parts, split

# Standard acceleration of free fall as the project fixes it [m/s²].
GRAVITY = 9.81


class Offsets(TypedDict):
    """Offsets between contacts, as a guideway's `moving_frf` takes them, each (receiver, source) [m]."""

    ahead: FloatArray
    # Of a vehicle with contacts beside the centre line only.
    across: NotRequired[FloatArray]
    source_across: NotRequired[FloatArray]


class Touching(TypedDict):
    """What of the road contacts touch, as `roughness.excitation.Touch` takes it; arrays (contact,) [m]."""

    positions: FloatArray
    paths: list[int]
    footprints: FloatArray
    cams: FloatArray


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Vehicle(Remembering, Value):
    """A linear vehicle: M z̈ + C ż + K z on its own, joined to the guideway by its contacts.

    Parameters
    ----------
    mass : array_like, shape (dof, dof)
        Mass matrix, symmetric and positive definite [kg; rotations in rad].
    damping : array_like, shape (dof, dof)
        Damping matrix of the vehicle without the dashpots of its contacts, symmetric and positive semidefinite
        [N s/m; rotations in rad].
    stiffness : array_like, shape (dof, dof)
        Stiffness matrix of the vehicle without the springs of its contacts, symmetric and positive semidefinite
        [N/m; rotations in rad].
    contact_map : array_like, shape (contact, dof)
        Displacement of the vehicle at each contact per degree of freedom [m/m or m/rad].
    contacts : sequence of Contact
        The contacts, one per row of `contact_map`.
    vertical : array_like, shape (dof,)
        Motion of each degree of freedom when the vehicle moves down by one metre (1 for translations, 0 for
        rotations); gravity acts along it. It strains nothing within the vehicle and moves each contact by one.
    dof_names : sequence of str
        One name per degree of freedom.

    Raises
    ------
    ValueError
        If shapes disagree, a matrix is not symmetric or not definite as demanded, `vertical` is not a rigid
        motion, the contacts do not hold the vehicle up, two rigid contacts prescribe the same motion, or no weight
        reaches a contact.
    """

    mass: ArrayLike
    damping: ArrayLike
    stiffness: ArrayLike
    contact_map: ArrayLike
    contacts: Sequence[Contact]
    vertical: ArrayLike
    dof_names: Sequence[str]

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking(self) as check:
            contacts, names = check.listed("contacts", self.contacts, Contact), _names(check, self.dof_names)
            dofs = len(names)
            for name, unit in (("mass", "kg"), ("damping", "N s/m"), ("stiffness", "N/m")):
                check.array(name, getattr(self, name), unit, (dofs, dofs))
            check.array("contact_map", self.contact_map, "m/m", (len(contacts), dofs))
            check.array("vertical", self.vertical, "m/m", (dofs,))
        with checking() as check:
            _check_definite(check, "mass", self.mass, strictly=True)
            _check_definite(check, "damping", self.damping, strictly=False)
            _check_definite(check, "stiffness", self.stiffness, strictly=False)
        with checking() as check:
            _check_free(check, self)
            _check_held(check, self)
        with checking() as check:
            _check_carried(check, self)

    def told(self) -> list[tuple[str, str]]:
        """Tell degrees of freedom, contacts, weight, in words."""
        loads = self.static_loads
        contacts = [
            f"{contact.name or f'contact {number}'} at {contact.position:.4g} m ({load / 1e3:.4g} kN)"
            for number, (contact, load) in enumerate(zip(self.contacts, loads.tolist(), strict=True))
        ]
        return [
            ("degrees of freedom", enumerated(self.dof_names, 8)),
            ("contacts", enumerated(contacts, 4)),
            ("weight", f"{loads.sum() / 1e3:.4g} kN"),
        ]

    # The fields as arrays: what the constructor stored.
    @property
    def matrices(self) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Mass, damping, stiffness and contact map as arrays."""
        return self.mass, self.damping, self.stiffness, self.contact_map  # type: ignore[return-value]

    @property
    @remembered
    def springs(self) -> FloatArray:
        """Stiffness of each contact [N/m], `inf` where it is rigid."""
        return np.array([contact.stiffness for contact in self.contacts], float)

    @property
    @remembered
    def dashpots(self) -> FloatArray:
        """Damping of each contact [N s/m]."""
        return np.array([contact.damping for contact in self.contacts], float)

    @property
    @remembered
    def positions(self) -> FloatArray:
        """Position of each contact ahead of the reference point [m]."""
        return np.array([contact.position for contact in self.contacts])

    @property
    @remembered
    def across(self) -> FloatArray:
        """Position of each contact left of the centre line [m]."""
        return np.array([contact.across for contact in self.contacts])

    @property
    def paths(self) -> list[int]:
        """Path of the profile that each contact follows."""
        return [contact.path for contact in self.contacts]

    @property
    def touching(self) -> Touching:
        """Where the contacts stand and what of the road each touches, as an excitation takes it."""
        return {
            "positions": self.positions,
            "paths": self.paths,
            "footprints": np.array([contact.footprint for contact in self.contacts]),
            "cams": np.array([contact.cams for contact in self.contacts]),
        }

    @property
    def on_rails(self) -> bool:
        """Whether every contact is as stiff as a wheel on a rail; a rigid one has to be called a wheelset."""
        # Between the stiffest tyres and the softest wheels on rails [2e7 to 3e8 N/m].
        least = 1e8
        return all(
            contact.stiffness > least and ("wheelset" in contact.name or not contact.rigid)
            for contact in self.contacts
        )

    @property
    def standing(self) -> Standing:
        """What messages say of the contacts."""
        return Standing([contact.name for contact in self.contacts], "rail" if self.on_rails else "road")

    @property
    @remembered
    def coordinates(self) -> dict[str, ArrayLike]:
        """Coordinates of a result by their names in the schema: contacts and degrees of freedom."""
        return {
            "contact": np.arange(len(self.contacts)),
            "position": self.positions,
            "path": np.array(self.paths),
            "contact_name": np.array([contact.name for contact in self.contacts]),
            "dof": np.array(self.dof_names),
            "dof_unit": np.where(np.asarray(self.vertical) == 0, "rad", "m"),
        }

    @property
    def offsets(self) -> Offsets:
        """Offset of every contact from every contact, as a guideway's `moving_frf` takes them [m]."""
        ahead, across = self.positions, self.across
        # To nine digits after the point [9 to 12]: the cars of a train have most of their offsets in common, but
        # for rounding.
        offsets: Offsets = {"ahead": np.round(ahead[:, None] - ahead, 9)}
        if across.any():
            offsets["across"] = across[:, None] - across
            offsets["source_across"] = np.broadcast_to(across, offsets["ahead"].shape)
        return offsets

    @property
    @remembered
    def weights(self) -> FloatArray:
        """Weight along each degree of freedom [N]."""
        return GRAVITY * self.matrices[0] @ np.asarray(self.vertical)

    @property
    @remembered
    def static_loads(self) -> FloatArray:
        """Contact forces of the vehicle at rest on a rigid flat road [N]."""
        impedance, rows, _ = self._held()
        motion = self._motion()
        assert motion is not None
        sag = motion.free @ np.linalg.solve(
            motion.free.T @ impedance.constant @ motion.free, motion.free.T @ self.weights
        )
        sprung = np.where(np.isinf(self.springs), 0.0, self.springs) * (rows @ sag)
        return sprung + motion.prescribed.T @ (self.weights - impedance.constant @ sag)

    @property
    @remembered
    def poles(self) -> ComplexArray:
        """Poles on a rigid road [rad/s], one of each conjugate pair, by ascending magnitude."""
        return self.dynamics().poles

    @property
    def natural_frequencies(self) -> FloatArray:
        """Magnitude of each pole over 2π [Hz], ascending; an overdamped mode appears as two."""
        return np.abs(self.poles) / (2 * np.pi)

    @property
    def damping_ratios(self) -> FloatArray:
        """Damping ratio of each pole, in the order of `natural_frequencies`; 1 for an overdamped mode."""
        return -self.poles.real / np.abs(self.poles)

    @remembered
    def dynamics(self) -> Dynamics:
        """Prepare the vehicle, once, to be asked what it does at its contacts at any frequency.

        Returns
        -------
        Dynamics
            Response and dynamic stiffness at the contacts.
        """
        found = parts(*self.matrices, self.springs, self.dashpots)
        return Dynamics(found, len(self.dof_names), len(self.contacts))

    @property
    def held_stiffness(self) -> FloatArray:
        """Stiffness with the guideway held still, rigid contacts left out [N/m]."""
        return self._held()[0].constant

    @remembered
    def _motion(self) -> Split | None:
        return split(self.matrices[3], np.isinf(self.springs))

    @remembered
    def _held(self) -> tuple[Quadratic, FloatArray, Quadratic]:
        mass, damping, stiffness, contact_map = self.matrices
        return held(Quadratic.of(mass, damping, stiffness), contact_map, self.springs, self.dashpots)


def require_vehicle(vehicle: object, name: str = "vehicle") -> None:
    """Refuse what is no vehicle.

    Parameters
    ----------
    vehicle : object
        What was given.
    name : str
        Name of the argument.

    Raises
    ------
    ValueError
        If it is no `Vehicle`.
    """
    with checking() as check:
        check_vehicle(check, vehicle, name)


def check_vehicle(check: Checks, vehicle: object, name: str = "vehicle") -> None:
    """Refuse what is no vehicle, along with whatever else is wrong."""
    if not isinstance(vehicle, Vehicle):
        check.refuse(name, mistaken("vehicle", vehicle))


def _names(check: Checks, names: Sequence[str]) -> tuple[str, ...]:
    listed = check.listed("dof_names", names, str)
    if len(set(listed)) < len(listed):
        check.refuse("dof_names", "must be different names")
    return listed


def _check_definite(check: Checks, name: str, matrix: object, *, strictly: bool) -> None:
    array = np.asarray(matrix, float)
    scale = np.abs(array).max(initial=0.0)
    if np.abs(array - array.T).max(initial=0.0) > 1e-9 * scale:
        check.refuse(name, "must be a symmetric matrix")
        return
    # Translations and rotations differ in scale: judge the matrix with its diagonal brought to one.
    diagonal = np.sqrt(np.abs(np.diag(array)))
    diagonal[diagonal == 0] = np.sqrt(scale) if scale else 1.0
    smallest = float(np.linalg.eigvalsh(array / np.outer(diagonal, diagonal)).min())
    if smallest < (1e-12 if strictly else -1e-9):
        kind = "positive definite" if strictly else "positive semidefinite"
        check.refuse(name, f"must be {kind}, got a smallest scaled eigenvalue of {smallest:.3g}")


def _check_free(check: Checks, vehicle: Vehicle) -> None:
    """Demand that moving the vehicle down moves every contact as much, and strains nothing within."""
    _, damping, stiffness, contact_map = vehicle.matrices
    down = np.asarray(vehicle.vertical)
    if np.abs(contact_map @ down - 1.0).max(initial=0.0) > 1e-6:
        check.refuse(
            "contact_map", "times vertical must be 1: the vehicle moves down by one metre, and so do its contacts"
        )
    for name, matrix, what, at_contacts in (
        ("stiffness", stiffness, "springs", vehicle.springs),
        ("damping", damping, "dashpots", vehicle.dashpots),
    ):
        resisted, nothing = matrix @ down, 1e-6 * np.abs(matrix).max(initial=0.0)
        if np.abs(resisted).max() > nothing:
            # What the contacts add, if the file of another program has them in its matrices.
            theirs = contact_map.T @ (np.where(np.isinf(at_contacts), 0.0, at_contacts) * (contact_map @ down))
            why = (
                f"it includes the {what} of the contacts, which stand apart: take them out"
                if np.abs(resisted - theirs).max() <= nothing
                else f"are {what} of the contacts, which stand apart, included, or is vertical 1 for a rotation?"
            )
            # Both may have one cause: it is asked for once.
            asked = any(why.partition("contacts")[2] in fault.message for fault in check.faults)
            within = "times vertical must be 0: moving the vehicle down as a whole strains nothing within"
            check.refuse(name, within if asked else f"{within}; {why}")


def _check_held(check: Checks, vehicle: Vehicle) -> None:
    """Demand that every motion meets a stiffness, or is prescribed once by a rigid contact."""
    motion = vehicle._motion()
    if motion is None:
        check.refuse(
            "contacts", "must not prescribe one motion twice, but rigid contacts of this vehicle do: leave one out"
        )
        return
    stiffness = motion.free.T @ vehicle.held_stiffness @ motion.free
    if not stiffness.size:
        return
    diagonal = np.sqrt(np.diag(stiffness))
    diagonal[diagonal == 0] = 1.0
    values, vectors = np.linalg.eigh(stiffness / np.outer(diagonal, diagonal))
    if values[0] < 1e-12:
        loose = np.abs(vectors[:, 0] / diagonal)
        names = [vehicle.dof_names[motion.kept[n]] for n in np.flatnonzero(loose > 0.1 * loose.max())]
        check.refuse(
            "contacts",
            f"must hold the vehicle up, but a motion of {', '.join(names)} meets no stiffness at all",
        )


def _check_carried(check: Checks, vehicle: Vehicle) -> None:
    """Demand that weight rests on every contact."""
    loads = vehicle.static_loads
    for number in np.flatnonzero(~(loads > 0)).tolist():
        at = vehicle.contacts[number]
        check.refuse(
            f"contacts[{number}]",
            f"at {at.position:g} m ahead and {at.across:g} m to the left must carry weight, got a static load of "
            f"{loads[number]:.6g} N: the vehicle would tip over its other contacts",
        )

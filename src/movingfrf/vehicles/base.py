"""One vehicle for all: matrices, and a map from its degrees of freedom to its contacts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, NotRequired, TypedDict

import numpy as np
from numpy.typing import ArrayLike

from movingfrf._checks import Checks, ComplexArray, FloatArray, checking

# Standard acceleration of free fall as the project fixes it [m/s²].
GRAVITY = 9.81

# Above this condition number of the modal matrix (a defective or nearly defective mode) the modes no longer
# carry the digits and each frequency is solved directly.
WORST_MODAL_CONDITION = 1e6


@dataclass(frozen=True, slots=True, kw_only=True)
class Contact:
    """Where and how a vehicle touches the guideway: a spring and a dashpot side by side.

    Parameters
    ----------
    position : float
        Ahead of the vehicle's reference point [m], positive in the direction of travel.
    stiffness : float
        Contact (tyre) stiffness [N/m].
    damping : float
        Contact damping [N s/m].
    path : int
        Number of the profile's path that the contact follows.
    across : float
        Position across the guideway, left of its centre line [m].
    footprint : float
        Length over which the contact averages the profile [m].

    Raises
    ------
    ValueError
        If the stiffness is not positive, or damping, path or footprint is negative.
    """

    position: float
    stiffness: float
    damping: float = 0.0
    path: int = 0
    across: float = 0.0
    footprint: float = 0.0

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking() as check:
            check.finite("position", self.position, "m")
            check.positive("stiffness", self.stiffness, "N/m")
            check.not_negative("damping", self.damping, "N s/m")
            check.whole("path", self.path)
            check.finite("across", self.across, "m")
            check.not_negative("footprint", self.footprint, "m")


class Offsets(TypedDict):
    """Offsets between contacts, as a guideway's `moving_frf` takes them, each (receiver, source) [m]."""

    ahead: FloatArray
    # Of a vehicle with contacts beside the centre line only.
    across: NotRequired[FloatArray]
    source_across: NotRequired[FloatArray]


class Modes(NamedTuple):
    """Poles and residues of the vehicle on its contact springs, the guideway held still."""

    poles: ComplexArray  # (mode,)
    shapes: ComplexArray  # (dof, mode)
    from_contacts: ComplexArray  # (mode, contact), what a force at a contact feeds into a mode


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Vehicle:
    """A linear vehicle: M z̈ + C ż + K z on its own, joined to the guideway by its contacts.

    Parameters
    ----------
    mass, damping, stiffness : array_like, shape (dof, dof)
        Symmetric matrices of the vehicle without its contact springs [kg, N s/m, N/m; rotations in rad].
        Mass positive definite, damping and stiffness positive semidefinite.
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
        motion, or the contacts do not hold the vehicle up.
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
        with checking() as check:
            contacts, names = _contacts(check, self.contacts), _names(check, self.dof_names)
            dofs = len(names)
            checked: dict[str, object] = {"contacts": contacts, "dof_names": names}
            for name, unit in (("mass", "kg"), ("damping", "N s/m"), ("stiffness", "N/m")):
                checked[name] = check.array(name, getattr(self, name), unit, (dofs, dofs))
            checked["contact_map"] = check.array("contact_map", self.contact_map, "m/m", (len(contacts), dofs))
            checked["vertical"] = check.array("vertical", self.vertical, "m/m", (dofs,))
            if not check.faults:
                _check_definite(check, "mass", checked["mass"], strictly=True)
                _check_definite(check, "damping", checked["damping"], strictly=False)
                _check_definite(check, "stiffness", checked["stiffness"], strictly=False)
        for name, value in checked.items():
            object.__setattr__(self, name, value)
        with checking() as check:
            _check_free(check, self)
            _check_held(check, self.held_stiffness)

    # The fields as arrays: what the constructor stored.
    @property
    def matrices(self) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Mass, damping, stiffness and contact map as arrays."""
        return self.mass, self.damping, self.stiffness, self.contact_map  # type: ignore[return-value]

    @property
    def positions(self) -> FloatArray:
        """Position of each contact ahead of the reference point [m]."""
        return np.array([contact.position for contact in self.contacts])

    @property
    def across(self) -> FloatArray:
        """Position of each contact left of the centre line [m]."""
        return np.array([contact.across for contact in self.contacts])

    @property
    def offsets(self) -> Offsets:
        """Offset of every contact from every contact, as a guideway's `moving_frf` takes them [m]."""
        ahead, across = self.positions, self.across
        offsets: Offsets = {"ahead": ahead[:, None] - ahead}
        if across.any():
            offsets["across"] = across[:, None] - across
            offsets["source_across"] = np.broadcast_to(across, offsets["ahead"].shape)
        return offsets

    @property
    def held_stiffness(self) -> FloatArray:
        """K + Bᵀ K_t B: stiffness with the guideway held still [N/m]."""
        _, _, stiffness, contact_map = self.matrices
        return stiffness + contact_map.T * [contact.stiffness for contact in self.contacts] @ contact_map

    @property
    def held_damping(self) -> FloatArray:
        """C + Bᵀ C_t B: damping with the guideway held still [N s/m]."""
        _, damping, _, contact_map = self.matrices
        return damping + contact_map.T * [contact.damping for contact in self.contacts] @ contact_map

    @property
    def static_loads(self) -> FloatArray:
        """Contact forces of the vehicle at rest on a rigid flat road [N]."""
        mass, _, _, contact_map = self.matrices
        sag = np.linalg.solve(self.held_stiffness, GRAVITY * mass @ np.asarray(self.vertical))
        return np.array([contact.stiffness for contact in self.contacts]) * (contact_map @ sag)

    @property
    def poles(self) -> ComplexArray:
        """Poles on a rigid road [rad/s], one of each conjugate pair, by ascending magnitude."""
        poles = np.linalg.eigvals(self._state_matrix()).astype(complex)
        upper = poles[poles.imag >= 0]
        return upper[np.argsort(np.abs(upper), kind="stable")]

    @property
    def natural_frequencies(self) -> FloatArray:
        """Magnitude of each pole over 2π [Hz], ascending; an overdamped mode appears as two."""
        return np.abs(self.poles) / (2 * np.pi)

    @property
    def damping_ratios(self) -> FloatArray:
        """Damping ratio of each pole, in the order of `natural_frequencies`; 1 for an overdamped mode."""
        return -self.poles.real / np.abs(self.poles)

    def contact_stiffness(self, omega: ComplexArray) -> ComplexArray:
        """k_t + iω c_t of each contact [N/m], shape (frequency, contact)."""
        stiffness = np.array([contact.stiffness for contact in self.contacts])
        damping = np.array([contact.damping for contact in self.contacts])
        return (stiffness[:, None] + (1j * omega) * damping[:, None]).T

    def modes(self) -> Modes | None:
        """Poles and residues; None if a mode is defective, or so nearly that it carries no digits."""
        mass, _, _, contact_map = self.matrices
        dofs = len(mass)
        poles, vectors = np.linalg.eig(self._state_matrix())
        # Displacement and velocity in one unit each, else the condition number measures the units.
        vectors[dofs:] /= np.abs(poles).max()
        vectors /= np.linalg.norm(vectors, axis=0)
        try:
            inverse = np.linalg.inv(vectors)
        except np.linalg.LinAlgError:
            return None
        if not np.linalg.norm(vectors) * np.linalg.norm(inverse) < WORST_MODAL_CONDITION:
            return None
        into_modes = inverse[:, dofs:] @ np.linalg.solve(mass, contact_map.T) / np.abs(poles).max()
        return Modes(poles, vectors[:dofs], into_modes)

    def motion(self, omega: ComplexArray, force: ComplexArray, modes: Modes | None) -> ComplexArray:
        """Motion of the vehicle on its contact springs, pushed at its contacts.

        Parameters
        ----------
        omega : ndarray, shape (frequency,)
            Angular frequency [rad/s].
        force : ndarray, shape (frequency, contact)
            Force on the vehicle at each contact [N], positive down: for a displacement d below the contact
            (k_t + iω c_t) d.
        modes : Modes or None
            What `modes()` returned; None solves each frequency directly.

        Returns
        -------
        ndarray, shape (frequency, dof)
            Motion of each degree of freedom [m or rad].
        """
        if modes is None:
            generalised = force @ self.matrices[3]
            return np.linalg.solve(self._impedance(omega), generalised[:, :, None])[:, :, 0]
        # Frequency last while computing: the other axes are too short to loop over first.
        modal = modes.from_contacts @ force.T
        modal *= _admittance(omega, modes.poles)
        return (modes.shapes @ modal).T

    def receptance(self, omega: ComplexArray, modes: Modes | None) -> ComplexArray:
        """Displacement of the vehicle at its contacts per force there, on its contact springs.

        Parameters
        ----------
        omega : ndarray, shape (frequency,)
            Angular frequency [rad/s].
        modes : Modes or None
            What `modes()` returned.

        Returns
        -------
        ndarray, shape (frequency, contact, contact)
            B A⁻¹ Bᵀ [m/N], with A the dynamic stiffness of the vehicle on its contact springs.
        """
        contact_map = self.matrices[3]
        count = len(contact_map)
        if modes is None:
            return contact_map @ np.linalg.solve(self._impedance(omega), contact_map.T.astype(complex))
        residues = (contact_map @ modes.shapes)[:, None, :] * modes.from_contacts.T
        pairs = residues.reshape(count * count, -1) @ _admittance(omega, modes.poles)
        return pairs.reshape(count, count, -1).transpose(2, 0, 1)

    def dynamic_stiffness(self, omega: ComplexArray, modes: Modes | None) -> ComplexArray:
        """Dynamic stiffness at the contacts, D = K_t − K_t B A⁻¹ Bᵀ K_t.

        It stays finite at rest, and moving all contacts as a rigid body costs nothing there.

        Parameters
        ----------
        omega : ndarray, shape (frequency,)
            Angular frequency [rad/s].
        modes : Modes or None
            What `modes()` returned.

        Returns
        -------
        ndarray, shape (frequency, contact, contact)
            Force that the guideway exerts on the vehicle per displacement below the contacts [N/m].
        """
        springs = self.contact_stiffness(omega)
        carried = self.receptance(omega, modes) * springs[:, None, :]
        return springs[:, :, None] * (np.eye(len(self.contacts)) - carried)

    def _impedance(self, omega: ComplexArray) -> ComplexArray:
        """Dynamic stiffness A of the vehicle on its contact springs, shape (frequency, dof, dof)."""
        i_omega: ComplexArray = 1j * omega[:, None, None]
        impedance: ComplexArray = i_omega * i_omega * self.matrices[0]
        impedance += i_omega * self.held_damping + self.held_stiffness
        return impedance

    def _state_matrix(self) -> FloatArray:
        mass = self.matrices[0]
        rates = np.linalg.solve(mass, np.hstack([-self.held_stiffness, -self.held_damping]))
        return np.vstack([np.hstack([np.zeros_like(mass), np.eye(len(mass))]), rates])


def _admittance(omega: ComplexArray, poles: ComplexArray) -> ComplexArray:
    """1/(iω − λ) for every pole λ, shape (mode, frequency); complex division would take most of the time."""
    real = (1j * omega).real - poles.real[:, None]
    imaginary = (1j * omega).imag - poles.imag[:, None]
    inverse = np.square(real)
    inverse += np.square(imaginary)
    np.reciprocal(inverse, out=inverse)
    admittance = np.empty(inverse.shape, complex)
    np.multiply(real, inverse, out=admittance.real)
    np.negative(inverse, out=inverse)
    np.multiply(imaginary, inverse, out=admittance.imag)
    return admittance


def _contacts(check: Checks, contacts: Sequence[Contact]) -> tuple[Contact, ...]:
    contacts = tuple(contacts) if isinstance(contacts, (list, tuple)) else ()
    if not contacts or not all(isinstance(contact, Contact) for contact in contacts):
        check.refuse("contacts", "must be a list of one or more Contact objects")
        return ()
    return contacts


def _names(check: Checks, names: Sequence[str]) -> tuple[str, ...]:
    names = tuple(names) if isinstance(names, (list, tuple)) else ()
    if not names or not all(isinstance(name, str) for name in names) or len(set(names)) < len(names):
        check.refuse("dof_names", "must be a list of one or more different names")
    return names


def _check_definite(check: Checks, name: str, matrix: object, *, strictly: bool) -> None:
    array = np.asarray(matrix, float)
    scale = np.abs(array).max(initial=0.0)
    if not np.allclose(array, array.T, rtol=0, atol=1e-9 * scale):
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
    if not np.allclose(contact_map @ down, 1.0, rtol=0, atol=1e-6):
        check.refuse(
            "contact_map", "times vertical must be 1: the vehicle moves down by one metre, and so do its contacts"
        )
    for name, matrix in (("stiffness", stiffness), ("damping", damping)):
        if not np.allclose(matrix @ down, 0.0, rtol=0, atol=1e-6 * np.abs(matrix).max(initial=0.0)):
            check.refuse(
                name, "times vertical must be 0: moving the vehicle down as a whole strains nothing within"
            )


def _check_held(check: Checks, stiffness: FloatArray) -> None:
    diagonal = np.sqrt(np.diag(stiffness))
    if not (diagonal > 0).all() or np.linalg.eigvalsh(stiffness / np.outer(diagonal, diagonal)).min() < 1e-12:
        check.refuse("contacts", "must hold the vehicle up: some motion of it meets no stiffness at all")

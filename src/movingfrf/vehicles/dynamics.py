"""What a vehicle does at its contacts, frequency by frequency.

The guideway moves the vehicle by d below its contacts. Elastic contacts pass that on through springs and dashpots
k(ω) = k + iωc; rigid ones prescribe the motion above them, B_r q = d_r. Split q = T p + S d into free coordinates p
and prescribed ones, so that B_r T = 0 and B_r S = 1; then the equations of motion, A(ω) = K + iωC − ω²M with the
elastic contact springs included, leave

    P p = H d,   F = Hᵀ p − E d,   P = Tᵀ A T,   H = Tᵀ (B_eᵀ k − A S),
    E = k − k B_e S − Sᵀ B_eᵀ k + Sᵀ A S,

with F the contact force (compression positive). The dynamic stiffness at the contacts is D = E − Hᵀ P⁻¹ H. H and E
are polynomials in iω, of first degree (E = k, H = Bᵀ k) where all contacts are elastic, of second where some are
rigid. No large number stands for rigidity.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import scipy.linalg

from movingfrf._basics.arrays import BoolArray, ComplexArray, FloatArray, IntArray, handed
from movingfrf._basics.compiling import loops_for
from movingfrf._basics.remembered import Remembering, remembered


@dataclass(frozen=True, slots=True, kw_only=True)
class Solution:
    """What tunes how a vehicle is solved; in brackets, between what each number is safe."""

    # Above this condition number of the modal matrix (a defective or nearly defective mode) the modes no longer
    # carry the digits and each frequency is solved directly.
    worst_condition: float = 1e6  # [1e3 to 1e8]
    # Compiled loops gain on BLAS up to so many modes; they take so many frequencies at a time.
    few: int = 12  # [8 to 20: time only]
    together: int = 64  # [16 to 256: time only]
    # Rigid contacts whose prescribed motions are closer to each other than this prescribe the same one twice.
    independent: float = 1e-9  # [1e-12 to 1e-6]


SOLUTION = Solution()


class Quadratic(NamedTuple):
    """A polynomial in iω whose coefficients are matrices, by ascending power."""

    constant: FloatArray
    linear: FloatArray
    square: FloatArray

    @classmethod
    def of(cls, mass: FloatArray, damping: FloatArray, stiffness: FloatArray) -> Quadratic:
        """Dynamic stiffness K + iωC + (iω)²M."""
        return cls(constant=stiffness, linear=damping, square=mass)

    def mapped(self, left: FloatArray, right: FloatArray) -> Quadratic:
        """Multiply every coefficient from both sides."""
        return Quadratic(*(left @ part @ right for part in self))

    def transposed(self) -> Quadratic:
        """Transpose every coefficient."""
        return Quadratic(*(part.T for part in self))

    def terms(self) -> list[tuple[int, FloatArray]]:
        """Powers of iω whose coefficients are not zero."""
        return [(power, part) for power, part in enumerate(self) if part.any()]

    def times(self, omega: ComplexArray, columns: ComplexArray) -> ComplexArray:
        """Multiply with a column per case and frequency: (*case, j, frequency) becomes (*case, i, frequency)."""
        shape = (*columns.shape[:-2], len(self.constant), omega.size)
        return _horner(1j * omega, [part @ columns if part.any() else None for part in self], shape)

    def at(self, omega: ComplexArray) -> ComplexArray:
        """Evaluate at some frequencies [rad/s], shape (*coefficient, frequency)."""
        s: ComplexArray = 1j * omega
        constant, linear, square = (part[..., None] for part in self)
        if not self.square.any():
            return constant + s * linear
        return constant + s * (linear + s * square)


def _horner(s: ComplexArray, terms: Sequence[ComplexArray | None], shape: tuple[int, ...]) -> ComplexArray:
    """Σ sᵏ terms[k], each of this shape with frequency last, None for zero; the terms are used up."""
    total: ComplexArray | None = None
    for term in reversed(terms):
        if total is not None:
            total *= s
        if term is not None:
            total = term if total is None else np.add(total, term, out=total)
    return np.zeros(shape, complex) if total is None else total


class Split(NamedTuple):
    """Free and prescribed motion: q = T p + S d."""

    free: FloatArray  # T (dof, free)
    prescribed: FloatArray  # S (dof, contact), zero for elastic contacts
    kept: IntArray  # (free,) numbers of the degrees of freedom that p consists of


def split(contact_map: FloatArray, rigid: BoolArray) -> Split | None:
    """Split the motion of a vehicle by its rigid contacts.

    Parameters
    ----------
    contact_map : ndarray, shape (contact, dof)
        Displacement at each contact per degree of freedom.
    rigid : ndarray, shape (contact,)
        Which contacts are rigid.

    Returns
    -------
    Split or None
        None if two rigid contacts prescribe the same motion.
    """
    contacts, dofs = contact_map.shape
    rows = contact_map[rigid]
    count = len(rows)
    if count > dofs:
        return None
    if not count:
        return Split(np.eye(dofs), np.zeros((dofs, contacts)), np.arange(dofs))
    # Rotations turn by less than wheels move; a column stands for a motion whatever its unit.
    size = np.abs(rows).max(axis=0)
    _, triangle, order = scipy.linalg.qr(rows / np.where(size, size, 1.0), pivoting=True, mode="economic")
    if np.abs(np.diag(triangle)).min() < SOLUTION.independent:
        return None
    bound, kept = np.sort(order[:count]), np.sort(order[count:])
    free, prescribed = np.zeros((dofs, kept.size)), np.zeros((dofs, contacts))
    free[kept, np.arange(kept.size)] = 1.0
    inverse = np.linalg.inv(rows[:, bound])
    free[bound] = -inverse @ rows[:, kept]
    prescribed[np.ix_(bound, np.flatnonzero(rigid))] = inverse
    return Split(free, prescribed, kept)


class Numbers(NamedTuple):
    """What compiled loops take of a part: all powers of iω up to the highest in one array."""

    poles: ComplexArray  # (mode,)
    carried: ComplexArray  # (power, contact², mode)
    direct: FloatArray  # E (power, contact, contact)
    entered: ComplexArray  # (power, mode, contact)
    moving: ComplexArray  # (dof, mode), what of a mode moves
    pushing: ComplexArray  # (power, contact, mode), what of it presses
    prescribed: FloatArray  # S (dof, contact), without columns if it is zero
    together: int  # frequencies at a time


class Modes(NamedTuple):
    """Poles and residues of P⁻¹: the vehicle on its contact springs, the guideway held still.

    What has a coefficient for each power of iω has None for those that are zero.
    """

    poles: ComplexArray  # (mode,)
    shapes: ComplexArray  # (free, mode)
    entered: tuple[ComplexArray | None, ...]  # (mode, contact), what a displacement below a contact feeds into it
    carried: tuple[ComplexArray | None, ...]  # (contact², mode), what of it comes back to the contacts

    @classmethod
    def of(cls, own: Quadratic, entry: Quadratic) -> Modes | None:
        """Take P and H apart; None if a mode is defective, or so nearly that it carries no digits."""
        dofs, contacts = len(own.constant), entry.constant.shape[1]
        if not dofs:
            return None
        poles, vectors = np.linalg.eig(state_matrix(own))
        # Displacement and velocity in one unit each, else the condition number measures the units.
        vectors[dofs:] /= np.abs(poles).max()
        vectors /= np.linalg.norm(vectors, axis=0)
        try:
            inverse = np.linalg.inv(vectors)
        except np.linalg.LinAlgError:
            return None
        if not np.linalg.norm(vectors) * np.linalg.norm(inverse) < SOLUTION.worst_condition:
            return None
        weights = np.linalg.solve(own.square, inverse[:, dofs:].T).T / np.abs(poles).max()
        shapes = vectors[:dofs].astype(complex)
        carried: list[ComplexArray | None] = [None] * 5
        entered: list[ComplexArray | None] = [None] * 3
        terms = [(power, part.T @ shapes, (weights @ part).astype(complex)) for power, part in entry.terms()]
        for power_in, _, into in terms:
            entered[power_in] = into
            for power_out, out, _ in terms:
                added, known = out[:, None, :] * into.T, carried[power_out + power_in]
                carried[power_out + power_in] = added if known is None else known + added
        flat = tuple(None if part is None else part.reshape(contacts**2, -1) for part in carried)
        return cls(poles.astype(complex), shapes, tuple(entered), flat)


@dataclass(frozen=True, slots=True, eq=False)
class Part(Remembering):
    """A part of a vehicle that moves on its own, all of it or one vehicle of a convoy; made by `parts`.

    Parameters
    ----------
    dofs, contacts : ndarray
        Numbers of its degrees of freedom and contacts within the vehicle.
    motion : Split
        Its free and prescribed motion.
    own : Quadratic
        P: dynamic stiffness of the free coordinates.
    entry : Quadratic
        H: force on the free coordinates per displacement below the contacts, shape (free, contact).
    direct : Quadratic
        E: force at the contacts per displacement below them, the free coordinates held, shape (contact, contact).
    modes : Modes or None
        Of the free coordinates; None if a mode is defective, or so nearly that it carries no digits.
    """

    dofs: IntArray
    contacts: IntArray
    motion: Split
    own: Quadratic
    entry: Quadratic
    direct: Quadratic
    modes: Modes | None

    def response(self, omega: ComplexArray, displacement: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
        """Motion (*case, dof, frequency) and contact force for a displacement, both (*case, contact, frequency)."""
        if self.numbers and (loops := loops_for("vehicles.compiled", self.numbers.poles.size * omega.size)):
            cases = handed(displacement).reshape(-1, *displacement.shape[-2:])
            found = loops.response(self.numbers, handed(omega), cases, 0)
            motion, force = (part.reshape(*displacement.shape[:-2], *part.shape[1:]) for part in found)
            return motion, force
        free = self._free(omega, displacement)
        if not self.motion.prescribed.any():
            moved = free
        else:
            moved = self.motion.free @ free
            moved += self.motion.prescribed @ displacement
        force = self.entry.transposed().times(omega, free)
        force -= self.direct.times(omega, displacement)
        return moved, force

    @property
    @remembered
    def numbers(self) -> Numbers | None:
        """What compiled loops take, where they gain on BLAS: of few modes."""
        modes = self.modes
        if modes is None or modes.poles.size > SOLUTION.few:
            return None
        contacts, pushing = len(self.contacts), [part.T @ modes.shapes for part in self.entry]
        powers = 1 + max(power for power, _ in (*self.entry.terms(), *self.direct.terms()))
        carried = range(max(powers, *(power + 1 for power, part in enumerate(modes.carried) if part is not None)))
        nothing = np.zeros((modes.poles.size, contacts)), np.zeros((contacts**2, modes.poles.size))
        return Numbers(
            modes.poles,
            np.array([nothing[1] if modes.carried[n] is None else modes.carried[n] for n in carried], complex),
            np.array([self.direct[power] if power < 3 else 0.0 * self.direct[0] for power in carried]),
            np.array([nothing[0] if part is None else part for part in modes.entered[:powers]], complex),
            np.ascontiguousarray(self.motion.free @ modes.shapes),
            np.array(pushing[:powers], complex),
            self.motion.prescribed if self.motion.prescribed.any() else self.motion.prescribed[:, :0],
            SOLUTION.together,
        )

    def _free(self, omega: ComplexArray, displacement: ComplexArray) -> ComplexArray:
        """Free coordinates p = P⁻¹ H d, shape (*case, free, frequency)."""
        if not len(self.own.constant):
            return np.zeros((*displacement.shape[:-2], 0, omega.size), complex)
        if self.modes is None:
            pushed = self.entry.times(omega, displacement)
            # Frequency first, and a column for each case, is what LAPACK takes.
            columns = np.moveaxis(pushed.reshape(-1, *pushed.shape[-2:]), (2, 1), (0, 1))
            free = np.linalg.solve(np.moveaxis(self.own.at(omega), -1, 0), columns)
            return np.moveaxis(free, (0, 1), (2, 1)).reshape(pushed.shape)
        modes = self.modes
        entered = [None if part is None else part @ displacement for part in modes.entered]
        modal = _horner(1j * omega, entered, (*displacement.shape[:-2], modes.poles.size, omega.size))
        modal *= _admittance(omega, modes.poles)
        return modes.shapes @ modal

    def stiffness(self, omega: ComplexArray) -> ComplexArray:
        """Dynamic stiffness D = E − Hᵀ P⁻¹ H at its contacts, shape (contact, contact, frequency)."""
        if self.numbers and (loops := loops_for("vehicles.compiled", self.numbers.poles.size * omega.size)):
            count, found = len(self.contacts), loops.stiffness(self.numbers, handed(omega))
            return found.reshape(count, count, omega.size)
        direct = self.direct.at(omega)
        if not len(self.own.constant):
            return direct
        if self.modes is None:
            entry, own = (np.moveaxis(part.at(omega), -1, 0) for part in (self.entry, self.own))
            return direct - np.moveaxis(entry.swapaxes(1, 2) @ np.linalg.solve(own, entry), 0, -1)
        admittance = _admittance(omega, self.modes.poles)
        # Hᵀ P⁻¹ H power by power of iω: each is a sum over modes, one product of matrices for all frequencies.
        terms = [None if part is None else part @ admittance for part in self.modes.carried]
        direct -= _horner(1j * omega, terms, (direct[..., 0].size, omega.size)).reshape(direct.shape)
        return direct


class Alike(NamedTuple):
    """Parts that are the same but for where they stand, as the cars of a train: computed together."""

    part: Part  # the first of them
    dofs: IntArray  # (part, dof)
    contacts: IntArray  # (part, contact)


@dataclass(frozen=True, slots=True, eq=False)
class Dynamics(Remembering):
    """A vehicle at its contacts, ready to be asked at any frequency; `Vehicle.dynamics()` makes it.

    Parameters
    ----------
    parts : tuple of Part
        Parts that move independently of each other: one, or one per vehicle of a convoy.
    dofs, contacts : int
        Number of degrees of freedom and of contacts.
    """

    parts: tuple[Part, ...]
    dofs: int
    contacts: int

    @property
    @remembered
    def alike(self) -> tuple[Alike, ...]:
        """The parts, those together that are the same but for where they stand."""
        groups: dict[int, list[Part]] = {}
        for part in self.parts:
            groups.setdefault(id(part.own), []).append(part)
        return tuple(
            Alike(group[0], np.stack([part.dofs for part in group]), np.stack([part.contacts for part in group]))
            for group in groups.values()
        )

    @property
    def poles(self) -> ComplexArray:
        """Poles on a rigid road [rad/s], one of each conjugate pair, by ascending magnitude."""
        own = [np.tile(np.linalg.eigvals(state_matrix(part.own)), len(dofs)) for part, dofs, _ in self.alike]
        poles = np.concatenate(own).astype(complex)
        upper = poles[poles.imag >= 0]
        return upper[np.argsort(np.abs(upper), kind="stable")]

    def response(self, omega: ComplexArray, displacement: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
        """Motion and contact force of the vehicle that is displaced below its contacts.

        Parameters
        ----------
        omega : ndarray, shape (frequency,)
            Angular frequency [rad/s].
        displacement : ndarray, shape (*case, contact, frequency)
            Displacement below the contacts [m], positive down: deflection less elevation.

        Returns
        -------
        motion : ndarray, shape (*case, dof, frequency)
            Motion of each degree of freedom [m or rad].
        force : ndarray, shape (*case, contact, frequency)
            Dynamic contact force [N], compression positive: −D d.
        """
        if len(self.parts) == 1:
            return self.parts[0].response(omega, displacement)
        cases = displacement.shape[:-2]
        motion = np.empty((*cases, self.dofs, omega.size), complex)
        force = np.empty((*cases, self.contacts, omega.size), complex)
        for part, dofs, contacts in self.alike:
            below = displacement[..., contacts, :]
            motion[..., dofs, :], force[..., contacts, :] = part.response(omega, below)
        return motion, force

    def stiffness(self, omega: ComplexArray) -> ComplexArray:
        """Dynamic stiffness at the contacts.

        Without rigid contacts it stays finite; moving all contacts as a rigid body costs nothing at rest.

        Parameters
        ----------
        omega : ndarray, shape (frequency,)
            Angular frequency [rad/s].

        Returns
        -------
        ndarray, shape (contact, contact, frequency)
            Force that the guideway exerts on the vehicle per displacement below the contacts [N/m].
        """
        if len(self.parts) == 1:
            return self.parts[0].stiffness(omega)
        stiffness = np.zeros((self.contacts, self.contacts, omega.size), complex)
        for part, _, contacts in self.alike:
            stiffness[contacts[:, :, None], contacts[:, None]] = part.stiffness(omega)
        return stiffness


def parts(
    mass: FloatArray,
    damping: FloatArray,
    stiffness: FloatArray,
    contact_map: FloatArray,
    springs: FloatArray,
    dashpots: FloatArray,
) -> tuple[Part, ...]:
    """Take a vehicle apart into what moves on its own.

    Parameters
    ----------
    mass, damping, stiffness : ndarray, shape (dof, dof)
        Matrices of the vehicle without its contact springs.
    contact_map : ndarray, shape (contact, dof)
        Displacement at each contact per degree of freedom.
    springs, dashpots : ndarray, shape (contact,)
        Contact stiffness, `inf` for rigid contacts, and contact damping.

    Returns
    -------
    tuple of Part
        In the order of their first degrees of freedom.
    """
    whole = Quadratic.of(mass, damping, stiffness)
    groups = _connected(np.sum([np.abs(part) for part in whole], axis=0), contact_map)
    found: dict[tuple[bytes, ...], Part] = {}
    return tuple(_part(whole, contact_map, springs, dashpots, dofs, found) for dofs in groups)


def held(
    own: Quadratic, contact_map: FloatArray, springs: FloatArray, dashpots: FloatArray
) -> tuple[Quadratic, FloatArray, Quadratic]:
    """Return A with the elastic contact springs in it, the rows of the elastic contacts, and their k(ω)."""
    elastic = np.isfinite(springs)
    rows = np.where(elastic[:, None], contact_map, 0.0)
    springs = np.where(elastic, springs, 0.0)
    k = Quadratic.of(np.zeros((len(rows), len(rows))), np.diag(dashpots), np.diag(springs))
    stiffer, damped = ((rows.T * each) @ rows for each in (springs, dashpots))
    return Quadratic(own.constant + stiffer, own.linear + damped, own.square), rows, k


def _part(
    whole: Quadratic,
    contact_map: FloatArray,
    springs: FloatArray,
    dashpots: FloatArray,
    dofs: IntArray,
    found: dict[tuple[bytes, ...], Part],
) -> Part:
    """Make a part; of those that are the same as one that was found, only where they stand is new."""
    contacts = np.flatnonzero(np.abs(contact_map[:, dofs]).any(axis=1))
    rows, springs, dashpots = contact_map[np.ix_(contacts, dofs)], springs[contacts], dashpots[contacts]
    own = Quadratic(*(part[np.ix_(dofs, dofs)] for part in whole))
    same = tuple(part.tobytes() for part in (*own, rows, springs, dashpots))
    if same in found:
        return replace(found[same], dofs=dofs, contacts=contacts)
    motion = split(rows, np.isinf(springs))
    assert motion is not None  # the vehicle has checked that
    impedance, elastic, k = held(own, rows, springs, dashpots)
    if not np.isinf(springs).any():
        entry = Quadratic(*(elastic.T @ c for c in k))
        found[same] = Part(dofs, contacts, motion, impedance, entry, k, Modes.of(impedance, entry))
        return found[same]
    free, prescribed = motion.free, motion.prescribed
    entry = Quadratic(*(free.T @ (elastic.T @ c - a @ prescribed) for c, a in zip(k, impedance, strict=True)))
    direct = Quadratic(
        *(
            c - c @ elastic @ prescribed - (c @ elastic @ prescribed).T + prescribed.T @ a @ prescribed
            for c, a in zip(k, impedance, strict=True)
        )
    )
    own = impedance.mapped(free.T, free)
    found[same] = Part(dofs, contacts, motion, own, entry, direct, Modes.of(own, entry))
    return found[same]


def _connected(coupling: FloatArray, contact_map: FloatArray) -> Sequence[IntArray]:
    """Degrees of freedom that act on each other, directly or by way of a contact, group by group."""
    touching = np.abs(contact_map)
    linked, left = coupling + touching.T @ touching > 0, np.ones(len(coupling), bool)
    groups: list[IntArray] = []
    while left.any():
        group = np.zeros_like(left)
        grown = np.arange(left.size) == left.argmax()
        while grown.sum() > group.sum():
            group, grown = grown, grown | linked[grown].any(axis=0)
        groups.append(np.flatnonzero(group))
        left &= ~group
    return groups


def state_matrix(own: Quadratic) -> FloatArray:
    """Rates of displacement and velocity per displacement and velocity."""
    mass = own.square
    rates = np.linalg.solve(mass, np.hstack([-own.constant, -own.linear]))
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

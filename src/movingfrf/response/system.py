"""What is solved, frequency by frequency: a vehicle on a guideway, or prescribed forces on one.

Below contact j the vehicle is moved by d = w − r, the deflection (down) less the elevation (up). It answers with
the dynamic force F = −D d, the guideway with w = G F. Hence (I + D G) F = D R: one small linear system per
frequency, at the ports where the two meet. Axes are (*case, port, frequency).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import pairwise
from typing import Any, NamedTuple, cast

import numpy as np

from movingfrf._basics.arrays import BoolArray, ComplexArray, FloatArray, IntArray, handed
from movingfrf._basics.compiling import loops_for
from movingfrf._basics.remembered import Remembering, latest, recalled, remembered, sharing
from movingfrf.guideways.guideway import Guideway
from movingfrf.guideways.track import Track
from movingfrf.guideways.waves import Seen, refuse, require_finite, waves
from movingfrf.response.along import CarByCar, Order, in_order, with_diagonal
from movingfrf.response.batches import BATCH, applied, multiplied, solved
from movingfrf.response.line import Histories, Line
from movingfrf.response.truncation import Truncation
from movingfrf.vehicles.dynamics import Dynamics, Numbers
from movingfrf.vehicles.vehicle import Vehicle


@dataclass(frozen=True, slots=True, eq=False)
class Tables:
    """Both sides of the ports at some frequencies, whatever the roughness.

    Parameters
    ----------
    omega : ndarray, shape (frequency,)
        Frequencies [rad/s].
    frf : ndarray, shape (receiver, source, frequency)
        Moving FRF G [m/N].
    stiffness : ndarray, shape (port, port, frequency)
        Dynamic stiffness D of the vehicle [N/m].
    """

    omega: ComplexArray
    frf: ComplexArray
    stiffness: ComplexArray

    def between(self, first: int, last: int) -> Tables:
        """Take some of the frequencies."""
        return Tables(*(part[..., first:last] for part in (self.omega, self.frf, self.stiffness)))

    def admitted(self, truncation: Truncation) -> Tables:
        """Let the guideway stiffen beyond a truncation."""
        return replace(self, frf=truncation.admitted(self.frf, self.omega))

    @property
    def matrix(self) -> ComplexArray:
        """I + D G, shape (port, port, frequency): singular at the poles of the coupled system."""
        return with_diagonal(multiplied(self.stiffness, self.frf))

    @property
    def pieces(self) -> list[tuple[int, ComplexArray]]:
        """Matrices (n, n, frequency) whose determinants, each to a power, multiply to that of I + D G: itself."""
        return [(1, self.matrix)]

    def carried(self, loads: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
        """Contact forces (I + D G)⁻¹ L [N] that loads leave [N], and deflections, all (*case, port, frequency)."""
        if found := self._compiled(loads, rough=False):
            return found
        force = solved(self.matrix, loads)
        return force, applied(self.frf, force)

    def coupled(self, roughness: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
        """Contact forces F = (I + D G)⁻¹ D R [N] and deflections G F [m], all (*case, port, frequency)."""
        return self._compiled(roughness, rough=True) or self.carried(applied(self.stiffness, roughness))

    def _compiled(self, given: ComplexArray, *, rough: bool) -> tuple[ComplexArray, ComplexArray] | None:
        """Answer compiled; None where that is not to be."""
        count = len(self.frf)
        if count > BATCH.looped or not (loops := loops_for("response.compiled", 0)):
            return None
        # Offset by offset, each from a contact to a contact.
        frf, cases = handed(self.frf.reshape(count * count, -1)), handed(given).reshape(-1, *given.shape[-2:])
        found = loops.coupled(frf, _each_from_each(count), handed(self.stiffness), cases, rough)
        force, deflection = (part.reshape(given.shape) for part in found)
        return force, deflection


@cache
def _each_from_each(count: int) -> IntArray:
    """Give every contact from every contact a number."""
    numbers = np.arange(count * count).reshape(count, count)
    numbers.setflags(write=False)
    return numbers


class Response(NamedTuple):
    """What the roughness adds to the steady state; each (*case, …, frequency), per case of roughness."""

    force: ComplexArray  # contact
    deflection: ComplexArray  # contact; beyond the truncation, where it is zero, left out
    motion: ComplexArray  # degree of freedom

    def histories(self, line: Line, finer: int = 1) -> CoupledHistories:
        """Transform to time, along the line on which the response was solved; several values for a sample."""
        asked = [(self.force, 0), (self.deflection, 0), (self.motion, 0), (self.motion, 2)]
        return CoupledHistories(*line.all_records(asked, finer))


class CoupledHistories(NamedTuple):
    """Histories of what the roughness adds to the steady state."""

    force: Histories  # [N]
    deflection: Histories  # [m]
    motion: Histories  # [m or rad]
    acceleration: Histories  # [m/s² or rad/s²]


class Distinct(NamedTuple):
    """Distinct offsets along the guideway, and which of them is that of a contact from a contact."""

    ahead: FloatArray  # (offset,) [m]
    which: IntArray  # (contact, contact)

    @classmethod
    def of(cls, offsets: FloatArray) -> Distinct:
        """Find those that are equal."""
        distinct, which = np.unique(offsets, return_inverse=True)
        return cls(distinct, which.reshape(offsets.shape))


class PerUnit(NamedTuple):
    """What is found per unit of roughness."""

    omega: bytes  # the frequencies
    found: FloatArray


class AtSpeed(NamedTuple):
    """A track as seen by whoever travels along it."""

    speed: float
    seen: Seen


class Moving(NamedTuple):
    """Moving FRFs of a track."""

    speed: float
    ahead: FloatArray  # (offset,) [m]
    omega: ComplexArray  # (frequency,)
    frf: ComplexArray  # (offset, frequency)


class Travelled(NamedTuple):
    """On what a vehicle travelled, how fast, and what is remembered of that."""

    guideway: Track
    speed: float
    memory: dict[str, Any]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class System(Remembering):
    """A guideway and a vehicle that travels on it.

    Parameters
    ----------
    guideway : Guideway
        The road.
    vehicle : Vehicle
        The vehicle.
    speed : float
        Speed [m/s].
    """

    guideway: Guideway
    vehicle: Vehicle
    speed: float

    @classmethod
    def of(cls, guideway: Guideway, vehicle: Vehicle, speed: float) -> System:
        """Put a vehicle on a guideway: with what is known if that is where it travelled last, and so fast.

        A track stays as it is; what other guideways do is theirs.
        """
        system = cls(guideway=guideway, vehicle=vehicle, speed=speed)
        if not isinstance(guideway, Track):
            return system
        known = latest(
            vehicle,
            "travelled",
            lambda known: known.guideway is guideway and known.speed == speed,
            lambda: Travelled(guideway, speed, {}),
        )
        return sharing(system, known.memory)

    @property
    def dynamics(self) -> Dynamics:
        """The vehicle at its contacts."""
        return self.vehicle.dynamics()

    @property
    def words(self) -> str:
        """What a message begins with that says what they have not."""
        return "vehicle and guideway have"

    @property
    @remembered
    def train(self) -> Order | None:
        """The vehicle from car to car, where it is solved so; None where all contacts are solved at once."""
        order = recalled(self.vehicle, "order along the road", lambda: in_order(self.vehicle))
        long = len(order.blocks) > 1 and self.ports > BATCH.at_once
        return order if long and isinstance(self.guideway, Track) else None

    @property
    def entries(self) -> int:
        """Entries of matrices at one frequency."""
        return self.ports * (2 * self.train.widest if self.train else self.ports)

    @property
    def ports(self) -> int:
        """Contacts."""
        return self.dynamics.contacts

    @property
    def kinds(self) -> tuple[int, ...]:
        """Contacts for forces and deflections, degrees of freedom for motions and accelerations."""
        contacts, dofs = self.dynamics.contacts, self.dynamics.dofs
        return contacts, contacts, dofs, dofs

    @property
    def seen(self) -> Seen:
        """The dynamic stiffness of a track as the vehicle sees it."""
        track, speed = cast("Track", self.guideway), self.speed
        found = latest(
            track,
            "as seen",
            lambda known: known.speed == speed,
            lambda: AtSpeed(speed, Seen.of(track.stiffness(), speed)),
        )
        return found.seen

    @property
    @remembered
    def _numbers(self) -> tuple[tuple[Any, ...], FloatArray, IntArray, Numbers] | None:
        """What compiled loops take of guideway, offsets and vehicle; None where they do not do it all at once."""
        parts = self.dynamics.parts
        fits = isinstance(self.guideway, Track) and not self.train and self.ports <= BATCH.looped
        vehicle = parts[0].numbers if len(parts) == 1 else None
        return (self.seen.numbers, *self.offsets, vehicle) if fits and vehicle else None

    def _require_finite(self, omega: ComplexArray, infinite: BoolArray, frf: ComplexArray) -> None:
        if infinite.any():
            refuse(infinite, self.speed, omega)
        require_finite(frf, self.speed, omega)

    @property
    def offsets(self) -> Distinct:
        """Offsets of contacts from contacts."""
        return recalled(self.vehicle, "distinct offsets", lambda: Distinct.of(self.vehicle.offsets["ahead"]))

    def at(self, omega: ComplexArray) -> Tables | CarByCar:
        """Evaluate both sides at some frequencies [rad/s], or take what was foreseen, once."""
        return self._foreseen.pop(omega.tobytes(), None) or self._evaluated(omega)

    def _evaluated(self, omega: ComplexArray) -> Tables | CarByCar:
        if self._numbers and (loops := loops_for("response.compiled", 0)):
            guideway, ahead, which, vehicle = self._numbers
            found, dynamic, infinite = loops.tables(guideway, ahead, vehicle, handed(omega))
            self._require_finite(omega, infinite, found)
            return Tables(omega, found[which], dynamic)
        if not isinstance(self.guideway, Track):
            frf = self.guideway.moving_frf(speed=self.speed, omega=omega, **self.vehicle.offsets)
            return Tables(omega, np.moveaxis(frf, 0, -1), self.dynamics.stiffness(omega))
        found = waves(self.seen, self.speed, omega)
        if self.train:
            return CarByCar(self.train, omega, found)
        distinct, which = self.offsets
        return Tables(omega, found.summed(distinct)[which], self.dynamics.stiffness(omega))

    def _lately(self, omega: ComplexArray) -> Tables | CarByCar:
        """Evaluate both sides, or take them again: many roads are solved at the same frequencies."""
        if self.train:
            return self.at(omega)

        def fits(known: Tables | Moving) -> bool:
            return known.omega.size == omega.size and bool((known.omega == omega).all())

        def compute() -> Tables:
            if not isinstance(self.guideway, Track):
                return cast("Tables", self.at(omega))
            distinct, which = self.offsets
            # Another vehicle with its contacts in the same places finds it there.
            moving = latest(
                self.guideway,
                "moving frf",
                lambda known: known.speed == self.speed and np.array_equal(known.ahead, distinct) and fits(known),
                lambda: Moving(self.speed, distinct, omega, self._moving(omega)),
            )
            return Tables(omega, moving.frf[which], self.dynamics.stiffness(omega))

        return latest(self, "solved", fits, compute)

    def _moving(self, omega: ComplexArray) -> ComplexArray:
        """Evaluate the moving FRF of a track at distinct offsets, shape (offset, frequency)."""
        if self._numbers and (loops := loops_for("response.compiled", 0)):
            guideway, ahead, _, _ = self._numbers
            found, infinite = loops.moving_frf(guideway, ahead, handed(omega))
            self._require_finite(omega, infinite, found)
            return cast("ComplexArray", found)
        return waves(self.seen, self.speed, omega).summed(self.offsets.ahead)

    def foresee(self, omegas: Sequence[ComplexArray]) -> None:
        """Evaluate both sides where `at` will be asked for them, as many sets in one go as a batch holds."""
        sizes = np.cumsum([0, *(omega.size for omega in omegas)])
        count = int(np.searchsorted(sizes, BATCH.frequencies(self.entries), side="right")) - 1
        if count < 2:
            return
        whole = self._evaluated(np.concatenate(omegas[:count]))
        for asked, (first, last) in zip(omegas, pairwise(sizes[: count + 1].tolist()), strict=False):
            self._foreseen[asked.tobytes()] = whole.between(first, last)

    @property
    @remembered
    def _foreseen(self) -> dict[bytes, Tables | CarByCar]:
        return {}

    def per_unit(self, omega: ComplexArray) -> FloatArray:
        """Magnitudes of what the guideway adds to each output, then of all of it, per roughness under each contact.

        Outputs are force and deflection at each contact, motion and acceleration of each degree of freedom; shape
        (2, contact, output, frequency). A rigid road changes the displacement under the contacts by −W, hence the
        force by D W and the motion by −H W.
        """
        if self._numbers and (loops := loops_for("response.compiled", 0)):
            asked = omega.tobytes()
            return latest(
                self,
                "per unit",
                lambda known: known.omega == asked,
                lambda: PerUnit(asked, self._per_unit(loops, omega)),
            ).found
        count, tables = self.ports, self.at(omega)
        # One case per contact under which the road is rough.
        unit = np.zeros((count, count, omega.size), complex)
        unit[np.arange(count), np.arange(count)] = 1.0
        force, deflection = tables.coupled(unit)
        answers, pushes = self.dynamics.response(omega, np.concatenate([deflection, unit]))
        moved, pushed, squared = answers[:count], pushes[:count], np.abs(omega) ** 2
        motion = moved - answers[count:]
        ends, sizes = np.cumsum(self.kinds).tolist(), np.empty((2, count, sum(self.kinds), omega.size))
        for found, outputs in zip(sizes, ((pushed, deflection, moved), (force, deflection, motion)), strict=True):
            for output, begin, end in zip(outputs, (0, *ends), ends, strict=False):
                np.abs(output, out=found[:, begin:end])
            np.multiply(squared, found[:, ends[1] : ends[2]], out=found[:, ends[2] :])
        return sizes

    def _per_unit(self, loops: Any, omega: ComplexArray) -> FloatArray:
        """Do the same compiled."""
        assert self._numbers
        tables, count = cast("Tables", self.at(omega)), self.ports
        frf = handed(tables.frf.reshape(count * count, -1))
        found: FloatArray = loops.per_unit(
            frf, _each_from_each(count), handed(tables.stiffness), self._numbers[-1], handed(omega)
        )
        return found

    def answer(self, omega: ComplexArray, roughness: ComplexArray, truncation: Truncation) -> Response:
        """Solve for the response to roughness [m], shape (*case, contact, frequency), at ascending frequencies.

        Where the guideway gives way the contact force solves (I + D G) F = D R; beyond the truncation G = 0. Either
        way the vehicle is moved by d = G F − R and everything follows from d.
        """
        reach = truncation.reach(omega)
        if not reach:
            motion, force = self.dynamics.response(omega, -roughness)
            return Response(force, roughness[..., :0], motion)
        tables = self._lately(omega[:reach])
        if self._numbers and isinstance(tables, Tables) and (loops := loops_for("response.compiled", 0)):
            count, kept = self.ports, truncation.taper(tables.omega)
            frf = tables.frf.reshape(count * count, -1)
            cases = handed(roughness).reshape(-1, *roughness.shape[-2:])
            found = loops.answered(
                frf, _each_from_each(count), tables.stiffness, self._numbers[-1], handed(omega), kept, cases
            )
            return Response(*(part.reshape(*roughness.shape[:-2], *part.shape[1:]) for part in found))
        tables, displacement = tables.admitted(truncation), -roughness
        solved_force, deflection = tables.coupled(roughness[..., :reach])
        displacement[..., :reach] += deflection
        motion, force = self.dynamics.response(omega, displacement)
        # Near a resonance of the vehicle between held contacts D d would lose digits that (I + D G)⁻¹ D R has.
        force[..., :reach] = solved_force
        return Response(force, deflection, motion)


class Yielding(NamedTuple):
    """What prescribed forces do."""

    deflection: ComplexArray  # (*case, point, frequency)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Prescribed:
    """A guideway under prescribed forces that travel along it, seen from points that do so too.

    Parameters
    ----------
    guideway : Guideway
        The road.
    loads, points : ndarray, shape (load,) and (point,)
        Where forces act and deflections are observed, in the frame that travels along [m].
    speed : float
        Speed [m/s].
    """

    guideway: Guideway
    loads: FloatArray
    points: FloatArray
    speed: float

    @property
    def words(self) -> str:
        """What a message begins with that says what they have not."""
        return "the guideway has"

    @property
    def entries(self) -> int:
        """Entries of a matrix at one frequency."""
        return self.loads.size * self.points.size

    @property
    def ports(self) -> int:
        """Loads and points."""
        return self.loads.size + self.points.size

    @property
    def kinds(self) -> tuple[int, ...]:
        """Points, all of them for deflections."""
        return (self.points.size,)

    def per_unit(self, omega: ComplexArray) -> FloatArray:
        """Magnitude of the deflection per unit of each load, all the guideway's: (2, load, point, frequency)."""
        size = np.abs(self._frf(omega)).swapaxes(0, 1)
        return np.stack([size, size])

    def _frf(self, omega: ComplexArray) -> ComplexArray:
        """Evaluate the moving FRF [m/N], shape (point, load, frequency)."""
        return np.moveaxis(self.guideway.moving_frf(self.points[:, None] - self.loads, self.speed, omega), 0, -1)

    def answer(self, omega: ComplexArray, force: ComplexArray, truncation: Truncation) -> Yielding:
        """Deflection G F [m] under forces [N], shape (*case, load, frequency); a truncation is the caller's."""
        return Yielding(applied(self._frf(omega), force))

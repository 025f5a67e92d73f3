"""A train on its guideway, solved car by car: what runs from car to car is the waves of the guideway.

Cars know of each other only by those waves, so that (I + D G) F = D R is solved by elimination along the train, at
a cost in proportion to the cars. A block is a car, or several that overlap. With S = (I + D G)⁻¹ D of one block,
C what its contacts see of waves that arrive and E what leaves as waves of each force,

    F = S (R − C a),   b = T a + E F = (T − E S C) a + E S R,

a and b the amplitudes of the waves that arrive and leave, T what is left of a wave past the length of the block.
From the rear to the front, what arrives from behind is an answer to what arrives from ahead, a₊ = U a₋ + h; then
back from the front, where nothing arrives, to the rear. Every factor is a wave that decays: none exceeds one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import ComplexArray, FloatArray, IntArray
from movingfrf.guideways.waves import Waves
from movingfrf.response.batches import applied, multiplied, solved
from movingfrf.response.truncation import Truncation
from movingfrf.vehicles.dynamics import Part
from movingfrf.vehicles.vehicle import Vehicle


class Kind(NamedTuple):
    """Blocks that are the same but for where they stand."""

    parts: tuple[tuple[Part, IntArray], ...]  # what moves on its own, and the numbers of its contacts in the block
    places: FloatArray  # (contact,) from the rearmost one [m]

    @property
    def length(self) -> float:
        """From the rearmost contact to the foremost [m]."""
        return float(self.places.max())

    def stiffness(self, omega: ComplexArray) -> ComplexArray:
        """Dynamic stiffness D [N/m], shape (contact, contact, frequency)."""
        stiffness = np.zeros((self.places.size, self.places.size, omega.size), complex)
        for part, own in self.parts:
            stiffness[own[:, None], own] = part.stiffness(omega)
        return stiffness


class Order(NamedTuple):
    """A vehicle as blocks that stand one behind the other, from the rear."""

    blocks: tuple[IntArray, ...]  # numbers of the contacts of each
    kind: tuple[int, ...]  # of each block
    kinds: tuple[Kind, ...]
    gaps: tuple[float, ...]  # behind each block, from the foremost contact of the one before [m]; of the first 0

    @property
    def widest(self) -> int:
        """Most contacts of a block."""
        return max(block.size for block in self.blocks)


def in_order(vehicle: Vehicle) -> Order:
    """Put what moves on its own in order along the road; what overlaps becomes one block.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle.

    Returns
    -------
    Order
        From the rear.
    """
    places, groups, front = vehicle.positions, list[list[Part]](), -np.inf
    standing = [part for part in vehicle.dynamics().parts if part.contacts.size]
    for part in sorted(standing, key=lambda part: float(places[part.contacts].min())):
        if not groups or places[part.contacts].min() <= front:
            groups = groups or [[]]
        else:
            groups.append([])
        groups[-1].append(part)
        front = max(front, float(places[part.contacts].max()))
    blocks, kind, gaps = list[IntArray](), list[int](), list[float]()
    kinds: dict[tuple[object, ...], tuple[int, Kind]] = {}
    front = places.min()
    for group in groups:
        contacts = np.concatenate([part.contacts for part in group])
        rear = places[contacts].min()
        ends = np.cumsum([part.contacts.size for part in group])
        own = np.split(np.arange(contacts.size), ends[:-1])
        made = Kind(tuple(zip(group, own, strict=True)), places[contacts] - rear)
        # To nine digits after the point, as offsets are: equal cars differ by rounding.
        same = (*(id(part.own) for part in group), np.round(made.places, 9).tobytes())
        number, _ = kinds.setdefault(same, (len(kinds), made))
        blocks.append(contacts)
        kind.append(number)
        gaps.append(round(float(rear - front), 9))
        front = places[contacts].max()
    return Order(tuple(blocks), tuple(kind), tuple(made for _, made in kinds.values()), tuple(gaps))


class Running(NamedTuple):
    """Waves by the way that they run, first those that run ahead; κ is that along their way, Im κ ≥ 0."""

    kappa: ComplexArray  # (wave, frequency) [rad/m]
    weight: ComplexArray  # (wave, frequency) [m/N]; zero where there are fewer than elsewhere
    ahead: int  # how many run ahead

    @classmethod
    def of(cls, waves: Waves) -> Running:
        """Sort waves; how many run ahead may change from frequency to frequency."""
        order = np.argsort(~waves.forward, axis=0, kind="stable")
        kappa, weight = (np.take_along_axis(part, order, axis=0) for part in (waves.kappa, waves.weight))
        forward = np.take_along_axis(waves.forward, order, axis=0)
        # At least one each way, be its weight zero: above the speed of all waves none runs ahead.
        ahead, behind = (int(way.sum(axis=0).max(initial=1)) for way in (forward, ~forward))
        last = len(kappa) - behind
        belongs = np.concatenate([forward[:ahead], ~forward[last:]])
        along_their_way = np.where(belongs, np.concatenate([kappa[:ahead], -kappa[last:]]), 0.0)
        return cls(along_their_way, np.where(belongs, np.concatenate([weight[:ahead], -weight[last:]]), 0.0), ahead)

    def over(self, distances: FloatArray | float) -> ComplexArray:
        """Tell what is left of waves past some distances [m] ≥ 0, shape (*distance, wave, frequency)."""
        return np.exp(1j * np.asarray(distances)[..., None, None] * self.kappa)


class Passed(NamedTuple):
    """A kind of block between waves that arrive and leave, those ahead first; frequency last."""

    stiffness: ComplexArray  # S (contact, contact) [N/m]
    frf: ComplexArray  # G of the block alone (contact, contact) [m/N]
    matrix: ComplexArray  # I + D G (contact, contact)
    seen: ComplexArray  # C (contact, wave)
    sent: ComplexArray  # E (wave, contact)
    held: ComplexArray  # S C (contact, wave)
    through: ComplexArray  # T − E S C (wave, wave)

    @classmethod
    def of(cls, kind: Kind, running: Running, omega: ComplexArray) -> Passed:
        """Let waves pass a kind of block."""
        places, length, ahead = kind.places, kind.length, running.ahead
        offsets = places[:, None] - places
        wanted = np.stack(
            [np.broadcast_to(part, offsets.shape) for part in (np.abs(offsets), places, length - places)]
        )
        distances, back = np.unique(np.round(wanted, 9), return_inverse=True)
        kept = running.over(distances)
        between, from_rear, to_front = back.reshape(wanted.shape)
        from_rear, to_front = from_rear[0], to_front[0]
        seen = np.concatenate([kept[from_rear, :ahead], kept[to_front, ahead:]], axis=1)
        sent = np.concatenate([kept[to_front, :ahead], kept[from_rear, ahead:]], axis=1) * running.weight
        weighted = kept * running.weight
        ways = np.stack([weighted[:, ahead:].sum(axis=1), weighted[:, :ahead].sum(axis=1)])
        frf, stiffness = ways[(offsets >= 0).astype(int), between], kind.stiffness(omega)
        matrix = with_diagonal(multiplied(stiffness, frf))
        stiffness = solved(matrix, stiffness.swapaxes(0, 1)).swapaxes(0, 1)
        sent, held = sent.swapaxes(0, 1), multiplied(stiffness, seen)
        through = -multiplied(sent, held)
        for wave, whole in enumerate(running.over(length)):
            through[wave, wave] += whole
        return cls(stiffness, frf, matrix, seen, sent, held, through)


class Met(NamedTuple):
    """How a block meets what lies behind it: a₊ = R b₋ + …, as an answer to what arrives from ahead."""

    matrix: ComplexArray  # M = I − R (T − E S C)₋₊ (ahead, ahead)
    inverse: ComplexArray  # M⁻¹ (ahead, ahead)
    turned: ComplexArray  # M⁻¹ R (ahead, behind)
    answer: ComplexArray  # U = M⁻¹ R (T − E S C)₋₋ (ahead, behind)


@dataclass(frozen=True, slots=True, eq=False)
class CarByCar:
    """Both sides of the ports of a train at some frequencies, block by block; `Tables` has them all at once.

    Parameters
    ----------
    order : Order
        The vehicle.
    omega : ndarray, shape (frequency,)
        Frequencies [rad/s].
    waves : Waves
        Of the guideway.
    """

    order: Order
    omega: ComplexArray
    waves: Waves

    def between(self, first: int, last: int) -> CarByCar:
        """Take some of the frequencies."""
        kappa, weight, forward = self.waves
        some = Waves(kappa[:, first:last], weight[:, first:last], forward[:, first:last])
        return CarByCar(self.order, self.omega[first:last], some)

    def admitted(self, truncation: Truncation) -> CarByCar:
        """Let the guideway stiffen beyond a truncation."""
        weight = truncation.admitted(self.waves.weight, self.omega)
        return replace(self, waves=self.waves._replace(weight=weight))

    def coupled(self, roughness: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
        """Contact forces F = (I + D G)⁻¹ D R [N] and deflections G F [m], all (*case, contact, frequency)."""
        return self._swept(roughness, lambda block, under: applied(block.stiffness, under))

    def carried(self, loads: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
        """Contact forces (I + D G)⁻¹ L [N] under loads [N], and deflections, all (*case, contact, frequency)."""
        return self._swept(loads, lambda block, load: solved(block.matrix, load))

    @property
    def pieces(self) -> list[tuple[int, ComplexArray]]:
        """Matrices (n, n, frequency) whose determinants, each to a power, multiply to that of I + D G."""
        running, passed = self._passed()
        pieces = [(self.order.kind.count(number), one.matrix) for number, one in enumerate(passed)]
        met = self._met(running, passed)[1:]
        # Their determinants: the order of the waves, and with it that of rows and columns, may change.
        return pieces + [(1, determinants(one.matrix)[None, None]) for one in met]

    def _passed(self) -> tuple[Running, list[Passed]]:
        running = Running.of(self.waves)
        return running, [Passed.of(kind, running, self.omega) for kind in self.order.kinds]

    def _met(self, running: Running, passed: list[Passed]) -> list[Met]:
        """Eliminate from the rear to the front."""
        ahead, waves, frequencies = running.ahead, *running.kappa.shape
        turned: ComplexArray = np.zeros((ahead, waves - ahead, frequencies), complex)
        unit = np.broadcast_to(np.eye(ahead, dtype=complex)[:, :, None], (ahead, ahead, frequencies))
        found, before = list[Met](), passed[self.order.kind[0]].through
        for number, gap in zip(self.order.kind, self.order.gaps, strict=True):
            through = passed[number].through
            if found:
                kept = running.over(gap)
                turned = multiplied(before[:ahead, :ahead], found[-1].answer) + before[:ahead, ahead:]
                turned *= kept[:ahead, None] * kept[ahead:]
            matrix = with_diagonal(-multiplied(turned, through[ahead:, :ahead]))
            both = solved(matrix, np.concatenate([unit, turned], axis=1).swapaxes(0, 1)).swapaxes(0, 1)
            inverse, met = both[:, :ahead], both[:, ahead:]
            found.append(Met(matrix, inverse, met, multiplied(met, through[ahead:, ahead:])))
            before = through
        return found

    def _swept(
        self, given: ComplexArray, by_itself: Callable[[Passed, ComplexArray], ComplexArray]
    ) -> tuple[ComplexArray, ComplexArray]:
        """Solve for forces and deflections, from the forces that a block by itself makes of what is given."""
        running, passed = self._passed()
        met, ahead = self._met(running, passed), running.ahead
        kept = {gap: running.over(gap) for gap in set(self.order.gaps)}
        blocks = list(zip(self.order.blocks, self.order.kind, self.order.gaps, met, strict=True))
        before = passed[self.order.kind[0]].through
        alone, sent, arrived = list[ComplexArray](), list[ComplexArray](), list[ComplexArray]()
        # From the rear to the front: what a block does alone, and what of it arrives ahead.
        for contacts, number, gap, one in blocks:
            block = passed[number]
            alone.append(by_itself(block, given[..., contacts, :]))
            sent.append(applied(block.sent, alone[-1]))
            arriving = applied(one.turned, sent[-1][..., ahead:, :])
            if arrived:
                behind = (applied(before[:ahead, :ahead], arrived[-1]) + sent[-2][..., :ahead, :]) * kept[gap][
                    :ahead
                ]
                arriving += applied(one.inverse, behind)
            arrived.append(arriving)
            before = block.through
        # From the front to the rear.
        force, deflection = np.empty_like(given), np.empty_like(given)
        back: ComplexArray = np.zeros((*given.shape[:-2], len(running.kappa) - ahead, given.shape[-1]), complex)
        for place in reversed(range(len(blocks))):
            contacts, number, gap, one = blocks[place]
            block = passed[number]
            arriving = np.concatenate([arrived[place] + applied(one.answer, back), back], axis=-2)
            held = alone[place] - applied(block.held, arriving)
            force[..., contacts, :] = held
            deflection[..., contacts, :] = applied(block.frf, held) + applied(block.seen, arriving)
            back = (applied(block.through[ahead:], arriving) + sent[place][..., ahead:, :]) * kept[gap][ahead:]
        return force, deflection


def with_diagonal(matrices: ComplexArray) -> ComplexArray:
    """Add the unit matrix, in place, to matrices of shape (n, n, frequency)."""
    for number in range(len(matrices)):
        matrices[number, number] += 1.0
    return matrices


def determinants(matrices: ComplexArray) -> ComplexArray:
    """Take the determinants of matrices of shape (n, n, frequency)."""
    found: ComplexArray = np.linalg.det(np.moveaxis(matrices, -1, 0))
    return found

"""Marching through time: a finite guideway and, on it, a vehicle or prescribed forces.

Every method of this package that steps a guideway uses `March`: it factorises what is constant once and then
advances, compiled where numba is installed and the guideway is a chain of beam elements, in NumPy and LAPACK
otherwise.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sparse
from numpy.typing import ArrayLike

from movingfrf._basics.arrays import FloatArray, IntArray
from movingfrf._basics.checks import SolveError
from movingfrf._basics.compiling import usable
from movingfrf._basics.progress import Progress, silent
from movingfrf.stepping.exchange import SOLVED, Iteration, exchanged
from movingfrf.stepping.factors import BandSolver, SparseSolver, bands_of, half_width, indefinite, solver
from movingfrf.stepping.finite_guideway import ELEMENT_ROUNDING, FiniteGuideway
from movingfrf.stepping.finite_track import CubicRows
from movingfrf.stepping.half_step import HalfStep
from movingfrf.stepping.schemes import Scheme
from movingfrf.stepping.tie import Tie


@dataclass(frozen=True, slots=True, kw_only=True)
class Stride:
    """How far a march goes between two looks at the keyboard; results do not depend on it.

    In brackets, between what each number is safe: below, calls take the time; above, an interruption comes late or
    rows take memory.
    """

    steps: int = 20_000  # [1000 to 20 000]
    work: int = 20_000_000  # unknowns times steps [1e6 to 2e7]
    # In NumPy, entries of interpolating rows, which are held for all these steps at once.
    entries: int = 1_000_000  # [1e4 to 1e7]
    # Unknowns that the compiled band solver needs at least: three from either end, and three in the middle.
    fewest_unknowns: int = 9


STRIDE = Stride()


@dataclass(slots=True)
class State:
    """Where a march has got to: motion of guideway and vehicle, forces on the guideway."""

    # Displacement, velocity and acceleration.
    guideway: FloatArray  # (3, dof)
    body: FloatArray  # (3, vehicle dof)
    acting: FloatArray  # (contact,)
    # Elements by which a travelling guideway has moved on.
    shifted: IntArray = field(default_factory=lambda: np.zeros(1, np.int64))

    def copied(self) -> State:
        """Return a state that can be marched on without changing this one."""
        return State(self.guideway.copy(), self.body.copy(), self.acting.copy(), self.shifted.copy())


class Trace(NamedTuple):
    """What was seen on the way; row k belongs to step k, row 0 to the state at the start."""

    force: FloatArray  # (time, contact) contact force without what was prescribed
    deflection: FloatArray  # (time, contact)
    observed: FloatArray  # (time, observer) deflection
    motion: FloatArray  # (time, dof)
    acceleration: FloatArray  # (time, dof)
    iterations: int


@dataclass(frozen=True, kw_only=True, eq=False)
class March:
    """One guideway, one scheme, one set of contacts: everything that stays constant, factorised once.

    Parameters
    ----------
    guideway : FiniteGuideway
        The guideway.
    scheme : Scheme
        Row of the scheme.
    time_step : float
        Step in time [s].
    speed : float
        Speed of the contacts [m/s].
    contacts, observers : ndarray
        Where they stand at step 0 [m].
    tie : Tie
        What happens at the contacts.
    iteration : Iteration
        How contact forces are found.
    compiled : bool, optional
        Whether to use the compiled loops; None: where they apply and numba is installed.
    observers_travel : bool
        Whether observers travel with the contacts or stand still.
    contacts_across, observers_across : array_like
        Where they stand left of the centre line [m].
    """

    guideway: FiniteGuideway
    scheme: Scheme
    time_step: float
    speed: float
    contacts: FloatArray
    observers: FloatArray
    tie: Tie
    iteration: Iteration = SOLVED
    compiled: bool | None = None
    observers_travel: bool = True
    contacts_across: ArrayLike = 0.0
    observers_across: ArrayLike = 0.0

    def at_rest(self, step: int = 0) -> State:
        """Everything at zero, at a step of the journey."""
        state = State(
            np.zeros((3, self.guideway.dofs)), np.zeros((3, len(self.tie.mass))), np.zeros(self.contacts.size)
        )
        if self.guideway.travels:
            state.shifted[0] = self._elements(np.array(step))
        return state

    def places(self, step: int) -> FloatArray:
        """Where the contacts stand at a step of the journey, seen from the guideway at rest there [m]."""
        return self._places(self.contacts, step, self.at_rest(step))

    def released(self, state: State, force: FloatArray) -> None:
        """Give the guideway the acceleration that fits its displacement, its velocity and forces on it (dof,)."""
        u, v, _ = state.guideway
        force = force - self.guideway.stiffness @ u - self.guideway.damping @ v
        state.guideway[2] = self.mass_solver.solve(force)

    def begun(self, state: State, roughness: FloatArray, rate: FloatArray, load: FloatArray, step: int = 0) -> None:
        """Give a state the contact forces and accelerations that fit it and the guideway under the contacts.

        Parameters
        ----------
        state : State
            Displacements and velocities; forces and accelerations are set.
        roughness, rate, load : ndarray, shape (contact,)
            Elevation [m], its rate [m/s] and prescribed forces [N] at this instant.
        step : int
            Step of the journey at which the state stands.
        """
        tie, guideway = self.tie, self.guideway
        (u, v, _), (z, dz, _) = state.guideway, state.body
        at = self._places(self.contacts, step, state)
        rows = guideway.rows(at, 0, self.contacts_across)
        force = tie.springs * (tie.contact_map @ z - rows @ u + roughness)
        if tie.dashpots.any():
            sinking = rows @ v + self.speed * (guideway.rows(at, 1, self.contacts_across) @ u)
            force += tie.dashpots * (tie.contact_map @ dz - sinking + rate)
        state.acting[:] = force + load
        state.body[2] = self.half.balanced(state.body, force)
        self.released(state, rows.T @ state.acting)

    def prepare(self) -> None:
        """Factorise now what the first step, or its beginning, would otherwise factorise."""
        _ = self._tables if self.uses_compiled else self._solver
        _ = self.half, self.mass_solver

    def run(
        self,
        steps: int,
        state: State,
        *,
        roughness: FloatArray,
        rate: FloatArray,
        loads: FloatArray,
        origin: int = 0,
        stage: str = "stepping",
        progress: Progress = silent,
    ) -> Trace:
        """Advance by some steps; `state` is advanced in place.

        Parameters
        ----------
        steps : int
            Number of steps.
        state : State
            Where to start; where it has got to, afterwards.
        roughness, rate : ndarray, shape (steps + 1, contact)
            Elevation [m] and its rate of change [m/s] under the contacts.
        loads : ndarray, shape (steps + 1, contact) or (1, contact)
            Prescribed forces on the guideway [N]; one row: constant.
        origin : int
            Step of the journey at which `state` stands.
        stage : str
            Name of the stage for `progress`.
        progress : callable
            Called with the name of the stage and the fraction of it that is done.

        Returns
        -------
        Trace
            With `steps + 1` rows.

        Raises
        ------
        SolveError
            If the exchange of contact forces does not come to agree, or a result is not finite.
        """
        contacts, dofs = self.contacts.size, len(self.tie.mass)
        widths = (contacts, contacts, self.observers.size, dofs, dofs)
        record: list[FloatArray] = [np.empty((steps + 1, width)) for width in widths]
        record[0][0] = state.acting - loads[0]
        watched = self._places(self.observers, origin, state) if self.observers_travel else self.observers
        touched = self.guideway.rows(self._places(self.contacts, origin, state), 0, self.contacts_across)
        record[1][0] = touched @ state.guideway[0]
        record[2][0] = self.guideway.rows(watched, 0, self.observers_across) @ state.guideway[0]
        record[3][0], record[4][0] = state.body[0], state.body[2]
        stride, advance = min(STRIDE.steps, STRIDE.work // self.guideway.dofs), self._compiled
        if not self.uses_compiled:
            entries = touched.nnz + self.observers.size
            stride, advance = min(stride, STRIDE.entries // max(entries, 1)), self._plain
        stride = max(stride, 1)
        iterations, begin = 0, 0
        while begin < steps:
            end = min(begin + stride, steps)
            failed, most = advance((origin, begin, end), state, roughness, rate, loads, record)
            iterations = max(iterations, most)
            if failed >= 0:
                raise SolveError(
                    f"the exchange of contact forces does not agree within {self.iteration.most} iterations "
                    f"at {failed * self.time_step:.6g} s and {self.speed:g} m/s (relative tolerance "
                    f"{self.iteration.tolerance:g}); a shorter time step than {self.time_step:g} s, or both sides "
                    "solved as one system, is needed"
                )
            if not np.isfinite(record[1][end]).all() or not np.isfinite(record[3][end]).all():
                raise SolveError(
                    f"the response grows beyond floating-point range by {end * self.time_step:.6g} s at "
                    f"{self.speed:g} m/s"
                )
            begin = end
            progress(stage, end / steps)
        force, deflection, observed, motion, acceleration = record
        return Trace(force, deflection, observed, motion, acceleration, iterations)

    def __post_init__(self) -> None:
        """Refuse compiled loops where they do not apply."""
        if self.compiled and not self._suits:
            raise ValueError(
                "compiled must be None or False: the compiled loops take roads of beam elements without layers of "
                "mass, as finite_track makes them"
            )

    @property
    def uses_compiled(self) -> bool:
        """Whether the compiled loops are used: where they apply and numba is installed, unless told otherwise."""
        return self._suits and usable("stepping.compiled") if self.compiled is None else self.compiled

    @cached_property
    def _suits(self) -> bool:
        """Whether the guideway is a chain of beam elements, with bands of half-width three."""
        guideway, rows = self.guideway, self.guideway.interpolation
        return (
            guideway.mesh is not None
            and isinstance(rows, CubicRows)
            and rows.mesh is guideway.mesh
            and guideway.dofs >= STRIDE.fewest_unknowns
            and max(half_width(matrix) for matrix in (guideway.mass, guideway.damping, guideway.stiffness)) <= 3
        )

    @cached_property
    def half(self) -> HalfStep:
        """The vehicle's half of a step, and the rule of the scheme."""
        return HalfStep.of(self.tie, self.scheme.over(self.time_step))

    @cached_property
    def effective(self) -> sparse.csc_array:
        """What a new acceleration of the guideway meets."""
        guideway = self.guideway
        return sparse.csc_array(self.half.rule.effective(guideway.mass, guideway.damping, guideway.stiffness))

    @cached_property
    def mass_solver(self) -> BandSolver | SparseSolver:
        """Solves with the guideway's mass matrix."""
        return solver(self.guideway.mass)

    @cached_property
    def _solver(self) -> BandSolver | SparseSolver:
        return solver(self.effective)

    @cached_property
    def _tables(self) -> dict[str, Any]:
        """What the compiled loops read."""
        from movingfrf.stepping import kernels

        guideway, n = self.guideway, self.guideway.dofs
        bands = [
            bands_of(matrix, 3) for matrix in (self.effective, guideway.mass, guideway.damping, guideway.stiffness)
        ]
        half = (n - 3) // 2
        rows, columns = np.zeros((half, 6)), np.zeros((half, 8))
        core: FloatArray = np.zeros((n - 2 * half, n - 2 * half))
        smallest = kernels.factorise(bands[0], rows, columns, core)
        if not smallest > 0 or not np.linalg.eigvalsh(core)[0] > 0:
            raise indefinite()
        core = np.linalg.inv(core)
        reach = self._reach(rows, columns, core)
        first = np.zeros(n, np.int64)
        needs_inverse = bool(len(self.tie.mass))
        inverse = kernels.inverse_rows(rows, columns, core, reach, first) if needs_inverse else np.zeros((1, 1))
        mesh = guideway.mesh
        assert mesh is not None
        return {
            "guideway": (*bands[1:], rows, columns, core, inverse, first),
            "mesh": (np.array([mesh.first, mesh.element]), mesh.number.astype(np.int64), guideway.travels),
        }

    def _reach(self, rows: FloatArray, columns: FloatArray, core: FloatArray) -> int:
        """Width outside which a row of the inverse is zero to rounding, judged in the middle of the guideway."""
        from movingfrf.stepping import kernels

        # Entries below this share of the largest are zero to rounding [1e-20 to 1e-16].
        negligible = 1e-17
        n = self.guideway.dofs
        reach = 0
        for unknown in (n // 2, n // 2 + 1):
            row = np.zeros(n)
            row[unknown] = 1.0
            kernels.solve(rows, columns, core, row, np.empty(len(core)))
            seen = np.flatnonzero(np.abs(row) > negligible * np.abs(row).max())
            reach = max(reach, int(np.abs(seen - unknown).max()))
        return min(n, 2 * reach + 4)

    def _compiled(
        self,
        steps: tuple[int, int, int],
        state: State,
        roughness: FloatArray,
        rate: FloatArray,
        loads: FloatArray,
        record: list[FloatArray],
    ) -> tuple[int, int]:
        from movingfrf.stepping import compiled

        loop: Callable[..., tuple[int, int]] = compiled.march
        return loop(
            self.half,
            *self._tables["guideway"],
            *self._tables["mesh"],
            self.contacts,
            self.observers,
            float(self.speed),
            self.observers_travel,
            np.ascontiguousarray(roughness),
            np.ascontiguousarray(rate),
            np.ascontiguousarray(loads),
            float(self.iteration.tolerance),
            self.iteration.most,
            state.guideway,
            state.body,
            state.acting,
            state.shifted,
            *steps,
            *record,
        )

    def _plain(
        self,
        steps: tuple[int, int, int],
        state: State,
        roughness: FloatArray,
        rate: FloatArray,
        loads: FloatArray,
        record: list[FloatArray],
    ) -> tuple[int, int]:
        """Advance as `compiled.march` does, one array operation after the other."""
        half, guideway = self.half, self.guideway
        dt, free_u, free_v, lift_u, lift_v, keep, alpha_m, alpha_f = half.rule
        mass, damping, stiffness = guideway.mass, guideway.damping, guideway.stiffness
        (u, v, a), body = state.guideway, state.body
        contacts, dashed = self.contacts.size, bool(self.tie.dashpots.any())
        worst = 0
        origin, begin, end = steps
        moved_on = self._elements(origin + np.arange(begin + 1, end + 1))
        steps_now = origin + np.arange(begin + 1, end + 1)
        touching, nobody = (self.contacts, self.contacts_across), (self.contacts[:0], 0.0)
        rows = self._rows(touching, steps_now, moved_on)
        slopes = self._rows(touching if dashed else nobody, steps_now, moved_on, derivative=1)
        before = self._rows(touching if alpha_f else nobody, steps_now - 1, moved_on)
        watched = self._rows(
            (self.observers, self.observers_across),
            steps_now if self.observers_travel else 0 * steps_now,
            moved_on,
        )
        for step in range(begin + 1, end + 1):
            now = step - begin - 1
            if guideway.travels:
                self._move_on(int(moved_on[now]), state)
            at, values = rows.at(now)
            load, earlier = loads[min(step, len(loads) - 1)], loads[min(step - 1, len(loads) - 1)]
            right = np.zeros((guideway.dofs, 1 + contacts), order="F")
            right[:, 0] = -(stiffness @ (u + keep * (dt * v + free_u * a))) - damping @ (v + keep * free_v * a)
            if alpha_m:
                right[:, 0] -= alpha_m * (mass @ a)
            if alpha_f:
                np.add.at(right[:, 0], before.at(now)[0], before.at(now)[1] * (alpha_f * state.acting)[:, None])
            for contact in range(contacts):
                np.add.at(right[:, 1 + contact], at[contact], keep * values[contact])
            right[:, 0] += right[:, 1:] @ load
            solved = self._solver.solve(right)
            free_a, per_force = solved[:, 0], solved[:, 1:]
            force: FloatArray = np.zeros(contacts)
            if body.size:
                free = half.freed(body, state.acting - earlier)
                moved = u + dt * v + free_u * a + lift_u * free_a
                yields = np.einsum("jq,jql->jl", values, per_force[at])
                down = (values * moved[at]).sum(axis=1)
                sinking: FloatArray | float = 0.0
                yielding: FloatArray | float = 0.0
                if dashed:
                    # The rate of the deflection under a contact is ẇ + v w′.
                    along, inclines = slopes.at(now)
                    sinking = (values * (v[at] + free_v * a[at] + lift_v * free_a[at])).sum(axis=1)
                    sinking += self.speed * (inclines * moved[along]).sum(axis=1)
                    yielding = lift_v * yields
                    yielding += self.speed * lift_u * np.einsum("jq,jql->jl", inclines, per_force[along])
                road = roughness[step], rate[step]
                matrix, gap = half.met(free, road, (down, sinking), (lift_u * yields, yielding))
                if self.iteration.tolerance:
                    force, count = exchanged(matrix, gap, state.acting - earlier, self.iteration)
                    if count < 0:
                        return step, worst
                    worst = max(worst, count)
                else:
                    force = np.linalg.solve(matrix, gap)
                half.taken(body, free, force)
            new = free_a + per_force @ force
            u += dt * v + free_u * a + lift_u * new
            v += free_v * a + lift_v * new
            a[:] = new
            state.acting[:] = force + load
            record[0][step], record[1][step] = force, (values * u[at]).sum(axis=1)
            if self.observers.size:
                seen, weights = watched.at(now)
                record[2][step] = (weights * u[seen]).sum(axis=1)
            record[3][step], record[4][step] = body[0], body[2]
            if alpha_m or alpha_f:
                # What such a scheme carries as acceleration belongs to a later instant; that of this one balances.
                record[4][step] = half.balanced(body, force)
        return -1, worst

    def _rows(
        self, places: tuple[FloatArray, ArrayLike], steps: IntArray, moved_on: IntArray, derivative: int = 0
    ) -> _Rows:
        """Rows of some places at some steps of the journey, on a guideway that has moved on by so many elements."""
        along, across = places
        travelled = self.speed * self.time_step * steps - moved_on * self.guideway.spacing
        positions = travelled[:, None] + along
        beside = np.broadcast_to(across, positions.shape).ravel()
        return _Rows.of(self.guideway.rows(positions.ravel(), derivative, beside), len(along))

    def _places(self, places: FloatArray, step: int, state: State) -> FloatArray:
        """Where contacts or observers stand at a step of the journey, seen from the guideway."""
        return places + (self.speed * self.time_step * step - state.shifted[0] * self.guideway.spacing)

    def _elements(self, steps: IntArray) -> IntArray:
        """Whole elements that a travelling guideway has moved on by some steps of the journey."""
        if not self.guideway.travels:
            return np.zeros(np.shape(steps), np.int64)
        elements = np.floor(self.speed * self.time_step * steps / self.guideway.spacing + ELEMENT_ROUNDING)
        return elements.astype(np.int64)

    def _move_on(self, elements: int, state: State) -> None:
        """Let a travelling guideway follow until it has moved on by so many elements."""
        elements -= int(state.shifted[0])
        if elements > 0:
            state.shifted[0] += elements
            gone = elements * self.guideway.column
            state.guideway[:, :-gone] = state.guideway[:, gone:].copy()
            state.guideway[:, -gone:] = 0.0


class _Rows(NamedTuple):
    """Sparse rows, one per place and step, filled up with zeros to equal length."""

    columns: IntArray  # (step · place, entry)
    values: FloatArray
    places: int

    @classmethod
    def of(cls, rows: sparse.csr_array, places: int) -> _Rows:
        """Fill rows up."""
        counts = np.diff(rows.indptr)
        entry = np.arange(rows.indices.size) - np.repeat(rows.indptr[:-1], counts)
        row = np.repeat(np.arange(counts.size), counts)
        shape = (counts.size, int(counts.max(initial=0)))
        columns, values = np.zeros(shape, np.int64), np.zeros(shape)
        columns[row, entry], values[row, entry] = rows.indices, rows.data
        return cls(columns, values, places)

    def at(self, step: int) -> tuple[IntArray, FloatArray]:
        """Columns and values of one step, shape (place, entry)."""
        some = slice(step * self.places, (step + 1) * self.places)
        return self.columns[some], self.values[some]

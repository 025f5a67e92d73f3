"""Prescribed loads that travel along a guideway."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

import movingfrf.results.findings as find
from movingfrf._basics.arrays import ComplexArray, FloatArray
from movingfrf._basics.checks import checking
from movingfrf._basics.progress import Progress, silent
from movingfrf._basics.spline import cubic
from movingfrf.guideways.guideway import Guideway, findings_of, require_guideway, told
from movingfrf.response.accuracy import hidden
from movingfrf.response.batches import unthreaded
from movingfrf.response.line import TRANSFORM, Given, Line, holds, require_record, together
from movingfrf.response.sampling import SAMPLING, Driving, Excited, excited
from movingfrf.response.solve import solve
from movingfrf.response.system import Prescribed
from movingfrf.response.truncation import Truncation
from movingfrf.results.labels import attributes, labelled, turned

if TYPE_CHECKING:
    import xarray as xr


def moving_loads(
    guideway: Guideway,
    force: ArrayLike,
    positions: ArrayLike,
    *,
    speed: float,
    time_step: float = 1e-3,
    observe: ArrayLike | None = None,
    truncation: float | None = None,
    progress: Progress = silent,
) -> xr.Dataset:
    """Deflection of a road under prescribed forces that travel along it, from rest at t = 0.

    Parameters
    ----------
    guideway : Guideway
        The road or track.
    force : array_like, shape (time, load)
        Forces [N], positive down; cubic splines between their samples. A force that is not zero at t = 0 is
        switched on at that instant. One that jumps later does so at an unknown instant between two samples: a
        finding says what that may change. Loads of a scenario are switched at the instants that it says.
    positions : array_like, shape (load,)
        Where the forces act, in the frame that travels with them [m], positive ahead.
    speed : float
        Common speed [m/s]; zero stands still, a negative one travels backwards.
    time_step : float
        Step in time [s].
    observe : array_like, shape (point,), optional
        Observation points in the same frame [m]; the loads' own by default.
    truncation : float, optional
        Frequency beyond which the response is left out [Hz], fading over the next 5 %; None leaves nothing out.
    progress : callable
        Called with the name of a stage and the fraction of it that is done.

    Returns
    -------
    xarray.Dataset
        `deflection` (time, point) [m] and `force` (time, load) [N].

    Raises
    ------
    ValueError
        If a value is impossible, shapes disagree, or memory does not hold the result.
    SolveError
        If a result is not finite.

    Warns
    -----
    ValidityWarning
        If the speed is near or above critical, the response has not decayed, a force jumps between two samples, or
        there is content beyond the truncation, or beyond what the steps of solution or output show.

    Examples
    --------
    >>> import movingfrf as mf
    >>> road = mf.track(mf.EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9),
    ...                 mf.Spring(stiffness=8.0e6, damping=3.0e4))
    >>> result = mf.moving_loads(road, np.full((2000, 1), 1e5), [0.0], speed=10.0)
    >>> round(1e3 * result.deflection[-1, 0].item(), 3)  # mm
    3.737
    """
    require_guideway(guideway)
    with checking() as check:
        at = check.array("positions", positions, "m", (None,))
        forces = check.array("force", force, "N", (None, at.size))
        points = at if observe is None else check.array("observe", observe, "m", (None,))
        speed = check.finite("speed", speed, "m/s")
        time_step = check.positive("time_step", time_step, "s")
        if truncation is not None:
            truncation = check.not_negative("truncation", truncation, "Hz")
        if not check.faults and (len(forces) < 2 or not at.size or not points.size):
            check.refuse("force", "must have at least two samples, one load and one observation point")
    prescribed = Forces(
        given=lambda line: line.given(forces.T),
        at=lambda times: _between(forces, time_step, times),
        sampled=forces,
        finest=time_step,
        jumps=isolated_jumps(forces),
    )
    return carried(
        Prescribed(guideway=guideway, loads=at, points=points, speed=speed),
        prescribed,
        time_step=time_step,
        truncation=truncation,
        progress=progress,
    )


class Forces(NamedTuple):
    """Prescribed forces over time."""

    given: Callable[[Line], Given]  # (load, instant) [N]
    at: Callable[[FloatArray], FloatArray]  # at some times [s], shape (time, load) [N]
    sampled: FloatArray  # at the steps of the record, shape (time, load) [N]
    finest: float = np.inf  # time within which they may change noticeably [s]
    jumps: FloatArray | None = None  # by which each load jumps somewhere within a step, shape (load,) [N]


@unthreaded
def carried(
    system: Prescribed,
    forces: Forces,
    *,
    time_step: float,
    truncation: float | None = None,
    progress: Progress = silent,
) -> xr.Dataset:
    """Deflection under prescribed forces: `moving_loads`, for functions of time.

    Parameters
    ----------
    system : Prescribed
        The guideway, where loads stand and deflections are observed, and their speed.
    forces : Forces
        The forces.
    time_step : float
        Step of the record [s].
    truncation : float, optional
        Frequency beyond which the response is left out [Hz].
    progress : callable
        Called with the name of a stage and the fraction of it that is done.

    Returns
    -------
    xarray.Dataset
        As `moving_loads` returns it.

    Raises
    ------
    ValueError
        If memory does not hold the result.
    SolveError
        If a result is not finite.
    """
    guideway, speed, samples = system.guideway, system.speed, len(forces.sampled)
    line = Line(samples=samples, time_step=time_step, cut=Truncation.stated(truncation).width)
    require_record(line, system.ports)
    progress("sampling", 0.0)
    # What changes sooner than the finest steps tell counts as abrupt.
    step = min(time_step, max(forces.finest, SAMPLING.loads.per_station * line.period / SAMPLING.loads.most))
    driven_by = excited(system, Driving(forces.given, step), line, truncation=np.inf, wanted=SAMPLING.loads)
    yielding = solve(system, driven_by.omega, driven_by.spectra, progress=progress).deflection
    progress("histories", 0.0)
    deflection, wrapped = _histories(driven_by, yielding)
    error = 0.0
    if truncation is not None:
        # What it leaves out is known: nothing else would tell how much that is.
        kept = Truncation(frequency=truncation).taper(driven_by.omega)
        left_out, _ = _histories(driven_by, yielding * (1.0 - kept))
        error = find.relative(np.sqrt((left_out**2).mean(axis=-1)), np.sqrt((deflection**2).mean(axis=-1)))
        deflection, yielding = deflection - left_out, yielding * kept
    critical_speed = float(guideway.critical_speed)
    above = hidden(line, together(yielding)[None], deflection[None], least=1.0).max(initial=0.0, keepdims=True)
    finer = int(np.ceil(time_step / driven_by.step)) if above.any() else 1
    fits = finer == 1 or holds(line, system.ports, finer)
    not_shown = find.not_shown(above, ["deflection"], time_step, kept=fits)
    found = [
        *find.near_critical(abs(speed), critical_speed),
        *findings_of(guideway),
        *find.not_decayed("deflection", wrapped, deflection),
        *find.beyond_truncation(truncation or 0.0, error),
        *find.jumps_within_a_step(_shifted(system, driven_by, forces, deflection), time_step),
        *find.loads_unresolved(driven_by.left_out, driven_by.step),
        *not_shown,
    ]
    values = {
        "time": line.time,
        "load": system.loads,
        "point": system.points,
        "force": forces.sampled,
        "deflection": turned(deflection),
    }
    if not_shown and fits:
        # What is measured is taken from the response in the steps in which it was solved.
        times = time_step / finer * np.arange(samples * finer)
        values |= {
            "solved_time": times,
            "solved_force": forces.at(times),
            "solved_deflection": turned(_histories(driven_by, yielding, finer)[0]),
        }
    settings = attributes(
        "loaded",
        "Response of a guideway to prescribed moving loads",
        method="moving-frf",
        speed=speed,
        time_step=time_step,
        solved_step=driven_by.step,
        # Where none is stated, whatever steps show: nothing is left out.
        truncation=0.5 / min(time_step, driven_by.step) if truncation is None else truncation,
        truncation_error=error,
        critical_speed=critical_speed,
        guideway=told(guideway),
        findings=found,
    )
    return labelled(values, settings)


def isolated_jumps(forces: FloatArray) -> FloatArray:
    """Find where sampled forces jump: what is smooth has no third differences like it, and noise has many.

    Parameters
    ----------
    forces : ndarray, shape (time, load)
        Forces [N].

    Returns
    -------
    ndarray, shape (load,)
        Largest isolated jump of each [N]; 0 if there is none.

    Examples
    --------
    >>> time = np.arange(100)
    >>> isolated_jumps(np.stack([5.0 * (time > 40), np.sin(0.1 * time), time % 3.0], axis=1)).tolist()
    [5.0, 0.0, 0.0]
    """
    reach = SAMPLING.alone
    third = np.diff(np.pad(forces, ((reach + 1, reach + 1), (0, 0)), mode="edge"), n=3, axis=0)
    # A jump J makes J, -2 J, J.
    middle = third[reach:-reach]
    size = 0.5 * np.abs(middle)
    others = np.zeros_like(size)
    for away in range(1, reach + 1):
        expected = -0.5 * middle if away == 1 else 0.0
        for shift in (-away, away):
            there = third[reach + shift : len(third) - reach + shift]
            others = np.maximum(others, np.abs(there - expected))
    found: FloatArray = np.where(others < SAMPLING.like * size, size, 0.0).max(axis=0)
    return found


def _between(forces: FloatArray, time_step: float, times: FloatArray) -> FloatArray:
    """Evaluate forces between their samples, as they are solved; past the last sample they stay."""
    known = time_step * np.arange(len(forces))
    return cubic(known, forces.T)(np.minimum(times, known[-1])).T


def _histories(driven_by: Excited, yielding: ComplexArray, finer: int = 1) -> tuple[FloatArray, FloatArray]:
    """Deflection (point, time) of all parts together, and what of it wraps around (point,)."""
    line = driven_by.line
    parts, wrapped = line.records(yielding, finer=finer)
    time = line.time_step / finer * np.arange(line.samples * finer)
    for part, begins in zip(parts, driven_by.begins, strict=True):
        # Nothing moves before: what is left out of a spectrum comes as a ripple on both sides.
        part[:, time <= begins + TRANSFORM.rounding * line.time_step] = 0.0
    return together(parts), wrapped.sum(axis=0)


def _shifted(system: Prescribed, driven_by: Excited, forces: Forces, deflection: FloatArray) -> float:
    """Tell what it changes, relative to the largest deflection of a point, if jumps come half a step later.

    A spline through the samples takes a jump to the middle of its step.
    """
    if forces.jumps is None or not forces.jumps.any():
        return 0.0
    line, jumps = driven_by.line, np.diag(forces.jumps)[forces.jumps > 0]
    impulses = (jumps[..., None] * driven_by.fade).astype(complex)
    # At once by half a step of the answer's rate, and never by more than the answer to the jump itself.
    s = 1j * driven_by.omega
    rates, steps = (
        np.abs(line.records(solve(system, driven_by.omega, given).deflection).values).max(axis=-1)
        for given in (impulses, impulses / s)
    )
    # Whether several jump at once is not asked.
    changed = np.sqrt((np.minimum(0.5 * line.time_step * rates, steps) ** 2).sum(axis=0))
    return find.relative(changed, np.abs(deflection).max(axis=-1))

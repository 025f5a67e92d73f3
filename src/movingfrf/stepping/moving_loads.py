"""Prescribed forces that travel along a finite guideway, stepped in time by Newmark's method."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from movingfrf._basics.arrays import FloatArray, require_memory
from movingfrf._basics.checks import checking
from movingfrf._basics.progress import Progress, silent
from movingfrf.results.labels import attributes, labelled
from movingfrf.stepping.finite_guideway import FiniteGuideway
from movingfrf.stepping.marching import March
from movingfrf.stepping.requirements import require_kind, require_on_guideway, require_stable_scheme
from movingfrf.stepping.schemes import Scheme, scheme_named
from movingfrf.stepping.tie import no_vehicle

if TYPE_CHECKING:
    import xarray as xr


def newmark_loads(
    road: FiniteGuideway,
    force: ArrayLike,
    positions: ArrayLike,
    *,
    speed: float,
    time_step: float = 1e-3,
    start: float = 0.0,
    observe: ArrayLike | None = None,
    scheme: str | Scheme = "average_acceleration",
    compiled: bool | None = None,
    progress: Progress = silent,
) -> xr.Dataset:
    """Deflection of a finite road under prescribed forces that travel along it, from rest at t = 0.

    Parameters
    ----------
    road : FiniteGuideway
        The road; see `finite_track`.
    force : array_like, shape (time, load)
        Forces at the steps [N], positive down. One that is not zero at t = 0 is switched on at that instant; one
        that jumps later rises over the step before.
    positions : array_like, shape (load,)
        Where the forces act, ahead of the frame that travels with them [m].
    speed : float
        Common speed [m/s]; zero stands still, a negative one travels backwards.
    time_step : float
        Step in time [s].
    start : float
        Distance of the frame's origin at t = 0 [m]; on a road that travels along it is 0.
    observe : array_like, shape (point,), optional
        Observation points in the same frame [m]; the loads' own by default.
    scheme : str or Scheme
        Time-stepping scheme, by name or as the row of its numbers.
    compiled : bool, optional
        Whether to use the compiled loops; None: where they apply and numba is installed.
    progress : callable
        Called with the name of a stage and the fraction of it that is done.

    Returns
    -------
    xarray.Dataset
        `deflection` (time, point) [m] and `force` (time, load) [N].

    Raises
    ------
    ValueError
        If a value is impossible, shapes disagree, the loads would leave the road, the scheme is unstable, or memory
        does not hold the result.
    SolveError
        If the road's matrices are inconsistent or a result is not finite.

    Examples
    --------
    >>> import movingfrf as mf
    >>> track = mf.track(mf.EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9),
    ...                  mf.Spring(stiffness=8.0e6, damping=3.0e4))
    >>> road = mf.finite_track(track, first=-20.0, last=40.0, element=0.5)
    >>> result = newmark_loads(road, np.full((2000, 1), 1e5), [0.0], speed=10.0)
    >>> round(1e3 * result.deflection[-1, 0].item(), 2)  # mm
    3.74
    """
    require_kind("road", road, FiniteGuideway, "finite road")
    with checking() as check:
        at = check.array("positions", positions, "m", (None,))
        forces = check.array("force", force, "N", (None, at.size))
        points = at if observe is None else check.array("observe", observe, "m", (None,))
        if not check.faults and (len(forces) < 2 or not at.size or not points.size):
            check.refuse("force", "must have at least two samples, one load and one observation point")
    return prepared_passage(
        road,
        at,
        points,
        speed=speed,
        time_step=time_step,
        samples=len(forces),
        start=start,
        scheme=scheme,
        compiled=compiled,
        progress=progress,
    )(forces)


def prepared_passage(
    road: FiniteGuideway,
    at: FloatArray,
    points: FloatArray,
    *,
    speed: float,
    time_step: float,
    samples: int,
    start: float = 0.0,
    scheme: str | Scheme = "average_acceleration",
    compiled: bool | None = None,
    progress: Progress = silent,
) -> Callable[[FloatArray], xr.Dataset]:
    """Check and prepare a passage: all that is the same whatever the forces, done once.

    Parameters
    ----------
    road, speed, time_step, start, scheme, compiled, progress
        As for `newmark_loads`.
    at, points : ndarray
        Where forces act, and where the deflection is wanted [m].
    samples : int
        Steps of the forces.

    Returns
    -------
    callable
        Steps through the passage of forces, shape (time, load) [N], and returns the result of `newmark_loads`.
    """
    with checking() as check:
        speed = check.finite("speed", speed, "m/s")
        time_step = check.positive("time_step", time_step, "s")
        start = check.finite("start", start, "m")
        row = scheme_named(check, scheme)
        if not check.faults and road.travels and (start or speed < 0):
            check.refuse(
                "start", f"must be 0 m, and the speed positive, on a road that travels along, got {start!r} m"
            )
    with checking() as check:
        # A guideway that travels along follows element by element.
        travelled = road.spacing if road.travels else speed * time_step * samples
        require_on_guideway(
            check,
            road,
            start + np.concatenate([at, points]),
            (min(0.0, travelled), max(0.0, travelled)),
            what="loads and observers travel",
        )
        require_stable_scheme(check, road, row, time_step)
    require_memory(16.0 * samples * (at.size + points.size), f"{samples} steps of {time_step:g} s")
    march = March(
        guideway=road,
        scheme=row,
        time_step=time_step,
        speed=speed,
        contacts=start + at,
        observers=start + points,
        tie=no_vehicle(at.size),
        compiled=compiled,
    )
    march.prepare()

    def step(forces: FloatArray) -> xr.Dataset:
        state = march.at_rest()
        state.acting[:] = forces[0]
        march.released(state, road.rows(march.places(0)).T @ forces[0])
        nothing: FloatArray = np.zeros_like(forces)
        trace = march.run(samples - 1, state, roughness=nothing, rate=nothing, loads=forces, progress=progress)
        values = {
            "time": time_step * np.arange(samples),
            "load": at,
            "point": points,
            "force": forces,
            "deflection": trace.observed,
        }
        settings = attributes(
            "loaded",
            "Response of a finite road to prescribed moving loads: Newmark's method",
            method="newmark",
            findings=(),
            speed=speed,
            time_step=time_step,
            start=start,
            scheme=repr(row),
            **road.attributes,
        )
        return labelled(values, settings)

    return step

"""Prescribed loads that travel along a guideway."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

import movingfrf.results.findings as find
from movingfrf._basics.checks import checking
from movingfrf._basics.progress import Progress, silent
from movingfrf.guideways.guideway import Guideway, findings_of, require_guideway, told
from movingfrf.response.line import Line, require_record
from movingfrf.response.sampling import excited
from movingfrf.response.solve import solve
from movingfrf.response.system import Prescribed
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
        Forces [N], positive down. A force that is not zero at t = 0 is switched on at that instant.
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
        If the speed is near or above critical, the response has not decayed, or there is content beyond the
        truncation.

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
    # What settles here is the guideway, in a time that is short beside that of any vehicle.
    settling = len(forces) * time_step
    require_record(settling, settling, time_step, at.size + points.size)
    line = Line(samples=len(forces), time_step=time_step, settling=settling)
    system = Prescribed(guideway=guideway, loads=at, points=points, speed=speed)
    progress("sampling", 0.0)
    # One case. Where no truncation is stated nothing is left out.
    stated = np.inf if truncation is None else truncation
    driven_by = excited(system, lambda line: line.given(forces.T[None]), line, time_step, truncation=stated)
    yielding = solve(
        system, driven_by.omega, driven_by.spectra, truncation=driven_by.truncation, progress=progress
    ).deflection
    progress("histories", 0.0)
    response, error = driven_by.line.records(yielding), driven_by.truncation.error
    critical_speed = float(guideway.critical_speed)
    found = [
        *find.near_critical(abs(speed), critical_speed),
        *findings_of(guideway),
        *find.not_decayed("deflection", response.wrapped, response.values),
        *find.beyond_truncation(truncation or 0.0, error),
    ]
    values = {
        "time": line.time,
        "load": at,
        "point": points,
        "force": forces,
        "deflection": turned(response.values[0]),
    }
    settings = attributes(
        "loaded",
        "Response of a guideway to prescribed moving loads",
        method="moving-frf",
        speed=speed,
        time_step=time_step,
        solved_step=driven_by.step,
        truncation=0.5 / driven_by.step if truncation is None else truncation,
        truncation_error=error,
        critical_speed=critical_speed,
        guideway=told(guideway),
        findings=found,
    )
    return labelled(values, settings)

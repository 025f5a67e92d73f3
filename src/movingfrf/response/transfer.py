"""What a unit of roughness under a contact does, frequency by frequency."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from movingfrf._basics.arrays import FloatArray, require_memory
from movingfrf._basics.checks import checking
from movingfrf._basics.wording import count
from movingfrf.guideways.guideway import Guideway, require_guideway, told
from movingfrf.response.batches import BATCH, unthreaded
from movingfrf.response.solve import solve
from movingfrf.response.survey import survey
from movingfrf.response.system import System
from movingfrf.results.labels import attributes, labelled, turned
from movingfrf.roughness.excitation import Touch
from movingfrf.vehicles.vehicle import Vehicle, require_vehicle

if TYPE_CHECKING:
    import xarray as xr


@unthreaded
def transfer(guideway: Guideway, vehicle: Vehicle, *, speed: float, frequency: ArrayLike) -> xr.Dataset:
    """Response of vehicle and road per metre of roughness under each contact.

    Parameters
    ----------
    guideway : Guideway
        The road or track.
    vehicle : Vehicle
        The vehicle.
    speed : float
        Speed [m/s].
    frequency : array_like, shape (frequency,)
        Frequencies [Hz]; zero is allowed.

    Returns
    -------
    xarray.Dataset
        Complex amplitudes per metre of elevation under the contact `source`, the others rolling on a smooth road:
        `contact_force` [N/m] and `deflection` [m/m] (frequency, contact, source), `motion` and `acceleration`
        (frequency, dof, source). A road that the contacts meet one after the other reaches each with its own
        phase e^{iωx/v}, x the contact's position.

    Raises
    ------
    ValueError
        If a value is impossible or memory does not hold the result.
    SolveError
        If vehicle and guideway are unstable together, or a frequency is singular.

    Warns
    -----
    ValidityWarning
        If the speed is near or above critical.

    Examples
    --------
    >>> import movingfrf as mf
    >>> car = mf.quarter_car(body_mass=400.0, wheel_mass=40.0, suspension_stiffness=2e4,
    ...                      suspension_damping=1.5e3, tyre_stiffness=2e5)
    >>> found = mf.transfer(mf.RigidGuideway(), car, speed=10.0, frequency=[0.0, 1.0])
    >>> abs(found.motion.sel(dof="body")).values.ravel().round(3).tolist()
    [1.0, 2.46]
    """
    require_guideway(guideway)
    require_vehicle(vehicle)
    with checking() as check:
        speed = check.positive("speed", speed, "m/s")
        lines = check.array("frequency", frequency, "Hz", (None,))
        if not check.faults and (not lines.size or lines.min() < 0):
            least = f"{lines.min():g} Hz" if lines.size else "none"
            check.refuse("frequency", f"must hold frequencies of at least zero [Hz], got {least}")
    contacts, dofs = len(vehicle.contacts), len(vehicle.dof_names)
    require_memory(
        BATCH.bytes_per_value * lines.size * contacts * (contacts + dofs),
        f"a transfer over {count(lines.size, 'frequency', 'frequencies')}",
    )
    system = System.of(guideway, vehicle, speed)
    surveyed = survey(system)
    omega = 2 * np.pi * lines
    # One case per contact under which the road is rough.
    unit = np.eye(contacts)[:, :, None] * Touch(**vehicle.touching).shares(omega / speed)
    force, deflection, motion = map(turned, solve(system, omega + 0j, unit + 0j))
    values: dict[str, ArrayLike] = {
        **coordinates(vehicle, lines),
        "source": np.arange(contacts),
        "contact_force": force,
        "deflection": deflection,
        "motion": motion,
        "acceleration": -(omega[:, None, None] ** 2) * motion,
    }
    settings = attributes(
        "transfer",
        "Response of a vehicle and a guideway per unit of roughness",
        speed=speed,
        critical_speed=surveyed.critical_speed,
        guideway=told(guideway),
        findings=surveyed.findings,
    )
    return labelled(values, settings)


def coordinates(vehicle: Vehicle, frequency: FloatArray) -> dict[str, ArrayLike]:
    """Coordinates of a result over frequency by their names in the schema.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle.
    frequency : ndarray, shape (frequency,)
        Frequency [Hz].

    Returns
    -------
    dict
        Frequencies, contacts and degrees of freedom.
    """
    return {"frequency": frequency, "omega": 2 * np.pi * frequency, **vehicle.coordinates}

"""The moving oscillator of bridge dynamics: one mass on one spring."""

from __future__ import annotations

from movingfrf._basics.checks import checking
from movingfrf.vehicles.assembly import Body, Suspension, assemble
from movingfrf.vehicles.contact import Contact
from movingfrf.vehicles.vehicle import Vehicle


def sprung_mass(
    mass: float, stiffness: float, damping: float = 0.0, *, wheel_mass: float = 0.0, footprint: float = 0.0
) -> Vehicle:
    """One mass on a spring and a dashpot, with or without a wheel that follows the road rigidly.

    Degrees of freedom `body` and, if it has a mass, `wheel`. Without, the spring itself stands on the road, as in
    the moving oscillator with which bridges and time-stepping methods are tried.

    Parameters
    ----------
    mass : float
        Sprung mass [kg].
    stiffness : float
        Stiffness of the spring [N/m].
    damping : float
        Damping beside it [N s/m].
    wheel_mass : float
        Mass that follows the road [kg]; 0 for none.
    footprint : float
        Length over which the road is averaged under the contact [m].

    Returns
    -------
    Vehicle
        With its contact at position 0.

    Raises
    ------
    ValueError
        If the mass or the stiffness is not positive, or another value is negative.

    References
    ----------
    L. Frýba: Vibration of solids and structures under moving loads. 3rd edition, Thomas Telford, London, 1999.
    Y. B. Yang, J. D. Yau, Y. S. Wu: Vehicle–bridge interaction dynamics. World Scientific, Singapore, 2004.

    Examples
    --------
    >>> sprung_mass(mass=5750.0, stiffness=1.595e6).natural_frequencies.round(3).tolist()
    [2.651]
    >>> sprung_mass(mass=5750.0, stiffness=1.595e6, wheel_mass=500.0).static_loads.round(1).tolist()
    [61312.5]
    """
    with checking() as check:
        mass = check.positive("mass", mass, "kg")
        stiffness = check.positive("stiffness", stiffness, "N/m")
        damping = check.not_negative("damping", damping, "N s/m")
        wheel_mass = check.not_negative("wheel_mass", wheel_mass, "kg")
        footprint = check.not_negative("footprint", footprint, "m")
    body = Body(mass=mass, name="body")
    if not wheel_mass:
        spring = Contact(position=0.0, stiffness=stiffness, damping=damping, footprint=footprint)
        return assemble(bodies=[body], suspensions=[], contacts=[spring], under=["body"])
    return assemble(
        bodies=[body, Body(mass=wheel_mass, name="wheel")],
        suspensions=[Suspension(upper="body", lower="wheel", stiffness=stiffness, damping=damping)],
        contacts=[Contact(position=0.0, stiffness=float("inf"), footprint=footprint, name="wheel")],
        under=["wheel"],
    )

"""Named vehicles, each with the source of its numbers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

from movingfrf._basics.checks import checking
from movingfrf.vehicles.cars import full_car, half_car, quarter_car
from movingfrf.vehicles.rail import carriage
from movingfrf.vehicles.trucks import Axle, Unit, truck
from movingfrf.vehicles.vehicle import Vehicle


class Entry(NamedTuple):
    """One vehicle of the catalogue."""

    make: Callable[[], Vehicle]
    summary: str
    source: str


def _half_truck() -> Vehicle:
    return half_car(
        body_mass=17735.0,
        pitch_inertia=1.47e5,
        wheel_masses=(1500.0, 1000.0),
        suspension_stiffness=(2.47e6, 4.23e6),
        suspension_damping=(3.0e4, 4.0e4),
        tyre_stiffness=(3.74e6, 4.60e6),
        tyre_damping=(3.9e3, 4.3e3),
        axles=(0.519 * 4.27, -0.481 * 4.27),
    )


def _golden_car() -> Vehicle:
    mass = 250.0
    return quarter_car(
        body_mass=mass,
        wheel_mass=0.15 * mass,
        suspension_stiffness=63.3 * mass,
        suspension_damping=6.0 * mass,
        tyre_stiffness=653.0 * mass,
        footprint=0.25,
    )


def _half_passenger_car() -> Vehicle:
    return half_car(
        body_mass=700.0,
        pitch_inertia=2460.0,
        wheel_masses=(40.0, 35.5),
        suspension_stiffness=(19960.0, 17500.0),
        suspension_damping=(1290.0, 1620.0),
        tyre_stiffness=(175500.0, 175500.0),
        tyre_damping=(1000.0, 1000.0),
        axles=(2.3, -2.3),
    )


def _passenger_car() -> Vehicle:
    return full_car(
        body_mass=840.0,
        pitch_inertia=1100.0,
        roll_inertia=820.0,
        wheel_masses=(53.0, 76.0),
        suspension_stiffness=(1.0e4, 1.3e4),
        suspension_damping=(1290.0, 1620.0),
        tyre_stiffness=(2.0e5, 2.0e5),
        axles=(1.4, -1.47),
        sides=(0.7, -0.75),
    )


def _two_axle_truck() -> Vehicle:
    axles = [
        Axle(position=at, mass=900.0, suspension_stiffness=6.0e6, suspension_damping=1.0e4, tyre_stiffness=1.75e6)
        for at in (2.5, -2.5)
    ]
    return truck(units=[Unit(mass=10500.0, pitch_inertia=5.0e4, position=0.0, axles=axles)])


def _tractor_semitrailer() -> Vehicle:
    def axle(at: float, mass: float, suspension: float, tyre: float) -> Axle:
        return Axle(
            position=at,
            mass=mass,
            suspension_stiffness=suspension,
            suspension_damping=1.0e3,
            tyre_stiffness=tyre,
            tyre_damping=1.0e4,
        )

    # The source measures rearwards from each centre of mass; the trailer's lies 2.15 + 6.15 m behind the tractor's.
    trailer = -2.15 - 6.15
    return truck(
        units=[
            Unit(
                mass=4500.0,
                pitch_inertia=4604.0,
                position=0.0,
                axles=[axle(0.5, 700.0, 4.0e5, 1.75e6), axle(-2.5, 1100.0, 1.0e6, 3.5e6)],
                name="tractor",
            ),
            Unit(
                mass=31450.0,
                pitch_inertia=16302.0,
                position=trailer,
                axles=[axle(trailer - at, 750.0, 7.5e5, 3.5e6) for at in (1.8, 2.9, 4.0)],
                name="trailer",
            ),
        ],
        hitches=[-2.15],
    )


def _manchester_coach() -> Vehicle:
    return carriage(
        body_mass=32000.0,
        body_pitch_inertia=1.97e6,
        bogie_mass=2615.0,
        bogie_pitch_inertia=1476.0,
        wheelset_mass=1813.0,
        primary_stiffness=2.4e6,
        primary_damping=8.0e3,
        secondary_stiffness=8.6e5,
        secondary_damping=4.0e4,
        bogie_spacing=19.0,
        axle_spacing=2.56,
    )


def _velaro_coach() -> Vehicle:
    return carriage(
        body_mass=47800.0,
        body_pitch_inertia=1957888.0,
        bogie_mass=3500.0,
        bogie_pitch_inertia=1715.0,
        wheelset_mass=1800.0,
        primary_stiffness=2.4e6,
        primary_damping=2.0e4,
        secondary_stiffness=7.0e5,
        secondary_damping=4.0e4,
        bogie_spacing=17.375,
        axle_spacing=2.5,
    )


def _shinkansen_coach() -> Vehicle:
    return carriage(
        body_mass=41750.0,
        body_pitch_inertia=2.08e6,
        bogie_mass=3040.0,
        bogie_pitch_inertia=3930.0,
        wheelset_mass=1780.0,
        primary_stiffness=1.18e6,
        primary_damping=3.92e4,
        secondary_stiffness=5.3e5,
        secondary_damping=9.02e4,
        bogie_spacing=17.5,
        axle_spacing=2.5,
    )


CATALOGUE: dict[str, Entry] = {
    "golden_car": Entry(
        _golden_car,
        "quarter car of the International Roughness Index, 0.25 m footprint; the standard fixes ratios, 250 kg",
        "ASTM E1926: per sprung mass K1 = 653, K2 = 63.3, C = 6, unsprung 0.15",
    ),
    "half_passenger_car": Entry(
        _half_passenger_car,
        "half of a passenger car",
        "an open teaching model of semi-active suspensions (its code repository junhyukch7/Semi-Active-Suspension)",
    ),
    "passenger_car": Entry(
        _passenger_car,
        "passenger car on four wheels, without anti-roll bars",
        "R. N. Jazar, Vehicle Dynamics: Theory and Application, the numerical example of the full car (recalled); "
        "it has no damping, which is that of half_passenger_car",
    ),
    "half_truck": Entry(
        _half_truck,
        "two-axle truck in one plane, the vehicle of the reference case",
        "N. L. Mulcahy; S. S. Law and X. Q. Zhu, for vehicle-bridge interaction (recalled)",
    ),
    "two_axle_truck": Entry(
        _two_axle_truck,
        "two-axle truck on stiff leaf springs",
        "an example of VBI-2D (D. Cantero), a program for vehicle-bridge interaction",
    ),
    "tractor_semitrailer": Entry(
        _tractor_semitrailer,
        "five-axle tractor and semitrailer, each trailer axle sprung on its own",
        "the example vehicle 2A3 of VBI-2D (D. Cantero), a program for vehicle-bridge interaction",
    ),
    "manchester_coach": Entry(
        _manchester_coach,
        "passenger coach 1 of the Manchester benchmarks, wheels that follow the rails",
        "S. Iwnicki, Vehicle System Dynamics 30 (1998) 295, reduced to one plane as in TTB-2D (D. Cantero)",
    ),
    "velaro_coach": Entry(
        _velaro_coach,
        "end coach of the ICE 3 Velaro E (AVE S-103), wheels that follow the rails",
        "J. Goicolea, Simplified mechanical description of AVE S-103 (2014), reduced to one plane as in TTB-2D",
    ),
    "shinkansen_coach": Entry(
        _shinkansen_coach,
        "coach of a Shinkansen Series 300, wheels that follow the rails",
        "Y. S. Wu and Y. B. Yang, Engineering Structures 25 (2003) 251, as in TTB-2D",
    ),
}


def catalogue(name: str, *, footprint: float | Sequence[float] | None = None) -> Vehicle:
    """Take a vehicle from the catalogue; `movingfrf vehicles` lists and describes them.

    Parameters
    ----------
    name : str
        Its name.
    footprint : float or sequence of float, optional
        Length of the footprint of every contact, or of each [m], in place of its own.

    Returns
    -------
    Vehicle
        The vehicle.

    Raises
    ------
    ValueError
        If there is none of that name, a footprint is negative, or there is not one for each contact.

    Examples
    --------
    >>> catalogue("half_truck").static_loads.round().tolist()
    [98400.0, 100106.0]
    """
    with checking() as check:
        name = check.choice("name", name, CATALOGUE)
    vehicle = CATALOGUE[name].make()
    if footprint is None:
        return vehicle
    with checking() as check:
        lengths = check.spread("footprint", footprint, "m", (len(vehicle.contacts),))
        if not check.faults:
            check.not_negative("footprint", float(lengths.min()), "m")
    contacts = [
        replace(own, footprint=length) for own, length in zip(vehicle.contacts, lengths.tolist(), strict=True)
    ]
    return replace(vehicle, contacts=contacts)

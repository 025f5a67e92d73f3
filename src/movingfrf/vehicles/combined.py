"""Vehicles made of vehicles: a train or convoy, a seat with its driver, other wheel paths."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
import scipy.linalg
from numpy.typing import ArrayLike

from movingfrf._basics import wording
from movingfrf._basics.arrays import FloatArray, require_memory
from movingfrf._basics.checks import Checks, checking, shown
from movingfrf.vehicles.vehicle import Vehicle, check_vehicle


def convoy(
    vehicles: Sequence[Vehicle], *, gaps: ArrayLike | None = None, spacing: ArrayLike | None = None
) -> Vehicle:
    """Let vehicles travel one behind the other, as one vehicle: a train, or lorries in a lane.

    Degrees of freedom carry the vehicle's number from the front, as in `1_bounce`; contacts too. The vehicles act
    on each other through the guideway alone.

    Parameters
    ----------
    vehicles : sequence of Vehicle
        From the front.
    gaps : float or array_like, shape (vehicle − 1,), optional
        Between the last contact of each vehicle and the first one of the next [m]; one number for all.
    spacing : float or array_like, shape (vehicle − 1,), optional
        Between the reference points of successive vehicles [m], instead: the length of a car over its couplers.

    Returns
    -------
    Vehicle
        With the reference point of the first vehicle.

    Raises
    ------
    ValueError
        If there is no vehicle, not exactly one of `gaps` and `spacing` is given, or vehicles would overlap.

    Examples
    --------
    >>> import movingfrf as mf
    >>> car = mf.quarter_car(body_mass=400.0, wheel_mass=40.0, suspension_stiffness=2e4,
    ...                      suspension_damping=1.5e3, tyre_stiffness=2e5)
    >>> convoy([car, car], gaps=30.0).positions.tolist()
    [0.0, -30.0]
    """
    with checking() as check:
        check.listed("vehicles", vehicles, Vehicle)
        if (gaps is None) == (spacing is None):
            check.refuse("gaps", "or spacing is needed, not both [m]")
    with checking() as check:
        name, given = ("gaps", gaps) if gaps is not None else ("spacing", spacing)
        between = len(vehicles) - 1
        assert given is not None
        distances = np.array(check.spread(name, given, "m", (between,)))
        if gaps is not None and not check.faults:
            rears = np.array([one.positions.min() for one in vehicles[:-1]])
            fronts = np.array([one.positions.max() for one in vehicles[1:]])
            distances += fronts - rears
        behind = -np.concatenate([[0.0], np.cumsum(distances)])
        if not check.faults:
            for n, (ahead, after) in enumerate(pairwise(vehicles)):
                left = behind[n] + ahead.positions.min() - behind[n + 1] - after.positions.max()
                if not left > 0:
                    check.refuse(
                        f"{name}[{n}]",
                        f"must keep the contacts of vehicle {n + 2} behind those of vehicle {n + 1}, which are "
                        f"then {left:.4g} m apart",
                    )
    joined = [
        scipy.linalg.block_diag(*matrices) for matrices in zip(*(one.matrices for one in vehicles), strict=True)
    ]
    return Vehicle(
        mass=joined[0],
        damping=joined[1],
        stiffness=joined[2],
        contact_map=joined[3],
        contacts=[
            replace(contact, position=contact.position + at, name=f"{n} {contact.name}".rstrip())
            for n, (one, at) in enumerate(zip(vehicles, behind.tolist(), strict=True), start=1)
            for contact in one.contacts
        ],
        vertical=np.concatenate([np.asarray(one.vertical) for one in vehicles]),
        dof_names=[f"{n}_{name}" for n, one in enumerate(vehicles, start=1) for name in one.dof_names],
    )


def train(car: Vehicle, count: int, *, spacing: float | None = None) -> Vehicle:
    """Repeat a vehicle: a train of equal cars.

    Parameters
    ----------
    car : Vehicle
        One car.
    count : int
        Number of cars.
    spacing : float, optional
        Between the reference points of successive cars [m]: the length of a car over its couplers. By default from
        the first axle to the last and twice the shortest distance between two axles, as coaches have it: 25 m for
        a Shinkansen's, 24.9 m for an ICE 3's of 24.8 m.

    Returns
    -------
    Vehicle
        As `convoy` makes it.

    Raises
    ------
    ValueError
        If the number is not positive, the cars would overlap, or a car with a single axle has no spacing.

    Examples
    --------
    >>> import movingfrf as mf
    >>> coach = mf.catalogue("shinkansen_coach")
    >>> axles = train(coach, 8).positions
    >>> round(float(axles[0] - axles[4]), 3)
    25.0
    """
    with checking() as check:
        check_vehicle(check, car, "car")
        count = check.whole("count", count, least=1)
        if spacing is not None:
            spacing = check.positive("spacing", spacing, "m")
        elif not check.faults:
            axles = np.unique(car.positions)
            if axles.size < 2:
                check.refuse("spacing", "must be given [m]: of one axle no length of a car follows")
            else:
                spacing = float(np.ptp(axles) + 2.0 * np.diff(axles).min())
    # Two dozen square matrices of all degrees of freedom, while they are joined and checked.
    require_memory(200.0 * (count * len(car.dof_names)) ** 2, f"a train of {wording.count(count, 'car')}")
    assert spacing is not None
    return convoy([car] * count, spacing=spacing)


def seated(
    vehicle: Vehicle,
    *,
    mount: Mapping[str, float],
    driver_mass: float,
    cushion_stiffness: float,
    cushion_damping: float,
    seat_mass: float = 0.0,
    seat_stiffness: float = 0.0,
    seat_damping: float = 0.0,
    name: str = "",
) -> Vehicle:
    """Put a driver on a vehicle, on a cushion, or on a cushion on a suspended seat.

    Adds the degrees of freedom `seat` (if it has a mass) and `driver`.

    Parameters
    ----------
    vehicle : Vehicle
        Any vehicle.
    mount : mapping of str to float
        Displacement of the floor under the seat per degree of freedom of the vehicle [m/m or m/rad]: for a seat 1.5
        m ahead of the centre of mass and 0.4 m to the left of it, `{"bounce": 1, "pitch": 1.5, "roll": 0.4}`.
    driver_mass : float
        Mass of the driver that the seat carries [kg].
    cushion_stiffness : float
        Stiffness of the cushion under the driver [N/m].
    cushion_damping : float
        Damping of the cushion under the driver [N s/m].
    seat_mass : float
        Mass of the seat on its suspension [kg]; 0: the cushion rests on the floor.
    seat_stiffness : float
        Stiffness between seat and floor [N/m].
    seat_damping : float
        Damping between seat and floor [N s/m].
    name : str
        Before the names of the new degrees of freedom, for more than one seat.

    Returns
    -------
    Vehicle
        The vehicle with the driver's weight on it.

    Raises
    ------
    ValueError
        If a mass or stiffness is not positive, or the floor does not go down by as much as the vehicle.

    Examples
    --------
    >>> import movingfrf as mf
    >>> car = mf.quarter_car(body_mass=400.0, wheel_mass=40.0, suspension_stiffness=2e4,
    ...                      suspension_damping=1.5e3, tyre_stiffness=2e5)
    >>> driven = seated(car, mount={"body": 1.0}, driver_mass=60.0, cushion_stiffness=3e4, cushion_damping=800.0)
    >>> driven.dof_names
    ('body', 'wheel', 'driver')
    """
    with checking() as check:
        check_vehicle(check, vehicle)
        driver_mass = check.positive("driver_mass", driver_mass, "kg")
        cushion_stiffness = check.positive("cushion_stiffness", cushion_stiffness, "N/m")
        cushion_damping = check.not_negative("cushion_damping", cushion_damping, "N s/m")
        if seat_mass := check.not_negative("seat_mass", seat_mass, "kg"):
            seat_stiffness = check.positive("seat_stiffness", seat_stiffness, "N/m")
            seat_damping = check.not_negative("seat_damping", seat_damping, "N s/m")
        elif seat_stiffness or seat_damping:
            check.refuse("seat_mass", "must be positive for a seat with a stiffness or damping of its own [kg]")
    with checking() as check:
        floor = _floor(vehicle, mount, check)
    dofs = len(vehicle.dof_names)
    added = [f"{name}_driver" if name else "driver"]
    masses, springs, dampers = [driver_mass], [cushion_stiffness], [cushion_damping]
    if seat_mass:
        added.insert(0, f"{name}_seat" if name else "seat")
        masses.insert(0, seat_mass)
        springs.insert(0, seat_stiffness)
        dampers.insert(0, seat_damping)
    mass, damping, stiffness = (
        scipy.linalg.block_diag(matrix, np.zeros((len(added), len(added)))) for matrix in vehicle.matrices[:3]
    )
    below = np.concatenate([floor, np.zeros(len(added))])
    for n, (kg, spring, damper) in enumerate(zip(masses, springs, dampers, strict=True), start=dofs):
        above = np.eye(dofs + len(added))[n]
        stretch = above - below
        mass[n, n] = kg
        stiffness += spring * np.outer(stretch, stretch)
        damping += damper * np.outer(stretch, stretch)
        below = above
    return Vehicle(
        mass=mass,
        damping=damping,
        stiffness=stiffness,
        contact_map=np.hstack([vehicle.matrices[3], np.zeros((len(vehicle.contacts), len(added)))]),
        contacts=vehicle.contacts,
        vertical=np.concatenate([np.asarray(vehicle.vertical), np.ones(len(added))]),
        dof_names=[*vehicle.dof_names, *added],
    )


def _floor(vehicle: Vehicle, mount: Mapping[str, float], check: Checks) -> FloatArray:

    floor = np.zeros(len(vehicle.dof_names))
    if not isinstance(mount, Mapping) or not mount:
        check.refuse("mount", "must name degrees of freedom with the floor's displacement per each [m/m or m/rad]")
        return floor
    for dof, lever in mount.items():
        if dof not in vehicle.dof_names:
            check.refuse(f"mount.{dof}", f"is no degree of freedom; there are {', '.join(vehicle.dof_names)}")
        else:
            floor[vehicle.dof_names.index(dof)] = check.finite(f"mount.{dof}", lever, "m/m or m/rad")
    down = float(floor @ np.asarray(vehicle.vertical))
    if not check.faults and abs(down - 1.0) > 1e-6:
        check.refuse("mount", f"must move down by 1 m when the vehicle does, got {down:g} m: is a bounce missing?")
    return floor


def on_paths(vehicle: Vehicle, paths: Sequence[int]) -> Vehicle:
    """Let the contacts follow other paths of the profile: one each, for wheels that are out of round.

    Parameters
    ----------
    vehicle : Vehicle
        Any vehicle.
    paths : sequence of int
        Number of the path that each contact follows.

    Returns
    -------
    Vehicle
        The same on these paths.

    Raises
    ------
    ValueError
        If there is not one path per contact.

    Examples
    --------
    >>> import movingfrf as mf
    >>> car = mf.quarter_car(body_mass=400.0, wheel_mass=40.0, suspension_stiffness=2e4,
    ...                      suspension_damping=1.5e3, tyre_stiffness=2e5)
    >>> on_paths(car, [1]).paths
    [1]
    """
    with checking() as check:
        check_vehicle(check, vehicle)
        if not isinstance(paths, (list, tuple)):
            check.refuse("paths", f"must be a list of whole numbers, got {shown(paths)}")
    with checking() as check:
        numbers = [check.whole(f"paths[{n}]", path) for n, path in enumerate(paths)]
    with checking() as check:
        if len(paths) != len(vehicle.contacts):
            check.refuse(
                "paths", f"must be one number per contact, {len(vehicle.contacts)} in all, got {len(paths)}"
            )
    return replace(
        vehicle, contacts=[replace(one, path=path) for one, path in zip(vehicle.contacts, numbers, strict=True)]
    )

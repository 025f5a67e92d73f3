"""A tractor and semitrailer on a class B road: what its axles do to the road, and the road to its driver.

Two variants of the trailer: each axle sprung on its own, or the last two at the ends of a walking beam, which
shares their load evenly but whose pitching nothing damps except the tyres.
"""

from __future__ import annotations

import xarray as xr

import movingfrf as mf

SPEED, DURATION = 20.0, 20.0

ROAD = mf.track(
    mf.EulerBernoulliBeam(bending_stiffness=1.573e7 * 3, mass=711.9 * 3),
    mf.Spring(stiffness=8.0e6 * 3, damping=3.0e4 * 3),
)
HITCH, TRAILER = -2.15, -8.3


def axle(position: float, mass: float, suspension: float, tyre: float) -> mf.Axle:
    """One axle on an air suspension, with well kept dampers."""
    return mf.Axle(
        position=position,
        mass=mass,
        suspension_stiffness=suspension,
        suspension_damping=2.5e4,
        tyre_stiffness=tyre,
        tyre_damping=3.0e3,
        footprint=0.2,
    )


def vehicle(*, walking_beam: bool) -> mf.Vehicle:
    """Tractor, semitrailer and a driver on a suspended seat."""
    last = [axle(TRAILER - at, 750.0, 7.5e5, 3.5e6) for at in (1.8, 2.9, 4.0)]
    if walking_beam:
        front, rear = last[1:]
        beam = mf.WalkingBeam(
            positions=(front.position, rear.position),
            mass=front.mass + rear.mass,
            pitch_inertia=2 * front.mass * (0.5 * (front.position - rear.position)) ** 2,
            suspension_stiffness=2 * front.suspension_stiffness,
            suspension_damping=2 * front.suspension_damping,
            tyre_stiffness=front.tyre_stiffness,
            tyre_damping=front.tyre_damping,
            footprint=front.footprint,
        )
        running_gear = [last[0], beam]
    else:
        running_gear = last
    tractor = mf.Unit(
        mass=4500.0,
        pitch_inertia=4604.0,
        position=0.0,
        axles=[axle(0.5, 700.0, 4.0e5, 1.75e6), axle(-2.5, 1100.0, 1.0e6, 3.5e6)],
        name="tractor",
    )
    trailer = mf.Unit(mass=31450.0, pitch_inertia=1.6302e5, position=TRAILER, axles=running_gear, name="trailer")
    lorry = mf.truck(units=[tractor, trailer], hitches=[HITCH])
    return mf.seated(
        lorry,
        mount={"tractor_bounce": 1.0, "tractor_pitch": 0.3},
        driver_mass=75.0,
        cushion_stiffness=4.0e4,
        cushion_damping=1.0e3,
        seat_mass=25.0,
        seat_stiffness=6.0e3,
        seat_damping=6.0e2,
    )


def drive(lorry: mf.Vehicle) -> xr.Dataset:
    """Simulate twenty seconds on a class B road."""
    profile = mf.realise(mf.IsoRoad.of_class("B", band=(0.01, 5.0)), length=430.0, start=-15.0, seed=3)
    return mf.simulate(ROAD, lorry, profile, speed=SPEED, duration=DURATION)


def main() -> None:
    """Compare the two."""
    for walking_beam in (False, True):
        lorry = vehicle(walking_beam=walking_beam)
        result = drive(lorry)
        felt = mf.comfort(result, "driver")
        print("with a walking beam:" if walking_beam else "each axle sprung on its own:")
        slowest = mf.vehicle_modes(lorry)[0]
        print(f"  slowest vibration {slowest.frequency:.2f} Hz, {slowest.description}")
        coefficients = mf.dynamic_load_coefficient(result)
        for contact, load, coefficient in zip(lorry.contacts, result.static_load, coefficients, strict=True):
            print(f"  {contact.name}: {load / 1e3:.1f} kN, dynamic load coefficient {coefficient:.3f}")
        print(f"  driver: {felt.rms:.2f} m/s² weighted (ISO 2631-1)")


if __name__ == "__main__":
    main()

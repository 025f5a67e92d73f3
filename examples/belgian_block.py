"""A car on Belgian blocks at 30 km/h: a measured surface of 10 m, driven forth and back by an option that says so.

`python examples/belgian_block.py [SURFACE]`; needs PyOpenCRG (`pip install PyOpenCRG`). The surface is not
part of this repository: it is `belgian_block.crg` of ASAM OpenCRG (DaimlerChrysler 2005, Apache License 2.0).
"""

import sys
import warnings
from pathlib import Path

import numpy as np

import movingfrf as mf

SURFACE = Path(__file__).parents[2] / "shared" / "data" / "belgian_block.crg"

# Lateral positions of the left and the right wheels [m].
WHEELS = (0.75, -0.75)
SPEED, DURATION = 30 / 3.6, 12.0


def road(surface: Path) -> mf.Profile:
    """Take two wheel paths of the surface, without level and slope, made 120 m long by going forth and back."""
    patch, _ = mf.read_profile(surface, across=WHEELS)
    return mf.mirrored(mf.detrended(patch), length=120.0)


def car() -> mf.Vehicle:
    """Describe a car of middle size in round numbers; its tyres average over the length of their footprint."""
    return mf.full_car(
        body_mass=1400.0,
        pitch_inertia=2300.0,
        roll_inertia=500.0,
        wheel_masses=(40.0, 35.0),
        suspension_stiffness=(2.0e4, 2.0e4),
        suspension_damping=(2000.0, 2000.0),
        tyre_stiffness=(2.0e5, 2.0e5),
        axles=(1.3, -1.4),
        sides=WHEELS,
        footprint=0.2,
    )


def told(surface: Path) -> list[str]:
    """Drive over it and describe what matters."""
    profile = road(surface)
    start = profile.stations[0] + 5.0
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", mf.ValidityWarning)  # wheels lift off; the last but one sentence says so
        result = mf.simulate(mf.RigidGuideway(), car(), profile, speed=SPEED, duration=DURATION, start=start)
    total = result.contact_force + result.static_load
    coefficient = (result.contact_force.std("time") / result.static_load).values
    airborne = (total < 0).mean("time").values
    return [
        f"Road: {profile.source}; {'; '.join(profile.steps)}.",
        f"Elevation {1e3 * np.std(profile.elevation):.1f} mm root mean square, at {3.6 * SPEED:.0f} km/h.",
        f"Front left wheel: {result.static_load[0] / 1e3:.1f} kN at rest, {total[:, 0].min() / 1e3:.1f} to "
        f"{total[:, 0].max() / 1e3:.1f} kN on the blocks; dynamic load coefficients of all wheels "
        f"{coefficient.min():.2f} to {coefficient.max():.2f}.",
        f"A wheel leaves the ground for {100 * airborne.max():.0f} % of the time at most; the model, which is "
        "linear, pulls at it then.",
        f"Body: {result.acceleration.sel(dof='bounce').std():.1f} m/s² root mean square at its centre of mass.",
    ]


if __name__ == "__main__":
    surface = Path(sys.argv[1]) if len(sys.argv) > 1 else SURFACE
    try:
        print("\n".join(told(surface)))
    except ValueError as error:
        sys.exit(f"{error}\n(the text at the top of this example says where the surface comes from)")

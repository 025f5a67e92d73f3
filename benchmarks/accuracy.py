"""How accurate, in numbers: `make accuracy`.

Prints the worst difference of every quantity from the reference numbers that the tests keep (`tests/data`): moving
FRFs by numerical integration, and a coupled response by time stepping.
"""

from __future__ import annotations

import csv

import numpy as np
from tests.cross.test_coupled_references import DATA, FIRST, relative_l2
from tests.helpers import DAMPED, VEHICLES

import movingfrf as mf

CHANNELS = ("bounce_m_s2", "pitch_rad_s2", "front_wheel_m_s2", "rear_wheel_m_s2")


def moving_frfs() -> float:
    """Worst relative difference of a moving FRF."""
    worst = 0.0
    with (DATA / "moving_frf.csv").open() as file:
        for row in csv.DictReader(file):
            omega = [2 * np.pi * float(row["frequency_Hz"])]
            road = DAMPED[row["guideway"]]
            found = road.moving_frf(float(row["offset_m"]), float(row["speed_m_s"]), omega)[0]
            wanted = complex(float(row["frf_real_m_N"]), float(row["frf_imag_m_N"]))
            worst = max(worst, abs(found - wanted) / abs(wanted))
    return worst


def coupled(suffix: str) -> dict[str, list[float]]:
    """Relative L2 of every channel, over four seconds and over the last one: the worst channel of each quantity."""
    road = np.loadtxt(DATA / f"coupled_profile{suffix}.csv.gz", delimiter=",", skiprows=1)
    wanted = np.genfromtxt(DATA / f"coupled_half_truck{suffix}.csv.gz", delimiter=",", names=True)[:-1]
    result = mf.simulate(
        DAMPED["euler_bernoulli_winkler"],
        VEHICLES["half_truck"],
        mf.Profile(road[:, 0], road[:, 1]),
        speed=10.0,
        duration=10.0,
        start=60.0,
        blend=0.0,
    )
    sag = result.static_deflection.values
    force, deflection, acceleration = (
        values[FIRST:]
        for values in (result.contact_force.values, result.deflection.values - sag, result.acceleration.values)
    )
    ends = ("front", "rear")
    pairs = {
        "contact force": [(force[:, n], wanted[f"force_{end}_N"]) for n, end in enumerate(ends)],
        "deflection": [(deflection[:, n], wanted[f"deflection_{end}_m"] - sag[n]) for n, end in enumerate(ends)],
        "acceleration": [(acceleration[:, n], wanted[f"accel_{name}"]) for n, name in enumerate(CHANNELS)],
    }
    return {
        quantity: [
            max(relative_l2(a[span], b[span]) for a, b in both) for span in (slice(0, None), slice(-1000, None))
        ]
        for quantity, both in pairs.items()
    }


def main() -> None:
    """Print all differences."""
    print(f"moving FRF, worst of all rows      {moving_frfs():.1e}")
    for suffix, content in (("_6", "60 Hz"), ("", "20 Hz")):
        for quantity, (whole, last) in coupled(suffix).items():
            print(f"to {content}, {quantity:14s} 4 s   {whole:.1e}   last second   {last:.1e}")


if __name__ == "__main__":
    main()

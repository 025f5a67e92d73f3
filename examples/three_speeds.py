"""A road agency's question: one measured road, a semitrailer at 60, 80 and 100 km/h, three measures side by side.

`python examples/three_speeds.py [PROFILE]`: a file that `movingfrf profile` reads, 500 m long at least; without one
a road of class B stands in for it.
"""

import sys
import tempfile
from pathlib import Path

import xarray as xr

import movingfrf as mf

SPEEDS = (60.0, 80.0, 100.0)  # [km/h]
MEASURES = ["dynamic_load_coefficient", "deflection_peak", "weighted_acceleration_rms"]


def scenario(profile: Path) -> dict:
    """Describe the lorry on that road, as a scenario file would; it starts 20 m from where the profile begins."""
    begins = float(mf.read_profile(profile).profile.stations[0])
    return {
        "guideway": {
            "kind": "track",
            "beam": {"kind": "euler_bernoulli_beam", "bending_stiffness": 1.573e7, "mass": 711.9},
            "foundation": {"kind": "spring", "stiffness": 8.0e6, "damping": 3.0e4},
        },
        "vehicle": {"kind": "catalogue", "name": "tractor_semitrailer"},
        "roughness": {"kind": "profile", "file": str(profile)},
        "run": {"speed_kmh": SPEEDS[0], "duration": 15.0, "start": begins + 20.0},
    }


def compared(profile: Path) -> xr.Dataset:
    """Drive at each speed."""
    return mf.sweep(scenario(profile), {"run.speed_kmh": SPEEDS}, measures=MEASURES)


def main() -> None:
    """Print the three measures: of the axles that have most of each, and of the tractor."""
    with tempfile.TemporaryDirectory() as folder:
        if sys.argv[1:]:
            file = Path(sys.argv[1]).resolve()
        else:
            file = Path(folder) / "road.csv"
            mf.write_profile(mf.realise(mf.IsoRoad.of_class("B"), length=500.0, seed=1), file)
        table = compared(file)
    print("km/h  dynamic load coefficient  deflection [mm]  tractor, weighted [m/s²]")
    cab = table.weighted_acceleration_rms.isel(dof=table.dof_name.values.tolist().index("tractor_bounce"))
    for speed in table.speed_kmh.values:
        load = float(table.dynamic_load_coefficient.sel(speed_kmh=speed).max())
        sag = 1e3 * float(table.deflection_peak.sel(speed_kmh=speed).max())
        print(f"{speed:4.0f}  {load:24.3f}  {sag:15.2f}  {float(cab.sel(speed_kmh=speed)):28.2f}")


if __name__ == "__main__":
    main()

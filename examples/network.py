"""A network: measured roads × three trucks, and which roads are loaded most.

`python examples/network.py [FOLDER]`: profiles that `movingfrf profile` reads, as FOLDER/profiles/*.csv, 300 m long
each at least; without a folder some roads of classes A and B stand in. `docs/sweeps.md` has it as an array job.
"""

import sys
import tempfile
from pathlib import Path

import xarray as xr

import movingfrf as mf

TRUCKS = ["half_truck", "two_axle_truck", "tractor_semitrailer"]
SCENARIO = """
[guideway]
kind = "track"
beam = { kind = "euler_bernoulli_beam", bending_stiffness = 1.573e7, mass = 711.9 }  # N m², kg/m
foundation = { kind = "spring", stiffness = 8.0e6, damping = 3.0e4 }                  # N/m², N s/m²

[vehicle]
kind = "catalogue"
name = "half_truck"

[roughness]
kind = "profile"
file = "profiles/001.csv"

[run]
speed_kmh = 80.0
duration = 10.0
start = 20.0      # m
"""


def surveyed(folder: Path, roads: int) -> None:
    """Let roads of classes A and B stand in for measured ones."""
    (folder / "profiles").mkdir()
    for number in range(1, roads + 1):
        road = mf.IsoRoad.of_class("AB"[number % 2])
        mf.write_profile(mf.realise(road, length=300.0, seed=number), folder / "profiles" / f"{number:03d}.csv")


def loaded(folder: Path) -> xr.Dataset:
    """Drive every truck on every road; what is solved stays in the folder."""
    file = folder / "network.toml"
    file.write_text(SCENARIO, encoding="utf-8")
    roads = sorted(f"profiles/{road.name}" for road in (folder / "profiles").glob("*.csv"))
    axes = {"roughness.file": roads, "vehicle": TRUCKS}
    return mf.sweep(file, axes, measures=["dynamic_load_coefficient"], store=folder / "out")


def most_loaded(table: xr.Dataset) -> xr.DataArray:
    """Rank the roads by the dynamic load coefficient of the axle and the truck that have most of it."""
    largest = table.dynamic_load_coefficient.max(["vehicle", "contact"])
    return largest.sortby(largest, ascending=False)


def main() -> None:
    """Print the five roads that are loaded most."""
    with tempfile.TemporaryDirectory() as made:
        folder = Path(sys.argv[1]) if sys.argv[1:] else Path(made)
        if not sys.argv[1:]:
            surveyed(folder, 9)
        worst = most_loaded(loaded(folder))[:5]
    for road, coefficient in zip(worst.file.values, worst.values, strict=True):
        print(f"{road}  {coefficient:.3f}")


if __name__ == "__main__":
    main()

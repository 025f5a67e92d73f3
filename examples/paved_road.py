"""What a surveyed road does to a truck: run a scenario and tell the result in sentences.

`python examples/paved_road.py [SCENARIO]`; the scenario says where it expects the profile.
"""

import sys
from pathlib import Path

import movingfrf as mf

SCENARIO = Path(__file__).with_name("paved_road.toml")


def told(file: Path) -> list[str]:
    """Run a scenario and describe what matters."""
    scenario = mf.read_scenario(file)
    result = scenario.run()
    total = result.contact_force + result.static_load
    coefficient = result.contact_force.std("time") / result.static_load
    bounce = float(result.acceleration.sel(dof="bounce").std())
    lines = [
        f"Road: {scenario.case.road.description}.",
        f"Speed {3.6 * scenario.journey.speed:.0f} km/h, {scenario.journey.duration:g} s.",
    ]
    for contact, name in enumerate(("Front", "Rear")):
        lines.append(
            f"{name} axle: {result.static_load[contact] / 1e3:.1f} kN at rest, between "
            f"{total[:, contact].min() / 1e3:.1f} and {total[:, contact].max() / 1e3:.1f} kN on the road; "
            f"dynamic load coefficient {float(coefficient[contact]):.3f}."
        )
    lines.append(f"Body: {bounce:.2f} m/s² root mean square at its centre of mass.")
    sag = 1e3 * result.deflection
    lines.append(f"Pavement: deflects {sag.min():.2f} to {sag.max():.2f} mm under the wheels.")
    return lines


if __name__ == "__main__":
    try:
        print("\n".join(told(Path(sys.argv[1]) if len(sys.argv) > 1 else SCENARIO)))
    except mf.ScenarioError as error:
        sys.exit(f"{error}\n(the comment at the top of the scenario says where the profile comes from)")

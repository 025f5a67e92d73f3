"""A designer's question: the dampers with which a truck loads its road least, within a limit of comfort.

`python examples/designer.py`: front and rear dampers of a half truck on a road of class B.
"""

import movingfrf as mf

COMFORT = 0.29  # weighted acceleration of the body, at most [m/s²]


def scenario() -> dict:
    """Describe the truck on its road, as a scenario file would."""
    return {
        "guideway": {
            "kind": "track",
            "beam": {"kind": "euler_bernoulli_beam", "bending_stiffness": 1.573e7, "mass": 711.9},
            "foundation": {"kind": "spring", "stiffness": 8.0e6, "damping": 3.0e4},
        },
        "vehicle": {
            "kind": "half_car",
            "body_mass": 16200.0,
            "pitch_inertia": 1.3e5,
            "wheel_masses": [700.0, 1100.0],
            "suspension_stiffness": [4e5, 1e6],
            "suspension_damping": [1e4, 2e4],
            "tyre_stiffness": [1.75e6, 3.5e6],
            "axles": [3.0, -1.5],
        },
        "roughness": {"kind": "iso_road", "road_class": "B"},
        "run": {"speed": 20.0, "duration": 12.0, "time_step": 2e-3},
    }


def best(comfort: float | None = COMFORT):
    """Search for both dampers."""
    return mf.optimise(
        scenario(),
        over={"vehicle.suspension_damping.0": (2e3, 2e5), "vehicle.suspension_damping.1": (2e3, 2e5)},
        minimise="dynamic_load_coefficient",
        contact="rear",
        where={} if comfort is None else {("weighted_acceleration_rms", "bounce"): comfort},
    )


def main() -> None:
    """Print what is found with the limit, and without it."""
    for words, found in (("comfortable", best()), ("whatever the comfort", best(None))):
        front, rear = found.x / 1e3
        print(f"{words}: dampers of {front:.1f} and {rear:.1f} kN s/m, load coefficient {found.fun:.4f}")
    print(found.message)


if __name__ == "__main__":
    main()

"""A road with rough stretches wears out faster than an even one of the same spectrum.

Two roads with the same spectrum: one is Gaussian; the roughness of the other varies from one hundred metres to the
next, with a kurtosis of 4.5 instead of 3. A vehicle that forgets within some ten metres feels a Gaussian road with
another variance V in each stretch. The mean square of its wheel force is the same on both roads, since E V = 1, but
the fourth power, by which roads are said to wear, is E V² = kurtosis/3 = 1.5 times as large.
"""

import numpy as np

import movingfrf as mf

SPEED, LENGTH, KURTOSIS = 25.0, 60_000.0, 4.5
truck = mf.quarter_car(
    body_mass=4500.0,
    wheel_mass=500.0,
    suspension_stiffness=5.0e5,
    suspension_damping=2.0e4,
    tyre_stiffness=2.0e6,
)
spectrum = mf.IsoRoad.of_class("A", band=(0.02, 4.0))
even = mf.realise(spectrum, length=LENGTH, step=0.1, seed=1)
varying = mf.realise_laplace(spectrum, kurtosis=KURTOSIS, segment=100.0, length=LENGTH, step=0.1, seed=1)


def dynamic_force(road: mf.Profile) -> np.ndarray:
    """Compute the wheel force without its mean, on a road that does not give way [N]."""
    duration = (LENGTH - 10.0) / SPEED
    result = mf.simulate(mf.RigidGuideway(), truck, road, speed=SPEED, duration=duration, time_step=2e-3)
    return result.contact_force.values[:, 0]


def moments() -> dict[str, tuple[float, float]]:
    """Find root mean square [N] and kurtosis of the wheel force on either road."""
    found = {}
    for name, road in (("even", even), ("varying", varying)):
        force = dynamic_force(road)
        found[name] = (float(np.sqrt(np.mean(force**2))), float(np.mean(force**4) / np.mean(force**2) ** 2))
    return found


if __name__ == "__main__":
    for name, (rms, kurtosis) in moments().items():
        print(f"{name:8} dynamic wheel force {rms / 1e3:.2f} kN rms, kurtosis {kurtosis:.2f}")

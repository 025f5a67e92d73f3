"""A half truck on a class A road, from Python: contact forces, and what speed does to them."""

import movingfrf as mf

road = mf.track(
    mf.EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9),  # one metre of pavement: N m², kg/m
    mf.Spring(stiffness=8.0e6, damping=3.0e4),  # N/m², N s/m²
)
truck = mf.half_car(
    body_mass=17735.0,
    pitch_inertia=1.47e5,
    wheel_masses=(1500.0, 1000.0),
    suspension_stiffness=(2.47e6, 4.23e6),
    suspension_damping=(3.0e4, 4.0e4),
    tyre_stiffness=(3.74e6, 4.60e6),
    tyre_damping=(3.9e3, 4.3e3),
    axles=(2.21613, -2.05387),
)
surface = mf.realise(mf.IsoRoad.of_class("A", band=(0.01, 6.0)), length=450.0, seed=0, start=-3.0)


def dynamic_load_coefficients() -> dict[float, list[float]]:
    """Root mean square of the dynamic force over the static one, front and rear, by speed [m/s]."""
    found = {}
    for speed in (10.0, 15.0, 20.0):
        result = mf.simulate(road, truck, surface, speed=speed, duration=20.0)
        found[speed] = (result.contact_force.std("time") / result.static_load).values.tolist()
    return found


if __name__ == "__main__":
    for speed, (front, rear) in dynamic_load_coefficients().items():
        print(f"{speed:4.0f} m/s: dynamic load coefficient {front:.3f} front, {rear:.3f} rear")

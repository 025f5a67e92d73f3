"""A car over all roads of a class at once: wheel loads and comfort, without realising any of them.

Left and right wheels meet different wheel paths of one surface: long waves lift both, short ones each by itself.
"""

import movingfrf as mf

road = mf.track(
    mf.EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9),  # one metre of pavement: N m², kg/m
    mf.Spring(stiffness=8.0e6, damping=3.0e4),  # N/m², N s/m²
)
car = mf.full_car(
    body_mass=840.0,
    pitch_inertia=1100.0,
    roll_inertia=820.0,
    wheel_masses=(53.0, 76.0),
    suspension_stiffness=(1.0e4, 1.3e4),
    suspension_damping=(900.0, 900.0),
    tyre_stiffness=(2.0e5, 2.0e5),
    axles=(1.4, -1.47),
    sides=(0.7, -0.75),
    footprint=0.1,
)
spectrum, coherence = mf.IsoRoad.of_class("B"), mf.IsotropicCoherence()


def all_roads(speed: float):
    """Stationary response at a speed [m/s] to all roads of class B."""
    return mf.random_response(road, car, spectrum, speed=speed, coherence=coherence, exposure=60.0)


def one_road(speed: float, seed: int):
    """Drive a minute over one of them, the first ten seconds left out."""
    surface = mf.realise(
        spectrum,
        length=60.0 * speed + 8.0,
        start=-4.0,
        seed=seed,
        across=(0.7, -0.75),
        coherence=coherence,
    )
    result = mf.simulate(road, car, surface, speed=speed, duration=60.0, time_step=2e-3)
    return result.sel(time=slice(10.0, None))


if __name__ == "__main__":
    for speed in (10.0, 15.0, 20.0):
        found = all_roads(speed)
        coefficient = found.dynamic_load_coefficient.values[0]
        largest = (found.static_load + found.contact_force_expected_peak).values[0]
        comfort = found.weighted_acceleration.sel(dof="bounce").item()
        print(
            f"{speed:3.0f} m/s: front left wheel, dynamic load coefficient {coefficient:.3f}, "
            f"largest load of a minute {largest / 1e3:.1f} kN; body, weighted acceleration {comfort:.2f} m/s²"
        )

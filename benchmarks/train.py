"""A train of sixteen coaches over ten kilometres of rough track: `python -m benchmarks.train`.

Sixty-four contacts, 160 degrees of freedom, 80 m/s, content up to 100 Hz and the track up to 110, on rails that the
wheels follow and on Hertzian springs. Prints the time, the memory at its peak and what the time consists of.
"""

from __future__ import annotations

import resource
import time
import warnings
from itertools import pairwise

import numpy as np

import movingfrf as mf

SPEED, LENGTH, LIMIT_S, LIMIT_GIB = 80.0, 10_000.0, 30.0, 4.0

TRACK = mf.track(
    mf.EulerBernoulliBeam(bending_stiffness=1.284e7, mass=120.4),
    mf.OnMass(
        above=mf.Spring(stiffness=6.0e8, damping=6.0e4),
        mass=500.0,
        below=mf.Spring(stiffness=2.0e8, damping=1.6e5),
    ),
)


def train(contact_stiffness: float) -> mf.Vehicle:
    """Repeat the Velaro coach of the catalogue sixteen times."""
    coach = mf.carriage(
        body_mass=47_800.0,
        body_pitch_inertia=1_957_888.0,
        bogie_mass=3500.0,
        bogie_pitch_inertia=1715.0,
        wheelset_mass=1800.0,
        primary_stiffness=2.4e6,
        primary_damping=2.0e4,
        secondary_stiffness=7.0e5,
        secondary_damping=4.0e4,
        bogie_spacing=17.375,
        axle_spacing=2.5,
        contact_stiffness=contact_stiffness,
    )
    return mf.train(car=coach, count=16, spacing=24.775)


def main() -> None:
    """Run both."""
    warnings.simplefilter("ignore", mf.ValidityWarning)
    spectrum = mf.GermanTrack.of_class("low", band=(0.0125, 1.25))
    profile = mf.realise(spectrum, length=LENGTH + 450.0, step=0.1, start=-400.0)
    hertz = 2 * mf.hertzian_stiffness(75e3, wheel_radius=0.46)
    for name, stiffness in (("wheels that follow the rails", np.inf), ("wheels on Hertzian springs", hertz)):
        stages: list[tuple[str, float]] = []

        def note(stage: str, _: float, stages: list[tuple[str, float]] = stages) -> None:
            if not stages or stages[-1][0] != stage:
                stages.append((stage, time.perf_counter()))

        began = time.perf_counter()
        result = mf.simulate(
            TRACK,
            train(stiffness),
            profile,
            speed=SPEED,
            duration=LENGTH / SPEED,
            time_step=2.5e-3,
            truncation=110.0,
            progress=note,
        )
        seconds = time.perf_counter() - began
        stages.append(("", time.perf_counter()))
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
        parts = ", ".join(f"{stage} {end - since:.1f}" for (stage, since), (_, end) in pairwise(stages))
        print(
            f"{name}: {result.sizes['contact']} contacts, {result.sizes['dof']} degrees of freedom, "
            f"{result.sizes['time']} steps: {seconds:.1f} s of {LIMIT_S:g} s allowed ({parts}); peak of process "
            f"{peak:.2f} GiB of {LIMIT_GIB:g} GiB allowed; at most {result.attrs['truncation_error']:.0e} of any "
            "output lost beyond the truncation"
        )


if __name__ == "__main__":
    main()

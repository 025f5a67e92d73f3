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
from benchmarks.cases import HERTZ, by_train

import movingfrf as mf

LENGTH, LIMIT_S, LIMIT_GIB = 10_000.0, 30.0, 4.0


def main() -> None:
    """Run both."""
    warnings.simplefilter("ignore", mf.ValidityWarning)
    for name, stiffness in (("wheels that follow the rails", np.inf), ("wheels on Hertzian springs", HERTZ)):
        stages: list[tuple[str, float]] = []

        def note(stage: str, _: float, stages: list[tuple[str, float]] = stages) -> None:
            if not stages or stages[-1][0] != stage:
                stages.append((stage, time.perf_counter()))

        run = by_train(LENGTH, stiffness)
        began = time.perf_counter()
        result = run(progress=note)
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

"""Prescribed loads: when they are switched, and what is said of what their samples do not tell."""

from __future__ import annotations

from tests.faults.fault import Fault

FAULTS = [
    Fault("every load switched on at the start", "response/line.py", "np.exp(-change.time * s) * pulse", "pulse"),
    Fault("switched off is switched on again", "scenarios/forces.py", "self.ends: -1.0}", "self.ends: 1.0}"),
    Fault(
        "jump of the value alone",
        "response/line.py",
        "value, slope, bend = jumps",
        "value, slope, bend = jumps[0], 0 * jumps[1], 0 * jumps[2]",
    ),
    Fault("ripple before the load", "response/moving_loads.py", "line.time_step] = 0.0", "line.time_step] *= 1.0"),
    Fault("load seen before it has passed", "response/sampling.py", "passed: float = 20.0", "passed: float = 1.0"),
    Fault("wave sampled as if it were slow", "scenarios/forces.py", "0.1 / highest", "1e9 / highest"),
    Fault("rise sampled as if it were slow", "scenarios/forces.py", "0.25 * ramp", "1e9 * ramp"),
    Fault(
        "first row that counts for nothing", "scenarios/forces.py", "begins=float(time[0])", "begins=float(time[1])"
    ),
    Fault(
        "jump within a step not said",
        "response/moving_loads.py",
        "others < SAMPLING.like * size",
        "others < 0.0 * size",
    ),
    Fault("noise that jumps", "response/moving_loads.py", "others < SAMPLING.like * size", "others < 10.0 * size"),
    Fault("jump a whole step late", "response/moving_loads.py", "0.5 * line.time_step", "2.0 * line.time_step"),
    Fault(
        "truncation said to leave out nothing",
        "response/moving_loads.py",
        "error = find.relative(",
        "error = 0.0 * find.relative(",
    ),
    Fault(
        "what lies between samples not said",
        "response/moving_loads.py",
        "deflection[None], least=1.0)",
        "deflection[None], least=1e9)",
    ),
]

"""Deliberate faults, and whether the tests find them: `python -m tests.faults [--list] [name …]`.

Each fault changes one piece of text in a copy of the package; the laws and the analytic tests then run against
the copy and must fail. A fault that survives is a gap in the tests.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
SOURCE = ROOT / "src" / "movingfrf"

# Run in this order; the first failure ends the run. A fault changes what its text says, so the test of the
# texts themselves stays out.
SELECTION = [
    "tests/analytic",
    "tests/laws/test_vehicles.py",
    "tests/laws/test_coupled.py",
    "tests/laws/test_guideways.py",
    "tests/laws/test_properties.py",
]

# Two processes share the machine, each on one core.
AT_A_TIME, LIMIT = 2, 600


class Fault(NamedTuple):
    """One change that no test may let pass."""

    name: str
    file: str  # below src/movingfrf
    old: str  # occurs exactly once
    new: str


FAULTS = [
    # Guideway: waves, sides, layers.
    Fault("direction of travel", "guideways/waves.py", "-1j * speed", "1j * speed"),
    Fault(
        "no convective terms", "guideways/waves.py", "for j in range(b + 1 if linear else 1)", "for j in range(1)"
    ),
    Fault("binomial missing", "guideways/waves.py", "comb(b, j) *", "1.0 *"),
    Fault("sides exchanged", "guideways/waves.py", "(ahead >= 0) == forward", "(ahead < 0) == forward"),
    Fault("two waves on each side", "guideways/waves.py", "(side > 0) == forward", "(kappa.real > 0) == forward"),
    Fault("sign behind", "guideways/waves.py", "frf[here] *= -1.0", "frf[here] *= 1.0"),
    Fault(
        "undamped limit from above",
        "guideways/waves.py",
        "(by_omega / slope).real",
        "-(by_omega / slope).real",
    ),
    Fault("undamped limit missing", "guideways/waves.py", "<= REAL_WITHIN * rounding", "< 0.0 * rounding"),
    Fault("slope sign", "guideways/waves.py", "(1j * kappa) ** derivative", "(-1j * kappa) ** derivative"),
    Fault("decay along the road", "guideways/waves.py", "np.exp(1j * kappa[", "np.exp(-1j * kappa["),
    Fault("sleeper inertia sign", "guideways/track.py", "{(0, 2): self.mass}", "{(0, 2): -self.mass}"),
    Fault("sleeper on a dashpot", "guideways/track.py", "{(0, 2): self.mass}", "{(0, 1): self.mass}"),
    Fault("rotary inertia sign", "guideways/track.py", "rotation[0, 2] = inertia", "rotation[0, 2] = -inertia"),
    Fault("rotary inertia forgotten", "guideways/track.py", "shearing[2, 2] = shear * inertia", "pass"),
    Fault("bending damping order", "guideways/track.py", "terms[4, 1]", "terms[2, 1]"),
    Fault(
        "shear layer as a spring",
        "guideways/track.py",
        "{(2, 0): self.shear_stiffness}",
        "{(0, 0): self.shear_stiffness}",
    ),
    Fault("layers side by side", "guideways/track.py", ".in_series(layer)", " + layer"),
    # Spectra and time.
    Fault("window sign", "spectral.py", "np.exp(-self.decay", "np.exp(self.decay"),
    Fault("window not undone", "spectral.py", "np.exp(self.decay", "np.exp(0.0 * self.decay"),
    Fault("line on the real axis", "spectral.py", "- 1j * self.decay", "+ 0j * self.decay"),
    Fault(
        "hertz for radians",
        "spectral.py",
        "2 * np.pi / (self.padded * self.time_step)",
        "1 / (self.padded * self.time_step)",
    ),
    Fault(
        "truncation in radians", "spectral.py", "int(self.truncation * self", "int(self.truncation / 6.283 * self"
    ),
    Fault("whole weight at the start", "spectral.py", "padded[:, 0] *= 0.5", "padded[:, 0] *= 1.0"),
    Fault(
        "record stops at its end",
        "spectral.py",
        "row[self.samples :] = self._continuation(history)",
        "row[self.samples :] = 0.0",
    ),
    Fault("acceleration sign", "spectral.py", "(1j * self.omega(", "(1 * self.omega("),
    Fault("velocity for acceleration", "response.py", "derivative=2", "derivative=1"),
    # Coupling.
    Fault("contacts transposed", "coupling.py", "at[:, None] - at", "at - at[:, None]"),
    Fault("roughness sign", "coupling.py", "displacement = -roughness[", "displacement = +roughness["),
    Fault(
        "beyond the truncation nothing moves",
        "coupling.py",
        "        springs = vehicle.contact_stiffness(omega)\n",
        "        displacement[kept:] = 0.0\n        springs = vehicle.contact_stiffness(omega)\n",
    ),
    Fault("deflection lifts the vehicle", "coupling.py", "displacement[:kept] +=", "displacement[:kept] -="),
    Fault(
        "sag leaves the loads alone",
        "coupling.py",
        "np.linalg.solve(np.eye(len(frf)) + stiffness @ frf, system.vehicle.static_loads)",
        "system.vehicle.static_loads",
    ),
    Fault("steady basin reversed", "coupling.py", "deflection=frf @ load", "deflection=frf.T @ load"),
    Fault("static sag missing", "simulation.py", "deflection += steady.deflection", "pass"),
    Fault("footprint twice as long", "simulation.py", "/ (2 * speed)", "/ speed"),
    Fault("unstable taken for stable", "stability.py", "round(-float(turned)", "round(float(turned)"),
    Fault("stability not looked at", "stability.py", "if growing_vibrations(system, along_axis):", "if False:"),
    # Vehicle.
    Fault("gravity", "vehicles/base.py", "GRAVITY = 9.81", "GRAVITY = 9.80665"),
    Fault(
        "tyre damping missing",
        "vehicles/base.py",
        "[contact.damping for contact in self.contacts] @",
        "[0.0 for contact in self.contacts] @",
    ),
    Fault("tyre damping in the force only", "vehicles/base.py", "(1j * omega) * damping", "(0j * omega) * damping"),
    Fault("inertia sign", "vehicles/base.py", "i_omega * i_omega * self", "-i_omega * i_omega * self"),
    Fault("contact map", "vehicles/road.py", "[[0, 0, 1, 0], [0, 0, 0, 1]]", "[[0, 0, 0, 1], [0, 0, 1, 0]]"),
    Fault(
        "nose up",
        "vehicles/road.py",
        "def suspension(at_front: float, at_rear: float)",
        "def suspension(at_front, at_rear, front=-front, rear=-rear)",
    ),
    Fault("wheels weightless", "vehicles/road.py", "vertical=[1, 0, 1, 1]", "vertical=[1, 0, 0, 0]"),
    # Road.
    Fault("two-sided density", "roughness/profiles.py", "np.sqrt(variance / 2)", "np.sqrt(variance)"),
    Fault("arithmetic class centres", "roughness/spectra.py", "16e-6 * 4.0**n", "20e-6 * 4.0**n"),
    Fault("limits at the centres", "roughness/spectra.py", "roughness < 2 * centre", "roughness < centre"),
    Fault("waviness ignored", "roughness/spectra.py", "power = 1 - self.waviness", "power = 1 - 2.0"),
    Fault("seed ignored", "roughness/profiles.py", "default_rng(seed)", "default_rng(0)"),
    Fault("second path is the first", "roughness/profiles.py", "elevation[:, path]", "elevation[:, 0]"),
    Fault("datum left in", "roughness/excitation.py", "seen -= datums[path]", "pass"),
    Fault("blend twice as long", "roughness/excitation.py", "- foremost) / blend", "- foremost) / (2 * blend)"),
    Fault(
        "each wheel blends from its own start",
        "roughness/excitation.py",
        "(distance[:blending] - foremost)",
        "(distance[:blending] - distance[0])",
    ),
    Fault("wheels exchanged along the road", "roughness/excitation.py", "(start + position)", "(start - position)"),
]


def stale() -> list[str]:
    """Faults whose old text does not occur exactly once in its file."""
    counts = {fault: (SOURCE / fault.file).read_text().count(fault.old) for fault in FAULTS}
    return [f"{fault.name}: {count} times in {fault.file}" for fault, count in counts.items() if count != 1]


# Prints where the package came from, so that a run cannot quietly test the original.
RUN = """
import sys
from pathlib import Path
import movingfrf, pytest
assert Path(movingfrf.__file__).is_relative_to(Path.cwd()), movingfrf.__file__
sys.exit(pytest.main(sys.argv[1:]))
"""


def outcome(fault: Fault | None) -> tuple[int, str]:
    """Run the tests against a copy, with a fault or without: exit status and the first test that failed."""
    with tempfile.TemporaryDirectory(prefix="movingfrf-fault-") as folder:
        copy = Path(folder).resolve()
        for part in ("src", "tests"):
            shutil.copytree(ROOT / part, copy / part, ignore=shutil.ignore_patterns("__pycache__"))
        shutil.copy(ROOT / "pyproject.toml", copy)
        if fault:
            path = copy / "src" / "movingfrf" / fault.file
            path.write_text(path.read_text().replace(fault.old, fault.new))
        environment = os.environ | {
            "PYTHONPATH": os.pathsep.join([str(copy / "src"), str(copy)]),
            "PYTHONDONTWRITEBYTECODE": "1",
            "OMP_NUM_THREADS": "1",
            "OPENBLAS_NUM_THREADS": "1",
        }
        command = [sys.executable, "-c", RUN, "-x", "-q", "-p", "no:cacheprovider", "--tb=line", *SELECTION]
        try:
            done = subprocess.run(
                command, cwd=copy, env=environment, capture_output=True, text=True, timeout=LIMIT, check=False
            )
        except subprocess.TimeoutExpired:
            return -1, f"no end within {LIMIT} s"
    failed = re.search(r"^(?:FAILED|ERROR) (\S+)", done.stdout, re.MULTILINE)
    # 0 all passed, 1 a test failed, 2 the copy could not even be collected; anything else is no verdict.
    return done.returncode, failed.group(1) if failed else (done.stdout + done.stderr)[-2000:]


def main() -> int:
    """Run the faults, two at a time."""
    parser = argparse.ArgumentParser(prog="python -m tests.faults", description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", help="only faults whose name contains one of these texts")
    parser.add_argument("--list", action="store_true", help="list the faults and run nothing")
    options = parser.parse_args()
    chosen = [f for f in FAULTS if not options.names or any(text in f.name for text in options.names)]
    if options.list:
        for fault in chosen:
            print(f"{fault.name:40} {fault.file}")
        return 0
    if not chosen:
        print("no fault of such a name")
        return 1
    if outdated := stale():
        print("\n".join(["no longer in the source:", *outdated]))
        return 1
    status, message = outcome(None)
    if status != 0:
        print(f"without any fault the tests do not pass: {message}")
        return 1
    survived = 0
    with ThreadPoolExecutor(AT_A_TIME) as pool:
        for fault, (status, message) in zip(chosen, pool.map(outcome, chosen), strict=True):
            killed = status in (1, 2)  # the package may refuse a fault itself, before any test runs
            survived += not killed
            print(
                f"{fault.name:40} {'killed by ' + message if killed else f'SURVIVED ({status}) {message}'}",
                flush=True,
            )
    print(f"{len(chosen) - survived} of {len(chosen)} faults killed")
    return 1 if survived else 0


if __name__ == "__main__":
    sys.exit(main())

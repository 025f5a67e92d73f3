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
    "tests/laws/test_truncation.py",
]

# These first where the fault lies in the independent way, and last otherwise.
REFERENCE = [
    "tests/reference/test_elements.py",
    "tests/reference/test_sampled.py",
    "tests/reference/test_coupled.py",
    "tests/reference/test_duhamel.py",
    "tests/reference/test_refusals.py",
    "tests/reference/test_impulse.py",
    "tests/reference/test_schemes.py",
    "tests/reference/test_plate.py",
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
        "truncation in radians",
        "spectral.py",
        "int(share * self.truncation * self",
        "int(share * self.truncation / 6.283 * self",
    ),
    Fault("truncation that cuts sharply", "spectral.py", "STIFFENING = 0.05", "STIFFENING = 1e-6"),
    Fault(
        "road that does not stiffen",
        "coupling.py",
        "frf * grid.compliance(slice(first, first + kept))[:, None, None]",
        "frf * 1.0",
    ),
    Fault(
        "load's road that does not fade", "simulation.py", "frf * grid.compliance(some)[:, None, None]", "frf * 1.0"
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
    Fault("contacts transposed", "vehicles/base.py", "ahead[:, None] - ahead", "ahead - ahead[:, None]"),
    Fault("left and right transposed", "vehicles/base.py", "across[:, None] - across", "across - across[:, None]"),
    Fault(
        "receiver's place for the source's",
        "vehicles/base.py",
        "np.broadcast_to(across, offsets",
        "np.broadcast_to(across[:, None], offsets",
    ),
    Fault("right side down", "vehicles/road.py", "along[axle], aside[side], 0.0", "along[axle], -aside[side], 0.0"),
    Fault("paths exchanged", "vehicles/road.py", "path=side", "path=1 - side"),
    Fault("wheels exchanged across", "vehicles/road.py", "across=aside[side]", "across=aside[1 - side]"),
    # Road.
    Fault("two-sided density", "roughness/profiles.py", "np.sqrt(variance / 2)", "np.sqrt(variance)"),
    Fault("arithmetic class centres", "roughness/spectra.py", "16e-6 * 4.0**n", "20e-6 * 4.0**n"),
    Fault("limits at the centres", "roughness/spectra.py", "roughness < 2 * centre", "roughness < centre"),
    Fault("waviness ignored", "roughness/spectra.py", "power = 1 - self.waviness", "power = 1 - 2.0"),
    Fault("seed ignored", "roughness/profiles.py", "default_rng(number)", "default_rng(0)"),
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
    Fault("rate of the blending missing", "roughness/excitation.py", "smooth_step_slope(setting_in)", "0.0"),
    # Finite roads.
    Fault("shape function", "reference/finite_guideway.py", "[0, 1, -2, 1]", "[0, 1, -1, 0]"),
    Fault("slope of an element not scaled", "reference/finite_guideway.py", "/ element**derivative", "/ 1.0"),
    Fault(
        "Pasternak layer missing",
        "reference/finite_guideway.py",
        "sparse.kron(integrals[1], layers.shear)",
        "0.0 * sparse.kron(integrals[1], layers.shear)",
    ),
    Fault(
        "bending damping as a dashpot",
        "reference/finite_guideway.py",
        "track.beam.bending_damping * integrals[2]",
        "track.beam.bending_damping * integrals[0]",
    ),
    Fault("sleepers on the ground", "reference/finite_guideway.py", "stretch[n + 1 : n + 2] = -1.0", "pass"),
    Fault(
        "absorption begins where it should end",
        "reference/finite_guideway.py",
        "smooth_step(1.0 - distance / length)",
        "smooth_step(distance / length)",
    ),
    # Plates.
    Fault("half of the twist", "reference/plate.py", "4 * twist * uxy * vxy", "2 * twist * uxy * vxy"),
    Fault(
        "no curvature across from one along",
        "reference/plate.py",
        "coupling * (uxx * vyy + uyy * vxx)",
        "0 * coupling * (uxx * vyy + uyy * vxx)",
    ),
    Fault("beam's stiffness for the plate's", "reference/plate.py", "bending / (1 - poisson**2)", "bending"),
    Fault("ratio for its root", "reference/plate.py", "np.sqrt(transverse) * along", "transverse * along"),
    Fault("mass of the whole width", "reference/plate.py", "beam.mass / width * carries", "beam.mass * carries"),
    Fault(
        "slope across for the deflection",
        "reference/plate.py",
        "(positions, derivative), (beside, 0)",
        "(positions, derivative), (beside, derivative)",
    ),
    Fault("nodes along for nodes across", "reference/plate.py", '"pis,pjt->pijts"', '"pis,pjt->pjits"'),
    Fault(
        "pinned end may twist",
        "reference/plate.py",
        "HELD_BY_DEFLECTION = np.array([True, False, True, False])",
        "HELD_BY_DEFLECTION = np.array([True, False, False, False])",
    ),
    Fault(
        "dashpots of the whole width at each place",
        "reference/plate.py",
        "length, positions) / width",
        "length, positions)",
    ),
    Fault(
        "plate moved on by a node too few",
        "reference/plate.py",
        "column=NODAL * (count[1] + 1)",
        "column=NODAL * count[1]",
    ),
    Fault(
        "struck where it is watched",
        "reference/plate.py",
        "beside[:, None] - beside, beside)",
        "beside[:, None] - beside, beside[:, None])",
    ),
    Fault("mirror that leaves the source", "reference/plate.py", "[1.0, -1.0, -1.0]", "[1.0, -1.0, 1.0]"),
    Fault("struck in the middle", "reference/impulse.py", "0, blow.across).toarray()", "0, 0.0).toarray()"),
    Fault("watched beside the centre line", "reference/impulse.py", "(sources + beside)[seen]", "beside[seen]"),
    Fault(
        "plain: every wheel on the centre line",
        "reference/marching.py",
        "touching, nobody = (self.contacts, self.contacts_across)",
        "touching, nobody = (self.contacts, 0.0)",
    ),
    Fault(
        "every wheel begins on the centre line",
        "reference/marching.py",
        "rows = road.rows(at, 0, self.contacts_across)",
        "rows = road.rows(at, 0, 0.0)",
    ),
    Fault(
        "road twice as wide",
        "reference/requirements.py",
        "np.abs(across).max() > 0.5 *",
        "np.abs(across).max() > 1 *",
    ),
    Fault(
        "place of the source for the offset across",
        "guideways/sampled.py",
        "else (self.across, self.source_across)",
        "else (self.source_across, self.across)",
    ),
    Fault("guided end held", "reference/finite_guideway.py", '"guided": (False, True)', '"guided": (True, True)'),
    # Schemes and the plain loop.
    Fault("generalised α without its β", "reference/schemes.py", "0.25 * (1 - alpha_m + alpha_f) ** 2", "0.25"),
    Fault(
        "alphas exchanged",
        "reference/schemes.py",
        "(2 * radius - 1) / (radius + 1), radius / (radius + 1)",
        "radius / (radius + 1), (2 * radius - 1) / (radius + 1)",
    ),
    Fault(
        "damping missing in the effective matrix",
        "reference/marching.py",
        "gamma * dt * self.road.damping",
        "0.0 * dt * self.road.damping",
    ),
    Fault(
        "β twice in the effective matrix",
        "reference/marching.py",
        "beta * dt * dt * self.road.stiffness",
        "2 * beta * dt * dt * self.road.stiffness",
    ),
    Fault(
        "vehicle without (1 − α_f)",
        "reference/marching.py",
        "np.linalg.inv((1 - alpha_m) * law.mass + (1 - alpha_f) * moving)",
        "np.linalg.inv((1 - alpha_m) * law.mass + moving)",
    ),
    Fault(
        "plain: convective term with the wrong sign", "reference/marching.py", "sinking += self", "sinking -= self"
    ),
    Fault("plain: rate of the road missing", "reference/marching.py", "- sinking + rate[step])", "- sinking)"),
    Fault("plain: old forces forgotten", "reference/marching.py", "(alpha_f * state.acting)", "(0 * state.acting)"),
    Fault(
        "plain: moved on by one unknown too many",
        "reference/marching.py",
        "gone = elements * self.road.column",
        "gone = elements * self.road.column + 1",
    ),
    Fault(
        "half an element late",
        "reference/marching.py",
        "/ self.road.spacing + SAME_PLACE",
        "/ self.road.spacing + 0.5",
    ),
    # The compiled loops.
    Fault(
        "convective term with the wrong sign",
        "reference/compiled.py",
        "dw += speed * slopes",
        "dw -= speed * slopes",
    ),
    Fault("convective term missing", "reference/compiled.py", "dw += speed * slopes", "dw += 0.0 * slopes"),
    Fault(
        "convective term missing in what a force does",
        "reference/compiled.py",
        "+ speed * lift_u * yielding",
        "+ 0.0 * yielding",
    ),
    Fault("rate of the road missing", "reference/compiled.py", "(dup - dw + rate[step, j])", "(dup - dw)"),
    Fault("old forces forgotten", "reference/compiled.py", "alpha_f * values_before[j, q] * acting[j]", "0.0"),
    Fault("old places not moved on", "reference/compiled.py", "before[j, q] -= gone", "before[j, q] -= 0"),
    Fault(
        "forces at their full",
        "reference/compiled.py",
        "+= keep * values[j, q] * gap[j]",
        "+= values[j, q] * gap[j]",
    ),
    Fault(
        "moved on by one unknown too many",
        "reference/compiled.py",
        "gone = min(2 * elements, n)",
        "gone = min(2 * elements + 1, n)",
    ),
    Fault(
        "lower half of the core",
        "reference/compiled.py",
        "core[q - 1 - b, q - 1 - a] += work",
        "core[q - 1 - b, q - 1 - a] -= work",
    ),
    Fault(
        "slope of a shape function",
        "reference/compiled.py",
        "slopes[1] = 1.0 + s * (3.0 * s - 4.0)",
        "slopes[1] = 1.0 + s * (3.0 * s - 2.0)",
    ),
    Fault("band product one short", "reference/compiled.py", "+ l3[i] * w3[i]", "+ 0.0 * w3[i]"),
    Fault(
        "suspension does not damp",
        "reference/compiled.py",
        "vehicle_damping[i, p] * (keep * free_dz[p] + alpha_f * dz[p])",
        "0.0",
    ),
    Fault(
        "exchange that fails goes unnoticed",
        "reference/compiled.py",
        "                if count < 0:\n                    return step, worst\n",
        "",
    ),
    Fault(
        "acceleration of a later instant",
        "reference/compiled.py",
        "if alpha_m != 0.0 or alpha_f != 0.0:",
        "if False:",
    ),
    Fault(
        "plain: acceleration of a later instant",
        "reference/marching.py",
        "record[4][step] = self._mass_inverse @ push",
        "pass",
    ),
    # Steady travel, footprint, prescribed forces.
    Fault(
        "run-in with the loads of a rigid road",
        "reference/coupled.py",
        "static_loads - held @ deflection",
        "static_loads",
    ),
    Fault("sag counted as motion", "reference/coupled.py", "motion -= steady.motion", "pass"),
    Fault(
        "footprint twice as long in time", "reference/coupled.py", "half = 0.5 * passing", "half = 1.0 * passing"
    ),
    Fault(
        "acceleration at the start missing", "reference/moving_load.py", ".T @ forces[0])", ".T @ (0 * forces[0]))"
    ),
    Fault(
        "vehicle too stiff for the scheme",
        "reference/requirements.py",
        "highest**2 + own",
        "highest**2 + 0.0 * own",
    ),
    Fault("jump at the start of the record", "reference/coupled.py", "march.begun(", "(lambda *_: None)("),
    Fault(
        "Duhamel: jump at the start",
        "reference/duhamel.py",
        "earlier[:, columns], first)",
        "earlier[:, columns], 0 * first)",
    ),
    Fault(
        "redistributed weight iterated without the road",
        "reference/coupled.py",
        "np.linalg.solve(np.eye(len(held)) + held @ yields, missing)",
        "missing",
    ),
    Fault("impulse as an acceleration", "reference/impulse.py", "state.road[1] = march", "state.road[2] = march"),
    Fault("one road for all", "reference/impulse.py", "np.mean(records, axis=0)", "records[0]"),
    Fault("reflections unseen", "reference/impulse.py", "share ** (2 * len(roads))", "0 * share"),
    Fault("first sample counts fully", "guideways/sampled.py", "samples[0] *= 0.5", "samples[0] *= 1.0"),
    Fault("transform of the other sign", "guideways/sampled.py", "phase = -1j", "phase = 1j"),
    Fault("nothing is beyond Nyquist", "guideways/sampled.py", "<= np.pi / self.time_step", "<= np.inf"),
    Fault(
        "wrong half of the first hat",
        "reference/duhamel.py",
        "whole, _, first = weights",
        "whole, first, _ = weights",
    ),
    Fault("hat leaning the other way", "reference/duhamel.py", "(trapezoid * (1 - share))", "(trapezoid * share)"),
    Fault("plain: backward differences", "reference/duhamel.py", "(1.5, -2.0, 0.5)", "(1.5, -2.0, -0.5)"),
    Fault("backward differences", "reference/compiled.py", "a, b, c = 1.5, -2.0, 0.5", "a, b, c = 1.5, -2.0, -0.5"),
    Fault("oldest force first", "reference/duhamel.py", "kernel[:, :, :0:-1]", "kernel[:, :, 1:]"),
]


def selection(fault: Fault | None) -> list[str]:
    """List what runs against a fault: first the tests that lie next to it."""
    file = fault.file if fault else ""
    independent = file.startswith(("reference/", "guideways/sampled"))
    chosen = REFERENCE + SELECTION if independent else SELECTION + REFERENCE
    return sorted(chosen, key=lambda tests: "plate" not in tests) if "plate" in file else chosen


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
        command = [sys.executable, "-c", RUN, "-x", "-q", "-p", "no:cacheprovider", "--tb=line", *selection(fault)]
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

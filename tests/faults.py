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
    "tests/laws/test_random.py",
    "tests/test_roads.py",
    "tests/test_random_command.py",
]

# These first where the fault lies in files of profiles, what is done to them and what is said of them.
PROFILES = ["tests/test_preparation.py", "tests/test_readers.py", "tests/test_profile_description.py"]

# These first where the fault lies in what is shown: figures, tables, files.
REPORTS = [
    "tests/test_plots.py",
    "tests/test_measure_command.py",
    "tests/test_random_command.py",
    "tests/test_report.py",
    "tests/test_cli.py",
]
SHOWN = ("reports/", "commands/", "results/files", "_basics/wording")

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
    Fault("sleeper inertia sign", "guideways/foundations.py", "{(0, 2): self.mass}", "{(0, 2): -self.mass}"),
    Fault("sleeper on a dashpot", "guideways/foundations.py", "{(0, 2): self.mass}", "{(0, 1): self.mass}"),
    Fault("rotary inertia sign", "guideways/beams.py", "rotation[0, 2] = inertia", "rotation[0, 2] = -inertia"),
    Fault("rotary inertia forgotten", "guideways/beams.py", "shearing[2, 2] = shear * inertia", "pass"),
    Fault("bending damping order", "guideways/beams.py", "terms[4, 1]", "terms[2, 1]"),
    Fault(
        "shear layer as a spring",
        "guideways/foundations.py",
        "{(2, 0): self.shear_stiffness}",
        "{(0, 0): self.shear_stiffness}",
    ),
    Fault("layers side by side", "guideways/foundations.py", ".in_series(layer)", " + layer"),
    # Spectra and time.
    Fault("window sign", "response/line.py", "np.exp(-self.decay", "np.exp(self.decay"),
    Fault("window not undone", "response/line.py", "np.exp(self.decay", "np.exp(0.0 * self.decay"),
    Fault("line on the real axis", "response/line.py", "- 1j * self.decay", "+ 0j * self.decay"),
    Fault(
        "hertz for radians",
        "response/line.py",
        "2 * np.pi / (self.padded * self.time_step)",
        "1 / (self.padded * self.time_step)",
    ),
    Fault(
        "truncation in radians",
        "response/line.py",
        "int(share * self.truncation * self",
        "int(share * self.truncation / 6.283 * self",
    ),
    Fault("truncation that cuts sharply", "response/line.py", "STIFFENING = 0.05", "STIFFENING = 1e-6"),
    Fault(
        "road that does not stiffen",
        "response/solve.py",
        "frf * grid.compliance(slice(first, first + kept))[:, None, None]",
        "frf * 1.0",
    ),
    Fault(
        "load's road that does not fade",
        "response/moving_loads.py",
        "frf * grid.compliance(some)[:, None, None]",
        "frf * 1.0",
    ),
    Fault("whole weight at the start", "response/line.py", "padded[:, 0] *= 0.5", "padded[:, 0] *= 1.0"),
    Fault(
        "record stops at its end",
        "response/line.py",
        "row[self.samples :] = self._continuation(history)",
        "row[self.samples :] = 0.0",
    ),
    Fault("acceleration sign", "response/line.py", "(1j * self.omega(", "(1 * self.omega("),
    Fault("velocity for acceleration", "response/solve.py", "derivative=2", "derivative=1"),
    # Coupling.
    Fault("roughness sign", "response/solve.py", "displacement = -roughness[", "displacement = +roughness["),
    Fault(
        "beyond the truncation nothing moves",
        "response/solve.py",
        "        motion[first:last], force",
        "        displacement[kept:] = 0.0\n        motion[first:last], force",
    ),
    Fault("deflection lifts the vehicle", "response/solve.py", "displacement[:kept] +=", "displacement[:kept] -="),
    Fault(
        "sag leaves the loads alone",
        "response/system.py",
        "np.linalg.solve(np.eye(len(frf)) + stiffness @ frf, system.vehicle.static_loads)",
        "system.vehicle.static_loads",
    ),
    Fault("steady basin reversed", "response/system.py", "deflection=frf @ load", "deflection=frf.T @ load"),
    Fault("static sag missing", "response/simulation.py", "deflection += steady.deflection", "pass"),
    Fault("footprint twice as long", "vehicles/contact.py", "half = 0.5 *", "half = 1.0 *"),
    Fault("cams twice as far apart", "vehicles/contact.py", "0.5 * self.cams", "1.0 * self.cams"),
    Fault("enveloping left out", "response/simulation.py", "if contact.envelops]", "if False]"),
    Fault("stability: the arc left out", "response/stability.py", "if not rigid:", "if True:"),
    Fault("unstable taken for stable", "response/stability.py", "round(-float(turned)", "round(float(turned)"),
    Fault("stability not looked at", "response/stability.py", "    if growing:\n", "    if False:\n"),
    # Vehicle.
    Fault("gravity", "vehicles/vehicle.py", "GRAVITY = 9.81", "GRAVITY = 9.80665"),
    Fault("tyre damping missing", "vehicles/dynamics.py", "np.diag(dashpots)", "0.0 * np.diag(dashpots)"),
    Fault(
        "inertia sign", "vehicles/dynamics.py", "(self.linear + s * self.square)", "(self.linear - s * self.square)"
    ),
    Fault("rigid motion turned", "vehicles/dynamics.py", "free[bound] = -inverse", "free[bound] = inverse"),
    Fault(
        "inertia above rigid contacts missing",
        "vehicles/dynamics.py",
        ".T + prescribed.T @ a @ prescribed",
        ".T + 0.0 * prescribed.T @ a @ prescribed",
    ),
    Fault(
        "force on the vehicle for that on the road",
        "vehicles/dynamics.py",
        "force -= self.direct",
        "force += self.direct",
    ),
    Fault("weight above rigid contacts missing", "vehicles/vehicle.py", "(self.weights - impedance", "(-impedance"),
    Fault(
        "tipping vehicles accepted",
        "vehicles/vehicle.py",
        "np.flatnonzero(~(loads > 0))",
        "np.flatnonzero(loads != loads)",
    ),
    Fault(
        "nose up",
        "vehicles/assembly.py",
        "(position - self.position, self.pitch_inertia)",
        "(self.position - position, self.pitch_inertia)",
    ),
    Fault(
        "right side down",
        "vehicles/assembly.py",
        "(across - self.across, self.roll_inertia)",
        "(self.across - across, self.roll_inertia)",
    ),
    Fault(
        "wheels weightless",
        "vehicles/assembly.py",
        "self.downward.add(body.dof_names[0])",
        "self.downward.update(body.dof_names[:1] if n == 0 else [])",
    ),
    Fault("hitch turned", "vehicles/assembly.py", "free[given_up] = -np.linalg", "free[given_up] = np.linalg"),
    Fault("dampers left out", "vehicles/assembly.py", "suspension.damping * square", "0.0 * square"),
    Fault("convoy ahead of itself", "vehicles/combined.py", "behind = -np.concatenate", "behind = np.concatenate"),
    Fault("both seats on the floor", "vehicles/combined.py", "        below = above\n", ""),
    Fault("half a wheel on each side", "vehicles/trucks.py", "(0.5, sides[1], 1", "(1.0, sides[1], 1"),
    Fault("Hertz' exponent", "vehicles/rail.py", "1.5 / constant", "1.0 / constant"),
    Fault("rear bogie ahead", "vehicles/rail.py", '"bogie_2": -0.5 * apart', '"bogie_2": 0.6 * apart'),
    Fault("contacts transposed", "vehicles/vehicle.py", "ahead[:, None] - ahead", "ahead - ahead[:, None]"),
    Fault(
        "left and right transposed", "vehicles/vehicle.py", "across[:, None] - across", "across - across[:, None]"
    ),
    Fault(
        "receiver's place for the source's",
        "vehicles/vehicle.py",
        "np.broadcast_to(across, offsets",
        "np.broadcast_to(across[:, None], offsets",
    ),
    Fault("paths exchanged", "vehicles/cars.py", "path=side", "path=1 - side"),
    Fault(
        "wheels exchanged across",
        "vehicles/cars.py",
        "path=side,\n                across=aside[side]",
        "path=side,\n                across=aside[1 - side]",
    ),
    # Road.
    Fault("two-sided density", "roughness/realisation.py", "np.sqrt(variance / 2)", "np.sqrt(variance)"),
    Fault("arithmetic class centres", "roughness/spectra/iso.py", "16e-6 * 4.0**n", "20e-6 * 4.0**n"),
    Fault("limits at the centres", "roughness/spectra/iso.py", "roughness < 2 * centre", "roughness < centre"),
    Fault(
        "waviness ignored",
        "roughness/spectra/spectrum.py",
        "power = 1 - np.asarray(exponent, float)",
        "power = np.array(-1.0)",
    ),
    Fault(
        "variance from zero on",
        "roughness/spectra/spectrum.py",
        "self._integral(self.band[0],",
        "self._integral(0.5 * self.band[0],",
    ),
    Fault(
        "content beside the band",
        "roughness/spectra/spectrum.py",
        "np.where(n == spatial_frequency, self._formula(n), 0.0)",
        "self._formula(n)",
    ),
    Fault(
        "per radian",
        "roughness/spectra/rail.py",
        "FRA_CORNER**2 / (2 * np.pi) ** 3",
        "FRA_CORNER**2 / (2 * np.pi) ** 2",
    ),
    Fault(
        "German per radian",
        "roughness/spectra/rail.py",
        "return self.roughness / (2 * np.pi) * c**2",
        "return self.roughness * c**2",
    ),
    Fault("cubic centimetres", "roughness/spectra/rail.py", "3.9488e-4]) * 1e-6", "3.9488e-4]) * 1e-4"),
    Fault("pieces without an end", "roughness/spectra/rail.py", "np.array([*CHINESE_BREAKS, np.inf])", "np.inf"),
    Fault("partial fraction", "roughness/spectra/rail.py", "b**2 / 3 * (low", "b**2 * (low"),
    Fault(
        "level of an amplitude",
        "roughness/spectra/tabulated.py",
        "REFERENCE**2 * 10 ** (np.asarray(self.level)[order] / 10)",
        "REFERENCE**2 * 10 ** (np.asarray(self.level)[order] / 20)",
    ),
    Fault(
        "levels in the order given",
        "roughness/spectra/tabulated.py",
        "order = np.argsort(-np.asarray(self.wavelength))",
        "order = np.arange(np.size(self.wavelength))",
    ),
    Fault(
        "table straight in density",
        "roughness/spectra/tabulated.py",
        "np.interp(np.log(n), np.log(knots), np.log(values))",
        "np.log(np.interp(n, knots, values))",
    ),
    # Paths, distributions, shapes.
    Fault(
        "coherence over half of the distance",
        "roughness/spectra/coherence.py",
        "z = 2 * np.pi * np",
        "z = np.pi * np",
    ),
    Fault(
        "waviness for the order",
        "roughness/spectra/coherence.py",
        "order = self.waviness / 2",
        "order = self.waviness / 2.5",
    ),
    Fault(
        "paths without an own part",
        "roughness/realisation.py",
        "own = rest[:, :1] > SMALLEST_PIVOT",
        "own = rest[:, :1] > 0.9",
    ),
    Fault(
        "coherence squared in realisations",
        "roughness/realisation.py",
        "rest = matrix[:, j:, j] -",
        "rest = matrix[:, j:, j] ** 2 -",
    ),
    Fault(
        "spread of a Laplace road",
        "roughness/realisation.py",
        "spread = kurtosis / 3 - 1",
        "spread = kurtosis / 6 - 0.5",
    ),
    Fault(
        "Laplace road half as rough",
        "roughness/realisation.py",
        "rng.gamma(1 / spread, spread,",
        "rng.gamma(1 / spread, spread / 2,",
    ),
    Fault("segments of a step", "roughness/realisation.py", "* (step / segment) *", "*"),
    Fault(
        "a flat lifts the wheel",
        "roughness/irregularities.py",
        "elevation = -(np.maximum(chord / 2",
        "elevation = (np.maximum(chord / 2",
    ),
    Fault("flat once per diameter", "roughness/irregularities.py", "at, 2 * np.pi * radius))", "at, 2 * radius))"),
    Fault("pothole that rises", "roughness/irregularities.py", "-depth * smooth_step(", "depth * smooth_step("),
    Fault(
        "weld twice as deep",
        "roughness/irregularities.py",
        "d * np.cos(np.pi * np.clip(",
        "2 * d * np.cos(np.pi * np.clip(",
    ),
    Fault(
        "joints that do not bend",
        "roughness/irregularities.py",
        "1 - away / reach, 0.0) ** 2",
        "1 - away / reach, 0.0)",
    ),
    Fault("wheel that falls into a gap", "roughness/combination.py", "relief = min(", "relief = 0.5 * min("),
    Fault(
        "sum on the first grid",
        "roughness/combination.py",
        "[profile.stations for profile in profiles]))",
        "[profile.stations for profile in profiles[:1]]))",
    ),
    Fault(
        "shape that starts at zero",
        "scenarios/roads.py",
        "last - first, start=first, **given)",
        "last - first, **given)",
    ),
    Fault(
        "strangers taken for one path", "roughness/road.py", "return 0.0 if different", "return 1.0 if different"
    ),
    Fault(
        "surface without a coherence",
        "roughness/road.py",
        "return coherence if coherence is not None else presumed(spectrum)",
        "return coherence",
    ),
    Fault("seed ignored", "roughness/realisation.py", "default_rng(number)", "default_rng(0)"),
    Fault("second path is the first", "roughness/profile.py", "elevation[:, path]", "elevation[:, 0]"),
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
    Fault("shape function", "stepping/finite_track.py", "[0, 1, -2, 1]", "[0, 1, -1, 0]"),
    Fault("slope of an element not scaled", "stepping/finite_track.py", "/ element**derivative", "/ 1.0"),
    Fault(
        "Pasternak layer missing",
        "stepping/finite_track.py",
        "sparse.kron(integrals[1], layers.shear)",
        "0.0 * sparse.kron(integrals[1], layers.shear)",
    ),
    Fault(
        "bending damping as a dashpot",
        "stepping/finite_track.py",
        "track.beam.bending_damping * integrals[2]",
        "track.beam.bending_damping * integrals[0]",
    ),
    Fault("sleepers on the ground", "stepping/finite_track.py", "stretch[n + 1 : n + 2] = -1.0", "pass"),
    Fault(
        "absorption begins where it should end",
        "stepping/finite_track.py",
        "smooth_step(1.0 - distance / length)",
        "smooth_step(distance / length)",
    ),
    # Plates.
    Fault("half of the twist", "stepping/finite_plate.py", "4 * twist * uxy * vxy", "2 * twist * uxy * vxy"),
    Fault(
        "no curvature across from one along",
        "stepping/finite_plate.py",
        "coupling * (uxx * vyy + uyy * vxx)",
        "0 * coupling * (uxx * vyy + uyy * vxx)",
    ),
    Fault("beam's stiffness for the plate's", "stepping/finite_plate.py", "bending / (1 - poisson**2)", "bending"),
    Fault("ratio for its root", "stepping/finite_plate.py", "np.sqrt(transverse) * along", "transverse * along"),
    Fault(
        "mass of the whole width", "stepping/finite_plate.py", "beam.mass / width * carries", "beam.mass * carries"
    ),
    Fault(
        "slope across for the deflection",
        "stepping/finite_plate.py",
        "(positions, derivative), (beside, 0)",
        "(positions, derivative), (beside, derivative)",
    ),
    Fault("nodes along for nodes across", "stepping/finite_plate.py", '"pis,pjt->pijts"', '"pis,pjt->pjits"'),
    Fault(
        "pinned end may twist",
        "stepping/finite_plate.py",
        "HELD_BY_DEFLECTION = np.array([True, False, True, False])",
        "HELD_BY_DEFLECTION = np.array([True, False, False, False])",
    ),
    Fault(
        "dashpots of the whole width at each place",
        "stepping/finite_plate.py",
        "length, positions) / width",
        "length, positions)",
    ),
    Fault(
        "plate moved on by a node too few",
        "stepping/finite_plate.py",
        "column=NODAL * (count[1] + 1)",
        "column=NODAL * count[1]",
    ),
    Fault(
        "struck where it is watched",
        "stepping/finite_plate.py",
        "beside[:, None] - beside, beside)",
        "beside[:, None] - beside, beside[:, None])",
    ),
    Fault("mirror that leaves the source", "stepping/finite_plate.py", "[1.0, -1.0, -1.0]", "[1.0, -1.0, 1.0]"),
    Fault("struck in the middle", "stepping/impulse.py", "0, blow.across).toarray()", "0, 0.0).toarray()"),
    Fault("watched beside the centre line", "stepping/impulse.py", "(sources + beside)[seen]", "beside[seen]"),
    Fault(
        "plain: every wheel on the centre line",
        "stepping/marching.py",
        "touching, nobody = (self.contacts, self.contacts_across)",
        "touching, nobody = (self.contacts, 0.0)",
    ),
    Fault(
        "every wheel begins on the centre line",
        "stepping/marching.py",
        "rows = road.rows(at, 0, self.contacts_across)",
        "rows = road.rows(at, 0, 0.0)",
    ),
    Fault(
        "road twice as wide",
        "stepping/requirements.py",
        "np.abs(across).max() > 0.5 *",
        "np.abs(across).max() > 1 *",
    ),
    Fault(
        "place of the source for the offset across",
        "guideways/sampled.py",
        "else (self.across, self.source_across)",
        "else (self.source_across, self.across)",
    ),
    Fault("guided end held", "stepping/finite_track.py", '"guided": (False, True)', '"guided": (True, True)'),
    # Schemes and the plain loop.
    Fault("generalised α without its β", "stepping/schemes.py", "0.25 * (1 - alpha_m + alpha_f) ** 2", "0.25"),
    Fault(
        "alphas exchanged",
        "stepping/schemes.py",
        "(2 * radius - 1) / (radius + 1), radius / (radius + 1)",
        "radius / (radius + 1), (2 * radius - 1) / (radius + 1)",
    ),
    Fault(
        "damping missing in the effective matrix",
        "stepping/marching.py",
        "gamma * dt * self.road.damping",
        "0.0 * dt * self.road.damping",
    ),
    Fault(
        "β twice in the effective matrix",
        "stepping/marching.py",
        "beta * dt * dt * self.road.stiffness",
        "2 * beta * dt * dt * self.road.stiffness",
    ),
    Fault(
        "vehicle without (1 − α_f)",
        "stepping/marching.py",
        "np.linalg.inv((1 - alpha_m) * law.mass + (1 - alpha_f) * moving)",
        "np.linalg.inv((1 - alpha_m) * law.mass + moving)",
    ),
    Fault(
        "plain: convective term with the wrong sign", "stepping/marching.py", "sinking += self", "sinking -= self"
    ),
    Fault("plain: rate of the road missing", "stepping/marching.py", "- sinking + rate[step])", "- sinking)"),
    Fault("plain: old forces forgotten", "stepping/marching.py", "(alpha_f * state.acting)", "(0 * state.acting)"),
    Fault(
        "plain: moved on by one unknown too many",
        "stepping/marching.py",
        "gone = elements * self.road.column",
        "gone = elements * self.road.column + 1",
    ),
    Fault(
        "half an element late",
        "stepping/marching.py",
        "/ self.road.spacing + SAME_PLACE",
        "/ self.road.spacing + 0.5",
    ),
    # The compiled loops.
    Fault(
        "convective term with the wrong sign",
        "stepping/compiled.py",
        "dw += speed * slopes",
        "dw -= speed * slopes",
    ),
    Fault("convective term missing", "stepping/compiled.py", "dw += speed * slopes", "dw += 0.0 * slopes"),
    Fault(
        "convective term missing in what a force does",
        "stepping/compiled.py",
        "+ speed * lift_u * yielding",
        "+ 0.0 * yielding",
    ),
    Fault("rate of the road missing", "stepping/compiled.py", "(dup - dw + rate[step, j])", "(dup - dw)"),
    Fault("old forces forgotten", "stepping/compiled.py", "alpha_f * values_before[j, q] * acting[j]", "0.0"),
    Fault("old places not moved on", "stepping/compiled.py", "before[j, q] -= gone", "before[j, q] -= 0"),
    Fault(
        "forces at their full",
        "stepping/compiled.py",
        "+= keep * values[j, q] * gap[j]",
        "+= values[j, q] * gap[j]",
    ),
    Fault(
        "moved on by one unknown too many",
        "stepping/compiled.py",
        "gone = min(2 * elements, n)",
        "gone = min(2 * elements + 1, n)",
    ),
    Fault(
        "lower half of the core",
        "stepping/kernels.py",
        "core[q - 1 - b, q - 1 - a] += work",
        "core[q - 1 - b, q - 1 - a] -= work",
    ),
    Fault(
        "slope of a shape function",
        "stepping/kernels.py",
        "slopes[1] = 1.0 + s * (3.0 * s - 4.0)",
        "slopes[1] = 1.0 + s * (3.0 * s - 2.0)",
    ),
    Fault("band product one short", "stepping/kernels.py", "+ l3[i] * w3[i]", "+ 0.0 * w3[i]"),
    Fault(
        "suspension does not damp",
        "stepping/compiled.py",
        "vehicle_damping[i, p] * (keep * free_dz[p] + alpha_f * dz[p])",
        "0.0",
    ),
    Fault(
        "exchange that fails goes unnoticed",
        "stepping/compiled.py",
        "                if count < 0:\n                    return step, worst\n",
        "",
    ),
    Fault(
        "acceleration of a later instant",
        "stepping/compiled.py",
        "if alpha_m != 0.0 or alpha_f != 0.0:",
        "if False:",
    ),
    Fault(
        "plain: acceleration of a later instant",
        "stepping/marching.py",
        "record[4][step] = self._mass_inverse @ push",
        "pass",
    ),
    # Steady travel, footprint, prescribed forces.
    Fault(
        "run-in with the loads of a rigid road",
        "stepping/coupled.py",
        "static_loads - held @ deflection",
        "static_loads",
    ),
    Fault("sag counted as motion", "stepping/coupled.py", "motion -= steady.motion", "pass"),
    Fault("footprint twice as long in time", "stepping/coupled.py", "half = 0.5 * passing", "half = 1.0 * passing"),
    Fault(
        "acceleration at the start missing", "stepping/moving_loads.py", ".T @ forces[0])", ".T @ (0 * forces[0]))"
    ),
    Fault(
        "vehicle too stiff for the scheme",
        "stepping/requirements.py",
        "highest**2 + own",
        "highest**2 + 0.0 * own",
    ),
    Fault("jump at the start of the record", "stepping/coupled.py", "march.begun(", "(lambda *_: None)("),
    Fault(
        "Duhamel: jump at the start",
        "stepping/duhamel.py",
        "earlier[:, columns], first)",
        "earlier[:, columns], 0 * first)",
    ),
    Fault(
        "redistributed weight iterated without the road",
        "stepping/coupled.py",
        "np.linalg.solve(np.eye(len(held)) + held @ yields, missing)",
        "missing",
    ),
    Fault("impulse as an acceleration", "stepping/impulse.py", "state.road[1] = march", "state.road[2] = march"),
    Fault("one road for all", "stepping/impulse.py", "np.mean(records, axis=0)", "records[0]"),
    Fault("reflections unseen", "stepping/impulse.py", "share ** (2 * len(roads))", "0 * share"),
    Fault("first sample counts fully", "guideways/sampled.py", "samples[0] *= 0.5", "samples[0] *= 1.0"),
    Fault("transform of the other sign", "guideways/sampled.py", "phase = -1j", "phase = 1j"),
    Fault("nothing is beyond Nyquist", "guideways/sampled.py", "<= np.pi / self.time_step", "<= np.inf"),
    Fault(
        "wrong half of the first hat",
        "stepping/duhamel.py",
        "whole, _, first = weights",
        "whole, first, _ = weights",
    ),
    Fault("hat leaning the other way", "stepping/duhamel.py", "(trapezoid * (1 - share))", "(trapezoid * share)"),
    Fault("plain: backward differences", "stepping/duhamel.py", "(1.5, -2.0, 0.5)", "(1.5, -2.0, -0.5)"),
    Fault("backward differences", "stepping/compiled.py", "a, b, c = 1.5, -2.0, 0.5", "a, b, c = 1.5, -2.0, -0.5"),
    Fault("oldest force first", "stepping/duhamel.py", "kernel[:, :, :0:-1]", "kernel[:, :, 1:]"),
    # Random roads.
    Fault(
        "rear wheel first", "response/random.py", "np.exp(2j * np.pi * np.outer", "np.exp(-2j * np.pi * np.outer"
    ),
    Fault(
        "density over the road",
        "response/random.py",
        "self.spectrum.density(n) / self.speed",
        "self.spectrum.density(n)",
    ),
    Fault("coherence squared", "response/random.py", "vectors * np.sqrt(np.maximum", "vectors * (np.maximum"),
    Fault("impossible coherence", "response/random.py", "SEMIDEFINITE = 1e-9", "SEMIDEFINITE = 1e9"),
    Fault(
        "random: velocity for acceleration", "response/random.py", "omega[:, None] ** 4 *", "omega[:, None] ** 2 *"
    ),
    Fault("rounding moves", "response/random.py", "ROUNDING = 1e-20", "ROUNDING = 1e-60"),
    Fault(
        "crossings by the fourth moment", "response/random.py", "_rate(second, variance)", "_rate(fourth, second)"
    ),
    Fault("lift-offs too rare", "response/statistics.py", "(crossing) * np.exp(-0.5", "(crossing) * np.exp(-1.0"),
    Fault("lift-offs unseen", "response/statistics.py", "if often > LIFT_OFFS or part", "if False and part"),
    Fault("end of the band unseen", "response/random.py", "if share <= AT_THE_END:", "if share >= 0:"),
    Fault("weighting of amplitudes", "response/random.py", "lines.frequency)) ** 2", "lines.frequency))"),
    Fault(
        "first level counted too often",
        "response/statistics.py",
        "- 0.5 * exceeded[..., 0]",
        "+ 50 * exceeded[..., 0]",
    ),
    Fault("coherence of any shape", "response/random.py", "if shared.shape != shape:", "if False:"),
    Fault(
        "path unlike itself",
        "response/random.py",
        "axis1=1, axis2=2) - 1) > SEMI",
        "axis1=1, axis2=2) - 1) > 1e9 + SEMI",
    ),
    Fault(
        "lopsided coherence",
        "response/random.py",
        "shared.swapaxes(1, 2)) > SEMI",
        "shared.swapaxes(1, 2)) > 9 + SEMI",
    ),
    Fault("damping always blamed", "response/random.py", "NEXT_TO_NONE = 1e-9", "NEXT_TO_NONE = 1e9"),
    Fault("history taken for a spectrum", "metrics/fatigue.py", '"contact_force_density" not in', '"" in'),
    Fault("threads that wait", "response/solve.py", "with unthreaded(contacts):", "with unthreaded(1):"),
    Fault("wide trapezoids", "metrics/fatigue.py", "(0.5 * (gaps[1:]", "(1.0 * (gaps[1:]"),
    Fault("coarse panels", "response/quadrature.py", "UNRESOLVED = 1e-3", "UNRESOLVED = 1e3"),
    Fault("panels that overlap", "response/quadrature.py", "= low[~rough], high", "= low[~rough] - 0.01, high"),
    Fault(
        "road that lifts the vehicle twice",
        "response/solve.py",
        "[some] - roughness[some]",
        "[some] + roughness[some]",
    ),
    Fault(
        "acceleration along the motion",
        "response/transfer.py",
        "-(omega[:, None, None] ** 2)",
        "(omega[:, None, None] ** 2)",
    ),
    # Measures.
    Fault(
        "rounded window of the IRI",
        "metrics/iri.py",
        "- 1, 0), (window**2 - 1) / 12",
        "- 1, 0), (round(window) ** 2 - 1) / 12",
    ),
    Fault("average counted twice", "metrics/iri.py", "(window**2 - 1) / 12", "window**2 / 12"),
    Fault("car starts level", "metrics/iri.py", "zi=[-keep * gain * start]", "zi=[0.0 * gain]"),
    Fault("one mode of the golden car", "metrics/iri.py", "found += 2 * driven.real", "found = 2 * driven.real"),
    Fault(
        "ride number of the mean path",
        "metrics/iri.py",
        "np.sqrt(square.mean(axis=1))",
        "np.sqrt(square).mean(axis=1)",
    ),
    Fault("segments one step late", "metrics/iri.py", "bounds - half, 0", "bounds - half + 1, 0"),
    Fault("step of a weighting turned", "metrics/comfort.py", "* (f5 / f6) ** 2", "* (f6 / f5) ** 2"),
    Fault("transition without its zero", "metrics/comfort.py", "(1 + p / (2 * np.pi * first))", "1"),
    Fault(
        "weighting wraps around",
        "metrics/comfort.py",
        "len(values) + int(np.ceil(memory / time_step))",
        "len(values)",
    ),
    Fault(
        "dose of squares",
        "metrics/comfort.py",
        "**4, axis=0) * time_step) ** 0.25",
        "**2, axis=0) * time_step) ** 0.25",
    ),
    Fault(
        "running rms of a mean",
        "metrics/comfort.py",
        "np.arange(1, len(energy)) - steps, 0)",
        "np.arange(1, len(energy)) - 2 * steps, 0)",
    ),
    Fault("rear axle first", "metrics/loads.py", "(points - start) / speed", "(points + start) / speed"),
    Fault(
        "static load forgotten", "metrics/loads.py", "force = static[contact] + CubicSpline", "force = CubicSpline"
    ),
    Fault("tension wears", "metrics/loads.py", "np.maximum(force, 0.0) ** power", "np.abs(force) ** power"),
    Fault("paths added up", "metrics/loads.py", "np.searchsorted(numbers, paths[contact])", "0 * paths[contact]"),
    Fault(
        "repeatability of the mean",
        "metrics/loads.py",
        "other - other.mean(axis=0)",
        "other - 0.0 * other.mean(axis=0)",
    ),
    Fault(
        "ranges for amplitudes",
        "metrics/fatigue.py",
        "np.abs(ends[:, 1] - ends[:, 0]) / 2",
        "np.abs(ends[:, 1] - ends[:, 0])",
    ),
    Fault(
        "open cycles lost",
        "metrics/fatigue.py",
        "for pairs in (closed, fatpack.find_rainflow_cycles(again)[0])",
        "for pairs in (closed,)",
    ),
    Fault(
        "variance for deviation",
        "metrics/fatigue.py",
        "np.exp(0.5 * slope * np.log(variance)",
        "np.exp(slope * np.log(variance)",
    ),
    Fault("falling through a level", "metrics/fatigue.py", "np.diff(history) > 0", "np.diff(history) < 0"),
    Fault(
        "accelerance with the wrong sign",
        "metrics/guideway.py",
        "(1j * omega[:, None]) ** power",
        "omega[:, None] ** power",
    ),
    Fault("decay rate: half a step at the end", "metrics/guideway.py", "/ 2, steps[-1:]]", "/ 2, steps[-1:] / 2]"),
    Fault(
        "decay of the nearest wave",
        "metrics/guideway.py",
        "np.abs(kappa.imag).min(axis=0)",
        "np.abs(kappa.imag).max(axis=0)",
    ),
    Fault("damage beyond a Gaussian process", "metrics/fatigue.py", "if not 0 < share <= 1 + BOUND:", "if False:"),
    Fault("damage of a negative life", "metrics/fatigue.py", "if not 0 < share <= 1", "if not share <= 1"),
    Fault("load that hangs divides", "metrics/loads.py", "where=load > 0)", "where=load != 0)"),
    Fault("load that hangs wears", "metrics/loads.py", "max(static[contact], 0.0)", "static[contact]"),
    Fault("points beyond memory", "metrics/loads.py", "(last - first) / spacing * (BYTES", "0 * (BYTES"),
    Fault("window longer than the road", "metrics/iri.py", "elif shortest > length:", "elif False:"),
    Fault("feet felt like the seat", "metrics/comfort.py", "[SEATED[name] for name in rms]", "1.0"),
    Fault(
        "histories mixed",
        "metrics/comfort.py",
        "np.reshape(values, (shape[0], -1))",
        "np.reshape(values, (-1, 1))",
    ),
    # Profiles from files.
    Fault("units not converted", "roughness/formats/base.py", "else values * scale", "else values"),
    Fault("decimal comma taken for none", "roughness/formats/columns.py", "decimal=layout.decimal", 'decimal="."'),
    Fault("right for left in a grid", "roughness/formats/crg.py", "road.surface_z()[:, ::-1]", "road.surface_z()"),
    Fault("slope and banking left out", "roughness/formats/crg.py", "road.surface_z()[", "road.z["),
    Fault("first path of an ERD file twice", "roughness/formats/erd.py", "values[:, n]", "values[:, 0]"),
    Fault("sphere for the ellipsoid", "roughness/formats/gpx.py", "6.694_379_990_141e-3", "0.0"),
    Fault("rows for columns", "_basics/matlab_file.py", 'reshape(shape, order="F")', "reshape(shape)"),
    Fault("packed bombs let in", "_basics/matlab_file.py", "most or limit)", "most or 0)"),
    Fault("paths between sections", "roughness/files.py", "rights + share * (lefts - rights)", "rights"),
    Fault("gaps filled unasked", "roughness/files.py", "if repair_gaps is None:", "if False:"),
    Fault("gaps of any length filled", "roughness/files.py", "if longest.length > repair_gaps:", "if False:"),
    Fault("high pass of first order", "roughness/preparation.py", "butter(GENTLE, 1 /", "butter(1, 1 /"),
    Fault(
        "resampled with aliases",
        "roughness/preparation.py",
        "if step > old * (1 + 1e-6):",
        "if step > old * (1 + 1e6):",
    ),
    Fault("spikes left in", "roughness/preparation.py", "column[out] = np.interp", "_ = np.interp"),
    Fault("mirror doubles its end", "roughness/preparation.py", "% (2 * last) - last", "% (2 * last + 1) - last"),
    Fault("steps forgotten", "roughness/preparation.py", "steps=(*profile.steps, sentence)", "steps=(sentence,)"),
    Fault("trend left in the spectrum", "metrics/profile.py", "piece -= np.outer", "_ = np.outer"),
    Fault("coherence of amplitudes", "metrics/profile.py", "(real**2 + imaginary**2)", "np.hypot(real, imaginary)"),
    Fault("edges counted with spikes", "metrics/profile.py", "np.flatnonzero(peak & (bend", "np.flatnonzero((bend"),
    Fault(
        "fitted beyond the content",
        "roughness/fitting.py",
        "start + _until_cliff(log_n",
        "log_n.size + 0 * len(log_n",
    ),
    Fault(
        "fitted below the content", "roughness/fitting.py", "return end - _until_cliff", "return 0 * _until_cliff"
    ),
    Fault("long waves that bend cut off", "roughness/fitting.py", "beyond = max(slope, 0.0)", "beyond = 0.0"),
    Fault("corner of a filter fitted", "roughness/fitting.py", "(below[:end] < KEPT)", "(below[:end] < np.inf)"),
    Fault("any spectrum a power law", "roughness/fitting.py", "> LARGEST_MISFIT:", "> np.inf:"),
    Fault("class from far away", "roughness/fitting.py", "if not near or", "if"),
    Fault("no doubt about a class", "roughness/fitting.py", "< CLASS_WIDTH", "< np.inf"),
    Fault("millimetres pass for metres", "metrics/profile.py", '(2 * CLASS_CENTRES["G"], 200.0)', "(1e9, 1e9)"),
    Fault("one level stretch of many", "metrics/profile.py", "[:MOST_STRETCHES]", "[:1]"),
    Fault(
        "equal paths told apart",
        "roughness/profile.py",
        "setdefault(blake2b(column + 0.0).digest()",
        "setdefault(bytes([path])",
    ),
    # What is left out, told apart, cut and refused.
    Fault(
        "vehicle that never runs in",
        "metrics/measures.py",
        "whole, result = result, result.isel",
        "whole, _ = result, result.isel",
    ),
    Fault(
        "weighting that starts anew",
        "metrics/comfort.py",
        "values = weighted(acceleration, time_step, weighting)[first:]",
        "values = weighted(np.asarray(acceleration)[first:], time_step, weighting)",
    ),
    Fault("limit the other way", "metrics/measures.py", "if name in felt.exceeded", "if name not in felt.exceeded"),
    Fault("one refusal for all", "metrics/measures.py", "if common_points(result).size:", "if True:"),
    Fault("nan that passes", "results/labels.py", "~np.isfinite(values)", "np.isinf(values)"),
    Fault(
        "rounding that is felt",
        "response/random.py",
        'statistics["acceleration_rms"] > 0, _',
        'statistics["acceleration_rms"] >= 0, _',
    ),
    Fault("curve that hides another", "reports/curves.py", "<= COINCIDENT * np.abs(other)", "<= np.abs(other)"),
    Fault("roll for a bounce", "reports/curves.py", "units[dof] != units[one] or abs(size", "abs(size"),
    Fault("wheels before bodies", "reports/curves.py", "key=lambda dof: rms[dof])", "key=lambda dof: -rms[dof])"),
    Fault("moving FRF up to a truncation", "reports/frf.py", "return min(max(ends), kept)", "return kept"),
    Fault("table wider than the console", "commands/console.py", "if pieces[-1] and width > left:", "if False:"),
    Fault("once in 1e46 seconds", "_basics/wording.py", "0 < value < NEVER", "0 < value < 0"),
    Fault("file without accelerations", "results/files.py", "if not label.optional]", "if label.optional]"),
]


def selection(fault: Fault | None) -> list[str]:
    """List what runs against a fault: first the tests that lie next to it."""
    file = fault.file if fault else ""
    independent = file.startswith(("stepping/", "guideways/sampled"))
    if file.startswith(
        ("roughness/fi", "roughness/formats", "roughness/preparation", "metrics/profile", "reports/profile")
    ):
        return PROFILES + SELECTION + REFERENCE
    if file.startswith(SHOWN):
        return REPORTS + SELECTION + REFERENCE
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
        for part in ("src", "tests", "docs"):
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

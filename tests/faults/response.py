"""The transform, the coupled system, its stability and truncation, random roads."""

from __future__ import annotations

from tests.faults.fault import Fault

FAULTS = [
    Fault(
        "contact lost at the output's instants alone",
        "response/simulation.py",
        "fine.force.values[0]), journey.time_step / finer",
        "histories.force.values[0]), journey.time_step",
    ),
    Fault("threads of BLAS let loose", "response/batches.py", "limit(limits=1)", "limit(limits=2)"),
    # Spectra and time.
    Fault("window sign", "response/line.py", "np.exp(-decay * step", "np.exp(decay * step"),
    Fault("window not undone", "response/line.py", "np.exp(self.decay * step", "np.exp(0.0 * step"),
    Fault("line on the real axis", "response/line.py", "- 1j * self.decay", "+ 0j * self.decay"),
    Fault(
        "hertz for radians",
        "response/line.py",
        "2 * np.pi / self.period",
        "1 / self.period",
    ),
    Fault(
        "truncation in radians",
        "response/truncation.py",
        "2 * np.pi * share * self.frequency",
        "share * self.frequency",
    ),
    Fault(
        "truncation that cuts sharply",
        "response/truncation.py",
        "stiffening: float = 0.05",
        "stiffening: float = 1e-6",
    ),
    Fault(
        "road that does not stiffen",
        "response/system.py",
        "truncation.admitted(tables.frf, tables.omega)",
        "tables.frf",
    ),
    Fault(
        "load's road that does not fade",
        "response/moving_loads.py",
        "Truncation(frequency=truncation).taper(driven_by.omega)",
        "(driven_by.omega.real <= 2 * np.pi * truncation)",
    ),
    Fault("what folds is mirrored", "response/line.py", "+= np.conj(downward[:, ::-1])", "+= downward[:, ::-1]"),
    Fault("what folds comes once", "response/line.py", "upward[:, within] *= 2.0", "pass"),
    Fault("images fold", "response/sampling.py", "enough = highest <= negligible and (", "enough = True or ("),
    Fault(
        "a sharp end of the content",
        "response/sampling.py",
        "fade = 1.0 - smoothest_step((np.arange(count) - ends + 1) / max(count - ends, 1))",
        "fade = np.ones(count)",
    ),
    Fault(
        "sampled at the output's step",
        "response/sampling.py",
        "wanted.per_station * line.period / step",
        "line.padded",
    ),
    Fault(
        "early counts more than late",
        "response/line.py",
        "np.abs(together(self._parts(given, 0.0)))",
        "np.abs(together(self._parts(given, self.decay)))",
    ),
    Fault(
        "nothing is unresolved",
        "response/accuracy.py",
        "return min(max(peaks, driven_by.missing), 1.0)",
        "return 0.0",
    ),
    Fault("guesses do not matter", "response/simulation.py", "if excitation.guessed <= 0:", "if True:"),
    Fault(
        "truncation's error as estimated",
        "response/accuracy.py",
        "if cut.error <= SAMPLING.estimated or",
        "if True or",
    ),
    Fault("whole weight at the start", "response/line.py", "padded[:, 0] *= 0.5", "padded[:, 0] *= 1.0"),
    Fault(
        "record stops at its end",
        "response/line.py",
        "padded[:, fading : instants.size] *= fade",
        "padded[:, fading : instants.size] *= 0.0",
    ),
    Fault("acceleration sign", "response/line.py", "factor = (1j * self.omega(", "factor = (1 * self.omega("),
    Fault("velocity for acceleration", "response/system.py", "derivative=2", "derivative=1"),
    # Coupling.
    Fault("roughness sign", "response/system.py", "displacement = -roughness", "displacement = +roughness"),
    Fault(
        "beyond the truncation nothing moves",
        "response/system.py",
        "displacement[..., :reach] += deflection",
        "displacement[..., :reach] += deflection\n        displacement[..., reach:] = 0.0",
    ),
    Fault("deflection lifts the vehicle", "response/system.py", "[..., :reach] += defl", "[..., :reach] -= defl"),
    Fault(
        "sag leaves the loads alone",
        "response/survey.py",
        "at_rest.shared(system.vehicle.static_loads[:, None] + 0j)[:, 0].real",
        "system.vehicle.static_loads",
    ),
    Fault("steady basin reversed", "response/survey.py", ".real @ load", ".real.T @ load"),
    Fault("static sag missing", "response/simulation.py", "+ steady.deflection[:, None]", "+ 0.0"),
    Fault(
        "truncation of the first case only",
        "response/influence.py",
        "cases = magnitudes.reshape(-1, *",
        "cases = magnitudes[:1].reshape(-1, *",
    ),
    Fault("ports without a diagonal", "response/system.py", "matrices[port, port] += 1.0", "pass"),
    Fault("Cramer's rule turned", "response/batches.py", "a * second - c * first", "a * second + c * first"),
    Fault(
        "truncation at zero that is none",
        "response/truncation.py",
        "omega.size if self.frequency else 0",
        "omega.size",
    ),
    Fault("stretches that do not join", "response/stability.py", "first + steps + 1]", "first + steps]"),
    Fault("loads all at once", "response/system.py", "self.loads.size * self.points.size", "1"),
    Fault("stability: the arc left out", "response/stability.py", "if not rigid:", "if True:"),
    Fault("unstable taken for stable", "response/stability.py", "round(-turned", "round(turned"),
    Fault("stability not looked at", "response/stability.py", "    if growing:\n", "    if False:\n"),
    # Random roads.
    Fault("rear wheel first", "roughness/excitation.py", "np.exp(1j * np.outer(self", "np.exp(-1j * np.outer(self"),
    Fault(
        "density over the road",
        "response/random.py",
        "self.spectrum.density(n) / self.speed",
        "self.spectrum.density(n)",
    ),
    Fault("coherence squared", "response/random.py", "vectors * np.sqrt(np.maximum", "vectors * (np.maximum"),
    Fault("impossible coherence", "response/random.py", "semidefinite: float = 1e-9", "semidefinite: float = 1e9"),
    Fault("random: velocity for acceleration", "response/random.py", "omega**4 *", "omega**2 *"),
    Fault("rounding moves", "response/random.py", "rounding: float = 1e-20", "rounding: float = 1e-60"),
    Fault(
        "crossings by the fourth moment", "response/random.py", "_rate(second, variance)", "_rate(fourth, second)"
    ),
    Fault("lift-offs too rare", "response/statistics.py", "(crossing) * np.exp(-0.5", "(crossing) * np.exp(-1.0"),
    Fault("lift-offs unseen", "response/statistics.py", "(often > most_times) |", "(often < 0) &"),
    Fault("end of the band unseen", "response/random.py", "if share <= TOLERANCES.at_the_end:", "if share >= 0:"),
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
        "axis1=1, axis2=2) - 1) > TOLERANCES.semi",
        "axis1=1, axis2=2) - 1) > 1e9 + TOLERANCES.semi",
    ),
    Fault(
        "lopsided coherence",
        "response/random.py",
        "shared.swapaxes(1, 2)) > TOLERANCES.semi",
        "shared.swapaxes(1, 2)) > 9 + TOLERANCES.semi",
    ),
    Fault("damping always blamed", "response/random.py", "undamped: float = 1e-9", "undamped: float = 1e9"),
    Fault("threads that wait", "response/batches.py", "limit(limits=1)", "limit(limits=2)"),
    Fault("coarse panels", "response/quadrature.py", "unresolved: float = 1e-3", "unresolved: float = 1e3"),
    Fault("panels that overlap", "response/quadrature.py", "= low[~rough], high", "= low[~rough] - 0.01, high"),
    Fault(
        "acceleration along the motion",
        "response/transfer.py",
        "-(omega[:, None, None] ** 2)",
        "(omega[:, None, None] ** 2)",
    ),
    # What is left out, told apart, cut and refused.
    Fault(
        "rounding that is felt",
        "response/random.py",
        'statistics["acceleration_rms"] > 0, _',
        'statistics["acceleration_rms"] >= 0, _',
    ),
]

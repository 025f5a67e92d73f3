"""Offsets, waves, their sides, the layers below a beam; what a struck road remembers."""

from __future__ import annotations

from tests.faults.fault import Fault

FAULTS = [
    # Guideway: waves, sides, layers.
    Fault("direction of travel", "guideways/waves.py", "-1j * speed", "1j * speed"),
    Fault(
        "no convective terms",
        "guideways/waves.py",
        "range((b + 1 if linear else 1) if coefficient else 0)",
        "range(1)",
    ),
    Fault("binomial missing", "guideways/waves.py", "comb(b, j) *", "1.0 *"),
    Fault("sides exchanged", "guideways/waves.py", "(ahead >= 0) == direction", "(ahead < 0) == direction"),
    Fault("two waves on each side", "guideways/waves.py", "side > 0), infinite", "kappa.real > 0), infinite"),
    Fault("sign behind", "guideways/waves.py", "else -weight[wave, at]", "else weight[wave, at]"),
    Fault(
        "undamped limit from above",
        "guideways/waves.py",
        "np.where(doubtful, (evaluated(",
        "np.where(doubtful, -(evaluated(",
    ),
    Fault(
        "undamped limit missing", "guideways/waves.py", "squared(slope) <= doubt * doubt", "squared(slope) < 0.0"
    ),
    Fault(
        "conjugate pair on one side",
        "guideways/roots.py",
        "rounding_errors: float = 1e4",
        "rounding_errors: float = 1e7",
    ),
    Fault("waves that meet are let through", "guideways/waves.py", "<= 2 * doubt *", "< 0.0 * doubt *"),
    Fault("roots left unsettled", "guideways/roots.py", "if not unsettled.any():", "if number > 0:"),
    Fault("two roots at one place", "guideways/roots.py", "slope - value * others", "slope - 0.0 * others"),
    Fault("slope sign", "guideways/waves.py", "(1j * kappa) ** derivative", "(-1j * kappa) ** derivative"),
    Fault("decay along the road", "guideways/waves.py", "np.exp(1j * ahead[row]", "np.exp(-1j * ahead[row]"),
    # The same, compiled.
    Fault("compiled: waves confused", "guideways/compiled.py", "roots[n] -= step", "roots[n] += step"),
    Fault("compiled: two roots at one place", "guideways/compiled.py", "slope - value * others[n]", "slope"),
    Fault(
        "compiled: sides exchanged",
        "guideways/compiled.py",
        "forward[n, at] = side > 0.0\n            if",
        "forward[n, at] = side < 0.0\n            if",
    ),
    Fault("compiled: undamped limit missing", "guideways/compiled.py", "<= doubt * doubt:", "< 0.0:"),
    Fault(
        "compiled: waves that meet are let through", "guideways/compiled.py", "<= 2.0 * doubt *", "< 0.0 * doubt *"
    ),
    Fault("compiled: sign behind", "guideways/compiled.py", "if offset >= 0.0 else -total", "if True else -total"),
    Fault("never compiled", "_basics/compiling.py", "if _chosen[0] is not False else None", "if False else None"),
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
    Fault("spring beside its dashpot", "guideways/relaxing.py", ").in_series(Ratio(", ") + (Ratio("),
    Fault("tension for compression", "guideways/tensioned.py", "{(2, 0): self.force}", "{(2, 0): -self.force}"),
    Fault("buckled track let in", "guideways/critical.py", "if not positive.size:", "if True:"),
    Fault("shortest wave that buckles", "guideways/critical.py", "among)).argmin()", "among)).argmax()"),
    Fault(
        "front of the waves forgotten",
        "guideways/critical.py",
        "[*dips, *waves.fronts, slowest.min()]",
        "[*dips, slowest.min()]",
    ),
    Fault(
        "waves of six decades", "guideways/critical.py", "first, last = _corners(table)", "first, last = 1.0, 1.0"
    ),
    Fault("climb past a root", "guideways/critical.py", "value * rest[:, 0] > 0", "value == value"),
    Fault("mass below on a shear layer", "guideways/track.py", "if massless and (", "if ("),
    Fault("compressed or not", "guideways/critical.py", "rise * below < above * fall", "False"),
    Fault("layers side by side", "guideways/foundations.py", ".in_series(layer)", " + layer"),
    # What whoever writes a guideway need not write.
    Fault("places across forgotten", "guideways/guideway.py", "    if wide:", "    if False:"),
    Fault("offset for its mirror", "guideways/guideway.py", "rows[back.ravel()]", "rows[back.ravel()[::-1]]"),
    Fault("offsets for frequencies", "guideways/guideway.py", "if found.shape not in {", "if False and {"),
    # Plates.
    Fault(
        "place of the source for the offset across",
        "guideways/sampled.py",
        "else (self.across, self.source_across)",
        "else (self.source_across, self.across)",
    ),
    # Steady travel, footprint, prescribed forces.
    Fault("root of time for a straight line", "guideways/record.py", "= (1.0, 0.5)", "= (1.0,)"),
    Fault("series of the onset cut short", "guideways/record.py", "series: int = 70", "series: int = 2"),
    Fault(
        "onset by trapezoids",
        "guideways/sampled.py",
        "self.samples, stepped=self.stepped)",
        "self.samples, stepped=True)",
    ),
    Fault(
        "what was stepped as if exact",
        "guideways/sampled.py",
        "self.samples, stepped=self.stepped)",
        "self.samples, stepped=False)",
    ),
    Fault("cut off without a word", "guideways/sampled.py", "(*self._cut_off(largest), *self", "(*self"),
    Fault("long step without a word", "guideways/sampled.py", "*self._coarse(largest), ", ""),
    Fault(
        "remarks forgotten", "guideways/sampled.py", "*self._coarse(largest), *remarks)", "*self._coarse(largest))"
    ),
    Fault(
        "tail of the last sample alone",
        "guideways/record.py",
        "rates = np.log(waves) / step",
        "rates = np.log(waves) / time_step",
    ),
    Fault("deaf to the guideway", "guideways/guideway.py", 'getattr(guideway, "findings", ())', "()"),
    Fault("file without remarks", "guideways/files.py", "for remark in guideway.remarks]", "for remark in ()]"),
    Fault("transform of the other sign", "guideways/sampled.py", "phase = -1j", "phase = 1j"),
    Fault("nothing is beyond Nyquist", "guideways/sampled.py", "<= np.pi / self.time_step", "<= np.inf"),
]

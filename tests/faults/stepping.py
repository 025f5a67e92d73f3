"""Finite guideways and plates, schemes, loops plain and compiled, Duhamel's integral, struck guideways."""

from __future__ import annotations

from tests.faults.fault import Fault

FAULTS = [
    # Finite guideways.
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
        "by_deflection = np.array([True, False, True, False])",
        "by_deflection = np.array([True, False, False, False])",
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
        "rows = guideway.rows(at, 0, self.contacts_across)",
        "rows = guideway.rows(at, 0, 0.0)",
    ),
    Fault(
        "road twice as wide",
        "stepping/requirements.py",
        "np.abs(across).max() > 0.5 *",
        "np.abs(across).max() > 1 *",
    ),
    Fault("guided end held", "stepping/finite_track.py", '"guided": End(False, True)', '"guided": End(True, True)'),
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
        "stepping/schemes.py",
        "self.lift_v * damping + self.lift_u * stiffness",
        "self.lift_u * stiffness",
    ),
    Fault(
        "β twice in the effective matrix",
        "stepping/schemes.py",
        "+ self.lift_u * stiffness",
        "+ 2 * self.lift_u * stiffness",
    ),
    Fault(
        "effective matrix without (1 − α_f)",
        "stepping/schemes.py",
        "+ self.keep * (self.lift_v",
        "+ (self.lift_v",
    ),
    # The vehicle's half of a step: the constants of both loops, then the plain and the compiled one.
    Fault("lifted at the full", "stepping/half_step.py", "(-rule.keep * inverse", "(-inverse"),
    Fault(
        "vehicle that does not give way at once",
        "stepping/half_step.py",
        "np.eye(len(own)) - (",
        "np.eye(len(own)) - 0 * (",
    ),
    Fault("plain: old forces within", "stepping/half_step.py", "- rule.alpha_f * old", "+ rule.alpha_f * old"),
    Fault("plain: old inertia", "stepping/half_step.py", "- rule.alpha_m * (tie.mass @ ddz)", ""),
    Fault("plain: rate of the road missing", "stepping/half_step.py", "- guideway[1] + road[1])", "- guideway[1])"),
    Fault("old inertia", "stepping/kernels.py", "total -= alpha_f * old + alpha_m", "total -= alpha_f * old + 0.0"),
    Fault("old forces of the contacts", "stepping/kernels.py", "total -= alpha_f * contact_map", "total -= 0.0"),
    Fault(
        "forces that do not move the wheel at once",
        "stepping/kernels.py",
        "body[1, i] = free[1, i] + lift_v * gained",
        "body[1, i] = free[1, i]",
    ),
    Fault(
        "plain: convective term with the wrong sign", "stepping/marching.py", "sinking += self", "sinking -= self"
    ),
    Fault("plain: old forces forgotten", "stepping/marching.py", "(alpha_f * state.acting)", "(0 * state.acting)"),
    Fault(
        "plain: moved on by one unknown too many",
        "stepping/marching.py",
        "gone = elements * self.guideway.column",
        "gone = elements * self.guideway.column + 1",
    ),
    Fault(
        "half an element late",
        "stepping/marching.py",
        "/ self.guideway.spacing + ELEMENT_ROUNDING",
        "/ self.guideway.spacing + 0.5",
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
    Fault("rate of the road missing", "stepping/kernels.py", "- sinking[j] + rate[step, j])", "- sinking[j])"),
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
        "stepping/kernels.py",
        "+ damping[i, p] * free[1, p]",
        "+ 0.0",
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
        "record[4][step] = half.balanced(body, force)",
        "pass",
    ),
    # Steady travel, footprint, prescribed forces.
    Fault(
        "run-in with the loads of a rigid road",
        "stepping/coupled.py",
        "static_loads - held @ deflection",
        "static_loads",
    ),
    Fault(
        "case of a batch that begins where the last one ended",
        "stepping/coupled.py",
        "else settled.copied()",
        "else settled",
    ),
    Fault("sag counted as motion", "stepping/coupled.py", "motion -= steady.motion", "pass"),
    Fault(
        "rate of another speed",
        "stepping/coupled.py",
        "rate(journey.travelled, journey.speed)",
        "rate(journey.travelled, 1.0)",
    ),
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
    Fault(
        "impulse as an acceleration",
        "stepping/impulse.py",
        "state.guideway[1] = march",
        "state.guideway[2] = march",
    ),
    Fault("one road for all", "stepping/impulse.py", "np.mean(records, axis=0)", "records[0]"),
    Fault(
        "onset of the convolution forgotten",
        "stepping/duhamel.py",
        "guideway.onset.moment(0) - rising",
        "0.0 * rising",
    ),
    Fault("kinks of the hats forgotten", "stepping/duhamel.py", "/ (12 * count)", "/ (1e9 * count)"),
    Fault("struck road as if sampled", "stepping/impulse.py", "stepped=True", "stepped=False"),
    Fault("no limit to the estimate", "stepping/impulse.py", "if back[worst] < VALIDITY.untold", "if True"),
    Fault("findings of the road left out", "stepping/duhamel.py", "            *road.findings,", ""),
    Fault("reflections unseen", "stepping/impulse.py", "share ** (2 * len(guideways))", "0 * share"),
    Fault(
        "wrong half of the first hat",
        "stepping/duhamel.py",
        "whole, _, first = weights",
        "whole, first, _ = weights",
    ),
    Fault(
        "hat leaning the other way",
        "stepping/duhamel.py",
        "(trapezoid * (1 - share) + kinks)",
        "(trapezoid * share + kinks)",
    ),
    Fault("plain: backward differences", "stepping/duhamel.py", "(1.5, -2.0, 0.5)", "(1.5, -2.0, -0.5)"),
    Fault(
        "backward differences",
        "stepping/compiled.py",
        "1.5 / dt, -2.0 / dt, 0.5 / dt",
        "1.5 / dt, -2.0 / dt, -0.5 / dt",
    ),
    Fault("oldest force first", "stepping/duhamel.py", "kernel[:, :, :0:-1]", "kernel[:, :, 1:]"),
]

"""The best values of keys: gradients, limits, the search."""

from __future__ import annotations

from tests.faults.fault import Fault

FAULTS = [
    Fault(
        "gradient of the system as it is", "response/adjoint.py", ".matrix.swapaxes(0, 1), force", ".matrix, force"
    ),
    Fault("forces within that are forgotten", "response/adjoint.py", "moved + answered", "answered"),
    Fault(
        "contacts that do not change",
        "response/adjoint.py",
        "self.springs[:] += squeezed",
        "self.springs[:] += 0 * squeezed",
    ),
    Fault(
        "road that does not change",
        "response/adjoint.py",
        "found[:, key] -= (answer.pressed * road",
        "found[:, key] -= 0 * (answer.pressed * road",
    ),
    Fault(
        "track that does not change",
        "response/adjoint.py",
        "found[:, key] += (answer.below * yielding)",
        "found[:, key] += 0 * (answer.below * yielding)",
    ),
    Fault(
        "steady travel that does not change",
        "response/adjoint.py",
        "found[number, key] += weight * (slope.load",
        "found[number, key] += 0 * (slope.load",
    ),
    Fault(
        "mass for damping",
        "response/adjoint.py",
        "matrices = stiffness, damping, mass,",
        "matrices = stiffness, mass, damping,",
    ),
    Fault(
        "window of the adjoint not undone",
        "response/gradient.py",
        "np.exp(line.decay * step *",
        "np.exp(0.0 * step *",
    ),
    Fault(
        "filter the wrong way round",
        "metrics/slopes.py",
        "weighted(weights[::-1], of.step, name)[::-1]",
        "weighted(weights, of.step, name)",
    ),
    Fault("static load left out of its coefficient", "metrics/slopes.py", "load=-value / load**2", "load=0.0"),
    Fault(
        "moments of another power",
        "response/random_gradient.py",
        "slope * bandwidth * frequency**power",
        "slope * bandwidth",
    ),
    Fault(
        "derivative past the end of a range",
        "studies/optimisation/problem.py",
        "if self.low <= value - step and",
        "if True or",
    ),
    Fault(
        "factors taken for steps",
        "studies/optimisation/problem.py",
        "return value * math.log(self.high / self.low) if",
        "return value if",
    ),
    Fault(
        "wheels taken for what is carried",
        "studies/optimisation/problem.py",
        "apart if apart.any() else along",
        "along",
    ),
    Fault(
        "another road without a word",
        "studies/optimisation/problem.py",
        "if len(stations) == 2 and not",
        "if False and not",
    ),
    Fault(
        "limits that are not looked at",
        "studies/optimisation/search.py",
        "kept = exceeded <= Search().kept",
        "kept = True",
    ),
    Fault(
        "limit for a lower one",
        "studies/optimisation/search.py",
        "((1.0, limit.low), (-1.0, limit.high))",
        "((1.0, limit.high), (-1.0, limit.low))",
    ),
    Fault(
        "one contact for all",
        "studies/optimisation/search.py",
        "tried.wanted[self.aims].max()",
        "tried.wanted[self.aims][0]",
    ),
    Fault(
        "end of a range without a word",
        "studies/optimisation/optimise.py",
        "min(share, 1.0 - share) < 1e-6",
        "min(share, 1.0 - share) < -1",
    ),
    Fault(
        "last case for the best",
        "studies/optimisation/search.py",
        "return min(self.tried, key=self.order)",
        "return self.tried[-1]",
    ),
    Fault(
        "limit of all places",
        "studies/optimisation/words.py",
        "name = (measure, int(where)",
        "name = measure if colon else (measure, int(where)",
    ),
]

"""What the package does in one place only: a second copy is how cams once came to be ignored in the time domain."""

import re

import pytest

from tests.faults.fault import SOURCE

# What it is, the text that gives it away, below which folder, and the file that may have it; a second one has the
# text for another reason: ratios of matrices for their eigenvalues, the paper's own JSON, compiled loops.
ONE_OF_EACH = {
    "inverse of the coupled system": (r"np\.linalg\.(solve|inv)\(", "response", {"batches.py", "stability.py"}),
    "loop over chunks of frequencies": (r"range\(0, omega\.size", "response", {"solve.py"}),
    "threads of many small matrices": (r"threadpoolctl", "response", {"batches.py"}),
    "what a contact sees of a road": (r"\bsmooth_step_slope\(", "", {"smooth.py", "excitation.py"}),
    "share of a wave that a contact follows": (r"np\.sin\(half\)", "", {"enveloping.py"}),
    "provenance of a result": (r'"movingfrf": VERSION', "", {"labels.py", "report.py"}),
    "estimate of a spectrum": (
        r"0\.5 - 0\.5 \* np\.cos|hanning|import .*(welch|csd|periodogram)$",
        "",
        {"welch.py"},
    ),
    "exponential window": (r"wrap_around", "", {"line.py"}),
    "taper of a truncation": (r"stiffening", "", {"truncation.py"}),
    "survey before a solution": (r"require_stable\(", "", {"stability.py", "survey.py"}),
    "the vehicle's free motion in a step": (r"def freed\(", "stepping", {"half_step.py", "kernels.py"}),
}


@pytest.mark.parametrize("what", ONE_OF_EACH)
def test_stands_once(what):
    text, folder, files = ONE_OF_EACH[what]
    found = {
        path.name for path in (SOURCE / folder).rglob("*.py") if re.search(text, path.read_text(encoding="utf-8"))
    }
    assert found == files

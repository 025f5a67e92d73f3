"""The layers: a module imports only from below; nouns of one layer do not know each other."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[1] / "src" / "movingfrf"

# Bottom to top. A folder stands for everything in it; within a folder modules may import each other.
LAYERS = [
    ["_checks", "version", "progress"],
    ["smooth", "matlab_file", "quadrature", "schema"],
    ["spectral"],
    ["guideways", "vehicles", "roughness"],
    ["coupling", "forces", "journey", "roads"],
    ["truncation", "stability", "response", "findings"],
    ["simulation", "transfers", "metrics"],
    ["random_vibration"],
    ["random_measures"],
    ["plots", "wording"],
    ["scenario", "illustrations", "profile_description"],
    ["page"],
    ["methods"],
    ["sweep", "comparison"],
    ["report", "profile_report", "random_report", "output", "describe", "comparison_output", "comparison_report"],
    ["paper"],
    ["cli", "app"],
    ["__main__"],
]
LEVEL = {name: level for level, names in enumerate(LAYERS) for name in names}

# The independent way to the same answer shares parameters, the road's surface and labels, and nothing that computes
# a response.
REFERENCE = {
    "_checks",
    "version",
    "progress",
    "smooth",
    "schema",
    "vehicles",
    "roughness",
    "journey",
    "findings",
    "guideways.track",
    "guideways.base",
    "guideways.sampled",
    "reference",
}
# Nor may what it shares bring the spectral code in, a track's own closed form (its `moving_frf`) apart.
SPECTRAL = {"spectral", "coupling", "truncation", "stability", "response", "simulation"}

MODULES = {
    ".".join(path.relative_to(SOURCE).with_suffix("").parts).removesuffix(".__init__"): path
    for path in sorted(SOURCE.rglob("*.py"))
    if path != SOURCE / "__init__.py"
}


def imported(tree: ast.AST) -> list[str]:
    """Everything of the package that a module imports anywhere, relative to the root; '' is the root itself."""
    found = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, "relative imports hide the layer"
            # `from movingfrf import plots` names a module; any other name would go through the package root.
            names = [f"{node.module}.{alias.name}" for alias in node.names]
            below = [name for name in names if name.removeprefix("movingfrf.") in MODULES]
            found += below if len(below) == len(names) else [node.module or ""]
    ours = [name for name in found if name.split(".")[0] == "movingfrf"]
    return [name.removeprefix("movingfrf").removeprefix(".") for name in ours]


def faults(module: str, tree: ast.AST) -> list[str]:
    """List what a module imports that it may not."""
    own = module.split(".")[0]
    found = []
    for name in imported(tree):
        other = name.split(".")[0]
        if not name:
            found.append(f"{module} imports the package root")
        elif own == "reference":
            allowed = other == own or any(name == ok or name.startswith(f"{ok}.") for ok in REFERENCE)
            found += [] if allowed else [f"{module} may not import {name}"]
        elif other == "reference":
            found += [] if LEVEL.get(own, 0) >= LEVEL["simulation"] else [f"{module} may not import {name}"]
        elif other != own and LEVEL.get(other, len(LAYERS)) >= LEVEL[own]:
            found.append(f"{module} (layer {LEVEL[own]}) may not import {name} (layer {LEVEL.get(other)})")
    return found


def test_what_the_reference_shares_does_not_bring_the_spectral_code_in():
    """Directly or by way of others; a track knows its own waves, which the reference does not ask for."""
    seen, waiting = set(), [module for module in MODULES if module.split(".")[0] == "reference"]
    assert waiting
    while waiting:
        module = waiting.pop()
        if module not in seen:
            seen.add(module)
            waiting += [name for name in imported(ast.parse(MODULES[module].read_text())) if name in MODULES]
    assert not seen & SPECTRAL


def test_every_module_has_a_layer():
    assert {module.split(".")[0] for module in MODULES} <= LEVEL.keys() | {"reference"}


@pytest.mark.parametrize("module", MODULES)
def test_imports_point_downwards(module):
    assert not faults(module, ast.parse(MODULES[module].read_text()))


@pytest.mark.parametrize(
    ("module", "line"),
    [
        ("coupling", "import movingfrf"),
        ("coupling", "from movingfrf import track"),
        ("coupling", "from movingfrf.simulation import simulate"),
        ("vehicles.base", "from movingfrf.guideways.base import Guideway"),
        ("vehicles.base", "def late():\n    import movingfrf.coupling"),
        ("truncation", "from movingfrf.stability import determinant"),
        ("reference.newmark", "from movingfrf.spectral import SpectralGrid"),
        ("reference.newmark", "from movingfrf.guideways.waves import Ratio"),
        ("reference.newmark", "from movingfrf.guideways import waves"),
        ("guideways.track", "from movingfrf.reference.newmark import step"),
    ],
)
def test_the_rule_itself_can_fail(module, line):
    assert faults(module, ast.parse(line))


@pytest.mark.parametrize(
    ("module", "line"),
    [
        ("vehicles.road", "from movingfrf.vehicles.base import Vehicle"),
        ("reference.newmark", "from movingfrf.guideways.track import Track"),
        ("report", "from movingfrf import plots"),
    ],
)
def test_the_rule_lets_pass_what_it_should(module, line):
    assert not faults(module, ast.parse(line))

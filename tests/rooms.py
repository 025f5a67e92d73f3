"""The rooms of the house, their order, and who imports whom: read from the source, used by a test and a picture."""

from __future__ import annotations

import ast
import re
from pathlib import Path

SOURCE = Path(__file__).parents[1] / "src" / "movingfrf"

# Bottom to top. Within a room modules may import each other, but not in a circle.
LAYERS = (
    ("_basics",),
    ("guideways", "vehicles", "roughness", "results"),
    ("metrics",),
    ("response", "stepping", "reports"),
    ("scenarios",),
    ("studies",),
    ("commands",),
)
LEVEL = {room: level for level, rooms in enumerate(LAYERS) for room in rooms}

# The one special rule: time stepping takes a guideway's parameters, never its waves. What it agrees with, it
# may not be made of.
UNSEEN = {"stepping": ("guideways.waves", "guideways.critical", "metrics.guideway")}

# The doors: what lies at the root, and what each may open.
DOORS = {"__init__": ("_basics",), "__main__": ("commands",)}

MODULES = {
    ".".join(path.relative_to(SOURCE).with_suffix("").parts).removesuffix(".__init__"): path
    for path in sorted(SOURCE.rglob("*.py"))
}
TREES = {module: ast.parse(path.read_text(encoding="utf-8")) for module, path in MODULES.items()}


def imported(tree: ast.AST) -> list[str]:
    """Everything of the package that a module names anywhere, relative to the root; '' is the root itself.

    Late imports are imports, those for annotations too, and so is a module that a text names (`import_module`,
    `python -m`, an annotation in quotation marks).
    """
    found = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, "relative imports hide the layer"
            # `from movingfrf.reports import plots` names a module, any other name something in one.
            names = [f"{node.module}.{alias.name}" for alias in node.names]
            found += [name if name.removeprefix("movingfrf.") in MODULES else node.module or "" for name in names]
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            found += re.findall(r"\A(movingfrf(?:\.\w+)+)\Z", node.value)
    ours = [name for name in found if name.split(".")[0] == "movingfrf"]
    return [name.removeprefix("movingfrf").removeprefix(".") for name in ours]


def module_of(name: str) -> str:
    """Give the module that a dotted name lies in."""
    while name and name not in MODULES:
        name = name.rpartition(".")[0]
    return name


def graph() -> dict[str, set[str]]:
    """Say which modules each module imports."""
    return {module: {module_of(name) for name in imported(tree)} - {module, ""} for module, tree in TREES.items()}


def arrows() -> dict[tuple[str, str], int]:
    """Count, for each pair of rooms (from, to), how many modules of the one import something of the other."""
    found: dict[tuple[str, str], int] = {}
    for module, others in graph().items():
        own = module.split(".")[0]
        for room in {other.split(".")[0] for other in others} - {own}:
            if own not in DOORS:
                found[own, room] = found.get((own, room), 0) + 1
    return dict(sorted(found.items()))

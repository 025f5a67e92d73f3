"""The rooms of the house and their order: a room imports only from rooms below, and rooms side by side never meet.

Late imports are imports, those for annotations too, and so is a module that is named in a text (`import_module`,
`python -m`, an annotation in quotation marks).
"""

from __future__ import annotations

import ast
import re

import pytest

from tests.rooms import DOORS, LAYERS, LEVEL, MODULES, SOURCE, TREES, UNSEEN, arrows, graph, imported


def faults(module: str, tree: ast.AST) -> list[str]:
    """List what a module imports that it may not."""
    own = module.split(".")[0]
    found = []
    for name in imported(tree):
        room = name.split(".")[0]
        if own in DOORS:
            allowed = room in DOORS[own]
        elif room == own:
            allowed = True
        else:
            unseen = any(f"{name}.".startswith(f"{hidden}.") for hidden in UNSEEN.get(own, ()))
            allowed = not unseen and LEVEL.get(room, len(LAYERS)) < LEVEL[own]
        if not allowed:
            found.append(f"{module} may not import {name or 'the package root'}")
    return found


def circle(graph: dict[str, set[str]]) -> list[str]:
    """Find modules that import each other in a circle; empty if there are none."""
    done: set[str] = set()

    def follow(module: str, way: list[str]) -> list[str]:
        if module in way:
            return way[way.index(module) :]
        if module in done:
            return []
        for other in sorted(graph.get(module, ())):
            if found := follow(other, [*way, module]):
                return found
        done.add(module)
        return []

    return next((found for module in sorted(graph) if (found := follow(module, []))), [])


def test_the_root_holds_doors_only():
    files = {path.name for path in SOURCE.iterdir() if path.is_file()}
    assert files == {"__init__.py", "__main__.py", "py.typed"}
    folders = {path.name for path in SOURCE.iterdir() if path.is_dir() and path.name != "__pycache__"}
    assert folders == set(LEVEL)
    assert len(LEVEL) == 12
    assert len(UNSEEN) == 1


@pytest.mark.parametrize("module", MODULES)
def test_imports_point_downwards(module):
    assert faults(module, TREES[module]) == []


def test_no_circles():
    modules = graph()
    assert sum(map(len, modules.values())) > 300
    assert circle(modules) == []


@pytest.mark.parametrize(
    ("module", "line"),
    [
        ("response.solve", "import movingfrf"),
        ("response.solve", "from movingfrf import track"),
        ("response.solve", "from movingfrf.scenarios.scenario import Scenario"),
        ("response.solve", "from movingfrf.stepping.schemes import Scheme"),
        ("vehicles.vehicle", "from movingfrf.guideways.guideway import Guideway"),
        ("vehicles.vehicle", "from movingfrf import guideways"),
        ("vehicles.vehicle", "def late():\n    import movingfrf.response.solve"),
        ("vehicles.vehicle", "if TYPE_CHECKING:\n    from movingfrf.results.labels import Label"),
        ("vehicles.vehicle", "def of(result: 'movingfrf.results.labels.Label'): ..."),
        ("vehicles.vehicle", "import_module('movingfrf.results.labels')"),
        ("results.files", "from movingfrf.metrics.measures import measures"),
        ("stepping.newmark", "from movingfrf.response.line import Line"),
        ("stepping.newmark", "from movingfrf.guideways.waves import Ratio"),
        ("stepping.newmark", "from movingfrf.guideways import waves"),
        ("stepping.newmark", "def late():\n    from movingfrf.guideways import critical"),
        ("guideways.track", "from movingfrf.stepping.newmark import step"),
        ("reports.page", "from movingfrf.response.simulation import simulate"),
        ("_basics.checks", "from movingfrf.results import labels"),
        ("somewhere.new", "from movingfrf._basics import checks"),
        ("__init__", "from movingfrf.response.simulation import simulate"),
    ],
)
def test_the_rule_itself_can_fail(module, line):
    if module.split(".")[0] not in {*LEVEL, *DOORS}:
        with pytest.raises(KeyError, match="somewhere"):
            faults(module, ast.parse(line))
    else:
        assert faults(module, ast.parse(line))


@pytest.mark.parametrize(
    ("module", "line"),
    [
        ("vehicles.cars", "from movingfrf.vehicles.vehicle import Vehicle"),
        ("stepping.newmark", "from movingfrf.guideways.track import Track"),
        ("stepping.newmark", "from movingfrf.guideways import sampled"),
        ("metrics.guideway", "from movingfrf.guideways.waves import Ratio"),
        ("reports.coupled", "from movingfrf.reports import plots"),
        ("_basics.wording", "'movingfrf is a package'"),
        ("__init__", "from movingfrf._basics.version import VERSION"),
    ],
)
def test_the_rule_lets_pass_what_it_should(module, line):
    assert not faults(module, ast.parse(line))


def test_a_circle_is_found():
    assert circle({"a": {"b"}, "b": {"c"}, "c": {"b"}}) == ["b", "c"]
    assert circle({"a": {"b", "c"}, "b": {"c"}, "c": set()}) == []


def test_the_picture_shows_today_s_arrows():
    """`make picture` draws it from the imports, and writes into it what it drew."""
    picture = (SOURCE.parents[1] / "docs" / "images" / "rooms.svg").read_text(encoding="utf-8")
    drawn = re.search(r"<dc:description>(.*?)</dc:description>", picture)
    assert drawn
    assert drawn[1].replace("&gt;", ">").split() == [f"{upper}>{lower}" for upper, lower in arrows()]


def constants(tree: ast.Module) -> list[str]:
    """Names that a module sets at its level and that are written as constants are, each of a tuple."""
    found = []
    for node in tree.body:
        targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
        names = [name.id for target in targets if target for name in ast.walk(target) if isinstance(name, ast.Name)]
        found += [name for name in names if re.fullmatch(r"_?[A-Z][A-Z0-9_]+", name)]
    return found


def test_constants_can_be_overseen():
    """Numbers that tune an algorithm are fields of one frozen value beside it, not names of their own."""
    counted = {module: constants(tree) for module, tree in TREES.items()}
    assert 50 < sum(map(len, counted.values())) <= 200


def test_files_can_be_overseen():
    root = SOURCE.parents[1]
    long = {
        str(path.relative_to(root)): length
        for folder in (SOURCE, root / "tests", root / "benchmarks", root / "docs")
        for path in folder.rglob("*.py")
        if (length := len(path.read_text(encoding="utf-8").splitlines())) > 600
    }
    assert long == {}


def test_constants_are_counted_one_by_one():
    text = "A_B, C2 = 1, 2\n_DE: int = 3\nPlain = 4\nlower = 5\nE_ = F_ = 6\nX[0] = 1\ndef f():\n    G_ = 1\n"
    assert constants(ast.parse(text)) == ["A_B", "C2", "_DE", "E_", "F_"]

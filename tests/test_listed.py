"""What lies in a room where lists are filled is in its list, and on the page that tells of it."""

from importlib import import_module

import pytest

from movingfrf.metrics.listed import TABLES
from movingfrf.roughness.files import FORMATS
from movingfrf.roughness.preparation import STEPS
from tests.faults.fault import ROOT, SOURCE


def marked(room, mark):
    """Values of a name in all modules of a room that have it."""
    names = sorted(path.stem for path in (SOURCE / room).glob("*.py"))
    modules = [import_module(f"movingfrf.{room.replace('/', '.')}.{name}") for name in names]
    return [getattr(module, mark) for module in modules if hasattr(module, mark)]


def page(name):
    return (ROOT / "docs" / f"{name}.md").read_text(encoding="utf-8")


def test_steps():
    found = marked("roughness/steps", "STEP")
    assert len(found) > 5
    assert {id(step) for step in found} == {id(step) for step in STEPS}


@pytest.mark.parametrize("key", [key for step in STEPS for key in step.keys])
def test_keys_of_steps_stand_on_their_page(key):
    assert f"`{key}`" in page("profiles")


def test_measures():
    found = marked("metrics", "ENTRY")
    assert found
    listed = [entry for table in TABLES for entry in table.entries]
    assert all(entry in listed for entry in found)


def test_formats():
    found = marked("roughness/formats", "FORMAT")
    assert len(found) == len(FORMATS)
    assert all(form in FORMATS.values() for form in found)

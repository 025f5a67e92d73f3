"""The list of deliberate faults cannot rot: each still finds the text that it changes, exactly once."""

from __future__ import annotations

import ast

from tests.faults import FAULTS, stale
from tests.faults.fault import SOURCE


def test_every_fault_still_has_its_place():
    assert stale() == []
    assert len({fault.name for fault in FAULTS}) == len(FAULTS) >= 20
    assert all(fault.old != fault.new for fault in FAULTS)


def test_every_fault_is_still_python():
    """A fault that cannot even be read would count as found by every test."""
    for fault in FAULTS:
        if fault.file.endswith(".py"):
            ast.parse((SOURCE / fault.file).read_text(encoding="utf-8").replace(fault.old, fault.new), fault.name)

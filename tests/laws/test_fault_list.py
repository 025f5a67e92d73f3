"""The list of deliberate faults cannot rot: each still finds the text that it changes, exactly once."""

from __future__ import annotations

from tests.faults import FAULTS, stale


def test_every_fault_still_has_its_place():
    assert stale() == []
    assert len({fault.name for fault in FAULTS}) == len(FAULTS) >= 20
    assert all(fault.old != fault.new for fault in FAULTS)

"""Deliberate faults, part by part: changes to the source that no test may let pass.

`python -m tests.faults` runs them; a part is a file here, and says in its first line what it covers.
"""

from __future__ import annotations

from types import ModuleType

from tests.faults import (
    guideways,
    loads,
    metrics,
    optimise,
    response,
    roughness,
    shown,
    stepping,
    sweeps,
    vehicles,
    written,
)
from tests.faults.fault import SOURCE, Fault

PARTS: dict[str, ModuleType] = {
    module.__name__.rpartition(".")[2]: module
    for module in (
        guideways,
        vehicles,
        roughness,
        metrics,
        response,
        loads,
        stepping,
        sweeps,
        optimise,
        shown,
        written,
    )
}


def faults_of(part: str) -> list[Fault]:
    """List the faults of a part."""
    listed: list[Fault] = PARTS[part].FAULTS
    return listed


def covers(part: str) -> str:
    """Say what a part covers."""
    return (PARTS[part].__doc__ or "").splitlines()[0]


FAULTS = [fault for part in PARTS for fault in faults_of(part)]


def stale() -> list[str]:
    """Faults whose old text does not occur exactly once in its file."""
    counts = {fault: (SOURCE / fault.file).read_text().count(fault.old) for fault in FAULTS}
    return [f"{fault.name}: {count} times in {fault.file}" for fault, count in counts.items() if count != 1]

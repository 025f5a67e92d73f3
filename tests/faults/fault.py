"""What a deliberate fault is, and where the source that it changes lies."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "src" / "movingfrf"


class Fault(NamedTuple):
    """One change that no test may let pass."""

    name: str
    file: str  # below src/movingfrf
    old: str  # occurs exactly once
    new: str

"""Whether loops run compiled, by numba (the extra `fast`), or in NumPy: compiled where loading it pays."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from types import ModuleType

from movingfrf._basics.ending import is_command


@dataclass(frozen=True, slots=True, kw_only=True)
class Patience:
    """How much the command does in NumPy before it loads numba; in brackets, between what the number is safe.

    Numba takes some 0.4 s to load. A process that imports the package goes on, as a rule, with more of what it has
    begun, and loads it at once. A command ends when it has done what it was asked for: loading must pay for itself.
    """

    # A unit of work is one wave, or one vibration of a vehicle, at one frequency: NumPy takes 0.1 to 0.2 µs longer.
    # Work is counted rather than timed, so that the same input takes the same way.
    work: int = 3_000_000  # [1e6 to 1e7: time only]


PATIENCE = Patience()

# Work done so far, and what is chosen: True and False for always and never, None for where it pays.
_done: list[int] = [0]
_chosen: list[bool | None] = [None]


def numba_is_there() -> bool:
    """Tell whether loops can be compiled."""
    try:
        return find_spec("numba") is not None
    except ImportError:
        return False


def loops_for(module: str, work: int) -> ModuleType | None:
    """Give a module of compiled loops if they shall be used.

    Parameters
    ----------
    module : str
        Its name below the package.
    work : int
        What is to be done: waves or vibrations times frequencies.

    Returns
    -------
    module or None
        None: do it in NumPy, with the same result but for rounding.
    """
    if _chosen[0] is None and "numba" not in sys.modules:
        if not numba_is_there():
            return None
        _done[0] += work
        if is_command() and _done[0] <= PATIENCE.work:
            return None
    return _loaded(module) if _chosen[0] is not False else None


def usable(module: str) -> bool:
    """Tell whether a module of compiled loops can be used at all: asking loads it."""
    return numba_is_there() and _loaded(module) is not None


def load() -> None:
    """Load all compiled loops of the frequency domain, where they can be used."""
    for module in ("_basics", "guideways", "vehicles", "response"):
        usable(f"{module}.compiled")


@cache
def _loaded(module: str) -> ModuleType | None:
    """Load compiled loops, and compile them if that has not been done; None where that is not possible.

    A numba may not fit its NumPy, there may be no place for what it compiles, or no room on the disk.
    """
    try:
        loops = import_module(f"movingfrf.{module}")
        getattr(loops, "ready", lambda: None)()
    except Exception:
        return None
    return loops


@contextmanager
def compiling(choice: bool | None) -> Iterator[None]:
    """Choose, while the block lasts, whether loops are compiled: always, never, or (None) where it pays."""
    before, _chosen[0] = _chosen[0], choice
    try:
        yield
    finally:
        _chosen[0] = before

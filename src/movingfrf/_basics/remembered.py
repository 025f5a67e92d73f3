"""What a frozen value implies is computed once, and remembered in the value itself."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import wraps
from typing import Any, TypeVar

import numpy as np

Implied = TypeVar("Implied")
Remembers = TypeVar("Remembers", bound="Remembering")


class Remembering:
    """Base of frozen, slotted dataclasses that remember what they imply: one private slot and nothing else.

    The slot is no field: it is not compared, hashed, shown, copied, replaced or pickled. A copy computes afresh.
    """

    __slots__ = ("_implied",)


def remembered(compute: Callable[[Any], Implied]) -> Callable[[Any], Implied]:
    """Compute a method without arguments, or a property, once per value; for classes based on `Remembering`.

    Threads that ask at the same moment may each compute; nothing worse happens.

    Parameters
    ----------
    compute : callable
        The method; below `property`, if it is one. What it returns is shared: arrays in it are made read-only.

    Returns
    -------
    callable
        The method, which computes when it is asked first.

    Examples
    --------
    >>> from dataclasses import dataclass
    >>> @dataclass(frozen=True, slots=True)
    ... class Span(Remembering):
    ...     length: float
    ...     @property
    ...     @remembered
    ...     def half(self):
    ...         print("computed")
    ...         return 0.5 * self.length
    >>> span = Span(6.0)
    >>> span.half, span.half
    computed
    (3.0, 3.0)
    """
    name = compute.__name__

    @wraps(compute)
    def asked(value: Any) -> Implied:
        try:
            return value._implied[name]
        except (AttributeError, KeyError):
            return recalled(value, name, lambda: compute(value))

    return asked


def recalled(value: Any, name: str, compute: Callable[[], Implied]) -> Implied:
    """Remember what a value implies by some name, where a method takes arguments.

    Parameters
    ----------
    value : Remembering
        What remembers.
    name : str
        What is remembered.
    compute : callable
        Computes it, without arguments. What it returns is shared, as for `remembered`.

    Returns
    -------
    object
        What is implied.
    """
    memory = _memory(value)
    if name not in memory:
        memory[name] = _sealed(compute())
    known: Implied = memory[name]
    return known


def latest(value: Any, name: str, fits: Callable[[Implied], bool], compute: Callable[[], Implied]) -> Implied:
    """Remember the latest of what a value implies together with something else.

    Parameters
    ----------
    value : Remembering
        What remembers.
    name : str
        What is remembered.
    fits : callable
        Tells of what is remembered whether it is what is asked for.
    compute : callable
        Computes it, without arguments, in place of what is remembered. What it returns is shared, as for
        `remembered`.

    Returns
    -------
    object
        What is implied.

    Examples
    --------
    >>> from dataclasses import dataclass
    >>> @dataclass(frozen=True, slots=True)
    ... class Span(Remembering):
    ...     length: float
    ...     def parts(self, count):
    ...         def cut():
    ...             print("cut")
    ...             return tuple(self.length / count for _ in range(count))
    ...         return latest(self, "parts", lambda known: len(known) == count, cut)
    >>> span = Span(6.0)
    >>> span.parts(2), span.parts(2), span.parts(3)
    cut
    cut
    ((3.0, 3.0), (3.0, 3.0), (2.0, 2.0, 2.0))
    """
    memory = _memory(value)
    known: Implied | None = memory.get(name)
    if known is None or not fits(known):
        memory[name] = known = _sealed(compute())
    return known


def sharing(value: Remembers, memory: dict[str, Any]) -> Remembers:
    """Let a value that has just been made remember what others remember that are made of the same."""
    object.__setattr__(value, "_implied", memory)
    return value


def _memory(value: Any) -> dict[str, Any]:
    """Find what a value remembers."""
    if not hasattr(value, "_implied"):
        object.__setattr__(value, "_implied", {})
    memory: dict[str, Any] = value._implied
    return memory


def _sealed(implied: Implied) -> Implied:
    """Make the arrays in a value read-only: those of tuples, dicts and dataclasses too.

    What remembers for itself, within another value, is somebody else's, and sealed by whoever remembers it.
    """
    fields = getattr(implied, "__dataclass_fields__", None)
    _seal((implied,) if fields is None else (getattr(implied, name) for name in fields))
    return implied


def _seal(parts: Iterable[Any]) -> None:
    for part in parts:
        if isinstance(part, np.ndarray):
            part.setflags(write=False)
        elif isinstance(part, tuple):
            _seal(part)
        elif isinstance(part, dict):
            _seal(part.values())
        elif hasattr(part, "__dataclass_fields__") and not isinstance(part, Remembering):
            _seal(getattr(part, name) for name in part.__dataclass_fields__)

"""What a frozen value implies is computed once, and remembered in the value itself."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, is_dataclass
from functools import wraps
from typing import Any, TypeVar

import numpy as np

Implied = TypeVar("Implied")


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
    if not hasattr(value, "_implied"):
        object.__setattr__(value, "_implied", {})
    implied: dict[str, Implied] = value._implied
    if name not in implied:
        implied[name] = _sealed(compute())
    return implied[name]


def _sealed(implied: Implied) -> Implied:
    """Make the arrays in a value read-only: those of tuples, dicts and dataclasses too."""
    if isinstance(implied, np.ndarray):
        implied.setflags(write=False)
    elif isinstance(implied, tuple):
        for part in implied:
            _sealed(part)
    elif isinstance(implied, dict):
        for part in implied.values():
            _sealed(part)
    elif is_dataclass(implied):
        for field in fields(implied):
            _sealed(getattr(implied, field.name))
    return implied

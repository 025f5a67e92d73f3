"""What the package says when something is wrong: exceptions, warnings and the checks that raise them."""

from __future__ import annotations

import difflib
import math
import sys
import warnings
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from numbers import Real
from types import FrameType
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from movingfrf._basics.arrays import FloatArray

Kind = TypeVar("Kind")


@dataclass(frozen=True, slots=True, kw_only=True)
class Magnitudes:
    """Bounds far inside which physical quantities in SI units lie; beyond them powers overflow [a convention]."""

    smallest: float = 1e-20
    largest: float = 1e20


CREDIBLE = Magnitudes()


class Fault(NamedTuple):
    """One refused parameter: its name and the sentence that says why."""

    name: str
    message: str


class ParameterError(ValueError):
    """One or more impossible parameters; `faults` lists all of them.

    Parameters
    ----------
    faults : sequence of Fault
        What was refused, in the order in which it was found.
    """

    def __init__(self, faults: Sequence[Fault]) -> None:
        self.faults = tuple(faults)
        super().__init__("; ".join(f"{fault.name} {fault.message}" for fault in self.faults))


class SolveError(RuntimeError):
    """The question has no meaningful answer: unstable coupling, a singular frequency, an overflow."""


class ValidityWarning(UserWarning):
    """The answer lies outside the assumptions it was computed under."""


class Finding(NamedTuple):
    """One thing to know about a result, or about what it is computed from."""

    code: str
    message: str


def warned(found: Iterable[Finding]) -> tuple[Finding, ...]:
    """Warn of every finding, at the line that called the package, and return them all."""
    level = 1
    frame: FrameType | None = sys._getframe()
    while frame is not None and frame.f_globals.get("__name__", "").partition(".")[0] == "movingfrf":
        level, frame = level + 1, frame.f_back
    found = tuple(found)
    for finding in found:
        warnings.warn(finding.message, ValidityWarning, stacklevel=level)
    return found


def shown(value: object) -> str:
    """Write a refused value, shortened where it is long."""
    try:
        text = repr(value)
    except ValueError:  # an integer of thousands of digits
        text = "a number of thousands of digits"
    return text if len(text) <= 60 else f"{text[:57]}..."


def nearest(word: str, known: Iterable[str]) -> str:
    """Suggest the nearest spelling, in brackets; nothing if there is none."""
    close = difflib.get_close_matches(word, list(known), n=1)
    return f" (did you mean {close[0]!r}?)" if close else ""


def with_unit(number: float, unit: str) -> str:
    """Write a number with its unit; of what has no dimension, the number alone."""
    return f"{number!r}" if unit == "1" else f"{number!r} {unit}"


def in_brackets(words: str, unit: str) -> str:
    """Write words with a unit in brackets behind them; without a dimension, the words alone."""
    return words if unit == "1" else f"{words} [{unit}]"


def option(name: str) -> str:
    """Name an option as it is typed in Python and in a scenario, and as on the command line."""
    return f"`{name}` (on the command line --{name.replace('_', '-')})"


class Checks:
    """Collects faults, so that one error can name every one of them.

    Each check returns the value in the type that the caller stores; after a fault the returned value is
    meaningless and the surrounding `checking` block raises.
    """

    def __init__(self) -> None:
        self.faults: list[Fault] = []

    def refuse(self, name: str, message: str) -> None:
        """Record that `name` is refused because of `message`."""
        self.faults.append(Fault(name, message))

    def finite(self, name: str, value: Any, unit: str, condition: str = "a finite number") -> float:
        """Demand a real, finite number of credible magnitude."""
        if not isinstance(value, Real) or isinstance(value, bool):
            self.refuse(name, f"must be {in_brackets(condition, unit)}, got {shown(value)}")
            return float("nan")
        try:
            number = float(value)
        except OverflowError:
            number = float("inf")
        if not np.isfinite(number):
            self.refuse(name, f"must be {condition}, got {with_unit(number, unit)}")
        elif abs(number) > CREDIBLE.largest:
            self.refuse(
                name,
                f"must be of a credible magnitude, at most {CREDIBLE.largest:g}, got {with_unit(number, unit)}",
            )
        else:
            return number
        return float("nan")

    def positive(self, name: str, value: Any, unit: str) -> float:
        """Demand a number above zero."""
        number = self.finite(name, value, unit, "a positive number")
        if number <= 0:
            self.refuse(name, f"must be positive, got {with_unit(number, unit)}")
        elif number < CREDIBLE.smallest:
            self.refuse(
                name,
                f"must be of a credible magnitude, at least {CREDIBLE.smallest:g}, got {with_unit(number, unit)}",
            )
        return number

    def positive_or_infinite(self, name: str, value: Any, unit: str) -> float:
        """Demand a number above zero, or infinity."""
        if isinstance(value, float) and value == math.inf:
            return value
        return self.positive(name, value, unit)

    def not_negative(self, name: str, value: Any, unit: str) -> float:
        """Demand a number of at least zero."""
        number = self.finite(name, value, unit, "a number of at least zero")
        if number < 0:
            self.refuse(name, f"must not be negative, got {with_unit(number, unit)}")
        return number

    def whole(self, name: str, value: Any, *, least: int = 0) -> int:
        """Demand a whole number of at least `least`."""
        if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or value < least:
            self.refuse(name, f"must be a whole number of at least {least}, got {shown(value)}")
            return least
        return int(value)

    def text(self, name: str, value: Any) -> str:
        """Demand a text."""
        if isinstance(value, str):
            return value
        self.refuse(name, f"must be a text, got {shown(value)}")
        return ""

    def array(self, name: str, value: ArrayLike, unit: str, shape: tuple[int | None, ...]) -> FloatArray:
        """Demand finite numbers in an array of the given shape (None: any length); returns a frozen copy."""
        try:
            given = np.asarray(value)
            numbers = given.dtype.kind in "iuf" or not given.size
            array = np.array(given, dtype=float) if numbers else given
        except (TypeError, ValueError, OverflowError):
            numbers = False
        if not numbers:
            self.refuse(name, f"must be {in_brackets('an array of numbers', unit)}, got {shown(value)}")
            return np.full([n or 1 for n in shape], np.nan)
        wanted = "(" + ", ".join("any" if n is None else str(n) for n in shape) + ")"
        if array.ndim != len(shape) or any(n not in (None, m) for n, m in zip(shape, array.shape, strict=True)):
            self.refuse(name, f"must have shape {wanted}, got {array.shape}")
            return np.full([n or 1 for n in shape], np.nan)
        bad = np.argwhere(~(np.abs(array) <= CREDIBLE.largest))
        if bad.size:
            place = tuple(int(i) for i in bad[0])
            self.refuse(
                name,
                f"must be finite and at most {with_unit(CREDIBLE.largest, unit)} throughout, got "
                f"{float(array[place])!r} at index {place[0] if len(place) == 1 else place}",
            )
        array.flags.writeable = False
        return array

    def listed(self, name: str, value: Any, kind: type[Kind], *, least: int = 1) -> tuple[Kind, ...]:
        """Demand a list of at least `least` objects of one kind."""
        if isinstance(value, (list, tuple)) and len(value) >= least and all(isinstance(one, kind) for one in value):
            return tuple(value)
        number = "one or more" if least else "any number of"
        what = {str: "texts", int: "whole numbers"}.get(kind, f"{kind.__name__} objects")
        self.refuse(name, f"must be a list of {number} {what}, got {shown(value)}")
        return ()

    def pair(
        self,
        name: str,
        value: Any,
        unit: str,
        *,
        positive: bool = True,
        signed: bool = False,
        infinite: bool = False,
    ) -> tuple[float, float]:
        """Demand two numbers: positive ones, or at least zero, or of any sign; or positive ones or infinity."""
        try:
            first, second = value
        except (TypeError, ValueError):
            self.refuse(name, f"must be {in_brackets('two numbers', unit)}, got {shown(value)}")
            return (float("nan"), float("nan"))
        check = self.finite if signed else self.positive if positive else self.not_negative
        check = self.positive_or_infinite if infinite else check
        return check(f"{name}[0]", first, unit), check(f"{name}[1]", second, unit)


@contextmanager
def checking() -> Iterator[Checks]:
    """Run a block of checks and raise one `ParameterError` at its end if any of them failed."""
    checks = Checks()
    yield checks
    if checks.faults:
        raise ParameterError(checks.faults)

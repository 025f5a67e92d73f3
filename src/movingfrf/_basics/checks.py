"""What the package says when something is wrong: exceptions, warnings and the checks that raise them."""

from __future__ import annotations

import difflib
import math
import sys
import warnings
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, fields
from numbers import Real
from os import PathLike
from pathlib import Path
from types import FrameType
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.door import beyond_limits, instead_of, mistaken, one_of
from movingfrf._basics.door import shown as shown
from movingfrf._basics.wording import enumerated

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
    # How far an output may be off, relative to the largest value of its channel; None where nothing is off by that.
    figure: float | None = None


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


def nearest(word: str, known: Iterable[str]) -> str:
    """Suggest the nearest spelling, in brackets; nothing if there is none."""
    close = difflib.get_close_matches(word, list(known), n=1)
    return f" (did you mean {close[0]!r}?)" if close else ""


def spelt(word: object, known: Iterable[str]) -> str | None:
    """Find a known word whatever the case of its letters, and whether hyphen, underscore or blank joins its parts.

    Examples
    --------
    >>> spelt("wk", ["Wk", "Wd"]), spelt("Moving_FRF", ["moving-frf"]), spelt("x", ["y"])
    ('Wk', 'moving-frf', None)
    """
    plainly = str.maketrans("-_", "  ")
    same = {one.casefold().translate(plainly): one for one in known}
    return same.get(word.casefold().translate(plainly)) if isinstance(word, str) else None


def with_unit(number: float, unit: str) -> str:
    """Write a number with its unit; of what has no dimension, the number alone."""
    return f"{number!r}" if unit == "1" else f"{number!r} {unit}"


def in_brackets(words: str, unit: str) -> str:
    """Write words with a unit in brackets behind them; without a dimension, the words alone."""
    return words if unit == "1" else f"{words} [{unit}]"


def option(name: str) -> str:
    """Name an option as it is typed in Python and in a scenario, and as on the command line."""
    return f"`{name}` (on the command line --{name.replace('_', '-')})"


def plain(value: Any) -> Any:
    """Make a Python number of a scalar in another dress: NumPy's, or an array without axes; leave the rest."""
    return value.item() if getattr(value, "ndim", None) == 0 and not np.ma.is_masked(value) else value


class Checks:
    """Collects faults, so that one error can name every one of them.

    Each check returns the value in the type that the caller stores, and no other is to be used: a number of single
    precision makes single precision of what it meets. After a fault the returned value is meaningless and the
    surrounding `checking` block raises.
    """

    def __init__(self) -> None:
        self.faults: list[Fault] = []
        self.values: dict[str, Any] = {}

    def keep(self, name: str, value: Kind) -> Kind:
        """Remember a value as that of `name`, in the type in which it is stored; returns it."""
        self.values[name] = value
        return value

    def refuse(self, name: str, message: str) -> None:
        """Record that `name` is refused because of `message`."""
        self.faults.append(Fault(name, message))

    def finite(self, name: str, value: Any, unit: str, condition: str = "a finite number") -> float:
        """Demand a real, finite number of credible magnitude."""
        if type(value) is float and -CREDIBLE.largest <= value <= CREDIBLE.largest:
            return self.keep(name, value)
        value = plain(value)
        if not isinstance(value, Real) or isinstance(value, bool):
            wanted = in_brackets(condition, unit)
            self.refuse(name, f"must be {wanted}, got {shown(value)}{beyond_limits(name, value)}")
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
            return self.keep(name, number)
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
        if isinstance(value := plain(value), Real) and value == math.inf:
            return self.keep(name, math.inf)
        return self.positive(name, value, unit)

    def not_negative(self, name: str, value: Any, unit: str) -> float:
        """Demand a number of at least zero."""
        number = self.finite(name, value, unit, "a number of at least zero")
        if number < 0:
            self.refuse(name, f"must not be negative, got {with_unit(number, unit)}")
        return number

    def whole(self, name: str, value: Any, *, least: int = 0) -> int:
        """Demand a whole number of at least `least`."""
        number = plain(value)
        if isinstance(number, bool) or not isinstance(number, int) or number < least:
            self.refuse(name, f"must be a whole number of at least {least}, got {shown(value)}")
            return least
        return self.keep(name, number)

    def text(self, name: str, value: Any) -> str:
        """Demand a text."""
        if isinstance(value, str):
            return self.keep(name, str(value))
        self.refuse(name, f"must be a text, got {shown(value)}")
        return ""

    def file(self, name: str, value: Any) -> Path:
        """Demand the name of a file."""
        if isinstance(value, (str, PathLike)):
            return self.keep(name, Path(value))
        self.refuse(name, mistaken("file", value))
        return Path()

    def choice(self, name: str, value: Any, known: Iterable[str]) -> str:
        """Demand one of some words; returns it as it is known."""
        known = list(known)
        if (found := spelt(value, known)) is not None:
            return self.keep(name, found)
        hint = nearest(value, known) if isinstance(value, str) else ""
        self.refuse(name, f"must be one of {', '.join(known)}, got {shown(value)}{hint}")
        return known[0]

    def one_of(self, name: str, value: Any, names: Sequence[str]) -> int:
        """Demand one of several things that have a number each, some a name too; returns its number."""
        return self._numbers(name, plain(value), names)[0]

    def some_of(self, name: str, value: Any, names: Sequence[str]) -> list[int]:
        """Demand some of several things, or one; returns their numbers. A name stands for all that have it."""
        value = plain(value)
        each = value if hasattr(value, "__iter__") and not isinstance(value, str) else [value]
        return [number for one in each for number in self._numbers(name, plain(one), names)]

    def _numbers(self, name: str, value: Any, names: Sequence[str]) -> list[int]:
        """Find the numbers of what is meant by one number or name; refuse what means nothing."""
        if (found := spelt(value, filter(None, names))) is not None:
            return [number for number, one in enumerate(names) if spelt(one, [found])]
        if isinstance(value, int) and not isinstance(value, bool) and 0 <= value < len(names):
            return [value]
        known = enumerated([f"{number} ({one})" if one else f"{number}" for number, one in enumerate(names)])
        hint = nearest(value, filter(None, names)) if isinstance(value, str) else ""
        self.refuse(name, f"must be among {known}, got {shown(value)}{hint}")
        return [0]

    def array(self, name: str, value: ArrayLike, unit: str, shape: tuple[int | None, ...] | None) -> FloatArray:
        """Demand finite numbers in an array of the given shape (None: any, of a length too); returns a frozen copy.

        Nothing may have made an ordinary array of it before: that uncovers what is masked.
        """
        try:
            array = real_numbers(value)
        except (TypeError, ValueError, OverflowError, RecursionError):
            wanted = in_brackets("an array of numbers", unit)
            self.refuse(name, f"must be {wanted}, got {shown(value)}{instead_of('numbers', value)}")
            return np.full([n or 1 for n in shape or ()], np.nan)
        shape = array.shape if shape is None else shape
        wanted = "(" + ", ".join("any" if n is None else str(n) for n in shape) + ")"
        if array.ndim != len(shape) or any(n not in (None, m) for n, m in zip(shape, array.shape, strict=True)):
            hint = one_of(name, value) if shape == (None,) and array.ndim == 2 and array.shape[1] > 1 else ""
            self.refuse(name, f"must have shape {wanted}, got {array.shape}{hint}")
            return np.full([n or 1 for n in shape], np.nan)
        if array.size and not np.abs(array).max() <= CREDIBLE.largest:
            bad = np.argwhere(~(np.abs(array) <= CREDIBLE.largest))
            place = tuple(int(i) for i in bad[0])
            got = "a masked value" if masks(value) and np.isnan(array[place]) else repr(float(array[place]))
            self.refuse(
                name,
                f"must be finite and at most {with_unit(CREDIBLE.largest, unit)} throughout, got {got}{_at(place)}",
            )
        array.flags.writeable = False
        return self.keep(name, array)

    def spread(self, name: str, value: ArrayLike, unit: str, shape: tuple[int, ...]) -> FloatArray:
        """Demand finite numbers in an array of the given shape, or one for all of it."""
        array = self.array(name, value, unit, None)
        return np.broadcast_to(array, shape) if array.ndim == 0 else self.array(name, array, unit, shape)

    def listed(self, name: str, value: Any, kind: type[Kind], *, least: int = 1) -> tuple[Kind, ...]:
        """Demand a list of at least `least` objects of one kind."""
        if isinstance(value, (list, tuple)) and len(value) >= least and all(isinstance(one, kind) for one in value):
            return self.keep(name, tuple(value))
        number = "one or more" if least else "any number of"
        what = "texts" if kind is str else f"{kind.__name__} objects"
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
            wanted = in_brackets("two numbers", unit)
            self.refuse(name, f"must be {wanted}, got {shown(value)}{beyond_limits(name, value)}")
            return (float("nan"), float("nan"))
        check = self.finite if signed else self.positive if positive else self.not_negative
        check = self.positive_or_infinite if infinite else check
        return self.keep(name, (check(f"{name}[0]", first, unit), check(f"{name}[1]", second, unit)))


@contextmanager
def checking(owner: Any = None) -> Iterator[Checks]:
    """Run a block of checks and raise one `ParameterError` at its end if any of them failed.

    Parameters
    ----------
    owner : dataclass instance, optional
        A frozen value under construction: its fields become what was checked under their names.
    """
    checks = Checks()
    yield checks
    if checks.faults:
        raise ParameterError(checks.faults)
    for field in () if owner is None else fields(owner):
        if field.name in checks.values:
            object.__setattr__(owner, field.name, checks.values[field.name])


def real_numbers(value: Any) -> FloatArray:
    """Make numbers of an array, or of lists of them; nan of what is masked, whatever number lies below.

    Raises
    ------
    TypeError, ValueError, OverflowError
        If there is something else among them; true and false are no numbers.
    """
    kinds = _kinds(value)
    if kinds & {bool, np.bool_}:
        raise TypeError("true and false are no numbers")
    given = np.asarray(uncovered(value) if masks(value) else value)
    if given.size and given.dtype.kind not in "iuf" and not all(issubclass(kind, Real) for kind in kinds):
        raise TypeError(f"got {shown(value)}")
    return np.array(given, dtype=float)


def masks(value: Any) -> bool:
    """Whether an array, or one in a list, may be masked."""
    return any(issubclass(kind, np.ma.MaskedArray) for kind in _kinds(value))


def _at(place: tuple[int, ...]) -> str:
    """Say where in an array; nothing of one without axes."""
    return f" at index {place[0] if len(place) == 1 else place}" if place else ""


def uncovered(value: Any) -> Any:
    """Put nan where a masked array, or one in a list, has nothing; the number below a mask is none."""
    if isinstance(value, (list, tuple)):
        return [uncovered(each) for each in value]
    return np.where(np.ma.getmaskarray(value), np.nan, value.data) if masks(value) else value


def _kinds(value: Any) -> set[type]:
    """Collect the types of what lists hold, to any depth."""
    if not isinstance(value, (list, tuple)):
        return {type(value)}
    kinds = set(map(type, value))
    return set().union(*map(_kinds, value)) if kinds & {list, tuple} else kinds

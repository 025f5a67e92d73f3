"""What a table of a scenario can be: kinds, each of keys, made from what Python offers.

The one source is the function or class that a kind is made from: its signature gives names, types and defaults, its
docstring the words and units.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from operator import or_
from pathlib import Path
from types import NoneType, UnionType
from typing import Any, Union, get_args, get_origin

from numpy.typing import ArrayLike

from movingfrf._basics.checks import shown
from movingfrf._basics.documented import documented


def all_given(table: Mapping[str, Any], **given: Any) -> Mapping[str, Any]:
    """Say that what a table makes depends on all that is given beside it."""
    return given


# Default of a key that has none.
NEEDED = inspect.Parameter.empty

# Python type of a value → what TOML makes of it, and its name.
VALUES: Mapping[Any, tuple[Any, str]] = {
    float: ((int, float), "a number"),
    int: (int, "a whole number"),
    bool: (bool, "true or false"),
    str: (str, "a text"),
    Path: (str, "the name of a file"),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Key:
    """One key of a table.

    Parameters
    ----------
    name : str
        Its name, that of a keyword argument.
    type : type
        The type of its value, without None. That of a family is a table of the family, `Sequence` of it a list of
        such tables, `Path` the name of a file.
    default : object
        What it is where it is left out; NEEDED if it may not be.
    words : str
        What it says, with its unit in brackets.
    infinite : bool
        Whether its numbers may be infinite: documented as `float or inf`.
    """

    name: str
    type: Any
    default: Any = NEEDED
    words: str = ""
    infinite: bool = False

    @property
    def needed(self) -> bool:
        """Whether it may not be left out."""
        return self.default is NEEDED

    @property
    def unit(self) -> str:
        """Its unit; empty if it has none, as the name of a file, whatever stands in the file."""
        found = None if self.is_file else re.search(r"\[([^\]]+)\]", self.words)
        return found[1] if found else ""

    @property
    def item(self) -> Any:
        """The type of what it lists; None if it is no list."""
        return get_args(self.type)[0] if get_origin(self.type) is Sequence else None

    @property
    def is_file(self) -> bool:
        """Whether it names a file."""
        return Path in (self.type, *get_args(self.type))

    def refusal(self, value: Any) -> str:
        """Say that a value of the file is of another type; empty if it is not."""
        unit = f" [{self.unit}]" if self.unit else ""
        return "" if fits(value, self.type) else f"must be {in_words(self.type)}{unit}, got {shown(value)}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Kind:
    """One thing that a table can be.

    Parameters
    ----------
    name : str
        What the table's `kind` says: the Python name in snake_case.
    make : callable
        Makes it from the keys as keyword arguments, and checks them.
    keys : tuple of Key
        The keys that the table may have.
    words : str
        What it is, in a sentence.
    either : tuple of str
        Keys of which one is needed, and only one.
    beside : callable
        Says, of a table and of what is given beside it (of a road, the way of the journey), what of the latter it
        depends on: where that is the same, equal tables make the same.
    """

    name: str
    make: Callable[..., Any]
    keys: tuple[Key, ...]
    words: str = ""
    either: tuple[str, ...] = ()
    beside: Callable[..., Mapping[str, Any]] = all_given

    @classmethod
    def of(cls, target: Callable[..., Any], *, name: str | None = None, without: Sequence[str] = ()) -> Kind:
        """Make a kind of a function or a class.

        Parameters
        ----------
        target : callable
            What makes it; its arguments become the keys.
        name : str, optional
            Its name; None: that of the function or class.
        without : sequence of str
            Arguments that are no keys, since they have defaults or whoever calls `make` gives them.

        Returns
        -------
        Kind
            The kind.
        """
        return cls(
            name=name or snake_case(target.__name__),
            make=target,
            keys=keys_of(target, without=without),
            words=summary(target),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Family:
    """All that a table can be: kinds that stand for each other.

    Parameters
    ----------
    name : str
        What the family is called.
    makes : type
        What its kinds make: an argument of this type is a table of this family.
    kinds : dict of str to Kind
        By name.
    default : str, optional
        The kind that a table has if it does not say; None: it has to.
    """

    name: str
    makes: Any
    kinds: Mapping[str, Kind]
    default: str | None = None


def family(name: str, makes: Any, *members: Kind | Callable[..., Any], default: str | None = None) -> Family:
    """Gather kinds; functions and classes become kinds.

    Parameters
    ----------
    name : str
        What the family is called.
    makes : type
        What its kinds make.
    *members : Kind or callable
        The kinds.
    default : str, optional
        The kind that a table has if it does not say; an only kind need not be said.

    Returns
    -------
    Family
        The family.
    """
    kinds = [member if isinstance(member, Kind) else Kind.of(member) for member in members]
    only = kinds[0].name if len(kinds) == 1 else None
    return Family(name=name, makes=makes, kinds={kind.name: kind for kind in kinds}, default=default or only)


def keys_of(target: Callable[..., Any], *, without: Sequence[str] = ()) -> tuple[Key, ...]:
    """Make keys of the arguments of a function or a class.

    Parameters
    ----------
    target : callable
        With annotations, and documented the way NumPy documents.
    without : sequence of str
        Arguments that are no keys.

    Returns
    -------
    tuple of Key
        In the order of the arguments.

    Examples
    --------
    >>> from movingfrf.guideways.foundations import Spring
    >>> [(key.name, key.type.__name__, key.needed, key.unit) for key in keys_of(Spring)]
    [('stiffness', 'float', True, 'N/m²'), ('damping', 'float', False, 'N s/m²')]
    """
    said = documented(target)
    return tuple(
        Key(
            name=name,
            type=_without_none(parameter.annotation),
            default=parameter.default,
            words=said[name].words if name in said else "",
            infinite=name in said and said[name].type.endswith(" or inf"),
        )
        for name, parameter in inspect.signature(target, eval_str=True).parameters.items()
        if name not in without
    )


def fits(value: Any, wanted: Any) -> bool:
    """Whether a value of a file is of a type; what is made of tables is looked at where they are read."""
    items, origin = get_args(wanted), get_origin(wanted)
    if wanted in VALUES:
        return isinstance(value, VALUES[wanted][0]) and (wanted is bool or not isinstance(value, bool))
    if wanted == ArrayLike:
        return fits(value, float) or (isinstance(value, list) and all(fits(one, ArrayLike) for one in value))
    if origin in (Union, UnionType):
        return any(fits(value, one) for one in items)
    if origin is tuple:
        return isinstance(value, list) and len(value) == len(items) and all(map(fits, value, items))
    if origin is Sequence:
        return isinstance(value, list) and all(fits(one, items[0]) for one in value)
    if origin is Mapping:
        return isinstance(value, dict) and all(fits(one, items[1]) for one in value.values())
    return True


def in_words(wanted: Any) -> str:
    """Name a type of values."""
    items, origin = get_args(wanted), get_origin(wanted)
    if wanted in VALUES:
        return VALUES[wanted][1]
    if wanted == ArrayLike:
        return "a number or an array of numbers"
    if origin in (Union, UnionType):
        return " or ".join(map(in_words, items))
    if origin is tuple:
        return f"[{', '.join(map(in_words, items))}]"
    return "a table" if origin is Mapping else f"a list, each {in_words(items[0])}"


def chosen(given: Mapping[str, Any], keys: Sequence[Key]) -> dict[str, Any]:
    """Take the arguments that belong to some keys."""
    return {key.name: given[key.name] for key in keys if key.name in given}


def summary(target: Callable[..., Any]) -> str:
    """First line of a docstring."""
    return (inspect.getdoc(target) or "").split("\n", 1)[0]


def snake_case(name: str) -> str:
    """Write a Python name as kinds are written: `EulerBernoulliBeam` is `euler_bernoulli_beam`."""
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()


def _without_none(annotation: Any) -> Any:
    """Take None out of a union: that a value may be left out, its default says."""
    if get_origin(annotation) not in (Union, UnionType):
        return annotation
    return reduce(or_, [one for one in get_args(annotation) if one is not NoneType])

"""Values: equal and hashed by what they hold, arrays too, and shown in a few lines."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import fields, is_dataclass
from functools import partial
from hashlib import blake2b
from html import escape
from typing import Any, TypeVar

import numpy as np

Kind = TypeVar("Kind")


class Value:
    """Base of frozen dataclasses that hold arrays, or values that do; they say `eq=False`.

    Two values are equal if they are of one class and hold the same: arrays of one shape with the same numbers,
    whatever their type. As numbers 0 and −0 are equal; nan, which is no number, equals nan, so that a copy equals
    what it was made from. Functions are equal if they are the same one. Equal values have one hash.

    A value is shown by its class and, below it, the names and words that `told` gives; in a notebook as a small
    table. A dataclass that does not say `repr=False` keeps the representation that can be typed.
    """

    __slots__ = ()

    def __eq__(self, other: object) -> bool:
        """Whether the other is of the same class and holds the same."""
        if type(other) is not type(self):
            return NotImplemented
        return self is other or content(self) == content(other)

    def __hash__(self) -> int:
        """Hash of what it holds."""
        return hash(content(self))

    def __repr__(self) -> str:
        """Show it in a few lines."""
        return in_lines(self, self.told())

    def _repr_html_(self) -> str:
        """Show it as a small table in a notebook."""
        return as_table(self, self.told())

    def told(self) -> list[tuple[str, str]]:
        """Tell what is shown: names and words, a pair a line; the fields, unless a class knows better."""
        assert is_dataclass(self)
        return [(field.name, brief(getattr(self, field.name))) for field in fields(self) if field.repr]


class Listed(list[Kind]):
    """A list that is shown as a table, a line an item.

    Parameters
    ----------
    items : iterable
        What it holds.
    heads : sequence of str
        Heads of the columns.
    row : function
        From an item to its words, one a column.
    """

    # Lines at most [20 to 200: what one looks through].
    most = 60

    def __init__(self, items: Iterable[Kind], heads: Sequence[str], row: Callable[[Kind], Sequence[str]]) -> None:
        super().__init__(items)
        self._heads, self._row = heads, row

    def __reduce__(self) -> tuple[Any, ...]:
        """Take it apart for a copy or a file, with what its rows are made of."""
        return type(self), (list(self), self._heads, self._row)

    def __repr__(self) -> str:
        """Show its table, numbers and words below their heads."""
        if not self:
            return "[]"
        rows = [self._heads, *map(self._row, self[: self.most])]
        across = [max(map(len, column)) for column in zip(*rows, strict=True)]
        lines = ["  ".join(map(str.ljust, row, across)).rstrip() for row in rows]
        return "\n".join([*lines, *self._more()])

    def _repr_html_(self) -> str:
        """Show its table in a notebook."""
        rows = [("th", self._heads), *(("td", self._row(item)) for item in self[: self.most])]
        lines = [
            "".join(f'<{tag} style="text-align:left">{escape(cell)}</{tag}>' for cell in cells)
            for tag, cells in rows
        ]
        return f"<table><tr>{'</tr><tr>'.join(lines)}</tr></table>{''.join(self._more())}"

    def _more(self) -> list[str]:
        return [f"… {len(self) - self.most} more"] if len(self) > self.most else []


def in_lines(value: object, told: Sequence[tuple[str, str]]) -> str:
    """Show a value by its class and, below it, what it tells, a line each."""
    across = max((len(name) for name, _ in told), default=0)
    return "\n".join([type(value).__name__, *(f"  {name:<{across}}  {words}" for name, words in told)])


def as_table(value: object, told: Sequence[tuple[str, str]]) -> str:
    """Show a value as a small table of HTML, its class above what it tells."""
    rows = "".join(
        f'<tr><th style="text-align:left">{escape(name)}</th><td style="text-align:left">{escape(words)}</td></tr>'
        for name, words in told
    )
    return f"<table><caption>{escape(type(value).__name__)}</caption>{rows}</table>"


def content(value: Any) -> Any:
    """Take a value apart into what is compared and hashed: arrays by a sum over their bytes.

    Parameters
    ----------
    value : object
        Anything.

    Returns
    -------
    object
        Equal for equal values only, with one hash then; unhashable where something in it is.

    Examples
    --------
    >>> content(np.array([0.0, np.nan])) == content(np.array([-0.0, -np.nan]))
    True
    >>> content(np.array([0, 1])) == content(np.array([[0.0, 1.0]]))
    False
    """
    if isinstance(value, np.ndarray):
        if value.dtype.kind not in "biufc":
            return value.shape, content(value.ravel().tolist())
        # A sum with zero knows one zero only, and is contiguous; nan has many forms of bytes.
        numbers = np.ascontiguousarray(value) + (0j if value.dtype.kind == "c" else 0.0)
        numbers[np.isnan(numbers)] = np.nan
        return value.shape, blake2b(numbers.tobytes(), digest_size=16).digest()
    if hasattr(value, "tocsr"):  # sparse
        rows = value.tocsr(copy=True)
        rows.sum_duplicates()
        rows.eliminate_zeros()
        return value.shape, *map(content, (rows.indptr, rows.indices, rows.data))
    if is_dataclass(value) and not isinstance(value, type):
        return type(value), *(content(getattr(value, field.name)) for field in fields(value) if field.compare)
    if isinstance(value, (list, tuple)):
        return type(value) if hasattr(value, "_fields") else tuple, *map(content, value)
    if isinstance(value, Mapping):
        return frozenset((key, content(item)) for key, item in value.items())
    if isinstance(value, partial):
        return value.func, content(value.args), content(value.keywords)
    return "nan" if isinstance(value, (float, complex)) and value != value else value


def digest(value: Any) -> str:
    """Write a sum over what a value holds: text in place of its numbers, equal for equal values."""
    return blake2b(repr(content(value)).encode(), digest_size=8).hexdigest()


def brief(value: Any, most: int = 88) -> str:
    """Write a value in at most a line: of an array its shape and between what it lies.

    Parameters
    ----------
    value : object
        Anything.
    most : int
        Letters in a line.

    Returns
    -------
    str
        Words.

    Examples
    --------
    >>> brief(np.linspace(0.0, 1.0, 24000)), brief((0.5, 2.0)), brief("a text")
    ('24000 numbers from 0 to 1', '(0.5, 2.0)', 'a text')
    """
    if isinstance(value, np.ndarray) and value.size and value.dtype.kind in "biuf":
        if value.size <= 4:
            return str(value.tolist())
        size = " × ".join(map(str, value.shape))
        return f"{size} numbers from {value.min():.6g} to {value.max():.6g}"
    if hasattr(value, "tocsr"):
        return f"{value.shape[0]} × {value.shape[1]}, {value.nnz} of them not zero"
    if isinstance(value, Value) and str(value).count("\n"):
        value = "; ".join(words for _, words in value.told())
    text = " ".join(str(value).split())
    return text if len(text) <= most else f"{text[: most - 1]}…"

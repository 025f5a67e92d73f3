"""What the docstring of a function says of its parameters: their types and units are put into words there only."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable
from typing import Any, NamedTuple


class Parameter(NamedTuple):
    """One parameter in words."""

    type: str
    words: str  # in one line, with the unit in square brackets


def documented(function: Callable[..., Any]) -> dict[str, Parameter]:
    """Read the section `Parameters` of a numpydoc docstring.

    `a, b : float` counts for both; of as many units, `[N/m, N s/m]`, each has its own.

    Parameters
    ----------
    function : callable
        A function or a class.

    Returns
    -------
    dict of str to Parameter
        By name, in order. Empty without such a section.

    Examples
    --------
    >>> documented(documented)["function"]
    Parameter(type='callable', words='A function or a class.')
    """
    _, _, section = (inspect.getdoc(function) or "").partition("Parameters\n----------\n")
    groups: list[tuple[list[str], str, list[str]]] = []
    for line in section.partition("\n\n")[0].splitlines():
        if line.startswith(" "):
            groups[-1][2].append(line.strip())
        else:
            left, _, kind = line.partition(" : ")
            groups.append(([name.strip().lstrip("*") for name in left.split(",")], kind.strip(), []))
    return {
        name: Parameter(kind, _own_unit(" ".join(lines), place, len(names)))
        for names, kind, lines in groups
        for place, name in enumerate(names)
    }


def _own_unit(words: str, place: int, of: int) -> str:
    """Leave of the units in brackets, one for each of several arguments, that of one of them."""

    def own(found: re.Match[str]) -> str:
        units = found[1].split(", ")
        return f"[{units[place]}{found[2]}]" if len(units) == of else found[0]

    return re.sub(r"\[([^\];]+)([^\]]*)\]", own, words)

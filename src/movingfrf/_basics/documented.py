"""What the docstring of a function says of its parameters: their types and units are put into words there only."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any, NamedTuple


class Parameter(NamedTuple):
    """One parameter in words."""

    type: str
    words: str  # with the unit in square brackets


def documented(function: Callable[..., Any]) -> dict[str, Parameter]:
    """Read the section `Parameters` of a numpydoc docstring.

    Parameters
    ----------
    function : callable
        A function or a class.

    Returns
    -------
    dict of str to Parameter
        By name, in order; `a, b : float` counts for both. Empty without such a section.

    Examples
    --------
    >>> documented(documented)["function"]
    Parameter(type='callable', words='A function or a class.')
    """
    lines = (inspect.getdoc(function) or "").splitlines()
    found: dict[str, Parameter] = {}
    if "Parameters" not in lines:
        return found
    names: list[str] = []
    section = lines[lines.index("Parameters") + 2 :]
    for line, below in zip(section, [*section[1:], ""], strict=True):
        if below.startswith("---"):
            break
        if line and not line.startswith(" "):
            left, _, kind = line.partition(" : ")
            names = [name.strip().lstrip("*") for name in left.split(",")]
            found |= dict.fromkeys(names, Parameter(kind.strip(), ""))
        else:
            said = line.strip()
            found |= {name: found[name]._replace(words=f"{found[name].words} {said}".strip()) for name in names}
    return found

"""Axes as they are written in a line: `run.speed=5:35:61`."""

from __future__ import annotations

import math
from collections.abc import Iterable
from glob import glob, has_magic
from pathlib import Path
from typing import Any

import numpy as np

from movingfrf._basics.toml_file import tables_of


def axes_in(lines: Iterable[str], folder: Path = Path()) -> dict[Any, list[Any]]:
    """Understand axes.

    Parameters
    ----------
    lines : iterable of str
        Each `KEY=VALUES`. Values have commas between them; `first:last:count` are so many numbers, the last one
        included, `first:last` whole numbers; names with `*`, `?` or `[…]` the files that match, sorted. Keys that
        vary together have commas between them, their values semicolons: `a,b=1,2,3;10,20,30`.
    folder : Path
        Folder to which names of files are relative.

    Returns
    -------
    dict
        As `sweep` takes axes.

    Raises
    ------
    ValueError
        If a line is none, with what is wrong, or no file matches.

    Examples
    --------
    >>> axes_in(["run.speed=10:20:3", "roughness.seed=0:2", "roughness.road_class=A,B"])
    {'run.speed': [10.0, 15.0, 20.0], 'roughness.seed': [0, 1, 2], 'roughness.road_class': ['A', 'B']}
    >>> axes_in(["a.x,a.y=1,2;3,4"])
    {('a.x', 'a.y'): [(1, 3), (2, 4)]}
    """
    axes: dict[Any, list[Any]] = {}
    for line in lines:
        key, equals, values = line.partition("=")
        if "~" in values:
            raise ValueError(f"--over {line} is a range: --samples says how many are drawn from it")
        keys = tuple(each.strip() for each in key.split(","))
        if not equals or not all(keys) or not values.strip():
            raise _refused(line)
        columns = [_values(line, each) for each in (values.split(";") if len(keys) > 1 else [values])]
        columns = [[one for value in column for one in _matching(line, value, folder)] for column in columns]
        if len(columns) != len(keys):
            raise ValueError(f"--over {line} must have values for {len(keys)} keys, with ; between them")
        if len({len(column) for column in columns}) > 1:
            counts = " and ".join(str(len(column)) for column in columns)
            raise ValueError(f"--over {line} must have as many values for each key, got {counts}")
        name = keys if len(keys) > 1 else keys[0]
        if name in axes:
            raise ValueError(f"--over {line}: {key} varies twice")
        axes[name] = [*zip(*columns, strict=True)] if len(keys) > 1 else columns[0]
    return axes


def _refused(line: str) -> ValueError:
    how = "KEY=VALUES, with values as 10,20,30 or first:last:count, or first:last for whole numbers"
    return ValueError(f"--over {line} must be {how}")


def _values(line: str, text: str) -> list[Any]:
    """Understand the values of one key."""
    if ":" not in text or any(letter.isalpha() and letter not in "eE" for letter in text):
        return [_value(each.strip()) for each in text.split(",")]
    words = [each.strip() for each in text.split(":")]
    try:
        first, last, *count = map(_number, words)
    except ValueError:
        raise _refused(line) from None
    if not count:
        if not (isinstance(first, int) and isinstance(last, int) and first <= last):
            raise ValueError(f"--over {line}: {text} must be whole numbers, ascending; of others say how many")
        return list(range(first, last + 1))
    if len(count) > 1 or not isinstance(count[0], int) or count[0] < 1 or not math.isfinite(last - first):
        raise _refused(line)
    return np.linspace(first, last, count[0]).tolist()


def _matching(line: str, value: Any, folder: Path) -> list[Any]:
    """Put the files that match in the place of a pattern; what is none stays."""
    if not (isinstance(value, str) and has_magic(value)):
        return [value]
    found = sorted(name for name in glob(value, root_dir=folder, recursive=True) if (folder / name).is_file())
    if not found:
        raise ValueError(f"--over {line}: no file matches {value} in {folder.resolve()}")
    return found


def _number(text: str) -> int | float:
    """Read a number, whole if it is written so."""
    try:
        return int(text)
    except ValueError:
        return float(text)


def _value(text: str) -> Any:
    """Read a number, a truth value, or a text."""
    if text in ("true", "false"):
        return text == "true"
    try:
        return _number(text)
    except ValueError:
        return text


def ranges_in(lines: Iterable[str]) -> dict[Any, tuple[float, float]]:
    """Understand ranges of keys, as `run.speed=10~30`; keys that have one value have commas between them.

    Raises
    ------
    ValueError
        If a line is none, or a key stands twice.

    Examples
    --------
    >>> ranges_in(["run.speed=10~30", "vehicle.axles.0,vehicle.axles.1=1~2"])
    {'run.speed': (10.0, 30.0), ('vehicle.axles.0', 'vehicle.axles.1'): (1.0, 2.0)}
    """
    found: dict[Any, tuple[float, float]] = {}
    for line in lines:
        key, _, values = (part.strip() for part in line.partition("="))
        keys = tuple(each.strip() for each in key.split(","))
        low, _, high = values.partition("~")
        try:
            ends = float(low), float(high)
            if not all(keys):
                raise ValueError
        except ValueError:
            raise ValueError(f"--over {line} must be KEY=LOW~HIGH, as run.speed=10~30") from None
        name = keys if len(keys) > 1 else key
        if name in found:
            raise ValueError(f"--over {line}: {key} varies twice")
        found[name] = ends
    return found


def values_in(lines: Iterable[str]) -> dict[str, Any]:
    """Understand single values of keys, as `run.speed=22`; lists and tables as TOML writes them.

    Raises
    ------
    ValueError
        If a line is none.

    Examples
    --------
    >>> values_in(["run.speed=22", "vehicle.axles=[2.0, -2.0]", "roughness.road_class=C"])
    {'run.speed': 22, 'vehicle.axles': [2.0, -2.0], 'roughness.road_class': 'C'}
    """
    found: dict[str, Any] = {}
    for line in lines:
        key, equals, value = (part.strip() for part in line.partition("="))
        if not (key and equals and value):
            raise ValueError(f"--set {line} must be KEY=VALUE, as run.speed=22")
        if key in found:
            raise ValueError(f"--set {line}: {key} is set twice")
        try:
            found[key] = tables_of(f"value = {value}")["value"]
        except ValueError:
            found[key] = value
    return found


def part_in(text: str) -> tuple[int, int]:
    """Understand which part is to be solved.

    Raises
    ------
    ValueError
        If it is none.

    Examples
    --------
    >>> part_in("3/64")
    (3, 64)
    """
    number, slash, count = text.partition("/")
    if not (slash and number.strip().isdecimal() and count.strip().isdecimal()):
        raise ValueError(f"--part must be as 3/64, got {text}")
    which, of = int(number), int(count)
    if not 1 <= which <= of:
        raise ValueError(f"--part must be one from 1/{of} to {of}/{of}, got {text}")
    return which, of

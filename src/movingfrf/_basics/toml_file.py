"""TOML as people write it: what is wrong is said with the line and, where that is plain, what to write instead."""

from __future__ import annotations

import json
import math
import re
import tomllib
from typing import Any

# What TOML's reader says, what the line looks like, and what to do, {1} being the first group; the first that fits.
HINTS = (
    ("Cannot", r"\s*([\w.-]+)\s*=.*", "{1} stands there already: a key stands once in its table"),
    ("Cannot", r"\s*\[+([\w.-]+)\]+.*", "[{1}] stands there already, or {1} is no table: a table stands once"),
    ("Unescaped|hex|escape", r'.*".*\\.*', """a backslash has a meaning in "…": write / in its place, or '…'"""),
    ("", r"\s*([\w.-]+)\s*:.*", "between a key and its value stands =: {1} = …"),
    ("", r".*=\s*([+-]?\d+),(\d+)\s*(#.*)?", "a decimal point is a point: {1}.{2}"),
    ("", r".*=\s*[+-]?\d{1,3}(,\d{3})+(\.\d*)?\s*(#.*)?", "a number has no commas; 1_000 is one"),
    ("", r".*=\s*([+-]?)(\.\d+)\s*(#.*)?", "a number begins with a digit: {1}0{2}"),
    ("", r".*=\s*([+-]?\d+\.)\s*(#.*)?", "a number ends with a digit: {1}0"),
    ("", r".*=\s*(?:(T)rue|(F)alse)\b.*", "true and false begin with small letters"),
    ("", r".*=\s*[+-]?\d[\d.e+-]*\s*[A-Za-zµ%°].*", "behind a number stands no unit, unless in a comment: # m/s"),
    ("", r"\s*\[+[\w.-]*\s*(#.*)?", "a bracket is missing: ]"),
    ("", r"""[^"']*=[^"']*["'][^"']*""", "a quotation mark is missing"),
    ("", r".*=\s*[A-Za-z/].*", 'a text stands in quotation marks: "…"'),
)


def text_of(data: bytes) -> str:
    """Make text of the bytes of a file: UTF-8, or UTF-16, which PowerShell makes of what is redirected.

    Parameters
    ----------
    data : bytes
        The file.

    Returns
    -------
    str
        Its text.

    Raises
    ------
    ValueError
        If it is neither.
    """
    wide = data.startswith((b"\xff\xfe", b"\xfe\xff"))
    try:
        return data.decode("utf-16" if wide else "utf-8-sig")
    except UnicodeDecodeError as error:
        if wide or b"\0" in data:
            raise ValueError("is not a text file") from None
        line = data.count(b"\n", 0, error.start) + 1
        raise ValueError(f"is not UTF-8 (line {line}): save it as UTF-8") from None


def tables_of(text: str) -> dict[str, Any]:
    r"""Read TOML.

    Parameters
    ----------
    text : str
        TOML.

    Returns
    -------
    dict
        Tables, keys and values.

    Raises
    ------
    ValueError
        If it is none: what its reader says, with the line, and what to write instead where that is plain.

    Examples
    --------
    >>> tables_of("[run]\nduration = 20.0")
    {'run': {'duration': 20.0}}
    """
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise ValueError("is nested too deeply") from None
    except ValueError as error:  # TOML's own, or an integer of thousands of digits
        said = str(error)
        raise ValueError(f"is not TOML: {said}{_hint(said, text.splitlines())}") from None


def as_toml(tables: dict[str, Any], path: str = "") -> str:
    r"""Write TOML: tables under their heads, lists of tables within their key.

    Parameters
    ----------
    tables : dict
        Tables, keys and values, as `tables_of` gives them.
    path : str
        What leads to them.

    Returns
    -------
    str
        TOML that says the same.

    Examples
    --------
    >>> print(as_toml({"run": {"speed": 22.0}, "vehicle": {"kind": "train", "car": {"kind": "bogie"}}}), end="")
    [run]
    speed = 22.0
    <BLANKLINE>
    [vehicle]
    kind = "train"
    <BLANKLINE>
    [vehicle.car]
    kind = "bogie"
    """
    own = [f"{_key(key)} = {_said(value)}\n" for key, value in tables.items() if not isinstance(value, dict)]
    parts = [f"[{path}]\n" + "".join(own)] if path and (own or not tables) else own
    for key, value in tables.items():
        if isinstance(value, dict):
            parts.append(as_toml(value, f"{path}.{_key(key)}" if path else _key(key)))
    return "\n".join(parts)


def _key(key: str) -> str:
    """Write a key, in quotation marks where it needs them."""
    return key if re.fullmatch(r"[\w-]+", key, re.ASCII) else json.dumps(key)


def _said(value: Any) -> str:
    """Write a value; JSON and TOML agree about texts, numbers and lists."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_key(key)} = {_said(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_said, value)) + "]"
    if isinstance(value, bool | str):
        return json.dumps(value)
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    return value.isoformat() if hasattr(value, "isoformat") else repr(value)


def _hint(said: str, lines: list[str]) -> str:
    """Say what to write, if it is plain from the line; of a text that never ends, from the last one."""
    found = re.search(r"at line (\d+)", said)
    number = int(found[1]) if found else len(lines)
    line = lines[number - 1] if 0 < number <= len(lines) else ""
    for about, looks, words in HINTS:
        if re.search(about, said) and (groups := re.fullmatch(looks, line)):
            return "; " + re.sub(r"\{(\d)\}", lambda which: groups[int(which[1])] or "", words)
    return ""

"""The JSON Schema of a scenario, by which editors complete and check TOML: made from the kinds of its tables."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import UnionType
from typing import Any, Union, get_args, get_origin

from numpy.typing import ArrayLike

from movingfrf._basics.version import VERSION
from movingfrf.scenarios.kind import Family, Key, Kind
from movingfrf.scenarios.kinds import DRIVE, PASSAGE, TABLES

# A part of a schema.
Part = dict[str, Any]

TITLE = "A scenario of movingfrf"

# Python type of a value → its schema.
VALUES: Mapping[Any, Part] = {
    float: {"type": "number"},
    int: {"type": "integer"},
    bool: {"type": "boolean"},
    str: {"type": "string"},
    Path: {"type": "string"},
    ArrayLike: {"$ref": "#/definitions/numbers"},
}


def scenario_schema() -> Part:
    """Make the JSON Schema of a scenario.

    Returns
    -------
    dict
        Draft 07: every table, every kind, every key with its type, unit, default and words.
    """
    numbers = {"type": "array", "items": {"anyOf": [{"type": "number"}, {"$ref": "#/definitions/numbers"}]}}
    return {
        # Draft 07 is what editors of TOML know: they complete along oneOf and $ref, but not along if and then.
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": TITLE,
        "description": f"movingfrf {VERSION}: a vehicle on a rough road, or prescribed loads. SI units throughout.",
        "oneOf": [_scenario(DRIVE), _scenario(PASSAGE)],
        "definitions": {
            "numbers": {"anyOf": [{"type": "number"}, numbers]},
            **{family.name: _family(family) for family in TABLES.values()},
        },
    }


def schema_as_json() -> str:
    """Write the JSON Schema of a scenario.

    Returns
    -------
    str
        JSON.
    """
    return json.dumps(scenario_schema(), indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def _scenario(tables: Mapping[str, Family]) -> Part:
    return {
        "type": "object",
        "properties": {name: _table(family) for name, family in tables.items()},
        "required": list(tables),
        "additionalProperties": False,
    }


def _table(family: Family) -> Part:
    """Refer to a family; the two families that are called `run` stand where they are used."""
    listed = family.makes in TABLES and TABLES[family.makes] is family
    return {"$ref": f"#/definitions/{family.name}"} if listed else _family(family)


def _family(family: Family) -> Part:
    parts = [_kind(kind, family) for kind in family.kinds.values()]
    return parts[0] if len(parts) == 1 else {"oneOf": parts}


def _kind(kind: Kind, family: Family) -> Part:
    """Describe one kind: its `kind`, needed unless it is the default or the only one, and its keys."""
    said = {"kind": {"type": "string", "enum": [kind.name], "description": kind.words}}
    several = len(family.kinds) > 1
    needed = [key.name for key in kind.keys if key.needed]
    return {
        "title": kind.name,
        "description": kind.words,
        "type": "object",
        "properties": (said if several else {}) | {key.name: _key(key) for key in kind.keys},
        "required": (["kind"] if several and kind.name != family.default else []) + needed,
        "additionalProperties": False,
    } | ({"oneOf": [{"required": [name]} for name in kind.either]} if kind.either else {})


def _key(key: Key) -> Part:
    part: Part = {"description": _words(key), **_type(key.type, infinite=key.infinite)}
    if not key.needed and key.default is not None and key.default != math.inf:
        part["default"] = key.default
    return part


def _words(key: Key) -> str:
    if key.needed:
        return key.words
    if key.default is None:
        return f"{key.words} May be left out."
    return f"{key.words} Default: {json.dumps(key.default).replace('Infinity', 'inf')}."


def _type(given: Any, *, infinite: bool = False) -> Part:
    """Describe the values of a Python type."""
    if given is float and infinite:
        # JSON has no infinity: what reads TOML for it makes nothing of `inf`.
        return {"type": ["number", "null"]}
    if given in TABLES:
        return _table(TABLES[given])
    if given in VALUES:
        return VALUES[given]
    items = get_args(given)
    origin = get_origin(given)
    if origin in (Union, UnionType):
        parts = [_type(one) for one in items]
        different = [part for n, part in enumerate(parts) if part not in parts[:n]]
        return {"anyOf": different} if len(different) > 1 else different[0]
    if origin is tuple:
        return {
            "type": "array",
            "items": _type(items[0], infinite=infinite),
            "minItems": len(items),
            "maxItems": len(items),
        }
    if origin is Sequence:
        return {"type": "array", "items": _type(items[0])} | ({"minItems": 1} if items[0] in TABLES else {})
    if origin is Mapping:
        return {"type": "object", "additionalProperties": _type(items[1])}
    raise TypeError(f"no schema for {given!r}")

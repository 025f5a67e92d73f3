"""Scenarios that differ by the values of some keys; what is made of equal tables is made once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from hashlib import blake2b, file_digest
from pathlib import Path
from typing import Any

import numpy as np

from movingfrf._basics.checks import nearest
from movingfrf._basics.toml_file import as_toml, tables_of, text_of
from movingfrf.scenarios.kinds import DRIVE, PASSAGE, TABLES
from movingfrf.scenarios.reading import Known, scenario_of, way_of
from movingfrf.scenarios.roads import places
from movingfrf.scenarios.scenario import Scenario

Tables = Mapping[str, Any]


def tables_in(scenario: Scenario | str | Path | Tables) -> tuple[dict[str, Any], Path, str]:
    """Give the tables of a scenario, the folder that its paths are relative to, and its name.

    Parameters
    ----------
    scenario : Scenario, str, Path or mapping
        A scenario, a file, or its tables.

    Returns
    -------
    tables : dict
        As the file says them.
    folder : Path
        The folder.
    name : str
        The scenario's name.

    Raises
    ------
    ValueError
        If the file cannot be read.
    """
    if isinstance(scenario, Scenario):
        return tables_of(scenario.text), scenario.folder, scenario.name
    if isinstance(scenario, Mapping):
        return plain(scenario), Path(), "scenario"
    path = Path(scenario)
    try:
        return tables_of(text_of(path.read_bytes())), path.parent, path.stem
    except OSError as error:
        raise ValueError(f"{path}: cannot be read: {error.strerror or error}") from None
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def plain(value: Any) -> Any:
    """Replace what NumPy makes of numbers and lists by what TOML makes of them, within tables too.

    Examples
    --------
    >>> plain({"speed": np.float64(3.0), "axles": (np.int64(1), 2.5)})
    {'speed': 3.0, 'axles': [1, 2.5]}
    """
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return plain(value.tolist()) if isinstance(value, np.ndarray) else value.item()
    if isinstance(value, Path):
        return str(value)
    return [plain(item) for item in value] if isinstance(value, list | tuple) else value


def changed(tables: Any, path: Sequence[str], value: Any, *, before: str = "") -> Any:
    """Put a value into tables, which stay as they are.

    Parameters
    ----------
    tables : dict or list
        Tables, or a list of them or of values.
    path : sequence of str
        Names of tables and of a key in them, numbers in lists.
    value : object
        The value.
    before : str
        What leads here, for the message.

    Returns
    -------
    dict or list
        The same but for this value.

    Raises
    ------
    ValueError
        If the path leads nowhere, with the nearest spelling.

    Examples
    --------
    >>> changed({"run": {"speed": 10.0}}, ["run", "speed"], 12.0)
    {'run': {'speed': 12.0}}
    """
    name, rest = path[0], path[1:]
    place = f"{before}.{name}" if before else name
    if isinstance(tables, list):
        if not name.isdecimal() or int(name) >= len(tables):
            numbers = f"0 to {len(tables) - 1}" if tables else "none"
            raise ValueError(f"{place} names nothing: {before} is a list, with the numbers {numbers}")
        number = int(name)
        put = changed(tables[number], rest, value, before=place) if rest else value
        return [*tables[:number], put, *tables[number + 1 :]]
    if not isinstance(tables, dict):
        raise ValueError(f"{place} names nothing: {before} is neither a table nor a list")
    if rest and name not in tables:
        raise ValueError(
            f"{place} names nothing: there is no {name}{nearest(name, tables)} in {before or 'the file'}"
        )
    return {**tables, name: changed(tables[name], rest, value, before=place) if rest else value}


def section_in(name: str, value: Any, folder: Path) -> Any:
    """Turn the name of a file, or of an entry of the catalogue, into the table that it stands for.

    Parameters
    ----------
    name : str
        Name of the table.
    value : object
        What stands in its place; what is no text stays.
    folder : Path
        Folder to which the path is relative.

    Returns
    -------
    object
        A table.

    Raises
    ------
    ValueError
        If the file cannot be read, or holds no such table.
    """
    if name not in {**DRIVE, **PASSAGE} or not isinstance(value, str):
        return value
    ending = Path(value).suffix.lower()
    if not ending and name == "vehicle":
        return {"kind": "catalogue", "name": value}
    if ending == ".toml":
        tables, there, _ = tables_in(folder / value)
        if name in tables:
            return _from_here(tables[name], there)
    others = {"vehicle": "vehicle_file", "roughness": "profile", "guideway": "sampled_guideway"}
    if name not in others or (ending == ".toml" and name != "vehicle"):
        raise ValueError(f"{name}: {value} holds no table [{name}]")
    return {"kind": others[name], "file": value}


def _from_here(said: Any, folder: Path) -> Any:
    """Let the names of files in tables from another folder lead there."""
    if isinstance(said, dict):
        return {key: _from_here(item, folder) for key, item in said.items()}
    if isinstance(said, list):
        return [_from_here(item, folder) for item in said]
    file = _file_in(said, folder)
    return said if file is None else str(file.resolve())


def _file_in(said: Any, folder: Path) -> Path | None:
    """Give the file that a value names; None if it names none."""
    try:
        return folder / said if isinstance(said, str) and (folder / said).is_file() else None
    except (OSError, ValueError):  # too long for a name, or no name at all
        return None


def contents(said: Any, folder: Path) -> dict[str, str]:
    """Tell the contents of all files that tables name, and of those that these name.

    Parameters
    ----------
    said : object
        Tables, lists and values.
    folder : Path
        Folder to which paths are relative.

    Returns
    -------
    dict of str to str
        By the name of the file a few letters that change with what it holds.
    """
    if isinstance(said, Mapping):
        said = list(said.values())
    if isinstance(said, list | tuple):
        return {name: letters for item in said for name, letters in contents(item, folder).items()}
    file = _file_in(said, folder)
    if file is None:
        return {}
    with file.open("rb") as opened:
        found = {str(file): file_digest(opened, lambda: blake2b(digest_size=8)).hexdigest()}
    if file.suffix.lower() == ".toml":
        with suppress(ValueError):  # whoever reads it says what is wrong
            tables, there, _ = tables_in(file)
            found |= contents(tables, there)
    return found


def unit_of(tables: Tables, path: str) -> str:
    """Give the unit of a key.

    Parameters
    ----------
    tables : mapping
        The scenario.
    path : str
        Where the key stands in it.

    Returns
    -------
    str
        The unit; empty if it has none, or is a whole table.

    Examples
    --------
    >>> unit_of({"vehicle": {"kind": "half_car", "tyre_stiffness": [3e6, 4e6]}}, "vehicle.tyre_stiffness.0")
    'N/m'
    """
    name, *rest = path.split(".")
    family, table = {**PASSAGE, **DRIVE}.get(name), tables.get(name)
    while family is not None and isinstance(table, Mapping) and rest:
        kind = family.kinds.get(str(table.get("kind", family.default or next(iter(family.kinds)))))
        key = next((key for key in kind.keys if key.name == rest[0]), None) if kind else None
        if key is None:
            return ""
        family, table, rest = TABLES.get(key.type) or TABLES.get(key.item), table.get(rest[0]), rest[1:]
        if family is None:
            return key.unit
        if isinstance(table, list) and rest and rest[0].isdecimal():
            table, rest = (table[int(rest[0])] if int(rest[0]) < len(table) else None), rest[1:]
    return ""


class Variants:
    """Scenarios that differ by the values of some keys.

    Parameters
    ----------
    tables : dict
        The scenario.
    folder : Path
        Folder to which paths in it are relative.
    name : str
        Its name.
    """

    def __init__(self, tables: dict[str, Any], folder: Path, name: str) -> None:
        self.tables, self.folder, self.name = tables, folder, name
        self._known = Known()

    def at(self, values: Mapping[str, Any], *, told: bool = True) -> Scenario:
        """Take some values.

        Parameters
        ----------
        values : mapping of str to object
            By the path of the key: `vehicle.tyre_stiffness.0`, or a whole table.
        told : bool
            Whether the scenario has a text.

        Returns
        -------
        Scenario
            Checked.

        Raises
        ------
        ScenarioError
            With everything that is wrong.
        ValueError
            If a path leads nowhere.
        """
        tables = self.tables_at(values)
        text = as_toml(tables) if told else ""
        return scenario_of(
            tables, name=self.name, source=self.name, folder=self.folder, text=text, known=self._known
        )

    def tables_at(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """Give the tables with some values, as `at` takes them, unchecked."""
        tables: Any = self.tables
        for path, value in values.items():
            names = path.split(".")
            there = self._section(path, value) if len(names) == 1 and isinstance(value, str) else value
            tables = changed(tables, names, there)
        found: dict[str, Any] = tables
        return found

    def roads_at(self, values: Mapping[str, Any]) -> list[Any]:
        """Say where all realised roads lie, as `places` does, with some values; none where there is no such way."""
        with suppress(ValueError):  # whoever solves the case says what is wrong
            tables = self.tables_at(values)
            way, road = way_of(tables, self.folder, self._known), tables.get("roughness")
            return [] if way is None or not isinstance(road, dict) else places(road, way)
        return []

    def _section(self, name: str, value: str) -> Any:
        """Read what stands for a whole table, once as long as it is among the latest."""
        return self._known.taken("whole", (name, value), lambda: section_in(name, value, self.folder))

"""Scenario files: TOML in, checked objects out, all faults of a file at once."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from movingfrf._basics.checks import Fault, ParameterError, checking, nearest, shown, spelt
from movingfrf._basics.toml_file import tables_of, text_of
from movingfrf.guideways.sampled import SampledGuideway
from movingfrf.response.line import Line, require_record
from movingfrf.response.ride import line_of
from movingfrf.roughness.excitation import require_cover
from movingfrf.scenarios.kind import Family, Key, Kind
from movingfrf.scenarios.kinds import DRIVE, PASSAGE, TABLES, VEHICLE
from movingfrf.scenarios.roads import Way
from movingfrf.scenarios.scenario import Drive, Passage, Scenario, ScenarioError
from movingfrf.scenarios.stepped import require_journey
from movingfrf.stepping.finite_guideway import FiniteGuideway
from movingfrf.vehicles.catalogue import CATALOGUE, catalogue
from movingfrf.vehicles.files import read_vehicle
from movingfrf.vehicles.vehicle import Vehicle


def read_scenario(file: str | Path) -> Scenario:
    """Read and check a scenario file.

    Parameters
    ----------
    file : str or Path
        The file; paths in it are relative to its folder.

    Returns
    -------
    Scenario
        Ready to run.

    Raises
    ------
    ScenarioError
        With everything that is wrong with the file.
    ValueError
        If it is no name of a file.
    """
    with checking() as check:
        path = check.file("file", file)
    return parse_scenario(_text(path), name=path.stem, source=str(path), folder=path.parent)


def named_vehicle(name: str | Path) -> Vehicle:
    """Find a vehicle: in the catalogue, in a file of matrices, or in the [vehicle] table of a scenario.

    Parameters
    ----------
    name : str or Path
        Name in the catalogue, or a file.

    Returns
    -------
    Vehicle
        The vehicle.

    Raises
    ------
    ValueError
        If there is none, or it is refused.
    """
    path = Path(name)
    if not path.suffix:
        return catalogue(name=str(name))
    if path.suffix.lower() != ".toml":
        return read_vehicle(path)
    tables = _tables(_text(path), str(path))
    if "vehicle" not in tables:
        return read_vehicle(path)
    builder = _Builder(path.parent)
    vehicle: Vehicle | None = builder.section(tables, "vehicle", VEHICLE)
    if builder.faults or vehicle is None:
        raise ScenarioError(str(path), builder.faults)
    return vehicle


def parse_scenario(
    text: str, *, name: str = "scenario", source: str = "scenario", folder: str | Path = "."
) -> Scenario:
    """Check the text of a scenario.

    Parameters
    ----------
    text : str
        TOML.
    name : str
        Name of the scenario.
    source : str
        Where the text comes from, for messages.
    folder : str or Path
        Folder to which paths in the text are relative.

    Returns
    -------
    Scenario
        Ready to run.

    Raises
    ------
    ScenarioError
        With everything that is wrong with the text.
    """
    return scenario_of(_tables(text, source), name=name, source=source, folder=folder, text=text)


class Known:
    """What was made of tables, to be taken again for equal ones: of each table the latest few.

    What a value remembers of others (`latest`) is worth most where the same values meet again.
    """

    def __init__(self) -> None:
        self._made: dict[str, dict[tuple[Any, ...], Any]] = {}

    def taken(self, name: str, asked: tuple[Any, ...], make: Callable[[], Any]) -> Any:
        """Take what was made of this, or make it; what could not be made (None) is not kept."""
        # Roads may be long. [1 to 1000: memory and time only]
        most = 4 if name.startswith("roughness") else 64
        made = self._made.setdefault(name, {})
        if asked in made:
            return made[asked]
        new = make()
        if new is not None:
            made[asked] = new
            while len(made) > most:
                del made[next(iter(made))]
        return new


def scenario_of(
    tables: dict[str, Any],
    *,
    name: str = "scenario",
    source: str = "scenario",
    folder: str | Path = ".",
    text: str = "",
    known: Known | None = None,
) -> Scenario:
    """Check the tables of a scenario.

    Parameters
    ----------
    tables : dict
        As TOML gives them.
    name : str
        Name of the scenario.
    source : str
        Where they come from, for messages.
    folder : str or Path
        Folder to which paths in them are relative.
    text : str
        What they were read from.
    known : Known, optional
        What was made of other tables.

    Returns
    -------
    Scenario
        Ready to run.

    Raises
    ------
    ScenarioError
        With everything that is wrong with them.
    """
    if not tables:
        raise ScenarioError(source, [Fault("the file", "is empty; `movingfrf new` writes one to start from")])
    builder = _Builder(Path(folder), known)
    scenario = builder.scenario(tables, name, text)
    if builder.faults or scenario is None:
        raise ScenarioError(source, builder.faults)
    return scenario


def way_of(tables: Mapping[str, Any], folder: Path, known: Known | None = None) -> Way | None:
    """Find the way of a scenario's vehicle, whatever else is wrong with the scenario.

    Parameters
    ----------
    tables : mapping
        As TOML gives them.
    folder : Path
        Folder to which paths in them are relative.
    known : Known, optional
        What was made of other tables.

    Returns
    -------
    Way or None
        None: vehicle or journey is missing or refused.
    """
    builder = _Builder(folder, known)
    vehicle, journey = (builder.section(tables, key, DRIVE[key]) for key in ("vehicle", "run"))
    return None if vehicle is None or journey is None else Way.of(journey, vehicle)


def _text(path: Path) -> str:
    try:
        return text_of(path.read_bytes())
    except OSError as error:
        raise ScenarioError(str(path), [Fault("the file", f"cannot be read: {error.strerror or error}")]) from None
    except ValueError as error:
        raise ScenarioError(str(path), [Fault("the file", str(error))]) from None


def _tables(text: str, source: str) -> dict[str, Any]:
    try:
        return tables_of(text)
    except ValueError as error:
        raise ScenarioError(source, [Fault("the text", str(error))]) from None


class _Builder:
    """Turns tables into objects and collects what is wrong with them."""

    def __init__(self, folder: Path, known: Known | None = None) -> None:
        self.folder = folder
        self.known = known
        self.faults: list[Fault] = []

    def scenario(self, tables: dict[str, Any], name: str, text: str) -> Scenario | None:
        """Build everything; None if that was not possible, with the reasons in `faults`."""
        with_loads = "loads" in tables
        wanted = PASSAGE if with_loads else DRIVE
        for key in DRIVE.keys() - PASSAGE.keys() if with_loads else ():
            if key in tables:
                self.faults.append(Fault(key, "and [loads] exclude each other: forces are computed or prescribed"))
                return None
        self._check_keys("", tables, wanted, wanted)
        case = (self._passage if with_loads else self._drive)(tables)
        if case is None or not self._suits(case):
            return None
        return Scenario(name=name, text=text, case=case, folder=self.folder)

    def _suits(self, case: Drive | Passage) -> bool:
        """Refuse a journey off a finite road, or other than one that was recorded."""
        match case.guideway:
            case FiniteGuideway() as road:
                what = "the contacts" if isinstance(case, Drive) else "loads and observers"
                return self._attempt(
                    "guideway:", lambda: require_journey(road, case.places, case.journey, what=what)
                )
            case SampledGuideway() as record:
                at_speed = self._attempt("run:", lambda: record.require_speed(case.journey.speed))
                return self._attempt("guideway:", lambda: record.columns(**case.offsets)) and at_speed
        return True

    def _passage(self, tables: Mapping[str, Any]) -> Passage | None:
        made = {key: self.section(tables, key, family) for key, family in PASSAGE.items()}
        loads, journey = made["loads"], made["run"]
        if loads is not None and journey is not None:
            channels = loads.positions.size + loads.observe.size
            self._attempt(
                "run:",
                lambda: require_record(Line(samples=journey.samples, time_step=journey.time_step), channels),
            )
        return None if self.faults else Passage(guideway=made["guideway"], loads=loads, journey=journey)

    def _drive(self, tables: Mapping[str, Any]) -> Drive | None:
        guideway = self.section(tables, "guideway", DRIVE["guideway"])
        vehicle = self.section(tables, "vehicle", DRIVE["vehicle"])
        journey = self.section(tables, "run", DRIVE["run"])
        # Some way, so that the road is checked even where the journey itself is refused.
        way = Way(0.0, 1.0, (0.0, 1.0))
        if journey is not None and vehicle is not None:
            way = Way.of(journey, vehicle)
            if self._attempt("run:", lambda: line_of(journey, vehicle)) is False:
                return None
        road = self.section(tables, "roughness", DRIVE["roughness"], way=way)
        if vehicle is not None and road is not None and journey is not None:
            paths, (first, last) = vehicle.paths, journey.interval(vehicle)
            self._attempt("roughness:", lambda: require_cover(road.profile, first, last, paths))
        return None if self.faults else Drive(guideway=guideway, vehicle=vehicle, road=road, journey=journey)

    def section(self, tables: Mapping[str, Any], key: str, family: Family, **given: Any) -> Any:
        """Build one table of the file, if it is there; None, with the reasons in `faults`, if it is refused."""
        if key not in tables:
            return None
        return self._taken(tables[key], family, key, **given)

    def _taken(self, table: Any, family: Family, path: str, **given: Any) -> Any:
        """Take what was made of an equal table and of what matters beside it, or build it."""

        def make() -> Any:
            return self._built(table, family, path, **given)

        if self.known is None:
            return make()
        name = table.get("kind") if isinstance(table, dict) else None
        kind = family.kinds.get(name) if isinstance(name, str) else None
        beside = given if kind is None else kind.beside(table, **given)
        return self.known.taken(path, (repr(table), repr(beside)), make)

    def _built(self, table: Any, family: Family, path: str, **given: Any) -> Any:
        """Build one table, or return None and leave the reasons in `faults`.

        What is `given` beside the table's own keys goes to whatever makes the kind, and to parts of its family.
        """
        if not isinstance(table, dict):
            self.faults.append(Fault(path, f"must be a table [{path}], got {shown(table)}"))
            return None
        kind = self._kind(table, family, path)
        if kind is None:
            return None
        known = [*(key.name for key in kind.keys), *(["kind"] if len(family.kinds) > 1 else [])]
        broken = self._check_keys(f"{path}.", table, known, {key.name for key in kind.keys if key.needed})
        arguments: dict[str, Any] = dict.fromkeys(broken)
        for key in kind.keys:
            if key.name in table:
                before = len(self.faults)
                parts = given if key.item == family.makes else {}
                arguments[key.name] = self._argument(key, table[key.name], f"{path}.{key.name}", **parts)
                if len(self.faults) > before:
                    broken.add(key.name)
        try:
            made = kind.make(**arguments, **given)
        except ParameterError as error:
            for fault in error.faults:
                # What is missing or broken has been reported; its stand-in None need not be.
                if re.split(r"[\[.]", fault.name)[0] not in broken:
                    self.faults.append(Fault(f"{path}.{fault.name}", fault.message))
            return None
        except ValueError as error:
            if not broken:
                self.faults.append(Fault(f"{path}:", str(error)))
            return None
        except (TypeError, AttributeError):
            # A stand-in, or a value of another type, is of no use to a function that goes on before it refuses;
            # its other errors are defects.
            said = [key for key in kind.keys if key.name in table.keys() - broken]
            refusals = {key.name: key.refusal(table[key.name]) for key in said}
            self.faults += [Fault(f"{path}.{name}", message) for name, message in refusals.items() if message]
            if not broken and not any(refusals.values()):
                raise
            return None
        return None if broken else made

    def _kind(self, table: Mapping[str, Any], family: Family, path: str) -> Kind | None:
        name, kinds = table.get("kind", family.default), family.kinds
        if name is None:
            self.faults.append(Fault(f"{path}.kind", f"is missing; it is one of {', '.join(kinds)}"))
        elif not isinstance(name, str) or name not in kinds:
            hint = nearest(str(name), kinds)
            if "catalogue" in kinds and (entry := spelt(name, CATALOGUE)):
                hint = f', which is in the catalogue: kind = "catalogue", name = "{entry}"'
            self.faults.append(Fault(f"{path}.kind", f"must be one of {', '.join(kinds)}, got {shown(name)}{hint}"))
        else:
            return kinds[name]
        return None

    def _argument(self, key: Key, value: Any, path: str, **given: Any) -> Any:
        """Turn the value of a key into an argument: a table or a list of tables into what they make, a file."""
        if key.type in TABLES:
            return self._built(value, TABLES[key.type], path)
        if key.item in TABLES:
            if not isinstance(value, list) or not value:
                self.faults.append(Fault(path, f"must be one or more tables [[{path}]]"))
                return None
            # Parts that are given something beside their tables are roads: dear.
            build = self._taken if given else self._built
            return [build(table, TABLES[key.item], f"{path}[{n}]", **given) for n, table in enumerate(value)]
        if key.is_file:
            if not isinstance(value, str) or "\0" in value:
                self.faults.append(Fault(path, f"must be the name of a file, got {shown(value)}"))
                return None
            if re.search(r"[\x00-\x1f]", value):
                why = """a backslash has a meaning in "…": write / in its place, or '…'"""
                self.faults.append(Fault(path, f"must be the name of a file, got {shown(value)}; {why}"))
                return None
            return self.folder / value
        return value

    def _check_keys(
        self, prefix: str, table: Mapping[str, Any], known: Iterable[str], required: Iterable[str]
    ) -> set[str]:
        """Report unknown and missing keys; returns the missing ones."""
        known = list(known)
        for key in table:
            if key not in known:
                allowed = ", ".join(sorted(known))
                self.faults.append(
                    Fault(f"{prefix}{key}", f"is not known here{nearest(key, known)}; allowed are {allowed}")
                )
        missing = set(required) - table.keys()
        for key in sorted(missing):
            self.faults.append(Fault(f"{prefix}{key}", "is missing"))
        return missing

    def _attempt(self, path: str, action: Callable[[], object]) -> bool:
        """Run a check that raises; False if it did."""
        try:
            action()
        except ValueError as error:
            self.faults.append(Fault(path, str(error)))
            return False
        return True

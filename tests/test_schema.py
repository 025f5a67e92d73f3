"""The JSON Schema of scenarios: it lets pass what the reader takes, and refuses what the reader refuses."""

from __future__ import annotations

import json
import math
import re
import tomllib
from pathlib import Path

import jsonschema
import pytest

import movingfrf as mf
from movingfrf.commands.main import main
from movingfrf.scenarios.kinds import DRIVE, TABLES
from movingfrf.scenarios.reading import _Builder, parse_scenario
from movingfrf.scenarios.schema import schema_as_json
from movingfrf.scenarios.template import template
from tests.test_roads import CAR, PARTS, SHAPE_KINDS, SPECTRUM_KINDS
from tests.test_sampled_files import CASE as SAMPLED
from tests.test_sampled_files import FINITE
from tests.test_scenario import LOADS, edited
from tests.test_vehicle_scenarios import GROUND, TEXTS

ROOT = Path(__file__).parents[1]
SCHEMA = json.loads(schema_as_json())
CHECK = jsonschema.Draft7Validator(SCHEMA)

FILES = [
    *sorted((ROOT / "examples").glob("*.toml")),
    *sorted((ROOT / "src" / "movingfrf").rglob("*.toml")),
]
IN_ORDER = {
    **{file.name: file.read_text(encoding="utf-8") for file in FILES},
    **{f"vehicle {kind}": text + GROUND for kind, text in TEXTS.items()},
    **{
        f"roughness {kind}": f'{CAR}[roughness]\nkind = "{kind}"\n{keys}'
        for kind, (keys, _) in (SPECTRUM_KINDS | SHAPE_KINDS).items()
    },
    "roughness superposed": f"{CAR}[roughness]\n{PARTS}",
    "prescribed loads": LOADS,
    "a sampled guideway": SAMPLED,
    "a finite plate": FINITE,
    "a guideway that does not say its kind": LOADS.replace("[guideway]", "[guideway]\nkind = 'track'"),
    "a seed for each path": edited(seed="[1, 2]"),
}


def wrong(text):
    """Mistakes in a scenario, as an editor finds them."""
    return [error.message for error in CHECK.iter_errors(tomllib.loads(text))]


def test_the_schema_is_one():
    jsonschema.Draft7Validator.check_schema(SCHEMA)


def test_the_templates_and_the_scenarios_that_ship_are_among_those_tried():
    assert {"scenario.toml", "loads.toml", "truck.toml", "train.toml", "paved_road.toml"} <= set(IN_ORDER)
    assert len(FILES) > 10


def test_a_spectrum_by_its_class_may_be_one_by_its_roughness():
    assert wrong(CAR + '[roughness]\nkind = "sncf_track"\nroughness = 1e-7') == []


@pytest.mark.parametrize("name", IN_ORDER)
def test_what_is_in_order_passes(name):
    assert wrong(IN_ORDER[name]) == []


@pytest.mark.parametrize(
    "text",
    [
        edited(mass="711.9\nmas = 1.0"),
        edited(time_step="0.001\ntimestep = 0.01"),
        edited(seed="0\n[extra]\nspeed = 1.0\n[more]"),
        edited(kind='"strange"'),
        edited(kind="3"),
        edited(body_mass=None),
        edited(speed=None),
        edited(body_mass='"heavy"'),
        edited(body_mass="true"),
        edited(body_mass="[1.0, 2.0]"),
        edited(axles="[1.0]"),
        edited(axles="[1.0, 2.0, 3.0]"),
        edited(axles="1.0"),
        edited(seed="1.5"),
        edited(band='["a", "b"]'),
        edited(road_class="1"),
        template("scenario").split("[run]")[0],
        template("scenario").split("[roughness]")[0] + "[run]\nspeed = 1.0\nduration = 1.0\n",
        template("scenario").replace("[guideway.foundation]", "[guideway.fundation]"),
        template("scenario").replace('kind = "iso_road"', ""),
        LOADS + "[vehicle]\nkind = 'catalogue'\nname = 'half_truck'\n",
        LOADS + "blend = 5.0\n",
        LOADS.replace("positions", "position"),
        LOADS.replace('kind = "constant"', 'kind = "harmonics"'),
        LOADS[: LOADS.index("[[loads.force]]")] + "force = []\n" + LOADS[LOADS.index("[run]") :],
        TEXTS["truck"].replace("mass = 700.0", 'mass = "700"') + GROUND,
        TEXTS["truck"].replace('kind = "walking_beam"', 'kind = "beam"') + GROUND,
        TEXTS["seated"].replace("bounce = 1.0", 'bounce = "1"') + GROUND,
        TEXTS["assemble"].replace('under = ["front", ""]', "under = [1, 2]") + GROUND,
        TEXTS["train"].replace("count = 3", "count = 3.5") + GROUND,
        TEXTS["convoy"].replace("gaps = 10.0", 'gaps = ["a"]') + GROUND,
        SAMPLED.replace("file =", "fil ="),
        FINITE.replace("ends = ", "ents = "),
        FINITE.replace("across = 3", "across = 3.5"),
        CAR + '[roughness]\nkind = "iso_road"\nroad_class = "A"\ncoherence = 0.5',
        CAR + '[roughness]\nkind = "iso_road"\nroad_class = "A"\nroughness = 1e-6',
        CAR + '[roughness]\nkind = "fra_track"\nseed = 1',
        CAR + '[roughness]\nkind = "laplace_road"\nkurtosis = 6.0\nsegment = 5.0\nspectrum = {kind = "iso_road"}',
        CAR + "[roughness]\n" + PARTS.replace("edge = 0.1", "edges = 0.1"),
    ],
)
def test_what_is_wrong_is_refused_by_schema_and_reader(text):
    assert wrong(text)
    with pytest.raises(mf.ScenarioError):
        parse_scenario(text)


def other_values(table, new):
    """Give every value of a table, and every one within it, in turn other values: where it stands, the table."""
    for place, value in list(table.items() if isinstance(table, dict) else enumerate(table)):
        within = other_values(value, new) if isinstance(value, (dict, list)) else ()
        for where, other in [*(((), one) for one in new(value)), *within]:
            changed = table.copy()
            changed[place] = other
            yield (place, *where), changed


def faults_of(tables):
    """Ask the reader what is wrong with tables."""
    builder = _Builder(ROOT / "examples")
    builder.scenario(tables, "case", "")
    return {fault.name: fault.message for fault in builder.faults}


def in_other_words(new):
    """All of `IN_ORDER` that needs no other file, every table once, with one value after another replaced."""
    tried = []
    for text in IN_ORDER.values():
        tables = tomllib.loads(text)
        if faults_of(tables):
            continue
        for where, changed in other_values({key: one for key, one in tables.items() if one not in tried}, new):
            yield ".".join(map(str, where)), tables | changed
        tried += tables.values()


def test_a_value_of_another_type_is_a_fault_and_never_a_defect():
    """Also where a shape goes on to calculate with what it has refused."""
    refused = [
        faults_of(tables) for _, tables in in_other_words(lambda value: [1.0, "x", True, [], {}, [value] * 2])
    ]
    assert len(refused) > 1000
    assert sum(not faults for faults in refused) < len(refused) / 10
    bridge = IN_ORDER["bridge.toml"]
    assert faults_of(tomllib.loads(bridge.replace('ends = "pinned"', "ends = 1.0"))) == {
        "guideway.ends": "must be a text or [a text, a text], got 1.0"
    }
    slabs = tomllib.loads(IN_ORDER["roughness faulted_slabs"])
    slabs["roughness"]["spacing"] = "5"
    assert faults_of(slabs) == {"roughness.spacing": "must be a positive number [m], got '5'"}


def test_every_kind_and_key_is_described():
    """Found where a table of it is allowed: name, type, default, and its unit in the words."""
    for family in TABLES.values():
        part = SCHEMA["definitions"][family.name]
        kinds = {one["title"]: one for one in part.get("oneOf", [part])}
        assert list(kinds) == list(family.kinds)
        for kind in family.kinds.values():
            found = kinds[kind.name]
            assert found["properties"].keys() - {"kind"} == {key.name for key in kind.keys}
            assert ("kind" in found["required"]) == (len(kinds) > 1 and kind.name != family.default)
    spring = SCHEMA["definitions"]["foundation"]["oneOf"][0]["properties"]
    assert spring["stiffness"] == {"description": "Stiffness per metre of track [N/m²].", "type": "number"}
    assert spring["damping"]["default"] == 0.0
    assert spring["damping"]["description"].endswith("[N s/m²]. Default: 0.0.")


def test_a_rigid_contact_is_no_mistake_where_json_has_no_infinity():
    """Editors make null of `inf`, where the words say that it may stand."""
    case = tomllib.loads(TEXTS["assemble"] + GROUND)
    assert case["vehicle"]["contacts"][1]["stiffness"] == float("inf")
    case["vehicle"]["contacts"][1]["stiffness"] = None
    assert CHECK.is_valid(case)
    case["vehicle"]["contacts"][1]["position"] = None
    assert not CHECK.is_valid(case)
    contact = SCHEMA["definitions"]["vehicle"]["oneOf"]
    (bogie,) = [kind["properties"] for kind in contact if kind["title"] == "bogie"]
    assert bogie["contact_stiffness"]["description"].endswith("follow the rails. Default: inf.")


def test_infinity_may_stand_where_the_reader_takes_it():
    """Tyres of cars and trucks, one and both; stiffnesses of contacts, but no damping."""
    taken = set()
    for where, tables in in_other_words(lambda value: [math.inf] if isinstance(value, float) else []):
        as_json = json.loads(json.dumps(tables).replace("Infinity", "null"))
        # What damps beside the infinite spring is another matter.
        faults = [message for message in faults_of(tables).values() if "at a rigid contact" not in message]
        assert CHECK.is_valid(as_json) == (not faults), where
        taken |= set() if faults else {where}
    assert {"vehicle.tyre_stiffness", "vehicle.tyre_stiffness.1", "vehicle.contact_stiffness"} <= taken


def test_the_command_writes_the_schema_that_the_templates_name(tmp_path, capsys, monkeypatch):
    assert main(["schema"]) == 0
    assert capsys.readouterr().out == schema_as_json()
    monkeypatch.chdir(tmp_path)
    for name in ("scenario", "loads"):
        first, *lines = template(name).splitlines()
        (file,) = re.findall(r"#:schema \./(\S+)", first)
        assert any(f"movingfrf schema {file} " in line for line in lines)
        for _ in range(2):  # what is there of an earlier version is replaced
            assert main(["schema", file]) == 0
        assert (tmp_path / file).read_text(encoding="utf-8") == schema_as_json()
    (tmp_path / "case.toml").write_text(template("scenario"), encoding="utf-8")
    capsys.readouterr()
    assert main(["schema", "case.toml"]) == 2
    assert "case.toml exists and is no schema of scenarios; choose another name" in capsys.readouterr().err
    assert (tmp_path / "case.toml").read_text(encoding="utf-8") == template("scenario")


def test_the_page_names_every_kind():
    page = (ROOT / "docs" / "scenarios.md").read_text(encoding="utf-8")
    for family in TABLES.values():
        for kind in family.kinds.values():
            assert len(family.kinds) == 1 or f"`{kind.name}`" in page, (family.name, kind.name)


def test_tables_of_a_scenario_are_those_of_the_reader():
    with_vehicle, with_loads = SCHEMA["oneOf"]
    assert list(with_vehicle["properties"]) == list(DRIVE)
    assert with_loads["properties"].keys() == {"guideway", "loads", "run"}

"""`movingfrf kinds`: what the tables of a scenario can be, on a terminal."""

import re
from itertools import takewhile

import pytest

from movingfrf.commands.main import main
from movingfrf.scenarios.kinds import TABLES
from movingfrf.scenarios.template import template
from tests.test_words import on_terminal

TABLES_BY_NAME = {family.name: family for family in TABLES.values()}


def told(capsys, *arguments):
    assert main(["kinds", *arguments]) == 0
    return capsys.readouterr().out


def test_all_of_them(capsys):
    text = told(capsys)
    for family in TABLES.values():
        assert family.name in text
        assert all(kind in text for kind in family.kinds)


@pytest.mark.parametrize("name", sorted({kind for family in TABLES.values() for kind in family.kinds}))
def test_every_kind_has_words_for_every_key(capsys, name):
    """With a unit wherever the docstring has one; nothing is printed that the reader would not take."""
    kind = next(family.kinds[name] for family in TABLES.values() if name in family.kinds)
    # Of a table that has a kind of its own name, that kind among the others.
    block = told(capsys, name).partition(f"{kind.name}\n")[2]
    lines = list(takewhile(lambda line: line.startswith(" "), block.splitlines()))
    for key in kind.keys:
        (line,) = [line for line in lines if line.split()[0].rstrip(":") == key.name]
        assert key.words
        assert key.words in line
        assert ("=" in line.split(":")[0]) == (not key.needed and key.default is not None)


def test_a_table_shows_all_its_kinds(capsys):
    text = told(capsys, "foundation")
    assert all(f"{kind}\n" in text for kind in TABLES_BY_NAME["foundation"].kinds)
    assert "Pasternak's G_p [N]" in text


@pytest.mark.parametrize("name", ["scenario", "loads"])
def test_templates_say_how_to_list_kinds_and_list_none_themselves(name):
    """Where a table has several kinds, and by the name that the command knows."""
    tables = re.findall(r"^\[+(?:\w+\.)?(\w+)\]+ *(?:# (.*))?$", template(name), re.MULTILINE)
    several = {table for table, _ in tables if table in TABLES_BY_NAME and len(TABLES_BY_NAME[table].kinds) > 1}
    assert {"guideway", "beam", "foundation"} < several
    assert {table for table, words in tables if words == f"kinds: movingfrf kinds {table}"} == several
    assert "kinds:" not in re.sub("kinds: movingfrf kinds", "", template(name))


def test_another_name_is_refused(capsys):
    assert main(["kinds", "half_kar"]) == 2
    assert "no table and no kind 'half_kar' (did you mean 'half_car'?)" in capsys.readouterr().err


def wordless(key):
    """Leave the unit out of what is said of a key."""
    return re.sub(r"\s*\[[^\]]*\]", "", key.words)


@pytest.mark.parametrize("family", TABLES.values(), ids=lambda family: family.name)
def test_no_two_keys_of_a_kind_have_the_same_words(family):
    """Read alone, "body_mass: sprung and unsprung mass" asks for the sum."""
    for kind in family.kinds.values():
        words = [wordless(key) for key in kind.keys]
        assert len(set(words)) == len(words), [word for word in words if words.count(word) > 1]


def test_what_a_file_holds_is_said_and_a_file_has_no_unit(capsys):
    text = told(capsys, "vehicle_file")
    assert "without the dashpots and springs of the contacts" in text
    assert TABLES_BY_NAME["vehicle"].kinds["vehicle_file"].keys[0].unit == ""


def test_keys_stand_out_where_their_words_are_wrapped(tmp_path):
    lines = on_terminal(["kinds", "finite_track"], tmp_path)
    begun = [line.split()[0].rstrip(":") for line in lines if re.match(r" {2}\S+( = .*| \(.*)?:", line)]
    assert begun == [key.name for key in TABLES_BY_NAME["guideway"].kinds["finite_track"].keys]
    assert any(line.startswith("    ") for line in lines)
    assert all(len(line) <= 80 for line in lines)

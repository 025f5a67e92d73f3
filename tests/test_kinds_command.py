"""`movingfrf kinds`: what the tables of a scenario can be, on a terminal."""

import re
from itertools import takewhile

import pytest

from movingfrf.commands.main import main
from movingfrf.scenarios.kinds import TABLES
from movingfrf.scenarios.template import template

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

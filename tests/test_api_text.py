"""The text of the public interface: every argument documented with its unit, unknown keywords rejected."""

from __future__ import annotations

import inspect
import json
import re
import subprocess
import sys

import pytest

import movingfrf as mf
from movingfrf._basics.documented import documented

PUBLIC = mf.__all__

# Public constructors that are not names of their own, and what a contract asks for in place of the contract.
CALLABLES = {name: getattr(mf, name) for name in PUBLIC if name != "Guideway"} | {
    "IsoRoad.of_class": mf.IsoRoad.of_class,
    "Guideway.moving_frf": mf.Guideway.moving_frf,
}

NUMERIC = re.compile(r"\b(float|array|ndarray)")
UNIT = re.compile(r"\[[^\]]+\]")
# Words that say that a number has no unit.
DIMENSIONLESS = re.compile(r"\b(exponent|ratio|factor|dimensionless|number of|share|motion of each degree)\b", re.I)


def arguments(function) -> list[str]:
    if inspect.isclass(function) and issubclass(function, BaseException) and "__init__" not in vars(function):
        return []
    return [name for name in inspect.signature(function).parameters if name != "self"]


@pytest.mark.parametrize("name", CALLABLES)
def test_every_argument_is_documented_with_its_unit(name):
    function = CALLABLES[name]
    assert inspect.getdoc(function), "no docstring"
    said = documented(function)
    assert set(arguments(function)) == set(said)
    for argument, (kind, text) in said.items():
        assert kind, f"{argument} has no type"
        assert text.strip(), f"{argument} has no text"
        if NUMERIC.search(kind):
            assert UNIT.search(text) or DIMENSIONLESS.search(text), f"{argument} states no unit: {text}"


def test_the_reader_of_docstrings_sees_what_is_missing():
    def example(one, two, three):
        """Do something.

        Parameters
        ----------
        one, two : float
            Lengths [m].
        three : float
            A thing.

        Returns
        -------
        float
            Nothing.
        """

    found = documented(example)
    assert list(found) == ["one", "two", "three"]
    assert UNIT.search(found["two"][1])
    assert not UNIT.search(found["three"][1])
    assert not DIMENSIONLESS.search(found["three"][1])


@pytest.mark.parametrize("name", CALLABLES)
def test_unknown_keywords_are_rejected(name):
    """Also by the constructors of values; a misspelt keyword never passes in silence."""
    # These hand their keywords on, so their own argument must be there.
    own = {"prepared": {"profile": mf.Profile(range(4), range(4))}, "read_pieces": {"file": "road.csv"}}
    given = own.get(name, {})
    with pytest.raises(TypeError, match=r"unexpected keyword argument|takes no (keyword )?arguments"):
        CALLABLES[name](**given, stifness=1.0)


def test_what_is_public():
    assert sorted(PUBLIC) == list(PUBLIC)
    assert set(PUBLIC) <= set(dir(mf))
    with pytest.raises(AttributeError, match="has no attribute 'nonsense'"):
        mf.nonsense  # noqa: B018


# One fresh interpreter for all questions about importing.
PROBE = """
import sys, json
import movingfrf
before = set(sys.modules)
loaded = [name for name in movingfrf.__all__ if name in vars(movingfrf)]
heavy = [name for name in ("numpy", "scipy", "xarray", "matplotlib") if name in before]
for name in movingfrf.__all__:
    getattr(movingfrf, name)
later = [name for name in ("scipy.interpolate", "xarray", "matplotlib") if name in sys.modules]
missing = [name for name in movingfrf.__all__ if name not in vars(movingfrf)]
print(json.dumps([loaded, heavy, later, missing]))
"""


def test_importing_costs_next_to_nothing():
    """Names load on first use; scipy.interpolate, xarray and matplotlib only where they are needed."""
    output = subprocess.run([sys.executable, "-c", PROBE], capture_output=True, text=True, check=True).stdout
    loaded, heavy, later, missing = json.loads(output)
    assert loaded == []
    assert heavy == []
    assert missing == []
    assert later == []

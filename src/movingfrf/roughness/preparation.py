"""What is done to a measured profile before it is used: each step makes a new profile and says what it did."""

from __future__ import annotations

import inspect
from dataclasses import field, make_dataclass
from pathlib import Path
from typing import Any

from movingfrf._basics.checks import ParameterError, checking
from movingfrf._basics.documented import documented
from movingfrf.roughness.files import ReadProfile, read_pieces, read_profile
from movingfrf.roughness.profile import Profile, require_profile
from movingfrf.roughness.steps import (
    cropped,
    detrended,
    high_passed,
    low_passed,
    mirrored,
    repaired,
    repeated,
    resampled,
    selected,
)
from movingfrf.roughness.steps.base import Step

# All steps, in the order in which they are done.
STEPS = (
    selected.STEP,
    cropped.STEP,
    repaired.STEP,
    detrended.STEP,
    high_passed.STEP,
    low_passed.STEP,
    resampled.STEP,
    repeated.STEP,
    mirrored.STEP,
)


def _fields(step: Step) -> list[tuple[str, Any, Any]]:
    """Name, type and default of a step's keys: each the argument that it fills, or None."""
    arguments = inspect.signature(step.do, eval_str=True).parameters
    return [(key, arguments[name].annotation | None, field(default=None)) for key, name in step.keys.items()]


def _in_words() -> str:
    """Write the keys of all steps as a docstring has them."""
    return "".join(
        f"    {key} : {said.type.removesuffix(', optional')}, optional\n        {said.words}\n"
        for step in STEPS
        for key, name in step.keys.items()
        if (said := documented(step.do).get(name))
    )


# What is to be done to a profile: a field for every key of every step, None where it is not asked for. These fields
# are the keys of a scenario, the options of a command and the arguments of `prepared`.
Preparation = make_dataclass(
    "Preparation",
    [each for step in STEPS for each in _fields(step)],
    namespace={
        "__module__": __name__,
        "__doc__": f"What is to be done.\n\n    Parameters\n    ----------\n{_in_words()}",
    },
    frozen=True,
    kw_only=True,
)


def prepared(profile: Profile, **keys: Any) -> Profile:
    """Do several things to a profile, in the order of the arguments; what is None is not done.

    Parameters
    ----------
    profile : Profile
        The road.
    KEYS

    Returns
    -------
    Profile
        Its `steps` list what was done.

    Raises
    ------
    ValueError
        If a step does, or if the profile is to be repeated and mirrored as well.
    """
    require_profile(profile)
    asked = {key: value for key, value in vars(Preparation(**keys)).items() if value is not None}
    with checking() as check:
        for step in STEPS:
            if step.without in asked and (both := step.keys.keys() & asked.keys()):
                check.refuse(min(both), f"and {step.without} exclude each other: one of them is enough")
    for step in STEPS:
        arguments = {name: asked[key] for key, name in step.keys.items() if key in asked}
        if arguments:
            profile = _done(step, profile, arguments)
    return profile


# What reads signatures and docstrings sees every key by its name.
prepared.__doc__ = (prepared.__doc__ or "").replace("    KEYS\n", f"{_in_words()}\n")
prepared.__signature__ = inspect.Signature(  # type: ignore[attr-defined]
    [
        next(iter(inspect.signature(prepared).parameters.values())),
        *inspect.signature(Preparation).parameters.values(),
    ]
)


def read_prepared(file: Path, **keys: Any) -> ReadProfile:
    """Read a profile from a file and prepare it, as keys of `read_profile` and of `Preparation` ask for it.

    What both take is done in reading, before anything is checked.
    """
    steps = _taken_out(keys)
    found, understood = read_profile(file, **keys)
    return ReadProfile(prepared(found, **steps), understood)


def read_prepared_pieces(file: Path, **keys: Any) -> list[ReadProfile]:
    """Read the pieces of a profile between its gaps, and prepare each."""
    steps = _taken_out(keys)
    return [ReadProfile(prepared(found, **steps), understood) for found, understood in read_pieces(file, **keys)]


def _taken_out(keys: dict[str, Any]) -> dict[str, Any]:
    """Take the keys of steps out of those of reading, and return them."""
    reading = inspect.signature(read_profile).parameters
    return {key: keys.pop(key) for step in STEPS for key in step.keys if key in keys and key not in reading}


def _done(step: Step, profile: Profile, arguments: dict[str, Any]) -> Profile:
    """Do a step; a fault bears the name of the key that filled the argument."""
    try:
        return step.do(profile, **arguments)
    except ParameterError as error:
        key_of = {name: key for key, name in step.keys.items()}
        faults = [fault._replace(name=key_of.get(fault.name, fault.name)) for fault in error.faults]
        raise ParameterError(faults) from None

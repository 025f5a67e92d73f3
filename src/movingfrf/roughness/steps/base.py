"""What every step has in common: how it is asked for, the profile that it makes, the numbers of filters."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray, require_memory
from movingfrf._basics.checks import checking
from movingfrf.roughness.profile import SLACK, Profile


class Step(NamedTuple):
    """A step of a preparation: what does it, and what asks for it.

    Type, unit and words of a key are those of the argument that it fills, in the function's docstring.
    """

    do: Callable[..., Profile]  # from a profile and arguments to a new profile
    keys: Mapping[str, str]  # key of a scenario, a command and `prepared` → argument that it fills
    without: str = ""  # key of another step that excludes this one


@dataclass(frozen=True, slots=True, kw_only=True)
class Filter:
    """What tunes the filters, Butterworth's, which run both ways; in brackets, between what each number is safe.

    The first three are documented: of a wave as long as the filter's a half is left, of one of another length what
    the order says.
    """

    # Before samples are taken further apart, waves shorter than this many new steps are taken out: more than 2.485,
    # or 3 % are left of waves of two steps.
    shortest_wave: float = 2.5
    sharp: int = 8  # order of the filter that does so
    gentle: int = 2  # order of the one that takes out long waves
    settling: float = 2.0  # wavelengths that it goes on past either end, the profile turned about its end [1 to 8]


FILTER = Filter()


def changed(profile: Profile, sentence: str, **fields: object) -> Profile:
    """Make a profile with other fields, which says in a sentence what was done."""
    return replace(profile, **fields, steps=(*profile.steps, sentence))  # type: ignore[arg-type]


def like(profile: Profile, columns: FloatArray) -> FloatArray:
    """Elevations in the shape that the profile's own have: without columns where it has none."""
    return columns[:, 0] if profile.same_across else columns


def longer(length: float, own: float, step: float, paths: int) -> int:
    """Tell how many stations a longer road has."""
    with checking() as check:
        if check.positive("length", length, "m") < own * (1 - SLACK):
            check.refuse("length", f"must be at least that of the profile, {own:g} m, got {length:g} m")
    require_room(length, step, paths)
    return int(np.ceil(length / step - SLACK * length / step)) + 1


def require_room(length: float, step: float, paths: int) -> None:
    """Refuse a profile that memory does not hold."""
    needed = 64 * length / step * paths  # bytes that a new profile takes at its peak
    require_memory(needed, f"a profile of {length:g} m in steps of {step:g} m")


def extended(
    profile: Profile, step: float, count: int, place: np.ndarray, columns: FloatArray, sentence: str
) -> Profile:
    """Make a longer profile of stations of columns, each named by its place."""
    distance = profile.stations[0] + step * np.arange(count)
    return changed(profile, sentence, distance=distance, elevation=like(profile, columns[place]))

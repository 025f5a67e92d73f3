"""What every step has in common: how it is asked for, the profile that it makes, the numbers of filters."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Literal, NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray, require_memory
from movingfrf._basics.checks import checking
from movingfrf._basics.wording import told_apart
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
    gentle: int = 2  # order of those that take out waves because they were asked to
    settling: float = 2.0  # wavelengths that it goes on past either end, the profile turned about its end [1 to 8]


FILTER = Filter()


def changed(profile: Profile, sentence: str, **fields: object) -> Profile:
    """Make a profile with other fields, which says in a sentence what was done."""
    return replace(profile, **fields, steps=(*profile.steps, sentence))  # type: ignore[arg-type]


def like(profile: Profile, columns: FloatArray) -> FloatArray:
    """Elevations in the shape that the profile's own have: without columns where it has none."""
    return columns[:, 0] if profile.same_across else columns


def longer(length: float, own: float, step: float, paths: int) -> tuple[float, int]:
    """Tell the length [m] of a longer road, checked, and how many stations it has."""
    with checking() as check:
        if (length := check.positive("length", length, "m")) < own * (1 - SLACK):
            least, got = told_apart(own, length)
            check.refuse("length", f"must be at least that of the profile, {least} m, got {got} m")
    require_room(length, step, paths)
    return length, int(np.ceil(length / step - SLACK * length / step)) + 1


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


def filtered(
    columns: FloatArray, step: float, *, wavelength: float, kind: Literal["highpass", "lowpass"], order: int
) -> FloatArray:
    """Take out waves longer or shorter than a length by a Butterworth filter, both ways: none is shifted."""
    from scipy.signal import butter, sosfiltfilt

    past = min(len(columns) - 1, int(np.ceil(FILTER.settling * wavelength / step)))
    sections = butter(order, 1 / wavelength, kind, fs=1 / step, output="sos")
    kept: FloatArray = sosfiltfilt(sections, columns, axis=0, padlen=past)
    return kept


def without_waves(profile: Profile, which: Literal["longer", "shorter"], wavelength: float) -> Profile:
    """Take waves longer or shorter than a length [m] out of a profile by the gentle filter, and say so."""
    with checking() as check:
        wavelength = check.positive("wavelength", wavelength, "m")
    step = profile.require_even("a filter")
    length = profile.stations[-1] - profile.stations[0]
    with checking() as check:
        if not 4 * step * (1 - SLACK) <= wavelength <= length * (1 + SLACK):
            least, most, got = told_apart(4 * step, length, wavelength)
            check.refuse(
                "wavelength",
                f"must lie between four steps and the length of the profile, {least} and {most} m, got {got} m",
            )
    kind: Literal["highpass", "lowpass"] = "highpass" if which == "longer" else "lowpass"
    kept = filtered(profile.columns, step, wavelength=wavelength, kind=kind, order=FILTER.gentle)
    how = f"Butterworth of order {FILTER.gentle}, both ways, half left there"
    done = f"took out waves {which} than {wavelength:g} m ({how})"
    return changed(profile, done, elevation=like(profile, kept))

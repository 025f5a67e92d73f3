"""What a scenario's [roughness] can be: a spectrum realised, shapes on a level road, and combinations of these.

Each kind is made from what Python offers, so that its keys are that function's keyword arguments; the length and
the start of the road follow from the interval that the journey covers.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from movingfrf._basics.checks import checking
from movingfrf.roughness import combination, irregularities
from movingfrf.roughness.profile import Profile
from movingfrf.roughness.realisation import realise, realise_laplace
from movingfrf.roughness.road import Road, in_common
from movingfrf.roughness.spectra.iso import IsoRoad
from movingfrf.roughness.spectra.rail import ChineseBallastlessTrack, FraTrack, FrybaTrack, GermanTrack, SncfTrack
from movingfrf.roughness.spectra.spectrum import Spectrum
from movingfrf.roughness.spectra.tabulated import TabulatedSpectrum, ThirdOctaveSpectrum, iso3095_limit
from movingfrf.roughness.spectra.two_slope import TwoSlopeRoad
from movingfrf.scenarios.kind import Key, Kind, chosen, keys_of


def by_class(spectrum: Any) -> Kind:
    """Make a spectrum either from its class or from its roughness."""
    (of_class, *others), own = keys_of(spectrum.of_class), keys_of(spectrum)
    label, left_to_it = of_class.name, {key.name for key in others if key.default is None}

    def make(*, roughness: float | None = None, **given: Any) -> Spectrum:
        named = given.pop(label, None)
        with checking() as check:
            if (roughness is None) == (named is None):
                check.refuse(label, "or roughness is needed: a class or a number, not both")
        return spectrum.of_class(named, **given) if roughness is None else spectrum(roughness=roughness, **given)

    def either(key: Key) -> Key:
        if key.name in left_to_it:
            words = f"{key.words} By default that of the class, with roughness {list(key.default)}."
            return replace(key, default=None, words=words)
        return replace(key, default=None) if key.name in ("roughness", label) else key

    return replace(
        Kind.of(spectrum), make=make, keys=tuple(map(either, (of_class, *own))), either=(label, "roughness")
    )


REALISING = keys_of(realise, without=["spectrum", "length", "start"])


def realised(spectrum: Kind) -> Kind:
    """Realise a spectrum over the interval: its own keys, then those of a realisation."""

    def make(*, interval: tuple[float, float], **given: Any) -> Road:
        first, last = interval
        made = spectrum.make(**chosen(given, spectrum.keys))
        how = {key.name: given.get(key.name, key.default) for key in REALISING}
        profile = realise(made, length=last - first, start=first, **how)
        common = in_common(made, how["seed"], how["across"], how["coherence"])
        return Road(profile, profile.source, made, common)

    return replace(spectrum, make=make, keys=(*spectrum.keys, *REALISING))


def shaped(shape: Callable[..., Profile], *, name: str | None = None) -> Kind:
    """Make a shape, or a road that does not carry its spectrum, over the interval."""

    def make(*, interval: tuple[float, float], **given: Any) -> Road:
        first, last = interval
        profile = shape(length=last - first, start=first, **given)
        return Road(profile, profile.source)

    return replace(Kind.of(shape, name=name, without=["length", "start"]), make=make)


def superposed(*, interval: tuple[float, float], parts: Sequence[Road]) -> Road:
    """Roads added up.

    Parameters
    ----------
    interval : tuple of float
        First and last distance that they cover [m].
    parts : sequence of Road
        The roads.

    Returns
    -------
    Road
        Their sum.
    """
    profile = combination.superposed(*[part.profile for part in parts])
    return Road(profile, "; ".join(part.description for part in parts))


def side_by_side(*, interval: tuple[float, float], parts: Sequence[Road]) -> Road:
    """Roads side by side, each a path of its own.

    Parameters
    ----------
    interval : tuple of float
        First and last distance that they cover [m].
    parts : sequence of Road
        The roads, path by path.

    Returns
    -------
    Road
        With as many paths as its parts have together.
    """
    profile = combination.side_by_side(*[part.profile for part in parts])
    return Road(profile, "; ".join(part.description for part in parts))


# Kinds of spectra.
SPECTRA = (
    by_class(IsoRoad),
    by_class(TwoSlopeRoad),
    by_class(FraTrack),
    by_class(FrybaTrack),
    by_class(GermanTrack),
    by_class(SncfTrack),
    Kind.of(ChineseBallastlessTrack),
    Kind.of(TabulatedSpectrum),
    Kind.of(ThirdOctaveSpectrum),
    Kind.of(iso3095_limit),
)

# Kinds of roads. A Laplace road does not carry its spectrum: random vibration in closed form would take it for a
# Gaussian one.
ROADS = (
    *map(realised, SPECTRA),
    shaped(realise_laplace, name="laplace_road"),
    shaped(irregularities.harmonic),
    shaped(irregularities.bump),
    shaped(irregularities.pothole),
    shaped(irregularities.faulted_slabs),
    shaped(irregularities.dipped_joints),
    shaped(irregularities.dipped_weld),
    shaped(irregularities.wheel_flat),
    shaped(irregularities.polygon),
    Kind.of(superposed, without=["interval"]),
    Kind.of(side_by_side, without=["interval"]),
)

"""What a scenario's [roughness] can be: a spectrum realised, shapes on a level road, and combinations of these.

Each kind is made from what Python offers, so that its keys are that function's keyword arguments; the length and
the start of the road follow from the journey.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from movingfrf._basics.checks import checking
from movingfrf.roughness import combination, irregularities
from movingfrf.roughness.profile import Profile
from movingfrf.roughness.realisation import realise, realise_laplace
from movingfrf.roughness.road import Road, in_common
from movingfrf.roughness.spectra.coherence import Coherence
from movingfrf.roughness.spectra.iso import IsoRoad
from movingfrf.roughness.spectra.rail import ChineseBallastlessTrack, FraTrack, FrybaTrack, GermanTrack, SncfTrack
from movingfrf.roughness.spectra.spectrum import Spectrum
from movingfrf.roughness.spectra.tabulated import TabulatedSpectrum, ThirdOctaveSpectrum, iso3095_limit
from movingfrf.roughness.spectra.two_slope import TwoSlopeRoad


def _with_signature(function: Callable[..., Any], parameters: Iterable[inspect.Parameter]) -> Callable[..., Any]:
    """Give a function that passes arguments on the signature of what it passes them to."""
    unique = {parameter.name: parameter for parameter in parameters}
    function.__signature__ = inspect.Signature(list(unique.values()))  # type: ignore[attr-defined]
    return function


def _parameters(function: Callable[..., Any], *without: str) -> list[inspect.Parameter]:
    return [
        parameter.replace(kind=inspect.Parameter.KEYWORD_ONLY)
        for name, parameter in inspect.signature(function).parameters.items()
        if name not in without
    ]


def by_class(spectrum: Any) -> Callable[..., Spectrum]:
    """Make a spectrum either from its class or from its roughness."""
    name = next(iter(inspect.signature(spectrum.of_class).parameters))

    def made(*, roughness: float | None = None, **given: Any) -> Spectrum:
        label = given.pop(name, None)
        with checking() as check:
            if (roughness is None) == (label is None):
                check.refuse(name, "or roughness is needed: a class or a number, not both")
        return spectrum.of_class(label, **given) if roughness is None else spectrum(roughness=roughness, **given)

    optional = [
        parameter.replace(default=None) if parameter.name in ("roughness", name) else parameter
        for parameter in [*_parameters(spectrum), *_parameters(spectrum.of_class)]
    ]
    return _with_signature(made, optional)


def realised(make_spectrum: Callable[..., Spectrum]) -> Callable[..., Road]:
    """Realise a spectrum over the interval that the journey needs."""

    def road(
        *,
        interval: tuple[float, float],
        step: float = 0.05,
        seed: int | Sequence[int] = 0,
        across: Sequence[float] | None = None,
        coherence: Coherence | None = None,
        **given: Any,
    ) -> Road:
        first, last = interval
        spectrum = make_spectrum(**given)
        profile = realise(
            spectrum, length=last - first, step=step, seed=seed, start=first, across=across, coherence=coherence
        )
        return Road(profile, profile.source, spectrum, in_common(spectrum, seed, across, coherence))

    own = _parameters(road, "given")
    return _with_signature(road, [own[0], *_parameters(make_spectrum), *own[1:]])


def laplace_road(
    *,
    interval: tuple[float, float],
    spectrum: Spectrum,
    kurtosis: float,
    segment: float,
    step: float = 0.05,
    seed: int | Sequence[int] = 0,
    across: Sequence[float] | None = None,
    coherence: Coherence | None = None,
) -> Road:
    """Realise a spectrum as a road whose roughness varies along the way.

    The road does not carry its spectrum: random vibration in closed form would take it for a Gaussian one.
    """
    first, last = interval
    profile = realise_laplace(
        spectrum,
        kurtosis=kurtosis,
        segment=segment,
        length=last - first,
        step=step,
        seed=seed,
        start=first,
        across=across,
        coherence=coherence,
    )
    return Road(profile, profile.source)


def shaped(shape: Callable[..., Profile]) -> Callable[..., Road]:
    """Make a shape over the interval that the journey needs."""

    def road(*, interval: tuple[float, float], **given: Any) -> Road:
        first, last = interval
        profile = shape(length=last - first, start=first, **given)
        return Road(profile, profile.source)

    return _with_signature(road, [*_parameters(road, "given"), *_parameters(shape, "length", "start")])


def roads_superposed(*, interval: tuple[float, float], parts: Sequence[Road]) -> Road:
    """Add roads up."""
    profile = combination.superposed(*[part.profile for part in parts])
    return Road(profile, "; ".join(part.description for part in parts))


def roads_side_by_side(*, interval: tuple[float, float], parts: Sequence[Road]) -> Road:
    """Set roads side by side, each a path of its own."""
    profile = combination.side_by_side(*[part.profile for part in parts])
    return Road(profile, "; ".join(part.description for part in parts))


# Kind of spectrum → what makes it.
SPECTRA: dict[str, Callable[..., Spectrum]] = {
    "iso_road": by_class(IsoRoad),
    "two_slope_road": by_class(TwoSlopeRoad),
    "fra_track": by_class(FraTrack),
    "fryba_track": by_class(FrybaTrack),
    "german_track": by_class(GermanTrack),
    "sncf_track": by_class(SncfTrack),
    "chinese_ballastless_track": ChineseBallastlessTrack,
    "tabulated_spectrum": TabulatedSpectrum,
    "third_octave_spectrum": ThirdOctaveSpectrum,
    "iso3095_limit": iso3095_limit,
}

SHAPES = (
    irregularities.harmonic,
    irregularities.bump,
    irregularities.pothole,
    irregularities.faulted_slabs,
    irregularities.dipped_joints,
    irregularities.dipped_weld,
    irregularities.wheel_flat,
    irregularities.polygon,
)

# Kind of road → what makes it.
ROADS: dict[str, Callable[..., Road]] = {
    **{name: realised(spectrum) for name, spectrum in SPECTRA.items()},
    "laplace_road": laplace_road,
    **{shape.__name__: shaped(shape) for shape in SHAPES},
    "superposed": roads_superposed,
    "side_by_side": roads_side_by_side,
}

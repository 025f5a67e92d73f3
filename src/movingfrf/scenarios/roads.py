"""What a scenario's [roughness] can be: a spectrum realised, shapes on a level road, and combinations of these.

Each kind is made from what Python offers, so that its keys are that function's keyword arguments; where the road
begins and ends follows from the way that the journey takes, unless a realised road says it itself.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

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
from movingfrf.vehicles.journey import Journey
from movingfrf.vehicles.vehicle import Vehicle


class Way(NamedTuple):
    """Where a journey needs a road.

    Parameters
    ----------
    first, last : float
        First and last distance that a contact meets [m]: between them lies the length to which a realised road
        belongs.
    covering : tuple of float
        First and last distance that the road covers [m]: what contacts touch ahead and behind, and more beyond the
        end.
    """

    first: float
    last: float
    covering: tuple[float, float]

    @classmethod
    def of(cls, journey: Journey, vehicle: Vehicle) -> Way:
        """Find the way of a vehicle.

        Parameters
        ----------
        journey : Journey
            How it travels.
        vehicle : Vehicle
            The vehicle.

        Returns
        -------
        Way
            From the hindmost contact at the start to the foremost at the end.
        """
        begin, end = journey.interval(vehicle)
        reach = 0.5 * max((contact.footprint + contact.cams for contact in vehicle.contacts), default=0.0)
        # What comes after the end of a record matters to it as well, and would have to be guessed [5 to 10 m, and
        # 0.25 to 1 s].
        beyond = 5.0 + 0.25 * journey.speed
        # The length belongs to the duration, whatever whole number of steps is nearest to it.
        last = end - journey.distance + journey.speed * journey.duration
        return cls(begin, last, (begin - reach, max(end, last) + reach + beyond))

    def realised(self, length: float | None = None, origin: float | None = None) -> dict[str, Any]:
        """Arguments that make a realised road: its own length, where it begins, and where stations are needed.

        Parameters
        ----------
        length : float, optional
            Length of the road [m]: with it the road is the same at every speed and duration, and a journey that
            leaves it is refused. None: that of the journey.
        origin : float, optional
            Where a road of stated `length` begins [m]: with it, it is the same for every start and vehicle as well.
            None: where the hindmost contact starts.

        Returns
        -------
        dict
            As `realise` takes them.
        """
        start = self.first if origin is None else origin
        if length is None:
            return {"length": self.last - self.first, "start": start, "covering": self.covering}
        return {"length": length, "start": start}

    @property
    def shaped(self) -> dict[str, Any]:
        """Arguments that make a shape there."""
        first, last = self.covering
        return {"length": last - first, "start": first}


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


# The way says length, start and covering.
REALISING = keys_of(realise, without=["spectrum", "length", "start", "covering"])


def placed(kind: Kind) -> Kind:
    """Let a kind of realised road have a length and an origin of its own, in place of those of the way."""

    def make(*, way: Way, length: float | None = None, origin: float | None = None, **given: Any) -> Road:
        with checking() as check:
            if length is not None:
                length = check.positive("length", length, "m")
            if origin is not None:
                origin = check.finite("origin", origin, "m")
                if length is None:
                    check.refuse("origin", "is of use only with `length`: without, the road is that of the journey")
        road: Road = kind.make(where=way.realised(length, origin), **given)
        return road

    keys = (*kind.keys, *keys_of(Way.realised, without=["self"]))
    return replace(kind, make=make, keys=keys, beside=where)


def where(table: Mapping[str, Any], *, way: Way) -> dict[str, Any]:
    """Say where the realised road of a table lies: it is another road where this is another.

    Parameters
    ----------
    table : mapping
        What a scenario says of it.
    way : Way
        The way of the journey.

    Returns
    -------
    dict
        As `Way.realised` says it.
    """
    return way.realised(table.get("length"), table.get("origin"))


def places(table: Mapping[str, Any], way: Way) -> list[Any]:
    """Say where all realised roads of a table lie, those of its parts included.

    Parameters
    ----------
    table : mapping
        The table of a scenario.
    way : Way
        The way of the journey.

    Returns
    -------
    list
        Length and beginning of each [m]: where these differ, equal tables are different roads.
    """
    parts = table.get("parts")
    if isinstance(parts, list):
        return [place for part in parts if isinstance(part, dict) for place in places(part, way)]
    kind = next((kind for kind in ROADS if kind.name == table.get("kind")), None)
    lies = where(table, way=way) if kind is not None and kind.beside is where else None
    return [] if lies is None else [(lies["length"], lies["start"])]


def realised(spectrum: Kind) -> Kind:
    """Realise a spectrum: its own keys, then those of a realisation."""

    def make(*, where: Mapping[str, Any], **given: Any) -> Road:
        made = spectrum.make(**chosen(given, spectrum.keys))
        how = {key.name: given.get(key.name, key.default) for key in REALISING}
        profile = realise(made, **how, **where)
        common = in_common(made, how["seed"], how["across"], how["coherence"])
        return Road(profile, profile.source, made, common)

    return placed(replace(spectrum, make=make, keys=(*spectrum.keys, *REALISING)))


def laplace_road(*, where: Mapping[str, Any], **given: Any) -> Road:
    """Realise a road that is not Gaussian.

    It does not carry its spectrum: random vibration in closed form would take it for a Gaussian one.

    Parameters
    ----------
    where : mapping
        Where it lies, as `Way.realised` says it.
    **given : object
        Further arguments of `realise_laplace`.

    Returns
    -------
    Road
        The road.
    """
    profile = realise_laplace(**given, **where)
    return Road(profile, profile.source)


def shaped(shape: Callable[..., Profile]) -> Kind:
    """Make a shape along the way."""

    def make(*, way: Way, **given: Any) -> Road:
        profile = shape(**given, **way.shaped)
        return Road(profile, profile.source)

    return replace(Kind.of(shape, without=["length", "start"]), make=make)


def superposed(*, way: Way, parts: Sequence[Road]) -> Road:
    """Roads added up.

    Parameters
    ----------
    way : Way
        Where they are needed.
    parts : sequence of Road
        The roads.

    Returns
    -------
    Road
        Their sum.
    """
    profile = combination.superposed(*[part.profile for part in parts])
    return Road(profile, "; ".join(part.description for part in parts))


def side_by_side(*, way: Way, parts: Sequence[Road]) -> Road:
    """Roads side by side, each a path of its own.

    Parameters
    ----------
    way : Way
        Where they are needed.
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

# Kinds of roads.
ROADS = (
    *map(realised, SPECTRA),
    placed(
        replace(
            Kind.of(realise_laplace, name="laplace_road", without=["length", "start", "covering"]),
            make=laplace_road,
        )
    ),
    shaped(irregularities.harmonic),
    shaped(irregularities.bump),
    shaped(irregularities.pothole),
    shaped(irregularities.faulted_slabs),
    shaped(irregularities.dipped_joints),
    shaped(irregularities.dipped_weld),
    shaped(irregularities.wheel_flat),
    shaped(irregularities.polygon),
    Kind.of(superposed, without=["way"]),
    Kind.of(side_by_side, without=["way"]),
)

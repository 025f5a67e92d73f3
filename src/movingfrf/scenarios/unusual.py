"""What of a scenario is in order and nevertheless absurd: slips of units above all, by a factor of a thousand."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import Finding
from movingfrf._basics.remembered import recalled
from movingfrf._basics.wording import in_both_units, number
from movingfrf.guideways.foundations import OnMass, ShearLayer, Spring
from movingfrf.guideways.relaxing import RelaxingSpring
from movingfrf.guideways.tensioned import TensionedBeam
from movingfrf.guideways.track import Track
from movingfrf.roughness.profile import Profile
from movingfrf.roughness.straight import mean_slope
from movingfrf.vehicles.journey import Journey
from movingfrf.vehicles.vehicle import Vehicle

# From the least to the most that is usual.
Range = tuple[float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Usual:
    """Between what quantities usually lie; outside they are worth a word, and no more.

    Wide enough for everything of which parameters have been published: pavements and railway tracks with their
    vehicles (Ding, Chen and Yang 2012; Zhai 2004; Mezher 2016; TTB-2D, VBI-2D; Law and Zhu; ASTM E1926), contact
    wires, ice on water; and narrow enough for most slips by a thousand. In brackets, what the ends stand for.
    """

    times_critical: float = 4.0  # speed over the critical one: trains on peat reach 1.3, tests on sledges 2
    # [m/s; walking pace, a car on an empty motorway; km/h typed as m/s is the commonest slip].
    road_speed: Range = (0.1, 70.0)
    truck_speed: Range = (0.1, 40.0)  # [m/s; racing trucks are held at 44]
    truck_axle: float = 4e4  # static load of an axle from which on a road vehicle is a truck [N; cars have 15 kN]
    rail_speed: Range = (0.1, 140.0)  # [m/s; the fastest trains in service run 97, tests have gone to 160]
    step: Range = (1e-7, 0.05)  # in time [s; 10 Hz would be the highest frequency shown]
    duration: Range = (1e-3, 36e3)  # [s; ten hours]
    road_load: Range = (200.0, 1.5e6)  # on a contact [N; a bicycle's wheel, a mining truck's]
    rail_load: Range = (2e3, 6e5)  # on a wheelset [N; a model in a laboratory is less; 45 t and more]
    length: Range = (0.2, 60.0)  # from the first to the last contact of what holds together [m; a road train]
    width: Range = (0.1, 6.0)  # from the right contact to the left one [m]
    footprint: Range = (0.0, 1.0)  # of a contact [m; longer than that of any tyre]
    sprung: Range = (0.2, 200.0)  # mass on springs over that of wheels [a bare bogie 0.7, a coach 5, a car 10]
    squeeze: Range = (2e-7, 0.3)  # of a contact's own spring under its load [m; a rail's, a balloon tyre's]
    slowest: Range = (0.1, 50.0)  # natural frequency of a vehicle [Hz]
    fastest: Range = (0.1, 150.0)  # the same of its fastest motion on tyres, or on rails that it follows [Hz]
    fastest_hertzian: Range = (0.1, 1500.0)  # and on a contact that is as stiff as a wheel on a rail [Hz]
    bending_stiffness: Range = (1e5, 1e12)  # of a beam that no force tenses [N m²; a light rail, a bridge]
    beam_mass: Range = (1.0, 1e5)  # of a beam or a layer [kg/m; a contact wire, a wide bridge]
    foundation: Range = (9e3, 2e10)  # [N/m²; water under a metre of ice, the stiffest of pads]
    bending_length: Range = (0.1, 30.0)  # (4 B/k)^¼ of a beam on springs [m; rails on stiff pads, ice]
    # Of the beam under the heaviest contact at rest [m; a truck on soft soil 8 mm, a locomotive 5], if not afloat.
    sag: Range = (1e-7, 0.025)
    floating: float = 5e4  # stiffness below which a foundation is water [N/m²; 9810 for a metre of width]
    foundation_damping: Range = (3e-4, 20.0)  # over the critical one, 2 √(k m), where there is any
    slope: Range = (0.0, 1.5)  # root mean square of a profile's, about its mean [class H has 0.8, class A 0.006]
    force: Range = (0.0, 5e6)  # prescribed [N; a heavy aircraft's gear]
    # Share of critical damping of what vibrates at `slowest`, bodies and wheels, unless it is undamped: of the best
    # damped vibration, and of the worst [trucks have 5 % and more of the one; leaf springs leave 0.2 % of the
    # other].
    best_damped: float = 0.03
    worst_damped: float = 1e-3
    # What a vehicle does that is worth a remark.
    damping: float = 0.02  # share of critical damping below which a vibration takes long to settle
    undamped: float = 1e-9  # share of critical damping that is rounding, of either sign


USUAL = Usual()


def unusual(
    guideway: object,
    journey: Journey,
    *,
    vehicle: Vehicle | None = None,
    profile: Profile | None = None,
    forces: FloatArray | None = None,
) -> list[Finding]:
    """Find what of a case lies outside what is usual.

    Parameters
    ----------
    guideway : Guideway or FiniteGuideway
        The road or track.
    journey : Journey
        Speed, duration, steps.
    vehicle : Vehicle, optional
        The vehicle.
    profile : Profile, optional
        What it travels over.
    forces : ndarray, shape (time, load), optional
        Prescribed forces [N].

    Returns
    -------
    list of Finding
        Each with the figure and the usual range; none for what is as usual.
    """
    found = [*_of_journey(guideway, journey, vehicle), *_of_guideway(guideway)]
    if vehicle is not None:
        found += [*_of_sag(guideway, vehicle), *recalled(vehicle, "unusual", lambda: tuple(_of_vehicle(vehicle)))]
    if profile is not None:
        found += recalled(profile, "unusual", lambda: tuple(_of_profile(profile)))
    if forces is not None:
        most = float(np.abs(forces).max(initial=0.0))
        found += _outside("the largest prescribed force", most, USUAL.force, "N", "is it in N?")
    return [Finding("unusual", message) for message in found]


def unusual_vehicle(vehicle: Vehicle) -> list[str]:
    """Say what of a vehicle alone lies outside what is usual, in sentences."""
    return list(recalled(vehicle, "unusual", lambda: tuple(_of_vehicle(vehicle))))


def _outside(what: str, value: float, usual: Range, unit: str, hint: str = "") -> Iterator[str]:
    """Say that a figure lies outside a range, if it does."""
    least, most = usual
    rounding = 1e-9  # of a figure in other units
    if least * (1 - rounding) <= value <= most * (1 + rounding):
        return
    unit = "" if unit == "1" else f" {unit}"
    between = f"{_written(least)} to {_written(most)}" if least else f"at most {_written(most)}"
    yield f"{what} is {_written(value)}{unit}, usual is {between}{unit}" + (f": {hint}" if hint else "")


def _written(value: float) -> str:
    """Write a number with as many of four digits as are not zeros at its end."""
    digits = f"{value:.3e}".partition("e")[0].replace(".", "").lstrip("-").rstrip("0")
    return number(value, max(len(digits), 1))


def _of_journey(guideway: object, journey: Journey, vehicle: Vehicle | None) -> Iterator[str]:
    critical = float(getattr(guideway, "critical_speed", np.inf))
    if journey.speed > USUAL.times_critical * critical:
        yield (
            f"the speed is {number(journey.speed / critical, 3)} times the critical one of {number(critical)} m/s, "
            f"usual is less than {USUAL.times_critical:g} times: is it in m/s, and the guideway in N and m?"
        )
    words, usual = "the speed", USUAL.rail_speed
    if vehicle is not None and not vehicle.on_rails:
        heaviest = recalled(vehicle, "heaviest axle", lambda: _heaviest_axle(vehicle))
        usual = USUAL.road_speed
        if heaviest > USUAL.truck_axle:
            words, usual = f"the speed of a truck with {number(heaviest / 1e3, 3)} kN on an axle", USUAL.truck_speed
    in_kmh = in_both_units(journey.speed)[1]
    yield from _outside(words, journey.speed, usual, "m/s", f"it is {in_kmh}; `speed_kmh` takes km/h")
    yield from _outside("the step in time", journey.time_step, USUAL.step, "s", "is it in s?")
    yield from _outside("the duration", journey.duration, USUAL.duration, "s", "is it in s?")


def _heaviest_axle(vehicle: Vehicle) -> float:
    """Give the static load of contacts that stand abreast, where it is largest [N]."""
    _, axle = np.unique(vehicle.positions.round(2), return_inverse=True)
    return float(np.bincount(axle, vehicle.static_loads).max())


def _of_guideway(guideway: object) -> Iterator[str]:
    if not isinstance(guideway, Track):
        return
    beam, tensed = guideway.beam, isinstance(guideway.beam, TensionedBeam)
    beam = beam.beam if isinstance(beam, TensionedBeam) else beam
    bending, mass = (getattr(beam, name, None) for name in ("bending_stiffness", "mass"))
    if bending is not None and not tensed:
        yield from _outside(
            "the bending stiffness of the beam", bending, USUAL.bending_stiffness, "N m²", "is it in N m²?"
        )
    if mass is not None:
        yield from _outside("the mass of the beam", mass, USUAL.beam_mass, "kg/m", "is it in kg/m?")
    yield from _of_foundation(guideway.foundation)
    held = guideway.foundation
    if bending is None or mass is None or not isinstance(held, (Spring, ShearLayer)) or tensed:
        return
    yield from _outside(
        "the length over which the beam bends, (4 B/k)^¼,",
        (4 * bending / held.stiffness) ** 0.25,
        USUAL.bending_length,
        "m",
        "are the beam in N m² and the foundation in N/m²?",
    )
    if held.damping:
        yield from _outside(
            "the damping of the foundation, over the critical one,",
            held.damping / (2 * np.sqrt(held.stiffness * mass)),
            USUAL.foundation_damping,
            "1",
            "is it in N s/m²?",
        )


def _of_sag(guideway: object, vehicle: Vehicle) -> Iterator[str]:
    """Say whether a beam gives way by what none gives way: one slip by a thousand, of whatever stiffness."""
    bending = getattr(getattr(guideway, "beam", None), "bending_stiffness", None)
    if not isinstance(guideway, Track) or bending is None:
        return
    given_way = _compliance(guideway.foundation)
    if not 0 < given_way < 1.0 / USUAL.floating:
        return
    held = 1.0 / given_way
    load = float(vehicle.static_loads.max())
    sag = load / (2 * held) * (held / (4 * bending)) ** 0.25
    words = f"the sag under {number(load / 1e3, 3)} kN at rest"
    yield from _outside(words, sag, USUAL.sag, "m", "are foundation and beam in N/m² and N m²?")


def _compliance(part: object) -> float:
    """Give way at rest, per force and length [m²/N]; 0 where that is not known."""
    if isinstance(part, OnMass):
        return _compliance(part.above) + _compliance(part.below)
    stiffness = float(getattr(part, "stiffness", 0.0))
    return 1.0 / stiffness if stiffness else 0.0


def _of_foundation(part: object) -> Iterator[str]:
    match part:
        case OnMass(above=above, mass=mass, below=below):
            yield from _of_foundation(above)
            yield from _outside("the mass of a layer", mass, USUAL.beam_mass, "kg/m", "is it in kg/m?")
            yield from _of_foundation(below)
        case Spring() | ShearLayer() | RelaxingSpring():
            yield from _outside(
                "the stiffness of the foundation", part.stiffness, USUAL.foundation, "N/m²", "is it in N/m²?"
            )


def _of_vehicle(vehicle: Vehicle) -> Iterator[str]:
    loads, springs = vehicle.static_loads, vehicle.springs
    sprung = np.isfinite(springs)
    usual = USUAL.rail_load if vehicle.on_rails else USUAL.road_load
    for place, words in ((loads.argmin(), "smallest"), (loads.argmax(), "largest")):
        yield from _outside(
            f"the {words} static load, that of {vehicle.standing.listed([int(place)])},",
            float(loads[place]),
            usual,
            "N",
            "are masses in kg?",
        )
        if words == "smallest" and loads[place] < usual[0]:
            break
    for what, places, range_ in (
        ("length from its first contact to its last", vehicle.positions, USUAL.length),
        ("width from its right contact to its left", vehicle.across, USUAL.width),
    ):
        # Of what holds together: the cars of a convoy may be as far apart as they like.
        extents = [float(np.ptp(places[part.contacts])) for part in vehicle.dynamics().parts]
        for extent in {max(extents), min(filter(None, extents), default=0.0)} - {0.0}:
            yield from _outside(f"the vehicle's {what}", extent, range_, "m", "are positions in m?")
    for contact in vehicle.contacts:
        yield from _outside("a footprint", contact.footprint, USUAL.footprint, "m", "no tyre's is longer")
        yield from _outside("the distance of cams", contact.cams, USUAL.footprint, "m", "no tyre's is longer")
        if contact.footprint > USUAL.footprint[1] or contact.cams > USUAL.footprint[1]:
            break
    if sprung.any():
        squeeze = loads[sprung] / springs[sprung]
        worst = int(np.abs(np.log(squeeze / 1e-2)).argmax())
        which = vehicle.standing.listed([int(np.flatnonzero(sprung)[worst])])
        yield from _outside(
            f"by what its load compresses the spring of {which}",
            float(squeeze[worst]),
            USUAL.squeeze,
            "m",
            "are stiffnesses in N/m and masses in kg?",
        )
    yield from _of_motions(vehicle, hertzian=bool((springs[sprung] > 1e8).any()) and vehicle.on_rails)


def _of_motions(vehicle: Vehicle, *, hertzian: bool) -> Iterator[str]:
    """Compare masses and springs with each other."""
    mass, _, _, contact_map = vehicle.matrices
    vertical = np.asarray(vehicle.vertical) != 0
    wheels = vertical & (contact_map != 0).any(axis=0)
    above = vertical & ~wheels
    weights = np.diag(mass)
    if wheels.any() and above.any():
        yield from _outside(
            f"the mass on springs, {number(weights[above].sum())} kg, over that of the wheels, "
            f"{number(weights[wheels].sum())} kg,",
            float(weights[above].sum() / weights[wheels].sum()),
            USUAL.sprung,
            "1",
            "are all masses in kg?",
        )
    frequencies = vehicle.natural_frequencies
    if not frequencies.size:
        return
    hint = "are stiffnesses in N/m, damping in N s/m and masses in kg?"
    fastest = USUAL.fastest_hertzian if hertzian else USUAL.fastest
    slowest = USUAL.slowest if above.any() else fastest
    yield from _outside("the slowest vibration of the vehicle", frequencies[0], slowest, "Hz", hint)
    yield from _outside("the fastest vibration of the vehicle", frequencies[-1], fastest, "Hz", hint)
    damped = vehicle.damping_ratios
    damped = damped[(frequencies <= USUAL.slowest[1]) & (damped > USUAL.undamped)]
    if not damped.size:
        return
    for which, share, least in (
        ("best", float(damped.max()), USUAL.best_damped),
        ("worst", float(damped.min()), USUAL.worst_damped),
    ):
        if share < least:
            yield (
                f"the {which} damped vibration of the vehicle has {number(100 * share, 2)} % of critical damping, "
                f"usual is {100 * least:g} % or more: is damping in N s/m?"
            )
            return


def _of_profile(profile: Profile) -> Iterator[str]:
    stations, elevations = profile.stations, profile.columns
    slopes = np.diff(elevations, axis=0) / np.diff(stations)[:, None] - mean_slope(stations, elevations)
    roughest = float(np.sqrt((slopes**2).mean(axis=0)).max(initial=0.0))
    yield from _outside(
        "the root mean square of the profile's slope", roughest, USUAL.slope, "1", "are elevations in m?"
    )

"""What the tables of a scenario can be: families of kinds.

A table's `kind` names a function or class, its keys are the keyword arguments, and the checks are those that the
function makes itself. A new kind is one line in its family; an argument whose type a family makes is a table.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from movingfrf._basics.checks import ParameterError, checking
from movingfrf.guideways.beams import Beam, EulerBernoulliBeam, TimoshenkoBeam
from movingfrf.guideways.files import read_sampled_guideway
from movingfrf.guideways.foundations import Foundation, OnMass, ShearLayer, Spring
from movingfrf.guideways.guideway import Guideway
from movingfrf.guideways.relaxing import RelaxingSpring
from movingfrf.guideways.rigid import RigidGuideway
from movingfrf.guideways.tensioned import TensionedBeam
from movingfrf.guideways.track import Track, track
from movingfrf.roughness.files import read_profile
from movingfrf.roughness.preparation import prepared, read_prepared
from movingfrf.roughness.road import Road
from movingfrf.roughness.spectra.coherence import Coherence, ExponentialCoherence, IsotropicCoherence
from movingfrf.roughness.spectra.spectrum import Spectrum
from movingfrf.scenarios import forces
from movingfrf.scenarios.kind import Family, Kind, family, keys_of, summary
from movingfrf.scenarios.roads import ROADS, SPECTRA, Way
from movingfrf.stepping.finite_plate import finite_plate
from movingfrf.stepping.finite_track import finite_track
from movingfrf.vehicles.assembly import Body, Hinge, Suspension, assemble
from movingfrf.vehicles.cars import full_car, half_car, quarter_car
from movingfrf.vehicles.catalogue import catalogue
from movingfrf.vehicles.combined import convoy, on_paths, seated, train
from movingfrf.vehicles.contact import Contact
from movingfrf.vehicles.files import read_vehicle
from movingfrf.vehicles.journey import Journey
from movingfrf.vehicles.oscillator import sprung_mass
from movingfrf.vehicles.rail import bogie, carriage, wheelset
from movingfrf.vehicles.trucks import Axle, Unit, WalkingBeam, truck
from movingfrf.vehicles.vehicle import Vehicle


def profile(*, way: Way, **given: Any) -> Road:
    """Read a measured profile, and prepare it as far as options ask for it; the description says what was done."""
    ready, understood = read_prepared(**given)
    return Road(ready, "; ".join([understood, *ready.steps]))


PROFILE = Kind(
    name="profile",
    make=profile,
    keys=tuple(
        {key.name: key for key in (*keys_of(read_profile), *keys_of(prepared, without=["profile"]))}.values()
    ),
    words="A measured profile, read from a file.",
    beside=lambda table, **given: {},  # what the file says
)

BEAM = family("beam", Beam, EulerBernoulliBeam, TimoshenkoBeam, TensionedBeam)
FOUNDATION = family("foundation", Foundation, Spring, ShearLayer, OnMass, RelaxingSpring)
TRACK = family("track", Track, track)
SAMPLED = Kind.of(read_sampled_guideway, name="sampled_guideway")
GUIDEWAY = family("guideway", Guideway, track, RigidGuideway, SAMPLED, finite_track, finite_plate, default="track")
VEHICLE = family(
    "vehicle",
    Vehicle,
    half_car,
    full_car,
    quarter_car,
    sprung_mass,
    truck,
    wheelset,
    bogie,
    carriage,
    convoy,
    train,
    seated,
    on_paths,
    catalogue,
    assemble,
    Vehicle,
    Kind.of(read_vehicle, name="vehicle_file"),
)
CONTACT = family("contact", Contact, Contact)
BODY = family("body", Body, Body)
SUSPENSION = family("suspension", Suspension, Suspension)
HINGE = family("hinge", Hinge, Hinge)
UNIT = family("unit", Unit, Unit)
AXLE = family("axle", Axle | WalkingBeam, Axle, WalkingBeam, default="axle")
ROUGHNESS = family("roughness", Road, *ROADS, PROFILE)
SPECTRUM = family("spectrum", Spectrum, *SPECTRA)
COHERENCE = family("coherence", Coherence, IsotropicCoherence, ExponentialCoherence)
LOADS = family("loads", forces.Loads, forces.loads)
FORCE = family("force", forces.History, forces.constant, forces.harmonics, forces.random_sum, forces.tabulated)

# Type of an argument → the family of the table that stands for it.
TABLES: Mapping[Any, Family] = {
    one.makes: one
    for one in (
        BEAM,
        FOUNDATION,
        TRACK,
        GUIDEWAY,
        VEHICLE,
        CONTACT,
        BODY,
        SUSPENSION,
        HINGE,
        UNIT,
        AXLE,
        ROUGHNESS,
        SPECTRUM,
        COHERENCE,
        LOADS,
        FORCE,
    )
}


def journey(*, speed: float | None = None, speed_kmh: float | None = None, **given: Any) -> Journey:
    """How a vehicle, or loads, travel; the speed in one of two units."""
    with checking() as check:
        if speed is not None and speed_kmh is not None:
            check.refuse("speed", "and speed_kmh exclude each other: one of the two [m/s, km/h]")
        elif speed is None and speed_kmh is None:
            check.refuse("speed", "is missing: speed [m/s] or speed_kmh [km/h]")
        elif speed_kmh is not None:
            speed = check.positive("speed_kmh", speed_kmh, "km/h") / 3.6
        try:
            # Any speed will do to find what else is wrong.
            made = Journey(speed=1.0 if check.faults else speed, in_kmh=speed_kmh is not None, **given)  # type: ignore[arg-type]
        except ParameterError as error:
            check.faults += error.faults
    return made


def travelling(*, without: Sequence[str] = ()) -> Kind:
    """Make the kind of a [run] table."""
    speed, *others = keys_of(Journey, without=["in_kmh", *without])
    in_kmh = replace(speed, name="speed_kmh", words="The same [km/h], in its place.")
    both = (replace(key, default=None) for key in (speed, in_kmh))
    return Kind(
        name="journey", make=journey, keys=(*both, *others), words=summary(Journey), either=("speed", "speed_kmh")
    )


# The tables of a scenario with a vehicle, and of one with prescribed loads, which have no profile to start on.
DRIVE = {
    "guideway": GUIDEWAY,
    "vehicle": VEHICLE,
    "roughness": ROUGHNESS,
    "run": family("run", Journey, travelling()),
}
PASSAGE = {
    "guideway": GUIDEWAY,
    "loads": LOADS,
    "run": family("run", Journey, travelling(without=["start", "blend"])),
}

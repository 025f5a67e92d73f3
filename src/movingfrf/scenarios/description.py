"""What a scenario says, in lines to read, without solving it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from movingfrf._basics import wording
from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import SolveError
from movingfrf._basics.welch import welch
from movingfrf.guideways.guideway import findings_of
from movingfrf.response.batches import unthreaded
from movingfrf.response.line import TRANSFORM, Line
from movingfrf.response.ride import excitation_of, line_of
from movingfrf.response.survey import survey
from movingfrf.response.system import System
from movingfrf.results.findings import graded, near_critical, one_path
from movingfrf.roughness.fitting import fit_iso
from movingfrf.roughness.road import Road
from movingfrf.roughness.straight import mean_slope, straight
from movingfrf.scenarios.scenario import COUPLED_BY, NEWMARK, Drive, Passage, Scenario
from movingfrf.scenarios.unusual import USUAL
from movingfrf.stepping.finite_guideway import FiniteGuideway
from movingfrf.vehicles.journey import Journey
from movingfrf.vehicles.modes import Mode, vehicle_modes
from movingfrf.vehicles.vehicle import Vehicle

# A section: its heading and its lines of name and value.
Section = tuple[str, list[tuple[str, str]]]


@dataclass(frozen=True, slots=True, kw_only=True)
class Description:
    """What a scenario says.

    Parameters
    ----------
    sections : list of (str, list of (str, str))
        Headings, each with lines of name and value.
    remarks : list of str
        Sentences on what is in order and nevertheless invites to look at again.
    refusal : str
        Why it cannot be solved by moving FRFs; empty if it can, or is not meant to be.
    """

    sections: list[Section]
    remarks: list[str]
    refusal: str = ""


def described(scenario: Scenario) -> Description:
    """Describe a scenario.

    Parameters
    ----------
    scenario : Scenario
        A checked scenario.

    Returns
    -------
    Description
        Sections, remarks, and a refusal where vehicle and guideway are unstable together.
    """
    sections: list[Section] = [("Guideway", _guideway(scenario))]
    endless, speed, refusal, found = scenario.endless, scenario.journey.speed, "", []
    if endless is not None:
        known = [*near_critical(speed, float(endless.critical_speed)), *findings_of(endless)]
        found += [finding.message for finding in known]
    match scenario.case:
        case Drive(vehicle=vehicle, road=road):
            contacts: Section = ("Contacts at rest", _contacts(vehicle, vehicle.static_loads))
            if endless is not None:
                try:
                    surveyed = unthreaded(survey)(System(guideway=endless, vehicle=vehicle, speed=speed))
                except SolveError as error:
                    refusal = str(error)
                else:
                    steady, found = surveyed.steady, [finding.message for finding in surveyed.findings]
                    contacts = "Contacts in steady travel", _contacts(vehicle, steady.load, steady.deflection)
            of_vehicle, _, vibrations = described_vehicle(vehicle)
            sections += [of_vehicle, contacts, vibrations, ("Roughness", _roughness(road))]
            paths = one_path(road.profile.one_path, vehicle.paths, vehicle.across)
            seen = excitation_of(road.profile, vehicle, scenario.journey)
            found += [*_remarks_on_vehicle(vehicle, scenario.journey)]
            found += [finding.message for finding in (*paths, *graded(*seen.slopes))]
        case Passage() as passage:
            sections.append(("Loads", _loads(passage)))
    found = [*(finding.message for finding in scenario.case.unusual), *found]
    return Description(sections=[*sections, ("Run", _run(scenario.case))], remarks=found, refusal=refusal)


def _remarks_on_vehicle(vehicle: Vehicle, journey: Journey) -> list[str]:
    found = []
    frequencies, ratios = vehicle.natural_frequencies, vehicle.damping_ratios
    fastest, nyquist = float(frequencies.max(initial=0.0)), 0.5 / journey.time_step
    if fastest > nyquist:
        found.append(
            f"the vehicle vibrates at up to {fastest:.4g} Hz, but a record in steps of {journey.time_step:g} s "
            f"shows only what is below {nyquist:.4g} Hz"
        )
    if frequencies.size and ratios.min() < USUAL.damping:
        found.append(
            f"a vibration of the vehicle at {frequencies[ratios.argmin()]:.3g} Hz "
            + (
                "is undamped: it does not settle"
                if abs(ratios.min()) < USUAL.undamped
                else f"has {100 * ratios.min():.2g} % of critical damping: it takes long to settle, and its size "
                "depends on that number"
            )
        )
    return found


def _guideway(scenario: Scenario) -> list[tuple[str, str]]:
    if isinstance(scenario.guideway, FiniteGuideway):
        return _finite(scenario.guideway)
    critical, speed = scenario.guideway.critical_speed, scenario.journey.speed
    share = "" if np.isinf(critical) else f", of which the speed is {speed / critical:.3g}"
    return [
        ("kind", type(scenario.guideway).__name__),
        ("critical speed", "none" if np.isinf(critical) else f"{critical:.5g} m/s{share}"),
    ]


def _finite(road: FiniteGuideway) -> list[tuple[str, str]]:
    first, last = road.interval
    varies = "which travels along" if road.travels else "not the same everywhere"
    lines = [
        ("kind", f"finite road, {varies}: no moving FRF, no critical speed"),
        ("length", f"{last - first:g} m, from {first:g} m to {last:g} m"),
    ]
    if road.width:
        lines.append(("width", f"{road.width:g} m"))
    if road.spacing:
        lines.append(("elements", f"{round((last - first) / road.spacing)} along, of {road.spacing:g} m"))
    return [*lines, ("unknowns", f"{road.dofs}")]


def described_vehicle(vehicle: Vehicle) -> list[Section]:
    """Describe a vehicle on its own, on a rigid road.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle.

    Returns
    -------
    list of (str, list of (str, str))
        Headings, each with lines of name and value: degrees of freedom and weight, contacts, vibrations.
    """
    return [
        (
            "Vehicle",
            [
                ("degrees of freedom", wording.enumerated(vehicle.dof_names)),
                ("weight", f"{vehicle.static_loads.sum() / 1e3:.2f} kN"),
            ],
        ),
        ("Contacts", _contacts(vehicle, vehicle.static_loads)),
        ("Vibrations on a rigid road", _vibrations(vehicle)),
    ]


def _contacts(
    vehicle: Vehicle, loads: FloatArray, sags: FloatArray | None = None, most: int = 12
) -> list[tuple[str, str]]:
    """One line per contact, at most so many: name and number, where it is, what it carries and how it is held."""
    lines = []
    for number, (contact, load) in enumerate(zip(vehicle.contacts, loads, strict=True)):
        place = f"at {contact.position:g} m" + (f", {contact.across:+g} m across" if contact.across else "")
        held = "rigid" if contact.rigid else f"{contact.stiffness:.4g} N/m"
        if contact.damping:
            held += f", {contact.damping:.4g} N s/m"
        patch = f", footprint {contact.footprint:g} m" if contact.footprint else ""
        cams = f", cams {contact.cams:g} m apart" if contact.cams else ""
        sag = "" if sags is None else f", deflection {sags[number] * 1e3:.3f} mm"
        path = f", path {contact.path}" if contact.path else ""
        name = f"{number} {contact.name}".rstrip()
        lines.append((name, f"{place}{path}, {load / 1e3:.2f} kN{sag}, {held}{patch}{cams}"))
    if len(lines) <= most:
        return lines
    left_out = len(lines) - most + 1
    return [*lines[: most - 2], ("…", f"{left_out} more"), lines[-1]]


def _vibrations(vehicle: Vehicle, same: float = 1e-6) -> list[tuple[str, str]]:
    """One line per natural frequency; the equal ones of equal cars share a line.

    Poles that differ by less than the share `same` are one [1e-10 to 1e-5: rounding to different wheels of a car].
    """
    groups: list[list[Mode]] = []
    for mode in vehicle_modes(vehicle):
        if groups and abs(mode.pole - groups[-1][0].pole) < same * abs(mode.pole):
            groups[-1].append(mode)
        else:
            groups.append([mode])
    if not groups:
        return [("none", "every motion is prescribed by a rigid contact")]
    return [
        (
            f"{group[0].frequency:.3f} Hz" + (f" ({len(group)} times)" if len(group) > 1 else ""),
            f"{_damping(group[0].damping_ratio)}: {_alike(group)}",
        )
        for group in groups
    ]


def _damping(ratio: float) -> str:
    return "undamped" if abs(ratio) < USUAL.undamped else f"{100 * ratio:.1f} % damping"


def _alike(group: Sequence[Mode]) -> str:
    """Describe vibrations of one frequency: two in full, of more the first."""
    return (
        "; ".join(mode.description for mode in group) if len(group) <= 2 else f"{group[0].description}, and alike"
    )


def _roughness(road: Road) -> list[tuple[str, str]]:
    profile = road.profile
    stations = profile.stations
    elevation = np.asarray(profile.elevation)
    slopes = mean_slope(stations, profile.columns)
    lines = [
        ("source", road.description),
        ("stations", f"{stations.size} from {stations[0]:.6g} m to {stations[-1]:.6g} m"),
        ("elevation", f"{elevation.min():.4g} m to {elevation.max():.4g} m"),
        ("mean slope", ", ".join(f"{100 * slope + 0.0:.2f} %" for slope in dict.fromkeys(slopes.round(4)))),
    ]
    if road.spectrum is not None:
        return [*lines, ("fitted spectrum", "none: it was made from the spectrum above")]
    step = float(np.median(np.diff(stations)))
    for paths in profile.alike:
        level = straight(stations, profile.columns[:, paths[:1]]).all()
        even = profile.along(paths[0])(np.arange(stations[0], stations[-1], step))
        fit = fit_iso(*((np.empty(0), np.empty(0)) if level else welch(even, step)))
        of = "" if profile.paths == 1 else f" of {wording.named_paths(paths)}"
        if fit.reason:
            lines.append((f"ISO 8608 class{of}", f"none: {fit.reason}"))
            continue
        at_two = f"{fit.road_class} ({fit.roughness_at_two:.3g} m³ at 0.1 cycle/m with waviness 2)"
        lines += [
            (
                f"fitted spectrum{of}",
                f"{fit.roughness:.3g} m³ at 0.1 cycle/m with waviness {fit.waviness:.2f}, over {fit.covered}",
            ),
            (f"ISO 8608 class{of}", f"{at_two}; {fit.doubt}" if fit.doubt else at_two),
        ]
    return lines


def _loads(passage: Passage) -> list[tuple[str, str]]:
    lines = [("observed at", ", ".join(f"{x:g} m" for x in passage.loads.observe))]
    for position, force in zip(passage.loads.positions, passage.forces.T, strict=True):
        lines.append((f"load at {position:g} m", f"{force.min() / 1e3:.4g} to {force.max() / 1e3:.4g} kN"))
    return lines


def _run(case: Drive | Passage) -> list[tuple[str, str]]:
    journey = case.journey
    match case:
        case Drive(vehicle=vehicle):
            line = line_of(journey, vehicle)
            channels = len(vehicle.contacts) + len(vehicle.dof_names)
            through_time, without = " or ".join(COUPLED_BY), "found"
        case Passage(loads=loads):
            line = Line(samples=journey.samples, time_step=journey.time_step)
            channels = len(loads.positions) + len(loads.observe)
            through_time, without = NEWMARK, "none"
    lines = [
        ("speed", journey.speed_in_words),
        ("travel", f"{journey.duration:g} s over {journey.speed * journey.duration:g} m"),
        ("time steps", f"{journey.samples} of {journey.time_step:g} s"),
    ]
    if isinstance(case.guideway, FiniteGuideway):
        return [*lines, ("method", f"through time: movingfrf run FILE --method {through_time}")]
    memory = TRANSFORM.bytes_per_sample * channels * line.padded
    found = "found, as fine as road, or loads, and system need"
    return [
        *lines,
        ("solved in steps", found if journey.solved_step is None else f"of {journey.solved_step:g} s"),
        ("truncation", without if journey.truncation is None else f"{journey.truncation:g} Hz"),
        ("memory", f"about {memory / 2**20:.3g} MiB"),
    ]

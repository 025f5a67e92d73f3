"""What a scenario says, in lines to read, without solving it."""

from __future__ import annotations

import numpy as np

from movingfrf.coupling import joined, steady_state
from movingfrf.roughness.profiles import Profile
from movingfrf.roughness.spectra import fit_iso, iso_class, welch
from movingfrf.scenario import Scenario
from movingfrf.simulation import BYTES_PER_SAMPLE, spectral_grid
from movingfrf.spectral import SpectralGrid

# A section: its heading and its lines of name and value.
Section = tuple[str, list[tuple[str, str]]]


def described(scenario: Scenario) -> list[Section]:
    """Describe a scenario.

    Parameters
    ----------
    scenario : Scenario
        A checked scenario.

    Returns
    -------
    list of (str, list of (str, str))
        Headings, each with lines of name and value.
    """
    sections: list[Section] = [("Guideway", _guideway(scenario))]
    if scenario.vehicle is not None:
        sections.append(("Vehicle", _vehicle(scenario)))
    if scenario.road is not None:
        sections.append(("Roughness", _roughness(scenario.road.profile, scenario.road.description)))
    if scenario.loads is not None:
        sections.append(("Loads", _loads(scenario)))
    return [*sections, ("Run", _run(scenario))]


def _guideway(scenario: Scenario) -> list[tuple[str, str]]:
    critical, speed = scenario.guideway.critical_speed, scenario.journey.speed
    share = "" if np.isinf(critical) else f", of which the speed is {speed / critical:.3g}"
    return [
        ("kind", type(scenario.guideway).__name__),
        ("critical speed", "none" if np.isinf(critical) else f"{critical:.5g} m/s{share}"),
    ]


def _vehicle(scenario: Scenario) -> list[tuple[str, str]]:
    vehicle = scenario.vehicle
    assert vehicle is not None
    system = joined(scenario.guideway, vehicle, scenario.journey.speed)
    steady = steady_state(system, system.sample(np.zeros(1, complex)))
    modes = zip(vehicle.natural_frequencies, vehicle.damping_ratios, strict=True)
    return [
        ("degrees of freedom", ", ".join(vehicle.dof_names)),
        ("contacts at", ", ".join(f"{x:g} m" for x in vehicle.positions)),
        ("steady contact forces", ", ".join(f"{load / 1e3:.2f} kN" for load in steady.load)),
        ("steady deflections", ", ".join(f"{sag * 1e3:.3f} mm" for sag in steady.deflection)),
        ("natural frequencies", "; ".join(f"{f:.3f} Hz ({100 * d:.1f} % damping)" for f, d in modes)),
    ]


def _roughness(profile: Profile, description: str) -> list[tuple[str, str]]:
    stations = profile.stations
    elevation = np.asarray(profile.elevation)
    lines = [
        ("source", description),
        ("stations", f"{stations.size} from {stations[0]:.6g} m to {stations[-1]:.6g} m"),
        ("elevation", f"{elevation.min():.4g} m to {elevation.max():.4g} m"),
    ]
    step = float(np.median(np.diff(stations)))
    for path in range(profile.paths):
        uniform = profile.along(path)(np.arange(stations[0], stations[-1], step))
        spectrum = welch(uniform, step)
        roughness, waviness = fit_iso(*spectrum)
        if np.isfinite(roughness):
            at_two, _ = fit_iso(*spectrum, waviness=2.0)
            of = f" of path {path}" if profile.paths > 1 else ""
            lines += [
                (f"fitted spectrum{of}", f"{roughness:.3g} m³ at 0.1 cycle/m with waviness {waviness:.2f}"),
                (f"ISO 8608 class{of}", f"{iso_class(at_two)} ({at_two:.3g} m³ at 0.1 cycle/m with waviness 2)"),
            ]
    return lines


def _loads(scenario: Scenario) -> list[tuple[str, str]]:
    loads, journey = scenario.loads, scenario.journey
    assert loads is not None
    time = np.arange(journey.samples) * journey.time_step
    lines = [("observed at", ", ".join(f"{x:g} m" for x in loads.observe))]
    for position, history in zip(loads.positions, loads.histories, strict=True):
        force = history(time)
        lines.append((f"load at {position:g} m", f"{force.min() / 1e3:.4g} to {force.max() / 1e3:.4g} kN"))
    return lines


def _run(scenario: Scenario) -> list[tuple[str, str]]:
    journey = scenario.journey
    if scenario.vehicle is not None:
        grid = spectral_grid(journey, scenario.vehicle)
        channels = len(scenario.vehicle.contacts) + len(scenario.vehicle.dof_names)
    else:
        assert scenario.loads is not None
        grid = SpectralGrid(samples=journey.samples, time_step=journey.time_step, truncation=journey.truncation)
        channels = len(scenario.loads.positions) + len(scenario.loads.observe)
    memory = BYTES_PER_SAMPLE * channels * grid.padded
    kept = f"{grid.kept} of them with the road" if journey.truncation is not None else "the truncation is found"
    return [
        ("speed", f"{journey.speed:g} m/s ({3.6 * journey.speed:g} km/h)"),
        ("travel", f"{journey.duration:g} s over {journey.speed * journey.duration:g} m"),
        ("time steps", f"{journey.samples} of {journey.time_step:g} s"),
        ("frequencies", f"{grid.size} up to {0.5 / journey.time_step:g} Hz, {kept}"),
        ("memory", f"about {memory / 2**20:.3g} MiB"),
    ]

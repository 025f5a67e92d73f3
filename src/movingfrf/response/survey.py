"""What is to be known of a system before it is solved: steady travel, stability, findings."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import movingfrf.results.findings as find
from movingfrf._basics.arrays import ComplexArray, FloatArray
from movingfrf._basics.remembered import recalled
from movingfrf.guideways.guideway import findings_of
from movingfrf.response.along import CarByCar
from movingfrf.response.batches import BATCH
from movingfrf.response.stability import along_the_axis, require_stable, stretches
from movingfrf.response.system import System, Tables


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SteadyState:
    """Travel on a smooth road: what is constant in time.

    Parameters
    ----------
    load : ndarray, shape (contact,)
        Contact forces [N].
    deflection : ndarray, shape (contact,)
        Deflection under each contact [m].
    """

    load: FloatArray
    deflection: FloatArray


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Survey:
    """What is to be known of a system before it is solved.

    Parameters
    ----------
    steady : SteadyState
        Travel on a smooth road.
    critical_speed : float
        Of the guideway [m/s].
    findings : tuple of Finding
        What a user should know.
    """

    steady: SteadyState
    critical_speed: float
    findings: tuple[find.Finding, ...]


def survey(system: System, soon: ComplexArray | None = None) -> Survey:
    """Look at a system before it is solved.

    Parameters
    ----------
    system : System
        Vehicle and road.
    soon : ndarray, optional
        Frequencies [rad/s] at which it will be looked at next, evaluated with those for the survey.

    Returns
    -------
    Survey
        Steady state, critical speed and findings.

    Raises
    ------
    SolveError
        If vehicle and guideway are unstable together.
    """
    return recalled(system, "survey", lambda: _surveyed(system, soon))


def _surveyed(system: System, soon: ComplexArray | None) -> Survey:
    """Look at a system for the first time."""
    critical_speed = float(system.guideway.critical_speed)
    findings = [*find.near_critical(system.speed, critical_speed), *findings_of(system.guideway)]
    batch = BATCH.frequencies(system.entries)
    # The vehicle alone tells along what path.
    vehicle, speed = system.vehicle, system.speed
    path = stretches(recalled(vehicle, "path along the axis", lambda: along_the_axis(vehicle, speed)), batch)
    at_rest = np.zeros(1, complex)
    system.foresee([at_rest, *path] if soon is None else [at_rest, *path, soon])
    steady = steady_state(system, system.at(at_rest))
    require_stable(system, map(system.at, path))
    return Survey(steady=steady, critical_speed=critical_speed, findings=tuple(findings))


def steady_state(system: System, at_rest: Tables | CarByCar) -> SteadyState:
    """Steady travel on a smooth road.

    Parameters
    ----------
    system : System
        Vehicle and road.
    at_rest : Tables or CarByCar
        Both sides at ω = 0.

    Returns
    -------
    SteadyState
        Loads and deflections. With more contacts than rigid motions the sag of the road redistributes the
        weight: (I + D G) F₀ = F_s at ω = 0.
    """
    load, deflection = at_rest.carried(system.vehicle.static_loads[:, None] + 0j)
    return SteadyState(load=load[:, 0].real, deflection=deflection[:, 0].real)

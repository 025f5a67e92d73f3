"""How vehicles and roads shake each other, computed in the frequency domain with moving FRFs."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from movingfrf.version import VERSION

__version__ = VERSION

# Public name → the module it lives in. Loaded on first use: importing the package costs next to nothing.
_WHERE = {
    "EulerBernoulliBeam": "guideways.track",
    "TimoshenkoBeam": "guideways.track",
    "Spring": "guideways.track",
    "ShearLayer": "guideways.track",
    "OnMass": "guideways.track",
    "track": "guideways.track",
    "RigidGuideway": "guideways.rigid",
    "Contact": "vehicles.base",
    "Vehicle": "vehicles.base",
    "quarter_car": "vehicles.road",
    "half_car": "vehicles.road",
    "full_car": "vehicles.road",
    "IsoRoad": "roughness.spectra",
    "Profile": "roughness.profiles",
    "realise": "roughness.profiles",
    "harmonic": "roughness.profiles",
    "bump": "roughness.profiles",
    "simulate": "simulation",
    "moving_loads": "simulation",
    "Scenario": "scenario",
    "ScenarioError": "scenario",
    "read_scenario": "scenario",
    "SampledGuideway": "guideways.sampled",
    "newmark_loads": "reference.moving_load",
    "moving_impulse_response": "reference.impulse",
    "struck_track": "reference.impulse",
    "duhamel": "reference.duhamel",
    "duhamel_loads": "reference.duhamel",
    "FiniteGuideway": "reference.finite_guideway",
    "finite_track": "reference.finite_guideway",
    "finite_plate": "reference.plate",
    "struck_plate": "reference.plate",
    "Scheme": "reference.schemes",
    "cdfm": "reference.coupled",
    "sim": "reference.coupled",
    "compare": "comparison",
    "measures": "metrics.basic",
    "ParameterError": "_checks",
    "SolveError": "_checks",
    "ValidityWarning": "_checks",
}

__all__ = sorted(_WHERE)


def __getattr__(name: str) -> Any:
    if name not in _WHERE:
        raise AttributeError(f"module 'movingfrf' has no attribute {name!r}")
    value = getattr(import_module(f"movingfrf.{_WHERE[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return [*__all__, "__version__"]

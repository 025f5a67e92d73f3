"""How vehicles and roads shake each other, computed in the frequency domain with moving FRFs."""

from __future__ import annotations

from movingfrf._basics.ending import heed, is_command

if is_command():
    heed()  # before anything else is loaded: from here on an interrupt ends in a line
    import os

    # No command gains by a second thread of BLAS, which takes the processor's time while it waits for the first.
    os.environ |= {"OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}

from importlib import import_module
from typing import Any

from movingfrf._basics.version import VERSION

__version__ = VERSION

# Public name → the module it lives in. Loaded on first use: importing the package costs next to nothing.
_WHERE = {
    "EulerBernoulliBeam": "guideways.beams",
    "TimoshenkoBeam": "guideways.beams",
    "TensionedBeam": "guideways.tensioned",
    "Spring": "guideways.foundations",
    "ShearLayer": "guideways.foundations",
    "OnMass": "guideways.foundations",
    "track": "guideways.track",
    "Guideway": "guideways.guideway",
    "at_offsets": "guideways.guideway",
    "RelaxingSpring": "guideways.relaxing",
    "RigidGuideway": "guideways.rigid",
    "Contact": "vehicles.contact",
    "Vehicle": "vehicles.vehicle",
    "Body": "vehicles.assembly",
    "Suspension": "vehicles.assembly",
    "Hinge": "vehicles.assembly",
    "assemble": "vehicles.assembly",
    "Axle": "vehicles.trucks",
    "WalkingBeam": "vehicles.trucks",
    "Unit": "vehicles.trucks",
    "truck": "vehicles.trucks",
    "wheelset": "vehicles.rail",
    "bogie": "vehicles.rail",
    "carriage": "vehicles.rail",
    "hertzian_stiffness": "vehicles.rail",
    "convoy": "vehicles.combined",
    "train": "vehicles.combined",
    "catalogue": "vehicles.catalogue",
    "read_vehicle": "vehicles.files",
    "write_vehicle": "vehicles.files",
    "vehicle_modes": "vehicles.modes",
    "seated": "vehicles.combined",
    "on_paths": "vehicles.combined",
    "sprung_mass": "vehicles.oscillator",
    "quarter_car": "vehicles.cars",
    "half_car": "vehicles.cars",
    "full_car": "vehicles.cars",
    "IsoRoad": "roughness.spectra.iso",
    "Profile": "roughness.profile",
    "read_profile": "roughness.files",
    "read_pieces": "roughness.files",
    "write_profile": "roughness.files",
    "selected": "roughness.steps.selected",
    "cropped": "roughness.steps.cropped",
    "repaired": "roughness.steps.repaired",
    "detrended": "roughness.steps.detrended",
    "high_passed": "roughness.steps.high_passed",
    "low_passed": "roughness.steps.low_passed",
    "resampled": "roughness.steps.resampled",
    "repeated": "roughness.steps.repeated",
    "mirrored": "roughness.steps.mirrored",
    "prepared": "roughness.preparation",
    "describe_profile": "metrics.profile",
    "TwoSlopeRoad": "roughness.spectra.two_slope",
    "FraTrack": "roughness.spectra.rail",
    "FrybaTrack": "roughness.spectra.rail",
    "GermanTrack": "roughness.spectra.rail",
    "SncfTrack": "roughness.spectra.rail",
    "ChineseBallastlessTrack": "roughness.spectra.rail",
    "TabulatedSpectrum": "roughness.spectra.tabulated",
    "ThirdOctaveSpectrum": "roughness.spectra.tabulated",
    "iso3095_limit": "roughness.spectra.tabulated",
    "third_octave_levels": "roughness.spectra.tabulated",
    "IsotropicCoherence": "roughness.spectra.coherence",
    "ExponentialCoherence": "roughness.spectra.coherence",
    "realise": "roughness.realisation",
    "realise_laplace": "roughness.realisation",
    "harmonic": "roughness.irregularities",
    "bump": "roughness.irregularities",
    "pothole": "roughness.irregularities",
    "faulted_slabs": "roughness.irregularities",
    "dipped_joints": "roughness.irregularities",
    "dipped_weld": "roughness.irregularities",
    "wheel_flat": "roughness.irregularities",
    "polygon": "roughness.irregularities",
    "superposed": "roughness.combination",
    "side_by_side": "roughness.combination",
    "rolled": "roughness.combination",
    "simulate": "response.simulation",
    "moving_loads": "response.moving_loads",
    "transfer": "response.transfer",
    "random_response": "response.random",
    "spectral_fatigue": "metrics.fatigue",
    "Scenario": "scenarios.scenario",
    "ScenarioError": "scenarios.scenario",
    "read_scenario": "scenarios.reading",
    "SampledGuideway": "guideways.sampled",
    "read_sampled_guideway": "guideways.files",
    "write_sampled_guideway": "guideways.files",
    "newmark_loads": "stepping.moving_loads",
    "moving_impulse_response": "stepping.impulse",
    "struck_track": "stepping.impulse",
    "duhamel": "stepping.duhamel",
    "duhamel_loads": "stepping.duhamel",
    "FiniteGuideway": "stepping.finite_guideway",
    "finite_track": "stepping.finite_track",
    "finite_plate": "stepping.finite_plate",
    "struck_plate": "stepping.finite_plate",
    "Scheme": "stepping.schemes",
    "cdfm": "stepping.coupled",
    "sim": "stepping.coupled",
    "compare": "studies.comparison.comparison",
    "sweep": "studies.sweep.sweep",
    "design": "studies.sweep.design",
    "sensitivity": "studies.sweep.design",
    "Design": "studies.sweep.design",
    "optimise": "studies.optimisation.optimise",
    "export": "results.export",
    "measures": "metrics.measures",
    "assess": "metrics.measures",
    "iri": "metrics.iri",
    "ride_number": "metrics.iri",
    "weighting": "metrics.comfort",
    "weighted": "metrics.comfort",
    "running_rms": "metrics.comfort",
    "vibration_dose": "metrics.comfort",
    "vibration_total": "metrics.totals",
    "seated_total": "metrics.totals",
    "whole_body_vibration": "metrics.comfort",
    "comfort": "metrics.comfort",
    "comfort_reactions": "metrics.comfort",
    "dynamic_load_coefficient": "metrics.loads",
    "road_stress_factor": "metrics.loads",
    "impact_factor": "metrics.impact",
    "aggregate_force": "metrics.loads",
    "road_wear": "metrics.loads",
    "spatial_repeatability": "metrics.loads",
    "contact_loss": "metrics.loads",
    "level_crossings": "metrics.fatigue",
    "rainflow": "metrics.fatigue",
    "rainflow_damage": "metrics.fatigue",
    "equivalent_amplitude": "metrics.fatigue",
    "spectral_damage": "metrics.fatigue",
    "receptance": "metrics.guideway",
    "mobility": "metrics.guideway",
    "accelerance": "metrics.guideway",
    "decay_rate": "metrics.guideway",
    "track_decay_rate": "metrics.guideway",
    "wave_decay_rate": "metrics.guideway",
    "ParameterError": "_basics.checks",
    "SolveError": "_basics.checks",
    "ValidityWarning": "_basics.checks",
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

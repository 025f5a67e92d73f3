"""The door of the package: every number becomes one of double precision there, and nothing masked comes in."""

from __future__ import annotations

import ast
import dataclasses
import inspect
import re
import tomllib
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from scipy import sparse

import movingfrf as mf
from movingfrf.scenarios.kind import snake_case
from movingfrf.scenarios.reading import _Builder
from tests.faults.fault import ROOT, SOURCE
from tests.helpers import PAVEMENT, SOIL
from tests.test_schema import IN_ORDER

ROAD = mf.track(PAVEMENT, SOIL)
RIGID = mf.RigidGuideway()
CAR = mf.quarter_car(
    body_mass=400.0, wheel_mass=40.0, suspension_stiffness=2e4, suspension_damping=1.5e3, tyre_stiffness=2e5
)
STATIONS = 0.25 * np.arange(161)
WAVE = mf.Profile(STATIONS, 1e-3 * np.sin(STATIONS))
TWO = mf.Profile(STATIONS, 1e-3 * np.sin(STATIONS[:, None] + [0.0, 1.0]))
RESULT = mf.simulate(RIGID, CAR, WAVE, speed=20.0, duration=1.0)
FINITE = mf.finite_track(ROAD, first=-20.0, last=40.0, element=0.5)
RINGING = mf.SampledGuideway(
    response=1e-6 * np.exp(-0.01 * np.arange(2000.0))[:, None], time_step=2**-10, offsets=[0.0], speed=20.0
)
PROCESS = mf.random_response(RIGID, CAR, mf.IsoRoad.of_class("B"), speed=20.0)
SHAKEN = np.sin(0.1 * np.arange(2048.0))
NUMBERS = (int, float)


DRESSES = {
    "single precision": lambda value: (
        np.int32(value)
        if isinstance(value, int)
        else np.float32(value)
        if float(np.float32(value)) == value
        else value
    ),
    "no axes": np.array,
    "double precision": lambda value: np.float64(value) if isinstance(value, float) else np.int64(value),
    "a fraction": lambda value: Fraction(value) if isinstance(value, float) and np.isfinite(value) else value,
    "a whole number": lambda value: (
        int(value) if isinstance(value, float) and np.isfinite(value) and value % 1 == 0 else value
    ),
}


def dressed(value, dress):
    """Put every number of tables or arguments, in lists too, into a dress."""
    if isinstance(value, dict):
        return {key: dressed(one, dress) for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        return type(value)(dressed(one, dress) for one in value)
    return dress(value) if type(value) in NUMBERS else value


def content(value):
    """Take a value apart; a number that is none of Python's is called by its type."""
    if isinstance(value, (np.generic, np.ndarray)):
        return (str(value.dtype), value.shape, value.tobytes()) if np.ndim(value) else f"{type(value)} {value}"
    if sparse.issparse(value):
        return content(value.toarray())
    if dataclasses.is_dataclass(value):
        names = [field.name for field in dataclasses.fields(value) if not field.name.startswith("_")]
        return type(value).__name__, [(name, content(getattr(value, name))) for name in names]
    if isinstance(value, dict):
        return [(key, content(one)) for key, one in value.items()]
    if isinstance(value, (list, tuple)):
        return [content(one) for one in value]
    if hasattr(value, "data_vars"):
        held = {str(name): one.values for name, one in {**value.data_vars, **value.coords}.items()}
        return content(held), content(value.attrs)
    if callable(value):
        return "a function"
    return type(value).__name__, value


def built(tables):
    builder = _Builder(ROOT / "examples")
    scenario = builder.scenario(tables, "a scenario", "")
    assert builder.faults == []
    return content(scenario.case)


@pytest.mark.parametrize(
    "name", [name for name, text in IN_ORDER.items() if "file =" not in text and "iso3095" not in name]
)
def test_every_kind_takes_numbers_in_any_dress(name):
    """Beams, foundations, vehicles, contacts, spectra, shapes, steps, forces and journeys, bit for bit."""
    tables = tomllib.loads(IN_ORDER[name])
    plain = built(tables)
    for dress in DRESSES.values():
        assert built(dressed(tables, dress)) == plain


TWICE = dict(time_step=2**-10, duration=0.5)
CALLS = {
    "simulate": lambda n: mf.simulate(RIGID, CAR, WAVE, **n(dict(speed=20.0, start=1.0, blend=4.0, **TWICE))),
    "truncation": lambda n: mf.simulate(ROAD, CAR, WAVE, **n(dict(speed=20.0, truncation=64.0, **TWICE))),
    "moving_loads": lambda n: mf.moving_loads(
        ROAD, n([[1e5]] * 100), n([0.0]), **n(dict(speed=20.0, time_step=2**-10, observe=[0.0, 1.5]))
    ),
    "transfer": lambda n: mf.transfer(ROAD, CAR, **n(dict(speed=20.0, frequency=[1.0, 2.5]))),
    "random_response": lambda n: mf.random_response(
        ROAD,
        mf.on_paths(CAR, n([1])),
        mf.IsoRoad.of_class("B", **n(dict(waviness=2.0, band=(2**-7, 4.0)))),
        **n(dict(speed=20.0, exposure=60.0, coherence=0.5, frequency=[1.0])),
    ),
    "cdfm": lambda n: mf.cdfm(
        FINITE, CAR, WAVE, **n(dict(speed=20.0, start=1.0, run_in=0.5, observe=[2.0], blend=4.0, **TWICE))
    ),
    "sim": lambda n: mf.sim(
        FINITE, CAR, WAVE, **n(dict(speed=20.0, run_in=0.5, iterations=100, tolerance=2**-20, **TWICE))
    ),
    "newmark_loads": lambda n: mf.newmark_loads(
        FINITE, n([[1e5]] * 100), n([0.0]), **n(dict(speed=20.0, time_step=2**-10, start=1.0))
    ),
    "duhamel": lambda n: mf.duhamel(RINGING, CAR, WAVE, **n(dict(speed=20.0, **TWICE))),
    "duhamel_loads": lambda n: mf.duhamel_loads(
        RINGING, n([[1e5]] * 100), n([0.0]), **n(dict(speed=20.0, time_step=2**-10))
    ),
    "struck": lambda n: mf.moving_impulse_response(
        FINITE,
        **n(
            dict(speed=20.0, offsets=[0.0, 1.0], strike=0.0, time_step=2**-10, band=20.0, duration=0.5, across=0.0)
        ),
    ),
    "struck_track": lambda n: mf.struck_track(
        ROAD, **n(dict(speed=20.0, offsets=[0.0], band=16.0, time_step=2**-9))
    ),
    "sampled": lambda n: mf.SampledGuideway(
        response=n([[2**-20], [2**-23]]),
        **n(dict(time_step=2**-7, offsets=[0.0], speed=20.0, critical_speed=300.0)),
    ),
    "moving_frf": lambda n: ROAD.moving_frf(
        n([0.0, 1.5]), n(20.0), n([1.0, 100.0]), across=n(0.5), derivative=n(1)
    ),
    "finite_track": lambda n: mf.finite_track(
        ROAD, **n(dict(first=-10.0, last=10.0, element=0.5, absorbing=3.0, band=30.0))
    ),
    "shear layer": lambda n: mf.ShearLayer(**n(dict(stiffness=8e6, damping=3e4, shear_stiffness=2e6))),
    "relaxing spring": lambda n: mf.RelaxingSpring(**n(dict(stiffness=8e6, relaxing_stiffness=4e6, damping=3e4))),
    "tensioned beam": lambda n: mf.TensionedBeam(beam=PAVEMENT, force=n(1e5)),
    "timoshenko beam": lambda n: mf.TimoshenkoBeam(
        **n(dict(bending_stiffness=1e7, mass=711.9, shear_stiffness=4e8, rotary_inertia=5.5))
    ),
    "at_offsets": lambda n: mf.at_offsets(
        lambda asked: (asked.ahead == 0) * asked.speed / (8e6 + 3e4j * asked.omega),
        n([0.0, 1.0]),
        n(20.0),
        n([1.0]),
    ),
    "scheme": lambda n: mf.cdfm(
        FINITE, CAR, WAVE, scheme=mf.Scheme(*n((0.25, 0.5, 0.0, 0.0))), **n(dict(speed=20.0, **TWICE))
    ),
    "finite_plate": lambda n: (
        mf.finite_plate(
            ROAD, **n(dict(width=3.0, first=-10.0, last=10.0, element=0.5, across=2, poisson=0.25, transverse=0.5))
        ).mass
    ),
    "finite_guideway": lambda n: mf.FiniteGuideway(
        mass=n([[2.0]]),
        damping=n([[0.125]]),
        stiffness=n([[1e4]]),
        interpolation=lambda at, derivative: sparse.csr_array(np.ones((len(at), 1))),
        **n(dict(interval=(0.0, 10.0), spacing=0.5)),
    ),
    "vehicle": lambda n: mf.Vehicle(
        mass=n([[10.0]]),
        damping=n([[0.0]]),
        stiffness=n([[0.0]]),
        contact_map=n([[1.0]]),
        contacts=[mf.Contact(**n(dict(position=0.0, stiffness=1e5, damping=10.0, path=1, across=0.5, cams=0.125)))],
        vertical=n([1.0]),
        dof_names=["body"],
    ),
    "hertzian_stiffness": lambda n: mf.hertzian_stiffness(**n(dict(load=6e4, wheel_radius=0.453125))),
    "convoy": lambda n: mf.convoy([CAR, CAR, CAR], gaps=n(10.125)),
    "train": lambda n: mf.train(car=CAR, **n(dict(count=3, spacing=10.125))),
    "realise": lambda n: mf.realise(
        mf.IsoRoad.of_class("B"), **n(dict(length=40.0, step=0.03125, start=1.0, seed=[1, 2]))
    ),
    "one surface": lambda n: mf.realise(
        mf.IsoRoad.of_class("B"),
        coherence=mf.ExponentialCoherence(decay=n(3.375)),
        **n(dict(length=40.0, step=0.03125, seed=1, across=[0.8, -0.8])),
    ),
    "realise_laplace": lambda n: mf.realise_laplace(
        mf.IsoRoad.of_class("B"), **n(dict(length=40.0, step=0.03125, kurtosis=6.375, segment=5.125))
    ),
    "density": lambda n: mf.IsoRoad(**n(dict(roughness=2**-16, waviness=2.125))).density(n([0.125, 1.375])),
    "variance": lambda n: mf.FraTrack.of_class(6, **n(dict(band=(2**-7, 2.0)))).variance_below(n([0.125, 1.375])),
    "isotropic": lambda n: mf.IsotropicCoherence(waviness=n(2.5)),
    "between": lambda n: mf.ExponentialCoherence(decay=n(2.5)).between(n([0.1, 1.5]), n(1.5)),
    "third_octave_levels": lambda n: mf.third_octave_levels(mf.iso3095_limit(), n([0.125, 0.0078125])),
    "profile": lambda n: mf.Profile(n([0.0, 0.125, 0.25, 0.375]), n([[0.125, 0.25]] * 4), across=n((0.8, -0.8))),
    "selected": lambda n: mf.selected(TWO, paths=n([1])),
    "prepared": lambda n: mf.prepared(WAVE, **n(dict(first=1.0, last=20.0, detrend=1, step=0.125, low_pass=2.5))),
    "cropped": lambda n: mf.cropped(WAVE, **n(dict(first=1.125, last=20.25))),
    "repaired": lambda n: mf.repaired(WAVE, **n(dict(spike=0.125, window=1.125, longest=2.25))),
    "detrended": lambda n: mf.detrended(WAVE, degree=n(2)),
    "high_passed": lambda n: mf.high_passed(WAVE, wavelength=n(10.125)),
    "low_passed": lambda n: mf.low_passed(WAVE, wavelength=n(10.125)),
    "resampled": lambda n: mf.resampled(WAVE, step=n(0.11)),
    "repeated": lambda n: mf.repeated(WAVE, **n(dict(length=100.125, overlap=2.25))),
    "mirrored": lambda n: mf.mirrored(WAVE, length=n(100.125)),
    "rolled": lambda n: mf.rolled(WAVE, radius=n(0.453125)),
    "iri": lambda n: mf.iri(WAVE, **n(dict(segment=20.125, average=0.375))),
    "ride_number": lambda n: mf.ride_number(WAVE, **n(dict(segment=20.125, average=0.375))),
    "weighting": lambda n: mf.weighting("Wk", n([0.7, 10.125])),
    "weighted": lambda n: mf.weighted(n(SHAKEN.tolist()), n(2**-8)),
    "running_rms": lambda n: mf.running_rms(n(SHAKEN.tolist()), **n(dict(time_step=2**-8, window=0.5))),
    "vibration_dose": lambda n: mf.vibration_dose(n(SHAKEN.tolist()), n(2**-8), since=n(0.125)),
    "vibration_total": lambda n: mf.vibration_total(n([0.375, 0.25]), n([1.4, 1.0])),
    "seated_total": lambda n: mf.seated_total(n({"seat z": 0.375, "feet x": 0.125})),
    "whole_body_vibration": lambda n: mf.whole_body_vibration(n(SHAKEN.tolist()), n(2**-8), since=n(0.125)),
    "comfort": lambda n: mf.comfort(RESULT, "body", since=n(0.125)),
    "comfort_reactions": lambda n: mf.comfort_reactions(n(0.315)),
    "assess": lambda n: mf.assess(RESULT, **n(dict(slope=4.125, since=0.125, contacts=[0]))),
    "road_stress_factor": lambda n: mf.road_stress_factor(n([0.125, 0.375])),
    "measures": lambda n: mf.measures(RESULT, since=n(0.125)),
    "dynamic_load_coefficient": lambda n: mf.dynamic_load_coefficient(RESULT, since=n(0.125)),
    "contact_loss": lambda n: mf.contact_loss(RESULT, since=n(0.125)),
    "impact_factor": lambda n: mf.impact_factor(RESULT, **n(dict(percentile=90.125, since=0.125))),
    "aggregate_force": lambda n: mf.aggregate_force(RESULT, **n(dict(power=4.125, spacing=0.375, since=0.125))),
    "road_wear": lambda n: mf.road_wear(RESULT, **n(dict(power=4.125, percentile=90.125, since=0.125))),
    "spatial_repeatability": lambda n: mf.spatial_repeatability(
        RESULT, RESULT, **n(dict(spacing=0.375, since=0.125))
    ),
    "level_crossings": lambda n: mf.level_crossings(n(SHAKEN.tolist()), n([0.125])),
    "rainflow": lambda n: mf.rainflow(n(SHAKEN.tolist())),
    "rainflow_damage": lambda n: mf.rainflow_damage(n(SHAKEN.tolist()), **n(dict(slope=4.125, strength=1e3))),
    "equivalent_amplitude": lambda n: mf.equivalent_amplitude(
        n(SHAKEN.tolist()), **n(dict(slope=4.125, duration=8.25, rate=1.125))
    ),
    "spectral_damage": lambda n: mf.spectral_damage(
        n([1.0, 2.125, 3.375]), n([0.125, 0.25, 0.125]), **n(dict(slope=4.125, strength=1e3))
    ),
    "spectral_fatigue": lambda n: mf.spectral_fatigue(
        PROCESS, "contact_force", **n(dict(slope=4.125, strength=1e3))
    ).to_dataset(name="damage"),
    "receptance": lambda n: mf.receptance(ROAD, n([1.125, 5.0]), ahead=n(0.375), speed=n(10.125)),
    "decay_rate": lambda n: mf.decay_rate(n([1.0, 0.5, 0.125]), n([0.0, 0.125, 0.4])),
    "track_decay_rate": lambda n: mf.track_decay_rate(ROAD, n([300.375]), spacing=n(0.625)),
    "wave_decay_rate": lambda n: mf.wave_decay_rate(ROAD, n([300.375])),
}


# Tables of a truck or of an assembly, without a kind of their own; and what takes minutes or a file.
OTHERS = {
    "Axle",
    "Body",
    "Design",
    "Hinge",
    "Suspension",
    "Unit",
    "accelerance",
    "compare",
    "design",
    "optimise",
    "read_profile",
    "struck_plate",
    "sweep",
}


def test_every_public_function_is_among_them():
    here, kinds = Path(__file__).read_text(encoding="utf-8"), "".join(IN_ORDER.values()).replace("'", '"')
    tried = {name for name in mf.__all__ if f"mf.{name}(" in here or f'"{snake_case(name)}"' in kinds}
    of_numbers = {
        name
        for name in mf.__all__
        if name not in tried | OTHERS
        and (inspect.isfunction(getattr(mf, name)) or dataclasses.is_dataclass(getattr(mf, name)))
        and re.search("float|int|ArrayLike", str(inspect.signature(getattr(mf, name))))
    }
    assert of_numbers <= {name for name in mf.__all__ if f"mf.{name}.of_class" in here}


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
@pytest.mark.parametrize("name", CALLS)
def test_every_function_takes_numbers_in_any_dress(name):
    call = CALLS[name]
    plain = content(call(lambda value: value))
    for dress in DRESSES.values():
        found = content(call(lambda value, dress=dress: dressed(value, dress)))
        assert found == plain


def test_single_precision_of_a_whole_number_is_that_number():
    """`np.float32(20)` as a speed was 1.7e-5 off, `np.array(20.0)` refused."""
    for speed in (np.float32(20), np.array(20.0), np.int64(20), Fraction(20), 20):
        found = mf.simulate(RIGID, CAR, WAVE, speed=speed, duration=1.0)
        assert np.array_equal(found.contact_force.values, RESULT.contact_force.values)
        assert found.attrs == RESULT.attrs


NO_NUMBER = [True, np.True_, np.array(True), np.array([20.0]), np.ma.masked, np.ma.array(20.0, mask=True), "20", 2j]


@pytest.mark.parametrize("speed", NO_NUMBER, ids=str)
def test_what_is_no_number_stays_none(speed):
    with pytest.raises(ValueError, match=r"speed must be a positive number \[m/s\], got"):
        mf.simulate(RIGID, CAR, WAVE, speed=speed, duration=1.0)
    with pytest.raises(ValueError, match="stiffness must be a positive number"):
        mf.Contact(position=0.0, stiffness=speed)


def masked(values, *places):
    array = np.ma.array(values, dtype=float)
    for place in places:
        array[place] = np.ma.masked
    return array


HIDDEN = masked(np.where(np.arange(161) == 7, -9999.0, 0.0), 7)
ROWS = np.ma.array(np.zeros((161, 2)), mask=np.arange(322).reshape(161, 2) == 15)
FORCE = masked(np.full((100, 1), 1e5), (7, 0))
MASKED = [
    (
        lambda: mf.Profile(STATIONS, HIDDEN),
        r"elevation must be finite .* m throughout, got a masked value at index 7",
    ),
    (lambda: mf.Profile(STATIONS, ROWS), r"elevation .* m throughout, got a masked value at index \(7, 1\)"),
    (lambda: mf.Profile(STATIONS, list(ROWS)), r"elevation .* got a masked value at index \(7, 1\)"),
    (lambda: mf.Profile(masked(STATIONS, 3), 0 * STATIONS), "distance .* got a masked value at index 3"),
    (lambda: mf.Profile([0, 1, np.ma.masked, 3], [0.0] * 4), "distance .* got a masked value at index 2"),
    (lambda: mf.Profile(STATIONS, ROWS.data, across=masked([0, 1], 1)), "across .* got a masked value at index 1"),
    (lambda: mf.moving_loads(ROAD, FORCE, [0.0], speed=20.0), r"force .* N throughout, got a masked .*\(7, 0\)"),
    (
        lambda: mf.moving_loads(ROAD, FORCE.data, masked([0.0], 0), speed=20.0),
        "positions .* masked value at index 0",
    ),
    (lambda: mf.newmark_loads(FINITE, FORCE, [0.0], speed=20.0), r"force .* masked value at index \(7, 0\)"),
    (lambda: mf.duhamel_loads(RINGING, FORCE, [0.0], speed=20.0), r"force .* masked value at index \(7, 0\)"),
    (
        lambda: mf.SampledGuideway(response=FORCE, time_step=0.01, offsets=[0.0], speed=20.0),
        r"response .* m/\(N s\) throughout, got a masked value at index \(7, 0\)",
    ),
    (
        lambda: mf.Vehicle(
            mass=np.ma.array([[10.0]], mask=True),
            damping=[[0.0]],
            stiffness=[[0.0]],
            contact_map=[[1.0]],
            contacts=[mf.Contact(position=0.0, stiffness=1e5)],
            vertical=[1.0],
            dof_names=["body"],
        ),
        r"mass .* kg throughout, got a masked value at index \(0, 0\)",
    ),
    (
        lambda: mf.FiniteGuideway(
            mass=np.ma.array([[10.0]], mask=True),
            damping=[[0.0]],
            stiffness=[[1.0]],
            interpolation=lambda at, derivative: sparse.csr_array(np.ones((len(at), 1))),
            interval=(0.0, 1.0),
        ),
        r"mass must be finite throughout \[kg\]",
    ),
    (
        lambda: mf.half_car(
            body_mass=1e3,
            pitch_inertia=1e3,
            wheel_masses=masked([40.0, 40.0], 1),
            suspension_stiffness=(2e4, 2e4),
            suspension_damping=(1e3, 1e3),
            tyre_stiffness=(2e5, 2e5),
            axles=(1.0, -1.0),
        ),
        r"wheel_masses\[1\] must be a positive number \[kg\], got masked",
    ),
    (lambda: mf.convoy([CAR] * 3, gaps=masked([9.0, 9.0], 1)), "gaps .* got a masked value at index 1"),
    (
        lambda: mf.TabulatedSpectrum(spatial_frequency=[0.1, 1.0], spectral_density=masked([1e-6, 1e-8], 1)),
        "spectral_density .* m³ throughout, got a masked value at index 1",
    ),
    (
        lambda: mf.IsoRoad.of_class("A").density(masked([0.1, 1.0], 1)),
        "spatial_frequency .* masked value at index 1",
    ),
    (lambda: mf.IsotropicCoherence().between(masked([0.1, 1.0], 1), 1.5), "spatial_frequency .* value at index 1"),
    (lambda: mf.ExponentialCoherence(decay=1.0).between([0.1], masked([0.1, 1.0], 1)), "apart .* value at index 1"),
    (lambda: RINGING.columns(masked([0.0], 0)), "ahead .* got a masked value at index 0"),
    (lambda: mf.third_octave_levels(mf.iso3095_limit(), masked([0.1], 0)), "wavelength .* masked value at index 0"),
    (lambda: mf.realise(mf.IsoRoad.of_class("A"), length=40.0, across=masked([1, 0], 1)), "across .* index 1"),
    (
        lambda: mf.whole_body_vibration(masked(SHAKEN, 9), 0.01),
        "acceleration .* m/s² throughout, got a masked .* 9",
    ),
    (lambda: mf.weighted(masked(SHAKEN, 9), 0.01), r"acceleration .* got a masked value at index"),
    (lambda: mf.running_rms(masked(SHAKEN, 9), 0.01), "values .* got a masked value at index"),
    (lambda: mf.weighting("Wk", masked([1.0, 2.0], 1)), "frequency .* got a masked value at index 1"),
    (lambda: mf.vibration_total(masked([0.1, 0.2], 1)), "rms .* got a masked value at index 1"),
    (lambda: mf.rainflow(masked(SHAKEN, 9)), "values .* got a masked value at index 9"),
    (lambda: mf.road_stress_factor(masked([0.1, 0.2], 1)), "coefficient must be at least zero throughout, got nan"),
    (
        lambda: mf.spectral_damage([1.0, 2.0], masked([0.1, 0.1], 1), slope=4.0),
        "density .* masked value at index 1",
    ),
    (
        lambda: mf.transfer(ROAD, CAR, speed=20.0, frequency=masked([1.0], 0)),
        "frequency .* masked value at index 0",
    ),
    (lambda: mf.mobility(ROAD, [1.0], ahead=masked([0.0, 1.0], 1)), "ahead .* got a masked value at index 1"),
    (lambda: mf.decay_rate(masked([1.0, 0.5], 1), [0.0, 1.0]), "response must be finite"),
    (lambda: ROAD.moving_frf(masked([0.0, 1.0], 1), 20.0, [1.0]), "ahead .* got a masked value at index 1"),
    (lambda: ROAD.moving_frf(0.0, 20.0, masked([0.0, 1.0], 1)), "omega must be finite"),
]


@pytest.mark.parametrize(("call", "message"), MASKED)
def test_what_lies_below_a_mask_is_no_number(call, message):
    with pytest.raises(ValueError, match=message):
        call()


def test_a_mask_that_hides_nothing_is_none():
    bare = mf.Profile(STATIONS, np.sin(STATIONS))
    assert content(mf.Profile(np.ma.array(STATIONS), np.ma.array(np.sin(STATIONS)))) == content(bare)
    assert mf.vibration_total(np.ma.array([3.0, 4.0])) == 5.0


@pytest.mark.parametrize(
    "values", [[True, 1.0, 2.0, 3.0], [0.0, np.True_, 2.0, 3.0], [[0.0], [1.0], [2.0], [True]]]
)
def test_true_in_a_list_is_no_number(values):
    with pytest.raises(ValueError, match=r"elevation must be an array of numbers \[m\]"):
        mf.Profile([0.0, 1.0, 2.0, 3.0], values)


def test_true_in_a_list_of_a_file_is_no_number(tmp_path):
    file = tmp_path / "vehicle.toml"
    rest = (
        "damping = [[0.0]]\nstiffness = [[0.0]]\ncontact_map = [[1.0]]\nposition = [0.0]\ncontact_stiffness = [1e5]"
    )
    file.write_text(f"mass = [[true]]\n{rest}\n", encoding="utf-8")
    with pytest.raises(ValueError, match="mass must be a matrix of real numbers: true and false are no numbers"):
        mf.read_vehicle(file)


def thrown_away(path: Path) -> list[str]:
    """Find checks of an argument whose result is given no name, so that what was given is used."""
    checks = {"finite", "positive", "positive_or_infinite", "not_negative", "whole", "array", "pair", "spread"}
    tree = ast.parse(path.read_text(encoding="utf-8"))
    above = {below: node for node in ast.walk(tree) for below in ast.iter_child_nodes(node)}
    found = []
    for call in ast.walk(tree):
        if not (isinstance(call, ast.Call) and isinstance(call.func, ast.Attribute) and call.func.attr in checks):
            continue
        if not (
            len(call.args) > 1 and isinstance(call.args[0], ast.Constant) and isinstance(call.args[1], ast.Name)
        ):
            continue
        node: ast.AST = call
        while not isinstance(node, (ast.stmt, ast.NamedExpr)):
            node = above[node]
        function = node
        while not isinstance(function, ast.FunctionDef):
            function = above[function]
        given = any(argument.arg == "check" for argument in function.args.args)
        stores = given or re.search(r"checking\(\w", ast.unparse(function))
        if not stores and not isinstance(node, (ast.Assign, ast.NamedExpr, ast.Return)):
            found.append(f"{path.name}:{call.lineno}: {call.args[1].id}")
    return found


def test_what_was_checked_is_what_is_used():
    assert [line for path in sorted(SOURCE.rglob("*.py")) for line in thrown_away(path)] == []

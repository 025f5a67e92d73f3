"""Random roads: statistics of a response, its integrals, what is refused."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import gamma
from scipy.stats import norm
from threadpoolctl import threadpool_info, threadpool_limits

import movingfrf as mf
from movingfrf._basics.compiling import compiling
from movingfrf.metrics.fatigue import METHODS
from movingfrf.metrics.measures import random_measures
from movingfrf.response.batches import solved
from movingfrf.response.quadrature import PANELS, resolved
from movingfrf.response.statistics import peak_factor
from movingfrf.results.labels import RANDOM_QUANTITIES
from tests.helpers import QUARTER_CAR, QUARTER_TRUCK, VEHICLES
from tests.laws.random_parts import CAR, GROUND, ISOTROPIC, RIGID, ROAD, respond

pytestmark = pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")


@cache
def reference_case():
    """Half truck on a road of class B at 20 m/s."""
    return mf.random_response(ROAD, VEHICLES["half_truck"], mf.IsoRoad.of_class("B"), speed=20.0)


# Statistics


def test_peak_factor():
    """The mean of the distribution by QUADPACK; Davenport's expansion of it, good to its next term."""
    for count in (0.1, 3.0, 1e3, 1e7):
        middle = np.sqrt(2 * np.log(max(count, 1.1)))
        exact = quad(lambda u, n=count: -np.expm1(-n * np.exp(-u * u / 2)), 0, middle + 9, points=[middle])[0]
        assert peak_factor(count) == pytest.approx(exact, rel=1e-7)
        if count > 100:
            assert peak_factor(count) == pytest.approx(middle + np.euler_gamma / middle, rel=1.5 / middle**4)
    assert peak_factor(0.0) == 0.0


def test_expected_peak_of_a_longer_journey():
    short, long = (respond(exposure=seconds) for seconds in (60.0, 3600.0))
    factor = peak_factor(60.0 * short.contact_force_crossing_rate.values)
    assert short.contact_force_expected_peak.values == pytest.approx(factor * short.contact_force_rms.values)
    assert (long.contact_force_expected_peak > 1.2 * short.contact_force_expected_peak).all()
    assert (long.contact_force_rms == short.contact_force_rms).all()


def test_contact_that_would_be_lost():
    """Gauss: share below zero; Rice: how often. On a good road neither is worth a word."""
    with pytest.warns(
        mf.ValidityWarning,
        match=r"contact 0 \(wheel\) would lift off the road about",
    ):
        rough = respond("quarter_car", spectrum=replace(GROUND, roughness=1e-3), speed=25.0, coherence=None)
    (finding,) = json.loads(rough.attrs["findings"])
    assert finding["code"] == "contact_lost"
    level = (rough.static_load / rough.contact_force_rms).item()
    assert rough.lift_off_share.item() == pytest.approx(norm.sf(level), rel=1e-12)
    rate = rough.contact_force_crossing_rate.item() * np.exp(-(level**2) / 2)
    assert rough.lift_off_rate.item() == pytest.approx(rate, rel=1e-12)
    assert rough.dynamic_load_coefficient.item() == pytest.approx(1 / level, rel=1e-12)
    assert json.loads(respond().attrs["findings"]) == []


def test_force_up_to_the_end_of_the_band():
    stiff = mf.quarter_car(**(QUARTER_CAR | {"tyre_damping": 2e4}))
    with pytest.warns(
        mf.ValidityWarning, match=r"lies in the highest tenth of the spectrum's band \(up to 5 cycle/m"
    ):
        respond(stiff, coherence=None)


def test_near_the_critical_speed():
    with pytest.warns(mf.ValidityWarning, match="critical speed"):
        result = respond("quarter_car", speed=0.9 * ROAD.critical_speed, coherence=None)
    assert "critical_speed" in [finding["code"] for finding in json.loads(result.attrs["findings"])]


def test_weighted_acceleration():
    """Weighted on a fine grid of its own (trapezoids: (Δf)² times the curvature of a resonance, below 1e-4)."""
    from movingfrf.metrics.comfort import weighting

    result = respond("half_truck", coherence=None)
    frequency = np.linspace(*(15.0 * n for n in GROUND.band), 20_000)
    fine = respond("half_truck", coherence=None, frequency=frequency)
    for dof, name in (("bounce", "Wk"), ("pitch", "We"), ("front_wheel", "Wk")):
        weighted = np.abs(weighting(name, frequency)) ** 2 * fine.acceleration_density.sel(dof=dof).values
        expected = np.sqrt(np.trapezoid(weighted, frequency))
        assert result.weighted_acceleration.sel(dof=dof).item() == pytest.approx(expected, rel=1e-4)


@pytest.mark.parametrize("slope", [3.0, 5.0])
def test_fatigue_of_a_narrow_band(slope):
    """ν₀ (√2 σ)^m Γ(1 + m/2)/C, from the same crossing rate and root mean square."""
    result = respond(coherence=None)
    damage = mf.spectral_fatigue(result, "contact_force", slope=slope, strength=1e20, method="narrow_band")
    rms, rate = result.contact_force_rms.values, result.contact_force_crossing_rate.values
    expected = rate * (np.sqrt(2) * rms) ** slope * gamma(1 + slope / 2) / 1e20
    assert damage.values == pytest.approx(expected, rel=1e-9)
    assert damage.dims == ("contact",)
    assert damage.attrs["units"] == "1/s"
    # Cycles of a wide band are fewer or smaller.
    dirlik = mf.spectral_fatigue(result, "contact_force", slope=slope, strength=1e20)
    assert (dirlik < damage).all()
    with pytest.raises(mf.ParameterError, match="quantity must be one of contact_force, deflection"):
        mf.spectral_fatigue(result, "force", slope=slope)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("slope", [2.0, 4.0, 10.0])
def test_fatigue_on_the_reference_case_is_positive(method, slope):
    """And no more than a narrow band's; irregularities go down to 0.08, where a formula may leave its range."""
    result = reference_case()
    for quantity in RANDOM_QUANTITIES:
        found = mf.spectral_fatigue(result, quantity, slope=slope, method=method)
        assert (found > 0).all()
        assert (
            found <= mf.spectral_fatigue(result, quantity, slope=slope, method="narrow_band") * (1 + 1e-6)
        ).all()


def test_what_is_no_random_response():
    history = mf.simulate(
        ROAD,
        VEHICLES["half_truck"],
        mf.harmonic(amplitude=0.01, wavelength=4.0, length=40.0),
        speed=10.0,
        duration=1.0,
        start=5.0,
    )
    for result in (history, None):
        for call in (lambda r: mf.spectral_fatigue(r, "contact_force", slope=4.0), random_measures):
            with pytest.raises(mf.ParameterError, match="result must be the response to a random road"):
                call(result)


def test_measures_of_a_random_response():
    result = respond(coherence=None)
    found = {(measure.quantity, measure.name): measure for measure in random_measures(result)}
    assert found["contact 1 force", "rms"].value == result.contact_force_rms.values[1]
    assert found["contact 1 force", "rms"].units == "N"
    assert found["pitch acceleration", "weighted rms (We)"].units == "rad/s²"
    total = found["contact 0 force", "static"].value + found["contact 0 force", "expected peak"].value
    assert found["contact 0 load", "expected largest"].value == total


# Quadrature


def test_peaks_and_combs_are_resolved():
    """A Lorentzian 1e-6 wide and a comb of 200 teeth, whose integrals are known."""

    def density(f):
        return np.stack([1e-6 / ((f - np.pi) ** 2 + 1e-12), 1 + np.cos(2 * np.pi * 20 * f) + 0 * f], axis=1)

    lines = resolved(density, np.array([1.0, 4.0, 11.0]), powers=(0, 2), comparable=np.eye(2))
    first = np.arctan((11 - np.pi) / 1e-6) + np.arctan((np.pi - 1) / 1e-6)
    assert lines.moment(0) == pytest.approx([first, 10.0], rel=1e-8)
    # ∫f² cos(ωf) df over whole periods: 2f cos(ωf)/ω².
    teeth = (11**3 - 1) / 3 + 20.0 / (2 * np.pi * 20) ** 2
    assert lines.moment(2)[1] == pytest.approx(teeth, rel=1e-8)
    assert (np.diff(lines.frequency) > 0).all()


def test_a_resonance_without_damping_has_no_mean_square():
    """Refused with its frequency; on a road that carries energy away the same car has a response."""
    bare = mf.quarter_car(**(QUARTER_CAR | {"suspension_damping": 0.0, "tyre_damping": 0.0}))
    at = bare.natural_frequencies[0]
    with pytest.raises(mf.SolveError, match=f"cannot be resolved near {at:.4g} Hz: a vibration without damping"):
        respond(bare, RIGID, coherence=None)
    assert np.isfinite(respond(bare, coherence=None).acceleration_rms).all()


@pytest.mark.parametrize(("speed", "band"), [(1e-9, "2e-11 to 5e-09"), (1e8, r"2e\+06 to 5e\+08")])
def test_rounding_is_not_blamed_on_damping(monkeypatch, speed, band):
    """At speeds at which the band lies nowhere near the vehicle; given up early, since it never ends well."""
    monkeypatch.setattr("movingfrf.response.quadrature.PANELS", replace(PANELS, most_panels=500))
    with pytest.raises(
        mf.SolveError, match=f"near .* Hz: no vibration of the vehicle is without .* rounding .* is {band} Hz"
    ):
        respond("quarter_car", RIGID, coherence=None, speed=speed)


# Refusals


class Impossible:
    """Neighbours alike, the outer two opposed: no road is like that."""

    def between(self, spatial_frequency, apart):
        return np.where(np.abs(apart) > 1.0, -1.0, np.ones_like(apart)) * np.ones((spatial_frequency.size, 1, 1))


class Wrong:
    """A model that returns something else than it should."""

    def __init__(self, change):
        self.change = change

    def between(self, spatial_frequency, apart):
        return self.change(ISOTROPIC.between(spatial_frequency, apart))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            lambda shared: shared[:, 0],
            r"must return an array \(frequency, path, path\), \(.*, 2, 2\), got \(.*, 2\)",
        ),
        (lambda shared: None, "must return an array"),
        (lambda shared: shared + 0j, "must return real, finite numbers"),
        (lambda shared: np.nan * shared, "must return real, finite numbers"),
        (lambda shared: 0.5 * shared, "must be 1 between a path and itself"),
        (lambda shared: np.triu(shared), "must be the same from left to right"),
    ],
)
def test_coherence_that_breaks_the_contract(change, message):
    with pytest.raises(mf.ParameterError, match=f"coherence {message}"):
        respond("full_truck", coherence=Wrong(change))


@pytest.mark.parametrize("coherence", ["isotropic", [1.0, 0.5], mf.IsotropicCoherence])
def test_what_is_no_coherence(coherence):
    for vehicle in ("half_truck", "full_truck"):
        with pytest.raises(
            mf.ParameterError, match=r"coherence must be a model, as IsotropicCoherence\(\) is, or a"
        ):
            respond(vehicle, coherence=coherence)


def test_what_is_no_vehicle_and_no_spectrum():
    with pytest.raises(mf.ParameterError, match="vehicle must be a Vehicle, got None"):
        mf.random_response(ROAD, None, GROUND, speed=1.0)
    with pytest.raises(mf.ParameterError, match="vehicle must be a Vehicle, got None"):
        mf.transfer(ROAD, None, speed=1.0, frequency=[1.0])
    with pytest.raises(
        mf.ParameterError,
        match="spectrum must be a roughness spectrum, as IsoRoad is, got the class IsoRoad itself",
    ):
        respond(spectrum=mf.IsoRoad, coherence=None)


@pytest.mark.parametrize("name", ["half_truck", "three_axles"])
def test_small_matrices_are_solved_by_one_thread(monkeypatch, name):
    """LAPACK's threads would wait for each other, and those of BLAS gain nothing on thin products."""
    seen = []

    def watched(*arguments):
        seen.extend(pool["num_threads"] for pool in threadpool_info() if pool["user_api"] == "blas")
        return solved(*arguments)

    monkeypatch.setattr("movingfrf.response.system.solved", watched)
    with threadpool_limits(limits=2), compiling(False):
        respond(name, coherence=None)
    assert set(seen) == {1}


def test_what_is_refused():
    with pytest.raises(mf.ParameterError, match="coherence is needed, since the contacts follow 2 paths"):
        respond("full_truck", coherence=None)
    with pytest.raises(mf.ParameterError, match=r"coherence must be at most 1, got 1\.5"):
        respond("full_truck", coherence=1.5)
    with pytest.raises(mf.ParameterError, match="coherence must not be negative"):
        respond("full_truck", coherence=-0.5)
    with pytest.raises(
        mf.ParameterError,
        match="must be a roughness spectrum, as IsoRoad is, got a Profile; `simulate` takes a profile",
    ):
        respond(spectrum=mf.bump(height=0.1, width=1.0, at=1.0, length=9.0))
    with pytest.raises(mf.ParameterError, match="exposure must be positive"):
        respond(exposure=0.0)
    with pytest.raises(mf.ParameterError, match="speed must be positive"):
        respond(speed=-1.0)
    with pytest.raises(
        mf.ParameterError, match=r"frequency must hold frequencies of at least zero \[Hz\], got -1 Hz"
    ):
        respond(frequency=[1.0, -1.0])
    with pytest.raises(mf.ParameterError, match=r"frequency must hold .* got none"):
        mf.transfer(ROAD, CAR, speed=1.0, frequency=[])
    with pytest.raises(ValueError, match="guideway must have a moving FRF"):
        respond(road=None)
    three = [
        replace(contact, path=n, across=0.7 * (n - 1)) for n, contact in enumerate(VEHICLES["three_axles"].contacts)
    ]
    with pytest.raises(ValueError, match="coherence must be positive semidefinite over the paths of the vehicle"):
        respond(replace(VEHICLES["three_axles"], contacts=three), coherence=Impossible())


def test_an_unstable_vehicle_is_refused():
    lively = mf.track(ROAD.beam, replace(ROAD.foundation, damping=3e3))
    slack = {"suspension_stiffness": 1.5e6, "suspension_damping": 3e3, "tyre_damping": 0.0}
    truck = mf.quarter_car(**(QUARTER_TRUCK | slack))
    for call in (
        lambda: respond(truck, lively, speed=195.0, coherence=None),
        lambda: mf.transfer(lively, truck, speed=195.0, frequency=[1.0]),
    ):
        with pytest.raises(mf.SolveError, match="unstable together"):
            call()

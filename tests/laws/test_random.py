"""Laws and closed forms of the random response and of the transfer functions it is made of."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import scipy.linalg
from scipy.integrate import quad, simpson
from scipy.special import gamma
from scipy.stats import norm
from threadpoolctl import threadpool_info, threadpool_limits

import movingfrf as mf
from movingfrf.metrics.fatigue import METHODS
from movingfrf.metrics.measures import random_measures
from movingfrf.response.batches import solve_contacts
from movingfrf.response.quadrature import PANELS, resolved
from movingfrf.response.statistics import peak_factor
from movingfrf.results.labels import RANDOM_QUANTITIES
from tests.helpers import DAMPED, QUARTER_CAR, QUARTER_TRUCK, UNDAMPED, VEHICLES

pytestmark = pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")

ROAD, RIGID = DAMPED["euler_bernoulli_winkler"], mf.RigidGuideway()
GROUND = mf.IsoRoad.of_class("A", band=(0.02, 5.0))
ISOTROPIC = mf.IsotropicCoherence()

# Four equal corners: bounce, pitch and roll do not mix.
SYMMETRIC = {
    "body_mass": 1200.0,
    "pitch_inertia": 1800.0,
    "wheel_masses": (40.0, 40.0),
    "suspension_stiffness": (2.0e4, 2.0e4),
    "suspension_damping": (1.5e3, 1.5e3),
    "tyre_stiffness": (2.0e5, 2.0e5),
    "tyre_damping": (100.0, 100.0),
    "axles": (1.3, -1.3),
}
WHEELBASE = 2.6
CAR = mf.full_car(**SYMMETRIC, roll_inertia=500.0, sides=(0.7, -0.7))


@cache
def reference_case():
    """Half truck on a road of class B at 20 m/s."""
    return mf.random_response(ROAD, VEHICLES["half_truck"], mf.IsoRoad.of_class("B"), speed=20.0)


STATISTICS = ("rms", "crossing_rate", "peak_rate", "irregularity", "expected_peak")


def respond(vehicle="half_truck", road=ROAD, spectrum=GROUND, *, speed=15.0, coherence=ISOTROPIC, **more):
    vehicle = VEHICLES[vehicle] if isinstance(vehicle, str) else vehicle
    return mf.random_response(road, vehicle, spectrum, speed=speed, coherence=coherence, **more)


def statistics(result):
    return {f"{name}_{kind}": result[f"{name}_{kind}"].values for name in RANDOM_QUANTITIES for kind in STATISTICS}


# Transfer functions


@pytest.mark.parametrize("name", ["half_truck", "full_truck", "footprint"])
def test_a_wave_in_the_road_does_what_the_transfer_functions_say(name):
    """The late part of `simulate` over a sine wave, amplitude and phase of every output.

    After 20 s the slowest vibration has decayed by e^(−0.37·20) = 6e-4, and it is fitted as well as the wave; the
    profile's spline through 50 points per wave is true to 1e-6.
    """
    vehicle, speed, wavelength, step = VEHICLES[name], 10.0, 4.0, 2e-3
    omega = 2 * np.pi * speed / wavelength
    wave = mf.harmonic(amplitude=1e-3, wavelength=wavelength, length=320.0, start=-5.0)
    result = mf.simulate(ROAD, vehicle, wave, speed=speed, duration=30.0, time_step=step)
    # Elevation 1e-3 sin(2π(x_j + vt)/λ) = Im[1e-3 e^{iω(t + x_j/v)}].
    seen = 1e-3 * np.exp(1j * omega * vehicle.positions / speed)
    found = mf.transfer(ROAD, vehicle, speed=speed, frequency=[speed / wavelength])
    late = result.time.values >= 20.0
    time = result.time.values[late]
    exponents = [
        1j * omega,
        *(1j * np.pi * 2 * vehicle.natural_frequencies * np.sqrt(1 - vehicle.damping_ratios**2)),
    ]
    decay = np.array([0.0, *(2 * np.pi * vehicle.natural_frequencies * vehicle.damping_ratios)])
    waves = np.exp(np.outer(time, exponents) - np.outer(time - 20.0, decay))
    basis = np.hstack([np.ones((time.size, 1)), waves.real, waves.imag])
    for quantity in ("contact_force", "deflection", "acceleration"):
        fit = np.linalg.lstsq(basis, result[quantity].values[late], rcond=None)[0]
        # a cos + b sin = Im[(b + ia) e^{iωt}]
        measured = fit[1 + len(exponents)] + 1j * fit[1]
        predicted = found[quantity].values[0] @ seen
        assert np.abs(measured - predicted).max() < 2e-4 * np.abs(predicted).max()


@pytest.mark.parametrize("name", VEHICLES)
def test_at_rest_the_vehicle_follows_the_road(name):
    """Raised under all contacts together, the road lifts vehicle and wheels by as much, at no force."""
    vehicle = VEHICLES[name]
    found = mf.transfer(ROAD, vehicle, speed=10.0, frequency=[0.0]).sum("source")
    stiffness = np.abs(mf.transfer(ROAD, vehicle, speed=10.0, frequency=[31.0]).contact_force).max().item()
    assert np.abs(found.motion.values[0] + np.asarray(vehicle.vertical)).max() < 1e-9
    assert np.abs(found.contact_force.values).max() < 1e-9 * stiffness


def test_acceleration_is_the_second_derivative_of_motion():
    found = mf.transfer(ROAD, VEHICLES["half_truck"], speed=10.0, frequency=[0.0, 1.0, 30.0])
    assert np.allclose(found.acceleration, -(found.omega**2) * found.motion, rtol=1e-13, atol=0)
    assert found.omega.values.tolist() == pytest.approx([0.0, 2 * np.pi, 60 * np.pi])


# Closed forms


@pytest.mark.parametrize("speed", [10.0, 30.0])
def test_quarter_car_on_a_rigid_road_by_lyapunov(speed):
    """Waviness 2: the road's velocity is white, and the covariance of the state solves a Lyapunov equation.

    The velocity ṙ has the two-sided density 2π² G_d(n₀) n₀² v per Hz. Below the band of 1e-6 to 1e5 cycle/m nothing
    is missing; above it the force k_t r has lost 1e-6 of its variance at most.
    """
    car = QUARTER_CAR | {"tyre_damping": 0.0}
    m, u, k, c, t = (
        car[name]
        for name in ("body_mass", "wheel_mass", "suspension_stiffness", "suspension_damping", "tyre_stiffness")
    )
    # Stretch of the suspension, velocity of the body, of the tyre, of the wheel; up.
    state = np.array([[0, 1, 0, -1], [-k / m, -c / m, 0, c / m], [0, 0, 0, 1], [k / u, c / u, -t / u, -c / u]])
    drive = np.diag([0.0, 0.0, 1.0, 0.0]) * 2 * np.pi**2 * 16e-6 * 0.1**2 * speed
    covariance = scipy.linalg.solve_continuous_lyapunov(state, -drive)
    found = respond(
        mf.quarter_car(**car), RIGID, mf.IsoRoad(roughness=16e-6, band=(1e-6, 1e5)), speed=speed, coherence=None
    )
    body = np.sqrt(state[1] @ covariance @ state[1])
    assert found.acceleration_rms.sel(dof="body").item() == pytest.approx(body, rel=1e-10)
    force = t * np.sqrt(covariance[2, 2])
    assert found.contact_force_rms.item() == pytest.approx(force, rel=2e-6)
    assert found.dynamic_load_coefficient.item() == pytest.approx(force / ((m + u) * 9.81), rel=2e-6)


def lump(damping_ratio, natural=2.0, mass=1000.0):
    """One mass on one contact."""
    rate = 2 * np.pi * natural
    return mf.Vehicle(
        mass=[[mass]],
        damping=[[0.0]],
        stiffness=[[0.0]],
        contact_map=[[1.0]],
        contacts=[
            mf.Contact(position=0.0, stiffness=mass * rate**2, damping=2 * damping_ratio * mass * rate),
        ],
        vertical=[1],
        dof_names=["mass"],
    )


@pytest.mark.parametrize("damping_ratio", [1e-3, 0.05, 0.5])
def test_oscillator_under_white_acceleration(damping_ratio):
    """Waviness 4: r̈ is white, σ_x² = W/(4ζω³) and σ_ẋ² = W/(4ζω) of the stretch x, whose force is kx + cẋ.

    W = ½ (2π)⁴ G_d(n₀) n₀⁴ v³ per Hz. The slow end at 1e-5 cycle/m costs σ² about (1e-5 v/f₀)/ζ, below 1e-6.
    """
    speed, natural = 20.0, 2.0
    rate, vehicle = 2 * np.pi * natural, lump(damping_ratio, natural)
    spectrum = mf.IsoRoad(roughness=1e-7, waviness=4.0, band=(1e-7, 1e6))
    found = respond(vehicle, RIGID, spectrum, speed=speed, coherence=None)
    white = 0.5 * (2 * np.pi) ** 4 * 1e-7 * 0.1**4 * speed**3
    stretch = white / (4 * damping_ratio * rate**3)
    contact = vehicle.contacts[0]
    force = stretch * (contact.stiffness**2 + (contact.damping * rate) ** 2)
    assert found.contact_force_rms.item() ** 2 == pytest.approx(force, rel=2e-6)


def test_a_lightly_damped_oscillator_crosses_at_its_own_frequency():
    """√(σ_ẋ²/σ_x²)/2π = f₀; the dashpot's share of the force, up to 1e3 cycle/m, adds less than 1e-3."""
    spectrum = mf.IsoRoad(roughness=1e-7, waviness=4.0, band=(1e-7, 1e3))
    found = respond(lump(1e-3, 2.0), RIGID, spectrum, speed=20.0, coherence=None)
    assert found.contact_force_crossing_rate.item() == pytest.approx(2.0, rel=1e-3)


def test_moments_by_another_quadrature():
    """A half truck on the reference road: Simpson in steps of 2 mHz, a thirtieth of the narrowest resonance.

    Its error is about (Δf/width)⁴/180, below 1e-8.
    """
    truck, speed = VEHICLES["half_truck"], 15.0
    found = respond(truck, speed=speed, coherence=None)
    frequency = np.linspace(*(speed * n for n in GROUND.band), 37_501)
    transfer = mf.transfer(ROAD, truck, speed=speed, frequency=frequency)
    phase = np.exp(2j * np.pi * np.outer(frequency, truck.positions) / speed)
    for quantity in ("contact_force", "deflection", "motion", "acceleration"):
        delayed = np.einsum("foc,fc->fo", transfer[quantity].values, phase)
        density = np.abs(delayed.T) ** 2 * GROUND.density(frequency / speed) / speed
        zeroth, second, fourth = (simpson(frequency**power * density, x=frequency) for power in (0, 2, 4))
        assert found[f"{quantity}_rms"].values == pytest.approx(np.sqrt(zeroth), rel=1e-7)
        assert found[f"{quantity}_crossing_rate"].values == pytest.approx(np.sqrt(second / zeroth), rel=1e-7)
        assert found[f"{quantity}_peak_rate"].values == pytest.approx(np.sqrt(fourth / second), rel=1e-7)


# Several contacts and paths


def by_matrix(vehicle, result, coherence, speed):
    """Densities from the full matrix of cross-spectra of the elevations, written out: H S Hᴴ."""
    f = result.frequency.values
    found = mf.transfer(ROAD, vehicle, speed=speed, frequency=f)
    places = np.array([[contact.position, contact.across] for contact in vehicle.contacts])
    ahead, aside = (places[:, None] - places)[..., 0], (places[:, None] - places)[..., 1]
    cross = GROUND.density(f / speed)[:, None, None] / speed * coherence.between(f / speed, aside)
    cross = cross * np.exp(2j * np.pi * f[:, None, None] * ahead / speed)
    return {
        name: np.einsum("foi,fij,foj->fo", found[name].values, cross, found[name].values.conj()).real
        for name in ("contact_force", "deflection", "motion", "acceleration")
    }


@pytest.mark.parametrize("coherence", [ISOTROPIC, mf.ExponentialCoherence(decay=4.0)])
@pytest.mark.parametrize("name", ["half_truck", "full_truck"])
def test_factor_and_full_matrix_agree(name, coherence):
    result = respond(name, coherence=coherence, speed=12.0)
    for quantity, expected in by_matrix(VEHICLES[name], result, coherence, 12.0).items():
        assert np.abs(result[f"{quantity}_density"].values - expected).max() < 1e-10 * expected.max()


def test_axles_meet_the_same_road_one_after_the_other():
    """Equal axles: an odd number of half waves between them does not lift, a whole wave does not pitch."""
    car, speed = mf.half_car(**SYMMETRIC), 10.0
    odd, whole = (2 * np.arange(3) + 1) * speed / (2 * WHEELBASE), np.arange(1, 4) * speed / WHEELBASE
    found = respond(car, RIGID, speed=speed, coherence=None, frequency=np.concatenate([odd, whole]))
    bounce, pitch = found.acceleration_density.sel(dof=["bounce", "pitch"]).values.T
    assert bounce[:3].max() < 1e-25 * bounce[3:].min()
    assert pitch[3:].max() < 1e-25 * pitch[:3].min()


def test_full_car_on_one_road_for_both_sides_is_a_half_car():
    """On a beam, which feels the sum over an axle. Roll is exactly nothing, not rounding with a frequency."""
    doubled = {
        name: tuple(2 * value for value in values) if name != "axles" else values
        for name, values in SYMMETRIC.items()
        if isinstance(values, tuple)
    }
    half = respond(mf.half_car(**(SYMMETRIC | doubled)), coherence=None)
    full = respond(CAR, coherence=1.0)
    for name in ("rms", "crossing_rate", "peak_rate"):
        for dof in ("bounce", "pitch"):
            mine, other = (result[f"acceleration_{name}"].sel(dof=dof).item() for result in (full, half))
            assert mine == pytest.approx(other, rel=1e-8)
    assert 2 * full.contact_force_rms.values[::2] == pytest.approx(half.contact_force_rms.values, rel=1e-8)
    assert full.deflection_rms.values[[0, 2]] == pytest.approx(half.deflection_rms.values, rel=1e-8)
    assert full.acceleration_rms.sel(dof="roll").item() == 0.0
    assert full.acceleration_expected_peak.sel(dof="roll").item() == 0.0
    assert np.isnan(full.acceleration_crossing_rate.sel(dof="roll").item())


def test_sides_share_what_is_coherent():
    """Bounce takes (1 + γ)/2 of what it does on one road for both sides, roll (1 − γ)/2 of its own."""
    frequency = np.geomspace(0.4, 40.0, 50)
    shared = ISOTROPIC.between(frequency / 15.0, np.array(1.4))
    one, none, some = (respond(CAR, coherence=c, frequency=frequency) for c in (1.0, 0.0, ISOTROPIC))
    bounce = some.acceleration_density.sel(dof="bounce").values / one.acceleration_density.sel(dof="bounce").values
    roll = some.acceleration_density.sel(dof="roll").values / none.acceleration_density.sel(dof="roll").values
    assert np.abs(bounce - (1 + shared) / 2).max() < 1e-12
    assert np.abs(roll - (1 - shared)).max() < 1e-12


def test_numbers_of_paths_are_names():
    swapped = replace(CAR, contacts=[replace(contact, path=7 - 3 * contact.path) for contact in CAR.contacts])
    first, second = statistics(respond(CAR)), statistics(respond(swapped))
    for name, values in first.items():
        assert second[name] == pytest.approx(values, rel=1e-9, nan_ok=True)


# What every random response obeys


@pytest.mark.parametrize("road", ["elastic", "rigid", "undamped"])
@pytest.mark.parametrize("name", VEHICLES)
def test_densities_and_their_integrals(name, road):
    """Roughness: what the spectrum says, to rounding. Root mean square: the sum of density times bandwidth."""
    guideway = {"elastic": ROAD, "rigid": RIGID, "undamped": UNDAMPED["euler_bernoulli_winkler"]}[road]
    vehicle, result = VEHICLES[name], respond(name, guideway, speed=10.0)
    below = GROUND.variance_below(np.array(GROUND.band[1])).item()
    if not any(contact.footprint for contact in vehicle.contacts):
        assert result.roughness_rms.values == pytest.approx(np.sqrt(below), rel=1e-12)
    else:
        assert (result.roughness_rms.values < np.sqrt(below)).all()
    for quantity in RANDOM_QUANTITIES:
        density = result[f"{quantity}_density"].values
        assert (density >= 0).all()
        assert np.sqrt(result.bandwidth.values @ density) == pytest.approx(
            result[f"{quantity}_rms"].values, rel=1e-12
        )
    assert result.bandwidth.sum().item() == pytest.approx(10.0 * (GROUND.band[1] - GROUND.band[0]), rel=1e-12)
    # The crossing rate of the motion is √(σ_ż²/σ_z²)/2π; that of its velocity lies above.
    assert (result.motion_peak_rate.values > result.motion_crossing_rate.values).all()
    assert (
        2 * np.pi * result.motion_crossing_rate.values * 2 * np.pi * result.motion_peak_rate.values
        == pytest.approx(result.acceleration_rms.values / result.motion_rms.values, rel=1e-9)
    )


def faintly_damped(part):
    """Keep a ten-thousandth of all dashpots."""
    if isinstance(part, mf.OnMass):
        return mf.OnMass(above=faintly_damped(part.above), mass=part.mass, below=faintly_damped(part.below))
    return replace(part, damping=1e-4 * part.damping)


@pytest.mark.parametrize("name", UNDAMPED)
def test_undamped_tracks_are_the_limit_of_faint_damping(name):
    """Singular densities of the road where its waves cut on, which the panels close in on; nothing jumps.

    A ten-thousandth of the damping changes root mean squares and rates by as little.
    """
    faint = mf.track(DAMPED[name].beam, faintly_damped(DAMPED[name].foundation))
    bare, limit = (respond("quarter_truck", road, speed=10.0) for road in (UNDAMPED[name], faint))
    for quantity in ("contact_force_rms", "deflection_rms", "acceleration_rms", "acceleration_crossing_rate"):
        assert bare[quantity].values == pytest.approx(limit[quantity].values, rel=3e-4)


def test_twice_the_roughness():
    one, two = (respond(spectrum=replace(GROUND, roughness=g)) for g in (16e-6, 32e-6))
    for name, values in statistics(one).items():
        factor = np.sqrt(2) if name.endswith(("rms", "expected_peak")) else 1.0
        assert statistics(two)[name] == pytest.approx(factor * values, rel=1e-9)


def test_frequencies_that_are_asked_for():
    """Densities there, zero outside the band; the statistics stay what they are."""
    free = respond()
    given = respond(frequency=[0.0, *free.frequency.values[::7], 1e4])
    assert "bandwidth" not in given.coords
    for quantity in RANDOM_QUANTITIES:
        density = given[f"{quantity}_density"].values
        assert np.abs(density[1:-1] - free[f"{quantity}_density"].values[::7]).max() <= 1e-12 * density.max()
        assert not density[[0, -1]].any()
    for name, values in statistics(free).items():
        assert (statistics(given)[name] == values).all()


class Stepped:
    """A spectrum with a step and a notch that no formula would have."""

    band = (0.05, 4.0)

    def density(self, n):
        inside = (n >= 0.05) & (n <= 4.0) & ~((n > 0.71) & (n < 0.73))
        return np.where(inside, np.where(n < 0.3, 1e-5, 2e-6), 0.0)

    def variance_below(self, n):
        edges, levels = np.array([0.05, 0.3, 0.71, 0.73, 4.0]), np.array([1e-5, 2e-6, 0.0, 2e-6])
        return np.interp(n, edges, np.concatenate([[0.0], np.cumsum(levels * np.diff(edges))]))


def test_a_spectrum_with_jumps():
    """Resolved where the jumps are, to the share that the panels may leave unresolved (1e-3, in fact far less)."""
    result = respond("quarter_car", RIGID, Stepped(), coherence=None)
    expected = np.sqrt(Stepped().variance_below(np.array(4.0)).item())
    assert result.roughness_rms.item() == pytest.approx(expected, rel=1e-4)


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
    with pytest.warns(mf.ValidityWarning, match="contact 0 would lift off the road about"):
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
    pytest.importorskip("FLife", reason="the extra `fatigue` is not installed")
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
    pytest.importorskip("FLife", reason="the extra `fatigue` is not installed")
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
        mf.ParameterError, match="spectrum must be a roughness spectrum, got the class IsoRoad itself"
    ):
        respond(spectrum=mf.IsoRoad, coherence=None)


def test_many_small_matrices_are_solved_by_one_thread(monkeypatch):
    """Of more than two contacts: LAPACK's threads would wait for each other."""
    seen = []

    def watched(*arguments):
        seen.extend(pool["num_threads"] for pool in threadpool_info() if pool["user_api"] == "blas")
        return solve_contacts(*arguments)

    monkeypatch.setattr("movingfrf.response.solve.solve_contacts", watched)
    with threadpool_limits(limits=2):
        respond("three_axles", coherence=None)
    assert set(seen) == {1}


def test_what_is_refused():
    with pytest.raises(mf.ParameterError, match="coherence is needed, since the contacts follow 2 paths"):
        respond("full_truck", coherence=None)
    with pytest.raises(mf.ParameterError, match=r"coherence must be at most 1, got 1\.5"):
        respond("full_truck", coherence=1.5)
    with pytest.raises(mf.ParameterError, match="coherence must not be negative"):
        respond("full_truck", coherence=-0.5)
    with pytest.raises(
        mf.ParameterError, match="must be a roughness spectrum, as IsoRoad is, got an object of Profile"
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

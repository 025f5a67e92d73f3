"""Laws and closed forms of the random response and of the transfer functions it is made of."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg
from scipy.integrate import simpson

import movingfrf as mf
from movingfrf.results.labels import RANDOM_QUANTITIES
from tests.helpers import DAMPED, QUARTER_CAR, UNDAMPED, VEHICLES
from tests.laws.random_parts import CAR, GROUND, ISOTROPIC, RIGID, ROAD, SYMMETRIC, respond

pytestmark = pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")


WHEELBASE = 2.6


STATISTICS = ("rms", "crossing_rate", "peak_rate", "irregularity", "expected_peak")


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

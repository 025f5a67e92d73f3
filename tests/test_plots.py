"""Figures: what is drawn, and that thinning out loses no extreme."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.signal
from matplotlib.figure import Figure

import movingfrf as mf
from movingfrf._basics import wording
from movingfrf._basics.welch import spectral_density
from movingfrf.reports import plots
from movingfrf.reports.axes import decimated
from movingfrf.reports.curves import PALETTE, Curve, _curves, distinct, telling
from movingfrf.reports.frf import FRF_AXES, frf_amplitude, frf_phase


@pytest.fixture(scope="module")
def result():
    road = mf.track(
        mf.EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9), mf.Spring(stiffness=8e6, damping=3e4)
    )
    car = mf.quarter_car(
        body_mass=400.0,
        wheel_mass=40.0,
        suspension_stiffness=2e4,
        suspension_damping=1.5e3,
        tyre_stiffness=2e5,
    )
    profile = mf.realise(mf.IsoRoad.of_class("B", band=(0.01, 3.0)), length=70.0, step=0.05, seed=0)
    return mf.simulate(road, car, profile, speed=15.0, duration=4.0, truncation=60.0)


def axes():
    return Figure().subplots()


@pytest.mark.parametrize("logarithmic", [False, True])
def test_decimation_keeps_every_extreme(logarithmic):
    rng = np.random.default_rng(0)
    x = np.arange(1.0, 100_001.0)
    y = rng.standard_normal(x.size)
    spikes = rng.choice(x.size, 40, replace=False)
    y[spikes] = 100.0 * rng.choice([-1, 1], 40) + np.arange(40)
    thin_x, thin_y = decimated(x, y, buckets=10_000, logarithmic=logarithmic)
    assert thin_x.size <= 20_002
    assert (thin_x[0], thin_x[-1]) == (x[0], x[-1])
    assert np.all(np.diff(thin_x) > 0)
    # Each sample that stayed is where it was; each bucket's extremes are among them.
    np.testing.assert_array_equal(y[thin_x.astype(int) - 1], thin_y)
    if not logarithmic:
        np.testing.assert_array_equal(np.isin(thin_y, y.reshape(10_000, 10).max(axis=1)).sum(), 10_000)
        np.testing.assert_array_equal(np.isin(thin_y, y.reshape(10_000, 10).min(axis=1)).sum(), 10_000)
    assert (thin_y.min(), thin_y.max()) == (y.min(), y.max())


def test_decimation_leaves_short_series_alone():
    x = np.arange(10.0)
    assert decimated(x, x, buckets=4)[0].size == 10


def test_forces_are_static_plus_dynamic_in_kilonewton(result):
    line = plots.contact_forces(result, axes()).lines[0]
    total = 1e-3 * (result.static_load.values[0] + result.contact_force.values[:, 0])
    np.testing.assert_allclose(line.get_ydata(), total, rtol=1e-12)


def test_an_interval_is_cut_out(result):
    line = plots.contact_forces(result, axes(), interval=(1.0, 2.0)).lines[0]
    assert line.get_xdata().min() >= 1.0
    assert line.get_xdata().max() < 2.0 + 1e-9


def test_force_spectrum_integrates_to_the_variance(result):
    frequency, density = spectral_density(result.contact_force.values[:, 0], 1e-3)
    # Windowing a record of four seconds costs some accuracy.
    variance = density.sum() * (frequency[1] - frequency[0])
    assert variance == pytest.approx(result.contact_force.values.var(), rel=0.25)


@pytest.mark.parametrize("count", [100, 1001, 40_000])
def test_spectral_density_is_that_of_another_program(count):
    values = np.random.default_rng(2).normal(size=count) + 100.0
    frequency, density = spectral_density(values, 1e-3)
    expected = scipy.signal.welch(values, 1e3, nperseg=min(max(2 * count // 9, 32), 10_000), detrend="constant")
    assert frequency == pytest.approx(expected[0][1:])
    assert density == pytest.approx(expected[1][1:], rel=1e-9)


def test_spectral_density_of_white_noise_is_flat_at_its_known_level():
    noise = np.random.default_rng(1).standard_normal(200_000)
    _, density = spectral_density(noise, 1e-3)
    assert density[5:-5].mean() == pytest.approx(2e-3, rel=0.02)  # one-sided: 2 σ² Δt


def test_nothing_to_see_has_no_spectrum():
    assert spectral_density(np.full(1000, 7.0), 1e-3)[0].size == 0
    assert spectral_density(np.arange(3.0), 1e-3)[0].size == 0


def test_a_constant_looks_constant(result):
    still = result.copy(deep=True)
    still.contact_force.values[:] = 1e-9 * np.sin(np.arange(still.sizes["time"]))[:, None]
    low, high = plots.contact_forces(still, axes()).get_ylim()
    level = 1e-3 * float(still.static_load[0])
    assert high - low >= 0.019 * level


def test_frf_in_micrometres_per_kilonewton_and_unwrapped_degrees():
    frequency = np.linspace(0.0, 10.0, 101)
    frf = 2e-9 * np.exp(-1j * 2 * np.pi * frequency * 0.3)[:, None]
    amplitude = frf_amplitude(frequency, frf, [0.0], axes(), truncation=5.0)
    np.testing.assert_allclose(amplitude.lines[0].get_ydata(), 2.0)
    assert "truncation, 5 Hz" in amplitude.get_legend_handles_labels()[1]
    phase = frf_phase(frequency, frf, [0.0], axes())
    np.testing.assert_allclose(phase.lines[0].get_ydata(), -360 * 0.3 * frequency, atol=1e-9)


def test_a_contact_keeps_its_colour(result):
    both = [
        plots.contact_forces(result, axes()).lines[0],
        plots.deflections(result, axes()).lines[0],
        plots.contact_force_spectra(result, axes()).lines[0],
    ]
    assert {line.get_color() for line in both} == {PALETTE[0]}


def test_many_curves_are_thinned_to_the_first_the_last_and_some_between():
    chosen = wording.evenly_spread(40)
    assert len(chosen) == wording.MOST_CURVES
    assert (chosen[0], chosen[-1]) == (0, 39)


@pytest.mark.parametrize(
    "draw",
    [
        plots.contact_forces,
        plots.contact_force_spectra,
        plots.deflections,
        plots.deflection_spectra,
        plots.roughness,
        plots.roughness_spectrum,
        lambda result, ax: plots.accelerations(result, ax, dof=0),
        lambda result, ax: plots.acceleration_spectrum(result, ax, dof="wheel"),
    ],
)
def test_every_axis_names_quantity_and_unit(result, draw):
    ax = axes()
    assert draw(result, ax) is ax
    assert "[" in ax.get_xlabel()
    assert "[" in ax.get_ylabel()
    assert ax.lines


def test_curves_that_coincide_are_merged():
    values = np.array([[1.0, 1.0, 2.0, 1.0, 2.0], [3.0, 3.0 + 1e-7, 4.0, 3.0, 4.0 + 1e-4]])
    curves = [Curve(n, f"c{n}", PALETTE[n]) for n in range(5)]
    assert distinct(curves, values) == [
        Curve(0, "c0 = 2 others", PALETTE[0]),
        Curve(2, "c2", PALETTE[2]),
        Curve(4, "c4", PALETTE[4]),
    ]
    assert [curve.name for curve in distinct(curves[:3], values)] == ["c0 = c1", "c2"]


def test_of_many_degrees_of_freedom_the_calm_ones_that_differ_are_drawn():
    """Four coaches of body, pitch, bogie and two wheelsets, a little livelier from one to the next."""
    one = np.array([0.1, 0.1, 1.3, 13.0, 13.5])
    rms = np.concatenate([one * (1 + 0.01 * coach) for coach in range(4)])
    units = ["m", "rad", "m", "m", "m"] * 4
    assert telling(rms, units, most=8) == [0, 1, 2, 3]
    assert telling(rms, units, most=3) == [0, 1, 2]
    assert telling(rms, units, most=20) == list(range(20))


def test_chosen_contacts_have_colours_of_their_own(result):
    curves = _curves([f"c{n}" for n in range(16)], [6, 7, 8])
    assert len({curve.colour for curve in curves}) == 3
    usual = {curve.column: curve.colour for curve in _curves([f"c{n}" for n in range(16)], None)}
    assert curves[0].colour == usual[6]


def test_a_phase_is_drawn_where_the_amplitude_is():
    frequency = np.linspace(0.0, 10.0, 101)
    frf = np.exp(-2.0 * frequency)[:, None] * np.exp(-1j * frequency[:, None])
    phase = frf_phase(frequency, frf, [0.0], axes()).lines[0].get_ydata()
    assert np.isfinite(phase).tolist() == (np.exp(-2.0 * frequency) >= FRF_AXES.depth).tolist()

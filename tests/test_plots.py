"""Figures: what is drawn, and that thinning out loses no extreme."""

from __future__ import annotations

from types import SimpleNamespace

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
    curves = _curves("contacts", [f"c{n}" for n in range(16)], [6, 7, 8])
    assert len({curve.colour for curve in curves}) == 3
    usual = {curve.column: curve.colour for curve in _curves("contacts", [f"c{n}" for n in range(16)], None)}
    assert curves[0].colour == usual[6]


def test_a_phase_is_drawn_where_the_amplitude_is():
    frequency = np.linspace(0.0, 10.0, 101)
    frf = np.exp(-2.0 * frequency)[:, None] * np.exp(-1j * frequency[:, None])
    phase = frf_phase(frequency, frf, [0.0], axes()).lines[0].get_ydata()
    assert np.isfinite(phase).tolist() == (np.exp(-2.0 * frequency) >= FRF_AXES.depth).tolist()


ROAD = mf.track(mf.EulerBernoulliBeam(1.573e7, 711.9), mf.Spring(8e6, 3e4))
TRUCK = mf.catalogue("half_truck")


@pytest.fixture(scope="module")
def others(result):
    """One result of every other kind, and what else is handed over by mistake."""
    drawn = {
        "random": mf.random_response(ROAD, TRUCK, mf.IsoRoad.of_class("A", band=(0.01, 6.0)), speed=10.0),
        "receptance": mf.receptance(ROAD, frequency=[1.0, 2.0]),
        "transfer": mf.transfer(ROAD, TRUCK, speed=10.0, frequency=[1.0, 2.0]),
        "loaded": mf.moving_loads(ROAD, [[1e5]] * 100, [0.0], speed=20.0, time_step=1e-3, observe=[0.0]),
    }
    return SimpleNamespace(**drawn, result=result, ax=axes())


REFUSED = {
    "a random road's": (lambda o: plots.contact_forces(o.random, o.ax), "`contact_force_spectra`, "),
    "a receptance": (
        lambda o: plots.contact_force_spectra(o.receptance, o.ax),
        r"`plots\.moving_frf` draws",
    ),
    "a transfer function": (lambda o: plots.acceleration_spectrum(o.transfer, o.ax, dof=0), "xarray's way"),
    "swapped": (
        lambda o: plots.contact_forces(o.ax, o.result),
        "ax must be.*order.*result must.*order is",
    ),
    "swapped with a road": (lambda o: plots.moving_frf(o.ax, ROAD, speeds=1.0), "order is guideway, axes"),
    "a road for a result": (lambda o: plots.roughness(ROAD, o.ax), "a Track; `moving_frf` draws"),
    "a figure": (
        lambda o: plots.roughness(o.result, o.ax.figure),
        r"`Figure\(\)\.subplots\(\)` makes one",
    ),
    "several axes": (
        lambda o: plots.roughness(o.result, Figure().subplots(2)),
        r"take one of them, as axes\[0\]",
    ),
    "no loads": (
        lambda o: plots.prescribed_forces(o.result, o.ax),
        "to prescribed loads, got a result of",
    ),
    "no vehicle": (
        lambda o: plots.roughness_spectrum(o.loaded, o.ax),
        "`prescribed_forces` and `deflections`",
    ),
    "beyond": (
        lambda o: plots.contact_forces(o.result, o.ax, interval=(30, 40)),
        r"interval must lie within the record, 0 s to 3\.999 s, got \(30, 40\) s",
    ),
    "backwards": (
        lambda o: plots.deflections(o.result, o.ax, interval=(3, 1)),
        r"later instant .*\(3, 1\)",
    ),
    "an instant": (
        lambda o: plots.accelerations(o.result, o.ax, dof=0, interval=3.0),
        "interval must be two",
    ),
    "no such contact": (lambda o: plots.contact_forces(o.result, o.ax, contacts=-1), "contacts .* got -1"),
    "true": (lambda o: plots.contact_forces(o.result, o.ax, contacts=[False]), "contacts must .* got False"),
    "no such name": (
        lambda o: plots.contact_force_spectra(o.random, o.ax, contacts="reer"),
        r"contacts must be among 0 \(front\), 1 \(rear\), got 'reer' \(did you mean 'rear'\?\)",
    ),
    "no such load": (lambda o: plots.prescribed_forces(o.loaded, o.ax, loads=1), "loads must be among 0"),
    "a dimension less": (
        lambda o: plots.contact_forces(o.result.isel(contact=0), o.ax),
        r"must keep its dimension contact, as `result\.isel\(contact=\[0\]\)` does",
    ),
    "an instant alone": (
        lambda o: plots.roughness(o.result.isel(time=[0]), o.ax),
        "two instants at least",
    ),
    "no attributes": (
        lambda o: plots.roughness(o.result.assign_attrs(kind="coupled").drop_attrs(), o.ax),
        "must keep its attributes, speed among them",
    ),
    "gaps": (
        lambda o: plots.deflections(o.result.where(ROAD is None), o.ax),
        "has deflection nan at time 0 s",
    ),
    "text for speeds": (lambda o: plots.moving_frf(ROAD, o.ax, speeds="fast"), r"speeds must be .*\[m/s\]"),
    "a table of speeds": (
        lambda o: plots.moving_frf(ROAD, o.ax, speeds=[[1.0]]),
        "speeds must be one number or",
    ),
    "frequencies in no order": (
        lambda o: plots.moving_frf(ROAD, o.ax, speeds=1.0, frequency=[2.0, 1.0]),
        "frequency must be two or more increasing",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_drawn_is_refused_with_what_to_do(others, name):
    call, words = REFUSED[name]
    with pytest.raises(ValueError, match=words):
        call(others)


def test_contacts_are_chosen_by_number_or_name_one_or_several(others):
    known = others.random
    by = [
        plots.contact_force_spectra(known, axes(), contacts=chosen).lines for chosen in (1, "Rear", [1], ["rear"])
    ]
    for lines in by:
        assert len(lines) == 1
        np.testing.assert_array_equal(lines[0].get_ydata(), by[0][0].get_ydata())


def test_spectra_of_a_random_road_are_its_own(others):
    known = others.random
    line = plots.contact_force_spectra(known, axes(), contacts=0).lines[0]
    at = np.isin(known.frequency.values, line.get_xdata())
    np.testing.assert_allclose(line.get_ydata(), np.sqrt(known.contact_force_density.values[at, 0]), rtol=1e-12)
    line = plots.deflection_spectra(known, axes(), places=0).lines[0]
    np.testing.assert_allclose(line.get_ydata()[0], 1e6 * np.sqrt(known.deflection_density.values[0, 0]))
    line = plots.acceleration_spectrum(known, axes(), dof="BOUNCE").lines[0]
    np.testing.assert_allclose(line.get_ydata()[0], known.acceleration_density.values[0, 0])
    line = plots.roughness_spectrum(known, axes()).lines[0]
    n = line.get_xdata()
    np.testing.assert_allclose(line.get_ydata(), mf.IsoRoad.of_class("A").density(n), rtol=1e-9)


def test_moving_frfs_over_speeds_and_points(others):
    frequency = np.linspace(0.0, 60.0, 61)
    ax = plots.moving_frf(ROAD, axes(), speeds=[0.0, 60.0], ahead=[0.0, -1.5], frequency=frequency)
    assert [line.get_label() for line in ax.lines] == [
        "0 m/s, under the load itself",
        "0 m/s, 1.50 m behind",
        "60 m/s, under the load itself",
        "60 m/s, 1.50 m behind",
    ]
    known = 1e9 * np.abs(ROAD.moving_frf(np.array([-1.5]), 60.0, 2 * np.pi * frequency)[:, 0])
    np.testing.assert_allclose(ax.lines[3].get_ydata(), known, rtol=1e-3)
    assert len({(line.get_color(), line.get_linestyle()) for line in ax.lines}) == 4


def test_moving_frfs_of_an_undamped_road_are_drawn_to_where_it_hardly_answers():
    rail = mf.track(mf.EulerBernoulliBeam(6e6, 60.0), mf.Spring(1e8, 0.0))
    line = plots.moving_frf(rail, axes(), speeds=40.0).lines[0]
    f, amplitude = line.get_data()
    assert np.isfinite(amplitude).all()
    assert 150.0 < f[amplitude.argmax()] < 206.0  # √(k/m)/2π = 205 Hz at rest
    assert amplitude[-1] == pytest.approx(0.1 * amplitude[0], rel=0.02)
    still = plots.moving_frf(mf.RigidGuideway(), axes(), speeds=40.0).lines[0]
    assert still.get_xdata()[-1] == 40.0

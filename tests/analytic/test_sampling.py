"""In what steps a record is solved: against steady waves, finer steps, longer records, and other steps."""

import json
from dataclasses import replace

import numpy as np
import pytest

import movingfrf as mf
from movingfrf.response.line import Given, Line, folded
from movingfrf.response.sampling import SAMPLING, Driving, excited
from movingfrf.response.system import System
from tests.helpers import DAMPED, HALF_TRUCK, QUARTER_TRUCK

PAVEMENT = DAMPED["euler_bernoulli_winkler"]
TRACK = DAMPED["rail_pad_sleeper_ballast"]
WHEELSET = mf.wheelset(mass=1800.0, contact_stiffness=2.4e9)
HERTZ = mf.wheelset(mass=600.0, contact_stiffness=1.1e9)
DASHPOT = mf.quarter_car(**QUARTER_TRUCK | {"tyre_damping": 5e3})


def largest(found, wanted):
    """Largest difference of any channel over its largest value, at the instants of the first."""
    wanted = wanted[: len(found)]
    return float((np.abs(found - wanted).max(axis=0) / np.abs(wanted).max(axis=0)).max())


def codes(result):
    return [found["code"] for found in json.loads(result.attrs["findings"])]


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
@pytest.mark.parametrize("time_step", [1e-3, 7.3e-3])
@pytest.mark.parametrize(("wavelength", "speed"), [(0.05, 36.0), (0.04, 30.0), (0.03, 12.0)])
def test_tones_above_the_nyquist_frequency(wavelength, speed, time_step):
    """In steady state |D/(1 + D G)| a, whatever frequency it would fold to."""
    duration, amplitude = 1.2, 5e-6
    rail = mf.harmonic(amplitude=amplitude, wavelength=wavelength, length=speed * duration + 10.0)
    result = mf.simulate(TRACK, WHEELSET, rail, speed=speed, duration=duration, time_step=time_step)
    omega = 2 * np.pi * speed / wavelength
    frf = TRACK.moving_frf(0.0, speed, [omega])[0]
    stiffness = WHEELSET.dynamics().stiffness(np.array([omega + 0j]))[0, 0, 0]
    wanted = abs(stiffness / (1 + stiffness * frf)) * amplitude
    late = result.time.values > 0.6 * duration
    time, force = result.time.values[late], result.contact_force.values[late, 0]
    waves = np.stack([np.cos(omega * time), np.sin(omega * time)], axis=1)
    parts = np.linalg.lstsq(waves, force)[0]
    # A spline through eight stations to the wave has an amplitude of its own.
    assert np.hypot(*parts) == pytest.approx(wanted, rel=1e-3)
    assert np.abs(force - waves @ parts).max() < 2e-3 * wanted
    assert codes(result) == ["beyond_nyquist"] * (speed / wavelength > 0.5 / time_step)
    assert result.attrs["solved_step"] < 0.5 * wavelength / speed


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
@pytest.mark.parametrize(
    ("guideway", "vehicle", "speed", "seed"),
    [(PAVEMENT, DASHPOT, 40.0, 1), (TRACK, HERTZ, 70.0, 2), (TRACK, mf.wheelset(mass=900.0), 30.0, 3)],
)
def test_images_of_the_spline_are_solved_for(guideway, vehicle, speed, seed):
    """Two stations and a half to the shortest wave; a quarter of the step changes nothing."""
    spectrum = mf.IsoRoad(roughness=1e-8, band=(0.05, 4.0))
    road = mf.realise(spectrum, length=2.6 * speed + 30.0, step=0.1, seed=seed)
    travel = {"speed": speed, "duration": 1.0, "time_step": 2e-3}
    found = mf.simulate(guideway, vehicle, road, **travel)
    finer = mf.simulate(
        guideway, vehicle, road, **travel | {"duration": 2.5}, solved_step=found.attrs["solved_step"] / 4
    )
    assert not {"unresolved", "profile_ends", "not_decayed"} & set(codes(found))
    for name in ("contact_force", "acceleration", "motion"):
        assert largest(found[name].values, finer[name].values) < 5e-4, name


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_the_step_is_the_users():
    """Values at the same instants are the same, in steps of 20, 5 and 1 ms."""
    road = mf.realise(mf.IsoRoad.of_class("A", band=(0.01, 6.0)), length=70.0, seed=0, start=-3.0)
    truck = mf.half_car(**HALF_TRUCK)
    by_step = {
        step: mf.simulate(PAVEMENT, truck, road, speed=10.0, duration=5.0, time_step=step)
        for step in (1e-3, 5e-3, 2e-2)
    }
    fine = by_step[1e-3]
    for step, result in by_step.items():
        every = round(step / 1e-3)
        for name in ("contact_force", "deflection", "motion", "acceleration"):
            assert largest(result[name].values, fine[name].values[::every]) < 1e-4, (step, name)


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_stations_of_a_realised_road_hardly_matter():
    """Harmonics belong to seed, length and band, so that only the spline between stations differs."""
    spectrum, truck = mf.IsoRoad.of_class("A", band=(0.01, 6.0)), mf.half_car(**HALF_TRUCK)
    forces = []
    for step in (None, 0.0125, 0.05):
        road = mf.realise(spectrum, length=70.0, step=step, seed=0, start=-3.0)
        forces.append(mf.simulate(PAVEMENT, truck, road, speed=10.0, duration=5.0).contact_force.values)
    apart = [np.linalg.norm(force - forces[1]) / np.linalg.norm(forces[1]) for force in forces]
    assert apart[0] < 1e-4
    assert apart[2] < 3e-3


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
@pytest.mark.parametrize(
    ("footprint", "cams", "speed", "vehicle"),
    [(0.5, 0.0, 5.0, QUARTER_TRUCK), (0.0, 0.6, 12.0, QUARTER_TRUCK), (0.0, 0.0, 80.0, None)],
)
def test_the_last_samples_are_as_good_as_the_others(footprint, cams, speed, vehicle):
    """As a record one second longer gives them; under a dashpot with content up to the steps of the output."""
    car = DASHPOT if vehicle is None else mf.quarter_car(**vehicle)
    contact = car.contacts[0]
    shape = mf.Contact(
        position=0.0, stiffness=contact.stiffness, damping=contact.damping, footprint=footprint, cams=cams
    )
    car = mf.Vehicle(
        mass=car.mass,
        damping=car.damping,
        stiffness=car.stiffness,
        contact_map=car.contact_map,
        contacts=[shape],
        vertical=car.vertical,
        dof_names=car.dof_names,
    )
    road = mf.realise(mf.IsoRoad.of_class("B", band=(0.02, 5.0)), length=3.5 * speed + 10.0, seed=5)
    short, longer = (mf.simulate(PAVEMENT, car, road, speed=speed, duration=d) for d in (2.0, 3.0))
    assert largest(short.contact_force.values, longer.contact_force.values) < 4e-4
    tail = slice(-20, None)
    apart = np.abs(short.contact_force.values[tail] - longer.contact_force.values[: len(short.time)][tail])
    assert apart.max() < 4e-4 * np.abs(longer.contact_force.values).max()


def test_past_the_end_of_a_profile_a_footprint_is_a_guess():
    """It says so, and how much that may matter."""
    car = mf.quarter_car(**QUARTER_TRUCK)
    car = mf.on_paths(car, [0])
    contact = mf.Contact(position=0.0, stiffness=3.7e6, footprint=0.5)
    car = mf.Vehicle(
        mass=car.mass,
        damping=car.damping,
        stiffness=car.stiffness,
        contact_map=car.contact_map,
        contacts=[contact],
        vertical=car.vertical,
        dof_names=car.dof_names,
    )
    figures, differences = [], []
    for seed in range(12):
        road = mf.realise(mf.IsoRoad.of_class("A", band=(0.02, 5.0)), length=40.0, step=0.1, seed=seed)
        ends = road.stations <= 30.0 + 1e-9
        cut = mf.Profile(road.stations[ends], road.columns[ends, 0])
        travel = {"speed": 15.0, "duration": 2.0, "blend": 3.0}
        known = mf.simulate(PAVEMENT, car, road, **travel)
        with pytest.warns(mf.ValidityWarning, match=r"0\.25 m past the end of the profile"):
            guessed = mf.simulate(PAVEMENT, car, cut, **travel)
        found = json.loads(guessed.attrs["findings"])
        figures += [one["figure"] for one in found if one["code"] == "profile_ends"]
        differences.append(
            max(largest(guessed[name].values, known[name].values) for name in ("contact_force", "acceleration"))
        )
        assert codes(known) == []
    ratio = np.median(figures) / np.median(differences)
    assert 1 / 3 < ratio < 3


@pytest.mark.filterwarnings("ignore:the profile begins with a mean slope")
def test_a_road_that_begins_with_a_kink_under_a_dashpot():
    """The force jumps; no step resolves that, and the finding says how much a finer one still changes."""
    ramp = mf.Profile(np.linspace(-5.0, 60.0, 261), 0.01 * np.linspace(-5.0, 60.0, 261))
    travel = {"speed": 10.0, "duration": 2.0, "blend": 0.0}
    with pytest.warns(mf.ValidityWarning, match="goes on above"):
        found = mf.simulate(mf.RigidGuideway(), DASHPOT, ramp, **travel)
    finer = mf.simulate(mf.RigidGuideway(), DASHPOT, ramp, **travel, solved_step=found.attrs["solved_step"] / 16)
    figure = next(f["figure"] for f in json.loads(found.attrs["findings"]) if f["code"] == "unresolved")
    off = max(largest(found[name].values[1:], finer[name].values[1:]) for name in ("contact_force", "acceleration"))
    assert off < 3 * figure


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
@pytest.mark.parametrize(
    ("duration", "truncation"), [(2.0, 10.0), (0.5, 15.0), (0.05, 20.0), (5.0, 30.0), (2.0, 45.0), (7.0, 50.0)]
)
def test_the_error_of_a_truncation_is_the_real_one(duration, truncation):
    """Of the worst channel, root mean square over the record; estimated from above where it is small."""
    road = mf.realise(mf.IsoRoad.of_class("A", band=(0.01, 6.0)), length=100.0, seed=2, start=-3.0)
    truck = mf.half_car(**HALF_TRUCK)
    cut, whole = (
        mf.simulate(PAVEMENT, truck, road, speed=12.0, duration=duration, truncation=f) for f in (truncation, 1e4)
    )
    errors = []
    for name in ("contact_force", "deflection", "motion", "acceleration"):
        off, rms = ((values**2).mean(axis=0) ** 0.5 for values in (cut[name] - whole[name], whole[name]))
        if name == "deflection":
            rms = ((whole.deflection - whole.static_deflection) ** 2).mean("time") ** 0.5
        size = rms.values
        kept = size > 1e-3 * size.max()
        errors.append((off.values[kept] / size[kept]).max())
    assert max(errors) > 2e-4
    assert cut.attrs["truncation_error"] == pytest.approx(max(errors), rel=0.02)


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_measures_are_of_the_response_as_it_was_solved():
    """At 25 Hz three quarters of a wheel's acceleration cannot be seen; every measure stays what it is."""
    car = mf.quarter_car(
        body_mass=400.0,
        wheel_mass=40.0,
        suspension_stiffness=2e4,
        suspension_damping=1.5e3,
        tyre_stiffness=2e5,
        tyre_damping=500.0,
    )
    road = mf.realise(mf.IsoRoad.of_class("C", band=(0.02, 4.0)), length=150.0, seed=1)
    coarse, fine = (
        mf.simulate(mf.RigidGuideway(), car, road, speed=20.0, duration=6.0, time_step=step)
        for step in (2e-2, 1e-4)
    )
    assert "beyond_nyquist" in codes(coarse)
    wanted = {(one.quantity, one.name): one.value for one in mf.assess(fine)}
    for one in mf.assess(coarse):
        assert one.value == pytest.approx(wanted[one.quantity, one.name], rel=5e-3, abs=1e-12), one


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
@pytest.mark.parametrize("grade", [0.06, -0.02])
def test_a_grade_changes_no_force(grade):
    """A class A road on a slope loads the truck as the road alone does, and is a finding."""
    road = mf.realise(mf.IsoRoad.of_class("A", band=(0.01, 4.0)), length=300.0, seed=1, start=-5.0)
    steep = mf.Profile(road.stations, road.columns[:, 0] + grade * road.stations)
    truck, travel = mf.half_car(**HALF_TRUCK), {"speed": 25.0, "duration": 10.0}
    level = mf.simulate(PAVEMENT, truck, road, **travel)
    with pytest.warns(mf.ValidityWarning, match="begins with a grade"):
        sloping = mf.simulate(PAVEMENT, truck, steep, **travel)
    assert level.attrs["grade"] == 0.0
    assert sloping.attrs["grade"] == pytest.approx(grade, abs=1e-3)
    np.testing.assert_allclose(
        mf.dynamic_load_coefficient(sloping), mf.dynamic_load_coefficient(level), rtol=0.02, atol=0
    )
    with pytest.warns(mf.ValidityWarning, match="begins with a grade"):
        stepped = mf.cdfm(
            mf.finite_track(PAVEMENT, first=-45.0, last=60.0, element=0.25), truck, steep, speed=25.0, duration=1.0
        )
    assert stepped.attrs["grade"] == sloping.attrs["grade"]
    blended = mf.simulate(PAVEMENT, truck, steep, **travel, blend=0.0)
    assert blended.attrs["grade"] == 0.0


@pytest.mark.parametrize("samples", [7, 8, 31])
@pytest.mark.parametrize("lines", [5, 9, 17, 40])
def test_what_folds_is_what_samples_see(samples, lines):
    """Harmonics of a period, summed one by one at its samples."""
    random = np.random.default_rng(samples + lines)
    spectra = random.normal(size=(2, lines)) + 1j * random.normal(size=(2, lines))
    spectra[:, 0] = spectra[:, 0].real
    at = np.arange(samples) / samples
    wanted = (
        spectra[:, :1].real + 2 * (spectra[:, 1:] @ np.exp(2j * np.pi * np.outer(np.arange(1, lines), at))).real
    )
    if lines > samples // 2 + 1:
        np.testing.assert_allclose(np.fft.irfft(folded(spectra, samples), samples) * samples, wanted, atol=1e-12)
    line = Line(samples=samples, time_step=0.1, points=4 * samples)
    assert line.size == 2 * samples + 1


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_a_narrow_ridge_between_far_stations_is_found():
    """It is described closely, the road around it is not; a step stated finely tells the force."""
    stations = np.unique(np.concatenate([np.arange(-5.0, 60.0), 25.0 + 0.004 * np.arange(-3, 4)]))
    inside = np.abs(stations - 25.0) < 0.0101
    elevation = np.where(inside, 3e-3 * np.cos(np.pi * (stations - 25.0) / 0.02) ** 2, 0.0)
    ridge, car = mf.Profile(stations, elevation), mf.quarter_car(**QUARTER_TRUCK)
    found, fine = (
        mf.simulate(PAVEMENT, car, ridge, speed=20.0, duration=2.0, solved_step=step) for step in (None, 2e-5)
    )
    assert largest(found.contact_force.values, fine.contact_force.values) < 1e-3
    assert "unresolved" not in codes(found)


@pytest.mark.filterwarnings("ignore:the vehicle's motion", "ignore:contact")
@pytest.mark.parametrize(("stated", "wavelength"), [(5.0, 1.0), (5e-3, 0.1), (2e-2, 0.5)])
def test_a_stated_step_that_is_too_coarse_is_said(stated, wavelength):
    """Its figure is within a factor of three of what is missing."""
    road = mf.harmonic(amplitude=1e-3, wavelength=wavelength, length=80.0, start=-5.0)
    car, travel = mf.quarter_car(**QUARTER_TRUCK), {"speed": 20.0, "duration": 3.0}
    with pytest.warns(mf.ValidityWarning, match="the stated step"):
        coarse = mf.simulate(PAVEMENT, car, road, **travel, solved_step=stated)
    with np.errstate(all="ignore"):
        fine = mf.simulate(PAVEMENT, car, road, **travel)
    figure = next(f["figure"] for f in json.loads(coarse.attrs["findings"]) if f["code"] == "unresolved")
    off = max(largest(coarse[name].values, fine[name].values) for name in ("contact_force", "acceleration"))
    assert off / 3 < figure <= 1.0


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_a_part_of_a_record_is_measured_as_that_part():
    """As it was solved, too."""
    car = mf.quarter_car(**QUARTER_TRUCK | {"tyre_damping": 5e3})
    road = mf.realise(mf.IsoRoad.of_class("B", band=(0.02, 4.0)), length=150.0, seed=1)
    coarse, fine = (
        mf.simulate(mf.RigidGuideway(), car, road, speed=20.0, duration=6.0, time_step=step)
        for step in (2e-2, 5e-4)
    )
    assert "solved_time" in coarse.dims
    for part in (slice(0.0, 1.99), slice(2.0, 3.99)):
        of_both = [mf.dynamic_load_coefficient(result.sel(time=part)) for result in (coarse, fine)]
        np.testing.assert_allclose(*of_both, rtol=2e-2)


@pytest.mark.filterwarnings("ignore:contact", "ignore:the profile")
def test_slopes_that_stay_in_are_said():
    """On a short profile, without a blend, and where a road sets out at another slope than its grade."""
    road = mf.realise(mf.IsoRoad.of_class("A", band=(0.02, 4.0)), length=205.0, seed=1, start=-5.0)
    truck, travel = mf.half_car(**HALF_TRUCK), {"speed": 10.0, "duration": 2.0}
    short = road.stations < 26.0
    steep = road.columns[:, 0] + 0.01 * road.stations
    hill = road.columns[:, 0] + 0.05 * np.minimum(road.stations, 40.0)
    for stations, elevation, words in (
        (road.stations[short], steep[short], "onto which the vehicle drives"),
        (road.stations, hill, "sets out at"),
    ):
        with pytest.warns(mf.ValidityWarning, match=words):
            result = mf.simulate(PAVEMENT, truck, mf.Profile(stations, elevation), **travel)
        assert abs(result.attrs["grade"]) < 0.04


def test_a_stated_step_that_memory_does_not_hold_is_refused():
    road = mf.harmonic(amplitude=1e-3, wavelength=1.0, length=80.0, start=-5.0)
    car = mf.quarter_car(**QUARTER_TRUCK)
    with pytest.raises(ValueError, match=r"solved in steps of 1e-09 s needs about .* GiB"):
        mf.simulate(PAVEMENT, car, road, speed=20.0, duration=3.0, solved_step=1e-9)


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_lost_contact_is_seen_between_the_samples_of_the_output():
    """Over an edge the wheel lifts for milliseconds; in output of 20 ms it may be on the ground at every sample."""
    truck = mf.catalogue("tractor_semitrailer")
    slabs = mf.faulted_slabs(height=0.006, spacing=5.0, edge=0.04, start=-20.0, length=60.0)
    found = {}
    for step in (1e-3, 2e-2):
        result = mf.simulate(mf.RigidGuideway(), truck, slabs, speed=22.0, duration=0.7, time_step=step)
        lifted = [finding for finding in json.loads(result.attrs["findings"]) if finding["code"] == "contact_lost"]
        name = "solved_contact_force" if "solved_time" in result else "contact_force"
        share = float((result[name].values + result.static_load.values < 0).mean(axis=0).max())
        assert f"{share:.2%}" in lifted[0]["message"]
        found[step] = share
    assert found[2e-2] == pytest.approx(found[1e-3], rel=0.2)


@pytest.mark.parametrize("less", [0.5, 0.01])
def test_a_second_look_is_like_a_first_one(less):
    """Where less turns out to be negligible, coarser steps are not looked at again: with the same outcome."""
    system, line = (
        System(guideway=TRACK, vehicle=HERTZ, speed=20.0),
        Line(samples=500, time_step=2e-3),
    )
    corners, looks = np.random.default_rng(0).normal(size=26), [0]

    def given(line):
        looks[0] += 1
        return Given(1e-4 * np.interp(line.instants, np.linspace(0.0, 2.0, 26), np.r_[0, corners[1:]])[None])

    stricter = replace(SAMPLING.road, negligible=less * SAMPLING.road.negligible)
    first = excited(system, Driving(given, 0.08), line, truncation=None)
    few, looks[0] = looks[0], 0
    afresh = excited(system, Driving(given, 0.08), line, truncation=None, wanted=stricter)
    several, looks[0] = looks[0], 0
    after = excited(system, Driving(given, 0.08), line, truncation=None, wanted=stricter, after=first)
    assert looks[0] == several - (few - 1)
    assert (after.line, after.truncation, after.left_out) == (afresh.line, afresh.truncation, afresh.left_out)
    for mine, others in ((after.spectra, afresh.spectra), (after.fade, afresh.fade), (after.beyond, afresh.beyond)):
        np.testing.assert_array_equal(mine, others)


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
@pytest.mark.parametrize("stations", [1.9, 2.0, 4.0, 8.0])
def test_a_wave_that_coarse_steps_do_not_see_is_not_missed(stations):
    """A smooth road is sampled coarser than its stations; with a short wave on it, of any length, it is not."""
    smooth = mf.realise(mf.IsoRoad.of_class("A", band=(0.02, 3.0)), length=100.0, seed=2)
    step, car = smooth.even_step(), mf.quarter_car(**QUARTER_TRUCK)
    wave = 2e-6 * np.cos(2 * np.pi / stations * np.arange(smooth.stations.size) + 0.3)
    rough = mf.Profile(smooth.stations, smooth.columns[:, 0] + wave)
    travel = {"speed": 10.0, "duration": 6.0, "time_step": 1e-3}
    coarse, fine = (mf.simulate(PAVEMENT, car, road, **travel) for road in (smooth, rough))
    assert coarse.attrs["solved_step"] > 4 * step / 10.0
    assert fine.attrs["solved_step"] < 0.5 * stations * step / 10.0
    exact = mf.simulate(PAVEMENT, car, rough, solved_step=0.1 * step / 10.0, **travel)
    for name in ("contact_force", "acceleration"):
        assert largest(fine[name].values, exact[name].values) < 2e-4, name


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_coarse_steps_give_what_fine_ones_give():
    """As closely as their bounds promise, on profiles of sixteen, thirty-two and ninety stations to a wave."""
    car, travel = mf.quarter_car(**QUARTER_TRUCK), {"speed": 10.0, "duration": 6.0, "time_step": 1e-3}
    for per_wave in (16, 32, 90):
        road = mf.realise(
            mf.IsoRoad.of_class("A", band=(0.02, 3.0)), length=100.0, step=1 / (3.0 * per_wave), seed=2
        )
        found = mf.simulate(PAVEMENT, car, road, **travel)
        exact = mf.simulate(PAVEMENT, car, road, solved_step=1e-3, **travel)
        for name in ("contact_force", "acceleration"):
            assert largest(found[name].values, exact[name].values) < 1e-4, (name, per_wave)


def drive_too_coarse():
    surface = mf.harmonic(amplitude=1e-5, wavelength=0.5, length=60.0, start=-20.0)
    return mf.simulate(TRACK, HERTZ, surface, speed=20.0, duration=1.0, time_step=0.02)


def loads_too_coarse():
    force = 1e4 * np.sin(2 * np.pi * 3.0 * 0.02 * np.arange(100))[:, None]
    force[::2] *= -1.0
    return mf.moving_loads(TRACK, force, [0.0], speed=20.0, time_step=0.02)


@pytest.mark.parametrize(("module", "solve"), [("ride", drive_too_coarse), ("moving_loads", loads_too_coarse)])
def test_a_response_that_memory_does_not_hold_is_not_kept(module, solve, monkeypatch):
    """Then the record is all there is, and the result says so: nothing runs out of memory for what is beside it."""
    with pytest.warns(mf.ValidityWarning, match=r"lies above 25 Hz.* is kept beside it"):
        whole = solve()
    assert "solved_deflection" in whole
    monkeypatch.setattr(f"movingfrf.response.{module}.holds", lambda *_: False)
    with pytest.warns(mf.ValidityWarning, match=r"lies above 25 Hz.* memory does not hold the response"):
        alone = solve()
    assert not [name for name in alone.variables if str(name).startswith("solved_")]
    np.testing.assert_array_equal(alone.deflection, whole.deflection)

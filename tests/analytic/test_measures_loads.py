"""Loads on the road against closed forms: forces that are cosines of the road, or Gaussian."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest

import movingfrf as mf
from movingfrf.metrics.listed import CAPTIONS, RANDOM_CAPTIONS, TABLES
from movingfrf.metrics.measures import assess, random_measures
from movingfrf.results.labels import labelled
from tests.helpers import DAMPED

PAVEMENT = DAMPED["euler_bernoulli_winkler"]
TRUCK = mf.quarter_car(
    body_mass=8900.0, wheel_mass=1100.0, suspension_stiffness=1e6, suspension_damping=3e4, tyre_stiffness=3.5e6
)

SPEED, STEP = 20.0, 1e-3


def travelled(
    *, amplitude, loads=(5e3, 8e3), positions=(1.5, -1.0), paths=(0, 0), start=3.0, duration=10.0, phase=0.0
):
    """Make a result whose dynamic forces are the cosine of the road under them, of 4 m, alike for all contacts."""
    time = STEP * np.arange(round(duration / STEP))
    under = start + np.array(positions) + SPEED * time[:, None]
    force = np.broadcast_to(amplitude, (len(positions),)) * np.cos(2 * np.pi * under / 4.0 + phase)
    contacts = len(positions)
    values = {
        "time": time,
        "contact": np.arange(contacts),
        "position": positions,
        "path": list(paths),
        "dof": ["body", "pitch"],
        "dof_unit": ["m", "rad"],
        "contact_force": force,
        "static_load": list(loads),
        "deflection": 0 * force + 1e-3,
        "static_deflection": [1e-3] * contacts,
        "motion": np.zeros((time.size, 2)),
        "acceleration": np.stack([np.sin(2 * np.pi * 8 * time), 0 * time], axis=1),
        "roughness": 0 * force,
    }
    attributes = {"speed": SPEED, "start": start, "time_step": STEP, "movingfrf": "test", "findings": "[]"}
    return labelled(values, {"kind": "coupled", **attributes})


def wild_at_first(wild=3.0, **changes):
    """Make a result of the same kind that is three times as wild in its first two seconds; tension included."""
    result = travelled(amplitude=2.5e3, loads=(5e3, 7e3), **changes)
    factor = np.where(result.time.values < 2.0, wild, 1.0)[:, None]
    for name in ("contact_force", "deflection", "acceleration"):
        result[name] = result[name].copy(data=result[name].values * factor)
    return result


# Every measure of a history, as a number.
SINCE = {
    "dynamic_load_coefficient": lambda r, **o: mf.dynamic_load_coefficient(r, **o)[0],
    "impact_factor": lambda r, **o: mf.impact_factor(r, **o)[0],
    "aggregate_force": lambda r, **o: mf.aggregate_force(r, **o).aggregate_force.values.max(),
    "road_wear": lambda r, **o: mf.road_wear(r, **o)[0],
    "spatial_repeatability": lambda r, **o: mf.spatial_repeatability(r, wild_at_first(-3.0, phase=0.7), **o)[0],
    "contact_loss": lambda r, **o: mf.contact_loss(r, **o).share[0],
    "measures": lambda r, **o: mf.measures(r, **o)[1].value,
    "vibration_dose": lambda r, **o: mf.vibration_dose(r.acceleration.values, STEP, **o)[0],
}


@pytest.mark.parametrize("name", SINCE)
def test_the_first_seconds_are_left_out(name):
    """As of the record that begins then; and they would have counted."""
    result = wild_at_first()
    later = result.isel(time=slice(2000, None))
    if name == "spatial_repeatability":
        # Both records are cut: cosines of one wavelength, 0.7 rad apart.
        assert SINCE[name](result, since=2.0) == pytest.approx(np.cos(0.7), abs=0.01)
    else:
        assert SINCE[name](result, since=2.0) == pytest.approx(SINCE[name](later), rel=1e-12)
    assert abs(SINCE[name](result) - SINCE[name](result, since=2.0)) > 0.02 * abs(SINCE[name](result))
    with pytest.raises(mf.ParameterError, match=r"since must lie within the record, 9\.999 s at most, got 10\.0 s"):
        SINCE[name](result, since=10.0)


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_since_in_closed_form():
    assert mf.dynamic_load_coefficient(wild_at_first(), since=2.0)[0] == pytest.approx(0.5 / np.sqrt(2), rel=1e-9)
    loads = mf.moving_loads(PAVEMENT, np.where(np.arange(3000) < 1000, 3e4, 1e4)[:, None], [0.0], speed=SPEED)
    (late,) = [m.value for m in mf.measures(loads, since=2.0) if m.name == "rms"]
    still = mf.moving_loads(PAVEMENT, np.full((3000, 1), 1e4), [0.0], speed=SPEED)
    (steady,) = [m.value for m in mf.measures(still, since=2.0) if m.name == "rms"]
    assert late == pytest.approx(steady, rel=1e-6)


def test_dynamic_load_coefficient():
    """A/√2 over the static load; whole waves."""
    result = travelled(amplitude=1e3)
    np.testing.assert_allclose(
        mf.dynamic_load_coefficient(result), 1e3 / np.sqrt(2) / np.array([5e3, 8e3]), rtol=1e-12
    )
    assert mf.dynamic_load_coefficient(travelled(amplitude=1.0, loads=(0.0, 1.0)))[0] == np.inf
    assert mf.dynamic_load_coefficient(travelled(amplitude=1.0, loads=(-500.0, 1.0)))[0] == np.inf


def test_an_axle_that_hangs():
    """Below zero in steady travel a load wears nothing; every measure is a number or infinite."""
    result = travelled(amplitude=1e3, loads=(-500.0, 8e3))
    assert mf.aggregate_force(result, power=1.5).static_aggregate.item() == pytest.approx(8e3**1.5)
    assert np.isfinite(mf.road_wear(result, power=1.5)).all()
    assert not any(np.isnan(measure.value) for measure in assess(result, dofs=["body"]))


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
def test_an_axle_that_hangs_between_others():
    """A body of 20 t on stiff axles at ±1.5 m, away from whose soft third one in the middle the road sags.

    In steady travel each bears k (z + θx − G F) as the body sinks by z and, on a moving road, turns by θ:
    F = (I + k G)⁻¹ k (z + θx), ΣF = m g, ΣFx = 0.
    """
    axles, stiffness = np.array([1.5, 0.0, -1.5]), np.array([5e9, 1e7, 5e9])
    body = mf.Vehicle(
        mass=np.diag([2e4, 3e4]),
        damping=np.zeros((2, 2)),
        stiffness=np.zeros((2, 2)),
        contact_map=np.stack([np.ones(3), axles], axis=1),
        contacts=[
            mf.Contact(position=x, stiffness=k, damping=1e-3 * k) for x, k in zip(axles, stiffness, strict=True)
        ],
        vertical=[1.0, 0.0],
        dof_names=["body", "pitch"],
    )
    compliance = PAVEMENT.moving_frf(axles[:, None] - axles, 20.0, [0.0])[0].real
    motions = np.stack([np.ones(3), axles], axis=1)
    forces = np.linalg.solve(np.eye(3) + stiffness[:, None] * compliance, stiffness[:, None] * motions)
    loads = forces @ np.linalg.solve(motions.T @ forces, [2e4 * 9.81, 0.0])
    assert loads[1] < 0

    road = mf.realise(mf.IsoRoad.of_class("B"), length=120.0, seed=1)
    history = mf.simulate(PAVEMENT, body, road, speed=20.0, duration=4.0, start=10.0)
    spectral = mf.random_response(PAVEMENT, body, mf.IsoRoad.of_class("B"), speed=20.0)
    for result, coefficients in (
        (history, mf.dynamic_load_coefficient(history)),
        (spectral, spectral.dynamic_load_coefficient.values),
    ):
        assert result.static_load.values == pytest.approx(loads, rel=1e-6)
        assert np.isinf(coefficients).tolist() == [False, True, False]
        (message,) = (f["message"] for f in json.loads(result.attrs["findings"]) if f["code"] == "contact_lost")
        assert re.match(r"contacts? (1|0 to 2) would lift off", message)
    found = {(m.quantity, m.name): m.value for m in assess(history)}
    listed = {(m.quantity, m.name): m.value for m in random_measures(spectral)}
    assert (
        found["contact 1 force", "road stress factor"] == listed["contact 1 load", "road stress factor"] == np.inf
    )
    assert not any(np.isnan(value) for (quantity, _), value in found.items() if "pitch" not in quantity)


def test_impact_factor():
    """Of a cosine, whole waves: A cos(π/20) is exceeded for 5 % of the time; of a Gaussian force, 1 + 1.645 s."""
    result = travelled(amplitude=1e3, phase=0.3)
    expected = 1 + 1e3 * np.cos(np.pi / 20) / np.array([5e3, 8e3])
    # A hundred samples a wave: the percentile lies within a step of the phase.
    assert mf.impact_factor(result) == pytest.approx(expected, abs=0.2 * np.sin(np.pi / 20) * 2 * np.pi / 100)
    assert mf.impact_factor(result, percentile=100.0)[0] == pytest.approx(1.2, abs=1e-3)
    assert mf.impact_factor(travelled(amplitude=1.0, loads=(-500.0, 1.0)))[0] == np.inf
    random = mf.random_response(PAVEMENT, TRUCK, mf.IsoRoad.of_class("B"), speed=20.0)
    listed = {(m.quantity, m.name): m.value for m in random_measures(random)}
    found = listed["contact 0 load", "impact factor (95 %)"]
    assert found == pytest.approx(1 + 1.6448536 * random.dynamic_load_coefficient.values[0], rel=1e-8)
    gaussian = 1e3 * np.random.default_rng(5).normal(size=result.contact_force.shape)
    noisy = result.assign(contact_force=(result.contact_force.dims, gaussian))
    taken = {(m.quantity, m.name): m.value for m in mf.assess(noisy)}
    # Scatter of a percentile of 10,000 samples: √(0.95 · 0.05/10⁴)/φ(1.645) = 0.021 of σ; four times that.
    assert taken["contact 0 force", "impact factor (95 %)"] == pytest.approx(1 + 1.6449 * 0.2, abs=4 * 0.021 * 0.2)


@pytest.mark.parametrize("coefficient", [0.0, 0.1, 0.3])
def test_road_stress_factor_is_the_gaussian_fourth_moment(coefficient):
    """E (1 + s Z)⁴ by Gauss–Hermite quadrature, exact for polynomials."""
    nodes, weights = np.polynomial.hermite_e.hermegauss(5)
    moment = (weights * (1 + coefficient * nodes) ** 4).sum() / weights.sum()
    assert mf.road_stress_factor(coefficient) == pytest.approx(moment, rel=1e-12)


def test_aggregate_force_of_a_pattern_of_the_road():
    """Each contact puts P_j + A cos(2πx/λ) on the point x; the points lie where both pass."""
    worn = mf.aggregate_force(travelled(amplitude=1e3), spacing=0.25)
    x = worn.distance.values
    wave = 1e3 * np.cos(2 * np.pi * x / 4.0)
    # A cubic spline through 200 samples a wave: (2π/200)⁴/384.
    np.testing.assert_allclose(worn.aggregate_force.values[:, 0], (5e3 + wave) ** 4 + (8e3 + wave) ** 4, rtol=1e-8)
    assert worn.static_aggregate.item() == pytest.approx(5e3**4 + 8e3**4)
    # From where the front contact starts to where the rear one ends.
    assert (x[0], x[-1]) == (3.0 + 1.5, np.floor((3.0 - 1.0 + 20.0 * 9.999) / 0.25) * 0.25)
    assert worn.aggregate_force.attrs["units"] == "N^4"


def test_percentile_of_the_aggregate():
    """The sum grows with the cosine, which stays below cos(0.05 π) for 95 % of a wave."""
    (ratio,) = mf.road_wear(travelled(amplitude=1e3))
    wave = 1e3 * np.cos(0.05 * np.pi)
    wanted = ((5e3 + wave) ** 4 + (8e3 + wave) ** 4) / (5e3**4 + 8e3**4)
    # Forty points a wave: the percentile falls between two of them.
    assert ratio == pytest.approx(wanted, rel=3e-3)
    assert mf.road_wear(travelled(amplitude=0.0)) == pytest.approx([1.0])
    assert mf.road_wear(travelled(amplitude=1e3), power=1.0, percentile=50.0) == pytest.approx([1.0], rel=1e-3)


def test_tension_wears_nothing():
    """Where P + A cos is negative it counts as none: the least is what the other contact does."""
    worn = mf.aggregate_force(travelled(amplitude=[6e3, 0.0]))
    assert worn.aggregate_force.values.min() == pytest.approx(8e3**4, rel=1e-12)


def test_paths_are_apart():
    worn = mf.aggregate_force(travelled(amplitude=[1e3, 0.0], paths=(0, 1)), power=1.0)
    assert worn.path.values.tolist() == [0, 1]
    np.testing.assert_allclose(worn.aggregate_force.values[:, 1], 8e3, rtol=1e-12)
    assert np.ptp(worn.aggregate_force.values[:, 0]) == pytest.approx(2e3, rel=1e-2)
    assert worn.aggregate_force.attrs["units"] == "N"


@pytest.mark.parametrize("phase", [0.0, np.pi / 3, np.pi / 2, np.pi])
def test_repeatability_of_shifted_patterns(phase):
    """The correlation of two cosines is the cosine of their shift, whatever their size, start and static loads.

    Over a stretch that is no whole number of waves: to one wave in the 45 of it.
    """
    first = travelled(amplitude=1e3)
    second = travelled(amplitude=300.0, loads=(1e4, 2e3), start=13.37, phase=phase)
    assert mf.spatial_repeatability(first, second)[0] == pytest.approx(np.cos(phase), abs=0.02)


def test_repeatability_needs_a_road_in_common():
    first = travelled(amplitude=1e3)
    assert np.isnan(mf.spatial_repeatability(first, travelled(amplitude=0.0)))[0]
    with pytest.raises(ValueError, match="none in common"):
        mf.spatial_repeatability(first, travelled(amplitude=1e3, start=900.0))
    with pytest.raises(ValueError, match=r"same paths as first, got \[0, 1\] beside \[0\]"):
        mf.spatial_repeatability(first, travelled(amplitude=1e3, paths=(0, 1)))


def test_lost_contact():
    """P + A cos ≤ 0 for arccos(P/A)/π of every wave of 0.2 s; to one step at each end of a loss."""
    result = travelled(amplitude=[1e4, 1e3])
    loss = mf.contact_loss(result)
    share = np.arccos(5e3 / 1e4) / np.pi
    assert loss.share == pytest.approx([share, 0.0], abs=2 * STEP / 0.2)
    assert loss.longest == pytest.approx([0.2 * share, 0.0], abs=2 * STEP)
    assert mf.contact_loss(travelled(amplitude=0.0, loads=(0.0, 1.0))).share.tolist() == [1.0, 0.0]


def test_simulated_trucks_repeat_themselves():
    """Two runs over one road at one speed are alike; over another road they have nothing in common."""
    roads = [mf.realise(mf.IsoRoad.of_class("B"), length=260.0, seed=seed) for seed in (1, 2)]
    runs = [mf.simulate(mf.RigidGuideway(), TRUCK, road, speed=20.0, duration=12.0) for road in roads]
    again = mf.simulate(mf.RigidGuideway(), TRUCK, roads[0], speed=20.0, duration=10.0, start=30.0)
    assert mf.spatial_repeatability(runs[0], again)[0] > 0.95
    assert abs(mf.spatial_repeatability(*runs)[0]) < 0.3


def test_assess_measures_everything():
    found = {(m.quantity, m.name): m for m in assess(travelled(amplitude=1e4), slope=4.0)}
    assert found["contact 0 force", "road stress factor"].value == pytest.approx(1 + 6 * 2 + 3 * 4)
    assert found["contact 0 force", "share of time without contact"].value == pytest.approx(1 / 3, abs=0.01)
    # Fifty waves in ten seconds, each as bad as five of one a second.
    amplitude = found["contact 1 force", "damage-equivalent amplitude at 1 Hz"]
    assert amplitude.value == pytest.approx(1e4 * 5**0.25, rel=1e-3)
    assert amplitude.units == "N"
    assert found["path 0 wear", "95th percentile of ΣP⁴ over static"].standard == "Cebon 1999"
    assert found["body acceleration", "weighted rms"].value == pytest.approx(
        abs(mf.weighting("Wk", 8.0)) / np.sqrt(2), rel=0.01
    )
    assert found["body acceleration", "VDV"].units == "m/s^1.75"
    assert found["pitch acceleration", "VDV"].units == "rad/s^1.75"
    assert found["pitch acceleration", "weighted rms"].standard == "ISO 2631-1, We"


def test_assess_measures_what_was_chosen():
    result = travelled(amplitude=1e3)
    chosen = assess(result, contacts=[1], dofs=["pitch"], weighting="Wb")
    assert {m.quantity for m in chosen} == {"contact 1 force", "contact 1 deflection", "pitch acceleration"}
    (rms,) = [m for m in assess(result, dofs=["body"], weighting="Wd") if m.name == "weighted rms"]
    assert rms.standard == "ISO 2631-1, Wd"
    assert rms.value == pytest.approx(abs(mf.weighting("Wd", 8.0)) / np.sqrt(2), rel=0.01)


def test_the_first_seconds_can_be_left_out():
    """Forces and accelerations that set in after two seconds of nothing: what is left are whole waves."""
    result = travelled(amplitude=1e3, duration=12.0)
    for name in ("contact_force", "acceleration"):
        result[name][:2000] = 0.0
    found = {(m.quantity, m.name): m.value for m in assess(result, dofs=["body"], since=2.0)}
    assert found["contact 0 force", "dynamic load coefficient"] == pytest.approx(1e3 / np.sqrt(2) / 5e3, rel=1e-9)
    assert found["body acceleration", "rms"] == pytest.approx(1 / np.sqrt(2), rel=1e-9)
    everything = {(m.quantity, m.name): m.value for m in assess(result, dofs=["body"])}
    share = np.sqrt(10 / 12)
    assert everything["contact 0 force", "dynamic load coefficient"] == pytest.approx(
        share * found["contact 0 force", "dynamic load coefficient"], rel=1e-9
    )


def test_a_weighting_has_run_in_before_what_is_left():
    """Once its filter has forgotten the start, a sine has the gain of the weighting to many digits."""
    result = travelled(amplitude=1.0, duration=40.0)
    gain = abs(mf.weighting("Wk", 8.0))
    (late,) = [m for m in assess(result, contacts=[], dofs=["body"], since=20.0) if m.name == "weighted rms"]
    assert late.value == pytest.approx(gain / np.sqrt(2), rel=1e-6)
    assert mf.comfort(result, "body", since=20.0).rms == late.value
    assert mf.comfort(result, "body", since=20.0).duration == pytest.approx(20.0)
    assert mf.comfort(result, "body").rms != pytest.approx(gain / np.sqrt(2), rel=1e-6)


def test_one_measure_without_an_answer_leaves_the_others():
    """Contacts 2.5 m apart, a record of 2 m: no point meets both."""
    found = assess(travelled(amplitude=1e3, duration=0.1))
    (wear,) = [m for m in found if m.quantity == "path 0 wear"]
    assert np.isnan(wear.value)
    assert wear.note == "the record is too short for all contacts to pass one point of the road"
    assert [m.name for m in found if np.isnan(m.value)] == [wear.name, "crest factor"]  # and a pitch of nothing
    (wear,) = [m for m in assess(travelled(amplitude=1e3, duration=0.2)) if m.quantity == "path 0 wear"]
    assert wear.value > 1
    assert not wear.note


def test_verdicts_on_what_was_chosen():
    """By hand: a sine of 8 Hz, weighted by 1.04, has an rms of 0.73 m/s² and no shocks; a single blow is one."""
    result = travelled(amplitude=1e3)
    notes = {m.name: m.note for m in assess(result, contacts=[], dofs=["body"]) if m.note}
    assert notes == {
        "weighted rms": "fairly uncomfortable (ISO 2631-1, C.2.3)",
        "crest factor": "not above 9",
        "MTVV": "not above 1.5 times the weighted rms",
        "VDV": "not above 1.75 times the weighted rms times the fourth root of the duration",
    }
    result.acceleration[:] = 0.0
    result.acceleration[5000:5020] = 8.0
    blow = {(m.quantity, m.name): m.note for m in assess(result, contacts=[], dofs=["body", "pitch"])}
    for name in ("crest factor", "MTVV", "VDV"):
        for dof in ("body", "pitch"):
            assert blow[f"{dof} acceleration", name].endswith(": the rms alone understates this vibration")
    assert not blow["pitch acceleration", "weighted rms"]
    assert not any(m.note for m in assess(result))
    assert not any(m.note for m in assess(result, dofs=["body"], weighting="Wf"))


def test_usual_measures_are_among_all():
    result = travelled(amplitude=1e3)
    everything = assess(result)
    assert all(measure in everything for measure in mf.measures(result) if not np.isnan(measure.value))


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda r: mf.contact_loss(r.drop_vars("contact_force")),
            "result must be the coupled response of a vehicle",
        ),
        (lambda r: mf.aggregate_force(r, power=0.0), "power must be positive"),
        (lambda r: mf.aggregate_force(r, spacing=-1.0), "spacing must be positive"),
        (
            lambda r: mf.aggregate_force(r.isel(time=slice(0, 20))),
            "contacts lie up to 2.5 m apart, and the record covers 0.38 m",
        ),
        (lambda r: mf.road_wear(r, percentile=101.0), "percentile must lie between 0 and 100 %"),
        (lambda r: mf.impact_factor(r, percentile=101.0), r"percentile must lie between 0 and 100 %, got 101\.0 %"),
        (lambda r: mf.road_stress_factor(-0.1), "coefficient must be at least zero throughout, got -0.1"),
        (lambda r: assess(r, contacts=[2]), "contacts must be among 0, 1, got 2"),
        (
            lambda r: assess(r, dofs=["nose"]),
            r"dofs must be among 0 \(body\), 1 \(pitch\), got 'nose'",
        ),
        (lambda r: assess(r, weighting="Wx"), "weighting must be one of"),
        (lambda r: assess(r, slope=0.0), "slope must be positive, got 0.0$"),
        (lambda r: assess(r, since=-1.0), "since must not be negative, got -1.0 s"),
        (lambda r: assess(r, since=10.0), "since must lie within the record, 9.999 s at most, got 10.0 s"),
        (lambda r: mf.comfort(r, "body", since=99.0), "since must lie within the record"),
        (lambda r: mf.road_stress_factor([0.1, np.nan]), "coefficient must be at least zero throughout, got nan"),
        (
            lambda r: assess(r.assign(acceleration=r.acceleration.where(r.time != 0.5))),
            "in finite numbers, but has acceleration nan at time 0.5 s, dof body",
        ),
        (lambda r: assess(r.drop_vars("static_deflection")), "in finite numbers, but lacks static_deflection"),
        (lambda r: mf.vibration_total([1.0], "x"), "factors must be an array of numbers, got 'x'"),
        (lambda r: assess(r.drop_vars("contact_force")), "result must be the coupled response of a vehicle"),
        (lambda r: mf.measures(None), "result must be the coupled response of a vehicle"),
        (
            lambda r: mf.dynamic_load_coefficient(mf.transfer(PAVEMENT, TRUCK, speed=9.0, frequency=[1.0])),
            "result must be",
        ),
        (lambda r: assess(r, weighting=["Wk"]), "weighting must be one of"),
        (lambda r: mf.aggregate_force(r, spacing=1e-12), "a spacing of 1e-12 m between points needs about"),
        (lambda r: mf.comfort(r, ["body"]), r"dof must be among 0 \(body\), 1 \(pitch\), got"),
        (
            lambda r: mf.comfort(r, "nose"),
            r"dof must be among 0 \(body\), 1 \(pitch\), got 'nose'",
        ),
        (lambda r: mf.comfort(r.drop_vars("acceleration"), "body"), "result must be the coupled response"),
    ],
)
def test_refusals(call, message):
    with pytest.raises(ValueError, match=message):
        call(travelled(amplitude=1e3))


def test_every_measure_has_a_caption_and_a_name_of_its_own():
    for table in TABLES:
        of_history = [entry.history.name for entry in table.entries if entry.history]
        of_random = [
            (taken.quantity or table.quantity, taken.name) for entry in table.entries if (taken := entry.random)
        ]
        assert len(set(of_history)) == len(of_history)
        assert len(set(of_random)) == len(of_random)
        assert not of_history or table.quantity in CAPTIONS
        assert {quantity for quantity, _ in of_random} <= RANDOM_CAPTIONS.keys()
        assert all(entry.history or entry.random for entry in table.entries)

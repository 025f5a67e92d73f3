"""Vehicle and finite road stepped together, against references, the frequency domain, and themselves."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse as sparse

import movingfrf as mf
from tests.helpers import (
    FULL_TRUCK,
    HALF_TRUCK,
    VEHICLES,
    apart,
    difference,
)
from tests.stepping.coupled_parts import DASHPOT, FLAT, TRACK, over_hump, travelling

DATA = Path(__file__).parents[1] / "data"


# Reference: (force, acceleration) by which its own refinements differ, from the JSON beside it.
REFERENCES = {"": (1.26e-4, 4.8e-4), "_6": (9.7e-5, 4.1e-4)}


@pytest.mark.parametrize("suffix", REFERENCES, ids=["20 Hz", "60 Hz"])
def test_references_are_reached_under_refinement(suffix):
    """Half truck at 10 m/s over the profile of tests/data, from shortly before its beginning at 120 m.

    The references are another program's (one Newmark system of FE beam and vehicle, refined and extrapolated).
    """
    stations = np.loadtxt(DATA / f"coupled_profile{suffix}.csv.gz", delimiter=",", skiprows=1)
    wanted = np.genfromtxt(DATA / f"coupled_half_truck{suffix}.csv.gz", delimiter=",", names=True)[:-1]
    sag = TRACK.moving_frf(np.subtract.outer(*2 * [VEHICLES["half_truck"].positions]), 10.0, [0.0])[0].real
    sag = sag @ VEHICLES["half_truck"].static_loads
    errors = []
    for element, step in ((0.25, 1e-3), (0.25, 5e-4), (0.125, 2.5e-4), (0.125, 1.25e-4)):
        result = mf.cdfm(
            travelling(element, 32.0, 28.0),
            VEHICLES["half_truck"],
            mf.Profile(stations[:, 0], stations[:, 1]),
            speed=10.0,
            duration=4.3,
            start=117.0,
            time_step=step,
            blend=0.0,
            superposed=True,
        )
        seen = result.isel(time=slice(0, None, round(1e-3 / step))).isel(time=slice(300, None))
        found = {
            "force": (seen.contact_force, [wanted["force_front_N"], wanted["force_rear_N"]]),
            "deflection": (
                seen.deflection - seen.static_deflection,
                [wanted["deflection_front_m"] - sag[0], wanted["deflection_rear_m"] - sag[1]],
            ),
            "acceleration": (
                seen.acceleration,
                [wanted[f"accel_{name}_m_s2"] for name in ("bounce", "front_wheel", "rear_wheel")],
            ),
        }
        found["acceleration"] = found["acceleration"][0].isel(dof=[0, 2, 3]), found["acceleration"][1]
        pitch = difference(seen.acceleration.values[:, 1:2], wanted["accel_pitch_rad_s2"][:, None])
        errors.append([difference(a, np.transpose(b)) for a, b in found.values()] + [pitch])
    force, deflection, acceleration, pitch = np.array(errors).T
    own_force, own_acceleration = REFERENCES[suffix]
    assert force[-1] < own_force
    assert max(acceleration[-1], pitch[-1]) < own_acceleration
    # The sag of the references is off by their own mesh error, 3e-4 of what moves.
    assert deflection[-1] < 6e-4
    # Before the references' own error shows, halving the step divides by four.
    assert force[1] < 0.4 * force[0]
    assert acceleration[1] < 0.3 * acceleration[0]
    assert acceleration[2] < 0.6 * acceleration[1]
    assert acceleration[3] < acceleration[2]


def rough(highest=2.0):
    return mf.realise(mf.IsoRoad.of_class("A", band=(0.02, highest)), length=50.0, step=0.02, seed=1, start=-8.0)


# Vehicle → difference at the finest step: force, motion, acceleration, deflection. What remains is the frequency
# domain's own (window and padding, 2e-5) and that of the absorbing ends.
AGREEMENT = {
    "half_truck": (5e-5, 2e-5, 3e-4, 2e-4),
    "quarter_truck": (5e-5, 2e-5, 1e-4, 2e-4),
    "three_axles": (5e-5, 2e-5, 2e-4, 3e-4),
    "footprint": (5e-5, 2e-5, 1e-4, 2e-4),
}


@pytest.mark.filterwarnings("ignore::movingfrf.ValidityWarning")
@pytest.mark.parametrize("name", AGREEMENT)
def test_time_and_frequency_domain_converge_to_each_other(name):
    """Neither knows anything of the other: no elements there, no moving FRF here.

    The last 50 ms are left out: there the frequency domain continues the profile past its end, the time domain
    keeps it as it is, and a footprint sees that.
    """
    differences = []
    for element, step in ((0.5, 1e-3), (0.25, 5e-4), (0.125, 2.5e-4)):
        spectral = mf.simulate(
            TRACK, VEHICLES[name], rough(), speed=10.0, duration=2.5, time_step=step, truncation=300.0
        )
        stepped = mf.cdfm(
            travelling(element), VEHICLES[name], rough(), speed=10.0, duration=2.5, time_step=step, superposed=True
        )
        np.testing.assert_allclose(stepped.static_load, spectral.static_load, rtol=1e-5)
        np.testing.assert_allclose(stepped.static_deflection, spectral.static_deflection, rtol=1e-3)
        differences.append(list(apart(stepped, spectral, slice(0, round(2.45 / step))).values()))
        if name != "footprint":
            assert difference(stepped.roughness, spectral.roughness) < 1e-12
    differences = np.array(differences)
    assert (differences[-1] < AGREEMENT[name]).all()
    assert (differences[1] < 0.5 * differences[0]).all()
    assert (differences[2] < 0.75 * differences[1]).all()


@pytest.mark.parametrize("tolerance", [1e-4, 1e-7, 1e-11])
@pytest.mark.parametrize("name", ["half_truck", "three_axles"])
def test_exchanged_forces_are_the_solved_ones(name, tolerance):
    """SIM stops when a step's forces change by less than the tolerance; what is left is a tenth of that or less."""
    road = travelling(0.5)
    coupled = over_hump(road, name)
    exchanged = over_hump(road, name, mf.sim, tolerance=tolerance)
    total = [result.contact_force + result.static_load for result in (exchanged, coupled)]
    assert difference(*total) < tolerance
    assert 1 < exchanged.attrs["iterations"] < 20
    assert coupled.attrs["iterations"] == 0
    if tolerance > 1e-10:
        assert difference(*total) > 1e-14


def test_a_looser_exchange_takes_fewer_rounds():
    road = travelling(0.5)
    rounds = [over_hump(road, method=mf.sim, tolerance=tol).attrs["iterations"] for tol in (1e-3, 1e-6, 1e-12)]
    assert rounds[0] < rounds[1] < rounds[2]


# Every way through the loops: (road, vehicle, scheme, method, weight superposed).
CORNERS = [
    ("still", "quarter_truck", "average_acceleration", mf.cdfm, False),
    ("travelling", "half_truck", "average_acceleration", mf.cdfm, True),
    ("pinned", "three_axles", "average_acceleration", mf.sim, False),
    ("travelling", "three_axles", "hilber_hughes_taylor", mf.cdfm, False),
    ("still", "half_truck", "hilber_hughes_taylor", mf.sim, False),
    ("travelling", "quarter_truck", "generalised_alpha", mf.sim, True),
    ("pinned", "half_truck", "generalised_alpha", mf.cdfm, False),
    ("travelling", "half_truck", "generalised_alpha", mf.cdfm, False),
]


@pytest.mark.parametrize(("road", "vehicle", "scheme", "method", "superposed"), CORNERS)
def test_compiled_and_plain_loops_are_one(road, vehicle, scheme, method, superposed):
    """The same arithmetic in another order: rounding, which the second derivative in time amplifies."""
    roads = {
        "still": mf.finite_track(TRACK, first=-10.0, last=20.0, element=0.5, absorbing=6.0),
        "pinned": mf.finite_track(TRACK, first=-10.0, last=20.0, element=0.5, ends="pinned"),
        "travelling": travelling(0.5, 12.0, 8.0),
    }
    compiled, plain = (
        over_hump(
            roads[road],
            vehicle,
            method,
            speed=20.0,
            duration=0.4,
            time_step=4e-3,
            run_in=0.35,
            scheme=scheme,
            superposed=superposed,
            compiled=flag,
        )
        for flag in (True, False)
    )
    assert max(apart(compiled, plain).values()) < 1e-10
    assert compiled.attrs["iterations"] == plain.attrs["iterations"]
    # In eight metres at 20 m/s a travelling road has moved on by sixteen elements.
    np.testing.assert_allclose(compiled.static_deflection, plain.static_deflection, rtol=1e-11)


@pytest.mark.parametrize("scheme", ["average_acceleration", "hilber_hughes_taylor", "generalised_alpha"])
@pytest.mark.parametrize("travels", [False, True], ids=["still", "travelling"])
def test_compiled_and_plain_loops_under_prescribed_forces(scheme, travels):
    time = 2e-3 * np.arange(100)
    force = 1e5 * np.stack([np.cos(30 * time), np.sin(50 * time) ** 2], axis=1)
    road = mf.finite_track(TRACK, first=-12.0, last=14.0, element=0.5, absorbing=6.0, travels=travels)
    compiled, plain = (
        mf.newmark_loads(
            road,
            force,
            [0.0, -3.3],
            speed=20.0,
            time_step=2e-3,
            observe=[0.1, 4.0, -5.0],
            scheme=scheme,
            compiled=flag,
        ).deflection
        for flag in (True, False)
    )
    assert difference(compiled, plain) < 1e-11


@pytest.mark.parametrize("method", [mf.cdfm, mf.sim])
def test_points_of_the_road_that_stand_still(method):
    """A point sees what the contact sees while that passes it, and in both loops the same."""
    road = mf.finite_track(TRACK, first=-10.0, last=20.0, element=0.5, absorbing=6.0)
    options = {"speed": 20.0, "duration": 0.4, "time_step": 2.5e-3, "run_in": 0.5, "observe": [3.0, 4.4]}
    compiled, plain = (over_hump(road, "quarter_truck", method, compiled=flag, **options) for flag in (True, False))
    assert difference(compiled.place_deflection, plain.place_deflection) < 1e-10
    # The contact is at 3.0 m after 60 steps and at 4.4 m after 88; what is recorded does not change the journey.
    for place, step in ((0, 60), (1, 88)):
        seen = compiled.place_deflection.values[step, place]
        assert seen == pytest.approx(compiled.deflection.values[step, 0], rel=1e-12)
    alone = over_hump(road, "quarter_truck", method, **(options | {"observe": ()}))
    assert (alone.contact_force.values == compiled.contact_force.values).all()
    assert "place_deflection" not in alone


def test_without_numba_the_plain_loops_are_used(monkeypatch):
    road = travelling(0.5, 12.0, 8.0)
    options = {"duration": 0.05, "run_in": 0.01}
    plain = over_hump(road, compiled=False, **options)
    monkeypatch.setattr("movingfrf.stepping.marching.usable", lambda _: False)
    left_open = over_hump(road, **options)
    assert (left_open.contact_force.values == plain.contact_force.values).all()


def permuted(road, seed=3):
    """Hand a road over as another program would: its unknowns in any order, no mesh."""
    order = np.random.default_rng(seed).permutation(road.dofs)
    return mf.FiniteGuideway(
        **{name: getattr(road, name)[order][:, order] for name in ("mass", "damping", "stiffness")},
        interpolation=lambda x, derivative: sparse.csr_array(road.interpolation(x, derivative))[:, order],
        interval=road.interval,
        spacing=road.spacing,
    )


@pytest.mark.parametrize(("method", "vehicle"), [(mf.cdfm, "half_truck"), (mf.sim, "quarter_truck")])
def test_a_users_matrices_in_any_order(method, vehicle):
    """Solved by sparse LU instead of band Cholesky, otherwise the same system."""
    road = mf.finite_track(TRACK, first=-10.0, last=20.0, element=0.5, absorbing=6.0)
    options = {"duration": 0.4, "time_step": 4e-3, "run_in": 0.35, "speed": 20.0}
    own, users = (over_hump(each, vehicle, method, **options) for each in (road, permuted(road)))
    assert max(apart(users, own).values()) < 1e-10
    np.testing.assert_allclose(users.static_deflection, own.static_deflection, rtol=1e-11)


def test_another_kind_of_elements():
    """A pinned beam by its first sine waves (diagonal matrices) against cubic elements.

    The waves left out would deflect by L³/(3π⁴ EI n³) under the load, 1e-4 of the whole with n = 120; elements of
    0.125 m lack a tenth of that, and shake the vehicle by as much from node to node.
    """
    length, count = 30.0, 120
    kappa = np.pi * np.arange(1, count + 1) / length
    waves = mf.FiniteGuideway(
        mass=np.eye(count) * 711.9 * length / 2,
        damping=np.eye(count) * 3.0e4 * length / 2,
        stiffness=np.diag(1.573e7 * kappa**4 + 8.0e6) * length / 2,
        interpolation=lambda x, d: (
            np.cos(np.outer(x + 10, kappa)) * kappa if d else np.sin(np.outer(x + 10, kappa))
        ),
        interval=(-10.0, 20.0),
    )
    elements = mf.finite_track(TRACK, first=-10.0, last=20.0, element=0.125, ends="pinned")
    options = {"duration": 0.8, "time_step": 1e-3, "run_in": 0.3, "vehicle": DASHPOT}
    first, second = (over_hump(road, **options) for road in (waves, elements))
    assert difference(first.deflection, second.deflection) < 3e-4
    assert difference(first.contact_force, second.contact_force) < 3e-4


def test_a_travelling_road_is_a_long_one():
    """Seen from the vehicle an endless road is the same wherever it is; ends are out of sight in both."""
    whole = over_hump(mf.finite_track(TRACK, first=-50.0, last=60.0, element=0.25, absorbing=20.0))
    moving = over_hump(travelling(0.25))
    assert max(apart(moving, whole).values()) < 2e-5
    np.testing.assert_allclose(moving.static_deflection, whole.static_deflection, rtol=1e-6)


@pytest.mark.parametrize("ends", ["pinned", "guided", "free", ("absorbing", "pinned")])
def test_a_travelling_road_with_ends_that_would_jump_is_refused(ends):
    """What joins it is at rest: where an end is not held that feeds energy in, which doubles in each element."""
    with pytest.raises(ValueError, match="ends of a road that travels along must be among absorbing, clamped"):
        travelling(0.25, ends=ends)


def test_a_travelling_road_with_clamped_ends():
    assert max(apart(over_hump(travelling(0.25, ends="clamped")), over_hump(travelling(0.25))).values()) < 1e-4


def test_contacts_of_a_travelling_road_stay_on_it():
    """Within an element's passage a contact runs up to one element ahead of where it stands: there must be room."""
    last = 2.25  # the foremost contact of the half truck is at 2.216 m
    road = mf.finite_track(TRACK, first=-20.0, last=last, element=0.25, ends="clamped", travels=True)
    with pytest.raises(ValueError, match="road must reach"):
        over_hump(road, duration=0.1, run_in=0.1)


def test_long_steps_of_a_travelling_road():
    """In one step it may move on by more than its own length: both loops then begin with a road at rest."""
    road = travelling(0.5, 10.0, 6.0)
    options = {"speed": 25.0, "duration": 3.0, "time_step": 1.0, "superposed": True, "start": -37.0}
    compiled, plain = (over_hump(road, compiled=flag, **options) for flag in (True, False))
    np.testing.assert_allclose(compiled.contact_force, plain.contact_force, atol=1e-9)


# In a process of its own, since what is written beyond the end of an array may end it.
ABSURD = """
import numpy as np, movingfrf as mf
beam = mf.EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9)
track = mf.track(beam, mf.Spring(stiffness=8e6, damping=3e4))
road = mf.finite_track(track, first=-10.0, last=10.0, element=0.5, travels=True)
try:
    for _ in range(5):
        mf.newmark_loads(road, np.full((100, 1), 1e5), [0.0], speed=30.0, time_step=10.0, compiled=True)
except ValueError:
    pass
print("done")
"""


def test_absurd_steps_of_a_travelling_road():
    """Hundreds of metres in one step: refused or computed, but nothing is written outside the road's arrays."""
    done = subprocess.run([sys.executable, "-c", ABSURD], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (0, "done\n"), done.stderr[-500:]


BURST = (lambda t: 1e5 * np.sin(np.pi * np.clip(t / 0.2, 0.0, 1.0)) ** 2 * np.cos(2 * np.pi * 50 * t))(
    5e-4 * np.arange(1600)
)[:, None]


def test_absorbing_ends_reflect_little():
    """A burst of waves of 50 Hz, struck in the middle: 20 m of absorption return less than 3e-4 to within 8 m.

    Against a road so long that nothing is back within 0.8 s (waves of 50 Hz run at some 300 m/s). Pinned ends
    return a fifth; what is absorbed is what comes in, no more: the road as a whole gives way alike.
    """
    at = {"speed": 0.0, "time_step": 5e-4, "observe": [0.0, 4.0, -8.0]}
    endless = mf.newmark_loads(
        mf.finite_track(TRACK, first=-130.0, last=130.0, ends="pinned"), BURST, [0.0], **at
    ).deflection
    back = {}
    for ends, absorbing in (("absorbing", 20.0), ("pinned", 0.0)):
        short = mf.finite_track(TRACK, first=-30.0, last=30.0, ends=ends, absorbing=absorbing)
        seen = mf.newmark_loads(short, BURST, [0.0], **at).deflection
        back[ends] = float(np.abs(seen - endless).max() / np.abs(endless).max())
    assert back["absorbing"] < 3e-4
    assert back["pinned"] > 0.03


def test_superposed_weight_is_the_stepped_one_under_refinement():
    """On a road that is the same everywhere; between nodes elements give way by a part of order 3 differently."""
    differences = []
    for element in (0.5, 0.25, 0.125):
        road = travelling(element)
        superposed, stepped = (over_hump(road, superposed=flag) for flag in (True, False))
        np.testing.assert_allclose(superposed.static_load, stepped.static_load, rtol=1e-12)
        differences.append(list(apart(stepped, superposed).values()))
    differences = np.array(differences)
    # Halving the element divides by eight; acceleration and deflection feel it most.
    assert (differences[1:] < 0.2 * differences[:-1]).all()
    assert differences[-1].max() < 3e-4


@pytest.mark.parametrize("superposed", [True, False], ids=["superposed", "stepped weight"])
def test_three_axles_share_their_weight_as_the_road_gives_way(superposed):
    """The sag redistributes the loads of a rigid road; `simulate` finds the same from the moving FRF at ω = 0."""
    truck = VEHICLES["three_axles"]
    spectral = mf.simulate(TRACK, truck, FLAT, speed=20.0, duration=0.5)
    stepped = mf.cdfm(travelling(0.25), truck, FLAT, speed=20.0, duration=0.5, superposed=superposed)
    shifted = np.abs(spectral.static_load - truck.static_loads).max()
    assert shifted > 0.003 * truck.static_loads.max()
    assert np.abs(stepped.static_load - spectral.static_load).max() < 1e-3 * shifted
    assert float(stepped.static_load.sum()) == pytest.approx(truck.static_loads.sum(), rel=1e-12)
    np.testing.assert_allclose(stepped.static_deflection, spectral.static_deflection, rtol=2e-4)
    # On the smooth road nothing else happens than the passage of elements.
    assert np.abs(stepped.contact_force).max() < 1e-4 * truck.static_loads.max()


# Alike left and right.
FOUR_WHEELS = mf.full_car(**(FULL_TRUCK | {"sides": (0.9, -0.9)}))


@pytest.mark.filterwarnings("ignore:the vehicle's motion has not died away")
@pytest.mark.parametrize("way", ["simulate", "cdfm", "sim"])
def test_four_wheels_on_a_beam_are_two_axles(way):
    """Equal paths: both sides share an axle's force, and nothing rolls. Opposite ones: the body rolls, no more.

    A beam deflects alike under both sides, so that opposite forces leave it at rest. The same equations in another
    order: rounding (1e-12).
    """
    methods = {
        "simulate": lambda *who: mf.simulate(
            TRACK, *who, speed=10.0, duration=2.0, truncation=300.0, solved_step=1e-3
        ),
        "cdfm": lambda *who: mf.cdfm(travelling(0.25, 25.0, 15.0), *who, speed=10.0, duration=2.0, superposed=True),
        "sim": lambda *who: mf.sim(travelling(0.25, 25.0, 15.0), *who, speed=10.0, duration=2.0, superposed=True),
    }
    stations, elevation = rough().distance, np.ravel(rough().elevation)
    equal, opposite = (
        methods[way](FOUR_WHEELS, mf.Profile(stations, np.stack([elevation, sign * elevation], axis=1)))
        for sign in (1, -1)
    )
    axles = methods[way](mf.half_car(**HALF_TRUCK), rough())
    within = 1e-9 if way != "sim" else 1e-8  # exchanged to 1e-10
    force = equal.contact_force.values.reshape(-1, 2, 2)
    assert difference(force.sum(axis=2), axles.contact_force) < within
    assert np.abs(force[..., 0] - force[..., 1]).max() < within * np.abs(force).max()
    for name in ("bounce", "pitch"):
        for output in ("motion", "acceleration"):
            assert difference(equal[output].sel(dof=name), axles[output].sel(dof=name)) < within
    np.testing.assert_allclose(equal.deflection[:, ::2], axles.deflection, rtol=within)
    np.testing.assert_allclose(equal.static_load.values.reshape(2, 2).sum(axis=1), axles.static_load, rtol=1e-9)
    largest = {name: float(np.abs(opposite.motion.sel(dof=name)).max()) for name in ("bounce", "pitch", "roll")}
    assert np.abs(equal.motion.sel(dof="roll")).max() < within * largest["roll"]
    assert max(largest["bounce"], largest["pitch"]) < within * largest["roll"]
    assert largest["roll"] > 1e-3
    moving = (opposite.deflection - opposite.static_deflection).values
    assert np.abs(moving).max() < within * np.abs(opposite.deflection).max()
    force = opposite.contact_force.values
    assert np.abs(force[:, ::2] + force[:, 1::2]).max() < within * np.abs(force).max()

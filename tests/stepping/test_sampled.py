"""A guideway known by samples: its transform against known ones, and what it refuses to know."""

from __future__ import annotations

import numpy as np
import pytest

import movingfrf as mf
from tests.helpers import VEHICLES

STEP = 1e-3
TIME = STEP * np.arange(4001)  # not a whole number of blocks
SIZES, RATES = np.array([1e-6, 4e-7, -2e-7]), np.array([10.0, 25.0, 60.0])
ROAD = mf.SampledGuideway(
    response=SIZES * np.exp(-RATES * TIME[:, None]), time_step=STEP, offsets=[0.0, 3.0, -3.0], speed=10.0
)
OMEGA = 2 * np.pi * np.concatenate([np.linspace(0.0, 100.0, 1500), [250.0, 499.0]])


@pytest.mark.parametrize("below", [0.0, 1.5], ids=["real", "below the axis"])
def test_transform_of_exponentials(below):
    """A e^{−at} has the transform A/(a + iω), for complex ω as well, up to the Nyquist frequency."""
    omega = OMEGA - 1j * below
    found = ROAD.moving_frf([0.0, 3.0, -3.0], 10.0, omega)
    exact = SIZES / (RATES + 1j * omega[:, None])
    # Four powers of time say of e^{−60 t} all but (60 ms⁻¹)⁵ of it.
    assert np.abs(found - exact).max() < 1e-9 * np.abs(exact).max()


@pytest.mark.parametrize("below", [0.0, 1.5], ids=["real", "below the axis"])
def test_transform_of_what_was_stepped(below):
    """A sum over samples from zero on: A Δt q/(1 − q) with q = e^{−(a+iω)Δt}, since nothing is left at the end."""
    response = np.where(TIME[:, None] > 0, ROAD.samples, 0.0)
    road = mf.SampledGuideway(response=response, time_step=STEP, offsets=[0.0, 3.0, -3.0], speed=10.0, stepped=True)
    omega = OMEGA - 1j * below
    found = road.moving_frf([0.0, 3.0, -3.0], 10.0, omega)
    decay = np.exp(-(RATES + 1j * omega[:, None]) * STEP)
    rule = SIZES * STEP * decay / (1 - decay)
    # After four seconds e^{(1.5 − 10) 4} is left at most, 2e-15.
    assert np.abs(found - rule).max() < 1e-12 * np.abs(rule).max()


def test_offsets_in_any_order_and_shape():
    whole = ROAD.moving_frf([0.0, 3.0, -3.0], 10.0, OMEGA)
    ahead = np.array([[0.0, -3.0, 3.0], [3.0, 3.0, 0.0]])
    found = ROAD.moving_frf(ahead, 10.0, OMEGA)
    assert found.shape == (OMEGA.size, 2, 3)
    assert (found == whole[:, [[0, 2, 1], [1, 1, 0]]]).all()
    assert ROAD.moving_frf(3.0, 10.0, OMEGA).shape == (OMEGA.size,)
    assert ROAD.moving_frf([3.0, 0.0], 10.0, 5.0, across=[[0.0], [1.0]]).shape == (1, 2, 2)
    # A distance that was computed another way is the same distance.
    assert (ROAD.moving_frf(3.0 + 1e-9, 10.0, OMEGA) == whole[:, 1]).all()


def test_beyond_half_the_sampling_frequency_the_road_is_rigid():
    found = ROAD.moving_frf([0.0], 10.0, 2 * np.pi * np.array([499.0, 501.0, 5000.0, -501.0]))
    assert found[0] != 0
    assert (found[1:] == 0).all()


def test_negative_frequencies_are_conjugate():
    found = ROAD.moving_frf([0.0], 10.0, [-30.0, 30.0])
    assert found[0] == pytest.approx(found[1].conj(), rel=1e-13)


# On a road with a width: every size once, (ahead, across, source across) → size.
PLACES = {(0.0, 0.0, 0.7): 1e-6, (0.0, -1.4, 0.7): 2e-6, (0.0, 1.4, -0.7): 3e-6, (2.5, 0.0, 0.7): 4e-6}
WIDE = mf.SampledGuideway(
    response=np.exp(-20.0 * TIME[:, None]) * list(PLACES.values()),
    time_step=STEP,
    offsets=[ahead for ahead, _, _ in PLACES],
    across=[across for _, across, _ in PLACES],
    source_across=[source for _, _, source in PLACES],
    speed=10.0,
)


def test_places_across_choose_the_column():
    """Offset along, offset across and place of the source together; places in any shape that broadcasts."""
    unit = WIDE.moving_frf(0.0, 10.0, [5.0], across=0.0, source_across=0.7)[0] / PLACES[0.0, 0.0, 0.7]
    for (ahead, across, source), size in PLACES.items():
        found = WIDE.moving_frf(ahead, 10.0, [5.0], across=across, source_across=source)
        assert found[0] == pytest.approx(size * unit, rel=1e-12)
    table = WIDE.moving_frf(0.0, 10.0, [5.0], across=[[0.0], [-1.4]], source_across=[0.7, 0.7, 0.7])
    assert table.shape == (1, 2, 3)
    np.testing.assert_allclose(table[0], unit * np.outer([1e-6, 2e-6], np.ones(3)), rtol=1e-12)
    # Where places across make no difference they only give the shape.
    plain = ROAD.moving_frf(3.0, 10.0, [5.0], across=[0.5, -0.5], source_across=[[1.0], [9.0]])
    assert plain.shape == (1, 2, 2)
    assert (plain == ROAD.moving_frf(3.0, 10.0, [5.0])[0]).all()


@pytest.mark.parametrize(
    "asked", [(0.0, 0.0, 0.0), (2.5, -1.4, 0.7), (0.0, 0.0, -0.7), (0.0, 0.7, -1.4), (0.0, -1.399, 0.7)]
)
def test_places_that_were_not_recorded_together_are_refused(asked):
    ahead, across, source = asked
    message = rf"ahead, across, source_across must be one of .* \[\[0.0, 0.0, 0.7\], .* m, got {ahead}, {across}, "
    with pytest.raises(ValueError, match=message):
        WIDE.moving_frf([0.0, ahead], 10.0, [1.0], across=[-1.4, across], source_across=[0.7, source])


@pytest.mark.parametrize(
    ("arguments", "more", "message"),
    [
        (([0.0], 11.0, [1.0]), {}, "speed must be 10.0 m/s, at which the impulse response was recorded, got 11.0"),
        (([0.0], np.nan, [1.0]), {}, "speed must be 10.0 m/s"),
        (([0.0, 1.0], 10.0, [1.0]), {}, r"ahead must be one of the recorded offsets \[0.0, 3.0, -3.0\] m, got 1.0"),
        (([3.001], 10.0, [1.0]), {}, "ahead must be one of the recorded"),
        (
            ([0.0], 10.0, [1.0]),
            {"derivative": 1},
            "derivative must be 0: this guideway knows deflections only, got 1",
        ),
    ],
)
def test_what_was_not_recorded_is_refused(arguments, more, message):
    with pytest.raises(ValueError, match=message):
        ROAD.moving_frf(*arguments, **more)


def test_a_missing_offset_is_refused_by_whoever_needs_it():
    profile = mf.Profile(np.linspace(-10.0, 40.0, 6), np.zeros(6))
    for call in (mf.simulate, mf.duhamel):
        with pytest.raises(ValueError, match="ahead must be one of the recorded offsets"):
            call(ROAD, VEHICLES["half_truck"], profile, speed=10.0, duration=1.0)
        with pytest.raises(ValueError, match=r"speed must be 10\.0 m/s"):
            call(ROAD, VEHICLES["quarter_car"], profile, speed=12.0, duration=1.0)


GOOD = {"response": np.ones((5, 2)), "time_step": 1e-3, "offsets": [0.0, 1.0], "speed": 10.0}


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"response": np.ones(5)}, r"response must have shape \(any, 2\), got \(5,\)"),
        ({"response": np.ones((5, 3))}, r"response must have shape \(any, 2\), got \(5, 3\)"),
        ({"response": np.full((5, 2), np.inf)}, "response must be finite"),
        ({"response": np.ones((1, 2))}, "response must hold at least two samples and one offset"),
        ({"response": np.ones((5, 0)), "offsets": []}, "response must hold at least two samples and one offset"),
        ({"time_step": -1e-3}, "time_step must be positive"),
        ({"speed": np.inf}, "speed must be a finite number"),
        ({"critical_speed": 0.0}, "critical_speed must be positive, got 0.0 m/s"),
        ({"across": [0.0, 1.0]}, r"across and source_across must be given both or neither \[m\]"),
        ({"source_across": [0.0, 1.0]}, "across and source_across must be given both or neither"),
        ({"across": [0.0], "source_across": [0.0, 1.0]}, r"across must have shape \(2\), got \(1,\)"),
        ({"across": [0.0, 1.0], "source_across": [0.0, np.nan]}, "source_across must be finite"),
    ],
)
def test_impossible_records(more, message):
    with pytest.raises(ValueError, match=message):
        mf.SampledGuideway(**(GOOD | more))


def test_a_record_is_kept_as_it_was_given():
    given = np.exp(-0.3 * np.arange(200.0))[:, None] * [1.0, 2.0]
    road = mf.SampledGuideway(**(GOOD | {"response": given}))
    given[:] = 2.0
    assert road.samples[0].tolist() == [1.0, 2.0]
    assert road.samples.max() == 2.0
    assert road.samples[-1].max() < 1e-20
    with pytest.raises(ValueError, match="read-only"):
        road.samples[0] = 0.0


def test_what_it_says_of_itself_tells_records_apart():
    """In the attributes of a result: not a dump that leaves out what differs, and whatever NumPy prints."""
    record = {"time_step": 1e-3, "offsets": [0.0], "speed": 10.0}
    response = 1e-6 * np.exp(-0.01 * np.arange(4000.0))[:, None]
    other = response.copy()
    other[500] *= 1.5
    one, same, two = (mf.SampledGuideway(response=part, **record) for part in (response, response.copy(), other))
    with np.printoptions(precision=2):
        assert repr(one) == repr(same)
    assert repr(one) != repr(two)
    assert "4000 samples of 1 offsets" in repr(one)

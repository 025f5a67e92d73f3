"""The coupled response against time-stepping: numbers computed without any frequency domain.

The references (FE beam and vehicle in one Newmark system, refined and extrapolated) were made for this project;
their own accuracy sets the tolerances: the two finest meshes differ by 1e-4 (force) and 4e-4 (acceleration).
"""

from pathlib import Path

import numpy as np
import pytest

import movingfrf as mf
from tests.helpers import DAMPED, VEHICLES

DATA = Path(__file__).parents[1] / "data"
FIRST = 6000  # the reference begins at 6 s in steps of 1 ms, and its last row is not part of a run of 10 s

# content up to: force, acceleration, deflection without its static sag
TOLERANCES = {"_6": (1.5e-4, 2e-4, 5e-4), "": (1.5e-4, 4e-4, 6e-4)}


def relative_l2(found, wanted):
    return np.sqrt(((found - wanted) ** 2).sum() / (wanted**2).sum())


@pytest.fixture(scope="module", params=TOLERANCES, ids=["60 Hz", "20 Hz"])
def case(request):
    suffix = request.param
    stations = np.loadtxt(DATA / f"coupled_profile{suffix}.csv.gz", delimiter=",", skiprows=1)
    wanted = np.genfromtxt(DATA / f"coupled_half_truck{suffix}.csv.gz", delimiter=",", names=True)[:-1]
    result = mf.simulate(
        DAMPED["euler_bernoulli_winkler"],
        VEHICLES["half_truck"],
        mf.Profile(stations[:, 0], stations[:, 1]),
        speed=10.0,
        duration=10.0,
        start=60.0,
        blend=0.0,
    )
    return result, wanted, TOLERANCES[suffix]


@pytest.mark.parametrize("span", [slice(0, None), slice(-1000, None)], ids=["4 s", "last second"])
@pytest.mark.parametrize(("contact", "name"), [(0, "front"), (1, "rear")])
def test_force_and_deflection(case, span, contact, name):
    result, wanted, (force_tolerance, _, deflection_tolerance) = case
    force = result.contact_force.values[FIRST:, contact]
    assert relative_l2(force[span], wanted[f"force_{name}_N"][span]) < force_tolerance
    # The reference's own static sag differs by its mesh error; what is judged is what moves.
    sag = result.static_deflection.values[contact]
    deflection = result.deflection.values[FIRST:, contact] - sag
    assert relative_l2(deflection[span], wanted[f"deflection_{name}_m"][span] - sag) < deflection_tolerance


@pytest.mark.parametrize("span", [slice(0, None), slice(-1000, None)], ids=["4 s", "last second"])
@pytest.mark.parametrize(
    ("dof", "column"),
    [
        ("bounce", "accel_bounce_m_s2"),
        ("pitch", "accel_pitch_rad_s2"),
        ("front_wheel", "accel_front_wheel_m_s2"),
        ("rear_wheel", "accel_rear_wheel_m_s2"),
    ],
)
def test_accelerations(case, span, dof, column):
    result, wanted, (_, tolerance, _) = case
    acceleration = result.acceleration.sel(dof=dof).values[FIRST:]
    assert relative_l2(acceleration[span], wanted[column][span]) < tolerance


def test_static_sag_is_that_of_the_reference(case):
    """Before the rough road the reference has been travelling smoothly; its mesh error is 1e-4."""
    result, wanted, _ = case
    assert result.static_deflection.values[0] == pytest.approx(wanted["deflection_front_m"].mean(), rel=0.02)
    assert result.static_load.values.sum() == pytest.approx((17735 + 1500 + 1000) * 9.81, rel=1e-12)

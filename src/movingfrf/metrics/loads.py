"""What contact forces do to the road: dynamic load, road stress, aggregate force, repeatability, lost contact."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from movingfrf._basics.arrays import BoolArray, FloatArray, require_memory
from movingfrf._basics.checks import Checks, checking, real_numbers
from movingfrf._basics.door import instead_of, mistaken
from movingfrf._basics.spline import cubic
from movingfrf._basics.values import Value
from movingfrf._basics.wording import told_apart
from movingfrf.results.labels import flaws, resolved, time_step_of

if TYPE_CHECKING:
    import xarray as xr


# Distance between points of the road at which forces are added up [m] [a convention].
POINT_SPACING = 0.1


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ContactLoss(Value):
    """For how long each contact bears nothing."""

    share: FloatArray  # of the time, shape (contact,)
    longest: FloatArray  # longest loss [s], shape (contact,)


def dynamic_load_coefficient(result: xr.Dataset, *, since: float = 0.0) -> FloatArray:
    """Root mean square of each dynamic contact force over its load in steady travel.

    Parameters
    ----------
    result : xarray.Dataset
        The coupled response of a vehicle, from `simulate`, `cdfm` or `sim`.
    since : float
        Seconds to leave out at the start [s]: there wheels may not have reached the rough road yet.

    Returns
    -------
    ndarray, shape (contact,)
        Dynamic load coefficients, dimensionless; inf for a contact that bears nothing in steady travel, which
        may come of a road that sags away from under an axle between others.

    Raises
    ------
    ValueError
        If the result has no contact forces, or nothing is left of the record.

    References
    ----------
    D. Cebon, Handbook of Vehicle-Road Interaction, Swets & Zeitlinger, 1999.
    """
    with checking() as check:
        result = check_coupled(check, result, since=since)
    return load_coefficient(np.sqrt(np.mean(result.contact_force.values**2, axis=0)), result.static_load.values)


def load_coefficient(rms: FloatArray, load: FloatArray) -> FloatArray:
    """Root mean square of dynamic forces over steady loads.

    Parameters
    ----------
    rms : ndarray, shape (contact,)
        Root mean square of the dynamic force [N].
    load : ndarray, shape (contact,)
        Contact force in steady travel [N].

    Returns
    -------
    ndarray, shape (contact,)
        Dynamic load coefficients, dimensionless; inf where the load is not positive.
    """
    return np.divide(rms, load, out=np.full(rms.shape, np.inf), where=load > 0)


def road_stress_factor(coefficient: ArrayLike) -> FloatArray:
    """Mean fourth power of a Gaussian force over the fourth power of its mean, 1 + 6 s² + 3 s⁴.

    Parameters
    ----------
    coefficient : array_like, shape (*s)
        Dynamic load coefficient s, a ratio.

    Returns
    -------
    ndarray, shape (*s)
        Factor by which the dynamic load raises road wear if that goes with the fourth power of the force and if
        every point of the road meets the same distribution of forces.

    Raises
    ------
    ValueError
        If a coefficient is negative or nan.

    References
    ----------
    J. Eisenmann, Dynamic wheel load fluctuations: road stress, Strasse und Autobahn 4 (1975) 127-128.

    Examples
    --------
    >>> road_stress_factor([0.0, 0.2])
    array([1.    , 1.2448])
    """
    with checking() as check:
        # Forces are no ratios, whether or not they are all positive.
        if hasattr(coefficient, "data_vars") or getattr(coefficient, "attrs", {}).get("units", "1") != "1":
            check.refuse("coefficient", mistaken("load coefficient", coefficient))
    s = real_numbers(coefficient)
    with checking() as check:
        if not (s >= 0).all():
            hint = instead_of("load coefficient", coefficient)
            check.refuse("coefficient", f"must be at least zero throughout, got {s[~(s >= 0)][0]:g}{hint}")
    return 1 + 6 * s**2 + 3 * s**4


def aggregate_force(
    result: xr.Dataset, *, power: float = 4.0, spacing: float = POINT_SPACING, since: float = 0.0
) -> xr.Dataset:
    """Add up what all contacts of a vehicle do to each point of the road, Σ_j P_jk^n.

    P_jk is the total force of contact j as it passes point k. Points lie at whole multiples of the spacing, where
    every contact passes during the record. A force that turns to tension counts as none, a static load too.

    Parameters
    ----------
    result : xarray.Dataset
        The coupled response of a vehicle, from `simulate`, `cdfm` or `sim`.
    power : float
        Exponent n to which wear goes with force: 4 for fatigue of flexible pavements, 1 for rutting.
    spacing : float
        Distance between points [m].
    since : float
        Seconds to leave out at the start [s]: there wheels may not have reached the rough road yet.

    Returns
    -------
    xarray.Dataset
        `aggregate_force` (distance, path) [N^n] and `static_aggregate` (path), the same of the static loads.

    Raises
    ------
    ValueError
        If the result has no contact forces, a value is not positive, nothing is left of the record, no point meets
        every contact, or memory does not hold the points.

    References
    ----------
    D. J. Cole, D. Cebon, Spatial repeatability of dynamic tyre forces generated by heavy vehicles, Proceedings of
    the Institution of Mechanical Engineers D 206 (1992) 17-27. D. Cebon, Handbook of Vehicle-Road Interaction,
    Swets & Zeitlinger, 1999.

    Examples
    --------
    >>> import movingfrf as mf
    >>> car = mf.quarter_car(body_mass=400.0, wheel_mass=40.0, suspension_stiffness=2e4,
    ...                      suspension_damping=1.5e3, tyre_stiffness=2e5)
    >>> hump = mf.bump(height=0.02, width=1.0, at=5.0, length=30.0)
    >>> result = mf.simulate(mf.RigidGuideway(), car, hump, speed=10.0, duration=2.0, blend=0.0)
    >>> worn = mf.aggregate_force(result)
    >>> round(float((worn.aggregate_force / worn.static_aggregate).max()), 1)
    4.6
    """
    import xarray as xr

    with checking() as check:
        result = check_coupled(check, result, since=since)
        power = check.positive("power", power, "1")
        spacing = check.positive("spacing", spacing, "m")
    speed, time = result.attrs["speed"], result.time.values
    starts = result.attrs["start"] + result.position.values
    static, paths = result.static_load.values, result.path.values
    numbers = np.unique(paths)
    points = common_points(result, spacing)
    if not points.size:
        apart, covered = told_apart(np.ptp(starts), speed * np.ptp(time))
        raise ValueError(
            "result must be long enough for every contact to pass one point: contacts lie up to "
            f"{apart} m apart, and the record covers {covered} m"
        )
    found, rest = np.zeros((points.size, numbers.size)), np.zeros(numbers.size)
    for contact, start in enumerate(starts):
        passed = np.clip((points - start) / speed, time[0], time[-1])
        force = static[contact] + cubic(time, result.contact_force.values[:, contact])(passed)
        column = int(np.searchsorted(numbers, paths[contact]))
        found[:, column] += np.maximum(force, 0.0) ** power
        rest[column] += max(static[contact], 0.0) ** power
    units = "N" if power == 1 else f"N^{power:g}"
    return xr.Dataset(
        {
            "aggregate_force": (
                ("distance", "path"),
                found,
                {"units": units, "long_name": "force on a point of the road, summed over all contacts"},
            ),
            "static_aggregate": (
                ("path",),
                rest,
                {"units": units, "long_name": "the same of the static loads"},
            ),
        },
        {
            "distance": ("distance", points, {"units": "m", "long_name": "point of the road"}),
            "path": ("path", numbers, {"units": "1", "long_name": "path of the profile"}),
        },
        {"power": float(power), "spacing": float(spacing)},
    )


def common_points(result: xr.Dataset, spacing: float = POINT_SPACING) -> FloatArray:
    """Points of the road that every contact passes during the record, at whole multiples of the spacing.

    Parameters
    ----------
    result : xarray.Dataset
        The coupled response of a vehicle.
    spacing : float
        Distance between points [m].

    Returns
    -------
    ndarray, shape (distance,)
        Positions [m]; none where the record is shorter than the vehicle.

    Raises
    ------
    ValueError
        If memory does not hold what is to be added up at so many points.
    """
    starts = result.attrs["start"] + result.position.values
    first = starts.max() + result.attrs["speed"] * result.time.values[0]
    last = starts.min() + result.attrs["speed"] * result.time.values[-1]
    # Bytes per point at the peak of adding up forces, beside those of every path; 40 as measured [40 to 128].
    bytes_per_point = 64
    require_memory(
        (last - first) / spacing * (bytes_per_point + 8 * np.unique(result.path.values).size),
        f"a spacing of {spacing:g} m between points",
    )
    return spacing * np.arange(np.ceil(first / spacing - 1e-9), np.floor(last / spacing + 1e-9) + 1)


def road_wear(
    result: xr.Dataset, *, power: float = 4.0, percentile: float = 95.0, since: float = 0.0
) -> FloatArray:
    """Aggregate force that a share of the road's points bear at most, over that of the static loads.

    Parameters
    ----------
    result : xarray.Dataset
        The coupled response of a vehicle.
    power : float
        Exponent to which wear goes with force.
    percentile : float
        Share of the points [%]: roads fail where they are worst, not on average.
    since : float
        Seconds to leave out at the start [s]: there wheels may not have reached the rough road yet.

    Returns
    -------
    ndarray, shape (path,)
        Ratio; 1 on a smooth road, inf without static loads.

    Raises
    ------
    ValueError
        As for `aggregate_force`, or if the percentile does not lie between 0 and 100.

    References
    ----------
    D. Cebon, Handbook of Vehicle-Road Interaction, Swets & Zeitlinger, 1999.
    """
    with checking() as check:
        if not 0 <= (percentile := check.finite("percentile", percentile, "%")) <= 100:
            check.refuse("percentile", f"must lie between 0 and 100 %, got {percentile!r} %")
    worn = aggregate_force(result, power=power, since=since)
    most, static = np.percentile(worn.aggregate_force.values, percentile, axis=0), worn.static_aggregate.values
    return np.divide(most, static, out=np.full(most.shape, np.inf), where=static != 0)


def spatial_repeatability(
    first: xr.Dataset, second: xr.Dataset, *, spacing: float = POINT_SPACING, since: float = 0.0
) -> FloatArray:
    """Correlation of the forces that two vehicles, or two runs, put on the same points of a road.

    The spatial repeatability index: the correlation coefficient over the road's points of the forces, each summed
    over the contacts of its vehicle. Near 1 both load the same points most, and wear concentrates there.

    Parameters
    ----------
    first, second : xarray.Dataset
        Coupled responses on the same road; speeds and vehicles may differ.
    spacing : float
        Distance between points [m].
    since : float
        Seconds to leave out at the start [s]: there wheels may not have reached the rough road yet.

    Returns
    -------
    ndarray, shape (path,)
        Correlation coefficients, between −1 and 1; nan where a force is the same everywhere.

    Raises
    ------
    ValueError
        If the two do not have the same paths or fewer than two points in common.

    References
    ----------
    D. J. Cole, D. Cebon, Spatial repeatability of dynamic tyre forces generated by heavy vehicles, Proceedings of
    the Institution of Mechanical Engineers D 206 (1992) 17-27.
    """
    with checking() as check:
        spacing = check.positive("spacing", spacing, "m")
    worn = [aggregate_force(result, power=1.0, spacing=spacing, since=since) for result in (first, second)]
    paths = [each.path.values.tolist() for each in worn]
    if paths[0] != paths[1]:
        raise ValueError(f"second must follow the same paths as first, got {paths[1]} beside {paths[0]}")
    numbers = [np.rint(each.distance.values / spacing).astype(int) for each in worn]
    common = np.intersect1d(*numbers)
    if common.size < 2:
        raise ValueError("second must pass points of the road that first passes, got none in common")
    one, other = (
        each.aggregate_force.values[np.searchsorted(number, common)]
        for each, number in zip(worn, numbers, strict=True)
    )
    one, other = one - one.mean(axis=0), other - other.mean(axis=0)
    size = np.sqrt((one**2).sum(axis=0) * (other**2).sum(axis=0))
    return np.divide((one * other).sum(axis=0), size, out=np.full(size.shape, np.nan), where=size > 0)


def contact_loss(result: xr.Dataset, *, since: float = 0.0) -> ContactLoss:
    """Tell for how long each contact would have to pull: its total force is not positive.

    The model keeps contact; where it is lost the computed force is tension, and what follows is an estimate.

    Parameters
    ----------
    result : xarray.Dataset
        The coupled response of a vehicle.
    since : float
        Seconds to leave out at the start [s]: there wheels may not have reached the rough road yet.

    Returns
    -------
    ContactLoss
        Share of the time and longest loss [s], each of shape (contact,).

    Raises
    ------
    ValueError
        If the result has no contact forces, or nothing is left of the record.
    """
    with checking() as check:
        result = check_coupled(check, result, since=since)
    lost = result.contact_force.values + result.static_load.values <= 0
    step = float(result.attrs["time_step"])
    longest = np.array([_longest_run(column) for column in lost.T]) * step
    return ContactLoss(lost.mean(axis=0), longest)


def _longest_run(flags: BoolArray) -> int:
    """Greatest number of flags in a row."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(int)))
    return int((edges[1::2] - edges[::2]).max(initial=0))


def check_coupled(check: Checks, result: Any, *also: str, since: float = 0.0) -> Any:
    """Refuse what is not the response of a vehicle in time, or has no numbers for it.

    Parameters
    ----------
    check : Checks
        Checks that are going on.
    result : Any
        What was given as a result.
    *also : str
        Variables that are needed beside contact forces, static loads and accelerations.
    since : float
        Seconds to leave out at the start [s].

    Returns
    -------
    xarray.Dataset
        The response as it was solved, in finer steps, where the result holds that; what is measured is taken of it.
    """
    names = ("contact_force", "static_load", "acceleration", *also)
    if not (hasattr(result, "data_vars") and {"time", "contact", "dof"} <= set(result.dims)):
        check.refuse("result", mistaken("coupled result", result))
        return result
    for flaw in flaws(result, names):
        check.refuse("result", f"must be the coupled response of a vehicle in finite numbers, but {flaw}")
    return result if check.faults else after(resolved(result), since)


def after(result: xr.Dataset, since: float) -> xr.Dataset:
    """Leave out the first seconds of a response over time."""
    return result.isel(time=slice(samples_before(since, time_step_of(result), result.sizes["time"]), None))


def samples_before(since: float, time_step: float, count: int) -> int:
    """Count the samples of a record that lie before an instant.

    Parameters
    ----------
    since : float
        The instant, from the first sample on [s].
    time_step : float
        Step in time [s].
    count : int
        Number of samples of the record.

    Returns
    -------
    int
        How many to leave out.

    Raises
    ------
    ValueError
        If the instant is negative, or beyond the record.
    """
    with checking() as check:
        since = check.not_negative("since", since, "s")
        most = max(count - 2, 0) * time_step
        if not check.faults and since > most:
            check.refuse("since", f"must leave at least two samples, so be {most:.6g} s at most, got {since!r} s")
    # A time is a whole number of steps but for rounding.
    return int(np.ceil(since / time_step - 1e-6))

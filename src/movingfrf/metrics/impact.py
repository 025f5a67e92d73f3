"""Impact factor: how far the high contact forces lie above the static one."""

from __future__ import annotations

from statistics import NormalDist
from typing import TYPE_CHECKING

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import checking
from movingfrf.metrics.entry import Entry, OfHistory, OfRandom
from movingfrf.metrics.loads import check_coupled

if TYPE_CHECKING:
    import xarray as xr


CUSTOMARY = 95.0  # percentile [%]


def impact_factor(result: xr.Dataset, *, percentile: float = CUSTOMARY, since: float = 0.0) -> FloatArray:
    """Total force that each contact exceeds for a small share of the time only, over its load in steady travel.

    Of a Gaussian force the factor is 1 + z s, s the dynamic load coefficient and z = 1.645 for 95 %.

    Parameters
    ----------
    result : xarray.Dataset
        The coupled response of a vehicle, from `simulate`, `cdfm` or `sim`.
    percentile : float
        Share of the time for which the force is not exceeded [%].
    since : float
        Seconds to leave out at the start [s]: there wheels may not have reached the rough road yet.

    Returns
    -------
    ndarray, shape (contact,)
        Ratios; inf for a contact that bears nothing in steady travel.

    Raises
    ------
    ValueError
        If the result has no contact forces, nothing is left of the record, or the percentile does not lie between 0
        and 100.

    References
    ----------
    P. F. Sweatman, A study of dynamic wheel forces in axle group suspensions of heavy vehicles, Special Report 27,
    Australian Road Research Board, 1983; as quoted in the literature on it.
    """
    with checking() as check:
        result = check_coupled(check, result, since=since)
        if not 0 <= (percentile := check.finite("percentile", percentile, "%")) <= 100:
            check.refuse("percentile", f"must lie between 0 and 100 %, got {percentile!r} %")
    load = result.static_load.values
    high = load + np.percentile(result.contact_force.values, percentile, axis=0)
    return np.divide(high, load, out=np.full(load.shape, np.inf), where=load > 0)


def _entry(name: str, by: str) -> Entry:
    high = NormalDist().inv_cdf(CUSTOMARY / 100)
    return Entry(
        "1",
        OfHistory(name, lambda of, n: impact_factor(of.result)[n], by),
        OfRandom(name, lambda of, n: 1 + high * of.value("dynamic_load_coefficient", n), by, "load"),
    )


ENTRY = _entry(f"impact factor ({CUSTOMARY:g} %)", by="Sweatman 1983")

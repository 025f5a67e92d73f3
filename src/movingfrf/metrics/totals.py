"""What vibration along several axes does to people together."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from movingfrf._basics.checks import checking, shown
from movingfrf.metrics.comfort import ISO_2631


def vibration_total(rms: ArrayLike, factors: ArrayLike = 1.0) -> float:
    """Combine the weighted rms accelerations of several axes, (Σ k² a²)^½.

    Parameters
    ----------
    rms : array_like, shape (axis,)
        Weighted rms acceleration of each axis [m/s² or rad/s²].
    factors : array_like, shape (axis,)
        The factor k of each, for health 1.4, 1.4 and 1; for a seated person's comfort see `seated_total`.

    Returns
    -------
    float
        Vibration total value [m/s²].

    Raises
    ------
    ValueError
        If an array is not a list of finite numbers, one factor for each axis.

    References
    ----------
    ISO 2631-1:1997, 6.5, equation (10).

    Examples
    --------
    >>> round(vibration_total([0.3, 0.2, 0.5], [1.4, 1.4, 1.0]), 3)
    0.71
    """
    with checking() as check:
        values = check.array("rms", rms, "m/s²", (None,))
        scales = check.spread("factors", factors, "1", values.shape)
    return float(np.sqrt(np.sum((scales * values) ** 2)))


def seated_total(rms: Mapping[str, float]) -> float:
    """Combine what a seated person feels at seat, backrest and feet, each axis with its factor for comfort.

    Parameters
    ----------
    rms : mapping of str to float
        Weighted rms acceleration [m/s² or rad/s²] by place and axis: `seat` with `x`, `y`, `z` (factor 1), `roll`
        (0.63), `pitch` (0.4) and `yaw` (0.2); `backrest` with `x` (0.8), `y` (0.5) and `z` (0.4); `feet` with `x`,
        `y` (0.25) and `z` (0.4). Those that are left out count as zero. Weighted with Wk on the vertical of the
        seat and on all of the feet, Wc on the backrest's x, We on rotations, Wd on the others.

    Returns
    -------
    float
        Overall vibration total value [m/s²].

    Raises
    ------
    ValueError
        If there is no such place and axis, or a value is negative.

    References
    ----------
    ISO 2631-1:1997, 8.2.2.1 and 8.2.3.

    Examples
    --------
    >>> round(seated_total({"seat z": 0.5, "seat pitch": 0.6, "backrest x": 0.3}), 3)
    0.604
    """
    with checking() as check:
        given = rms.items() if isinstance(rms, Mapping) else ()
        if not given:
            check.refuse(
                "rms", f"must give accelerations by place and axis, as {{'seat z': 0.5}}, got {shown(rms)}"
            )
        for name in dict(given):
            if name not in ISO_2631.seated:
                check.refuse("rms", f"must be of {', '.join(ISO_2631.seated)}, got {shown(name)}")
        felt = {name: check.not_negative(f"rms[{name!r}]", value, "m/s²") for name, value in given}
    return vibration_total(list(felt.values()), [ISO_2631.seated[name] for name in felt])

"""Samples of what is uncertain, or to be chosen: designs of a sweep; and what varies with which key."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import checking, shown
from movingfrf._basics.values import Value
from movingfrf._basics.wording import count
from movingfrf.studies.sweep.files import measures_in

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Design(Value):
    """Values of some keys, sample by sample; made by `design`.

    Parameters
    ----------
    paths : tuple of str
        Where each key stands in the scenario.
    values : ndarray, shape (sample, key)
        What each is [in the key's own unit].
    kind : str
        How they were drawn.
    base : int
        How many samples were asked for; a `saltelli` design has (keys + 2) times as many.
    seed : int
        The same seed gives the same design.
    """

    paths: tuple[str, ...]
    values: FloatArray
    kind: str
    base: int
    seed: int

    @property
    def drawn(self) -> dict[str, Any]:
        """How samples were drawn, in words and numbers."""
        return {"kind": self.kind, "samples": self.base, "seed": self.seed, "paths": list(self.paths)}

    def told(self) -> list[tuple[str, str]]:
        """Tell kind, keys and between what they lie."""
        lines = [("kind", f"{self.kind}, {count(len(self.values), 'sample')}, seed {self.seed}")]
        for path, values in zip(self.paths, self.values.T, strict=True):
            lines.append((path, f"{values.min():.6g} to {values.max():.6g}"))
        return lines


def design(over: Mapping[str, Any], *, samples: int, kind: str = "sobol", seed: int = 0) -> Design:
    """Draw samples of keys of a scenario, for `sweep`.

    Parameters
    ----------
    over : mapping of str to tuple of float, or distribution
        By the path of each key between what it lies [in its own unit], all values alike; or a distribution of
        `scipy.stats`.
    samples : int
        How many; a power of two for `sobol` and `saltelli`, whose evenness rests on it.
    kind : str
        `sobol` (a sequence that fills the ranges evenly, scrambled), `latin_hypercube`, `random`, or `saltelli`,
        which `sensitivity` needs: (keys + 2) · samples cases.
    seed : int
        The same seed gives the same samples.

    Returns
    -------
    Design
        Takes the place of axes in `sweep`, whose dimension is `sample` then.

    Raises
    ------
    ValueError
        If there is no key, a range is empty, or the number does not suit the kind.

    References
    ----------
    A. Saltelli et al., Variance based sensitivity analysis of model output, Computer Physics Communications 181
    (2010) 259-270.

    Examples
    --------
    >>> import movingfrf as mf
    >>> mf.design({"run.speed": (10.0, 30.0)}, samples=4).values.shape
    (4, 1)
    >>> mf.design({"run.speed": (10.0, 30.0), "run.start": (0.0, 5.0)}, samples=4, kind="saltelli").values.shape
    (16, 2)
    """
    with checking() as check:
        samples = check.whole("samples", samples, least=2)
        seed = check.whole("seed", seed)
        kind = check.choice("kind", kind, ("sobol", "latin_hypercube", "random", "saltelli"))
        if not isinstance(over, Mapping) or not over:
            check.refuse("over", f"must be a mapping from keys to ranges (low, high), got {shown(over)}")
        for path in over if isinstance(over, Mapping) else ():
            if not isinstance(path, str):
                check.refuse("over", f"must have a range for each key, got one for all of {shown(path)}")
        if kind in ("sobol", "saltelli") and samples & (samples - 1):
            power = 1 << samples.bit_length()
            check.refuse("samples", f"must be a power of two for {kind}, got {samples}; the next one is {power}")
    inverses = {str(path): _inverse(str(path), given) for path, given in over.items()}
    uniform = _uniform(kind, samples, len(inverses), seed)
    values = np.stack(
        [inverse(column) for inverse, column in zip(inverses.values(), uniform.T, strict=True)], axis=1
    )
    values.setflags(write=False)
    return Design(paths=tuple(inverses), values=values, kind=kind, base=samples, seed=seed)


def _inverse(path: str, given: Any) -> Any:
    """Give the inverse of a distribution function: of a range, or of a distribution."""
    if hasattr(given, "ppf"):
        return given.ppf
    try:
        low, high = map(float, given)
    except (TypeError, ValueError):
        raise ValueError(f"{path} must have a range (low, high) or a distribution, got {shown(given)}") from None
    if not (math.isfinite(low) and math.isfinite(high) and low < high):
        raise ValueError(f"{path} must have a range from a lower to a higher value, got {low:g} to {high:g}")

    def inverse(share: ArrayLike) -> FloatArray:
        return low + (high - low) * np.asarray(share)

    return inverse


def _uniform(kind: str, samples: int, keys: int, seed: int) -> FloatArray:
    """Draw from the unit cube, shape (sample, key)."""
    from scipy.stats import qmc

    if kind == "random":
        drawn: FloatArray = np.random.default_rng(seed).random((samples, keys))
        return drawn
    if kind == "latin_hypercube":
        return np.asarray(qmc.LatinHypercube(keys, seed=seed).random(samples))
    if kind == "sobol":
        return np.asarray(qmc.Sobol(keys, seed=seed).random(samples))
    both = np.asarray(qmc.Sobol(2 * keys, seed=seed).random(samples))
    first, second = both[:, :keys], both[:, keys:]
    mixed = []
    for key in range(keys):
        one = first.copy()
        one[:, key] = second[:, key]
        mixed.append(one)
    return np.concatenate([first, second, *mixed])


def sensitivity(table: xr.Dataset, measure: str) -> xr.Dataset:
    """Say how much of a measure's variance is due to which key: Sobol indices.

    Parameters
    ----------
    table : xarray.Dataset
        What `sweep` returned for a `saltelli` design.
    measure : str
        A measure in it.

    Returns
    -------
    xarray.Dataset
        `first_order(key, contact)`: the share of the variance that would go if the key were known; `total`: the
        share that would stay if all others were. The first ones add up to one where keys act on their own. Both are
        nan where nothing varies.

    Raises
    ------
    ValueError
        If the table is of another design, lacks the measure, or has cases without an answer.

    References
    ----------
    A. Saltelli et al., Variance based sensitivity analysis of model output, Computer Physics Communications 181
    (2010) 259-270.
    """
    import xarray as xr

    if getattr(table, "attrs", {}).get("kind") != "sweep":
        raise ValueError(f"table must be what sweep returned, got {shown(table)}")
    drawn = json.loads(table.attrs.get("design", "{}"))
    if drawn.get("kind") != "saltelli":
        how = f"a {drawn['kind']} design" if drawn else "axes"
        raise ValueError(f"sensitivity needs a sweep of a saltelli design, got one of {how}")
    with checking() as check:
        measure = check.choice("measure", measure, measures_in(table))
    without = int((table.status.values != "").sum())
    if without:
        raise ValueError(
            f"sensitivity needs an answer of every case, but {without} of {table.status.size} have none"
        )
    base, keys = int(drawn["samples"]), drawn["paths"]
    values = table[measure].values  # (sample, contact or dof)
    parts = values.reshape(len(keys) + 2, base, -1)
    first, total = (np.full((len(keys), values.shape[1]), np.nan) for _ in range(2))
    for place in range(values.shape[1]):
        first[:, place], total[:, place] = shares_of(parts[:, :, place])
    dims = ("key", str(table[measure].dims[-1]))
    coordinates: dict[str, Any] = {"key": np.array(keys, object)}
    coordinates |= {name: table[name] for name in (dims[1], f"{dims[1]}_name") if name in table.coords}
    words = "share of the variance of " + str(table[measure].attrs["long_name"])
    return xr.Dataset(
        {
            "first_order": (dims, first, {"units": "1", "long_name": f"{words}, due to the key alone"}),
            "total": (
                dims,
                total,
                {"units": "1", "long_name": f"{words}, due to the key and what it does with others"},
            ),
        },
        coordinates,
        {"title": f"Sensitivity of {measure}", "movingfrf_sweep": table.attrs["axes"]},
    )


def shares_of(parts: FloatArray) -> FloatArray:
    """Say how much of the variance of some values is due to which key: Sobol indices.

    Parameters
    ----------
    parts : ndarray, shape (key + 2, sample)
        Values of a `saltelli` design: of the first samples, of the second ones, and of the first with one key each
        of the second.

    Returns
    -------
    ndarray, shape (2, key)
        First-order and total index; nan where nothing varies.
    """
    from scipy.stats import sobol_indices

    # What is the same but for rounding has no variance to share [1e-12 to 1e-6].
    if np.ptp(parts) <= 1e-9 * np.abs(parts).max():
        return np.full((2, len(parts) - 2), np.nan)
    given = {"f_A": parts[None, 0], "f_B": parts[None, 1], "f_AB": parts[2:, None]}
    found = sobol_indices(func=given, n=parts.shape[1])
    return np.array([np.ravel(found.first_order), np.ravel(found.total_order)])

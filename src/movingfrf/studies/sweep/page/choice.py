"""Which axes of a sweep a figure has, and how."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.wording import MOST_CURVES

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True, slots=True, kw_only=True)
class Drawn:
    """How much a figure of a sweep bears; conventions, which captions state."""

    map_places: int = 5  # along both axes at the least, for a map
    map_most: int = 40  # of a map, along each axis
    names: int = 12  # of a text axis, each with its own line; of more, ranks
    name_letters: int = 30  # the end of a longer one is shown
    curve_points: int = 250  # buckets of a curve, each with its extremes
    samples: int = 400  # dots of a scatter
    keys: int = 2  # scatters beside a histogram, those that matter most
    stretches: int = 3  # said one by one
    resamples: int = 200  # of a saltelli design, for how uncertain its shares are
    confidence: float = 0.95


DRAWN = Drawn()


class Layout(NamedTuple):
    """Which axes a figure has."""

    kind: str  # samples, map, curves, dots, ranks; empty: nothing varies
    along: str = ""
    across: str = ""  # other axis of a map, or the one whose values are curves
    seeds: tuple[str, ...] = ()  # of whose values means and percentiles are taken
    others: tuple[str, ...] = ()  # of whose values the worst is taken


def layout_of(table: xr.Dataset) -> Layout:
    """Choose what a figure has.

    Parameters
    ----------
    table : xarray.Dataset
        What `sweep` returned.

    Returns
    -------
    Layout
        As `layout` chooses it.
    """
    dims = [str(dim) for dim in table.status.dims]
    numeric = {dim for dim in dims if table[dim].dtype.kind in "iuf"}
    return layout({dim: table.sizes[dim] for dim in dims}, numeric, design="design" in table.attrs)


def layout(sizes: dict[str, int], numeric: set[str], *, design: bool) -> Layout:
    """Choose what a figure has, by the axes and how long they are.

    Parameters
    ----------
    sizes : dict of str to int
        Values along each axis.
    numeric : set of str
        Axes whose values are numbers.
    design : bool
        Whether the axis is one of samples.

    Returns
    -------
    Layout
        Two long numeric axes are a map, one is that of curves, a text axis is one of dots or, where it is long, of
        ranks. Seeds are never drawn: roads of one kind are a spread.

    Examples
    --------
    >>> layout({"speed": 61, "seed": 100}, {"speed", "seed"}, design=False)
    Layout(kind='curves', along='speed', across='', seeds=('seed',), others=())
    >>> layout({"speed": 9, "vehicle": 2, "stiffness": 5}, {"speed", "stiffness"}, design=False)[:3]
    ('map', 'speed', 'stiffness')
    """
    if design:
        return Layout("samples", "sample")
    dims = [dim for dim, size in sizes.items() if size > 1]
    seeds = tuple(dim for dim in dims if dim.split(".")[-1] == "seed")
    longest = sorted((dim for dim in dims if dim not in seeds), key=lambda dim: -sizes[dim])
    numbers = [dim for dim in longest if dim in numeric]
    words = [dim for dim in longest if dim not in numeric]
    if not longest:
        return Layout("samples", "", seeds=seeds) if seeds else Layout("")
    long = [dim for dim in numbers if sizes[dim] >= DRAWN.map_places]
    if len(long) > 1:
        kind, along, across = "map", *long[:2]
    elif numbers and (long or not words or sizes[words[0]] <= MOST_CURVES):
        kind, along, across = "curves", numbers[0], next(iter([*words, *numbers[1:]]), "")
    else:
        kind, along = "dots" if sizes[words[0]] <= DRAWN.names else "ranks", words[0]
        across = next(iter([*numbers, *words[1:]]), "")
    return Layout(kind, along, across, seeds, tuple(dim for dim in longest if dim not in (along, across)))


def laid_out(values: FloatArray, dims: list[str], chosen: Layout, *, below: bool) -> FloatArray:
    """Lay values out as a figure has them.

    Parameters
    ----------
    values : ndarray, shape (*dims)
        A value of each case.
    dims : list of str
        The axes.
    chosen : Layout
        What a figure has.
    below : bool
        Whether the smallest value is the worst one.

    Returns
    -------
    ndarray, shape (along, across, seed)
        Of the other axes the worst.
    """
    order = [dim for dim in (chosen.along, chosen.across) if dim]
    order += [dim for dim in dims if dim in chosen.seeds]
    turned = np.moveaxis(values, [dims.index(dim) for dim in order], range(len(order)))
    first, second = (values.shape[dims.index(dim)] if dim else 1 for dim in (chosen.along, chosen.across))
    seeds = int(np.prod([values.shape[dims.index(dim)] for dim in chosen.seeds], dtype=int))
    turned = turned.reshape(first, second, seeds, -1)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        found: FloatArray = np.nanmin(turned, axis=-1) if below else np.nanmax(turned, axis=-1)
    return found

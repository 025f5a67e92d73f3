"""Curves of a figure: which columns are drawn, what they are called and how they look."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import checking
from movingfrf._basics.wording import evenly_spread, some_of
from movingfrf.results.labels import contact_names, contacts_in_words

if TYPE_CHECKING:
    import xarray as xr


# Okabe and Ito's palette, distinct under every common colour blindness; its yellow is too pale on white.
PALETTE = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
INK, GREY = "#222222", "#6b6b6b"


# Things by their numbers or names, or one of them.
Chosen = Sequence[int | str] | int | str


class Curve(NamedTuple):
    """One curve of a figure: a column of an array, what it is called and how it looks."""

    column: int
    name: str
    colour: str


def telling(rms: FloatArray, units: Sequence[str], most: int, *, alike: float = 0.1) -> list[int]:
    """Which degrees of freedom to draw where there are more than a figure bears.

    Those that move like one before them are left out, then the liveliest: bodies come before wheels.

    Parameters
    ----------
    rms : ndarray, shape (dof,)
        Root mean square of each acceleration [m/s² or rad/s²].
    units : sequence of str
        Unit of each degree of freedom.
    most : int
        Number of degrees of freedom that a figure bears.
    alike : float
        Motions whose root mean squares differ by less than this share tell the same [a convention, which
        `left_out_dofs` states].

    Returns
    -------
    list of int
        Their numbers.

    Examples
    --------
    >>> telling(np.array([1.0, 2.0, 9.0, 1.05, 2.0, 9.1]), ["m", "rad", "m", "m", "rad", "m"], most=5)
    [0, 1, 2]
    """
    if len(rms) <= most:
        return list(range(len(rms)))
    chosen: list[int] = []
    for dof, size in enumerate(rms):
        if all(units[dof] != units[one] or abs(size - rms[one]) > alike * rms[one] for one in chosen):
            chosen.append(dof)
    return sorted(sorted(chosen, key=lambda dof: rms[dof])[:most])


def left_out_dofs(total: int, drawn: int) -> str:
    """Say in a caption how many degrees of freedom are drawn, and which `telling` left out."""
    words = " Left out are those with an rms within a tenth of one that is drawn, then the liveliest."
    return some_of(total, drawn, "degrees of freedom") + (words if drawn < total else "")


def distinct(curves: Sequence[Curve], values: FloatArray, *, coincident: float = 1e-6) -> list[Curve]:
    """Merge curves that lie on top of each other: the first one stays, and says which others it stands for.

    Parameters
    ----------
    curves : sequence of Curve
        The curves.
    values : ndarray, shape (sample, channel)
        What is drawn, in any unit.
    coincident : float
        Curves that differ by less than this share of their largest value lie on top of each other [1e-9, above
        rounding, to 1e-3, below the width of a line].

    Returns
    -------
    list of Curve
        Curves that can be told apart.
    """
    groups: list[list[Curve]] = []
    for curve in curves:
        mine = values[:, curve.column]
        for group in groups:
            other = values[:, group[0].column]
            if np.abs(mine - other).max(initial=0.0) <= coincident * np.abs(other).max(initial=0.0):
                group.append(curve)
                break
        else:
            groups.append([curve])
    others = [f" = {len(group) - 1} others" if len(group) > 2 else f" = {group[-1].name}" for group in groups]
    return [
        group[0]._replace(name=group[0].name + (words if len(group) > 1 else ""))
        for group, words in zip(groups, others, strict=True)
    ]


def contact_curves(result: xr.Dataset, contacts: Chosen | None = None) -> list[Curve]:
    """Name and colour of contacts, the same in every figure.

    Parameters
    ----------
    result : xarray.Dataset
        What `simulate` returned.
    contacts : sequence of int or str, optional
        Numbers or names of the contacts, or one; by default all, or some of them where there are many (see
        `evenly_spread`).

    Returns
    -------
    list of Curve
        One per contact.
    """
    position, path = result.position.values, result.path.values
    several_paths = len(np.unique(path)) > 1
    names = [
        f"{called} at {_signed(place)} m" + (f", path {along}" if several_paths else "")
        for called, place, along in zip(contacts_in_words(result), position, path, strict=True)
    ]
    return _curves("contacts", names, contacts, contact_names(result))


def point_curves(result: xr.Dataset, points: Chosen | None = None) -> list[Curve]:
    """Name and colour of the observation points of a result of `moving_loads`.

    Parameters
    ----------
    result : xarray.Dataset
        What `moving_loads` returned.
    points : sequence of int, optional
        Numbers of the points; by default all, or some of them where there are many (see `evenly_spread`).

    Returns
    -------
    list of Curve
        One per point.
    """
    return _curves("places", [f"point at {_signed(place)} m" for place in result.point.values], points)


def load_curves(result: xr.Dataset, loads: Chosen | None = None) -> list[Curve]:
    """Name and colour of the loads of a result of `moving_loads`.

    Parameters
    ----------
    result : xarray.Dataset
        What `moving_loads` returned.
    loads : sequence of int, optional
        Numbers of the loads; by default all, or some of them where there are many (see `evenly_spread`).

    Returns
    -------
    list of Curve
        One per load.
    """
    return _curves("loads", [f"load at {_signed(place)} m" for place in result["load"].values], loads)


def foremost(result: xr.Dataset) -> list[int]:
    """Find the foremost contact in each path, of at most `MOST_CURVES` paths.

    Parameters
    ----------
    result : xarray.Dataset
        What `simulate` returned.

    Returns
    -------
    list of int
        Contacts, in the order of the paths' numbers.
    """
    position, path = result.position.values, result.path.values
    paths = np.unique(path)
    return [
        max(np.flatnonzero(path == paths[number]).tolist(), key=lambda contact: position[contact])
        for number in evenly_spread(len(paths))
    ]


def _signed(place: float) -> str:
    """Position [m] with its sign, to the centimetre."""
    return f"{place:+.2f}".replace("-", "−") if abs(place) >= 0.005 else "0"


def _curves(what: str, names: Sequence[str], chosen: Chosen | None, called: Sequence[str] = ()) -> list[Curve]:
    """Curves of the chosen columns; a column keeps its colour whatever else is chosen."""
    usual = evenly_spread(len(names))
    colours = {column: PALETTE[rank] for rank, column in enumerate(usual)}
    columns = usual
    if chosen is not None:
        with checking() as check:
            columns = check.some_of(what, chosen, called or names)
    taken = {colours[column] for column in columns if column in colours}
    free = itertools.cycle([colour for colour in PALETTE if colour not in taken] or PALETTE)
    return [Curve(c, names[c], colours[c] if c in colours else next(free)) for c in columns]


def place_curves(result: xr.Dataset, places: Chosen | None) -> list[Curve]:
    """Name and colour of the places of a result: its contacts, or its observation points."""
    return contact_curves(result, places) if "contact" in result.dims else point_curves(result, places)


def dof_curve(result: xr.Dataset, dof: int | str) -> Curve:
    """Name a degree of freedom, alone in its figure."""
    names = list(map(str, result.dof.values))
    with checking() as check:
        column = check.one_of("dof", dof, names)
    return Curve(column, readable(names[column]), INK)


def readable(name: str) -> str:
    """Write a name from code as words.

    Parameters
    ----------
    name : str
        Name, words joined by underscores.

    Returns
    -------
    str
        The words.
    """
    return name.replace("_", " ")

"""The page of a sweep: what each measure does along the axes, where it is worst, which cases have no answer."""

from __future__ import annotations

import json
import warnings
from collections import Counter
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.version import VERSION
from movingfrf._basics.wording import count, evenly_spread, number, plain
from movingfrf.reports.axes import legend_above
from movingfrf.reports.curves import GREY, PALETTE
from movingfrf.reports.figures import SIZE, blank, drawing, illustrated
from movingfrf.reports.page import page
from movingfrf.reports.tables import SCALES, Column, Row, Setting, Table
from movingfrf.studies.sweep.design import sensitivity
from movingfrf.studies.sweep.files import with_unit

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes


class Question(NamedTuple):
    """What a figure answers."""

    measures: tuple[str, ...]  # the first one that there is, is drawn
    asks: str
    smallest: bool = False  # whether the smallest value is the worst one


class Seen(NamedTuple):
    """A measure of every case: of the contact or degree of freedom where it is worst."""

    name: str
    words: str
    units: str
    values: FloatArray  # over the axes, in the unit in which it is read
    smallest: bool


def render(table: xr.Dataset, title: str, scenario: str) -> str:
    """Write the report of a sweep.

    Parameters
    ----------
    table : xarray.Dataset
        What `sweep` returned.
    title : str
        What the page is called.
    scenario : str
        Text of the scenario that is varied.

    Returns
    -------
    str
        One HTML page without references to anything outside it.
    """
    seen = _seen(table)
    with drawing():
        figures = [
            illustrated(f"sweep-{number}", question.asks, _caption(table, one), _figure(table, one))
            for number, (question, one) in enumerate(seen)
            if table.status.dims
        ]
    return page(
        title=title,
        version=VERSION,
        summary=_summary(table),
        settings=[_setting(table, str(name)) for name in table.coords if _varies(table, str(name))],
        findings=findings(table),
        no_findings="No findings: every case has an answer, within the assumptions that it is computed under.",
        tables=tables(table),
        figures=figures,
        method=[
            "Each case is the scenario below with other values of some keys, solved and measured as a case by "
            "itself. Of several contacts or degrees of freedom one is shown, as captions say; table.csv has all."
        ],
        scenario=scenario,
        measures="The worst cases",
    )


def _questions() -> list[Question]:
    """Say what figures answer, in the order of the page."""
    return [
        Question(("dynamic_load_coefficient",), "How much does the load on the road vary?"),
        Question(("contact_force_peak", "contact_force_expected_peak"), "How large does the dynamic force become?"),
        Question(("smallest_contact_force",), "Is contact lost?", smallest=True),
        Question(("lift_off_share",), "For what share of the time would contact be lost?"),
        Question(("deflection_peak", "deflection_expected_peak"), "How far does the road yield?"),
        Question(
            ("weighted_acceleration_rms", "weighted_acceleration"), "What do people feel, on the calmest body?"
        ),
    ]


def _seen(table: xr.Dataset) -> list[tuple[Question, Seen]]:
    """Take what is drawn: of each question the measure that there is, or all others."""
    found = []
    drawn: set[str] = set()
    for question in _questions():
        name = next((name for name in question.measures if name in table), None)
        if name is not None:
            found.append((question, _worst(table, name, question.smallest)))
            drawn.add(name)
    if not found:
        others = [str(name) for name in table.data_vars if name not in ("status", "findings")]
        found = [(Question((name,), f"{_words(table, name)}?"), _worst(table, name, False)) for name in others]
    return found


def _words(table: xr.Dataset, name: str) -> str:
    words = str(table[name].attrs["long_name"])
    return words[0].upper() + words[1:]


def _worst(table: xr.Dataset, name: str, smallest: bool) -> Seen:
    """Take the worst contact of each case, or the calmest degree of freedom that is no wheel's: the body."""
    values, units = table[name].values, str(table[name].attrs["units"])
    if table[name].dims[-1] == "dof":
        units = units.split(" or ")[0]
        turning = table["dof_unit"].values == "rad"
        values = np.where(np.broadcast_to(turning, values.shape), np.nan, values)
    calmest = smallest or (table[name].dims[-1] == "dof" and name.startswith("weighted"))
    with warnings.catch_warnings():
        # A case without an answer has none.
        warnings.simplefilter("ignore", RuntimeWarning)
        each = np.nanmin(values, axis=-1) if calmest else np.nanmax(values, axis=-1)
    called, scale = SCALES.get(units, (units.replace("s2", "s²"), 1.0))
    return Seen(name, _words(table, name), called, scale * each, smallest)


def _ways(table: xr.Dataset) -> tuple[str | None, str | None, list[str]]:
    """Choose the axis that figures have along them, the one whose values are curves, and the others.

    Seeds are never drawn: roads of one kind are a spread.
    """
    dims = [str(dim) for dim in table.status.dims if table.sizes[dim] > 1]
    numeric = [dim for dim in dims if table[dim].dtype.kind in "iuf" and dim != "seed"]
    along = max(numeric, key=lambda dim: table.sizes[dim]) if numeric else None
    if along is None:
        along = next((dim for dim in dims if dim != "seed"), None)
    rest = [dim for dim in dims if dim not in (along, "seed")]
    curves = rest[0] if rest else None
    return along, curves, [dim for dim in dims if dim not in (along, curves)]


def _figure(table: xr.Dataset, seen: Seen) -> Any:
    """Draw a measure along an axis: a curve for each value of another one, a band where others vary as well."""
    if "design" in table.attrs:
        return _sampled(table, seen)
    along, curves, others = _ways(table)
    figure = blank(SIZE.single + 0.4)
    (ax,) = figure.subplots(1, 1, squeeze=False)[0]
    dims = [str(dim) for dim in table.status.dims]
    order = [dims.index(dim) for dim in dims if dim in others]
    spread = np.moveaxis(seen.values, order, range(len(order))) if order else seen.values
    spread = spread.reshape(-1, *spread.shape[len(order) :])
    left = [dim for dim in dims if dim not in others]
    if along is None:
        _draw_spread(ax, spread.reshape(-1), seen)
        return figure
    places, names = _places(table, along)
    spread = np.moveaxis(spread, 1 + left.index(along), 1)
    spread = spread.reshape(len(spread), len(places), -1)
    chosen = evenly_spread(spread.shape[2], len(PALETTE))
    for colour, column in zip(PALETTE, chosen, strict=False):
        label = f"{curves} {_value(table, curves, column)}" if curves else None
        _draw_curve(ax, places, spread[:, :, column], colour, label, dots=names is not None or len(places) <= 12)
    if seen.smallest:
        ax.axhline(0.0, color=GREY, linestyle=":", linewidth=1.2)
    if names is not None:
        ax.set_xticks(places, names)
    unit = f" [{seen.units}]" if seen.units else ""
    ax.set(xlabel=_axis_name(table, along), ylabel=f"{seen.words.lower()}{unit}")
    legend_above(ax)
    return figure


def _sampled(table: xr.Dataset, seen: Seen) -> Any:
    """Draw how often which value comes, and each sample over the first few keys."""
    keys = [str(name) for name in table.coords if table[name].dims == ("sample",) and name != "sample"][:3]
    figure = blank(SIZE.single + 0.4)
    first, *others = figure.subplots(1, 1 + len(keys), squeeze=False)[0]
    _draw_spread(first, seen.values, seen)
    for ax, key in zip(others, keys, strict=True):
        ax.plot(table[key].values, seen.values, ".", color=PALETTE[0], markersize=3.0)
        ax.set(xlabel=_axis_name(table, key), ylabel=seen.units)
    return figure


def _draw_curve(
    ax: Axes, places: FloatArray, spread: FloatArray, colour: str, label: str | None, *, dots: bool
) -> None:
    """Draw the mean over what else varies, and between what it lies."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        mean, low, high = np.nanmean(spread, axis=0), *np.nanpercentile(spread, [5.0, 95.0], axis=0)
    ax.plot(places, mean, color=colour, label=label, marker="o" if dots else None, markersize=4.0, linewidth=1.4)
    if len(spread) > 1:
        ax.fill_between(places, low, high, color=colour, alpha=0.18, linewidth=0)


def _draw_spread(ax: Axes, values: FloatArray, seen: Seen) -> None:
    """Draw how often which value comes."""
    there = values[np.isfinite(values)]
    ax.hist(there, bins="auto" if there.size else 1, color=PALETTE[0])
    unit = f" [{seen.units}]" if seen.units else ""
    ax.set(xlabel=f"{seen.words.lower()}{unit}", ylabel="cases")


def _places(table: xr.Dataset, dim: str) -> tuple[FloatArray, list[str] | None]:
    """Where the values of an axis stand; by name where they are no numbers."""
    values = table[dim].values
    if values.dtype.kind in "iuf":
        return values.astype(float), None
    return np.arange(values.size, dtype=float), [str(value) for value in values]


def _value(table: xr.Dataset, dim: str, number_: int) -> str:
    """Write a value of an axis."""
    return _said(table, dim, table[dim].values[number_])


def _said(table: xr.Dataset, name: str, value: Any) -> str:
    """Write a value of a key with its unit: six digits are more than any drawn one means."""
    if table[name].dtype.kind not in "iuf":
        return str(value)
    unit = str(table[name].attrs.get("units", "1"))
    return plain(float(f"{value:.6g}")) + ("" if unit == "1" else f" {unit}")


def _axis_name(table: xr.Dataset, dim: str) -> str:
    """Name an axis, with its unit where its key has one."""
    return with_unit(dim.replace("_", " "), table[dim])


def _caption(table: xr.Dataset, seen: Seen) -> str:
    """Say what is drawn, and where it is worst."""
    along, curves, others = (None, None, list[str]()) if "design" in table.attrs else _ways(table)
    words = f"{seen.words}: of each case the contact with the {'smallest' if seen.smallest else 'largest'} value. "
    if table[seen.name].dims[-1] == "dof":
        words = f"{seen.words}: of each case the calmest of what moves up and down. "
    if curves and table.sizes[curves] > len(PALETTE):
        words += f"{len(PALETTE)} of {table.sizes[curves]} values of {curves} are drawn. "
    if others and along is not None:
        words += f"Lines are means over {' and '.join(others)}, bands from the 5th to the 95th percentile. "
    where = _extreme(table, seen)
    if where:
        words += f"{'Smallest' if seen.smallest else 'Largest'} at {where}."
    if seen.smallest and np.isfinite(seen.values).any():
        below = int((seen.values < 0).sum())
        words += (
            f" Below zero, where contact would be lost, in {below or 'none'} of {count(seen.values.size, 'case')}."
        )
    return words


def _extreme(table: xr.Dataset, seen: Seen) -> str:
    """Say at which values of the axes a measure is worst."""
    if not np.isfinite(seen.values).any():
        return ""
    at = int(np.nanargmin(seen.values) if seen.smallest else np.nanargmax(seen.values))
    if "design" in table.attrs:
        keys = [str(name) for name in table.coords if _varies(table, str(name))]
        return ", ".join(f"{key} {_said(table, key, table[key].values[at])}" for key in keys)
    places = np.unravel_index(at, seen.values.shape)
    return ", ".join(
        f"{dim} {_value(table, str(dim), int(place))}" for dim, place in zip(table.status.dims, places, strict=True)
    )


def _summary(table: xr.Dataset) -> str:
    cases, without = table.status.size, int((table.status.values != "").sum())
    if "design" in table.attrs:
        drawn = json.loads(table.attrs["design"])
        words = (
            f"{count(cases, 'case')}, drawn ({drawn['kind'].replace('_', ' ')}) of {' and '.join(drawn['paths'])}."
        )
        return words + _answered(without)
    dims = [f"{table.sizes[dim]} of {str(dim).replace('_', ' ')}" for dim in table.status.dims]
    words = f"{count(cases, 'case')}: {' × '.join(dims)}."
    return words + _answered(without)


def _answered(without: int) -> str:
    """Say how many cases have no answer."""
    if not without:
        return " Every one has an answer."
    return f" {without} of them {'has' if without == 1 else 'have'} no answer."


def _varies(table: xr.Dataset, name: str) -> bool:
    """Whether a coordinate is one of keys."""
    return name != "sample" and bool(table[name].dims) and set(table[name].dims) <= set(table.status.dims)


def _setting(table: xr.Dataset, dim: str) -> Setting:
    """Say over what an axis goes."""
    values = table[dim].values
    if values.dtype.kind in "iuf" and values.size > 4:
        said = f"{_said(table, dim, values.min())} to {_said(table, dim, values.max())}"
    else:
        said = ", ".join(_value(table, dim, number_) for number_ in range(min(values.size, 6)))
        said += ", …" if values.size > 6 else ""
    return Setting(str(table[dim].attrs.get("long_name", dim)), said, count(values.size, "value"))


def findings(table: xr.Dataset) -> list[str]:
    """Say what to know about a sweep, in sentences.

    Parameters
    ----------
    table : xarray.Dataset
        What `sweep` returned.

    Returns
    -------
    list of str
        Of the sweep as a whole, then why cases have no answer, then what is to be known of how many cases.
    """
    said = [str(one["message"]) for one in json.loads(table.attrs["findings"])]
    found = [f"{words[0].upper()}{words[1:]}." for words in said]
    reasons = Counter(str(why) for why in table.status.values.ravel() if why)
    found += [f"{count(times, 'case')} without an answer: {why}." for why, times in reasons.most_common(8)]
    if len(reasons) > 8:
        found.append(f"{len(reasons) - 8} other reasons for cases without an answer stand in table.csv.")
    codes = Counter(code for each in table.findings.values.ravel() if each for code in str(each).split(", "))
    cases = table.status.size
    found += [
        f"{code.replace('_', ' ').capitalize()}, in {times} of {count(cases, 'case')}; `movingfrf run` says more."
        for code, times in codes.most_common()
    ]
    return found


def tables(table: xr.Dataset) -> list[Table]:
    """Tables for reading.

    Parameters
    ----------
    table : xarray.Dataset
        What `sweep` returned.

    Returns
    -------
    list of Table
        Of each measure the extremes, and where the worst one is.
    """
    rows = []
    for _, seen in _seen(table):
        there = seen.values[np.isfinite(seen.values)]
        if not there.size:
            continue
        cells = [number(float(value)) for value in (there.min(), np.median(there), there.max())]
        rows.append(Row(seen.words, [*cells, seen.units, _extreme(table, seen)]))
    columns = [
        Column("smallest", ""),
        Column("median", ""),
        Column("largest", ""),
        Column("unit", "", words=True),
        Column("worst at", "", words=True),
    ]
    found = [Table("Measures over all cases, and where each is worst.", "measure", columns, rows)] if rows else []
    return [*found, *_indices(table)]


def _indices(table: xr.Dataset) -> list[Table]:
    """Say how much of each measure's variance is due to which key, where the design tells."""
    drawn = json.loads(table.attrs.get("design", "{}"))
    if drawn.get("kind") != "saltelli" or (table.status.values != "").any():
        return []
    rows = []
    for _, seen in _seen(table):
        found = sensitivity(table, seen.name)
        # Of the contact or degree of freedom that varies most.
        place = int(np.nanargmax(np.nan_to_num(table[seen.name].values.std(axis=0), nan=-1.0)))
        cells = [
            f"{number(float(first), 2)}; {number(float(total), 2)}"
            for first, total in zip(found.first_order.values[:, place], found.total.values[:, place], strict=True)
        ]
        rows.append(Row(seen.words, cells))
    return [
        Table(
            "Share of the variance that is due to a key alone; to it and others with it. Of the contact or degree "
            "of freedom that varies most.",
            "measure",
            [Column(str(key), "", words=True) for key in drawn["paths"]],
            rows,
        )
    ]

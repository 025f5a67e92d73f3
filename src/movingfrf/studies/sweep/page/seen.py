"""What figures and tables see of a sweep: a measure of every case, and the question that it answers."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.wording import number, plain
from movingfrf.reports.curves import readable
from movingfrf.reports.tables import SCALES
from movingfrf.studies.sweep.files import measures_in
from movingfrf.studies.sweep.page.limits import Limit, usual_limits

if TYPE_CHECKING:
    import xarray as xr


class Question(NamedTuple):
    """What a figure answers."""

    measures: tuple[str, ...]  # the first one that there is, is drawn
    asks: str
    below: bool = False  # whether the smallest value is the worst one


class Bound(NamedTuple):
    """A limit in the unit in which its measure is read."""

    value: float
    said: str  # with its unit
    meaning: str


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Seen:
    """A measure of every case.

    Parameters
    ----------
    name : str
        What the table calls it.
    asks : str
        The question.
    units : str
        Unit in which it is read; empty where it has none.
    each : ndarray, shape (*axes, place)
        Values at each contact or degree of freedom.
    places : ndarray of str, shape (*axes, place)
        What these are called.
    worst : ndarray, shape (*axes)
        Value where it is worst, or of the calmest degree of freedom: the body.
    below : bool
        Whether the smallest value is the worst one.
    calmest : bool
        Whether `worst` is of the calmest.
    felt : bool
        Whether it is what ISO 2631-1 judges.
    limit : Bound, optional
        What it is held against.
    static : ndarray, shape (*axes, place), optional
        What it is a dynamic part of, in the same unit.
    """

    name: str
    asks: str
    units: str
    each: FloatArray
    places: np.ndarray
    worst: FloatArray
    below: bool
    calmest: bool
    felt: bool
    limit: Bound | None = None
    static: FloatArray | None = None

    @property
    def called(self) -> str:
        """Its name in words."""
        return readable(self.name)

    @property
    def label(self) -> str:
        """Its name with its unit, as axes have it."""
        return f"{self.called} [{self.units}]" if self.units else self.called

    @property
    def at(self) -> tuple[int, ...]:
        """Case, and number of the contact or degree of freedom, where it is worst of all.

        Raises
        ------
        ValueError
            If no case has an answer.
        """
        worst = np.nanargmin(self.worst) if self.below else np.nanargmax(self.worst)
        case = tuple(int(place) for place in np.unravel_index(int(worst), self.worst.shape))
        return (*case, int(np.flatnonzero(self.each[case] == self.worst[case])[0]))

    def written(self, value: float, digits: int = 4) -> str:
        """Write a value with its unit."""
        return f"{number(float(value), digits)} {self.units}".strip()

    def beyond(self, values: FloatArray) -> np.ndarray:
        """Say which values lie beyond the limit; none of what is nan."""
        assert self.limit
        return values < self.limit.value if self.below else values > self.limit.value


def questions() -> list[Question]:
    """Say what figures answer, in the order of the page."""
    return [
        Question(("dynamic_load_coefficient",), "How much does the load on the road vary?"),
        Question(("contact_force_peak", "contact_force_expected_peak"), "How large does the dynamic force become?"),
        Question(("smallest_contact_force",), "Is contact lost?", below=True),
        Question(("lift_off_share",), "For what share of the time would contact be lost?"),
        Question(("deflection_peak", "deflection_expected_peak"), "How far does the road yield?"),
        Question(
            ("weighted_acceleration_rms", "weighted_acceleration"), "What do people feel, on the calmest body?"
        ),
    ]


def seen_of(table: xr.Dataset, limits: Sequence[Limit] = ()) -> list[Seen]:
    """Take what is asked: the questions of which there is a measure, and all that has a limit; or all measures.

    Parameters
    ----------
    table : xarray.Dataset
        What `sweep` returned.
    limits : sequence of Limit
        What measures are held against; where a usual one has none here, it keeps its usual one.

    Returns
    -------
    list of Seen
        One for each question and limit.
    """
    names = measures_in(table)
    asked = [
        question._replace(measures=(name,))
        for question in questions()
        if (name := next((name for name in question.measures if name in names), None))
    ]
    there = {question.measures[0] for question in asked}
    others = [limit.measure for limit in limits] if asked else names
    asked += [Question((name,), "") for name in dict.fromkeys(others) if name not in there]
    return [_seen(table, question, limit) for question in asked for limit in _limits(question.measures[0], limits)]


def _limits(measure: str, limits: Iterable[Limit]) -> Sequence[Limit | None]:
    """Give the limits of a measure, its usual one where it has no other, or None alone."""
    return [limit for limit in limits if limit.measure == measure] or usual_limits(measure) or [None]


def _seen(table: xr.Dataset, question: Question, limit: Limit | None) -> Seen:
    """Take a measure, in the unit in which it is read."""
    (name,) = question.measures
    values, place = table[name].values, str(table[name].dims[-1])
    places = np.broadcast_to(_places(table, place), values.shape)
    units = str(table[name].attrs["units"])
    turning = np.broadcast_to(table["dof_unit"].values == "rad", values.shape) if place == "dof" else None
    if limit and limit.place:
        values = np.where(places == limit.place, values, np.nan)
        rad = turning is not None and bool((turning & (places == limit.place)).any())
        units = units.split(" or ")[-1 if rad else 0]
    elif turning is not None:
        # Rotations are of another unit.
        values, units = np.where(turning, np.nan, values), units.split(" or ")[0]
    felt = place == "dof" and name.startswith("weighted")
    calmest = felt and not (limit and limit.place)
    called, scale = SCALES.get(units, (units.replace("s2", "s²"), 1.0))
    with warnings.catch_warnings():
        # A case without an answer has none.
        warnings.simplefilter("ignore", RuntimeWarning)
        worst = np.nanmin(values, axis=-1) if question.below or calmest else np.nanmax(values, axis=-1)
    dynamic = name in ("contact_force_peak", "contact_force_expected_peak") and "static_load" in table
    seen = Seen(
        name=name,
        asks=question.asks,
        units=called,
        each=scale * values,
        places=places,
        worst=scale * worst,
        below=question.below,
        calmest=calmest,
        felt=felt,
        static=scale * table["static_load"].values if dynamic else None,
    )
    return _limited(seen, limit, scale)


def _limited(seen: Seen, limit: Limit | None, scale: float) -> Seen:
    """Hold a measure against a limit: what is asked of it then is whether it passes that."""
    from dataclasses import replace

    if limit is None:
        return replace(seen, asks=seen.asks or f"How large does the {seen.called} become?")
    value = scale * limit.value
    bound = Bound(value, f"{plain(value)} {seen.units}".strip(), limit.meaning)
    verb = "fall below" if seen.below else "exceed"
    where = f" at {limit.place}" if limit.place else ""
    asks = seen.asks if limit.meaning else f"Where does the {seen.called}{where} {verb} {bound.said}?"
    return replace(seen, asks=asks, limit=bound)


def _places(table: xr.Dataset, place: str) -> np.ndarray:
    """Name contacts or degrees of freedom: by number where names say nothing, or not which."""
    names: Any = table[f"{place}_name"].values
    numbers = np.array([f"{place} {number}" for number in range(table.sizes[place])], object)
    alike = names.ndim == 1 and len(set(names)) < names.size
    return np.where((names == "") | alike, numbers, names)

"""The list of items, in the order of the report, and their computation."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Sequence
from typing import NamedTuple

from movingfrf._basics.progress import Progress, silent
from movingfrf.studies.paper import claims, guideway, load, plate, vehicle
from movingfrf.studies.paper.drawing import journal
from movingfrf.studies.paper.outcome import Outcome
from movingfrf.studies.paper.study import Study


class Item(NamedTuple):
    """One part of the reproduction: what it is, where it stands in the paper, and what computes it."""

    title: str
    place: str
    compute: Callable[[Study], Outcome]


ITEMS: dict[str, Item] = {
    "1": Item("Moving impulse response and moving FRF", "Fig. 5", guideway.moving_frf),
    "2": Item("Moving FRF over speed and offset", "Fig. 6", guideway.maps),
    "3": Item("Response to a moving load", "Figs. 7 to 9", load.response),
    "4": Item("Two truncations", "Fig. 10", load.truncated),
    "5": Item("Error over the truncation", "Fig. 11", load.error_over_truncation),
    "6": Item("Multiplications and time", "Table 1", load.costs),
    "7": Item("Road surface", "Fig. 13", vehicle.profile),
    "8": Item("Spectra of the coupled system", "Fig. 14", vehicle.spectra),
    "9": Item("Contact deflections", "Fig. 15", vehicle.deflections),
    "10": Item("Vehicle accelerations", "Figs. 16 and 17", vehicle.accelerations),
    "11": Item("Three dimensions", "Fig. 18 and the comparison after it", plate.in_three_dimensions),
    "12": Item("Times of all methods", "the last table", vehicle.times),
    "claim1": Item("Time-varying becomes time-invariant", "", claims.time_invariant),
    "claim2": Item("Cheaper by orders of magnitude", "", claims.cheaper),
    "claim3": Item("Truncation error below 10⁻⁴ beyond 70 Hz", "", claims.truncation),
    "claim4": Item("A road of 40 m suffices", "", guideway.where_it_fails),
    "claim5": Item("What is left open", "", claims.left_open),
}


def name_of(key: str) -> str:
    """Write the key of an item as words.

    Parameters
    ----------
    key : str
        Key.

    Returns
    -------
    str
        Words.

    Examples
    --------
    >>> name_of("5"), name_of("claim2")
    ('Item 5', 'Claim 2')
    """
    return f"Claim {key.removeprefix('claim')}" if key.startswith("claim") else f"Item {key}"


class Reproduction(NamedTuple):
    """What was computed: outcomes by the items' keys, and whether coarsely."""

    outcomes: dict[str, Outcome]
    quick: bool


def chosen(only: Sequence[str] | None) -> list[str]:
    """Check keys of items.

    Parameters
    ----------
    only : sequence of str or None
        Keys: 1 to 12, claim1 to claim5; None: all.

    Returns
    -------
    list of str
        In the order of the report.

    Raises
    ------
    ValueError
        If a key is unknown, or there is none.
    """
    if only is None:
        return list(ITEMS)
    unknown = [key for key in only if key not in ITEMS]
    if unknown or not only:
        close = difflib.get_close_matches(unknown[0], ITEMS, n=1) if unknown and not unknown[0].isdigit() else []
        hint = f" (did you mean {close[0]!r}?)" if close else ""
        raise ValueError(f"only must name items among {', '.join(ITEMS)}, got {', '.join(unknown) or 'none'}{hint}")
    return [key for key in ITEMS if key in only]


def reproduce(
    only: Sequence[str] | None = None, *, quick: bool = False, progress: Progress = silent
) -> Reproduction:
    """Compute the items of the paper.

    Parameters
    ----------
    only : sequence of str, optional
        Keys of items: 1 to 12, claim1 to claim5; None: all.
    quick : bool
        Whether to do everything more coarsely: fewer points, a shorter journey where steps are compared.
    progress : callable
        Called with the name of an item and its stage, and the fraction of that which is done.

    Returns
    -------
    Reproduction
        Outcomes by the items' keys.

    Raises
    ------
    ValueError
        If an item is unknown.

    Examples
    --------
    >>> found = reproduce(["claim1"], quick=True)
    >>> str(found.outcomes["claim1"].statements[0].verdict)
    'holds'
    """
    keys = chosen(only)
    current = ""

    def told(stage: str, fraction: float) -> None:
        progress(f"{current}: {stage}", fraction)

    study = Study(quick=quick, progress=told)
    outcomes: dict[str, Outcome] = {}
    with journal():
        for number, key in enumerate(keys, start=1):
            item = ITEMS[key]
            current = f"{number}/{len(keys)} {name_of(key)}"
            progress(current, (number - 1) / len(keys))
            outcomes[key] = item.compute(study)
    return Reproduction(outcomes, quick)

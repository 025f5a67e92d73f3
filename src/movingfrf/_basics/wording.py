"""Numbers and lists in words, for reading."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from typing import NamedTuple

import numpy as np

# A rate [1/s] or a share below this stands for never [a convention].
NEVER = 1e-12

# Curves in one figure beyond which nobody can tell one from another; the palette has as many colours.
MOST_CURVES = 6


def number(value: float, digits: int = 4) -> str:
    """Write a number for reading: significant digits, powers of ten only where they are shorter.

    Parameters
    ----------
    value : float
        The number.
    digits : int
        Significant digits.

    Returns
    -------
    str
        The number, with a true minus sign.

    Examples
    --------
    >>> number(98399.5), number(-0.0810412), number(1.2e-7, 2), number(0.0), number(float("inf"))
    ('98400', '−0.08104', '1.2 × 10⁻⁷', '0', '∞')
    """
    if value == 0:
        return "0"
    if not np.isfinite(value):
        return str(value).replace("inf", "∞").replace("-", "−")
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    power = int(exponent)
    if -4 < power < 6:
        rounded = float(f"{mantissa}e{power}")
        return f"{rounded:.{max(digits - 1 - power, 0)}f}".replace("-", "−")
    return f"{mantissa} × 10{raised(str(power))}".replace("-", "−")


def raised(exponent: str) -> str:
    """Write an exponent in raised digits.

    Examples
    --------
    >>> "10" + raised("-3")
    '10⁻³'
    """
    return exponent.translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))


def plain(value: float) -> str:
    """Write a setting as it was typed: without trailing zeros."""
    return f"{value:.10g}".replace("-", "−")


def place(along: float) -> str:
    """Write a place along a road, or across it, to a tenth of a millimetre.

    Examples
    --------
    >>> place(523425.2400000001), place(10 / 3), place(-0.0), place(12000.0)
    ('523425.24', '3.3333', '0', '12000')
    """
    return np.format_float_positional(round(along, 4) + 0.0, trim="-")


def in_both_units(speed: float, *, in_kmh: bool = False) -> tuple[str, str]:
    """Write a speed in m/s and in km/h, as it was given first and the other as one writes it.

    Parameters
    ----------
    speed : float
        Speed [m/s].
    in_kmh : bool
        Whether it was given in km/h.

    Returns
    -------
    tuple of str
        Two numbers with their units.

    Examples
    --------
    >>> in_both_units(69.4444), in_both_units(250 / 3.6, in_kmh=True)
    (('69.4444 m/s', '250 km/h'), ('250 km/h', '69.44 m/s'))
    """
    given, other = ((3.6 * speed, "km/h"), (speed, "m/s"))[:: 1 if in_kmh else -1]
    return f"{plain(given[0])} {given[1]}", f"{plain(float(f'{other[0]:.4g}'))} {other[1]}"


def told_apart(*values: float, digits: int = 6) -> tuple[str, ...]:
    """Write numbers that a sentence compares with as many digits as it takes to see that they differ.

    Parameters
    ----------
    *values : float
        The numbers.
    digits : int
        Significant digits at the least.

    Returns
    -------
    tuple of str
        One text for each; texts are equal where numbers are.

    Examples
    --------
    >>> told_apart(523417.6, 523417.5), told_apart(0.1, 1200.0), told_apart(523418.0, 523418.0)
    (('523417.6', '523417.5'), ('0.1', '1200'), ('523418', '523418'))
    """
    for enough in range(digits, 18):
        texts = tuple(_positional(value, enough) for value in values)
        if len(set(texts)) == len(set(values)):
            break
    return texts


def _positional(value: float, digits: int) -> str:
    """Write so many digits of a number, powers of ten only where nobody would write it in full."""
    text = f"{value + 0.0:.{digits}g}"  # no sign of zero
    in_full = "e" in text and 1e-4 <= abs(value) < 1e15
    return np.format_float_positional(float(text), trim="-") if in_full else text


def is_never(value: float, units: str) -> bool:
    """Tell whether a rate or a share is too small for its digits to mean anything."""
    return units in ("1/s", "1", "%") and 0 < value < NEVER


def count(number: int, singular: str, plural: str = "") -> str:
    """Write a number of things, in the singular or the plural."""
    return f"{number} {singular if number == 1 else plural or singular + 's'}"


def named_paths(numbers: Sequence[int], most: int = 6) -> str:
    """Name some paths by their numbers, `most` at most: path 0, paths 0 and 2, paths 0, 1, 2, 3 and 11 more."""
    words = [str(number) for number in numbers]
    if len(words) == 1:
        return f"path {words[0]}"
    if len(words) > most:
        words = [*words[: most - 1], f"{len(words) - most + 1} more"]
    *first, last = words
    return f"paths {', '.join(first)} and {last}"


class Standing(NamedTuple):
    """What messages say of a vehicle's contacts: their names, and what they stand on."""

    names: Sequence[str]
    ground: str = "road"  # or "rail"

    def listed(self, numbers: Sequence[int], most: int = 4) -> str:
        """Name some contacts, neighbours by the first and the last, at most so many groups.

        Examples
        --------
        >>> Standing(["front", "rear"]).listed([1])
        'contact 1 (rear)'
        >>> Standing([""] * 64).listed([0, 2, *range(9, 64)])
        'contacts 0, 2 and 9 to 63'
        >>> Standing(["front", "rear"]).listed([0, 1])
        'contacts 0 (front) and 1 (rear)'
        """
        words = [f"{number} ({self.names[number]})" if self.names[number] else f"{number}" for number in numbers]
        if len(words) == 1:
            return f"contact {words[0]}"
        # Neighbours have one difference between number and rank.
        runs = [list(run) for _, run in groupby(range(len(words)), lambda rank: numbers[rank] - rank)]
        if len(words) == 2:
            runs = [[0], [1]]
        groups = [words[run[0]] + (f" to {words[run[-1]]}" if run[1:] else "") for run in runs]
        if len(groups) > most:
            groups = [*groups[: most - 1], f"{sum(map(len, runs[most - 1 :]))} more"]
        *first, last = groups
        return f"contacts {', '.join(first)} and {last}" if first else f"contacts {last}"


def enumerated(words: Sequence[str], most: int = 14) -> str:
    """Words with commas between them, at most so many: the middle ones are left out."""
    if len(words) <= most:
        return ", ".join(words)
    return f"{', '.join(words[: most - 2])}, …, {words[-1]} ({len(words)} in all)"


def some_of(total: int, most: int, what: str) -> str:
    """Say in a caption that not everything is drawn."""
    return f" {most} of {total} {what} are drawn; the tables list all." if total > most else ""


def evenly_spread(count: int, most: int = MOST_CURVES) -> list[int]:
    """Which of `count` curves to draw: all, or `most` of them from the first to the last, evenly spread.

    Parameters
    ----------
    count : int
        Number of curves there are.
    most : int
        Number of curves that a figure bears.

    Returns
    -------
    list of int
        Their numbers.

    Examples
    --------
    >>> evenly_spread(3), evenly_spread(64)
    ([0, 1, 2], [0, 13, 25, 38, 50, 63])
    """
    if count <= most:
        return list(range(count))
    return [round(number) for number in np.linspace(0, count - 1, most).tolist()]

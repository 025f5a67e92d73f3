"""Some of the paths."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from movingfrf._basics.checks import checking, shown
from movingfrf.roughness.profile import Profile, require_profile
from movingfrf.roughness.steps.base import Step, changed


def selected(profile: Profile, paths: Sequence[int]) -> Profile:
    """Take some of the paths, in the order in which they are named.

    Parameters
    ----------
    profile : Profile
        The road.
    paths : sequence of int
        Number of each path to take, counted from 0.

    Returns
    -------
    Profile
        With a column for each.

    Raises
    ------
    ValueError
        If there is no such path, or none is named.

    Examples
    --------
    >>> both = Profile([0.0, 1.0, 2.0, 3.0], [[0.0, 1.0]] * 4)
    >>> selected(both, paths=[1]).elevation[0].tolist()
    [1.0]
    """
    require_profile(profile)
    numbers = path_numbers(paths, profile.paths)
    across = None if profile.across is None else tuple(profile.across[number] for number in numbers)
    return changed(profile, selecting(numbers), elevation=profile.columns[:, numbers], across=across)


def path_numbers(paths: Sequence[int], count: int) -> list[int]:
    """Numbers of the paths to take, of so many.

    Parameters
    ----------
    paths : sequence of int
        Number of each path to take, counted from 0.
    count : int
        Number of paths that there are.

    Returns
    -------
    list of int
        The numbers, checked.

    Raises
    ------
    ValueError
        If there is no such path, or none is named.
    """
    numbers: list[int] = []
    with checking() as check:
        if np.ndim(paths) != 1 or not len(paths):
            check.refuse("paths", f"must be a list of at least one number of a path, got {shown(paths)}")
        else:
            numbers = [check.whole("paths", path) for path in paths]
            for number in numbers:
                if number >= count:
                    check.refuse("paths", f"must be below {count}, the number of paths, got {number}")
    return numbers


def selecting(numbers: Sequence[int]) -> str:
    """Say which paths were taken."""
    return f"took the paths {list(numbers)}"


STEP = Step(selected, {"paths": "paths"})

"""Road profiles: elevation over distance."""

from __future__ import annotations

from dataclasses import dataclass
from hashlib import blake2b

import numpy as np
from numpy.typing import ArrayLike

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import checking
from movingfrf._basics.door import mistaken
from movingfrf._basics.remembered import Remembering, recalled, remembered
from movingfrf._basics.spline import Piecewise, cubic
from movingfrf._basics.values import Value, brief
from movingfrf._basics.wording import told_apart

# Relative slack in the comparison of lengths that were computed in different ways: more than their rounding, and
# less than a step, of which a profile that fits into the memory has a thousand million at the most [1e-12 to 1e-9].
SLACK = 1e-9


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Profile(Remembering, Value):
    """Elevation of a road over distance; between its samples a cubic spline.

    Parameters
    ----------
    distance : array_like, shape (distance,)
        Stations along the road [m], increasing; at least four.
    elevation : array_like, shape (distance,) or (distance, path)
        Elevation [m], positive up: the same for all paths, or one column for each.
    source : str
        Where it comes from: a file, a spectrum.
    steps : tuple of str
        What was done to it since, one sentence each, in order.
    across : tuple of float, length path, optional
        Lateral position of each path [m], positive to the left, where it is known.
    full_width : bool
        Whether a profile without columns is meant for the whole width, as a joint or a hump is, and not known along
        one path only.

    Raises
    ------
    ValueError
        If stations do not increase, values are not finite, or shapes disagree.

    Examples
    --------
    >>> Profile([0.0, 1.0, 2.0, 3.0], [0.0, 0.01, 0.0, -0.01]).paths
    1
    """

    distance: ArrayLike
    elevation: ArrayLike
    source: str = ""
    steps: tuple[str, ...] = ()
    across: tuple[float, ...] | None = None
    full_width: bool = False

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking(self) as check:
            distance = check.array("distance", self.distance, "m", (None,))
            elevation = check.array("elevation", self.elevation, "m", None)
            if elevation.ndim not in (1, 2) and not check.faults:
                check.refuse("elevation", f"must have shape (any) or (any, any), got {elevation.shape}")
            if not check.faults:
                if distance.size < 4:
                    check.refuse("distance", f"must have at least 4 stations, got {distance.size}")
                if distance.size != len(elevation):
                    check.refuse(
                        "elevation",
                        f"must have {distance.size} values, one per station, got {len(elevation)}",
                    )
                falls = np.flatnonzero(np.diff(distance) <= 0)
                if falls.size:
                    n = int(falls[0])
                    one, next_one = told_apart(distance[n], distance[n + 1])
                    check.refuse(
                        "distance", f"must increase, got {one} m followed by {next_one} m at index {n + 1}"
                    )
            across = None if self.across is None else check.array("across", self.across, "m", (None,))
            count = elevation.shape[1] if elevation.ndim == 2 else 1
            if across is not None:
                check.keep("across", tuple(across.tolist()))
                if across.size != count:
                    check.refuse("across", f"must have one position [m] for each path, {count}, got {across.size}")
            check.keep("steps", tuple(self.steps))

    def told(self) -> list[tuple[str, str]]:
        """Tell stations, elevation, where it comes from and what was done to it, in words."""
        stations, elevation, step = self.stations, self.columns, self.even_step()
        apart = "uneven" if step is None else f"{step:.6g} m apart"
        places = "" if self.across is None else f", at {', '.join(f'{place:+g}' for place in self.across)} m"
        lines = [
            ("stations", f"{stations.size} from {stations[0]:.6g} m to {stations[-1]:.6g} m, {apart}"),
            ("elevation", f"{elevation.min():.4g} m to {elevation.max():.4g} m"),
            ("paths", "the same for all" if self.same_across else f"{self.paths}{places}"),
            ("source", brief(self.source)),
            ("steps", brief("; ".join(self.steps))),
        ]
        return [(name, words) for name, words in lines if words]

    @property
    def stations(self) -> FloatArray:
        """Stations [m], shape (distance,)."""
        return np.asarray(self.distance, float)

    @property
    def remembers(self) -> bool:
        """Whether its splines are kept: those of many stations, tens of kilometres, are made whenever asked for."""
        many = 2**20  # [memory only]
        return self.stations.size <= many

    @property
    def paths(self) -> int:
        """Number of paths."""
        elevation = np.asarray(self.elevation)
        return 1 if elevation.ndim == 1 else elevation.shape[1]

    @property
    def columns(self) -> FloatArray:
        """Elevations with one column per path [m], shape (distance, path)."""
        elevation = np.asarray(self.elevation, float)
        return elevation[:, None] if elevation.ndim == 1 else elevation

    @remembered
    def even_step(self) -> float | None:
        """Distance between stations if it is the same throughout, but for the rounding of whatever wrote them.

        Returns
        -------
        float or None
            Step [m]; None if the stations are uneven.
        """
        step, off = self._even_grid()
        # How far a station may lie from an even grid, as a share of the step: the rounding of a file's stations,
        # 0.01 for whole millimetres at steps of 50, 0.02 for single precision 30 km along at steps of 0.1 m; 0.1
        # moves a roughness index by up to 0.3 % [0.01 to 0.1]. Stations are no more even than numbers of their size
        # can say.
        uneven = 0.02
        return step if off <= uneven * step + 8 * np.spacing(np.abs(self.stations[[0, -1]]).max()) else None

    def _even_grid(self) -> tuple[float, float]:
        """Step of the even grid from the first station to the last, and how far one lies from it at most [m]."""
        stations = self.stations
        step = float((stations[-1] - stations[0]) / (stations.size - 1))
        return step, float(np.abs(stations - (stations[0] + step * np.arange(stations.size))).max())

    def on_grid(self, what: str) -> tuple[float, tuple[str, ...]]:
        """Step of a profile whose stations a file does not hold, and its steps, which say what that changes.

        Parameters
        ----------
        what : str
            What needs an even step, for the message.

        Returns
        -------
        float
            Step [m].
        tuple of str
            What was done to the profile: `steps`, and that stations were moved if they were.

        Raises
        ------
        ValueError
            If the stations are uneven.
        """
        self.require_even(what)
        step, off = self._even_grid()
        if off <= 1e-6 * step:  # a micrometre in steps of a metre is moved by nobody
            return step, self.steps
        return step, (*self.steps, f"put stations at an even step, which moved them by up to {off:.2g} m")

    def require_even(self, what: str) -> float:
        """Distance between stations, which must be the same throughout.

        Parameters
        ----------
        what : str
            What needs an even step, for the message.

        Returns
        -------
        float
            Step [m].

        Raises
        ------
        ValueError
            If the stations are uneven.
        """
        step = self.even_step()
        if step is None:
            steps = np.diff(self.stations)
            shortest, longest = told_apart(steps.min(), steps.max(), digits=4)
            raise ValueError(
                f"{what} needs stations at an even step, but they are {shortest} to {longest} m apart; "
                "resample the profile first, in Python by `resampled`, else by `movingfrf convert --step`"
            )
        return step

    @property
    def same_across(self) -> bool:
        """Whether all paths have the same elevation: there are no columns."""
        return np.ndim(self.elevation) == 1

    @property
    def one_path(self) -> bool:
        """Whether it is known along one path only: without columns, not level, not meant for the whole width."""
        return self.same_across and not self.full_width and bool(np.ptp(self.columns))

    @property
    def alike(self) -> list[list[int]]:
        """Numbers of the paths, those of equal elevation together: one list if all are equal."""
        groups: dict[bytes, list[int]] = {}
        for path, column in enumerate(self.columns.T):
            # A sum with zero is contiguous, and knows one zero only.
            groups.setdefault(blake2b(column + 0.0).digest(), []).append(path)
        return list(groups.values())

    def along(self, path: int = 0) -> Piecewise:
        """Elevation of one path as a function of distance: the cubic spline through its samples.

        Parameters
        ----------
        path : int
            Number of the path.

        Returns
        -------
        Piecewise
            Callable with any array of distances [m] on the profile; gives elevations [m], or with a second argument
            a derivative of that order.
        """
        if not self.remembers:
            return self._along(path)
        return recalled(self, f"along path {path}", lambda: self._along(path))

    def _along(self, path: int) -> Piecewise:
        elevation = np.asarray(self.elevation)
        return cubic(self.stations, elevation if elevation.ndim == 1 else elevation[:, path])


def require_profile(profile: object, name: str = "profile") -> None:
    """Refuse what is no profile.

    Parameters
    ----------
    profile : object
        What was given.
    name : str
        Name of the argument.

    Raises
    ------
    ValueError
        If it is no `Profile`.
    """
    with checking() as check:
        if not isinstance(profile, Profile):
            check.refuse(name, mistaken("profile", profile))

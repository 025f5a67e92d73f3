"""The contract of everything that carries a contact."""

from __future__ import annotations

from collections.abc import Callable
from inspect import getattr_static
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike

from movingfrf._basics.arrays import ComplexArray, FloatArray
from movingfrf._basics.checks import Finding, checking, uncovered
from movingfrf._basics.door import mistaken


class Guideway(Protocol):
    """An infinitely long, homogeneous road or track: the contract; any object that keeps it is a guideway.

    `at_offsets` takes shapes and checks off the hands of whoever writes one; `docs/guideways.md` has one in twenty
    lines. Laws that every guideway obeys, and that the tests put to every one of them:

    1. *Homogeneity*: only the offset between receiver and source matters, not where they are.
    2. *Mirror*: G(ξ, v) = G(−ξ, −v). Ahead and behind differ as soon as v ≠ 0.
    3. *Reality*: G(−ω*) = G(ω)*; the moving impulse response is a real function.
    4. *Causality*: nothing moves before the load arrives.
    5. *Dissipation*: in the fixed frame Im C(κ, Ω) · sign Ω ≤ 0. (Im G itself may turn positive above the
       critical speed: the motion of the load then feeds the vibration.)

    A guideway that knows of its own limits says so in `findings`, pairs of a code and a message: every result that
    is computed from it carries them. Without that attribute there are none.
    """

    @property
    def critical_speed(self) -> float:
        """Speed at which a steady load meets the guideway's own waves [m/s]; inf if there is none."""
        ...

    def moving_frf(
        self,
        ahead: ArrayLike,
        speed: float,
        omega: ArrayLike,
        *,
        across: ArrayLike = 0.0,
        source_across: ArrayLike = 0.0,
        derivative: int = 0,
    ) -> ComplexArray:
        """Deflection per unit force between points that travel together.

        Parameters
        ----------
        ahead : array_like, shape (*s)
            Receiver minus source along the guideway [m], positive in the direction of travel.
        speed : float
            Common speed of source and receiver [m/s].
        omega : array_like, shape (frequency,)
            Angular frequency in the moving frame [rad/s]; may be complex with Im ω ≤ 0. On the real axis the
            value is the limit of ω − i0⁺.
        across : array_like, broadcastable to (*s)
            Receiver minus source across the guideway [m], positive to the left.
        source_across : array_like, broadcastable to (*s)
            Where the source stands, left of the centre line [m]. Along a guideway nothing but the offset matters;
            across it a road of finite width is not the same everywhere. Only asked of a guideway when a vehicle has
            contacts beside the centre line.
        derivative : int
            Order of the derivative with respect to x: 0 deflection, 1 slope, 2 curvature.

        Returns
        -------
        ndarray, shape (frequency, *s), complex
            Moving FRF [m/N], or [m/N/m^derivative].
        """
        ...


class Asked(NamedTuple):
    """What a guideway is asked for, checked: distinct offsets in a column, frequencies in a row.

    Whatever is computed of both by plain formulas has the shape (offset, frequency).
    """

    ahead: FloatArray  # (offset, 1) [m]
    across: FloatArray  # (offset, 1) [m]
    source_across: FloatArray  # (offset, 1) [m]
    speed: float  # [m/s]
    omega: ComplexArray  # (frequency,), Im ω ≤ 0 [rad/s]
    derivative: int


def at_offsets(
    frf: Callable[[Asked], Any],
    ahead: ArrayLike,
    speed: float,
    omega: ArrayLike,
    *,
    across: ArrayLike = 0.0,
    source_across: ArrayLike = 0.0,
    derivative: int = 0,
    wide: bool = False,
    known_derivatives: int | None = 0,
) -> ComplexArray:
    """Answer as `Guideway.moving_frf` does, by a function of distinct offsets.

    Parameters
    ----------
    frf : callable
        Called once with what is asked for: `ahead`, `across`, `source_across`, shape (offset, 1) [m], `speed`
        [m/s], `omega`, shape (frequency,) [rad/s], and `derivative`. Returns the moving FRF [m/N/m^derivative] as
        one number or in an array of shape (offset, frequency), where either side may be 1: the same for all.
    ahead, across, source_across : array_like
        As `Guideway.moving_frf` was given them [m].
    speed : float
        Speed [m/s].
    omega : array_like, shape (frequency,)
        Angular frequency in the moving frame [rad/s].
    derivative : int
        Order of the derivative with respect to x, a whole number of at least zero.
    wide : bool
        Whether places across make a difference; otherwise `across` and `source_across` of what is asked are zero.
    known_derivatives : int, optional
        Highest derivative that `frf` knows; None: all.

    Returns
    -------
    ndarray, shape (frequency, *s), complex
        Moving FRF [m/N/m^derivative].

    Raises
    ------
    ValueError
        If an argument is not finite, ω has a positive imaginary part, the derivative is not a whole number or not
        known, or `frf` returns another shape.

    Examples
    --------
    A road of separate springs and dashpots, 8e6 N/m and 3e4 N s/m at each point: what is not loaded does not move.

    >>> springs = lambda asked: (asked.ahead == 0) / (8.0e6 + 3.0e4j * asked.omega)
    >>> abs(at_offsets(springs, [[0.0, 4.0], [-4.0, 0.0]], 10.0, [0.0, 100.0])).round(10)
    array([[[1.25e-07, 0.00e+00],
            [0.00e+00, 1.25e-07]],
    <BLANKLINE>
           [[1.17e-07, 0.00e+00],
            [0.00e+00, 1.17e-07]]])
    """
    with checking() as check:
        places = [
            check.array(name, given, "m", None)
            for name, given in (("ahead", ahead), ("across", across), ("source_across", source_across))
        ]
        speed = check.finite("speed", speed, "m/s")
        frequencies = np.atleast_1d(np.asarray(uncovered(omega), complex))
        if frequencies.ndim != 1 or not np.isfinite(frequencies).all() or (frequencies.imag > 0).any():
            check.refuse("omega", "must be finite, one-dimensional and have Im ω ≤ 0 [rad/s]")
        derivative = check.whole("derivative", derivative)
        if known_derivatives is not None and derivative > known_derivatives:
            knows = (
                f"at most {known_derivatives}" if known_derivatives else "0: this guideway knows deflections only"
            )
            check.refuse("derivative", f"must be {knows}, got {derivative}")
    shape = np.broadcast_shapes(*(place.shape for place in places))
    given = np.stack([np.broadcast_to(place, shape).ravel() for place in places])
    if wide:
        distinct, back = np.unique(given, axis=1, return_inverse=True)
    else:
        # Offsets along alone sort fifty times as fast as triples.
        along, back = np.unique(given[0], return_inverse=True)
        distinct = np.stack([along, 0 * along, 0 * along])
    columns = distinct[:, :, None]
    wanted = distinct.shape[1], frequencies.size
    found = np.asarray(frf(Asked(columns[0], columns[1], columns[2], speed, frequencies, derivative)))
    # Of a single axis NumPy's rules would say that it is frequency.
    if found.shape not in {(), wanted, (wanted[0], 1), (1, wanted[1]), (1, 1)}:
        raise ValueError(
            "frf must return one number or an array of shape (offset, frequency), either of which may be 1, here "
            f"{wanted}, got {found.shape}"
        )
    rows = np.broadcast_to(found, wanted).astype(complex, copy=False)
    return np.moveaxis(rows[back.ravel()].reshape(*shape, frequencies.size), -1, 0)


def require_guideway(guideway: object) -> None:
    """Refuse what does not keep the contract: a finite road, for one, which is not the same everywhere.

    Parameters
    ----------
    guideway : object
        What was given as a guideway.

    Raises
    ------
    ValueError
        If it is none.
    """
    if not hasattr(guideway, "moving_frf"):
        raise ValueError(f"guideway {mistaken('guideway', guideway)}")
    # Looked up without asking for it, which may take a second; unless it is handed on.
    if getattr_static(guideway, "critical_speed", None) is None and not hasattr(guideway, "critical_speed"):
        raise ValueError(
            f"guideway must have a critical_speed [m/s], which may be inf, got a {type(guideway).__name__} without"
        )


def findings_of(guideway: Guideway) -> tuple[Finding, ...]:
    """Ask a guideway what it knows of its own limits.

    Parameters
    ----------
    guideway : Guideway
        The guideway.

    Returns
    -------
    tuple of Finding
        Its `findings`; none by default.
    """
    return tuple(Finding(*finding) for finding in getattr(guideway, "findings", ()))


def told(guideway: Guideway) -> str:
    """Say what a guideway is, for the attributes of a result: equal input makes equal bytes.

    Parameters
    ----------
    guideway : Guideway
        The guideway.

    Returns
    -------
    str
        Its own representation, or its kind if that would be an address in memory.
    """
    kind = type(guideway)
    return kind.__name__ if kind.__repr__ is object.__repr__ else repr(guideway)

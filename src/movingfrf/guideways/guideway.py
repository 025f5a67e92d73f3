"""The contract of everything that carries a contact."""

from __future__ import annotations

from typing import Protocol

from numpy.typing import ArrayLike

from movingfrf._basics.arrays import ComplexArray


class Guideway(Protocol):
    """An infinitely long, homogeneous road or track.

    Laws that every guideway obeys, and that the tests put to every one of them:

    1. *Homogeneity*: only the offset between receiver and source matters, not where they are.
    2. *Mirror*: G(ξ, v) = G(−ξ, −v). Ahead and behind differ as soon as v ≠ 0.
    3. *Reality*: G(−ω*) = G(ω)*; the moving impulse response is a real function.
    4. *Causality*: nothing moves before the load arrives.
    5. *Dissipation*: in the fixed frame Im C(κ, Ω) · sign Ω ≤ 0. (Im G itself may turn positive above the
       critical speed: the motion of the load then feeds the vibration.)
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


def require_guideway(guideway: object) -> None:
    """Refuse what has no moving FRF: a finite road, for one, which is not the same everywhere.

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
        raise ValueError(
            f"guideway must have a moving FRF, as a track has, got a {type(guideway).__name__}; a finite road is "
            "for cdfm, sim and newmark_loads, or struck with moving_impulse_response"
        )

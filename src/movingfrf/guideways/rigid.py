"""The road that does not give way: null object and limit case."""

from __future__ import annotations

from dataclasses import dataclass

from numpy.typing import ArrayLike

from movingfrf._basics.arrays import ComplexArray
from movingfrf._basics.values import Value
from movingfrf.guideways.guideway import at_offsets


@dataclass(frozen=True, slots=True)
class RigidGuideway(Value):
    """A guideway without any compliance.

    Examples
    --------
    >>> RigidGuideway().moving_frf([0.0, 4.0], 10.0, [1.0, 2.0, 3.0]).shape
    (3, 2)
    """

    @property
    def critical_speed(self) -> float:
        """A rigid road has no waves and no critical speed [m/s]: inf."""
        return float("inf")

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
        """Zero for all offsets and frequencies [m/N]; see `Guideway.moving_frf` for the arguments."""
        return at_offsets(
            lambda _: 0.0,
            ahead,
            speed,
            omega,
            across=across,
            source_across=source_across,
            derivative=derivative,
            known_derivatives=None,
        )

"""Foundations: what a beam rests on, each as a ratio of polynomials."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from movingfrf._basics.checks import Checks, checking
from movingfrf._basics.values import Value
from movingfrf.guideways.waves import ONE, Ratio, polynomial, table_sum


@runtime_checkable
class Foundation(Protocol):
    """What holds the beam up: a dynamic stiffness in (κ, p)."""

    def foundation_stiffness(self, *, damped: bool = True) -> Ratio:
        """Dynamic stiffness per metre under the beam [N/m²]; without its losses unless `damped`."""
        ...


@dataclass(frozen=True, slots=True)
class Spring(Value):
    """Springs and dashpots side by side (Winkler, Kelvin–Voigt).

    Parameters
    ----------
    stiffness : float
        Stiffness per metre of track [N/m²].
    damping : float
        Damping per metre of track [N s/m²].

    Raises
    ------
    ValueError
        If the stiffness is not positive or the damping is negative.
    """

    stiffness: float
    damping: float = 0.0

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking(self) as check:
            _check_spring(check, self.stiffness, self.damping)

    def foundation_stiffness(self, *, damped: bool = True) -> Ratio:
        """Return k + c p [N/m²]."""
        return Ratio(_spring(self.stiffness, self.damping, damped), ONE)


@dataclass(frozen=True, slots=True)
class ShearLayer(Value):
    """Springs and dashpots tied together by a layer that resists shear (Pasternak).

    Parameters
    ----------
    stiffness : float
        Stiffness per metre of track [N/m²].
    damping : float
        Damping per metre of track [N s/m²].
    shear_stiffness : float
        Pasternak's G_p [N].

    Raises
    ------
    ValueError
        If a stiffness is not positive or the damping is negative.
    """

    stiffness: float
    damping: float = 0.0
    _: KW_ONLY
    shear_stiffness: float

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking(self) as check:
            _check_spring(check, self.stiffness, self.damping)
            check.positive("shear_stiffness", self.shear_stiffness, "N")

    def foundation_stiffness(self, *, damped: bool = True) -> Ratio:
        """Return k + c p + G_p κ² [N/m²]."""
        shear = polynomial({(2, 0): self.shear_stiffness})
        return Ratio(table_sum(_spring(self.stiffness, self.damping, damped), shear), ONE)


@dataclass(frozen=True, slots=True)
class OnMass(Value):
    """A foundation that stands on a layer of mass, which stands on another foundation.

    Rail pad, sleepers, ballast: ``OnMass(above=pad, mass=250.0, below=ballast)``. Nests to any depth.

    Parameters
    ----------
    above : Foundation
        Between the beam and the mass.
    mass : float
        Mass per metre of track [kg/m].
    below : Foundation
        Under the mass.

    Raises
    ------
    ValueError
        If the mass is not positive, or `above` or `below` is not a foundation.
    """

    above: Foundation
    mass: float
    below: Foundation

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking(self) as check:
            check.positive("mass", self.mass, "kg/m")
            for name in ("above", "below"):
                if not isinstance(getattr(self, name), Foundation):
                    check.refuse(name, f"must be a foundation, got {getattr(self, name)!r}")

    def foundation_stiffness(self, *, damped: bool = True) -> Ratio:
        """Series of what is above and of the mass on what is below [N/m²]."""
        if isinstance(self.above, OnMass):
            # Only what has no mass transmits the same force at both ends: number the layers from the top.
            top = self.above
            rest = OnMass(above=top.below, mass=self.mass, below=self.below)
            return OnMass(above=top.above, mass=top.mass, below=rest).foundation_stiffness(damped=damped)
        layer = Ratio(polynomial({(0, 2): self.mass}), ONE) + self.below.foundation_stiffness(damped=damped)
        return self.above.foundation_stiffness(damped=damped).in_series(layer)


def _check_spring(check: Checks, stiffness: float, damping: float) -> None:
    check.positive("stiffness", stiffness, "N/m²")
    check.not_negative("damping", damping, "N s/m²")


def _spring(stiffness: float, damping: float, damped: bool) -> np.ndarray:
    return polynomial({(0, 0): stiffness, (0, 1): damping} if damped and damping else {(0, 0): stiffness})

"""Beams: what of a track bends, each as a ratio of polynomials."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from typing import Protocol, runtime_checkable

from movingfrf._basics.checks import checking
from movingfrf._basics.values import Value
from movingfrf.guideways.waves import ONE, Ratio, polynomial, table_sum


@runtime_checkable
class Beam(Protocol):
    """What carries the load along the track: a dynamic stiffness in (κ, p)."""

    mass: float

    def beam_stiffness(self, *, damped: bool = True) -> Ratio:
        """Dynamic stiffness per metre of a free beam [N/m²]; without its losses unless `damped`."""
        ...


@dataclass(frozen=True, slots=True)
class EulerBernoulliBeam(Value):
    """A slender beam: bending and translational inertia, no shear deformation.

    Parameters
    ----------
    bending_stiffness : float
        EI [N m²].
    mass : float
        Mass per metre [kg/m].
    bending_damping : float
        Kelvin–Voigt damping of the bending [N m² s]: the moment is −(EI + B ∂/∂t) ∂²w/∂x².

    Raises
    ------
    ValueError
        If stiffness or mass is not positive, or the damping is negative.

    Examples
    --------
    >>> beam = EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9)
    >>> EulerBernoulliBeam(bending_stiffness=-1.0, mass=711.9)
    Traceback (most recent call last):
    movingfrf._basics.checks.ParameterError: bending_stiffness must be positive, got -1.0 N m²
    """

    bending_stiffness: float
    mass: float
    _: KW_ONLY
    bending_damping: float = 0.0

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking(self) as check:
            check.positive("bending_stiffness", self.bending_stiffness, "N m²")
            check.positive("mass", self.mass, "kg/m")
            check.not_negative("bending_damping", self.bending_damping, "N m² s")

    def beam_stiffness(self, *, damped: bool = True) -> Ratio:
        """EI κ⁴ + B κ⁴ p + m p² [N/m²]."""
        terms = {(4, 0): self.bending_stiffness, (0, 2): self.mass}
        if damped and self.bending_damping:
            terms[4, 1] = self.bending_damping
        return Ratio(polynomial(terms), ONE)


@dataclass(frozen=True, slots=True)
class TimoshenkoBeam(Value):
    """A beam with shear deformation and rotary inertia.

    Parameters
    ----------
    bending_stiffness : float
        EI [N m²].
    mass : float
        Mass per metre [kg/m].
    shear_stiffness : float
        κ_s G A [N], the shear coefficient included.
    rotary_inertia : float
        ρ I [kg m].

    Raises
    ------
    ValueError
        If a stiffness or the mass is not positive, or the rotary inertia is negative.
    """

    bending_stiffness: float
    mass: float
    _: KW_ONLY
    shear_stiffness: float
    rotary_inertia: float

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking(self) as check:
            check.positive("bending_stiffness", self.bending_stiffness, "N m²")
            check.positive("mass", self.mass, "kg/m")
            check.positive("shear_stiffness", self.shear_stiffness, "N")
            check.not_negative("rotary_inertia", self.rotary_inertia, "kg m")

    def beam_stiffness(self, *, damped: bool = True) -> Ratio:
        """S κ² − (S κ)²/(EI κ² + S + ρI p²) + m p² [N/m²], over its common denominator."""
        shear, bending, inertia = self.shear_stiffness, self.bending_stiffness, self.rotary_inertia
        rotation = {(2, 0): bending, (0, 0): shear}
        # S κ² (EI κ² + ρI p²), the two terms S² κ² having cancelled on paper rather than in floating point.
        shearing = {(4, 0): shear * bending}
        if inertia:
            rotation[0, 2] = inertia
            shearing[2, 2] = shear * inertia
        below = polynomial(rotation)
        massive = polynomial({(a, b + 2): self.mass * value for (a, b), value in rotation.items()})
        return Ratio(table_sum(polynomial(shearing), massive), below)

"""Beams, foundations, and the track made of one of each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from movingfrf._basics.arrays import ComplexArray
from movingfrf._basics.checks import Checks, checking
from movingfrf.guideways.critical import first_stationary_velocity, speed_of_greatest_deflection
from movingfrf.guideways.waves import Ratio, polynomial, residue_sum, total

ONE = polynomial({(0, 0): 1.0})


@runtime_checkable
class Beam(Protocol):
    """What carries the load along the track: a dynamic stiffness in (κ, p)."""

    mass: float

    def beam_stiffness(self, *, damped: bool = True) -> Ratio:
        """Dynamic stiffness per metre of a free beam [N/m²]; without its losses unless `damped`."""
        ...


@runtime_checkable
class Foundation(Protocol):
    """What holds the beam up: a dynamic stiffness in (κ, p)."""

    def foundation_stiffness(self, *, damped: bool = True) -> Ratio:
        """Dynamic stiffness per metre under the beam [N/m²]; without its losses unless `damped`."""
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class EulerBernoulliBeam:
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
    bending_damping: float = 0.0

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking() as check:
            check.positive("bending_stiffness", self.bending_stiffness, "N m²")
            check.positive("mass", self.mass, "kg/m")
            check.not_negative("bending_damping", self.bending_damping, "N m² s")

    def beam_stiffness(self, *, damped: bool = True) -> Ratio:
        """EI κ⁴ + B κ⁴ p + m p² [N/m²]."""
        terms = {(4, 0): self.bending_stiffness, (0, 2): self.mass}
        if damped and self.bending_damping:
            terms[4, 1] = self.bending_damping
        return Ratio(polynomial(terms), ONE)


@dataclass(frozen=True, slots=True, kw_only=True)
class TimoshenkoBeam:
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
    shear_stiffness: float
    rotary_inertia: float

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking() as check:
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
        return Ratio(total(polynomial(shearing), massive), below)


@dataclass(frozen=True, slots=True, kw_only=True)
class Spring:
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
        with checking() as check:
            _check_spring(check, self.stiffness, self.damping)

    def foundation_stiffness(self, *, damped: bool = True) -> Ratio:
        """Return k + c p [N/m²]."""
        return Ratio(_spring(self.stiffness, self.damping, damped), ONE)


@dataclass(frozen=True, slots=True, kw_only=True)
class ShearLayer:
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
    shear_stiffness: float

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking() as check:
            _check_spring(check, self.stiffness, self.damping)
            check.positive("shear_stiffness", self.shear_stiffness, "N")

    def foundation_stiffness(self, *, damped: bool = True) -> Ratio:
        """Return k + c p + G_p κ² [N/m²]."""
        shear = polynomial({(2, 0): self.shear_stiffness})
        return Ratio(total(_spring(self.stiffness, self.damping, damped), shear), ONE)


@dataclass(frozen=True, slots=True, kw_only=True)
class OnMass:
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
        with checking() as check:
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


@dataclass(frozen=True, slots=True)
class Track:
    """A beam on a foundation, infinitely long; made by `track`.

    Parameters
    ----------
    beam : Beam
        What carries the load along.
    foundation : Foundation
        What holds the beam up.
    """

    beam: Beam
    foundation: Foundation

    def stiffness(self, *, damped: bool = True) -> Ratio:
        """Dynamic stiffness of the track for a wave e^{i(Ωt + κx)} [N/m²], as a ratio of polynomials."""
        return self.beam.beam_stiffness(damped=damped) + self.foundation.foundation_stiffness(damped=damped)

    @property
    def critical_speed(self) -> float:
        """Critical speed [m/s]; inf if there is none.

        On a massless foundation the minimum phase velocity, damping ignored: a load that travels with it keeps
        up with its own waves. A mass in the foundation lets waves of ever shorter length travel ever slower;
        then it is the speed of the greatest steady deflection anywhere along the track, with the track's own
        damping, up to the first stationary phase velocity.
        """
        velocity = first_stationary_velocity(self.stiffness(damped=False))
        if velocity.unbounded:
            return speed_of_greatest_deflection(self.stiffness(), velocity.value)
        return velocity.value

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

        The sum of residues over the waves of the track: exact, at any speed, below and above critical.

        Parameters
        ----------
        ahead : array_like, shape (*s)
            Receiver minus source [m], positive in the direction of travel.
        speed : float
            Common speed of source and receiver [m/s].
        omega : array_like, shape (frequency,)
            Angular frequency in the moving frame [rad/s]; may be complex with Im ω ≤ 0.
        across, source_across : array_like
            Ignored: the section of a beam moves as one [m].
        derivative : int
            Order of the derivative with respect to x; 2 is the curvature.

        Returns
        -------
        ndarray, shape (frequency, *s), complex
            Moving FRF [m/N/m^derivative].

        Raises
        ------
        ValueError
            If an argument is not finite, ω has a positive imaginary part, or the derivative is not a whole
            number of at least zero.
        SolveError
            If the response is infinite.

        Examples
        --------
        >>> road = track(EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9),
        ...              Spring(stiffness=8.0e6, damping=3.0e4))
        >>> abs(road.moving_frf([0.0, 4.0, -4.0], 10.0, [0.0])).round(11)
        array([[3.737e-08, 3.600e-10, 0.000e+00]])
        """
        shape = np.broadcast_shapes(np.shape(ahead), np.shape(across), np.shape(source_across))
        with checking() as check:
            offsets = check.array("ahead", np.broadcast_to(np.asarray(ahead), shape).ravel(), "m", (None,))
            speed = check.finite("speed", speed, "m/s")
            frequencies = np.atleast_1d(np.asarray(omega, complex))
            if frequencies.ndim != 1 or not np.isfinite(frequencies).all() or (frequencies.imag > 0).any():
                check.refuse("omega", "must be finite, one-dimensional and have Im ω ≤ 0 [rad/s]")
            derivative = check.whole("derivative", derivative)
        distinct, back = np.unique(offsets, return_inverse=True)
        frf = residue_sum(self.stiffness(), distinct, speed, frequencies, derivative)
        return frf[back].T.reshape(frequencies.size, *shape)


def track(beam: Beam, foundation: Foundation) -> Track:
    """Put a beam on a foundation.

    Parameters
    ----------
    beam : EulerBernoulliBeam or TimoshenkoBeam
        What carries the load along.
    foundation : Spring, ShearLayer or OnMass
        What holds the beam up.

    Returns
    -------
    Track
        The guideway.

    Raises
    ------
    ValueError
        If one of the two is not what it should be.
    """
    with checking() as check:
        if not isinstance(beam, Beam):
            check.refuse("beam", f"must be a beam, got {beam!r}")
        if not isinstance(foundation, Foundation):
            check.refuse("foundation", f"must be a foundation, got {foundation!r}")
    return Track(beam, foundation)


def _check_spring(check: Checks, stiffness: float, damping: float) -> None:
    check.positive("stiffness", stiffness, "N/m²")
    check.not_negative("damping", damping, "N s/m²")


def _spring(stiffness: float, damping: float, damped: bool) -> np.ndarray:
    return polynomial({(0, 0): stiffness, (0, 1): damping} if damped and damping else {(0, 0): stiffness})

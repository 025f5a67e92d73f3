"""The track, made of a beam and a foundation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from movingfrf._basics.arrays import ComplexArray
from movingfrf._basics.checks import checking
from movingfrf._basics.door import given
from movingfrf._basics.remembered import Remembering, recalled, remembered
from movingfrf._basics.values import Value
from movingfrf.guideways.beams import Beam
from movingfrf.guideways.critical import (
    buckles_at,
    compressed,
    first_stationary_velocity,
    least_phase_velocity,
    speed_of_greatest_deflection,
)
from movingfrf.guideways.foundations import Foundation
from movingfrf.guideways.guideway import Asked, at_offsets
from movingfrf.guideways.waves import Ratio, Seen, Waves, require_finite, waves


@dataclass(frozen=True, slots=True)
class Track(Remembering, Value):
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
        return recalled(
            self,
            "stiffness" if damped else "stiffness without damping",
            lambda: self.beam.beam_stiffness(damped=damped) + self.foundation.foundation_stiffness(damped=damped),
        )

    @property
    @remembered
    def critical_speed(self) -> float:
        """Critical speed [m/s]; inf if there is none. Computed when first asked for.

        On a massless foundation the minimum phase velocity, damping ignored: a load that travels with it keeps
        up with its own waves. Where ever shorter waves travel ever slower it is that of their front. A mass in the
        foundation lets short waves travel as slowly as its own shear layer does, or not at all; then it is the
        speed of the greatest steady deflection anywhere along the track, with the track's own damping, up to the
        first stationary phase velocity. Where damping is so strong that the deflection is greatest at rest there
        is none; but if the beam is compressed, it is the first stationary phase velocity: compression slows that
        wave down, to a standstill where the beam buckles, and damping does not stop it.
        """
        lossless = self.stiffness(damped=False)
        held = self.foundation.foundation_stiffness(damped=False)
        massless = not any(table[:, 1:].any() for table in (held.above, held.below))
        if massless and (least := least_phase_velocity(lossless)) > 0:
            return least
        limit = first_stationary_velocity(lossless)
        speed = speed_of_greatest_deflection(self.stiffness(), limit)
        return limit if np.isinf(speed) and compressed(lossless) else speed

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
        >>> import movingfrf as mf
        >>> road = mf.track(mf.EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9),
        ...                 mf.Spring(stiffness=8.0e6, damping=3.0e4))
        >>> abs(road.moving_frf([0.0, 4.0, -4.0], 10.0, [0.0])).round(11)
        array([[3.737e-08, 3.600e-10, 0.000e+00]])
        """
        return at_offsets(
            self._frf,
            ahead,
            speed,
            omega,
            across=across,
            source_across=source_across,
            derivative=derivative,
            known_derivatives=None,
        )

    def waves(self, speed: float, omega: ComplexArray) -> Waves:
        """Free waves of the track, as an observer who travels along sees them.

        Parameters
        ----------
        speed : float
            Speed of the observer [m/s].
        omega : ndarray, shape (frequency,)
            Angular frequency in the moving frame [rad/s]; may be complex with Im ω ≤ 0.

        Returns
        -------
        Waves
            Wavenumbers [rad/m], weights [m/N], and which of them run ahead of a source.

        Raises
        ------
        SolveError
            If the response is infinite.
        """
        return waves(Seen.of(self.stiffness(), speed), speed, omega)

    def _frf(self, asked: Asked) -> ComplexArray:
        found = self.waves(asked.speed, asked.omega).summed(asked.ahead[:, 0], asked.derivative)
        require_finite(found, asked.speed, asked.omega)
        return found


def track(beam: Beam, foundation: Foundation) -> Track:
    """Put a beam on a foundation.

    Parameters
    ----------
    beam : EulerBernoulliBeam, TimoshenkoBeam, TensionedBeam or any Beam
        What carries the load along.
    foundation : Spring, ShearLayer, RelaxingSpring, OnMass or any Foundation
        What holds the beam up.

    Returns
    -------
    Track
        The guideway.

    Raises
    ------
    ValueError
        If one of the two is not what it should be, or the beam buckles on the foundation.
    """
    order = "; the order is beam, foundation"
    with checking() as check:
        if not isinstance(beam, Beam):
            hint = order if isinstance(beam, Foundation) else ""
            check.refuse("beam", f"must be a beam, got {given(beam)}{hint}")
        if not isinstance(foundation, Foundation):
            hint = order if isinstance(foundation, Beam) else ""
            check.refuse("foundation", f"must be a foundation, got {given(foundation)}{hint}")
    made = Track(beam, foundation)
    if (wavenumber := buckles_at(made.stiffness(damped=False))) > 0:
        raise ValueError(
            f"beam must stay straight on its foundation, but buckles in waves of {2 * np.pi / wavenumber:.3g} m"
        )
    return made

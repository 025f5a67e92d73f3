"""A beam under a force along its axis: a contact wire, a rail that heat or cold has put under stress."""

from __future__ import annotations

from dataclasses import dataclass

from movingfrf._basics.checks import checking, shown
from movingfrf._basics.values import Value
from movingfrf.guideways.beams import Beam
from movingfrf.guideways.waves import ONE, Ratio, polynomial


@dataclass(frozen=True, slots=True)
class TensionedBeam(Value):
    """A beam under an axial force, that keeps its direction and its size.

    A rail of section A, welded without joints, carries −E A α ΔT when it is ΔT warmer than when it was laid: some
    −19 kN for each kelvin in a rail UIC60. A contact wire on droppers that are smeared is a beam of hardly any
    bending stiffness under 15 to 30 kN.

    Parameters
    ----------
    beam : EulerBernoulliBeam or TimoshenkoBeam
        The beam.
    force : float
        Axial force [N], positive in tension.

    Raises
    ------
    ValueError
        If `beam` is not a beam or the force is not finite. Whether a compressed beam buckles depends on what holds
        it: `track` refuses it.

    Notes
    -----
    Tension N adds N κ² to the dynamic stiffness. On springs k the critical speed becomes √((2 √(k EI) + N)/m), and
    at −2 √(k EI) the beam buckles.

    References
    ----------
    A. D. Kerr: The continuously supported rail subjected to an axial force and a moving load. International Journal
    of Mechanical Sciences 14 (1972) 71–78.

    Examples
    --------
    A rail 40 K warmer than when it was laid deflects a little more and waves in it are a little slower:

    >>> from movingfrf.guideways.beams import EulerBernoulliBeam
    >>> from movingfrf.guideways.foundations import Spring
    >>> from movingfrf.guideways.track import track
    >>> rail, bed = EulerBernoulliBeam(bending_stiffness=6.42e6, mass=60.2), Spring(stiffness=5.0e7)
    >>> for force in (0.0, -7.5e5):
    ...     laid = track(TensionedBeam(beam=rail, force=force), bed)
    ...     print(round(laid.critical_speed, 1), abs(laid.moving_frf(0.0, 0.0, [0.0])).round(11))
    771.5 [1.181e-08]
    763.4 [1.194e-08]
    """

    beam: Beam
    force: float

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking(self) as check:
            if not isinstance(self.beam, Beam):
                check.refuse("beam", f"must be a beam, got {shown(self.beam)}")
            check.finite("force", self.force, "N")

    @property
    def mass(self) -> float:
        """Mass per metre [kg/m]."""
        return self.beam.mass

    def beam_stiffness(self, *, damped: bool = True) -> Ratio:
        """Return the beam's own and N κ² [N/m²]."""
        return self.beam.beam_stiffness(damped=damped) + Ratio(polynomial({(2, 0): self.force}), ONE)

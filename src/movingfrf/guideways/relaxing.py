"""A foundation that relaxes: stiff at once, softer in the long run, as polymers, asphalt and clay are."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass

from movingfrf._basics.checks import checking
from movingfrf._basics.values import Value
from movingfrf.guideways.waves import ONE, Ratio, polynomial


@dataclass(frozen=True, slots=True)
class RelaxingSpring(Value):
    """A spring, and beside it another one on a dashpot (Zener, the standard linear solid).

    A rail pad of rubber is stiffer in a vibration than at rest, and no further beyond some frequency; springs and
    dashpots side by side are not.

    Parameters
    ----------
    stiffness : float
        Stiffness per metre of track that stays in the long run [N/m²].
    relaxing_stiffness : float
        Stiffness per metre that is there at once as well, and relaxes [N/m²].
    damping : float
        Damping per metre of the dashpot over which it relaxes [N s/m²]; in the time c/k₁.

    Raises
    ------
    ValueError
        If a value is not positive.

    References
    ----------
    C. Zener, Elasticity and Anelasticity of Metals, University of Chicago Press, 1948.

    Examples
    --------
    A pad that doubles its stiffness around 30 Hz:

    >>> pad = RelaxingSpring(stiffness=1.0e8, relaxing_stiffness=1.0e8, damping=5.3e5)
    >>> from movingfrf.guideways.beams import EulerBernoulliBeam
    >>> from movingfrf.guideways.track import track
    >>> rail = track(EulerBernoulliBeam(bending_stiffness=6.42e6, mass=60.2), pad)
    >>> abs(rail.moving_frf(0.0, 20.0, [0.0])).round(11)
    array([6.91e-09])
    """

    stiffness: float
    _: KW_ONLY
    relaxing_stiffness: float
    damping: float

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking(self) as check:
            check.positive("stiffness", self.stiffness, "N/m²")
            check.positive("relaxing_stiffness", self.relaxing_stiffness, "N/m²")
            check.positive("damping", self.damping, "N s/m²")

    def foundation_stiffness(self, *, damped: bool = True) -> Ratio:
        """Return k + k₁ c p/(k₁ + c p), or k without its losses [N/m²]."""
        lasting = Ratio(polynomial({(0, 0): self.stiffness}), ONE)
        if not damped:
            return lasting
        spring, dashpot = {(0, 0): self.relaxing_stiffness}, {(0, 1): self.damping}
        return lasting + Ratio(polynomial(spring), ONE).in_series(Ratio(polynomial(dashpot), ONE))

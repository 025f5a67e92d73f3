"""Time-stepping schemes: each is a row of four numbers."""

from __future__ import annotations

from numbers import Real
from typing import Any, NamedTuple

from movingfrf._basics.checks import Checks, plain, shown, spelt


class Rule(NamedTuple):
    """A scheme with a step of some length: u ← u + Δt v + free_u a + lift_u ä, v ← v + free_v a + lift_v ä.

    Here a is the old acceleration and ä the new one; the compiled loops read it as it is.
    """

    step: float  # [s]
    free_u: float  # (½ − β) Δt² [s²]
    free_v: float  # (1 − γ) Δt [s]
    lift_u: float  # β Δt² [s²]
    lift_v: float  # γ Δt [s]
    keep: float  # 1 − α_f
    alpha_m: float
    alpha_f: float

    def effective(self, mass: Any, damping: Any, stiffness: Any) -> Any:
        """Give what a new acceleration meets, dense or sparse: (1 − α_m) M + (1 − α_f)(γ Δt C + β Δt² K)."""
        return (1 - self.alpha_m) * mass + self.keep * (self.lift_v * damping + self.lift_u * stiffness)


class Scheme(NamedTuple):
    """Newmark's method, generalised: M a(n+1−α_m) + C v(n+1−α_f) + K u(n+1−α_f) = f(n+1−α_f).

    u(n+1) = u + Δt v + Δt² ((½ − β) a + β a(n+1)), v(n+1) = v + Δt ((1 − γ) a + γ a(n+1)); a value at n+1−α is
    (1 − α) times the new and α times the old one (Newmark 1959; Chung and Hulbert, J. Appl. Mech. 60, 1993).

    Parameters
    ----------
    beta, gamma : float
        Newmark's parameters, dimensionless.
    alpha_m, alpha_f : float
        Shares of the old value in inertia and in forces, dimensionless; zero in Newmark's own method.

    Examples
    --------
    >>> Scheme(beta=1 / 4, gamma=1 / 2).largest_phase
    inf
    """

    beta: float
    gamma: float
    alpha_m: float = 0.0
    alpha_f: float = 0.0

    def over(self, step: float) -> Rule:
        """Apply the scheme to a step of some length [s]."""
        beta, gamma, alpha_m, alpha_f = (float(number) for number in self)
        new = beta * step * step, gamma * step
        return Rule(step, (0.5 - beta) * step * step, (1 - gamma) * step, *new, 1 - alpha_f, alpha_m, alpha_f)

    @property
    def largest_phase(self) -> float:
        """Largest ω Δt of an undamped vibration at which a scheme without α stays stable; inf if at any [rad]."""
        if self.gamma < 0.5:
            return 0.0
        if self.alpha_m or self.alpha_f:
            # Slack in the comparison of sums of parameters [1e-15 to 1e-9].
            rounding = 1e-12
            steady = self.alpha_m <= self.alpha_f <= 0.5
            steady = steady and self.gamma >= 0.5 - self.alpha_m + self.alpha_f - rounding
            return (
                float("inf")
                if steady and self.beta >= 0.25 + 0.5 * (self.alpha_f - self.alpha_m) - rounding
                else 0.0
            )
        spare = 0.5 * self.gamma - self.beta
        return float("inf") if spare <= 0 else float(spare**-0.5)


def generalised_alpha(radius: float) -> Scheme:
    """Scheme of second order whose highest frequencies shrink by `radius` in each step (Chung and Hulbert 1993)."""
    alpha_m, alpha_f = (2 * radius - 1) / (radius + 1), radius / (radius + 1)
    return Scheme(0.25 * (1 - alpha_m + alpha_f) ** 2, 0.5 - alpha_m + alpha_f, alpha_m, alpha_f)


SCHEMES = {
    "average_acceleration": Scheme(1 / 4, 1 / 2),
    "linear_acceleration": Scheme(1 / 6, 1 / 2),
    "fox_goodwin": Scheme(1 / 12, 1 / 2),
    "central_difference": Scheme(0.0, 1 / 2),
    "hilber_hughes_taylor": Scheme(1.1**2 / 4, 1 / 2 + 0.1, 0.0, 0.1),
    "generalised_alpha": generalised_alpha(0.8),
}


def scheme_named(check: Checks, given: str | Scheme) -> Scheme:
    """Find a scheme by its name, or take the row that is given."""
    numbers = [plain(number) for number in given] if isinstance(given, tuple) else []
    if 2 <= len(numbers) <= 4 and all(isinstance(number, Real) for number in numbers):
        return Scheme(*map(float, numbers))
    name = spelt(given, SCHEMES)
    if name is None:
        check.refuse("scheme", f"must be a Scheme or one of {', '.join(SCHEMES)}, got {shown(given)}")
    return SCHEMES[name or "average_acceleration"]

"""The vehicle's half of a time step: where it goes by itself, what contact forces add, and how both sides meet.

All methods that step a vehicle share it, plain ones by the methods of `HalfStep`, compiled ones by the functions of
the same names in `kernels`, which read the same value.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf.stepping.schemes import Rule
from movingfrf.stepping.tie import Tie

# Displacement, velocity and acceleration, each (dof,).
Motion = tuple[FloatArray, FloatArray, FloatArray]


class HalfStep(NamedTuple):
    """A vehicle and a rule, and what of a step stays constant; made by `of`."""

    rule: Rule
    tie: Tie
    inverse: FloatArray  # (dof, dof) of what a new acceleration meets
    mass_inverse: FloatArray  # (dof, dof)
    lifted: FloatArray  # (dof, contact) acceleration per contact force
    fixed: FloatArray  # (contact, contact) what the equations for the contact forces have from the vehicle

    @classmethod
    def of(cls, tie: Tie, rule: Rule) -> HalfStep:
        """Invert and multiply what is constant."""
        inverse = np.linalg.inv(rule.effective(tie.mass, tie.damping, tie.stiffness))
        lifted = np.ascontiguousarray(-rule.keep * inverse @ tie.contact_map.T)
        own = tie.contact_map @ lifted
        fixed = np.eye(len(own)) - (rule.lift_u * tie.springs + rule.lift_v * tie.dashpots)[:, None] * own
        return cls(rule, tie, inverse, np.linalg.inv(tie.mass), lifted, fixed)

    def freed(self, body: FloatArray, before: FloatArray) -> Motion:
        """Motion after the step without its contact forces; `before` are those at its beginning."""
        rule, tie = self.rule, self.tie
        z, dz, ddz = body
        free_z = z + rule.step * dz + rule.free_u * ddz
        free_dz = dz + rule.free_v * ddz
        push = -(tie.stiffness @ free_z + tie.damping @ free_dz)
        if rule.alpha_m or rule.alpha_f:
            old = tie.stiffness @ z + tie.damping @ dz + tie.contact_map.T @ before
            push = rule.keep * push - rule.alpha_f * old - rule.alpha_m * (tie.mass @ ddz)
        free_ddz = self.inverse @ push
        return free_z + rule.lift_u * free_ddz, free_dz + rule.lift_v * free_ddz, free_ddz

    def met(
        self,
        free: Motion,
        road: tuple[FloatArray, FloatArray],
        guideway: tuple[FloatArray, FloatArray | float],
        yields: tuple[FloatArray, FloatArray | float],
    ) -> tuple[FloatArray, FloatArray]:
        """Set up the contact forces of the step, matrix · F = right: F = k (B z − w + r) + c (B ż − ẇ + ṙ).

        Each pair is a displacement and its rate at the contacts: elevation, deflection without the forces of this
        step, and deflection per force.
        """
        tie = self.tie
        right = tie.springs * (tie.contact_map @ free[0] - guideway[0] + road[0])
        right += tie.dashpots * (tie.contact_map @ free[1] - guideway[1] + road[1])
        return self.fixed + tie.springs[:, None] * yields[0] + tie.dashpots[:, None] * yields[1], right

    def taken(self, body: FloatArray, free: Motion, force: FloatArray) -> None:
        """Bring a vehicle to the end of the step, in place: free motion and contact forces (contact,)."""
        gained = self.lifted @ force
        body[0] = free[0] + self.rule.lift_u * gained
        body[1] = free[1] + self.rule.lift_v * gained
        body[2] = free[2] + gained

    def balanced(self, body: FloatArray, force: FloatArray) -> FloatArray:
        """Acceleration that fits displacement, velocity and contact forces, (dof,)."""
        tie = self.tie
        return self.mass_inverse @ -(tie.stiffness @ body[0] + tie.damping @ body[1] + tie.contact_map.T @ force)

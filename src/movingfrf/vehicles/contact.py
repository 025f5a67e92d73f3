"""Where a vehicle touches the guideway."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from movingfrf._basics.arrays import NumberArray
from movingfrf._basics.checks import checking
from movingfrf._basics.enveloping import enveloping
from movingfrf._basics.values import Value


@dataclass(frozen=True, slots=True, kw_only=True)
class Contact(Value):
    """Where and how a vehicle touches the guideway: a spring and a dashpot side by side, or rigidly.

    Parameters
    ----------
    position : float
        Ahead of the vehicle's reference point [m], positive in the direction of travel.
    stiffness : float or inf
        Contact (tyre) stiffness [N/m]; `inf` for a contact that follows the guideway rigidly.
    damping : float
        Contact damping [N s/m]; nothing for a rigid contact.
    path : int
        Number of the profile's path that the contact follows.
    across : float
        Position across the guideway, left of its centre line [m].
    footprint : float
        Length over which the contact averages the profile [m].
    cams : float
        Distance between the two points, one behind the other, whose mean height the contact follows [m]: the
        tandem of cams by which a tyre envelops the road, linearised. 0 for one point.
    name : str
        What the contact is called in reports.

    Raises
    ------
    ValueError
        If the stiffness is not positive, or damping, path, footprint or cams is negative.

    References
    ----------
    Tandem of cams: A. J. C. Schmeitz, A semi-empirical three-dimensional model of the pneumatic tyre rolling over
    arbitrarily uneven road surfaces, thesis, TU Delft, 2004.
    """

    position: float
    stiffness: float
    damping: float = 0.0
    path: int = 0
    across: float = 0.0
    footprint: float = 0.0
    cams: float = 0.0
    name: str = ""

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking(self) as check:
            check.finite("position", self.position, "m")
            check.not_negative("damping", self.damping, "N s/m")
            if check.positive_or_infinite("stiffness", self.stiffness, "N/m") == np.inf and self.damping:
                check.refuse("damping", f"must be 0 at a rigid contact, got {self.damping!r} N s/m")
            check.whole("path", self.path)
            check.finite("across", self.across, "m")
            check.not_negative("footprint", self.footprint, "m")
            check.not_negative("cams", self.cams, "m")
            check.text("name", self.name)

    @property
    def rigid(self) -> bool:
        """Whether the contact follows the guideway rigidly."""
        return self.stiffness == np.inf

    def enveloping(self, wavenumber: NumberArray) -> NumberArray:
        """Share of a wave of the profile that the contact follows.

        Parameters
        ----------
        wavenumber : ndarray
            Wavenumber κ of the profile [rad/m]; may be complex.

        Returns
        -------
        ndarray
            sin(κL/2)/(κL/2) · cos(κs/2) for a footprint of length L and cams at a distance s, like `wavenumber`.
        """
        return enveloping(wavenumber, self.footprint, self.cams)

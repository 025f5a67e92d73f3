"""How a vehicle travels, and in what steps it is observed."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import checking
from movingfrf._basics.wording import in_both_units, told_apart
from movingfrf.vehicles.vehicle import Vehicle


@dataclass(frozen=True, slots=True, kw_only=True)
class Journey:
    """How a vehicle travels and in what steps it is observed.

    Parameters
    ----------
    speed : float
        Speed [m/s].
    duration : float
        Duration [s].
    start : float
        Distance of the vehicle's reference point at t = 0 [m].
    time_step : float
        Step in time [s].
    truncation : float, optional
        Frequency beyond which the road counts as rigid [Hz].
    blend : float
        Length over which the profile sets in [m].
    solved_step : float, optional
        Step in which moving FRFs solve it [s]; None: as fine as road and system need.
    in_kmh : bool
        Whether the speed was given in km/h, as which it is shown first then.

    Raises
    ------
    ValueError
        If a value is impossible.
    """

    speed: float
    duration: float
    start: float = 0.0
    time_step: float = 1e-3
    truncation: float | None = None
    blend: float = 5.0
    solved_step: float | None = None
    in_kmh: bool = field(default=False, compare=False)  # how it was given is no part of what it is

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking(self) as check:
            check.positive("speed", self.speed, "m/s")
            check.positive("duration", self.duration, "s")
            check.positive("time_step", self.time_step, "s")
            check.finite("start", self.start, "m")
            check.not_negative("blend", self.blend, "m")
            if self.truncation is not None:
                check.not_negative("truncation", self.truncation, "Hz")
            if self.solved_step is not None:
                check.positive("solved_step", self.solved_step, "s")
            if not check.faults and self.samples < 2:
                step, got = told_apart(self.time_step, self.duration)
                check.refuse("duration", f"must be at least two time steps of {step} s, got {got} s")

    @property
    def speed_in_words(self) -> str:
        """The speed in both units, first in that in which it was given."""
        first, second = in_both_units(self.speed, in_kmh=self.in_kmh)
        return f"{first} ({second})"

    @property
    def samples(self) -> int:
        """Number of time steps."""
        return round(self.duration / self.time_step)

    @property
    def times(self) -> FloatArray:
        """Times at which the vehicle is observed, from zero, shape (time,) [s]."""
        return np.arange(self.samples) * self.time_step

    @property
    def travelled(self) -> FloatArray:
        """Distance travelled by then, shape (time,) [m]."""
        return self.speed * self.time_step * np.arange(self.samples)

    @property
    def distance(self) -> float:
        """Distance travelled in all [m]."""
        return self.speed * self.time_step * self.samples

    @property
    def settings(self) -> dict[str, float]:
        """What a result says of the journey, by the names of its attributes."""
        return {name: getattr(self, name) for name in ("speed", "duration", "start", "time_step", "blend")}

    @property
    def given_speed(self) -> dict[str, float]:
        """What a result says of the speed beside it [km/h]; nothing where it was given in m/s."""
        return {"speed_kmh": 3.6 * self.speed} if self.in_kmh else {}

    def interval(self, vehicle: Vehicle) -> tuple[float, float]:
        """First and last distance that a contact meets [m]."""
        positions = self.start + vehicle.positions
        return float(positions.min()), float(positions.max()) + self.distance

    def coordinates(self, vehicle: Vehicle) -> dict[str, ArrayLike]:
        """Coordinates of a coupled result by their names in the schema: times, contacts, degrees of freedom."""
        return {"time": self.times, **vehicle.coordinates}

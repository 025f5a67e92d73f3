"""Where the guideway begins to count as rigid."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from movingfrf._basics.arrays import ComplexArray, FloatArray
from movingfrf._basics.smooth import smoothest_step


@dataclass(frozen=True, slots=True, kw_only=True)
class TruncationSearch:
    """What tunes the truncation and the search for it; in brackets, between what each number is safe."""

    # Share of the truncation over which the guideway stiffens beyond it. What a sharp cut discards would ring on
    # and on, and the window raises what comes late.
    stiffening: float = 0.05  # [a convention that users are told]
    # The change in any output that a rigid road beyond the truncation may make is 1e-6, relative L2. The spectra
    # are those of records under an exponential window; undoing it raises what was cut early against what comes
    # late.
    negligible: float = 5e-7  # [1e-8 to 7e-7]
    # Bands, equally wide in the logarithm, within which the system counts as constant.
    bands: int = 160  # [80 to 640]
    # A frequency that exceeds the truncation by this share of it lies at it.
    rounding: float = 1e-9  # [1e-12 to 1e-6]


TRUNCATION = TruncationSearch()


@dataclass(frozen=True, slots=True, kw_only=True)
class Truncation:
    """Where the guideway begins to count as rigid.

    Parameters
    ----------
    frequency : float
        Up to here the guideway is what it is; over the next 5 % it stiffens, beyond it is rigid [Hz]. inf: it is
        what it is everywhere; 0: it is rigid.
    error : float
        Greatest relative change of any output that this makes.
    """

    frequency: float = np.inf
    error: float = 0.0

    @classmethod
    def stated(cls, frequency: float | None) -> Truncation:
        """Truncate where it is asked for [Hz]; None: nowhere."""
        return cls() if frequency is None else cls(frequency=frequency)

    @property
    def width(self) -> float:
        """Width of the band over which the guideway stiffens [Hz]; inf if it does nowhere."""
        return TRUNCATION.stiffening * self.frequency or np.inf

    def taper(self, omega: ComplexArray) -> FloatArray:
        """Share of its compliance that the guideway has at some frequencies [rad/s]: 1, then less, then 0."""
        if self.frequency in (0.0, np.inf):
            return np.full(omega.size, 1.0 if self.frequency else 0.0)
        frequency, width = omega.real / (2 * np.pi), TRUNCATION.stiffening
        return smoothest_step((1.0 + width - frequency / self.frequency) / width)

    def admitted(self, frf: ComplexArray, omega: ComplexArray) -> ComplexArray:
        """Let a guideway stiffen: moving FRFs, shape (…, frequency), times the taper."""
        return frf * self.taper(omega)

    def untouched(self, omega: ComplexArray) -> int:
        """Count the frequencies [rad/s] up to the truncation; ascending, unless all count."""
        return self._below(omega, 1.0)

    def harmonics(self, period: float, size: int) -> int:
        """Count those of so many harmonics of a period [s] that lie up to the truncation, from zero on."""
        if self.frequency in (0.0, np.inf):
            return size if self.frequency else 0
        return min(int(self.frequency * (1.0 + TRUNCATION.rounding) * period) + 1, size)

    def reach(self, omega: ComplexArray) -> int:
        """Count the frequencies [rad/s] at which the guideway gives way at all, as for `untouched`."""
        return self._below(omega, 1.0 + TRUNCATION.stiffening)

    def _below(self, omega: ComplexArray, share: float) -> int:
        if self.frequency in (0.0, np.inf):
            return omega.size if self.frequency else 0
        limit = 2 * np.pi * share * self.frequency * (1.0 + TRUNCATION.rounding)
        return int(np.searchsorted(omega.real, limit, side="right"))


# The guideway is what it is at every frequency.
EVERYWHERE = Truncation()

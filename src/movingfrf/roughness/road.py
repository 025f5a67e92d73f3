"""A road: a profile together with the ensemble that it stands for."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from movingfrf._basics.checks import plain
from movingfrf.roughness.profile import Profile
from movingfrf.roughness.spectra.coherence import Coherence, presumed
from movingfrf.roughness.spectra.spectrum import Spectrum


class Road(NamedTuple):
    """A profile, a sentence about where it comes from, and the spectrum of the Gaussian roads that it is one of.

    `coherence` says what its paths have in common: 1 for the same elevation on all, 0 for nothing.
    """

    profile: Profile
    description: str
    spectrum: Spectrum | None = None
    coherence: Coherence | float | None = None


def in_common(
    spectrum: Spectrum, seed: int | Sequence[int], across: Sequence[float] | None, coherence: Coherence | None
) -> Coherence | float | None:
    """Say what the paths of a realisation have in common; None if only some of them are equal."""
    if across is not None:
        return coherence if coherence is not None else presumed(spectrum)
    seeds = [plain(one) for one in (seed if isinstance(seed, Sequence) else [seed])]
    different = len(set(seeds))
    if different == 1:
        return 1.0
    return 0.0 if different == len(seeds) else None

"""From coupled spectra to histories."""

from __future__ import annotations

from typing import NamedTuple

from movingfrf.response.line import Histories, SpectralGrid
from movingfrf.response.solve import CoupledSpectra


class Response(NamedTuple):
    """Histories of what the roughness adds to the steady state."""

    force: Histories
    deflection: Histories
    motion: Histories
    acceleration: Histories


def histories(spectra: CoupledSpectra, grid: SpectralGrid) -> Response:
    """Transform coupled spectra to time.

    Parameters
    ----------
    spectra : CoupledSpectra
        What `couple` returned.
    grid : SpectralGrid
        The grid they were computed on.

    Returns
    -------
    Response
        Dynamic force [N], deflection [m], motion [m or rad] and acceleration [m/s² or rad/s²].
    """
    scratch = grid.scratch()
    return Response(
        grid.to_histories(spectra.force, scratch=scratch),
        grid.to_histories(spectra.deflection, scratch=scratch),
        grid.to_histories(spectra.motion, scratch=scratch),
        grid.to_histories(spectra.motion, derivative=2, scratch=scratch),
    )

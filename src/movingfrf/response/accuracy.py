"""How far the record of a solved response may be off, in figures."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf.response.line import Given, Histories
from movingfrf.response.sampling import SAMPLING, Excited
from movingfrf.response.solve import solve
from movingfrf.response.system import CoupledHistories, Response, System
from movingfrf.response.truncation import EVERYWHERE, Truncation


def relative(
    part: CoupledHistories,
    whole: CoupledHistories,
    *,
    peaks: bool = True,
    factors: Sequence[FloatArray | float] = (1.0, 1.0, 1.0, 1.0),
) -> FloatArray:
    """Greatest share that a part of the response has of any channel.

    Parameters
    ----------
    part, whole : CoupledHistories
        Dynamic parts of the response.
    peaks : bool
        Whether largest values are compared; otherwise root mean squares.
    factors : sequence of ndarray
        By what the part is multiplied, one for each channel of each kind.

    Returns
    -------
    ndarray, shape (case,)
        Relative to the channel, for each case of the part.
    """

    def size(records: Histories) -> FloatArray:
        if peaks:
            return np.abs(records.values).max(axis=-1)
        return np.sqrt(np.square(records.values).mean(axis=-1))

    greatest = np.zeros(len(part.force.values))
    for mine, all_of_it, factor in zip(part, whole, factors, strict=True):
        of_whole = size(all_of_it)
        of_whole = np.maximum(of_whole, SAMPLING.smallest * of_whole.max(initial=0.0))
        of_part = factor * size(mine)
        share = np.divide(of_part, of_whole, out=np.zeros_like(of_part), where=of_whole > 0)
        greatest = np.maximum(greatest, share.max(axis=-1, initial=0.0))
    return greatest


def unresolved(driven_by: Excited, response: Response, histories: CoupledHistories) -> float:
    """Estimate what is not solved from the highest octave that is: from its largest values and its energy.

    Parameters
    ----------
    driven_by : Excited
        What was solved.
    response : Response
        Its spectra.
    histories : CoupledHistories
        Its records.

    Returns
    -------
    float
        Relative to the largest value of a channel.
    """
    count = driven_by.omega.size
    octave = [spectra.copy() for spectra in response]
    for spectra in octave:
        spectra[..., : count // 2] = 0.0
    ports = [spectra.shape[-2] for spectra in (response.force, response.deflection, response.motion)]
    beyond = np.split(driven_by.beyond, np.cumsum([*ports, ports[-1]])[:-1])
    return float(relative(Response(*octave).histories(driven_by.line), histories, factors=beyond).max())


def past_the_end(
    system: System, driven_by: Excited, given: Given, histories: CoupledHistories, known: int
) -> float:
    """Estimate what guesses about the road past the end of its profile change.

    Parameters
    ----------
    system : System
        Vehicle and road.
    driven_by : Excited
        What was solved.
    given : Given
        What guesses are off, one case each.
    histories : CoupledHistories
        The records.
    known : int
        So many of their samples know the road; what is guessed may be far larger.

    Returns
    -------
    float
        Relative to the largest value of a channel.
    """
    omega = driven_by.omega
    response = solve(system, omega, driven_by.likewise(given), truncation=driven_by.truncation)
    before = CoupledHistories(*(Histories(some.values[..., :known], some.wrapped) for some in histories))
    return float(np.median(relative(response.histories(driven_by.line), before)))


def truncated(system: System, driven_by: Excited, response: Response, histories: CoupledHistories) -> Truncation:
    """Say of a truncation what it changes: estimated where that is little, otherwise computed.

    Parameters
    ----------
    system : System
        Vehicle and road.
    driven_by : Excited
        What was solved.
    response : Response
        Its spectra.
    histories : CoupledHistories
        Its records.

    Returns
    -------
    Truncation
        The same, with the greatest relative change of any channel, root mean square over the record.
    """
    cut, omega = driven_by.truncation, driven_by.omega
    if cut.error <= SAMPLING.estimated:
        return cut
    first = cut.untouched(omega)
    whole = solve(system, omega[first:], driven_by.spectra[..., first:], truncation=EVERYWHERE)
    change = []
    for with_it, without in zip(response, whole, strict=True):
        difference = np.zeros((*without.shape[:-1], omega.size), complex)
        difference[..., first:] = without
        difference[..., first : with_it.shape[-1]] -= with_it[..., first:]
        change.append(difference)
    error = float(relative(Response(*change).histories(driven_by.line), histories, peaks=False).max())
    return Truncation(frequency=cut.frequency, error=error)

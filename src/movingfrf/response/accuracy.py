"""How far the record of a solved response may be off, in figures."""

from __future__ import annotations

import numpy as np

from movingfrf._basics.arrays import ComplexArray, FloatArray
from movingfrf.response.influence import quotient
from movingfrf.response.line import TRANSFORM, Given
from movingfrf.response.sampling import SAMPLING, Excited
from movingfrf.response.solve import solve
from movingfrf.response.system import CoupledHistories, Response, System
from movingfrf.response.truncation import EVERYWHERE, Truncation


def largest(records: FloatArray) -> FloatArray:
    """Largest magnitudes of records, (*case, port, time) to (*case, port)."""
    return np.abs(records).max(axis=-1)


def rms(records: FloatArray) -> FloatArray:
    """Root mean squares of records, (*case, port, time) to (*case, port)."""
    return np.sqrt(np.square(records).mean(axis=-1))


def relative(part: FloatArray, whole: FloatArray) -> FloatArray:
    """Greatest share that a part has of any channel of its kind.

    Parameters
    ----------
    part, whole : ndarray, shape (case, port)
        Sizes.

    Returns
    -------
    ndarray, shape (case,)
        Relative to the channel.
    """
    whole = np.maximum(whole, SAMPLING.smallest * whole.max(initial=0.0))
    share: FloatArray = np.divide(part, whole, out=np.zeros_like(part), where=whole > 0)
    return share.max(axis=-1, initial=0.0)


def unresolved(driven_by: Excited, response: Response, histories: CoupledHistories) -> float:
    """Estimate what is not solved from the highest octave that is: from its largest values and its energy.

    Forces and accelerations have more of it than deflections and motions.

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
    beyond, contacts, dofs = driven_by.beyond, response.force.shape[-2], response.motion.shape[-2]
    of_force = beyond[:contacts] * _largest_of_octave(driven_by, response.force, 0)
    of_acceleration = beyond[-dofs:] * _largest_of_octave(driven_by, response.motion, 2)
    peaks = max(
        float(relative(part, largest(whole.values)).max(initial=0.0))
        for part, whole in ((of_force, histories.force), (of_acceleration, histories.acceleration))
    )
    # No more than all can be missing; and no less than what is known to be left out, relative L2.
    return min(max(peaks, driven_by.missing), 1.0)


def _largest_of_octave(driven_by: Excited, spectra: ComplexArray, derivative: int) -> FloatArray:
    """Largest magnitudes, (*case, port), of what the highest octave that is solved holds of a derivative."""
    begins, scratch = driven_by.omega.size // 2, driven_by.line.scratch()
    found = []
    # A few channels at a time: fresh memory for all of them costs more than their transforms.
    for first in range(0, spectra.shape[-2], TRANSFORM.together):
        octave = spectra[..., first : first + TRANSFORM.together, :].copy()
        octave[..., :begins] = 0.0
        found.append(largest(driven_by.line.records(octave, derivative=derivative, scratch=scratch).values))
    return np.concatenate(found, axis=-1)


def shares_beyond(response: Response, omega: ComplexArray, first: int) -> FloatArray:
    """Share of each contact force and each acceleration, relative L2, from a frequency on; shape (output,)."""
    shares = []
    for spectra, weight in ((response.force[0], np.ones(omega.size)), (response.motion[0], np.abs(omega) ** 4)):
        # Channel by channel, as above.
        part, whole = (
            np.array([_energy(channel[begins:], weight[begins:]) for channel in spectra]) for begins in (first, 0)
        )
        shares.append(_share(part, whole))
    return np.concatenate(shares)


def _energy(channel: ComplexArray, weight: FloatArray) -> float:
    """Energy of a spectrum, frequency by frequency weighted."""
    return float((np.square(channel.real) + np.square(channel.imag)) @ weight)


def _share(part: FloatArray, whole: FloatArray) -> FloatArray:
    """Square root of the quotient of two energies, each whole as large as a small share of the largest at least."""
    return np.sqrt(quotient(part, np.maximum(whole, SAMPLING.smallest**2 * whole.max(initial=0.0))))


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
    pairs = zip(response.histories(driven_by.line), histories, strict=True)
    shares = [relative(largest(off.values), largest(all_of_it.values[..., :known])) for off, all_of_it in pairs]
    return float(np.median(np.max(shares, axis=0)))


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
    first = cut.untouched(omega)
    if cut.error <= SAMPLING.estimated or omega.size - first > SAMPLING.affordable:
        return cut
    untruncated = solve(system, omega[first:], driven_by.spectra[..., first:], truncation=EVERYWHERE)
    change = []
    for with_it, without in zip(response, untruncated, strict=True):
        difference = np.zeros((*without.shape[:-1], omega.size), complex)
        difference[..., first:] = without
        difference[..., first : with_it.shape[-1]] -= with_it[..., first:]
        change.append(difference)
    error = 0.0
    for off, cut_off in zip(Response(*change).histories(driven_by.line), histories, strict=True):
        error = max(error, float(relative(rms(off.values), rms(cut_off.values + off.values)).max(initial=0.0)))
    return Truncation(frequency=cut.frequency, error=error)

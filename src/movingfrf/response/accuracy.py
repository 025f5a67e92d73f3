"""How far the record of a solved response may be off, in figures."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from movingfrf._basics.arrays import ComplexArray, FloatArray
from movingfrf.response.line import TRANSFORM, Given, Line, in_blocks
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
    line, beyond, begins = driven_by.line, driven_by.beyond, driven_by.omega.size // 2
    contacts, dofs = response.force.shape[-2], response.motion.shape[-2]
    octaves = [(response.force[..., begins:], 0), (response.motion[..., begins:], 2)]
    forces, accelerations = _each(line, begins, octaves, _largest)
    peaks = max(
        relative(beyond[:contacts] * forces, largest(histories.force.values)).max(initial=0.0),
        relative(beyond[-dofs:] * accelerations, largest(histories.acceleration.values)).max(initial=0.0),
    )
    # No more than all can be missing; and no less than what is known to be left out, relative L2.
    return min(max(float(peaks), driven_by.missing), 1.0)


def hidden(
    line: Line, spectra: ComplexArray, records: FloatArray, *, derivative: int = 0, least: float | None = None
) -> FloatArray:
    """Share of each channel above the Nyquist frequency of its record, root mean square over the record.

    Parameters
    ----------
    line : Line
        The record.
    spectra : ndarray, shape (case, port, frequency)
        Spectra of the channels: those of a record under a window, which do not tell it themselves.
    records : ndarray, shape (case, port, time)
        Their records, or those of derivatives.
    derivative : int
        Order of these.
    least : float, optional
        A channel counts as large as this share of the largest at least; None: a small one.

    Returns
    -------
    ndarray, shape (port,)
        Relative to the channel.
    """
    first = line.padded // 2 + 1
    if spectra.shape[-1] <= first:
        return np.zeros(spectra.shape[-2])
    # What happens right after the end shows before it, for as long as the cut rings.
    kept = max(1.0 - 2.0 / TRANSFORM.fading_in / line.samples, 0.5)

    def size(swings: FloatArray) -> FloatArray:
        return np.sqrt(0.5 * swings[..., : max(int(kept * swings.shape[-1]), 1)].mean(axis=-1))

    (part,), whole = _each(line, first, [(spectra[..., first:], derivative)], size), rms(records)
    # Few samples may all miss it.
    whole = np.maximum(whole, part)
    whole = np.maximum(whole, (SAMPLING.smallest if least is None else least) * whole.max(initial=0.0))
    share: FloatArray = np.divide(part, whole, out=np.zeros_like(part), where=whole > 0)
    return share.max(axis=0)


def _largest(swings: FloatArray) -> FloatArray:
    """Largest envelope of each channel."""
    found: FloatArray = np.sqrt(swings.max(axis=-1))
    return found


def _mean(swings: FloatArray) -> FloatArray:
    """Mean squared envelope of each channel."""
    found: FloatArray = swings.mean(axis=-1)
    return found


def _each(
    line: Line,
    first: int,
    asked: Sequence[tuple[ComplexArray, int]],
    measured: Callable[[FloatArray], FloatArray],
    *,
    fading_in: bool = True,
) -> list[FloatArray]:
    """Measure the squared envelopes, `Line.swings`, of what begins at a frequency, or of its derivatives in time.

    A few channels at a time: memory for all costs more. From (case, port, frequency) to (case, port) each.
    """
    cases, longest = len(asked[0][0]), max(spectra.shape[-1] for spectra, _ in asked)
    s = 1j * line.omega(slice(first, first + longest))
    factors = {order: s**order for _, order in asked if order}
    counts = [spectra.shape[1] for spectra, _ in asked]
    found: list[FloatArray] = [np.empty((cases, count)) for count in counts]
    for rows, here in in_blocks(counts, TRANSFORM.rows(2 * longest)):
        block = np.zeros((cases, rows, longest), complex)
        for kind, some, there in here:
            spectra, order = asked[kind]
            size = spectra.shape[-1]
            np.multiply(spectra[:, some], factors[order][:size] if order else 1.0, out=block[:, there, :size])
        measures = measured(line.swings(block, first, fading_in=fading_in))
        for kind, some, there in here:
            found[kind][:, some] = measures[:, there]
    return found


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
        known = with_it[..., first:]
        without[..., : known.shape[-1]] -= known
        change.append(without)
    line, error = driven_by.line, 0.0
    for spectra, order, records in zip(
        (*change, change[-1]), (0, 0, 0, 2), (part.values for part in histories), strict=True
    ):
        (swings,) = _each(line, first, [(spectra, order)], _mean, fading_in=False)
        share = float(relative(np.sqrt(0.5 * swings), rms(records)).max(initial=0.0))
        if share > SAMPLING.slight:
            # The record without a truncation is another one.
            whole = np.zeros((*spectra.shape[:-1], omega.size), complex)
            whole[..., first:] = spectra
            off = line.records(whole, derivative=order).values
            share = float(relative(rms(off), rms(records + off)).max(initial=0.0))
        error = max(error, share)
    return Truncation(frequency=cut.frequency, error=error)

"""A track of finite length, by cubic Hermite elements."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from numbers import Real
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sparse
from numpy.typing import ArrayLike

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import Checks, checking, shown, spelt
from movingfrf._basics.door import instead_of
from movingfrf._basics.smooth import smooth_step
from movingfrf._basics.values import Value
from movingfrf.guideways.beams import EulerBernoulliBeam
from movingfrf.guideways.foundations import Foundation, OnMass, ShearLayer, Spring
from movingfrf.guideways.track import Track
from movingfrf.stepping.finite_guideway import ELEMENT_ROUNDING, FiniteGuideway, Mesh


class End(NamedTuple):
    """What an end of a finite guideway holds."""

    deflection: bool
    slope: bool
    # Whether a guideway may have it that travels along: elsewhere what joins the guideway would have to jump.
    follows: bool = False


# How a finite guideway may end.
ENDS = {
    "pinned": End(True, False),
    "clamped": End(True, True, follows=True),
    "guided": End(False, True),
    "free": End(False, False),
    "absorbing": End(True, True, follows=True),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Absorption:
    """What tunes an absorbing stretch; in brackets, between what each number is safe."""

    # Damping at its end, as a multiple of 2√(km): strong, but reached so gradually that next to nothing is
    # reflected. Measured on the reference road, 15 to 20 m long: below 1e-3 of what comes in.
    strength: float = 1.5  # [1.2 to 2]
    # Its length unless told otherwise [m]; the range is that of the reference road, which bends over 1.7 m. A track
    # that bends over more needs a longer one: at 5 m some per cent of a receptance come back.
    length: float = 15.0  # [12 to 20]


ABSORPTION = Absorption()


@dataclass(frozen=True, slots=True, eq=False)
class CubicRows(Value):
    """Interpolation on a chain of cubic elements."""

    mesh: Mesh
    dofs: int

    def __call__(self, positions: FloatArray, derivative: int = 0, /) -> sparse.csr_array:
        """Rows of shape (position, dof)."""
        mesh = self.mesh
        at = (positions - mesh.first) / mesh.element
        elements = np.clip(np.floor(at).astype(int), 0, mesh.elements - 1)
        values = cubic_functions(at - elements, mesh.element, derivative)
        places = mesh.number[2 * elements[:, None] + np.arange(4)]
        values[places < 0] = 0.0
        rows = np.broadcast_to(np.arange(len(positions))[:, None], places.shape)
        shape = (len(positions), self.dofs)
        return sparse.csr_array((values.ravel(), (rows.ravel(), np.maximum(places, 0).ravel())), shape=shape)


def cubic_functions(share: FloatArray, element: float, derivative: int) -> FloatArray:
    """Cubic Hermite functions of one element, or their derivatives along the guideway.

    Parameters
    ----------
    share : ndarray, shape (n,)
        Place within the element, from 0 to 1.
    element : float
        Length of the element [m].
    derivative : int
        Order of the derivative.

    Returns
    -------
    ndarray, shape (n, 4)
        Of the deflection and slope at the first node, then of those at the second.

    Examples
    --------
    >>> cubic_functions(np.array([0.0, 0.5]), 2.0, 0).tolist()
    [[1.0, 0.0, 0.0, 0.0], [0.5, 0.25, 0.5, -0.25]]
    """
    polynomials = np.array([[1.0, 0, -3, 2], [0, 1, -2, 1], [0, 0, 3, -2], [0, 0, -1, 1]])
    scale = np.array([1.0, element, 1.0, element]) / element**derivative
    return np.stack(
        [
            factor * np.polynomial.Polynomial(row).deriv(derivative)(share)
            for factor, row in zip(scale, polynomials, strict=True)
        ],
        axis=1,
    )


def finite_track(
    track: Track,
    *,
    first: float,
    last: float,
    element: float = 0.25,
    ends: str | tuple[str, str] = "absorbing",
    absorbing: float | None = None,
    band: float = 70.0,
    travels: bool = False,
) -> FiniteGuideway:
    """Cut a stretch out of a track and divide it into cubic Hermite elements.

    Parameters
    ----------
    track : Track
        An Euler–Bernoulli beam on any foundation; layers of mass get unknowns of their own.
    first : float
        Where the stretch begins [m].
    last : float
        Where the stretch ends [m].
    element : float
        Length of an element [m], at most: a whole number of them fills the stretch.
    ends : str or tuple of str
        "pinned" (simply supported), "clamped", "guided", "free", or "absorbing"; one for both, or one for each.
        Absorbing ends have dashpots that grow from nothing over the length `absorbing`. A stretch that travels has
        absorbing or clamped ends.
    absorbing : float, optional
        Length of that stretch at each absorbing end [m]; None: 15 m, or a third of a road that is short.
    band : float
        Highest frequency whose waves the elements shall resolve [Hz].
    travels : bool
        Whether the stretch accompanies the vehicle: positions are then those seen from its reference point.

    Returns
    -------
    FiniteGuideway
        With the mass, damping and stiffness of the track, consistent matrices.

    Raises
    ------
    ValueError
        If the beam is no Euler–Bernoulli beam, an end is unknown, a length is impossible, or an element is too
        long to bend as the track does under a load at rest, or in the waves of the band.

    Examples
    --------
    >>> import movingfrf as mf
    >>> pavement = mf.EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9)
    >>> road = mf.track(pavement, mf.Spring(stiffness=8.0e6, damping=3.0e4))
    >>> finite_track(road, first=0.0, last=40.0, element=0.5, ends="pinned").dofs
    160
    """
    with checking() as check:
        if not isinstance(track, Track) or not isinstance(track.beam, EulerBernoulliBeam):
            check.refuse(
                "track",
                f"must have an Euler–Bernoulli beam to be cut into elements, got {shown(track)}"
                f"{instead_of('track', track)}",
            )
        first, last = check.finite("first", first, "m"), check.finite("last", last, "m")
        element = check.positive("element", element, "m")
        both, length = require_stretch(check, (first, last), element, ends, absorbing, travels)
        band = check.not_negative("band", band, "Hz")
    assert isinstance(track.beam, EulerBernoulliBeam)
    layers = _layers(track)
    with checking() as check:
        require_fine(check, track, element, band)
    count = int(np.ceil((last - first) / element - ELEMENT_ROUNDING))
    element = (last - first) / count
    integrals = [_assembled(element, count, order) for order in range(3)]
    node = np.zeros(len(layers.masses))
    node[0] = 1.0
    beam_only = sparse.diags_array(node)
    middles = first + element * (np.arange(count) + 0.5)
    dashpots = absorption(track, (first, last), both, length, middles)
    mass = sparse.kron(integrals[0], sparse.diags_array(layers.masses))
    stiffness = (
        sparse.kron(track.beam.bending_stiffness * integrals[2], beam_only)
        + sparse.kron(integrals[1], layers.shear)
        + sparse.kron(integrals[0], layers.stiffness)
    )
    damping = (
        sparse.kron(track.beam.bending_damping * integrals[2], beam_only)
        + sparse.kron(integrals[0], layers.damping)
        + sparse.kron(_assembled(element, count, 0, dashpots), sparse.eye_array(len(layers.masses)))
    )
    held = np.zeros((count + 1, 2), bool)
    held[0], held[-1] = ((ENDS[end].deflection, ENDS[end].slope) for end in both)
    kept = np.flatnonzero(np.repeat(~held.ravel(), len(layers.masses)))
    number = np.full(held.size * len(layers.masses), -1)
    number[kept] = np.arange(kept.size)
    mesh = Mesh(float(first), float(element), number[:: len(layers.masses)])

    def of(matrix: Any) -> sparse.csc_array:
        return sparse.csc_array(sparse.csr_array(matrix)[kept][:, kept])

    return FiniteGuideway(
        mass=of(mass),
        damping=of(damping),
        stiffness=of(stiffness),
        interpolation=CubicRows(mesh, kept.size),
        interval=(float(first), float(last)),
        spacing=element,
        mesh=mesh,
        travels=travels,
        column=2 * len(layers.masses),
        finer=partial(
            _finer,
            element,
            track=track,
            first=first,
            last=last,
            ends=both,
            absorbing=length,
            band=band,
            travels=travels,
        ),
    )


def _finer(element: float, parts: int, **others: Any) -> FiniteGuideway:
    return finite_track(element=element / parts, **others)


def require_stretch(
    check: Checks,
    interval: tuple[float, float],
    element: float,
    ends: str | tuple[str, str],
    absorbing: float | None,
    travels: bool,
) -> tuple[tuple[str, str], float]:
    """Check where a stretch begins and ends, and how.

    Parameters
    ----------
    check : Checks
        Collects the faults.
    interval : tuple of float
        First and last position [m].
    element : float
        Length of an element [m].
    ends, absorbing, travels
        As for `finite_track`.

    Returns
    -------
    ends : tuple of str
        One for each end.
    absorbing : float
        Length of the absorbing stretches [m].
    """
    first, last = interval
    usual = min(ABSORPTION.length, max(last - first, 0.0) / 3)
    length = check.not_negative("absorbing", usual if absorbing is None else absorbing, "m")
    both = tuple(spelt(end, ENDS) for end in ((ends, ends) if isinstance(ends, str) else ends))
    if len(both) != 2 or None in both:
        check.refuse("ends", f"must be one or two of {', '.join(ENDS)}, got {shown(ends)}")
    following = {end for end, kind in ENDS.items() if kind.follows}
    if travels and not set(both) <= following:
        check.refuse(
            "ends",
            f"of a road that travels along must be among {', '.join(sorted(following))}, so that what joins and "
            f"leaves it is at rest, got {shown(ends)}",
        )
    if not check.faults and last - first < 4 * element:
        check.refuse("last", f"must lie four elements of {element:g} m or more behind first, got {last!r} m")
    if not check.faults and "absorbing" in both and length > 0.5 * (last - first):
        check.refuse(
            "absorbing", f"must be at most half of the stretch, {0.5 * (last - first):.6g} m, got {length!r} m"
        )
    return both, length  # type: ignore[return-value]


def require_fine(check: Checks, track: Track, element: float, band: float) -> None:
    """Refuse elements too long to bend as the track does.

    Parameters
    ----------
    check : Checks
        Collects the fault.
    track : Track
        The track.
    element : float
        Length of an element [m].
    band : float
        Highest frequency whose waves the elements shall resolve [Hz].
    """
    assert isinstance(track.beam, EulerBernoulliBeam)
    # Cubic elements that a wave needs at least: with four its length is right to 1e-3 [4 or more].
    per_wave = 4
    bends_over = bending_length(track)
    inertia = track.beam.mass * (2 * np.pi * band) ** 2 - _layers(track).stiffness[0, 0]
    wavenumber = (max(inertia, 0.0) / track.beam.bending_stiffness) ** 0.25
    wave = 2 * np.pi / wavenumber if wavenumber else np.inf
    if element > bends_over:
        check.refuse(
            "element",
            f"must be at most {bends_over:.4g} m, the length (4 EI/k)^¼ over which this track bends under a load "
            f"at rest, got {element!r} m",
        )
    elif element * per_wave > wave:
        check.refuse(
            "element",
            f"must be at most {wave / per_wave:.4g} m, {per_wave} to the wave of {wave:.4g} m that runs along this "
            f"track at {band:g} Hz, got {element!r} m",
        )


def absorption(
    track: Track, interval: tuple[float, float], ends: tuple[str, str], length: float, positions: FloatArray
) -> FloatArray:
    """Damping that absorbing ends add to a track's own.

    Parameters
    ----------
    track : Track
        The track.
    interval : tuple of float
        Where the stretch begins and ends [m].
    ends : tuple of str
        How.
    length : float
        Length of an absorbing stretch [m].
    positions : ndarray
        Where it is asked for [m].

    Returns
    -------
    ndarray
        Damping per length of the whole width [N s/m²], shape of `positions`.
    """
    layers = _layers(track)
    strength = ABSORPTION.strength * 2 * np.sqrt(layers.support * layers.masses.sum())
    damping = np.zeros_like(positions)
    for end, distance in zip(ends, (positions - interval[0], interval[1] - positions), strict=True):
        if end == "absorbing" and length:
            damping += strength * smooth_step(1.0 - distance / length)
    return damping


def bending_length(track: Track) -> float:
    """Length (4 EI/k)^¼ over which a track bends under a load at rest [m].

    Parameters
    ----------
    track : Track
        The track.

    Returns
    -------
    float
        With k the stiffness of all its layers in series.
    """
    return float((4 * track.beam.bending_stiffness / _layers(track).support) ** 0.25)  # type: ignore[attr-defined]


class _Layers(NamedTuple):
    """Beam and masses of a track, and what ties them to each other and to the ground, per metre."""

    masses: FloatArray  # (layer,) [kg/m], the beam first
    stiffness: FloatArray  # (layer, layer) [N/m²]
    damping: FloatArray  # (layer, layer) [N s/m²]
    shear: FloatArray  # (layer, layer) [N]
    support: float  # static stiffness under the beam [N/m²]


def _layers(track: Track) -> _Layers:
    """List the layers of a track from the top."""
    masses, springs = [float(track.beam.mass)], []
    waiting: list[Foundation | float] = [track.foundation]
    while waiting:
        part = waiting.pop()
        if isinstance(part, OnMass):
            # What is below waits until all that is above has been listed.
            waiting += [part.below, part.mass, part.above]
        elif isinstance(part, (Spring, ShearLayer)):
            springs.append(part)
        elif isinstance(part, Real):
            masses.append(float(part))
        else:
            with checking() as check:
                kinds = "Spring, ShearLayer or OnMass"
                check.refuse("track", f"must stand on a {kinds} to be cut into elements, got {shown(part)}")
    count = len(masses)
    tables = np.zeros((3, count, count))
    for n, spring in enumerate(springs):
        stretch = np.zeros(count)
        stretch[n] = 1.0
        stretch[n + 1 : n + 2] = -1.0
        shear = spring.shear_stiffness if isinstance(spring, ShearLayer) else 0.0
        tables += np.multiply.outer([spring.stiffness, spring.damping, shear], np.outer(stretch, stretch))
    support = 1 / sum(1 / spring.stiffness for spring in springs)
    return _Layers(np.array(masses), tables[0], tables[1], tables[2], support)


def _assembled(element: float, count: int, order: int, factor: ArrayLike = 1.0) -> sparse.csr_array:
    """Integrals of the products of all shape functions' derivatives, each element times a factor."""
    points, weights = np.polynomial.legendre.leggauss(4)
    functions = cubic_functions(0.5 * (points + 1.0), element, order)
    local = np.einsum("p,pa,pb->ab", 0.5 * element * weights, functions, functions)
    places = 2 * np.arange(count)[:, None] + np.arange(4)
    rows, columns = (np.broadcast_to(x, (count, 4, 4)) for x in (places[:, :, None], places[:, None, :]))
    values = np.broadcast_to(factor, (count,))[:, None, None] * local
    size = 2 * (count + 1)
    return sparse.csr_array((values.ravel(), (rows.ravel(), columns.ravel())), shape=(size, size))

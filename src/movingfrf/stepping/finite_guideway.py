"""Roads of finite length: matrices, and a row of them for any position."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from numbers import Real
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sparse
from numpy.typing import ArrayLike

from movingfrf._basics.arrays import FloatArray, IntArray
from movingfrf._basics.checks import Checks, checking, shown
from movingfrf._basics.smooth import smooth_step
from movingfrf.guideways.beams import EulerBernoulliBeam
from movingfrf.guideways.foundations import Foundation, OnMass, ShearLayer, Spring
from movingfrf.guideways.track import Track
from movingfrf.stepping.factors import is_definite

# Positions [m], order of the derivative and, on a road with a width, places across [m] → one row per position,
# shape (position, dof).
Interpolation = Callable[..., Any]

# Ends of a finite road → which of deflection and slope they hold.
ENDS = {
    "pinned": (True, False),
    "clamped": (True, True),
    "guided": (False, True),
    "free": (False, False),
    "absorbing": (True, True),
}

# Those that a road may have which travels along: elsewhere the road that joins it would have to jump.
FOLLOWING = {"absorbing", "clamped"}

# Damping at the end of an absorbing stretch, as a multiple of 2√(km): strong, but reached so gradually that next to
# nothing is reflected. Measured on the reference road, 15 to 20 m long: below 1e-3 of what comes in.
ABSORPTION = 1.5

# Length of such a stretch unless told otherwise [m].
ABSORBING = 15.0

# Cubic elements that a wave needs at least: with four its length is right to 1e-3.
PER_WAVE = 4

# Two positions closer than this share of an element are one.
SAME_PLACE = 1e-9

# Share of the mass, scaled to the matrix, with which semidefiniteness is tested.
LITTLE = 1e-8

# Asymmetry of a matrix, relative to its largest entry, that is rounding.
ASYMMETRY = 1e-9


class Mesh(NamedTuple):
    """Nodes of a chain of cubic elements, and where their unknowns (deflection, slope of each layer) are."""

    first: float  # position of the first node [m]
    element: float  # length of an element [m]
    number: IntArray  # (2 · nodes,) unknown of the beam's deflection and slope at each node; −1 where it is held

    @property
    def elements(self) -> int:
        """Number of elements."""
        return len(self.number) // 2 - 1


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FiniteGuideway:
    """A guideway as matrices: M ü + C u̇ + K u = Σ N(x_j)ᵀ F_j, its deflection at x being N(x) u.

    From `finite_track`, or from any finite-element program: export three matrices and say how a position on the
    road is interpolated.

    Parameters
    ----------
    mass, damping, stiffness : sparse matrix or array_like, shape (dof, dof)
        Symmetric matrices [kg, N s/m, N/m; rotations in rad]; mass positive definite, the others semidefinite.
    interpolation : callable
        Called with positions [m], shape (position,), and the order of the derivative along the road (0, or 1
        where a contact has damping), and on a road with a width with places across as well, left of the centre
        line [m], shape (position,); returns the rows N, shape (position, dof), sparse or not [m/m or 1/m].
    interval : tuple of float
        First and last position that may be loaded [m].
    spacing : float
        Distance between nodes along the road [m]; contacts closer than that cannot be told apart.
    width : float
        Width of a road whose section does not move as one [m]; 0: places across make no difference.
    mesh : Mesh, optional
        Set by `finite_track`: what the compiled solvers need.
    travels : bool
        Set by `finite_track` and `finite_plate`: whether positions are those seen from the vehicle, which the road
        accompanies.
    column : int
        Set by the same: unknowns per element along the road, by which the state of a road that travels moves back.

    Raises
    ------
    ValueError
        If matrices disagree in shape, are not symmetric, finite and definite as demanded, or the interpolation does
        not give rows of their length.

    Examples
    --------
    A mass on a spring, one unknown, which deflects alike wherever it is loaded:

    >>> import numpy as np
    >>> slab = FiniteGuideway(mass=[[2000.0]], damping=[[1e4]], stiffness=[[5e6]], interval=(0.0, 10.0),
    ...                       interpolation=lambda x, derivative: np.full((x.size, 1), 1.0 - derivative))
    >>> slab.mass.shape
    (1, 1)
    """

    mass: Any
    damping: Any
    stiffness: Any
    interpolation: Interpolation
    interval: tuple[float, float]
    spacing: float = 0.0
    width: float = 0.0
    mesh: Mesh | None = None
    travels: bool = False
    column: int = 0

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking() as check:
            for name, unit in (("mass", "kg"), ("damping", "N s/m"), ("stiffness", "N/m")):
                object.__setattr__(self, name, _symmetric(check, name, getattr(self, name), unit))
            first, last = check.pair("interval", self.interval, "m", signed=True)
            if not check.faults and not first < last:
                check.refuse("interval", f"must begin before it ends, got {first!r} m to {last!r} m")
            check.not_negative("spacing", self.spacing, "m")
            check.not_negative("width", self.width, "m")
            if self.travels and not self.column > 0:
                check.refuse("column", f"must be positive on a road that travels, got {self.column!r}")
            if not check.faults:
                shapes = {matrix.shape for matrix in (self.mass, self.damping, self.stiffness)}
                if len(shapes) > 1:
                    check.refuse("mass", f"damping and stiffness must have one shape, got {sorted(shapes)}")
                if not (self.mass.diagonal() > 0).all():
                    place = int((self.mass.diagonal() <= 0).argmax())
                    check.refuse(
                        "mass",
                        f"must be positive definite, got {self.mass.diagonal()[place]!r} kg on its diagonal "
                        f"at index {place}",
                    )
            if not check.faults:
                _check_definite(check, self)
                _check_rows(check, self)

    @property
    def dofs(self) -> int:
        """Number of unknowns."""
        return int(self.mass.shape[0])

    def rows(self, positions: FloatArray, derivative: int = 0, across: ArrayLike = 0.0) -> sparse.csr_array:
        """Rows that interpolate the deflection, or its slope along the road, shape (position, dof).

        Parameters
        ----------
        positions : ndarray, shape (position,)
            Positions along the road [m].
        derivative : int
            Order of the derivative along the road.
        across : array_like, broadcastable to (position,)
            Places left of the centre line [m]; without meaning on a road without a width.
        """
        at = np.asarray(positions, float)
        beside = (np.broadcast_to(np.asarray(across, float), at.shape),) if self.width else ()
        return sparse.csr_array(self.interpolation(at, derivative, *beside))


def _symmetric(check: Checks, name: str, given: Any, unit: str) -> sparse.csc_array:
    try:
        matrix = sparse.csc_array(given, dtype=float)
    except (TypeError, ValueError):
        check.refuse(name, f"must be a square matrix [{unit}], got {shown(given)}")
        return sparse.csc_array((1, 1))
    if matrix.ndim != 2 or matrix.shape[0] != matrix.shape[1] or not matrix.shape[0]:
        check.refuse(name, f"must be a square matrix [{unit}], got shape {matrix.shape}")
    elif not np.isfinite(matrix.data).all():
        check.refuse(name, f"must be finite throughout [{unit}]")
    elif matrix.nnz and abs(matrix - matrix.T).max() > ASYMMETRY * abs(matrix).max():
        check.refuse(name, f"must be a symmetric matrix [{unit}]")
    return matrix


def _check_definite(check: Checks, road: FiniteGuideway) -> None:
    """Demand a positive definite mass, and damping and stiffness that are at least semidefinite."""
    if not is_definite(road.mass):
        check.refuse("mass", "must be positive definite: some motion has no inertia, or a negative one")
        return
    heaviest = abs(road.mass).max()
    for name, matrix in (("damping", road.damping), ("stiffness", road.stiffness)):
        largest = abs(matrix).max() if matrix.nnz else 0.0
        # A little of the mass makes a semidefinite matrix definite, and leaves an indefinite one what it is.
        if largest and not is_definite(sparse.csc_array(matrix + LITTLE * largest / heaviest * road.mass)):
            check.refuse(name, "must be positive semidefinite: some motion would be fed with energy")


def _check_rows(check: Checks, road: FiniteGuideway) -> None:
    middle = np.array([0.5 * (road.interval[0] + road.interval[1])])
    try:
        rows = road.rows(middle)
    except (TypeError, ValueError) as error:
        check.refuse("interpolation", f"must give rows for positions [m] and a derivative, but: {error}")
        return
    if rows.shape != (1, road.dofs) or not np.isfinite(rows.data).all() or not rows.nnz:
        check.refuse(
            "interpolation", f"must give finite rows of {road.dofs} values, one per unknown, got {rows.shape}"
        )


@dataclass(frozen=True, slots=True)
class CubicRows:
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
    """Cubic Hermite functions of one element, or their derivatives along the road.

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
    first, last : float
        Where the stretch begins and ends [m].
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
    >>> from movingfrf.guideways.track import EulerBernoulliBeam, Spring, track
    >>> pavement = EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9)
    >>> road = track(pavement, Spring(stiffness=8.0e6, damping=3.0e4))
    >>> finite_track(road, first=0.0, last=40.0, element=0.5, ends="pinned").dofs
    160
    """
    with checking() as check:
        if not isinstance(track, Track) or not isinstance(track.beam, EulerBernoulliBeam):
            check.refuse("track", f"must have an Euler–Bernoulli beam to be cut into elements, got {shown(track)}")
        both, length = require_stretch(check, (first, last), element, ends, absorbing, travels)
        check.not_negative("band", band, "Hz")
    assert isinstance(track.beam, EulerBernoulliBeam)
    layers = _layers(track)
    with checking() as check:
        require_fine(check, track, element, band)
    count = int(np.ceil((last - first) / element - SAME_PLACE))
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
    held[0], held[-1] = ENDS[both[0]], ENDS[both[1]]
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
    )


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
    first, last = check.finite("first", interval[0], "m"), check.finite("last", interval[1], "m")
    check.positive("element", element, "m")
    usual = min(ABSORBING, max(last - first, 0.0) / 3)
    length = check.not_negative("absorbing", usual if absorbing is None else absorbing, "m")
    both = (ends, ends) if isinstance(ends, str) else tuple(ends)
    if len(both) != 2 or not all(isinstance(end, str) and end in ENDS for end in both):
        check.refuse("ends", f"must be one or two of {', '.join(ENDS)}, got {shown(ends)}")
    if travels and not set(both) <= FOLLOWING:
        check.refuse(
            "ends",
            f"of a road that travels along must be among {', '.join(sorted(FOLLOWING))}, so that what joins and "
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
    elif element * PER_WAVE > wave:
        check.refuse(
            "element",
            f"must be at most {wave / PER_WAVE:.4g} m, {PER_WAVE} to the wave of {wave:.4g} m that runs along this "
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
    strength = ABSORPTION * 2 * np.sqrt(layers.support * layers.masses.sum())
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

"""Guideways of finite length: matrices, and a row of them for any position."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sparse
from numpy.typing import ArrayLike

from movingfrf._basics.arrays import FloatArray, IntArray
from movingfrf._basics.checks import Checks, checking, real_numbers, shown
from movingfrf._basics.values import Value
from movingfrf.stepping.factors import is_definite

# Positions [m], order of the derivative and, on a guideway with a width, places across [m] → one row per position,
# shape (position, dof).
Interpolation = Callable[..., Any]

# Two positions closer than this share of an element are one. The compiled loops read it too, which know no other
# kind of constant. [1e-10 to 1e-6]
ELEMENT_ROUNDING = 1e-9


class Mesh(NamedTuple):
    """Nodes of a chain of cubic elements, and where their unknowns (deflection, slope of each layer) are."""

    first: float  # position of the first node [m]
    element: float  # length of an element [m]
    number: IntArray  # (2 · nodes,) unknown of the beam's deflection and slope at each node; −1 where it is held

    @property
    def elements(self) -> int:
        """Number of elements."""
        return len(self.number) // 2 - 1


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class FiniteGuideway(Value):
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
    finer : callable, optional
        Set by the same: gives the same road with so many elements in place of each, in every direction.

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
    finer: Callable[[int], FiniteGuideway] | None = None

    def __post_init__(self) -> None:
        """Check the parameters."""
        with checking(self) as check:
            for name, unit in (("mass", "kg"), ("damping", "N s/m"), ("stiffness", "N/m")):
                check.keep(name, _symmetric(check, name, getattr(self, name), unit))
            first, last = check.pair("interval", self.interval, "m", signed=True)
            if not check.faults and not first < last:
                check.refuse("interval", f"must begin before it ends, got {first!r} m to {last!r} m")
            check.not_negative("spacing", self.spacing, "m")
            check.not_negative("width", self.width, "m")
            if self.travels and not self.column > 0:
                check.refuse("column", f"must be positive on a road that travels, got {self.column!r}")
        with checking() as check:
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
        with checking() as check:
            _check_definite(check, self)
            _check_rows(check, self)

    def told(self) -> list[tuple[str, str]]:
        """Tell where it lies and how it is divided, in words."""
        first, last = self.interval
        lines = [
            ("kind", f"finite road, {'which travels along' if self.travels else 'which stands still'}"),
            ("length", f"{last - first:g} m, from {first:g} m to {last:g} m"),
            ("width", f"{self.width:g} m" if self.width else ""),
            ("elements", f"of {self.spacing:g} m" if self.spacing else ""),
            ("unknowns", f"{self.dofs}"),
        ]
        return [(name, words) for name, words in lines if words]

    @property
    def dofs(self) -> int:
        """Number of unknowns."""
        return int(self.mass.shape[0])

    @property
    def attributes(self) -> dict[str, float | int]:
        """What a result says about the road that it was stepped on."""
        return {
            "road_dofs": self.dofs,
            "road_spacing": float(self.spacing),
            "road_first": float(self.interval[0]),
            "road_last": float(self.interval[1]),
            "road_travels": int(self.travels),
        }

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
    # Asymmetry, relative to the largest entry, that is rounding [1e-12 to 1e-6].
    rounding = 1e-9
    try:
        matrix = sparse.csc_array(given if sparse.issparse(given) else real_numbers(given), dtype=float)
    except (TypeError, ValueError):
        check.refuse(name, f"must be a square matrix [{unit}], got {shown(given)}")
        return sparse.csc_array((1, 1))
    if matrix.ndim != 2 or matrix.shape[0] != matrix.shape[1] or not matrix.shape[0]:
        check.refuse(name, f"must be a square matrix [{unit}], got shape {matrix.shape}")
    elif not np.isfinite(matrix.data).all():
        check.refuse(name, f"must be finite throughout [{unit}]")
    elif matrix.nnz and abs(matrix - matrix.T).max() > rounding * abs(matrix).max():
        check.refuse(name, f"must be a symmetric matrix [{unit}]")
    return matrix


def _check_definite(check: Checks, guideway: FiniteGuideway) -> None:
    """Demand a positive definite mass, and damping and stiffness that are at least semidefinite."""
    if not is_definite(guideway.mass):
        check.refuse("mass", "must be positive definite: some motion has no inertia, or a negative one")
        return
    # Share of the mass, scaled to the matrix, with which semidefiniteness is tested [1e-11 to 1e-6].
    little = 1e-8
    heaviest = abs(guideway.mass).max()
    for name, matrix in (("damping", guideway.damping), ("stiffness", guideway.stiffness)):
        largest = abs(matrix).max() if matrix.nnz else 0.0
        # A little of the mass makes a semidefinite matrix definite, and leaves an indefinite one what it is.
        if largest and not is_definite(sparse.csc_array(matrix + little * largest / heaviest * guideway.mass)):
            check.refuse(name, "must be positive semidefinite: some motion would be fed with energy")


def _check_rows(check: Checks, guideway: FiniteGuideway) -> None:
    middle = np.array([0.5 * (guideway.interval[0] + guideway.interval[1])])
    try:
        rows = guideway.rows(middle)
    except (TypeError, ValueError) as error:
        check.refuse("interpolation", f"must give rows for positions [m] and a derivative, but: {error}")
        return
    if rows.shape != (1, guideway.dofs) or not np.isfinite(rows.data).all() or not rows.nnz:
        check.refuse(
            "interpolation", f"must give finite rows of {guideway.dofs} values, one per unknown, got {rows.shape}"
        )

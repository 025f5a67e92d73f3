"""A guideway as wide as it is: a plate on a viscoelastic foundation, by scikit-fem."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sparse

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import checking, shown
from movingfrf._basics.door import instead_of
from movingfrf._basics.progress import Progress, silent
from movingfrf._basics.values import Value
from movingfrf.guideways.beams import EulerBernoulliBeam
from movingfrf.guideways.foundations import ShearLayer, Spring
from movingfrf.guideways.sampled import SampledGuideway
from movingfrf.guideways.track import Track
from movingfrf.stepping.finite_guideway import ELEMENT_ROUNDING, FiniteGuideway
from movingfrf.stepping.finite_track import (
    ENDS,
    absorption,
    bending_length,
    cubic_functions,
    require_fine,
    require_stretch,
)
from movingfrf.stepping.impulse import CANCELLING, PINNED, moving_impulse_response
from movingfrf.vehicles.vehicle import Vehicle, require_vehicle

# Unknowns at a node: w, ∂w/∂x, ∂w/∂y, ∂²w/∂x∂y.
NODAL = 4


class Stiffnesses(NamedTuple):
    """Bending and twisting of an orthotropic plate [N m]: ½∫ Dx wxx² + 2 D1 wxx wyy + Dy wyy² + 4 Dk wxy²."""

    along: float
    across: float
    coupling: float
    twist: float


@dataclass(frozen=True, slots=True, eq=False)
class PlateRows(Value):
    """Interpolation on rectangles of cubic functions along times cubic functions across (Bogner, Fox, Schmit)."""

    first: FloatArray  # (2,) position of the first node, along and across [m]
    element: FloatArray  # (2,) length and width of an element [m]
    count: tuple[int, int]  # elements along and across
    number: FloatArray  # (nodes along, nodes across, 4) unknown; −1 where it is held
    dofs: int

    def __call__(self, positions: FloatArray, derivative: int = 0, across: FloatArray | float = 0.0, /) -> Any:
        """Rows of shape (position, dof)."""
        elements, functions = [], []
        beside = np.broadcast_to(np.asarray(across, float), positions.shape)
        for axis, (place, order) in enumerate(((positions, derivative), (beside, 0))):
            at = (place - self.first[axis]) / self.element[axis]
            element = np.clip(np.floor(at).astype(int), 0, self.count[axis] - 1)
            elements.append(element)
            # (position, node, value or slope)
            values = cubic_functions(at - element, float(self.element[axis]), order)
            functions.append(values.reshape(-1, 2, 2))
        along, aside = functions
        products = np.einsum("pis,pjt->pijts", along, aside).reshape(len(positions), 4 * NODAL)
        nodes_along = elements[0][:, None, None, None] + np.arange(2)[:, None, None]
        nodes_across = elements[1][:, None, None, None] + np.arange(2)[:, None]
        places = (
            self.number[nodes_along, nodes_across, np.arange(NODAL)].reshape(len(positions), 4 * NODAL).astype(int)
        )
        products[places < 0] = 0.0
        rows = np.broadcast_to(np.arange(len(positions))[:, None], places.shape)
        shape = (len(positions), self.dofs)
        return sparse.csr_array((products.ravel(), (rows.ravel(), np.maximum(places, 0).ravel())), shape=shape)


def finite_plate(
    track: Track,
    *,
    width: float,
    first: float,
    last: float,
    element: float = 0.5,
    across: int = 6,
    poisson: float = 0.35,
    transverse: float = 1.0,
    ends: str | tuple[str, str] = "absorbing",
    absorbing: float | None = None,
    band: float = 70.0,
    travels: bool = False,
) -> FiniteGuideway:
    """Spread a track over its width: a plate with free edges on a foundation, by finite elements.

    A thin (Kirchhoff) plate that carries, mass and foundation per area, what the track carries per length, and that
    bends along the road as the track's beam does as long as its section may warp freely: with B the beam's bending
    stiffness per width, D_x = B/(1 − ν²). Across it is `transverse` times as stiff, with Huber's twisting stiffness
    of an orthotropic plate: D_y = s D_x, D_1 = ν √s D_x, 2 D_k = (1 − ν) √s D_x. With s = 1 it is an isotropic
    plate; with s → ∞ its section stays straight, and it deflects as the track does.

    Parameters
    ----------
    track : Track
        An Euler–Bernoulli beam on springs or a shear layer: stiffness, mass and damping of the whole width.
    width : float
        Width [m].
    first : float
        Where the stretch begins [m].
    last : float
        Where the stretch ends [m].
    element : float
        Length of an element along the road [m], at most: a whole number of them fills the stretch.
    across : int
        Number of elements across.
    poisson : float
        Poisson's ratio ν, from 0 to below 1/2; of an orthotropic plate the geometric mean of the two.
    transverse : float
        Bending stiffness across over that along, a ratio.
    ends : str or tuple of str
        "pinned", "clamped", "guided", "free" or "absorbing", one for both or one for each, as for `finite_track`;
        the edges along the road are free.
    absorbing : float, optional
        Length of the stretch that absorbs at each absorbing end [m]; None: 15 m, or a third of a short road.
    band : float
        Highest frequency whose waves the elements shall resolve [Hz].
    travels : bool
        Whether the stretch accompanies the vehicle: positions are then those seen from its reference point.

    Returns
    -------
    FiniteGuideway
        With a width: `Contact.across` decides where a contact touches it.

    Raises
    ------
    ValueError
        If the track has a Timoshenko beam or layers of mass, or a value is impossible.

    References
    ----------
    S. P. Timoshenko, S. Woinowsky-Krieger, Theory of Plates and Shells, 1959, chapter 11; F. K. Bogner, R. L. Fox,
    L. A. Schmit, Proc. Conf. Matrix Methods in Struct. Mech., 1965.

    Examples
    --------
    >>> import movingfrf as mf
    >>> road = mf.track(mf.EulerBernoulliBeam(bending_stiffness=4.719e7, mass=2135.7),
    ...                 mf.Spring(stiffness=2.4e7, damping=9.0e4))
    >>> plate = finite_plate(road, width=3.0, first=-10.0, last=10.0, element=0.5, across=3, ends="pinned")
    >>> plate.dofs, plate.width
    (640, 3.0)
    """
    with checking() as check:
        usable = isinstance(track, Track) and isinstance(track.beam, EulerBernoulliBeam)
        if not usable or not isinstance(track.foundation, (Spring, ShearLayer)):
            check.refuse(
                "track",
                "must be an Euler–Bernoulli beam on springs or a shear layer to be spread over its width, got "
                f"{shown(track)}{instead_of('track', track)}",
            )
        width = check.positive("width", width, "m")
        count_across = check.whole("across", across, least=1)
        poisson = check.not_negative("poisson", poisson, "1")
        transverse = check.positive("transverse", transverse, "1")
        if not check.faults and not poisson < 0.5:
            check.refuse("poisson", f"must be less than 0.5, got {poisson!r}")
        first, last = check.finite("first", first, "m"), check.finite("last", last, "m")
        element = check.positive("element", element, "m")
        both, length = require_stretch(check, (first, last), element, ends, absorbing, travels)
        band = check.not_negative("band", band, "Hz")
    assert isinstance(track.beam, EulerBernoulliBeam)
    assert isinstance(track.foundation, (Spring, ShearLayer))
    with checking() as check:
        require_fine(check, track, element, band)
        if width / count_across > bending_length(track):
            check.refuse(
                "across",
                f"must be at least {int(np.ceil(width / bending_length(track)))}, so that an element is no wider "
                f"than the length {bending_length(track):.4g} m over which the track bends, got {across!r}",
            )
    count = (int(np.ceil((last - first) / element - ELEMENT_ROUNDING)), count_across)
    begin, size = np.array([first, -0.5 * width]), np.array([last - first, width]) / count
    stiffnesses = _stiffnesses(track.beam.bending_stiffness / width, poisson, transverse)

    def dashpots(positions: FloatArray) -> FloatArray:
        return absorption(track, (first, last), both, length, positions) / width

    mass, damping, stiffness = _assembled(track, width, (begin, size, count), stiffnesses, dashpots)
    held = np.zeros((count[0] + 1, count[1] + 1, NODAL), bool)
    # A held deflection holds the first unknown of a node and the third, a held slope along the guideway the others.
    by_deflection = np.array([True, False, True, False])
    for node, end in ((0, both[0]), (-1, both[1])):
        held[node] = np.where(by_deflection, ENDS[end].deflection, ENDS[end].slope)
    kept = np.flatnonzero(~held.ravel())
    number = np.full(held.shape, -1)
    number.ravel()[kept] = np.arange(kept.size)
    return FiniteGuideway(
        mass=mass[kept][:, kept],
        damping=damping[kept][:, kept],
        stiffness=stiffness[kept][:, kept],
        interpolation=PlateRows(begin, size, count, number, kept.size),
        interval=(float(first), float(last)),
        spacing=float(size[0]),
        width=float(width),
        travels=travels,
        column=NODAL * (count[1] + 1),
        finer=partial(
            _finer,
            float(size[0]),
            count_across,
            track=track,
            width=width,
            first=first,
            last=last,
            poisson=poisson,
            transverse=transverse,
            ends=both,
            absorbing=length,
            band=band,
            travels=travels,
        ),
    )


def _finer(element: float, across: int, parts: int, **others: Any) -> FiniteGuideway:
    return finite_plate(element=element / parts, across=across * parts, **others)


def struck_plate(
    track: Track,
    *,
    width: float,
    speed: float,
    vehicle: Vehicle,
    across: int = 6,
    poisson: float = 0.35,
    transverse: float = 1.0,
    plain: bool = False,
    band: float = 70.0,
    progress: Progress = silent,
) -> SampledGuideway:
    """Find the moving FRF between all contacts of a vehicle from a finite-element model of 40 m of a plate.

    The plate is stepped in NumPy: ten seconds or more; `plain` with three elements across takes two.

    Parameters
    ----------
    track : Track
        The track, spread over its width as by `finite_plate`.
    width : float
        Width [m].
    speed : float
        Speed [m/s].
    vehicle : Vehicle
        The vehicle: where its contacts stand, along and across.
    across : int
        Number of elements across.
    poisson : float
        Poisson's ratio, as for `finite_plate` (a ratio).
    transverse : float
        Bending stiffness across over that along, a ratio, as for `finite_plate`.
    plain : bool
        Whether to do as the paper does, as for `struck_track`.
    band : float
        Highest frequency that is wanted [Hz].
    progress : callable
        Called with the name of a stage and the fraction of it that is done.

    Returns
    -------
    SampledGuideway
        For this speed and these contacts.

    Raises
    ------
    ValueError
        If 40 m are too short, the elements do not suit the track, a contact stands beside the road, or a value is
        impossible.

    Warns
    -----
    ValidityWarning
        As `moving_impulse_response`.
    """
    require_vehicle(vehicle)
    recipe = PINNED if plain else CANCELLING
    half = 0.5 * recipe.length
    guideways = [
        finite_plate(
            track,
            width=width,
            first=-half,
            last=half,
            element=recipe.element,
            across=across,
            poisson=poisson,
            transverse=transverse,
            ends=ends,
            band=band,
        )
        for ends in recipe.ends
    ]
    at, beside = vehicle.positions, vehicle.across
    pairs = np.stack(np.broadcast_arrays(at[:, None] - at, beside[:, None] - beside, beside), axis=-1)
    wanted = np.unique(np.round(pairs.reshape(-1, 3), 9), axis=0)
    # Left and right are alike: what is struck on the right is struck on the left, seen in a mirror.
    mirrored = (wanted[:, 2] < 0) | ((wanted[:, 2] == 0) & (wanted[:, 1] < 0))
    on_the_left, back = np.unique(
        np.where(mirrored[:, None], wanted * [1.0, -1.0, -1.0], wanted) + 0.0, axis=0, return_inverse=True
    )
    ahead, offset, source = on_the_left.T
    struck = moving_impulse_response(
        guideways,
        speed=speed,
        offsets=ahead,
        across=offset,
        strike=0.0,
        strike_across=source,
        time_step=recipe.time_step,
        band=band,
        critical_speed=track.critical_speed,
        scheme=recipe.scheme,
        progress=progress,
    )
    ahead, offset, source = wanted.T
    response = struck.samples[:, back.ravel()]
    return replace(struck, response=response, offsets=ahead, across=offset, source_across=source)


def _stiffnesses(bending: float, poisson: float, transverse: float) -> Stiffnesses:
    along = bending / (1 - poisson**2)
    mean = np.sqrt(transverse) * along
    return Stiffnesses(along, transverse * along, poisson * mean, 0.5 * (1 - poisson) * mean)


def _assembled(
    track: Track,
    width: float,
    mesh: tuple[FloatArray, FloatArray, tuple[int, int]],
    stiffnesses: Stiffnesses,
    dashpots: Callable[[FloatArray], FloatArray],
) -> tuple[sparse.csc_array, sparse.csc_array, sparse.csc_array]:
    """Mass, damping and stiffness; unknowns node by node across, then along."""
    from skfem import Basis, BilinearForm, ElementQuadBFS, MeshQuad
    from skfem.helpers import dd, dot, grad

    @BilinearForm  # type: ignore[untyped-decorator]
    def bending(u: Any, v: Any, _: Any) -> Any:
        along, across, coupling, twist = stiffnesses
        (uxx, uxy), (_, uyy) = dd(u)
        (vxx, vxy), (_, vyy) = dd(v)
        return along * uxx * vxx + across * uyy * vyy + coupling * (uxx * vyy + uyy * vxx) + 4 * twist * uxy * vxy

    @BilinearForm  # type: ignore[untyped-decorator]
    def carrying(u: Any, v: Any, _: Any) -> Any:
        return u * v

    @BilinearForm  # type: ignore[untyped-decorator]
    def shearing(u: Any, v: Any, _: Any) -> Any:
        return dot(grad(u), grad(v))

    @BilinearForm  # type: ignore[untyped-decorator]
    def absorbing(u: Any, v: Any, w: Any) -> Any:
        return dashpots(w.x[0]) * u * v

    begin, size, count = mesh
    lines = [begin[axis] + size[axis] * np.arange(count[axis] + 1) for axis in range(2)]
    basis = Basis(MeshQuad.init_tensor(*lines), ElementQuadBFS(), intorder=6)
    nodes = np.round((basis.mesh.p - begin[:, None]) / size[:, None]).astype(int)
    places = nodes[0] * (count[1] + 1) + nodes[1]
    order = np.empty(basis.N, int)
    order[NODAL * places + np.arange(NODAL)[:, None]] = basis.nodal_dofs

    def of(form: Any) -> sparse.csc_array:
        matrix = sparse.csr_array(form.assemble(basis))
        return sparse.csc_array(matrix[order][:, order])

    beam, foundation = track.beam, track.foundation
    assert isinstance(beam, EulerBernoulliBeam)
    assert isinstance(foundation, (Spring, ShearLayer))
    bends, carries = of(bending), of(carrying)
    stiffness = bends + foundation.stiffness / width * carries
    if isinstance(foundation, ShearLayer):
        stiffness += foundation.shear_stiffness / width * of(shearing)
    damping = foundation.damping / width * carries + of(absorbing)
    damping += beam.bending_damping / beam.bending_stiffness * bends
    return beam.mass / width * carries, sparse.csc_array(damping), sparse.csc_array(stiffness)

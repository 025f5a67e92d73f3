"""The moving impulse response of a finite guideway: strike it, and travel along while it rings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from movingfrf._basics.arrays import FloatArray, require_memory
from movingfrf._basics.checks import checking
from movingfrf._basics.door import given, instead_of
from movingfrf._basics.progress import Progress, silent
from movingfrf.guideways.sampled import SampledGuideway
from movingfrf.guideways.track import Track
from movingfrf.stepping.finite_guideway import FiniteGuideway
from movingfrf.stepping.finite_track import finite_track
from movingfrf.stepping.marching import March
from movingfrf.stepping.requirements import require_across, require_stable_scheme
from movingfrf.stepping.schemes import Scheme, scheme_named
from movingfrf.stepping.tie import no_vehicle


@dataclass(frozen=True, slots=True, kw_only=True)
class Ringing:
    """What tunes the record of a response; in brackets, between what each number is safe."""

    # It is recorded in stretches of this length [s], ...
    stretch: float = 0.1  # [0.05 to 0.5]
    # ... until one stays below this share of the largest value, ...
    faded: float = 1e-6  # [1e-8 to 1e-5]
    # ... and for no longer than this unless asked for [s].
    longest: float = 4.0  # [a convention]


@dataclass(frozen=True, slots=True, kw_only=True)
class Validity:
    """What about a response is worth a warning; in brackets, between what each number is safe."""

    # What is left of a wave that comes back from the ends of the guideway, relative to the largest moving FRF, and
    # from where on that is no estimate any more; and the error of the step at the highest frequency of the band,
    # (ω Δt)²/12.
    reflected: float = 1e-3  # [a convention]
    untold: float = 0.3  # [0.1 to 1]
    stretched: float = 1e-2  # [a convention]
    # Share of the guideway that counts as each of its ends.
    outer: float = 0.1  # [0.05 to 0.1]
    # Frequencies at which reflections are estimated, and points at each end of the guideway.
    frequencies: int = 40  # [20 to 200]
    points: int = 8  # [4 to 32]


RINGING, VALIDITY = Ringing(), Validity()


class Recipe(NamedTuple):
    """How to strike a track: its length and elements [m], the step [s], the scheme, and each guideway's ends."""

    length: float
    element: float
    time_step: float
    scheme: str
    ends: tuple[tuple[str, str], ...]


# The paper's guideway; and four of the same length, with either of two ends at both, whose end reflections cancel.
# The scheme of the latter damps vibrations of single elements, which the impulse excites and average acceleration
# keeps alive.
PINNED = Recipe(40.0, 0.5, 1e-3, "average_acceleration", (("pinned", "pinned"),))
CANCELLING = Recipe(
    40.0,
    0.25,
    2.5e-4,
    "generalised_alpha",
    (("pinned", "pinned"), ("pinned", "guided"), ("guided", "pinned"), ("guided", "guided")),
)


def moving_impulse_response(
    roads: FiniteGuideway | Sequence[FiniteGuideway],
    *,
    speed: float,
    offsets: ArrayLike,
    strike: float,
    across: ArrayLike = 0.0,
    strike_across: ArrayLike = 0.0,
    duration: float | None = None,
    time_step: float = 2.5e-4,
    band: float = 70.0,
    critical_speed: float = np.inf,
    scheme: str | Scheme = "average_acceleration",
    compiled: bool | None = None,
    progress: Progress = silent,
) -> SampledGuideway:
    """Strike a finite road and record what points see that travel on from there.

    The impulse gives the road the velocity M⁻¹ N(x)ᵀ; then it rings freely.

    Parameters
    ----------
    roads : FiniteGuideway or sequence of FiniteGuideway
        The road; of several the average is taken. Pinned and guided ends reflect every wave with opposite signs: in
        the average of four roads with either at each end all cancels that has met an end an odd number of times
        (W. D. Smith, J. Comput. Phys. 15, 1974).
    speed : float
        Speed of the points [m/s].
    offsets : array_like, shape (offset,)
        Where the points start, ahead of the impulse [m].
    strike : float
        Where the impulse strikes [m]; at a node a mesh is most accurate.
    across, strike_across : array_like, broadcastable to (offset,)
        On a road with a width: place of each point across, less that of the impulse, and the impulse's own, left of
        the centre line [m]. The road is struck once at each place.
    duration : float, optional
        Length of the record [s]; None: until it has died away, as long as every point stays on the road and at
        most 4 s.
    time_step : float
        Step of the record and of the stepping [s].
    band : float
        Highest frequency that the record shall hold [Hz].
    critical_speed : float
        Critical speed of the road [m/s], if it is known.
    scheme : str or Scheme
        Time-stepping scheme, by name or as the row of its numbers.
    compiled : bool, optional
        Whether to use the compiled loops; None: where they apply and numba is installed.
    progress : callable
        Called with the name of a stage and the fraction of it that is done.

    Returns
    -------
    SampledGuideway
        A guideway that `simulate` and `moving_loads` accept like any other, at this speed and these offsets.

    Raises
    ------
    ValueError
        If the road is too short for speed and duration, the step too long for the band, or a value is impossible.
    SolveError
        If the road's matrices are inconsistent.

    Warns
    -----
    ValidityWarning
        If the response has not died away at the end, waves come back from the ends of the road, or the step is
        long for the band.

    Examples
    --------
    >>> import movingfrf as mf
    >>> track = mf.track(mf.EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9),
    ...                  mf.Spring(stiffness=8.0e6, damping=3.0e4))
    >>> road = mf.finite_track(track, first=-40.0, last=40.0, element=0.5)
    >>> struck = moving_impulse_response(road, speed=10.0, offsets=[0.0], strike=0.0, time_step=5e-4, band=30.0)
    >>> abs(struck.moving_frf(0.0, 10.0, [0.0]) / track.moving_frf(0.0, 10.0, [0.0])).round(2).tolist()
    [1.0]
    """
    several: list[Any] = list(roads) if isinstance(roads, (list, tuple)) else [roads]
    with checking() as check:
        at = check.array("offsets", offsets, "m", (None,))
        beside, sources = (
            check.spread(name, value, "m", at.shape)
            for name, value in (("across", across), ("strike_across", strike_across))
        )
        speed = check.finite("speed", speed, "m/s")
        strike = check.finite("strike", strike, "m")
        time_step = check.positive("time_step", time_step, "s")
        band = check.positive("band", band, "Hz")
        if duration is not None:
            duration = check.positive("duration", duration, "s")
        row = scheme_named(check, scheme)
        if not several or not all(
            isinstance(guideway, FiniteGuideway) and not guideway.travels for guideway in several
        ):
            other = next((one for one in several if not isinstance(one, FiniteGuideway)), None)
            hint = "" if other is None else f", got {given(other)}{instead_of('finite road', other)}"
            check.refuse("roads", f"must be one or more roads that stand still{hint}")
        if not check.faults and not at.size:
            check.refuse("offsets", "must hold at least one offset [m]")
        if not check.faults and band * time_step > 0.25:
            check.refuse(
                "time_step", f"must be at most {0.25 / band:.3g} s to hold {band:g} Hz, got {time_step!r} s"
            )
    first, last = (
        max(guideway.interval[0] for guideway in several),
        min(guideway.interval[1] for guideway in several),
    )
    starts = strike + np.append(at, 0.0)
    room = (last - starts.max() if speed > 0 else starts.min() - first) / abs(speed) if speed else np.inf
    wide = any(guideway.width for guideway in several)
    with checking() as check:
        length = min(room, RINGING.longest) if duration is None else duration
        if starts.min() < first or starts.max() > last or length > room * (1 + 1e-9) or length < 2 * time_step:
            check.refuse(
                "roads",
                f"must be long enough: points that start from {starts.min():.6g} m to {starts.max():.6g} m at "
                f"{speed:g} m/s stay on the road, {first:.6g} m to {last:.6g} m, for {max(room, 0.0):.4g} s"
                + ("" if duration is None else f", not for the duration of {duration:g} s"),
            )
        if not wide and (beside.any() or sources.any()):
            check.refuse("across", "and strike_across must be 0 m on a road whose section moves as one")
        for guideway in several:
            require_across(check, guideway, np.concatenate([sources, sources + beside]))
            require_stable_scheme(check, guideway, row, time_step)
    steps = int(length / time_step * (1 + 1e-12))
    require_memory(
        32.0 * steps * at.size * len(several), f"an impulse response of {length:g} s in steps of {time_step:g} s"
    )
    pieces: dict[float, FloatArray] = {}
    for source in np.unique(sources).tolist():
        seen = sources == source
        blow = Blow(strike, source, speed, strike + at[seen], (sources + beside)[seen])
        records: list[FloatArray] = []
        for guideway in several:
            # What the first guideway has forgotten the others need not remember.
            fading = RINGING.faded if duration is None and not pieces and not records else 0.0
            records.append(_ringing(guideway, row, time_step, blow, steps, compiled, progress, fading=fading))
            steps = len(records[0]) - 1
        pieces[source] = np.mean(records, axis=0)
    response = np.empty((steps + 1, at.size))
    for source, piece in pieces.items():
        response[:, sources == source] = piece
    return SampledGuideway(
        response=response,
        time_step=time_step,
        offsets=at,
        speed=float(speed),
        across=beside if wide else None,
        source_across=sources if wide else None,
        critical_speed=critical_speed,
        stepped=True,
        remarks=[
            *_stretched(band, time_step),
            *_reflected(several, row, time_step, strike, steps, band, compiled, progress),
        ],
    )


def struck_track(
    track: Track,
    *,
    speed: float,
    offsets: ArrayLike,
    plain: bool = False,
    time_step: float | None = None,
    band: float = 70.0,
    compiled: bool | None = None,
    progress: Progress = silent,
) -> SampledGuideway:
    """Find the moving FRF of a track from a finite-element model of 40 m of it.

    Parameters
    ----------
    track : Track
        The track.
    speed : float
        Speed [m/s].
    offsets : array_like, shape (offset,)
        Receiver minus source [m].
    plain : bool
        Whether to do as the paper does: simply supported ends, elements of 0.5 m, steps of 1 ms. Otherwise four
        roads whose end reflections cancel are averaged, with elements of 0.25 m and steps of 0.25 ms.
    time_step : float, optional
        Another step [s].
    band : float
        Highest frequency that is wanted [Hz].
    compiled : bool, optional
        Whether to use the compiled loops; None: where they apply and numba is installed.
    progress : callable
        Called with the name of a stage and the fraction of it that is done.

    Returns
    -------
    SampledGuideway
        At this speed and these offsets.

    Raises
    ------
    ValueError
        If 40 m are too short, the elements do not suit the track, or a value is impossible.

    Warns
    -----
    ValidityWarning
        As `moving_impulse_response`.
    """
    recipe = PINNED if plain else CANCELLING
    half = 0.5 * recipe.length
    guideways = [
        finite_track(track, first=-half, last=half, element=recipe.element, ends=ends, band=band)
        for ends in recipe.ends
    ]
    return moving_impulse_response(
        guideways,
        speed=speed,
        offsets=offsets,
        strike=0.0,
        time_step=recipe.time_step if time_step is None else time_step,
        band=band,
        critical_speed=track.critical_speed,
        scheme=recipe.scheme,
        compiled=compiled,
        progress=progress,
    )


class Blow(NamedTuple):
    """Where the guideway is struck, and the points that travel on from there and watch."""

    at: float  # [m]
    across: float  # [m]
    speed: float  # [m/s]
    points: FloatArray  # (point,) [m]
    points_across: ArrayLike  # (point,) [m]


def _ringing(
    guideway: FiniteGuideway,
    scheme: Scheme,
    time_step: float,
    blow: Blow,
    steps: int,
    compiled: bool | None,
    progress: Progress,
    *,
    fading: float = 0.0,
) -> FloatArray:
    """Deflection at points that travel, after a unit impulse, shape (steps + 1, point); shorter if it dies away."""
    march = March(
        guideway=guideway,
        scheme=scheme,
        time_step=time_step,
        speed=blow.speed,
        contacts=np.empty(0),
        observers=blow.points,
        observers_across=blow.points_across,
        tie=no_vehicle(0),
        compiled=compiled,
    )
    state = march.at_rest()
    state.guideway[1] = march.mass_solver.solve(guideway.rows(np.array([blow.at]), 0, blow.across).toarray()[0])
    march.released(state, np.zeros(guideway.dofs))
    stretch = max(int(RINGING.stretch / time_step), 1)
    pieces: list[FloatArray] = [np.zeros((1, blow.points.size))]
    done, largest = 0, 0.0
    while done < steps:
        count = min(stretch, steps - done)
        nothing = np.zeros((count + 1, 0))
        piece = march.run(
            count,
            state,
            roughness=nothing,
            rate=nothing,
            loads=nothing[:1],
            origin=done,
            stage="impulse",
            progress=progress,
        ).observed[1:]
        pieces.append(piece)
        done += count
        lately = float(np.abs(piece).max())
        largest = max(largest, lately)
        if lately <= fading * largest:
            break
    return np.concatenate(pieces)


def _stretched(band: float, time_step: float) -> list[tuple[str, str]]:
    error = (2 * np.pi * band * time_step) ** 2 / 12
    if error <= VALIDITY.stretched:
        return []
    return [
        (
            "struck_step",
            f"the time step of {time_step:g} s is long for {band:g} Hz: vibrations there are slowed by "
            f"{error:.1%}; {np.sqrt(12 * VALIDITY.stretched) / (2 * np.pi * band):.2g} s would do",
        )
    ]


def _reflected(
    guideways: Sequence[FiniteGuideway],
    scheme: Scheme,
    time_step: float,
    strike: float,
    steps: int,
    band: float,
    compiled: bool | None,
    progress: Progress,
) -> list[tuple[str, str]]:
    """Estimate what comes back from the ends.

    A wave that is e times as high at an end as where it began is e² times as high when it is back, e⁴ times when
    it has been to both ends, e⁸ times when it has been there twice: what remains of one, two or four guideways.
    What is seen at an end holds the reflection as well; where the end reflects, the square of what passes half-way
    there tells more.
    """
    guideway = guideways[0]
    first, last = guideway.interval
    outer = VALIDITY.outer * (last - first)
    stretches = ((first, first + outer), (last - outer, last))
    ends = np.concatenate([np.linspace(*stretch, VALIDITY.points) for stretch in stretches])
    middles = 0.5 * (strike + np.array([first, last]))
    points = np.concatenate([[strike], middles, ends])
    # On the centre line, where no roll adds to what the blow itself brings about.
    blow = Blow(strike, 0.0, 0.0, points, 0.0)
    records = _ringing(guideway, scheme, time_step, blow, steps, compiled, progress)
    omega = 2 * np.pi * np.linspace(0.0, band, VALIDITY.frequencies)
    frf = np.abs(np.exp(-1j * time_step * omega[:, None] * np.arange(len(records))) @ records)
    share = np.minimum(frf[:, 3:].max(axis=1), frf[:, 1:3].max(axis=1) ** 2 / frf[:, 0]) / frf[:, 0]
    back = share ** (2 * len(guideways)) * frf[:, 0] / frf[:, 0].max()
    worst = int(back.argmax())
    if back[worst] <= VALIDITY.reflected:
        return []
    size = (
        f"about {back[worst]:.1e} of the largest moving FRF"
        if back[worst] < VALIDITY.untold
        else "hardly weaker than they set out: the road is far too short, the moving FRF not to be relied on"
    )
    return [
        (
            "reflections",
            f"waves come back from the ends of the road, at {omega[worst] / (2 * np.pi):.3g} Hz {size}; a longer "
            "road, absorbing ends, or the average of roads with pinned and guided ends reflects less",
        )
    ]

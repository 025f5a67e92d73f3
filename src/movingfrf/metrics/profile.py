"""What a measured profile is like: its stations, spectrum, ISO 8608 class, roughness index, and what looks odd."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from movingfrf._basics.arrays import FloatArray, finite
from movingfrf._basics.checks import checking, option
from movingfrf._basics.progress import Progress, silent
from movingfrf._basics.values import Value, brief
from movingfrf._basics.welch import Spectra
from movingfrf._basics.wording import evenly_spread, named_paths, place, plain, told_apart
from movingfrf.metrics.iri import PROCEDURE, coarse_for_index, index_between, shortest_segment, straight_index
from movingfrf.metrics.spectra import path_spectra
from movingfrf.roughness.fitting import SMOOTHING_EDGES, IsoFit, fit_iso
from movingfrf.roughness.profile import Profile, require_profile
from movingfrf.roughness.sentinels import Sentinel, sentinels
from movingfrf.roughness.spectra.iso import CLASS_CENTRES
from movingfrf.roughness.steps.resampled import resampled
from movingfrf.roughness.steps.selected import selected
from movingfrf.roughness.straight import mean_slope, resolution, straight


@dataclass(frozen=True, slots=True, kw_only=True)
class Oddities:
    """From what on a profile looks odd: conventions, all of them."""

    spike: float = 5e-3  # distance of an elevation from the middle of its neighbours [m]
    unusual: float = 15.0  # the same over the usual one
    level: float = 5.0  # length of a stretch without any change [m]
    level_stations: int = 20  # stations of it
    most_stretches: int = 5  # of level stretches the longest so many are named
    # Rougher than roads are. A smooth road whose centimetres are taken for metres lies beyond both.
    density: float = 2 * CLASS_CENTRES["G"]  # at 0.1 cycle/m [m³], where class H begins
    index: float = 200.0  # [mm/m]


ODDITIES = Oddities()


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class PathDescription(Value):
    """One path of a profile.

    Parameters
    ----------
    number : int
        Number of the path.
    across : float or None
        Lateral position [m], left positive, where it is known.
    lowest, highest : float
        Elevations between which it lies [m].
    slope : float
        Mean slope, of the straight line that fits best [m/m], positive uphill.
    resolution : float
        What all elevations are a multiple of [m]; 0 if nothing was found.
    fit : IsoFit
        Fitted spectrum: roughness, waviness, class and range, or why there is none.
    index : float
        International roughness index of the whole path [mm/m], of pieces by their lengths; nan where it has none.
    indices : dict of float to ndarray
        Length of the segments [m] → index of each [mm/m]; nan where a segment touches a gap.
    spatial_frequency, density : ndarray
        Estimated spectrum [cycle/m] and [m³].
    """

    number: int
    across: float | None
    lowest: float
    highest: float
    slope: float
    resolution: float
    fit: IsoFit
    index: float
    indices: dict[float, FloatArray]
    spatial_frequency: FloatArray
    density: FloatArray


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class ProfileDescription(Value):
    """A profile, described.

    Parameters
    ----------
    profile : Profile
        The profile itself; of pieces, all stations that there are.
    pieces : tuple of Profile
        The pieces between gaps; the profile alone where it has none.
    edges : dict of float to ndarray
        Length of the segments [m] → where they begin and end [m], shape (segment + 1,): at multiples of the length,
        the first and the last segment being what is left at either end.
    shortest_step, longest_step : float
        Smallest and largest distance between stations [m].
    used_step : float
        Step of the stations that spectra and indices were taken from [m].
    paths : tuple of PathDescription
        The paths; of equal ones the first, and some of them where there are many.
    coherence : tuple of ndarray, or None
        Spatial frequency [cycle/m] and magnitude-squared coherence, dimensionless, between the first and the last
        path described; None with one path.
    findings : tuple of str
        What looks odd.
    """

    profile: Profile
    pieces: tuple[Profile, ...]
    edges: dict[float, FloatArray]
    shortest_step: float
    longest_step: float
    used_step: float
    paths: tuple[PathDescription, ...]
    coherence: tuple[FloatArray, FloatArray] | None
    findings: tuple[str, ...]

    def told(self) -> list[tuple[str, str]]:
        """Tell the profile, and of each path its class and roughness index, in words."""
        paths = [
            (
                f"path {path.number}",
                f"ISO 8608 class {path.fit.road_class or 'none'}, IRI "
                + ("none" if np.isnan(path.index) else f"{path.index:.3g} mm/m"),
            )
            for path in self.paths
        ]
        return [*self.profile.told(), *paths, ("findings", brief("; ".join(self.findings)) or "none")]

    @property
    def length(self) -> float:
        """Distance from the first station to the last [m], gaps included."""
        return float(np.ptp(self.profile.stations))

    @property
    def scope(self) -> str:
        """How many of the paths are described, in words; empty if all of them."""
        described, paths = len(self.paths), self.profile.paths
        return f"{described} of {paths} paths are described" if described < paths else ""


def describe_profile(profile: Profile | Sequence[Profile], *, progress: Progress = silent) -> ProfileDescription:
    """Describe a profile.

    Parameters
    ----------
    profile : Profile or sequence of Profile
        The profile, or its pieces between gaps in order, as `read_pieces` reads them. Of equal paths the first is
        described, and of many paths six. Where stations are uneven, spectra, coherence and the roughness index are
        taken from the cubic spline at the median step. Of pieces, spectra and coherence are those of the longest.
    progress : callable
        Called with the name of a stage and the fraction of it that is done.

    Returns
    -------
    ProfileDescription
        Extent, spectrum, class and roughness index of each path, coherence, and what looks odd.

    Raises
    ------
    ValueError
        If pieces overlap or have different numbers of paths.

    Examples
    --------
    >>> import movingfrf as mf
    >>> road = mf.realise(mf.IsoRoad.of_class("B"), length=1000.0, seed=1)
    >>> describe_profile(road).paths[0].fit.road_class
    'B'
    """
    pieces = tuple(profile) if isinstance(profile, (list, tuple)) else (profile,)
    for piece in pieces:
        require_profile(piece)
    whole = _together(pieces)
    steps = np.concatenate([np.diff(piece.stations) for piece in pieces])
    alike = whole.alike
    findings = [
        f"{_sentence(named_paths(same))} are equal: path {same[0]} is described for all."
        for same in alike
        if len(same) > 1
    ]
    numbers = [alike[n][0] for n in evenly_spread(len(alike))]
    described = [selected(piece, paths=numbers) if len(numbers) < whole.paths else piece for piece in pieces]
    longest = int(np.argmax([np.ptp(piece.stations) for piece in pieces]))
    uneven = [piece.even_step() is None for piece in described]
    step = described[longest].even_step() or float(np.median(np.diff(pieces[longest].stations)))
    if any(uneven):
        progress("even stations", 0.0)
        described = [
            resampled(piece, step=step) if odd else piece for piece, odd in zip(described, uneven, strict=True)
        ]
        shortest, furthest = told_apart(steps.min(), steps.max(), digits=4)
        findings.append(
            f"Stations are uneven, {shortest} to {furthest} m apart: spectra and indices are taken from the cubic "
            f"spline at steps of {step:.4g} m."
        )
    if len(pieces) > 1:
        findings.append(_parted(pieces, longest))
    stations, columns = whole.stations, whole.columns[:, numbers]
    # Where markers of missing values stand, nothing that is computed means anything.
    marked = np.array([bool(sentinels(column)) for column in columns.T])
    edges = _edges(whole, step)
    indices, reason = _indices(described, longest, edges, progress)
    for found in indices.values():
        found[:, marked] = np.nan
    progress("spectra", 0.0)
    # By the profile's own numbers: what a spline makes of them between stations has not their resolution.
    rough = ~straight(stations, columns) & ~marked
    estimated = path_spectra(described[longest].columns, step, rough)
    slopes = mean_slope(stations, columns)
    if reason:
        findings.append(reason)
    elif indices and not marked.any():
        findings += [f"{_sentence(finding.message)}." for finding in coarse_for_index(described[longest])]
    findings += [_missing(each) for each in sentinels(whole.columns)]
    paths = []
    for n, number in enumerate(numbers):
        progress("paths", n / len(numbers))
        path = _path(described[longest], n, number, columns[:, n], float(slopes[n]), indices, estimated)
        if marked[n]:
            path = replace(path, fit=path.fit._replace(reason="values that stand for missing ones are no road"))
        paths.append(path)
        for piece in pieces if not marked[n] else ():
            of = f" on path {number}" if len(alike) > 1 else ""
            findings += _oddities(piece.stations, piece.columns[:, number], of)
    findings += _doubts(paths)
    return ProfileDescription(
        profile=whole,
        pieces=pieces,
        edges={span: at for span, at in edges.items() if span in indices},
        shortest_step=float(steps.min()),
        longest_step=float(steps.max()),
        used_step=step,
        paths=tuple(paths),
        coherence=_coherence(estimated) if described[longest].paths > 1 else None,
        findings=tuple(findings),
    )


def _together(pieces: Sequence[Profile]) -> Profile:
    """Put all stations of pieces into one profile, in which nothing may be taken between pieces."""
    with checking() as check:
        if not pieces:
            check.refuse("profile", "must be a profile or its pieces, got none")
        elif len({piece.paths for piece in pieces}) > 1:
            check.refuse("profile", "must have pieces with the same number of paths")
    if len(pieces) == 1:
        return pieces[0]
    return replace(
        pieces[0],
        distance=np.concatenate([piece.stations for piece in pieces]),
        elevation=np.concatenate([np.asarray(piece.elevation) for piece in pieces]),
        steps=tuple(dict.fromkeys(step for piece in pieces for step in piece.steps)),
    )


def _parted(pieces: Sequence[Profile], longest: int) -> str:
    """Say what gaps cost."""
    first, last = told_apart(*pieces[longest].stations[[0, -1]].tolist())
    return (
        f"There are gaps between {len(pieces)} pieces: segments that touch one have no roughness index, that of "
        f"the whole is of the pieces by their lengths, and spectra are of the longest, {first} m to {last} m."
    )


def as_dict(found: ProfileDescription, understood: str = "") -> dict[str, object]:
    """Turn a description into what JSON can hold.

    Parameters
    ----------
    found : ProfileDescription
        What `describe_profile` returned.
    understood : str
        How the file was understood.

    Returns
    -------
    dict
        With the unit in every name; None where there is no number.
    """
    profile = found.profile
    paths = [
        {
            "path": path.number,
            "across_m": path.across,
            "lowest_m": path.lowest,
            "highest_m": path.highest,
            "mean_slope_percent": 100 * path.slope,
            "resolution_m": path.resolution or None,
            "roughness_m3": path.fit.roughness,
            "waviness": path.fit.waviness,
            "roughness_at_waviness_2_m3": path.fit.roughness_at_two,
            "fitted_over_cycle_per_m": list(path.fit.band),
            "iso_8608_class": path.fit.road_class or None,
            "why_no_class": path.fit.reason or None,
            "iri_mm_per_m": path.index,
            **{f"iri_per_{span:g}_m_mm_per_m": each.tolist() for span, each in path.indices.items()},
        }
        for path in found.paths
    ]
    coherence = found.coherence or (np.empty(0), np.empty(0))
    content = {
        "source": profile.source,
        "understood": understood,
        "steps": list(profile.steps),
        "stations": int(profile.stations.size),
        "first_m": float(profile.stations[0]),
        "last_m": float(profile.stations[-1]),
        "length_m": found.length,
        "shortest_step_m": found.shortest_step,
        "longest_step_m": found.longest_step,
        "paths": paths,
        "segments_m": {f"{span:g}": at.tolist() for span, at in found.edges.items()},
        "coherence": {
            "spatial_frequency_cycle_per_m": coherence[0].tolist(),
            "magnitude_squared": coherence[1].tolist(),
        },
        "findings": list(found.findings),
    }
    cleaned: dict[str, object] = finite(content)
    return cleaned


def indices_as_csv(found: ProfileDescription, name: str = "") -> str:
    """Write the roughness index of every segment as a table.

    Parameters
    ----------
    found : ProfileDescription
        What `describe_profile` returned.
    name : str
        Name of the file, for tables that are put together; that of the profile's source by default.

    Returns
    -------
    str
        CSV text: the file, length of whole segments, where each begins and ends [m], and the index of each path
        [mm/m], empty where there is none; heads alone of a profile without segments.
    """
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    heads = ["file", "segment [m]", "start [m]", "end [m]"]
    table.writerow([*heads, *(f"IRI of path {path.number} [mm/m]" for path in found.paths)])
    for span, edges in found.edges.items():
        for n, (start, end) in enumerate(pairwise(edges.tolist())):
            row = (path.indices[span][n] for path in found.paths)
            values = ("" if np.isnan(value) else f"{value:.5g}" for value in row)
            table.writerow([name or found.profile.source, f"{span:g}", f"{start:.12g}", f"{end:.12g}", *values])
    return text.getvalue()


def _path(
    even: Profile,
    column: int,
    number: int,
    elevation: FloatArray,
    slope: float,
    indices: dict[float, FloatArray],
    estimated: Spectra,
) -> PathDescription:
    density = estimated.own[:, column]
    spectrum = (estimated.frequency, density) if density.any() else (np.empty(0), np.empty(0))
    across = even.across[column] if even.across is not None else None
    return PathDescription(
        number=number,
        across=across,
        lowest=float(elevation.min()),
        highest=float(elevation.max()),
        slope=slope,
        resolution=resolution(elevation),
        fit=fit_iso(*spectrum),
        index=float(indices[0.0][0, column]) if 0.0 in indices else float("nan"),
        indices={span: found[:, column] for span, found in indices.items() if span},
        spatial_frequency=spectrum[0],
        density=spectrum[1],
    )


def _edges(profile: Profile, step: float) -> dict[float, FloatArray]:
    """Where segments begin and end [m], by their length: multiples of it, and both ends of the profile."""
    first, last = profile.stations[[0, -1]].tolist()
    found = {}
    # Segments of 20 m and 100 m [a convention].
    for span in (20.0, 100.0):
        # What is left within half a step of an end is nothing.
        inner = span * np.arange(np.ceil((first - step / 2) / span), np.floor((last + step / 2) / span) + 1) + 0.0
        if span > shortest_segment(step) + step and inner.size > 1:
            ends = [first] if first < inner[0] - step / 2 else [], [last] if last > inner[-1] + step / 2 else []
            found[span] = np.concatenate([ends[0], inner, ends[1]])
    return found


def _indices(
    pieces: Sequence[Profile], longest: int, edges: dict[float, FloatArray], progress: Progress
) -> tuple[dict[float, FloatArray], str]:
    """Roughness index of the whole (at 0) and of segments, and why there is none."""
    step, length = pieces[longest].even_step() or 0.0, float(np.ptp(pieces[longest].stations))
    if step > PROCEDURE.longest_step:
        most, got = told_apart(PROCEDURE.longest_step, step, digits=2)
        return {}, f"The roughness index needs a step of at most {most} m, and there is one of {got} m."
    if length < PROCEDURE.start:
        least, got = told_apart(PROCEDURE.start, length, digits=4)
        return {}, f"The roughness index needs {least} m of road, and there are {got} m."
    fit = [
        piece
        for piece in pieces
        if np.ptp(piece.stations) >= PROCEDURE.start and (piece.even_step() or 0.0) <= PROCEDURE.longest_step
    ]
    progress("roughness index", 0.0)
    lengths = [float(np.ptp(piece.stations)) for piece in fit]
    found = {0.0: np.average([straight_index(piece, None) for piece in fit], axis=0, weights=lengths)}
    for n, (span, bounds) in enumerate(edges.items(), start=1):
        progress("roughness index", n / (len(edges) + 1))
        found[span] = np.full((bounds.size - 1, pieces[longest].paths), np.nan)
        for piece in fit:
            own = _within(piece, bounds)
            if own.stop > own.start:
                found[span][own] = index_between(piece, bounds[own.start : own.stop + 1])
    return found, ""


def _within(piece: Profile, bounds: FloatArray) -> slice:
    """Segments that lie on a piece and are long enough for an index."""
    step = piece.even_step() or 0.0
    starts, ends = bounds[:-1], bounds[1:]
    there = (starts >= piece.stations[0] - step / 2) & (ends <= piece.stations[-1] + step / 2)
    numbers = np.flatnonzero(there & (ends - starts >= shortest_segment(step)))
    return slice(int(numbers[0]), int(numbers[-1]) + 1) if numbers.size else slice(0, 0)


def _coherence(estimated: Spectra) -> tuple[FloatArray, FloatArray] | None:
    """Magnitude-squared coherence of the first and the last path, averaged over the bands of ISO 8608."""
    n = estimated.frequency
    band = np.digitize(n, SMOOTHING_EDGES)
    sums = [
        np.bincount(band, values, minlength=SMOOTHING_EDGES.size + 1)[1:-1]
        for values in (np.ones(n.size), n, *estimated.own[:, [0, -1]].T, estimated.both.real, estimated.both.imag)
    ]
    lines, frequency, first, last, real, imaginary = (total[sums[2] * sums[3] > 0] for total in sums)
    if not lines.size:
        return None
    return frequency / lines, (real**2 + imaginary**2) / (first * last)


def _doubts(paths: list[PathDescription]) -> list[str]:
    """Say why there is no class or it means little, once for all paths of which it is true, and what is no road."""
    said: dict[str, list[int]] = {}
    for path in paths:
        words = f"no class: {path.fit.reason}" if path.fit.reason else path.fit.doubt
        if words:
            said.setdefault(f"{words}.", []).append(path.number)
        if path.fit.roughness_at_two > ODDITIES.density or path.index > ODDITIES.index:
            rough = (f"IRI {path.index:.4g} mm/m",) if np.isfinite(path.index) else ()
            dense = () if path.fit.reason else (f"{path.fit.roughness_at_two:.3g} m³ at 0.1 cycle/m",)
            words = f"rougher than roads are, {' and '.join(rough + dense)}: are the elevations in metres?"
            said.setdefault(words, []).append(path.number)
    return [
        _sentence(words if len(numbers) == len(paths) else f"{named_paths(numbers)}: {words}")
        for words, numbers in said.items()
    ]


def _missing(value: Sentinel) -> str:
    """Say that a value is hardly an elevation."""
    where = "1 elevation is" if value.number == 1 else f"{value.number} elevations are"
    return (
        f"{where} {plain(value.value)} m, {value.off:.4g} m from the nearest other one: more likely a marker of "
        f"missing values than the road, so that there is neither class nor index; {option('missing')} says what "
        "stands for nothing, in the file's unit."
    )


def _sentence(words: str) -> str:
    return words[0].upper() + words[1:]


def _oddities(stations: FloatArray, elevation: FloatArray, of: str) -> list[str]:
    """Say what looks like a drop-out, a spike or a fill."""
    found = []
    bend = np.abs(elevation[1:-1] - (elevation[:-2] + elevation[2:]) / 2)
    # A spike bends its neighbours half as much; it is counted once.
    around = np.pad(bend, 1)
    peak = (bend >= around[:-2]) & (bend > around[2:])
    high = np.flatnonzero(peak & (bend > max(ODDITIES.spike, ODDITIES.unusual * float(np.median(bend)))))
    if high.size:
        worst = int(high[bend[high].argmax()])
        where = place(stations[worst + 1])
        by = f"by {1e3 * bend[worst]:.3g} mm at {where} m: a spike, or a sharp edge of the road."
        one = f"1 elevation{of} stands out from both of its neighbours, "
        several = f"{high.size} elevations{of} stand out from both of their neighbours, the most "
        found.append((one if high.size == 1 else several) + by)
    changes = np.flatnonzero(np.diff(elevation) != 0)
    bounds = np.concatenate([[0], changes + 1, [len(elevation)]])
    lengths = stations[bounds[1:] - 1] - stations[bounds[:-1]]
    level = np.flatnonzero((np.diff(bounds) > ODDITIES.level_stations) & (lengths >= ODDITIES.level))
    if level.size:
        longest = level[np.sort(np.argsort(-lengths[level], kind="stable")[: ODDITIES.most_stretches])]
        places = [f"over {lengths[n]:.4g} m from {place(stations[bounds[n]])} m on" for n in longest]
        more = f", and in {level.size - len(places)} shorter stretches" if level.size > len(places) else ""
        found.append(
            f"The elevation{of} does not change at all {', '.join(places)}{more}: a drop-out that was filled, or a "
            "level that is no measurement."
        )
    return found

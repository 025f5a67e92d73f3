"""Roads to draw from: tonal, broad and as measured; each with a road that goes on, and what a case sees of it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

import movingfrf as mf

Draw = np.random.Generator


class Road(NamedTuple):
    profile: mf.Profile
    said: str


def tonal(draw: Draw, first: float, length: float, met: tuple[float, float], paths: int) -> Road:
    wavelength = float(np.exp(draw.uniform(np.log(0.03), np.log(0.5))))
    amplitude = 10 ** draw.uniform(-5.5, -3)
    waves = [
        mf.harmonic(
            amplitude=amplitude, wavelength=wavelength, length=length, start=first, phase=draw.uniform(0, 2 * np.pi)
        )
        for _ in range(paths)
    ]
    return Road(waves[0] if paths == 1 else mf.side_by_side(*waves), f"tonal {wavelength:.3g} m")


def realised(draw: Draw, first: float, length: float, paths: int, highest: float, step: float) -> tuple:
    if draw.random() < 0.3:
        spectrum = mf.FraTrack.of_class(int(draw.integers(4, 7)))
        spectrum, kind = mf.FraTrack(roughness=spectrum.roughness, band=(0.01, highest)), "FRA"
    else:
        name = "ABCD"[draw.integers(4)]
        spectrum, kind = mf.IsoRoad.of_class(name, band=(0.01, highest)), f"ISO {name}"
    seeds = draw.integers(10_000, size=paths)
    seed = int(seeds[0]) if paths == 1 else [int(each) for each in seeds]
    return mf.realise(spectrum, length=length, step=step, seed=seed, start=first), kind


def broad(draw: Draw, first: float, length: float, met: tuple[float, float], paths: int) -> Road:
    highest = float(draw.choice([2.0, 5.0, 10.0, 20.0]))
    profile, kind = realised(draw, first, length, paths, highest, 0.125 / highest)
    return Road(profile, f"{kind} to {highest:g}/m")


def measured(draw: Draw, first: float, length: float, met: tuple[float, float], paths: int) -> Road:
    """Measure a road at coarse stations: its spline is the road, images included."""
    fine, kind = realised(draw, first, length, paths, float(draw.choice([2.0, 5.0, 10.0])), 0.0125)
    step = float(np.exp(draw.uniform(np.log(0.05), np.log(0.25))))
    stations = first + step * np.arange(int(length / step))
    said = f"{kind} at {step:.3g} m"
    if draw.random() < 0.3:
        stations[1:-1] += step * draw.uniform(-0.35, 0.35, stations.size - 2)
        said += " uneven"
    columns = np.stack([fine.along(path)(stations) for path in range(fine.paths)], axis=1)
    if draw.random() < 0.35:
        grade = draw.uniform(-0.06, 0.06)
        columns += grade * (stations - first)[:, None]
        said += f", grade {grade:.1%}"
    profile = mf.Profile(stations, columns if paths > 1 else columns[:, 0])
    if draw.random() < 0.35:
        defect, name = obstacle(draw, first, length, met)
        return Road(mf.superposed(profile, defect), f"{said}, {name}")
    return Road(profile, said)


def obstacle(draw: Draw, first: float, length: float, met: tuple[float, float]) -> tuple[mf.Profile, str]:
    """One obstacle somewhere between two distances."""
    at = met[0] + draw.uniform(0.0, 0.7) * (met[1] - met[0])
    where = {"at": at, "length": length, "start": first}
    kind = draw.integers(3)
    if kind == 0:
        return mf.bump(height=draw.uniform(0.005, 0.05), width=draw.uniform(0.3, 3.0), **where), "bump"
    if kind == 1:
        edge = draw.uniform(0.05, 0.2)
        return mf.pothole(
            depth=draw.uniform(0.01, 0.04), width=draw.uniform(0.5, 1.5), edge=edge, **where
        ), "pothole"
    return mf.dipped_weld(depth=draw.uniform(1e-4, 1e-3), width=1.0, short_depth=1e-4, **where), "weld"


def level_first(draw: Draw, first: float, length: float, met: tuple[float, float], paths: int) -> Road:
    """Lay an obstacle in a level road."""
    defect, name = obstacle(draw, first, length, met)
    return Road(defect, f"{name} alone")


def levelled(profile: mf.Profile, first: float, over: float) -> mf.Profile:
    """Let a road begin level, at its own height there: for who does not blend it in.

    Stations are dense there: between those of a measured road, the spline would overshoot where it is level.
    """
    stations = profile.stations
    dense = np.arange(stations[0], first + over, 0.01)
    stations = np.r_[dense, stations[stations > dense[-1] + 0.005]]
    share = np.clip((stations - first) / over, 0.0, 1.0)
    step = share**4 * (35 - share * (84 - share * (70 - 20 * share)))
    splines = [profile.along(path) for path in range(profile.paths)]
    columns = np.stack([step * (spline(stations) - spline(first)) for spline in splines], axis=1)
    return mf.Profile(stations, columns[:, 0] if profile.same_across else columns)


def cut(profile: mf.Profile, end: float) -> mf.Profile:
    """End a road at a distance, the spline up to there being the same.

    The last station but one lies within the last cubic piece, where the end condition of a spline makes it no knot.
    """
    stations = profile.stations
    kept = stations[stations < end - 1e-6]
    kept = np.r_[kept, 0.5 * (kept[-1] + end), end]
    columns = np.stack([profile.along(path)(kept) for path in range(profile.paths)], axis=1)
    return mf.Profile(kept, columns[:, 0] if profile.same_across else columns)


ROADS = {"tonal": tonal, "broad": broad, "measured": measured, "level": level_first}

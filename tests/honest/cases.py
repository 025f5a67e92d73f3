"""Three hundred cases, each drawn from its own number alone."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

import movingfrf as mf
from movingfrf.roughness.excitation import slope_of
from tests.helpers import BALLAST, PAD, PAVEMENT, RAIL, SHEARED_SOIL, SOIL, TIMOSHENKO
from tests.honest.roads import ROADS, cut, levelled
from tests.honest.vehicles import VEHICLES, vehicle

Draw = np.random.Generator


@dataclass(frozen=True, kw_only=True)
class Case:
    number: int
    guideway: mf.Guideway
    vehicle: mf.Vehicle
    profile: mf.Profile  # what the case sees
    onward: mf.Profile  # the same, and more
    speed: float
    start: float
    time_step: float
    duration: float
    blend: float
    names: dict[str, str]  # vehicle, guideway, profile
    ends: bool  # the profile ends where the foremost contact does

    def run(self, **changes):
        settings = {name: getattr(self, name) for name in ("speed", "start", "time_step", "duration", "blend")}
        profile = changes.pop("profile", self.profile)
        return mf.simulate(self.guideway, self.vehicle, profile, **settings | changes)


BLEND = 5.0  # the default [m]
LONGER = 2.0  # that the reference's record is longer [s]
FARTHEST = 400.0  # that a case travels [m]
WAVES = 150.0  # that a case travels on corrugation, of which there are fifty stations to a wave [m]


def scaled(draw: Draw, part, spread: float = 0.7):
    """Change the parameters of a beam or foundation."""
    names = [name for name in part.__dataclass_fields__ if isinstance(getattr(part, name), float)]
    return replace(part, **{name: getattr(part, name) * np.exp(draw.uniform(-spread, spread)) for name in names})


def _layered(draw: Draw) -> mf.Guideway:
    layers = mf.OnMass(above=scaled(draw, PAD), mass=draw.uniform(200, 300), below=scaled(draw, BALLAST))
    return mf.track(RAIL, layers)


def _soft(draw: Draw) -> mf.Guideway:
    """Draw a critical speed that vehicles reach: 30 to 60 m/s."""
    beam = mf.EulerBernoulliBeam(bending_stiffness=draw.uniform(1e6, 4e6), mass=2000.0)
    return mf.track(beam, mf.Spring(stiffness=draw.uniform(1e6, 3e6), damping=draw.uniform(2e4, 1e5)))


def _fifth(draw: Draw) -> mf.Guideway:
    if draw.random() < 0.5:
        return mf.track(replace(PAVEMENT, bending_damping=10 ** draw.uniform(3.5, 5)), scaled(draw, SOIL))
    return mf.track(mf.TensionedBeam(beam=RAIL, force=draw.uniform(-7e5, 7e5)), scaled(draw, BALLAST))


GUIDEWAYS: dict[str, Callable[[Draw], mf.Guideway]] = {
    "rigid": lambda draw: mf.RigidGuideway(),
    "beam on springs": lambda draw: mf.track(scaled(draw, PAVEMENT), scaled(draw, SOIL)),
    "soft": _soft,
    "Timoshenko": lambda draw: mf.track(TIMOSHENKO, scaled(draw, SHEARED_SOIL)),
    "rail on sleepers": _layered,
    "damped or tensioned": _fifth,
}
GUIDEWAY_SHARES = (0.2, 0.14, 0.06, 0.2, 0.22, 0.18)


def _speed(draw: Draw, name: str, critical: float) -> float:
    if name == "soft" and draw.random() < 0.5 and critical < 70:
        return float(min(critical * draw.uniform(1.2, 1.8), 80.0))
    return float(np.exp(draw.uniform(np.log(2.0), np.log(min(80.0, 0.9 * critical)))))


def same_grade(one: mf.Profile, other: mf.Profile, first: float) -> bool:
    slopes = [slope_of([road.along(path) for path in range(road.paths)], first) for road in (one, other)]
    grades = [slope if counts else 0.0 for slope, counts in slopes]
    return abs(grades[0] - grades[1]) < 1e-12


def stable(guideway: mf.Guideway, driven: mf.Vehicle, speed: float) -> bool:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", mf.ValidityWarning)
            mf.transfer(guideway, driven, speed=speed, frequency=[1.0])
    except mf.SolveError:
        return False
    return True


def case(number: int, seed: int = 0) -> Case:
    """Draw a case; every tenth is short."""
    draw = np.random.default_rng([seed, number])
    guideway_name = str(draw.choice(list(GUIDEWAYS), p=GUIDEWAY_SHARES))
    guideway = GUIDEWAYS[guideway_name](draw)
    kind = list(VEHICLES)[draw.integers(len(VEHICLES))]
    driven, called = vehicle(draw, kind)
    speed = _speed(draw, guideway_name, guideway.critical_speed)
    if speed > guideway.critical_speed and not stable(guideway, driven, speed):
        speed = 0.8 * guideway.critical_speed
    road = str(draw.choice(list(ROADS), p=(0.25, 0.3, 0.4, 0.05)))
    time_step = float(np.exp(draw.uniform(np.log(2.5e-4), np.log(2e-2))))
    farthest = WAVES if road == "tonal" else FARTHEST
    duration = float(np.exp(draw.uniform(np.log(0.5), np.log(10.0))))
    if number % 10 == 0:
        duration, time_step = min(duration, 0.5 + 0.15 * duration), max(time_step, 1e-3)
    duration = max(min(duration, farthest / speed), 0.5)
    samples = round(duration / time_step)
    duration = samples * time_step
    start = float(draw.uniform(0.0, 20.0))
    hindmost = start + float(driven.positions.min())
    first = hindmost - draw.uniform(0.0, 3.0)
    end = start + float(driven.positions.max()) + speed * time_step * samples
    length = end + speed * (LONGER + 2 * time_step) + 3.0 - first
    paths = max(driven.paths) + 1
    foremost = start + float(driven.positions.max())
    made = ROADS[road](draw, first, length, (foremost, end), paths)
    onward, blend, ends = made.profile, BLEND, draw.random() < 1 / 3
    if road == "level" or (ends and not same_grade(onward, cut(onward, end), hindmost)):
        # Where a road that ends early has another grade, the two would be solved about different lines.
        onward, blend = levelled(onward, foremost, BLEND), 0.0
    return Case(
        number=number,
        guideway=guideway,
        vehicle=driven,
        profile=cut(onward, end) if ends else onward,
        onward=onward,
        speed=speed,
        start=start,
        time_step=time_step,
        duration=duration,
        blend=blend,
        names={"vehicle": called, "guideway": guideway_name, "profile": made.said},
        ends=ends,
    )

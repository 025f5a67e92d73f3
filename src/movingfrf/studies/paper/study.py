"""What the items of the paper share: its scenarios, and results that more than one of them shows."""

from __future__ import annotations

import statistics
import time
import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache, cached_property
from importlib.resources import files
from typing import TYPE_CHECKING

import numpy as np
from threadpoolctl import threadpool_limits

from movingfrf._basics.arrays import ComplexArray, FloatArray
from movingfrf._basics.checks import ValidityWarning
from movingfrf._basics.progress import Progress, silent
from movingfrf.guideways.guideway import Guideway
from movingfrf.guideways.sampled import SampledGuideway
from movingfrf.guideways.track import Track
from movingfrf.response.line import Line
from movingfrf.response.moving_loads import moving_loads
from movingfrf.response.simulation import simulate
from movingfrf.roughness.profile import Profile
from movingfrf.scenarios.reading import parse_scenario
from movingfrf.scenarios.scenario import Drive, Scenario, drive_of, passage_of, shortened
from movingfrf.scenarios.stepped import elements
from movingfrf.stepping.finite_guideway import FiniteGuideway
from movingfrf.stepping.finite_track import finite_track
from movingfrf.stepping.impulse import struck_track
from movingfrf.stepping.moving_loads import newmark_loads
from movingfrf.studies.comparison.comparison import Comparison, compare
from movingfrf.studies.comparison.methods import FOR_VEHICLE, Case
from movingfrf.studies.paper.stated import STATED, SUBSTITUTES

if TYPE_CHECKING:
    import xarray as xr


# The scenarios that ship with the package.
SCENARIOS = ("load", "load_abrupt", "truck", "truck_times", "truck_narrow", "truck_3d", "truck_3d_paths")


@cache
def scenario(name: str) -> Scenario:
    """Read one of the scenarios that ship with the package.

    Parameters
    ----------
    name : str
        Its name, without the ending.

    Returns
    -------
    Scenario
        Checked.
    """
    text = files("movingfrf").joinpath("studies", "paper", "scenarios", f"{name}.toml").read_text(encoding="utf-8")
    return parse_scenario(text, name=name, source=f"{name}.toml")


def drive(name: str) -> Drive:
    """Give the vehicle on its road that one of these scenarios says.

    Parameters
    ----------
    name : str
        Name of the scenario.

    Returns
    -------
    Drive
        The vehicle on its road.
    """
    return drive_of(scenario(name))


@dataclass(frozen=True)
class Study:
    """One run of the reproduction; what several items need is computed once, when the first of them asks for it.

    Parameters
    ----------
    quick : bool
        Whether to do everything more coarsely.
    progress : callable
        Called with the name of a stage and the fraction of it that is done.
    """

    quick: bool = False
    progress: Progress = silent

    def told(self, stage: str, done: int, of: int) -> None:
        """Report that so many of so many parts of a stage are done."""
        self.progress(stage, done / of)

    @cached_property
    def guideway(self) -> Track:
        """The paper's road, 3 m wide and without ends."""
        guideway = scenario("truck").guideway
        assert isinstance(guideway, Track)
        return guideway

    @property
    def speed(self) -> float:
        """The paper's speed [m/s]."""
        return scenario("truck").journey.speed

    @cached_property
    def wheelbase(self) -> float:
        """Distance between the axles [m]."""
        return float(np.ptp(drive("truck").vehicle.positions))

    @cached_property
    def offsets(self) -> FloatArray:
        """Under the load, one wheelbase ahead, one behind [m]."""
        return np.array([0.0, self.wheelbase, -self.wheelbase])

    @cached_property
    def struck(self) -> SampledGuideway:
        """The paper's way: 40 m of finite elements with pinned ends, struck once, steps of 1 ms."""
        return self._struck(plain=True)

    @cached_property
    def struck_finely(self) -> SampledGuideway:
        """Four roads of 40 m whose end reflections cancel, finer elements and steps."""
        return self._struck(plain=False)

    def _struck(self, *, plain: bool) -> SampledGuideway:
        with quiet():
            return struck_track(
                self.guideway, speed=self.speed, offsets=self.offsets, plain=plain, progress=self.progress
            )

    @cached_property
    def finite(self) -> FiniteGuideway:
        """The paper's road for Newmark's method: 480 unknowns."""
        first = -SUBSTITUTES.newmark_start
        return finite_track(
            self.guideway,
            first=first,
            last=first + STATED.newmark_length,
            element=STATED.newmark_element,
            ends="pinned",
        )

    @cached_property
    def force(self) -> FloatArray:
        """The load's history, shape (time, 1) [N]."""
        return history("load")

    def under_load(self, guideway: Guideway, name: str = "load") -> xr.Dataset:
        """Deflection under the moving load, by the moving FRF, nothing left out."""
        journey = scenario(name).journey
        with quiet():
            return moving_loads(guideway, history(name), [0.0], speed=journey.speed, time_step=journey.time_step)

    def cut_sharply(self, guideway: Guideway, name: str = "load") -> Callable[[float], FloatArray]:
        """Prepare the deflection under the moving load as the paper truncates it: without frequencies beyond a cut.

        (`moving_loads` lets it fade over the next 5 %, since a sharp cut rings.)
        """
        journey = scenario(name).journey
        samples, step = journey.samples, journey.time_step
        # The sharper the cut, the longer it rings: all along the record.
        line = Line(samples=samples, time_step=step, cut=1.0 / (samples * step))
        forces = line.spectra(line.given(history(name).T))[0]
        spectrum = guideway.moving_frf(0.0, journey.speed, line.omega()) * forces
        kept = np.arange(line.size) / line.period
        return lambda cut: line.records(spectrum[kept <= cut * (1 + 1e-9)]).values[:, None]

    @cached_property
    def by_newmark(self) -> xr.Dataset:
        """Deflection under the moving load, by Newmark's method on the paper's road."""
        journey = scenario("load").journey
        return newmark_loads(self.finite, self.force, [0.0], speed=journey.speed, time_step=journey.time_step)

    def driven(
        self,
        guideway: Guideway,
        name: str = "truck",
        truncation: float | None = STATED.truncation,
        *,
        duration: float | None = None,
        profile: Profile | None = None,
    ) -> xr.Dataset:
        """Response of the vehicle and the road, by the moving FRF; on another profile or for another time."""
        case = drive(name)
        journey = case.journey
        with quiet():
            return simulate(
                guideway,
                case.vehicle,
                case.road.profile if profile is None else profile,
                speed=journey.speed,
                duration=journey.duration if duration is None else duration,
                time_step=journey.time_step,
                truncation=truncation,
                blend=journey.blend,
            )

    @cached_property
    def by_moving_frf(self) -> xr.Dataset:
        """Response of vehicle and road as in the paper: moving FRF of the struck 40 m, up to 70 Hz."""
        return self.driven(self.struck)

    @cached_property
    def in_closed_form(self) -> xr.Dataset:
        """Response of vehicle and road with the moving FRF in closed form."""
        return self.driven(self.guideway)

    @cached_property
    def by_cdfm(self) -> xr.Dataset:
        """Response of vehicle and road by the coupled method."""
        return self._stepped("cdfm")

    @cached_property
    def by_sim(self) -> xr.Dataset:
        """Response of vehicle and road by the separate iterative method."""
        return self._stepped("sim")

    def _stepped(self, method: str) -> xr.Dataset:
        case = scenario("truck")
        of = Case(scenario=case, time_step=case.journey.time_step, element=elements(case.guideway)[-1])
        with quiet():
            return FOR_VEHICLE[method].prepare(of)(of.given)

    @cached_property
    def compared(self) -> Comparison:
        """All methods on the vehicle's journey; in the quick version its first second, each run once."""
        case, brief = scenario("truck_times"), self.quick
        if brief:
            case = shortened(case, 1.0)
        methods = ["moving-frf", "moving-frf-fe", "moving-frf-fe-plain", "duhamel", "cdfm", "cdfm-weight", "sim"]
        return compare(case, methods, memory=not brief, runs=1 if brief else 3, progress=self.progress)


@cache
def history(name: str) -> FloatArray:
    """Load of a scenario at its steps, shape (time, 1) [N]."""
    return passage_of(scenario(name)).forces


@contextmanager
def quiet() -> Iterator[None]:
    """Keep findings to themselves: the report shows the errors."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ValidityWarning)
        yield


def closed_form(guideway: Track, frequency: FloatArray, offsets: FloatArray, speed: float) -> ComplexArray:
    """Sum the residues of the moving FRF at real frequencies [m/N], shape (frequency, offset)."""
    return guideway.moving_frf(offsets, speed, 2 * np.pi * frequency)


def relative(found: FloatArray, wanted: FloatArray) -> float:
    """Relative L2 difference, the worst channel of (time, channel)."""
    return float((np.linalg.norm(found - wanted, axis=0) / np.linalg.norm(wanted, axis=0)).max())


def timed(ways: Mapping[str, Callable[[], object]], runs: int = 5) -> dict[str, float]:
    """Median time of each way [s] over some runs, on one thread, after one that does not count, taken in turns."""
    with threadpool_limits(limits=1):
        for way in ways.values():
            way()
        seconds: dict[str, list[float]] = {name: [] for name in ways}
        for _ in range(runs):
            for name, way in ways.items():
                began = time.perf_counter()
                way()
                seconds[name].append(time.perf_counter() - began)
    return {name: statistics.median(taken) for name, taken in seconds.items()}

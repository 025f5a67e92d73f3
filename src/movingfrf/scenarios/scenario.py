"""A checked scenario, ready to run; and what is said where a file is refused."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from movingfrf._basics.checks import Fault
from movingfrf._basics.progress import Progress, silent
from movingfrf.guideways.guideway import Guideway
from movingfrf.response.moving_loads import moving_loads
from movingfrf.response.simulation import simulate
from movingfrf.roughness.road import Road
from movingfrf.scenarios.kinds import Loads
from movingfrf.vehicles.journey import Journey
from movingfrf.vehicles.vehicle import Vehicle

if TYPE_CHECKING:
    import xarray as xr


class ScenarioError(ValueError):
    """A scenario file that is refused; `faults` lists everything that is wrong with it.

    Parameters
    ----------
    source : str
        The file.
    faults : sequence of Fault
        Key path and reason of each fault.
    """

    def __init__(self, source: str, faults: Sequence[Fault]) -> None:
        self.faults = tuple(faults)
        count = "1 fault" if len(self.faults) == 1 else f"{len(self.faults)} faults"
        lines = [f"  {fault.name} {fault.message}".rstrip() for fault in self.faults]
        super().__init__("\n".join([f"{source}: {count}", *lines]))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Scenario:
    """A checked scenario, ready to run: a vehicle on a road, or prescribed loads.

    Parameters
    ----------
    name : str
        Name of the file, without its ending.
    text : str
        The scenario as it was written.
    guideway : Guideway
        The road or track.
    journey : Journey
        Speed, duration, steps.
    vehicle : Vehicle, optional
        The vehicle; None with prescribed loads.
    road : Road, optional
        The profile and what it stands for; None with prescribed loads.
    loads : Loads, optional
        The prescribed loads; None with a vehicle.
    folder : Path
        Folder to which paths in the text are relative.
    """

    name: str
    text: str
    guideway: Guideway
    journey: Journey
    vehicle: Vehicle | None = None
    road: Road | None = None
    loads: Loads | None = None
    folder: Path = Path()

    def run(self, progress: Progress = silent) -> xr.Dataset:
        """Compute the response.

        Parameters
        ----------
        progress : callable
            Called with the name of a stage and the fraction of it that is done.

        Returns
        -------
        xarray.Dataset
            What `simulate` or `moving_loads` returns, with the scenario's text in its attributes.

        Raises
        ------
        SolveError
            If the case has no meaningful answer.
        """
        journey = self.journey
        if self.loads is not None:
            time = np.arange(journey.samples) * journey.time_step
            result = moving_loads(
                self.guideway,
                np.stack([history(time) for history in self.loads.histories], axis=1),
                self.loads.positions,
                speed=journey.speed,
                time_step=journey.time_step,
                observe=self.loads.observe,
                truncation=journey.truncation,
                progress=progress,
            )
        else:
            assert self.vehicle is not None
            assert self.road is not None
            result = simulate(
                self.guideway,
                self.vehicle,
                self.road.profile,
                speed=journey.speed,
                duration=journey.duration,
                start=journey.start,
                time_step=journey.time_step,
                truncation=journey.truncation,
                blend=journey.blend,
                progress=progress,
            )
        attributes = {"scenario": self.text}
        if self.road is not None:
            attributes["road"] = self.road.description
            if self.road.spectrum is not None:
                attributes["spectrum"] = str(self.road.spectrum)
        return result.assign_attrs(attributes)

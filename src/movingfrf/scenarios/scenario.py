"""A checked scenario, ready to run; and what is said where a file is refused."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import Fault, Finding, nearest, shown, spelt, warned
from movingfrf._basics.progress import Progress, silent
from movingfrf._basics.values import Value, brief
from movingfrf._basics.wording import count, enumerated
from movingfrf.guideways.guideway import Guideway, require_guideway
from movingfrf.response.moving_loads import Forces, carried
from movingfrf.response.simulation import driven
from movingfrf.response.system import Prescribed
from movingfrf.results.findings import one_path, with_more
from movingfrf.roughness.road import Road
from movingfrf.roughness.spectra.spectrum import Spectrum
from movingfrf.scenarios.forces import Loads
from movingfrf.scenarios.stepped import EXCHANGED, Division, coupled, elements, loaded, require_endless
from movingfrf.scenarios.unusual import unusual
from movingfrf.stepping.exchange import SOLVED
from movingfrf.stepping.finite_guideway import FiniteGuideway
from movingfrf.vehicles.journey import Journey
from movingfrf.vehicles.vehicle import Offsets, Vehicle

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
        lines = [f"  {fault.name} {fault.message}".rstrip() for fault in self.faults]
        super().__init__("\n".join([f"{source}: {count(len(self.faults), 'fault')}", *lines]))


# What computes a case unless something else is asked for; the methods that step a drive, and how each finds contact
# forces; the one that steps a passage.
MOVING_FRF = "moving-frf"
COUPLED_BY = {"cdfm": SOLVED, "sim": EXCHANGED}
NEWMARK = "newmark"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Drive(Value):
    """A vehicle on a rough road.

    Parameters
    ----------
    guideway : Guideway or FiniteGuideway
        The road or track.
    vehicle : Vehicle
        The vehicle.
    road : Road
        The profile and what it stands for.
    journey : Journey
        Speed, duration, steps.
    """

    guideway: Guideway | FiniteGuideway
    vehicle: Vehicle
    road: Road
    journey: Journey

    def told(self) -> list[tuple[str, str]]:
        """Tell guideway, vehicle, road and journey, in words."""
        (_, dofs), (_, contacts), (_, weight) = self.vehicle.told()
        return [
            ("guideway", brief(self.guideway)),
            ("vehicle", f"{weight}; {dofs}"),
            ("contacts", contacts),
            ("road", brief(self.road.description)),
            ("journey", f"{self.journey.duration:g} s at {self.journey.speed_in_words}"),
        ]

    @property
    def unusual(self) -> list[Finding]:
        """What of it lies outside what is usual."""
        return unusual(self.guideway, self.journey, vehicle=self.vehicle, profile=self.road.profile)

    @property
    def spectrum(self) -> Spectrum:
        """Spectrum of the road; refused where it has none."""
        if self.road.spectrum is None:
            raise ValueError(
                f"the roughness has no spectrum ({self.road.description}): it is one road, not all of a kind. "
                "`movingfrf run` computes the response to it. A random road needs a kind with a spectrum, such as "
                "iso_road with the roughness and waviness that `movingfrf check` fits to a measured profile"
            )
        return self.road.spectrum

    @property
    def of_random_roads(self) -> list[Finding]:
        """What is to be known about it where all roads of its spectrum are meant."""
        alike = one_path(self.road.profile.one_path, self.vehicle.paths, self.vehicle.across)
        return [*alike, *self.unusual]

    @property
    def places(self) -> FloatArray:
        """Where contacts stand, ahead of the reference point [m]."""
        return self.vehicle.positions

    @property
    def offsets(self) -> Offsets:
        """Offset of every contact from every contact, as a guideway's `moving_frf` takes them [m]."""
        return self.vehicle.offsets

    def run(self, progress: Progress = silent, method: str = MOVING_FRF) -> xr.Dataset:
        """Compute the response.

        Parameters
        ----------
        progress : callable
            Called with the name of a stage and the fraction of it that is done.
        method : str
            `moving-frf`, or `cdfm` or `sim`, which step through time: on a finite road as it is, otherwise on a
            stretch that is cut out of an endless track.

        Returns
        -------
        xarray.Dataset
            What `simulate`, `cdfm` or `sim` returns, with what the road is in its attributes.

        Raises
        ------
        ValueError
            If there is no such method, or the road does not suit it.
        SolveError
            If the case has no meaningful answer.
        """
        method = _known_method(method, (MOVING_FRF, *COUPLED_BY), "a vehicle", self.guideway)
        if method in COUPLED_BY:
            result = coupled(
                (self.guideway, self.vehicle),
                self.journey,
                Division(element=elements(self.guideway)[-1]),
                iteration=COUPLED_BY[method],
                progress=progress,
            )(self.road.profile)
        else:
            endless = require_endless(self.guideway, instead="cdfm")
            result = driven(endless, self.vehicle, self.road.profile, self.journey, progress=progress)
        spectrum = {} if self.road.spectrum is None else {"spectrum": str(self.road.spectrum)}
        return result.assign_attrs(road=self.road.description, **spectrum)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Passage(Value):
    """Prescribed loads that travel along a road.

    Parameters
    ----------
    guideway : Guideway or FiniteGuideway
        The road or track.
    loads : Loads
        The loads, and where the deflection is wanted.
    journey : Journey
        Speed, duration, steps.
    """

    guideway: Guideway | FiniteGuideway
    loads: Loads
    journey: Journey

    def told(self) -> list[tuple[str, str]]:
        """Tell guideway, loads and journey, in words."""
        return [
            ("guideway", brief(self.guideway)),
            ("loads", f"at {enumerated([f'{place:g}' for place in self.loads.positions], 8)} m"),
            ("observed", f"at {enumerated([f'{place:g}' for place in self.loads.observe], 8)} m"),
            ("journey", f"{self.journey.duration:g} s at {self.journey.speed_in_words}"),
        ]

    @property
    def unusual(self) -> list[Finding]:
        """What of it lies outside what is usual."""
        return unusual(self.guideway, self.journey, forces=self.forces)

    @property
    def places(self) -> FloatArray:
        """Where loads and observers stand, ahead of the reference point [m]."""
        return np.concatenate([self.loads.positions, self.loads.observe])

    @property
    def offsets(self) -> Offsets:
        """Offset of every observer from every load, as a guideway's `moving_frf` takes them [m]."""
        return {"ahead": np.round(self.loads.observe[:, None] - self.loads.positions, 9)}

    @property
    def forces(self) -> FloatArray:
        """Forces at the steps of the journey, shape (time, load) [N]."""
        return self.loads.at(self.journey.times)

    def run(self, progress: Progress = silent, method: str = MOVING_FRF) -> xr.Dataset:
        """Compute the response.

        Parameters
        ----------
        progress : callable
            Called with the name of a stage and the fraction of it that is done.
        method : str
            `moving-frf`, or `newmark`, which steps through time: on a finite road as it is, otherwise on a stretch
            that is cut out of an endless track.

        Returns
        -------
        xarray.Dataset
            What `moving_loads` or `newmark_loads` returns.

        Raises
        ------
        ValueError
            If there is no such method, or the road does not suit it.
        SolveError
            If the case has no meaningful answer.
        """
        method = _known_method(method, (MOVING_FRF, NEWMARK), "prescribed loads", self.guideway)
        if method == NEWMARK:
            return loaded(
                self.guideway,
                (self.loads.positions, self.loads.observe),
                self.journey,
                Division(element=elements(self.guideway)[-1]),
                progress=progress,
            )(self.forces)
        guideway = require_endless(self.guideway, instead=NEWMARK)
        require_guideway(guideway)
        return carried(
            Prescribed(
                guideway=guideway,
                loads=self.loads.positions,
                points=self.loads.observe,
                speed=self.journey.speed,
            ),
            Forces(given=self.loads.given, at=self.loads.at, sampled=self.forces, finest=self.loads.finest),
            time_step=self.journey.time_step,
            truncation=self.journey.truncation,
            progress=progress,
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Scenario(Value):
    """A checked scenario, ready to run: what a user wrote, and the case that it says.

    Parameters
    ----------
    name : str
        Name of the file, without its ending.
    text : str
        The scenario as it was written.
    case : Drive or Passage
        A vehicle on a rough road, or prescribed loads.
    folder : Path
        Folder to which paths in the text are relative.
    """

    name: str
    text: str
    case: Drive | Passage
    folder: Path = field(default=Path(), compare=False)

    def told(self) -> list[tuple[str, str]]:
        """Tell name and case, in words."""
        return [("name", self.name), *self.case.told()]

    @property
    def guideway(self) -> Guideway | FiniteGuideway:
        """The road or track."""
        return self.case.guideway

    @property
    def endless(self) -> Guideway | None:
        """The same where it is endless and so has moving FRFs; None: it is a finite road."""
        return None if isinstance(self.guideway, FiniteGuideway) else self.guideway

    @property
    def journey(self) -> Journey:
        """Speed, duration, steps."""
        return self.case.journey

    def run(self, progress: Progress = silent, method: str = MOVING_FRF) -> xr.Dataset:
        """Compute the response.

        Parameters
        ----------
        progress : callable
            Called with the name of a stage and the fraction of it that is done.
        method : str
            `moving-frf`; `cdfm` or `sim` with a vehicle, `newmark` with prescribed loads, on a finite road one of
            these.

        Returns
        -------
        xarray.Dataset
            What `simulate`, `moving_loads`, `cdfm`, `sim` or `newmark_loads` returns, with the scenario's text in
            its attributes.

        Raises
        ------
        ValueError
            If there is no such method, or the road does not suit it.
        SolveError
            If the case has no meaningful answer.
        """
        result = self.case.run(progress, method)
        findings = with_more(result.attrs["findings"], warned(self.case.unusual))
        return result.assign_attrs(scenario=self.text, findings=findings, **self.journey.given_speed)

    def at_random(
        self, *, exposure: float = 600.0, frequency: ArrayLike | None = None, progress: Progress = silent
    ) -> xr.Dataset:
        """Compute the response to all roads of the spectrum, without realising one.

        Parameters
        ----------
        exposure : float
            Duration for which largest values are expected [s].
        frequency : array_like, optional
            Frequencies at which densities are told [Hz]; None: where they are needed.
        progress : callable
            Called with the name of a stage and the fraction of it that is done.

        Returns
        -------
        xarray.Dataset
            What `random_response` returns, with the scenario's text in its attributes.

        Raises
        ------
        ValueError
            If loads are prescribed, the guideway is no endless one, or the roughness has no spectrum.
        SolveError
            If the case has no meaningful answer.
        """
        from movingfrf.response.random import random_response

        drive = drive_of(self, "have no random road; a vehicle and a spectrum are needed")
        result = random_response(
            require_endless(drive.guideway, instead="cdfm"),
            drive.vehicle,
            drive.spectrum,
            speed=drive.journey.speed,
            coherence=drive.road.coherence,
            exposure=exposure,
            frequency=frequency,
            progress=progress,
        )
        findings = with_more(result.attrs["findings"], warned(drive.of_random_roads))
        return result.assign_attrs(scenario=self.text, findings=findings, **drive.journey.given_speed)


def shortened(scenario: Scenario, duration: float) -> Scenario:
    """Let a scenario end earlier.

    Parameters
    ----------
    scenario : Scenario
        The scenario.
    duration : float
        Duration, at most its own [s].

    Returns
    -------
    Scenario
        The same but for its duration.
    """
    journey = replace(scenario.journey, duration=duration)
    return replace(scenario, case=replace(scenario.case, journey=journey))


def drive_of(scenario: Scenario, otherwise: str = "") -> Drive:
    """Give the drive that a scenario says.

    Parameters
    ----------
    scenario : Scenario
        A scenario with a vehicle.
    otherwise : str
        What is said of prescribed loads.

    Returns
    -------
    Drive
        The vehicle on its road.

    Raises
    ------
    ValueError
        If its loads are prescribed.
    """
    if isinstance(scenario.case, Drive):
        return scenario.case
    if otherwise:
        raise ValueError(f"prescribed loads {otherwise}")
    raise ValueError(f"{scenario.name}: a scenario with a vehicle is wanted, its loads are prescribed")


def passage_of(scenario: Scenario) -> Passage:
    """Give the passage of prescribed loads that a scenario says.

    Parameters
    ----------
    scenario : Scenario
        A scenario with loads.

    Returns
    -------
    Passage
        The loads on their road.

    Raises
    ------
    ValueError
        If it has a vehicle.
    """
    if isinstance(scenario.case, Passage):
        return scenario.case
    raise ValueError(f"{scenario.name}: a scenario with prescribed loads is wanted, it has a vehicle")


def _known_method(method: str, known: tuple[str, ...], what: str, guideway: Guideway | FiniteGuideway) -> str:
    found = spelt(method, known)
    if found is None:
        if isinstance(guideway, FiniteGuideway):
            known, what = tuple(one for one in known if one != MOVING_FRF), f"{what} on a finite road"
        hint = "" if method in (*COUPLED_BY, NEWMARK) else nearest(str(method), known)
        raise ValueError(f"method must be one of {', '.join(known)} with {what}, got {shown(method)}{hint}")
    return found

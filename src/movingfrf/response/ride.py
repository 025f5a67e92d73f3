"""What a vehicle and a road do on a journey, before it has labels: of one case, or of thousands."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

import movingfrf.results.findings as find
from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.progress import Progress, silent
from movingfrf._basics.remembered import Remembering, latest, recalled, remembered
from movingfrf.guideways.guideway import Guideway
from movingfrf.response.accuracy import hidden, past_the_end, truncated, unresolved
from movingfrf.response.influence import looked_at
from movingfrf.response.line import Given, Line, holds, require_record
from movingfrf.response.sampling import SAMPLING, Driving, Excited, at_first, excited, sixteenths
from movingfrf.response.solve import solve
from movingfrf.response.survey import SteadyState, Survey, survey
from movingfrf.response.system import CoupledHistories, Response, System
from movingfrf.response.truncation import Truncation
from movingfrf.results.labels import turned
from movingfrf.roughness.along import shortest_wave
from movingfrf.roughness.excitation import Excitation, Touch, excite
from movingfrf.roughness.profile import Profile
from movingfrf.vehicles.journey import Journey
from movingfrf.vehicles.vehicle import Vehicle


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Ride(Remembering):
    """A vehicle on a rough road, solved; made by `ride`.

    Parameters
    ----------
    system : System
        Vehicle and road.
    profile : Profile
        Elevation of the road.
    journey : Journey
        How the vehicle travels.
    excitation : Excitation
        What contacts see of the road.
    surveyed : Survey
        Steady travel.
    driven_by : Excited
        Spectra of what drives the vehicle.
    response : Response
        Spectra of what it does.
    histories : CoupledHistories
        The same at the steps of the journey, about steady travel.
    left_out : float
        Estimate of what is not solved, relative to the largest value of a channel.
    """

    system: System
    profile: Profile
    journey: Journey
    excitation: Excitation
    surveyed: Survey
    driven_by: Excited
    response: Response
    histories: CoupledHistories
    left_out: float

    @property
    def steady(self) -> SteadyState:
        """Travel on a smooth road."""
        return self.surveyed.steady

    @property
    @remembered
    def truncation(self) -> Truncation:
        """Where the guideway begins to count as rigid, and what that changes."""
        return truncated(self.system, self.driven_by, self.response, self.histories)

    @property
    @remembered
    def _above(self) -> FloatArray:
        """Share of each contact's force, then of each acceleration, that the steps of the journey do not show."""
        line, histories = self.driven_by.line, self.histories
        return np.append(
            hidden(line, self.response.force, histories.force.values),
            hidden(line, self.response.motion, histories.acceleration.values, derivative=2),
        )

    @property
    @remembered
    def _kept(self) -> bool:
        """Whether memory holds the response in finer steps, if those of the journey do not show it."""
        return self._finer == 1 or holds(self.driven_by.line, self._above.size, self._finer)

    @property
    @remembered
    def _finer(self) -> int:
        """How many values for each step of the journey would show all."""
        return self.driven_by.finer(self.journey.time_step) if self._above.any() else 1

    @property
    @remembered
    def not_shown(self) -> list[find.Finding]:
        """What the steps of the journey do not show, if that is worth a word."""
        vehicle = self.system.vehicle
        names = [
            *(f"force of {vehicle.standing.listed([n])}" for n in range(len(vehicle.contacts))),
            *(f"acceleration of {name}" for name in vehicle.dof_names),
        ]
        above = self._above
        return find.not_shown(above, names, self.journey.time_step, kept=self._kept) if above.any() else []

    @property
    def finer(self) -> int:
        """In how many steps for each of the journey the response is kept beside it; 1: it is not."""
        return self._finer if self.not_shown and self._kept else 1

    @property
    @remembered
    def fine(self) -> CoupledHistories:
        """The response as it was solved: what is measured, and whether contact is kept, is taken of it."""
        return self.response.histories(self.driven_by.line, self.finer) if self.finer > 1 else self.histories

    def records(self, histories: CoupledHistories) -> dict[str, FloatArray]:
        """Name records as in a result, each (place, time): deflections in all, the rest about steady travel."""
        return {
            "contact_force": histories.force.values[0],
            "deflection": histories.deflection.values[0] + self.steady.deflection[:, None],
            "motion": histories.motion.values[0],
            "acceleration": histories.acceleration.values[0],
        }

    def turned(self, finer: int = 1) -> dict[str, FloatArray]:
        """Give records in steps of the journey or finer ones as in a result, with what contacts see."""
        journey, histories = self.journey, self.histories if finer == 1 else self.fine
        seen = self.excitation.elevation(
            journey.speed * (journey.time_step / finer) * np.arange(journey.samples * finer)
        )
        return {name: turned(values) for name, values in (*self.records(histories).items(), ("roughness", seen))}

    @property
    def findings(self) -> list[find.Finding]:
        """What is to be known about it."""
        journey, profile, vehicle = self.journey, self.profile, self.system.vehicle
        driven_by, excitation, motion = self.driven_by, self.excitation, self.histories.motion
        force = self.fine.force.values[0]
        load, step = self.steady.load, journey.time_step / self.finer
        lost = (force.min(axis=-1) + load < 0).any()
        return [
            *(find.contact_lost((force + load[:, None]).T, step, vehicle.standing) if lost else []),
            *self.surveyed.findings,
            *find.one_path(profile.one_path, vehicle.paths, vehicle.across),
            *find.not_decayed("vehicle's motion", motion.wrapped, motion.values),
            *find.beyond_truncation(self.truncation.frequency, self.truncation.error),
            *find.unresolved(self.left_out, driven_by.step, stated=journey.solved_step is not None),
            *find.jumps_at_the_start(_jump(excitation, vehicle)),
            *self.not_shown,
            *find.profile_ends(_guessed(self), excitation.guessed),
            *find.graded(*excitation.slopes),
        ]


def ride(
    guideway: Guideway, vehicle: Vehicle, profile: Profile, journey: Journey, *, progress: Progress = silent
) -> Ride:
    """Drive a vehicle over a rough road.

    Parameters
    ----------
    guideway : Guideway
        The road or track.
    vehicle : Vehicle
        The vehicle.
    profile : Profile
        Elevation of the road; must cover the journey of every contact.
    journey : Journey
        How the vehicle travels.
    progress : callable
        Called with the name of a stage and the fraction of it that is done.

    Returns
    -------
    Ride
        To be asked for records and findings.

    Raises
    ------
    ValueError
        If the profile does not cover the journey, or memory does not hold the result.
    SolveError
        If vehicle and guideway are unstable together, or a result is not finite.
    """
    progress("profile", 0.0)
    excitation = excitation_of(profile, vehicle, journey)
    system = System.of(guideway, vehicle, journey.speed)
    progress("steady state", 0.0)
    driving = _driving(excitation, journey)
    line = line_of(journey, vehicle, fading=excitation.fading / journey.speed)
    line = at_first(system, driving, line, journey.solved_step, SAMPLING.road)
    surveyed = survey(system, soon=looked_at(line, journey.truncation, driving.images))
    driven_by, response, histories, left_out = _solved(system, driving, line, journey, progress)
    return Ride(
        system=system,
        profile=profile,
        journey=journey,
        excitation=excitation,
        surveyed=surveyed,
        driven_by=driven_by,
        response=response,
        histories=histories,
        left_out=left_out,
    )


def in_steps_of_the_band(profile: Profile, journey: Journey) -> Journey:
    """Observe a journey in steps that show what is in the road, and no finer.

    Parameters
    ----------
    profile : Profile
        The road.
    journey : Journey
        How the vehicle travels.

    Returns
    -------
    Journey
        The same in other steps; as it is where the road does not tell how short its waves are.
    """
    shortest = shortest_wave(profile, SAMPLING.shorter)
    if shortest is None:
        return journey
    step, duration = min(SAMPLING.observed * shortest / journey.speed, SAMPLING.coarsest), journey.duration
    samples = sixteenths(math.ceil(max(duration / step, SAMPLING.at_least)))
    return replace(journey, time_step=duration / samples)


def excitation_of(profile: Profile, vehicle: Vehicle, journey: Journey) -> Excitation:
    """Let a vehicle look at a profile on a journey.

    Parameters
    ----------
    profile : Profile
        Elevation of the road.
    vehicle : Vehicle
        The vehicle.
    journey : Journey
        How it travels.

    Returns
    -------
    Excitation
        To be asked at any distance travelled.
    """
    touch = recalled(vehicle, "touch", lambda: Touch(**vehicle.touching))
    return excite(profile, touch, start=journey.start, distance=journey.distance, blend=journey.blend)


def _solved(
    system: System, driving: Driving, line: Line, journey: Journey, progress: Progress
) -> tuple[Excited, Response, CoupledHistories, float]:
    """Solve, for more where what is left out matters to a channel's largest value; and say how much it does."""
    wanted = SAMPLING.road
    before: Excited | None = None
    for _ in range(SAMPLING.rounds):
        progress("sampling", 0.0)
        # One part, one case.
        driven_by = excited(
            system,
            driving,
            line,
            truncation=journey.truncation,
            solved_step=journey.solved_step,
            wanted=wanted,
            after=before,
        )
        response = solve(
            system, driven_by.omega, driven_by.spectra, truncation=driven_by.truncation, progress=progress
        )
        progress("histories", 0.0)
        histories = response.histories(driven_by.line)
        left_out = unresolved(driven_by, response, histories)
        many = driven_by.line.solved * len(system.vehicle.contacts) > SAMPLING.many
        tolerated = SAMPLING.tolerated * (SAMPLING.less if many else 1.0)
        if driven_by.finest or left_out <= tolerated:
            break
        less = wanted.negligible * max(0.5 * tolerated / left_out, 0.01)
        wanted, before = replace(wanted, negligible=less, smooth=less), driven_by
    return driven_by, response, histories, left_out


def _driving(excitation: Excitation, journey: Journey) -> Driving:
    """Tell of a road in time."""
    speed, short = journey.speed, excitation.short_waves
    if short is not None:
        short = short._replace(energy=short.energy / speed, whole=short.whole / speed)
    return Driving(
        given=lambda line: Given(excitation.elevation(speed * line.instants)),
        step=excitation.station / speed,
        finest=excitation.closest / speed,
        short=short,
        remembers=excitation,
    )


def _jump(excitation: Excitation, vehicle: Vehicle) -> float:
    """Largest step at t = 0 that a contact with a dashpot, or a rigid one, meets [m]."""
    if excitation.blend:
        return 0.0
    hard = (vehicle.dashpots > 0) | np.isinf(vehicle.springs)
    return float(np.abs(excitation.elevation(np.zeros(1))[:, 0] * hard).max())


def _guessed(ride: Ride) -> float:
    """Estimate what guesses past the end of the profile change, relative to a channel's largest value."""
    excitation, journey, driven_by = ride.excitation, ride.journey, ride.driven_by
    if excitation.guessed <= 0:
        return 0.0
    off = excitation.doubt(journey.speed * driven_by.line.instants)
    known = max(int((journey.distance - excitation.guessed) / (journey.speed * journey.time_step)), 1)
    return past_the_end(ride.system, driven_by, Given(off), ride.histories, known)


def line_of(journey: Journey, vehicle: Vehicle, *, fading: float = 0.0) -> Line:
    """Line of frequencies that stands for a journey, with padding for the vehicle's motion to die away.

    Parameters
    ----------
    journey : Journey
        How the vehicle travels.
    vehicle : Vehicle
        The vehicle.
    fading : float
        Time within which the road fades out, at least [s].

    Returns
    -------
    Line
        With the journey's samples.

    Raises
    ------
    ValueError
        If memory would not hold the result.
    """
    asked = (journey.samples, journey.time_step, fading, Truncation.stated(journey.truncation).width)

    def make() -> Line:
        samples, time_step, _, cut = asked
        dying = max(-float(vehicle.poles.real.max()), 0.0) if vehicle.poles.size else 0.0
        return Line(samples=samples, time_step=time_step, dying=dying, fading=fading, cut=cut)

    def fits(known: Line) -> bool:
        return (known.samples, known.time_step, known.fading, known.cut) == asked

    line = latest(vehicle, "line", fits, make)
    require_record(line, len(vehicle.contacts) + len(vehicle.dof_names))
    return line

"""What a case differs by from the same solved finer on a longer record, and whether its findings say so."""

from __future__ import annotations

import json
import time
import traceback
import warnings
from dataclasses import dataclass, field

import numpy as np
import xarray as xr

import movingfrf as mf
from tests.honest.cases import LONGER, Case, case
from tests.honest.exact import exact, has_exact

# Findings of the kind that speaks of such a difference.
CODES = ("not_decayed", "beyond_truncation", "unresolved", "profile_ends")
TOLERATED, WITHIN = 1e-3, 3.0
# What guesses past the end of a profile are off is told by their median; one may be off by more, or be right.
GUESSED, A_GUESS = "profile_ends", 10.0
FALSE_ALARMS = 0.05  # of the cases that are right
# The reference: how much finer; steps from station to station at least, so that of the spline's images two are in;
# steps in all that are not exceeded for these.
FINER, PER_STATION, MOST = 4.0, 5.0, 2**20
ROUNDING = 1e-4  # of the largest channel of its kind

Channels = dict[str, np.ndarray]


@dataclass(frozen=True, kw_only=True)
class Difference:
    size: float = 0.0
    channel: str = "none"
    at: float = 0.0  # share of the record
    share: float = 1.0  # of the channel's largest value in that of the largest channel of its kind

    @property
    def where(self) -> str:
        return "start" if self.at < 0.05 else "end" if self.at > 0.95 else f"{self.at:.2f}"


@dataclass(frozen=True, kw_only=True)
class Outcome:
    number: int
    said: dict[str, str]  # of the case, in words
    finer: Difference = Difference()
    exact: Difference | None = None
    findings: list[dict] = field(default_factory=list)
    solved_step: float = np.nan
    grades: tuple[float, float] = (0.0, 0.0)
    seconds: tuple[float, float] = (0.0, 0.0)
    variants: dict[str, float] = field(default_factory=dict)
    failed: str = ""

    @property
    def difference(self) -> Difference:
        return max(self.finer, self.exact or Difference(), key=lambda each: each.size)

    @property
    def figures(self) -> list[tuple[float, float]]:
        """Between what findings say that differences lie."""
        said = [(found["code"] == GUESSED, found["figure"]) for found in self.findings if found["code"] in CODES]
        return [(0.0, A_GUESS * size) if guess else (size / WITHIN, size * WITHIN) for guess, size in said]

    @property
    def right(self) -> bool:
        return not self.failed and self.difference.size <= TOLERATED

    @property
    def silent(self) -> bool:
        """Wrong by more than is tolerated, and no finding says by how much."""
        size = self.difference.size
        return not (self.right or any(low <= size <= high for low, high in self.figures))

    @property
    def false_alarm(self) -> bool:
        return self.right and bool(self.figures)


def channels(result: xr.Dataset) -> Channels:
    """Histories about the steady state, each contact and degree of freedom a row."""
    return {
        "contact_force": result["contact_force"].to_numpy().T,
        "deflection": (result["deflection"] - result["static_deflection"]).transpose("contact", "time").to_numpy(),
        "motion": result["motion"].to_numpy().T,
        "acceleration": result["acceleration"].to_numpy().T,
    }


def difference(result: Channels, reference: Channels) -> Difference:
    """Largest difference of any channel from the reference at the same instants, over its largest value."""
    worst = Difference()
    for name, truth in reference.items():
        rows = result[name]
        truth = truth[:, : rows.shape[1]]
        sizes = np.abs(truth).max(axis=1)
        for number in np.flatnonzero(sizes > ROUNDING * sizes.max()).tolist():
            off = np.abs(rows[number] - truth[number])
            at = int(off.argmax())
            if off[at] > worst.size * sizes[number]:
                worst = Difference(
                    size=float(off[at] / sizes[number]),
                    channel=f"{name} {number}",
                    at=at / off.size,
                    share=float(sizes[number] / sizes.max()),
                )
    return worst


def compared(drawn: Case, *, variants: bool = False) -> Outcome:
    """Compute a case and its references; with variants, what a wrong one owes to which of its settings."""
    said = {
        **drawn.names,
        "speed": f"{drawn.speed:.1f}",
        "step": f"{1e3 * drawn.time_step:.3g}",
        "duration": f"{drawn.duration:.2f}",
        "ends": "ends" if drawn.ends else "",
    }
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", mf.ValidityWarning)
        try:
            return _compared(drawn, said, variants)
        except Exception as failure:  # a crash is an outcome
            place = traceback.extract_tb(failure.__traceback__)[-1]
            text = f"{type(failure).__name__}: {failure} ({place.name}, line {place.lineno})"
            return Outcome(number=drawn.number, said=said, failed=text)


def _compared(drawn: Case, said: dict[str, str], variants: bool) -> Outcome:
    begun = time.process_time()
    result = drawn.run()
    halfway = time.process_time()
    step, longer = float(result.attrs["solved_step"]), drawn.duration + LONGER
    grade, solution = float(result.attrs["grade"]), channels(result)
    stations = max(np.median(np.diff(drawn.onward.stations)) / (PER_STATION * drawn.speed), longer / MOST)
    least = min(step / FINER, float(stations))
    reference = drawn.run(profile=drawn.onward, solved_step=least, duration=longer)
    finer = difference(solution, channels(reference))
    truth = difference(solution, exact(drawn, grade)) if has_exact(drawn) else None
    done = time.process_time()
    told = {}
    if variants and max(finer.size, truth.size if truth else 0.0) > TOLERATED:
        tried = {
            "finer": {"solved_step": least},
            "onward": {"profile": drawn.onward, "solved_step": step},
            "longer": {"profile": drawn.onward, "duration": longer, "solved_step": step},
            "untruncated": {"truncation": 1e6, "solved_step": step},
        }
        told = {name: difference(solution, channels(drawn.run(**some))).size for name, some in tried.items()}
    return Outcome(
        number=drawn.number,
        said=said,
        finer=finer,
        exact=truth,
        solved_step=step,
        grades=(grade, float(reference.attrs["grade"])),
        seconds=(halfway - begun, done - halfway),
        findings=json.loads(result.attrs["findings"]),
        variants=told,
    )


def outcome(number: int, seed: int, variants: bool) -> Outcome:
    """Draw a case and compare it."""
    return compared(case(number, seed), variants=variants)

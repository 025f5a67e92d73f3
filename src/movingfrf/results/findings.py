"""Where a result leaves the assumptions it was computed under, in plain words."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from movingfrf._basics.arrays import FloatArray
from movingfrf._basics.checks import Finding as Finding
from movingfrf._basics.checks import warned
from movingfrf._basics.wording import Standing


@dataclass(frozen=True, slots=True, kw_only=True)
class Thresholds:
    """From where on something is worth a word: conventions, all of them."""

    near_critical: float = 0.8  # share of the critical speed
    # What may wrap around from the end of the padding, and what a truncation may change, relative to a record.
    tolerated: float = 1e-3
    # A record is as large as this share of the largest of several at least: one that hardly moves is no matter.
    smallest: float = 1e-3
    # Share of an output, relative L2, that may lie above the Nyquist frequency of its record.
    at_nyquist: float = 0.01
    grade: float = 5e-3  # mean slope of a road
    jump: float = 1e-6  # of the elevation under a contact [m]
    sets_out: float = 1.5e-2  # slope of its first metres, beyond the grade


THRESHOLDS = Thresholds()


def contact_lost(total_force: FloatArray, time_step: float, contacts: Standing) -> list[Finding]:
    """Total contact forces, shape (time, contact) [N], that turn to tension, which no contact can carry."""
    lifted = total_force < 0
    lost = np.flatnonzero(lifted.any(axis=0)).tolist()
    if not lost:
        return []
    up_to = "up to " if len(lost) > 1 else ""
    return [
        Finding(
            "contact_lost",
            f"{contacts.listed(lost)} would lift off the {contacts.ground} during {up_to}"
            f"{lifted.mean(axis=0).max():.2%} of the time, first at "
            f"{lifted.any(axis=1).argmax() * time_step:.3f} s; the linear contact pulls there instead, so forces "
            "and accelerations around those instants are not to be relied on",
        )
    ]


def near_critical(speed: float, critical_speed: float) -> list[Finding]:
    """Speed [m/s] close to or above the critical speed [m/s]."""
    if speed < THRESHOLDS.near_critical * critical_speed:
        return []
    where = "above" if speed > critical_speed else "close to"
    return [
        Finding(
            "critical_speed",
            f"the speed of {speed:.4g} m/s is {where} the critical speed of {critical_speed:.4g} m/s: deflections "
            "depend strongly on speed and damping there",
        )
    ]


def one_path(known: bool, paths: Sequence[int], across: FloatArray) -> list[Finding]:
    """Say that contacts on several paths, or at several places across [m], meet a profile known along one path."""
    abreast = max(len(set(paths)), len(set(across.tolist())))
    if not known or abreast == 1:
        return []
    return [
        Finding(
            "one_path",
            f"the profile is known along one path, but contacts travel on {abreast} side by side: all of them meet "
            "the same elevation, and a vehicle that is alike on both sides does not roll. Elevations with a column "
            "for each path that a contact follows make it; equal columns say that it is meant",
        )
    ]


def not_decayed(name: str, wrapped: FloatArray, values: FloatArray) -> list[Finding]:
    """Compare what wraps around from the end of the padding (*case, port) with records (*case, port, time)."""
    size = np.abs(values).max(axis=-1, initial=0.0)
    size = np.maximum(size, THRESHOLDS.smallest * size.max(initial=0.0))
    left = relative(wrapped, size)
    if left <= THRESHOLDS.tolerated:
        return []
    return [
        Finding(
            "not_decayed",
            f"the {name} has not died away at the end of the padded record; up to {left:.1e} of its largest value "
            "wraps around to the start. More damping, or a longer duration, would let it decay",
            left,
        )
    ]


def relative(part: FloatArray, whole: FloatArray) -> float:
    """Greatest quotient of two sizes; nothing of nothing is nothing."""
    return float(np.divide(part, whole, out=np.zeros_like(whole), where=whole > 0).max(initial=0.0))


def beyond_truncation(truncation: float, error: float) -> list[Finding]:
    """Say what a truncation [Hz] may change, relative to the whole record."""
    if error <= THRESHOLDS.tolerated:
        return []
    return [
        Finding(
            "beyond_truncation",
            f"the guideway counts as rigid beyond {truncation:g} Hz, which may change an output by {error:.1e} of "
            "its root mean square; a higher truncation changes less",
            error,
        )
    ]


def not_shown(shares: FloatArray, names: Sequence[str], time_step: float, *, kept: bool) -> list[Finding]:
    """Shares of outputs, relative L2, above the Nyquist frequency of their record, whose steps are [s].

    Memory may not hold the response as it was solved; then it is not kept.
    """
    share, name = float(shares.max(initial=0.0)), names[int(shares.argmax())]
    if share <= THRESHOLDS.at_nyquist:
        return []
    return [
        Finding(
            "beyond_nyquist",
            f"{share:.1%} of the root mean square of the {name} lies above {0.5 / time_step:g} Hz, which a record "
            f"in steps of {time_step:g} s cannot show. Its values are right; "
            + (
                "measures and spectra are made of the response as it was solved, which is kept beside it"
                if kept
                else "memory does not hold the response as it was solved, so that measures and spectra are made of "
                "the record and miss that part: a finer step would show it"
            ),
        )
    ]


def loads_unresolved(left_out: float, solved_step: float) -> list[Finding]:
    """Say what is left out, relative to a record, although it was solved in steps as fine as are allowed [s]."""
    if left_out <= THRESHOLDS.tolerated:
        return []
    return [
        Finding(
            "unresolved",
            f"steps of {solved_step:.2g} s, the finest that were tried, leave out {left_out:.1e} of the root mean "
            "square of an output, most of it where something begins or ends abruptly",
            left_out,
        )
    ]


def jumps_within_a_step(change: float, time_step: float) -> list[Finding]:
    """Say what it may change, relative to the largest value, that a force jumps within a step [s]."""
    if change <= THRESHOLDS.tolerated:
        return []
    return [
        Finding(
            "jump_within_a_step",
            f"a force jumps between two samples, {time_step:g} s apart, at an instant that they do not tell; "
            f"half a step later changes the deflection by up to {change:.1e} of its largest value. A shorter step "
            "would tell, or a scenario, whose loads are switched at stated instants",
            change,
        )
    ]


def unresolved(figure: float, solved_step: float, *, stated: bool) -> list[Finding]:
    """How much of the largest value may be wrong since no finer step [s] was solved, stated or found."""
    if figure <= THRESHOLDS.tolerated:
        return []
    why = (
        f"the stated step of {solved_step:.3g} s leaves out what the contacts see above that"
        if stated
        else "a profile that begins abruptly is of that kind, and kinks under a dashpot or a rigid contact; "
        "blending in, a footprint or a smoother profile would help"
    )
    return [
        Finding(
            "unresolved",
            f"what the contacts see goes on above {0.5 / solved_step:.3g} Hz, up to which it was solved: outputs "
            f"may be off by {figure:.1e} of their largest value; {why}",
            figure,
        )
    ]


def jumps_at_the_start(jump: float) -> list[Finding]:
    """Step of the road at t = 0 under a dashpot or a rigid contact [m]."""
    if jump <= THRESHOLDS.jump:
        return []
    return [
        Finding(
            "jump_at_the_start",
            f"the profile begins with a step of {1e3 * jump:.3g} mm under a contact with a dashpot, or a rigid "
            "one: its force is unbounded there, and no number for the first instants is right; a blend would help",
            1.0,
        )
    ]


def profile_ends(figure: float, beyond: float) -> list[Finding]:
    """How much of the largest value may be wrong since contacts reach past the end of the profile [m]."""
    if figure <= THRESHOLDS.tolerated:
        return []
    return [
        Finding(
            "profile_ends",
            f"a footprint or a cam reaches {beyond:.3g} m past the end of the profile, where it is guessed: "
            f"the last samples may be off by {figure:.1e} of the largest value; a longer profile, or a shorter "
            "journey, would do without a guess",
            figure,
        )
    ]


def graded(grade: float, slope: float, sets_out: float) -> list[Finding]:
    """Grade that is part of the steady state, mean slope of the road where the journey begins, and at its start."""
    found = []
    if abs(grade) > THRESHOLDS.grade:
        found.append(
            f"the profile begins with a grade of {100 * grade:+.2g} %, on which the vehicle is already travelling: "
            "elevation and motion are about that line; the load transfer of a vehicle on a slope is not part of it"
        )
    elif abs(slope - grade) > THRESHOLDS.grade:
        found.append(
            f"the profile begins with a mean slope of {100 * slope:+.2g} %, onto which the vehicle drives: that "
            "shakes it. With a blend, and 100 m of the profile or more, a grade is part of the steady state"
        )
    if abs(sets_out - grade) > THRESHOLDS.sets_out and abs(sets_out - slope) > THRESHOLDS.grade:
        found.append(
            f"the profile sets out at {100 * sets_out:+.2g} % over its first metres, its grade is "
            f"{100 * grade:+.2g} %: the vehicle drives onto the difference, which shakes it"
        )
    return [Finding("grade", message) for message in found]


def with_more(findings: str, more: Iterable[Finding]) -> str:
    """Add findings to those of a JSON text."""
    return json.dumps([*json.loads(findings), *map(_plain, more)])


def announced(found: Iterable[Finding]) -> str:
    """Warn of every finding, at the line that called the package, and return them all as JSON text."""
    return json.dumps([_plain(finding) for finding in warned(found)])


def _plain(finding: Finding) -> dict[str, str | float]:
    """Leave out a figure that there is not."""
    return {key: value for key, value in finding._asdict().items() if value is not None}

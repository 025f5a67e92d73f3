"""What vibration does to people: frequency weightings, vibration doses, comfort reactions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from movingfrf._basics.arrays import ComplexArray, FloatArray
from movingfrf._basics.checks import Checks, checking
from movingfrf._basics.values import Value
from movingfrf._basics.wording import number
from movingfrf.metrics.loads import check_coupled, samples_before

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True, slots=True, kw_only=True)
class Standard:
    """How ISO 2631-1 judges a weighted vibration: standardised, no tuning."""

    # Limits beyond which the rms alone understates a vibration (6.2.1 and 6.3.3).
    crest_limit: float  # peak over rms
    mtvv_limit: float  # MTVV over rms
    vdv_limit: float  # VDV over rms times the fourth root of the duration
    running: float  # time over which the running rms is taken [s] (6.3.1)
    # Frequency-weighted rms acceleration [m/s²] from and up to which people react so (C.2.3); they overlap.
    reactions: tuple[tuple[str, float, float], ...]
    seated: Mapping[str, float]  # multiplying factors of a seated person's axes for comfort (8.2.2.1)


ISO_2631 = Standard(
    crest_limit=9.0,
    mtvv_limit=1.5,
    vdv_limit=1.75,
    running=1.0,
    reactions=(
        ("not uncomfortable", 0.0, 0.315),
        ("a little uncomfortable", 0.315, 0.63),
        ("fairly uncomfortable", 0.5, 1.0),
        ("uncomfortable", 0.8, 1.6),
        ("very uncomfortable", 1.25, 2.5),
        ("extremely uncomfortable", 2.0, np.inf),
    ),
    seated={
        "seat x": 1.0,
        "seat y": 1.0,
        "seat z": 1.0,
        "seat roll": 0.63,
        "seat pitch": 0.4,
        "seat yaw": 0.2,
        "backrest x": 0.8,
        "backrest y": 0.5,
        "backrest z": 0.4,
        "feet x": 0.25,
        "feet y": 0.25,
        "feet z": 0.4,
    },
)

# Weighting of ISO 2631-1 by the unit of a degree of freedom: vertical vibration of a seat or floor, and rotation.
WEIGHTING_OF = {"m": "Wk", "rad": "We"}


class Weighting(NamedTuple):
    """A frequency weighting: frequencies [Hz] and quality factors of its four filters, and its gain."""

    band: tuple[float, float]  # f1, f2 of the Butterworth limits
    transition: tuple[float, float, float] | None = None  # f3 (inf: none), f4, Q4: from acceleration to velocity
    step: tuple[float, float, float, float] | None = None  # f5, Q5, f6, Q6: from jerk to acceleration
    gain: float = 1.0
    standard: str = "ISO 2631-1"


WEIGHTINGS = {
    "Wk": Weighting((0.4, 100.0), (12.5, 12.5, 0.63), (2.37, 0.91, 3.35, 0.91)),
    "Wd": Weighting((0.4, 100.0), (2.0, 2.0, 0.63)),
    "Wf": Weighting((0.08, 0.63), (np.inf, 0.25, 0.86), (0.0625, 0.80, 0.1, 0.80)),
    "Wc": Weighting((0.4, 100.0), (8.0, 8.0, 0.63)),
    "We": Weighting((0.4, 100.0), (1.0, 1.0, 0.63)),
    "Wj": Weighting((0.4, 100.0), None, (3.75, 0.91, 5.32, 0.91)),
    # Its gain is 0.4 below the step.
    "Wb": Weighting((0.4, 100.0), (16.0, 16.0, 0.55), (2.5, 0.90, 4.0, 0.95), 1.024, "ISO 2631-4"),
}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Comfort(Value):
    """Measures of one weighted acceleration; of a rotation in rad instead of m."""

    weighting: str
    rms: float  # [m/s²]
    peak: float  # [m/s²]
    mtvv: float  # greatest running rms over one second [m/s²]
    vdv: float  # vibration dose value [m/s^1.75]
    duration: float  # [s]
    bias: float = 0.0  # what was taken out of a recording: half-way through it [m/s²] …
    drift: float = 0.0  # … and its rise [m/s³]

    def told(self) -> list[tuple[str, str]]:
        """Tell the measures with their units, in few digits, and what the standard makes of them."""
        rms = f"{number(self.rms)} {self._unit('/s²')}"
        if self.rms and self._unit("") == "m" and self.weighting != "Wf":
            rms += f": {', or '.join(self.reactions)}"
        lines = [
            ("weighting", f"{self.weighting}, {WEIGHTINGS[self.weighting].standard}"),
            ("rms", rms),
            ("peak", f"{number(self.peak)} {self._unit('/s²')}"),
            ("crest factor", number(self.crest_factor)),
            ("MTVV", f"{number(self.mtvv)} {self._unit('/s²')}"),
            ("VDV", f"{number(self.vdv)} {self._unit('/s^1.75')}"),
            ("duration", f"{self.duration:g} s"),
        ]
        if self.exceeded:
            lines.append(("understated", f"by the rms alone, says {' and '.join(self.exceeded)}"))
        return lines + ([("taken out", self.taken_out)] if self.taken_out else [])

    def _unit(self, per: str) -> str:
        return ("rad" if self.weighting == WEIGHTING_OF["rad"] else "m") + per

    @property
    def taken_out(self) -> str:
        """What was taken out of a recorded acceleration, in words; empty of a computed one."""
        if not (self.bias or self.drift):
            return ""
        unit = self._unit("/s²")
        words = f"a bias of {self.bias:.3g} {unit} and a drift of {self.drift:.3g} {unit} per second were taken out"
        slowest = 1 / WEIGHTINGS[self.weighting].band[0]
        short = f"; in less than {slowest:.3g} s {self.weighting} cannot tell them from vibration"
        return words + (short if self.duration < slowest else "")

    @property
    def crest_factor(self) -> float:
        """Peak over rms."""
        return self.peak / self.rms if self.rms else float("nan")

    @property
    def exceeded(self) -> tuple[str, ...]:
        """Criteria of ISO 2631-1 by which the rms alone understates the vibration: `crest`, `MTVV`, `VDV`."""
        if not self.rms:
            return ()
        ratios = {
            "crest": self.crest_factor / ISO_2631.crest_limit,
            "MTVV": self.mtvv / self.rms / ISO_2631.mtvv_limit,
            "VDV": self.vdv / (self.rms * self.duration**0.25) / ISO_2631.vdv_limit,
        }
        return tuple(name for name, ratio in ratios.items() if ratio > 1)

    @property
    def reactions(self) -> tuple[str, ...]:
        """Likely reactions of passengers in public transport to such an rms, which overlap."""
        return comfort_reactions(self.rms)


def weighting(name: str, frequency: ArrayLike) -> ComplexArray:
    """Evaluate a frequency weighting of whole-body vibration.

    A product of rational functions of p = 2πi f,

        (p/ω₁)²            1             1 + p/ω₃       1 + p/(Q₅ω₅) + (p/ω₅)²  ω₅²
        ─────── · ──────────────── · ──────────── · ──────────────────────── · ───
         B(p,ω₁)      B(p,ω₂)         N(p,ω₄,Q₄)     1 + p/(Q₆ω₆) + (p/ω₆)²     ω₆²

    with N(p, ω, Q) = 1 + p/(Qω) + (p/ω)² and B(p, ω) = N(p, ω, 1/√2): band limits, transition from acceleration to
    velocity, upward step.

    Parameters
    ----------
    name : str
        `Wk` (vertical, seat and floor), `Wd` (horizontal), `Wf` (vertical, motion sickness), `Wc` (horizontal,
        backrest), `We` (rotational), `Wj` (vertical, recumbent person's head), or `Wb` (vertical, rail vehicles).
    frequency : array_like, shape (*s)
        Frequency [Hz].

    Returns
    -------
    ndarray, shape (*s), complex
        Factor on the spectrum of an acceleration, dimensionless.

    Raises
    ------
    ValueError
        If there is no such weighting, or a frequency is not finite.

    References
    ----------
    ISO 2631-1:1997, Annex A; ISO 2631-4:2001 and ISO 8041 (`Wb`).

    Examples
    --------
    >>> abs(weighting("Wk", [1.0, 10.0, 100.0])).round(4)
    array([0.4825, 0.9884, 0.0887])
    """
    with checking() as check:
        name = check.choice("weighting", name, WEIGHTINGS)
        f = check.array("frequency", frequency, "Hz", None)
    chosen, p = WEIGHTINGS[name], 2j * np.pi * f
    low, high = chosen.band
    factor = chosen.gain * (p / (2 * np.pi * low)) ** 2 / _second_order(p, low) / _second_order(p, high)
    if chosen.transition:
        first, f4, q4 = chosen.transition
        factor = factor * (1 + p / (2 * np.pi * first)) / _second_order(p, f4, q4)
    if chosen.step:
        f5, q5, f6, q6 = chosen.step
        factor = factor * _second_order(p, f5, q5) / _second_order(p, f6, q6) * (f5 / f6) ** 2
    return factor


@lru_cache(maxsize=8)
def _factors(name: str, samples: int, time_step: float) -> ComplexArray:
    """Evaluate a weighting at the frequencies of a record; kept, since many records are alike."""
    import scipy.fft

    factors = weighting(name, scipy.fft.rfftfreq(samples, time_step))
    factors.setflags(write=False)
    return factors


def weighted(acceleration: ArrayLike, time_step: float, name: str = "Wk", *, recorded: bool = False) -> FloatArray:
    """Weight acceleration histories.

    In the frequency domain, where a weighting is exact, behind a padding in which it forgets.

    Parameters
    ----------
    acceleration : array_like, shape (time, *s)
        Accelerations [m/s² or rad/s²], zero before and after.
    time_step : float
        Step in time [s].
    name : str
        Name of the weighting; see `weighting`.
    recorded : bool
        Whether they were measured. A recording does not begin as a step from zero: the straight line that fits it
        best, which is gravity, bias and drift of the sensor, is then taken out first.

    Returns
    -------
    ndarray, shape (time, *s)
        Weighted accelerations [m/s² or rad/s²].

    Raises
    ------
    ValueError
        If there is no such weighting, the step is not positive or values are not finite.

    Examples
    --------
    >>> time = np.arange(0.0, 40.0, 1e-3)
    >>> hum = weighted(np.sin(2 * np.pi * 10 * time), 1e-3, "Wk")
    >>> round(float(np.sqrt(2) * hum[20_000:].std()), 4)
    0.9884
    """
    with checking() as check:
        name = check.choice("weighting", name, WEIGHTINGS)
        time_step = check.positive("time_step", time_step, "s")
        values, shape = _histories(check, "acceleration", acceleration, "m/s²")
    if recorded:
        values, _, _ = _without_line(values, time_step)
    return weighted_rows(values.T, time_step, [name] * values.shape[1]).T.reshape(shape)


def weighted_rows(rows: FloatArray, time_step: float, names: Sequence[str]) -> FloatArray:
    """Weight histories that have been checked, (channel, time), each with a weighting of its own; as `weighted`."""
    import scipy.fft

    # What is left of a weighting's memory at the end of the padding [1e-15 to 1e-7].
    forgotten = 1e-9
    # The slowest pole is that of the Butterworth high-pass: ω₁/√2.
    lowest = min(WEIGHTINGS[name].band[0] for name in names)
    memory, samples = -np.log(forgotten) * np.sqrt(2) / (2 * np.pi * lowest), rows.shape[1]
    padded = scipy.fft.next_fast_len(samples + int(np.ceil(memory / time_step)), real=True)
    spectra = scipy.fft.rfft(rows, padded)
    for spectrum, name in zip(spectra, names, strict=True):
        spectrum *= _factors(name, padded, time_step)
    found: FloatArray = scipy.fft.irfft(spectra, padded, overwrite_x=True)[:, :samples]
    return found


def running_rms(
    values: ArrayLike, time_step: float, window: float = ISO_2631.running, *, since: float = 0.0
) -> FloatArray:
    """Root mean square over the time just past; before what is measured there was nothing.

    Parameters
    ----------
    values : array_like, shape (time, *s)
        Histories, of any quantity [any unit].
    time_step : float
        Step in time [s].
    window : float
        Time over which the mean is taken [s].
    since : float
        Seconds to leave out at the start [s].

    Returns
    -------
    ndarray, shape (time, *s)
        Running rms of what is left [unit of the histories].

    Raises
    ------
    ValueError
        If a time is not positive, values are not finite, or nothing is left of them.

    References
    ----------
    ISO 2631-1:1997, 6.3.1, equation (2).
    """
    with checking() as check:
        time_step = check.positive("time_step", time_step, "s")
        window = check.positive("window", window, "s")
        histories, shape = _histories(check, "values", values, "any unit")
    squares = histories[samples_before(since, time_step, len(histories)) :] ** 2
    energy = np.concatenate([np.zeros_like(squares[:1]), np.cumsum(squares, axis=0)])
    steps = max(round(window / time_step), 1)
    first = np.maximum(np.arange(1, len(energy)) - steps, 0)
    # Differences of a sum may come out just below zero.
    return np.sqrt(np.maximum(energy[1:] - energy[first], 0.0) / steps).reshape(-1, *shape[1:])


def vibration_dose(values: ArrayLike, time_step: float, *, since: float = 0.0) -> FloatArray:
    """Vibration dose value (∫ a⁴ dt)^¼, which weighs shocks more than an rms does.

    Parameters
    ----------
    values : array_like, shape (time, *s)
        Weighted accelerations [m/s² or rad/s²].
    time_step : float
        Step in time [s].
    since : float
        Seconds to leave out at the start [s].

    Returns
    -------
    ndarray, shape (*s)
        Dose value [m/s^1.75 or rad/s^1.75].

    Raises
    ------
    ValueError
        If the step is not positive, values are not finite, or nothing is left of them.

    References
    ----------
    ISO 2631-1:1997, 6.3.2, equation (5).
    """
    with checking() as check:
        time_step = check.positive("time_step", time_step, "s")
        histories, shape = _histories(check, "values", values, "m/s²")
    felt = histories[samples_before(since, time_step, len(histories)) :]
    return np.asarray((np.sum(felt**4, axis=0) * time_step) ** 0.25).reshape(shape[1:])


def comfort(result: xr.Dataset, dof: str | int, *, weighting: str = "Wk", since: float = 0.0) -> Comfort:
    """Measure how a degree of freedom would feel to somebody who moves with it.

    Parameters
    ----------
    result : xarray.Dataset
        The coupled response of a vehicle, from `simulate`, `cdfm` or `sim`.
    dof : str or int
        Name or number of the degree of freedom.
    weighting : str
        Name of the frequency weighting: `Wk` for vertical motion of a seat or floor, `We` for a rotation; see
        `weighting`.
    since : float
        Seconds to leave out at the start [s], after weighting.

    Returns
    -------
    Comfort
        Weighted rms, peak, MTVV and VDV; as properties the crest factor, the criteria by which the rms alone
        understates the vibration, and the likely reactions.

    Raises
    ------
    ValueError
        If there is no such degree of freedom or weighting, or nothing is left.

    References
    ----------
    ISO 2631-1:1997, Mechanical vibration and shock: evaluation of human exposure to whole-body vibration.

    Examples
    --------
    >>> import movingfrf as mf
    >>> car = mf.quarter_car(body_mass=400.0, wheel_mass=40.0, suspension_stiffness=2e4,
    ...                      suspension_damping=1.5e3, tyre_stiffness=2e5)
    >>> road = mf.realise(mf.IsoRoad.of_class("C"), length=250.0, seed=1)
    >>> result = mf.simulate(mf.RigidGuideway(), car, road, speed=20.0, duration=10.0)
    >>> felt = mf.comfort(result, "body")
    >>> felt.reactions
    ('fairly uncomfortable', 'uncomfortable')
    """
    with checking() as check:
        weighting = check.choice("weighting", weighting, WEIGHTINGS)
        result = check_coupled(check, result)
        if not check.faults:
            number = check.one_of("dof", dof, result.dof.values.tolist())
    step = float(result.attrs["time_step"])
    return vibration(result.acceleration.values[:, number], step, weighting, since=since)


def whole_body_vibration(
    acceleration: ArrayLike, time_step: float, weighting: str = "Wk", *, since: float = 0.0
) -> Comfort:
    """Measure a recorded acceleration as `comfort` measures a result's.

    A recording does not begin as a step from zero: the straight line that fits it best is taken out first, which is
    gravity, bias and drift of the sensor. What is left is zero before and after.

    Parameters
    ----------
    acceleration : array_like, shape (time,)
        Acceleration of seat, floor or backrest along one axis [m/s² or rad/s²]; at least three samples.
    time_step : float
        Step in time [s].
    weighting : str
        Name of the frequency weighting.
    since : float
        Seconds to leave out at the start [s], after weighting: the weighting knows what went before.

    Returns
    -------
    Comfort
        As `comfort` returns it, with the `bias` [m/s²] and the `drift` [m/s³] that were taken out, as properties in
        words `taken_out`. A record shorter than the slowest wave that the weighting passes (Wk: 2.5 s) cannot tell
        them from vibration, and the words say so.

    Raises
    ------
    ValueError
        If there is no such weighting, the step is not positive, there is not one finite history of at least three
        samples, or nothing of it is left.

    References
    ----------
    ISO 2631-1:1997, Mechanical vibration and shock: evaluation of human exposure to whole-body vibration.

    Examples
    --------
    >>> time = np.arange(0.0, 60.0, 1e-3)
    >>> found = whole_body_vibration(9.81 + 0.5 * np.sin(2 * np.pi * 8 * time), 1e-3, "Wk")
    >>> round(found.rms, 3), found.exceeded, round(found.bias, 3)
    (0.366, (), 9.81)
    """
    with checking() as check:
        history = check.array("acceleration", acceleration, "m/s²", (None,))
        time_step = check.positive("time_step", time_step, "s")
        if not check.faults and history.size < 3:
            check.refuse("acceleration", f"must hold at least three samples [m/s²], got {history.size}")
    left, bias, drift = _without_line(history, time_step)
    found = vibration(left, time_step, weighting, since=since)
    return replace(found, bias=float(bias), drift=float(drift))


def vibration(acceleration: FloatArray, time_step: float, weighting: str, *, since: float) -> Comfort:
    """Measure an acceleration that begins at rest, as a computed one does: nothing is taken out of it.

    Parameters
    ----------
    acceleration : ndarray, shape (time,)
        Acceleration [m/s² or rad/s²], zero before and after.
    time_step, weighting, since
        As for `whole_body_vibration`.

    Returns
    -------
    Comfort
        Its measures.
    """
    first = samples_before(since, time_step, np.size(acceleration))
    return felt(weighted(acceleration, time_step, weighting)[first:], time_step, weighting)


def felt(values: FloatArray, time_step: float, weighting: str) -> Comfort:
    """Measure a weighted acceleration.

    Parameters
    ----------
    values : ndarray, shape (time,)
        Weighted acceleration [m/s² or rad/s²].
    time_step : float
        Step in time [s].
    weighting : str
        Name of the weighting.

    Returns
    -------
    Comfort
        Its measures.
    """
    return Comfort(
        weighting=weighting,
        rms=float(np.sqrt(np.mean(values**2))),
        peak=float(np.abs(values).max()),
        mtvv=float(running_rms(values, time_step).max()),
        vdv=float(vibration_dose(values, time_step)),
        duration=values.size * time_step,
    )


def comfort_reactions(rms: float) -> tuple[str, ...]:
    """Name the likely reactions of passengers in public transport, which overlap.

    Parameters
    ----------
    rms : float
        Frequency-weighted rms acceleration, or total of several axes [m/s²].

    Returns
    -------
    tuple of str
        One reaction, or two neighbouring ones.

    Raises
    ------
    ValueError
        If the rms is negative.

    References
    ----------
    ISO 2631-1:1997, C.2.3.

    Examples
    --------
    >>> comfort_reactions(0.4), comfort_reactions(0.9)
    (('a little uncomfortable',), ('fairly uncomfortable', 'uncomfortable'))
    """
    with checking() as check:
        rms = check.not_negative("rms", rms, "m/s²")
    return tuple(name for name, least, most in ISO_2631.reactions if least <= rms < most)


def _second_order(p: ComplexArray, frequency: float, quality: float = np.sqrt(0.5)) -> ComplexArray:
    ratio = p / (2 * np.pi * frequency)
    return 1 + ratio / quality + ratio**2


def _without_line(values: FloatArray, time_step: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Histories (time, …) without the straight line that fits each best, its middle and its slope."""
    time = time_step * (np.arange(len(values)) - 0.5 * (len(values) - 1))
    middle, slope = values.mean(axis=0), time @ values / max(float(time @ time), time_step**2)
    return values - middle - np.multiply.outer(time, slope), middle, slope


def _histories(check: Checks, name: str, values: ArrayLike, unit: str) -> tuple[FloatArray, tuple[int, ...]]:
    """Histories side by side (time, channel), and the shape in which they came."""
    before = len(check.faults)
    array = check.array(name, values, unit, None)
    if len(check.faults) > before:
        return np.ones((1, 1)), (1,)
    if not array.size or not array.ndim:
        check.refuse(name, f"must hold at least one sample, in a first axis over time, got shape {array.shape}")
        return np.ones((1, 1)), array.shape
    return array.reshape(len(array), -1), array.shape

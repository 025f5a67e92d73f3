"""The stationary response to a random road, without realising one: spectral densities and what follows from them.

The elevations under the contacts i and j have the cross-spectral density

    S_ij(f) = G_d(n)/v · γ_ij(n) · e^{iω(x_i − x_j)/v},   n = f/v,

since a contact ahead meets the road earlier; γ_ij is the coherence of the paths that they follow. With a factor
γ = L Lᵀ over the paths, a response with the transfer functions H has the density Σ_c |H e^{iωx/v} L_c|² G_d/v: one
solution per path, and no matrix of cross-spectra.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from numbers import Real
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from movingfrf._basics.arrays import ComplexArray, FloatArray, require_memory
from movingfrf._basics.checks import Checks, SolveError, checking, plain, shown
from movingfrf._basics.progress import Progress, silent
from movingfrf.guideways.guideway import Guideway, require_guideway, told
from movingfrf.metrics.comfort import WEIGHTING_OF
from movingfrf.metrics.loads import load_coefficient
from movingfrf.response.batches import BATCH, unthreaded
from movingfrf.response.quadrature import Lines, Unresolved, resolved
from movingfrf.response.solve import solve
from movingfrf.response.statistics import lift_off, lifting_off, peak_factor, spectral_rate
from movingfrf.response.survey import Survey, survey
from movingfrf.response.system import System
from movingfrf.response.transfer import coordinates
from movingfrf.results.findings import Finding
from movingfrf.results.labels import RANDOM_QUANTITIES, attributes, labelled, turned
from movingfrf.roughness.excitation import Touch
from movingfrf.roughness.spectra.coherence import Coherence
from movingfrf.roughness.spectra.spectrum import Spectrum, require_spectrum
from movingfrf.vehicles.vehicle import Vehicle, require_vehicle

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True, slots=True, kw_only=True)
class Tolerances:
    """What counts as rounding, as undamped and as too much; in brackets, between what each number is safe."""

    # A variance that is this small a share of a comparable one is rounding.
    rounding: float = 1e-20  # [1e-25 to 1e-18]
    # Negative eigenvalues of a matrix of coherences up to this size are rounding, and so is what it lacks of being
    # symmetric and 1 on its diagonal.
    semidefinite: float = 1e-9  # [1e-12 to 1e-7]
    # Damping ratio below which a resonance is too sharp to be resolved; it gives the reason of a refusal only.
    undamped: float = 1e-9  # [1e-12 to 1e-7]
    # Share of the variance of a contact force that may lie in the highest tenth of the band.
    at_the_end: float = 0.01  # [a convention]
    # Powers of the frequency whose integrals the statistics need.
    powers: tuple[int, ...] = (0, 2, 4)  # [a convention]


TOLERANCES = Tolerances()


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Ensemble:
    """All roads of a spectrum, under a vehicle."""

    vehicle: Vehicle
    spectrum: Spectrum
    coherence: Coherence | float
    speed: float

    def amplitudes(self, frequency: FloatArray) -> ComplexArray:
        """Elevation under the contacts, one case per independent part of the road [m/√Hz].

        Shape (case, contact, frequency); the cases' products with their own conjugates add up to S_ij.
        """
        n = frequency / self.speed
        size = np.sqrt(self.spectrum.density(n) / self.speed)
        _, path = np.unique(self.vehicle.paths, return_inverse=True)
        return size * Touch(**self.vehicle.touching).waves(2 * np.pi * n) * self._factor(n)[:, path]

    def _factor(self, spatial_frequency: FloatArray) -> FloatArray:
        """L of γ = L Lᵀ, shape (case, path, frequency)."""
        paths = np.array(self.vehicle.paths)
        across = np.array([self.vehicle.across[paths == path].mean() for path in np.unique(paths)])
        if len(across) == 1:
            return np.ones((1, 1, spatial_frequency.size))
        if isinstance(self.coherence, float):
            same = np.where(np.eye(len(across), dtype=bool), 1.0, self.coherence)
            shared: FloatArray = np.broadcast_to(same, (spatial_frequency.size, *same.shape))
        else:
            shared = _matrices(self.coherence, spatial_frequency, across)
        values, vectors = np.linalg.eigh(shared)
        if values.min() < -TOLERANCES.semidefinite * len(across):
            n = spatial_frequency[values.min(axis=1).argmin()]
            raise ValueError(
                "coherence must be positive semidefinite over the paths of the vehicle, but at "
                f"{n:.4g} cycle/m its matrix has the eigenvalue {values.min():.3g}: no road can have it"
            )
        return np.transpose(vectors * np.sqrt(np.maximum(values, 0.0))[:, None, :], (2, 1, 0))


@unthreaded
def random_response(
    guideway: Guideway,
    vehicle: Vehicle,
    spectrum: Spectrum,
    *,
    speed: float,
    coherence: Coherence | float | None = None,
    exposure: float = 600.0,
    frequency: ArrayLike | None = None,
    progress: Progress = silent,
) -> xr.Dataset:
    """Stationary response of vehicle and road to a random road, in closed form from its spectrum.

    Parameters
    ----------
    guideway : Guideway
        The road or track.
    vehicle : Vehicle
        The vehicle.
    spectrum : IsoRoad or any Spectrum
        One-sided spectrum of the elevation, the same for all paths.
    speed : float
        Speed [m/s].
    coherence : Coherence or float, optional
        What the paths have in common: `IsotropicCoherence()` for one, or a constant ratio of cross-spectrum to
        spectrum, 1.0 for the same road on all paths, 0.0 for roads without anything in common. Needed where the
        contacts follow several paths; the distance between two of them is that of the contacts that follow them.
    exposure : float
        Duration for which the largest value is expected [s].
    frequency : array_like, shape (frequency,), optional
        Frequencies at which spectral densities are wanted [Hz]. By default those that the integrals need: then a
        moment ∫ fᵏ S df is the sum of fᵏ S · `bandwidth`. Statistics do not depend on this choice.
    progress : callable
        Called with the name of a stage and the fraction of it that is done.

    Returns
    -------
    xarray.Dataset
        For each of `contact_force`, `deflection` (contact), `motion`, `acceleration` (dof) and `roughness`
        (contact), all about the steady state: `…_density` (frequency, …), one-sided, per Hz, zero outside the band
        of the spectrum; `…_rms`; `…_crossing_rate`, upcrossings of zero per second, √(m₂/m₀); `…_peak_rate`,
        maxima per second, √(m₄/m₂); `…_irregularity`, their quotient; `…_expected_peak`, the mean of the largest
        value within the exposure on one side of the steady state, not of the largest magnitude. Also
        `static_load`, `static_deflection`, `dynamic_load_coefficient`, `lift_off_share` and `lift_off_rate`
        (contact), and `weighted_acceleration` (dof) after ISO 2631-1. Settings and findings in the attributes.

    Raises
    ------
    ValueError
        If a value is impossible, a coherence is missing or none that a road can have, or memory does not hold the
        result.
    SolveError
        If vehicle and guideway are unstable together, or a vibration without damping has no finite mean square.

    Warns
    -----
    ValidityWarning
        If contact is likely to be lost, the speed is near or above critical, or the contact force has content up to
        the end of the spectrum's band.

    References
    ----------
    D. E. Newland, An introduction to random vibrations, spectral and wavelet analysis, 3rd ed., Longman, 1993.
    S. O. Rice, Mathematical analysis of random noise, Bell System Technical Journal 23 (1944), 24 (1945).
    A. G. Davenport, Note on the distribution of the largest value of a random function with application to gust
    loading, Proceedings of the Institution of Civil Engineers 28 (1964).

    Examples
    --------
    >>> import movingfrf as mf
    >>> road = mf.track(mf.EulerBernoulliBeam(bending_stiffness=1.573e7, mass=711.9),
    ...                 mf.Spring(stiffness=8.0e6, damping=3.0e4))
    >>> truck = mf.quarter_car(body_mass=8900.0, wheel_mass=1100.0, suspension_stiffness=1e6,
    ...                        suspension_damping=3e4, tyre_stiffness=3.5e6)
    >>> found = mf.random_response(road, truck, mf.IsoRoad.of_class("B"), speed=20.0)
    >>> round(found.dynamic_load_coefficient.item(), 3)
    0.09
    """
    require_guideway(guideway)
    require_vehicle(vehicle)
    require_spectrum(spectrum)
    with checking() as check:
        speed = check.positive("speed", speed, "m/s")
        exposure = check.positive("exposure", exposure, "s")
        shared = checked_coherence(check, coherence, len(set(vehicle.paths)))
        wanted = None if frequency is None else check.array("frequency", frequency, "Hz", (None,))
        if wanted is not None and not check.faults and not (wanted.size and wanted.min() >= 0):
            least = f"{wanted.min():g} Hz" if wanted.size else "none"
            check.refuse("frequency", f"must hold frequencies of at least zero [Hz], got {least}")
    found = stationary(
        guideway, vehicle, spectrum, speed=speed, coherence=shared, exposure=exposure, progress=progress
    )
    if wanted is None:
        lines = found.lines
        axis: dict[str, ArrayLike] = {**coordinates(vehicle, lines.frequency), "bandwidth": lines.bandwidth}
        shown = lines.density
    else:
        require_memory(BATCH.bytes_per_value * wanted.size * _outputs(vehicle), f"{wanted.size} frequencies")
        axis, shown = coordinates(vehicle, wanted), found.densities(wanted)
    values: dict[str, ArrayLike] = {
        **axis,
        **{f"{name}_density": shown[:, part] for name, part in _parts(vehicle).items()},
        **found.statistics,
    }
    settings = attributes(
        "random",
        "Stationary response of a vehicle and a guideway to a random road",
        speed=speed,
        exposure=exposure,
        spectrum=str(spectrum),
        coherence=repr(shared) if coherence is not None else "one path",
        lowest_frequency=spectrum.band[0] * speed,
        highest_frequency=spectrum.band[1] * speed,
        frequencies=found.lines.frequency.size,
        weightings=", ".join(f"{name} for accelerations in {unit}/s2" for unit, name in WEIGHTING_OF.items()),
        critical_speed=found.surveyed.critical_speed,
        guideway=told(guideway),
        findings=found.findings,
    )
    return labelled(values, settings)


class Stationary(NamedTuple):
    """The response to a random road, before it has labels."""

    surveyed: Survey
    lines: Lines  # densities where the integrals need them
    densities: Callable[[FloatArray], FloatArray]  # the same at any frequencies [Hz]
    statistics: dict[str, FloatArray]  # by name, (contact,) or (dof,)
    findings: list[Finding]


def stationary(
    guideway: Guideway,
    vehicle: Vehicle,
    spectrum: Spectrum,
    *,
    speed: float,
    coherence: Coherence | float,
    exposure: float = 600.0,
    progress: Progress = silent,
) -> Stationary:
    """Compute the response to a random road: `random_response` without labels, for what has been checked.

    Parameters
    ----------
    guideway, vehicle, spectrum, speed, coherence, exposure, progress
        As for `random_response`.

    Returns
    -------
    Stationary
        Densities, statistics and findings.

    Raises
    ------
    SolveError
        If vehicle and guideway are unstable together, or a vibration without damping has no finite mean square.
    """
    system = System.of(guideway, vehicle, speed)
    progress("steady state", 0.0)
    surveyed = survey(system)
    steady = surveyed.steady
    densities = _densities(system, Ensemble(vehicle=vehicle, spectrum=spectrum, coherence=coherence, speed=speed))
    progress("spectral densities", 0.0)
    lines = _resolved(densities, vehicle, _edges(spectrum, speed))
    statistics = _statistics(vehicle, lines, exposure)
    force_rms, crossing = statistics["contact_force_rms"], statistics["contact_force_crossing_rate"]
    lift_off_share, lift_off_rate = lift_off(steady.load, force_rms, crossing)
    all_of_them = {
        "static_load": steady.load.copy(),
        "static_deflection": steady.deflection.copy(),
        **statistics,
        "dynamic_load_coefficient": load_coefficient(force_rms, steady.load),
        "lift_off_share": lift_off_share,
        "lift_off_rate": lift_off_rate,
        # What does not move but for rounding is not felt either.
        "weighted_acceleration": np.where(statistics["acceleration_rms"] > 0, _weighted(vehicle, lines), 0.0),
    }
    found = [
        *lifting_off(lift_off_share, lift_off_rate, exposure, vehicle.standing),
        *surveyed.findings,
        *_at_the_end(lines, vehicle, spectrum),
    ]
    return Stationary(surveyed, lines, densities, all_of_them, found)


def checked_coherence(check: Checks, coherence: Coherence | float | None, paths: int) -> Coherence | float:
    """Take a coherence as a model or a float; anything will do for a single path."""
    if coherence is None:
        if paths > 1:
            check.refuse(
                "coherence",
                f"is needed, since the contacts follow {paths} paths: a model such as IsotropicCoherence(), 1.0 "
                "for the same road on all of them, or 0.0 for roads without anything in common",
            )
        return 1.0
    coherence = plain(coherence)
    if isinstance(coherence, Real):
        ratio = check.not_negative("coherence", coherence, "1")
        if ratio > 1:
            check.refuse("coherence", f"must be at most 1, got {coherence!r}")
        return ratio
    if isinstance(coherence, type) or not hasattr(coherence, "between"):
        check.refuse(
            "coherence",
            f"must be a model, as IsotropicCoherence() is, or a number between 0 and 1, got {shown(coherence)}",
        )
    return coherence


def _matrices(coherence: Coherence, spatial_frequency: FloatArray, across: FloatArray) -> FloatArray:
    """γ of a model over the paths, (frequency, path, path); one that breaks the contract of models is refused."""
    shape = (spatial_frequency.size, across.size, across.size)
    with checking() as check:
        shared = np.asarray(coherence.between(spatial_frequency, across[:, None] - across))
        if shared.shape != shape:
            check.refuse("coherence", f"must return an array (frequency, path, path), {shape}, got {shared.shape}")
        elif shared.dtype.kind not in "iuf" or not np.isfinite(shared).all():
            check.refuse("coherence", "must return real, finite numbers: neither path is ahead of the other")
        elif (np.abs(np.diagonal(shared, axis1=1, axis2=2) - 1) > TOLERANCES.semidefinite).any():
            check.refuse("coherence", "must be 1 between a path and itself, no distance apart")
        elif (np.abs(shared - shared.swapaxes(1, 2)) > TOLERANCES.semidefinite).any():
            check.refuse("coherence", "must be the same from left to right as from right to left")
    return shared


def _parts(vehicle: Vehicle) -> dict[str, slice]:
    """Columns of every quantity within the outputs."""
    count = {"contact": len(vehicle.contacts), "dof": len(vehicle.dof_names)}
    ends = np.cumsum([0, *(count[place] for place, _, _ in RANDOM_QUANTITIES.values())]).tolist()
    return {name: slice(*ends[n : n + 2]) for n, name in enumerate(RANDOM_QUANTITIES)}


def _outputs(vehicle: Vehicle) -> int:
    return _parts(vehicle)["roughness"].stop


def _densities(system: System, road: Ensemble) -> Callable[[FloatArray], FloatArray]:
    """Spectral densities of all outputs, (frequency, output), as a function of the frequency [Hz]."""

    def densities(frequency: FloatArray) -> FloatArray:
        omega = 2 * np.pi * frequency
        roughness = road.amplitudes(frequency)
        found = solve(system, omega + 0j, roughness)
        force, deflection, motion, elevation = (
            (part.real**2 + part.imag**2).sum(axis=0) for part in (*found, roughness)
        )
        return turned(np.vstack([force, deflection, motion, omega**4 * motion, elevation]))

    return densities


def _resolved(densities: Callable[[FloatArray], FloatArray], vehicle: Vehicle, edges: FloatArray) -> Lines:
    """Frequencies that resolve the densities; where none do, the reason."""
    comparable = np.eye(_outputs(vehicle)) + TOLERANCES.rounding * _negligible(vehicle)
    try:
        return resolved(densities, edges, powers=TOLERANCES.powers, comparable=comparable)
    except Unresolved as failure:
        reason = (
            "a vibration without damping has no finite root mean square"
            if vehicle.damping_ratios.min(initial=np.inf) < TOLERANCES.undamped
            else "no vibration of the vehicle is without damping, so that it may be rounding that varies there; at "
            f"this speed the band of the road is {edges[0]:.3g} to {edges[-1]:.3g} Hz"
        )
        raise SolveError(f"{failure}: {reason}") from None


def _edges(spectrum: Spectrum, speed: float) -> FloatArray:
    """Octaves of the band [Hz]."""
    low, high = (n * speed for n in spectrum.band)
    return np.geomspace(low, high, max(int(np.ceil(np.log2(high / low))), 1) + 1)


def _negligible(vehicle: Vehicle) -> FloatArray:
    """Beside what an output is negligible, shape (output, output).

    Contacts are compared with each other, degrees of freedom by the kinetic energy of their motion.
    """
    inertia = np.diag(vehicle.matrices[0])
    among = {"contact": np.ones((len(vehicle.contacts),) * 2), "dof": inertia / inertia[:, None]}
    whole = np.zeros((_outputs(vehicle),) * 2)
    for name, part in _parts(vehicle).items():
        whole[part, part] = among[RANDOM_QUANTITIES[name][0]]
    return whole


def _statistics(vehicle: Vehicle, lines: Lines, exposure: float) -> dict[str, FloatArray]:
    """Statistics of every quantity by their names in the schema."""
    variance, second, fourth = (lines.moment(power) for power in TOLERANCES.powers)
    rounding = variance < TOLERANCES.rounding * (_negligible(vehicle) @ variance)
    variance, second, fourth = (np.where(rounding, 0.0, moment) for moment in (variance, second, fourth))
    rms, crossing, peaks = np.sqrt(variance), spectral_rate(second, variance), spectral_rate(fourth, second)
    columns = {
        "rms": rms,
        "crossing_rate": crossing,
        "peak_rate": peaks,
        "irregularity": crossing / peaks,
        # What does not move has no peak either.
        "expected_peak": rms * peak_factor(np.nan_to_num(crossing) * exposure),
    }
    return {
        f"{name}_{statistic}": column[part]
        for name, part in _parts(vehicle).items()
        for statistic, column in columns.items()
    }


def _weighted(vehicle: Vehicle, lines: Lines) -> FloatArray:
    """Root mean square acceleration with the weighting of its unit, shape (dof,)."""
    from movingfrf.metrics.comfort import weighting

    density = lines.density[:, _parts(vehicle)["acceleration"]]
    found = np.empty(len(vehicle.dof_names))
    units = coordinates(vehicle, lines.frequency)["dof_unit"]
    for unit, name in WEIGHTING_OF.items():
        gain = np.abs(weighting(name, lines.frequency)) ** 2
        mine = np.asarray(units) == unit
        found[mine] = np.sqrt((lines.bandwidth * gain) @ density[:, mine])
    return found


def _at_the_end(lines: Lines, vehicle: Vehicle, spectrum: Spectrum) -> list[Finding]:
    """Contact forces with content up to the end of the band."""
    force = lines.density[:, _parts(vehicle)["contact_force"]]
    last = lines.frequency > 0.9 * lines.frequency[-1]
    share = float(((lines.bandwidth * last) @ force / lines.moment(0)[: force.shape[1]]).max())
    if share <= TOLERANCES.at_the_end:
        return []
    return [
        Finding(
            "end_of_band",
            f"{share:.1%} of the variance of a contact force lies in the highest tenth of the spectrum's band (up "
            f"to {spectrum.band[1]:g} cycle/m): a wider band would add to it, a footprint of the tyre take away",
        )
    ]
